//! Simulated runs: no collision under the supervisor, by an oracle on the true positions; the figures of a run follow from
//! its record; the same seed gives the same run.

use pcr_execution::simulate::{
    ClosedLoopOptions, ControllerKind, ControllerRunEntry, Disturbance, FRAME, MotionTrace, RunEnd, SimulationReport,
    SimulationRun, SimulationTask, forage, run,
};
use pcr_formats::scenario::Scenario;
use pcr_planning::plan::{PlanOptions, PlanReport};
use pcr_tests::generators::Dice;
use std::f64::consts::{PI, TAU};

const SEEDS: u64 = if cfg!(optimized) { 100 } else { 3 };

/// Overlaps up to this depth \[m\] are rounding.
const ROUNDING: f64 = 1e-9;

const USUAL: Disturbance = Disturbance { noise: 0.015, slip: 0.05, delay: 1.0, drift: 0.005 };

const NONE: Disturbance = Disturbance { noise: 0.0, slip: 0.0, delay: 0.0, drift: 0.0 };

fn settings(seed: u64, disturbance: Disturbance) -> ClosedLoopOptions {
    ClosedLoopOptions { seed, replan: 2.0, disturbance }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Whether two discs that move uniformly for a frame come nearer than `reach`: the time is halved until the way that they
/// travel decides.
fn meet(a: [[f64; 2]; 2], b: [[f64; 2]; 2], reach: f64) -> bool {
    let middle = |way: [[f64; 2]; 2]| [0, 1].map(|axis| 0.5 * (way[0][axis] + way[1][axis]));
    let apart = distance(middle(a), middle(b));
    if apart < reach {
        return true;
    }
    let half = 0.5 * (distance(a[0], a[1]) + distance(b[0], b[1]));
    if apart - half >= reach || half < 1e-12 {
        return false;
    }
    [0, 1].iter().any(|&end| meet([a[end], middle(a)], [b[end], middle(b)], reach))
}

/// Frames in which two tracks overlap by more than a depth.
fn overlaps(a: &[[f64; 2]], b: &[[f64; 2]], radius: f64, depth: f64) -> Vec<usize> {
    let ways = a.windows(2).zip(b.windows(2)).enumerate();
    let meets = |(a, b): (&[[f64; 2]], &[[f64; 2]])| meet([a[0], a[1]], [b[0], b[1]], radius - depth);
    ways.filter(|(_, ways)| meets(*ways)).map(|(frame, _)| frame).collect()
}

/// Every pair with a robot: numbers, tracks and the sum of the radii.
type Track = Vec<[f64; 2]>;
fn pairs(task: &SimulationTask, trace: &MotionTrace) -> Vec<([Option<u64>; 2], [Track; 2], f64)> {
    let robots: Vec<_> = task.robots.iter().zip(&trace.positions).collect();
    let mut pairs = Vec::new();
    for (place, (robot, track)) in robots.iter().enumerate() {
        for (other, second) in robots.iter().skip(place + 1) {
            let tracks = [track.to_vec(), second.to_vec()];
            pairs.push(([Some(robot.id), Some(other.id)], tracks, robot.radius + other.radius));
        }
        for obstacle in &task.obstacles {
            let stands = vec![obstacle.centre; track.len()];
            pairs.push(([Some(robot.id), obstacle.id], [track.to_vec(), stands], robot.radius + obstacle.radius));
        }
    }
    pairs
}

/// No disc meets another one, everything is done, and the run says so.
#[track_caller]
fn assert_safe(task: &SimulationTask, outcome: &SimulationRun, case: &str) {
    for (ids, [a, b], radius) in pairs(task, &outcome.trace) {
        assert_eq!(overlaps(&a, &b, radius, ROUNDING), [0_usize; 0], "{case}: {ids:?}");
    }
    let ControllerRunEntry { done, not_done, collisions, planning, .. } = &outcome.run;
    let missions: usize = task.robots.iter().map(|robot| robot.missions.len()).sum();
    assert_eq!((*done, *not_done, collisions.len()), (missions, 0, 0), "{case}");
    assert_eq!(planning.expect("a supervisor plans").authority_overruns, 0, "{case}");
}

/// One that turns twice, one with a slow middle of its path, and one that only turns.
const SLOWER: &str = r#"{ "agents": [
    { "id": 1, "radius": 0.3, "v_max": 1, "a_max": 0.5, "turn_v_max": 0.5, "turn_a_max": 1, "start": { "x": 0, "y": 0, "heading": 0 },
      "path": [ { "kind": "line", "length": 4 }, { "kind": "turn", "sweep": 1.5 }, { "kind": "line", "length": 3 },
                { "kind": "turn", "sweep": 3 } ] },
    { "id": 2, "radius": 0.3, "start": { "x": 7, "y": 9, "heading": 3.14159 },
      "path": [ { "kind": "line", "length": 2 }, { "kind": "line", "length": 1 }, { "kind": "line", "length": 2 } ],
      "profile": { "v0": 0, "pieces": [
        { "duration": 1, "accel": 1 }, { "duration": 1.03125, "accel": 0 }, { "duration": 0.75, "accel": -1 },
        { "duration": 4, "accel": 0 }, { "duration": 0.75, "accel": 1 }, { "duration": 1.03125, "accel": 0 },
        { "duration": 1, "accel": -1 } ] } },
    { "id": 3, "radius": 0.3, "v_max": 1, "a_max": 1, "turn_v_max": 0.1, "turn_a_max": 1, "start": { "x": 9, "y": 2, "heading": 0 },
      "path": [ { "kind": "turn", "sweep": 2 } ] } ] }"#;

