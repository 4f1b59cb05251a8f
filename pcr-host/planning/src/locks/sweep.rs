//! All that vehicles sweep on the edges and nodes of a layout, and which of them can touch, in one pass over those that come
//! near one another: a grid finds them, and rows are computed on all cores.
//!
//! Two edges that are one line in both directions are a *track*: what is blocked on one is blocked on the other, and it is
//! computed once.

use super::rides::{Lengths, Ride, Rides, reversed};
use super::{Extents, joined};
use crate::bodies::{Bodies, Disced};
use crate::fleet::Fleet;
use crate::memory::{self, Held};
use crate::rows::{Grid, area};
use pcr_core::{Full, Interval, Motion, Piece, overlaps};
use pcr_formats::import::{self, Edge, Id, ImportError, Imported, Layout};
use pcr_formats::scenario::{Agent, PathSegment, Scenario, label};
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;

/// Locks that are held to be put in order: more are told in the order of the tracks.
const HELD: usize = 10_000_000;

/// Pairs of discs that are looked at before what was found is handed on.
const STRETCH: usize = 1 << 16;

/// Pieces of two discs, which have one a pair of segments.
const PIECES: usize = 16;

/// How far a pass is: pairs of discs that were looked at, of so many.
pub type Told<'t> = &'t (dyn Fn(usize, usize) + Sync);

/// Two edges or nodes, by their places in [`Sweep::ids`], the lower first, and lengths of both at which vehicles may touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Edges come before nodes.
    pub places: [usize; 2],
    /// From the start of each \[m\].
    pub lengths: Extents,
}

/// What vehicles sweep on a layout.
pub struct Sweep {
    /// Names of the edges in their order, then of the nodes.
    ids: Vec<Id>,
    /// How many of them are edges.
    edges: usize,
    pub(super) tracks: Vec<Track>,
    /// What lengths on the path of a ride are, and its track.
    rides: Vec<(Lengths, u32)>,
    fleet: Fleet<f64>,
    discs: Vec<Disced>,
    /// Of each disc.
    areas: Vec<[f64; 4]>,
}

/// An edge or a node, or edges that are one.
pub(super) struct Track {
    /// By their places in the names, and whether it leads the other way.
    pub(super) members: Vec<(usize, bool)>,
    /// \[m\]
    pub(super) length: f64,
    levels: [usize; 2],
    discs: Range<usize>,
}

impl Track {
    /// An edge that leads from level to level is on both.
    fn shares_a_level(&self, other: &Self) -> bool {
        self.levels.iter().any(|level| other.levels.contains(level))
    }

    /// Lengths on a member of lengths on the track.
    pub(super) fn on_member(&self, lengths: [f64; 2], turned: bool) -> [f64; 2] {
        if turned { reversed(self.length, lengths) } else { lengths }
    }
}

/// A track before its discs are made.
struct Plan {
    members: Vec<(usize, bool)>,
    length: f64,
    levels: [usize; 2],
    rides: Vec<Ride>,
}

impl Sweep {
    /// The edges of a layout, and its nodes if asked for.
    ///
    /// # Errors
    /// [`ImportError`] for coordinates beyond what can be computed with.
    pub fn new(imported: &Imported, nodes: bool) -> Result<Self, ImportError> {
        let (layout, rides) = (&imported.layout, Rides::new(imported));
        let mut order: Vec<&Edge> = layout.edges.iter().collect();
        order.sort_by(|a, b| a.id.cmp(&b.id));
        let mut ids: Vec<Id> = order.iter().map(|edge| edge.id.clone()).collect();
        let mut plans: Vec<Box<dyn Fn() -> Plan + Sync + '_>> = Vec::new();
        for members in tracks(layout, &order, rides.vehicle().footprint.is_none()) {
            let (edge, rides) = (order[members[0].0], &rides);
            plans.push(Box::new(move || Plan {
                members: members.clone(),
                length: edge.length(),
                levels: edge.ends.map(|node| layout.nodes.get(node).map_or(0, |node| node.level)),
                rides: rides.on(edge),
            }));
        }
        if nodes {
            let mut order: Vec<usize> = (0..layout.nodes.len()).collect();
            order.sort_by(|&a, &b| layout.nodes[a].id.cmp(&layout.nodes[b].id));
            for node in order {
                let (place, rides, level) = (ids.len(), &rides, layout.nodes[node].level);
                ids.push(layout.nodes[node].id.clone());
                let members = vec![(place, false)];
                let plan = move || Plan {
                    members: members.clone(),
                    length: 0.0,
                    levels: [level; 2],
                    rides: vec![rides.at(node)],
                };
                plans.push(Box::new(plan));
            }
        }
        let edges = order.len();
        let mut sweep = Self {
            ids,
            edges,
            tracks: Vec::with_capacity(plans.len()),
            rides: Vec::new(),
            fleet: Fleet::new(&Scenario::default()).map_err(|refused| ImportError::new(refused.to_string()))?,
            discs: Vec::new(),
            areas: Vec::new(),
        };
        for stretch in plans.chunks(STRETCH) {
            let made = stretch.par_iter().map(|plan| {
                let plan = plan();
                let bodies = bodies(&plan, &sweep.ids)?;
                Ok((plan, bodies))
            });
            for (plan, bodies) in made.collect::<Result<Vec<_>, ImportError>>()? {
                sweep.add(plan, bodies);
            }
        }
        Ok(sweep)
    }

