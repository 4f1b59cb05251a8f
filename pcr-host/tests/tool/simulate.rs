//! `pcr simulate`: outputs, the page, refusals.

use crate::fixture::{column, crossing, directory, file, run, straight};
use serde_json::json;

/// The controllers, in the order of their runs.
const CONTROLLERS: &[&str] = &["pcr", "potential", "orca"];

#[test]
fn a_crossing_is_simulated_under_every_controller() {
    let name = file("simulate", "crossing.json", crossing().to_string());
    let page = directory("simulate").join("replay.html");
    let arguments = ["simulate", &name, "--seed", "5", "--format", "json", "-o", page.to_str().unwrap()];
    let result = run(&arguments);
    assert_eq!((result.status, result.err.as_str()), (0, ""));
    let simulation = result.json();
    assert_eq!((&simulation["name"], &simulation["seed"]), (&json!("crossing"), &json!(5)));
    let runs = simulation["runs"].as_array().unwrap();
    let controllers: Vec<&str> = runs.iter().filter_map(|run| run["controller"].as_str()).collect();
    assert_eq!(controllers, CONTROLLERS);
    let pcr = &runs[0];
    assert_eq!((&pcr["done"], &pcr["not_done"], &pcr["collisions"]), (&json!(2), &json!(0), &json!([])));

    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.starts_with("<!DOCTYPE html>") && page.contains("default-src 'none'"));
    for request in ["src=", "href=", "@import", "url(", "fetch(", "import(", "http:", "https:"] {
        assert!(!page.contains(request), "{request}");
    }
    let (_, data) = page.split_once(r#"<script type="application/json" id="data">"#).unwrap();
    let data: serde_json::Value = serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap();
    let track = data["runs"][0]["tracks"][0].as_array().unwrap();
    assert_eq!(track[..2], [json!(-20000), json!(0)]);
    assert!(data["runs"][0]["plans"][0]["maps"][0]["regions"][0]["outline"][0].as_array().unwrap().len() > 10);
}

#[test]
fn one_controller_as_table_and_as_csv() {
    let name = file("simulate", "one.json", crossing().to_string());
    let table = run(&["simulate", &name, "--controller", "pcr"]).ok();
    assert!(table.starts_with("crossing: seed 1,") && table.contains("\n  pcr ") && !table.contains("orca"), "{table}");
    let csv = run(&["simulate", &name, "--controller", "potential", "--format", "csv"]).ok();
    assert!(csv.starts_with("name,controller,id,begin,end,unimpeded,waiting,label\ncrossing,potential,1,0,"), "{csv}");
    assert_eq!(csv.lines().count(), 3);
}

#[test]
fn settings_out_of_range_are_refused() {
    for (option, value, allowed) in [
        ("--noise", "-0.1", "0 to 10"),
        ("--noise", "nan", "0 to 10"),
        ("--replan", "0", "0.05 to 3600"),
        ("--slip", "0.91", "0 to 0.9"),
        ("--delay", "inf", "0 to 3600"),
        ("--drift", "11", "0 to 10"),
    ] {
        let refused = run(&["simulate", &format!("{option}={value}")]);
        assert_eq!((refused.status, refused.out.as_str()), (2, ""));
        let expected = format!("error: invalid value '{value}' for '{option} ");
        assert!(refused.err.starts_with(&expected), "{}", refused.err);
        assert!(refused.err.contains(&format!(": a number from {allowed} is expected\n")), "{}", refused.err);
    }
    for (option, value) in [("--trips", "0"), ("--noise", "much"), ("--seed", "-1"), ("--controller", "none")] {
        let refused = run(&["simulate", &format!("{option}={value}")]);
        assert!(refused.status == 2 && refused.err.contains(option), "{}", refused.err);
    }
}

