//! Fleets that run for a while on a real layout: no contact, nobody beyond its hold, everybody arrives in the end.

use pcr_formats::import::{self, Format, Options, Warnings};
use pcr_planning::lifelong::{Delays, Method, Outcome, Request, run};

const WAREHOUSE: &str = include_str!("../data/real/nav2/warehouse_graph.geojson");

fn warehouse(agents: usize, minutes: f64, stopped: f64, method: Method) -> Outcome {
    let options = Options {
        radius: Some(0.4),
        speed: Some(1.0),
        acceleration: Some(0.5),
        rotation: Some(1.0),
        rotation_acceleration: Some(1.0),
        ..Options::default()
    };
    let imported = import::layout(Format::Nav2, WAREHOUSE, &options, &mut Warnings::default())
        .expect("a layout of the repository");
    let delays = Delays { stopped, ..Delays::default() };
    let request = Request { agents, duration: 60.0 * minutes, delays, seed: 3, method };
    let report = run(&imported, request).expect("a run");
    let outcome = report.outcome;
    assert!(report.decisions.len() >= outcome.missions);
    assert_eq!((outcome.certificate.verdict, outcome.breaches, outcome.stuck), ("proved", 0, 0), "{outcome:?}");
    assert!(outcome.standstill < 60.0 && outcome.certificate.steps > 0, "{outcome:?}");
    outcome
}

#[test]
fn robots_of_a_warehouse_carry_out_missions_and_never_touch() {
    let minutes = if cfg!(optimized) { 15.0 } else { 3.0 };
    let outcome = warehouse(6, minutes, 0.0, Method::Orders);
    // One alone carries out 47 an hour.
    assert!(outcome.missions_per_hour > 150.0 && outcome.robots == 6, "{outcome:?}");
}

#[test]
fn robots_that_are_stopped_at_random_arrive_all_the_same() {
    let outcome = warehouse(8, if cfg!(optimized) { 15.0 } else { 3.0 }, 0.2, Method::Orders);
    assert!(outcome.missions > 3, "{outcome:?}");
}

/// The same missions, the same delays.
#[test]
fn orders_do_more_missions_than_locks_and_start_delays() {
    let minutes = if cfg!(optimized) { 20.0 } else { 4.0 };
    let [orders, others @ ..] = Method::ALL.map(|method| warehouse(8, minutes, 0.02, method).missions);
    assert!(others.iter().all(|&missions| missions > 0 && 3 * missions < 2 * orders), "{orders} {others:?}");
}