#[test]
fn robots_turn_in_place_and_are_slow_where_their_own_motion_is() {
    let scenario = Scenario::from_json(SLOWER).expect("a scenario");
    let task = SimulationTask::from_scenario(&scenario).expect("a task");
    assert_eq!(task.warnings, [""; 0]);
    for seed in 0..SEEDS {
        let outcome = run(&task, ControllerKind::Pcr, settings(seed, USUAL)).expect("a run");
        assert_safe(&task, &outcome, &format!("seed {seed}"));
        let duration = |place: usize| {
            let journey = outcome.trace.journeys.iter().find(|journey| journey.robot == place).expect("its mission");
            (journey.end.expect("an end") - journey.begin) as f64 * FRAME
        };
        // 6 and 5 s of driving, 3.5 and 6.5 s of turns; the mean speed of a turn takes as long as the turn.
        assert!(duration(0) > 20.9 && duration(2) > 20.0, "seed {seed}: {} {}", duration(0), duration(2));
        let fastest = outcome.trace.travelled[1].windows(2).filter(|pair| pair[0] >= 2.0 && pair[1] <= 3.0);
        let fastest = fastest.map(|pair| (pair[1] - pair[0]) / FRAME).fold(0.0, f64::max);
        assert!(fastest > 0.2 && fastest <= 0.25 + 1e-9, "seed {seed}: {fastest}");
    }
    // Without disturbances, as fast as by their own motions.
    let exact = settings(0, NONE);
    let outcome = run(&task, ControllerKind::Pcr, exact).expect("a run");
    for journey in &outcome.trace.journeys {
        let took = (journey.end.expect("an end") - journey.begin) as f64 * FRAME;
        assert!((took - journey.unimpeded).abs() < 0.2, "{took} {}", journey.unimpeded);
    }
    for (journey, agent) in outcome.trace.journeys.iter().zip(&scenario.agents) {
        let own = agent.duration();
        assert!((journey.unimpeded - own).abs() < 1e-2 * own, "{} {own}", journey.unimpeded);
    }
}

