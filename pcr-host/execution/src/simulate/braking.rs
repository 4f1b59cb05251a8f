//! Braking in frames: a robot keeps its speed during a frame, and changes it by a bounded step between frames. And fastest motions.

/// The distance to a stop \[m\]: one frame at this speed \[m/s\], then braking as hard as possible in every further frame.
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

/// The largest speed from which the robot can brake to `slow` \[m/s\] within `length` \[m\], starting with the next frame.
pub(super) fn speed_before(length: f64, slow: f64, acceleration: f64, frame: f64) -> f64 {
    // One frame at this speed, then the distance of steady braking, which is longer than that of braking in frames.
    let step = acceleration * frame;
    (step * step + slow * slow + 2.0 * acceleration * length.max(0.0)).sqrt() - step
}

/// A stretch of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SpeedLimitSpan {
    /// \[m\]
    pub(super) length: f64,
    /// Largest speed on it \[m/s\].
    pub(super) top: f64,
}

/// Largest speeds \[m/s\] at the start of each stretch, and at the end, with which a robot can keep the top speeds of all further
/// stretches and stop at the end.
pub(super) fn speeds_to_rest(stretches: &[SpeedLimitSpan], acceleration: f64) -> Vec<f64> {
    let mut speeds = vec![0.0_f64; stretches.len() + 1];
    let mut before = 0.0_f64;
    for (k, stretch) in stretches.iter().enumerate().rev() {
        let previous = k.checked_sub(1).map_or(f64::INFINITY, |previous| stretches[previous].top);
        before = (before * before + 2.0 * acceleration * stretch.length).sqrt().min(stretch.top).min(previous);
        speeds[k] = before;
    }
    speeds
}

/// Pieces (duration \[s\], acceleration \[m/s²\]) of the fastest motion from a speed to rest at the end of some stretches; `None`
/// where it cannot keep to them.
pub(super) fn to_rest(speed: f64, stretches: &[SpeedLimitSpan], acceleration: f64) -> Option<Vec<(f64, f64)>> {
    /// Relative rounding error of the square of a speed.
    const ROUNDING: f64 = 1e-12;
    let most = speeds_to_rest(stretches, acceleration);
    if most[0] * most[0] < speed * speed * (1.0 - ROUNDING) {
        return None;
    }
    let (mut pieces, mut speed) = (Vec::new(), speed);
    for (&SpeedLimitSpan { length, top }, most) in stretches.iter().zip(&most[1..]) {
        let after = most.min((speed * speed + 2.0 * acceleration * length).sqrt());
        let squares = speed * speed + after * after;
        let peak = top.min((squares / 2.0 + acceleration * length).sqrt()).max(speed).max(after);
        let ramps = (2.0 * peak * peak - squares) / (2.0 * acceleration);
        let cruise = if peak > 0.0 { (length - ramps).max(0.0) / peak } else { 0.0 };
        let [faster, slower] = [speed, after].map(|end| (peak - end) / acceleration);
        pieces.extend([(faster, acceleration), (cruise, 0.0), (slower, -acceleration)]);
        speed = after;
    }
    pieces.retain(|(duration, _)| *duration > 0.0);
    Some(pieces)
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
    fn speeds_before_a_slow_stretch_are_low_enough_there() {
        let (acceleration, frame) = (0.4, 1.0 / 30.0);
        for (k, slow) in (0..2000).flat_map(|k| [0.0, 0.05, 0.3].map(|slow| (k, slow))) {
            let length = f64::from(k) * 1e-4;
            let (mut travelled, mut now) = (0.0, speed_before(length, slow, acceleration, frame));
            while now > slow {
                travelled += now * frame;
                now -= acceleration * frame;
            }
            assert!(travelled <= length + 1e-12, "{length}: {travelled}");
        }
    }

    #[test]
    fn motions_to_rest_travel_the_length_within_the_limits() {
        let acceleration = 0.2;
        let stretch = |length, top| SpeedLimitSpan { length, top };
        let one = |length| vec![stretch(length, 0.5)];
        let three = |a, b, c| vec![stretch(a, 0.5), stretch(b, 0.1), stretch(c, 0.4)];
        for (speed, stretches) in [
            (0.0, one(2.0)),
            (0.0, one(0.1)),
            (0.3, one(1.0)),
            (0.5, one(5.0)),
            (0.2, one(0.1)),
            (0.0, one(0.0)),
            (0.0, three(2.0, 1.0, 3.0)),
            (0.5, three(1.0, 0.01, 0.02)),
            (0.2, three(0.08, 0.2, 0.0)),
            (0.0, three(0.0, 1.0, 1.0)),
        ] {
            let pieces = to_rest(speed, &stretches, acceleration).expect("long enough");
            let (mut now, mut travelled) = (speed, 0.0);
            let top = |at: f64| {
                let mut end = 0.0;
                let passed = |stretch: &&SpeedLimitSpan| {
                    end += stretch.length;
                    at > end - 1e-12
                };
                stretches.get(stretches.iter().take_while(passed).count()).map_or(0.0, |stretch| stretch.top)
            };
            for (duration, its) in pieces {
                assert!(duration > 0.0 && its.abs() <= acceleration);
                // A step of many, in the middle of which the speed is in no other stretch.
                for _ in 0..1000 {
                    let step = duration / 1000.0;
                    let middle = now * step / 2.0 + its * step * step / 8.0;
                    assert!(
                        now + its * step / 2.0 <= top(travelled + middle) + 1e-3,
                        "{stretches:?}: {now} at {travelled}"
                    );
                    travelled += now * step + its * step * step / 2.0;
                    now += its * step;
                }
            }
            let length: f64 = stretches.iter().map(|stretch| stretch.length).sum();
            assert!((travelled - length).abs() < 1e-12 && now.abs() < 1e-12, "{stretches:?}: {travelled} {now}");
        }
        assert_eq!(to_rest(0.5, &one(0.6), acceleration), None);
        assert_eq!(to_rest(0.5, &three(0.5, 1.0, 1.0), acceleration), None);
    }
}
