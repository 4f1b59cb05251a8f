//! Regions of agents: those of the table, where both agents are one body; the unions of the regions of their bodies, where either is
//! several.
//!
//! The bodies of an agent share one motion, so the regions of all pairs of bodies lie in the same plane of time and
//! length, once lengths are converted to those of the reference point. A region of two agents is a connected union of
//! them.

use super::entries::{CrossSectionEntry, PieceEntry, RegionBuilder, RegionEntry, slice};
use crate::bodies::Body;
use crate::fleet::HostScalar;
use pcr_core::RegionRef;
use std::collections::BTreeMap;

/// Times at which two regions of bodies are looked at for a common point, at least, as long as none is found. Those of bodies side by side
/// overlap over most of their extent.
const LOOKS: f64 = 64.0;

/// Times and lengths that are one but for rounding \[s\], \[m\]: where one outline gives way to another.
const NEAR: f64 = 1e-9;

/// A region of two bodies in some number format.
trait ErasedRegion {
    /// The lengths inside, along the path of the body; outside of the region's time those at its begin or end.
    fn slice(&self, time: f64) -> Vec<[f64; 2]>;
    fn pieces(&self) -> Vec<PieceEntry>;
}

/// A region in a row of a table.
struct RowRegion<'a, S: HostScalar> {
    work: &'a RegionBuilder<'a, S>,
    region: RegionRef<'a, S>,
    /// Places of the bodies in the row.
    places: [usize; 2],
}

impl<S: HostScalar> ErasedRegion for RowRegion<'_, S> {
    fn slice(&self, time: f64) -> Vec<[f64; 2]> {
        let within = self.region.time();
        slice(&self.region, S::from_f64(time).clamp(within.lo, within.hi)).l
    }

    fn pieces(&self) -> Vec<PieceEntry> {
        self.work.pieces(self.places[0], self.places[1], &self.region)
    }
}

/// A region of two bodies.
struct BodyRegion<'a> {
    region: Box<dyn ErasedRegion + 'a>,
    /// The bodies.
    bodies: [&'a Body; 2],
    /// Whether it goes on before and after the motion of the other agent.
    open: [bool; 2],
    time: [f64; 2],
    length: [f64; 2],
}

impl<'a> BodyRegion<'a> {
    fn of<S: HostScalar>(
        work: &'a RegionBuilder<'a, S>,
        places: [usize; 2],
        [own, other]: [&'a Body; 2],
        region: RegionRef<'a, S>,
    ) -> Self {
        let (time, length) = (region.time(), region.length());
        Self {
            bodies: [own, other],
            open: [region.is_open_at_start() && other.is_at_start(), region.is_open_at_end() && other.is_at_end()],
            time: [time.lo.to_f64(), time.hi.to_f64()],
            length: own.on_agent([length.lo.to_f64(), length.hi.to_f64()]),
            region: Box::new(RowRegion { work, places, region }),
        }
    }

    fn slice(&self, time: f64) -> Vec<[f64; 2]> {
        if time < self.time[0] - NEAR || time > self.time[1] + NEAR {
            return Vec::new();
        }
        self.region.slice(time).into_iter().map(|lengths| self.bodies[0].on_agent(lengths)).collect()
    }

    /// The times at which both may have a common point; `None` if there are none. Parts whose gap may be due to rounding belong
    /// together.
    fn common_time(&self, other: &Self) -> Option<[f64; 2]> {
        let [lo, hi] = common(self.time, other.time);
        let [from, to] = common(self.length, other.length);
        let hi = if hi < lo { hi + NEAR } else { hi };
        (lo <= hi && from <= to + NEAR).then_some([lo, hi])
    }
}

fn common(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].max(b[0]), a[1].min(b[1])]
}

