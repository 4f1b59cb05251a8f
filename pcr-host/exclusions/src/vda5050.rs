//! Zone sets of VDA 5050 (3.0): RELEASE zones, each granted to one vehicle at a time.
//!
//! If two vehicles touch, some point is in the contours of both. A vehicle needs a RELEASE zone as soon as any part of
//! its contour enters it. Hence any zones that cover all corridors keep vehicles apart. Here each line or arc of an
//! edge is a zone, or each part of it if it is cut; both directions of one way share a zone. Vehicles do not enter a
//! `BLOCKED` zone at all.

use crate::outline::{around, distance};
use crate::settings::{Notes, Settings};
use crate::{Claim, Group, Mark, Rules, Way, stretch};
use pcr_formats::import::{ImportError, Imported, Layout};
use pcr_formats::scenario::PathSegment;
use pcr_formats::scenario::Placed;
use pcr_planning::checksum::crc32;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::f64::consts::FRAC_PI_4;

/// Zones reach this far beyond corridors, so that rounding does not count \[m\].
const BEYOND: f64 = 1e-6;

/// Zones of arcs turn by no more than this \[rad\].
const TURN: f64 = FRAC_PI_4;

/// Lengths of edges within which the zones are the same, as a share of the radius.
const STEP: f64 = 0.125;

/// Whether a text holds zone sets.
pub(crate) fn is_zones(text: &str) -> bool {
    let value: Option<Value> = serde_json::from_str(text.trim_start_matches('\u{feff}')).ok();
    value.is_some_and(|value| messages(&value).iter().any(|message| !message["zoneSet"]["zones"].is_null()))
}

/// One message, or a list of them.
fn messages(value: &Value) -> Vec<&Value> {
    match value {
        Value::Array(list) => list.iter().collect(),
        one => vec![one],
    }
}

/// The map of a level.
fn map(layout: &Layout, level: usize) -> &str {
    match layout.levels.get(level).map_or("", String::as_str) {
        "" if layout.name.is_empty() => "map",
        "" => &layout.name,
        name => name,
    }
}

struct Zone {
    map: String,
    blocked: bool,
    polygon: Vec<[f64; 2]>,
    token: usize,
}

