//! `pcr locks`: a table for people, CSV and JSON for programs, a page.

use crate::fixture::{directory, file, run, run_with};
use serde_json::{Value, json};

const WAREHOUSE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/warehouse_graph.geojson");

/// A cross of two edges of 4 m, one of them drawn by a point in its middle.
fn cross() -> String {
    let node = |id: u32, x: f64, y: f64| json!({ "type": "Feature", "properties": { "id": id }, "geometry": { "type": "Point", "coordinates": [x, y] } });
    let edge = |id: u32, from: u32, to: u32| {
        json!({ "type": "Feature", "properties": { "id": id, "startid": from, "endid": to },
            "geometry": { "type": "MultiLineString", "coordinates": [] } })
    };
    let features =
        [node(1, -2.0, 0.0), node(2, 2.0, 0.0), node(3, 0.0, -2.0), node(4, 0.0, 2.0), edge(20, 1, 2), edge(7, 3, 4)];
    json!({ "type": "FeatureCollection", "name": "cross", "features": features }).to_string()
}

#[test]
fn json_is_as_documented() {
    let name = file("locks", "cross.geojson", cross());
    let output = run(&["locks", &name, "--radius", "0.25", "--format", "json"]);
    let table: serde_json::Value = serde_json::from_str(&output.out).unwrap();
    assert_eq!(
        table.as_object().unwrap().keys().collect::<Vec<_>>(),
        ["format", "layout", "locks", "vehicle", "version", "warnings"]
    );
    assert_eq!((&table["layout"], &table["vehicle"]), (&json!("cross"), &json!({ "name": null, "radius": 0.25 })));
    let lock = &table["locks"][0];
    assert_eq!((&lock["a"], &lock["b"], table["locks"].as_array().unwrap().len()), (&json!(7), &json!(20), 1));
    for lengths in [&lock["a_length"], &lock["b_length"]] {
        for (length, expected) in [(0, 1.5), (1, 2.5)] {
            assert!((lengths[length].as_f64().unwrap() - expected).abs() < 1e-12, "{lock}");
        }
    }
}

#[test]
fn csv_and_table() {
    let cross = cross();
    let arguments = ["locks", "-", "--from", "nav2", "--radius", "0.25", "--nodes", "--format"];
    let csv = run_with(&[&arguments[..], &["csv"]].concat(), cross.as_bytes()).out;
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!((lines[0], lines.len()), ("a,b,a_from,a_to,b_from,b_to", 6));
    assert!(lines[1].starts_with("7,20,1.") && lines[2].starts_with("node 3,7,,,0,0.5"), "{csv}");
    let table = run_with(&[&arguments[..], &["table"]].concat(), cross.as_bytes()).out;
    let expected = "\
cross: 1 lock of 1 pair of edges, radius 0.25 m
  a  b   a from [m]     to  b from [m]     to
  7  20       1.500  2.500       1.500  2.500
4 locks of nodes
  node  edge  from [m]     to
  3     7        0.000  0.500
";
    assert!(table.starts_with(expected), "{table}");
}

#[test]
fn nothing_is_not_less_than_0() {
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/aws_graph.geojson");
    for arguments in [&["locks", layout, "--radius", "0.4"][..], &["locks", layout, "--radius", "0.4", "--edge", "112"]]
    {
        let table = run(arguments).out;
        assert!(table.contains(" 0.000  0.000 ") && !table.contains("-0.000"), "{table}");
    }
    assert!(!run(&["nodes", layout, "--json", "-q"]).out.contains("\"length\":-0"));
    let edge = run(&["locks", layout, "--radius", "0.4", "--edge", "112", "--json"]);
    let warnings: Value = serde_json::from_str(&edge.out).unwrap();
    assert!(warnings["warnings"][0].as_str().unwrap().contains("edge 112: its length is 0"), "{warnings}");
}

#[test]
fn pictures_are_written() {
    let pictures = directory("locks").join("pictures");
    let _ = std::fs::remove_dir_all(&pictures);
    let output = run(&["locks", WAREHOUSE, "--radius", "0.4", "-o", pictures.to_str().unwrap()]);
    assert_eq!(output.status, 0, "{}", output.err);
    assert!(output.out.starts_with("warehouse_graph: 544 locks of 544 pairs of edges, radius 0.4 m\n"));
    let mut names: Vec<_> = std::fs::read_dir(&pictures).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    let expected: &[&str] =
        if cfg!(feature = "png") { &["layout.png", "layout.svg", "locks.html"] } else { &["layout.svg", "locks.html"] };
    assert_eq!(names, expected);
}

