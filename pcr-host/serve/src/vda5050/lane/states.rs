//! What the vehicle says.

use super::super::door::{self, Limits, Refusal};
use super::super::header::Header;
use super::super::messages::Visualization;
use super::super::state::{Pose, State};
use super::super::topics::Kind;
use super::Lane;
use crate::course::{Course, Start};
use crate::supervisor::{Report, Supervisor};
use std::sync::Arc;

/// A vehicle that says otherwise so often in a row, for so long \[s\], has lost its order or was moved.
const ASTRAY: (u32, f64) = (3, 2.0);

impl Lane {
    /// Takes a state.
    ///
    /// # Errors
    /// [`Refusal`] for what is none; it counts for nothing.
    pub fn state(
        &mut self,
        supervisor: &mut Supervisor,
        bytes: &[u8],
        limits: Limits,
        is_third: bool,
        now: f64,
    ) -> Result<(), Refusal> {
        let state: State = door::read(bytes, limits)?;
        let version = state.header.check(&self.profile.key, is_third)?;
        let is_new = self.is_new(Kind::State, &state.header);
        if is_new {
            self.version = Some(version);
        }
        self.acknowledge(&state);
        self.locate(supervisor, &state, is_new, now);
        if is_new {
            self.state = Some(Arc::new(state));
            self.finish(supervisor, now);
            self.mirror();
        }
        Ok(())
    }

    /// The vehicle has the updates up to the one that it names.
    fn acknowledge(&mut self, state: &State) {
        let Some(job) = self.job.as_mut().filter(|job| job.held.order_id == state.order_id) else { return };
        let Some(sent) = job.sent else { return };
        let update = state.order_update_id;
        if update == sent.update && state.base() == job.last().sequence {
            job.acknowledged = Some((update, sent.manager));
        }
    }

    /// Takes where the vehicle is, as far as it is sure.
    fn locate(&mut self, supervisor: &mut Supervisor, state: &State, is_new: bool, now: f64) {
        let Some(pose) = state.position().filter(|pose| pose.is_known()) else { return };
        let at = [pose.x, pose.y];
        let Ok(robot) = supervisor.robot(&self.name) else {
            if is_new && self.is_still(state) && self.reach(pose) >= 0.0 {
                let start = Start { x: pose.x, y: pose.y, heading: pose.theta };
                // Where it cannot stand, it is asked again with its next state.
                let _ = supervisor.add(&self.name, self.profile.abilities, start);
            }
            return;
        };
        let reach = self.reach(pose);
        let (path, end) = (robot.path, robot.course.length());
        let found = match &self.job {
            Some(job) if job.held.order_id == state.order_id => {
                let Some(place) = job.stop(state.last_node_sequence_id) else { return };
                let from = job.stops[place].length;
                let to = job.stops.get(place + 1).map_or(from, |next| next.length);
                let offset = job.offset(robot);
                // It counts as passed before the vehicle is all there.
                let near = job.way.near(at, [from - reach.max(0.0), to], reach);
                near.map(|lengths| lengths.map(|length| (length - offset).clamp(0.0, end)))
            }
            _ if !is_new => return,
            Some(job) => {
                let offset = job.offset(robot);
                let start = (0.0 - offset).clamp(0.0, end);
                job.way.near(at, [0.0, 0.0], reach).map(|_| [start; 2])
            }
            None => {
                let there = robot.course.pose(end);
                ((there.x - at[0]).hypot(there.y - at[1]) <= reach).then_some([end; 2])
            }
        };
        match found {
            Some(at) => {
                // The path is that of the robot, and the place on it: there is nothing to refuse.
                let _ = supervisor.position(&Report { robot: self.name.clone(), path, at, age: 0.0 }, now);
            }
            None if is_new => {
                let _ = supervisor.off(&self.name, at, now);
            }
            None => {}
        }
    }

    /// What is left of the margin for being off the path \[m\].
    fn reach(&self, pose: &Pose) -> f64 {
        self.deviation() - pose.deviation_range.unwrap_or(0.0)
    }

    /// Whether it stands and has nothing to do.
    fn is_still(&self, state: &State) -> bool {
        !state.driving && state.node_states.iter().all(|node| !node.released)
    }

