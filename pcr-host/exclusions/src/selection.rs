//! Which edges and nodes an audit is about.

use crate::LayoutElementId;
use pcr_formats::import::{ImportError, ImportedLayout};
use std::collections::BTreeSet;

/// Some edges and nodes of a layout, by their places; all of them if none is named.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    edges: BTreeSet<usize>,
    nodes: BTreeSet<usize>,
}

impl Selection {
    /// Returns those of these names: ids of edges, and ids or names of nodes.
    ///
    /// # Errors
    /// A name that the layout does not have; a name that several of its nodes have.
    pub fn of(imported: &ImportedLayout, edges: &[String], nodes: &[String]) -> Result<Self, ImportError> {
        let layout = &imported.layout;
        let edge = |name: &String| {
            let place = layout.edges.iter().position(|edge| edge.id.to_string() == *name);
            place.ok_or_else(|| ImportError::new(format!("--edge {name}: there is no such edge; pcr nodes lists them")))
        };
        let node = |name: &String| match layout.nodes_called(name)[..] {
            [only] => Ok(only),
            [] => Err(ImportError::new(format!("--node {name}: there is no such node; pcr nodes lists them"))),
            ref several => {
                let count = several.len();
                Err(ImportError::new(format!("--node {name}: {count} nodes have this name; pcr nodes lists their ids")))
            }
        };
        Ok(Self {
            edges: edges.iter().map(edge).collect::<Result<_, _>>()?,
            nodes: nodes.iter().map(node).collect::<Result<_, _>>()?,
        })
    }

    fn is_all(&self) -> bool {
        self.edges.is_empty() && self.nodes.is_empty()
    }

    /// Whether one of two edges is asked for.
    pub(crate) fn has(&self, pair: [usize; 2]) -> bool {
        self.is_all() || pair.iter().any(|edge| self.edges.contains(edge))
    }

    /// Whether a node or an edge is asked for.
    pub(crate) fn has_either(&self, node: usize, edge: usize) -> bool {
        self.is_all() || self.nodes.contains(&node) || self.edges.contains(&edge)
    }

    /// Returns the selected edges and nodes; none if everything is selected.
    pub(crate) fn spots(&self, imported: &ImportedLayout) -> Vec<LayoutElementId> {
        let layout = &imported.layout;
        let edges = self.edges.iter().map(|&edge| LayoutElementId::Edge(layout.edges[edge].id.clone()));
        edges.chain(self.nodes.iter().map(|&node| LayoutElementId::Node(layout.nodes[node].id.clone()))).collect()
    }
}
