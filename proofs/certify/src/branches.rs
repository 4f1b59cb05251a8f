//! C-share: where two intervals of an arc may be covered at once, the piece that holds a contact selects the one with it.
//!
//! Let α be the length of the arc opposite to the foot, on the lap nearest to the middle of the arc. A piece that stands for
//! the interval at the start selects it wherever l <= α, one for that at the end wherever l >= α (docs/theory/certificates.md, lemma 4).
//! So for every cell the contacts with l <= α must lie in rectangles of pieces `Only` or `Start`, those with l >= α in such of `Only` or
//! `End`. On a cell α has a range; where that is too wide the cell is cut in half. A query is at a length of the number format, so that
//! of a cell in fixed point what lies between the first and the last one of these counts, down to a single one.

use crate::ball::{Ball, Real106, Ternary};
use crate::distance_claim::{DistanceClaim, DualPrecisionPart};
use crate::double_double::DoubleDouble;
use crate::pair::{Findings, PairRadii, SegmentPairPieces, TableProperty, gaps};
use crate::plane::SegmentPart;
use crate::raw::{RawBranch, RawPair};

/// Cells of one pair of segments at most.
const MOST: usize = 20_000;

/// The lengths, at most two ranges of them, that lie opposite to the feet of a cell \[m\].
fn opposite(cell: &SegmentPart<DoubleDouble>, arc: &SegmentPart<DoubleDouble>) -> Vec<[Real106; 2]> {
    let Some(circle) = &arc.circle else { return Vec::new() };
    let at = cell.middle - circle.centre;
    let cross = arc.axis.cross(at);
    let foot = Ball::angle(arc.axis.dot(at), cross);
    let half_turn = Ball { mid: DoubleDouble::TURN.half(), err: 1e-30 };
    let back = half_turn - foot;
    let spread = cell.spread(at);
    let (least, most) = (back - spread, back + spread);
    // Angles from the middle of the arc, in the direction of travel.
    let ranges = if !(foot - spread).is_positive().is_certain() {
        // The foot is about the middle, the point opposite about the seam of the laps.
        vec![[least, half_turn], [-half_turn, -least]]
    } else {
        let side = if circle.left { cross } else { -cross };
        match (least.is_positive(), side.is_positive()) {
            (Ternary::Yes, Ternary::Yes) => vec![[-most, -least]],
            (Ternary::Yes, Ternary::No) => vec![[least, most]],
            _ => vec![[-most, most]],
        }
    };
    ranges.into_iter().map(|range| range.map(|angle| arc.half + circle.radius * angle)).collect()
}

/// Checks two segments.
pub fn check(segments: &SegmentPairPieces<'_>, pair: &RawPair, radii: &PairRadii, findings: &mut Findings) {
    let [first, second] = segments.stretches;
    let mut arc = first.placed.whole();
    let claim = DistanceClaim::Above(radii.covered);
    let of_format = |cell: DualPrecisionPart<'_>| second.of_format(cell.range).map(|range| second.placed.part(range));
    let mut rest: Vec<_> = segments.cells().into_iter().map(|range| second.placed.part(range)).collect();
    rest = rest.into_iter().filter_map(of_format).collect();
    let mut taken = 0;
    while let Some(mut cell) = rest.pop() {
        (taken, findings.steps) = (taken + 1, findings.steps + 1);
        let sides = |cell: &mut DualPrecisionPart<'_>, arc: &mut DualPrecisionPart<'_>, certain: bool| {
            let ranges = opposite(cell.exact(), arc.exact());
            let mut sides = Vec::new();
            for [lo, hi] in &ranges {
                let (to, from) = if certain { (below(*lo), above(*hi)) } else { (above(*hi), below(*lo)) };
                let length = first.placed.length;
                if to.is_nan() || from.is_nan() {
                    // The comparisons below would all say no, and nothing would be left to show.
                    sides.extend((!certain).then_some([DoubleDouble::ZERO, length]));
                    continue;
                }
                let ends = [
                    [DoubleDouble::ZERO, to.clamp(DoubleDouble::ZERO, length)],
                    [from.clamp(DoubleDouble::ZERO, length), length],
                ];
                let there = [to >= DoubleDouble::ZERO, from <= length];
                for (k, shares) in
                    [[RawBranch::Only, RawBranch::Start], [RawBranch::Only, RawBranch::End]].iter().enumerate()
                {
                    if there[k] {
                        sides.extend(gaps(segments.held(cell.range, shares), ends[k]));
                    }
                }
            }
            // On two laps at once nothing is certain.
            if certain && ranges.len() > 1 { Vec::new() } else { sides }
        };
        let open = sides(&mut cell, &mut arc, false);
        let proved = open.into_iter().all(|gap| claim.holds_at_once(&mut cell, &mut first.placed.part(gap)));
        if proved {
            continue;
        }
        // One that a query can have.
        let [_, middle] = second.of_format([cell.range[0], cell.middle()]).unwrap_or(cell.range);
        let mut point = second.placed.part([middle, middle]);
        for gap in sides(&mut point, &mut arc, true) {
            let mut near = first.placed.part(gap);
            if claim.fails(&mut point, &mut near).is_certain() {
                findings.refuted.push(segments.witness(TableProperty::Shared, pair, radii, middle, 1, &mut near));
                return;
            }
        }
        let half = (cell.range[1] - cell.range[0]).half().to_f64();
        if taken >= MOST || half <= 1e-26 * (1.0 + middle.to_f64()) {
            findings.undecided.push(segments.witness(TableProperty::Shared, pair, radii, middle, 1, &mut arc));
            return;
        }
        rest.extend(cell.halves().into_iter().filter_map(of_format));
    }
}

fn below(ball: Real106) -> DoubleDouble {
    ball.mid - DoubleDouble::from(2.0 * ball.err)
}

fn above(ball: Real106) -> DoubleDouble {
    ball.mid + DoubleDouble::from(2.0 * ball.err)
}
