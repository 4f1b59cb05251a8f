//! Missions of files on small sites.

use super::*;
use pcr_formats::import::{Facing, ImportOptions, InputFormat, Warnings, roads};
use pcr_formats::missions::{MissionSource, RecordKind};
use pcr_formats::scenario::{Agent, PathSegment, PlacedSegment, REVERSE};
use pcr_formats::splitmix64::SplitMix64;
use pcr_planning::check::CheckReport;

mod passing;

/// A site with these nodes; edges with their ids, from node to node.
fn site(points: &[[f64; 2]], edges: &[(usize, [usize; 2])]) -> ImportedLayout {
    let node = |(id, [x, y]): (usize, &[f64; 2])| {
        format!(
            r#"{{"type":"Feature","properties":{{"id":{id}}},"geometry":{{"type":"Point","coordinates":[{x},{y}]}}}}"#
        )
    };
    let edge = |&(id, [from, to]): &(usize, [usize; 2])| {
        let ([x, y], [u, v]) = (points[from], points[to]);
        format!(
            r#"{{"type":"Feature","properties":{{"id":{id},"startid":{from},"endid":{to}}},
            "geometry":{{"type":"LineString","coordinates":[[{x},{y}],[{u},{v}]]}}}}"#
        )
    };
    let features: Vec<String> = points.iter().enumerate().map(node).chain(edges.iter().map(edge)).collect();
    let text = format!(r#"{{"type":"FeatureCollection","name":"site","features":[{}]}}"#, features.join(","));
    let options = ImportOptions { radius: Some(0.4), ..ImportOptions::default() };
    roads(InputFormat::Nav2, &text, &options, &mut Warnings::default()).expect("a layout")
}

/// Edges in both directions, with ids from 100 on.
fn two_way(edges: &[[usize; 2]]) -> Vec<(usize, [usize; 2])> {
    let both = edges.iter().flat_map(|&[a, b]| [[a, b], [b, a]]);
    (100..).zip(both).collect()
}

/// A corridor with an alcove in its middle (node 3).
fn alcove() -> ImportedLayout {
    site(&[[0.0, 0.0], [5.0, 0.0], [10.0, 0.0], [5.0, 3.0]], &two_way(&[[0, 1], [1, 2], [1, 3]]))
}

/// A square of 10 m, with a bay at each corner (nodes 4 to 7).
fn square() -> ImportedLayout {
    let points =
        [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0], [-3.0, 0.0], [13.0, 0.0], [13.0, 10.0], [-3.0, 10.0]];
    site(&points, &two_way(&[[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 5], [2, 6], [3, 7]]))
}

/// The report of a file, of which the run is certified, also as it is written and read again, if it can be.
fn report(imported: &ImportedLayout, text: &str) -> MissionsReport {
    let source = MissionSource { text, kind: RecordKind::Mission };
    let fleet = FleetMissions::read(&[source], &imported.layout, &imported.vehicle).expect("missions");
    let (report, scenario) = MissionsReport::run(imported, &fleet, &|_, _| {}).expect("a run");
    assert_eq!(report.certificate.verdict, "proved", "{report:?}");
    if let Some(scenario) = scenario {
        let read = Scenario::from_json(&scenario.to_json()).expect("a scenario");
        assert_eq!(CheckReport::compute::<f64>(&read, false).expect("a check").conflicts.len(), 0);
        assert_eq!(read.agents.len(), fleet.vehicles.len());
    }
    report
}

fn finish(report: &MissionsReport, id: &str) -> Option<f64> {
    report.missions.iter().find(|mission| mission.id == id).expect("a mission").finish
}

#[test]
fn two_vehicles_pass_one_another_at_an_alcove() {
    let report = report(
        &alcove(),
        r#"{"kind": "vehicle", "id": "a", "start": 0}
        {"kind": "vehicle", "id": "b", "start": 2}
        {"id": "m1", "vehicle": "a", "to": 2, "due": 10}
        {"id": "m2", "vehicle": "b", "to": 0}"#,
    );
    assert!(report.is_sound() && report.done == 2 && report.late == 1, "{report:?}");
    assert!(!report.waits.is_empty(), "{report:?}");
    assert_eq!([&report.vehicles[0].end, &report.vehicles[1].end], [&Some("2".into()), &Some("0".into())]);
}

