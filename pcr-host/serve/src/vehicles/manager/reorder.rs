//! Orders for the rest of the way.
//!
//! An order can be refused for good although its manager has never seen the vehicle with it: the state was lost in which the vehicle had
//! it, and then the vehicle has lost it. So an order that is refused in several states is replaced, too, while the vehicle has nothing to
//! do. If the vehicle takes a late copy of the refused order, that is its order again.

use super::super::edge_reservations::to_line;
use super::{FleetManager, IssuedOrder, ManagedVehicle, NEAR, OutgoingMessage};
use pcr_formats::vda5050::order::{OrderEdge, OrderNode};
use pcr_formats::vda5050::state::State;
use pcr_formats::vda5050::topics::VehicleId;

/// Number of refused orders of a vehicle that are kept.
const MOST: usize = 8;

impl FleetManager {
    /// The rest of the way for a vehicle that has lost its order, or whose order is refused, from where it stands.
    pub(super) fn plan_anew(&mut self, key: &VehicleId, state: &State, now: f64) -> Option<OutgoingMessage> {
        let pose = state.position().filter(|pose| pose.is_known())?;
        let given = self.clients.get(key)?.order.as_ref()?;
        let (lost, had) = (&given.order, given.had);
        let place = |node: &OrderNode| node.node_position.as_ref().map(|position| [position.x, position.y]);
        let places: Vec<[f64; 2]> = lost.nodes.iter().filter_map(place).collect();
        let here = [pose.x, pose.y];
        let off = |leg: &[[f64; 2]]| to_line(here, leg[0], leg[1]);
        let legs = places.windows(2).enumerate();
        let nearest = legs.min_by(|a, b| off(a.1).total_cmp(&off(b.1))).map_or(0, |(leg, _)| leg);
        let near = |node: usize| places.get(node).is_some_and(|at| (at[0] - here[0]).hypot(at[1] - here[1]) <= NEAR);
        // From the node where it stands, or across one where it stands to the next.
        let (first, is_between) = match [nearest, nearest + 1].into_iter().rfind(|&node| near(node)) {
            Some(node) => (node, false),
            None => (nearest, true),
        };
        let mut nodes: Vec<OrderNode> = lost.nodes.iter().skip(first).cloned().collect();
        let mut edges: Vec<OrderEdge> = lost.edges.iter().skip(first).cloned().collect();
        if is_between {
            let begin = nodes.first_mut()?;
            begin.node_id = format!("{}+", begin.node_id);
            begin.node_position = Some(self.position(pose));
            edges.first_mut()?.start_node_id = Some(begin.node_id.clone());
        }
        for (k, node) in nodes.iter_mut().enumerate() {
            node.sequence_id = 2 * k as u64;
        }
        for (k, edge) in edges.iter_mut().enumerate() {
            edge.sequence_id = 2 * k as u64 + 1;
        }
        self.again += 1;
        if !had {
            let client = self.clients.get_mut(key)?;
            client.refused.extend(client.order.take().map(|given| given.order));
            client.refused.drain(..client.refused.len().saturating_sub(MOST));
        }
        self.begin(key, nodes, edges, now)
    }
}

impl ManagedVehicle {
    /// Makes a refused order the present one, if the vehicle has it.
    pub(super) fn takes_back(&mut self, state: &State, now: f64) {
        let Some(given) = self.order.as_mut().filter(|given| given.order.order_id != state.order_id) else { return };
        if let Some(refused) = self.refused.iter_mut().find(|order| order.order_id == state.order_id) {
            std::mem::swap(refused, &mut given.order);
            (given.had, given.lost, given.from, given.sent) = (false, None, 0, now);
            given.released = given.order.edges.len();
        }
    }
}

impl IssuedOrder {
    /// Whether the vehicle, or its supervisor, says that it does not take the order.
    pub(super) fn is_refused(&self, state: &State) -> bool {
        state.errors.iter().any(|error| error.refuses(&self.order.order_id))
    }
}
