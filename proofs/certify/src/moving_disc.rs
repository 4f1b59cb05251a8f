//! An agent in the plane over time, between two times in one phase and on one segment: position, velocity and acceleration, and how
//! far off they may be.
//!
//! Where one phase or segment gives way to the next is rounded to an `f64`; how far an agent may have gone on by then along the wrong
//! one is part of the bound.
//!
//! *Phases.* Rounding keeps the order of times, so that of the phases to which it leaves any time (standing is one) only neighbours meet
//! at a rounded end e. One ends at E, and between E and e its speed is V at most; the next one begins at E' >= E, and has V' at most between
//! E' and e. The phases between them, of a way h, are hidden at e. Let g be the larger one of `|E - e|` and `|E' - e|`. The former says the
//! length at E exactly, and the latter that at E'. Where the latter is asked too early, from e on, it says no more than V' g less, and the
//! agent lags behind the length at E' by h + V g at most; where the former is asked too late, likewise the other way round. So
//!
//! ```text
//! |what either says at a time of its own - where the agent is| <= (V + V') g + h,
//! ```
//!
//! which also is no less than what is left of the way after e. (`docs/theory/certificates.md`, motions.)

use crate::arc_length_motion::{self, BallRamp};
use crate::ball::{Ball, BallReal};
use crate::box_index::{PlainBox, area};
use crate::double_double::DoubleDouble;
use crate::error::CertifyError;
use crate::path::{PreparedSegment, stretches};
use crate::plane::{BallCarrier, BallVector};
use crate::raw::{RawAgent, RawPhase};

/// An agent between two times, in one phase and on one segment.
#[derive(Clone, Debug)]
pub(crate) struct MoverLeg {
    pub(crate) exact: LegMotion<DoubleDouble>,
    pub(crate) near: LegMotion<f64>,
    /// Place of its segment in the path.
    pub(crate) place: usize,
    /// Largest speed \[m/s\].
    pub(crate) speed: f64,
    /// Curvature \[1/m\].
    pub(crate) curvature: f64,
    /// How far the agent may be from where this says \[m\].
    pub(crate) off: f64,
}

/// A carrier, and the length along it over time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LegMotion<R> {
    carrier: BallCarrier<R>,
    pub(crate) ramp: BallRamp<R>,
}

/// Position, velocity and acceleration.
pub(crate) type KinematicState<R> = [BallVector<R>; 3];

impl<R: BallReal> LegMotion<R> {
    fn of(course: &LegMotion<DoubleDouble>) -> Self {
        Self { carrier: BallCarrier::of(course.carrier), ramp: BallRamp::convert(&course.ramp) }
    }

    pub(crate) fn at(&self, time: Ball<R>) -> KinematicState<R> {
        let (length, speed) = (self.ramp.length_at(time), self.ramp.speed_at(time));
        let (place, along) = (self.carrier.point(length), self.carrier.direction(length));
        let straight = along.times(self.ramp.acceleration);
        let acceleration = match self.carrier {
            BallCarrier::Line { .. } => straight,
            BallCarrier::Circle { radius, left, .. } => {
                let inward = if left { along.left() } else { along.left().times(Ball::from(-1.0)) };
                straight + inward.times(speed * speed / radius)
            }
        };
        [place, along.times(speed), acceleration]
    }
}

/// An agent in motion.
#[derive(Clone, Debug)]
pub struct Mover {
    pub(crate) id: u64,
    pub(crate) radius: f64,
    /// Each from its time on \[s\]; the first one from the beginning of time.
    pub(crate) legs: Vec<(f64, MoverLeg)>,
    pub(crate) speed: f64,
    /// How far it may be from where any leg says \[m\].
    pub(crate) position_error: f64,
    /// Around its disc wherever it passes, outward.
    pub(crate) area: PlainBox,
    /// When it is there at all \[s\].
    pub(crate) time: [f64; 2],
    /// From setting off to arrival \[s\].
    pub(crate) moves: [f64; 2],
}

