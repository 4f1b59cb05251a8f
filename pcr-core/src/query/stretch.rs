//! Speed scale factors: how long an agent has to take for its path so that it meets no region.
//!
//! The profile of the ego is stretched as a whole, so that it takes the duration d instead of its own D: speeds are
//! multiplied by the scale factor D / d. A point (l, s) of coordination space is reached with d = D (T_other(s) - t₀) /
//! τ_ego(l), where t₀ is the start and τ the time since then. For l > 0 that is continuous, so the image of a connected
//! region is connected, and a region forbids one interval of durations. The interval is unbounded above if the region
//! contains the ego's start (the ego is met however slow it is) or if the other agent stands in it at its end. It
//! extends down to 0 if the region contains the ego's end, or if the other agent stands in it at its start. Finite ends
//! are found like those of delays.

use crate::error::{Invalid, not_negative, positive};
use crate::geometry::Interval;
use crate::profile::Profile;
use crate::query::bracket::Bracket;
use crate::query::delay::settle;
use crate::region::RegionRef;
use crate::scalar::Scalar;

impl<S: Scalar> RegionRef<'_, S> {
    /// The durations of the ego's motion \[s\] with which it meets this region, if its profile is stretched or
    /// compressed as a whole ([`Profile::stretched`]) and its start time stays, rounded outward; `None` if there is no
    /// such duration. The forbidden interval of a speed scale factor runs from the duration of the motion divided by
    /// the upper end to the same divided by the lower end. An upper end of [`Scalar::LIMIT`] stands for infinity. `N`
    /// must be at least the number of phases of the motion.
    ///
    /// The accuracy is that of [`RegionRef::forbidden_delays`]. If the start time cuts off all but a small part of the
    /// region, or if agents may be late, the result may be all durations that the bounding box of the region allows.
    /// Cost: 10 to 40 searches for contacts for each finite end.
    ///
    /// # Errors
    /// [`Invalid::Full`] if the motion has more than `N` phases and a duration has to be tried.
    pub fn forbidden_durations<const N: usize>(&self) -> Result<Option<Interval<S>>, Invalid> {
        let Some(possible) = self.possible_durations() else {
            return Ok(None);
        };
        let (mut met, mut full) = (None, None);
        if !self.is_uncertain() {
            // The start time may cut off all but a corner of the region.
            let eighth = possible.length().half().half().half();
            let even = [(); 7].iter().scan(possible.lo, |place, ()| {
                *place = *place + eighth;
                Some(*place)
            });
            let points = self.inner_points().map(|[length, other_length]| self.duration_to_meet(length, other_length));
            for duration in points.chain(even) {
                if met.is_none() && duration > S::ZERO && possible.contains(duration) {
                    let contact = self.contact_in::<N>(duration);
                    full = full.or(contact.err());
                    met = contact.is_ok_and(|contact| contact.is_some()).then_some(duration);
                }
            }
        }
        if let Some(full) = full {
            return Err(full);
        }
        let ends = [possible.lo, possible.hi].map(|beyond| met.map_or(beyond, |met| self.end::<N>(met, beyond)));
        Ok(Some(Interval::new(ends[0], ends[1])))
    }

    /// The duration with which the ego is at one length when the other agent is at another.
    fn duration_to_meet(&self, length: S, other_length: S) -> S {
        let (ego, other) = (self.ego_motion(), self.other_motion());
        let start = ego.time().lo;
        let since = ego.time_in(Interval::new(length, length)).lo - start;
        let then = other.time_in(Interval::new(other_length, other_length)).lo - start;
        then.portion(ego.profile().duration(), since)
    }

    /// The durations that the bounding box of the region allows.
    fn possible_durations(&self) -> Option<Interval<S>> {
        let ego = self.ego_motion();
        let (length, start, duration) = (self.length(), ego.time().lo, ego.profile().duration());
        let before = Interval::new(-S::LIMIT, start);
        if length.lo <= S::ZERO && self.blocked(Interval::new(S::ZERO, S::ZERO), before).next().is_some() {
            // The ego meets the region whatever its duration.
            return Some(Interval::new(S::ZERO, S::LIMIT));
        }
        let (own, their) = (ego.time_in(length), self.time());
        let slack = self.resolution();
        let then = self.with_lateness(Interval::new(their.lo - start - slack, their.hi - start + slack));
        let scaled = |then: S, since: S| then.portion(duration, since);
        let (soonest, latest) = (own.lo - start - slack, own.hi - start + slack);
        let [before, after] = self.lets_pass();
        let (never, ever) = (!before || then.lo <= S::ZERO, !after || soonest <= S::ZERO);
        if !ever && then.hi <= S::ZERO {
            return None;
        }
        let lo = if never { S::ZERO } else { scaled(then.lo, latest) - slack };
        let hi = if ever { S::LIMIT } else { scaled(then.hi, soonest) + slack };
        // None, if all of them are longer than any that the format has.
        (lo <= S::LIMIT).then(|| Interval::new(lo.max(S::ZERO), hi.min(S::LIMIT)))
    }

    /// The end of the forbidden durations, between a forbidden duration and one beyond the end.
    fn end<const N: usize>(&self, inside: S, outside: S) -> S {
        if outside >= S::LIMIT || outside <= S::ZERO {
            return outside;
        }
        let contact = |duration: S| self.contact_in::<N>(duration).unwrap_or(Some(S::ZERO));
        Bracket { inside, outside, resolution: self.resolution() }.shrunk(contact)
    }

    /// How long the ego is in contact in this region with this duration of its motion; `None` if it is not.
    fn contact_in<const N: usize>(&self, duration: S) -> Result<Option<S>, Invalid> {
        let ego = self.ego_motion();
        let contact = |profile: &Profile<S, N>| {
            let ego = ego.with_profile(profile.as_profile(), ego.time().lo)?;
            Ok(self.contact_of(&ego, self.length(), -S::LIMIT))
        };
        match Profile::<S, N>::stretched(ego.profile(), duration).and_then(|profile| contact(&profile)) {
            Err(full @ Invalid::Full(_)) => Err(full),
            // A duration that the format cannot represent counts as forbidden.
            other => Ok(other.unwrap_or(Some(S::ZERO))),
        }
    }
}

