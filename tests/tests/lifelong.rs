//! Fleets that run for a while on a real layout: no contact, nobody beyond its hold, everybody arrives in the end.

use pcr_execution::lifelong::{
    CoordinationMethod, DelayModel, LifelongOptions, LifelongReport, LifelongResult, TimeShares, run, streets,
    well_formedness,
};
use pcr_formats::import::{self, ImportOptions, ImportedLayout, InputFormat, Warnings};
use std::f64::consts::TAU;

pub(crate) const WAREHOUSE: &str = include_str!("../data/real/nav2/warehouse_graph.geojson");

pub(crate) fn layout(format: InputFormat, text: &str, radius: f64) -> ImportedLayout {
    let options = ImportOptions {
        radius: Some(radius),
        speed: Some(1.0),
        acceleration: Some(0.5),
        rotation: Some(1.0),
        rotation_acceleration: Some(1.0),
        ..ImportOptions::default()
    };
    import::layout(format, text, &options, &mut Warnings::default()).expect("a layout")
}

fn warehouse(agents: usize, minutes: f64, stopped: f64, method: CoordinationMethod) -> LifelongResult {
    driven(&layout(InputFormat::Nav2, WAREHOUSE, 0.4), agents, minutes, stopped, method)
}

fn driven(
    imported: &ImportedLayout,
    agents: usize,
    minutes: f64,
    stopped: f64,
    method: CoordinationMethod,
) -> LifelongResult {
    let delays = DelayModel { stopped, ..DelayModel::default() };
    let request = LifelongOptions { agents, duration: 60.0 * minutes, delays, seed: 3, method };
    let report = run(imported, request).expect("a run");
    let (alone, outcome) = (report.alone, report.outcome);
    // By some missions on either side of the time that counts, at most.
    let steady = outcome.missions_per_hour * 0.9 * minutes / 60.0;
    assert!(steady <= alone * 0.9 * minutes / 60.0 + agents as f64, "{alone} an hour alone, {outcome:?}");
    assert!(report.decisions.len() >= outcome.missions);
    assert_eq!(
        (outcome.certificate.verdict, outcome.authority_overruns, outcome.stuck),
        ("proved", 0, 0),
        "{outcome:?}"
    );
    assert!(outcome.standstill < 60.0 && (agents == 1 || outcome.certificate.steps > 0), "{outcome:?}");
    let TimeShares { driving, turning, stopped: stops, waiting: held, yielding: aside, idle } = outcome.time;
    assert!((driving + turning + stops + held + aside + idle - 1.0).abs() < 1e-9, "{outcome:?}");
    // Nobody goes before a robot that is alone.
    assert!(agents > 1 || held == 0.0, "{outcome:?}");
    outcome
}

#[test]
fn robots_of_a_warehouse_carry_out_missions_and_never_touch() {
    let minutes = if cfg!(optimized) { 15.0 } else { 3.0 };
    let outcome = warehouse(6, minutes, 0.0, CoordinationMethod::Orders);
    // One alone carries out 47 an hour.
    assert!(outcome.missions_per_hour > 150.0 && outcome.robots == 6, "{outcome:?}");
    assert!(warehouse(1, 3.0, 0.02, CoordinationMethod::Orders).missions > 0);
}

#[test]
fn robots_that_are_stopped_at_random_arrive_all_the_same() {
    let outcome = warehouse(8, if cfg!(optimized) { 15.0 } else { 3.0 }, 0.2, CoordinationMethod::Orders);
    assert!(outcome.missions > 3, "{outcome:?}");
}

#[test]
fn locks_on_edges_let_everybody_arrive() {
    let outcome = warehouse(8, if cfg!(optimized) { 15.0 } else { 3.0 }, 0.2, CoordinationMethod::EdgeLocks);
    assert!(outcome.missions > 3 && outcome.revised == 0, "{outcome:?}");
}

