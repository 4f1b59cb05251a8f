//! Conflicts of the agents of a scenario as they move: the answer of `pcr check` in every format.
//!
//! The types match the JSON output, field by field in this order. All motions run from the earliest start to the latest
//! arrival; every agent stands at its start before its motion and at its end afterwards.

use crate::agent_regions::{BoxGrid, expanded_box};
use crate::bodies::{Body, BodyFleet};
use crate::certify::MotionCertificate;
use crate::failure::ComputationError;
use crate::fleet::HostScalar;
use crate::memory_budget::{self, MemoryBudget, MemoryDemand};
use crate::parallel;
use crate::regions::{AgentBodies, ProgressFn};
use pcr_core::{ClosestApproach, Encounter, Interval, Motion};
use pcr_formats::plane_geometry::distance;
use pcr_formats::scenario::{Labels, Scenario};
use serde::Serialize;
use std::cmp::Ordering;

/// Conflicts of one scenario, or why there is no answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckReport {
    /// Name of the scenario.
    pub name: String,
    /// Labels of the agents, by their numbers.
    #[serde(skip_serializing_if = "Labels::is_empty")]
    pub labels: Labels,
    /// Number of agents.
    #[serde(skip)]
    pub agents: usize,
    /// Sorted by their begin, then by the agents.
    pub conflicts: Vec<ConflictEntry>,
    /// Every pair, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closest: Option<Vec<ClosestApproachEntry>>,
    /// The bodies of agents that are several ones, as in [`crate::regions::RegionsReport`].
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<AgentBodies>,
    /// Result of the independent checker, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<MotionCertificate>,
    /// Why the scenario was refused.
    pub error: Option<String>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
}

/// Two agents in contact, from begin to end. Contacts deeper than [`Encounter::tolerance`] are always reported, agents that stay farther
/// apart than that never.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ConflictEntry {
    /// Number of an agent.
    pub i: u64,
    /// Number of the other one, larger.
    pub j: u64,
    /// Begin and end \[s\].
    pub t: [f64; 2],
    /// Largest overlap: the length of the least translation that separates the two, or of two of their convex parts \[m\].
    pub depth: f64,
    /// Lengths along the path of `i` meanwhile \[m\].
    pub l_i: [f64; 2],
    /// Lengths along the path of `j` meanwhile \[m\].
    pub l_j: [f64; 2],
    /// Whether the depth is at most the tolerance of the search (`Encounter::tolerance`).
    pub touching: bool,
}

impl ConflictEntry {
    /// By its begin, then by its agents.
    fn by_begin(&self, other: &Self) -> Ordering {
        self.t[0].total_cmp(&other.t[0]).then((self.i, self.j).cmp(&(other.i, other.j)))
    }
}

/// The closest approach of two agents.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ClosestApproachEntry {
    /// Number of an agent.
    pub i: u64,
    /// Number of the other one, larger.
    pub j: u64,
    /// First time of the closest approach \[s\].
    pub t: f64,
    /// Distance of the reference points \[m\].
    pub separation: f64,
    /// Distance of the outlines, below 0 that of the least translation that separates them \[m\].
    pub clearance: f64,
}

impl CheckReport {
    /// The conflicts of a scenario, computed in the format `S`.
    ///
    /// # Errors
    /// [`ComputationError`] if a value does not fit the format, or memory does not hold the answer.
    pub fn compute<S: HostScalar>(scenario: &Scenario, closest: bool) -> Result<Self, ComputationError> {
        Self::watched::<S>(scenario, closest, &|_, _| {})
    }

    /// The same, with reports of progress: done agents, and all agents.
    ///
    /// # Errors
    /// As [`CheckReport::compute`].
    pub fn watched<S: HostScalar>(
        scenario: &Scenario,
        closest: bool,
        told: ProgressFn<'_>,
    ) -> Result<Self, ComputationError> {
        let (fleet, bodies, agents) = BodyFleet::<S>::moving(scenario)?;
        Self::between(scenario, (&bodies, &agents), &fleet.motions(), closest, told)
    }

