//! Records the motions of robots for the independent checker, which finds any contact during a run.

use super::robot::{LifelongRobot, RobotPhase};
use super::route_element::STRAIGHT;
use super::route_graph::RouteGraph;
use pcr_formats::plane_geometry::wrapped;

use pcr_certify::error::CertifyError;
use pcr_certify::motion::{MotionFindings, Mover, meetings};
use pcr_certify::outline::motion::Driven;
use pcr_certify::outline::{self, Body, RawBody, RawBodySegment, RawCourse, RawHeading, RawOutline};
use pcr_certify::raw::{self, RawAgent, RawAngle, RawMotion, RawSegment};
use pcr_core::{Curve, TurnSide};
use pcr_formats::scenario::{PathSegment, PlacedSegment};
use serde::Serialize;
use std::fmt;

/// Result of the checker for all windows of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct RunCertificate {
    /// `proved`: no contact at any time. `contact`: there is one. `undecided`: so near that rounding does not tell, or not checked.
    pub verdict: &'static str,
    /// Number of windows of time.
    pub windows: usize,
    /// Number of intervals of time that were examined.
    pub steps: usize,
    /// Number of pairs of robots with a contact, in all windows.
    pub contacts: usize,
    /// Number of pairs without a decision.
    pub undecided: usize,
    /// Reason why there is no verdict.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// Places that differ by at most this are equal \[m\].
const ROUNDING: f64 = 1e-6;

impl RunCertificate {
    /// A certificate before anything is checked.
    pub(super) fn new() -> Self {
        Self { verdict: "undecided", ..Self::default() }
    }

    /// Checks the motions of robots since the beginning of the window.
    pub(super) fn window(
        &mut self,
        site: &RouteGraph,
        robots: &mut [LifelongRobot],
        window: &mut CheckWindow,
        end: f64,
    ) {
        let begin = window.begin;
        let mut widened = false;
        let records: Result<Vec<RecordedMotion>, RecordError> = robots
            .iter_mut()
            .zip(window.places.iter_mut().zip(&window.layers))
            .enumerate()
            .map(|(id, (robot, (place, &layer)))| {
                robot.stops.clear();
                let (phases, trail, since) = robot.report(place.since);
                let (mut record, ends, gaps) =
                    RecordedMotion::of(site, (id as u64, layer), [begin, end], &phases, (&trail, since), *place)?;
                *place = WindowStart::of(site, robot);
                // The recorded motion has to lead to where the robot is; otherwise nothing is certified. Two edges that meet at a node
                // may end slightly beside each other.
                let apart = (ends.at[0] - place.at[0]).hypot(ends.at[1] - place.at[1]);
                if apart > ROUNDING + gaps + 2.0 * site.position_error {
                    return Err(RecordError::Place(id as u64, [ends.at, place.at]));
                }
                if site.is_outline(layer) && wrapped(ends.heading - place.heading).abs() > JUMP {
                    return Err(RecordError::Heading(id as u64, [ends.heading, place.heading]));
                }
                let gaps = if apart > ROUNDING { gaps + apart } else { gaps };
                record.grow(gaps);
                widened |= gaps > 0.0;
                Ok(record)
            })
            .collect();
        let result = records.and_then(|records| found(&records, [begin, end]).map_err(RecordError::Certify));
        window.begin = end;
        self.windows += 1;
        match result {
            Ok(found) => {
                self.steps += found.steps;
                // If the discs were enlarged for such gaps, a contact of the enlarged discs proves nothing.
                let (contacts, undecided) = (found.contacts.len(), found.undecided.len());
                self.contacts += if widened { 0 } else { contacts };
                self.undecided += if widened { contacts + undecided } else { undecided };
            }
            Err(problem) => {
                self.error.get_or_insert(problem.to_string());
            }
        }
        self.verdict = match (self.contacts, self.undecided, &self.error) {
            (1.., ..) => "contact",
            (0, 0, None) => "proved",
            _ => "undecided",
        };
    }
}

/// Why recorded motions are not certified.
#[derive(Clone, Debug, PartialEq)]
enum RecordError {
    /// The record of this robot has a gap at this time \[s\].
    Gap(u64, f64),
    /// The record of this robot ends at this time \[s\], before the others.
    Short(u64, f64),
    /// The record of this robot ends at the first point, and the robot is at the second one \[m\].
    Place(u64, [[f64; 2]; 2]),
    /// The record of this robot ends with the first heading, and the robot has the second one \[rad\].
    Heading(u64, [f64; 2]),
    /// The motions are no input of the certificate.
    Certify(CertifyError),
}

