//! Any bytes as a nav2 route graph.
#![no_main]

use pcr_formats::import::InputFormat;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pcr_fuzz::import(InputFormat::Nav2, bytes));
