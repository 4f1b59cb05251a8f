//! A layout: nodes, and edges between them with their exact geometry; the common form of all layout files.

use super::vehicle::Facing;
use super::{ImportError, VehicleTraits};
use crate::scenario::PlacedSegment;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::fmt;

/// Name of a node or an edge, as in the source file.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ElementId {
    /// A number.
    Number(u64),
    /// A text.
    Text(String),
}

impl fmt::Display for ElementId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(f),
            Self::Text(text) => text.fmt(f),
        }
    }
}

impl Ord for ElementId {
    fn cmp(&self, other: &Self) -> Ordering {
        match (self, other) {
            (Self::Number(a), Self::Number(b)) => a.cmp(b),
            (Self::Text(a), Self::Text(b)) => a.cmp(b),
            (Self::Number(_), Self::Text(_)) => Ordering::Less,
            (Self::Text(_), Self::Number(_)) => Ordering::Greater,
        }
    }
}

impl PartialOrd for ElementId {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// A place where vehicles may stop.
#[derive(Clone, Debug, PartialEq)]
pub struct LayoutNode {
    /// As in the file, unique.
    pub id: ElementId,
    /// A second name that the file gives it.
    pub name: Option<String>,
    /// Place of its level in [`Layout::levels`].
    pub level: usize,
    /// \[m\]
    pub point: [f64; 2],
}

/// A way from node to node.
#[derive(Clone, Debug, PartialEq)]
pub struct LayoutEdge {
    /// As in the file, unique.
    pub id: ElementId,
    /// Places in [`Layout::nodes`] of the nodes where it begins and ends.
    pub ends: [usize; 2],
    /// Its lines and arcs, each beginning where the one before it ends.
    pub curve: Vec<PlacedSegment>,
    /// Whether it may be travelled from its first end to the other one, and back.
    pub ways: [bool; 2],
    /// Whether the file closes it for all vehicles. Routes avoid it; locks include it, because it may be opened again.
    pub closed: bool,
    /// Largest speed in either direction \[m/s\], where it is limited.
    pub speed: [Option<f64>; 2],
    /// Largest speed of rotation \[rad/s\], where it is limited.
    pub rotation: Option<f64>,
    /// Which way the vehicle faces in either direction, with respect to its way there.
    pub facing: [Facing; 2],
    /// How far the vehicle may be from where it is on `curve` at the same length \[m\]: where the file has lines and arcs, it is the
    /// `room`, and else by how much the curve in the file is off in addition.
    pub deviation: f64,
    /// How far the vehicle may leave its curve to go round obstacles \[m\], in a corridor that the file gives it.
    pub room: f64,
    /// Largest difference of both lengths \[m\].
    pub longer: f64,
    /// Largest difference of both headings at the same length \[rad\].
    pub turned: f64,
}

impl LayoutEdge {
    /// One way along these lines and arcs, open and without limits.
    pub fn new(id: ElementId, ends: [usize; 2], curve: Vec<PlacedSegment>) -> Self {
        let ways = [true, false];
        let (deviation, room, longer, turned) = (0.0, 0.0, 0.0, 0.0);
        let (speed, rotation, facing) = ([None; 2], None, [Facing::Ahead; 2]);
        Self { id, ends, curve, ways, closed: false, speed, rotation, facing, deviation, room, longer, turned }
    }

    /// How far any point of a vehicle may be from where it is on the curve in the file \[m\].
    pub fn position_error(&self, vehicle: &VehicleTraits) -> f64 {
        self.deviation + vehicle.moved_by(self.turned)
    }

    /// Whether it may be travelled in both directions.
    pub fn is_two_way(&self) -> bool {
        self.ways == [true; 2]
    }

    /// Length \[m\].
    pub fn length(&self) -> f64 {
        // A sum of nothing is -0.
        self.curve.iter().map(|placed| placed.shape.length()).sum::<f64>() + 0.0
    }
}

/// Nodes and edges that a file names together: a block of openTCS, a mutex group of Open-RMF.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LayoutZone {
    /// Its name in the file, unique.
    pub id: String,
    /// Places of its nodes in [`Layout::nodes`].
    pub nodes: Vec<usize>,
    /// Places of its edges in [`Layout::edges`].
    pub edges: Vec<usize>,
}

