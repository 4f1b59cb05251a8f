//! Compares the rules of a file with the exact table of locks: finds contacts that are not excluded, and exclusions of
//! pairs that cannot touch.
//!
//! Two vehicles on one edge can always touch, so an edge has to exclude itself. A vehicle that arrives at a node was on
//! an edge that ends there, and the corridor of that edge contains the node. Hence for a node and an edge it is enough
//! that a vehicle at the node keeps others off the edge, and two nodes need nothing more.

use crate::convex_outline::overlap;
use crate::token_conflicts::TokenConflicts;
use crate::{
    DirectedEdgeRules, ExclusionFormat, ExclusionGroup, ExclusionRules, Selection, VehicleStamp, nearest, stretch,
};
use pcr_formats::import::{ElementId, ImportError, ImportedLayout, Layout, LayoutEdge, RouteStep};
use pcr_formats::scenario::{Agent, PlacedSegment};
use pcr_planning::exclusion_table::{
    EdgeExclusion, EdgeTraversals, ExclusionTable, ExclusionVehicle, NodeExclusion, SweptShape, can_touch, corridor,
};
use serde::Serialize;
use std::cell::LazyCell;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fmt;

/// The result of an audit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExclusionAudit {
    /// Name of the layout.
    pub layout: String,
    /// The vehicle.
    pub vehicle: ExclusionVehicle,
    /// Format of the exclusions.
    pub exclusions: String,
    /// For which vehicle the file was written, where it says so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub written_for: Option<VehicleStamp>,
    /// The edges and nodes that were asked about; nothing if all were.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub selected: Vec<LayoutElementId>,
    /// Number of groups, blocks, zones or lists of the file.
    pub groups: usize,
    /// Number of pairs of edges, or of a node and an edge, on which two vehicles can touch; each edge and itself is a pair.
    pub can_touch: usize,
    /// Pairs that can touch and that the rules do not exclude.
    pub gaps: Vec<MissingExclusion>,
    /// Pairs of edges that cannot touch but are excluded.
    pub needless: Vec<NeedlessExclusion>,
    /// Area of the pairs of lengths, over all pairs of edges, at which the rules do not let two vehicles be at the same time \[m²\].
    pub excluded: f64,
    /// Area of the pairs of lengths, over all pairs of edges, that the table of locks excludes \[m²\].
    pub needed: f64,
    /// Warnings about input that was changed or left out when it was read: of the layout, then of the exclusions.
    pub warnings: Vec<String>,
    /// Number of warnings that are about the layout.
    #[serde(skip)]
    pub of_layout: usize,
}

/// An edge or a node.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LayoutElementId {
    /// Id of an edge in the layout.
    Edge(ElementId),
    /// Id of a node in the layout.
    Node(ElementId),
}

impl fmt::Display for LayoutElementId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Edge(id) => write!(f, "edge {id}"),
            Self::Node(id) => write!(f, "node {id}"),
        }
    }
}

/// Two places at which two vehicles can touch although they keep the rules.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MissingExclusion {
    /// The first place.
    pub a: LayoutElementId,
    /// The second place; the same edge for two vehicles on one edge.
    pub b: LayoutElementId,
    /// Relation of the two: `same`, `adjacent` (they share a node) or `apart`.
    pub relation: &'static str,
    /// Lengths on the first one \[m\]; `None` for a node.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub a_length: Option<[f64; 2]>,
    /// Lengths on the second one \[m\].
    pub b_length: [f64; 2],
    /// Point between the two centres where they come nearest \[m\].
    pub at: [f64; 2],
    /// Largest overlap of the vehicles there \[m\]; for an outline that of all it sweeps on both edges.
    pub depth: f64,
    /// Floor or map.
    pub level: String,
}

/// Two edges that are excluded and cannot touch.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NeedlessExclusion {
    /// Id of the first edge.
    pub a: ElementId,
    /// Id of the second edge.
    pub b: ElementId,
}

impl ExclusionAudit {
    /// What rules leave out, and what they exclude in vain.
    ///
    /// # Errors
    /// [`ImportError`] for locks without those of nodes, and for locks and rules of another layout: they would seem to suffice.
    pub fn run(
        imported: &ImportedLayout,
        locks: &ExclusionTable,
        rules: &ExclusionRules,
        target: ExclusionFormat,
    ) -> Result<Self, ImportError> {
        Self::of_some(imported, locks, rules, target, &Selection::default())
    }