impl Mover {
    /// An agent that is there for so long \[s\].
    ///
    /// # Errors
    /// What is wrong with its path, or that it has no motion.
    pub fn new(agent: &RawAgent, time: [f64; 2]) -> Result<Self, CertifyError> {
        if !(0.0..=1e15).contains(&agent.radius) {
            return Err(CertifyError::ValueOutOfRange("a radius of", agent.radius));
        }
        let stretches = stretches(&agent.path)?;
        let travel = agent.travel.as_ref().ok_or(CertifyError::NoMotion)?;
        let start = DoubleDouble::from(travel.start);
        arc_length_motion::checked(agent)?;
        let stands = |place: usize, stretch: &PreparedSegment, at: DoubleDouble| {
            let course = LegMotion { carrier: stretch.placed.exact, ramp: BallRamp::standing(at) };
            MoverLeg { exact: course, near: LegMotion::of(&course), place, speed: 0.0, curvature: 0.0, off: 0.0 }
        };
        let (Some(first), Some(last)) = (stretches.first(), stretches.last()) else {
            return Err(CertifyError::NoSegments);
        };
        let mut legs = vec![(f64::NEG_INFINITY, stands(0, first, DoubleDouble::ZERO))];
        let mut span = LegSpan { begin: 0, speeds: [0.0; 2], times: [start; 2], rounding_gap: 0.0 };
        let (mut arrival, mut reached, mut hidden, mut all_hidden) = (start, 0.0, 0.0, 0.0);
        for phase in &travel.phases {
            let exact = phase.time.map(|time| start + DoubleDouble::from(time));
            if exact[0].to_f64() < exact[1].to_f64() {
                let begin = legs.len();
                let speeds = add_legs(&mut legs, &stretches, phase, start, exact);
                span = span.then(LegSpan { begin, speeds, times: exact, rounding_gap: 0.0 }, hidden, &mut legs);
                hidden = 0.0;
            } else {
                let way = phase.length[1] - phase.length[0];
                (hidden, all_hidden) = (up(hidden + way), up(all_hidden + way));
            }
            (arrival, reached) = (exact[1], phase.length[1]);
        }
        let end = last.before + last.placed.length;
        let gap = (end - DoubleDouble::from(reached)).abs().to_f64();
        let rest = LegSpan { begin: legs.len(), speeds: [0.0; 2], times: [arrival; 2], rounding_gap: 0.0 };
        legs.push((arrival.to_f64(), stands(stretches.len() - 1, last, last.placed.length)));
        span.then(rest, hidden, &mut legs).close(legs.len(), 0.0, &mut legs);
        // A length beyond the end of the path is none: the agent is at its end.
        legs.iter_mut().for_each(|(_, leg)| leg.off = up(leg.off + gap));
        let speed = legs.iter().map(|(_, leg)| leg.speed).fold(0.0, f64::max);
        // What its speed does not explain: what a leg is off where it is looked at, on the way to another time all that is hidden,
        // and after the last rounded end the rest of the way, which is no more than what the last leg is off.
        let off = up(2.0 * legs.iter().map(|(_, leg)| leg.off).fold(0.0, f64::max) + all_hidden);
        let arrival = arrival.to_f64();
        // Along its path it may be anywhere: how far off that is does not count.
        let area = area(&stretches, (agent.radius + gap).next_up());
        Ok(Self {
            id: agent.id,
            radius: agent.radius,
            legs,
            speed,
            position_error: off,
            area,
            time,
            moves: [travel.start, arrival],
        })
    }

