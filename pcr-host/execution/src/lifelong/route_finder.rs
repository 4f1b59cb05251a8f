//! Quickest routes on a layout, including turns at nodes and additional costs of atoms.
//!
//! A* over atoms. The heuristic is exact except for tolls: the least times from everywhere to a goal are computed once,
//! and kept for the most recent goals.

use super::kinematic_limits::KinematicLimits;
use super::route_graph::{DeparturePose, RouteGraph};
use pcr_formats::plane_geometry::wrapped;
use std::cell::RefCell;
use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap, HashSet, VecDeque};
use std::rc::Rc;

/// Memory for the times to goals, roughly \[bytes\].
const ROOM: usize = 256 << 20;

/// An atom that can be left at this time, with a lower bound of the remaining time \[s\].
#[derive(PartialEq)]
struct OpenElement {
    bound: f64,
    cost: f64,
    atom: usize,
}

impl Eq for OpenElement {}

impl Ord for OpenElement {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound).then(other.atom.cmp(&self.atom))
    }
}

impl PartialOrd for OpenElement {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The result for an atom in the search with this number.
#[derive(Clone, Copy, Default)]
struct SearchLabel {
    search: u32,
    done: bool,
    cost: f64,
    before: Option<usize>,
}

/// The times of a layout: for each atom, and for each corner.
pub(super) struct RouteFinder {
    /// The abilities of the robots of each layer.
    abilities: Vec<KinematicLimits>,
    /// Time of each atom \[s\].
    times: Vec<f64>,
    /// For each atom the atoms that can follow it, with the cost of the corner between them \[s\].
    after: Vec<Vec<(usize, f64)>>,
    /// For each atom the atoms that it can follow, with the same costs.
    before: Vec<Vec<(usize, f64)>>,
    /// For each goal the least times from the ends of all atoms \[s\].
    left: RefCell<HashMap<usize, Rc<[f32]>>>,
    /// The goals with stored times, the oldest first.
    goals: RefCell<VecDeque<usize>>,
    found: RefCell<(u32, Vec<SearchLabel>)>,
}

impl RouteFinder {
    pub(super) fn new(site: &RouteGraph) -> Self {
        let abilities: Vec<KinematicLimits> =
            site.layers.iter().map(|layer| KinematicLimits::of(&layer.vehicle)).collect();
        let edges = site.edges;
        let (mut after, mut before) = (vec![Vec::new(); edges], vec![Vec::new(); edges]);
        for (atom, it) in site.atoms[..edges].iter().enumerate() {
            let last = it.headings.map(|headings| headings[1]);
            for &next in &site.leaving[it.ends[1]] {
                let corner = corner(&abilities[it.layer], last, site.atoms[next].headings);
                after[atom].push((next, corner));
                before[next].push((atom, corner));
            }
        }
        let times = site.atoms[..edges].iter().map(|atom| atom.length / atom.speed).collect();
        let found = RefCell::new((0, vec![SearchLabel::default(); edges]));
        Self { abilities, times, after, before, left: RefCell::default(), goals: RefCell::default(), found }
    }

    /// Takes the speeds that the edges have now.
    pub(super) fn retime(&mut self, site: &RouteGraph) {
        self.times = site.atoms[..site.edges].iter().map(|atom| atom.length / atom.speed).collect();
        self.left.get_mut().clear();
        self.goals.get_mut().clear();
    }

    /// Computes the times to these goals now, if there is room for all of them.
    pub(super) fn warm(&self, site: &RouteGraph, goals: &[usize]) {
        if goals.len() * self.times.len() * size_of::<f32>() <= ROOM {
            goals.iter().for_each(|&goal| drop(self.remaining_times(site, goal)));
        }
    }

    /// The least times to a goal from the ends of all atoms, without tolls, rounded down \[s\].
    fn remaining_times(&self, site: &RouteGraph, goal: usize) -> Rc<[f32]> {
        if let Some(known) = self.left.borrow().get(&goal) {
            return known.clone();
        }
        let mut left = vec![f64::INFINITY; self.times.len()];
        let mut heap = BinaryHeap::new();
        for &atom in &site.coming[goal] {
            left[atom] = 0.0;
            heap.push(OpenElement { bound: 0.0, cost: 0.0, atom });
        }
        while let Some(OpenElement { cost, atom, .. }) = heap.pop() {
            if cost > left[atom] {
                continue;
            }
            for &(last, corner) in &self.before[atom] {
                let cost = cost + self.times[atom] + corner;
                if cost < left[last] {
                    left[last] = cost;
                    heap.push(OpenElement { bound: cost, cost, atom: last });
                }
            }
        }
        let below = |time: f64| if time < f64::INFINITY { (time as f32).next_down() } else { f32::INFINITY };
        let left: Rc<[f32]> = left.into_iter().map(below).collect();
        let (mut known, mut goals) = (self.left.borrow_mut(), self.goals.borrow_mut());
        if known.len() * left.len() * size_of::<f32>() > ROOM {
            goals.pop_front().map(|oldest| known.remove(&oldest));
        }
        goals.push_back(goal);
        known.insert(goal, left.clone());
        left
    }

