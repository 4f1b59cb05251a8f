//! A run of the missions of a file: until all are done or given up, without random delays.

use super::change_results::ChangeResults;
use super::endpoints::{Endpoints, WellFormedness};
use super::motion_record::{CheckWindow, RunCertificate};
use super::own_missions::{MissionOutcome, OwnMission, OwnMissions, OwnWait};
use super::random_draws::STEP;
use super::robot::LifelongRobot;
use super::route_graph::{DeparturePose, RouteGraph, VehicleLayer};
use super::run_state::LifelongState;
use super::shunting::is_one_way;
use super::trajectory;
use super::world_changes::ChangeId;
use super::{CoordinationMethod, DelayModel, LifelongOptions};
use crate::error::ExecutionError;
use pcr_formats::import::ImportedLayout;
use pcr_formats::missions::{FleetMissions, FleetVehicle};
use pcr_formats::scenario::Scenario;

/// If no vehicle has moved for this long and nothing is to come, none ever will \[s\].
const STILL: f64 = 120.0;

/// If no stop was reached for this long although vehicles move, the other missions are given up \[s\].
const FRUITLESS: f64 = 3600.0;

/// What became of the missions of a file.
#[derive(Clone, Debug)]
pub struct MissionRun {
    /// What became of each mission.
    pub missions: Vec<MissionResult>,
    /// Where vehicles waited for others, in the order of time.
    pub waits: Vec<MissionWait>,
    /// The whole run as a scenario, with an agent for each vehicle. Its turns in place are so short that rounding of a long way
    /// before them can move them in time.
    pub scenario: Scenario,
    /// Result of the independent checker for the motions as they were recorded, with their turns in place.
    pub certificate: RunCertificate,
    /// What the changes of the site did.
    pub changes: ChangeResults,
    /// For each vehicle the node of the layout where it stands in the end; `None` on an edge.
    pub ends: Vec<Option<usize>>,
    /// Time at which the last vehicle stands \[s\].
    pub duration: f64,
}

/// What became of a mission.
#[derive(Clone, Debug, PartialEq)]
pub struct MissionResult {
    /// Index of its vehicle, if it has one.
    pub vehicle: Option<usize>,
    /// Time at which its vehicle got a route for it \[s\].
    pub start: Option<f64>,
    /// Times at which its stops were reached \[s\].
    pub reached: Vec<f64>,
    /// Reason why it was given up.
    pub reason: Option<String>,
}

/// Why no vehicle can do a mission.
pub(super) struct ImpossibleMission {
    pub(super) why: String,
    /// The change because of which a vehicle cannot come to a node of the layout, if it is one.
    cause: Option<(ChangeId, usize, usize)>,
}

/// A vehicle that waited for another one.
#[derive(Clone, Debug, PartialEq)]
pub struct MissionWait {
    /// Index of the vehicle.
    pub vehicle: usize,
    /// Index of the vehicle that went first.
    pub first: usize,
    /// From when to when \[s\].
    pub time: [f64; 2],
    /// Id of the edge on which it stood; `None` at a node.
    pub edge: Option<String>,
    /// Where it stood \[m\].
    pub point: [f64; 2],
}

