//! An agent in the plane over time, between two times in one phase and on one segment: position, velocity and acceleration, and how
//! far off they may be.
//!
//! Where one phase or segment gives way to the next is rounded to an `f64`; how far an agent may have gone on by then along the wrong
//! one is part of the bound.

use crate::ball::{Ball, Real};
use crate::data::{Agent, Phase};
use crate::near::{Area, area};
use crate::path::{Stretch, stretches};
use crate::plane::{Carrier, Vector};
use crate::travel::{self, Ramp};
use crate::twofold::Twofold;

/// An agent between two times, in one phase and on one segment.
#[derive(Clone, Debug)]
pub(crate) struct Leg {
    pub(crate) exact: Course<Twofold>,
    pub(crate) near: Course<f64>,
    /// Largest speed \[m/s\].
    pub(crate) speed: f64,
    /// Curvature \[1/m\].
    pub(crate) curvature: f64,
    /// How far the agent may be from where this says \[m\].
    pub(crate) off: f64,
}

/// A carrier, and the length along it over time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Course<R> {
    carrier: Carrier<R>,
    pub(crate) ramp: Ramp<R>,
}

/// Position, velocity and acceleration.
pub(crate) type State<R> = [Vector<R>; 3];

impl<R: Real> Course<R> {
    fn of(course: &Course<Twofold>) -> Self {
        Self { carrier: Carrier::of(course.carrier), ramp: Ramp::of(&course.ramp) }
    }

