//! An agent in motion: a disc or an outline, its path, and its travelled length over time (Eq. 2, ρ ∘ λ).

use crate::bit_rows::digest;
use crate::error::{self, InvalidInput, in_range, not_negative};
use crate::geometry::{Aabb, Interval, Point};
use crate::outline::placed::{Carried, Corners};
use crate::outline::{Corner, OutlineRef};
use crate::path::PathRef;
use crate::profile::ProfileRef;
use crate::scalar::{Scalar, Wide};
#[cfg(feature = "outlines")]
use crate::segment::Curve;
use crate::segment::Segment;

/// The end of a profile may differ from the end of the path by this fraction of the path's length, given as its
/// logarithm to the base 2: 2⁻²⁰, 1 mm in a kilometre. Profiles that people write with seven digits differ by as much.
/// The fraction is the same for all number formats, so that they accept the same files. If [`Scalar::slack`] of the
/// extent is larger than that, it is the limit.
pub const LENGTH_TOLERANCE_LOG2: i32 = -20;

/// A disc on a path with a speed profile. It stands at the start of the path before it sets off, and at the end of the
/// path after its arrival.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Motion<'a, S: Scalar> {
    path: PathRef<'a, S>,
    profile: ProfileRef<'a, S>,
    /// Radius of the disc, or of the rounding of the outline.
    radius: S,
    /// Corners of the outline; none for a disc.
    corners: &'a [Corner<S>],
    /// Largest distance of a corner from the reference point.
    spread: S,
    /// Sum of both: radius of the disc about the reference point that contains the outline.
    reach: S,
    /// How much farther a corner moves at most than the travelled length, as a factor.
    lever: S,
    /// Whether it takes the kernels of outlines.
    #[cfg(feature = "outlines")]
    outlined: bool,
    margin: S,
    time: Interval<S>,
    lateness: S,
    bounds: Aabb<S>,
    extent: S,
    drift: S,
    /// Largest lag for which its regions hold.
    allowance: S,
    top_speed: S,
    /// Checksum of the path.
    digest: u32,
}

impl<'a, S: Scalar> Motion<'a, S> {
    /// The motion of a disc with this radius \[m\] that sets off at the time `start` \[s\].
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`], [`InvalidInput::NonPositive`], [`InvalidInput::TooSmall`] (radius), and
    /// [`InvalidInput::LengthMismatch`] if the lengths of profile and path differ by more than [`LENGTH_TOLERANCE_LOG2`] and
    /// rounding allow. A smaller difference is added to [`Motion::lag`], and twice the difference to ε
    /// ([`excess`](crate::excess)).
    pub fn new(path: PathRef<'a, S>, profile: ProfileRef<'a, S>, radius: S, start: S) -> Result<Self, InvalidInput> {
        error::radius(radius)?;
        Self::of(path, profile, OutlineRef::disc(radius), start)
    }

    /// The motion of an outline whose reference point follows the path, with its `x` axis along the direction of travel, or at the angle to it that the path
    /// states ([`Path::facing`](crate::Path::facing), [`Path::reverse`](crate::Path::reverse)), and that sets off at the time `start` \[s\]. An outline that is a disc about its reference point makes the motion of
    /// [`Motion::new`].
    ///
    /// # Errors
    /// As [`Motion::new`]; [`InvalidInput::TurnInPlace`] if the heading jumps where the path turns without a length ([`Path::turn`](crate::Path::turn)), so that the outline would sweep an area; [`InvalidInput::Lever`] if an
    /// arc is so tight, or the lever of a turn in place so short, that rounding a length could move a corner by a sixteenth of the size of the outline.
    ///
    /// ```
    /// use pcr_core::{Ecm, Limits, Motion, Outline, Path, Piece, Point, Pose, Profile, Radians, EcmEntry};
    /// // Two pallet trucks, 1.2 m long and 0.8 m wide, pass each other 1 mm apart.
    /// let pose = |x, y, heading| Pose { position: Point::new(x, y), heading: Radians(heading) };
    /// let east = Path::<f64, 1>::starting_at(pose(0.0, 0.0, 0.0))?.line(6.0)?;
    /// let west = Path::<f64, 1>::starting_at(pose(6.0, 0.801, core::f64::consts::PI))?.line(6.0)?;
    /// let truck = Outline::<f64, 4>::rectangle(0.6, 0.6, 0.4, 0.4, 0.0)?;
    /// let profile = Profile::rest_to_rest(6.0, Limits { speed: 1.0, acceleration: 1.0 })?;
    /// let motion = |path| Motion::with_outline(path, profile.as_profile(), &truck, 0.0);
    /// let fleet = [motion(east.as_path())?, motion(west.as_path())?];
    /// assert!(Ecm::build([EcmEntry::EMPTY; 1], [Piece::EMPTY; 4], &fleet)?.is_empty());
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[cfg(feature = "outlines")]
    pub fn with_outline(
        path: PathRef<'a, S>,
        profile: ProfileRef<'a, S>,
        outline: impl Into<OutlineRef<'a, S>>,
        start: S,
    ) -> Result<Self, InvalidInput> {
        Self::of(path, profile, outline.into(), start)
    }

