//! Results as text: JSON and CSV for programs, tables for people.

mod lifelong;
mod simulation;
mod traffic;

pub use lifelong::{LIFELONG_CSV_HEADER, lifelong_csv, lifelong_table};
pub use simulation::{simulation_csv, simulation_table};
pub use traffic::{TRAFFIC_CSV_HEADER, traffic_csv, traffic_table};

use crate::lifelong::Lifelong;
use crate::simulate::Simulation;
use crate::traffic::Traffic;
use pcr_planning::report::Document;

impl Document for Simulation {
    const FORMAT: &'static str = "pcr-simulation";
}
impl Document for Traffic {
    const FORMAT: &'static str = "pcr-traffic";
}
impl Document for Lifelong {
    const FORMAT: &'static str = "pcr-lifelong";
}