/// Runs the missions of a file on a layout; `told` gets the simulated time and the number of missions that are over.
///
/// # Errors
/// Vehicles that touch where they start, a vehicle on edges that it cannot drive, or an edge that is no path.
pub fn run_missions(
    imported: &ImportedLayout,
    fleet: &FleetMissions,
    told: &dyn Fn(f64, usize),
) -> Result<MissionRun, ExecutionError> {
    let mut run = LifelongState::of_fleet(imported, fleet)?;
    run.refuse_impossible(0.0);
    let window = CheckWindow::new(&run.site, &run.robots);
    let (mut still, mut tick) = (0.0, 0);
    loop {
        let now = tick as f64 * STEP;
        let stand = run.robots.iter().all(LifelongRobot::has_arrived);
        let Some(own) = &run.own else { break };
        let is_to_come = own.is_to_come(now) || run.world.is_to_come(now);
        if own.is_over() && stand {
            break;
        }
        if !is_to_come && (still > STILL || now - own.progress > FRUITLESS) {
            run.give_up(now);
            if still > STILL {
                break;
            }
        }
        if tick % 100 == 0 {
            told(now, run.own.as_ref().map_or(0, OwnMissions::over));
        }
        run.change_world(now);
        run.note_parked(now);
        if tick == 0 {
            run.refuse_without_passing();
        }
        run.give(now);
        run.decide(now);
        run.note_begun(now);
        let before: f64 = run.robots.iter().map(|robot| robot.at).sum();
        run.step(tick, now, true);
        let moves = run.robots.iter().map(|robot| robot.at).sum::<f64>() != before;
        let waits = run.missions.iter().flatten().any(|mission| !mission.admitted);
        run.quiet = if waits && run.robots.iter().all(LifelongRobot::has_arrived) { run.quiet + STEP } else { 0.0 };
        still = if moves { 0.0 } else { still + STEP };
        tick += 1;
    }
    run.result(fleet, &imported.layout.name, tick as f64 * STEP, window)
}

impl LifelongState {
    /// The fleet of a file, before anything happens.
    fn of_fleet(imported: &ImportedLayout, fleet: &FleetMissions) -> Result<Self, ExecutionError> {
        let FleetMissions { vehicles, .. } = fleet;
        let mut layers: Vec<VehicleLayer> = Vec::new();
        let mut layer_of = Vec::new();
        for FleetVehicle { traits, forbidden, .. } in vehicles {
            let layer = VehicleLayer { vehicle: traits.clone(), forbidden: forbidden.clone() };
            let known = layers.iter().position(|other| other.is_same(&layer));
            layer_of.push(known.unwrap_or(layers.len()));
            if known.is_none() {
                layers.push(layer);
            }
        }
        let mut site = RouteGraph::layered(&imported.layout, &layers)?;
        site.stops_at_turns = true;
        let id = |robot: usize| &vehicles[robot].id;
        let starts: Vec<usize> =
            vehicles.iter().zip(&layer_of).map(|(it, layer)| layer * site.places() + it.start).collect();
        for (robot, &start) in starts.iter().enumerate() {
            if let Some(other) = starts[..robot].iter().position(|&other| site.collide(other, start)) {
                return Err(ExecutionError::Touching([other, robot].map(|robot| id(robot).clone())));
            }
        }
        let ends = Endpoints::of(&site, 1);
        let own = OwnMissions::new(fleet, is_one_way(&site));
        let delays = DelayModel { stopped: 0.0, stop: 1.0, slip: 0.0 };
        let method = CoordinationMethod::Orders;
        let request = LifelongOptions { agents: starts.len(), duration: f64::INFINITY, delays, seed: 1, method };
        let run =
            Self::standing((imported, false), site, ends, WellFormedness::default(), &starts, request, &fleet.changes)?;
        Ok(Self { own: Some(own), ..run })
    }

    /// Notes vehicles that can never leave where they stand. Missions that are impossible for that reason are given up.
    fn note_parked(&mut self, now: f64) {
        let is_new = |own: &OwnMissions, robot: usize| {
            let it = &self.robots[robot];
            it.has_arrived() && it.cut.is_none() && own.looked_at[robot] != Some(it.way.end())
        };
        let Some(own) = &self.own else { return };
        let new: Vec<usize> = (0..self.robots.len()).filter(|&robot| is_new(own, robot)).collect();
        let parked: Vec<bool> = new.iter().map(|&robot| !self.can_leave(own, robot)).collect();
        let Some(own) = &mut self.own else { return };
        for (&robot, &is_parked) in new.iter().zip(&parked) {
            own.looked_at[robot] = Some(self.robots[robot].way.end());
            own.is_parked[robot] = is_parked;
        }
        if parked.contains(&true) {
            self.refuse_impossible(now);
        }
    }