#[test]
fn what_is_wrong_with_a_scenario_is_said_as_elsewhere() {
    let mut scenario = crossing();
    scenario["agents"][1]["radius"] = json!(-1);
    let name = file("simulate", "wrong.json", scenario.to_string());
    let column = column(&scenario, "/agents/1/radius");
    let expected =
        format!("pcr: {name}:1:{column}: agent 2, radius: -1 is out of range; allowed is above 0, up to 1e10\n");
    assert_eq!(run(&["simulate", &name]).failed(2), expected);
    scenario["agents"][1]["radius"] = json!(0.2);
    scenario["agents"][1]["t_start"] = json!(1e6);
    let name = file("simulate", "late.json", scenario.to_string());
    let expected =
        format!("pcr: {name}: agent 2, t_start: a simulation is of 10000 s at most until the last one sets off\n");
    assert_eq!(run(&["simulate", &name]).failed(2), expected);
}

/// It was driven from rest with the least of accelerations, for hours or without end.
#[test]
fn a_profile_that_is_under_way_is_sped_up_within_its_duration() {
    let rolls = |accel: f64| {
        let piece = |accel: f64| json!({ "duration": 2.0, "accel": accel });
        let profile = json!({ "v0": 0.5, "pieces": [piece(accel), piece(-accel)] });
        let agents = json!([{ "id": 1, "radius": 0.3, "start": { "x": 0, "y": 0, "heading": 0 }, "profile": profile,
            "path": [{ "kind": "line", "length": 2.0 }] }]);
        let name = file("simulate", "rolls.json", json!({ "agents": agents }).to_string());
        let simulated = run(&["simulate", &name, "--controller", "pcr", "--json", "-q"]).json();
        let warning = simulated["warnings"][0].as_str().unwrap_or_default().to_owned();
        assert!(
            warning.starts_with("agent 1: its own motion takes 4.000 s; it is simulated from rest to rest"),
            "{warning}"
        );
        warning
    };
    for accel in [1e-7, 1e-17, 1e-300] {
        assert!(rolls(accel).ends_with("by which it takes 8.000 s [replaced-motion]"), "{accel}");
    }
    assert!(rolls(0.0).ends_with("by which it takes 5.000 s [replaced-motion]"));
    let mut far = crossing();
    far["agents"][0]["a_max"] = json!(1e-12);
    let name = file("simulate", "far.json", far.to_string());
    let expected = format!(
        "pcr: {name}: agent 1: alone and from rest to rest it takes longer than 100000 s, the most for a simulation\n"
    );
    assert_eq!(run(&["simulate", &name]).failed(2), expected);
}

/// They were taken for 0, so that the robots set off at once.
#[test]
fn negative_starts_keep_their_distance_in_time() {
    let runs = |by: f64| {
        let mut scenario = crossing();
        for (agent, start) in [(0, 0.0), (1, 2.5)] {
            scenario["agents"][agent]["t_start"] = json!(start + by);
        }
        let name = file("simulate", "early.json", scenario.to_string());
        let mut report = run(&["simulate", &name, "--controller", "potential", "--json", "-q"]).json();
        (report["runs"].take(), report["warnings"].take())
    };
    let ((early, warned), (late, silent)) = (runs(-100.0), runs(0.0));
    assert_eq!(early, late);
    assert_eq!(
        (warned, silent),
        (
            json!(["the first agent sets off at -100 s; times of the simulation count from there [shifted-times]"]),
            json!([])
        )
    );
    // Times since 1970 were refused.
    let (since_1970, warned) = runs(1.7e9);
    assert_eq!(since_1970, late);
    assert_eq!(
        warned[0],
        "the first agent sets off at 1700000000 s; times of the simulation count from there [shifted-times]"
    );
}

