//! Bodies in motion: no contact in an interval of time, a contact at a time, and what follows from both: first conflicts, and intervals of
//! contact.
//!
//! While both bodies keep phase and segment, the distance in the direction m that moves with one of them is at least its value in the
//! middle less `|g'| k + ½ max |g''| k²` ([`super::separation`]); whatever they do, it is at least that in the middle less the ways of
//! both. The travelled length over time, and how far it may be off, is that of [`crate::moving_disc`] on a line of the same lengths; times the
//! lever of the body it bounds how far a corner is off.

use super::body::{Body, Carried};
use super::separation::{Change, above, below};
use crate::arc_length_motion::BallRamp;
use crate::ball::{Ball, BallReal, Ternary};
use crate::box_index::BoxIndex;
use crate::double_double::DoubleDouble;
use crate::error::{CertifyError, InputPart};
use crate::motion::{ContactWitness, MotionFindings};
use crate::moving_disc::{Mover, MoverLeg};
use crate::raw::RawAgent;

/// Intervals of one question at most.
const MOST: usize = 1_000_000;

/// A body in motion.
#[derive(Clone, Debug)]
pub struct Driven<'a> {
    pub(super) body: &'a Body<'a>,
    pub(super) mover: Mover,
    /// Bound on the speed of each of its points, for a speed of 1 along the path.
    pub(super) lever: f64,
}

/// What has come of a claim about times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// It holds.
    Proved,
    /// It does not hold at a time.
    Refuted(Moment),
    /// At a time rounding does not tell, or the claim takes too many steps.
    Undecided(Moment),
}

impl Answer {
    /// Whether the claim is proved.
    pub fn is_proved(&self) -> bool {
        *self == Self::Proved
    }

    /// Whether the claim is refuted.
    pub fn is_refuted(&self) -> bool {
        matches!(self, Self::Refuted(_))
    }
}

/// A time, and how near the bodies are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// When \[s\].
    pub time: f64,
    /// Distance of the polygons there less R, that of the least translation that parts them, negative, if they overlap \[m\]; NaN where it is not known.
    pub clearance: f64,
}

impl<'a> Driven<'a> {
    /// A body that is there for so long \[s\]: it stands at the start of its path before it sets off, and at the end after its arrival.
    ///
    /// # Errors
    /// A motion that is none, or that goes back or jumps; no motion.
    pub fn new(body: &'a Body<'a>, time: [f64; 2]) -> Result<Self, CertifyError> {
        let agent = RawAgent {
            id: body.raw.id,
            radius: body.raw.outline.radius,
            path: body.lengths.clone(),
            travel: body.raw.travel.clone(),
        };
        Ok(Self { body, mover: Mover::new(&agent, time)?, lever: body.lever() })
    }

    /// A body under way on a clock of its own, which shows 0 when it sets off, and how long that takes \[s\].
    ///
    /// # Errors
    /// As [`Driven::new`].
    pub(super) fn on_own_clock(body: &'a Body<'a>) -> Result<(Self, f64), CertifyError> {
        let wrong = CertifyError::of(InputPart::Body(body.raw.id, None));
        let mut travel = body.raw.travel.clone().ok_or_else(|| wrong(CertifyError::NoMotion))?;
        travel.start = 0.0;
        let duration = travel.phases.last().map_or(0.0, |last| last.time[1]);
        let (radius, path) = (body.raw.outline.radius, body.lengths.clone());
        let agent = RawAgent { id: body.raw.id, radius, path, travel: Some(travel) };
        Ok((Self { body, mover: Mover::new(&agent, [0.0, duration])?, lever: body.lever() }, duration))
    }
}

/// A type of number that legs are computed in.
pub(super) trait Precision: BallReal {
    fn carried<'b>(body: &'b Body<'_>, place: usize) -> &'b Carried<Self>;
    fn ramp(leg: &MoverLeg) -> &BallRamp<Self>;
}

impl Precision for f64 {
    fn carried<'b>(body: &'b Body<'_>, place: usize) -> &'b Carried<Self> {
        &body.segments[place].near
    }
    fn ramp(leg: &MoverLeg) -> &BallRamp<Self> {
        &leg.near.ramp
    }
}

impl Precision for DoubleDouble {
    fn carried<'b>(body: &'b Body<'_>, place: usize) -> &'b Carried<Self> {
        &body.segments[place].exact
    }
    fn ramp(leg: &MoverLeg) -> &BallRamp<Self> {
        &leg.exact.ramp
    }
}

/// Two bodies in motion.
#[derive(Clone, Copy, Debug)]
pub struct Encounter<'a> {
    bodies: [&'a Driven<'a>; 2],
}

/// What one look at an interval of time shows.
struct Look {
    /// Whether all of it is farther than a bound.
    clear: Ternary,
    /// Whether its middle is within the bound.
    meets: Ternary,
    clearance: f64,
}

