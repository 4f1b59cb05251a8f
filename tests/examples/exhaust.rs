//! The functions of docs/errors.md that are held by trying every input:
//!
//! ```text
//! cargo run --release -p pcr-tests --example exhaust -- [turns-sine] [f32-arctangent] [f32-sine]
//! ```
//!
//! Prints the largest errors; the exit status is 1 if one is beyond its bound.

use pcr_tests::exhaust::{RUNS, within};
use std::process::ExitCode;

fn main() -> ExitCode {
    let asked: Vec<_> = std::env::args().skip(1).collect();
    let mut held = true;
    for run in RUNS.iter().filter(|run| asked.is_empty() || asked.iter().any(|name| name == run.name)) {
        let worst = run.worst(1);
        for ((figure, worst), bound) in run.figures.iter().zip(worst).zip(run.bounds) {
            println!("{}: {figure} {worst:.4}, bound {bound}", run.name);
        }
        held &= within(worst, run.bounds);
    }
    if held && asked.iter().all(|name| RUNS.iter().any(|run| run.name == name)) {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
