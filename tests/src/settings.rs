//! How often properties are tried.

use proptest::test_runner::{Config, RngSeed};

/// Settings of a property with this many cases in an optimized run, one in `debug_part` of them in another. They follow
/// from the seed alone: a failure is the same everywhere.
pub fn settings(release: u32, debug_part: u32, seed: u64) -> Config {
    let cases = if cfg!(optimized) { release } else { release / debug_part };
    Config {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(seed),
        // More rejections than cases would mean that hardly anything is tested.
        max_global_rejects: cases,
        ..Config::default()
    }
}
