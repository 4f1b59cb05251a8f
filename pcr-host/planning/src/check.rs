//! Whether the agents of a scenario collide as they move: what `pcr check` prints in every format.
//!
//! The types are the JSON output, field for field in this order. All motions run from the earliest start to the latest
//! arrival; every agent stands at its start before and at its end after its motion.

use crate::bodies::{Bodies, Disced};
use crate::certify::Proof;
use crate::fleet::{Format, Refused};
use pcr_core::{Encounter, Interval, Motion};
use pcr_formats::scenario::{Labels, Scenario};
use serde::Serialize;

/// Conflicts of one scenario, or why there is no answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Name of the scenario.
    pub name: String,
    /// What the agents are called, by their numbers.
    #[serde(skip_serializing_if = "Labels::is_empty")]
    pub labels: Labels,
    /// Sorted by their begin, then by the agents.
    pub conflicts: Vec<Conflict>,
    /// Every pair, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closest: Option<Vec<Closest>>,
    /// What an independent checker has proved, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Proof>,
    /// Why the scenario was refused.
    pub error: Option<String>,
    /// What was read otherwise than it was written.
    pub warnings: Vec<String>,
}

/// Two discs in contact, from begin to end. What is deeper than [`Encounter::tolerance`] is always there, what is
/// clearer never.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Conflict {
    /// Number of an agent.
    pub i: u64,
    /// Number of the other one, larger.
    pub j: u64,
    /// From when to when \[s\].
    pub t: [f64; 2],
    /// Largest overlap: sum of the radii less the separation \[m\].
    pub depth: f64,
    /// Lengths along the path of `i` meanwhile \[m\].
    pub l_i: [f64; 2],
    /// Lengths along the path of `j` meanwhile \[m\].
    pub l_j: [f64; 2],
    /// Whether the depth is within the tolerance of 0.
    pub touching: bool,
}

/// How near two agents come.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Closest {
    /// Number of an agent.
    pub i: u64,
    /// Number of the other one, larger.
    pub j: u64,
    /// When, for the first time \[s\].
    pub t: f64,
    /// Distance of the centres \[m\].
    pub separation: f64,
    /// Separation less the radii \[m\].
    pub clearance: f64,
}

impl Verdict {
    /// The conflicts of a scenario, computed in the format `S`.
    ///
    /// # Errors
    /// [`Refused`] where a value does not fit the format.
    pub fn of<S: Format>(scenario: &Scenario, closest: bool) -> Result<Self, Refused> {
        let Bodies { fleet, discs, .. } = Bodies::<S>::new(scenario)?;
        let motions = fleet.motions();
        let time = motions.iter().map(Motion::time).reduce(Interval::hull).unwrap_or_default();
        let mut agents: Vec<(u64, Vec<Body<'_, S>>)> =
            scenario.agents.iter().map(|agent| (agent.id, Vec::new())).collect();
        for body in discs.iter().zip(&motions) {
            if let Some((_, bodies)) = agents.get_mut(body.0.agent) {
                bodies.push(body);
            }
        }
        agents.sort_by_key(|&(id, _)| id);
        let pairs = agents.iter().enumerate().flat_map(|(k, a)| agents[k + 1..].iter().map(move |b| (a, b)));
        let (mut conflicts, mut nearest) = (Vec::new(), Vec::new());
        for ((i, first), (j, second)) in pairs {
            let mut found: Vec<Conflict> = Vec::new();
            let mut closest_of: Option<Closest> = None;
            for (own, other) in first.iter().flat_map(|own| second.iter().map(move |other| (own, other))) {
                let [own_time, their_time] = [own, other].map(|(disc, motion)| disc.time(motion, time));
                let time = Interval { lo: own_time.lo.max(their_time.lo), hi: own_time.hi.min(their_time.hi) };
                if time.lo > time.hi {
                    continue;
                }
                let encounter = Encounter::new(own.1, other.1);
                found.extend(encounter.conflicts(time).map(|conflict| Conflict {
                    i: *i,
                    j: *j,
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
                        let (t, separation) = (approach.time.to_f64(), approach.separation.to_f64());
                        closest_of = Some(Closest { i: *i, j: *j, t, separation, clearance });
                    }
                }
            }
            conflicts.extend(if first.len() * second.len() > 1 { joined(found) } else { found });
            nearest.extend(closest_of);
        }
        // Stable: those that begin together stay in the order of the agents.
        conflicts.sort_by(|a, b| a.t[0].total_cmp(&b.t[0]));
        Ok(Self {
            name: scenario.name.clone(),
            labels: Labels::of(scenario),
            conflicts,
            closest: closest.then_some(nearest),
            certificate: None,
            warnings: scenario.warnings.clone(),
            error: None,
        })
    }

    /// The same with a certificate.
    ///
    /// # Errors
    /// As [`Verdict::of`].
    pub fn certified<S: Format>(scenario: &Scenario, closest: bool) -> Result<Self, Refused> {
        let certificate = Some(Proof::of::<S>(scenario)?);
        Ok(Self { certificate, ..Self::of::<S>(scenario, closest)? })
    }

    /// No answer, and why.
    pub fn refused(name: &str, error: String) -> Self {
        Self {
            name: name.to_owned(),
            labels: Labels::default(),
            conflicts: Vec::new(),
            closest: None,
            certificate: None,
            warnings: Vec::new(),
            error: Some(error),
        }
    }
}

/// A disc of an agent, and its motion.
type Body<'a, S> = (&'a Disced, &'a Motion<'a, S>);

/// Times that are one but for rounding \[s\].
const NEAR: f64 = 1e-9;

/// The conflicts of two agents by those of their discs: what lasts on is one.
fn joined(mut conflicts: Vec<Conflict>) -> Vec<Conflict> {
    conflicts.sort_by(|a, b| a.t[0].total_cmp(&b.t[0]));
    let hull = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].max(b[1])];
    let mut joined: Vec<Conflict> = Vec::new();
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

fn ends<S: Format>(interval: Interval<S>) -> [f64; 2] {
    [interval.lo.to_f64(), interval.hi.to_f64()]
}
