//! Files that were changed on purpose: a field left out, a key misspelt, renamed, added, or in another object, and another version.
//!
//! Small readers that share nothing with the importers say what each file means. What the importers make of it has to be that, or they
//! refuse it, or they say which key they do not know.

use pcr_formats::import::{ImportOptions, InputFormat, Warnings, layout, scenario};
use pcr_formats::scenario::{PathSegment, PlacedSegment};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

pub(crate) type Point = [f64; 2];

/// A way: points on it, one close to the next, its room \[m\] and its speed \[m/s\].
#[derive(Clone, Debug)]
pub(crate) struct Way {
    points: Vec<Point>,
    room: f64,
    speed: Option<f64>,
}

/// What a file means: its ways by their names.
pub(crate) type Meaning = BTreeMap<String, Way>;

/// How far the points of a way may be from the other one, which has lines and arcs within 1 mm, and chords for curves \[m\].
const NEAR: f64 = 0.02;

/// Distance of the points of a way \[m\].
const STEP: f64 = 0.2;

fn apart(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

impl Way {
    /// Points along a polyline, in steps of at most [`STEP`]; of many that are close to one another only some.
    pub(crate) fn along(corners: &[Point], room: f64, speed: Option<f64>) -> Self {
        let mut points: Vec<Point> = corners.first().into_iter().copied().collect();
        for (k, pair) in corners.windows(2).enumerate() {
            let count = (apart(pair[0], pair[1]) / STEP).ceil().max(1.0);
            let at = |k: usize| [0, 1].map(|axis| pair[0][axis] + (pair[1][axis] - pair[0][axis]) * k as f64 / count);
            points.extend((1..count as usize).map(at));
            let is_last = k + 2 == corners.len();
            if is_last || points.last().is_none_or(|last| apart(*last, pair[1]) > 0.25 * STEP) {
                points.push(pair[1]);
            }
        }
        Self { points, room, speed }
    }

    fn is(&self, other: &Self) -> bool {
        let holds = |a: &Self, b: &Self| {
            let near = |point: &Point| b.points.iter().any(|other| apart(*point, *other) <= STEP + NEAR);
            a.points.iter().all(near)
        };
        let ends = |way: &Self| way.points.first().copied().zip(way.points.last().copied());
        let same_ends = match (ends(self), ends(other)) {
            (Some((a, b)), Some((c, d))) => apart(a, c) <= NEAR && apart(b, d) <= NEAR,
            (a, b) => a.is_none() && b.is_none(),
        };
        let same = |a: f64, b: f64| (a - b).abs() <= 1e-9;
        let same_speed = self.speed.is_some() == other.speed.is_some()
            && same(self.speed.unwrap_or_default(), other.speed.unwrap_or_default());
        same_ends && holds(self, other) && holds(other, self) && same(self.room, other.room) && same_speed
    }
}

pub(crate) fn is_same(a: &Meaning, b: &Meaning) -> bool {
    a.len() == b.len() && a.iter().all(|(name, way)| b.get(name).is_some_and(|other| way.is(other)))
}

// The small readers. `None` is a file that does not say what it has to.

fn number(object: &Value, key: &str) -> Option<f64> {
    object.get(key)?.as_f64()
}

fn text<'v>(object: &'v Value, key: &str) -> Option<&'v str> {
    object.get(key)?.as_str()
}

fn place(object: &Value) -> Option<Point> {
    Some([number(object, "x")?, number(object, "y")?])
}

fn given<'v>(object: &'v Value, key: &str) -> Option<&'v Value> {
    object.get(key).filter(|value| !value.is_null())
}

fn list<'v>(object: &'v Value, key: &str) -> &'v [Value] {
    object.get(key).and_then(Value::as_array).map_or(&[], Vec::as_slice)
}

