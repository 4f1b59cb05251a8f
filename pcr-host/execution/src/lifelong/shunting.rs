//! Missions of a file where no whole route is admitted and all stand: the vehicles move one after the other from node to node, as a
//! search over all their nodes together finds it, until the oldest mission for which there is such a sequence is at its next stop.
//!
//! Each move is admitted as any other way, as soon as all can still finish; so it may begin before the one before it is over. Whoever
//! goes first, in the end all are where the sequence leads.

use super::endpoints::reached;
use super::own_missions::OwnMissions;
use super::route_graph::{DeparturePose, RouteGraph};
use super::run_state::LifelongState;
use super::stretch::Stretch;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashSet, VecDeque};

/// Vehicles are moved one after the other when all have stood for this long while missions wait, or if for the second time nobody has had
/// a goal on its way; and again after the third if there was no such sequence. Where one might come to a place from which no way leads
/// back, the first is so short that nobody is sent out of the way before \[s\].
const QUIET: [f64; 2] = [6.0, 1.0];
const FRUITLESS: f64 = 60.0;
const AGAIN: f64 = 60.0;

/// Largest number of states of a search.
const STATES: usize = 30_000;

/// Time that a sequence counts more for each edge on which a vehicle outside of the search stands \[ms\].
const OTHERS: u64 = 100_000;

/// A state of a search: the nodes of its vehicles and the number of stops that the first one has reached, the state before it, and the
/// vehicle that moved, with its edge.
struct NodeState {
    key: Box<[u32]>,
    before: Option<(usize, usize, usize)>,
    cost: u64,
}

impl LifelongState {
    /// Moves vehicles one after the other, if nothing else helps. Returns whether it does that at present.
    pub(super) fn shunts(&mut self, now: f64) -> bool {
        let Some(own) = &self.own else { return false };
        let mut shunting = own.shunting.clone();
        let is_idle = self.missions.iter().flatten().all(|mission| !mission.admitted) && !self.waiting().is_empty();
        shunting.idle_since = is_idle.then(|| shunting.idle_since.unwrap_or(now));
        let is_due = shunting.moves.is_empty() && now >= shunting.next_try;
        let is_fruitless = is_due && shunting.idle_since.is_some_and(|since| now - since > FRUITLESS);
        let stand = self.robots.iter().all(|robot| robot.has_arrived());
        let quiet = QUIET[usize::from(own.is_one_way)];
        if is_due && (self.quiet > quiet || (is_fruitless && stand)) {
            shunting.present = self.world.present.len();
            shunting.next_try = now + AGAIN;
            let found = self.waiting().into_iter().find_map(|robot| self.sequence(own, robot, now));
            shunting.moves = found.unwrap_or_default().into();
        }
        // Nobody gets another way until all stand.
        let is_active = !shunting.moves.is_empty() || (is_fruitless && !stand);
        let changed = shunting.present != self.world.present.len();
        while let Some(next) = shunting.moves.front() {
            let it = &self.robots[next.robot];
            let begins = next.atoms.first().is_some_and(|&first| self.site.atoms[first].ends[0] == it.way.end());
            if changed || !begins || it.cut.is_some() {
                (shunting.moves, shunting.next_try) = (VecDeque::new(), now + AGAIN);
            } else if let Some(found) = self.admit_together(std::slice::from_ref(next), now) {
                self.take_together(std::slice::from_ref(next), found, now);
                shunting.moves.pop_front();
                shunting.next_try = now;
            } else {
                if stand {
                    (shunting.moves, shunting.next_try) = (VecDeque::new(), now + AGAIN);
                }
                break;
            }
        }
        if let Some(own) = &mut self.own {
            own.shunting = shunting;
        }
        is_active
    }

    /// Moves of vehicles one after the other until one of them is at the next stop of its mission, with the rest of the mission possible
    /// in the same way; `None` if there are none, or too many states to look at.
    fn sequence(&self, own: &OwnMissions, root: usize, now: f64) -> Option<Vec<Stretch>> {
        let mission = &own.missions[own.current[root]?];
        let stops = mission.request.stops.iter().skip(mission.reached.len());
        let stops: Vec<usize> = stops.map(|&stop| self.node_of_layer(root, stop)).collect();
        let is_stranded = |robot: usize| self.robots[robot].cut.is_some() || self.world.is_stranded(robot, now);
        let mut closed: Vec<bool> = self.world.closed.iter().map(|&closed| closed > 0).collect();
        let (mut outside, mut group) = (Vec::new(), vec![root]);
        for robot in (0..self.robots.len()).filter(|&robot| robot != root) {
            match is_stranded(robot) {
                true => self.end_covers(robot).iter().for_each(|&atom| closed[atom] = true),
                false => outside.push(robot),
            }
        }
        loop {
            let mut avoided = vec![false; self.site.atoms.len()];
            outside.iter().for_each(|&robot| self.end_covers(robot).iter().for_each(|&atom| avoided[atom] = true));
            let moves = self.moves(&group, &stops, &closed, &avoided)?;
            let stands = |&robot: &usize| {
                let covers = self.end_covers(robot);
                moves.iter().any(|&(_, atom)| covers.contains(&atom))
            };
            match outside.iter().position(stands) {
                Some(next) => group.push(outside.remove(next)),
                None => return Some(self.stretches(root, stops.first().copied()?, moves)),
            }
        }
    }

