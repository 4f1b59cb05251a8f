//! Orders that end before they are done: cancelled, refused, dropped or lost by the vehicle.
//!
//! The way of such an order becomes free only when the vehicle stands and can take nothing more of the order. Orders and the actions that
//! cancel them have different topics, so either may come first: an update that the vehicle has not shown may come after it has
//! reported the order as cancelled. No message is later than [`LATEST`]. So while the vehicle has not shown the last update, the order is
//! over only after another `cancelOrder`, sent that long after the update, is answered and the vehicle stands. If it takes the update
//! meanwhile, it shows that, and is cancelled again. A first order that the vehicle refuses has reached it: only another copy of what it
//! refuses may still come, and [`REFUSED`] is enough for that.

use super::job::Cancellation;
use super::map_check::{MAP, map_of};
use super::recency::LATEST;
use super::refused_orders::TRIED;
use super::release::AGAIN;
use super::{ActiveOrder, VehicleAdapter};
use crate::owned_path::StartPose;
use crate::supervisor::Supervisor;
use pcr_formats::vda5050::order_state::RejectedOrder;
use pcr_formats::vda5050::state::State;
use pcr_formats::vda5050::version::OrderRejection;

/// Number of successive states, and time \[s\], after which a vehicle that contradicts its order has lost it or was moved.
const ASTRAY: (u32, f64) = (3, 2.0);

/// Time for which a vehicle that has lost its order keeps its right of way \[s\]: another order may follow the same way.
pub(super) const KEPT: f64 = 30.0;

/// Time for which the way of a first order that the vehicle refuses is kept after its last copy was sent \[s\].
const REFUSED: f64 = 20.0;

impl VehicleAdapter {
    /// Whether the vehicle stands and has nothing to do.
    pub(super) fn is_still(&self, state: &State) -> bool {
        !state.driving && state.node_states.iter().all(|node| !node.released)
    }

    /// Ends an order that was cancelled, or that the vehicle has lost.
    pub(super) fn finish(&mut self, supervisor: &mut Supervisor, now: f64) {
        let Some(state) = self.state.clone() else { return };
        let Ok(robot) = supervisor.robot(&self.name) else { return };
        let is_off = robot.alarm.is_some();
        // An outline may have turned where its order has ended, for an action, or was turned by hand.
        let has_turned = is_off && self.profile.abilities.footprint.is_some() && self.is_free(supervisor);
        let is_over = |job: &&ActiveOrder| has_turned && job.cancel.is_none();
        let Some(job) = self.job.as_ref().filter(|job| !is_over(job)) else {
            // It was moved by hand, or to another map: its reported position counts.
            let map = state.position().map(|pose| pose.map_id.as_str());
            let is_elsewhere = map_of(robot).is_some_and(|known| map.is_some_and(|map| known != map));
            if self.stays_astray((is_off || is_elsewhere) && self.is_still(&state), now) {
                self.reseat(supervisor, &state);
            }
            return;
        };
        if job.cancel.is_some() {
            return self.finish_cancelled(supervisor, &state, now);
        }
        if !job.was_there() && job.refused.is_some_and(|since| now - since >= TRIED) {
            return self.cancel_again(supervisor, now);
        }
        let has_it = job.order.order_id == state.order_id;
        let is_gone = job.was_there() && (!has_it || job.is_dropped(&state)) && self.is_still(&state);
        // An update may still follow an order that it names.
        let may_follow = has_it && job.is_due(&state);
        let is_astray = self.stays_astray(is_gone, now);
        let Some(job) = &mut self.job else { return };
        if has_it && !is_gone {
            job.lost_at = None;
        }
        if !is_astray {
            return;
        }
        let is_first = job.lost_at.is_none();
        let since = *job.lost_at.get_or_insert(now);
        let kept = if may_follow { LATEST } else { KEPT };
        // Its manager sends it on, or it has stood there for some time without an order.
        if is_off && !may_follow || !is_first && now - since > kept {
            self.reseat(supervisor, &state);
            if self.job.is_none() {
                // It may have the order all the same, and not say so.
                self.ask_for("cancelOrder");
            }
        }
    }