    /// Audits only the pairs of which at least one side is selected.
    ///
    /// # Errors
    /// Those of [`ExclusionAudit::run`].
    pub fn of_some(
        imported: &ImportedLayout,
        locks: &ExclusionTable,
        rules: &ExclusionRules,
        target: ExclusionFormat,
        selection: &Selection,
    ) -> Result<Self, ImportError> {
        let places = ElementIndex::of(&imported.layout);
        let mut nodes = places.nodes(locks)?;
        nodes.retain(|([node, edge], _)| selection.has_either(*node, *edge));
        let mut edges = places.edges(locks)?;
        edges.retain(|(pair, _)| selection.has(*pair));
        fit(&imported.layout, rules)?;
        let auditor = Auditor::new(imported, rules);
        let mut audit = Self {
            layout: locks.layout.clone(),
            vehicle: locks.vehicle.clone(),
            exclusions: target.to_string(),
            written_for: rules.stamp.clone(),
            selected: selection.spots(imported),
            groups: rules.groups.len(),
            can_touch: 0,
            gaps: Vec::new(),
            needless: Vec::new(),
            excluded: 0.0,
            needed: 0.0,
            warnings: imported.layout.warnings.clone(),
            of_layout: 0,
        };
        audit.of_layout = audit.warnings.len();
        audit.warnings.extend_from_slice(&rules.warnings);
        audit.warnings.extend(rules.stamp.as_ref().and_then(|stamp| stamp.difference(imported)));
        let mut pairs: BTreeMap<[usize; 2], Vec<[[f64; 2]; 2]>> = BTreeMap::new();
        for (pair, lengths) in edges {
            pairs.entry(pair).or_default().push(lengths);
            audit.needed += lengths.map(|[from, to]| to - from).into_iter().product::<f64>();
        }
        for (k, edge) in imported.layout.edges.iter().enumerate().filter(|(k, _)| selection.has([*k; 2])) {
            pairs.entry([k, k]).or_default().push([[0.0, edge.length()]; 2]);
        }
        for (&[a, b], locked) in &pairs {
            audit.can_touch += 1;
            let gaps = locked.iter().filter_map(|&lengths| auditor.gap([a, b], lengths));
            audit.gaps.extend(gaps.max_by(|x, y| x.depth.total_cmp(&y.depth)));
        }
        audit.add_nodes(&auditor, nodes);
        for [a, b] in auditor.excluded_pairs().filter(|pair| selection.has(*pair)) {
            audit.excluded += auditor.area([a, b]);
            if !pairs.contains_key(&[a, b]) && !pairs.contains_key(&[b, a]) {
                let id = |place: usize| imported.layout.edges[place].id.clone();
                audit.needless.push(NeedlessExclusion { a: id(a), b: id(b) });
            }
        }
        audit.needless.sort_by(|x, y| (&x.a, &x.b).cmp(&(&y.a, &y.b)));
        Ok(audit)
    }

    fn add_nodes(&mut self, auditor: &Auditor<'_>, locks: Vec<TouchingEdgeAndNode>) {
        let mut done: BTreeMap<[usize; 2], Option<MissingExclusion>> = BTreeMap::new();
        for ([node, edge], length) in locks {
            let gap = auditor.gap_at(node, edge, length);
            let known = done.entry([node, edge]).or_default();
            if known.as_ref().map_or(f64::NEG_INFINITY, |gap| gap.depth)
                < gap.as_ref().map_or(f64::NEG_INFINITY, |gap| gap.depth)
            {
                *known = gap;
            }
        }
        self.can_touch += done.len();
        self.gaps.extend(done.into_values().flatten());
    }

    /// Whether no vehicles can touch as long as they keep the rules.
    pub fn suffices(&self) -> bool {
        self.gaps.is_empty()
    }
}

/// Two edges and their lengths that lock each other, and a node with an edge and its lengths.
type TouchingEdges = ([usize; 2], [[f64; 2]; 2]);
type TouchingEdgeAndNode = ([usize; 2], [f64; 2]);

/// Where edges and nodes are in a layout, by their names.
struct ElementIndex<'a> {
    edges: HashMap<&'a ElementId, usize>,
    nodes: HashMap<&'a ElementId, usize>,
}

impl<'a> ElementIndex<'a> {
    fn of(layout: &'a Layout) -> Self {
        let edges = layout.edges.iter().enumerate().map(|(k, edge)| (&edge.id, k)).collect();
        Self { edges, nodes: layout.nodes.iter().enumerate().map(|(k, node)| (&node.id, k)).collect() }
    }

    fn edge(&self, id: &ElementId) -> Result<usize, ImportError> {
        let place = self.edges.get(id).copied();
        place.ok_or_else(|| ImportError::new(format!("locks of edge {id}, which the layout does not have")))
    }

