//! A whole table of bodies: every pair of them, every pair of their segments, and what is told of each region.
//!
//! The promises are those of discs (`docs/theory/certificates.md`): C-rect, C-share (the k-th of n intervals), C4 and E_t, with the distance of the
//! outlines in place of that of the discs. The lag of a motion is what a corner may be off.

use super::body::Body;
use super::cover::{Segments, Verdict};
use super::data::{RawBody, RawOutlinePair, RawOutlinePiece, RawOutlineTable};
use super::ranks::{self, Bounds};
use super::separation::above;
use crate::arc_length_motion;
use crate::ball::Ball;
use crate::box_index::{BoxIndex, PlainBox};
use crate::distance_claim::ClaimVerdict;
use crate::double_double::DoubleDouble;
use crate::error::{CertifyError, InputPart};
use crate::pair::{Findings, PieceOnSegments, TableProperty, Witness, pieces_of};
use crate::path::{LEAST, PreparedSegment};
use crate::raw::{RawAgent, RawBranch, RawPair, RawPiece};
use crate::regions::{self, Distances};
use crate::table::{CoverageMargin, ProximityIndex};
use std::collections::HashSet;

/// What has come of a check of a table of bodies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// What is refuted, what is undecided, and what was looked at.
    pub findings: Findings,
    /// How much of the second segments of all pairs is so near to an event that of no more than the number of intervals nothing is
    /// proved ([`super::ranks`]) \[m\].
    pub unranked: f64,
}

/// The box of all that a body passes, with what its lengths are off and ε.
fn area(body: &Body<'_>, excess: f64) -> PlainBox {
    body.area((off(body) + excess).next_up())
}

/// What a corner may be off by the rounding of lengths and times \[m\].
fn off(body: &Body<'_>) -> f64 {
    let lag = body.raw.travel.as_ref().map_or(0.0, |travel| travel.lag);
    (body.raw.rounding * body.lever() + lag).next_up()
}

impl ProximityIndex {
    /// Those of a table of bodies whose pairs have an ε of this at most \[m\].
    ///
    /// # Errors
    /// A body that is none.
    pub fn of_bodies(bodies: &[RawBody], excess: f64) -> Result<Self, CertifyError> {
        let areas = bodies.iter().map(|raw| Ok(area(&Body::new(raw)?, excess)));
        Ok(Self(BoxIndex::new(areas.collect::<Result<_, CertifyError>>()?)))
    }
}

/// A table whose numbers have been looked through.
#[derive(Clone, Debug)]
pub struct Checker<'a> {
    bodies: Vec<Body<'a>>,
    /// The segments of each as lengths, and its motion.
    lines: Vec<(Vec<PreparedSegment>, RawAgent)>,
    pairs: &'a [RawOutlinePair],
}

impl<'a> Checker<'a> {
    /// Puts the bodies on their paths into the plane.
    ///
    /// # Errors
    /// What is wrong with the table: numbers out of range, a path or an outline that is none, a pair that is missing or there twice.
    pub fn new(table: &'a RawOutlineTable) -> Result<Self, CertifyError> {
        let (mut bodies, mut lines) = (Vec::new(), Vec::new());
        for (place, raw) in table.bodies.iter().enumerate() {
            let wrong = CertifyError::of(InputPart::Body(raw.id, Some(place)));
            let body = Body::new(raw).map_err(wrong)?;
            let agent = RawAgent {
                id: raw.id,
                radius: raw.outline.radius,
                path: body.lengths.clone(),
                travel: raw.travel.clone(),
            };
            arc_length_motion::checked(&agent).and_then(|()| arc_length_motion::arrives(&agent)).map_err(wrong)?;
            lines.push((body.segments.iter().map(|segment| segment.stretch.clone()).collect(), agent));
            bodies.push(body);
        }
        let checker = Self { bodies, lines, pairs: &table.pairs };
        checker.all_pairs_are_there(table.apart)?;
        Ok(checker)
    }

    fn all_pairs_are_there(&self, apart: Option<f64>) -> Result<(), CertifyError> {
        let count = self.bodies.len();
        let id = |place: usize| self.bodies[place].raw.id;
        let mut there = HashSet::with_capacity(self.pairs.len());
        for pair in self.pairs {
            let [a, b] = pair.bodies;
            if a == b || a >= count || b >= count || id(a) == id(b) || !there.insert([a.min(b), a.max(b)]) {
                return Err(CertifyError::NoPair([a, b]));
            }
            if !(LEAST..1e15).contains(&pair.excess) {
                return Err(CertifyError::Excess([a, b]));
            }
        }
        let is_missing = |a: usize, b: usize| id(a) != id(b) && !there.contains(&[a, b]);
        let missing = match apart {
            Some(excess) if (LEAST..1e15).contains(&excess) => {
                let near = BoxIndex::new(self.bodies.iter().map(|body| area(body, excess)).collect());
                (0..count).find_map(|a| near.after(a).into_iter().find(|&b| is_missing(a, b)).map(|b| [a, b]))
            }
            Some(_) => return Err(CertifyError::OutOfRange("the excess of those that are left out")),
            None => (0..count).find_map(|a| (a + 1..count).find(|&b| is_missing(a, b)).map(|b| [a, b])),
        };
        missing.map_or(Ok(()), |pair| Err(CertifyError::MissingPair(pair)))
    }

