//! Random traffic on a layout: the answer and the pictures of `pcr traffic`.
//!
//! Every agent has one mission, the shortest way between two random nodes. Without a plan all would set off at once;
//! the plan delays them. Agents for which there is no delay, because they meet others whenever they start, are left out
//! and counted.

mod missions;
mod schedule;
mod startable_agents;

use missions::{MissionSample, RandomMission};
use pcr_formats::import::{ElementId, ImportedLayout};
use pcr_formats::scenario::{Agent, Scenario};
use pcr_formats::warning::WarningCode;
use pcr_planning::certify::MotionCertificate;
use pcr_planning::check::CheckReport;
use pcr_planning::failure::ComputationError;
use pcr_planning::plan::{DelaySchedule, ForbiddenDelays, UnplannedAgents};
use pcr_planning::regions::{self, RegionsReport};
use serde::Serialize;

/// The options of a request for missions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrafficOptions {
    /// Number of agents that are to have missions.
    pub agents: usize,
    /// Seed of the missions.
    pub seed: u64,
}

/// Missions, and how well they can be carried out. The JSON output, field for field in this order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrafficReport {
    /// Name of the layout.
    pub layout: String,
    /// Seed of the missions.
    pub seed: u64,
    /// Radius of the discs, without their margin and the deviation of their paths \[m\].
    pub radius: f64,
    /// Number of agents requested.
    pub asked: usize,
    /// Number of agents with a mission; for the others there is no room to start or to end.
    pub placed: usize,
    /// Number of missions that were drawn and rejected, in all draws.
    pub passed_over: usize,
    /// Reasons for the rejections, with their numbers.
    pub passed_over_because: Vec<SkippedMissions>,
    /// Number of agents with a mission and a plan.
    pub planned: usize,
    /// Number of collision regions of the agents with a mission, both directions of every pair.
    pub regions: usize,
    /// Number of conflicts of the agents with a plan if all set off at once.
    pub conflicts_before: usize,
    /// Number of conflicts with the plan.
    pub conflicts_after: usize,
    /// Result of the independent checker for the plan.
    pub certificate: MotionCertificate,
    /// Time from the start of all to the last arrival \[s\].
    pub makespan: f64,
    /// Sum of the times of arrival of all agents \[s\].
    pub sum_of_costs: f64,
    /// The sum of costs if no agent had to wait \[s\].
    pub lower_bound: f64,
    /// Missions carried out in the makespan, per hour.
    pub missions_per_hour: f64,
    /// The missions, by the number of their agent.
    pub missions: Vec<TrafficEntry>,
    /// Reasons why agents have no plan; the first of each `ids` has none.
    pub unsolved: Vec<UnplannedAgents>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
}

/// Why missions were passed over.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SkippedMissions {
    /// In words.
    pub why: String,
    /// How many.
    pub missions: usize,
}

/// A mission and what became of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrafficEntry {
    /// Number of the agent.
    pub id: u64,
    /// Node where it begins, as in the layout.
    pub from: ElementId,
    /// Node where it ends.
    pub to: ElementId,
    /// Length of the way \[m\].
    pub length: f64,
    /// How long it waits before it starts \[s\]; none without a plan.
    pub delay: Option<f64>,
    /// When it arrives \[s\]; none without a plan.
    pub t_end: Option<f64>,
}

/// Returns an upper bound for the number of agents that a layout has room for at one time, on the level with the most nodes.
pub fn room(imported: &ImportedLayout) -> usize {
    missions::room(imported)
}