    fn add(&mut self, plan: Plan, bodies: Bodies<f64>) {
        let (first, before, track) = (self.rides.len(), self.discs.len(), self.tracks.len() as u32);
        self.rides.extend(plan.rides.into_iter().map(|ride| (ride.lengths, track)));
        self.areas.extend(bodies.fleet.motions().iter().map(area));
        self.fleet.append(bodies.fleet);
        self.discs.extend(bodies.discs.into_iter().map(|disc| disc.moved(first)));
        let Plan { members, length, levels, .. } = plan;
        self.tracks.push(Track { members, length, levels, discs: before..self.discs.len() });
    }

    /// Names of the edges in their order, then of the nodes in theirs.
    pub fn ids(&self) -> &[Id] {
        &self.ids
    }

    /// Whether a place in [`Sweep::ids`] is that of an edge.
    pub fn is_edge(&self, place: usize) -> bool {
        place < self.edges
    }

    /// What `make` makes of all that was found, on all cores, to `take`: pairs of edges, then edges with nodes, then pairs
    /// of nodes, in the order of their names and lengths; or, where that is more than ten million, in that of the tracks.
    ///
    /// # Errors
    /// What `take` refuses, and [`ImportError`] for a pair that no memory holds.
    pub fn each<T: Send, E: From<ImportError>>(
        &self,
        told: Told<'_>,
        make: impl Fn(&[Found]) -> T + Sync,
        mut take: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        let pass = Pass::new(self);
        let most = |track: &Track| pass.counts[track.discs.clone()].iter().map(|&count| count as usize).sum::<usize>();
        let expected: usize = self.tracks.iter().map(|track| most(track) * track.members.len().pow(2) / 2).sum();
        let find = |track: usize| Ok(self.found(track, &pass.row(track, false)?));
        if expected > HELD {
            return pass.each(told, |track| find(track).map(|found| make(&found)), take);
        }
        let (mut all, mut held) = (Vec::new(), Held::default());
        pass.each(told, find, |found| {
            held.extend(&mut all, found, 0, "locks").map_err(|large| E::from(ImportError::new(large.to_string())))
        })?;
        all.par_sort_unstable_by(|a: &Found, b: &Found| {
            let nodes = |found: &Found| found.places.map(|place| !self.is_edge(place));
            let lengths = |k: usize| a.lengths[k][0].total_cmp(&b.lengths[k][0]);
            (nodes(a), a.places).cmp(&(nodes(b), b.places)).then(lengths(0)).then(lengths(1))
        });
        for stretch in all.chunks(STRETCH) {
            let parts = stretch.par_chunks(STRETCH / 16).map(&make);
            parts.collect::<Vec<_>>().into_iter().try_for_each(&mut take)?;
        }
        Ok(())
    }

    /// What a row of tracks means for their members.
    fn found(&self, track: usize, row: &[(usize, Extents)]) -> Vec<Found> {
        let own = &self.tracks[track];
        let mut all = Vec::new();
        for &(other, [lengths, other_lengths]) in row {
            let their = &self.tracks[other];
            for (k, &(a, turned)) in own.members.iter().enumerate() {
                // Of one track each pair of members once.
                for &(b, other_turned) in their.members.iter().skip(if other == track { k + 1 } else { 0 }) {
                    let (own, their) = (own.on_member(lengths, turned), their.on_member(other_lengths, other_turned));
                    all.push(if a < b {
                        Found { places: [a, b], lengths: [own, their] }
                    } else {
                        Found { places: [b, a], lengths: [their, own] }
                    });
                }
            }
        }
        all.sort_by_key(|found| found.places);
        all
    }
}

/// The discs of a track.
fn bodies(plan: &Plan, ids: &[Id]) -> Result<Bodies<f64>, ImportError> {
    let name = plan.members.first().and_then(|&(place, _)| ids.get(place)).map(|id| label(&id.to_string()));
    let agents = plan.rides.iter().enumerate().map(|(k, ride)| Agent {
        id: k as u64,
        label: name.clone().unwrap_or_default(),
        ..ride.agent.clone()
    });
    let scenario = import::checked(&Scenario::new("", agents.collect()))?;
    Bodies::new(&scenario).map_err(|refused| ImportError::new(refused.to_string()))
}

