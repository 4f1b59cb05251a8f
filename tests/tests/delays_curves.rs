//! Unsafe delays of arcs and of accelerations against sampled motions.

use pcr_core::{Interval, Motion};
use pcr_formats::import::{
    ElementId, ImportError, ImportOptions, ImportedLayout, InputFormat, LayoutEdge, Warnings, layout, ride,
};
use pcr_formats::scenario::{Agent, MotionSpec, PathSegment, PlacedSegment, Scenario};
use pcr_planning::exclusion_table::{EdgeDriving, UnsafeDelayModel, UnsafeRelation};
use pcr_planning::fleet::Fleet;
use std::collections::HashMap;

const CURVES: &str = include_str!("../data/real/lif/example_17.lif.json");
const WAREHOUSE: &str = include_str!("../data/real/nav2/warehouse_graph.geojson");
const SAMPLES: u32 = 400;

fn read(format: InputFormat, text: &str, radius: f64) -> ImportedLayout {
    let options = ImportOptions { radius: Some(radius), ..ImportOptions::default() };
    layout(format, text, &options, &mut Warnings::default()).unwrap()
}

type Intervals = HashMap<[usize; 2], Vec<[f64; 2]>>;

fn found(delays: &UnsafeDelayModel) -> Intervals {
    let mut all = Intervals::new();
    let take = |row: Vec<UnsafeRelation>| {
        for found in row {
            if let UnsafeRelation::Delays(ways, interval) = found {
                all.entry(ways).or_default().push(interval);
            }
        }
        Ok::<(), ImportError>(())
    };
    delays.each(&|_, _| {}, &<[UnsafeRelation]>::to_vec, take).unwrap();
    all
}

/// The least sampled distance if the second sets off later, while both are under way; and how far they go between two samples.
fn sampled(a: &Motion<'_, f64>, b: &Motion<'_, f64>, delay: f64) -> Option<[f64; 2]> {
    let b = b.delayed(delay).unwrap();
    let (lo, hi) = (a.time().lo.max(b.time().lo), a.time().hi.min(b.time().hi));
    (lo <= hi).then(|| {
        let apart = (0..=SAMPLES).map(|k| {
            let time = lo + (hi - lo) * f64::from(k) / f64::from(SAMPLES);
            let (p, q) = (a.position_at(time), b.position_at(time));
            (p.x - q.x).hypot(p.y - q.y)
        });
        let speed = a.profile().top_speed() + b.profile().top_speed();
        [apart.fold(f64::INFINITY, f64::min), speed * (hi - lo) / f64::from(SAMPLES)]
    })
}

/// Every way of a layout as it is driven, in the order of the table.
fn fleet(imported: &ImportedLayout, driving: EdgeDriving) -> Fleet<f64> {
    let mut vehicle = imported.vehicle.clone();
    vehicle.radius += vehicle.margin;
    vehicle.margin = 0.0;
    vehicle.speed = driving.speed;
    vehicle.acceleration = driving.acceleration.unwrap_or(vehicle.acceleration);
    let mut order: Vec<_> = imported.layout.edges.iter().collect();
    order.sort_by(|a, b| a.id.cmp(&b.id));
    let mut agents: Vec<Agent> = Vec::new();
    for edge in order {
        for step in edge.steps() {
            let agent = ride(&vehicle, step);
            let mut speed = step.speed().map_or(driving.speed, |limit| limit.min(driving.speed));
            for piece in &agent.path {
                if let (PathSegment::Arc { radius, .. }, Some(rotation)) = (piece, edge.rotation) {
                    speed = speed.min(radius * rotation);
                }
            }
            let motion = match driving.acceleration {
                None => MotionSpec::profile(speed, [(agent.length() / speed, 0.0)]),
                Some(a_max) if matches!(agent.path[..], [PathSegment::Line { .. }]) => {
                    MotionSpec::RestToRest { v_max: speed, a_max }
                }
                Some(_) => agent.motion.clone(),
            };
            agents.push(Agent { id: agents.len() as u64, motion, ..agent });
        }
    }
    Fleet::new(&Scenario::new("", agents)).unwrap()
}

