//! The first line of a connection: a hello with the version of the lines and, over TCP, the token.
//!
//! Until it has come, a connection has few bytes and little time, and nothing that it sends reaches the supervisor. A web page can have a
//! browser send requests of HTTP to any port of its machine, with lines of the page's choice in them: such a request begins with another
//! line.

use crate::lines::{self, RequestLine};
use crate::request_error::RequestError;
use crate::sockets::Stream;
use crate::token::Token;
use serde_json::Value;
use std::io::{BufRead, BufReader, ErrorKind};
use std::time::{Duration, Instant};

/// Longest first line \[bytes\].
pub const LONGEST: usize = 4096;

/// Why a connection ends that the client has not ended.
#[derive(Clone, Debug)]
pub enum ConnectionRefusal {
    /// The first line, or a later one, is one of HTTP: a browser, or a program that takes the lines for a web server.
    Http {
        /// The page that had the browser send it, if the browser says so.
        origin: Option<String>,
    },
    /// The connection begins as one with TLS.
    Tls,
    /// A line is no JSON object.
    NoObject(Value),
    /// A line is longer than so many bytes.
    TooLong(usize),
    /// The first line did not come in time.
    Late,
    /// The first line did not come before too many others connected.
    Crowded,
    /// The first line is refused.
    Hello(RequestError, Value),
}

impl ConnectionRefusal {
    /// Returns the reason in words, for the log. It has no part of what the client has sent but the origin.
    pub fn reason(&self) -> String {
        match self {
            Self::Http { .. } => "a browser or an HTTP client has sent a request to the lines, which are no web server: a web page may try to \
                 command robots"
                .into(),
            Self::Tls => "it begins as a connection with TLS, which the lines do not have".into(),
            Self::NoObject(_) => "a line is no JSON object".into(),
            Self::TooLong(most) => format!("a line is longer than {most} bytes"),
            Self::Late => "its first line did not come in time".into(),
            Self::Crowded => "its first line did not come before too many others connected".into(),
            Self::Hello(RequestError::NoHello, _) => {
                "its first line is no hello: a client of an earlier version, or of something else (docs/reference/serve.md)".into()
            }
            Self::Hello(RequestError::Unauthorized { why }, _) => (*why).into(),
            Self::Hello(RequestError::Version { .. }, _) => "its hello has another version, or none".into(),
            Self::Hello(fault, _) => fault.to_string(),
        }
    }

    /// Returns the last line that the client gets.
    pub fn answer(&self) -> Value {
        let why = match self {
            Self::NoObject(answer) | Self::Hello(_, answer) => return answer.clone(),
            Self::Http { .. } => "these are lines of JSON and no web server",
            Self::Tls => "these are lines of JSON without TLS",
            Self::TooLong(LONGEST) => "the first line is too long",
            Self::TooLong(_) => return lines::too_long(),
            Self::Late | Self::Crowded => "the first line did not come in time",
        };
        lines::refusal(&RequestError::Malformed {
            why: format!("{why}; the first line is a hello (docs/reference/serve.md)"),
        })
    }

    /// Returns what kind of refusal it is: of each kind, the log has few lines.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Http { .. } => "http",
            Self::Tls => "tls",
            Self::NoObject(_) => "object",
            Self::TooLong(_) => "length",
            Self::Late => "time",
            Self::Crowded => "crowd",
            Self::Hello(RequestError::Unauthorized { .. }, _) => "token",
            Self::Hello(RequestError::Version { .. }, _) => "version",
            Self::Hello(RequestError::Full { .. }, _) => "places",
            Self::Hello(..) => "hello",
        }
    }
}

/// Reads the first line of a connection and checks it; `None`: the client has ended the connection before. Nothing behind the line is taken
/// from `input`.
///
/// # Errors
/// [`ConnectionRefusal`].
pub fn read(
    input: &mut BufReader<Stream>,
    token: Option<&Token>,
    within: Duration,
) -> Result<Option<RequestLine>, ConnectionRefusal> {
    let Some(line) = first_line(input, Instant::now() + within)? else { return Ok(None) };
    let request = RequestLine::read(line.trim_ascii());
    if !request.is_object() {
        return Err(no_object(&line, input.buffer(), &request));
    }
    let checked = request.hello().and_then(|hello| match (token, &hello.token) {
        (None, _) => Ok(()),
        (Some(token), Some(said)) if token.is(said) => Ok(()),
        (Some(_), Some(_)) => Err(RequestError::Unauthorized { why: "the token is wrong" }),
        (Some(_), None) => Err(RequestError::Unauthorized { why: "hello has no token" }),
    });
    match checked {
        Ok(()) => Ok(Some(request)),
        Err(fault) => Err(ConnectionRefusal::Hello(fault.clone(), request.refused(fault))),
    }
}

/// What a line is that is no JSON object. `behind` is what has come after it.
pub(crate) fn no_object(line: &[u8], behind: &[u8], request: &RequestLine) -> ConnectionRefusal {
    if is_tls(line) {
        ConnectionRefusal::Tls
    } else if is_http(line) {
        ConnectionRefusal::Http { origin: origin([line, behind]) }
    } else {
        ConnectionRefusal::NoObject(request.refused(RequestError::Malformed {
            why: "the line is no JSON object, so this connection ends here".into(),
        }))
    }
}

