//! Large fleets: rows that are streamed are those that are held, and agents that are far away cost nothing.

use pcr_comparing::compare::crowd;
use pcr_formats::scenario::Scenario;
use pcr_planning::check::CheckReport;
use pcr_planning::regions::{RegionJob, RegionOptions, RegionsReport};
use pcr_planning::report::{csv, json, sheet_csv, sheet_json};

const OUTLINES: &str = include_str!("../data/small/outlines.json");

/// What is printed at once, and what is printed row by row.
fn printed(scenario: &Scenario, request: RegionOptions) -> [[Vec<u8>; 2]; 2] {
    let answer = RegionsReport::compute::<f64>(scenario, request).unwrap();
    let sheet = RegionJob::<f64>::new(scenario, request).unwrap();
    let mut out: [[Vec<u8>; 2]; 2] = Default::default();
    csv(&answer, &mut out[0][0]).unwrap();
    json(&answer, &mut out[0][1]).unwrap();
    sheet_csv(&sheet, &|_, _| {}, &mut out[1][0]).unwrap();
    sheet_json(&sheet, &|_, _| {}, &mut out[1][1]).unwrap();
    out
}

#[test]
fn rows_are_printed_as_whole_answers_are() {
    let mut margins = crowd(60, 3);
    margins.give_margin(0.05);
    // A name that looks like what is looked for.
    margins.name = r#"\"regions\":[] "regions":[]"#.into();
    let outlines = Scenario::from_json(OUTLINES).unwrap();
    for scenario in [&crowd(200, 1), &margins, &outlines, &Scenario::default()] {
        for slices in [None, Some(2)] {
            let [whole, rows] = printed(scenario, RegionOptions { slices, ..RegionOptions::default() });
            assert!(whole == rows, "{}", scenario.name);
        }
    }
}

#[test]
fn pairs_that_are_looked_at_grow_with_the_agents() {
    let near = |agents: usize| {
        let scenario = crowd(agents, 0);
        RegionJob::<f64>::new(&scenario, RegionOptions::default()).unwrap().near() as f64 / agents as f64
    };
    let [small, large] = [1_000, 8_000].map(near);
    assert!(small > 5.0 && large < 1.3 * small, "{small} and {large} an agent");
}

#[test]
fn conflicts_of_a_crowd_are_those_of_its_pairs() {
    let scenario = crowd(150, 2);
    let all = CheckReport::compute::<f64>(&scenario, false).unwrap().conflicts;
    let mut pairs = Vec::new();
    for (k, a) in scenario.agents.iter().enumerate() {
        for b in &scenario.agents[k + 1..] {
            // The last one stands until the last arrival of all.
            let mut pair = scenario.clone();
            pair.agents = vec![a.clone(), b.clone()];
            pairs.extend(
                CheckReport::compute::<f64>(&pair, false).unwrap().conflicts.iter().map(|it| (it.i, it.j, it.t[0])),
            );
        }
    }
    let mut found: Vec<_> = all.iter().map(|conflict| (conflict.i, conflict.j, conflict.t[0])).collect();
    found.sort_by(|a, b| a.partial_cmp(b).unwrap());
    pairs.sort_by(|a, b| a.partial_cmp(b).unwrap());
    assert!(found.len() > 50 && found == pairs, "{} {}", found.len(), pairs.len());
}