/// Points of a B-spline by de Boor's recursion; without knots they are even and clamped.
fn spline(curve: &Value) -> Option<Vec<Point>> {
    let points: Vec<Point> = list(curve, "controlPoints").iter().map(place).collect::<Option<_>>()?;
    let degree = given(curve, "degree").map_or(Some(1), Value::as_u64)? as usize;
    if points.len() <= degree || degree == 0 {
        return None;
    }
    let inner = points.len() - degree;
    let even = || (0..points.len() + degree + 1).map(|k| (k.saturating_sub(degree)).min(inner) as f64).collect();
    let knots: Vec<f64> = match given(curve, "knotVector") {
        None => even(),
        Some(_) => list(curve, "knotVector").iter().map(Value::as_f64).collect::<Option<_>>()?,
    };
    if knots.len() != points.len() + degree + 1 {
        return None;
    }
    let at = |u: f64| {
        let span = (degree..points.len()).rev().find(|k| knots[*k] <= u && knots[*k] < knots[k + 1]).unwrap_or(degree);
        let mut own: Vec<Point> = (0..=degree).map(|k| points[span - degree + k]).collect();
        for round in 1..=degree {
            for k in (round..=degree).rev() {
                let [lo, hi] = [knots[span - degree + k], knots[span + 1 + k - round]];
                let share = (u - lo) / (hi - lo);
                own[k] = [0, 1].map(|axis| own[k - 1][axis] * (1.0 - share) + own[k][axis] * share);
            }
        }
        own[degree]
    };
    let [first, last] = [knots[degree], knots[points.len()]];
    Some((0..=80).map(|k| at(first + (last - first) * (f64::from(k) / 80.0).min(1.0 - 1e-12))).collect())
}

fn corridor(of: &Value, names: [&str; 2], radius: f64) -> Option<f64> {
    let Some(corridor) = given(of, "corridor") else { return Some(0.0) };
    let widest = number(corridor, names[0])?.max(number(corridor, names[1])?);
    let reference = ["corridorReferencePoint", "corridorRefPoint"].iter().find_map(|key| text(corridor, key));
    Some(if reference == Some("CONTOUR") { (widest - radius).max(0.0) } else { widest })
}

fn lif(root: &Value) -> Option<Meaning> {
    let version = given(root, "metaInformation").and_then(|meta| text(meta, "lifVersion"));
    let is_second = match version {
        Some(version) => version.starts_with('2'),
        None => root.get("origins").is_some(),
    };
    let layouts: Vec<&Value> = match is_second {
        true => list(root, "origins").iter().flat_map(|origin| list(origin, "layouts")).collect(),
        false => list(root, "layouts").iter().collect(),
    };
    let [edge_properties, speed] = match is_second {
        true => ["mobileRobotTypeEdgeProperties", "maximumSpeed"],
        false => ["vehicleTypeEdgeProperties", "maxSpeed"],
    };
    let mut nodes = BTreeMap::new();
    for node in layouts.iter().flat_map(|layout| list(layout, "nodes")) {
        nodes.insert(text(node, "nodeId")?, place(node.get("nodePosition")?)?);
    }
    let mut ways = Meaning::new();
    for edge in layouts.iter().flat_map(|layout| list(layout, "edges")) {
        let ends = ["startNodeId", "endNodeId"].map(|key| text(edge, key).and_then(|node| nodes.get(node).copied()));
        let straight = [ends[0]?, ends[1]?];
        let none = json!({});
        let property = list(edge, edge_properties).first().unwrap_or(&none);
        if is_second
            && list(property, "mobileRobotTypes")
                .iter()
                .any(|robot| text(robot, "manufacturer").is_none() || text(robot, "seriesName").is_none())
        {
            return None;
        }
        let room = corridor(property, ["maximumLeftWidth", "maximumRightWidth"], 0.4)?;
        let corners = match given(property, "trajectory") {
            Some(curve) => spline(curve)?,
            None => straight.to_vec(),
        };
        let way = Way::along(&corners, room, given(property, speed).and_then(Value::as_f64));
        ways.insert(text(edge, "edgeId")?.to_owned(), way);
    }
    Some(ways).filter(|ways| !ways.is_empty())
}

