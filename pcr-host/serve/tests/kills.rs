//! The process ends at any instant: after the restart no right is lost, and none is given to another robot.

use crate::world::{Disc, STEP, Trouble, World};
use pcr_serve::event::SupervisorEvent;
use pcr_serve::journal::{self, Journal, JournalDamage, ParsedFrames};
use pcr_serve::journal_entry::{JournalEntry, JournalStore, NullStore, StoredPrecedence};
use pcr_serve::owned_path::{PathElement, StartPose};
use pcr_serve::request_error::RequestError;
use pcr_serve::robot::{RobotTraits, SupervisedRobot};
use pcr_serve::supervisor::{AdmissionResult, MissionRequest, PositionReport, Supervisor, SupervisorConfig};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::io::{BufRead, BufReader, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::Ordering::Relaxed;

const GOOD: Trouble = Trouble { lost: 0.0, late: 0.5, stops: 0.0 };

pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("pcr-serve-{}-{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    folder
}

/// All that others rely on: paths, how far who may go, and who goes first where.
pub(crate) fn rights(supervisor: &Supervisor) -> HashMap<String, (u64, f64, Vec<StoredPrecedence>)> {
    let robots = supervisor.robots().iter();
    let mut orders: HashMap<String, Vec<StoredPrecedence>> = HashMap::new();
    let fleet = supervisor.fleet().unwrap();
    for (place, robot) in robots.clone().enumerate() {
        let row = supervisor.orders().row(&fleet, place).unwrap();
        let row = row.map(|(_, region, pass)| StoredPrecedence {
            with: supervisor.robots()[region.other()].name.clone(),
            pass: pass.into(),
            active_from: 0.0,
            lengths: [region.length(), region.other_length()].map(|length| [length.lo, length.hi]),
        });
        orders.insert(robot.name.clone(), row.collect());
    }
    robots.map(|robot| (robot.name.clone(), (robot.path, robot.granted, orders.remove(&robot.name).unwrap()))).collect()
}

/// Whether what is known after a restart holds all that was told before.
pub(crate) fn keeps(after: &Supervisor, before: &HashMap<String, (u64, f64, Vec<StoredPrecedence>)>, context: &str) {
    let now = rights(after);
    assert_eq!(now.len(), before.len(), "{context}");
    for (name, (path, granted, orders)) in before {
        let robot = after.robot(name).unwrap();
        assert_eq!(robot.path, *path, "{context}: {name}");
        assert!(
            robot.notified_limit >= *granted,
            "{context}: {name} was told {granted}, known is {}",
            robot.notified_limit
        );
        assert!(robot.granted <= *granted, "{context}: {name} gets more than it had");
        let same = |(a, b): (&StoredPrecedence, &StoredPrecedence)| {
            // What is over for one of both times was passed: nobody has the right any more.
            let over = [a.pass, b.pass].contains(&pcr_serve::journal_entry::StoredPassingState::Over);
            a.with == b.with && a.lengths == b.lengths && (a.pass == b.pass || over)
        };
        // Nobody counts as allowed to go where the orders do not let it go.
        let place = after.robots().iter().position(|other| other.name == *name).unwrap();
        let progress: Vec<_> = after.robots().iter().map(SupervisedRobot::progress).collect();
        let (hold, _) = after.orders().wait(&after.fleet().unwrap(), place, &progress).unwrap();
        let bound = hold.length(robot.course.length());
        assert!(
            bound.is_some_and(|bound| robot.notified_limit <= bound),
            "{context}: {name}: {} {hold:?}",
            robot.notified_limit
        );
        let (own, count) = (&now[name].2, orders.len());
        assert!(own.len() == count && own.iter().zip(orders).all(same), "{context}: {name}: {own:?} {orders:?}");
    }
}

#[test]
fn a_journal_that_ends_at_any_byte_keeps_all_that_was_told() {
    let mut world = World::new(3, 3, GOOD);
    let mut told = vec![(0, HashMap::new())];
    while world.now < 12.0 {
        world.step();
        let written = world.disc.bytes.lock().unwrap().len();
        // What is told without a write is in the journal already.
        match told.last_mut() {
            Some((last, rights_then)) if *last == written => *rights_then = rights(&world.supervisor),
            _ => told.push((written, rights(&world.supervisor))),
        }
    }
    let bytes = world.disc.bytes.lock().unwrap().clone();
    assert!(told.len() > 10, "{} writes", told.len());
    let (mut last, mut restarts) = (usize::MAX, 0);
    for end in 16..=bytes.len() {
        let ParsedFrames { entries, end: read, .. } = journal::read(&bytes[..end]).unwrap();
        let Some((_, before)) = told.iter().rev().find(|(written, _)| *written <= end) else { continue };
        let whole =
            told.iter().rev().find(|(written, _)| *written <= end).map_or(16, |(written, _)| (*written).max(16));
        assert_eq!(read, whole, "what was cut off is left out, all else is there");
        if read != last {
            let after = Supervisor::restored(SupervisorConfig::default(), entries, Box::new(NullStore)).unwrap();
            keeps(&after, before, &format!("byte {end}"));
            (last, restarts) = (read, restarts + 1);
        }
    }
    assert_eq!(restarts, told.len());
}

#[test]
fn a_journal_that_is_damaged_is_not_gone_on_with() {
    let mut world = World::new(3, 2, GOOD);
    while world.now < 4.0 {
        world.step();
    }
    let bytes = world.disc.bytes.lock().unwrap().clone();
    let ParsedFrames { entries, end, .. } = journal::read(&bytes).unwrap();
    assert_eq!(end, bytes.len());
    // Any bit that is another one is noticed. In the last frame it counted as one that is not complete: what had been told was forgotten. (Of
    // those before it not all: reading them takes long.)
    let last = last_frame(&bytes);
    assert!(last > 1000 && bytes.len() > last + 100 && !entries.is_empty());
    let places = (0..last).step_by(37).chain(last..bytes.len());
    for (place, bit) in places.flat_map(|place| (0..8).map(move |bit| (place, bit))) {
        let mut other = bytes.clone();
        other[place] ^= 1 << bit;
        // Zeros are what is not there yet.
        if other[place] != 0 {
            other.resize(bytes.len() + 600 * (place % 2), 0);
            assert!(journal::read(&other).is_err(), "bit {bit} of byte {place}");
        }
    }
    let mut older = bytes.clone();
    older[12] = 2;
    let why = "it is of version 2, and 3 and 4 are read: begin another journal while all robots stand";
    assert_eq!(journal::read(&older).unwrap_err().to_string(), why);
    assert_eq!(journal::read(b"{}").unwrap_err(), JournalDamage::NoJournal);
}

/// A frame that was there twice, was cut from the middle, or had changed places with another one was read as if nothing were wrong.
#[test]
fn frames_that_do_not_follow_one_another_are_damage() {
    let mut world = World::new(3, 2, GOOD);
    while world.now < 4.0 {
        world.step();
    }
    let bytes = world.disc.bytes.lock().unwrap().clone();
    let mut ends = vec![16];
    while ends.last() < Some(&bytes.len()) {
        let (first, length) = (*ends.last().unwrap(), |at: usize| bytes[at..at + 4].try_into().unwrap());
        ends.push(first + 16 + u32::from_le_bytes(length(first)) as usize);
    }
    let frames: Vec<&[u8]> = ends.windows(2).map(|ends| &bytes[ends[0]..ends[1]]).collect();
    assert!(frames.len() > 5 && ends.last() == Some(&bytes.len()));
    let read = |frames: &[&[u8]]| journal::read(&[&bytes[..16], &frames.concat()].concat());
    assert!(read(&frames).is_ok());
    for (k, end) in ends[..frames.len()].iter().enumerate() {
        let why = |at: usize| Some(format!("at byte {at}: entries that do not follow those before them"));
        let mut twice = frames.clone();
        twice.insert(k, frames[k]);
        assert_eq!(read(&twice).err().map(|damage| damage.to_string()), why(ends[k + 1]), "twice");
        if k + 1 < frames.len() {
            let mut cut = frames.clone();
            cut.remove(k);
            assert_eq!(read(&cut).err().map(|damage| damage.to_string()), why(*end), "cut");
            let mut swapped = frames.clone();
            swapped.swap(k, k + 1);
            assert_eq!(read(&swapped).err().map(|damage| damage.to_string()), why(*end), "swapped");
        }
    }
}

/// What vehicles may go on to is a list that grows with each release. If all of it was written each time, a journal of an hour would have
/// the square of that.
#[test]
fn a_list_that_grows_is_written_once_and_is_there_after_a_restart() {
    let disc = Disc::new();
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(disc.clone()));
    let start = StartPose { x: 0.0, y: 0.0, heading: 0.0 };
    own.add("a", RobotTraits { radius: 0.4, footprint: None, margin: 0.0, speed: 1.0, acceleration: 0.5 }, start)
        .unwrap();
    own.note("a", "list", json!([0])).unwrap();
    own.settle(0.0).unwrap();
    let mut sizes = Vec::new();
    for k in 1..=1000 {
        own.note_more("a", "list", &[k]).unwrap();
        own.settle(f64::from(k)).unwrap();
        sizes.push(disc.bytes.lock().unwrap().len());
    }
    // Its numbers and those of the frames get longer by a digit or two.
    let grown = |frames: &[usize]| frames[frames.len() - 1] - frames[0];
    assert!(grown(&sizes[800..]) < grown(&sizes[..200]) + 500, "{} {}", grown(&sizes[..200]), grown(&sizes[800..]));
    let all = json!((0..=1000).collect::<Vec<_>>());
    let restored = |entries| Supervisor::restored(SupervisorConfig::default(), entries, Box::new(NullStore));
    assert_eq!(restored(disc.entries()).unwrap().robot("a").unwrap().notes["list"], all);
    assert_eq!(restored(own.snapshot().unwrap()).unwrap().robot("a").unwrap().notes["list"], all);
    // More of what is no list, or of a robot that is not there, is damage.
    own.note("a", "text", json!("no list")).unwrap();
    assert!(own.note_more("a", "text", &[1]).is_err() && own.note_more("b", "list", &[1]).is_err());
    for (robot, key) in [("a", "text"), ("b", "list")] {
        let more = JournalEntry::More { robot: robot.into(), key: key.into(), more: vec![json!(1)] };
        let entries: Vec<JournalEntry> = own.snapshot().unwrap().into_iter().chain([more]).collect();
        assert!(restored(entries).is_err(), "{robot} {key}");
    }
}

