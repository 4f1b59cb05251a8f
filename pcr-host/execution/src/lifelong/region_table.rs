//! Passing orders: the regions of the ways of a fleet, indexed by robot.
//!
//! A region is a connected set of pairs of atoms of two ways at which the robots touch. The robot that passes second
//! waits at the gates of the region.

use super::gates::{ElementContact, Gate, TimedGate, authority, pruned};
use super::robot::LifelongRobot;
use super::route::Route;
use super::route_graph::RouteGraph;
use pcr_core::Interval;
use std::rc::Rc;

/// A region of two ways, and its passing order.
#[derive(Clone, Debug)]
pub(super) struct RouteRegion {
    pub(super) robots: [usize; 2],
    /// Range of lengths of the region on each of the two ways \[m\].
    pub(super) hull: [Interval<f64>; 2],
    /// Gates of each of the two robots, if it is the second.
    gates: [Rc<[TimedGate]>; 2],
    /// The nearest and the last of these gates, if there are any.
    ends: [Option<[TimedGate; 2]>; 2],
    /// Which of the two goes first: 0 or 1.
    pub(super) first: usize,
}

impl RouteRegion {
    /// The gates of the second robot.
    pub(super) fn gates(&self) -> &[TimedGate] {
        &self.gates[1 - self.first]
    }

    /// The gates of one of the two robots, if it is the second.
    pub(super) fn gates_of(&self, second: usize) -> &[TimedGate] {
        &self.gates[second]
    }

    /// The nearest and the last gate of the second robot, if there are any.
    pub(super) fn ends(&self) -> Option<[TimedGate; 2]> {
        self.ends[1 - self.first]
    }

    /// The same region with the two robots exchanged.
    fn swapped(&self) -> Self {
        let Self { robots: [a, b], hull: [own, other], gates: [first, second], ends: [head, tail], .. } = self;
        Self {
            robots: [*b, *a],
            hull: [*other, *own],
            gates: [second.clone(), first.clone()],
            ends: [*tail, *head],
            first: 1 - self.first,
        }
    }

    /// The robot that passes second.
    pub(super) fn second(&self) -> usize {
        self.robots[1 - self.first]
    }

    /// The robot that passes second, and the length at which the region begins on its way \[m\].
    fn waits(&self) -> (usize, f64) {
        (self.second(), self.hull[1 - self.first].lo)
    }

    /// Whether one of the two robots has left the region.
    pub(super) fn is_over(&self, at: [f64; 2]) -> bool {
        at[0] > self.hull[0].hi || at[1] > self.hull[1].hi
    }

    /// Whether robot `first` of the two can go first: the other can stop at its hold, and `first` leaves the region on its way, or the way
    /// of the other ends before the last gate.
    pub(super) fn can_be_first(&self, first: usize, at: [f64; 2], stop: [f64; 2], lengths: [f64; 2]) -> bool {
        let second = 1 - first;
        let gates = &self.gates[second];
        let leaves = gates.last().is_none_or(|last| {
            last.gate.required_position <= lengths[first] || last.gate.wait_position >= lengths[second]
        });
        leaves && stop[second] <= authority(gates, at[first])
    }
}

/// A pair of atoms of two ways that touch.
struct TouchingElements<'s> {
    /// The robot of the other way.
    other: usize,
    /// Index of the atom on each of the two ways.
    places: [usize; 2],
    hull: [Interval<f64>; 2],
    contact: &'s ElementContact,
    group: usize,
}

/// The regions of a fleet.
#[derive(Clone, Debug, Default)]
pub(super) struct RegionTable {
    regions: Vec<Option<RouteRegion>>,
    /// For each region the robot that passes second, and the length from which on it may have to wait \[m\]. It is kept apart from
    /// `regions` because each step of a robot reads it.
    seconds: Vec<(usize, f64)>,
    /// Unused indices of `regions`.
    free: Vec<usize>,
    /// For each robot the indices of its regions.
    rows: Vec<Vec<usize>>,
    /// For each atom the robots that have it on their way, with its index on that way.
    robots_by_element: Vec<Vec<(usize, usize)>>,
}

impl RegionTable {
    /// The book of robots that stand at nodes without touching.
    pub(super) fn new(site: &RouteGraph, robots: &[LifelongRobot]) -> Self {
        let (rows, on) = (vec![Vec::new(); robots.len()], vec![Vec::new(); site.atoms.len()]);
        let mut book = Self { rows, robots_by_element: on, ..Self::default() };
        for (robot, it) in robots.iter().enumerate() {
            book.occupy(robot, &it.way);
        }
        book
    }

    /// The regions of a robot.
    pub(super) fn row(&self, robot: usize) -> impl Iterator<Item = &RouteRegion> {
        self.rows[robot].iter().filter_map(|&place| self.regions[place].as_ref())
    }

