//! The node that could cost least first: what is open costs more and more, and with it what all plans cost at least.
//!
//! Depth first finds plans soon, but leaves nodes behind that were branched early and could cost little: as a bound it is worth nothing
//! until it ends. Here a node is the list of sides that lead to it, and is made anew when it is its turn.

use super::problem::Constraint;
use super::search::{Found, Search, Step};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A side, and the side that was chosen before it.
type Chosen = (usize, Option<Constraint>);

/// Most nodes of such a search: all that are open are remembered, in up to 200 MB.
pub(super) const MOST: u64 = 500_000;

impl Search<'_> {
    /// The delays that cost least, and less than a limit; in nodes that are looked at in the order of their bounds.
    pub(super) fn lowest(mut self, limit: i128) -> Found {
        self.limit = limit;
        let mut open = BinaryHeap::new();
        // The way to each node, from its last side to the first.
        let mut chosen: Vec<Chosen> = vec![(0, None)];
        if self.force() {
            // Of those that cost the same the deepest one, and then the one that was found first.
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
                self.net.take_back(mark);
            }
            self.net.take_back(root);
        }
        let limit = self.limit;
        self.found(limit)
    }

    /// The sides to branch upon, after those that are the only ones left; and the node that these make.
    fn branched(&mut self, chosen: &mut Vec<Chosen>, mut place: usize) -> (Option<[Constraint; 2]>, usize) {
        loop {
            match self.step() {
                Step::End => return (None, place),
                Step::Only(side) if !self.takes(side) => return (None, place),
                Step::Only(side) => {
                    chosen.push((place, Some(side)));
                    place = chosen.len() - 1;
                }
                Step::Both(sides) => return (Some(sides), place),
            }
        }
    }
}

/// The sides that lead to a node, the last one first.
fn way(chosen: &[Chosen], place: usize) -> impl Iterator<Item = Constraint> {
    let before = |node: &Chosen| chosen.get(node.0).copied();
    std::iter::successors(chosen.get(place).copied(), before).map_while(|(_, side)| side)
}
