//! Bodies and their tables as plain numbers for [`pcr_certify::outline`]: outlines, and the discs beside them as outlines of one corner.

use super::{RoundTripError, ends_of, same_disc, same_motion};
use crate::fleet::{Fleet, HostScalar, PathTurn, growth_of_turns};
use pcr_certify::outline::{
    RawBody, RawBodySegment, RawCourse, RawHeading, RawOutline, RawOutlinePair, RawOutlinePiece,
};
use pcr_certify::raw::{RawAgent, RawAngle, RawBranch, RawPair};
use pcr_core::{Curve, Motion, RegionRef, TurnSide, excess};
use pcr_formats::scenario::{Agent, Scenario};
use std::f64::consts::TAU;

/// What headings on both sides of a joint may differ by: they are one number, but for the rounding of the checker \[rad\].
const JUMP: f64 = 1e-12;

/// Whether a motion is that of an outline and not of a disc.
pub fn is_outline<S: HostScalar>(motion: &Motion<'_, S>) -> bool {
    !motion.outline().corners().is_empty()
}

/// Whether a motion is one for the checker of outlines: that of an outline, or of a disc whose turns in place have a length.
pub(crate) fn is_body<S: HostScalar>(motion: &Motion<'_, S>) -> bool {
    is_outline(motion) || motion.path().segments().iter().any(|segment| matches!(segment.curve(), Curve::Pivot { .. }))
}

