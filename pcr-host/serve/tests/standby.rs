//! A standby follows the journal of the supervisor at work, and takes over when that one is dead, at whatever write: no right is lost, and none is
//! given to another robot.

use crate::kills::{assert_known, folder, keeps, rights, told_until_killed};
use crate::world::{Trouble, World};
use pcr_serve::journal::{self, Journal, JournalFollower};
use pcr_serve::journal_entry::{JournalEntry, JournalStore, NullStore};
use pcr_serve::standby::Standby;
use pcr_serve::supervisor::{Supervisor, SupervisorConfig};
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write};
use std::path::Path;
use std::sync::{Arc, Mutex};

const GOOD: Trouble = Trouble { lost: 0.0, late: 0.5, stops: 0.0 };

/// A journal that counts its writes, and that its process loses when it dies.
#[derive(Clone)]
struct Mortal(Arc<Mutex<(Option<Journal>, usize)>>);

impl JournalStore for Mortal {
    fn keep(&mut self, entries: &[JournalEntry]) -> std::io::Result<()> {
        let mut own = self.0.lock().unwrap();
        own.1 += 1;
        own.0.as_mut().expect("it lives").keep(entries)
    }
}

fn restored(entries: Vec<JournalEntry>) -> Supervisor {
    Supervisor::restored(SupervisorConfig::default(), entries, Box::new(NullStore)).unwrap()
}

/// Takes away the end of the last frame, as if the process had died before it was written.
fn tear(folder: &Path, kept: usize) {
    let path = folder.join("journal");
    let mut bytes = std::fs::read(&path).unwrap();
    let end = journal::read(&bytes).unwrap().end;
    let last = journal::read(&bytes[..end - 1]).unwrap().end;
    bytes[last + kept..].fill(0);
    std::fs::write(&path, bytes).unwrap();
}

#[test]
fn it_takes_over_at_every_write_and_knows_all_that_was_told() {
    /// Writes of the fleet below in 8 s, the first one with its whole state.
    const WRITES: usize = 24;
    for (dies_at, is_torn) in (2..WRITES).flat_map(|write| [(write, false), (write, true)]) {
        let folder = folder(&format!("standby-{dies_at}-{is_torn}"));
        let (journal, _) = Journal::open(&folder).unwrap();
        let first = Mortal(Arc::new(Mutex::new((Some(journal), 0))));
        let mut standby = Standby::new(&folder).unwrap();
        let mut world = World::new(3, 4, GOOD);
        world.persist(Box::new(first.clone()));
        let mut before = rights(&world.supervisor);
        loop {
            assert!(standby.take_over().unwrap().is_none(), "the other one lives");
            standby.follow().unwrap();
            world.step();
            assert!(world.now < 60.0, "{dies_at} writes");
            if first.0.lock().unwrap().1 >= dies_at {
                break;
            }
            before = rights(&world.supervisor);
        }
        // It has told all of that, or the write was not complete and nothing that depends on it was told.
        let told = if is_torn { before } else { rights(&world.supervisor) };
        first.0.lock().unwrap().0 = None;
        if is_torn {
            tear(&folder, 1 + dies_at * 7 % 60);
        }
        standby.follow().unwrap();
        assert_eq!(standby.robots(), 4);
        let (_journal, found) = standby.take_over().unwrap().expect("the lock is free");
        assert_eq!(found.torn > 0, is_torn);
        keeps(&restored(found.entries), &told, &format!("dead at write {dies_at}, torn: {is_torn}"));
        // Nobody else takes over from this one.
        assert!(standby.take_over().unwrap().is_none());
        assert_eq!(Journal::open(&folder).unwrap_err().kind(), ErrorKind::WouldBlock);
        let _ = std::fs::remove_dir_all(&folder);
    }
}