/// The edges in their order, those together that are one line between the same nodes if turned over, as a disc is.
fn tracks(layout: &Layout, order: &[&Edge], disc: bool) -> Vec<Vec<(usize, bool)>> {
    let straight = |edge: &Edge| {
        let [from, to] = edge.ends.map(|node| layout.nodes.get(node).map(|node| node.at));
        let ([x, y], [to_x, to_y]) = (from?, to?);
        let [line] = &edge.curve[..] else { return None };
        let length = (to_x - x).hypot(to_y - y);
        let same = line.at == [x, y] && line.shape == PathSegment::Line { length } && edge.deviation == 0.0;
        (same && line.heading == (to_y - y).atan2(to_x - x)).then_some(edge.ends)
    };
    let mut tracks: Vec<Vec<(usize, bool)>> = Vec::new();
    let mut known: HashMap<[usize; 2], (usize, [usize; 2])> = HashMap::new();
    for (place, edge) in order.iter().enumerate() {
        let Some(ends) = straight(edge).filter(|_| disc) else {
            tracks.push(vec![(place, false)]);
            continue;
        };
        let key = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        let &mut (track, first) = known.entry(key).or_insert((tracks.len(), ends));
        match tracks.get_mut(track) {
            Some(members) => members.push((place, ends != first)),
            None => tracks.push(vec![(place, false)]),
        }
    }
    tracks
}

/// A pass over all pairs.
pub(super) struct Pass<'a> {
    sweep: &'a Sweep,
    motions: Vec<Motion<'a, f64>>,
    grid: Grid,
    /// How many discs come near each.
    pub(super) counts: Vec<u32>,
}

impl<'a> Pass<'a> {
    pub(super) fn new(sweep: &'a Sweep) -> Self {
        let grid = Grid::new(sweep.areas.clone());
        Self { sweep, motions: sweep.fleet.motions(), counts: grid.counts(), grid }
    }

    /// Rows one after the other, computed on all cores.
    pub(super) fn each<T: Send, E: From<ImportError>>(
        &self,
        told: Told<'_>,
        row: impl Fn(usize) -> Result<T, ImportError> + Sync,
        mut take: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        let work = |track: usize| {
            let discs = self.sweep.tracks[track].discs.clone();
            1 + self.counts[discs].iter().map(|&count| count as usize).sum::<usize>()
        };
        let (all, mut next, mut done) = (self.sweep.tracks.len(), 0, 0);
        let total = (0..all).map(work).sum();
        while next < all {
            let (first, mut held) = (next, 0);
            while next < all && held < STRETCH {
                held += work(next);
                next += 1;
            }
            let rows = (first..next).into_par_iter().map(&row);
            rows.collect::<Result<Vec<T>, ImportError>>()?.into_iter().try_for_each(&mut take)?;
            done += held;
            told(done, total);
        }
        Ok(())
    }

    /// The tracks after one, or with `both` all, that can be touched from it, itself where it has several members, with the
    /// lengths of both: by the other track, then in the order of the lengths.
    pub(super) fn row(&self, track: usize, both: bool) -> Result<Vec<(usize, Extents)>, ImportError> {
        let sweep = self.sweep;
        let own = &sweep.tracks[track];
        let (mut near, mut pairs) = (Vec::new(), Vec::new());
        for disc in own.discs.clone() {
            if both {
                self.grid.around(disc, &mut near)
            } else {
                self.grid.after(disc, &mut near)
            }
            let others = near.iter().map(|&other| (sweep.track_of(other as usize), [disc, other as usize]));
            pairs.extend(others.filter(|&(other, _)| other != track && own.shares_a_level(&sweep.tracks[other])));
        }
        if own.members.len() > 1 {
            pairs.extend(own.discs.clone().map(|disc| (track, [disc, disc])));
        }
        pairs.sort_unstable();
        sweep.grouped(&pairs, |disc| self.motions.get(disc).copied())
    }
}

/// Changes, one edge at a time: the names are then in no order.
impl Sweep {
    /// Adds an edge; returns its track.
    pub(super) fn insert(&mut self, layout: &Layout, rides: &Rides<'_>, edge: &Edge) -> Result<usize, ImportError> {
        let (place, track) = (self.ids.len(), self.tracks.len());
        let plan = Plan {
            members: vec![(place, false)],
            length: edge.length(),
            levels: edge.ends.map(|node| layout.nodes.get(node).map_or(0, |node| node.level)),
            rides: rides.on(edge),
        };
        self.ids.push(edge.id.clone());
        match bodies(&plan, &self.ids) {
            Ok(bodies) => {
                self.edges = self.ids.len();
                self.add(plan, bodies);
                Ok(track)
            }
            Err(refused) => {
                self.ids.pop();
                Err(refused)
            }
        }
    }

