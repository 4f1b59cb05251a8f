//! Tests with fleets of which not all agents can have a plan.

use super::*;

/// The delays that are found in no time when a clock stops every search at once: nobody is left out who fits in.
#[test]
fn most_of_a_hundred_have_a_plan_however_little_time_there_is() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/table6-100.json");
    let scenario = Scenario::from_json(&std::fs::read_to_string(file).expect(file)).expect("a scenario");
    let effort = DelaySearchOptions { time: Some(std::time::Duration::ZERO), ..DelaySearchOptions::default() };
    let request = PlanOptions { leave_out: true, effort, ..PlanOptions::default() };
    let (plan, solved) = PlanReport::compute(&scenario, &request).expect("an answer");
    println!("{} planned, {} left out", plan.agents.len(), plan.left_out.len());
    assert!(solved.is_some() && plan.agents.len() + plan.left_out.len() == 100);
    assert!(plan.agents.len() > 50, "{:?}", plan.left_out);
    assert_eq!(plan.certificate.as_ref().map(|proof| proof.verdict), Some("proved"));
    // Each of them is named, with a reason or as one for whom none was found.
    let named = |id: &u64| plan.unsolved.iter().any(|unsolved| unsolved.ids.contains(id));
    assert!(plan.left_out.iter().all(named), "{:?}", plan.unsolved);
}

/// Motions whose ramps take less than a digit of the time, or that turn in place slower than rounding: what was written took another way
/// than the plan that was proved, and was refused when it was read.
#[test]
fn plans_are_what_is_read_from_their_files() {
    let slow = r#"{"agents":[{"id":1,"radius":0.5,"start":{"x":0,"y":0.00029899553369582606,"heading":3.665512020442172},"path":[{"kind":"turn","sweep":1},{"kind":"line","length":1}],"v_max":1.506911950465925e-07,"a_max":1,"t_start":0,"turn_v_max":0.001565762650287845,"turn_a_max":0.7681830659140476},{"id":2,"radius":0.080536964761782,"start":{"x":-20903672.724483624,"y":0.005660989921138849,"heading":-1.4622709412064667},"path":[{"kind":"turn","sweep":-656.2415135931003},{"kind":"arc","radius":1,"sweep":-3}],"v_max":6.4928648758137035e-09,"a_max":0.43559442147545313,"t_start":-1,"turn_v_max":0.009634034663909437,"turn_a_max":2.862891760852571}]}"#;
    let fast = r#"{"agents":[{"id":1,"radius":0.2483831362458482,"start":{"x":0,"y":0,"heading":1.9635447532477395},"path":[{"kind":"arc","radius":1,"sweep":5.556008449174128e-07},{"kind":"turn","sweep":-0.0014974846134741169}],"v_max":4366.455188208114,"a_max":7150397958.556232,"t_start":-9.00005485489812,"turn_v_max":0.009312073909698175,"turn_a_max":1},{"id":2,"radius":0.2483831362458482,"start":{"x":1,"y":13.618341128281351,"heading":-0.8001288909395576},"path":[{"kind":"line","length":0.4967662724916964},{"kind":"line","length":0},{"kind":"arc","radius":0.4967662724916964,"sweep":6.283185307179586},{"kind":"line","length":0.4967662724916964}],"v_max":1,"a_max":1,"t_start":0,"turn_v_max":1,"turn_a_max":1}]}"#;
    let answer = |text: &str, method| {
        let scenario = Scenario::from_json(text).expect("a scenario");
        PlanReport::compute(&scenario, &PlanOptions { method, ..PlanOptions::default() }).expect("an answer")
    };
    for (text, method) in [(slow, PlanMethod::Speed), (fast, PlanMethod::Delay)] {
        let (plan, solved) = answer(text, method);
        let solved = solved.unwrap_or_else(|| panic!("{:?}", plan.unsolved));
        assert_eq!(Scenario::from_json(&solved.to_json()).as_ref(), Ok(&solved));
        assert_eq!(plan.certificate.map(|proof| proof.verdict), Some("proved"));
    }
}

/// Who waits for a plan sees a percentage: it only grows within a part of the work, and its end is known and reached at most.
#[test]
fn planning_tells_how_far_it_is() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/paper12.json");
    let scenario = Scenario::from_json(&std::fs::read_to_string(file).expect(file)).expect("a scenario");
    let stages = |request: &PlanOptions| {
        let told = std::sync::Mutex::new(Vec::<(PlanStage, Vec<[usize; 2]>)>::new());
        let tell = |stage: PlanStage, done: usize, all: usize| {
            let mut told = told.lock().expect("a list");
            match told.last_mut().filter(|(last, _)| *last == stage) {
                Some((_, counts)) => counts.push([done, all]),
                None => told.push((stage, vec![[done, all]])),
            }
        };
        let (_, solved) = PlanReport::watched(&scenario, request, &tell).expect("an answer");
        assert!(solved.is_some());
        told.into_inner().expect("a list")
    };
    for (method, second) in [(PlanMethod::Delay, PlanStage::Check), (PlanMethod::Speed, PlanStage::Speeds)] {
        let told = stages(&PlanOptions::new(method));
        let order: Vec<PlanStage> = told.iter().map(|(stage, _)| *stage).collect();
        assert_eq!(order[..3], [PlanStage::Regions, PlanStage::Delays, second], "{order:?}");
        assert_eq!(order.last(), Some(&PlanStage::Check));
        for (stage, counts) in &told {
            let all = counts[0][1];
            assert!(all > 0 && counts.iter().all(|&[done, of]| done <= all && of == all), "{stage:?} {counts:?}");
            assert!(counts.windows(2).all(|pair| pair[0][0] <= pair[1][0]), "{stage:?} {counts:?}");
            if *stage != PlanStage::Speeds {
                assert_eq!(counts.last(), Some(&[all, all]), "{stage:?}");
            }
        }
    }
    // A search without a limit has no end that is known.
    let effort = DelaySearchOptions { prove: true, ..DelaySearchOptions::default() };
    let told = stages(&PlanOptions { effort, ..PlanOptions::default() });
    let searches = told.iter().find(|(stage, _)| *stage == PlanStage::Delays).expect("searches");
    assert!(searches.1.iter().all(|[_, all]| *all == 0), "{searches:?}");
}
