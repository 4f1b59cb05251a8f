//! The agent of an order: from node to node, along its trajectories or straight.

use super::super::json_access::JsonObject;
use super::super::path_builder::LimitedPathBuilder;
use super::super::trajectory::FittedTrajectory;
use super::super::vehicle::Facing;
use super::super::warnings::{DIFFERENCE, LENGTH};
use super::super::{ImportError, WarningCode, corridor, route, vehicle_heading};
use super::order_element::{OrderElement, check, parts};
use super::{ACTIONS, GAP, Vda5050Reader, gap, keys};
use crate::footprint::Footprint;
use crate::json::JsonNode;
use crate::scenario::{Agent, PlacedSegment};
use crate::vda5050::version::ProtocolVersion;
use std::f64::consts::PI;

/// How an order is travelled up to some node.
#[derive(Default)]
struct OrderPathBuilder {
    /// Along its heading, and as it faces on the edges.
    tracers: [LimitedPathBuilder; 2],
    /// Headings of each edge at both ends; none where it has no length.
    headings: Vec<Option<[f64; 2]>>,
    position: Option<[f64; 2]>,
    deviation: f64,
    /// Largest difference of the headings at the same length \[rad\].
    turned: f64,
    /// By which the vehicle may be ahead of its path, or behind.
    longer: f64,
    /// How far it may leave its edges \[m\].
    room: f64,
    /// Which way it faces on each of its edges.
    facings: Vec<Facing>,
}

