//! Regions of agents with footprints: the unions of the regions of their discs.
//!
//! The discs of an agent share one motion, so the regions of all pairs of discs lie in the same plane of time and
//! length, once lengths are converted to those of the reference point. A region of two agents is a connected union of
//! them.

use super::record::{Piece, Region, Slice, Work, slice};
use crate::bodies::Disced;
use crate::fleet::Format;
use pcr_core::RegionRef;
use std::collections::BTreeMap;

/// Times at which two regions of discs are looked at for a common point, beside the first. Those of discs side by side overlap
/// over most of their extent.
const LOOKS: u32 = 64;

/// Times and lengths that are one but for rounding \[s\], \[m\]: where one outline gives way to another.
const NEAR: f64 = 1e-9;

/// A region of two discs in some number format.
trait Computed {
    /// The lengths inside, along the path of the disc; outside of the region's time those at its begin or end.
    fn slice(&self, time: f64) -> Vec<[f64; 2]>;
    fn pieces(&self) -> Vec<Piece>;
}

/// A region in a row of a table.
struct InRow<'a, S: Format> {
    work: &'a Work<'a, S>,
    region: RegionRef<'a, S>,
    /// Places of the discs in the row.
    places: [usize; 2],
}

impl<S: Format> Computed for InRow<'_, S> {
    fn slice(&self, time: f64) -> Vec<[f64; 2]> {
        let within = self.region.time();
        slice(&self.region, S::from_f64(time).clamp(within.lo, within.hi)).l
    }

    fn pieces(&self) -> Vec<Piece> {
        self.work.pieces(self.places[0], self.places[1], &self.region)
    }
}

/// A region of two discs.
struct Part<'a> {
    region: Box<dyn Computed + 'a>,
    /// The discs.
    discs: [&'a Disced; 2],
    /// Whether it goes on before and after the motion of the other agent.
    open: [bool; 2],
    time: [f64; 2],
    length: [f64; 2],
}

impl Part<'_> {
    fn slice(&self, time: f64) -> Vec<[f64; 2]> {
        if time < self.time[0] - NEAR || time > self.time[1] + NEAR {
            return Vec::new();
        }
        self.region.slice(time).into_iter().map(|lengths| self.discs[0].on_agent(lengths)).collect()
    }

    /// Whether a point of both was found.
    fn meets(&self, other: &Self) -> bool {
        let [lo, hi] = common(self.time, other.time);
        let [from, to] = common(self.length, other.length);
        // Parts whose gap may be due to rounding belong together.
        let (hi, to) = (if hi < lo { hi + NEAR } else { hi }, to + NEAR);
        let overlap = |time: f64| {
            let own = self.slice(time);
            other.slice(time).iter().any(|b| own.iter().any(|a| a[0] <= b[1] + NEAR && b[0] <= a[1] + NEAR))
        };
        lo <= hi && from <= to && (0..=LOOKS).any(|k| overlap(lo + (hi - lo) * f64::from(k) / f64::from(LOOKS)))
    }
}

fn common(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].max(b[0]), a[1].min(b[1])]
}

