//! The motion of a vehicle along a way: it stops where it has to, and turns in place at corners.

use super::random::Random;
use crate::course::Shape;
use crate::vda5050::held::Held;
use crate::vda5050::way::Way;
use serde::{Deserialize, Serialize};

/// What a vehicle can do, and how badly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Abilities {
    /// Of the disc that it fits in \[m\].
    pub radius: f64,
    /// \[m/s\]
    pub speed: f64,
    /// Speeding up and braking \[m/s²\].
    pub acceleration: f64,
    /// Turning in place \[rad/s\].
    pub rotation: f64,
    /// Largest part of its way that it loses.
    pub slip: f64,
    /// How far it is off its way at most \[m\].
    pub drift: f64,
    /// How far off the position that it reports is at most \[m\].
    pub noise: f64,
    /// Longest hold-up, about every 20 s \[s\].
    pub delay: f64,
}

impl Default for Abilities {
    fn default() -> Self {
        Self {
            radius: 0.4,
            speed: 1.0,
            acceleration: 0.5,
            rotation: 1.0,
            slip: 0.05,
            drift: 0.02,
            noise: 0.02,
            delay: 2.0,
        }
    }
}

/// How far and how fast a vehicle is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drive {
    /// Length of the way that it has done \[m\].
    pub at: f64,
    /// \[m/s\]
    pub speed: f64,
    /// How long it still turns in place \[s\].
    pub turns: f64,
    /// How long it is still held up \[s\].
    pub held_up: f64,
    /// Up to which length it has turned \[m\].
    turned: f64,
}

/// Lengths that are as near are the same \[m\].
const NEAR: f64 = 1e-6;

impl Drive {
    /// At the start of a way.
    pub fn new() -> Self {
        Self { turned: -1.0, ..Self::default() }
    }

    /// Whether it moves or turns.
    pub fn is_driving(&self) -> bool {
        self.speed > 0.0 || self.turns > 0.0
    }

    /// Goes on for a time \[s\], no further than an end \[m\].
    pub fn advance(&mut self, way: &Way, held: &Held, end: f64, can: &Abilities, random: &mut Random, time: f64) {
        if self.held_up > 0.0 {
            // Held up by something in its way: it has stopped at once.
            (self.held_up, self.speed) = ((self.held_up - time).max(0.0), 0.0);
            return;
        }
        if self.turns > 0.0 {
            self.turns = (self.turns - time).max(0.0);
            return;
        }
        if self.speed > 0.0 && can.delay > 0.0 && random.happens(0.05, time) {
            self.held_up = random.unit() * can.delay;
        }
        let corner = corner(way, held, self.at, self.turned);
        let stop = corner.map_or(end, |(length, _)| length.min(end));
        let left = (stop - self.at).max(0.0);
        if left <= NEAR {
            self.speed = 0.0;
            if let Some((length, angle)) = corner.filter(|(length, _)| *length <= self.at + NEAR && end > length + NEAR)
            {
                (self.turns, self.turned) = (angle / can.rotation, length);
            }
            return;
        }
        let before = self.speed;
        let after = (before + can.acceleration * time).min(can.speed).min((2.0 * can.acceleration * left).sqrt());
        let step = 0.5 * (before + after) * time * (1.0 - can.slip * random.unit());
        self.speed = after;
        self.at = if step >= left { stop } else { self.at + step };
        if stop - self.at <= NEAR {
            (self.at, self.speed) = (stop, 0.0);
        }
    }

    /// Comes to rest within a time \[s\], or as fast as it can.
    pub fn brake(&mut self, end: f64, can: &Abilities, time: f64) {
        let after = (self.speed - can.acceleration * time).max(0.0);
        self.at = (self.at + 0.5 * (self.speed + after) * time).min(end);
        self.speed = after;
        self.turns = 0.0;
    }
}

/// The next corner from a length on at which the vehicle has not yet turned, and by how much \[m, rad\].
fn corner(way: &Way, held: &Held, at: f64, turned: f64) -> Option<(f64, f64)> {
    /// Turned while driving \[rad\].
    const SLIGHT: f64 = 0.01;
    let angle = |shapes: &[Shape]| match shapes.first() {
        Some(Shape::Turn { sweep }) if sweep.abs() > SLIGHT => Some(sweep.abs()),
        _ => None,
    };
    if at <= NEAR
        && turned < 0.0
        && let Some(angle) = angle(way.shapes(None, held.nodes.len()))
    {
        return Some((0.0, angle));
    }
    let nodes = (0..held.nodes.len()).filter_map(|node| Some((node, way.node(node)?)));
    let mut ahead = nodes.filter(|(_, length)| *length >= at - NEAR && *length > turned + NEAR);
    ahead.find_map(|(node, length)| Some((length, angle(way.shapes(Some(node), node + 1))?)))
}
