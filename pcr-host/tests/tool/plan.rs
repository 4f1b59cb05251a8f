//! `pcr plan`: a plan is a scenario that the check finds free.

use crate::fixture::{PAPER, crossing, directory, file, run, run_with, straight};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// The report of a plan, and the scenario it wrote.
fn plan(name: &str, scenario: &Value, arguments: &[&str]) -> (i32, Value, Option<String>) {
    let input = file("plan", &format!("{name}.json"), scenario.to_string());
    let output = directory("plan").join(format!("{name}-plan.json"));
    let _ = fs::remove_file(&output);
    let output = output.to_str().unwrap().to_owned();
    let asked = ["plan", &input, "-o", &output, "--format", "json", "--warnings", "all"];
    let run = run(&[&asked, arguments].concat());
    let report: Value = serde_json::from_str(&run.out).unwrap();
    // What it warns of is said, and nothing else.
    let warnings = report["warnings"].as_array().into_iter().flatten();
    let said = warnings.map(|it| format!("pcr: warning: {input}: {}\n", it.as_str().unwrap()));
    assert_eq!(run.err, said.collect::<String>());
    let written = Path::new(&output).exists().then_some(output);
    (run.status, report, written)
}

#[test]
fn a_crossing_is_resolved_by_the_delay_of_the_second() {
    let (status, report, written) = plan("crossing", &crossing(), &["--priority", "2"]);
    assert_eq!((status, &report["order"], &report["method"]), (0, &json!([2, 1]), &json!("delay")));
    let delays = [0, 1].map(|k| report["agents"][k]["delay"].as_f64().unwrap());
    // Both pass the crossing at 1 m/s, but the first begins to slow down a second after: a little more than R √2.
    assert!(delays[1] == 0.0 && (0.7..0.72).contains(&delays[0]), "{delays:?}");
    // The other way round it is at least as long: what is asked for is the best, or nearly so, and known to be.
    let bound = report["lower_bound"].as_f64().unwrap();
    assert!((10.6..=10.0 + delays[0]).contains(&bound) && report["unsolved"] == json!([]), "{report}");
    assert!((report["makespan"].as_f64().unwrap() - 5.0 - delays[0]).abs() < 1e-12);
    assert!((report["sum_of_costs"].as_f64().unwrap() - 10.0 - delays[0]).abs() < 1e-12);
    let free = run(&["check", &written.unwrap(), "--format", "json"]);
    assert_eq!(free.json()["conflicts"], json!([]));
}

#[test]
fn the_papers_agents_are_resolved_and_the_plan_is_free() {
    let output = directory("plan").join("paper12-plan.json").to_str().unwrap().to_owned();
    let table = run(&["plan", PAPER, "-o", &output]).ok();
    assert!(table.starts_with("paper12: a plan without conflicts, by start delays"), "{table}");
    assert!(table.lines().count() == 16 && table.contains("makespan") && table.contains("proved"), "{table}");
    let check = run(&["check", &output]).ok();
    assert_eq!(check, "paper12: no conflicts, 12 agents\n");
    let csv = run(&["plan", PAPER, "--format", "csv"]).ok();
    assert!(csv.starts_with("name,id,delay,t_end,label\npaper12,1,") && csv.lines().count() == 13, "{csv}");
}

#[test]
fn speeds_are_planned_and_written_as_profiles() {
    // Behind the second at the crossing, in front of a third that passes its start.
    let agents = json!({ "agents": [
        straight(1, [0.0, 0.0, 0.0], 8.0),
        straight(2, [0.0, -1.2, std::f64::consts::FRAC_PI_2], 12.0),
        straight(3, [5.0, -5.0, std::f64::consts::FRAC_PI_2], 10.0)
    ] });
    let (status, report, written) = plan("speeds", &agents, &["--method", "speed", "--priority", "2,3,1"]);
    assert_eq!((status, &report["order"], &report["method"]), (0, &json!([2, 3, 1]), &json!("speed")));
    let written = written.unwrap();
    let scenario: Value = serde_json::from_str(&fs::read_to_string(&written).unwrap()).unwrap();
    assert!(scenario["agents"][0]["profile"]["pieces"].as_array().unwrap().len() > 3, "{scenario}");
    assert!(scenario["agents"][1]["v_max"].is_number(), "{scenario}");
    assert_eq!(run(&["check", &written, "--format", "json"]).json()["conflicts"], json!([]));
}

