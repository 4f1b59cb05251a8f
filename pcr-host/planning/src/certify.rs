//! Proofs of tables and motions by [`pcr_certify`]: the answer of `pcr certify` in every format.
//!
//! The types match the JSON output, field by field in this order.

mod motions;
mod reported;

pub use motions::{CertificateContact, MotionCertificate};

use crate::regions::ProgressFn;
use pcr_certify::device_dump;
use pcr_certify::pair::{Findings, TableProperty};
pub use pcr_certify::raw::RawTable;
use pcr_certify::table::{Checker, CoverageMargin};
use pcr_formats::scenario::Labels;
use pcr_formats::warning::WarningCode;
use reported::{RegionScope, ReportedDiscCover};
use serde::de::IgnoredAny;
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
    /// Number of pairs of discs of different agents, also those far apart: the verdict is about these.
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
    /// Distance of the centres minus the radii \[m\]; NaN where it is not known, in JSON `null`.
    pub clearance: f64,
    /// That distance in ε of the pair; between 0 and 1 a table may count it as contact or not.
    pub in_excess: f64,
}

/// The format of the answers that have a certificate, and its version.
pub(crate) const ANSWERS: &str = "pcr-regions";
pub(crate) const VERSION: u32 = 1;

/// The tables in an answer of `pcr regions --certificate`, or the table that a microcontroller prints. Other parts of the
/// answer may be missing; if present, they have to agree with the tables.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct CertifyInput {
    /// Name of the scenario.
    pub name: String,
    /// Labels of its agents.
    #[serde(default)]
    pub labels: Labels,
    /// Warnings about input that was changed or left out when it was read.
    #[serde(default)]
    pub warnings: Vec<String>,
    /// The table of contacts, and that of overlaps of margins, if there are any.
    pub certificate: Vec<RawTable>,
    #[serde(default)]
    agent: Option<u64>,
    #[serde(default)]
    regions: Option<Vec<reported::ReportedRegion>>,
    #[serde(default)]
    margin_regions: Option<Vec<reported::ReportedRegion>>,
    #[serde(default)]
    footprints: Vec<ReportedDiscCover>,
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
    pub fn of(text: &str, name: &str) -> Result<Self, String> {
        if text.trim_start().starts_with('{') {
            return Self::of_json(text);
        }
        Ok(Self { name: name.to_owned(), certificate: vec![device_dump::decode(text)?], ..Self::default() })
    }

    /// Reads the tables from a JSON text.
    ///
    /// # Errors
    /// The problem, in words: another format or version, two agents with one number, or regions that differ from those of the
    /// tables.
    pub fn of_json(text: &str) -> Result<Self, String> {
        let said: CertifyProbe = serde_json::from_str(text).map_err(|error| error.to_string())?;
        let (format, version) = (ANSWERS, VERSION);
        if said.format.as_ref().is_none_or(|said| said == "pcr-scenario") && said.agents.is_some() {
            return Err("this is a scenario; without --table, the table that is computed for it is proved".into());
        }
        if let Some(other) = said.format.filter(|said| said != format) {
            return Err(format!("format: {other} where \"{format}\" is expected"));
        }
        if let Some(other) = said.version.filter(|said| said != version) {
            return Err(format!("version: {other} where {version}, all that this pcr knows, is expected"));
        }
        if let Some(error) = said.error {
            return Err(format!("its regions were not computed: {error}"));
        }
        if said.certificate.is_none() {
            return Err("there is no certificate in it; pcr regions --json --certificate prints one".into());
        }
        let mut dump: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        dump.warnings = dump.warnings.into_iter().map(WarningCode::coded).collect();
        for table in &dump.certificate {
            reported::bodies(table, &dump.footprints)?;
            reported::asked(table, dump.agent)?;
        }
        dump.compare()?;
        Ok(dump)
    }

    /// Compares the tables of the discs and of the discs with their margins with one another, and with the regions that are told.
    fn compare(&self) -> Result<(), String> {
        match &self.certificate[..] {
            [] | [_] => {}
            [discs, margins] => reported::enlarged(discs, margins)?,
            more => {
                let count = more.len();
                return Err(format!("certificate: {count} tables; there are at most two, the second with margins"));
            }
        }
        let lists = [("regions", &self.regions), ("margin_regions", &self.margin_regions)];
        let is_told = lists.iter().any(|(_, list)| list.is_some());
        let asked = RegionScope { agent: self.agent, covers: &self.footprints };
        for (place, (name, list)) in lists.into_iter().enumerate() {
            match (list, self.certificate.get(place)) {
                (Some(list), Some(table)) => reported::compare(name, list, table, asked)?,
                (Some(_), None) if place > 0 => return Err(format!("{name}: the certificate has no table of them")),
                (None, Some(_)) if is_told => {
                    return Err(format!("{name}: missing, and the certificate has a table of them"));
                }
                _ => {}
            }
        }
        Ok(())
    }
}

impl CertifyReport {
    /// Proves a table; also finds its margin, if requested.
    pub fn prove(name: &str, table: &RawTable, margin: bool) -> Self {
        Self::watched(name, table, margin, &|_, _| {})
    }

    /// Proves a table as [`CertifyReport::prove`], and tells before each pair how many checks of how many are done.
    pub fn watched(name: &str, table: &RawTable, margin: bool, told: ProgressFn<'_>) -> Self {
        /// What a margin takes, in times of the check.
        const MARGIN: usize = 12;
        let all = table.pairs.len() * if margin { 1 + MARGIN } else { 1 };
        let checked = Checker::new(table).and_then(|checker| {
            let findings = checker.watched(CoverageMargin::Needed, &|done| told(done, all))?;
            let margin = if margin { checker.margin()? } else { None };
            Ok((findings, margin))
        });
        match checked {
            Ok((findings, margin)) => Self::found(name, table, &findings, margin.map(|(margin, _)| margin)),
            Err(problem) => Self::refused(name, problem),
        }
    }

    /// Sets labels and warnings.
    #[must_use]
    pub fn with(self, labels: &Labels, warnings: &[String]) -> Self {
        Self { labels: labels.clone(), warnings: warnings.to_vec(), ..self }
    }

    fn found(name: &str, table: &RawTable, findings: &Findings, margin: Option<f64>) -> Self {
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
            discs: table.agents.len(),
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
