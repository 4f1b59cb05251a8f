//! VDA 5050: orders (2.x and 3.0) and states (3.0); each vehicle that is named becomes an agent, and each message that
//! names none. `updates` joins an order with its updates.
//!
//! A file holds one message, a list of them, or several one after the other. `null` counts as missing.
//! - An order is travelled from node to node by `sequenceId`, along its trajectories or straight, under its speed
//!   limits; the base ends where the first node or edge is not released, and the horizon is travelled only if
//!   requested.
//! - A state with an `intermediatePath` is a plan with times, in seconds since the time stamp of the first state with a
//!   path; one with a `plannedPath` travels that from rest, from its own time stamp on; one with neither stands where it
//!   is. It is refused if it goes on from where its path ends, or from where it stands, and if the vehicle does not know
//!   where it is. Loads in a state enlarge the vehicle.
//! - Orders do not say when they begin: all do at the time 0, and they are not read together with states with paths.

use super::timed::{self, seconds};
use super::trace::Tracer;
use super::value::Object;
use super::warnings::TOGETHER;
use super::{ImportError, Options, Vehicle, Warnings, facing, loads, route, trajectory, updates};
use crate::footprint::Footprint;
use crate::scenario::Placed;
use crate::scenario::{Agent, MotionSpec, Scenario, label};
use serde_json::Value;
use std::collections::BTreeSet;

/// Largest gap between the end of a path and its node, or the vehicle: it counts as deviation of the path \[m\].
const GAP: f64 = 0.05;

/// Gap that is rounding and nothing else \[m\].
const CLOSED: f64 = 1e-9;

/// Whether a JSON value looks like an order or a state.
pub(super) fn is_message(root: &Value) -> bool {
    let one = match root {
        Value::Array(messages) => messages.first(),
        one => Some(one),
    };
    one.is_some_and(|one| one.get("orderId").is_some() || one.get("nodeStates").is_some())
}

/// Reads orders and states; returns the radii of the vehicles with their loads as well.
pub(super) fn read(
    text: &str,
    options: &Options,
    vehicle: &Vehicle,
    warnings: &mut Warnings,
) -> Result<(Scenario, Vec<f64>), ImportError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut messages = Vec::new();
    for value in serde_json::Deserializer::from_str(text).into_iter::<Value>() {
        match value.map_err(|error| ImportError::new(format!("not JSON: {error}")))? {
            Value::Array(several) => messages.extend(several),
            one => messages.push(one),
        }
    }
    if messages.is_empty() {
        return Err(ImportError::new("there is no order and no state in it"));
    }
    let messages = updates::joined(messages)?;
    let mut reader = Reader { options, vehicle, warnings, begins: Vec::new(), maps: BTreeSet::new() };
    let mut scenario = Scenario::new("", Vec::new());
    let mut radii = Vec::new();
    for (k, value) in messages.iter().enumerate() {
        let id = k as u64 + 1;
        let message = Object::new(format!("message {id}"), value)?;
        let name = message.text("orderId").ok().flatten().unwrap_or_default();
        let robot = message.text("serialNumber").ok().flatten().unwrap_or_default();
        let called = label(&[robot, name].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" "));
        let state = ["nodeStates", "mobileRobotPosition", "plannedPath", "intermediatePath"];
        if message.get("nodes").is_some() {
            let order = message.called(format!("order {name}"));
            reader.begins.push((order.name.clone(), Begin::Unsaid));
            scenario.agents.push(Agent { label: called, ..reader.order(id, &order)? });
            radii.push(vehicle.radius);
        } else if state.iter().any(|field| message.get(field).is_some()) {
            let robot = Some(robot).filter(|robot| !robot.is_empty());
            let state =
                message.called(robot.map_or_else(|| format!("state {id}"), |robot| format!("state of {robot}")));
            let loaded = loads::loaded(&state, vehicle, reader.warnings)?;
            let (agent, begin) = reader.state(id, &state, &loaded)?;
            reader.begins.push((state.name.clone(), begin));
            scenario.agents.push(Agent { label: called, ..agent });
            radii.push(loaded.radius);
        } else {
            return Err(message.missing("nodes or nodeStates"));
        }
        // Several have no name in common.
        if messages.len() == 1 {
            scenario.name = name.to_owned();
        }
    }
    begin(&mut scenario.agents, &reader.begins)?;
    if reader.maps.len() > 1 {
        let maps = reader.maps.into_iter().collect::<Vec<_>>().join(", ");
        warnings
            .add(format_args!("maps {maps}"), format!("{TOGETHER}on several, which a scenario does not tell apart"));
    }
    Ok((scenario, radii))
}

