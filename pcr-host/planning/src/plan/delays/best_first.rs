//! Best-first search: the open node with the least bound is expanded first. Its bound is a lower bound of the cost of all plans, and
//! rises as the search goes on.
//!
//! Depth-first search finds plans early, but its lower bound rises only at the end, because nodes near the root stay open. Here a node is
//! stored as the list of sides that lead to it, and is computed again when it is expanded.

use super::branch_and_bound::{BranchAndBound, BranchStep, DelaySearchResult};
use super::problem::DifferenceConstraint;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A side, and the side that was chosen before it.
type OpenSearchNode = (usize, Option<DifferenceConstraint>);

/// Node limit of such a search: all open nodes are kept in memory, up to 200 MB.
pub(super) const MOST: u64 = 500_000;

impl BranchAndBound<'_> {
    /// The delays with the least cost, if that is below `limit`. Nodes are expanded in increasing order of their bounds.
    pub(super) fn lowest(mut self, limit: i128) -> DelaySearchResult {
        self.limit = limit;
        let mut open = BinaryHeap::new();
        // The sides that lead to each node, the last one first.
        let mut chosen: Vec<OpenSearchNode> = vec![(0, None)];
        if self.force() {
            // Among nodes with equal bounds the deepest is expanded first, then the one found first.
            open.push(Reverse((self.problem.cost(&self.net.least), Reverse(0_u32), 0_usize)));
        }
        let root = self.net.mark();
        while let Some(Reverse((bound, Reverse(depth), place))) = open.pop() {
            if bound >= self.limit {
                break;
            }
            if self.is_over() {
                return self.found(bound);
            }
            let possible = way(&chosen, place).all(|side| self.net.impose(side));
            let (sides, place) = if possible { self.branched(&mut chosen, place) } else { (None, place) };
            for side in sides.into_iter().flatten() {
                let mark = self.net.mark();
                if self.takes(side) {
                    let bound = bound.max(self.bound());
                    if bound < self.limit {
                        open.push(Reverse((bound, Reverse(depth + 1), chosen.len())));
                        chosen.push((place, Some(side)));
                    }
                }
                self.net.undo_to(mark);
            }
            self.net.undo_to(root);
        }
        let limit = self.limit;
        self.found(limit)
    }

    /// Adds all forced sides to a node; returns the two sides to branch on, and the resulting node.
    fn branched(
        &mut self,
        chosen: &mut Vec<OpenSearchNode>,
        mut place: usize,
    ) -> (Option<[DifferenceConstraint; 2]>, usize) {
        loop {
            match self.step() {
                BranchStep::End => return (None, place),
                BranchStep::Only(side) if !self.takes(side) => return (None, place),
                BranchStep::Only(side) => {
                    chosen.push((place, Some(side)));
                    place = chosen.len() - 1;
                }
                BranchStep::Both(sides) => return (Some(sides), place),
            }
        }
    }
}

/// The sides that lead to a node, the last one first.
fn way(chosen: &[OpenSearchNode], place: usize) -> impl Iterator<Item = DifferenceConstraint> {
    let before = |node: &OpenSearchNode| chosen.get(node.0).copied();
    std::iter::successors(chosen.get(place).copied(), before).map_while(|(_, side)| side)
}
