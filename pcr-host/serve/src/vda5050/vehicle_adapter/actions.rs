//! Instant actions: those of the manager, and our own.

use super::release::AGAIN;
use super::{Recipient, SendCondition, VehicleAdapter};
use crate::event::{CancelCause, SupervisorEvent};
use crate::supervisor::Supervisor;
use pcr_formats::vda5050::decode::{self, DecodeError, MessageLimits};
use pcr_formats::vda5050::header::MessageHeader;
use pcr_formats::vda5050::messages::{Action, InstantActions};
use pcr_formats::vda5050::order_state::RejectedOrder;
use pcr_formats::vda5050::state::State;
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::{OrderRejection, ProtocolVersion};
use serde_json::{Map, Value};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

impl VehicleAdapter {
    /// Passes on instant actions of the manager. An order that they cancel gets no further update.
    ///
    /// # Errors
    /// [`DecodeError`] for an invalid message, for a `cancelOrder` with a used `actionId`, which is passed on but cancels nothing,
    /// and for a `stopPause` while the vehicle has to stand.
    pub fn instant_actions(
        &mut self,
        supervisor: &mut Supervisor,
        bytes: &[u8],
        limits: MessageLimits,
        is_third: bool,
        now: f64,
    ) -> Result<(), DecodeError> {
        let message: InstantActions = decode::read(bytes, limits)?;
        let actions = message.list()?;
        // Schema 2.0 does not require a header.
        let version = match (message.header.version.as_str(), self.version) {
            ("", Some(version)) => version,
            _ => message.header.check(&self.profile.key, is_third)?,
        };
        if actions.iter().any(|action| action.action_type == "cancelOrder") {
            self.early.clear();
        }
        let (cancel, repeated) = self.cancels(supervisor, actions);
        if cancel.is_some_and(|cancel| self.note_cancel(supervisor, cancel, now)) {
            // Without another mission in its place: lengths that the vehicle reports are those of its order.
            let _ = supervisor.give_up(&self.name);
        }
        let (due, held) = self.hold_back(supervisor, actions.to_vec(), now);
        if held.is_none() || !due.is_empty() {
            self.act(version, &due, &message.rest);
        }
        repeated.or(held).map_or(Ok(()), Err)
    }

    /// The action that cancels the order, if there is one. A used `actionId` means a repeated message: the vehicle ignores it,
    /// and reports it as finished since the order before.
    fn cancels(&mut self, supervisor: &mut Supervisor, actions: &[Action]) -> (Option<String>, Option<DecodeError>) {
        let (mut cancel, mut repeated) = (None, None);
        let order = self.job.as_ref().map_or("", |job| job.order.order_id.as_str());
        for (k, action) in actions.iter().enumerate().filter(|(_, action)| action.action_type == "cancelOrder") {
            let id = &action.action_id;
            // Since 3.0 it may name an order, and if that is another one the vehicle reports it as failed. Older vehicles do not know that.
            let is_third = self.version.is_some_and(|version| version.major() == ProtocolVersion::V3_0.major());
            if is_third && action.parameter("orderId").is_some_and(|asked| asked != order) {
                continue;
            }
            let is_over = |state: &State| matches!(state.action(id), Some("FINISHED" | "FAILED"));
            if self.cancels.contains(id) || self.state.as_deref().is_some_and(is_over) {
                let why = format!("{id:?} was there before: it cancels nothing");
                repeated.get_or_insert(DecodeError::new(format!("actions[{k}].actionId"), why));
                continue;
            }
            let noted = self.cancels.push(id);
            self.note_past(supervisor, self.cancels.key, noted);
            cancel.get_or_insert(id.clone());
        }
        (cancel, repeated)
    }

    /// Sends an instant action of our own, and returns its id.
    pub fn ask_for(&mut self, action_type: &str) -> String {
        /// An earlier supervisor of this program may have sent an action within the same millisecond.
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let version = self.version.unwrap_or(ProtocolVersion::V2_1);
        let header = self.header(TopicKind::InstantActions, version);
        let id = format!("pcr-{action_type}-{}-{}", header.timestamp, COUNT.fetch_add(1, Relaxed));
        let message = InstantActions::one(header, action_type, id.clone());
        let due = match action_type {
            "startPause" => SendCondition::AtOnce,
            "stopPause" => SendCondition::Free,
            _ => SendCondition::Kept,
        };
        self.post_when(due, Recipient::Vehicle, TopicKind::InstantActions, version, &message);
        id
    }