    /// The regions of a robot with their indices; the robot is the first of the two.
    pub(super) fn seen_by(&self, robot: usize) -> impl Iterator<Item = (usize, RouteRegion)> {
        self.rows[robot].iter().filter_map(move |&place| {
            let region = self.regions[place].as_ref()?;
            Some((place, if region.robots[0] == robot { region.clone() } else { region.swapped() }))
        })
    }

    /// Sets which robot goes first at some regions, given by their indices.
    pub(super) fn set_precedences(&mut self, firsts: &[(usize, usize)]) {
        for &(place, first) in firsts {
            if let Some(region) = &mut self.regions[place] {
                region.first = usize::from(region.robots[1] == first);
                self.seconds[place] = region.waits();
            }
        }
    }

    /// Length up to which a robot may go.
    pub(super) fn authority(&self, robot: usize, robots: &[LifelongRobot], far: f64) -> f64 {
        let mut least = far;
        for &place in &self.rows[robot] {
            let (second, from) = self.seconds[place];
            if second == robot
                && from < least
                && let Some(region) = &self.regions[place]
            {
                least = least.min(authority(region.gates(), robots[region.robots[region.first]].at));
            }
        }
        least
    }

    /// The robot that has to go first where a robot has to wait next, within a length.
    pub(super) fn next_first(&self, robot: usize, robots: &[LifelongRobot], far: f64) -> Option<usize> {
        let second = self.row(robot).filter(|region| region.second() == robot);
        let holds = second.map(|region| {
            let first = region.robots[region.first];
            (authority(region.gates(), robots[first].at), first)
        });
        holds.filter(|hold| hold.0 <= far).min_by(|a, b| a.0.total_cmp(&b.0)).map(|hold| hold.1)
    }

    /// Removes the regions that a robot, or the other one, has left.
    pub(super) fn drop_over(&mut self, robot: usize, robots: &[LifelongRobot]) {
        let over = |place: &usize| {
            let region = self.regions[*place].as_ref();
            region.is_some_and(|region| region.is_over(region.robots.map(|robot| robots[robot].at)))
        };
        let gone: Vec<usize> = self.rows[robot].iter().copied().filter(over).collect();
        gone.into_iter().for_each(|place| self.remove(place));
    }

    fn remove(&mut self, place: usize) {
        if let Some(region) = self.regions[place].take() {
            for robot in region.robots {
                self.rows[robot].retain(|&other| other != place);
            }
            self.free.push(place);
        }
    }

    /// Gives a robot another way, with its regions.
    pub(super) fn exchange(&mut self, robot: usize, old: &Route, new: &Route, regions: Vec<RouteRegion>) {
        for place in std::mem::take(&mut self.rows[robot]) {
            self.remove(place);
        }
        for atom in &old.atoms {
            self.robots_by_element[*atom].retain(|(other, _)| *other != robot);
        }
        self.occupy(robot, new);
        self.add(regions);
    }

    /// Computes the times of the regions of a robot anew, after those of its way or of another one have changed.
    pub(super) fn retime(&mut self, robot: usize, robots: &[LifelongRobot]) {
        for &place in &self.rows[robot] {
            if let Some(region) = &mut self.regions[place] {
                let ways = region.robots.map(|robot| &robots[robot].way);
                for side in 0..2 {
                    let anew = |it: &TimedGate| timed(it.gate, ways[1 - side], ways[side]);
                    region.gates[side] = region.gates[side].iter().map(anew).collect();
                }
                region.ends = region.gates.each_ref().map(|gates| Some([*gates.first()?, *gates.last()?]));
            }
        }
    }

    /// Adds regions of ways that it has already.
    pub(super) fn add(&mut self, regions: Vec<RouteRegion>) {
        for region in regions {
            let place = self.free.pop().unwrap_or(self.regions.len());
            if place == self.regions.len() {
                self.regions.push(None);
                self.seconds.push(region.waits());
            } else {
                self.seconds[place] = region.waits();
            }
            region.robots.iter().for_each(|&robot| self.rows[robot].push(place));
            self.regions[place] = Some(region);
        }
    }

    fn occupy(&mut self, robot: usize, way: &Route) {
        for (place, &atom) in way.atoms.iter().enumerate() {
            self.robots_by_element[atom].push((robot, place));
        }
    }

