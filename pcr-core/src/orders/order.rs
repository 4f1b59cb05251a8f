//! Who passes a region first, and what is known of agents.

use crate::geometry::Interval;
use crate::motion::Motion;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// Whether an agent passes a region first or second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Pass {
    /// Not decided yet: both have to stay before the region.
    #[default]
    Undecided,
    /// It goes first, and the other one waits.
    First,
    /// It waits until the other one is through.
    Second,
    /// One of the two has left the region behind: it is nothing to anybody any more.
    Over,
}

impl Pass {
    /// The same as the other agent sees it.
    #[must_use]
    pub fn swapped(self) -> Self {
        match self {
            Self::First => Self::Second,
            Self::Second => Self::First,
            same => same,
        }
    }

    /// As seen by the other agent, if `swapped`.
    pub(super) fn swapped_if(self, swapped: bool) -> Self {
        if swapped { self.swapped() } else { self }
    }
}

/// What is known of an agent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Progress<S> {
    /// Where it is on its path \[m\]. The lower end may be old: it counts for what it has passed.
    pub at: Interval<S>,
    /// Where it can be at rest at the latest \[m\], the upper end of `at` or more. What it has promised not to go beyond
    /// counts, too.
    pub stop: S,
}

impl<S: Scalar> Progress<S> {
    /// At rest at a length that is known exactly \[m\].
    pub fn at_rest(length: S) -> Self {
        Self { at: Interval::new(length, length), stop: length }
    }

    /// Whether it has left a region of these lengths of its path behind for sure.
    pub(super) fn is_beyond(&self, lengths: Interval<S>, motion: &Motion<'_, S>) -> bool {
        self.at.lo > exit(lengths, motion)
    }
}

/// An entry of the table [`Orders`](crate::Orders): who passes a region first. 20 bytes for `f32`, 40 for `f64`.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Order<S> {
    /// As the agent of the lower index sees it.
    pub(super) pass: Pass,
    /// Whether the other way round is possible, too, and has not been tried yet.
    pub(super) open: bool,
    /// From which length of the second on the region counts \[m\]: what is behind it is passed.
    pub(super) since: S,
    /// Least length of the second in it \[m\].
    pub(super) entry: S,
    /// Largest length of the first in it \[m\], out of reach if it holds the end of its path.
    pub(super) exit: S,
    /// How far a check has found the second to get past it \[m\].
    pub(super) hold: S,
}

const _: () = assert!(size_of::<Order<f32>>() == 20, "the documented size of an order");
const _: () = assert!(size_of::<Order<f64>>() == 40, "the documented size of an order");

impl<S: Scalar> Order<S> {
    /// No order, to fill a storage with.
    pub const EMPTY: Self =
        Self { pass: Pass::Undecided, open: false, since: S::ZERO, entry: S::ZERO, exit: S::ZERO, hold: S::ZERO };

    /// The order in which the ego of a region is first or second; what is behind `since` of the second does not count.
    pub(super) fn new(region: &RegionRef<'_, S>, pass: Pass, since: S) -> Self {
        let (second, exit) = match pass {
            Pass::First => (region.other_length(), exit(region.length(), region.ego_motion())),
            _ => (region.length(), exit(region.other_length(), region.other_motion())),
        };
        let transposed = region.ego() > region.other();
        Self { pass: pass.swapped_if(transposed), since, entry: second.lo, exit, ..Self::EMPTY }
    }

    /// Whether the second is held nowhere before the entry: it cannot be inside.
    pub(super) fn bounds_from_entry(&self) -> bool {
        self.entry >= self.since && self.entry > S::ZERO
    }

    /// As this agent of the pair sees it.
    pub(super) fn pass_of(&self, agent: usize, [_, higher]: [usize; 2]) -> Pass {
        self.pass.swapped_if(agent == higher)
    }
}

/// Where an agent has left a region of these lengths: never if it holds the end of its path, whatever rounding says.
fn exit<S: Scalar>(lengths: Interval<S>, motion: &Motion<'_, S>) -> S {
    if lengths.hi < motion.path().length() { lengths.hi } else { S::LIMIT }
}

impl<S: Scalar> Default for Order<S> {
    fn default() -> Self {
        Self::EMPTY
    }
}