#[test]
fn what_is_no_layout_is_refused() {
    let scenario = file("locks", "scenario.json", crate::fixture::crossing().to_string());
    let failed = run(&["locks", &scenario]).failed(2);
    assert!(
        failed.ends_with("scenario.json: this is a scenario, with paths of its own; a layout is expected\n"),
        "{failed}"
    );
}

/// All lines of a run, in order.
fn sorted(text: &str) -> Vec<String> {
    let mut lines: Vec<String> = text.lines().skip(1).map(str::to_owned).collect();
    lines.sort();
    lines
}

#[test]
fn lines_say_what_the_table_says_and_that_they_are_all() {
    let arguments = ["locks", WAREHOUSE, "--radius", "0.4", "--nodes", "-q"];
    let table: Value = run(&[&arguments[..], &["--json"]].concat()).json();
    let lines = run(&[&arguments[..], &["--lines"]].concat()).ok();
    let lines: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let [head, locks @ .., end] = &lines[..] else { panic!("{lines:?}") };
    assert_eq!((&head["format"], &head["vehicle"]), (&json!("pcr-lock-lines"), &table["vehicle"]));
    assert_eq!(end, &json!({ "locks": locks.len() }));
    let list = |name: &str| table[name].as_array().unwrap().clone();
    let pairs = list("node_pairs").into_iter().map(|pair| json!({ "nodes": pair }));
    let expected: Vec<Value> = list("locks").into_iter().chain(list("nodes")).chain(pairs).collect();
    assert_eq!(locks, expected);
}

#[test]
fn an_edge_is_found_in_an_index_without_the_others() {
    let index = directory("locks").join("warehouse.locks");
    let index = index.to_str().unwrap();
    let arguments = ["locks", WAREHOUSE, "--radius", "0.4", "--nodes", "-q"];
    let written = run(&[&arguments[..], &["--index", index]].concat());
    assert_eq!((written.status, written.out.as_str()), (0, ""), "{}", written.err);
    let table: Value = run(&[&arguments[..], &["--json"]].concat()).json();
    let mut edges = 0;
    for edge in table["locks"].as_array().unwrap().iter().step_by(37).map(|lock| lock["a"].to_string()) {
        let of = |source: &[&str]| run(&[&["locks"], source, &["--edge", &edge, "--json"]].concat()).json();
        let [held, computed] = [of(&[index]), of(&arguments[1..])];
        let [held, computed] = [&held, &computed].map(|of| of["partners"].as_array().unwrap());
        assert_eq!(held.len(), computed.len(), "{edge}");
        let is = |id: &Value| format!("{id}") == edge;
        let own = |lock: &&Value| is(&lock["a"]) || is(&lock["b"]);
        let nodes = table["nodes"].as_array().unwrap().iter().filter(|lock| is(&lock["edge"])).count();
        assert_eq!(held.len(), table["locks"].as_array().unwrap().iter().filter(own).count() + nodes, "{edge}");
        for (held, computed) in held.iter().zip(computed) {
            assert_eq!((&held["name"], &held["node"]), (&computed["name"], &computed["node"]), "{edge}");
            for lengths in ["own", "other"] {
                let [[lo, hi], [exact_lo, exact_hi]] =
                    [held, computed].map(|of| [0, 1].map(|end| of[lengths][end].as_f64().unwrap()));
                // Rounded outward to seven digits.
                assert!(lo <= exact_lo && exact_lo - lo < 1e-5 && exact_hi <= hi && hi - exact_hi < 1e-5, "{held}");
            }
        }
        edges += 1;
    }
    assert!(edges > 10, "{edges}");
    let unknown = run(&["locks", index, "--edge", "nowhere"]).failed(2);
    assert!(unknown.ends_with("there is no edge nowhere; pcr nodes lists them\n"), "{unknown}");
    let again = run(&["locks", index]).failed(2);
    assert!(again.ends_with("this is a table of locks already; pcr locks reads it, with --edge\n"), "{again}");
}

