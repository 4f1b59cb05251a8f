//! Runs the supervisor with its journal, clients and page.

use super::super::brokers::AT_BROKERS;
use super::super::printed::{notes, quiet};
use super::super::{CliError, NOT_WRITTEN, WRONG_INPUT};
use super::demo::BrokerDemo;
use super::threads::thread;
use super::{ServeArgs, bridge, listen, page, standby};
use pcr_serve::journal::{Journal, JournalContents};
use pcr_serve::journal_entry::{JournalStore, NullStore};
use pcr_serve::journal_writer::{JournalWriter, WriteProgress};
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::server::{ServerHandle, ServerInput, queue, serve};
use pcr_serve::supervisor::{Supervisor, SupervisorConfig};
use pcr_serve::{clients, http};
use std::io::{ErrorKind, Write};
use std::process::ExitCode;
use std::sync::mpsc::{Sender, channel};
use std::thread;

pub(super) fn run(arguments: ServeArgs) -> Result<ExitCode, CliError> {
    let settings = settings(&arguments)?;
    listen::check(&arguments)?;
    let log = log_of(&arguments)?;
    let demo = arguments.demo.as_deref().map(|layout| BrokerDemo::start(layout, &arguments, log)).transpose()?;
    let (handle, inputs) = queue();
    let waited = match standby::wait(&arguments, log)? {
        Some(waited) => waited,
        // It was ended while it waited.
        None => return Ok(ExitCode::SUCCESS),
    };
    let (mut supervisor, kept) = open(&arguments, settings, &handle, waited.journal, log)?;
    if let Some(demo) = &demo {
        supervisor.draw(demo.drawn().clone()).map_err(|fault| CliError::Error(fault.to_string(), NOT_WRITTEN))?;
    }
    let ends = match &demo {
        Some(demo) => Some(bridge::start(&handle, &mut supervisor, demo.fleet(), log)?),
        None => bridge::BridgeFleetConfig::of(&arguments, log)?
            .map(|fleet| bridge::start(&handle, &mut supervisor, fleet, log))
            .transpose()?,
    };
    let _sockets = listen::start(&arguments, &handle, log)?;
    let readiness = ends.as_ref().map(bridge::BridgeThread::readiness);
    if let Some((address, late)) = waited.page {
        // It is asked already; nobody else has put anything there.
        let _ = late.set((handle.clone(), page::content(Some(address), readiness)));
    } else if let Some(listener) =
        page::place(&arguments).map(|place| listen::patient(&arguments, || page::listener(place, log))).transpose()?
    {
        let url = listener.local_addr().map_or_else(|_| String::new(), |address| format!("http://{address}/"));
        match demo {
            Some(_) => writeln!(notes(), "pcr: open {url} in a browser; Ctrl-C ends the demo")?,
            None => log.write(LogLevel::Info, "page", &[("url", &url)]),
        }
        let content = page::content(listener.local_addr().ok(), readiness);
        let handle = handle.clone();
        thread("page", move || http::listen(&handle, &listener.into(), content, log))?;
    }
    // Standard input may end while a standby waits.
    let stays = arguments.stay || arguments.standby || demo.is_some();
    let (failed, failures) = channel();
    let last = StopOnStdinEnd { handle: handle.clone(), stays, failed: failed.clone(), log };
    let unheard = StopOnStdoutError { handle: handle.clone(), stays, failed, log };
    thread("lines", move || {
        let lost = move |error| unheard.tell(error);
        if let Err(error) = clients::serve(&last.handle, std::io::stdin(), std::io::stdout(), lost) {
            last.fails(error.to_string());
        }
    })?;
    interrupted(handle)?;
    let served = serve(&mut supervisor, &inputs, &kept, log);
    drop(inputs);
    // The bridge and the demo end in order, whatever has ended this.
    let ended = ends.map_or(Ok(()), bridge::BridgeThread::end);
    let done = demo.map_or(Ok(()), BrokerDemo::end);
    served.map_err(|fault| CliError::Error(fault.to_string(), NOT_WRITTEN))?;
    ended.and(done)?;
    match failures.try_recv() {
        Ok(stop) => Err(stop),
        Err(_) => Ok(ExitCode::SUCCESS),
    }
}

/// Ends the supervisor when standard input has ended, unless it is to stay, and when it cannot be read. Why is told before.
struct StopOnStdinEnd {
    handle: ServerHandle,
    stays: bool,
    failed: Sender<CliError>,
    log: LogWriter,
}

impl StopOnStdinEnd {
    fn fails(&self, why: String) {
        let _ = self.failed.send(CliError::Error(format!("standard input: not read: {why}"), WRONG_INPUT));
        self.handle.send(ServerInput::Stop);
    }
}

impl Drop for StopOnStdinEnd {
    fn drop(&mut self) {
        if thread::panicking() {
            self.fails("there is no memory for its thread".into());
        } else if !self.stays {
            self.log.write(LogLevel::Info, "standard input has ended; --stay goes on without it", &[]);
            self.handle.send(ServerInput::Stop);
        }
    }
}

