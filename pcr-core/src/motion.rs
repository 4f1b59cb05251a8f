//! An agent in motion: a disc, its path, and when it is where on it (Eq. 2, ρ ∘ λ).

use crate::bits::digest;
use crate::error::{self, Invalid, in_range, not_negative};
use crate::geometry::{Bounds, Interval, Point};
use crate::path::PathRef;
use crate::profile::ProfileRef;
use crate::scalar::{Scalar, Wide};
use crate::segment::Curve;

/// Logarithm to the base 2 of the part of a path's length by which a profile may miss the end of the path: 2⁻²⁰, 1 mm in a kilometre.
/// Profiles that people write with seven digits miss it by as much, and files are read with the same number. Where rounding may be more,
/// [`Scalar::slack`] of the extent, a profile may miss it by that.
pub const LENGTH_TOLERANCE_LOG2: i32 = -20;

/// A disc on a path with a speed profile. It stands at the start of the path before it sets off, and at the
/// end of it after its arrival.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Motion<'a, S: Scalar> {
    path: PathRef<'a, S>,
    profile: ProfileRef<'a, S>,
    radius: S,
    margin: S,
    time: Interval<S>,
    lateness: S,
    bounds: Bounds<S>,
    extent: S,
    drift: S,
    lag: S,
    top_speed: S,
    /// Checksum of the path.
    digest: u32,
}

impl<'a, S: Scalar> Motion<'a, S> {
    /// The motion of a disc of this radius \[m\] that sets off at the time `start` \[s\].
    ///
    /// # Errors
    /// [`Invalid::NonFinite`], [`Invalid::OutOfRange`], [`Invalid::NonPositive`], [`Invalid::TooSmall`] (radius) and
    /// [`Invalid::LengthMismatch`] where the profile does not travel the length of the path, by more than [`LENGTH_TOLERANCE_LOG2`] or
    /// rounding. What it misses counts: [`Motion::lag`] is larger by it, and so is ε, by twice as much
    /// ([`excess`](crate::excess)).
    pub fn new(path: PathRef<'a, S>, profile: ProfileRef<'a, S>, radius: S, start: S) -> Result<Self, Invalid> {
        error::radius(radius)?;
        let time = travel_time(profile, start)?;
        let bounds = path.bounds();
        let extent = bounds.extent().max(path.length()) + radius.double();
        let gap = (profile.length() - path.length()).abs();
        let share = (LENGTH_TOLERANCE_LOG2..0).fold(path.length(), |length, _| length.half());
        if gap > S::slack(extent).max(share) {
            let [path, profile] = [path.length(), profile.length()].map(S::millimetres);
            return Err(Invalid::LengthMismatch { path, profile });
        }
        // `count` would check for overflow.
        let (arcs, diameter) =
            path.segments().iter().fold((0_usize, S::ZERO), |(arcs, most), segment| match segment.curve() {
                Curve::Line => (arcs, most),
                Curve::Arc { radius, .. } => (arcs.saturating_add(1), most.max(radius.double())),
            });
        let drift = S::drift(arcs, extent + diameter);
        let top_speed = profile.top_speed();
        // The agent is nowhere by more than that from where its profile says.
        let lag = S::lag(top_speed, profile.duration()) + gap;
        let (margin, lateness) = (S::ZERO, S::ZERO);
        let digest = path.digest();
        Ok(Self { path, profile, radius, margin, time, lateness, bounds, extent, drift, lag, top_speed, digest })
    }

    /// The same motion with a margin \[m\] to be kept around the disc: for errors of localization, for latency, for comfort.
    /// It changes no region; those of [`Motion::inflated`] motions tell where margins overlap.
    ///
    /// # Errors
    /// [`Invalid::NonFinite`], [`Invalid::OutOfRange`] (also for radius and margin together), [`Invalid::Negative`].
    pub fn with_margin(self, margin: S) -> Result<Self, Invalid> {
        not_negative(margin, "margin")?;
        in_range(self.radius + margin, "radius with its margin")?;
        Ok(Self { margin, ..self })
    }

