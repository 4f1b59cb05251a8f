//! A checksum of the layout and the vehicle of a table of locks, which shows whether the table is out of date.

use crate::checksum::crc32;
use pcr_formats::import::ImportedLayout;
use std::fmt::Debug;

/// The checksum of all that locks depend on: names, places and levels of nodes; curves, ends and directions of edges, and whether they are
/// closed; and the vehicle. Speeds do not count.
pub fn origin(imported: &ImportedLayout) -> u32 {
    let (layout, vehicle) = (&imported.layout, &imported.vehicle);
    let mut sum = 0;
    let mut add = |part: &dyn Debug| sum = crc32(format!("{sum} {part:?}").as_bytes());
    add(&(vehicle.radius, vehicle.margin, &vehicle.footprint, layout.nodes.len(), layout.edges.len()));
    layout.nodes.iter().for_each(|node| add(&(&node.id, node.level, node.point)));
    let edges = layout.edges.iter();
    edges.for_each(|edge| {
        let facing = vehicle.footprint.as_ref().map(|_| edge.facing);
        add(&(&edge.id, edge.ends, &edge.curve, edge.ways, edge.closed, edge.position_error(vehicle), facing));
    });
    sum
}
