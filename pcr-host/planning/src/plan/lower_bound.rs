//! A lower bound for the speed plans of an agent.

use pcr_core::{Limits, SpeedPlanLimits};

/// Bound on the relative rounding error by which the time of a motion may be too short.
pub(super) const ROUNDING: f64 = 1e-9;

/// The least time from one speed to another over a length \[s\]: full acceleration, the largest speed, full deceleration.
pub(super) fn fastest(
    SpeedPlanLimits { limits: Limits { speed, acceleration }, start, goal }: SpeedPlanLimits<f64>,
    length: f64,
) -> f64 {
    let squares = start * start + goal * goal;
    let reached = (squares / 2.0 + acceleration * length).max(0.0).sqrt();
    let peak = reached.min(speed).max(start).max(goal);
    if peak <= 0.0 {
        return 0.0;
    }
    // Without acceleration it goes at one speed.
    let (ramps, ramped) = match acceleration > 0.0 {
        true => ((2.0 * peak - start - goal) / acceleration, (2.0 * peak * peak - squares) / (2.0 * acceleration)),
        false => (0.0, 0.0),
    };
    // Speeds and phases of a plan are rounded.
    (ramps + (length - ramped).max(0.0) / peak) * (1.0 - ROUNDING)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramps_and_cruise_take_what_they_take() {
        let drive =
            |speed, acceleration, start, goal| SpeedPlanLimits { limits: Limits { speed, acceleration }, start, goal };
        for (drive, length, expected) in [
            // 2 s up, 3 s on, 2 s down: 1 + 3 + 1 m.
            (drive(1.0, 0.5, 0.0, 0.0), 5.0, 7.0),
            // Half a metre up and half a metre down.
            (drive(9.0, 1.0, 0.0, 0.0), 1.0, 2.0),
            // In motion at both ends: 1 s up by 1.5 m, 2 m at 2 m/s, 1 s down.
            (drive(2.0, 1.0, 1.0, 1.0), 5.0, 3.0),
            // At one speed.
            (drive(2.0, 0.0, 2.0, 2.0), 5.0, 2.5),
            // It stands.
            (drive(0.0, 0.0, 0.0, 0.0), 0.0, 0.0),
        ] {
            let least = fastest(drive, length);
            assert!((least - expected).abs() < 1e-8 && least <= expected, "{drive:?}: {least} {expected}");
        }
    }
}
