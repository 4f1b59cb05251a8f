//! Messages of the vehicle.

use super::super::door::{self, Limits, Refusal};
use super::super::header::Header;
use super::super::messages::Visualization;
use super::super::state::{Pose, State};
use super::super::topics::Kind;
use super::maps::{MAP, map_of};
use super::newest::Place;
use super::refused::TRIED;
use super::{Job, Lane};
use crate::course::Start;
use crate::robot::{BACK, Robot};
use crate::supervisor::{Report, Supervisor};
use std::sync::Arc;

/// Number of successive states, and time \[s\], after which a vehicle that contradicts its order has lost it or was moved.
const ASTRAY: (u32, f64) = (3, 2.0);

/// Time for which a vehicle that has lost its order keeps its right of way \[s\]: another order may follow the same way.
const KEPT: f64 = 30.0;

/// Least time by which a late message counts as older than the newest one, and largest age that is passed on \[s\]: the supervisor
/// refuses larger ages.
const LATE: f64 = 1e-3;
const OLDEST: f64 = 1e6;

/// The kind of message with a position.
#[derive(Clone, Copy, Debug, PartialEq)]
enum With {
    /// The newest state.
    Newest,
    /// A message between states, after the newest one.
    Between,
    /// A state that was written before the newest one.
    Late,
}

