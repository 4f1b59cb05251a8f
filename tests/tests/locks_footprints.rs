//! Locks of vehicles with outlines, against their polygons in many poses on the edges and in the turns at their ends.

use pcr_exclusions::{ExclusionAudit, ExclusionFormat, LayoutElementId, WriteOptions, write};
use pcr_formats::footprint::Footprint;
use pcr_formats::import::{
    ElementId, Facing, ImportOptions, ImportedLayout, InputFormat, Layout, LayoutEdge, Warnings, layout,
};
use pcr_formats::scenario::{KINK, PathSegment, PlacedSegment};
use pcr_planning::exclusion_table::{EdgeExclusion, ExclusionTable};
use pcr_tests::polygons::{Point, Polygon, apart, placed};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::f64::consts::PI;

const WAREHOUSE: &str = include_str!("../data/real/nav2/warehouse_graph.geojson");
const SAMPLE: &str = include_str!("../data/real/nav2/sample_graph.geojson");
const DEMO: &str = include_str!("../data/real/opentcs/Demo-01.xml");
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
            PathSegment::Arc { radius, sweep, .. } => {
                let angle = u / radius;
                (radius * angle.sin(), (radius * (1.0 - angle.cos())).copysign(sweep), angle.copysign(sweep))
            }
            _ => (u, 0.0, 0.0),
        };
        last = Pose(length, [x + along * cos - across * sin, y + along * sin + across * cos], piece.heading + turned);
        if rest <= piece.shape.length() {
            break;
        }
        rest -= piece.shape.length();
    }
    last
}

/// The directions in which an edge may be travelled: the nodes from and to which, the directions there, and the angle from them to the
/// heading of a vehicle that travels sideways.
fn ways(edge: &LayoutEdge) -> Vec<([usize; 2], [f64; 2], f64)> {
    let [start, end] = [on(edge, 0.0).2, on(edge, edge.length()).2];
    let [from, to] = edge.ends;
    let [there, back] = edge.facing.map(|facing| match facing {
        Facing::Sideways(_) => facing.angle().unwrap(),
        _ => 0.0,
    });
    let back = edge.is_two_way().then_some(([to, from], [end + PI, start + PI], back));
    [([from, to], [start, end], there)].into_iter().chain(back).collect()
}

fn within_half_turn(angle: f64) -> f64 {
    (angle + PI).rem_euclid(2.0 * PI) - PI
}

/// Poses on an edge, those of both directions, and those of the turns from and to the edges at its ends.
fn poses(layout: &Layout, edge: &LayoutEdge) -> Vec<Pose> {
    many_poses(layout, edge, POSES)
}

