//! An order as its receiver holds it; updates are stitched to its base as the standard says.

use super::door::Refusal;
use super::order::{Edge, Node, Order};
use super::version::Error;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Largest number of nodes of an order that are kept.
const MOST: usize = 10_000;

/// An order with all of its updates so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Held {
    /// Order id.
    pub order_id: String,
    /// Order update id of the last update that was taken.
    pub update_id: u64,
    /// Nodes that are kept, in the order of travel.
    pub nodes: Vec<Node>,
    /// Edges: one less than nodes.
    pub edges: Vec<Edge>,
    /// Index of the last node of the base.
    pub base: usize,
    /// All other fields of the last update that was taken, as `zoneSetId`, kept unchanged.
    #[serde(default)]
    pub rest: Map<String, Value>,
}

/// The result of an update.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taken {
    /// The update was known already.
    Repeated,
    /// The nodes after this index are new.
    After(usize),
}

/// Why an order or an update is not taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Rejected {
    /// Error type of the standard.
    pub error: Error,
    /// What is wrong.
    pub refusal: Refusal,
}

impl Rejected {
    /// A rejection with this error type and reason.
    pub fn new(error: Error, field: &str, why: impl std::fmt::Display) -> Self {
        Self { error, refusal: Refusal::new(field, why) }
    }
}

impl From<Refusal> for Rejected {
    fn from(refusal: Refusal) -> Self {
        Self { error: Error::Malformed, refusal }
    }
}

impl Held {
    /// A new order.
    ///
    /// # Errors
    /// As [`Order::check`].
    pub fn new(mut order: Order) -> Result<Self, Rejected> {
        order.check()?;
        let base = order.base();
        let Order { order_id, order_update_id: update_id, nodes, edges, rest, .. } = order;
        Ok(Self { order_id, update_id, nodes, edges, base, rest })
    }

    /// Applies an update, which has to go on at the last node of the base; it replaces the horizon.
    ///
    /// # Errors
    /// [`Rejected`] if it does not go on there; nothing has changed then.
    pub fn update(&mut self, mut order: Order) -> Result<Taken, Rejected> {
        order.check()?;
        if order.order_update_id < self.update_id {
            let why = format!("{}, but {} was taken already", order.order_update_id, self.update_id);
            return Err(Rejected::new(Error::Outdated, "orderUpdateId", why));
        }
        if order.order_update_id == self.update_id {
            return Ok(Taken::Repeated);
        }
        let (Some(stitch), Some(first)) = (self.nodes.get(self.base), order.nodes.first()) else {
            return Err(Rejected::new(Error::Update, "nodes", "empty"));
        };
        if (&stitch.node_id, stitch.sequence_id) != (&first.node_id, first.sequence_id) {
            let [is, was] = [first, stitch].map(|node| format!("{} ({})", node.node_id, node.sequence_id));
            let why = format!("it begins at {is}, but the base ends at {was}");
            return Err(Rejected::new(Error::Update, "nodes[0]", why));
        }
        if self.base + order.nodes.len() > MOST {
            return Err(Rejected::new(Error::Order, "nodes", format!("more than {MOST} of one order")));
        }
        let after = self.base;
        self.base += order.base();
        self.update_id = order.order_update_id;
        self.nodes.truncate(after + 1);
        self.edges.truncate(after);
        self.nodes.extend(order.nodes.into_iter().skip(1));
        self.edges.extend(order.edges);
        self.rest = order.rest;
        Ok(Taken::After(after))
    }

    /// Drops passed nodes up to this index, but not the end of the base.
    pub fn forget(&mut self, place: usize) {
        let place = place.min(self.base);
        self.nodes.drain(..place);
        self.edges.drain(..place);
        self.base -= place;
    }

    /// Index of the node with this sequence number.
    pub fn place_of(&self, sequence_id: u64) -> Option<usize> {
        self.nodes.binary_search_by_key(&sequence_id, |node| node.sequence_id).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::super::door::{Limits, read};
    use super::*;
    use serde_json::json;

    /// Nodes of these numbers, of which so many are released.
    fn order(update: u64, names: &[(&str, u64)], released: usize) -> Order {
        let nodes: Vec<_> = (names.iter().enumerate())
            .map(|(k, (name, sequence))| json!({ "nodeId": name, "sequenceId": sequence, "released": k < released, "actions": [] }))
            .collect();
        let edges: Vec<_> = (names.windows(2).enumerate())
            .map(|(k, pair)| json!({ "edgeId": "e", "sequenceId": pair[0].1 + 1, "released": k + 1 < released, "actions": [] }))
            .collect();
        let order = json!({ "orderId": "o", "orderUpdateId": update, "nodes": nodes, "edges": edges });
        read(order.to_string().as_bytes(), Limits::default()).unwrap()
    }

    #[test]
    fn updates_are_stitched_to_the_base() {
        // The example of the standard: f, d, g are released, b and h are not.
        let mut held = Held::new(order(0, &[("f", 0), ("d", 2), ("g", 4), ("b", 6), ("h", 8)], 3)).unwrap();
        assert_eq!(held.base, 2);
        let update = order(1, &[("g", 4), ("b", 6), ("h", 8), ("i", 10)], 3);
        assert_eq!(held.update(update.clone()), Ok(Taken::After(2)));
        let names: Vec<_> = held.nodes.iter().map(|node| node.node_id.as_str()).collect();
        assert_eq!((names.concat().as_str(), held.base, held.edges.len()), ("fdgbhi", 4, 5));
        assert_eq!(held.update(update), Ok(Taken::Repeated));
        let before = held.clone();
        assert_eq!(held.update(order(0, &[("h", 8)], 1)).unwrap_err().error, Error::Outdated);
        assert_eq!(held.update(order(2, &[("g", 4), ("b", 6)], 2)).unwrap_err().error, Error::Update);
        assert_eq!(held.update(order(2, &[("h", 9), ("b", 11)], 2)).unwrap_err().error, Error::Update);
        assert_eq!(held.update(order(2, &[("h", 8), ("b", 11)], 2)).unwrap_err().error, Error::Malformed);
        assert_eq!(held, before);
        // The horizon may be another one, or none.
        assert_eq!(held.update(order(2, &[("h", 8)], 1)), Ok(Taken::After(4)));
        assert_eq!((held.nodes.len(), held.base), (5, 4));
        held.forget(3);
        assert_eq!((held.nodes[0].node_id.as_str(), held.base, held.place_of(8)), ("b", 1, Some(1)));
    }

    #[test]
    fn what_is_no_way_is_refused() {
        let refused = |order: Order| Held::new(order).unwrap_err().refusal.field;
        assert_eq!(refused(order(0, &[("a", 0), ("b", 3)], 2)), "edges[0].sequenceId");
        assert_eq!(refused(order(0, &[("a", 0), ("b", 2)], 0)), "nodes[0].released");
        let mut gap = order(0, &[("a", 0), ("b", 2), ("c", 4)], 1);
        gap.nodes[2].released = true;
        gap.edges[1].released = true;
        assert_eq!(refused(gap), "edges[1].released");
        let mut named = order(0, &[("a", 0), ("b", 2)], 2);
        named.edges[0].end_node_id = Some("c".into());
        assert_eq!(refused(named), "edges[0].endNodeId");
        let mut short = order(0, &[("a", 0), ("b", 2)], 2);
        short.edges.clear();
        assert_eq!(refused(short), "nodes");
    }
}
