//! States of the actions of an order that the vehicle does not list, because it does not have them: it gets them later, or never any more.

use super::journal_notes::noted;
use super::{ActiveOrder, VehicleAdapter};
use crate::robot::SupervisedRobot;
use crate::supervisor::{JournalError, Supervisor};
use pcr_formats::vda5050::messages::Action;
use pcr_formats::vda5050::state::{ActionState, State};
use serde::{Deserialize, Serialize};
use serde_json::Map;

/// Key of the note with the actions that a vehicle never gets.
const NOTE: &str = "unsent";

/// The actions of the order before which the vehicle has not got, and never gets, because that order is over.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct UnsentActions {
    order: String,
    states: Vec<ActionState>,
}

impl UnsentActions {
    /// What the journal has.
    ///
    /// # Errors
    /// [`JournalError`] where that cannot be read.
    pub(super) fn remembered(robot: Option<&SupervisedRobot>) -> Result<Option<Self>, JournalError> {
        noted(robot, NOTE)
    }
}

impl ActiveOrder {
    /// The actions at nodes and edges that a vehicle has not come to, in the order of travel.
    fn actions_ahead(&self, state: &State) -> impl Iterator<Item = &Action> {
        let here = self.passed(state).and_then(|place| self.stops.get(place)).map_or(0, |stop| stop.node);
        // On the edge that begins here it may be already, if it has it.
        let edge = if here == self.last().node { here } else { here + 1 };
        let (nodes, edges) = (&self.order.nodes, &self.order.edges);
        (here..edges.len()).flat_map(move |k| {
            let of_edge = edges.get(k.max(edge)).filter(|_| k >= edge).map(|edge| &edge.actions);
            let of_node = nodes.get(k + 1).map(|node| &node.actions);
            of_edge.into_iter().chain(of_node).flatten()
        })
    }

    /// The states of those that the vehicle does not list.
    fn unlisted_actions(&self, state: &State) -> Vec<ActionState> {
        let status = if self.cancel.is_some() || self.lost_at.is_some() { "FAILED" } else { "WAITING" };
        let own = self.actions_ahead(state).filter(|action| state.action(&action.action_id).is_none());
        let own = own.map(|action| ActionState {
            action_id: action.action_id.clone(),
            action_status: status.into(),
            rest: Map::from_iter([("actionType".to_owned(), action.action_type.clone().into())]),
        });
        own.collect()
    }
}

impl VehicleAdapter {
    /// Adds the actions of the order that the vehicle does not list to its state.
    pub(super) fn add_action_states(&self, state: &mut State) {
        let more = match &self.job {
            Some(job) if job.order.order_id == state.order_id => job.unlisted_actions(state),
            _ => {
                let unsent = self.unsent.iter().filter(|unsent| unsent.order == state.order_id);
                let all = unsent.flat_map(|unsent| &unsent.states);
                all.filter(|own| state.action(&own.action_id).is_none()).cloned().collect()
            }
        };
        state.action_states.extend(more);
    }

    /// Keeps the actions that a vehicle has not got of an order that is over: they have failed.
    pub(super) fn keep_unsent(&mut self, state: &State) {
        let job = self.job.as_ref().filter(|job| job.order.order_id == state.order_id);
        let unsent = job.map(|job| {
            let mut states = job.unlisted_actions(state);
            states.iter_mut().for_each(|own| own.action_status = "FAILED".into());
            UnsentActions { order: job.order.order_id.clone(), states }
        });
        self.unsent = unsent.filter(|unsent| !unsent.states.is_empty());
    }

    /// The vehicle has another order: those of the one before are not told any more.
    pub(super) fn drop_unsent(&mut self, supervisor: &mut Supervisor) {
        if self.unsent.take().is_some() {
            self.note_unsent(supervisor);
        }
    }

    /// Stores them in the journal.
    pub(super) fn note_unsent(&self, supervisor: &mut Supervisor) {
        self.note(supervisor, NOTE, &self.unsent);
    }
}
