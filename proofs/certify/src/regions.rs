//! What is told of a region: that its lengths are those of its pieces, and that its times hold every contact.
//!
//! The told time begins no later than when the agent reaches the first length of the region, and ends no earlier than when it leaves the
//! last one (`docs/theory/certificates.md`, lemma 7). Where rounding has let it begin later, at the length u, the lengths up to u must be
//! farther than R from all that the pieces hold of the other path, but for what another region tells: then no contact there is untold.

use crate::arc_length_motion;
use crate::distance_claim::{ClaimVerdict, DistanceClaim};
use crate::double_double::DoubleDouble;
use crate::error::{CertifyError, InputPart};
use crate::pair::{Findings, PairRadii, PieceOnSegments, SegmentPairPieces, TableProperty, gaps};
use crate::path::PreparedSegment;
use crate::raw::{RawAgent, RawMotion, RawPair};

/// The distances of two agents, be they discs or outlines.
pub(crate) trait Distances {
    /// Decides whether lengths on a segment of the agent `k` are all farther than R from lengths on a segment of the other agent.
    fn are_clear(
        &self,
        segments: [usize; 2],
        k: usize,
        own: [DoubleDouble; 2],
        other: [DoubleDouble; 2],
        steps: &mut usize,
    ) -> ClaimVerdict;
    /// Keeps what is not proved about a length of a piece of the agent `k`.
    fn note(
        &self,
        outcome: ClaimVerdict,
        promise: TableProperty,
        piece: &PieceOnSegments,
        k: usize,
        findings: &mut Findings,
    );
}

/// Two discs.
pub(crate) struct Discs<'a> {
    pub(crate) stretches: [&'a [PreparedSegment]; 2],
    pub(crate) pair: &'a RawPair,
    pub(crate) radii: &'a PairRadii,
}

impl Distances for Discs<'_> {
    fn are_clear(
        &self,
        segments: [usize; 2],
        k: usize,
        own: [DoubleDouble; 2],
        other: [DoubleDouble; 2],
        steps: &mut usize,
    ) -> ClaimVerdict {
        let part = |side: usize, range| self.stretches[side][segments[side]].placed.part(range);
        DistanceClaim::Above(self.radii.radius).decide(&part(k, own), &mut part(1 - k, other), steps)
    }

    fn note(
        &self,
        outcome: ClaimVerdict,
        promise: TableProperty,
        piece: &PieceOnSegments,
        k: usize,
        findings: &mut Findings,
    ) {
        let segments = SegmentPairPieces {
            stretches: [0, 1].map(|side| &self.stretches[side][piece.segments[side]]),
            whole: [0, 1].map(|side| self.stretches[side][piece.segments[side]].placed.whole()),
            pieces: Vec::new(),
        };
        let other = 1 - k;
        let mut near = segments.stretches[other].placed.part(piece.lengths[other]);
        segments.note(outcome, promise, self.pair, self.radii, k, &mut near, findings);
    }
}

/// Checks the regions of a pair.
///
/// # Errors
/// A region that is none: without pieces, with lengths that are not those of its pieces, without times where there are motions.
pub(crate) fn check(
    agents: [&RawAgent; 2],
    stretches: [&[PreparedSegment]; 2],
    pair: &RawPair,
    pieces: &[PieceOnSegments],
    distances: &impl Distances,
    findings: &mut Findings,
) -> Result<(), CertifyError> {
    lengths_are_those_of_pieces(pair)?;
    for (place, region) in pair.regions.iter().enumerate() {
        let wrong = CertifyError::of(InputPart::Region(place));
        let times = match (region.times, agents.map(|agent| agent.travel.as_ref())) {
            (None, [None, None]) => continue,
            (Some(times), [Some(first), Some(second)]) => [(times[0], first), (times[1], second)],
            _ => return Err(wrong(CertifyError::TimeWithoutMotion)),
        };
        findings.times += 1;
        let those: Vec<&PieceOnSegments> = pieces.iter().filter(|piece| piece.region == place).collect();
        for (k, (time, travel)) in times.into_iter().enumerate() {
            let [from, to] = time;
            if !(from <= to && from.abs() < 1e15 && to.abs() < 1e15) {
                return Err(wrong(CertifyError::NoTime(time)));
            }
            let told = ReportedTime { region: place, k, time, travel, agent: agents[k], lengths: region.lengths[k] };
            for end in [0, 1] {
                told.check(end, stretches, pair, &those, pieces, distances, findings);
            }
        }
    }
    Ok(())
}

