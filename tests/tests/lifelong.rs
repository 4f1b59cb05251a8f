//! Fleets that run for a while on a real layout: no contact, nobody beyond its hold, everybody arrives in the end.

use pcr_formats::import::{self, Format, Options, Warnings};
use pcr_planning::lifelong::{Outcome, Request, run};

const WAREHOUSE: &str = include_str!("../data/real/nav2/warehouse_graph.geojson");

fn warehouse(agents: usize, minutes: f64, stopped: f64) -> Outcome {
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
    let request = Request { agents, duration: 60.0 * minutes, stopped, seed: 3 };
    let (outcome, decisions) = run(&imported, request).expect("a run");
    assert!(decisions.len() >= outcome.refused + outcome.missions);
    assert_eq!((outcome.contacts, outcome.breaches, outcome.stuck, outcome.full), (0, 0, 0, 0), "{outcome:?}");
    assert!(outcome.clearance > 0.0 && outcome.standstill < 60.0, "{outcome:?}");
    outcome
}

#[test]
fn robots_of_a_warehouse_carry_out_missions_and_never_touch() {
    let minutes = if cfg!(optimized) { 10.0 } else { 3.0 };
    let outcome = warehouse(6, minutes, 0.0);
    // One alone carries out 47 an hour.
    assert!(outcome.missions_per_hour > 150.0, "{outcome:?}");
    assert!(outcome.safe_ends >= 15 && outcome.robots == 6, "{outcome:?}");
}

#[test]
fn robots_that_are_stopped_at_random_arrive_all_the_same() {
    let outcome = warehouse(8, if cfg!(optimized) { 10.0 } else { 3.0 }, 0.2);
    assert!(outcome.missions > 3, "{outcome:?}");
}
