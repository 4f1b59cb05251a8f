//! Proofs of tables and motions by [`pcr_certify`]: the answer of `pcr certify` in every format.
//!
//! The types match the JSON output, field by field in this order.

mod certificate_table;
mod error;
mod motions;
mod reported;
#[cfg(test)]
mod tests;

pub use certificate_table::CertificateTable;
pub use error::{CertifyInputError, RegionDifference};
pub use motions::{CertificateContact, MotionCertificate};

use crate::agent_regions::ProgressFn;
use pcr_certify::device_dump;
use pcr_certify::error::CertifyError;
use pcr_certify::outline;
use pcr_certify::outline::RawOutlineTable;
use pcr_certify::pair::{Findings, TableProperty};
use pcr_certify::raw::RawTable;
use pcr_certify::table::{Checker, CoverageMargin};
use pcr_formats::scenario::Labels;
use pcr_formats::warning::WarningCode;
use reported::{RegionScope, ReportedBodies};
use serde::de::{DeserializeOwned, IgnoredAny};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The result of the proof of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CertifyReport {
    /// Name of the scenario.
    pub name: String,
    /// Labels of the agents, by their numbers.
    #[serde(skip_serializing_if = "Labels::is_empty")]
    pub labels: Labels,
    /// `proved`, `refuted` or `undecided`; `None` if the scenario was refused.
    pub verdict: Option<&'static str>,
    /// Number of discs.
    pub discs: usize,
    /// Number of outlines that were proved.
    #[serde(skip_serializing_if = "is_zero")]
    pub outlines: usize,
    /// Number of pairs of discs and outlines of different agents, also those far apart: the verdict is about these.
    pub pairs: usize,
    /// Number of pairs of segments that were examined.
    pub segment_pairs: usize,
    /// Number of pieces of the table.
    pub pieces: usize,
    /// Number of regions whose times were examined.
    pub times: usize,
    /// Number of evaluations of the bounds on a pair of parts of segments.
    pub steps: usize,
    /// The largest margin \[ε\] for which all contacts are covered, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub margin: Option<f64>,
    /// Points at which a promise is broken.
    pub refuted: Vec<CertifyWitnessEntry>,
    /// Points at which rounding of the checker leaves it open.
    pub undecided: Vec<CertifyWitnessEntry>,
    /// Reason why there is no verdict.
    pub error: Option<String>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "what serde asks for")]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

/// A point of two paths.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CertifyWitnessEntry {
    /// The promise that is broken, or may be.
    pub promise: &'static str,
    /// Number of the first agent.
    pub i: u64,
    /// Number of the second agent.
    pub j: u64,
    /// Length along the path of `i`, or of its disc \[m\].
    pub l_i: f64,
    /// Length along the path of `j` \[m\].
    pub l_j: f64,
    /// Distance of the centres minus the radii, or of the outlines \[m\]; NaN where it is not known, in JSON `null`.
    pub clearance: f64,
    /// That distance in ε of the pair; between 0 and 1 a table may count it as contact or not.
    pub in_excess: f64,
}

/// The format of the answers that have a certificate, and its version.
pub(crate) const ANSWERS: &str = "pcr-regions";
pub(crate) const VERSION: u32 = 2;

/// The tables in an answer of `pcr regions --certificate`, or the table that a microcontroller prints. Other parts of the
/// answer may be missing; if present, they have to agree with the tables.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CertifyInput {
    /// Name of the scenario.
    pub name: String,
    /// Labels of its agents.
    pub labels: Labels,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
    /// The table of contacts, and that of overlaps of margins, if there are any.
    pub certificate: Vec<CertificateTable>,
}

/// An answer of `regions` as it is written, with tables of one kind.
#[derive(Deserialize)]
struct RegionsAnswer<T> {
    name: String,
    #[serde(default)]
    labels: Labels,
    #[serde(default)]
    warnings: Vec<String>,
    certificate: Vec<T>,
    #[serde(default)]
    agent: Option<u64>,
    #[serde(default)]
    regions: Option<Vec<reported::ReportedRegion>>,
    #[serde(default)]
    margin_regions: Option<Vec<reported::ReportedRegion>>,
    #[serde(default, alias = "footprints")]
    bodies: Vec<ReportedBodies>,
}