    /// Whether a vehicle can ever go where it would not touch one that comes to the place where it stands.
    fn can_leave(&self, own: &OwnMissions, robot: usize) -> bool {
        let here = self.robots[robot].way.end();
        let blocked = self.blocked_for_ever(own, robot);
        let it = &self.robots[robot];
        let from = it.way.committed_part(&self.site, it.at, it.stop(), it.turned).end_pose;
        let toll = |atom: usize| if blocked[atom] { f64::INFINITY } else { 0.0 };
        !self.network.quickest(&self.site, from, toll, |node| !self.site.collide(here, node), None, 1).is_empty()
    }

    /// Gives up the missions that no vehicle can do, whatever the others do.
    pub(super) fn refuse_impossible(&mut self, now: f64) {
        let Some(own) = &self.own else { return };
        let reasons: Vec<(usize, ImpossibleMission)> = own
            .missions
            .iter()
            .enumerate()
            .filter(|(_, mission)| matches!(mission.outcome, MissionOutcome::Open | MissionOutcome::Begun))
            .filter_map(|(place, mission)| Some((place, self.why_impossible(own, mission)?)))
            .collect();
        for (mission, ImpossibleMission { why, cause }) in reasons {
            if let Some((change, robot, node)) = cause {
                self.world.lose(change, robot, node, now);
            }
            self.drop_mission(mission, why);
        }
    }

    /// Gives a mission up, also if a vehicle has it.
    pub(super) fn drop_mission(&mut self, mission: usize, why: String) {
        let Some(own) = &mut self.own else { return };
        let vehicle = own.current.iter().position(|current| *current == Some(mission));
        own.refuse(mission, why);
        if let Some(robot) = vehicle {
            self.missions[robot] = None;
            self.world.suspended[robot] = None;
            self.robots[robot].way.goals.clear();
        }
    }

    /// Why no vehicle can do a mission from where it is now; `None` if one can.
    fn why_impossible(&self, own: &OwnMissions, mission: &OwnMission) -> Option<ImpossibleMission> {
        let stops = &mission.request.stops[mission.reached.len().min(mission.request.stops.len())..];
        // Whoever has begun it goes on.
        let vehicles: Vec<usize> = match mission.vehicle.or(mission.request.vehicle) {
            Some(vehicle) => vec![vehicle],
            None => (0..self.robots.len()).collect(),
        };
        if vehicles.is_empty() {
            return Some(ImpossibleMission { why: "there is no vehicle".into(), cause: None });
        }
        let all: Option<Vec<ImpossibleMission>> =
            vehicles.into_iter().map(|vehicle| self.why_not(own, vehicle, stops)).collect();
        let all = all?;
        let why: Vec<&str> = all.iter().map(|it| it.why.as_str()).collect();
        Some(ImpossibleMission { why: why.join("; "), cause: all.iter().find_map(|it| it.cause) })
    }

    /// Why a vehicle can never come to stops from where it is now; `None` if a way leads there.
    pub(super) fn why_not(&self, own: &OwnMissions, vehicle: usize, stops: &[usize]) -> Option<ImpossibleMission> {
        let id = &own.fleet.vehicles[vehicle].id;
        if self.world.stranded[vehicle] == f64::INFINITY {
            return Some(ImpossibleMission { why: format!("vehicle {id} broke down"), cause: None });
        }
        let blocked = self.blocked_for_ever(own, vehicle);
        let lost = (1..=stops.len()).find(|&count| !self.reaches(vehicle, &stops[..count], &blocked))?;
        let from = match lost.checked_sub(2) {
            Some(before) => format!("node {}", self.name_of(stops[before])),
            None => "where it is".into(),
        };
        let forbidden = &own.fleet.vehicles[vehicle].forbidden;
        let mut why = match forbidden.is_empty() {
            true => String::new(),
            false => " without the edges that are forbidden to it".into(),
        };
        let mut lost_by = None;
        if self.reaches(vehicle, &stops[..lost], &[]) {
            let cause = self.cause(vehicle, &stops[..lost], &self.world.lasting());
            lost_by = cause.map(|change| (change, vehicle, stops[lost - 1]));
            why = match cause {
                Some(_) => " without what is closed, or in the way of a vehicle that broke down, for ever".into(),
                None => format!(" past {}, which can never leave", self.parked_names(own, vehicle)),
            };
        }
        let node = self.name_of(stops[lost - 1]);
        let why = format!("vehicle {id}: no route leads from {from} to node {node}{why}");
        Some(ImpossibleMission { why, cause: lost_by })
    }

