//! The area that a vehicle sweeps on an edge: its motions along the edge, and its turns at both ends.
//!
//! A disc is the same in every heading. Any other outline differs on the way back along a two-way edge, and sweeps more
//! where the vehicle turns. At each end of an edge it turns in place from the edges that lead there, and to those that
//! continue from it. It turns back along the same line only if no other open way leads on. Half a turn onto another line,
//! or within an edge, may go to either side.

use pcr_formats::import::{Facing, ImportedLayout, Layout, LayoutEdge, RouteStep, VehicleTraits, ride, turn};
use pcr_formats::plane_geometry::{hull, wrapped};
use pcr_formats::scenario::{Agent, KINK, MotionSpec, PathSegment, PlacedSegment};
use std::collections::{HashMap, HashSet};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Rounding of lengths, relative.
const ROUNDING: f64 = 1e-12;

/// Two edges between the same nodes are the same line if they are not farther apart than this, where they are compared \[m\].
const ALIKE: f64 = 0.05;

/// They are compared at lengths that differ by no more than this \[m\].
const APART: f64 = 0.1;

/// The vehicle somewhere on an edge.
pub struct EdgeTraversal {
    /// The agent that travels the edge.
    pub agent: Agent,
    pub(crate) lengths: LengthMapping,
}

/// The meaning of lengths on the path of an agent, as lengths on the edge.
#[derive(Clone, Copy, Debug)]
pub(crate) enum LengthMapping {
    /// Those on the edge.
    Along,
    /// The same from the other end of the edge, which is so long \[m\].
    Reversed(f64),
    /// The agent turns in place at this length \[m\].
    At(f64),
}

impl EdgeTraversal {
    /// Returns the length of its edge at which the agent turns in place \[m\]; `None` if it drives along the edge.
    pub fn turns_at(&self) -> Option<f64> {
        match self.lengths {
            LengthMapping::At(length) => Some(length),
            LengthMapping::Along | LengthMapping::Reversed(_) => None,
        }
    }

    /// Returns the lengths on the edge at which the agent is at one of these lengths of its path, rounded outward \[m\].
    pub fn touched_lengths(&self, lengths: [f64; 2]) -> [f64; 2] {
        self.lengths.on_edge(lengths)
    }

    /// Returns the lengths on the edge at which the agent is at no others than these lengths of its path, rounded inward but at the
    /// ends of the edge \[m\]; nothing if there are none.
    pub fn enclosed_lengths(&self, [from, to]: [f64; 2]) -> Option<[f64; 2]> {
        let whole = self.agent.length();
        let slack = ROUNDING * (1.0 + whole);
        let (starts, ends) = (from <= slack, to >= whole - slack);
        let inner = match self.lengths {
            LengthMapping::At(length) => return (starts && ends).then_some([length; 2]),
            LengthMapping::Along => [if starts { 0.0 } else { from + slack }, if ends { whole } else { to - slack }],
            LengthMapping::Reversed(length) => {
                [if ends { 0.0 } else { length - to + slack }, if starts { length } else { length - from - slack }]
            }
        };
        (inner[0] <= inner[1]).then_some(inner)
    }

    /// Returns the agent on that part of its path on which it may be within these lengths of the edge, with all of the turns in place
    /// there \[m\]; nothing if it turns in place elsewhere.
    pub fn within(&self, [from, to]: [f64; 2]) -> Option<Agent> {
        let whole = self.agent.length();
        let slack = ROUNDING * (1.0 + whole);
        let [from, to] = match self.lengths {
            LengthMapping::At(length) => {
                return (from - slack <= length && length <= to + slack).then(|| self.agent.clone());
            }
            LengthMapping::Along => [from, to],
            LengthMapping::Reversed(length) => [length - to, length - from],
        };
        let [from, to] = [from - slack, to + slack];
        let (mut before, mut pieces) = (0.0, Vec::new());
        for piece in placed_pieces(&self.agent) {
            let length = piece.shape.length();
            let [lo, hi] = [(from - before).max(0.0), (to - before).min(length)];
            if lo <= hi {
                pieces.push(piece.part(lo, hi));
            }
            before += length;
        }
        let first = pieces.first()?;
        let start = [first.start[0], first.start[1], first.heading];
        let path = pieces.iter().map(|piece| piece.shape).filter(|it| it.length() > 0.0 || it.sweep() != 0.0);
        let path: Vec<PathSegment> = path.collect();
        let length = path.iter().map(PathSegment::length).sum();
        // What it covers does not depend on its speed.
        let motion = MotionSpec::profile(1.0, [(length, 0.0)]);
        Some(Agent { start, path, motion, ..self.agent.clone() })
    }
}

