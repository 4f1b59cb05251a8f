//! Missions of a file: which vehicle does which one, and how far each has come.
//!
//! A mission is a list of stops. The vehicle gets them one after the other, each as a mission of its own, with the next one known
//! before it is at the present one.

use super::own_events::OwnEvent;
use super::route_graph::DeparturePose;
use super::run_state::{LifelongState, RobotMission};
use pcr_formats::import::Layout;
use pcr_formats::missions::{FleetMissions, MissionRequest};
use std::time::Duration;

/// What became of a mission.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum MissionOutcome {
    /// No vehicle has it yet.
    Open,
    /// A vehicle is on its way.
    Begun,
    /// It was done at this time \[s\].
    Done(f64),
    /// It was given up, and why.
    Refused(String),
}

/// A mission, and what has become of it so far.
#[derive(Clone, Debug)]
pub(super) struct OwnMission {
    pub(super) request: MissionRequest,
    pub(super) outcome: MissionOutcome,
    /// The vehicle that has it.
    pub(super) vehicle: Option<usize>,
    /// Time at which that vehicle got a route for it \[s\].
    pub(super) begun: Option<f64>,
    /// Times at which its stops were reached \[s\].
    pub(super) reached: Vec<f64>,
}

/// Where a vehicle waited for another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OwnWait {
    pub(super) vehicle: usize,
    /// The vehicle that had to go first.
    pub(super) other: usize,
    /// From when to when \[s\].
    pub(super) time: [f64; 2],
    /// Index of the edge on which it stood; `None` at a node.
    pub(super) edge: Option<usize>,
    /// Where it stood \[m\].
    pub(super) point: [f64; 2],
}

/// The missions of a file.
#[derive(Clone, Debug)]
pub(super) struct OwnMissions {
    pub(super) fleet: FleetMissions,
    pub(super) missions: Vec<OwnMission>,
    /// The mission of each vehicle.
    pub(super) current: Vec<Option<usize>>,
    pub(super) waits: Vec<OwnWait>,
    /// What became of the closures and breakdowns of the file.
    pub(super) closures: Vec<OwnEvent>,
    pub(super) breakdowns: Vec<OwnEvent>,
    /// Time at which a stop was reached for the last time \[s\].
    pub(super) progress: f64,
    /// Names of the nodes and edges of the layout.
    pub(super) nodes: Vec<String>,
    pub(super) edges: Vec<String>,
}

impl OwnMissions {
    pub(super) fn new(fleet: &FleetMissions, layout: &Layout) -> Self {
        let missions = fleet.missions.iter().map(|request| OwnMission {
            request: request.clone(),
            outcome: MissionOutcome::Open,
            vehicle: None,
            begun: None,
            reached: Vec::new(),
        });
        let (missions, current) = (missions.collect(), vec![None; fleet.vehicles.len()]);
        let nodes = layout.nodes.iter().map(|node| node.id.to_string()).collect();
        let edges = layout.edges.iter().map(|edge| edge.id.to_string()).collect();
        let [closures, breakdowns] =
            [fleet.closures.len(), fleet.breakdowns.len()].map(|count| vec![OwnEvent::default(); count]);
        let (fleet, waits, progress) = (fleet.clone(), Vec::new(), 0.0);
        Self { fleet, missions, current, waits, closures, breakdowns, progress, nodes, edges }
    }

    /// Number of missions that are done or given up.
    pub(super) fn over(&self) -> usize {
        let is_over =
            |mission: &&OwnMission| matches!(mission.outcome, MissionOutcome::Done(_) | MissionOutcome::Refused(_));
        self.missions.iter().filter(is_over).count()
    }

    /// Whether every mission is done or given up.
    pub(super) fn is_over(&self) -> bool {
        self.over() == self.missions.len()
    }

    /// Whether missions will be released after this time.
    pub(super) fn is_to_come(&self, now: f64) -> bool {
        self.missions.iter().any(|mission| mission.outcome == MissionOutcome::Open && mission.request.release > now)
    }

    /// The node of the stop after the next one in the mission of a vehicle.
    pub(super) fn next_stop(&self, vehicle: usize) -> Option<usize> {
        let mission = &self.missions[self.current[vehicle]?];
        mission.request.stops.get(mission.reached.len() + 1).copied()
    }

    /// Gives a mission up.
    pub(super) fn refuse(&mut self, mission: usize, why: String) {
        self.missions[mission].outcome = MissionOutcome::Refused(why);
        self.current.iter_mut().filter(|current| **current == Some(mission)).for_each(|current| *current = None);
    }

