//! Footprints that are convex polygons, which `pcr regions` and `pcr check` compute with as they are.

use crate::fixture::{file, run, straight};
use serde_json::{Value, json};
use std::f64::consts::PI;

const FORMATS: [&str; 4] = ["f64", "f32", "q20", "q16"];

fn truck(id: u64, start: [f64; 3]) -> Value {
    let corner = |[ahead, left]: [f64; 2]| json!({ "ahead": ahead, "left": left });
    let polygon = [[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]].map(corner);
    let mut truck = straight(id, start, 6.0);
    truck.as_object_mut().unwrap().remove("radius");
    truck["footprint"] = json!({ "polygon": polygon });
    truck
}

/// Two trucks, 0.8 m wide, on lanes at this distance.
fn lanes(name: &str, apart: f64) -> String {
    let agents = [truck(1, [0.0, 0.0, 0.0]), truck(2, [6.0, apart, PI])];
    file("outlines", name, json!({ "name": "lanes", "agents": agents }).to_string())
}

#[test]
fn trucks_pass_each_other_a_millimetre_apart() {
    let (free, not) = (lanes("free.json", 0.801), lanes("not.json", 0.799));
    for scalar in FORMATS {
        let regions = |file: &str| run(&["regions", file, "--json", "--slices", "1", "--scalar", scalar]).json();
        assert_eq!(regions(&free)["regions"], json!([]), "{scalar}");
        let found = regions(&not);
        let [region, _] = &found["regions"].as_array().unwrap()[..] else { panic!("{scalar}: {found}") };
        assert!(region["slices"][0]["l"].as_array().is_some_and(|slice| !slice.is_empty()), "{scalar}: {found}");
        assert_eq!((&region["pieces"][0]["i_segment"], &region["pieces"][0]["type"]), (&json!(1), &json!("SS")));
        assert!(found.get("footprints").is_none());
        assert_eq!(run(&["check", &free, "--scalar", scalar]).status, 0, "{scalar}");
        assert_eq!(run(&["check", &not, "--scalar", scalar]).status, 1, "{scalar}");
    }
}

#[test]
fn the_closest_approach_is_that_of_the_outlines() {
    let answer = run(&["check", &lanes("closest.json", 1.0), "--json", "--closest"]).json();
    let [clearance, separation] = ["clearance", "separation"].map(|key| answer["closest"][0][key].as_f64().unwrap());
    assert!((clearance - 0.2).abs() < 1e-9, "{clearance}");
    // The trucks are beside one another, their reference points up to 1.2 m apart along the lanes.
    assert!((1.0 - 1e-9..1.2_f64.hypot(1.0) + 1e-6).contains(&separation), "{separation}");
    assert!(answer.get("footprints").is_none());
}

#[test]
fn what_is_certified_are_covers_and_the_answer_says_so() {
    // Covers of these trucks are 0.97 m wide.
    let near = lanes("near.json", 0.9);
    let ids = |answer: &Value| -> Vec<u64> {
        answer["footprints"].as_array().unwrap().iter().map(|cover| cover["id"].as_u64().unwrap()).collect()
    };
    assert_eq!(run(&["check", &near, "--json"]).json()["conflicts"], json!([]));
    let certified = run(&["check", &near, "--json", "--certify"]).json_of(1);
    assert!(ids(&certified) == [1, 2] && certified["certificate"]["verdict"] == "contact", "{certified}");
    assert!(!certified["conflicts"].as_array().unwrap().is_empty());
    let table = run(&["regions", &near, "--json", "--certificate"]).json();
    assert!(ids(&table) == [1, 2] && !table["regions"].as_array().unwrap().is_empty());
    let name = file("outlines", "table.json", table.to_string());
    assert_eq!(run(&["certify", "--table", &name, "--json"]).json()["verdict"], "proved");
    let apart = run(&["check", &lanes("apart.json", 1.0), "--json", "--certify"]).json();
    assert_eq!((ids(&apart), &apart["certificate"]["verdict"]), (vec![1, 2], &json!("proved")));
}