/// Whether a piece is a turn in place or a kink.
pub fn is_turn(piece: &PlacedSegment) -> bool {
    matches!(piece.shape, PathSegment::Turn { .. } | PathSegment::Kink { .. })
}

/// Returns the path of an agent in the plane; where it stands, a line without a length.
pub fn placed_pieces(agent: &Agent) -> Vec<PlacedSegment> {
    let [x, y, heading] = agent.start;
    let mut last = PlacedSegment { start: [x, y], heading, shape: PathSegment::Line { length: 0.0 } };
    let pieces = agent.path.iter().map(|&shape| {
        last = PlacedSegment { start: last.end(), heading: last.heading_at_end(), shape };
        last
    });
    let pieces: Vec<PlacedSegment> = pieces.collect();
    if pieces.is_empty() { vec![last] } else { pieces }
}

impl LengthMapping {
    /// Lengths on the edge for lengths on the path of the agent, rounded outward.
    pub(crate) fn on_edge(self, lengths: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Along => lengths,
            Self::Reversed(length) => reversed(length, lengths),
            Self::At(length) => [length; 2],
        }
    }
}

/// Lengths from the other end of an edge of this length \[m\], outward.
pub(crate) fn reversed(length: f64, [lo, hi]: [f64; 2]) -> [f64; 2] {
    let slack = ROUNDING * (1.0 + length);
    [length - hi - slack, length - lo + slack].map(|l| l.clamp(0.0, length))
}

/// All rides on the edges of a layout.
pub struct EdgeTraversals<'a> {
    layout: &'a Layout,
    vehicle: VehicleTraits,
    /// The vehicle as it covers what it may cover where it faces otherwise than along its way.
    outlines: HashMap<Facing, VehicleTraits>,
    /// For each node the ways on which the vehicle comes to it, and leaves it.
    sides: Vec<[Vec<EdgeApproach<'a>>; 2]>,
    /// How far from each node a vehicle may be that has come to the end of an edge there \[m\].
    beside: Vec<f64>,
}

