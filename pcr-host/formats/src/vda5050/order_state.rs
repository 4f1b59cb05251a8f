//! An order as its receiver keeps it. Updates are stitched to the end of its base, as the standard says: the base itself cannot be
//! changed. The importer, the supervisor and simulated vehicles decide by this, and with these words.

use super::decode::DecodeError;
use super::messages::Action;
use super::order::{Order, OrderEdge, OrderNode};
use super::state::{ErrorEntry, ORDER};
use super::version::{OrderRejection, ProtocolVersion};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Largest number of nodes of an order that are kept.
const MOST: usize = 10_000;

/// Largest distance between the end of the base and the first node of an update, which are one node, so that the difference is
/// rounding \[m\].
const SAME_PLACE: f64 = 1e-3;

/// An order with all of its updates so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OrderState {
    /// Order id.
    pub order_id: String,
    /// Order update id of the last update that was taken.
    pub update_id: u64,
    /// Nodes that are kept, in the order of travel.
    pub nodes: Vec<OrderNode>,
    /// Edges: one less than nodes.
    pub edges: Vec<OrderEdge>,
    /// Index of the last node of the base.
    pub base: usize,
    /// Sequence number of the first node of the last update that was taken; `None` in journals of earlier versions.
    #[serde(default)]
    begins: Option<u64>,
    /// All other fields of the last update that was taken, as `zoneSetId`, kept unchanged.
    #[serde(default)]
    pub rest: Map<String, Value>,
}

/// The result of an update.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpdateResult {
    /// The update was known already.
    Repeated,
    /// The nodes after this index are new.
    After(usize),
}

/// Why an order or an update is not taken.
#[derive(Clone, Debug, PartialEq)]
pub struct RejectedOrder {
    /// Error type of the standard.
    pub error: OrderRejection,
    /// What is wrong.
    pub refusal: DecodeError,
}

impl RejectedOrder {
    /// A rejection with this error type and reason.
    pub fn new(error: OrderRejection, field: &str, why: impl std::fmt::Display) -> Self {
        Self { error, refusal: DecodeError::new(field, why) }
    }

    /// The error by which a receiver reports it; with references if the message said which order and update it is.
    pub fn report(&self, version: ProtocolVersion, order: &str, update: u64) -> ErrorEntry {
        let update = update.to_string();
        let mut references = vec![(ORDER, order), ("orderUpdateId", update.as_str())];
        references.retain(|_| !order.is_empty());
        ErrorEntry::warning(version.error(self.error), self.refusal.to_string(), &references)
    }
}

impl From<DecodeError> for RejectedOrder {
    fn from(refusal: DecodeError) -> Self {
        Self { error: OrderRejection::Malformed, refusal }
    }
}

impl OrderState {
    /// A new order, for a vehicle that has none.
    ///
    /// # Errors
    /// As [`Order::check`]; and since edition 3.0 the number of a new order has to be 0.
    pub fn new(order: Order) -> Result<Self, RejectedOrder> {
        let (update, is_third) =
            (order.order_update_id, ProtocolVersion::parse(&order.header.version) == Some(ProtocolVersion::V3_0));
        let state = Self::recorded(order)?;
        if is_third && update > 0 {
            let why = format!("{update} of an order that the vehicle does not have; a new order has 0");
            return Err(RejectedOrder::new(OrderRejection::Order, "orderUpdateId", why));
        }
        Ok(state)
    }

    /// An order of which the first messages may not have been recorded.
    ///
    /// # Errors
    /// As [`Order::check`].
    pub fn recorded(mut order: Order) -> Result<Self, RejectedOrder> {
        order.check()?;
        let base = order.base();
        let Order { order_id, order_update_id: update_id, nodes, edges, rest, .. } = order;
        let begins = nodes.first().map(|node| node.sequence_id);
        Ok(Self { order_id, update_id, nodes, edges, base, begins, rest })
    }

