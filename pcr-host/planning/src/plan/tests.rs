//! Tests with fleets of which not all agents can have a plan.

use super::*;

/// The delays that are found in no time when a clock stops every search at once: nobody is left out who fits in.
#[test]
fn most_of_a_hundred_have_a_plan_however_little_time_there_is() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/table6-100.json");
    let scenario = Scenario::from_json(&std::fs::read_to_string(file).expect(file)).expect("a scenario");
    let effort = Effort { time: Some(std::time::Duration::ZERO), ..Effort::default() };
    let request = Request { leave_out: true, effort, ..Request::default() };
    let (plan, solved) = Plan::of(&scenario, &request).expect("an answer");
    println!("{} planned, {} left out", plan.agents.len(), plan.left_out.len());
    assert!(solved.is_some() && plan.agents.len() + plan.left_out.len() == 100);
    assert!(plan.agents.len() > 50, "{:?}", plan.left_out);
    assert_eq!(plan.certificate.as_ref().map(|proof| proof.verdict), Some("proved"));
    // Each of them is named, with a reason or as one for whom none was found.
    let named = |id: &u64| plan.unsolved.iter().any(|unsolved| unsolved.ids.contains(id));
    assert!(plan.left_out.iter().all(named), "{:?}", plan.unsolved);
}