#[test]
fn a_damaged_index_gives_no_answer() {
    let name = file("locks", "damaged.geojson", cross());
    let index = directory("locks").join("damaged.locks");
    let path = index.to_str().unwrap();
    assert_eq!(run(&["locks", &name, "--radius", "0.25", "--index", path, "-q"]).status, 0);
    let whole = std::fs::read(&index).unwrap();
    let asked = ["locks", path, "--edge", "7", "--format", "csv"];
    let answer = run(&asked).ok();
    assert_eq!(answer.lines().count(), 2);
    // What is reserved is covered by a checksum, too; the locks of the other edge are not read.
    let mut unread = 0;
    for byte in 0..whole.len() {
        let mut damaged = whole.clone();
        damaged[byte] ^= 0x10;
        std::fs::write(&index, damaged).unwrap();
        let run = run(&asked);
        unread += usize::from(run.out == answer);
        assert!(run.status == 2 || run.out == answer, "byte {byte}: {}", run.out);
    }
    assert_eq!(unread, 20);
    std::fs::write(&index, &whole[..whole.len() - 1]).unwrap();
    assert!(run(&asked).failed(2).contains("it is longer or shorter than its header says"));
}

#[test]
fn an_index_that_is_out_of_date_gives_no_answer() {
    let name = file("locks", "now.geojson", cross());
    let index = directory("locks").join("stale.locks");
    let path = index.to_str().unwrap();
    let of = |layout: &str, radius: &str| {
        run(&["locks", layout, "--radius", radius, "--index", path, "--edge", "7", "--json", "-q"])
    };
    assert_eq!(run(&["locks", &name, "--radius", "0.25", "--index", path, "-q"]).status, 0);
    let whole = std::fs::read(&index).unwrap();
    // What there is to be said of the layout is not in the file.
    let (asked, held) = (of(&name, "0.25").json(), run(&["locks", path, "--edge", "7", "--json"]).json());
    assert_eq!((&asked["partners"], &held["warnings"]), (&held["partners"], &json!([])));
    // Nor are its name and the vehicle.
    assert_eq!((&asked["layout"], &asked["vehicle"]["radius"]), (&json!("cross"), &json!(0.25)));
    assert!(held.get("layout").is_none() && held.get("vehicle").is_none(), "{held}");
    let stale = "it has the locks of another layout or vehicle; without --edge it is written anew";
    assert!(of(&name, "0.26").failed(2).contains(stale));
    // One node by a tenth of a micrometre.
    let moved = cross().replacen("-2.0", "-2.0000001", 1);
    assert_ne!(moved, cross());
    assert!(of(&file("locks", "moved.geojson", moved), "0.25").failed(2).contains(stale));
    // The version before this one, which did not say what it is of.
    let mut older = whole.clone();
    older[8] = 1;
    std::fs::write(&index, older).unwrap();
    assert!(of(&name, "0.25").failed(2).contains("version 1; known is 2"));
    // Cut anywhere.
    for length in 0..whole.len() {
        std::fs::write(&index, &whole[..length]).unwrap();
        let run = of(&name, "0.25");
        assert!(run.status == 2 && run.out.is_empty(), "{length} bytes: {}", run.out);
    }
    assert_eq!(run(&["locks", &name, "--radius", "0.25", "--index", path, "--json"]).status, 2);
}

#[test]
fn an_index_without_nodes_tells_nothing_about_them() {
    let name = file("locks", "no-nodes.geojson", cross());
    let index = directory("locks").join("no-nodes.locks");
    let of = |more: &[&str]| {
        run(&[&["locks", &name, "--radius", "0.25", "-q", "--index", index.to_str().unwrap()], more].concat())
    };
    assert_eq!(of(&[]).status, 0);
    let refused = of(&["--nodes", "--edge", "7"]).failed(2);
    assert!(
        refused.ends_with("it has no nodes, as it was written without --nodes; without --edge it is written anew\n"),
        "{refused}"
    );
    assert_eq!(of(&["--nodes"]).status, 0);
    let partners = of(&["--nodes", "--edge", "7", "--json"]).json()["partners"].clone();
    assert_eq!(partners.as_array().unwrap().iter().filter(|partner| partner["node"] == true).count(), 2);
}

