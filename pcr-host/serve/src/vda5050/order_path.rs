//! The path of an order: from where the vehicle stands through its nodes, straight or along their trajectories.
//!
//! Of a vehicle with an outline, the heading matters. It faces along its edges, or as their `orientation` says, and turns in place at nodes,
//! also to their `theta`. The standard does not say which way round: a turn of more than a kink is followed by a whole one, so that
//! the outline sweeps all that it can. Turns have a length, which is so short that where the vehicle is within them does not matter. The
//! reported heading is compared with that of the path, except where the vehicle turns. Where its heading is not known,
//! the path tells why: there the vehicle is the disc around its outline.

mod segment;
mod trajectory;

pub use trajectory::TOLERANCE;

use super::edge_orientation::EdgeOrientation;
use crate::owned_path::{PathElement, StartPose};
use pcr_formats::plane_geometry::{distance, wrapped};
use pcr_formats::scenario::{PathSegment, PlacedSegment};
use pcr_formats::vda5050::decode::DecodeError;
use pcr_formats::vda5050::order::{OrderEdge, OrderNode};
use pcr_formats::vda5050::order_state::OrderState;
use pcr_formats::vda5050::state::VehiclePosition;
use segment::{LEVER, OrderPathSegment, OrderPathShape, along};
use std::f64::consts::TAU;

/// Shortest line \[m\]: below this its direction may be rounding.
const NEAR: f64 = 1e-6;

/// Largest angle that counts as rounding \[rad\].
const STRAIGHT: f64 = 1e-9;

/// Turns of outlines up to this go the shorter way round \[rad\].
const KINK: f64 = 0.1;

/// A vehicle with an outline that is nearer to its first node than this \[m\] goes there without turning.
const HOP: f64 = 0.1;

/// The path of an order, with the lengths of its nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct OrderPath {
    start: StartPose,
    pieces: Vec<OrderPathSegment>,
    shapes: Vec<PathElement>,
    /// For each node the length up to it \[m\] and the number of shapes before it.
    nodes: Vec<(f64, usize)>,
    at: [f64; 2],
    heading: f64,
    /// Radius of the disc around the outline of the vehicle \[m\]; 0 for a vehicle that is a disc.
    spread: f64,
    /// Why the heading is not known, and the node up to which that is so.
    unknown: Vec<(usize, String)>,
}

impl OrderPath {
    /// The way of an order for a vehicle that stands at `start`. `spread` is the radius of the disc around its outline \[m\], 0 for a disc.
    ///
    /// # Errors
    /// [`DecodeError`] if a node has no position, or if a trajectory or an orientation cannot be read.
    pub(crate) fn new(start: StartPose, held: &OrderState, spread: f64) -> Result<Self, DecodeError> {
        let (at, heading) = ([start.x, start.y], start.heading);
        let (pieces, shapes, nodes, unknown) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut way = Self { start, pieces, shapes, nodes, at, heading, spread, unknown };
        if let Some(first) = held.nodes.first() {
            let to = position(first, 0)?;
            let (away, line) = (distance(at, to), PlacedSegment::line(at, to));
            if spread > 0.0 && away > HOP {
                way.unknown.push((0, format!("it goes {away:.3} m to the first node")));
            }
            let side = if spread > 0.0 { wrapped(line.heading - heading) } else { 0.0 };
            way.line(to, side);
            way.arrived(first);
        }
        way.extend(held, 0)?;
        Ok(way)
    }

    /// Replaces the way after a node by that of the updated order.
    ///
    /// # Errors
    /// As [`OrderPath::new`]; the way must not be used then.
    pub(crate) fn extend(&mut self, held: &OrderState, after: usize) -> Result<(), DecodeError> {
        self.nodes.truncate(after + 1);
        let (length, shapes) = self.nodes.last().copied().unwrap_or_default();
        self.shapes.truncate(shapes);
        self.pieces.retain(|piece| piece.from < length);
        self.unknown.retain(|(node, _)| *node <= after);
        let StartPose { x, y, heading } = self.end();
        (self.at, self.heading) = ([x, y], heading);
        trajectory::check_sizes(&held.edges, after)?;
        for (k, (edge, ends)) in held.edges.iter().zip(held.nodes.windows(2)).enumerate().skip(after) {
            let [from, to] = ends else { continue };
            self.edge(edge, from, to, k)?;
            self.arrived(to);
        }
        Ok(())
    }

