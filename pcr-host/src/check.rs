//! Whether the agents of a scenario collide as they move: what `pcr check` prints in every format.
//!
//! The types are the JSON output, field for field in this order. All motions run from the earliest start to the latest
//! arrival; every agent stands at its start before and at its end after its motion.

use crate::fleet::{Fleet, Format, Refused};
use crate::scenario::Scenario;
use pcr_core::{Encounter, Interval, Motion};
use serde::Serialize;

/// Conflicts of one scenario, or why there is no answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Name of the scenario.
    pub name: String,
    /// Sorted by their begin, then by the agents.
    pub conflicts: Vec<Conflict>,
    /// Every pair, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closest: Option<Vec<Closest>>,
    /// Why the scenario was refused.
    pub error: Option<String>,
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
        let fleet = Fleet::<S>::new(scenario)?;
        let motions = fleet.motions();
        let time = motions.iter().map(Motion::time).reduce(Interval::hull).unwrap_or_default();
        let mut agents: Vec<(u64, &Motion<'_, S>)> =
            scenario.agents.iter().map(|agent| agent.id).zip(&motions).collect();
        agents.sort_by_key(|&(id, _)| id);
        let pairs = agents.iter().enumerate().flat_map(|(k, a)| agents[k + 1..].iter().map(move |b| (a, b)));
        let (mut conflicts, mut nearest) = (Vec::new(), Vec::new());
        for (&(i, first), &(j, second)) in pairs {
            let encounter = Encounter::new(first, second);
            conflicts.extend(encounter.conflicts(time).map(|conflict| Conflict {
                i,
                j,
                t: ends(conflict.time),
                depth: conflict.depth.to_f64(),
                l_i: ends(conflict.length),
                l_j: ends(conflict.other_length),
                touching: conflict.touching,
            }));
            if closest {
                let approach = encounter.closest(time);
                let clearance = (approach.separation - encounter.radius()).to_f64();
                let (t, separation) = (approach.time.to_f64(), approach.separation.to_f64());
                nearest.push(Closest { i, j, t, separation, clearance });
            }
        }
        // Stable: those that begin together stay in the order of the agents.
        conflicts.sort_by(|a, b| a.t[0].total_cmp(&b.t[0]));
        Ok(Self { name: scenario.name.clone(), conflicts, closest: closest.then_some(nearest), error: None })
    }

    /// No answer, and why.
    pub fn refused(name: &str, error: String) -> Self {
        Self { name: name.to_owned(), conflicts: Vec::new(), closest: None, error: Some(error) }
    }
}

fn ends<S: Format>(interval: Interval<S>) -> [f64; 2] {
    [interval.lo.to_f64(), interval.hi.to_f64()]
}
