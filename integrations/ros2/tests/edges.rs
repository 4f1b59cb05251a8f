//! Edges of a route graph that robots are in the way of, and what route servers are told of them.

mod common;

use common::{NOW, Random, at, path};
use pcr_ros2::messages::{DynamicEdgesRequest, DynamicEdgesResponse};
use pcr_ros2::{Closures, Config, EdgeRequests, GraphError, RouteGraph, Watch};
use serde_json::json;
use std::collections::BTreeSet;
use std::time::Duration;

/// A graph of edges with these ids, each with nodes of its own.
fn graph_text(edges: &[(u64, [[f64; 2]; 2])]) -> String {
    let mut features = Vec::new();
    for (place, (id, ends)) in edges.iter().enumerate() {
        let nodes = [2 * place, 2 * place + 1];
        for (node, end) in nodes.iter().zip(ends) {
            let geometry = json!({ "type": "Point", "coordinates": end });
            features
                .push(json!({ "type": "Feature", "properties": { "id": node, "frame": "map" }, "geometry": geometry }));
        }
        let geometry = json!({ "type": "MultiLineString", "coordinates": [ends] });
        let properties = json!({ "id": id, "startid": nodes[0], "endid": nodes[1] });
        features.push(json!({ "type": "Feature", "properties": properties, "geometry": geometry }));
    }
    json!({ "type": "FeatureCollection", "features": features }).to_string()
}

