//! The motion of a vehicle along a way: it stops where it has to, and turns in place at corners.

use crate::owned_path::PathElement;
use crate::vda5050::order_path::OrderPath;
use pcr_formats::footprint::Footprint;
use pcr_formats::plane_geometry::wrapped;
use pcr_formats::splitmix64::SplitMix64;
use pcr_formats::vda5050::order_state::OrderState;
use serde::{Deserialize, Serialize};

/// The abilities and errors of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SimulatedTraits {
    /// Radius of the disc that contains it \[m\]; of no meaning for a rectangle.
    pub radius: f64,
    /// Length and width of a rectangle about its reference point \[m\]; `None` for a disc.
    pub rectangle: Option<[f64; 2]>,
    /// \[m/s\]
    pub speed: f64,
    /// Acceleration and deceleration \[m/s²\].
    pub acceleration: f64,
    /// Speed of turns in place \[rad/s\].
    pub rotation: f64,
    /// Largest share of its way that it loses.
    pub slip: f64,
    /// Largest distance from its way \[m\].
    pub drift: f64,
    /// Largest error of the position that it reports \[m\].
    pub noise: f64,
    /// Longest hold-up, about every 20 s \[s\].
    pub delay: f64,
}

impl Default for SimulatedTraits {
    fn default() -> Self {
        Self {
            radius: 0.4,
            rectangle: None,
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

impl SimulatedTraits {
    /// Its outline, if it is no disc.
    pub fn footprint(&self) -> Option<Footprint> {
        let [ahead, left] = self.rectangle?.map(|side| 0.5 * side);
        Footprint::new(vec![[-ahead, -left], [ahead, -left], [ahead, left], [-ahead, left]]).ok()
    }
}

/// Position and speed of a vehicle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DriveState {
    /// Length of the way that it has travelled \[m\].
    pub at: f64,
    /// \[m/s\]
    pub speed: f64,
    /// Remaining time of a turn in place \[s\].
    pub turns: f64,
    /// Remaining time of a hold-up \[s\].
    pub(crate) held_up: f64,
    /// Length up to which all turns are done \[m\].
    turned: f64,
}

/// Largest corner that is driven without a stop \[rad\].
const SLIGHT: f64 = 0.01;

/// Lengths that differ by at most this are equal \[m\].
const NEAR: f64 = 1e-6;

/// The largest speed at a place of a way, so that it can brake to the limits of all edges ahead in time \[m/s\].
fn speed_limit(way: &OrderPath, held: &OrderState, at: f64, can: &SimulatedTraits) -> f64 {
    let limits = held.edges.iter().enumerate().filter_map(|(k, edge)| {
        let (begin, end, speed) = (way.node(k)?, way.node(k + 1)?, edge.max_speed()?);
        // An edge is behind it as soon as it has left the place of its end.
        (end > at + NEAR).then(|| (speed.max(0.0).powi(2) + 2.0 * can.acceleration * (begin - at).max(0.0)).sqrt())
    });
    limits.fold(f64::INFINITY, f64::min)
}

impl DriveState {
    /// A vehicle at the start of a way.
    pub(crate) fn new() -> Self {
        Self { turned: -1.0, ..Self::default() }
    }

    /// Whether it moves or turns.
    pub(crate) fn is_driving(&self) -> bool {
        self.speed > 0.0 || self.turns > 0.0
    }

    /// Moves for a time \[s\], up to an end \[m\].
    pub(crate) fn advance(
        &mut self,
        way: &OrderPath,
        held: &OrderState,
        end: f64,
        can: &SimulatedTraits,
        random: &mut SplitMix64,
        time: f64,
    ) {
        if self.held_up > 0.0 {
            // Held up by an obstacle: it stops immediately.
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
        let most = can.speed.min(speed_limit(way, held, self.at, can));
        let after = (before + can.acceleration * time).min(most).min((2.0 * can.acceleration * left).sqrt());
        let step = 0.5 * (before + after) * time * (1.0 - can.slip * random.unit());
        self.speed = after;
        self.at = if step >= left { stop } else { self.at + step };
        if stop - self.at <= NEAR {
            (self.at, self.speed) = (stop, 0.0);
        }
    }

    /// Brakes within a time \[s\], as hard as necessary or possible.
    pub(crate) fn brake(&mut self, end: f64, can: &SimulatedTraits, time: f64) {
        let after = (self.speed - can.acceleration * time).max(0.0);
        self.at = (self.at + 0.5 * (self.speed + after) * time).min(end);
        self.speed = after;
        // A turn is done to its end.
        self.turns = (self.turns - time).max(0.0);
    }

    /// Heading at its place on a way \[rad\].
    pub(crate) fn heading(&self, way: &OrderPath, can: &SimulatedTraits) -> f64 {
        let [before, after] = [way.reached(self.at).heading, way.pose(self.at).heading];
        let sweep = wrapped(after - before);
        if sweep.abs() <= SLIGHT {
            after
        } else if self.turned < self.at - NEAR {
            before
        } else {
            after - (self.turns * can.rotation).min(sweep.abs()).copysign(sweep)
        }
    }
}

/// Length and angle of the next corner at which the vehicle has not turned yet \[m, rad\].
fn corner(way: &OrderPath, held: &OrderState, at: f64, turned: f64) -> Option<(f64, f64)> {
    let angle = |shapes: &[PathElement]| match shapes.first() {
        Some(PathElement::Turn { sweep, .. }) if sweep.abs() > SLIGHT => Some(sweep.abs()),
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
