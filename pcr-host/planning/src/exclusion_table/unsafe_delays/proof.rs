//! The proof of unsafe delays by [`pcr_certify`]: with every other delay, two vehicles under way do not touch.
//!
//! The proof is about the motions: of two straight edges at constant speed about the lines between their nodes, of all others about the
//! motions from which the library has computed the delays. Which pairs come near one another, the checker finds itself.

use super::UnsafeDelayModel;
use crate::checker_input::{self, outlines};
use crate::exclusion_table::area_pair_search::{SyncProgressFn, in_stretches};
use crate::memory_budget::MemoryDemand;
use crate::parallel;
use pcr_certify::delays::{Neighbours, Traversal, Verdict};
use pcr_certify::error::CertifyError;
use pcr_certify::outline::Body as OutlineBody;
use pcr_certify::outline::delays::{Traversal as OutlineTraversal, neighbours};
use pcr_formats::import::{ElementId, ImportError};
use serde::Serialize;
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

/// Number of pairs without a proof that are listed, of each kind.
const LISTED: usize = 10;

/// The result of the proof of unsafe delays.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DelayProof {
    /// `proved`: with no other delay two vehicles touch. `refuted`: with one they do. `undecided`: rounding does not tell.
    pub verdict: &'static str,
    /// Number of pairs of directed edges that come near one another, an edge with itself included.
    pub pairs: usize,
    /// Number of pairs that are proved.
    pub proved: usize,
    /// Number of pairs with a contact at another delay.
    pub refuted: usize,
    /// Number of pairs that are not decided.
    pub undecided: usize,
    /// Number of evaluations of the bound on the distance.
    pub cells: usize,
    /// The first pairs without a proof, contacts before undecided ones.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub open: Vec<DelayApproach>,
}

/// Two vehicles that touch with a delay that is not listed, or may touch.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DelayApproach {
    /// `refuted` or `undecided`.
    pub verdict: &'static str,
    /// Edge, as in the layout.
    pub a: ElementId,
    /// Whether it is driven from its end.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub a_backward: bool,
    /// Edge, `a` or after it.
    pub b: ElementId,
    /// Whether it is driven from its end.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub b_backward: bool,
    /// How much later than on `a` the vehicle on `b` departs \[s\].
    pub delay: f64,
    /// Time since the departure on `a` \[s\].
    pub time: f64,
    /// Distance of the centres less the radii, or of the outlines \[m\]; NaN where it is not known, in JSON `null`.
    pub clearance: f64,
}

/// The forbidden intervals of pairs of ways, by their indices, the lower one first; those of a pair disjoint and in increasing order.
pub(crate) type ForbiddenDelays = HashMap<[usize; 2], Vec<[f64; 2]>>;

/// The ways in the form of the checker.
struct Traversals {
    /// The straight ones as lines, and their ways.
    lines: Vec<Traversal>,
    ways: Vec<usize>,
    /// The index of each way among the lines.
    line: Vec<Option<usize>>,
    /// All as motions of discs; empty if all are lines, and for outlines.
    motions: Vec<Traversal>,
}

/// Ways that may come near one another, each with its motions as bodies.
struct OutlineTraversals<'a> {
    all: Vec<OutlineTraversal<'a>>,
    /// For each way those of its bodies.
    of: &'a [Range<usize>],
    /// For each way the later ones near it, in order.
    near: Vec<Vec<usize>>,
}

