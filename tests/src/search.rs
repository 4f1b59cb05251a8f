//! Directed search: pairs whose regions end as near as possible to where a collision would be lost, or one invented.
//!
//! Random pairs hardly ever come near the worst case. From a pair that is degenerate within a few slacks each step changes one
//! number of it, by any order of magnitude down to the last digit, and is kept unless the ends of the regions are farther from
//! their limits then.

use crate::clearance::of_ends;
use crate::disc::{Disc, Leg};
use crate::generators::{Dice, Pair, RELATIONS, inner_tangent, related};
use pcr_planning::fleet::Format;

/// What a search has come to.
#[derive(Clone, Debug)]
pub struct Worst {
    /// The least and the largest clearance of ends of the regions of the pair, as parts of the excess.
    pub ends: [f64; 2],
    /// The pair.
    pub pair: Pair,
}

impl Worst {
    /// How far it is from a violation.
    pub fn margin(&self) -> f64 {
        let [least, most] = self.ends;
        least.min(1.0 - most)
    }
}

/// The pair of this number to start from, of a size that leaves the format some digits; two of three are tangent from inside.
pub fn start<S: Format>(seed: u64) -> Pair {
    let mut dice = Dice::seeded(seed);
    let size = size::<S>();
    let slack = S::slack(S::from_f64(10.0 * size)).to_f64();
    if seed % 3 == 2 {
        let (a, b) = related(RELATIONS[dice.below(RELATIONS.len())], &mut dice);
        return (scaled(&a, size), scaled(&b, size));
    }
    inner_tangent(size, slack, &mut dice)
}

/// A metre, or what has as many digits as one of `Q16`.
fn size<S: Format>() -> f64 {
    (S::slack(S::ZERO).to_f64() * 13_000.0).max(1.0)
}

fn scaled(disc: &Disc, by: f64) -> Disc {
    let [x, y, heading] = disc.start;
    let legs = disc.legs.iter().map(|leg| match *leg {
        Leg::Line(length) => Leg::Line(by * length),
        Leg::Left { radius, length } => Leg::Left { radius: by * radius, length: by * length },
        Leg::Right { radius, length } => Leg::Right { radius: by * radius, length: by * length },
    });
    Disc { radius: by * disc.radius, start: [by * x, by * y, heading], legs: legs.collect() }
}

/// The worst pair within so many steps of the one of this number; none if that has no end to look at.
pub fn search<S: Format>(seed: u64, steps: u64) -> Option<Worst> {
    let pair = start::<S>(seed);
    let mut worst = Worst { ends: of_ends::<S>(&pair)?, pair };
    for step in 0..steps {
        let pair =
            changed(&worst.pair, &mut Dice::seeded(seed.wrapping_mul(0x1_0000_0001).wrapping_add(step)), size::<S>());
        if let Some(ends) = of_ends::<S>(&pair) {
            let next = Worst { ends, pair };
            if next.margin() <= worst.margin() {
                worst = next;
            }
        }
    }
    Some(worst)
}

/// One number of the pair, changed.
fn changed(pair: &Pair, dice: &mut Dice, size: f64) -> Pair {
    let mut pair = pair.clone();
    let disc = if dice.chance(0.5) { &mut pair.0 } else { &mut pair.1 };
    let by = dice.sign() * size * dice.magnitude(1e-16, 0.1);
    let index = dice.below(4 + disc.legs.len());
    match index.checked_sub(4).and_then(|leg| disc.legs.get_mut(leg)) {
        Some(Leg::Line(length)) => *length = (*length + by).max(0.0),
        Some(Leg::Left { radius, length } | Leg::Right { radius, length }) => {
            if dice.chance(0.5) {
                *radius = (*radius + by).max(1e-3 * size);
            } else {
                *length = (*length + by).max(0.0);
            }
        }
        None if index == 0 => disc.radius = (disc.radius + by).max(1e-3 * size),
        None => disc.start[index - 1] += if index == 3 { by / size } else { by },
    }
    pair
}