    /// Applies an update, which has to go on at the last node of the base; it replaces the horizon. An update that was taken already is
    /// recognized by its number.
    ///
    /// # Errors
    /// [`RejectedOrder`] if its number is lower than that of the last one, if it has the number of the last one and says something else, or if
    /// it does not go on at the end of the base: at the same node, with the same sequence number, at the same place, without further actions.
    /// Nothing has changed then.
    pub fn update(&mut self, mut order: Order) -> Result<UpdateResult, RejectedOrder> {
        order.check()?;
        if order.order_update_id < self.update_id {
            let why = format!("{}, but {} was taken already", order.order_update_id, self.update_id);
            return Err(RejectedOrder::new(OrderRejection::Outdated, "orderUpdateId", why));
        }
        if order.order_update_id == self.update_id {
            let why = format!("{} was taken already, with another content", self.update_id);
            let other = || RejectedOrder::new(OrderRejection::SameUpdate, "orderUpdateId", why);
            return self.has(&order).then_some(UpdateResult::Repeated).ok_or_else(other);
        }
        let (Some(stitch), Some(first)) = (self.nodes.get(self.base), order.nodes.first()) else {
            return Err(RejectedOrder::new(OrderRejection::Update, "nodes", "empty"));
        };
        if (&stitch.node_id, stitch.sequence_id) != (&first.node_id, first.sequence_id) {
            let [is, was] = [first, stitch].map(|node| format!("{} ({})", node.node_id, node.sequence_id));
            let why = format!("it begins at {is}, but the base ends at {was} and cannot be changed");
            return Err(RejectedOrder::new(OrderRejection::Update, "nodes[0]", why));
        }
        if let Some(why) = moved(stitch, first) {
            return Err(RejectedOrder::new(OrderRejection::Update, "nodes[0].nodePosition", why));
        }
        let is_known = |action: &&Action| stitch.actions.iter().any(|own| own.action_id == action.action_id);
        if let Some(more) = first.actions.iter().find(|action| !is_known(action)) {
            let why = format!(
                "node {} was released without action {}; an action that is added belongs to a further node, which may be at the same place",
                first.node_id, more.action_id
            );
            return Err(RejectedOrder::new(OrderRejection::Update, "nodes[0].actions", why));
        }
        if self.base + order.nodes.len() > MOST {
            return Err(RejectedOrder::new(OrderRejection::Order, "nodes", format!("more than {MOST} of one order")));
        }
        let after = self.base;
        self.begins = Some(first.sequence_id);
        self.base += order.base();
        self.update_id = order.order_update_id;
        self.nodes.truncate(after + 1);
        self.edges.truncate(after);
        self.nodes.extend(order.nodes.into_iter().skip(1));
        self.edges.extend(order.edges);
        self.rest = order.rest;
        Ok(UpdateResult::After(after))
    }

