//! Pairs whose numbers are multiples of a few, and pairs that touch from inside an arc: where many things happen at once.

use super::{Dice, Pair, moved};
use crate::disc::{Disc, Leg};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_6, PI, TAU};

/// Integers and halves, and multiples of π/4 and π/6: what people draw.
pub(super) fn lattice(dice: &mut Dice) -> Pair {
    let unit = [FRAC_PI_4, FRAC_PI_6][dice.below(2)];
    let disc = |dice: &mut Dice| {
        let halves = |dice: &mut Dice, count: usize| 0.5 * dice.below(count) as f64;
        let (x, y) = (halves(dice, 13) - 3.0, halves(dice, 13) - 3.0);
        let start = [x, y, unit * dice.below((TAU / unit + 0.5) as usize) as f64 - PI];
        let legs = (0..1 + dice.below(4)).map(|_| match dice.below(2) {
            0 => Leg::Line(0.5 + halves(dice, 8)),
            _ => {
                let turns = (1 + dice.below((TAU / unit + 0.5) as usize)) as f64;
                Leg::arc(0.5 + halves(dice, 6), dice.sign() * (turns * unit).min(TAU))
            }
        });
        let legs = legs.collect();
        Disc { radius: 0.25 + 0.25 * dice.below(8) as f64, start, legs }
    };
    (disc(dice), disc(dice))
}

/// A disc of radius R that touches an arc of radius ϱ from inside, |ϱ - R| from 0 to ϱ, or stays a few last digits of
/// some format away from it: the path of its centre comes as near as |ϱ - R| to the centre of the arc, or as far.
pub(super) fn inside(dice: &mut Dice) -> Pair {
    let bend = dice.magnitude(0.2, 20.0);
    let ring = bend
        * match dice.below(4) {
            0 => 0.0,
            1 => dice.magnitude(1e-9, 1e-3),
            2 => dice.magnitude(1e-3, 1.0),
            _ => dice.range(0.0, 1.0),
        };
    let combined = if dice.chance(0.3) { bend + ring } else { (bend - ring).max(0.01 * bend) };
    let digit = [f64::EPSILON * bend, 6e-8 * bend, 1e-6, 1.5e-5, 2.5e-4][dice.below(5)];
    let off = digit * dice.range(-12.0, 12.0);
    let (own, other) = touching([bend, combined], off, dice);
    let away = match dice.below(3) {
        0 => [0.0; 3],
        1 => [dice.range(-5.0, 5.0), dice.range(-5.0, 5.0), 0.0],
        _ => [dice.range(-100.0, 100.0), dice.range(-100.0, 100.0), dice.range(-PI, PI)],
    };
    let (own, other) = (moved(&own, away), moved(&other, away));
    if dice.chance(0.5) { (own, other) } else { (other, own) }
}

/// The same of about a `size` \[m\], give or take 6 `slack` \[m\], R = ϱ (1 - q) or ϱ (1 + q) with q from 1e-4 to 0.6: where
/// rounding is amplified most.
pub fn inner_tangent(size: f64, slack: f64, dice: &mut Dice) -> Pair {
    let bend = size * dice.range(0.3, 3.0);
    let q = dice.magnitude(1e-4, 0.6);
    let combined = if dice.chance(0.8) { bend * (1.0 - q) } else { bend * (1.0 + q) };
    let off = slack * dice.range(-6.0, 6.0);
    let (own, other) = touching([bend, combined], off, dice);
    let away = [dice.range(-3.0, 3.0) * size, dice.range(-3.0, 3.0) * size, dice.range(-PI, PI)];
    let (own, other) = (moved(&own, away), moved(&other, away));
    if dice.chance(0.5) { (own, other) } else { (other, own) }
}

