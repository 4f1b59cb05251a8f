//! Connects one vehicle with its fleet manager and the supervisor.
//!
//! The manager's order is stored unchanged ([`OrderState`](pcr_formats::vda5050::order_state::OrderState)). The vehicle gets it under the same name, with
//! its base cut to the part that the supervisor has allowed, and with its own numbers of nodes and updates, because the
//! base may end in the middle of an edge. Reports of the vehicle are sent to the manager with the manager's numbers.

mod actions;
mod ends;
mod interim;
mod job;
mod maps;
mod mirror;
mod newest;
mod notes;
mod orders;
mod past;
mod pause;
mod refused;
mod release;
mod states;
mod trim;

pub use job::{Job, Received, Sent, Stop};

use crate::robot::Abilities;
use crate::supervisor::{Damaged, Supervisor};
use interim::Interim;
use newest::Newest;
use notes::noted;
use past::{Noted, Past};
use pause::Pauses;
use pcr_formats::vda5050::header::Header;
use pcr_formats::vda5050::order::Order;
use pcr_formats::vda5050::stamp;
use pcr_formats::vda5050::state::{State, StateError};
use pcr_formats::vda5050::topics::{Key, Kind};
use pcr_formats::vda5050::version::Version;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The configuration of a vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Manufacturer and serial number.
    pub key: Key,
    /// Its abilities. The margin has to cover how far it may be off its path, and the error of its reported position.
    pub abilities: Abilities,
    /// Whether it can stop in the middle of straight edges, and not at nodes only.
    pub split: bool,
}

/// The receiver of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum To {
    /// The vehicle.
    Vehicle,
    /// Its fleet manager.
    Manager,
}

/// When a message may be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Due {
    /// When all that was decided before is in the journal.
    Kept,
    /// At once: it tells the vehicle to stop, and a stop needs no journal.
    AtOnce,
    /// As `Kept`, but not if the vehicle was told to stop since, because it would let the vehicle go.
    Free,
}

/// A message to be sent.
#[derive(Clone, Debug, PartialEq)]
pub struct Post {
    /// Receiver.
    pub to: To,
    /// The vehicle that the message is about.
    pub key: Key,
    /// Edition of the standard.
    pub version: Version,
    /// Kind of message.
    pub kind: Kind,
    /// Content, as JSON.
    pub payload: Vec<u8>,
    /// When it may be sent.
    pub due: Due,
}

/// Key of the note with the radius of the disc that a vehicle needs.
const NEEDS: &str = "needs";

/// Key of the note that a vehicle was seated by a state that may be from before the start.
const DOUBTFUL: &str = "doubtful";

/// One vehicle.
#[derive(Debug)]
pub struct Lane {
    profile: Profile,
    name: String,
    version: Option<Version>,
    newest: BTreeMap<Kind, Newest>,
    /// The last visualization that counted.
    interim: Interim,
    state: Option<Arc<State>>,
    /// The newest state was written at this time or before \[s\].
    heard_at: f64,
    job: Option<Job>,
    /// Orders and updates that have come after a restart before its first state.
    early: Vec<(Order, bool)>,
    /// Orders that it had, and actions by which the manager has cancelled orders.
    orders: Past,
    cancels: Past,
    /// Errors of the manager's orders, reported in states until an order is taken.
    errors: Vec<StateError>,
    /// Number of successive states in which the vehicle does not have its order or is not where it was, and the time of the
    /// first one.
    astray: Option<(u32, f64)>,
    pauses: Pauses,
    sent: BTreeMap<Kind, u64>,
    posts: Vec<Post>,
    /// The nodes and edges ahead, as they were last sent to the manager.
    ahead: Option<mirror::Ahead>,
    /// Radius of the disc that the vehicle needs, according to its own data \[m\].
    needs: Option<f64>,
    /// Why its position is ignored: it is on another map than the other vehicles.
    elsewhere: Option<String>,
    /// Whether it was seated by a state that may be from before the start.
    is_doubtful: bool,
}

