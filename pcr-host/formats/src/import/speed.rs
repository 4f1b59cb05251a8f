//! The fastest motion along a path under limits that change from segment to segment.
//!
//! Between the speeds at two joints a segment is travelled with full acceleration, its limit, and full deceleration. The
//! speeds at the joints follow from one pass forward (what can be reached) and one backward (what can be braked
//! from). A turn in place of angle θ(t) is the motion ε θ(t) on its arc of radius ε.

use super::Vehicle;
use super::trace::Stretch;
use crate::scenario::{MotionSpec, PathSegment, TURN};

/// Limits of one segment.
#[derive(Clone, Copy, Debug)]
struct Limited {
    length: f64,
    speed: f64,
    acceleration: f64,
    in_place: bool,
}

fn limited(stretch: &Stretch, vehicle: &Vehicle) -> Limited {
    let length = stretch.shape.length();
    let mut speed = stretch.speed.map_or(vehicle.speed, |limit| limit.min(vehicle.speed));
    let rotation = stretch.rotation.map_or(vehicle.rotation, |limit| limit.min(vehicle.rotation));
    let mut acceleration = vehicle.acceleration;
    if let PathSegment::Arc { radius, .. } = stretch.shape {
        if stretch.in_place {
            speed = radius * rotation;
            acceleration = radius * vehicle.rotation_acceleration;
        } else if radius > TURN {
            speed = speed.min(radius * rotation);
        }
    }
    Limited { length, speed, acceleration, in_place: stretch.in_place }
}

/// The motion from rest to rest in the least time.
pub(super) fn motion(stretches: &[Stretch], vehicle: &Vehicle) -> MotionSpec {
    let limits: Vec<Limited> = stretches.iter().map(|stretch| limited(stretch, vehicle)).collect();
    if limits.iter().all(|limit| !limit.in_place && limit.speed >= vehicle.speed) {
        return MotionSpec::RestToRest { v_max: vehicle.speed, a_max: vehicle.acceleration };
    }
    let mut pieces = Vec::new();
    for (limit, [before, after]) in limits.iter().zip(speeds(&limits)) {
        let a = limit.acceleration;
        let peak = ((before * before + after * after) / 2.0 + a * limit.length).sqrt();
        let peak = peak.min(limit.speed).max(before).max(after);
        let cruise = limit.length - (peak * peak - before * before + (peak * peak - after * after)) / (2.0 * a);
        add(&mut pieces, (peak - before) / a, a);
        add(&mut pieces, cruise.max(0.0) / peak, 0.0);
        add(&mut pieces, (peak - after) / a, -a);
    }
    MotionSpec::Profile { v0: 0.0, pieces }
}

/// Speeds at the beginning and the end of each segment.
fn speeds(limits: &[Limited]) -> Vec<[f64; 2]> {
    let joint = |k: usize| match (k.checked_sub(1).and_then(|before| limits.get(before)), limits.get(k)) {
        (Some(before), Some(after)) if !before.in_place && !after.in_place => before.speed.min(after.speed),
        _ => 0.0,
    };
    let reach = |speed: f64, limit: &Limited| (speed * speed + 2.0 * limit.acceleration * limit.length).sqrt();
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
fn add(pieces: &mut Vec<(f64, f64)>, duration: f64, acceleration: f64) {
    match pieces.last_mut() {
        _ if duration <= 0.0 => {}
        Some((before, same)) if *same == acceleration => *before += duration,
        _ => pieces.push((duration, acceleration)),
    }
}
