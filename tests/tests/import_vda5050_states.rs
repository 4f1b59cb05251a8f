//! States of VDA 5050: where vehicles say that they are, and where to.

use crate::import_vda5050::{options, outlined, quarter, read, square};
use pcr_formats::import::ImportOptions;
use pcr_planning::fleet::Fleet;
use serde_json::{Value, json};

#[test]
fn states_tell_paths_with_or_without_times() {
    let pose = json!({ "x": 4.0, "y": 0.0, "theta": 0.0, "mapId": "m", "localized": true });
    let state = |more: Value| {
        let mut state = json!({ "timestamp": "2026-11-21T08:00:00.000Z", "serialNumber": "r7", "orderId": "o",
            "nodeStates": [{ "nodeId": "n1", "sequenceId": 2, "released": true }], "edgeStates": [], "mobileRobotPosition": pose });
        state.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        state.to_string()
    };
    let (scenario, _) =
        read(&state(json!({ "plannedPath": { "trajectory": quarter(), "traversedNodes": ["n1"] } })), &options())
            .unwrap();
    assert_eq!(scenario.agents[0].structure(), "AA");
    // Where it goes is told by nodes only: it does not stand.
    let lost = "state of r7: its way is told by nodeStates only, give its order instead";
    assert_eq!(read(&state(json!({})), &options()).unwrap_err(), format!("{lost}; --partial leaves that out"));
    let partial = ImportOptions { partial: true, ..options() };
    let (scenario, warnings) = read(&state(json!({})), &partial).unwrap();
    assert_eq!((scenario.agents[0].path.len(), scenario.agents[0].start), (0, [4.0, 0.0, 0.0]));
    assert_eq!(warnings, [format!("{lost}: left out")]);
    assert_eq!(scenario.warnings, [format!("{lost}: left out [left-out]")]);
    let (scenario, warnings) = read(&state(json!({ "nodeStates": [] })), &options()).unwrap();
    assert_eq!((scenario.agents[0].path.len(), warnings.len()), (0, 0));
    let timed = json!({ "polyline": [{ "x": 6.0, "y": 2.0, "eta": "2026-11-21T08:00:04Z" }] });
    let both = state(json!({ "plannedPath": {}, "intermediatePath": timed }));
    assert!(read(&both, &options()).unwrap_err().contains("its plannedPath, which goes on"));
    let elsewhere = json!({ "nodeStates": [], "plannedPath": { "trajectory": quarter() }, "mobileRobotPosition": { "x": 3.0, "y": 0.0 } });
    let error = read(&state(elsewhere), &options()).unwrap_err();
    assert_eq!(error, "state of r7, plannedPath: it begins 1.000 m from where the vehicle is");
    let point = |x: f64, y: f64, eta: &str| json!({ "x": x, "y": y, "eta": eta });
    let polyline = [
        point(6.0, 0.0, "2026-11-21T08:00:02Z"),
        point(6.0, 0.0, "2026-11-21T08:00:03.5Z"),
        point(6.0, 3.0, "2026-11-21T08:00:05.500Z"),
    ];
    let text = state(json!({ "nodeStates": [], "intermediatePath": { "polyline": polyline } }));
    // A second state, of another vehicle, that was sent a second later.
    let later = text.replace("08:00:00.000Z", "08:00:01Z").replace("\"r7\"", "\"r8\"");
    let (scenario, _) = read(&format!("{text}\n{later}"), &options()).unwrap();
    let fleet = Fleet::<f64>::new(&scenario).unwrap();
    let motions = fleet.motions();
    for (time, [x, y]) in
        [(1.0, [5.0, 0.0]), (2.0, [6.0, 0.0]), (3.0, [6.0, 0.0]), (4.5, [6.0, 1.5]), (9.0, [6.0, 3.0])]
    {
        let at = motions[0].position_at(time);
        assert!((at.x - x).hypot(at.y - y) < 1e-8, "{at:?} at {time}");
    }
    assert_eq!(motions[1].time().lo, 1.0);
    let backward = text.replace("08:00:03.5Z", "07:00:03.5Z");
    assert!(read(&backward, &options()).unwrap_err().contains("intermediatePath: point 3 is reached at -3596.5 s"));
    let no_stamp = text.replace("2026-11-21T08:00:02Z", "soon");
    assert!(read(&no_stamp, &options()).unwrap_err().ends_with("eta: \"soon\" is not a time stamp"));
}