    fn finish_cancelled(&mut self, supervisor: &mut Supervisor, state: &State, now: f64) {
        // After a restart nobody knows when it was sent.
        if let Some(job) = self.job.as_mut().filter(|job| job.sent_at == f64::NEG_INFINITY) {
            job.sent_at = now;
        }
        let Some(job) = &self.job else { return };
        let (has_it, is_still) = (job.order.order_id == state.order_id, self.is_still(state));
        if job.sent.is_none() {
            let why = "it was cancelled before the vehicle got it: nothing of it is carried out";
            let (order, update) = (job.order.order_id.clone(), job.order.update_id);
            self.reject(&RejectedOrder::new(OrderRejection::Order, "orderId", why), &order, update);
            return self.reseat(supervisor, state);
        }
        if job.lost_at.is_some() && !has_it {
            return self.reseat(supervisor, state);
        }
        if job.was_there() && !has_it {
            // It has lost the order before it was cancelled, and does not get it again.
            if self.stays_astray(is_still, now) {
                self.reseat(supervisor, state);
            }
            return;
        }
        let Some(Cancellation { action, first_at: since, last_at: last }) = job.cancel.clone() else { return };
        let status = state.action(&action);
        let is_failed = status == Some("FAILED");
        if !is_failed && status != Some("FINISHED") || now - since < LATEST && self.is_cancelling(state) {
            return;
        }
        let latest = if job.refused.is_some() && !job.was_there() { REFUSED } else { LATEST };
        let waits = state.node_states.iter().any(|node| node.released) || is_failed && !state.node_states.is_empty();
        if has_it && waits {
            // The cancellation came before the order, or before the update.
            if now - last >= AGAIN {
                self.cancel_again(supervisor, now);
            }
        } else if is_still && job.is_due(state) && since - job.sent_at < latest {
            if now - job.sent_at >= latest {
                self.cancel_again(supervisor, now);
            }
        } else if !(is_failed && self.is_free(supervisor)) {
            self.reseat(supervisor, state);
        }
    }

    fn stays_astray(&mut self, is_astray: bool, now: f64) -> bool {
        let (count, since) = self.astray.unwrap_or((0, now));
        self.astray = is_astray.then_some((count + 1, since));
        is_astray && count + 1 >= ASTRAY.0 && now - since >= ASTRAY.1
    }

    /// Sets the vehicle to its reported position, without an order: all its rights are void. This has no effect while it may move.
    pub(super) fn reseat(&mut self, supervisor: &mut Supervisor, state: &State) {
        if !self.is_still(state) {
            return;
        }
        let Some(pose) = state.position().filter(|pose| pose.is_known() && self.remaining_margin(pose) >= 0.0) else {
            return;
        };
        let map = pose.map_id.clone();
        // On its way it is as far off as before, and not farther by the error of this position.
        let on_way = self.job.as_ref().zip(supervisor.robot(&self.name).ok()).and_then(|(job, robot)| {
            let within = self.on_its_way(job, robot, pose).filter(|_| robot.alarm.is_none())?;
            let there = nearest(job, within, [pose.x, pose.y]);
            // It may be anywhere in a turn.
            Some(if job.path.spread() > 0.0 { StartPose { heading: pose.theta, ..there } } else { there })
        });
        let start = on_way.unwrap_or(StartPose { x: pose.x, y: pose.y, heading: pose.theta });
        if self.shares(supervisor, &map).is_err() {
            return;
        }
        // If it cannot stand there, its former place is kept, so that no other vehicle drives through it.
        if supervisor.reseat(&self.name, start).is_ok() {
            self.keep_unsent(state);
            (self.job, self.astray) = (None, None);
            self.note_anew(supervisor);
            self.note(supervisor, MAP, map);
        }
    }
}

/// The place of the way nearest to a point, between two lengths.
fn nearest(job: &ActiveOrder, [lo, hi]: [f64; 2], [x, y]: [f64; 2]) -> StartPose {
    /// Places that are compared.
    const PLACES: u32 = 256;
    let places = (0..=PLACES).map(|k| job.path.pose(lo + (hi - lo) * f64::from(k) / f64::from(PLACES)));
    let off = |place: &StartPose| (place.x - x).hypot(place.y - y);
    places.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or_else(|| job.path.pose(lo))
}
