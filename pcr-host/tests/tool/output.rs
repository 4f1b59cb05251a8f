//! What is printed: every format against the documented form and against the core's own numbers.

use crate::fixture::{PAPER, column, crossing, directory, file, run, straight};
use pcr_core::{Motion, RegionRef};
use pcr_formats::paper_example;
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::{Fleet, HostScalar, build_ecm};
use serde_json::{Value, json};

/// The text with every number replaced by `N`.
fn skeleton(text: &str) -> String {
    let mut skeleton = String::new();
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c == '-' || c.is_ascii_digit()) {
        let quoted = rest[..start].ends_with(|c: char| c.is_ascii_alphanumeric());
        let length = rest[start..].find(|c: char| !(c.is_ascii_alphanumeric() || "+-.".contains(c))).unwrap();
        skeleton.push_str(&rest[..start]);
        skeleton.push_str(if quoted { &rest[start..start + length] } else { "N" });
        rest = &rest[start + length..];
    }
    skeleton + rest
}

#[test]
fn json_has_the_documented_keys_in_the_documented_order() {
    let scenario = file("keys", "crossing.json", crossing().to_string());
    let region = concat!(
        r#"{"i":N,"j":N,"t":[N,N],"l":[N,N],"open_start":false,"open_end":false,"#,
        r#""pieces":[{"type":"SS","i_segment":N,"j_segment":N,"i_length":[N,N],"j_length":[N,N],"#,
        r#""crossings":[{"T":N,"L":N,"r_hat":N,"v":N,"theta":N}]}]"#
    );
    let plain = run(&["regions", &scenario, "--format", "json"]).ok();
    let form = format!(
        r#"{{"format":"pcr-regions","version":N,"name":"crossing","scalar":"f64","regions":[{region}}},{region}}}],"error":null,"warnings":[]}}"#
    );
    assert_eq!(skeleton(&plain), form + "\n");
    let sliced = run(&["regions", &scenario, "--format", "json", "--slices", "1", "--scalar", "f32"]).ok();
    let region = format!(r#"{region},"slices":[{{"t":N,"l":[[N,N]]}}]}}"#);
    let form = format!(
        r#"{{"format":"pcr-regions","version":N,"name":"crossing","scalar":"f32","regions":[{region},{region}],"error":null,"warnings":[]}}"#
    );
    assert_eq!(skeleton(&sliced), form + "\n");
}

#[test]
fn a_crossing_at_right_angles_has_the_numbers_of_the_hand_calculation() {
    let scenario = file("hand", "crossing.json", crossing().to_string());
    let answer = run(&["regions", &scenario, "--format", "json"]).json();
    // 1 s and 0.5 m to speed up, then 1.5 m at 1 m/s to the crossing; the discs reach 0.5 m.
    for region in answer["regions"].as_array().unwrap() {
        let expected = [("/t/0", 2.0), ("/t/1", 3.0), ("/l/0", 1.5), ("/l/1", 2.5)];
        let crossing = [("T", 2.5), ("L", 2.0), ("r_hat", 0.5), ("v", 1.0)];
        let crossing = crossing.map(|(key, value)| (format!("/pieces/0/crossings/0/{key}"), value));
        for (pointer, value) in expected.map(|(key, value)| (key.to_owned(), value)).into_iter().chain(crossing) {
            let got = region.pointer(&pointer).unwrap().as_f64().unwrap();
            // Outward rounding of lengths of some metres.
            assert!((got - value).abs() < 1e-12, "{pointer}: {got}");
        }
    }
}

/// Every number of the JSON output is the core's, bit for bit.
fn output_is_the_cores<S: HostScalar>() {
    let scenario = Scenario::from_json(paper_example::SCENARIO).unwrap();
    let fleet = Fleet::<S>::new(&scenario).unwrap();
    let motions = fleet.motions();
    let ecm = build_ecm(&motions).unwrap();
    let answer = run(&["regions", PAPER, "--format", "json", "--slices", "2", "--scalar", S::NAME]).json();
    let printed = answer["regions"].as_array().unwrap();
    let regions: Vec<RegionRef<'_, S>> = ecm.regions(&motions).expect("the table of the fleet").collect();
    assert_eq!((answer["scalar"].as_str(), printed.len()), (Some(S::NAME), regions.len()));
    let mut found = 0;
    for region in &regions {
        let (time, length) = (region.time(), region.length());
        let id = |agent: usize| scenario.agents[agent].id;
        let start = [time.lo.to_f64(), length.lo.to_f64()];
        let same = |printed: &&Value| {
            (&printed["i"], &printed["j"]) == (&json!(id(region.ego())), &json!(id(region.other())))
                && [&printed["t"][0], &printed["l"][0]] == [&json!(start[0]), &json!(start[1])]
        };
        let printed = printed.iter().find(same).unwrap();
        assert_eq!(printed["t"], json!([time.lo.to_f64(), time.hi.to_f64()]));
        assert_eq!(printed["l"], json!([length.lo.to_f64(), length.hi.to_f64()]));
        assert_eq!(printed["open_start"], json!(region.is_open_at_start()));
        assert_eq!(printed["open_end"], json!(region.is_open_at_end()));
        assert_eq!(printed["pieces"].as_array().unwrap().len(), region.pieces().count());
        for slice in printed["slices"].as_array().unwrap() {
            let intervals = region.slice_at(S::from_f64(slice["t"].as_f64().unwrap()));
            let intervals: Vec<[f64; 2]> = intervals.map(|part| [part.lo.to_f64(), part.hi.to_f64()]).collect();
            assert_eq!(slice["l"], json!(intervals));
        }
        found += 1;
    }
    assert_eq!(found, printed.len());
}

#[test]
fn json_is_what_the_core_computes_in_f64() {
    output_is_the_cores::<f64>();
}

#[test]
fn json_is_what_the_core_computes_in_f32() {
    output_is_the_cores::<f32>();
}

#[test]
fn regions_are_sorted_by_number_and_not_by_place() {
    let north = std::f64::consts::FRAC_PI_2;
    let agents = [
        straight(u64::MAX, [-2.0, 0.0, 0.0], 4.0),
        straight(10, [0.0, -2.0, north], 4.0),
        straight(9, [0.5, -2.0, north], 4.0),
    ];
    let scenario = file("sorted", "fleet.json", json!({ "agents": agents }).to_string());
    let answer = run(&["regions", &scenario, "--format", "json"]).json();
    let regions = answer["regions"].as_array().unwrap();
    let pairs: Vec<[u64; 2]> =
        regions.iter().map(|region| ["i", "j"].map(|key| region[key].as_u64().unwrap())).collect();
    assert_eq!(pairs, [[9, 10], [9, u64::MAX], [10, 9], [10, u64::MAX], [u64::MAX, 9], [u64::MAX, 10]]);
    let paper = run(&["regions", PAPER, "--format", "json"]).json();
    let keys: Vec<(u64, u64, f64, f64)> = paper["regions"].as_array().unwrap().iter().map(key).collect();
    assert!(keys.is_sorted(), "{keys:?}");
}

fn key(region: &Value) -> (u64, u64, f64, f64) {
    let id = |key: &str| region[key].as_u64().unwrap();
    let start = |key: &str| region[key][0].as_f64().unwrap();
    (id("i"), id("j"), start("t"), start("l"))
}

/// How far the distance at the end of a slice may be from the sum of the radii: rounding of coordinates up to 10 m.
const CONTACT: f64 = 1e-12;

#[test]
fn slices_are_at_the_documented_times_and_end_where_discs_touch() {
    let scenario = Scenario::from_json(paper_example::SCENARIO).unwrap();
    let fleet = Fleet::<f64>::new(&scenario).unwrap();
    let motions = fleet.motions();
    let motion = |id: &Value| -> &Motion<'_, f64> {
        &motions[scenario.agents.iter().position(|agent| Some(agent.id) == id.as_u64()).unwrap()]
    };
    const SLICES: usize = 9;
    let answer = run(&["regions", PAPER, "--format", "json", "--slices", "9"]).json();
    let mut ends = 0;
    for region in answer["regions"].as_array().unwrap() {
        let (ego, other) = (motion(&region["i"]), motion(&region["j"]));
        let [from, to] = [0, 1].map(|end| region["t"][end].as_f64().unwrap());
        let slices = region["slices"].as_array().unwrap();
        assert_eq!(slices.len(), SLICES);
        for (k, slice) in (1..).zip(slices) {
            let time = slice["t"].as_f64().unwrap();
            let expected = from + (to - from) * f64::from(k) / (SLICES + 1) as f64;
            assert!((time - expected).abs() <= f64::EPSILON * to, "{time} for {expected}");
            let centre = other.position_at(time);
            let intervals = slice["l"].as_array().unwrap();
            assert!(!intervals.is_empty(), "{region}");
            for end in intervals.iter().flat_map(|interval| interval.as_array().unwrap()) {
                let length = end.as_f64().unwrap();
                let at = ego.path().point_at(length);
                let distance = (at.x - centre.x).hypot(at.y - centre.y);
                let radius = ego.radius() + other.radius();
                let at_end_of_path = length == 0.0 || length == ego.path().length();
                assert!((distance - radius).abs() < CONTACT || at_end_of_path && distance < radius, "{region} {time}");
                ends += 1;
            }
        }
    }
    assert!(ends >= 2 * 136 * SLICES);
}

