//! Any bytes as a roadmap or log of Continuous-CBS.
#![no_main]

use pcr_formats::import::InputFormat;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pcr_fuzz::import(InputFormat::Ccbs, bytes));
