//! When the world changes: edges and nodes that are closed, and vehicles that stand still.
//!
//! Whoever is on a closed edge, or cannot stop before it, drives through; all others get another route, or go to an end and wait. A
//! vehicle that stands still is an obstacle where it is: its route ends there, and so do those of all that would wait for it for ever, until they
//! have another one.

use super::own_missions::{ClosureEffect, MissionOutcome, OwnEvent};
use super::planning_context::{PlanningContext, TOLLS};
use super::route_admission::AdmittedRoute;
use super::run_state::{LifelongState, RobotMission};
use super::scheduling::AGAIN;
use pcr_formats::missions::ClosedElement;
use std::rc::Rc;

impl LifelongState {
    /// Begins and ends closures and breakdowns.
    pub(super) fn change_world(&mut self, now: f64) {
        let Some(own) = &self.own else { return };
        let (closures, breakdowns) = (own.fleet.closures.clone(), own.fleet.breakdowns.clone());
        let mut is_lasting = false;
        for (k, closure) in closures.iter().enumerate() {
            let event = &self.own.as_ref().map(|own| own.closures[k].clone()).unwrap_or_default();
            if !event.is_begun && closure.at <= now {
                self.close(closure.element, true);
                self.event(k, true, |event| event.is_begun = true);
                is_lasting |= closure.until.is_none();
                self.turn_away(k, now);
            } else if event.is_begun && !event.is_over && closure.until.is_some_and(|until| until <= now) {
                self.close(closure.element, false);
                self.event(k, true, |event| event.is_over = true);
            }
        }
        for (k, breakdown) in breakdowns.iter().enumerate() {
            let is_begun = self.own.as_ref().is_some_and(|own| own.breakdowns[k].is_begun);
            if !is_begun && breakdown.at <= now {
                self.event(k, false, |event| event.is_begun = true);
                is_lasting |= breakdown.until.is_none();
                self.break_down(k, breakdown.vehicle, breakdown.until.unwrap_or(f64::INFINITY), now);
            }
        }
        if is_lasting {
            self.refuse_impossible();
        }
        if now >= self.freed {
            self.freed = now + AGAIN;
            self.free_stranded(now);
        }
    }

    fn event(&mut self, k: usize, is_closure: bool, change: impl FnOnce(&mut OwnEvent)) {
        let Some(own) = &mut self.own else { return };
        let events = if is_closure { &mut own.closures } else { &mut own.breakdowns };
        events.get_mut(k).map(change);
    }

    /// The atoms that nobody may enter while an element is closed.
    pub(super) fn closed_atoms(&self, element: ClosedElement) -> Vec<usize> {
        match element {
            ClosedElement::Edge(edge) => {
                (0..self.site.edges).filter(|&atom| self.site.atoms[atom].edge == Some(edge)).collect()
            }
            ClosedElement::Node(place) => {
                let is_there = |atom: &usize| self.site.atoms[*atom].ends[1] % self.site.places() == place;
                (0..self.site.edges).filter(is_there).collect()
            }
        }
    }

    fn close(&mut self, element: ClosedElement, closes: bool) {
        for atom in self.closed_atoms(element) {
            let count = &mut self.closed[atom];
            *count = if closes { *count + 1 } else { count.saturating_sub(1) };
        }
    }

    /// Gives other routes to the vehicles on whose routes closed elements are.
    fn turn_away(&mut self, closure: usize, now: f64) {
        for robot in 0..self.robots.len() {
            let it = &self.robots[robot];
            let stop = it.stop();
            let ahead = |k: &usize| self.closed[it.way.atoms[*k]] > 0 && it.way.offsets[*k + 1] > it.at;
            let closed: Vec<usize> = (0..it.way.atoms.len()).filter(ahead).collect();
            let is_through = closed.iter().any(|&k| it.way.offsets[k] < stop || it.way.offsets[k] < it.at);
            let is_turned = closed.iter().any(|&k| it.way.offsets[k] >= stop);
            if is_turned {
                let effect = if self.reroute(robot, now) { ClosureEffect::Rerouted } else { ClosureEffect::Waits };
                self.event(closure, true, |event| event.effects.push((robot, effect)));
            } else if is_through {
                self.event(closure, true, |event| event.effects.push((robot, ClosureEffect::Through)));
            }
        }
        self.end_circles(now);
    }

    /// A vehicle stands still from now on.
    fn break_down(&mut self, k: usize, robot: usize, until: f64, now: f64) {
        self.robots[robot].stopped_until = until;
        self.cut(robot);
        let is_for_ever = until == f64::INFINITY;
        let place = self.place_of(robot);
        self.event(k, false, |event| event.place = Some(place));
        if let Some(own) = &mut self.own
            && is_for_ever
            && let Some(mission) = own.current[robot].take()
        {
            let id = own.fleet.vehicles[robot].id.clone();
            let it = &mut own.missions[mission];
            let is_empty = it.reached.is_empty() && it.request.vehicle.is_none();
            it.outcome = if is_empty {
                (it.vehicle, it.begun) = (None, None);
                MissionOutcome::Open
            } else {
                MissionOutcome::Refused(format!("vehicle {id} broke down at {now:.1} s"))
            };
        }
        self.missions[robot] = None;
        for other in self.end_circles(now) {
            let effect = if self.robots[other].cut.is_none() { ClosureEffect::Rerouted } else { ClosureEffect::Waits };
            self.event(k, false, |event| event.effects.push((other, effect)));
        }
    }

