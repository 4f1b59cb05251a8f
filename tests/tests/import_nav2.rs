//! Route graphs of nav2: routes against an independent shortest path, the paths against the polygons they round.

use pcr_core::{Curve, Motion};
use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, Layout, Warnings, layout, scenario};
use pcr_formats::scenario::{MotionSpec, PathSegment, Scenario};
use pcr_planning::exclusion_table::ExclusionTable;
use pcr_planning::fleet::Fleet;
use serde_json::{Value, json};

const WAREHOUSE: &str = include_str!("../data/real/nav2/warehouse_graph.geojson");
const AWS: &str = include_str!("../data/real/nav2/aws_graph.geojson");
const SAMPLE: &str = include_str!("../data/real/nav2/sample_graph.geojson");

fn options(routes: &[&str], corner_radius: f64) -> ImportOptions {
    ImportOptions {
        routes: routes.iter().map(ToString::to_string).collect(),
        radius: Some(0.4),
        speed: Some(1.0),
        acceleration: Some(0.5),
        rotation: Some(0.8),
        rotation_acceleration: Some(1.5),
        corner_radius: Some(corner_radius),
        ..ImportOptions::default()
    }
}

fn read(text: &str) -> (Layout, Vec<String>) {
    let mut warnings = Warnings::default();
    let ImportedLayout { layout, .. } = layout(InputFormat::Nav2, text, &options(&[], 1.0), &mut warnings).unwrap();
    (layout, warnings.lines())
}

fn route(text: &str, routes: &[&str], corner_radius: f64) -> Scenario {
    scenario(InputFormat::Nav2, text, &options(routes, corner_radius), &mut Warnings::default()).unwrap()
}

/// They were taken for metres, as nav2 does: no two edges of a hall had anything in common.
#[test]
fn longitudes_and_latitudes_are_no_metres() {
    let with = |crs: Value| {
        let mut graph: Value = serde_json::from_str(WAREHOUSE).unwrap();
        graph["crs"] = crs;
        layout(InputFormat::Nav2, &graph.to_string(), &options(&[], 1.0), &mut Warnings::default())
            .map(|read| read.layout.edges.len())
            .map_err(|error| error.problem().to_owned())
    };
    let named = |name: &str| with(json!({ "type": "name", "properties": { "name": name } }));
    for name in ["urn:ogc:def:crs:OGC:1.3:CRS84", "urn:ogc:def:crs:EPSG::4326", "EPSG:4326"] {
        let error = named(name).unwrap_err();
        assert!(error.contains(name) && error.contains("has degrees"), "{error}");
    }
    assert!(with(json!("EPSG:4326")).is_err());
    for crs in [Value::Null, json!("EPSG:3857"), json!({ "type": "name", "properties": {} })] {
        assert_eq!(with(crs), named("urn:ogc:def:crs:EPSG::3857"));
    }
    assert!(named("urn:ogc:def:crs:EPSG::25832").is_ok_and(|edges| edges > 0));
}

/// "Nothing excludes anything" would be said of it, although robots at its nodes touch.
#[test]
fn a_layout_without_an_edge_is_refused() {
    let node = |id: u32, x: f64| json!({ "type": "Feature", "properties": { "id": id }, "geometry": { "type": "Point", "coordinates": [x, 0.0] } });
    let text = json!({ "type": "FeatureCollection", "features": [node(0, 0.0), node(1, 0.3)] }).to_string();
    let error = layout(InputFormat::Nav2, &text, &options(&[], 1.0), &mut Warnings::default()).unwrap_err();
    assert_eq!(error.problem(), "there is no edge in it, on which anything could drive");
}

