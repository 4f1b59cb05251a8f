//! The collision regions of a scenario as plain numbers: the answer of `pcr regions` in every format.
//!
//! The types match the JSON output, field by field in this order. All numbers are `f64` and hold the results of the
//! chosen number format exactly, hence rounded outward.

pub(crate) mod certificate_tables;
mod entries;
mod footprint_regions;
mod region_job;
#[cfg(test)]
mod tests;

pub use crate::agent_regions::ProgressFn;
use crate::certify::CertificateTable;
use crate::disc_fleet::BodyDisc;
use crate::failure::ComputationError;
use crate::fleet::{HostEcm, HostPrecedenceTable, HostScalar, build_ecm, build_orders};
use crate::memory_budget::MemoryError;
pub use certificate_tables::table_of;
pub use entries::{CrossSectionEntry, CrossingDescriptor, PieceEntry, RegionEntry};
use pcr_core::{CapacityError, Motion};
use pcr_formats::footprint::CoverDisc;
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
    /// The same for the discs with their margins, if any agent has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin_regions: Option<Vec<RegionEntry>>,
    /// The covers of the agents whose outlines are not computed as they are, if there are any; of an agent with loads those of all its
    /// stretches.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub footprints: Vec<DiscCover>,
    /// The tables as they are held, of contact and of margins, for `pcr certify`; if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Vec<CertificateTable>>,
    /// Why the scenario was refused.
    pub error: Option<String>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
}

/// The discs that an agent with a footprint, or with loads, is computed with.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DiscCover {
    /// Number of the agent.
    pub id: u64,
    /// First and last segment of its path with this outline, counted from 1; none where it is the same on all of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub segments: Option<[usize; 2]>,
    /// No point of a disc is farther than this from the outline \[m\]; 0 where the outline is a disc.
    pub overhang: f64,
    /// How much larger the discs are in motion at most \[m\]: for turns, changes of speed, and digits that a number format does
    /// not have.
    pub growth: f64,
    /// The discs.
    pub discs: Vec<CoverDisc>,
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
        CapacityError::Regions | CapacityError::Pieces | CapacityError::Orders => {
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
            footprints: Vec::new(),
            warnings: Vec::new(),
            certificate: None,
            error: Some(error),
        }
    }
}

impl DiscCover {
    /// The covers of all agents of a scenario with these bodies, which are in the order of the agents.
    pub(crate) fn all(scenario: &Scenario, bodies: &[BodyDisc]) -> Vec<Self> {
        let own = bodies.chunk_by(|a, b| a.agent == b.agent);
        own.flat_map(|own| Self::of(&scenario.agents[own[0].agent], own)).collect()
    }

    /// The covers of an agent: one for each stretch of its path with another outline, with the resulting discs; none of one that is
    /// computed as it is.
    fn of(agent: &Agent, own: &[BodyDisc]) -> Vec<Self> {
        if agent.loads.is_empty() && own.iter().all(BodyDisc::is_whole) {
            return Vec::new();
        }
        let covers = agent.outlines().into_iter().filter_map(|outline| {
            let segments = (!agent.loads.is_empty()).then(|| outline.segments.map(|segment| segment + 1));
            let own = own.iter().filter(|disc| disc.first() == outline.segments[0]);
            let growth = own.map(|disc| disc.growth).fold(0.0, f64::max);
            let (overhang, discs) = match outline.footprint {
                Some(footprint) => (footprint.overhang(), footprint.discs().to_vec()),
                None if agent.loads.is_empty() => return None,
                None => (0.0, vec![CoverDisc { ahead: 0.0, left: 0.0, radius: outline.radius }]),
            };
            Some(Self { id: agent.id, segments, overhang, growth, discs })
        });
        covers.collect()
    }
}
