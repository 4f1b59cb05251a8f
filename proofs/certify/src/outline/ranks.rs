//! C-share for outlines: a piece that stands for the k-th of n intervals stands for the one that holds its contacts.
//!
//! The library looks up a slice of the first segment. If it has n intervals, the piece stands for the k-th one, otherwise for all that meet
//! its range. So only where there are n of them must k be right. On a cell of the second segment let w_1 < ... < w_z be *walls*, lengths of
//! the first segment that are farther than R + ε from all of the cell, with a length within R of all of the cell before w_1, between
//! any two, and behind w_z. Every slice of the cell then has at least z + 1 intervals. If it has z + 1, the i-th one lies between w_i and
//! w_i+1. So for n = z + 1 a piece holds only contacts between its own two walls, and all others must be held by pieces of their own; for
//! n < z + 1 every slice has another number of intervals, and a piece stands for all of its range, as it does for n = 1.
//!
//! A cell that has no such walls is cut in half. About an event, where a gap or an interval has just opened, no cell has any: there the
//! distance has an extreme within R and R + ε, and the number of intervals is what rounding makes of it. Such cells, down to where no
//! point of the bodies goes farther than ε, are not proved, and their length is told. A small cell without such an extreme is undecided.

use super::cover::{Range, Segments, Verdict};
use super::separation::sketched;
use crate::ball::Real106;
use crate::double_double::DoubleDouble;
use crate::pair::gaps;

/// Samples of a slice, and between any two ends of pieces.
const SAMPLES: usize = 32;
/// Samples between ends of pieces, all of them together, about.
const MOST_SAMPLES: usize = 256;
/// Cells of one pair of segments at most.
const MOST: usize = 20_000;

/// What has come of a check of ranks.
#[derive(Clone, Debug, Default)]
pub struct Ranks {
    /// What is not proved.
    pub found: Vec<Verdict>,
    /// How much of the second segment is so near to an event that nothing is proved of it \[m\].
    pub unranked: f64,
}

/// The bounds on the distance of the polygons that ranks are about.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// R \[m\].
    pub radius: Real106,
    /// What all contacts are within: R + δ \[m\].
    pub covered: Real106,
    /// R + ε \[m\].
    pub told: Real106,
}

/// An extreme of the distance along the first segment.
#[derive(Clone, Copy)]
struct Extreme {
    at: f64,
    distance: f64,
    is_least: bool,
}

/// Checks the pieces of two segments.
pub fn check(segments: &Segments<'_>, pieces: &[([Range; 2], [u8; 2])], bounds: Bounds, steps: &mut usize) -> Ranks {
    let mut ranks = Ranks::default();
    let mut cuts: Vec<DoubleDouble> = pieces.iter().flat_map(|(ranges, _)| ranges[1]).collect();
    cuts.sort_by(DoubleDouble::total_cmp);
    cuts.dedup();
    let mut rest: Vec<Range> = cuts.windows(2).map(|cut| [cut[0], cut[1]]).collect();
    if cuts.len() == 1 {
        rest.push([cuts[0]; 2]);
    }
    let mut taken = 0;
    while let Some(cell) = rest.pop() {
        (taken, *steps) = (taken + 1, *steps + 1);
        let holds = |(ranges, _): &&([Range; 2], [u8; 2])| ranges[1][0] <= cell[0] && cell[1] <= ranges[1][1];
        let held: Vec<_> = pieces.iter().filter(holds).collect();
        if held.iter().all(|(_, [_, of])| *of <= 1) {
            continue;
        }
        let middle = (cell[0] + cell[1]).half();
        let extremes = extremes(segments, &held, middle);
        if let Some(walls) = walls(segments, &extremes, cell, bounds, steps)
            && held.iter().all(|(_, [_, of])| usize::from(*of) <= walls.len() + 1)
        {
            ranks.found.extend(unheld(segments, &held, &walls, cell, bounds, steps));
            continue;
        }
        let width = (cell[1] - cell[0]).to_f64();
        let excess = (bounds.told - bounds.radius).to_f64();
        if width * segments.0[1].lever > excess && taken < MOST && cell[0] < middle && middle < cell[1] {
            rest.extend([[middle, cell[1]], [cell[0], middle]]);
            continue;
        }
        let event = |extreme: &Extreme| (extreme.distance - bounds.radius.to_f64()).abs() <= 2.0 * excess;
        if extremes.iter().any(event) {
            ranks.unranked += width;
        } else {
            // Others beside it would be as well.
            ranks.found.push(Verdict::Undecided([held[0].0[0][0], middle]));
            break;
        }
    }
    ranks
}

