//! Updates for the vehicle: its base ends where the supervisor allows.

use super::VehicleAdapter;
use super::job::{ActiveOrder, ReleasePoint, SentUpdate};
use crate::robot::SupervisedRobot;
use crate::supervisor::Supervisor;
use pcr_formats::vda5050::header::MessageHeader;
use pcr_formats::vda5050::order::Order;
use pcr_formats::vda5050::topics::TopicKind;
use pcr_formats::vda5050::version::ProtocolVersion;

/// Time between two attempts to send the same \[s\].
pub(super) const AGAIN: f64 = 1.0;

/// The same for what the vehicle refuses.
const REFUSED: f64 = 5.0;

/// A hold that is lower than a node by at most this counts as at the node \[m\], or by less, where points of an outline go further than its path. Discs are larger by more than this: by the part of the
/// margin (`TOLERANCE`) that no vehicle may use.
const ROUNDING: f64 = 1e-4;

/// Shortest part of an edge that is released alone \[m\].
const PART: f64 = 0.05;

/// Largest number of nodes that are sent to a vehicle ahead: it does not need all of a long order.
const AHEAD: usize = 60;

impl VehicleAdapter {
    /// Sends the vehicle its next update, according to what the supervisor has granted.
    pub fn release(&mut self, supervisor: &mut Supervisor, now: f64) {
        let Some(version) = self.version.filter(|_| !self.is_away) else { return };
        self.follow_cancel(now);
        let (Some(state), Ok(robot)) = (&self.state, supervisor.robot(&self.name)) else { return };
        let Some(job) = &mut self.job else { return };
        // Not `told`: after a restart that is the hold that the vehicle may have been told, which is kept free for it but may
        // not be granted.
        let allowed = robot.granted;
        // A vehicle that is not where it may be is not sent further, nor does it get again what it has not confirmed. Its first order leads it
        // to its way; it judges itself whether it can come there.
        let is_held = robot.stopped.is_some() || robot.alarm.is_some() && job.sent.is_some();
        if job.cancel.is_some() || job.lost_at.is_some() || is_held {
            return;
        }
        // What the vehicle has had must not reach it again as a new order.
        let is_gone = job.was_there() && state.order_id != job.order.order_id;
        if !job.is_acknowledged() {
            if is_gone && job.sent.is_some_and(|sent| sent.update == 0) {
                return;
            }
            // The vehicle has an older update, or none: the same one is sent again.
            let pause = if job.refused.is_some() { REFUSED } else { AGAIN };
            if now - job.sent_at >= pause {
                job.sent_at = now;
                self.send(version);
            }
            return;
        }
        let is_first = job.sent.is_none();
        // With its first order the vehicle goes to its first node.
        let Some(offset) = job.offset(robot) else { return };
        let may_begin = allowed + offset + rounding(robot) >= job.last().length;
        if is_first && !(may_begin && state.node_states.is_empty()) {
            return;
        }
        let next = job.next(robot, allowed, self.profile.split);
        let stop = job.stop_after(robot, next.last().copied(), self.profile.split);
        if let Some(stop) = stop.filter(|stop| *stop != robot.next) {
            let _ = supervisor.stops_at(&self.name, stop);
        }
        if next.is_empty() && (is_gone || !job.changed) {
            return;
        }
        let update = job.sent.map_or(0, |sent| sent.update + 1);
        let from = job.stops.len().saturating_sub(1);
        job.stops.extend_from_slice(&next);
        job.sent = Some(SentUpdate { update, manager: job.order.update_id, from });
        (job.sent_at, job.changed) = (now, false);
        let sent = job.sent;
        self.note_more(supervisor, "stops", &next);
        self.note(supervisor, "sent", sent);
        self.send(version);
    }

    pub(super) fn send(&mut self, version: ProtocolVersion) {
        let deviation = self.deviation();
        let header = self.header(TopicKind::Order, version);
        let Some(job) = &self.job else { return };
        let Some(sent) = job.sent else { return };
        let message = job.written(header, sent, deviation);
        self.post(super::Recipient::Vehicle, TopicKind::Order, version, &message);
    }
}

/// The same on the path of a robot \[m\].
fn rounding(robot: &SupervisedRobot) -> f64 {
    ROUNDING / robot.course.stretch(robot.spread())
}

impl ActiveOrder {
    /// The stops up to the granted length that have not been sent; empty if there are none.
    fn next(&self, robot: &SupervisedRobot, allowed: f64, split: bool) -> Vec<ReleasePoint> {
        let Some(offset) = self.offset(robot) else { return Vec::new() };
        let planned = self.planned(robot);
        let hold = allowed + offset;
        let last = self.last();
        let mut stops = Vec::new();
        let mut sequence = last.sequence;
        let mut push = |stops: &mut Vec<ReleasePoint>, length, node, between| {
            sequence += 2;
            let from = stops.last().map_or(last.length, |stop| stop.length);
            stops.push(ReleasePoint { sequence, length, node, between, speed: self.limit_between(from, length) });
        };
        let mut reached = last.node;
        for node in last.node + 1..=planned {
            let Some(length) = self.path.node(node).filter(|length| *length <= hold + rounding(robot)) else { break };
            push(&mut stops, length, node, false);
            reached = node;
        }
        // A stop in the middle of an edge is used only if the vehicle would otherwise brake.
        let from = stops.last().map_or(last.length, |stop| stop.length);
        let is_short = from - (robot.up_to + offset) < 2.0 * robot.abilities.braking() + 2.0 * robot.abilities.speed;
        let next = self.path.node(reached + 1).filter(|_| reached < planned);
        // It has to come out of its turns first.
        let turned = self.path.departure(reached).unwrap_or(from).max(from);
        if split && is_short && self.can_split(reached) && next.is_some() && hold - turned >= PART {
            push(&mut stops, hold, reached, true);
        }
        stops
    }

    /// Length of the supervisor's path at which the vehicle can stop next after a stop, if it can stop at nodes only \[m\].
    fn stop_after(&self, robot: &SupervisedRobot, stop: Option<ReleasePoint>, split: bool) -> Option<f64> {
        let node = stop.unwrap_or(self.last()).node;
        let is_free = split && self.can_split(node);
        let next = self.path.node(node + 1).filter(|_| !is_free && node < self.planned(robot))?;
        Some(next - self.offset(robot)?)
    }

    /// An update from its first stop on: released up to the last stop, then the horizon.
    fn written(&self, header: MessageHeader, sent: SentUpdate, deviation: f64) -> Order {
        let mut stops: Vec<ReleasePoint> = self.stops.iter().skip(sent.from).copied().collect();
        let (base, mut last) = (stops.len(), self.last());
        for node in (last.node + 1..self.order.nodes.len()).take(AHEAD) {
            last = ReleasePoint {
                sequence: last.sequence + 2,
                length: self.path.node(node).unwrap_or(last.length),
                node,
                between: false,
                speed: None,
            };
            stops.push(last);
        }
        let nodes = stops.iter().enumerate().filter_map(|(k, stop)| self.node(*stop, deviation, k < base));
        let pairs = stops.windows(2).enumerate();
        let edges = pairs.filter_map(|(k, pair)| self.edge([pair[0], pair[1]], k + 1 < base));
        let (order_id, rest) = (self.order.order_id.clone(), self.order.rest.clone());
        Order { header, order_id, order_update_id: sent.update, nodes: nodes.collect(), edges: edges.collect(), rest }
    }
}