fn nav2(root: &Value) -> Option<Meaning> {
    let (mut nodes, mut ways) = (BTreeMap::new(), Meaning::new());
    let of = |kind: &'static str| list(root, "features").iter().filter(move |one| one["geometry"]["type"] == kind);
    for node in of("Point") {
        let at = list(&node["geometry"], "coordinates");
        nodes.insert(node["properties"]["id"].as_u64()?, [at.first()?.as_f64()?, at.get(1)?.as_f64()?]);
    }
    for edge in of("MultiLineString") {
        let properties = &edge["properties"];
        let end = |key: &str| nodes.get(&properties[key].as_u64()?).copied();
        let speed = properties["metadata"]["speed_limit"].as_f64().filter(|share| *share <= 1.0);
        let way = Way::along(&[end("startid")?, end("endid")?], 0.0, speed);
        ways.insert(properties["id"].as_u64()?.to_string(), way);
    }
    Some(ways).filter(|ways| !ways.is_empty())
}

fn rmf(root: &Value) -> Option<Meaning> {
    let graph = root.get("building_name").is_some();
    let mut ways = Meaning::new();
    for (name, level) in root.get("levels")?.as_object()? {
        let vertex = |value: &Value| Some([value.get(0)?.as_f64()?, value.get(1)?.as_f64()?]);
        let vertices: Vec<Point> = list(level, "vertices").iter().map(vertex).collect::<Option<_>>()?;
        let value = |value: &Value| value.get(1).cloned().unwrap_or(value.clone());
        let ends = |one: &Value| {
            let end = |k: usize| vertices.get(one.get(k)?.as_u64()? as usize).copied();
            Some([end(0)?, end(1)?])
        };
        let mut scales = Vec::new();
        for measurement in list(level, "measurements") {
            let [a, b] = ends(measurement)?;
            scales.push(value(measurement.get(2)?.get("distance")?).as_f64()? / apart(a, b));
        }
        let scale = match text(root, "coordinate_system") {
            Some("cartesian_meters") => [1.0, 1.0],
            _ if graph => [1.0, 1.0],
            _ if scales.is_empty() => return None,
            _ => [1.0, -1.0].map(|sign| sign * scales.iter().sum::<f64>() / scales.len() as f64),
        };
        for (k, lane) in list(level, "lanes").iter().enumerate() {
            let corners = ends(lane)?.map(|at| [0, 1].map(|axis| at[axis] * scale[axis]));
            let parameters = lane.get(2).cloned().unwrap_or_default();
            let speed = parameters.get("speed_limit").map(value).and_then(|speed| speed.as_f64());
            let both = parameters.get("bidirectional").map(value).and_then(|both| both.as_bool()).unwrap_or(false);
            ways.insert(format!("{name}/{k}"), Way::along(&corners, 0.0, speed));
            if both && !graph {
                ways.insert(format!("{name}/{k} back"), Way::along(&[corners[1], corners[0]], 0.0, speed));
            }
        }
    }
    Some(ways).filter(|ways| !ways.is_empty())
}

fn order(root: &Value) -> Option<Meaning> {
    let sequence = |one: &Value| number(one, "sequenceId");
    let sorted = |key: &str| {
        let mut all: Vec<&Value> = list(root, key).iter().collect();
        let numbered = all.iter().filter(|one| sequence(one).is_some()).count();
        if numbered > 0 && numbered < all.len() {
            return None;
        }
        all.sort_by(|a, b| sequence(a).unwrap_or_default().total_cmp(&sequence(b).unwrap_or_default()));
        Some(all)
    };
    let (nodes, edges) = (sorted("nodes")?, sorted("edges")?);
    if nodes.len() != edges.len() + 1 || sequence(nodes[0]).is_some() != sequence(edges.first()?).is_some() {
        return None;
    }
    let released = |one: &Value| one.get("released").and_then(Value::as_bool).unwrap_or(true);
    let mut corners: Vec<Point> = Vec::new();
    let mut room = 0.0_f64;
    for (k, edge) in edges.iter().enumerate() {
        text(edge, "edgeId")?;
        if !released(edge) || !released(nodes[k + 1]) {
            break;
        }
        let end = |node: &Value| given(node, "nodePosition").map(place);
        room = room.max(corridor(edge, ["leftWidth", "rightWidth"], 0.4)?);
        let named = |key: &str, node: &Value| given(edge, key).is_none() || edge.get(key) == node.get("nodeId");
        if !named("startNodeId", nodes[k]) || !named("endNodeId", nodes[k + 1]) {
            return None;
        }
        match given(edge, "trajectory") {
            Some(curve) => corners.extend(spline(curve)?),
            // Where the trajectory before ended, if the node does not say where it is.
            None => {
                let from = corners.last().copied().or_else(|| end(nodes[k]).flatten())?;
                corners.extend([from, end(nodes[k + 1])??]);
            }
        }
    }
    nodes.iter().try_for_each(|node| text(node, "nodeId").map(drop))?;
    if corners.is_empty() {
        corners = vec![place(nodes[0].get("nodePosition")?)?; 2];
    }
    Some(Meaning::from([("agent".to_owned(), Way::along(&corners, room, None))]))
}

