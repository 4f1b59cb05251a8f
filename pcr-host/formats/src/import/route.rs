//! Routes on a layout: the shortest way from node to node, and its path.
//!
//! Corners between straight edges are rounded if the layout has a rule for it, which is that of nav2: an arc of radius
//! R touches both edges at the distance R / tan(α/2) from the node, where α is the angle between them. The arc is left
//! out if this distance is not less than the rest of the edge before (the arc of the previous corner has taken its
//! part), or than the edge after. Without an arc the vehicle stops and turns.

use super::layout::{Layout, LayoutEdge};
use super::path_builder::{LimitedPath, LimitedPathBuilder};
use super::vehicle::{Facing, RouteRequest};
use super::{ImportError, ImportOptions, VehicleTraits, WarningCode, Warnings, speed, vehicle_heading};
use crate::plane_geometry::distance;
use crate::scenario::PlacedSegment;
use crate::scenario::{Agent, PathSegment, Scenario, label};
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::fmt;

/// Angle between edges that nav2 takes as straight, or as turning back \[rad\].
const SHALLOW: f64 = 1e-9;

/// Largest gap between a curve and its node: it counts as deviation of the path \[m\].
pub(super) const GAP: f64 = 0.05;

/// An edge, and whether it is travelled from its end to its beginning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RouteStep<'a> {
    /// The edge.
    pub edge: &'a LayoutEdge,
    /// From its end to its beginning.
    pub backward: bool,
}

impl LayoutEdge {
    /// The directions in which it may be travelled, also if it is closed.
    pub fn steps(&self) -> impl Iterator<Item = RouteStep<'_>> {
        let ways = [false, true].into_iter().filter(|&backward| self.ways[usize::from(backward)]);
        ways.map(|backward| RouteStep { edge: self, backward })
    }
}

impl RouteStep<'_> {
    /// The node from which it goes.
    pub fn origin(self) -> usize {
        self.edge.ends[usize::from(self.backward)]
    }

    /// The node to which it goes.
    pub fn target(self) -> usize {
        self.edge.ends[usize::from(!self.backward)]
    }

    /// Largest speed \[m/s\], where it is limited.
    pub fn speed(self) -> Option<f64> {
        self.edge.speed[usize::from(self.backward)]
    }

    /// The largest speed \[m/s\], up to this one, at which it can be travelled as a whole.
    pub fn steady(self, fastest: f64) -> f64 {
        let rotation = self.edge.rotation.unwrap_or(f64::INFINITY);
        let turns = self.facing().heading().is_none();
        let bends = self.edge.curve.iter().filter_map(|piece| match piece.shape {
            PathSegment::Arc { radius, .. } if turns => Some(radius * rotation),
            _ => None,
        });
        bends.chain(self.speed()).fold(fastest, f64::min)
    }

    /// Which way the vehicle faces, with respect to the direction of travel.
    pub fn facing(self) -> Facing {
        self.edge.facing[usize::from(self.backward)]
    }

    /// Largest distance from the curve in the file after the same length of travel \[m\]: backward, lengths count from the other end.
    pub fn deviation(self) -> f64 {
        self.edge.deviation + if self.backward { self.edge.longer } else { 0.0 }
    }

    /// Largest difference of the headings at the same length of travel \[rad\].
    pub fn turned(self) -> f64 {
        self.edge.turned + if self.backward { turn_over(&self.edge.curve, self.edge.longer) } else { 0.0 }
    }

    /// Its lines and arcs in the direction of travel.
    pub fn curve(self) -> Vec<PlacedSegment> {
        match self.backward {
            true => self.edge.curve.iter().rev().map(PlacedSegment::reversed).collect(),
            false => self.edge.curve.clone(),
        }
    }
}

/// A node that is reached, the nearest first; among equals the one of the lowest place.
#[derive(PartialEq)]
struct FrontierNode {
    length: f64,
    node: usize,
}

impl Eq for FrontierNode {}

