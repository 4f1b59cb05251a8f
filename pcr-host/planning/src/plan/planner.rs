//! One plan of a fleet, from delays or speeds to the printed answer; it is checked and proved.

use super::circular_wait::CIRCULAR_WAIT;
use super::delays::Objective;
use super::plan_context::Planner;
use super::starts::PartialDelayPlan;
use super::{
    PlanAnswer, PlanCosts, PlanEntry, PlanMethod, PlanReport, PriorityRule, UnplannedAgents, lower_bound, sides, speeds,
};
use crate::certify::MotionCertificate;
use crate::check::CheckReport;
use crate::failure::ComputationError;
use crate::fleet::stops_of_pivots;
use crate::parallel;
use pcr_core::{Curve, Motion, PlanError as Never, SpeedPlanLimits};
use pcr_formats::scenario::{Agent, Labels, MotionPiece, MotionSpec, Scenario};
use pcr_formats::warning::WarningCode;

/// Costs that differ by less are printed alike \[s\].
const NEAR: f64 = 1e-4;

/// Differences of starts, and durations of pieces, up to this come from rounding \[s\]. They are not written: smaller number formats
/// could not hold them.
const ROUNDED: f64 = 1e-12;

impl<'m> Planner<'_, 'm> {
    /// A plan without agents.
    pub(super) fn none(&self) -> PlanReport {
        PlanReport {
            labels: Labels::from_scenario(self.scenario),
            warnings: self.warnings(),
            ..PlanReport::none(&self.scenario.name, self.request.method, self.request.objective)
        }
    }

    /// Warnings about input that was changed or left out, and about requests that were planned differently.
    fn warnings(&self) -> Vec<String> {
        let mut warnings = self.scenario.warnings.clone();
        if self.request.method == PlanMethod::Speed {
            let keeps = self
                .motions
                .iter()
                .zip(&self.scenario.agents)
                .filter(|(motion, _)| SpeedPlanLimits::of(motion).is_none());
            warnings.extend(keeps.map(|(_, agent)| {
                let why = if agent.turns_in_place() {
                    "it turns in place"
                } else {
                    "its own profile is slower on the way than its largest speed and acceleration"
                };
                WarningCode::OwnMotion
                    .text(format_args!("agent {}: {why}; it is nowhere faster than its own motion", agent.id))
            }));
        }
        warnings
    }

    /// A plan by the method; `known` delays, if any, are for all agents.
    pub(super) fn plan(&self, known: Option<PartialDelayPlan>) -> Result<PlanAnswer, ComputationError> {
        let later = known.as_ref().and_then(|known| {
            let delayed = self.motions.iter().zip(&known.delays).map(|(motion, &delay)| motion.delayed(delay).ok());
            delayed.collect::<Option<Vec<_>>>()
        });
        match self.request.method {
            PlanMethod::Delay => {
                let Some(planned) = later else {
                    let why = "a start is out of range";
                    return Ok((
                        PlanReport { unsolved: vec![UnplannedAgents::nowhere(Vec::new(), why)], ..self.none() },
                        None,
                    ));
                };
                self.answer(&planned, known)
            }
            PlanMethod::Speed => {
                let mut pool = speeds::pool(self.motions.len());
                let known = later.zip(known.map(|known| known.order));
                let told = |(planned, order): speeds::PlanWithOrder<'_>| {
                    let (mut plan, solved) = self.answer(&planned, None)?;
                    if self.request.priority != PriorityRule::Best && solved.is_some() {
                        plan.order = order.into_iter().map(|agent| self.id(agent)).collect();
                    }
                    Ok((plan, solved))
                };
                match speeds::plan(self, &self.ecm()?, self.orders()?, known.clone(), &mut pool) {
                    Ok(found) => {
                        let answer = told(found)?;
                        // If no other speeds are found, the delays are the plan.
                        match known.filter(|_| answer.1.is_none()) {
                            Some(known) => told(known),
                            None => Ok(answer),
                        }
                    }
                    Err(never) => Ok((PlanReport { unsolved: self.unsolved(never), ..self.none() }, None)),
                }
            }
        }
    }

    /// Lower bound of all plans by the method \[s\].
    fn bound(&self, known: Option<&PartialDelayPlan>) -> f64 {
        let least = |motion: &Motion<'_, f64>| match self.request.method {
            PlanMethod::Delay => motion.time().length(),
            // An agent that may not be faster than its own motion takes at least as long.
            PlanMethod::Speed => SpeedPlanLimits::of(motion)
                .map_or(motion.time().length(), |drive| lower_bound::fastest(drive, motion.path().length())),
        };
        let alone = match self.request.objective {
            // An empty sum is -0.
            Objective::Sum => self.motions.iter().map(least).sum::<f64>() + 0.0,
            Objective::Makespan => {
                let begin = self.begin();
                let ends = self.motions.iter().map(|motion| motion.time().lo + least(motion) - begin);
                ends.fold(0.0, f64::max)
            }
        };
        let together = known.map_or(0.0, |known| match self.request.objective {
            Objective::Sum => alone + known.bound,
            Objective::Makespan => known.bound - self.begin(),
        });
        alone.max(together)
    }

    /// Motions as a plan. A plan that the check refuses, or that has a contact, is not returned.
    fn answer(
        &self,
        planned: &[Motion<'_, f64>],
        known: Option<PartialDelayPlan>,
    ) -> Result<PlanAnswer, ComputationError> {
        let mut plan = self.none();
        // As it is read again: ramps shorter than a digit of the time are lost in phases.
        let solved = match Scenario::from_json(&self.solved(planned).to_json()) {
            Ok(solved) => solved,
            Err(why) => {
                let why = format!("the plan cannot be written as phases: {why}");
                plan.unsolved.push(UnplannedAgents::nowhere(Vec::new(), why));
                return Ok((plan, None));
            }
        };
        let verdict = CheckReport::watched::<f64>(&solved, false, &|done, all| self.tell_check(0, done, all))?;
        if let Some(conflict) = verdict.conflicts.first() {
            let why = format!("the plan has a conflict at {} s", conflict.t[0]);
            plan.unsolved.push(UnplannedAgents::nowhere(vec![conflict.i, conflict.j], why));
            return Ok((plan, None));
        }
        // Agents with margins that only touch are far enough apart.
        if self.scenario.agents.iter().any(|agent| agent.margin > 0.0)
            && let Some(conflict) =
                CheckReport::of_margins::<f64>(&solved)?.conflicts.iter().find(|found| !found.touching)
        {
            let why = format!("margins of the plan overlap at {} s", conflict.t[0]);
            plan.unsolved.push(UnplannedAgents::nowhere(vec![conflict.i, conflict.j], why));
            return Ok((plan, None));
        }
        let agents = self.motions.len();
        self.tell_check(1, agents, agents);
        let proof = MotionCertificate::prove::<f64>(&solved)?;
        self.tell_check(2, agents, agents);
        if let Some(contact) = proof.contacts.first() {
            let why = format!("the plan has a contact at {} s", contact.t);
            plan.unsolved.push(UnplannedAgents::nowhere(vec![contact.i, contact.j], why));
            plan.certificate = Some(proof);
            return Ok((plan, None));
        }
        plan.certificate = Some(proof);
        let begin = self.begin();
        let [mut makespan, mut sum_of_costs] = [0.0f64; 2];
        for (agent, (motion, planned)) in self.motions.iter().zip(planned).enumerate() {
            let [start, end] = [planned.time().lo, planned.time().hi];
            plan.agents.push(PlanEntry { id: self.id(agent), delay: start - motion.time().lo, t_end: end });
            makespan = makespan.max(end - begin);
            sum_of_costs += end - motion.time().lo;
        }
        let mut order: Vec<usize> = (0..planned.len()).collect();
        match &known {
            Some(known) if !known.order.is_empty() => order.clone_from(&known.order),
            _ => order.sort_by(|&a, &b| planned[a].time().lo.total_cmp(&planned[b].time().lo)),
        }
        plan.order = order.into_iter().map(|agent| self.id(agent)).collect();
        let cost = self.cost(planned);
        let bound = self.bound(known.as_ref());
        debug_assert!(bound <= cost + NEAR + lower_bound::ROUNDING * cost, "a bound of {bound} for a plan of {cost}");
        // Sums are rounded.
        let lower_bound = bound.min(cost);
        let difference = cost - lower_bound;
        let gap = if cost > 0.0 { difference / cost } else { 0.0 };
        // For a long plan a small share may be seconds.
        let proved =
            known.is_some_and(|known| known.proved) || difference <= NEAR.min(2.0 * lower_bound::ROUNDING * cost);
        plan.costs = Some(PlanCosts { makespan, sum_of_costs, lower_bound, gap, proved });
        Ok((plan, Some(solved)))
    }

    fn unsolved(&self, never: Never) -> Vec<UnplannedAgents> {
        let ids = |agents: [usize; 2]| agents.map(|agent| self.id(agent));
        let mut unsolved = Vec::new();
        if let Some(circle) = self.circle() {
            unsolved.push(UnplannedAgents::nowhere(
                circle.into_iter().map(|agent| self.id(agent)).collect(),
                CIRCULAR_WAIT,
            ));
        }
        let certain = match never {
            Never::Starts(agents) | Never::Ends(agents) | Never::Always(agents) => Some(agents),
            _ => None,
        };
        // The search stops at the first reason. Where there is no table of all, that one is no less true.
        let (pairs, unknown) = match self.never() {
            Ok(all) if !all.is_empty() => (all, None),
            Ok(_) => (Vec::from_iter(certain), None),
            Err(failure) => (Vec::from_iter(certain), Some(format!("other pairs were not looked for: {failure}"))),
        };
        let is_certain = !pairs.is_empty();
        let of_pair = |pair: usize| UnplannedAgents::of(self.scenario, ids(pairs[pair]), true);
        unsolved.extend(parallel::map_parallel(0..pairs.len(), &of_pair));
        if !is_certain {
            unsolved.push(match never {
                Never::Priorities(agents) => UnplannedAgents::of(self.scenario, ids(agents), false),
                Never::Overlap(agents) => {
                    UnplannedAgents::nowhere(ids(agents).to_vec(), "they overlap by the plan that was found")
                }
                Never::Full(agent) => {
                    UnplannedAgents::nowhere(vec![self.id(agent)], "its plan takes too many profiles or phases")
                }
                Never::Invalid { agent, reason } => UnplannedAgents::nowhere(vec![self.id(agent)], reason.to_string()),
                other => UnplannedAgents::nowhere(Vec::new(), other.to_string()),
            });
        }
        unsolved.extend(unknown.map(|why| UnplannedAgents::nowhere(Vec::new(), why)));
        unsolved
    }

    /// All pairs that meet however they move.
    fn never(&self) -> Result<Vec<[usize; 2]>, ComputationError> {
        let ecm = self.ecm()?;
        let regions = ecm.regions(self.motions).expect("the table of the fleet");
        let pairs = regions.filter(|region| region.ego() > region.other() && sides(region) == [true; 2]);
        let mut pairs: Vec<[usize; 2]> = pairs.map(|region| [region.ego(), region.other()]).collect();
        pairs.sort_unstable_by_key(|&[ego, other]| [other, ego]);
        pairs.dedup();
        Ok(pairs)
    }

    /// The scenario with the motions of a plan.
    fn solved(&self, planned: &[Motion<'_, f64>]) -> Scenario {
        let mut solved = self.scenario.clone();
        for ((agent, given), motion) in solved.agents.iter_mut().zip(self.motions).zip(planned) {
            let start = motion.time().lo;
            // A start that a rounding has moved is that of the file.
            if (start - given.time().lo).abs() > ROUNDED {
                agent.t_start = start;
            }
            let phases = motion.profile().phases();
            if phases != given.profile().phases() {
                let v0 = phases.first().map_or(0.0, |first| first.speed()[0]);
                let pieces = scenario_pieces(agent, motion).into_iter().filter(|piece| piece.duration > ROUNDED);
                agent.motion = MotionSpec::Profile { v0, pieces: pieces.collect() };
            }
        }
        solved
    }
}

/// The pieces of a motion on the path of the scenario, on which turns in place have no length. A planned motion is nowhere faster than
/// that of the file, so it stands before and after such a turn, or passes a kink in next to no time.
fn scenario_pieces(agent: &Agent, motion: &Motion<'_, f64>) -> Vec<MotionPiece> {
    let turns = motion.path().segments().iter().filter_map(|segment| match segment.curve() {
        Curve::Pivot { lever, .. } => Some((segment.from(), segment.from() + segment.length(), lever)),
        _ => None,
    });
    let turns: Vec<(f64, f64, f64, bool)> =
        turns.zip(stops_of_pivots::<f64>(agent)).map(|((from, to, lever), stops)| (from, to, lever, stops)).collect();
    let mut pieces = Vec::new();
    for phase in motion.profile().phases() {
        let (mut rest, acceleration) = (phase.time().length(), phase.acceleration());
        let ([mut speed, _], mut at) = (phase.speed(), phase.length().lo);
        let ends = turns.iter().flat_map(|&(from, to, ..)| [from, to]);
        // Ends of phases are at ends of turns but for rounding.
        let lengths = phase.length();
        let near = ROUNDED * (1.0 + lengths.hi);
        let ends = ends.filter(|end| lengths.lo + near < *end && *end < lengths.hi - near).chain([lengths.hi]);
        for end in ends {
            let after = (speed * speed + 2.0 * acceleration * (end - at)).max(0.0).sqrt();
            let time = if end >= lengths.hi { rest } else { (2.0 * (end - at) / (speed + after)).min(rest) };
            let middle = 0.5 * (at + end);
            match turns.iter().find(|(from, to, ..)| (*from..=*to).contains(&middle)) {
                None => pieces.push(MotionPiece::drive(time, acceleration)),
                Some(_) if speed == 0.0 && acceleration == 0.0 => pieces.push(MotionPiece::drive(time, 0.0)),
                Some((.., lever, true)) => pieces.push(MotionPiece::turn(time, acceleration / lever)),
                // It stands at a kink, or passes it without a stop.
                Some((.., lever, false)) if *lever >= 1.0 => pieces.push(MotionPiece::drive(time, 0.0)),
                Some(_) => {}
            }
            (rest, speed, at) = (rest - time, after, end);
        }
    }
    if turns.is_empty() { turning_while_it_waits(agent, pieces) } else { pieces }
}

/// The pieces of a motion of a disc, which waits while it turns in place, with its turns as they are in the motion of the agent. A planned
/// motion waits there at least as long.
fn turning_while_it_waits(agent: &Agent, pieces: Vec<MotionPiece>) -> Vec<MotionPiece> {
    let mut before = 0.0;
    let parts = agent.parts();
    let turns = agent.path.iter().zip(&parts).filter_map(|(segment, phases)| {
        before += segment.length();
        let turning = phases.iter().filter(|phase| segment.takes_turning() && phase.moves());
        let turning: Vec<_> = turning.map(|phase| MotionPiece::turn(phase.duration, phase.acceleration())).collect();
        (!turning.is_empty()).then_some((before, turning))
    });
    let mut turns = turns.peekable();
    if turns.peek().is_none() {
        return pieces;
    }
    let near = ROUNDED * (1.0 + agent.length());
    let (mut speed, _) = agent.motion.pieces(agent.length());
    let (mut at, mut all) = (0.0, Vec::new());
    let mut pieces = pieces.into_iter().peekable();
    let is_wait = |piece: &MotionPiece, speed: f64| speed <= ROUNDED && piece.acceleration == 0.0;
    while let Some(piece) = pieces.next() {
        if !is_wait(&piece, speed) {
            let after = (speed + piece.acceleration * piece.duration).max(0.0);
            at += 0.5 * (speed + after) * piece.duration;
            speed = after;
            all.push(piece);
            continue;
        }
        let mut wait = piece.duration;
        while let Some(next) = pieces.next_if(|next| is_wait(next, speed)) {
            wait += next.duration;
        }
        while let Some((_, turning)) = turns.next_if(|(place, _)| *place <= at + near) {
            wait -= turning.iter().map(|piece| piece.duration).sum::<f64>();
            all.extend(turning);
        }
        if wait > 0.0 {
            all.push(MotionPiece::drive(wait, 0.0));
        }
    }
    // Where it has arrived it turns as it stands.
    all.extend(turns.flat_map(|(_, turning)| turning));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fleet::Fleet;

    /// What is written of a motion with a turn, which it waits before, in and after, is read as the same motion.
    #[test]
    fn motions_with_turns_are_written_as_they_are_read() {
        let corner = |[ahead, left]: [f64; 2]| serde_json::json!({ "ahead": ahead, "left": left });
        let polygon = [[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]].map(corner);
        let piece = |duration: f64, accel: f64| serde_json::json!({ "duration": duration, "accel": accel });
        let turn = 1e-9 * std::f64::consts::FRAC_PI_2;
        let pieces = [
            piece(2.0, 0.5),
            piece(2.0, -0.5),
            piece(3.0, 0.0),
            piece(1.0, 0.5 * turn),
            piece(1.0, -0.5 * turn),
            piece(0.7, 0.0),
            piece(1.0, 0.5 * turn),
            piece(1.0, -0.5 * turn),
            piece(0.3, 0.0),
            piece(2.0, 0.5),
            piece(2.0, -0.5),
        ];
        let line = serde_json::json!({ "kind": "line", "length": 2.0 });
        let path = serde_json::json!([line, { "kind": "turn", "sweep": std::f64::consts::FRAC_PI_2 }, line]);
        let outlined = serde_json::json!({ "id": 1, "footprint": { "polygon": polygon }, "path": path,
            "start": { "x": 0.0, "y": 0.0, "heading": 0.0 }, "profile": { "v0": 0.0, "pieces": pieces } });
        let mut disc = outlined.clone();
        disc.as_object_mut().expect("an object").remove("footprint");
        disc["radius"] = serde_json::json!(0.5);
        [outlined, disc].iter().for_each(is_read_as_written);
    }

    fn is_read_as_written(agent: &serde_json::Value) {
        let mut scenario = Scenario::from_value(&serde_json::json!({ "agents": [agent] })).expect("a scenario");
        let fleet = Fleet::<f64>::of_bodies(&scenario).expect("it fits");
        let motions = fleet.motions();
        let pivots = motions[0].path().segments().iter().filter(|it| matches!(it.curve(), Curve::Pivot { .. }));
        assert_eq!(pivots.count(), usize::from(scenario.agents[0].footprint.is_some()));
        scenario.agents[0].motion =
            MotionSpec::Profile { v0: 0.0, pieces: scenario_pieces(&scenario.agents[0], &motions[0]) };
        assert!(scenario.agents[0].motion.turns_in_place());
        let read = Scenario::from_json(&scenario.to_json()).expect("what was written");
        let again = Fleet::<f64>::of_bodies(&read).expect("it fits");
        let again = again.motions();
        for step in 0..=1_600 {
            let time = f64::from(step) / 100.0;
            let apart = motions[0].length_at(time) - again[0].length_at(time);
            assert!(apart.abs() < 1e-6, "{time}: {apart}");
        }
    }
}
