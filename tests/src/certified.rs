//! Tables of random pairs, proved by `pcr_certify`.

use crate::case_ranges::{CaseRange, Total, in_every_format};
use crate::disc::{Course, Disc, Drive};
use crate::generators::certifiable;
use pcr_certify::raw::RawTable;
use pcr_certify::table::{Checker, CoverageMargin};
use pcr_formats::scenario::Scenario;
use pcr_planning::certify::CertificateTable;
use pcr_planning::checker_input;
use pcr_planning::fleet::{HostScalar, build_ecm};
use pcr_planning::regions::table_of;
use std::fmt;

/// What has come of many tables.
#[derive(Clone, Debug, Default)]
pub struct Proofs {
    /// Tables that are proved.
    pub proved: u64,
    /// Pairs that the format or a table cannot hold.
    pub refused: u64,
    /// Tables with pieces that stand for one of two intervals.
    pub shared: u64,
    /// Pieces.
    pub pieces: u64,
    /// Cells that were looked at.
    pub steps: u64,
    /// Most of one table with one pair of segments.
    pub most: u64,
    /// What is refuted, with the seed.
    pub refuted: Vec<String>,
    /// What the checker's rounding does not tell, with the seed.
    pub undecided: Vec<String>,
}

impl Total for Proofs {
    fn add(&mut self, other: &Self) {
        self.proved += other.proved;
        self.refused += other.refused;
        self.shared += other.shared;
        self.pieces += other.pieces;
        self.steps += other.steps;
        self.most = self.most.max(other.most);
        self.refuted.extend_from_slice(&other.refuted);
        self.undecided.extend_from_slice(&other.undecided);
    }
}

impl Proofs {
    /// The headings of [`Proofs::row`].
    pub const HEADINGS: &str = "| format | refuted | pairs | proved | undecided | refused by the format | pieces | most steps for one \
                                pair of segments |\n|---|---|---|---|---|---|---|---|";

    /// A row of the table in `docs/theory/errors.md`.
    pub fn row(&self, format: &str) -> String {
        let Self { proved, refused, pieces, most, refuted, undecided, .. } = self;
        let numbers = [refuted.len() as u64, self.cases(), *proved, undecided.len() as u64, *refused, *pieces, *most];
        let numbers: Vec<String> = numbers.iter().map(|&number| grouped(number)).collect();
        format!("| <a id=\"c-{format}\"></a>`{format}` | {} |", numbers.join(" | "))
    }

    /// All of them.
    pub fn cases(&self) -> u64 {
        self.proved + self.refused + (self.refuted.len() + self.undecided.len()) as u64
    }
}

/// A number with a comma between groups of three digits.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let groups = digits.as_bytes().rchunks(3).rev().map(String::from_utf8_lossy);
    groups.collect::<Vec<_>>().join(",")
}

impl fmt::Display for Proofs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { proved, refused, shared, pieces, steps, most, refuted, undecided } = self;
        write!(f, "{proved} proved ({refused} refused by the format), {} refuted, ", refuted.len())?;
        write!(f, "{} undecided; {pieces} pieces, in {shared} tables one of two intervals; ", undecided.len())?;
        write!(f, "{steps} steps, {most} at most for one pair of segments")
    }
}

/// The table of a pair in motion, as plain numbers; none where the format or a table cannot hold it.
pub fn table<S: HostScalar>(pair: &(Disc, Disc), drives: &[(Drive, f64); 2]) -> Option<RawTable> {
    let driven =
        [(pair.0.clone(), drives[0].0.clone(), drives[0].1), (pair.1.clone(), drives[1].0.clone(), drives[1].1)];
    let [first, second] = driven.each_ref().map(Course::<S>::rounded);
    let courses = [first?, second?];
    let motions = courses.each_ref().map(|(course, _)| course.motion());
    let ecm = build_ecm(&motions).ok()?;
    let agents = courses.iter().zip(&motions).enumerate().map(|(place, ((_, (disc, ..)), motion))| {
        checker_input::agent(place as u64, motion, S::angle(disc.start[2]).expect("an angle"), &[])
    });
    Some(checker_input::table(agents.collect(), &motions, &ecm))
}

/// Certifies the tables of the cases `first`, `first + 1`, ... of [`certifiable`].
pub fn run<S: HostScalar>(first: u64, count: u64) -> Proofs {
    let mut proofs = Proofs::default();
    for seed in first..first + count {
        let (pair, drives) = certifiable::<S>(seed);
        let Some(table) = table::<S>(&pair, &drives) else {
            proofs.refused += 1;
            continue;
        };
        let found = Checker::new(&table).and_then(|checker| checker.check(CoverageMargin::Needed));
        let found = found.unwrap_or_else(|wrong| panic!("{seed} in {}: {wrong}", S::NAME));
        proofs.pieces += found.pieces as u64;
        proofs.steps += found.steps as u64;
        let one_of_two = |pair: &pcr_certify::raw::RawPair| {
            pair.pieces.iter().any(|piece| piece.share != pcr_certify::raw::RawBranch::Only)
        };
        proofs.shared += u64::from(table.pairs.iter().any(one_of_two));
        if found.segments == 1 {
            proofs.most = proofs.most.max(found.steps as u64);
        }
        match (found.refuted.first(), found.undecided.first()) {
            (Some(witness), _) => proofs.refuted.push(format!("{seed}: {witness:?}")),
            (None, Some(witness)) => proofs.undecided.push(format!("{seed}: {witness:?}")),
            (None, None) => proofs.proved += 1,
        }
    }
    proofs
}

/// The formats by name.
pub const FORMATS: &[(&str, CaseRange<Proofs>)] = &in_every_format!(run);

/// The table of contacts of a fleet of discs.
///
/// # Panics
/// If there is none.
pub fn discs_of<S: HostScalar>(scenario: &Scenario) -> RawTable {
    let tables = table_of::<S>(scenario).expect("tables");
    tables.into_iter().next().and_then(CertificateTable::discs).expect("a table of discs")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_one_of_a_table() {
        let proofs = Proofs { proved: 1_234_567, refused: 12, undecided: vec![String::new()], ..Proofs::default() };
        let row = "| <a id=\"c-q16\"></a>`q16` | 0 | 1,234,580 | 1,234,567 | 1 | 12 | 0 | 0 |";
        assert_eq!(proofs.row("q16"), row);
        let columns = |line: &str| line.matches('|').count();
        assert!(Proofs::HEADINGS.lines().all(|line| columns(line) == columns(&proofs.row("q16"))));
    }
}