    /// The other robots that have an atom on the rest of their ways.
    pub(super) fn others_on<'s>(
        &'s self,
        atom: usize,
        robot: usize,
        robots: &'s [LifelongRobot],
    ) -> impl Iterator<Item = (usize, usize)> + 's {
        let there = self.robots_by_element[atom].iter().copied();
        there.filter(move |&(other, place)| other != robot && robots[other].way.offsets[place + 1] >= robots[other].at)
    }

    /// The regions of a way of a robot that is at `at` on it; the robot goes second at all of them.
    pub(super) fn regions(
        &self,
        site: &RouteGraph,
        robots: &[LifelongRobot],
        robot: usize,
        way: &Route,
        at: f64,
    ) -> Vec<RouteRegion> {
        let mut ties: Vec<TouchingElements<'_>> = Vec::new();
        for (place, &atom) in way.atoms.iter().enumerate() {
            for (near, contact) in site.contacts(atom) {
                for (other, their) in self.others_on(near, robot, robots) {
                    let offsets = [way.offsets[place], robots[other].way.offsets[their]];
                    let shifted = |side: usize| {
                        let Interval { lo, hi } = contact.hull[side];
                        Interval::new(lo + offsets[side], hi + offsets[side])
                    };
                    let hull = [shifted(0), shifted(1)];
                    let is_ahead = hull[0].hi >= at && hull[1].hi >= robots[other].at;
                    // A way may end within an atom, before it touches.
                    if is_ahead && hull[0].lo <= way.length() && hull[1].lo <= robots[other].way.length() {
                        ties.push(TouchingElements { other, places: [place, their], hull, contact, group: 0 });
                    }
                }
            }
        }
        // Numbers of their own: arrays are compared by a loop.
        ties.sort_unstable_by_key(|&TouchingElements { other, places: [own, their], .. }| (other, own, their));
        let pairs = ties.chunk_by_mut(|a, b| a.other == b.other);
        pairs.flat_map(|ties| joined(ties, robot, [way, &robots[ties[0].other].way])).collect()
    }
}

/// A hold at the beginning of an atom is moved before it; there is nothing before the first atom.
fn authority_before(at: f64, offset: f64, place: usize) -> f64 {
    /// Distance by which it is moved \[m\].
    const BEFORE: f64 = 1e-6;
    match (at > f64::NEG_INFINITY, place) {
        (true, _) => at + offset,
        (false, 0) => f64::NEG_INFINITY,
        (false, _) => offset - BEFORE,
    }
}

/// A robot that does not leave a contact on an atom has left it at the end of that atom, if its way goes on there.
fn needed(needs: f64, way: &Route, place: usize) -> f64 {
    match needs < f64::INFINITY {
        true => needs + way.offsets[place],
        false if place + 1 < way.atoms.len() => way.offsets[place + 1],
        false => f64::INFINITY,
    }
}

fn timed(gate: Gate, first: &Route, second: &Route) -> TimedGate {
    let opens =
        if gate.required_position <= first.length() { first.time(gate.required_position) } else { f64::INFINITY };
    TimedGate { gate, arrival_time: second.time(gate.wait_position.clamp(0.0, second.length())), opening_time: opens }
}

/// The regions that are made of the ties of two robots, which are sorted by indices: ties of successive atoms belong together
/// if they meet.
fn joined(ties: &mut [TouchingElements<'_>], robot: usize, ways: [&Route; 2]) -> Vec<RouteRegion> {
    /// Lengths that differ by at most this are equal \[m\].
    const NEAR: f64 = 1e-5;
    let mut parents: Vec<usize> = (0..ties.len()).collect();
    fn root(parents: &mut [usize], mut k: usize) -> usize {
        while parents[k] != k {
            parents[k] = parents[parents[k]];
            k = parents[k];
        }
        k
    }
    for (k, tie) in ties.iter().enumerate() {
        for side in 0..2 {
            let mut next = tie.places;
            next[side] += 1;
            let Ok(next) = ties.binary_search_by_key(&next, |tie| tie.places) else { continue };
            let across = 1 - side;
            let [a, b] = [tie.hull, ties[next].hull];
            if a[side].hi + NEAR >= b[side].lo && a[across].widened(NEAR).meets(b[across]) {
                let (a, b) = (root(&mut parents, k), root(&mut parents, next));
                parents[a] = b;
            }
        }
    }
    for (k, tie) in ties.iter_mut().enumerate() {
        tie.group = root(&mut parents, k);
    }
    ties.sort_by_key(|tie| tie.group);
    let region = |group: &[TouchingElements<'_>]| {
        let hull = [0, 1].map(|side| group.iter().map(|tie| tie.hull[side]).reduce(Interval::hull).unwrap_or_default());
        let gates = [0, 1].map(|side| {
            let all = group.iter().flat_map(|tie| {
                let [own, other] = [side, 1 - side].map(|side| (ways[side], tie.places[side]));
                tie.contact.gates[side].iter().map(move |gate| Gate {
                    wait_position: authority_before(gate.wait_position, own.0.offsets[own.1], own.1),
                    required_position: needed(gate.required_position, other.0, other.1),
                })
            });
            pruned(all.collect()).into_iter().map(|gate| timed(gate, ways[1 - side], ways[side])).collect()
        });
        let ends = gates.each_ref().map(|gates: &Rc<[TimedGate]>| Some([*gates.first()?, *gates.last()?]));
        RouteRegion { robots: [robot, group[0].other], hull, gates, ends, first: 1 }
    };
    ties.chunk_by(|a, b| a.group == b.group).map(region).collect()
}

trait WidenInterval {
    fn widened(self, by: f64) -> Self;
}

impl WidenInterval for Interval<f64> {
    fn widened(self, by: f64) -> Self {
        Interval::new(self.lo - by, self.hi + by)
    }
}
