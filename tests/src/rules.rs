//! Vehicles that keep to the rules of a file and to nothing else: random missions, speeds, delays and stops.
//!
//! Each of them is a disc that goes by the shortest way to a random node, and on to the next one. Before it goes on, to a further stretch of an
//! edge or onto the next edge, it asks whether the rules let it; if not, it waits where it is. One that has waited for long goes another way,
//! or is taken out and put in elsewhere. Where they were at all times is proved to be without contact by `pcr_certify`, which knows no rules.

use pcr_certify::motion::{ContactWitness, Mover, meetings};
use pcr_certify::raw::{RawAgent, RawAngle, RawMotion, RawPath, RawPhase, RawSegment};
use pcr_exclusions::{ClaimSpan, ExclusionRules, ResourceClaim};
use pcr_formats::import::ImportedLayout;
use pcr_formats::scenario::{PathSegment, PlacedSegment};
use pcr_formats::splitmix64::SplitMix64;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

/// Refusals after which a vehicle goes any way that is free.
const PATIENCE: usize = 6;

/// Refusals after which it is taken out.
const STUCK: usize = 40;

/// Largest distance of the end of an edge from its node, if the edge is travelled: as far as routes pass \[m\]. From the end of one edge to
/// the beginning of the next it goes at once.
const OFF: f64 = 0.05;

/// What has come of it.
#[derive(Clone, Debug, Default)]
pub struct Run {
    /// Missions that were completed.
    pub missions: usize,
    /// Edges that were travelled.
    pub edges: usize,
    /// Times that a vehicle was not let on.
    pub refused: usize,
    /// Vehicles that were taken out because they could not go on.
    pub taken_out: usize,
    /// Pairs of edges at one time whose distance was proved, or not.
    pub pairs: usize,
    /// Contacts, and what is not decided.
    pub contacts: Vec<ContactWitness>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    Out,
    Node(usize),
    Edge { edge: usize, back: bool, section: usize },
}

struct Vehicle {
    id: u64,
    place: Place,
    claim: ResourceClaim,
    goal: usize,
    refused: usize,
    /// Since when it is on its path, and what it does there.
    since: f64,
    /// Floor or map of its path.
    level: usize,
    curve: Vec<PlacedSegment>,
    phases: Vec<RawPhase>,
}

/// What a vehicle was on, and when.
struct Trip {
    mover: Mover,
    id: u64,
    level: usize,
    time: [f64; 2],
    bounds: [[f64; 2]; 2],
}

/// Fleet, layout and rules.
pub struct World<'a> {
    imported: &'a ImportedLayout,
    rules: &'a ExclusionRules,
    /// Of each edge, forward and backward.
    sections: Vec<[Vec<ClaimSpan>; 2]>,
    random: SplitMix64,
    vehicles: Vec<Vehicle>,
    /// Edges that leave each node, and whether backward.
    leaving: Vec<Vec<(usize, bool)>>,
    next_id: u64,
    trips: Vec<Trip>,
    run: Run,
}

/// Runs until so many missions are done, with a few vehicles.
pub fn run(imported: &ImportedLayout, rules: &ExclusionRules, missions: usize, seed: u64) -> Run {
    let layout = &imported.layout;
    let mut leaving = vec![Vec::new(); layout.nodes.len()];
    for (k, edge) in layout.edges.iter().enumerate() {
        let at = edge.ends.map(|node| layout.nodes[node].point);
        let ends = edge.curve.first().zip(edge.curve.last()).map_or(at, |(first, last)| [first.start, last.end()]);
        let reaches = (0..2).all(|k| (ends[k][0] - at[k][0]).hypot(ends[k][1] - at[k][1]) <= OFF);
        if reaches && layout.nodes[edge.ends[0]].level == layout.nodes[edge.ends[1]].level {
            edge.steps().for_each(|step| leaving[step.origin()].push((k, step.backward)));
        }
    }
    let count = (layout.nodes.len() / 6).clamp(2, 10);
    let vehicles = (0..count).map(|_| Vehicle {
        id: 0,
        place: Place::Out,
        claim: ResourceClaim::default(),
        goal: 0,
        refused: 0,
        since: 0.0,
        level: 0,
        curve: Vec::new(),
        phases: Vec::new(),
    });
    let vehicles = vehicles.collect();
    let mut world = World {
        imported,
        rules,
        sections: rules.edges.iter().map(|ways| [0, 1].map(|k: usize| ways[k].sections())).collect(),
        random: SplitMix64(seed),
        vehicles,
        leaving,
        next_id: 1,
        trips: Vec::new(),
        run: Run::default(),
    };
    world.drive(missions);
    world.run
}

