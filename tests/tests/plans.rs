//! Fleet plans: no two discs come nearer than their radii, by the oracle; and nobody waits longer than for all others.

use pcr_core::{InvalidInput, Motion, PlanError, Profile, Scalar, SearchNode, plan_delays, plan_speeds};
use pcr_fixed::Q16;
use pcr_planning::fleet::{HostScalar, build_ecm};
use pcr_tests::disc::{Course, Disc, Drive, Driven, Leg};
use pcr_tests::generators::Dice;
use pcr_tests::oracle::contact::Meeting;
use pcr_tests::plans::{Method, Tally, audit, drive_of, fleet};
use std::f64::consts::PI;

/// `cargo run --release -p pcr-tests --example fleets` takes any number.
const FLEETS: u64 = if cfg!(optimized) { 2_000 } else { 100 };

fn audited(method: Method) -> Tally {
    let mut tally = Tally::default();
    (0..FLEETS).for_each(|seed| audit(seed, method, &mut tally));
    println!("{tally:?}");
    let Tally { solved, moved, never, full, .. } = tally;
    assert!(u64::from(solved) * 3 > FLEETS && moved > 0 && never > 0, "{tally:?}");
    assert!(u64::from(full) * 1000 <= FLEETS, "{tally:?}");
    tally
}

#[test]
fn random_fleets_are_delayed_without_collisions_and_without_idle_waits() {
    let tally = audited(Method::Delay);
    assert_eq!(tally.faster, 0);
}

#[test]
fn random_fleets_are_given_speeds_without_collisions_and_without_idle_waits() {
    let tally = audited(Method::Speed);
    assert!(tally.faster > 0, "{tally:?}");
}

/// Plans in another format, for what is left of the numbers in it: discs that are smaller by `slip` \[m\] are apart.
fn audited_in<S: HostScalar>(slip: f64) {
    const PHASES: usize = 64;
    let mut solved = [0_u64; 2];
    for seed in 0..FLEETS {
        let rounded = fleet(&mut Dice::seeded(seed)).iter().map(Course::<S>::rounded).collect::<Option<Vec<_>>>();
        let Some((courses, driven)) = rounded.map(|rounded| rounded.into_iter().unzip::<_, _, Vec<_>, Vec<_>>()) else {
            continue;
        };
        let motions: Vec<Motion<'_, S>> = courses.iter().map(Course::motion).collect();
        let ecm = build_ecm(&motions).expect("a small table");
        let mut stations = vec![SearchNode::EMPTY; 160];
        for (way, solved) in solved.iter_mut().enumerate() {
            let mut profiles = vec![Profile::<S, PHASES>::standing(); 40];
            let (mut plan, mut order) = (motions.clone(), (0..motions.len()).collect::<Vec<_>>());
            let outcome = match way {
                0 => plan_delays(&ecm, &motions, &mut plan, &mut order),
                _ => plan_speeds(&ecm, &motions, &mut plan, &mut order, &mut profiles, &mut stations),
            };
            if let Err(unsolved) = outcome {
                assert!(!matches!(unsolved, PlanError::Overlap(_)), "seed {seed}: {unsolved}");
                continue;
            }
            *solved += 1;
            let last = plan.iter().map(|motion| motion.time().hi.to_f64()).fold(0.0, f64::max);
            let planned: Vec<Driven> = (driven.iter().zip(&plan))
                .map(|((disc, ..), motion)| (disc.grown(-slip), drive_of(motion), motion.time().lo.to_f64()))
                .collect();
            for (k, a) in planned.iter().enumerate() {
                for b in &planned[..k] {
                    let met = Meeting::new(a, b).comes_within(0.0, [0.0, last]);
                    assert!(!met, "seed {seed}, way {way}: {a:?} and {b:?}");
                }
            }
        }
    }
    println!("{solved:?} of {FLEETS}");
    assert!(solved.iter().all(|&solved| solved * 10 > FLEETS), "{solved:?} of {FLEETS}");
}

