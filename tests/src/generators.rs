//! Pairs of discs that aim at the degenerate cases: in real layouts they are the common ones.
//!
//! A pair is built from a list of numbers in [0, 1), so that proptest can shrink it and a campaign can replay it.

mod cases;
mod dice;
mod relations;
mod tangencies;

pub use cases::{Case, case};
pub use dice::{Dice, FACES};
pub use relations::{RELATIONS, Relation};
pub use tangencies::{behind, inner_tangent};

use crate::disc::{Disc, Drive, Leg};
use crate::neighbour::neighbour;
use pcr_planning::fleet::HostScalar;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

/// The ego and the other.
pub type Pair = (Disc, Disc);

/// Any pair.
pub fn pairs() -> impl Strategy<Value = Pair> {
    prop::collection::vec(0.0..1.0_f64, FACES).prop_map(|faces| pair(&mut Dice::new(faces)))
}

/// A pair, a drive for each disc and start times, for the tests of what depends on time.
pub fn driven_pairs() -> impl Strategy<Value = (Pair, [(Drive, f64); 2])> {
    prop::collection::vec(0.0..1.0_f64, FACES).prop_map(|faces| {
        let mut dice = Dice::new(faces);
        let (ego, other) = pair(&mut dice);
        let drives = [&ego, &other].map(|disc| (drive(&mut dice, disc.length()), dice.range(-5.0, 50.0)));
        ((ego, other), drives)
    })
}

/// The pair that the dice show.
pub fn pair(dice: &mut Dice) -> Pair {
    let relation = RELATIONS[dice.below(RELATIONS.len())];
    related(relation, dice)
}

/// A pair in this relation to one another.
pub fn related(relation: Relation, dice: &mut Dice) -> Pair {
    let (mut ego, mut other) = relations::related(relation, dice);
    for disc in [&mut ego, &mut other] {
        // What comes after does not disturb the relation, but joints come to lie in the middle of regions.
        if dice.chance(0.4) {
            for _ in 0..1 + dice.below(3) {
                disc.legs.push(leg(dice));
            }
        }
        if dice.chance(0.25) {
            split(disc, dice);
        }
        if dice.chance(0.1) {
            disc.legs.insert(dice.below(disc.legs.len() + 1), Leg::Line(0.0));
        }
    }
    if dice.chance(0.15) {
        ego = reversed(&ego);
    }
    // The relations are built about the origin and along the axes, where rounding is kind.
    let motion = match dice.below(4) {
        0 => [0.0; 3],
        1 => [0.0, 0.0, FRAC_PI_2 * dice.below(4) as f64],
        2 => [dice.range(-5.0, 5.0), dice.range(-5.0, 5.0), dice.range(-3.2, 3.2)],
        _ => [dice.range(-100.0, 100.0), dice.range(-100.0, 100.0), dice.range(-3.2, 3.2)],
    };
    let pair = (moved(&ego, motion), moved(&other, motion));
    if dice.chance(0.5) { pair } else { (pair.1, pair.0) }
}

/// A line or an arc of ordinary size.
pub fn leg(dice: &mut Dice) -> Leg {
    match dice.below(6) {
        0 | 1 => Leg::Line(dice.range(0.1, 4.0)),
        2 => Leg::arc(dice.range(0.05, 0.5), dice.sign() * dice.range(0.1, 6.2)),
        3 => Leg::arc(dice.range(0.3, 3.0), dice.sign() * dice.sweep()),
        _ => Leg::arc(dice.range(0.3, 3.0), dice.sign() * dice.range(0.1, 2.5)),
    }
}

/// A profile over a path: limits, or pieces with waits that travel `length` \[m\].
pub fn drive(dice: &mut Dice, length: f64) -> Drive {
    if length == 0.0 || dice.chance(0.4) {
        return Drive::Limits(dice.range(0.2, 2.0), dice.range(0.1, 3.0));
    }
    // Trapezoids from rest to rest with waits in between, each over a share of the length.
    let mut pieces = Vec::new();
    let parts = 1 + dice.below(3);
    for _ in 0..parts {
        if dice.chance(0.5) {
            pieces.push((dice.range(0.0, 4.0), 0.0));
        }
        let (ramp, cruise) = (dice.range(0.2, 2.0), if dice.chance(0.3) { 0.0 } else { dice.range(0.0, 3.0) });
        let acceleration = length / parts as f64 / (ramp * (ramp + cruise));
        pieces.extend([(ramp, acceleration), (cruise, 0.0), (ramp, -acceleration)]);
    }
    Drive::Pieces(0.0, pieces)
}