    /// What a corner may be off by the rounding of lengths and times \[m\].
    fn off(&self, place: usize) -> f64 {
        off(&self.bodies[place])
    }

    /// Checks every pair.
    ///
    /// # Errors
    /// A piece or a region that is none.
    pub fn check(&self, margin: CoverageMargin) -> Result<Report, CertifyError> {
        self.watched(margin, &|_| {})
    }

    /// Checks every pair as [`Checker::check`], and tells before each one how many are checked.
    ///
    /// # Errors
    /// A piece or a region that is none.
    pub fn watched(&self, margin: CoverageMargin, told: &dyn Fn(usize)) -> Result<Report, CertifyError> {
        let mut report = Report::default();
        for (checked, pair) in self.pairs.iter().enumerate() {
            told(checked);
            self.pair(pair, margin, &mut report)?;
        }
        Ok(report)
    }

    /// The largest margin, in ε, at which contacts are covered in all pairs with regions, up to 1 and found to 2^-12; none without any. An
    /// exact table with a slack of ε/2 would have 1/2.
    ///
    /// # Errors
    /// A piece that is none.
    pub fn margin(&self) -> Result<Option<f64>, CertifyError> {
        const STEPS: u32 = 12;
        let mut least: Option<f64> = None;
        for pair in self.pairs.iter().filter(|pair| !pair.pieces.is_empty()) {
            let pieces = self.pieces(pair)?;
            let holds = |part: f64| self.is_covered(pair, &pieces, part);
            let (mut lo, mut hi) = (-1.0, least.unwrap_or(1.0));
            if !holds(lo) {
                return Ok(Some(f64::NEG_INFINITY));
            }
            if holds(hi) {
                lo = hi;
            }
            for _ in 0..STEPS {
                let middle = 0.5 * (lo + hi);
                if holds(middle) { lo = middle } else { hi = middle }
            }
            least = Some(lo);
        }
        Ok(least)
    }

    /// Whether pieces hold all contacts within R and a part of ε.
    fn is_covered(&self, pair: &RawOutlinePair, pieces: &[(PieceOnSegments, [u8; 2])], part: f64) -> bool {
        let [first, second] = pair.bodies.map(|place| &self.bodies[place]);
        let least = first.radius + second.radius + Ball::from(part * pair.excess);
        first.segments.iter().enumerate().all(|(i, own)| {
            second.segments.iter().enumerate().all(|(j, other)| {
                let those = pieces.iter().filter(|(piece, _)| piece.segments == [i, j]);
                let rectangles: Vec<_> = those.map(|(piece, _)| piece.lengths).collect();
                let segments = Segments([own, other]);
                let mut free = segments.left_free(&rectangles).into_iter();
                free.all(|ranges| segments.farther(ranges, least, &mut 0) == Verdict::Proved)
            })
        })
    }

    /// The pieces of a pair as lengths along their segments, with their ranks.
    fn pieces(&self, pair: &RawOutlinePair) -> Result<Vec<(PieceOnSegments, [u8; 2])>, CertifyError> {
        let [a, b] = pair.bodies;
        let named = CertifyError::of(InputPart::Pair([a, b]));
        let stretches: [&[PreparedSegment]; 2] = [&self.lines[a].0, &self.lines[b].0];
        let mut pieces = Vec::with_capacity(pair.pieces.len());
        for piece in &pair.pieces {
            let [k, of] = piece.rank;
            if k >= of {
                return Err(named(CertifyError::PieceRank([k, of])));
            }
            let placed = pieces_of(&[unranked(piece)], stretches).map_err(named)?;
            pieces.extend(placed.into_iter().map(|one| (one, piece.rank)));
        }
        Ok(pieces)
    }

