//! What random fleets forbid, and the start delays that are found for them, a line of JSON a fleet, for `start_delays.py` beside this file:
//! `start_delays SECONDS FIRST_SEED COUNT LEAST LARGEST`, or `start_delays SECONDS FILE...`. SECONDS is the time limit, 0 for none.
//!
//! Fleets have LEAST to LARGEST agents, one size after the other; agents that cannot go together with the others are left out.

use pcr_comparing::compare::crowd;
use pcr_formats::scenario::Scenario;
use pcr_planning::plan::{DelaySearchOptions, ForbiddenDelays, Objective, PlanOptions, PlanReport};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

fn main() {
    let mut arguments = std::env::args().skip(1);
    let seconds: f64 = arguments.next().and_then(|seconds| seconds.parse().ok()).expect("a time limit");
    let effort = DelaySearchOptions { time: (seconds > 0.0).then(|| Duration::from_secs_f64(seconds)), prove: false };
    let arguments: Vec<String> = arguments.collect();
    let numbers: Vec<u64> = arguments.iter().map_while(|argument| argument.parse().ok()).collect();
    if let &[first, count, least, largest] = &numbers[..] {
        for seed in first..first + count {
            let agents = least + seed % (largest + 1 - least);
            println!("{}", answered(&format!("seed {seed}"), &crowd(agents as usize, seed), effort));
        }
        return;
    }
    for file in &arguments {
        let text = std::fs::read_to_string(file).expect("a file");
        println!("{}", answered(file, &Scenario::from_json(&text).expect("a scenario"), effort));
    }
}

fn answered(name: &str, scenario: &Scenario, effort: DelaySearchOptions) -> Value {
    let forbidden = ForbiddenDelays::compute(scenario).expect("a fleet");
    let count = forbidden.len();
    let pairs = (0..count).flat_map(|i| (0..i).map(move |j| [i, j])).filter_map(|[i, j]| {
        let intervals: Vec<[Value; 2]> = forbidden.intervals(i, j).map(|ends| ends.map(number)).collect();
        (!intervals.is_empty()).then(|| json!({ "agents": [i, j], "forbidden": intervals }))
    });
    let ids: Vec<u64> = scenario.agents.iter().map(|agent| agent.id).collect();
    let ends: Vec<f64> = scenario.agents.iter().map(|agent| forbidden_end(scenario, agent.id)).collect();
    let pairs: Vec<Value> = pairs.collect();
    let plans = [Objective::Sum, Objective::Makespan].map(|objective| {
        let begin = Instant::now();
        let request = PlanOptions { objective, leave_out: true, effort, ..PlanOptions::default() };
        let (plan, _) = PlanReport::compute(scenario, &request).expect("an answer");
        let taken = begin.elapsed().as_secs_f64();
        let delays: Vec<Value> = plan.agents.iter().map(|planned| json!([planned.id, planned.delay])).collect();
        json!({
            "objective": plan.objective, "sum_of_costs": plan.costs.map(|costs| costs.sum_of_costs),
            "makespan": plan.costs.map(|costs| costs.makespan), "lower_bound": plan.costs.map(|costs| costs.lower_bound),
            "gap": plan.costs.map(|costs| costs.gap), "proved": plan.costs.is_some_and(|costs| costs.proved),
            "left_out": plan.left_out,
            "unsolved": plan.unsolved.iter().map(|unsolved| &unsolved.ids).collect::<Vec<_>>(), "delays": delays, "seconds": taken
        })
    });
    json!({ "name": name, "ids": ids, "ends": ends, "pairs": pairs, "plans": plans })
}

/// When an agent arrives without a delay \[s\]: of the fleet alone.
fn forbidden_end(scenario: &Scenario, id: u64) -> f64 {
    let alone = Scenario {
        agents: scenario.agents.iter().filter(|agent| agent.id == id).cloned().collect(),
        ..scenario.clone()
    };
    PlanReport::compute(&alone, &PlanOptions::default()).expect("one agent").0.costs.expect("a plan").makespan
}

/// An end of an interval, none where it is infinite.
fn number(end: f64) -> Value {
    if end.is_finite() { json!(end) } else { Value::Null }
}
