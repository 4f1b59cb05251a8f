//! The place of a robot on its path, as an interval that certainly contains its progress.
//!
//! A robot has travelled at most as far as its wheels have turned, and never back. A camera whose error is at most a
//! known distance can see it at its measured position only from a part of its path. That part is the stretch that a
//! standing disc with this radius blocks, which the collision regions give.

use super::speed_limited_path::{OwnedMotion, SpeedLimitedPath};
use pcr_core::{Encounter, Interval, Pose, Radians};

/// Distances below this count as this \[m\], because a disc needs a radius.
const FINEST: f64 = 1e-6;

/// The interval after an observation: the interval before \[m\], extended by the way of the wheels since then \[m\], without
/// the parts that are farther than `error` \[m\] from the observed position.
pub(super) fn narrowed(
    before: Interval<f64>,
    way: f64,
    seen: [f64; 2],
    error: f64,
    course: &SpeedLimitedPath,
) -> Interval<f64> {
    let end = course.length();
    let possible = Interval::new(before.lo, (before.hi + way).min(end));
    let within = part_within(seen, error, course);
    let near = within.iter().filter(|part| part.meets(possible)).copied().reduce(Interval::hull);
    // If no part of the path is near enough, the observation is wrong and is ignored.
    near.map_or(possible, |near| Interval::new(possible.lo.max(near.lo), possible.hi.min(near.hi)))
}

/// The lengths of the course within a distance of a point.
fn part_within(point: [f64; 2], distance: f64, course: &SpeedLimitedPath) -> Vec<Interval<f64>> {
    let position = pcr_core::Point::new(point[0], point[1]);
    let probe = SpeedLimitedPath::standing(Pose { position, heading: Radians(0.0) }).ok();
    let probe = probe.and_then(|probe| OwnedMotion::standing(probe, 0.0));
    let ego = OwnedMotion::at_unit_speed(course.clone());
    let radius = (distance / 2.0).max(FINEST);
    let motions = ego.as_ref().and_then(|ego| Some([ego.motion(radius)?, probe.as_ref()?.motion(radius)?]));
    motions.map_or(Vec::new(), |[ego, probe]| {
        Encounter::new(&ego, &probe).blocked_lengths(Interval::new(0.0, 0.0)).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_core::Point;
    use pcr_formats::scenario::PathSegment;

    #[test]
    fn a_robot_is_where_its_wheels_and_the_camera_say() {
        let pose = Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) };
        let course = SpeedLimitedPath::new(pose, &[PathSegment::Line { length: 2.0 }]).expect("a course");
        let start = Interval::new(0.0, 0.0);
        let close = |a: Interval<f64>, lo: f64, hi: f64| (a.lo - lo).abs() < 1e-9 && (a.hi - hi).abs() < 1e-9;
        // Half a metre at most, seen at 0.9 m within 0.5 m: 0.3 m off the path leave 0.4 m.
        assert!(close(narrowed(start, 0.5, [0.9, 0.3], 0.5, &course), 0.5, 0.5));
        assert!(close(narrowed(start, 0.6, [0.9, 0.3], 0.5, &course), 0.5, 0.6));
        assert!(close(narrowed(Interval::new(0.2, 0.4), 0.1, [0.1, 0.0], 0.3, &course), 0.2, 0.4));
        assert!(close(narrowed(Interval::new(1.8, 1.9), 0.5, [1.9, 0.0], 0.3, &course), 1.8, 2.0));
        // An impossible observation is ignored.
        assert!(close(narrowed(start, 0.5, [0.9, 7.0], 0.5, &course), 0.0, 0.5));
    }
}
