//! Start delays: how much later an agent has to start so that it meets no region.
//!
//! The ego starts later by τ and stands at its start until then. A point (l, s) of coordination space is reached with a
//! delay of T_other(s) - T_ego(l). The image of a connected region is connected, so every region forbids one interval
//! of delays, whatever the profiles. The interval is unbounded above if the ego is hit while it stands at its start
//! (starting later does not help), or if it meets the other agent standing at its end; it is unbounded below in the
//! mirrored cases. A finite end is bracketed (`bracket`): a delay with a contact lies inside, and outside the extreme delay that the bounding box
//! of the region allows, or a larger one if there is a contact at that. The outer end of the bracket, which was tried and is clear, is the result.
//! If agents may be late, the interval is longer by their lateness.
//!
//! Delays beyond that end were not tried. They are clear because the delays at which the region of a given radius is met are one interval: the search is
//! made with a radius that is larger by an allowance, of which rounding can use up a part only (docs/theory/errors.md).

use crate::error::in_range;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::query::boundary_search::{ForbiddenBracket, Trial};
use crate::query::contact::{Encounter, pad};
use crate::query::safe::times;
use crate::region::RegionRef;
use crate::scalar::Scalar;

impl<S: Scalar> RegionRef<'_, S> {
    /// The delays of the ego's start \[s\] with which it meets this region, rounded outward; negative delays are
    /// earlier starts. An end of magnitude [`Scalar::LIMIT`] stands for infinity. If agents may be late
    /// ([`Motion::with_lateness`]), these are the delays with which they may meet.
    ///
    /// With a delay outside of the interval, and at its ends, [`Motion::delayed`] returns a motion that does not come nearer to the other agent than
    /// the sum of the radii in this region. The interval is longer than the exact one by at most what discs make of it that are larger by three
    /// [`Encounter::tolerance`], and at each end by [`Scalar::tolerance`] of the time from the first start to the last arrival, or four
    /// [`Scalar::rounding`] of the latest time if that is more. (`docs/theory/errors.md` derives this.) There are two exceptions: where the agents also meet in another
    /// region of their pair whose pieces lie beside those of this one, an end may be that of the other; and for a region in
    /// which the discs hardly touch, the result may be all delays that its bounding box allows. Cost: 10 to 30 searches for contacts for each finite end.
    pub fn forbidden_delays(&self) -> Interval<S> {
        let [before, after] = self.lets_pass();
        let allowance = self.allowance();
        self.delays(allowance, [before, after], false, &|delay| self.after(delay, allowance))
    }

    /// The delays of the ego's start \[s\] with which it meets this region while both agents are under way, rounded
    /// outward. An agent does not count before its start or after its arrival, as if it appeared and vanished. Meant
    /// for tables of the edges of a roadmap.
    ///
    /// Accuracy, lateness and cost are those of [`RegionRef::forbidden_delays`].
    pub fn passing_delays(&self) -> Interval<S> {
        let allowance = self.allowance();
        self.delays(allowance, [true; 2], true, &|delay| self.in_passing(delay, allowance))
    }

    /// The interval of delays around one inside, of which each end is either finite or not; contacts may be `cut` off by a start or an arrival.
    fn delays(&self, allowance: S, finite: [bool; 2], cut: bool, trial: &impl Fn(S) -> Trial<S>) -> Interval<S> {
        let (near, far) = (self.near_delays(allowance), self.far_delays());
        let met = self.delays_inside().find(|&delay| near.contains(delay) && trial(delay).is_inside());
        let bracket = |ends| ForbiddenBracket::new(met.unwrap_or(near.middle()), ends, self.resolution(), trial);
        let end =
            |ends| bracket(ends).map(|bracket| met.map_or(bracket.outside(), |_| bracket.with_cuts(cut).shrunk(trial)));
        let [lo, hi] = [[near.lo.max(far.lo), far.lo], [near.hi.min(far.hi), far.hi]];
        // A delay that is free, but out of the range of the format, was not tried. No motion can have it.
        let apart = self.apart_delays();
        let lo = if finite[0] { end(lo).or((apart.lo < far.lo).then_some(apart.lo.max(-S::LIMIT))) } else { None };
        let hi = if finite[1] { end(hi).or((apart.hi > far.hi).then_some(apart.hi.min(S::LIMIT))) } else { None };
        self.with_lateness(Interval::new(lo.unwrap_or(-S::LIMIT), hi.unwrap_or(S::LIMIT)))
    }

    /// How much farther apart than R the agents have to be at a delay for which the region is clear \[m\]: so much that all delays
    /// beyond it are clear of R as well, whatever is rounded (docs/theory/errors.md).
    pub(super) fn allowance(&self) -> S {
        let (ego, other) = (self.ego_motion(), self.other_motion());
        // If both are under way at the same time, the ego's times are no later than this.
        let latest = other.latest() + ego.profile().duration();
        let pad = pad(ego, other, ego.way_until(latest) + other.reach());
        // The region may hold for motions with more lag than these, and is larger then.
        pad.max(self.slack()).double().double()
    }

    /// Delays with which the agents meet at points inside the region.
    fn delays_inside(&self) -> impl Iterator<Item = S> {
        let when = |motion: &Motion<'_, S>, length| motion.time_in(Interval::new(length, length)).lo;
        let points = self.inner_points();
        points.map(move |[length, other_length]| {
            when(self.other_motion(), other_length) - when(self.ego_motion(), length)
        })
    }

    /// The delays that the bounding box of the region allows, where no end of a path belongs to it.
    fn near_delays(&self, allowance: S) -> Interval<S> {
        let own = self.ego_motion().time_in(self.length().widen(allowance, whole(self.ego_motion())));
        self.delays_of(own, allowance)
    }

    /// The delays with which both agents can be under way at the same time.
    fn apart_delays(&self) -> Interval<S> {
        let (own, their, slack) = (self.ego_motion().time(), self.other_motion().time(), self.resolution());
        Interval::new(their.lo - own.hi - slack, their.hi - own.lo + slack)
    }

    /// Those of them that the format can represent.
    fn far_delays(&self) -> Interval<S> {
        let (own, apart) = (self.ego_motion().time(), self.apart_delays());
        let most = Interval::new((-S::LIMIT - own.lo).max(-S::LIMIT), (S::LIMIT - own.hi).min(S::LIMIT));
        Interval::new(apart.lo.max(most.lo), apart.hi.min(most.hi))
    }

    /// The delays that move the ego's times `own` \[s\] onto times at which the other agent is in the region, or within a distance of it.
    pub(super) fn delays_of(&self, own: Interval<S>, allowance: S) -> Interval<S> {
        let other = self.other_motion();
        let their = other.time_in(self.other_length().widen(allowance, whole(other)));
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

    /// What happens in this region if the ego starts later by this delay.
    fn after(&self, delay: S, allowance: S) -> Trial<S> {
        // A start that the format cannot represent counts as forbidden.
        let Ok(ego) = self.ego_motion().delayed(delay) else { return Trial::Contact(S::ZERO) };
        self.tried(&ego, self.length(), ego.time().hull(self.other_motion().time()), allowance)
    }

    /// What happens in this region while both agents are under way, if the ego starts later by this delay.
    fn in_passing(&self, delay: S, allowance: S) -> Trial<S> {
        let Ok(ego) = self.ego_motion().delayed(delay) else { return Trial::Contact(S::ZERO) };
        let under_way = ego.time().common(self.other_motion().time());
        if under_way.lo > under_way.hi {
            return Trial::Clear;
        }
        self.tried(&ego, self.length(), under_way, allowance)
    }

    /// What happens on a part of this region during an interval of time \[s\], where `ego` is another motion along the ego's path. It is
    /// clear only if the agents are farther apart than R and the allowance whenever both are within the allowance of lengths of the region.
    pub(super) fn tried(&self, ego: &Motion<'_, S>, part: Interval<S>, during: Interval<S>, allowance: S) -> Trial<S> {
        let (ego, other) = (&ego.enlarged(allowance), self.other_motion());
        let encounter = Encounter::new(ego, other);
        // An agent is off the place of a time by less than the pad.
        let beside = allowance + encounter.pad();
        let near = |motion: &Motion<'_, S>, part: Interval<S>, during| {
            times(motion, part.widen(beside, whole(motion)), during)
        };
        let both = |own, their, during| near(other, their, near(ego, own, during)?);
        let Some(window) = both(part, self.other_length(), during) else { return Trial::Clear };
        let covers = |time: S| self.covers(ego.length_at(time), other.length_at(time));
        let mut found = Trial::Clear;
        for contact in encounter.contacts(window) {
            let long = contact.length();
            if covers(contact.middle()) {
                return Trial::Contact(long);
            }
            let beside_pieces = self.pieces().filter_map(|piece| both(piece.length, piece.other_length, contact));
            let Some(near) = beside_pieces.reduce(Interval::hull) else { continue };
            let closest = encounter.closest(near);
            if covers(near.middle()) || covers(closest.time) {
                return Trial::Contact(long);
            }
            // Of a slight contact only the deepest point may be in the region, and `closest` may miss that by the tolerance.
            let depth = encounter.radius() - allowance - closest.separation;
            if depth <= encounter.tolerance() {
                return Trial::Touch(long);
            }
            found = Trial::Elsewhere;
        }
        found
    }

    /// The least delay from `delay` on with which the ego does not meet this region, and whether it is clear; if not, another region
    /// forbids the delay. `strictly`, no such delay is returned.
    fn next_free(&self, delay: S, strictly: bool) -> Option<(S, bool)> {
        if self.is_uncertain() {
            let Interval { lo, hi } = self.near_delays(self.allowance());
            let [before, after] = self.lets_pass();
            let possible = Interval::new(if before { lo } else { -S::LIMIT }, if after { hi } else { S::LIMIT });
            if !self.with_lateness(possible).contains(delay) {
                return Some((delay, true));
            }
            let forbidden = self.forbidden_delays();
            let end = if forbidden.lo <= delay { forbidden.hi.max(delay) } else { delay };
            return (end < S::LIMIT).then_some((end, true));
        }
        // No motion can have a delay that is out of range: who tries is told so.
        if self.ego_motion().delayed(delay).is_err() {
            return Some((delay, true));
        }
        let trial = |delay| self.after(delay, S::ZERO);
        match trial(delay) {
            Trial::Clear => return Some((delay, true)),
            Trial::Elsewhere if !strictly => return Some((delay, false)),
            _ => {}
        }
        let [_, after] = self.lets_pass();
        if !after {
            return None;
        }
        let (near, far) = (self.near_delays(S::ZERO).hi.max(delay), self.far_delays().hi);
        let Some(bracket) = ForbiddenBracket::new(delay, [near.min(far), far], self.resolution(), &trial) else {
            let apart = self.apart_delays().hi;
            return (far < apart && apart < S::LIMIT).then_some((apart, true));
        };
        Some((if strictly { bracket.outside() } else { bracket.shrunk(&trial) }, true))
    }
}