/// Others of the repository, certified; nobody gets stuck with any method.
#[test]
fn orders_do_more_missions_than_locks_on_other_layouts() {
    let (agents, minutes) = if cfg!(optimized) { (10, 4.0) } else { (4, 3.0) };
    let layouts = [
        (InputFormat::Nav2, include_str!("../data/real/nav2/aws_graph.geojson")),
        (InputFormat::Rmf, include_str!("../data/real/rmf/office.building.yaml")),
        (InputFormat::Rmf, include_str!("../data/real/rmf/triple_H.building.yaml")),
    ];
    for (format, text) in layouts {
        let imported = layout(format, text, 0.3);
        let [orders, locks @ ..] =
            [CoordinationMethod::Orders, CoordinationMethod::RouteLocks, CoordinationMethod::EdgeLocks]
                .map(|method| driven(&imported, agents, minutes, 0.02, method).missions);
        assert!(locks.iter().all(|&missions| missions > 0 && missions < orders), "{format}: {orders}, {locks:?}");
    }
}

/// Joints of these roads are open by up to some millimetres: what is certified has larger discs by that.
#[test]
fn open_joints_of_roads_are_certified() {
    let text = include_str!("../data/real/opendrive/Town01.planview.xodr");
    let (agents, minutes) = if cfg!(optimized) { (10, 6.0) } else { (6, 3.0) };
    let outcome = driven(&layout(InputFormat::OpenDrive, text, 0.5), agents, minutes, 0.02, CoordinationMethod::Orders);
    assert!(outcome.missions > 0, "{outcome:?}");
}

/// There are 17 safe ends: the others stand where they cut off few, and go away when asked.
#[test]
fn more_robots_than_safe_ends_go_on_all_the_same() {
    let (agents, minutes) = if cfg!(optimized) { (20, 4.0) } else { (19, 2.0) };
    let outcome = warehouse(agents, minutes, 0.02, CoordinationMethod::Orders);
    assert!(outcome.robots == agents && outcome.missions > agents / 2, "{outcome:?}");
}

/// More robots than are taken whole: decisions keep a timetable of all others.
#[test]
fn large_fleets_never_touch_and_all_arrive() {
    let (agents, minutes) = if cfg!(optimized) { (100, 2.0) } else { (70, 1.0) };
    let outcome = driven(&streets(10), agents, minutes, 0.05, CoordinationMethod::Orders);
    assert!(outcome.robots == agents && outcome.missions > agents / 4, "{outcome:?}");
}

/// Too many nodes to look at all sets of ends, and no dead ends: no end is known to be safe. Robots drove one at a time there.
#[test]
fn robots_drive_together_where_no_end_is_safe() {
    let mut imported = streets(32);
    imported.layout.edges.retain(|edge| !edge.is_two_way());
    let form = well_formedness(&imported, 3).expect("a layout");
    assert!(form.safe_ends.is_empty() && form.dead_ends_only, "{form:?}");
    let outcome = driven(&imported, 12, 2.0, 0.02, CoordinationMethod::Orders);
    assert!(outcome.robots == 12 && outcome.missions > 4 && outcome.time.idle < 0.2, "{outcome:?}");
}

/// 20 robots in a tree of 21 nodes and the room on its dead ends. Nobody moved any more after three minutes, as all places were on routes
/// that were reserved for one another.
#[test]
fn a_tree_full_of_robots_goes_on() {
    let imported = layout(InputFormat::Rmf, include_str!("../data/real/rmf/battle_royale.building.yaml"), 0.3);
    let request = LifelongOptions {
        agents: 20,
        duration: 420.0,
        delays: DelayModel::default(),
        seed: 2,
        method: CoordinationMethod::Orders,
    };
    let outcome = run(&imported, request).expect("a run").outcome;
    assert!(outcome.robots == 20 && outcome.missions > 20, "{outcome:?}");
    assert_eq!((outcome.certificate.verdict, outcome.stuck), ("proved", 0));
}

/// The same missions, the same delays.
#[test]
fn orders_do_more_missions_than_locks_and_start_delays() {
    let minutes = if cfg!(optimized) { 12.0 } else { 4.0 };
    let [orders, routes, edges, delays] =
        CoordinationMethod::ALL.map(|method| warehouse(8, minutes, 0.02, method).missions);
    assert!([routes, edges, delays].iter().all(|&missions| missions > 0 && missions < orders), "{orders}");
    assert!(2 * routes < orders, "{orders}, locks on routes {routes}, on edges {edges}");
}

