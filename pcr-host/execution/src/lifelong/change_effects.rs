//! What changes of the site do to the fleet, at random missions and at missions of a file.
//!
//! Whoever is on a closed edge, or cannot stop before it, drives through; all others get another route, or go to an end and wait. A
//! vehicle that stands still is an obstacle where it is: its route ends there, and so do those of all that would wait for it for ever, until they
//! have another one. A mission that cannot be done while a change lasts waits for its end without being in the way of younger ones.

use super::own_missions::MissionOutcome;
use super::planning_context::{PlanningContext, TOLLS};
use super::robot_mission::RobotMission;
use super::route_admission::AdmittedRoute;
use super::run_state::LifelongState;
use super::scheduling::AGAIN;
use super::world_changes::{ChangeEffect, ChangeId};
use pcr_formats::missions::ClosedElement;
use std::rc::Rc;

impl LifelongState {
    /// Begins and ends closures and breakdowns.
    pub(super) fn change_world(&mut self, now: f64) {
        if self.world.changes.is_empty() {
            return;
        }
        let [begun, over] = self.world.due(now);
        let ends_something = !over.is_empty();
        let limits = |change: &ChangeId| self.world.limit(*change).is_some();
        if begun.iter().chain(&over).any(limits) {
            self.limit_speeds(&begun, now);
        }
        for change in over {
            if let ChangeId::Closure(k) = change
                && self.world.limit(change).is_none()
            {
                self.close(self.world.changes.closures[k].element, false);
            }
        }
        for &change in &begun {
            match change {
                ChangeId::Closure(_) if self.world.limit(change).is_some() => {}
                ChangeId::Closure(k) => {
                    self.close(self.world.changes.closures[k].element, true);
                    self.turn_away(change, now);
                }
                ChangeId::Breakdown(k) => self.break_down(change, self.world.changes.breakdowns[k].vehicle, now),
            }
        }
        let lasts = |change: &ChangeId| self.world.times(*change)[1] == f64::INFINITY;
        if begun.iter().any(lasts) {
            if let Some(own) = &mut self.own {
                own.looked_at.fill(None);
            }
            self.refuse_impossible(now);
        }
        if ends_something || !begun.is_empty() {
            self.resume(now);
        }
        if now >= self.world.next_review || !begun.is_empty() {
            self.world.next_review = now + AGAIN;
            self.free_stranded(now);
            self.suspend_unreachable(now);
        }
    }

    /// The atoms that nobody may enter while an element is closed.
    fn closed_atoms(&self, element: ClosedElement) -> Vec<usize> {
        let is_closed = |atom: &usize| {
            let it = &self.site.atoms[*atom];
            it.edge.is_some_and(|edge| self.world.has_edge(element, edge))
                || self.world.has_node(element, it.ends[1] % self.site.places())
        };
        (0..self.site.edges).filter(is_closed).collect()
    }

    fn close(&mut self, element: ClosedElement, closes: bool) {
        for atom in self.closed_atoms(element) {
            let count = &mut self.world.closed[atom];
            *count = if closes { *count + 1 } else { count.saturating_sub(1) };
        }
    }

    /// The atoms that a change takes from a robot.
    pub(super) fn blocked(&self, change: ChangeId, robot: usize) -> Rc<[usize]> {
        match change {
            ChangeId::Closure(_) if self.world.limit(change).is_some() => Rc::default(),
            ChangeId::Closure(k) => self.closed_atoms(self.world.changes.closures[k].element).into(),
            ChangeId::Breakdown(k) => match self.world.changes.breakdowns[k].vehicle {
                other if other == robot || other >= self.robots.len() => Rc::default(),
                other => self.end_covers(other),
            },
        }
    }

    /// The first of some changes that leaves no route for a robot to all of these nodes of the layout, one after the other, together with those
    /// before it.
    pub(super) fn cause(&self, robot: usize, stops: &[usize], changes: &[ChangeId]) -> Option<ChangeId> {
        let mut blocked = vec![false; self.site.atoms.len()];
        let mut add = |change: &ChangeId| {
            self.blocked(*change, robot).iter().for_each(|&atom| blocked[atom] = true);
            !self.reaches(robot, stops, &blocked)
        };
        changes.iter().copied().find(|change| add(change))
    }

    /// Returns the change because of which a robot cannot reach its goal, together with those before it; `None` if the present changes leave it
    /// a route.
    fn obstacle(&self, robot: usize, goal: usize) -> Option<ChangeId> {
        let goal = [goal % self.site.places()];
        let lasting = self.world.lasting();
        // Those for ever first: without a route past them the mission is given up.
        let for_ever = if lasting.is_empty() { None } else { self.cause(robot, &goal, &lasting) };
        for_ever.or_else(|| {
            let is_passing = |change: &ChangeId| !lasting.contains(change);
            let passing = self.world.present.iter().copied().filter(is_passing);
            let all: Vec<ChangeId> = lasting.iter().copied().chain(passing).collect();
            self.cause(robot, &goal, &all)
        })
    }

    /// Whether a robot may get a random mission: it can drive, waits for no change, and some goal can be reached.
    pub(super) fn has_goals(&self, robot: usize, now: f64) -> bool {
        if self.world.is_stranded(robot, now) || self.world.suspended[robot].is_some() {
            return false;
        }
        let lasting = self.world.lasting();
        if lasting.is_empty() || !self.robots[robot].way.goals.is_empty() {
            return true;
        }
        let mut blocked = vec![false; self.site.atoms.len()];
        for change in lasting {
            self.blocked(change, robot).iter().for_each(|&atom| blocked[atom] = true);
        }
        let here = self.robots[robot].way.end();
        let mut goals = self.ends.nodes.iter().map(|&node| node % self.site.places());
        goals.any(|goal| goal != here && self.reaches(robot, &[goal], &blocked))
    }

