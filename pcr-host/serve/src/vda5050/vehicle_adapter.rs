//! Connects one vehicle with its fleet manager and the supervisor.
//!
//! The manager's order is stored unchanged ([`OrderState`](pcr_formats::vda5050::order_state::OrderState)). The vehicle gets it under the same name, with
//! its base cut to the part that the supervisor has allowed, and with its own numbers of nodes and updates, because the
//! base may end in the middle of an edge. Reports of the vehicle are sent to the manager with the manager's numbers.

mod absence;
mod action_states;
mod actions;
mod base_end;
mod corridors;
mod interim;
mod job;
mod journal_notes;
mod manager_orders;
mod manager_state;
mod map_check;
mod order_termination;
mod pause;
mod recency;
mod refused_orders;
mod release;
mod speed_limits;
mod vehicle_messages;
mod zones;

pub use job::ActiveOrder;

use crate::robot::RobotTraits;
use crate::supervisor::{JournalError, PauseAbility, StandingPlace, Supervisor};
use action_states::UnsentActions;
use base_end::OrderWait;
use interim::Interim;
use journal_notes::{NoteChange, UsedIds, noted};
use pause::VehiclePauses;
use pcr_formats::vda5050::header::MessageHeader;
use pcr_formats::vda5050::order::Order;
use pcr_formats::vda5050::state::{ErrorEntry, State};
use pcr_formats::vda5050::timestamp;
use pcr_formats::vda5050::topics::{TopicKind, VehicleId};
use pcr_formats::vda5050::version::ProtocolVersion;
use recency::RecencyFilter;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;
use vehicle_messages::PositionSource;
use zones::VehicleZones;

/// What a notice to the manager is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoticeKind {
    /// A vehicle for which others wait.
    Unplaced,
    /// A closed area.
    Closed,
    /// An area in which the speed is limited.
    Limited,
    /// The pause of the whole fleet.
    Paused,
}

/// The configuration of a vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct VehicleConfig {
    /// Manufacturer and serial number.
    pub key: VehicleId,
    /// Its abilities. The margin has to cover how far it may be off its path, and the error of its reported position.
    pub abilities: RobotTraits,
    /// Whether it can stop in the middle of straight edges, and not at nodes only.
    pub split: bool,
    /// Whether it is away at the start; `None`: as the journal says.
    pub away: Option<bool>,
    /// Where its reference point may be as long as it has not said where it stands: discs around the places where it is switched on. Empty: anywhere.
    pub places: Vec<StandingPlace>,
}

/// The receiver of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Recipient {
    /// The vehicle.
    Vehicle,
    /// Its fleet manager.
    Manager,
}

/// When a message may be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SendCondition {
    /// When all that was decided before is in the journal.
    Kept,
    /// At once: it tells the vehicle to stop, and a stop needs no journal.
    AtOnce,
    /// As `Kept`, but not if the vehicle was told to stop since, because it would let the vehicle go.
    Free,
}

/// A message to be sent.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OutboundMessage {
    /// Receiver.
    pub to: Recipient,
    /// The vehicle that the message is about.
    pub key: VehicleId,
    /// Edition of the standard.
    pub version: ProtocolVersion,
    /// Kind of message.
    pub kind: TopicKind,
    /// Content, as JSON.
    pub payload: Vec<u8>,
    /// When it may be sent.
    pub due: SendCondition,
}

/// Key of the note with what a vehicle needs, according to its own data.
const NEEDS: &str = "needs";

/// Key of the note that a vehicle was seated by a state that may be from before the start.
const DOUBTFUL: &str = "doubtful";

/// One vehicle.
#[derive(Debug)]
pub struct VehicleAdapter {
    profile: VehicleConfig,
    name: String,
    version: Option<ProtocolVersion>,
    newest: BTreeMap<TopicKind, RecencyFilter>,
    /// The last visualization that counted.
    interim: Interim,
    state: Option<Arc<State>>,
    /// The newest state was written at this time or before \[s\].
    heard_at: f64,
    job: Option<ActiveOrder>,
    /// Actions of the order before that it never gets.
    unsent: Option<UnsentActions>,
    /// Orders and updates that have come after a restart before its first state.
    early: Vec<(Order, bool)>,
    /// Orders that it had, and actions by which the manager has cancelled orders.
    orders: UsedIds,
    cancels: UsedIds,
    /// Errors of the manager's orders, reported in states until an order is taken.
    errors: Vec<ErrorEntry>,
    /// Number of successive states in which the vehicle does not have its order or is not where it was, and the time of the
    /// first one.
    astray: Option<(u32, f64)>,
    pauses: VehiclePauses,
    sent: BTreeMap<TopicKind, u64>,
    posts: Vec<OutboundMessage>,
    /// The nodes and edges ahead, as they were last sent to the manager.
    ahead: Option<manager_state::CachedRemaining>,
    /// The zones that its manager has sent it.
    zones: VehicleZones,
    /// Why its order waits, if it does.
    wait: Option<OrderWait>,
    /// What the vehicle needs, according to its own data: the radius of its disc, or how far it reaches beyond its outline \[m\].
    needs: Option<f64>,
    /// Why it is not certain that it can be paused; `None`: its factsheet says that it can.
    pause_ability: Option<PauseAbility>,
    /// Why its position is ignored: it is on another map than the other vehicles.
    elsewhere: Option<String>,
    /// Whether it was seated by a state that may be from before the start.
    is_doubtful: bool,
    /// Whether it is away, as it was known last.
    is_away: bool,
    /// Vehicles for which others wait, and why.
    notices: Vec<(NoticeKind, [String; 2])>,
    /// What is to be told of its orders in the log.
    remarks: Vec<String>,
}

