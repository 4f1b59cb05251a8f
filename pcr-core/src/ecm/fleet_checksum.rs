//! A checksum that identifies the fleet of a table. A sum, so that one agent can be taken out and put in again.

use crate::motion::Motion;
use crate::scalar::Scalar;

/// The fleet of a table: the number of its agents, and the sum of their checksums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FleetChecksum {
    agents: usize,
    sum: u32,
}

impl FleetChecksum {
    pub(super) const NOBODY: Self = Self { agents: 0, sum: 0 };

    pub(super) fn all<'m, S: Scalar + 'm>(fleet: impl IntoIterator<Item = &'m Motion<'m, S>>) -> Self {
        fleet.into_iter().fold(Self::NOBODY, |known, motion| known.with(known.agents, motion))
    }

    pub(super) fn with<S: Scalar>(self, agent: usize, motion: &Motion<'_, S>) -> Self {
        let sum = self.sum.wrapping_add(motion.digest(agent));
        Self { agents: self.agents.wrapping_add(1), sum }
    }

    pub(super) fn without<S: Scalar>(self, agent: usize, motion: &Motion<'_, S>) -> Self {
        let sum = self.sum.wrapping_sub(motion.digest(agent));
        Self { agents: self.agents.wrapping_sub(1), sum }
    }
}
