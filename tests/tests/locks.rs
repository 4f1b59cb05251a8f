//! Tables of locks against geometry that is written out here: distances of segments, sampled curves.

use pcr_formats::import::{
    ElementId, ImportOptions, ImportedLayout, InputFormat, Layout, LayoutEdge, Warnings, layout,
};
use pcr_formats::scenario::PathSegment;
use pcr_planning::exclusion_table::ExclusionTable;
use serde_json::{Value, json};

const WAREHOUSE: &str = include_str!("../data/real/nav2/warehouse_graph.geojson");
const AWS: &str = include_str!("../data/real/nav2/aws_graph.geojson");
const CURVES: &str = include_str!("../data/real/lif/example_17.lif.json");
const LEVELS: &str = include_str!("../data/real/lif/example_05.lif.json");

fn read(format: InputFormat, text: &str, radius: f64) -> ImportedLayout {
    let options = ImportOptions { radius: Some(radius), ..ImportOptions::default() };
    layout(format, text, &options, &mut Warnings::default()).unwrap()
}

type Point = [f64; 2];

fn between([a, b]: [Point; 2], share: f64) -> Point {
    [0, 1].map(|k| a[k] + (b[k] - a[k]) * share)
}

/// Distance of a point from a segment.
fn from_segment([a, b]: [Point; 2], p: Point) -> f64 {
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let square = dx * dx + dy * dy;
    let share = if square > 0.0 { (((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
    let [x, y] = between([a, b], share);
    (x - p[0]).hypot(y - p[1])
}

/// The shares of the first segment that are within `reach` of the second: distance from a segment is convex, so that they
/// are one interval, whose ends bisection finds on both sides of the nearest point.
fn within(own: [Point; 2], other: [Point; 2], reach: f64) -> Option<[f64; 2]> {
    let distance = |share: f64| from_segment(other, between(own, share));
    let (mut lo, mut hi) = (0.0, 1.0);
    for _ in 0..200 {
        let thirds = [lo + (hi - lo) / 3.0, hi - (hi - lo) / 3.0];
        if distance(thirds[0]) <= distance(thirds[1]) { hi = thirds[1] } else { lo = thirds[0] }
    }
    let nearest = [0.0, 1.0, lo].into_iter().min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap();
    if distance(nearest) > reach {
        return None;
    }
    let end = |out: f64| {
        if distance(out) <= reach {
            return out;
        }
        let (mut inside, mut outside) = (nearest, out);
        for _ in 0..100 {
            let middle = 0.5 * (inside + outside);
            if distance(middle) <= reach { inside = middle } else { outside = middle }
        }
        inside
    };
    Some([end(0.0), end(1.0)])
}

fn ends(layout: &Layout, edge: &LayoutEdge) -> [Point; 2] {
    edge.ends.map(|node| layout.nodes[node].point)
}

#[test]
fn locks_of_straight_edges_are_those_of_their_distances() {
    for (text, radius) in [(WAREHOUSE, 0.4), (WAREHOUSE, 0.75), (AWS, 0.3)] {
        let imported = read(InputFormat::Nav2, text, radius);
        let table = ExclusionTable::compute(&imported, false).unwrap();
        let layout = &imported.layout;
        let mut edges: Vec<&LayoutEdge> = layout.edges.iter().collect();
        edges.sort_by(|a, b| a.id.cmp(&b.id));
        let mut locks = table.locks.iter().peekable();
        for (k, a) in edges.iter().enumerate() {
            for b in edges.iter().skip(k + 1) {
                let (own, other) = (ends(layout, a), ends(layout, b));
                let name = format!("{} {}", a.id, b.id);
                let [sure, possible] = [-1e-9, 1e-9].map(|more| within(own, other, 2.0 * radius + more));
                let lock = locks.next_if(|lock| (&lock.a, &lock.b) == (&a.id, &b.id));
                assert!(lock.is_some() || sure.is_none(), "{name}: no lock");
                assert!(lock.is_none() || possible.is_some(), "{name}: a lock");
                let Some(lock) = lock else { continue };
                // A combined radius that is a nanometre larger and one that is smaller enclose the ends.
                let sides = [(a, lock.a_length, own, other), (b, lock.b_length, other, own)];
                for (edge, length, own, other) in sides {
                    let [lo, hi] = within(own, other, 2.0 * radius + 1e-9).unwrap().map(|share| share * edge.length());
                    assert!(lo - 1e-7 <= length[0] && length[1] <= hi + 1e-7, "{name}: {length:?} {lo} {hi}");
                    if let Some([lo, hi]) =
                        within(own, other, 2.0 * radius).map(|[a, b]| [a * edge.length(), b * edge.length()])
                    {
                        assert!(length[0] <= lo + 1e-12 && hi - 1e-12 <= length[1], "{name}: {length:?} {lo} {hi}");
                    }
                }
            }
        }
        assert_eq!(locks.next(), None, "in order, and one a pair");
    }
}

#[test]
fn what_a_node_blocks_is_within_reach_of_it() {
    let imported = read(InputFormat::Nav2, WAREHOUSE, 0.4);
    let table = ExclusionTable::compute(&imported, true).unwrap();
    let layout = &imported.layout;
    let nodes = table.nodes.unwrap();
    let mut expected = 0;
    for node in &layout.nodes {
        for edge in &layout.edges {
            let share = within(ends(layout, edge), [node.point; 2], 0.8);
            expected += usize::from(share.is_some());
            let lock = nodes.iter().find(|lock| (&lock.node, &lock.edge) == (&node.id, &edge.id));
            match (share, lock) {
                (Some([lo, hi]), Some(lock)) => {
                    assert!((lock.edge_length[0] - lo * edge.length()).abs() < 1e-9);
                    assert!((lock.edge_length[1] - hi * edge.length()).abs() < 1e-9);
                }
                (share, lock) => assert!(share.is_none() && lock.is_none(), "{} {}", node.id, edge.id),
            }
        }
    }
    assert_eq!(nodes.len(), expected);
    let near = |a: Point, b: Point| (a[0] - b[0]).hypot(a[1] - b[1]) <= 0.8;
    let pairs = layout.nodes.iter().enumerate();
    let pairs = pairs.map(|(k, a)| layout.nodes.iter().skip(k + 1).filter(|b| near(a.point, b.point)).count());
    assert_eq!(table.node_pairs.unwrap().len(), pairs.sum::<usize>());
}

/// Points of an edge with their lengths, from its lines and arcs.
fn samples(edge: &LayoutEdge) -> Vec<(f64, Point)> {
    let mut from = 0.0;
    let mut points = Vec::new();
    for piece in &edge.curve {
        let length = piece.shape.length();
        for k in 0..=60 {
            let u = length * f64::from(k) / 60.0;
            let ([x, y], (sin, cos)) = (piece.start, piece.heading.sin_cos());
            let (along, across) = match piece.shape {
                PathSegment::Arc { radius, sweep, .. } => {
                    let angle = u / radius;
                    (radius * angle.sin(), (radius * (1.0 - angle.cos())).copysign(sweep))
                }
                _ => (u, 0.0),
            };
            points.push((from + u, [x + along * cos - across * sin, y + along * sin + across * cos]));
        }
        from += length;
    }
    points
}

#[test]
fn locks_of_curves_hold_every_contact() {
    for radius in [0.2, 0.5, 1.0, 3.0] {
        let imported = read(InputFormat::Lif, CURVES, radius);
        let [a, b] = [&imported.layout.edges[0], &imported.layout.edges[1]];
        let table = ExclusionTable::compute(&imported, false).unwrap();
        let reach = 2.0 * radius + a.deviation + b.deviation;
        // `a` comes first in order.
        for (own, at) in samples(a) {
            for (other, there) in samples(b) {
                let distance = (at[0] - there[0]).hypot(at[1] - there[1]);
                let holds = table.locks.iter().any(|lock| {
                    let within = |[lo, hi]: [f64; 2], x: f64| lo - 1e-9 <= x && x <= hi + 1e-9;
                    within(lock.a_length, own) && within(lock.b_length, other)
                });
                assert!(holds || distance > reach - 1e-9, "{own} {other}: {distance} and no lock");
            }
        }
        for lock in &table.locks {
            let nearest = |length: f64, own: &LayoutEdge, other: &LayoutEdge| {
                let (_, at) = samples(own)
                    .into_iter()
                    .min_by(|(x, _), (y, _)| (x - length).abs().total_cmp(&(y - length).abs()))
                    .unwrap();
                samples(other)
                    .into_iter()
                    .map(|(_, p)| (at[0] - p[0]).hypot(at[1] - p[1]))
                    .fold(f64::INFINITY, f64::min)
            };
            for end in lock.a_length {
                // As near as the samples tell.
                assert!(nearest(end, a, b) <= reach + 0.1, "{end}");
            }
        }
        assert!(!table.locks.is_empty());
    }
}

#[test]
fn edges_of_different_levels_do_not_lock() {
    let mut value: Value = serde_json::from_str(LEVELS).unwrap();
    for k in 0..2 {
        value["layouts"][1]["nodes"][k]["nodePosition"] = value["layouts"][0]["nodes"][k]["nodePosition"].clone();
    }
    assert_eq!(ExclusionTable::compute(&read(InputFormat::Lif, &value.to_string(), 0.5), false).unwrap().locks, []);
    for k in 0..2 {
        value["layouts"][1]["nodes"][k]["mapId"] = json!("Map_Z-Level_1");
    }
    let table = ExclusionTable::compute(&read(InputFormat::Lif, &value.to_string(), 0.5), false).unwrap();
    assert_eq!(table.locks.len(), 1);
    assert_eq!(
        (&table.locks[0].a, &table.locks[0].b),
        (&ElementId::Text("N1-N2".into()), &ElementId::Text("N101-N102".into()))
    );
}

#[test]
fn an_edge_from_level_to_level_locks_those_of_both() {
    let node =
        |id: &str, map: &str, x: f64, y: f64| json!({ "nodeId": id, "mapId": map, "nodePosition": { "x": x, "y": y } });
    let edge = |id: &str, from: &str, to: &str| json!({ "edgeId": id, "startNodeId": from, "endNodeId": to });
    let lif = json!({ "layouts": [{ "layoutId": "a",
        "nodes": [node("a", "low", 0.0, 0.0), node("b", "high", 10.0, 0.0), node("c", "high", 9.0, -3.0), node("d", "high", 9.0, 3.0),
            node("e", "low", 1.0, -3.0), node("f", "low", 1.0, 3.0)],
        "edges": [edge("ramp", "a", "b"), edge("back", "b", "a"), edge("upper", "c", "d"), edge("lower", "e", "f")] }] });
    let table = ExclusionTable::compute(&read(InputFormat::Lif, &lif.to_string(), 0.3), false).unwrap();
    let pairs: Vec<_> = table.locks.iter().map(|lock| [lock.a.to_string(), lock.b.to_string()]).collect();
    // Both of the ramp are on both levels, and lock each other once.
    let expected = [["back", "lower"], ["back", "ramp"], ["back", "upper"], ["lower", "ramp"], ["ramp", "upper"]];
    assert_eq!(pairs, expected);
}
