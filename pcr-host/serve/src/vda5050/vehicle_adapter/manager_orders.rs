//! Orders of the fleet manager.

use super::super::order_path::{OrderPath, TOLERANCE};
use super::VehicleAdapter;
use super::job::{ActiveOrder, BEGINS, RECEIVED, mission};
use super::map_check::map_of;
use super::recency::LATEST;
use crate::supervisor::{AdmissionResult, MissionRequest, Supervisor};
use pcr_formats::vda5050::decode::{self, DecodeError, MessageLimits};
use pcr_formats::vda5050::order::Order;
use pcr_formats::vda5050::order_state::{OrderState, RejectedOrder, UpdateResult};
use pcr_formats::vda5050::state::ErrorEntry;
use pcr_formats::vda5050::version::{OrderRejection, ProtocolVersion};

/// Largest number of orders and updates that wait for the first state of a vehicle after a restart.
const EARLY: usize = 8;

impl VehicleAdapter {
    /// Takes an order or an update of the manager; an error is reported to the manager.
    pub fn order(
        &mut self,
        supervisor: &mut Supervisor,
        bytes: &[u8],
        limits: MessageLimits,
        is_third: bool,
        now: f64,
    ) {
        let (mut id, mut update) = (String::new(), 0);
        let taken = decode::read::<Order>(bytes, limits).map_err(RejectedOrder::from).and_then(|order| {
            (id, update) = (order.order_id.clone(), order.order_update_id);
            self.take(supervisor, order, is_third, now)
        });
        match taken {
            Ok(true) => self.errors.clear(),
            Ok(false) => {}
            Err(rejected) => self.reject(&rejected, &id, update),
        }
        self.mirror();
    }

    /// Reports to the manager why an order is rejected.
    pub(super) fn reject(&mut self, rejected: &RejectedOrder, order: &str, update: u64) {
        let Some(version) = self.version else { return };
        self.complain(rejected.report(version, order, update));
    }

    /// Reports an error to the manager, until an order is taken.
    pub(super) fn complain(&mut self, error: ErrorEntry) {
        /// Largest number of errors that are kept.
        const MOST: usize = 10;
        if !self.errors.contains(&error) {
            self.errors.push(error);
            if self.errors.len() > MOST {
                self.errors.remove(0);
            }
        }
    }

    /// Takes an order; returns whether it was new.
    fn take(
        &mut self,
        supervisor: &mut Supervisor,
        order: Order,
        is_third: bool,
        now: f64,
    ) -> Result<bool, RejectedOrder> {
        let version = order.header.check(&self.profile.key, is_third)?;
        if self.version.is_some_and(|own| own.major() != version.major()) {
            return Err(DecodeError::new("version", "not that of the vehicle").into());
        }
        if supervisor.is_away(&self.name) {
            return Err(RejectedOrder::new(OrderRejection::Order, "", "the vehicle is away"));
        }
        self.passable(supervisor, &order)?;
        if supervisor.robot(&self.name).is_err() {
            return Err(RejectedOrder::new(OrderRejection::Order, "", "the vehicle has not yet said where it stands"));
        }
        let is_its = self.job.as_ref().is_some_and(|job| job.order.order_id == order.order_id);
        if !is_its && self.orders.contains(&order.order_id) {
            return Err(was_there());
        }
        match &self.job {
            Some(_) if is_its => self.extend(supervisor, order, now),
            Some(_) if self.state.is_none() && self.early.len() < EARLY => {
                self.early.push((order, is_third));
                Ok(false)
            }
            Some(job) if job.lost_at.is_some() => self.begin_anew(supervisor, order, version, now),
            Some(_) if !self.is_free(supervisor) => Err(RejectedOrder::new(
                OrderRejection::Order,
                "orderId",
                "the vehicle has another order that is not finished",
            )),
            _ => self.begin(supervisor, order, version, now),
        }
    }

    /// Takes the orders that came before the first state of the vehicle.
    pub(super) fn take_early(&mut self, supervisor: &mut Supervisor, now: f64) {
        for (order, is_third) in std::mem::take(&mut self.early) {
            let (id, update) = (order.order_id.clone(), order.order_update_id);
            match self.take(supervisor, order, is_third, now) {
                Ok(_) => self.errors.clear(),
                Err(rejected) => self.reject(&rejected, &id, update),
            }
        }
    }