    /// Whether there is any conflict: the work ends with the first, and nothing is held.
    ///
    /// # Errors
    /// [`ComputationError`] where a value does not fit the format.
    pub fn any<S: HostScalar>(scenario: &Scenario, told: ProgressFn<'_>) -> Result<bool, ComputationError> {
        let (fleet, bodies, _) = BodyFleet::<S>::moving(scenario)?;
        let motions = fleet.motions();
        let pairs = PairFinder::new(scenario, &bodies, &motions);
        let count = pairs.ids.len();
        for first in (0..count).step_by(STRETCH) {
            let stretch = first..count.min(first + STRETCH);
            if parallel::any(stretch.clone(), &|agent| pairs.any(agent)) {
                return Ok(true);
            }
            told(stretch.end, count);
        }
        Ok(false)
    }

    /// Overlaps of margins: the conflicts of bodies enlarged by their margins.
    ///
    /// # Errors
    /// As [`CheckReport::compute`].
    pub(crate) fn of_margins<S: HostScalar>(scenario: &Scenario) -> Result<Self, ComputationError> {
        let (fleet, bodies, agents) = BodyFleet::<S>::moving(scenario)?;
        let motions: Vec<Motion<'_, S>> = fleet.motions().into_iter().map(Motion::inflated).collect();
        Self::between(scenario, (&bodies, &agents), &motions, false, &|_, _| {})
    }

    fn between<S: HostScalar>(
        scenario: &Scenario,
        (bodies, agents): (&[Body], &Scenario),
        motions: &[Motion<'_, S>],
        closest: bool,
        told: ProgressFn<'_>,
    ) -> Result<Self, ComputationError> {
        let pairs = PairFinder::new(scenario, bodies, motions);
        let count = pairs.ids.len();
        let (mut conflicts, mut nearest, mut held) = (Vec::new(), Vec::new(), MemoryBudget::default());
        if closest {
            let all = count.saturating_mul(count.saturating_sub(1)) / 2;
            let what = || format!("how near all {all} pairs come");
            // And those of one stretch, before they are with the others.
            let of_stretch = count.min(STRETCH).saturating_mul(count);
            let bytes = all.saturating_add(of_stretch).saturating_mul(size_of::<ClosestApproachEntry>());
            memory_budget::ask(bytes as u64, what)?;
            // As a whole: a list that grows is there twice.
            nearest.try_reserve_exact(all).map_err(|_| memory_budget::MemoryError::of(what()))?;
        }
        for first in (0..count).step_by(STRETCH) {
            let stretch = first..count.min(first + STRETCH);
            for (found, near) in parallel::map_parallel(stretch.clone(), &|agent| pairs.of(agent, closest)) {
                held.extend(&mut conflicts, found, 0, "conflicts")?;
                nearest.extend(near);
            }
            told(stretch.end, count);
        }
        // No two conflicts of the same agents begin at the same time.
        conflicts.sort_unstable_by(ConflictEntry::by_begin);
        Ok(Self {
            name: scenario.name.clone(),
            labels: Labels::from_scenario(scenario),
            agents: scenario.agents.len(),
            conflicts,
            closest: closest.then_some(nearest),
            bodies: AgentBodies::all(scenario, bodies, agents),
            certificate: None,
            warnings: scenario.warnings.clone(),
            error: None,
        })
    }

    /// Computes the report as [`CheckReport::compute`] does, with a certificate that a checker proved.
    ///
    /// # Errors
    /// As [`CheckReport::compute`], and [`ComputationError::NoPair`].
    pub fn certified<S: HostScalar>(
        scenario: &Scenario,
        closest: bool,
        told: ProgressFn<'_>,
    ) -> Result<Self, ComputationError> {
        let verdict = Self::watched::<S>(scenario, closest, told)?;
        // The checker has a list of its own.
        MemoryDemand::ConflictProof(verdict.conflicts.len()).ask()?;
        Ok(Self { certificate: Some(MotionCertificate::of_pairs::<S>(scenario)?), ..verdict })
    }

    /// An answer that says why there are no conflicts.
    pub fn refused(name: &str, error: String) -> Self {
        Self {
            name: name.to_owned(),
            labels: Labels::default(),
            agents: 0,
            conflicts: Vec::new(),
            closest: None,
            bodies: Vec::new(),
            certificate: None,
            warnings: Vec::new(),
            error: Some(error),
        }
    }
}

/// A body of an agent, and its motion.
type BodyMotion<'a, S> = (&'a Body, &'a Motion<'a, S>);

