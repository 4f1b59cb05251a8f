//! The path of an order: from where the vehicle stands through its nodes, straight or along their trajectories.

use crate::owned_path::{PathElement, StartPose};
use pcr_formats::import::{self, ImportOptions, InputFormat, Warnings};
use pcr_formats::plane_geometry::distance;
use pcr_formats::scenario::{PathSegment, PlacedSegment, TURN};
use pcr_formats::vda5050::decode::DecodeError;
use pcr_formats::vda5050::order::{OrderEdge, OrderNode};
use pcr_formats::vda5050::order_state::OrderState;
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};

/// Shortest line \[m\]: below this its direction may be rounding.
const NEAR: f64 = 1e-6;

/// Largest angle that counts as rounding \[rad\].
const STRAIGHT: f64 = 1e-9;

/// Bound on the distance of lines and arcs from a trajectory, and of a trajectory from its nodes \[m\]: margins have to cover
/// it.
pub const TOLERANCE: f64 = 2e-3;

/// Bound on the sideways distance of lines and arcs from a trajectory \[m\]. At equal lengths the distance grows with the
/// length of the trajectory.
const FIT: f64 = 1e-4;

/// Largest degree of a trajectory. Converting takes longer the larger degree and number of control points are, and all vehicles wait
/// for it.
const MOST_DEGREE: f64 = 8.0;

/// Most control points of a trajectory.
const MOST_POINTS: usize = 100;

/// Most control points of all trajectories that are converted together.
const MOST_POINTS_IN_ALL: usize = 1000;

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
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct OrderPathSegment {
    from: f64,
    placed: PlacedSegment,
}

impl OrderPathSegment {
    fn end(&self) -> StartPose {
        let [x, y] = self.placed.end();
        StartPose { x, y, heading: self.placed.heading_at_end() }
    }
}