#[test]
fn plans_meet_nobody_in_f32_and_q16() {
    audited_in::<f32>(5e-4);
    audited_in::<Q16>(5e-3);
}

fn line(start: [f64; 3], length: f64) -> Course<f64> {
    let disc = Disc { radius: 0.25, start, legs: vec![Leg::Line(length)] };
    Course::driven(&disc, &Drive::Unit, 0.0).expect("a valid disc")
}

fn delays(courses: &[Course<f64>], order: &mut [usize]) -> Result<Vec<f64>, PlanError> {
    let fleet: Vec<_> = courses.iter().map(Course::motion).collect();
    let ecm = build_ecm(&fleet).expect("a small table");
    let mut plan = fleet.clone();
    plan_delays(&ecm, &fleet, &mut plan, order)?;
    Ok(plan.iter().zip(&fleet).map(|(planned, motion)| planned.time().lo - motion.time().lo).collect())
}

#[test]
fn the_lower_priority_waits_at_a_crossing() {
    let crossing = [line([-2.0, 0.0, 0.0], 4.0), line([0.0, -2.0, PI / 2.0], 4.0)];
    for (mut order, waits) in [([0, 1], 1), ([1, 0], 0)] {
        let found = delays(&crossing, &mut order).expect("a plan");
        assert!((found[waits] - 0.5 * 2.0_f64.sqrt()).abs() < 1e-8 && found[1 - waits] == 0.0, "{found:?}");
    }
}

#[test]
fn head_on_agents_are_named() {
    let found = delays(&[line([0.0, 0.0, 0.0], 4.0), line([4.0, 0.0, PI], 4.0)], &mut [0, 1]);
    assert_eq!(found, Err(PlanError::Always([1, 0])));
    assert_eq!(delays(&[line([0.0, 0.0, 0.0], 4.0)], &mut [3]), Err(PlanError::NoSuchAgent(3)));
}

/// Nobody would look out for an agent that is left out.
#[test]
fn an_order_lists_every_agent_once() {
    let courses = [line([-2.0, 0.0, 0.0], 4.0), line([0.0, -2.0, PI / 2.0], 4.0), line([9.0, 9.0, 0.0], 4.0)];
    let fleet: Vec<_> = courses.iter().map(Course::motion).collect();
    let ecm = build_ecm(&fleet).expect("a small table");
    let orders: [(&[usize], _); 6] = [
        (&[], PlanError::NotOnce(0)),
        (&[0, 1], PlanError::NotOnce(2)),
        (&[2, 0], PlanError::NotOnce(1)),
        (&[0, 1, 1], PlanError::NotOnce(1)),
        (&[0, 1, 2, 0], PlanError::NotOnce(0)),
        (&[0, 1, 3], PlanError::NoSuchAgent(3)),
    ];
    for (order, refused) in orders {
        let mut plan = fleet.clone();
        assert_eq!(delays(&courses, &mut order.to_vec()), Err(refused), "{order:?}");
        let mut profiles = vec![Profile::<f64, 16>::standing(); 3];
        let (mut order, mut stations) = (order.to_vec(), vec![SearchNode::EMPTY; 100]);
        let speeds = plan_speeds(&ecm, &fleet, &mut plan, &mut order, &mut profiles, &mut stations);
        assert_eq!(speeds, Err(refused), "{order:?}");
    }
    let text = PlanError::NotOnce(2).to_string();
    assert_eq!(text, "the order of priorities does not list agent 2 of the fleet once");
}

#[test]
fn an_agent_in_the_way_of_another_goes_first() {
    // Agent 0 passes over the start of agent 1, which leaves to the side.
    let mut order = [0, 1];
    let found = delays(&[line([-2.0, 0.0, 0.0], 4.0), line([0.0, 0.0, PI / 2.0], 2.0)], &mut order).expect("a plan");
    assert!(order == [0, 1] && found == [0.0, 0.0], "it is gone in time: {order:?} {found:?}");
    // It leaves too late unless agent 0 waits for it.
    let mut late = [line([-0.6, 0.0, 0.0], 4.0), line([0.0, 0.0, PI / 2.0], 2.0)];
    late.reverse();
    let found = delays(&late, &mut [1, 0]).expect("a plan");
    assert!(found[1] > 0.0 && found[0] == 0.0, "{found:?}");
}