fn hull(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// The regions of an agent, from the rows of its discs, by the other agent.
pub(super) fn regions<S: Format>(rows: &[(Work<'_, S>, usize)], discs: &[Disced], ids: &[u64]) -> Vec<Region> {
    let mut pairs: Pairs<'_> = BTreeMap::new();
    for (work, place) in rows {
        let Some(own) = discs.get(work.in_fleet(*place)) else { continue };
        for region in work.ecm.row(work.motions, *place).expect("the table of the row") {
            let other = discs.get(work.in_fleet(region.other()));
            let Some(other) = other.filter(|other| other.agent != own.agent) else { continue };
            let (time, length) = (region.time(), region.length());
            let part = Part {
                discs: [own, other],
                open: [region.is_open_at_start() && other.is_at_start(), region.is_open_at_end() && other.is_at_end()],
                time: [time.lo.to_f64(), time.hi.to_f64()],
                length: own.on_agent([length.lo.to_f64(), length.hi.to_f64()]),
                region: Box::new(InRow { work, places: [*place, region.other()], region }),
            };
            pairs.entry([own.agent, other.agent]).or_default().push(part);
        }
    }
    let slices = rows.first().and_then(|(work, _)| work.slices);
    pairs.iter().flat_map(|(&[ego, other], parts)| unions([ids[ego], ids[other]], parts, slices)).collect()
}

/// The regions of the discs, by the two agents.
type Pairs<'a> = BTreeMap<[usize; 2], Vec<Part<'a>>>;

/// The regions of two agents, in order of time, with this number of slices.
fn unions(agents: [u64; 2], parts: &[Part<'_>], slices: Option<usize>) -> Vec<Region> {
    components(parts).iter().map(|parts| union(agents, parts, slices)).collect()
}

/// The parts, those together that are connected.
fn components<'p, 'a>(parts: &'p [Part<'a>]) -> Vec<Vec<&'p Part<'a>>> {
    let mut sorted: Vec<&Part<'a>> = parts.iter().collect();
    sorted.sort_by(|a, b| a.time[0].total_cmp(&b.time[0]));
    let mut group: Vec<usize> = (0..sorted.len()).collect();
    fn find(group: &mut [usize], mut part: usize) -> usize {
        while group[part] != part {
            group[part] = group[group[part]];
            part = group[part];
        }
        part
    }
    // Earlier parts that are not over yet.
    let mut lasting: Vec<usize> = Vec::new();
    for (place, part) in sorted.iter().enumerate() {
        lasting.retain(|&other| sorted[other].time[1] + NEAR >= part.time[0]);
        for &other in &lasting {
            let (a, b) = (find(&mut group, place), find(&mut group, other));
            // Parts that are connected already need no test.
            if a != b && part.meets(sorted[other]) {
                group[a.max(b)] = a.min(b);
            }
        }
        lasting.push(place);
    }
    let mut components: BTreeMap<usize, Vec<&Part<'a>>> = BTreeMap::new();
    for (place, part) in sorted.iter().enumerate() {
        components.entry(find(&mut group, place)).or_default().push(part);
    }
    components.into_values().collect()
}

fn union([i, j]: [u64; 2], parts: &[&Part<'_>], slices: Option<usize>) -> Region {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let t = parts.iter().fold(none, |range, part| hull(range, part.time));
    let l = parts.iter().fold(none, |range, part| hull(range, part.length));
    let slices = slices.map(|slices| {
        let times = (1..=slices).map(|k| t[0] + (t[1] - t[0]) * (k as f64 / (slices + 1) as f64));
        times.map(|t| Slice { t, l: merged(parts.iter().flat_map(|part| part.slice(t)).collect()) }).collect()
    });
    Region {
        i,
        j,
        t,
        l,
        open_start: parts.iter().any(|part| part.open[0]),
        open_end: parts.iter().any(|part| part.open[1]),
        pieces: pieces(parts),
        slices,
    }
}

/// The union of some intervals.
fn merged(mut intervals: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    intervals.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut merged: Vec<[f64; 2]> = Vec::new();
    for next in intervals {
        match merged.last_mut() {
            Some(last) if next[0] <= last[1] + NEAR => last[1] = last[1].max(next[1]),
            _ => merged.push(next),
        }
    }
    merged
}

/// One for each pair of segments of the agents; the crossings of their discs are none of theirs.
fn pieces(parts: &[&Part<'_>]) -> Vec<Piece> {
    let mut pieces: BTreeMap<[Option<usize>; 2], Piece> = BTreeMap::new();
    for part in parts {
        let [own, other] = part.discs;
        for piece in part.region.pieces() {
            let segment =
                |disc: &Disced, number: Option<usize>| disc.segment(number?.checked_sub(1)?).map(|segment| segment + 1);
            let segments = [segment(own, piece.i_segment), segment(other, piece.j_segment)];
            let piece = Piece {
                i_segment: segments[0],
                j_segment: segments[1],
                i_length: own.on_agent(piece.i_length),
                j_length: other.on_agent(piece.j_length),
                ..piece
            };
            let there = pieces.entry(segments).or_insert_with(|| piece.clone());
            there.i_length = hull(there.i_length, piece.i_length);
            there.j_length = hull(there.j_length, piece.j_length);
        }
    }
    pieces.into_values().collect()
}