/// The bytes up to the end of the first line that is not empty, or up to where it is clear that it is no hello.
fn first_line(input: &mut BufReader<Stream>, until: Instant) -> Result<Option<Vec<u8>>, ConnectionRefusal> {
    let mut line = Vec::new();
    loop {
        let left = until.saturating_duration_since(Instant::now());
        // A read may not wait for no time at all.
        if left.is_zero() || input.get_ref().set_read_timeout(Some(left)).is_err() {
            return Err(late(&line));
        }
        let bytes = match input.fill_buf() {
            Ok([]) if line.trim_ascii().is_empty() => return Ok(None),
            // A last line needs no end.
            Ok([]) => return Ok(Some(line)),
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                return Err(late(&line));
            }
            Err(_) => return Ok(None),
        };
        let (used, ends) = match bytes.iter().position(|byte| *byte == b'\n') {
            Some(place) => (place + 1, true),
            None => (bytes.len(), false),
        };
        let used = used.min(LONGEST + 1 - line.len());
        line.extend_from_slice(&bytes[..used]);
        input.consume(used);
        if line.len() > LONGEST {
            return Err(match (is_tls(&line), is_http(&line)) {
                (true, _) => ConnectionRefusal::Tls,
                (_, true) => ConnectionRefusal::Http { origin: origin([&line, &[]]) },
                _ => ConnectionRefusal::TooLong(LONGEST),
            });
        }
        let text = line.trim_ascii_start();
        // Words are read to their end, to tell what they are.
        let is_other = text.first().is_some_and(|first| *first != b'{' && !first.is_ascii_alphabetic());
        if is_other || ends && !text.is_empty() {
            return Ok(Some(line));
        }
    }
}

/// What a line is whose end did not come in time.
fn late(line: &[u8]) -> ConnectionRefusal {
    if is_http(line) { ConnectionRefusal::Http { origin: None } } else { ConnectionRefusal::Late }
}

/// Whether bytes begin as a connection with TLS: a handshake, and the version.
fn is_tls(line: &[u8]) -> bool {
    line.starts_with(&[0x16, 3])
}

/// Whether a line is the first one of a request of HTTP, or a header.
fn is_http(line: &[u8]) -> bool {
    const METHODS: [&str; 13] = [
        "GET", "POST", "OPTIONS", "PUT", "HEAD", "DELETE", "PATCH", "CONNECT", "TRACE", "PRI", "PROPFIND", "HTTP/1.0",
        "HTTP/1.1",
    ];
    const HEADERS: [&str; 9] = [
        "Host",
        "Origin",
        "Connection",
        "User-Agent",
        "Content-Length",
        "Content-Type",
        "Accept",
        "Sec-Fetch-Mode",
        "Upgrade",
    ];
    let line = line.trim_ascii();
    let begins = |word: &str, end: u8| {
        line.split_at_checked(word.len())
            .is_some_and(|(begin, rest)| begin.eq_ignore_ascii_case(word.as_bytes()) && rest.first() == Some(&end))
    };
    METHODS.iter().any(|method| begins(method, b' '))
        || HEADERS.iter().any(|header| begins(header, b':'))
        || line.ends_with(b" HTTP/1.1")
}

/// The value of the header `Origin`.
fn origin(parts: [&[u8]; 2]) -> Option<String> {
    let text = parts.concat();
    let mut lines = text.split(|byte| *byte == b'\n');
    let value = lines.find_map(|line| {
        let (name, value) = line.split_at_checked("origin:".len())?;
        name.eq_ignore_ascii_case(b"origin:").then_some(value)
    })?;
    Some(String::from_utf8_lossy(value.trim_ascii()).chars().take(200).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_of_http_are_known_wherever_they_begin() {
        for line in [
            "GET / HTTP/1.1\r\n",
            "POST / HTTP/1.1",
            "OPTIONS * HTTP/1.1",
            "put /x HTTP/1.1",
            "HEAD / HTTP/1.0",
            "DELETE /a HTTP/1.1",
            "PATCH /a HTTP/1.1",
            "CONNECT a:1 HTTP/1.1",
            "TRACE / HTTP/1.1",
            "PRI * HTTP/2.0",
            "BREW /pot HTTP/1.1",
            "GET /",
            "Host: 127.0.0.1:7070\r\n",
            "host:x",
            "Content-Length: 12",
            "HTTP/1.1 200 OK",
        ] {
            assert!(is_http(line.as_bytes()), "{line}");
        }
        for line in ["", "{}", "{\"GET \": 1}", "GETTING on", "hosts", "Host", "x", "[1]"] {
            assert!(!is_http(line.as_bytes()), "{line}");
        }
        let post = "POST / HTTP/1.1\r\nHost: 127.0.0.1:7070\r\norigin: http://evil.example\r\n\r\n{}\n";
        assert_eq!(origin([&post.as_bytes()[..20], &post.as_bytes()[20..]]).unwrap(), "http://evil.example");
        assert_eq!(origin([b"GET / HTTP/1.1\r\n", b""]), None);
        assert_eq!(origin([b"Origin: ", "x".repeat(5000).as_bytes()]).unwrap().len(), 200);
    }

    #[test]
    fn reasons_are_a_line_of_words() {
        for refusal in [
            ConnectionRefusal::Http { origin: None },
            ConnectionRefusal::Tls,
            ConnectionRefusal::NoObject(Value::Null),
            ConnectionRefusal::TooLong(LONGEST),
            ConnectionRefusal::Late,
            ConnectionRefusal::Crowded,
            ConnectionRefusal::Hello(RequestError::NoHello, Value::Null),
            ConnectionRefusal::Hello(RequestError::Unauthorized { why: "no token" }, Value::Null),
            ConnectionRefusal::Hello(RequestError::Full { places: 2 }, Value::Null),
        ] {
            let reason = refusal.reason();
            assert!(!reason.contains(['\n', '\\']) && !reason.contains("  "), "{reason}");
        }
    }
}
