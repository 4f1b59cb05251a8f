//! Random fleets that have a plan, carried out while robots are late. The long command is
//! `cargo run --release -p pcr-tests --example simulate -- 0 500`.

use pcr_tests::closed_loop::{Tally, fleet};

#[test]
fn fleets_with_a_plan_are_carried_out_or_it_is_said_who_is_in_the_way() {
    let mut tally = Tally::default();
    let mut failures = Vec::new();
    let count = if cfg!(optimized) { 20 } else { 3 };
    for seed in 0.. {
        failures.extend(fleet(seed, 16, &mut tally));
        if tally.carried_out + tally.told + tally.failed >= count {
            break;
        }
    }
    assert_eq!((tally.failed, tally.contacts, tally.breaches), (0, 0, 0), "{failures:?}");
    assert!(10 * tally.carried_out > 8 * count, "{tally}");
}
