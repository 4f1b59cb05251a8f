//! Locks of vehicles with outlines, against their polygons in many poses on the edges and in the turns at their ends.

use pcr_formats::footprint::Footprint;
use pcr_formats::import::{
    ElementId, ImportOptions, ImportedLayout, InputFormat, Layout, LayoutEdge, Warnings, layout,
};
use pcr_formats::scenario::{KINK, PathSegment, PlacedSegment};
use pcr_planning::exclusion_table::{EdgeExclusion, ExclusionTable};
use pcr_tests::polygons::{Point, Polygon, apart, placed};
use serde_json::json;
use std::f64::consts::PI;

const WAREHOUSE: &str = include_str!("../data/real/nav2/warehouse_graph.geojson");
const SAMPLE: &str = include_str!("../data/real/nav2/sample_graph.geojson");
const CURVES: &str = include_str!("../data/real/lif/example_17.lif.json");
const OFFICE: &str = include_str!("../data/real/rmf/office.building.yaml");

/// Longer than wide, its reference point nearer to one end.
const FORK: [Point; 4] = [[-0.4, -0.3], [0.6, -0.3], [0.6, 0.3], [-0.4, 0.3]];

/// A route graph with one-way edges.
const GRAPH: &str = if cfg!(optimized) { WAREHOUSE } else { SAMPLE };

/// Poses of each edge, and of each turn.
const POSES: usize = if cfg!(optimized) { 16 } else { 6 };

fn read(format: InputFormat, text: &str, footprint: Option<Footprint>) -> ImportedLayout {
    let radius = footprint.as_ref().map_or(0.5, Footprint::circumscribed_radius);
    let options = ImportOptions { radius: Some(radius), ..ImportOptions::default() };
    let mut imported = layout(format, text, &options, &mut Warnings::default()).unwrap();
    imported.vehicle.footprint = footprint;
    imported
}

/// A length on an edge, where that is, and the heading there.
#[derive(Clone, Copy)]
struct Pose(f64, Point, f64);

/// On an edge at a length, travelled forward.
fn on(edge: &LayoutEdge, length: f64) -> Pose {
    let mut rest = length;
    let mut last = Pose(0.0, [0.0; 2], 0.0);
    for piece in &edge.curve {
        let u = rest.clamp(0.0, piece.shape.length());
        let ([x, y], (sin, cos)) = (piece.start, piece.heading.sin_cos());
        let (along, across, turned) = match piece.shape {
            PathSegment::Line { .. } => (u, 0.0, 0.0),
            PathSegment::Arc { radius, sweep } => {
                let angle = u / radius;
                (radius * angle.sin(), (radius * (1.0 - angle.cos())).copysign(sweep), angle.copysign(sweep))
            }
        };
        last = Pose(length, [x + along * cos - across * sin, y + along * sin + across * cos], piece.heading + turned);
        if rest <= piece.shape.length() {
            break;
        }
        rest -= piece.shape.length();
    }
    last
}

/// The directions in which an edge may be travelled: the nodes from and to which, and the headings there.
fn ways(edge: &LayoutEdge) -> Vec<([usize; 2], [f64; 2])> {
    let [start, end] = [on(edge, 0.0).2, on(edge, edge.length()).2];
    let [from, to] = edge.ends;
    let back = edge.is_two_way().then_some(([to, from], [end + PI, start + PI]));
    [([from, to], [start, end])].into_iter().chain(back).collect()
}

fn within_half_turn(angle: f64) -> f64 {
    (angle + PI).rem_euclid(2.0 * PI) - PI
}

