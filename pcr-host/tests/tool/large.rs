//! Fleets beyond what a table numbers, and beyond what memory holds.

use crate::fixture::{directory, file, run, straight};
use serde_json::json;
use std::process::Command;

/// Discs that stand, so many metres apart.
fn discs(count: usize, apart: f64) -> String {
    let side = (count as f64).sqrt().ceil() as usize;
    let agent = |k: usize| {
        let (x, y) = ((k % side) as f64 * apart, (k / side) as f64 * apart);
        json!({ "id": k + 1, "radius": 0.3, "v_max": 1, "a_max": 1, "start": { "x": x, "y": y, "heading": 0 }, "path": [] })
    };
    json!({ "agents": (0..count).map(agent).collect::<Vec<_>>() }).to_string()
}

#[test]
fn more_agents_than_a_table_numbers_are_answered() {
    let name = file("large", "discs.json", discs(70_000, 3.0));
    assert_eq!(run(&["regions", &name, "--format", "csv"]).ok().lines().count(), 1);
    assert_eq!(run(&["check", &name]).ok(), "discs: no conflicts, 70000 agents\n");
}

/// Pairs of agents that cross, 8 m apart.
fn crossings(pairs: usize) -> String {
    let agent = |k: usize| {
        let (x, y, north) = ((k / 2 % 100) as f64 * 8.0, (k / 200) as f64 * 8.0, k % 2 == 1);
        let [x, y, heading] = if north { [x, y - 2.0, std::f64::consts::FRAC_PI_2] } else { [x - 2.0, y, 0.0] };
        straight(k as u64 + 1, [x, y, heading], 4.0)
    };
    json!({ "agents": (0..2 * pairs).map(agent).collect::<Vec<_>>() }).to_string()
}

#[test]
fn large_fleets_are_certified_by_those_that_come_near() {
    // More than a table numbers; nobody comes near anybody.
    let name = file("large", "certified.json", discs(70_000, 3.0));
    let proved = run(&["certify", &name, "--json"]).json();
    assert_eq!(
        [&proved["verdict"], &proved["discs"], &proved["pieces"]],
        [&json!("proved"), &json!(70_000), &json!(0)]
    );
    // The pairs and no others are looked at: the work grows with the fleet, not with its square.
    let name = file("large", "crossings.json", crossings(2_000));
    let proved = run(&["certify", &name, "--json"]).json();
    assert_eq!([&proved["verdict"], &proved["segment_pairs"]], [&json!("proved"), &json!(2_000)]);
}

#[test]
fn of_large_fleets_the_maps_are_drawn_that_are_asked_for() {
    let name = file("large", "maps.json", crossings(1_001));
    let maps = directory("large").join("maps");
    let _ = std::fs::remove_dir_all(&maps);
    let folder = maps.to_str().unwrap();
    let message = run(&["map", &name, "-o", folder]).failed(2);
    assert!(message.contains("without --agent, maps are drawn for 2000 agents at most; there are 2002"), "{message}");
    assert!(!maps.exists());
    let plan = run(&["plan", &name, "--pictures", folder]).failed(2);
    assert!(plan.contains("maps are drawn for 2000 agents at most; there are 2002"), "{plan}");
    let layout = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/warehouse_graph.geojson");
    let traffic = run(&["traffic", layout, "--radius", "0.4", "-q", "--agents", "2001", "-o", folder]).failed(2);
    assert!(traffic.contains("maps are drawn for 2000 agents at most; there are 2001"), "{traffic}");
    assert!(!maps.exists());
    let said = run(&["map", &name, "--agent", "401", "--agent", "7", "-o", folder]).ok();
    let mut drawn: Vec<String> = std::fs::read_dir(&maps)
        .unwrap()
        .map(|file| file.unwrap().file_name().into_string().unwrap())
        .filter(|file| file.ends_with(".svg") && file.starts_with("ecm"))
        .collect();
    drawn.sort();
    assert_eq!(drawn, ["ecm-401.svg", "ecm-7.svg"], "{said}");
    // With those whom they meet, and nobody else.
    let page = std::fs::read_to_string(maps.join("index.html")).unwrap();
    for (there, id) in [(true, 401), (true, 402), (true, 7), (true, 8), (false, 9), (false, 1)] {
        assert_eq!(page.contains(&format!("\"id\":\"{id}\"")), there, "{id}");
    }
    let message = run(&["map", &name, "--agent", "5000", "-o", folder]).failed(2);
    assert!(message.contains("no agent 5000"), "{message}");
}

