//! Plans of random fleets, checked by the oracle.

use crate::disc::{Course, Disc, Drive, Driven};
use crate::generators::{Dice, drive, leg};
use crate::oracle::contact::Meeting;
use pcr_core::{Encounter, Interval, Motion, PlanError, Profile, SearchNode, plan_delays, plan_speeds};
use pcr_planning::fleet::{HostScalar, build_ecm};
use std::f64::consts::PI;

/// How a fleet is planned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// `plan_delays`
    Delay,
    /// `plan_speeds`
    Speed,
}

/// What became of the fleets.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// With a plan.
    pub solved: u32,
    /// Of these, in another order than the given one.
    pub moved: u32,
    /// Of these, with an agent that goes in another way than the given one.
    pub faster: u32,
    /// Without a plan, as two agents meet however they move.
    pub never: u32,
    /// Without a plan for the priorities that were tried.
    pub not_found: u32,
    /// Without a plan for want of room.
    pub full: u32,
}

/// Discs that are a little larger, so that the true ones are certain not to touch after a few hundred steps of the
/// oracle \[m\]. The plans are held to 1e-8 m with the larger ones.
const GROWTH: f64 = 1e-5;

/// Two to six agents in a square of 6 m, or on one another's paths.
pub fn fleet(dice: &mut Dice) -> Vec<Driven> {
    let agents = 2 + dice.below(5);
    let agent = |dice: &mut Dice| {
        let start = [dice.range(-3.0, 3.0), dice.range(-3.0, 3.0), dice.range(-PI, PI)];
        let legs = (0..1 + dice.below(3)).map(|_| leg(dice)).collect();
        let disc = Disc { radius: dice.range(0.05, 0.3), start, legs };
        let drive = drive(dice, disc.length());
        (disc, drive, if dice.chance(0.5) { 0.0 } else { dice.range(0.0, 5.0) })
    };
    (0..agents).map(|_| agent(dice)).collect()
}

/// Plans the fleet of a seed and checks what comes of it: nobody is met, nobody waits longer than until all those before
/// it have arrived, limits are kept, and agents of which it is said that they meet whenever they start do so.
///
/// # Panics
/// If something is not as it should be, with the seed.
pub fn audit(seed: u64, method: Method, tally: &mut Tally) {
    let driven = fleet(&mut Dice::seeded(seed));
    let courses: Vec<_> =
        driven.iter().map(|(disc, drive, start)| Course::<f64>::driven(&disc.grown(GROWTH), drive, *start)).collect();
    let Ok(courses) = courses.into_iter().collect::<Result<Vec<_>, _>>() else { return };
    let motions: Vec<Motion<'_, f64>> = courses.iter().map(Course::motion).collect();
    let ecm = build_ecm(&motions).expect("a small table");
    let (mut plan, mut order) = (motions.clone(), (0..motions.len()).collect::<Vec<_>>());
    let given = order.clone();
    let mut profiles = vec![Profile::<f64, 64>::standing(); 40];
    let mut stations = vec![SearchNode::EMPTY; 160];
    let outcome = match method {
        Method::Delay => plan_delays(&ecm, &motions, &mut plan, &mut order),
        Method::Speed => plan_speeds(&ecm, &motions, &mut plan, &mut order, &mut profiles, &mut stations),
    };
    let mut sorted = order.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, given, "seed {seed}");
    match outcome {
        Ok(()) => {
            tally.solved += 1;
            tally.moved += u32::from(order != given);
            let differs = |(planned, motion): (&Motion<'_, f64>, &Motion<'_, f64>)| {
                planned.profile().phases() != motion.profile().phases()
            };
            tally.faster += u32::from(plan.iter().zip(&motions).any(differs));
            solved(seed, &driven, &motions, &plan, &order);
        }
        Err(PlanError::Starts([a, b]) | PlanError::Ends([a, b]) | PlanError::Always([a, b])) => {
            tally.never += 1;
            // With no delay at all do they get by.
            for k in -8..=8 {
                let starts = [motions[a].time().lo + 5.0 * f64::from(k), motions[b].time().lo];
                let ends = [starts[0] + motions[a].time().length(), motions[b].time().hi];
                let during = [starts[0].min(starts[1]) - 1.0, ends[0].max(ends[1]) + 1.0];
                let margin = 2.0 * GROWTH + 1e-6;
                let meeting = Meeting::new(&leaving(&driven[a], starts[0]), &leaving(&driven[b], starts[1]));
                assert!(meeting.comes_within(margin, during), "seed {seed}: {a} and {b} at {k}");
            }
        }
        Err(PlanError::Priorities(_)) => tally.not_found += 1,
        Err(PlanError::Full(_) | PlanError::Invalid { .. }) => tally.full += 1,
        Err(other) => panic!("seed {seed}: {other}"),
    }
}