    /// Takes missions that cannot be done at present from their robots. Random ones are given up if they never can.
    fn suspend_unreachable(&mut self, now: f64) {
        if self.world.present.is_empty() {
            return;
        }
        for robot in 0..self.robots.len() {
            let Some(mission) = self.missions[robot].filter(|mission| !mission.admitted) else { continue };
            let Some(change) = self.obstacle(robot, mission.goal) else { continue };
            let lasts = self.world.times(change)[1] == f64::INFINITY;
            // Missions of a file that no vehicle can do are given up there, with the reason.
            if self.own.is_none() || !lasts {
                self.world.lose(change, robot, mission.goal % self.site.places(), now);
                self.missions[robot] = None;
                self.world.suspended[robot] = (!lasts).then_some(mission);
            }
        }
    }

    /// Looks again at missions that could not be done: their robots get them back where they can be done now.
    fn resume(&mut self, now: f64) {
        for robot in 0..self.robots.len() {
            let Some(mission) = self.world.suspended[robot].filter(|_| !self.world.is_stranded(robot, now)) else {
                continue;
            };
            match self.obstacle(robot, mission.goal) {
                None => {
                    // It has not waited for other robots.
                    self.missions[robot] = Some(RobotMission { passed: 0, next_try: now, ..mission });
                    self.world.suspended[robot] = None;
                }
                Some(change) if self.own.is_none() && self.world.times(change)[1] == f64::INFINITY => {
                    self.world.lose(change, robot, mission.goal % self.site.places(), now);
                    self.world.suspended[robot] = None;
                }
                Some(_) => {}
            }
        }
    }

    /// Gives other routes to the vehicles on whose routes a closure is. Those that drive through another one, which began before, do so.
    fn turn_away(&mut self, closure: ChangeId, now: f64) {
        let atoms = self.blocked(closure, usize::MAX);
        for robot in 0..self.robots.len() {
            let it = &self.robots[robot];
            let stop = it.stop();
            // One that stands within an edge is still on it.
            let is_left = |k: usize| it.way.offsets[k + 1] <= it.at && !(it.way.is_cut && k + 1 == it.way.atoms.len());
            let ahead = |k: &usize| atoms.contains(&it.way.atoms[*k]) && !is_left(*k);
            let closed: Vec<usize> = (0..it.way.atoms.len()).filter(ahead).collect();
            let is_through = closed.iter().any(|&k| it.way.offsets[k] < stop || it.way.offsets[k] < it.at);
            let is_turned = closed.iter().any(|&k| it.way.offsets[k] >= stop);
            // Whoever drives through may get another route for the rest of its way.
            let is_rerouted = is_turned && self.reroute(robot, now);
            if is_turned && !is_rerouted {
                self.end_circles(now);
            }
            let turned = if is_rerouted { ChangeEffect::Rerouted } else { ChangeEffect::Waits };
            // One that drives through and would have come back gets another route or waits as well.
            let effects = [(is_through, ChangeEffect::Through), (is_turned, turned)];
            let effects = effects.into_iter().filter(|effect| effect.0).map(|effect| (robot, effect.1));
            self.world.record(closure).effects.extend(effects);
        }
        self.end_circles(now);
    }

    /// A vehicle stands still from now on. One that is not on the layout cannot.
    fn break_down(&mut self, change: ChangeId, robot: usize, now: f64) {
        if robot >= self.robots.len() {
            return;
        }
        let until = self.world.times(change)[1].max(self.world.stranded[robot]);
        self.world.stranded[robot] = until;
        self.robots[robot].stopped_until = until;
        self.cut(robot);
        let is_for_ever = until == f64::INFINITY;
        self.world.record(change).place = Some(self.place_of(robot));
        if let Some(own) = &mut self.own {
            if is_for_ever && let Some(mission) = own.current[robot].take() {
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
            self.world.suspended[robot] = None;
        } else if self.robots[robot].way.goals.is_empty() {
            // It does not come to its goal while it brakes.
            let mission = self.missions[robot].take().or(self.world.suspended[robot].take());
            if let Some(mission) = mission {
                self.world.lose(change, robot, mission.goal % self.site.places(), now);
                let waits = RobotMission { admitted: false, ..mission };
                self.world.suspended[robot] = (!is_for_ever).then_some(waits);
            }
        }
        for other in self.end_circles(now) {
            let effect = if self.robots[other].cut.is_none() { ChangeEffect::Rerouted } else { ChangeEffect::Waits };
            self.world.record(change).effects.push((other, effect));
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
        // Decisions in a large fleet rely on times of the ways as they are.
        if self.is_large()
            && let Ok(forecast) = self.scene(now).base()
        {
            self.timetable.change(forecast.robots.into_iter().zip(forecast.lines).collect());
        }
        for &robot in &ended {
            if !self.world.is_stranded(robot, now) {
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
            let is_able = it.cut.is_some() && !self.world.is_stranded(robot, now);
            if is_able && self.missions[robot].is_none_or(|it| !it.admitted) {
                self.reroute(robot, now);
            }
        }
        self.end_circles(now);
    }

    /// Whether a vehicle cannot make way: it broke down, or stands on an edge.
    pub(super) fn is_fixed(&self, robot: usize, now: f64) -> bool {
        self.robots[robot].cut.is_some() || self.world.is_stranded(robot, now)
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
