//! A journal on a thread of its own: nothing is told before it is on the disc, and what comes meanwhile is decided.

use crate::world::Disc;
use pcr_serve::entry::{Entry, Keep};
use pcr_serve::log::{Level, Log};
use pcr_serve::outbox::{Lines, outbox};
use pcr_serve::server::{Handle, Input, queue, serve};
use pcr_serve::supervisor::{Settings, Supervisor};
use pcr_serve::writer::Writer;
use serde_json::{Value, json};
use std::io;
use std::sync::{Arc, Condvar, Mutex};
use std::thread::{self, JoinHandle};

#[derive(Clone, Copy, PartialEq)]
enum Door {
    Open,
    Shut,
    Broken,
}

/// A disc that takes as long as the test says.
#[derive(Clone)]
struct Slow {
    disc: Disc,
    door: Arc<(Mutex<Door>, Condvar)>,
}

impl Slow {
    fn set(&self, door: Door) {
        *self.door.0.lock().unwrap() = door;
        self.door.1.notify_all();
    }
}

impl Keep for Slow {
    fn keep(&mut self, entries: &[Entry]) -> io::Result<()> {
        let door = self.door.1.wait_while(self.door.0.lock().unwrap(), |door| *door == Door::Shut).unwrap();
        if *door == Door::Broken {
            return Err(io::Error::other("no more room"));
        }
        self.disc.keep(entries)
    }
}

struct Office {
    slow: Slow,
    handle: Handle,
    lines: Lines,
    server: JoinHandle<Result<(), String>>,
}

impl Office {
    /// Two robots that stand, and a client that is told everything.
    fn open() -> Self {
        let slow = Slow { disc: Disc::new(), door: Arc::new((Mutex::new(Door::Open), Condvar::new())) };
        let (handle, inputs) = queue();
        let own = handle.clone();
        let writer = Writer::start(Box::new(slow.clone()), move || own.wake()).unwrap();
        let kept = writer.kept();
        let mut supervisor = Supervisor::new(Settings::default(), Box::new(writer));
        let mut serves = move || serve(&mut supervisor, &inputs, &kept, Log::new(Level::Error));
        let server = thread::spawn(move || serves().map_err(|fault| fault.to_string()));
        let (out, lines) = outbox();
        handle.send(Input::Opened(1, out));
        let own = Self { slow, handle, lines, server };
        own.ask(&json!({ "verb": "watch" }));
        for (robot, y) in [("a", 0.0), ("b", 9.0)] {
            let abilities = json!({ "radius": 0.25, "speed": 1.0, "acceleration": 0.5 });
            let start = json!({ "x": 0.0, "y": y, "heading": 0.0 });
            own.ask(&json!({ "verb": "add", "robot": robot, "start": start, "abilities": abilities }));
        }
        (0..3).for_each(|_| assert!(own.next()["ok"].is_object()));
        own
    }

    fn ask(&self, request: &Value) {
        self.handle.send(Input::Line(1, request.to_string().into_bytes()));
    }

    fn mission(&self, id: u64, robot: &str) {
        let path = json!([{ "kind": "line", "length": 20.0 }]);
        self.ask(&json!({ "id": id, "verb": "mission", "robot": robot, "mission": "1", "path": path }));
    }

    fn next(&self) -> Value {
        serde_json::from_str(&self.lines.recv().unwrap()).unwrap()
    }

    fn at(&self, robot: &'static str) -> f64 {
        self.handle.ask(move |supervisor, _, _| supervisor.robot(robot).unwrap().at).unwrap()
    }
}

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
            .all(|entry| !matches!(entry, Entry::Robot(known) if known.name == "b" && known.path == 2))
    );
    own.slow.set(Door::Open);
    let told: Vec<Value> = (0..5).map(|_| own.next()).collect();
    let ids: Vec<u64> = told.iter().filter_map(|line| line["id"].as_u64()).collect();
    let holds = told.iter().filter(|line| line["event"] == "hold").map(|line| line["robot"].as_str().unwrap());
    assert_eq!(ids, [2, 3], "{told:?}");
    let mut holds: Vec<&str> = holds.collect();
    holds.sort_unstable();
    assert_eq!(holds, ["a", "b"], "{told:?}");
    own.handle.send(Input::Stop);
    assert_eq!(own.server.join().unwrap(), Ok(()));
    // What was told is there.
    let entries = own.slow.disc.entries();
    assert!(entries.iter().any(|entry| matches!(entry, Entry::Robot(known) if known.name == "b" && known.path == 2)));
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
    own.handle.send(Input::Stop);
    let slow = own.slow.clone();
    let opens = thread::spawn(move || slow.set(Door::Open));
    assert_eq!(own.server.join().unwrap(), Ok(()));
    opens.join().unwrap();
    assert_eq!(own.lines.recv().map(|line| line.contains("admitted")), Ok(true));
}