#[test]
fn the_published_graphs_are_read_whole() {
    let (warehouse, warnings) = read(WAREHOUSE);
    let length = |layout: &Layout| layout.edges.iter().map(|edge| edge.length()).sum::<f64>();
    assert_eq!((warehouse.nodes.len(), warehouse.edges.len()), (96, 172));
    assert!((length(&warehouse) - 651.1).abs() < 1e-9);
    // Its drawing was not kept up with its nodes.
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].starts_with("edge 10118, edge 10119, ") && warnings[0].contains("and 10 more: its drawn line"));
    let (aws, warnings) = read(AWS);
    assert_eq!((aws.nodes.len(), aws.edges.len()), (40, 84));
    assert_eq!(warnings, ["edge 112: its length is 0"]);
    let (sample, warnings) = read(SAMPLE);
    assert_eq!((sample.nodes.len(), sample.edges.len(), warnings.len()), (9, 24, 0));
    assert_eq!(sample.edges.iter().filter_map(|edge| edge.speed[0]).collect::<Vec<_>>(), [0.85]);
}

/// Lengths of the shortest ways by the algorithm of Floyd and Warshall.
fn all_pairs(layout: &Layout) -> Vec<Vec<f64>> {
    let count = layout.nodes.len();
    let mut lengths = vec![vec![f64::INFINITY; count]; count];
    for edge in &layout.edges {
        let [from, to] = edge.ends;
        let [a, b] = edge.ends.map(|node| layout.nodes[node].point);
        lengths[from][to] = lengths[from][to].min((a[0] - b[0]).hypot(a[1] - b[1]));
    }
    for (node, row) in lengths.iter_mut().enumerate() {
        row[node] = 0.0;
    }
    for via in 0..count {
        for from in 0..count {
            for to in 0..count {
                let through = lengths[from][via] + lengths[via][to];
                lengths[from][to] = lengths[from][to].min(through);
            }
        }
    }
    lengths
}

#[test]
fn routes_are_shortest_ways() {
    for text in [WAREHOUSE, AWS, SAMPLE] {
        let (layout, _) = read(text);
        let lengths = all_pairs(&layout);
        for from in (0..layout.nodes.len()).step_by(7) {
            for to in (0..layout.nodes.len()).step_by(5) {
                let name = format!("{}:{}", layout.nodes[from].id, layout.nodes[to].id);
                let outcome = scenario(InputFormat::Nav2, text, &options(&[&name], 0.0), &mut Warnings::default());
                if lengths[from][to].is_infinite() {
                    assert_eq!(
                        outcome.unwrap_err().problem().to_owned(),
                        format!("route {name}: there is no way from node to node")
                    );
                } else {
                    // Turns in place are arcs of a nanometre.
                    let length = outcome.unwrap().agents[0].length();
                    assert!((length - lengths[from][to]).abs() < 1e-6, "{name}: {length} {}", lengths[from][to]);
                }
            }
        }
    }
}

