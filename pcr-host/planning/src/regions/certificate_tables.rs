//! The tables of a scenario in the form that the checker takes, for fleets of any size.

use crate::disc_fleet::{DiscFleet, Form};
use crate::failure::ComputationError;
use crate::fleet::HostScalar;
use crate::{agent_regions, checker_input, memory_budget};
use pcr_certify::raw::{RawAgent, RawTable};
use pcr_certify::table::ProximityIndex;
use pcr_core::{Motion, excess};
use pcr_formats::scenario::Scenario;

/// Memory of a segment in a table and in the checker \[bytes\].
const SEGMENT_BYTES: u64 = 800;

/// The tables of a scenario, to be certified: that of contact, and that in which margins overlap, if any agent has one. The checker knows
/// discs, so all footprints are covered.
///
/// # Errors
/// [`ComputationError`] where a value does not fit the format, or memory does not hold the tables.
pub fn table_of<S: HostScalar>(scenario: &Scenario) -> Result<Vec<RawTable>, ComputationError> {
    let segments: usize = scenario.agents.iter().map(|agent| agent.path.len()).sum();
    memory_budget::ask(segments as u64 * SEGMENT_BYTES, || format!("the proof for {segments} segments"))?;
    let DiscFleet { scenario: discs, fleet, discs: owners } = DiscFleet::<S>::new(scenario, Form::Covers)?;
    let motions = fleet.motions();
    let ids: Vec<u64> = owners.iter().map(|disc| scenario.agents[disc.agent].id).collect();
    checker_input::as_given::<S>(&discs, &checker_input::agents(&fleet, &motions, &ids))
        .map_err(ComputationError::Misread)?;
    let mut tables = vec![motions.clone()];
    if motions.iter().any(|motion| motion.margin() > S::ZERO) {
        tables.push(motions.iter().map(|motion| motion.inflated()).collect());
    }
    let certificate = |motions: &Vec<_>| {
        let agents = checker_input::agents(&fleet, motions, &ids);
        of_rows(agents, motions).map_err(|failure| failure.named(&discs))
    };
    tables.iter().map(certificate).collect()
}

/// The table of a fleet of any size, row by row: of the pairs that come near one another, by what the checker takes for near.
///
/// # Errors
/// As [`agent_regions::AgentRegions::new`], and [`MemoryError`](memory_budget::MemoryError) where memory does not hold the pairs.
fn of_rows<S: HostScalar>(agents: Vec<RawAgent>, motions: &[Motion<'_, S>]) -> Result<RawTable, ComputationError> {
    // The excess of a pair has three parts, of the extents, of the lags and of the rounding of arcs of both agents. Each is at most
    // the largest excess of an agent with itself, hence their sum at most three times that.
    let largest = motions.iter().map(|motion| excess(motion, motion).to_f64()).fold(0.0, f64::max);
    let apart = 3.0 * largest.max(1e-100);
    let Ok(close) = ProximityIndex::new(&agents, apart) else {
        // The checker says what is wrong.
        return Ok(RawTable { agents, pairs: Vec::new(), apart: None });
    };
    let near = |i: usize| {
        let own = agents.get(i).map(|agent| agent.id);
        close.after(i).into_iter().filter(|&j| agents.get(j).map(|agent| agent.id) != own).collect::<Vec<_>>()
    };
    let count: u64 = (0..agents.len()).map(|i| near(i).len() as u64).sum();
    memory_budget::ask(count * PAIR_BYTES, || {
        format!("the certificate of {count} pairs of discs that come near one another")
    })?;
    let pairs = agent_regions::gathered(motions, "pairs", |row| {
        let i = row.agents()[row.agent_index()] as usize;
        let told = |j: usize| {
            let regions = row.pair(i, j).expect("the row of the agent");
            checker_input::pair([i, j], [&motions[i], &motions[j]], regions)
        };
        near(i).into_iter().map(told).collect()
    })?;
    Ok(RawTable { agents, pairs, apart: Some(apart) })
}

/// Memory for a pair of discs in a certificate and in the checker \[bytes\].
const PAIR_BYTES: u64 = 128;