fn hull(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// The regions of an agent, from the rows of its bodies, by the other agent.
pub(super) fn regions<S: HostScalar>(
    rows: &[(RegionBuilder<'_, S>, usize)],
    bodies: &[Body],
    ids: &[u64],
) -> Vec<RegionEntry> {
    let (mut all, mut pairs): (Vec<RegionEntry>, BodyRegionsByPair<'_>) = (Vec::new(), BTreeMap::new());
    for (work, place) in rows {
        let Some(own) = bodies.get(work.in_fleet(*place)) else { continue };
        for (there, regions) in work.pairs(*place) {
            let other = bodies.get(work.in_fleet(there));
            let Some(other) = other.filter(|other| other.agent != own.agent) else { continue };
            let (places, agents) = ([*place, there], [own.agent, other.agent]);
            if own.is_whole() && other.is_whole() {
                all.extend(work.pair(places, agents.map(|agent| ids[agent]), &regions));
            } else {
                let parts = regions.into_iter().map(|region| BodyRegion::of(work, places, [own, other], region));
                pairs.entry(agents).or_default().extend(parts);
            }
        }
    }
    let slices = rows.first().and_then(|(work, _)| work.slices);
    all.extend(pairs.iter().flat_map(|(&agents, parts)| unions(agents.map(|agent| ids[agent]), parts, slices)));
    all
}

/// The regions of the bodies, by the two agents.
type BodyRegionsByPair<'a> = BTreeMap<[usize; 2], Vec<BodyRegion<'a>>>;

/// The regions of two agents, in order of time, with this number of slices.
fn unions(agents: [u64; 2], parts: &[BodyRegion<'_>], slices: Option<usize>) -> Vec<RegionEntry> {
    components(parts).iter().map(|parts| union(agents, parts, slices)).collect()
}

/// The parts, those together that are connected.
fn components<'p, 'a>(parts: &'p [BodyRegion<'a>]) -> Vec<Vec<&'p BodyRegion<'a>>> {
    let mut sorted: Vec<&BodyRegion<'a>> = parts.iter().collect();
    sorted.sort_by(|a, b| a.time[0].total_cmp(&b.time[0]));
    let mut sweep = TimeSweep { group: (0..sorted.len()).collect(), parts: &sorted };
    let all = sorted.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |all, part| hull(all, part.time));
    sweep.between(all, &(0..sorted.len()).collect::<Vec<_>>());
    sweep.at_ends();
    let mut components: BTreeMap<usize, Vec<&BodyRegion<'a>>> = BTreeMap::new();
    for (place, part) in sorted.iter().enumerate() {
        components.entry(sweep.root(place)).or_default().push(part);
    }
    components.into_values().collect()
}

/// A sweep over time that joins parts with common points. At each time the lengths of a part are computed once, for all parts that it may
/// meet. Parts that are joined already are not looked at again.
struct TimeSweep<'s, 'p, 'a> {
    parts: &'s [&'p BodyRegion<'a>],
    /// For each part another one of its component with a lower or the same index; only the first of a component has its own.
    group: Vec<usize>,
}

impl TimeSweep<'_, '_, '_> {
    /// The first part of the component.
    fn root(&mut self, mut part: usize) -> usize {
        while self.group[part] != part {
            self.group[part] = self.group[self.group[part]];
            part = self.group[part];
        }
        part
    }

    fn join(&mut self, a: usize, b: usize) {
        let [a, b] = [a, b].map(|part| self.root(part));
        self.group[a.max(b)] = a.min(b);
    }

    /// Joins those of the parts that overlap at a time.
    fn at(&mut self, time: f64, parts: &[usize]) {
        let slices = |&part: &usize| self.parts[part].slice(time).into_iter().map(move |lengths| (lengths, part));
        let mut slices: Vec<([f64; 2], usize)> = parts.iter().flat_map(slices).collect();
        slices.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        let mut farthest: Option<(f64, usize)> = None;
        for ([lo, hi], part) in slices {
            match farthest {
                Some((end, before)) if lo <= end + NEAR => {
                    self.join(before, part);
                    farthest = Some(if hi > end { (hi, part) } else { (end, before) });
                }
                _ => farthest = Some((hi, part)),
            }
        }
    }

    /// Those of the parts that are not joined with another one that they may meet in this time. A pair that this time is short for has
    /// been looked at often enough; one with hardly any time in common is left to [`TimeSweep::at_ends`].
    fn open(&mut self, [lo, hi]: [f64; 2], parts: &[usize]) -> Vec<usize> {
        let roots: Vec<usize> = parts.iter().map(|&part| self.root(part)).collect();
        let mut is_open = vec![false; parts.len()];
        for (k, &part) in parts.iter().enumerate() {
            for (l, &other) in parts.iter().enumerate().skip(k + 1) {
                if roots[k] != roots[l]
                    && !(is_open[k] && is_open[l])
                    && let Some(time) = self.parts[part].common_time(self.parts[other])
                    && time[0] <= hi
                    && time[1] >= lo
                    && time[1] - time[0] > NEAR
                    && hi - lo > (time[1] - time[0]) / LOOKS
                {
                    (is_open[k], is_open[l]) = (true, true);
                }
            }
        }
        parts.iter().zip(is_open).filter_map(|(&part, open)| open.then_some(part)).collect()
    }

    /// Joins the parts inside of a time, which is halved as long as any two are open.
    fn between(&mut self, [lo, hi]: [f64; 2], parts: &[usize]) {
        let open = self.open([lo, hi], parts);
        if open.is_empty() {
            return;
        }
        let middle = lo + 0.5 * (hi - lo);
        // Of a late time there is none in between.
        if middle <= lo || middle >= hi {
            return;
        }
        self.at(middle, &open);
        self.between([lo, middle], &open);
        self.between([middle, hi], &open);
    }

    /// Joins parts that meet where either begins or ends.
    fn at_ends(&mut self) {
        for place in 0..self.parts.len() {
            for other in 0..place {
                let ends = self.parts[place].common_time(self.parts[other]);
                for time in ends.into_iter().flatten() {
                    if self.root(place) != self.root(other) {
                        self.at(time, &[place, other]);
                    }
                }
            }
        }
    }
}

fn union([i, j]: [u64; 2], parts: &[&BodyRegion<'_>], slices: Option<usize>) -> RegionEntry {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    let t = parts.iter().fold(none, |range, part| hull(range, part.time));
    let l = parts.iter().fold(none, |range, part| hull(range, part.length));
    let slices = slices.map(|slices| {
        let times = (1..=slices).map(|k| t[0] + (t[1] - t[0]) * (k as f64 / (slices + 1) as f64));
        times
            .map(|t| CrossSectionEntry { t, l: merged(parts.iter().flat_map(|part| part.slice(t)).collect()) })
            .collect()
    });
    RegionEntry {
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

/// One for each pair of segments of the agents; the crossings of their bodies are none of theirs.
fn pieces(parts: &[&BodyRegion<'_>]) -> Vec<PieceEntry> {
    let mut pieces: BTreeMap<[Option<usize>; 2], PieceEntry> = BTreeMap::new();
    for part in parts {
        let [own, other] = part.bodies;
        for piece in part.region.pieces() {
            let segment =
                |body: &Body, number: Option<usize>| body.segment(number?.checked_sub(1)?).map(|segment| segment + 1);
            let segments = [segment(own, piece.i_segment), segment(other, piece.j_segment)];
            let piece = PieceEntry {
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
