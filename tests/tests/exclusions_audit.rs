//! Files that look as if they kept vehicles apart and do not: what an audit must not be taken in by.

use pcr_exclusions::{ExclusionAudit, ExclusionFormat, WriteOptions, read, write};
use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, Warnings, layout};
use pcr_planning::exclusion_table::ExclusionTable;
use serde_json::{Value, json};

const FLEET: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json");

fn disc(radius: f64) -> ImportOptions {
    ImportOptions { radius: Some(radius), ..ImportOptions::default() }
}

fn imported(format: InputFormat, text: &str, options: &ImportOptions) -> ImportedLayout {
    let mut imported = layout(format, text, options, &mut Warnings::default()).unwrap();
    if imported.layout.name.is_empty() {
        imported.layout.name = "map".into();
    }
    imported
}

/// A route graph: nodes from 1 on, edges from 10 on.
fn graph(nodes: &[[f64; 2]], edges: &[[usize; 2]]) -> Value {
    let mut features = Vec::new();
    for (k, at) in nodes.iter().enumerate() {
        let geometry = json!({ "type": "Point", "coordinates": at });
        features.push(json!({ "type": "Feature", "properties": { "id": k + 1 }, "geometry": geometry }));
    }
    for (k, [from, to]) in edges.iter().enumerate() {
        let geometry = json!({ "type": "LineString", "coordinates": [nodes[from - 1], nodes[to - 1]] });
        let properties = json!({ "id": 10 + k, "startid": from, "endid": to });
        features.push(json!({ "type": "Feature", "properties": properties, "geometry": geometry }));
    }
    json!({ "type": "FeatureCollection", "features": features })
}

/// One set of zones.
fn set(map: &str, zones: &[(&str, &str, &[[f64; 2]])]) -> Value {
    let zone = |(name, kind, corners): &(&str, &str, &[[f64; 2]])| {
        let vertices: Vec<Value> = corners.iter().map(|[x, y]| json!({ "x": x, "y": y })).collect();
        json!({ "zoneId": name, "zoneType": kind, "vertices": vertices })
    };
    json!({ "zoneSet": { "mapId": map, "zoneSetId": "z", "zones": zones.iter().map(zone).collect::<Vec<_>>() } })
}

fn audit(imported: &ImportedLayout, target: ExclusionFormat, text: &str) -> ExclusionAudit {
    let locks = ExclusionTable::compute(imported, true).unwrap();
    ExclusionAudit::run(imported, &locks, &read(target, text, imported).unwrap(), target).unwrap()
}

fn refused(imported: &ImportedLayout, target: ExclusionFormat, text: &str) -> String {
    read(target, text, imported).unwrap_err().to_string()
}

/// One edge of 10 m along the x axis.
fn lane(options: &ImportOptions) -> ImportedLayout {
    imported(InputFormat::Nav2, &graph(&[[0.0, 0.0], [10.0, 0.0]], &[[1, 2]]).to_string(), options)
}

/// A zone beside the lane, from this distance on.
fn beside(from: f64) -> [[f64; 2]; 4] {
    [[-2.0, from], [12.0, from], [12.0, 2.0], [-2.0, 2.0]]
}

#[test]
fn a_zone_beside_a_lane_counts_if_contours_reach_into_it() {
    let suffices = |options: &ImportOptions, kind: &str, from: f64| {
        audit(&lane(options), ExclusionFormat::Vda5050, &set("map", &[("s", kind, &beside(from))]).to_string())
            .suffices()
    };
    let with_margin = ImportOptions { margin: Some(0.05), ..disc(0.4) };
    for kind in ["RELEASE", "BLOCKED"] {
        assert!(suffices(&disc(0.4), kind, 0.399), "{kind}");
        // Nobody ever enters it, nor with half a step along the edge, nor with what is kept free around.
        assert!(!suffices(&disc(0.4), kind, 0.400_001) && !suffices(&disc(0.4), kind, 0.42), "{kind}");
        assert!(suffices(&with_margin, kind, 0.349) && !suffices(&with_margin, kind, 0.351), "{kind}");
    }
    // The contour reaches 0.4 m to the sides, the disc around it 1.4 m.
    let outline = ImportOptions { fleet: Some(FLEET.into()), ..ImportOptions::default() };
    assert!(!suffices(&outline, "RELEASE", 0.7) && !suffices(&outline, "BLOCKED", 0.7));
    assert!(suffices(&outline, "RELEASE", 0.39));
    assert!(suffices(&outline, "RELEASE", -1.5), "all of the contour");
}