#[test]
fn every_crossing_is_in_one_piece() {
    for (file, crossings) in [("table6-30.json", 218), ("table6-50.json", 718)] {
        let file = format!("{}/../tests/data/{file}", env!("CARGO_MANIFEST_DIR"));
        let answer = run(&["regions", &file, "--format", "json"]).json();
        let pieces =
            answer["regions"].as_array().unwrap().iter().flat_map(|region| region["pieces"].as_array().unwrap());
        assert_eq!(pieces.map(|piece| piece["crossings"].as_array().unwrap().len()).sum::<usize>(), crossings);
    }
}

#[test]
fn csv_reads_back_as_the_same_numbers() {
    let csv = run(&["regions", PAPER, "--format", "csv"]).ok();
    let mut lines = csv.lines();
    assert_eq!(
        lines.next(),
        Some("name,i,j,t_a,t_b,l_a,l_b,open_start,open_end,types,crossings,margin,i_label,j_label")
    );
    let answer = run(&["regions", PAPER, "--format", "json"]).json();
    let regions = answer["regions"].as_array().unwrap();
    let lines: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(lines.len(), regions.len());
    for (cells, region) in lines.iter().zip(regions) {
        assert_eq!(cells[0], "paper12");
        let numbers: Vec<f64> = cells[3..7].iter().map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(json!([numbers[..2], numbers[2..]]), json!([region["t"], region["l"]]));
        let flag = |key: &str| if region[key] == json!(true) { "1" } else { "0" };
        assert_eq!([cells[7], cells[8]], [flag("open_start"), flag("open_end")]);
        let pieces = region["pieces"].as_array().unwrap();
        let crossings: usize = pieces.iter().map(|piece| piece["crossings"].as_array().unwrap().len()).sum();
        assert_eq!(cells[10], crossings.to_string());
        assert!(cells[9].contains(pieces[0]["type"].as_str().unwrap()));
    }
}

