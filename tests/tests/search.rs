//! Contact where rounding is amplified most, and directed search for the worst pair: ends of regions stay above R and below
//! R + ε in every format.
//!
//! The long command is `cargo run --release -p pcr-tests --example search -- --starts 1000 --steps 20000 [--format q16]`.

use pcr_fixed::{Q12, Q16, Q20};
use pcr_host::fleet::Format;
use pcr_tests::clearance::of_ends;
use pcr_tests::generators::{Dice, inner_tangent};
use pcr_tests::search::search;

/// As many as are done in seconds.
const fn count(release: u64, debug: u64) -> u64 {
    if cfg!(optimized) { release } else { debug }
}

/// Pairs of a size \[m\] that touch from inside an arc.
fn tangents_hold<S: Format>(size: f64) {
    let slack = S::slack(S::from_f64(10.0 * size)).to_f64();
    let (mut seen, mut least, mut most) = (0, f64::INFINITY, f64::NEG_INFINITY);
    let pairs = count(20_000, 500);
    for seed in 0..pairs {
        let pair = inner_tangent(size, slack, &mut Dice::seeded(seed));
        if let Some([low, high]) = of_ends::<S>(&pair) {
            seen += 1;
            (least, most) = (least.min(low), most.max(high));
            assert!(low > 0.0 && high <= 1.0, "{}, {seed}: ends at {low} to {high} of the excess, {pair:?}", S::NAME);
        }
    }
    println!("{}: {seen} pairs, ends at {least:.3} to {most:.3} of the excess", S::NAME);
    assert!(2 * seen > pairs, "only {seen} pairs have an end to look at");
}

#[test]
fn discs_that_nearly_fit_an_arc_lose_nothing_in_floating_point() {
    tangents_hold::<f64>(1.0);
    tangents_hold::<f32>(1.0);
}

#[test]
fn discs_that_nearly_fit_an_arc_lose_nothing_in_fixed_point() {
    tangents_hold::<Q20>(1.0);
    tangents_hold::<Q16>(1.0);
    // The largest arc is 60 m.
    tangents_hold::<Q12>(20.0);
}

fn withstands<S: Format>() {
    let mut searched = 0;
    for worst in (0..count(24, 3)).filter_map(|seed| search::<S>(seed, count(1_000, 60))) {
        searched += 1;
        assert!(worst.margin() >= 0.0 && worst.ends[0] > 0.0, "{}: {worst:?}", S::NAME);
    }
    assert!(searched >= count(12, 1), "only {searched} starts have an end to look at");
}

#[test]
fn directed_search_finds_nothing_lost_in_floating_point() {
    withstands::<f64>();
    withstands::<f32>();
}

#[test]
fn directed_search_finds_nothing_lost_in_fixed_point() {
    withstands::<Q20>();
    withstands::<Q16>();
    withstands::<Q12>();
}
