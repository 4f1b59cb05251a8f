//! What a plan says of itself is so: margins are kept, bounds hold, what is proved was, and reasons are true.

use pcr_formats::scenario::Scenario;
use pcr_planning::check::CheckReport;
use pcr_planning::plan::{DelaySearchOptions, Objective, PlanMethod, PlanOptions, PlanReport, PriorityRule};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, PI};
use std::time::Duration;

fn line(length: f64) -> Value {
    json!({ "kind": "line", "length": length })
}

fn turn(sweep: f64) -> Value {
    json!({ "kind": "turn", "sweep": sweep })
}

fn agent(id: u64, start: [f64; 3], path: &Value, more: &Value) -> Value {
    let mut agent = json!({ "id": id, "radius": 0.3, "v_max": 1.0, "a_max": 1.0, "path": path,
        "start": { "x": start[0], "y": start[1], "heading": start[2] } });
    let fields = more.as_object().unwrap().clone();
    agent.as_object_mut().unwrap().extend(fields);
    agent
}

fn read(agents: &[Value]) -> Scenario {
    Scenario::from_json(&json!({ "name": "claims", "agents": agents }).to_string()).unwrap()
}

fn clearance(scenario: &Scenario) -> f64 {
    let closest = CheckReport::compute::<f64>(scenario, true).unwrap().closest.unwrap();
    closest.iter().map(|pair| pair.clearance).fold(f64::INFINITY, f64::min)
}

/// One that turns in place keeps its own motion: its delay counts from that, and not from a delay that it has.
#[test]
fn who_keeps_its_own_motion_keeps_its_margin() {
    let turns = json!({ "margin": 0.2, "turn_v_max": 1.0, "turn_a_max": 1.0 });
    let path = json!([{ "kind": "turn", "sweep": FRAC_PI_2 }, line(6.0)]);
    for x in [-2.3, -2.1] {
        let slow = agent(2, [x, 3.0, 0.0], &json!([line(8.0)]), &json!({ "v_max": 0.5 }));
        let scenario = read(&[agent(1, [0.0; 3], &path, &turns), slow]);
        let [later, faster] = [PlanMethod::Delay, PlanMethod::Speed]
            .map(|method| PlanReport::compute(&scenario, &PlanOptions::new(method)).unwrap());
        let solved = faster.1.unwrap_or_else(|| panic!("{x}: {:?}", faster.0.unsolved));
        let [cost, of_delays] = [&faster.0, &later.0].map(|plan| plan.costs.unwrap().sum_of_costs);
        assert!(cost <= of_delays + 1e-9, "{x}: {:?}", faster.0);
        assert!(clearance(&solved) > 0.2, "{x}: {}", clearance(&solved));
    }
}

/// Starts at times since 1970, and at the latest of all: delays were known to some tenths of a second, so that optima were too high, and
/// there were said to be none where there are.
#[test]
fn late_starts_have_the_plans_of_early_ones() {
    let arc = |radius: f64, sweep: f64| json!({ "kind": "arc", "radius": radius, "sweep": sweep });
    let crossing = |t: f64| {
        let starts = json!({ "t_start": t });
        let [east, north] = [([-4.0, 0.0, 0.0], 1), ([0.0, -4.0, FRAC_PI_2], 2)];
        [east, north].map(|(start, id)| agent(id, start, &json!([line(8.0)]), &starts))
    };
    // The second one has to wait for the first for as long as there is room beside its turn.
    let rounds = |t: f64| {
        let path = json!([
            arc(0.25, 2.0 * PI),
            arc(0.5, -FRAC_PI_2),
            arc(1.6321931586055558, 5.613353710987893),
            line(2.270545553301106)
        ]);
        let own = json!({ "radius": 0.45, "v_max": 0.47494745010994044, "a_max": 1.7990277950347808, "t_start": t });
        let other = json!({ "radius": 0.35, "a_max": 1.5613073850739487, "t_start": t - 3.0 });
        let start = [1.1858181408123376, -2.0, -FRAC_PI_2];
        [agent(1, [0.0, 0.170572161272029, 0.0], &path, &own), agent(2, start, &json!([arc(0.5, -2.0 * PI)]), &other)]
    };
    let both: [&dyn Fn(f64) -> [Value; 2]; 2] = [&crossing, &rounds];
    for agents in both {
        for method in [PlanMethod::Delay, PlanMethod::Speed] {
            let costs = |t: f64| {
                let (plan, solved) = PlanReport::compute(&read(&agents(t)), &PlanOptions::new(method)).unwrap();
                let costs = plan.costs.unwrap_or_else(|| panic!("{t}: {:?}", plan.unsolved));
                assert!(solved.is_some() && (costs.proved || method == PlanMethod::Speed));
                [costs.sum_of_costs, costs.lower_bound, costs.makespan]
            };
            let early = costs(3.0);
            for t in [1.7e9, 9.9e9] {
                let late = costs(t);
                let apart = early.iter().zip(late).map(|(early, late)| (early - late).abs()).fold(0.0, f64::max);
                // Contacts have a tolerance of 1e-13 times what a vehicle of its top speed goes since the time 0 (`Encounter::tolerance`).
                assert!(apart < 5e-13 * t, "{t}: {early:?} {late:?}");
            }
        }
    }
}

