//! Any bytes as a building or fleet of Open-RMF.
#![no_main]

use pcr_formats::import::InputFormat;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pcr_fuzz::import(InputFormat::Rmf, bytes));
