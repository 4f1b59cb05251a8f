//! Waits while another supervisor has the journal open.

use super::super::{CliError, NOT_WRITTEN};
use super::bridge::BridgeFleetConfig;
use super::threads::thread;
use super::{ServeArgs, page};
use pcr_serve::http::{self, LateSupervisor};
use pcr_serve::journal::{Journal, JournalContents};
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::standby::Standby;
use std::io::ErrorKind;
use std::net::{SocketAddr, TcpListener};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::Duration;

/// Time between two attempts to take over.
const PAUSE: Duration = Duration::from_millis(50);

/// What a supervisor goes on with that has waited for its turn, or need not wait.
#[derive(Default)]
pub(super) struct Waited {
    pub(super) journal: Option<(Journal, JournalContents)>,
    /// The page that it has shown meanwhile.
    pub(super) page: Option<(SocketAddr, LateSupervisor)>,
}

/// Waits until nobody else has the journal open, if it is a standby; `None`: it was told to end.
pub(super) fn wait(arguments: &ServeArgs, log: LogWriter) -> Result<Option<Waited>, CliError> {
    let (true, Some(folder)) = (arguments.standby, &arguments.journal) else { return Ok(Some(Waited::default())) };
    let wrong = |error| unopened(folder, error);
    let mut standby = Standby::new(folder).map_err(wrong)?;
    if let Some(opened) = standby.take_over().map_err(wrong)? {
        return Ok(Some(Waited { journal: Some(opened), page: None }));
    }
    // What is wrong with them is better known now. They are read again later.
    drop(BridgeFleetConfig::of(arguments, log)?);
    let ends = signals();
    let page = page::place(arguments).and_then(|place| shown(place, log).transpose()).transpose()?;
    let mut follows = Follows { folder, log, is_told: false, fault: None };
    loop {
        follows.look(&mut standby);
        // Once more after each look, which takes longer the more there is to read.
        if let Some(opened) = standby.take_over().map_err(wrong)? {
            let what = "the other supervisor has ended: this one takes over";
            log.write(LogLevel::Warn, what, &[("entries", &opened.1.entries.len())]);
            return Ok(Some(Waited { journal: Some(opened), page }));
        }
        if ends.load(Ordering::Relaxed) {
            return Ok(None);
        }
        sleep(PAUSE);
    }
}

/// Says in the log what it follows.
struct Follows<'a> {
    folder: &'a Path,
    log: LogWriter,
    is_told: bool,
    fault: Option<String>,
}

impl Follows<'_> {
    fn look(&mut self, standby: &mut Standby) {
        let fault = standby.follow().err();
        let log = |level, what, more: (&str, &dyn std::fmt::Display)| {
            self.log.write(level, what, &[("journal", &self.folder.display()), more]);
        };
        match &fault {
            Some(why) if fault != self.fault => {
                log(LogLevel::Error, "standby: the journal could not be gone on with as it is", ("why", why));
            }
            None if self.fault.is_some() || !self.is_told => {
                let what = "standby: another supervisor is at work, and its journal is followed";
                log(LogLevel::Info, what, ("robots", &standby.robots()));
                self.is_told = true;
            }
            _ => {}
        }
        self.fault = fault;
    }
}

/// The page of a standby; `None` where another program is: the supervisor at work has the same, on the same machine.
fn shown(place: &str, log: LogWriter) -> Result<Option<(SocketAddr, LateSupervisor)>, CliError> {
    let listener: TcpListener = match page::listener(place, log) {
        Ok(listener) => listener,
        Err(CliError::Error(why, _)) => {
            let what = "no page while it waits; another port, where it says that it is a standby, can be watched";
            log.write(LogLevel::Warn, what, &[("why", &why)]);
            return Ok(None);
        }
        Err(other) => return Err(other),
    };
    let address = listener.local_addr()?;
    let (late, site) = (LateSupervisor::default(), page::content(Some(address), None));
    let own = Arc::clone(&late);
    thread("page", move || http::listen_late(&own, &listener.into(), site, log))?;
    Ok(Some((address, late)))
}

/// The error of a journal that cannot be opened.
pub(super) fn unopened(folder: &Path, error: std::io::Error) -> CliError {
    match error.kind() {
        // Whoever has it open, or has damaged it, is not the disc.
        ErrorKind::WouldBlock | ErrorKind::InvalidData => CliError::wrong(folder, error),
        _ => CliError::Error(
            format!("the journal cannot be opened, so no robot gets the right of way: {error}"),
            NOT_WRITTEN,
        ),
    }
}

/// Whether it was told to end. A signal that tells it to read the file of vehicles again is one for the supervisor at work.
fn signals() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    #[cfg(unix)]
    {
        use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
        for signal in [SIGINT, SIGTERM] {
            // Where it cannot be caught, it ends the program as it does others.
            let _ = signal_hook::flag::register(signal, flag.clone());
        }
        let _ = signal_hook::flag::register(SIGHUP, Arc::default());
    }
    flag
}