/// Poses on an edge, those of both directions, and those of the turns from and to the edges at its ends.
fn poses(layout: &Layout, edge: &LayoutEdge) -> Vec<Pose> {
    let length = edge.length();
    let steps = || (0..=POSES).map(|k| k as f64 / POSES as f64);
    let mut poses = Vec::new();
    for ([from, to], [start, end]) in ways(edge) {
        let backward = from != edge.ends[0];
        for share in steps() {
            let Pose(at, point, heading) = on(edge, share * length);
            poses.push(Pose(at, point, if backward { heading + PI } else { heading }));
        }
        let others = || layout.edges.iter().flat_map(ways);
        // Headings, and the nodes at the other ends of the ways.
        let mut turn = |node: usize, from: &[(f64, usize)], to: &[(f64, usize)]| {
            let at = if node == edge.ends[0] { 0.0 } else { length };
            let open = layout.edges.iter().filter(|edge| !edge.closed).flat_map(ways);
            let onward: Vec<_> = open.filter(|(ends, _)| ends[0] == node).collect();
            let is_half = |turn: f64| turn.abs() > PI - KINK;
            let is_back = |a: (f64, usize), b: (f64, usize)| is_half(within_half_turn(b.0 - a.0)) && a.1 == b.1;
            for (a, b) in from.iter().flat_map(|a| to.iter().map(move |b| (*a, *b))) {
                // It goes back only where no other way leads on from there.
                if is_back(a, b) && onward.iter().any(|(ends, headings)| !is_back(a, (headings[0], ends[1]))) {
                    continue;
                }
                let turn = within_half_turn(b.0 - a.0);
                // Half a turn may go to either side.
                let other = is_half(turn).then(|| turn - (2.0 * PI).copysign(turn));
                for turn in std::iter::once(turn).chain(other) {
                    poses.extend(steps().map(|share| Pose(at, on(edge, at).1, a.0 + turn * share)));
                }
            }
        };
        let arriving: Vec<_> =
            others().filter(|(ends, _)| ends[1] == from).map(|(ends, headings)| (headings[1], ends[0])).collect();
        let leaving: Vec<_> =
            others().filter(|(ends, _)| ends[0] == to).map(|(ends, headings)| (headings[0], ends[1])).collect();
        turn(from, &arriving, &[(start, to)]);
        turn(to, &[(end, from)], &leaving);
    }
    poses
}

fn outlines(poses: &[Pose]) -> Vec<(f64, Point, Polygon)> {
    poses.iter().map(|&Pose(length, at, heading)| (length, at, placed(&FORK, at, heading))).collect()
}

fn within([lo, hi]: [f64; 2], x: f64) -> bool {
    lo - 1e-9 <= x && x <= hi + 1e-9
}

/// Compares the locks of a layout with polygons in many poses; returns how many pairs of poses overlap.
fn compare(imported: &ImportedLayout) -> usize {
    let layout = &imported.layout;
    let locks = ExclusionTable::compute(imported, false).unwrap().locks;
    let footprint = imported.vehicle.footprint.as_ref().unwrap();
    let mut edges: Vec<&LayoutEdge> = layout.edges.iter().filter(|edge| edge.length() > 0.0).collect();
    edges.sort_by(|a, b| a.id.cmp(&b.id));
    let swept: Vec<_> = edges.iter().map(|edge| outlines(&poses(layout, edge))).collect();
    let mut overlaps = 0;
    for (k, a) in edges.iter().enumerate() {
        for (m, b) in edges.iter().enumerate().skip(k + 1) {
            if layout.level(a) != layout.level(b) {
                continue;
            }
            let own: Vec<&EdgeExclusion> = locks.iter().filter(|lock| (&lock.a, &lock.b) == (&a.id, &b.id)).collect();
            let deviation = a.deviation + b.deviation;
            for (length, at, outline) in &swept[k] {
                for (other, there, other_outline) in &swept[m] {
                    let distance = (at[0] - there[0]).hypot(at[1] - there[1]);
                    if distance > 2.0 * footprint.circumscribed_radius() || apart(outline, other_outline) > 0.0 {
                        continue;
                    }
                    overlaps += 1;
                    let there = own.iter().any(|lock| within(lock.a_length, *length) && within(lock.b_length, *other));
                    assert!(there, "{} at {length}, {} at {other}: no lock", a.id, b.id);
                }
            }
            // Half the way between two poses of the other edge, and what the curves are off.
            let coarse = 0.5 * (b.length() + PI * footprint.circumscribed_radius()) / POSES as f64;
            for lock in own {
                for end in lock.a_length.into_iter().filter(|end| *end > 1e-6 && *end < a.length() - 1e-6) {
                    let ways = ways(a).len();
                    let Pose(_, at, heading) = on(a, end);
                    let nearest = (0..ways).map(|way| placed(&FORK, at, heading + way as f64 * PI));
                    let nearest = nearest.flat_map(|own| swept[m].iter().map(move |(_, _, other)| apart(&own, other)));
                    let nearest = nearest.fold(f64::INFINITY, f64::min);
                    let most = deviation + coarse + 1e-6;
                    assert!(nearest <= most, "{} at {end}, {}: {nearest} of {most}", a.id, b.id);
                }
            }
        }
    }
    overlaps
}