    /// The edge on which a vehicle will stand, and the point.
    fn place_of(&self, robot: usize) -> (Option<usize>, [f64; 2]) {
        let way = &self.robots[robot].way;
        let (length, last) = (way.length(), way.atoms[way.atoms.len() - 1]);
        let edge = if way.is_cut { self.site.atoms[last].edge } else { None };
        (edge, way.point(&self.site, length))
    }

    /// Another route for a vehicle to its goal; otherwise one to an end, or it stops. Returns whether it got one to its goal.
    fn reroute(&mut self, robot: usize, now: f64) -> bool {
        if let Some(mission) = self.missions[robot] {
            if let Some(admitted) = self.scene(now).dispatch(robot, &[mission.goal]) {
                self.take(robot, admitted);
                self.missions[robot] = Some(RobotMission { admitted: true, ..mission });
                return true;
            }
            self.missions[robot] = Some(RobotMission { admitted: false, next_try: now + AGAIN, ..mission });
        }
        let has_goal = self.missions[robot].is_some();
        match self.scene(now).retreat(robot) {
            Some(admitted) => self.take(robot, admitted),
            None => {
                self.cut(robot);
                return false;
            }
        }
        !has_goal
    }

    /// Ends the routes of vehicles that would wait for ever where they can stop, and gives them others. Returns these vehicles.
    fn end_circles(&mut self, now: f64) -> Vec<usize> {
        let mut ended = Vec::new();
        while let Err(stuck) = self.scene(now).base() {
            let new: Vec<usize> =
                stuck.iter().map(|stuck| stuck.robot).filter(|robot| !ended.contains(robot)).collect();
            if new.is_empty() {
                break;
            }
            for robot in new {
                self.cut(robot);
                if let Some(mission) = &mut self.missions[robot]
                    && self.robots[robot].way.goals.is_empty()
                {
                    (mission.admitted, mission.next_try) = (false, now);
                }
                ended.push(robot);
            }
        }
        for &robot in &ended {
            if !self.is_fixed(robot, now) || self.robots[robot].stopped_until <= now {
                self.reroute(robot, now);
            }
        }
        ended
    }

    /// Ends the route of a vehicle where it can stop.
    fn cut(&mut self, robot: usize) {
        let stop = self.robots[robot].stop();
        let old = self.robots[robot].way.clone();
        if stop >= old.length() {
            return;
        }
        let before: Vec<_> = self.book.seen_by(robot).map(|(_, region)| region).collect();
        let covers = self.end_covers(robot);
        covers.iter().for_each(|&atom| self.parked[atom] -= 1);
        let way = old.cut(&self.site, stop);
        let at = self.robots[robot].at;
        self.book.exchange(robot, &old, &way, Vec::new());
        let is_cut = way.is_cut;
        self.robots[robot].way = way;
        self.robots[robot].cut = is_cut.then(|| self.covers_on_edge(robot));
        let mut regions = self.book.regions(&self.site, &self.robots, robot, &self.robots[robot].way, at);
        for region in &mut regions {
            let same = before.iter().find(|other| {
                other.robots[1] == region.robots[1] && (0..2).all(|side| other.hull[side].meets(region.hull[side]))
            });
            region.first = same.map_or(1, |same| same.first);
        }
        self.book.add(regions);
        let covers = self.end_covers(robot);
        covers.iter().for_each(|&atom| self.parked[atom] += 1);
    }

    /// The atoms on which others would touch a vehicle at the end of its route on an edge.
    fn covers_on_edge(&self, robot: usize) -> Rc<[usize]> {
        let way = &self.robots[robot].way;
        let last = way.atoms.len() - 1;
        let along = way.length() - way.offsets[last];
        let contacts = self.site.contacts(way.atoms[last]);
        let near = contacts.filter(|(_, contact)| contact.hull[0].lo <= along && along <= contact.hull[0].hi);
        near.map(|(atom, _)| atom).collect()
    }

    /// Searches routes for vehicles that stopped on an edge and could drive.
    fn free_stranded(&mut self, now: f64) {
        for robot in 0..self.robots.len() {
            let it = &self.robots[robot];
            if it.cut.is_some() && it.stopped_until <= now && self.missions[robot].is_none_or(|it| !it.admitted) {
                self.reroute(robot, now);
            }
        }
        self.end_circles(now);
    }

    /// Whether a vehicle cannot make way: it broke down, or stands on an edge.
    pub(super) fn is_fixed(&self, robot: usize, now: f64) -> bool {
        self.own.is_some() && (self.robots[robot].cut.is_some() || self.robots[robot].stopped_until > now)
    }

    /// The atoms on which others would touch a robot at the end of its way.
    pub(super) fn end_covers(&self, robot: usize) -> Rc<[usize]> {
        self.robots[robot].end_covers(&self.site)
    }
}

impl PlanningContext<'_> {
    /// A way for a robot to a place where it may stand for good, whatever its goal is.
    fn retreat(&self, robot: usize) -> Option<AdmittedRoute> {
        /// Number of nearest places that are tried.
        const PLACES: usize = 6;
        let kept = self.kept(robot);
        let safe = |node: usize| self.is_free(robot, node) && self.ends.is_safe[node];
        let mut found = self.routes(robot, &kept, TOLLS[0], safe, None, PLACES);
        if found.is_empty() || self.crowded {
            found.extend(self.aside(robot, kept.end_pose, TOLLS[0], |_| true, PLACES));
        }
        if self.is_free(robot, kept.end_pose.node) {
            found.push(Vec::new());
        }
        self.admitted(robot, &kept, found.into_iter().map(|route| (route, Vec::new())).collect())
    }
}