    /// Takes an edge out of its track, which is nowhere when it was the last one.
    pub(super) fn take_out(&mut self, track: usize, id: &Id) {
        let Some(own) = self.tracks.get_mut(track) else { return };
        own.members.retain(|&(place, _)| self.ids.get(place).is_some_and(|there| there != id));
        if own.members.is_empty() {
            let [nowhere, never] = [f64::INFINITY, f64::NEG_INFINITY];
            self.areas[own.discs.clone()].fill([nowhere, nowhere, never, never]);
        }
    }

    /// The members of a track by their names, and whether they lead the other way.
    pub(super) fn members(&self, track: usize) -> impl Iterator<Item = (&Id, bool)> {
        let members = self.tracks.get(track).into_iter().flat_map(|track| &track.members);
        members.filter_map(|&(place, turned)| Some((self.ids.get(place)?, turned)))
    }

    /// The tracks that can be touched from one, with the lengths of both, and how many pairs of discs that took.
    pub(super) fn row_of(&self, track: usize) -> Result<(Vec<(usize, Extents)>, usize), ImportError> {
        let own = &self.tracks[track];
        let meet = |a: &[f64; 4], b: &[f64; 4]| a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3];
        let mut pairs = Vec::new();
        for disc in own.discs.clone() {
            let near = self.areas.iter().enumerate().filter(|(_, other)| meet(&self.areas[disc], other));
            let near = near.map(|(other, _)| (self.track_of(other), [disc, other]));
            pairs.extend(near.filter(|&(other, _)| other != track && own.shares_a_level(&self.tracks[other])));
        }
        if own.members.len() > 1 {
            pairs.extend(own.discs.clone().map(|disc| (track, [disc, disc])));
        }
        pairs.sort_unstable();
        Ok((self.grouped(&pairs, |disc| self.fleet.motion(disc))?, pairs.len()))
    }

    /// The extents of pairs of discs, by the other track.
    fn grouped<'m>(
        &self,
        pairs: &[(usize, [usize; 2])],
        motion: impl Fn(usize) -> Option<Motion<'m, f64>> + Copy,
    ) -> Result<Vec<(usize, Extents)>, ImportError> {
        let mut row = Vec::new();
        for group in pairs.chunk_by(|a, b| a.0 == b.0) {
            let Some(&(other, _)) = group.first() else { continue };
            let extents = self.extents(group.iter().map(|&(_, discs)| discs), motion)?;
            row.extend(extents.into_iter().map(|extents| (other, extents)));
        }
        Ok(row)
    }

    fn track_of(&self, disc: usize) -> usize {
        self.discs.get(disc).and_then(|disc| self.rides.get(disc.agent)).map_or(usize::MAX, |ride| ride.1 as usize)
    }

    /// The extents of the regions of some pairs of discs of two tracks, of which those that overlap are one.
    fn extents<'m>(
        &self,
        pairs: impl Iterator<Item = [usize; 2]>,
        motion: impl Fn(usize) -> Option<Motion<'m, f64>>,
    ) -> Result<Vec<Extents>, ImportError> {
        let (mut extents, mut pieces) = (Vec::new(), vec![Piece::EMPTY; PIECES]);
        for [own, other] in pairs {
            let swap = other < own;
            let [first, second] = if swap { [other, own] } else { [own, other] };
            let (Some(a), Some(b)) = (motion(first), motion(second)) else { continue };
            let on = |disc: usize, range: Interval<f64>| {
                let disc = &self.discs[disc];
                self.rides[disc.agent].0.on_edge(disc.on_agent([range.lo, range.hi]))
            };
            while let Err(full) = overlaps(&a, &b, &mut pieces, |region| {
                let lengths = [on(first, region.length()), on(second, region.other_length())];
                extents.push(if swap { [lengths[1], lengths[0]] } else { lengths });
            }) {
                let bytes = 2 * (pieces.len() * size_of::<Piece<f64>>()) as u64;
                memory::ask(bytes, || "a pair of edges".into()).map_err(|large| ImportError::new(large.to_string()))?;
                if full != Full::Pieces {
                    let names = [own, other].map(|disc| self.name(disc));
                    let problem = "more than 32767 pairs of segments within reach of one another";
                    return Err(ImportError::new(format!("{} and {}: {problem}", names[0], names[1])));
                }
                pieces.resize(2 * pieces.len(), Piece::EMPTY);
            }
        }
        Ok(if extents.len() > 1 { joined(extents) } else { extents })
    }

    /// What a disc belongs to, for messages.
    fn name(&self, disc: usize) -> String {
        let member = self.tracks.get(self.track_of(disc)).and_then(|track| track.members.first());
        member.and_then(|&(place, _)| self.ids.get(place)).map_or_else(String::new, Id::to_string)
    }
}