fn fork() -> Footprint {
    Footprint::new(FORK.to_vec()).unwrap()
}

#[test]
fn no_overlap_of_polygons_is_without_a_lock() {
    for (format, text) in [(InputFormat::Nav2, GRAPH), (InputFormat::Lif, CURVES), (InputFormat::Rmf, OFFICE)] {
        let overlaps = compare(&read(format, text, Some(fork())));
        assert!(overlaps > 100, "{format}: {overlaps}");
    }
}

/// A graph of these nodes and edges, numbered from 0 and from 10.
fn graph(places: &[Point], edges: &[[usize; 2]]) -> ImportedLayout {
    let node = |(id, at): (usize, &Point)| {
        json!({ "type": "Feature", "properties": { "id": id, "frame": "map" },
            "geometry": { "type": "Point", "coordinates": at } })
    };
    let edge = |(id, [from, to]): (usize, &[usize; 2])| {
        json!({ "type": "Feature", "properties": { "id": id, "startid": from, "endid": to },
            "geometry": { "type": "MultiLineString", "coordinates": [[places[*from], places[*to]]] } })
    };
    let features: Vec<_> = places.iter().enumerate().map(node).chain((10..).zip(edges).map(edge)).collect();
    read(InputFormat::Nav2, &json!({ "type": "FeatureCollection", "features": features }).to_string(), Some(fork()))
}

#[track_caller]
fn locked(imported: &ImportedLayout, pairs: &[[u64; 2]]) {
    let locks = ExclusionTable::compute(imported, false).unwrap().locks;
    for pair in pairs {
        let is_locked = locks.iter().any(|lock| [&lock.a, &lock.b] == pair.map(ElementId::Number).each_ref());
        assert!(is_locked, "{pair:?}: {locks:?}");
    }
}

/// Past a node, and back onto another line: exactly half a turn, and almost.
#[test]
fn half_a_turn_onto_another_line_is_no_way_back() {
    for off in [0.0, 0.02] {
        let places = [[0.0, 0.0], [5.0, 0.0], [2.0, off], [8.0, 0.0], [5.0, 0.85], [7.0, 0.85]];
        let imported = graph(&places, &[[0, 1], [1, 2], [1, 3], [3, 1], [4, 5]]);
        compare(&imported);
        locked(&imported, &[[10, 14], [11, 14]]);
    }
}

#[test]
fn half_a_turn_within_an_edge_goes_to_either_side() {
    let places = [[0.0, 0.0], [2.0, 0.0], [5.0, 0.85], [7.0, 0.85], [5.0, -0.85], [7.0, -0.85]];
    let mut imported = graph(&places, &[[0, 1], [2, 3], [4, 5]]);
    for off in [0.0, 1e-6, -1e-6] {
        let tip = [5.0, off];
        imported.layout.edges[0].curve =
            vec![PlacedSegment::line([0.0, 0.0], tip), PlacedSegment::line(tip, [2.0, 0.0])];
        locked(&imported, &[[10, 11], [10, 12]]);
    }
}

#[test]
fn where_only_closed_edges_lead_on_it_turns_back() {
    let places = [[0.0, 0.0], [5.0, 0.0], [8.0, 0.0], [5.0, 0.85], [7.0, 0.85]];
    let mut imported = graph(&places, &[[0, 1], [1, 0], [1, 2], [3, 4]]);
    imported.layout.edges[2].closed = true;
    locked(&imported, &[[10, 13], [11, 13]]);
}

