//! Missions of a file, given to vehicles: which one does which mission, and the stops of each, one after the other.

use super::own_missions::{MissionOutcome, OwnMission};
use super::robot_mission::RobotMission;
use super::route_graph::DeparturePose;
use super::run_state::LifelongState;
use std::time::Duration;

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
            let OwnMission { request, unable, .. } = &own.missions[mission];
            let idle = (0..self.robots.len()).filter(|&robot| {
                own.current[robot].is_none()
                    && self.missions[robot].is_none()
                    && request.vehicle.is_none_or(|vehicle| vehicle == robot)
                    && !unable.contains(&robot)
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
            let is_free =
                self.missions[robot].is_none() && self.world.suspended[robot].is_none() && self.is_able(robot, now);
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
        self.reach_where_they_stand(now);
    }

    /// Counts the next stops of vehicles that stand there already: a mission may begin where its vehicle is, and a vehicle may have been sent there
    /// to make way.
    fn reach_where_they_stand(&mut self, now: f64) {
        for robot in 0..self.robots.len() {
            let it = &self.robots[robot];
            let is_there =
                self.missions[robot].is_some_and(|mission| !mission.admitted && mission.goal == it.way.end());
            if !is_there || !it.has_arrived() || it.cut.is_some() {
                continue;
            }
            if let Some(own) = &mut self.own
                && let Some(mission) = own.current[robot]
            {
                own.missions[mission].begun.get_or_insert(now);
            }
            self.arrived(robot, now);
        }
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
        !self.world.is_stranded(robot, now)
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