/// Reads the zones.
pub(crate) fn read(text: &str, imported: &Imported) -> Result<Rules, ImportError> {
    let root: Value = serde_json::from_str(text.trim_start_matches('\u{feff}'))
        .map_err(|error| ImportError::new(format!("not JSON: {error}")))?;
    let layout = &imported.layout;
    let maps: BTreeSet<&str> = (0..layout.levels.len()).map(|level| map(layout, level)).collect();
    let (mut zones, mut groups, mut warnings) = (Vec::new(), Vec::new(), Vec::new());
    for message in messages(&root) {
        let set = &message["zoneSet"];
        let id = set["mapId"].as_str().ok_or_else(|| ImportError::new("zoneSet, mapId: missing"))?;
        if !maps.contains(id) {
            return Err(ImportError::new(format!("zoneSet, mapId: the layout has no map {id}")));
        }
        for zone in set["zones"].as_array().into_iter().flatten() {
            let name = zone["zoneId"].as_str().unwrap_or_default();
            let problem = |what: &str| ImportError::new(format!("zone {name}, {what}"));
            let kind = zone["zoneType"].as_str().ok_or_else(|| problem("zoneType: missing"))?;
            if kind != "RELEASE" && kind != "BLOCKED" {
                warnings.push(format!("zone {name}: {kind} keeps no vehicles apart"));
                continue;
            }
            let corner = |vertex: &Value| Some([vertex["x"].as_f64()?, vertex["y"].as_f64()?]);
            let corners = zone["vertices"].as_array().into_iter().flatten().map(corner).collect::<Option<Vec<_>>>();
            let polygon = corners.filter(|corners| corners.len() >= 3);
            let polygon = polygon.ok_or_else(|| problem("vertices: three or more are expected"))?;
            let token = groups.len();
            let level = (0..layout.levels.len()).find(|&level| map(layout, level) == id).unwrap_or_default();
            groups.push(Group { name: name.to_owned(), outline: polygon.clone(), level, ..Group::default() });
            zones.push(Zone { map: id.to_owned(), blocked: kind == "BLOCKED", polygon, token });
        }
    }
    let radius = imported.vehicle.radius + imported.vehicle.margin;
    let claim = |levels: &[usize], at: [f64; 2], reach: f64| {
        let near = zones.iter().filter(|zone| {
            levels.iter().any(|&level| map(layout, level) == zone.map) && distance(&zone.polygon, at) <= reach
        });
        let (blocked, free): (Vec<&Zone>, Vec<&Zone>) = near.partition(|zone| zone.blocked);
        let tokens = free.iter().map(|zone| zone.token).collect();
        Claim { closed: !blocked.is_empty(), ..Claim::exclusive(tokens) }
    };
    let edges = layout.edges.iter().map(|edge| {
        let levels: Vec<usize> =
            edge.ends.iter().filter_map(|&end| layout.nodes.get(end).map(|node| node.level)).collect();
        let reach = radius + edge.deviation;
        let length = edge.length();
        let count = (length / (STEP * radius)).ceil().max(1.0);
        let (mut marks, mut closed): (Vec<Mark>, Vec<[f64; 2]>) = (Vec::new(), Vec::new());
        // What the mark of a token, of takes and of bars, ends with goes on if the token is there in the next step.
        let mut last: HashMap<(usize, bool), usize> = HashMap::new();
        for k in 0..count as usize {
            // The last one ends where the edge does, and not a digit before.
            let [from, to] = [k, k + 1].map(|k| if k as f64 == count { length } else { length * k as f64 / count });
            let at = stretch(&edge.curve, [(from + to) / 2.0; 2]);
            let at = at.first().map_or(layout.nodes[edge.ends[0]].at, |piece| piece.at);
            let claim = claim(&levels, at, reach + (to - from) / 2.0);
            for (tokens, bars) in [(&claim.takes, false), (&claim.bars, true)] {
                for &token in tokens {
                    match last.get(&(token, bars)).and_then(|&place| marks.get_mut(place)) {
                        Some(mark) if mark.range[1] == from => mark.range[1] = to,
                        _ => {
                            last.insert((token, bars), marks.len());
                            marks.push(Mark { token, bars, range: [from, to] });
                        }
                    }
                }
            }
            match closed.last_mut().filter(|last| last[1] == from) {
                Some(last) if claim.closed => last[1] = to,
                _ if claim.closed => closed.push([from, to]),
                _ => {}
            }
        }
        Way::both(length, marks, closed)
    });
    let edges: Vec<[Way; 2]> = edges.collect();
    let nodes = layout.nodes.iter().map(|node| claim(&[node.level], node.at, radius)).collect();
    let mut members: BTreeMap<usize, BTreeSet<String>> = BTreeMap::new();
    for (edge, ways) in layout.edges.iter().zip(&edges) {
        for mark in ways[0].marks().iter().filter(|mark| !mark.bars) {
            members.entry(mark.token).or_default().insert(edge.id.to_string());
        }
    }
    for (token, edges) in members {
        groups[token].edges = edges.into_iter().collect();
    }
    Ok(Rules { edges, nodes, groups, warnings })
}

