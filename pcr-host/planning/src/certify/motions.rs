//! Proofs by [`pcr_certify`] that motions have no contact at any time.

use super::is_zero;
use crate::bodies::BodyFleet;
use crate::checker_input::{self, outlines};
use crate::failure::ComputationError;
use crate::fleet::{FormatRangeError, HostScalar};
use pcr_certify::error::{CertifyError, InputPart};
use pcr_certify::motion::{ContactWitness, MotionFindings, Mover, meetings};
use pcr_certify::outline::motion::{Driven, meetings as outline_meetings};
use pcr_certify::outline::{Body, RawBody};
use pcr_certify::raw::RawAgent;
use pcr_core::Motion;
use pcr_formats::scenario::Scenario;
use serde::Serialize;

/// The result of the proof of motions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MotionCertificate {
    /// `proved`: no contact at any time. `contact`: there is one. `undecided`: so near that rounding does not tell.
    pub verdict: &'static str,
    /// Number of pairs of discs and outlines of different agents.
    pub pairs: usize,
    /// Number of outlines that were proved as they are, and not as covers.
    #[serde(skip_serializing_if = "is_zero")]
    pub outlines: usize,
    /// Number of intervals of time that were examined.
    pub steps: usize,
    /// A contact of each pair of discs that has one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub contacts: Vec<CertificateContact>,
    /// Points at which it is not decided.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub undecided: Vec<CertificateContact>,
    /// Reason why there is no verdict.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// A contact of two agents.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CertificateContact {
    /// Number of an agent.
    pub i: u64,
    /// Number of the other one.
    pub j: u64,
    /// Time \[s\].
    pub t: f64,
    /// Distance of the outlines, or of two of their discs \[m\]; NaN where it is not known, in JSON `null`.
    pub clearance: f64,
}

impl MotionCertificate {
    /// The proof for a scenario, as the format `S` represents it: of the outlines that the core computes with, and of the discs of all other
    /// agents.
    ///
    /// # Errors
    /// [`FormatRangeError`] if a value does not fit the format.
    pub fn prove<S: HostScalar>(scenario: &Scenario) -> Result<Self, FormatRangeError> {
        let (fleet, discs, given) = BodyFleet::<S>::moving(scenario)?;
        let motions = fleet.motions();
        let all = Motion::span(&motions);
        let ids: Vec<u64> = discs.iter().map(|disc| scenario.agents[disc.agent].id).collect();
        let agents = checker_input::agents(&fleet, &motions, &ids);
        let times = motions.iter().zip(&discs).map(|(motion, disc)| {
            let time = disc.time(motion, all);
            [time.lo.to_f64(), time.hi.to_f64()]
        });
        let times: Vec<[f64; 2]> = times.collect();
        let count = motions.iter().filter(|motion| outlines::is_outline(motion)).count();
        let found = if !motions.iter().any(outlines::is_body) {
            checker_input::as_given::<S>(&given, &agents)
                .map_err(|misread| misread.to_string())
                .and_then(|()| of_discs(&agents, &times).map_err(|wrong| wrong.to_string()))
        } else {
            let bodies = outlines::bodies(&fleet, agents.clone(), &motions);
            outlines::as_given::<S>(&given, &agents, &bodies)
                .map_err(|misread| misread.to_string())
                .and_then(|()| of_outlines(&bodies, &times).map_err(|wrong| wrong.to_string()))
        };
        Ok(match found {
            Ok(found) => Self { outlines: count, ..Self::found(&found) },
            Err(problem) => Self { error: Some(problem), ..Self::found(&MotionFindings::default()) }.undecided(),
        })
    }

    /// The same for who asks whether there is a contact: of one agent alone, or of none, nothing would be proved.
    ///
    /// # Errors
    /// [`ComputationError::Refused`] where a value does not fit the format, [`ComputationError::NoPair`].
    pub(crate) fn of_pairs<S: HostScalar>(scenario: &Scenario) -> Result<Self, ComputationError> {
        match Self::prove::<S>(scenario)? {
            Self { pairs: 0, error: None, .. } => Err(ComputationError::NoPair),
            proof => Ok(proof),
        }
    }

    fn found(found: &MotionFindings) -> Self {
        let contact = |meeting: &ContactWitness| {
            let [i, j] = meeting.agents;
            CertificateContact { i, j, t: meeting.time, clearance: meeting.clearance }
        };
        let verdict = match (found.contacts.is_empty(), found.undecided.is_empty()) {
            (false, _) => "contact",
            (true, false) => "undecided",
            (true, true) => "proved",
        };
        Self {
            verdict,
            pairs: found.pairs,
            outlines: 0,
            steps: found.steps,
            contacts: found.contacts.iter().map(contact).collect(),
            undecided: found.undecided.iter().map(contact).collect(),
            error: None,
        }
    }

    fn undecided(self) -> Self {
        Self { verdict: "undecided", ..self }
    }
}

/// What the checker finds of discs that are there at these times.
fn of_discs(agents: &[RawAgent], times: &[[f64; 2]]) -> Result<MotionFindings, CertifyError> {
    let movers = agents
        .iter()
        .zip(times)
        .map(|(agent, &time)| Mover::new(agent, time).map_err(CertifyError::of(InputPart::Agent(agent.id, None))));
    Ok(meetings(&movers.collect::<Result<Vec<_>, _>>()?))
}

/// What the checker finds of bodies that are there at these times.
fn of_outlines(bodies: &[RawBody], times: &[[f64; 2]]) -> Result<MotionFindings, CertifyError> {
    let wrong = |id: u64| CertifyError::of(InputPart::Agent(id, None));
    let placed = bodies.iter().map(|raw| Body::new(raw).map_err(wrong(raw.id)));
    let placed: Vec<Body<'_>> = placed.collect::<Result<_, _>>()?;
    let driven = placed.iter().zip(times).map(|(body, &time)| Driven::new(body, time).map_err(wrong(body.raw.id)));
    Ok(outline_meetings(&driven.collect::<Result<Vec<_>, _>>()?))
}
