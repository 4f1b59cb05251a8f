//! Messages of the vehicle.

use super::interim::Interim;
use super::job::RECEIVED;
use super::map_check::{MAP, map_of};
use super::order_termination::KEPT;
use super::recency::{Recency, RecencyFilter};
use super::{ActiveOrder, DOUBTFUL, VehicleAdapter};
use crate::owned_path::StartPose;
use crate::request_error::RequestError;
use crate::robot::{BACK, SupervisedRobot};
use crate::supervisor::{PositionReport, Supervisor};
use pcr_formats::vda5050::decode::{self, DecodeError, MessageLimits};
use pcr_formats::vda5050::header::MessageHeader;
use pcr_formats::vda5050::messages::Visualization;
use pcr_formats::vda5050::state::{ActionState, State, VehiclePosition};
use pcr_formats::vda5050::topics::TopicKind;
use serde_json::Value;
use std::sync::Arc;

/// Least time by which a late message counts as older than the newest one, and largest age that is passed on \[s\]: the supervisor
/// refuses larger ages.
const LATE: f64 = 1e-3;
const OLDEST: f64 = 1e6;

/// The action of its order that a standing vehicle carries out, in words.
fn action_under_way(state: &State) -> Option<String> {
    let is_under_way = |action: &&ActionState| {
        matches!(action.action_status.as_str(), "INITIALIZING" | "RUNNING" | "PAUSED" | "RETRIABLE")
    };
    let action = state.action_states.iter().find(is_under_way).filter(|_| !state.driving)?;
    let kind = action.rest.get("actionType").and_then(Value::as_str).unwrap_or("an action");
    Some(format!("carries out {kind} ({}, {})", action.action_id, action.action_status))
}

/// The kind of message with a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PositionSource {
    /// The newest state.
    Newest,
    /// A message between states, after the newest one.
    Between,
    /// A state that was written before the newest one.
    Late,
    /// The newest state, but it was not written after a visualization that has counted: its place neither begins nor ends an alarm.
    Overtaken,
    /// The newest state, perhaps written before the supervisor was started: it ends no alarm, and a vehicle seated by it is in doubt.
    Doubtful,
}

impl VehicleAdapter {
    /// Takes a state.
    ///
    /// # Errors
    /// [`DecodeError`] for an invalid state, which has no effect.
    pub fn state(
        &mut self,
        supervisor: &mut Supervisor,
        bytes: &[u8],
        limits: MessageLimits,
        is_third: bool,
        now: f64,
    ) -> Result<(), DecodeError> {
        let state: State = decode::read(bytes, limits)?;
        let version = state.header.check(&self.profile.key, is_third)?;
        self.follow_absence(supervisor);
        let newest = self.newest.entry(TopicKind::State).or_default();
        let place = newest.take(&state.header, now, |action| state.names(action));
        if newest.is_in_doubt(now) {
            self.ask_when(now);
        }
        if place == Recency::Anew {
            // Its clock may have restarted.
            self.newest.remove(&TopicKind::Visualization);
            self.newest.remove(&TopicKind::Factsheet);
            self.interim = Interim::default();
            self.ask_for("factsheetRequest");
        }
        let is_new = place != Recency::Late;
        if is_new {
            self.version = Some(version);
        }
        self.acknowledge(supervisor, &state, now);
        if let Some(job) = self.job.as_mut().filter(|_| is_new) {
            job.refused = job.is_refused(&state).then(|| job.refused.unwrap_or(now));
        }
        let is_proven = self.is_proven();
        let overtaken = self.interim.overtook(&state.header, now, |action| state.names(action));
        let with = match (is_new, is_proven, overtaken) {
            (true, true, Some(_)) => PositionSource::Overtaken,
            (true, true, None) => PositionSource::Newest,
            (true, false, _) => PositionSource::Doubtful,
            (false, ..) => PositionSource::Late,
        };
        let located = self.locate(supervisor, &state, with, now);
        if is_new && is_proven && self.is_doubtful {
            self.doubts(supervisor, false);
        }
        if is_new {
            supervisor.set_doing(&self.name, action_under_way(&state));
            if is_proven {
                self.follow_zone_sets(supervisor, &state);
            }
            self.state = Some(Arc::new(state));
            if is_proven {
                self.heard_at = overtaken.unwrap_or(now);
                self.finish(supervisor, now);
            }
            self.take_early(supervisor, now);
            self.mirror();
        }
        located
    }

    /// Whether the place of the vehicle may be one from before the start; nobody is released anything then.
    fn doubts(&mut self, supervisor: &mut Supervisor, is_doubtful: bool) {
        self.is_doubtful = is_doubtful;
        self.note(supervisor, DOUBTFUL, is_doubtful);
    }

    /// Whether the newest state was certainly written after the supervisor was started.
    fn is_proven(&self) -> bool {
        self.newest.get(&TopicKind::State).is_some_and(RecencyFilter::is_proven)
    }

    /// Requests a state that is certainly newer than all states so far, if that is in doubt.
    /// Returns the id of the request.
    pub(crate) fn ask_when(&mut self, now: f64) -> String {
        let id = self.ask_for("stateRequest");
        self.newest.entry(TopicKind::State).or_default().asks(id.clone(), now);
        id
    }

