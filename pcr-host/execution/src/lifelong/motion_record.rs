//! Records the motions of robots for the independent checker, which finds any contact during a run.

use super::robot::{LifelongRobot, RobotPhase};
use super::route_graph::RouteGraph;

use pcr_certify::motion::{Mover, meetings};
use pcr_certify::raw::{self, RawAgent, RawAngle, RawMotion, RawSegment};
use pcr_formats::scenario::{PathSegment, PlacedSegment};
use serde::Serialize;

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

    /// Checks the motions of robots of this radius \[m\] since the beginning of the window.
    pub(super) fn window(
        &mut self,
        site: &RouteGraph,
        robots: &mut [LifelongRobot],
        window: &mut CheckWindow,
        radius: f64,
        end: f64,
    ) {
        let begin = window.begin;
        let mut widened = false;
        let movers: Result<Vec<Mover>, String> = robots
            .iter_mut()
            .zip(&mut window.places)
            .enumerate()
            .map(|(id, (robot, place))| {
                let (phases, trail, since) = robot.report(place.since);
                let (mut agent, ends, gaps) =
                    agent(site, id as u64, radius, [begin, end], &phases, (&trail, since), place.at)?;
                *place = WindowStart::of(site, robot);
                // The recorded motion has to lead to where the robot is; otherwise nothing is certified. Two edges that meet at a node
                // may end slightly beside each other.
                let apart = (ends[0] - place.at[0]).hypot(ends[1] - place.at[1]);
                if apart > ROUNDING + gaps + 2.0 * site.position_error {
                    return Err(format!("robot {id}: its record ends at {ends:?}, it is at {:?}", place.at));
                }
                let gaps = if apart > ROUNDING { gaps + apart } else { gaps };
                agent.radius += gaps;
                widened |= gaps > 0.0;
                Mover::new(&agent, [begin, end])
            })
            .collect();
        window.begin = end;
        self.windows += 1;
        match movers {
            Ok(movers) => {
                let found = meetings(&movers);
                self.steps += found.steps;
                // If the discs were enlarged for such gaps, a contact of the enlarged discs proves nothing.
                let (contacts, undecided) = (found.contacts.len(), found.undecided.len());
                self.contacts += if widened { 0 } else { contacts };
                self.undecided += if widened { contacts + undecided } else { undecided };
            }
            Err(problem) => {
                self.error.get_or_insert(problem);
            }
        }
        self.verdict = match (self.contacts, self.undecided, &self.error) {
            (1.., ..) => "contact",
            (0, 0, None) => "proved",
            _ => "undecided",
        };
    }
}

/// Where and when a window of the check begins.
#[derive(Clone, Debug)]
pub(super) struct CheckWindow {
    begin: f64,
    places: Vec<WindowStart>,
}

#[derive(Clone, Copy, Debug)]
struct WindowStart {
    /// Length of the robot on its present atom \[m\].
    since: f64,
    /// Position of the robot \[m\].
    at: [f64; 2],
}

impl WindowStart {
    fn of(site: &RouteGraph, robot: &LifelongRobot) -> Self {
        Self { since: robot.along(), at: robot.way.point(site, robot.at) }
    }
}

impl CheckWindow {
    pub(super) fn new(site: &RouteGraph, robots: &[LifelongRobot]) -> Self {
        Self { begin: 0.0, places: robots.iter().map(|robot| WindowStart::of(site, robot)).collect() }
    }
}

/// The motion of a robot in a window, on these atoms from a length of the first one on. Also returns its last position, and the
/// sum of the gaps where shapes of the layout do not meet: the path here has no gaps, so it may be off by that sum \[m\].
fn agent(
    site: &RouteGraph,
    id: u64,
    radius: f64,
    [begin, end]: [f64; 2],
    phases: &[RobotPhase],
    (trail, since): (&[usize], f64),
    at: [f64; 2],
) -> Result<(RawAgent, [f64; 2], f64), String> {
    /// Largest gap that is rounding \[m\].
    const NO_GAP: f64 = 1e-9;
    let mut travel = RawMotion { start: begin, phases: Vec::new(), lag: 0.0, time_excess: 0.0 };
    let (mut time, mut length) = (0.0, 0.0);
    for phase in phases {
        // Each phase begins where the one before ends, except for rounding of the summed times.
        if (phase.time - begin - time).abs() > 1e-6 {
            return Err(format!("robot {id}: a gap in what it did at {} s", phase.time));
        }
        let to = time + phase.duration;
        let further = length + 0.5 * (phase.speed[0] + phase.speed[1]) * phase.duration;
        travel.phases.push(raw::RawPhase { time: [time, to], length: [length, further], speed: phase.speed });
        (time, length) = (to, further);
    }
    if (time - (end - begin)).abs() > 1e-6 {
        return Err(format!("robot {id}: what it did ends at {} s", begin + time));
    }
    let shapes: Vec<PlacedSegment> = trail.iter().flat_map(|&atom| site.atoms[atom].shapes.iter().copied()).collect();
    let gap = |pair: &[PlacedSegment]| {
        let (end, at) = (pair[0].end(), pair[1].start);
        (end[0] - at[0]).hypot(end[1] - at[1])
    };
    let gaps: f64 = shapes.windows(2).map(gap).filter(|gap| *gap > NO_GAP).sum();
    let parts = cut(&shapes, since, length);
    let ends = parts.last().map_or(at, PlacedSegment::end);
    Ok((RawAgent { id, radius, path: path(&parts, at, length), travel: Some(travel) }, ends, gaps))
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
            PathSegment::Line { .. } => None,
            PathSegment::Arc { radius, sweep } => Some(radius.copysign(sweep)),
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