fn audited(imported: &ImportedLayout, driving: EdgeDriving) {
    let delays = UnsafeDelayModel::new(imported, driving, false).unwrap();
    let (found, fleet) = (found(&delays), fleet(imported, driving));
    let motions = fleet.motions();
    assert_eq!(motions.len(), delays.ways().len());
    let empty = Vec::new();
    let (mut met, mut free) = (0, 0);
    for a in 0..motions.len() {
        // Of large layouts some pairs.
        for b in (a..motions.len()).filter(|b| motions.len() < 60 || (a + b) % 7 < 2) {
            let (own, their) = (&motions[a], &motions[b]);
            let reach = own.radius() + their.radius();
            let intervals = found.get(&[a, b]).unwrap_or(&empty);
            let (lo, hi) = (-their.profile().duration(), own.profile().duration());
            let ends = intervals.iter().flatten().flat_map(|end| [end - 1e-3, end - 1e-7, end + 1e-7, end + 1e-3]);
            for delay in (0..=24).map(|k| lo + (hi - lo) * f64::from(k) / 24.0).chain(ends) {
                let Some([apart, step]) = sampled(own, their, delay) else { continue };
                let inside = intervals.iter().any(|[from, to]| (from..=to).contains(&&delay));
                if inside {
                    // At the very end they touch between two samples.
                    assert!(apart <= reach + step, "{a} {b} at {delay}: {apart} {intervals:?}");
                    met += 1;
                } else {
                    assert!(apart > reach - 1e-9, "{a} {b} at {delay}: {apart} {intervals:?}");
                    free += 1;
                }
            }
            for &[from, to] in intervals {
                // Not too wide: a little inside there is a contact, or they are under way for no more than a moment.
                for (end, inward) in [(from, 1e-4), (to, -1e-4)] {
                    if let Some([apart, step]) = sampled(own, their, end + inward).filter(|_| to - from > 2e-4) {
                        assert!(apart <= reach + 1e-6 + 0.01 * step, "{a} {b} at {end}: {apart} {intervals:?}");
                    }
                }
            }
        }
    }
    assert!(met > 20 && free > 40, "{met} {free}");
}

#[test]
fn arcs_at_constant_speed() {
    audited(&read(InputFormat::Lif, CURVES, 0.3), EdgeDriving { speed: 0.8, acceleration: None });
}

#[test]
fn arcs_from_rest_to_rest() {
    audited(&read(InputFormat::Lif, CURVES, 0.3), EdgeDriving { speed: 1.5, acceleration: Some(0.4) });
}

#[test]
fn lines_from_rest_to_rest() {
    audited(&read(InputFormat::Nav2, WAREHOUSE, 0.4), EdgeDriving { speed: 1.0, acceleration: Some(0.5) });
}

#[test]
fn limits_of_edges_hold_from_rest_to_rest() {
    let mut imported = read(InputFormat::Nav2, WAREHOUSE, 0.4);
    let limits = [None, Some(0.25), Some(2.0), Some(0.6)];
    for (edge, limit) in imported.layout.edges.iter_mut().zip(limits.into_iter().cycle()) {
        edge.speed = [limit; 2];
    }
    for acceleration in [None, Some(0.5)] {
        audited(&imported, EdgeDriving { speed: 1.0, acceleration });
    }
}

#[test]
fn limits_of_rotation_hold_at_constant_speed() {
    let mut imported = read(InputFormat::Lif, CURVES, 0.3);
    for (edge, limit) in imported.layout.edges.iter_mut().zip([None, Some(0.1), Some(0.4)].into_iter().cycle()) {
        edge.rotation = limit;
    }
    audited(&imported, EdgeDriving { speed: 0.8, acceleration: None });
}

#[test]
fn limits_of_rotation_hold_from_rest_to_rest() {
    let vehicle = read(InputFormat::Lif, CURVES, 0.3).vehicle;
    let shape = PathSegment::arc(2.0, 1.5);
    let mut edge =
        LayoutEdge::new(ElementId::Number(1), [0, 1], vec![PlacedSegment { start: [0.0; 2], heading: 0.0, shape }]);
    edge.rotation = Some(0.1);
    // 1.5 rad at 0.1 rad/s, and what it takes to speed up to 0.2 m/s, and to stop.
    let least = 15.0 + 0.2 / vehicle.acceleration;
    let agent = ride(&vehicle, edge.steps().next().expect("a way"));
    assert!((agent.duration() - least).abs() < 1e-9, "{} {least}", agent.duration());
}

