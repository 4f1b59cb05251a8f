//! Exclusions in the files of fleets: vehicles that obey nothing but a written file never touch, no lock is needless, and what
//! is not asked to change does not change.

use pcr_certify::motion::{Mover, meetings};
use pcr_certify::raw::{RawAgent, RawAngle, RawMotion, RawPath, RawSegment};
use pcr_exclusions::{ExclusionAudit, ExclusionFormat, LayoutElementId, WriteOptions, read, stretch, write};
use pcr_formats::import::{ElementId, ImportOptions, ImportedLayout, InputFormat, Warnings, layout};
use pcr_planning::exclusion_table::ExclusionTable;
use pcr_tests::rules::run;
use pcr_tests::written::{self, Written};
use serde_json::Value;

const WAREHOUSE: &str = include_str!("../data/real/nav2/warehouse_graph.geojson");
const SAMPLE: &str = include_str!("../data/real/nav2/sample_graph.geojson");
const DEMO: &str = include_str!("../data/real/opentcs/Demo-01.xml");
const OFFICE: &str = include_str!("../data/real/rmf/office.building.yaml");

/// What is driven by each file.
const MISSIONS: usize = 300;

fn options(radius: f64) -> ImportOptions {
    ImportOptions { radius: Some(radius), ..ImportOptions::default() }
}

fn imported(format: InputFormat, text: &str, radius: f64) -> ImportedLayout {
    layout(format, text, &options(radius), &mut Warnings::default()).unwrap()
}

fn settings(target: ExclusionFormat) -> WriteOptions {
    WriteOptions { target, split: None, envelopes: None }
}

fn written(format: InputFormat, text: &str, radius: f64, settings: &WriteOptions) -> String {
    write(format, text, &options(radius), "site", settings).unwrap().0
}

fn suffice(is_asked: impl Fn(&Written) -> bool) {
    for file in written::ALL.into_iter().filter(is_asked) {
        let (_, run) = file.obeyed(MISSIONS, 7).unwrap();
        assert!(run.contacts.is_empty(), "{file}: {:?}", run.contacts);
        assert_eq!(run.missions, MISSIONS, "{file}: {run:?}");
        assert!(5 * run.pairs > MISSIONS && 10 * run.refused > MISSIONS, "{file}: hardly anybody met: {run:?}");
    }
}

#[test]
fn vehicles_that_obey_nav2_lists_never_touch() {
    suffice(|file| file.target == ExclusionFormat::Nav2);
}

#[test]
fn vehicles_that_obey_mutex_groups_never_touch() {
    suffice(|file| file.target == ExclusionFormat::Rmf);
}

#[test]
fn vehicles_that_obey_blocks_or_envelopes_never_touch() {
    suffice(|file| file.target == ExclusionFormat::OpenTcs);
}

#[test]
fn vehicles_that_obey_release_zones_never_touch() {
    suffice(|file| file.target == ExclusionFormat::Vda5050);
}

#[test]
fn vehicles_that_obey_lock_files_never_touch() {
    suffice(|file| file.target == ExclusionFormat::Pcr);
}

#[test]
fn vehicles_without_rules_touch() {
    let imported = imported(InputFormat::Nav2, WAREHOUSE, 0.4);
    let none = read(ExclusionFormat::Nav2, WAREHOUSE, &imported).unwrap();
    let run = run(&imported, &none, 200, 7);
    assert!(run.contacts.len() > 20, "{run:?}");
}

/// Two discs that stand, as the checker sees them.
fn touch(radius: f64, points: [[f64; 2]; 2]) -> bool {
    let mover = |(k, start): (usize, [f64; 2])| {
        let segment = RawSegment { length: 0.0, radius: None, turns: Vec::new(), from: 0.0, to: 0.0 };
        let path =
            RawPath { start, heading: RawAngle::Radians(0.0), segments: vec![segment], rounding: 0.0, step: 0.0 };
        let travel = RawMotion { start: 0.0, phases: Vec::new(), lag: 0.0, time_excess: 0.0 };
        Mover::new(&RawAgent { id: k as u64, radius, path, travel: Some(travel) }, [0.0, 1.0]).unwrap()
    };
    let movers: Vec<Mover> = points.into_iter().enumerate().map(mover).collect();
    !meetings(&movers).contacts.is_empty()
}