impl fmt::Display for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gap(id, time) => write!(f, "robot {id}: a gap in what it did at {time} s"),
            Self::Short(id, time) => write!(f, "robot {id}: what it did ends at {time} s"),
            Self::Place(id, [recorded, now]) => {
                write!(f, "robot {id}: its record ends at {recorded:?}, it is at {now:?}")
            }
            Self::Heading(id, [recorded, now]) => {
                write!(f, "robot {id}: its record ends with the heading {recorded}, it has {now}")
            }
            Self::Certify(wrong) => wrong.fmt(f),
        }
    }
}

/// Where and when a window of the check begins.
#[derive(Clone, Debug)]
pub(super) struct CheckWindow {
    begin: f64,
    places: Vec<WindowStart>,
    /// The layer of each robot.
    layers: Vec<usize>,
}

#[derive(Clone, Copy, Debug)]
struct WindowStart {
    /// Length of the robot on its present atom \[m\].
    since: f64,
    /// Position of the robot \[m\].
    at: [f64; 2],
    /// Heading of an outline \[rad\].
    heading: f64,
}

impl WindowStart {
    fn of(site: &RouteGraph, robot: &LifelongRobot) -> Self {
        let heading = robot.way.heading_at(site, robot.at);
        Self { since: robot.along(), at: robot.way.point(site, robot.at), heading }
    }
}

impl CheckWindow {
    pub(super) fn new(site: &RouteGraph, robots: &[LifelongRobot]) -> Self {
        let layers = robots.iter().map(|robot| site.layer_of(robot.way.end())).collect();
        Self { begin: 0.0, places: robots.iter().map(|robot| WindowStart::of(site, robot)).collect(), layers }
    }
}

/// A motion for the checker.
enum RecordedMotion {
    Disc(RawAgent),
    Outline(RawBody),
}

/// The contacts of these motions.
fn found(records: &[RecordedMotion], time: [f64; 2]) -> Result<MotionFindings, CertifyError> {
    let discs = records.iter().map(|record| match record {
        RecordedMotion::Disc(agent) => Some(agent),
        RecordedMotion::Outline(_) => None,
    });
    if let Some(discs) = discs.collect::<Option<Vec<_>>>() {
        let movers: Result<Vec<Mover>, CertifyError> = discs.into_iter().map(|agent| Mover::new(agent, time)).collect();
        return Ok(meetings(&movers?));
    }
    let bodies: Vec<RawBody> = records.iter().map(RecordedMotion::body).collect();
    let outlines: Vec<Body<'_>> = bodies.iter().map(Body::new).collect::<Result<_, _>>()?;
    let driven: Result<Vec<Driven<'_>>, CertifyError> = outlines.iter().map(|body| Driven::new(body, time)).collect();
    Ok(outline::motion::meetings(&driven?))
}

impl RecordedMotion {
    /// The motion of a robot in a window, on these atoms from a length of the first one on. Also returns where it ends, and the
    /// sum of the gaps where shapes of the layout do not meet: the path here has no gaps, so it may be off by that sum \[m\].
    fn of(
        site: &RouteGraph,
        (id, layer): (u64, usize),
        window: [f64; 2],
        phases: &[RobotPhase],
        (trail, since): (&[usize], f64),
        begin: WindowStart,
    ) -> Result<(Self, WindowStart, f64), RecordError> {
        let (travel, length) = travel(id, window, phases)?;
        if site.is_outline(layer) {
            return Ok(body(site, (id, layer), travel, length, (trail, since), begin));
        }
        let shapes: Vec<PlacedSegment> =
            trail.iter().flat_map(|&atom| site.atoms[atom].shapes.iter().copied()).collect();
        let gap = |pair: &[PlacedSegment]| {
            let (end, at) = (pair[0].end(), pair[1].start);
            (end[0] - at[0]).hypot(end[1] - at[1])
        };
        let gaps: f64 = shapes.windows(2).map(gap).filter(|gap| *gap > NO_GAP).sum();
        let parts = cut(&shapes, since, length);
        let end = parts.last().map_or(begin.at, PlacedSegment::end);
        let (path, radius) = (path(&parts, begin.at, length), site.layers[layer].shape.reach());
        let agent = RawAgent { id, radius, path, travel: Some(travel) };
        Ok((Self::Disc(agent), WindowStart { at: end, ..begin }, gaps))
    }