/// The bodies of a fleet, whose paths and times are those of these agents.
pub fn bodies<S: HostScalar>(fleet: &Fleet<S>, agents: Vec<RawAgent>, motions: &[Motion<'_, S>]) -> Vec<RawBody> {
    let all = agents.into_iter().zip(motions).enumerate();
    all.map(|(place, (agent, motion))| body(agent, motion, fleet.headings(place))).collect()
}

fn body<S: HostScalar>(
    agent: RawAgent,
    motion: &Motion<'_, S>,
    (heading, turns): (S::Angle, &[PathTurn<S>]),
) -> RawBody {
    let outline = motion.outline();
    let corners = outline.corners().iter().map(|corner| [corner.at().x.to_f64(), corner.at().y.to_f64()]);
    let corners: Vec<[f64; 2]> = if is_outline(motion) { corners.collect() } else { vec![[0.0; 2]] };
    // Turns without a length are those that move no point by more than rounding does, and turns of the path where the body keeps its
    // heading, but for what the rounding of three angles of the format leaves.
    let (mut was, mut jump, mut ahead) = (0.0, 0.0_f64, S::radians(heading));
    let mut facing = RawAngle::Turns(0.0);
    let mut left = turns.iter().peekable();
    let mut turn_before = |place: usize, was: &mut f64, ahead: &mut f64| {
        let mut facing = None;
        while let Some(turn) = left.next_if(|turn| turn.before <= place) {
            let by = S::radians(turn.by);
            let off = turn.facing.map_or(by, |facing| by - (*was - S::radians(facing)));
            *was = turn.facing.map_or(*was, S::radians);
            *ahead += by;
            jump = jump.max((off - TAU * (off / TAU).round()).abs());
            facing = turn.facing.or(facing);
        }
        facing
    };
    let mut segments = Vec::with_capacity(agent.path.segments.len());
    for (place, (segment, part)) in agent.path.segments.into_iter().zip(motion.path().segments()).enumerate() {
        facing = turn_before(place, &mut was, &mut ahead).map_or(facing, S::held_angle);
        // In the numbers of the checker, which are those of the format, a heading on the map is a sum of angles; it is known within the jump.
        let turned = match part.curve() {
            Curve::Line => 0.0,
            Curve::Arc { radius: lever, turn } | Curve::Pivot { lever, turn } => {
                let turned = segment.length / lever.to_f64();
                if turn == TurnSide::Left { turned } else { -turned }
            }
        };
        let heading = match part.is_steady() {
            false => RawHeading::Along(facing),
            true => {
                let heading = RawHeading::Steady(RawAngle::Radians(ahead + was));
                was -= turned;
                facing = RawAngle::Radians(was);
                heading
            }
        };
        ahead += turned;
        segments.push(RawBodySegment {
            course: match part.curve() {
                Curve::Pivot { lever, turn: TurnSide::Left } => RawCourse::Pivot { lever: lever.to_f64() },
                Curve::Pivot { lever, turn: TurnSide::Right } => RawCourse::Pivot { lever: -lever.to_f64() },
                _ => segment.radius.map_or(RawCourse::Line, |radius| RawCourse::Arc { radius }),
            },
            length: segment.length,
            turns: segment.turns,
            heading,
            from: segment.from,
            to: segment.to,
        });
    }
    turn_before(usize::MAX, &mut was, &mut ahead);
    let jump = jump * (1.0 + 1e-9) + JUMP;
    RawBody {
        id: agent.id,
        outline: RawOutline { corners, radius: outline.radius().to_f64() },
        start: agent.path.start,
        direction: agent.path.heading,
        segments,
        rounding: agent.path.rounding,
        jump,
        step: agent.path.step,
        travel: agent.travel,
    }
}

/// Compares what the checker is given, before margins, with the agents of a scenario, as [`super::as_given`] does for discs. Outlines have to
/// hold those of the file, and be larger by no more than the last digits of the format.
///
/// # Errors
/// [`RoundTripError`], with the first difference.
///
/// # Panics
/// If `agents` or `bodies` are not as many as the agents of the scenario.
pub(crate) fn as_given<S: HostScalar>(
    given: &Scenario,
    agents: &[RawAgent],
    bodies: &[RawBody],
) -> Result<(), RoundTripError> {
    assert_eq!([given.agents.len(); 2], [agents.len(), bodies.len()], "the bodies of the scenario");
    for ((given, agent), body) in given.agents.iter().zip(agents).zip(bodies) {
        let turned = body.segments.iter().filter(|segment| matches!(segment.course, RawCourse::Pivot { .. }));
        same_motion::<S>(given, agent, turned.map(|segment| segment.length).collect())?;
        if body.outline.corners == [[0.0; 2]] {
            same_disc::<S>(given, agent, true)
        } else {
            same_outline::<S>(given, body)
        }?;
    }
    Ok(())
}

/// Digits of a coordinate by which an outline may be larger than that of the file: needless corners, rounding of corners and radius.
const DIGITS: f64 = 16.0;

fn same_outline<S: HostScalar>(given: &Agent, body: &RawBody) -> Result<(), RoundTripError> {
    let RawOutline { corners, radius } = &body.outline;
    let misread =
        |needed| RoundTripError { agent: given.display_name(), field: "footprint", stored: *radius, given: needed };
    let Some(footprint) = &given.footprint else { return Err(misread(given.circumscribed_radius())) };
    let size = footprint.polygon().iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    // The radius makes up for what the polygon has lost.
    let needed = footprint.growth() + footprint.beyond(corners);
    let most = footprint.growth() + growth_of_turns::<S>(given) + DIGITS * (S::STEP + S::EPSILON * size);
    // No corner is one that the file does not have.
    let nearest = |corner: &[f64; 2]| {
        let away = footprint.polygon().iter().map(|own| (own[0] - corner[0]).hypot(own[1] - corner[1]));
        away.fold(f64::INFINITY, f64::min)
    };
    let off = corners.iter().map(nearest).fold(0.0, f64::max);
    let holds = needed <= *radius && *radius <= most && off <= S::STEP + S::EPSILON * size;
    if holds { Ok(()) } else { Err(misread(needed)) }
}

/// Two bodies with their regions, in the order of the table.
pub fn pair<'a, S: HostScalar + 'a>(
    bodies: [usize; 2],
    [first, second]: [&Motion<'_, S>; 2],
    all: impl Iterator<Item = RegionRef<'a, S>>,
) -> RawOutlinePair {
    let regions: Vec<RegionRef<'a, S>> = all.collect();
    let pieces = regions.iter().enumerate().flat_map(|(number, region)| {
        region.pieces().map(move |piece| RawOutlinePiece {
            segments: piece.segments,
            lengths: [ends_of(piece.length), ends_of(piece.other_length)],
            // Of discs there are one or two intervals.
            rank: piece.rank.unwrap_or(match piece.share {
                pcr_core::Branch::Only => [0, 1],
                pcr_core::Branch::Start => [0, 2],
                pcr_core::Branch::End => [1, 2],
            }),
            region: number,
        })
    });
    let pieces = pieces.collect();
    let regions = regions.into_iter().map(|region| super::region(&region)).collect();
    RawOutlinePair { bodies, excess: excess(first, second).to_f64(), regions, pieces }
}

/// A body as an agent on the same path, of which its outline is forgotten: what of a table does not depend on the outlines.
pub fn agent(body: &RawBody) -> RawAgent {
    let segments = body.segments.iter().map(|segment| pcr_certify::raw::RawSegment {
        length: segment.length,
        radius: match segment.course {
            RawCourse::Line => None,
            RawCourse::Arc { radius } => Some(radius),
            RawCourse::Pivot { lever } => Some(lever),
        },
        turns: segment.turns.clone(),
        from: segment.from,
        to: segment.to,
    });
    RawAgent {
        id: body.id,
        radius: body.outline.radius,
        path: pcr_certify::raw::RawPath {
            start: body.start,
            heading: body.direction,
            segments: segments.collect(),
            rounding: body.rounding,
            step: body.step,
        },
        travel: body.travel.clone(),
    }
}

/// A pair of bodies as one of agents, without the ranks of its pieces.
pub(crate) fn pair_of_agents(pair: &RawOutlinePair) -> RawPair {
    let pieces = pair.pieces.iter().map(|piece| pcr_certify::raw::RawPiece {
        segments: piece.segments,
        lengths: piece.lengths,
        share: RawBranch::Only,
        region: piece.region,
    });
    RawPair { agents: pair.bodies, excess: pair.excess, regions: pair.regions.clone(), pieces: pieces.collect() }
}