/// All lengths of the path of a motion.
pub(super) fn whole<S: Scalar>(motion: &Motion<'_, S>) -> Interval<S> {
    Interval::new(S::ZERO, motion.path().length())
}

/// The least delay of the ego's start, from `from` \[s\] on, with which it meets none of the regions. Pass the regions
/// of its row in the table, or those with some of the other agents. With the result, [`Motion::delayed`] returns a motion that does not come
/// nearer to the agents of these regions than the sum of the radii, or refuses if all delays that would help are out of range. `None` if no delay
/// helps, or if `from` is no number that the format can represent; then [`RegionRef::forbidden_delays`] of each region shows which ones forbid all late starts.
///
/// Cost: a comparison of ranges for each region, and 10 to 30 searches for contacts for each region that is met.
///
/// ```
/// use pcr_core::{Ecm, Motion, Path, Piece, Point, Pose, Profile, Radians, EcmEntry, earliest_start};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
/// let ecm = Ecm::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], &fleet)?;
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

/// The least value from `from` on that is free for all regions. `next_free` returns the next value at which one region is not met, and
/// whether it is clear there.
pub(super) fn settle<'a, S: Scalar>(
    regions: impl Iterator<Item = RegionRef<'a, S>> + Clone,
    from: S,
    next_free: impl Fn(&RegionRef<'a, S>, S, bool) -> Option<(S, bool)>,
) -> Option<S> {
    let mut value = from;
    // Strictly, if a value that no region claims is not clear of all of them, or if they do not settle.
    for strictly in [false, true] {
        // A region that was passed is not met again: one round for each region, and one that changes nothing.
        for () in regions.clone().map(|_| ()).chain([()]) {
            let (mut later, mut clear) = (value, true);
            for region in regions.clone() {
                let (next, is_clear) = next_free(&region, later, strictly)?;
                (later, clear) = (next, clear && is_clear);
            }
            if later <= value {
                if clear {
                    return Some(value);
                }
                break;
            }
            value = later;
        }
    }
    None
}