/// A state of a vehicle at (4, 0).
fn state(more: Value) -> String {
    let mut state = json!({ "timestamp": "2026-11-21T08:00:00Z", "serialNumber": "r7", "orderId": "o", "nodeStates": [],
        "edgeStates": [], "mobileRobotPosition": { "x": 4.0, "y": 0.0, "theta": 0.0, "mapId": "m" } });
    state.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    state.to_string()
}

/// It was taken to stand for ever where the path of its state ends, or where it is.
#[test]
fn a_state_that_goes_on_is_refused() {
    let timed = json!({ "polyline": [{ "x": 6.0, "y": 2.0, "eta": "2026-11-21T08:00:04Z" }] });
    for (path, value) in [("plannedPath", json!({ "trajectory": quarter() })), ("intermediatePath", timed)] {
        let on = |node: Value, released: bool| {
            let node = json!({ "nodeId": "n1", "sequenceId": 2, "released": released, "nodePosition": node });
            let further = json!({ "nodeId": "n2", "sequenceId": 4, "released": false });
            read(&state(json!({ path: value, "nodeStates": [further, node] })), &options())
        };
        let lost = "state of r7, node n1: its way on to there, as its path ends before or elsewhere; give its order \
            instead; --partial leaves that out";
        assert!(on(json!({ "x": 6.0, "y": 2.0 }), true).is_ok() && on(json!({ "x": 6.0, "y": 9.0 }), false).is_ok());
        assert_eq!(on(json!({ "x": 6.0, "y": 9.0 }), true).unwrap_err(), lost);
        assert_eq!(on(Value::Null, true).unwrap_err(), lost);
        let edge = json!([{ "edgeId": "e1", "sequenceId": 1, "released": true }]);
        let error = read(&state(json!({ path: value, "edgeStates": edge })), &options()).unwrap_err();
        assert!(error.starts_with("state of r7, edge e1: where it leads"), "{error}");
    }
    let lost = "state of r7: its way, as it moves and does not say where to";
    for moves in [
        json!({ "driving": true }),
        json!({ "velocity": { "vx": 0.0, "vy": -0.5 } }),
        json!({ "velocity": { "omega": 0.1 } }),
        json!({ "edgeStates": [{ "edgeId": "e1", "sequenceId": 1, "released": true }] }),
    ] {
        assert_eq!(read(&state(moves), &options()).unwrap_err(), format!("{lost}; --partial leaves that out"));
    }
    assert!(read(&state(json!({ "driving": false, "velocity": { "vx": 0.0 } })), &options()).is_ok());
    let drives = json!({ "driving": true, "plannedPath": { "trajectory": quarter() } });
    let (_, warnings) = read(&state(drives), &options()).unwrap();
    assert_eq!(warnings, ["state of r7: it moves already; its plannedPath is travelled from rest"]);
}

/// It was read as standing where it says, although it says that it does not know.
#[test]
fn a_vehicle_that_does_not_know_where_it_is_is_refused() {
    for (pose, field, value) in [
        ("mobileRobotPosition", "localized", json!(false)),
        ("agvPosition", "positionInitialized", json!(false)),
        ("agvPosition", "localizationScore", json!(0.0)),
    ] {
        let mut at = json!({ "x": 4.0, "y": 0.0, "theta": 0.0, "mapId": "m" });
        at[field] = value;
        let error = read(&state(json!({ "mobileRobotPosition": null, pose: at })), &options()).unwrap_err();
        assert_eq!(error, format!("state of r7, {pose}, {field}: it does not know where it is"));
    }
}

/// A planned path began at the time 0, whatever the time stamp of its state was.
#[test]
fn planned_paths_begin_at_the_time_stamps_of_their_states() {
    let planned = state(json!({ "plannedPath": { "trajectory": quarter() } }));
    let points = json!({ "polyline": [{ "x": 6.0, "y": 2.0, "eta": "2026-11-21T08:00:14Z" }] });
    let timed = state(json!({ "serialNumber": "r8", "timestamp": "2026-11-21T08:00:10Z", "intermediatePath": points }));
    let starts = |text: &str| {
        let (scenario, _) = read(text, &options()).unwrap();
        scenario.agents.iter().map(|agent| agent.t_start).collect::<Vec<_>>()
    };
    assert_eq!(starts(&format!("{planned} {timed}")), [0.0, 10.0]);
    assert_eq!(starts(&format!("{timed} {planned}")), [0.0, -10.0]);
    // What stands does so at all times; what moves has to say from when on.
    let stands = state(json!({ "serialNumber": "r9", "timestamp": "2026-11-21T07:00:00Z" }));
    assert_eq!(starts(&format!("{stands} {timed} {planned}")), [0.0, 0.0, -10.0]);
    let unsaid = state(json!({ "timestamp": null, "plannedPath": { "trajectory": quarter() } }));
    assert_eq!(starts(&unsaid), [0.0]);
    let why = "it does not say when it begins, and cannot be read together with what does: state of r8";
    assert_eq!(read(&format!("{timed} {unsaid}"), &options()).unwrap_err(), format!("state of r7: {why}"));
    assert_eq!(read(&format!("{} {timed}", square()), &options()).unwrap_err(), format!("order square: {why}"));
    assert_eq!(starts(&format!("{} {stands}", square())), [0.0, 0.0]);
}

