//! Tests for every kind of refusal, with the whole message, and for inputs that must not be refused.

use super::*;
use crate::splitmix64::SplitMix64;
use serde_json::{Value, json};
use std::f64::consts::PI;

fn agent(id: u64) -> Value {
    json!({
        "id": id, "radius": 0.5, "v_max": 1.0, "a_max": 0.5,
        "start": { "x": 0.0, "y": 0.0, "heading": 0.0 },
        "path": [{ "kind": "line", "length": 2.0 }, { "kind": "arc", "radius": 1.0, "sweep": -1.5 }],
    })
}

/// Agent 7 in the second place, with a value put in (or, if null, a key taken out).
fn with(pointer: &str, value: &Value) -> Value {
    let mut scenario = json!({ "agents": [agent(3), agent(7)] });
    let changed = &mut scenario["agents"][1];
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    let parent = changed.pointer_mut(parent).unwrap();
    match (parent, value) {
        (Value::Object(members), Value::Null) => drop(members.remove(key).unwrap()),
        (Value::Object(members), value) => drop(members.insert(key.into(), value.clone())),
        (Value::Array(elements), value) => elements[key.parse::<usize>().unwrap()] = value.clone(),
        _ => panic!("{pointer}"),
    }
    scenario
}

#[track_caller]
fn refused(scenario: &Value, message: &str) {
    assert_eq!(Scenario::from_value(scenario).unwrap_err().to_string(), message);
}

#[track_caller]
fn refused_text(text: &str, line: usize, message: &str) {
    let error = Scenario::from_json(text).unwrap_err();
    assert_eq!((error.line(), error.to_string().as_str()), (line, message));
}

#[test]
fn missing_fields_are_named() {
    for field in ["radius", "v_max", "a_max", "start", "path"] {
        refused(&with(&format!("/{field}"), &Value::Null), &format!("agent 7, {field}: missing"));
    }
    refused(&with("/id", &Value::Null), "agent at place 2, id: missing");
    refused(&with("/start/x", &Value::Null), "agent 7, start.x: missing");
    refused(&with("/path/0/length", &Value::Null), "agent 7, segment 1, length: missing");
    refused(&with("/path/1/radius", &Value::Null), "agent 7, segment 2, radius: missing");
    refused(&with("/path/1/kind", &Value::Null), "agent 7, segment 2, kind: missing");
    refused(&json!({}), "agents: missing");
}

#[test]
fn unknown_keys_are_refused_with_those_that_are_known() {
    refused(
        &with("/path/1/length", &json!(1)),
        "agent 7, segment 2, length: unknown key; known are kind, radius, sweep, sweep_deg, gear, facing, facing_deg, steady",
    );
    refused(
        &with("/path/0/sweep", &json!(1)),
        "agent 7, segment 1, sweep: unknown key; known are kind, length, gear, facing, facing_deg, steady",
    );
    refused(&with("/start/z", &json!(1)), "agent 7, start.z: unknown key; known are x, y, heading, heading_deg");
    refused(
        &with("/speed", &json!(1)),
        "agent 7, speed: unknown key; known are id, label, radius, footprint, loads, margin, v_max, a_max, turn_v_max, turn_v_max_deg, turn_a_max, turn_a_max_deg, t_start, start, path, profile",
    );
    refused(
        &json!({ "agents": [], "units": "m" }),
        "units: unknown key; known are format, version, name, angles, agents, warnings",
    );
}

#[test]
fn numbers_out_of_range_come_with_the_range() {
    for (pointer, field) in [("/radius", "radius"), ("/v_max", "v_max"), ("/a_max", "a_max")] {
        for value in [0.0, -0.25, 2e10] {
            let message = format!("agent 7, {field}: {} is out of range; allowed is above 0, up to 1e10", json!(value));
            refused(&with(pointer, &json!(value)), &message);
        }
    }
    let any = "is out of range; allowed is -1e10 to 1e10";
    refused(&with("/t_start", &json!(-2e10)), &format!("agent 7, t_start: -20000000000.0 {any}"));
    refused(&with("/start/heading", &json!(1e300)), &format!("agent 7, start.heading: 1e+300 {any}"));
    refused(&with("/path/1/sweep", &json!(1e11)), &format!("agent 7, segment 2, sweep: 100000000000.0 {any}"));
    let length = "agent 7, segment 1, length: -1 is out of range; allowed is 0 to 1e10";
    refused(&with("/path/0/length", &json!(-1)), length);
    let radius = "agent 7, segment 2, radius: 0 is out of range; allowed is above 0, up to 1e10";
    refused(&with("/path/1/radius", &json!(0)), radius);
}