/// A lock file without one of its locks of two edges.
fn without(file: &str, a: &Value, b: &Value, own: &Value) -> String {
    let mut root: Value = serde_json::from_str(file).unwrap();
    for entry in root["edges"].as_array_mut().unwrap() {
        let edge = entry["edge"].clone();
        entry["locks"].as_array_mut().unwrap().retain(|lock| {
            !((edge == *a && lock["edge"] == *b && lock["own"] == *own)
                || (edge == *b && lock["edge"] == *a && lock["other"] == *own))
        });
    }
    root.to_string()
}

/// Leaves out locks of a table, every `step`th; each leaves a contact that the audit shows and the checker confirms.
fn needed(format: InputFormat, text: &str, radius: f64, step: usize) {
    let file = written(format, text, radius, &settings(ExclusionFormat::Pcr));
    let mut imported = imported(format, text, radius);
    imported.layout.name = "site".into();
    let locks = ExclusionTable::compute(&imported, true).unwrap();
    let root: Value = serde_json::from_str(&file).unwrap();
    let mut pairs = Vec::new();
    for entry in root["edges"].as_array().unwrap() {
        for lock in entry["locks"].as_array().unwrap() {
            pairs.push((entry["edge"].clone(), lock["edge"].clone(), lock["own"].clone()));
        }
    }
    let id = |value: &Value| {
        value.as_u64().map_or_else(|| ElementId::Text(value.as_str().unwrap().into()), ElementId::Number)
    };
    let (mut shown, mut left_out) = (0, 0);
    for (a, b, own) in pairs.iter().step_by(step) {
        left_out += 1;
        let rules = read(ExclusionFormat::Pcr, &without(&file, a, b, own), &imported).unwrap();
        let audit = ExclusionAudit::run(&imported, &locks, &rules, ExclusionFormat::Pcr).unwrap();
        let ends = [LayoutElementId::Edge(id(a).min(id(b))), LayoutElementId::Edge(id(a).max(id(b)))];
        let gap = audit.gaps.iter().find(|gap| {
            let mut both = [gap.a.clone(), gap.b.clone()];
            both.sort();
            both == ends
        });
        let gap = gap.unwrap_or_else(|| panic!("{a} {b}: nothing touches without it"));
        let curve = |spot: &LayoutElementId, lengths: [f64; 2]| {
            let edge =
                imported.layout.edges.iter().find(|edge| LayoutElementId::Edge(edge.id.clone()) == *spot).unwrap();
            stretch(&edge.curve, lengths)
        };
        let found = pcr_exclusions::nearest(&curve(&gap.a, gap.a_length.unwrap()), &curve(&gap.b, gap.b_length));
        shown += usize::from(found.is_none_or(|found| touch(radius, found.points)));
    }
    assert!(left_out > 20);
    assert_eq!(shown, left_out, "not all of them are contacts");
}

#[test]
fn every_lock_that_is_left_out_leaves_a_contact() {
    needed(InputFormat::Nav2, SAMPLE, 0.3, 1);
    needed(InputFormat::Nav2, WAREHOUSE, 0.4, 40);
    needed(InputFormat::OpenTcs, DEMO, 0.9, 15);
}

