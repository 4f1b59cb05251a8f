//! Finds all pairs of swept areas on a layout that can touch, in one pass: a grid finds the areas that are near one
//! another, and rows are computed on all cores.

use super::swept_areas::{STRETCH, SharedCurve, SweptLayout};
use super::{LengthRanges, joined};
use crate::agent_regions::BoxGrid;
use crate::memory_budget::{self, MemoryBudget};
use crate::parallel;
use pcr_core::{CapacityError, Interval, Motion, Piece, overlaps};
use pcr_formats::import::{ElementId, ImportError};
use rayon::prelude::*;

/// Largest number of locks that are kept to be sorted; more are passed on in the order of the tracks.
const HELD: usize = 10_000_000;

/// Two edges or nodes, by their indices in [`SweptLayout::ids`], the lower one first, and the lengths of both at which vehicles may
/// touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchingAreas {
    /// Edges come before nodes.
    pub places: [usize; 2],
    /// Lengths from the start of each \[m\].
    pub lengths: LengthRanges,
}

/// Number of pieces of two bodies for which there is room at first; it grows.
pub(super) const PIECES: usize = 16;

/// Reports progress: examined pairs of bodies, and all pairs.
pub type SyncProgressFn<'t> = &'t (dyn Fn(usize, usize) + Sync);

/// A pass over all pairs.
pub(super) struct AreaPairSearch<'a> {
    sweep: &'a SweptLayout,
    motions: Vec<Motion<'a, f64>>,
    grid: BoxGrid,
    /// For each body the number of bodies near it.
    pub(super) counts: Vec<u32>,
}

impl<'a> AreaPairSearch<'a> {
    pub(super) fn new(sweep: &'a SweptLayout) -> Self {
        let grid = BoxGrid::new(sweep.areas.clone());
        Self { sweep, motions: sweep.fleet.motions(), counts: grid.counts(), grid }
    }

    /// Passes on rows one after the other; they are computed on all cores.
    pub(super) fn each<T: Send, E: From<ImportError>>(
        &self,
        told: SyncProgressFn<'_>,
        row: &(dyn Fn(usize) -> Result<T, ImportError> + Sync),
        take: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        let work = |track: usize| {
            let bodies = self.sweep.tracks[track].bodies.clone();
            1 + self.counts[bodies].iter().map(|&count| count as usize).sum::<usize>()
        };
        in_stretches(self.sweep.tracks.len(), work, told, row, take)
    }

    /// The later tracks (with `both` all tracks) that touch a track, with the lengths of both; a track with several members
    /// also touches itself. Sorted by track, then by lengths.
    pub(super) fn row(&self, track: usize, both: bool) -> Result<Vec<(usize, LengthRanges)>, ImportError> {
        let sweep = self.sweep;
        let own = &sweep.tracks[track];
        let (mut near, mut pairs) = (Vec::new(), Vec::new());
        for body in own.bodies.clone() {
            if both {
                self.grid.around(body, &mut near)
            } else {
                self.grid.after(body, &mut near)
            }
            let others = near.iter().map(|&other| (sweep.track_of(other as usize), [body, other as usize]));
            pairs.extend(others.filter(|&(other, _)| other != track && own.shares_a_level(&sweep.tracks[other])));
        }
        if own.members.len() > 1 {
            pairs.extend(own.bodies.clone().map(|body| (track, [body, body])));
        }
        pairs.sort_unstable();
        sweep.grouped(&pairs, |body| self.motions.get(body).copied())
    }
}

/// Passes on rows in stretches of equal work; they are computed on all cores.
pub(super) fn in_stretches<T: Send, E: From<ImportError>>(
    rows: usize,
    work: impl Fn(usize) -> usize,
    told: SyncProgressFn<'_>,
    row: &(dyn Fn(usize) -> Result<T, ImportError> + Sync),
    mut take: impl FnMut(T) -> Result<(), E>,
) -> Result<(), E> {
    let (mut next, mut done) = (0, 0);
    let total = (0..rows).map(&work).sum();
    while next < rows {
        let (first, mut held) = (next, 0);
        while next < rows && held < STRETCH {
            held += work(next);
            next += 1;
        }
        let made = parallel::map_parallel(first..next, row).into_iter();
        made.collect::<Result<Vec<T>, ImportError>>()?.into_iter().try_for_each(&mut take)?;
        done += held;
        told(done, total);
    }
    Ok(())
}

impl SweptLayout {
    /// Calls `make` for each result, on all cores, and passes its values to `take`: pairs of edges, then edges with nodes, then
    /// pairs of nodes, sorted by ids and lengths; more than ten million results are in the order of the tracks.
    ///
    /// # Errors
    /// What `take` refuses, and [`ImportError`] for a pair that no memory holds.
    pub fn each<T: Send, E: From<ImportError>>(
        &self,
        told: SyncProgressFn<'_>,
        make: &(dyn Fn(&[TouchingAreas]) -> T + Sync),
        mut take: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        let pass = AreaPairSearch::new(self);
        let most =
            |track: &SharedCurve| pass.counts[track.bodies.clone()].iter().map(|&count| count as usize).sum::<usize>();
        let expected: usize = self.tracks.iter().map(|track| most(track) * track.members.len().pow(2) / 2).sum();
        let find = |track: usize| Ok(self.found(track, &pass.row(track, false)?));
        if expected > HELD {
            return pass.each(told, &|track| find(track).map(|found| make(&found)), take);
        }
        let (mut all, mut held) = (Vec::new(), MemoryBudget::default());
        pass.each(told, &find, |found| {
            held.extend(&mut all, found, 0, "locks").map_err(|large| E::from(ImportError::new(large.to_string())))
        })?;
        self.sort(&mut all);
        for stretch in all.chunks(STRETCH) {
            let parts: Vec<&[TouchingAreas]> = stretch.chunks(STRETCH / 16).collect();
            parallel::map_parallel(0..parts.len(), &|part| make(parts[part])).into_iter().try_for_each(&mut take)?;
        }
        Ok(())
    }

