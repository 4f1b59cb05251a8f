//! Constraints on one agent, as a search over a fleet adds them: lengths that it must avoid during a time, or which
//! agent passes a region first.

use crate::error::InvalidInput;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::query::times;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// Lengths of its path, ends included, at which an agent must not be during an interval of time. At the two ends of the
/// interval it may be there, so an interval of length 0 forbids nothing. Conflict-based search adds such constraints to
/// an agent to resolve a conflict (Sharon et al. 2015), here with intervals in place of vertices and time steps
/// (Andreychuk et al. 2022).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Constraint<S> {
    /// Lengths along the path \[m\].
    pub length: Interval<S>,
    /// Times \[s\]; ends beyond [`Scalar::LIMIT`] stand for no end.
    pub time: Interval<S>,
}

impl<S: Scalar> Constraint<S> {
    /// The ego passes the region before the other agent: it is not at these lengths from the time at which the other
    /// agent arrives there, or at all if the other agent starts there. The lateness of both counts.
    pub fn before(region: &RegionRef<'_, S>) -> Self {
        let arrives = if region.is_open_at_start() { -S::LIMIT } else { region.with_lateness(region.time()).lo };
        Self { length: region.length(), time: Interval::new(arrives, S::LIMIT) }
    }

    /// The ego passes the region after the other agent: it is not at these lengths until the other agent has left them,
    /// or at all if the other agent ends its path there. The lateness of both counts.
    pub fn after(region: &RegionRef<'_, S>) -> Self {
        let left = if region.is_open_at_end() { S::LIMIT } else { region.with_lateness(region.time()).hi };
        Self { length: region.length(), time: Interval::new(-S::LIMIT, left) }
    }

    /// Checks that both are valid intervals.
    pub(super) fn checked(&self) -> Result<(), InvalidInput> {
        let is_one = |all: Interval<S>| all.lo <= all.hi;
        if is_one(self.length) && is_one(self.time) { Ok(()) } else { Err(InvalidInput::OutOfRange("constraint")) }
    }

    /// The times, within those that motions have.
    pub(super) fn during(&self) -> Interval<S> {
        self.time.limited()
    }

    /// Whether an agent that stands at its start from the time `from` \[s\] and then moves by `motion` is on these
    /// lengths at these times, by more than two [`Interval::resolution`] of its times.
    pub(super) fn is_broken_by(&self, motion: &Motion<'_, S>, from: S) -> bool {
        let rounding = Interval::new(from.min(motion.time().lo), motion.time().hi).resolution().double();
        let time = self.during();
        let during = Interval::new(time.lo.max(from) + rounding, time.hi - rounding);
        during.lo <= during.hi && times(motion, self.length, during).is_some()
    }
}