/// Calls with the motion of a route.
fn with_motion(scenario: &Scenario, agent: usize, mut test: impl FnMut(&Motion<'_, f64>)) {
    let fleet = Fleet::<f64>::new(scenario).unwrap();
    test(&fleet.motions()[agent]);
}

#[test]
fn a_route_cuts_its_corners_by_what_the_radius_allows() {
    let (layout, _) = read(WAREHOUSE);
    let routes = ["0:50", "90:7", "20:80", "3:95"];
    let scenario = route(WAREHOUSE, &routes, 1.0);
    let again = Scenario::from_json(&scenario.to_json()).unwrap();
    for (read, written) in again.agents.iter().zip(&scenario.agents) {
        // A profile is scaled by the last digit as it is read.
        assert_eq!((read.start, &read.path, read.radius), (written.start, &written.path, written.radius));
    }
    for (agent, name) in routes.iter().enumerate() {
        let ends = name.split(':').map(|node| layout.nodes[layout.node(node).unwrap()].point).collect::<Vec<_>>();
        with_motion(&scenario, agent, |motion| {
            let path = motion.path();
            let (first, last) = (path.point_at(0.0), path.point_at(path.length()));
            assert!((first.x - ends[0][0]).hypot(first.y - ends[0][1]) < 1e-12);
            assert!((last.x - ends[1][0]).hypot(last.y - ends[1][1]) < 1e-8, "{name}");
            let mut arcs = 0;
            for segment in path.segments() {
                if let Curve::Arc { radius, .. } = segment.curve() {
                    assert_eq!(radius, 1.0);
                    arcs += 1;
                }
            }
            assert!(arcs > 0, "{name}");
            // No point of it is farther from the edges than the middle of the arc in a right angle, the sharpest corner.
            for k in 0..=1000 {
                let point = path.point_at(path.length() * f64::from(k) / 1000.0);
                let distance = |edge: &pcr_formats::import::LayoutEdge| {
                    let [a, b] = edge.ends.map(|node| layout.nodes[node].point);
                    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
                    let along = ((point.x - a[0]) * dx + (point.y - a[1]) * dy) / (dx * dx + dy * dy).max(1e-300);
                    let along = along.clamp(0.0, 1.0);
                    (point.x - a[0] - along * dx).hypot(point.y - a[1] - along * dy)
                };
                let nearest = layout.edges.iter().map(distance).fold(f64::INFINITY, f64::min);
                assert!(nearest < 2.0_f64.sqrt() - 1.0 + 1e-9, "{name}: {nearest}");
            }
        });
    }
}

#[test]
fn where_no_arc_fits_the_vehicle_stops_and_turns() {
    // Edges of 1 m cannot have arcs of 1 m radius.
    let scenario = route(SAMPLE, &["0:1", "0:4"], 1.0);
    let turning = &scenario.agents[1];
    let MotionSpec::Profile { pieces, .. } = &turning.motion else { panic!("{turning:?}") };
    let turns: Vec<f64> =
        turning.path.iter().filter(|segment| segment.letter() == 'T').map(|turn| turn.sweep().abs()).collect();
    assert!(!turns.is_empty());
    // By hand: 1 m at 0.5 m/s² up to 1/√2 m/s, and a turn at 1.5 rad/s² up to 0.8 rad/s.
    let turn = |angle: f64| if angle > 0.64 / 1.5 { angle / 0.8 + 0.8 / 1.5 } else { 2.0 * (angle / 1.5).sqrt() };
    let lines = turning.path.iter().filter(|segment| segment.letter() == 'S').count();
    let expected = lines as f64 * 2.0 * 2.0_f64.sqrt() + turns.iter().map(|angle| turn(*angle)).sum::<f64>();
    let duration: f64 = pieces.iter().map(|piece| piece.duration).sum();
    // The first edge has a speed limit of 0.85 m/s, more than is reached.
    assert!((duration - expected).abs() < 1e-8, "{duration} {expected}");
    assert_eq!(Scenario::from_json(&scenario.to_json()).unwrap().agents.len(), 2);
    with_motion(&scenario, 1, |motion| {
        let corner = motion.path().point_at(1.0);
        let stands = 2.0 * 2.0_f64.sqrt() + 0.5 * turn(turns[0]);
        let at = motion.position_at(stands);
        assert!((at.x - corner.x).hypot(at.y - corner.y) < 1e-8 && motion.speed_at(stands) < 1e-8);
    });
}

#[test]
fn speed_limits_are_fractions_or_percentages() {
    let slow = SAMPLE.replace("0.85", "40");
    assert_ne!(slow, SAMPLE);
    let scenario = route(&slow, &["0:1"], 1.0);
    let expected = [(0.8, 0.5), (1.7, 0.0), (0.8, -0.5)];
    assert!(matches!(scenario.agents[0].motion, MotionSpec::Profile { .. }));
    let (_, pieces) = scenario.agents[0].motion.pieces(scenario.agents[0].length());
    assert_eq!(pieces.len(), 3);
    for ((duration, accel), (of, at)) in pieces.iter().zip(expected) {
        assert!((duration - of).abs() < 1e-12 && (accel - at).abs() < 1e-12);
    }
}

#[test]
fn wrong_routes_are_named() {
    let failed = |routes: &[&str]| {
        scenario(InputFormat::Nav2, WAREHOUSE, &options(routes, 1.0), &mut Warnings::default())
            .unwrap_err()
            .problem()
            .to_owned()
    };
    assert_eq!(failed(&["0:999"]), "route 0:999: there is no node 999");
    assert_eq!(failed(&["x:1@3"]), "route x:1@3: there is no node x");
    assert_eq!(failed(&["0:1@noon"]), "route 0:1@noon: FROM:TO or FROM:TO@TIME is expected");
    assert_eq!(failed(&["0"]), "route 0: FROM:TO or FROM:TO@TIME is expected");
    assert!(failed(&[]).starts_with("a layout has no agents; ask for routes with --route FROM:TO"));
    let late = route(WAREHOUSE, &["0:1@12.5", "1:1"], 1.0);
    assert_eq!((late.agents[0].t_start, late.agents[1].path.len()), (12.5, 0));
}

const ONE_ID: &str = include_str!("../data/cases/one-id-two-edges.geojson");

fn failed(graph: &Value) -> String {
    layout(InputFormat::Nav2, &graph.to_string(), &options(&[], 1.0), &mut Warnings::default())
        .unwrap_err()
        .problem()
        .to_owned()
}

#[test]
fn two_edges_of_one_id_are_both_there() {
    let mut warnings = Warnings::default();
    let imported = layout(InputFormat::Nav2, ONE_ID, &options(&[], 1.0), &mut warnings).unwrap();
    let ids: Vec<String> = imported.layout.edges.iter().map(|edge| edge.id.to_string()).collect();
    assert_eq!(ids, ["101", "100", "101#2"]);
    assert!(
        warnings.lines().contains(&"edge 101: several have this name; one of them is called 101#2 here".to_owned())
    );
    let table = ExclusionTable::compute(&imported, false).unwrap();
    let [lock] = &table.locks[..] else { panic!("{:?}", table.locks) };
    assert_eq!((lock.a.to_string(), lock.b.to_string()), ("100".into(), "101#2".into()));
    // Where it came from is told with the answer.
    assert!(table.warnings.iter().any(|line| line.contains("101#2")), "{:?}", table.warnings);
    // The other way round as well, and where the first one is in the way.
    let scenario = route(ONE_ID, &["4:5", "2:3"], 1.0);
    assert_eq!(scenario.agents.iter().map(|agent| agent.length()).collect::<Vec<_>>(), [10.0, 10.0]);
    assert!(scenario.warnings.iter().any(|line| line.contains("101#2")));
}

#[test]
fn copies_are_there_once_and_edges_join_the_last_node_of_an_id() {
    let mut graph: Value = serde_json::from_str(ONE_ID).unwrap();
    let features = graph["features"].as_array_mut().unwrap();
    let copies = [features[0].clone(), features[7].clone()];
    features.extend(copies);
    let (whole, warnings) = read(&graph.to_string());
    assert_eq!((whole.nodes.len(), whole.edges.len()), (6, 3));
    for name in ["node 0", "edge 100"] {
        assert!(warnings.iter().any(|line| line.contains(name) && line.ends_with("given twice, the same each time")));
    }
    // The loader of nav2 goes on with the last node of an id: edge 100 then begins at (0, 1).
    let mut moved = graph["features"][0].clone();
    moved["geometry"]["coordinates"] = json!([0, 1]);
    graph["features"].as_array_mut().unwrap().push(moved);
    let (whole, _) = read(&graph.to_string());
    assert_eq!(
        whole.nodes.iter().map(|node| node.id.to_string()).collect::<Vec<_>>(),
        ["0", "1", "2", "3", "4", "5", "0#2"]
    );
    let edge = whole.edges.iter().find(|edge| edge.id.to_string() == "100").unwrap();
    assert_eq!(whole.nodes[edge.ends[0]].point, [0.0, 1.0]);
    assert!((edge.length() - 101.0_f64.sqrt()).abs() < 1e-12);
    // Which is a copy of the first one here.
    let first = graph["features"][0].clone();
    graph["features"].as_array_mut().unwrap().push(first);
    let (whole, _) = read(&graph.to_string());
    let edge = whole.edges.iter().find(|edge| edge.id.to_string() == "100").unwrap();
    assert_eq!((whole.nodes[edge.ends[0]].point, edge.length()), ([0.0, 0.0], 10.0));
}

#[test]
fn what_cannot_be_read_is_refused_by_name() {
    let changed = |pointer: &str, value: Value| {
        let mut graph: Value = serde_json::from_str(ONE_ID).unwrap();
        *graph.pointer_mut(pointer).unwrap() = value;
        graph
    };
    let lost = "; --partial leaves that out";
    let unknown = changed("/features/7/properties/endid", json!(44));
    assert_eq!(failed(&unknown), format!("edge 100, endid: there is no node 44{lost}"));
    let partial = ImportOptions { partial: true, ..options(&[], 1.0) };
    let mut warnings = Warnings::default();
    let rest = layout(InputFormat::Nav2, &unknown.to_string(), &partial, &mut warnings).unwrap().layout;
    assert_eq!(rest.edges.iter().map(|edge| edge.id.to_string()).collect::<Vec<_>>(), ["101", "101#2"]);
    assert_eq!(rest.warnings, warnings.all());
    assert!(
        rest.warnings.contains(&"edge 100, endid: there is no node 44: left out [left-out]".to_owned()),
        "{:?}",
        rest.warnings
    );
    let nowhere = changed("/features/0/geometry/coordinates", json!([0]));
    let failed_at = failed(&nowhere);
    assert!(failed_at.starts_with("feature 1, geometry, coordinates: two numbers are expected; "), "{failed_at}");
    assert!(failed_at.contains("edge 100, startid: there is no node 0"), "{failed_at}");
    let nameless = changed("/features/1/properties/id", json!(-1));
    assert!(failed(&nameless).starts_with("feature 2, properties, id: not a whole number from 0; "));
    let elsewhere = changed("/features/1/properties/frame", json!("odom"));
    assert_eq!(failed(&elsewhere), "graph: its nodes are in several frames (map, odom); one has to be given");
    // Areas are no part of the graph, for nav2 either.
    let (_, warnings) = read(&{
        let mut graph: Value = serde_json::from_str(ONE_ID).unwrap();
        let area = json!({ "type": "Feature", "properties": {}, "geometry": { "type": "Polygon", "coordinates": [] } });
        graph["features"].as_array_mut().unwrap().push(area);
        graph.to_string()
    });
    assert!(warnings.iter().any(|line| line.starts_with("feature 10: it is no point and no line")), "{warnings:?}");
}

#[test]
fn speed_limits_end_at_100_percent() {
    let limited = |limit: Value| {
        let mut graph: Value = serde_json::from_str(ONE_ID).unwrap();
        graph["features"][7]["properties"]["metadata"] = json!({ "speed_limit": limit });
        let (layout, warnings) = read(&graph.to_string());
        let edge = layout.edges.iter().find(|edge| edge.id.to_string() == "100").unwrap().speed[0];
        (edge, warnings.iter().any(|line| line.starts_with("edge 100: its speed_limit is not above 0 and up to 100")))
    };
    for (limit, expected) in [(json!(1), 1.0), (json!(0.5), 0.5), (json!(2), 0.02), (json!(100), 1.0)] {
        assert_eq!(limited(limit.clone()), (Some(expected), false), "{limit}");
    }
    for limit in [json!(0), json!(-0.5), json!(100.5), json!(1e4), json!("fast")] {
        assert_eq!(limited(limit.clone()), (None, true), "{limit}");
    }
}

#[test]
fn a_route_that_can_be_read_in_two_ways_is_refused() {
    let mut graph: Value = serde_json::from_str(ONE_ID).unwrap();
    for (node, name) in [(0, "a"), (1, "b:c"), (2, "a:b"), (3, "c"), (4, "twin"), (5, "twin")] {
        graph["features"][node]["properties"]["name"] = json!(name);
    }
    let failed = |route: &str| {
        let options = options(&[route], 1.0);
        scenario(InputFormat::Nav2, &graph.to_string(), &options, &mut Warnings::default())
            .unwrap_err()
            .problem()
            .to_owned()
    };
    assert_eq!(failed("a:b:c"), "route a:b:c: there are nodes for more than one reading of it");
    assert_eq!(failed("twin:a"), "route twin:a: 2 nodes have the name twin");
    assert_eq!(failed("a:b:c@7"), "route a:b:c@7: there are nodes for more than one reading of it");
}

#[test]
fn ids_speeds_and_directions_are_those_of_the_file() {
    assert_eq!(InputFormat::detect("graph.json".as_ref(), ONE_ID), Some(InputFormat::Nav2));
    assert_eq!(InputFormat::detect("graph.json".as_ref(), r#"{ "type": "Feature" }"#), None);
    let mut graph: Value = serde_json::from_str(ONE_ID).unwrap();
    // Whole numbers, as texts or with a decimal point as well.
    (graph["features"][0]["properties"]["id"], graph["features"][1]["properties"]["id"]) = (json!("0"), json!(1.0));
    graph["features"][7]["properties"]["metadata"] = json!({ "speed_limit": 0.5 });
    graph["features"][8]["properties"]["metadata"] = json!({ "speed_limit": 50 });
    let fast = ImportOptions { speed: Some(3.0), ..options(&[], 1.0) };
    let whole = layout(InputFormat::Nav2, &graph.to_string(), &fast, &mut Warnings::default()).unwrap().layout;
    let speeds: Vec<Option<f64>> = whole.edges.iter().map(|edge| edge.speed[0]).collect();
    assert_eq!(speeds, [None, Some(1.5), Some(1.5)]);
    assert!(whole.edges.iter().all(|edge| !edge.is_two_way() && edge.curve.len() == 1));
    graph["features"][1]["properties"]["id"] = json!(1.5);
    assert!(failed(&graph).starts_with("feature 2, properties, id: not a whole number from 0; "));
}

/// A node without a frame is in that of the map.
#[test]
fn nodes_are_in_one_frame() {
    let node = |id: u32, x: f64, frame: Value| {
        json!({ "type": "Feature", "properties": { "id": id, "frame": frame },
            "geometry": { "type": "Point", "coordinates": [x, 0.0] } })
    };
    let edge = json!({ "type": "Feature", "properties": { "id": 9, "startid": 0, "endid": 1 },
        "geometry": { "type": "MultiLineString", "coordinates": [[[0.0, 0.0], [5.0, 0.0]]] } });
    let read = |frames: [Value; 2]| {
        let [a, b] = frames;
        let graph = json!({ "type": "FeatureCollection", "features": [node(0, 0.0, a), node(1, 5.0, b), edge] });
        let read = layout(InputFormat::Nav2, &graph.to_string(), &options(&[], 1.0), &mut Warnings::default());
        read.map(|imported| imported.layout.edges.len()).map_err(|error| error.problem().to_owned())
    };
    for frames in [
        [json!("map"), json!("map")],
        [json!("map"), Value::Null],
        [Value::Null, Value::Null],
        [json!("odom"), json!("odom")],
    ] {
        assert_eq!(read(frames), Ok(1));
    }
    let several = "graph: its nodes are in several frames (map, odom); one has to be given";
    assert_eq!(read([Value::Null, json!("odom")]), Err(several.to_owned()));
    assert!(read([json!(7), json!("map")]).unwrap_err().starts_with("node 0, frame: "));
}

/// nav2 rounds no corners by default (`smooth_corners`).
#[test]
fn corners_are_rounded_only_if_that_is_asked_for() {
    let arcs = |corner_radius: Option<f64>| {
        let mut warnings = Warnings::default();
        let options = ImportOptions { corner_radius, ..options(&["0:50"], 1.0) };
        let scenario = scenario(InputFormat::Nav2, WAREHOUSE, &options, &mut warnings).unwrap();
        assert!(warnings.lines().iter().all(|line| !line.starts_with("corners")), "{:?}", warnings.lines());
        let is_arc = |segment: &&PathSegment| matches!(segment, PathSegment::Arc { radius, .. } if *radius == 1.0);
        scenario.agents[0].path.iter().filter(is_arc).count()
    };
    assert_eq!((arcs(None), arcs(Some(0.0))), (0, 0));
    assert!(arcs(Some(1.0)) > 0);
}

/// A radius has an effect if it rounds a corner, and 0 is what is done anyway.
#[test]
fn a_corner_radius_is_of_use_where_a_corner_is_rounded_with_it() {
    // A corner with room for the usual arc (1.52 m and 3 m); one of 5 mrad; none.
    let slight = two_edges([[0.0, 0.0], [10.0, 0.0], [20.0, 0.05]], [100, 100]);
    let other = include_str!("../data/small/roadmap.xml");
    for (format, text, route, radius, is_used) in [
        (InputFormat::Nav2, AWS, "11:13", 0.0, true),
        (InputFormat::Nav2, AWS, "11:13", 0.5, true),
        (InputFormat::Nav2, AWS, "11:13", 1.0, true),
        (InputFormat::Nav2, AWS, "11:13", 2.0, true),
        (InputFormat::Nav2, AWS, "11:12", 0.0, true),
        (InputFormat::Nav2, AWS, "11:12", 2.0, false),
        (InputFormat::Nav2, &slight, "0:2", 0.0, true),
        (InputFormat::Nav2, &slight, "0:2", 1000.0, true),
        (InputFormat::Nav2, &slight, "0:2", 10000.0, false),
        (InputFormat::Ccbs, other, "n0:n2", 0.0, true),
        (InputFormat::Ccbs, other, "n0:n2", 0.5, true),
        (InputFormat::Ccbs, other, "n0:n2", 1000.0, false),
    ] {
        let mut warnings = Warnings::default();
        let options = options(&[route], radius);
        scenario(format, text, &options, &mut warnings).unwrap();
        let unused = options.unused(&[&warnings]).map(|(option, _)| option);
        assert_eq!(unused, (!is_used).then_some("--corner-radius"), "{format} {route} {radius}");
    }
}

/// A graph of two edges one after the other, with speed limits in percent.
fn two_edges(nodes: [[f64; 2]; 3], percents: [u64; 2]) -> String {
    let node = |id: u64, at: [f64; 2]| json!({ "type": "Feature", "properties": { "id": id, "frame": "map" }, "geometry": { "type": "Point", "coordinates": at } });
    let edge = |id: u64, [from, to]: [u64; 2], percent: u64| {
        json!({ "type": "Feature", "properties": { "id": id, "startid": from, "endid": to,
            "metadata": { "speed_limit": percent } }, "geometry": { "type": "MultiLineString", "coordinates": [] } })
    };
    let nodes = [0, 1, 2].map(|k| node(k as u64, nodes[k]));
    let edges = [edge(10, [0, 1], percents[0]), edge(11, [1, 2], percents[1])];
    json!({ "type": "FeatureCollection", "features": ([&nodes[..], &edges].concat()) }).to_string()
}

/// The arc was as fast as the edge before it allows.
#[test]
fn a_rounded_corner_has_the_limits_of_both_edges() {
    for (percents, arcs) in [([50, 50], 1), ([100, 5], 2), ([5, 100], 2)] {
        let scenario = route(&two_edges([[-5.0, 0.0], [0.0, 0.0], [0.0, 5.0]], percents), &["0:2"], 1.0);
        assert_eq!(scenario.agents[0].path.len(), 2 + arcs);
        with_motion(&scenario, 0, |motion| {
            // Half of the arc from either edge: the node, as it were.
            let corner = 4.0 + std::f64::consts::FRAC_PI_4;
            let phases = motion.profile().phases();
            for (k, percent) in percents.iter().enumerate() {
                let own = phases.iter().filter(|phase| {
                    let middle = phase.length().middle();
                    if k == 0 { middle < corner } else { middle > corner }
                });
                let fastest = own.flat_map(|phase| phase.speed()).fold(0.0, f64::max);
                assert!(fastest <= *percent as f64 / 100.0 + 1e-6, "{percents:?}: {fastest}");
            }
        });
    }
}