/// A disc on an arc of about half a turn, of about a `size` \[m\] and up to 20 `slack` \[m\] larger than the disc, and one that passes
/// the centre on the other side: there the arc's ends are nearest, one after the other, and its middle is far.
pub fn behind(size: f64, slack: f64, dice: &mut Dice) -> Pair {
    let bend = size * dice.range(0.3, 3.0);
    let over = slack * [dice.magnitude(1e-4, 1.0), dice.range(0.0, 4.0), dice.range(0.0, 20.0)][dice.below(3)];
    let combined = bend - slack - over;
    let share = dice.range(0.1, 0.9);
    let sweep = PI + if dice.chance(0.8) { -dice.magnitude(1e-9, 1.0) } else { dice.magnitude(1e-9, 1.0) };
    let (sin, cos) = (-0.5 * sweep).sin_cos();
    let start = [bend * cos, bend * sin, 0.5 * (PI - sweep)];
    let own = Disc { radius: share * combined, start, legs: vec![Leg::arc(bend, sweep)] };
    // The ends are as near as the disc where |y| = over + x² / 2 bend: the other path is drawn at that scale.
    let scale = [(2.0 * bend * over.max(0.1 * slack)).sqrt(), dice.magnitude(slack, bend), bend][dice.below(3)];
    let mut place = || [scale * dice.range(-5.0, 3.0), over.max(slack) * dice.range(-8.0, 8.0)];
    let [from, to] = [place(), place()];
    let (length, heading) = ((to[0] - from[0]).hypot(to[1] - from[1]), (to[1] - from[1]).atan2(to[0] - from[0]));
    let bent = if dice.chance(0.3) { dice.sign() * dice.magnitude(1e-6, 3.0) } else { 0.0 };
    let (legs, heading) = if bent == 0.0 {
        (vec![Leg::Line(length)], heading)
    } else {
        (vec![Leg::arc(0.5 * length / (0.5 * bent).sin().abs(), bent)], heading - 0.5 * bent)
    };
    let other = Disc { radius: combined - share * combined, start: [from[0], from[1], heading], legs };
    let away = [[0.0; 3], [dice.range(-3.0, 3.0), dice.range(-3.0, 3.0), dice.range(-PI, PI)]][dice.below(2)];
    let (own, other) = (moved(&own, away), moved(&other, away));
    if dice.chance(0.5) { (own, other) } else { (other, own) }
}

/// A disc on an arc of radius `bend` about the origin, and one whose path comes as near to the origin, or as far, as their radii
/// together differ from that, and by `off` more \[m\].
fn touching([bend, combined]: [f64; 2], off: f64, dice: &mut Dice) -> Pair {
    let share = dice.range(0.1, 0.9);
    // The arc starts anywhere on its circle.
    let (from, sweep) = (dice.range(-PI, PI), dice.sweep());
    let on = [bend * from.cos(), bend * from.sin(), from + FRAC_PI_2];
    let own = Disc { radius: share * combined, start: on, legs: vec![Leg::arc(bend, sweep)] };
    // The other path, at its place nearest to the centre or farthest from it: there it goes straight up at x = `way`.
    let way = (bend - combined).abs() + off;
    let (before, after) = (dice.range(0.0, 1.5) * bend, dice.range(0.01, 1.5) * bend);
    let legs = match dice.below(3) {
        0 => vec![Leg::Line(before + after)],
        _ => {
            let radius = bend * dice.magnitude(0.05, 10.0);
            vec![Leg::arc(radius, dice.sign() * ((before + after) / radius).min(TAU))]
        }
    };
    let bent = legs[0].sweep() * before / (before + after);
    let start = match legs[0].radius() {
        None => [way, -before, FRAC_PI_2],
        Some(radius) => {
            // Its centre is at (way - radius, 0), where it turns left.
            let (radius, (sin, cos)) = (radius.copysign(bent), (-bent).sin_cos());
            [way - radius + radius * cos, radius * sin, FRAC_PI_2 - bent]
        }
    };
    let other = Disc { radius: combined - share * combined, start, legs };
    let turned = dice.range(-PI, PI);
    (own, moved(&other, [0.0, 0.0, turned]))
}
