//! The collision regions of a scenario as plain numbers: the answer of `pcr regions` in every format.
//!
//! The types match the JSON output, field by field in this order. All numbers are `f64` and hold the results of the
//! chosen number format exactly, hence rounded outward.

mod body_regions;
pub(crate) mod certificate_tables;
mod entries;
mod region_job;
#[cfg(test)]
mod tests;

pub use crate::agent_regions::ProgressFn;
use crate::bodies::Body;
use crate::certify::CertificateTable;
use crate::failure::ComputationError;
use crate::fleet::{HostEcm, HostPrecedenceTable, HostScalar, build_ecm, build_orders};
use crate::memory_budget::MemoryError;
pub use certificate_tables::table_of;
pub use entries::{CrossSectionEntry, CrossingDescriptor, PieceEntry, RegionEntry};
use pcr_core::{CapacityError, Motion};
use pcr_formats::scenario::{Agent, Labels, Scenario};
pub use region_job::RegionJob;
use serde::Serialize;

/// Regions of one scenario, or why there are none.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RegionsReport {
    /// Name of the scenario.
    pub name: String,
    /// Labels of the agents, by their numbers.
    #[serde(skip_serializing_if = "Labels::is_empty")]
    pub labels: Labels,
    /// Number format of the computation.
    pub scalar: &'static str,
    /// The agent that was asked for: there are only regions that it has to keep out of.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub agent: Option<u64>,
    /// Sorted by `i`, `j`, start time and start length.
    pub regions: Vec<RegionEntry>,
    /// Regions of the discs with their margins, sorted like `regions`, if any agent has a margin.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin_regions: Option<Vec<RegionEntry>>,
    /// The bodies of the agents that are several ones, or whose path has lengths for turns in place, if there are any.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bodies: Vec<AgentBodies>,
    /// The tables as they are held, of contact and of margins, for `pcr certify`; if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Vec<CertificateTable>>,
    /// Why the scenario was refused.
    pub error: Option<String>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
}

/// The convex bodies that an agent, or one with its load, is computed as.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AgentBodies {
    /// Number of the agent.
    pub id: u64,
    /// First and last segment of its path with these bodies, counted from 1; none where they are the same on all of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub segments: Option<[usize; 2]>,
    /// Each of them.
    pub parts: Vec<BodyShape>,
}

/// A convex polygon, rounded by a radius.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BodyShape {
    /// Corners, ahead and left of the reference point \[m\]; none of a disc about that point.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub polygon: Vec<[f64; 2]>,
    /// \[m\]
    pub radius: f64,
}

/// The options of a request for regions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RegionOptions {
    /// Only the regions of the agent of this number.
    pub agent: Option<u64>,
    /// Number of slices for each region.
    pub slices: Option<usize>,
    /// Whether the tables are included.
    pub certificate: bool,
}