    pub(crate) fn of(
        path: PathRef<'a, S>,
        profile: ProfileRef<'a, S>,
        outline: OutlineRef<'a, S>,
        start: S,
    ) -> Result<Self, InvalidInput> {
        check_times(profile, start)?;
        let motion = Self::accepted(path, profile, outline, start);
        motion.check()?;
        Ok(motion)
    }

    /// The motion of what [`Motion::of`] has accepted before.
    // Not inlined: both callers would have a copy of it.
    #[cfg_attr(not(feature = "std"), inline(never))]
    pub(crate) fn accepted(
        path: PathRef<'a, S>,
        profile: ProfileRef<'a, S>,
        outline: OutlineRef<'a, S>,
        start: S,
    ) -> Self {
        let (radius, corners, spread) = (outline.radius(), outline.corners(), outline.spread());
        let time = travel_time(profile, start);
        let bounds = path.bounds();
        let extent = bounds.extent().max(path.length()) + radius.double();
        // `fold`, because `Iterator::count` contains an overflow check, which can panic.
        let (arcs, diameter) =
            path.segments().iter().fold((0_usize, S::ZERO), |(arcs, most), segment| match segment.curve().lever() {
                None => (arcs, most),
                Some(lever) => (arcs.saturating_add(1), most.max(lever.double())),
            });
        #[cfg(feature = "outlines")]
        let outlined =
            !corners.is_empty() || path.segments().iter().any(|segment| matches!(segment.curve(), Curve::Pivot { .. }));
        let drift = S::drift(arcs, extent + diameter);
        let top_speed = profile.top_speed();
        let allowance = S::lag(top_speed, profile.duration()) + gap(path, profile);
        let (margin, lateness, lever) = (S::ZERO, S::ZERO, S::ZERO);
        let digest = path.digest();
        let disc = Self {
            path,
            profile,
            radius,
            corners,
            spread,
            reach: outline.reach(),
            lever,
            #[cfg(feature = "outlines")]
            outlined,
            margin,
            time,
            lateness,
            bounds,
            extent,
            drift,
            allowance,
            top_speed,
            digest,
        };
        if disc.has_outline() { disc.extended(diameter) } else { disc }
    }

    /// Whether it may be used: its lengths agree, and rounding leaves it what its outline needs.
    fn check(&self) -> Result<(), InvalidInput> {
        let Self { path, profile, .. } = *self;
        let extent = self.bounds.extent().max(path.length()) + self.radius.double();
        let share = (LENGTH_TOLERANCE_LOG2..0).fold(path.length(), |length, _| length.half());
        if gap(path, profile) > S::slack(extent).max(share) {
            let [path, profile] = [path.length(), profile.length()].map(S::millimetres);
            return Err(InvalidInput::LengthMismatch { path, profile });
        }
        if self.has_outline() { self.check_outline() } else { Ok(()) }
    }