impl Lane {
    /// Takes a state.
    ///
    /// # Errors
    /// [`Refusal`] for an invalid state, which has no effect.
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
        let newest = self.newest.entry(Kind::State).or_default();
        let place = newest.take(&state.header, now, |action| state.names(action));
        if newest.is_in_doubt(now) {
            self.ask_when(now);
        }
        if place == Place::Anew {
            // Its clock may have restarted.
            self.newest.remove(&Kind::Visualization);
        }
        let is_new = place != Place::Late;
        if is_new {
            self.version = Some(version);
        }
        self.acknowledge(&state);
        if let Some(job) = self.job.as_mut().filter(|_| is_new) {
            job.refused = job.is_refused(&state).then(|| job.refused.unwrap_or(now));
        }
        let located = match is_new {
            true => self.locate(supervisor, &state, With::Newest, now),
            false => self.locate(supervisor, &state, With::Late, now),
        };
        if is_new {
            self.heard_at = now;
            self.state = Some(Arc::new(state));
            self.finish(supervisor, now);
            self.mirror();
        }
        located
    }

    /// Requests a state that is certainly newer than all states so far, if that is in doubt.
    pub(super) fn ask_when(&mut self, now: f64) {
        let id = self.ask_for("stateRequest");
        self.newest.entry(Kind::State).or_default().asks(id, now);
    }

    /// Takes the order update id of a state as a confirmation.
    fn acknowledge(&mut self, state: &State) {
        let Some(job) = self.job.as_mut().filter(|job| job.held.order_id == state.order_id) else { return };
        let Some(sent) = job.sent else { return };
        let update = state.order_update_id;
        if update == sent.update && state.base() == job.last().sequence {
            job.acknowledged = Some((update, sent.manager));
        }
    }

    /// Takes the position of the vehicle, as far as it is certain.
    ///
    /// # Errors
    /// [`Refusal`] for a position on another map.
    fn locate(&mut self, supervisor: &mut Supervisor, state: &State, with: With, now: f64) -> Result<(), Refusal> {
        let Some(pose) = state.position().filter(|pose| pose.is_known()) else { return Ok(()) };
        let (at, is_new) = ([pose.x, pose.y], with == With::Newest);
        let Ok(robot) = supervisor.robot(&self.name) else {
            if is_new && self.is_still(state) && self.reach(pose) >= 0.0 {
                self.shares(supervisor, &pose.map_id)?;
                let start = Start { x: pose.x, y: pose.y, heading: pose.theta };
                // If it cannot stand there, the next state is tried again. An order that it had is void.
                if supervisor.add(&self.name, self.profile.abilities, start).is_ok() {
                    (self.job, self.astray) = (None, None);
                    self.note_anew(supervisor);
                    self.note(supervisor, MAP, &pose.map_id);
                }
            }
            return Ok(());
        };
        if let Some(map) = map_of(robot).filter(|map| *map != pose.map_id) {
            let why = format!("{:?}; what is known of it is on {map:?}", pose.map_id);
            return Err(Refusal::new("position.mapId", why));
        }
        if is_new {
            self.elsewhere = None;
        }
        // On a mission that is none of its order, nobody knows what its lengths mean.
        if self.job.as_ref().is_some_and(|job| job.offset(robot).is_none()) {
            return Ok(());
        }
        let offset = self.job.as_ref().and_then(|job| job.offset(robot)).unwrap_or_default();
        let reach = self.reach(pose);
        let (path, end) = (robot.path, robot.course.length());
        let back = robot.at - 2.0 * self.deviation() - BACK;
        let found = match &self.job {
            Some(job) if job.held.order_id == state.order_id => {
                let Some(place) = job.passed(state) else {
                    // The vehicle names a node that was not released, a node of an earlier order, or none, or one that it has ahead. If its
                    // position is on its path anyway, this is not an alarm.
                    if is_new && self.on_its_way(job, robot, pose).is_none() {
                        let _ = supervisor.off(&self.name, at, 0.0, now);
                    }
                    return Ok(());
                };
                let from = job.stops[place].length;
                let to = job.stops.get(place + 1).map_or(from, |next| next.length);
                // Vehicles report a node as passed when they are near it, so the search begins before the node.
                let near = job.way.near(at, [from - reach.max(0.0), to], reach);
                near.map(|lengths| lengths.map(|length| (length - offset).clamp(0.0, end)))
            }
            _ if !is_new => return Ok(()),
            Some(job) if job.was_there() => {
                self.on_its_way(job, robot, pose).map(|lengths| lengths.map(|length| (length - offset).clamp(0.0, end)))
            }
            Some(job) => {
                let start = (0.0 - offset).clamp(0.0, end);
                job.way.near(at, [0.0, 0.0], reach).map(|_| [start; 2])
            }
            None => {
                let there = robot.course.pose(end);
                ((there.x - at[0]).hypot(there.y - at[1]) <= reach).then_some([end; 2])
            }
        };
        match found {
            // The vehicle rolled or was pushed back into a part of its path that may already be free for others.
            Some([_, hi]) if is_new && hi < back => _ = supervisor.off(&self.name, at, 0.0, now),
            // It may have passed the next node since, and be on its way back: this neither begins nor ends an alarm.
            Some([_, hi]) if with == With::Between && hi < back => {}
            Some(at) => {
                // Older than the newest message, by an unknown time.
                let age = if with == With::Late { (now - self.heard_at).max(0.0) + LATE } else { 0.0 };
                // Path and interval are valid, so this cannot be refused.
                let _ = supervisor.position(&Report { robot: self.name.clone(), path, at, age: age.min(OLDEST) }, now);
            }
            None if is_new => _ = supervisor.off(&self.name, at, 0.0, now),
            None => {}
        }
        Ok(())
    }

    /// Lengths at which a vehicle that does not confirm its order is on its way, between its last position and its hold.
    pub(super) fn on_its_way(&self, job: &Job, robot: &Robot, pose: &Pose) -> Option<[f64; 2]> {
        let (offset, reach) = (job.offset(robot)?, self.reach(pose));
        job.way.near([pose.x, pose.y], [robot.at + offset - reach.max(0.0), robot.told + offset], reach)
    }

    /// Part of the margin that is left for being off the path \[m\].
    fn reach(&self, pose: &Pose) -> f64 {
        self.deviation() - pose.deviation_range.unwrap_or(0.0)
    }

    /// Whether the vehicle stands and has nothing to do.
    fn is_still(&self, state: &State) -> bool {
        !state.driving && state.node_states.iter().all(|node| !node.released)
    }

    /// Ends an order that was cancelled, or that the vehicle has lost.
    fn finish(&mut self, supervisor: &mut Supervisor, now: f64) {
        let Some(state) = self.state.clone() else { return };
        let Ok(robot) = supervisor.robot(&self.name) else { return };
        let is_off = robot.alarm.is_some();
        let Some(job) = &self.job else {
            // It was moved by hand, or to another map: its reported position counts.
            let map = state.position().map(|pose| pose.map_id.as_str());
            let is_elsewhere = map_of(robot).is_some_and(|known| map.is_some_and(|map| known != map));
            if self.stays_astray((is_off || is_elsewhere) && self.is_still(&state), now) {
                self.reseat(supervisor, &state);
            }
            return;
        };
        let has_it = job.held.order_id == state.order_id;
        let is_refused = job.refused.is_some();
        if let Some(action) = job.cancel.clone() {
            let status = state.action(&action);
            let has_nothing = job.sent.is_none() || job.lost.is_some();
            // It has all updates that were sent, or has sent a state since it was told to cancel: no update that it may still
            // drive is on its way.
            let is_told = job.is_acknowledged() || self.heard_at > job.sent_at.max(job.cancelled_at);
            let is_cancelled = has_it && status == Some("FINISHED") && is_told;
            if (is_cancelled || has_nothing) && self.is_still(&state) {
                self.reseat(supervisor, &state);
            } else if is_refused && status == Some("FAILED") && self.is_still(&state) {
                // It has no part of what it refuses: what was sent before the cancellation has come before it.
                match job.cancelled_at >= job.sent_at {
                    true => self.reseat(supervisor, &state),
                    false => self.cancel_again(supervisor, now),
                }
            } else if job.was_there() && !has_it {
                // It has lost the order before it was cancelled, and does not get it again.
                if self.stays_astray(self.is_still(&state), now) {
                    self.reseat(supervisor, &state);
                }
            } else if has_it && status == Some("FAILED") && !state.node_states.is_empty() {
                // The cancellation came before the order.
                self.cancel_again(supervisor, now);
            } else if has_it && status == Some("FAILED") && job.is_acknowledged() && !self.is_free(supervisor) {
                // It had reached the end of its order: nothing more will come.
                self.reseat(supervisor, &state);
            }
            return;
        }
        if !job.was_there() && job.refused.is_some_and(|since| now - since >= TRIED) {
            return self.cancel_again(supervisor, now);
        }
        let (is_gone, lost) = (job.was_there() && !has_it && self.is_still(&state), job.lost);
        let is_astray = self.stays_astray(is_gone, now);
        let Some(job) = &mut self.job else { return };
        if has_it {
            job.lost = None;
        }
        if !is_astray {
            return;
        }
        // Its manager sends it on, or it has stood there for some time without an order.
        let since = *job.lost.get_or_insert(now);
        if is_off || lost.is_some() && now - since > KEPT {
            self.reseat(supervisor, &state);
        }
    }

    fn stays_astray(&mut self, is_astray: bool, now: f64) -> bool {
        let (count, since) = self.astray.unwrap_or((0, now));
        self.astray = is_astray.then_some((count + 1, since));
        is_astray && count + 1 >= ASTRAY.0 && now - since >= ASTRAY.1
    }

    /// Sets the vehicle to its reported position, without an order: all its rights are void.
    pub(super) fn reseat(&mut self, supervisor: &mut Supervisor, state: &State) {
        let Some(pose) = state.position().filter(|pose| pose.is_known() && self.reach(pose) >= 0.0) else { return };
        let map = pose.map_id.clone();
        // On its way it is as far off as before, and not farther by the error of this position.
        let on_way = self.job.as_ref().zip(supervisor.robot(&self.name).ok()).and_then(|(job, robot)| {
            let within = self.on_its_way(job, robot, pose).filter(|_| robot.alarm.is_none())?;
            Some(nearest(job, within, [pose.x, pose.y]))
        });
        let start = on_way.unwrap_or(Start { x: pose.x, y: pose.y, heading: pose.theta });
        if self.shares(supervisor, &map).is_err() {
            return;
        }
        // If it cannot stand there, its former place is kept, so that no other vehicle drives through it.
        if supervisor.reseat(&self.name, start).is_ok() {
            (self.job, self.astray) = (None, None);
            self.note_anew(supervisor);
            self.note(supervisor, MAP, map);
        }
    }

    /// Takes a visualization message. It does not name an order, so it counts only on the stretch of the newest state.
    ///
    /// # Errors
    /// [`Refusal`] for an invalid message, which has no effect.
    pub fn visualization(
        &mut self,
        supervisor: &mut Supervisor,
        bytes: &[u8],
        limits: Limits,
        is_third: bool,
        now: f64,
    ) -> Result<(), Refusal> {
        let message: Visualization = door::read(bytes, limits)?;
        // Schema 2.0 does not require a header.
        if message.header != Header::default() {
            message.header.check(&self.profile.key, is_third)?;
        }
        let is_after = self.newest.get(&Kind::State).is_some_and(|state| state.is_before(&message.header, now));
        let newest = self.newest.entry(Kind::Visualization).or_default();
        if !is_after || newest.take(&message.header, now, |_| false) == Place::Late {
            return Ok(());
        }
        if let Some(mut state) = self.state.as_deref().cloned() {
            let has_it = self.job.as_ref().is_some_and(|job| job.held.order_id == state.order_id);
            (state.agv_position, state.mobile_robot_position) = (message.agv_position, message.mobile_robot_position);
            // It may have passed the next node since: no alarm.
            if has_it {
                return self.locate(supervisor, &state, With::Between, now);
            }
        }
        Ok(())
    }
}

/// The place of the way nearest to a point, between two lengths.
fn nearest(job: &Job, [lo, hi]: [f64; 2], [x, y]: [f64; 2]) -> Start {
    /// Places that are compared.
    const PLACES: u32 = 256;
    let places = (0..=PLACES).map(|k| job.way.pose(lo + (hi - lo) * f64::from(k) / f64::from(PLACES)));
    let off = |place: &Start| (place.x - x).hypot(place.y - y);
    places.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or_else(|| job.way.pose(lo))
}