/// The least duration of the ego's motion, from `from` \[s\] on, with which it meets none of the regions, if its
/// profile is stretched as a whole and its start time stays. Pass the regions of its row in the table, or those with
/// some of the other agents. `None` if no duration helps. The speed scale factor is the duration of the motion divided
/// by the result. `N` must be at least the number of phases of the motion.
///
/// Cost: twice that of [`RegionRef::forbidden_durations`] for each region that is met.
///
/// # Errors
/// [`Invalid::Full`] if the motion has more than `N` phases; [`Invalid::NonFinite`], [`Invalid::OutOfRange`] and
/// [`Invalid::Negative`] for `from`, and [`Invalid::NonPositive`] if `from` is 0 and the motion takes time.
///
/// ```
/// use pcr_core::{Ecm, Motion, Path, Piece, Point, Pose, Profile, Radians, Region, least_duration};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
/// let ecm = Ecm::build([Region::EMPTY; 4], [Piece::EMPTY; 4], &fleet)?;
///
/// // At the speed v the ego passes |2 v - 2| / √(1 + v²) behind the other: 0.5 m for 15 v² - 32 v + 15 = 0.
/// let duration = least_duration::<f64, 1>(ecm.row(&fleet, 0)?, 4.0)?.unwrap();
/// assert!((4.0 / duration - (16.0 - 31.0_f64.sqrt()) / 15.0).abs() < 1e-8);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn least_duration<'a, S: Scalar, const N: usize>(
    regions: impl Iterator<Item = RegionRef<'a, S>> + Clone,
    from: S,
) -> Result<Option<S>, Invalid> {
    not_negative(from, "duration")?;
    for region in regions.clone() {
        let profile = region.ego_motion().profile();
        if profile.phases().len() > N {
            return Err(Invalid::Full("phase"));
        }
        if profile.duration() > S::ZERO {
            positive(from, "duration")?;
        }
    }
    Ok(settle(regions, from, |region, duration| {
        let forbidden = region.forbidden_durations::<N>().unwrap_or(Some(Interval::new(S::ZERO, S::LIMIT)));
        match forbidden.filter(|forbidden| forbidden.lo <= duration && duration < forbidden.hi) {
            Some(forbidden) => (forbidden.hi < S::LIMIT).then_some(forbidden.hi),
            None => Some(duration),
        }
    }))
}