/// An order that could not be written was noted as none.
#[test]
fn after_a_note_that_is_no_json_nothing_is_told() {
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(NullStore));
    let start = StartPose { x: 0.0, y: 0.0, heading: 0.0 };
    own.add("a", RobotTraits { radius: 0.4, footprint: None, margin: 0.0, speed: 1.0, acceleration: 0.5 }, start)
        .unwrap();
    let note = HashMap::from([([1, 2], 3)]);
    assert!(matches!(own.note("a", "order", note), Err(RequestError::Broken { .. })));
    assert!(matches!(own.settle(0.0), Err(RequestError::Broken { .. })));
}

/// Where the last frame begins.
fn last_frame(bytes: &[u8]) -> usize {
    journal::read(&bytes[..bytes.len() - 1]).unwrap().end
}

/// The sectors of a frame may reach the disk in any order, and there are zeros where they are to be.
#[test]
fn a_last_frame_of_which_any_sectors_are_missing_is_left_out() {
    const SECTOR: usize = 64;
    let mut world = World::new(3, 3, GOOD);
    while world.now < 12.0 {
        world.step();
    }
    let mut bytes = world.disc.bytes.lock().unwrap().clone();
    pcr_serve::journal_entry::JournalStore::keep(&mut world.disc.clone(), &world.supervisor.snapshot().unwrap())
        .unwrap();
    let whole = world.disc.bytes.lock().unwrap().clone();
    let (before, last) = (journal::read(&bytes).unwrap().entries.len(), bytes.len());
    assert!(whole.len() - last > 4 * SECTOR && last_frame(&whole) == last);
    let room = whole.len() + 1000;
    bytes.resize(room, 0);
    let sectors = (whole.len() - last).div_ceil(SECTOR);
    for missing in 1..1_u32 << sectors.min(10) {
        let mut torn = bytes.clone();
        for (sector, part) in whole[last..].chunks(SECTOR).enumerate() {
            // The last one of the pattern stands for all that follow.
            if missing >> sector.min(9) & 1 == 0 {
                torn[last + sector * SECTOR..][..part.len()].copy_from_slice(part);
            }
        }
        let ParsedFrames { entries, end, .. } = journal::read(&torn).unwrap();
        assert!(end == last && entries.len() == before, "{missing:b}");
    }
    // A byte that became 0 was another one once, and what the record says may have been told.
    for place in (last + 60..whole.len() - 1).step_by(7) {
        let mut damaged = whole.clone();
        damaged[place] = 0;
        assert!(journal::read(&damaged).is_err(), "{place}");
    }
    let ParsedFrames { entries, end, .. } = journal::read(&[whole.clone(), vec![0; 1000]].concat()).unwrap();
    assert!(end == whole.len() && entries.len() > before);
}