#[test]
fn numbers_that_are_not_finite_are_refused_where_they_stand() {
    for word in ["NaN", "Infinity", "-Infinity", "1e999", "-1e400"] {
        // The id comes last: it is known all the same.
        let text = format!(
            r#"{{"agents": [{{"radius": 1, "v_max": 1, "a_max": 1, "start": {{"x": 0, "y": 0, "heading": 0}},
                "path": [{{"kind": "line", "length": 1}},
                         {{"kind": "arc", "radius": 1, "sweep": {word}}}], "id": 12}}]}}"#
        );
        let message = format!("agent 12, segment 2, sweep: {word} is out of range; allowed is -1e10 to 1e10");
        refused_text(&text, 3, &message);
    }
}

#[test]
fn values_of_the_wrong_type_are_quoted() {
    refused(&with("/radius", &json!("0.5")), "agent 7, radius: \"0.5\" where a number is expected");
    refused(&with("/radius", &json!([0.5])), "agent 7, radius: an array where a number is expected");
    refused(&with("/v_max", &json!(true)), "agent 7, v_max: true where a number is expected");
    refused(&with("/start", &json!([0, 0, 0])), "agent 7, start: an array where an object is expected");
    refused(&with("/path", &json!({})), "agent 7, path: an object where an array is expected");
    refused(&with("/path/0", &json!(2.0)), "agent 7, segment 1: 2.0 where an object is expected");
    refused(
        &with("/path/0/kind", &json!("spline")),
        "agent 7, segment 1, kind: \"spline\"; allowed is \"line\", \"arc\", \"turn\" or \"kink\"",
    );
    refused(&json!({ "agents": [agent(1), 5] }), "agent at place 2: 5 where an object is expected");
    refused(&json!({ "agents": 5 }), "agents: 5 where an array is expected");
    refused(&json!({ "agents": [], "name": 5 }), "name: 5 where a string is expected");
    refused(&json!([]), "an array where an object is expected");
}

#[test]
fn long_values_are_quoted_in_part() {
    let message = Scenario::from_value(&with("/radius", &json!("x".repeat(1_000_000)))).unwrap_err().to_string();
    assert!(message.starts_with("agent 7, radius: \"xxx") && message.len() < 120, "{message}");
    let digits = format!("{{\"agents\": [{{\"id\": {}}}]}}", "9".repeat(1_000_000));
    let message = Scenario::from_json(&digits).unwrap_err().to_string();
    assert!(message.starts_with("agent at place 1, id: 999") && message.len() < 120, "{message}");
}

#[test]
fn ids_are_whole_numbers_and_unique() {
    for wrong in ["9007199254740993.0", "1e-400", "0.5"] {
        let text = format!("{{\"agents\": [{{\"id\": {wrong}}}]}}");
        let message = Scenario::from_json(&text).unwrap_err().to_string();
        assert!(message.contains(&format!("id: {wrong} where a whole number")), "{message}");
    }
    for id in [json!(-1), json!(1.5), json!(1e17), json!(""), json!([7])] {
        let message = Scenario::from_value(&with("/id", &id)).unwrap_err().to_string();
        assert!(message.starts_with("agent at place 2, id: "), "{message}");
        assert!(message.ends_with(" where a whole number from 0 or a name is expected"), "{message}");
    }
    refused(&with("/id", &json!(3)), "agent 3, id: 3 is given to two agents");
    assert_eq!(Scenario::from_value(&with("/id", &json!(u64::MAX))).unwrap().agents[1].id, u64::MAX);
    // As Python and JavaScript write what was computed.
    assert_eq!(Scenario::from_value(&with("/id", &json!(8.0))).unwrap().agents[1].id, 8);
}

