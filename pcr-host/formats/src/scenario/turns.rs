//! Motions with turns in place, before and after which the vehicle is at rest.

use super::round_trip::speed_after;
use super::{Agent, LENGTH_TOLERANCE, MotionPiece, MotionSpec, PathSegment, SegmentPhase};

/// Whether a segment is a turn in place.
fn is_turn(segment: &PathSegment) -> bool {
    matches!(segment, PathSegment::Turn { .. })
}

impl Agent {
    /// Whether its path has a turn in place, or a change of facing: there it stands.
    pub fn turns_in_place(&self) -> bool {
        self.changes_facing() || self.path.iter().any(PathSegment::takes_turning)
    }
}

/// The phases of a turn by an angle from a speed \[rad/s\]: of the first of these pieces, with waits in between.
pub(super) fn phases(pieces: &[MotionPiece], sweep: f64, mut rotation: f64) -> Vec<SegmentPhase> {
    let (mut angle, mut phases) = (0.0, Vec::new());
    for piece in pieces {
        let before = rotation;
        if !piece.in_place && (before > 0.0 || piece.acceleration != 0.0) {
            break;
        }
        let after =
            if piece.in_place { speed_after(before + piece.acceleration * piece.duration, before) } else { 0.0 };
        let way = 0.5 * (before + after) * piece.duration;
        // Another turn may follow without a stop, and what is left of this one may be less than rounding.
        let is_done = angle >= (1.0 - LENGTH_TOLERANCE) * sweep;
        if is_done && (before == 0.0 || angle + way > (1.0 + LENGTH_TOLERANCE) * sweep) {
            break;
        }
        angle += way;
        rotation = after;
        phases.push(SegmentPhase { duration: piece.duration, before, after });
    }
    phases
}

/// From rest to rest in the least time under limits of speed and acceleration, of turns as well.
pub(super) fn pieces(path: &[PathSegment], limits: [f64; 2], turn_limits: [f64; 2]) -> Vec<MotionPiece> {
    let at_most = |[v_max, a_max]: [f64; 2], way| MotionSpec::RestToRest { v_max, a_max }.pieces(way).1.into_iter();
    let mut pieces = Vec::new();
    for run in path.chunk_by(|a, b| !is_turn(a) && !is_turn(b)) {
        if let [PathSegment::Turn { sweep }] = run {
            pieces
                .extend(at_most(turn_limits, sweep.abs()).map(|(duration, accel)| MotionPiece::turn(duration, accel)));
        } else {
            let length = run.iter().map(PathSegment::length).sum();
            pieces.extend(at_most(limits, length).map(|(duration, accel)| MotionPiece::drive(duration, accel)));
        }
    }
    pieces
}