/// Straight edges by the closed form and, with no more than the rounding of a deviation, by the library.
#[test]
fn both_ways_agree() {
    let imported = read(InputFormat::Nav2, WAREHOUSE, 0.4);
    let driving = EdgeDriving { speed: 1.3, acceleration: None };
    let mut bent = imported.clone();
    bent.layout.edges.iter_mut().for_each(|edge| edge.deviation = 1e-12);
    let [closed, general] =
        [&imported, &bent].map(|imported| found(&UnsafeDelayModel::new(imported, driving, false).unwrap()));
    assert!(closed.len() > 500);
    for (ways, intervals) in &closed {
        let [interval] = intervals[..] else { panic!("{ways:?} {intervals:?}") };
        let [other] = general[ways][..] else { panic!("{ways:?} {:?}", general[ways]) };
        let off = (0..2).map(|end| (interval[end] - other[end]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-6, "{ways:?} {interval:?} {other:?}");
    }
    // What only the library finds is a touch.
    for (ways, intervals) in general.iter().filter(|(ways, _)| !closed.contains_key(*ways)) {
        let all: Vec<Interval<f64>> = intervals.iter().map(|[lo, hi]| Interval::new(*lo, *hi)).collect();
        assert!(all.iter().all(|interval| interval.hi - interval.lo < 1e-4), "{ways:?} {all:?}");
    }
}

/// It was left out, as if the vehicle stood at the node itself.
#[test]
fn a_vehicle_that_stands_beside_its_node_is_in_the_way_there() {
    let node = |id: &str, [x, y]: [f64; 2]| serde_json::json!({ "nodeId": id, "mapId": "m", "nodePosition": { "x": x, "y": y }, "vehicleTypeNodeProperties": [] });
    let edge = |id: &str, [from, to]: [&str; 2], trajectory: serde_json::Value| {
        serde_json::json!({ "edgeId": id, "startNodeId": from, "endNodeId": to,
            "vehicleTypeEdgeProperties": [{ "vehicleTypeId": "V", "trajectory": trajectory }] })
    };
    let table = |aside: f64| {
        let points = serde_json::json!([{ "x": 0, "y": 0 }, { "x": 2, "y": 0.5 }, { "x": 5, "y": aside }]);
        let curve = serde_json::json!({ "degree": 2, "controlPoints": points });
        let nodes = [
            node("A", [0.0; 2]),
            node("N", [5.0, 0.0]),
            node("P", [3.0, 0.82]),
            node("Q", [8.0, 0.82]),
            node("S", [5.0, 0.82]),
        ];
        let edges = [edge("curve", ["A", "N"], curve), edge("line", ["P", "Q"], serde_json::Value::Null)];
        let file = serde_json::json!({ "metaInformation": { "projectIdentification": "beside", "lifVersion": "1.0.0" },
            "layouts": [{ "layoutId": "L", "nodes": nodes, "stations": [], "edges": edges }] });
        let imported = read(InputFormat::Lif, &file.to_string(), 0.4);
        let (mut times, mut pairs) = (0, 0);
        let take = |row: Vec<UnsafeRelation>| {
            for found in row {
                // N is the second of the nodes, the line the second of the ways.
                times += usize::from(matches!(found, UnsafeRelation::Times(1, 1, _)));
                pairs += usize::from(matches!(found, UnsafeRelation::Nodes([1, 4])));
            }
            Ok::<(), ImportError>(())
        };
        let delays = UnsafeDelayModel::new(&imported, EdgeDriving { speed: 1.0, acceleration: None }, true).unwrap();
        delays.each(&|_, _| {}, &<[UnsafeRelation]>::to_vec, take).unwrap();
        [times, pairs]
    };
    assert_eq!([table(0.0), table(0.049)], [[0, 0], [1, 1]]);
}
