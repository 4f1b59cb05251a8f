//! An agent in motion: a disc, its path, and when it is where on it (Eq. 2, ρ ∘ λ).

use crate::error::{Invalid, in_range, positive};
use crate::geometry::{Bounds, Interval, Point};
use crate::path::PathRef;
use crate::profile::ProfileRef;
use crate::scalar::Scalar;

/// A disc on a path with a speed profile. It stands at the start of the path before it sets off, and at the
/// end of it after its arrival.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a, S: Scalar> {
    path: PathRef<'a, S>,
    profile: ProfileRef<'a, S>,
    radius: S,
    start: S,
    bounds: Bounds<S>,
    extent: S,
}

impl<'a, S: Scalar> Motion<'a, S> {
    /// The motion of a disc of this radius \[m\] that sets off at the time `start` \[s\].
    ///
    /// # Errors
    /// [`Invalid::NonFinite`], [`Invalid::OutOfRange`], [`Invalid::NonPositive`] (radius) and
    /// [`Invalid::LengthMismatch`] where the profile does not travel the length of the path (rounding aside).
    pub fn new(path: PathRef<'a, S>, profile: ProfileRef<'a, S>, radius: S, start: S) -> Result<Self, Invalid> {
        positive(radius, "radius")?;
        in_range(start, "start time")?;
        in_range(start + profile.duration(), "end time")?;
        let bounds = path.bounds();
        let extent = bounds.extent().max(path.length()) + radius;
        if (profile.length() - path.length()).abs() > S::slack(extent) {
            return Err(Invalid::LengthMismatch);
        }
        Ok(Self { path, profile, radius, start, bounds, extent })
    }

    /// The same motion, later by `delay` \[s\].
    ///
    /// # Errors
    /// [`Invalid::NonFinite`], [`Invalid::OutOfRange`].
    pub fn delayed(self, delay: S) -> Result<Self, Invalid> {
        in_range(delay, "delay")?;
        let start = in_range(self.start + delay, "start time")?;
        in_range(start + self.profile.duration(), "end time")?;
        Ok(Self { start, ..self })
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

    /// From setting off to arrival \[s\].
    pub fn time(&self) -> Interval<S> {
        Interval::new(self.start, self.start + self.profile.duration())
    }

    /// Box around the path \[m\], radius not included.
    pub fn bounds(&self) -> Bounds<S> {
        self.bounds
    }

    /// Largest coordinate or length that belongs to the motion, plus its radius \[m\]: what errors grow with.
    pub fn extent(&self) -> S {
        self.extent
    }

    /// λ: length travelled at a time \[m\], limited to the length of the path.
    pub fn length_at(&self, time: S) -> S {
        let end = self.path.length();
        if time >= self.time().hi { end } else { self.profile.length_at(time - self.start).min(end) }
    }

    /// Speed at a time \[m/s\].
    pub fn speed_at(&self, time: S) -> S {
        self.profile.speed_at(time - self.start)
    }

    /// Position of the centre at a time.
    pub fn position_at(&self, time: S) -> Point<S> {
        self.path.point_at(self.length_at(time))
    }

    /// When the travelled length lies in `length` \[s\]: the times are rounded outward, but not beyond
    /// [`Motion::time`].
    pub fn time_in(&self, length: Interval<S>) -> Interval<S> {
        let travel = self.time();
        let lo = if length.lo > S::ZERO { self.start + self.profile.first_time_at(length.lo) } else { travel.lo };
        let hi =
            if length.hi < self.path.length() { self.start + self.profile.last_time_at(length.hi) } else { travel.hi };
        Interval::new(lo, hi).widen(S::slack(travel.lo.abs().max(travel.hi.abs())), travel)
    }
}
