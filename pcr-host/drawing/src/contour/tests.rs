//! Compares outlines with the definition and with the reference regions.

use super::*;
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::{Fleet, build_ecm};
use serde_json::{Value, json};

/// Distance of an outline from the contour \[m\]: slices are rounded outward by a few ulp of some 10 m.
const RESIDUAL: f64 = 1e-9;

/// The same of the ends of regions \[m, s\], as in the tests of the reference regions: those of an overlap of a micrometre move more than
/// what they are rounded by.
const EXTENT: f64 = 2e-9;

/// Pixels along each side of a region in these tests.
const PIXELS: f64 = 300.0;

/// Area between an outline and the region, as a part of the box around it: [`TOLERANCE`] along an outline of at
/// most four sides, twice as long for the bends.
const AREA: f64 = 8.0 * TOLERANCE / PIXELS;

fn scenario(agents: &Value) -> Scenario {
    Scenario::from_json(&json!({ "agents": agents }).to_string()).unwrap()
}

/// Calls `check` with every region of the scenario, its ego and its outline.
fn for_all(scenario: &Scenario, mut check: impl FnMut(&RegionRef<'_, f64>, &Motion<'_, f64>, &RegionOutline)) {
    let fleet = Fleet::<f64>::new(scenario).unwrap();
    let motions = fleet.motions();
    let ecm = build_ecm(&motions).unwrap();
    for region in ecm.regions(&motions).expect("the table of the fleet") {
        let ego = &motions[region.ego()];
        let pixel = [region.time(), region.length()].map(|side| side.length().max(1e-6) / PIXELS);
        check(&region, ego, &trace(&region, ego, pixel));
    }
}

fn area(contour: &[[f64; 2]]) -> f64 {
    let sides = contour.iter().zip(contour.iter().cycle().skip(1));
    sides.map(|(a, b)| (a[0] - contour[0][0]) * (b[1] - a[1]) - (a[1] - contour[0][1]) * (b[0] - a[0])).sum::<f64>()
        / 2.0
}

fn golden() -> Vec<Value> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/golden-public.json");
    let golden: Value = serde_json::from_str(&std::fs::read_to_string(file).expect(file)).unwrap();
    golden["cases"].as_array().unwrap().iter().filter(|case| case["uncertain"] == json!(false)).cloned().collect()
}

fn golden_scenario(case: &Value) -> Scenario {
    let mut agents = [case["i"].clone(), case["j"].clone()];
    agents[0]["id"] = json!(1);
    agents[1]["id"] = json!(2);
    scenario(&json!(agents))
}

#[test]
fn every_point_is_on_the_contour_or_at_an_end_of_the_path() {
    let paper = Scenario::from_json(pcr_formats::paper_example::SCENARIO).unwrap();
    for scenario in golden().iter().map(golden_scenario).chain([paper]) {
        for_all(&scenario, |region, ego, outline| {
            let (other, whole) = (region.other_motion(), ego.path().length());
            for [time, length] in outline.iter().flatten() {
                let (a, b) = (ego.path().point_at(*length), other.position_at(*time));
                let residual = (a.x - b.x).hypot(a.y - b.y) - ego.radius() - other.radius();
                let at_end = *length <= RESIDUAL || *length >= whole - RESIDUAL;
                assert!(residual.abs() < RESIDUAL || at_end && residual < 0.0, "{time} {length} {residual:e}");
            }
        });
    }
}

#[test]
fn outlines_enclose_the_areas_of_the_reference_regions() {
    let mut regions = 0;
    for case in golden() {
        let mut found = Vec::new();
        for_all(&golden_scenario(&case), |region, _, outline| {
            if region.ego() == 0 {
                let (time, length) = (region.time(), region.length());
                found.push(([time.lo, time.hi, length.lo, length.hi], outline.iter().map(|c| area(c)).sum::<f64>()));
            }
        });
        for component in case["components"].as_array().unwrap() {
            let extents = [("t", 0), ("t", 1), ("l", 0), ("l", 1)].map(|(key, k)| component[key][k].as_f64().unwrap());
            let same = |found: &[f64; 4]| found.iter().zip(extents).all(|(a, b)| (a - b).abs() < EXTENT);
            let (_, inside) = found.iter().find(|(found, _)| same(found)).unwrap();
            let want = component["area"].as_f64().unwrap();
            let bounds = (extents[1] - extents[0]) * (extents[3] - extents[2]);
            assert!((inside - want).abs() <= AREA * bounds + 1e-12, "{}: {inside} for {want}", case["name"]);
            regions += 1;
        }
    }
    assert!(regions > 300, "{regions}");
}