/// The extended collision map of a scenario.
///
/// # Errors
/// [`ComputationError::Overfull`] with the pair that the table cannot hold, [`ComputationError::Full`] for too many agents.
pub fn table<S: HostScalar>(scenario: &Scenario, motions: &[Motion<'_, S>]) -> Result<HostEcm<S>, ComputationError> {
    build_ecm(motions).map_err(|full| unfit(full, scenario, motions.len()))
}

/// The passing orders of a scenario, of which none is decided.
///
/// # Errors
/// As [`table`].
pub fn orders(scenario: &Scenario, motions: &[Motion<'_, f64>]) -> Result<HostPrecedenceTable, ComputationError> {
    build_orders(motions).map_err(|full| unfit(full, scenario, motions.len()))
}

fn unfit(full: CapacityError, scenario: &Scenario, discs: usize) -> ComputationError {
    match full {
        CapacityError::Regions { .. } | CapacityError::Pieces { .. } | CapacityError::Orders { .. } => {
            MemoryError::of(format!("the table of all pairs of {discs} discs")).into()
        }
        full => ComputationError::Full(full).named(scenario),
    }
}

/// The number of the agent that is asked for by its number or, where there is no such number, by its label.
///
/// # Errors
/// [`ComputationError::NoSuchAgent`], [`ComputationError::Twofold`] for a number that is a label, too, and, for texts, [`ComputationError::NoSuchLabel`] or,
/// where several have it, [`ComputationError::Ambiguous`].
pub fn find(scenario: &Scenario, asked: &str) -> Result<u64, ComputationError> {
    let number = asked.parse::<u64>().ok();
    let ids = || scenario.agents.iter().map(|agent| agent.id);
    let labelled: Vec<u64> =
        scenario.agents.iter().filter(|agent| agent.label == asked).map(|agent| agent.id).collect();
    if let Some(id) = number.filter(|number| ids().any(|id| id == *number)) {
        let others: Vec<u64> = labelled.into_iter().filter(|other| *other != id).collect();
        return if others.is_empty() { Ok(id) } else { Err(ComputationError::Twofold(id, asked.to_owned(), others)) };
    }
    match (labelled.as_slice(), number) {
        ([id], _) => Ok(*id),
        ([], Some(number)) => Err(ComputationError::NoSuchAgent(number, ids().collect())),
        ([], None) => Err(ComputationError::NoSuchLabel(
            asked.to_owned(),
            scenario.agents.iter().map(Agent::display_name).collect(),
        )),
        _ => Err(ComputationError::Ambiguous(asked.to_owned(), labelled)),
    }
}

impl RegionsReport {
    /// The regions of a scenario, computed in the format `S`.
    ///
    /// # Errors
    /// [`ComputationError`] where a value does not fit the format, the agent asked for is not there, or memory does not hold all regions.
    pub fn compute<S: HostScalar>(scenario: &Scenario, request: RegionOptions) -> Result<Self, ComputationError> {
        RegionJob::<S>::new(scenario, request)?.answer(&|_, _| {})
    }

    /// No regions, and why.
    pub fn refused<S: HostScalar>(name: &str, error: String) -> Self {
        Self {
            name: name.to_owned(),
            labels: Labels::default(),
            scalar: S::NAME,
            agent: None,
            regions: Vec::new(),
            margin_regions: None,
            bodies: Vec::new(),
            warnings: Vec::new(),
            certificate: None,
            error: Some(error),
        }
    }
}

impl AgentBodies {
    /// The bodies of all agents of a scenario: `bodies` and `agents` are in the order of its agents.
    pub(crate) fn all(scenario: &Scenario, bodies: &[Body], agents: &Scenario) -> Vec<Self> {
        if bodies.iter().all(Body::is_whole) && bodies.len() == scenario.agents.len() {
            return Vec::new();
        }
        let mut all: Vec<Self> = Vec::new();
        let mut first = None;
        for (body, agent) in bodies.iter().zip(&agents.agents) {
            let own = &scenario.agents[body.agent];
            if body.is_whole() && !own.has_parts() {
                continue;
            }
            let shape = BodyShape::of(agent);
            let place = Some([body.agent, body.first()]);
            match all.last_mut() {
                Some(last) if place == first => last.parts.push(shape),
                _ => {
                    let stretch = own
                        .outlines()
                        .into_iter()
                        .find(|outline| own.file_segment(outline.segments[0]) == body.first());
                    let segments = stretch
                        .filter(|_| !own.loads.is_empty())
                        .map(|it| it.segments.map(|k| own.file_segment(k) + 1));
                    all.push(Self { id: own.id, segments, parts: vec![shape] });
                }
            }
            first = place;
        }
        all
    }
}

impl BodyShape {
    fn of(agent: &Agent) -> Self {
        match &agent.footprint {
            Some(footprint) => Self { polygon: footprint.polygon().to_vec(), radius: footprint.growth() },
            None => Self { polygon: Vec::new(), radius: agent.radius },
        }
    }
}
