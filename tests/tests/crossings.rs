//! Crossings of paths: where both paths are, within σ, in every number format; at a joint once.

use pcr_core::scalar::Micro;
use pcr_core::{crossings, excess};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;
use pcr_tests::disc::{Course, Disc, Leg};
use pcr_tests::exact::{DoubleDouble, Route};
use pcr_tests::generators::Dice;
use std::f64::consts::{FRAC_PI_2, PI};

fn leg(size: f64, dice: &mut Dice) -> Leg {
    if dice.chance(0.4) {
        Leg::Line(size * dice.range(0.1, 4.0))
    } else {
        let radius = size * dice.magnitude(0.2, 50.0);
        let most = (4.0 * size / radius).min(3.0);
        Leg::arc(radius, dice.sign() * dice.range(0.02, 1.0) * most)
    }
}

fn disc(size: f64, dice: &mut Dice) -> Disc {
    let start = [dice.range(-2.0, 2.0) * size, dice.range(-2.0, 2.0) * size, dice.range(-PI, PI)];
    Disc { radius: 0.3 * size, start, legs: (0..1 + dice.below(4)).map(|_| leg(size, dice)).collect() }
}

/// How far both paths are apart at these lengths \[m\].
fn apart(routes: &[Route; 2], at: [f64; 2]) -> f64 {
    let [a, b] = [0, 1].map(|k| routes[k].at(DoubleDouble::from(at[k])));
    (a[0] - b[0]).to_f64().hypot((a[1] - b[1]).to_f64())
}

/// Whether a joint or an end of the path is as near to this length \[m\].
fn beside_joint(disc: &Disc, at: f64, near: f64) -> bool {
    let mut joint = 0.0;
    let joints = disc.legs.iter().map(|leg| {
        joint += leg.length();
        joint
    });
    [0.0].into_iter().chain(joints).any(|joint| (joint - at).abs() <= near)
}

/// The crossings of two discs.
struct Found {
    /// Along both paths \[m\].
    lengths: Vec<[f64; 2]>,
    /// How far both paths are apart there at most, as a part of σ.
    worst: f64,
    /// The same before the last leg of each.
    at_joint: f64,
}

fn found<S: HostScalar>(pair: [&Disc; 2]) -> Option<Found> {
    let rounded = pair.map(Disc::rounded::<S>);
    let [first, second] = [Course::<S>::new(&rounded[0]).ok()?, Course::<S>::new(&rounded[1]).ok()?];
    let (first, second) = (first.motion(), second.motion());
    let routes = [Route::new::<S>(&rounded[0]), Route::new::<S>(&rounded[1])];
    let sigma = 0.5 * excess(&first, &second).to_f64();
    let (mut lengths, mut worst) = (Vec::new(), 0.0_f64);
    for crossing in crossings(&first, &second) {
        let at = [crossing.length, crossing.other_length].map(S::to_f64);
        // Up to four slacks before a joint or beyond an end of a path it is told by the point there.
        let beside = [0, 1].map(|k| beside_joint(&rounded[k], at[k], 4.5 * sigma)).contains(&true);
        worst = worst.max(apart(&routes, at) / sigma / if beside { 5.0 } else { 1.0 });
        lengths.push(at);
    }
    let joints = [0, 1]
        .map(|k| rounded[k].legs.split_last().map_or(0.0, |(_, before)| before.iter().map(|leg| leg.length()).sum()));
    Some(Found { lengths, worst, at_joint: apart(&routes, joints) / sigma })
}

fn both_paths_are_there<S: HostScalar>(size: f64) {
    let pairs = if cfg!(optimized) { 20_000 } else { 1_000 };
    let (mut count, mut worst) = (0, 0.0_f64);
    for seed in 0..pairs {
        let mut dice = Dice::seeded(seed);
        let (own, other) = (disc(size, &mut dice), disc(size, &mut dice));
        let Some(found) = found::<S>([&own, &other]) else { continue };
        assert!(found.worst <= 1.0, "{}, seed {seed}: {} of σ", S::NAME, found.worst);
        (count, worst) = (count + found.lengths.len(), worst.max(found.worst));
    }
    println!("{}: {count} crossings, {worst} of σ", S::NAME);
    assert!(count as u64 > pairs / 10 && worst > 0.001, "{}: {count} {worst}", S::NAME);
}

#[test]
fn crossings_are_where_both_paths_are() {
    both_paths_are_there::<f64>(1.0);
    both_paths_are_there::<f32>(1.0);
    both_paths_are_there::<Micro>(1.0);
    both_paths_are_there::<Q20>(1.0);
    both_paths_are_there::<Q16>(1.0);
    both_paths_are_there::<Q12>(20.0);
}

/// Paths that cross at the origin at an angle, each from any number of arcs and lines before, and with a joint there.
fn through_a_joint(size: f64, [own, their]: [f64; 2], dice: &mut Dice) -> [Disc; 2] {
    [own, their].map(|heading| {
        let legs: Vec<Leg> = (0..1 + dice.below(3)).map(|_| leg(size, dice)).collect();
        // Back along them from the origin.
        let (mut x, mut y, mut angle) = (0.0, 0.0, heading);
        for leg in &legs {
            let (chord, before) = match leg.radius() {
                None => (leg.length(), angle),
                Some(radius) => {
                    let half = 0.5 * leg.sweep();
                    (2.0 * radius * half.abs().sin(), angle - half)
                }
            };
            (x, y) = (x - chord * before.cos(), y - chord * before.sin());
            angle -= leg.sweep();
        }
        let mut legs: Vec<Leg> = legs.into_iter().rev().collect();
        legs.push(Leg::Line(0.2 * size));
        Disc { radius: 0.3 * size, start: [x, y, angle], legs }
    })
}

fn joints_count_once<S: HostScalar>(size: f64) {
    let pairs = if cfg!(optimized) { 20_000 } else { 1_000 };
    let mut seen = 0;
    for seed in 0..pairs {
        let mut dice = Dice::seeded(seed);
        let own = dice.range(-PI, PI);
        // From 15 degrees on.
        let between = dice.sign() * dice.range(0.262, FRAC_PI_2);
        let [first, second] = through_a_joint(size, [own, own + between], &mut dice);
        let at = [&first, &second].map(|disc| disc.length() - 0.2 * size);
        let Some(Found { lengths, at_joint, .. }) = found::<S>([&first, &second]) else { continue };
        // What is rounded to the format may cross beside the joint, even so far before it that rounding decides.
        if at_joint > 0.5 {
            continue;
        }
        let near = |[l, s]: &&[f64; 2]| (l - at[0]).abs() < 0.01 * size && (s - at[1]).abs() < 0.01 * size;
        assert_eq!(lengths.iter().filter(near).count(), 1, "{}, seed {seed}: {lengths:?}, {at:?}", S::NAME);
        seen += 1;
    }
    assert!(2 * seen > pairs, "{}: {seen}", S::NAME);
}

#[test]
fn a_crossing_at_joints_counts_once_in_every_format() {
    joints_count_once::<f64>(1.0);
    joints_count_once::<f32>(1.0);
    joints_count_once::<Micro>(1.0);
    joints_count_once::<Q20>(1.0);
    joints_count_once::<Q16>(1.0);
    joints_count_once::<Q12>(20.0);
}
