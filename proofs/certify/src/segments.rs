//! C-rect and C4: whether the pieces of two segments hold all contacts, and nothing else; and C-share where a piece stands for one interval
//! of two.

use crate::cell::{Claim, Outcome};
use crate::data::{Pair, Share};
use crate::pair::{Findings, Promise, Radii, Segments, gaps};
use crate::path::Stretch;
use crate::shares;
use crate::twofold::Twofold;

/// Checks two segments; C4 only if the table tells lengths.
pub fn check(segments: &mut Segments<'_>, pair: &Pair, radii: &Radii, tells: bool, findings: &mut Findings) {
    findings.segments += 1;
    findings.pieces += segments.pieces.len();
    let covered = Claim::Above(radii.covered);
    if segments.pieces.is_empty() {
        let [first, second] = &mut segments.whole;
        let outcome = covered.decide(second, first, &mut findings.steps);
        if !matches!(outcome, Outcome::Proved) {
            let mut near = first.clone();
            segments.note(outcome, Promise::Covered, pair, radii, 1, &mut near, findings);
        }
        return;
    }
    let [first, second] = segments.stretches;
    for cell in segments.cells() {
        let part = second.placed.part(cell);
        for gap in
            gaps(segments.held(cell, &[Share::Only, Share::Start, Share::End]), [Twofold::ZERO, first.placed.length])
        {
            let mut near = first.placed.part(gap);
            let outcome = covered.decide(&part, &mut near, &mut findings.steps);
            segments.note(outcome, Promise::Covered, pair, radii, 1, &mut near, findings);
        }
    }
    if segments.pieces.iter().any(|(_, share)| *share != Share::Only) {
        shares::check(segments, pair, radii, findings);
    }
    let is_beside = |stretch: &&Stretch| stretch.turns_within(radii.radius, radii.beside);
    let told = if segments.stretches.iter().any(is_beside) { radii.beside } else { radii.told };
    for (lengths, _) in segments.pieces.clone().into_iter().filter(|_| tells) {
        let mut parts = [0, 1].map(|k| segments.stretches[k].placed.part(lengths[k]));
        for of in [0, 1] {
            let cell = parts[of].clone();
            let outcome = Claim::Within(told).decide(&cell, &mut parts[1 - of], &mut findings.steps);
            segments.note(outcome, Promise::Near, pair, radii, of, &mut parts[1 - of], findings);
        }
    }
}