#[test]
fn own_motions_that_wait_are_simulated_without_their_waits_and_that_is_told() {
    let waits = SLOWER.replace(r#"{ "duration": 4, "accel": 0 }"#, r#"{ "duration": 3, "accel": 0 },
        { "duration": 0.25, "accel": -1 }, { "duration": 9, "accel": 0 }, { "duration": 0.25, "accel": 1 }, { "duration": 0.75, "accel": 0 }"#);
    let task = SimulationTask::from_scenario(&Scenario::from_json(&waits).expect("a scenario")).expect("a task");
    assert_eq!(task.warnings.len(), 1, "{:?}", task.warnings);
    assert!(task.warnings[0].starts_with("agent 2: its own motion takes 18.81"), "{:?}", task.warnings);
}

#[test]
fn foraging_robots_do_not_collide_under_the_supervisor() {
    for seed in 0..SEEDS {
        let task = forage::task(seed, 2);
        let outcome = run(&task, ControllerKind::Pcr, settings(seed, USUAL)).expect("a run");
        assert_safe(&task, &outcome, &format!("seed {seed}"));
    }
}

#[test]
fn late_and_lost_robots_do_not_collide_under_the_supervisor() {
    for seed in 0..SEEDS {
        // Up to twice the noise of the paper, robots that lose up to half of their way and are held up for up to 6 s.
        let part = (seed % 7) as f64 / 6.0;
        let disturbance = Disturbance { noise: 0.03 * (1.0 - part), slip: 0.5 * part, delay: 6.0, drift: 0.01 };
        let task = forage::task(seed, 1);
        let settings = ClosedLoopOptions { seed, replan: 0.5 + 4.0 * part, disturbance };
        let outcome = run(&task, ControllerKind::Pcr, settings).expect("a run");
        assert_safe(&task, &outcome, &format!("seed {seed}"));
    }
}

/// Robots around a circle whose paths all lead over its middle, on lines or arcs, to between those on the other side.
fn star(seed: u64) -> Scenario {
    let robots = 3 + 2 * (seed as usize % 2);
    let agents: Vec<String> = (0..robots)
        .map(|k| {
            let from = TAU * k as f64 / robots as f64;
            let (x, y) = (1.5 * from.cos(), 1.5 * from.sin());
            let speed = 0.3 + 0.05 * ((seed + k as u64) % 5) as f64;
            // An arc of 3 m whose chord leads through the middle.
            let sweep = if (seed / 2 + k as u64).is_multiple_of(2) { 0.3 } else { -0.3 };
            let heading = from + PI - sweep / 2.0;
            format!(
                r#"{{ "id": {k}, "radius": 0.1, "v_max": {speed}, "a_max": 0.3, "t_start": {},
                     "start": {{ "x": {x}, "y": {y}, "heading": {heading} }},
                     "path": [ {{ "kind": "arc", "radius": {}, "sweep": {sweep} }} ] }}"#,
                0.7 * ((seed * 3 + k as u64) % 4) as f64,
                3.0 / sweep.abs(),
            )
        })
        .collect();
    Scenario::from_json(&format!(r#"{{ "agents": [{}] }}"#, agents.join(","))).expect("a scenario")
}

#[test]
fn robots_that_all_want_to_the_middle_get_past_one_another() {
    for seed in 0..SEEDS {
        let task = SimulationTask::from_scenario(&star(seed)).expect("a task");
        let outcome = run(&task, ControllerKind::Pcr, settings(seed, USUAL)).expect("a run");
        assert_safe(&task, &outcome, &format!("seed {seed}"));
    }
}

#[test]
fn nothing_is_lost_without_disturbances_and_without_others() {
    let mut task = forage::task(5, 1);
    task.robots.truncate(1);
    let outcome = run(&task, ControllerKind::Pcr, settings(5, NONE)).expect("a run");
    assert_safe(&task, &outcome, "alone");
    // A few frames: commands are a frame late, and speeds change from frame to frame.
    assert!(outcome.run.travel - outcome.run.unimpeded < 10.0 * FRAME, "{:?}", outcome.run);
}

#[test]
fn the_figures_follow_from_the_record() {
    for &controller in ControllerKind::ALL {
        let task = forage::task(2, 1);
        let outcome = run(&task, controller, settings(2, USUAL)).expect("a run");
        let SimulationRun { run, trace, .. } = &outcome;
        let frames = trace.positions[0].len();
        assert_eq!(run.missions.len(), trace.journeys.len());
        let (mut travel, mut waiting) = (0.0, 0.0);
        for (mission, journey) in run.missions.iter().zip(&trace.journeys) {
            let robot = &task.robots[journey.robot];
            let track = &trace.positions[journey.robot];
            let end = journey.end.expect("it arrives");
            assert!(distance(track[end], journey.goal) < robot.radius, "{controller:?}");
            assert_eq!((mission.id, mission.begin), (robot.id, journey.begin as f64 * FRAME));
            travel += (end - journey.begin) as f64 * FRAME;
            let slow = |k: &usize| distance(track[*k], track[k + 1]) / FRAME < 0.1 * robot.limits.speed;
            waiting += (journey.begin..end).filter(slow).count() as f64 * FRAME;
            // A mission takes no less than the fastest motion on the straight line.
            let straight = distance(track[journey.begin], track[end]) / robot.limits.speed;
            assert!((end - journey.begin) as f64 * FRAME > straight - 2.0 * FRAME, "{controller:?}");
        }
        let missions = run.missions.len() as f64;
        assert!((run.travel - travel / missions).abs() < 1e-9 && (run.waiting - waiting / missions).abs() < 1e-9);
        assert!((run.duration - (frames - 1) as f64 * FRAME).abs() < 1e-9);
        // No robot jumps: its speed, and a tenth of the drift a frame.
        for (robot, track) in task.robots.iter().zip(&trace.positions) {
            let most = robot.limits.speed * FRAME + 0.1 * USUAL.drift + 1e-3 + 1e-12;
            assert!(track.windows(2).all(|pair| distance(pair[0], pair[1]) <= most), "{controller:?}");
        }
        // The least clearance: met when the discs are larger by a little more than it, not by a little less.
        let least = run.clearance.expect("there are several robots");
        let met = |grown: f64| {
            pairs(&task, trace).iter().any(|(_, [a, b], radius)| !overlaps(a, b, radius + grown, 0.0).is_empty())
        };
        assert!(met(least + 1e-9) && !met(least - 1e-9), "{controller:?}");
    }
}

/// Two robots head-on, on one line.
fn head_on() -> SimulationTask {
    let agent = |id: u64, x: f64, heading: f64| {
        format!(
            r#"{{ "id": {id}, "radius": 0.2, "v_max": 0.5, "a_max": 1.0, "start": {{ "x": {x}, "y": 0, "heading": {heading} }},
                 "path": [ {{ "kind": "line", "length": 4.0 }} ] }}"#
        )
    };
    let text = format!(r#"{{ "agents": [{}, {}] }}"#, agent(4, -2.0, 0.0), agent(9, 2.0, PI));
    SimulationTask::from_scenario(&Scenario::from_json(&text).expect("a scenario")).expect("a task")
}

