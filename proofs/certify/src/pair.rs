//! Two agents: the pieces of their regions on their segments, what is asked of them, and what is found.

use crate::ball::Ball;
use crate::distance_claim::{ClaimVerdict, DualPrecisionPart};
use crate::double_double::DoubleDouble;
use crate::error::CertifyError;
use crate::path::PreparedSegment;
use crate::raw::{RawBranch, RawPair, RawPiece};

/// What a table promises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableProperty {
    /// Every contact lies in the rectangle of a piece (C-rect).
    Covered,
    /// The piece that holds it stands for the interval that holds it (C-share).
    Shared,
    /// No length is told that is farther than R + ε from all lengths of the other path told with it, or R + 3/2 ε beside an arc that is as
    /// large as the disc (C4).
    Near,
    /// Whenever an agent is at a contact of a region, that is within the time told of the region (E_t).
    Timed,
    /// No time is told that is farther out than stated from when the agent is at its lengths (E_t).
    Prompt,
}

/// Where a promise is broken, or may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Witness {
    /// The promise.
    pub promise: TableProperty,
    /// Places of the agents.
    pub agents: [usize; 2],
    /// Lengths along their paths \[m\].
    pub lengths: [f64; 2],
    /// Distance of the discs' centres there less R \[m\]; NaN where it is not known.
    pub clearance: f64,
    /// ε \[m\].
    pub excess: f64,
}

/// What has come of a check.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// What is wrong, the first one of each pair of segments.
    pub refuted: Vec<Witness>,
    /// Where rounding does not tell.
    pub undecided: Vec<Witness>,
    /// Cells that were looked at.
    pub steps: usize,
    /// Pairs of segments.
    pub segments: usize,
    /// Pieces.
    pub pieces: usize,
    /// Regions whose times were looked at.
    pub times: usize,
}

impl Findings {
    /// Both together.
    pub fn add(&mut self, other: Self) {
        self.refuted.extend(other.refuted);
        self.undecided.extend(other.undecided);
        self.steps += other.steps;
        self.segments += other.segments;
        self.pieces += other.pieces;
        self.times += other.times;
    }
}

/// What is asked of a pair.
#[derive(Clone, Copy, Debug)]
pub struct PairRadii {
    /// The combined radius R \[m\].
    pub radius: Ball<DoubleDouble>,
    /// What all contacts are within: R + δ \[m\].
    pub covered: Ball<DoubleDouble>,
    /// What everything told is within: R + ε \[m\].
    pub reported: Ball<DoubleDouble>,
    /// The same beside an arc that is as large as the disc: R + 3/2 ε \[m\].
    pub beside_large_arc: Ball<DoubleDouble>,
}

/// Two segments and the pieces about them.
pub struct SegmentPairPieces<'a> {
    /// Those of the first and of the second agent.
    pub stretches: [&'a PreparedSegment; 2],
    /// All of them.
    pub whole: [DualPrecisionPart<'a>; 2],
    /// Lengths along the segments, and the share.
    pub pieces: Vec<([[DoubleDouble; 2]; 2], RawBranch)>,
}

/// Lengths of the first segment in `within` that are in none of the ranges, closed. A range with an end that is no number
/// holds nothing, and of what is within no numbers all is left: neither may pass as held.
pub fn gaps(mut ranges: Vec<[DoubleDouble; 2]>, within: [DoubleDouble; 2]) -> Vec<[DoubleDouble; 2]> {
    if within.iter().any(|end| end.is_nan()) {
        return vec![within];
    }
    ranges.retain(|ends| !ends.iter().any(|end| end.is_nan()));
    ranges.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let ([mut from, end], mut gaps) = (within, Vec::new());
    let mut begun = false;
    for [lo, hi] in ranges {
        if lo > end {
            break;
        }
        if lo > from {
            gaps.push([from, lo]);
        }
        // A range that ends before does not hold the first length.
        if hi >= from {
            (from, begun) = (hi, true);
        }
    }
    if from < end || (!begun && from <= end) {
        gaps.push([from, end]);
    }
    gaps
}

impl SegmentPairPieces<'_> {
    /// The parts of the second segment between ends of pieces.
    pub fn cells(&self) -> Vec<[DoubleDouble; 2]> {
        let end = self.stretches[1].placed.length;
        let mut cuts: Vec<DoubleDouble> = self.pieces.iter().flat_map(|(lengths, _)| lengths[1]).collect();
        cuts.extend([DoubleDouble::ZERO, end]);
        cuts.sort_by(DoubleDouble::total_cmp);
        cuts.dedup();
        if cuts.len() == 1 {
            return vec![[DoubleDouble::ZERO, end]];
        }
        cuts.windows(2).map(|cut| [cut[0], cut[1]]).collect()
    }

    /// The lengths of the first segment that pieces with one of these shares hold all along a cell of the second one.
    pub fn held(&self, cell: [DoubleDouble; 2], shares: &[RawBranch]) -> Vec<[DoubleDouble; 2]> {
        let holds = |range: [DoubleDouble; 2]| range[0] <= cell[0] && cell[1] <= range[1];
        let those = self.pieces.iter().filter(|(lengths, share)| shares.contains(share) && holds(lengths[1]));
        those.map(|(lengths, _)| lengths[0]).collect()
    }

    /// The point of the cell's middle and the point of a part of the first segment nearest to it, or the other way round.
    pub fn witness(
        &self,
        promise: TableProperty,
        pair: &RawPair,
        radii: &PairRadii,
        at: DoubleDouble,
        of: usize,
        near: &mut DualPrecisionPart<'_>,
    ) -> Witness {
        let other = 1 - of;
        let mut here = self.stretches[of].placed.part([at, at]);
        let distance = near.exact().nearest(here.exact().middle);
        let foot = near.foot(here.exact().middle);
        let mut lengths = [0.0; 2];
        lengths[of] = self.stretches[of].on_path(at);
        lengths[other] = self.stretches[other].on_path(foot);
        let clearance = (distance - radii.radius).display_length();
        Witness { promise, agents: pair.agents, lengths, clearance, excess: pair.excess }
    }

    /// Keeps what is not proved.
    #[expect(clippy::too_many_arguments, reason = "what a witness is made of")]
    pub fn note(
        &self,
        outcome: ClaimVerdict,
        promise: TableProperty,
        pair: &RawPair,
        radii: &PairRadii,
        of: usize,
        near: &mut DualPrecisionPart<'_>,
        findings: &mut Findings,
    ) {
        match outcome {
            ClaimVerdict::Proved => {}
            ClaimVerdict::Refuted(at) => findings.refuted.push(self.witness(promise, pair, radii, at, of, near)),
            ClaimVerdict::Undecided(at) => findings.undecided.push(self.witness(promise, pair, radii, at, of, near)),
        }
    }
}