impl<'a> Encounter<'a> {
    /// Two bodies in motion.
    pub fn new(first: &'a Driven<'a>, second: &'a Driven<'a>) -> Self {
        Self { bodies: [first, second] }
    }

    /// When both are there \[s\].
    fn common(&self) -> [f64; 2] {
        let [a, b] = self.bodies.map(|body| body.mover.time);
        [a[0].max(b[0]), a[1].min(b[1])]
    }

    /// Decides whether the bodies are farther than R apart at all times of a closed interval \[s\]. Counts the steps.
    pub fn is_clear(&self, [from, to]: [f64; 2], steps: &mut usize) -> Answer {
        let [begin, end] = self.common();
        let (from, to) = (from.max(begin), to.min(end));
        // Before both set off, and after both have arrived, nothing changes.
        let [a, b] = self.bodies.map(|body| body.mover.moves);
        let (first, last) = (a[0].min(b[0]), a[1].max(b[1]));
        let (from, to) = (from.max(first.min(to)), to.min(last.max(from)));
        if from.is_nan() || to.is_nan() {
            return Answer::Undecided(Moment { time: from, clearance: f64::NAN });
        }
        if from > to {
            return Answer::Proved;
        }
        let mut rest = vec![[from, to]];
        let mut taken = 0;
        while let Some([lo, hi]) = rest.pop() {
            (taken, *steps) = (taken + 1, *steps + 1);
            let near = self.look::<f64>([lo, hi], 0.0);
            let seen = match (near.clear, near.meets) {
                (Ternary::Yes, _) => continue,
                (_, Ternary::Doubt) => self.look::<DoubleDouble>([lo, hi], 0.0),
                _ => near,
            };
            if seen.clear.is_certain() {
                continue;
            }
            let moment = Moment { time: middle([lo, hi]), clearance: seen.clearance };
            if seen.meets.is_certain() {
                return Answer::Refuted(moment);
            }
            match self.cut([lo, hi]) {
                Some(cut) if taken < MOST && seen.meets == Ternary::No => rest.extend([[cut, hi], [lo, cut]]),
                _ => return Answer::Undecided(moment),
            }
        }
        Answer::Proved
    }

    /// Decides whether the bodies are within R + `excess` of each other at a time \[s\], and both are there.
    pub fn is_contact(&self, time: f64, excess: f64) -> Answer {
        let [begin, end] = self.common();
        if !(begin <= time && time <= end) {
            return Answer::Refuted(Moment { time, clearance: f64::NAN });
        }
        let mut seen = self.look::<f64>([time, time], excess);
        if !seen.meets.is_certain() && !seen.clear.is_certain() {
            seen = self.look::<DoubleDouble>([time, time], excess);
        }
        let moment = Moment { time, clearance: seen.clearance };
        match (seen.meets, seen.clear) {
            (Ternary::Yes, _) => Answer::Proved,
            (_, Ternary::Yes) => Answer::Refuted(moment),
            _ => Answer::Undecided(moment),
        }
    }

    /// Decides whether a time is that of the first contact since `from` \[s\], or none whether there is no contact until `to`: at all times
    /// up to the number before it the bodies are farther than R apart, and at it within R + `excess`. Counts the steps.
    pub fn is_first_conflict(&self, [from, to]: [f64; 2], told: Option<f64>, excess: f64, steps: &mut usize) -> Answer {
        let Some(time) = told else { return self.is_clear([from, to], steps) };
        match self.is_contact(time, excess) {
            Answer::Proved if from < time => self.is_clear([from, time.next_down()], steps),
            answer => answer,
        }
    }

    /// Decides whether intervals of time, in order, hold all contacts between `from` and `to` \[s\], and each begins and ends within
    /// R + `excess`, but for those that begin or end with the whole. Counts the steps.
    pub fn are_conflicts(&self, [from, to]: [f64; 2], told: &[[f64; 2]], excess: f64, steps: &mut usize) -> Answer {
        let mut at = from;
        let mut begun = false;
        for &[begin, end] in told {
            if !(begin <= end && at <= begin && end <= to) {
                return Answer::Refuted(Moment { time: begin, clearance: f64::NAN });
            }
            for time in [begin, end].into_iter().filter(|time| from < *time && *time < to) {
                match self.is_contact(time, excess) {
                    Answer::Proved => {}
                    other => return other,
                }
            }
            let gap = [if begun { at.next_up() } else { at }, begin.next_down()];
            if gap[0] <= gap[1] {
                match self.is_clear(gap, steps) {
                    Answer::Proved => {}
                    other => return other,
                }
            }
            (at, begun) = (end, true);
        }
        let gap = [if begun { at.next_up() } else { at }, to];
        if gap[0] <= gap[1] { self.is_clear(gap, steps) } else { Answer::Proved }
    }

