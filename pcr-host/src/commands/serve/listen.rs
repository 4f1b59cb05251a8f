//! Where clients of the lines connect, and what they have to know.

use super::super::CliError;
use super::threads::thread;
use super::{ServeArgs, bound};
use pcr_serve::clients::{self, Access};
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::server::ServerHandle;
use pcr_serve::sockets::Listener;
#[cfg(unix)]
use pcr_serve::sockets::SocketFile;
use pcr_serve::token::Token;
use std::net::{SocketAddr, ToSocketAddrs};
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// What stands for the socket in the folder of the journal.
pub(super) const USUAL: &str = "unix:";

/// Where to listen.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum ListenAddress {
    /// At a Unix socket; `None`: in the folder of the journal.
    Unix(Option<PathBuf>),
    /// At an address, as it is written.
    Tcp(String),
}

/// Reads a place.
pub(super) fn place(text: &str) -> Result<ListenAddress, String> {
    match text.strip_prefix(USUAL) {
        Some("") => Ok(ListenAddress::Unix(None)),
        Some(path) => Ok(ListenAddress::Unix(Some(path.into()))),
        None => super::parse_listen_address(text).map(ListenAddress::Tcp).map_err(|why| format!("unix:PATH, {why}")),
    }
}

/// Checks the options that belong together.
pub(super) fn check(arguments: &ServeArgs) -> Result<(), CliError> {
    let wrong = |why: &str| Err(CliError::arguments(why));
    let has = |which: fn(&ListenAddress) -> bool| arguments.listen.iter().any(which);
    if has(|place| *place == ListenAddress::Unix(None)) && arguments.journal.is_none() {
        return wrong("--listen: the socket is in the folder of --journal, which is not given; or --listen unix:PATH");
    }
    let has_tcp = has(|place| matches!(place, ListenAddress::Tcp(_)));
    if has_tcp && token_file(arguments).is_none() {
        return wrong(
            "--listen: clients over TCP need a token: --journal DIR keeps it in DIR/token, or --token-file FILE says where",
        );
    }
    if !has_tcp && arguments.token_file.is_some() {
        return wrong("--token-file has no effect: only clients over TCP need a token");
    }
    if !has_tcp && arguments.allow_remote {
        return wrong("--allow-remote has no effect: --listen names no address");
    }
    Ok(())
}

fn token_file(arguments: &ServeArgs) -> Option<PathBuf> {
    let of_journal = arguments.journal.as_ref().map(|folder| folder.join("token"));
    arguments.token_file.clone().or(of_journal)
}

/// The files of sockets, which are removed at the end.
pub(super) struct Sockets(#[cfg(unix)] Vec<SocketFile>);

/// Takes clients at all places, each in a thread of its own.
pub(super) fn start(arguments: &ServeArgs, handle: &ServerHandle, log: LogWriter) -> Result<Sockets, CliError> {
    let mut sockets = Sockets(
        #[cfg(unix)]
        Vec::new(),
    );
    for place in &arguments.listen {
        let (listener, access) = match place {
            ListenAddress::Tcp(place) => patient(arguments, || tcp(arguments, place, log))?,
            ListenAddress::Unix(path) => {
                let of_journal = || arguments.journal.as_ref().map(|folder| folder.join("socket"));
                let path = path.clone().or_else(of_journal).unwrap_or_default();
                (patient(arguments, || sockets.bind(&path, log))?, Access::new(None))
            }
        };
        let handle = handle.clone();
        thread("clients", move || clients::listen(&handle, &listener, access, log))?;
    }
    Ok(sockets)
}

impl Sockets {
    #[cfg(unix)]
    fn bind(&mut self, path: &Path, log: LogWriter) -> Result<Listener, CliError> {
        let (listener, file) =
            SocketFile::bind(path).map_err(|error| CliError::arguments(format!("--listen: {error}")))?;
        self.0.push(file);
        log.write(LogLevel::Info, "listening", &[("for", &"--listen"), ("socket", &path.display())]);
        Ok(listener)
    }

    #[cfg(not(unix))]
    fn bind(&mut self, _: &Path, _: LogWriter) -> Result<Listener, CliError> {
        Err(CliError::arguments(
            "--listen: there are no Unix sockets on this system: --listen PORT takes clients over TCP",
        ))
    }
}

/// Listens at an address. Others than this machine reach it only where the arguments say so.
fn tcp(arguments: &ServeArgs, place: &str, log: LogWriter) -> Result<(Listener, Access), CliError> {
    let wrong = |why: String| CliError::arguments(format!("--listen: {place}: {why}"));
    let addresses = addresses(place).map_err(|error| wrong(error.to_string()))?;
    let is_remote = !addresses.iter().all(|address| address.ip().to_canonical().is_loopback());
    if is_remote && !arguments.allow_remote {
        return Err(wrong(
            "other machines can reach this address, and neither the token nor the lines are encrypted: --allow-remote if the network is yours \
             alone, or a tunnel (ssh -L) to a port of this machine"
                .into(),
        ));
    }
    let file = token_file(arguments).unwrap_or_default();
    let token = Token::at(&file).map_err(|error| CliError::arguments(format!("--token-file: {error}")))?;
    let listener = bound("--listen", place, &addresses, &[("token", &file.display())], log)?;
    if is_remote {
        log.write(
            LogLevel::Warn,
            "other machines can reach the lines, which are not encrypted",
            &[("address", &place)],
        );
    }
    Ok((listener.into(), Access::new(Some(token))))
}

/// The addresses of a place: of this machine only, if none is written.
pub(super) fn addresses(place: &str) -> std::io::Result<Vec<SocketAddr>> {
    match place.parse::<u16>() {
        Ok(port) => Ok(vec![([127, 0, 0, 1], port).into()]),
        Err(_) => place.to_socket_addrs().map(Iterator::collect),
    }
}

/// Time for which a place to listen at may still be that of a process that is ending: it loses its files one after the other.
const PATIENCE: Duration = Duration::from_secs(2);

/// Time between two attempts.
const PAUSE: Duration = Duration::from_millis(50);

/// Tries again for a while, where a supervisor takes the place of another one.
pub(super) fn patient<T>(
    arguments: &ServeArgs,
    mut attempt: impl FnMut() -> Result<T, CliError>,
) -> Result<T, CliError> {
    let begin = Instant::now();
    loop {
        match attempt() {
            Err(_) if arguments.standby && begin.elapsed() < PATIENCE => sleep(PAUSE),
            done => return done,
        }
    }
}
