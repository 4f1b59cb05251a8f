//! Contact from inside an arc, within a few slacks of touching: where rounding is amplified most.

use super::{Dice, Pair};
use crate::disc::{Disc, Leg};
use std::f64::consts::{PI, TAU};

/// A disc on an arc of a radius ϱ of about `size` \[m\], R = ϱ (1 - q) or ϱ (1 + q) with q from 1e-4 to 0.6, and a line or an
/// arc that passes its centre at |ϱ - R|, give or take 6 `slack` \[m\].
pub fn inner_tangent(size: f64, slack: f64, dice: &mut Dice) -> Pair {
    let own = size * dice.range(0.3, 3.0);
    let q = dice.magnitude(1e-4, 0.6);
    let radius = if dice.chance(0.8) { own * (1.0 - q) } else { own * (1.0 + q) };
    let share = dice.range(0.2, 0.8);
    let at = [dice.range(-3.0, 3.0) * size, dice.range(-3.0, 3.0) * size];
    // The arc about `at`, and the point of it at which the disc touches.
    let (turn, middle) = (dice.sign(), dice.range(-PI, PI));
    let longest = if dice.chance(0.5) { 1.0 } else { 6.2 };
    let sweep = dice.range(0.05, longest);
    let heading = middle - turn * sweep * dice.range(0.1, 0.9);
    let [x, y] = [at[0] + own * (heading - turn * 0.5 * PI).cos(), at[1] + own * (heading - turn * 0.5 * PI).sin()];
    let first = Disc { radius: share * radius, start: [x, y, heading], legs: vec![Leg::arc(own, turn * sweep)] };
    // The nearest point of the other path: on the far side of the centre.
    let away = middle + turn * 0.5 * PI + if radius < own { 0.0 } else { PI };
    let distance = (own - radius).abs() + dice.range(-6.0, 6.0) * slack;
    let [x, y] = [at[0] + distance * away.cos(), at[1] + distance * away.sin()];
    let along = away + 0.5 * PI * dice.sign();
    let (before, after) = (size * dice.magnitude(0.01, 1.5), size * dice.magnitude(0.01, 1.5));
    let (start, legs) = if dice.chance(0.4) {
        ([x - before * along.cos(), y - before * along.sin(), along], vec![Leg::Line(before + after)])
    } else {
        let (bend, turn) = (size * dice.magnitude(0.1, 5.0), dice.sign());
        let [before, after] = [before, after].map(|part| (part / bend).min(3.0));
        let normal = along + turn * 0.5 * PI;
        let centre = [x + bend * normal.cos(), y + bend * normal.sin()];
        let (start, out) = (along - turn * before, along - turn * (before + 0.5 * PI));
        let at = [centre[0] + bend * out.cos(), centre[1] + bend * out.sin(), start % TAU];
        (at, vec![Leg::arc(bend, turn * (before + after))])
    };
    let second = Disc { radius: radius - share * radius, start, legs };
    if dice.chance(0.5) { (first, second) } else { (second, first) }
}