/// A turn in place takes its time, and an edge with a lower limit as well: nobody drives faster there because of a plan.
#[test]
fn who_is_slow_for_a_reason_is_not_made_faster() {
    let limits = json!({ "turn_v_max": 1.0, "turn_a_max": 1.0 });
    let mut turning = straight(1, [0.0, 0.0, 0.0], 2.0);
    turning.as_object_mut().unwrap().extend(limits.as_object().unwrap().clone());
    let path = turning["path"].as_array_mut().unwrap();
    path.extend([
        json!({ "kind": "turn", "sweep": std::f64::consts::FRAC_PI_2 }),
        json!({ "kind": "line", "length": 3.0 }),
    ]);
    // 1 m/s, then 0.2 m/s.
    let mut slow = straight(1, [0.0, 0.0, 0.0], 8.0);
    let slow_fields = slow.as_object_mut().unwrap();
    slow_fields.retain(|key, _| !["v_max", "a_max"].contains(&key.as_str()));
    let pieces = [[1.0, 1.0], [3.02, 0.0], [0.8, -1.0], [19.9, 0.0], [0.2, -1.0]];
    let pieces = pieces.map(|[duration, accel]| json!({ "duration": duration, "accel": accel }));
    slow_fields.insert("profile".to_owned(), json!({ "v0": 0.0, "pieces": pieces }));

    for (name, first, why) in [("turns", turning, "it turns in place"), ("slow", slow, "its own profile is slower")] {
        let agents = json!({ "agents": [first, straight(2, [6.0, 0.0, std::f64::consts::PI], 6.0)] });
        let alone = json!({ "agents": [first] });
        let (status, report, _) = plan(name, &alone, &["--method", "speed"]);
        let (_, by_delay, _) = plan(name, &alone, &[]);
        assert_eq!(
            (status, &report["makespan"], &report["lower_bound"]),
            (0, &by_delay["makespan"], &by_delay["lower_bound"])
        );
        let warning = report["warnings"][0].as_str().unwrap();
        assert!(warning.starts_with("agent 1: ") && warning.contains(why), "{warning}");
        let (status, report, _) = plan(name, &agents, &["--method", "speed"]);
        if name == "turns" {
            // The other one stops before it, and does not only start later.
            let (_, by_delay, _) = plan(name, &agents, &[]);
            let cost = |report: &Value| report["sum_of_costs"].as_f64().unwrap();
            assert!(status == 0 && cost(&report) <= cost(&by_delay) + 1e-9 && cost(&report) > 15.0, "{report}");
        } else {
            assert_eq!((status, &report["agents"]), (1, &json!([])), "head-on, {report}");
        }
        let simulated = run(&["simulate", &file("plan", name, alone.to_string()), "--json", "-q"]).json();
        // Turns are simulated as they are, and within one segment one limit holds.
        let warned =
            simulated["warnings"][0].as_str().is_some_and(|it| it.starts_with("agent 1: its own motion takes"));
        assert_eq!(warned, name == "slow", "{simulated}");
    }
}

#[test]
fn what_cannot_work_is_named_and_nothing_is_written() {
    let head_on =
        json!({ "agents": [straight(4, [0.0, 0.0, 0.0], 4.0), straight(9, [4.0, 0.0, std::f64::consts::PI], 4.0)] });
    let (status, report, written) = plan("head-on", &head_on, &[]);
    assert_eq!((status, &report["agents"], written), (1, &json!([]), None));
    // Nothing costs 0 that does not exist.
    for cost in ["makespan", "sum_of_costs", "lower_bound", "gap"] {
        assert_eq!(report.get(cost), Some(&Value::Null), "{cost}: {report}");
    }
    assert_eq!(report["proved"], json!(false));
    let unsolved = &report["unsolved"][0];
    assert_eq!(unsolved["ids"], json!([9, 4]));
    let why = unsolved["why"].as_str().unwrap();
    assert!(why.contains("head-on without a passing place") && !why.contains("margins"), "{unsolved}");
    // Lanes on which the discs get past one another, and their margins do not.
    let mut lanes = head_on;
    lanes["agents"][1]["start"]["y"] = json!(lanes["agents"][0]["radius"].as_f64().unwrap() * 2.0 + 0.05);
    for agent in lanes["agents"].as_array_mut().unwrap() {
        agent["margin"] = json!(0.05);
    }
    let (status, report, _) = plan("lanes", &lanes, &[]);
    let why = report["unsolved"][0]["why"].as_str().unwrap().to_owned();
    assert!(status == 1 && why.contains("way of the second, within their margins, on lengths"), "{why}");
}