/// Times before 0 are times as all others.
#[test]
fn a_last_arrival_before_0_has_its_bound() {
    let starts = |t: f64| {
        let early = json!({ "t_start": t });
        read(&[
            agent(1, [-4.0, 0.0, 0.0], &json!([line(8.0)]), &early),
            agent(2, [0.0, -4.0, FRAC_PI_2], &json!([line(8.0)]), &early),
        ])
    };
    for priority in [PriorityRule::Best, PriorityRule::Longest] {
        let request = PlanOptions { objective: Objective::Makespan, priority, ..PlanOptions::default() };
        let [late, early] = [0.0, -100.0].map(|t| PlanReport::compute(&starts(t), &request).unwrap().0.costs.unwrap());
        assert!((late.makespan - early.makespan).abs() < 1e-6, "{early:?}");
        assert!((late.lower_bound - early.lower_bound).abs() < 1e-6 && late.proved == early.proved, "{early:?}");
        assert!(early.lower_bound <= early.makespan, "{early:?}");
    }
}

/// A load that is far from the crossing does not make anybody wait there.
#[test]
fn a_load_counts_where_it_is_carried() {
    let load = |radius: f64| json!({ "loads": [{ "segments": [2, 2], "radius": radius }] });
    let crossing = read(&[
        agent(1, [-4.0, 0.0, 0.0], &json!([line(8.0), line(20.0)]), &load(1.5)),
        agent(2, [0.0, -4.0, FRAC_PI_2], &json!([line(8.0)]), &json!({})),
    ]);
    let (plan, solved) = PlanReport::compute(&crossing, &PlanOptions::default()).unwrap();
    let costs = plan.costs.unwrap();
    assert!(costs.proved && costs.sum_of_costs < 38.9 && costs.lower_bound <= costs.sum_of_costs, "{plan:?}");
    // A little less of a delay, and they meet.
    let mut sooner = solved.unwrap();
    let delayed = plan.agents.iter().position(|agent| agent.delay > 0.0).unwrap();
    sooner.agents[delayed].t_start -= 1e-4;
    assert_ne!(CheckReport::compute::<f64>(&sooner, false).unwrap().conflicts, []);
    // Back to back, and the load is as far away as that.
    let apart = read(&[
        agent(1, [0.0; 3], &json!([line(5.0), line(5.0)]), &load(2.0)),
        agent(2, [-1.0, 0.0, PI], &json!([line(5.0)]), &json!({})),
    ]);
    for method in [PlanMethod::Delay, PlanMethod::Speed] {
        let (plan, solved) = PlanReport::compute(&apart, &PlanOptions::new(method)).unwrap();
        assert!(solved.is_some() && plan.agents.iter().all(|agent| agent.delay == 0.0), "{plan:?}");
    }
    // In the way of the load for good.
    let blocked = read(&[
        agent(1, [0.0; 3], &json!([line(5.0), line(5.0)]), &load(2.0)),
        agent(2, [7.0, 1.0, 0.0], &json!([]), &json!({})),
    ]);
    let (plan, solved) = PlanReport::compute(&blocked, &PlanOptions::default()).unwrap();
    assert!(solved.is_none() && plan.unsolved.len() == 1 && !plan.unsolved[0].why.contains("starts,"), "{plan:?}");
}