impl Ord for FrontierNode {
    fn cmp(&self, other: &Self) -> Ordering {
        other.length.total_cmp(&self.length).then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for FrontierNode {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The edges of the shortest way, by length; of equally long ones that of the edges that come first in the file.
pub(super) fn shortest(layout: &Layout, ends: [usize; 2]) -> Option<Vec<RouteStep<'_>>> {
    cheapest(layout, ends, |step| step.edge.length())
}

/// The same by other costs, from 0; what costs an infinite amount is not travelled.
pub fn cheapest<'a>(
    layout: &'a Layout,
    [from, to]: [usize; 2],
    cost: impl Fn(RouteStep<'a>) -> f64,
) -> Option<Vec<RouteStep<'a>>> {
    let mut leaving = vec![Vec::new(); layout.nodes.len()];
    for step in layout.edges.iter().filter(|edge| !edge.closed).flat_map(LayoutEdge::steps) {
        if let Some(steps) = leaving.get_mut(step.origin()) {
            steps.push((step.origin(), step));
        }
    }
    let mut best = vec![(f64::INFINITY, None); layout.nodes.len()];
    best.get_mut(from)?.0 = 0.0;
    let mut heap = BinaryHeap::from([FrontierNode { length: 0.0, node: from }]);
    while let Some(FrontierNode { length, node }) = heap.pop() {
        if node == to {
            break;
        }
        if best.get(node).is_none_or(|(shorter, _)| *shorter < length) {
            continue;
        }
        for &(origin, step) in leaving.get(node)? {
            let total = length + cost(step);
            let target = best.get_mut(step.target())?;
            if total < target.0 {
                *target = (total, Some((origin, step)));
                heap.push(FrontierNode { length: total, node: step.target() });
            }
        }
    }
    let mut steps = Vec::new();
    let mut node = to;
    while node != from {
        let (origin, step) = best.get(node)?.1?;
        steps.push(step);
        node = origin;
    }
    steps.reverse();
    Some(steps)
}

/// The arcs that round the corners at the ends of some edges, where there is one.
fn corner_arcs(
    layout: &Layout,
    from: usize,
    steps: &[RouteStep<'_>],
    radius: Option<f64>,
) -> Vec<Option<PlacedSegment>> {
    let mut position = layout.position(from);
    let arc = |(k, step): (usize, &RouteStep<'_>)| {
        let target = layout.position(step.target());
        let next = steps.get(k + 1).filter(|next| step.edge.is_straight() && next.edge.is_straight());
        let arc = next
            .zip(radius)
            .and_then(|(next, radius)| corner_arc(position, target, layout.position(next.target()), radius));
        // A curve may end beside its node.
        let bent = if step.edge.is_straight() { None } else { step.curve().pop() };
        position = arc.or(bent).map_or(target, |last| last.end());
        arc
    };
    steps.iter().enumerate().map(arc).collect()
}

/// The path along some edges, from the node where it begins, on which the vehicle faces as its edges say, or which it travels along its
/// heading.
fn trace(layout: &Layout, from: usize, steps: &[RouteStep<'_>], in_gears: bool) -> Result<LimitedPath, ImportError> {
    let at = |node: usize| layout.position(node);
    let arcs = corner_arcs(layout, from, steps, layout.corner_radius);
    let mut tracer = LimitedPathBuilder::default();
    let mut position = at(from);
    // If curves and their arcs differ in length, the vehicle is ahead of its path, or behind it, from there on.
    let (mut deviation, mut turned, mut longer) = (0.0_f64, 0.0_f64, 0.0);
    for (k, (step, arc)) in steps.iter().zip(arcs).enumerate() {
        let (edge, target) = (step.edge, at(step.target()));
        tracer.limit(step.speed(), edge.rotation);
        tracer.face_as(if in_gears { step.facing() } else { Facing::Ahead });
        deviation = deviation.max(step.deviation() + longer);
        // Who keeps his heading is not turned with the curve.
        if !in_gears || step.facing().heading().is_none() {
            turned = turned.max(step.turned() + turn_over(&edge.curve, longer));
        }
        longer += edge.longer;
        let curve = step.curve();
        if !edge.is_straight() {
            let ends = curve.first().zip(curve.last()).map(|(first, last)| (first.start, last.end()));
            let (begin, end) = ends.unwrap_or((position, target));
            for (point, node, place) in [(begin, position, "begins"), (end, target, "ends")] {
                let gap = distance(point, node);
                if gap > GAP {
                    let name = &edge.id;
                    return Err(ImportError::new(format!("edge {name}: its curve {place} {gap:.3} m from its node")));
                }
            }
            curve.iter().for_each(|piece| tracer.follow(piece));
            position = end;
            continue;
        }
        match arc {
            Some(arc) => {
                tracer.line(position, arc.start);
                // It stands for the end of this edge and for the begin of the next one, whose limits may be others.
                let next = steps.get(k + 1).map(|next| (next.speed(), next.edge.rotation));
                match next.filter(|next| *next != (step.speed(), edge.rotation)) {
                    None => tracer.follow(&arc),
                    Some((speed, rotation)) => {
                        let half = arc.shape.length() / 2.0;
                        tracer.follow(&arc.part(0.0, half));
                        tracer.limit(speed, rotation);
                        tracer.follow(&arc.part(half, arc.shape.length()));
                    }
                }
                position = arc.end();
            }
            None => {
                tracer.line(position, target);
                position = target;
            }
        }
    }
    let mut trace = tracer.finish(position);
    trace.deviation += deviation;
    trace.turned += turned;
    Ok(trace)
}

/// Largest turn of lines and arcs over a length \[rad\].
pub(super) fn turn_over(pieces: &[PlacedSegment], length: f64) -> f64 {
    length * pieces.iter().filter_map(PlacedSegment::radius).fold(0.0, |most: f64, radius| most.max(radius.recip()))
}

impl LayoutEdge {
    /// Whether it is one line from node to node, or nothing.
    fn is_straight(&self) -> bool {
        match self.curve.as_slice() {
            [] => true,
            [only] => matches!(only.shape, PathSegment::Line { .. }) && self.deviation == self.room,
            _ => false,
        }
    }
}

impl Layout {
    /// Adds to every straight edge how far vehicles leave it where they round the corners at its ends with [`Layout::corner_radius`], and
    /// how far they are turned there. From then on the layout is one of places, not of routes: its corners are not rounded again.
    ///
    /// An arc of radius R for a turn by α is R (1 − cos(α/2)) off its edges. Every corner of two edges counts that some route may round.
    pub fn include_corners(&mut self) {
        /// Larger than the rounding of the closed form.
        const OUTWARD: f64 = 1.0 + 1e-12;
        let Some(radius) = self.corner_radius.take().filter(|radius| *radius > 0.0) else { return };
        let mut ends: Vec<[Vec<(usize, usize)>; 2]> = vec![Default::default(); self.nodes.len()];
        for (k, edge) in self.edges.iter().enumerate().filter(|(_, edge)| edge.is_straight()) {
            for step in edge.steps() {
                for (node, other, side) in [(step.target(), step.origin(), 0), (step.origin(), step.target(), 1)] {
                    if let Some(sides) = ends.get_mut(node) {
                        sides[side].push((k, other));
                    }
                }
            }
        }
        let mut off = vec![[0.0_f64; 2]; self.edges.len()];
        for (node, [incoming, outgoing]) in ends.iter().enumerate() {
            for &(before, from) in incoming {
                for &(after, to) in outgoing {
                    let [start, corner, end] = [from, node, to].map(|node| self.position(node));
                    let Some(PlacedSegment { shape: PathSegment::Arc { sweep, .. }, .. }) =
                        corner_arc(start, corner, end, radius)
                    else {
                        continue;
                    };
                    let half = 0.5 * sweep.abs();
                    // 1 - cos(a) without cancellation.
                    let leaves = OUTWARD * 2.0 * radius * (0.5 * half).sin().powi(2);
                    for edge in [before, after] {
                        off[edge] = [off[edge][0].max(leaves), off[edge][1].max(OUTWARD * half)];
                    }
                }
            }
        }
        for (edge, [leaves, turned]) in self.edges.iter_mut().zip(off) {
            edge.deviation += leaves;
            edge.turned += turned;
            self.corner_margin = self.corner_margin.max(leaves);
        }
    }
}

/// The arc with which nav2 rounds the corner between two edges, `None` where it leaves it out.
pub(super) fn corner_arc(start: [f64; 2], corner: [f64; 2], end: [f64; 2], radius: f64) -> Option<PlacedSegment> {
    let back = [start[0] - corner[0], start[1] - corner[1]];
    let onward = [end[0] - corner[0], end[1] - corner[1]];
    let [before, after] = [back, onward].map(|[x, y]| x.hypot(y));
    if before == 0.0 || after == 0.0 || radius == 0.0 {
        return None;
    }
    let cross = back[0] * onward[1] - back[1] * onward[0];
    let dot = back[0] * onward[0] + back[1] * onward[1];
    let angle = cross.abs().atan2(dot);
    if angle < SHALLOW || std::f64::consts::PI - angle < SHALLOW {
        return None;
    }
    let tangent = radius / (angle / 2.0).tan();
    if tangent >= before || tangent >= after {
        return None;
    }
    let at = [corner[0] + back[0] / before * tangent, corner[1] + back[1] / before * tangent];
    let heading = (-back[1]).atan2(-back[0]);
    // The way on lies to the left where the vector back lies to its left.
    let sweep = (std::f64::consts::PI - angle).copysign(-cross);
    Some(PlacedSegment { start: at, heading, shape: PathSegment::arc(radius, sweep) })
}

/// The routes that the options ask for as a scenario, an agent a route.
pub(super) fn scenario(
    layout: &Layout,
    vehicle: &VehicleTraits,
    options: &ImportOptions,
    warnings: &mut Warnings,
) -> Result<Scenario, ImportError> {
    if options.routes.is_empty() {
        let nodes = layout.nodes.iter().take(3).map(|node| node.id.to_string()).collect::<Vec<_>>().join(", ");
        return Err(ImportError::new(format!(
            "a layout has no agents; ask for routes with --route FROM:TO, from node to node (there are {} nodes: {nodes}, ...)",
            layout.nodes.len()
        )));
    }
    let mut agents = Vec::new();
    let mut levels = Vec::new();
    // A radius of 0 asks for what is done anyway.
    let mut rounded = options.corner_radius == Some(0.0);
    for (k, route) in options.routes.iter().enumerate() {
        let asked = RouteRequest::parse(route, |name| layout.nodes_called(name))?;
        let refused = |problem: &dyn fmt::Display| ImportError::new(format!("route {route}: {problem}"));
        let steps = shortest(layout, asked.ends).ok_or_else(|| refused(&"there is no way from node to node"))?;
        let (trace, vehicle) = travel(layout, vehicle, asked.ends[0], &steps).map_err(|error| refused(&error))?;
        rounded |= corner_arcs(layout, asked.ends[0], &steps, layout.corner_radius).iter().any(Option::is_some);
        levels.push(layout.level_of(asked.ends[0]));
        let name = |place: usize| {
            let node = &layout.nodes[place];
            node.name.clone().unwrap_or_else(|| node.id.to_string())
        };
        let way = format!("{} > {}", name(asked.ends[0]), name(asked.ends[1]));
        // If the file names its vehicles, the routes belong to them, in the order of both.
        let label = label(&layout.vehicles.get(k).map_or(way.clone(), |vehicle| format!("{vehicle} {way}")));
        agents.push(Agent { label, ..agent(k as u64 + 1, &trace, &vehicle, asked.time) });
    }
    let names = options.routes.iter().map(|route| format!("route {route}")).collect::<Vec<_>>();
    vehicle_heading::warn_of_half_turns(names.iter().map(String::as_str).zip(&agents), warnings);
    if rounded {
        warnings.use_option("corner_radius");
    }
    if levels.windows(2).any(|pair| pair[0] != pair[1]) {
        warnings.add(
            WarningCode::SeveralLevels,
            "routes",
            "they are on different levels, which a scenario does not tell apart",
        );
    }
    Ok(Scenario::new(layout.name.clone(), agents))
}

/// The agent that travels the shortest way between two nodes from the time 0, if there is one.
pub(super) fn mission(
    layout: &Layout,
    vehicle: &VehicleTraits,
    id: u64,
    ends: [usize; 2],
) -> Result<Option<Agent>, ImportError> {
    let Some(steps) = shortest(layout, ends) else { return Ok(None) };
    let (trace, vehicle) = travel(layout, vehicle, ends[0], &steps)?;
    Ok(Some(agent(id, &trace, &vehicle, 0.0)))
}

/// The path of a vehicle along some edges, from the node where it begins, and the vehicle as it is on it: it changes its facing where it
/// is known which way its outline faces on every edge.
fn travel(
    layout: &Layout,
    vehicle: &VehicleTraits,
    from: usize,
    steps: &[RouteStep<'_>],
) -> Result<(LimitedPath, VehicleTraits), ImportError> {
    let facings = || steps.iter().map(|step| step.facing());
    let in_gears = vehicle.footprint.is_some() && Facing::changes(facings());
    let path = trace(layout, from, steps, in_gears)?;
    let facing = facings().reduce(Facing::then).unwrap_or_default();
    Ok((path, if in_gears { vehicle.clone() } else { vehicle.facing(facing) }))
}

/// The vehicle on a single edge, in one direction, with the limits of the edge. It has the outline that it has there, which
/// [`VehicleTraits::facing`] gives.
pub fn ride(vehicle: &VehicleTraits, step: RouteStep<'_>) -> Agent {
    let mut tracer = LimitedPathBuilder::default();
    tracer.limit(step.speed(), step.edge.rotation);
    let steady = step.facing().heading().is_some() && vehicle.footprint.is_some();
    if steady {
        tracer.face_as(step.facing());
    }
    let curve = step.curve();
    curve.iter().for_each(|piece| tracer.follow(piece));
    let mut trace = tracer.finish(curve.first().map_or([0.0; 2], |first| first.start));
    trace.deviation += step.deviation();
    trace.turned += if steady { 0.0 } else { step.turned() };
    agent(0, &trace, vehicle, 0.0)
}

/// The vehicle that turns in place from a heading by an angle, or stands there.
pub fn turn(vehicle: &VehicleTraits, at: [f64; 2], heading: f64, angle: f64) -> Agent {
    let mut tracer = LimitedPathBuilder::default();
    tracer.turn(at, heading, angle);
    agent(0, &tracer.finish(at), vehicle, 0.0)
}

/// The agent that travels a path. If its heading is not known, it is the disc around its outline.
pub(super) fn agent(id: u64, trace: &LimitedPath, vehicle: &VehicleTraits, t_start: f64) -> Agent {
    let path = trace.stretches.iter().map(|stretch| stretch.shape).collect();
    let motion = speed::motion(&trace.stretches, vehicle);
    let footprint = vehicle.footprint.as_ref().filter(|_| trace.faces);
    let off = trace.deviation + vehicle.moved_by(trace.turned);
    let footprint = footprint.map(|footprint| footprint.inflated(off));
    let disc = Agent::disc(id, vehicle.radius + off, trace.start, path, motion);
    Agent { footprint, margin: vehicle.margin, t_start, ..disc }
}

#[cfg(test)]
mod tests {
    use super::super::{ElementId, InputFormat, LayoutNode, layout};
    use super::*;
    use std::collections::HashSet;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// Graphs that others made: of a warehouse, of another one, and a small one. They are in the repository, and not in the package
    /// of this crate.
    fn graphs() -> [String; 3] {
        ["warehouse", "aws", "sample"].map(|name| {
            let file = format!("{}/../../tests/data/real/nav2/{name}_graph.geojson", env!("CARGO_MANIFEST_DIR"));
            std::fs::read_to_string(&file).expect(&file)
        })
    }

    #[test]
    fn a_corner_is_rounded_as_nav2_does_it() {
        let arc = corner_arc([-3.0, 0.0], [0.0, 0.0], [0.0, 2.0], 1.0).unwrap();
        assert!((arc.start[0] + 1.0).abs() < 1e-15 && arc.start[1] == 0.0 && arc.heading == 0.0);
        assert!(matches!(arc.shape, PathSegment::Arc { radius: 1.0, sweep, .. } if (sweep - FRAC_PI_2).abs() < 1e-15));
        let right = corner_arc([-3.0, 0.0], [0.0, 0.0], [-1.0, -3.0_f64.sqrt()], 0.5).unwrap();
        // Tangent length 0.5 / tan 30°, and 120° to turn.
        assert!((right.start[0] + 0.5 * 3.0_f64.sqrt()).abs() < 1e-12);
        assert!(matches!(right.shape, PathSegment::Arc { sweep, .. } if (sweep + 2.0 * PI / 3.0).abs() < 1e-12));
        let end = right.end();
        assert!((end[0] + 0.25 * 3.0_f64.sqrt()).abs() < 1e-12 && (end[1] + 0.75).abs() < 1e-12);
        // Along no axis: it begins 1 m of 5 m before the corner, and half a metre.
        let askew = corner_arc([-1.0, -1.0], [2.0, 3.0], [-2.0, 6.0], 1.0).unwrap();
        assert!((askew.start[0] - 1.4).hypot(askew.start[1] - 2.2) < 1e-12, "{askew:?}");
        let askew = corner_arc([-1.0, -1.0], [2.0, 3.0], [-2.0, 6.0], 0.5).unwrap();
        assert!((askew.start[0] - 1.7).hypot(askew.start[1] - 2.6) < 1e-12, "{askew:?}");
        assert_eq!(corner_arc([-3.0, 0.0], [0.0, 0.0], [0.0, 2.0], 0.0), None);
    }

    #[test]
    fn an_edge_is_on_the_levels_of_its_ends() {
        let layout = bend(1);
        let on = |edge: usize| [0, 1, 2].map(|level| layout.is_on(&layout.edges[edge], level));
        assert_eq!([on(1), on(2), on(3)], [[true, false, false], [true, true, false], [false, true, false]]);
    }

    #[test]
    fn an_arc_is_left_out_where_it_does_not_fit() {
        let corner = [0.0, 0.0];
        assert_eq!(
            corner_arc([-1.0, 0.0], corner, [0.0, 2.0], 1.0),
            None,
            "the edge before is no longer than the tangent"
        );
        assert_eq!(corner_arc([-2.0, 0.0], corner, [0.0, 1.0], 1.0), None, "the edge after");
        assert_eq!(corner_arc([-2.0, 0.0], corner, [-1.0, 0.0], 0.1), None, "back");
        assert_eq!(corner_arc([-2.0, 0.0], corner, [1.0, 0.0], 0.1), None, "straight on");
        assert_eq!(corner_arc(corner, corner, [1.0, 0.0], 0.1), None, "an edge of length 0");
    }

    /// A quarter of a circle and two lines beyond it; the last node on this level.
    fn bend(level: usize) -> Layout {
        let node = |id: u64, at: [f64; 2], level: usize| LayoutNode {
            id: ElementId::Number(id),
            name: None,
            level,
            point: at,
        };
        let edge =
            |id: u64, ends: [usize; 2], curve: Vec<PlacedSegment>| LayoutEdge::new(ElementId::Number(id), ends, curve);
        let arc = PathSegment::arc(1.0, FRAC_PI_2);
        let curve = vec![PlacedSegment { start: [0.0, 0.0], heading: 0.0, shape: arc }];
        let nodes = [([0.0, 0.0], 0), ([1.0, 1.0], 0), ([1.0, 3.0], 0), ([4.0, 3.0], level), ([5.0, 3.0], level)];
        Layout {
            nodes: (0..).zip(nodes).map(|(id, (at, level))| node(id, at, level)).collect(),
            edges: vec![
                edge(0, [0, 1], curve),
                edge(1, [1, 2], vec![]),
                edge(2, [2, 3], vec![]),
                edge(3, [3, 4], vec![]),
            ],
            ..Layout::default()
        }
    }

    #[test]
    fn a_way_goes_on_where_the_edge_before_ends() {
        let layout = bend(0);
        let steps = shortest(&layout, [0, 4]).expect("a way");
        let trace = trace(&layout, 0, &steps, false).expect("a path");
        assert!(trace.deviation < 1e-5, "{}", trace.deviation);
        let length: f64 = trace.stretches.iter().map(|stretch| stretch.shape.length()).sum();
        assert!((length - (FRAC_PI_2 + 2.0 + 3.0 + 1.0)).abs() < 1e-5, "{length}");
    }

    #[test]
    fn routes_on_different_levels_are_told() {
        let told = |level: usize| {
            let routes = vec!["0:2".to_owned(), "3:4".to_owned()];
            let (options, mut warnings) = (ImportOptions { routes, ..ImportOptions::default() }, Warnings::default());
            let vehicle = layout(InputFormat::Nav2, &graphs()[0], &ImportOptions::default(), &mut Warnings::default());
            scenario(&bend(level), &vehicle.expect("a graph").vehicle, &options, &mut warnings).expect("two routes");
            warnings.lines().iter().any(|line| line.contains("they are on different levels"))
        };
        assert_eq!([told(0), told(1)], [false, true]);
    }

    /// Corners of ways from node to node to node that do not turn back, and how many of them have an arc.
    fn corners(text: &str, radius: f64) -> [usize; 2] {
        let imported = layout(InputFormat::Nav2, text, &ImportOptions::default(), &mut Warnings::default()).unwrap();
        let Layout { nodes, edges, .. } = &imported.layout;
        let mut ways = HashSet::new();
        for before in edges {
            for after in edges.iter().filter(|after| after.ends[0] == before.ends[1] && after.ends[1] != before.ends[0])
            {
                ways.insert([before.ends[0], before.ends[1], after.ends[1]]);
            }
        }
        let arcs = |radius: f64| {
            let arc = |way: &&[usize; 3]| {
                let [start, corner, end] = way.map(|node| nodes[node].point);
                corner_arc(start, corner, end, radius).is_some()
            };
            ways.iter().filter(arc).count()
        };
        [arcs(1e-6), arcs(radius)]
    }

    #[test]
    fn corners_of_the_published_graphs() {
        let graphs = graphs();
        assert_eq!(graphs.each_ref().map(|graph| corners(graph, 0.5)), [[112, 112], [118, 118], [32, 32]]);
        assert_eq!(corners(&graphs[0], 1.0), [112, 100]);
        // One of them turns by 2° only.
        assert_eq!(corners(&graphs[1], 1.0), [118, 112]);
    }
}
