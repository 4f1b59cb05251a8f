//! Plans with times: points and the times at which they are reached, with constant speed in between.
//!
//! The speed of such a plan jumps at its points. A profile of constant accelerations changes it within [`RAMP`], before
//! the slower of two sections and after it, so that every point is reached exactly at its time. In between the vehicle
//! is off by at most half of its speed times that, which is nanometres.

use super::ImportError;
use super::path_builder::{LimitedPathBuilder, LimitedSegment};
use crate::scenario::{Agent, LIMIT, MOST_SEGMENTS, MotionSpec, PathSegment};

/// Time in which a speed changes that a plan changes at once \[s\], if that does not take more than half of the acceleration
/// that is allowed or a quarter of the section.
const RAMP: f64 = 1e-9;

/// A point and when it is reached \[m, s\].
pub(super) type TimedPoint = ([f64; 2], f64);

/// The agent that reaches these points at these times. At the same point twice it waits.
pub(super) fn agent(id: u64, radius: f64, stops: &[TimedPoint]) -> Result<Agent, ImportError> {
    let &(first, t_start) = stops.first().ok_or_else(|| ImportError::new("no point at all"))?;
    let mut tracer = LimitedPathBuilder::default();
    let mut sections = Vec::new();
    let mut travelled = 0.0;
    for (k, pair) in stops.windows(2).enumerate() {
        let [(from, begin), (to, end)] = [pair[0], pair[1]];
        let duration = end - begin;
        if duration.is_nan() || duration < 0.0 || (duration == 0.0 && from != to) {
            let problem = format!("point {} is reached at {end} s, from point {} at {begin} s", k + 2, k + 1);
            return Err(ImportError::new(problem));
        }
        tracer.line(from, to);
        // No scenario may have more, and reading on would take long.
        if tracer.count() > MOST_SEGMENTS {
            return Err(ImportError::new(format!("point {}: more than {MOST_SEGMENTS} segments up to here", k + 2)));
        }
        let length = tracer.length() - travelled;
        travelled = tracer.length();
        if duration > 0.0 {
            if length / duration > LIMIT / 1e3 {
                return Err(ImportError::new(format!(
                    "point {} is {length} m away and reached in {duration} s",
                    k + 2
                )));
            }
            sections.push((length, duration));
        }
    }
    let trace = tracer.finish(first);
    // Corners take no time.
    let shape = |stretch: &LimitedSegment| match stretch.shape {
        PathSegment::Turn { sweep } => PathSegment::Kink { sweep },
        other => other,
    };
    let path = trace.stretches.iter().map(shape).collect();
    let motion = sectioned(&sections);
    Ok(Agent { t_start, ..Agent::disc(id, radius + trace.deviation, trace.start, path, motion) })
}

/// The motion over sections of given lengths \[m\] and durations \[s\] above 0, each at a constant speed: it changes within a nanosecond, so
/// that it is off by nanometres there.
pub fn sectioned(sections: &[(f64, f64)]) -> MotionSpec {
    let speed = |k: Option<usize>| k.and_then(|k| sections.get(k)).map_or(0.0, |(length, duration)| length / duration);
    let mut pieces = Vec::new();
    for (k, &(length, duration)) in sections.iter().enumerate() {
        let own = length / duration;
        let [before, after] = [own.min(speed(k.checked_sub(1))), own.min(speed(Some(k + 1)))];
        let ramp = RAMP.max(own / (LIMIT / 2.0)).min(duration / 4.0);
        // (b + p) τ / 2 + p (T - 2 τ) + (p + e) τ / 2 is the length.
        let peak = (length - (before + after) * ramp / 2.0) / (duration - ramp);
        pieces.extend([(ramp, (peak - before) / ramp), (duration - 2.0 * ramp, 0.0), (ramp, (after - peak) / ramp)]);
    }
    MotionSpec::profile(0.0, pieces)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impossible_plans_are_refused() {
        let message = |stops: &[TimedPoint]| agent(1, 0.5, stops).unwrap_err().to_string();
        assert_eq!(message(&[]), "no point at all");
        assert_eq!(message(&[([0.0, 0.0], 1.0), ([1.0, 0.0], 1.0)]), "point 2 is reached at 1 s, from point 1 at 1 s");
        assert_eq!(
            message(&[([0.0, 0.0], 1.0), ([0.0, 0.0], 0.5)]),
            "point 2 is reached at 0.5 s, from point 1 at 1 s"
        );
        assert!(message(&[([0.0, 0.0], 0.0), ([1.0, 0.0], f64::NAN)]).contains("NaN"));
        assert!(message(&[([0.0, 0.0], 0.0), ([1.0, 0.0], 1e-300)]).contains("reached in"));
    }

    #[test]
    fn a_plan_of_too_many_corners_is_refused_before_it_is_read_to_its_end() {
        let corner = |k: u32| ([f64::from(k.div_ceil(2)), f64::from(k / 2)], f64::from(k));
        let stops: Vec<TimedPoint> = (0..2_000_000).map(corner).collect();
        let refused = agent(1, 0.5, &stops).unwrap_err().to_string();
        assert_eq!(refused, "point 32770: more than 65535 segments up to here");
    }

    #[test]
    fn a_speed_above_the_limit_is_refused() {
        let way = |metres: f64| agent(1, 0.5, &[([0.0, 0.0], 0.0), ([metres, 0.0], 0.5)]);
        assert!(way(LIMIT / 2e3).is_ok() && way(1.0).is_ok());
        assert!(way(LIMIT / 2e3 + 1.0).unwrap_err().to_string().contains("reached in 0.5 s"));
    }

    #[test]
    fn speeds_change_in_the_time_of_a_ramp_and_every_point_is_reached_in_time() {
        // Nanoseconds; at a speed of which the acceleration would be too large; and in a section that is shorter than these.
        for (sections, ramps) in [
            (vec![(1.0, 2.0), (3.0, 2.0)], vec![1e-9, 1e-9]),
            (vec![(1e6, 1.0), (1.0, 1.0)], vec![2e6 / LIMIT, 1e-9]),
            (vec![(1e-9, 2e-9), (4e-9, 2e-9), (2e-9, 2e-9)], vec![0.5e-9; 3]),
        ] {
            let (v0, pieces) = sectioned(&sections).pieces(0.0);
            let mut speed = v0;
            for ((&(length, duration), ramp), pieces) in sections.iter().zip(ramps).zip(pieces.chunks(3)) {
                let mut way = 0.0;
                for &(time, acceleration) in pieces {
                    way += (speed + acceleration * time / 2.0) * time;
                    speed += acceleration * time;
                }
                assert!((way / length - 1.0).abs() < 1e-12, "{way} m of {length} m");
                let [up, between, down] = [pieces[0].0, pieces[1].0, pieces[2].0];
                assert_eq!((up, down), (ramp, ramp));
                assert!(((up + between + down) / duration - 1.0).abs() < 1e-12);
            }
            let last = sections.last().map_or(0.0, |(length, duration)| length / duration);
            assert!(speed.abs() < 1e-9 * last, "{speed} m/s at the end");
        }
    }
}