/// Long vehicles side by side are none of the reasons why two others, head-on, have no plan.
#[test]
fn reasons_for_no_speeds_are_those_of_outlines() {
    let corners = [[2.0, 0.2], [-2.0, 0.2], [-2.0, -0.2], [2.0, -0.2]];
    let polygon = json!({ "polygon": corners.map(|[ahead, left]| json!({ "ahead": ahead, "left": left })) });
    let long = |id: u64, y: f64| {
        let mut long = agent(id, [0.0, y, 0.0], &json!([line(10.0)]), &json!({ "footprint": polygon }));
        long.as_object_mut().unwrap().remove("radius");
        long
    };
    let scenario = read(&[
        long(1, 0.0),
        long(2, 1.0),
        agent(3, [5.0, -5.0, FRAC_PI_2], &json!([line(10.0)]), &json!({})),
        agent(4, [5.0, 6.0, -FRAC_PI_2], &json!([line(10.0)]), &json!({})),
    ]);
    for leave_out in [false, true] {
        let request = PlanOptions { leave_out, ..PlanOptions::new(PlanMethod::Speed) };
        let (plan, solved) = PlanReport::compute(&scenario, &request).unwrap();
        assert_eq!(solved.is_some(), leave_out, "{plan:?}");
        let mut named: Vec<u64> = plan.unsolved.iter().flat_map(|unsolved| unsolved.ids.clone()).collect();
        named.sort_unstable();
        assert_eq!(named, [3, 4], "{plan:?}");
        assert!(plan.left_out.iter().all(|id| named.contains(id)), "{plan:?}");
    }
}

/// Half a second is not nothing, however long others take.
#[test]
fn a_long_plan_is_not_proved_by_its_length() {
    let turns = json!([line(3.0), { "kind": "arc", "radius": 2, "sweep": -1.5 }]);
    let waits = json!(
        [[5e8, 0.0], [1.0, 1.0], [1.0, -1.0]].map(|[duration, accel]| json!({ "duration": duration, "accel": accel }))
    );
    let slow = json!({ "id": 3, "radius": 0.3, "start": { "x": 100, "y": 100, "heading": 0 }, "path": [line(1.0)],
        "profile": { "v0": 0.0, "pieces": waits } });
    let scenario = read(&[
        agent(1, [-4.0, 0.0, 0.0], &json!([line(8.0)]), &json!({})),
        agent(2, [0.0, -4.0, FRAC_PI_2], &turns, &json!({})),
        slow,
    ]);
    let best = PlanReport::compute(&scenario, &PlanOptions::default()).unwrap().0.costs.unwrap();
    let worst = [vec![1, 2], vec![2, 1]].map(|order| {
        let plan = PlanReport::compute(
            &scenario,
            &PlanOptions { priority: PriorityRule::Given(order), ..PlanOptions::default() },
        )
        .unwrap()
        .0;
        let costs = plan.costs.unwrap();
        assert!(!costs.proved || costs.sum_of_costs < best.sum_of_costs + 1e-3, "{plan:?}");
        costs.sum_of_costs
    });
    assert!(worst.iter().any(|cost| *cost > best.sum_of_costs + 0.1), "{worst:?}");
}

/// Of a makespan an agent that is left out is no part.
#[test]
fn who_is_left_out_does_not_begin_the_makespan() {
    let early = json!({ "t_start": -50 });
    let scenario = read(&[
        agent(1, [0.0; 3], &json!([line(5.0)]), &early),
        agent(2, [0.0, 0.4, 0.0], &json!([]), &json!({})),
        agent(3, [0.0, -0.4, 0.0], &json!([]), &json!({})),
        agent(4, [20.0, 0.0, 0.0], &json!([line(5.0)]), &json!({})),
    ]);
    let request = PlanOptions { leave_out: true, ..PlanOptions::default() };
    let plan = PlanReport::compute(&scenario, &request).unwrap().0;
    assert!(plan.left_out == [1] && (plan.costs.unwrap().makespan - 6.0).abs() < 1e-9, "{plan:?}");
}

/// However many agents have no plan together, the answer comes when it has to.
#[test]
fn large_fleets_with_a_limit_of_time_are_answered() {
    const SIDE: usize = 60;
    let place = |k: usize| [(k % SIDE) as f64 * 3.0, (k / SIDE) as f64 * 3.0, (k as f64 * 0.7) % 6.25];
    let agents: Vec<Value> =
        (0..SIDE * SIDE).map(|k| agent(k as u64 + 1, place(k), &json!([line(8.0)]), &json!({}))).collect();
    let scenario = read(&agents);
    let effort = DelaySearchOptions { time: Some(Duration::from_millis(500)), ..DelaySearchOptions::default() };
    let (plan, solved) = PlanReport::compute(&scenario, &PlanOptions { effort, ..PlanOptions::default() }).unwrap();
    assert!(solved.is_none() && !plan.unsolved.is_empty());
}