/// A vehicle that stands at a node was reported although none may be there.
#[test]
fn nobody_stands_at_a_node_in_a_blocked_zone() {
    let text = graph(&[[0.0, 0.0], [10.0, 0.0], [10.7, -5.0], [10.7, 5.0]], &[[1, 2], [3, 4]]).to_string();
    let imported = imported(InputFormat::Nav2, &text, &disc(0.4));
    let zone = |x: [f64; 2], y: [f64; 2]| [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]];
    let (along, across, end) =
        (zone([-1.0, 10.0], [-0.3, 0.3]), zone([10.5, 10.9], [-6.0, 6.0]), zone([9.0, 10.0], [-0.3, 0.3]));
    let mut zones: Vec<(&str, &str, &[[f64; 2]])> = vec![("a", "RELEASE", &along), ("b", "RELEASE", &across)];
    let of = |zones: &[(&str, &str, &[[f64; 2]])]| {
        audit(&imported, ExclusionFormat::Vda5050, &set("map", zones).to_string())
    };
    assert!(!of(&zones).suffices(), "without it one can stand there");
    zones.push(("c", "BLOCKED", &end));
    let blocked = of(&zones);
    assert!(blocked.suffices(), "{:?}", blocked.gaps);
}

#[test]
fn where_a_zone_ends_beside_the_lane_two_may_stand_there() {
    let notch = |depth: f64| -> Vec<[f64; 2]> {
        vec![[-2.0, -2.0], [1.2, -2.0], [1.2, depth], [8.8, depth], [8.8, -2.0], [12.0, -2.0], [12.0, 3.0], [-2.0, 3.0]]
    };
    let of = |depth: f64| {
        audit(&lane(&disc(0.4)), ExclusionFormat::Vda5050, &set("map", &[("u", "RELEASE", &notch(depth))]).to_string())
    };
    assert!(of(0.399).suffices());
    let open = of(0.42);
    assert_eq!(open.gaps.len(), 1, "{:?}", open.gaps);
    // Beside the ends of the notch the disc reaches into the zone; one of the two is between them.
    let gap = &open.gaps[0];
    assert!(
        (1.599..=8.401).contains(&gap.at[0]) && gap.relation == "same" && (gap.depth - 0.8).abs() < 1e-6,
        "{gap:?}"
    );
}

#[test]
fn zones_that_are_a_little_smaller_do_not_keep_the_next_lane_apart() {
    let text = graph(&[[0.0, 0.0], [10.0, 0.0], [0.0, 0.59], [10.0, 0.59]], &[[1, 2], [3, 4]]).to_string();
    let imported = imported(InputFormat::Nav2, &text, &disc(0.3));
    let zones = |half: f64| {
        let around = |y: f64| [[-0.3, y - half], [10.3, y - half], [10.3, y + half], [-0.3, y + half]];
        set("map", &[("10", "RELEASE", &around(0.0)), ("11", "RELEASE", &around(0.59))]).to_string()
    };
    assert!(audit(&imported, ExclusionFormat::Vda5050, &zones(0.3)).suffices());
    let open = audit(&imported, ExclusionFormat::Vda5050, &zones(0.282));
    assert!(open.gaps.iter().any(|gap| gap.relation == "apart" && (gap.depth - 0.01).abs() < 1e-6), "{:?}", open.gaps);
}

#[test]
fn an_edge_from_map_to_map_needs_zones_on_both() {
    let node = |id: &str, x: f64, map: &str| {
        json!({ "nodeId": id, "nodePosition": { "x": x, "y": 0.0 }, "mapId": map,
            "vehicleTypeNodeProperties": [{ "vehicleTypeId": "A" }] })
    };
    let edge = json!({ "edgeId": "e", "startNodeId": "a", "endNodeId": "b", "vehicleTypeEdgeProperties": [{ "vehicleTypeId": "A" }] });
    let text = json!({
        "metaInformation": { "projectIdentification": "p", "creator": "c", "exportTimestamp": "2024-01-01T00:00:00Z", "lifVersion": "1.0.0" },
        "layouts": [{ "layoutId": "l", "layoutVersion": "1", "nodes": [node("a", 0.0, "M1"), node("b", 10.0, "M2")], "edges": [edge], "stations": [] }]
    });
    let text = text.to_string();
    let imported = imported(InputFormat::Lif, &text, &disc(0.4));
    let all = [[-5.0, -5.0], [15.0, -5.0], [15.0, 5.0], [-5.0, 5.0]];
    let end = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    for kind in ["RELEASE", "BLOCKED"] {
        let of = |first: &[[f64; 2]], second: &[[f64; 2]]| {
            let sets = json!([set("M1", &[("x", kind, first)]), set("M2", &[("y", kind, second)])]);
            audit(&imported, ExclusionFormat::Vda5050, &sets.to_string()).gaps.len()
        };
        assert_eq!(of(&all, &all), 0, "{kind}");
        assert!(of(&end, &all) > 0 && of(&all, &end) > 0, "{kind}");
    }
    let settings = WriteOptions { target: ExclusionFormat::Vda5050, split: None, envelopes: None };
    assert!(write(InputFormat::Lif, &text, &disc(0.4), "map", &settings).unwrap().2.suffices());
}