    /// Returns the body that moves so. A disc keeps its heading, because it turns without moving.
    fn body(&self) -> RawBody {
        match self {
            Self::Outline(body) => body.clone(),
            Self::Disc(RawAgent { id, radius, path, travel }) => RawBody {
                id: *id,
                outline: RawOutline { corners: vec![[0.0; 2]], radius: *radius },
                start: path.start,
                direction: path.heading,
                segments: path
                    .segments
                    .iter()
                    .map(|segment| RawBodySegment {
                        course: segment.radius.map_or(RawCourse::Line, |radius| RawCourse::Arc { radius }),
                        length: segment.length,
                        turns: segment.turns.clone(),
                        heading: RawHeading::Steady(RawAngle::Radians(0.0)),
                        from: segment.from,
                        to: segment.to,
                    })
                    .collect(),
                rounding: path.rounding,
                jump: JUMP,
                step: path.step,
                travel: travel.clone(),
            },
        }
    }

    /// Makes the robot larger by so much all around \[m\].
    fn grow(&mut self, by: f64) {
        match self {
            Self::Disc(agent) => agent.radius += by,
            Self::Outline(body) => body.outline.radius += by,
        }
    }
}

/// Largest gap that is rounding \[m\].
const NO_GAP: f64 = 1e-9;

/// Largest change of heading where an outline does not turn \[rad\].
const JUMP: f64 = 2.0 * STRAIGHT;

/// The times of the phases in a window, and the length that is travelled \[m\].
fn travel(id: u64, [begin, end]: [f64; 2], phases: &[RobotPhase]) -> Result<(RawMotion, f64), RecordError> {
    let mut travel = RawMotion { start: begin, phases: Vec::new(), lag: 0.0, time_excess: 0.0 };
    let (mut time, mut length) = (0.0, 0.0);
    for phase in phases {
        // Each phase begins where the one before ends, except for rounding of the summed times.
        if (phase.time - begin - time).abs() > 1e-6 {
            return Err(RecordError::Gap(id, phase.time));
        }
        let to = time + phase.duration;
        let further = length + 0.5 * (phase.speed[0] + phase.speed[1]) * phase.duration;
        travel.phases.push(raw::RawPhase { time: [time, to], length: [length, further], speed: phase.speed });
        (time, length) = (to, further);
    }
    if (time - (end - begin)).abs() > 1e-6 {
        return Err(RecordError::Short(id, begin + time));
    }
    Ok((travel, length))
}

/// The motion of an outline: the segments of these atoms, with their turns in place.
fn body(
    site: &RouteGraph,
    (id, layer): (u64, usize),
    travel: RawMotion,
    length: f64,
    (trail, since): (&[usize], f64),
    begin: WindowStart,
) -> (RecordedMotion, WindowStart, f64) {
    let (corners, radius) = site.layers[layer].shape.corners();
    let (mut before, mut left, mut gaps, mut from) = (since, length, 0.0, 0.0);
    let mut segments: Vec<RawBodySegment> = Vec::new();
    let (mut direction, mut heading) = (begin.heading, begin.heading);
    let (mut at, mut end, mut joint) = (None, None, None::<[f64; 2]>);
    let all = trail.iter().flat_map(|&atom| {
        let element = &site.atoms[atom];
        element.segments.iter().filter(|segment| segment.length() > 0.0).map(move |segment| (segment, element))
    });
    for (segment, element) in all {
        let place = |u: f64| {
            let point = segment.point_at(u);
            [point.x, point.y]
        };
        let start = place(0.0);
        let gap = joint.map_or(0.0, |joint| f64::hypot(start[0] - joint[0], start[1] - joint[1]));
        gaps += if gap > NO_GAP { gap } else { 0.0 };
        joint = Some(place(segment.length()));
        let skip = before.min(segment.length());
        before -= skip;
        let keep = (segment.length() - skip).min(left);
        if keep <= 0.0 {
            continue;
        }
        left -= keep;
        let start = segment.heading_at(skip).0;
        let turned = if segments.is_empty() { 0.0 } else { wrapped(start - direction) };
        if segments.is_empty() {
            (direction, at) = (start, Some((place(skip), start)));
        }
        let turns = if turned == 0.0 { Vec::new() } else { vec![RawAngle::Radians(turned)] };
        let signed = |number: f64, turn: TurnSide| if turn == TurnSide::Left { number } else { -number };
        let (course, sweep) = match segment.curve() {
            Curve::Line => (RawCourse::Line, 0.0),
            Curve::Arc { radius, turn } => {
                (RawCourse::Arc { radius: signed(radius, turn) }, signed(keep / radius, turn))
            }
            Curve::Pivot { lever, turn } => {
                (RawCourse::Pivot { lever: signed(lever, turn) }, signed(keep / lever, turn))
            }
        };
        let to = from + keep;
        segments.push(RawBodySegment {
            course,
            length: keep,
            turns,
            heading: match element.steady {
                Some(heading) => RawHeading::Steady(RawAngle::Radians(heading)),
                None => RawHeading::Along(RawAngle::Radians(element.facing)),
            },
            from,
            to,
        });
        from = to;
        direction += turned + sweep;
        heading = element.steady.unwrap_or(start + sweep + element.facing);
        end = Some(place(skip + keep));
    }
    let (start, angle) = at.unwrap_or((begin.at, begin.heading));
    if segments.is_empty() {
        segments.push(RawBodySegment {
            course: RawCourse::Line,
            length: 0.0,
            turns: Vec::new(),
            heading: RawHeading::Along(RawAngle::Radians(0.0)),
            from: 0.0,
            to: 0.0,
        });
    }
    let body = RawBody {
        id,
        outline: RawOutline { corners, radius },
        start,
        direction: RawAngle::Radians(angle),
        segments,
        rounding: f64::EPSILON * length.max(1.0) * 16.0,
        jump: JUMP,
        step: 0.0,
        travel: Some(travel),
    };
    (RecordedMotion::Outline(body), WindowStart { at: end.unwrap_or(begin.at), heading, ..begin }, gaps)
}