#[test]
fn stops_are_visited_one_after_the_other_by_the_nearest_vehicle() {
    let report = report(
        &square(),
        r#"{"kind": "vehicle", "id": "far", "start": 6}
        {"kind": "vehicle", "id": "near", "start": 4}
        {"id": 1, "from": 0, "via": [1, 2], "to": 5, "release": 20, "priority": 2}"#,
    );
    assert!(report.is_sound(), "{report:?}");
    let mission = &report.missions[0];
    assert_eq!((mission.id.as_str(), mission.vehicle.as_deref()), ("1", Some("near")));
    let times: Vec<f64> = mission.stops.iter().map(|stop| stop.time.expect("reached")).collect();
    assert!(mission.start >= Some(20.0) && times.is_sorted() && times.len() == 4, "{mission:?}");
    // 10 m at 1 m/s and the ramps, with a quarter turn at the second one.
    assert!(times[1] - times[0] >= 10.0 && times[3] - times[2] >= 13.0, "{mission:?}");
}

/// They were refused.
#[test]
fn vehicles_leave_their_bays_backward_and_travel_sideways() {
    for (facing, angle) in [(Facing::Backward, REVERSE), (Facing::sideways(1.0), 1.0)] {
        let mut imported = square();
        for edge in imported.layout.edges.iter_mut().filter(|edge| edge.ends[0] >= 4) {
            edge.facing = [facing; 2];
        }
        let text = r#"{"kind": "vehicle", "id": "truck", "start": 4, "length": 1.6, "width": 0.8, "speed": 0.5}
            {"kind": "vehicle", "id": "other", "start": 6, "length": 1.2, "width": 0.6}
            {"kind": "vehicle", "id": "disc", "start": 5, "radius": 0.4}
            {"id": "a", "vehicle": "truck", "to": 6, "via": [0]}
            {"id": "b", "vehicle": "other", "to": 4}
            {"id": "c", "vehicle": "disc", "to": 7}
            {"id": "d", "vehicle": "truck", "to": 5}"#;
        let report = report(&imported, text);
        assert!(report.is_sound() && report.done == 4, "{report:?}");
        let source = MissionSource { text, kind: RecordKind::Mission };
        let fleet = FleetMissions::read(&[source], &imported.layout, &imported.vehicle).expect("missions");
        let (_, scenario) = MissionsReport::run(&imported, &fleet, &|_, _| {}).expect("a run");
        let agents = scenario.expect("a run that is a scenario").agents;
        let facings = |agent: &Agent| {
            let facing = |segment: &PathSegment| match *segment {
                PathSegment::Facing { after, .. } => Some(after),
                _ => None,
            };
            agent.path.iter().filter_map(facing).collect::<Vec<_>>()
        };
        // Out of a bay, and ahead from the aisle on.
        for (agent, least) in [(0, 2), (1, 1), (2, 0)] {
            let facings = facings(&agents[agent]);
            assert!(facings.chunks(2).all(|pair| pair == [angle, 0.0]), "{facings:?}");
            assert!(facings.len() >= 2 * least && (least > 0 || facings.is_empty()), "{facings:?}");
        }
        // The path of the scenario leads to the bay where the truck ends.
        let placed = agents[0].path.iter().fold(
            PlacedSegment {
                start: [agents[0].start[0], agents[0].start[1]],
                heading: agents[0].start[2],
                shape: PathSegment::Line { length: 0.0 },
            },
            |last, &shape| PlacedSegment { start: last.end(), heading: last.heading_at_end(), shape },
        );
        let [x, y] = placed.end();
        assert!(f64::hypot(x - 13.0, y) < 1e-6, "{x} {y}");
    }
}

#[test]
fn several_types_of_vehicles_keep_apart_as_large_as_they_are() {
    let report = report(
        &square(),
        r#"{"kind": "vehicle", "id": "truck", "start": 4, "length": 1.6, "width": 0.8, "speed": 0.5}
        {"kind": "vehicle", "id": "small", "start": 6, "radius": 0.25, "speed": 1.5}
        {"kind": "vehicle", "id": "disc", "start": 5, "radius": 0.6}
        {"id": "a", "vehicle": "truck", "to": 6}
        {"id": "b", "vehicle": "small", "to": 4}
        {"id": "c", "vehicle": "disc", "to": 7}
        {"id": "d", "to": 5, "release": 10}"#,
    );
    assert!(report.is_sound() && report.done == 4, "{report:?}");
}

