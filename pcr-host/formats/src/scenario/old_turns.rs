//! Turns in place of files before version 3. They were arcs of this radius, and profiles travelled their lengths: 1 nm for each radian.

use super::agent_parts::along;
use super::{LENGTH_TOLERANCE, MotionPiece, PathSegment, SegmentPhase};

/// The radius of such an arc \[m\].
pub(super) const RADIUS: f64 = 1e-9;

/// The length that a segment had in profiles \[m\].
pub(super) fn length(segment: &PathSegment) -> f64 {
    match segment {
        PathSegment::Turn { sweep } => RADIUS * sweep.abs(),
        other => other.length(),
    }
}

/// The pieces of a profile in which turns in place are such; all turns of the path that it passes without a stop become kinks.
pub(super) fn converted(path: &mut [PathSegment], v0: f64, pieces: &[(f64, f64)]) -> Vec<MotionPiece> {
    let lengths: Vec<f64> = path.iter().map(length).collect();
    let performed = performed(path, v0, &along(v0, pieces, &lengths, LENGTH_TOLERANCE));
    for (segment, performed) in path.iter_mut().zip(&performed) {
        if let PathSegment::Turn { sweep } = *segment
            && !performed
        {
            *segment = PathSegment::Kink { sweep };
        }
    }
    if performed.iter().all(|performed| !performed) {
        return pieces.iter().map(|&(duration, acceleration)| MotionPiece::drive(duration, acceleration)).collect();
    }
    // What is between two turns is one length, so that a piece of the profile is not cut there.
    let mut runs = vec![(0.0, false)];
    for (length, performed) in lengths.into_iter().zip(performed) {
        match runs.last_mut() {
            Some((run, false)) if !performed => *run += length,
            _ => runs.push((length, performed)),
        }
    }
    let lengths: Vec<f64> = runs.iter().map(|run| run.0).collect();
    let phases = along(v0, pieces, &lengths, LENGTH_TOLERANCE);
    let piece = |(phase, turns): (&SegmentPhase, bool)| {
        let (duration, acceleration) = (phase.duration, phase.acceleration());
        if turns && phase.moves() {
            MotionPiece::turn(duration, acceleration / RADIUS)
        } else {
            MotionPiece::drive(duration, acceleration)
        }
    };
    runs.iter()
        .zip(&phases)
        .flat_map(|(run, phases)| phases.iter().map(move |phase| (phase, run.1)))
        .map(piece)
        .collect()
}

/// Which segments are turns for which the vehicle stops, before the first of a row of them and after the last.
fn performed(path: &[PathSegment], v0: f64, phases: &[Vec<SegmentPhase>]) -> Vec<bool> {
    let mut performed = vec![false; path.len()];
    let (mut speed, mut row) = (v0, None);
    for (k, (segment, own)) in path.iter().zip(phases).enumerate() {
        if !segment.takes_turning() {
            row = None;
        } else if row.is_none() || speed == 0.0 {
            row = (speed == 0.0).then_some(k);
        }
        speed = own.last().map_or(speed, |phase| phase.after);
        if let Some(first) = row
            && speed == 0.0
        {
            for (performed, own) in performed.iter_mut().zip(phases).take(k + 1).skip(first) {
                *performed = own.iter().any(SegmentPhase::moves);
            }
        }
    }
    performed
}
