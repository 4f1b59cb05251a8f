//! Any bytes as an OpenDRIVE file.
#![no_main]

use pcr_formats::import::InputFormat;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| pcr_fuzz::import(InputFormat::OpenDrive, bytes));