#[test]
fn edges_may_be_forbidden_to_a_vehicle() {
    let free = r#"{"kind": "vehicle", "id": "a", "start": 4}
        {"id": "m", "to": 5}"#;
    let forbidden = free.replace("\"start\": 4", "\"start\": 4, \"forbidden\": [100]");
    let imported = square();
    let [short, long] = [free, &forbidden].map(|text| report(&imported, text));
    assert!((short.vehicles[0].length - 16.0).abs() < 1e-6 && (long.vehicles[0].length - 36.0).abs() < 1e-6);
    assert!(short.is_sound() && long.is_sound());
}

#[test]
fn what_is_impossible_is_refused_at_once_with_the_reason() {
    let imported = square();
    let refused = report(
        &imported,
        r#"{"kind": "vehicle", "id": "a", "start": 4, "forbidden": [100, 107]}
        {"kind": "vehicle", "id": "b", "start": 6}
        {"id": "m1", "vehicle": "a", "to": 5}
        {"id": "m2", "vehicle": "b", "to": 5}"#,
    );
    assert_eq!((refused.done, refused.refused), (1, 1), "{refused:?}");
    let why = refused.missions[0].reason.as_deref().unwrap_or_default();
    assert_eq!(why, "vehicle a: no route leads from where it is to node 5 without the edges that are forbidden to it");
    assert!(!refused.is_sound() && refused.missions[0].start.is_none());
    // A node that nobody can leave is a goal all the same, and one that nobody can come to is none.
    let points = [[0.0, 0.0], [5.0, 0.0], [10.0, 0.0], [15.0, 0.0]];
    let one_way = site(&points, &[(10, [0, 1]), (11, [1, 0]), (12, [1, 2]), (13, [3, 2])]);
    let report = report(
        &one_way,
        r#"{"kind": "vehicle", "id": "a", "start": 0}
        {"id": "in", "to": 2, "release": 5}
        {"id": "out", "to": 3}"#,
    );
    assert!(finish(&report, "in").is_some() && finish(&report, "out").is_none(), "{report:?}");
    assert_eq!(report.missions[1].reason.as_deref(), Some("vehicle a: no route leads from where it is to node 3"));
}

#[test]
fn missions_of_high_priority_go_first() {
    let text = |high: &str, low: &str| {
        format!(
            r#"{{"kind": "vehicle", "id": "a", "start": 4}}
            {{"id": "low", "to": 5, "priority": {low}}}
            {{"id": "high", "to": 6, "priority": {high}}}"#
        )
    };
    let imported = square();
    let [first, second] = [("5", "1"), ("-1", "0")].map(|(high, low)| report(&imported, &text(high, low)));
    assert!(finish(&first, "high") < finish(&first, "low") && first.is_sound(), "{first:?}");
    assert!(finish(&second, "high") > finish(&second, "low") && second.is_sound(), "{second:?}");
}

