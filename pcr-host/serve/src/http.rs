//! A small HTTP/1.1 server for the live page and the metrics. It only answers GET and HEAD, so that nothing can be changed
//! through it. Pages of others can neither read its answers nor show them.

use crate::bridge_status::BridgeStatus;
use crate::connection_limit;
use crate::log::LogWriter;
use crate::metrics;
use crate::query::RobotView;
use crate::server::ServerHandle;
use crate::sockets::{Listener, Stream};
use crate::supervisor::Supervisor;
use crate::telemetry::Telemetry;
use serde_json::json;
use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, Ipv6Addr};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// Largest length of a request \[bytes\].
const LONGEST: usize = 8192;

/// Largest number of connections at a time.
const MOST: usize = 32;

/// Time in which a request has to come, and its answer has to be read: in which a connection that is slow on purpose keeps its place.
const WITHIN: Duration = Duration::from_secs(5);

/// A function that draws the regions of a robot in its fleet.
pub type DrawFn = fn(&[RobotDrawing], usize) -> Result<String, String>;

/// A robot, as it is drawn.
#[derive(Clone, Debug)]
pub struct RobotDrawing {
    /// Name of the robot.
    pub name: String,
    /// Its outline and abilities.
    pub abilities: crate::robot::RobotTraits,
    /// Whether it may have any heading.
    pub any_heading: bool,
    /// The rest of its path.
    pub course: crate::owned_path::OwnedPath,
}

/// The content that is served.
#[derive(Clone, Debug)]
pub struct HttpContent {
    /// The page.
    pub page: String,
    /// The function that draws pictures, if there is one.
    pub draw: Option<DrawFn>,
    /// Accepted host names: a foreign page whose host name points here gets no answer.
    pub hosts: Vec<String>,
    /// Whether every address is accepted as a host, because the page is at all addresses of the machine. A foreign page needs a name that it
    /// can point here.
    pub addresses: bool,
    /// Why others than the supervisor itself keep it from granting authority; `None` if nobody else does.
    pub unready: Option<Readiness>,
}

/// Why nothing is granted yet, if so: told by the bridge to the vehicles, and shown at `/readyz`; and its part of `/metrics`.
#[derive(Clone, Debug, Default)]
pub struct Readiness(Arc<Mutex<(Option<String>, BridgeStatus)>>);

impl Readiness {
    /// Tells why nothing is granted (`None`: it is), and the status for the metrics.
    pub fn tell(&self, why: Option<String>, status: BridgeStatus) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = (why, status);
    }

    fn why(&self) -> Option<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).0.clone()
    }

    fn status(&self) -> BridgeStatus {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).1.clone()
    }
}

impl HttpContent {
    fn is_here(&self, host: &str) -> bool {
        let address =
            host.rsplit_once(':').filter(|(_, port)| !port.ends_with(']')).map_or(host, |(address, _)| address);
        let inner = address.strip_prefix('[').and_then(|rest| rest.strip_suffix(']'));
        let is_address = inner.map_or(address.parse::<Ipv4Addr>().is_ok(), |inner| inner.parse::<Ipv6Addr>().is_ok());
        self.hosts.iter().any(|known| known.eq_ignore_ascii_case(host)) || self.addresses && is_address
    }
}

/// Serves for ever.
pub fn listen(handle: &ServerHandle, listener: &Listener, site: HttpContent, log: LogWriter) {
    let handle = handle.clone();
    connection_limit::each(listener, "request", MOST, log, move |stream, _| {
        // An error means that the client has gone.
        let _ = converse(|request| answer(&handle, &site, request), stream);
    });
}

/// The supervisor that a standby becomes, with what is then served.
pub type LateSupervisor = Arc<OnceLock<(ServerHandle, HttpContent)>>;

/// Serves for ever: that it is a standby, until there is a supervisor.
pub fn listen_late(supervisor: &LateSupervisor, listener: &Listener, site: HttpContent, log: LogWriter) {
    let supervisor = supervisor.clone();
    connection_limit::each(listener, "request", MOST, log, move |stream, _| {
        let answer = |request: &[u8]| match supervisor.get() {
            Some((handle, site)) => answer(handle, site, request),
            None => answer_standby(&site, request),
        };
        // An error means that the client has gone.
        let _ = converse(answer, stream);
    });
}

/// A connection that ends at a time, however often a byte comes or goes.
struct TimedStream {
    stream: Stream,
    until: Instant,
}

impl TimedStream {
    /// Time that is left.
    fn left(&self) -> io::Result<Option<Duration>> {
        let left = self.until.saturating_duration_since(Instant::now());
        if left.is_zero() { Err(io::ErrorKind::TimedOut.into()) } else { Ok(Some(left)) }
    }
}

impl Read for TimedStream {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.stream.set_read_timeout(self.left()?)?;
        self.stream.read(bytes)
    }
}