    /// Takes the order update id of a state as a confirmation. The first state of an order may still have the last node of the order
    /// before, and no nodes ahead, as if all of it were done. So the first confirmation has nodes ahead, or nothing that could have been
    /// passed, or the vehicle has said the same for [`KEPT`]: then its states on the way were lost.
    fn acknowledge(&mut self, supervisor: &mut Supervisor, state: &State, now: f64) {
        let Some(job) = self.job.as_mut().filter(|job| job.order.order_id == state.order_id) else { return };
        let Some(sent) = job.sent else { return };
        let (update, before) = (state.order_update_id, job.received);
        job.received.named = true;
        let has_it = update == sent.update && state.base() == job.last().sequence;
        let is_certain = job.is_confirmed() || !state.node_states.is_empty() || job.stops.len() == 1;
        job.reported_complete_at =
            (has_it && !is_certain && !state.driving).then(|| job.reported_complete_at.unwrap_or(now));
        if has_it && (is_certain || job.reported_complete_at.is_some_and(|since| now - since > KEPT)) {
            job.received.acknowledged = Some((update, sent.manager));
        }
        let received = job.received;
        if received != before {
            self.note(supervisor, RECEIVED, received);
        }
    }

    /// Takes it that the vehicle is off its path, unless a newer visualization says where it is.
    fn strays(&mut self, supervisor: &mut Supervisor, at: [f64; 2], with: PositionSource, now: f64) {
        if with != PositionSource::Overtaken {
            // The place is finite, and the robot is there: this cannot be refused.
            let _ = supervisor.report_off_path(&self.name, at, 0.0, now);
        } else if self.interim.contradicts(now) {
            let id = self.ask_when(now);
            self.interim.asks(id, now);
        }
    }

    /// Takes the position of the vehicle, as far as it is certain.
    ///
    /// # Errors
    /// [`DecodeError`] for a position on another map.
    fn locate(
        &mut self,
        supervisor: &mut Supervisor,
        state: &State,
        with: PositionSource,
        now: f64,
    ) -> Result<(), DecodeError> {
        let Some(pose) = state.position().filter(|pose| pose.is_known()) else { return Ok(()) };
        let (at, is_new) = ([pose.x, pose.y], matches!(with, PositionSource::Newest | PositionSource::Overtaken));
        // What is doubtful may begin an alarm, but changes none.
        let has_alarm = supervisor.robot(&self.name).is_ok_and(|robot| robot.alarm.is_some());
        let alarms = is_new || with == PositionSource::Doubtful && !has_alarm;
        if supervisor.is_away(&self.name) && with != PositionSource::Late {
            self.shares(supervisor, &pose.map_id)?;
            self.comes_back(supervisor, pose, self.is_still(state), with, now);
        }
        let Ok(robot) = supervisor.robot(&self.name) else {
            if alarms && self.is_still(state) && self.remaining_margin(pose) >= 0.0 {
                self.shares(supervisor, &pose.map_id)?;
                let start = StartPose { x: pose.x, y: pose.y, heading: pose.theta };
                // If it cannot stand there, the next state is tried again.
                let _ = self.seat(supervisor, start, &pose.map_id, with);
            }
            return Ok(());
        };
        if let Some(map) = map_of(robot).filter(|map| *map != pose.map_id) {
            let why = format!("{:?}; what is known of it is on {map:?}", pose.map_id);
            return Err(DecodeError::new("position.mapId", why));
        }
        if is_new {
            self.elsewhere = None;
        }
        // On a mission that is none of its order, nobody knows what its lengths mean.
        if self.job.as_ref().is_some_and(|job| job.offset(robot).is_none()) {
            return Ok(());
        }
        let offset = self.job.as_ref().and_then(|job| job.offset(robot)).unwrap_or_default();
        let reach = self.remaining_margin(pose);
        let (path, end) = (robot.path, robot.course.length());
        let back = robot.arc_length - 2.0 * self.deviation() - BACK;
        let is_of_order = self.job.as_ref().is_some_and(|job| job.order.order_id == state.order_id);
        let found = match &self.job {
            Some(job) if job.order.order_id == state.order_id => {
                let Some(place) = job.passed(state) else {
                    // The vehicle names a node that was not released, a node of an earlier order, or none, or one that it has ahead. If its
                    // position is on its path anyway, this is not an alarm.
                    if alarms && self.on_its_way(job, robot, pose).is_none() {
                        self.strays(supervisor, at, with, now);
                    }
                    return Ok(());
                };
                let from = job.stops[place].length;
                let to = job.stops.get(place + 1).map_or(from, |next| next.length);
                // Vehicles report a node as passed when they are near it, so the search begins before the node.
                let near = job.path.near(pose, [from - reach.max(0.0), to], reach, robot.any_heading);
                near.map(|lengths| lengths.map(|length| (length - offset).clamp(0.0, end)))
            }
            _ if !alarms => return Ok(()),
            Some(job) if job.was_there() => {
                self.on_its_way(job, robot, pose).map(|lengths| lengths.map(|length| (length - offset).clamp(0.0, end)))
            }
            Some(job) => {
                let start = (0.0 - offset).clamp(0.0, end);
                job.path.near(pose, [0.0, 0.0], reach, robot.any_heading).map(|_| [start; 2])
            }
            None => {
                let there = robot.course.pose(end);
                let turned = 2.0 * (0.5 * (pose.theta - there.heading)).sin().abs();
                let off = (there.x - at[0]).hypot(there.y - at[1]) + robot.spread() * turned;
                (off <= reach).then_some([end; 2])
            }
        };
        match found {
            // The vehicle rolled or was pushed back into a part of its path that may already be free for others.
            Some([_, hi]) if alarms && hi < back => self.strays(supervisor, at, with, now),
            // It may have passed the next node since, and be on its way back: this neither begins nor ends an alarm.
            Some([_, hi]) if with == PositionSource::Between && hi < back => {}
            // It may be a place from before the order.
            Some(_) if with == PositionSource::Doubtful && !is_of_order => {}
            Some(at) => {
                // Older than the newest message that is certain, by an unknown time.
                let newer = match with {
                    PositionSource::Newest | PositionSource::Between => None,
                    PositionSource::Overtaken => self.interim.overtook(&state.header, now, |_| false),
                    PositionSource::Late | PositionSource::Doubtful => Some(self.heard_at),
                };
                let age = newer.map_or(0.0, |newer| (now - newer).max(0.0) + LATE);
                if with == PositionSource::Between {
                    self.interim.take(&state.header, now);
                } else if is_new {
                    self.interim.agrees();
                }
                // Path and interval are valid, so this cannot be refused.
                let _ = supervisor
                    .position(&PositionReport { robot: self.name.clone(), path, at, age: age.min(OLDEST) }, now);
            }
            None if alarms => self.strays(supervisor, at, with, now),
            None => {}
        }
        Ok(())
    }

