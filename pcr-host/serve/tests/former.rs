//! Journals that the version before has written, as it wrote them.

use pcr_serve::journal::{self, HEADER, Journal};
use pcr_serve::journal_entry::{JournalEntry, JournalStore};
use pcr_serve::robot::Alarm;
use pcr_serve::supervisor::{Supervisor, SupervisorConfig};
use std::path::{Path, PathBuf};

/// The bytes of a journal of version 3.
fn former(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name)).unwrap()
}

/// A folder with these bytes as its journal.
fn folder(name: &str, bytes: &[u8]) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("pcr-serve-{}-{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("journal"), bytes).unwrap();
    folder
}

#[test]
fn a_journal_of_the_version_before_goes_on() {
    for (name, count) in [("journal-3-lines", 4), ("journal-3-vda5050", 2)] {
        let bytes = former(name);
        assert_eq!(bytes[12], 3);
        let folder = folder(name, &bytes);
        let (mut journal, found) = Journal::open(&folder).unwrap();
        let as_it_was = found.former.clone().unwrap();
        assert_eq!((as_it_was.clone(), found.torn), (folder.join("journal.3"), 0));
        assert_eq!(std::fs::read(&as_it_was).unwrap(), bytes, "kept as it was");
        let entries = serde_json::to_string(&found.entries).unwrap();
        assert_eq!(entries, serde_json::to_string(&journal::read(&bytes).unwrap().entries).unwrap());
        let supervisor = Supervisor::restored(SupervisorConfig::default(), found.entries, Box::new(journal)).unwrap();
        assert_eq!(supervisor.robots().len(), count, "{name}");
        if name == "journal-3-lines" {
            let robot = |name: &str| supervisor.robot(name).unwrap();
            assert_eq!((robot("east").path, robot("east").mission.as_deref()), (3, Some("E1")));
            assert!(robot("east").notified_limit >= 4.1 && robot("east").arc_length == 1.0);
            assert_eq!(robot("north").alarm, Some(Alarm::Off { x: 0.1, y: -5.0 }));
            assert_eq!((robot("blocker").path, robot("blocker").past.len()), (4, 1));
            // It had to wait before.
            assert_eq!((robot("south").mission.as_deref(), robot("south").waiting.is_none()), (Some("S1"), true));
        }
        drop(supervisor);
        // From now on it is one of the present version, also to those who read it again.
        let (again, found) = Journal::open(&folder).unwrap();
        assert_eq!((found.former, serde_json::to_string(&found.entries).unwrap()), (None, entries));
        journal = again;
        journal.keep(&[JournalEntry::Spent { path: 9 }]).unwrap();
        drop(journal);
        let written = std::fs::read(folder.join("journal")).unwrap();
        assert_eq!(&written[..16], HEADER);
        let read = journal::read(&written).unwrap();
        assert!(matches!(read.entries.last(), Some(JournalEntry::Spent { path: 9 })) && !read.is_former);
        let _ = std::fs::remove_dir_all(&folder);
    }
}

/// A state of its own in the first frame, and a last frame that is not whole.
#[test]
fn a_journal_of_the_version_before_may_be_begun_anew_or_torn() {
    let bytes = former("journal-3-lines");
    let whole = journal::read(&bytes).unwrap();
    let (frame, _) = journal::frame(&whole.entries, journal::FIRST).unwrap();
    let anew = [b"pcr-journal\0\x03\0\0\xff".as_slice(), &frame].concat();
    let place = folder("former-anew", &anew);
    let (journal, found) = Journal::open(&place).unwrap();
    assert_eq!((found.entries.len(), found.former.is_some()), (whole.entries.len(), true));
    drop(journal);
    assert_eq!(std::fs::read(place.join("journal")).unwrap()[12..16], [4, 0, 0, 0xff]);
    // Its first frame was whole once.
    std::fs::write(place.join("journal"), &anew[..anew.len() - 9]).unwrap();
    assert!(Journal::open(&place).is_err());
    let mut torn = bytes.clone();
    torn.truncate(bytes.len() - 9);
    torn.resize(bytes.len() + 600, 0);
    std::fs::write(place.join("journal"), &torn).unwrap();
    let (journal, found) = Journal::open(&place).unwrap();
    assert!(found.torn > 0 && found.former.is_some() && found.entries.len() < whole.entries.len());
    drop(journal);
    assert_eq!(std::fs::read(place.join("journal.3")).unwrap(), torn);
    let (_journal, found) = Journal::open(&place).unwrap();
    assert_eq!((found.torn, found.former), (0, None));
    let _ = std::fs::remove_dir_all(&place);
}

/// What is damaged is refused as before, and stays as it is.
#[test]
fn a_damaged_journal_of_the_version_before_is_not_converted() {
    let mut bytes = former("journal-3-lines");
    bytes[100] ^= 1;
    let folder = folder("former-damaged", &bytes);
    assert!(Journal::open(&folder).is_err());
    assert_eq!(std::fs::read(folder.join("journal")).unwrap(), bytes);
    assert!(!folder.join("journal.3").exists());
    let _ = std::fs::remove_dir_all(&folder);
}
