//! Options and warnings of writers.

use crate::ExclusionFormat;

/// Options of a writer.
#[derive(Clone, Debug)]
pub struct WriteOptions {
    /// The format.
    pub target: ExclusionFormat,
    /// Cut edges into equal parts no longer than this \[m\].
    pub split: Option<f64>,
    /// Envelopes with this key instead of blocks (openTCS).
    pub envelopes: Option<String>,
}

/// Warnings of writers.
#[derive(Clone, Debug, Default)]
pub(crate) struct WriteNotes {
    pub(crate) groups: usize,
    pub(crate) at_least: Option<usize>,
    pub(crate) warnings: Vec<String>,
}