/// Nodes and edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// Name, empty if the file gives none.
    pub name: String,
    /// Floors or maps: what lies on different ones cannot collide. At least one if there are nodes.
    pub levels: Vec<String>,
    /// The nodes.
    pub nodes: Vec<LayoutNode>,
    /// The edges.
    pub edges: Vec<LayoutEdge>,
    /// The zones, in the order in which the file first names them.
    pub zones: Vec<LayoutZone>,
    /// Other ids of nodes, with their places: names of ends of edges that are one node.
    pub aliases: Vec<(String, usize)>,
    /// Types of vehicles that the file tells apart.
    pub vehicle_types: Vec<String>,
    /// An edge whose vehicle types have different speeds, of which one was taken.
    pub of_speeds: Option<ElementId>,
    /// Vehicles that the file names.
    pub vehicles: Vec<String>,
    /// Radius with which routes round corners between straight edges \[m\], if that is asked for.
    pub corner_radius: Option<f64>,
    /// Largest distance of a vehicle from its edges in rounded corners \[m\], if the deviations of the edges contain it
    /// ([`Layout::include_corners`]); else 0.
    pub corner_margin: f64,
    /// Warnings of the reader of the file.
    pub warnings: Vec<String>,
}

impl Layout {
    /// Checks that each edge has one speed, on which all times depend.
    ///
    /// # Errors
    /// [`ImportError`] with an edge whose vehicle types have different speeds.
    pub fn one_speed(&self) -> Result<(), ImportError> {
        let problem = "its vehicle types have different speeds; say which one drives, --vehicle TYPE";
        self.of_speeds.as_ref().map_or(Ok(()), |edge| Err(ImportError::new(format!("edge {edge}: {problem}"))))
    }

    /// The zone of this name, which is added if there is none.
    pub(crate) fn zone_called(&mut self, name: &str) -> &mut LayoutZone {
        let place = self.zones.iter().position(|zone| zone.id == name).unwrap_or(self.zones.len());
        if place == self.zones.len() {
            self.zones.push(LayoutZone { id: name.to_owned(), ..LayoutZone::default() });
        }
        &mut self.zones[place]
    }

    /// Places of the node of this id or of this other id or, if there is none, of those of this name.
    pub fn nodes_called(&self, name: &str) -> Vec<usize> {
        let by_id = self.nodes.iter().position(|node| node.id.to_string() == name);
        let by_name = || {
            let named = self.nodes.iter().enumerate().filter(|(_, node)| node.name.as_deref() == Some(name));
            named.map(|(place, _)| place).collect()
        };
        let by_alias = || self.aliases.iter().find(|(alias, _)| alias == name).map(|(_, place)| *place);
        by_id.or_else(by_alias).map_or_else(by_name, |place| vec![place])
    }

    /// Place of the node of this id or, if there is none, of this other id, or of this name if only one has it.
    pub fn node(&self, name: &str) -> Option<usize> {
        match self.nodes_called(name)[..] {
            [only] => Some(only),
            _ => None,
        }
    }

    /// The level that has most nodes; among equals the first.
    pub fn largest_level(&self) -> usize {
        let count = |level: usize| self.nodes.iter().filter(|node| node.level == level).count();
        (0..self.levels.len()).rev().max_by_key(|&level| count(level)).unwrap_or(0)
    }

    /// Where a node is \[m\].
    ///
    /// # Panics
    /// If there is no such node: readers give edges only such ends as are places of nodes.
    pub fn position(&self, node: usize) -> [f64; 2] {
        self.nodes[node].point
    }

    /// Level of a node.
    ///
    /// # Panics
    /// As [`Layout::position`].
    pub fn level_of(&self, node: usize) -> usize {
        self.nodes[node].level
    }

    /// Level of an edge: that of the node where it begins.
    ///
    /// # Panics
    /// As [`Layout::position`].
    pub fn level(&self, edge: &LayoutEdge) -> usize {
        self.level_of(edge.ends[0])
    }

    /// Whether an edge begins or ends on a level.
    ///
    /// # Panics
    /// As [`Layout::position`].
    pub fn is_on(&self, edge: &LayoutEdge, level: usize) -> bool {
        edge.ends.iter().any(|&node| self.level_of(node) == level)
    }
}
