//! Compares the layout of a written file with that of the file before: every node and edge has to be where it was, edges that are cut
//! have to be chains of parts on their lines, and nothing else may have come in.
//!
//! It shares nothing with the writers, which may not have written what they meant to.

use pcr_formats::import::{ElementId, ImportError, ImportedLayout, Layout, LayoutEdge};
use pcr_formats::scenario::{PathSegment, PlacedSegment};
use std::collections::HashMap;
use std::fmt;

/// Rounding of coordinates, relative to them: far more than that of a few sums, and less than what anybody measures.
const RELATIVE: f64 = 1e-9;

/// How edges may have been cut.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cut {
    /// Longest part \[m\]; `None` if nothing was to be cut.
    pub(crate) most: Option<f64>,
    /// How far new nodes may be off the line of their edge, by the digits of the format \[m\].
    pub(crate) rounding: f64,
}

/// Refuses a layout that is not the one before, with its edges cut.
///
/// # Errors
/// The first node or edge that is not where it was, or was not there.
pub(crate) fn compare(before: &ImportedLayout, after: &ImportedLayout, cut: Cut) -> Result<(), ImportError> {
    differ(before, after, cut)
        .map_err(|what| ImportError::new(format!("what would be written is another layout: {what}")))
}

/// The first difference of a layout from the one before.
#[derive(Clone, Debug, PartialEq)]
enum LayoutDifference {
    /// Another vehicle.
    Vehicle,
    /// Another name, or other levels: before, and after.
    Levels([(String, Vec<String>); 2]),
    /// A node is missing.
    MissingNode(ElementId),
    /// A node is elsewhere: before, and after.
    MovedNode(ElementId, [[f64; 2]; 2]),
    /// An edge differs.
    Edge(ElementId, EdgeDifference),
    /// An edge is on none of the edges before.
    StrangeEdge(ElementId),
    /// A node is on none of the edges before.
    StrangeNode(ElementId),
}

/// Why an edge of the file that was written is not that of the layout.
#[derive(Clone, Debug, PartialEq)]
enum EdgeDifference {
    /// It is missing, or not what it was.
    Missing,
    /// A part of it is missing.
    MissingPart,
    /// It has another name.
    Renamed(ElementId),
}

impl fmt::Display for EdgeDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("it is missing, or not what it was"),
            Self::MissingPart => f.write_str("a part is missing"),
            Self::Renamed(id) => write!(f, "it is called {id} there"),
        }
    }
}

impl fmt::Display for LayoutDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Vehicle => f.write_str("its vehicle is another one"),
            Self::Levels([(name, levels), (new, others)]) => {
                write!(f, "{name:?} with levels {levels:?} became {new:?} with {others:?}")
            }
            Self::MissingNode(id) => write!(f, "node {id} is missing"),
            Self::MovedNode(id, [was, is]) => write!(f, "node {id} is at {is:?}, and was at {was:?}"),
            Self::Edge(id, what) => write!(f, "edge {id}: {what}"),
            Self::StrangeEdge(id) => write!(f, "edge {id} is on none of the edges before"),
            Self::StrangeNode(id) => write!(f, "node {id} is on none of the edges before"),
        }
    }
}