/// Agents that never move are no robots, so that no run counts their contacts.
#[test]
fn agents_that_stand_in_contact_are_warned_about() {
    let stands = |id: u64, [x, y]: [f64; 2], radius: f64| {
        let start = json!({ "x": x, "y": y, "heading": 0 });
        json!({ "id": id, "radius": radius, "v_max": 2, "a_max": 4, "start": start, "path": [] })
    };
    let agents = json!([stands(3, [0.5, -1.0], 0.1), stands(2, [2.0, -1.0], 0.5), stands(1, [0.5, 0.0], 1.0)]);
    let name = file("simulate", "heap.json", json!({ "agents": agents }).to_string());
    let result = run(&["simulate", &name, "--json"]);
    assert_eq!(result.status, 0);
    assert_eq!(result.err, format!("pcr: warning: {name}: agents 1 and 3 stand in contact [standing-contact]\n"));
    let simulation: serde_json::Value = serde_json::from_str(&result.out).unwrap();
    assert_eq!(simulation["warnings"], json!(["agents 1 and 3 stand in contact [standing-contact]"]));
    // They just touch.
    let agents = json!([stands(1, [0.0, 0.0], 0.5), stands(2, [1.0, 0.0], 0.5)]);
    let name = file("simulate", "touch.json", json!({ "agents": agents }).to_string());
    assert_eq!(run(&["simulate", &name, "--json"]).json()["warnings"], json!([]));
    // Of a heap only some are named.
    let agents: Vec<_> = (0..10).map(|id| stands(id, [0.0, 0.0], 0.5)).collect();
    let name = file("simulate", "many.json", json!({ "agents": agents }).to_string());
    let said = run(&["simulate", &name, "--controller", "potential"]).err;
    assert!(
        said.lines().count() == 1
            && said.ends_with("stand in contact [standing-contact] and 16 more; --warnings all\n"),
        "{said}"
    );
    let said = run(&["simulate", &name, "--controller", "potential", "--warnings", "all"]).err;
    let last = ": 29 more pairs of agents stand in contact [standing-contact]\n";
    assert!(said.lines().count() == 17 && said.ends_with(last), "{said}");
}

#[test]
fn margins_are_no_part_of_those_that_stand() {
    let stands = json!({ "id": 1, "radius": 0.5, "margin": 0.3, "v_max": 1, "a_max": 1, "path": [], "start": { "x": 0, "y": 0, "heading": 0 } });
    let goes = json!({ "id": 2, "radius": 0.5, "v_max": 1, "a_max": 1, "path": [{ "kind": "line", "length": 3 }],
        "start": { "x": 1.2, "y": 0, "heading": 0 } });
    let name = file("simulate", "margin.json", json!({ "agents": [stands, goes] }).to_string());
    for controller in CONTROLLERS.iter().copied().filter(|name| *name != "potential") {
        // It stands within the margin, so that the supervisor has no plan, and says so by its status.
        let said = run(&["simulate", &name, "--controller", controller, "--json"]);
        assert_eq!(said.status, i32::from(controller == "pcr"));
        let run = &serde_json::from_str::<serde_json::Value>(&said.out).unwrap()["runs"][0];
        assert_eq!(run["collisions"], json!([]), "{controller}");
        let clearance = run["clearance"].as_f64().unwrap();
        assert!((clearance - 0.2).abs() < 0.02, "{controller}: {clearance}");
    }
}

#[test]
fn who_goes_straight_to_the_end_has_nothing_to_do_on_a_circle_and_that_is_told() {
    let circle = json!({ "id": 1, "radius": 0.2, "v_max": 1, "a_max": 1, "path": [{ "kind": "arc", "radius": 1, "sweep": std::f64::consts::TAU }],
        "start": { "x": 0, "y": 0, "heading": 0 } });
    let name = file("simulate", "circle.json", json!({ "agents": [circle] }).to_string());
    let expected = [("pcr", 7.2, false), ("orca", 5.0, false), ("potential", 0.0, true)];
    for (controller, least, told) in expected.into_iter().filter(|(name, ..)| CONTROLLERS.contains(name)) {
        let said = run(&["simulate", &name, "--controller", controller, "--json"]);
        assert_eq!(said.err.contains("agent 1: its path ends where it begins"), told, "{controller}: {}", said.err);
        let run = &serde_json::from_str::<serde_json::Value>(&said.out).unwrap()["runs"][0];
        assert!(run["done"] == 1 && run["travel"].as_f64().unwrap() >= least, "{controller}: {run}");
    }
}