    /// A disc that goes from one point straight to another \[m\] at a speed \[m/s\], from the time 0 on. The last time is rounded up.
    ///
    /// # Errors
    /// Numbers that are out of range.
    pub(crate) fn straight(radius: f64, [from, to]: [[f64; 2]; 2], speed: f64) -> Result<Self, CertifyError> {
        const MOST: f64 = 1e15;
        let numbers = [from[0], from[1], to[0], to[1], radius, speed];
        if !numbers.iter().all(|number| number.abs() <= MOST) || radius < 0.0 || speed <= 0.0 {
            return Err(CertifyError::StraightOutOfRange { radius, ends: [from, to], speed });
        }
        let number = Ball::<DoubleDouble>::from;
        let point = |[x, y]: [f64; 2]| BallVector { x: number(x), y: number(y) };
        let way = point(to) - point(from);
        let length = if from == to { number(0.0) } else { way.norm() };
        let along = if from == to { point([1.0, 0.0]) } else { way.times(number(1.0) / length) };
        let carrier = BallCarrier::Line { start: point(from), along };
        let duration = length / number(speed);
        let duration = if from == to { 0.0 } else { (duration.to_f64() + duration.err).next_up() };
        if duration.is_nan() || duration > MOST {
            return Err(CertifyError::StraightTooLong { ends: [from, to], speed });
        }
        let standing = BallRamp::standing(DoubleDouble::ZERO);
        let leg = |ramp: BallRamp<DoubleDouble>, speed: f64| {
            let exact = LegMotion { carrier, ramp };
            MoverLeg { exact, near: LegMotion::of(&exact), place: 0, speed, curvature: 0.0, off: 0.0 }
        };
        let legs = vec![
            (f64::NEG_INFINITY, leg(standing, 0.0)),
            (0.0, leg(BallRamp { speed: number(speed), ..standing }, speed)),
            (duration, leg(BallRamp { length, ..standing }, 0.0)),
        ];
        let lo = [0, 1].map(|axis| (from[axis].min(to[axis]) - radius).next_down());
        let hi = [0, 1].map(|axis| (from[axis].max(to[axis]) + radius).next_up());
        let (area, moves) = ([lo[0], lo[1], hi[0], hi[1]], [0.0, duration]);
        Ok(Self { id: 0, radius, legs, speed, position_error: 0.0, area, time: moves, moves })
    }

    pub(crate) fn leg(&self, time: f64) -> usize {
        self.legs.partition_point(|(from, _)| *from <= time).saturating_sub(1)
    }
}

fn exact(value: DoubleDouble) -> Ball<DoubleDouble> {
    Ball { mid: value, err: 0.0 }
}

/// A bound on a number that is not negative, whatever a few operations have rounded or lost to underflow: what is no number is not
/// bounded.
fn up(value: f64) -> f64 {
    if value.is_nan() { f64::INFINITY } else { value * (1.0 + 16.0 * f64::EPSILON) + f64::MIN_POSITIVE }
}

/// The legs of a phase to which rounding leaves time, or of standing.
struct LegSpan {
    /// The first one.
    begin: usize,
    /// Largest speeds between the exact times and the rounded ones \[m/s\].
    speeds: [f64; 2],
    /// From when to when, exactly \[s\].
    times: [DoubleDouble; 2],
    /// How far they are off at most where they begin \[m\].
    rounding_gap: f64,
}

impl LegSpan {
    /// The next one, after phases that rounding hides.
    fn then(self, next: Self, hidden: f64, legs: &mut [(f64, MoverLeg)]) -> Self {
        let rounded = DoubleDouble::from(next.times[0].to_f64());
        let apart = [self.times[1], next.times[0]].map(|exact| (exact - rounded).abs().to_f64());
        let lost = up((self.speeds[1] + next.speeds[0]) * apart[0].max(apart[1]) + hidden);
        self.close(next.begin, lost, legs);
        Self { rounding_gap: lost, ..next }
    }

    /// Its legs are off by so much about its end, or by what is lost about its beginning: no time is beyond both.
    fn close(self, until: usize, lost: f64, legs: &mut [(f64, MoverLeg)]) {
        let lost = self.rounding_gap.max(lost);
        legs[self.begin..until].iter_mut().for_each(|(_, leg)| leg.off = up(leg.off + lost));
    }
}

