//! How far a motion in a number format is from that in the scenario: the conversion loses digits.

use super::{Fleet, FormatRangeError, HostScalar};
use pcr_core::Motion;
use pcr_formats::footprint::Footprint;
use pcr_formats::scenario::{Agent, PathSegment, PlacedSegment, Scenario};
use pcr_formats::warning::WarningCode;
use std::f64::consts::{PI, TAU};

/// What a format makes of a motion, at most.
#[derive(Clone, Copy, Debug)]
struct RoundingBounds {
    /// Distance of the disc from where the scenario has it at the same time \[m\].
    distance: f64,
    /// Difference of lengths along the path \[m\].
    length: f64,
}

impl RoundingBounds {
    /// That of a motion of an agent.
    ///
    /// Where paths differ: points at the same share of a segment are as far apart as its starts, and along it by the difference
    /// of the headings times its length, and by that of the lengths. Where times differ: a difference of two motions is a
    /// parabola between two times at which one of them changes its acceleration.
    fn of<S: HostScalar>(agent: &Agent, motion: &Motion<'_, S>) -> Self {
        let Self { distance, length } = of_path::<S>(agent);
        // On an arc corners of an outline go farther than its reference point.
        let curvatures = agent.path.iter().map(|segment| match *segment {
            PathSegment::Arc { radius, steady: false, .. } => 1.0 / radius,
            _ => 0.0,
        });
        let lever = 1.0 + spread(agent) * curvatures.fold(0.0, f64::max);
        Self { distance: distance + lever * (2.0 * length + of_times(agent, motion)), length }
    }
}

/// The largest distance from the motion in the file without a warning \[m\].
const UNTOLD: f64 = 1e-3;

/// Returns the warning of [`super::rounded`].
pub(super) fn warning<S: HostScalar>(scenario: &Scenario) -> Result<Option<String>, FormatRangeError> {
    if S::NAME == f64::NAME {
        return Ok(None);
    }
    let fleet = Fleet::<S>::new(scenario)?;
    let motions = fleet.motions();
    let distances =
        scenario.agents.iter().zip(&motions).map(|(agent, motion)| (RoundingBounds::of(agent, motion).distance, agent));
    let told: Vec<(f64, &Agent)> = distances.filter(|(distance, _)| *distance > UNTOLD).collect();
    let worst = told.iter().max_by(|(a, _), (b, _)| a.total_cmp(b));
    Ok(worst.map(|(distance, agent)| {
        let (format, count, all, called) = (S::NAME, told.len(), motions.len(), agent.display_name());
        WarningCode::NumberFormat.text(format_args!(
            "rounding to {format} moves {count} of {all} agents by more than 1 mm; agent {called} is up to {distance:.3} m from where \
             the file has it"
        ))
    }))
}

/// Largest distance of a point of the outline from the reference point \[m\]; 0 for a disc, which does not turn.
fn spread(agent: &Agent) -> f64 {
    agent.footprint.as_ref().map_or(0.0, Footprint::circumscribed_radius)
}

/// The number that the format holds.
fn representable<S: HostScalar>(value: f64) -> f64 {
    S::from_f64(value).to_f64()
}

/// The angle that the format holds.
fn held_angle<S: HostScalar>(radians: f64) -> f64 {
    S::radians(S::angle(radians).expect("an agent that has a motion"))
}

