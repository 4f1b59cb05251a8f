//! Random missions: pairs of nodes with a way between them, which some order of starts allows.

use super::startable_agents::StartableAgents;
use pcr_core::{Path, Point, Pose, ProfileRef, Radians};
use pcr_formats::import::{ImportedLayout, VehicleTraits, mission};
use pcr_formats::plane_geometry::{distance, wrapped};
use pcr_formats::scenario::Agent;
use pcr_formats::scenario::PlacedSegment;
use pcr_formats::splitmix64::SplitMix64;
use pcr_planning::fleet::{ConvexBody, build_ecm};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::f64::consts::FRAC_1_SQRT_2;

/// How many times the sum of their radii and margins agents keep that wait at their starts or stand at their ends: more than
/// 1 by what plans and checks may take for a contact.
const CLEAR: f64 = 1.0 + 1e-6;

/// A way from node to node.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RandomMission {
    /// Indices of its nodes in the layout.
    pub(super) ends: [usize; 2],
    /// The agent that travels it, from time 0 on.
    pub(super) agent: Agent,
}

impl RandomMission {
    /// Poses of the agent before and after.
    fn stands(&self) -> [Pose<f64>; 2] {
        let Agent { start: [x, y, heading], ref path, .. } = self.agent;
        let end = path.iter().fold((([x, y]), heading), |(at, heading), &shape| {
            let placed = PlacedSegment { start: at, heading, shape };
            (placed.end(), placed.heading_at_end())
        });
        [([x, y], heading), end]
            .map(|([x, y], heading)| Pose { position: Point::new(x, y), heading: Radians(wrapped(heading)) })
    }

    /// Whether its agent and another one can stand at their starts at the same time, and at their ends.
    fn is_clear_of(&self, other: &Self) -> bool {
        let kept = |mission: &Self| mission.agent.circumscribed_radius() + mission.agent.margin;
        let reach = kept(self) + kept(other);
        let mut pairs = self.stands().into_iter().zip(other.stands());
        pairs.all(|(own, its)| {
            let apart = distance([own.position.x, own.position.y], [its.position.x, its.position.y]);
            apart > reach * CLEAR || self.has_outline_clear_of(own, other, its)
        })
    }

    /// Whether its outline in a pose is clear of that of another one, with their margins; discs are not that are too near one another.
    fn has_outline_clear_of(&self, own: Pose<f64>, other: &Self, its: Pose<f64>) -> bool {
        if self.agent.footprint.is_none() && other.agent.footprint.is_none() {
            return false;
        }
        let body = |mission: &Self| {
            let body = ConvexBody::of_agent(&mission.agent)?;
            body.inflated(mission.agent.margin + (CLEAR - 1.0) * body.reach())
        };
        let bodies = [body(self), body(other)];
        let paths = [own, its].map(Path::<f64, 1>::starting_at);
        let ([Ok(a), Ok(b)], [Ok(first), Ok(second)]) = (bodies, paths) else { return false };
        let stands = ProfileRef::new(&[]);
        let motions = stands
            .and_then(|stands| Ok([a.motion(first.as_path(), stands, 0.0)?, b.motion(second.as_path(), stands, 0.0)?]));
        motions.is_ok_and(|motions| build_ecm(&motions).is_ok_and(|ecm| ecm.is_empty()))
    }
}

/// Missions that were drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct MissionSample {
    pub(super) missions: Vec<RandomMission>,
    /// How many were passed over, by the reason.
    pub(super) passed_over: BTreeMap<String, usize>,
}

/// Radius of a disc that a vehicle covers whichever way it faces, with its margin \[m\].
fn core_radius(vehicle: &VehicleTraits) -> f64 {
    let inner = vehicle.footprint.as_ref().map_or(vehicle.radius, |footprint| footprint.inner_radius().max(0.0));
    inner + vehicle.margin
}