struct Reader<'a> {
    options: &'a Options,
    vehicle: &'a Vehicle,
    warnings: &'a mut Warnings,
    /// Names of the agents, and when each begins.
    begins: Vec<(String, Begin)>,
    /// The maps of all agents.
    maps: BTreeSet<String>,
}

/// Begin of the motion of an agent.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Begin {
    /// It stands, whenever.
    Never,
    /// It moves, and it is not said from when on.
    Unsaid,
    /// \[s\] since 1970.
    At(f64),
}

/// Gives agents their times since that of the first one that has one.
fn begin(agents: &mut [Agent], begins: &[(String, Begin)]) -> Result<(), ImportError> {
    let mut all = begins.iter();
    let origin = all.find_map(|(name, begin)| if let Begin::At(time) = begin { Some((name, *time)) } else { None });
    let Some((stamped, origin)) = origin else { return Ok(()) };
    for (agent, (name, begin)) in agents.iter_mut().zip(begins) {
        match begin {
            Begin::Never => {}
            Begin::At(time) => agent.t_start = time - origin,
            Begin::Unsaid => {
                let problem = "it does not say when it begins, and cannot be read together with what does";
                return Err(ImportError::new(format!("{name}: {problem}: {stamped}")));
            }
        }
    }
    Ok(())
}

/// A node or an edge in the order of travel.
struct Part<'j> {
    object: Object<'j>,
    sequence: f64,
    released: bool,
}

fn parts<'j>(order: &Object<'j>, list: &str, what: &str, id: &str) -> Result<Vec<Part<'j>>, ImportError> {
    let mut parts = Vec::new();
    for (k, value) in order.list(list)?.iter().enumerate() {
        let object = Object::new(format!("{}, {what} {}", order.name, k + 1), value)?;
        let name = object.text(id)?.ok_or_else(|| object.missing(id))?;
        let object = object.called(format!("{}, {what} {name}", order.name));
        let released = object.flag("released")?.unwrap_or(true);
        // Without numbers the lists are in the order of travel.
        parts.push(Part { sequence: object.number("sequenceId")?.unwrap_or(k as f64), released, object });
    }
    parts.sort_by(|a, b| a.sequence.total_cmp(&b.sequence));
    Ok(parts)
}

