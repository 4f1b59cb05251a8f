//! The travelled length over time: what the phases of a motion say.
//!
//! A phase goes at constant acceleration through the times and lengths at both its ends, with the speed at the slower one. Before the
//! first one the agent stands at the start of its path, after the last one at its end.

use crate::ball::{Ball, Real};
use crate::data::{Phase, Travel};
use crate::twofold::Twofold;

/// No number of a motion is larger.
const MOST: f64 = 1e15;

/// Motion at constant acceleration.
#[derive(Clone, Copy, Debug)]
pub struct Ramp<R> {
    /// Time at the slow end \[s\].
    pub time: Ball<R>,
    /// Length there \[m\].
    pub length: Ball<R>,
    /// Speed there \[m/s\].
    pub speed: Ball<R>,
    /// Acceleration, in the direction of time \[m/s²\].
    pub acceleration: Ball<R>,
}

impl<R: Real> Ramp<R> {
    /// The same with numbers of another type.
    pub fn of(ramp: &Ramp<Twofold>) -> Self {
        Self {
            time: Ball::of(ramp.time),
            length: Ball::of(ramp.length),
            speed: Ball::of(ramp.speed),
            acceleration: Ball::of(ramp.acceleration),
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

impl Ramp<Twofold> {
    /// Nobody moves.
    pub fn standing(length: Twofold) -> Self {
        let zero = Ball::from(0.0);
        Self { time: zero, length: Ball { mid: length, err: 0.0 }, speed: zero, acceleration: zero }
    }

    /// A phase of a motion that begins at the time `start` \[s\].
    pub fn of_phase(phase: &Phase, start: Twofold) -> Self {
        let number = Ball::<Twofold>::from;
        let slow = usize::from(phase.speed[1] < phase.speed[0]);
        let sign = if slow == 0 { 1.0 } else { -1.0 };
        let duration = number(phase.time[1]) - number(phase.time[0]);
        let way = number(phase.length[1]) - number(phase.length[0]);
        let speed = number(phase.speed[slow]);
        // way = speed · duration + acceleration · duration² / 2
        let gain = if duration.is_positive().is_certain() {
            (way - speed * duration) * number(2.0) / (duration * duration)
        } else {
            number(0.0)
        };
        let time = Ball { mid: start, err: 0.0 } + number(phase.time[slow]);
        Self { time, length: number(phase.length[slow]), speed, acceleration: gain * number(sign) }
    }
}

/// Looks through the phases.
///
/// # Errors
/// What is wrong with them.
pub fn checked(travel: &Travel) -> Result<(), String> {
    let numbers = travel.phases.iter().flat_map(|phase| phase.time.into_iter().chain(phase.length).chain(phase.speed));
    if !numbers.chain([travel.start]).all(|number| number.abs() < MOST) {
        return Err("a number of the motion is out of range".into());
    }
    if ![travel.lag, travel.time_excess].iter().all(|number| (0.0..MOST).contains(number)) {
        return Err("what a motion may be off is out of range".into());
    }
    let mut reached = [0.0, 0.0];
    for phase in &travel.phases {
        let [time, length] = [phase.time, phase.length];
        if time[0] != reached[0] || length[0] != reached[1] || time[1] < time[0] || length[1] < length[0] {
            return Err("a phase does not begin where the one before ends".into());
        }
        if phase.speed.iter().any(|&speed| speed < 0.0) {
            return Err("a speed below 0".into());
        }
        reached = [time[1], length[1]];
    }
    Ok(())
}

/// When the last phase ends, since the start \[s\].
pub fn duration(travel: &Travel) -> f64 {
    travel.phases.last().map_or(0.0, |phase| phase.time[1])
}

/// Between what lengths the agent is at a time \[m\], on a path of this length. Ends of phases are exact, and no length of a phase is
/// beyond them.
pub fn length_at(travel: &Travel, time: Twofold, end: f64) -> [Twofold; 2] {
    let since = time - Twofold::from(travel.start);
    let end = Twofold::from(end);
    let next = travel.phases.partition_point(|phase| Twofold::from(phase.time[1]) <= since);
    let Some(phase) = travel.phases.get(next) else { return [end; 2] };
    let [lo, hi] = phase.length.map(|length| Twofold::from(length).clamp(Twofold::ZERO, end));
    if since <= Twofold::from(phase.time[0]) {
        return [lo; 2];
    }
    let there = Ramp::of_phase(phase, Twofold::from(travel.start)).length_at(Ball { mid: time, err: 0.0 });
    // Twice what it may be off, for the rounding of these two sums. Where nothing is known, it is somewhere in the phase.
    let by = Twofold::from(2.0 * there.err);
    let within = |length: Twofold| length.clamp(lo, hi);
    if there.err.is_finite() { [within(there.mid - by), within(there.mid + by)] } else { [lo, hi] }
}