fn differ(before: &ImportedLayout, after: &ImportedLayout, cut: Cut) -> Result<(), LayoutDifference> {
    if before.vehicle != after.vehicle {
        return Err(LayoutDifference::Vehicle);
    }
    let (old, new) = (&before.layout, &after.layout);
    if (&old.name, &old.levels) != (&new.name, &new.levels) {
        return Err(LayoutDifference::Levels([old, new].map(|layout| (layout.name.clone(), layout.levels.clone()))));
    }
    let places: HashMap<&ElementId, usize> =
        new.nodes.iter().enumerate().map(|(place, node)| (&node.id, place)).collect();
    let mut kept = vec![false; new.nodes.len()];
    let mut nodes = Vec::with_capacity(old.nodes.len());
    for node in &old.nodes {
        let Some(&place) = places.get(&node.id) else { return Err(LayoutDifference::MissingNode(node.id.clone())) };
        if new.nodes[place] != *node {
            return Err(LayoutDifference::MovedNode(node.id.clone(), [node.point, new.nodes[place].point]));
        }
        kept[place] = true;
        nodes.push(place);
    }
    let mut ways = Ways::of(new);
    let mut passed = vec![false; new.nodes.len()];
    // Forward first: there each edge has its own name, and another one may lead the same way as it does backward.
    for backward in [false, true] {
        for edge in &old.edges {
            let Some(step) = edge.steps().find(|step| step.backward == backward) else { continue };
            let ends = [nodes[step.origin()], nodes[step.target()]];
            let chain = Chain { edge, backward, ends, cut };
            chain
                .follow(new, &kept, &mut ways, &mut passed)
                .map_err(|what| LayoutDifference::Edge(edge.id.clone(), what))?;
        }
    }
    if let Some(edge) = ways.unused(new) {
        return Err(LayoutDifference::StrangeEdge(edge.id.clone()));
    }
    let strange = new.nodes.iter().enumerate().find(|(place, _)| !kept[*place] && !passed[*place]);
    strange.map_or(Ok(()), |(_, node)| Err(LayoutDifference::StrangeNode(node.id.clone())))
}

/// The directions in which edges may be travelled, by the nodes from which they go, and which of them are taken.
struct Ways {
    from: Vec<Vec<(usize, bool)>>,
    taken: Vec<[bool; 2]>,
}

impl Ways {
    fn of(layout: &Layout) -> Self {
        let mut from = vec![Vec::new(); layout.nodes.len()];
        for (place, edge) in layout.edges.iter().enumerate() {
            edge.steps().for_each(|step| from[step.origin()].push((place, step.backward)));
        }
        Self { from, taken: vec![[false; 2]; layout.edges.len()] }
    }

    /// An edge of which a direction is not taken.
    fn unused<'a>(&self, layout: &'a Layout) -> Option<&'a LayoutEdge> {
        let mut edges = layout.edges.iter().zip(&self.taken);
        edges
            .find(|(edge, taken)| edge.ways.iter().zip(*taken).any(|(way, taken)| *way && !taken))
            .map(|(edge, _)| edge)
    }
}

/// An edge of the file before in a direction, and where its ends are in the layout after.
struct Chain<'a> {
    edge: &'a LayoutEdge,
    backward: bool,
    ends: [usize; 2],
    cut: Cut,
}