    /// Moves of one vehicle along several edges as one, up to the first stop of the root.
    fn stretches(&self, root: usize, stop: usize, moves: Vec<(usize, usize)>) -> Vec<Stretch> {
        let mut found: Vec<Stretch> = Vec::new();
        for (robot, atom) in moves {
            match found.last_mut().filter(|last| last.robot == robot) {
                Some(last) => last.atoms.push(atom),
                None => found.push(Stretch { robot, atoms: vec![atom] }),
            }
            if robot == root && self.site.atoms[atom].ends[1] == stop {
                break;
            }
        }
        found
    }

    /// The moves of a group of vehicles, of which one at a time moves along an edge, that bring the first one to all stops soonest, if
    /// there are no others. Ways over the atoms in `avoided` are tried last.
    fn moves(
        &self,
        group: &[usize],
        stops: &[usize],
        closed: &[bool],
        avoided: &[bool],
    ) -> Option<Vec<(usize, usize)>> {
        let (site, count) = (&self.site, group.len());
        let mut key: Vec<u32> = group.iter().map(|&robot| self.robots[robot].way.end() as u32).collect();
        key.push(0);
        let remaining = |key: &[u32]| {
            let (mut time, mut node) = (0.0, key[0] as usize);
            for &stop in &stops[key[count] as usize..] {
                time += self.network.times(site, stop)(DeparturePose { node, heading: None });
                node = stop;
            }
            (1000.0 * time) as u64
        };
        let reach = |key: &mut Box<[u32]>| {
            let here = stops.iter().skip(key[count] as usize).take_while(|&&stop| stop == key[0] as usize).count();
            key[count] += here as u32;
        };
        let mut key = key.into_boxed_slice();
        reach(&mut key);
        let mut heap = BinaryHeap::from([(Reverse(remaining(&key)), Reverse(0))]);
        let (mut states, mut done) = (vec![NodeState { key, before: None, cost: 0 }], HashSet::new());
        while let Some((_, Reverse(place))) = heap.pop() {
            let (key, cost) = (states[place].key.clone(), states[place].cost);
            if !done.insert(key.clone()) {
                continue;
            }
            if key[count] as usize == stops.len() {
                let back = std::iter::successors(states[place].before, |&(before, ..)| states[before].before);
                let mut moves: Vec<(usize, usize)> = back.map(|(_, member, atom)| (group[member], atom)).collect();
                moves.reverse();
                return Some(moves);
            }
            for member in 0..count {
                for &atom in &site.leaving[key[member] as usize] {
                    let target = site.atoms[atom].ends[1];
                    let is_free = |other: usize| {
                        let node = key[other] as usize;
                        !site.passes(atom, node) && !site.collide(target, node)
                    };
                    if closed[atom] || !(0..count).all(|other| other == member || is_free(other)) {
                        continue;
                    }
                    let mut key = key.clone();
                    key[member] = target as u32;
                    reach(&mut key);
                    if done.contains(&key) {
                        continue;
                    }
                    let it = &site.atoms[atom];
                    let time = (1000.0 * it.length / it.speed) as u64 + if avoided[atom] { OTHERS } else { 1 };
                    let cost = cost.saturating_add(time);
                    heap.push((Reverse(cost.saturating_add(remaining(&key))), Reverse(states.len())));
                    states.push(NodeState { key, before: Some((place, member, atom)), cost });
                }
            }
            if states.len() > STATES {
                return None;
            }
        }
        None
    }
}

/// Whether some way leads to a node from which none leads back.
pub(super) fn is_one_way(site: &RouteGraph) -> bool {
    let mut known = vec![false; site.points.len()];
    (0..known.len()).any(|node| {
        if known[node] {
            return false;
        }
        let [to, from] = [false, true].map(|back| reached(site, node, back, |_| true));
        known.iter_mut().zip(&to).for_each(|(known, &to)| *known |= to);
        to != from
    })
}
