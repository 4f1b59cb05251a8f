//! Any bytes as the configuration of a fleet or as a factsheet.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pcr_fuzz::fleet(bytes));