#[test]
fn fleets_whose_supervisor_is_killed_in_the_middle_of_writes() {
    let (mut kills, mut missions) = (0, 0);
    for seed in 0..4 {
        let mut world = World::new(seed, 3 + seed as usize, Trouble { lost: 0.1, late: 2.0, stops: 0.002 });
        while world.now < 60.0 {
            if world.disc.fails_at.load(Relaxed) == usize::MAX {
                let further = world.dice().uniform(0.0, 6000.0) as usize;
                let written = world.disc.bytes.lock().unwrap().len();
                world.disc.fails_at.store(written + further, Relaxed);
            }
            world.step();
        }
        world.certify();
        kills += world.kills;
        missions += world.vehicles.iter().map(|vehicle| vehicle.missions).sum::<u32>();
    }
    println!("{kills} kills, {missions} missions");
    assert!(kills > 40 && missions > 40, "{kills} kills, {missions} missions");
}

#[test]
fn a_second_supervisor_is_refused_and_a_torn_end_is_told() {
    let folder = folder("second");
    let (mut journal, found) = Journal::open(&folder).unwrap();
    assert!(found.entries.is_empty() && found.torn == 0);
    assert_eq!(Journal::open(&folder).unwrap_err().kind(), ErrorKind::WouldBlock);
    let mut world = World::new(1, 2, GOOD);
    while world.now < 3.0 {
        world.step();
    }
    pcr_serve::journal_entry::JournalStore::keep(&mut journal, &world.supervisor.snapshot().unwrap()).unwrap();
    drop(journal);
    let path = folder.join("journal");
    let end = journal::read(&std::fs::read(&path).unwrap()).unwrap().end;
    let file = std::fs::OpenOptions::new().write(true).open(&path).unwrap();
    assert!(file.metadata().unwrap().len() > end as u64, "zeros follow");
    (&file).seek(SeekFrom::Start(end as u64)).unwrap();
    (&file).write_all(&[0, 0, 7]).unwrap();
    let (mut journal, found) = Journal::open(&folder).unwrap();
    assert!(found.torn == 3 && !found.entries.is_empty());
    // Begun anew it holds the same.
    let before = Supervisor::restored(SupervisorConfig::default(), found.entries, Box::new(NullStore)).unwrap();
    pcr_serve::journal_entry::JournalStore::restart(&mut journal, &before.snapshot().unwrap()).unwrap();
    pcr_serve::journal_entry::JournalStore::keep(&mut journal, &before.snapshot().unwrap()).unwrap();
    drop(journal);
    let (_journal, found) = Journal::open(&folder).unwrap();
    let after = Supervisor::restored(SupervisorConfig::default(), found.entries, Box::new(NullStore)).unwrap();
    keeps(&after, &rights(&before), "begun anew");
    let _ = std::fs::remove_dir_all(&folder);
}

