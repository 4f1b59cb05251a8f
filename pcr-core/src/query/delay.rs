//! Start delays: by how much an agent has to start later so that it meets no region.
//!
//! The ego sets off later by τ and stands at its start until then. A point (l, s) of coordination space is met at a
//! delay of T_other(s) - T_ego(l); the image of a connected region is connected, hence every region forbids one
//! interval of delays, whatever the profiles. It reaches to infinity where the ego is met standing at its start (later
//! does not help), or the other standing at its end; and from minus infinity likewise. A finite end is bracketed: what
//! the box of the region allows lies outside, a delay with a contact inside (`bracket`). The outer end is taken, at which
//! there was none. Where agents may be late, the interval is longer by as much.

use crate::error::in_range;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::query::bracket::Bracket;
use crate::query::contact::Encounter;
use crate::query::safe::times;
use crate::region::RegionRef;
use crate::scalar::Scalar;

impl<S: Scalar> RegionRef<'_, S> {
    /// The delays of the ego's start \[s\] at which it meets this region, rounded outward; negative ones are earlier
    /// starts. An end of magnitude [`Scalar::LIMIT`] stands for infinity. With agents that may be late
    /// ([`Motion::with_lateness`]) these are the delays at which they may meet.
    ///
    /// The ends are right within [`Scalar::tolerance`] of the latest time, and what [`Encounter::tolerance`] of distance
    /// makes of them; a region in which the discs only touch may forbid all that its ranges allow. Cost: for each finite end
    /// 10 to 30 searches for contacts.
    pub fn forbidden_delays(&self) -> Interval<S> {
        let possible = self.possible_delays();
        let met = self.delays_inside().find(|&delay| possible.contains(delay) && self.contact_after(delay).is_some());
        let ends = [possible.lo, possible.hi].map(|beyond| met.map_or(beyond, |met| self.end_of_delays(met, beyond)));
        self.with_lateness(Interval::new(ends[0], ends[1]))
    }

    /// The delays of the ego's start \[s\] at which it meets this region while both are under way, rounded outward: what either
    /// does before its start and after its arrival does not count, as if they came from nowhere and were gone then. For tables of
    /// the edges of a roadmap.
    ///
    /// Accuracy, lateness and cost as of [`RegionRef::forbidden_delays`].
    pub fn passing_delays(&self) -> Interval<S> {
        let possible = self.delays_of(self.ego_motion().time_in(self.length()));
        let meets = |delay| self.contact_in_passing(delay);
        let met = self.delays_inside().find(|&delay| possible.contains(delay) && meets(delay).is_some());
        let end = |outside| {
            let bracket = |inside| Bracket { inside, outside, resolution: self.resolution() };
            met.map_or(outside, |met| bracket(met).shrunk(meets))
        };
        self.with_lateness(Interval::new(end(possible.lo), end(possible.hi)))
    }

    /// Delays that bring the agents to points inside the region.
    fn delays_inside(&self) -> impl Iterator<Item = S> {
        let when = |motion: &Motion<'_, S>, length| motion.time_in(Interval::new(length, length)).lo;
        let points = self.inner_points();
        points.map(move |[length, other_length]| {
            when(self.other_motion(), other_length) - when(self.ego_motion(), length)
        })
    }

    /// The delays that the ranges of the region allow.
    fn possible_delays(&self) -> Interval<S> {
        let length = self.length();
        let Interval { lo, hi } = self.delays_of(self.ego_motion().time_in(length));
        let never = length.hi >= self.ego_motion().path().length() || self.is_open_at_start();
        let ever = length.lo <= S::ZERO || self.is_open_at_end();
        Interval::new(if never { -S::LIMIT } else { lo }, if ever { S::LIMIT } else { hi })
    }

    /// The delays that bring what the ego does at these times \[s\] to those at which the other is in the region.
    pub(super) fn delays_of(&self, own: Interval<S>) -> Interval<S> {
        let their = self.time();
        // Differences of times have a rounding of their own.
        let slack = self.resolution();
        Interval::new(their.lo - own.hi - slack, their.hi - own.lo + slack)
    }

    /// Longer by how late the agents may be.
    pub(super) fn with_lateness(&self, delays: Interval<S>) -> Interval<S> {
        let (own, their) = (self.ego_motion().lateness(), self.other_motion().lateness());
        let lo = if delays.lo > -S::LIMIT { delays.lo - own } else { delays.lo };
        Interval::new(lo, if delays.hi < S::LIMIT { delays.hi + their } else { delays.hi })
    }

    /// Whether either agent may be late.
    pub(crate) fn is_uncertain(&self) -> bool {
        self.ego_motion().lateness() > S::ZERO || self.other_motion().lateness() > S::ZERO
    }

    /// Brackets are not narrower than this \[s\].
    pub(super) fn resolution(&self) -> S {
        let latest = |interval: Interval<S>| interval.lo.abs().max(interval.hi.abs());
        S::tolerance(latest(self.ego_motion().time()).max(latest(self.other_motion().time())))
    }

    /// The end of the forbidden delays between one that is forbidden and one that is beyond it.
    fn end_of_delays(&self, inside: S, outside: S) -> S {
        if outside.abs() >= S::LIMIT {
            return outside;
        }
        Bracket { inside, outside, resolution: self.resolution() }.shrunk(|delay| self.contact_after(delay))
    }

    /// How long the ego meets the region if it starts later by this delay, if it does.
    fn contact_after(&self, delay: S) -> Option<S> {
        // A start that the format does not hold is none to recommend.
        self.ego_motion().delayed(delay).map_or(Some(S::ZERO), |ego| self.contact_of(&ego, self.length(), -S::LIMIT))
    }

    /// How long the ego meets the region while both are under way if it starts later by this delay, if it does.
    fn contact_in_passing(&self, delay: S) -> Option<S> {
        let Ok(ego) = self.ego_motion().delayed(delay) else { return Some(S::ZERO) };
        let under_way = ego.time().common(self.other_motion().time());
        if under_way.lo > under_way.hi {
            return None;
        }
        self.contact_during(&ego, self.length(), under_way)
    }

    /// How long the ego, in another motion along its path, first meets the region on a part of it from a time on \[s\], if
    /// it does.
    pub(super) fn contact_of(&self, ego: &Motion<'_, S>, part: Interval<S>, from: S) -> Option<S> {
        let Interval { lo, hi } = ego.time().hull(self.other_motion().time());
        self.contact_during(ego, part, Interval::new(lo.max(from), hi))
    }

    /// The same in an interval of time \[s\].
    fn contact_during(&self, ego: &Motion<'_, S>, part: Interval<S>, all: Interval<S>) -> Option<S> {
        let other = self.other_motion();
        let encounter = Encounter::new(ego, other);
        let (own, their) = (times(ego, part, all)?, times(other, self.other_length(), all)?);
        let during = Interval::new(own.lo.max(their.lo), own.hi.min(their.hi));
        // A contact is connected, hence part of one region; at a grazing one only its deepest point may be inside. No region
        // covers what is not within R, so that a contact of none is a touch, within what `Encounter::new` adds to R.
        let covers = |time: S| self.covers(ego.length_at(time), other.length_at(time));
        let belongs = |contact: &Interval<S>| covers(contact.middle()) || covers(encounter.closest(*contact).time);
        let mut contacts = (during.lo <= during.hi).then(|| encounter.contacts(during)).into_iter().flatten();
        contacts.find(belongs).map(Interval::length)
    }

    /// The least delay from `delay` on at which the ego does not meet this region.
    fn next_free(&self, delay: S) -> Option<S> {
        let possible = self.possible_delays();
        if !self.with_lateness(possible).contains(delay) {
            return Some(delay);
        }
        if self.is_uncertain() {
            let forbidden = self.forbidden_delays();
            let end = if forbidden.lo <= delay { forbidden.hi.max(delay) } else { delay };
            return (end < S::LIMIT).then_some(end);
        }
        if self.contact_after(delay).is_none() {
            return Some(delay);
        }
        (possible.hi < S::LIMIT).then(|| self.end_of_delays(delay, possible.hi))
    }
}

