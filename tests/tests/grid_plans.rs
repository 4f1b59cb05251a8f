//! Plans on grids, read and carried out while robots are late: nobody touches anybody, everybody arrives, later than planned and no later than
//! by cells.

use pcr_formats::import::{GridPlan, ImportOptions, InputFormat, Warnings, scenario};
use pcr_lab::grid_plans::{ExecutionMethod, GridRunResult, carried_out, random_stops, situation};
use pcr_planning::certify::MotionCertificate;

const NAMES: [&str; 3] = ["11_an_60", "17_an_95", "24_an_95"];
const PLANS: [&str; 3] = [
    include_str!("../data/real/stpg/map_random-32-32-10_ins_11_an_60.path"),
    include_str!("../data/real/stpg/map_random-32-32-10_ins_17_an_95.path"),
    include_str!("../data/real/stpg/map_random-32-32-10_ins_24_an_95.path"),
];
const SITUATION: &str = include_str!("../data/real/stpg/map_random-32-32-10_ins_24_an_95_sit_0.json");

const RADII: [f64; 2] = [0.35, 0.45];

fn plan(text: &str) -> GridPlan {
    GridPlan::read(text).expect("a plan")
}

/// Mean time until the agents that have a way arrive as planned \[s\].
fn planned(plan: &GridPlan) -> f64 {
    let end = |cells: &Vec<[i32; 2]>| cells.iter().rposition(|cell| Some(cell) != cells.last()).map(|last| last + 1);
    let ends: Vec<usize> = plan.cells().iter().filter_map(end).collect();
    ends.iter().sum::<usize>() as f64 / ends.len() as f64
}

#[track_caller]
fn assert_sound(outcome: &GridRunResult, case: &str) {
    assert_eq!((outcome.proof.verdict, outcome.stuck), ("proved", 0), "{case}: {:?}", outcome.proof);
    assert!(outcome.travel >= outcome.alone, "{case}");
}

#[test]
fn plans_are_what_was_published_for_discs_of_half_a_cell() {
    for (name, text) in NAMES.into_iter().zip(PLANS) {
        let file = format!("{name}.path");
        assert_eq!(InputFormat::detect(file.as_ref(), text), Some(InputFormat::Grid), "{name}");
        let mut warnings = Warnings::default();
        let options = ImportOptions { radius: Some(0.499), ..ImportOptions::default() };
        let read = scenario(InputFormat::Grid, text, &options, &mut warnings).expect("a plan");
        assert_eq!(read.agents.len(), plan(text).cells().len());
        assert_eq!(MotionCertificate::prove::<f64>(&read).expect("a scenario").verdict, "proved", "{name}");
        assert!(warnings.lines().is_empty(), "{:?}", warnings.lines());
        // A plan with a contact of discs is none for orders.
        let wide = carried_out(&plan(text), 0.51, ExecutionMethod::Orders, &Vec::new());
        assert!(wide.is_err(), "{name}");
    }
    let radius =
        scenario(InputFormat::Grid, PLANS[0], &ImportOptions::default(), &mut Warnings::default()).expect("a plan");
    // And what turns in place displace.
    assert!((radius.agents[0].radius - 0.35).abs() < 1e-6);
}

#[test]
fn without_stops_plans_are_carried_out_as_planned() {
    for (name, text) in NAMES.into_iter().zip(PLANS) {
        let plan = plan(text);
        for by in [ExecutionMethod::Orders, ExecutionMethod::Switching, ExecutionMethod::Cells] {
            let outcome = carried_out(&plan, 0.45, by, &Vec::new()).expect("a plan");
            assert_sound(&outcome, name);
            // Nobody waits for a time: who can go on does.
            assert!(outcome.travel <= planned(&plan) + 0.1, "{name}: {} {}", outcome.travel, planned(&plan));
        }
    }
}

#[test]
fn late_robots_touch_nobody_and_arrive() {
    let mut earlier = [0.0; 2];
    for (name, text) in NAMES.into_iter().zip(PLANS) {
        let plan = plan(text);
        let robots = plan.cells().len();
        let mut stops = vec![random_stops(robots, 500, 0.01, 1), random_stops(robots, 500, 0.03, 2)];
        if name == NAMES[2] {
            stops.push(situation(SITUATION, robots).expect("its situation"));
        }
        for stops in stops {
            assert!(stops.iter().any(|stops| !stops.is_empty()));
            let cells = carried_out(&plan, 0.45, ExecutionMethod::Cells, &stops).expect("a plan");
            assert_sound(&cells, name);
            let mut last = 0.0;
            for (radius, earlier) in RADII.into_iter().zip(&mut earlier) {
                let orders = carried_out(&plan, radius, ExecutionMethod::Orders, &stops).expect("a plan");
                assert_sound(&orders, name);
                assert_eq!(orders.alone, cells.alone);
                let switching = carried_out(&plan, radius, ExecutionMethod::Switching, &stops).expect("a plan");
                assert_sound(&switching, name);
                assert!(switching.travel < orders.travel, "{name}, {radius}: {}", switching.travel);
                // Smaller discs wait for less.
                assert!(orders.travel >= last && orders.travel < cells.travel, "{name}, {radius}: {}", orders.travel);
                last = orders.travel;
                *earlier += cells.travel - orders.travel;
            }
        }
    }
    assert!(earlier[0] > earlier[1] && earlier[1] > 1.0, "{earlier:?}");
}

#[test]
fn who_never_goes_on_keeps_only_those_behind() {
    let plan = plan(
        "2\nAgent 0: (0,0)->(1,0)->(2,0)->(3,0)->\nAgent 1: (2,-3)->(2,-3)->(2,-3)->(2,-2)->(2,-1)->(2,0)->(2,1)->\n",
    );
    // Whoever has not come to the crossing lets the other one go first.
    let stops = vec![vec![[1.0, 100.0]], Vec::new()];
    let outcome = carried_out(&plan, 0.4, ExecutionMethod::Switching, &stops).expect("a plan");
    assert_sound(&outcome, "switching");
    assert!((outcome.travel - outcome.alone).abs() < 1e-9, "{outcome:?}");
    for by in [ExecutionMethod::Orders, ExecutionMethod::Cells] {
        let stops = vec![vec![[1.0, 100.0]], Vec::new()];
        let outcome = carried_out(&plan, 0.4, by, &stops).expect("a plan");
        assert_sound(&outcome, by.name());
        assert!(outcome.makespan > 101.0, "{outcome:?}");
        // The other one way round nobody waits.
        let outcome = carried_out(&plan, 0.4, by, &vec![Vec::new(), vec![[0.0, 50.0]]]).expect("a plan");
        assert!((outcome.travel - outcome.alone).abs() < 1e-9);
    }
}

#[test]
fn situations_of_other_plans_are_refused() {
    assert!(situation(SITUATION, 60).is_err() && situation("{}", 95).is_err());
    let stops = situation(SITUATION, 95).expect("its situation");
    assert_eq!(stops.iter().flatten().count(), 2);
    assert_eq!(stops[1], [[3.0, 16.0]]);
}
