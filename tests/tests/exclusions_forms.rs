//! Exclusions written into files that have the same things in other forms: what is there is kept, and what cannot be is refused.

use pcr_exclusions::{ExclusionAudit, ExclusionFormat, WriteOptions, WriteReport, read, write};
use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat, Warnings, layout};
use pcr_planning::exclusion_table::ExclusionTable;
use serde_json::{Value, json};
use std::collections::BTreeSet;

fn options(radius: f64) -> ImportOptions {
    ImportOptions { radius: Some(radius), ..ImportOptions::default() }
}

fn imported(format: InputFormat, text: &str, radius: f64) -> ImportedLayout {
    layout(format, text, &options(radius), &mut Warnings::default()).unwrap()
}

fn written(
    format: InputFormat,
    text: &str,
    radius: f64,
    target: ExclusionFormat,
    split: Option<f64>,
) -> (String, WriteReport) {
    let settings = WriteOptions { target, split, envelopes: None };
    let (written, report, audit) = write(format, text, &options(radius), "site", &settings).unwrap();
    assert!(audit.suffices());
    if target.layout().is_some() {
        let again = imported(format, &written, radius);
        let rules = read(target, &written, &again).unwrap();
        assert!(
            ExclusionAudit::run(&again, &ExclusionTable::compute(&again, true).unwrap(), &rules, target)
                .unwrap()
                .suffices()
        );
        assert_eq!(
            write(format, &written, &options(radius), "site", &WriteOptions { split: None, ..settings }).unwrap().0,
            written
        );
    }
    (written, report)
}

fn refused(format: InputFormat, text: &str, target: ExclusionFormat, split: Option<f64>) -> String {
    let settings = WriteOptions { target, split, envelopes: None };
    write(format, text, &options(0.4), "site", &settings).unwrap_err().to_string()
}