/// Cuts one leg in two: nothing changes.
pub fn split(disc: &mut Disc, dice: &mut Dice) {
    if disc.legs.is_empty() {
        return;
    }
    let index = dice.below(disc.legs.len());
    let leg = disc.legs[index];
    let first = leg.length() * dice.range(0.0, 1.0);
    disc.legs[index] = leg.with_length(first);
    disc.legs.insert(index + 1, leg.with_length(leg.length() - first));
}

/// The disc, driven from the end of its path to its start.
pub fn reversed(disc: &Disc) -> Disc {
    let (x, y) = crate::oracle::Route::new(disc).at(disc.length());
    let heading = disc.start[2] + disc.legs.iter().map(|leg| leg.sweep()).sum::<f64>();
    let heading = (heading + 0.5 * TAU) % TAU;
    let legs = disc.legs.iter().rev().map(|leg| leg.reversed()).collect();
    Disc { radius: disc.radius, start: [x, y, heading], legs }
}

/// The disc, turned about the origin by the third number and then shifted by the first two.
pub fn moved(disc: &Disc, [dx, dy, turn]: [f64; 3]) -> Disc {
    let [x, y, heading] = disc.start;
    let (sin, cos) = turn.sin_cos();
    Disc { start: [cos * x - sin * y + dx, sin * x + cos * y + dy, heading + turn], ..disc.clone() }
}

/// A pair in motion for the checker of tables, in the format `S`: those of [`case`], others whose numbers are multiples of a few, that
/// touch from inside an arc or are related to one another, each number of these a few last digits off now and then.
pub fn certifiable<S: HostScalar>(seed: u64) -> Case {
    let (kind, seed) = (seed % 8, seed / 8);
    if kind < 3 {
        return case(seed.wrapping_mul(3).wrapping_add(kind)).0;
    }
    let mut dice = Dice::seeded(seed.wrapping_mul(8).wrapping_add(kind));
    let pair = match kind {
        3 | 4 => tangencies::lattice(&mut dice),
        5 | 6 => tangencies::inside(&mut dice),
        _ => {
            let relation = RELATIONS[dice.below(RELATIONS.len())];
            related(relation, &mut dice)
        }
    };
    let mut dice = Dice::seeded(!seed);
    let often = if dice.chance(0.5) { 0.0 } else { 0.3 };
    let [first, second] = [pair.0, pair.1].map(|disc| nudged::<S>(disc.rounded::<S>(), often, &mut dice));
    let drives = [&first, &second].map(|disc| match dice.below(4) {
        0 => (drive(&mut dice, disc.length()), dice.range(-5.0, 50.0)),
        _ => (Drive::Unit, 0.0),
    });
    ((first, second), drives)
}

/// The disc with some of its numbers one to three last digits off.
fn nudged<S: HostScalar>(mut disc: Disc, often: f64, dice: &mut Dice) -> Disc {
    let mut nudge = |value: f64| {
        // Beyond the limit there may be no other number; the library refuses it.
        if !dice.chance(often) || value.abs() >= S::LIMIT.to_f64() {
            return value;
        }
        let (steps, above) = (1 + dice.below(3), dice.chance(0.5));
        (0..steps).fold(S::from_f64(value), |value, _| neighbour(value, above)).to_f64()
    };
    disc.radius = nudge(disc.radius);
    disc.start[0] = nudge(disc.start[0]);
    disc.start[1] = nudge(disc.start[1]);
    for leg in &mut disc.legs {
        *leg = match *leg {
            Leg::Line(length) => Leg::Line(nudge(length)),
            Leg::Left { radius, length } => Leg::Left { radius: nudge(radius), length: nudge(length) },
            Leg::Right { radius, length } => Leg::Right { radius: nudge(radius), length: nudge(length) },
        };
    }
    disc
}
