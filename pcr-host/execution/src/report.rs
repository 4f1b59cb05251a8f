//! Results as text: JSON and CSV for programs, tables for people.

mod lifelong;
mod missions;
mod simulation;
mod site_changes;
mod traffic;

pub use lifelong::{LIFELONG_CSV_HEADER, lifelong_csv, lifelong_table};
pub use missions::{MISSIONS_CSV_HEADER, missions_csv, missions_table};
pub use simulation::{simulation_csv, simulation_table};
pub use traffic::{TRAFFIC_CSV_HEADER, traffic_csv, traffic_table};

use crate::lifelong::LifelongReport;
use crate::missions::MissionsReport;
use crate::simulate::SimulationReport;
use crate::traffic::TrafficReport;
use pcr_planning::report::VersionedReport;

impl VersionedReport for SimulationReport {
    const FORMAT: &'static str = "pcr-simulation";
}
impl VersionedReport for TrafficReport {
    const FORMAT: &'static str = "pcr-traffic";
}
impl VersionedReport for MissionsReport {
    const FORMAT: &'static str = "pcr-missions";
}
impl VersionedReport for LifelongReport {
    const FORMAT: &'static str = "pcr-lifelong";
}
