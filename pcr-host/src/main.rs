//! The command `pcr`; this file only sets its exit status.

mod abort;
mod commands;
mod progress;

use commands::{CliError, complain};
use std::process::ExitCode;

fn main() -> ExitCode {
    match commands::run(std::env::args_os().collect()) {
        Ok(status) => status,
        Err(CliError::Closed) => ExitCode::SUCCESS,
        Err(CliError::Usage(error)) => {
            // Where standard error is closed, the exit status has to do.
            let _ = error.print();
            ExitCode::from(2)
        }
        Err(CliError::Error(message, status)) => {
            pcr_formats::output::remove_empty_folders();
            complain(&message);
            ExitCode::from(status)
        }
    }
}
