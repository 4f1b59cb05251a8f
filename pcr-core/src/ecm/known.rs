//! Which fleet a table is that of: a checksum.

use crate::motion::Motion;
use crate::scalar::Scalar;

/// The agents that a table knows: how many, and the sum of their checksums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Known {
    agents: usize,
    sum: u32,
}

impl Known {
    pub(super) const NOBODY: Self = Self { agents: 0, sum: 0 };

    pub(super) fn all<'m, S: Scalar + 'm>(fleet: impl IntoIterator<Item = &'m Motion<'m, S>>) -> Self {
        (0_usize..).zip(fleet).fold(Self::NOBODY, |known, (agent, motion)| known.with(agent, motion))
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
