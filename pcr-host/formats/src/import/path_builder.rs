//! Converts lines and arcs anywhere in the plane to one path: a G1 chain of lines and arcs.
//!
//! Where two pieces meet at an angle, the vehicle turns in place, or passes without a stop if the angle is no more than [`KINK`]. Where the vehicle goes on in the other gear, or at another angle to its heading, it comes to rest as
//! well, and turns by what its own heading differs. A line is aimed at its end from the point that the path has really reached, so
//! that gaps do not add up. The largest distance from the requested geometry is recorded.

use super::vehicle::Facing;
use crate::plane_geometry::{distance, within_half_turn, wrapped};
use crate::scenario::{KINK, PathSegment, PlacedSegment};
use std::f64::consts::PI;

/// Length of a line that is left out \[m\]: its direction may be rounding and nothing else.
const NEAR: f64 = 1e-6;

/// Angle that is rounding and nothing else \[rad\].
pub(super) const STRAIGHT: f64 = 1e-9;

/// Deviation that is rounding and nothing else \[m\].
const ROUNDING: f64 = 1e-12;

/// A segment of a path and how fast it may be travelled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LimitedSegment {
    /// Its shape.
    pub(super) shape: PathSegment,
    /// Largest speed \[m/s\], where it is limited.
    pub(super) speed: Option<f64>,
    /// Largest speed of rotation \[rad/s\], where it is limited.
    pub(super) rotation: Option<f64>,
}

impl LimitedSegment {
    /// Whether the vehicle is at rest before and after it.
    pub(super) fn is_stop(&self) -> bool {
        matches!(self.shape, PathSegment::Turn { .. } | PathSegment::Facing { .. })
    }
}

/// How a vehicle faces \[rad\].
#[derive(Clone, Copy, Debug)]
enum Faces {
    /// At an angle from its direction of travel.
    Angle(f64),
    /// At an angle on the map.
    Heading(f64),
}

impl Default for Faces {
    fn default() -> Self {
        Self::Angle(0.0)
    }
}

/// A path in the making.
#[derive(Clone, Debug, Default)]
pub(super) struct LimitedPathBuilder {
    start: Option<[f64; 3]>,
    stretches: Vec<LimitedSegment>,
    /// Of all stretches \[m\].
    length: f64,
    at: [f64; 2],
    /// Direction of travel \[rad\].
    heading: f64,
    /// The angle from the direction of travel to the heading of the vehicle \[rad\], and how it faces in what is added from now on.
    facing: (f64, Faces),
    deviation: f64,
    turned: f64,
    speed: Option<f64>,
    rotation: Option<f64>,
}

/// A path from somewhere, with its limits.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LimitedPath {
    pub(super) start: [f64; 3],
    pub(super) stretches: Vec<LimitedSegment>,
    /// Largest distance from what was asked for \[m\].
    pub(super) deviation: f64,
    /// Largest angle between a heading and the one that was asked for \[rad\].
    pub(super) turned: f64,
    /// Whether it is known which way the vehicle faces where it begins: not if it stands there and nothing more is said.
    pub(super) faces: bool,
}

impl LimitedPathBuilder {
    /// The limits of what is added from now on.
    pub(super) fn limit(&mut self, speed: Option<f64>, rotation: Option<f64>) {
        (self.speed, self.rotation) = (speed, rotation);
    }

    /// The vehicle faces so on what is added from now on; ahead where it is not known.
    pub(super) fn face_as(&mut self, facing: Facing) {
        self.facing.1 = match facing.heading() {
            Some(heading) => Faces::Heading(heading),
            None => Faces::Angle(facing.angle().unwrap_or(0.0)),
        };
    }

