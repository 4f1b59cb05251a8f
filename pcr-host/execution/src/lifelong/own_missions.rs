//! Missions of a file: which vehicle does which one, and how far each has come.
//!
//! A mission is a list of stops. The vehicle gets them one after the other, each as a mission of its own, with the next one known
//! before it is at the present one.

use super::stretch::StretchSequence;
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
    /// Vehicles that can never do it.
    pub(super) unable: Vec<usize>,
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

/// The missions of a file.
#[derive(Clone, Debug)]
pub(super) struct OwnMissions {
    pub(super) fleet: FleetMissions,
    pub(super) missions: Vec<OwnMission>,
    /// The mission of each vehicle.
    pub(super) current: Vec<Option<usize>>,
    pub(super) waits: Vec<OwnWait>,
    /// Time at which a stop was reached for the last time \[s\].
    pub(super) progress: f64,
    /// For each vehicle whether it stands where it can never leave, and the place for which that is known.
    pub(super) is_parked: Vec<bool>,
    pub(super) looked_at: Vec<Option<usize>>,
    pub(super) shunting: StretchSequence,
    /// Whether vehicles can come to a node from which they cannot come back.
    pub(super) is_one_way: bool,
}

impl OwnMissions {
    pub(super) fn new(fleet: &FleetMissions, is_one_way: bool) -> Self {
        let missions = fleet.missions.iter().map(|request| OwnMission {
            request: request.clone(),
            outcome: MissionOutcome::Open,
            vehicle: None,
            begun: None,
            reached: Vec::new(),
            unable: Vec::new(),
        });
        let (missions, current) = (missions.collect(), vec![None; fleet.vehicles.len()]);
        let count = fleet.vehicles.len();
        Self {
            fleet: fleet.clone(),
            missions,
            current,
            waits: Vec::new(),
            progress: 0.0,
            is_parked: vec![false; count],
            looked_at: vec![None; count],
            shunting: StretchSequence::default(),
            is_one_way,
        }
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
}