/// A piece on its segments.
#[derive(Clone, Copy, Debug)]
pub struct PieceOnSegments {
    /// Places of the segments in their paths.
    pub segments: [usize; 2],
    /// Lengths along the segments.
    pub lengths: [[DoubleDouble; 2]; 2],
    /// Its share.
    pub share: RawBranch,
    /// Place of its region.
    pub region: usize,
}

/// The pieces of a pair by their segments, as lengths along these.
///
/// # Errors
/// What is wrong with them.
pub fn pieces_of(
    pieces: &[RawPiece],
    stretches: [&[PreparedSegment]; 2],
) -> Result<Vec<PieceOnSegments>, CertifyError> {
    let mut placed = Vec::with_capacity(pieces.len());
    for piece in pieces {
        let mut lengths = [[DoubleDouble::ZERO; 2]; 2];
        for k in [0, 1] {
            let stretch = stretches[k].get(piece.segments[k]).ok_or(CertifyError::NoSuchSegment)?;
            let [lo, hi] = piece.lengths[k];
            if !(stretch.contains(lo) && stretch.contains(hi) && lo <= hi) {
                return Err(CertifyError::PieceOffSegment([lo, hi]));
            }
            if !(stretch.is_of_format(lo) && stretch.is_of_format(hi)) {
                return Err(CertifyError::PieceOffFormat([lo, hi]));
            }
            lengths[k] = stretch.range([lo, hi]);
        }
        if piece.share != RawBranch::Only && stretches[0][piece.segments[0]].turns_left().is_none() {
            return Err(CertifyError::LineBranch);
        }
        placed.push(PieceOnSegments { segments: piece.segments, lengths, share: piece.share, region: piece.region });
    }
    placed.sort_by_key(|piece| piece.segments);
    Ok(placed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ranges<const N: usize>(ends: [[f64; 2]; N]) -> Vec<[DoubleDouble; 2]> {
        ends.map(|range| range.map(DoubleDouble::from)).to_vec()
    }

    #[test]
    fn what_is_no_number_holds_nothing() {
        let left = |held: Vec<[DoubleDouble; 2]>| gaps(held, [0.0, 9.0].map(DoubleDouble::from));
        assert_eq!(left(ranges([[6.0, 9.0], [0.0, 2.0], [1.0, 4.0]])), ranges([[4.0, 6.0]]));
        let none = f64::NAN;
        assert_eq!(left(ranges([[none, 9.0], [3.0, none], [2.0, 9.0], [none, none]])), ranges([[0.0, 2.0]]));
        assert_eq!(left(ranges([[8.0, 9.0], [none, 1.0], [0.0, 7.0]])), ranges([[7.0, 8.0]]));
        for within in [[none, 9.0], [0.0, none]] {
            assert_eq!(gaps(ranges([[0.0, 9.0]]), within.map(DoubleDouble::from)).len(), 1, "{within:?}");
        }
    }
}
