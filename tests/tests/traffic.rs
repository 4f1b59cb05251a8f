//! Random traffic: missions are what they say, and no two agents of a plan come nearer than their radii, by positions
//! at many times.

use pcr_execution::traffic::{TrafficOptions, TrafficReport};
use pcr_formats::footprint::Footprint;
use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, Warnings, roads};
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::Fleet;
use pcr_tests::polygons::{apart, placed};
use std::collections::HashSet;

const WAREHOUSE: &str = include_str!("../data/real/nav2/warehouse_graph.geojson");
const LEVELS: &str = include_str!("../data/real/rmf/office.building.yaml");

/// Between two times that are looked at \[s\].
const STEP: f64 = 0.05;

fn read(format: InputFormat, text: &str, radius: f64) -> ImportedLayout {
    // Routes of nav2 round corners where smooth_corners is set.
    let corner_radius = (format == InputFormat::Nav2).then_some(1.0);
    let options = ImportOptions { radius: Some(radius), corner_radius, ..ImportOptions::default() };
    roads(format, text, &options, &mut Warnings::default()).unwrap()
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The least distance of two agents less their radii, at many times.
fn clearance(scenario: &Scenario) -> f64 {
    let fleet = Fleet::<f64>::new(scenario).unwrap();
    let motions = fleet.motions();
    let end = motions.iter().map(|motion| motion.time().hi).fold(0.0, f64::max);
    let mut least = f64::INFINITY;
    for k in 0..=(end / STEP) as usize {
        let discs: Vec<_> =
            motions.iter().map(|motion| (motion.position_at(k as f64 * STEP), motion.radius())).collect();
        for (place, (a, own)) in discs.iter().enumerate() {
            for (b, other) in &discs[..place] {
                least = least.min(distance([a.x, a.y], [b.x, b.y]) - own - other);
            }
        }
    }
    least
}

#[test]
fn agents_of_a_plan_keep_clear_and_those_at_once_do_not() {
    let imported = read(InputFormat::Nav2, WAREHOUSE, 0.4);
    let (traffic, [missions, plan]) = TrafficReport::plan(&imported, TrafficOptions { agents: 12, seed: 1 }).unwrap();
    assert_eq!((traffic.placed, missions.agents.len()), (12, 12));
    assert_eq!((traffic.planned + traffic.unsolved.len(), plan.agents.len()), (12, traffic.planned));
    assert_eq!(traffic.planned, 12);
    assert!(traffic.conflicts_before > 0 && traffic.conflicts_after == 0);
    assert!(clearance(&missions) < 0.0 && clearance(&plan) > 0.0);
}

/// Missions are drawn so that each can be carried out after those that have to come first.
#[test]
fn every_mission_that_is_placed_is_planned() {
    const AGENTS: usize = if cfg!(optimized) { 50 } else { 20 };
    let imported = read(InputFormat::Nav2, WAREHOUSE, 0.4);
    let (traffic, [_, plan]) = TrafficReport::plan(&imported, TrafficOptions { agents: AGENTS, seed: 1 }).unwrap();
    assert_eq!(traffic.placed, AGENTS);
    assert_eq!((traffic.planned, traffic.conflicts_after), (traffic.placed, 0), "{:?}", traffic.unsolved);
    assert!(traffic.passed_over > 0 && clearance(&plan) > 0.0);
}

/// Outlines keep clear as polygons, of which the discs around them would overlap.
#[test]
fn vehicles_with_outlines_keep_clear() {
    const FORK: [[f64; 2]; 4] = [[-0.4, -0.25], [0.8, -0.25], [0.8, 0.25], [-0.4, 0.25]];
    let mut imported = read(InputFormat::Nav2, WAREHOUSE, 0.4);
    let footprint = Footprint::new(FORK.to_vec()).unwrap();
    (imported.vehicle.radius, imported.vehicle.footprint) = (footprint.circumscribed_radius(), Some(footprint));
    let (traffic, [_, plan]) = TrafficReport::plan(&imported, TrafficOptions { agents: 8, seed: 2 }).unwrap();
    assert_eq!((traffic.planned, traffic.conflicts_after), (8, 0), "{:?}", traffic.unsolved);
    assert!(clearance(&plan) < 0.0, "the discs around them overlap");
    let fleet = Fleet::<f64>::new(&plan).unwrap();
    let motions = fleet.motions();
    let end = motions.iter().map(|motion| motion.time().hi).fold(0.0, f64::max);
    for k in 0..=(end / STEP) as usize {
        let outlines: Vec<_> = motions
            .iter()
            .map(|motion| {
                let pose = motion.path().pose_at(motion.length_at(k as f64 * STEP));
                placed(&FORK, [pose.position.x, pose.position.y], pose.heading.0)
            })
            .collect();
        for (place, a) in outlines.iter().enumerate() {
            assert!(outlines[..place].iter().all(|b| apart(a, b) > 0.0), "at {}", k as f64 * STEP);
        }
    }
}

#[test]
fn missions_join_their_nodes_and_keep_apart_at_both_ends() {
    let imported = read(InputFormat::Nav2, WAREHOUSE, 0.4);
    let (traffic, [missions, _]) = TrafficReport::plan(&imported, TrafficOptions { agents: 14, seed: 7 }).unwrap();
    let fleet = Fleet::<f64>::new(&missions).unwrap();
    let node = |id| imported.layout.nodes.iter().find(|node| node.id == id).unwrap().point;
    let mut ends: [Vec<[f64; 2]>; 2] = Default::default();
    for (motion, mission) in fleet.motions().iter().zip(&traffic.missions) {
        let path = motion.path();
        assert!((path.length() - mission.length).abs() < 1e-9);
        for (place, length, id) in [(0, 0.0, &mission.from), (1, path.length(), &mission.to)] {
            let point = path.point_at(length);
            assert!(distance([point.x, point.y], node(id.clone())) < 1e-6);
            assert!(ends[place].iter().all(|other| distance(*other, [point.x, point.y]) > 0.8));
            ends[place].push([point.x, point.y]);
        }
    }
}

#[test]
fn what_is_counted_is_what_the_missions_say() {
    let imported = read(InputFormat::Rmf, LEVELS, 0.2);
    let request = TrafficOptions { agents: 8, seed: 3 };
    let (traffic, [_, plan]) = TrafficReport::plan(&imported, request).unwrap();
    assert_eq!(TrafficReport::plan(&imported, request).unwrap().0, traffic, "the same seed, the same traffic");
    let other = TrafficReport::plan(&imported, TrafficOptions { seed: 4, ..request }).unwrap().0;
    assert_ne!(other.missions, traffic.missions);
    let planned: Vec<_> = traffic.missions.iter().filter(|mission| mission.delay.is_some()).collect();
    assert_eq!(planned.len(), traffic.planned);
    for (mission, agent) in planned.iter().zip(&plan.agents) {
        assert_eq!((mission.id, mission.delay), (agent.id, Some(agent.t_start)));
        assert!((mission.t_end.unwrap() - agent.t_start - agent.duration()).abs() < 1e-9);
    }
    let last = planned.iter().filter_map(|mission| mission.t_end).fold(0.0, f64::max);
    assert_eq!(traffic.makespan, last);
    assert!((traffic.missions_per_hour - 3600.0 * planned.len() as f64 / last).abs() < 1e-9);
    let waits: f64 = planned.iter().filter_map(|mission| mission.delay).sum();
    assert!((traffic.sum_of_costs - traffic.lower_bound - waits).abs() < 1e-6);
    let ids: HashSet<u64> = traffic.unsolved.iter().filter_map(|unsolved| unsolved.ids.first()).copied().collect();
    assert!(ids.iter().all(|id| plan.agents.iter().all(|agent| agent.id != *id)));
}

#[test]
fn where_there_is_no_room_fewer_are_placed() {
    let imported = read(InputFormat::Nav2, WAREHOUSE, 3.0);
    let (traffic, _) = TrafficReport::plan(&imported, TrafficOptions { agents: 96, seed: 1 }).unwrap();
    assert!(traffic.placed < 30 && traffic.placed > 0, "{}", traffic.placed);
    assert_eq!(traffic.asked, 96);
}

#[test]
fn missions_that_are_passed_over_are_told_with_their_reasons() {
    let imported = read(InputFormat::Nav2, WAREHOUSE, 0.4);
    let (traffic, _) = TrafficReport::plan(&imported, TrafficOptions { agents: 16, seed: 1 }).unwrap();
    let because: Vec<_> =
        traffic.passed_over_because.iter().map(|reason| (reason.why.as_str(), reason.missions)).collect();
    assert!(traffic.passed_over > 0, "{traffic:?}");
    assert_eq!(because, [("no order of starts lets it through with those before it", traffic.passed_over)]);
    // Its trajectories are metres from its nodes: no way is a path.
    let apart = include_str!("../data/real/lif/example_17.lif.json");
    let imported = read(InputFormat::Lif, apart, 0.4);
    let (traffic, _) = TrafficReport::plan(&imported, TrafficOptions { agents: 1, seed: 1 }).unwrap();
    assert_eq!((traffic.placed, traffic.passed_over), (0, 8), "two ways in four draws");
    let mut reasons = traffic.passed_over_because.iter();
    assert!(reasons.all(|reason| reason.why.starts_with("the way is no path: edge N") && reason.missions == 4));
    let mut text = Vec::new();
    pcr_execution::report::traffic_table(&traffic, &mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    assert!(
        text.contains("4 missions rejected and drawn again: the way is no path: edge N1-N2: its curve begins 5.000 m"),
        "{text}"
    );
    assert!(
        traffic.warnings.iter().any(|line| line.contains("its trajectory begins 5.000 m")),
        "{:?}",
        traffic.warnings
    );
}

#[test]
fn levels_without_missions_are_told() {
    let hotel = read(InputFormat::Rmf, include_str!("../data/real/rmf/hotel.building.yaml"), 0.3);
    let (traffic, [missions, plan]) = TrafficReport::plan(&hotel, TrafficOptions { agents: 2, seed: 1 }).unwrap();
    let told = "levels: missions are drawn on L1 only, of 3 [one-level]".to_owned();
    assert!([&traffic.warnings, &missions.warnings, &plan.warnings].iter().all(|warnings| warnings.contains(&told)));
}
