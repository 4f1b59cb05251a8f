//! What a robot did from the beginning on, as an agent of a scenario: its path, and its speed on it.
//!
//! Turns in place of an outline have the length of its lever here, and those of a disc none, which turns while it stands; in a scenario
//! they are in radians. So the motion is cut at the stops before and after them, and scaled onto the length, or the angle, that the scenario
//! has in between.

use super::robot::{LifelongRobot, RobotPhase};
use super::route_element::STRAIGHT;
use super::route_graph::RouteGraph;
use crate::error::DrivenError;
use pcr_core::{Curve, TurnSide};
use pcr_formats::plane_geometry::wrapped;
use pcr_formats::scenario::{Agent, MotionPiece, MotionSpec, PathSegment, PlacedSegment};
use std::collections::VecDeque;

/// Lengths that differ by less are equal \[m\].
const NEAR: f64 = 1e-7;

/// Time that is rounding and nothing else \[s\].
const SHORT: f64 = 1e-9;

/// Longest time of a turn of a disc \[s\]: then it waits.
const SLOWEST: f64 = 5.0;

/// Angle that is rounding and nothing else \[rad\].
const NO_TURN: f64 = 1e-8;

/// A segment of the scenario.
struct DrivenSegment {
    shape: PathSegment,
    /// Lengths of the robot at its ends \[m\].
    driven: [f64; 2],
    /// Whether it is a turn while a disc stands.
    is_standing_turn: bool,
}

/// A path in the making.
#[derive(Default)]
struct DrivenPath {
    start: Option<[f64; 3]>,
    at: [f64; 2],
    heading: f64,
    /// Angle from the direction of travel to the heading of the robot \[rad\].
    facing: f64,
    /// Pose before the last segment.
    before: ([f64; 2], f64),
    driven: f64,
    segments: Vec<DrivenSegment>,
}

impl DrivenPath {
    fn push(&mut self, shape: PathSegment, driven: f64, is_standing_turn: bool) {
        self.before = (self.at, self.heading);
        let placed = PlacedSegment { start: self.at, heading: self.heading, shape };
        (self.at, self.heading) = (placed.end(), placed.heading_at_end());
        self.facing = shape.facing_after(self.facing);
        let ends = [self.driven, self.driven + driven];
        self.driven = ends[1];
        self.segments.push(DrivenSegment { shape, driven: ends, is_standing_turn });
    }

    /// The path begins here if it has not begun.
    fn begin(&mut self, at: [f64; 2], heading: f64) {
        if self.start.is_none() {
            (self.at, self.heading, self.start) = (at, heading, Some([at[0], at[1], heading]));
        }
    }

    /// Turns to a heading; the path begins here if it has not begun. A turn before takes what is missing by rounding.
    fn face(&mut self, at: [f64; 2], heading: f64) {
        self.begin(at, heading);
        let missing = wrapped(heading - self.heading);
        if missing != 0.0
            && missing.abs() < STRAIGHT
            && let Some(DrivenSegment { shape: PathSegment::Turn { sweep }, driven, is_standing_turn }) =
                self.segments.pop_if(|last| matches!(last.shape, PathSegment::Turn { .. }))
        {
            (self.at, self.heading) = self.before;
            self.driven = driven[0];
            self.push(PathSegment::Turn { sweep: sweep + missing }, driven[1] - driven[0], is_standing_turn);
        }
        let sweep = wrapped(heading - self.heading);
        if sweep.abs() > STRAIGHT {
            self.push(PathSegment::Turn { sweep }, 0.0, true);
        } else if sweep.abs() > NO_TURN {
            self.push(PathSegment::Kink { sweep }, 0.0, false);
        }
    }

    /// Goes on in a direction \[rad\] with this angle from it to the heading of the robot, which stands and does not turn where that changes.
    fn set_facing(&mut self, at: [f64; 2], direction: f64, facing: f64) {
        if wrapped(self.facing - facing).abs() > NO_TURN {
            self.face(if self.start.is_none() { at } else { self.at }, direction + facing - self.facing);
            self.push(PathSegment::Facing { before: self.facing, after: facing }, 0.0, false);
            self.facing = facing;
        }
    }

