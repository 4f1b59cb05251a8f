//! The fastest motion along a path under limits that change from segment to segment.
//!
//! Between the speeds at two joints, a segment is travelled with full acceleration, at its speed limit, and with full
//! deceleration. The speeds at the joints follow from a forward pass (which speeds can be reached) and a backward pass
//! (from which speeds the vehicle can brake). A turn in place is one in radians. Before and after it, and at a change of gear, the vehicle is
//! at rest.

use super::VehicleTraits;
use super::path_builder::LimitedSegment;
use crate::scenario::{MotionPiece, MotionSpec, PathSegment};

/// Limits of one segment: in metres, of a turn in place in radians.
#[derive(Clone, Copy, Debug)]
struct SegmentLimits {
    length: f64,
    speed: f64,
    acceleration: f64,
    is_turn: bool,
    is_stop: bool,
}

fn limited(stretch: &LimitedSegment, vehicle: &VehicleTraits) -> SegmentLimits {
    let mut length = stretch.shape.length();
    let mut speed = stretch.speed.map_or(vehicle.speed, |limit| limit.min(vehicle.speed));
    let rotation = stretch.rotation.map_or(vehicle.rotation, |limit| limit.min(vehicle.rotation));
    let mut acceleration = vehicle.acceleration;
    let is_turn = match stretch.shape {
        PathSegment::Turn { sweep } => {
            (length, speed, acceleration) = (sweep.abs(), rotation, vehicle.rotation_acceleration);
            true
        }
        PathSegment::Arc { radius, steady: false, .. } => {
            speed = speed.min(radius * rotation);
            false
        }
        _ => false,
    };
    SegmentLimits { length, speed, acceleration, is_turn, is_stop: stretch.is_stop() }
}

/// The motion from rest to rest in the least time.
pub(super) fn motion(stretches: &[LimitedSegment], vehicle: &VehicleTraits) -> MotionSpec {
    let limits: Vec<SegmentLimits> = stretches.iter().map(|stretch| limited(stretch, vehicle)).collect();
    if limits.iter().all(|limit| !limit.is_stop && limit.speed >= vehicle.speed) {
        return MotionSpec::RestToRest { v_max: vehicle.speed, a_max: vehicle.acceleration };
    }
    let mut pieces = Vec::new();
    // A kink or a change of gear has no length and takes no time.
    for (limit, [before, after]) in limits.iter().zip(speeds(&limits)).filter(|(limit, _)| limit.length > 0.0) {
        let a = limit.acceleration;
        let peak = ((before * before + after * after) / 2.0 + a * limit.length).sqrt();
        let peak = peak.min(limit.speed).max(before).max(after);
        let cruise = limit.length - (peak * peak - before * before + (peak * peak - after * after)) / (2.0 * a);
        let phases = [((peak - before) / a, a), (cruise.max(0.0) / peak, 0.0), ((peak - after) / a, -a)];
        for (duration, acceleration) in phases {
            add(&mut pieces, MotionPiece { duration, acceleration, in_place: limit.is_turn });
        }
    }
    MotionSpec::Profile { v0: 0.0, pieces }
}

/// Speeds at the beginning and the end of each segment.
fn speeds(limits: &[SegmentLimits]) -> Vec<[f64; 2]> {
    let joint = |k: usize| match (k.checked_sub(1).and_then(|before| limits.get(before)), limits.get(k)) {
        (Some(before), Some(after)) if !before.is_stop && !after.is_stop => before.speed.min(after.speed),
        _ => 0.0,
    };
    let reach = |speed: f64, limit: &SegmentLimits| (speed * speed + 2.0 * limit.acceleration * limit.length).sqrt();
    let mut joints: Vec<f64> = (0..=limits.len()).map(joint).collect();
    for (k, limit) in limits.iter().enumerate() {
        joints[k + 1] = joints[k + 1].min(reach(joints[k], limit));
    }
    for (k, limit) in limits.iter().enumerate().rev() {
        joints[k] = joints[k].min(reach(joints[k + 1], limit));
    }
    joints.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// Adds a piece of a profile; one that lasts no time is left out, one that goes on like the one before it is joined to it.
fn add(pieces: &mut Vec<MotionPiece>, piece: MotionPiece) {
    match pieces.last_mut() {
        _ if piece.duration <= 0.0 => {}
        Some(last) if (last.acceleration, last.in_place) == (piece.acceleration, piece.in_place) => {
            last.duration += piece.duration;
        }
        _ => pieces.push(piece),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VEHICLE: VehicleTraits = VehicleTraits {
        name: None,
        radius: 0.4,
        footprint: None,
        size: super::super::SizeSource::Option,
        margin: 0.0,
        speed: 2.0,
        acceleration: 0.5,
        rotation: 1.0,
        rotation_acceleration: 0.25,
    };

    fn stretch(shape: PathSegment, speed: Option<f64>, rotation: Option<f64>) -> LimitedSegment {
        LimitedSegment { shape, speed, rotation }
    }

    fn line(speed: Option<f64>) -> LimitedSegment {
        stretch(PathSegment::Line { length: 8.0 }, speed, None)
    }

    fn turn(rotation: Option<f64>) -> LimitedSegment {
        stretch(PathSegment::Turn { sweep: 1.0 }, None, rotation)
    }

    #[test]
    fn the_smaller_of_two_limits_counts() {
        let bend = |speed, rotation| limited(&stretch(PathSegment::arc(1.5, 1.0), speed, rotation), &VEHICLE).speed;
        assert_eq!([bend(None, None), bend(None, Some(0.5)), bend(None, Some(3.0))], [1.5, 0.75, 1.5]);
        assert_eq!([bend(Some(0.25), Some(3.0)), bend(Some(9.0), Some(0.5))], [0.25, 0.75]);
        let speed = |rotation| limited(&turn(rotation), &VEHICLE).speed;
        assert_eq!([speed(None), speed(Some(0.5)), speed(Some(3.0))], [1.0, 0.5, 1.0]);
    }

    #[test]
    fn only_a_path_without_limits_of_its_own_is_from_rest_to_rest() {
        let whole = MotionSpec::RestToRest { v_max: 2.0, a_max: 0.5 };
        for free in [vec![], vec![line(None)], vec![line(None), line(Some(2.0))], vec![line(Some(3.0))]] {
            assert_eq!(motion(&free, &VEHICLE), whole);
        }
        // A vehicle that drives as it turns in place.
        let slow = VehicleTraits { speed: 1.0, acceleration: 0.25, ..VEHICLE };
        let limits = |stretches: &[LimitedSegment]| -> bool { motion(stretches, &VEHICLE) != whole };
        assert!(limits(&[line(None), line(Some(1.5))]) && limits(&[line(None), turn(None)]));
        assert!(matches!(motion(&[turn(None)], &slow), MotionSpec::Profile { .. }));
    }

    #[test]
    fn before_and_after_a_turn_in_place_the_vehicle_is_at_rest() {
        let limits: Vec<SegmentLimits> =
            [line(None), turn(None), line(Some(1.0)), line(None)].iter().map(|one| limited(one, &VEHICLE)).collect();
        assert_eq!(speeds(&limits), [[0.0, 0.0], [0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]);
    }
}
