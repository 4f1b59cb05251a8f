//! The locks of a layout that changes. An edge that is added, moved or removed costs a comparison with the box of every
//! other edge, and the computation of its own locks.

use super::EdgeExclusion;
use super::edge_traversals::EdgeTraversals;
use super::swept_areas::SweptLayout;
use pcr_formats::import::{ElementId, ImportError, ImportedLayout, LayoutEdge};
use std::collections::HashMap;

/// A layout whose edges change, one at a time.
pub struct IncrementalExclusions {
    imported: ImportedLayout,
    sweep: SweptLayout,
    /// Track of each edge.
    tracks: HashMap<ElementId, usize>,
}

/// The effect of a change on the locks.
#[derive(Clone, Debug, PartialEq)]
pub struct ExclusionChange {
    /// The edges whose former locks are void: the changed edge, and for outlines the edges that it meets at a node, where the
    /// vehicle turns.
    pub edges: Vec<ElementId>,
    /// The present locks of these edges, each once.
    pub locks: Vec<EdgeExclusion>,
    /// Number of pairs of bodies that were near enough to be computed.
    pub looked: usize,
}

impl IncrementalExclusions {
    /// The edges of a layout, which [`Locks::compute`](super::ExclusionTable::compute) has the locks of.
    ///
    /// # Errors
    /// As [`SweptLayout::new`].
    pub fn new(imported: ImportedLayout) -> Result<Self, ImportError> {
        let sweep = SweptLayout::new(&imported, false)?;
        let members =
            sweep.tracks.iter().enumerate().flat_map(|(track, it)| it.members.iter().map(move |m| (m.0, track)));
        let tracks = members.filter_map(|(place, track)| Some((sweep.ids().get(place)?.clone(), track))).collect();
        Ok(Self { imported, sweep, tracks })
    }

    /// The layout as it is now; its edges are in no order.
    pub fn imported(&self) -> &ImportedLayout {
        &self.imported
    }

    /// Adds an edge, or puts it in place of the one of its name.
    ///
    /// # Errors
    /// [`ImportError`] for an edge between nodes that the layout does not have, or out of range; then nothing is changed.
    pub fn insert(&mut self, edge: LayoutEdge) -> Result<ExclusionChange, ImportError> {
        if let Some(end) = edge.ends.iter().find(|&&end| end >= self.imported.layout.nodes.len()) {
            return Err(ImportError::new(format!("edge {}: there is no node at place {end}", edge.id)));
        }
        let id = edge.id.clone();
        let before = self.take_out(&id);
        let mut met = before.as_ref().map_or_else(Vec::new, |before| self.met(before.ends));
        met.extend(self.met(edge.ends));
        self.imported.layout.edges.push(edge);
        met.push(id.clone());
        let change = self.renew(met);
        if change.is_err() {
            self.imported.layout.edges.pop();
            if let Some(before) = before {
                self.imported.layout.edges.push(before);
                self.renew(vec![id])?;
            }
        }
        change
    }

    /// Removes an edge.
    ///
    /// # Errors
    /// [`ImportError`] where there is no such edge.
    pub fn remove(&mut self, id: &ElementId) -> Result<ExclusionChange, ImportError> {
        let before = self.take_out(id).ok_or_else(|| ImportError::new(format!("there is no edge {id}")))?;
        let mut change = self.renew(self.met(before.ends))?;
        change.edges.push(id.clone());
        Ok(change)
    }

    /// The edges that share a node with one, if the vehicle turns there.
    fn met(&self, ends: [usize; 2]) -> Vec<ElementId> {
        if self.imported.vehicle.footprint.is_none() {
            return Vec::new();
        }
        let edges = self.imported.layout.edges.iter().filter(|edge| edge.ends.iter().any(|end| ends.contains(end)));
        edges.map(|edge| edge.id.clone()).collect()
    }

    fn take_out(&mut self, id: &ElementId) -> Option<LayoutEdge> {
        let edges = &mut self.imported.layout.edges;
        let place = edges.iter().position(|edge| edge.id == *id)?;
        if let Some(track) = self.tracks.remove(id) {
            self.sweep.take_out(track, id);
        }
        Some(edges.swap_remove(place))
    }

    /// Computes some edges anew.
    fn renew(&mut self, mut edges: Vec<ElementId>) -> Result<ExclusionChange, ImportError> {
        edges.sort();
        edges.dedup();
        let rides = EdgeTraversals::new(&self.imported);
        for id in &edges {
            let Some(edge) = self.imported.layout.edges.iter().find(|edge| edge.id == *id) else { continue };
            if let Some(track) = self.tracks.remove(id) {
                self.sweep.take_out(track, id);
            }
            let track = self.sweep.insert(&self.imported.layout, &rides, edge)?;
            self.tracks.insert(id.clone(), track);
        }
        let mut change = ExclusionChange { edges, locks: Vec::new(), looked: 0 };
        for id in &change.edges {
            let Some(&track) = self.tracks.get(id) else { continue };
            let (row, looked) = self.sweep.row_of(track)?;
            change.looked += looked;
            for (other, lengths) in row {
                for (name, turned) in self.sweep.members(other) {
                    // Between two that are computed anew, once.
                    if name == id || (name < id && change.edges.binary_search(name).is_ok()) {
                        continue;
                    }
                    let their = self.sweep.tracks[other].on_member(lengths[1], turned);
                    change.locks.push(if id < name {
                        EdgeExclusion { a: id.clone(), b: name.clone(), a_length: lengths[0], b_length: their }
                    } else {
                        EdgeExclusion { a: name.clone(), b: id.clone(), a_length: their, b_length: lengths[0] }
                    });
                }
            }
        }
        Ok(change)
    }
}