    fn edge(&mut self, edge: &OrderEdge, from: &OrderNode, to: &OrderNode, k: usize) -> Result<(), DecodeError> {
        let (orientation, why) = match self.spread > 0.0 {
            true => EdgeOrientation::of(edge, k)?,
            false => (EdgeOrientation::Tangential(0.0), None),
        };
        self.unknown.extend(why.map(|why| (k + 1, why)));
        if edge.trajectory.is_none() {
            let to = position(to, k + 1)?;
            let side = match orientation {
                EdgeOrientation::Tangential(angle) => -angle,
                EdgeOrientation::Global(heading) => PlacedSegment::line(self.at, to).heading - heading,
            };
            self.line(to, wrapped(side));
            return Ok(());
        }
        let (start, path) = trajectory::converted([from, to], edge, k)?;
        // How far the heading of lines and arcs is from that of the curve is not known here.
        let is_curved = |shape: &PathSegment| matches!(shape, PathSegment::Arc { .. });
        let is_ahead = orientation == EdgeOrientation::Tangential(0.0);
        if self.spread > 0.0 && (!is_ahead || path.iter().any(is_curved)) {
            self.unknown.push((k + 1, format!("edges[{k}] is curved")));
        }
        let [x, y, mut heading] = start;
        let mut at = [x, y];
        for shape in path {
            let placed = PlacedSegment { start: at, heading, shape };
            (at, heading) = (placed.end(), placed.heading_at_end());
            if shape.length() > 0.0 {
                self.follow(placed);
            }
        }
        Ok(())
    }

    fn follow(&mut self, placed: PlacedSegment) {
        match placed.shape {
            PathSegment::Arc { .. } => {
                self.line(placed.start, 0.0);
                self.push(placed, 0.0);
            }
            _ => self.line(placed.end(), 0.0),
        }
    }

    /// Appends a line to a point, with an angle from the heading to the direction of travel \[rad\].
    fn line(&mut self, to: [f64; 2], side: f64) {
        if distance(self.at, to) > NEAR {
            self.push(PlacedSegment::line(self.at, to), side);
        }
    }

    fn push(&mut self, placed: PlacedSegment, side: f64) {
        self.turn(placed.heading - side);
        self.pieces.push(OrderPathSegment { from: self.length(), shape: OrderPathShape::Drive(placed, side) });
        self.shapes.push(match placed.shape {
            PathSegment::Line { length } if side == 0.0 => PathElement::Line { length },
            PathSegment::Line { length } => {
                PathElement::Shift { ahead: length * side.cos(), left: length * side.sin() }
            }
            // Of an order there are lines and arcs; these turn the way.
            PathSegment::Turn { sweep } | PathSegment::Kink { sweep } => PathElement::Turn { sweep, lever: None },
            PathSegment::Facing { before, after } => PathElement::Turn { sweep: before - after, lever: None },
            PathSegment::Arc { radius, sweep, .. } => PathElement::Arc { radius, sweep },
        });
        (self.at, self.heading) = (placed.end(), placed.heading_at_end() - side);
    }

    /// Appends a turn in place to a heading \[rad\].
    fn turn(&mut self, to: f64) {
        let sweep = wrapped(to - self.heading);
        if sweep.abs() <= STRAIGHT {
            return;
        }
        if self.spread == 0.0 {
            self.shapes.push(PathElement::Turn { sweep, lever: None });
            return;
        }
        let whole = (sweep.abs() > KINK).then_some(TAU.copysign(sweep));
        for sweep in [sweep].into_iter().chain(whole) {
            let from = StartPose { x: self.at[0], y: self.at[1], heading: self.heading };
            self.pieces.push(OrderPathSegment { from: self.length(), shape: OrderPathShape::Turn(from, sweep) });
            self.shapes.push(PathElement::Turn { sweep, lever: Some(LEVER) });
            self.heading += sweep;
        }
    }