    /// The names of all vehicles but one that can never leave where they stand.
    fn parked_names(&self, own: &OwnMissions, vehicle: usize) -> String {
        let parked = (0..self.robots.len()).filter(|&other| other != vehicle && own.is_parked[other]);
        let names: Vec<&str> = parked.map(|other| own.fleet.vehicles[other].id.as_str()).collect();
        names.join(", ")
    }

    /// For each atom whether it is closed for ever, or a vehicle other than this one stands on it that never drives again, or can never leave.
    pub(super) fn blocked_for_ever(&self, own: &OwnMissions, vehicle: usize) -> Vec<bool> {
        let mut blocked = vec![false; self.site.atoms.len()];
        for change in self.world.lasting() {
            self.blocked(change, vehicle).iter().for_each(|&atom| blocked[atom] = true);
        }
        for other in (0..self.robots.len()).filter(|&other| other != vehicle && own.is_parked[other]) {
            self.end_covers(other).iter().for_each(|&atom| blocked[atom] = true);
        }
        blocked
    }

    /// Whether routes lead a vehicle to all of these nodes of the layout, one after the other, over atoms that are not blocked.
    pub(super) fn reaches(&self, robot: usize, stops: &[usize], blocked: &[bool]) -> bool {
        let it = &self.robots[robot];
        let mut from = it.way.committed_part(&self.site, it.at, it.stop(), it.turned).end_pose;
        let toll = |atom: usize| if blocked.get(atom) == Some(&true) { f64::INFINITY } else { 0.0 };
        stops.iter().all(|&stop| {
            let node = self.node_of_layer(robot, stop);
            let found = self.network.quickest(&self.site, from, toll, |other| other == node, Some(node), 1);
            from = DeparturePose { node, heading: None };
            !found.is_empty()
        })
    }

    /// The name of a node of the layout.
    pub(super) fn name_of(&self, place: usize) -> &str {
        self.world.nodes.get(place).map_or("", String::as_str)
    }

    /// Gives up all missions that are not done.
    fn give_up(&mut self, now: f64) {
        let Some(own) = &self.own else { return };
        let is_left = |mission: &&OwnMission| matches!(mission.outcome, MissionOutcome::Open | MissionOutcome::Begun);
        let left: Vec<usize> = (0..own.missions.len()).filter(|&k| is_left(&&own.missions[k])).collect();
        let reasons: Vec<String> = left.iter().map(|&mission| self.why_left(own, mission, now)).collect();
        let Some(own) = &mut self.own else { return };
        for (mission, why) in left.into_iter().zip(reasons) {
            own.refuse(mission, why);
        }
        own.progress = now;
        self.missions.fill(None);
        self.world.suspended.fill(None);
    }

    /// The reason why a mission did not come to its end.
    fn why_left(&self, own: &OwnMissions, mission: usize, now: f64) -> String {
        let it = &own.missions[mission];
        let Some(vehicle) = it.vehicle else {
            return match self.why_impossible(own, it) {
                Some(impossible) => impossible.why,
                None => "every vehicle that can do it was on another mission to the end".into(),
            };
        };
        let id = |robot: usize| own.fleet.vehicles[robot].id.as_str();
        let Some(&stop) = it.request.stops.get(it.reached.len()) else { return String::new() };
        let goal = self.node_of_layer(vehicle, stop);
        let scene = self.scene(now);
        match scene.wanted(vehicle, goal).map(|route| scene.standing_on(vehicle, &route)) {
            None => format!("vehicle {}: no route leads to node {} at present", id(vehicle), self.name_of(stop)),
            Some(others) if others.is_empty() => {
                format!("vehicle {}: no route to node {} was admitted", id(vehicle), self.name_of(stop))
            }
            Some(others) => {
                let names: Vec<&str> = others.iter().map(|&other| id(other)).collect();
                format!(
                    "vehicle {}: on its route to node {} stands {}, and nobody there can make way",
                    id(vehicle),
                    self.name_of(stop),
                    names.join(", ")
                )
            }
        }
    }