    /// The same motion of an agent that may be late by up to so much \[s\]: at any time it is somewhere where by the motion it
    /// has been during so long before. What is asked for plans takes it into account on both sides, of the ego and of
    /// others: blocked windows and safe intervals, forbidden delays, durations and waits, speed plans. Regions, conflicts and
    /// the closest approach are those of the motion as it is.
    ///
    /// # Errors
    /// [`Invalid::NonFinite`], [`Invalid::OutOfRange`], [`Invalid::Negative`].
    pub fn with_lateness(self, lateness: S) -> Result<Self, Invalid> {
        not_negative(lateness, "lateness")?;
        Ok(Self { lateness, ..self })
    }

    /// By how much the agent may be late \[s\].
    pub fn lateness(&self) -> S {
        self.lateness
    }

    /// The same motion of a disc that is larger by the margin, without a margin of its own: a table of such motions
    /// holds the regions in which margins overlap, apart from those of contact.
    ///
    /// ```
    /// # use pcr_core::{Ecm, Limits, Motion, Path, Piece, Point, Pose, Profile, Radians, Region};
    /// # let pose = |y, heading| Pose { position: Point::new(-2.0, y), heading: Radians(heading) };
    /// let lanes = [Path::<f64, 1>::starting_at(pose(0.0, 0.0))?.line(4.0)?, Path::starting_at(pose(0.6, 0.0))?.line(4.0)?];
    /// # let profile = Profile::rest_to_rest(4.0, Limits { speed: 1.0, acceleration: 1.0 })?;
    /// # let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0)?.with_margin(0.1);
    /// let fleet = [motion(lanes[0].as_path())?, motion(lanes[1].as_path())?]; // radius 0.25 m, margin 0.1 m
    /// let contact = Ecm::build([Region::EMPTY; 1], [Piece::EMPTY; 1], &fleet)?;
    /// assert!(contact.is_empty()); // they pass, 0.1 m apart
    ///
    /// let inflated = fleet.map(|motion| motion.inflated());
    /// let margin = Ecm::build([Region::EMPTY; 1], [Piece::EMPTY; 1], &inflated)?;
    /// assert_eq!(margin.len(), 1); // but not 0.2 m
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    pub fn inflated(self) -> Self {
        let (radius, extent) = (self.radius + self.margin, self.extent + self.margin.double());
        Self { radius, extent, margin: S::ZERO, ..self }
    }

    /// The same disc on the same path with another profile and start time \[s\].
    ///
    /// # Errors
    /// As [`Motion::new`].
    pub fn with_profile(self, profile: ProfileRef<'a, S>, start: S) -> Result<Self, Invalid> {
        Self::new(self.path, profile, self.radius, start)?.with_margin(self.margin)?.with_lateness(self.lateness)
    }

    /// The same motion, later by `delay` \[s\].
    ///
    /// # Errors
    /// [`Invalid::NonFinite`], [`Invalid::OutOfRange`].
    pub fn delayed(self, delay: S) -> Result<Self, Invalid> {
        in_range(delay, "delay")?;
        Ok(Self { time: travel_time(self.profile, self.time.lo + delay)?, ..self })
    }

    /// From the first start to the last arrival of a fleet \[s\]: the time in which anything changes. From 0 to 0 for nobody.
    ///
    /// ```
    /// # use pcr_core::{Interval, Motion, Path, Point, Pose, Profile, Radians};
    /// # let start = Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) };
    /// # let path = Path::<f64, 1>::starting_at(start)?.line(4.0)?;
    /// # let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
    /// # let motion = |start| Motion::new(path.as_path(), profile.as_profile(), 0.25, start);
    /// let fleet = [motion(1.0)?, motion(6.5)?]; // four seconds each
    /// assert_eq!(Motion::span(&fleet), Interval::new(1.0, 10.5));
    /// # Ok::<(), pcr_core::Invalid>(())
    /// ```
    pub fn span(fleet: &[Self]) -> Interval<S> {
        let times = fleet.iter().map(Self::time);
        times.reduce(Interval::hull).unwrap_or(Interval::new(S::ZERO, S::ZERO))
    }