/// Two pairs that are head-on, one that crosses nobody, and one on its way that crosses the first pair.
fn two_pairs() -> Value {
    json!({ "agents": [
        straight(1, [0.0, 0.0, 0.0], 4.0),
        straight(2, [4.0, 0.0, std::f64::consts::PI], 4.0),
        straight(3, [0.0, 3.0, 0.0], 4.0),
        straight(4, [4.0, 3.0, std::f64::consts::PI], 4.0),
        straight(5, [0.0, 9.0, 0.0], 4.0),
        straight(6, [2.0, -2.0, std::f64::consts::FRAC_PI_2], 4.0)
    ] })
}

#[test]
fn all_pairs_that_cannot_be_planned_are_named() {
    let (status, report, written) = plan("pairs", &two_pairs(), &[]);
    assert_eq!((status, &report["agents"], written), (1, &json!([]), None));
    let named: Vec<&Value> = report["unsolved"].as_array().unwrap().iter().map(|unsolved| &unsolved["ids"]).collect();
    assert_eq!(named, [&json!([2, 1]), &json!([4, 3])], "{report}");
}

#[test]
fn the_others_are_planned_if_that_is_asked_for() {
    let (status, report, written) = plan("leave-out", &two_pairs(), &["--leave-out"]);
    let out: Vec<u64> = serde_json::from_value(report["left_out"].clone()).unwrap();
    assert!(status == 1 && out.len() == 2 && out[0] <= 2 && (3..=4).contains(&out[1]), "{report}");
    assert_eq!((report["agents"].as_array().unwrap().len(), &report["proved"]), (4, &json!(true)));
    assert_eq!(
        (&report["certificate"]["verdict"], report["unsolved"].as_array().unwrap().len()),
        (&json!("proved"), 2)
    );
    let written = written.unwrap();
    let scenario: Value = serde_json::from_str(&fs::read_to_string(&written).unwrap()).unwrap();
    assert_eq!(scenario["agents"].as_array().unwrap().len(), 4);
    let checked = run(&["check", &written, "--format", "json"]);
    assert!(checked.status == 0 && checked.err.contains(": left out of the plan: 2 of 6 agents: "), "{}", checked.err);
    let checked: Value = serde_json::from_str(&checked.out).unwrap();
    assert_eq!(checked["conflicts"], json!([]));
    let table = run(&["plan", &file("plan", "leave-out.json", two_pairs().to_string()), "--leave-out"]);
    assert!(
        table.status == 1 && table.out.contains("a plan without conflicts for some, by start delays"),
        "{}",
        table.out
    );
    // Where all can go nobody is left out.
    let (status, report, _) = plan("nobody", &crossing(), &["--leave-out"]);
    assert_eq!((status, &report["left_out"]), (0, &Value::Null));
}

#[test]
fn what_is_to_be_least_is_said_and_proved() {
    for (objective, least) in [("sum", "sum_of_costs"), ("makespan", "makespan")] {
        let (status, report, _) = plan("least", &crossing(), &["--objective", objective, "--prove"]);
        assert_eq!((status, &report["objective"], &report["proved"]), (0, &json!(least), &json!(true)));
        let [cost, bound, gap] = [least, "lower_bound", "gap"].map(|key| report[key].as_f64().unwrap());
        assert!(bound <= cost && cost - bound < 1e-6 && (0.0..1e-6).contains(&gap), "{report}");
    }
    let table = run(&["plan", &file("plan", "proved.json", crossing().to_string())]).ok();
    assert!(table.contains("the sum of costs is proved to be the least\n"), "{table}");
    let wrong = run(&["plan", &file("plan", "limit.json", crossing().to_string()), "--time-limit=-1"]);
    assert_eq!((wrong.status, wrong.out.as_str()), (2, ""));
}

