//! All that vehicles sweep on the edges and nodes of a layout.
//!
//! Two edges that are one line in both directions are a *track*: what is blocked on one is blocked on the other, and it is
//! computed once.

use super::Extents;
use super::pass::{Pass, STRETCH, Told};
use super::rides::{Lengths, Ride, Rides, reversed};
use crate::bodies::{Bodies, Disced};
use crate::fleet::Fleet;
use crate::memory::Held;
use crate::rows::area;
use pcr_formats::import::{self, Edge, Id, ImportError, Imported, Layout};
use pcr_formats::scenario::{Agent, PathSegment, Scenario, label};
use rayon::prelude::*;
use std::collections::HashMap;
use std::ops::Range;

/// Locks that are held to be put in order: more are told in the order of the tracks.
const HELD: usize = 10_000_000;

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
    pub(super) ids: Vec<Id>,
    /// How many of them are edges.
    pub(super) edges: usize,
    pub(super) tracks: Vec<Track>,
    /// What lengths on the path of a ride are, and its track.
    pub(super) rides: Vec<(Lengths, u32)>,
    pub(super) fleet: Fleet<f64>,
    pub(super) discs: Vec<Disced>,
    /// Of each disc.
    pub(super) areas: Vec<[f64; 4]>,
}

/// An edge or a node, or edges that are one.
pub(super) struct Track {
    /// By their places in the names, and whether it leads the other way.
    pub(super) members: Vec<(usize, bool)>,
    /// \[m\]
    pub(super) length: f64,
    levels: [usize; 2],
    pub(super) discs: Range<usize>,
}

impl Track {
    /// An edge that leads from level to level is on both.
    pub(super) fn shares_a_level(&self, other: &Self) -> bool {
        self.levels.iter().any(|level| other.levels.contains(level))
    }

    /// Lengths on a member of lengths on the track.
    pub(super) fn on_member(&self, lengths: [f64; 2], turned: bool) -> [f64; 2] {
        if turned { reversed(self.length, lengths) } else { lengths }
    }
}

/// A track before its discs are made.
pub(super) struct Plan {
    pub(super) members: Vec<(usize, bool)>,
    pub(super) length: f64,
    pub(super) levels: [usize; 2],
    pub(super) rides: Vec<Ride>,
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

    pub(super) fn add(&mut self, plan: Plan, bodies: Bodies<f64>) {
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
pub(super) fn bodies(plan: &Plan, ids: &[Id]) -> Result<Bodies<f64>, ImportError> {
    let name = plan.members.first().and_then(|&(place, _)| ids.get(place)).map(|id| label(&id.to_string()));
    let agents = plan.rides.iter().enumerate().map(|(k, ride)| Agent {
        id: k as u64,
        label: name.clone().unwrap_or_default(),
        ..ride.agent.clone()
    });
    let scenario = import::checked(&Scenario::new("", agents.collect()))?;
    Bodies::new(&scenario).map_err(|refused| ImportError::new(refused.to_string()))
}

/// Where an edge begins and ends that is the line between its nodes, and no other.
pub(super) fn straight_ends(layout: &Layout, edge: &Edge) -> Option<[[f64; 2]; 2]> {
    let [from, to] = edge.ends.map(|node| layout.nodes.get(node).map(|node| node.at));
    let ([x, y], [to_x, to_y]) = (from?, to?);
    let [line] = &edge.curve[..] else { return None };
    let length = (to_x - x).hypot(to_y - y);
    let same = line.at == [x, y] && line.shape == PathSegment::Line { length } && edge.deviation == 0.0;
    (same && line.heading == (to_y - y).atan2(to_x - x)).then_some([[x, y], [to_x, to_y]])
}

/// The edges in their order, those together that are one line between the same nodes if turned over, as a disc is.
fn tracks(layout: &Layout, order: &[&Edge], disc: bool) -> Vec<Vec<(usize, bool)>> {
    let mut tracks: Vec<Vec<(usize, bool)>> = Vec::new();
    let mut known: HashMap<[usize; 2], (usize, [usize; 2])> = HashMap::new();
    for (place, edge) in order.iter().enumerate() {
        if !disc || straight_ends(layout, edge).is_none() {
            tracks.push(vec![(place, false)]);
            continue;
        }
        let ends = edge.ends;
        let key = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        let &mut (track, first) = known.entry(key).or_insert((tracks.len(), ends));
        match tracks.get_mut(track) {
            Some(members) => members.push((place, ends != first)),
            None => tracks.push(vec![(place, false)]),
        }
    }
    tracks
}