#[test]
fn a_turn_in_place_at_the_end_is_over_when_the_mission_is_done() {
    let turn = json!({ "kind": "turn", "sweep": 3 });
    // Alone, a turn of 3 rad takes 3 s and a second of ramps; a line of 3 m takes as long.
    for (path, unimpeded) in [(json!([turn]), 4.0), (json!([{ "kind": "line", "length": 3 }, turn]), 8.0)] {
        let agent = json!({ "id": 1, "radius": 0.3, "v_max": 1, "a_max": 1, "turn_v_max": 1, "turn_a_max": 1, "path": path,
            "start": { "x": 0, "y": 0, "heading": 0 } });
        let name = file("simulate", "turn.json", json!({ "agents": [agent] }).to_string());
        let run = &run(&["simulate", &name, "--controller", "pcr", "--json"]).json()["runs"][0];
        assert_eq!((&run["done"], &run["ended"], run.get("waiting_for")), (&json!(1), &json!("done"), None), "{run}");
        let told = run["unimpeded"].as_f64().unwrap();
        assert!((told - unimpeded).abs() < 1e-6, "{told}");
    }
}

/// The plan leads past one that stands with less room than two robots need that are not quite on their paths.
#[test]
fn room_that_is_missing_is_told_with_what_would_do() {
    for beside in [0.5041, 0.5025] {
        let stands = json!({ "id": 2, "radius": 0.25, "v_max": 1, "a_max": 1, "start": { "x": 0.0, "y": beside, "heading": 0.0 }, "path": [] });
        let scenario = json!({ "agents": [straight(1, [-2.0, 0.0, 0.0], 4.0), stands] });
        let name = file("simulate", "beside.json", scenario.to_string());
        let ask = ["simulate", &name, "--controller", "pcr"];
        let first_run = |more: &[&str]| {
            let answer = run(&[&ask[..], &["--json", "-q"], more].concat()).out;
            serde_json::from_str::<serde_json::Value>(&answer).unwrap()["runs"][0].clone()
        };
        let waiting = first_run(&[])["waiting_for"][0].clone();
        assert_eq!((&waiting["id"], &waiting["by"]), (&json!(1), &json!(2)), "{waiting}");
        let number = |key: &str| waiting["clearance"][key].as_f64().unwrap();
        let (free, needed) = (number("free"), number("needed"));
        assert!((free - (beside - 0.5)).abs() < 1e-5 && needed >= 0.005, "{waiting}");
        let told = run(&ask).out;
        assert!(told.contains("pcr: 1 never set off, as 2 stands too near its way: 0.00"), "{told}");
        // With the drift that is named it arrives, and with a little more it does not.
        let drift = number("drift");
        let with = |drift: f64| first_run(&["--drift", &format!("{drift:.6}")])["done"].clone();
        assert_eq!([with(drift - 1e-6), with(drift + 1e-4)], [json!(1), json!(0)], "{waiting}");
        assert!(told.contains(&format!("or --drift {:.4}, would do", (1e4 * drift).floor() * 1e-4)), "{told}");
    }
    // In the way also without any error.
    let stands = json!({ "id": 2, "radius": 0.25, "v_max": 1, "a_max": 1, "start": { "x": 0.0, "y": 0.3, "heading": 0.0 }, "path": [] });
    let scenario = json!({ "agents": [straight(1, [-2.0, 0.0, 0.0], 4.0), stands] });
    let name = file("simulate", "within.json", scenario.to_string());
    let told = run(&["simulate", &name, "--controller", "pcr"]).out;
    assert!(told.contains("pcr: 1 never set off, as 2 stands in its way\n"), "{told}");
}