#[test]
fn margins_are_kept() {
    let mut wide = crossing();
    wide["agents"][0]["margin"] = json!(0.1);
    let (_, near, _) = plan("near", &crossing(), &["--priority", "1,2"]);
    let (_, far, _) = plan("far", &wide, &["--priority", "1,2"]);
    let delay = |report: &Value| report["agents"][1]["delay"].as_f64().unwrap();
    assert!(delay(&far) > delay(&near) + 0.1, "{far} {near}");
}

#[test]
fn what_is_refused() {
    let input = file("plan", "refused.json", crossing().to_string());
    let message = run(&["plan", &input, "--priority", "3"]).failed(2);
    assert_eq!(message, format!("pcr: {input}: no agent 3; there are 1, 2\n"));
    for wrong in ["fast", "1,1", "1,,2", "-1"] {
        let run = run(&["plan", &input, &format!("--priority={wrong}")]);
        assert_eq!((run.status, run.out.as_str()), (2, ""), "{wrong}");
    }
    let blocked = format!("{}/plan.json", file("plan", "blocked", ""));
    let message = run(&["plan", &input, "-o", &blocked]).failed(3);
    assert!(message.starts_with(&format!("pcr: {blocked}: cannot be written: ")), "{message}");
    assert!(
        run(&["plan", "--help"])
            .ok()
            .contains("  1  no plan for all agents, even if --leave-out found a plan for some\n")
    );
}

#[test]
fn agents_that_wait_for_one_another_in_a_circle_are_named() {
    // Each goes to the start of the next one, around a triangle of 0.5 m that is too small to go round in.
    let side = |id: u64, turn: f64| {
        let heading = std::f64::consts::TAU / 3.0 * turn;
        let (sin, cos) = (heading - std::f64::consts::FRAC_PI_2 - std::f64::consts::FRAC_PI_3).sin_cos();
        let radius = 0.5 / 3.0_f64.sqrt();
        json!({ "id": id, "radius": 0.2, "v_max": 1.0, "a_max": 1.0,
            "start": { "x": radius * cos, "y": radius * sin, "heading": heading },
            "path": [{ "kind": "line", "length": 0.5 }] })
    };
    let agents = json!({ "agents": [side(1, 0.0), side(2, 1.0), side(3, 2.0)] });
    for method in ["delay", "speed"] {
        let (status, report, written) = plan(&format!("circle-{method}"), &agents, &["--method", method]);
        assert_eq!((status, written, &report["unsolved"][0]["ids"]), (1, None, &json!([1, 2, 3])), "{report}");
        assert!(report["unsolved"][0]["why"].as_str().unwrap().contains("circular wait: "), "{report}");
    }
    // Two of them are no circle.
    let agents = json!({ "agents": [side(1, 0.0), side(2, 1.0)] });
    assert_eq!(plan("no-circle", &agents, &[]).0, 0);
}

#[test]
fn the_maps_before_and_after_are_drawn_beside_the_report() {
    let input = file("plan", "drawn.json", crossing().to_string());
    let pictures = directory("plan").join("maps");
    let drawn = run(&["plan", &input, "--pictures", pictures.to_str().unwrap(), "--format", "json"]);
    assert_eq!((drawn.status, drawn.err.matches("Pictures: ").count()), (0, 2), "{}", drawn.err);
    assert_eq!(serde_json::from_str::<Value>(&drawn.out).unwrap()["unsolved"], json!([]));
    let read = |part: &str| fs::read_to_string(pictures.join(part)).unwrap();
    assert_ne!(read("before/ecm-1.svg"), read("after/ecm-1.svg"));
    assert!(read("before/index.html").len() > 1000 && read("after/index.html").len() > 1000);
}