    /// Completes the motion of an outline, or of a disc that turns in place: what rounding does to its corners, and its checksum.
    // Not inlined: other discs do not need it.
    #[inline(never)]
    fn extended(self, diameter: S) -> Self {
        // Corners are placed by their vectors from the centre of an arc. The length of a turn is that at its lever.
        let extent = self.extent + self.spread.double() + diameter;
        let segments = self.path.segments();
        let turning = segments.iter().filter(|segment| !segment.is_steady());
        let levers = turning.filter_map(|segment| segment.curve().lever());
        let lever = levers.map(|lever| self.spread.quotient(lever)).fold(S::ZERO, S::max);
        let levered = |length: S| length + length.times(lever).narrow();
        // The heading of the body behind a steady arc is rounded, and turns all corners that follow.
        let steady = segments.iter().filter(|segment| segment.is_steady());
        let turned = steady.fold(S::ZERO, |sum, _| sum + S::rounding(self.spread).double().double().double());
        let drift = levered(self.drift) + S::slack(extent).times(lever).narrow() + turned;
        let allowance = levered(self.allowance);
        let has_corners = !self.corners.is_empty();
        let corners = self.corners.iter().flat_map(|corner| [corner.at.x, corner.at.y]);
        let bodies = segments.iter().map(Segment::body).filter(|_| has_corners).flat_map(|body| {
            let ahead = body.vector(self.spread, S::ZERO);
            [ahead.x, ahead.y]
        });
        let sum = corners.chain(bodies).fold(self.digest, |sum, coordinate| digest(sum, coordinate.digest()));
        let steady = segments.iter().map(Segment::is_steady).enumerate().filter(|&(_, steady)| steady && has_corners);
        let digest = steady.fold(sum, |sum, (place, _)| digest(sum, place as u32));
        Self { extent, lever, drift, allowance, digest, ..self }
    }

    /// Whether rounding could move a corner too far, and whether the outline would sweep an area where the path turns without a length.
    #[inline(never)]
    fn check_outline(&self) -> Result<(), InvalidInput> {
        in_range(self.extent, "extent of the motion")?;
        let (has_corners, slack) = (!self.corners.is_empty(), S::slack(self.extent));
        let rounding = slack + self.drift + self.allowance;
        if has_corners && rounding.double().double().double().double() > self.spread + self.radius {
            return Err(InvalidInput::Lever);
        }
        // A turn that moves no corner by more than rounding does is none.
        let fine = slack.half().half();
        let segments = self.path.segments();
        let next = segments.iter().skip(1).map(Some).chain([None]);
        if has_corners && segments.iter().zip(next).any(|(own, next)| own.jumps_before(next, self.spread, fine)) {
            return Err(InvalidInput::TurnInPlace);
        }
        Ok(())
    }