#[test]
fn names_are_harmless_in_csv_and_tables() {
    let mut scenario = crossing();
    scenario["name"] = json!("a,\"b\"");
    let named = file("names", "names.json", scenario.to_string());
    let csv = run(&["regions", &named, "--format", "csv"]).ok();
    assert!(csv.contains("\n\"a,\"\"b\"\"\",1,2,"), "{csv}");
    for control in ['\u{1b}', '\n', '\u{202e}'] {
        scenario["name"] = json!(format!("a{control}b"));
        let named = file("names", "controls.json", scenario.to_string());
        let expected = format!(
            "pcr: {named}:1:{}: name: has the control character {}; allowed is printable text\n",
            column(&scenario, "/name"),
            control.escape_default()
        );
        assert_eq!(run(&["regions", &named]).failed(2), expected);
    }
    // Layouts may have any names: they are shown without what moves the text beside them.
    let lif = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/lif/example_07.lif.json");
    let lif = std::fs::read_to_string(lif).unwrap();
    let lif = lif.replace("\"LIF Example 07\"", "\"g\\u202e\\n\"").replace("\"N1\"", "\"N1\\u202e\"");
    let graph = file("names", "graph.lif.json", lif);
    let table = run(&["nodes", &graph]).out;
    assert!(table.starts_with("g: ") && table.contains("N1\\u{202e}") && !table.contains('\u{202e}'), "{table}");
    let pictures = directory("names").join("locks");
    run(&["locks", &graph, "--radius", "0.3", "-q", "-o", pictures.to_str().unwrap()]).ok();
    let svg = std::fs::read_to_string(pictures.join("layout.svg")).unwrap();
    assert!(svg.contains("N1\u{fffd}") && !svg.contains('\u{202e}'), "{svg}");
    let page = std::fs::read_to_string(pictures.join("locks.html")).unwrap();
    assert!(page.contains("<title>g – locks<"));
}

