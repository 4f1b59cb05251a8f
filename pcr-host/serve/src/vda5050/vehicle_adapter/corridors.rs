//! Corridors of edges, in which a vehicle might leave its way. Others keep clear of the vehicle on its way only, so it does not get the corridors,
//! and the manager is told.

use super::ActiveOrder;
use pcr_formats::vda5050::state::ErrorEntry;

/// Most edges that are named.
const NAMED: usize = 10;

impl ActiveOrder {
    /// An error about the corridors ahead of a node.
    pub(super) fn corridors_ahead(&self, node: usize) -> Option<ErrorEntry> {
        let mut all = self.order.edges.iter().skip(node).filter(|edge| edge.has_corridor());
        let named: Vec<&str> = all.by_ref().take(NAMED).map(|edge| edge.edge_id.as_str()).collect();
        if named.is_empty() {
            return None;
        }
        let more = match all.count() {
            0 => String::new(),
            more => format!(" and {more} others"),
        };
        let why = format!(
            "the vehicle does not get the corridors of the edges {}{more}: it keeps to their lines, because only there others keep clear of it",
            named.join(", ")
        );
        let references: Vec<(&str, &str)> = named.iter().map(|edge| ("edgeId", *edge)).collect();
        Some(ErrorEntry::warning("corridorRemoved", why, &references))
    }
}
