//! The agent of a state: on its path with times, on its planned path from rest, or where it stands.

use super::super::json_access::JsonObject;
use super::super::path_builder::{LimitedPath, LimitedPathBuilder};
use super::super::vehicle::Facing;
use super::super::{ImportError, VehicleTraits, WarningCode, route, timed_paths, vehicle_heading};
use super::agent_start::{AgentStart, stamp};
use super::order_element::{OrderElement, check, parts};
use super::{ACTIONS, GAP, Vda5050Reader, gap, keys};
use crate::footprint::Footprint;
use crate::json::JsonNode;
use crate::scenario::{Agent, MotionSpec, PlacedSegment};
use std::f64::consts::PI;

/// Angle between a vehicle and its path that is taken for the error of its localization \[rad\].
const SEEN: f64 = 0.15;

/// Where a vehicle says that it is.
struct ReportedPose {
    at: Option<[f64; 2]>,
    heading: Option<f64>,
}

impl Vda5050Reader<'_> {
    /// The agent of a state, and when it begins.
    pub(super) fn state(
        &mut self,
        id: u64,
        state: &JsonObject<'_>,
        vehicle: &VehicleTraits,
    ) -> Result<(Agent, AgentStart), ImportError> {
        keys::STATE.check(state, self.warnings)?;
        let pose = self.pose(state)?;
        let nodes = parts(state, "nodeStates", "node", "nodeId")?;
        check(&nodes, &keys::NODE, self.warnings)?;
        check(&parts(state, "edgeStates", "edge", "edgeId")?, &keys::EDGE_STATE, self.warnings)?;
        for (field, keys) in [("velocity", keys::VELOCITY), ("safetyState", keys::SAFETY)] {
            if let Some(object) = state.object(field)? {
                keys.check(&object, self.warnings)?;
            }
        }
        let positions = nodes.iter().filter(|node| node.released).map(|node| node.object.object("nodePosition"));
        self.maps(state, std::iter::once(position(state)).chain(positions))?;
        let planned = state.object("plannedPath")?;
        if let Some(path) = timed_path(state)? {
            if planned.is_some() {
                let problem = "its plannedPath, which goes on where the times of its intermediatePath end";
                self.warnings.lose(state.error(format_args!("{problem}")));
            }
            return self.timed(id, state, &path, &pose, vehicle);
        }
        match planned {
            Some(path) => self.planned(id, state, &path, &pose, vehicle),
            None => Ok((self.stands(id, state, &pose, vehicle)?, AgentStart::Never)),
        }
    }

    /// Where the vehicle is; it has to know that.
    fn pose(&mut self, state: &JsonObject<'_>) -> Result<ReportedPose, ImportError> {
        let Some(pose) = position(state)? else { return Ok(ReportedPose { at: None, heading: None }) };
        keys::POSITION.check(&pose, self.warnings)?;
        let unknown = |field: &str| Err(pose.field_error(field, "it does not know where it is"));
        for field in ["localized", "positionInitialized"] {
            if pose.flag(field)? == Some(false) {
                return unknown(field);
            }
        }
        if pose.number("localizationScore")?.is_some_and(|score| score <= 0.0) {
            return unknown("localizationScore");
        }
        Ok(ReportedPose { at: Some(pose.point()?), heading: vehicle_heading::theta(&pose)? })
    }

    /// The agent on a path with times. It is a disc: how long turns take is not in the file.
    fn timed(
        &mut self,
        id: u64,
        state: &JsonObject<'_>,
        path: &JsonObject<'_>,
        pose: &ReportedPose,
        vehicle: &VehicleTraits,
    ) -> Result<(Agent, AgentStart), ImportError> {
        keys::INTERMEDIATE.check(path, self.warnings)?;
        let mut stops = Vec::new();
        if let Some(at) = pose.at {
            stops.push((at, stamp(state, "timestamp")?));
        }
        for (k, value) in path.list("polyline")?.iter().enumerate() {
            let point = JsonObject::new(format!("{}, point {}", path.name, k + 1), value)?;
            keys::TIMED_POINT.check(&point, self.warnings)?;
            stops.push((point.point()?, stamp(&point, "eta")?));
        }
        let begin = stops.first().map(|(_, time)| *time).unwrap_or_default();
        let stops: Vec<timed_paths::TimedPoint> = stops.into_iter().map(|(at, time)| (at, time.since(begin))).collect();
        let end = stops.last().map_or([0.0; 2], |(end, _)| *end);
        let named = |error| path.error(error);
        let agent = timed_paths::agent(id, vehicle.radius, &stops).map_err(named)?;
        self.leads_somewhere(state, agent.path.is_empty())?;
        self.goes(state)?;
        let radius = agent.radius + self.goes_on(state, end, &[])?;
        Ok((Agent { radius, margin: vehicle.margin, ..agent }, AgentStart::At(begin)))
    }

    /// The agent on its planned path, from rest.
    fn planned(
        &mut self,
        id: u64,
        state: &JsonObject<'_>,
        path: &JsonObject<'_>,
        pose: &ReportedPose,
        vehicle: &VehicleTraits,
    ) -> Result<(Agent, AgentStart), ImportError> {
        keys::PLANNED.check(path, self.warnings)?;
        let trajectory = path.object("trajectory")?.ok_or_else(|| path.missing("trajectory"))?;
        let read = self.trajectory(&trajectory, vehicle)?;
        let [begin, end] = read.ends;
        let before = pose.at.map_or(0.0, |at| gap(at, begin));
        if before > GAP {
            return Err(path.error(format_args!("it begins {before:.3} m from where the vehicle is")));
        }
        let pieces = &read.fit.pieces;
        self.leads_somewhere(state, pieces.is_empty())?;
        self.goes(state)?;
        let behind = self.goes_on(state, end, path.list("traversedNodes")?)?;
        if moves(state)? {
            self.warnings.add(
                WarningCode::MovesAlready,
                &state.name,
                "it moves already; its plannedPath is travelled from rest",
            );
        }
        let mut tracer = LimitedPathBuilder::default();
        pieces.iter().for_each(|piece| tracer.follow(piece));
        let mut trace = tracer.finish(pose.at.unwrap_or(begin));
        trace.deviation += read.fit.deviation + before.max(behind);
        trace.turned += read.fit.heading_error;
        let mut facing = Facing::Ahead;
        if let Some(outline) = &vehicle.footprint {
            let askew;
            (facing, askew) = self.faces(state, pose, pieces, outline)?;
            trace.turned += askew;
            set_heading(&mut trace, pose, pieces);
        }
        let begin = match state.get("timestamp") {
            None => AgentStart::Unsaid,
            Some(_) => AgentStart::At(stamp(state, "timestamp")?),
        };
        Ok((route::agent(id, &trace, &vehicle.facing(facing), 0.0), begin))
    }

    /// The agent that stands where it is, unless it says that it goes on.
    fn stands(
        &mut self,
        id: u64,
        state: &JsonObject<'_>,
        pose: &ReportedPose,
        vehicle: &VehicleTraits,
    ) -> Result<Agent, ImportError> {
        let [x, y] = pose.at.ok_or_else(|| state.missing("mobileRobotPosition"))?;
        if !state.list("nodeStates")?.is_empty() {
            self.warnings.lose(state.error(format_args!("its way is told by nodeStates only, give its order instead")));
        } else if moves(state)? || !state.list("edgeStates")?.is_empty() {
            self.lose_way(state);
        }
        let motion = MotionSpec::RestToRest { v_max: vehicle.speed, a_max: vehicle.acceleration };
        let VehicleTraits { radius, margin, .. } = *vehicle;
        let stands = Agent::disc(id, radius, [x, y, pose.heading.unwrap_or(0.0)], Vec::new(), motion);
        // Without a heading it is the disc around its outline.
        let footprint = vehicle.footprint.clone().filter(|_| pose.heading.is_some());
        Ok(Agent { footprint, margin, ..stands })
    }

    /// What moves does not stay where its path has no length.
    fn leads_somewhere(&mut self, state: &JsonObject<'_>, is_point: bool) -> Result<(), ImportError> {
        if is_point && moves(state)? {
            self.lose_way(state);
        }
        Ok(())
    }

    /// What is halted does not say when it goes on along its path; actions may halt it.
    fn goes(&mut self, state: &JsonObject<'_>) -> Result<(), ImportError> {
        if let Some(halt) = halt(state)? {
            self.warnings.lose(state.error(format_args!("when it goes on along its path, as {halt}")));
        }
        let mut acts = false;
        for (k, action) in state.list("actionStates")?.iter().enumerate() {
            let action = JsonObject::new(format!("{}, actionState {}", state.name, k + 1), action)?;
            acts |= action.text("actionStatus")?.is_some_and(|status| !["FINISHED", "FAILED"].contains(&status));
        }
        if acts {
            self.warnings.add(WarningCode::Actions, &state.name, ACTIONS);
        }
        Ok(())
    }

    fn lose_way(&mut self, state: &JsonObject<'_>) {
        self.warnings.lose(state.error(format_args!("its way, as it moves and does not say where to")));
    }

    /// Which way an outline faces on its planned path: along it, or backward if the vehicle does so where it is. Returns by how much it
    /// is turned from that as well, as far as this is the error of a measurement \[rad\].
    fn faces(
        &mut self,
        state: &JsonObject<'_>,
        pose: &ReportedPose,
        pieces: &[PlacedSegment],
        outline: &Footprint,
    ) -> Result<(Facing, f64), ImportError> {
        let first = pieces.first().map(|first| first.heading);
        let seen = pose.heading.zip(first);
        let off = |turned: f64| {
            seen.map_or(0.0, |(theta, heading)| vehicle_heading::askew(outline, theta - heading - turned))
        };
        // Where it turns back on its way, it may go on in the other gear.
        let of_curve = vehicle_heading::of_curve(pieces);
        let (facing, turned) = match (off(PI) < off(0.0), of_curve) {
            (true, Facing::Ahead) => (Facing::Backward, PI),
            (false, _) => (of_curve, 0.0),
            (true, _) => (of_curve, PI),
        };
        let mut askew = off(turned);
        if askew > SEEN {
            vehicle_heading::lose(state, "theta", pose.heading.unwrap_or_default(), self.warnings);
            askew = 0.0;
        }
        for node in parts(state, "nodeStates", "node", "nodeId")?.iter().filter(|node| node.released) {
            let Some((at, theta)) = node.position()?.zip(node.theta()?) else { continue };
            // Which of several passes is meant is not known: any of them may be.
            let mut passes =
                pieces.iter().filter_map(|piece| vehicle_heading::heading_beside(piece, at, GAP)).peekable();
            if passes.peek().is_none() && !pieces.is_empty() {
                let problem = format_args!("its theta {theta}, as the planned path does not pass it");
                self.warnings.lose(node.object.error(problem));
            } else if !passes.any(|heading| {
                let either =
                    facing == Facing::Either && vehicle_heading::is_ahead(outline, theta - heading - turned - PI);
                either || vehicle_heading::is_ahead(outline, theta - heading - turned)
            }) {
                vehicle_heading::lose(&node.object, "theta", theta, self.warnings);
            }
        }
        Ok((facing, askew))
    }

    /// How far the last node that is released is from the end of a path \[m\], which has to be there: the vehicle does not stand where it
    /// ends else.
    fn goes_on(
        &mut self,
        state: &JsonObject<'_>,
        end: [f64; 2],
        traversed: &[JsonNode<'_>],
    ) -> Result<f64, ImportError> {
        let nodes = parts(state, "nodeStates", "node", "nodeId")?;
        let Some(last) = nodes.iter().take_while(|node| node.released).last() else {
            self.no_edge(state, &nodes)?;
            return Ok(0.0);
        };
        let behind = match last.position()? {
            Some(node) => Some(gap(node, end)).filter(|gap| *gap <= GAP),
            None => {
                let name = last.object.text("nodeId")?;
                traversed.iter().any(|node| node.as_str() == name).then_some(0.0)
            }
        };
        if behind.is_none() {
            let problem = "its way on to there, as its path ends before or elsewhere; give its order instead";
            self.warnings.lose(last.object.error(format_args!("{problem}")));
        }
        Ok(behind.unwrap_or(0.0))
    }

    /// Without nodes no edge is ahead of which anything is known.
    fn no_edge(&mut self, state: &JsonObject<'_>, nodes: &[OrderElement<'_>]) -> Result<(), ImportError> {
        let edges = parts(state, "edgeStates", "edge", "edgeId")?;
        if let Some(edge) = edges.iter().find(|edge| edge.released && nodes.is_empty()) {
            self.warnings.lose(edge.object.error(format_args!("where it leads, as there is no node in nodeStates")));
        }
        Ok(())
    }
}