/// The least delay of the ego's start, from `from` \[s\] on, at which it meets none of the regions: those of its row in
/// the table, or of some of the others. `None` where no delay helps that the format holds; [`RegionRef::forbidden_delays`] tells which regions
/// forbid all late ones.
///
/// Cost: a comparison of ranges a region, 10 to 30 searches for contacts for each that is met.
///
/// ```
/// use pcr_core::{Ecm, Motion, Path, Piece, Point, Pose, Profile, Radians, Region, earliest_start};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
/// let ecm = Ecm::build([Region::EMPTY; 4], [Piece::EMPTY; 4], &fleet)?;
///
/// // At 1 m/s on crossing lines: R √2.
/// let delay = earliest_start(ecm.row(&fleet, 0)?, 0.0).unwrap();
/// assert!((delay - 0.5 * 2.0_f64.sqrt()).abs() < 1e-8);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn earliest_start<'a, S: Scalar>(regions: impl Iterator<Item = RegionRef<'a, S>> + Clone, from: S) -> Option<S> {
    let from = in_range(from, "delay").ok()?;
    settle(regions, from, RegionRef::next_free)
}

/// The least value from `from` on that is free for all regions.
pub(super) fn settle<'a, S: Scalar>(
    regions: impl Iterator<Item = RegionRef<'a, S>> + Clone,
    from: S,
    next_free: impl Fn(&RegionRef<'a, S>, S) -> Option<S>,
) -> Option<S> {
    let mut delay = from;
    // A region that was left behind is not met again: one round for each, and one that finds nothing.
    for () in regions.clone().map(|_| ()).chain([()]) {
        let mut later = delay;
        for region in regions.clone() {
            later = next_free(&region, later)?;
        }
        if later <= delay {
            return Some(delay);
        }
        delay = later;
    }
    None
}