    /// Returns the motion with a margin \[m\] around the disc, for localization errors, latency or comfort. Margins do not
    /// change regions of contact; regions in which margins overlap are those of [`Motion::inflated`] motions.
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`] (also for radius and margin together), [`InvalidInput::Negative`].
    pub fn with_margin(self, margin: S) -> Result<Self, InvalidInput> {
        not_negative(margin, "margin")?;
        in_range(self.radius + margin, "radius with its margin")?;
        Ok(Self { margin, ..self })
    }

    /// Returns the motion of an agent that may be late by up to `lateness` \[s\]: at any time it is at a place where the
    /// motion has been at some time within the last `lateness` seconds. Queries for planning take this into account,
    /// for the ego and for the others: blocked windows and safe intervals, forbidden delays, durations and waits, speed
    /// plans. Regions, conflicts and the closest approach are still those of the motion itself.
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`], [`InvalidInput::Negative`].
    pub fn with_lateness(self, lateness: S) -> Result<Self, InvalidInput> {
        not_negative(lateness, "lateness")?;
        Ok(Self { lateness, ..self })
    }

    /// Largest lateness of the agent \[s\].
    pub fn lateness(&self) -> S {
        self.lateness
    }

    /// Returns the motion of a disc that is larger by the margin, with a margin of 0. A table of such motions holds the
    /// regions in which margins overlap; keep it beside the table of contacts.
    ///
    /// ```
    /// # use pcr_core::{Ecm, Limits, Motion, Path, Piece, Point, Pose, Profile, Radians, EcmEntry};
    /// # let pose = |y, heading| Pose { position: Point::new(-2.0, y), heading: Radians(heading) };
    /// let lanes = [Path::<f64, 1>::starting_at(pose(0.0, 0.0))?.line(4.0)?, Path::starting_at(pose(0.6, 0.0))?.line(4.0)?];
    /// # let profile = Profile::rest_to_rest(4.0, Limits { speed: 1.0, acceleration: 1.0 })?;
    /// # let motion = |path| Motion::new(path, profile.as_profile(), 0.25, 0.0)?.with_margin(0.1);
    /// let fleet = [motion(lanes[0].as_path())?, motion(lanes[1].as_path())?]; // radius 0.25 m, margin 0.1 m
    /// let contact = Ecm::build([EcmEntry::EMPTY; 1], [Piece::EMPTY; 1], &fleet)?;
    /// assert!(contact.is_empty()); // they pass, 0.1 m apart
    ///
    /// let inflated = fleet.map(|motion| motion.inflated());
    /// let margin = Ecm::build([EcmEntry::EMPTY; 1], [Piece::EMPTY; 1], &inflated)?;
    /// assert_eq!(margin.len(), 1); // but not 0.2 m
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    pub fn inflated(self) -> Self {
        let [radius, reach] = [self.radius, self.reach].map(|radius| radius + self.margin);
        Self { radius, reach, extent: self.extent + self.margin.double(), margin: S::ZERO, ..self }
    }

    /// Returns the motion of the disc on its path with another profile and start time \[s\]. A table of the motion holds for it, too, unless its
    /// [`Motion::lag`] is larger than that for which the regions were computed ([`Motion::with_longest`]).
    ///
    /// # Errors
    /// As [`Motion::new`].
    pub fn with_profile(self, profile: ProfileRef<'a, S>, start: S) -> Result<Self, InvalidInput> {
        let motion = Self::of(self.path, profile, self.outline(), start)?;
        let allowance = self.allowance.max(motion.allowance);
        Self { allowance, ..motion }.with_margin(self.margin)?.with_lateness(self.lateness)
    }

    /// Returns the motion whose regions also hold for profiles that take up to `longest` \[s\] and are not faster
    /// ([`Motion::with_profile`]). Their error bound ([`excess`](crate::excess)) grows with that time, in fixed point not. For plans in which
    /// agents wait, give it to the motions before the table is made.
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`], [`InvalidInput::Negative`].
    pub fn with_longest(self, longest: S) -> Result<Self, InvalidInput> {
        not_negative(longest, "longest duration")?;
        let lag = self.levered(S::lag(self.top_speed, longest) + gap(self.path, self.profile));
        in_range(lag, "lag")?;
        Ok(Self { allowance: self.allowance.max(lag), ..self })
    }

    /// Returns the motion later by `delay` \[s\].
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`].
    pub fn delayed(self, delay: S) -> Result<Self, InvalidInput> {
        in_range(delay, "delay")?;
        let start = self.time.lo + delay;
        check_times(self.profile, start)?;
        Ok(Self { time: travel_time(self.profile, start), ..self })
    }

    /// The interval from the first start to the last arrival of a fleet \[s\]; outside of it nothing moves. From 0 to 0
    /// for an empty fleet.
    ///
    /// ```
    /// # use pcr_core::{Interval, Motion, Path, Point, Pose, Profile, Radians};
    /// # let start = Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) };
    /// # let path = Path::<f64, 1>::starting_at(start)?.line(4.0)?;
    /// # let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
    /// # let motion = |start| Motion::new(path.as_path(), profile.as_profile(), 0.25, start);
    /// let fleet = [motion(1.0)?, motion(6.5)?]; // four seconds each
    /// assert_eq!(Motion::span(&fleet), Interval::new(1.0, 10.5));
    /// # Ok::<(), pcr_core::InvalidInput>(())
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

    /// Radius of the disc, or of the disc about the reference point that contains the outline \[m\].
    #[expect(clippy::misnamed_getters, reason = "the field of this name is the radius of the rounding")]
    pub fn radius(&self) -> S {
        self.reach
    }

    /// Returns the outline. It has no corners if it is a disc about the reference point.
    pub fn outline(&self) -> OutlineRef<'a, S> {
        OutlineRef::of(self.corners, self.radius, self.spread)
    }

    /// Whether the agent takes the kernels of outlines: it is not a disc about its reference point, or it turns in place.
    pub(crate) fn has_outline(&self) -> bool {
        #[cfg(feature = "outlines")]
        return self.outlined;
        #[cfg(not(feature = "outlines"))]
        false
    }

    /// Radius of the disc, or of the rounding of the outline \[m\].
    pub(crate) fn rounding_radius(&self) -> S {
        self.radius
    }

    /// Margin around the disc \[m\].
    pub fn margin(&self) -> S {
        self.margin
    }

    /// The interval from the start to the arrival \[s\]; the arrival is rounded up.
    pub fn time(&self) -> Interval<S> {
        self.time
    }

    /// Box around the path \[m\], without the radius.
    pub fn bounds(&self) -> Aabb<S> {
        self.bounds
    }

    /// Whether it has the path of the other motion, and a disc that is not larger.
    pub(crate) fn is_within(&self, other: &Self) -> bool {
        self.digest == other.digest && self.radius <= other.radius
    }

    /// Whether it is the same disc on the same path.
    pub(crate) fn is_same_disc(&self, other: &Self) -> bool {
        self.digest == other.digest && self.radius == other.radius
    }

    /// A checksum of all that the regions of this agent depend on: path, radius, the lag for which they hold, and its index in the fleet.
    pub(crate) fn digest(&self, place: usize) -> u32 {
        // All of it goes into the checksum as one number, because every query checks the whole fleet. Index and lag are
        // multiplied, so that exchanging two agents cannot cancel a change of radius, and a change of radius not one of the lag.
        let [place, allowance] =
            [(place as u32).wrapping_mul(0x9E37_79B9), self.allowance.digest().wrapping_mul(0x85EB_CA6B)];
        digest(self.digest, self.radius.digest() ^ place ^ allowance)
    }

    /// Box around the area that the disc sweeps, expanded by twice the rounding error of a distance \[m\]. Agents whose
    /// boxes do not meet have no region.
    pub(crate) fn swept(&self) -> Aabb<S> {
        let slack = S::slack(self.extent) + self.drift + self.allowance;
        self.bounds.expanded(self.reach + slack.double())
    }

    /// Largest coordinate or length of the motion, plus the diameter of the disc \[m\]. Rounding errors grow with it.
    pub fn extent(&self) -> S {
        self.extent
    }

    /// Largest distance of the path from its exact place because of rounding, which accumulates arc by arc \[m\].
    pub(crate) fn drift(&self) -> S {
        self.drift
    }

    /// Largest distance of the agent from its exact place at a time \[m\], because of the rounding of times and the
    /// difference between the lengths of profile and path.
    pub fn lag(&self) -> S {
        self.levered(S::lag(self.top_speed, self.profile.duration()) + gap(self.path, self.profile))
    }

    /// How far a corner moves at most while the reference point moves by a length \[m\].
    pub(crate) fn levered(&self, length: S) -> S {
        if self.has_outline() { length + length.times(self.lever).narrow() } else { length }
    }

    /// Largest lag for which the regions of the motion hold \[m\], at least its own.
    pub(crate) fn allowance(&self) -> S {
        self.allowance
    }

    /// Largest distance of the agent from both ends of a segment that it passes at a single time \[m\]: a quarter of
    /// the distance that it goes at top speed in the rounding error of a time. 0 in a format of relative precision,
    /// where `reach` covers the error of times.
    pub(crate) fn leap(&self) -> S {
        self.levered(self.top_speed.times(S::slack(S::ZERO)).narrow().half().half())
    }

    /// Distance that the agent goes at its top speed during a time that contains its motion and the time 0 \[m\].
    pub(crate) fn reach(&self) -> S {
        self.way_until(self.latest())
    }

    /// Distance that the agent goes at its top speed during such a time \[s\] \[m\].
    pub(crate) fn way_until(&self, latest: S) -> S {
        self.levered(self.top_speed.times(latest).narrow())
    }

    /// The same motion of a disc that is larger by a few rounding errors \[m\], for a search that has to leave room for them.
    pub(crate) fn enlarged(&self, by: S) -> Self {
        Self { radius: self.radius + by, reach: self.reach + by, ..*self }
    }

    /// λ: length travelled at a time \[m\], clamped to the length of the path.
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

    /// The corners of the outline at a time, relative to a point.
    pub(crate) fn corners_at(&self, time: S, from: Point<S>) -> Corners<S> {
        match self.path.locate(self.length_at(time)) {
            Some((segment, length)) => Carried::new(segment, self.outline()).at(length, from),
            None => Corners::new(Corner::CENTRE),
        }
    }

    /// The times \[s\] at which the travelled length is in the interval `length`. They are rounded outward by at most
    /// [`Motion::time_excess`], plus, where the agent almost stands, the time that it needs for the rounding error of
    /// its lengths; but not beyond [`Motion::time`].
    pub fn time_in(&self, length: Interval<S>) -> Interval<S> {
        let Interval { lo: start, hi: arrival } = self.time;
        let lo = if length.lo > S::ZERO { start + self.profile.first_time_at(length.lo) } else { start };
        let hi = if length.hi < self.path.length() { start + self.profile.last_time_at(length.hi) } else { arrival };
        Interval::new(lo, hi).widen(self.time_slack(), self.time)
    }

    /// Largest excess of a time of [`Motion::time_in`] over the exact time of the lengths of the motion \[s\].
    pub fn time_excess(&self) -> S {
        self.time_slack().double()
    }

    /// Bound on the rounding error of the sum of the start time and the time since the start.
    fn time_slack(&self) -> S {
        let rounding = S::rounding(self.latest());
        rounding.double() + rounding
    }

    /// The largest magnitude of a time of the motion \[s\].
    pub(crate) fn latest(&self) -> S {
        self.time.lo.abs().max(self.time.hi.abs())
    }
}

/// Difference of the lengths of path and profile \[m\].
fn gap<S: Scalar>(path: PathRef<'_, S>, profile: ProfileRef<'_, S>) -> S {
    (profile.length() - path.length()).abs()
}

/// Whether the times of a motion that sets off at `start` are in range.
fn check_times<S: Scalar>(profile: ProfileRef<'_, S>, start: S) -> Result<(), InvalidInput> {
    in_range(start, "start time")?;
    in_range(start + profile.duration(), "end time").map(drop)
}

/// The interval from the start to the arrival; the arrival is rounded up.
fn travel_time<S: Scalar>(profile: ProfileRef<'_, S>, start: S) -> Interval<S> {
    Interval::new(start, start.sum_up(profile.duration()))
}