#[test]
fn traffic_in_which_nobody_has_a_plan_is_no_success() {
    let point = |id: u32| {
        json!({ "type": "Feature", "properties": { "id": id, "frame": "map" },
                "geometry": { "type": "Point", "coordinates": [5 * id, 0] } })
    };
    let line = |id: u32, from: u32, to: u32| {
        json!({ "type": "Feature", "properties": { "id": id, "startid": from, "endid": to },
                "geometry": { "type": "MultiLineString", "coordinates": [[[5 * from, 0], [5 * to, 0]]] } })
    };
    let graph = |features: &[Value]| json!({ "type": "FeatureCollection", "features": features }).to_string();
    let apart = file("plan", "apart.geojson", graph(&[point(0), point(1), line(2, 0, 0)]));
    let joined = file("plan", "joined.geojson", graph(&[point(0), point(1), line(2, 0, 1)]));
    for (layout, planned, status) in [(apart, 0, 1), (joined, 1, 0)] {
        let limits = ["--radius", "0.4", "--speed", "1", "--acceleration", "1", "--rotation", "1"];
        let limits = [&limits[..], &["--rotation-acceleration", "1", "--agents", "1"]].concat();
        let answer = run(&[&["traffic", &layout, "--json", "-q"], &limits[..]].concat()).json_of(status);
        assert_eq!(answer["planned"], json!(planned));
    }
}

#[test]
fn a_plan_is_not_written_among_its_pictures() {
    let input = file("plan", "odds.json", crossing().to_string());
    let folder = directory("plan-odds");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let name = |part: &str| folder.join(part).to_str().unwrap().to_owned();
    for output in ["maps", "maps/before", "maps/after/index.html"] {
        let message = run(&["plan", &input, "-q", "--pictures", &name("maps"), "-o", &name(output)]).failed(2);
        assert_eq!(message, "pcr: --output: pictures are written there; give another name\n");
    }
    // Where the pictures cannot be, there is no plan either.
    fs::write(folder.join("maps"), "").unwrap();
    let message = run(&["plan", &input, "-q", "--pictures", &name("maps"), "-o", &name("plan.json")]).failed(3);
    assert!(message.contains("maps: cannot be written: it is there and not a folder"), "{message}");
    assert!(!folder.join("plan.json").exists());
}

#[test]
fn labels_with_commas_can_be_given_a_priority() {
    let mut labelled = crossing();
    (labelled["agents"][0]["label"], labelled["agents"][1]["label"]) = (json!("dock, left"), json!("b"));
    let (status, report, _) = plan("commas", &labelled, &["--priority", "b,dock\\, left"]);
    assert_eq!((status, &report["order"]), (0, &json!([2, 1])), "{report}");
}

/// A robot on a line, and one on an arc across it: it stands at its start in the way of the line, and at its end, but not in one region.
fn twice_across() -> Vec<Value> {
    vec![
        json!({ "id": 3, "radius": 0.31, "v_max": 1, "a_max": 1, "start": { "x": 2.03, "y": -1.73, "heading": 2.1 },
            "path": [{ "kind": "line", "length": 1.74 }] }),
        json!({ "id": 4, "radius": 0.27, "v_max": 1, "a_max": 1, "start": { "x": 1.95, "y": -2.35, "heading": 2.61 },
            "path": [{ "kind": "arc", "radius": 2.39, "sweep": -1.33 }] }),
    ]
}

#[test]
fn two_regions_that_start_delays_cannot_pass_have_orders_by_other_speeds() {
    let name = file("plan", "twice.json", json!({ "agents": twice_across() }).to_string());
    let delays = run(&["plan", &name]);
    let told = "no start delays are possible, other speeds may be: the second stands at its start in the way of the first, on lengths ";
    assert!(delays.status == 1 && delays.out.contains(told), "{}", delays.out);
    assert_eq!(delays.out.matches(" on lengths ").count(), 2, "{}", delays.out);
    assert_eq!(run(&["plan", &name, "--method", "speed"]).status, 0);
}