/// What was long when it was opened had to become eight times as long each time.
#[test]
fn a_long_journal_is_long_after_each_restart() {
    let folder = folder("long");
    let (mut journal, _) = Journal::open(&folder).unwrap();
    let note = JournalEntry::Note { robot: "a".into(), key: "k".into(), note: "x".repeat(1 << 20).into() };
    let mut frames = 0;
    while !journal.is_long() {
        journal.keep(std::slice::from_ref(&note)).unwrap();
        frames += 1;
    }
    assert_eq!(frames, 16);
    drop(journal);
    for _ in 0..2 {
        let (journal, found) = Journal::open(&folder).unwrap();
        assert!(found.entries.len() == frames && journal.is_long());
    }
    // One whose state is large is long when it has grown to eight times that.
    let (mut journal, _) = Journal::open(&folder).unwrap();
    journal.restart(&vec![note.clone(); 3]).unwrap();
    drop(journal);
    let (mut journal, _) = Journal::open(&folder).unwrap();
    for _ in 0..20 {
        journal.keep(std::slice::from_ref(&note)).unwrap();
    }
    assert!(!journal.is_long());
    drop(journal);
    let (mut journal, _) = Journal::open(&folder).unwrap();
    assert!(!journal.is_long());
    for _ in 0..2 {
        journal.keep(std::slice::from_ref(&note)).unwrap();
    }
    assert!(journal.is_long());
    let _ = std::fs::remove_dir_all(&folder);
}