/// The cells of the line of a table that begins with these.
fn row<'t>(table: &'t str, first: &[&str]) -> Vec<&'t str> {
    let rows = table.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    rows.into_iter().find(|cells| cells.starts_with(first)).unwrap_or_else(|| panic!("no {first:?} in\n{table}"))
}

#[test]
fn the_table_of_an_agent_is_that_of_the_paper() {
    let table = run(&["regions", PAPER, "--agent", "3"]).ok();
    assert!(table.starts_with("paper12: 18 collision regions, 18 crossings (f64)\n"), "{table}");
    let row_8 = ["3", "8", "1", "AA", "10.376", "4.668", "0.310", "0.440", "-1.668", "1.150", "ccw", "2.248", "ccw"];
    assert_eq!(row(&table, &["3", "8", "1", "AA"]), row_8);
    let row_13 = ["3", "9", "3", "SA", "18.306", "8.207", "0.320", "0.420", "-1.507", "-", "2.330", "cw"];
    assert_eq!(row(&table, &["3", "9", "3"]), row_13);
    assert_eq!(row(&table, &["3", "4", "3.568"]), ["3", "4", "3.568", "4.769", "2.881", "3.504", "-", "1", "SA+AA"]);
    assert_eq!(table.lines().filter(|line| line.starts_with("  3  ")).count(), 36);
    assert!(table.lines().all(|line| line.chars().count() <= 100), "{table}");
}

#[test]
fn columns_of_tables_are_aligned() {
    let table = run(&["regions", PAPER]).ok();
    let mut blocks = 0;
    for block in table.split("\n\n").skip(1) {
        // Under the last letter of a title that is set to the right ends every number of its column.
        let lines: Vec<Vec<char>> = block.lines().skip(1).map(|line| line.chars().collect()).collect();
        let title: String = lines[0].iter().collect();
        let end =
            title.find("t_a [s]").map_or_else(|| title.find("T [s]").map(|at| at + 5), |at| Some(at + 7)).unwrap();
        for line in lines.iter().filter(|line| line.first() == Some(&' ')) {
            assert!(line[end - 1] != ' ' && line[end] == ' ', "{}", line.iter().collect::<String>());
        }
        blocks += 1;
    }
    assert_eq!(blocks, 2);
}

