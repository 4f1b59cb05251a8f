//! Zone sets of VDA 5050 (3.0): RELEASE zones, each granted to one vehicle at a time.
//!
//! If two vehicles touch, some point is in the contours of both. A vehicle needs a RELEASE zone as soon as any part of
//! its contour enters it. Hence any zones that cover all corridors keep vehicles apart. Here each line or arc of an
//! edge is a zone, or each part of it if it is cut; both directions of one way share a zone. Vehicles do not enter a
//! `BLOCKED` zone at all.
//!
//! When a file is read, a vehicle somewhere on an edge has a zone only if it is sure to need it, however far it is off
//! the edge. That keeps off others who are sure to need it, too. Besides, one whose contour lies in the zone as a whole
//! is kept off by whoever can reach into the zone at all: where they touch, both are in it. By the second rule the
//! zones that are written here suffice, whatever the deviations and the outlines.

mod written_zones;
mod zone_presence;

use crate::options::{WriteNotes, WriteOptions};
use crate::stamp::VehicleStamp;
use crate::{DirectedEdgeRules, ExclusionGroup, ExclusionRules, ResourceClaim, TokenSpan};
use pcr_formats::import::{ImportError, ImportedLayout, Layout, LayoutEdge, RouteStep, parse_json};
use pcr_formats::plane_geometry::hull;
use pcr_formats::scenario::{LIMIT, PlacedSegment};
use pcr_formats::warning::WarningCode;
use pcr_planning::checksum::crc32;
use pcr_planning::exclusion_table::EdgeTraversals;
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use written_zones::{distinguish, lone_nodes, zones};
use zone_presence::{OutlinePresence, OutlineRadii, ReleaseZone, ZoneIntervals, both, bounds};

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

/// The map of a level: the name of the level, else that of the layout.
fn map(layout: &Layout, level: usize) -> &str {
    match layout.levels.get(level).map_or("", String::as_str) {
        "" if layout.name.is_empty() => "map",
        "" => &layout.name,
        name => name,
    }
}

/// Why a field of a zone set cannot be read.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ZoneFieldError {
    /// It is missing.
    Missing(&'static str),
    /// It is no text.
    NoText(&'static str),
    /// It is no list.
    NoList(&'static str),
    /// A zone has fewer than three corners.
    FewCorners,
    /// A corner has a coordinate that is out of range \[m\].
    OutOfRange(f64),
    /// All corners are on one line.
    NoArea,
}

impl fmt::Display for ZoneFieldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing(field) => write!(f, "{field}: missing"),
            Self::NoText(field) => write!(f, "{field}: a text is expected"),
            Self::NoList(field) => write!(f, "{field}: a list is expected"),
            Self::FewCorners => f.write_str("vertices: three or more are expected"),
            Self::OutOfRange(far) => write!(f, "vertices: {far:e} is out of range; allowed is up to {LIMIT:e}"),
            Self::NoArea => f.write_str("vertices: they are on one line"),
        }
    }
}

/// The corners of a zone.
fn polygon(vertices: &Value) -> Result<Vec<[f64; 2]>, ZoneFieldError> {
    let corner = |vertex: &Value| Some([vertex["x"].as_f64()?, vertex["y"].as_f64()?]);
    let corners = vertices.as_array().into_iter().flatten().map(corner).collect::<Option<Vec<_>>>();
    let polygon = corners.filter(|corners| corners.len() >= 3).ok_or(ZoneFieldError::FewCorners)?;
    if let Some(&far) = polygon.iter().flatten().find(|x| x.abs() > LIMIT) {
        return Err(ZoneFieldError::OutOfRange(far));
    }
    // No vehicle is in a zone that is a line, and what only touches it need not ask for it.
    if !is_area(&polygon) {
        return Err(ZoneFieldError::NoArea);
    }
    Ok(polygon)
}

/// Whether the hull of points is wider than the rounding of their coordinates.
fn is_area(points: &[[f64; 2]]) -> bool {
    let hull = hull(points.to_vec());
    let [lo, hi] = bounds(points);
    let (long, far) =
        ((hi[0] - lo[0]).hypot(hi[1] - lo[1]), points.iter().flatten().fold(0.0, |far: f64, x| far.max(x.abs())));
    let corners = hull.iter().zip(hull.iter().skip(1).chain(hull.first()));
    let twice: f64 = corners.map(|([x, y], [u, v])| (x - lo[0]) * (v - lo[1]) - (u - lo[0]) * (y - lo[1])).sum();
    twice > 64.0 * f64::EPSILON * far * long
}

