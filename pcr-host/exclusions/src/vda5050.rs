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

use crate::convex_outline::{around, around_swept, depth, distance, sides_meet};
use crate::curve_proximity::{lengths_near_polygon, lengths_of_outline};
use crate::options::{WriteNotes, WriteOptions};
use crate::stamp::VehicleStamp;
use crate::{DirectedEdgeRules, ExclusionGroup, ExclusionRules, ResourceClaim, TokenSpan, stretch};
use pcr_formats::import::{ImportError, ImportedLayout, Layout, LayoutEdge, RouteStep, VehicleTraits, parse_json};
use pcr_formats::plane_geometry::hull;
use pcr_formats::scenario::{Agent, LIMIT, PathSegment, PlacedSegment};
use pcr_formats::warning::WarningCode;
use pcr_planning::checksum::crc32;
use pcr_planning::exclusion_table::{
    EdgeTraversal, EdgeTraversals, SweptShape, corridor, is_turn, placed_pieces, swept,
};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_PI_4;
use std::fmt;

/// Zones reach this far beyond corridors, so that rounding does not count \[m\].
const BEYOND: f64 = 1e-6;

/// Zones of arcs turn by no more than this \[rad\].
const TURN: f64 = FRAC_PI_4;

/// By how much vehicles have to reach farther than to the border of a zone that they are said to need, or to be within: less than
/// [`BEYOND`] \[m\].
const SURE: f64 = 1e-7;

/// How much farther off vehicles are said to reach into a zone: more than what counts as contact in an audit \[m\].
const POSSIBLE: f64 = 1e-4;

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

struct ReleaseZone {
    map: String,
    blocked: bool,
    polygon: Vec<[f64; 2]>,
    /// Corners of the box around it.
    bounds: [[f64; 2]; 2],
}

/// Lengths of an edge at which a vehicle is in a zone.
#[derive(Default)]
struct ZoneIntervals {
    /// The vehicle is certainly in the zone, at least in part.
    certain: Vec<[f64; 2]>,
    /// The vehicle is certainly in the zone entirely.
    whole: Vec<[f64; 2]>,
    /// The vehicle may be in the zone in part.
    possible: Vec<[f64; 2]>,
}

/// Where on an edge a vehicle with an outline turns in place, its presence there is said of so much of the edge on both sides \[m\].
const TURNING: f64 = 1e-4;

/// So much of the edge on both sides of it is in the zone of a turn in place \[m\].
const BESIDE_TURN: f64 = 1e-3;

/// Lengths that differ by no more are the end of an edge \[m\].
const SAME: f64 = 1e-9;

/// Bounds on how far vehicles reach from their centres.
struct OutlineRadii {
    /// All points at most this far from the centre are in the contour \[m\]; `None` if the centre is outside, because then
    /// nothing is known.
    inner: Option<f64>,
    /// Bound on the distance of the points of the contour from the centre \[m\].
    outer: f64,
    /// Bound on the distance of the centre from its edge \[m\].
    position_error: f64,
}

impl OutlineRadii {
    fn of(imported: &ImportedLayout) -> Self {
        let vehicle = &imported.vehicle;
        let inner = match &vehicle.footprint {
            None => Some(vehicle.radius),
            Some(footprint) => Some(depth(footprint.polygon(), [0.0; 2])).filter(|depth| *depth >= 0.0),
        };
        // A margin is for how far vehicles are off their edges: their contours are no larger for it.
        Self { inner, outer: vehicle.radius, position_error: vehicle.margin }
    }

    /// Lengths of a curve at which a vehicle is in a zone; `deviation` bounds the distance of the true curve from this one
    /// \[m\].
    fn entered(&self, curve: &[PlacedSegment], deviation: f64, zone: &ReleaseZone) -> ZoneIntervals {
        let off = self.position_error + deviation;
        let far = self.outer + off + POSSIBLE;
        if !near(curve, far, zone.bounds) {
            return ZoneIntervals::default();
        }
        let within = |reach| lengths_near_polygon(curve, &zone.polygon, reach);
        ZoneIntervals {
            // If the centre is outside the contour, only a zone that contains the whole contour is certain to contain a part of
            // it.
            certain: within(self.inner.unwrap_or(-self.outer) - off - SURE),
            whole: within(-(self.outer + off + SURE)),
            possible: within(far),
        }
    }
}

