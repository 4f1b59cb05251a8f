//! Turns in place and kinks of outlines. The path of a scenario has no length for them, but an outline sweeps an area meanwhile, so each of
//! them becomes a segment with a length.

use super::HostScalar;
use pcr_formats::scenario::{Agent, MotionSpec, PathSegment, SegmentPhase};

/// Length for each radian where the agent comes to rest before and after a turn \[m\]: a speed of 1 m/s is one of 1 rad/s.
const LEVER: f64 = 1.0;

/// Time of a turn that takes none where the agent stands \[s\].
const SHORTEST: f64 = 1e-3;

/// The motion of an agent that turns in place, on the path in which turns have a length.
pub(super) struct TurningMotion {
    /// For each segment of the scenario the length for each radian of it \[m\]; 0 for what is no turn.
    pub(super) levers: Vec<f64>,
    pub(super) motion: MotionSpec,
    /// How far the agent is from where it would be without lengths of turns that it passes without a stop, at most \[m\].
    pub(super) off: f64,
}

/// The motion of an agent with turns in place; `None` if it has none.
pub(super) fn turning<S: HostScalar>(agent: &Agent) -> Option<TurningMotion> {
    let sweep = |segment: &PathSegment| match *segment {
        PathSegment::Turn { sweep } | PathSegment::Kink { sweep } if sweep != 0.0 => Some(sweep.abs()),
        _ => None,
    };
    agent.path.iter().find_map(sweep)?;
    let parts = agent.parts();
    let along = agent.path.iter().zip(&parts).filter(|(segment, _)| !segment.takes_turning());
    let phases = along.flat_map(|(_, phases)| phases);
    let top = phases.flat_map(|phase| [phase.before, phase.after]).fold(0.0, f64::max);
    let (mut speed, _) = agent.motion.pieces(agent.length());
    let [x, y, _] = agent.start;
    let extent = x.abs().max(y.abs()) + agent.length() + agent.circumscribed_radius();
    // What the turn adds to the path, and the rounding of coordinates divided by the lever, are about the same.
    let slack = S::slack(S::from_f64(extent)).to_f64();
    let passing = slack.sqrt().min(LEVER);
    let mut all: Vec<SegmentPhase> = Vec::new();
    let (mut levers, mut late) = (vec![0.0; agent.path.len()], 0.0);
    for ((segment, own), lever) in agent.path.iter().zip(&parts).zip(&mut levers) {
        let Some(sweep) = sweep(segment) else {
            speed = own.last().map_or(speed, |last| last.after);
            all.extend(own);
            continue;
        };
        let duration: f64 = own.iter().map(|phase| phase.duration).sum();
        let after = own.last().map_or(speed, |last| last.after);
        if sweep * agent.circumscribed_radius() <= 0.125 * slack {
            // It moves no point by more than rounding does.
            let standing = SegmentPhase { duration, before: 0.0, after: 0.0 };
            all.extend(if segment.takes_turning() { std::slice::from_ref(&standing) } else { own });
            speed = if segment.takes_turning() { speed } else { after };
        } else if segment.takes_turning() && own.iter().any(SegmentPhase::moves) {
            *lever = LEVER;
            all.extend(own.iter().map(|phase| SegmentPhase {
                before: phase.before * LEVER,
                after: phase.after * LEVER,
                ..*phase
            }));
            speed = after;
        } else if speed == 0.0 && after == 0.0 {
            *lever = LEVER;
            all.extend(own);
            let half = 0.5 * SHORTEST.max(64.0 * S::STEP);
            let peak = sweep * LEVER / half;
            all.push(SegmentPhase { duration: half, before: 0.0, after: peak });
            all.push(SegmentPhase { duration: half, before: peak, after: 0.0 });
            late += 2.0 * half;
        } else {
            // Some digits long, however little it turns.
            *lever = passing.max(16.0 * S::STEP / sweep);
            let (length, mean) = (sweep * *lever, 0.5 * (speed + after));
            all.push(SegmentPhase { duration: length / mean, before: speed, after });
            late += (length / mean - duration).abs();
            speed = after;
        }
    }
    Some(TurningMotion { levers, motion: joined::<S>(&all), off: late * top })
}

/// The motion of these phases. Times and speeds below the last digit of the format are dropped.
pub(super) fn joined<S: HostScalar>(phases: &[SegmentPhase]) -> MotionSpec {
    let v0 = phases.first().map_or(0.0, |phase| phase.before);
    // Duration, and speed after it.
    let mut reached: Vec<(f64, f64)> = Vec::new();
    for phase in phases {
        let lost = |value: f64| S::from_f64(value) == S::ZERO;
        let after = if lost(phase.after) { 0.0 } else { phase.after };
        match reached.last_mut() {
            Some(last) if lost(phase.duration) => last.1 = after,
            _ => reached.push((phase.duration, after)),
        }
    }
    let mut speed = v0;
    let pieces = reached.into_iter().map(|(duration, after)| {
        let gain = after - std::mem::replace(&mut speed, after);
        (duration, if duration > 0.0 { gain / duration } else { 0.0 })
    });
    MotionSpec::profile(v0, pieces)
}