impl Reader<'_> {
    fn order(&mut self, id: u64, order: &Object<'_>) -> Result<Agent, ImportError> {
        let mut nodes = parts(order, "nodes", "node", "nodeId")?;
        let mut edges = parts(order, "edges", "edge", "edgeId")?;
        if nodes.len() != edges.len() + 1 {
            let problem = format!("{}: {} nodes and {} edges, which is no path", order.name, nodes.len(), edges.len());
            return Err(ImportError::new(problem));
        }
        if !self.options.horizon {
            let base =
                nodes.iter().skip(1).zip(&edges).take_while(|(node, edge)| node.released && edge.released).count();
            if base < edges.len() {
                let ahead = format!(
                    "{} of {} edges are not released and left out (--horizon)",
                    edges.len() - base,
                    edges.len()
                );
                self.warnings.add(&order.name, ahead);
            }
            nodes.truncate(base + 1);
            edges.truncate(base);
        }
        self.maps(order, nodes.iter().map(|node| node.object.object("nodePosition")))?;
        for node in &nodes {
            let position = node.object.object("nodePosition")?;
            if position.is_some_and(|position| position.get("allowedDeviationXY").is_some_and(allows)) {
                let problem = "its allowedDeviationXY is not read; the vehicle is taken to pass the node itself";
                self.warnings.add(&node.object.name, problem);
            }
        }
        for edge in &edges {
            if edge.object.get("corridor").is_some() {
                self.warnings
                    .add(&edge.object.name, "its corridor is not read; the vehicle keeps to the middle of its way");
            }
        }
        let mut tracer = Tracer::default();
        let mut ways: Vec<Option<[f64; 2]>> = Vec::new();
        let (mut position, mut deviation) = (position(nodes.first(), "nodePosition")?, 0.0_f64);
        // Difference of lengths: the vehicle may be ahead of its path by this, or behind it.
        let mut longer = 0.0;
        if position.is_none() && edges.is_empty() {
            return Err(nodes
                .first()
                .map_or_else(|| order.missing("nodes"), |node| node.object.missing("nodePosition")));
        }
        for (k, edge) in edges.iter().enumerate() {
            let (before, after) = (nodes.get(k), nodes.get(k + 1));
            let edge = &edge.object;
            joins(edge, before, after)?;
            let speed = match edge.positive("maxSpeed")? {
                None => edge.positive("maximumSpeed")?,
                speed => speed,
            };
            let rotation = match edge.positive("maxRotationSpeed")? {
                None => edge.positive("maximumRotationSpeed")?,
                rotation => rotation,
            };
            tracer.limit(speed, rotation);
            let target = self::position(after, "nodePosition")?;
            let trajectory = edge.object("trajectory")?;
            let is_straight = trajectory.is_none();
            let line = position.zip(target).filter(|_| is_straight);
            let ahead = line.map(|(from, to)| (to[1] - from[1]).atan2(to[0] - from[0]));
            if let Some(outline) = &self.vehicle.footprint {
                facing::along(edge, "orientation", 1.0, ahead, outline, self.warnings)?;
            }
            let Some(trajectory) = trajectory else {
                let missing = |node: Option<&Part<'_>>| {
                    node.map_or_else(|| edge.missing("node"), |node| node.object.missing("nodePosition"))
                };
                let from = position.ok_or_else(|| missing(before))?;
                let to = target.ok_or_else(|| missing(after))?;
                tracer.line(from, to);
                ways.push(ahead.filter(|_| from != to).map(|heading| [heading; 2]));
                position = Some(to);
                continue;
            };
            let trajectory = trajectory.called(format!("{}, trajectory", edge.name));
            let fit = trajectory::read(&trajectory, self.options.tolerance(), self.warnings)?;
            let ends = fit.pieces.first().zip(fit.pieces.last());
            ways.push(ends.map(|(first, last)| [first.heading, last.heading_at_end()]));
            let (end, gap) = follow(&mut tracer, edge, &fit.pieces, position, target)?;
            position = Some(end);
            deviation = deviation.max(fit.deviation + longer + gap);
            longer += fit.longer;
        }
        deviation = deviation.max(longer);
        let stands = ways.iter().all(Option::is_none);
        if let Some(outline) = self.vehicle.footprint.as_ref().filter(|_| !stands) {
            self.thetas(&nodes, &ways, outline)?;
        }
        let stops = nodes.iter().any(|node| !node.object.list("actions").unwrap_or_default().is_empty());
        if stops {
            self.warnings.add(&order.name, "its actions take no time here: the file does not say how long they last");
        }
        let mut trace = tracer.finish(position.unwrap_or_default());
        trace.deviation += deviation;
        if stands
            && let Some(place) = nodes.first().map_or(Ok(None), |node| node.object.object("nodePosition"))?
            && let Some(theta) = place.number("theta")?
        {
            (trace.start[2], trace.faces) = (theta, true);
        }
        Ok(route::agent(id, &trace, self.vehicle, 0.0))
    }

    /// Warns if the orientation at a node matches neither the arriving nor the departing edge. `ways` has the headings of each edge at its
    /// two ends.
    fn thetas(
        &mut self,
        nodes: &[Part<'_>],
        ways: &[Option<[f64; 2]>],
        outline: &Footprint,
    ) -> Result<(), ImportError> {
        for (k, node) in nodes.iter().enumerate() {
            let Some(theta) = node.object.object("nodePosition")?.map_or(Ok(None), |it| it.number("theta"))? else {
                continue;
            };
            let arrives = k.checked_sub(1).and_then(|before| ways.get(before).copied().flatten()).map(|way| way[1]);
            let departs = ways.get(k).copied().flatten().map(|way| way[0]);
            if !arrives.into_iter().chain(departs).any(|heading| facing::is_ahead(outline, theta - heading)) {
                facing::lose(&node.object.name, "theta", theta, self.warnings);
            }
        }
        Ok(())
    }

    /// Keeps the map on which an agent is, which has to be one, as what is on different maps has no common coordinates.
    fn maps<'j>(
        &mut self,
        of: &Object<'_>,
        positions: impl Iterator<Item = Result<Option<Object<'j>>, ImportError>>,
    ) -> Result<(), ImportError> {
        let mut own: Option<&str> = None;
        for position in positions {
            let Some(map) = position?.map(|position| position.text("mapId")).transpose()?.flatten() else { continue };
            if own.is_some_and(|own| own != map) {
                let own = own.unwrap_or_default();
                return Err(ImportError::new(format!("{}: it leads from map {own} to map {map}", of.name)));
            }
            own = Some(map);
        }
        self.maps.extend(own.map(str::to_owned));
        Ok(())
    }

    /// The agent of a state, and when it begins.
    fn state(&mut self, id: u64, state: &Object<'_>, vehicle: &Vehicle) -> Result<(Agent, Begin), ImportError> {
        let pose =
            state.object("mobileRobotPosition")?.map_or_else(|| state.object("agvPosition"), |pose| Ok(Some(pose)))?;
        self.maps(state, std::iter::once(Ok(pose.clone())))?;
        let heading = pose.as_ref().map_or(Ok(None), |pose| pose.number("theta"))?;
        if let Some(pose) = &pose {
            for field in ["localized", "positionInitialized"] {
                if pose.flag(field)? == Some(false) {
                    return Err(ImportError::new(format!("{}, {field}: it does not know where it is", pose.name)));
                }
            }
            if pose.number("localizationScore")?.is_some_and(|score| score <= 0.0) {
                let name = &pose.name;
                return Err(ImportError::new(format!("{name}, localizationScore: it does not know where it is")));
            }
        }
        let at = pose.map(|pose| pose.point()).transpose()?;
        if let Some(path) = state.object("intermediatePath")? {
            if state.get("plannedPath").is_some() {
                let problem = "its plannedPath, which goes on where the times of its intermediatePath end";
                self.warnings.lose(format_args!("{}: {problem}", state.name));
            }
            let (agent, begin, end) = self.timed(id, state, &path, at, vehicle.radius)?;
            self.goes_on(state, end, &[])?;
            return Ok((Agent { margin: vehicle.margin, ..agent }, Begin::At(begin)));
        }
        if let Some(path) = state.object("plannedPath")? {
            let trajectory = path.object("trajectory")?.ok_or_else(|| path.missing("trajectory"))?;
            let fit = trajectory::read(&trajectory, self.options.tolerance(), self.warnings)?;
            let begin = fit.pieces.first().map(|piece| piece.at);
            let gap = at.zip(begin).map_or(0.0, |(at, begin)| (at[0] - begin[0]).hypot(at[1] - begin[1]));
            if gap > GAP {
                let name = &path.name;
                return Err(ImportError::new(format!("{name}: it begins {gap:.3} m from where the vehicle is")));
            }
            let mut tracer = Tracer::default();
            fit.pieces.iter().for_each(|piece| tracer.follow(piece));
            let begin = at.or(begin).unwrap_or_default();
            self.goes_on(state, fit.pieces.last().map_or(begin, Placed::end), path.list("traversedNodes")?)?;
            if moves(state)? {
                self.warnings.add(&state.name, "it moves already; its plannedPath is travelled from rest");
            }
            let mut trace = tracer.finish(begin);
            trace.deviation += fit.deviation + gap;
            let begin = match state.get("timestamp") {
                None => Begin::Unsaid,
                Some(_) => Begin::At(stamp(state, "timestamp")?),
            };
            return Ok((route::agent(id, &trace, vehicle, 0.0), begin));
        }
        let [x, y] = at.ok_or_else(|| state.missing("mobileRobotPosition"))?;
        if !state.list("nodeStates")?.is_empty() {
            self.warnings
                .lose(format_args!("{}: its way is told by nodeStates only, give its order instead", state.name));
        } else if moves(state)? || !state.list("edgeStates")?.is_empty() {
            self.warnings.lose(format_args!("{}: its way, as it moves and does not say where to", state.name));
        }
        let motion = MotionSpec::RestToRest { v_max: vehicle.speed, a_max: vehicle.acceleration };
        let Vehicle { radius, margin, .. } = *vehicle;
        let stands = Agent::disc(id, radius, [x, y, heading.unwrap_or(0.0)], Vec::new(), motion);
        // Without a heading it is the disc around its outline.
        let footprint = vehicle.footprint.clone().filter(|_| heading.is_some());
        Ok((Agent { footprint, margin, ..stands }, Begin::Never))
    }

    /// The planned path must end at the last released node; otherwise the vehicle drives on beyond its end. Warns if it does not.
    fn goes_on(&mut self, state: &Object<'_>, end: [f64; 2], traversed: &[Value]) -> Result<(), ImportError> {
        let nodes = parts(state, "nodeStates", "node", "nodeId")?;
        let last = nodes.iter().take_while(|node| node.released).last();
        let Some(last) = last else {
            let edges = parts(state, "edgeStates", "edge", "edgeId")?;
            if let Some(edge) = edges.iter().find(|edge| edge.released && nodes.is_empty()) {
                self.warnings
                    .lose(format_args!("{}: where it leads, as there is no node in nodeStates", edge.object.name));
            }
            return Ok(());
        };
        let name = last.object.text("nodeId")?;
        let is_there = match position(Some(last), "nodePosition")? {
            Some(node) => (node[0] - end[0]).hypot(node[1] - end[1]) <= GAP,
            None => traversed.iter().any(|node| node.as_str() == name),
        };
        if !is_there {
            let problem = "its way on to there, as its path ends before or elsewhere; give its order instead";
            self.warnings.lose(format_args!("{}: {problem}", last.object.name));
        }
        Ok(())
    }

    /// The agent on a polyline with times, when it begins \[s\], and where it ends.
    fn timed(
        &mut self,
        id: u64,
        state: &Object<'_>,
        path: &Object<'_>,
        at: Option<[f64; 2]>,
        radius: f64,
    ) -> Result<(Agent, f64, [f64; 2]), ImportError> {
        let mut stops = Vec::new();
        if let Some(at) = at {
            stops.push((at, stamp(state, "timestamp")?));
        }
        for (k, value) in path.list("polyline")?.iter().enumerate() {
            let point = Object::new(format!("{}, point {}", path.name, k + 1), value)?;
            stops.push((point.point()?, stamp(&point, "eta")?));
        }
        let begin = stops.first().map_or(0.0, |(_, time)| *time);
        stops.iter_mut().for_each(|(_, time)| *time -= begin);
        let named = |error| ImportError::new(format!("{}: {error}", path.name));
        let agent = timed::agent(id, radius, &stops).map_err(named)?;
        Ok((agent, begin, stops.last().map_or([0.0; 2], |(end, _)| *end)))
    }
}

