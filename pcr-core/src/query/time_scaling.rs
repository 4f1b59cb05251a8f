//! Speed scale factors: how long an agent has to take for its path so that it meets no region.
//!
//! The profile of the ego is stretched as a whole, so that it takes the duration d instead of its own D: speeds are
//! multiplied by the scale factor D / d. A point (l, s) of coordination space is reached with d = D (T_other(s) - t₀) /
//! τ_ego(l), where t₀ is the start and τ the time since then. For l > 0 that is continuous, so the image of a connected
//! region is connected, and a region forbids one interval of durations. The interval is unbounded above if the region
//! contains the ego's start (the ego is met however slow it is) or if the other agent stands in it at its end. It
//! extends down to 0 if the region contains the ego's end, or if the other agent stands in it at its start. Finite ends
//! are found like those of delays.
//!
//! The profile that [`Profile::stretched`] makes is not exactly the one that is stretched: times, and in fixed point speeds, are rounded. The rounding is that of
//! each duration, so that a duration next to one that is clear may not be. An interval of durations is therefore searched with an allowance for it; the
//! least duration is one that was tried itself.

use crate::error::{InvalidInput, not_negative, positive};
use crate::geometry::Interval;
use crate::profile::Profile;
use crate::query::boundary_search::{ForbiddenBracket, Trial};
use crate::query::contact::pad;
use crate::query::start_delay::{settle, whole};
use crate::region::RegionRef;
use crate::scalar::{Scalar, Wide};
use core::cell::Cell;