#[test]
fn zones_hold_whatever_the_margin_the_outline_and_the_cut() {
    // Where contours need not reach into the zone of the other one to be within their margins: who is in a zone as a whole keeps them off.
    let text = graph(&[[0.0, 0.0], [10.0, 1.0], [0.0, 0.59], [10.0, 1.9], [5.0, 9.0]], &[[1, 2], [3, 4], [2, 5]]);
    let outline = ImportOptions { fleet: Some(FLEET.into()), margin: Some(0.1), ..ImportOptions::default() };
    for (options, splits) in [
        (disc(0.3), &[None, Some(0.7)][..]),
        (ImportOptions { margin: Some(0.5), ..disc(0.3) }, &[None, Some(0.7)]),
        (outline, &[None, Some(0.7)]),
    ] {
        for &split in splits {
            let settings = WriteOptions { target: ExclusionFormat::Vda5050, split, envelopes: None };
            let (_, written, audit) = write(InputFormat::Nav2, &text.to_string(), &options, "map", &settings).unwrap();
            assert!(audit.suffices() && written.can_touch > 3, "{written:?}");
        }
    }
}

#[test]
fn what_is_there_twice_is_refused() {
    let imported = lane(&disc(0.4));
    let half = set("map", &[("s", "RELEASE", &beside(0.0))]);
    let twice = json!([half, half]).to_string();
    assert!(refused(&imported, ExclusionFormat::Vda5050, &twice).contains("mapId map: a second one of this map"));
    let same = set("map", &[("s", "RELEASE", &beside(0.0)), ("s", "RELEASE", &beside(-1.0))]).to_string();
    assert!(refused(&imported, ExclusionFormat::Vda5050, &same).contains("zone s, zoneId: there is another one"));
    let keys = half.to_string().replacen("\"zones\":", "\"zones\":[],\"zones\":", 1);
    assert!(refused(&imported, ExclusionFormat::Vda5050, &keys).contains("\"zones\" is there twice"));
    // What is left out is no set without zones, and a zone without a name is no second one of another's.
    let without = |pointer: &str, field: &str, value: Value| {
        let mut two = json!([set("map", &[("s", "RELEASE", &beside(0.0)), ("t", "RELEASE", &beside(-1.0))])]);
        two.pointer_mut(pointer).unwrap()[field] = value;
        refused(&imported, ExclusionFormat::Vda5050, &two.to_string())
    };
    let set_of = "/0/zoneSet";
    assert_eq!(without(set_of, "zones", Value::Null), "message 1, zoneSet, zones: missing");
    assert_eq!(without(set_of, "zones", json!({})), "message 1, zoneSet, zones: a list is expected");
    assert_eq!(without("/0", "zoneSet", Value::Null), "message 1, zoneSet, mapId: missing");
    assert_eq!(without("/0/zoneSet/zones/1", "zoneId", Value::Null), "message 1, zoneSet, zone 2, zoneId: missing");
    assert_eq!(
        without("/0/zoneSet/zones/1", "zoneId", json!(2)),
        "message 1, zoneSet, zone 2, zoneId: a text is expected"
    );
    // The same in the files of others.
    let mut root = graph(&[[0.0, 0.0], [10.0, 0.0]], &[[1, 2]]);
    for feature in root["features"].as_array_mut().unwrap() {
        feature["properties"]["metadata"] = json!({ "closed_edges": [10] });
    }
    assert!(audit(&imported, ExclusionFormat::Nav2, &root.to_string()).suffices());
    let keys = root.to_string().replacen("\"closed_edges\":", "\"closed_edges\":[],\"closed_edges\":", 1);
    assert!(refused(&imported, ExclusionFormat::Nav2, &keys).contains("\"closed_edges\" is there twice"));
    assert!(layout(InputFormat::Nav2, &keys, &disc(0.4), &mut Warnings::default()).is_err());
    let settings = WriteOptions { target: ExclusionFormat::Pcr, split: None, envelopes: None };
    let (locks, ..) = write(InputFormat::Nav2, &root.to_string(), &disc(0.4), "map", &settings).unwrap();
    assert!(audit(&imported, ExclusionFormat::Pcr, &locks).suffices());
    let keys = locks.replacen("\"edges\":", "\"edges\": [], \"edges\":", 1);
    assert!(refused(&imported, ExclusionFormat::Pcr, &keys).contains("duplicate field `edges`"));
    // An edge or a node again, without locks or with the same ones.
    for (kind, id) in [("edge", 10), ("node", 1)] {
        let mut again: Value = serde_json::from_str(&locks).unwrap();
        let list = again[format!("{kind}s")].as_array_mut().unwrap();
        let same = list.iter().find(|entry| entry[kind] == id).unwrap().clone();
        list.push(json!({ kind: id, "locks": [] }));
        assert_eq!(
            refused(&imported, ExclusionFormat::Pcr, &again.to_string()),
            format!("{kind} {id}: there is another one of it")
        );
        *again[format!("{kind}s")].as_array_mut().unwrap().last_mut().unwrap() = same;
        assert!(refused(&imported, ExclusionFormat::Pcr, &again.to_string()).starts_with(&format!("{kind} {id}: ")));
    }
    let plant = |more: &str| {
        let envelope = "<vehicleEnvelope key=\"k\"><vertex x=\"0\" y=\"0\"/><vertex x=\"8\" y=\"0\"/><vertex x=\"0\" y=\"1\"/></vehicleEnvelope>";
        let block = "<block name=\"x\"><member name=\"p\"/></block>";
        let more = more.replace('e', envelope);
        let twice = if more.is_empty() { block } else { "" };
        format!(
            "<model name=\"m\"><point name=\"a\" positionX=\"0\" positionY=\"0\"/><point name=\"b\" positionX=\"8000\" positionY=\"0\"/>\
             <path name=\"p\" sourcePoint=\"a\" destinationPoint=\"b\">{more}</path><vehicle name=\"v\" envelopeKey=\"k\"/>{block}{twice}</model>"
        )
    };
    let plant = |more: &str| {
        let text = plant(more);
        read(ExclusionFormat::OpenTcs, &text, &self::imported(InputFormat::OpenTcs, &text, &disc(0.4))).map(|_| ())
    };
    assert!(plant("e").is_ok());
    assert!(plant("ee").unwrap_err().to_string().contains("p, vehicleEnvelope: there is another one"));
    assert!(plant("").unwrap_err().to_string().contains("block x: there is another one of this name"));
    let building = "name: b\ncoordinate_system: cartesian_meters\nlevels:\n  L1:\n    lanes:\n      - [0, 1, {mutex: [1, a], mutex: [1, b]}]\n    \
        vertices:\n      - [0, 0, 0, \"\"]\n      - [8, 0, 0, \"\"]\n";
    let error = layout(InputFormat::Rmf, building, &disc(0.4), &mut Warnings::default()).unwrap_err().to_string();
    assert!(error.contains("mutex"), "{error}");
}