/// Where the vehicle is, in version 3 or 2.
pub(in crate::import) fn position<'j>(state: &JsonObject<'j>) -> Result<Option<JsonObject<'j>>, ImportError> {
    match state.object("mobileRobotPosition")? {
        None => state.object("agvPosition"),
        pose => Ok(pose),
    }
}

/// Why the vehicle does not go along its path now, if it says so.
fn halt(state: &JsonObject<'_>) -> Result<Option<String>, ImportError> {
    if state.flag("paused")? == Some(true) {
        return Ok(Some("it is paused".into()));
    }
    if let Some(mode) = state.text("operatingMode")?.filter(|mode| !["AUTOMATIC", "SEMIAUTOMATIC"].contains(mode)) {
        return Ok(Some(format!("its operatingMode is {mode}")));
    }
    let Some(safety) = state.object("safetyState")? else { return Ok(None) };
    // Names in versions 3 and 2.
    for field in ["activeEmergencyStop", "eStop"] {
        if let Some(stop) = safety.text(field)?.filter(|stop| *stop != "NONE") {
            return Ok(Some(format!("its {field} is {stop}")));
        }
    }
    Ok((safety.flag("fieldViolation")? == Some(true)).then(|| "there is something in its protective field".into()))
}

/// The path with times, if it has a point: without any it says nothing.
fn timed_path<'j>(state: &JsonObject<'j>) -> Result<Option<JsonObject<'j>>, ImportError> {
    let Some(path) = state.object("intermediatePath")? else { return Ok(None) };
    Ok(if path.list("polyline")?.is_empty() { None } else { Some(path) })
}

/// An outline of which nobody knows which way it faces is the disc around it; one that does not move faces as it says.
fn set_heading(trace: &mut LimitedPath, pose: &ReportedPose, pieces: &[PlacedSegment]) {
    match pose.heading {
        None => trace.faces = false,
        Some(theta) if pieces.is_empty() => (trace.start[2], trace.faces) = (theta, true),
        Some(_) => {}
    }
}

/// Whether a vehicle says that it moves.
fn moves(state: &JsonObject<'_>) -> Result<bool, ImportError> {
    let mut moves = state.flag("driving")?.unwrap_or(false);
    if let Some(velocity) = state.object("velocity")? {
        for field in ["vx", "vy", "omega"] {
            moves |= velocity.number(field)?.is_some_and(|speed| speed != 0.0);
        }
    }
    Ok(moves)
}