#[test]
fn a_crossing_is_one_outline_around_a_region_without_holes() {
    let paper = Scenario::from_json(pcr_formats::paper_example::SCENARIO).unwrap();
    for_all(&paper, |region, _, outline| {
        assert_eq!(outline.len(), 1, "{} {}", region.ego(), region.other());
        assert!(area(&outline[0]) > 0.0);
    });
}

#[test]
fn a_region_that_splits_and_merges_again_has_a_hole() {
    // The ego comes back on a second lane; the other goes down between the lanes and back.
    let agents = json!([
        { "id": 1, "radius": 0.4, "v_max": 1, "a_max": 1, "start": { "x": 0, "y": -0.5, "heading": 0 }, "path": [
            { "kind": "line", "length": 6 }, { "kind": "arc", "radius": 0.5, "sweep": std::f64::consts::PI },
            { "kind": "line", "length": 6 } ] },
        { "id": 2, "radius": 0.4, "v_max": 1, "a_max": 1,
          "start": { "x": 6.2, "y": 0.1, "heading": std::f64::consts::PI }, "path": [
            { "kind": "line", "length": 3 }, { "kind": "arc", "radius": 0.1, "sweep": std::f64::consts::PI },
            { "kind": "line", "length": 3 } ] }
    ]);
    let mut seen = 0;
    for_all(&scenario(&agents), |region, _, outline| {
        if region.ego() == 0 {
            let mut areas: Vec<f64> = outline.iter().map(|contour| area(contour)).collect();
            areas.sort_by(f64::total_cmp);
            assert!(matches!(areas[..], [hole, all] if hole < 0.0 && all > -hole), "{areas:?}");
            seen += 1;
        }
    });
    assert_eq!(seen, 1);
}

#[test]
fn the_region_of_a_standing_agent_is_a_line() {
    let agents = json!([
        { "id": 1, "radius": 0.3, "v_max": 1, "a_max": 1, "start": { "x": 0, "y": 0, "heading": 0 },
          "path": [{ "kind": "line", "length": 4 }] },
        { "id": 2, "radius": 0.3, "v_max": 1, "a_max": 1, "t_start": 5, "start": { "x": 2, "y": 0, "heading": 0 }, "path": [] }
    ]);
    for_all(&scenario(&agents), |region, _, outline| {
        assert_eq!(outline.len(), 1);
        if region.ego() == 0 {
            assert!(outline[0].iter().all(|[time, _]| *time == 5.0));
            let lengths: Vec<f64> = outline[0].iter().map(|[_, length]| *length).collect();
            assert!(matches!(lengths[..], [lo, hi] if (lo - 1.4).abs() < RESIDUAL && (hi - 2.6).abs() < RESIDUAL));
        }
    });
}

#[test]
fn columns_are_limited_by_the_size_of_the_picture() {
    // Two discs of a micrometre that follow one another over a hundred kilometres.
    let agent = |id, x| {
        json!({ "id": id, "radius": 1e-6, "v_max": 10, "a_max": 1, "start": { "x": x, "y": 0, "heading": 0 },
        "path": [{ "kind": "line", "length": 1e5 }] })
    };
    for_all(&scenario(&json!([agent(1, 0.0), agent(2, 1.0)])), |_, _, outline| {
        let points = outline.iter().map(Vec::len).sum::<usize>();
        assert!((4..10 * PIXELS as usize).contains(&points), "{points}");
    });
}

#[test]
fn a_steep_band_is_as_thin_as_a_flat_one() {
    let square = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]];
    let flat = [[0.0, 0.0], [90.0, 0.0], [90.0, 0.5], [0.0, 0.5]];
    let steep = flat.map(|[x, y]| [0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y]);
    assert!(!is_thin(&square, 1.0) && is_thin(&flat, 1.0) && is_thin(&steep, 1.0));
    assert!(is_thin(&[[1.0, 1.0]], 1.0) && is_thin(&[], 1.0));
}