impl Write for TimedStream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.set_write_timeout(self.left()?)?;
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

fn converse(answer: impl Fn(&[u8]) -> Answer, stream: Stream) -> io::Result<()> {
    let mut stream = TimedStream { stream, until: Instant::now() + WITHIN };
    let mut bytes = Vec::new();
    let mut part = [0; 1024];
    while !bytes.windows(4).any(|end| end == b"\r\n\r\n") {
        let count = stream.read(&mut part)?;
        bytes.extend(&part[..count]);
        if count == 0 || bytes.len() > LONGEST {
            return respond(&mut stream, "400 Bad Request", "text/plain", "a request ends with an empty line\n", true);
        }
    }
    let (status, kind, body) = answer(&bytes);
    stream.until = Instant::now() + WITHIN;
    let has_body = !bytes.starts_with(b"HEAD ");
    respond(&mut stream, status, kind, &body, has_body)
}

fn respond(stream: &mut TimedStream, status: &str, kind: &str, body: &str, has_body: bool) -> io::Result<()> {
    let allow = if status.starts_with("405") { "Allow: GET, HEAD\r\n" } else { "" };
    let head = format!(
        "HTTP/1.1 {status}\r\n{allow}Content-Type: {kind}; charset=utf-8\r\nContent-Length: {}\r\nCache-Control: no-store\r\n\
         X-Content-Type-Options: nosniff\r\nCross-Origin-Resource-Policy: same-origin\r\n\
         Content-Security-Policy: frame-ancestors 'none'\r\nConnection: close\r\n\r\n",
        body.len()
    );
    stream.write_all(head.as_bytes())?;
    if has_body { stream.write_all(body.as_bytes()) } else { Ok(()) }
}

/// Status, kind and body of an answer.
pub type Answer = (&'static str, &'static str, String);

fn plain(status: &'static str, text: &str) -> Answer {
    (status, "text/plain", format!("{text}\n"))
}

/// The target of a request.
///
/// # Errors
/// The answer to a request that is refused.
fn target(site: &HttpContent, request: &[u8]) -> Result<String, Answer> {
    let text = String::from_utf8_lossy(request);
    let mut lines = text.split("\r\n").take_while(|line| !line.is_empty());
    let words: Vec<&str> = lines.next().unwrap_or_default().split(' ').collect();
    let [method, target, "HTTP/1.1" | "HTTP/1.0"] = words[..] else {
        return Err(plain("400 Bad Request", "a request of HTTP/1.1 begins with METHOD PATH HTTP/1.1"));
    };
    let headers: Vec<(&str, &str)> = lines.filter_map(|line| line.split_once(':')).collect();
    let values = |name: &str| {
        let found: Vec<&str> =
            headers.iter().filter(|(key, _)| key.eq_ignore_ascii_case(name)).map(|(_, value)| value.trim()).collect();
        found
    };
    if !matches!(values("host")[..], [host] if site.is_here(host)) {
        return Err(plain("403 Forbidden", "not under this name"));
    }
    if !["GET", "HEAD"].contains(&method) {
        return Err(plain("405 Method Not Allowed", "only GET and HEAD"));
    }
    if values("upgrade").iter().any(|upgrade| upgrade.eq_ignore_ascii_case("websocket")) {
        return Err(plain("400 Bad Request", "there are no WebSockets here"));
    }
    Ok(target.to_owned())
}

/// The answer of a standby to a request.
fn answer_standby(site: &HttpContent, request: &[u8]) -> Answer {
    const WAITS: &str = "standby: it follows the journal, and waits for the end of the supervisor at work";
    let target = match target(site, request) {
        Ok(target) => target,
        Err(refused) => return refused,
    };
    match target.split_once('?').map_or(target.as_str(), |(path, _)| path) {
        "/healthz" => plain("200 OK", WAITS),
        "/metrics" => ("200 OK", "text/plain; version=0.0.4", metrics::standby(true)),
        _ => plain("503 Service Unavailable", WAITS),
    }
}

