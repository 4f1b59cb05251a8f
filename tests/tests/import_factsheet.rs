//! Factsheets of VDA 5050: contours and limits, and what they become on layouts.

use pcr_formats::import::{ImportOptions, InputFormat, Warnings, scenario, vehicle};
use pcr_planning::regions::{RegionOptions, RegionsReport};
use serde_json::{Value, json};
use std::path::PathBuf;

const SHEET: &str = include_str!("../data/small/factsheet.json");
const WAREHOUSE: &str = include_str!("../data/real/nav2/warehouse_graph.geojson");
const CURVES: &str = include_str!("../data/small/plant.xml");

fn options(routes: &[&str]) -> ImportOptions {
    let fleet = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/data/small/factsheet.json"));
    ImportOptions {
        fleet: Some(fleet),
        routes: routes.iter().map(|route| (*route).to_owned()).collect(),
        ..ImportOptions::default()
    }
}

fn lines(sheet: &Value) -> (Result<pcr_formats::import::VehicleTraits, String>, String) {
    let mut warnings = Warnings::default();
    let read = vehicle(&sheet.to_string(), &ImportOptions::default(), &mut warnings);
    (read.map_err(|error| error.problem().to_owned()), warnings.lines().join("\n"))
}

/// Of two names for one limit the first one counted, whatever the other one said.
#[test]
fn limits_under_the_names_of_two_versions_have_to_be_the_same() {
    let mut sheet: Value = serde_json::from_str(SHEET).unwrap();
    let speed = |sheet: &Value| lines(sheet).0.map(|vehicle| vehicle.speed);
    (sheet["physicalParameters"]["maximumSpeed"], sheet["physicalParameters"]["speedMax"]) = (json!(1.5), json!(1.5));
    assert_eq!(speed(&sheet), Ok(1.5));
    sheet["physicalParameters"]["maximumSpeed"] = json!(0.0);
    assert_eq!(speed(&sheet), Ok(1.5));
    sheet["physicalParameters"]["maximumSpeed"] = json!(0.5);
    assert_eq!(speed(&sheet), Err("factsheet, physicalParameters: its maximumSpeed is not its speedMax".to_owned()));
}

#[test]
fn a_factsheet_gives_contour_and_limits() {
    let sheet: Value = serde_json::from_str(SHEET).unwrap();
    let fork = lines(&sheet).0.unwrap();
    assert_eq!((fork.name.as_deref(), fork.speed, fork.acceleration), (Some("Fork"), 1.5, 0.4));
    let footprint = fork.footprint.unwrap();
    assert_eq!(footprint.polygon(), [[1.3, 0.4], [-0.6, 0.4], [-0.6, -0.4], [1.3, -0.4]]);
    assert!((1.3_f64.hypot(0.4)..1.3_f64.hypot(0.4) + 1e-14).contains(&fork.radius));
    // Version 3 has other names.
    let sheet = json!({ "typeSpecification": { "seriesName": "Fork" },
        "physicalParameters": { "maximumSpeed": 1.5, "maximumAcceleration": 0.6, "maximumDeceleration": 0.4, "maximumAngularSpeed": 0.7 },
        "mobileRobotGeometry": { "envelopes2d": [ { "envelope2dId": "a", "vertices": [
            { "x": 1.3, "y": 0.4 }, { "x": -0.6, "y": 0.4 }, { "x": -0.6, "y": -0.4 }, { "x": 1.3, "y": -0.4 } ] },
            { "envelope2dId": "b", "vertices": [ { "x": 0.0, "y": 0.4 }, { "x": 0.0, "y": -0.6 }, { "x": 1.0, "y": 0.0 } ] } ] } });
    let (third, warned) = lines(&sheet);
    let third = third.unwrap();
    assert_eq!((third.speed, third.acceleration, third.rotation), (1.5, 0.4, 0.7));
    // No corner of any of them is left out.
    let corners = [[-0.6, -0.4], [0.0, -0.6], [1.3, -0.4], [1.3, 0.4], [-0.6, 0.4]];
    assert_eq!(third.footprint.unwrap().polygon(), corners);
    assert!(warned.contains("envelopes2d: there are 2; the convex hull of all is taken"), "{warned}");
}

