//! C-rect and C4: whether the pieces of two segments hold all contacts, and nothing else; and C-share where a piece stands for one interval
//! of two.

use crate::branches;
use crate::distance_claim::{ClaimVerdict, DistanceClaim};
use crate::double_double::DoubleDouble;
use crate::pair::{Findings, PairRadii, SegmentPairPieces, TableProperty, gaps};
use crate::path::PreparedSegment;
use crate::raw::{RawBranch, RawPair};

/// Checks two segments; C4 only if the table tells lengths.
pub fn check(
    segments: &mut SegmentPairPieces<'_>,
    pair: &RawPair,
    radii: &PairRadii,
    tells: bool,
    findings: &mut Findings,
) {
    findings.segments += 1;
    findings.pieces += segments.pieces.len();
    let covered = DistanceClaim::Above(radii.covered);
    if segments.pieces.is_empty() {
        let [first, second] = &mut segments.whole;
        let outcome = covered.decide(second, first, &mut findings.steps);
        if !matches!(outcome, ClaimVerdict::Proved) {
            let mut near = first.clone();
            segments.note(outcome, TableProperty::Covered, pair, radii, 1, &mut near, findings);
        }
        return;
    }
    let [first, second] = segments.stretches;
    for cell in segments.cells() {
        let part = second.placed.part(cell);
        for gap in gaps(
            segments.held(cell, &[RawBranch::Only, RawBranch::Start, RawBranch::End]),
            [DoubleDouble::ZERO, first.placed.length],
        ) {
            let mut near = first.placed.part(gap);
            let outcome = covered.decide(&part, &mut near, &mut findings.steps);
            segments.note(outcome, TableProperty::Covered, pair, radii, 1, &mut near, findings);
        }
    }
    if segments.pieces.iter().any(|(_, share)| *share != RawBranch::Only) {
        branches::check(segments, pair, radii, findings);
    }
    let is_beside = |stretch: &&PreparedSegment| stretch.turns_within(radii.radius, radii.beside_large_arc);
    let told = if segments.stretches.iter().any(is_beside) { radii.beside_large_arc } else { radii.reported };
    for (lengths, _) in segments.pieces.clone().into_iter().filter(|_| tells) {
        let mut parts = [0, 1].map(|k| segments.stretches[k].placed.part(lengths[k]));
        for of in [0, 1] {
            let cell = parts[of].clone();
            let outcome = DistanceClaim::Within(told).decide(&cell, &mut parts[1 - of], &mut findings.steps);
            segments.note(outcome, TableProperty::Near, pair, radii, of, &mut parts[1 - of], findings);
        }
    }
}