    fn node(&self, id: &ElementId) -> Result<usize, ImportError> {
        let place = self.nodes.get(id).copied();
        place.ok_or_else(|| ImportError::new(format!("locks of node {id}, which the layout does not have")))
    }

    /// The locks of edges by their places.
    fn edges(&self, locks: &ExclusionTable) -> Result<Vec<TouchingEdges>, ImportError> {
        let place =
            |lock: &EdgeExclusion| Ok(([self.edge(&lock.a)?, self.edge(&lock.b)?], [lock.a_length, lock.b_length]));
        locks.locks.iter().map(place).collect()
    }

    /// The locks of nodes by their places.
    fn nodes(&self, locks: &ExclusionTable) -> Result<Vec<TouchingEdgeAndNode>, ImportError> {
        let none = || ImportError::new("an audit takes the locks of nodes as well");
        let place = |lock: &NodeExclusion| Ok(([self.node(&lock.node)?, self.edge(&lock.edge)?], lock.edge_length));
        locks.nodes.as_ref().ok_or_else(none)?.iter().map(place).collect()
    }
}

/// Checks that rules are of a layout: there is something about each edge and each node.
fn fit(layout: &Layout, rules: &ExclusionRules) -> Result<(), ImportError> {
    if (rules.edges.len(), rules.nodes.len()) == (layout.edges.len(), layout.nodes.len()) {
        return Ok(());
    }
    Err(ImportError::new("the exclusions are of another layout"))
}

struct Auditor<'a> {
    imported: &'a ImportedLayout,
    rules: &'a ExclusionRules,
    rides: EdgeTraversals<'a>,
    radius: f64,
    meetings: TokenConflicts,
}

/// The two ranges' common part.
fn common(a: [f64; 2], b: [f64; 2]) -> Option<[f64; 2]> {
    let both = [a[0].max(b[0]), a[1].min(b[1])];
    (both[0] <= both[1]).then_some(both)
}

impl<'a> Auditor<'a> {
    fn new(imported: &'a ImportedLayout, rules: &'a ExclusionRules) -> Self {
        let rides = EdgeTraversals::new(imported);
        let radius = rides.vehicle().radius;
        Self { imported, rules, rides, radius, meetings: TokenConflicts::of(rules) }
    }

