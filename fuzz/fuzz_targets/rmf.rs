//! Any bytes as a building or fleet of Open-RMF.
#![no_main]

use pcr_formats::import::Format;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pcr_fuzz::import(Format::Rmf, bytes));