#[test]
fn repeated_keys_are_refused() {
    refused_text(r#"{"agents": [], "agents": []}"#, 1, "agents: given twice");
    let text = "{\"agents\": [{\"id\": 4,\n\"radius\": 1,\n\"radius\": 2}]}";
    refused_text(text, 3, "agent 4, radius: given twice");
}

#[test]
fn profiles_have_to_fit_the_path() {
    // The path is 3.5 m long.
    let fits = |v0: f64, pieces: Value| {
        let scenario = with("/profile", &json!({ "v0": v0, "pieces": pieces }));
        Scenario::from_value(&scenario).map(|scenario| scenario.agents[1].duration()).map_err(|error| error.to_string())
    };
    assert_eq!(fits(0.5, json!([{ "duration": 7.0, "accel": 0.0 }])), Ok(7.0));
    assert_eq!(fits(0.5, json!([{ "duration": 7.000001, "accel": 0.0 }])), Ok(7.000001));
    assert_eq!(
        fits(0.5, json!([{ "duration": 7.1, "accel": 0.0 }])).unwrap_err(),
        "agent 7, profile: travels 3.55 m on a path of 3.5 m; allowed is a relative difference of 9.54e-7"
    );
    assert_eq!(
        fits(0.5, json!([{ "duration": 1.0, "accel": 0.0 }, { "duration": 2.0, "accel": -0.5 }])).unwrap_err(),
        "agent 7, profile piece 2, accel: -0.5 brings the speed to -0.5 m/s; allowed is 0 and above"
    );
    assert_eq!(
        fits(0.5, json!([{ "duration": -1.0, "accel": 0.0 }])).unwrap_err(),
        "agent 7, profile piece 1, duration: -1.0 is out of range; allowed is 0 to 1e10"
    );
    assert_eq!(fits(-0.5, json!([])).unwrap_err(), "agent 7, profile.v0: -0.5 is out of range; allowed is 0 to 1e10");
    assert_eq!(fits(0.5, json!([{ "duration": 1.0 }])).unwrap_err(), "agent 7, profile piece 1, accel: missing");
    refused(&with("/profile", &json!({ "v0": 1 })), "agent 7, profile.pieces: missing");
    refused(&with("/profile", &json!([])), "agent 7, profile: an array where an object is expected");
    refused(
        &with("/profile", &json!({ "v0": 1, "pieces": [], "dt": 1 })),
        "agent 7, profile.dt: unknown key; known are v0, pieces",
    );
}

#[test]
fn what_follows_from_several_fields_is_checked_too() {
    let slow = "agent 7, v_max, a_max: the motion takes 3.5e12 s from 0 s; allowed is up to 1e10 s";
    refused(&with("/v_max", &json!(1e-12)), slow);
    let message = Scenario::from_value(&with("/t_start", &json!(1e10))).unwrap_err().to_string();
    assert!(message.starts_with("agent 7, t_start: the motion takes ") && message.contains("allowed is up to 1e10"));
    let long = "agent 7, path: 1.0000000002e10 m long; allowed is up to 1e10";
    refused(&with("/path/1", &json!({ "kind": "line", "length": 1e10 })), long);
    let turns = "agent 7, path: 159156 segments, each turn of an arc counted; allowed are up to 65535";
    refused(&with("/path/1/sweep", &json!(1e6)), turns);
}

#[test]
fn angles_may_be_in_degrees() {
    let read = |pointer: &str, key: &str, value: Value| {
        let mut scenario = with(pointer, &Value::Null);
        let parent = scenario["agents"][1].pointer_mut(pointer.rsplit_once('/').unwrap().0).unwrap();
        parent[key] = value;
        Scenario::from_value(&scenario)
    };
    for (degrees, radians) in [(90.0, PI / 2.0), (-180.0, -PI), (360.0, TAU), (720.0, 2.0 * TAU), (0.0, 0.0)] {
        let scenario = read("/start/heading", "heading_deg", json!(degrees)).unwrap();
        assert_eq!((scenario.agents[1].start[2], scenario.warnings.len()), (radians, 0), "{degrees}");
        let scenario = read("/path/1/sweep", "sweep_deg", json!(degrees)).unwrap();
        let arc = PathSegment::arc(1.0, radians);
        assert_eq!((scenario.agents[1].path[1], scenario.warnings.len()), (arc, 0), "{degrees}");
        // What is written of it is not doubted either.
        assert_eq!(Scenario::from_json(&scenario.to_json()), Ok(scenario));
    }
    let turn = json!({ "kind": "turn", "sweep_deg": 90 });
    let mut turns = with("/path/1", &turn);
    for (agent, keys) in [(0, ["turn_v_max", "turn_a_max"]), (1, ["turn_v_max_deg", "turn_a_max_deg"])] {
        turns["agents"][agent]["path"][1] = turn.clone();
        keys.iter().for_each(|key| turns["agents"][agent][key] = json!(1.0));
    }
    let scenario = Scenario::from_value(&turns).unwrap();
    let [radians, degrees] = [0, 1].map(|agent| scenario.agents[agent].duration() - 4.0);
    // From rest to rest, at 1 °/s² up to 1 °/s, and the same in radians.
    assert!((radians - (PI / 2.0 + 1.0)).abs() < 1e-9 && (degrees - 91.0).abs() < 1e-9, "{radians} {degrees}");
    let both = "given beside sweep; give either radians (sweep) or degrees (sweep_deg)";
    refused(&with("/path/1/sweep_deg", &json!(1)), &format!("agent 7, segment 2, sweep_deg: {both}"));
    let both = "given beside heading; give either radians (heading) or degrees (heading_deg)";
    refused(&with("/start/heading_deg", &json!(1)), &format!("agent 7, start.heading_deg: {both}"));
    let any = "is out of range; allowed is -1e10 to 1e10";
    let error = read("/start/heading", "heading_deg", json!(2e10)).unwrap_err().to_string();
    assert_eq!(error, format!("agent 7, start.heading_deg: 20000000000.0 {any}"));
}

#[test]
fn radians_above_one_turn_are_doubted() {
    let warnings = |scenario: &Value| Scenario::from_value(scenario).unwrap().warnings;
    let unless = "or add \"angles\": \"radians\" to the file if this is meant [angle-unit]";
    let heading =
        format!("agent 7, start.heading: 90 is more than one turn in radians; use heading_deg for degrees, {unless}");
    let mut scenario = with("/start/heading", &json!(90));
    assert_eq!(warnings(&scenario), std::slice::from_ref(&heading));
    scenario["agents"][0]["path"][1]["sweep"] = json!(-90.0);
    scenario["agents"][1]["path"][1]["sweep"] = json!(6.3);
    let sweep =
        "agent 3, segment 2, sweep: -90 is more than one turn in radians (and 1 more); use sweep_deg for degrees,";
    assert_eq!(warnings(&scenario), [heading.clone(), format!("{sweep} {unless}")]);
    // It is told once, however often it is read; what the tool writes declares its unit.
    scenario["warnings"] = json!([heading]);
    let read = Scenario::from_value(&scenario).unwrap();
    assert_eq!(read.warnings.len(), 2);
    assert_eq!(Scenario::from_json(&read.to_json()), Ok(read));
    scenario["warnings"] = json!([]);
    scenario["angles"] = json!("radians");
    assert_eq!(warnings(&scenario), [""; 0]);
    scenario["angles"] = json!("degrees");
    refused(
        &scenario,
        "angles: \"degrees\" where \"radians\" (degrees have keys of their own, such as heading_deg) is expected",
    );
    for turn in [std::f64::consts::TAU, -std::f64::consts::TAU, 3.0] {
        assert_eq!(warnings(&with("/start/heading", &json!(turn))), [""; 0], "{turn}");
        assert_eq!(warnings(&with("/path/1/sweep", &json!(turn))), [""; 0], "{turn}");
    }
    // Turns in place, and how fast they are.
    let mut turns = with("/path/1", &json!({ "kind": "turn", "sweep": 1.5 }));
    turns["agents"][1]["turn_v_max"] = json!(45);
    turns["agents"][1]["turn_a_max"] = json!(90);
    let [speed, acceleration] = warnings(&turns).try_into().unwrap();
    assert!(speed.starts_with("agent 7, turn_v_max: 45 is more than one turn a second in radians; use turn_v_max_deg"));
    assert!(acceleration.starts_with("agent 7, turn_a_max: 90 is more than"), "{acceleration}");
}

#[test]
fn faults_of_the_text_come_with_line_and_column() {
    let refused_at = |text: &str, [line, column]: [usize; 2], message: &str| {
        refused_text(text, line, message);
        assert_eq!(Scenario::from_json(text).unwrap_err().column(), Some(column));
    };
    refused_text("", 1, "empty; a scenario is an object with a list of agents");
    refused_text("\u{feff} \r\n", 1, "empty; a scenario is an object with a list of agents");
    refused_at("{\"agents\": [}", [1, 13], "} where a value is expected");
    refused_at("{\"agents\":\n []", [2, 4], "the text ends where `,` or `}` is expected");
    refused_at(
        "{\"agents\": []}\n{}",
        [2, 1],
        "more text after the end of the scenario (pcr check and pcr regions read several on standard input, each on a line of its own)",
    );
    refused_at("{\"name\": \"é\", \"agents\": 1}", [1, 25], "agents: 1 where an array is expected");
    refused_at(
        "{\"agents\": [{\"id\":\n 1, \"radius\": \"a\"}]}",
        [2, 15],
        "agent 1, radius: \"a\" where a number is expected",
    );
    refused_at(&"[".repeat(100_000), [1, 65], "arrays and objects nested more than 64 deep");
}

#[test]
fn the_name_is_known_of_a_refused_scenario() {
    let scenario = json!({ "agents": [agent(1), agent(1)], "name": "twins" });
    assert_eq!(Scenario::from_value(&scenario).unwrap_err().scenario(), "twins");
}

#[test]
fn what_is_allowed_is_accepted() {
    assert_eq!(Scenario::from_json("\u{feff}{\"agents\": []}\r\n").unwrap(), Scenario::default());
    for (pointer, value) in [
        ("/path", json!([])),
        ("/path/0/length", json!(0)),
        ("/path/0/length", json!(1e-17)),
        ("/path/1/sweep", json!(0)),
        ("/path/1/sweep", json!(-40.0)),
        ("/path/1/radius", json!(1e-9)),
        ("/start/x", json!(-5.3e6)),
        ("/t_start", json!(1.8e9)),
        ("/t_start", json!(-100)),
        ("/radius", json!(1e-6)),
    ] {
        let scenario = Scenario::from_value(&with(pointer, &value));
        assert!(scenario.is_ok(), "{pointer} {value}: {}", scenario.unwrap_err());
    }
    let standing = with("/profile", &json!({ "v0": 0, "pieces": [{ "duration": 5, "accel": 0 }] }));
    let mut standing = standing;
    standing["agents"][1]["path"] = json!([]);
    assert_eq!(Scenario::from_value(&standing).unwrap().agents[1].duration(), 5.0);
}

/// Profiles that are read are fitted to their paths; after that nothing changes any more, however often they are written and read.
#[test]
fn profiles_that_are_written_are_read_as_they_were() {
    // Numbers of all sizes, the same in each run.
    let mut random = SplitMix64(1);
    let mut next = || random.unit();
    let mut written = 0;
    for _ in 0..2000 {
        // Speeds at the ends of pieces, of which some are stops.
        let (mut speed, mut travelled, mut pieces) = (0.0, 0.0, Vec::new());
        for k in 0..(1 + (next() * 9.0) as usize) {
            let to = if k % 3 == 2 || next() < 0.2 { 0.0 } else { next() * 10_f64.powf(4.0 * next() - 3.0) };
            let duration = 10_f64.powf(5.0 * next() - 2.0);
            pieces.push(json!({ "duration": duration, "accel": (to - speed) / duration }));
            travelled += 0.5 * (speed + to) * duration;
            speed = to;
        }
        if travelled == 0.0 {
            continue;
        }
        // As far off as a file of few digits is.
        let length = travelled * (1.0 + 1e-7 * (next() - 0.5));
        let mut scenario = with("/profile", &json!({ "v0": 0, "pieces": pieces }));
        scenario["agents"][1]["path"] = json!([{ "kind": "line", "length": length }]);
        let read = Scenario::from_value(&scenario).unwrap();
        assert_eq!(Scenario::from_json(&read.to_json()), Ok(read));
        written += 1;
    }
    assert!(written > 1500);
}

#[test]
fn labels_are_printable_text() {
    assert_eq!(
        Scenario::from_value(&with("/label", &json!("AGV 7 → Ω"))).unwrap().agents[1].display_name(),
        "7 AGV 7 → Ω"
    );
    refused(&with("/label", &json!(5)), "agent 7, label: 5 where a string is expected");
    let control = "agent 7, label: has the control character \\u{1b}; allowed is printable text";
    refused(&with("/label", &json!("\u{1b}[2J")), control);
    let turns = "agent 7, label: has the control character \\u{202e}; allowed is printable text";
    refused(&with("/label", &json!("AGV \u{202e}7")), turns);
    assert_eq!(crate::scenario::label("A\u{2028}G\u{202e}V\n"), "AGV");
    // What nobody sees.
    let unseen = "agent 7, label: has the control character \\u{200b}; allowed is printable text";
    refused(&with("/label", &json!("AGV\u{200b}7")), unseen);
    assert_eq!(crate::scenario::label("\u{e0041}A\u{200f}G\u{2060}V\u{200d}"), "AGV\u{200d}");
    let long = with("/label", &json!("x".repeat(LONGEST_LABEL + 1)));
    refused(&long, "agent 7, label: has 201 characters; allowed are up to 200");
    // Messages about the agent name it.
    let mut wrong = with("/label", &json!("AGV-7"));
    wrong["agents"][1]["radius"] = json!(-1);
    refused(&wrong, "agent 7 AGV-7, radius: -1 is out of range; allowed is above 0, up to 1e10");
}

#[test]
fn ids_may_be_texts_if_all_are() {
    let named = |ids: [Value; 2]| {
        let agents = ids.map(|id| {
            let mut agent = agent(0);
            agent["id"] = id;
            agent
        });
        json!({ "agents": agents })
    };
    let scenario = Scenario::from_value(&named([json!("AGV-7"), json!("AGV-3")])).unwrap();
    assert_eq!(scenario.agents.iter().map(Agent::display_name).collect::<Vec<_>>(), ["1 AGV-7", "2 AGV-3"]);
    assert_eq!(Scenario::from_json(&scenario.to_json()), Ok(scenario));
    refused(&named([json!("a"), json!("a")]), "agent 2 a, id: \"a\" is given to two agents");
    for mixed in [[json!("a"), json!(5)], [json!(5), json!("a")]] {
        let message = Scenario::from_value(&named(mixed)).unwrap_err().to_string();
        assert!(
            message.ends_with("id: some ids are numbers and others texts; give numbers to all, and texts as labels")
        );
    }
    let mut both = named([json!("a"), json!("b")]);
    both["agents"][0]["label"] = json!("c");
    refused(&both, "agent 1 a, label: given, and the id is a text");
}

#[test]
fn files_may_say_what_they_are() {
    let file = |format: &str, version: u32| {
        Scenario::from_value(&json!({ "format": format, "version": version, "agents": [] }))
    };
    assert!(file("pcr-scenario", 1).is_ok() && file("pcr-scenario", 2).is_ok());
    let message = file("other", 1).unwrap_err().to_string();
    assert_eq!(message, "format: \"other\" where \"pcr-scenario\" is expected");
    let message = file("pcr-locks", 1).unwrap_err().to_string();
    assert_eq!(message, "this is pcr-locks, an answer of pcr; a scenario is expected");
    let message = file("pcr-scenario", 6).unwrap_err().to_string();
    assert_eq!(message, "version: 6 where 1 to 5, all that this pcr knows, is expected");
}

#[test]
fn a_margin_is_given_to_those_that_have_none() {
    let mut scenario = Scenario::from_value(&json!({ "agents": [agent(3), agent(7)] })).unwrap();
    scenario.agents[1].margin = 0.25;
    scenario.give_margin(0.1);
    assert_eq!(scenario.agents.iter().map(|agent| agent.margin).collect::<Vec<_>>(), [0.1, 0.25]);
}

#[test]
fn a_full_turn_may_be_rounded_and_no_more() {
    let turns = |sweep| PathSegment::arc(1.0, sweep).turns();
    assert_eq!([turns(2.0 * PI * (1.0 + 5e-13)), turns(-2.0 * PI), turns(2.0 * PI * (1.0 + 1e-11))], [1.0, 1.0, 2.0]);
    assert_eq!([turns(0.0), turns(4.0 * PI), turns(-13.0)], [1.0, 2.0, 3.0]);
}

#[test]
fn a_path_without_length_takes_no_time() {
    assert_eq!(MotionSpec::RestToRest { v_max: 1.0, a_max: 0.5 }.pieces(0.0), (0.0, Vec::new()));
}

#[test]
fn only_loads_and_what_is_not_convex_make_several_bodies() {
    let mut scenario = with("/loads", &json!([{ "segments": [2, 2], "radius": 0.6 }]));
    let concave = json!([[1.0, 0.0], [0.0, 0.3], [-1.0, 0.0], [0.0, 1.0]]);
    let corners = |all: &Value| -> Value {
        all.as_array().unwrap().iter().map(|corner| json!({ "ahead": corner[0], "left": corner[1] })).collect()
    };
    for polygon in [&concave, &json!([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])] {
        let mut other = agent(11 + scenario["agents"].as_array().unwrap().len() as u64);
        other.as_object_mut().unwrap().remove("radius");
        other["footprint"] = json!({ "polygon": corners(polygon) });
        scenario["agents"].as_array_mut().unwrap().push(other);
    }
    let read = Scenario::from_value(&scenario).unwrap();
    assert_eq!(read.agents.iter().map(Agent::has_parts).collect::<Vec<_>>(), [false, true, true, false]);
    // What once said how far discs could reach out is still checked.
    scenario["agents"][2]["footprint"]["overhang"] = json!(-0.1);
    refused(&scenario, "agent 13, footprint.overhang: -0.1 is out of range; allowed is above 0, up to 1e10");
}

#[test]
fn a_stretch_ends_with_its_wait_and_nothing_of_what_follows() {
    // 1 m, a wait of 5 s at the joint, and 1 m more.
    let mut other = agent(7);
    other["path"] = json!([{ "kind": "line", "length": 1.0 }, { "kind": "line", "length": 1.0 }]);
    let pieces: Value = [(1.0, 1.0), (1.0, -1.0), (5.0, 0.0), (1.0, 1.0), (1.0, -1.0)]
        .iter()
        .map(|(duration, acceleration)| json!({ "duration": duration, "accel": acceleration }))
        .collect();
    other["profile"] = json!({ "v0": 0.0, "pieces": pieces });
    for key in ["v_max", "a_max"] {
        other.as_object_mut().unwrap().remove(key);
    }
    let scenario = Scenario::from_value(&json!({ "agents": [other] })).unwrap();
    let durations = |first, last| -> Vec<f64> {
        let MotionSpec::Profile { pieces, .. } = scenario.agents[0].stretch(first, last).agent.motion else {
            panic!("a profile")
        };
        pieces.into_iter().map(|piece| piece.duration).collect()
    };
    assert_eq!(durations(0, 0), [1.0, 1.0, 5.0]);
    assert_eq!(durations(1, 1), [5.0, 1.0, 1.0]);
    assert_eq!(durations(0, 1), [1.0, 1.0, 5.0, 1.0, 1.0]);
    assert_eq!(scenario.agents[0].stretch(1, 1).agent.t_start, 2.0);
}

/// A path with a turn of 2 rad, a joint that is passed, and a turn of 1 rad: 2 m, 2 m and 1 m from rest to rest at 1 m/s², with accelerations of
/// 0.5 rad/s² in place.
fn turning(version: u64, turn: impl Fn(f64, f64) -> Value, kink: &Value) -> Value {
    let line = |length: f64| json!({ "kind": "line", "length": length });
    let piece = |duration: f64, accel: f64| json!({ "duration": duration, "accel": accel });
    let path = [line(2.0), json!({ "kind": "turn", "sweep": 2.0 }), line(1.0), kink.clone(), line(1.0)];
    let path = [&path[..], &[json!({ "kind": "turn", "sweep": -1.0 }), line(1.0)]].concat();
    let drive = |length: f64| [piece(length.sqrt(), 1.0), piece(length.sqrt(), -1.0)];
    let turn = |sweep: f64| [turn((2.0 * sweep).sqrt(), 0.5), turn((2.0 * sweep).sqrt(), -0.5)];
    let wait = [piece(3.0, 0.0)];
    let pieces = [&drive(2.0)[..], &wait, &turn(2.0), &wait, &drive(2.0), &turn(1.0), &drive(1.0)].concat();
    let agent = json!({ "id": 1, "radius": 0.3, "start": { "x": 0, "y": 0, "heading": 0 }, "path": path,
        "profile": { "v0": 0, "pieces": pieces } });
    json!({ "version": version, "agents": [agent] })
}

#[test]
fn turns_with_a_length_are_read_as_turns() {
    let old = |duration: f64, accel: f64| json!({ "duration": duration, "accel": 1e-9 * accel });
    let arc = json!({ "kind": "arc", "radius": 1e-9, "sweep": 0.005 });
    let old = Scenario::from_value(&turning(1, old, &arc)).unwrap();
    let new = |duration: f64, accel: f64| json!({ "duration": duration, "turn_accel": accel });
    let new = Scenario::from_value(&turning(3, new, &json!({ "kind": "kink", "sweep": 0.005 }))).unwrap();
    let [old, new] = [&old.agents[0], &new.agents[0]];
    assert_eq!((new.structure().as_str(), &old.path), ("STSTSTS", &new.path));
    assert_eq!([new.path[1], new.path[3]], [PathSegment::Turn { sweep: 2.0 }, PathSegment::Kink { sweep: 0.005 }]);
    assert_eq!(old.length(), 5.0);
    let [was, is] = [old.parts(), new.parts()];
    for (was, is) in was.iter().zip(&is) {
        let [before, after] = [was, is].map(|phases| {
            let peak = phases.iter().flat_map(|phase| [phase.before, phase.after]).fold(0.0, f64::max);
            (phases.iter().map(|phase| phase.duration).sum::<f64>(), peak)
        });
        assert!((before.0 - after.0).abs() < 1e-6 && (before.1 - after.1).abs() < 1e-6, "{was:?} {is:?}");
    }
    // It waits before it turns, and after it before it drives on.
    let waits = |place: usize| is[place].first().is_some_and(|phase| phase.duration == 3.0 && !phase.moves());
    assert_eq!([0, 1, 2, 5].map(waits), [false, true, true, false]);
    let turned: f64 = is[5].iter().map(|phase| 0.5 * (phase.before + phase.after) * phase.duration).sum();
    assert!((turned - 1.0).abs() < 1e-12, "{turned}");
    // Both are written as they are now.
    for agent in [old, new] {
        let scenario = Scenario::new("", vec![agent.clone()]);
        assert!(scenario.to_json().contains("\"version\": 3"));
        assert_eq!(Scenario::from_json(&scenario.to_json()), Ok(scenario));
    }
}

#[test]
fn turns_are_done_where_they_are_and_as_far() {
    let new = |duration: f64, accel: f64| json!({ "duration": duration, "turn_accel": accel });
    let kink = json!({ "kind": "kink", "sweep": 0.005 });
    let file = turning(3, new, &kink);
    let changed = |pointer: &str, value: Value| {
        let mut file = file.clone();
        *file.pointer_mut(pointer).unwrap() = value;
        Scenario::from_value(&file).unwrap_err().to_string()
    };
    let angle = changed("/agents/0/path/1/sweep", json!(2.1));
    assert!(angle.contains("profile: turns by 2 rad in place where segment 2 turns by 2.1 rad"), "{angle}");
    let place = changed("/agents/0/path/0/length", json!(3.0));
    assert!(place.contains("m on a path of 6 m"), "{place}");
    let mut shifted = file.clone();
    shifted["agents"][0]["path"].as_array_mut().unwrap().swap(0, 4);
    shifted["agents"][0]["path"][0] = json!({ "kind": "line", "length": 1.0 });
    shifted["agents"][0]["path"][4] = json!({ "kind": "line", "length": 2.0 });
    let place = Scenario::from_value(&shifted).unwrap_err().to_string();
    assert!(place.contains("piece 4 turns in place at 2"), "{place}");
    let mut fewer = file.clone();
    fewer["agents"][0]["path"].as_array_mut().unwrap().remove(5);
    let none = Scenario::from_value(&fewer).unwrap_err().to_string();
    assert!(none.contains("piece 9 turns in place; there is no turn left on the path"), "{none}");
    let mut more = file.clone();
    more["agents"][0]["path"].as_array_mut().unwrap().push(json!({ "kind": "turn", "sweep": 1.0 }));
    let more = Scenario::from_value(&more).unwrap_err().to_string();
    assert!(more.contains("does not turn in place on segment 8"), "{more}");
    let back = changed("/agents/0/profile/pieces/4/turn_accel", json!(-2.0));
    assert!(back.contains("profile piece 5, turn_accel: -2 brings the speed to"), "{back}");
    // Before version 3 there is neither, and from then on turns have no length.
    for version in [1, 2] {
        let mut old = file.clone();
        old["version"] = json!(version);
        let refused = Scenario::from_value(&old).unwrap_err().to_string();
        assert!(refused.contains("it is there from version 3 on"), "{refused}");
    }
    let long = |duration: f64, accel: f64| json!({ "duration": duration, "accel": 1e-9 * accel });
    let refused = Scenario::from_value(&turning(3, long, &kink)).unwrap_err().to_string();
    assert!(refused.contains("no turn_accel, although the path turns in place"), "{refused}");
}