/// Runs with so much address space \[kB\].
#[cfg(target_os = "linux")]
fn limited(kilobytes: u32, arguments: &[&str]) -> (Option<i32>, String) {
    let script = format!("ulimit -v {kilobytes}; exec \"$0\" \"$@\" > /dev/null");
    let output = Command::new("bash")
        .args(["-c", &script, env!("CARGO_BIN_EXE_pcr")])
        .args(arguments)
        // Each thread takes addresses.
        .env("RAYON_NUM_THREADS", "2")
        .output()
        .unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[cfg(target_os = "linux")]
#[test]
fn what_memory_does_not_hold_is_refused_with_a_number() {
    let heap = file("large", "heap.json", discs(600, 0.001));
    for (limit, arguments) in [(400_000, &["regions", &heap][..]), (300_000, &["check", &heap])] {
        let (status, message) = limited(limit, arguments);
        assert_eq!(status, Some(2), "{arguments:?}: {message}");
        let number = message.contains(" MB ") && message.starts_with("pcr: ");
        assert!(number, "{arguments:?}: {message}");
    }
    // By the status alone, nothing is held.
    assert_eq!(limited(200_000, &["check", &heap, "-q"]), (Some(1), String::new()));
    let (many, large) =
        (file("large", "many.json", discs(40_000, 3.0)), file("large", "pile.json", discs(2_000, 0.001)));
    for (limit, arguments) in [
        (60_000, &["check", &many][..]),
        (150_000, &["plan", &many]),
        (200_000, &["compare", &many, "--rounds", "1", "--method", "polyline"]),
        (300_000, &["check", &large, "--closest", "--json"]),
        (460_000, &["check", &large, "--certify", "--json"]),
    ] {
        let (status, message) = limited(limit, arguments);
        let number = message.contains(" MB ") && message.starts_with("pcr: ");
        assert!(status == Some(2) && number, "{arguments:?}: {status:?} {message}");
    }
    // Wherever the limit is, there is an answer or a number.
    let building = file("large", "large.building.yaml", lanes(20_000));
    for (arguments, limits) in
        [(["check", &many, "-q"], 50_000..140_000), (["nodes", &building, "-q"], 120_000..400_000)]
    {
        let (mut answered, mut refused) = (0, 0);
        for limit in limits.step_by(10_000) {
            match limited(limit, &arguments) {
                (Some(0), _) => answered += 1,
                (Some(2), message) if message.contains(" MB of memory; ") => refused += 1,
                (status, message) => panic!("{arguments:?} {limit}: {status:?} {message}"),
            }
        }
        assert!(answered > 0 && refused > 0, "{arguments:?}: {answered} {refused}");
    }
    // Who has none is told before an allocation fails, whose message is not ours.
    let (status, message) = limited(60_000, &["demo", "--scenario"]);
    assert!(status == Some(0) && message.starts_with("pcr: warning: hardly any memory is left"), "{message}");
    // Row by row it fits.
    let (status, message) = limited(400_000, &["regions", &heap, "--format", "csv"]);
    assert_eq!((status, message.as_str()), (Some(0), ""));
}

/// A building with so many lanes, one after the other.
#[cfg(target_os = "linux")]
fn lanes(count: usize) -> String {
    use std::fmt::Write;
    let mut text =
        "name: large\ncoordinate_system: cartesian_meters\nlevels:\n  L1:\n    elevation: 0\n    vertices:\n"
            .to_owned();
    for k in 0..=count {
        writeln!(text, "      - [{k}, 0, 0, v{k}]").unwrap();
    }
    text.push_str("    lanes:\n");
    for k in 0..count {
        writeln!(text, "      - [{k}, {}, {{bidirectional: [4, true], graph_idx: [2, 0], mutex: [1, \"\"]}}]", k + 1)
            .unwrap();
    }
    text
}

/// A path of so many segments that crosses a line again and again.
fn comb(segments: usize) -> String {
    let turn = |sweep: f64| json!({ "kind": "arc", "radius": 0.5, "sweep": sweep });
    let piece = |k: usize| match k % 4 {
        1 => turn(std::f64::consts::PI),
        3 => turn(-std::f64::consts::PI),
        _ => json!({ "kind": "line", "length": 4 }),
    };
    let agent = |id: u64, x: f64, y: f64, heading: f64, path: serde_json::Value| json!({ "id": id, "radius": 0.3, "v_max": 1, "a_max": 1, "start": { "x": x, "y": y, "heading": heading }, "path": path });
    let north = std::f64::consts::FRAC_PI_2;
    let path = (0..segments).map(piece).collect::<Vec<_>>();
    let line = json!([{ "kind": "line", "length": segments / 2 + 3000 }]);
    json!({ "agents": [agent(1, -2.0, 0.0, 0.0, path.into()), agent(2, 0.0, -10.0, north, line)] }).to_string()
}

/// Each crossing is looked for among the pieces of its own two segments.
#[test]
fn a_path_that_crosses_another_ten_thousand_times_has_each_crossing_in_its_region() {
    let name = file("large", "comb.json", comb(20_001));
    let csv = run(&["regions", &name, "--format", "csv"]).ok();
    let mut rows = [0, 0];
    for line in csv.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        assert_eq!(fields[10], "1", "one crossing: {line}");
        rows[fields[1].parse::<usize>().unwrap() - 1] += 1;
    }
    // Every second segment is a line, and crosses.
    assert_eq!(rows, [10_001, 10_001]);
}

