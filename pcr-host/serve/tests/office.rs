//! A server whose disk takes as long as the test says.

use crate::world::Disc;
use pcr_serve::journal_entry::{JournalEntry, JournalStore};
use pcr_serve::journal_writer::JournalWriter;
use pcr_serve::lines::RequestLine;
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::outbox::{OutboxReceiver, outbox};
use pcr_serve::server::{ServerHandle, ServerInput, queue, serve};
use pcr_serve::supervisor::{Supervisor, SupervisorConfig};
use serde_json::{Value, json};
use std::io;
use std::sync::{Arc, Condvar, Mutex};
use std::thread::{self, JoinHandle};
use std::time::Duration;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Door {
    Open,
    Shut,
    Broken,
}

/// A disk that takes as long as the test says.
#[derive(Clone)]
pub(crate) struct Slow {
    pub(crate) disc: Disc,
    door: Arc<(Mutex<Door>, Condvar)>,
}

impl Slow {
    pub(crate) fn set(&self, door: Door) {
        *self.door.0.lock().unwrap() = door;
        self.door.1.notify_all();
    }
}

impl JournalStore for Slow {
    fn keep(&mut self, entries: &[JournalEntry]) -> io::Result<()> {
        let door = self.door.1.wait_while(self.door.0.lock().unwrap(), |door| *door == Door::Shut).unwrap();
        if *door == Door::Broken {
            return Err(io::Error::other("no more room"));
        }
        self.disc.keep(entries)
    }
}

pub(crate) struct Office {
    pub(crate) slow: Slow,
    pub(crate) handle: ServerHandle,
    pub(crate) lines: OutboxReceiver,
    pub(crate) server: JoinHandle<Result<(), String>>,
}

impl Office {
    /// Two robots that stand, and a client that is told everything.
    pub(crate) fn open() -> Self {
        let slow = Slow { disc: Disc::new(), door: Arc::new((Mutex::new(Door::Open), Condvar::new())) };
        let (handle, inputs) = queue();
        let own = handle.clone();
        let writer = JournalWriter::start(Box::new(slow.clone()), move || own.wake()).unwrap();
        let kept = writer.kept();
        let mut supervisor = Supervisor::new(SupervisorConfig::default(), Box::new(writer));
        let mut serves = move || serve(&mut supervisor, &inputs, &kept, LogWriter::new(LogLevel::Error));
        let server = thread::spawn(move || serves().map_err(|fault| fault.to_string()));
        let (out, lines) = outbox();
        handle.send(ServerInput::Opened(1, out));
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

    pub(crate) fn ask(&self, request: &Value) {
        self.handle.send(ServerInput::Line(1, RequestLine::read(request.to_string().as_bytes())));
    }

    pub(crate) fn mission(&self, id: u64, robot: &str) {
        let path = json!([{ "kind": "line", "length": 20.0 }]);
        self.ask(&json!({ "id": id, "verb": "mission", "robot": robot, "mission": "1", "path": path }));
    }

    pub(crate) fn next(&self) -> Value {
        // Longer than any machine takes: who waits for what does not come would never end.
        let line = self.lines.recv_timeout(Duration::from_secs(60)).unwrap();
        serde_json::from_str(&line).unwrap()
    }

    /// All that it was told until the server ended.
    pub(crate) fn rest(&self) -> Vec<Value> {
        std::iter::from_fn(|| self.lines.recv().ok()).map(|line| serde_json::from_str(&line).unwrap()).collect()
    }

    pub(crate) fn at(&self, robot: &'static str) -> f64 {
        self.handle.ask(move |supervisor, _, _| supervisor.robot(robot).unwrap().arc_length).unwrap()
    }
}
