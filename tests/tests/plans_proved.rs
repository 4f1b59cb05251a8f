//! Start delays of whole scenarios: solved where they were not, proved to be the best, certified.

use pcr_formats::scenario::Scenario;
use pcr_planning::plan::{Objective, PlanMethod, PlanOptions, PlanReport, PriorityRule};

const SOLVABLE: [(&str, &str); 3] = [
    ("dense", include_str!("../data/cases/solvable-dense-10358.json")),
    ("lanes", include_str!("../data/cases/solvable-lanes-10008.json")),
    ("swap", include_str!("../data/cases/solvable-swap-10078.json")),
];

const PAPER: [(&str, &str); 5] = [
    ("5", include_str!("../data/table6-5.json")),
    ("12", include_str!("../data/table6-12.json")),
    ("paper12", include_str!("../data/paper12.json")),
    ("30", include_str!("../data/table6-30.json")),
    ("50", include_str!("../data/table6-50.json")),
];

#[track_caller]
fn planned(text: &str, request: &PlanOptions) -> (PlanReport, Option<Scenario>) {
    PlanReport::compute(&Scenario::from_json(text).unwrap(), request).unwrap()
}

#[track_caller]
fn proved(plan: &PlanReport) {
    let costs = plan.costs.unwrap();
    assert!(costs.proved && costs.gap < 1e-6 && costs.lower_bound <= costs.sum_of_costs, "{plan:?}");
    assert_eq!(plan.certificate.as_ref().map(|proof| proof.verdict), Some("proved"), "{plan:?}");
}

#[test]
fn fleets_that_have_delays_get_the_best_ones() {
    for (name, text) in SOLVABLE {
        let (plan, solved) = planned(text, &PlanOptions::default());
        assert!(solved.is_some() && plan.unsolved.is_empty() && plan.left_out.is_empty(), "{name}: {plan:?}");
        proved(&plan);
    }
}

#[test]
fn an_order_of_priority_costs_no_less_and_has_the_same_bound() {
    for (name, text) in &PAPER[..3] {
        let best = planned(text, &PlanOptions::default()).0;
        proved(&best);
        for priority in [PriorityRule::Longest, PriorityRule::Crowded] {
            let plan = planned(text, &PlanOptions { priority, ..PlanOptions::default() }).0;
            let [costs, least] = [&plan, &best].map(|plan| plan.costs.unwrap());
            assert!(plan.unsolved.is_empty() && costs.sum_of_costs >= least.sum_of_costs - 1e-9, "{name}: {plan:?}");
            assert!((costs.lower_bound - least.lower_bound).abs() < 1e-6, "{name}: {plan:?}");
        }
    }
}

#[test]
fn the_last_arrival_is_the_earliest_if_that_is_asked_for() {
    let least = PlanOptions { objective: Objective::Makespan, ..PlanOptions::default() };
    for (name, text) in PAPER[..3].iter().chain(&SOLVABLE) {
        let plans = [PlanOptions::default(), least.clone()].map(|request| planned(text, &request).0);
        assert_eq!(plans[1].objective, "makespan");
        let [sum, last] = plans.map(|plan| plan.costs.unwrap());
        assert!(last.makespan <= sum.makespan + 1e-9 && sum.sum_of_costs <= last.sum_of_costs + 1e-9, "{name}");
        assert!(last.proved && last.lower_bound <= last.makespan && last.gap < 1e-6, "{name}: {last:?}");
    }
}

#[test]
fn the_others_have_a_plan_if_some_are_left_out() {
    for (name, text) in &PAPER[3..] {
        let whole = planned(text, &PlanOptions::default());
        assert!(whole.1.is_none() && whole.0.agents.is_empty(), "{name}: {whole:?}");
        let (plan, solved) = planned(text, &PlanOptions { leave_out: true, ..PlanOptions::default() });
        proved(&plan);
        assert_eq!(plan.unsolved, whole.0.unsolved, "{name}");
        // Whoever is left out is in a set that is named, and every set loses one.
        assert!(
            plan.left_out.iter().all(|id| plan.unsolved.iter().any(|unsolved| unsolved.ids.contains(id))),
            "{name}"
        );
        let loses = |ids: &[u64]| ids.iter().any(|id| plan.left_out.contains(id));
        assert!(plan.unsolved.iter().all(|unsolved| loses(&unsolved.ids)), "{name}: {plan:?}");
        assert_eq!(plan.agents.len(), solved.unwrap().agents.len(), "{name}");
    }
}

#[test]
fn speeds_cost_no_more_than_delays() {
    for (name, text) in SOLVABLE.iter().chain(&PAPER[..1]) {
        let [later, faster] =
            [PlanMethod::Delay, PlanMethod::Speed].map(|method| planned(text, &PlanOptions::new(method)));
        let [cost, of_delays] = [&faster.0, &later.0].map(|plan| plan.costs.unwrap().sum_of_costs);
        assert!(cost <= of_delays + 1e-9, "{name}: {:?}", faster.0);
        assert_eq!(faster.0.certificate.map(|proof| proof.verdict), Some("proved"), "{name}");
    }
}
