//! The path of a robot from node to node, and where it has to stop on it.

use super::network::Network;
use pcr_core::{Invalid, Motion, PathRef, Phase, Point, Pose, ProfileRef, Radians, Segment, Turn};
use pcr_formats::import::Step;
use pcr_formats::scenario::PathSegment;
use pcr_formats::scenario::Placed;
use std::f64::consts::{PI, TAU};

/// Angles below are no corner \[rad\].
const STRAIGHT: f64 = 1e-9;

/// A path, and what a robot does on it.
#[derive(Clone, Debug)]
pub(super) struct Way<'a> {
    segments: Vec<Segment<f64>>,
    length: f64,
    /// At 1 m/s: lengths are times.
    phases: Vec<Phase<f64>>,
    radius: f64,
    /// Where it begins.
    from: usize,
    steps: Vec<Step<'a>>,
    /// Length after each step \[m\].
    after: Vec<f64>,
    /// Lengths at which the robot stops and turns, and by how much \[m, rad\].
    pub(super) corners: Vec<(f64, f64)>,
    /// Length at which the goal is, if it is still ahead \[m\].
    pub(super) goal: Option<f64>,
}

impl<'a> Way<'a> {
    /// A robot that stands at a node.
    pub(super) fn standing(network: &Network<'a>, node: usize, radius: f64) -> Result<Self, Invalid> {
        Self::new(network, node, Vec::new(), radius, None)
    }

    /// Along these steps; the goal is after so many of them.
    pub(super) fn new(
        network: &Network<'a>,
        from: usize,
        steps: Vec<Step<'a>>,
        radius: f64,
        goal: Option<usize>,
    ) -> Result<Self, Invalid> {
        let mut shapes: Vec<Placed> = Vec::new();
        let (mut corners, mut after, mut length) = (Vec::new(), Vec::new(), 0.0);
        for step in &steps {
            for placed in step.curve().into_iter().filter(|placed| placed.shape.length() > 0.0) {
                let turn = shapes.last().map_or(0.0, |last| wrapped(placed.heading - last.heading_at_end()));
                if turn.abs() > STRAIGHT {
                    corners.push((length, turn));
                }
                length += placed.shape.length();
                // Lines that go on straight are one: fewer pieces.
                match (shapes.last_mut(), placed.shape) {
                    (Some(Placed { shape: PathSegment::Line { length: last }, .. }), PathSegment::Line { length })
                        if turn.abs() <= STRAIGHT =>
                    {
                        *last += length;
                    }
                    _ => shapes.push(placed),
                }
            }
            after.push(length);
        }
        let segments = path(shapes, network.at(from))?;
        let length = PathRef::new(&segments)?.length();
        let phases = if length > 0.0 { vec![Phase::starting_at(1.0, length, 0.0)?] } else { Vec::new() };
        let goal = goal.map(|goal| goal.checked_sub(1).map_or(0.0, |last| after[last]));
        let way = Self { segments, length, phases, radius, from, steps, after, corners, goal };
        way.try_motion().map(|_| ())?;
        Ok(way)
    }

    fn try_motion(&self) -> Result<Motion<'_, f64>, Invalid> {
        Motion::new(PathRef::new(&self.segments)?, ProfileRef::new(&self.phases)?, self.radius, 0.0)
    }

    /// For the table.
    pub(super) fn motion(&self) -> Motion<'_, f64> {
        self.try_motion().expect("checked by the constructor")
    }

    pub(super) fn length(&self) -> f64 {
        self.length
    }

    /// Where the robot is after so much \[m\].
    pub(super) fn point(&self, length: f64) -> [f64; 2] {
        let point = self.motion().path().point_at(length);
        [point.x, point.y]
    }

    /// The last node.
    pub(super) fn end(&self) -> usize {
        self.steps.last().map_or(self.from, |step| step.target())
    }

    /// The steps that are kept if another way is to begin at the first node from `stop` on, for a robot that is at `at` \[m\]: where they
    /// begin, what was before that, and the node where they end.
    pub(super) fn kept(&self, at: f64, stop: f64) -> (usize, Vec<Step<'a>>, f64, usize) {
        let last = self.after.iter().position(|&after| after >= stop - 1e-9).map_or(self.steps.len(), |k| k + 1);
        let first = self.after.iter().position(|&after| after >= at - 1e-9).unwrap_or(0).min(last);
        let before = first.checked_sub(1).map_or(0.0, |before| self.after[before]);
        let steps = self.steps[first..last].to_vec();
        let origin = steps.first().map_or(self.from, |step| step.origin());
        let node = steps.last().map_or(origin, |step| step.target());
        (origin, steps, before, node)
    }
}

fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// The segments, with turns in place where the shapes meet at an angle.
fn path(shapes: Vec<Placed>, at: [f64; 2]) -> Result<Vec<Segment<f64>>, Invalid> {
    let heading = shapes.first().map_or(0.0, |first| first.heading);
    let start = shapes.first().map_or(at, |first| first.at);
    let mut last = Segment::standing(Pose { position: Point::new(start[0], start[1]), heading: Radians(heading) })?;
    let mut segments: Vec<Segment<f64>> = Vec::new();
    let mut heading = heading;
    for placed in shapes {
        let turn = wrapped(placed.heading - heading);
        if turn != 0.0 {
            last = last.turned(Radians(turn))?;
            if let Some(before) = segments.last_mut() {
                *before = last;
            }
        }
        last = match placed.shape {
            PathSegment::Line { length } => last.then_line(length)?,
            PathSegment::Arc { radius, sweep } => {
                last.then_arc(radius, if sweep > 0.0 { Turn::Left } else { Turn::Right }, radius * sweep.abs())?
            }
        };
        heading = placed.heading_at_end();
        segments.push(last);
    }
    if segments.is_empty() {
        segments.push(last);
    }
    Ok(segments)
}
