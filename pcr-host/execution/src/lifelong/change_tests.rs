//! Random missions on sites that change.

use super::change_results::ChangeResults;
use super::motion_record::{CheckWindow, RunCertificate};
use super::random_draws::STEP;
use super::robot::LifelongRobot;
use super::run_state::LifelongState;
use super::world_changes::{ChangeEffect, ChangeId};
use super::{CoordinationMethod, DelayModel, LifelongOptions, streets};
use crate::error::ExecutionError;
use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, Warnings, roads};
use pcr_formats::missions::{Breakdown, ClosedElement, Closure, SiteChanges};
use pcr_formats::splitmix64::SplitMix64;

fn options(agents: usize, duration: f64, seed: u64) -> LifelongOptions {
    let (delays, method) = (DelayModel::default(), CoordinationMethod::Orders);
    LifelongOptions { agents, duration, delays, seed, method }
}

fn real(name: &str) -> ImportedLayout {
    let path = format!("{}/../../tests/data/real/nav2/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a layout");
    let options = ImportOptions { radius: Some(0.3), ..ImportOptions::default() };
    roads(InputFormat::Nav2, &text, &options, &mut Warnings::default()).expect("a layout")
}

/// Runs a fleet and looks at each step whether somebody is where it must not be: on a closed element without having driven through, or in
/// motion although it is broken down. The run is certified. Also returns the number of missions that were done.
fn watched(imported: &ImportedLayout, request: LifelongOptions, changes: &SiteChanges) -> (ChangeResults, usize) {
    let mut run = LifelongState::new(imported, request, changes, None).expect("a fleet");
    let mut window = CheckWindow::new(&run.site, &run.robots);
    // For each robot the atoms that it may still drive through.
    let mut through: Vec<Vec<usize>> = vec![Vec::new(); run.robots.len()];
    let mut tick = 0;
    loop {
        let now = tick as f64 * STEP;
        let open = now < request.duration;
        if !open && run.robots.iter().all(LifelongRobot::has_arrived) {
            break;
        }
        assert!(now < request.duration + 3600.0, "nobody comes to an end");
        if open {
            let begun: Vec<bool> = run.world.closures.iter().map(|it| it.is_begun).collect();
            run.change_world(now);
            for (k, closure) in changes.closures.iter().enumerate() {
                if run.world.closures[k].is_begun && !begun[k] && closure.speed.is_none() {
                    let atoms = run.blocked(ChangeId::Closure(k), usize::MAX);
                    let effects = &run.world.closures[k].effects;
                    for (robot, _) in effects.iter().filter(|effect| effect.1 == ChangeEffect::Through) {
                        let ahead = &run.robots[*robot];
                        assert!(ahead.way.atoms.iter().any(|atom| atoms.contains(atom)), "{closure:?}");
                        through[*robot].extend(atoms.iter());
                    }
                }
            }
            run.give(now);
            run.refresh(tick, now);
            run.decide(now);
        } else {
            run.finish(tick, now);
        }
        let before: Vec<(f64, f64)> = run.robots.iter().map(|it| (it.at, it.speed)).collect();
        run.step(tick, now, open);
        for (robot, it) in run.robots.iter().enumerate() {
            if it.at > before[robot].0 {
                let atom = it.way.atoms[it.way.atom(it.at)];
                let is_allowed = run.world.closed[atom] == 0 || through[robot].contains(&atom);
                assert!(is_allowed, "at {now} robot {robot} drives on atom {atom}, which is closed");
                through[robot].retain(|&other| run.world.closed[other] > 0);
            }
            let brakes = it.speed < before[robot].1 || it.speed == 0.0;
            // Whoever is faster than the limit brakes as hard as it can.
            let limit = run.site.atoms[it.way.atoms[it.way.atom(it.at)]].speed.max(it.abilities.acceleration * STEP);
            let is_kept =
                it.speed <= limit + 1e-9 || it.speed <= before[robot].1 - it.abilities.acceleration * STEP + 1e-9;
            assert!(is_kept, "at {now} robot {robot} drives at {} where {limit} m/s are allowed", it.speed);
            assert!(!run.world.is_stranded(robot, now) || brakes, "robot {robot} drives at {now}");
        }
        tick += 1;
    }
    assert_eq!(run.outcome.authority_overruns, 0);
    let mut certificate = RunCertificate::new();
    certificate.window(&run.site, &mut run.robots, &mut window, tick as f64 * STEP);
    assert_eq!(certificate.verdict, "proved", "{certificate:?}");
    (run.world.results(), run.outcome.missions)
}