    /// Adds a line to a point.
    fn line(&mut self, from: [f64; 2], to: [f64; 2], driven: f64) {
        let at = if self.start.is_none() { from } else { self.at };
        if f64::hypot(to[0] - at[0], to[1] - at[1]) < NEAR {
            self.driven += driven;
            return;
        }
        self.face(at, PlacedSegment::line(at, to).heading);
        self.push(PlacedSegment::line(self.at, to).shape, driven, false);
    }
}

/// The agent of a robot that began at a node.
///
/// # Errors
/// A motion that is not along its path.
pub(super) fn agent(
    site: &RouteGraph,
    robot: &LifelongRobot,
    id: u64,
    label: &str,
    start: usize,
) -> Result<Agent, DrivenError> {
    let layer = site.layer_of(start);
    let vehicle = &site.layers[layer].vehicle;
    let mut path = DrivenPath::default();
    // Length of the robot before each atom.
    let mut before = Vec::with_capacity(robot.trail.len() + 1);
    let mut length = 0.0;
    for (k, &atom) in robot.trail.iter().enumerate() {
        before.push(length);
        let element = &site.atoms[atom];
        let is_last = k + 1 == robot.trail.len();
        let left = if is_last { robot.along().min(element.length) } else { element.length };
        add(&mut path, site, atom, left);
        length += left;
        path.driven = length;
    }
    let start = path.start.unwrap_or_else(|| {
        let [x, y] = site.points[start];
        [x, y, site.first_heading(start).unwrap_or(0.0)]
    });
    let pieces = pieces(&mut path, robot, &before, length)?;
    let motion = MotionSpec::Profile { v0: 0.0, pieces };
    Ok(Agent {
        id,
        label: label.to_owned(),
        radius: vehicle.radius,
        footprint: vehicle.footprint.clone(),
        loads: Vec::new(),
        margin: vehicle.margin,
        t_start: 0.0,
        start,
        path: path.segments.iter().map(|segment| segment.shape).collect(),
        motion,
    })
}

/// Adds the first metres of an atom.
fn add(path: &mut DrivenPath, site: &RouteGraph, atom: usize, mut left: f64) {
    let element = &site.atoms[atom];
    if !site.is_outline(element.layer) {
        for placed in &element.shapes {
            let keep = placed.shape.length().min(left);
            left -= keep;
            if keep <= 0.0 {
                continue;
            }
            let part = placed.part(0.0, keep);
            match part.shape {
                PathSegment::Line { .. } => path.line(part.start, part.end(), keep),
                _ => {
                    path.face(part.start, part.heading);
                    path.push(part.shape, keep, false);
                }
            }
        }
        return;
    }
    for segment in &element.segments {
        let keep = segment.length().min(left);
        left -= keep;
        if keep <= 0.0 {
            continue;
        }
        let point = |length: f64| {
            let point = segment.point_at(length);
            [point.x, point.y]
        };
        let signed = |angle: f64, turn: TurnSide| if turn == TurnSide::Left { angle } else { -angle };
        // At a node the heading of a turn is that of the robot.
        let heading = segment.heading_at(0.0).0;
        if element.edge.is_some() {
            let own = element.steady.map_or(element.facing, |own| wrapped(own - heading));
            path.set_facing(point(0.0), heading, own);
        }
        match segment.curve() {
            Curve::Line => path.line(point(0.0), point(keep), keep),
            Curve::Arc { radius, turn } => {
                path.face(point(0.0), heading);
                let steady = element.steady.is_some();
                path.push(PathSegment::Arc { radius, sweep: signed(keep / radius, turn), steady }, keep, false);
            }
            Curve::Pivot { lever, turn } => {
                path.begin(point(0.0), heading);
                let missing = wrapped(heading + element.facing - path.heading - path.facing);
                let sweep = signed(keep / lever, turn) + missing;
                let is_passed = sweep.abs() <= STRAIGHT;
                path.push(
                    if is_passed { PathSegment::Kink { sweep } } else { PathSegment::Turn { sweep } },
                    keep,
                    false,
                );
            }
        }
    }
}

/// A part of a motion.
struct DrivenPhase {
    /// \[s\]
    duration: f64,
    /// Speed at its end \[m/s\]; in place \[rad/s\].
    end: f64,
    in_place: bool,
}