    pub(crate) fn at(&self, time: Ball<R>) -> State<R> {
        let (length, speed) = (self.ramp.length_at(time), self.ramp.speed_at(time));
        let (place, along) = (self.carrier.point(length), self.carrier.direction(length));
        let straight = along.times(self.ramp.acceleration);
        let acceleration = match self.carrier {
            Carrier::Line { .. } => straight,
            Carrier::Circle { radius, left, .. } => {
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
    pub(crate) legs: Vec<(f64, Leg)>,
    pub(crate) speed: f64,
    /// How far it may be from where any leg says \[m\].
    pub(crate) off: f64,
    /// Around its disc wherever it passes, outward.
    pub(crate) area: Area,
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
    pub fn new(agent: &Agent, time: [f64; 2]) -> Result<Self, String> {
        if !(0.0..=1e15).contains(&agent.radius) {
            return Err(format!("a radius of {} is out of range", agent.radius));
        }
        let stretches = stretches(&agent.path)?;
        let travel = agent.travel.as_ref().ok_or("no motion")?;
        let start = Twofold::from(travel.start);
        travel::checked(agent)?;
        let mut legs: Vec<(f64, Leg)> = Vec::new();
        let stands = |stretch: &Stretch, at: Twofold| {
            let course = Course { carrier: stretch.placed.exact, ramp: Ramp::standing(at) };
            Leg { exact: course, near: Course::of(&course), speed: 0.0, curvature: 0.0, off: 0.0 }
        };
        let (Some(first), Some(last)) = (stretches.first(), stretches.last()) else { return Err("no segments".into()) };
        legs.push((f64::NEG_INFINITY, stands(first, Twofold::ZERO)));
        let (mut arrival, mut reached, mut jumps) = (travel.start, 0.0, 0.0);
        for phase in &travel.phases {
            let time = phase.time;
            reached = phase.length[1];
            let ends = time.map(|time| (start + Twofold::from(time)).to_f64());
            if time[0] < time[1] {
                add_legs(&mut legs, &stretches, phase, start, ends);
            } else {
                jumps += phase.length[1] - phase.length[0];
            }
            arrival = ends[1];
        }
        let end = last.before + last.placed.length;
        let gap = (end - Twofold::from(reached)).abs().to_f64();
        legs.push((arrival, stands(last, last.placed.length)));
        // A length beyond the end of the path is none: the agent is at its end. What takes no time is rounded off.
        let gone = (gap + jumps) * (1.0 + 4.0 * f64::EPSILON);
        legs.iter_mut().for_each(|(_, leg)| leg.off += gone);
        let speed = legs.iter().map(|(_, leg)| leg.speed).fold(0.0, f64::max);
        let off = legs.iter().map(|(_, leg)| leg.off).fold(0.0, f64::max);
        let area = area(&stretches, (agent.radius + off).next_up());
        Ok(Self { id: agent.id, radius: agent.radius, legs, speed, off, area, time, moves: [travel.start, arrival] })
    }

    pub(crate) fn leg(&self, time: f64) -> usize {
        self.legs.partition_point(|(from, _)| *from <= time).saturating_sub(1)
    }
}

fn exact(value: Twofold) -> Ball<Twofold> {
    Ball { mid: value, err: 0.0 }
}

/// The legs of a phase: one on each segment.
fn add_legs(legs: &mut Vec<(f64, Leg)>, stretches: &[Stretch], phase: &Phase, start: Twofold, ends: [f64; 2]) {
    let ramp = Ramp::of_phase(phase, start);
    let [lo, hi] = phase.length;
    let at = |t: f64| ramp.length_at(Ball::from(t));
    // The speed at the other end follows from the rest; it may differ from the one told by rounding.
    let told = phase.time.map(|t| exact(start) + Ball::from(t));
    let [a, b, c, d] =
        [told[0], told[1], Ball::from(ends[0]), Ball::from(ends[1])].map(|t: Ball<Twofold>| ramp.speed_at(t).abs());
    let top = a.max(b).max(c.max(d));
    let top = (top.to_f64() + top.err) * (1.0 + f64::EPSILON);
    let mut from = ends[0];
    // Those before it are passed already.
    let begin = stretches.partition_point(|stretch| stretch.before + stretch.placed.length <= Twofold::from(lo));
    for (place, stretch) in stretches.iter().enumerate().skip(begin.min(stretches.len().saturating_sub(1))) {
        let (before, after) = (stretch.before, stretch.before + stretch.placed.length);
        let last = place + 1 == stretches.len();
        if (after <= Twofold::from(lo) && !last) || (before >= Twofold::from(hi) && place > 0 && from >= ends[1]) {
            continue;
        }
        // When it leaves the segment, about: where the length passes its end.
        let to = if last || after >= Twofold::from(hi) { ends[1] } else { crossing(&at, after, [from, ends[1]]) };
        let beyond = |past: Ball<Twofold>| (past.to_f64() + past.err).max(0.0);
        let over = beyond(exact(before) - at(from)).max(beyond(at(to) - exact(after)));
        let early = beyond(Ball::from(phase.time[0]) + exact(start) - Ball::from(from));
        let late = beyond(Ball::from(to) - exact(start) - Ball::from(phase.time[1]));
        let own = Ramp { length: ramp.length - exact(before), ..ramp };
        let course = Course { carrier: stretch.placed.exact, ramp: own };
        let curvature = match course.carrier {
            Carrier::Line { .. } => 0.0,
            Carrier::Circle { radius, .. } => (1.0 / radius.to_f64()) * (1.0 + f64::EPSILON),
        };
        let off = 2.0 * over + 2.0 * top * (early.max(late));
        legs.push((from, Leg { exact: course, near: Course::of(&course), speed: top, curvature, off }));
        from = to;
        if from >= ends[1] {
            break;
        }
    }
}

/// A time at which a length that does not decrease passes a value, about.
fn crossing(at: &impl Fn(f64) -> Ball<Twofold>, value: Twofold, [mut lo, mut hi]: [f64; 2]) -> f64 {
    for _ in 0..64 {
        let middle = 0.5 * (lo + hi);
        if middle <= lo || middle >= hi {
            break;
        }
        if at(middle).mid < value { lo = middle } else { hi = middle }
    }
    hi
}
