//! The tables of a scenario in the form that the checker takes, for fleets of any size.

use crate::agent_regions;
use crate::bodies::BodyFleet;
use crate::certify::CertificateTable;
use crate::checker_input::{self, outlines};
use crate::failure::ComputationError;
use crate::fleet::HostScalar;
use crate::memory_budget::MemoryDemand;
use pcr_certify::outline::{RawBody, RawOutlineTable};
use pcr_certify::raw::{RawAgent, RawTable};
use pcr_certify::table::ProximityIndex;
use pcr_core::{Motion, RegionRef, excess};
use pcr_formats::scenario::Scenario;

/// The tables of a scenario, to be certified: that of contact, and that in which margins overlap, if any agent has one. They are tables of
/// discs if all agents are computed as such.
///
/// # Errors
/// [`ComputationError`] where a value does not fit the format, or memory does not hold the tables.
pub fn table_of<S: HostScalar>(scenario: &Scenario) -> Result<Vec<CertificateTable>, ComputationError> {
    let segments: usize = scenario.agents.iter().map(|agent| agent.path.len()).sum();
    MemoryDemand::SegmentProof(segments).ask()?;
    let BodyFleet { scenario: given, fleet, bodies: owners } = BodyFleet::<S>::new(scenario)?;
    let motions = fleet.motions();
    let ids: Vec<u64> = owners.iter().map(|disc| scenario.agents[disc.agent].id).collect();
    let has_outlines = motions.iter().any(outlines::is_body);
    let agents = checker_input::agents(&fleet, &motions, &ids);
    if has_outlines {
        outlines::as_given::<S>(&given, &agents, &outlines::bodies(&fleet, agents.clone(), &motions))
    } else {
        checker_input::as_given::<S>(&given, &agents)
    }
    .map_err(ComputationError::Misread)?;
    let mut tables = vec![motions.clone()];
    if motions.iter().any(|motion| motion.margin() > S::ZERO) {
        tables.push(motions.iter().map(|motion| motion.inflated()).collect());
    }
    let certificate = |motions: &Vec<Motion<'_, S>>| {
        let agents = checker_input::agents(&fleet, motions, &ids);
        let table = if has_outlines {
            of_bodies(outlines::bodies(&fleet, agents, motions), motions).map(CertificateTable::from)
        } else {
            of_discs(agents, motions).map(CertificateTable::from)
        };
        table.map_err(|failure| failure.named(&given))
    };
    tables.iter().map(certificate).collect()
}

/// ε of pairs that are left out because they are far apart \[m\].
fn apart<S: HostScalar>(motions: &[Motion<'_, S>]) -> f64 {
    // The excess of a pair has three parts, of the extents, of the lags and of the rounding of arcs of both agents. Each is at most
    // the largest excess of an agent with itself, hence their sum at most three times that.
    let largest = motions.iter().map(|motion| excess(motion, motion).to_f64()).fold(0.0, f64::max);
    3.0 * largest.max(1e-100)
}

/// The table of a fleet of discs of any size.
fn of_discs<S: HostScalar>(agents: Vec<RawAgent>, motions: &[Motion<'_, S>]) -> Result<RawTable, ComputationError> {
    let apart = apart(motions);
    let Ok(close) = ProximityIndex::new(&agents, apart) else {
        // The checker says what is wrong.
        return Ok(RawTable { agents, pairs: Vec::new(), apart: None });
    };
    let ids: Vec<u64> = agents.iter().map(|agent| agent.id).collect();
    let pairs = of_rows(&ids, &close, motions, |places, both, regions| checker_input::pair(places, both, regions))?;
    Ok(RawTable { agents, pairs, apart: Some(apart) })
}

/// The table of a fleet of outlines and discs of any size.
fn of_bodies<S: HostScalar>(
    bodies: Vec<RawBody>,
    motions: &[Motion<'_, S>],
) -> Result<RawOutlineTable, ComputationError> {
    let apart = apart(motions);
    let Ok(close) = ProximityIndex::of_bodies(&bodies, apart) else {
        // The checker says what is wrong.
        return Ok(RawOutlineTable { bodies, pairs: Vec::new(), apart: None });
    };
    let ids: Vec<u64> = bodies.iter().map(|body| body.id).collect();
    let pairs = of_rows(&ids, &close, motions, |places, both, regions| outlines::pair(places, both, regions))?;
    Ok(RawOutlineTable { bodies, pairs, apart: Some(apart) })
}

/// The regions of two motions, in the order of the table.
type PairRegions<'r, 'a, S> = &'r mut dyn Iterator<Item = RegionRef<'a, S>>;

/// What is `made` of all pairs of bodies with different numbers that come near one another, by what the checker takes for near.
///
/// # Errors
/// As [`agent_regions::AgentRegions::new`], and [`MemoryError`](crate::memory_budget::MemoryError) where memory does not hold the pairs.
fn of_rows<'m, S: HostScalar, T: Send>(
    ids: &[u64],
    close: &ProximityIndex,
    motions: &[Motion<'m, S>],
    made: impl Fn([usize; 2], [&Motion<'m, S>; 2], PairRegions<'_, '_, S>) -> T + Sync,
) -> Result<Vec<T>, ComputationError> {
    let near = |i: usize| {
        let own = ids.get(i);
        close.after(i).into_iter().filter(|&j| ids.get(j) != own).collect::<Vec<_>>()
    };
    let count: u64 = (0..ids.len()).map(|i| near(i).len() as u64).sum();
    MemoryDemand::PairProof(count).ask()?;
    agent_regions::gathered(motions, "pairs", &|_, _| {}, |row| {
        let i = row.agents()[row.agent_index()] as usize;
        let told = |j: usize| {
            let mut regions = row.pair(i, j).expect("the row of the agent");
            made([i, j], [&motions[i], &motions[j]], &mut regions)
        };
        near(i).into_iter().map(told).collect()
    })
}