/// The same, so many steps of each.
fn many_poses(layout: &Layout, edge: &LayoutEdge, steps: usize) -> Vec<Pose> {
    let length = edge.length();
    let steps = || (0..=steps).map(move |k| k as f64 / steps as f64);
    let mut poses = Vec::new();
    for ([from, to], [start, end], facing) in ways(edge) {
        let backward = from != edge.ends[0];
        for share in steps() {
            let Pose(at, point, heading) = on(edge, share * length);
            poses.push(Pose(at, point, facing + if backward { heading + PI } else { heading }));
        }
        let others = || layout.edges.iter().flat_map(ways);
        // Directions, the nodes at the other ends of the ways, and the angles to the headings.
        let mut turn = |node: usize, from: &[(f64, usize, f64)], to: &[(f64, usize, f64)]| {
            let at = if node == edge.ends[0] { 0.0 } else { length };
            let open = layout.edges.iter().filter(|edge| !edge.closed).flat_map(ways);
            let onward: Vec<_> = open.filter(|(ends, ..)| ends[0] == node).collect();
            let is_half = |turn: f64| turn.abs() > PI - KINK;
            let is_back =
                |a: (f64, usize, f64), b: (f64, usize, f64)| is_half(within_half_turn(b.0 - a.0)) && a.1 == b.1;
            for (a, b) in from.iter().flat_map(|a| to.iter().map(move |b| (*a, *b))) {
                // It goes back only where no other way leads on from there.
                if is_back(a, b) && onward.iter().any(|(ends, headings, _)| !is_back(a, (headings[0], ends[1], 0.0))) {
                    continue;
                }
                let turn = within_half_turn(b.0 + b.2 - a.0 - a.2);
                // Half a turn may go to either side.
                let other = is_half(turn).then(|| turn - (2.0 * PI).copysign(turn));
                for turn in std::iter::once(turn).chain(other) {
                    poses.extend(steps().map(|share| Pose(at, on(edge, at).1, a.0 + a.2 + turn * share)));
                }
            }
        };
        let arriving: Vec<_> = others()
            .filter(|(ends, ..)| ends[1] == from)
            .map(|(ends, headings, facing)| (headings[1], ends[0], facing))
            .collect();
        let leaving: Vec<_> = others()
            .filter(|(ends, ..)| ends[0] == to)
            .map(|(ends, headings, facing)| (headings[0], ends[1], facing))
            .collect();
        turn(from, &arriving, &[(start, to, facing)]);
        turn(to, &[(end, from, facing)], &leaving);
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

/// A factsheet of a vehicle with this contour.
fn factsheet(name: &str, contour: &[Point]) -> ImportOptions {
    let points: Vec<_> = contour.iter().map(|[x, y]| json!({ "x": x, "y": y })).collect();
    let sheet = json!({ "headerId": 1, "version": "2.1.0", "manufacturer": "m", "serialNumber": "7",
        "physicalParameters": { "speedMax": 1.5, "accelerationMax": 0.6, "width": 0.6, "length": 1.0 },
        "agvGeometry": { "envelopes2d": [{ "set": "all", "polygonPoints": points }] } });
    let file = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&file, sheet.to_string()).unwrap();
    ImportOptions { fleet: Some(file), ..ImportOptions::default() }
}

/// How far a point is beyond a convex polygon at most, its corners to the left about.
fn outside(polygon: &[Point], [x, y]: Point) -> f64 {
    let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let beyond = sides.map(|(a, b)| {
        let [u, v] = [b[0] - a[0], b[1] - a[1]];
        ((x - a[0]) * v - (y - a[1]) * u) / u.hypot(v)
    });
    beyond.fold(f64::NEG_INFINITY, f64::max)
}

/// Whoever is somewhere is in a zone as a whole; and every corner of a zone is where a vehicle may be.
#[test]
fn zones_are_what_an_outline_sweeps() {
    let options = factsheet("zones.json", &FORK);
    let reach = fork().circumscribed_radius();
    for (format, text) in [(InputFormat::Nav2, SAMPLE), (InputFormat::Lif, CURVES), (InputFormat::Rmf, OFFICE)] {
        let imported = layout(format, text, &options, &mut Warnings::default()).unwrap();
        assert_eq!(imported.vehicle.footprint, Some(fork()));
        let site = &imported.layout;
        let edges: Vec<&LayoutEdge> = site.edges.iter().filter(|edge| edge.length() > 0.0).collect();
        let steps = 60;
        let swept: Vec<Vec<Polygon>> = edges
            .iter()
            .map(|edge| many_poses(site, edge, steps).iter().map(|pose| placed(&FORK, pose.1, pose.2)).collect())
            .collect();
        let spacing = edges.iter().map(|edge| edge.length()).fold(0.0, f64::max).max(PI * reach) / steps as f64;
        for split in [None, Some(0.7)] {
            let settings = WriteOptions { target: ExclusionFormat::Vda5050, split, envelopes: None };
            let (written, report, audit) = write(format, text, &options, "site", &settings).unwrap();
            assert!(audit.suffices() && report.warnings.iter().all(|text| !text.contains("disc-around")), "{report:?}");
            let sets: Value = serde_json::from_str(&written).unwrap();
            let zones = sets["zoneSet"]["zones"].as_array().unwrap();
            let zones: Vec<Polygon> = zones
                .iter()
                .map(|zone| {
                    let corners = zone["vertices"].as_array().unwrap().iter();
                    corners.map(|corner| ["x", "y"].map(|axis| corner[axis].as_f64().unwrap())).collect()
                })
                .collect();
            for (edge, polygons) in edges.iter().zip(&swept) {
                for polygon in polygons {
                    let is_in = |zone: &Polygon| polygon.iter().all(|&corner| outside(zone, corner) <= 1e-9);
                    assert!(zones.iter().any(is_in), "{format}: {} {polygon:?}", edge.id);
                }
            }
            let deviation = edges.iter().map(|edge| edge.position_error(&imported.vehicle)).fold(0.0, f64::max);
            // Which way a vehicle faces is not known of all edges: then there are zones for discs.
            let is_known = edges.iter().all(|edge| edge.facing == [Facing::Ahead; 2]);
            assert!(is_known || format == InputFormat::Lif);
            for corner in zones.iter().flatten().filter(|_| is_known) {
                let near =
                    swept.iter().flatten().map(|polygon| outside(polygon, *corner)).fold(f64::INFINITY, f64::min);
                let most = spacing + 0.01 * reach + 1.5 * deviation;
                assert!(near <= most, "{format}: {corner:?} is {near} of {most} beyond all poses");
            }
        }
    }
}

/// Two lanes of 0.6 m wide vehicles, 0.61 m apart, have zones apart; the disc around them would fill both.
#[test]
fn zones_of_narrow_lanes_leave_one_another_free() {
    let place = |x: f64, y: f64| json!({ "type": "Point", "coordinates": [x, y] });
    let node =
        |id: u32, x: f64, y: f64| json!({ "type": "Feature", "properties": { "id": id }, "geometry": place(x, y) });
    let edge = |id: u32, from: u32, to: u32| {
        json!({ "type": "Feature", "properties": { "id": id, "startid": from, "endid": to },
            "geometry": { "type": "LineString", "coordinates": [] } })
    };
    let features = json!([
        node(0, 0.0, 0.0),
        node(1, 9.0, 0.0),
        node(2, 9.0, 0.61),
        node(3, 0.0, 0.61),
        edge(10, 0, 1),
        edge(11, 2, 3)
    ]);
    let text = json!({ "type": "FeatureCollection", "features": features }).to_string();
    let options = factsheet("lanes.json", &FORK);
    let settings = WriteOptions { target: ExclusionFormat::Vda5050, split: None, envelopes: None };
    let (written, report, audit) = write(InputFormat::Nav2, &text, &options, "site", &settings).unwrap();
    assert!(audit.suffices() && report.needless == 0 && report.groups == 2 && report.excluded == 0.0, "{report:?}");
    // The same zones, each as much narrower as its outline is: what is not enough is told.
    let mut sets: Value = serde_json::from_str(&written).unwrap();
    for zone in sets["zoneSet"]["zones"].as_array_mut().unwrap() {
        let corners = zone["vertices"].as_array_mut().unwrap();
        for corner in corners {
            let y = corner["y"].as_f64().unwrap();
            let middle = if y > 0.305 { 0.61 } else { 0.0 };
            corner["y"] = json!(middle + 0.99 * (y - middle));
        }
    }
    let imported = layout(InputFormat::Nav2, &text, &options, &mut Warnings::default()).unwrap();
    let locks = ExclusionTable::compute(&imported, true).unwrap();
    let rules = pcr_exclusions::read(ExclusionFormat::Vda5050, &sets.to_string(), &imported).unwrap();
    let narrow = ExclusionAudit::run(&imported, &locks, &rules, ExclusionFormat::Vda5050).unwrap();
    // Two on one lane are in its zone in part, wherever they are. One that stands at an end of a lane may have turned there, and nobody on
    // the other lane is within a zone as a whole.
    let of_nodes =
        narrow.gaps.iter().filter(|gap| matches!(gap.a, LayoutElementId::Node(_)) && gap.relation == "apart");
    assert_eq!([of_nodes.count(), narrow.gaps.len()], [4; 2], "{:?}", narrow.gaps);
    let beside = sets.to_string().replace("\"RELEASE\"", "\"SPEED_LIMIT\"");
    let rules = pcr_exclusions::read(ExclusionFormat::Vda5050, &beside, &imported).unwrap();
    let none = ExclusionAudit::run(&imported, &locks, &rules, ExclusionFormat::Vda5050).unwrap();
    assert!(none.gaps.len() > 4 && none.gaps.iter().any(|gap| gap.relation == "same"), "{:?}", none.gaps);
}

/// The envelopes of a key in a plant model, by the names of points and paths.
fn envelopes(model: &str, key: &str) -> BTreeMap<String, Polygon> {
    let attribute = |tag: &str, name: &str| {
        let from = tag.find(&format!("{name}=\""))? + name.len() + 2;
        Some(tag[from..from + tag[from..].find('"')?].to_owned())
    };
    let (mut all, mut name, mut open) = (BTreeMap::<String, Polygon>::new(), String::new(), false);
    for tag in model.split('<') {
        if tag.starts_with("point ") || tag.starts_with("path ") {
            name = attribute(tag, " name").unwrap();
        } else if tag.starts_with("vehicleEnvelope ") {
            open = attribute(tag, "key").as_deref() == Some(key);
        } else if open && tag.starts_with("vertex ") {
            let corner = ["x", "y"].map(|axis| attribute(tag, axis).unwrap().parse::<f64>().unwrap() / 1e3);
            all.entry(name.clone()).or_default().push(corner);
        }
    }
    for polygon in all.values_mut() {
        polygon.pop();
    }
    all
}

/// Whoever is on a path is within its envelope and those of its points.
#[test]
fn envelopes_hold_what_an_outline_sweeps() {
    const BOX: [Point; 4] = [[-0.5, -0.2], [0.5, -0.2], [0.5, 0.2], [-0.5, 0.2]];
    let options = factsheet("envelopes.json", &BOX);
    let settings = WriteOptions { target: ExclusionFormat::OpenTcs, split: None, envelopes: Some("box".into()) };
    let (model, report, audit) = write(InputFormat::OpenTcs, DEMO, &options, "site", &settings).unwrap();
    assert!(audit.suffices() && report.groups > 10, "{report:?}");
    let imported = layout(InputFormat::OpenTcs, DEMO, &options, &mut Warnings::default()).unwrap();
    let site = &imported.layout;
    let envelopes = envelopes(&model, "box");
    let area = |polygon: &Polygon| {
        let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
        0.5 * sides.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>()
    };
    let mut narrow = 0;
    for edge in site.edges.iter().filter(|edge| edge.length() > 0.0) {
        let own = &envelopes[&edge.id.to_string()];
        let points = edge.ends.map(|node| &envelopes[&site.nodes[node].id.to_string()]);
        for Pose(_, at, heading) in many_poses(site, edge, 30) {
            let corners = placed(&BOX, at, heading);
            for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                for share in 0..4 {
                    let point = [0, 1].map(|k| a[k] + (b[k] - a[k]) * f64::from(share) / 4.0);
                    let is_in = [own, points[0], points[1]].iter().any(|polygon| outside(polygon, point) <= 0.0);
                    assert!(is_in, "{}: {point:?}", edge.id);
                }
            }
        }
        if let [PlacedSegment { shape: PathSegment::Line { length }, .. }] = edge.curve[..] {
            // Nothing but the lane, and millimetres.
            let most = (length + 1.0 + 0.01) * (0.4 + 0.01);
            assert!(area(own) <= most, "{}: {} of {most}", edge.id, area(own));
            narrow += 1;
        }
    }
    assert!(narrow > 5, "{narrow}");
}