// What the importers make of it.

pub(crate) fn options() -> ImportOptions {
    let one = Some(1.0);
    ImportOptions {
        radius: Some(0.4),
        speed: one,
        acceleration: one,
        rotation: one,
        rotation_acceleration: one,
        ..ImportOptions::default()
    }
}

pub(crate) fn points(pieces: &[PlacedSegment]) -> Vec<Point> {
    let mut corners: Vec<Point> = pieces.first().map(|first| first.start).into_iter().collect();
    for piece in pieces {
        let count = match piece.shape {
            PathSegment::Arc { .. } => 4,
            _ => 1,
        };
        let length = piece.shape.length();
        corners.extend((1..=count).map(|k| piece.part(0.0, length * f64::from(k) / f64::from(count)).end()));
    }
    corners
}

fn imported(format: InputFormat, root: &Value) -> Result<(Meaning, Vec<String>), String> {
    let (text, mut warnings) = (root.to_string(), Warnings::default());
    let mut ways = Meaning::new();
    if format == InputFormat::Vda5050 {
        let read = scenario(format, &text, &options(), &mut warnings).map_err(|error| error.to_string())?;
        let agent = &read.agents[0];
        let mut pieces = Vec::new();
        let mut at = PlacedSegment {
            start: [agent.start[0], agent.start[1]],
            heading: agent.start[2],
            shape: PathSegment::Line { length: 0.0 },
        };
        for shape in &agent.path {
            at = PlacedSegment { start: at.end(), heading: at.heading_at_end(), shape: *shape };
            pieces.push(at);
        }
        let corners = if pieces.is_empty() { vec![at.start; 2] } else { points(&pieces) };
        // What curves are off is less than 1 mm.
        let room = ((agent.radius - 0.4) * 100.0).floor() / 100.0;
        ways.insert("agent".to_owned(), Way::along(&corners, room, None));
    } else {
        let read = layout(format, &text, &options(), &mut warnings).map_err(|error| error.to_string())?;
        for edge in &read.layout.edges {
            for step in edge.steps() {
                let back = if step.backward { " back" } else { "" };
                let way = Way::along(&points(&step.curve()), edge.room, step.speed());
                ways.insert(format!("{}{back}", edge.id), way);
            }
        }
    }
    Ok((ways, warnings.lines()))
}

// Changes.

/// Calls `visit` with every object in a value, by its path.
fn objects(value: &Value, path: &str, visit: &mut dyn FnMut(&str, &Map<String, Value>)) {
    match value {
        Value::Object(members) => {
            visit(path, members);
            members.iter().for_each(|(key, value)| objects(value, &format!("{path}/{key}"), visit));
        }
        Value::Array(elements) => {
            elements.iter().enumerate().for_each(|(k, value)| objects(value, &format!("{path}/{k}"), visit));
        }
        _ => {}
    }
}

/// The spellings of a key with one error in them.
pub(crate) fn misspelt(key: &str) -> Vec<String> {
    let letters: Vec<char> = key.chars().collect();
    let middle = letters.len() / 2;
    let mut less = letters.clone();
    less.remove(middle);
    let mut swapped = letters.clone();
    swapped.swap(middle, middle.saturating_sub(1));
    let mut all = vec![key.to_uppercase(), format!("{key}s"), less.iter().collect(), swapped.iter().collect()];
    all.retain(|other| other != key && !other.is_empty());
    all
}

#[derive(Default)]
struct Tally {
    same: usize,
    told: usize,
    refused: usize,
}