impl TrafficReport {
    /// The traffic on a layout, the scenario of all missions with all agents setting off at once, and that of the plan.
    ///
    /// # Errors
    /// [`ComputationError`] where the missions cannot be computed with.
    pub fn plan(imported: &ImportedLayout, request: TrafficOptions) -> Result<(Self, [Scenario; 2]), ComputationError> {
        let MissionSample { missions: drawn, passed_over } = missions::draw(imported, request.agents, request.seed);
        let layout = &imported.layout;
        let agents = drawn.iter().map(|mission| mission.agent.clone()).collect();
        let mut missions = Scenario { warnings: layout.warnings.clone(), ..Scenario::new(layout.name.clone(), agents) };
        if layout.levels.len() > 1 {
            let level = &layout.levels[layout.largest_level()];
            let problem = format_args!("levels: missions are drawn on {level} only, of {}", layout.levels.len());
            missions.warnings.push(WarningCode::OneLevel.text(problem));
        }
        let regions = RegionsReport::compute::<f64>(&missions, regions::RegionOptions::default())?.regions.len();
        let DelaySchedule { delays, out, .. } = schedule(&missions, request.seed)?;
        let id = |agent: usize| missions.agents[agent].id;
        let kept = missions.agents.iter().zip(&delays).filter_map(|(agent, delay)| Some((agent, (*delay)?)));
        let at_once = Scenario { agents: kept.clone().map(|(agent, _)| agent.clone()).collect(), ..missions.clone() };
        let later = kept.map(|(agent, delay)| Agent { t_start: delay, ..agent.clone() });
        let plan = Scenario { agents: later.collect(), ..missions.clone() };
        let conflicts =
            |scenario: &Scenario| CheckReport::compute::<f64>(scenario, false).map(|found| found.conflicts.len());
        let travels: Vec<TrafficEntry> =
            drawn.iter().zip(&delays).map(|(mission, delay)| TrafficEntry::of(mission, imported, *delay)).collect();
        let ends = || travels.iter().filter_map(|travel| travel.t_end);
        let makespan = ends().fold(0.0, f64::max);
        let traffic = Self {
            layout: layout.name.clone(),
            seed: request.seed,
            radius: imported.vehicle.radius,
            asked: request.agents,
            placed: drawn.len(),
            passed_over: passed_over.values().sum(),
            passed_over_because: passed_over
                .into_iter()
                .map(|(why, missions)| SkippedMissions { why, missions })
                .collect(),
            planned: plan.agents.len(),
            regions,
            conflicts_before: conflicts(&at_once)?,
            conflicts_after: conflicts(&plan)?,
            certificate: MotionCertificate::prove::<f64>(&plan)?,
            makespan,
            // A sum of nothing is -0.
            sum_of_costs: ends().sum::<f64>() + 0.0,
            lower_bound: at_once.agents.iter().map(Agent::duration).sum::<f64>() + 0.0,
            missions_per_hour: if makespan > 0.0 { plan.agents.len() as f64 / makespan * 3600.0 } else { 0.0 },
            missions: travels,
            unsolved: out
                .iter()
                .map(|out| UnplannedAgents::of(&missions, [id(out.agent), id(out.blocked_by)], out.always))
                .collect(),
            warnings: missions.warnings.clone(),
        };
        Ok((traffic, [missions, plan]))
    }

    /// Whether every agent that was asked for has a mission and a plan.
    pub fn is_complete(&self) -> bool {
        self.planned == self.asked
    }

    /// Whether at least one agent has a plan, and the plan is proved to be free of contact.
    pub fn is_sound(&self) -> bool {
        self.planned > 0 && self.conflicts_after == 0 && self.certificate.verdict == "proved"
    }
}

/// Start delays for as many agents of a scenario as can have one, of 2000 orders that are tried.
pub fn schedule(scenario: &Scenario, seed: u64) -> Result<DelaySchedule, ComputationError> {
    let mut longest_first: Vec<usize> = (0..scenario.agents.len()).collect();
    let duration = |agent: usize| scenario.agents[agent].duration();
    longest_first.sort_by(|&a, &b| duration(b).total_cmp(&duration(a)));
    Ok(schedule::best(&ForbiddenDelays::compute(scenario)?, longest_first, seed))
}

