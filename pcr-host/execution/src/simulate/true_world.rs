//! The true world, frame by frame: robots, their missions, and a record of everything.

use super::outcome::{MissionRecord, MotionTrace};
use super::simulation_task::{RobotTask, SimulationTask};
use super::speed_limited_path::SpeedLimitedPath;
use super::true_state::{TrueRobotState, TurnState};
use super::vector::PlaneVector;
use super::{ClosedLoopOptions, ControlInput, FRAME, RobotController};

/// A robot with its missions.
struct WorldRobot<'a> {
    robot: &'a RobotTask,
    body: TrueRobotState,
    /// The course of its present or last mission.
    course: Option<&'a SpeedLimitedPath>,
    /// Number of missions begun.
    begun: usize,
    travels: bool,
}

impl WorldRobot<'_> {
    /// Its heading on its path, from which it is never off \[rad\]; for discs it does not count.
    fn heading(&self) -> f64 {
        if self.robot.body.is_disc() {
            return 0.0;
        }
        let first = self.robot.missions.first().map(|mission| &mission.course);
        self.course.or(first).map_or(0.0, |course| course.heading_at(self.body.travelled()))
    }
}

pub(super) struct TrueWorld<'a> {
    agents: Vec<WorldRobot<'a>>,
    pub(super) trace: MotionTrace,
}

impl<'a> TrueWorld<'a> {
    pub(super) fn new(task: &'a SimulationTask, settings: ClosedLoopOptions) -> Self {
        let agent = |(place, robot): (usize, &'a RobotTask)| {
            let body = TrueRobotState::new(robot, place, settings.seed, settings.disturbance);
            WorldRobot { robot, body, course: None, begun: 0, travels: false }
        };
        let agents: Vec<WorldRobot<'a>> = task.robots.iter().enumerate().map(agent).collect();
        let positions = agents.iter().map(|agent| vec![agent.body.position()]).collect();
        let travelled = vec![vec![0.0]; agents.len()];
        let headings = agents.iter().map(|agent| vec![agent.heading()]).collect();
        Self { agents, trace: MotionTrace { positions, headings, travelled, journeys: Vec::new() } }
    }

    /// Announces the first mission of each robot before it begins.
    pub(super) fn announce(&self, control: &mut dyn RobotController) {
        for (place, agent) in self.agents.iter().enumerate() {
            if let Some(first) = agent.robot.missions.first().filter(|first| first.release > 0.0) {
                control.announce(place, &first.course, first.release);
            }
        }
    }

    /// Ends and begins missions at a frame.
    pub(super) fn missions(&mut self, frame: usize, control: &mut dyn RobotController) {
        let time = frame as f64 * FRAME;
        for (place, agent) in self.agents.iter_mut().enumerate() {
            let Some(end) = agent.course.filter(|_| agent.travels) else { continue };
            if agent.body.has_arrived(end, control.goal_tolerance(place)) {
                agent.travels = false;
                let of = |journey: &&mut MissionRecord| journey.robot == place && journey.end.is_none();
                if let Some(journey) = self.trace.journeys.iter_mut().find(of) {
                    journey.end = Some(frame);
                }
            }
        }
        for (place, agent) in self.agents.iter_mut().enumerate().filter(|(_, agent)| !agent.travels) {
            let Some(next) = agent.robot.missions.get(agent.begun).filter(|next| next.release <= time) else {
                continue;
            };
            agent.body.begin();
            agent.course = Some(&next.course);
            (agent.travels, agent.begun) = (true, agent.begun + 1);
            control.assign(place, &next.course);
            self.trace.journeys.push(MissionRecord {
                robot: place,
                begin: frame,
                end: None,
                goal: next.course.point_at(next.course.length()),
                unimpeded: next.course.unimpeded(agent.robot.limits),
            });
        }
    }

    /// The share of the missions that is done, from 0 to 1: each counts with its time without other robots, and those under way with
    /// the part of their path behind the robot.
    pub(super) fn share(&self) -> f64 {
        let (mut done, mut all) = (0.0, 0.0);
        for agent in &self.agents {
            for (place, mission) in agent.robot.missions.iter().enumerate() {
                let time = mission.course.unimpeded(agent.robot.limits);
                all += time;
                done += match place + 1 {
                    under_way if under_way == agent.begun && agent.travels => {
                        time * (agent.body.travelled() / mission.course.length()).clamp(0.0, 1.0)
                    }
                    number if number <= agent.begun => time,
                    _ => 0.0,
                };
            }
        }
        if all > 0.0 { done / all } else { 0.0 }
    }

    /// Whether all missions are done.
    pub(super) fn is_done(&self) -> bool {
        self.agents.iter().all(|agent| !agent.travels && agent.begun == agent.robot.missions.len())
    }

    /// Whether all robots have been given all of their missions.
    pub(super) fn all_given(&self) -> bool {
        self.agents.iter().all(|agent| agent.begun == agent.robot.missions.len())
    }

    /// Simulates from a frame to the next one.
    pub(super) fn step(&mut self, frame: usize, control: &mut dyn RobotController) {
        let time = frame as f64 * FRAME;
        let seen: Vec<PlaneVector> = self.agents.iter_mut().map(|agent| agent.body.observed()).collect();
        let speeds: Vec<f64> = self.agents.iter().map(|agent| agent.body.speed()).collect();
        let arrived: Vec<bool> = self.agents.iter().map(|agent| agent.course.is_some() && !agent.travels).collect();
        let turning: Vec<Option<TurnState>> = self.agents.iter().map(|agent| agent.body.turning()).collect();
        let commands = control.commands(&ControlInput {
            time,
            seen: &seen,
            speeds: &speeds,
            arrived: &arrived,
            turning: &turning,
        });
        let MotionTrace { positions, headings, travelled, .. } = &mut self.trace;
        let tracks = positions.iter_mut().zip(headings).zip(travelled);
        for ((agent, command), ((track, headings), travelled)) in self.agents.iter_mut().zip(commands).zip(tracks) {
            agent.body.step(time, command, agent.course);
            track.push(agent.body.position());
            headings.push(agent.heading());
            travelled.push(agent.body.travelled());
        }
    }
}