    /// The least times to a goal from other nodes, without tolls \[s\].
    pub(super) fn times<'s>(&'s self, site: &'s RouteGraph, goal: usize) -> impl Fn(DeparturePose) -> f64 + 's {
        let left = self.remaining_times(site, goal);
        move |DeparturePose { node, heading }| {
            let over = |&atom: &usize| {
                let corner = corner(&self.abilities[site.layer_of(node)], heading, site.atoms[atom].headings);
                corner + self.times[atom] + f64::from(left[atom])
            };
            if node == goal { 0.0 } else { site.leaving[node].iter().map(over).fold(f64::INFINITY, f64::min) }
        }
    }

    /// Whether only few atoms lead to a goal, and none of them comes from `from`. Searched backward from the goal, because a
    /// forward search would visit the whole layout.
    fn is_shut(&self, site: &RouteGraph, goal: usize, from: usize, toll: impl Fn(usize) -> f64) -> bool {
        /// Largest number of atoms that are visited.
        const FEW: usize = 64;
        let is_open = |&atom: &usize| toll(atom) < f64::INFINITY;
        let mut met: Vec<usize> = site.coming[goal].iter().copied().filter(is_open).collect();
        let mut next = 0;
        while let Some(&atom) = met.get(next) {
            if site.atoms[atom].ends[0] == from || met.len() > FEW {
                return false;
            }
            for (before, _) in &self.before[atom] {
                if !met.contains(before) && is_open(before) {
                    met.push(*before);
                }
            }
            next += 1;
        }
        true
    }

    /// The quickest routes from a node to different requested nodes, the quickest first, at most `count`. `toll` is the
    /// additional cost of an atom \[s\]; `towards` is the only requested node, if there is only one.
    pub(super) fn quickest(
        &self,
        site: &RouteGraph,
        DeparturePose { node: from, heading }: DeparturePose,
        toll: impl Fn(usize) -> f64,
        asked: impl Fn(usize) -> bool,
        towards: Option<usize>,
        count: usize,
    ) -> Vec<Vec<usize>> {
        let mut routes = Vec::new();
        let mut met = HashSet::new();
        if asked(from) {
            routes.push(Vec::new());
            met.insert(from);
        }
        // Toll that no route to the goal avoids.
        let last = |goal: usize| site.coming[goal].iter().map(|&atom| toll(atom)).fold(f64::INFINITY, f64::min);
        let last = towards.map_or(0.0, last);
        let is_shut = |goal: usize| self.is_shut(site, goal, from, &toll);
        if routes.len() == count || towards.is_some_and(is_shut) {
            return routes;
        }
        let left = towards.map(|goal| self.remaining_times(site, goal));
        let left = |atom: usize| match &left {
            Some(left) if towards != Some(site.atoms[atom].ends[1]) => last + f64::from(left[atom]),
            _ => 0.0,
        };
        let (search, all) = &mut *self.found.borrow_mut();
        *search = search.wrapping_add(1);
        if *search == 0 {
            all.fill(SearchLabel::default());
            *search = 1;
        }
        let search = *search;
        let mut heap = BinaryHeap::new();
        let relax = |all: &mut [SearchLabel],
                     heap: &mut BinaryHeap<OpenElement>,
                     atom: usize,
                     before: Option<usize>,
                     cost: f64| {
            let known = all[atom].search == search;
            if known && all[atom].done {
                return;
            }
            let bound = left(atom);
            let cost = cost + self.times[atom];
            if bound == f64::INFINITY || (known && all[atom].cost <= cost) {
                return;
            }
            let cost = cost + toll(atom);
            if cost < f64::INFINITY && (!known || cost < all[atom].cost) {
                all[atom] = SearchLabel { search, done: false, cost, before };
                heap.push(OpenElement { bound: cost + bound, cost, atom });
            }
        };
        for &atom in &site.leaving[from] {
            relax(
                all,
                &mut heap,
                atom,
                None,
                corner(&self.abilities[site.layer_of(from)], heading, site.atoms[atom].headings),
            );
        }
        while routes.len() < count {
            let Some(OpenElement { cost, atom, .. }) = heap.pop() else { break };
            if std::mem::replace(&mut all[atom].done, true) {
                continue;
            }
            let node = site.atoms[atom].ends[1];
            if asked(node) && met.insert(node) {
                let before = |&atom: &usize| all[atom].before;
                let mut route: Vec<usize> = std::iter::successors(Some(atom), before).collect();
                route.reverse();
                routes.push(route);
            }
            for &(next, corner) in &self.after[atom] {
                relax(all, &mut heap, next, Some(atom), cost + corner);
            }
        }
        routes
    }
}

/// Cost of the corner between a direction and the first direction of an atom \[s\].
fn corner(abilities: &KinematicLimits, last: Option<f64>, next: Option<[f64; 2]>) -> f64 {
    let turn = last.zip(next).map_or(0.0, |(last, [next, _])| wrapped(next - last));
    if turn.abs() > 1e-6 { abilities.turn(turn) + abilities.stop() } else { 0.0 }
}
