//! Methods side by side: what errors are measured by agrees with the oracle, the methods keep what they promise, and the
//! measure of errors sees a wrong answer.

use pcr_comparing::compare::{
    Accuracy, Comparison, DiscTrack, MeasurementBudget, MethodMeasurement, MethodQuestion, UnavailableMethod, crowd,
    reference,
};
use pcr_formats::scenario::Scenario;
use pcr_lab::methods::methods;
use pcr_planning::agent_regions::{AgentRegions as FleetRow, AgentRegionsWalk, each, grid, rows};
use pcr_planning::fleet::{Fleet, build_ecm};
use pcr_tests::disc::{Disc, Drive};
use pcr_tests::oracle::contact::Meeting;
use std::sync::atomic::{AtomicUsize, Ordering};

const FLEETS: u64 = if cfg!(optimized) { 15 } else { 3 };

const EFFORT: MeasurementBudget = MeasurementBudget { rounds: 2, budget: 0.01, slices: 5_000 };

fn compared(scenario: &Scenario, filters: &[&str]) -> Vec<MethodMeasurement> {
    let filters: Vec<String> = filters.iter().map(|filter| (*filter).to_owned()).collect();
    Comparison::new(scenario, methods(), EFFORT, &filters, &mut |_, _| {}).expect("it fits").rows
}

#[test]
fn the_reference_agrees_with_the_oracle() {
    /// The oracle's tolerance over the least speed \[s\].
    const SLIP: f64 = 1e-5;
    let mut met = 0;
    for seed in 0..8 * FLEETS {
        let scenario = crowd(12, seed);
        let driven: Vec<_> =
            scenario.agents.iter().map(|agent| (Disc::of_agent(agent), Drive::of_agent(agent), 0.0)).collect();
        let tracks: Vec<DiscTrack> = scenario.agents.iter().map(DiscTrack::new).collect();
        let during = [0.0, 60.0];
        for first in 0..12 {
            for second in first + 1..12 {
                let found = reference::contacts(&tracks[first], &tracks[second], during);
                let known = Meeting::new(&driven[first], &driven[second]).contacts(during, 1e-8);
                let holds =
                    |outer: [f64; 2], inner: [f64; 2]| outer[0] - SLIP <= inner[0] && inner[1] <= outer[1] + SLIP;
                let case = format!("seed {seed}: {first}, {second}");
                for &inner in &known.inner {
                    assert!(found.iter().any(|found| holds(found.time, inner.into())), "{case}");
                }
                for found in &found {
                    assert!(known.outer.iter().any(|&outer| holds(outer.into(), found.time)), "{case}");
                }
                met += found.len();
            }
        }
    }
    assert!(met > 8 * FLEETS as usize, "{met}");
}

#[test]
fn every_method_keeps_what_it_promises() {
    for seed in 0..FLEETS {
        let scenario = crowd(12, seed);
        let rows = compared(&scenario, &["pcr", "polyline", "sampled map 0.1 s"]);
        assert_eq!(rows.len(), 12);
        let area = |row: &MethodMeasurement| match row.errors {
            Accuracy::Regions { area, difference } => difference / area,
            Accuracy::Conflicts { .. } => panic!("{}", row.method),
        };
        for row in rows.iter().filter(|row| row.question == MethodQuestion::Regions) {
            let largest = match row.method.as_str() {
                "pcr f64" | "pcr f64, all cores" => 1e-8,
                "pcr f32" => 1e-3,
                "pcr q16" => 0.01,
                _ => 0.2,
            };
            assert!(area(row) < largest, "seed {seed}, {}: {}", row.method, area(row));
        }
        for row in rows.iter().filter(|row| row.question == MethodQuestion::Conflicts) {
            let Accuracy::Conflicts { missed, invented, time, .. } = row.errors else { panic!("{}", row.method) };
            assert_eq!(missed, 0, "seed {seed}, {}", row.method);
            if row.method.starts_with("pcr f64") {
                assert!(invented == 0 && time < 1e-6, "seed {seed}, {}: {invented}, {time}", row.method);
            }
        }
        let find = |method: &str| rows.iter().find(|row| row.method == method).expect("it is there");
        assert!(area(find("sampled map 0.1 s")) > 1e-3, "samples are no exact regions");
        let boxes = find("sampled map 0.1 s, boxes");
        let plain = find("sampled map 0.1 s");
        assert_eq!((boxes.bytes, boxes.errors), (plain.bytes, plain.errors), "boxes change nothing");
    }
}

#[test]
fn finer_methods_are_less_wrong() {
    let rows = compared(&crowd(12, 7), &["polyline", "sampled"]);
    let error = |method: &str| match rows.iter().find(|row| row.method == method).expect("it is there").errors {
        Accuracy::Regions { area, difference } => difference / area,
        Accuracy::Conflicts { time, .. } => time,
    };
    assert!(error("sampled map 0.01 s, boxes") < 0.3 * error("sampled map 0.1 s, boxes"));
    assert!(error("polyline 1 mm") < error("polyline 10 mm"));
}