/// All nine nodes are taken: no robot can go anywhere.
#[test]
fn a_fleet_in_which_nobody_can_do_anything_says_why() {
    let imported = layout(InputFormat::Nav2, include_str!("../data/real/nav2/sample_graph.geojson"), 0.3);
    let request = LifelongOptions {
        agents: 10,
        // Together they move up for some minutes, until all have gone round.
        duration: 600.0,
        delays: DelayModel::default(),
        seed: 1,
        method: CoordinationMethod::Orders,
    };
    let why = |agents: usize| {
        let answer =
            LifelongReport::run(&imported, LifelongOptions { agents, ..request }, &[CoordinationMethod::Orders])
                .expect("a run");
        let outcome = &answer.runs[0].outcome;
        (outcome.robots, outcome.idle_because.clone(), answer.is_sound())
    };
    let (robots, idle, is_sound) = why(10);
    assert_eq!((robots, is_sound), (9, false));
    let idle = idle.expect("a reason");
    assert!(idle.ends_with(": the 9 robots take up all places where any of them could stand"), "{idle}");
    assert_eq!(why(4), (4, None, true));
}

/// A layout of nav2 with these points, and a two-way edge between each of these pairs of them.
pub(crate) fn graph(points: &[[f64; 2]], edges: &[[usize; 2]]) -> String {
    one_way(points, &edges.iter().flat_map(|&[a, b]| [[a, b], [b, a]]).collect::<Vec<_>>())
}

