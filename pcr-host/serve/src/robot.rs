//! The state of a robot: its abilities, its path, its place on the path, and how far it has been allowed to go.

use crate::course::{Course, Shape};
use pcr_core::{Hold, Interval, Invalid, Motion, Progress};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;

/// Discs are larger by this than they are \[m\]: what rounding does to paths that are cut and joined, and to lengths in messages.
pub const ROOM: f64 = 1e-6;

/// A robot that is further back than it has been by so much more than it may be off, there and here, is not where it was \[m\].
pub const BACK: f64 = 0.05;

/// What a robot can do.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Abilities {
    /// Radius of the disc that it fits in, turning in place, too \[m\].
    pub radius: f64,
    /// To be kept around it, for what it may be off its path \[m\].
    #[serde(default)]
    pub margin: f64,
    /// Largest speed \[m/s\].
    pub speed: f64,
    /// Deceleration with which it stops \[m/s²\].
    pub acceleration: f64,
}

impl Abilities {
    /// # Errors
    /// What is wrong, in words.
    pub fn checked(self) -> Result<Self, String> {
        for (name, value) in [("radius", self.radius), ("speed", self.speed), ("acceleration", self.acceleration)] {
            if !(1e-4..=1e4).contains(&value) {
                return Err(format!("{name}: {value} is out of range; allowed is 0.0001 to 10000"));
            }
        }
        if !(0.0..=1e4).contains(&self.margin) {
            return Err(format!("margin: {} is out of range; allowed is 0 to 10000", self.margin));
        }
        Ok(self)
    }

    /// Radius that orders are made for \[m\].
    pub fn reach(&self) -> f64 {
        self.radius + self.margin + ROOM
    }

    /// The way that it needs to stop from its largest speed \[m\].
    pub fn braking(&self) -> f64 {
        self.speed * self.speed / (2.0 * self.acceleration)
    }
}

/// Why a robot is not allowed to go on, whatever its orders say.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "why")]
pub enum Alarm {
    /// It is beyond what it was allowed to.
    Beyond {
        /// How far it was allowed to go \[m\].
        told: f64,
        /// Where it says it may be \[m\].
        at: f64,
    },
    /// It is further back than it has been: others may have the right to go there.
    Back {
        /// How far it had come \[m\].
        passed: f64,
        /// Between which lengths of its path it is \[m\].
        between: [f64; 2],
    },
    /// It is not on its path.
    Off {
        /// Where it is \[m\].
        x: f64,
        /// \[m\]
        y: f64,
    },
}

/// A mission that waits until it can be admitted.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Waiting {
    /// What the fleet manager calls it.
    pub mission: String,
    /// From which length of the present path on it goes otherwise \[m\].
    pub after: f64,
    /// Number of that path.
    pub path: u64,
    /// The shapes from there on.
    pub shapes: Vec<Shape>,
    /// Its turn: lower ones are tried first.
    pub turn: u64,
}

/// How a mission was asked for: who asks again under its name has to ask for the same.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Asked {
    /// At which length of the path before it begins \[m\].
    pub after: f64,
    /// How many shapes at the end of the path are its own.
    pub shapes: usize,
}

/// How far the orders of a robot allow it to go, as the others were when this was computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wait {
    /// So far.
    pub hold: Hold<f64>,
    /// The number of the robot that it waits for there, and where that one was \[m\]: when it has gone on there is more.
    pub by: Option<(usize, f64)>,
}

/// What others have to remember of a robot, by what it is about.
pub type Notes = BTreeMap<String, Value>;

/// Adds to a list among them, which begins empty; false: what is there is no list.
pub fn remember(notes: &mut Notes, key: &str, more: &[Value]) -> bool {
    let Value::Array(list) = notes.entry(key.into()).or_insert_with(|| Value::Array(Vec::new())) else {
        return false;
    };
    list.extend_from_slice(more);
    true
}

