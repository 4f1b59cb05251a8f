//! The command `pcr`; this file only sets its exit status.

mod abort;
mod commands;
mod progress;

use commands::{Stop, complain};
use std::process::ExitCode;

fn main() -> ExitCode {
    match commands::run(std::env::args_os().collect()) {
        Ok(status) => status,
        Err(Stop::Closed) => ExitCode::SUCCESS,
        Err(Stop::Usage(error)) => {
            // Where standard error is closed, the exit status has to do.
            let _ = error.print();
            ExitCode::from(2)
        }
        Err(Stop::Error(message, status)) => {
            pcr_formats::output::remove_empty_folders();
            complain(&message);
            ExitCode::from(status)
        }
    }
}
