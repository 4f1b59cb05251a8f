//! Types for the order in which agents pass a region, and for the progress of an agent.

use crate::geometry::Interval;
use crate::motion::Motion;
use crate::precedence::authority::MovementAuthority;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// Whether an agent passes a region first or second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum PassingState {
    /// Not decided yet: both agents have to stay before the region, unless one of them has left it.
    #[default]
    Undecided,
    /// The agent goes first, and the other one waits.
    First,
    /// The agent waits until the other one has left the region.
    Second,
    /// One of the two agents has left the region: it no longer restricts either of them.
    Over,
}

impl PassingState {
    /// The same order seen by the other agent.
    #[must_use]
    pub fn swapped(self) -> Self {
        match self {
            Self::First => Self::Second,
            Self::Second => Self::First,
            same => same,
        }
    }

    /// The order seen by the other agent if `swapped`.
    pub(super) fn swapped_if(self, swapped: bool) -> Self {
        if swapped { self.swapped() } else { self }
    }
}

/// What is known about the progress of an agent.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Progress<S> {
    /// Where the agent is on its path \[m\]. The lower end may be out of date; it decides which regions the agent has
    /// left.
    pub at: Interval<S>,
    /// The furthest length at which the agent can come to rest \[m\], at least the upper end of `at`. If it has
    /// promised not to go beyond a length, it is that length.
    pub stop: S,
}

impl<S: Scalar> Progress<S> {
    /// At rest at an exactly known length \[m\].
    pub fn at_rest(length: S) -> Self {
        Self { at: Interval::new(length, length), stop: length }
    }

    /// The furthest length at which the agent can come to rest \[m\], also if `stop` was given less than its place.
    pub(super) fn furthest(&self) -> S {
        self.stop.max(self.at.hi)
    }

    /// The lower end of the place \[m\], at most the value that [`exit`] uses for "never". NaN is kept: no comparison
    /// then says that a region was passed.
    pub(super) fn known(&self) -> S {
        self.at.lo.min(S::LIMIT)
    }

    /// That of an agent: without an entry, the agent is at the start of its path.
    pub(super) fn of(progress: &[Self], agent: usize) -> Self {
        progress.get(agent).copied().unwrap_or_default()
    }

    /// Whether the agent has certainly left a region with these lengths of its path.
    pub(super) fn is_beyond(&self, lengths: Interval<S>, motion: &Motion<'_, S>) -> bool {
        self.known() > exit(lengths, motion)
    }
}

impl<S: Scalar> RegionRef<'_, S> {
    /// Whether one of the two agents has certainly left the region.
    pub(super) fn is_over(&self, progress: &[Progress<S>]) -> bool {
        let [own, their] = [self.ego(), self.other()].map(|agent| Progress::of(progress, agent));
        own.is_beyond(self.length(), self.ego_motion()) || their.is_beyond(self.other_length(), self.other_motion())
    }

    /// How far the ego may go while nobody has decided who goes first: neither agent may enter the region, until one of
    /// them has left it.
    pub(super) fn hold_undecided(&self, progress: &[Progress<S>]) -> MovementAuthority<S> {
        if self.is_over(progress) { MovementAuthority::Free } else { self.hold(S::ZERO, S::ZERO) }
    }
}

/// An entry of the table [`PrecedenceTable`](crate::PrecedenceTable): which agent passes a region first. 20 bytes for `f32`, 40 for
/// `f64`.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct RegionPrecedence<S> {
    /// The order seen by the agent with the lower index.
    pub(super) pass: PassingState,
    /// Whether the reversed order is possible, too, and has not been tried yet.
    pub(super) open: bool,
    /// Length of the second agent from which on the region counts \[m\]; what is behind it has been passed.
    pub(super) since: S,
    /// Least length of the second agent in the region \[m\].
    pub(super) entry: S,
    /// Largest length of the first agent in the region \[m\]; unreachable if the region contains the end of its path.
    pub(super) exit: S,
    /// Hold of the second agent at this region, as last computed by a check \[m\].
    pub(super) hold: S,
}

const _: () = assert!(size_of::<RegionPrecedence<f32>>() == 20, "the documented size of an order");
const _: () = assert!(size_of::<RegionPrecedence<f64>>() == 40, "the documented size of an order");

impl<S: Scalar> RegionPrecedence<S> {
    /// No order: an entry to fill a storage with.
    pub const EMPTY: Self = Self {
        pass: PassingState::Undecided,
        open: false,
        since: S::ZERO,
        entry: S::ZERO,
        exit: S::ZERO,
        hold: S::ZERO,
    };

    /// The order in which the ego of a region goes first or second. Lengths of the second agent below `since` do not
    /// count.
    pub(super) fn new(region: &RegionRef<'_, S>, pass: PassingState, since: S) -> Self {
        let (second, exit) = match pass {
            PassingState::First => (region.other_length(), exit(region.length(), region.ego_motion())),
            _ => (region.length(), exit(region.other_length(), region.other_motion())),
        };
        let transposed = region.ego() > region.other();
        Self { pass: pass.swapped_if(transposed), since, entry: second.lo, exit, ..Self::EMPTY }
    }

    /// Whether the hold of the second agent is at least `entry`, because the agent cannot be inside the region.
    pub(super) fn bounds_from_entry(&self) -> bool {
        self.entry >= self.since && self.entry > S::ZERO
    }

    /// The order seen by this agent of the pair.
    pub(super) fn pass_of(&self, agent: usize, [_, higher]: [usize; 2]) -> PassingState {
        self.pass.swapped_if(agent == higher)
    }
}

/// The other agent of a pair.
pub(super) fn other(agents: [usize; 2], agent: usize) -> usize {
    if agents[0] == agent { agents[1] } else { agents[0] }
}

/// The length at which an agent has left a region with these lengths: never, if the region contains the end of its
/// path, whatever rounding does.
fn exit<S: Scalar>(lengths: Interval<S>, motion: &Motion<'_, S>) -> S {
    if lengths.hi < motion.path().length() { lengths.hi } else { S::LIMIT }
}

impl<S: Scalar> Default for RegionPrecedence<S> {
    fn default() -> Self {
        Self::EMPTY
    }
}