/// Number of agents between two reports of progress.
const STRETCH: usize = 1024;

/// The agents by their numbers, and the pairs that may come near each other.
struct PairFinder<'a, S: HostScalar> {
    /// Numbers of the agents.
    ids: Vec<u64>,
    /// The bodies of all agents, one agent after the other.
    bodies: Vec<BodyMotion<'a, S>>,
    /// For each agent the index of its first body, and the total number of bodies.
    begins: Vec<usize>,
    /// For each body the rank of its agent.
    ranks: Vec<usize>,
    grid: BoxGrid,
    /// From the first start to the last arrival \[s\].
    time: Interval<S>,
}

impl<'a, S: HostScalar> PairFinder<'a, S> {
    fn new(scenario: &Scenario, bodies: &'a [Body], motions: &'a [Motion<'a, S>]) -> Self {
        let time = Motion::span(motions);
        let order = by_number(scenario);
        let ids = order.iter().map(|&agent| scenario.agents[agent].id).collect();
        let mut rank_of = vec![0; order.len()];
        order.iter().enumerate().for_each(|(rank, &agent)| rank_of[agent] = rank);
        let ranks: Vec<usize> = bodies.iter().map(|body| rank_of[body.agent]).collect();
        let places = by_rank(&ranks);
        let mut begins = vec![0; order.len() + 1];
        ranks.iter().for_each(|rank| begins[rank + 1] += 1);
        (1..begins.len()).for_each(|rank| begins[rank] += begins[rank - 1]);
        let bodies = places.iter().map(|&body| (&bodies[body], &motions[body])).collect();
        let grid = BoxGrid::new(motions.iter().map(area).collect());
        Self { ids, bodies, begins, ranks, grid, time }
    }

    /// The number of an agent, and its bodies.
    fn agent(&self, rank: usize) -> (u64, &[BodyMotion<'a, S>]) {
        (self.ids[rank], &self.bodies[self.begins[rank]..self.begins[rank + 1]])
    }

    /// The agents of higher rank that may come near an agent.
    fn after(&self, agent: usize) -> Vec<usize> {
        let (mut near, mut after) = (Vec::new(), Vec::new());
        for (_, motion) in self.agent(agent).1 {
            self.grid.meeting(&area(motion), &mut near);
            after.extend(near.iter().map(|&body| self.ranks[body as usize]));
        }
        after.retain(|&other| other > agent);
        after.sort_unstable();
        after.dedup();
        after
    }

    /// Whether an agent has a conflict with an agent of higher rank.
    fn any(&self, agent: usize) -> bool {
        let is_in_conflict = |other: usize| {
            let (found, _) = encounters(self.agent(agent), self.agent(other), self.time, false);
            !found.is_empty()
        };
        self.after(agent).into_iter().any(is_in_conflict)
    }

    /// The conflicts of an agent with agents of higher rank; with `closest` also the closest approaches.
    fn of(&self, agent: usize, closest: bool) -> (Vec<ConflictEntry>, Vec<ClosestApproachEntry>) {
        let others = if closest { (agent + 1..self.ids.len()).collect() } else { self.after(agent) };
        let (mut conflicts, mut nearest) = (Vec::new(), Vec::new());
        for other in others {
            let (found, near) = encounters(self.agent(agent), self.agent(other), self.time, closest);
            conflicts.extend(found);
            nearest.extend(near);
        }
        (conflicts, nearest)
    }
}

/// The agents in the order of their numbers.
fn by_number(scenario: &Scenario) -> Vec<usize> {
    let mut order: Vec<usize> = (0..scenario.agents.len()).collect();
    order.sort_by_key(|&agent| scenario.agents[agent].id);
    order
}

/// The bodies in the order of the ranks of their agents.
fn by_rank(ranks: &[usize]) -> Vec<usize> {
    let mut places: Vec<usize> = (0..ranks.len()).collect();
    places.sort_by_key(|&body| ranks[body]);
    places
}

/// The area outside of which a body is in no contact.
fn area<S: HostScalar>(motion: &Motion<'_, S>) -> [f64; 4] {
    let reach = (motion.radius() + Encounter::new(motion, motion).tolerance()).to_f64();
    expanded_box(motion, reach)
}

/// The conflicts of two agents, and their closest approach if requested.
fn encounters<S: HostScalar>(
    (i, first): (u64, &[BodyMotion<'_, S>]),
    (j, second): (u64, &[BodyMotion<'_, S>]),
    time: Interval<S>,
    closest: bool,
) -> (Vec<ConflictEntry>, Option<ClosestApproachEntry>) {
    let mut found: Vec<ConflictEntry> = Vec::new();
    let mut closest_of: Option<ClosestApproachEntry> = None;
    for (own, other) in first.iter().flat_map(|own| second.iter().map(move |other| (own, other))) {
        let [own_time, their_time] = [own, other].map(|(body, motion)| body.time(motion, time));
        let time = Interval { lo: own_time.lo.max(their_time.lo), hi: own_time.hi.min(their_time.hi) };
        if time.lo > time.hi {
            continue;
        }
        let encounter = Encounter::new(own.1, other.1);
        found.extend(encounter.conflicts(time).map(|conflict| ConflictEntry {
            i,
            j,
            t: ends(conflict.time),
            depth: conflict.depth.to_f64(),
            l_i: own.0.on_agent(ends(conflict.length)),
            l_j: other.0.on_agent(ends(conflict.other_length)),
            touching: conflict.touching,
        }));
        if closest {
            let approach = encounter.closest(time);
            let clearance = (approach.separation - encounter.radius()).to_f64();
            if closest_of.is_none_or(|closest| clearance < closest.clearance) {
                let t = approach.time.to_f64();
                closest_of = Some(ClosestApproachEntry {
                    i,
                    j,
                    t,
                    separation: separation([own.1, other.1], &approach),
                    clearance,
                });
            }
        }
    }
    (if first.len() * second.len() > 1 { joined(found) } else { found }, closest_of)
}

/// Distance of the centres at the closest approach \[m\].
fn separation<S: HostScalar>(motions: [&Motion<'_, S>; 2], approach: &ClosestApproach<S>) -> f64 {
    if motions.iter().all(|motion| motion.outline().corners().is_empty()) {
        return approach.separation.to_f64();
    }
    let [a, b] = motions.map(|motion| motion.position_at(approach.time)).map(|at| [at.x.to_f64(), at.y.to_f64()]);
    distance(a, b)
}

/// Times that differ by less are equal, for rounding \[s\].
const NEAR: f64 = 1e-9;

/// The conflicts of two agents from those of their bodies; successive contacts are joined.
fn joined(mut conflicts: Vec<ConflictEntry>) -> Vec<ConflictEntry> {
    conflicts.sort_by(|a, b| a.t[0].total_cmp(&b.t[0]));
    let hull = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
    let mut joined: Vec<ConflictEntry> = Vec::new();
    for next in conflicts {
        match joined.last_mut() {
            Some(last) if next.t[0] <= last.t[1] + NEAR => {
                (last.t, last.depth) = (hull(last.t, next.t), last.depth.max(next.depth));
                (last.l_i, last.l_j) = (hull(last.l_i, next.l_i), hull(last.l_j, next.l_j));
                last.touching &= next.touching;
            }
            _ => joined.push(next),
        }
    }
    joined
}

fn ends<S: HostScalar>(interval: Interval<S>) -> [f64; 2] {
    [interval.lo.to_f64(), interval.hi.to_f64()]
}