#[test]
fn edges_that_the_service_cannot_close_are_refused() {
    let mut root = graph(&[[0.0, 0.0], [10.0, 0.0]], &[[1, 2]]);
    root["features"][2]["properties"] =
        json!({ "id": 70_000, "startid": 1, "endid": 2, "metadata": { "closed_edges": [70_000] } });
    let text = root.to_string();
    let imported = imported(InputFormat::Nav2, &text, &disc(0.4));
    assert!(refused(&imported, ExclusionFormat::Nav2, &text).contains("edge 70000: the service"), "ids of 16 bits");
    let text = text.replace("[70000]", "[1e300]");
    let column = text.find("[1e300]").unwrap() + 1;
    let expected = format!("line 1, column {column}: edge 70000, metadata, closed_edges: ids of edges are expected");
    assert_eq!(refused(&imported, ExclusionFormat::Nav2, &text), expected);
}

#[test]
fn a_node_beside_an_edge_without_length_is_not_passed_over() {
    let nodes = [[0.0, 0.0], [0.0, 0.0], [0.3, 0.0], [5.0, 0.0]];
    let of = |lists: [&[u64]; 4]| {
        let mut root = graph(&nodes, &[[1, 2], [4, 3]]);
        let edges: [&[u64]; 2] = [&[10, 11]; 2];
        for (feature, list) in root["features"].as_array_mut().unwrap().iter_mut().zip(lists.into_iter().chain(edges)) {
            feature["properties"]["metadata"] = json!({ "closed_edges": list });
        }
        let text = root.to_string();
        audit(&imported(InputFormat::Nav2, &text, &disc(0.4)), ExclusionFormat::Nav2, &text)
    };
    let whole: [&[u64]; 4] = [&[10, 11], &[10, 11], &[10, 11], &[11]];
    assert!(of(whole).suffices(), "{:?}", of(whole).gaps);
    let open = of([whole[0], whole[1], &[11], whole[3]]);
    assert_eq!(open.gaps.len(), 1, "{:?}", open.gaps);
    assert!((open.gaps[0].depth - 0.5).abs() < 1e-9 && (open.gaps[0].at[0] - 0.15).abs() < 1e-9, "{:?}", open.gaps);
}