impl OrderPath {
    /// The way of an order for a vehicle that stands at `start`.
    ///
    /// # Errors
    /// [`DecodeError`] if a node has no position, or a trajectory cannot be read.
    pub(crate) fn new(start: StartPose, held: &OrderState) -> Result<Self, DecodeError> {
        let (at, heading) = ([start.x, start.y], start.heading);
        let mut way = Self { start, pieces: Vec::new(), shapes: Vec::new(), nodes: Vec::new(), at, heading };
        if let Some(first) = held.nodes.first() {
            way.line(position(first, 0)?);
            way.arrived();
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
        let StartPose { x, y, heading } = self.end();
        (self.at, self.heading) = ([x, y], heading);
        check_sizes(&held.edges, after)?;
        for (k, (edge, ends)) in held.edges.iter().zip(held.nodes.windows(2)).enumerate().skip(after) {
            let [from, to] = ends else { continue };
            self.edge(edge, from, to, k)?;
            self.arrived();
        }
        Ok(())
    }

    fn edge(&mut self, edge: &OrderEdge, from: &OrderNode, to: &OrderNode, k: usize) -> Result<(), DecodeError> {
        if edge.trajectory.is_none() {
            self.line(position(to, k + 1)?);
            return Ok(());
        }
        let order = json!({ "orderId": "one", "nodes": [from, to], "edges": [edge] }).to_string();
        let one = Some(1.0);
        let options = ImportOptions {
            radius: one,
            speed: one,
            acceleration: one,
            rotation: one,
            rotation_acceleration: one,
            tolerance: Some(FIT),
            horizon: true,
            ..ImportOptions::default()
        };
        let field = || format!("edges[{k}].trajectory");
        let read = import::scenario(InputFormat::Vda5050, &order, &options, &mut Warnings::default());
        let read = read.map_err(|error| DecodeError::new(field(), error))?;
        let Some(agent) = read.agents.first() else { return Err(DecodeError::new(field(), "no way")) };
        if agent.radius > 1.0 + TOLERANCE {
            return Err(DecodeError::new(
                field(),
                format!("it is {:.4} m off its nodes, or off lines and arcs", agent.radius - 1.0),
            ));
        }
        let [x, y, mut heading] = agent.start;
        let mut at = [x, y];
        for &shape in &agent.path {
            let placed = PlacedSegment { start: at, heading, shape };
            (at, heading) = (placed.end(), placed.heading_at_end());
            if !matches!(shape, PathSegment::Arc { radius: TURN, .. }) {
                self.follow(placed);
            }
        }
        Ok(())
    }

    fn follow(&mut self, placed: PlacedSegment) {
        match placed.shape {
            PathSegment::Line { .. } => self.line(placed.end()),
            PathSegment::Arc { .. } => {
                self.line(placed.start);
                self.push(placed);
            }
        }
    }

    /// Appends a line to a point.
    fn line(&mut self, to: [f64; 2]) {
        if distance(self.at, to) > NEAR {
            self.push(PlacedSegment::line(self.at, to));
        }
    }

    fn push(&mut self, placed: PlacedSegment) {
        let sweep = (placed.heading - self.heading + PI).rem_euclid(TAU) - PI;
        if sweep.abs() > STRAIGHT {
            self.shapes.push(PathElement::Turn { sweep, lever: None });
        }
        self.pieces.push(OrderPathSegment { from: self.length(), placed });
        self.shapes.push(match placed.shape {
            PathSegment::Line { length } => PathElement::Line { length },
            PathSegment::Arc { radius, sweep } => PathElement::Arc { radius, sweep },
        });
        (self.at, self.heading) = (placed.end(), placed.heading_at_end());
    }

    fn arrived(&mut self) {
        self.nodes.push((self.length(), self.shapes.len()));
    }

    /// \[m\]
    pub(crate) fn length(&self) -> f64 {
        self.pieces.last().map_or(0.0, |last| last.from + last.placed.shape.length())
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
        let along = (length - piece.from).min(piece.placed.shape.length());
        let shape = match piece.placed.shape {
            PathSegment::Line { .. } => PathSegment::Line { length: along },
            PathSegment::Arc { radius, sweep } => PathSegment::Arc { radius, sweep: (along / radius).copysign(sweep) },
        };
        let part = PlacedSegment { shape, ..piece.placed };
        let [x, y] = part.end();
        StartPose { x, y, heading: part.heading_at_end() }
    }

    /// The least and the largest length within a window at which a piece of the way is nearest to a point, of the pieces that
    /// come within `reach` of the point \[m\]. `None`: no piece does.
    pub(crate) fn near(&self, point: [f64; 2], window: [f64; 2], reach: f64) -> Option<[f64; 2]> {
        let mut found: Option<[f64; 2]> = None;
        let mut consider = |length: f64, off: f64| {
            if off <= reach {
                found = Some(found.map_or([length; 2], |[lo, hi]| [lo.min(length), hi.max(length)]));
            }
        };
        if self.pieces.is_empty() {
            consider(0.0, distance(self.at, point));
        }
        for piece in &self.pieces {
            let to = piece.from + piece.placed.shape.length();
            if to < window[0] || piece.from > window[1] {
                continue;
            }
            let length = (piece.from + along(&piece.placed, point)).clamp(window[0], window[1].max(window[0]));
            let there = self.pose(length.clamp(piece.from, to));
            consider(length, distance([there.x, there.y], point));
        }
        found
    }
}

/// The length along a line or an arc at which it is nearest to a point \[m\].
fn along(placed: &PlacedSegment, point: [f64; 2]) -> f64 {
    let [x, y] = [point[0] - placed.start[0], point[1] - placed.start[1]];
    let (sin, cos) = placed.heading.sin_cos();
    let (ahead, left) = (x * cos + y * sin, y * cos - x * sin);
    match placed.shape {
        PathSegment::Line { length } => ahead.clamp(0.0, length),
        PathSegment::Arc { radius, sweep } => {
            // The centre is to the left of an arc that turns left.
            let towards = if sweep < 0.0 { -left } else { left };
            let angle = ahead.atan2(radius - towards).rem_euclid(TAU);
            let whole = sweep.abs();
            // Beyond its end, the nearest point is one of the two ends.
            let angle = if angle <= whole {
                angle
            } else if angle - whole < TAU - angle {
                whole
            } else {
                0.0
            };
            radius * angle
        }
    }
}

/// Position of a node.
fn position(node: &OrderNode, place: usize) -> Result<[f64; 2], DecodeError> {
    let position = node.node_position.as_ref().map(|position| [position.x, position.y]);
    position.ok_or_else(|| DecodeError::new(format!("nodes[{place}].nodePosition"), "missing"))
}

/// Refuses trajectories whose conversion would hold up the supervisor, before any is converted. What is no trajectory is left to the
/// importer.
fn check_sizes(edges: &[OrderEdge], after: usize) -> Result<(), DecodeError> {
    let mut all = 0;
    for (k, trajectory) in
        edges.iter().enumerate().skip(after).filter_map(|(k, edge)| Some((k, edge.trajectory.as_ref()?)))
    {
        let refused = |problem: String| Err(DecodeError::new(format!("edges[{k}].trajectory"), problem));
        if let Some(degree) = trajectory.get("degree").and_then(Value::as_f64).filter(|degree| *degree > MOST_DEGREE) {
            return refused(format!("degree {degree}; a trajectory has at most {MOST_DEGREE}"));
        }
        let count = |key: &str| trajectory.get(key).and_then(Value::as_array).map_or(0, Vec::len);
        let (points, knots) = (count("controlPoints"), count("knotVector"));
        // Knots are as many as control points and degree together, and one more.
        if points > MOST_POINTS || knots > MOST_POINTS + MOST_DEGREE as usize + 1 {
            return refused(format!(
                "{points} control points and {knots} knots; a trajectory has at most {MOST_POINTS} control points"
            ));
        }
        all += points;
        if all > MOST_POINTS_IN_ALL {
            return refused(format!(
                "with it the order has {all} control points; those that are converted together are at most {MOST_POINTS_IN_ALL}"
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::vda5050::decode::{MessageLimits, read};
    use pcr_formats::vda5050::order::Order;

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

    const ORIGIN: StartPose = StartPose { x: 0.0, y: 0.0, heading: 0.0 };

    #[test]
    fn a_way_leads_through_its_nodes() {
        let corner = order_with_points(&[[1.0, 0.0], [4.0, 0.0], [4.0, 2.0]], None);
        let way = OrderPath::new(ORIGIN, &corner).unwrap();
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
        let way = OrderPath::new(ORIGIN, &order_with_points(&[[0.0, 0.0], [4.0, 0.0], [0.0, 0.0]], None)).unwrap();
        assert_eq!(way.near([1.0, 0.05], [0.0, 4.0], 0.1), Some([1.0, 1.0]));
        assert_eq!(way.near([1.0, 0.05], [4.0, 8.0], 0.1), Some([7.0, 7.0]));
        assert_eq!(way.near([1.0, 0.05], [0.0, 8.0], 0.1), Some([1.0, 7.0]));
        assert_eq!(way.near([1.0, 0.05], [0.0, 8.0], 0.04), None);
        assert_eq!(way.near([1.0, 0.0], [2.0, 3.0], 0.1), None, "outside of the window");
    }

    #[test]
    fn long_curves_are_read_and_gaps_are_refused() {
        let wave: Vec<Value> =
            (0..=40).map(|k| json!({ "x": 2 * k, "y": if k % 2 == 0 { 0.0 } else { 1.5 } })).collect();
        let curve = json!({ "degree": 3, "controlPoints": wave });
        let length = |from: f64| {
            OrderPath::new(ORIGIN, &order_with_points(&[[from, 0.0], [80.0, 0.0]], Some(curve.clone())))
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
            OrderPath::new(ORIGIN, &order_with_points(&[[0.0, 0.0], [last, 0.0]], Some(curve)))
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
        let error = OrderPath::new(ORIGIN, &order_with_points(&ends, Some(curve(3, 100)))).unwrap_err();
        assert_eq!(error.field, "edges[10].trajectory");
        assert!(error.to_string().contains("1100 control points"), "{error}");
    }

    #[test]
    fn curves_are_followed() {
        // A quarter circle of radius 2 around (0, 2), as a rational curve.
        let curve = json!({ "degree": 2, "knotVector": [0.0, 0.0, 0.0, 1.0, 1.0, 1.0], "controlPoints": [
            { "x": 0.0, "y": 0.0, "weight": 1.0 }, { "x": 2.0, "y": 0.0, "weight": 0.5_f64.sqrt() }, { "x": 2.0, "y": 2.0, "weight": 1.0 } ] });
        let way = OrderPath::new(ORIGIN, &order_with_points(&[[0.0, 0.0], [2.0, 2.0]], Some(curve))).unwrap();
        assert!((way.length() - PI).abs() < 1e-2, "{}", way.length());
        for k in 0..=20 {
            let length = way.length() * f64::from(k) / 20.0;
            let pose = way.pose(length);
            assert!((pose.x.hypot(pose.y - 2.0) - 2.0).abs() < TOLERANCE, "{pose:?}");
            let [lo, hi] = way.near([pose.x, pose.y], [0.0, 4.0], 1e-6).unwrap();
            assert!((lo - length).abs() < 1e-5 && (hi - length).abs() < 1e-5, "{lo} {hi} {length}");
        }
        let nonsense = order_with_points(&[[0.0, 0.0], [2.0, 2.0]], Some(json!({ "degree": 2, "controlPoints": [] })));
        assert_eq!(OrderPath::new(ORIGIN, &nonsense).unwrap_err().field, "edges[0].trajectory");
    }
}
