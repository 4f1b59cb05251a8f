//! Agents that go to the last digit of what their holds allow, on paths that aim at degenerate cases: nobody touches anybody, and
//! whoever was admitted arrives. The long command is `cargo run --release -p pcr-tests --example adversary -- 0 100000`.

use pcr_core::scalar::Micro;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;
use pcr_tests::adversary::{Tally, Way, run};

const SEEDS: u64 = if cfg!(optimized) { 200 } else { 40 };

fn audited<S: HostScalar>() {
    let mut all = Tally::default();
    for seed in 0..SEEDS {
        for way in [Way::Decided, Way::Admitted] {
            run::<S>(seed, way, &mut all);
        }
    }
    println!("{all:?}");
    let seeds = SEEDS as u32;
    // What they are asked for is not easy.
    assert!(
        all.fleets > seeds / 2 && all.admitted > seeds && all.amid > seeds / 8 && all.refused > seeds / 4,
        "{all:?}"
    );
    assert!(all.to_the_hold > seeds, "{all:?}");
    // What is rounded to quarters of a millimetre keeps more than a thousandth of a metre from everybody.
    assert!(S::STEP > 1e-4 || all.close > seeds / 10, "{all:?}");
}

#[test]
fn agents_at_their_holds_do_not_touch_f64() {
    audited::<f64>();
}

#[test]
fn agents_at_their_holds_do_not_touch_f32() {
    audited::<f32>();
}

#[test]
fn agents_at_their_holds_do_not_touch_micro() {
    audited::<Micro>();
}

#[test]
fn agents_at_their_holds_do_not_touch_q20() {
    audited::<Q20>();
}

#[test]
fn agents_at_their_holds_do_not_touch_q16() {
    audited::<Q16>();
}

#[test]
fn agents_at_their_holds_do_not_touch_q12() {
    audited::<Q12>();
}
