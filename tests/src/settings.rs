//! How often properties are tried.

use proptest::test_runner::{Config, RngSeed};

/// Settings of a property with this many cases in a release run, one in `debug_part` of them in a debug run. They follow
/// from the seed alone: a failure is the same everywhere.
pub fn settings(release: u32, debug_part: u32, seed: u64) -> Config {
    let cases = if cfg!(not(optimized)) { release / debug_part } else { release };
    Config {
        cases,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(seed),
        // More rejections than cases would mean that hardly anything is tested.
        max_global_rejects: cases,
        ..Config::default()
    }
}
