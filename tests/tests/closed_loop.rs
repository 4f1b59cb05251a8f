//! Random fleets that have a plan, carried out while robots are late. The long command is
//! `cargo run --release -p pcr-tests --example simulate -- 0 500`.

use pcr_tests::closed_loop::{Missions, Tally, fleet};

/// Carries out so many fleets that have a plan.
fn carried_out(count: usize, missions: Missions) -> Tally {
    let mut tally = Tally::default();
    let mut failures = Vec::new();
    for seed in 0.. {
        failures.extend(fleet(seed, 16, missions, &mut tally));
        if tally.carried_out + tally.told + tally.failed >= count {
            break;
        }
    }
    assert_eq!((tally.failed, tally.contacts, tally.breaches), (0, 0, 0), "{failures:?}");
    tally
}

#[test]
fn fleets_with_a_plan_are_carried_out_or_it_is_said_who_is_in_the_way() {
    let count = if cfg!(optimized) { 20 } else { 3 };
    let tally = carried_out(count, Missions::default());
    assert!(10 * tally.carried_out > 8 * count, "{tally}");
}

/// Nobody comes to stand where others have to pass that set off later.
#[test]
fn later_starts_are_planned_from_the_beginning() {
    let count = if cfg!(optimized) { 20 } else { 3 };
    let tally = carried_out(count, Missions { latest: 40.0, trips: 0 });
    assert!(10 * tally.carried_out > 8 * count, "{tally}");
}

#[test]
fn missions_that_nobody_knew_of_do_not_end_in_a_contact() {
    let tally = carried_out(if cfg!(optimized) { 8 } else { 2 }, Missions { latest: 0.0, trips: 2 });
    assert!(tally.replanning.len() > 10, "{tally}");
}
