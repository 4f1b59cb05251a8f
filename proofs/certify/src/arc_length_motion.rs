//! The travelled length over time: what the phases of a motion say.
//!
//! A phase goes at constant acceleration through the times and lengths at both its ends, with the speed at the slower one. Before the
//! first one the agent stands at the start of its path, after the last one at its end.
//!
//! Nobody goes backward. Where rounding has made that speed so large that the agent would pass the other end and come back to it, it
//! arrives there at rest; where it would go farther than rounding explains, the phase is refused.

use crate::ball::{Ball, BallReal};
use crate::double_double::DoubleDouble;
use crate::error::{CertifyError, InputPart};
use crate::raw::{RawAgent, RawMotion, RawPath, RawPhase};

/// No number of a motion is larger.
const MOST: f64 = 1e15;

/// Motion at constant acceleration.
#[derive(Clone, Copy, Debug)]
pub struct BallRamp<R> {
    /// Time at the slow end \[s\].
    pub time: Ball<R>,
    /// Length there \[m\].
    pub length: Ball<R>,
    /// Speed there \[m/s\].
    pub speed: Ball<R>,
    /// Acceleration, in the direction of time \[m/s²\].
    pub acceleration: Ball<R>,
}

impl<R: BallReal> BallRamp<R> {
    /// The same with numbers of another type.
    pub fn convert(ramp: &BallRamp<DoubleDouble>) -> Self {
        Self {
            time: Ball::from_twofold(ramp.time),
            length: Ball::from_twofold(ramp.length),
            speed: Ball::from_twofold(ramp.speed),
            acceleration: Ball::from_twofold(ramp.acceleration),
        }
    }

    /// The length at a time \[m\].
    pub fn length_at(&self, time: Ball<R>) -> Ball<R> {
        let since = time - self.time;
        self.length + (self.speed + (self.acceleration * since).half()) * since
    }

    /// The speed at a time \[m/s\].
    pub fn speed_at(&self, time: Ball<R>) -> Ball<R> {
        self.speed + self.acceleration * (time - self.time)
    }
}

impl BallRamp<DoubleDouble> {
    /// Nobody moves.
    pub fn standing(length: DoubleDouble) -> Self {
        let zero = Ball::from(0.0);
        Self { time: zero, length: Ball { mid: length, err: 0.0 }, speed: zero, acceleration: zero }
    }

    /// A phase of a motion that begins at the time `start` \[s\].
    pub fn of_phase(phase: &RawPhase, start: DoubleDouble) -> Self {
        let number = Ball::<DoubleDouble>::from;
        let slow = usize::from(phase.speed[1] < phase.speed[0]);
        let sign = if slow == 0 { 1.0 } else { -1.0 };
        let duration = number(phase.time[1]) - number(phase.time[0]);
        let way = number(phase.length[1]) - number(phase.length[0]);
        let mut speed = number(phase.speed[slow]);
        let mut gain = number(0.0);
        if duration.is_positive().is_certain() {
            // The speeds at both ends add up to this: no speed is below 0 if this one is not larger.
            let both = way * number(2.0) / duration;
            if !both.above(speed).is_certain() {
                speed = speed.min(both);
            }
            // way = speed · duration + acceleration · duration² / 2
            gain = (way - speed * duration) * number(2.0) / (duration * duration);
        }
        let time = Ball { mid: start, err: 0.0 } + number(phase.time[slow]);
        Self { time, length: number(phase.length[slow]), speed, acceleration: gain * number(sign) }
    }
}

/// Looks through the phases of an agent.
///
/// # Errors
/// What is wrong with them: numbers that are none, a gap, a way backward, a jump.
pub fn checked(agent: &RawAgent) -> Result<(), CertifyError> {
    let Some(travel) = &agent.travel else { return Ok(()) };
    let numbers = travel.phases.iter().flat_map(|phase| phase.time.into_iter().chain(phase.length).chain(phase.speed));
    if !numbers.chain([travel.start]).all(|number| number.abs() < MOST) {
        return Err(CertifyError::OutOfRange("a number of the motion"));
    }
    if ![travel.lag, travel.time_excess].iter().all(|number| (0.0..MOST).contains(number)) {
        return Err(CertifyError::OutOfRange("what a motion may be off"));
    }
    let mut reached = [0.0, 0.0];
    for phase in &travel.phases {
        let [time, length] = [phase.time, phase.length];
        if time[0] != reached[0] || length[0] != reached[1] || time[1] < time[0] || length[1] < length[0] {
            return Err(CertifyError::PhaseGap);
        }
        if phase.speed.iter().any(|&speed| speed < 0.0) {
            return Err(CertifyError::NegativeSpeed);
        }
        goes_on(phase, travel, &agent.path).map_err(CertifyError::of(InputPart::Phase { time, length }))?;
        reached = [time[1], length[1]];
    }
    Ok(())
}