    fn layout(&self) -> &'a Layout {
        &self.imported.layout
    }

    /// An edge in the directions in which it may be travelled.
    fn ways(&self, edge: usize) -> impl Iterator<Item = &'a DirectedEdgeRules> {
        let ways = self.rules.edges.get(edge);
        self.layout().edges[edge].steps().filter_map(move |step| ways?.get(usize::from(step.backward)))
    }

    /// Both edges in all directions in which they may be travelled.
    fn both_ways(&self, [a, b]: [usize; 2]) -> impl Iterator<Item = [&'a DirectedEdgeRules; 2]> {
        let of_b: Vec<&DirectedEdgeRules> = self.ways(b).collect();
        self.ways(a).flat_map(move |own| of_b.clone().into_iter().map(move |other| [own, other]))
    }

    /// The tokens of two edges. If vehicles on both can be on either of two levels, the tokens of each level: vehicles that
    /// touch are on one level, and have to be kept apart by the tokens of that level.
    fn tokens(&self, pair: [usize; 2]) -> Vec<Vec<usize>> {
        let all: Vec<usize> = self.meetings.tokens(pair).collect();
        let levels = pair.map(|edge| {
            let ends = self.layout().edges[edge].ends.iter();
            ends.map(|&end| self.layout().level_of(end)).collect::<BTreeSet<usize>>()
        });
        let common: Vec<usize> = levels[0].intersection(&levels[1]).copied().collect();
        if self.rules.levels.is_empty() || common.len() < 2 {
            return vec![all];
        }
        let of =
            |level: usize| all.iter().copied().filter(|&token| self.rules.levels.get(token) == Some(&level)).collect();
        common.into_iter().map(of).collect()
    }

    /// The place on two edges, within the lengths of a lock, at which vehicles overlap most.
    fn gap(&self, pair: [usize; 2], [a_length, b_length]: [[f64; 2]; 2]) -> Option<MissingExclusion> {
        let mut worst: Option<MissingExclusion> = None;
        let mut seen = BTreeSet::new();
        let tokens = self.tokens(pair);
        // The same for all lengths; computed only if needed, because it is slow.
        let deepest = LazyCell::new(|| self.overlap(pair));
        for ([own_way, other_way], tokens) in
            self.both_ways(pair).flat_map(|ways| tokens.iter().map(move |tokens| (ways, tokens)))
        {
            let [sections, others] = DirectedEdgeRules::between(own_way, other_way, tokens.iter().copied());
            for own in &sections {
                let Some(own_length) = common(own.length, a_length) else { continue };
                for other in others.iter().filter(|other| !own.claim.excludes(&other.claim)) {
                    let Some(other_length) = common(other.length, b_length) else { continue };
                    if seen.insert([own_length, other_length].map(|range| range.map(f64::to_bits))) {
                        let sides = [own_way, other_way].map(DirectedEdgeRules::is_backward);
                        let gap = self.touching(pair, sides, [own_length, other_length], &|| *deepest);
                        if gap.as_ref().is_some_and(|gap| worst.as_ref().is_none_or(|worst| worst.depth < gap.depth)) {
                            worst = gap;
                        }
                    }
                }
            }
        }
        worst
    }

    /// The gap of two stretches, if vehicles on them can touch.
    fn touching(
        &self,
        [a, b]: [usize; 2],
        backward: [bool; 2],
        lengths: [[f64; 2]; 2],
        overlap: &dyn Fn() -> Option<(f64, [f64; 2])>,
    ) -> Option<MissingExclusion> {
        let edges = [a, b].map(|place| &self.layout().edges[place]);
        let near = if self.imported.vehicle.footprint.is_none() {
            let curves = [0, 1].map(|k| self.stretch(edges[k], lengths[k]));
            let reach = 2.0 * self.radius + edges[0].deviation + edges[1].deviation;
            near(&curves[0], &curves[1], reach)
        } else {
            let agents = [0, 1].map(|k| {
                let rides = self.rides.in_direction(RouteStep { edge: edges[k], backward: backward[k] });
                rides.iter().filter_map(|ride| ride.within(lengths[k])).collect::<Vec<Agent>>()
            });
            if !can_touch(&agents[0], &agents[1]) {
                return None;
            }
            overlap()
        };
        // If the depth cannot be determined, the largest possible one is reported.
        let (depth, at) = near.unwrap_or((2.0 * self.radius, self.start_point(edges[0])));
        let shared = edges[0].ends.iter().any(|end| edges[1].ends.contains(end));
        (depth >= 0.0).then(|| MissingExclusion {
            a: LayoutElementId::Edge(edges[0].id.clone()),
            b: LayoutElementId::Edge(edges[1].id.clone()),
            relation: if a == b {
                "same"
            } else if shared {
                "adjacent"
            } else {
                "apart"
            },
            a_length: Some(lengths[0]),
            b_length: lengths[1],
            at,
            depth,
            level: self.level(self.layout().level(edges[0])),
        })
    }

    /// How deep the corridors of an outline on two edges overlap, and where \[m\].
    fn overlap(&self, pair: [usize; 2]) -> Option<(f64, [f64; 2])> {
        let corridors = pair.map(|place| corridor(&self.rides.on_edge(&self.layout().edges[place])));
        let pairs = corridors[0].iter().flat_map(|own| corridors[1].iter().map(move |other| (own, other)));
        let all = pairs.filter_map(|pair| match pair {
            (SweptShape::Area(own, r), SweptShape::Area(other, s)) => overlap([own, other], r + s),
            (SweptShape::Stroke(own, r), SweptShape::Stroke(other, s)) => near(own, other, r + s),
            // One vehicle is a disc or an outline on all edges.
            _ => None,
        });
        all.max_by(|x, y| x.0.total_cmp(&y.0)).map(|(depth, at)| (depth.max(0.0), at))
    }

    /// The start of an edge.
    fn start_point(&self, edge: &LayoutEdge) -> [f64; 2] {
        self.layout().position(edge.ends[0])
    }

    /// A part of an edge; an edge without length is a point.
    fn stretch(&self, edge: &LayoutEdge, lengths: [f64; 2]) -> Vec<PlacedSegment> {
        let at = self.start_point(edge);
        if edge.curve.is_empty() { vec![PlacedSegment::line(at, at)] } else { stretch(&edge.curve, lengths) }
    }

    fn level(&self, level: usize) -> String {
        self.layout().levels.get(level).cloned().unwrap_or_default()
    }

    /// The place where a vehicle on an edge can touch one that stands at a node and does not keep it off. Nobody stands where nobody may be.
    fn gap_at(&self, node: usize, edge: usize, length: [f64; 2]) -> Option<MissingExclusion> {
        let (claim, there) = (&self.rules.nodes[node], &self.layout().nodes[node]);
        if claim.closed {
            return None;
        }
        let (own, stands) = (&self.layout().edges[edge], [PlacedSegment::line(there.point, there.point)]);
        let sections = self.ways(edge).flat_map(|way| {
            let back = way.is_backward();
            way.excluded_spans(claim).into_iter().map(move |section| (back, section))
        });
        let open = sections.filter(|(_, section)| !claim.keeps_out(&section.claim));
        let ranges = open.filter_map(|(back, section)| Some((back, common(section.length, length)?)));
        let gaps = ranges.filter_map(|(back, range)| {
            if self.imported.vehicle.footprint.is_some() {
                let rides = self.rides.in_direction(RouteStep { edge: own, backward: back });
                let agents: Vec<Agent> = rides.iter().filter_map(|ride| ride.within(range)).collect();
                if !can_touch(&[self.rides.at_node(node).agent], &agents) {
                    return None;
                }
            }
            let near = near(&stands, &self.stretch(own, range), 2.0 * self.radius + own.deviation);
            let (depth, at) = near.unwrap_or((2.0 * self.radius, there.point));
            // For an outline, the lock shows that there is contact.
            let depth = if self.imported.vehicle.footprint.is_some() { depth.max(0.0) } else { depth };
            (depth >= 0.0).then(|| MissingExclusion {
                a: LayoutElementId::Node(there.id.clone()),
                b: LayoutElementId::Edge(own.id.clone()),
                relation: if own.ends.contains(&node) { "adjacent" } else { "apart" },
                a_length: None,
                b_length: range,
                at,
                depth,
                level: self.level(there.level),
            })
        });
        gaps.max_by(|x, y| x.depth.total_cmp(&y.depth))
    }

    /// Pairs of different edges of which some sections exclude each other.
    fn excluded_pairs(&self) -> impl Iterator<Item = [usize; 2]> {
        self.meetings.pairs().filter(|&[a, b]| a != b && self.excludes([a, b]))
    }

    fn excludes(&self, pair: [usize; 2]) -> bool {
        self.both_ways(pair).any(|[own, other]| {
            let [own, other] = DirectedEdgeRules::between(own, other, self.meetings.tokens(pair));
            own.iter().any(|own| other.iter().any(|other| own.claim.excludes(&other.claim)))
        })
    }

    /// Area of the lengths of two edges at which they exclude each other, in the directions with the least area \[m²\].
    fn area(&self, pair: [usize; 2]) -> f64 {
        let size = |length: [f64; 2]| length[1] - length[0];
        let area = |[own, other]: [&DirectedEdgeRules; 2]| {
            let [own, other] = DirectedEdgeRules::between(own, other, self.meetings.tokens(pair));
            let pairs = own.iter().flat_map(|own| other.iter().map(move |other| (own, other)));
            let excluded = pairs.filter(|(own, other)| own.claim.excludes(&other.claim));
            excluded.map(|(own, other)| size(own.length) * size(other.length)).sum::<f64>()
        };
        self.both_ways(pair).map(area).fold(f64::INFINITY, f64::min)
    }
}