/// Changes a file in all ways at all places, and compares.
fn change(format: InputFormat, base: &Value, read: fn(&Value) -> Option<Meaning>, tally: &mut Tally) {
    let meant = read(base).expect("the file says what it has to");
    let (own, _) = imported(format, base).unwrap();
    assert!(is_same(&own, &meant), "{base}\n{own:?}\n{meant:?}");
    let mut places = Vec::new();
    objects(base, "", &mut |path, members| {
        places.extend(members.keys().map(|key| (path.to_owned(), key.clone())));
    });
    // Names and kinds of things may be any.
    let is_text = |path: &str, key: &str| base.pointer(&format!("{path}/{key}")).is_some_and(Value::is_string);
    for (path, key) in places {
        let renamed = |new: &str| {
            let mut value = base.clone();
            let members = value.pointer_mut(&path).unwrap().as_object_mut().unwrap();
            let content = members.remove(&key).unwrap();
            members.insert(new.to_owned(), content);
            value
        };
        // A level, a floor and the like is not a key of the format.
        let is_name = path.ends_with("/levels");
        // Misspelt: what it says is read, or it is refused.
        for new in misspelt(&key) {
            let exists = base.pointer(&path).and_then(|object| object.get(&new)).is_some();
            if is_name || exists {
                continue;
            }
            let value = renamed(&new);
            match imported(format, &value) {
                Err(_) => tally.refused += 1,
                Ok((ways, _)) if is_same(&ways, &meant) => tally.same += 1,
                // Of very short keys only the same letters are one.
                Ok((_, warnings)) if key.len() < 4 && warnings.iter().any(|line| line.contains(&new)) => {
                    tally.told += 1
                }
                Ok((ways, warnings)) => panic!("{path}: {key} as {new}: {warnings:?}\n{ways:?}\n{meant:?}"),
            }
        }
        // Renamed, left out, null: as if it had been left out, which is told or refused.
        let mut removed = base.clone();
        removed.pointer_mut(&path).unwrap().as_object_mut().unwrap().remove(&key);
        let mut null = base.clone();
        null.pointer_mut(&path).unwrap()[&key] = Value::Null;
        for (value, new) in [(removed.clone(), None), (null, None), (renamed("zzzzzz"), Some("zzzzzz"))] {
            if is_name {
                continue;
            }
            match (imported(format, &value), read(&removed)) {
                (Err(_), _) => tally.refused += 1,
                (Ok((ways, warnings)), Some(expected)) => {
                    assert!(is_same(&ways, &expected), "{path}, {key} ({new:?}): {warnings:?}\n{ways:?}\n{expected:?}");
                    let is_told = new.is_none_or(|new| warnings.iter().any(|line| line.contains(new)));
                    let is_free = format == InputFormat::Nav2 || is_same(&expected, &meant);
                    assert!(is_told || is_free, "{path}: {key} is not told: {warnings:?}");
                    if new.is_none() { tally.same += 1 } else { tally.told += 1 }
                }
                (Ok((ways, warnings)), None) => {
                    // Nothing says where it is: only what is a text has a meaning of its own.
                    assert!(
                        is_text(&path, &key) && is_same(&ways, &meant),
                        "{path}, {key} ({new:?}): {warnings:?}\n{ways:?}"
                    );
                    tally.same += 1;
                }
            }
        }
        // Moved to the object around it, or the one around that.
        let mut around = path.clone();
        while let Some(slash) = around.rfind('/') {
            around.truncate(slash);
            let Some(Value::Object(members)) = base.pointer(&around) else { continue };
            if members.contains_key(&key) || is_name {
                continue;
            }
            let mut value = removed.clone();
            let content = base.pointer(&path).unwrap()[&key].clone();
            value.pointer_mut(&around).unwrap()[&key] = content;
            match imported(format, &value) {
                Err(_) => tally.refused += 1,
                Ok((ways, _)) if is_same(&ways, &meant) => tally.same += 1,
                Ok((_, warnings)) if warnings.iter().any(|line| line.contains(&format!("key {key}"))) => {
                    tally.told += 1
                }
                Ok((ways, _))
                    if format == InputFormat::Nav2 && read(&removed).is_some_and(|it| is_same(&ways, &it)) =>
                {
                    tally.told += 1;
                }
                Ok((_, warnings)) => panic!("{key} from {path} to {around}: {warnings:?}"),
            }
        }
    }
    // An unknown key anywhere changes nothing.
    objects(base, "", &mut |path, _| {
        if path.ends_with("/levels") || path == "/levels" {
            return;
        }
        let mut value = base.clone();
        value.pointer_mut(path).unwrap()["zzzzzz"] = json!({ "x": 1.0, "y": 2.0 });
        let (ways, warnings) = imported(format, &value).unwrap_or_else(|error| panic!("{path}: {error}"));
        assert!(is_same(&ways, &meant), "{path}");
        let is_told = warnings.iter().any(|line| line.contains("its key zzzzzz is not known, and not read"));
        assert!(is_told || !matches!(format, InputFormat::Lif | InputFormat::Vda5050), "{path}: {warnings:?}");
        tally.same += 1;
    });
}

