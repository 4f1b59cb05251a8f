//! Start delays: by how much an agent has to start later so that it meets no region.
//!
//! The ego sets off later by τ and stands at its start until then. A point (l, s) of coordination space is met at a
//! delay of T_other(s) - T_ego(l); the image of a connected region is connected, hence every region forbids one
//! interval of delays, whatever the profiles. It reaches to infinity where the ego is met standing at its start (later
//! does not help), or the other standing at its end; and from minus infinity likewise. A finite end is bracketed: what
//! the box of the region allows lies outside, a delay with a contact inside, and the bracket is halved by looking for
//! contacts. The outer end is taken, at which there was none.

use crate::geometry::Interval;
use crate::motion::Motion;
use crate::query::contact::Encounter;
use crate::query::safe::times;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// Halvings of a bracket at most; fewer where the format has fewer digits.
const HALVINGS: u32 = 64;

impl<S: Scalar> RegionRef<'_, S> {
    /// The delays of the ego's start \[s\] at which it meets this region, rounded outward; negative ones are earlier
    /// starts. An end of magnitude [`Scalar::LIMIT`] stands for infinity.
    ///
    /// The ends are right within [`Scalar::tolerance`] of the latest time, and what [`Encounter::tolerance`] of distance
    /// makes of them; a region in which the discs only touch
    /// may forbid all that its ranges allow. Cost: for each finite end about 30 searches for contacts in `f64`, 15 in `f32`.
    pub fn forbidden_delays(&self) -> Interval<S> {
        let when = |motion: &Motion<'_, S>, length| motion.time_in(Interval::new(length, length)).lo;
        let delays = self
            .inner_points()
            .map(|[length, other_length]| when(self.other_motion(), other_length) - when(self.ego_motion(), length));
        let possible = self.possible_delays();
        match delays.filter(|&delay| possible.contains(delay)).find(|&delay| self.is_met(delay)) {
            Some(met) => Interval::new(self.end_of_delays(met, possible.lo), self.end_of_delays(met, possible.hi)),
            None => possible,
        }
    }

    /// The delays that the ranges of the region allow.
    fn possible_delays(&self) -> Interval<S> {
        let ego = self.ego_motion();
        let length = self.length();
        let (own, their) = (ego.time_in(length), self.time());
        // Differences of times have a rounding of their own.
        let slack = self.resolution();
        let never = length.hi >= ego.path().length() || self.is_open_at_start();
        let ever = length.lo <= S::ZERO || self.is_open_at_end();
        Interval::new(
            if never { -S::LIMIT } else { their.lo - own.hi - slack },
            if ever { S::LIMIT } else { their.hi - own.lo + slack },
        )
    }

    /// Brackets are not narrower than this \[s\].
    fn resolution(&self) -> S {
        let latest = |interval: Interval<S>| interval.lo.abs().max(interval.hi.abs());
        S::tolerance(latest(self.ego_motion().time()).max(latest(self.other_motion().time())))
    }

    /// The end of the forbidden delays between one that is forbidden and one that is beyond it.
    fn end_of_delays(&self, met: S, beyond: S) -> S {
        if beyond.abs() >= S::LIMIT {
            return beyond;
        }
        let resolution = self.resolution();
        let (mut inside, mut outside) = (met, beyond);
        for _ in 0..HALVINGS {
            if (outside - inside).abs() <= resolution {
                break;
            }
            let middle = inside + (outside - inside).half();
            if self.is_met(middle) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        outside
    }

    /// Whether the ego meets the region if it starts later by this delay.
    fn is_met(&self, delay: S) -> bool {
        let other = self.other_motion();
        // A start that the format does not hold is none to recommend.
        let Ok(ego) = self.ego_motion().delayed(delay) else {
            return true;
        };
        let encounter = Encounter::new(&ego, other);
        let all = encounter.time();
        let (Some(own), Some(their)) = (times(&ego, self.length(), all), times(other, self.other_length(), all)) else {
            return false;
        };
        let during = Interval::new(own.lo.max(their.lo), own.hi.min(their.hi));
        // A contact is connected, hence part of one region; at a grazing one only its deepest point may be inside.
        let covers = |time: S| self.covers(ego.length_at(time), other.length_at(time));
        let belongs = |contact: Interval<S>| covers(contact.middle()) || covers(encounter.closest(contact).time);
        during.lo <= during.hi && encounter.contacts(during).any(belongs)
    }

    /// The least delay from `delay` on at which the ego does not meet this region.
    fn next_free(&self, delay: S) -> Option<S> {
        let possible = self.possible_delays();
        if !possible.contains(delay) || !self.is_met(delay) {
            return Some(delay);
        }
        (possible.hi < S::LIMIT).then(|| self.end_of_delays(delay, possible.hi))
    }
}

/// The least delay of the ego's start, from `from` \[s\] on, at which it meets none of the regions: those of its row in
/// the table, or of some of the others. `None` where no delay helps; [`RegionRef::forbidden_delays`] tells which regions
/// forbid all late ones.
///
/// Cost: a comparison of ranges a region, 15 to 30 searches for contacts for each that is met.
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
/// let delay = earliest_start(ecm.row(&fleet, 0), 0.0).unwrap();
/// assert!((delay - 0.5 * 2.0_f64.sqrt()).abs() < 1e-8);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn earliest_start<'a, S: Scalar>(regions: impl Iterator<Item = RegionRef<'a, S>> + Clone, from: S) -> Option<S> {
    let mut delay = from;
    // A region that was left behind is not met again: one round for each, and one that finds nothing.
    for () in regions.clone().map(|_| ()).chain([()]) {
        let mut later = delay;
        for region in regions.clone() {
            later = region.next_free(later)?;
        }
        if later <= delay {
            return Some(delay);
        }
        delay = later;
    }
    None
}
