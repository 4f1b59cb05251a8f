//! Pairs of paths that stand in a special relation to one another.

use super::{Dice, Pair, leg, moved, reversed};
use crate::disc::{Disc, Leg};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// What is special about a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// Nothing.
    Any,
    /// Parallel lines at a distance of about R, or less, either direction.
    ParallelLines,
    /// Following or head-on on one line.
    OneLine,
    /// Lines that are almost parallel.
    AlmostParallel,
    /// A line at a distance of about R from an arc, outside or inside.
    TangentLine,
    /// Concentric arcs whose radii differ by about R, or less, either direction.
    ConcentricArcs,
    /// Arcs of the same circle.
    OneCircle,
    /// Circles at such a distance that the discs just touch, outside or inside.
    TangentCircles,
    /// A path through the centre of an arc, R about its radius, or larger.
    ThroughCentre,
    /// R larger than the radii of both arcs.
    LargeDisc,
    /// Paths that merge tangentially.
    Merging,
    /// The same path.
    Identical,
    /// The same path, the other way round.
    Opposite,
    /// One agent stands inside the other's path, or just at its side.
    Standing,
    /// Both stand.
    BothStanding,
    /// Arcs that turn on and on with a changing radius.
    Spiral,
    /// Radii from 1e-3 m to 1e7 m.
    ExtremeRadii,
    /// Paths with an end in common.
    CommonEnd,
    /// Paths of a multiple of a length, so that joints and ends coincide with events.
    Lattice,
    /// The other ends, or starts, just at contact.
    TouchingEnd,
}

/// All relations.
pub const RELATIONS: [Relation; 20] = [
    Relation::Any,
    Relation::ParallelLines,
    Relation::OneLine,
    Relation::AlmostParallel,
    Relation::TangentLine,
    Relation::ConcentricArcs,
    Relation::OneCircle,
    Relation::TangentCircles,
    Relation::ThroughCentre,
    Relation::LargeDisc,
    Relation::Merging,
    Relation::Identical,
    Relation::Opposite,
    Relation::Standing,
    Relation::BothStanding,
    Relation::Spiral,
    Relation::ExtremeRadii,
    Relation::CommonEnd,
    Relation::Lattice,
    Relation::TouchingEnd,
];