impl Chain<'_> {
    /// Takes the ways that lead along the edge.
    fn follow(
        &self,
        layout: &Layout,
        kept: &[bool],
        ways: &mut Ways,
        passed: &mut [bool],
    ) -> Result<(), EdgeDifference> {
        let (mut at, mut done, mut parts) = (self.ends[0], 0.0, 0);
        loop {
            let fits = |&&(place, backward): &&(usize, bool)| {
                !ways.taken[place][usize::from(backward)]
                    && self.next(layout, kept, at, (place, backward), done, parts).is_some()
            };
            // The first part has the name of the edge; of several edges that run alike each has its own.
            let own = |&&(place, _): &&(usize, bool)| layout.edges[place].id == self.edge.id;
            let all = || ways.from[at].iter().filter(fits);
            let Some(&(place, backward)) = all().find(own).or_else(|| all().next()) else {
                return Err(if parts == 0 { EdgeDifference::Missing } else { EdgeDifference::MissingPart });
            };
            if parts == 0 && !self.backward && layout.edges[place].id != self.edge.id {
                return Err(EdgeDifference::Renamed(layout.edges[place].id.clone()));
            }
            // It fits.
            let Some((target, reached)) = self.next(layout, kept, at, (place, backward), done, parts) else { continue };
            ways.taken[place][usize::from(backward)] = true;
            (at, done, parts) = (target, reached, parts + 1);
            if at == self.ends[1] && !(self.is_loop() && done == 0.0) {
                return Ok(());
            }
            passed[at] = true;
        }
    }

    fn is_loop(&self) -> bool {
        self.ends[0] == self.ends[1] && self.edge.length() > 0.0
    }

    /// The node to which a way leads along the edge, and its length from the beginning; `None` if it is no part of the edge.
    fn next(
        &self,
        layout: &Layout,
        kept: &[bool],
        at: usize,
        (place, backward): (usize, bool),
        done: f64,
        parts: usize,
    ) -> Option<(usize, f64)> {
        let (old, part) = (self.edge, &layout.edges[place]);
        let target = part.ends[usize::from(!backward)];
        let limits =
            |edge: &LayoutEdge, backward: bool| (edge.speed[usize::from(backward)], edge.closed, edge.rotation);
        if limits(old, self.backward) != limits(part, backward) {
            return None;
        }
        // As it was.
        let as_it_was = (old.deviation, old.longer, old.turned) == (part.deviation, part.longer, part.turned);
        if parts == 0 && target == self.ends[1] && backward == self.backward && as_it_was && part.curve == old.curve {
            return Some((target, old.length()));
        }
        // A part of a line, or the same line the other way round.
        let ([line], [drawn]) = (&old.curve[..], &part.curve[..]) else { return None };
        let [PathSegment::Line { length }, PathSegment::Line { .. }] = [line.shape, drawn.shape] else { return None };
        let is_last = target == self.ends[1];
        if !as_it_was || (self.cut.most.is_none() && !(is_last && parts == 0)) || (!is_last && kept[target]) {
            return None;
        }
        let far = [line.start, line.end()].into_iter().flatten().fold(1.0, |far: f64, x| far.max(x.abs()));
        let near = self.cut.rounding + RELATIVE * far;
        let ends = [part.ends[0], part.ends[1]].map(|end| layout.nodes[end].point);
        let is_there = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) <= RELATIVE * far;
        if !is_there(drawn.start, ends[0]) || !is_there(drawn.end(), ends[1]) || at == target {
            return None;
        }
        let (along, beside) = on(line, layout.nodes[target].point);
        let reached = if self.backward { length - along } else { along };
        let is_short = self.cut.most.is_none_or(|most| reached - done <= most + 2.0 * near);
        let is_part = beside <= near && reached > done && reached <= length + near && is_short;
        is_part.then_some((target, reached))
    }
}

