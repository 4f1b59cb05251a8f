//! How far the searches for start delays are.

use super::branch_and_bound::steps;
use super::{DelayProblem, DelaySearchOptions, FACTOR, NODES, ROUNDS, SEARCHED, SEARCHES, share};
use crate::agent_regions::ProgressFn;

/// Counts the steps of all searches that are allowed for all parts of a fleet: looks at the clock in a tree, and rounds of
/// improvement. A part that is done early skips its other steps.
pub(super) struct SearchMeter<'a> {
    told: ProgressFn<'a>,
    effort: DelaySearchOptions,
    done: std::cell::Cell<u64>,
    /// 0 if the number of searches has no limit.
    all: u64,
}

impl<'a> SearchMeter<'a> {
    pub(super) fn new<'p>(
        parts: impl Iterator<Item = &'p DelayProblem>,
        effort: DelaySearchOptions,
        told: ProgressFn<'a>,
    ) -> Self {
        let all = if effort.prove { 0 } else { parts.map(|part| allowed(part, effort)).sum() };
        Self { told, effort, done: 0.into(), all }
    }

    /// Returns the number of steps when the part that begins now has taken all of its own.
    pub(super) fn end_of(&self, part: &DelayProblem) -> u64 {
        self.done.get() + if self.all > 0 { allowed(part, self.effort) } else { 0 }
    }

    /// Counts a step of a part; more than it is allowed are not counted.
    pub(super) fn step(&self, end: u64) {
        let next = self.done.get() + 1;
        self.skip_to(if self.all > 0 { next.min(end) } else { next });
    }

    /// Skips steps.
    pub(super) fn skip_to(&self, done: u64) {
        self.done.set(self.done.get().max(done));
        (self.told)(self.done.get() as usize, self.all as usize);
    }
}

/// Steps of a part.
fn allowed(part: &DelayProblem, effort: DelaySearchOptions) -> u64 {
    if part.pairs.len() > SEARCHED && effort == DelaySearchOptions::default() {
        return 1;
    }
    let search = |search: u32| {
        let factor = u64::from(FACTOR).pow(search);
        // No improvement follows the last tree.
        let rounds = if search + 1 < SEARCHES { share(part, effort, ROUNDS as u64 * factor) } else { 0 };
        steps(part, share(part, effort, NODES * factor)) + rounds
    };
    (0..SEARCHES).map(search).sum()
}
