//! Difference constraints, and the least delays that satisfy them: longest paths, updated for each new constraint.
//!
//! A constraint raises the delay at its end, which raises others. A cycle of constraints whose sum is above 0 has no
//! solution. Since there was a solution before, such a cycle contains the new constraint, so the raise comes back to
//! its beginning.

use super::problem::{DifferenceConstraint, NEVER};
use std::collections::VecDeque;

pub(super) struct DifferenceNetwork {
    /// The least delays \[ticks\].
    pub(super) least: Vec<i64>,
    /// For each agent its constraints: the other agent, and the least difference.
    out: Vec<Vec<(usize, i64)>>,
    /// Changes: an agent that got a constraint, or an agent with its former delay.
    changes: Vec<(usize, Option<i64>)>,
    queue: VecDeque<usize>,
    queued: Vec<bool>,
}

impl DifferenceNetwork {
    /// A net without constraints between agents; delays are at least these.
    pub(super) fn new(least: Vec<i64>) -> Self {
        let count = least.len();
        Self {
            least,
            out: vec![Vec::new(); count],
            changes: Vec::new(),
            queue: VecDeque::new(),
            queued: vec![false; count],
        }
    }

    /// Adds a constraint; `false` if no delays are left. Then the constraint has to be taken back.
    pub(super) fn impose(&mut self, constraint: DifferenceConstraint) -> bool {
        let DifferenceConstraint { from, to, least } = constraint;
        if least >= NEVER || from == to {
            return false;
        }
        self.out[from].push((to, least));
        self.changes.push((from, None));
        self.raise(to, self.least[from] + least);
        let mut possible = true;
        while let Some(agent) = self.queue.pop_front() {
            self.queued[agent] = false;
            possible &= agent != from;
            // After a contradiction the queue is emptied without effect.
            let reached = if possible { self.out[agent].len() } else { 0 };
            for place in 0..reached {
                let (next, least) = self.out[agent][place];
                self.raise(next, self.least[agent] + least);
            }
        }
        possible
    }

    fn raise(&mut self, agent: usize, least: i64) {
        let before = self.least[agent];
        if least <= before {
            return;
        }
        self.changes.push((agent, Some(before)));
        self.least[agent] = least;
        if !self.queued[agent] {
            self.queued[agent] = true;
            self.queue.push_back(agent);
        }
    }

    /// A mark for [`Self::undo_to`].
    pub(super) fn mark(&self) -> usize {
        self.changes.len()
    }

    /// Takes back all changes since a mark.
    pub(super) fn undo_to(&mut self, mark: usize) {
        while self.changes.len() > mark {
            match self.changes.pop() {
                Some((agent, Some(before))) => self.least[agent] = before,
                Some((agent, None)) => drop(self.out[agent].pop()),
                None => {}
            }
        }
    }
}
