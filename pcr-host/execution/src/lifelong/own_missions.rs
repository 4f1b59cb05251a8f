//! Missions of a file: which vehicle does which one, and how far each has come.
//!
//! A mission is a list of stops. The vehicle gets them one after the other, each as a mission of its own, with the next one known
//! before it is at the present one.

use pcr_formats::import::Layout;
use pcr_formats::missions::{FleetMissions, MissionRequest};

/// What became of a mission.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum MissionOutcome {
    /// No vehicle has it yet.
    Open,
    /// A vehicle is on its way.
    Begun,
    /// It was done at this time \[s\].
    Done(f64),
    /// It was given up, and why.
    Refused(String),
}

/// A mission, and what has become of it so far.
#[derive(Clone, Debug)]
pub(super) struct OwnMission {
    pub(super) request: MissionRequest,
    pub(super) outcome: MissionOutcome,
    /// The vehicle that has it.
    pub(super) vehicle: Option<usize>,
    /// Time at which that vehicle got a route for it \[s\].
    pub(super) begun: Option<f64>,
    /// Times at which its stops were reached \[s\].
    pub(super) reached: Vec<f64>,
}

/// Where a vehicle waited for another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OwnWait {
    pub(super) vehicle: usize,
    /// The vehicle that had to go first.
    pub(super) other: usize,
    /// From when to when \[s\].
    pub(super) time: [f64; 2],
    /// Index of the edge on which it stood; `None` at a node.
    pub(super) edge: Option<usize>,
    /// Where it stood \[m\].
    pub(super) point: [f64; 2],
}

/// What a closure did to a vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClosureEffect {
    /// It was on the element, or too near to stop before it.
    Through,
    /// It got another route.
    Rerouted,
    /// It went elsewhere or stopped, and waits.
    Waits,
}

/// A closure or breakdown that has begun.
#[derive(Clone, Debug, Default)]
pub(super) struct OwnEvent {
    pub(super) is_begun: bool,
    pub(super) is_over: bool,
    /// Vehicles on whose routes it is, and what became of them.
    pub(super) effects: Vec<(usize, ClosureEffect)>,
    /// Where a vehicle that broke down stands: its edge, `None` at a node, and the point \[m\].
    pub(super) place: Option<(Option<usize>, [f64; 2])>,
}

/// The missions of a file.
#[derive(Clone, Debug)]
pub(super) struct OwnMissions {
    pub(super) fleet: FleetMissions,
    pub(super) missions: Vec<OwnMission>,
    /// The mission of each vehicle.
    pub(super) current: Vec<Option<usize>>,
    pub(super) waits: Vec<OwnWait>,
    /// What became of the closures and breakdowns of the file.
    pub(super) closures: Vec<OwnEvent>,
    pub(super) breakdowns: Vec<OwnEvent>,
    /// Time at which a stop was reached for the last time \[s\].
    pub(super) progress: f64,
    /// Names of the nodes and edges of the layout.
    pub(super) nodes: Vec<String>,
    pub(super) edges: Vec<String>,
}

impl OwnMissions {
    pub(super) fn new(fleet: &FleetMissions, layout: &Layout) -> Self {
        let missions = fleet.missions.iter().map(|request| OwnMission {
            request: request.clone(),
            outcome: MissionOutcome::Open,
            vehicle: None,
            begun: None,
            reached: Vec::new(),
        });
        let (missions, current) = (missions.collect(), vec![None; fleet.vehicles.len()]);
        let nodes = layout.nodes.iter().map(|node| node.id.to_string()).collect();
        let edges = layout.edges.iter().map(|edge| edge.id.to_string()).collect();
        let [closures, breakdowns] =
            [fleet.closures.len(), fleet.breakdowns.len()].map(|count| vec![OwnEvent::default(); count]);
        let (fleet, waits, progress) = (fleet.clone(), Vec::new(), 0.0);
        Self { fleet, missions, current, waits, closures, breakdowns, progress, nodes, edges }
    }

    /// Number of missions that are done or given up.
    pub(super) fn over(&self) -> usize {
        let is_over =
            |mission: &&OwnMission| matches!(mission.outcome, MissionOutcome::Done(_) | MissionOutcome::Refused(_));
        self.missions.iter().filter(is_over).count()
    }

    /// Whether every mission is done or given up.
    pub(super) fn is_over(&self) -> bool {
        self.over() == self.missions.len()
    }

    /// Whether missions will be released after this time.
    pub(super) fn is_to_come(&self, now: f64) -> bool {
        self.missions.iter().any(|mission| mission.outcome == MissionOutcome::Open && mission.request.release > now)
    }

    /// The node of the stop after the next one in the mission of a vehicle.
    pub(super) fn next_stop(&self, vehicle: usize) -> Option<usize> {
        let mission = &self.missions[self.current[vehicle]?];
        mission.request.stops.get(mission.reached.len() + 1).copied()
    }

    /// Gives a mission up.
    pub(super) fn refuse(&mut self, mission: usize, why: String) {
        self.missions[mission].outcome = MissionOutcome::Refused(why);
        self.current.iter_mut().filter(|current| **current == Some(mission)).for_each(|current| *current = None);
    }

    /// Notes that a vehicle waits for another one during a step.
    pub(super) fn wait(&mut self, wait: OwnWait) {
        /// Waits with a shorter time between them are one \[s\].
        const GAP: f64 = 0.5;
        let same = |last: &&mut OwnWait| {
            (last.vehicle, last.other, last.edge) == (wait.vehicle, wait.other, wait.edge)
                && wait.time[0] - last.time[1] < GAP
        };
        match self.waits.iter_mut().rev().take(64).find(same) {
            Some(last) => last.time[1] = wait.time[1],
            None => self.waits.push(wait),
        }
    }

    /// Whether closures or breakdowns begin or end after this time.
    pub(super) fn is_changing(&self, now: f64) -> bool {
        let closures = self.fleet.closures.iter().map(|it| (it.at, it.until));
        let breakdowns = self.fleet.breakdowns.iter().map(|it| (it.at, it.until));
        closures.chain(breakdowns).any(|(at, until)| at > now || until.is_some_and(|until| until > now))
    }
}
