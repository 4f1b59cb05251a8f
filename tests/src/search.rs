//! Directed search: pairs whose tables cover contacts by as little as possible.
//!
//! Random pairs hardly ever come near the worst case. From a pair that is degenerate within a few slacks each step changes one
//! number of it, by any order of magnitude down to the last digit, and is kept unless the margin of its table is larger then: by how much
//! more than R all contacts are covered ([`Checker::margin`]), which the whole table counts for and not only the ends of its pieces.

use crate::case_ranges::Total;
use crate::certified::table;
use crate::disc::{Disc, Drive, Leg};
use crate::generators::{Dice, Pair, RELATIONS, inner_tangent, related};
use pcr_certify::pair::Findings;
use pcr_certify::raw::RawTable;
use pcr_certify::table::{Checker, CoverageMargin};
use pcr_planning::fleet::HostScalar;

/// What a search has come to.
#[derive(Clone, Debug)]
pub struct Worst {
    /// The largest δ for which the table covers all contacts at R + δ, in parts of the excess.
    pub margin: f64,
    /// What is not proved of it.
    pub findings: Findings,
    /// The number of its start.
    pub seed: u64,
    /// The pair.
    pub pair: Pair,
}

/// What many searches have come to.
#[derive(Clone, Debug, Default)]
pub struct Searches {
    /// Starts with a region.
    pub starts: u64,
    /// Tables that were looked at.
    pub tables: u64,
    /// The one with the smallest margin.
    pub worst: Option<Worst>,
    /// Those that are refuted.
    pub refuted: Vec<Worst>,
}

impl Total for Searches {
    fn add(&mut self, other: &Self) {
        self.starts += other.starts;
        self.tables += other.tables;
        self.refuted.extend_from_slice(&other.refuted);
        let both = [self.worst.take(), other.worst.clone()].into_iter().flatten();
        self.worst = both.min_by(|a, b| a.margin.total_cmp(&b.margin));
    }
}

impl Searches {
    /// The headings of [`Searches::row`].
    pub const HEADINGS: &str =
        "| format | refuted | starts | tables | smallest margin | its start |\n|---|---|---|---|---|---|";

    /// A row of the table in `docs/theory/errors.md`.
    pub fn row(&self, format: &str) -> String {
        let Self { starts, tables, worst, refuted } = self;
        let [margin, seed] = match worst {
            Some(worst) => [format!("{:.3}", worst.margin), worst.seed.to_string()],
            None => [const { String::new() }; 2],
        };
        let refuted = refuted.len();
        format!("| <a id=\"s-{format}\"></a>`{format}` | {refuted} | {starts} | {tables} | {margin} | {seed} |")
    }
}

/// The searches from `count` starts.
pub fn searches<S: HostScalar>(first: u64, count: u64, steps: u64) -> Searches {
    let mut all = Searches::default();
    for worst in (first..first + count).filter_map(|seed| search::<S>(seed, steps)) {
        let refuted = if worst.findings.refuted.is_empty() { Vec::new() } else { vec![worst.clone()] };
        all.add(&Searches { starts: 1, tables: steps + 1, worst: Some(worst), refuted });
    }
    all
}

/// The pair of this number to start from, of a size that leaves the format some digits; two of three are tangent from inside.
pub fn start<S: HostScalar>(seed: u64) -> Pair {
    let mut dice = Dice::seeded(seed);
    let size = size::<S>();
    let slack = S::slack(S::from_f64(10.0 * size)).to_f64();
    if seed % 3 == 2 {
        let (a, b) = related(RELATIONS[dice.below(RELATIONS.len())], &mut dice);
        return (scaled(&a, size), scaled(&b, size));
    }
    inner_tangent(size, slack, &mut dice)
}

/// A metre, or what has as many digits as one of `Q16`.
fn size<S: HostScalar>() -> f64 {
    (S::slack(S::ZERO).to_f64() * 13_000.0).max(1.0)
}

fn scaled(disc: &Disc, by: f64) -> Disc {
    let [x, y, heading] = disc.start;
    let legs = disc.legs.iter().map(|leg| match *leg {
        Leg::Line(length) => Leg::Line(by * length),
        Leg::Left { radius, length } => Leg::Left { radius: by * radius, length: by * length },
        Leg::Right { radius, length } => Leg::Right { radius: by * radius, length: by * length },
    });
    Disc { radius: by * disc.radius, start: [by * x, by * y, heading], legs: legs.collect() }
}

/// The worst pair within so many steps of the one of this number; none if that has no region.
pub fn search<S: HostScalar>(seed: u64, steps: u64) -> Option<Worst> {
    let mut pair = start::<S>(seed);
    let mut worst = (margin_below(&held::<S>(&pair)?, f64::INFINITY)?, pair.clone());
    for step in 0..steps {
        let next = changed(&pair, &mut Dice::seeded(seed.wrapping_mul(0x1_0000_0001).wrapping_add(step)), size::<S>());
        let less = held::<S>(&next).and_then(|table| margin_below(&table, worst.0 + PLATEAU));
        if let Some(less) = less {
            pair = next;
            if less < worst.0 {
                worst = (less, pair.clone());
            }
        }
    }
    let (margin, pair) = worst;
    let findings = Checker::new(&held::<S>(&pair)?).and_then(|checker| checker.check(CoverageMargin::Needed));
    let findings = findings.unwrap_or_else(|wrong| panic!("{seed} in {}: {wrong}", S::NAME));
    Some(Worst { margin, findings, seed, pair })
}

/// How much worse than the worst one a pair may be from which the search goes on: margins are found to 2^-12 only.
const PLATEAU: f64 = 1.0 / 4096.0;

fn held<S: HostScalar>(pair: &Pair) -> Option<RawTable> {
    table::<S>(pair, &[(Drive::Unit, 0.0), (Drive::Unit, 0.0)])
}

fn margin_below(table: &RawTable, known: f64) -> Option<f64> {
    let found = Checker::new(table).and_then(|checker| checker.margin_below(known));
    found.expect("a table of the library").map(|(margin, _)| margin)
}

/// One number of the pair, changed.
fn changed(pair: &Pair, dice: &mut Dice, size: f64) -> Pair {
    let mut pair = pair.clone();
    let disc = if dice.chance(0.5) { &mut pair.0 } else { &mut pair.1 };
    let by = dice.sign() * size * dice.magnitude(1e-16, 0.1);
    let index = dice.below(4 + disc.legs.len());
    match index.checked_sub(4).and_then(|leg| disc.legs.get_mut(leg)) {
        Some(Leg::Line(length)) => *length = (*length + by).max(0.0),
        Some(Leg::Left { radius, length } | Leg::Right { radius, length }) => {
            if dice.chance(0.5) {
                *radius = (*radius + by).max(1e-3 * size);
            } else {
                *length = (*length + by).max(0.0);
            }
        }
        None if index == 0 => disc.radius = (disc.radius + by).max(1e-3 * size),
        None => disc.start[index - 1] += if index == 3 { by / size } else { by },
    }
    pair
}
