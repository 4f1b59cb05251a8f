//! Tables as plain numbers for [`pcr_certify`], which shares no code with the library that computed them.
//!
//! All numbers are those that the library holds; this module neither rounds nor computes.

pub mod outlines;

use crate::fleet::{Fleet, HostEcm, HostScalar, PathTurn, growth_of_turns};
use pcr_certify::raw::{
    RawAgent, RawAngle, RawBranch, RawMotion, RawPair, RawPath, RawPhase, RawPiece, RawRegion, RawSegment, RawTable,
};
use pcr_core::{Curve, Interval, Motion, RegionRef, TurnSide, excess};
use pcr_formats::scenario::{Agent, PathSegment, Scenario, figure};
use std::f64::consts::{PI, TAU};
use std::fmt;

/// A bound on the last digit of an angle in fixed point, as a part of half a turn: 2⁻³¹.
const FINEST: f64 = 1.0 / (1_u64 << 31) as f64;

/// A motion: `heading` is the heading at the start of its path, `turns` are those of its direction of travel.
pub fn agent<S: HostScalar>(id: u64, motion: &Motion<'_, S>, heading: S::Angle, turns: &[PathTurn<S>]) -> RawAgent {
    let path = motion.path();
    let parts = path.segments();
    let ends = parts.iter().skip(1).map(|next| next.from()).chain([path.length()]);
    let segments = parts.iter().zip(ends).enumerate().map(|(place, (segment, to))| RawSegment {
        length: segment.length().to_f64(),
        radius: match segment.curve() {
            Curve::Line => None,
            Curve::Arc { radius, turn: TurnSide::Left } => Some(radius.to_f64()),
            Curve::Arc { radius, turn: TurnSide::Right } => Some(-radius.to_f64()),
            // The checker of discs has no turns in place with a length: it refuses this radius.
            Curve::Pivot { .. } => Some(0.0),
        },
        turns: turns.iter().filter(|turn| turn.before == place).map(|turn| S::held_angle(turn.by)).collect(),
        from: segment.from().to_f64(),
        to: to.to_f64(),
    });
    let start = path.point_at(S::ZERO);
    let phases = motion.profile().phases().iter().map(|phase| RawPhase {
        time: ends_of(phase.time()),
        length: ends_of(phase.length()),
        speed: phase.speed().map(S::to_f64),
    });
    RawAgent {
        id,
        radius: motion.radius().to_f64(),
        path: RawPath {
            start: [start.x.to_f64(), start.y.to_f64()],
            heading: S::held_angle(heading),
            segments: segments.collect(),
            rounding: S::EPSILON * path.length().to_f64(),
            step: S::STEP,
        },
        travel: Some(RawMotion {
            start: motion.time().lo.to_f64(),
            phases: phases.collect(),
            lag: motion.lag().to_f64(),
            time_excess: motion.time_excess().to_f64(),
        }),
    }
}

fn ends_of<S: HostScalar>(interval: Interval<S>) -> [f64; 2] {
    [interval.lo.to_f64(), interval.hi.to_f64()]
}

/// The discs of a fleet; the numbers tell which ones are of one body.
pub fn agents<S: HostScalar>(fleet: &Fleet<S>, motions: &[Motion<'_, S>], ids: &[u64]) -> Vec<RawAgent> {
    let all = motions.iter().zip(ids).enumerate();
    all.map(|(place, (motion, &id))| {
        let (heading, turns) = fleet.headings(place);
        agent(id, motion, heading, turns)
    })
    .collect()
}

/// What is no number is not within anything.
fn is_within(off: f64, most: f64) -> bool {
    off <= most
}

/// What is to be proved is not what the scenario says: a number was read as another one.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundTripError {
    agent: String,
    field: &'static str,
    stored: f64,
    given: f64,
}

impl fmt::Display for RoundTripError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { agent, field, stored: held, given } = self;
        write!(f, "agent {agent}, {field}: {} was read as {}; please report this", figure(*given), figure(*held))
    }
}

impl std::error::Error for RoundTripError {}

