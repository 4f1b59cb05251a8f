//! Waits on the way: how long an agent has to stand at a length of its path so that it meets no region after it.
//!
//! After this length the motion is delayed by the wait, so the forbidden waits are found like the forbidden delays
//! (`delay`). How long the agent may stand there follows from the windows in which its place is blocked.

use crate::error::in_range;
use crate::geometry::Interval;
use crate::query::boundary_search::{ForbiddenBracket, Trial};
use crate::query::start_delay::{earliest_start, settle, whole};
use crate::region::RegionRef;
use crate::scalar::Scalar;

impl<S: Scalar> RegionRef<'_, S> {
    /// The least wait from `wait` on, at a length of the path, with which the ego does not meet the rest of this
    /// region, and whether the rest is clear then (as `settle` asks).
    // Not inlined: the caller keeps a copy of the regions.
    #[inline(never)]
    fn next_free_after(&self, at: S, wait: S, strictly: bool) -> Option<(S, bool)> {
        let (ego, other) = (self.ego_motion(), self.other_motion());
        let at = ego.path().length().min(at);
        let part = Interval::new(self.length().lo.max(at), self.length().hi);
        if part.lo > part.hi {
            return Some((wait, true));
        }
        // Standing at the end of the path belongs to the rest.
        let leaves = self.leaves(at);
        // The motion with the wait is made by someone else, who rounds its times again.
        let allowance = self.allowance();
        let trial = |wait: S| {
            let Ok(ego) = ego.delayed(wait) else { return Trial::Contact(S::ZERO) };
            let Interval { lo, hi } = ego.time().hull(other.time());
            self.tried(&ego, part, Interval::new(lo.max(leaves + wait).min(hi), hi), allowance)
        };
        let is_parked = || self.blocked(part, Interval::new(S::LIMIT, S::LIMIT)).next().is_some();
        let own = ego.time_in(part.widen(allowance, whole(ego)));
        let own = Interval::new(own.lo.max(leaves), own.hi.max(leaves));
        if self.is_uncertain() {
            // All waits that the bounding box allows count as forbidden.
            let near = self.with_lateness(self.delays_of(own, allowance));
            let (parked, stands) = (is_parked(), part.hi >= ego.path().length() || self.is_open_at_start());
            let apart = wait >= near.hi && !parked || wait < near.lo && !stands;
            return if apart { Some((wait, true)) } else { (!parked).then_some((near.hi, true)) };
        }
        match trial(wait) {
            Trial::Clear => return Some((wait, true)),
            Trial::Elsewhere if !strictly => return Some((wait, false)),
            _ => {}
        }
        if is_parked() {
            return None;
        }
        let most = S::LIMIT.min(S::LIMIT - ego.time().hi);
        let far = (other.time().hi - leaves + self.resolution()).max(wait).min(most);
        let near = self.delays_of(own, allowance).hi.max(wait).min(far);
        let bracket = ForbiddenBracket::new(wait, [near, far], self.resolution(), &trial)?;
        Some((if strictly { bracket.outside() } else { bracket.shrunk(&trial) }, true))
    }

    /// The time at which the ego's motion leaves a length of its path.
    fn leaves(&self, at: S) -> S {
        self.ego_motion().time().lo + self.ego_motion().profile().last_time_at(at)
    }

    /// How long the ego can stand at a length of its path, counted from when its motion leaves it.
    // Not inlined: its frame would add to that of the search before it.
    #[inline(never)]
    fn longest_wait(&self, at: S) -> S {
        let at = self.ego_motion().path().length().min(at);
        let leaves = self.leaves(at);
        let mut longest = S::LIMIT;
        for window in self.blocked(Interval::new(at, at), Interval::new(leaves, S::LIMIT)) {
            longest = longest.min(window.lo - leaves);
        }
        longest
    }
}

