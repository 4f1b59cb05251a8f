//! Options and warnings of writers.

use crate::Target;

/// Options of a writer.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The format.
    pub target: Target,
    /// Cut edges into equal parts no longer than this \[m\].
    pub split: Option<f64>,
    /// Envelopes with this key instead of blocks (openTCS).
    pub envelopes: Option<String>,
}

/// Warnings of writers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Notes {
    pub(crate) groups: usize,
    pub(crate) at_least: Option<usize>,
    pub(crate) said: Vec<String>,
}