/// For start delays two of these four are left out; other speeds bring one of them back.
#[test]
fn whom_other_speeds_keep_is_not_left_out() {
    let stands = |id: u64, x: f64| json!({ "id": id, "radius": 1, "v_max": 1, "a_max": 1, "start": { "x": x, "y": 0, "heading": 0 }, "path": [] });
    let mut agents = twice_across();
    agents.extend([stands(91, 100.0), stands(92, 101.0)]);
    let name = file("plan", "fewest.json", json!({ "agents": agents }).to_string());
    let said = run(&["plan", &name, "--method", "speed", "--leave-out", "--json"]).json_of(1);
    assert_eq!(said["left_out"].as_array().map(Vec::len), Some(1), "{said}");
    let out = &said["left_out"][0];
    assert!(*out == 91 || *out == 92, "{said}");
    let unsolved = said["unsolved"].as_array().unwrap();
    assert!(unsolved.len() == 1 && unsolved[0]["ids"].as_array().unwrap().contains(out), "{said}");
    // The file of the plan says so, too.
    let plan = run(&["plan", &name, "--method", "speed", "--leave-out", "-q", "-o", "-"]).out;
    let plan: Value = serde_json::from_str(&plan).unwrap();
    assert_eq!(plan["warnings"][0], format!("left out of the plan: 1 of 4 agents: {out} [agents-left-out]"));
}

#[test]
fn pairs_that_never_have_a_plan_are_named_by_speeds_as_well() {
    // Without acceleration there are no other speeds; the pair overlaps at its starts.
    let agents = json!([
        { "id": 7, "radius": 0.2, "v_max": 1, "a_max": 1, "start": { "x": 0, "y": 0, "heading": std::f64::consts::PI }, "path": [{ "kind": "line", "length": 4 }] },
        { "id": 9, "radius": 0.2, "profile": { "v0": 1, "pieces": [{ "duration": 4, "accel": 0 }] }, "start": { "x": 0.3, "y": 0, "heading": 0 },
          "path": [{ "kind": "line", "length": 4 }] }]);
    let steady = file("plan", "steady.json", json!({ "agents": agents }).to_string());
    // Nearer than its margins at its start, in motion.
    let agents = json!([
        { "id": 7, "radius": 0.2, "margin": 0.1, "v_max": 1, "a_max": 1, "start": { "x": 0, "y": 0, "heading": std::f64::consts::PI },
          "path": [{ "kind": "line", "length": 4 }] },
        { "id": 9, "radius": 0.2, "margin": 0.1, "t_start": 2, "start": { "x": 0.5, "y": 0, "heading": 0 },
          "profile": { "v0": 1, "pieces": [{ "duration": 2, "accel": 0.5 }, { "duration": 0.5, "accel": 0 }] },
          "path": [{ "kind": "line", "length": 4 }] }]);
    let margins = file("plan", "moving.json", json!({ "agents": agents }).to_string());
    for (name, told) in
        [(&steady, "they overlap at their starts"), (&margins, "they are nearer than their margins at their starts")]
    {
        let said = run(&["plan", name, "--method", "speed", "--json"]).json_of(1);
        let unsolved = said["unsolved"].as_array().unwrap();
        assert!(unsolved.len() == 1 && unsolved[0]["ids"] == json!([9, 7]), "{said}");
        assert!(unsolved[0]["why"].as_str().unwrap().starts_with(told), "{said}");
    }
}

#[test]
fn speeds_are_told_in_the_order_that_is_asked_for() {
    let asked: Vec<u64> = (1..=12).rev().collect();
    let names: Vec<String> = asked.iter().map(u64::to_string).collect();
    let said = run(&["plan", PAPER, "--method", "speed", "--priority", &names.join(","), "--json"]).json();
    let order: Vec<u64> = serde_json::from_value(said["order"].clone()).unwrap();
    // Agents that have no plan otherwise are moved up.
    assert_eq!(&order[..2], &asked[..2], "{order:?}");
}

/// Whoever is first in the order waits for nobody. Start delays cost less here than speeds in the order that is asked for.
#[test]
fn a_plan_by_delays_has_their_order() {
    let line = |length: f64| json!({ "kind": "line", "length": length });
    let around = json!([line(6.0), { "kind": "arc", "radius": 3, "sweep": -std::f64::consts::PI }, line(4.0)]);
    let agents = json!([
        { "id": 1, "radius": 0.3, "start": { "x": 0, "y": 0, "heading": 0 }, "path": [line(8.0)], "v_max": 0.5, "a_max": 1 },
        { "id": 2, "radius": 0.3, "start": { "x": 2, "y": -5, "heading": std::f64::consts::FRAC_PI_2 }, "path": around,
            "v_max": 2, "a_max": 1 },
    ]);
    let (status, said, _) = plan("around", &json!({ "agents": agents }), &["--method", "speed", "--priority", "1,2"]);
    assert_eq!((status, &said["order"]), (0, &json!([2, 1])), "{said}");
    assert!(said["agents"][0]["delay"].as_f64().unwrap() > 0.4 && said["agents"][1]["delay"] == json!(0.0), "{said}");
}