// Files.

fn curve() -> Value {
    let points =
        [[0.0, 0.0], [0.0, 5.0], [10.0, 5.0], [10.0, 0.0]].map(|[x, y]| json!({ "x": x, "y": y, "weight": 1.0 }));
    json!({ "degree": 2, "knotVector": [0, 0, 0, 0.5, 1, 1, 1], "controlPoints": points })
}

fn lif_file(version: &str) -> Value {
    let second = version.starts_with('2');
    let types = |mut property: Value| {
        if second {
            property["mobileRobotTypes"] = json!([{ "manufacturer": "M", "seriesName": "S" }]);
        } else {
            property["vehicleTypeId"] = json!("t");
        }
        property
    };
    let [node_list, edge_list] = match second {
        true => ["mobileRobotTypeNodeProperties", "mobileRobotTypeEdgeProperties"],
        false => ["vehicleTypeNodeProperties", "vehicleTypeEdgeProperties"],
    };
    let node = |id: &str, [x, y]: Point| {
        let mut node = json!({ "nodeId": id, "mapId": "m", "nodePosition": { "x": x, "y": y } });
        node[node_list] = json!([types(json!({ "theta": 0.5 }))]);
        node
    };
    let edge = |id: &str, ends: [&str; 2], property: Value| {
        let mut edge = json!({ "edgeId": id, "edgeName": id, "startNodeId": ends[0], "endNodeId": ends[1] });
        edge[edge_list] = json!([types(property)]);
        edge
    };
    let mut bent = json!({ "trajectory": curve(), "orientationType": "TANGENTIAL" });
    let mut straight = json!({ "rotationAtEndNodeAllowed": "BOTH" });
    if second {
        bent["maximumSpeed"] = json!(0.75);
        bent["mobileRobotOrientations"] = json!([0.0]);
        straight["corridor"] =
            json!({ "maximumLeftWidth": 0.5, "maximumRightWidth": 0.7, "corridorReferencePoint": "CONTOUR" });
    } else {
        bent["maxSpeed"] = json!(0.75);
        bent["vehicleOrientation"] = json!(0.0);
        bent["rotationAllowed"] = json!(false);
    }
    let nodes = [node("a", [0.0, 0.0]), node("b", [10.0, 0.0]), node("c", [10.0, 7.0])];
    let edges = [edge("ab", ["a", "b"], bent), edge("bc", ["b", "c"], straight)];
    let layout = json!({ "layoutId": "l", "layoutVersion": "1", "nodes": nodes, "edges": edges });
    let meta = json!({ "lifVersion": version, "creator": "x", "exportTimestamp": "2026-01-01T00:00:00Z" });
    match second {
        true => json!({ "metaInformation": meta, "origins": [{ "originId": "o", "layouts": [layout] }] }),
        false => json!({ "metaInformation": meta, "layouts": [layout] }),
    }
}

fn nav2_file() -> Value {
    let node = |id: u64, at: Point| {
        let geometry = json!({ "type": "Point", "coordinates": at });
        json!({ "type": "Feature", "properties": { "id": id, "frame": "map" }, "geometry": geometry })
    };
    let edge = |id: u64, ends: [u64; 2]| {
        let properties = json!({ "id": id, "startid": ends[0], "endid": ends[1], "metadata": { "speed_limit": 0.5 } });
        json!({ "type": "Feature", "properties": properties, "geometry": { "type": "MultiLineString", "coordinates": [] } })
    };
    let features = [node(0, [0.0, 0.0]), node(1, [4.0, 1.0]), node(2, [5.0, 6.0]), edge(10, [0, 1]), edge(11, [1, 2])];
    json!({ "type": "FeatureCollection", "name": "g", "features": features })
}