fn head_on_and_one_apart() -> Scenario {
    read(&[
        agent(1, [0.0; 3], &json!([line(5.0)]), &json!({})),
        agent(2, [5.0, 0.0, PI], &json!([line(5.0)]), &json!({})),
        agent(3, [0.0, 10.0, 0.0], &json!([line(5.0)]), &json!({})),
    ])
}

/// Who is left out may have been given a priority.
#[test]
fn an_order_may_name_who_is_left_out() {
    for method in [PlanMethod::Delay, PlanMethod::Speed] {
        for order in [vec![2, 1], vec![1, 2], vec![3, 2, 1]] {
            let request =
                PlanOptions { leave_out: true, priority: PriorityRule::Given(order), ..PlanOptions::new(method) };
            let (plan, solved) = PlanReport::compute(&head_on_and_one_apart(), &request).unwrap();
            assert!(solved.is_some() && plan.left_out.len() == 1 && plan.agents.len() == 2, "{plan:?}");
        }
        let request =
            PlanOptions { priority: PriorityRule::Given(vec![4]), leave_out: true, ..PlanOptions::new(method) };
        assert!(PlanReport::compute(&head_on_and_one_apart(), &request).is_err());
    }
}

/// Discs that touch do not overlap, and neither do margins make them.
#[test]
fn what_is_too_near_is_said_as_it_is() {
    let why = |y: f64, more: Value| {
        let scenario = read(&[
            agent(1, [0.0; 3], &json!([line(5.0)]), &json!({})),
            agent(2, [0.0, y, 0.0], &json!([line(5.0)]), &more),
        ]);
        PlanReport::compute(&scenario, &PlanOptions::default()).unwrap().0.unsolved[0].why.clone()
    };
    assert!(why(0.5, json!({})).starts_with("they overlap at their starts"));
    assert!(why(0.6, json!({})).starts_with("they touch at their starts"));
    assert!(why(0.7, json!({ "margin": 0.2 })).starts_with("they are nearer than their margins at their starts"));
    assert!(why(0.5, json!({ "margin": 0.2 })).starts_with("they overlap at their starts"));
}

/// By either method, and not only the first that is found.
#[test]
fn all_pairs_that_meet_however_they_move_are_named() {
    let scenario = read(
        &(0..6).map(|k| agent(k, [0.0, 0.0, k as f64 / 10.0], &json!([line(3.0)]), &json!({}))).collect::<Vec<_>>(),
    );
    let ids = |plan: &PlanReport| {
        let mut ids: Vec<Vec<u64>> = plan.unsolved.iter().map(|unsolved| unsolved.ids.clone()).collect();
        ids.iter_mut().for_each(|ids| ids.sort_unstable());
        ids.sort_unstable();
        ids
    };
    let [delay, speed] = [PlanMethod::Delay, PlanMethod::Speed]
        .map(|method| PlanReport::compute(&scenario, &PlanOptions::new(method)).unwrap().0);
    assert_eq!((ids(&delay).len(), ids(&delay)), (15, ids(&speed)), "{speed:?}");
    // A pair without a plan is no reason against others.
    let speed = PlanReport::compute(&head_on_and_one_apart(), &PlanOptions::new(PlanMethod::Speed)).unwrap().0;
    assert_eq!(ids(&speed), [[1, 2]]);
}

/// Far along a path, the length of a turn in place (a nanometre a radian) has few digits.
#[test]
fn turns_far_along_a_path_take_their_time() {
    for far in [40.0, 129.3, 1300.0, 1e5] {
        let path = json!([line(far), turn(FRAC_PI_2), line(5.4), turn(-FRAC_PI_2), line(1.3), turn(0.3), line(7.0)]);
        let scenario = read(&[agent(1, [0.0; 3], &path, &json!({ "turn_v_max": 0.52, "turn_a_max": 1.23 }))]);
        let [later, faster] = [PlanMethod::Delay, PlanMethod::Speed]
            .map(|method| PlanReport::compute(&scenario, &PlanOptions::new(method)).unwrap().0.costs.unwrap().makespan);
        assert!((later - faster).abs() < 1e-9 * later, "{far}: {later} {faster}");
    }
}