/// These motions as pieces of a profile. A reader sums them up, so each takes back the rounding of those before it.
fn balanced(motions: Vec<DrivenPhase>) -> Vec<MotionPiece> {
    let (mut speed, mut rotation) = (0.0, 0.0);
    let piece = |DrivenPhase { duration, end, in_place }| {
        let now = if in_place { &mut rotation } else { &mut speed };
        let acceleration = (end - *now) / duration;
        // At a stop a reader takes what rounding leaves for none.
        *now = if end == 0.0 { 0.0 } else { *now + acceleration * duration };
        MotionPiece { duration, acceleration, in_place }
    };
    motions.into_iter().filter(|motion| motion.duration > 0.0).map(piece).collect()
}

/// The profile along the path. A turn of a disc that it does not stand for becomes a kink.
fn pieces(
    path: &mut DrivenPath,
    robot: &LifelongRobot,
    before: &[f64],
    length: f64,
) -> Result<Vec<MotionPiece>, DrivenError> {
    let borders: Vec<f64> = path.segments.iter().flat_map(|segment| segment.driven).collect();
    let is_border = |at: f64| borders.iter().any(|border| (border - at).abs() < NEAR);
    // Stops where a segment ends, and the end.
    let mut stops: Vec<(f64, f64)> = vec![(0.0, 0.0)];
    for &(time, atoms, along) in &robot.stops {
        let end = before.get(atoms).copied().unwrap_or(length);
        let at = atoms.checked_sub(1).map_or(0.0, |last| f64::min(before[last] + along, end));
        if at > stops[stops.len() - 1].1 + NEAR && is_border(at) {
            stops.push((time, at));
        }
    }
    let mut pieces = Vec::new();
    let mut phases: VecDeque<RobotPhase> = robot.done.iter().copied().collect();
    let mut next = 0;
    for (k, &(_, from)) in stops.iter().enumerate() {
        let (until, to) = stops.get(k + 1).copied().unwrap_or((f64::INFINITY, length));
        // What the robot did until it stopped there, with the time for which it stood first.
        let (mut stood, mut done) = (0.0, Vec::new());
        while phases.front().is_some_and(|phase| phase.time < until - SHORT)
            && let Some(mut phase) = phases.pop_front()
        {
            let is_still = phase.speed == [0.0; 2];
            let beyond = phase.time + phase.duration - until;
            if is_still && beyond > SHORT {
                phase.duration -= beyond;
                phases.push_front(RobotPhase { time: until, duration: beyond, ..phase });
            }
            if is_still && done.is_empty() { stood += phase.duration } else { done.push(phase) }
        }
        // The segments between the two stops.
        let (mut standing, mut turning, mut ahead) = (0.0, 0.0, 0.0);
        while let Some(segment) = path.segments.get_mut(next) {
            let is_turn = segment.is_standing_turn;
            let is_inside = if is_turn { segment.driven[0] < to - NEAR } else { segment.driven[1] < to + NEAR };
            if !is_inside {
                break;
            }
            let is_first = segment.driven[0] < from + NEAR;
            match segment.shape {
                PathSegment::Turn { sweep } if is_turn && is_first => standing += sweep.abs(),
                PathSegment::Turn { sweep } if is_turn => segment.shape = PathSegment::Kink { sweep },
                PathSegment::Turn { sweep } => turning += sweep.abs(),
                shape => ahead += shape.length(),
            }
            next += 1;
        }
        if (standing > 0.0 && stood <= 0.0) || (turning > 0.0 && ahead > 0.0) {
            return Err(DrivenError::TurnWithoutStop);
        }
        let mut phase = |duration, end, in_place| pieces.push(DrivenPhase { duration, end, in_place });
        if standing > 0.0 {
            let time = stood.min(SLOWEST);
            phase(0.5 * time, 2.0 * standing / time, true);
            phase(0.5 * time, 0.0, true);
            stood -= time;
        }
        phase(stood, 0.0, false);
        let driven: f64 = done.iter().map(|phase| 0.5 * (phase.speed[0] + phase.speed[1]) * phase.duration).sum();
        let way = ahead + turning;
        if way > 0.0 && driven <= 0.0 {
            return Err(DrivenError::PathWithoutMotion);
        }
        let scale = if driven > 0.0 { way / driven } else { 0.0 };
        for own in done {
            let moves = own.speed.iter().any(|speed| *speed > 0.0);
            phase(own.duration, own.speed[1] * scale, turning > 0.0 && moves);
        }
    }
    Ok(balanced(pieces))
}
