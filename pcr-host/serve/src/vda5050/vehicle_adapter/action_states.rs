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

/// The actions at nodes and edges that a vehicle has not come to, in the order of travel, as they wait.
#[derive(Clone, Debug)]
pub(super) struct ActionsAhead {
    /// Those on the edge that begins where it is: it may be on it already, if it has it.
    next: Vec<ActionState>,
    /// Index of the node where it is.
    node: usize,
    others: Vec<ActionState>,
}

/// An action as it waits.
fn waiting(action: &Action) -> ActionState {
    let rest = Map::from_iter([("actionType".to_owned(), action.action_type.clone().into())]);
    ActionState { action_id: action.action_id.clone(), action_status: "WAITING".into(), rest }
}

impl ActiveOrder {
    /// The actions ahead of a node.
    pub(super) fn actions_ahead(&self, node: usize) -> ActionsAhead {
        let (nodes, edges) = (&self.order.nodes, &self.order.edges);
        let of_edge = |edge: usize| edges.get(edge).into_iter().flat_map(|edge| &edge.actions);
        let of_node = |node: usize| nodes.get(node).into_iter().flat_map(|node| &node.actions);
        let others = (node + 1..nodes.len()).flat_map(|node| of_node(node).chain(of_edge(node)));
        ActionsAhead { next: of_edge(node).map(waiting).collect(), node, others: others.map(waiting).collect() }
    }

    /// The states of those that the vehicle does not list.
    fn unlisted_actions(&self, ahead: &ActionsAhead, state: &State) -> Vec<ActionState> {
        let next = if ahead.node == self.last().node { ahead.next.as_slice() } else { &[] };
        let own = next.iter().chain(&ahead.others).filter(|own| state.action(&own.action_id).is_none());
        let is_over = self.cancel.is_some() || self.lost_at.is_some();
        let status = if is_over { "FAILED" } else { "WAITING" };
        own.map(|own| ActionState { action_status: status.into(), ..own.clone() }).collect()
    }
}

impl VehicleAdapter {
    /// Adds the actions of the order that the vehicle does not list to its state.
    pub(super) fn add_action_states(&self, state: &mut State) {
        let more = match (&self.job, &self.ahead) {
            (Some(job), Some(ahead)) => job.unlisted_actions(&ahead.actions, state),
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
            let here = job.passed(state).and_then(|place| job.stops.get(place)).map_or(0, |stop| stop.node);
            let mut states = job.unlisted_actions(&job.actions_ahead(here), state);
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