/// Ends the supervisor when standard output cannot be written, unless it is to stay: robots and other clients still need it then.
struct StopOnStdoutError {
    handle: ServerHandle,
    stays: bool,
    failed: Sender<CliError>,
    log: LogWriter,
}

impl StopOnStdoutError {
    fn tell(self, error: std::io::Error) {
        // A reader who goes is no error, as for other commands.
        let level = if error.kind() == ErrorKind::BrokenPipe { LogLevel::Warn } else { LogLevel::Error };
        self.log.write(
            level,
            "standard output cannot be written: answers to standard input are lost",
            &[("why", &error)],
        );
        if !self.stays {
            let _ = self.failed.send(error.into());
            self.handle.send(ServerInput::Stop);
        }
    }
}

/// What the command line says, and what is usual where it says nothing.
pub(super) fn settings(arguments: &ServeArgs) -> Result<SupervisorConfig, CliError> {
    let usual = SupervisorConfig::default();
    let at_broker = arguments.broker.is_some() || arguments.demo.is_some();
    let (width, lookahead) = if at_broker { AT_BROKERS } else { (usual.position_uncertainty, usual.lookahead) };
    let within = |name: &str, value: f64, lo: f64, hi: f64| match (lo..=hi).contains(&value) {
        true => Ok(value),
        false => {
            let whose = if at_broker { " for vehicles of VDA 5050" } else { "" };
            Err(CliError::arguments(format!("{name}: allowed is {lo} to {hi}{whose}")))
        }
    };
    let least = |usual: f64, other: f64| if at_broker { usual } else { other };
    Ok(SupervisorConfig {
        position_uncertainty: within("--width", arguments.width.unwrap_or(width), least(width, 0.001), 10.0)?,
        lookahead: within("--lookahead", arguments.lookahead.unwrap_or(lookahead), least(lookahead, 0.1), 600.0)?,
        report_timeout: within("--silence", arguments.silence, 0.1, 86400.0)?,
        ..usual
    })
}

pub(super) fn log_of(arguments: &ServeArgs) -> Result<LogWriter, CliError> {
    let level = match &arguments.log {
        Some(_) if quiet() => {
            return Err(CliError::arguments("--log has no effect: with --quiet only errors are told"));
        }
        Some(level) => level.parse().map_err(|why| CliError::arguments(format!("--log: {why}")))?,
        None if quiet() => LogLevel::Error,
        None => LogLevel::Info,
    };
    Ok(LogWriter::new(level))
}

/// Ctrl-C and its like end it in order.
fn interrupted(handle: ServerHandle) -> Result<(), CliError> {
    #[cfg(unix)]
    {
        use signal_hook::consts::{SIGINT, SIGTERM};
        let flag = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM] {
            // Where it cannot be caught, it ends the program as it does others: the journal bears that.
            let _ = signal_hook::flag::register(signal, flag.clone());
        }
        thread("signals", move || {
            while !flag.load(std::sync::atomic::Ordering::Relaxed) {
                thread::sleep(std::time::Duration::from_millis(50));
            }
            handle.send(ServerInput::Stop);
        })?;
    }
    #[cfg(not(unix))]
    drop(handle);
    Ok(())
}

fn open(
    arguments: &ServeArgs,
    settings: SupervisorConfig,
    handle: &ServerHandle,
    taken_over: Option<(Journal, JournalContents)>,
    log: LogWriter,
) -> Result<(Supervisor, WriteProgress), CliError> {
    let Some(folder) = &arguments.journal else {
        log.write(
            LogLevel::Warn,
            "no --journal: nothing outlives this program, and robots must stand when it starts",
            &[],
        );
        let keeper: Box<dyn JournalStore> = Box::new(NullStore);
        return Ok((Supervisor::new(settings, keeper), WriteProgress::default()));
    };
    let (journal, found) = match taken_over {
        Some(taken_over) => taken_over,
        None => Journal::open(folder).map_err(|error| standby::unopened(folder, error))?,
    };
    if found.torn > 0 {
        log.write(
            LogLevel::Warn,
            "the end of the journal was cut off, and is left out: nobody was told of it",
            &[("bytes", &found.torn)],
        );
    }
    if let Some(former) = &found.former {
        let what = "the journal was of the version before, and is of the present one now; as it was, it is";
        log.write(LogLevel::Info, what, &[("file", &former.display())]);
    }
    let own = handle.clone();
    let writer =
        JournalWriter::start(Box::new(journal), move || own.wake()).map_err(|error| CliError::wrong(folder, error))?;
    let kept = writer.kept();
    let supervisor = Supervisor::restored(settings, found.entries, Box::new(writer));
    let supervisor = supervisor.map_err(|damaged| CliError::wrong(folder, damaged))?;
    log.write(LogLevel::Info, "ready", &[("robots", &supervisor.robots().len())]);
    Ok((supervisor, kept))
}
