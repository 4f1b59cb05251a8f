//! Whether some robots can come to their goals past one another at all, whatever the speeds: a search over all their places
//! together. Which other robots matter is found on the way: only those that stand where a way of the others leads.
//!
//! In the end all are at nodes again, as in any run: nobody sets off who could not come to its end. If the site changes on the way that is
//! not so, and not asked for.
//!
//! A "no" is a proof: robots elsewhere, turns of outlines and more than two robots at one spot would make it only harder
//! ([`super::passing_cells`]). A "yes" is none.

use super::passing_cells::PassingCells;
use super::route_finder::RouteFinder;
use super::route_graph::DeparturePose;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap, HashSet};

/// Largest number of looks at a robot, or at a pair of robots, in one search, and in all searches for a file.
const LOOKS: [usize; 2] = [150_000, 1_500_000];

/// Time that a way counts more for each edge on which a robot outside of the search stands \[ms\].
const OTHERS: u64 = 100_000;

/// A robot of a search.
#[derive(Clone, Debug)]
pub(super) struct PassingRobot {
    /// Its index in the fleet.
    pub(super) robot: usize,
    /// The node where it stands.
    pub(super) start: usize,
    /// For each atom whether it may not go there.
    pub(super) blocked: Vec<bool>,
}

/// What a search has found.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum PassingAnswer {
    /// The edges of a way of all robots on which the first one comes to its stops.
    Possible(BTreeSet<usize>),
    /// Whatever they do, the first robot does not come to this one of its stops, or they cannot all drive on afterwards.
    Impossible { stop: usize },
    /// It takes too long to find out.
    Open,
}

/// A state by its place in memory, the one before it and the edges on which others stand that were used so far.
struct SearchState {
    key: Box<[u32]>,
    before: Option<usize>,
    others: u64,
}

/// The searches for the missions of a file.
pub(super) struct PassingSearch<'s> {
    cells: PassingCells<'s>,
    network: &'s RouteFinder,
    /// Whether all robots have to be at nodes in the end.
    at_nodes: bool,
    /// Number of looks that are left for the file.
    pub(super) left: usize,
}

impl<'s> PassingSearch<'s> {
    pub(super) fn new(cells: PassingCells<'s>, network: &'s RouteFinder, at_nodes: bool) -> Self {
        Self { cells, network, at_nodes, left: LOOKS[1] }
    }

    /// Whether the first of these robots can come to some nodes, one after the other, if there are no other robots. Ways over the atoms
    /// in `avoided` are tried last.
    pub(super) fn answer(&mut self, robots: &[PassingRobot], stops: &[usize], avoided: &[bool]) -> PassingAnswer {
        let mut looks = LOOKS[0].min(self.left);
        let before = looks;
        let answer = self.search(robots, stops, avoided, &mut looks);
        self.left -= before - looks;
        answer
    }

    /// A key has the place of each robot (a node, or an edge behind all nodes), then the number of stops that were reached, then for each
    /// pair of robots how they are to one another.
    fn search(
        &mut self,
        robots: &[PassingRobot],
        stops: &[usize],
        avoided: &[bool],
        looks: &mut usize,
    ) -> PassingAnswer {
        let (count, nodes) = (robots.len(), self.cells.site.points.len());
        let mut key = vec![0_u32; count + 1 + count * (count - 1) / 2];
        for (member, robot) in robots.iter().enumerate() {
            key[member] = robot.start as u32;
        }
        reach_stops(stops, count, &mut key);
        let (mut states, mut known, mut heap) = (Vec::new(), HashSet::new(), BinaryHeap::new());
        let mut farthest = 0;
        known.insert(key.clone().into_boxed_slice());
        states.push(SearchState { key: key.into_boxed_slice(), before: None, others: 0 });
        heap.push((Reverse(0_u64), Reverse(0_usize)));
        while let Some((_, Reverse(place))) = heap.pop() {
            let key = states[place].key.clone();
            // Where somebody is on an edge, all might be stuck.
            let is_settled = !self.at_nodes || key[..count].iter().all(|&place| (place as usize) < nodes);
            if is_settled {
                farthest = farthest.max(key[count] as usize);
            }
            if is_settled && farthest == stops.len() {
                return PassingAnswer::Possible(self.edges(&states, place, count));
            }
            for member in 0..count {
                for (key, edge) in self.steps(robots, stops, &key, member, looks) {
                    if known.insert(key.clone()) {
                        let is_avoided = edge.is_some_and(|edge| avoided[edge]);
                        let others = states[place].others + if is_avoided { OTHERS } else { 0 };
                        let cost = others.saturating_add(self.remaining(stops, count, &key));
                        heap.push((Reverse(cost), Reverse(states.len())));
                        states.push(SearchState { key, before: Some(place), others });
                    }
                }
                if *looks == 0 {
                    return PassingAnswer::Open;
                }
            }
        }
        PassingAnswer::Impossible { stop: farthest }
    }