    /// Pairs of edges, then edges with nodes, then pairs of nodes, each by places and lengths.
    fn sort(&self, all: &mut [TouchingAreas]) {
        // The number of nodes, and the places as numbers of their own: arrays are compared by a loop.
        let places = |&TouchingAreas { places: [first, second], .. }: &TouchingAreas| {
            (u8::from(!self.is_edge(first)) + u8::from(!self.is_edge(second)), first, second)
        };
        all.par_sort_unstable_by(|a, b| {
            let lengths = |k: usize| a.lengths[k][0].total_cmp(&b.lengths[k][0]);
            places(a).cmp(&places(b)).then_with(|| lengths(0)).then_with(|| lengths(1))
        });
    }

    /// The locks of the members of tracks, from a row of tracks.
    fn found(&self, track: usize, row: &[(usize, LengthRanges)]) -> Vec<TouchingAreas> {
        let own = &self.tracks[track];
        let mut all = Vec::new();
        for &(other, [lengths, other_lengths]) in row {
            let their = &self.tracks[other];
            for (k, &(a, turned)) in own.members.iter().enumerate() {
                // Each pair of members of one track once.
                for &(b, other_turned) in their.members.iter().skip(if other == track { k + 1 } else { 0 }) {
                    let (own, their) = (own.on_member(lengths, turned), their.on_member(other_lengths, other_turned));
                    all.push(if a < b {
                        TouchingAreas { places: [a, b], lengths: [own, their] }
                    } else {
                        TouchingAreas { places: [b, a], lengths: [their, own] }
                    });
                }
            }
        }
        all.sort_by_key(|found| found.places);
        all
    }

    /// The extents of pairs of bodies, by the other track.
    pub(super) fn grouped<'m>(
        &self,
        pairs: &[(usize, [usize; 2])],
        motion: impl Fn(usize) -> Option<Motion<'m, f64>> + Copy,
    ) -> Result<Vec<(usize, LengthRanges)>, ImportError> {
        let (mut row, mut pieces) = (Vec::new(), vec![Piece::EMPTY; PIECES]);
        for group in pairs.chunk_by(|a, b| a.0 == b.0) {
            let Some(&(other, _)) = group.first() else { continue };
            let extents = self.extents(group.iter().map(|&(_, bodies)| bodies), motion, &mut pieces)?;
            row.extend(extents.into_iter().map(|extents| (other, extents)));
        }
        Ok(row)
    }

    pub(super) fn track_of(&self, body: usize) -> usize {
        self.bodies.get(body).and_then(|body| self.rides.get(body.agent)).map_or(usize::MAX, |ride| ride.1 as usize)
    }

    /// The extents of the regions of some pairs of bodies of two tracks, of which those that overlap are one. The room for pieces grows.
    fn extents<'m>(
        &self,
        pairs: impl Iterator<Item = [usize; 2]>,
        motion: impl Fn(usize) -> Option<Motion<'m, f64>>,
        pieces: &mut Vec<Piece<f64>>,
    ) -> Result<Vec<LengthRanges>, ImportError> {
        let mut extents = Vec::new();
        for [own, other] in pairs {
            let swap = other < own;
            let [first, second] = if swap { [other, own] } else { [own, other] };
            let (Some(a), Some(b)) = (motion(first), motion(second)) else { continue };
            let on = |body: usize, range: Interval<f64>| {
                let body = &self.bodies[body];
                self.rides[body.agent].0.on_edge(body.on_agent([range.lo, range.hi]))
            };
            while let Err(full) = overlaps(&a, &b, pieces, |region| {
                let lengths = [on(first, region.length()), on(second, region.other_length())];
                extents.push(if swap { [lengths[1], lengths[0]] } else { lengths });
            }) {
                let bytes = 2 * (pieces.len() * size_of::<Piece<f64>>()) as u64;
                memory_budget::ask(bytes, || "a pair of edges".into())
                    .map_err(|large| ImportError::new(large.to_string()))?;
                if !matches!(full, CapacityError::Pieces { .. }) {
                    let names = [own, other].map(|body| self.name(body));
                    let problem = "more than 32767 pieces (pairs of segments within reach of one another)";
                    return Err(ImportError::new(format!("{} and {}: {problem}", names[0], names[1])));
                }
                pieces.resize(2 * pieces.len(), Piece::EMPTY);
            }
        }
        Ok(if extents.len() > 1 { joined(extents) } else { extents })
    }

    /// Id of the edge or node of a body, for messages.
    fn name(&self, body: usize) -> String {
        let member = self.tracks.get(self.track_of(body)).and_then(|track| track.members.first());
        member.and_then(|&(place, _)| self.ids.get(place)).map_or_else(String::new, ElementId::to_string)
    }
}