/// Compares what the checker is given, before margins, with the discs of a scenario: a proof about other numbers is none about
/// the scenario. Radius, start and length of the path have to be those of the file but for the last digits of the format.
///
/// # Errors
/// [`RoundTripError`], with the first difference.
///
/// # Panics
/// If `agents` are not as many as the agents of the scenario.
pub(crate) fn as_given<S: HostScalar>(discs: &Scenario, agents: &[RawAgent]) -> Result<(), RoundTripError> {
    assert_eq!(discs.agents.len(), agents.len(), "the discs of the scenario");
    discs.agents.iter().zip(agents).try_for_each(|(given, held)| {
        same_disc::<S>(given, held, false)?;
        same_motion::<S>(given, held, Vec::new())
    })
}

/// Numbers of a field, as they are held and given, and how many roundings there are between them.
fn same_numbers<S: HostScalar>(given: &Agent, numbers: &[(&'static str, f64, f64, f64)]) -> Result<(), RoundTripError> {
    // Lengths below the square of the least radius are taken as 0.
    let least = S::LEAST.to_f64() * S::LEAST.to_f64();
    for &(field, stored, number, parts) in numbers {
        let digit = S::STEP.max(S::EPSILON * number.abs()).max(least);
        if !is_within((stored - number).abs(), parts * digit) {
            return Err(RoundTripError { agent: given.display_name(), field, stored, given: number });
        }
    }
    Ok(())
}

fn same_disc<S: HostScalar>(given: &Agent, held: &RawAgent, pivots: bool) -> Result<(), RoundTripError> {
    let radius = given.circumscribed_radius() + if pivots { growth_of_turns::<S>(given) } else { 0.0 };
    same_numbers::<S>(given, &[("radius", held.radius, radius, 1.0)])
}

/// Compares path and times of an agent with those of a scenario. `turned` are the lengths of its turns in place, where they have one \[m\].
fn same_motion<S: HostScalar>(given: &Agent, held: &RawAgent, turned: Vec<f64>) -> Result<(), RoundTripError> {
    let start = held.travel.as_ref().map_or(given.t_start, |travel| travel.start);
    let travelled = given.path.iter().map(PathSegment::length).chain(turned.iter().copied()).sum();
    let length = held.path.segments.last().map_or(0.0, |last| last.to);
    // A length is rounded for each segment, and for each turn of an arc; the rounding of a radius is in it once for each radian.
    let bends = given.path.iter().map(|segment| segment.sweep().abs());
    let parts = (held.path.segments.len() + given.path.len() + 1) as f64 + bends.sum::<f64>();
    let numbers = [
        ("start.x", held.path.start[0], given.start[0], 1.0),
        ("start.y", held.path.start[1], given.start[1], 1.0),
        ("t_start", start, given.t_start, 1.0),
        ("length of the path", length, travelled, parts),
    ];
    same_numbers::<S>(given, &numbers)?;
    let heading = match held.path.heading {
        RawAngle::Radians(radians) => radians,
        RawAngle::Turns(turns) => turns * TAU,
    };
    // Whole turns are subtracted in `f64`, here and when it was read.
    let digit = PI * S::EPSILON.max(FINEST) + 4.0 * f64::EPSILON * given.start[2].abs();
    let turned = (heading - given.start[2]).rem_euclid(TAU);
    if is_within(turned.min(TAU - turned), digit) {
        return Ok(());
    }
    let agent = given.display_name();
    Err(RoundTripError { agent, field: "start.heading", stored: heading, given: given.start[2] })
}

/// A whole table of these discs, pair by pair.
pub fn table<S: HostScalar>(agents: Vec<RawAgent>, motions: &[Motion<'_, S>], ecm: &HostEcm<S>) -> RawTable {
    let mut pairs = Vec::new();
    for (i, own) in agents.iter().enumerate() {
        for (j, other) in agents.iter().enumerate().skip(i + 1) {
            if own.id != other.id {
                let regions = ecm.pair(motions, i, j).expect("the table of the fleet");
                pairs.push(pair([i, j], [&motions[i], &motions[j]], regions));
            }
        }
    }
    RawTable { agents, pairs, apart: None }
}

/// Two discs with their regions, in the order of the table.
pub fn pair<'a, S: HostScalar + 'a>(
    agents: [usize; 2],
    [first, second]: [&Motion<'_, S>; 2],
    all: impl Iterator<Item = RegionRef<'a, S>>,
) -> RawPair {
    let (mut regions, mut pieces) = (Vec::new(), Vec::new());
    for (number, region) in all.enumerate() {
        regions.push(self::region(&region));
        pieces.extend(region.pieces().map(|piece| RawPiece {
            segments: piece.segments,
            lengths: [ends_of(piece.length), ends_of(piece.other_length)],
            share: match piece.share {
                pcr_core::Branch::Only => RawBranch::Only,
                pcr_core::Branch::Start => RawBranch::Start,
                pcr_core::Branch::End => RawBranch::End,
            },
            region: number,
        }));
    }
    RawPair { agents, excess: excess(first, second).to_f64(), regions, pieces }
}

/// What is told of a region.
fn region<S: HostScalar>(region: &RegionRef<'_, S>) -> RawRegion {
    RawRegion {
        lengths: [ends_of(region.length()), ends_of(region.other_length())],
        times: Some([ends_of(region.clone().swapped().time()), ends_of(region.time())]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_fixed::{Q12, Q16, Q20};
    use serde_json::json;

    /// Whatever else is read from the file.
    fn compared<S: HostScalar>() {
        let path = json!([
            { "kind": "line", "length": 2.3 },
            { "kind": "turn", "sweep": 41.7 },
            { "kind": "arc", "radius": 0.7, "sweep": -13.1 },
        ]);
        let start = json!({ "x": 1.3, "y": -2.1, "heading": 1e5 });
        let agent = json!({
            "id": 7, "radius": 0.31, "v_max": 1.0, "a_max": 0.5, "turn_v_max": 1.0, "turn_a_max": 1.0, "t_start": 3.3,
            "start": start, "path": path,
        });
        let scenario = Scenario::from_value(&json!({ "agents": [agent] })).expect("a scenario");
        let fleet = Fleet::<S>::new(&scenario).expect("it fits");
        let told = |scenario: &Scenario| {
            as_given::<S>(scenario, &agents(&fleet, &fleet.motions(), &[7])).map_err(|misread| misread.to_string())
        };
        assert_eq!(told(&scenario), Ok(()), "{}", S::NAME);
        type Change = fn(&mut pcr_formats::scenario::Agent);
        let changes: [(&str, Change); 6] = [
            ("start.heading", |agent| agent.start[2] = 0.0),
            ("start.heading", |agent| agent.start[2] = f64::NAN),
            ("start.x", |agent| agent.start[0] += 0.01),
            ("radius", |agent| agent.radius += 0.01),
            ("t_start", |agent| agent.t_start = 0.0),
            ("length of the path", |agent| agent.path.truncate(2)),
        ];
        for (field, change) in changes {
            let mut other = scenario.clone();
            change(&mut other.agents[0]);
            let refused = told(&other).expect_err(field);
            assert!(refused.starts_with(&format!("agent 7, {field}: ")), "{}: {refused}", S::NAME);
        }
    }

    #[test]
    fn nothing_is_proved_of_other_numbers_than_those_of_the_scenario() {
        compared::<f64>();
        compared::<f32>();
        compared::<Q12>();
        compared::<Q16>();
        compared::<Q20>();
    }

    /// The radius of a full circle is rounded once, and its length is off by that 2 π times.
    #[test]
    fn circles_whose_radius_is_rounded_are_as_given() {
        let circle = |radius: f64, sweep: f64| json!({ "kind": "arc", "radius": radius, "sweep": sweep });
        for k in 0..200 {
            let off = f64::from(k) * 1.7e-7;
            let path = json!([circle(0.118_018_95 + off, TAU), circle(1.813_987_58 + off, -3.0 * TAU)]);
            let start = json!({ "x": 0.0, "y": 0.0, "heading": 0.0 });
            let agent = json!({ "id": 1, "radius": 0.3, "v_max": 1.0, "a_max": 1.0, "start": start, "path": path });
            let scenario = Scenario::from_value(&json!({ "agents": [agent] })).expect("a scenario");
            let fleet = Fleet::<Q16>::new(&scenario).expect("it fits");
            let agents = agents(&fleet, &fleet.motions(), &[1]);
            assert_eq!(as_given::<Q16>(&scenario, &agents).map_err(|misread| misread.to_string()), Ok(()), "{k}");
        }
    }
}