impl<'a> EdgeTraversals<'a> {
    /// The rides of the vehicle with its margin.
    pub fn new(ImportedLayout { layout, vehicle }: &'a ImportedLayout) -> Self {
        let vehicle = VehicleTraits { margin: 0.0, ..with_margin(vehicle, vehicle.margin) };
        // A disc is the same in every heading.
        let turning = if vehicle.footprint.is_some() { &layout.edges[..] } else { &[] };
        let mut all =
            vec![<[Vec<EdgeApproach<'_>>; 2]>::default(); if turning.is_empty() { 0 } else { layout.nodes.len() }];
        for step in turning.iter().flat_map(|edge| edge.steps()) {
            let Some([start, end]) = ends(step) else { continue };
            for (node, side, end) in [(step.target(), 0, end), (step.origin(), 1, start)] {
                if let Some(sides) = all.get_mut(node) {
                    sides[side].push(EdgeApproach { step, heading: end.heading });
                }
            }
        }
        let mut beside = vec![0.0_f64; layout.nodes.len()];
        for edge in &layout.edges {
            for &node in &edge.ends {
                if let Some(farthest) = beside.get_mut(node) {
                    *farthest = farthest.max(edge.deviation);
                }
            }
        }
        let facings: HashSet<Facing> = turning.iter().flat_map(|edge| edge.facing).collect();
        let outlines = facings.into_iter().map(|facing| (facing, vehicle.facing(facing))).collect();
        Self { layout, vehicle, outlines, sides: all, beside }
    }

    /// The vehicle, larger by its margin.
    pub fn vehicle(&self) -> &VehicleTraits {
        &self.vehicle
    }

    /// The rides on an edge: one for a disc, else those in each direction.
    pub fn on_edge(&self, edge: &LayoutEdge) -> Vec<EdgeTraversal> {
        if self.vehicle.footprint.is_none() {
            return vec![self.along(RouteStep { edge, backward: false })];
        }
        edge.steps().flat_map(|step| self.turning(step)).collect()
    }

    /// Returns the rides on an edge in one direction.
    pub fn in_direction(&self, step: RouteStep<'_>) -> Vec<EdgeTraversal> {
        if self.vehicle.footprint.is_none() { vec![self.along(step)] } else { self.turning(step) }
    }

    /// The rides of an outline in one direction.
    fn turning(&self, step: RouteStep<'_>) -> Vec<EdgeTraversal> {
        let Some([start, end]) = ends(step) else {
            // Without a length it has no direction.
            return vec![self.at_node(step.origin())];
        };
        let facing = self.facing(step);
        let (length, vehicle) = (step.edge.length(), with_margin(facing, step.edge.position_error(facing)));
        let [from, to] = if step.backward { [length, 0.0] } else { [0.0, length] };
        let before = self.turns(EdgeApproach { step, heading: start.heading }, 0);
        let after = self.turns(EdgeApproach { step, heading: end.heading }, 1);
        // Before a turn to the left the vehicle looks further to the right.
        // The outline of one that keeps its heading on the map is not turned from its way.
        let own = step.facing().heading();
        let turns =
            [(from, start, before.map(|turn| -turn)), (to, end, after)].into_iter().filter_map(|(at, end, turns)| {
                let [right, left] = [turns[0].min(turns[1]), turns[0].max(turns[1])];
                let heading = own.unwrap_or(end.heading);
                let agent = (right < left).then(|| turn(&vehicle, end.at, heading + right, left - right));
                Some(EdgeTraversal { agent: agent?, lengths: LengthMapping::At(at) })
            });
        // Half a turn within the edge.
        let mut before: Option<PlacedSegment> = None;
        let mut travelled = 0.0;
        let halves = step.curve().into_iter().filter(|piece| piece.shape.length() > 0.0).filter_map(|piece| {
            // Where it turns back in one gear or the other, it may also turn by less.
            let least = if step.facing() == Facing::Ahead { PI - KINK } else { FRAC_PI_2 };
            let is_half = own.is_none()
                && before.is_some_and(|before| wrapped(piece.heading - before.heading_at_end()).abs() > least);
            let at = if step.backward { length - travelled } else { travelled };
            (before, travelled) = (Some(piece), travelled + piece.shape.length());
            is_half
                .then(|| EdgeTraversal { agent: turn(&vehicle, piece.start, 0.0, TAU), lengths: LengthMapping::At(at) })
        });
        std::iter::once(self.along(step)).chain(turns).chain(halves).collect()
    }

    fn along(&self, step: RouteStep<'_>) -> EdgeTraversal {
        let agent = self.along_with(self.facing(step), step);
        let lengths = if step.backward { LengthMapping::Reversed(agent.length()) } else { LengthMapping::Along };
        EdgeTraversal { agent, lengths }
    }

    /// A vehicle with other limits of its motion, along an edge.
    pub(super) fn along_with(&self, vehicle: &VehicleTraits, step: RouteStep<'_>) -> Agent {
        match ends(step) {
            Some(_) => ride(vehicle, step),
            None => turn(&with_margin(vehicle, step.edge.deviation), self.node_point(step.origin()), 0.0, 0.0),
        }
    }

    /// The vehicle as it is where it faces as on this way.
    pub(super) fn facing(&self, step: RouteStep<'_>) -> &VehicleTraits {
        self.outlines.get(&step.facing()).unwrap_or(&self.vehicle)
    }

    /// The vehicle that stands at a node, or where an edge ends beside it, in any heading.
    pub fn at_node(&self, node: usize) -> EdgeTraversal {
        let mut vehicle = with_margin(&self.vehicle, self.node_tolerance(node));
        // Turned by a whole turn, an outline around its reference point is the disc around it.
        vehicle.footprint = vehicle.footprint.filter(|footprint| footprint.inner_radius() < 0.0);
        let angle = if vehicle.footprint.is_some() { TAU } else { 0.0 };
        EdgeTraversal { agent: turn(&vehicle, self.node_point(node), 0.0, angle), lengths: LengthMapping::At(0.0) }
    }

    /// How far from a node a vehicle may be that stands there \[m\].
    pub(super) fn node_tolerance(&self, node: usize) -> f64 {
        self.beside.get(node).copied().unwrap_or_default()
    }

    fn node_point(&self, node: usize) -> [f64; 2] {
        self.layout.position(node)
    }

    /// The farthest turns to the right and to the left from ways that come to the origin of a way onto this one (side 0), or
    /// from this one onto those that leave its target (side 1).
    fn turns(&self, own: EdgeApproach<'_>, side: usize) -> [f64; 2] {
        let node = if side == 0 { own.step.origin() } else { own.step.target() };
        let Some(sides) = self.sides.get(node) else { return [0.0; 2] };
        let mut range = [0.0_f64; 2];
        for other in &sides[side] {
            let [arrives, leaves] = if side == 0 { [other, &own] } else { [&own, other] };
            let [before, after] = [arrives, leaves].map(|way| way.step.facing().angle_at(way.heading));
            // What faces another way on the next edge may turn round in between, to either side.
            let Some((before, after)) = before.zip(after) else { return [-PI, PI] };
            let turn = wrapped(arrives.turn(leaves) + after - before);
            let leads_on = |way: &EdgeApproach<'_>| !way.step.edge.closed && !arrives.turns_back(way);
            if arrives.turns_back(leaves) && sides[1].iter().any(leads_on) {
                continue;
            }
            let [lo, hi] = if is_half(turn) { [-PI, PI] } else { [turn; 2] };
            range = [range[0].min(lo), range[1].max(hi)];
        }
        range
    }
}

/// The vehicle, larger on all sides.
fn with_margin(vehicle: &VehicleTraits, by: f64) -> VehicleTraits {
    let footprint = vehicle.footprint.as_ref().map(|footprint| footprint.inflated(by));
    VehicleTraits { radius: vehicle.radius + by, footprint, ..vehicle.clone() }
}

/// A way that ends or begins at a node, and the heading there \[rad\].
#[derive(Clone)]
struct EdgeApproach<'a> {
    step: RouteStep<'a>,
    heading: f64,
}

impl EdgeApproach<'_> {
    /// The turn from this way, which comes to a node, onto one that leaves it \[rad\].
    fn turn(&self, leaves: &Self) -> f64 {
        wrapped(leaves.heading - self.heading)
    }