/// The lengths of an edge in one direction at which a vehicle with an outline is in zones.
struct OutlinePresence<'a> {
    rides: &'a EdgeTraversals<'a>,
    vehicle: &'a VehicleTraits,
    inner: Option<f64>,
}

impl OutlinePresence<'_> {
    /// The rides in one direction, each with where it goes.
    fn ways(&self, step: RouteStep<'_>) -> Vec<(EdgeTraversal, Vec<PlacedSegment>)> {
        let rides = self.rides.in_direction(step).into_iter();
        rides.map(|ride| (placed_pieces(&ride.agent), ride)).map(|(path, ride)| (ride, path)).collect()
    }

    fn entered(
        &self,
        step: RouteStep<'_>,
        ways: &[(EdgeTraversal, Vec<PlacedSegment>)],
        zone: &ReleaseZone,
    ) -> ZoneIntervals {
        let length = step.edge.length();
        let mut all = ZoneIntervals::default();
        let (mut uncertain, mut not_whole) = (Vec::new(), Vec::new());
        for (ride, path) in ways {
            let here = self.of_ride(step, ride, path, zone);
            match ride.turns_at() {
                None => {
                    let enclosed = |ranges: Vec<[f64; 2]>| {
                        let inner = ranges.into_iter().filter_map(|range| ride.enclosed_lengths(range));
                        inner.map(|[from, to]| [from, if to >= length - SAME { length } else { to }]).collect()
                    };
                    all.certain = enclosed(here.certain);
                    all.whole = enclosed(here.whole);
                    let touched = here.possible.into_iter().map(|range| ride.touched_lengths(range));
                    all.possible.extend(touched.map(|[from, to]| [from, to.min(length)]));
                }
                Some(at) => {
                    let beside = [at - TURNING, at + TURNING];
                    let angle: f64 = path.iter().map(|piece| piece.shape.sweep().abs()).sum();
                    let is_all =
                        |ranges: &[[f64; 2]]| ranges.iter().any(|[from, to]| *from <= SAME && *to >= angle - SAME);
                    if !is_all(&here.certain) {
                        uncertain.push(beside);
                    }
                    if !is_all(&here.whole) {
                        not_whole.push(beside);
                    }
                    if !here.possible.is_empty() {
                        all.possible.push(beside.map(|end| end.clamp(0.0, length)));
                    }
                }
            }
        }
        all.certain = without(all.certain, &uncertain);
        all.whole = without(all.whole, &not_whole);
        all
    }

    /// The same as lengths on the path of a ride.
    fn of_ride(
        &self,
        step: RouteStep<'_>,
        ride: &EdgeTraversal,
        path: &[PlacedSegment],
        zone: &ReleaseZone,
    ) -> ZoneIntervals {
        let agent = &ride.agent;
        if !near(path, agent.radius + POSSIBLE, zone.bounds) {
            return ZoneIntervals::default();
        }
        let (corners, growth) = match &agent.footprint {
            Some(footprint) => (footprint.polygon(), footprint.growth()),
            None => (&[[0.0; 2]][..], agent.radius),
        };
        let (far, deep) = (growth + POSSIBLE, growth + SURE);
        let polygon = &zone.polygon[..];
        let touches = |placed: &[[f64; 2]]| {
            let is_near =
                |own: &[[f64; 2]], other: &[[f64; 2]]| own.iter().any(|&corner| distance(other, corner) <= far);
            is_near(placed, polygon) || is_near(polygon, placed) || sides_meet(placed, polygon)
        };
        let encloses = |placed: &[[f64; 2]]| {
            placed.iter().all(|&corner| depth(polygon, corner) >= deep)
                && polygon.iter().all(|&corner| depth(placed, corner) <= -deep)
                && !sides_meet(placed, polygon)
        };
        // What the vehicle itself covers, of which the agent has the hull if it may face either way, and the margin with other
        // deviations.
        let known = step.facing().angle().filter(|_| agent.footprint.is_some());
        let contour = known.and_then(|_| self.vehicle.facing(step.facing()).footprint);
        let off = agent.radius - self.vehicle.radius + SURE;
        let mut certain = Vec::new();
        if let Some(contour) = &contour {
            let room = off - contour.growth();
            certain.extend(lengths_of_outline(path, contour.polygon(), polygon, &[room], |placed| {
                placed.iter().any(|&corner| depth(polygon, corner) >= room)
                    || polygon.iter().any(|&corner| depth(placed, corner) >= room)
            }));
        }
        if let Some(inner) = self.inner {
            let room = off - inner;
            certain.extend(lengths_of_outline(path, &[[0.0; 2]], polygon, &[room], |placed| {
                placed.iter().all(|&centre| depth(polygon, centre) >= room)
            }));
        }
        ZoneIntervals {
            certain: joined(certain),
            whole: lengths_of_outline(path, corners, polygon, &[deep], encloses),
            possible: lengths_of_outline(path, corners, polygon, &[far], touches),
        }
    }
}