#[test]
fn collisions_are_found_and_reported() {
    // A camera that errs by more than the robots are large.
    let disturbance = Disturbance { noise: 0.6, ..USUAL };
    let task = head_on();
    let mut found = 0;
    for seed in 0..4 {
        let outcome = run(&task, ControllerKind::Potential, settings(seed, disturbance)).expect("a run");
        let [a, b] = [0, 1].map(|robot| &outcome.trace.positions[robot][..]);
        let frames = overlaps(a, b, 0.4, ROUNDING);
        let reported = outcome.run.collisions.iter().flat_map(|collision| {
            assert_eq!((collision.i, collision.j), (4, Some(9)));
            assert!(!overlaps(a, b, 0.4, collision.depth - 1e-9).is_empty());
            assert!(overlaps(a, b, 0.4, collision.depth + 1e-9).len() < frames.len());
            let [begin, end] = collision.t.map(|time| (time / FRAME).round() as usize);
            begin..end
        });
        assert_eq!(frames, reported.collect::<Vec<_>>());
        found += outcome.run.collisions.len();
    }
    assert!(found > 0);
}

#[test]
fn who_cannot_get_past_stays_where_it_is() {
    let outcome = run(&head_on(), ControllerKind::Pcr, settings(1, USUAL)).expect("a run");
    assert_eq!((outcome.run.done, outcome.run.not_done, outcome.run.collisions.len()), (0, 2, 0));
    assert!(outcome.trace.positions.iter().all(|track| track.iter().all(|&at| at == track[0])));
    // Nothing changes, so that no other try is made.
    let planning = outcome.run.planning.expect("a supervisor plans");
    assert_eq!((planning.count, planning.kept), (1, 1));
    let simulation = SimulationReport::from_runs(&head_on(), settings(1, USUAL), &[outcome]);
    assert!(!simulation.is_as_promised());
}

