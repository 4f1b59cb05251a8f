//! Any bytes as numbers, among them the limits of each format: all that motions can be asked, with overflow checks.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pcr_core::scalar::Micro;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_planning::fleet::HostScalar;
use pcr_tests::limits::{GARBAGE, NUMBERS, number, survives};

/// Three bytes a number: which kind, and two for its value.
fn numbers<S: HostScalar>(bytes: &[u8]) -> Vec<f64> {
    let number = |bytes: &[u8]| {
        let value = f64::from(i16::from_le_bytes([bytes[1], bytes[2]]));
        match bytes[0] % 8 {
            0 => GARBAGE[usize::from(bytes[1]) % GARBAGE.len()],
            1 => number::<S>(value / 32768.0, true),
            2 => number::<S>(10.0_f64.powf(value / 4096.0), true),
            // A few last digits from the limit.
            3 => S::LIMIT.to_f64() + value * S::slack(S::LIMIT).to_f64() / 8192.0,
            4 => 10.0_f64.powf(value / 2048.0),
            _ => value / 1024.0,
        }
    };
    let mut numbers: Vec<f64> = bytes.chunks_exact(3).map(number).collect();
    numbers.resize(NUMBERS, 1.0);
    numbers
}

fuzz_target!(|bytes: &[u8]| {
    survives::<f64>(&numbers::<f64>(bytes));
    survives::<f32>(&numbers::<f32>(bytes));
    survives::<Micro>(&numbers::<Micro>(bytes));
    survives::<Q12>(&numbers::<Q12>(bytes));
    survives::<Q16>(&numbers::<Q16>(bytes));
    survives::<Q20>(&numbers::<Q20>(bytes));
});