impl UnsafeDelayModel {
    /// Proves that with no delays but the forbidden ones two vehicles touch, or shows where they do.
    ///
    /// # Errors
    /// [`ImportError`] for a motion that the checker refuses, and for motions that do not fit in memory.
    pub(crate) fn proof(
        &self,
        forbidden: &ForbiddenDelays,
        told: SyncProgressFn<'_>,
    ) -> Result<DelayProof, ImportError> {
        MemoryDemand::TraversalProof(2 * self.ways.len()).ask().map_err(|large| ImportError::new(large.to_string()))?;
        if self.fleet.motions().iter().any(outlines::is_body) {
            return self.proof_of_outlines(forbidden, told);
        }
        let traversals = self.traversals()?;
        let near = [&traversals.lines, &traversals.motions].map(|all| Neighbours::new(all));
        // Of two lines the lines count, of all others the motions.
        let pairs_of = |way: usize| {
            let line = traversals.line[way];
            let lines = line.map_or_else(Vec::new, |line| near[0].after(line));
            let motions = if traversals.motions.is_empty() { Vec::new() } else { near[1].after(way) };
            let lines = lines.into_iter().map(|other| traversals.ways[other]);
            let motions = motions.into_iter().filter(|&other| line.is_none() || traversals.line[other].is_none());
            let mut others: Vec<usize> = std::iter::once(way).chain(lines).chain(motions).collect();
            others.retain(|&other| self.share_a_level([way, other]));
            others.sort_unstable();
            others
        };
        let row = |way: usize| {
            let mut found = Found::default();
            for other in pairs_of(way) {
                let [first, second] = traversals.pair([way, other]);
                let intervals = forbidden.get(&[way, other]).map_or(&[][..], Vec::as_slice);
                let (verdict, cells) = first.outside(second, intervals);
                found.add([way, other], verdict, cells);
            }
            Ok(found)
        };
        let mut all = Found::default();
        in_stretches(
            self.ways.len(),
            |_| 1,
            told,
            &row,
            |found: Found| {
                all.append(found);
                Ok::<(), ImportError>(())
            },
        )?;
        Ok(all.proof(self))
    }

    /// The same of outlines, each of whose bodies is proved by itself.
    fn proof_of_outlines(
        &self,
        forbidden: &ForbiddenDelays,
        told: SyncProgressFn<'_>,
    ) -> Result<DelayProof, ImportError> {
        let motions = self.fleet.motions();
        let ids: Vec<u64> = (0..motions.len() as u64).collect();
        let raw = outlines::bodies(&self.fleet, checker_input::agents(&self.fleet, &motions, &ids), &motions);
        let of = self.bodies.get(..self.ways.len()).unwrap_or_default();
        let way_of = |body: usize| of.partition_point(|bodies| bodies.end <= body);
        let refused =
            |body: usize, problem: CertifyError| ImportError::new(format!("{}: {problem}", self.name(way_of(body))));
        let count = of.last().map_or(0, |last| last.end);
        let placed = parallel::map_parallel(0..count, &|body| {
            OutlineBody::new(&raw[body]).map_err(|problem| refused(body, problem))
        });
        let placed: Vec<OutlineBody<'_>> = placed.into_iter().collect::<Result<_, _>>()?;
        let all = placed
            .iter()
            .enumerate()
            .map(|(body, placed)| OutlineTraversal::new(placed).map_err(|problem| refused(body, problem)));
        let all: Vec<OutlineTraversal<'_>> = all.collect::<Result<_, _>>()?;
        let index = neighbours(&all);
        let mut near = vec![BTreeSet::new(); of.len()];
        for body in 0..count {
            for other in index.after(body) {
                // Bodies of a way are one after the other.
                near[way_of(body)].insert(way_of(other));
            }
        }
        let near = near.into_iter().map(|ways| ways.into_iter().collect()).collect();
        let traversals = OutlineTraversals { all, of, near };
        let row = |way: usize| {
            let mut found = Found::default();
            let others = traversals.near[way].iter().copied().filter(|&other| other != way);
            for other in std::iter::once(way).chain(others).filter(|&other| self.share_a_level([way, other])) {
                let intervals = forbidden.get(&[way, other]).map_or(&[][..], Vec::as_slice);
                let (verdict, cells) = traversals.outside([way, other], intervals);
                found.add([way, other], verdict, cells);
            }
            Ok(found)
        };
        let mut all = Found::default();
        in_stretches(
            self.ways.len(),
            |_| 1,
            told,
            &row,
            |found: Found| {
                all.append(found);
                Ok::<(), ImportError>(())
            },
        )?;
        Ok(all.proof(self))
    }

