//! Outlines in closed loop.

use super::simulation_task::SimulationTask;
use super::{ClosedLoopOptions, ControllerKind, Disturbance, SimulationReport, SimulationRun, run};
use pcr_formats::scenario::Scenario;
use pcr_formats::splitmix64::SplitMix64;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const USUAL: Disturbance = Disturbance { noise: 0.015, slip: 0.05, delay: 1.0, drift: 0.005 };

/// A vehicle that is 1.2 m long.
fn agent(id: u64, width: f64, [x, y, heading]: [f64; 3], path: &str) -> String {
    let half = 0.5 * width;
    format!(
        r#"{{ "id": {id}, "v_max": 1, "a_max": 0.5, "turn_v_max": 0.5, "turn_a_max": 1,
             "start": {{ "x": {x}, "y": {y}, "heading": {heading} }}, "path": [ {path} ],
             "footprint": {{ "polygon": [ {{ "ahead": 0.6, "left": {half} }}, {{ "ahead": -0.6, "left": {half} }},
                                          {{ "ahead": -0.6, "left": -{half} }}, {{ "ahead": 0.6, "left": -{half} }} ] }} }}"#
    )
}

fn task(agents: &[String]) -> SimulationTask {
    let text = format!(r#"{{ "version": 4, "agents": [ {} ] }}"#, agents.join(", "));
    SimulationTask::from_scenario(&Scenario::from_json(&text).expect("a scenario")).expect("a task")
}

fn driven(task: &SimulationTask, seed: u64) -> SimulationRun {
    run(task, ControllerKind::Pcr, ClosedLoopOptions { seed, replan: 2.0, disturbance: USUAL }).expect("a run")
}

/// The least distance of 1.2 m long rectangles at the frames \[m\], by the normals of their sides.
fn sampled(run: &SimulationRun, widths: &[f64]) -> f64 {
    let corners = |robot: usize, frame: usize| {
        let ([x, y], heading) = (run.trace.positions[robot][frame], run.trace.headings[robot][frame]);
        let ((sin, cos), half) = (heading.sin_cos(), 0.5 * widths[robot]);
        [[0.6, half], [-0.6, half], [-0.6, -half], [0.6, -half]]
            .map(|[a, b]| [x + a * cos - b * sin, y + a * sin + b * cos])
    };
    let mut nearest = f64::INFINITY;
    for frame in 0..run.trace.positions[0].len() {
        for own in 0..widths.len() {
            for other in 0..own {
                let boxes = [corners(own, frame), corners(other, frame)];
                let gap = [own, other].into_iter().flat_map(|robot| {
                    let (sin, cos) = run.trace.headings[robot][frame].sin_cos();
                    [[cos, sin], [-sin, cos]]
                });
                let gap = gap.map(|[u, v]| {
                    let span = boxes.map(|corners| corners.map(|[x, y]| x * u + y * v));
                    let ends = span.map(|along| {
                        along.iter().fold([f64::INFINITY, f64::MIN], |[lo, hi], &x| [lo.min(x), hi.max(x)])
                    });
                    f64::max(ends[0][0] - ends[1][1], ends[1][0] - ends[0][1])
                });
                nearest = nearest.min(gap.fold(f64::MIN, f64::max));
            }
        }
    }
    nearest
}

fn assert_done(task: &SimulationTask, widths: &[f64], seed: u64) {
    let outcome = driven(task, seed);
    let run = &outcome.run;
    assert_eq!((run.not_done, run.collisions.len()), (0, 0), "seed {seed}: {run:?}");
    assert_eq!(run.planning.expect("a supervisor plans").authority_overruns, 0, "seed {seed}");
    let nearest = sampled(&outcome, widths);
    // What is told is the distance of the rectangles, or the gap along a normal where corners are nearest.
    assert!(nearest > 0.0 && run.clearance.expect("two robots") <= nearest + 0.3, "seed {seed}: {nearest}");
}

#[test]
fn vehicles_side_by_side_and_on_opposite_lanes_need_no_more_room_than_they_have() {
    let line = r#"{ "kind": "line", "length": 4 }"#;
    let abreast = task(&[agent(1, 0.4, [0.0; 3], line), agent(2, 0.4, [0.0, 0.7, 0.0], line)]);
    let opposite = task(&[
        agent(1, 0.4, [0.0; 3], line),
        agent(2, 0.4, [4.0, 0.7, PI], line),
        r#"{ "id": 3, "radius": 0.2, "v_max": 1, "a_max": 0.5, "start": { "x": 2, "y": -3, "heading": 1.57079633 },
             "path": [ { "kind": "line", "length": 6 } ] }"#
            .to_owned(),
    ]);
    assert_eq!((&abreast.warnings, &opposite.warnings), (&Vec::new(), &Vec::new()));
    for seed in 0..6 {
        assert_done(&abreast, &[0.4, 0.4], seed);
        assert_done(&opposite, &[0.4, 0.4], seed);
    }
}