/// Whether a phase can have the speed at its slower end without a way back, and without a jump.
fn goes_on(phase: &RawPhase, travel: &RawMotion, path: &RawPath) -> Result<(), CertifyError> {
    let number = Ball::<DoubleDouble>::from;
    let [time, length] = [phase.time, phase.length];
    let slowest = phase.speed[0].min(phase.speed[1]);
    let (speed, duration) = (number(slowest), number(time[1]) - number(time[0]));
    let way = number(length[1]) - number(length[0]);
    let allowed = rounding(phase, slowest, travel, path);
    if time[0] == time[1] && length[0] < length[1] && !allowed.above(way).is_certain() {
        return Err(CertifyError::Jump);
    }
    // Its speed at the slower end would take it farther, so that it would have to come back.
    if slowest > 0.0 && time[0] < time[1] && !allowed.above(speed * duration - way).is_certain() {
        return Err(CertifyError::TooShortAWay(slowest));
    }
    Ok(())
}

/// By how much the rounding of its numbers may change the way of a phase \[m\]: in floating point 13 u of the length and 7 u of the
/// duration at top speed (`docs/theory/errors.md`, times), of which the rounding of the path is 2 u and the lag 8 u; in fixed point a few last
/// digits of lengths, times and speeds; and always a few of the `f64` that is read.
fn rounding(phase: &RawPhase, speed: f64, travel: &RawMotion, path: &RawPath) -> Ball<DoubleDouble> {
    let number = Ball::<DoubleDouble>::from;
    let [speed, end, length] = [speed, phase.time[1], phase.length[1]].map(number);
    let duration = end - number(phase.time[0]);
    let floating = number(travel.lag) + number(7.0) * number(path.rounding);
    let fixed = number(4.0 * path.step) * (number(1.0) + speed + duration);
    floating + fixed + number(8.0 * f64::EPSILON) * (speed * end + length)
}

/// Whether the phases end where the path does: what an agent misses is part of its lag.
///
/// # Errors
/// Where they end.
pub fn arrives(agent: &RawAgent) -> Result<(), CertifyError> {
    let Some(travel) = &agent.travel else { return Ok(()) };
    let (path, number) = (&agent.path, Ball::<DoubleDouble>::from);
    let [reached, end] = [
        travel.phases.last().map_or(0.0, |phase| phase.length[1]),
        path.segments.last().map_or(0.0, |segment| segment.to),
    ];
    let missed = (number(end) - number(reached)).abs();
    let allowed = number(travel.lag) + number(path.rounding) + number(8.0 * f64::EPSILON) * number(end);
    if reached == end || allowed.above(missed).is_certain() {
        return Ok(());
    }
    Err(CertifyError::Arrival { reached, end })
}

/// When the last phase ends, since the start \[s\].
pub fn duration(travel: &RawMotion) -> f64 {
    travel.phases.last().map_or(0.0, |phase| phase.time[1])
}