/// What is left of a text without the lists, the blocks, or the groups that were written.
#[test]
fn all_else_is_kept_byte_for_byte() {
    let nav2 = written(InputFormat::Nav2, SAMPLE, 0.3, &settings(ExclusionFormat::Nav2));
    let mut rest = nav2.clone();
    while let Some(at) = rest.find("\"closed_edges\": [") {
        let end = at + rest[at..].find(']').unwrap() + 1;
        let from = ["\"metadata\": { ", ", "]
            .iter()
            .fold(at, |from, before| if rest[..from].ends_with(before) { from - before.len() } else { from });
        let after = if rest[from..].starts_with(", \"metadata\"") { end + " }".len() } else { end };
        rest.replace_range(from..after, "");
    }
    // At the end it says for which vehicle that is.
    let stamp = rest.find(", \"pcr_vehicle\": {").unwrap();
    let end = stamp + rest[stamp..].find("}").unwrap() + 1;
    rest.replace_range(stamp..end, "");
    assert_eq!(rest, SAMPLE);
    // Written again, nothing changes.
    assert_eq!(written(InputFormat::Nav2, &nav2, 0.3, &settings(ExclusionFormat::Nav2)), nav2);

    let blocks = written(InputFormat::OpenTcs, DEMO, 0.9, &settings(ExclusionFormat::OpenTcs));
    let first = blocks.find("\n    <block name=\"pcr-block-").unwrap();
    let last = blocks.rfind("</block>").unwrap() + "</block>".len();
    let mut rest = [&blocks[..first], &blocks[last..]].concat();
    let stamp = rest.find("\n    <property name=\"pcr:vehicle\"").unwrap();
    let end = stamp + rest[stamp..].find("/>").unwrap() + 2;
    rest.replace_range(stamp..end, "");
    assert_eq!(rest, DEMO);
    assert_eq!(written(InputFormat::OpenTcs, &blocks, 0.9, &settings(ExclusionFormat::OpenTcs)), blocks);

    let groups = written(InputFormat::Rmf, OFFICE, 0.3, &settings(ExclusionFormat::Rmf));
    assert_eq!(written(InputFormat::Rmf, &groups, 0.3, &settings(ExclusionFormat::Rmf)), groups);
    let other = |text: &str| {
        let is_other = |line: &&str| !line.starts_with("      - [") && !line.starts_with("pcr_vehicle: ");
        let lines = text.lines().filter(is_other);
        lines.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(other(&groups), other(OFFICE));
}

/// Two ways beside each other, one of them in both directions, each with what may be in a model.
const PLANT: &str = r#"<model version="7.0.0" name="plant">
    <point name="a" positionX="0" positionY="0" positionZ="0" type="HALT_POSITION"><maxVehicleBoundingBox length="1000" width="1000" height="1000" referenceOffsetX="0" referenceOffsetY="0"/><outgoingPath name="a'b"/></point>
    <point name="b" positionX="5001" positionY="3" positionZ="500" type="PARK_POSITION"><maxVehicleBoundingBox length="1200" width="900" height="1000" referenceOffsetX="0" referenceOffsetY="0"/><outgoingPath name="back"/></point>
    <point name="c" positionX="0" positionY="-4000" positionZ="0" type="HALT_POSITION"><maxVehicleBoundingBox length="1000" width="1000" height="1000" referenceOffsetX="0" referenceOffsetY="0"/><outgoingPath name="c-d"/></point>
    <point name="d" positionX="5000" positionY="-4000" positionZ="0" type="HALT_POSITION"><maxVehicleBoundingBox length="1000" width="1000" height="1000" referenceOffsetX="0" referenceOffsetY="0"/></point>
    <path name='a&apos;b' sourcePoint="a" destinationPoint="b" length="5001" maxVelocity="1000" maxReverseVelocity="500" locked="false"><pathLayout connectionType="DIRECT" layerId="3"/></path>
    <path name="back" sourcePoint="b" destinationPoint="a" length="5001" maxVelocity="1000" maxReverseVelocity="0" locked="false"/>
    <path name="c-d" sourcePoint="c" destinationPoint="d" length="5000" maxVelocity="1000" maxReverseVelocity="0" locked="false">CONTENT</path>
    <block name="kept" type="SINGLE_VEHICLE_ONLY">
        <member name="a'b"/>
        <member name="d"/>
    </block>MORE
</model>"#;

#[test]
fn paths_of_a_plant_are_cut_where_nothing_belongs_to_all_of_them() {
    let plant = |content: &str, more: &str| PLANT.replace("CONTENT", content).replace("MORE", more);
    let cut = |text: &str, split| {
        let settings = WriteOptions { split: Some(split), ..settings(ExclusionFormat::OpenTcs) };
        write(InputFormat::OpenTcs, text, &options(0.5), "site", &settings).unwrap()
    };
    let (text, report, _) = cut(&plant("", ""), 2.0);
    // Each path has points of its own; the first part keeps the name.
    assert_eq!((report.edges, report.nodes), (9, 10), "{text}");
    for expected in [
        "<path name='a&apos;b' sourcePoint=\"a\" destinationPoint=\"a&apos;b+1.667\" length=\"1667\" maxVelocity=\"1000\" maxReverseVelocity=\"500\"",
        "<path name='a&apos;b part 3' sourcePoint=\"a&apos;b+3.334\" destinationPoint=\"b\" length=\"1667\"",
        "<path name=\"back part 2\" sourcePoint=\"back+1.667\" destinationPoint=\"back+3.334\"",
        "<point name=\"a&apos;b+3.334\" positionX=\"3334\" positionY=\"2\" positionZ=\"333\" vehicleOrientationAngle=\"NaN\" type=\"HALT_POSITION\">
        <maxVehicleBoundingBox length=\"1200\" width=\"900\" height=\"1000\" referenceOffsetX=\"0\" referenceOffsetY=\"0\"/>
        <outgoingPath name=\"a&apos;b part 3\"/>
        <pointLayout labelOffsetX=\"-10\" labelOffsetY=\"-20\" layerId=\"3\"/>
    </point>",
        // A block that holds a path holds all that it has become.
        "<member name=\"a'b\"/>
        <member name=\"a&apos;b part 2\"/>
        <member name=\"a&apos;b part 3\"/>
        <member name=\"a&apos;b+1.667\"/>
        <member name=\"a&apos;b+3.334\"/>
        <member name=\"d\"/>",
    ] {
        assert!(text.contains(expected), "{expected}\n{text}");
    }
    // Cut again nothing changes, and less is excluded than without.
    assert_eq!(cut(&text, 2.0).0, text);
    assert!(report.excluded < 0.7 * report.uncut.unwrap(), "{report:?}");
    for (content, more, reason) in [
        (
            r#"<peripheralOperation name="open" locationName="door" executionTrigger="AFTER_MOVEMENT" completionRequired="true"/>"#,
            "",
            "operations",
        ),
        (r#"<property name="tcs:routingCostForward" value="9"/>"#, "", "properties"),
        (r#"<vehicleEnvelope key="k"><vertex x="0" y="0"/></vehicleEnvelope>"#, "", "envelopes"),
        (
            r#"<pathLayout connectionType="POLYPATH" layerId="0"><controlPoint x="50" y="85"/></pathLayout>"#,
            "",
            "of their curves",
        ),
        (
            "",
            r#"<block name="lane" type="SAME_DIRECTION_ONLY"><member name="c-d"/></block>"#,
            "which path vehicles come in",
        ),
    ] {
        let (text, report, _) = cut(&plant(content, more), 2.0);
        assert!(
            report.warnings.iter().any(|said| said.contains(reason) && said.ends_with(": c-d [left-whole]")),
            "{:?}",
            report.warnings
        );
        assert!(
            text.contains(r#"name="c-d" sourcePoint="c" destinationPoint="d" length="5000""#)
                && text.contains("a&apos;b part 3")
        );
    }
}

#[test]
fn a_byte_order_mark_before_a_plant_moves_nothing() {
    const LAYOUT: &str = r#"<pathLayout connectionType="DIRECT" layerId="0"/>"#;
    let plant = |content: &str| {
        PLANT
            .replace("false\"/>", &format!("false\">{LAYOUT}</path>"))
            .replace("CONTENT", content)
            .replace("MORE", r#"<vehicle name="v" envelopeKey="k"></vehicle>"#)
    };
    let marked = |text: &str| format!("\u{feff}{text}");
    let envelopes = Some("k".to_owned());
    for settings in [
        settings(ExclusionFormat::OpenTcs),
        WriteOptions { split: Some(2.0), ..settings(ExclusionFormat::OpenTcs) },
        WriteOptions { envelopes: envelopes.clone(), ..settings(ExclusionFormat::OpenTcs) },
        WriteOptions { envelopes, split: Some(2.0), ..settings(ExclusionFormat::OpenTcs) },
    ] {
        let plain = written(InputFormat::OpenTcs, &plant(LAYOUT), 2.5, &settings);
        assert_ne!(plain, plant(LAYOUT));
        assert_eq!(
            written(InputFormat::OpenTcs, &marked(&plant(LAYOUT)), 2.5, &settings),
            marked(&plain),
            "{settings:?}"
        );
        // There are blocks or envelopes that are replaced.
        assert_eq!(written(InputFormat::OpenTcs, &marked(&plain), 2.5, &settings), marked(&plain), "{settings:?}");
    }
    // Envelopes that are written anew do not belong to the whole path.
    let envelope = r#"<vehicleEnvelope key="k"><vertex x="0" y="0"/></vehicleEnvelope>"#;
    let settings = WriteOptions { envelopes: Some("k".into()), split: Some(2.0), ..settings(ExclusionFormat::OpenTcs) };
    assert!(written(InputFormat::OpenTcs, &plant(envelope), 0.5, &settings).contains("c-d part 3"));
}

#[test]
fn audits_name_what_is_left_out_and_what_is_in_vain() {
    let (radius, target) = (0.3, ExclusionFormat::Nav2);
    let file = written(InputFormat::Nav2, SAMPLE, radius, &settings(target));
    let imported = imported(InputFormat::Nav2, SAMPLE, radius);
    let locks = ExclusionTable::compute(&imported, true).unwrap();
    let audit =
        |text: &str| ExclusionAudit::run(&imported, &locks, &read(target, text, &imported).unwrap(), target).unwrap();
    let whole = audit(&file);
    assert!(whole.suffices() && whole.needless.is_empty(), "{whole:?}");
    // An edge more in one list only excludes nothing; in both it is in vain.
    let lists = |text: &str, edge: u64| -> Vec<u64> {
        let root: Value = serde_json::from_str(text).unwrap();
        let of = |feature: &&Value| feature["properties"]["id"] == edge && feature["properties"]["startid"].is_number();
        let features = root["features"].as_array().unwrap();
        serde_json::from_value(features.iter().find(of).unwrap()["properties"]["metadata"]["closed_edges"].clone())
            .unwrap()
    };
    let ids: Vec<u64> = imported.layout.edges.iter().map(|edge| edge.id.to_string().parse().unwrap()).collect();
    let a = ids[0];
    let near = lists(&file, a);
    let far = *ids.iter().find(|id| !near.contains(id)).unwrap();
    let with = |text: &str, edge: u64, change: &dyn Fn(&mut Vec<u64>)| {
        let mut root: Value = serde_json::from_str(text).unwrap();
        for feature in root["features"].as_array_mut().unwrap() {
            let properties = &mut feature["properties"];
            if properties["id"] == edge && properties["startid"].is_number() {
                let mut list = lists(text, edge);
                change(&mut list);
                properties["metadata"]["closed_edges"] = list.into();
            }
        }
        root.to_string()
    };
    let once = with(&file, a, &|list| list.push(far));
    assert!(audit(&once).needless.is_empty());
    let twice = with(&once, far, &|list| list.push(a));
    assert_eq!(audit(&twice).needless.len(), 1);
    // One that is missing from one list only: who comes second is not stopped.
    let other = *near.iter().find(|id| **id != a).unwrap();
    let open = audit(&with(&file, a, &|list| list.retain(|id| *id != other)));
    assert_eq!(open.gaps.len(), 1, "{:?}", open.gaps);
    assert!(open.gaps[0].depth > 0.0 && open.gaps[0].a_length.is_some());
    // An edge that is not closed for others while somebody is on it.
    let same = audit(&with(&file, a, &|list| list.retain(|id| *id != a)));
    assert_eq!(same.gaps.iter().map(|gap| gap.relation).collect::<Vec<_>>(), ["same"]);
}

#[test]
fn what_cannot_be_written_is_refused() {
    let refused = |format, text: &str, settings: &WriteOptions, partial: bool| {
        let options = ImportOptions { partial, ..options(0.4) };
        write(format, text, &options, "site", settings).unwrap_err().to_string()
    };
    let nav2 = settings(ExclusionFormat::Nav2);
    assert!(refused(InputFormat::OpenTcs, DEMO, &nav2, false).contains("written into files of nav2"));
    assert!(refused(InputFormat::Nav2, WAREHOUSE, &nav2, true).contains("--partial"));
    let large = WAREHOUSE.replace("10000", "70000");
    assert!(refused(InputFormat::Nav2, &large, &nav2, false).contains("edge 70000"), "ids of 16 bits");
    let split = WriteOptions { split: Some(0.2), ..settings(ExclusionFormat::OpenTcs) };
    assert!(refused(InputFormat::OpenTcs, DEMO, &split, false).contains("whole millimetres"));
    let unknown = WAREHOUSE.replacen("\"id\": 0  }", "\"id\": 0, \"metadata\": { \"closed_edges\": [7] } }", 1);
    let imported = imported(InputFormat::Nav2, WAREHOUSE, 0.4);
    assert!(read(ExclusionFormat::Nav2, &unknown, &imported).unwrap_err().to_string().contains("there is no edge 7"));
}