impl World<'_> {
    fn drive(&mut self, missions: usize) {
        // Times in nanoseconds order as numbers do.
        let mut events: BinaryHeap<Reverse<(u64, usize)>> = (0..self.vehicles.len()).map(|k| Reverse((0, k))).collect();
        let steps = 4000 * (missions + 10);
        for _ in 0..steps {
            let Some(Reverse((nanos, k))) = events.pop() else { break };
            if self.run.missions >= missions {
                break;
            }
            let now = nanos as f64 * 1e-9;
            let next = self.step(k, now);
            events.push(Reverse(((next * 1e9).round().max(nanos as f64 + 1.0) as u64, k)));
            if self.trips.len() > 400 {
                self.prove(now);
            }
        }
        let end = events.iter().map(|Reverse((nanos, _))| *nanos as f64 * 1e-9).fold(0.0, f64::max);
        for k in 0..self.vehicles.len() {
            self.leave(k, end);
        }
        self.prove(f64::INFINITY);
    }

    /// Lets a vehicle go on at a time; returns when it does so again.
    fn step(&mut self, k: usize, now: f64) -> f64 {
        let wait = now + self.random.uniform(0.3, 2.0);
        match self.vehicles[k].place {
            Place::Out => {
                self.enter(k, now);
                wait
            }
            Place::Node(node) => {
                if self.vehicles[k].goal == node {
                    self.run.missions += 1;
                    self.vehicles[k].goal = self.random.below(self.leaving.len());
                }
                match self.way(k, node) {
                    Some((edge, back)) if self.is_free(k, self.claim_of(edge, back, 0)) => {
                        self.leave(k, now);
                        self.set_off(k, edge, back, now)
                    }
                    _ => self.hold(k, now, wait),
                }
            }
            Place::Edge { edge, back, section } => {
                let sections = &self.sections[edge][usize::from(back)];
                if section + 1 < sections.len() {
                    let next = &sections[section + 1].claim;
                    if !self.is_free(k, next) {
                        return self.hold(k, now, wait);
                    }
                    self.vehicles[k].claim = next.clone();
                    return self.travel(k, edge, back, section + 1, now);
                }
                let node = self.imported.layout.edges[edge].ends[usize::from(!back)];
                if !self.is_free(k, &self.rules.nodes[node]) {
                    return self.hold(k, now, wait);
                }
                let vehicle = &mut self.vehicles[k];
                vehicle.claim = self.rules.nodes[node].clone();
                (vehicle.place, vehicle.refused) = (Place::Node(node), 0);
                now + self.random.uniform(0.0, 3.0)
            }
        }
    }

    fn claim_of(&self, edge: usize, back: bool, section: usize) -> &ResourceClaim {
        &self.sections[edge][usize::from(back)][section].claim
    }

    /// Whether the others let a vehicle have a claim.
    fn is_free(&self, k: usize, claim: &ResourceClaim) -> bool {
        let mut others =
            self.vehicles.iter().enumerate().filter(|(other, vehicle)| *other != k && vehicle.place != Place::Out);
        !claim.closed && others.all(|(_, vehicle)| !vehicle.claim.keeps_out(claim))
    }

    /// Waits, or is taken out if that has no end.
    fn hold(&mut self, k: usize, now: f64, until: f64) -> f64 {
        self.run.refused += 1;
        self.vehicles[k].refused += 1;
        if self.vehicles[k].refused > STUCK {
            self.run.taken_out += 1;
            self.leave(k, now);
            self.vehicles[k].place = Place::Out;
        }
        until
    }

    /// Comes in at a node as if by an edge that ends there, by the last stretch of it.
    fn enter(&mut self, k: usize, now: f64) {
        let from = self.random.below(self.leaving.len());
        if self.leaving[from].is_empty() {
            return;
        }
        let (edge, back) = self.leaving[from][self.random.below(self.leaving[from].len())];
        let node = self.imported.layout.edges[edge].ends[usize::from(!back)];
        let sections = &self.sections[edge][usize::from(back)];
        let Some(last) = sections.last() else { return };
        // It must not be there against the will of one that is there already, nor come upon one.
        let others = self.vehicles.iter().filter(|vehicle| vehicle.place != Place::Out);
        let mutual = others.into_iter().all(|vehicle| !last.claim.keeps_out(&vehicle.claim));
        if !self.is_free(k, &last.claim) || !mutual || !self.is_free(k, &self.rules.nodes[node]) {
            return;
        }
        let at = self.imported.layout.nodes[node].point;
        let goal = self.random.below(self.leaving.len());
        self.vehicles[k] = Vehicle {
            id: self.next_id,
            place: Place::Node(node),
            claim: self.rules.nodes[node].clone(),
            goal,
            refused: 0,
            since: now,
            level: self.imported.layout.nodes[node].level,
            curve: vec![PlacedSegment::line(at, at)],
            phases: Vec::new(),
        };
        self.next_id += 1;
    }

    /// The next edge on the way of a vehicle, or any one that is free if it has waited long.
    fn way(&mut self, k: usize, node: usize) -> Option<(usize, bool)> {
        let all = &self.leaving[node];
        if all.is_empty() {
            return None;
        }
        let any = all[self.random.below(all.len())];
        if self.vehicles[k].refused > PATIENCE || self.random.unit() < 0.1 {
            return Some(any);
        }
        // Fewest edges to the goal.
        let goal = self.vehicles[k].goal;
        let mut first = vec![None; self.leaving.len()];
        let mut queue = VecDeque::from([node]);
        while let Some(at) = queue.pop_front() {
            for &(edge, back) in &self.leaving[at] {
                let to = self.imported.layout.edges[edge].ends[usize::from(!back)];
                if to != node && first[to].is_none() {
                    first[to] = if at == node { Some((edge, back)) } else { first[at] };
                    queue.push_back(to);
                }
            }
        }
        if first[goal].is_none() {
            self.vehicles[k].goal = self.random.below(self.leaving.len());
        }
        first[goal].or(Some(any))
    }

    fn set_off(&mut self, k: usize, edge: usize, back: bool, now: f64) -> f64 {
        let layout = &self.imported.layout;
        let ways = &layout.edges[edge].curve;
        let mut curve: Vec<PlacedSegment> =
            if back { ways.iter().rev().map(PlacedSegment::reversed).collect() } else { ways.clone() };
        if curve.is_empty() {
            let at = layout.nodes[layout.edges[edge].ends[0]].point;
            curve.push(PlacedSegment::line(at, at));
        }
        let claim = self.claim_of(edge, back, 0).clone();
        let vehicle = &mut self.vehicles[k];
        (vehicle.curve, vehicle.since, vehicle.refused, vehicle.claim) = (curve, now, 0, claim);
        vehicle.phases.clear();
        self.run.edges += 1;
        self.travel(k, edge, back, 0, now)
    }

    /// Travels a stretch at some speed, with a stop now and then; returns when it is through.
    fn travel(&mut self, k: usize, edge: usize, back: bool, section: usize, now: f64) -> f64 {
        let length = self.imported.layout.edges[edge].length();
        let sections = &self.sections[edge][usize::from(back)];
        let [from, to] = sections[section].length;
        let last = section + 1 == sections.len();
        let end = if last {
            length
        } else if back {
            length - from
        } else {
            to
        };
        self.vehicles[k].place = Place::Edge { edge, back, section };
        self.vehicles[k].refused = 0;
        self.stand(k, now);
        let begin = self.travelled(k);
        let end = end.max(begin);
        let mut time = now;
        let stop = if self.random.unit() < 0.2 { Some(self.random.uniform(begin, end)) } else { None };
        for to in stop.into_iter().chain([end]) {
            let here = self.travelled(k);
            let speed = self.random.uniform(0.2, 2.0);
            let duration = (to - here) / speed + 1e-3;
            self.phase(k, time, time + duration, to);
            time += duration;
            if to < end {
                let pause = self.random.uniform(0.1, 8.0);
                self.phase(k, time, time + pause, to);
                time += pause;
            }
        }
        time
    }

    fn travelled(&self, k: usize) -> f64 {
        self.vehicles[k].phases.last().map_or(0.0, |phase| phase.length[1])
    }

    /// Stands until now where it is.
    fn stand(&mut self, k: usize, now: f64) {
        let here = self.travelled(k);
        self.phase(k, now, now, here);
    }

    /// A phase that ends at a time and a length; what is between it and the one before is a wait.
    fn phase(&mut self, k: usize, from: f64, to: f64, length: f64) {
        let vehicle = &mut self.vehicles[k];
        let (mut time, here) = vehicle.phases.last().map_or((0.0, 0.0), |phase| (phase.time[1], phase.length[1]));
        let [from, to] = [from - vehicle.since, to - vehicle.since];
        if from > time {
            vehicle.phases.push(RawPhase { time: [time, from], length: [here; 2], speed: [0.0; 2] });
            time = from;
        }
        if to > time {
            let speed = (length - here) / (to - time);
            vehicle.phases.push(RawPhase { time: [time, to], length: [here, length], speed: [speed; 2] });
        }
    }

    /// It is no longer on its path: what it did there is kept.
    fn leave(&mut self, k: usize, now: f64) {
        if self.vehicles[k].place == Place::Out {
            return;
        }
        self.stand(k, now);
        let whole: f64 = self.vehicles[k].curve.iter().map(|piece| piece.shape.length()).sum();
        if self.travelled(k) < whole {
            // What is not there any more may go on.
            self.phase(k, now, now + 1.0, whole);
        }
        let vehicle = &mut self.vehicles[k];
        let radius = self.imported.vehicle.radius + self.imported.vehicle.margin;
        let agent = agent(vehicle, radius);
        let mover = Mover::new(&agent, [vehicle.since, now]).expect("a path and a motion on it");
        self.trips.push(Trip {
            mover,
            id: vehicle.id,
            level: vehicle.level,
            time: [vehicle.since, now],
            bounds: bounds(&vehicle.curve, radius),
        });
    }

    /// Proves all pairs of trips of which one has ended by now, and forgets what no later trip can meet.
    fn prove(&mut self, now: f64) {
        let since = self.vehicles.iter().filter(|vehicle| vehicle.place != Place::Out).map(|vehicle| vehicle.since);
        let oldest = since.fold(now, f64::min);
        let (done, later): (Vec<Trip>, Vec<Trip>) =
            std::mem::take(&mut self.trips).into_iter().partition(|trip| trip.time[1] <= oldest);
        for (k, own) in done.iter().enumerate() {
            for other in done[k + 1..].iter().chain(&later) {
                let apart =
                    (0..2).any(|x| own.bounds[0][x] > other.bounds[1][x] || other.bounds[0][x] > own.bounds[1][x]);
                let early = own.time[1] < other.time[0] || other.time[1] < own.time[0];
                if own.id == other.id || own.level != other.level || apart || early {
                    continue;
                }
                self.run.pairs += 1;
                let found = meetings(&[own.mover.clone(), other.mover.clone()]);
                self.run.contacts.extend(found.contacts.into_iter().chain(found.undecided));
            }
        }
        self.trips = later;
    }
}