#[test]
fn a_scenario_without_a_plan_is_missed_in_no_stream() {
    let head_on = |id: u64, x: f64, heading: f64| {
        json!({ "id": id, "radius": 0.3, "v_max": 1, "a_max": 1, "start": { "x": x, "y": 0, "heading": heading },
            "path": [{ "kind": "line", "length": 6 }] })
    };
    let agents = json!([head_on(1, -3.0, 0.0), head_on(2, 3.0, std::f64::consts::PI)]);
    let name = file("plan", "head-on.json", json!({ "name": "head-on", "agents": agents }).to_string());
    let csv = run(&["plan", &name, "--format", "csv"]);
    assert_eq!((csv.status, csv.out.lines().count()), (1, 1));
    assert!(csv.err.starts_with(&format!("pcr: {name}: no plan\npcr: {name}: agents ")), "{}", csv.err);
    let stream = run(&["plan", &name, PAPER, "-q", "-o", "-"]);
    let first = "{\"format\":\"pcr-scenario\",\"version\":1,\"name\":\"head-on\",\"error\":\"no plan: agents ";
    assert!(stream.status == 1 && stream.out.starts_with(first), "{}", stream.out);
    let checked = run_with(&["check", "-"], stream.out.as_bytes());
    assert_eq!(checked.status, 2);
    let why = "pcr: standard input: line 1, column 63: head-on: no plan: agents ";
    assert!(checked.err.starts_with(why) && checked.err.contains("1 of 2 scenarios refused"), "{}", checked.err);
}

/// The table named every pair, and a limit of the time did not hold for the reasons.
#[test]
fn a_heap_that_has_no_plan_is_told_in_a_few_lines_and_in_its_time() {
    let heap: Vec<Value> = (0..60).map(|k| straight(k + 1, [0.001 * k as f64, 0.0, 0.1 * k as f64], 4.0)).collect();
    let scenario = file("plan", "heap.json", json!({ "name": "heap", "agents": heap }).to_string());
    let table = run(&["plan", &scenario]);
    let lines: Vec<&str> = table.out.lines().collect();
    assert_eq!((table.status, lines.len()), (1, 42), "{}", table.out);
    assert!(lines[1].contains("they overlap at their starts"), "{}", lines[1]);
    assert_eq!(lines[41], "  and 1730 more (--json)");
    for (limit, why) in
        [(&[][..], "they overlap at their starts"), (&["--time-limit", "0"], "they meet whenever they start")]
    {
        let report = run(&[&["plan", &scenario, "--json"], limit].concat()).json_of(1);
        let unsolved = report["unsolved"].as_array().unwrap();
        assert_eq!(unsolved.len(), 60 * 59 / 2);
        assert!(unsolved.iter().all(|pair| pair["why"].as_str().unwrap().starts_with(why)), "{}", unsolved[0]);
    }
}

#[test]
fn pictures_of_an_earlier_plan_are_told() {
    let pictures = directory("plan").join("earlier").to_str().unwrap().to_owned();
    let _ = fs::remove_dir_all(&pictures);
    let free = file("plan", "earlier-free.json", crossing().to_string());
    let stuck = json!({ "agents": [straight(1, [0.0, 0.0, 0.0], 4.0), straight(2, [0.1, 0.0, 0.0], 4.0)] });
    let stuck = file("plan", "earlier-stuck.json", stuck.to_string());
    let said = |scenario: &str| run(&["plan", scenario, "--pictures", &pictures, "--json"]).err;
    let told =
        format!("pcr: warning: {pictures}/after: of an earlier plan, and there is none now [earlier-pictures]\n");
    assert!(!said(&stuck).contains("earlier plan") && !said(&free).contains("earlier plan"));
    assert!(said(&stuck).ends_with(&told));
}