/// One whose first frame was cut was read as that of a fleet without robots, and cut to its header.
#[test]
fn a_journal_begun_anew_that_was_cut_is_damaged() {
    let folder = folder("anew");
    let mut world = World::new(1, 2, GOOD);
    while world.now < 3.0 {
        world.step();
    }
    let (mut journal, _) = Journal::open(&folder).unwrap();
    pcr_serve::journal_entry::JournalStore::restart(&mut journal, &world.supervisor.snapshot().unwrap()).unwrap();
    drop(journal);
    let path = folder.join("journal");
    let whole = std::fs::read(&path).unwrap();
    assert!(!journal::read(&whole).unwrap().entries.is_empty());
    // Also where what is missing is zeros.
    for (end, room) in [16, 17, 40, whole.len() - 1].into_iter().flat_map(|end| [(end, end), (end, whole.len() + 99)]) {
        let mut cut = whole[..end].to_vec();
        cut.resize(room, 0);
        std::fs::write(&path, &cut).unwrap();
        assert_eq!(Journal::open(&folder).unwrap_err().kind(), ErrorKind::InvalidData, "{end} {room}");
        assert_eq!(std::fs::read(&path).unwrap(), cut, "left as it is");
    }
    // A later frame was never whole.
    std::fs::write(&path, &whole).unwrap();
    let (mut journal, _) = Journal::open(&folder).unwrap();
    pcr_serve::journal_entry::JournalStore::keep(&mut journal, &world.supervisor.snapshot().unwrap()).unwrap();
    drop(journal);
    let more = journal::read(&std::fs::read(&path).unwrap()).unwrap().end;
    std::fs::OpenOptions::new().write(true).open(&path).unwrap().set_len(more as u64 - 1).unwrap();
    let (_journal, found) = Journal::open(&folder).unwrap();
    assert!(found.torn > 0 && found.entries.len() == world.supervisor.snapshot().unwrap().len());
    // No bit of the header is one that does not count.
    for bit in 0..128 {
        let mut other = whole.clone();
        other[bit / 8] ^= 1 << (bit % 8);
        assert!(journal::read(&other).is_err(), "bit {bit}");
    }
    let mut later = whole;
    later[12] = 5;
    assert_eq!(journal::read(&later).unwrap_err(), JournalDamage::Version { own: 5, version: 4 });
    let _ = std::fs::remove_dir_all(&folder);
}

const CAN: RobotTraits = RobotTraits { radius: 0.25, footprint: None, margin: 0.0, speed: 1.0, acceleration: 0.5 };

fn mission(own: &mut Supervisor, robot: &str, mission: &str, length: f64, now: f64) -> AdmissionResult {
    let (robot, mission, path) = (robot.into(), mission.into(), vec![PathElement::Line { length }]);
    own.mission(
        &MissionRequest { robot, mission, after: None, expected_path: None, any_heading: false, start: None, path },
        now,
    )
    .unwrap()
}

