//! Running the binary, and scenarios to run it on.

use serde_json::{Value, json};
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// The paper's 12 agents.
pub(crate) const PAPER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/formats/scenarios/paper12.json");

/// What a run left behind.
pub(crate) struct Run {
    pub(crate) status: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

pub(crate) fn pcr() -> Command {
    Command::new(env!("CARGO_BIN_EXE_pcr"))
}

pub(crate) fn run(arguments: &[&str]) -> Run {
    run_with(arguments, b"")
}

pub(crate) fn run_with(arguments: &[&str], input: &[u8]) -> Run {
    let mut command = pcr();
    command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let input = input.to_vec();
    // A tool that stops early closes the pipe; that is its own business.
    let feed = std::thread::spawn(move || drop(stdin.write_all(&input)));
    let output = child.wait_with_output().unwrap();
    feed.join().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    Run { status: output.status.code().unwrap(), out: text(output.stdout), err: text(output.stderr) }
}

impl Run {
    /// The output of a run that went well.
    #[track_caller]
    pub(crate) fn ok(self) -> String {
        assert_eq!((self.status, self.err.as_str()), (0, ""));
        self.out
    }

    /// The JSON output of a run that went well.
    #[track_caller]
    pub(crate) fn json(self) -> Value {
        serde_json::from_str(&self.ok()).unwrap()
    }

    /// The JSON output of a run with this status and no message.
    #[track_caller]
    pub(crate) fn json_of(self, status: i32) -> Value {
        assert_eq!((self.status, self.err.as_str()), (status, ""));
        serde_json::from_str(&self.out).unwrap()
    }

    /// The message of a run that failed with this status and printed nothing else.
    #[track_caller]
    pub(crate) fn failed(self, status: i32) -> String {
        assert_eq!((self.status, self.out.as_str()), (status, ""), "{}", self.err);
        assert!(self.err.starts_with("pcr: ") && self.err.ends_with('\n'), "{}", self.err);
        assert_eq!(self.err.lines().count(), 1, "{}", self.err);
        self.err
    }
}

/// A place for files of a test.
pub(crate) fn directory(test: &str) -> PathBuf {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(test);
    fs::create_dir_all(&directory).unwrap();
    directory
}

/// The path of a file with this content.
pub(crate) fn file(test: &str, name: &str, content: impl AsRef<[u8]>) -> String {
    let path = directory(test).join(name);
    fs::write(&path, content).unwrap();
    path.to_str().unwrap().to_owned()
}

/// An agent that goes straight ahead, from rest to rest.
pub(crate) fn straight(id: u64, [x, y, heading]: [f64; 3], length: f64) -> Value {
    json!({
        "id": id, "radius": 0.25, "v_max": 1.0, "a_max": 1.0,
        "start": { "x": x, "y": y, "heading": heading },
        "path": [{ "kind": "line", "length": length }],
    })
}

/// Two agents that cross at right angles in the middle of their paths of 4 m.
pub(crate) fn crossing() -> Value {
    let north = std::f64::consts::FRAC_PI_2;
    json!({ "name": "crossing", "agents": [straight(1, [-2.0, 0.0, 0.0], 4.0), straight(2, [0.0, -2.0, north], 4.0)] })
}

/// The column of the value with this pointer in the text of a scenario on one line.
pub(crate) fn column(scenario: &Value, pointer: &str) -> usize {
    let mut marked = scenario.clone();
    *marked.pointer_mut(pointer).unwrap() = Value::from("this one");
    marked.to_string().find("\"this one\"").unwrap() + 1
}