#[test]
fn rows_hold_the_regions_of_the_table() {
    for (agents, seed) in [(0, 0), (1, 0), (2, 3), (60, 1), (60, 2)] {
        let scenario = crowd(agents, seed);
        let fleet = Fleet::<f64>::new(&scenario).expect("it fits");
        let motions = fleet.motions();
        let table = build_ecm(&motions).expect("it fits");
        let rows = rows(&motions).expect("they fit");
        assert_eq!(rows.len(), agents);
        for (ego, row) in rows.iter().enumerate() {
            assert_eq!(row.agents()[0] as usize, ego);
            for other in ego + 1..agents {
                for [i, j] in [[ego, other], [other, ego]] {
                    let extents = |region: pcr_core::RegionRef<'_, f64>| (region.time(), region.length());
                    let whole: Vec<_> =
                        table.pair(&motions, i, j).expect("the table of the fleet").map(extents).collect();
                    let part: Vec<_> = row.pair(i, j).expect("the row of one of them").map(extents).collect();
                    assert_eq!(whole, part, "{i}, {j}");
                }
            }
        }
        assert_eq!(rows.iter().map(|row| row.table().len()).sum::<usize>(), table.len());
    }
}

#[test]
fn rows_in_the_storage_of_others_are_the_same() {
    let scenario = crowd(300, 4);
    let fleet = Fleet::<f64>::new(&scenario).expect("it fits");
    let motions = fleet.motions();
    let own = rows(&motions).expect("they fit");
    let same = |row: &FleetRow<'_, f64>| {
        let agents = row.agents();
        let other = &own[agents[0] as usize];
        assert_eq!(
            (agents, row.table().len(), row.table().pieces()),
            (other.agents(), other.table().len(), other.table().pieces())
        );
        for &agent in &agents[1..] {
            let extents = |row: &FleetRow<'_, f64>| -> Vec<_> {
                row.pair(agents[0] as usize, agent as usize)
                    .expect("its row")
                    .map(|region| (region.time(), region.length()))
                    .collect()
            };
            assert_eq!(extents(row), extents(other), "{} {agent}", agents[0]);
        }
    };
    let grid = grid(&motions);
    let mut walk = AgentRegionsWalk::new(&motions, &grid);
    // Twice: the second time all storage is there, and nothing of the rows before.
    for ego in grid.order().into_iter().chain(grid.order()) {
        same(walk.row(ego as usize).expect("it fits"));
    }
    let seen = AtomicUsize::new(0);
    each(&motions, |row| {
        same(row);
        seen.fetch_add(1, Ordering::Relaxed);
    })
    .expect("they fit");
    assert_eq!(seen.into_inner(), motions.len());
}

#[test]
fn the_grid_finds_the_boxes_that_meet() {
    for seed in 0..FLEETS {
        let scenario = crowd(300, seed);
        let fleet = Fleet::<f64>::new(&scenario).expect("it fits");
        let motions = fleet.motions();
        let areas: Vec<[f64; 4]> = motions.iter().map(pcr_planning::agent_regions::area).collect();
        let grid = grid(&motions);
        let meet = |a: &[f64; 4], b: &[f64; 4]| a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3];
        let mut order = grid.order();
        order.sort_unstable();
        assert_eq!(order, (0..300).collect::<Vec<u32>>());
        // Also boxes that are no members, and one around all of them.
        let far = [[-9.0, -9.0, -8.0, -8.0], [-99.0, -99.0, 99.0, 99.0]];
        for b in areas.iter().chain(&far) {
            let all = (0..300).filter(|&other| meet(b, &areas[other as usize]));
            assert_eq!(grid.near(b), all.collect::<Vec<u32>>());
        }
    }
}

#[test]
fn other_libraries_find_what_is_no_graze() {
    /// Slowest sampling, and a slack of 15 mm at small speeds.
    const LATE: f64 = 0.1;
    for seed in 0..FLEETS {
        let filters = ["parry", "FCL", "Box2D"].map(str::to_owned);
        let comparison =
            Comparison::new(&crowd(12, seed), methods(), EFFORT, &filters, &mut |_, _| {}).expect("it fits");
        for UnavailableMethod { method, reason } in &comparison.absent {
            assert!(!method.starts_with("parry"), "parry is a crate");
            assert!(reason.contains("was not installed"), "{method}: {reason}");
            // The build fails there if a library is missing.
            assert!(std::env::var("CI").as_deref() != Ok("true"), "{method}: {reason}");
            println!("left out: {method}: {reason}");
        }
        let others: Vec<&MethodMeasurement> =
            comparison.rows.iter().filter(|row| !row.method.starts_with("pcr")).collect();
        assert_eq!(others.len() + comparison.absent.len(), 4);
        for row in others {
            let Accuracy::Conflicts { missed, invented, time, .. } = row.errors else { panic!("{}", row.method) };
            assert_eq!((missed, invented), (0, 0), "seed {seed}, {}", row.method);
            assert!(time < LATE, "seed {seed}, {}: {time}", row.method);
        }
    }
}