/// Robots "0", "1" and so on with these footprints, of which each is told which edges are closed.
fn watch(footprints: &[String]) -> Watch {
    let robot = |(k, footprint): (usize, &String)| {
        format!(r#"{{ "name": "{k}", "path": "/r{k}/plan", "route_server": "/r{k}/edges", {footprint} }}"#)
    };
    let robots: Vec<String> = footprints.iter().enumerate().map(robot).collect();
    let config = format!(
        r#"{{ "frame": "map", "max_age": 30, "route_graph": {{ "file": "g", "stands": 10 }}, "robots": [{}] }}"#,
        robots.join(", ")
    );
    Watch::new(Config::from_json(&config).expect("a configuration"))
}

fn disc(radius: f64, margin: f64) -> String {
    format!(r#""radius": {radius}, "margin": {margin}"#)
}

fn rectangle(long: f64, wide: f64) -> String {
    let (x, y) = (long / 2.0, wide / 2.0);
    format!(r#""outline": [[{}, {}], [{x}, {}], [{x}, {y}], [{}, {y}]], "margin": 0"#, -x, -y, -y, -x)
}

fn closures(edges: &[(u64, [[f64; 2]; 2])], robots: usize, stands: f64) -> Closures {
    Closures::new(RouteGraph::read(&graph_text(edges), "map").expect("a graph"), stands, robots)
}

fn closed(watch: &Watch, closures: &mut Closures, robot: usize, seconds: f64) -> Vec<u16> {
    let found = watch.closed_edges(closures, at(seconds))[robot].as_ref().expect("edges");
    found.iter().copied().collect()
}

#[test]
fn discs_that_stand_close_the_edges_that_are_nearer_than_both_radii_and_margins() {
    let (mut random, mut counts) = (Random(7), [0; 2]);
    let watched = watch(&[disc(0.4, 0.1), disc(0.3, 0.05)]);
    for _ in 0..200 {
        let edges: Vec<(u64, [[f64; 2]; 2])> =
            (0..8).map(|k| (100 + k, [[(); 2]; 2].map(|end| end.map(|()| random.between(-2.0, 2.0))))).collect();
        let [x, y, yaw] = [random.between(-2.0, 2.0), random.between(-2.0, 2.0), random.between(-3.0, 3.0)];
        let (mut watch, mut closures) = (watched.clone(), closures(&edges, 2, 0.0));
        watch.take(1, &path(&[(0.0, x, y, yaw)]));
        let found = closed(&watch, &mut closures, 0, 0.0);
        for (id, [from, to]) in edges {
            // The nearest of many points, which lie so dense that no other one is nearer by more than a micrometre.
            let steps = 4000;
            let point = |k: usize, axis: usize| from[axis] + (to[axis] - from[axis]) * k as f64 / steps as f64;
            let nearest = (0..=steps).map(|k| (point(k, 0) - x).hypot(point(k, 1) - y)).fold(f64::INFINITY, f64::min);
            let is_closed = found.contains(&(id as u16));
            if (nearest - 0.85).abs() > 1e-5 {
                assert_eq!(is_closed, nearest < 0.85, "{from:?} {to:?} {x} {y}: {nearest}");
            }
            counts[usize::from(is_closed)] += 1;
        }
    }
    assert!(counts.iter().all(|&count| count > 300), "{counts:?}");
}

#[test]
fn outlines_are_as_they_drive_along_an_edge_and_as_they_stand() {
    let edges = [(1, [[0.0, 0.0], [6.0, 0.0]]), (2, [[3.0, -3.0], [3.0, 3.0]]), (3, [[8.0, 0.0], [8.0, 0.0]])];
    // Half of the width of the one that drives, and of the length of the one that stands across: 0.4 m and 0.9 m.
    let mut watch = watch(&[rectangle(2.0, 0.8), rectangle(1.8, 0.6)]);
    for (y, yaw, expected) in [
        (1.29, std::f64::consts::FRAC_PI_2, &[1, 2][..]),
        (1.32, std::f64::consts::FRAC_PI_2, &[2]),
        (0.69, 0.0, &[1, 2]),
        (0.72, 0.0, &[2]),
    ] {
        let mut closures = closures(&edges, 2, 0.0);
        watch.take(1, &path(&[(0.0, 3.0, y, yaw)]));
        assert_eq!(closed(&watch, &mut closures, 0, 0.0), expected, "{y} {yaw}");
        // On an edge of length 0 a robot may have any heading: what counts is how far both reach, 2.026 m together.
        for (above, expected) in [(y, true), (2.02, true), (2.05, false)] {
            watch.take(1, &path(&[(0.0, 8.0, above, yaw)]));
            assert_eq!(closed(&watch, &mut closures, 0, 0.0).contains(&3), expected, "{above} {yaw}");
        }
    }
}

#[test]
fn edges_are_closed_for_others_once_a_robot_has_stood_and_opened_when_it_moves_on() {
    let edges = [(7, [[0.0, 0.0], [6.0, 0.0]]), (9, [[0.0, 5.0], [6.0, 5.0]])];
    let mut watch = watch(&[disc(0.4, 0.0), disc(0.3, 0.0)]);
    let mut closures = closures(&edges, 2, 10.0);
    let publish = |watch: &mut Watch, seconds: f64, poses: &[common::Timed]| {
        let mut message = path(poses);
        message.header.stamp = at(seconds);
        watch.take(1, &message);
    };
    // Nothing is known before the first message.
    assert_eq!(closed(&watch, &mut closures, 0, 0.0), [0; 0]);
    publish(&mut watch, 0.0, &[(0.0, 2.0, 0.1, 0.0)]);
    assert_eq!(closed(&watch, &mut closures, 0, 0.0), [0; 0]);
    assert_eq!(closed(&watch, &mut closures, 0, 9.9), [0; 0]);
    assert_eq!(closed(&watch, &mut closures, 0, 10.0), [7]);
    // Not for itself: it is the one that is to leave.
    assert_eq!(closed(&watch, &mut closures, 1, 10.0), [0; 0]);
    // It was shoved aside: it has stood all the time.
    publish(&mut watch, 11.0, &[(11.0, 2.0, 4.9, 0.0)]);
    assert_eq!(closed(&watch, &mut closures, 0, 11.0), [9]);
    // Who is silent, or cannot be understood, is still there.
    assert_eq!(closed(&watch, &mut closures, 0, 100.0), [9]);
    watch.take_unreadable(1, "it ends too early".to_owned());
    assert_eq!(closed(&watch, &mut closures, 0, 101.0), [9]);
    publish(&mut watch, 102.0, &[(102.0, 2.0, 4.9, 0.0), (104.0, 2.0, 8.0, 0.0)]);
    assert_eq!(closed(&watch, &mut closures, 0, 102.0), [0; 0]);
    // And once more from the beginning.
    publish(&mut watch, 104.0, &[(104.0, 2.0, 5.0, 0.0)]);
    assert_eq!(closed(&watch, &mut closures, 0, 104.0), [0; 0]);
    publish(&mut watch, 114.0, &[(114.0, 2.0, 5.0, 0.0)]);
    assert_eq!(closed(&watch, &mut closures, 0, 114.0), [9]);
    assert_eq!(NOW, at(0.0));
}

#[test]
fn graphs_whose_edges_could_not_all_be_closed_are_refused() {
    let edge = [[0.0, 0.0], [1.0, 0.0]];
    let read = |edges: &[(u64, [[f64; 2]; 2])]| RouteGraph::read(&graph_text(edges), "map");
    assert!(read(&[(0, edge), (65535, edge)]).is_ok());
    assert_eq!(read(&[(65536, edge)]), Err(GraphError::Edge("65536".to_owned())));
    assert!(matches!(read(&[(4, edge), (4, edge)]), Err(GraphError::Edge(_))));
    let expected = GraphError::Frame { given: "map".to_owned(), expected: "odom".to_owned() };
    assert_eq!(RouteGraph::read(&graph_text(&[(4, edge)]), "odom"), Err(expected));
    for text in ["{", "{}", r#"{ "type": "FeatureCollection", "features": [] }"#] {
        assert!(matches!(RouteGraph::read(text, "map"), Err(GraphError::Unreadable(_))), "{text}");
    }
    // An edge to a node that is not there.
    let text = graph_text(&[(4, edge)]).replace(r#""endid":1"#, r#""endid":17"#);
    assert!(text.contains(r#""endid":17"#), "{text}");
    assert!(matches!(RouteGraph::read(&text, "map"), Err(GraphError::Unreadable(_))));
}

fn edges(ids: &[u16]) -> BTreeSet<u16> {
    ids.iter().copied().collect()
}

fn request(closed: &[u16], opened: &[u16]) -> Option<DynamicEdgesRequest> {
    let adjust_edges = Vec::new();
    Some(DynamicEdgesRequest { closed_edges: closed.to_vec(), opened_edges: opened.to_vec(), adjust_edges })
}

#[test]
fn a_server_is_asked_until_it_has_done_what_is_to_be_done() {
    let second = |seconds: f64| Duration::from_secs_f64(seconds);
    let [done, failed] = [true, false].map(|success| DynamicEdgesResponse { success });
    let mut requests = EdgeRequests::default();
    assert_eq!(requests.due(&edges(&[]), second(100.0)), None);
    assert_eq!(requests.due(&edges(&[3, 5]), second(100.0)), request(&[3, 5], &[]));
    // It has time to answer, and is asked again after that.
    assert!(!requests.is_late(second(101.9)));
    assert_eq!(requests.due(&edges(&[3, 5]), second(101.9)), None);
    assert!(requests.is_late(second(102.0)));
    assert_eq!(requests.due(&edges(&[3, 5]), second(102.0)), request(&[3, 5], &[]));
    // It could not: nothing is open yet, and it is asked again.
    requests.answered(failed, second(102.1));
    assert_eq!(requests.due(&edges(&[3, 5]), second(103.0)), None);
    assert_eq!(requests.due(&edges(&[3, 5]), second(104.0)), request(&[3, 5], &[]));
    // Without an answer edge 3 may be closed: a new request opens it.
    assert_eq!(requests.due(&edges(&[5, 8]), second(104.5)), request(&[5, 8], &[3]));
    requests.answered(done, second(104.6));
    assert_eq!(requests.due(&edges(&[5, 8]), second(114.5)), None);
    // It may have been started anew.
    assert_eq!(requests.due(&edges(&[5, 8]), second(114.6)), request(&[5, 8], &[]));
    requests.answered(done, second(114.7));
    assert_eq!(requests.due(&edges(&[]), second(114.8)), request(&[], &[5, 8]));
    assert_eq!(requests.due(&edges(&[]), second(116.8)), request(&[], &[5, 8]));
    requests.answered(done, second(116.9));
    // An answer that comes twice changes nothing.
    requests.answered(done, second(117.0));
    assert_eq!(requests.due(&edges(&[]), second(1000.0)), None);
    assert!(!requests.is_late(second(1000.0)));
}
