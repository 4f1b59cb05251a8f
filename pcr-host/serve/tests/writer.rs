//! A journal on a thread of its own: nothing is told before it is on the disk, and what comes meanwhile is decided.

use crate::office::{Door, Office};
use pcr_serve::journal_entry::JournalEntry;
use pcr_serve::server::ServerInput;
use serde_json::{Value, json};
use std::thread;

#[test]
fn nothing_is_told_before_it_is_on_the_disc_and_positions_are_read_meanwhile() {
    let own = Office::open();
    own.mission(1, "a");
    assert_eq!(own.next()["ok"]["verdict"], "admitted");
    assert_eq!([own.next()["event"].clone(), own.next()["event"].clone()], ["admitted", "hold"]);
    own.slow.set(Door::Shut);
    own.mission(2, "b");
    own.ask(&json!({ "id": 3, "verb": "position", "robot": "a", "path": 2, "at": [1.5, 1.6] }));
    // The write is on its way, and will be as long as the test wants.
    while own.at("a") < 1.5 {
        thread::yield_now();
    }
    own.at("a");
    assert!(own.lines.try_recv().is_err(), "told before it was on the disc");
    assert!(
        own.slow
            .disc
            .entries()
            .iter()
            .all(|entry| !matches!(entry, JournalEntry::Robot(known) if known.name == "b" && known.path == 2))
    );
    own.slow.set(Door::Open);
    let told: Vec<Value> = (0..5).map(|_| own.next()).collect();
    let ids: Vec<u64> = told.iter().filter_map(|line| line["id"].as_u64()).collect();
    let holds = told.iter().filter(|line| line["event"] == "hold").map(|line| line["robot"].as_str().unwrap());
    assert_eq!(ids, [2, 3], "{told:?}");
    let mut holds: Vec<&str> = holds.collect();
    holds.sort_unstable();
    assert_eq!(holds, ["a", "b"], "{told:?}");
    own.handle.send(ServerInput::Stop);
    assert_eq!(own.server.join().unwrap(), Ok(()));
    // What was told is there.
    let entries = own.slow.disc.entries();
    assert!(
        entries.iter().any(|entry| matches!(entry, JournalEntry::Robot(known) if known.name == "b" && known.path == 2))
    );
}

#[test]
fn a_disc_that_fails_later_lets_nobody_know_what_was_decided() {
    let own = Office::open();
    own.slow.set(Door::Shut);
    own.mission(1, "a");
    own.ask(&json!({ "id": 2, "verb": "query", "what": "counts" }));
    own.at("a");
    own.slow.set(Door::Broken);
    for id in [1, 2] {
        let line = own.next();
        assert_eq!(line["id"], id);
        assert_eq!(line["error"]["code"], "broken", "{line}");
    }
    assert!(own.server.join().unwrap().unwrap_err().contains("no more room"));
}

#[test]
fn the_end_waits_for_the_disc() {
    let own = Office::open();
    own.slow.set(Door::Shut);
    own.mission(1, "a");
    own.handle.send(ServerInput::Stop);
    let slow = own.slow.clone();
    let opens = thread::spawn(move || slow.set(Door::Open));
    assert_eq!(own.server.join().unwrap(), Ok(()));
    opens.join().unwrap();
    assert_eq!(own.lines.recv().map(|line| line.contains("admitted")), Ok(true));
}
