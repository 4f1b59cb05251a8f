//! Quickest routes over a layout, with the turns at its nodes, and what else an atom is made to cost.

use super::abilities::Abilities;
use super::site::{From, Site, wrapped};
use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashSet};

/// An atom that can be left after this time \[s\], with what is left at least.
#[derive(PartialEq)]
struct Reached {
    bound: f64,
    cost: f64,
    atom: usize,
}

impl Eq for Reached {}

impl Ord for Reached {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound).then(other.atom.cmp(&self.atom))
    }
}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The quickest routes from a node to different nodes that are asked for, the quickest first, at most `count`. `toll` is what an atom
/// costs beside its time \[s\]; `towards` the only node that is asked for.
pub(super) fn routes(
    (site, abilities): (&Site, &Abilities),
    From { node: from, heading }: From,
    toll: impl Fn(usize) -> f64,
    asked: impl Fn(usize) -> bool,
    towards: Option<usize>,
    count: usize,
) -> Vec<Vec<usize>> {
    let mut found = Vec::new();
    let mut met = HashSet::new();
    if asked(from) {
        found.push(Vec::new());
        met.insert(from);
    }
    let left = |node: usize| match towards {
        Some(to) => {
            let (a, b) = (site.points[node], site.points[to]);
            (a[0] - b[0]).hypot(a[1] - b[1]) / abilities.speed
        }
        None => 0.0,
    };
    // The least cost of each atom, and the one before it.
    let mut best: Vec<(f64, usize)> = vec![(f64::INFINITY, usize::MAX); site.atoms.len()];
    let mut done = vec![false; site.atoms.len()];
    let mut heap = BinaryHeap::new();
    let relax = |heap: &mut BinaryHeap<Reached>,
                 best: &mut [(f64, usize)],
                 atom: usize,
                 before: Option<usize>,
                 cost: f64,
                 heading: Option<f64>| {
        let it = &site.atoms[atom];
        let turn = heading.zip(it.headings).map_or(0.0, |(last, next)| wrapped(next[0] - last));
        let corner = if turn.abs() > 1e-6 { abilities.turn(turn) + abilities.stop() } else { 0.0 };
        let cost = cost + corner + it.length / it.speed + toll(atom);
        if cost < best[atom].0 {
            best[atom] = (cost, before.unwrap_or(usize::MAX));
            heap.push(Reached { bound: cost + left(it.ends[1]), cost, atom });
        }
    };
    for &atom in &site.leaving[from] {
        relax(&mut heap, &mut best, atom, None, 0.0, heading);
    }
    while found.len() < count {
        let Some(Reached { cost, atom, .. }) = heap.pop() else { break };
        if std::mem::replace(&mut done[atom], true) {
            continue;
        }
        let node = site.atoms[atom].ends[1];
        if asked(node) && met.insert(node) {
            let mut route = vec![atom];
            let mut before = best[atom].1;
            while before != usize::MAX {
                route.push(before);
                before = best[before].1;
            }
            route.reverse();
            found.push(route);
        }
        let heading = site.atoms[atom].headings.map(|headings| headings[1]);
        for &next in &site.leaving[node] {
            if !done[next] {
                relax(&mut heap, &mut best, next, Some(atom), cost, heading);
            }
        }
    }
    found
}