/// Overlap of discs with this sum of radii where two curves come nearest, and the place; negative if they do not touch.
fn near(a: &[PlacedSegment], b: &[PlacedSegment], reach: f64) -> Option<(f64, [f64; 2])> {
    let found = nearest(a, b)?;
    let [p, q] = found.points;
    let depth = reach - found.distance;
    // What could be rounding counts as contact.
    let depth = if depth < 0.0 && found.least <= reach { 0.0 } else { depth };
    Some((depth, [0, 1].map(|k| (p[k] + q[k]) / 2.0)))
}

/// The groups of tokens that several places have, by name.
pub(crate) fn groups(
    layout: &Layout,
    names: &[String],
    edges: &[Vec<usize>],
    nodes: &[Vec<usize>],
) -> Vec<ExclusionGroup> {
    let empty = |name: &String| ExclusionGroup { name: name.clone(), ..ExclusionGroup::default() };
    let mut groups: Vec<ExclusionGroup> = names.iter().map(empty).collect();
    for (tokens, edge) in edges.iter().zip(&layout.edges) {
        for token in tokens {
            if let Some(group) = groups.get_mut(*token) {
                group.edges.push(edge.id.to_string());
            }
        }
    }
    for (tokens, node) in nodes.iter().zip(&layout.nodes) {
        for token in tokens {
            if let Some(group) = groups.get_mut(*token) {
                group.nodes.push(node.id.to_string());
            }
        }
    }
    groups
}
