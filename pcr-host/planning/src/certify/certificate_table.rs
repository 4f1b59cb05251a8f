//! Tables for the checker: of discs, or of outlines with the discs beside them.

use crate::checker_input::outlines;
use pcr_certify::outline::RawOutlineTable;
use pcr_certify::raw::RawTable;
use serde::Serialize;
use std::borrow::Cow;

/// A table to be certified.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum CertificateTable {
    /// Of discs only.
    Discs(RawTable),
    /// Of outlines that the core computes with, and of discs.
    Outlines(RawOutlineTable),
}

impl From<RawTable> for CertificateTable {
    fn from(table: RawTable) -> Self {
        Self::Discs(table)
    }
}

impl From<RawOutlineTable> for CertificateTable {
    fn from(table: RawOutlineTable) -> Self {
        Self::Outlines(table)
    }
}

impl CertificateTable {
    /// The table, if it is one of discs.
    pub fn discs(self) -> Option<RawTable> {
        match self {
            Self::Discs(table) => Some(table),
            Self::Outlines(_) => None,
        }
    }

    /// The table, if it has outlines.
    pub fn outlines(self) -> Option<RawOutlineTable> {
        match self {
            Self::Discs(_) => None,
            Self::Outlines(table) => Some(table),
        }
    }

    /// Number of pairs in it.
    pub(super) fn pairs(&self) -> usize {
        match self {
            Self::Discs(table) => table.pairs.len(),
            Self::Outlines(table) => table.pairs.len(),
        }
    }

    /// Number of outlines that are no discs.
    pub(super) fn outline_count(&self) -> usize {
        match self {
            Self::Discs(_) => 0,
            Self::Outlines(table) => table.bodies.iter().filter(|body| body.outline.corners != [[0.0; 2]]).count(),
        }
    }

    /// The table with outlines forgotten, which hold what does not depend on them: paths, times, regions and pieces.
    pub(super) fn paths(&self) -> Cow<'_, RawTable> {
        match self {
            Self::Discs(table) => Cow::Borrowed(table),
            Self::Outlines(table) => Cow::Owned(RawTable {
                agents: table.bodies.iter().map(outlines::agent).collect(),
                pairs: table.pairs.iter().map(outlines::pair_of_agents).collect(),
                apart: table.apart,
            }),
        }
    }
}