    /// Where a leg ends, nearest to the middle, or the middle; nowhere, if there is no number in between.
    fn cut(&self, interval: [f64; 2]) -> Option<f64> {
        let inside = |cut: &f64| interval[0] < *cut && *cut < interval[1];
        let middle = middle(interval);
        let ends = self.bodies.iter().flat_map(|body| {
            let after = body.mover.legs.partition_point(|(from, _)| *from < middle);
            body.mover.legs[after.saturating_sub(1)..].iter().take(3).map(|(from, _)| *from)
        });
        let far = |end: f64| (end - middle).abs();
        let nearest = ends.filter(inside).min_by(|a, b| far(*a).total_cmp(&far(*b)));
        nearest.or(Some(middle).filter(inside))
    }

    fn look<R: Precision>(&self, [lo, hi]: [f64; 2], excess: f64) -> Look {
        let number = Ball::<R>::from;
        let time = middle([lo, hi]);
        // No less than the way to either end, whatever was rounded.
        let half = 0.5 * (hi - lo) * (1.0 + 4.0 * f64::EPSILON) + f64::EPSILON * time.abs() + f64::MIN_POSITIVE;
        let half = number(if lo == hi { 0.0 } else { half });
        let movers = self.bodies.map(|body| &body.mover);
        let places = movers.map(|mover| mover.leg(time));
        let legs = [0, 1].map(|k| &movers[k].legs[places[k]].1);
        let carried = [0, 1].map(|k| R::carried(self.bodies[k].body, legs[k].place));
        let at = Ball::from(time);
        let [a, b] = [0, 1].map(|k| carried[k].posture(R::ramp(legs[k]).length_at(at)));
        let speeds = legs.map(|leg| R::ramp(leg).speed_at(at));
        let accelerations = legs.map(|leg| R::ramp(leg).acceleration);
        let seen = below(carried, [&a, &b], &Change::Line { speeds, accelerations, half });
        let [first, second] = self.bodies;
        let radius = Ball::from_twofold(first.body.radius) + Ball::from_twofold(second.body.radius) + number(excess);
        let lever = [number(first.lever), number(second.lever)];
        let off = number(legs[0].off) * lever[0] + number(legs[1].off) * lever[1];
        let most = above([&a, &b]);
        let between = most - radius;
        let clearance = Ball { err: between.err + off.to_f64(), ..between }.display_length();
        let middle_is_clear = seen.middle.above(radius + off);
        let meets = if middle_is_clear.is_certain() {
            Ternary::No
        } else if radius.above(most + off).is_certain() {
            Ternary::Yes
        } else {
            Ternary::Doubt
        };
        // The leg that begins with the end of the interval counts from there on.
        let until = |k: usize| {
            let mover = movers[k];
            mover.legs.get(places[k] + 1).is_none_or(|(next, _)| hi <= *next) && mover.legs[places[k]].0 <= lo
        };
        let clear = if until(0) && until(1) {
            seen.anywhere.above(radius + off)
        } else {
            let bound = |k: usize| {
                lever[k] * (number(movers[k].speed) * half + number(movers[k].position_error))
                    + number(self.bodies[k].body.jumps)
            };
            seen.middle.above(radius + off + bound(0) + bound(1))
        };
        let clear = if clear.is_certain() { Ternary::Yes } else { Ternary::Doubt };
        Look { clear, meets, clearance }
    }
}

fn middle([lo, hi]: [f64; 2]) -> f64 {
    lo + 0.5 * (hi - lo)
}

/// All pairs of bodies with different numbers, at all times: no contact, or where there is one.
pub fn meetings(driven: &[Driven<'_>]) -> MotionFindings {
    let mut found = MotionFindings::default();
    // Along its path a body may be anywhere: how far off that is does not count, but for an end that differs from that of its motion.
    let near = BoxIndex::new(
        driven.iter().map(|one| one.body.area((one.mover.position_error * one.lever).next_up())).collect(),
    );
    for (place, own) in driven.iter().enumerate() {
        let others = &driven[place + 1..];
        found.pairs += others.iter().filter(|other| other.mover.id != own.mover.id).count();
        let close = near.after(place).into_iter().map(|other| &driven[other]);
        for other in close.filter(|other| other.mover.id != own.mover.id) {
            let agents = [own.mover.id, other.mover.id];
            let meeting = |moment: Moment| ContactWitness { agents, time: moment.time, clearance: moment.clearance };
            let always = [f64::NEG_INFINITY, f64::INFINITY];
            match Encounter::new(own, other).is_clear(always, &mut found.steps) {
                Answer::Proved => {}
                Answer::Refuted(moment) => found.contacts.push(meeting(moment)),
                Answer::Undecided(moment) => found.undecided.push(meeting(moment)),
            }
        }
    }
    found
}