/// An edge that only comes to the node was taken for a way on, and one that leads on for none.
#[test]
fn whether_it_turns_back_is_decided_by_the_edges_that_leave() {
    let places = [[0.0, 0.0], [4.0, 0.0], [0.0, -3.0], [-0.9, -1.5], [-0.9, 1.5]];
    let to = |third: [usize; 2]| graph(&places, &[[1, 0], [0, 1], third, [3, 4]]);
    let comes = to([2, 0]);
    compare(&comes);
    locked(&comes, &[[11, 13]]);
    let leads_on = to([0, 2]);
    compare(&leads_on);
    let locks = ExclusionTable::compute(&leads_on, false).unwrap().locks;
    assert!(!locks.iter().any(|lock| [&lock.a, &lock.b] == [11, 13].map(ElementId::Number).each_ref()), "{locks:?}");
}

/// Another way back, that is beside the line between two places where both are the same.
#[test]
fn a_way_that_bends_off_is_no_way_back() {
    let places = [[0.0, 0.0], [5.0, 0.0], [8.0, 0.0], [5.0, 0.85], [7.0, 0.85]];
    let mut imported = graph(&places, &[[0, 1], [1, 0], [1, 2], [2, 1], [3, 4]]);
    let corners = [[5.0, 0.0], [4.375, 0.0], [4.0, 0.3], [3.75, 0.0], [0.0, 0.0]];
    imported.layout.edges[1].curve = corners.windows(2).map(|ends| PlacedSegment::line(ends[0], ends[1])).collect();
    locked(&imported, &[[10, 14], [11, 14]]);
}

/// Locks of an outline are within those of the disc around it, and block less.
#[test]
fn an_outline_blocks_less_than_the_disc_around_it() {
    let locks = |footprint: Option<Footprint>| {
        let mut imported = read(InputFormat::Nav2, GRAPH, footprint);
        imported.vehicle.radius = fork().circumscribed_radius();
        ExclusionTable::compute(&imported, false).unwrap().locks
    };
    let (outline, disc) = (locks(Some(fork())), locks(None));
    for lock in &outline {
        let holds = |other: &&EdgeExclusion| {
            let around = |[lo, hi]: [f64; 2], [from, to]: [f64; 2]| lo - 1e-6 <= from && to <= hi + 1e-6;
            (&other.a, &other.b) == (&lock.a, &lock.b)
                && around(other.a_length, lock.a_length)
                && around(other.b_length, lock.b_length)
        };
        assert!(disc.iter().any(|other| holds(&other)), "{lock:?}");
    }
    let blocked = |locks: &[EdgeExclusion]| {
        let area =
            |lock: &EdgeExclusion| [lock.a_length, lock.b_length].map(|[lo, hi]| hi - lo).iter().product::<f64>();
        locks.iter().map(area).sum::<f64>()
    };
    let share = blocked(&outline) / blocked(&disc);
    println!("{} locks, {} of the disc; {share:.3} of what that blocks", outline.len(), disc.len());
    assert!((0.3..0.95).contains(&share), "{share}");
}

/// A vehicle at a node may have any heading: it blocks what the disc around it does.
#[test]
fn a_vehicle_at_a_node_may_have_any_heading() {
    let imported = read(InputFormat::Nav2, GRAPH, Some(fork()));
    let table = ExclusionTable::compute(&imported, true).unwrap();
    let layout = &imported.layout;
    let (nodes, reach) = (table.nodes.unwrap(), fork().circumscribed_radius());
    for node in &layout.nodes {
        for edge in layout.edges.iter().filter(|edge| edge.length() > 0.0) {
            let lengths: Vec<_> = nodes.iter().filter(|lock| lock.node == node.id && lock.edge == edge.id).collect();
            for share in 0..=20 {
                let Pose(length, at, heading) = on(edge, edge.length() * f64::from(share) / 20.0);
                if (at[0] - node.point[0]).hypot(at[1] - node.point[1]) > 2.0 * reach {
                    continue;
                }
                let outline = placed(&FORK, at, heading);
                let headings = (0..36).map(|k| placed(&FORK, node.point, f64::from(k) * PI / 18.0));
                let meets = headings.into_iter().any(|there| apart(&there, &outline) == 0.0);
                assert!(
                    !meets || lengths.iter().any(|lock| within(lock.edge_length, length)),
                    "{} {}",
                    node.id,
                    edge.id
                );
            }
        }
    }
}
