//! Regions of the table as records: ids of agents, indices of segments, lengths, and crossings with their descriptors.

use crate::fleet::{Fleet, HostEcm, HostScalar};
use pcr_core::{Crossing, Curve, Motion, RegionRef, TurnSide, crossings};
use serde::Serialize;
use std::cmp::Ordering;

/// A collision region: what agent `i` has to keep out of because of agent `j`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RegionEntry {
    /// Number of the ego.
    pub i: u64,
    /// Number of the other agent.
    pub j: u64,
    /// Time range \[s\].
    pub t: [f64; 2],
    /// Length range along the path of `i` \[m\].
    pub l: [f64; 2],
    /// Whether it reaches back to before `j` sets off, as a strip.
    pub open_start: bool,
    /// Whether it goes on after the arrival of `j`, as a strip.
    pub open_end: bool,
    /// By the segments of `i`, then of `j`.
    pub pieces: Vec<PieceEntry>,
    /// Evenly spaced inner times, if asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub slices: Option<Vec<CrossSectionEntry>>,
}

/// The part of a region that belongs to one segment of each path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PieceEntry {
    /// SS, SA, AS or AA; the first letter is the ego's.
    #[serde(rename = "type")]
    pub piece_type: String,
    /// Segment of `i` in the scenario, counted from 1; none where `i` stands all the time.
    pub i_segment: Option<usize>,
    /// Segment of `j`, likewise.
    pub j_segment: Option<usize>,
    /// Length range along the path of `i` \[m\].
    pub i_length: [f64; 2],
    /// Length range along the path of `j` \[m\].
    pub j_length: [f64; 2],
    /// The crossings of the two paths in it, in the order of `i`: none where the paths only come near, mostly one.
    pub crossings: Vec<CrossingDescriptor>,
}

/// The paper's descriptor of the region at a crossing (Table VII).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CrossingDescriptor {
    /// When `j` passes \[s\].
    #[serde(rename = "T")]
    pub time: f64,
    /// Length along the path of `i` \[m\].
    #[serde(rename = "L")]
    pub length: f64,
    /// Sum of the radii \[m\].
    pub r_hat: f64,
    /// Speed of `j` as it passes \[m/s\].
    pub v: f64,
    /// Heading of `j` less heading of `i` \[rad\], both accumulated along their paths (in `f32` from start headings
    /// without whole turns).
    pub theta: f64,
    /// Radius of the arc of `i` \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma_i: Option<f64>,
    /// Its turn: +1 counter-clockwise, -1 clockwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dir_i: Option<i8>,
    /// Radius of the arc of `j` \[m\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma_j: Option<f64>,
    /// Its turn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dir_j: Option<i8>,
}

/// The lengths that a region covers at one time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CrossSectionEntry {
    /// \[s\]
    pub t: f64,
    /// Disjoint intervals along the path of `i` \[m\], in increasing order.
    pub l: Vec<[f64; 2]>,
}

// Comparisons are methods and not closures, so that sorting is compiled once and not for each number format.

impl CrossingDescriptor {
    fn by_length(&self, other: &Self) -> Ordering {
        self.length.total_cmp(&other.length)
    }
}

impl PieceEntry {
    /// By the segments, then by where it begins on both paths.
    fn by_segments(&self, other: &Self) -> Ordering {
        let starts = |[a, b]: [[f64; 2]; 2]| a[0].total_cmp(&b[0]);
        let segments = (self.i_segment, self.j_segment).cmp(&(other.i_segment, other.j_segment));
        segments.then(starts([self.i_length, other.i_length])).then(starts([self.j_length, other.j_length]))
    }
}

impl RegionEntry {
    /// By the other agent, then by where it begins.
    pub(super) fn by_other(&self, other: &Self) -> Ordering {
        let starts = self.t[0].total_cmp(&other.t[0]).then(self.l[0].total_cmp(&other.l[0]));
        self.j.cmp(&other.j).then(starts)
    }