/// A layout of nav2 with these points, and an edge from the first to the second of each of these pairs.
pub(crate) fn one_way(points: &[[f64; 2]], edges: &[[usize; 2]]) -> String {
    let feature = |properties: String, kind: &str, at: String| {
        let geometry = format!(r#"{{"type":"{kind}","coordinates":{at}}}"#);
        format!(r#"{{"type":"Feature","properties":{{{properties}}},"geometry":{geometry}}}"#)
    };
    let node =
        |(k, [x, y]): (usize, &[f64; 2])| feature(format!(r#""id":{k},"frame":"map""#), "Point", format!("[{x},{y}]"));
    let edge = |(k, &[a, b]): (usize, &[usize; 2])| {
        let [[x, y], [u, v]] = [points[a], points[b]];
        let properties = format!(r#""id":{},"startid":{a},"endid":{b}"#, 1000 + k);
        feature(properties, "MultiLineString", format!("[[[{x},{y}],[{u},{v}]]]"))
    };
    let features: Vec<String> = points.iter().enumerate().map(node).chain(edges.iter().enumerate().map(edge)).collect();
    format!(r#"{{"type":"FeatureCollection","features":[{}]}}"#, features.join(","))
}

/// Robots at all safe ends: they can change places where there is room in front of the ends. On a line there is none past each other,
/// and the answer is no success.
#[test]
fn as_many_robots_as_safe_ends_go_on_or_say_why_not() {
    let star: Vec<[f64; 2]> =
        (0..6).map(|k| f64::from(k).to_radians() * 60.0).map(|a| [5.0 * a.cos(), 5.0 * a.sin()]).collect();
    let points: Vec<[f64; 2]> = std::iter::once([0.0; 2]).chain(star).collect();
    let edges: Vec<[usize; 2]> = (1..7).map(|leaf| [0, leaf]).collect();
    let answer = |text: &str, agents: usize, hours: f64| {
        let imported = layout(InputFormat::Nav2, text, 0.4);
        let request = LifelongOptions {
            agents,
            duration: 3600.0 * hours,
            delays: DelayModel::default(),
            seed: 1,
            method: CoordinationMethod::Orders,
        };
        LifelongReport::run(&imported, request, &[CoordinationMethod::Orders]).expect("a run")
    };
    let star = answer(&graph(&points, &edges), 6, 0.25);
    assert_eq!((star.well_formedness.safe_ends.len(), star.runs[0].outcome.starved), (6, 0));
    assert!(star.is_sound() && star.runs[0].outcome.missions > 40, "{star:?}");
    let points: Vec<[f64; 2]> = (0..4).map(|k| [4.0 * f64::from(k), 0.0]).collect();
    let line = answer(&graph(&points, &[[0, 1], [1, 2], [2, 3]]), 2, 0.5);
    let outcome = &line.runs[0].outcome;
    assert!(!line.is_sound() && outcome.starved == 2 && outcome.missions > 0, "{line:?}");
    assert!(
        outcome.idle_because.as_ref().is_some_and(|why| why.starts_with("nobody has reached a goal for ")),
        "{line:?}"
    );
    // Also in a short run.
    let short = answer(&graph(&points, &[[0, 1], [1, 2], [2, 3]]), 2, 0.1);
    let why = short.runs[0].outcome.idle_because.as_deref().unwrap_or_default();
    assert!(!short.is_sound() && why.starts_with("nobody has moved for "), "{short:?}");
    // A robot at one of two nodes leaves none that could be reached.
    let two = layout(InputFormat::Nav2, &graph(&points[..2], &[[0, 1]]), 0.4);
    assert_eq!(well_formedness(&two, 1).expect("a site").safe_ends.len(), 1);
}

/// On a round every robot is in the way of the one behind it, and nobody can make way but by going on.
#[test]
fn rounds_without_bays_go_on_also_when_all_places_are_taken() {
    let minutes = if cfg!(optimized) { 15.0 } else { 3.0 };
    let square = |k: usize| {
        [[0.0, 0.0], [5.0, 0.0], [10.0, 0.0], [10.0, 5.0], [10.0, 10.0], [5.0, 10.0], [0.0, 10.0], [0.0, 5.0]][k]
    };
    let around = |k: usize| (TAU * k as f64 / 16.0).sin_cos();
    let ring: Vec<[f64; 2]> = (0..16).map(|k| [12.0 * around(k).1, 12.0 * around(k).0]).collect();
    let next = |count: usize| -> Vec<[usize; 2]> { (0..count).map(|k| [k, (k + 1) % count]).collect() };
    let eight: Vec<[f64; 2]> = (0..8).map(square).collect();
    let four: Vec<[f64; 2]> = [0, 2, 4, 6].map(square).to_vec();
    let sites = [
        (one_way(&four, &next(4)), vec![(2, 100.0), (4, 200.0)]),
        (one_way(&eight, &next(8)), vec![(2, 100.0), (4, 200.0), (8, 200.0)]),
        (one_way(&ring, &next(16)), vec![(8, 150.0)]),
        (graph(&ring, &next(16)), vec![(4, 80.0)]),
    ];
    for (text, fleets) in sites {
        let imported = layout(InputFormat::Nav2, &text, 0.4);
        for (agents, least) in fleets {
            let outcome = driven(&imported, agents, minutes, 0.02, CoordinationMethod::Orders);
            assert_eq!((outcome.robots, outcome.starved), (agents, 0), "{outcome:?}");
            // Short runs only show that somebody arrives.
            let least = if minutes < 10.0 { 1.0 } else { least };
            assert!(outcome.missions_per_hour >= least, "{agents}: {outcome:?}");
        }
    }
}

/// Short edges, on which the largest speed is not reached.
#[test]
fn nobody_is_quicker_than_alone() {
    let points: Vec<[f64; 2]> = (0..5).map(|k| [0.3 * f64::from(k), 0.0]).collect();
    let imported = layout(InputFormat::Nav2, &graph(&points, &[[0, 1], [1, 2], [2, 3], [3, 4]]), 0.1);
    let delays = DelayModel { stopped: 0.0, stop: 5.0, slip: 0.0 };
    let request = LifelongOptions { agents: 1, duration: 600.0, delays, seed: 1, method: CoordinationMethod::Orders };
    let outcome = run(&imported, request).expect("a run").outcome;
    let travel = outcome.travel_over_unimpeded.expect("missions");
    assert!((1.0..1.2).contains(&travel), "{outcome:?}");
}

/// The edges begin and end far from the two nodes, so that robots count as larger than the nodes are apart. A goal where a robot would not
/// touch one at the other node was drawn again and again, without end. Neither node is a safe end; one robot drives all the same.
#[test]
fn one_robot_drives_between_two_nodes_that_touch() {
    let text = include_str!("../data/real/lif/example_17.lif.json");
    let imported = import::roads(
        InputFormat::Lif,
        text,
        &ImportOptions { radius: Some(0.3), ..ImportOptions::default() },
        &mut Warnings::default(),
    );
    let request = LifelongOptions {
        agents: 10,
        duration: 300.0,
        delays: DelayModel::default(),
        seed: 1,
        method: CoordinationMethod::Orders,
    };
    let report = run(&imported.expect("a layout"), request).expect("a run");
    let outcome = &report.outcome;
    assert_eq!((outcome.robots, outcome.stuck, outcome.certificate.verdict), (1, 0, "proved"), "{outcome:?}");
    assert!(outcome.missions > 30 && outcome.idle_because.is_none(), "{outcome:?}");
}

/// To and fro between two nodes 10 m apart: 10 m at 1 m/s, 2 s for the ramps at 0.5 m/s², and half a turn at 1 rad/s, ramps of 1 s.
#[test]
fn robots_turn_before_they_go_back() {
    let corridor = r#"{"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"id": 0}, "geometry": {"type": "Point", "coordinates": [0, 0]}},
        {"type": "Feature", "properties": {"id": 1}, "geometry": {"type": "Point", "coordinates": [10, 0]}},
        {"type": "Feature", "properties": {"id": 2, "startid": 0, "endid": 1},
            "geometry": {"type": "LineString", "coordinates": [[0, 0], [10, 0]]}},
        {"type": "Feature", "properties": {"id": 3, "startid": 1, "endid": 0},
            "geometry": {"type": "LineString", "coordinates": [[10, 0], [0, 0]]}}]}"#;
    let delays = DelayModel { stopped: 0.0, stop: 5.0, slip: 0.0 };
    let request = LifelongOptions { agents: 1, duration: 1000.0, delays, seed: 1, method: CoordinationMethod::Orders };
    let outcome = run(&layout(InputFormat::Nav2, corridor, 0.4), request).expect("a run").outcome;
    let alone = 10.0 + 2.0 + std::f64::consts::PI + 1.0;
    let missions = 1000.0 / alone;
    assert!((outcome.missions as f64 - missions).abs() < 3.0, "{outcome:?}, expected {missions}");
}

/// At a corner within an edge a robot turned for ever, as the same way again looked sooner; and with a piece that an edge has twice the
/// corner was at another length.
#[test]
fn robots_turn_once_at_corners_within_edges() {
    let node = |id: &str, [x, y]: [f64; 2]| serde_json::json!({ "nodeId": id, "mapId": "m", "nodePosition": { "x": x, "y": y }, "vehicleTypeNodeProperties": [] });
    let edge = |id: &str, [from, to]: [&str; 2], points: &[[f64; 2]]| {
        let points: Vec<_> = points.iter().map(|[x, y]| serde_json::json!({ "x": x, "y": y })).collect();
        serde_json::json!({ "edgeId": id, "startNodeId": from, "endNodeId": to, "vehicleTypeEdgeProperties":
            [{ "vehicleTypeId": "V", "trajectory": { "degree": 1, "controlPoints": points } }] })
    };
    let (a, b) = ([0.0, 0.0], [5.0, 5.0]);
    for bends in [vec![[5.0, 0.0]], vec![[5.0, 0.0], [0.0, 0.0], [5.0, 0.0]]] {
        let points = [&[a], &bends[..], &[b]].concat();
        let file = serde_json::json!({ "metaInformation": { "projectIdentification": "bends", "lifVersion": "1.0.0" },
            "layouts": [{ "layoutId": "L", "nodes": [node("A", a), node("B", b)], "stations": [],
                "edges": [edge("there", ["A", "B"], &points), edge("back", ["B", "A"], &[b, a])] }] });
        let imported = layout(InputFormat::Lif, &file.to_string(), 0.2);
        for method in CoordinationMethod::ALL {
            let outcome = driven(&imported, 1, 10.0, 0.0, method);
            assert!(outcome.missions > 10 && outcome.time.turning < 0.6, "{method:?}: {outcome:?}");
        }
    }
}