    /// Whether an order, which has been checked, says what the last update said. What was passed and dropped is not compared.
    fn has(&self, order: &Order) -> bool {
        let begins = order.nodes.first().map(|node| node.sequence_id);
        if self.begins.is_some() && self.begins != begins || self.rest != order.rest {
            return false;
        }
        let first = self.nodes.first().map_or(0, |node| node.sequence_id);
        let since = |sequence: u64| sequence >= first && begins.is_some_and(|begins| sequence >= begins);
        let nodes = order.nodes.iter().filter(|node| since(node.sequence_id));
        let edges = order.edges.iter().filter(|edge| since(edge.sequence_id));
        let mut pairs = self.nodes.iter().filter(|node| since(node.sequence_id)).zip(nodes).enumerate();
        // Of the first node of an update, that of the base is kept.
        let same = |(k, (own, other)): (usize, (&OrderNode, &OrderNode))| {
            if k == 0 { is_node(own, other) } else { own == other }
        };
        self.nodes.last().map(|node| node.sequence_id) == order.nodes.last().map(|node| node.sequence_id)
            && pairs.all(same)
            && self.edges.iter().filter(|edge| since(edge.sequence_id)).eq(edges)
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

/// Whether the first node of an update is this one.
fn is_node(stitch: &OrderNode, first: &OrderNode) -> bool {
    (&stitch.node_id, stitch.sequence_id) == (&first.node_id, first.sequence_id) && moved(stitch, first).is_none()
}

/// Says how far the first node of an update is from the end of the base, if it is elsewhere. A node without a position is where it was.
fn moved(stitch: &OrderNode, first: &OrderNode) -> Option<String> {
    let (was, is) = stitch.node_position.as_ref().zip(first.node_position.as_ref())?;
    if was.map_id != is.map_id {
        return Some(format!("node {} is on map {}, but it was on map {}", first.node_id, is.map_id, was.map_id));
    }
    let apart = (is.x - was.x).hypot(is.y - was.y);
    (apart > SAME_PLACE).then(|| format!("node {} is {apart:.3} m from where it was", first.node_id))
}

#[cfg(test)]
mod tests {
    use super::super::decode::{MessageLimits, read};
    use super::super::order::NodePosition;
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
        read(order.to_string().as_bytes(), MessageLimits::default()).unwrap()
    }

    #[test]
    fn updates_are_stitched_to_the_base() {
        // The example of the standard: f, d, g are released, b and h are not.
        let mut held = OrderState::new(order(0, &[("f", 0), ("d", 2), ("g", 4), ("b", 6), ("h", 8)], 3)).unwrap();
        assert_eq!(held.base, 2);
        let update = order(1, &[("g", 4), ("b", 6), ("h", 8), ("i", 10)], 3);
        assert_eq!(held.update(update.clone()), Ok(UpdateResult::After(2)));
        let names: Vec<_> = held.nodes.iter().map(|node| node.node_id.as_str()).collect();
        assert_eq!((names.concat().as_str(), held.base, held.edges.len()), ("fdgbhi", 4, 5));
        assert_eq!(held.update(update), Ok(UpdateResult::Repeated));
        let before = held.clone();
        assert_eq!(held.update(order(0, &[("h", 8)], 1)).unwrap_err().error, OrderRejection::Outdated);
        assert_eq!(held.update(order(2, &[("g", 4), ("b", 6)], 2)).unwrap_err().error, OrderRejection::Update);
        assert_eq!(held.update(order(2, &[("h", 9), ("b", 11)], 2)).unwrap_err().error, OrderRejection::Update);
        assert_eq!(held.update(order(2, &[("h", 8), ("b", 11)], 2)).unwrap_err().error, OrderRejection::Malformed);
        assert_eq!(held, before);
        // The horizon may be another one, or none.
        assert_eq!(held.update(order(2, &[("h", 8)], 1)), Ok(UpdateResult::After(4)));
        assert_eq!((held.nodes.len(), held.base), (5, 4));
        held.forget(3);
        assert_eq!((held.nodes[0].node_id.as_str(), held.base, held.place_of(8)), ("b", 1, Some(1)));
    }

    #[test]
    fn the_number_of_an_update_is_taken_once() {
        let mut held = OrderState::new(order(0, &[("a", 0), ("b", 2), ("c", 4)], 2)).unwrap();
        assert_eq!(held.update(order(0, &[("a", 0), ("b", 2), ("c", 4)], 2)), Ok(UpdateResult::Repeated));
        for other in [
            order(0, &[("a", 0), ("b", 2), ("c", 4)], 3),
            order(0, &[("a", 0), ("b", 2), ("d", 4)], 2),
            order(0, &[("a", 0), ("b", 2)], 2),
            order(0, &[("a", 0), ("b", 2), ("c", 4), ("d", 6)], 2),
        ] {
            let rejected = held.update(other).unwrap_err();
            assert_eq!(
                (rejected.error, rejected.refusal.field.as_str()),
                (OrderRejection::SameUpdate, "orderUpdateId")
            );
        }
        let update = order(1, &[("b", 2), ("c", 4), ("d", 6)], 3);
        assert_eq!(held.update(update.clone()), Ok(UpdateResult::After(1)));
        assert_eq!(held.update(update.clone()), Ok(UpdateResult::Repeated));
        // What was passed is not known any more.
        held.forget(2);
        assert_eq!(held.update(update), Ok(UpdateResult::Repeated));
        assert!(held.update(order(1, &[("b", 2), ("c", 4), ("e", 6)], 3)).is_err());
        // A part of it is something else, and so is what says more of a node or of the order.
        assert!(held.update(order(1, &[("c", 4), ("d", 6)], 2)).is_err());
        let mut turned = order(1, &[("b", 2), ("c", 4), ("d", 6)], 3);
        turned.nodes[2].extra.insert("nodeDescription".into(), "dock".into());
        assert!(held.update(turned).is_err());
        let mut zoned = order(1, &[("b", 2), ("c", 4), ("d", 6)], 3);
        zoned.rest.insert("zoneSetId".into(), "other".into());
        assert!(held.update(zoned).is_err());
    }

    /// Since 3.0; a record may begin later.
    #[test]
    fn a_new_order_has_the_number_0() {
        for (version, is_taken) in [("", true), ("2.1.0", true), ("3.0.0", false)] {
            let mut late = order(3, &[("a", 0), ("b", 2)], 2);
            late.header.version = version.into();
            assert_eq!(OrderState::new(late.clone()).is_ok(), is_taken);
            assert!(OrderState::recorded(late).is_ok());
        }
    }

    #[test]
    fn the_first_node_of_an_update_is_where_the_base_ends() {
        let at = |mut order: Order, k: usize, x: f64, map: &str| {
            order.nodes[k].node_position = Some(NodePosition { x, y: 1.0, map_id: map.into(), rest: Map::new() });
            order
        };
        let first = at(order(0, &[("a", 0), ("b", 2)], 2), 1, 5.0, "m");
        let update = || order(1, &[("b", 2), ("c", 4)], 2);
        for (x, map, why) in [
            (5.0, "m", None),
            (5.0005, "m", None),
            (5.01, "m", Some("node b is 0.010 m from where it was")),
            (5.0, "n", Some("node b is on map n, but it was on map m")),
        ] {
            let taken = OrderState::new(first.clone()).unwrap().update(at(update(), 0, x, map));
            let refused = taken.err().map(|rejected| (rejected.error, rejected.refusal.why));
            assert_eq!(refused, why.map(|why| (OrderRejection::Update, why.to_owned())));
        }
        assert!(OrderState::new(first).unwrap().update(update()).is_ok());
    }

    /// It would never have been carried out, and nobody would have said so.
    #[test]
    fn a_node_that_was_released_gets_no_further_actions() {
        let with = |mut order: Order, k: usize, ids: &[&str]| {
            let action = |id: &&str| json!({ "actionType": "pick", "actionId": id, "blockingType": "HARD" });
            let actions = serde_json::from_value(ids.iter().map(action).collect::<Vec<_>>().into());
            order.nodes[k].actions = actions.unwrap();
            order
        };
        let first = with(order(0, &[("a", 0), ("b", 2)], 2), 1, &["1"]);
        let update = |ids: &[&str]| {
            let update = with(order(1, &[("b", 2), ("b", 4)], 2), 1, &["2"]);
            OrderState::new(first.clone()).unwrap().update(with(update, 0, ids))
        };
        assert_eq!(update(&["1"]), Ok(UpdateResult::After(1)));
        assert_eq!(update(&[]), Ok(UpdateResult::After(1)), "what it has done need not be named again");
        let refused = update(&["1", "2"]).unwrap_err();
        assert_eq!((refused.error, refused.refusal.field.as_str()), (OrderRejection::Update, "nodes[0].actions"));
    }

    #[test]
    fn what_is_no_way_is_refused() {
        let refused = |order: Order| OrderState::new(order).unwrap_err().refusal.field;
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