    /// Sends instant actions of the manager, in their order. Those that let the vehicle go on are not sent if it was told to stop since; so they
    /// are in messages of their own.
    pub(super) fn act(&mut self, version: ProtocolVersion, actions: &[Action], rest: &Map<String, Value>) {
        let is_free = |action: &Action| action.action_type == "stopPause";
        let mut send = |actions: &[Action]| {
            let due = if actions.first().is_some_and(is_free) { SendCondition::Free } else { SendCondition::Kept };
            let message =
                |header| InstantActions { rest: rest.clone(), ..InstantActions::new(header, actions.to_vec()) };
            self.post_actions(due, version, message);
        };
        if actions.is_empty() {
            send(actions);
        }
        actions.chunk_by(|a, b| is_free(a) == is_free(b)).for_each(send);
    }

    /// Sends instant actions to the vehicle.
    fn post_actions(
        &mut self,
        due: SendCondition,
        version: ProtocolVersion,
        message: impl FnOnce(MessageHeader) -> InstantActions,
    ) {
        let message = message(self.header(TopicKind::InstantActions, version));
        self.post_when(due, Recipient::Vehicle, TopicKind::InstantActions, version, &message);
    }

    /// Notes that an action of this id cancels the order. Without it there is nothing to cancel.
    fn note_cancel(&mut self, supervisor: &mut Supervisor, id: String, now: f64) -> bool {
        let Some(job) = &mut self.job else { return false };
        job.is_cancelled(id, now);
        let given = job.given();
        self.note(supervisor, "order", given);
        true
    }

    /// Cancels the order of the vehicle again, with another action id.
    pub(super) fn cancel_again(&mut self, supervisor: &mut Supervisor, now: f64) {
        if self.version.is_none() {
            return;
        }
        let id = self.ask_for("cancelOrder");
        self.note_cancel(supervisor, id, now);
    }

    /// The cancellation may be lost: it is sent again until the vehicle says what became of it.
    pub(super) fn follow_cancel(&mut self, now: f64) {
        let (Some(version), Some(state), Some(job)) = (self.version, &self.state, &mut self.job) else { return };
        let Some(cancel) = &mut job.cancel else { return };
        if state.action(&cancel.action).is_none() && now - cancel.last_at >= AGAIN {
            cancel.last_at = now;
            let id = cancel.action.clone();
            let message = |header| InstantActions::one(header, "cancelOrder", id);
            self.post_actions(SendCondition::Kept, version, message);
        }
    }

    /// Whether the vehicle carries out a `cancelOrder`.
    pub(super) fn is_cancelling(&self, state: &State) -> bool {
        let mut all = state.action_states.iter().chain(state.instant_action_states.iter().flatten());
        all.any(|action| {
            let kind = action.rest.get("actionType").and_then(Value::as_str);
            // Vehicles need not report the type of an action.
            let cancels = kind == Some("cancelOrder")
                || self.cancels.contains(&action.action_id)
                || action.action_id.starts_with("pcr-cancelOrder-");
            cancels && matches!(action.action_status.as_str(), "WAITING" | "INITIALIZING" | "RUNNING" | "PAUSED")
        })
    }

    /// Handles an event of the supervisor about the vehicle.
    pub(crate) fn on_event(&mut self, event: &SupervisorEvent) {
        // A mission that was replaced by a longer one of the same order is not lost, and one that was cancelled, or whose vehicle was moved,
        // is no error.
        let SupervisorEvent::Dropped { mission, why: CancelCause::Impossible(why), .. } = event else { return };
        let order = mission.rsplit_once('#').map_or(mission.as_str(), |(order, _)| order);
        let update = self.job.as_ref().map_or(0, |job| job.order.update_id);
        if self.job.as_ref().is_none_or(|job| job.cancel.is_none()) {
            self.reject(&RejectedOrder::new(OrderRejection::Order, "nodes", why), order, update);
            self.mirror();
        }
    }
}