#[test]
fn loads_of_a_state_make_its_vehicle_larger() {
    let state = |loads: Value| {
        json!({ "serialNumber": "r7", "nodeStates": [], "loads": loads,
            "agvPosition": { "x": 1.0, "y": 2.0, "theta": 0.5, "mapId": "m" } })
        .to_string()
    };
    let load = |length: f64, width: f64, [x, y, theta]: [f64; 3]| {
        json!({ "loadId": "a", "loadDimensions": { "length": length, "width": width, "height": 1.0 },
            "boundingBoxReference": { "x": x, "y": y, "z": 0.2, "theta": theta } })
    };
    // A disc becomes the disc around both.
    let radius = |loads: Value| {
        let (scenario, warnings) = read(&state(loads), &options()).unwrap();
        (scenario.agents[0].radius, warnings)
    };
    assert_eq!(radius(Value::Null), (0.4, vec![]));
    assert_eq!(radius(json!([load(0.2, 0.2, [0.1, 0.0, 0.0])])), (0.4, vec![]));
    let (reach, warnings) = radius(json!([load(1.2, 0.8, [0.5, 0.0, 0.0])]));
    assert_eq!((reach, warnings), (1.1_f64.hypot(0.4), vec![]));
    // A quarter turn exchanges length and width.
    let (reach, _) = radius(json!([load(1.2, 0.8, [0.5, 0.0, std::f64::consts::FRAC_PI_2])]));
    assert!((reach - 0.9_f64.hypot(0.6)).abs() < 1e-12, "{reach}");
    let (reach, warnings) = radius(json!([{ "loadId": "b", "loadDimensions": { "length": 2.0, "width": 1.0 } }]));
    assert_eq!(reach, 1.0_f64.hypot(0.5));
    assert!(warnings[0].contains("state of r7, load 1: it has no boundingBoxReference"), "{warnings:?}");
    let (reach, warnings) = radius(json!([{ "loadId": "b", "loadType": "pallet" }]));
    assert!(reach == 0.4 && warnings[0].contains("no length and width"), "{warnings:?}");
    let (_, warnings) = radius(json!([load(0.0, 0.8, [0.0; 3])]));
    assert!(warnings[0].contains("not above 0"), "{warnings:?}");
    let (_, warnings) = radius(json!([load(0.8, 0.0, [0.0; 3])]));
    assert!(warnings[0].contains("not above 0"), "{warnings:?}");
    // Turned by an angle of which sine and cosine are 0.6 and 0.8.
    let (reach, _) = radius(json!([load(1.6, 0.4, [0.5, 0.2, 0.6_f64.asin()])]));
    let corners =
        [[0.8, 0.2], [0.8, -0.2]].map(|[x, y]: [f64; 2]| (0.5 + 0.8 * x - 0.6 * y).hypot(0.2 + 0.6 * x + 0.8 * y));
    assert!((reach - corners[0].max(corners[1])).abs() < 1e-12, "{reach} {corners:?}");
    let wrong = read(&state(json!([{ "loadDimensions": { "length": "2", "width": 1 } }])), &options()).unwrap_err();
    assert_eq!(wrong, "state of r7, load 1, loadDimensions, length: a text where a number is expected");
    assert!(read(&state(json!({})), &options()).unwrap_err().contains("loads: an object where a list"));

    // A contour becomes the hull of both.
    let fleet = concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json");
    let options = ImportOptions { fleet: Some(fleet.into()), ..ImportOptions::default() };
    let (scenario, _) = read(&state(json!([load(1.0, 1.2, [0.9, 0.0, 0.0])])), &options).unwrap();
    let outline = scenario.agents[0].footprint.as_ref().unwrap();
    let corners = [[-0.6, -0.4], [0.4, -0.6], [1.4, -0.6], [1.4, 0.6], [0.4, 0.6], [-0.6, 0.4]];
    assert_eq!(outline.polygon().len(), corners.len());
    for (corner, expected) in outline.polygon().iter().zip(corners) {
        assert!((corner[0] - expected[0]).hypot(corner[1] - expected[1]) < 1e-12, "{corner:?}");
    }
    assert_eq!(scenario.agents[0].radius, outline.circumscribed_radius());
}