    /// Appends what a vehicle does at a node when it arrives: it turns to the `theta` of the node.
    fn arrived(&mut self, node: &OrderNode) {
        let theta = node.node_position.as_ref().and_then(|position| position.rest.get("theta")?.as_f64());
        if let Some(theta) = theta.filter(|_| self.spread > 0.0) {
            self.turn(theta);
        }
        self.nodes.push((self.length(), self.shapes.len()));
    }

    /// \[m\]
    pub(crate) fn length(&self) -> f64 {
        self.pieces.last().map_or(0.0, |last| last.from + last.length())
    }

    /// Radius of the disc around the outline of the vehicle \[m\]; 0 for a vehicle that is a disc.
    pub(crate) fn spread(&self) -> f64 {
        self.spread
    }

    /// Returns why the heading is not known on the way from a node, or from the start, to the end.
    pub(crate) fn unknown_heading(&self, from: Option<usize>) -> Option<&str> {
        let is_ahead = |node: usize| from.is_none_or(|from| node > from);
        self.unknown.iter().find(|(node, _)| is_ahead(*node)).map(|(_, why)| why.as_str())
    }

    /// Length up to a node, and the turns in place there with which the next edge begins \[m\].
    pub(crate) fn departure(&self, place: usize) -> Option<f64> {
        let mut length = self.node(place)?;
        for piece in self.pieces.iter().skip(self.pieces.partition_point(|piece| piece.from < length)) {
            match piece.shape {
                OrderPathShape::Turn(..) => length = piece.from + piece.length(),
                OrderPathShape::Drive(..) => break,
            }
        }
        Some(length)
    }

    /// Its first pose.
    pub(crate) fn start(&self) -> StartPose {
        self.start
    }

    /// Length up to a node \[m\].
    pub fn node(&self, place: usize) -> Option<f64> {
        self.nodes.get(place).map(|(length, _)| *length)
    }

    /// The pose with which a node is reached.
    pub(crate) fn arrival(&self, place: usize) -> Option<StartPose> {
        let length = self.node(place)?;
        let before = self.pieces.partition_point(|piece| piece.from < length);
        Some(before.checked_sub(1).and_then(|last| self.pieces.get(last)).map_or(self.start, OrderPathSegment::end))
    }

    /// The pose at its end.
    fn end(&self) -> StartPose {
        self.pieces.last().map_or(self.start, OrderPathSegment::end)
    }

    /// The shapes from one node, or from the start, up to another node.
    pub(crate) fn shapes(&self, from: Option<usize>, to: usize) -> &[PathElement] {
        let before = |node: usize| self.nodes.get(node).map_or(self.shapes.len(), |(_, shapes)| *shapes);
        self.shapes.get(from.map_or(0, before)..before(to)).unwrap_or_default()
    }

    /// The pose at a length \[m, rad\].
    pub(crate) fn pose(&self, length: f64) -> StartPose {
        let after = self.pieces.partition_point(|piece| piece.from <= length);
        let Some(piece) = after.checked_sub(1).and_then(|place| self.pieces.get(place)) else { return self.start };
        piece.pose((length - piece.from).min(piece.length()))
    }

    /// The pose with which a length is reached \[m, rad\].
    pub(crate) fn reached(&self, length: f64) -> StartPose {
        let before = self.pieces.partition_point(|piece| piece.from < length);
        let Some(piece) = before.checked_sub(1).and_then(|place| self.pieces.get(place)) else { return self.start };
        piece.pose((length - piece.from).min(piece.length()))
    }

    /// How far any point of a vehicle is from where it would be at a pose of the way, at most \[m\]; where it may have any heading, only its
    /// reference point.
    fn off(&self, at: &VehiclePosition, there: StartPose, any_heading: bool) -> f64 {
        let turned = if any_heading { 0.0 } else { self.moved_by(at.theta - there.heading) };
        distance([there.x, there.y], [at.x, at.y]) + turned
    }

    /// How far a turn moves any point of the vehicle at most \[m\].
    pub(crate) fn moved_by(&self, angle: f64) -> f64 {
        self.spread * 2.0 * (0.5 * wrapped(angle)).sin().abs()
    }

