//! `pcr serve --check`: what would be wrong at the start, without a start. Nothing is written, and no vehicle is told anything.

use super::super::{CliError, WRONG_INPUT};
use super::bridge::{self, BridgeFleetConfig};
use super::listen::{self, ListenAddress};
use super::{ServeArgs, run};
use pcr_serve::journal;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::log::LogWriter;
use pcr_serve::supervisor::{Supervisor, SupervisorConfig};
use pcr_serve::vda5050::mqtt::{BrokerAddress, LinkEvent, MqttLink};
use std::fs::{File, TryLockError};
use std::io::{ErrorKind, Write};
use std::net::TcpListener;
use std::path::Path;
use std::process::ExitCode;
use std::sync::mpsc::channel;
use std::time::Duration;

/// Time in which the broker has to answer.
const PATIENCE: Duration = Duration::from_secs(5);

/// Prints what would be wrong, a line each.
pub(super) fn check(arguments: &ServeArgs) -> Result<ExitCode, CliError> {
    let log = run::log_of(arguments)?;
    let settings = run::settings(arguments)?;
    listen::check(arguments)?;
    let (mut right, mut wrong) = (Vec::new(), Vec::new());
    let fleet = note(BridgeFleetConfig::of(arguments, log), &mut wrong)?.flatten();
    if let Some(fleet) = &fleet {
        right.push(format!("vehicles: {}", fleet.profiles.len()));
        match reached(&fleet.broker) {
            Ok(()) => right.push("the broker lets it in".into()),
            Err(why) => wrong.push(format!("--broker: {}:{}: {why}", fleet.broker.host, fleet.broker.port)),
        }
    }
    if let Some(folder) = &arguments.journal
        && let Some(found) = note(journal(folder, settings, fleet.as_ref(), log), &mut wrong)?
    {
        right.push(found);
    }
    if let Some(place) = &arguments.page {
        note(free("--page", place), &mut wrong)?;
    }
    for place in &arguments.listen {
        match place {
            ListenAddress::Tcp(place) => drop(note(free("--listen", place), &mut wrong)?),
            ListenAddress::Unix(path) => {
                let of_journal = || arguments.journal.as_ref().map(|folder| folder.join("socket"));
                note(unheard(&path.clone().or_else(of_journal).unwrap_or_default()), &mut wrong)?;
            }
        }
    }
    let mut out = std::io::stdout().lock();
    right.iter().try_for_each(|line| writeln!(out, "{line}"))?;
    wrong.iter().try_for_each(|line| writeln!(out, "wrong: {line}"))?;
    if wrong.is_empty() {
        writeln!(out, "nothing is wrong")?;
    }
    Ok(if wrong.is_empty() { ExitCode::SUCCESS } else { ExitCode::from(WRONG_INPUT) })
}

/// The result, or a note of what is wrong.
fn note<T>(result: Result<T, CliError>, wrong: &mut Vec<String>) -> Result<Option<T>, CliError> {
    match result {
        Ok(value) => Ok(Some(value)),
        Err(CliError::Error(why, _)) => {
            wrong.push(why);
            Ok(None)
        }
        Err(other) => Err(other),
    }
}

/// Whether the broker lets it in: address, certificate, name and password. What it may read and write there is not tried.
fn reached(broker: &BrokerAddress) -> Result<(), String> {
    let (sender, news) = channel();
    let id = format!("pcr-check-{}", std::process::id());
    let link = MqttLink::open(broker, &id, None, Vec::new(), move |it| drop(sender.send(it)));
    let link = link.map_err(|error| error.to_string())?;
    let told = news.recv_timeout(PATIENCE);
    match told {
        Ok(LinkEvent::Down(why)) => Err(why),
        Ok(LinkEvent::Up | LinkEvent::Message { .. }) => {
            link.close();
            Ok(())
        }
        Err(_) => Err(format!("no answer in {} s", PATIENCE.as_secs())),
    }
}

/// What is in the journal, which stays as it is.
fn journal(
    folder: &Path,
    settings: SupervisorConfig,
    fleet: Option<&BridgeFleetConfig>,
    log: LogWriter,
) -> Result<String, CliError> {
    let wrong = |error: std::io::Error| CliError::wrong(folder, error);
    match File::open(folder.join("lock")) {
        Ok(lock) => match lock.try_lock_shared() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(CliError::wrong(folder, "another supervisor has it open")),
            Err(TryLockError::Error(error)) => return Err(wrong(error)),
        },
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        Err(error) => return Err(wrong(error)),
    }
    let bytes = match std::fs::read(folder.join("journal")) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == ErrorKind::NotFound => {
            return Ok("journal: there is none yet; robots must stand at the start".into());
        }
        Err(error) => return Err(wrong(error)),
    };
    let found = journal::read(&bytes).map_err(|damage| CliError::wrong(folder, damage))?;
    let version = if found.is_former { ", of the version before: the start converts it" } else { "" };
    let supervisor = Supervisor::restored(settings, found.entries, Box::new(NullStore))
        .map_err(|damage| CliError::wrong(folder, damage))?;
    if let Some(fleet) = fleet {
        bridge::known(&supervisor, &fleet.profiles, log)?;
    }
    Ok(format!("journal: {} robots{version}", supervisor.robots().len()))
}

/// Whether nobody listens at a port.
fn free(option: &str, place: &str) -> Result<(), CliError> {
    let wrong = |error: std::io::Error| CliError::arguments(format!("{option}: {place}: {error}"));
    let addresses = listen::addresses(place).map_err(wrong)?;
    TcpListener::bind(&addresses[..]).map(drop).map_err(wrong)
}

/// Whether nobody listens at a socket.
fn unheard(path: &Path) -> Result<(), CliError> {
    #[cfg(unix)]
    if std::os::unix::net::UnixStream::connect(path).is_ok() {
        return Err(CliError::arguments(format!("--listen: {}: another program listens there", path.display())));
    }
    #[cfg(not(unix))]
    let _ = path;
    Ok(())
}