/// A field that has to be there, as a text.
fn text_of<'j>(object: &'j Value, field: &'static str) -> Result<&'j str, ZoneFieldError> {
    match &object[field] {
        Value::String(text) => Ok(text),
        Value::Null => Err(ZoneFieldError::Missing(field)),
        _ => Err(ZoneFieldError::NoText(field)),
    }
}

/// The zones of all messages with their groups, and warnings of zones that are none of these.
type ZoneSet = (Vec<ReleaseZone>, Vec<ExclusionGroup>, Vec<String>);

fn zones_of(root: &Value, layout: &Layout) -> Result<ZoneSet, ImportError> {
    let mut maps: BTreeMap<&str, usize> = BTreeMap::new();
    for level in 0..layout.levels.len() {
        maps.entry(map(layout, level)).or_insert(level);
    }
    let (mut zones, mut groups, mut warnings) = (Vec::new(), Vec::new(), Vec::new());
    let mut sets: BTreeSet<&str> = BTreeSet::new();
    for (k, message) in messages(root).into_iter().enumerate() {
        let set = &message["zoneSet"];
        let place = if root.is_array() { format!("message {}, zoneSet", k + 1) } else { "zoneSet".to_owned() };
        let refused = |problem: &dyn fmt::Display| ImportError::new(format!("{place}, {problem}"));
        let id = text_of(set, "mapId").map_err(|problem| refused(&problem))?;
        let Some(&level) = maps.get(id) else {
            let there = maps.into_keys().collect::<Vec<_>>().join(", ");
            return Err(refused(&format_args!("mapId: the layout has no map {id}; it has {there}")));
        };
        if !sets.insert(id) {
            let problem =
                "a second one of this map; vehicles have one set of a map enabled at most, audit each by itself";
            return Err(refused(&format!("mapId {id}: {problem}")));
        }
        let list = match &set["zones"] {
            Value::Array(list) => list,
            Value::Null => return Err(refused(&ZoneFieldError::Missing("zones"))),
            _ => return Err(refused(&ZoneFieldError::NoList("zones"))),
        };
        let mut names: BTreeSet<&str> = BTreeSet::new();
        for (k, zone) in list.iter().enumerate() {
            let name =
                text_of(zone, "zoneId").map_err(|problem| refused(&format_args!("zone {}, {problem}", k + 1)))?;
            let problem = |what: &dyn fmt::Display| ImportError::new(format!("zone {name}, {what}"));
            if !names.insert(name) {
                return Err(problem(&"zoneId: there is another one of this name in the set"));
            }
            let kind = text_of(zone, "zoneType").map_err(|wrong| problem(&wrong))?;
            if kind != "RELEASE" && kind != "BLOCKED" {
                let text = format_args!("zone {name}: {kind} keeps no vehicles apart");
                warnings.push(WarningCode::UncountedExclusion.text(text));
                continue;
            }
            let polygon = polygon(&zone["vertices"]).map_err(|wrong| problem(&wrong))?;
            groups.push(ExclusionGroup {
                name: name.to_owned(),
                outline: polygon.clone(),
                level,
                ..ExclusionGroup::default()
            });
            zones.push(ReleaseZone {
                map: id.to_owned(),
                blocked: kind == "BLOCKED",
                bounds: bounds(&polygon),
                polygon,
            });
        }
    }
    Ok((zones, groups, warnings))
}

/// What a vehicle takes and bars in one of so many zones: three tokens for each zone, 0 for certain presence, 1 and 2 for the others. A
/// vehicle that is entirely inside takes token 2 and bars token 1; one that is possibly inside takes token 1 and bars token 2.
fn tokens(
    zone: usize,
    count: usize,
    ZoneIntervals { certain: sure, whole, possible }: ZoneIntervals,
) -> impl Iterator<Item = TokenSpan> {
    let of = move |ranges: Vec<[f64; 2]>, takes: usize, bars: usize| {
        ranges.into_iter().flat_map(move |range| {
            [(takes, false), (bars, true)].map(|(kind, bars)| TokenSpan { token: kind * count + zone, bars, range })
        })
    };
    of(sure, 0, 0).chain(of(whole, 2, 1)).chain(of(possible, 1, 2))
}

