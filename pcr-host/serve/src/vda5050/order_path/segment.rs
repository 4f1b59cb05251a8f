//! The pieces of a path: lines and arcs that a vehicle drives, and turns in place of an outline.

use crate::owned_path::StartPose;
use pcr_formats::scenario::{PathSegment, PlacedSegment};
use std::f64::consts::TAU;

/// Length of the path for each radian that an outline turns in place \[m\].
pub(super) const LEVER: f64 = 0.02;

/// A piece of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OrderPathSegment {
    /// Length of the path up to it \[m\].
    pub(super) from: f64,
    pub(super) shape: OrderPathShape,
}

/// What a vehicle does on a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum OrderPathShape {
    /// A line or an arc, with the angle from the heading to the direction of travel \[rad\].
    Drive(PlacedSegment, f64),
    /// A turn in place of an outline from a pose by an angle \[rad\].
    Turn(StartPose, f64),
}

impl OrderPathSegment {
    /// \[m\]
    pub(super) fn length(&self) -> f64 {
        match self.shape {
            OrderPathShape::Drive(placed, _) => placed.shape.length(),
            OrderPathShape::Turn(_, sweep) => LEVER * sweep.abs(),
        }
    }

    /// Its last pose.
    pub(super) fn end(&self) -> StartPose {
        match self.shape {
            OrderPathShape::Drive(placed, side) => {
                let [x, y] = placed.end();
                StartPose { x, y, heading: placed.heading_at_end() - side }
            }
            OrderPathShape::Turn(from, sweep) => StartPose { heading: from.heading + sweep, ..from },
        }
    }

    /// The pose after a length of it \[m\].
    pub(super) fn pose(&self, along: f64) -> StartPose {
        let shape = match self.shape {
            OrderPathShape::Drive(placed, side) => {
                let shape = match placed.shape {
                    PathSegment::Arc { radius, sweep, .. } => {
                        PathSegment::arc(radius, (along / radius).copysign(sweep))
                    }
                    _ => PathSegment::Line { length: along },
                };
                OrderPathShape::Drive(PlacedSegment { shape, ..placed }, side)
            }
            OrderPathShape::Turn(from, sweep) => OrderPathShape::Turn(from, (along / LEVER).copysign(sweep)),
        };
        Self { shape, ..*self }.end()
    }
}

/// The length along a line or an arc at which it is nearest to a point \[m\].
pub(super) fn along(placed: &PlacedSegment, point: [f64; 2]) -> f64 {
    let [x, y] = [point[0] - placed.start[0], point[1] - placed.start[1]];
    let (sin, cos) = placed.heading.sin_cos();
    let (ahead, left) = (x * cos + y * sin, y * cos - x * sin);
    match placed.shape {
        PathSegment::Line { length } => ahead.clamp(0.0, length),
        PathSegment::Arc { radius, sweep, .. } => {
            // The centre is to the left of an arc that turns left.
            let towards = if sweep < 0.0 { -left } else { left };
            let angle = ahead.atan2(radius - towards).rem_euclid(TAU);
            let whole = sweep.abs();
            // Beyond its end, the nearest point is one of the two ends.
            let angle = if angle <= whole {
                angle
            } else if angle - whole < TAU - angle {
                whole
            } else {
                0.0
            };
            radius * angle
        }
        _ => 0.0,
    }
}