/// What it follows is what is in the journal, however much of a frame is there when it looks, and also when the journal is begun anew.
#[test]
fn it_reads_every_frame_once_and_no_part_of_one() {
    let mut world = World::new(5, 3, GOOD);
    while world.now < 6.0 {
        world.step();
    }
    let bytes = world.disc.bytes.lock().unwrap().clone();
    let folder = folder("follows");
    std::fs::create_dir_all(&folder).unwrap();
    let mut follower = JournalFollower::new(&folder);
    assert!(follower.read_on().unwrap().entries.is_empty(), "there is none yet");
    let path = folder.join("journal");
    let mut file = OpenOptions::new().create(true).append(true).open(&path).unwrap();
    let (mut entries, mut count) = (Vec::new(), 0);
    for (place, byte) in bytes.iter().enumerate() {
        file.write_all(&[*byte]).unwrap();
        let whole = journal::read(&bytes[..(place + 1).max(16).min(bytes.len())]).unwrap();
        // Reading all of it takes long: at the ends of frames, and at some other bytes.
        if whole.end == place + 1 || place % 97 == 0 {
            let news = follower.read_on().unwrap();
            count += usize::from(!news.entries.is_empty());
            entries.extend(news.entries);
            let text = |entries: &[JournalEntry]| serde_json::to_string(entries).unwrap();
            let known = if place < 16 { Vec::new() } else { whole.entries };
            assert_eq!(text(&entries), text(&known), "byte {place}");
        }
    }
    assert!(count > 5, "{count} frames");
    // Another one takes its place.
    let state = world.supervisor.snapshot().unwrap();
    let (frame, sum) = journal::frame(&state, journal::FIRST).unwrap();
    let new = folder.join("journal.new");
    std::fs::write(&new, [journal::ANEW.as_slice(), &frame].concat()).unwrap();
    std::fs::rename(&new, &path).unwrap();
    let news = follower.read_on().unwrap();
    assert!(news.is_anew && news.entries.len() == state.len());
    let (frame, _) = journal::frame(&[JournalEntry::Spent { path: 9 }], sum).unwrap();
    OpenOptions::new().append(true).open(&path).unwrap().write_all(&frame).unwrap();
    let news = follower.read_on().unwrap();
    assert!(!news.is_anew && matches!(news.entries[..], [JournalEntry::Spent { path: 9 }]));
    // What does not follow is damage, and so is another version.
    OpenOptions::new().append(true).open(&path).unwrap().write_all(&frame).unwrap();
    assert_eq!(follower.read_on().unwrap_err().kind(), ErrorKind::InvalidData);
    let mut other = bytes.clone();
    other[12] = 7;
    std::fs::write(&new, &other).unwrap();
    std::fs::rename(&new, &path).unwrap();
    let why = follower.read_on().unwrap_err().to_string();
    assert!(why.contains("it is of version 7"), "{why}");
    let _ = std::fs::remove_dir_all(&folder);
}

/// Somebody removes the lock of a supervisor that is at work: its standby must not take the new file for a sign that nobody is.
#[test]
fn a_lock_that_was_removed_is_no_death() {
    let folder = folder("standby-lock");
    let (mut journal, _) = Journal::open(&folder).unwrap();
    let mut standby = Standby::new(&folder).unwrap();
    std::fs::remove_file(folder.join("lock")).unwrap();
    assert!(standby.take_over().unwrap().is_none());
    // The first one notices, and ends.
    assert!(journal.keep(&[JournalEntry::Spent { path: 1 }]).is_err());
    drop(journal);
    let taken = (0..3).find_map(|_| standby.take_over().unwrap());
    assert!(taken.is_some());
    assert_eq!(Journal::open(&folder).unwrap_err().kind(), ErrorKind::WouldBlock);
    let _ = std::fs::remove_dir_all(&folder);
}

/// A process that is killed at any moment, and a standby beside it.
#[test]
fn it_takes_over_from_a_process_that_was_killed() {
    let mut most = 0;
    for round in 0..6 {
        let folder = folder(&format!("standby-killed-{round}"));
        let mut standby = None;
        let told = told_until_killed(&folder, 60 + 50 * round, |line| {
            // It has the lock before it says anything.
            if line.starts_with("told ") {
                let standby = standby.get_or_insert_with(|| Standby::new(&folder).unwrap());
                assert!(standby.take_over().unwrap().is_none(), "round {round}: {line}");
                standby.follow().unwrap();
            }
        });
        let (_journal, found) = standby.unwrap().take_over().unwrap().expect("the lock of a dead process is free");
        assert_known(&restored(found.entries), &told, round);
        most = most.max(told.len());
        let _ = std::fs::remove_dir_all(&folder);
    }
    assert!(most > 1, "{most} robots were told something");
}