    /// Whether that is half a turn, back along the same line.
    fn turns_back(&self, leaves: &Self) -> bool {
        is_half(self.turn(leaves)) && leads_back(self.step, leaves.step)
    }
}

/// Whether it is half a turn, but for what joints of maps are off by.
fn is_half(turn: f64) -> bool {
    turn.abs() > PI - KINK
}

/// Whether a way leads back along the line of another one.
fn leads_back(step: RouteStep<'_>, other: RouteStep<'_>) -> bool {
    if std::ptr::eq(step.edge, other.edge) {
        return step.backward != other.backward;
    }
    let back = RouteStep { backward: !other.backward, ..other };
    if [step.origin(), step.target()] != [back.origin(), back.target()] {
        return false;
    }
    let lengths = [step, back].map(|step| step.edge.length());
    let curves = [step, back].map(RouteStep::curve);
    let count = (lengths[0].max(lengths[1]) / APART).ceil().max(8.0);
    (0..=count as usize)
        .map(|k| [0, 1].map(|way| point(&curves[way], lengths[way] * k as f64 / count)))
        .all(|[[x, y], [u, v]]| (x - u).hypot(y - v) <= ALIKE)
}

/// The point of a curve after a length \[m\].
fn point(curve: &[PlacedSegment], length: f64) -> [f64; 2] {
    let mut left = length;
    for piece in curve {
        let length = piece.shape.length();
        if left < length {
            return piece.part(0.0, left).end();
        }
        left -= length;
    }
    curve.last().map_or([0.0; 2], PlacedSegment::end)
}

/// A pose of the vehicle.
struct TraversalPose {
    at: [f64; 2],
    heading: f64,
}