/// Whether tables have bodies, and are of outlines.
#[derive(Deserialize)]
struct TableKindProbe {
    certificate: Vec<TableProbe>,
}

#[derive(Deserialize)]
struct TableProbe {
    bodies: Option<IgnoredAny>,
}

/// What a text is, as far as that is to be known before it is read.
#[derive(Deserialize)]
struct CertifyProbe {
    format: Option<Value>,
    version: Option<Value>,
    error: Option<String>,
    agents: Option<IgnoredAny>,
    certificate: Option<IgnoredAny>,
}

impl CertifyInput {
    /// Reads one from the text of a file: JSON, or what a microcontroller prints, which has the name of the file.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn of(text: &str, name: &str) -> Result<Self, CertifyInputError> {
        if text.trim_start().starts_with('{') {
            return Self::of_json(text);
        }
        Ok(Self { name: name.to_owned(), certificate: vec![device_dump::decode(text)?.into()], ..Self::default() })
    }

    /// Reads the tables from a JSON text.
    ///
    /// # Errors
    /// Another format or version, two agents with one number, or regions that differ from those of the
    /// tables.
    pub fn of_json(text: &str) -> Result<Self, CertifyInputError> {
        let said: CertifyProbe = serde_json::from_str(text)?;
        if said.format.as_ref().is_none_or(|said| said == "pcr-scenario") && said.agents.is_some() {
            return Err(CertifyInputError::Scenario);
        }
        if let Some(other) = said.format.filter(|said| said != ANSWERS) {
            return Err(CertifyInputError::Format(other));
        }
        // Version 1 had covers of discs.
        if let Some(other) = said.version.filter(|said| !(1..=VERSION).any(|known| *said == known)) {
            return Err(CertifyInputError::Version(other));
        }
        if let Some(reason) = said.error {
            return Err(CertifyInputError::NotComputed(reason));
        }
        if said.certificate.is_none() {
            return Err(CertifyInputError::NoCertificate);
        }
        let has_bodies = |probe: TableKindProbe| probe.certificate.iter().any(|table| table.bodies.is_some());
        if serde_json::from_str(text).is_ok_and(has_bodies) {
            RegionsAnswer::<RawOutlineTable>::read(text)
        } else {
            RegionsAnswer::<RawTable>::read(text)
        }
    }
}

impl<T: DeserializeOwned + Into<CertificateTable>> RegionsAnswer<T> {
    /// Reads the tables, and compares them with what is told beside them.
    fn read(text: &str) -> Result<CertifyInput, CertifyInputError> {
        let answer: Self = serde_json::from_str(text)?;
        let Self { name, labels, warnings, certificate, agent, regions, margin_regions, bodies: told } = answer;
        let certificate: Vec<CertificateTable> = certificate.into_iter().map(T::into).collect();
        let paths: Vec<_> = certificate.iter().map(CertificateTable::paths).collect();
        for table in &paths {
            reported::bodies(table, &told)?;
            reported::asked(table, agent)?;
        }
        match (&certificate[..], &paths[..]) {
            ([] | [_], _) => {}
            ([bodies, enlarged], [discs, margins]) => {
                reported::enlarged(discs, margins)?;
                reported::same_corners(bodies, enlarged)?;
            }
            (more, _) => return Err(CertifyInputError::TableCount(more.len())),
        }
        let lists = [("regions", &regions), ("margin_regions", &margin_regions)];
        let is_told = lists.iter().any(|(_, list)| list.is_some());
        let asked = RegionScope { agent, bodies: &told };
        for (place, (name, list)) in lists.into_iter().enumerate() {
            match (list, paths.get(place)) {
                (Some(list), Some(table)) => reported::compare(name, list, table, asked)?,
                (Some(_), None) if place > 0 => return Err(CertifyInputError::ListWithoutTable(name)),
                (None, Some(_)) if is_told => return Err(CertifyInputError::TableWithoutList(name)),
                _ => {}
            }
        }
        let warnings = warnings.into_iter().map(WarningCode::coded).collect();
        Ok(CertifyInput { name, labels, warnings, certificate })
    }
}