    /// Notes that the heading of the vehicle is not known from its start on.
    pub(crate) fn starts_turned(&mut self, why: String) {
        self.unknown.push((0, why));
    }

    /// The least and the largest length within a window at which a piece of the way is nearest to a reported pose, of the pieces that
    /// come within `reach` of it \[m\]. `None`: no piece does. While an outline turns, it has any heading and is anywhere in the turn.
    pub(crate) fn near(
        &self,
        at: &VehiclePosition,
        window: [f64; 2],
        reach: f64,
        any_heading: bool,
    ) -> Option<[f64; 2]> {
        let point = [at.x, at.y];
        let mut found: Option<[f64; 2]> = None;
        let mut consider = |length: f64, off: f64| {
            if off <= reach {
                found = Some(found.map_or([length; 2], |[lo, hi]| [lo.min(length), hi.max(length)]));
            }
        };
        if self.pieces.is_empty() {
            consider(0.0, self.off(at, self.start, any_heading));
        }
        for piece in &self.pieces {
            let to = piece.from + piece.length();
            if to < window[0] || piece.from > window[1] {
                continue;
            }
            let within = |length: f64| length.clamp(window[0], window[1].max(window[0]));
            match piece.shape {
                OrderPathShape::Drive(placed, _) => {
                    let length = within(piece.from + along(&placed, point));
                    consider(length, self.off(at, self.pose(length.clamp(piece.from, to)), any_heading));
                }
                // It may not have begun to turn.
                OrderPathShape::Turn(from, _) if piece.from >= window[1] => {
                    consider(within(piece.from), self.off(at, from, any_heading))
                }
                OrderPathShape::Turn(from, _) => {
                    let off = distance([from.x, from.y], point);
                    [piece.from, to].into_iter().for_each(|length| consider(within(length), off));
                }
            }
        }
        found
    }
}