/// The beginning and the end of an edge, where it has a length.
fn ends(step: RouteStep<'_>) -> Option<[TraversalPose; 2]> {
    let curve = step.curve();
    let mut pieces = curve.iter().filter(|piece| piece.shape.length() > 0.0);
    let first = pieces.next()?;
    let last = pieces.next_back().unwrap_or(first);
    Some([
        TraversalPose { at: first.start, heading: first.heading },
        TraversalPose { at: last.end(), heading: last.heading_at_end() },
    ])
}

/// A part of what a vehicle sweeps.
pub enum SweptShape {
    /// All points within a radius \[m\] of a curve.
    Stroke(Vec<PlacedSegment>, f64),
    /// All points within a radius \[m\] of a polygon.
    Area(Vec<[f64; 2]>, f64),
}

/// Returns an area that contains what a vehicle sweeps on an edge. Of an outline it reaches beyond that by at most 0.22 % of the distance
/// of its corners from the centres of its arcs and turns.
pub fn corridor(rides: &[EdgeTraversal]) -> Vec<SweptShape> {
    rides.iter().flat_map(|ride| swept(&ride.agent, &placed_pieces(&ride.agent))).collect()
}

/// Returns the same of an agent on some pieces of its path.
pub fn swept(agent: &Agent, pieces: &[PlacedSegment]) -> Vec<SweptShape> {
    /// Turn between two poses at most \[rad\].
    const STEP: f64 = PI / 24.0;
    let Some(footprint) = &agent.footprint else {
        return vec![SweptShape::Stroke(pieces.to_vec(), agent.radius)];
    };
    let parts: Vec<_> = footprint.parts().collect();
    let mut shapes = Vec::new();
    let mut facing = 0.0;
    for piece in pieces {
        let at_start = facing;
        facing = piece.shape.facing_after(at_start);
        let sweep = piece.shape.sweep();
        let steps = (sweep.abs() / STEP).ceil().max(1.0);
        let half = sweep / steps / 2.0;
        let length = piece.shape.length();
        let pose = |step: f64| {
            if is_turn(piece) {
                return (piece.start, piece.heading + sweep * (step / steps));
            }
            let part = piece.part(0.0, length * (step / steps));
            (part.end(), part.heading_at_end() + part.shape.facing_after(at_start))
        };
        // Of the centre about which it turns, if it does.
        let radius = match piece.shape {
            PathSegment::Arc { radius, steady: false, .. } => Some(radius),
            PathSegment::Turn { .. } | PathSegment::Kink { .. } => Some(0.0),
            _ => None,
        };
        for step in 0..steps as usize {
            let ends = [pose(step as f64), pose((step + 1) as f64)];
            for part in &parts {
                let corners = ends.iter().flat_map(|&(at, heading)| placed(part.polygon(), at, heading));
                let mut corners: Vec<[f64; 2]> = corners.collect();
                if let Some(radius) = radius {
                    // The way of a corner lies in the triangle of its ends and the point in which its tangents meet.
                    let ([x, y], heading) = ends[0];
                    let to = heading + FRAC_PI_2.copysign(sweep);
                    let [x, y] = [x + radius * to.cos(), y + radius * to.sin()];
                    let tangent = half.tan();
                    let meets = placed(part.polygon(), ends[0].0, heading).map(|[u, v]| {
                        let [u, v] = [u - x, v - y];
                        [x + u - tangent * v, y + v + tangent * u]
                    });
                    corners.extend(meets.collect::<Vec<_>>());
                } else if let PathSegment::Arc { radius, .. } = piece.shape {
                    // The same of a corner that goes as far as the reference point, beside it.
                    let ([x, y], heading) = ends[0];
                    let (ahead, way) = (piece.heading + sweep * (step as f64 / steps), radius * half.tan().abs());
                    corners.extend(placed(part.polygon(), [x + way * ahead.cos(), y + way * ahead.sin()], heading));
                }
                shapes.push(SweptShape::Area(hull(corners), footprint.growth()));
            }
        }
    }
    shapes
}

fn placed(polygon: &[[f64; 2]], [x, y]: [f64; 2], heading: f64) -> impl Iterator<Item = [f64; 2]> + '_ {
    let (sin, cos) = heading.sin_cos();
    polygon.iter().map(move |[ahead, left]| [x + ahead * cos - left * sin, y + ahead * sin + left * cos])
}