/// Whether an edge is closed, or leads the other way, decides where an outline turns.
#[test]
fn an_index_of_an_edge_that_is_closed_or_turned_since_is_out_of_date() {
    let plant = |path: &str| {
        let text = format!(
            "<model name=\"p\"><point name=\"A\" positionX=\"0\" positionY=\"0\"/>\
             <point name=\"B\" positionX=\"4000\" positionY=\"0\"/><path name=\"7\" sourcePoint=\"A\" \
             destinationPoint=\"B\" length=\"4000\" {path}/></model>"
        );
        file("locks", "ways.xml", text)
    };
    let index = directory("locks").join("ways.locks");
    let of = |path: &str, more: &[&str]| {
        let layout = plant(path);
        run(&[&["locks", &layout, "--radius", "0.25", "-q", "--index", index.to_str().unwrap()], more].concat())
    };
    let forward = "maxVelocity=\"1000\" maxReverseVelocity=\"0\"";
    assert_eq!(of(forward, &[]).status, 0);
    assert_eq!(of(forward, &["--edge", "7"]).status, 0);
    for other in [&format!("{forward} locked=\"true\""), "maxVelocity=\"0\" maxReverseVelocity=\"1000\""] {
        let refused = of(other, &["--edge", "7"]).failed(2);
        assert!(refused.contains("it has the locks of another layout or vehicle"), "{refused}");
    }
}

#[test]
fn csv_beside_pictures_is_the_same_as_without() {
    let name = file("locks", "csv.geojson", cross());
    let of = |more: &[&str]| {
        run(&[&["locks", &name, "--radius", "0.25", "--nodes", "--format", "csv", "-q"], more].concat()).ok()
    };
    let folder = directory("locks").join("csv");
    assert_eq!(of(&["-o", folder.to_str().unwrap()]), of(&[]));
}

#[test]
fn rotation_without_acceleration_is_refused_of_delays() {
    let name = file("locks", "rotation.geojson", cross());
    for option in ["--rotation", "--rotation-acceleration"] {
        let delays = ["locks", &name, "--radius", "0.25", "-q", "--delays", "--speed", "1", option, "0.5"];
        let refused = run(&delays).failed(2);
        assert!(refused.contains(&format!("{option} has no effect without --acceleration")), "{refused}");
        assert_eq!(run(&[&delays[..], &["--acceleration", "1"]].concat()).status, 0);
    }
}

/// A roadmap as Continuous-CBS has them, each way in both directions: a lattice with diagonals, not all of it even.
fn roadmap(side: usize) -> String {
    let mut text = String::from("<graphml><graph edgedefault=\"directed\">");
    let node = |x: usize, y: usize| x * side + y;
    for (x, y) in (0..side * side).map(|k| (k / side, k % side)) {
        let shift = ((7 * x + 3 * y) % 5) as f64 * 0.1;
        text += &format!("<node id=\"n{}\"><data>{},{}</data></node>", node(x, y), x as f64 + shift, y as f64 - shift);
    }
    let mut count = 0;
    for (x, y) in (0..side * side).map(|k| (k / side, k % side)) {
        for (to_x, to_y) in [(x + 1, y), (x, y + 1), (x + 1, y + 1)] {
            if to_x < side && to_y < side {
                for (from, to) in [(node(x, y), node(to_x, to_y)), (node(to_x, to_y), node(x, y))] {
                    text += &format!("<edge id=\"e{count}\" source=\"n{from}\" target=\"n{to}\"/>");
                    count += 1;
                }
            }
        }
    }
    text + "</graph></graphml>"
}

#[test]
fn both_directions_of_a_way_have_the_same_locks() {
    let roadmap = file("locks", "roadmap.xml", roadmap(6));
    let csv = run(&["locks", &roadmap, "--radius", "0.2", "--format", "csv"]).ok();
    let lines = sorted(&csv);
    assert!(lines.windows(2).all(|pair| pair[0] != pair[1]) && lines.len() > 1500, "{}", lines.len());
    let mut of: std::collections::BTreeMap<u32, Vec<(u32, [f64; 2])>> = std::collections::BTreeMap::new();
    for line in &lines {
        let cells: Vec<&str> = line.split(',').collect();
        let [a, b] = [cells[0], cells[1]].map(|name| name[1..].parse::<u32>().unwrap());
        let number = |k: usize| cells[k].parse::<f64>().unwrap();
        of.entry(a).or_default().push((b, [number(2), number(3)]));
        of.entry(b).or_default().push((a, [number(4), number(5)]));
    }
    for there in (0..of.len() as u32).step_by(2) {
        let partners = |edge: u32| {
            let others = of[&edge].iter().filter(|(other, _)| other / 2 != edge / 2);
            let mut others: Vec<(u32, [f64; 2])> = others.copied().collect();
            others.sort_by(|a, b| a.0.cmp(&b.0).then(a.1[0].total_cmp(&b.1[0])));
            others
        };
        let (ahead, back) = (partners(there), partners(there + 1));
        let length = of[&there].iter().find(|(other, _)| other / 2 == there / 2).unwrap().1[1];
        assert_eq!(ahead.len(), back.len());
        for ((other, [from, to]), (same, [back_from, back_to])) in ahead.iter().zip(&back) {
            assert_eq!(other, same);
            assert!((from + back_to - length).abs() < 1e-9 && (to + back_from - length).abs() < 1e-9, "e{there}");
        }
    }
}