impl TrafficEntry {
    fn of(mission: &RandomMission, imported: &ImportedLayout, delay: Option<f64>) -> Self {
        let node = |place: usize| {
            let node = imported.layout.nodes.get(place);
            node.map_or_else(|| ElementId::Text(String::new()), |node| node.id.clone())
        };
        Self {
            id: mission.agent.id,
            from: node(mission.ends[0]),
            to: node(mission.ends[1]),
            length: mission.agent.length(),
            delay,
            t_end: delay.map(|delay| delay + mission.agent.duration()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lifelong::aisles;
    use pcr_formats::footprint::Footprint;
    use pcr_formats::scenario::{PathSegment, PlacedSegment};

    /// Where an agent is at a time, and how it heads.
    fn pose(agent: &Agent, time: f64) -> ([f64; 2], f64) {
        let mut left = time - agent.t_start;
        let [x, y, heading] = agent.start;
        let (mut at, mut heading) = ([x, y], heading);
        for (&shape, parts) in agent.path.iter().zip(agent.parts()) {
            let placed = PlacedSegment { start: at, heading, shape };
            let mut length = 0.0;
            for part in parts {
                let taken = left.clamp(0.0, part.duration);
                let gain = (part.after - part.before) / part.duration.max(1e-300);
                length += part.before * taken + 0.5 * gain * taken * taken;
                left -= taken;
            }
            let here = match shape {
                PathSegment::Turn { sweep } => {
                    let shape = PathSegment::Turn { sweep: length.min(sweep.abs()).copysign(sweep) };
                    PlacedSegment { shape, ..placed }
                }
                _ => placed.part(0.0, length.min(shape.length())),
            };
            (at, heading) = (here.end(), here.heading_at_end());
            if left <= 0.0 {
                break;
            }
        }
        (at, heading)
    }

    /// Distance of two rectangles that are this long and wide \[m\], below 0 if they overlap: the largest gap along the normals of their sides.
    fn apart(poses: [([f64; 2], f64); 2], [long, wide]: [f64; 2]) -> f64 {
        let corners = poses.map(|([x, y], heading)| {
            let (sin, cos) = heading.sin_cos();
            [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|[a, b]| {
                let (ahead, left) = (0.5 * long * a, 0.5 * wide * b);
                [x + ahead * cos - left * sin, y + ahead * sin + left * cos]
            })
        });
        let normals = poses.iter().flat_map(|(_, heading)| {
            let (sin, cos) = heading.sin_cos();
            [[cos, sin], [-sin, cos]]
        });
        let gap = |[u, v]: [f64; 2]| {
            let spans = corners.map(|corners| {
                let along = corners.map(|[x, y]| x * u + y * v);
                [along.iter().copied().fold(f64::INFINITY, f64::min), along.iter().copied().fold(f64::MIN, f64::max)]
            });
            f64::max(spans[0][0] - spans[1][1], spans[1][0] - spans[0][1])
        };
        normals.map(gap).fold(f64::MIN, f64::max)
    }

    #[test]
    fn missions_of_outlines_are_planned_as_they_are() {
        let mut imported = aisles(2);
        imported.vehicle.radius = 0.52_f64.sqrt();
        let request = TrafficOptions { agents: 12, seed: 1 };
        let (discs, _) = TrafficReport::plan(&imported, request).expect("a plan of discs");
        let corners = vec![[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]];
        imported.vehicle.footprint = Some(Footprint::new(corners).expect("a footprint"));
        let (exact, [_, plan]) = TrafficReport::plan(&imported, request).expect("a plan");
        assert!(exact.is_sound() && exact.planned >= discs.planned && exact.planned > 4, "{exact:?}");
        let ends = exact.missions.iter().filter_map(|mission| mission.t_end).fold(0.0, f64::max);
        let mut nearest = f64::INFINITY;
        for k in 0..=4_000 {
            let poses: Vec<_> = plan.agents.iter().map(|agent| pose(agent, ends * f64::from(k) / 4_000.0)).collect();
            for (place, own) in poses.iter().enumerate() {
                for other in &poses[place + 1..] {
                    nearest = nearest.min(apart([*own, *other], [1.2, 0.8]));
                }
            }
        }
        // Two discs whose outlines pass each other in an aisle are 0.1 m from one another.
        assert!((0.0..0.3).contains(&nearest), "{nearest}");
    }
}
