//! Any bytes as a list of points.
#![no_main]

use pcr_formats::import::InputFormat;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pcr_fuzz::import(InputFormat::Path, bytes));