/// Position of a node.
fn position(node: &OrderNode, place: usize) -> Result<[f64; 2], DecodeError> {
    let position = node.node_position.as_ref().map(|position| [position.x, position.y]);
    position.ok_or_else(|| DecodeError::new(format!("nodes[{place}].nodePosition"), "missing"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::vda5050::decode::{MessageLimits, read};
    use pcr_formats::vda5050::order::Order;
    use serde_json::{Value, json};
    use std::f64::consts::PI;

    fn order_with_points(points: &[[f64; 2]], curve: Option<Value>) -> OrderState {
        let nodes: Vec<_> = (points.iter().enumerate())
            .map(|(k, [x, y])| {
                let at = json!({ "x": x, "y": y, "mapId": "m" });
                json!({ "nodeId": k.to_string(), "sequenceId": 2 * k, "released": true, "actions": [], "nodePosition": at })
            })
            .collect();
        let edges: Vec<_> = (1..points.len())
            .map(|k| json!({ "edgeId": "e", "sequenceId": 2 * k - 1, "released": true, "actions": [], "trajectory": curve }))
            .collect();
        let order = json!({ "orderId": "o", "orderUpdateId": 0, "nodes": nodes, "edges": edges });
        OrderState::new(read::<Order>(order.to_string().as_bytes(), MessageLimits::default()).unwrap()).unwrap()
    }

    fn at([x, y]: [f64; 2]) -> VehiclePosition {
        read(json!({ "x": x, "y": y, "theta": 0.0, "mapId": "m" }).to_string().as_bytes(), MessageLimits::default())
            .unwrap()
    }

    const ORIGIN: StartPose = StartPose { x: 0.0, y: 0.0, heading: 0.0 };

    #[test]
    fn a_way_leads_through_its_nodes() {
        let corner = order_with_points(&[[1.0, 0.0], [4.0, 0.0], [4.0, 2.0]], None);
        let way = OrderPath::new(ORIGIN, &corner, 0.0).unwrap();
        assert_eq!([0, 1, 2].map(|node| way.node(node).unwrap()), [1.0, 4.0, 6.0]);
        assert_eq!(way.length(), 6.0);
        let end = way.pose(5.0);
        assert!((end.x - 4.0).abs() < 1e-12 && (end.y - 1.0).abs() < 1e-12, "{end:?}");
        assert_eq!(way.shapes(None, 0), [PathElement::Line { length: 1.0 }]);
        assert_eq!(way.shapes(Some(0), 1), [PathElement::Line { length: 3.0 }]);
        assert!(matches!(way.shapes(Some(1), 2), [PathElement::Turn { .. }, PathElement::Line { .. }]));
        let mut again = way.clone();
        again.extend(&corner, 1).unwrap();
        assert_eq!(again, way);
    }

    #[test]
    fn a_place_is_found_where_the_window_is() {
        // There and back again: the same place twice.
        let way = OrderPath::new(ORIGIN, &order_with_points(&[[0.0, 0.0], [4.0, 0.0], [0.0, 0.0]], None), 0.0).unwrap();
        assert_eq!(way.near(&at([1.0, 0.05]), [0.0, 4.0], 0.1, false), Some([1.0, 1.0]));
        assert_eq!(way.near(&at([1.0, 0.05]), [4.0, 8.0], 0.1, false), Some([7.0, 7.0]));
        assert_eq!(way.near(&at([1.0, 0.05]), [0.0, 8.0], 0.1, false), Some([1.0, 7.0]));
        assert_eq!(way.near(&at([1.0, 0.05]), [0.0, 8.0], 0.04, false), None);
        assert_eq!(way.near(&at([1.0, 0.0]), [2.0, 3.0], 0.1, false), None, "outside of the window");
    }

    #[test]
    fn long_curves_are_read_and_gaps_are_refused() {
        let wave: Vec<Value> =
            (0..=40).map(|k| json!({ "x": 2 * k, "y": if k % 2 == 0 { 0.0 } else { 1.5 } })).collect();
        let curve = json!({ "degree": 3, "controlPoints": wave });
        let length = |from: f64| {
            OrderPath::new(ORIGIN, &order_with_points(&[[from, 0.0], [80.0, 0.0]], Some(curve.clone())), 0.0)
                .map(|way| way.length())
        };
        assert!(length(0.0).is_ok_and(|length| length > 80.0));
        assert!(length(0.001).is_ok());
        let refusal = length(0.01).unwrap_err().to_string();
        assert!(refusal.contains("m off its nodes, or off lines and arcs"), "{refusal}");
    }

    #[test]
    fn trajectories_too_large_to_convert_are_refused_by_their_size() {
        let curve = |degree: usize, points: usize| {
            let points: Vec<Value> = (0..points).map(|k| json!({ "x": k, "y": 0 })).collect();
            json!({ "degree": degree, "controlPoints": points })
        };
        let read = |curve: Value| {
            let last = curve["controlPoints"].as_array().map_or(0, |points| points.len() - 1) as f64;
            OrderPath::new(ORIGIN, &order_with_points(&[[0.0, 0.0], [last, 0.0]], Some(curve)), 0.0)
        };
        let refusal = |curve: Value| {
            let error = read(curve).unwrap_err();
            assert_eq!(error.field, "edges[0].trajectory");
            error.to_string()
        };
        assert!(read(curve(8, 100)).is_ok_and(|way| (way.length() - 99.0).abs() < 1e-6));
        let text = refusal(curve(9, 20));
        assert!(text.contains("degree 9; a trajectory has at most 8"), "{text}");
        let text = refusal(curve(1, 101));
        assert!(text.contains("101 control points and 0 knots; a trajectory has at most 100"), "{text}");
        // Knots alone, which are no curve, and far too many.
        let knots = json!({ "degree": 1, "controlPoints": [{ "x": 0, "y": 0 }, { "x": 1, "y": 0 }], "knotVector": vec![0.0; 1500] });
        let text = refusal(knots);
        assert!(text.contains("2 control points and 1500 knots"), "{text}");
        // Each is allowed, all together are not.
        let ends: Vec<[f64; 2]> = (0..=11).map(|k| [99.0 * f64::from(k % 2), 0.0]).collect();
        let error = OrderPath::new(ORIGIN, &order_with_points(&ends, Some(curve(3, 100))), 0.0).unwrap_err();
        assert_eq!(error.field, "edges[10].trajectory");
        assert!(error.to_string().contains("1100 control points"), "{error}");
    }

    #[test]
    fn curves_are_followed() {
        // A quarter circle of radius 2 around (0, 2), as a rational curve.
        let curve = json!({ "degree": 2, "knotVector": [0.0, 0.0, 0.0, 1.0, 1.0, 1.0], "controlPoints": [
            { "x": 0.0, "y": 0.0, "weight": 1.0 }, { "x": 2.0, "y": 0.0, "weight": 0.5_f64.sqrt() }, { "x": 2.0, "y": 2.0, "weight": 1.0 } ] });
        let way = OrderPath::new(ORIGIN, &order_with_points(&[[0.0, 0.0], [2.0, 2.0]], Some(curve)), 0.0).unwrap();
        assert!((way.length() - PI).abs() < 1e-2, "{}", way.length());
        for k in 0..=20 {
            let length = way.length() * f64::from(k) / 20.0;
            let pose = way.pose(length);
            assert!((pose.x.hypot(pose.y - 2.0) - 2.0).abs() < TOLERANCE, "{pose:?}");
            let [lo, hi] = way.near(&at([pose.x, pose.y]), [0.0, 4.0], 1e-6, false).unwrap();
            assert!((lo - length).abs() < 1e-5 && (hi - length).abs() < 1e-5, "{lo} {hi} {length}");
        }
        let nonsense = order_with_points(&[[0.0, 0.0], [2.0, 2.0]], Some(json!({ "degree": 2, "controlPoints": [] })));
        assert_eq!(OrderPath::new(ORIGIN, &nonsense, 0.0).unwrap_err().field, "edges[0].trajectory");
    }

    fn with_edge(mut order: Value, edge: usize, fields: Value) -> OrderState {
        order["edges"][edge].as_object_mut().unwrap().extend(fields.as_object().unwrap().clone());
        OrderState::new(read::<Order>(order.to_string().as_bytes(), MessageLimits::default()).unwrap()).unwrap()
    }

    /// Through these nodes; the last one with a `theta`.
    fn plain_order(points: &[[f64; 2]], theta: Option<f64>) -> Value {
        let last = points.len() - 1;
        let node = |(k, [x, y]): (usize, &[f64; 2])| {
            let mut at = json!({ "x": x, "y": y, "mapId": "m" });
            if let Some(theta) = theta.filter(|_| k == last) {
                at["theta"] = json!(theta);
            }
            json!({ "nodeId": k.to_string(), "sequenceId": 2 * k, "released": true, "actions": [], "nodePosition": at })
        };
        let edge = |k| json!({ "edgeId": "e", "sequenceId": 2 * k - 1, "released": true, "actions": [] });
        let nodes: Vec<Value> = points.iter().enumerate().map(node).collect();
        let edges: Vec<Value> = (1..points.len()).map(edge).collect();
        json!({ "orderId": "o", "orderUpdateId": 0, "nodes": nodes, "edges": edges })
    }

    fn posed(x: f64, y: f64, theta: f64) -> VehiclePosition {
        VehiclePosition { theta, ..at([x, y]) }
    }

    /// Radius of the disc around the outline.
    const SPREAD: f64 = 0.7;

    #[test]
    fn outlines_turn_at_nodes_all_the_way_round() {
        let held = with_edge(plain_order(&[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0]], Some(0.0)), 0, json!({}));
        let way = OrderPath::new(ORIGIN, &held, SPREAD).unwrap();
        let turn = LEVER * (0.5 * PI + TAU);
        assert_eq!(way.unknown_heading(None), None);
        // A node is reached before the turn to the next edge, and after the one to its own heading.
        let nodes = [0, 1, 2].map(|node| way.node(node).unwrap());
        for (node, length) in nodes.into_iter().zip([0.0, 4.0, 4.0 + turn + 2.0 + turn]) {
            assert!((node - length).abs() < 1e-12, "{nodes:?}");
        }
        assert!((way.departure(1).unwrap() - 4.0 - turn).abs() < 1e-12);
        assert!(
            (way.arrival(2).unwrap().heading.rem_euclid(TAU) - TAU).abs() < 1e-9
                || way.arrival(2).unwrap().heading.rem_euclid(TAU) < 1e-9
        );
        let owned = crate::owned_path::OwnedPath::new(ORIGIN, way.shapes(None, 2).to_vec()).unwrap();
        assert!((owned.length() - way.length()).abs() < 1e-9);
        // While it turns, it has any heading and may be anywhere in the turn; on an edge it has that of the edge.
        let near = |pose: VehiclePosition, window| way.near(&pose, window, 0.05, false);
        let found = near(posed(4.0, 0.0, 2.0), [0.0, way.length()]).unwrap();
        assert!((found[0] - 4.0).abs() < 1e-12 && (found[1] - 4.0 - turn).abs() < 1e-12, "{found:?}");
        assert_eq!(near(posed(4.0, 0.0, 2.0), [0.0, 4.0]), None, "it may not turn yet");
        assert_eq!(near(posed(4.0, 0.0, 0.0), [0.0, 4.0]), Some([4.0, 4.0]));
        assert_eq!(near(posed(2.0, 0.0, 0.05), [0.0, 4.0]), Some([2.0, 2.0]));
        assert_eq!(near(posed(2.0, 0.0, 0.1), [0.0, 4.0]), None, "a corner is 7 cm off");
        assert_eq!(near(posed(2.0, 0.0, PI), [0.0, 4.0]), None);
    }

    #[test]
    fn orientations_of_straight_edges_are_driven_as_they_say() {
        let points = [[0.0, 0.0], [4.0, 0.0]];
        for (fields, heading) in [
            (json!({ "orientation": PI }), PI),
            (json!({ "orientation": 0.5 * PI, "orientationType": "TANGENTIAL" }), 0.5 * PI),
            (json!({ "orientation": 1.0, "orientationType": "GLOBAL" }), 1.0),
        ] {
            let start = StartPose { heading, ..ORIGIN };
            let way = OrderPath::new(start, &with_edge(plain_order(&points, None), 0, fields.clone()), SPREAD).unwrap();
            let [PathElement::Shift { ahead, left }] = *way.shapes(None, 1) else {
                panic!("{:?}", way.shapes(None, 1))
            };
            let (sin, cos) = heading.sin_cos();
            assert!(
                (ahead * cos - left * sin - 4.0).abs() < 1e-9 && (ahead * sin + left * cos).abs() < 1e-9,
                "{fields}"
            );
            assert_eq!((way.length(), way.unknown_heading(None)), (4.0, None));
            assert_eq!(way.near(&posed(1.0, 0.0, heading), [0.0, 4.0], 0.05, false), Some([1.0, 1.0]));
            let owned = crate::owned_path::OwnedPath::new(start, way.shapes(None, 1).to_vec()).unwrap();
            let end = owned.arrival(owned.length()).unwrap();
            assert!(
                (end.x - 4.0).abs() < 1e-9 && end.y.abs() < 1e-9 && (end.heading - heading).abs() < 1e-9,
                "{end:?}"
            );
        }
        for (fields, why) in [
            (json!({ "rotationAllowed": true }), "it may rotate on edges[0]"),
            (json!({ "reachOrientationBeforeEntering": false }), "before it enters edges[0]"),
        ] {
            let way = OrderPath::new(ORIGIN, &with_edge(plain_order(&points, None), 0, fields), SPREAD).unwrap();
            assert!(way.unknown_heading(None).unwrap().contains(why));
        }
        let far = StartPose { y: 0.2, ..ORIGIN };
        let way = OrderPath::new(far, &with_edge(plain_order(&points, None), 0, json!({})), SPREAD).unwrap();
        assert!(way.unknown_heading(None).unwrap().contains("to the first node"));
        assert_eq!(way.unknown_heading(Some(0)), None);
        let degrees = with_edge(plain_order(&points, None), 0, json!({ "orientation": 90 }));
        assert_eq!(OrderPath::new(ORIGIN, &degrees, SPREAD).unwrap_err().field, "edges[0].orientation");
    }
}
