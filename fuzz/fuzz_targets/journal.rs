//! Any bytes as a journal: refused with a message, or entries that are a supervisor or no.
#![no_main]

use pcr_serve::journal::{ANEW, FIRST, HEADER, frame, read};
use pcr_serve::journal_entry::{JournalEntry, NullStore};
use pcr_serve::supervisor::{Supervisor, SupervisorConfig};

fn restored(entries: Vec<JournalEntry>) {
    match Supervisor::restored(SupervisorConfig::default(), entries, Box::new(NullStore)) {
        Ok(mut supervisor) => {
            supervisor.settle(0.0).expect("a journal that is nowhere");
        }
        Err(damaged) => assert!(!damaged.to_string().is_empty()),
    }
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let [journal, anew] = [HEADER, ANEW].map(|header| [&header[..], bytes].concat());
    for bytes in [bytes, &journal, &anew] {
        match read(bytes) {
            Ok(found) => {
                assert!(found.end <= bytes.len());
                restored(found.entries);
            }
            Err(why) => assert!(!why.to_string().is_empty()),
        }
    }
    // Past the checksums.
    if let Ok(entries) = serde_json::from_slice::<Vec<JournalEntry>>(bytes) {
        if let Ok((frame, _)) = frame(&entries, FIRST) {
            let whole = [&HEADER[..], &frame].concat();
            assert_eq!(read(&whole).map(|found| found.end), Ok(whole.len()));
        }
        restored(entries);
    }
});