/// Where a point is along a line, and how far beside it \[m\].
fn on(line: &PlacedSegment, [x, y]: [f64; 2]) -> (f64, f64) {
    let [dx, dy] = [x - line.start[0], y - line.start[1]];
    let (sin, cos) = line.heading.sin_cos();
    (dx * cos + dy * sin, (dy * cos - dx * sin).abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::import::{ImportOptions, InputFormat, Warnings, layout};
    use serde_json::{Value, json};

    /// A route graph of nodes and edges with their ids.
    fn graph(nodes: &[(u64, [f64; 2])], edges: &[(u64, [u64; 2])]) -> ImportedLayout {
        let feature = |properties: Value, geometry: Value| json!({ "type": "Feature", "properties": properties, "geometry": geometry });
        let mut features: Vec<Value> = Vec::new();
        features.extend(
            nodes.iter().map(|(id, at)| feature(json!({ "id": id }), json!({ "type": "Point", "coordinates": at }))),
        );
        features.extend(edges.iter().map(|(id, [from, to])| {
            feature(
                json!({ "id": id, "startid": from, "endid": to }),
                json!({ "type": "MultiLineString", "coordinates": [] }),
            )
        }));
        let text = json!({ "type": "FeatureCollection", "features": features }).to_string();
        let options = ImportOptions { radius: Some(0.3), ..ImportOptions::default() };
        layout(InputFormat::Nav2, &text, &options, &mut Warnings::default()).unwrap()
    }

    const NODES: [(u64, [f64; 2]); 3] = [(1, [0.3, 0.1]), (2, [6.3, 8.1]), (3, [20.0, 0.1])];
    const EDGES: [(u64, [u64; 2]); 3] = [(7, [1, 2]), (8, [2, 1]), (9, [2, 3])];

    #[test]
    fn what_is_as_it_was_or_cut_is_kept() {
        let before = graph(&NODES, &EDGES);
        let nothing = Cut { most: None, rounding: 0.0 };
        let cut = Cut { most: Some(5.0), rounding: 0.0 };
        assert_eq!(compare(&before, &graph(&NODES, &EDGES), nothing), Ok(()));
        // Both directions of 10 m share the node in the middle; 9 was left whole, as it may be.
        let whole = Cut { most: Some(16.0), ..cut };
        let nodes = [&NODES[..], &[(4, [3.3, 4.1])]].concat();
        let edges = [(7, [1, 4]), (8, [2, 4]), (9, [2, 3]), (10, [4, 2]), (11, [4, 1])];
        assert_eq!(compare(&before, &graph(&nodes, &edges), whole), Ok(()));
        assert!(compare(&before, &graph(&nodes, &edges), nothing).is_err(), "nothing was to be cut");
        for (nodes, edges, expected) in [
            // The place of the new node: at the origin, beside the line, and beyond its end.
            (vec![(4, [0.0, 0.0])], edges, "edge 7: it is missing"),
            (vec![(4, [3.3, 4.2])], edges, "edge 7: it is missing"),
            (vec![(4, [9.3, 12.1])], edges, "edge 7: it is missing"),
            // Other ends, another direction, an edge and a node too many.
            (
                vec![(4, [3.3, 4.1])],
                [(7, [1, 4]), (8, [2, 4]), (9, [2, 3]), (10, [4, 3]), (11, [4, 1])],
                "edge 7: a part",
            ),
            (
                vec![(4, [3.3, 4.1])],
                [(7, [1, 4]), (8, [2, 4]), (9, [3, 2]), (10, [4, 2]), (11, [4, 1])],
                "edge 9: it is",
            ),
            (
                vec![(4, [3.3, 4.1])],
                [(7, [1, 2]), (8, [2, 1]), (9, [2, 3]), (10, [4, 2]), (11, [4, 1])],
                "edge 10 is on none",
            ),
            (vec![(4, [3.3, 4.1]), (5, [0.0, 9.0])], edges, "node 5 is on none"),
            // A part of another name where the edge begins.
            (
                vec![(4, [3.3, 4.1])],
                [(12, [1, 4]), (8, [2, 4]), (9, [2, 3]), (10, [4, 2]), (11, [4, 1])],
                "edge 7: it is called 12",
            ),
        ] {
            let after = graph(&[&NODES[..], &nodes].concat(), &edges);
            let error = compare(&before, &after, whole).expect_err(expected).to_string();
            assert!(error.contains(expected), "{error} is not {expected}");
        }
        let moved = graph(&[(1, [0.3, 0.1 + 1e-12]), NODES[1], NODES[2]], &EDGES);
        let error = compare(&before, &moved, cut).unwrap_err().to_string();
        assert!(error.contains("node 1 is at [0.3"), "{error}");
    }

    /// A lane both ways became two, and the one back was taken for another lane that leads the same way.
    #[test]
    fn lanes_that_lead_the_same_way_keep_their_names() {
        let options = ImportOptions { radius: Some(0.3), ..ImportOptions::default() };
        let building = |lanes: &str| {
            let text = format!(
                "coordinate_system: cartesian_meters\nname: m\nlevels:\n  L:\n    lanes: {lanes}\n    vertices: [[0, 0], [4, 0]]\n"
            );
            layout(InputFormat::Rmf, &text, &options, &mut Warnings::default()).unwrap()
        };
        let before = building("[[0, 1, {bidirectional: [4, true]}], [1, 0, {}]]");
        let after = building("[[0, 1, {bidirectional: [4, false]}], [1, 0, {}], [1, 0, {bidirectional: [4, false]}]]");
        let nothing = Cut { most: None, rounding: 0.0 };
        assert_eq!(compare(&before, &after, nothing), Ok(()));
        assert!(compare(&before, &building("[[0, 1, {}], [1, 0, {}]]"), nothing).is_err());
    }
}