/// Ranges in ascending order, those that overlap as one.
fn joined(mut ranges: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    ranges.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut all: Vec<[f64; 2]> = Vec::new();
    for next in ranges {
        match all.last_mut() {
            Some(last) if next[0] < last[1] => last[1] = last[1].max(next[1]),
            _ => all.push(next),
        }
    }
    all
}

/// Ranges without what is in others.
fn without(ranges: Vec<[f64; 2]>, others: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let cut = |ranges: Vec<[f64; 2]>, &[from, to]: &[f64; 2]| {
        let rest = ranges.into_iter().flat_map(|[lo, hi]| [[lo, hi.min(from)], [lo.max(to), hi]]);
        rest.filter(|[lo, hi]| lo < hi).collect()
    };
    others.iter().fold(ranges, cut)
}

/// Whether a curve can come so near a box.
fn near(curve: &[PlacedSegment], far: f64, [lo, hi]: [[f64; 2]; 2]) -> bool {
    curve.iter().any(|piece| {
        let ends = [piece.start, piece.end()];
        // No point of a piece is farther from both ends than half its length.
        let room = match piece.shape {
            PathSegment::Arc { .. } => piece.shape.length() / 2.0,
            _ => 0.0,
        };
        (0..2).all(|x| {
            let (least, most) = (ends[0][x].min(ends[1][x]), ends[0][x].max(ends[1][x]));
            least - room - far <= hi[x] && lo[x] <= most + room + far
        })
    })
}

fn bounds(polygon: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let of = |pick: fn(f64, f64) -> f64, from: f64| [0, 1].map(|x| polygon.iter().map(|at| at[x]).fold(from, pick));
    [of(f64::min, f64::INFINITY), of(f64::max, f64::NEG_INFINITY)]
}

/// The intersection of two lists of ranges.
fn both(a: &[[f64; 2]], b: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let pairs = a.iter().flat_map(|a| b.iter().map(move |b| [a[0].max(b[0]), a[1].min(b[1])]));
    pairs.filter(|[from, to]| from <= to).collect()
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

type ZoneOutline = (String, Vec<[f64; 2]>);

/// The zones of the edges of a level, by the name of the first edge that they are of.
fn zones(imported: &ImportedLayout, level: usize, split: Option<f64>) -> Vec<ZoneOutline> {
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
fn distinguish(zones: &mut [ZoneOutline]) {
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
fn lone_nodes(imported: &ImportedLayout, level: usize) -> Vec<ZoneOutline> {
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