/// Between what lengths the agent is at a time \[m\], on a path of this length. Ends of phases are exact, and no length of a phase is
/// beyond them.
pub fn length_at(travel: &RawMotion, time: DoubleDouble, end: f64) -> [DoubleDouble; 2] {
    let since = time - DoubleDouble::from(travel.start);
    let end = DoubleDouble::from(end);
    let next = travel.phases.partition_point(|phase| DoubleDouble::from(phase.time[1]) <= since);
    let Some(phase) = travel.phases.get(next) else { return [end; 2] };
    let [lo, hi] = phase.length.map(|length| DoubleDouble::from(length).clamp(DoubleDouble::ZERO, end));
    if since <= DoubleDouble::from(phase.time[0]) {
        return [lo; 2];
    }
    let there = BallRamp::of_phase(phase, DoubleDouble::from(travel.start)).length_at(Ball { mid: time, err: 0.0 });
    // Twice what it may be off, for the rounding of these two sums. Where nothing is known, it is somewhere in the phase.
    let by = DoubleDouble::from(2.0 * there.err);
    let within = |length: DoubleDouble| length.clamp(lo, hi);
    if there.err.is_finite() { [within(there.mid - by), within(there.mid + by)] } else { [lo, hi] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raw::{RawAngle, RawSegment};

    fn agent(length: f64, phases: &[[[f64; 2]; 3]], step: f64) -> RawAgent {
        let segment = RawSegment { length, radius: None, turns: Vec::new(), from: 0.0, to: length };
        let path =
            RawPath { start: [0.0; 2], heading: RawAngle::Radians(0.0), segments: vec![segment], rounding: 0.0, step };
        let phases = phases.iter().map(|&[time, length, speed]| RawPhase { time, length, speed }).collect();
        RawAgent {
            id: 1,
            radius: 0.25,
            path,
            travel: Some(RawMotion { start: 0.0, phases, lag: 0.0, time_excess: 0.0 }),
        }
    }

    fn refused(phases: &[[[f64; 2]; 3]], why: &str) {
        let found = checked(&agent(4.0, phases, 0.0)).unwrap_err().to_string();
        assert!(found.contains(why), "{found}");
    }

    #[test]
    fn what_goes_back_or_jumps_is_refused() {
        let back = "too short a way";
        refused(&[[[0.0, 10.0], [0.0, 1.0], [5.0, 5.0]]], back);
        refused(&[[[0.0, 4.0], [0.0, 4.0], [1e9, 1e9]]], back);
        // It would be slower at the other end, above 0 or not.
        refused(&[[[0.0, 4.0], [0.0, 4.0], [1.001, 2.0]]], back);
        refused(&[[[0.0, 4.0], [0.0, 4.0], [3.0, 2.5]]], back);
        refused(&[[[0.0, 4.0], [0.0, 0.0], [1e-9, 1e-9]]], back);
        let jump = [[1.0, 1.0], [1.0, 3.0], [1.0, 1.0]];
        refused(&[[[0.0, 1.0], [0.0, 1.0], [1.0, 1.0]], jump, [[1.0, 2.0], [3.0, 4.0], [1.0, 1.0]]], "takes no time");
        refused(&[[[0.0, 0.0], [0.0, 1e-300], [1.0, 1.0]]], "takes no time");
    }

    #[test]
    fn what_is_rounded_passes_and_nobody_goes_back() {
        // A wait, an empty phase, both ramps; in fixed point with last digits of 2^-12 that are off.
        let digit = f64::powi(2.0, -12);
        let exact = [[0.0, 1.0], [0.0, 0.0], [0.0, 0.0]];
        let ramps = [[[1.0, 3.0], [0.0, 1.0], [0.0, 1.0]], [[3.0, 3.0], [1.0, 1.0], [1.0, 1.0]]];
        assert_eq!(checked(&agent(1.0, &[exact, ramps[0], ramps[1]], 0.0)), Ok(()));
        for way in [0.0, 1.0, 2.0] {
            let phase = [[0.0, 3.0 * digit], [0.0, way * digit], [0.75, 0.75]];
            assert_eq!(checked(&agent(1.0, &[phase], digit)), Ok(()));
            assert!(checked(&agent(1.0, &[phase], 0.0)).is_err());
            let [time, length, speed] = phase;
            let ramp = BallRamp::of_phase(&RawPhase { time, length, speed }, DoubleDouble::ZERO);
            for k in 0..=8 {
                let at = Ball::from(time[1] * f64::from(k) / 8.0);
                let (there, fast) = (ramp.length_at(at), ramp.speed_at(at));
                assert!(fast.to_f64() >= -fast.err, "{way} {k}: {fast:?}");
                assert!(
                    there.to_f64() >= -there.err && there.to_f64() <= length[1] + there.err,
                    "{way} {k}: {there:?}"
                );
            }
        }
    }

    #[test]
    fn phases_end_where_the_path_does() {
        let whole = [[0.0, 4.0], [0.0, 4.0], [1.0, 1.0]];
        assert_eq!(arrives(&agent(4.0, &[whole], 0.0)), Ok(()));
        assert_eq!(arrives(&agent(0.0, &[], 0.0)), Ok(()));
        for short in [agent(4.0, &[], 0.0), agent(4.001, &[whole], 0.0), agent(3.999, &[whole], 0.0)] {
            assert!(matches!(arrives(&short), Err(CertifyError::Arrival { .. })));
        }
        let mut late = agent(4.001, &[whole], 0.0);
        late.travel.as_mut().unwrap().lag = 0.001_1;
        assert_eq!(arrives(&late), Ok(()));
    }
}