    /// Notes which missions have got a route for their vehicles.
    fn note_begun(&mut self, now: f64) {
        let Some(own) = &mut self.own else { return };
        for (robot, current) in own.current.iter().enumerate() {
            if let Some(mission) = *current
                && self.missions[robot].is_some_and(|mission| mission.admitted)
            {
                own.missions[mission].begun.get_or_insert(now);
            }
        }
    }

    /// Notes for which vehicle another one waits at its hold.
    pub(super) fn note_wait(&mut self, robot: usize, hold: f64, now: f64) {
        /// A vehicle within this distance of its hold waits there \[m\].
        const NEAR: f64 = 0.01;
        let it = &self.robots[robot];
        let is_driving = it.speed > 0.0 || it.has_arrived() || it.turning > now || it.stopped_until > now;
        if is_driving || hold - it.at > NEAR {
            return;
        }
        let Some(other) = self.book.next_first(robot, &self.robots, hold + 1e-6) else { return };
        let (atom, point) = (it.way.atoms[it.way.atom(it.at)], it.way.point(&self.site, it.at));
        let atom = if it.way.node(&self.site, it.at).is_some() { None } else { self.site.atoms[atom].edge };
        if let Some(own) = &mut self.own {
            own.wait(OwnWait { vehicle: robot, other, time: [now, now + STEP], edge: atom, point });
        }
    }

    /// The results of a run of some seconds.
    fn result(
        mut self,
        fleet: &FleetMissions,
        name: &str,
        duration: f64,
        mut window: CheckWindow,
    ) -> Result<MissionRun, ExecutionError> {
        let Some(own) = &self.own else { return Err(ExecutionError::NoMissions) };
        let missions = own.missions.iter().map(|it| MissionResult {
            vehicle: it.vehicle,
            start: it.begun,
            reached: it.reached.clone(),
            reason: match &it.outcome {
                MissionOutcome::Refused(why) => Some(why.clone()),
                _ => None,
            },
        });
        let waits = own.waits.iter().map(|it| MissionWait {
            vehicle: it.vehicle,
            first: it.other,
            time: it.time,
            edge: it.edge.map(|edge| self.world.edges[edge].clone()),
            point: it.point,
        });
        let changes = self.world.results();
        let (missions, mut waits): (Vec<_>, Vec<MissionWait>) = (missions.collect(), waits.collect());
        waits.sort_by(|a, b| a.time[0].total_cmp(&b.time[0]).then(a.vehicle.cmp(&b.vehicle)));
        let mut agents = Vec::new();
        for ((robot, it), vehicle) in self.robots.iter().enumerate().zip(&fleet.vehicles) {
            let start = self.site.layer_of(it.way.end()) * self.site.places() + vehicle.start;
            let agent = trajectory::agent(&self.site, it, robot as u64 + 1, &vehicle.id, start);
            agents.push(agent.map_err(|problem| ExecutionError::Driven(vehicle.id.clone(), problem))?);
        }
        let end = |robot: &LifelongRobot| robot.way.node(&self.site, robot.at).map(|node| node % self.site.places());
        let ends = self.robots.iter().map(end).collect();
        let scenario = Scenario::new(name, agents);
        let mut certificate = RunCertificate::new();
        certificate.window(&self.site, &mut self.robots, &mut window, duration);
        Ok(MissionRun { missions, waits, scenario, certificate, changes, ends, duration })
    }
}