pub(super) fn related(relation: Relation, dice: &mut Dice) -> Pair {
    let combined = dice.magnitude(0.05, 1.5);
    let share = dice.range(0.1, 0.9);
    let (own, their) = (share * combined, combined - share * combined);
    let r = own + their;
    let disc = |radius, x: f64, y: f64, heading: f64, legs| Disc { radius, start: [x, y, heading], legs };
    let east = |length| disc(own, 0.0, 0.0, 0.0, vec![Leg::Line(length)]);
    match relation {
        Relation::Any => (any(own, dice), any(their, dice)),
        Relation::ParallelLines => {
            let length = dice.range(0.5, 5.0);
            let distance = if dice.chance(0.6) { dice.near(r) } else { dice.range(0.0, r) };
            let (x, heading) = if dice.chance(0.5) { (0.0, 0.0) } else { (length, PI) };
            let shift = if dice.chance(0.3) { 0.0 } else { dice.range(-2.0, 2.0) };
            (east(length), disc(their, x + shift, distance, heading, vec![Leg::Line(dice.range(0.5, 5.0))]))
        }
        Relation::OneLine => {
            let length = dice.range(0.5, 5.0);
            let (x, heading) = if dice.chance(0.5) { (dice.range(-2.0, 2.0), 0.0) } else { (dice.range(0.0, 6.0), PI) };
            let second = match dice.below(3) {
                0 => length,
                1 => dice.near(r),
                _ => dice.range(0.5, 5.0),
            };
            (east(length), disc(their, x, 0.0, heading, vec![Leg::Line(second)]))
        }
        Relation::AlmostParallel => {
            let angle = dice.sign() * dice.magnitude(1e-12, 1e-2) + if dice.chance(0.5) { PI } else { 0.0 };
            let distance = if dice.chance(0.5) { dice.near(r) } else { dice.range(0.0, r) };
            let other = disc(their, dice.range(-1.0, 3.0), distance, angle, vec![Leg::Line(dice.range(0.5, 5.0))]);
            (east(dice.range(0.5, 5.0)), other)
        }
        Relation::TangentLine => {
            let (radius, sweep) = (dice.range(0.2, 3.0), dice.sign() * dice.sweep());
            let ego = disc(own, 0.0, 0.0, dice.range(-PI, PI), vec![Leg::arc(radius, sweep)]);
            let (cx, cy) = centre(&ego);
            let distance = match dice.below(3) {
                0 => radius + r,
                1 => radius - r,
                _ => radius,
            };
            let heading = dice.range(-PI, PI);
            let back = dice.range(0.0, 3.0);
            let (sin, cos) = heading.sin_cos();
            let distance = dice.near(distance);
            let (x, y) = (cx + sin * distance - cos * back, cy - cos * distance - sin * back);
            (ego, disc(their, x, y, heading, vec![Leg::Line(back + dice.range(-0.5, 3.0).max(0.0))]))
        }
        Relation::ConcentricArcs => {
            let radius = dice.range(0.2, 3.0);
            let apart = if dice.chance(0.6) { dice.near(r) } else { dice.range(0.0, r) };
            (circling(own, radius, dice), circling(their, radius + apart, dice))
        }
        Relation::OneCircle => {
            let radius = if dice.chance(0.3) { dice.near(r) } else { dice.range(0.2, 3.0) };
            let ego = circling(own, radius, dice);
            let mut other = circling(their, radius, dice);
            if dice.chance(0.3) {
                other.start = ego.start;
            }
            (ego, other)
        }
        Relation::TangentCircles => {
            let (a, b) = (dice.range(0.1, 2.0), dice.range(0.1, 2.0));
            let distance = match dice.below(5) {
                0 => a + b + r,
                1 => (a - b).abs() + r,
                2 => (a - b).abs() - r,
                3 => a + b - r,
                _ => r - a - b,
            };
            let shift = [dice.near(distance.abs()), 0.0, 0.0];
            (circling(own, a, dice), moved(&circling(their, b, dice), shift))
        }
        Relation::ThroughCentre => {
            let radius = match dice.below(3) {
                0 => dice.near(r),
                1 => dice.range(0.1, 1.0) * r,
                _ => dice.range(1.0, 3.0) * r,
            };
            let ego = circling(own, radius, dice);
            let heading = dice.range(-PI, PI);
            let back = dice.range(0.0, 3.0);
            let first =
                if dice.chance(0.5) { Leg::Line(back) } else { Leg::arc(dice.range(0.3, 3.0), dice.sign() * 1.0) };
            // Reversed, so that the path leads from the centre outwards and, as often, back through it.
            let out = disc(their, 0.0, 0.0, heading, vec![first]);
            let mut other = if dice.chance(0.7) { reversed(&out) } else { out };
            if dice.chance(0.7) {
                other.legs.push(leg(dice));
            }
            (ego, other)
        }
        Relation::LargeDisc => {
            let (a, b) = (dice.range(0.05, 1.1) * r, dice.range(0.05, 1.1) * r);
            let shift = [dice.range(-1.5, 1.5) * r, dice.range(-1.5, 1.5) * r, 0.0];
            (circling(own, a, dice), moved(&circling(their, b, dice), shift))
        }
        Relation::Merging => {
            let ego = disc(own, 0.0, 0.0, 0.0, vec![Leg::Line(dice.range(0.5, 5.0)), leg(dice)]);
            let merge = [dice.range(0.0, 3.0), 0.0, if dice.chance(0.7) { PI } else { 0.0 }];
            let branch = vec![Leg::arc(dice.range(0.3, 3.0), dice.sign() * dice.range(0.2, 1.6)), leg(dice)];
            let branch = disc(their, merge[0], merge[1], merge[2], branch);
            let mut other = if dice.chance(0.7) { reversed(&branch) } else { branch };
            other.legs.push(Leg::Line(dice.range(0.3, 4.0)));
            (ego, other)
        }
        Relation::Identical => {
            let ego = any(own, dice);
            let other = Disc { radius: their, ..ego.clone() };
            (ego, other)
        }
        Relation::Opposite => {
            let ego = any(own, dice);
            let other = Disc { radius: their, ..reversed(&ego) };
            (ego, other)
        }
        Relation::Standing => {
            let ego = any(own, dice);
            let route = crate::oracle::Route::new(&ego);
            let (x, y) = route.at(dice.range(0.0, ego.length()));
            let angle = dice.range(-PI, PI);
            let off = match dice.below(3) {
                0 => 0.0,
                1 => dice.near(r),
                _ => dice.range(0.0, r),
            };
            (ego, disc(their, x + off * angle.cos(), y + off * angle.sin(), angle, vec![]))
        }
        Relation::BothStanding => {
            let off = if dice.chance(0.7) { dice.near(r) } else { dice.range(0.0, 2.0 * r) };
            (disc(own, 0.0, 0.0, 0.0, vec![]), disc(their, off, 0.0, 0.0, vec![]))
        }
        Relation::Spiral => {
            let spiral = |radius: f64, dice: &mut Dice| {
                let (mut bend, turn) = (dice.range(0.2, 1.0), dice.sign());
                let (growth, sweep) = (dice.range(0.6, 1.6), dice.range(0.5, TAU));
                let mut legs = Vec::new();
                for _ in 0..2 + dice.below(4) {
                    legs.push(Leg::arc(bend, turn * sweep));
                    bend *= growth;
                }
                disc(radius, dice.range(-1.0, 1.0), dice.range(-1.0, 1.0), dice.range(-PI, PI), legs)
            };
            (spiral(own, dice), spiral(their, dice))
        }
        Relation::ExtremeRadii => {
            let path = |radius: f64, dice: &mut Dice| {
                let mut legs = Vec::new();
                for _ in 0..1 + dice.below(3) {
                    let bend = dice.magnitude(1e-3, 1e7);
                    let sweep = (dice.range(0.3, 4.0) / bend).min(dice.sweep());
                    legs.push(Leg::arc(bend, dice.sign() * sweep));
                }
                disc(radius, dice.range(-1.0, 1.0), dice.range(-1.0, 1.0), dice.range(-PI, PI), legs)
            };
            (path(own, dice), path(their, dice))
        }
        Relation::CommonEnd => {
            let ego = any(own, dice);
            let mut other = any(their, dice);
            let route = crate::oracle::Route::new(&ego);
            let (x, y) = route.at(if dice.chance(0.5) { 0.0 } else { ego.length() });
            (other.start[0], other.start[1]) = (x, y);
            (ego, if dice.chance(0.5) { reversed(&other) } else { other })
        }
        Relation::Lattice => {
            let unit = r * [0.5, 1.0, 2.0][dice.below(3)];
            let path = |radius: f64, dice: &mut Dice| {
                let mut legs = Vec::new();
                for _ in 0..1 + dice.below(5) {
                    legs.push(match dice.below(4) {
                        0 => Leg::arc(unit, FRAC_PI_2),
                        1 => Leg::arc(unit, -FRAC_PI_2),
                        2 => Leg::arc(unit * (1 + dice.below(3)) as f64, dice.sign() * PI),
                        _ => Leg::Line(unit * (1 + dice.below(3)) as f64),
                    });
                }
                let mut cell = || unit * (dice.below(5) as f64 - 2.0);
                let (x, y) = (cell(), cell());
                disc(radius, x, y, FRAC_PI_2 * dice.below(4) as f64, legs)
            };
            (path(own, dice), path(their, dice))
        }
        Relation::TouchingEnd => {
            let ego = any(own, dice);
            let route = crate::oracle::Route::new(&ego);
            let at = if dice.chance(0.3) { ego.length() } else { dice.range(0.0, ego.length()) };
            let ((x, y), (ax, ay)) = (route.at(at), route.at((at - 1e-4).max(0.0)));
            // Off to the side of the path, or straight on from it.
            let angle = (y - ay).atan2(x - ax) + if dice.chance(0.5) { FRAC_PI_2 } else { 0.0 };
            let off = dice.near(r);
            let mut other = any(their, dice);
            other.start = [x + off * angle.cos(), y + off * angle.sin(), dice.range(-PI, PI)];
            (ego, if dice.chance(0.5) { reversed(&other) } else { other })
        }
    }
}

fn any(radius: f64, dice: &mut Dice) -> Disc {
    let start = [dice.range(-2.0, 2.0), dice.range(-2.0, 2.0), dice.range(-PI, PI)];
    let legs = (0..1 + dice.below(4)).map(|_| leg(dice)).collect();
    Disc { radius, start, legs }
}

/// A disc on a circle about the origin.
fn circling(radius: f64, bend: f64, dice: &mut Dice) -> Disc {
    let (angle, turn) = (if dice.chance(0.3) { 0.0 } else { dice.range(-PI, PI) }, dice.sign());
    let start = [bend * angle.cos(), bend * angle.sin(), angle + turn * FRAC_PI_2];
    Disc { radius, start, legs: vec![Leg::arc(bend, turn * dice.sweep())] }
}

/// Centre of the first leg, an arc.
fn centre(disc: &Disc) -> (f64, f64) {
    let [x, y, heading] = disc.start;
    let (sin, cos) = heading.sin_cos();
    match disc.legs[0] {
        Leg::Right { radius, .. } => (x + radius * sin, y - radius * cos),
        Leg::Left { radius, .. } => (x - radius * sin, y + radius * cos),
        Leg::Line(_) => (x, y),
    }
}
