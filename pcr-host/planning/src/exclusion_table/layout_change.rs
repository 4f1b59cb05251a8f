//! Changes of a layout, one edge at a time.

use super::LengthRanges;
use super::edge_traversals::EdgeTraversals;
use super::swept_areas::{CurveTraversals, SweptLayout, bodies};
use pcr_formats::import::{ElementId, ImportError, Layout, LayoutEdge};

/// Changes leave the ids unsorted.
impl SweptLayout {
    /// Adds an edge; returns its track.
    pub(super) fn insert(
        &mut self,
        layout: &Layout,
        rides: &EdgeTraversals<'_>,
        edge: &LayoutEdge,
    ) -> Result<usize, ImportError> {
        let (place, track) = (self.ids.len(), self.tracks.len());
        let plan = CurveTraversals {
            members: vec![(place, false)],
            length: edge.length(),
            levels: edge.ends.map(|node| layout.level_of(node)),
            rides: rides.on_edge(edge),
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

    /// Removes an edge from its track; a track without edges is removed from the grid.
    pub(super) fn take_out(&mut self, track: usize, id: &ElementId) {
        let Some(own) = self.tracks.get_mut(track) else { return };
        own.members.retain(|&(place, _)| self.ids.get(place).is_some_and(|there| there != id));
        if own.members.is_empty() {
            let [nowhere, never] = [f64::INFINITY, f64::NEG_INFINITY];
            self.areas[own.bodies.clone()].fill([nowhere, nowhere, never, never]);
        }
    }

    /// The members of a track by their ids, and whether they lead the other way.
    pub(super) fn members(&self, track: usize) -> impl Iterator<Item = (&ElementId, bool)> {
        let members = self.tracks.get(track).into_iter().flat_map(|track| &track.members);
        members.filter_map(|&(place, turned)| Some((self.ids.get(place)?, turned)))
    }

    /// The tracks that touch a track, with the lengths of both, and the number of pairs of bodies that were examined.
    pub(super) fn row_of(&self, track: usize) -> Result<(Vec<(usize, LengthRanges)>, usize), ImportError> {
        let own = &self.tracks[track];
        let meet = |a: &[f64; 4], b: &[f64; 4]| a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3];
        let mut pairs = Vec::new();
        for body in own.bodies.clone() {
            let near = self.areas.iter().enumerate().filter(|(_, other)| meet(&self.areas[body], other));
            let near = near.map(|(other, _)| (self.track_of(other), [body, other]));
            pairs.extend(near.filter(|&(other, _)| other != track && own.shares_a_level(&self.tracks[other])));
        }
        if own.members.len() > 1 {
            pairs.extend(own.bodies.clone().map(|body| (track, [body, body])));
        }
        pairs.sort_unstable();
        Ok((self.grouped(&pairs, |body| self.fleet.motion(body))?, pairs.len()))
    }
}
