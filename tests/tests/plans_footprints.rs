//! Start delays of vehicles with outlines: as polygons they keep clear, and they do not wait for what only the discs around them
//! would touch.

use pcr_formats::scenario::Scenario;
use pcr_planning::check::CheckReport;
use pcr_planning::fleet::Fleet;
use pcr_planning::plan::{PlanMethod, PlanOptions, PlanReport};
use pcr_tests::polygons::{Point, apart, placed};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, PI};

const TRUCK: [Point; 4] = [[-0.5, -0.3], [0.9, -0.3], [0.9, 0.3], [-0.5, 0.3]];

fn truck(id: u64, [x, y, heading]: [f64; 3], path: &Value) -> Value {
    let corners = TRUCK.iter().map(|[ahead, left]| json!({ "ahead": ahead, "left": left }));
    json!({ "id": id, "footprint": { "polygon": corners.collect::<Vec<_>>() }, "v_max": 1.0, "a_max": 0.7,
        "path": path, "start": { "x": x, "y": y, "heading": heading } })
}

fn line(length: f64) -> Value {
    json!({ "kind": "line", "length": length })
}

fn planned(agents: &[Value], method: PlanMethod) -> (PlanReport, Option<Scenario>) {
    let scenario = Scenario::from_json(&json!({ "name": "trucks", "agents": agents }).to_string()).unwrap();
    PlanReport::compute(&scenario, &PlanOptions::new(method)).unwrap()
}

/// The least distance of the outlines of a scenario.
fn clearance(scenario: &Scenario) -> f64 {
    let fleet = Fleet::<f64>::new(scenario).unwrap();
    let motions = fleet.motions();
    let end = motions.iter().map(|motion| motion.time().hi).fold(0.0, f64::max);
    let at = |time: f64| {
        let outline = |motion: &pcr_core::Motion<'_, f64>| {
            let pose = motion.path().pose_at(motion.length_at(time));
            placed(&TRUCK, [pose.position.x, pose.position.y], pose.heading.0)
        };
        let outlines: Vec<_> = motions.iter().map(outline).collect();
        let pairs = outlines.iter().enumerate().flat_map(|(k, a)| outlines[..k].iter().map(move |b| apart(a, b)));
        pairs.fold(f64::INFINITY, f64::min)
    };
    (0..=2000).map(|k| at(end * f64::from(k) / 2000.0)).fold(f64::INFINITY, f64::min)
}

#[test]
fn trucks_on_lanes_beside_one_another_need_not_wait() {
    let agents = [truck(1, [-4.0, 0.0, 0.0], &json!([line(8.0)])), truck(2, [4.0, 0.9, PI], &json!([line(8.0)]))];
    let (plan, solved) = planned(&agents, PlanMethod::Delay);
    assert!(plan.agents.iter().all(|agent| agent.delay == 0.0), "{plan:?}");
    assert!(clearance(&solved.unwrap()) > 0.29);
    // A speed plan takes the discs around them, which meet head-on; but the delays are a plan.
    let (plan, solved) = planned(&agents, PlanMethod::Speed);
    assert!(
        solved.is_some() && plan.costs.unwrap().proved && plan.agents.iter().all(|agent| agent.delay == 0.0),
        "{plan:?}"
    );
}

#[test]
fn trucks_that_cross_wait_as_long_as_their_outlines_do() {
    let around = json!([line(3.0), { "kind": "arc", "radius": 1.2, "sweep": FRAC_PI_2 }, line(3.0)]);
    let agents = [
        truck(1, [-4.0, 0.0, 0.0], &around),
        truck(2, [-2.0, -4.0, FRAC_PI_2], &json!([line(8.0)])),
        truck(3, [4.0, 1.3, PI], &json!([line(9.0)])),
    ];
    let (plan, solved) = planned(&agents, PlanMethod::Delay);
    let solved = solved.unwrap();
    assert!(plan.unsolved.is_empty() && clearance(&solved) > 0.0, "{plan:?}");
    assert_eq!(CheckReport::compute::<f64>(&solved, false).unwrap().conflicts, []);
    let waits: Vec<f64> = plan.agents.iter().map(|agent| agent.delay).collect();
    assert!(waits.iter().any(|wait| *wait > 0.1), "{waits:?}");
    // Any of them half a second earlier, and the outlines touch: no wait is longer than what their covers take.
    for (place, wait) in waits.iter().enumerate().filter(|(_, wait)| **wait > 0.0) {
        let mut earlier = solved.clone();
        earlier.agents[place].t_start -= f64::min(0.5, *wait);
        assert_ne!(CheckReport::compute::<f64>(&earlier, false).unwrap().conflicts, [], "{place}");
    }
}

#[test]
fn trucks_that_meet_head_on_have_no_plan() {
    let agents = [truck(7, [-4.0, 0.0, 0.0], &json!([line(8.0)])), truck(3, [4.0, 0.1, PI], &json!([line(8.0)]))];
    let (plan, solved) = planned(&agents, PlanMethod::Delay);
    assert!(solved.is_none());
    assert!(plan.unsolved[0].why.contains("head-on"), "{plan:?}");
    assert_eq!(plan.unsolved[0].ids.iter().sum::<u64>(), 10);
}
