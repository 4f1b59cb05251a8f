//! Pieces of way of a layout: an edge in one direction, a node at which a robot can stand, or a turn there.

use super::kinematic_limits::KinematicLimits;
use pcr_core::{InvalidInput, Motion, PathRef, Phase, Point, Pose, ProfileRef, Radians, Segment, TurnSide};
use pcr_formats::import::{Layout, RouteStep, VehicleTraits};
use pcr_formats::plane_geometry::wrapped;
use pcr_formats::scenario::{PathSegment, PlacedSegment};
use pcr_planning::fleet::ConvexBody;

/// Largest change of direction that is not a corner \[rad\].
pub(super) const STRAIGHT: f64 = 1e-6;

/// Travelled length for each radian of a turn at a node \[m\]: so short that ramps of the speed take no time there, and so long that a
/// rounding of lengths turns nothing.
pub(super) const LEVER: f64 = 0.01;

/// An edge in one direction, a node at which a robot can stand, or a turn there.
#[derive(Clone, Debug)]
pub(super) struct RouteElement {
    /// Nodes where it begins and ends.
    pub(super) ends: [usize; 2],
    pub(super) length: f64,
    /// Largest speed on it \[m/s\].
    pub(super) speed: f64,
    /// Headings of the robot at its ends \[rad\]; of a disc its directions of travel, `None` where it stands.
    pub(super) headings: Option<[f64; 2]>,
    pub(super) shapes: Vec<PlacedSegment>,
    pub(super) segments: Vec<Segment<f64>>,
    /// Angle from the direction of travel to the heading of the robot at the start \[rad\].
    pub(super) facing: f64,
    /// The heading that the robot keeps all along, though its way is curved \[rad\].
    pub(super) steady: Option<f64>,
    phases: Vec<Phase<f64>>,
    /// Least and largest x and y \[m\].
    pub(super) bounds: [[f64; 2]; 2],
    /// Index of its edge in the layout; `None` for a node.
    pub(super) edge: Option<usize>,
    /// Index of its layer.
    pub(super) layer: usize,
}

/// Makes the elements of a layout.
pub(super) struct ElementMaker<'l> {
    pub(super) layout: &'l Layout,
    pub(super) vehicle: VehicleTraits,
    pub(super) shape: ConvexBody,
    pub(super) layer: usize,
    /// Whether a robot that drives backward faces so; otherwise all face along their ways.
    pub(super) is_known: bool,
}

impl ElementMaker<'_> {
    /// Whether turns are elements, and the robot is no disc.
    pub(super) fn has_outline(&self) -> bool {
        !self.shape.is_disc()
    }

    pub(super) fn along(&self, step: RouteStep<'_>, edge: usize) -> Result<RouteElement, InvalidInput> {
        let mut shapes = step.curve();
        shapes.retain(|placed| placed.shape.length() > 0.0);
        let from = self.layout.nodes[step.origin()].point;
        let speed = step.steady(self.vehicle.speed);
        let said = step.facing();
        let steady = said.heading().filter(|_| self.has_outline() && self.is_known);
        let ahead = shapes.first().map_or(0.0, |first| first.heading);
        let facing = said.angle_at(ahead).filter(|_| self.has_outline() && self.is_known).unwrap_or(0.0);
        let abilities = KinematicLimits::of(&self.vehicle);
        // With this lever the turn takes as long at the speed of the edge as it would by itself.
        let lever = |turn: f64| {
            if turn.abs() > STRAIGHT { speed * abilities.turn(turn) / turn.abs() } else { LEVER }
        };
        let segments = path(&shapes, (from, 0.0), (facing, steady), self.has_outline().then_some(&lever))?;
        let ends = shapes.first().zip(shapes.last());
        let headings = ends.map(|(first, last)| match steady {
            Some(heading) => [heading; 2],
            None => [first.heading, last.heading_at_end()].map(|heading| heading + facing),
        });
        RouteElement {
            ends: [step.origin(), step.target()],
            speed,
            headings,
            bounds: bounds(&shapes, from),
            shapes,
            facing,
            steady,
            edge: Some(edge),
            layer: self.layer,
            ..RouteElement::default()
        }
        .with(segments)
    }
}

impl Default for RouteElement {
    fn default() -> Self {
        Self {
            ends: [0; 2],
            length: 0.0,
            speed: 0.0,
            headings: None,
            shapes: Vec::new(),
            segments: Vec::new(),
            facing: 0.0,
            steady: None,
            phases: Vec::new(),
            bounds: [[0.0; 2]; 2],
            edge: None,
            layer: 0,
        }
    }
}

impl RouteElement {
    /// Returns the element in another layer.
    pub(super) fn in_layer(self, layer: usize) -> Self {
        Self { layer, ..self }
    }

    /// With its path, and a motion along it.
    pub(super) fn with(self, segments: Vec<Segment<f64>>) -> Result<Self, InvalidInput> {
        let length = PathRef::new(&segments)?.length();
        let phases = if length > 0.0 { vec![Phase::starting_at(1.0, length, 0.0)?] } else { Vec::new() };
        Ok(Self { length, segments, phases, ..self })
    }

    pub(super) fn standing(node: usize, at: [f64; 2], heading: Option<f64>) -> Result<Self, InvalidInput> {
        let segments = path(&[], (at, heading.unwrap_or(0.0)), (0.0, None), None)?;
        let headings = heading.map(|heading| [heading; 2]);
        Self { ends: [node; 2], headings, bounds: [at, at], ..Self::default() }.with(segments)
    }