impl Vda5050Reader<'_> {
    /// The agent of an order, and the radius of its vehicle with the room that the order gives it.
    pub(super) fn order(&mut self, id: u64, order: &JsonObject<'_>) -> Result<(Agent, f64), ImportError> {
        keys::ORDER.check(order, self.warnings)?;
        let [nodes, edges] = self.base(order)?;
        let is_third = is_third(order)?;
        self.maps(order, nodes.iter().map(|node| node.object.object("nodePosition")))?;
        self.warn_of_freedom(&nodes)?;
        let mut way = OrderPathBuilder { position: position(nodes.first())?, ..OrderPathBuilder::default() };
        if way.position.is_none() && edges.is_empty() {
            return Err(nodes.first().map_or_else(|| order.missing("nodes"), unplaced));
        }
        for (edge, ends) in edges.iter().zip(nodes.windows(2)) {
            if let [before, after] = ends {
                self.edge(&mut way, &edge.object, [before, after], is_third)?;
            }
        }
        let stands = way.headings.iter().all(Option::is_none);
        let outline = self.vehicle.footprint.as_ref();
        // What stands faces as its nodes say.
        let moves = |_: &Facing| !stands || way.room > 0.0;
        let in_gears = !stands && outline.is_some() && Facing::changes(way.facings.iter().copied());
        let facing = way.facings.iter().copied().reduce(Facing::then).filter(moves).unwrap_or_default();
        if let Some(outline) = outline.filter(|_| !stands && (in_gears || facing != Facing::Any)) {
            self.thetas(&nodes, &way, outline)?;
        }
        self.warn_of_actions(order, nodes.iter().chain(&edges))?;
        let [in_one_gear, geared] = way.tracers;
        let tracer = if in_gears { geared } else { in_one_gear };
        let mut trace = tracer.finish(way.position.unwrap_or_default());
        trace.deviation += way.deviation.max(way.longer) + way.room;
        trace.turned += way.turned;
        if stands && let Some(theta) = rests(&nodes, outline)? {
            (trace.start[2], trace.faces) = (theta, true);
        }
        let vehicle = if in_gears { self.vehicle.clone() } else { self.vehicle.facing(facing) };
        Ok((route::agent(id, &trace, &vehicle, 0.0), self.vehicle.radius + way.room))
    }

    /// Nodes and edges of the base, or all of them if that is asked for; `updates` has checked that they are one way.
    fn base<'j>(&mut self, order: &JsonObject<'j>) -> Result<[Vec<OrderElement<'j>>; 2], ImportError> {
        let mut nodes = parts(order, "nodes", "node", "nodeId")?;
        let mut edges = parts(order, "edges", "edge", "edgeId")?;
        // Also of what is left out below.
        check(&nodes, &keys::NODE, self.warnings)?;
        check(&edges, &keys::EDGE, self.warnings)?;
        let base = nodes.iter().skip(1).zip(&edges).take_while(|(node, edge)| node.released && edge.released).count();
        if base < edges.len() {
            if self.options.horizon {
                self.warnings.use_option("horizon");
            } else {
                let ahead = format!(
                    "{} of {} edges are not released and left out (--horizon)",
                    edges.len() - base,
                    edges.len()
                );
                self.warnings.add(WarningCode::NotReleased, &order.name, ahead);
                nodes.truncate(base + 1);
                edges.truncate(base);
            }
        }
        Ok([nodes, edges])
    }

    /// Says at which nodes the vehicle may pass beside them, which is not read.
    fn warn_of_freedom(&mut self, nodes: &[OrderElement<'_>]) -> Result<(), ImportError> {
        let outline = self.vehicle.footprint.is_some();
        for node in nodes {
            let Some(position) = node.object.object("nodePosition")? else { continue };
            let allowed = |field: &str| position.get(field).is_some_and(allows);
            // Of both spellings the second one is that of the schema of 2.0.
            if let Some(field) = ["allowedDeviationXY", "allowedDeviationXy"].into_iter().find(|field| allowed(field)) {
                let problem = format!("its {field} is not read; the vehicle is taken to pass the node itself");
                self.warnings.add(WarningCode::AllowedDeviation, &node.object.name, problem);
            }
            if outline && allowed("allowedDeviationTheta") {
                let problem = "its allowedDeviationTheta is not read; the vehicle is taken to face along its path";
                self.warnings.add(WarningCode::Orientation, &node.object.name, problem);
            }
        }
        Ok(())
    }

    /// Says that actions are not read, of nodes or of edges.
    fn warn_of_actions<'p, 'j: 'p>(
        &mut self,
        order: &JsonObject<'_>,
        parts: impl Iterator<Item = &'p OrderElement<'j>>,
    ) -> Result<(), ImportError> {
        let mut acts = false;
        for part in parts {
            acts |= !part.object.list("actions")?.is_empty();
        }
        if acts {
            self.warnings.add(WarningCode::Actions, &order.name, ACTIONS);
        }
        Ok(())
    }

    /// Goes on along an edge.
    fn edge(
        &mut self,
        way: &mut OrderPathBuilder,
        edge: &JsonObject<'_>,
        ends: [&OrderElement<'_>; 2],
        is_third: bool,
    ) -> Result<(), ImportError> {
        let room = corridor::read(edge, self.vehicle, self.warnings)?.filter(|room| *room > 0.0);
        way.room = way.room.max(room.unwrap_or_default());
        // Within its room it may face any way.
        let within = |facing: Facing| if room.is_some() { Facing::Any } else { facing };
        let speed = either(edge, ["maxSpeed", "maximumSpeed"])?;
        let rotation = either(edge, ["maxRotationSpeed", "maximumRotationSpeed"])?;
        way.tracers.iter_mut().for_each(|tracer| tracer.limit(speed, rotation));
        let target = ends[1].position()?;
        let Some(trajectory) = edge.object("trajectory")? else {
            let from = way.position.ok_or_else(|| unplaced(ends[0]))?;
            let to = target.ok_or_else(|| unplaced(ends[1]))?;
            let ahead = Some((to[1] - from[1]).atan2(to[0] - from[0])).filter(|_| from != to);
            way.faces(within(self.facing(edge, is_third, ahead, &[])?));
            way.line(from, to, ahead);
            return self.has_length(edge, gap(from, to));
        };
        let trajectory = trajectory.called(format!("{}, trajectory", edge.name));
        let vehicle = self.vehicle;
        let read = self.trajectory(&trajectory, vehicle)?;
        way.faces(within(self.facing(edge, is_third, None, &read.fit.pieces)?));
        way.follow(edge, &read, target)?;
        self.has_length(edge, read.fit.pieces.iter().map(|piece| piece.shape.length()).sum())
    }

    /// Says where an edge is longer or shorter than its geometry.
    fn has_length(&mut self, edge: &JsonObject<'_>, drawn: f64) -> Result<(), ImportError> {
        // 0 is what senders write that do not know it.
        let typed = edge.number("length")?.filter(|typed| *typed != 0.0);
        if typed.is_some_and(|typed| (typed - drawn).abs() > DIFFERENCE * drawn + GAP) {
            self.warnings.add(WarningCode::WrittenLength, &edge.name, LENGTH);
        }
        Ok(())
    }

    /// Which way an outline faces on an edge, which has this heading where it is straight.
    fn facing(
        &self,
        edge: &JsonObject<'_>,
        is_third: bool,
        heading: Option<f64>,
        pieces: &[PlacedSegment],
    ) -> Result<Facing, ImportError> {
        if self.vehicle.footprint.is_none() {
            return Ok(Facing::Ahead);
        }
        let orientation = edge.number("orientation")?;
        let said = vehicle_heading::of_edge(edge, "orientation", orientation.as_slice(), heading)?;
        // One that rotates on the edge has any heading there.
        let reaches = edge.flag("reachOrientationBeforeEntering")?;
        if edge.flag("rotationAllowed")? == Some(true) || reaches == Some(false) || is_third && said.is_none() {
            return Ok(Facing::Any);
        }
        Ok(said.unwrap_or_else(|| vehicle_heading::of_curve(pieces)))
    }

    /// An outline at a node is as the path arrives there, or as it departs.
    fn thetas(
        &mut self,
        nodes: &[OrderElement<'_>],
        way: &OrderPathBuilder,
        outline: &Footprint,
    ) -> Result<(), ImportError> {
        let edges: Vec<(&Option<[f64; 2]>, &Facing)> = way.headings.iter().zip(&way.facings).collect();
        let at = |edge: usize, end: usize| {
            let (headings, facing) = edges.get(edge)?;
            headings.map(|headings| (headings[end], facing.angle_at(headings[end])))
        };
        for (k, node) in nodes.iter().enumerate() {
            let Some(theta) = node.theta()? else { continue };
            let arrives = k.checked_sub(1).and_then(|before| at(before, 1));
            let is_there = |(heading, angle): (f64, Option<f64>)| {
                let mut angles = angle.map_or([0.0, PI], |angle| [angle; 2]).into_iter();
                angles.any(|angle| vehicle_heading::is_ahead(outline, theta - heading - angle))
            };
            if !arrives.into_iter().chain(at(k, 0)).any(is_there) {
                vehicle_heading::lose(&node.object, "theta", theta, self.warnings);
            }
        }
        Ok(())
    }
}

impl OrderPathBuilder {
    /// The vehicle faces so on the next edge.
    fn faces(&mut self, next: Facing) {
        self.tracers[1].face_as(next);
        self.facings.push(next);
    }

    fn line(&mut self, from: [f64; 2], to: [f64; 2], ahead: Option<f64>) {
        self.tracers.iter_mut().for_each(|tracer| tracer.line(from, to));
        self.headings.push(ahead.map(|heading| [heading; 2]));
        self.position = Some(to);
    }

    /// Follows a trajectory from where the way is to the node at its end, if these have places.
    fn follow(
        &mut self,
        edge: &JsonObject<'_>,
        read: &FittedTrajectory,
        target: Option<[f64; 2]>,
    ) -> Result<(), ImportError> {
        let FittedTrajectory { fit, ends: [begin, end] } = read;
        let mut widest = 0.0_f64;
        for (point, node, place) in [(*begin, self.position, "begins"), (*end, target, "ends")] {
            let gap = node.map_or(0.0, |node| gap(point, node));
            if gap > GAP {
                return Err(edge.error(format_args!("its trajectory {place} {gap:.3} m from its node")));
            }
            widest = widest.max(gap);
        }
        fit.pieces.iter().for_each(|piece| self.tracers.iter_mut().for_each(|tracer| tracer.follow(piece)));
        let ends = fit.pieces.first().zip(fit.pieces.last());
        self.headings.push(ends.map(|(first, last)| [first.heading, last.heading_at_end()]));
        self.position = Some(*end);
        self.deviation = self.deviation.max(fit.deviation + self.longer + widest);
        self.turned = self.turned.max(fit.heading_error + route::turn_over(&fit.pieces, self.longer));
        self.longer += fit.length_error;
        Ok(())
    }
}

/// Which way a vehicle faces that stays where it is, if that is one way: one that turns there covers the disc around its outline.
fn rests(nodes: &[OrderElement<'_>], outline: Option<&Footprint>) -> Result<Option<f64>, ImportError> {
    let thetas = nodes.iter().map(OrderElement::theta).collect::<Result<Vec<_>, _>>()?;
    let Some(first) = thetas.first().copied().flatten() else { return Ok(None) };
    let turns =
        |outline: &Footprint| thetas.iter().flatten().any(|theta| !vehicle_heading::is_ahead(outline, theta - first));
    Ok(Some(first).filter(|_| !outline.is_some_and(turns)))
}

/// Position of a node, where it has one.
fn position(node: Option<&OrderElement<'_>>) -> Result<Option<[f64; 2]>, ImportError> {
    node.map_or(Ok(None), OrderElement::position)
}

fn unplaced(node: &OrderElement<'_>) -> ImportError {
    node.object.missing("nodePosition")
}

/// A limit under its name in version 2 or that in version 3; the lower one of both.
fn either(edge: &JsonObject<'_>, names: [&str; 2]) -> Result<Option<f64>, ImportError> {
    let [second, third] = names.map(|name| edge.positive(name));
    Ok(second?.into_iter().chain(third?).reduce(f64::min))
}

/// Whether an allowed deviation, a number or the half axes of an ellipse, allows any.
fn allows(deviation: &JsonNode<'_>) -> bool {
    let above = |value: &JsonNode<'_>| value.as_f64().is_some_and(|allowed| allowed > 0.0);
    above(deviation) || ["a", "b"].iter().any(|axis| deviation.get(axis).is_some_and(above))
}

/// Whether an order is of version 3, which leaves it to the vehicle how it faces on an edge that says nothing of it. `updates` has checked
/// that its version is known.
fn is_third(order: &JsonObject<'_>) -> Result<bool, ImportError> {
    Ok(order.text("version")?.and_then(ProtocolVersion::parse) == Some(ProtocolVersion::V3_0))
}