/// The disc on its path, as the checker reads it.
fn agent(vehicle: &Vehicle, radius: f64) -> RawAgent {
    let (mut segments, mut total) = (Vec::new(), 0.0);
    let mut heading: Option<f64> = None;
    for piece in &vehicle.curve {
        let length = piece.shape.length();
        let turn = heading.map(|heading| piece.heading - heading).filter(|turn| *turn != 0.0);
        let bend = match piece.shape {
            PathSegment::Arc { radius, sweep, .. } => Some(radius * sweep.signum()),
            _ => None,
        };
        let turns = turn.map(RawAngle::Radians).into_iter().collect();
        segments.push(RawSegment { length, radius: bend, turns, from: total, to: total + length });
        total += length;
        heading = Some(piece.heading_at_end());
    }
    let first = vehicle.curve[0];
    let path = RawPath {
        start: first.start,
        heading: RawAngle::Radians(first.heading),
        segments,
        rounding: 1e-15 * total,
        step: 0.0,
    };
    let travel = RawMotion { start: vehicle.since, phases: vehicle.phases.clone(), lag: 0.0, time_excess: 0.0 };
    RawAgent { id: vehicle.id, radius, path, travel: Some(travel) }
}

/// A box around all discs on a curve.
fn bounds(curve: &[PlacedSegment], radius: f64) -> [[f64; 2]; 2] {
    let mut all = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for piece in curve {
        // No point of a piece is farther from where it begins than its length.
        let room = match piece.shape {
            PathSegment::Arc { .. } => piece.shape.length(),
            _ => 0.0,
        };
        for point in [piece.start, piece.end()] {
            for x in 0..2 {
                all[0][x] = all[0][x].min(point[x] - room - radius - 1e-6);
                all[1][x] = all[1][x].max(point[x] + room + radius + 1e-6);
            }
        }
    }
    all
}
