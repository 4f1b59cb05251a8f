//! The part of an order that the vehicle has passed is left out, so that an order that is extended for hours stays short: each update
//! writes all of it to the journal.

use super::super::order_path::OrderPath;
use super::job::{ActiveOrder, ReleasePoint, SentUpdate};
use pcr_formats::vda5050::state::State;

/// Number of passed stops that are kept: late states name them.
const KEPT: usize = 50;

impl ActiveOrder {
    /// The order from a node on that the vehicle has passed long ago; `None` if that is not worth it.
    pub(super) fn trimmed(&self, state: &State) -> Option<Self> {
        let sent = self.sent.filter(|_| self.is_confirmed() && state.order_id == self.order.order_id)?;
        let first = self.passed(state)?.checked_sub(KEPT)?.min(sent.from);
        let first = (0..=first).rev().find(|&place| self.stops.get(place).is_some_and(|stop| !stop.between))?;
        let node = self.stops.get(first)?.node.min(self.order.base);
        if node < KEPT {
            return None;
        }
        let (from, start) = (self.path.node(node)?, self.path.arrival(node)?);
        let mut job = self.clone();
        job.order.forget(node);
        job.path = OrderPath::new(start, &job.order, self.path.spread()).ok()?;
        job.requested_node = job.requested_node.checked_sub(node)?;
        job.sent = Some(SentUpdate { from: sent.from.checked_sub(first)?, ..sent });
        let moved = |stop: &ReleasePoint| {
            Some(ReleasePoint { length: stop.length - from, node: stop.node.checked_sub(node)?, ..*stop })
        };
        job.stops = self.stops.iter().skip(first).map(moved).collect::<Option<_>>()?;
        // The vehicle knows stops by their names, which contain lengths: by rounding another one may have come out.
        let names = |job: &Self| job.stops.iter().rev().map(|stop| job.id(*stop)).collect::<Vec<_>>();
        let (own, before) = (names(&job), names(self));
        before.starts_with(&own).then_some(job)
    }
}