#[test]
fn speeds_go_where_delays_cannot() {
    // Agent 0 may neither stand at its start when agent 1 passes there, nor pass the place where agent 2 crosses before that one.
    let fast = |start, length, at| {
        let disc = Disc { radius: 0.25, start, legs: vec![Leg::Line(length)] };
        Course::<f64>::driven(&disc, &Drive::Limits(1.0, 1.0), at).expect("a valid disc")
    };
    let courses = [
        fast([0.0, 0.0, 0.0], 8.0, 0.0),
        fast([0.0, -1.2, PI / 2.0], 12.0, 0.0),
        fast([5.0, -5.0, PI / 2.0], 10.0, 0.0),
    ];
    let fleet: Vec<Motion<'_, f64>> = courses.iter().map(Course::motion).collect();
    let ecm = build_ecm(&fleet).expect("a small table");
    let mut order = [1, 2, 0];
    let mut plan = fleet.clone();
    plan_delays(&ecm, &fleet, &mut plan, &mut order).expect("another order");
    assert_eq!(order, [0, 1, 2], "only if it goes first");

    let mut order = [1, 2, 0];
    let mut profiles = vec![Profile::<f64, 16>::standing(); 3];
    let mut plan = fleet.clone();
    plan_speeds(&ecm, &fleet, &mut plan, &mut order, &mut profiles, &mut vec![SearchNode::EMPTY; 100]).expect("a plan");
    assert_eq!(order, [1, 2, 0]);
    assert!(plan[0].profile().phases().len() > 3, "it slows down on the way: {:?}", plan[0].profile());
}

/// A start that the format cannot hold is neither a question of room nor of priorities.
#[test]
fn a_plan_that_would_be_too_late_is_out_of_range() {
    let late = f64::LIMIT - 4.5;
    for drive in [Drive::Unit, Drive::Limits(1.0, 10.0)] {
        let crossing = [[-2.0, 0.0, 0.0], [0.0, -2.0, PI / 2.0]].map(|start| {
            let disc = Disc { radius: 0.5, start, legs: vec![Leg::Line(4.0)] };
            Course::driven(&disc, &drive, late).expect("a valid disc")
        });
        let is_too_late = |found: Result<(), PlanError>| {
            assert!(
                matches!(found, Err(PlanError::Invalid { agent: 1, reason: InvalidInput::OutOfRange(_) })),
                "{drive:?}: {found:?}"
            );
        };
        is_too_late(delays(&crossing, &mut [0, 1]).map(drop));
        let fleet: Vec<_> = crossing.iter().map(Course::motion).collect();
        let ecm = build_ecm(&fleet).expect("a small table");
        let mut profiles = vec![Profile::<f64, 32>::standing(); 4];
        let (mut plan, mut stations) = (fleet.clone(), vec![SearchNode::EMPTY; 100]);
        is_too_late(plan_speeds(&ecm, &fleet, &mut plan, &mut [0, 1], &mut profiles, &mut stations));
    }
}

#[test]
fn overlaps_at_the_ends_are_named() {
    let ends = [line([0.0, 0.0, 0.0], 4.0), line([4.0, 4.3, -PI / 2.0], 4.0)];
    assert!(matches!(delays(&ends, &mut [0, 1]), Err(PlanError::Ends([1, 0]))));
    let starts = [line([0.0, 0.0, 0.0], 4.0), line([0.0, 0.3, PI / 2.0], 4.0)];
    assert!(matches!(delays(&starts, &mut [0, 1]), Err(PlanError::Starts([1, 0]))));
}