fn of_path<S: HostScalar>(agent: &Agent) -> RoundingBounds {
    let [x, y, heading] = agent.start;
    let stands =
        |[x, y]: [f64; 2], heading| PlacedSegment { start: [x, y], heading, shape: PathSegment::Line { length: 0.0 } };
    let mut exact = stands([x, y], heading);
    let mut rounded = stands([representable::<S>(x), representable::<S>(y)], held_angle::<S>(heading));
    let (mut rounding, mut longer) = (RoundingBounds { distance: 0.0, length: 0.0 }, 0.0_f64);
    for &segment in &agent.path {
        let (from, to) = (exact.end(), rounded.end());
        let apart = (from[0] - to[0]).hypot(from[1] - to[1]);
        let turned = (exact.heading_at_end() - rounded.heading_at_end()).rem_euclid(TAU);
        let turned = if turned > PI { TAU - turned } else { turned };
        let mut next = PlacedSegment { start: to, heading: rounded.heading_at_end(), shape: segment };
        let (length, mut bent) = (segment.length(), 0.0);
        let turns = segment.turns();
        let kept = representable::<S>(length / turns) * turns;
        next.shape = match segment {
            PathSegment::Line { .. } => PathSegment::Line { length: kept },
            PathSegment::Arc { radius, sweep, steady } => {
                let radius = representable::<S>(radius);
                let rounded = if radius > 0.0 { (kept / radius).copysign(sweep) } else { 0.0 };
                bent = (rounded - sweep).abs();
                PathSegment::Arc { radius, sweep: rounded, steady }
            }
            PathSegment::Turn { sweep } | PathSegment::Kink { sweep } => {
                PathSegment::Kink { sweep: held_angle::<S>(sweep) }
            }
            // By what the angles differ in the format.
            PathSegment::Facing { before, after } => {
                PathSegment::Kink { sweep: held_angle::<S>(before) - held_angle::<S>(after) }
            }
        };
        let differs = next.shape.length() - length;
        longer += differs;
        rounding.length = rounding.length.max(longer.abs());
        let way = apart + (length + spread(agent)) * (turned + bent) + differs.abs();
        rounding.distance = rounding.distance.max(way);
        exact = PlacedSegment { start: from, heading: exact.heading_at_end(), shape: segment };
        rounded = next;
    }
    let (from, to) = (exact.end(), rounded.end());
    rounding.distance = rounding.distance.max((from[0] - to[0]).hypot(from[1] - to[1]));
    rounding
}

/// Time, length, speed and acceleration from then on.
type MotionKnot = [f64; 4];

fn of_times<S: HostScalar>(agent: &Agent, motion: &Motion<'_, S>) -> f64 {
    let (mut speed, pieces) = agent.motion.pieces(agent.length());
    let (mut time, mut length) = (agent.t_start, 0.0);
    let mut exact: Vec<MotionKnot> = Vec::new();
    for (duration, acceleration) in pieces {
        exact.push([time, length, speed, acceleration]);
        time += duration;
        length += (speed + 0.5 * acceleration * duration) * duration;
        speed += acceleration * duration;
    }
    exact.push([time, length, 0.0, 0.0]);
    let start = motion.time().lo.to_f64();
    let mut rounded: Vec<MotionKnot> = Vec::new();
    for phase in motion.profile().phases() {
        let [before, _] = phase.speed().map(S::to_f64);
        let (time, length) = (phase.time().lo.to_f64(), phase.length().lo.to_f64());
        rounded.push([start + time, length, before, phase.acceleration().to_f64()]);
    }
    let end = start + motion.profile().duration().to_f64();
    rounded.push([end, motion.profile().length().to_f64(), 0.0, 0.0]);
    let mut times: Vec<f64> = exact.iter().chain(&rounded).map(|knot| knot[0]).collect();
    times.sort_by(f64::total_cmp);
    let bound = |pair: &[f64]| {
        let [a, b] = [pair[0], pair[1]];
        let middle = 0.5 * (a + b);
        let differs = |time: f64| (at(&exact, time, middle)[0] - at(&rounded, time, middle)[0]).abs();
        let bends = (at(&exact, middle, middle)[1] - at(&rounded, middle, middle)[1]).abs();
        differs(a).max(differs(b)) + 0.125 * bends * (b - a) * (b - a)
    };
    times.windows(2).map(bound).fold(0.0, f64::max)
}

/// Length and acceleration at a time by the piece that holds another one.
fn at(knots: &[MotionKnot], time: f64, within: f64) -> [f64; 2] {
    match knots.partition_point(|knot| knot[0] <= within).checked_sub(1).and_then(|place| knots.get(place)) {
        None => [0.0, 0.0],
        Some(&[from, length, speed, acceleration]) => {
            let elapsed = time - from;
            [length + (speed + 0.5 * acceleration * elapsed) * elapsed, acceleration]
        }
    }
}