/// The legs of a phase between exact times: one on each segment. Returns the largest speeds between these and the rounded ones.
///
/// A leg goes on along its own carrier where the length is not on its segment, by x at most: then it is off by 2x, as the agent goes
/// as far along another one. The length does not decrease within the phase, so that x is found at both ends of the leg, and at those
/// of the phase where the leg goes on beyond them.
fn add_legs(
    legs: &mut Vec<(f64, MoverLeg)>,
    stretches: &[PreparedSegment],
    phase: &RawPhase,
    start: DoubleDouble,
    times: [DoubleDouble; 2],
) -> [f64; 2] {
    let ramp = BallRamp::of_phase(phase, start);
    let ends = times.map(DoubleDouble::to_f64);
    let [lo, hi] = phase.length;
    let at = |t: f64| ramp.length_at(Ball::from(t));
    // The speed at the other end follows from the rest; it may differ from the one told by rounding.
    let told = phase.time.map(|t| exact(start) + Ball::from(t));
    let speeds = [0, 1].map(|end| {
        let [a, b] = [told[end], Ball::from(ends[end])].map(|t| ramp.speed_at(t).abs());
        up(a.max(b).to_f64() + a.max(b).err)
    });
    let top = speeds[0].max(speeds[1]);
    let mut from = ends[0];
    // Those before it are passed already.
    let begin = stretches.partition_point(|stretch| stretch.before + stretch.placed.length <= DoubleDouble::from(lo));
    for (place, stretch) in stretches.iter().enumerate().skip(begin.min(stretches.len().saturating_sub(1))) {
        let (before, after) = (stretch.before, stretch.before + stretch.placed.length);
        let last = place + 1 == stretches.len();
        if (after <= DoubleDouble::from(lo) && !last)
            || (before >= DoubleDouble::from(hi) && place > 0 && from >= ends[1])
        {
            continue;
        }
        // When it leaves the segment, about: where the length passes its end.
        let to = if last || after >= DoubleDouble::from(hi) { ends[1] } else { crossing(&at, after, [from, ends[1]]) };
        let begins = if DoubleDouble::from(from) <= times[0] { Ball::from(lo) } else { at(from) };
        let leaves = if DoubleDouble::from(to) >= times[1] { Ball::from(hi) } else { at(to) };
        let beyond = |past: Ball<DoubleDouble>| {
            let most = past.to_f64() + past.err;
            if most <= 0.0 { 0.0 } else { up(most) }
        };
        let over = beyond(exact(before) - begins).max(beyond(leaves - exact(after)));
        let own = BallRamp { length: ramp.length - exact(before), ..ramp };
        let course = LegMotion { carrier: stretch.placed.exact, ramp: own };
        let curvature = match course.carrier {
            BallCarrier::Line { .. } => 0.0,
            BallCarrier::Circle { radius, .. } => up(1.0 / radius.to_f64()),
        };
        let leg =
            MoverLeg { exact: course, near: LegMotion::of(&course), place, speed: top, curvature, off: 2.0 * over };
        legs.push((from, leg));
        from = to;
        if from >= ends[1] {
            break;
        }
    }
    speeds
}

