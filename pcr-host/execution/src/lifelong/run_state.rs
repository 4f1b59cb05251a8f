//! The state of a run: the fleet, its missions, and the results so far.

use super::endpoints::{Endpoints, WellFormedness};
use super::forecast::WHOLE;
use super::joint_phase::JointPhase;
use super::kinematic_limits::KinematicLimits;
use super::motion_record::RunCertificate;
use super::outcome::{LifelongResult, TimeShares};
use super::own_missions::OwnMissions;
use super::parking_spots::queued;
use super::planning_context::PlanningContext;
use super::random_draws::{self, starts};
use super::region_table::RegionTable;
use super::reservations::RouteReservations;
use super::robot::LifelongRobot;
use super::robot_mission::RobotMission;
use super::route::Route;
use super::route_admission::AdmittedRoute;
use super::route_finder::RouteFinder;
use super::route_graph::RouteGraph;
use super::tasks::{TaskQueue, TaskStream};
use super::timetable::Timetable;
use super::world_changes::WorldChanges;
use super::{CoordinationMethod, LifelongOptions};
use crate::error::ExecutionError;
use pcr_formats::import::ImportedLayout;
use pcr_formats::missions::SiteChanges;
use std::time::{Duration, Instant};

pub(super) struct LifelongState {
    pub(super) site: RouteGraph,
    pub(super) ends: Endpoints,
    pub(super) layout: WellFormedness,
    /// Whether there are more robots than safe ends, or as many and additional queue places where robots can make way for one
    /// another.
    pub(super) crowded: bool,
    /// Whether only the mission that has waited longest is admitted.
    pub(super) is_urgent: bool,
    /// Reserved routes as (robot, route), where no other robot may come to stand: first that of the mission that has waited
    /// longest, then those of robots in its way.
    pub(super) reserved: Vec<(usize, Vec<usize>)>,
    pub(super) network: RouteFinder,
    pub(super) request: LifelongOptions,
    pub(super) robots: Vec<LifelongRobot>,
    pub(super) book: RegionTable,
    /// The timetable, used for a large fleet.
    pub(super) timetable: Timetable,
    pub(super) locks: RouteReservations,
    /// For each atom the number of robots that stand for good in its way.
    pub(super) parked: Vec<u16>,
    pub(super) missions: Vec<Option<RobotMission>>,
    /// Number of missions given to each robot.
    pub(super) given: Vec<u64>,
    pub(super) reviewed: Vec<f64>,
    /// For each robot the time of the last attempt to reverse its orders.
    pub(super) switched: Vec<f64>,
    pub(super) outcome: LifelongResult,
    pub(super) decisions: Vec<Duration>,
    pub(super) travel: (f64, f64),
    pub(super) steady: usize,
    pub(super) last_arrival: f64,
    /// Time for which all robots have stood at their ends while missions wait \[s\].
    pub(super) quiet: f64,
    /// When robots are moved up together.
    pub(super) joint: JointPhase,
    /// Tasks that are not done yet, if the robots share them.
    pub(super) tasks: Option<TaskQueue>,
    /// What changes on the site.
    pub(super) world: WorldChanges,
    /// Missions of a file, instead of random ones.
    pub(super) own: Option<OwnMissions>,
}

impl LifelongState {
    pub(super) fn new(
        imported: &ImportedLayout,
        request: LifelongOptions,
        changes: &SiteChanges,
        tasks: Option<&TaskStream>,
    ) -> Result<Self, ExecutionError> {
        if !changes.is_empty() && request.method != CoordinationMethod::Orders {
            return Err(ExecutionError::Changes(request.method.name()));
        }
        let site = RouteGraph::new(imported)?;
        let ends = Endpoints::of(&site, request.seed);
        let layout = ends.report(&site, &imported.layout);
        let starts = match tasks {
            Some(tasks) => tasks.starts(&site)?,
            None => starts(&site, &ends, request.agents, request.seed),
        };
        let run = Self::standing((imported, true), site, ends, layout, &starts, request, changes)?;
        // Not in unoptimized tests, because it takes long there.
        if !cfg!(debug_assertions) && tasks.is_some() {
            run.network.warm(&run.site, &run.ends.nodes);
        }
        Ok(Self { tasks: tasks.map(TaskQueue::of), ..run })
    }