    /// A turn in place that takes this time \[s\].
    pub(super) fn turning(node: usize, at: [f64; 2], from: f64, turn: f64, time: f64) -> Result<Self, InvalidInput> {
        let pose = Pose { position: Point::new(at[0], at[1]), heading: Radians(from) };
        let segment = Segment::standing(pose)?.then_pivot(LEVER, side(turn), LEVER * turn.abs())?;
        let headings = Some([from, from + turn]);
        let element = Self { ends: [node; 2], headings, bounds: [at, at], ..Self::default() }.with(vec![segment])?;
        Ok(Self { speed: element.length / time, ..element })
    }

    /// Whether it is a turn at a node.
    pub(super) fn is_turn(&self) -> bool {
        self.edge.is_none() && self.length > 0.0
    }

    /// Heading of a robot at a length \[rad\].
    pub(super) fn heading(&self, length: f64) -> f64 {
        if let Some(heading) = self.steady {
            return heading;
        }
        PathRef::new(&self.segments).map_or(0.0, |path| path.pose_at(length).heading.0) + self.facing
    }

    /// Angle from the direction of travel to the heading of the robot at the end \[rad\].
    pub(super) fn facing_at_end(&self) -> f64 {
        let end = self.shapes.last().map(PlacedSegment::heading_at_end);
        self.steady.zip(end).map_or(self.facing, |(heading, end)| wrapped(heading - end))
    }

    /// Largest distance between the ends of its curve and its nodes \[m\].
    pub(super) fn gap(&self, points: &[[f64; 2]]) -> f64 {
        let ends = self.shapes.first().zip(self.shapes.last()).map(|(first, last)| [first.start, last.end()]);
        let off = |ends: [[f64; 2]; 2]| {
            let each =
                ends.iter().zip(self.ends).map(|(at, node)| (at[0] - points[node][0]).hypot(at[1] - points[node][1]));
            each.fold(0.0, f64::max)
        };
        ends.map_or(0.0, off)
    }

    /// The atom as a motion at 1 m/s.
    pub(super) fn motion<'m>(&'m self, body: &'m ConvexBody) -> Result<Motion<'m, f64>, InvalidInput> {
        body.motion(PathRef::new(&self.segments)?, ProfileRef::new(&self.phases)?, 0.0)
    }

    /// Position of a robot at a length \[m\].
    pub(super) fn point(&self, length: f64) -> [f64; 2] {
        let point = PathRef::new(&self.segments).map(|path| path.point_at(length)).unwrap_or_default();
        [point.x, point.y]
    }
}

fn side(turn: f64) -> TurnSide {
    if turn > 0.0 { TurnSide::Left } else { TurnSide::Right }
}

/// The segments, with turns in place where the shapes meet at an angle: without a length, or with the lever of the turn \[m\]. A robot that keeps its
/// heading does not turn there.
fn path(
    shapes: &[PlacedSegment],
    (at, heading): ([f64; 2], f64),
    (facing, steady): (f64, Option<f64>),
    lever: Option<&dyn Fn(f64) -> f64>,
) -> Result<Vec<Segment<f64>>, InvalidInput> {
    let mut heading = shapes.first().map_or(heading, |first| first.heading);
    let start = shapes.first().map_or(at, |first| first.start);
    let mut last = Segment::standing(Pose { position: Point::new(start[0], start[1]), heading: Radians(heading) })?;
    if facing != 0.0 {
        last = last.facing(Radians(facing))?;
    }
    let mut segments: Vec<Segment<f64>> = Vec::new();
    for placed in shapes {
        let turn = wrapped(placed.heading - heading);
        if turn != 0.0 {
            if let Some(lever) = lever.filter(|_| steady.is_none()) {
                let lever = lever(turn);
                last = last.then_pivot(lever, side(turn), lever * turn.abs())?;
                segments.push(last);
            } else {
                last = last.turned(Radians(turn))?;
                if let Some(before) = segments.last_mut() {
                    *before = last;
                }
            }
        }
        last = match placed.shape {
            PathSegment::Line { length } => last.then_line(length)?,
            PathSegment::Arc { radius, sweep, .. } if steady.is_some() => {
                last.then_steady_arc(radius, side(sweep), radius * sweep.abs())?
            }
            PathSegment::Arc { radius, sweep, .. } => last.then_arc(radius, side(sweep), radius * sweep.abs())?,
            // A route is of lines and arcs of edges, and turns where they meet.
            PathSegment::Turn { .. } | PathSegment::Kink { .. } => {
                return Err(InvalidInput::Disconnected("path with a turn of its own"));
            }
            PathSegment::Facing { .. } => return Err(InvalidInput::Disconnected("path that leaves its heading")),
        };
        if let Some(own) = steady {
            last = last.facing(Radians(wrapped(own - placed.heading)))?;
        }
        heading = placed.heading_at_end();
        segments.push(last);
    }
    if segments.is_empty() {
        segments.push(last);
    }
    Ok(segments)
}

/// A box around a curve.
fn bounds(shapes: &[PlacedSegment], at: [f64; 2]) -> [[f64; 2]; 2] {
    let mut bounds = [at, at];
    for placed in shapes {
        // No point of an arc is farther from its ends than its length.
        let (ends, room) = match placed.shape {
            PathSegment::Arc { .. } => ([placed.start, placed.end()], 0.5 * placed.shape.length()),
            _ => ([placed.start, placed.end()], 0.0),
        };
        for end in ends {
            for axis in 0..2 {
                bounds[0][axis] = bounds[0][axis].min(end[axis] - room);
                bounds[1][axis] = bounds[1][axis].max(end[axis] + room);
            }
        }
    }
    bounds
}
