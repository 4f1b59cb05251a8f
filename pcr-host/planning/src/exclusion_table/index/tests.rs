use super::*;
use pcr_formats::import::{ImportOptions, InputFormat, Warnings, layout};

/// The table of a cross of two edges and its four nodes.
fn table() -> Vec<u8> {
    let point = |id: usize, x: i32, y: i32| {
        format!(
            r#"{{"type":"Feature","properties":{{"id":{id}}},"geometry":{{"type":"Point","coordinates":[{x},{y}]}}}}"#
        )
    };
    let edge = |id: usize, from: usize, to: usize| {
        let ends = format!(r#""startid":{from},"endid":{to}"#);
        format!(
            r#"{{"type":"Feature","properties":{{"id":{id},{ends}}},"geometry":{{"type":"LineString","coordinates":[]}}}}"#
        )
    };
    let parts = [point(1, 0, 0), point(2, 10, 0), point(3, 5, -5), point(4, 5, 5), edge(10, 1, 2), edge(11, 3, 4)];
    let text = format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, parts.join(","));
    let options = ImportOptions { radius: Some(1.0), ..ImportOptions::default() };
    let imported = layout(InputFormat::Nav2, &text, &options, &mut Warnings::default()).expect("a layout");
    let file = scratch("whole");
    let mut out = File::options().read(true).write(true).create(true).truncate(true).open(&file).expect("a file");
    let sweep = SweptLayout::new(&imported, true).expect("a table");
    write_index(&sweep, 7, &mut out, &|_, _| {}).expect("written");
    let bytes = std::fs::read(&file).expect("a table");
    std::fs::remove_file(file).expect("removed");
    bytes
}

fn scratch(name: &str) -> std::path::PathBuf {
    std::env::temp_dir().join(format!("pcr-index-{}-{name}.locks", std::process::id()))
}

/// What is answered about an edge after a change, with all checksums as they should be.
fn answered(name: &str, change: impl Fn(&mut [u8], [usize; 3])) -> Result<usize, String> {
    let mut bytes = table();
    let number = |bytes: &[u8], at: usize| le64(&bytes[at..at + 8]) as usize;
    let [places, tracks, records] = [16, 24, 32].map(|at| number(&bytes, at));
    let directory = HEADER as usize + RECORD * records;
    change(&mut bytes, [directory, directory + 16 * places, places]);
    for track in 0..tracks {
        let at = directory + 16 * places + 24 * track;
        let (first, count) = (number(&bytes, at), le32(&bytes[at + 8..at + 12]) as usize);
        let begin = HEADER as usize + RECORD * first;
        let sum = crc32(bytes.get(begin..begin + RECORD * count).unwrap_or_default());
        bytes[at + 12..at + 16].copy_from_slice(&sum.to_le_bytes());
    }
    for (sum, at) in [(crc32(&bytes[directory..]), 48), (0, 12)] {
        let sum = if at == 12 { crc32(&bytes[16..HEADER as usize]) } else { sum };
        bytes[at..at + 4].copy_from_slice(&sum.to_le_bytes());
    }
    let file = scratch(name);
    std::fs::write(&file, &bytes).expect("written");
    let mut partners = ExclusionIndex::open(&file).map_err(|error| error.to_string());
    let found = partners
        .as_mut()
        .map_err(|error| error.clone())
        .and_then(|index| index.partners("10").map_err(|error| error.to_string()));
    std::fs::remove_file(file).expect("removed");
    found.map(|partners| partners.map_or(0, |partners| partners.len()))
}

/// Their checksums are right, and they answered "0 locks", or nonsense.
#[test]
fn numbers_that_do_not_fit_are_no_table() {
    // The other edge, and the nodes at both ends.
    assert_eq!(answered("right", |_, _| {}), Ok(3));
    type Change = fn(&mut [u8], [usize; 3]);
    let changes: [(&str, Change); 9] = [
        ("places", |bytes, _| bytes[16] += 1),
        ("many places", |bytes, _| bytes[23] = 0x40),
        ("tracks", |bytes, _| bytes[24] -= 1),
        ("many tracks", |bytes, _| bytes[31] = 0x20),
        ("track of a place", |bytes, [places, ..]| bytes[places..places + 4].copy_from_slice(&[0xf0, 255, 255, 255])),
        ("records of a track", |bytes, [_, tracks, _]| bytes[tracks + 8..tracks + 12].fill(0)),
        ("members of a track", |bytes, [_, tracks, _]| bytes[tracks + 20..tracks + 24].fill(255)),
        ("other track", |bytes, _| bytes[HEADER as usize..HEADER as usize + 4].fill(255)),
        ("length", |bytes, _| bytes[HEADER as usize + 4..HEADER as usize + 8].copy_from_slice(&f32::NAN.to_le_bytes())),
    ];
    for (name, change) in changes {
        let problem = answered(name, change).expect_err(name);
        assert!(problem.starts_with("not a table of locks that can be read: "), "{name}: {problem}");
    }
}