#[test]
fn an_agent_restricts_every_format() {
    let answer = run(&["regions", PAPER, "--agent", "5", "--format", "json"]).json();
    let all = run(&["regions", PAPER, "--format", "json"]).json();
    let of_5: Vec<&Value> =
        all["regions"].as_array().unwrap().iter().filter(|region| region["i"] == json!(5)).collect();
    assert_eq!(answer["regions"].as_array().unwrap().iter().collect::<Vec<_>>(), of_5);
    let csv = run(&["regions", PAPER, "--agent", "5", "--format", "csv"]).ok();
    assert_eq!(csv.lines().count(), 1 + of_5.len());
}

#[test]
fn agents_that_stand_have_open_regions_and_no_segment() {
    let mut standing = straight(2, [0.0, 0.0, 0.0], 0.0);
    standing["path"] = json!([]);
    let scenario = json!({ "agents": [straight(1, [-2.0, 0.0, 0.0], 4.0), standing] });
    let scenario = file("standing", "standing.json", scenario.to_string());
    let answer = run(&["regions", &scenario, "--format", "json"]).json();
    let [passing, standing] = answer["regions"].as_array().unwrap().as_slice() else { panic!("{answer}") };
    assert_eq!((&passing["open_start"], &passing["open_end"]), (&json!(true), &json!(true)));
    assert_eq!((&passing["t"], &passing["pieces"][0]["j_segment"]), (&json!([0.0, 0.0]), &Value::Null));
    assert_eq!((&standing["open_start"], &standing["open_end"]), (&json!(false), &json!(false)));
    assert_eq!((&standing["l"], &standing["pieces"][0]["i_segment"]), (&json!([0.0, 0.0]), &Value::Null));
}

#[test]
fn fleets_of_none_and_of_one_have_no_regions() {
    for agents in [json!([]), json!([straight(1, [0.0, 0.0, 0.0], 1.0)])] {
        let name = format!("of-{}", agents.as_array().unwrap().len());
        let scenario = file("few", &format!("{name}.json"), json!({ "agents": agents }).to_string());
        let json = run(&["regions", &scenario, "--format", "json"]).ok();
        assert_eq!(
            json,
            format!(
                "{{\"format\":\"pcr-regions\",\"version\":2,\"name\":\"{name}\",\"scalar\":\"f64\",\"regions\":[],\"error\":null,\"warnings\":[]}}\n"
            )
        );
        assert_eq!(run(&["regions", &scenario]).ok(), format!("{name}: 0 collision regions, 0 crossings (f64)\n"));
        assert_eq!(run(&["regions", &scenario, "--format", "csv"]).ok().lines().count(), 1);
    }
}

#[test]
fn paths_of_ten_thousand_segments_are_no_matter() {
    let segments: Vec<Value> = (0..10_000).map(|_| json!({ "kind": "line", "length": 0.01 })).collect();
    let mut long = straight(1, [-50.0, 0.0, 0.0], 100.0);
    long["path"] = json!(segments);
    let scenario = json!({ "agents": [long, straight(2, [0.002, -2.0, std::f64::consts::FRAC_PI_2], 4.0)] });
    let scenario = file("long", "long.json", scenario.to_string());
    let answer = run(&["regions", &scenario, "--format", "json", "--agent", "1"]).json();
    let [region] = answer["regions"].as_array().unwrap().as_slice() else { panic!("{answer}") };
    // 0.5 m to either side of 50.002 m, in steps of 0.01 m.
    let pieces = region["pieces"].as_array().unwrap();
    assert_eq!((pieces.len(), pieces[0]["i_segment"].as_u64()), (101, Some(4951)));
    assert_eq!(pieces.iter().filter(|piece| piece["crossings"] != json!([])).count(), 1);
}