/// The least additional wait of the ego at a length of its path \[m\], from `from` \[s\] on, with which it meets none
/// of the regions when it continues with its motion. Pass the regions of its row in the table, or those with some of
/// the other agents. The length is clamped to the path; a wait at length 0 is a delay of the start. `None` if no wait
/// helps, if the agent would be hit while it waits, or for an argument that is NaN or beyond [`Scalar::LIMIT`]. The
/// function does not check that the agent can stop there; a motion that is at rest at this length can.
///
/// A motion that stands at this length longer by the result does not come nearer to the agents of these regions than the sum of the radii from then on, however
/// its times are rounded when the wait is added to them.
///
/// If the motion itself waits at this length, the additional wait comes after that. If the length cuts a region in two,
/// a wait with which the agent would pass between the parts may be missed. If agents may be late, a wait that is
/// shorter than all those that the bounding box of a region allows may be missed, too. Cost: that of [`earliest_start`]
/// for each region that is met, and a few hundred operations for each piece at this length.
///
/// ```
/// use pcr_core::{Ecm, Motion, Path, Piece, Point, Pose, Profile, Radians, EcmEntry, earliest_departure};
/// let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
/// let north = Pose { position: Point::new(0.0, -2.0), heading: Radians(core::f64::consts::FRAC_PI_2) };
/// let paths = [Path::<f64, 1>::starting_at(east)?.line(4.0)?, Path::starting_at(north)?.line(4.0)?];
/// let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
/// let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0);
/// let fleet = [motion(paths[0].as_path())?, motion(paths[1].as_path())?];
/// let ecm = Ecm::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], &fleet)?;
///
/// // 1 m from the start it waits as long as at the start; 0.4 m before the crossing the other would meet it standing.
/// let wait = earliest_departure(ecm.row(&fleet, 0)?, 1.0, 0.0).unwrap();
/// assert!((wait - 0.5 * 2.0_f64.sqrt()).abs() < 1e-8);
/// assert_eq!(earliest_departure(ecm.row(&fleet, 0)?, 1.6, 0.0), None);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn earliest_departure<'a, S: Scalar>(
    regions: impl Iterator<Item = RegionRef<'a, S>> + Clone,
    length: S,
    from: S,
) -> Option<S> {
    if length <= S::ZERO {
        return earliest_start(regions, from);
    }
    let (length, from) = (in_range(length, "length").ok()?, in_range(from, "wait").ok()?);
    let wait = settle(regions.clone(), from, |region, wait, strictly| region.next_free_after(length, wait, strictly))?;
    let longest = regions.map(|region| region.longest_wait(length)).fold(S::LIMIT, S::min);
    (wait <= S::ZERO || wait <= longest).then_some(wait)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Ecm, EcmEntry, Motion, Path, Piece, Point, Pose, Profile, Radians};

    /// The least wait from each of some, 1 m from the start of an ego that is up to 0.25 s late and travels as far to the east from (-2, 0),
    /// beside an agent that is up to 0.5 s late and travels to the north from 5 s on, between two distances from where they cross. Discs of
    /// 0.25 m, 1 m/s: the ego is near the crossing from 1.5 to 2.5 m of its path.
    fn waits<const N: usize>(far: f64, [from, to]: [f64; 2], waits: [f64; N]) -> [Option<f64>; N] {
        let east = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
        let north = Pose { position: Point::new(0.0, from), heading: Radians(core::f64::consts::FRAC_PI_2) };
        let paths = [(east, far), (north, to - from)]
            .map(|(start, long)| Path::<f64, 1>::starting_at(start).unwrap().line(long).unwrap());
        let profiles = [far, to - from].map(|long| Profile::<f64, 1>::from_pieces(1.0, [(long, 0.0)]).unwrap());
        let motion = |agent: usize, start: f64, late: f64| {
            let motion = Motion::new(paths[agent].as_path(), profiles[agent].as_profile(), 0.25, start).unwrap();
            motion.with_lateness(late).unwrap()
        };
        let fleet = [motion(0, 0.0, 0.25), motion(1, 5.0, 0.5)];
        let ecm = Ecm::build([EcmEntry::EMPTY; 4], [Piece::EMPTY; 4], &fleet).unwrap();
        waits.map(|wait| earliest_departure(ecm.row(&fleet, 0).unwrap(), 1.0, wait))
    }

    #[track_caller]
    fn assert_close<const N: usize>(found: [Option<f64>; N], expected: [Option<f64>; N]) {
        let is_close = |(found, expected): (&Option<f64>, &Option<f64>)| match (found, expected) {
            (Some(found), Some(expected)) => (found - expected).abs() < 1e-6,
            (found, expected) => found == expected,
        };
        assert!(found.iter().zip(&expected).all(is_close), "{found:?} {expected:?}");
    }

    #[test]
    fn waits_of_agents_that_may_be_late_are_outside_of_what_their_ranges_allow() {
        // The other agent is near the crossing from 6.5 to 7.5 s: forbidden are the waits from 6.5 - 2.5 - 0.25 to 7.5 - 1.5 + 0.5 s.
        let found = waits(4.0, [-2.0, 2.0], [0.0, 3.7, 3.8, 6.4, 6.6]);
        assert_close(found, [Some(0.0), Some(3.7), Some(6.5), Some(6.5), Some(6.6)]);
    }

    #[test]
    fn nobody_who_may_be_late_goes_before_where_one_of_them_stands() {
        // The ego ends in the middle of the crossing, and stands there as the other one comes.
        assert_close(waits(2.0, [-2.0, 2.0], [0.0, 3.8, 6.6]), [Some(6.5), Some(6.5), Some(6.6)]);
        // The other one stands there before it sets off; it is 0.5 m away at 5.5 s.
        assert_close(waits(4.0, [0.0, 2.0], [0.0, 2.4, 4.6]), [Some(4.5), Some(4.5), Some(4.6)]);
        // It stands there from 7 s on, so that only going before it helps.
        assert_close(waits(4.0, [-2.0, 0.0], [0.0, 3.7, 3.8, 9.0]), [Some(0.0), Some(3.7), None, None]);
    }
}