impl CertifyReport {
    /// Proves a table; also finds its margin, if requested.
    pub fn prove(name: &str, table: &CertificateTable, margin: bool) -> Self {
        Self::watched(name, table, margin, &|_, _| {})
    }

    /// Proves a table as [`CertifyReport::prove`], and tells before each pair how many checks of how many are done.
    pub fn watched(name: &str, table: &CertificateTable, margin: bool, told: ProgressFn<'_>) -> Self {
        /// What a margin takes, in times of the check.
        const MARGIN: usize = 12;
        let all = table.pairs() * if margin { 1 + MARGIN } else { 1 };
        let told = |done: usize| told(done, all);
        let checked = match table {
            CertificateTable::Discs(table) => of_discs(table, margin, &told),
            CertificateTable::Outlines(table) => of_outlines(table, margin, &told),
        };
        match checked {
            Ok((findings, margin)) => Self::found(name, table, &findings, margin),
            Err(problem) => Self::refused(name, problem.to_string()),
        }
    }

    /// Sets labels and warnings.
    #[must_use]
    pub fn with(self, labels: &Labels, warnings: &[String]) -> Self {
        Self { labels: labels.clone(), warnings: warnings.to_vec(), ..self }
    }

    fn found(name: &str, table: &CertificateTable, findings: &Findings, margin: Option<f64>) -> Self {
        let (outlines, table) = (table.outline_count(), &*table.paths());
        let points = |those: &[pcr_certify::pair::Witness]| {
            let id = |place: usize| table.agents[place].id;
            let point = those.iter().map(|witness| CertifyWitnessEntry {
                promise: match witness.promise {
                    TableProperty::Covered => "contact outside of all pieces",
                    TableProperty::Shared => "contact in a piece that does not show it",
                    TableProperty::Near => "told, but no contact",
                    TableProperty::Timed => "contact outside of the time of its region",
                    TableProperty::Prompt => "time told that is too far from the region",
                },
                i: id(witness.agents[0]),
                j: id(witness.agents[1]),
                l_i: witness.lengths[0],
                l_j: witness.lengths[1],
                clearance: witness.clearance,
                in_excess: witness.clearance / witness.excess,
            });
            point.collect::<Vec<_>>()
        };
        let verdict = match findings {
            Findings { refuted, .. } if !refuted.is_empty() => "refuted",
            Findings { undecided, .. } if !undecided.is_empty() => "undecided",
            _ => "proved",
        };
        Self {
            name: name.to_owned(),
            labels: Labels::default(),
            verdict: Some(verdict),
            discs: table.agents.len() - outlines,
            outlines,
            pairs: reported::pairs(table),
            segment_pairs: findings.segments,
            pieces: findings.pieces,
            times: findings.times,
            steps: findings.steps,
            margin,
            refuted: points(&findings.refuted),
            undecided: points(&findings.undecided),
            error: None,
            warnings: Vec::new(),
        }
    }

    /// An answer that says why there is no verdict.
    pub fn refused(name: &str, error: String) -> Self {
        Self {
            name: name.to_owned(),
            labels: Labels::default(),
            verdict: None,
            discs: 0,
            outlines: 0,
            pairs: 0,
            segment_pairs: 0,
            pieces: 0,
            times: 0,
            steps: 0,
            margin: None,
            refuted: Vec::new(),
            undecided: Vec::new(),
            error: Some(error),
            warnings: Vec::new(),
        }
    }
}

/// What the checker finds, and the margin if it was asked for.
type Checked = Result<(Findings, Option<f64>), CertifyError>;

fn of_discs(table: &RawTable, margin: bool, told: &dyn Fn(usize)) -> Checked {
    let checker = Checker::new(table)?;
    let findings = checker.watched(CoverageMargin::Needed, told)?;
    let margin = if margin { checker.margin()? } else { None };
    Ok((findings, margin.map(|(margin, _)| margin)))
}

fn of_outlines(table: &RawOutlineTable, margin: bool, told: &dyn Fn(usize)) -> Checked {
    let checker = outline::table::Checker::new(table)?;
    let findings = checker.watched(CoverageMargin::Needed, told)?.findings;
    let margin = if margin { checker.margin()? } else { None };
    Ok((findings, margin))
}