    /// Adds the vehicle to the supervisor where it stands. An order that it had is void.
    ///
    /// # Errors
    /// [`RequestError`] if it cannot stand there.
    pub(super) fn seat(
        &mut self,
        supervisor: &mut Supervisor,
        start: StartPose,
        map: &str,
        with: PositionSource,
    ) -> Result<(), RequestError> {
        supervisor.add(&self.name, self.profile.abilities.clone(), start)?;
        (self.job, self.astray, self.unsent) = (None, None, None);
        self.note_anew(supervisor);
        self.note(supervisor, MAP, map);
        self.doubts(supervisor, with == PositionSource::Doubtful);
        Ok(())
    }

    /// Lengths at which a vehicle that does not confirm its order is on its way, between its last position and its hold.
    pub(super) fn on_its_way(
        &self,
        job: &ActiveOrder,
        robot: &SupervisedRobot,
        pose: &VehiclePosition,
    ) -> Option<[f64; 2]> {
        let (offset, reach) = (job.offset(robot)?, self.remaining_margin(pose));
        let window = [robot.arc_length + offset - reach.max(0.0), robot.notified_limit + offset];
        job.path.near(pose, window, reach, robot.any_heading)
    }

    /// Part of the margin that is left for being off the path \[m\].
    pub(super) fn remaining_margin(&self, pose: &VehiclePosition) -> f64 {
        self.deviation() - pose.deviation_range.unwrap_or(0.0)
    }

    /// Takes a visualization message. It does not name an order, so it counts only on the stretch of the newest state.
    ///
    /// # Errors
    /// [`DecodeError`] for an invalid message, which has no effect.
    pub fn visualization(
        &mut self,
        supervisor: &mut Supervisor,
        bytes: &[u8],
        limits: MessageLimits,
        is_third: bool,
        now: f64,
    ) -> Result<(), DecodeError> {
        let message: Visualization = decode::read(bytes, limits)?;
        // Schema 2.0 does not require a header.
        if message.header != MessageHeader::default() {
            message.header.check(&self.profile.key, is_third)?;
        }
        let lead = self.newest.get(&TopicKind::State).and_then(|state| state.lead(&message.header, now));
        let Some(lead) = lead.filter(|lead| *lead >= 0.0 && self.is_proven()) else { return Ok(()) };
        if self.newest.entry(TopicKind::Visualization).or_default().take(&message.header, now, |_| false)
            == Recency::Late
        {
            return Ok(());
        }
        // One of the same time as the state may be the older one of the two: what the state says of an alarm counts.
        let has_alarm = supervisor.robot(&self.name).is_ok_and(|robot| robot.alarm.is_some());
        if has_alarm && lead == 0.0 {
            return Ok(());
        }
        if let Some(mut state) = self.state.as_deref().cloned() {
            let has_it = self.job.as_ref().is_some_and(|job| job.order.order_id == state.order_id);
            state.header = message.header;
            (state.agv_position, state.mobile_robot_position) = (message.agv_position, message.mobile_robot_position);
            // It may have passed the next node since: no alarm.
            if has_it {
                return self.locate(supervisor, &state, PositionSource::Between, now);
            }
        }
        Ok(())
    }
}