impl VehicleAdapter {
    /// The lane of a vehicle, with the notes that the supervisor has stored about it.
    ///
    /// # Errors
    /// [`JournalError`] if a note cannot be read.
    pub fn new(profile: VehicleConfig, supervisor: &Supervisor) -> Result<Self, JournalError> {
        let name = profile.key.to_string();
        let robot = supervisor.robot(&name).ok();
        let job = ActiveOrder::remembered(robot)?;
        let (orders, cancels) = (UsedIds::remembered("orders", robot)?, UsedIds::remembered("cancels", robot)?);
        let (newest, sent) = (BTreeMap::from([(TopicKind::State, RecencyFilter::begun())]), BTreeMap::new());
        let (errors, posts, early) = (Vec::new(), Vec::new(), Vec::new());
        let version = job.as_ref().and_then(|job| ProtocolVersion::parse(&job.version));
        let pauses = VehiclePauses::remembered(robot)?;
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
            unsent: UnsentActions::remembered(robot)?,
            early,
            orders,
            cancels,
            errors,
            astray,
            pauses,
            sent,
            posts,
            ahead: None,
            wait: None,
            zones: VehicleZones::remembered(robot)?,
            needs,
            pause_ability: Some(PauseAbility::Unknown),
            elsewhere: None,
            is_doubtful,
            is_away: false,
            notices: Vec::new(),
            remarks: Vec::new(),
        })
    }

    /// Name of the vehicle in the supervisor.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its configuration.
    pub fn profile(&self) -> &VehicleConfig {
        &self.profile
    }

    /// Takes another configuration.
    pub(crate) fn reconfigure(&mut self, profile: VehicleConfig) {
        self.profile = profile;
    }

    /// Its present or last order.
    pub fn job(&self) -> Option<&ActiveOrder> {
        self.job.as_ref()
    }

    /// Its last state.
    pub fn state_of(&self) -> Option<&State> {
        self.state.as_deref()
    }

    /// Why the vehicle does not fit into its configured disc or outline, according to its own data.
    pub fn misfit(&self) -> Option<String> {
        let RobotTraits { radius, footprint, .. } = &self.profile.abilities;
        let own = if footprint.is_some() { 0.0 } else { *radius };
        let needs = self.needs.filter(|needs| *needs > own + 1e-9)?;
        Some(match footprint {
            Some(_) => format!("the vehicle reaches {needs:.3} m beyond its outline"),
            None => format!("the vehicle needs a disc of {needs} m, not {own}"),
        })
    }

    /// Why it is not certain that it can be paused; `None` if it can.
    pub fn pause_ability(&self) -> Option<PauseAbility> {
        self.pause_ability
    }

    /// Takes what is to be told in the log.
    pub(crate) fn remarks(&mut self) -> Vec<String> {
        std::mem::take(&mut self.remarks)
    }

    /// Takes the messages to be sent.
    pub(crate) fn posts(&mut self) -> Vec<OutboundMessage> {
        std::mem::take(&mut self.posts)
    }

    /// The header of our next message of a kind.
    fn header(&mut self, kind: TopicKind, version: ProtocolVersion) -> MessageHeader {
        let number = self.sent.entry(kind).or_insert(0);
        *number += 1;
        MessageHeader::new(&self.profile.key, version, *number, timestamp::now())
    }

    fn post(&mut self, to: Recipient, kind: TopicKind, version: ProtocolVersion, message: &impl Serialize) {
        self.post_when(SendCondition::Kept, to, kind, version, message);
    }

    fn post_when(
        &mut self,
        due: SendCondition,
        to: Recipient,
        kind: TopicKind,
        version: ProtocolVersion,
        message: &impl Serialize,
    ) {
        /// Usual largest size of a message \[bytes\].
        const USUAL: usize = 8192;
        let mut payload = Vec::with_capacity(USUAL);
        // Messages of texts and finite numbers can always be written.
        if serde_json::to_writer(&mut payload, message).is_err() {
            payload.clear();
        }
        self.posts.push(OutboundMessage { to, key: self.profile.key.clone(), version, kind, payload, due });
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
    fn note_past(&self, supervisor: &mut Supervisor, key: &str, noted: NoteChange) {
        match noted {
            NoteChange::More(more) => self.note_more(supervisor, key, &more),
            NoteChange::All(all) => self.note(supervisor, key, all),
        }
    }

    /// Stores again the notes that outlive an order, for a robot that was removed and added: removal deletes its notes.
    fn note_anew(&self, supervisor: &mut Supervisor) {
        for past in [&self.orders, &self.cancels] {
            self.note(supervisor, past.key, past.all());
        }
        self.note_pauses(supervisor);
        self.note_zones(supervisor);
        if self.unsent.is_some() {
            self.note_unsent(supervisor);
        }
        if self.needs.is_some() {
            self.note(supervisor, NEEDS, self.needs);
        }
    }
}