/// Reads the zones.
pub(crate) fn read(text: &str, imported: &ImportedLayout) -> Result<ExclusionRules, ImportError> {
    let layout = &imported.layout;
    let root = parse_json(text)?.to_value();
    let (zones, mut groups, warnings) = zones_of(&root, layout)?;
    let said = messages(&root).into_iter().filter_map(|message| message["zoneSet"]["zoneSetDescriptor"].as_str());
    // A descriptor may be anybody's.
    let stamp = said.filter_map(VehicleStamp::read).next();
    let (reach, count) = (OutlineRadii::of(imported), zones.len());
    let there = |zone: &ReleaseZone, level: usize| map(layout, level) == zone.map;
    let rides = EdgeTraversals::new(imported);
    let presence = OutlinePresence { rides: &rides, vehicle: &imported.vehicle, inner: reach.inner };
    let of_outline = |edge: &LayoutEdge, backward: bool| {
        let ends = edge.ends.map(|end| layout.level_of(end));
        let step = RouteStep { edge, backward };
        let ways = presence.ways(step);
        let (mut marks, mut closed): (Vec<TokenSpan>, [Vec<[f64; 2]>; 2]) = Default::default();
        for (k, zone) in zones.iter().enumerate().filter(|(_, zone)| ends.iter().any(|&end| there(zone, end))) {
            let entered = presence.entered(step, &ways, zone);
            if zone.blocked {
                let on = (0..2).filter(|&end| there(zone, ends[end]));
                on.for_each(|end| closed[end].extend_from_slice(&entered.certain));
            } else {
                marks.extend(tokens(k, count, entered));
            }
        }
        DirectedEdgeRules::one_way(edge.length(), backward, marks, both(&closed[0], &closed[1]))
    };
    let edges = layout.edges.iter().map(|edge| {
        if imported.vehicle.footprint.is_some() && edge.length() > 0.0 {
            return [false, true].map(|backward| of_outline(edge, backward));
        }
        let ends = edge.ends.map(|end| layout.level_of(end));
        let curve = match &edge.curve[..] {
            // Without a length an edge is a point.
            [] => &[layout.position(edge.ends[0])].map(|at| PlacedSegment::line(at, at)),
            curve => curve,
        };
        let mut marks = Vec::new();
        // From map to map a vehicle may be on either: it is kept out where it is on both.
        let mut closed: [Vec<[f64; 2]>; 2] = Default::default();
        for (k, zone) in zones.iter().enumerate().filter(|(_, zone)| ends.iter().any(|&end| there(zone, end))) {
            let entered = reach.entered(curve, edge.deviation, zone);
            if zone.blocked {
                let on = (0..2).filter(|&end| there(zone, ends[end]));
                on.for_each(|end| closed[end].extend_from_slice(&entered.certain));
            } else {
                marks.extend(tokens(k, count, entered));
            }
        }
        DirectedEdgeRules::both(edge.length(), marks, both(&closed[0], &closed[1]))
    });
    let edges: Vec<[DirectedEdgeRules; 2]> = edges.collect();
    let nodes = layout.nodes.iter().map(|node| {
        let mut claim = ResourceClaim::default();
        for (k, zone) in zones.iter().enumerate().filter(|(_, zone)| there(zone, node.level)) {
            let entered = reach.entered(&[PlacedSegment::line(node.point, node.point)], 0.0, zone);
            if zone.blocked {
                claim.closed |= !entered.certain.is_empty();
                continue;
            }
            for mark in tokens(k, count, entered) {
                if mark.bars { claim.blocked.push(mark.token) } else { claim.acquired.push(mark.token) }
            }
        }
        claim.acquired.sort_unstable();
        claim.blocked.sort_unstable();
        claim
    });
    let nodes = nodes.collect();
    let mut members: BTreeMap<usize, BTreeSet<String>> = BTreeMap::new();
    for (edge, ways) in layout.edges.iter().zip(&edges) {
        // Vehicles that may reach into it.
        for mark in ways
            .iter()
            .flat_map(|way| way.marks())
            .filter(|mark| !mark.bars && (count..2 * count).contains(&mark.token))
        {
            members.entry(mark.token - count).or_default().insert(edge.id.to_string());
        }
    }
    for (token, edges) in members {
        groups[token].edges = edges.into_iter().collect();
    }
    let levels = (0..3 * count).map(|token| groups[token % count].level).collect();
    Ok(ExclusionRules { edges, nodes, groups, warnings, stamp, levels })
}

/// Writes the zone set of each map: one message, or a list of them.
pub(crate) fn write(
    imported: &ImportedLayout,
    settings: &WriteOptions,
    notes: &mut WriteNotes,
) -> Result<String, ImportError> {
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
        let set = json!({
            "mapId": map, "zoneSetId": format!("{map}-pcr-{sum:08x}"), "zoneSetDescriptor": VehicleStamp::of(imported).text(), "zones": zones
        });
        messages.push(json!({
            "headerId": 0, "timestamp": "1970-01-01T00:00:00.000Z", "version": "3.0.0", "manufacturer": "", "serialNumber": "",
            "zoneSet": set
        }));
    }
    let all = if messages.len() == 1 { messages.remove(0) } else { Value::Array(messages) };
    let text = serde_json::to_string_pretty(&all).map_err(|error| ImportError::new(error.to_string()))?;
    Ok(text + "\n")
}