    /// Whether the vehicle has completed its order.
    pub(super) fn is_free(&self, supervisor: &Supervisor) -> bool {
        let (Some(job), Some(state), Ok(robot)) = (&self.job, &self.state, supervisor.robot(&self.name)) else {
            return self.job.is_none();
        };
        job.is_acknowledged()
            && robot.waiting.is_none()
            && job.planned(robot) == job.order.base
            && job.order.nodes.len() == job.order.base + 1
            && job.last().node == job.order.base
            && !job.last().between
            && state.order_id == job.order.order_id
            && job.passed(state) == job.stops.len().checked_sub(1)
            && state.is_idle()
    }

    /// Rejects an order that leads against a one-way zone, or from map to map, or that has a deviation which is none.
    fn passable(&self, supervisor: &Supervisor, order: &Order) -> Result<(), RejectedOrder> {
        self.zones.check(order)?;
        for (k, node) in order.nodes.iter().enumerate() {
            let position = node.node_position.as_ref();
            position.map_or(Ok(None), |position| position.deviation()).map_err(|refusal| {
                DecodeError::new(format!("nodes[{k}].nodePosition.{}", refusal.field), refusal.why)
            })?;
        }
        let maps = order.nodes.iter().filter_map(|node| node.node_position.as_ref()).map(|position| &position.map_id);
        let here = self.state.as_ref().and_then(|state| state.position()).map(|pose| pose.map_id.as_str());
        // After a restart it is known before the vehicle sends a message.
        let known = supervisor.robot(&self.name).ok().and_then(map_of);
        let mut all = maps.map(String::as_str).chain(here).chain(known);
        let first = all.next();
        if all.any(|map| Some(map) != first) {
            return Err(RejectedOrder::new(
                OrderRejection::Order,
                "nodes",
                "from map to map: there are no common coordinates",
            ));
        }
        Ok(())
    }

    fn begin(
        &mut self,
        supervisor: &mut Supervisor,
        order: Order,
        version: ProtocolVersion,
        now: f64,
    ) -> Result<bool, RejectedOrder> {
        let robot =
            supervisor.robot(&self.name).map_err(|fault| RejectedOrder::new(OrderRejection::Order, "", fault))?;
        let course = &robot.course;
        let start =
            course.arrival(course.length()).map_err(|fault| RejectedOrder::new(OrderRejection::Order, "", fault))?;
        let held = OrderState::new(order)?;
        let mut way = OrderPath::new(start, &held, self.profile.abilities.spread())
            .map_err(|refusal| RejectedOrder { error: OrderRejection::Order, refusal })?;
        // Where its heading was not known until now, only its own word tells how it stands.
        let theta = self.state.as_ref().and_then(|state| state.position()).map(|pose| pose.theta);
        let turned = theta.map_or(f64::INFINITY, |theta| way.moved_by(theta - start.heading));
        if way.spread() > 0.0 && turned > self.deviation() && (theta.is_some() || robot.any_heading) {
            way.starts_turned("it does not stand as its path has led it".into());
        }
        let begins = way.node(0).unwrap_or(0.0);
        if begins > BEGINS {
            return Err(RejectedOrder::new(
                OrderRejection::Order,
                "nodes[0].nodePosition",
                format!("{begins:.3} m from the vehicle"),
            ));
        }
        let mut job = ActiveOrder::new(held, way, version.text().into());
        self.ask(supervisor, &mut job, None, now)?;
        self.has(supervisor, job);
        Ok(true)
    }

    /// Gives the vehicle this order.
    fn has(&mut self, supervisor: &mut Supervisor, job: ActiveOrder) {
        self.drop_unsent(supervisor);
        let noted = self.orders.push(&job.order.order_id);
        self.note_past(supervisor, self.orders.key, noted);
        self.note(supervisor, "order", job.given());
        self.note(supervisor, "stops", &job.stops);
        self.note(supervisor, "sent", job.sent);
        self.note(supervisor, RECEIVED, job.received);
        (self.job, self.astray) = (Some(job), None);
    }