/// Closures and breakdowns at random, of which every third is for ever.
fn changes(imported: &ImportedLayout, robots: usize, duration: f64, seed: u64) -> SiteChanges {
    let (layout, mut random) = (&imported.layout, SplitMix64(seed));
    let mut time = |k: usize| {
        let at = duration * random.unit();
        (at, (!k.is_multiple_of(3)).then(|| at + 1.0 + 0.3 * duration * random.unit()))
    };
    let times: Vec<_> = (0..15).map(&mut time).collect();
    let closures = times[..12].iter().enumerate().map(|(k, &(at, until))| {
        let (element, speed) = match k {
            6.. => (ClosedElement::Edge(random.below(layout.edges.len())), Some([0.05, 0.2, 0.4][k % 3])),
            0 | 2 | 4 => (ClosedElement::Edge(random.below(layout.edges.len())), None),
            _ => (ClosedElement::Node(random.below(layout.nodes.len())), None),
        };
        Closure { element, speed, at, until }
    });
    let closures = closures.collect();
    let breakdowns = times[12..].iter().map(|&(at, until)| Breakdown { vehicle: random.below(robots), at, until });
    SiteChanges { closures, breakdowns: breakdowns.collect() }
}

#[test]
fn nobody_enters_what_is_closed_and_runs_are_certified() {
    let mut effects = [0; 4];
    for (imported, robots) in [(real("aws_graph.geojson"), 6), (real("warehouse_graph.geojson"), 8)] {
        for seed in 1..=4 {
            let some = changes(&imported, robots, 600.0, seed);
            let (found, missions) = watched(&imported, options(robots, 600.0, seed), &some);
            assert!(missions > 0, "{seed}: {found:?}");
            assert!(found.closures.iter().chain(&found.breakdowns).all(|it| it.is_begun));
            for (_, effect) in found.closures.iter().flat_map(|it| &it.effects) {
                effects[*effect as usize] += 1;
            }
        }
    }
    // All of it happened.
    assert!(effects.iter().all(|&count| count > 0), "{effects:?}");
}

/// In a large fleet decisions look at some robots only.
#[test]
fn a_large_fleet_keeps_out_of_what_is_closed() {
    let imported = streets(6);
    let some = changes(&imported, 70, 120.0, 3);
    let (found, missions) = watched(&imported, options(70, 120.0, 1), &some);
    assert!(missions > 20 && found.breakdowns.iter().all(|it| it.place.is_some()), "{missions}: {found:?}");
}

/// Robots beside closed ones go on with their work: a mission that has to wait for the end of a closure is in nobody's way.
#[test]
fn tasks_that_cannot_be_reached_are_told_and_hold_nobody_up() {
    let imported = real("aws_graph.geojson");
    let site = LifelongState::new(&imported, options(4, 60.0, 1), &SiteChanges::default(), None).expect("a fleet");
    let goal = site.ends.nodes[site.ends.nodes.len() / 2];
    let closed = |until: Option<f64>| SiteChanges {
        closures: vec![Closure { element: ClosedElement::Node(goal), speed: None, at: 60.0, until }],
        breakdowns: Vec::new(),
    };
    let (open, all) = watched(&imported, options(4, 1800.0, 1), &SiteChanges::default());
    assert!(open.closures.is_empty());
    let id = imported.layout.nodes[goal].id.to_string();
    for until in [Some(1500.0), None] {
        let (found, missions) = watched(&imported, options(4, 1800.0, 1), &closed(until));
        let lost = &found.closures[0].unreachable;
        assert!(!lost.is_empty() && lost.iter().any(|it| it.node == id), "{lost:?}");
        assert!(lost.iter().all(|it| it.is_given_up == until.is_none() && it.tasks > 0 && it.at >= 60.0), "{lost:?}");
        assert!(missions > all / 3, "{missions} of {all}");
    }
}

#[test]
fn a_breakdown_of_a_robot_that_is_not_there_does_nothing() {
    let imported = real("aws_graph.geojson");
    let breakdowns = vec![Breakdown { vehicle: 7, at: 10.0, until: None }];
    let some = SiteChanges { closures: Vec::new(), breakdowns };
    let (found, missions) = watched(&imported, options(2, 300.0, 1), &some);
    let (_, all) = watched(&imported, options(2, 300.0, 1), &SiteChanges::default());
    assert!(found.breakdowns[0].is_begun && found.breakdowns[0].place.is_none());
    assert_eq!(missions, all);
}

#[test]
fn other_methods_are_refused_on_a_site_that_changes() {
    let imported = real("aws_graph.geojson");
    let request = LifelongOptions { method: CoordinationMethod::EdgeLocks, ..options(2, 60.0, 1) };
    let some = changes(&imported, 2, 60.0, 1);
    let refused = LifelongState::new(&imported, request, &some, None).err();
    assert_eq!(refused, Some(ExecutionError::Changes("edge locks")));
}
