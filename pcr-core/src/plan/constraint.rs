//! Constraints on one agent, as a search over a fleet puts them: where it must not be when, and who passes a region first.

use crate::error::Invalid;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::query::times;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// Lengths of its path at which an agent must not be in an interval of time; on the border of both it may. What conflict-based search
/// adds to an agent to resolve a conflict (Sharon et al. 2015), with intervals in place of vertices and time steps (Andreychuk et al. 2022).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Constraint<S> {
    /// Along the path \[m\].
    pub length: Interval<S>,
    /// When \[s\].
    pub time: Interval<S>,
}

impl<S: Scalar> Constraint<S> {
    /// The ego passes the region before the other agent does: it is not at these lengths from when the other one comes.
    pub fn before(region: &RegionRef<'_, S>) -> Self {
        Self { length: region.length(), time: Interval::new(region.time().lo, S::LIMIT) }
    }

    /// The ego passes the region after the other agent: it is not at these lengths until the other one has left, never if that stays
    /// there.
    pub fn after(region: &RegionRef<'_, S>) -> Self {
        let left = if region.is_open_at_end() { S::LIMIT } else { region.time().hi };
        Self { length: region.length(), time: Interval::new(-S::LIMIT, left) }
    }

    /// Whether both are intervals.
    pub(super) fn checked(&self) -> Result<(), Invalid> {
        let is_one = |all: Interval<S>| all.lo <= all.hi;
        if is_one(self.length) && is_one(self.time) { Ok(()) } else { Err(Invalid::OutOfRange("constraint")) }
    }

    /// Whether a motion is on these lengths at such times, from its start on, by more than rounding.
    pub(super) fn is_broken_by(&self, motion: &Motion<'_, S>) -> bool {
        let latest = motion.time().lo.abs().max(motion.time().hi.abs());
        let [length, time] = [motion.path().length(), latest].map(|extent| S::tolerance(extent).double());
        let inside = Interval::new(self.length.lo + length, self.length.hi - length);
        let during = Interval::new(self.time.lo.max(motion.time().lo) + time, self.time.hi - time);
        inside.lo <= inside.hi && during.lo <= during.hi && times(motion, inside, during).is_some()
    }
}