/// Robots go as far as they may, and nobody is stopped.
fn go(own: &mut Supervisor, now: &mut f64) {
    for _ in 0..60 {
        *now += 0.5;
        for robot in own.robots().to_vec() {
            let at = [robot.granted; 2];
            own.position(&PositionReport { robot: robot.name, path: robot.path, at, age: 0.0 }, *now).unwrap();
        }
        let events = own.settle(*now).unwrap();
        assert!(!events.iter().any(|event| matches!(event, SupervisorEvent::Stop { .. })), "{events:?}");
    }
}

/// The robot `a` has been allowed to go 3 m of 12 m, and the journal had 5 m.
fn ahead(disc: &Disc) -> Supervisor {
    let mut own = Supervisor::new(SupervisorConfig::default(), Box::new(disc.clone()));
    own.add("a", CAN, StartPose { x: 0.0, y: 0.0, heading: 0.0 }).unwrap();
    assert!(matches!(mission(&mut own, "a", "A", 12.0, 0.0), AdmissionResult::Admitted { .. }));
    own.settle(0.0).unwrap();
    let a = own.robot("a").unwrap();
    assert!(a.notified_limit == 3.0 && a.ceiling == 5.0, "{a:?}");
    own
}

fn restarted(disc: &Disc) -> Supervisor {
    Supervisor::restored(SupervisorConfig::default(), disc.entries(), Box::new(disc.clone())).unwrap()
}

/// What the journal had beyond the hold was where another robot had been added since: after a restart both stood for ever.
#[test]
fn a_robot_that_is_added_beyond_a_hold_can_leave_after_a_restart() {
    for drives in [false, true] {
        let (disc, mut now) = (Disc::new(), 1.0);
        let mut own = ahead(&disc);
        own.add("b", CAN, StartPose { x: 5.0, y: 0.0, heading: std::f64::consts::FRAC_PI_2 }).unwrap();
        own.settle(now).unwrap();
        if drives {
            go(&mut own, &mut now);
            let a = own.robot("a").unwrap();
            assert!((a.granted - 4.5).abs() < 1e-3 && own.waits_for(a) == Some("b"), "{a:?}");
        }
        let mut own = restarted(&disc);
        assert!(own.robot("a").unwrap().notified_limit < 4.5);
        go(&mut own, &mut now);
        assert!(matches!(mission(&mut own, "b", "B", 6.0, now), AdmissionResult::Admitted { .. }));
        go(&mut own, &mut now);
        assert!(own.robots().iter().all(|robot| robot.has_arrived(1e-3)), "{:?}", own.robots());
    }
}

/// What the journal had beyond the hold was where another robot was to go first since.
#[test]
fn no_ceiling_is_where_another_robot_goes_first() {
    let disc = Disc::new();
    let mut own = ahead(&disc);
    // So near to where the paths cross that it goes first, and it is told so before anybody drives.
    own.add("b", CAN, StartPose { x: 4.2, y: -0.7, heading: std::f64::consts::FRAC_PI_2 }).unwrap();
    assert!(matches!(mission(&mut own, "b", "B", 9.0, 0.0), AdmissionResult::Admitted { .. }));
    own.settle(0.0).unwrap();
    let bound = own.robot("a").unwrap().authority.unwrap().hold.length(12.0).unwrap();
    assert!(bound > 3.0 && bound < 4.2, "{bound}");
    let after = restarted(&disc);
    assert!((3.0..=bound).contains(&after.robot("a").unwrap().notified_limit), "{:?}", after.robot("a"));
    keeps(&after, &rights(&own), "second");
}

#[test]
fn after_an_end_in_order_only_what_was_told_counts_as_told() {
    let disc = Disc::new();
    let mut own = ahead(&disc);
    own.finish(1.0).unwrap();
    let mut own = restarted(&disc);
    assert_eq!(own.robot("a").unwrap().notified_limit, 3.0);
    own.add("b", CAN, StartPose { x: 5.0, y: 0.0, heading: std::f64::consts::FRAC_PI_2 }).unwrap();
    let mut now = 2.0;
    go(&mut own, &mut now);
    assert!(matches!(mission(&mut own, "b", "B", 6.0, now), AdmissionResult::Admitted { .. }));
    go(&mut own, &mut now);
    assert!(own.robots().iter().all(|robot| robot.has_arrived(1e-3)), "{:?}", own.robots());
}