    /// Memory that it takes outside of the struct \[bytes\].
    pub(super) fn bytes(&self) -> u64 {
        /// Smallest size of an allocation; also enough for the two letters of a type.
        const SMALLEST: usize = 32;
        let crossings: usize = self.pieces.iter().map(|piece| piece.crossings.len()).sum();
        let covered: usize = self.slices.iter().flatten().map(|slice| slice.l.len()).sum();
        let slices = self.slices.as_ref().map_or(0, Vec::len);
        let pieces =
            self.pieces.len() * (size_of::<PieceEntry>() + 2 * SMALLEST) + crossings * size_of::<CrossingDescriptor>();
        (SMALLEST + pieces + slices * (size_of::<CrossSectionEntry>() + SMALLEST) + covered * 16) as u64
    }
}

/// A row of a table, and what its regions are described with.
pub(super) struct RegionBuilder<'a, S: HostScalar> {
    pub(super) fleet: &'a Fleet<S>,
    /// Places in the fleet of the agents of the row, which the table numbers from 0.
    pub(super) agents: &'a [u32],
    pub(super) motions: &'a [Motion<'a, S>],
    pub(super) ecm: &'a HostEcm<S>,
    pub(super) slices: Option<usize>,
}

impl<S: HostScalar> RegionBuilder<'_, S> {
    /// The regions of one ego, by the other.
    pub(super) fn pairs(&self, ego: usize) -> Vec<(usize, Vec<RegionRef<'_, S>>)> {
        let mut pairs: Vec<(usize, Vec<RegionRef<'_, S>>)> = Vec::new();
        for region in self.ecm.row(self.motions, ego).expect("the table of the row") {
            match pairs.last_mut() {
                Some((other, pair)) if *other == region.other() => pair.push(region),
                _ => pairs.push((region.other(), vec![region])),
            }
        }
        pairs
    }

    /// The regions of one ordered pair of agents with these numbers. Each crossing of the paths of two discs is in the piece that holds it.
    pub(super) fn pair(
        &self,
        [ego, other]: [usize; 2],
        numbers: [u64; 2],
        pair: &[RegionRef<'_, S>],
    ) -> Vec<RegionEntry> {
        let mut records: Vec<RegionEntry> =
            pair.iter().map(|region| self.region([ego, other], numbers, region)).collect();
        let motions = [ego, other].map(|place| self.motions.get(place));
        let [Some(own), Some(their)] = motions.map(|motion| motion.filter(|it| it.outline().corners().is_empty()))
        else {
            return records;
        };
        let held = by_segments(&records);
        for crossing in crossings(own, their) {
            let place = self.place_of(ego, other, &crossing, pair, &records, &held);
            let piece = place.and_then(|[region, piece]| records.get_mut(region)?.pieces.get_mut(piece));
            if let Some(piece) = piece {
                piece.crossings.push(CrossingDescriptor::of(&crossing));
            }
        }
        for piece in records.iter_mut().flat_map(|record| &mut record.pieces) {
            piece.crossings.sort_by(CrossingDescriptor::by_length);
        }
        records
    }

    /// Region and piece that a crossing lies in.
    fn place_of(
        &self,
        ego: usize,
        other: usize,
        crossing: &Crossing<S>,
        pair: &[RegionRef<'_, S>],
        records: &[RegionEntry],
        held: &[PieceKey],
    ) -> Option<[usize; 2]> {
        let (length, other_length) = (crossing.length.to_f64(), crossing.other_length.to_f64());
        let segments = self.segments(ego, other, crossing.segments);
        let within = |[lo, hi]: [f64; 2], length: f64| lo <= length && length <= hi;
        let holds = |&[region, piece]: &[usize; 2]| {
            let piece = &records[region].pieces[piece];
            within(piece.i_length, length) && within(piece.j_length, other_length)
        };
        let first = held.partition_point(|(of, _)| *of < segments);
        let places = held[first..].iter().take_while(|(of, _)| *of == segments).map(|(_, place)| *place).filter(holds);
        // Regions may interlock, then the ranges of several hold the crossing, but only one contains it.
        let contains = |k: usize| pair.get(k).is_some_and(|region| region.contains(crossing.time, crossing.length));
        let candidates: Vec<[usize; 2]> = places.collect();
        match candidates[..] {
            [only] => Some(only),
            _ => candidates.iter().find(|&&[k, _]| contains(k)).or(candidates.first()).copied(),
        }
    }

    /// The pieces of a region, without crossings.
    pub(super) fn pieces(&self, ego: usize, other: usize, region: &RegionRef<'_, S>) -> Vec<PieceEntry> {
        let pieces = region.pieces().map(|piece| {
            let [i_segment, j_segment] = self.segments(ego, other, piece.segments);
            PieceEntry {
                piece_type: piece.piece_type().to_string(),
                i_segment,
                j_segment,
                i_length: [piece.length.lo.to_f64(), piece.length.hi.to_f64()],
                j_length: [piece.other_length.lo.to_f64(), piece.other_length.hi.to_f64()],
                crossings: Vec::new(),
            }
        });
        let mut pieces: Vec<PieceEntry> = pieces.collect();
        pieces.sort_by(PieceEntry::by_segments);
        pieces
    }

    fn region(&self, [ego, other]: [usize; 2], [i, j]: [u64; 2], region: &RegionRef<'_, S>) -> RegionEntry {
        let (time, length) = (region.time(), region.length());
        let t = [time.lo.to_f64(), time.hi.to_f64()];
        let slices = self.slices.map(|slices| {
            let times = (1..=slices).map(|k| t[0] + (t[1] - t[0]) * (k as f64 / (slices + 1) as f64));
            times.map(|time| slice(region, S::from_f64(time))).collect()
        });
        RegionEntry {
            i,
            j,
            t,
            l: [length.lo.to_f64(), length.hi.to_f64()],
            open_start: region.is_open_at_start(),
            open_end: region.is_open_at_end(),
            pieces: self.pieces(ego, other, region),
            slices,
        }
    }

    /// Numbers in the scenario of a segment of each path.
    fn segments(&self, ego: usize, other: usize, [i, j]: [usize; 2]) -> [Option<usize>; 2] {
        let source = |agent, segment| self.fleet.source(self.in_fleet(agent), segment).map(|index| index + 1);
        [source(ego, i), source(other, j)]
    }

    /// Place in the fleet of an agent of the row.
    pub(super) fn in_fleet(&self, agent: usize) -> usize {
        self.agents[agent] as usize
    }
}

/// The segments of a piece, and the place of its region and its own place there.
type PieceKey = ([Option<usize>; 2], [usize; 2]);

/// All pieces by their segments: paths may cross ten thousand times, and none of these crossings looks at all pieces.
fn by_segments(records: &[RegionEntry]) -> Vec<PieceKey> {
    let pieces = records.iter().enumerate().flat_map(|(region, record)| {
        let pieces = record.pieces.iter().enumerate();
        pieces.map(move |(piece, it)| ([it.i_segment, it.j_segment], [region, piece]))
    });
    let mut held: Vec<PieceKey> = pieces.collect();
    // Stable: those of the same segments stay in their order.
    held.sort_by_key(|(segments, _)| *segments);
    held
}

pub(super) fn slice<S: HostScalar>(region: &RegionRef<'_, S>, time: S) -> CrossSectionEntry {
    let intervals = region.slice_at(time).map(|interval| [interval.lo.to_f64(), interval.hi.to_f64()]);
    CrossSectionEntry { t: time.to_f64(), l: intervals.collect() }
}

impl CrossingDescriptor {
    fn of<S: HostScalar>(crossing: &Crossing<S>) -> Self {
        let arc = |curve: Curve<S>| match curve {
            // Nothing crosses a turn in place.
            Curve::Line | Curve::Pivot { .. } => (None, None),
            Curve::Arc { radius, turn: TurnSide::Left } => (Some(radius.to_f64()), Some(1)),
            Curve::Arc { radius, turn: TurnSide::Right } => (Some(radius.to_f64()), Some(-1)),
        };
        let (sigma_i, dir_i) = arc(crossing.ego_curve);
        let (sigma_j, dir_j) = arc(crossing.other_curve);
        Self {
            time: crossing.time.to_f64(),
            length: crossing.length.to_f64(),
            r_hat: crossing.combined_radius.to_f64(),
            v: crossing.speed.to_f64(),
            theta: S::radians(crossing.theta),
            sigma_i,
            dir_i,
            sigma_j,
            dir_j,
        }
    }
}