/// The lengths of pieces that are not between their walls must be held by others, or be no contacts.
fn unheld(
    segments: &Segments<'_>,
    held: &[&([Range; 2], [u8; 2])],
    walls: &[DoubleDouble],
    cell: Range,
    bounds: Bounds,
    steps: &mut usize,
) -> Vec<Verdict> {
    let end = segments.0[0].stretch.placed.length;
    let own = |(ranges, [k, of]): &([Range; 2], [u8; 2])| {
        let [lo, hi] = ranges[0];
        if usize::from(*of) <= walls.len() {
            return Some([lo, hi]);
        }
        let k = usize::from(*k);
        let from = if k == 0 { DoubleDouble::ZERO } else { walls[k - 1] };
        let to = walls.get(k).copied().unwrap_or(end);
        let (from, to) = (if from < lo { lo } else { from }, if to < hi { to } else { hi });
        (from <= to).then_some([from, to])
    };
    let kept: Vec<Range> = held.iter().filter_map(|piece| own(piece)).collect();
    let mut found = Vec::new();
    for (ranges, _) in held.iter().filter(|piece| own(piece) != Some(piece.0[0])) {
        for gap in gaps(kept.clone(), ranges[0]) {
            match segments.farther([gap, cell], bounds.covered, steps) {
                Verdict::Proved => {}
                other => found.push(other),
            }
        }
    }
    found
}

/// Lengths of the first segment that part the contacts of a cell, and are certain to; none, if any is not.
fn walls(
    segments: &Segments<'_>,
    extremes: &[Extreme],
    cell: Range,
    bounds: Bounds,
    steps: &mut usize,
) -> Option<Vec<DoubleDouble>> {
    let radius = bounds.radius.to_f64();
    let mut walls = Vec::new();
    let mut wall: Option<Extreme> = None;
    let mut any = false;
    for &extreme in extremes {
        if !extreme.is_least {
            let higher = wall.is_none_or(|wall| wall.distance < extreme.distance);
            wall = if higher { Some(extreme) } else { wall };
            continue;
        }
        if extreme.distance > radius {
            continue;
        }
        let at = DoubleDouble::from(extreme.at);
        if !segments.is_within_at(at, cell, bounds.radius) {
            return None;
        }
        if let Some(wall) = wall.filter(|_| any)
            && wall.distance > radius
        {
            let at = DoubleDouble::from(wall.at);
            *steps += 1;
            if !segments.is_farther_at_once([[at, at], cell], bounds.told) {
                return None;
            }
            walls.push(at);
        }
        (any, wall) = (true, None);
    }
    any.then_some(walls)
}

/// The extremes of the distance along the first segment at a length of the second one, about, in order. Where pieces end and between
/// them, gaps and intervals may be thin, and samples are closer.
fn extremes(segments: &Segments<'_>, held: &[&([Range; 2], [u8; 2])], at: DoubleDouble) -> Vec<Extreme> {
    let [own, other] = segments.0.map(|body| &body.near);
    let length = segments.0[0].stretch.placed.length.to_f64();
    let there = other.sketch(at.to_f64());
    let distance = |at: f64| sketched([&own.sketch(at), &there]);
    let mut ends: Vec<f64> = held.iter().flat_map(|(ranges, _)| ranges[0].map(DoubleDouble::to_f64)).collect();
    ends.extend([0.0, length]);
    ends.sort_by(f64::total_cmp);
    ends.dedup();
    let count = (MOST_SAMPLES / ends.len()).clamp(2, SAMPLES);
    let part = |k: usize, count: usize| k as f64 / count as f64;
    let between = ends.windows(2).flat_map(|ends| (0..count).map(|k| ends[0] + (ends[1] - ends[0]) * part(k, count)));
    let mut places: Vec<f64> = between.chain((0..=SAMPLES).map(|k| length * part(k, SAMPLES))).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    let samples: Vec<f64> = places.iter().map(|&at| distance(at)).collect();
    let end = places.len() - 1;
    let mut all = Vec::new();
    let mut k = 0;
    while k <= end {
        // A level stretch counts once, by its middle.
        let mut last = k;
        while last < end && samples[last + 1] == samples[k] {
            last += 1;
        }
        let before = (k > 0).then(|| samples[k - 1]);
        let behind = (last < end).then(|| samples[last + 1]);
        for is_least in [true, false] {
            let sign = if is_least { 1.0 } else { -1.0 };
            let beyond = |other: Option<f64>| other.is_none_or(|other| sign * other > sign * samples[k]);
            if !(beyond(before) && beyond(behind)) {
                continue;
            }
            let (mut best, mut least) = (0.5 * (places[k] + places[last]), sign * samples[k]);
            if k == last {
                let (from, to) = (places[k.saturating_sub(1)], places[(k + 1).min(end)]);
                let mut step = 0.5 * (to - from);
                while step > 1e-13 * length && step > 0.0 {
                    let tried = [best - step, best + step].map(|at| at.clamp(from, to));
                    match tried.map(|at| (sign * distance(at), at)).into_iter().find(|(other, _)| *other < least) {
                        Some(better) => (least, best) = better,
                        None => step *= 0.5,
                    }
                }
            }
            all.push(Extreme { at: best, distance: sign * least, is_least });
        }
        k = last + 1;
    }
    all.sort_by(|a, b| a.at.total_cmp(&b.at));
    all
}