/// The first late message from before a restart set the time from which on a place behind the known one was an alarm.
#[test]
fn late_messages_from_before_a_restart_are_no_alarm() {
    let disc = Disc::new();
    let mut own = ahead(&disc);
    let at = |at: f64, age: f64| PositionReport { robot: "a".into(), path: 2, at: [at, at], age };
    own.position(&at(2.5, 0.0), 1.0).unwrap();
    own.settle(1.0).unwrap();
    let mut own = restarted(&disc);
    assert_eq!(own.robot("a").unwrap().arc_length, 2.5);
    own.settle(100.0).unwrap();
    for late in [at(1.5, 3.0), at(1.7, 2.5), at(1.9, 2.0)] {
        own.position(&late, 101.0).unwrap();
        assert_eq!(own.robot("a").unwrap().alarm, None, "{late:?}");
    }
    own.position(&at(1.9, 0.5), 101.0).unwrap();
    assert!(own.robot("a").unwrap().alarm.is_some());
}

/// The child of the test below: a fleet whose journal is a file, and that tells on standard output what it tells.
#[test]
#[ignore = "started by the test that kills it"]
fn child() {
    let folder = PathBuf::from(std::env::var_os("PCR_SERVE_FOLDER").expect("a folder"));
    let (journal, _) = Journal::open(&folder).unwrap();
    let mut world = World::new(11, 4, GOOD);
    world.persist(Box::new(journal));
    let mut out = std::io::stdout();
    while world.now < 3000.0 * STEP {
        for event in world.step() {
            writeln!(out, "\ntold {}", serde_json::to_string(&event).unwrap()).unwrap();
            out.flush().unwrap();
        }
    }
}

/// Starts the child with a journal in a folder and kills it after so many lines; `each` sees a line before the next one is read. Returns the path and the
/// hold that each robot was told last.
pub(crate) fn told_until_killed(folder: &Path, most: usize, mut each: impl FnMut(&str)) -> HashMap<String, (u64, f64)> {
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["--ignored", "--exact", "kills::child", "--nocapture"])
        .env("PCR_SERVE_FOLDER", folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let mut told = HashMap::new();
    let mut take = |line: &str| {
        let event = line.strip_prefix("told ").and_then(|text| serde_json::from_str::<Value>(text).ok());
        let Some(event) = event.filter(|event| event["event"] == "hold" || event["event"] == "admitted") else {
            return;
        };
        let of = (event["path"].as_u64().unwrap(), event["hold"].as_f64().unwrap());
        told.insert(event["robot"].as_str().unwrap().to_owned(), of);
    };
    for line in lines.by_ref().take(most).map_while(Result::ok) {
        each(&line);
        take(&line);
    }
    child.kill().unwrap();
    child.wait().unwrap();
    // What was on its way is told, too.
    lines.map_while(Result::ok).for_each(|line| take(&line));
    told
}

/// Checks that a supervisor knows all that was told.
pub(crate) fn assert_known(own: &Supervisor, told: &HashMap<String, (u64, f64)>, round: usize) {
    for (name, (path, hold)) in told {
        let robot = own.robot(name).unwrap();
        assert!(robot.path >= *path, "round {round}: a path of {name} is lost");
        assert!(robot.path > *path || robot.notified_limit >= *hold, "round {round}: {name} was told {hold}");
    }
}

#[test]
fn a_process_that_is_killed_has_told_nothing_that_is_not_in_its_journal() {
    let mut most = 0;
    for round in 0..6 {
        let folder = folder(&format!("killed-{round}"));
        let told = told_until_killed(&folder, 40 + 60 * round, |_| {});
        let (_journal, found) = Journal::open(&folder).unwrap();
        let after = Supervisor::restored(SupervisorConfig::default(), found.entries, Box::new(NullStore)).unwrap();
        assert_known(&after, &told, round);
        most = most.max(told.len());
        let _ = std::fs::remove_dir_all(&folder);
    }
    assert!(most > 1, "{most} robots were told something");
}
