//! Footprints that are convex polygons.

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
        assert!(found.get("bodies").is_none());
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
    assert!(answer.get("bodies").is_none());
}

#[test]
fn what_is_certified_are_the_outlines_and_the_answer_says_so() {
    for (name, apart, is_free) in [("near.json", 0.801, true), ("touch.json", 0.799, false)] {
        let near = lanes(name, apart);
        let status = i32::from(!is_free);
        let certified = run(&["check", &near, "--json", "--certify"]).json_of(status);
        let proof = &certified["certificate"];
        assert_eq!(proof["verdict"], if is_free { "proved" } else { "contact" }, "{certified}");
        assert!(proof["outlines"] == 2 && certified.get("bodies").is_none(), "{certified}");
        for scalar in FORMATS {
            let table = run(&["regions", &near, "--json", "--certificate", "--scalar", scalar]).json();
            assert!(table.get("bodies").is_none());
            assert_eq!(table["regions"].as_array().unwrap().is_empty(), is_free, "{scalar}");
            let name = file("outlines", "table.json", table.to_string());
            let proved = run(&["certify", "--table", &name, "--json"]).json();
            assert_eq!((&proved["verdict"], &proved["outlines"]), (&json!("proved"), &json!(2)), "{scalar}");
            if !is_free {
                // Without its region.
                let mut other = table;
                let pair = &mut other["certificate"][0]["pairs"][0];
                (pair["regions"], pair["pieces"]) = (json!([]), json!([]));
                other.as_object_mut().unwrap().remove("regions");
                let name = file("outlines", "without.json", other.to_string());
                assert_eq!(run(&["certify", "--table", &name, "--json"]).json_of(1)["verdict"], "refuted", "{scalar}");
            }
        }
        let told = run(&["certify", &near]).ok();
        assert!(told.starts_with("lanes: proved; 2 outlines, 1 pair of segments"), "{told}");
    }
}

#[test]
fn plans_of_outlines_are_planned_and_proved_as_they_are() {
    let near = lanes("plan.json", 0.801);
    for method in ["delay", "speed"] {
        let plan = run(&["plan", &near, "--method", method, "--json"]).json();
        let delays = plan["agents"].as_array().unwrap().iter().map(|agent| agent["delay"].as_f64().unwrap());
        assert!(delays.fold(0.0, f64::max) == 0.0 && plan["proved"] == true, "{plan}");
        assert_eq!(plan["certificate"]["outlines"], 2, "{plan}");
    }
    let told = run(&["plan", &near]).ok();
    let line = "certificate: no contact at any time, proved (1 pair of bodies; 2 outlines)";
    assert!(told.contains(line), "{told}");
}