/// A full circle, of which the end is the start to the last digit, and a robot that stands on it.
#[test]
fn who_never_sets_off_has_not_gone_round() {
    let text = r#"{ "agents": [
        { "id": 1, "radius": 0.5, "v_max": 0.5, "a_max": 1, "start": { "x": 996, "y": 997, "heading": -1.5707963267948966 },
          "path": [ { "kind": "arc", "radius": 2, "sweep": 6.283185307179586 } ] },
        { "id": 2, "radius": 0.00001, "v_max": 0.5, "a_max": 1, "start": { "x": 1000, "y": 998, "heading": 0 }, "path": [] } ] }"#;
    let task = SimulationTask::from_scenario(&Scenario::from_json(text).expect("a scenario")).expect("a task");
    let outcome = run(&task, ControllerKind::Pcr, settings(1, USUAL)).expect("a run");
    assert_eq!((outcome.run.done, outcome.run.not_done), (0, 1), "{:?}", outcome.run);
}

#[test]
fn the_same_seed_gives_the_same_run() {
    let once = |seed, controller| run(&forage::task(3, 1), controller, settings(seed, USUAL)).expect("a run");
    for &controller in ControllerKind::ALL {
        let (first, second, other) = (once(3, controller), once(3, controller), once(4, controller));
        assert_eq!(first.trace, second.trace, "{controller:?}");
        let without_times = |mut run: ControllerRunEntry| {
            if let Some(planning) = &mut run.planning {
                (planning.mean_ms, planning.longest_ms) = (0.0, 0.0);
            }
            run
        };
        assert_eq!(without_times(first.run), without_times(second.run));
        assert_ne!(first.trace, other.trace, "{controller:?}");
    }
}