/// A time stamp \[s\].
fn stamp(object: &Object<'_>, field: &str) -> Result<f64, ImportError> {
    match object.text(field)? {
        None => Err(object.missing(field)),
        Some(text) => seconds(text)
            .ok_or_else(|| ImportError::new(format!("{}, {field}: {text:?} is not a time stamp", object.name))),
    }
}

/// Whether an allowed deviation, a number or the half axes of an ellipse, allows any.
fn allows(deviation: &Value) -> bool {
    let above = |value: &Value| value.as_f64().is_some_and(|allowed| allowed > 0.0);
    above(deviation) || ["a", "b"].iter().any(|axis| deviation.get(axis).is_some_and(above))
}

/// Whether a vehicle says that it moves.
fn moves(state: &Object<'_>) -> Result<bool, ImportError> {
    let mut moves = state.flag("driving")?.unwrap_or(false);
    if let Some(velocity) = state.object("velocity")? {
        for field in ["vx", "vy", "omega"] {
            moves |= velocity.number(field)?.is_some_and(|speed| speed != 0.0);
        }
    }
    Ok(moves)
}

/// Position of a node, where it has one.
fn position(node: Option<&Part<'_>>, field: &str) -> Result<Option<[f64; 2]>, ImportError> {
    let Some(node) = node else { return Ok(None) };
    node.object.object(field)?.map(|position| position.point()).transpose()
}