#[test]
fn outlines_turn_in_place_and_others_wait_for_what_they_sweep() {
    let turning = r#"{ "kind": "line", "length": 3 }, { "kind": "turn", "sweep": 1.5707963267948966 }, { "kind": "line", "length": 3 },
        { "kind": "turn", "sweep": -3 }"#;
    let passing = r#"{ "kind": "line", "length": 8 }"#;
    // It passes 0.5 m beside the first turn, with 0.1 m between their sides, and corners reach 0.63 m.
    let fleet = task(&[agent(1, 0.4, [0.0; 3], turning), agent(2, 0.4, [-1.0, -0.5, 0.0], passing)]);
    assert_eq!(fleet.warnings, [""; 0]);
    for seed in 0..6 {
        assert_done(&fleet, &[0.4, 0.4], seed);
    }
    let outcome = driven(&fleet, 1);
    let (headings, end) = (&outcome.trace.headings[0], outcome.trace.headings[0].len() - 1);
    assert!((headings[end] - (FRAC_PI_2 - 3.0)).abs() < 2e-4, "{}", headings[end]);
    let fastest = headings.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    assert!(fastest <= 0.5 / 30.0 + 1e-9, "{fastest}");
}

#[test]
fn vehicles_change_their_gear_and_stand_there() {
    // Into a bay, where it turns, and out of it in reverse gear on another arc; the other one passes in front of the bay.
    let shunting = r#"{ "kind": "line", "length": 2, "gear": "reverse" }, { "kind": "arc", "radius": 1, "sweep": 1, "gear": "reverse" },
        { "kind": "arc", "radius": 1, "sweep": 1 }, { "kind": "turn", "sweep": -0.5 }, { "kind": "line", "length": 2 },
        { "kind": "line", "length": 1, "gear": "reverse" }"#;
    let passing = r#"{ "kind": "line", "length": 9 }"#;
    let disc = r#"{ "id": 3, "radius": 0.2, "v_max": 1, "a_max": 0.5, "start": { "x": -3.5, "y": 3, "heading": 1.57079633 },
        "path": [ { "kind": "line", "length": 2 }, { "kind": "line", "length": 6, "gear": "reverse" } ] }"#;
    let fleet = task(&[agent(1, 0.4, [0.0; 3], shunting), agent(2, 0.4, [3.0, 1.0, PI], passing), disc.to_owned()]);
    assert_eq!(fleet.warnings, [""; 0]);
    for seed in 0..6 {
        let SimulationRun { run, trace, .. } = driven(&fleet, seed);
        assert_eq!((run.not_done, run.collisions.len()), (0, 0), "seed {seed}: {run:?}");
        assert_eq!(run.planning.expect("a supervisor plans").authority_overruns, 0, "seed {seed}");
        let (headings, end) = (&trace.headings[0], trace.headings[0].len() - 1);
        // An arc turns it by its sweep in either gear.
        assert!((headings[end] - 1.5).abs() < 1e-9, "{}", headings[end]);
        let fastest = headings.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert!(fastest <= 1.0 / 30.0 + 1e-9, "{fastest}");
        // The disc ends 4 m below its start, and has been at the end of its first line.
        let disc = &trace.positions[2];
        assert!((disc[disc.len() - 1][1] + 1.0).abs() < 0.01, "{:?}", disc[disc.len() - 1]);
        let top = disc.iter().map(|at| at[1]).fold(f64::MIN, f64::max);
        assert!((top - 5.0).abs() < 0.01, "{top}");
    }
}

