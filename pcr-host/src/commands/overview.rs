//! `pcr` alone: the paper's simulation.

use super::map::draw;
use super::{Stop, paper12};
use pcr_host::fleet::Fleet;
use pcr_host::regions::{self, Answer, Failure, Request};
use pcr_host::report;
use std::io;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// Directory for the pictures.
const DIRECTORY: &str = "pcr-out";

pub(super) fn run() -> Result<ExitCode, Stop> {
    let scenario = paper12()?;
    let fleet = Fleet::<f64>::new(&scenario).map_err(Failure::from)?;
    let motions = fleet.motions();
    let begin = Instant::now();
    regions::table(&scenario, &motions)?;
    let took = begin.elapsed();
    let answer = Answer::of::<f64>(&scenario, Request::default())?;
    let mut out = io::stdout().lock();
    report::overview(&scenario, &answer, took, &mut out)?;
    draw(&scenario, None, Path::new(DIRECTORY), &mut out)?;
    Ok(ExitCode::SUCCESS)
}