fn lengths_are_those_of_pieces(pair: &RawPair) -> Result<(), CertifyError> {
    let mut hulls: Vec<Option<[[f64; 2]; 2]>> = vec![None; pair.regions.len()];
    for piece in &pair.pieces {
        let hull = hulls.get_mut(piece.region).ok_or(CertifyError::NoSuchRegion)?;
        let all = hull.get_or_insert(piece.lengths);
        for (all, own) in all.iter_mut().zip(piece.lengths) {
            *all = [all[0].min(own[0]), all[1].max(own[1])];
        }
    }
    let wrong = pair.regions.iter().zip(hulls).position(|(region, hull)| hull != Some(region.lengths));
    wrong.map_or(Ok(()), |place| Err(CertifyError::of(InputPart::Region(place))(CertifyError::RegionLengths)))
}

/// The time of one agent of a region.
struct ReportedTime<'a> {
    /// Of which region.
    region: usize,
    /// Which agent.
    k: usize,
    time: [f64; 2],
    travel: &'a RawMotion,
    agent: &'a RawAgent,
    lengths: [f64; 2],
}

impl ReportedTime<'_> {
    /// Checks the beginning, or the end, of a region of these `pieces`.
    #[expect(clippy::too_many_arguments, reason = "what a witness is made of")]
    fn check(
        &self,
        end: usize,
        stretches: [&[PreparedSegment]; 2],
        pair: &RawPair,
        pieces: &[&PieceOnSegments],
        all: &[PieceOnSegments],
        distances: &impl Distances,
        findings: &mut Findings,
    ) {
        let path = &self.agent.path;
        let full = path.segments.last().map_or(0.0, |segment| segment.to);
        let at = |time: DoubleDouble| arc_length_motion::length_at(self.travel, time, full);
        let since = |time: DoubleDouble| time - DoubleDouble::from(self.travel.start);
        let end_of_all = DoubleDouble::from(arc_length_motion::duration(self.travel));
        let (told, length) = (DoubleDouble::from(self.time[end]), DoubleDouble::from(self.lengths[end]));
        let inward = |by: f64| DoubleDouble::from(if end == 0 { by } else { -by });
        // Before it sets off an agent stands at 0, after its arrival at the end: there no time is too early or too late.
        let always = if end == 0 { since(told) <= DoubleDouble::ZERO } else { since(told) >= end_of_all };
        let note = |outcome, promise, piece: &PieceOnSegments, findings: &mut Findings| {
            distances.note(outcome, promise, piece, self.k, findings);
        };
        if !always {
            // What the lengths along the path may be off is added.
            let reached = at(told)[1 - end] + inward(path.rounding);
            let strip = if end == 0 { [length, reached] } else { [reached, length] };
            if strip[0] <= strip[1] {
                let told = |piece: &&PieceOnSegments| {
                    self.is_told(strip, pair.regions[piece.region].times.map(|times| times[self.k]))
                };
                let elsewhere: Vec<&PieceOnSegments> =
                    all.iter().filter(|piece| piece.region != self.region).filter(told).collect();
                for piece in pieces {
                    let outcome = self.strip_is_clear(strip, stretches, piece, &elsewhere, distances, findings);
                    note(outcome, TableProperty::Timed, piece, findings);
                }
            }
        }
        // For messages the piece that the end is of.
        let is_its_end = |piece: &&&PieceOnSegments| {
            let stretch = &stretches[self.k][piece.segments[self.k]];
            stretch.contains(self.lengths[end])
                && piece.lengths[self.k][end] == stretch.range([self.lengths[end]; 2])[end]
        };
        let Some(piece) = pieces.iter().find(is_its_end).or(pieces.first()) else { return };
        let by_then = told + inward(self.travel.time_excess);
        let [lo, hi] = at(by_then);
        let latest = end_of_all + DoubleDouble::from(self.travel.time_excess);
        // The phases that it goes through may be off by so much of its way.
        let lag = DoubleDouble::from(self.travel.lag);
        // Whether it is certain to have been there by then, or to be there no more; and whether it is certain not to.
        let (passed, not_yet) = match end {
            0 if self.lengths[0] <= 0.0 => (since(told) >= DoubleDouble::ZERO, since(told) < DoubleDouble::ZERO),
            0 => (lo + lag >= length || since(by_then) >= end_of_all, hi + lag < length),
            _ if self.lengths[1] >= full => (since(told) <= latest, since(told) > latest),
            _ => (hi - lag <= length || since(by_then) <= DoubleDouble::ZERO, lo - lag > length),
        };
        let place = piece.lengths[self.k][end];
        let outcome = match (passed, not_yet) {
            (true, _) => ClaimVerdict::Proved,
            (_, true) => ClaimVerdict::Refuted(place),
            _ => ClaimVerdict::Undecided(place),
        };
        note(outcome, TableProperty::Prompt, piece, findings);
    }

    /// Whether the agent is within the lengths of a strip at no other times than these.
    fn is_told(&self, strip: [DoubleDouble; 2], time: Option<[f64; 2]>) -> bool {
        let Some(time) = time else { return false };
        let [full, rounding] = [self.agent.path.segments.last().map_or(0.0, |last| last.to), self.agent.path.rounding];
        let [begin, end] = time.map(|time| {
            let since = DoubleDouble::from(time) - DoubleDouble::from(self.travel.start);
            (since, arc_length_motion::length_at(self.travel, DoubleDouble::from(time), full))
        });
        (begin.0 <= DoubleDouble::ZERO || begin.1[1] + DoubleDouble::from(rounding) < strip[0])
            && (end.0 >= DoubleDouble::from(arc_length_motion::duration(self.travel))
                || end.1[0] - DoubleDouble::from(rounding) > strip[1])
    }

    /// Whether no length of a strip that the piece holds is within R of what it holds of the other path and other pieces do not.
    fn strip_is_clear(
        &self,
        strip: [DoubleDouble; 2],
        stretches: [&[PreparedSegment]; 2],
        piece: &PieceOnSegments,
        elsewhere: &[&PieceOnSegments],
        distances: &impl Distances,
        findings: &mut Findings,
    ) -> ClaimVerdict {
        let other = 1 - self.k;
        let own = &stretches[self.k][piece.segments[self.k]];
        let [from, to] = piece.lengths[self.k];
        let Some(strip) = own.common(strip) else { return ClaimVerdict::Proved };
        let lo = if from < strip[0] { strip[0] } else { from };
        let hi = if strip[1] < to { strip[1] } else { to };
        if hi < lo {
            return ClaimVerdict::Proved;
        }
        let holds = |it: &&&PieceOnSegments| {
            let [from, to] = it.lengths[self.k];
            it.segments == piece.segments && from <= lo && hi <= to
        };
        let held = elsewhere.iter().filter(holds).map(|it| it.lengths[other]).collect();
        for left in gaps(held, piece.lengths[other]) {
            let outcome = distances.are_clear(piece.segments, self.k, [lo, hi], left, &mut findings.steps);
            if !matches!(outcome, ClaimVerdict::Proved) {
                return outcome;
            }
        }
        ClaimVerdict::Proved
    }
}