    /// Notes that a vehicle waits for another one during a step.
    pub(super) fn wait(&mut self, wait: OwnWait) {
        /// Waits with a shorter time between them are one \[s\].
        const GAP: f64 = 0.5;
        let same = |last: &&mut OwnWait| {
            (last.vehicle, last.other, last.edge) == (wait.vehicle, wait.other, wait.edge)
                && wait.time[0] - last.time[1] < GAP
        };
        match self.waits.iter_mut().rev().take(64).find(same) {
            Some(last) => last.time[1] = wait.time[1],
            None => self.waits.push(wait),
        }
    }
}

impl LifelongState {
    /// Gives their next stops to vehicles on missions, and missions that are released to vehicles without one.
    pub(super) fn give_own(&mut self, now: f64) {
        let Some(mut own) = self.own.take() else { return };
        let mut open: Vec<usize> = (0..own.missions.len())
            .filter(|&mission| own.missions[mission].outcome == MissionOutcome::Open)
            .filter(|&mission| own.missions[mission].request.release <= now)
            .collect();
        open.sort_by(|&a, &b| {
            let [a, b] = [a, b].map(|mission| &own.missions[mission].request);
            b.priority.cmp(&a.priority).then(a.release.total_cmp(&b.release))
        });
        for mission in open {
            let request = &own.missions[mission].request;
            let idle = (0..self.robots.len()).filter(|&robot| {
                own.current[robot].is_none()
                    && self.missions[robot].is_none()
                    && request.vehicle.is_none_or(|vehicle| vehicle == robot)
                    && self.is_able(robot, now)
            });
            let times = idle.map(|robot| (self.time_to(robot, &request.stops), robot));
            let nearest = times.filter(|time| time.0 < f64::INFINITY).min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((_, robot)) = nearest {
                let it = &mut own.missions[mission];
                (it.outcome, it.vehicle) = (MissionOutcome::Begun, Some(robot));
                own.current[robot] = Some(mission);
            }
        }
        for robot in 0..self.robots.len() {
            let is_free = self.missions[robot].is_none() && self.is_able(robot, now);
            let Some(mission) = own.current[robot].filter(|_| is_free) else { continue };
            let mission = &own.missions[mission];
            let Some(&stop) = mission.request.stops.get(mission.reached.len()) else { continue };
            self.missions[robot] = Some(RobotMission {
                goal: self.node_of_layer(robot, stop),
                assigned_at: now,
                rank: mission.request.release - RANK * mission.request.priority as f64,
                unimpeded_time: 0.0,
                admitted: !self.robots[robot].way.goals.is_empty(),
                passed: 0,
                next_try: now,
                prepared: Duration::ZERO,
            });
        }
        self.own = Some(own);
    }

    /// Time of a robot alone until it is at all of these nodes of the layout, one after the other; infinite if no route leads there
    /// \[s\].
    pub(super) fn time_to(&self, robot: usize, stops: &[usize]) -> f64 {
        let it = &self.robots[robot];
        let mut from = it.way.committed_part(&self.site, it.at, it.stop(), it.turned).end_pose;
        let mut time = it.way.time(it.way.length()) - it.way.time(it.at);
        for stop in stops {
            let node = self.node_of_layer(robot, *stop);
            time += self.network.times(&self.site, node)(from);
            from = DeparturePose { node, heading: None };
        }
        time
    }

    /// The node of a place of the layout in the layer of a robot.
    pub(super) fn node_of_layer(&self, robot: usize, place: usize) -> usize {
        self.site.layer_of(self.robots[robot].way.end()) * self.site.places() + place
    }

    /// Whether a vehicle can drive.
    fn is_able(&self, robot: usize, now: f64) -> bool {
        self.robots[robot].stopped_until <= now
    }

    /// Notes that a vehicle has reached the next stop of its mission.
    pub(super) fn reached_stop(&mut self, robot: usize, now: f64) {
        let Some(own) = &mut self.own else { return };
        own.progress = now;
        let Some(mission) = own.current[robot] else { return };
        let it = &mut own.missions[mission];
        it.reached.push(now);
        if it.reached.len() == it.request.stops.len() {
            it.outcome = MissionOutcome::Done(now);
            own.current[robot] = None;
        }
    }
}

/// Difference of ranks for one step of priority \[s\]: longer than any file.
const RANK: f64 = 1e8;