    /// A fleet that stands at these nodes of a layout, of which additional places on dead ends may be used or not.
    pub(super) fn standing(
        (imported, may_queue): (&ImportedLayout, bool),
        mut site: RouteGraph,
        mut ends: Endpoints,
        layout: WellFormedness,
        starts: &[usize],
        request: LifelongOptions,
        changes: &SiteChanges,
    ) -> Result<Self, ExecutionError> {
        // With fewer robots than safe ends a robot can always make way at a free end.
        let is_tight = starts.len() >= ends.capacity;
        let places = (may_queue && is_tight).then(|| queued(imported, &site));
        let is_full = |lanes: &[Vec<usize>]| starts.len() > ends.capacity || lanes.iter().any(|lane| lane.len() > 1);
        let places = places.filter(|(_, lanes)| is_full(lanes));
        let crowded = places.is_some() || (!may_queue && starts.len() > ends.capacity);
        let mut layout_used = &imported.layout;
        if let Some((queued, lanes)) = &places {
            site = RouteGraph::new(queued)?;
            ends = ends.queued(&site, lanes.clone());
            layout_used = &queued.layout;
        }
        let network = RouteFinder::new(&site);
        // Not in unoptimized tests, because it takes long there.
        if !cfg!(debug_assertions) {
            site.warm();
            ends.harm(&site);
        }
        if starts.is_empty() {
            return Err(ExecutionError::NoRoom);
        }
        let abilities = |node: usize| KinematicLimits::of(&site.layers[site.layer_of(node)].vehicle);
        let robots: Vec<LifelongRobot> =
            starts.iter().map(|&node| LifelongRobot::new(Route::standing(&site, node), abilities(node))).collect();
        let mut parked = vec![0; site.atoms.len()];
        starts.iter().for_each(|&node| site.covers(node).iter().for_each(|&atom| parked[atom] += 1));
        let count = robots.len();
        let outcome = LifelongResult {
            method: request.method,
            robots: count,
            missions: 0,
            missions_per_hour: 0.0,
            travel_over_unimpeded: None,
            certificate: RunCertificate::new(),
            authority_overruns: 0,
            stuck: 0,
            standstill: 0.0,
            refused: 0,
            moved: 0,
            revised: 0,
            overtaken: 0,
            longest_wait: 0.0,
            waiting: 0.0,
            starved: 0,
            idle_because: None,
            time: TimeShares::default(),
        };
        Ok(Self {
            world: WorldChanges::new(changes, layout_used, count, &site),
            book: RegionTable::new(&site, &robots),
            locks: RouteReservations::new(count),
            network,
            timetable: Timetable::new(count),
            layout,
            crowded,
            is_urgent: false,
            reserved: Vec::new(),
            site,
            ends,
            request,
            robots,
            parked,
            missions: vec![None; count],
            given: vec![0; count],
            reviewed: vec![0.0; count],
            switched: vec![0.0; count],
            outcome,
            decisions: Vec::new(),
            travel: (0.0, 0.0),
            steady: 0,
            last_arrival: 0.0,
            quiet: 0.0,
            joint: JointPhase::default(),
            tasks: None,
            own: None,
        })
    }

    /// Whether missions remain.
    pub(super) fn has_work(&self) -> bool {
        self.tasks.as_ref().is_none_or(|tasks| !tasks.is_empty())
    }

    /// Gives a mission to each robot without one.
    pub(super) fn give(&mut self, now: f64) {
        if self.tasks.is_some() {
            self.assign(now);
            return;
        }
        if self.own.is_some() {
            self.give_own(now);
            return;
        }
        for robot in 0..self.robots.len() {
            if self.missions[robot].is_some() || !self.has_goals(robot, now) {
                continue;
            }
            let it = &self.robots[robot];
            let from = it.way.committed_part(&self.site, it.at, it.at, it.turned).end_pose;
            let place = from.node;
            let goal = random_draws::goal(&self.site, &self.ends, self.request.seed, robot, self.given[robot], place);
            self.given[robot] += 1;
            let begin = Instant::now();
            let way = self.network.quickest(&self.site, from, |_| 0.0, |node| node == goal, Some(goal), 1);
            let alone = way.first().map_or(0.0, |atoms| {
                Route::new(&self.site, from, atoms, &[], &it.abilities).unimpeded_time(&it.abilities)
            });
            let admitted = !it.way.goals.is_empty();
            let prepared = begin.elapsed();
            self.missions[robot] = Some(RobotMission {
                goal,
                assigned_at: now,
                rank: now,
                unimpeded_time: alone,
                admitted,
                passed: 0,
                next_try: now,
                prepared,
            });
        }
    }

    /// The goal of a robot after its present one, if it has one.
    pub(super) fn next_goal(&self, robot: usize, after: usize) -> Option<usize> {
        match &self.own {
            Some(own) => own.next_stop(robot).map(|stop| self.node_of_layer(robot, stop)),
            None => {
                let number = self.given[robot];
                Some(random_draws::goal(&self.site, &self.ends, self.request.seed, robot, number, after))
            }
        }
    }

    /// Whether decisions look at some of the robots only: in a large fleet, and if robots share their tasks, because another
    /// robot then takes over a late task.
    pub(super) fn is_large(&self) -> bool {
        self.request.method == CoordinationMethod::Orders
            && (self.robots.len() > WHOLE && self.own.is_none() || self.tasks.is_some())
    }

    pub(super) fn scene(&self, now: f64) -> PlanningContext<'_> {
        PlanningContext {
            site: &self.site,
            robots: &self.robots,
            book: &self.book,
            locks: &self.locks,
            network: &self.network,
            ends: &self.ends,
            crowded: self.crowded,
            is_urgent: self.is_urgent,
            reserved: &self.reserved,
            parked: &self.parked,
            stays: self.own.is_some() || !self.world.present.is_empty(),
            closed: &self.world.closed,
            time: now,
            timetable: self.is_large().then_some(&self.timetable),
            method: self.request.method,
        }
    }

    pub(super) fn take(&mut self, robot: usize, admitted: AdmittedRoute) {
        let AdmittedRoute { way, kept, before, regions, departs, lines, .. } = admitted;
        self.timetable.change(lines);
        if let Some(level) = self.reserved.iter().position(|route| route.0 == robot) {
            self.reserved.truncate(level);
        }
        self.end_covers(robot).iter().for_each(|&atom| self.parked[atom] -= 1);
        let it = &mut self.robots[robot];
        it.cut = None;
        self.site.covers(way.end()).iter().for_each(|&atom| self.parked[atom] += 1);
        self.book.exchange(robot, &it.way, &way, regions);
        self.locks.exchange(robot, kept);
        it.take(way, before);
        it.departs = departs;
    }
}
