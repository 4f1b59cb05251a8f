//! Damaged files: every importer gives an error or a result, and never panics or hangs.

use pcr_formats::import::{ImportOptions, InputFormat, Warnings, layout, scenario};
use pcr_formats::splitmix64::SplitMix64;
use pcr_planning::exclusion_table::ExclusionTable;
use pcr_planning::fleet::Fleet;
use serde_json::{Value, json};

/// One file of every kind.
const FILES: [(InputFormat, &str); 13] = [
    (InputFormat::Nav2, include_str!("../data/real/nav2/sample_graph.geojson")),
    (InputFormat::Nav2, include_str!("../data/real/nav2/aws_graph.geojson")),
    (InputFormat::Lif, include_str!("../data/real/lif/example_17.lif.json")),
    (InputFormat::Lif, include_str!("../data/real/lif/example_10.lif.json")),
    (InputFormat::Vda5050, include_str!("../data/real/vda5050/order_v2_flywei.json")),
    (InputFormat::Vda5050, include_str!("../data/small/state.json")),
    (InputFormat::Ccbs, include_str!("../data/real/ccbs/example_grid_task_log.xml")),
    (InputFormat::Ccbs, include_str!("../data/small/roadmap.xml")),
    (InputFormat::OpenDrive, include_str!("../data/small/track.xodr")),
    (InputFormat::OpenTcs, include_str!("../data/small/plant.xml")),
    (InputFormat::Grid, include_str!("../data/small/grid.path")),
    (InputFormat::Path, include_str!("../data/small/points.path")),
    (InputFormat::Rmf, include_str!("../data/real/rmf/triple_H.building.yaml")),
];

/// Reads the text in every way. What it becomes has to be fit for use.
fn read(format: InputFormat, text: &str) {
    let options = |routes: &[&str]| ImportOptions {
        routes: routes.iter().map(ToString::to_string).collect(),
        partial: true,
        ..ImportOptions::default()
    };
    let mut warnings = Warnings::default();
    if let Ok(imported) = layout(format, text, &options(&[]), &mut warnings) {
        let _ = ExclusionTable::compute(&imported, true);
        let ids: Vec<String> = imported.layout.nodes.iter().map(|node| node.id.to_string()).collect();
        for pair in ids.windows(2).take(4) {
            let route = format!("{}:{}", pair[0], pair[1]);
            if let Ok(scenario) = scenario(format, text, &options(&[&route]), &mut warnings) {
                let _ = Fleet::<f64>::new(&scenario);
            }
        }
    }
    if let Ok(scenario) = scenario(format, text, &options(&[]), &mut warnings) {
        let _ = Fleet::<f64>::new(&scenario);
    }
    assert!(warnings.lines().iter().all(|line| !line.is_empty()));
}

#[test]
fn files_that_end_early() {
    for (format, text) in FILES {
        for k in 0..60 {
            let end = text.len() * k / 60;
            read(format, &text[..text.floor_char_boundary(end)]);
        }
    }
}

#[test]
fn files_with_other_bytes() {
    let mut dice = SplitMix64(1);
    let bytes = b"0129-+.eE\"{}[],:<>/=&; \nNa\0\xf0";
    for (format, text) in FILES {
        for _ in 0..150 {
            let mut damaged = text.as_bytes().to_vec();
            for _ in 0..=dice.below(6) {
                let place = dice.below(damaged.len());
                match dice.below(3) {
                    0 if damaged.is_empty() => {}
                    0 => damaged[place] = bytes[dice.below(bytes.len())],
                    1 => damaged.insert(place, bytes[dice.below(bytes.len())]),
                    _ => drop(damaged.drain(place..(place + dice.below(40)).min(damaged.len()))),
                }
            }
            read(format, &String::from_utf8_lossy(&damaged));
        }
    }
}

/// All places in a JSON value, as pointers.
fn places(value: &Value, at: &str, into: &mut Vec<String>) {
    into.push(at.to_owned());
    match value {
        Value::Array(elements) => {
            for (k, element) in elements.iter().enumerate() {
                places(element, &format!("{at}/{k}"), into);
            }
        }
        Value::Object(members) => {
            for (key, member) in members {
                places(member, &format!("{at}/{}", key.replace('~', "~0").replace('/', "~1")), into);
            }
        }
        _ => {}
    }
}

#[test]
fn json_with_other_values() {
    let mut dice = SplitMix64(2);
    for (format, text) in FILES {
        let Ok(value) = serde_json::from_str::<Value>(text) else { continue };
        let mut all = Vec::new();
        places(&value, "", &mut all);
        for k in 0..150 {
            let mut damaged = value.clone();
            for _ in 0..=k % 3 {
                let other = [
                    json!(null),
                    json!(1e308),
                    json!(-1e-308),
                    json!(-1),
                    json!(0),
                    json!(u64::MAX),
                    json!(3.5),
                    json!("text"),
                    json!(""),
                    json!(true),
                    json!([]),
                    json!({}),
                    json!([[[[1]]]]),
                    value.pointer(&all[dice.below(all.len())]).cloned().unwrap_or_default(),
                ];
                if let Some(place) = damaged.pointer_mut(&all[dice.below(all.len())]) {
                    *place = other[dice.below(other.len())].clone();
                }
            }
            read(format, &damaged.to_string());
        }
    }
}

#[test]
fn texts_of_another_kind() {
    let deep = "[".repeat(100_000);
    let texts = [
        "",
        " ",
        "\u{feff}",
        "null",
        "[]",
        "{}",
        "0",
        "<a/>",
        "<a>",
        "a: b",
        "- - -",
        "\"",
        "{\"features\": {}}",
        &deep,
    ];
    for (format, _) in FILES {
        for text in texts {
            assert!(
                layout(format, text, &ImportOptions::default(), &mut Warnings::default()).is_err(),
                "{format} {text:.20}"
            );
            assert!(
                scenario(format, text, &ImportOptions::default(), &mut Warnings::default()).is_err(),
                "{format} {text:.20}"
            );
        }
    }
}