    /// The edges on the way to a state.
    fn edges(&self, states: &[SearchState], place: usize, count: usize) -> BTreeSet<usize> {
        let nodes = self.cells.site.points.len() as u32;
        let way = std::iter::successors(Some(place), |&place| states[place].before);
        let edges = way.flat_map(|place| states[place].key[..count].to_vec());
        edges.filter(|&place| place >= nodes).map(|place| (place - nodes) as usize).collect()
    }

    /// Time that the first robot would need alone to the stops that are left \[ms\].
    fn remaining(&self, stops: &[usize], count: usize, key: &[u32]) -> u64 {
        let (site, place) = (self.cells.site, key[0] as usize);
        let (mut time, mut node) =
            (0.0, place.checked_sub(site.points.len()).map_or(place, |edge| site.atoms[edge].ends[1]));
        for &stop in &stops[key[count] as usize..] {
            time += self.network.times(site, stop)(DeparturePose { node, heading: None });
            node = stop;
        }
        (1000.0 * time) as u64
    }

    /// The states to which one robot leads, with the edge to which it goes.
    fn steps(
        &mut self,
        robots: &[PassingRobot],
        stops: &[usize],
        key: &[u32],
        member: usize,
        looks: &mut usize,
    ) -> Vec<(Box<[u32]>, Option<usize>)> {
        let (site, nodes) = (self.cells.site, self.cells.site.points.len());
        let place = key[member] as usize;
        let targets: Vec<usize> = match place.checked_sub(nodes) {
            Some(edge) => vec![site.atoms[edge].ends[1]],
            None => {
                let open = |edge: &&usize| !robots[member].blocked[**edge];
                site.leaving[place].iter().filter(open).map(|edge| nodes + edge).collect()
            }
        };
        let mut found = Vec::new();
        for target in targets {
            *looks = looks.saturating_sub(1);
            let mut next = key.to_vec();
            next[member] = target as u32;
            let mut open = vec![next];
            for other in (0..robots.len()).filter(|&other| other != member) {
                *looks = looks.saturating_sub(1);
                let pair = pair_place(robots.len(), member, other);
                let relations = self.relations(key, [member, other], target, key[pair] as usize);
                let with = |key: Vec<u32>| {
                    relations.clone().into_iter().map(move |relation| {
                        let mut key = key.clone();
                        key[pair] = relation as u32;
                        key
                    })
                };
                open = open.into_iter().flat_map(with).collect();
            }
            for mut key in open {
                reach_stops(stops, robots.len(), &mut key);
                found.push((key.into_boxed_slice(), target.checked_sub(nodes)));
            }
        }
        found
    }

    /// How two robots can be to one another after the first of them has gone to its next place. At a node and on an edge: the range of
    /// the edge. On two edges: twice the range of the one that was on its edge before, and 1 more if that is the one with the lower index.
    fn relations(&mut self, key: &[u32], [member, other]: [usize; 2], target: usize, relation: usize) -> Vec<usize> {
        let nodes = self.cells.site.points.len();
        let [from, beside] = [key[member] as usize, key[other] as usize];
        let edge_of = |place: usize| place.checked_sub(nodes);
        match (edge_of(target), edge_of(beside)) {
            (Some(edge), None) => {
                let ranges = self.cells.beside(edge, beside);
                if ranges.first().is_some_and(|&range| PassingCells::begins(range)) { vec![0] } else { Vec::new() }
            }
            (Some(edge), Some(second)) => {
                let cells = self.cells.between(edge, second);
                let entries = cells.entries.get(relation).into_iter().flatten();
                entries.map(|entry| 2 * entry + usize::from(other < member)).collect()
            }
            (None, None) => {
                let edge = from - nodes;
                let ranges = self.cells.beside(edge, beside);
                let is_out = ranges.get(relation).is_some_and(|&range| self.cells.ends(range, edge));
                if is_out && self.cells.may_stand(target, beside) { vec![0] } else { Vec::new() }
            }
            (None, Some(second)) => {
                let cells = self.cells.between(from - nodes, second);
                let was_last = (relation % 2 == 1) == (other < member);
                let exits = cells.exits[usize::from(!was_last)].get(relation / 2);
                exits.cloned().unwrap_or_default()
            }
        }
    }
}

/// Counts the stops at which the first robot stands.
fn reach_stops(stops: &[usize], count: usize, key: &mut [u32]) {
    let here = stops.iter().skip(key[count] as usize).take_while(|&&stop| stop == key[0] as usize);
    key[count] += here.count() as u32;
}

/// Place of a pair of robots in a key.
fn pair_place(count: usize, a: usize, b: usize) -> usize {
    let (a, b) = (a.min(b), a.max(b));
    count + 1 + b * (b - 1) / 2 + a
}