#[test]
fn without_a_contour_length_and_width_are_taken() {
    let mut sheet: Value = serde_json::from_str(SHEET).unwrap();
    sheet["agvGeometry"] = Value::Null;
    let (fork, warned) = lines(&sheet);
    let polygon = fork.unwrap().footprint.unwrap().polygon().to_vec();
    assert_eq!(polygon, [[0.95, 0.4], [-0.95, 0.4], [-0.95, -0.4], [0.95, -0.4]]);
    assert!(warned.contains("contour: not in the file"), "{warned}");
    sheet["physicalParameters"]["width"] = Value::Null;
    // One without the other is no size.
    assert_eq!(lines(&sheet).0.unwrap_err(), "factsheet, physicalParameters, width: missing");
    sheet["physicalParameters"]["length"] = Value::Null;
    let fork = lines(&sheet).0.unwrap();
    assert_eq!((fork.footprint, fork.radius), (None, 0.5));
}

#[test]
fn what_is_wrong_is_named() {
    let wrong = |pointer: &str, value: Value| {
        let mut sheet: Value = serde_json::from_str(SHEET).unwrap();
        *sheet.pointer_mut(pointer).unwrap() = value;
        lines(&sheet).0.unwrap_err()
    };
    let points = "/agvGeometry/envelopes2d/0/polygonPoints";
    assert!(wrong(points, json!([])).contains("envelopes2d: 0 corners"));
    assert!(wrong(&format!("{points}/1/x"), json!("1")).contains("envelopes2d, point 2, x: a text"));
    let second = "/agvGeometry/envelopes2d";
    let two = json!([{ "polygonPoints": [{ "x": 1, "y": 0 }] }, { "polygonPoints": [] }]);
    assert_eq!(wrong(second, two), "factsheet, envelopes2d 2: 0 corners");
    assert!(wrong("/physicalParameters/speedMax", json!(-1)).contains("physicalParameters, speedMax: -1"));
    assert!(wrong("/agvGeometry", json!([])).contains("agvGeometry: a list where an object"));
    let neither = vehicle("{}", &ImportOptions::default(), &mut Warnings::default()).unwrap_err().problem().to_owned();
    assert!(neither.contains("rmf_fleet: missing"), "{neither}");
}

#[test]
fn agents_on_routes_have_the_contour() {
    let mut warnings = Warnings::default();
    let fleet = scenario(InputFormat::Nav2, WAREHOUSE, &options(&["0:3", "3:0"]), &mut warnings).unwrap();
    assert!(fleet.agents.iter().all(|agent| agent.footprint.as_ref().unwrap().polygon().len() == 4));
    let answer = RegionsReport::compute::<f64>(&fleet, RegionOptions::default()).unwrap();
    assert!(!answer.regions.is_empty());
    // Both turn in place.
    assert_eq!(answer.bodies.len(), 2);
    // With a radius it is a disc.
    let disc = ImportOptions { radius: Some(0.4), ..options(&["0:50"]) };
    let disc = scenario(InputFormat::Nav2, WAREHOUSE, &disc, &mut warnings).unwrap();
    assert!(disc.agents[0].footprint.is_none());
    // Turns in place at corners deviate from their node by nanometres.
    let growth = disc.agents[0].radius - 0.4;
    assert!((0.0..1e-8).contains(&growth), "{growth}");
}

#[test]
fn contours_grow_by_what_curves_are_off() {
    let mut warnings = Warnings::default();
    // The other direction of its paths, which is driven backward, is left out.
    let coarse = ImportOptions { tolerance: Some(0.02), partial: true, ..options(&["A:B"]) };
    let fleet = scenario(InputFormat::OpenTcs, CURVES, &coarse, &mut warnings).unwrap();
    let footprint = fleet.agents[0].footprint.as_ref().unwrap();
    // And what headings are off, by 0.05 rad at most.
    let most = 0.02 + 0.05 * footprint.circumscribed_radius();
    assert!(footprint.growth() > 1e-3 && footprint.growth() <= most, "{}", footprint.growth());
}