    /// Ends an order that was cancelled, or that the vehicle has lost.
    fn finish(&mut self, supervisor: &mut Supervisor, now: f64) {
        let Some(state) = self.state.clone() else { return };
        let Ok(robot) = supervisor.robot(&self.name) else { return };
        let is_off = robot.alarm.is_some();
        let Some(job) = &self.job else {
            // It was moved by hand: it stands where it says.
            if self.stays_astray(is_off && self.is_still(&state), now) {
                self.reseat(supervisor, &state);
            }
            return;
        };
        let has_it = job.held.order_id == state.order_id;
        if let Some(action) = job.cancel.clone() {
            let status = state.action(&action);
            let nothing_sent = job.sent.is_none();
            if (has_it && status == Some("FINISHED") || nothing_sent) && self.is_still(&state) {
                self.reseat(supervisor, &state);
            } else if has_it && status == Some("FAILED") && !state.node_states.is_empty() {
                // It came before the order.
                self.cancel_again(supervisor, now);
            } else if has_it && status == Some("FAILED") && job.is_acknowledged() && !self.is_free(supervisor) {
                // It had come to the end of what it was given: nothing more will come.
                self.reseat(supervisor, &state);
            }
            return;
        }
        // An update is sent when the one before it was there, perhaps to another supervisor.
        let had_it = job.acknowledged.is_some() || job.sent.is_some_and(|sent| sent.update > 0);
        if self.stays_astray(had_it && !has_it && self.is_still(&state), now) {
            self.reseat(supervisor, &state);
        }
    }

    fn stays_astray(&mut self, is_astray: bool, now: f64) -> bool {
        let (count, since) = self.astray.unwrap_or((0, now));
        self.astray = is_astray.then_some((count + 1, since));
        is_astray && count + 1 >= ASTRAY.0 && now - since >= ASTRAY.1
    }

    /// The vehicle stands where it says, without an order: all that it had been allowed to is void.
    fn reseat(&mut self, supervisor: &mut Supervisor, state: &State) {
        let Some(pose) = state.position().filter(|pose| pose.is_known() && self.reach(pose) >= 0.0) else { return };
        let start = Start { x: pose.x, y: pose.y, heading: pose.theta };
        // Where it could not be added again it stays what it was: nobody may drive through one that is forgotten.
        let abilities = self.profile.abilities;
        let stands = Course::new(start, Vec::new()).and_then(|course| course.motion(abilities.reach()).map(drop));
        if stands.is_err() || supervisor.remove(&self.name).is_err() {
            return;
        }
        self.astray = None;
        self.job = None;
        // If that fails it is added with its next state.
        let _ = supervisor.add(&self.name, abilities, start);
    }

    /// Takes a position that comes between states. It says nothing of orders, hence counts only on the stretch that the newest state names.
    ///
    /// # Errors
    /// [`Refusal`] for what is none; it counts for nothing.
    pub fn visualization(
        &mut self,
        supervisor: &mut Supervisor,
        bytes: &[u8],
        limits: Limits,
        is_third: bool,
        now: f64,
    ) -> Result<(), Refusal> {
        let message: Visualization = door::read(bytes, limits)?;
        // Schema 2.0 does not ask for a header.
        if message.header != Header::default() {
            message.header.check(&self.profile.key, is_third)?;
        }
        let stamp = |header: &Header| pcr_formats::import::seconds(&header.timestamp);
        let newer = stamp(&message.header).zip(self.state.as_ref().and_then(|state| stamp(&state.header)));
        if !self.is_new(Kind::Visualization, &message.header) || newer.is_none_or(|(own, state)| own < state) {
            return Ok(());
        }
        if let Some(mut state) = self.state.as_deref().cloned() {
            let has_it = self.job.as_ref().is_some_and(|job| job.held.order_id == state.order_id);
            (state.agv_position, state.mobile_robot_position) = (message.agv_position, message.mobile_robot_position);
            // It may have passed the next node since: no alarm.
            if has_it {
                self.locate(supervisor, &state, false, now);
            }
        }
        Ok(())
    }
}