/// An upper bound for the number of agents that can stand at nodes of the level with the most nodes at one time: at most one in each
/// square whose diagonal is the distance that two of them keep.
pub(super) fn room(imported: &ImportedLayout) -> usize {
    /// Slightly smaller squares, so that rounding joins no two nodes that are far enough from one another.
    const SMALLER: f64 = 1.0 - 1e-6;
    /// Up to so many squares from the origin the rounding is smaller than that.
    const FAR: f64 = 1e9;
    let ImportedLayout { layout, vehicle } = imported;
    let level = layout.largest_level();
    let side = 2.0 * core_radius(vehicle) * FRAC_1_SQRT_2 * SMALLER;
    let there = || layout.nodes.iter().filter(|node| node.level == level);
    let square = |at: [f64; 2]| at.map(|coordinate| (coordinate / side).floor());
    if there().any(|node| square(node.point).iter().any(|number| !(0.0..FAR).contains(&number.abs()))) {
        return there().count();
    }
    there().map(|node| square(node.point).map(|number| number as i64)).collect::<HashSet<_>>().len()
}

/// Draws at most, where not all agents have a mission in the first one.
const DRAWS: usize = 4;

/// Missions for up to `count` agents on the level with the most nodes: each from a random node to another one, so that no two
/// agents overlap at their starts or at their ends, and there is an order in which all can start. The first of some draws with
/// a mission for every agent, or else the draw with the most missions.
pub(super) fn draw(imported: &ImportedLayout, count: usize, seed: u64) -> MissionSample {
    let mut seeds = SplitMix64(seed);
    let mut best = attempt(imported, count, SplitMix64(seed));
    for _ in 1..DRAWS {
        if best.missions.len() == count {
            break;
        }
        let next = attempt(imported, count, SplitMix64(seeds.bits()));
        let mut passed_over = std::mem::take(&mut best.passed_over);
        next.passed_over.iter().for_each(|(why, count)| *passed_over.entry(why.clone()).or_default() += count);
        let more = next.missions.len() > best.missions.len();
        best = MissionSample { passed_over, ..if more { next } else { best } };
    }
    best
}

/// One draw, an agent after the other: it ends where there is no pair of nodes with a way between them for the next one.
fn attempt(imported: &ImportedLayout, count: usize, mut random: SplitMix64) -> MissionSample {
    let ImportedLayout { layout, vehicle } = imported;
    let level = layout.largest_level();
    let there: Vec<usize> = (0..layout.nodes.len()).filter(|&node| layout.nodes[node].level == level).collect();
    let reach = 2.0 * core_radius(vehicle) * CLEAR;
    let mut drawn = MissionSample::default();
    let mut crowd = StartableAgents::default();
    // Pairs that were no mission, and why if that is told: with more agents they are none, either.
    let mut none: HashMap<[usize; 2], Option<String>> = HashMap::new();
    for id in (1..).take(count) {
        let missions = &drawn.missions;
        let free = &|end: usize, node: usize| {
            let apart = |mission: &RandomMission| {
                distance(layout.nodes[mission.ends[end]].point, layout.nodes[node].point) > reach
            };
            missions.iter().all(apart)
        };
        let (starts, ends) = (random.shuffled(&there), random.shuffled(&there));
        let pairs = starts.iter().filter(|&&from| free(0, from)).flat_map(|&from| {
            let ends = ends.iter().filter(move |&&to| to != from && free(1, to));
            ends.map(move |&to| [from, to])
        });
        let clear =
            |drawn: &RandomMission| drawn.agent.length() > 0.0 && missions.iter().all(|other| drawn.is_clear_of(other));
        // Nodes without a way between them, or too near others, are no mission that could be passed over: nothing is told.
        let mut take = |ends| match mission(imported, id, ends) {
            Ok(None) => Err(None),
            Ok(Some(agent)) => {
                let mission = RandomMission { ends, agent };
                let added = if clear(&mission) { crowd.add(&mission.agent) } else { return Err(None) };
                added.map(|()| mission).map_err(|problem| Some(problem.to_string()))
            }
            Err(error) => Err(Some(format!("the way is no path: {error}"))),
        };
        let found = pairs.into_iter().find_map(|ends| {
            let why = match none.get(&ends) {
                Some(why) => why.clone(),
                None => match take(ends) {
                    Ok(mission) => return Some(mission),
                    Err(why) => none.entry(ends).or_insert(why).clone(),
                },
            };
            why.into_iter().for_each(|why| *drawn.passed_over.entry(why).or_default() += 1);
            None
        });
        let Some(mission) = found else { break };
        drawn.missions.push(mission);
    }
    drawn
}