    /// The path.
    pub fn path(&self) -> PathRef<'a, S> {
        self.path
    }

    /// The speed profile.
    pub fn profile(&self) -> ProfileRef<'a, S> {
        self.profile
    }

    /// Radius of the disc \[m\].
    pub fn radius(&self) -> S {
        self.radius
    }

    /// Margin to be kept around the disc \[m\].
    pub fn margin(&self) -> S {
        self.margin
    }

    /// From setting off to arrival, that rounded up \[s\].
    pub fn time(&self) -> Interval<S> {
        self.time
    }

    /// Box around the path \[m\], radius not included.
    pub fn bounds(&self) -> Bounds<S> {
        self.bounds
    }

    /// A checksum of the path and the radius, on which regions depend, in this place of a fleet.
    pub(crate) fn digest(&self, place: usize) -> u32 {
        digest(digest(self.digest, place as u32), self.radius.digest())
    }

    /// Box around all that the disc sweeps, twice what rounding may do to a distance included \[m\]: agents whose boxes do
    /// not meet have no region.
    pub(crate) fn swept(&self) -> Bounds<S> {
        let slack = S::slack(self.extent) + self.drift + self.lag;
        self.bounds.expanded(self.radius + slack.double())
    }

    /// Largest coordinate or length that belongs to the motion, plus the diameter of the disc \[m\]: what errors grow with.
    pub fn extent(&self) -> S {
        self.extent
    }

    /// How far rounding, arc by arc, may have taken the path from where it should be \[m\].
    pub(crate) fn drift(&self) -> S {
        self.drift
    }

    /// How far the agent is from where it should be at a time, for the rounding of times, and for what the profile's length
    /// differs from the path's \[m\].
    pub fn lag(&self) -> S {
        self.lag
    }

    /// How far the agent may be from both ends of a segment that it passes at one time: a quarter of the way at its top speed
    /// in what a time may be off. Nothing in a format of relative precision, whose times `reach` is for \[m\].
    pub(crate) fn leap(&self) -> S {
        self.top_speed.times(S::slack(S::ZERO)).narrow().half().half()
    }

    /// How far the agent goes at its top speed in a time that holds all of its motion and the time 0 \[m\].
    pub(crate) fn reach(&self) -> S {
        self.top_speed.times(self.latest()).narrow()
    }

    /// λ: length travelled at a time \[m\], limited to the length of the path.
    #[cfg_attr(feature = "std", inline(always))]
    pub fn length_at(&self, time: S) -> S {
        let end = self.path.length();
        let elapsed = time.clamp(self.time.lo, self.time.hi) - self.time.lo;
        if elapsed >= self.profile.duration() { end } else { self.profile.length_at(elapsed).min(end) }
    }

    /// Speed at a time \[m/s\].
    pub fn speed_at(&self, time: S) -> S {
        if self.time.contains(time) { self.profile.speed_at(time - self.time.lo) } else { S::ZERO }
    }

    /// Position of the centre at a time.
    pub fn position_at(&self, time: S) -> Point<S> {
        self.path.point_at(self.length_at(time))
    }

    /// When the travelled length lies in `length` \[s\]: rounded outward by [`Motion::time_excess`] at most and, where the agent all
    /// but stands, by the time that it needs for what its lengths are off, but not beyond [`Motion::time`].
    pub fn time_in(&self, length: Interval<S>) -> Interval<S> {
        let Interval { lo: start, hi: arrival } = self.time;
        let lo = if length.lo > S::ZERO { start + self.profile.first_time_at(length.lo) } else { start };
        let hi = if length.hi < self.path.length() { start + self.profile.last_time_at(length.hi) } else { arrival };
        Interval::new(lo, hi).widen(self.time_slack(), self.time)
    }

    /// By how much a time of [`Motion::time_in`] is further out than the exact one of the lengths that it has, at most \[s\].
    pub fn time_excess(&self) -> S {
        self.time_slack().double()
    }

    /// What the sum of the start time and a time since then may be off.
    fn time_slack(&self) -> S {
        let rounding = S::rounding(self.latest());
        rounding.double() + rounding
    }

    /// The largest magnitude of a time of the motion \[s\].
    fn latest(&self) -> S {
        self.time.lo.abs().max(self.time.hi.abs())
    }
}

/// From setting off to arrival, that rounded up.
fn travel_time<S: Scalar>(profile: ProfileRef<'_, S>, start: S) -> Result<Interval<S>, Invalid> {
    in_range(start, "start time")?;
    in_range(start + profile.duration(), "end time")?;
    Ok(Interval::new(start, start.sum_up(profile.duration())))
}