#[test]
fn a_pair_that_the_table_cannot_hold_is_named() {
    // Two convoys in steps of 1 cm: each of 700 segments is within reach of 100 of the other agent.
    let segments: Vec<Value> = (0..700).map(|_| json!({ "kind": "line", "length": 0.01 })).collect();
    let agent = |id, y: f64| {
        let mut agent = straight(id, [0.0, y, 0.0], 7.0);
        agent["path"] = json!(segments);
        agent
    };
    let scenario = json!({ "agents": [agent(8, 50.0), agent(5, 0.0), agent(6, 0.1)] });
    let scenario = file("overfull", "convoy.json", scenario.to_string());
    let message = run(&["regions", &scenario]).failed(2);
    let problem = "agents 5 and 6: more than 32767 pieces (pairs of segments within reach of one another), each turn of an arc counted; \
                   join short segments, or leave out turns";
    assert_eq!(message, format!("pcr: {scenario}: {problem}\n"));
}

#[test]
fn the_embedded_scenario_is_that_of_the_tests() {
    assert_eq!(paper_example::SCENARIO, include_str!("../../../tests/data/paper12.json"));
}

#[test]
fn pictures_are_listed_and_there() {
    let scenario = file("map", "crossing.json", crossing().to_string());
    let pictures = directory("map").join("pictures");
    let _ = std::fs::remove_dir_all(&pictures);
    let printed = run(&["map", &scenario, "-o", pictures.to_str().unwrap()]).ok();
    let files: Vec<_> = std::fs::read_dir(&pictures).unwrap().map(|entry| entry.unwrap()).collect();
    assert!(files.iter().all(|file| file.metadata().unwrap().len() > 0));
    let expected = format!("Pictures: {} files in {}; begin with ", files.len(), pictures.display());
    let first = printed.strip_prefix(&expected).unwrap_or_else(|| panic!("{printed}")).trim_end();
    assert!(std::path::Path::new(first).is_file(), "{first}");
    for name in ["ecm-1.svg", "ecm-2.svg", "workspace.svg"] {
        assert!(pictures.join(name).is_file(), "{name}");
    }
    assert_eq!(pictures.join("ecm-2.png").is_file(), cfg!(feature = "png"));
}

#[test]
fn the_tables_of_the_paper_are_printed_beside_ours() {
    // Where pictures cannot be written the tables are printed all the same.
    let directory = directory("overview");
    std::fs::write(directory.join("pcr-out"), "not a directory").unwrap();
    let output = crate::fixture::pcr().current_dir(&directory).output().unwrap();
    let (out, err) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    assert_eq!(output.status.code(), Some(3), "{err}");
    assert!(err.starts_with("pcr: pcr-out: cannot be written: "), "{err}");
    assert_eq!(row(&out, &["sum"]), ["sum", "126", "126", "136"]);
    let row_18 = row(&out, &["18", "SA"]).join(" ");
    assert_eq!(row_18, "18 SA 1 2 9.610 9.6 10.832 10.8 0.240 0.2 0.580 0.6 -4.995 -5.0 - 0.849 ccw 0.8 ccw");
    assert!(out.contains("17 of 18 rows agree to the printed digit"), "{out}");
    assert!(row(&out, &["17*", "SA"]).ends_with(&["1.635", "cw", "1.6", "ccw"]), "{out}");
    assert!(!out.contains('!'), "{out}");
    assert!(out.lines().count() <= 60 && out.lines().all(|line| line.chars().count() <= 120), "{out}");
}

#[cfg(feature = "png")]
#[test]
fn letters_that_are_boxes_in_a_picture_are_named() {
    let mut labelled = crossing();
    (labelled["agents"][0]["label"], labelled["agents"][1]["label"]) = (json!("机器人"), json!("\u{e9}"));
    let name = file("boxes", "labelled.json", labelled.to_string());
    let pictures = directory("boxes").join("maps").to_str().unwrap().to_owned();
    let run = run(&["map", &name, "-o", &pictures]);
    let text = "PNG has boxes for letters that the font of the program lacks: 人 器 机; SVG has them";
    assert_eq!((run.status, run.err), (0, format!("pcr: warning: {pictures}: {text} [missing-letters]\n")));
}
