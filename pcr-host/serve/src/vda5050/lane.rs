//! Connects one vehicle with its fleet manager and the supervisor.
//!
//! The manager's order is stored unchanged ([`Held`](super::held::Held)). The vehicle gets it under the same name, with
//! its base cut to the part that the supervisor has allowed, and with its own numbers of nodes and updates, because the
//! base may end in the middle of an edge. Reports of the vehicle are sent to the manager with the manager's numbers.

mod actions;
mod job;
mod maps;
mod mirror;
mod newest;
mod notes;
mod orders;
mod past;
mod pause;
mod release;
mod states;

pub use job::{Job, Sent, Stop};

use super::header::Header;
use super::order::Order;
use super::stamp;
use super::state::{State, StateError};
use super::topics::{Key, Kind};
use super::version::Version;
use crate::robot::Abilities;
use crate::supervisor::{Damaged, Supervisor};
use newest::Newest;
use past::{Noted, Past};
use pause::Pauses;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What is known of a vehicle before it says anything.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Which.
    pub key: Key,
    /// Its margin has to cover how far it may be off its path, and how far it may be from where it says.
    pub abilities: Abilities,
    /// Whether it can be sent to places in the middle of straight edges, so that it need not wait at nodes.
    pub split: bool,
}

/// To whom a message goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum To {
    /// The vehicle.
    Vehicle,
    /// Its fleet manager.
    Manager,
}

/// A message to be sent.
#[derive(Clone, Debug, PartialEq)]
pub struct Post {
    /// To whom.
    pub to: To,
    /// Whose.
    pub key: Key,
    /// Of which edition.
    pub version: Version,
    /// What.
    pub kind: Kind,
    /// JSON.
    pub payload: Vec<u8>,
}

/// One vehicle.
#[derive(Debug)]
pub struct Lane {
    profile: Profile,
    name: String,
    version: Option<Version>,
    newest: BTreeMap<Kind, Newest>,
    state: Option<Arc<State>>,
    /// When that came \[s\].
    heard_at: f64,
    job: Option<Job>,
    /// The orders that it had, and the actions by which the manager has cancelled any.
    orders: Past,
    cancels: Past,
    /// What the manager is told is wrong with its orders, until one is taken.
    errors: Vec<StateError>,
    /// Messages in a row after which it does not have the order that it had, or is not where it was, and when the first one came.
    astray: Option<(u32, f64)>,
    pauses: Pauses,
    sent: BTreeMap<Kind, u64>,
    posts: Vec<Post>,
    /// What the manager was told of what is ahead.
    ahead: Option<mirror::Ahead>,
    /// Why its disc is not that of the vehicle, by the vehicle's own words.
    misfit: Option<String>,
    /// Why it does not stand where it says: that is another map than that of the others.
    elsewhere: Option<String>,
}

impl Lane {
    /// Of a vehicle, with what the supervisor remembers of it.
    ///
    /// # Errors
    /// [`Damaged`] where that cannot be read.
    pub fn new(profile: Profile, supervisor: &Supervisor) -> Result<Self, Damaged> {
        let name = profile.key.to_string();
        let robot = supervisor.robot(&name).ok();
        let job = Job::remembered(robot)?;
        let (orders, cancels) = (Past::remembered("orders", robot)?, Past::remembered("cancels", robot)?);
        let (newest, sent) = (BTreeMap::new(), BTreeMap::new());
        let (errors, posts) = (Vec::new(), Vec::new());
        let version = job.as_ref().and_then(|job| Version::of(&job.version));
        let pauses = Pauses::remembered(robot)?;
        let (state, heard_at, astray) = (None, 0.0, None);
        Ok(Self {
            profile,
            name,
            version,
            newest,
            state,
            heard_at,
            job,
            orders,
            cancels,
            errors,
            astray,
            pauses,
            sent,
            posts,
            ahead: None,
            misfit: None,
            elsewhere: None,
        })
    }

    /// What the supervisor calls it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What is known of it before it says anything.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// The order that it has, or had last.
    pub fn job(&self) -> Option<&Job> {
        self.job.as_ref()
    }

    /// What it has said last.
    pub fn state_of(&self) -> Option<&State> {
        self.state.as_deref()
    }

    /// Why its disc is not that of the vehicle, by what the vehicle says of itself.
    pub fn misfit(&self) -> Option<&str> {
        self.misfit.as_deref()
    }

    /// The messages to be sent.
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
        /// Most messages are no longer \[bytes\].
        const USUAL: usize = 8192;
        let mut payload = Vec::with_capacity(USUAL);
        // Maps of texts and finite numbers: there is no message that cannot be written.
        if serde_json::to_writer(&mut payload, message).is_err() {
            payload.clear();
        }
        self.posts.push(Post { to, key: self.profile.key.clone(), version, kind, payload });
    }

    /// Remembers what it has to.
    fn note(&self, supervisor: &mut Supervisor, key: &str, note: Value) {
        // A robot that is not there needs no memory; a broken journal tells no more holds either.
        let _ = supervisor.note(&self.name, key, note);
    }

    /// Adds to a list that it has to remember.
    fn note_more(&self, supervisor: &mut Supervisor, key: &str, more: Vec<Value>) {
        // As above.
        let _ = supervisor.note_more(&self.name, key, more);
    }

    /// Remembers a name that was used.
    fn note_past(&self, supervisor: &mut Supervisor, key: &str, noted: Noted) {
        match noted {
            Noted::More(more) => self.note_more(supervisor, key, more),
            Noted::All(all) => self.note(supervisor, key, all),
        }
    }

    /// Remembers for a robot that was added anew what outlives its order: its notes went with the one before.
    fn note_anew(&self, supervisor: &mut Supervisor) {
        for past in [&self.orders, &self.cancels] {
            self.note(supervisor, past.key, past.all());
        }
        self.note_pauses(supervisor);
    }
}

/// An order of ours.
fn order(header: Header, order_id: String, order_update_id: u64) -> Order {
    Order { header, order_id, order_update_id, nodes: Vec::new(), edges: Vec::new(), rest: serde_json::Map::new() }
}