/// Checks that an edge joins the nodes before and after it, where it names its nodes.
fn joins(edge: &Object<'_>, before: Option<&Part<'_>>, after: Option<&Part<'_>>) -> Result<(), ImportError> {
    for (field, node) in [("startNodeId", before), ("endNodeId", after)] {
        let there = node.map(|node| node.object.text("nodeId")).transpose()?.flatten();
        let named = edge.text(field)?;
        if named.is_some() && named != there {
            let (named, there) = (named.unwrap_or_default(), there.unwrap_or_default());
            return Err(ImportError::new(format!("{}, {field}: {named}, but by sequenceId it is {there}", edge.name)));
        }
    }
    Ok(())
}

/// Follows a trajectory from node to node; returns where the path then is, and the largest gap to a node \[m\].
fn follow(
    tracer: &mut Tracer,
    edge: &Object<'_>,
    pieces: &[Placed],
    from: Option<[f64; 2]>,
    to: Option<[f64; 2]>,
) -> Result<([f64; 2], f64), ImportError> {
    let ends = pieces.first().zip(pieces.last()).map(|(first, last)| [first.at, last.end()]);
    let Some([begin, end]) = ends.or(from.map(|at| [at; 2])) else {
        return Err(ImportError::new(format!("{}: a trajectory of length 0, and no position", edge.name)));
    };
    let mut widest = 0.0_f64;
    for (point, node, place) in [(begin, from, "begins"), (end, to, "ends")] {
        let gap = node.map_or(0.0, |node| (point[0] - node[0]).hypot(point[1] - node[1]));
        if gap > GAP {
            return Err(ImportError::new(format!("{}: its trajectory {place} {gap:.3} m from its node", edge.name)));
        }
        widest = widest.max(gap);
    }
    pieces.iter().for_each(|piece| tracer.follow(piece));
    Ok((end, if widest > CLOSED { widest } else { 0.0 }))
}
