//! Threads of the supervisor.

use super::super::{CliError, WRONG_INPUT};
use std::thread::{Builder, JoinHandle};

/// A thread for some work, or why there is none.
pub(super) fn thread<T: Send + 'static>(
    name: &str,
    work: impl FnOnce() -> T + Send + 'static,
) -> Result<JoinHandle<T>, CliError> {
    let started = Builder::new().name(name.to_owned()).spawn(work);
    started.map_err(|error| CliError::Error(format!("no thread can be started for {name}: {error}"), WRONG_INPUT))
}