/// A building of four lanes, one of them for one way, in the form that the editor writes.
const BUILDING: &str = "coordinate_system: cartesian_meters
levels:
  L1:
    lanes:
      - [0, 1, {bidirectional: [4, true], graph_idx: [2, 0], orientation: [1, forward]}]
      - [1, 2, {bidirectional: [4, false], mutex: [1, \"\"], graph_idx: [2, 0]}]
      - [1, 3]
      - [4, 5, {}]
    vertices:
      - [0, 0, 0, \"\"]
      - [4, 0, 0, \"b\", {is_charger: [4, true]}]
      - [8, 0]
      - [4, 3, 0]
      - [0, 0.5, 0, \"\", {mutex: [1, mine]}]
      - [4, 0.5, 0, \"\", {}]
name: site
";

/// The same as block lists, in JSON, and in the first form with comments, further commas, and lines that end as in Windows.
fn forms() -> [String; 4] {
    let block = "coordinate_system: cartesian_meters
levels:
  L1:
    lanes:
    - - 0
      - 1
      - bidirectional: # both
        - 4
        - true
        graph_idx: [2, 0]
        orientation:
        - 1
        - forward
    # one way
    - - 1
      - 2
      - bidirectional: [4, false]
        mutex: [1, \"\"]
        graph_idx: [2, 0]
    - - 1
      - 3
    - - 4
      - 5
      - {}
    # vertices
    vertices:
    - - 0
      - 0
      - 0
      - ''
    - [4, 0, 0, b, {is_charger: [4, true]}]
    - - 8
      - 0
    - - 4
      - 3
      - 0 # height
    - [0, 0.5, 0, '', {mutex: [1, mine]}]
    - - 4
      - 0.5
      - 0
      - ''
      - {}
name: site
";
    let lanes = json!([[0, 1, { "bidirectional": [4, true], "graph_idx": [2, 0], "orientation": [1, "forward"] }],
        [1, 2, { "bidirectional": [4, false], "mutex": [1, ""], "graph_idx": [2, 0] }], [1, 3], [4, 5, {}]]);
    let vertices = json!([[0, 0, 0, ""], [4, 0, 0, "b", { "is_charger": [4, true] }], [8, 0], [4, 3, 0],
        [0, 0.5, 0, "", { "mutex": [1, "mine"] }], [4, 0.5, 0, "", {}]]);
    let levels = json!({ "L1": { "lanes": lanes, "vertices": vertices } });
    let other = json!({ "coordinate_system": "cartesian_meters", "levels": levels, "name": "site" });
    let comments =
        BUILDING.replace("]\n", "] # a [comment], or two\n").replace("true]}", "true],}").replace('\n', "\r\n");
    [
        BUILDING.to_owned(),
        block.to_owned(),
        serde_json::to_string(&other).unwrap(),
        format!("\u{feff}---\r\n{comments}...\r\n"),
    ]
}

/// The lanes that a building has.
fn lanes(text: &str) -> Value {
    let root: Value = serde_saphyr::from_str(text).unwrap();
    root["levels"]["L1"]["lanes"].clone()
}

#[test]
fn buildings_in_all_forms_of_yaml_get_the_same_groups() {
    let expected = written(InputFormat::Rmf, BUILDING, 0.4, ExclusionFormat::Rmf, None);
    let cut = written(InputFormat::Rmf, BUILDING, 0.4, ExclusionFormat::Rmf, Some(1.5));
    assert!(expected.1.warnings.contains(&"groups of the file are replaced: mine [replaced-exclusions]".to_owned()));
    assert_eq!((expected.1.edges, cut.1.edges), (5, 14));
    for text in forms() {
        for (expected, split) in [(&expected, None), (&cut, Some(1.5))] {
            let (written, report) = written(InputFormat::Rmf, &text, 0.4, ExclusionFormat::Rmf, split);
            assert_eq!(lanes(&written), lanes(&expected.0), "{written}");
            assert_eq!(&report, &expected.1);
            let ends = |text: &str| [text.matches("\r\n").count(), text.matches('\n').count()];
            let expected = if text.contains("\r\n") { ends(&written)[1] } else { 0 };
            assert_eq!(ends(&written)[0], expected, "lines end as before");
            assert_eq!(text.starts_with('{'), serde_json::from_str::<Value>(&written).is_ok(), "JSON stays JSON");
            // All names and comments that were there are there, in their order.
            let mut rest = written.as_str();
            for word in text.split([' ', '\r', '\n', '[', ']', '{', '}', ',']).filter(|_| split.is_none()) {
                if word.contains(|sign: char| sign.is_alphabetic() || sign == '#')
                    && !["true", "mine", "\"mine\""].contains(&word)
                {
                    let at = rest.find(word).unwrap_or_else(|| panic!("{word} is no longer there: {written}"));
                    rest = &rest[at + word.len()..];
                }
            }
        }
    }
    // The way back of a lane that is for one way now looks to the other side.
    assert!(expected.0.contains(
        "- [1, 0, {bidirectional: [4, false], graph_idx: [2, 0], orientation: [1, \"backward\"], mutex: [1, \"pcr/L1/1\"]}]"
    ));
}

#[test]
fn what_is_shared_in_a_building_is_refused() {
    for (from, to) in [
        ("{bidirectional: [4, true], graph", "&p {bidirectional: [4, true], graph"),
        ("bidirectional: [4, true]", "bidirectional: &two [4, true]"),
        ("[4, 5, {}]", "[4, 5, *x]\n      - &y [5, 4, {}]"),
        ("[4, 0.5, 0, \"\", {}]", "&v [4, 0.5, 0, \"\", {}]"),
        ("[4, 0.5, 0, \"\", {}]", "[4, &h 0.5, 0, \"\", {}]"),
    ] {
        let text = format!("more: &x {{}}\n{}", BUILDING.replace(from, to));
        assert_ne!(text.len(), BUILDING.len() + 12);
        let why = refused(InputFormat::Rmf, &text, ExclusionFormat::Rmf, None);
        assert!(why.contains("anchor or an alias"), "{why}");
    }
    // What is merged would be in the parts and in both directions.
    for split in [None, Some(1.5)] {
        let merged = BUILDING.replacen("{bidirectional: [4, true], ", "{<<: {bidirectional: [4, true]}, ", 1);
        assert_ne!(merged, BUILDING);
        let why = refused(InputFormat::Rmf, &merged, ExclusionFormat::Rmf, split);
        assert!(why.contains("lanes L1/0: its parameters have a merge key (<<)"), "{why}");
    }
    // Elsewhere they do no harm.
    let text = format!("more: &x {{}}\nagain: *x\n{BUILDING}");
    let (text, _) = written(InputFormat::Rmf, &text, 0.4, ExclusionFormat::Rmf, None);
    let (stamp, rest) = text.split_once('\n').unwrap();
    assert!(stamp.starts_with("pcr_vehicle: {") && rest.starts_with("more: &x {}\nagain: *x\n"), "{text}");
}

const GRAPH: &str = "building_name: site
doors: {}
levels:
  L1:
    lanes:
    - - 0
      - 1
      - {orientation_constraint: forward}
    - - 1
      - 0
      - {orientation_constraint: backward, speed_limit: 0.5}
    - - 1
      - 2
      - {dock_name: dock}
    vertices:
    - - 1.0
      - -2.0
      - {is_charger: true, name: home}
    - - 5.0
      - -2.0
      - {name: ''}
    - - 5.0
      - -6.0
      - {name: ''}
  L2:
    lanes:
    - - 0
      - 1
      - {}
    vertices:
    - - 1.0
      - -2.0
      - {name: above}
    - - 5.0
      - -2.0
      - {name: ''}
lifts: {}
";

#[test]
fn navigation_graphs_are_read_and_written() {
    let there = imported(InputFormat::Rmf, GRAPH, 0.4).layout;
    assert_eq!((there.name.as_str(), there.nodes.len(), there.edges.len()), ("site", 5, 4));
    assert_eq!((there.nodes[0].point, there.nodes[0].name.as_deref()), ([1.0, -2.0], Some("home")));
    assert!(there.edges.iter().all(|edge| !edge.is_two_way()));
    let (text, _) = written(InputFormat::Rmf, GRAPH, 0.4, ExclusionFormat::Rmf, None);
    let plain: String = text
        .replace(", mutex: \"pcr/L1/0\"", "")
        .replace(", mutex: \"pcr/L1/1\"", "")
        .replace(", mutex: \"pcr/L1/2\"", "");
    let plain = plain
        .replace(", mutex: \"pcr/L2/0\"", "")
        .replace(", mutex: \"pcr/L2/1\"", "")
        .replace("mutex: \"pcr/L2/0\"", "");
    let (stamp, plain) = plain.split_once('\n').unwrap();
    assert!(stamp.starts_with("pcr_vehicle: {"), "{stamp}");
    assert_eq!(plain, GRAPH);
    for expected in [
        "{orientation_constraint: forward, mutex: \"pcr/L1/0\"}",
        "{orientation_constraint: backward, speed_limit: 0.5, mutex: \"pcr/L1/1\"}",
        "{is_charger: true, name: home, mutex: \"pcr/L1/0\"}",
        "{mutex: \"pcr/L2/0\"}",
    ] {
        assert!(text.contains(expected), "{text}");
    }
    let (text, report) = written(InputFormat::Rmf, GRAPH, 0.4, ExclusionFormat::Rmf, Some(2.0));
    assert_eq!(report.edges, 7, "{text}");
    assert!(report.warnings.iter().any(|said| said.contains("L1/2 is left whole: a robot docks")), "{report:?}");
    for expected in [
        "    - - 3\n      - 1\n      - {orientation_constraint: forward, ",
        "    - [3.0, -2.0, {name: \"\", mutex: \"pcr/L1/3\"}]\n",
    ] {
        assert!(text.contains(expected), "{text}");
    }
    // Lanes of one way only, whatever they say.
    let both = GRAPH.replace("speed_limit: 0.5", "is_bidirectional: true");
    let mut warnings = Warnings::default();
    let there = layout(InputFormat::Rmf, &both, &options(0.4), &mut warnings).unwrap().layout;
    assert!(
        !there.edges[1].is_two_way() && warnings.lines().iter().any(|said| said.contains("taken one way")),
        "{warnings:?}"
    );
}

/// Features of a route graph: four nodes, three ways.
fn graph(more: &str) -> String {
    let node = |id: u32, x: f64, y: f64| {
        format!(
            "{{\"type\":\"Feature\",\"properties\":{{\"id\":{id}}},\"geometry\":{{\"type\":\"Point\",\"coordinates\":[{x},{y}]}}}}"
        )
    };
    let edge = |id: u32, from: u32, to: u32, more: &str| {
        format!(
            "{{\"type\":\"Feature\",\"geometry\":{{\"type\":\"LineString\",\"coordinates\":[[0,0],[0,1]]}},\"properties\":{{\"startid\":{from},\"endid\":{to},\"id\":{id}{more}}}}}"
        )
    };
    let features = [
        node(0, 0.0, 0.0),
        node(1, 4.0, 0.0),
        node(2, 4.0, 4.0),
        node(3, 0.0, 0.5),
        edge(10, 0, 1, more),
        edge(11, 1, 2, ""),
        edge(12, 3, 1, ""),
    ];
    format!("{{\"type\":\"FeatureCollection\",\r\n\"features\":[{}]}}\r\n", features.join(",\r\n"))
}

#[test]
fn operations_of_route_graphs_stay_with_a_whole_edge_in_both_forms() {
    let door = r#"{"type":"open_door","trigger":"ON_ENTER"}"#;
    for (operations, is_whole) in [
        (format!("{{\"open\":{door}}}"), true),
        (format!("[{door}]"), true),
        ("{}".to_owned(), false),
        ("[]".to_owned(), false),
        ("null".to_owned(), false),
    ] {
        let (text, report) = written(
            InputFormat::Nav2,
            &graph(&format!(",\"operations\":{operations}")),
            0.4,
            ExclusionFormat::Nav2,
            Some(2.0),
        );
        assert_eq!(report.edges, if is_whole { 6 } else { 7 }, "{operations}");
        assert_eq!(text.matches("open_door").count(), usize::from(is_whole), "{text}");
        // The first part keeps the number.
        let root: Value = serde_json::from_str(&text).unwrap();
        let edge =
            root["features"].as_array().unwrap().iter().find(|feature| feature["properties"]["id"] == 10).unwrap();
        assert_eq!((edge["properties"]["startid"] == 0, edge["properties"]["endid"] == 1), (true, is_whole), "{text}");
        assert_eq!(text.matches('\n').count(), text.matches("\r\n").count());
    }
}

#[test]
fn lists_stand_in_metadata_whatever_it_was() {
    for (given, expected) in [
        ("", "\"metadata\": { \"closed_edges\": ["),
        (",\"metadata\":null", ",\"metadata\":{ \"closed_edges\": ["),
        (",\"metadata\":{}", ",\"metadata\":{\"closed_edges\": ["),
        (
            ",\"metadata\":{\"a\":{\"closed_edges\":[1]}}",
            ",\"metadata\":{\"a\":{\"closed_edges\":[1]}, \"closed_edges\": [",
        ),
        (
            ",\"metadata\":{\"closed_edges\":[12, 10],\"\\u00e9\\\"}\":\"]\"}",
            ",\"metadata\":{\"closed_edges\":[10,11,12],\"\\u00e9\\\"}\":\"]\"}",
        ),
    ] {
        let (text, _) = written(InputFormat::Nav2, &graph(given), 0.4, ExclusionFormat::Nav2, None);
        assert!(text.contains(expected), "{given}: {text}");
    }
    // Which of two members of one name counts depends on who reads them.
    let twice = graph(",\"metadata\":{\"closed_edges\":[7]},\"metadata\":{}");
    assert!(refused(InputFormat::Nav2, &twice, ExclusionFormat::Nav2, None).contains("\"metadata\" is there twice"));
}

/// Zones as the standard asks for them: names of their own, and what a RELEASE zone needs.
fn zone_sets(text: &str) -> Vec<String> {
    let root: Value = serde_json::from_str(text).unwrap();
    let messages = if let Value::Array(list) = root { list } else { vec![root] };
    messages
        .iter()
        .map(|message| {
            let texts = ["timestamp", "version", "manufacturer", "serialNumber"];
            assert!(texts.iter().all(|name| message[name].is_string()) && message["headerId"].is_u64(), "{message}");
            let set = &message["zoneSet"];
            let zones = set["zones"].as_array().unwrap();
            let names: BTreeSet<&str> = zones.iter().map(|zone| zone["zoneId"].as_str().unwrap()).collect();
            assert_eq!(names.len(), zones.len(), "names twice in {}", set["mapId"]);
            for zone in zones {
                assert_eq!([&zone["zoneType"], &zone["releaseLossBehavior"]], ["RELEASE", "STOP"]);
                let corners = zone["vertices"].as_array().unwrap();
                assert!(corners.len() >= 3 && corners.iter().all(|at| at["x"].is_number() && at["y"].is_number()));
            }
            assert!(set["mapId"].is_string());
            set["zoneSetId"].as_str().unwrap().to_owned()
        })
        .collect()
}

#[test]
fn of_zones_their_level_is_told() {
    let settings = WriteOptions { target: ExclusionFormat::Vda5050, split: None, envelopes: None };
    let text = write(InputFormat::Rmf, GRAPH, &options(0.4), "site", &settings).unwrap().0;
    // On which level a zone is drawn; a zone that slows vehicles down does not keep them apart.
    let imported = imported(InputFormat::Rmf, GRAPH, 0.4);
    let levels = |text: &str| -> Vec<usize> {
        read(ExclusionFormat::Vda5050, text, &imported).unwrap().groups.iter().map(|group| group.level).collect()
    };
    assert_eq!(levels(&text).iter().copied().collect::<BTreeSet<_>>().len(), 2, "{:?}", levels(&text));
    let slow = text.replacen("\"RELEASE\"", "\"SPEED_LIMIT\"", 1);
    assert_eq!(levels(&slow)[..], levels(&text)[1..]);
    let warnings = read(ExclusionFormat::Vda5050, &slow, &imported).unwrap().warnings;
    assert!(warnings.iter().any(|said| said.contains("SPEED_LIMIT keeps no vehicles apart")), "{warnings:?}");
}

/// Two lanes that meet at none of their vertices.
#[test]
fn lanes_that_cross_between_vertices_have_a_group() {
    let building = "coordinate_system: cartesian_meters
levels:
  L1:
    lanes:
      - [0, 1, {bidirectional: [4, true]}]
      - [2, 3, {bidirectional: [4, true]}]
    vertices:
      - [0, 0, 0, \"\"]
      - [8, 0, 0, \"\"]
      - [4, -4, 0, \"\"]
      - [4, 4, 0, \"\"]
name: site
";
    let (text, report) = written(InputFormat::Rmf, building, 0.4, ExclusionFormat::Rmf, None);
    // Lanes have the groups of vertices, and two vertices one in common: two lanes and two vertices name it.
    assert_eq!((report.groups, text.matches("\"pcr/L1/1\"").count()), (3, 4), "{text}");
}

#[test]
fn that_lanes_of_other_graphs_stay_is_said() {
    let said = |graph| {
        let options = ImportOptions { graph, ..options(0.4) };
        let settings = WriteOptions { target: ExclusionFormat::Rmf, split: None, envelopes: None };
        let report = write(InputFormat::Rmf, BUILDING, &options, "site", &settings).unwrap().1;
        report.warnings.iter().any(|said| said.contains("lanes of other graphs than 0"))
    };
    assert_eq!([said(None), said(Some(0))], [false, true]);
}

#[test]
fn zones_and_zone_sets_have_names_of_their_own() {
    let of = |radius, split| zone_sets(&written(InputFormat::Rmf, GRAPH, radius, ExclusionFormat::Vda5050, split).0);
    let sets = [of(0.4, None), of(0.4, Some(1.0)), of(0.5, None)].concat();
    assert_eq!(sets.len(), 6);
    assert_eq!(sets.iter().collect::<BTreeSet<_>>().len(), 6, "other zones, another set: {sets:?}");
    assert_eq!(of(0.4, None), of(0.4, None));
    // A path in parts, and one that is called like its second part.
    let plant = |name: &str| {
        let point =
            |name: &str, x: u32, y: u32| format!("<point name=\"{name}\" positionX=\"{x}\" positionY=\"{y}\"/>");
        let path = |name: &str, from: &str, to: &str| {
            format!("<path name=\"{name}\" sourcePoint=\"{from}\" destinationPoint=\"{to}\" length=\"2000\"/>")
        };
        let points = [point("a", 0, 0), point("b", 4000, 0), point("c", 0, 4000), point("d", 2000, 4000)].concat();
        format!("<model name=\"m\">{points}{}{}</model>", path("p", "a", "b"), path(name, "c", "d"))
    };
    let (text, report) = written(InputFormat::OpenTcs, &plant("p (2)"), 0.4, ExclusionFormat::Vda5050, Some(2.0));
    assert_eq!((zone_sets(&text).len(), report.groups), (1, 3));
}

const DEMO: &str = include_str!("../data/real/opentcs/Demo-01.xml");

#[test]
fn blocks_of_a_model_have_names_of_their_own() {
    let mine = "<block name=\"pcr-block-of-mine\"><member name=\"Point-0001\"/></block>";
    let text = DEMO
        .replacen("<block ", &format!("{mine}\n    <block "), 1)
        .replace("\"Fire door 01\"", "\"pcr-block-0002\"")
        .replace('\n', "\r\n");
    let (text, report) = written(InputFormat::OpenTcs, &text, 0.9, ExclusionFormat::OpenTcs, None);
    assert!(text.contains(mine) && report.groups > 1);
    assert_eq!(text.matches("<block name=\"\"pcr-block-0002\"").count(), 0);
    assert_eq!(text.matches("<block name=\"pcr-block-0").count(), report.groups);
    assert_eq!(text.matches('\n').count(), text.matches("\r\n").count());
    let prefixed = "<m:model xmlns:m=\"urn:m\" name=\"m\"><m:point name=\"a\" positionX=\"0\" positionY=\"0\"/>\
        <m:point name=\"b\" positionX=\"2000\" positionY=\"0\"/><m:path name=\"p\" sourcePoint=\"a\" destinationPoint=\"b\"/></m:model>";
    let why = refused(InputFormat::OpenTcs, prefixed, ExclusionFormat::OpenTcs, None);
    assert!(why.contains("prefix"), "{why}");
}

#[test]
fn parts_that_no_memory_holds_are_refused_before_they_are_made() {
    for (format, text, target) in [
        (InputFormat::Nav2, graph(""), ExclusionFormat::Nav2),
        (InputFormat::Rmf, BUILDING.to_owned(), ExclusionFormat::Vda5050),
    ] {
        let why = refused(format, &text, target, Some(1e-12));
        assert!(why.contains("parts"), "{why}");
    }
}