/// Its planned path was travelled ahead, however the vehicle faced where it was.
#[test]
fn an_outline_faces_along_its_planned_path_or_backward_or_is_refused() {
    let planned = |theta: Value, nodes: Value| {
        let path = json!({ "trajectory": { "controlPoints": [{ "x": 0, "y": 0 }, { "x": 0, "y": 3 }, { "x": 4, "y": 3 }] },
            "traversedNodes": [] });
        let pose = json!({ "x": 0.0, "y": 0.0, "theta": theta, "mapId": "m" });
        state(json!({ "plannedPath": path, "mobileRobotPosition": pose, "nodeStates": nodes }))
    };
    let north = std::f64::consts::FRAC_PI_2;
    let (scenario, _) = read(&planned(json!(north), json!([])), &outlined()).unwrap();
    assert!(scenario.agents[0].footprint.is_some());
    // What a localization is off makes the outline larger.
    let growth = |theta: f64| {
        let (scenario, _) = read(&planned(json!(theta), json!([])), &outlined()).unwrap();
        scenario.agents[0].footprint.as_ref().unwrap().growth()
    };
    let more = growth(north + 0.1) - growth(north);
    assert!((0.05..0.2).contains(&more), "{more}");
    for theta in [0.0, north + 0.2] {
        let error = read(&planned(json!(theta), json!([])), &outlined()).unwrap_err();
        assert!(error.starts_with(&format!("state of r7: its theta {theta}, as outlines face along")), "{error}");
        assert!(read(&planned(json!(theta), json!([])), &options()).is_ok(), "it does not matter how a disc faces");
    }
    // The other way round it drives backward.
    let outline = |theta: f64| {
        let (scenario, _) = read(&planned(json!(theta), json!([])), &outlined()).unwrap();
        scenario.agents[0].footprint.as_ref().unwrap().polygon().to_vec()
    };
    let turned: Vec<_> = outline(north).iter().map(|corner| corner.map(|x| -x)).collect();
    assert_eq!(outline(-north), turned);
    // Nobody knows which way it faces: the disc around it.
    let (scenario, _) = read(&planned(Value::Null, json!([])), &outlined()).unwrap();
    assert!(scenario.agents[0].footprint.is_none() && scenario.agents[0].radius > 0.5);
    let node = |k: u64, x: f64, y: f64, theta: f64| {
        json!({ "nodeId": format!("n{k}"), "sequenceId": k, "released": true,
            "nodePosition": { "x": x, "y": y, "theta": theta, "mapId": "m" } })
    };
    let along = json!([node(2, 0.0, 1.0, north), node(4, 0.0, 3.0, 0.0), node(6, 4.0, 3.0, 0.0)]);
    assert!(read(&planned(json!(north), along), &outlined()).is_ok());
    let turned = json!([node(2, 0.0, 1.0, 0.0), node(6, 4.0, 3.0, north)]);
    let error = read(&planned(json!(north), turned), &outlined()).unwrap_err();
    for lost in ["state of r7, node n2: its theta 0, as", "state of r7, node n6: its theta 1.5"] {
        assert!(error.contains(lost), "{error}");
    }
}

/// An empty path with times made it stand, although it said that it moves.
#[test]
fn a_path_without_points_is_no_path() {
    let lost = "state of r7: its way, as it moves and does not say where to; --partial leaves that out";
    let at = json!([{ "x": 4.0, "y": 0.0, "eta": "2026-11-21T08:00:09Z" }]);
    for path in [json!({}), json!({ "polyline": [] }), json!({ "polyline": null }), json!({ "polyline": at })] {
        let moves = state(json!({ "intermediatePath": path, "driving": true }));
        assert_eq!(read(&moves, &options()).unwrap_err(), lost, "{path}");
        assert!(read(&state(json!({ "intermediatePath": path })), &options()).is_ok(), "{path}");
    }
    let point = json!({ "trajectory": { "controlPoints": [{ "x": 4, "y": 0 }, { "x": 4, "y": 0 }] } });
    assert_eq!(read(&state(json!({ "plannedPath": point, "driving": true })), &options()).unwrap_err(), lost);
    // The other path counts then.
    let both = state(json!({ "intermediatePath": { "polyline": [] }, "plannedPath": { "trajectory": quarter() } }));
    assert_eq!(read(&both, &options()).unwrap().0.agents[0].structure(), "AA");
}