/// A robot as the supervisor knows it.
#[derive(Clone, Debug)]
pub struct Robot {
    /// What it is called.
    pub name: String,
    /// What it can do.
    pub abilities: Abilities,
    /// The path that it has.
    pub course: Course,
    /// Its number: 1 for that with which it was added, or more if others of any name were removed before; and one more each time.
    pub path: u64,
    /// Where the path begins, as a length of the way since the robot was added \[m\]: what was left out of paths before.
    pub origin: f64,
    /// The mission that it has got last.
    pub mission: Option<String>,
    /// How that was asked for; none: not known.
    pub asked: Option<Asked>,
    /// Missions that it had or waited for before, oldest first: who asks late for one of them again gets nothing twice.
    pub past: Vec<String>,
    /// It is here or further on \[m\]; never less than before on the same path.
    pub at: f64,
    /// It was here or before \[m\] at the time `heard`.
    pub up_to: f64,
    /// Time to which `up_to` belongs \[s\]; none since the start.
    pub heard: Option<f64>,
    /// When its last message came \[s\].
    pub alive: Option<f64>,
    /// How far it may go \[m\]: what it may be told, again and again.
    pub granted: f64,
    /// How far it may have been allowed to go \[m\]: `granted`, but after a restart, when more may have been told than is known to be
    /// right now. It may be there, and must not be told so.
    pub told: f64,
    /// What is in the journal of that: `told` or more.
    pub ceiling: f64,
    /// It can stop there, and not before \[m\]: less is of no use to it. Not known after a restart.
    pub next: f64,
    /// How far its orders allow it to go; none: not known.
    pub hold: Option<Wait>,
    /// Something is wrong with it.
    pub alarm: Option<Alarm>,
    /// Who it must stop for, as that one may be anywhere near.
    pub stopped: Option<String>,
    /// A mission that waits.
    pub waiting: Option<Waiting>,
    /// Whether it has been called silent.
    pub silent: bool,
    /// When it was seen to go on last, or got a path \[s\].
    pub moved: Option<f64>,
    /// Whether it has been said since then that nothing goes on because of it.
    pub stands: bool,
    /// What others have to remember of it, by what it is about.
    pub notes: Notes,
}

impl Robot {
    /// A robot that stands at the start of its path, which it has to itself as soon as the others say so.
    pub fn new(name: String, abilities: Abilities, course: Course) -> Self {
        Self {
            name,
            abilities,
            course,
            path: 1,
            origin: 0.0,
            mission: None,
            asked: None,
            past: Vec::new(),
            at: 0.0,
            up_to: 0.0,
            heard: None,
            alive: None,
            granted: 0.0,
            told: 0.0,
            ceiling: 0.0,
            next: 0.0,
            hold: None,
            alarm: None,
            stopped: None,
            waiting: None,
            silent: false,
            moved: None,
            stands: false,
            notes: Notes::new(),
        }
    }

    /// How its mission was asked for: from which length of the path before on, and along which shapes; none: not known.
    pub fn asked(&self) -> Option<(f64, &[Shape])> {
        let Asked { after, shapes } = self.asked?;
        let all = self.course.shapes();
        Some((after, all.get(all.len().checked_sub(shapes)?..)?))
    }

    /// Remembers a mission that is over.
    pub fn outlives(past: &mut Vec<String>, mission: String) {
        /// So many are remembered.
        const MOST: usize = 32;
        past.push(mission);
        let first = past.len().saturating_sub(MOST);
        past.drain(..first);
    }

    /// As a disc on its path.
    ///
    /// # Errors
    /// [`Invalid`] for a radius; robots that were added have been checked.
    pub fn motion(&self) -> Result<Motion<'_, f64>, Invalid> {
        self.course.motion(self.abilities.reach())
    }

    /// Where it is, and where it can be at rest: it may go on to what it has been told without asking again.
    pub fn progress(&self) -> Progress<f64> {
        Progress { at: Interval::new(self.at, self.told), stop: self.told }
    }

    /// Where it can be at a time \[m\]: the upper end grows with its speed up to what it has been told.
    pub fn extent(&self, now: f64) -> Interval<f64> {
        let grown =
            self.heard.map_or(f64::INFINITY, |heard| self.up_to + self.abilities.speed * (now - heard).max(0.0));
        Interval::new(self.at, grown.min(self.told).max(self.at))
    }

    /// How far it wants to be allowed to go \[m\]: so that it need not brake for what it will be told within a time \[s\].
    pub fn wanted(&self, lookahead: f64) -> f64 {
        let way = self.abilities.braking() + self.abilities.speed * lookahead;
        (self.up_to + way).max(self.next).min(self.course.length())
    }

    /// Whether it has come to the end of its path, within a width \[m\].
    pub fn has_arrived(&self, width: f64) -> bool {
        self.at >= self.course.length() - width
    }
}