impl<S: Scalar> RegionRef<'_, S> {
    /// The durations of the ego's motion \[s\] with which it meets this region, if its profile is stretched or
    /// compressed as a whole ([`Profile::stretched`]) and its start time stays, rounded outward; `None` if there is no
    /// such duration. The forbidden interval of a speed scale factor runs from the duration of the motion divided by
    /// the upper end to the same divided by the lower end. An upper end of [`Scalar::LIMIT`] stands for infinity. `N`
    /// must be at least the number of phases of the motion.
    ///
    /// With a duration outside of the interval, and at its ends, [`Profile::stretched`] returns a profile with which the ego does not come nearer to the
    /// other agent than the sum of the radii in this region. The interval exceeds the exact one by as much as that of [`RegionRef::forbidden_delays`]; and in fixed point, where a
    /// stretched profile has speeds of few digits, by what the distance changes that an agent goes at one last digit of a speed
    /// until the other one has left the region. If the start time cuts off all but a small part of the
    /// region, or if agents may be late, the result may be all durations that the bounding box of the region allows.
    /// Cost: 10 to 40 searches for contacts for each finite end.
    ///
    /// # Errors
    /// [`InvalidInput::Full`] if the motion has more than `N` phases and a duration has to be tried.
    pub fn forbidden_durations<const N: usize>(&self) -> Result<Option<Interval<S>>, InvalidInput> {
        let whole = self.ego_motion().profile().duration();
        let own = if whole > S::ZERO { self.allowance_in(whole) } else { self.allowance() };
        let Some(possible) = self.possible_durations(own) else {
            return Ok(None);
        };
        if self.is_uncertain() {
            return Ok(Some(possible));
        }
        let (mut met, mut full) = (None, None);
        // The start time may cut off all but a corner of the region.
        let eighth = possible.length().half().half().half();
        let even = [(); 7].iter().scan(possible.lo, |place, ()| {
            *place = *place + eighth;
            Some(*place)
        });
        let points = self.inner_points().map(|[length, other_length]| self.duration_to_meet(length, other_length));
        for duration in points.chain(even) {
            if met.is_none() && duration > S::ZERO && possible.contains(duration) {
                let allowance = self.allowance_in(duration);
                let trial = self.tried_in::<N>(duration, allowance);
                full = full.or(trial.err());
                met = trial.is_ok_and(Trial::is_inside).then_some((duration, allowance));
            }
        }
        if let Some(full) = full {
            return Err(full);
        }
        // Without a duration inside, what the bounding box allows.
        let (inside, allowance) = met.unwrap_or((possible.middle(), own));
        let trial = |duration: S| self.tried_in::<N>(duration, allowance).unwrap_or(Trial::Contact(S::ZERO));
        let end = |near: S, far: S| {
            let bracket = ForbiddenBracket::new(inside, [near, far], self.resolution(), &trial)?;
            Some(met.map_or(bracket.outside(), |_| bracket.shrunk(&trial)))
        };
        let is_finite = |end: S| S::ZERO < end && end < S::LIMIT;
        let lo = if is_finite(possible.lo) { end(possible.lo, S::ZERO).unwrap_or(S::ZERO) } else { possible.lo };
        let most = self.longest_duration().max(possible.hi);
        let hi = if is_finite(possible.hi) { end(possible.hi, most).unwrap_or(S::LIMIT) } else { possible.hi };
        Ok(Some(Interval::new(lo, hi)))
    }

    /// [`RegionRef::allowance`] of a search for durations: with the top speed of the stretched motion, and more by twice what rounding its speeds
    /// moves it in fixed point (docs/theory/errors.md).
    fn allowance_in(&self, duration: S) -> S {
        let (ego, other) = (self.ego_motion(), self.other_motion());
        let start = ego.time().lo;
        let speed = ego.profile().top_speed().portion(ego.profile().duration(), duration);
        let latest = other.latest().max(start.abs() + duration);
        let rest = pad(ego, other, speed.times(latest).narrow() + other.reach()).max(self.slack());
        let leap = speed.times(S::slack(S::ZERO)).narrow();
        // A speed is off by half a last digit, a sixteenth of the slack, until the other agent has left the region.
        let since = (other.time_in(self.other_length()).hi - start).max(S::ZERO).min(S::LIMIT);
        let noise = since.times(S::slack(S::ZERO)).narrow().half().half().half();
        (rest.double().double() + leap + noise).min(S::LIMIT)
    }

    /// The duration with which the ego is at one length when the other agent is at another.
    fn duration_to_meet(&self, length: S, other_length: S) -> S {
        let (ego, other) = (self.ego_motion(), self.other_motion());
        let start = ego.time().lo;
        let since = ego.time_in(Interval::new(length, length)).lo - start;
        let then = other.time_in(Interval::new(other_length, other_length)).lo - start;
        then.portion(ego.profile().duration(), since)
    }

    /// The durations that the bounding box of the region allows, enlarged by an allowance.
    fn possible_durations(&self, allowance: S) -> Option<Interval<S>> {
        let (ego, other) = (self.ego_motion(), self.other_motion());
        let (start, duration) = (ego.time().lo, ego.profile().duration());
        let before = Interval::new(-S::LIMIT, start);
        if self.length().lo <= S::ZERO && self.blocked(Interval::new(S::ZERO, S::ZERO), before).next().is_some() {
            // The ego meets the region whatever its duration.
            return Some(Interval::new(S::ZERO, S::LIMIT));
        }
        let own = ego.time_in(self.length().widen(allowance, whole(ego)));
        let their = other.time_in(self.other_length().widen(allowance, whole(other)));
        let slack = self.resolution();
        let then = self.with_lateness(Interval::new(their.lo - start - slack, their.hi - start + slack));
        let scaled = |then: S, since: S| then.portion(duration, since);
        let (soonest, latest) = (own.lo - start - slack, own.hi - start + slack);
        let [before, after] = self.lets_pass();
        let (never, ever) = (!before || then.lo <= S::ZERO, !after || self.length().lo <= S::ZERO);
        if !ever && then.hi <= S::ZERO {
            return None;
        }
        let lo = if never { S::ZERO } else { scaled(then.lo, latest) - slack };
        let most = self.longest_duration();
        // If it is longer than all that the format has, a shorter one may be clear.
        let longest = if soonest > S::ZERO { (scaled(then.hi, soonest) + slack).min(most) } else { most };
        let hi = if ever { S::LIMIT } else { longest };
        // None, if all of them are longer than any that the format has.
        (lo <= S::LIMIT).then(|| Interval::new(lo.max(S::ZERO), hi.max(lo).max(S::ZERO)))
    }

    /// The longest duration of the ego's motion that the format can represent.
    fn longest_duration(&self) -> S {
        S::LIMIT - self.ego_motion().time().lo.max(S::ZERO)
    }

    /// What happens in this region with this duration of the ego's motion.
    fn tried_in<const N: usize>(&self, duration: S, allowance: S) -> Result<Trial<S>, InvalidInput> {
        let ego = self.ego_motion();
        let trial = |profile: &Profile<S, N>| {
            let ego = ego.with_profile(profile.as_profile(), ego.time().lo)?;
            Ok(self.tried(&ego, self.length(), ego.time().hull(self.other_motion().time()), allowance))
        };
        match Profile::<S, N>::stretched(ego.profile(), duration).and_then(|profile| trial(&profile)) {
            Err(full @ InvalidInput::Full(_)) => Err(full),
            // A duration that the format cannot represent counts as forbidden.
            other => Ok(other.unwrap_or(Trial::Contact(S::ZERO))),
        }
    }

    /// The least duration from `duration` on with which the ego does not meet this region, and whether it is clear then (as `settle` asks). `None`
    /// if there is none; `lost` is set if only the digits of the format are to blame.
    fn next_free_in<const N: usize>(&self, duration: S, strictly: bool, lost: &Cell<bool>) -> Option<(S, bool)> {
        if self.is_uncertain() {
            let forbidden = self.forbidden_durations::<N>().unwrap_or(Some(Interval::new(S::ZERO, S::LIMIT)));
            return match forbidden.filter(|forbidden| forbidden.lo <= duration && duration < forbidden.hi) {
                Some(forbidden) => (forbidden.hi < S::LIMIT).then_some((forbidden.hi, true)),
                None => Some((duration, true)),
            };
        }
        let trial = |duration: S| self.tried_in::<N>(duration, S::ZERO).unwrap_or(Trial::Contact(S::ZERO));
        match trial(duration) {
            Trial::Clear => return Some((duration, true)),
            Trial::Elsewhere if !strictly => return Some((duration, false)),
            _ => {}
        }
        let near = self.possible_durations(self.allowance()).map_or(duration, |possible| possible.hi.max(duration));
        if near >= S::LIMIT {
            return None;
        }
        let far = self.longest_duration().max(near);
        let Some(bracket) = ForbiddenBracket::new(duration, [near, far], self.resolution(), &trial) else {
            lost.set(true);
            return None;
        };
        Some((if strictly { bracket.outside() } else { bracket.shrunk(&trial) }, true))
    }
}