/// Gaps were added at the beginning of a path only.
#[test]
fn the_gap_behind_a_planned_path_counts() {
    let radius = |x: f64, path: Value| {
        let node = json!({ "nodeId": "n1", "sequenceId": 2, "released": true, "nodePosition": { "x": x, "y": 2.0 } });
        let mut message = json!({ "nodeStates": [node] });
        message.as_object_mut().unwrap().extend(path.as_object().unwrap().clone());
        read(&state(message), &options()).unwrap().0.agents[0].radius
    };
    let points = json!([{ "x": 4.0, "y": 2.0, "eta": "2026-11-21T08:00:04Z" }, { "x": 6.0, "y": 2.0, "eta": "2026-11-21T08:00:09Z" }]);
    for path in
        [json!({ "plannedPath": { "trajectory": quarter() } }), json!({ "intermediatePath": { "polyline": points } })]
    {
        let whole = radius(6.0, path.clone());
        assert!((radius(6.04, path.clone()) - whole - 0.04).abs() < 1e-6, "{path}");
        assert!((radius(5.97, path.clone()) - whole - 0.03).abs() < 1e-6, "{path}");
    }
}

/// They set off at their time stamps.
#[test]
fn a_vehicle_that_is_halted_does_not_say_when_it_goes_on() {
    let timed = json!({ "polyline": [{ "x": 6.0, "y": 2.0, "eta": "2026-11-21T08:00:04Z" }] });
    for (path, value) in [("plannedPath", json!({ "trajectory": quarter() })), ("intermediatePath", timed)] {
        let with = |field: &str, of: Value| read(&state(json!({ path: value, field: of })), &options());
        for (field, of, why) in [
            ("paused", json!(true), "it is paused"),
            ("operatingMode", json!("MANUAL"), "its operatingMode is MANUAL"),
            ("safetyState", json!({ "eStop": "AUTOACK" }), "its eStop is AUTOACK"),
            ("safetyState", json!({ "activeEmergencyStop": "REMOTE" }), "its activeEmergencyStop is REMOTE"),
            ("safetyState", json!({ "fieldViolation": true }), "there is something in its protective field"),
        ] {
            let lost = format!("state of r7: when it goes on along its path, as {why}; --partial leaves that out");
            assert_eq!(with(field, of.clone()).unwrap_err(), lost);
            // One that stands is where it is.
            assert!(read(&state(json!({ field: of })), &options()).is_ok());
        }
        for (field, of) in [
            ("paused", json!(false)),
            ("operatingMode", json!("SEMIAUTOMATIC")),
            ("safetyState", json!({ "eStop": "NONE", "activeEmergencyStop": "NONE", "fieldViolation": false })),
            ("actionStates", json!([{ "actionId": "a", "actionStatus": "FINISHED" }])),
        ] {
            assert_eq!(with(field, of).unwrap().1, [""; 0]);
        }
        let acts = with("actionStates", json!([{ "actionId": "a", "actionStatus": "RUNNING" }])).unwrap().1;
        assert_eq!(acts, ["state of r7: its actions take no time here: the file does not say how long they last"]);
    }
}

/// They were compared in orders only.
#[test]
fn nodes_of_a_state_are_on_the_map_of_its_vehicle() {
    let on = |map: &str, released: bool| {
        let node = json!({ "nodeId": "n1", "sequenceId": 2, "released": released,
            "nodePosition": { "x": 6.0, "y": 2.0, "mapId": map } });
        read(&state(json!({ "plannedPath": { "trajectory": quarter() }, "nodeStates": [node] })), &options())
    };
    assert!(on("m", true).is_ok() && on("upstairs", false).is_ok());
    assert_eq!(on("upstairs", true).unwrap_err(), "state of r7: it leads from map m to map upstairs");
}

/// Seconds since 1970 are off by 0.2 µs, in which a vehicle of 2 m/s goes 0.4 µm.
#[test]
fn starts_are_those_of_the_time_stamps_to_the_last_digit() {
    let stamped = |time: &str, name: &str| {
        let path = json!({ "trajectory": quarter() });
        state(json!({ "serialNumber": name, "timestamp": time, "plannedPath": path }))
    };
    let both = [stamped("2026-11-21T08:00:00.000001Z", "a"), stamped("2026-11-21T08:00:00.101404Z", "b")].join("\n");
    let starts: Vec<f64> = read(&both, &options()).unwrap().0.agents.iter().map(|agent| agent.t_start).collect();
    assert!(starts[0] == 0.0 && (starts[1] - 0.101403).abs() < 1e-15, "{starts:?}");
}
