//! Zones that are written: each part of an edge, and each turn in place, with all that vehicles sweep there.

use crate::convex_outline::{around, around_swept};
use crate::stretch;
use pcr_formats::import::{ImportedLayout, LayoutEdge};
use pcr_formats::scenario::{Agent, PathSegment, PlacedSegment};
use pcr_planning::exclusion_table::{EdgeTraversals, SweptShape, corridor, is_turn, placed_pieces, swept};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_PI_4;

/// Zones reach this far beyond corridors, so that rounding does not count \[m\].
const BEYOND: f64 = 1e-6;

/// Zones of arcs turn by no more than this \[rad\].
const TURN: f64 = FRAC_PI_4;

/// So much of the edge on both sides of it is in the zone of a turn in place \[m\].
const BESIDE_TURN: f64 = 1e-3;

/// The name of a zone, and its corners.
pub(super) type ZoneOutline = (String, Vec<[f64; 2]>);

/// The zones of the edges of a level, by the name of the first edge that they are of.
pub(super) fn zones(imported: &ImportedLayout, level: usize, split: Option<f64>) -> Vec<ZoneOutline> {
    let layout = &imported.layout;
    let edges = layout.edges.iter().filter(|edge| layout.is_on(edge, level));
    if imported.vehicle.footprint.is_some() {
        return outline_zones(imported, edges, split);
    }
    let radius = imported.vehicle.radius + imported.vehicle.margin;
    let mut zones: Vec<ZoneOutline> = Vec::new();
    let mut known = BTreeSet::new();
    for edge in edges {
        let parts = parts(&edge.curve, split);
        for (k, part) in parts.iter().enumerate() {
            // The way back is the same zone, and so is another edge on the same line.
            if known.insert((place(part), edge.deviation.to_bits())) {
                zones.push((
                    part_name(edge, k, parts.len()),
                    around(std::slice::from_ref(part), radius + edge.deviation + BEYOND),
                ));
            }
        }
    }
    zones
}

fn part_name(edge: &LayoutEdge, part: usize, count: usize) -> String {
    if count == 1 { edge.id.to_string() } else { format!("{} ({})", edge.id, part + 1) }
}

/// Where a part of a curve is, in steps of a micrometre: the same in both directions.
fn place(part: &PlacedSegment) -> [[i64; 2]; 3] {
    let steps = |point: [f64; 2]| point.map(|x| (x * 1e6).round() as i64);
    let middle = stretch(std::slice::from_ref(part), [part.shape.length() / 2.0; 2])[0].start;
    let [a, b] = [part.start, part.end()].map(steps);
    [a.min(b), a.max(b), steps(middle)]
}

/// The zones of what an outline sweeps: of each part of an edge in all directions in which it is travelled, and of the turns in place at
/// each point.
fn outline_zones<'e>(
    imported: &ImportedLayout,
    edges: impl Iterator<Item = &'e LayoutEdge>,
    split: Option<f64>,
) -> Vec<ZoneOutline> {
    let rides = EdgeTraversals::new(imported);
    let mut zones: Vec<(String, Vec<SweptShape>)> = Vec::new();
    let mut known: BTreeMap<[[i64; 2]; 3], usize> = BTreeMap::new();
    let mut add = |key: [[i64; 2]; 3], name: &dyn Fn() -> String, shapes: Vec<SweptShape>| {
        let zone = *known.entry(key).or_insert_with(|| {
            zones.push((name(), Vec::new()));
            zones.len() - 1
        });
        zones[zone].1.extend(shapes);
    };
    for edge in edges {
        let parts = parts(&edge.curve, split);
        for step in edge.steps() {
            let all = rides.in_direction(step);
            let along = |lengths: [f64; 2]| {
                let agents =
                    all.iter().filter(|ride| ride.turns_at().is_none()).filter_map(|ride| ride.within(lengths));
                agents.collect::<Vec<Agent>>()
            };
            let driven = |lengths: [f64; 2]| {
                let swept_by = |agent: &Agent| {
                    let driven = placed_pieces(agent).into_iter().filter(|piece| !is_turn(piece)).collect::<Vec<_>>();
                    swept(agent, &driven)
                };
                along(lengths).iter().flat_map(swept_by).collect::<Vec<SweptShape>>()
            };
            let mut before = 0.0;
            for (k, part) in parts.iter().enumerate() {
                let after = before + part.shape.length();
                add(place(part), &|| part_name(edge, k, parts.len()), driven([before, after]));
                before = after;
            }
            let name = || format!("{} (turn)", edge.id);
            let mut turn = |at: f64, point: [f64; 2], shapes: Vec<SweptShape>| {
                let point = place(&PlacedSegment::line(point, point));
                add(point, &name, shapes);
                add(point, &name, driven([at - BESIDE_TURN, at + BESIDE_TURN]));
            };
            for ride in &all {
                let pieces = placed_pieces(&ride.agent);
                if let Some(at) = ride.turns_at() {
                    turn(at, [ride.agent.start[0], ride.agent.start[1]], swept(&ride.agent, &pieces));
                    continue;
                }
                let mut travelled = 0.0;
                for piece in pieces {
                    let length = piece.shape.length();
                    if is_turn(&piece) {
                        let [lo, hi] = ride.touched_lengths([travelled, travelled + length]);
                        turn((lo + hi) / 2.0, piece.start, swept(&ride.agent, &[piece]));
                    }
                    travelled += length;
                }
            }
        }
    }
    let around = |(name, shapes): (String, Vec<SweptShape>)| (name, around_swept(&shapes, BEYOND));
    zones.into_iter().map(around).collect()
}

/// Gives zones of one name different ones.
pub(super) fn distinguish(zones: &mut [ZoneOutline]) {
    let mut taken = BTreeSet::new();
    for (name, _) in zones {
        let given = name.clone();
        let mut count = 1;
        while !taken.insert(name.clone()) {
            count += 1;
            *name = format!("{given} [{count}]");
        }
    }
}

/// Zones of nodes at which no edge ends: a vehicle there is on no corridor.
pub(super) fn lone_nodes(imported: &ImportedLayout, level: usize) -> Vec<ZoneOutline> {
    let layout = &imported.layout;
    let used: BTreeSet<usize> =
        layout.edges.iter().filter(|edge| !edge.curve.is_empty()).flat_map(|edge| edge.ends).collect();
    let rides = EdgeTraversals::new(imported);
    let lone = layout.nodes.iter().enumerate().filter(|(k, node)| node.level == level && !used.contains(k));
    let zone = |node: usize| around_swept(&corridor(&[rides.at_node(node)]), BEYOND);
    lone.map(|(k, node)| (format!("node {}", node.id), zone(k))).collect()
}

/// Lines and arcs, cut into equal parts no longer than asked for and that turn no farther than [`TURN`].
fn parts(curve: &[PlacedSegment], split: Option<f64>) -> Vec<PlacedSegment> {
    let mut parts = Vec::new();
    for piece in curve {
        let length = piece.shape.length();
        let by_length = split.map_or(1.0, |most| (length / most - 1e-9).ceil());
        let by_turn = match piece.shape {
            PathSegment::Arc { sweep, .. } => (sweep.abs() / TURN - 1e-9).ceil(),
            _ => 1.0,
        };
        let count = by_length.max(by_turn).max(1.0);
        for k in 0..count as usize {
            let range = [k, k + 1].map(|k| length * k as f64 / count);
            parts.extend(stretch(std::slice::from_ref(piece), range));
        }
    }
    parts
}