/// The answer to a request.
pub fn answer(handle: &ServerHandle, site: &HttpContent, request: &[u8]) -> Answer {
    let target = match target(site, request) {
        Ok(target) => target,
        Err(refused) => return refused,
    };
    let (path, query) = target.split_once('?').unwrap_or((&target, ""));
    match path {
        "/" => ("200 OK", "text/html", site.page.clone()),
        // Browsers request it with every page.
        "/favicon.ico" => ("204 No Content", "text/plain", String::new()),
        "/metrics" => {
            let bridge = site.unready.as_ref().map(Readiness::status);
            let text = move |supervisor: &mut Supervisor, board: &Telemetry, _| {
                metrics::text(supervisor, &board.latency, bridge.as_ref())
            };
            match handle.ask(text) {
                Some(text) => ("200 OK", "text/plain; version=0.0.4", text),
                None => ended(),
            }
        }
        "/state" => match handle.ask(|supervisor, board, now| {
            let robots = supervisor.robots().iter();
            let views: Vec<RobotView<'_>> = robots.map(|robot| RobotView::new(supervisor, robot, now)).collect();
            json!({ "now": now, "counts": supervisor.counts(), "robots": views, "away": supervisor.away(), "paused": supervisor.pause_reason(),
                "unplaced": supervisor.unplaced().map(|(name, why)| format!("{name} {why}")).collect::<Vec<_>>(), "closures": supervisor.closures().collect::<Vec<_>>(), "events": board.events() }).to_string()
        }) {
            Some(text) => ("200 OK", "application/json", text),
            None => ended(),
        },
        "/layout" => match handle.ask(|supervisor, _, _| json!(supervisor.layout()).to_string()) {
            Some(text) => ("200 OK", "application/json", text),
            None => ended(),
        },
        "/map" => map(handle, site, query),
        "/healthz" => match handle.ask(|_, _, _| ()) {
            Some(()) => plain("200 OK", "it decides"),
            None => ended(),
        },
        "/readyz" => match handle.ask(|supervisor, _, _| [supervisor.broken().map(str::to_owned), supervisor.pause_reason()]) {
            Some([broken, paused]) => {
                let why = broken.or_else(|| site.unready.as_ref()?.why()).into_iter().chain(paused);
                match why.collect::<Vec<_>>().join("; ").as_str() {
                    "" => plain("200 OK", "it grants authority"),
                    why => plain("503 Service Unavailable", why),
                }
            }
            None => ended(),
        },
        _ => plain("404 Not Found", "there is /, /state, /layout, /map?robot=NAME, /metrics, /healthz and /readyz"),
    }
}

fn ended() -> Answer {
    ("503 Service Unavailable", "text/plain", "the supervisor has ended\n".into())
}

fn map(handle: &ServerHandle, site: &HttpContent, query: &str) -> Answer {
    let Some(draw) = site.draw else { return plain("404 Not Found", "there are no pictures") };
    // Other parameters, such as a time, are ignored; pages add them to bypass the cache.
    let name = query.split('&').find_map(|part| part.strip_prefix("robot=")).map(decoded);
    let Some(name) = name else { return plain("400 Bad Request", "robot=NAME") };
    let fleet = handle.ask(move |supervisor, _, _| {
        let place = supervisor.robots().iter().position(|robot| robot.name == name)?;
        let drawn = supervisor.robots().iter().map(|robot| {
            let course = robot.course.part(robot.arc_length, robot.course.length());
            let course = course.map_err(|why| format!("{}: {why}", robot.name))?;
            Ok(RobotDrawing {
                name: robot.name.clone(),
                abilities: robot.abilities.clone(),
                any_heading: robot.any_heading,
                course,
            })
        });
        Some(drawn.collect::<Result<Vec<_>, String>>().map(|fleet| (fleet, place)))
    });
    let drawn = match fleet {
        None => return ended(),
        Some(None) => return plain("404 Not Found", "there is no such robot"),
        Some(Some(fleet)) => fleet.and_then(|(fleet, place)| draw(&fleet, place)),
    };
    match drawn {
        Ok(picture) => ("200 OK", "image/svg+xml", picture),
        Err(why) => plain("500 Internal Server Error", &why),
    }
}

/// Decodes `%41` and `+`.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let code = after
            .get(..2)
            .filter(|code| code.iter().all(u8::is_ascii_hexdigit))
            .and_then(|code| std::str::from_utf8(code).ok())
            .and_then(|code| u8::from_str_radix(code, 16).ok());
        match (first, code) {
            (b'%', Some(byte)) => {
                bytes.push(byte);
                rest = &after[2..];
            }
            _ => {
                bytes.push(if *first == b'+' { b' ' } else { *first });
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::{TcpListener, TcpStream};

    /// A client that sent a byte from time to time kept its place for ever: 32 of them closed page and metrics.
    #[test]
    fn a_connection_ends_in_time_however_often_a_byte_comes() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let mut client = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let (stream, _) = listener.accept().unwrap();
        let drips = std::thread::spawn(move || {
            while client.write_all(b"x").is_ok() {
                std::thread::sleep(Duration::from_millis(5));
            }
        });
        let until = Instant::now() + Duration::from_millis(200);
        let mut stream = TimedStream { stream: Stream::Tcp(stream), until };
        let mut part = [0; 16];
        let mut count = 0;
        let error = loop {
            match stream.read(&mut part) {
                Ok(more) => count += more,
                Err(error) => break error,
            }
        };
        assert!(count > 0 && matches!(error.kind(), io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock), "{error}");
        assert_eq!(stream.write(b"x").unwrap_err().kind(), io::ErrorKind::TimedOut);
        drop(stream);
        drips.join().unwrap();
    }
}
