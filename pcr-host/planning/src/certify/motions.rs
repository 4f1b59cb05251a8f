//! Proofs by [`pcr_certify`] that motions have no contact at any time.

use crate::checker_input;
use crate::disc_fleet::{DiscFleet, Form};
use crate::failure::ComputationError;
use crate::fleet::{FormatRangeError, HostScalar};
use pcr_certify::motion::{ContactWitness, Mover, meetings};
use pcr_core::Motion;
use pcr_formats::scenario::Scenario;
use serde::Serialize;

/// The result of the proof of motions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MotionCertificate {
    /// `proved`: no contact at any time. `contact`: there is one. `undecided`: so near that rounding does not tell.
    pub verdict: &'static str,
    /// Number of pairs of discs.
    pub pairs: usize,
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
    /// Distance of the centres of two of their discs less the radii \[m\]; NaN where it is not known, in JSON `null`.
    pub clearance: f64,
}

impl MotionCertificate {
    /// The proof for a scenario, as the format `S` represents it.
    ///
    /// # Errors
    /// [`FormatRangeError`] if a value does not fit the format.
    pub fn prove<S: HostScalar>(scenario: &Scenario) -> Result<Self, FormatRangeError> {
        let (fleet, discs, given) = DiscFleet::<S>::moving(scenario, Form::Covers)?;
        let motions = fleet.motions();
        let all = Motion::span(&motions);
        let ids: Vec<u64> = discs.iter().map(|disc| scenario.agents[disc.agent].id).collect();
        let agents = checker_input::agents(&fleet, &motions, &ids);
        if let Err(misread) = checker_input::as_given::<S>(&given, &agents) {
            return Ok(Self { error: Some(misread.to_string()), ..Self::found(&[]) }.undecided());
        }
        let movers = agents.iter().zip(&motions).zip(&discs).map(|((agent, motion), disc)| {
            let time = disc.time(motion, all);
            let mover = Mover::new(agent, [time.lo.to_f64(), time.hi.to_f64()]);
            mover.map_err(|problem| format!("agent {}: {problem}", agent.id))
        });
        Ok(match movers.collect::<Result<Vec<_>, _>>() {
            Ok(movers) => Self::found(&movers),
            Err(problem) => Self { error: Some(problem), ..Self::found(&[]) }.undecided(),
        })
    }

    /// The same for who asks whether there is a contact: of one agent alone, or of none, nothing would be proved.
    ///
    /// # Errors
    /// [`ComputationError::Refused`] where a value does not fit the format, [`ComputationError::NoPair`].
    pub fn of_pairs<S: HostScalar>(scenario: &Scenario) -> Result<Self, ComputationError> {
        match Self::prove::<S>(scenario)? {
            Self { pairs: 0, error: None, .. } => Err(ComputationError::NoPair),
            proof => Ok(proof),
        }
    }

    fn found(movers: &[Mover]) -> Self {
        let found = meetings(movers);
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