#[test]
fn closed_edges_are_left_driven_round_or_waited_for() {
    let imported = square();
    let fleet = r#"{"kind": "vehicle", "id": "a", "start": 4}
        {"id": "m", "to": 5}"#;
    let closed = |what: &str| report(&imported, &format!("{fleet}\n{{\"kind\": \"closure\", {what}}}"));
    let effects = |report: &MissionsReport| {
        let it = &report.closures[0];
        [&it.through, &it.rerouted, &it.waited].map(Vec::len)
    };
    // Edges 100 and 101 are the lower side of the square. Long before it: round the square.
    let early = closed(r#""edge": 100, "at": 1"#);
    assert_eq!(effects(&early), [0, 1, 0], "{early:?}");
    assert!(early.is_sound() && early.vehicles[0].length > 30.0, "{early:?}");
    // On it: through.
    let late = closed(r#""edge": 100, "at": 10"#);
    assert_eq!(effects(&late), [1, 0, 0], "{late:?}");
    assert!(late.is_sound() && late.vehicles[0].length < 17.0, "{late:?}");
    // Closed before it begins: nobody is told, and the way is round the square as well.
    let before = closed(r#""edge": 100, "at": 0"#);
    assert!(before.is_sound() && before.vehicles[0].length > 30.0, "{before:?}");
    // The bay itself: it waits until it is opened.
    let bay = closed(r#""node": 5, "at": 2, "until": 100"#);
    assert!(bay.is_sound() && finish(&bay, "m") > Some(100.0), "{bay:?}");
    assert_eq!(effects(&bay), [0, 0, 1], "{bay:?}");
    // For ever: the mission is refused.
    let never = closed(r#""node": 5, "at": 2"#);
    assert_eq!(never.refused, 1, "{never:?}");
    let why = never.missions[0].reason.as_deref().unwrap_or_default();
    assert!(why.contains("closed"), "{why}");
    let lost = |report: &MissionsReport| {
        let lost = &report.closures[0].unreachable;
        lost.iter().map(|it| (it.vehicle.clone(), it.node.clone(), it.given_up)).collect::<Vec<_>>()
    };
    assert_eq!(lost(&never), [("a".into(), "5".into(), true)]);
    assert_eq!(lost(&bay), [("a".into(), "5".into(), false)]);
    assert_eq!(lost(&early), []);
}

/// 20 m straight on and 10 m more; the speed on the first edge is limited.
#[test]
fn a_limit_of_the_speed_holds_from_its_time_on() {
    let imported = site(&[[0.0, 0.0], [20.0, 0.0], [30.0, 0.0]], &two_way(&[[0, 1], [1, 2]]));
    let run = |closure: &str| {
        let fleet = r#"{"kind": "vehicle", "id": "a", "start": 0, "speed": 1.0, "acceleration": 0.5}
            {"id": "m", "to": 2}"#;
        report(&imported, &format!("{fleet}\n{closure}"))
    };
    let effects = |report: &MissionsReport| {
        let it = &report.closures[0];
        [&it.through, &it.slowed, &it.rerouted, &it.waited].map(Vec::len)
    };
    let time = |report: &MissionsReport| finish(report, "m").expect("it is done");
    let free = time(&run(""));
    assert!((free - 32.0).abs() < 0.2, "{free}");
    // From the beginning on: 20 m at 0.2 m/s instead of 1 m/s.
    let whole = run(r#"{"kind": "closure", "edge": 100, "speed": 0.2, "at": 0}"#);
    assert!((time(&whole) - (100.0 + 12.0)).abs() < 3.0 && effects(&whole) == [0; 4], "{whole:?}");
    // On its way: from 9 m on, of which it needs 0.96 m to brake.
    let late = run(r#"{"kind": "closure", "edge": 100, "speed": 0.2, "at": 10}"#);
    assert!((time(&late) - (11.6 + 10.04 / 0.2 + 12.0)).abs() < 3.0, "{late:?}");
    assert_eq!(effects(&late), [1, 1, 0, 0], "{late:?}");
    // For a while: 30 s at 0.2 m/s are 6 m.
    let passing = run(r#"{"kind": "closure", "edge": 100, "speed": 0.2, "at": 10, "until": 40}"#);
    assert!((time(&passing) - (free + 24.0)).abs() < 3.0, "{passing:?}");
    // Before it and able to brake: at the node it has the limit.
    let ahead = run(r#"{"kind": "closure", "edge": 102, "speed": 0.2, "at": 10}"#);
    assert!((time(&ahead) - (20.0 + 2.0 + 50.0)).abs() < 3.0 && effects(&ahead) == [0, 1, 0, 0], "{ahead:?}");
    // A limit above what it drives changes nothing.
    let high = run(r#"{"kind": "closure", "edge": 100, "speed": 3, "at": 5}"#);
    assert!((time(&high) - free).abs() < 1e-9 && effects(&high) == [0; 4], "{high:?}");
}

#[test]
fn a_limit_of_the_speed_sends_vehicles_another_way() {
    let fleet = r#"{"kind": "vehicle", "id": "a", "start": 4}
        {"id": "m", "to": 5}"#;
    let limited = |what: &str| report(&square(), &format!("{fleet}\n{{\"kind\": \"closure\", {what}}}"));
    // The lower side of the square is 10 m; round the square it is 30 m.
    let round = limited(r#""edge": 100, "speed": 0.05, "at": 1"#);
    assert!(round.closures[0].rerouted == ["a"] && round.vehicles[0].length > 30.0, "{round:?}");
    let on_it = limited(r#""edge": 100, "speed": 0.6, "at": 1"#);
    assert!(on_it.closures[0].slowed == ["a"] && on_it.vehicles[0].length < 17.0, "{on_it:?}");
}

/// The vehicle is on the first of two closed edges, and the second one is on its route.
#[test]
fn who_drives_through_and_gets_another_route_is_told_as_both() {
    let mut imported = square();
    let edges = [100, 102].map(|id| {
        imported.layout.edges.iter().position(|edge| edge.id.to_string() == id.to_string()).expect("an edge")
    });
    imported.layout.zones =
        vec![pcr_formats::import::LayoutZone { id: "south".into(), nodes: Vec::new(), edges: edges.to_vec() }];
    let both = report(
        &imported,
        r#"{"kind": "vehicle", "id": "a", "start": 4}
        {"id": "m", "to": 6}
        {"kind": "closure", "zone": "south", "at": 5}"#,
    );
    let it = &both.closures[0];
    assert_eq!((it.zone.as_deref(), &it.edge), (Some("south"), &None));
    assert!(both.is_sound(), "{both:?}");
    assert!(it.through == ["a"] && it.rerouted == ["a"], "{both:?}");
}

#[test]
fn vehicles_that_break_down_are_obstacles() {
    let imported = square();
    let fleet = r#"{"kind": "vehicle", "id": "a", "start": 4}
        {"kind": "vehicle", "id": "b", "start": 7}
        {"id": "m1", "vehicle": "a", "to": 5}
        {"id": "m2", "vehicle": "b", "to": 5, "release": 15}"#;
    let broken =
        |what: &str| report(&imported, &format!("{fleet}\n{{\"kind\": \"breakdown\", \"vehicle\": \"a\", {what}}}"));
    // In the middle of the lower side: the other one goes over the upper side.
    let side = broken(r#""at": 10"#);
    let it = &side.breakdowns[0];
    assert_eq!((it.edge.as_deref(), it.begun), (Some("100"), true), "{side:?}");
    assert!(it.x.is_some_and(|x| (1.0..9.0).contains(&x)), "{it:?}");
    assert!(finish(&side, "m1").is_none() && finish(&side, "m2").is_some(), "{side:?}");
    assert!(side.vehicles[1].end.as_deref() == Some("5") && side.vehicles[0].end.is_none(), "{side:?}");
    let why = side.missions[0].reason.as_deref().unwrap_or_default();
    assert!(why.contains("broke down at 10.0 s"), "{why}");
    // For half a minute: both get there, one after the other, as far as there is room.
    let text = r#"{"kind": "vehicle", "id": "a", "start": 4}
        {"kind": "vehicle", "id": "b", "start": 7}
        {"id": "m1", "vehicle": "a", "to": 5}
        {"id": "m2", "vehicle": "b", "to": 6}
        {"kind": "breakdown", "vehicle": "a", "at": 8, "until": 40}"#;
    let later = report(&imported, text);
    assert!(later.is_sound() && finish(&later, "m1") > Some(40.0) && finish(&later, "m2") < Some(40.0), "{later:?}");
}

/// A vehicle behind one that broke down on a one-way edge can go nowhere.
#[test]
fn who_is_behind_a_broken_vehicle_stops_behind_it() {
    let ring = site(
        &[[0.0, 0.0], [20.0, 0.0], [20.0, 10.0], [0.0, 10.0]],
        &[(10, [0, 1]), (11, [1, 2]), (12, [2, 3]), (13, [3, 0])],
    );
    let report = report(
        &ring,
        r#"{"kind": "vehicle", "id": "a", "start": 0}
        {"kind": "vehicle", "id": "b", "start": 3}
        {"id": "m1", "vehicle": "a", "to": 2}
        {"id": "m2", "vehicle": "b", "to": 1}
        {"kind": "breakdown", "vehicle": "a", "at": 12, "until": 60}"#,
    );
    assert!(report.done == 2 && finish(&report, "m2") > Some(60.0), "{report:?}");
}

/// The second mission goes to a bay that nobody can leave, and where a vehicle stands or comes to stand.
#[test]
fn a_mission_to_where_somebody_parks_for_good_is_refused_at_once() {
    let points = [[0.0, 0.0], [5.0, 0.0], [10.0, 0.0], [5.0, 5.0]];
    let imported = site(&points, &[(10, [0, 1]), (11, [1, 0]), (12, [1, 2]), (13, [1, 3]), (14, [3, 1])]);
    for (start, first, finished) in [(2, 2, 1), (0, 2, 1)] {
        let text = format!(
            r#"{{"kind": "vehicle", "id": "a", "start": {start}}}
            {{"kind": "vehicle", "id": "b", "start": 3}}
            {{"id": "m1", "vehicle": "a", "to": {first}}}
            {{"id": "m2", "vehicle": "b", "to": 2, "release": 20}}"#
        );
        let source = MissionSource { text: &text, kind: RecordKind::Mission };
        let fleet = FleetMissions::read(&[source], &imported.layout, &imported.vehicle).expect("missions");
        let run = run_missions(&imported, &fleet, &|_, _| {}).expect("a run");
        assert_eq!(run.missions.iter().filter(|it| it.reason.is_none()).count(), finished);
        let why = run.missions[1].reason.as_deref();
        assert_eq!(why, Some("vehicle b: no route leads from where it is to node 2 past a, which can never leave"));
        // Without a look at it, two minutes without a motion would tell.
        assert!(run.duration < 30.0, "{start}: {}", run.duration);
    }
    // Of two vehicles in the bays of a two-way site each can make way.
    let both = report(
        &square(),
        r#"{"kind": "vehicle", "id": "a", "start": 4}
        {"kind": "vehicle", "id": "b", "start": 5}
        {"id": "m1", "vehicle": "a", "to": 5}
        {"id": "m2", "vehicle": "b", "to": 4}"#,
    );
    assert!(both.is_sound(), "{both:?}");
}

/// Missions at random on a real site, for vehicles of three types, with closures and breakdowns or without.
#[test]
fn runs_of_many_missions_on_a_real_site_are_certified() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/real/nav2/aws_graph.geojson");
    let text = std::fs::read_to_string(path).expect("a layout");
    let options = ImportOptions { radius: Some(0.4), ..ImportOptions::default() };
    let imported = roads(InputFormat::Nav2, &text, &options, &mut Warnings::default()).expect("a layout");
    let layout = &imported.layout;
    let types = [r#""radius": 0.4"#, r#""length": 1.0, "width": 0.6, "speed": 0.8"#, r#""radius": 0.3, "speed": 1.5"#];
    for seed in 1..=4 {
        let mut random = SplitMix64(seed);
        let nodes: Vec<usize> = (0..layout.nodes.len()).collect();
        let mut starts: Vec<usize> = Vec::new();
        for node in random.shuffled(&nodes) {
            let [x, y] = layout.nodes[node].point;
            let far = |&other: &usize| {
                let [u, v] = layout.nodes[other].point;
                f64::hypot(x - u, y - v) > 1.7
            };
            if starts.len() < 8 && starts.iter().all(far) {
                starts.push(node);
            }
        }
        let id = |node: usize| layout.nodes[node].id.to_string();
        let mut lines: Vec<String> = starts
            .iter()
            .enumerate()
            .map(|(k, &start)| {
                format!(r#"{{"kind": "vehicle", "id": "v{k}", "start": {}, {}}}"#, id(start), types[k % types.len()])
            })
            .collect();
        for k in 0..30 {
            let [from, to] = [(); 2].map(|()| id(random.below(nodes.len())));
            let release = random.below(300);
            lines.push(format!(r#"{{"id": "m{k}", "from": {from}, "to": {to}, "release": {release}}}"#));
        }
        let all = report(&imported, &lines.join("\n"));
        assert!(all.is_sound() && all.done == 30, "{seed}: {all:?}");
        for _ in 0..4 {
            let (edge, at) = (&layout.edges[random.below(layout.edges.len())].id, random.below(200));
            lines.push(format!(r#"{{"kind": "closure", "edge": {edge}, "at": {at}, "until": {}}}"#, at + 100));
        }
        lines.push(format!(r#"{{"kind": "breakdown", "vehicle": "v{}", "at": 60, "until": 160}}"#, random.below(8)));
        let some = report(&imported, &lines.join("\n"));
        assert!(some.done == 30, "{seed}: {some:?}");
    }
}
