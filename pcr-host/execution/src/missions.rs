//! Missions of one's own: the answer of `pcr traffic --missions`.

use crate::error::ExecutionError;
use crate::lifelong::site_changes::{self, BreakdownEntry, ClosureEntry};
use crate::lifelong::{MissionResult, MissionRun, RunCertificate, run_missions};
use pcr_formats::import::ImportedLayout;
use pcr_formats::missions::{FleetMissions, MissionRequest};
use pcr_formats::scenario::Scenario;
use pcr_planning::certify::MotionCertificate;
use serde::Serialize;

/// What became of missions. The JSON output, field for field in this order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MissionsReport {
    /// Name of the layout.
    pub layout: String,
    /// Number of missions that were done.
    pub done: usize,
    /// Number of these that were done after they were due.
    pub late: usize,
    /// Number of missions that were refused or given up.
    pub refused: usize,
    /// Time at which the last mission was done \[s\].
    pub makespan: f64,
    /// Result of the independent checker for the whole run.
    pub certificate: MotionCertificate,
    /// The missions, in the order of the file.
    pub missions: Vec<MissionEntry>,
    /// The vehicles, in the order of the file.
    pub vehicles: Vec<FleetVehicleEntry>,
    /// Where vehicles waited for others, in the order of time.
    pub waits: Vec<WaitEntry>,
    /// The closures, in the order of the file.
    pub closures: Vec<ClosureEntry>,
    /// The breakdowns, in the order of the file.
    pub breakdowns: Vec<BreakdownEntry>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
}

/// A mission in the timetable.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MissionEntry {
    /// Its name.
    pub id: String,
    /// Its vehicle; none if no vehicle began it.
    pub vehicle: Option<String>,
    /// Time at which its vehicle got a route for it \[s\].
    pub start: Option<f64>,
    /// Time at which it was done \[s\].
    pub finish: Option<f64>,
    /// How much later than it was due it was done \[s\]: 0 if it was in time; none without `due` or if it was not done.
    pub lateness: Option<f64>,
    /// Its stops, with the times at which they were reached.
    pub stops: Vec<StopEntry>,
    /// Reason why it was refused or given up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// A stop of a mission.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StopEntry {
    /// The node.
    pub node: String,
    /// When it was reached \[s\].
    pub time: Option<f64>,
}

/// A vehicle of the fleet.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FleetVehicleEntry {
    /// Its name.
    pub id: String,
    /// Number of missions that it did.
    pub missions: usize,
    /// Length that it travelled \[m\].
    pub length: f64,
    /// Node where it stands in the end; none on an edge.
    pub end: Option<String>,
}

/// A vehicle that waited for another one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WaitEntry {
    /// Who waited.
    pub vehicle: String,
    /// Who went first.
    #[serde(rename = "for")]
    pub first: String,
    /// From when \[s\].
    pub from: f64,
    /// Until when \[s\].
    pub until: f64,
    /// Edge on which it waited; none at a node.
    pub edge: Option<String>,
    /// Where it waited \[m\].
    pub x: f64,
    /// Where it waited \[m\].
    pub y: f64,
}

/// The proof of a run by its scenario, or, where the scenario is not proved, by what was recorded; and whether it is by the scenario.
fn certificate(run: &MissionRun) -> Result<(MotionCertificate, bool), ExecutionError> {
    let of_scenario = MotionCertificate::prove::<f64>(&run.scenario).map_err(ExecutionError::Certificate)?;
    if of_scenario.verdict == "proved" {
        return Ok((of_scenario, true));
    }
    let RunCertificate { verdict, steps, ref error, .. } = run.certificate;
    let (contacts, undecided, error) = (Vec::new(), Vec::new(), error.clone());
    Ok((MotionCertificate { verdict, steps, contacts, undecided, error, ..of_scenario }, false))
}

impl MissionsReport {
    /// Runs the missions of a fleet on a layout. Also returns the run as a scenario, unless rounding moves its turns in place, so that it is
    /// not proved as a scenario. `told` gets the simulated time \[s\] and the number of
    /// missions that are over.
    ///
    /// # Errors
    /// Vehicles that touch where they start, or an edge that a vehicle cannot drive.
    pub fn run(
        imported: &ImportedLayout,
        fleet: &FleetMissions,
        told: &dyn Fn(f64, usize),
    ) -> Result<(Self, Option<Scenario>), ExecutionError> {
        let run = run_missions(imported, fleet, told)?;
        let (certificate, is_exact) = certificate(&run)?;
        let node = |place: usize| imported.layout.nodes[place].id.to_string();
        let id = |vehicle: usize| fleet.vehicles[vehicle].id.clone();
        let missions: Vec<MissionEntry> = fleet
            .missions
            .iter()
            .zip(&run.missions)
            .map(|(request, result)| MissionEntry::new(request, result, result.vehicle.map(id), node))
            .collect();
        let vehicles = fleet.vehicles.iter().enumerate().map(|(vehicle, it)| FleetVehicleEntry {
            id: it.id.clone(),
            missions: run.missions.iter().filter(|done| done.vehicle == Some(vehicle) && done.reason.is_none()).count(),
            length: run.scenario.agents[vehicle].length(),
            end: run.ends[vehicle].map(node),
        });
        let waits = run.waits.iter().map(|wait| WaitEntry {
            vehicle: id(wait.vehicle),
            first: id(wait.first),
            from: wait.time[0],
            until: wait.time[1],
            edge: wait.edge.clone(),
            x: wait.point[0],
            y: wait.point[1],
        });
        let (closures, breakdowns) = site_changes::entries(&imported.layout, &fleet.changes, &run.changes, id);
        let report = Self {
            closures,
            breakdowns,
            layout: imported.layout.name.clone(),
            done: missions.iter().filter(|mission| mission.finish.is_some()).count(),
            late: missions.iter().filter(|mission| mission.lateness.is_some_and(|late| late > 0.0)).count(),
            refused: missions.iter().filter(|mission| mission.finish.is_none()).count(),
            makespan: missions.iter().filter_map(|mission| mission.finish).fold(0.0, f64::max),
            certificate,
            vehicles: vehicles.collect(),
            waits: waits.collect(),
            missions,
            warnings: imported.layout.warnings.clone(),
        };
        let MissionRun { mut scenario, .. } = run;
        scenario.warnings.clone_from(&imported.layout.warnings);
        Ok((report, is_exact.then_some(scenario)))
    }

    /// Whether all missions were done, and the run is proved to be free of contact.
    pub fn is_sound(&self) -> bool {
        self.refused == 0 && self.certificate.verdict == "proved"
    }
}

impl MissionEntry {
    fn new(
        request: &MissionRequest,
        result: &MissionResult,
        vehicle: Option<String>,
        node: impl Fn(usize) -> String,
    ) -> Self {
        let times = (0..request.stops.len()).map(|stop| result.reached.get(stop).copied());
        let stops = request.stops.iter().zip(times).map(|(&stop, time)| StopEntry { node: node(stop), time });
        let finish = result.reached.get(request.stops.len() - 1).copied();
        let lateness = finish.zip(request.due).map(|(finish, due)| f64::max(0.0, finish - due));
        Self {
            id: request.id.clone(),
            vehicle,
            start: result.start,
            finish,
            lateness,
            stops: stops.collect(),
            reason: result.reason.clone(),
        }
    }
}

#[cfg(test)]
mod tests;
