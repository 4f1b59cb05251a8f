//! The command `pcr`: its exit statuses, and nothing else.

mod commands;

use clap::Parser;
use commands::{Arguments, Stop, complain};
use std::process::ExitCode;

fn main() -> ExitCode {
    match Arguments::parse().run() {
        Ok(status) => status,
        Err(Stop::Closed) => ExitCode::SUCCESS,
        Err(Stop::Error(message, status)) => {
            complain(&message);
            ExitCode::from(status)
        }
    }
}