    /// Takes an order for a vehicle that has lost its order. It keeps its rights if the new order follows the same way.
    fn begin_anew(
        &mut self,
        supervisor: &mut Supervisor,
        order: Order,
        version: ProtocolVersion,
        now: f64,
    ) -> Result<bool, RejectedOrder> {
        let held = OrderState::new(order.clone())?;
        let robot =
            supervisor.robot(&self.name).map_err(|fault| RejectedOrder::new(OrderRejection::Order, "", fault))?;
        let rejoined = self.job.as_ref().zip(self.state.as_ref()).and_then(|(lost, state)| {
            let [length, _] = self.on_its_way(lost, robot, state.position()?)?;
            lost.rejoined(robot, held, length, version.text().into())
        });
        let Some((mut job, joins)) = rejoined else {
            let state = self.state.clone();
            let may_follow = self.job.as_ref().zip(state.as_ref()).is_some_and(|(job, state)| {
                job.order.order_id == state.order_id && job.is_due(state) && now - job.sent_at < LATEST
            });
            state.iter().filter(|_| !may_follow).for_each(|state| self.reseat(supervisor, state));
            return match self.job {
                None => self.begin(supervisor, order, version, now),
                Some(_) => Err(RejectedOrder::new(
                    OrderRejection::Order,
                    "",
                    "the vehicle has lost its order, and does not say where it stands, or may still get an update of it",
                )),
            };
        };
        let known = mission(&job.order, joins);
        supervisor
            .adopt(&self.name, known)
            .map_err(|fault| RejectedOrder::new(OrderRejection::Order, "orderId", fault))?;
        job.requested_node = joins;
        if job.order.base > joins {
            self.ask(supervisor, &mut job, Some(joins), now)?;
        }
        self.has(supervisor, job);
        Ok(true)
    }

    fn extend(&mut self, supervisor: &mut Supervisor, order: Order, now: f64) -> Result<bool, RejectedOrder> {
        let Some(job) = &self.job else { return Ok(false) };
        if job.cancel.is_some() {
            return Err(RejectedOrder::new(OrderRejection::Cancelled, "orderId", "it is being cancelled"));
        }
        if job.lost_at.is_some() {
            return Err(RejectedOrder::new(OrderRejection::Order, "orderId", "the vehicle has lost it"));
        }
        let trimmed = self.state.as_deref().and_then(|state| job.trimmed(state));
        let is_trimmed = trimmed.is_some();
        let mut job = trimmed.unwrap_or_else(|| job.clone());
        let UpdateResult::After(after) = job.order.update(order)? else { return Ok(false) };
        job.path
            .extend(&job.order, after)
            .map_err(|refusal| RejectedOrder { error: OrderRejection::Order, refusal })?;
        let robot =
            supervisor.robot(&self.name).map_err(|fault| RejectedOrder::new(OrderRejection::Order, "", fault))?;
        let from = job.is_admitted(robot).then(|| job.planned(robot));
        if job.order.base > job.requested_node {
            self.ask(supervisor, &mut job, from, now)?;
        }
        job.changed = true;
        self.note(supervisor, "order", job.given());
        if is_trimmed {
            // Their lengths and numbers count from where the order begins now.
            self.note(supervisor, "stops", &job.stops);
            self.note(supervisor, "sent", job.sent);
        }
        self.job = Some(job);
        Ok(true)
    }

    /// Requests a mission from a node, or from where the vehicle stands, to the end of the base.
    fn ask(
        &mut self,
        supervisor: &mut Supervisor,
        job: &mut ActiveOrder,
        from: Option<usize>,
        now: f64,
    ) -> Result<(), RejectedOrder> {
        let path = job.path.shapes(from, job.order.base).to_vec();
        let why = job.path.unknown_heading(from).map(|why| format!("order {:?}: its heading is not known, as {why}: until it is done it counts as the disc around its outline", job.order.order_id));
        let proposal = MissionRequest {
            robot: self.name.clone(),
            mission: mission(&job.order, job.order.base),
            after: None,
            expected_path: None,
            any_heading: why.is_some(),
            start: None,
            path,
        };
        let verdict = supervisor.mission_in_parts(&proposal, job.mission_ends(from), now);
        if verdict.map_err(|fault| RejectedOrder::new(OrderRejection::Order, "nodes", fault))? == AdmissionResult::Past
        {
            return Err(was_there());
        }
        job.requested_node = job.order.base;
        self.remarks.extend(why);
        Ok(())
    }

    /// Bound on how far the vehicle may be off its path, plus the error of its reported position \[m\].
    pub(super) fn deviation(&self) -> f64 {
        (self.profile.abilities.margin - TOLERANCE).max(0.0)
    }
}

/// Rejects an old message that came late; the order would never be carried out.
fn was_there() -> RejectedOrder {
    RejectedOrder::new(OrderRejection::Order, "orderId", "the vehicle had an order of this name before")
}