/// The least duration of the ego's motion, from `from` \[s\] on, with which it meets none of the regions, if its
/// profile is stretched as a whole and its start time stays. Pass the regions of its row in the table, or those with
/// some of the other agents. With the result, [`Profile::stretched`] returns a profile with which the ego does not come nearer to the agents of these
/// regions than the sum of the radii. In fixed point, where the profiles of neighbouring durations are rounded differently, a shorter duration may also be free,
/// if it is one with which they hardly touch. `None` if no duration helps. The speed scale factor is the duration of the motion divided
/// by the result. `N` must be at least the number of phases of the motion.
///
/// Cost: that of one end of [`RegionRef::forbidden_durations`] for each region that is met.
///
/// # Errors
/// [`InvalidInput::Full`] if the motion has more than `N` phases; [`InvalidInput::OutOfRange`] if a duration would help, but all that the format can
/// represent are too near to contact; [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`] and
/// [`InvalidInput::Negative`] for `from`, and [`InvalidInput::NonPositive`] if `from` is 0 and the motion takes time.
///
/// ```
/// use pcr_core::{Ecm, Motion, Path, Piece, Point, Pose, Profile, Radians, EcmEntry, least_duration};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
/// let ecm = Ecm::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], &fleet)?;
///
/// // At the speed v the ego passes |2 v - 2| / √(1 + v²) behind the other: 0.5 m for 15 v² - 32 v + 15 = 0.
/// let duration = least_duration::<f64, 1>(ecm.row(&fleet, 0)?, 4.0)?.unwrap();
/// assert!((4.0 / duration - (16.0 - 31.0_f64.sqrt()) / 15.0).abs() < 1e-8);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn least_duration<'a, S: Scalar, const N: usize>(
    regions: impl Iterator<Item = RegionRef<'a, S>> + Clone,
    from: S,
) -> Result<Option<S>, InvalidInput> {
    not_negative(from, "duration")?;
    for region in regions.clone() {
        let profile = region.ego_motion().profile();
        if profile.phases().len() > N {
            return Err(InvalidInput::Full("phase"));
        }
        if profile.duration() > S::ZERO {
            positive(from, "duration")?;
        }
    }
    let lost = Cell::new(false);
    match settle(regions, from, |region, duration, strictly| region.next_free_in::<N>(duration, strictly, &lost)) {
        None if lost.get() => Err(InvalidInput::OutOfRange("duration")),
        found => Ok(found),
    }
}