#[test]
fn warnings_of_the_layout_come_first() {
    let lane = lane(&disc(0.4));
    let zones = set("map", &[("s", "RELEASE", &beside(0.0)), ("t", "SPEED_LIMIT", &beside(0.0))]).to_string();
    let audit = audit(&lane, ExclusionFormat::Vda5050, &zones);
    let said = |part: &str| audit.warnings.iter().position(|said| said.contains(part));
    assert_eq!(said("SPEED_LIMIT"), Some(audit.of_layout));
}

/// A zone that is a line seemed to keep vehicles apart, and corners had any size.
#[test]
fn zones_have_an_area_and_corners_in_range() {
    let lane = lane(&disc(0.5));
    let of = |corners: &[[f64; 2]]| set("map", &[("z", "RELEASE", corners)]).to_string();
    for corners in [[[-100.0, 0.0], [100.0, 0.0], [0.0, 0.0]], [[3.0, 3.0]; 3], [[0.1, 0.3], [0.2, 0.6], [0.3, 0.9]]] {
        assert_eq!(refused(&lane, ExclusionFormat::Vda5050, &of(&corners)), "zone z, vertices: they are on one line");
    }
    let far = refused(&lane, ExclusionFormat::Vda5050, &of(&[[0.0, 0.0], [1.0, 0.0], [1e308, 1e308]]));
    assert_eq!(far, "zone z, vertices: 1e308 is out of range; allowed is up to 1e10");
    assert!(read(ExclusionFormat::Vda5050, &of(&[[1e6, 1e6], [1e6 + 0.1, 1e6], [1e6, 1e6 + 0.1]]), &lane).is_ok());
}

/// Without locks of nodes nothing was looked at there, and what the layout does not have was left aside: both sufficed.
#[test]
fn an_audit_takes_all_locks_and_exclusions_of_its_layout() {
    let lane = lane(&disc(0.5));
    let text = set("map", &[]).to_string();
    let rules = read(ExclusionFormat::Vda5050, &text, &lane).unwrap();
    let locks = ExclusionTable::compute(&lane, true).unwrap();
    let failed = |locks: &ExclusionTable| {
        ExclusionAudit::run(&lane, locks, &rules, ExclusionFormat::Vda5050).unwrap_err().to_string()
    };
    assert!(ExclusionAudit::run(&lane, &locks, &rules, ExclusionFormat::Vda5050).is_ok());
    assert_eq!(failed(&ExclusionTable::compute(&lane, false).unwrap()), "an audit takes the locks of nodes as well");
    let mut other = locks.clone();
    other.nodes.as_mut().unwrap()[0].node = pcr_formats::import::ElementId::Text("x".into());
    assert_eq!(failed(&other), "locks of node x, which the layout does not have");
    let crossing = graph(&[[0.0, 0.0], [10.0, 0.0], [5.0, -5.0], [5.0, 5.0]], &[[1, 2], [3, 4]]).to_string();
    let crossing = imported(InputFormat::Nav2, &crossing, &disc(0.5));
    let more = ExclusionTable::compute(&crossing, true).unwrap();
    assert!(failed(&more).starts_with("locks of "), "{}", failed(&more));
    let error = ExclusionAudit::run(&crossing, &more, &rules, ExclusionFormat::Vda5050).unwrap_err().to_string();
    assert_eq!(error, "the exclusions are of another layout");
}