/// Unsafe delays of a cross, whose closed form is R √2 at the same distance from the crossing.
#[test]
fn delays_are_those_of_the_closed_form_in_every_form() {
    let name = file("locks", "delays.geojson", cross());
    let arguments = ["locks", &name, "--radius", "0.25", "--delays", "--speed", "1", "--nodes", "-q"];
    let table = run(&[&arguments[..], &["--json"]].concat()).json();
    assert_eq!((&table["format"], &table["speed"]), (&json!("pcr-delays"), &json!(1.0)));
    let delays = table["delays"].as_array().unwrap();
    let pairs: Vec<_> = delays.iter().map(|delay| (delay["a"].clone(), delay["b"].clone())).collect();
    assert_eq!(pairs, [(json!(7), json!(7)), (json!(7), json!(20)), (json!(20), json!(20))]);
    for (delay, half) in delays.iter().zip([0.5, 0.5 * 2.0_f64.sqrt(), 0.5]) {
        let [lo, hi] = [0, 1].map(|end| delay["delay"][end].as_f64().unwrap());
        assert!(lo <= -half && -half - lo < 1e-12 && half <= hi && hi - half < 1e-12, "{delay}");
    }
    assert_eq!(table["nodes"].as_array().unwrap().len(), 4);
    let lines = run(&[&arguments[..], &["--lines"]].concat()).ok();
    let lines: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let [head, found @ .., end] = &lines[..] else { panic!("{lines:?}") };
    assert_eq!((&head["format"], end), (&json!("pcr-delay-lines"), &json!({ "delays": found.len() })));
    for list in ["delays", "nodes"] {
        assert!(table[list].as_array().unwrap().iter().all(|entry| found.contains(entry)), "{found:?}");
    }
    let csv = run(&[&arguments[..], &["--format", "csv"]].concat()).ok();
    assert!(csv.starts_with("a,a_direction,b,b_direction,from,to\n7,forward,7,forward,-0.5"), "{csv}");
    assert_eq!(csv.lines().count(), 1 + found.len());
    let text = run(&arguments[..8]).ok();
    let expected = "\
delays: 3 intervals of unsafe delays, radius 0.25 m, at 1 m/s
  a   b   b later by [s]     to
  7   7           -0.500  0.500
  7   20          -0.708  0.708
  20  20          -0.500  0.500
4 intervals of times at nodes
  node  edge  from [s]     to
  3     7        0.000  0.500
";
    assert!(text.replacen("cross", "delays", 1).starts_with(expected), "{text}");
}

#[test]
fn all_other_delays_are_proved_on_request() {
    let name = file("locks", "proved.geojson", cross());
    let arguments = ["locks", &name, "--radius", "0.25", "--delays", "--speed", "1"];
    let counts =
        |table: &Value| ["pairs", "proved", "refuted", "undecided"].map(|of| table["certificate"][of].as_u64());
    for driving in [&[][..], &["--acceleration", "0.5", "--rotation", "1", "--rotation-acceleration", "1"]] {
        let all = [&arguments[..], driving, &["--certify"]].concat();
        let proved = run(&[&all[..], &["--json", "-q"]].concat());
        assert_eq!(proved.status, 0, "{}", proved.err);
        let table = proved.json();
        assert_eq!((&table["certificate"]["verdict"], counts(&table)), (&json!("proved"), [3, 3, 0, 0].map(Some)));
        assert!(table["certificate"].get("open").is_none(), "{table}");
        // Nothing else changes, and nothing is proved without the option.
        let mut plain = run(&[&arguments[..], driving, &["--json", "-q"]].concat()).json();
        assert!(plain.get("certificate").is_none());
        plain["certificate"] = table["certificate"].clone();
        assert_eq!(plain, table);
        let text = run(&all).ok();
        let line = "certificate: no contact at any other delay, proved (3 pairs of edges)";
        assert_eq!(text.lines().last(), Some(line), "{text}");
    }
    let csv = run(&[&arguments[..], &["--certify", "--format", "csv"]].concat()).failed(2);
    assert!(csv.contains("--certify is for --format json and table"), "{csv}");
}