fn solved(seed: u64, driven: &[Driven], motions: &[Motion<'_, f64>], plan: &[Motion<'_, f64>], order: &[usize]) {
    let first = plan.iter().map(|motion| motion.time().lo).fold(f64::INFINITY, f64::min);
    let last = plan.iter().map(|motion| motion.time().hi).fold(0.0, f64::max);
    let planned: Vec<Driven> = plan
        .iter()
        .zip(driven)
        .map(|(motion, driven)| (driven.0.clone(), drive_of(motion), motion.time().lo))
        .collect();
    for (place, &agent) in order.iter().enumerate() {
        let earliest = motions[agent].time().lo;
        let before = &order[..place];
        // The others have arrived; what is added is the rounding of the delay.
        let all_there = before.iter().map(|&other| plan[other].time().hi).fold(earliest, f64::max);
        let latest = all_there + motions[agent].time().length() + 1e-6;
        assert!(earliest <= plan[agent].time().lo, "seed {seed}, agent {agent}");
        // Unless the agent cannot wait for them: another one passes over its start.
        let waiting = leaving(&driven[agent], all_there);
        let waits = |other: usize| {
            !Meeting::new(&waiting, &planned[other]).comes_within(2.0 * GROWTH + 1e-6, [first, latest.max(last)])
        };
        let in_time = plan[agent].time().hi <= latest;
        assert!(in_time || !before.iter().all(|&other| waits(other)), "seed {seed}, agent {agent}");
        for (given, planned) in limits(&motions[agent]).into_iter().zip(limits(&plan[agent])) {
            assert!(planned <= given * (1.0 + 1e-9), "seed {seed}, agent {agent}: {planned} above {given}");
        }
        for &other in before {
            let met = Meeting::new(&planned[agent], &planned[other]).comes_within(0.0, [first, last]);
            assert!(!met, "seed {seed}: {agent} and {other}");
            let encounter = Encounter::new(&plan[agent], &plan[other]);
            let clearance = encounter.closest(Interval::new(first, last)).separation - encounter.radius();
            assert!(clearance > -1e-8, "seed {seed}: {agent} and {other} by {clearance}");
        }
    }
}

/// The same at another start time \[s\].
fn leaving((disc, drive, _): &Driven, start: f64) -> Driven {
    (disc.clone(), drive.clone(), start)
}

/// Largest speed and acceleration.
fn limits(motion: &Motion<'_, f64>) -> [f64; 2] {
    let phases = motion.profile().phases();
    [motion.profile().top_speed(), phases.iter().map(|phase| phase.acceleration().abs()).fold(0.0, f64::max)]
}

/// The motion as the oracle takes it.
pub fn drive_of<S: HostScalar>(motion: &Motion<'_, S>) -> Drive {
    let phases = motion.profile().phases();
    let speed = phases.first().map_or(0.0, |first| first.speed()[0].to_f64());
    let pieces = phases.iter().map(|phase| (phase.time().length().to_f64(), phase.acceleration().to_f64()));
    Drive::Pieces(speed, pieces.collect())
}
