//! The data that a speed plan stores for each border of cells along the path.

use crate::plan::lattice::LEVELS;
use crate::plan::time_set::TimeSet;
use crate::scalar::Scalar;

/// A border of two cells of the path, or one of its ends: an entry of the storage of [`plan_speed`](crate::plan_speed).
#[derive(Clone, Debug)]
pub struct SearchNode<S> {
    /// Length along the path \[m\].
    pub(super) length: S,
    /// Times at which the agent can be here with each speed \[s\].
    pub(super) reached: [TimeSet<S>; LEVELS],
    /// Index of the speed that was chosen.
    pub(super) level: usize,
    /// Time at which the agent leaves \[s\].
    pub(super) leaves: S,
}

#[cfg(feature = "defmt")]
impl<S: Scalar + defmt::Format> defmt::Format for SearchNode<S> {
    fn format(&self, f: defmt::Formatter<'_>) {
        defmt::write!(f, "station at {} m, left at {} s", self.length, self.leaves);
    }
}

impl<S: Scalar> SearchNode<S> {
    /// An unused entry, to fill a storage with.
    pub const EMPTY: Self =
        Self { length: S::ZERO, reached: [const { TimeSet::NONE }; LEVELS], level: 0, leaves: S::ZERO };

    /// The times for a speed. At the ends of the path there is only one speed; its times are returned for any index.
    pub(super) fn reached(&self, level: usize) -> Option<&TimeSet<S>> {
        self.reached.get(level).or(self.reached.first())
    }

    pub(super) fn reached_mut(&mut self, level: usize) -> Option<&mut TimeSet<S>> {
        if level < LEVELS { self.reached.get_mut(level) } else { self.reached.first_mut() }
    }

    pub(super) fn clear(&mut self) {
        self.reached.iter_mut().for_each(TimeSet::clear);
    }
}

impl<S: Scalar> Default for SearchNode<S> {
    fn default() -> Self {
        Self::EMPTY
    }
}
