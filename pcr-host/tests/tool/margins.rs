//! Margins: regions of their own, apart from those of contact.

use crate::fixture::{crossing, file, run};
use serde_json::{Value, json};

/// The crossing of two discs of 0.25 m; its regions are [1.5, 2.5] m and [2, 3] s.
fn with_margins(name: &str, margins: [f64; 2]) -> String {
    let mut scenario = crossing();
    for (k, margin) in margins.into_iter().enumerate().filter(|(_, margin)| *margin > 0.0) {
        scenario["agents"][k]["margin"] = json!(margin);
    }
    file(name, "crossing.json", scenario.to_string())
}

fn length(region: &Value) -> [f64; 2] {
    [0, 1].map(|end| region["l"][end].as_f64().unwrap())
}

#[test]
fn contact_is_the_same_with_and_without_margins() {
    let (plain, margins) = (with_margins("none", [0.0; 2]), with_margins("both", [0.1, 0.2]));
    let [plain, margins] = [plain, margins].map(|file| run(&["regions", &file, "--format", "json"]).json());
    assert_eq!(plain["regions"], margins["regions"]);
    assert!(plain.get("margin_regions").is_none());
    let wide: Vec<_> = margins["margin_regions"].as_array().unwrap().iter().map(length).collect();
    // 0.5 m and 0.3 m of margins on either side of the crossing at 2 m.
    assert_eq!(wide.len(), 2);
    assert!(wide.iter().all(|[lo, hi]| (lo - 1.2).abs() < 1e-12 && (hi - 2.8).abs() < 1e-12), "{wide:?}");
}

#[test]
fn the_option_is_for_agents_without_a_margin_of_their_own() {
    let file = with_margins("option", [0.1, 0.0]);
    let answer = run(&["regions", &file, "--format", "json", "--margin", "0.4"]).json();
    let [lo, hi] = length(&answer["margin_regions"][0]);
    assert!((lo - 1.0).abs() < 1e-12 && (hi - 3.0).abs() < 1e-12, "0.5 m, 0.1 m and 0.4 m: {lo} {hi}");
    let csv = run(&["regions", &file, "--format", "csv", "--margin", "0.4"]).ok();
    let last: Vec<_> = csv.lines().filter_map(|line| line.split(',').nth(11)).collect();
    assert_eq!(last, ["margin", "0", "0", "1", "1"]);
    let table = run(&["regions", &file, "--margin", "0.4"]).ok();
    assert!(table.contains("\nRegions of the discs with their margins"), "{table}");
}

#[test]
fn a_margin_below_zero_is_refused() {
    let file = with_margins("zero", [0.0; 2]);
    for margin in ["-0.1", "nan", "inf", "1e7", "a"] {
        let run = run(&["regions", &file, &format!("--margin={margin}")]);
        assert!(run.status == 2 && run.err.contains("--margin"), "{margin}: {}", run.err);
    }
    let mut scenario = crossing();
    scenario["agents"][1]["margin"] = json!(-0.1);
    let run = run(&["regions", &crate::fixture::file("below", "crossing.json", scenario.to_string())]);
    assert!(run.status == 2 && run.err.contains("agent 2, margin: -0.1"), "{}", run.err);
}