impl Lane {
    /// The lane of a vehicle, with the notes that the supervisor has stored about it.
    ///
    /// # Errors
    /// [`Damaged`] if a note cannot be read.
    pub fn new(profile: Profile, supervisor: &Supervisor) -> Result<Self, Damaged> {
        let name = profile.key.to_string();
        let robot = supervisor.robot(&name).ok();
        let job = Job::remembered(robot)?;
        let (orders, cancels) = (Past::remembered("orders", robot)?, Past::remembered("cancels", robot)?);
        let (newest, sent) = (BTreeMap::from([(Kind::State, Newest::begun())]), BTreeMap::new());
        let (errors, posts, early) = (Vec::new(), Vec::new(), Vec::new());
        let version = job.as_ref().and_then(|job| Version::of(&job.version));
        let pauses = Pauses::remembered(robot)?;
        let (state, heard_at, astray) = (None, 0.0, None);
        let needs = noted(robot, NEEDS)?;
        let is_doubtful = noted(robot, DOUBTFUL)?.unwrap_or(false);
        Ok(Self {
            profile,
            name,
            version,
            newest,
            interim: Interim::default(),
            state,
            heard_at,
            job,
            early,
            orders,
            cancels,
            errors,
            astray,
            pauses,
            sent,
            posts,
            ahead: None,
            needs,
            elsewhere: None,
            is_doubtful,
        })
    }

    /// Name of the vehicle in the supervisor.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its configuration.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// Its present or last order.
    pub fn job(&self) -> Option<&Job> {
        self.job.as_ref()
    }

    /// Its last state.
    pub fn state_of(&self) -> Option<&State> {
        self.state.as_deref()
    }

    /// Why the vehicle does not fit into its configured disc, according to its own data.
    pub fn misfit(&self) -> Option<String> {
        let own = self.profile.abilities.radius;
        let needs = self.needs.filter(|needs| *needs > own + 1e-9)?;
        Some(format!("the vehicle needs a disc of {needs} m, not {own}"))
    }

    /// Whether its place may be one from before the start of the supervisor.
    pub fn is_doubtful(&self) -> bool {
        self.is_doubtful
    }

    /// Takes the messages to be sent.
    pub fn posts(&mut self) -> Vec<Post> {
        std::mem::take(&mut self.posts)
    }

    /// The header of our next message of a kind.
    fn header(&mut self, kind: Kind, version: Version) -> Header {
        let number = self.sent.entry(kind).or_insert(0);
        *number += 1;
        Header::new(&self.profile.key, version, *number, stamp::now())
    }

    fn post(&mut self, to: To, kind: Kind, version: Version, message: &impl Serialize) {
        self.post_when(Due::Kept, to, kind, version, message);
    }

    fn post_when(&mut self, due: Due, to: To, kind: Kind, version: Version, message: &impl Serialize) {
        /// Usual largest size of a message \[bytes\].
        const USUAL: usize = 8192;
        let mut payload = Vec::with_capacity(USUAL);
        // Messages of texts and finite numbers can always be written.
        if serde_json::to_writer(&mut payload, message).is_err() {
            payload.clear();
        }
        self.posts.push(Post { to, key: self.profile.key.clone(), version, kind, payload, due });
    }

    /// Stores a note about the vehicle in the supervisor.
    fn note(&self, supervisor: &mut Supervisor, key: &str, note: impl Serialize) {
        // Errors can be ignored: a removed robot needs no note, and after one that could not be written no holds are told
        // either.
        let _ = supervisor.note(&self.name, key, note);
    }

    /// Appends to a note that is a list.
    fn note_more(&self, supervisor: &mut Supervisor, key: &str, more: &[impl Serialize]) {
        // Errors can be ignored, as above.
        let _ = supervisor.note_more(&self.name, key, more);
    }

    /// Stores an id that was used.
    fn note_past(&self, supervisor: &mut Supervisor, key: &str, noted: Noted) {
        match noted {
            Noted::More(more) => self.note_more(supervisor, key, &more),
            Noted::All(all) => self.note(supervisor, key, all),
        }
    }

    /// Stores again the notes that outlive an order, for a robot that was removed and added: removal deletes its notes.
    fn note_anew(&self, supervisor: &mut Supervisor) {
        for past in [&self.orders, &self.cancels] {
            self.note(supervisor, past.key, past.all());
        }
        self.note_pauses(supervisor);
        if self.needs.is_some() {
            self.note(supervisor, NEEDS, self.needs);
        }
    }
}
