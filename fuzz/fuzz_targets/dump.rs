//! Any bytes as the table that a microcontroller prints, as they are and with the check of their lines put right: refused with a
//! message, or a table whose proof ends, counts all pieces, and needs all pairs.
#![no_main]

use pcr_certify::device_dump::decode;
use pcr_certify::table::{Checker, CoverageMargin};

/// Segments and pieces up to which a table is checked: a run stays short.
const MOST: usize = 16;

/// The lines up to the end, and their CRC-32 of IEEE 802.3, as the checker asks for it.
fn sealed(text: &str) -> String {
    let lines = text.lines().skip_while(|line| !line.trim_start().starts_with("pcr-table"));
    let body: String =
        lines.take_while(|line| !line.trim_start().starts_with("end")).flat_map(|line| [line, "\n"]).collect();
    let sum = body.bytes().fold(!0_u32, |sum, byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| if sum & 1 == 1 { (sum >> 1) ^ 0xedb8_8320 } else { sum >> 1 })
    });
    format!("{body}end {:08x}\n", !sum)
}

fn survives(text: &str) {
    let table = match decode(text) {
        Ok(table) => table,
        Err(problem) => return assert!(!problem.to_string().is_empty()),
    };
    let segments: usize = table.agents.iter().map(|agent| agent.path.segments.len()).sum();
    let pieces: usize = table.pairs.iter().map(|pair| pair.pieces.len()).sum();
    if segments.max(pieces) > MOST {
        return;
    }
    let check = |table| Checker::new(table).and_then(|checker| checker.check(CoverageMargin::Needed));
    match check(&table) {
        Ok(found) if found.refuted.is_empty() && found.undecided.is_empty() => {
            // All of it was looked at.
            assert_eq!(found.pieces, pieces);
            let mut other = table.clone();
            other.pairs.clear();
            assert!(table.pairs.is_empty() || check(&other).is_err(), "a pair may be missing");
        }
        Ok(_) => {}
        Err(problem) => assert!(!problem.to_string().is_empty()),
    }
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    survives(text);
    survives(&sealed(text));
});