fn rmf_file(graph: bool) -> Value {
    let vertices = if graph {
        json!([[0, 0, { "name": "a" }], [4, 1, { "name": "b" }], [5, 6, { "name": "c" }]])
    } else {
        json!([[100, 100, 0, "a"], [500, 120, 0, "b"], [520, 700, 0, "c"]])
    };
    let lanes = if graph {
        json!([[0, 1, { "graph_idx": 0, "speed_limit": 0.5 }], [1, 2, { "graph_idx": 0 }]])
    } else {
        json!([
            [0, 1, { "bidirectional": [4, true], "graph_idx": [2, 0], "speed_limit": [3, 0.5] }],
            [1, 2, { "bidirectional": [4, false] }]
        ])
    };
    let mut level = json!({ "vertices": vertices, "lanes": lanes });
    if graph {
        return json!({ "building_name": "b", "levels": { "L1": level }, "lifts": {} });
    }
    level["measurements"] = json!([[0, 1, { "distance": [3, 10.0] }]]);
    json!({ "name": "b", "coordinate_system": "reference_image", "levels": { "L1": level }, "lifts": {} })
}

fn order_file(version: &str) -> Value {
    let node = |k: usize, [x, y]: Point| {
        json!({ "nodeId": format!("n{k}"), "sequenceId": 2 * k, "released": k < 3, "actions": [],
            "nodePosition": { "x": x, "y": y, "mapId": "m" } })
    };
    let edge = |k: usize, more: Value| {
        let mut edge = json!({ "edgeId": format!("e{k}"), "sequenceId": 2 * k + 1, "released": k < 2, "actions": [] });
        edge.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        if !version.starts_with('3') {
            edge["startNodeId"] = json!(format!("n{k}"));
            edge["endNodeId"] = json!(format!("n{}", k + 1));
        }
        edge
    };
    let reference = if version.starts_with('3') { "corridorReferencePoint" } else { "corridorRefPoint" };
    let mut room = json!({ "corridor": { "leftWidth": 0.5, "rightWidth": 0.75 } });
    room["corridor"][reference] = json!("CONTOUR");
    if version == "2.0.0" {
        room = json!({});
    }
    let nodes = [node(0, [0.0, 0.0]), node(1, [10.0, 0.0]), node(2, [10.0, 7.0]), node(3, [0.0, 7.0])];
    let edges = [edge(0, json!({ "trajectory": curve() })), edge(1, room), edge(2, json!({}))];
    json!({ "headerId": 1, "timestamp": "2026-01-01T00:00:00Z", "version": version, "manufacturer": "m", "serialNumber": "s",
        "orderId": "o", "orderUpdateId": 0, "nodes": nodes, "edges": edges })
}

#[test]
fn what_was_changed_is_read_as_it_stands_or_refused_or_told() {
    let mut tally = Tally::default();
    for version in ["0.11.0", "1.0.0", "2.0.0"] {
        change(InputFormat::Lif, &lif_file(version), lif, &mut tally);
    }
    change(InputFormat::Nav2, &nav2_file(), nav2, &mut tally);
    for graph in [false, true] {
        change(InputFormat::Rmf, &rmf_file(graph), rmf, &mut tally);
    }
    for version in ["2.0.0", "2.1.0", "3.0.0"] {
        change(InputFormat::Vda5050, &order_file(version), order, &mut tally);
    }
    let Tally { same, told, refused } = tally;
    assert!(same > 300 && told > 50 && refused > 300, "{same} the same, {told} told, {refused} refused");
}

#[test]
fn a_file_in_the_names_of_another_version_is_refused() {
    for (own, other) in [("1.0.0", "2.0.0"), ("0.11.0", "2.0.0"), ("2.0.0", "1.0.0"), ("2.0.0", "0.11.0")] {
        let mut file = lif_file(own);
        file["metaInformation"]["lifVersion"] = json!(other);
        let error = imported(InputFormat::Lif, &file).unwrap_err();
        assert!(error.starts_with(&format!("LIF, lifVersion: the file says {other}, but ")), "{error}");
    }
}