    fn traversals(&self) -> Result<Traversals, ImportError> {
        let refused = |way: usize, problem: CertifyError| ImportError::new(format!("{}: {problem}", self.name(way)));
        let mut all = Traversals { lines: Vec::new(), ways: Vec::new(), line: Vec::new(), motions: Vec::new() };
        for (way, straight) in self.straight.iter().enumerate() {
            all.line.push(straight.as_ref().map(|_| all.lines.len()));
            if let Some(straight) = straight {
                let line = Traversal::straight(0.5 * self.reach, straight.ends(), straight.speed());
                all.lines.push(line.map_err(|problem| refused(way, problem))?);
                all.ways.push(way);
            }
        }
        let motions = self.fleet.motions();
        if !motions.is_empty() {
            let traversals = parallel::map_parallel(0..self.ways.len(), &|way| {
                let Some(motion) = motions.get(way) else { return Err(refused(way, CertifyError::NoMotion)) };
                let (heading, turns) = self.fleet.headings(way);
                let agent = checker_input::agent(way as u64, motion, heading, turns);
                Traversal::new(&agent).map_err(|problem| refused(way, problem))
            });
            all.motions = traversals.into_iter().collect::<Result<_, _>>()?;
        }
        Ok(all)
    }
}

impl OutlineTraversals<'_> {
    /// The first verdict about two bodies of two ways that is none of freedom.
    fn outside(&self, ways: [usize; 2], forbidden: &[[f64; 2]]) -> (Verdict, usize) {
        let [own, their] = ways.map(|way| &self.all[self.of[way].clone()]);
        let (mut worst, mut cells) = (Verdict::Free, 0);
        for (first, second) in own.iter().flat_map(|first| their.iter().map(move |second| (first, second))) {
            let (verdict, more) = first.outside(second, forbidden);
            cells += more;
            match verdict {
                Verdict::Free => {}
                Verdict::Contact(_) => return (verdict, cells),
                Verdict::Undecided(_) => worst = verdict,
            }
        }
        (worst, cells)
    }
}

impl Traversals {
    fn pair(&self, ways: [usize; 2]) -> [&Traversal; 2] {
        match ways.map(|way| self.line[way]) {
            [Some(own), Some(their)] => [own, their].map(|line| &self.lines[line]),
            _ => ways.map(|way| &self.motions[way]),
        }
    }
}

/// The verdicts of some pairs.
#[derive(Default)]
struct Found {
    pairs: usize,
    cells: usize,
    /// Numbers of refuted and of undecided pairs.
    counts: [usize; 2],
    /// The first ones of each.
    listed: [Vec<([usize; 2], Verdict)>; 2],
}

impl Found {
    fn add(&mut self, ways: [usize; 2], verdict: Verdict, cells: usize) {
        self.pairs += 1;
        self.cells += cells;
        let kind = match verdict {
            Verdict::Free => return,
            Verdict::Contact(_) => 0,
            Verdict::Undecided(_) => 1,
        };
        self.counts[kind] += 1;
        if self.listed[kind].len() < LISTED {
            self.listed[kind].push((ways, verdict));
        }
    }

    fn append(&mut self, other: Self) {
        self.pairs += other.pairs;
        self.cells += other.cells;
        for (kind, listed) in other.listed.into_iter().enumerate() {
            self.counts[kind] += other.counts[kind];
            let room = LISTED - self.listed[kind].len();
            self.listed[kind].extend(listed.into_iter().take(room));
        }
    }