    /// Adds a line to a point from where the path is, which ought to be `from`.
    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2]) {
        let begins = self.start.is_none();
        let at = if begins { from } else { self.at };
        self.deviation = self.deviation.max(distance(at, from));
        if distance(at, to) < NEAR {
            self.deviation = self.deviation.max(distance(at, to));
            return;
        }
        let aim = PlacedSegment::line(at, to);
        if distance(from, to) > 0.0 {
            self.turned = self.turned.max(within_half_turn(aim.heading - PlacedSegment::line(from, to).heading).abs());
        }
        self.face(at, aim.heading);
        self.deviation = self.deviation.max(distance(self.at, from));
        self.push(PlacedSegment::line(self.at, to).shape);
        self.deviation = self.deviation.max(distance(self.at, to));
    }

    /// Adds a line or an arc.
    pub(super) fn follow(&mut self, piece: &PlacedSegment) {
        match piece.shape {
            PathSegment::Line { .. } => self.line(piece.start, piece.end()),
            // No curve of a file has one.
            PathSegment::Turn { .. } | PathSegment::Kink { .. } | PathSegment::Facing { .. } => {}
            PathSegment::Arc { radius, sweep, .. } => {
                if radius * sweep == 0.0 {
                    return;
                }
                self.face(piece.start, piece.heading);
                // Displaced as a whole, and turned by what the headings differ.
                let turned = within_half_turn(self.heading - piece.heading).abs() * radius * sweep.abs().min(PI);
                self.deviation = self.deviation.max(distance(self.at, piece.start) + turned);
                let steady = matches!(self.facing.1, Faces::Heading(_));
                self.push(match piece.shape {
                    PathSegment::Arc { radius, sweep, .. } if steady => PathSegment::Arc { radius, sweep, steady },
                    shape => shape,
                });
            }
        }
    }

    /// Turns in place to a heading; the path begins here if it has not begun.
    fn face(&mut self, at: [f64; 2], heading: f64) {
        let after = match self.facing.1 {
            Faces::Angle(angle) => angle,
            Faces::Heading(own) => wrapped(own - heading),
        };
        if self.start.is_none() {
            let own = match self.facing.1 {
                Faces::Heading(own) => own,
                Faces::Angle(_) if after == 0.0 => heading,
                Faces::Angle(_) => wrapped(heading + after),
            };
            (self.at, self.heading) = (at, own);
            self.start = Some([at[0], at[1], own]);
        }
        let before = self.facing.0;
        // Where a heading is kept from one arc to the next, rounding is no change.
        let goes_on = matches!(self.facing.1, Faces::Heading(_)) && within_half_turn(after - before).abs() <= STRAIGHT;
        if before != after && !goes_on {
            self.facing.0 = after;
            self.push(PathSegment::Facing { before, after });
        }
        let sweep = within_half_turn(heading - self.heading);
        if sweep.abs() > KINK {
            self.push(PathSegment::Turn { sweep });
        } else if sweep.abs() > STRAIGHT {
            self.push(PathSegment::Kink { sweep });
        }
    }

    /// Begins here in this heading, and turns in place by an angle.
    pub(super) fn turn(&mut self, at: [f64; 2], heading: f64, sweep: f64) {
        self.face(at, heading);
        if sweep != 0.0 {
            self.push(PathSegment::Turn { sweep });
        }
    }

    fn push(&mut self, shape: PathSegment) {
        let placed = PlacedSegment { start: self.at, heading: self.heading, shape };
        (self.at, self.heading) = (placed.end(), placed.heading_at_end());
        self.facing.0 = shape.facing_after(self.facing.0);
        self.length += shape.length();
        let next = LimitedSegment { shape, speed: self.speed, rotation: self.rotation };
        let last = self.stretches.last_mut().filter(|last| (last.speed, last.rotation) == (next.speed, next.rotation));
        match (last.map(|last| &mut last.shape), shape) {
            // Straight on: one line.
            (Some(PathSegment::Line { length }), PathSegment::Line { length: more }) => *length += more,
            _ => self.stretches.push(next),
        }
    }

    /// Length of what was added \[m\].
    pub(super) fn length(&self) -> f64 {
        self.length
    }

    /// Number of segments that were added.
    pub(super) fn count(&self) -> usize {
        self.stretches.len()
    }

    /// The path, which stands at `at` if nothing was added.
    pub(super) fn finish(self, at: [f64; 2]) -> LimitedPath {
        let start = self.start.unwrap_or([at[0], at[1], 0.0]);
        let deviation = if self.deviation > ROUNDING { self.deviation } else { 0.0 };
        LimitedPath { start, stretches: self.stretches, deviation, turned: self.turned, faces: self.start.is_some() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn corners_are_turns_in_place_that_do_not_add_up() {
        let mut tracer = LimitedPathBuilder::default();
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0], [0.0, 0.0]];
        for side in 0..400 {
            tracer.line(corners[side % 4], corners[side % 4 + 1]);
        }
        let trace = tracer.finish([9.0, 9.0]);
        assert_eq!(trace.start, [0.0, 0.0, 0.0]);
        assert_eq!(trace.deviation, 0.0);
        assert_eq!(trace.stretches.iter().filter(|stretch| stretch.is_stop()).count(), 399);
    }

    #[test]
    fn a_joint_that_is_off_by_a_millimetre_is_closed_and_told() {
        let mut tracer = LimitedPathBuilder::default();
        tracer.follow(&PlacedSegment::line([0.0, 0.0], [5.0, 0.0]));
        let arc = PathSegment::arc(2.0, -FRAC_PI_2);
        tracer.follow(&PlacedSegment { start: [5.001, 0.0], heading: 1e-4, shape: arc });
        let trace = tracer.finish([0.0, 0.0]);
        assert!((trace.deviation - 1e-3).abs() < 1e-8);
        assert_eq!(trace.stretches.len(), 3);
        assert!(trace.stretches.iter().all(|stretch| !stretch.is_stop()));
    }

    #[test]
    fn what_is_left_out_is_told() {
        let deviation = |from: [f64; 2], to: [f64; 2]| {
            let mut tracer = LimitedPathBuilder::default();
            tracer.line([0.0, 0.0], [1.0, 0.0]);
            tracer.line(from, to);
            tracer.finish([0.0, 0.0]).deviation
        };
        // A line that begins, or ends, elsewhere than where the path is, and is no part of it.
        assert_eq!(deviation([1.0, 0.003], [1.0, 0.0]), 0.003);
        assert_eq!(deviation([1.0, 0.0], [1.0, NEAR / 2.0]), NEAR / 2.0);
        assert!((deviation([1.0, 0.003], [2.0, 0.0]) - 0.003).abs() < 1e-9);
        assert_eq!(deviation([1.0, 0.0], [2.0, 0.0]), 0.0);
    }

    #[test]
    fn straight_on_at_the_same_limits_is_one_line() {
        let lines = |limits: [[Option<f64>; 2]; 2]| {
            let mut tracer = LimitedPathBuilder::default();
            for ([speed, rotation], [from, to]) in limits.into_iter().zip([[0.0, 1.0], [1.0, 3.0]]) {
                tracer.limit(speed, rotation);
                tracer.line([from, 0.0], [to, 0.0]);
            }
            let stretches = tracer.finish([0.0, 0.0]).stretches;
            stretches.iter().map(|one| (one.shape.length(), one.speed, one.rotation)).collect::<Vec<_>>()
        };
        assert_eq!(lines([[Some(1.0), None]; 2]), [(3.0, Some(1.0), None)]);
        assert_eq!(lines([[Some(1.0), None], [None; 2]]), [(1.0, Some(1.0), None), (2.0, None, None)]);
        assert_eq!(lines([[None, Some(0.5)], [None; 2]]), [(1.0, None, Some(0.5)), (2.0, None, None)]);
    }

    #[test]
    fn turning_back_is_half_a_turn() {
        let mut tracer = LimitedPathBuilder::default();
        tracer.line([0.0, 0.0], [1.0, 0.0]);
        tracer.line([1.0, 0.0], [0.0, 0.0]);
        let trace = tracer.finish([0.0, 0.0]);
        assert!(matches!(trace.stretches[1].shape, PathSegment::Turn { sweep } if (sweep.abs() - PI).abs() < 1e-12));
    }
}
