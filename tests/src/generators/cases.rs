//! Pairs in motion by number, for runs of millions: related ones as everywhere, uniformly random ones, long chains;
//! slow and fast, with waits, and at times that are large against their travel.

use super::{Dice, Pair, RELATIONS, drive, leg, related};
use crate::disc::{Disc, Drive, Leg};
use std::f64::consts::PI;

/// One in so many pairs is of long chains, which take as much time as hundreds of others.
const CHAINS: u64 = 512;

/// A pair with a drive and a start time \[s\] for each.
pub type Case = (Pair, [(Drive, f64); 2]);

/// The case of this number, and dice for what is tried on it.
pub fn case(seed: u64) -> (Case, Dice) {
    let mut dice = Dice::seeded(seed);
    let pair = match dice.below(8) {
        _ if seed.is_multiple_of(CHAINS) => (chain(seed), chain(!seed)),
        0 | 1 => {
            let arena = dice.magnitude(1.0, 1000.0);
            (uniform(arena, &mut dice), uniform(arena, &mut dice))
        }
        _ => {
            let relation = RELATIONS[dice.below(RELATIONS.len())];
            related(relation, &mut dice)
        }
    };
    let mut dice = Dice::seeded(!seed);
    let drives = [&pair.0, &pair.1].map(|disc| match dice.below(3) {
        0 => (Drive::Unit, dice.range(-5.0, 50.0)),
        1 => (drive(&mut dice, disc.length()), dice.range(-5.0, 50.0)),
        _ => extreme(&mut dice, disc.length()),
    });
    ((pair, drives), dice)
}

/// A disc anywhere in an arena of this size \[m\], on a path that crosses a good part of it.
fn uniform(arena: f64, dice: &mut Dice) -> Disc {
    let mut within = || dice.range(-0.5, 0.5) * arena;
    let (x, y) = (within(), within());
    let start = [x, y, dice.range(-PI, PI)];
    let radius = arena * dice.magnitude(1e-3, 0.1);
    let legs = (0..1 + dice.below(4)).map(|_| {
        let length = arena * dice.range(0.01, 0.4);
        if dice.chance(0.4) {
            Leg::Line(length)
        } else {
            let bend = arena * dice.magnitude(0.02, 2.0);
            Leg::arc(bend, dice.sign() * (length / bend).min(6.2))
        }
    });
    Disc { radius, start, legs: legs.collect() }
}

/// A disc on a path of hundreds of legs: different ones, or the same two or four over and over, whose rounding errors
/// do not cancel.
fn chain(seed: u64) -> Disc {
    let mut dice = Dice::seeded(seed);
    let start = [dice.range(-5.0, 5.0), dice.range(-5.0, 5.0), dice.range(-PI, PI)];
    let radius = dice.range(0.1, 0.5);
    let count = 100 + dice.below(300);
    let pattern: Vec<Leg> = (0..2 + 2 * dice.below(2)).map(|_| leg(&mut dice)).collect();
    let repeated = dice.chance(0.5);
    let legs = (0..count).map(|k| {
        if repeated { pattern[k % pattern.len()] } else { leg(&mut Dice::seeded(seed.wrapping_add(k as u64))) }
    });
    Disc { radius, start, legs: legs.collect() }
}

/// A drive and a start time with large ratios: speeds from 1 cm/s to 20 m/s, accelerations from 1 cm/s² to 50 m/s²,
/// waits of up to an hour, starts up to a day away.
fn extreme(dice: &mut Dice, length: f64) -> (Drive, f64) {
    let start = dice.sign() * dice.magnitude(1e-3, 1e5);
    if length == 0.0 || dice.chance(0.5) {
        return (Drive::Limits(dice.magnitude(0.01, 20.0), dice.magnitude(0.01, 50.0)), start);
    }
    // A start at speed, a wait, and a second part that does not come to rest.
    let (speed, wait) = (dice.magnitude(0.05, 5.0), dice.magnitude(0.1, 3600.0));
    let part = dice.range(0.1, 0.9) * length;
    let (stop, rest) = (2.0 * part / speed, length - part);
    let acceleration = dice.magnitude(0.01, 20.0);
    let pieces = vec![(stop, -speed / stop), (wait, 0.0), ((2.0 * rest / acceleration).sqrt(), acceleration)];
    (Drive::Pieces(speed, pieces), start)
}
