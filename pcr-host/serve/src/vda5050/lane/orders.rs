//! Orders of the fleet manager.

use super::super::way::{TOLERANCE, Way};
use super::Lane;
use super::job::{BEGINS, Job, RECEIVED, mission};
use super::maps::map_of;
use super::newest::LATEST;
use crate::supervisor::{Proposal, Supervisor, Verdict};
use pcr_formats::vda5050::decode::{self, Limits, Refusal};
use pcr_formats::vda5050::order::Order;
use pcr_formats::vda5050::order_state::{OrderState, Rejected, Taken};
use pcr_formats::vda5050::version::{Error, Version};

/// Largest number of orders and updates that wait for the first state of a vehicle after a restart.
const EARLY: usize = 8;

impl Lane {
    /// Takes an order or an update of the manager; an error is reported to the manager.
    pub fn order(&mut self, supervisor: &mut Supervisor, bytes: &[u8], limits: Limits, is_third: bool, now: f64) {
        let (mut id, mut update) = (String::new(), 0);
        let taken = decode::read::<Order>(bytes, limits).map_err(Rejected::from).and_then(|order| {
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
    pub(super) fn reject(&mut self, rejected: &Rejected, order: &str, update: u64) {
        let Some(version) = self.version else { return };
        let error = rejected.report(version, order, update);
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
    fn take(&mut self, supervisor: &mut Supervisor, order: Order, is_third: bool, now: f64) -> Result<bool, Rejected> {
        let version = order.header.check(&self.profile.key, is_third)?;
        if self.version.is_some_and(|own| own.major() != version.major()) {
            return Err(Refusal::new("version", "not that of the vehicle").into());
        }
        self.passable(supervisor, &order)?;
        if supervisor.robot(&self.name).is_err() {
            return Err(Rejected::new(Error::Order, "", "the vehicle has not yet said where it stands"));
        }
        let is_its = self.job.as_ref().is_some_and(|job| job.held.order_id == order.order_id);
        if !is_its && self.orders.contains(&order.order_id) {
            return Err(was_there());
        }
        match &self.job {
            Some(_) if is_its => self.extend(supervisor, order, now),
            Some(_) if self.state.is_none() && self.early.len() < EARLY => {
                self.early.push((order, is_third));
                Ok(false)
            }
            Some(job) if job.lost.is_some() => self.begin_anew(supervisor, order, version, now),
            Some(_) if !self.is_free(supervisor) => {
                Err(Rejected::new(Error::Order, "orderId", "the vehicle has another order that is not finished"))
            }
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
            && job.planned(robot) == job.held.base
            && job.held.nodes.len() == job.held.base + 1
            && job.last().node == job.held.base
            && !job.last().between
            && state.order_id == job.held.order_id
            && job.passed(state) == job.stops.len().checked_sub(1)
            && state.is_idle()
    }

    /// Rejects an order that the vehicle's margin does not cover.
    fn passable(&self, supervisor: &Supervisor, order: &Order) -> Result<(), Rejected> {
        for (k, edge) in order.edges.iter().enumerate() {
            if edge.rest.contains_key("corridor") {
                let field = format!("edges[{k}].corridor");
                return Err(Rejected::new(Error::Order, &field, "vehicles keep to the middle of their way here"));
            }
        }
        for (k, node) in order.nodes.iter().enumerate() {
            let position = node.node_position.as_ref();
            position
                .map_or(Ok(None), |position| position.deviation())
                .map_err(|refusal| Refusal::new(format!("nodes[{k}].nodePosition.{}", refusal.field), refusal.why))?;
        }
        let maps = order.nodes.iter().filter_map(|node| node.node_position.as_ref()).map(|position| &position.map_id);
        let here = self.state.as_ref().and_then(|state| state.position()).map(|pose| pose.map_id.as_str());
        // After a restart it is known before the vehicle sends a message.
        let known = supervisor.robot(&self.name).ok().and_then(map_of);
        let mut all = maps.map(String::as_str).chain(here).chain(known);
        let first = all.next();
        if all.any(|map| Some(map) != first) {
            return Err(Rejected::new(Error::Order, "nodes", "from map to map: there are no common coordinates"));
        }
        Ok(())
    }

    fn begin(
        &mut self,
        supervisor: &mut Supervisor,
        order: Order,
        version: Version,
        now: f64,
    ) -> Result<bool, Rejected> {
        let robot = supervisor.robot(&self.name).map_err(|fault| Rejected::new(Error::Order, "", fault))?;
        let course = &robot.course;
        let start = course.arrival(course.length()).map_err(|fault| Rejected::new(Error::Order, "", fault))?;
        let held = OrderState::new(order)?;
        let way = Way::new(start, &held).map_err(|refusal| Rejected { error: Error::Order, refusal })?;
        let begins = way.node(0).unwrap_or(0.0);
        if begins > BEGINS {
            return Err(Rejected::new(
                Error::Order,
                "nodes[0].nodePosition",
                format!("{begins:.3} m from the vehicle"),
            ));
        }
        let mut job = Job::new(held, way, version.text().into());
        self.ask(supervisor, &mut job, None, now)?;
        self.has(supervisor, job);
        Ok(true)
    }

    /// Gives the vehicle this order.
    fn has(&mut self, supervisor: &mut Supervisor, job: Job) {
        let noted = self.orders.push(&job.held.order_id);
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
        version: Version,
        now: f64,
    ) -> Result<bool, Rejected> {
        let held = OrderState::new(order.clone())?;
        let robot = supervisor.robot(&self.name).map_err(|fault| Rejected::new(Error::Order, "", fault))?;
        let rejoined = self.job.as_ref().zip(self.state.as_ref()).and_then(|(lost, state)| {
            let [length, _] = self.on_its_way(lost, robot, state.position()?)?;
            lost.rejoined(robot, held, length, version.text().into())
        });
        let Some((mut job, joins)) = rejoined else {
            let state = self.state.clone();
            let may_follow = self.job.as_ref().zip(state.as_ref()).is_some_and(|(job, state)| {
                job.held.order_id == state.order_id && job.is_due(state) && now - job.sent_at < LATEST
            });
            state.iter().filter(|_| !may_follow).for_each(|state| self.reseat(supervisor, state));
            return match self.job {
                None => self.begin(supervisor, order, version, now),
                Some(_) => Err(Rejected::new(
                    Error::Order,
                    "",
                    "the vehicle has lost its order, and does not say where it stands, or may still get an update of it",
                )),
            };
        };
        let known = mission(&job.held, joins);
        supervisor.adopt(&self.name, known).map_err(|fault| Rejected::new(Error::Order, "orderId", fault))?;
        job.asked = joins;
        if job.held.base > joins {
            self.ask(supervisor, &mut job, Some(joins), now)?;
        }
        self.has(supervisor, job);
        Ok(true)
    }

    fn extend(&mut self, supervisor: &mut Supervisor, order: Order, now: f64) -> Result<bool, Rejected> {
        let Some(job) = &self.job else { return Ok(false) };
        if job.cancel.is_some() {
            return Err(Rejected::new(Error::Cancelled, "orderId", "it is being cancelled"));
        }
        if job.lost.is_some() {
            return Err(Rejected::new(Error::Order, "orderId", "the vehicle has lost it"));
        }
        let trimmed = self.state.as_deref().and_then(|state| job.trimmed(state));
        let is_trimmed = trimmed.is_some();
        let mut job = trimmed.unwrap_or_else(|| job.clone());
        let Taken::After(after) = job.held.update(order)? else { return Ok(false) };
        job.way.extend(&job.held, after).map_err(|refusal| Rejected { error: Error::Order, refusal })?;
        let robot = supervisor.robot(&self.name).map_err(|fault| Rejected::new(Error::Order, "", fault))?;
        let from = job.is_admitted(robot).then(|| job.planned(robot));
        if job.held.base > job.asked {
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
    fn ask(&self, supervisor: &mut Supervisor, job: &mut Job, from: Option<usize>, now: f64) -> Result<(), Rejected> {
        let path = job.way.shapes(from, job.held.base).to_vec();
        let proposal = Proposal {
            robot: self.name.clone(),
            mission: mission(&job.held, job.held.base),
            after: None,
            of: None,
            start: None,
            path,
        };
        let verdict = supervisor.mission(&proposal, now);
        if verdict.map_err(|fault| Rejected::new(Error::Order, "nodes", fault))? == Verdict::Past {
            return Err(was_there());
        }
        job.asked = job.held.base;
        Ok(())
    }

    /// Bound on how far the vehicle may be off its path, plus the error of its reported position \[m\].
    pub(super) fn deviation(&self) -> f64 {
        (self.profile.abilities.margin - TOLERANCE).max(0.0)
    }
}

/// Rejects an old message that came late; the order would never be carried out.
fn was_there() -> Rejected {
    Rejected::new(Error::Order, "orderId", "the vehicle had an order of this name before")
}