#[test]
fn random_fleets_of_rectangles_run_without_a_contact() {
    let mut random = SplitMix64(7);
    let (mut done, mut all) = (0, 0);
    for seed in 0..12 {
        let widths: Vec<f64> = (0..5).map(|_| 0.3 + 0.5 * random.unit()).collect();
        let agents = widths.iter().enumerate().map(|(k, &width)| {
            let heading = TAU * random.unit();
            let at = [6.0 * heading.cos() + 2.0 * random.unit(), 6.0 * heading.sin() + 2.0 * random.unit()];
            let path = format!(
                r#"{{ "kind": "line", "length": {} }}, {{ "kind": "arc", "radius": {}, "sweep": {} }}, {{ "kind": "turn", "sweep": {} }},
                   {{ "kind": "line", "length": 4, {} }}"#,
                3.0 + 3.0 * random.unit(),
                0.5 + random.unit(),
                4.0 * random.unit() - 2.0,
                3.0 * random.unit() - 1.5,
                match random.unit() {
                    kind if kind < 0.4 => r#""gear": "reverse""#.to_owned(),
                    kind if kind < 0.8 => format!(r#""facing": {}"#, TAU * random.unit()),
                    _ => r#""gear": "forward""#.to_owned(),
                }
            );
            agent(k as u64 + 1, width, [at[0], at[1], heading + PI], &path)
        });
        let fleet = task(&agents.collect::<Vec<_>>());
        let outcome = driven(&fleet, seed);
        let run = &outcome.run;
        // Some cannot be carried out by any plan, or touch where they begin.
        let begin = sampled(&SimulationRun { trace: first_frame(&outcome), ..outcome.clone() }, &widths);
        assert!(begin <= 0.0 || run.collisions.is_empty(), "{seed}: {run:?}");
        if begin > 0.0 {
            assert!(sampled(&outcome, &widths) > -1e-9, "{seed}");
            (done, all) = (done + run.done, all + 5);
        }
        assert_eq!(run.planning.expect("a supervisor plans").authority_overruns, 0, "{seed}");
    }
    assert!(2 * done > all && all > 20, "{done} of {all}");
}

fn first_frame(run: &SimulationRun) -> super::MotionTrace {
    let mut trace = run.trace.clone();
    trace.positions.iter_mut().for_each(|track| track.truncate(1));
    trace.headings.iter_mut().for_each(|track| track.truncate(1));
    trace
}

#[test]
fn controllers_of_discs_are_told_and_so_are_hulls() {
    let line = r#"{ "kind": "line", "length": 4 }"#;
    let fleet = task(&[agent(1, 0.4, [0.0; 3], line), agent(2, 0.4, [0.0, 3.0, 0.0], line)]);
    let settings = ClosedLoopOptions { seed: 1, replan: 2.0, disturbance: USUAL };
    let runs = [ControllerKind::Pcr, ControllerKind::Orca].map(|kind| run(&fleet, kind, settings).expect("a run"));
    let report = SimulationReport::from_runs(&fleet, settings, &runs);
    assert!(report.warnings.iter().any(|text| text.contains("disc-around-outline")), "{:?}", report.warnings);
    assert!(SimulationReport::from_runs(&fleet, settings, &runs[..1]).warnings.is_empty());
    let loaded = agent(1, 0.4, [0.0; 3], line).replacen(
        "\"path\"",
        r#""loads": [ { "segments": [1, 1], "radius": 0.7 } ], "path""#,
        1,
    );
    let loaded = task(&[loaded]);
    assert!(loaded.warnings.iter().any(|text| text.contains("convex-hull")), "{:?}", loaded.warnings);
}