    fn pair(&self, pair: &RawOutlinePair, margin: CoverageMargin, report: &mut Report) -> Result<(), CertifyError> {
        let [a, b] = pair.bodies;
        let bodies = [&self.bodies[a], &self.bodies[b]];
        let lines = [&self.lines[a], &self.lines[b]];
        let stretches: [&[PreparedSegment]; 2] = lines.map(|(stretches, _)| &stretches[..]);
        let more = match margin {
            CoverageMargin::Needed => self.off(a).max(self.off(b)).max(0.25 * pair.excess),
            CoverageMargin::Epsilons(part) => part * pair.excess,
        };
        let radius = bodies[0].radius + bodies[1].radius;
        let bounds = Bounds { radius, covered: radius + Ball::from(more), told: radius + Ball::from(pair.excess) };
        let pieces = self.pieces(pair)?;
        let pair_of_discs = RawPair {
            agents: pair.bodies,
            excess: pair.excess,
            regions: pair.regions.clone(),
            pieces: pair.pieces.iter().map(unranked).collect(),
        };
        let outlines = Outlines { bodies, pair: &pair_of_discs, radius };
        for (i, own) in bodies[0].segments.iter().enumerate() {
            for (j, other) in bodies[1].segments.iter().enumerate() {
                let segments = Segments([own, other]);
                let those = pieces.iter().filter(|(piece, _)| piece.segments == [i, j]);
                let those: Vec<_> = those.map(|(piece, rank)| (piece.lengths, *rank)).collect();
                let rectangles: Vec<_> = those.iter().map(|(lengths, _)| *lengths).collect();
                report.findings.segments += 1;
                report.findings.pieces += rectangles.len();
                let steps = &mut report.findings.steps;
                let uncovered = segments.covered(&rectangles, bounds.covered, steps);
                let ranks = ranks::check(&segments, &those, bounds, steps);
                report.unranked += ranks.unranked;
                let mut far = Vec::new();
                for rectangle in &rectangles {
                    far.extend([0, 1].map(|of| segments.within(of, *rectangle, bounds.told, steps)));
                }
                for (promise, verdicts) in [
                    (TableProperty::Covered, uncovered),
                    (TableProperty::Shared, ranks.found),
                    (TableProperty::Near, far),
                ] {
                    for verdict in verdicts {
                        outlines.keep(verdict, promise, [i, j], &mut report.findings);
                    }
                }
            }
        }
        let agents = lines.map(|(_, agent)| agent);
        let placed: Vec<PieceOnSegments> = pieces.iter().map(|(piece, _)| *piece).collect();
        regions::check(agents, stretches, &pair_of_discs, &placed, &outlines, &mut report.findings)
            .map_err(CertifyError::of(InputPart::Pair([a, b])))
    }
}

/// A piece without its rank.
fn unranked(piece: &RawOutlinePiece) -> RawPiece {
    let RawOutlinePiece { segments, lengths, region, .. } = *piece;
    RawPiece { segments, lengths, share: RawBranch::Only, region }
}

/// Distances of two bodies.
struct Outlines<'a> {
    bodies: [&'a Body<'a>; 2],
    pair: &'a RawPair,
    radius: Ball<DoubleDouble>,
}

impl Outlines<'_> {
    fn segments(&self, places: [usize; 2]) -> Segments<'_> {
        Segments([0, 1].map(|k| &self.bodies[k].segments[places[k]]))
    }

    fn keep(&self, verdict: Verdict, promise: TableProperty, places: [usize; 2], findings: &mut Findings) {
        let (refuted, at) = match verdict {
            Verdict::Proved => return,
            Verdict::Refuted(at) => (true, at),
            Verdict::Undecided(at) => (false, at),
        };
        let Segments(segments) = self.segments(places);
        let postures = [0, 1].map(|k| segments[k].exact.posture(Ball { mid: at[k], err: 0.0 }));
        let witness = Witness {
            promise,
            agents: self.pair.agents,
            lengths: [0, 1].map(|k| segments[k].stretch.on_path(at[k])),
            clearance: (above([&postures[0], &postures[1]]) - self.radius).display_length(),
            excess: self.pair.excess,
        };
        if refuted { findings.refuted.push(witness) } else { findings.undecided.push(witness) }
    }
}

impl Distances for Outlines<'_> {
    fn are_clear(
        &self,
        places: [usize; 2],
        k: usize,
        own: [DoubleDouble; 2],
        other: [DoubleDouble; 2],
        steps: &mut usize,
    ) -> ClaimVerdict {
        let ranges = if k == 0 { [own, other] } else { [other, own] };
        match self.segments(places).farther(ranges, self.radius, steps) {
            Verdict::Proved => ClaimVerdict::Proved,
            Verdict::Refuted(at) => ClaimVerdict::Refuted(at[k]),
            Verdict::Undecided(at) => ClaimVerdict::Undecided(at[k]),
        }
    }

    fn note(
        &self,
        outcome: ClaimVerdict,
        promise: TableProperty,
        piece: &PieceOnSegments,
        k: usize,
        findings: &mut Findings,
    ) {
        let pair = |at: DoubleDouble| {
            let mut lengths = piece.lengths.map(|range| range[0]);
            lengths[k] = at;
            lengths[1 - k] = self.segments(piece.segments).guess(k, at, piece.lengths[1 - k]);
            lengths
        };
        let verdict = match outcome {
            ClaimVerdict::Proved => return,
            ClaimVerdict::Refuted(at) => Verdict::Refuted(pair(at)),
            ClaimVerdict::Undecided(at) => Verdict::Undecided(pair(at)),
        };
        self.keep(verdict, promise, piece.segments, findings);
    }
}
