//! Braking in frames: a robot keeps its speed during a frame, and changes it by a bounded step between frames.

use pcr_core::Limits;

/// The way from now to a stop \[m\]: this speed \[m/s\] in the frame that begins, then as much less as is possible in
/// every further one.
pub(super) fn stopping_length(speed: f64, acceleration: f64, frame: f64) -> f64 {
    let step = acceleration * frame;
    let frames = (speed / step).floor();
    frame * ((frames + 1.0) * speed - step * frames * (frames + 1.0) / 2.0)
}

/// The largest speed whose [`stopping_length`] is not above `length` \[m\]: its inverse.
pub(super) fn speed_within(length: f64, acceleration: f64, frame: f64) -> f64 {
    let step = acceleration * frame;
    let length = length.max(0.0);
    let frames = ((1.0 + 8.0 * length / (step * frame)).sqrt() / 2.0 - 0.5).floor().max(0.0);
    (length / frame + step * frames * (frames + 1.0) / 2.0) / (frames + 1.0)
}

/// Pieces (duration \[s\], acceleration \[m/s²\]) of the fastest motion from a speed to rest after `length` \[m\]; `None`
/// where it cannot stop there.
pub(super) fn to_rest(speed: f64, length: f64, limits: Limits<f64>) -> Option<Vec<(f64, f64)>> {
    /// Of the way to stop, what rounding may add to it.
    const ROUNDING: f64 = 1e-12;
    let Limits { speed: top, acceleration } = limits;
    if length < speed * speed / (2.0 * acceleration) * (1.0 - ROUNDING) {
        return None;
    }
    let peak = top.min((speed * speed / 2.0 + acceleration * length).sqrt()).max(speed);
    let ramps = (2.0 * peak * peak - speed * speed) / (2.0 * acceleration);
    let cruise = if peak > 0.0 { (length - ramps).max(0.0) / peak } else { 0.0 };
    let pieces = [((peak - speed) / acceleration, acceleration), (cruise, 0.0), (peak / acceleration, -acceleration)];
    Some(pieces.into_iter().filter(|(duration, _)| *duration > 0.0).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_speed_stops_within_the_length() {
        let (acceleration, frame) = (0.4, 1.0 / 30.0);
        for k in 0..2000 {
            let length = f64::from(k) * 1e-4;
            let speed = speed_within(length, acceleration, frame);
            // Braking frame by frame is the definition.
            let (mut travelled, mut now) = (0.0, speed);
            while now > 0.0 {
                travelled += now * frame;
                now -= acceleration * frame;
            }
            assert!((travelled - length).abs() < 1e-12, "{length}: {travelled}");
            assert!((stopping_length(speed, acceleration, frame) - length).abs() < 1e-12, "{length}");
        }
    }

    #[test]
    fn motions_to_rest_travel_the_length_within_the_limits() {
        let limits = Limits { speed: 0.5, acceleration: 0.2 };
        for (speed, length) in [(0.0, 2.0), (0.0, 0.1), (0.3, 1.0), (0.5, 5.0), (0.2, 0.1), (0.0, 0.0)] {
            let pieces = to_rest(speed, length, limits).expect("long enough");
            let (mut now, mut travelled, mut top) = (speed, 0.0, speed);
            for (duration, acceleration) in pieces {
                assert!(duration > 0.0 && acceleration.abs() <= limits.acceleration);
                travelled += now * duration + acceleration * duration * duration / 2.0;
                now += acceleration * duration;
                top = top.max(now);
            }
            assert!((travelled - length).abs() < 1e-12 && now.abs() < 1e-12 && top <= limits.speed + 1e-12);
        }
        assert_eq!(to_rest(0.5, 0.6, limits), None);
    }
}