#[cfg(target_os = "linux")]
#[test]
fn whatever_memory_there_is_every_command_ends_with_a_reason() {
    let heap = file("limits", "heap.json", discs(200, 0.001));
    let many = file("limits", "many.json", discs(4_000, 3.0));
    let comb = file("limits", "comb.json", comb(1_000));
    let site = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/warehouse_graph.geojson");
    let maps = directory("limits").join("maps").to_str().unwrap().to_owned();
    // Below the first one the system does not load the program.
    let least = (0..60).map(|step| 8_000 + 4_000 * step).find(|&limit| limited(limit, &["--version"]).0 == Some(0));
    let least = least.unwrap();
    let (mut refused, mut done) = (0, 0);
    for more in [0, 1_000, 3_000, 6_000, 12_000, 24_000, 60_000, 200_000] {
        for arguments in [
            &["check", &many][..],
            &["regions", &heap, "--json"],
            &["plan", &many],
            &["plan", &heap],
            &["map", &comb, "-o", &maps],
            &["certify", &heap],
            &["locks", site, "--radius", "0.4"],
        ] {
            let (status, message) = limited(least + more, arguments);
            match status {
                Some(0 | 1) => done += 1,
                Some(2) => {
                    refused += 1;
                    assert!(!message.is_empty(), "{arguments:?} with {} kB", least + more);
                }
                _ => panic!("{arguments:?} with {} kB: {status:?}: {message}", least + more),
            }
        }
    }
    assert!(refused > 5 && done > 5, "{refused} refused, {done} done");
}

#[test]
fn what_is_nested_too_deep_is_refused() {
    for (name, begin, again) in [
        ("nested.json", "", "["),
        ("agents.json", "", "{\"agents\":"),
        ("nested.xodr", "<OpenDRIVE>", "<a>"),
        ("nested.building.yaml", "levels: ", "["),
        ("flow.building.yaml", "levels: ", "{a: "),
        ("nested.geojson", "{\"type\":\"FeatureCollection\",\"features\":", "["),
    ] {
        let name = file("nested", name, begin.to_owned() + &again.repeat(100_000));
        for command in ["check", "plan", "locks"] {
            let _ = run(&[command, &name]).failed(2);
        }
    }
}