/// The part of some shapes from a length on, with this length.
fn cut(shapes: &[PlacedSegment], from: f64, length: f64) -> Vec<PlacedSegment> {
    let (mut before, mut left) = (from, length);
    let mut parts = Vec::new();
    for placed in shapes {
        let whole = placed.shape.length();
        let skip = before.min(whole);
        before -= skip;
        let keep = (whole - skip).min(left);
        if keep > 0.0 {
            parts.push(placed.part(skip, skip + keep));
            left -= keep;
        }
    }
    parts
}

/// A path along the shapes; without shapes the robot stands.
fn path(shapes: &[PlacedSegment], at: [f64; 2], length: f64) -> raw::RawPath {
    let first = shapes.first();
    let mut heading = first.map_or(0.0, |first| first.heading);
    let start = first.map_or(at, |first| first.start);
    let path_heading = RawAngle::Radians(heading);
    let mut segments = Vec::new();
    let mut from = 0.0;
    for placed in shapes {
        let turn = placed.heading - heading;
        let long = placed.shape.length();
        let radius = match placed.shape {
            PathSegment::Arc { radius, sweep, .. } => Some(radius.copysign(sweep)),
            _ => None,
        };
        let turns = if turn == 0.0 { Vec::new() } else { vec![RawAngle::Radians(turn)] };
        segments.push(RawSegment { length: long, radius, turns, from, to: from + long });
        from += long;
        heading = placed.heading_at_end();
    }
    if segments.is_empty() {
        segments.push(RawSegment { length: 0.0, radius: None, turns: Vec::new(), from: 0.0, to: 0.0 });
    }
    raw::RawPath { start, heading: path_heading, segments, rounding: f64::EPSILON * length.max(1.0) * 16.0, step: 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_certify::raw::{RawPath, RawPhase};

    /// A robot that goes 4 m to the east at 1 m/s, past the origin.
    fn path(start: [f64; 2]) -> (RawPath, RawMotion) {
        let segments = vec![RawSegment { length: 4.0, radius: None, turns: Vec::new(), from: 0.0, to: 4.0 }];
        let path = RawPath { start, heading: RawAngle::Radians(0.0), segments, rounding: 1e-14, step: 0.0 };
        let phases = vec![RawPhase { time: [0.0, 4.0], length: [0.0, 4.0], speed: [1.0; 2] }];
        (path, RawMotion { start: 0.0, phases, lag: 0.0, time_excess: 0.0 })
    }

    #[test]
    fn discs_and_outlines_are_judged_together() {
        for (beside, contacts) in [(0.56, 0), (0.54, 1)] {
            let (own, travel) = path([-2.0, 0.0]);
            let disc = RecordedMotion::Disc(RawAgent { id: 1, radius: 0.25, path: own, travel: Some(travel) });
            // A rectangle, 0.6 m wide, that drives beside the disc.
            let (its, travel) = path([-2.0, beside]);
            let corners = vec![[-0.4, -0.3], [0.4, -0.3], [0.4, 0.3], [-0.4, 0.3]];
            let other = RawAgent { id: 2, radius: 0.0, path: its, travel: Some(travel) };
            let mut body = RecordedMotion::Disc(other).body();
            body.outline.corners = corners;
            let found = found(&[disc, RecordedMotion::Outline(body)], [0.0, 4.0]).expect("motions");
            assert_eq!((found.contacts.len(), found.undecided.len()), (contacts, 0), "{beside}");
        }
    }
}