    fn proof(self, of: &UnsafeDelayModel) -> DelayProof {
        let [refuted, undecided] = self.counts;
        let open = self.listed.into_iter().flatten().filter_map(|(ways, verdict)| {
            let (verdict, approach) = match verdict {
                Verdict::Free => return None,
                Verdict::Contact(approach) => ("refuted", approach),
                Verdict::Undecided(approach) => ("undecided", approach),
            };
            let [a, b] = ways.map(|way| of.ways[way].clone());
            let (delay, time, clearance) = (approach.delay, approach.time, approach.clearance);
            let (a_backward, b_backward) = (a.backward, b.backward);
            Some(DelayApproach { verdict, a: a.edge, a_backward, b: b.edge, b_backward, delay, time, clearance })
        });
        let verdict = match [refuted, undecided] {
            [0, 0] => "proved",
            [0, _] => "undecided",
            _ => "refuted",
        };
        let proved = self.pairs - refuted - undecided;
        DelayProof { verdict, pairs: self.pairs, proved, refuted, undecided, cells: self.cells, open: open.collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exclusion_table::{EdgeDriving, ExclusionTable};
    use crate::report::UnsafeDelayReport;
    use pcr_formats::footprint::Footprint;
    use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, VehicleTraits, Warnings, layout};
    use pcr_formats::scenario::PlacedSegment;
    use std::path::Path;

    const DRIVING: [EdgeDriving; 2] =
        [EdgeDriving { speed: 1.0, acceleration: None }, EdgeDriving { speed: 1.0, acceleration: Some(0.3) }];

    /// One-way streets so far apart \[m\], and one of them with its way back. Discs 1 m apart just touch.
    fn grid(apart: f64) -> ImportedLayout {
        let at = |k: u32| f64::from(k) * apart;
        let node =
            |x: u32, y: u32| format!(r#"<node id="n{}"><data key="p">{},{}</data></node>"#, 3 * x + y, at(x), at(y));
        let edge = |id: u32, a: u32, b: u32| format!(r#"<edge id="e{id}" source="n{a}" target="n{b}"/>"#);
        let nodes: String = (0..9).map(|k| node(k / 3, k % 3)).collect();
        let ahead = (0..9).filter(|k| k % 3 < 2).map(|k| edge(k, k, k + 1));
        let aside = (0..6).map(|k| edge(10 + k, k, k + 3));
        let edges: String = ahead.chain(aside).chain([edge(20, 1, 0)]).collect();
        let text = format!(
            r#"<graphml><key id="p" for="node" attr.name="coords" attr.type="string"/><graph edgedefault="directed">{nodes}{edges}</graph></graphml>"#
        );
        read(InputFormat::Ccbs, &text, 0.5)
    }

    fn curves() -> ImportedLayout {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/real/lif/example_17.lif.json");
        read(InputFormat::Lif, &std::fs::read_to_string(path).expect("a layout"), 0.4)
    }

    fn read(format: InputFormat, text: &str, radius: f64) -> ImportedLayout {
        let options = ImportOptions { radius: Some(radius), ..ImportOptions::default() };
        layout(format, text, &options, &mut Warnings::default()).expect("a layout")
    }

    fn table(imported: &ImportedLayout, driving: EdgeDriving) -> (UnsafeDelayModel, UnsafeDelayReport) {
        let delays = UnsafeDelayModel::new(imported, driving, false).expect("delays");
        let table = UnsafeDelayReport::collect(ExclusionTable::head(imported, false), driving, &delays, &|_, _| {})
            .expect("a table");
        (delays, table)
    }

    fn proof(delays: &UnsafeDelayModel, table: &UnsafeDelayReport) -> DelayProof {
        let mut table = table.clone();
        table.certify(delays, &|_, _| {}).expect("a proof");
        table.certificate.expect("as requested")
    }

    #[test]
    fn delays_of_grids_and_curves_are_proved() {
        for (imported, rows) in [(grid(1.0), 20), (grid(0.8), 20), (curves(), 3)] {
            for driving in DRIVING {
                let (delays, table) = table(&imported, driving);
                let found = proof(&delays, &table);
                assert_eq!(
                    (found.verdict, found.proved, &found.open[..]),
                    ("proved", found.pairs, &[][..]),
                    "{driving:?}"
                );
                assert!(table.delays.len() >= rows && found.pairs >= delays.ways().len(), "{found:?}");
            }
        }
    }

    /// A vehicle longer than wide; and one with a notch ahead, of two bodies or more.
    fn outlines() -> [Footprint; 2] {
        let fork =
            [[-0.3, -0.25], [0.7, -0.25], [0.7, -0.1], [0.2, -0.1], [0.2, 0.1], [0.7, 0.1], [0.7, 0.25], [-0.3, 0.25]];
        [vec![[-0.3, -0.25], [0.7, -0.25], [0.7, 0.25], [-0.3, 0.25]], fork.to_vec()]
            .map(|corners| Footprint::new(corners).expect("a footprint"))
    }

    fn with(footprint: Footprint, imported: ImportedLayout) -> ImportedLayout {
        let ImportedLayout { layout, vehicle } = imported;
        let radius = footprint.circumscribed_radius();
        ImportedLayout { layout, vehicle: VehicleTraits { radius, footprint: Some(footprint), ..vehicle } }
    }

    #[test]
    fn delays_of_outlines_are_proved_and_shorter_ones_refuted() {
        for footprint in outlines() {
            let parts = footprint.parts().count();
            for (imported, rows) in [(grid(0.8), 20), (curves(), 1)] {
                let imported = with(footprint.clone(), imported);
                for driving in DRIVING {
                    let (delays, table) = table(&imported, driving);
                    assert_eq!(delays.bodies.iter().map(Range::len).max(), Some(parts));
                    let found = proof(&delays, &table);
                    assert_eq!((found.verdict, &found.open[..]), ("proved", &[][..]), "{driving:?} {found:?}");
                    assert!(table.delays.len() >= rows && found.pairs >= delays.ways().len(), "{found:?}");
                    for row in 0..table.delays.len().min(4) {
                        let [lo, hi] = table.delays[row].delay;
                        let mut altered = table.clone();
                        altered.delays[row].delay = [lo + 0.2 * (hi - lo), hi];
                        let found = proof(&delays, &altered);
                        assert_eq!((found.verdict, found.refuted), ("refuted", 1), "{found:?}");
                        let delay = found.open[0].delay;
                        assert!((lo..=hi).contains(&delay) && found.open[0].clearance < 0.0, "{found:?}");
                    }
                }
            }
        }
    }

    /// Behind one another on one line, the longer vehicle has to leave more room than the disc of its width, and less than the disc around it.
    #[test]
    fn an_outline_behind_another_leaves_its_length() {
        let [footprint, _] = outlines();
        let imported = with(footprint, grid(2.0));
        let (delays, table) = table(&imported, DRIVING[0]);
        let own = table.delays.iter().filter(|row| row.a == row.b && row.a_backward == row.b_backward);
        let mut count = 0;
        for row in own {
            let [lo, hi] = row.delay;
            assert!((lo + 1.0).abs() < 1e-7 && (hi - 1.0).abs() < 1e-7 && lo <= -1.0 && hi >= 1.0, "{row:?}");
            count += 1;
        }
        assert_eq!(count, delays.ways().len());
    }

    #[test]
    fn an_outline_that_turns_in_no_time_is_refused() {
        let [footprint, _] = outlines();
        let mut imported = with(footprint, grid(2.0));
        let corner = [PlacedSegment::line([0.0, 0.0], [0.0, 1.0]), PlacedSegment::line([0.0, 1.0], [1.0, 1.0])];
        imported.layout.edges[0].curve = corner.to_vec();
        let refused = UnsafeDelayModel::new(&imported, DRIVING[0], false).err().expect("no time").to_string();
        assert!(refused.contains("turns in place") && refused.contains("--acceleration"), "{refused}");
        let (delays, table) = table(&imported, DRIVING[1]);
        assert_eq!(proof(&delays, &table).verdict, "proved");
    }

    #[test]
    fn a_table_that_lacks_a_delay_is_refuted() {
        let imported = grid(0.8);
        for driving in DRIVING {
            let (delays, table) = table(&imported, driving);
            let mut refuted = 0;
            for row in 0..table.delays.len() {
                let pair =
                    |found: &DelayApproach| (found.a.clone(), found.a_backward, found.b.clone(), found.b_backward);
                let row_pair = |table: &UnsafeDelayReport| {
                    let of = &table.delays[row];
                    (of.a.clone(), of.a_backward, of.b.clone(), of.b_backward)
                };
                let [lo, hi] = table.delays[row].delay;
                for change in [0, 1, 2] {
                    let mut altered = table.clone();
                    match change {
                        0 => altered.delays[row].delay = [lo + 0.2 * (hi - lo), hi],
                        1 => altered.delays[row].delay = [lo, hi - 0.2 * (hi - lo)],
                        _ => drop(altered.delays.remove(row)),
                    }
                    let found = proof(&delays, &altered);
                    assert_eq!((found.verdict, found.refuted, found.undecided), ("refuted", 1, 0), "{found:?}");
                    assert_eq!(pair(&found.open[0]), row_pair(&table));
                    let delay = found.open[0].delay;
                    assert!((lo..=hi).contains(&delay) && found.open[0].clearance < 0.0, "{found:?}");
                    refuted += 1;
                }
            }
            assert!(refuted > 60, "{refuted}");
        }
    }

    #[test]
    fn a_row_of_another_layout_is_an_error() {
        let (delays, mut table) = table(&grid(1.0), DRIVING[0]);
        table.delays[0].a = ElementId::Text("nowhere".into());
        let refused = table.certify(&delays, &|_, _| {}).expect_err("no such edge");
        assert!(refused.to_string().contains("there is no edge nowhere in this direction"), "{refused}");
    }
}