#[test]
fn robots_with_turns_in_place_get_where_they_go() {
    let scenario =
        Scenario::from_json(include_str!("../data/cases/simulate-two-robots-never-move.json")).expect("a scenario");
    let task = SimulationTask::from_scenario(&scenario).expect("a task");
    let outcome = run(&task, ControllerKind::Pcr, settings(1, USUAL)).expect("a run");
    assert_safe(&task, &outcome, "4.5 m apart");
    // They go round a square, turning in place, across the ways of two others.
    let agent = |id: u64, [x, y]: [f64; 2], path: &str, t: f64| {
        format!(
            r#"{{ "id": {id}, "radius": 0.2, "v_max": 1.0, "a_max": 0.8, "turn_v_max": 1.0, "turn_a_max": 1.0, "t_start": {t},
                 "start": {{ "x": {x}, "y": {y}, "heading": 0.0 }}, "path": [ {path} ] }}"#
        )
    };
    let line = |length: f64| format!(r#"{{ "kind": "line", "length": {length} }}"#);
    let turn = |sweep: f64| format!(r#"{{ "kind": "turn", "sweep": {sweep} }}"#);
    let round = [line(4.0), turn(PI / 2.0), line(4.0), turn(PI / 2.0), line(4.0)].join(", ");
    for seed in 0..SEEDS {
        let late = 0.4 * seed as f64;
        let agents = [
            agent(1, [0.0, 0.0], &round, 0.0),
            agent(2, [-3.0, 2.0], &line(9.0), late),
            agent(3, [2.0, -3.0], &[turn(PI / 2.0), line(9.0)].join(", "), 2.0 * late),
        ];
        let scenario = Scenario::from_json(&format!(r#"{{ "agents": [{}] }}"#, agents.join(","))).expect("a scenario");
        let task = SimulationTask::from_scenario(&scenario).expect("a task");
        let outcome = run(&task, ControllerKind::Pcr, settings(seed, USUAL)).expect("a run");
        assert_safe(&task, &outcome, &format!("seed {seed}"));
    }
}

/// Robots from all around, each of which goes round a full circle in the middle: paths that cross one another several times, and
/// themselves.
fn loops(seed: u64) -> Scenario {
    let dice = &mut Dice::seeded(seed);
    let count = 2 + seed as usize % 5;
    let agents = (0..count).map(|k| {
        let around = TAU * (k as f64 + dice.range(-0.15, 0.15)) / count as f64;
        let [from, towards] = [[4.5 * around.cos(), 4.5 * around.sin()], [dice.range(-0.7, 0.7), dice.range(-0.7, 0.7)]];
        let (heading, length) = ((towards[1] - from[1]).atan2(towards[0] - from[0]), distance(from, towards));
        let sweep = if dice.range(0.0, 1.0) < 0.5 { TAU } else { -TAU };
        format!(
            r#"{{ "id": {}, "radius": {}, "v_max": 1, "a_max": 1, "start": {{ "x": {}, "y": {}, "heading": {heading} }},
                 "path": [ {{ "kind": "line", "length": {length} }}, {{ "kind": "arc", "radius": {}, "sweep": {sweep} }},
                           {{ "kind": "line", "length": {} }} ] }}"#,
            k + 1,
            dice.range(0.1, 0.2),
            from[0],
            from[1],
            dice.range(0.6, 1.5),
            length * dice.range(0.8, 1.2)
        )
    });
    let agents: Vec<String> = agents.collect();
    Scenario::from_json(&format!(r#"{{ "agents": [{}] }}"#, agents.join(","))).expect("a scenario")
}

/// Regions of a pair whose extents overlap, passed in different orders: robots that were held by the extents stood for ever.
#[test]
fn robots_whose_paths_cross_several_times_get_past_one_another() {
    let two = r#"{ "agents": [
        { "id": 3, "radius": 0.176, "v_max": 1, "a_max": 1, "start": { "x": -4.3976, "y": -0.1458, "heading": 0.00135 },
          "path": [ { "kind": "line", "length": 4.4837 }, { "kind": "arc", "radius": 0.80856, "sweep": 6.283185307179586 },
                    { "kind": "line", "length": 3.9369 } ] },
        { "id": 4, "radius": 0.124, "v_max": 1, "a_max": 1, "start": { "x": 0.6804, "y": -4.3471, "heading": 1.52537 },
          "path": [ { "kind": "line", "length": 5.0787 }, { "kind": "arc", "radius": 0.87947, "sweep": 6.283185307179586 },
                    { "kind": "line", "length": 5.3205 } ] } ] }"#;
    let two = Scenario::from_json(two).expect("a scenario");
    let mut solved = 0;
    for seed in 0..if cfg!(optimized) { 30 } else { 3 } {
        let scenario = if seed == 0 { two.clone() } else { loops(seed) };
        if !PlanReport::compute(&scenario, &PlanOptions::default()).is_ok_and(|(_, solved)| solved.is_some()) {
            continue;
        }
        solved += 1;
        let task = SimulationTask::from_scenario(&scenario).expect("a task");
        for disturbance in [USUAL, NONE] {
            let outcome = run(&task, ControllerKind::Pcr, settings(seed, disturbance)).expect("a run");
            assert_eq!(outcome.run.ended, RunEnd::Done, "{seed}: {:?}", outcome.run);
            assert_safe(&task, &outcome, &format!("loops {seed}"));
        }
    }
    assert!(solved > if cfg!(optimized) { 15 } else { 0 }, "{solved}");
}

/// A robot with a straight way of 10 m.
fn lane(id: u64, y: f64) -> String {
    format!(
        r#"{{ "id": {id}, "radius": 0.25, "v_max": 1, "a_max": 1, "start": {{ "x": 0, "y": {y}, "heading": 0 }},
             "path": [ {{ "kind": "line", "length": 10 }} ] }}"#
    )
}