#[test]
fn delays_need_a_speed_and_locks_none() {
    let name = file("locks", "speedless.geojson", cross());
    let none = run(&["locks", &name, "--radius", "0.25", "--delays"]).failed(2);
    assert!(none.contains("--delays are of one speed: say which, --speed"), "{none}");
    let vain = run(&["locks", &name, "--radius", "0.25", "--speed", "1"]).failed(2);
    assert!(vain.contains("--speed has no effect: locks are of all ways of a vehicle, at any speed"), "{vain}");
    let outline = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/small/factsheet.json");
    let certified = ["locks", &name, "--fleet", outline, "--delays", "--speed", "1", "--certify", "--json", "-q"];
    let table = run(&certified).json();
    // On a lane of its own the outline of 1.9 m has to be its length behind the other one.
    let row = table["delays"].as_array().unwrap().iter().find(|row| row["a"] == row["b"]).unwrap();
    let after = row["delay"][1].as_f64().unwrap();
    assert!((1.9..1.9 + 1e-6).contains(&after) && table["certificate"]["verdict"] == "proved", "{table}");
    // From rest to rest it takes longer over the crossing's ends, and no less far.
    let arguments = ["locks", &name, "--radius", "0.25", "--delays", "--speed", "1", "--json", "-q"];
    let slow = run(&[&arguments[..], &["--acceleration", "0.5"]].concat()).json();
    let width = |table: &Value| table["delays"][0]["delay"][1].as_f64().unwrap();
    assert!(width(&slow) > width(&run(&arguments).json()), "{slow}");
}

/// A line that is left out of a path because it is so short that its direction may be rounding takes time from rest to rest.
#[test]
fn delays_of_the_shortest_edges_are_as_long_as_they_take() {
    for (length, acceleration) in [("1e-7", "1e-4"), ("1e-9", "1e-6"), ("0.9e-6", "1"), ("1.1e-6", "1")] {
        let road = format!(
            r#"<road id="3" length="{length}"><planView><geometry x="0" y="0" hdg="0" length="{length}"><line/></geometry></planView></road>"#
        );
        let name = file("locks", "shortest.xodr", format!("<OpenDRIVE><header/>{road}</OpenDRIVE>"));
        let arguments = ["locks", &name, "--radius", "0.25", "--delays", "--speed", "1", "--nodes", "--json", "-q"];
        let table = run(&[&arguments[..], &["--acceleration", acceleration]].concat()).json();
        let numbers = [length, acceleration].map(|text| text.parse::<f64>().unwrap());
        let takes = 2.0 * (numbers[0] / numbers[1]).sqrt();
        let delays = table["delays"].as_array().unwrap();
        assert_eq!(delays.len(), 3, "{table}");
        let ends = |entry: &Value, list: &str| [0, 1].map(|end| entry[list][end].as_f64().unwrap());
        for delay in delays {
            let [lo, hi] = ends(delay, "delay");
            assert!(lo <= -takes && takes <= hi && hi - lo < 2.0 * takes + 1e-6, "{length}: {delay}");
        }
        let nodes = table["nodes"].as_array().unwrap();
        assert_eq!(nodes.len(), 4, "{table}");
        for time in nodes {
            let [lo, hi] = ends(time, "time");
            assert!(lo <= 0.0 && takes <= hi && hi < takes + 1e-6, "{length}: {time}");
        }
    }
}

#[cfg(unix)]
#[test]
fn a_table_of_its_own_form_is_not_written_to_a_device() {
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/aws_graph.geojson");
    let message = run(&["locks", layout, "--radius", "0.3", "-q", "--index", "/dev/null"]).failed(2);
    let why = "this is written and read at many places, which a pipe or a device is not";
    assert_eq!(message, format!("pcr: /dev/null: {why}\n"));
}