/// A time at which a length that does not decrease passes a value, about.
fn crossing(at: &impl Fn(f64) -> Ball<DoubleDouble>, value: DoubleDouble, [mut lo, mut hi]: [f64; 2]) -> f64 {
    for _ in 0..64 {
        let middle = 0.5 * (lo + hi);
        if middle <= lo || middle >= hi {
            break;
        }
        if at(middle).mid < value { lo = middle } else { hi = middle }
    }
    hi
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dice::Dice;
    use crate::raw::{RawAngle, RawMotion, RawPath, RawSegment};

    /// An agent that sets off after 2^33 s, where two times are 2^-19 s apart, on lines and arcs, with phases of all speeds, of which
    /// some are shorter than that.
    fn late(dice: &mut Dice) -> RawAgent {
        let (mut time, mut length, mut phases) = (0.0, 0.0, Vec::new());
        for _ in 0..8 {
            let speed = if dice.unit() < 0.3 { 0.0 } else { (10.0 * dice.unit()).exp2() };
            let lasts = if dice.unit() < 0.5 { dice.unit() } else { dice.unit() * (-19.0 - 3.0 * dice.unit()).exp2() };
            let next = [time + lasts, length + speed * lasts * (1.0 + dice.unit())];
            phases.push(RawPhase { time: [time, next[0]], length: [length, next[1]], speed: [speed; 2] });
            [time, length] = next;
        }
        let (mut from, mut segments) = (0.0, Vec::new());
        let cuts = [dice.unit(), dice.unit(), dice.unit()].map(|part| part * length);
        let ends = phases.iter().map(|phase| phase.length[1]).filter(|_| dice.unit() < 0.5);
        let mut ends: Vec<f64> = ends.chain(cuts).filter(|&end| end < length).collect();
        ends.sort_by(f64::total_cmp);
        for to in ends.into_iter().chain([length]) {
            let radius = if dice.unit() < 0.5 { None } else { Some((to - from).max(1e-3) * (dice.unit() - 0.5)) };
            let radius = radius.map(|radius: f64| (0.2 * (to - from) + radius.abs()).copysign(radius));
            let turns = vec![RawAngle::Radians(7.0 * dice.unit())];
            segments.push(RawSegment { length: to - from, radius: radius.filter(|_| to > from), turns, from, to });
            from = to;
        }
        let path = RawPath { start: [0.0; 2], heading: RawAngle::Turns(0.0), segments, rounding: 1e-9, step: 0.0 };
        let travel = RawMotion { start: 8_589_934_592.0 + dice.unit(), phases, lag: 1e-9, time_excess: 0.0 };
        RawAgent { id: 1, radius: 0.5, path, travel: Some(travel) }
    }

    #[test]
    fn every_leg_is_off_by_no_more_than_it_says() {
        let (mut dice, mut worst) = (Dice(1), 0.0_f64);
        for _ in 0..1000 {
            let agent = late(&mut dice);
            let mover = Mover::new(&agent, [0.0, 1e12]).unwrap();
            let (stretches, travel) = (stretches(&agent.path).unwrap(), agent.travel.as_ref().unwrap());
            let end = stretches.last().map(|last| last.before + last.placed.length).unwrap();
            let there = |time: DoubleDouble| {
                let length = arc_length_motion::length_at(travel, time, end.to_f64())[0].clamp(DoubleDouble::ZERO, end);
                let place = stretches.iter().position(|one| length <= one.before + one.placed.length);
                let stretch = &stretches[place.unwrap_or(stretches.len() - 1)];
                stretch.placed.exact.point(exact(length - stretch.before))
            };
            for (place, (from, leg)) in mover.legs.iter().enumerate() {
                let from = from.max(travel.start - 1.0);
                let to = mover.legs.get(place + 1).map_or(from + 1.0, |next| next.0);
                let digit = from * f64::EPSILON;
                let inside = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5].map(|part| part * digit);
                let times = inside.iter().flat_map(|&by| [(from, by), (to, -by), (from, dice.unit() * (to - from))]);
                for time in times.map(|(end, by)| DoubleDouble::from(end) + DoubleDouble::from(by)) {
                    if time < DoubleDouble::from(from) || DoubleDouble::from(to) < time {
                        continue;
                    }
                    let off = (leg.exact.at(exact(time))[0] - there(time)).norm();
                    assert!(off.to_f64() <= leg.off + 1e-12, "{agent:?} {place} {time:?}: {off:?} {}", leg.off);
                    worst = worst.max(off.to_f64() / (leg.off + 1e-12));
                }
            }
        }
        assert!(worst > 0.5, "{worst}: too good to be measured");
    }
}
