//! Fleets that keep passing orders, whatever the delays: nobody touches anybody, and everybody arrives.

use pcr_fixed::Q16;
use pcr_planning::fleet::HostScalar;
use pcr_tests::execution::{Tally, run};

/// Random fleets of 2 to 9 robots.
fn fleets<S: HostScalar>(seeds: u64) -> Tally {
    let mut all = Tally { clearance: f64::INFINITY, ..Tally::default() };
    for seed in 0..seeds {
        let tally = run::<S>(seed, 2 + (seed % 8) as usize, 60.0);
        all.admitted += tally.admitted;
        all.changed += tally.changed;
        all.stuck += tally.stuck;
        all.blocked += tally.blocked;
        all.waits += tally.waits;
        all.clearance = all.clearance.min(tally.clearance);
        all.time = all.time.max(tally.time);
    }
    println!("{all:?}");
    all
}

const SEEDS: u64 = if cfg!(optimized) { 200 } else { 40 };

fn audited<S: HostScalar>() {
    let all = fleets::<S>(SEEDS);
    let seeds = SEEDS as u32;
    // What the robots have to do is not easy.
    assert!(all.admitted > 8 * seeds && all.changed > seeds / 4, "{all:?}");
    assert!(all.blocked > seeds && all.stuck > 0 && all.waits > 100 * seeds, "{all:?}");
    assert!(all.clearance < 0.01, "{all:?}");
}

#[test]
fn fleets_with_delays_neither_touch_nor_stop_for_ever_f64() {
    audited::<f64>();
}

#[test]
fn fleets_with_delays_neither_touch_nor_stop_for_ever_f32() {
    audited::<f32>();
}

#[test]
fn fleets_with_delays_neither_touch_nor_stop_for_ever_q16() {
    audited::<Q16>();
}