/// Writes the zone set of each map: one message, or a list of them.
pub(crate) fn write(imported: &Imported, settings: &Settings, notes: &mut Notes) -> String {
    let layout = &imported.layout;
    let mut messages = Vec::new();
    for level in 0..layout.levels.len() {
        let mut zones = zones(imported, level, settings.split);
        zones.extend(lone_nodes(imported, level));
        distinguish(&mut zones);
        notes.groups += zones.len();
        let zones: Vec<Value> = zones
            .into_iter()
            .map(|(name, corners)| {
                let vertices: Vec<Value> = corners.iter().map(|[x, y]| json!({ "x": x, "y": y })).collect();
                json!({ "zoneId": name, "zoneType": "RELEASE", "vertices": vertices, "releaseLossBehavior": "STOP" })
            })
            .collect();
        let map = map(layout, level);
        // Other zones are another set: vehicles know sets by their names.
        let zones = Value::Array(zones);
        let sum = crc32(zones.to_string().as_bytes());
        let set = json!({ "mapId": map, "zoneSetId": format!("{map}-pcr-{sum:08x}"), "zones": zones });
        messages.push(json!({
            "headerId": 0, "timestamp": "1970-01-01T00:00:00.000Z", "version": "3.0.0", "manufacturer": "", "serialNumber": "",
            "zoneSet": set
        }));
    }
    let all = if messages.len() == 1 { messages.remove(0) } else { Value::Array(messages) };
    // Writing to a string does not fail.
    serde_json::to_string_pretty(&all).unwrap_or_default() + "\n"
}

type Outline = (String, Vec<[f64; 2]>);

/// The zones of the edges of a level, by the name of the first edge that they are of.
fn zones(imported: &Imported, level: usize, split: Option<f64>) -> Vec<Outline> {
    let layout = &imported.layout;
    let radius = imported.vehicle.radius + imported.vehicle.margin;
    let mut zones: Vec<Outline> = Vec::new();
    let mut known = BTreeSet::new();
    for edge in layout.edges.iter().filter(|edge| layout.is_on(edge, level)) {
        let parts = parts(&edge.curve, split);
        for (k, part) in parts.iter().enumerate() {
            // The way back is the same zone, and so is another edge on the same line.
            let steps = |point: [f64; 2]| point.map(|x| (x * 1e6).round() as i64);
            let middle = stretch(std::slice::from_ref(part), [part.shape.length() / 2.0; 2])[0].at;
            let mut ends = [steps(part.at), steps(part.end())];
            ends.sort_unstable();
            if known.insert((ends, steps(middle), edge.deviation.to_bits())) {
                let name = if parts.len() == 1 { edge.id.to_string() } else { format!("{} ({})", edge.id, k + 1) };
                zones.push((name, around(std::slice::from_ref(part), radius + edge.deviation + BEYOND)));
            }
        }
    }
    zones
}

/// Gives zones of one name different ones.
fn distinguish(zones: &mut [Outline]) {
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
fn lone_nodes(imported: &Imported, level: usize) -> Vec<Outline> {
    let layout = &imported.layout;
    let used: BTreeSet<usize> =
        layout.edges.iter().filter(|edge| !edge.curve.is_empty()).flat_map(|edge| edge.ends).collect();
    let radius = imported.vehicle.radius + imported.vehicle.margin;
    let lone = layout.nodes.iter().enumerate().filter(|(k, node)| node.level == level && !used.contains(k));
    lone.map(|(_, node)| (format!("node {}", node.id), around(&[Placed::line(node.at, node.at)], radius + BEYOND)))
        .collect()
}

/// Lines and arcs, cut into equal parts no longer than asked for and that turn no farther than [`TURN`].
fn parts(curve: &[Placed], split: Option<f64>) -> Vec<Placed> {
    let mut parts = Vec::new();
    for piece in curve {
        let length = piece.shape.length();
        let by_length = split.map_or(1.0, |most| (length / most - 1e-9).ceil());
        let by_turn = match piece.shape {
            PathSegment::Line { .. } => 1.0,
            PathSegment::Arc { sweep, .. } => (sweep.abs() / TURN - 1e-9).ceil(),
        };
        let count = by_length.max(by_turn).max(1.0);
        for k in 0..count as usize {
            let range = [k, k + 1].map(|k| length * k as f64 / count);
            parts.extend(stretch(std::slice::from_ref(piece), range));
        }
    }
    parts
}