/// The run was given up long before they could have arrived, and nobody said so.
#[test]
fn robots_that_are_held_up_for_long_arrive_all_the_same() {
    let text = format!(r#"{{ "agents": [{}, {}] }}"#, lane(1, 0.0), lane(2, 3.0));
    let task = SimulationTask::from_scenario(&Scenario::from_json(&text).expect("a scenario")).expect("a task");
    let outcome = run(&task, ControllerKind::Pcr, settings(1, Disturbance { delay: 600.0, ..USUAL })).expect("a run");
    assert_safe(&task, &outcome, "held up");
    // Two head-on are in each other's way for good.
    let outcome = run(&head_on(), ControllerKind::Pcr, settings(1, USUAL)).expect("a run");
    assert_eq!(outcome.run.ended, RunEnd::Standstill);
}

/// A controller that does not know that its goal is taken is stopped at the limit.
#[test]
fn who_waits_for_a_place_that_never_gets_free_is_stopped_at_the_limit() {
    let text = format!(
        r#"{{ "agents": [{}, {{ "id": 2, "radius": 0.25, "v_max": 1, "a_max": 1, "start": {{ "x": 10, "y": 0, "heading": 0 }},
                               "path": [] }}] }}"#,
        lane(1, 0.0)
    );
    let task = SimulationTask::from_scenario(&Scenario::from_json(&text).expect("a scenario")).expect("a task");
    let outcome = run(&task, ControllerKind::Orca, settings(1, NONE)).expect("a run");
    assert_eq!(outcome.run.ended, RunEnd::TimeLimit);
}

/// More of them than are planned by priority: lanes that cross everybody else's.
#[test]
fn a_larger_fleet_sets_off_one_after_the_other_and_arrives() {
    const LANES: usize = 8;
    let agent = |id: usize, [x, y, heading]: [f64; 3]| {
        format!(
            r#"{{ "id": {id}, "radius": 0.3, "v_max": 1.0, "a_max": 0.5, "start": {{ "x": {x}, "y": {y}, "heading": {heading} }},
                 "path": [ {{ "kind": "line", "length": {} }} ] }}"#,
            1.5 * LANES as f64 + 3.0
        )
    };
    let east = (0..LANES).map(|k| agent(k, [-2.0, 1.5 * k as f64, 0.0]));
    let north = (0..LANES).map(|k| agent(LANES + k, [1.5 * k as f64, -2.0, PI / 2.0]));
    let agents: Vec<String> = east.chain(north).collect();
    let scenario = Scenario::from_json(&format!(r#"{{ "agents": [{}] }}"#, agents.join(","))).expect("a scenario");
    let task = SimulationTask::from_scenario(&scenario).expect("a task");
    let outcome = run(&task, ControllerKind::Pcr, settings(1, USUAL)).expect("a run");
    assert_safe(&task, &outcome, "lanes");
    // One plan is enough: its orders are kept.
    assert_eq!(outcome.run.planning.map(|planning| planning.count), Some(1));
}

#[test]
fn loads_take_their_room() {
    let agent = |loads: &str| {
        format!(
            r#"{{ "agents": [ {{ "id": 1, "radius": 0.2, {loads} "v_max": 1.0, "a_max": 1.0,
                 "start": {{ "x": 0.0, "y": 0.0, "heading": 0.0 }}, "path": [ {{ "kind": "line", "length": 4.0 }} ] }} ] }}"#
        )
    };
    let radius = |loads: &str| {
        let scenario = Scenario::from_json(&agent(loads)).expect("a scenario");
        SimulationTask::from_scenario(&scenario).expect("a task").robots[0].radius
    };
    assert_eq!((radius(""), radius(r#""loads": [ { "segments": [1, 1], "radius": 0.7 } ],"#)), (0.2, 0.7));
}
