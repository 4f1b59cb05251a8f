//! Start delays: how much later an agent has to start so that it meets no region.
//!
//! The ego starts later by τ and stands at its start until then. A point (l, s) of coordination space is reached with a
//! delay of T_other(s) - T_ego(l). The image of a connected region is connected, so every region forbids one interval
//! of delays, whatever the profiles. The interval is unbounded above if the ego is hit while it stands at its start
//! (starting later does not help), or if it meets the other agent standing at its end; it is unbounded below in the
//! mirrored cases. A finite end is bracketed (`bracket`): the extreme delay that the bounding box of the region allows lies
//! outside, a delay with a contact inside. The outer end of the bracket, at which there was no contact, is the result.
//! If agents may be late, the interval is longer by their lateness.

use crate::error::in_range;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::query::bracket::Bracket;
use crate::query::contact::Encounter;
use crate::query::safe::times;
use crate::region::RegionRef;
use crate::scalar::Scalar;

impl<S: Scalar> RegionRef<'_, S> {
    /// The delays of the ego's start \[s\] with which it meets this region, rounded outward; negative delays are
    /// earlier starts. An end of magnitude [`Scalar::LIMIT`] stands for infinity. If agents may be late
    /// ([`Motion::with_lateness`]), these are the delays with which they may meet.
    ///
    /// The error of an end is [`Scalar::tolerance`] of the time from the first start to the last arrival, or four
    /// [`Scalar::rounding`] of the latest time if that is more, plus the delay that corresponds to a distance of
    /// [`Encounter::tolerance`]. For a region in which the discs only touch, the result may be all delays that its
    /// bounding box allows. Cost: 10 to 30 searches for contacts for each finite end.
    pub fn forbidden_delays(&self) -> Interval<S> {
        let possible = self.possible_delays();
        let met = self.delays_inside().find(|&delay| possible.contains(delay) && self.contact_after(delay).is_some());
        let ends = [possible.lo, possible.hi].map(|beyond| met.map_or(beyond, |met| self.end_of_delays(met, beyond)));
        self.with_lateness(Interval::new(ends[0], ends[1]))
    }

    /// The delays of the ego's start \[s\] with which it meets this region while both agents are under way, rounded
    /// outward. An agent does not count before its start or after its arrival, as if it appeared and vanished. Meant
    /// for tables of the edges of a roadmap.
    ///
    /// Accuracy, lateness and cost are those of [`RegionRef::forbidden_delays`].
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

    /// Delays with which the agents meet at points inside the region.
    fn delays_inside(&self) -> impl Iterator<Item = S> {
        let when = |motion: &Motion<'_, S>, length| motion.time_in(Interval::new(length, length)).lo;
        let points = self.inner_points();
        points.map(move |[length, other_length]| {
            when(self.other_motion(), other_length) - when(self.ego_motion(), length)
        })
    }

    /// The delays that the bounding box of the region allows.
    fn possible_delays(&self) -> Interval<S> {
        let Interval { lo, hi } = self.delays_of(self.ego_motion().time_in(self.length()));
        let [before, after] = self.lets_pass();
        Interval::new(if before { lo } else { -S::LIMIT }, if after { hi } else { S::LIMIT })
    }

    /// The delays that move the ego's times `own` \[s\] onto times at which the other agent is in the region.
    pub(super) fn delays_of(&self, own: Interval<S>) -> Interval<S> {
        let their = self.time();
        // Differences of times have a rounding error of their own.
        let slack = self.resolution();
        Interval::new(their.lo - own.hi - slack, their.hi - own.lo + slack)
    }

    /// Extends an interval of delays by the lateness of both agents.
    pub(crate) fn with_lateness(&self, delays: Interval<S>) -> Interval<S> {
        let (own, their) = (self.ego_motion().lateness(), self.other_motion().lateness());
        let lo = if delays.lo > -S::LIMIT { delays.lo - own } else { delays.lo };
        Interval::new(lo, if delays.hi < S::LIMIT { delays.hi + their } else { delays.hi })
    }

    /// Whether either agent may be late.
    pub(crate) fn is_uncertain(&self) -> bool {
        self.ego_motion().lateness() > S::ZERO || self.other_motion().lateness() > S::ZERO
    }

    /// Brackets are not made narrower than this \[s\].
    pub(super) fn resolution(&self) -> S {
        self.ego_motion().time().hull(self.other_motion().time()).resolution()
    }

    /// The end of the forbidden delays, between a forbidden delay and one beyond the end.
    fn end_of_delays(&self, inside: S, outside: S) -> S {
        if outside.abs() >= S::LIMIT {
            return outside;
        }
        Bracket { inside, outside, resolution: self.resolution() }.shrunk(|delay| self.contact_after(delay))
    }

    /// How long the ego is in contact in this region if it starts later by this delay; `None` if it is not.
    fn contact_after(&self, delay: S) -> Option<S> {
        // A start that the format cannot represent counts as forbidden.
        self.ego_motion().delayed(delay).map_or(Some(S::ZERO), |ego| self.contact_of(&ego, self.length(), -S::LIMIT))
    }

    /// How long the ego is in contact in this region while both agents are under way, if it starts later by this delay;
    /// `None` if it is not.
    fn contact_in_passing(&self, delay: S) -> Option<S> {
        let Ok(ego) = self.ego_motion().delayed(delay) else { return Some(S::ZERO) };
        let under_way = ego.time().common(self.other_motion().time());
        if under_way.lo > under_way.hi {
            return None;
        }
        self.contact_during(&ego, self.length(), under_way)
    }

    /// Duration \[s\] of the first contact of the ego on a part of this region from a time on, where `ego` is another
    /// motion along its path; `None` if there is no contact.
    pub(super) fn contact_of(&self, ego: &Motion<'_, S>, part: Interval<S>, from: S) -> Option<S> {
        let Interval { lo, hi } = ego.time().hull(self.other_motion().time());
        self.contact_during(ego, part, Interval::new(lo.max(from), hi))
    }

    /// The same during an interval of time \[s\].
    fn contact_during(&self, ego: &Motion<'_, S>, part: Interval<S>, all: Interval<S>) -> Option<S> {
        let other = self.other_motion();
        let encounter = Encounter::new(ego, other);
        let (own, their) = (times(ego, part, all)?, times(other, self.other_length(), all)?);
        let during = Interval::new(own.lo.max(their.lo), own.hi.min(their.hi));
        // A contact is connected, hence belongs to one region; of a grazing contact only the deepest point may be
        // inside. Regions cover everything within R, so a contact outside of all regions is a touch, within the
        // allowance that `Encounter::new` adds to R.
        let covers = |time: S| self.covers(ego.length_at(time), other.length_at(time));
        let belongs = |contact: &Interval<S>| covers(contact.middle()) || covers(encounter.closest(*contact).time);
        let mut contacts = (during.lo <= during.hi).then(|| encounter.contacts(during)).into_iter().flatten();
        contacts.find(belongs).map(Interval::length)
    }

    /// The least delay from `delay` on with which the ego does not meet this region.
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

/// The least delay of the ego's start, from `from` \[s\] on, with which it meets none of the regions. Pass the regions
/// of its row in the table, or those with some of the other agents. `None` if no delay that the format can represent
/// helps, or if `from` is no such number; then [`RegionRef::forbidden_delays`] of each region shows which ones forbid all late starts.
///
/// Cost: a comparison of ranges for each region, and 10 to 30 searches for contacts for each region that is met.
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
    // A region that was passed is not met again: one round for each region, and one that changes nothing.
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
