//! Who may send lines over a socket, and what becomes of the lines of all others; and the page, which nobody can change anything by.

use crate::lines::{document, fits, requests, supervisor};
use pcr_formats::splitmix64::SplitMix64;
use pcr_serve::clients::Access;
use pcr_serve::hello;
use pcr_serve::journal_writer::WriteProgress;
use pcr_serve::lines::LONGEST;
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::request_error::RequestError;
use pcr_serve::server::{ServerHandle, ServerInput, queue, serve};
use pcr_serve::sockets::Listener;
use pcr_serve::token::Token;
use pcr_serve::{clients, http};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, ErrorKind, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::path::PathBuf;
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// A supervisor with clients over TCP.
struct Server {
    handle: ServerHandle,
    at: SocketAddr,
    thread: Option<JoinHandle<Result<(), RequestError>>>,
    folder: PathBuf,
    token: String,
}

impl Server {
    /// With what a test changes of the usual access.
    fn new(name: &str, change: impl FnOnce(&mut Access)) -> Self {
        let folder = std::env::temp_dir().join(format!("pcr-sockets-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let token = Token::at(&folder.join("token")).unwrap();
        let said = std::fs::read_to_string(folder.join("token")).unwrap().trim_end().to_owned();
        let mut access = Access::new(Some(token));
        change(&mut access);
        let (handle, inputs) = queue();
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let (at, own) = (listener.local_addr().unwrap(), handle.clone());
        thread::spawn(move || clients::listen(&own, &listener.into(), access, LogWriter::new(LogLevel::Error)));
        let thread = thread::spawn(move || {
            serve(&mut supervisor(), &inputs, &WriteProgress::default(), LogWriter::new(LogLevel::Error))
        });
        Self { handle, at, thread: Some(thread), folder, token: said }
    }

    fn hello(&self) -> String {
        json!({ "pcr": 1, "verb": "hello", "token": self.token }).to_string()
    }

    fn connected(&self) -> TcpStream {
        TcpStream::connect(self.at).unwrap()
    }

    /// A client that was let in.
    fn client(&self) -> Client {
        let mut client = Client(BufReader::new(self.connected()));
        assert_eq!(client.ask(&self.hello())["ok"]["version"], 1);
        client
    }

    /// What comes back for some bytes, until the connection ends.
    fn said(&self, bytes: &[u8]) -> Vec<Value> {
        let stream = self.connected();
        // One that does not end fails the test, and does not hold it up.
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        let (mut writer, whole) = (stream.try_clone().unwrap(), bytes.to_vec());
        // It may end before all is written.
        let writes = thread::spawn(move || {
            let _ = writer.write_all(&whole);
        });
        let lines = BufReader::new(&stream).lines().map_while(Result::ok);
        let said = lines.map(|line| serde_json::from_str(&line).unwrap()).collect();
        let _ = stream.shutdown(Shutdown::Both);
        writes.join().unwrap();
        said
    }

    fn robots(&self) -> Vec<String> {
        self.handle.ask(|own, _, _| own.robots().iter().map(|robot| robot.name.clone()).collect()).unwrap()
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.handle.send(ServerInput::Stop);
        let ended = self.thread.take().unwrap().join();
        assert!(ended.is_ok_and(|served| served.is_ok()) || thread::panicking());
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

struct Client(BufReader<TcpStream>);

impl Client {
    fn ask(&mut self, line: &str) -> Value {
        self.0.get_mut().write_all(format!("{line}\n").as_bytes()).unwrap();
        self.next().unwrap()
    }

    fn next(&mut self) -> Option<Value> {
        let mut line = String::new();
        self.0.read_line(&mut line).unwrap();
        (!line.is_empty()).then(|| serde_json::from_str(&line).unwrap())
    }
}

const REMOVE: &str = r#"{"id": 7, "verb": "remove", "robot": "a"}"#;

/// What a browser sends for `fetch` with lines as its body, from a page of somebody else.
fn post(line: &str) -> String {
    format!(
        "POST / HTTP/1.1\r\nHost: 127.0.0.1:7070\r\nConnection: keep-alive\r\nContent-Length: {}\r\nContent-Type: text/plain;charset=UTF-8\r\n\
         Origin: http://evil.example\r\nSec-Fetch-Mode: no-cors\r\n\r\n{line}\n",
        line.len() + 1
    )
}

/// The beginning of a connection with TLS, with lines behind it.
fn client_hello() -> Vec<u8> {
    [b"\x16\x03\x01\x00\xc8\x01\x00\x00\xc4\x03\x03".as_slice(), format!("\n{REMOVE}\n").as_bytes()].concat()
}

/// Any page in a browser of the machine could command robots.
#[test]
fn nothing_is_carried_out_of_a_connection_that_does_not_begin_with_a_hello() {
    let schema: Value = serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap();
    let server = Server::new("first", |_| {});
    let mut client = server.client();
    assert_eq!(client.ask(&requests()[0])["ok"]["path"], 1);
    let hello = |change: fn(&mut Value)| {
        let mut hello = serde_json::from_str(&server.hello()).unwrap();
        change(&mut hello);
        hello.to_string().into_bytes()
    };
    let text = |text: &str| text.as_bytes().to_vec();
    for (bytes, code) in [
        // A client of before.
        (text(REMOVE), "no_hello"),
        (text(r#"{"verb": "watch"}"#), "no_hello"),
        (text(r#"{"hello": 1}"#), "no_hello"),
        (hello(|hello| hello["verb"] = json!("Hello")), "no_hello"),
        (hello(|hello| hello["more"] = json!(1)), "no_hello"),
        (hello(|hello| hello["token"] = json!(1)), "no_hello"),
        (hello(|hello| hello["token"] = Value::Null), "unauthorized"),
        (hello(|hello| hello["token"] = json!("")), "unauthorized"),
        (hello(|hello| hello["token"] = json!("0".repeat(64))), "unauthorized"),
        (hello(|hello| hello["token"] = json!(hello["token"].as_str().unwrap()[..63])), "unauthorized"),
        (hello(|hello| hello["token"] = json!(format!("{}0", hello["token"].as_str().unwrap()))), "unauthorized"),
        (hello(|hello| hello["pcr"] = json!(2)), "version"),
        (hello(|hello| hello["pcr"] = json!("1")), "version"),
        (hello(|hello| drop(hello.as_object_mut().unwrap().remove("pcr"))), "version"),
        (text(&post(REMOVE)), "malformed"),
        (text(&post(&server.hello())), "malformed"),
        (text("GET /?{\"verb\":\"remove\"} HTTP/1.1\r\nHost: a\r\n\r\n"), "malformed"),
        (text("OPTIONS / HTTP/1.1\r\nAccess-Control-Request-Method: POST\r\n\r\n"), "malformed"),
        (text("Host: 127.0.0.1\r\n"), "malformed"),
        (text("PUT"), "malformed"),
        (client_hello(), "malformed"),
        (vec![0x16, 3, 1], "malformed"),
        (text("[]"), "malformed"),
        (text(&format!("[{}]", server.hello())), "malformed"),
        (text(&format!("\"{}\"", server.token)), "malformed"),
        (text(&server.token), "malformed"),
        (text(&format!("\u{feff}{}", server.hello())), "malformed"),
        (text(&format!("{} {}", server.hello(), server.hello())), "malformed"),
        (text("{"), "malformed"),
        (vec![0xff, 0xfe], "malformed"),
        (vec![0; 100], "malformed"),
        (vec![b' '; hello::LONGEST + 1], "malformed"),
        (vec![b'\n'; hello::LONGEST + 1], "malformed"),
        (vec![b'{'; LONGEST], "malformed"),
        (vec![b'x'; hello::LONGEST + 1], "malformed"),
        (
            format!("{{\"pcr\": 1, \"verb\": \"hello\", \"token\": \"{}\"}}", "x".repeat(hello::LONGEST)).into_bytes(),
            "malformed",
        ),
    ] {
        let shown = String::from_utf8_lossy(&bytes[..bytes.len().min(80)]).into_owned();
        // Lines behind it, one of them a hello.
        let whole = [&bytes[..], b"\n", server.hello().as_bytes(), b"\n", REMOVE.as_bytes(), b"\n"].concat();
        let said = server.said(&whole);
        assert_eq!(said.len(), 1, "{shown}: {said:?}");
        fits(&schema, &said[0]);
        assert_eq!(said[0]["error"]["code"], code, "{shown}: {said:?}");
        assert!(!said[0].to_string().contains(&server.token));
        assert_eq!(server.robots(), ["a"], "{shown}");
    }
    // What a connection begins as is told, also if it comes in pieces.
    for (bytes, why) in [
        (text(&post(REMOVE)), "no web server"),
        (text("Host: a\n"), "no web server"),
        (client_hello(), "without TLS"),
        ([vec![0x16, 3], vec![1; hello::LONGEST]].concat(), "without TLS"),
        (text(&format!("GET /{}", "a".repeat(hello::LONGEST))), "no web server"),
        (text("[]\n"), "no JSON object"),
        (text("POSTER\n"), "no JSON object"),
        (vec![b'{'; hello::LONGEST + 1], "too long"),
    ] {
        let mut stream = server.connected();
        stream.set_nodelay(true).unwrap();
        let mut said = String::new();
        for piece in [&bytes[..2], &bytes[2..]] {
            // It may have ended before.
            let _ = stream.write_all(piece);
            thread::sleep(Duration::from_millis(20));
        }
        stream.read_to_string(&mut said).unwrap();
        assert!(said.contains(why), "{why}: {said}");
    }
    // What cannot become a hello ends the connection at once, and not at its end.
    let mut stream = server.connected();
    stream.write_all(b" [").unwrap();
    stream.set_read_timeout(Some(Duration::from_secs(3))).unwrap();
    assert!(stream.read_to_string(&mut String::new()).is_ok());
    // A hello may be as long as said, with its end.
    for (length, answers) in [(hello::LONGEST, 2), (hello::LONGEST + 1, 1)] {
        let hello = format!("{}{}\n", server.hello(), " ".repeat(length - server.hello().len() - 1));
        let said = server.said(format!("{hello}[]\n").as_bytes());
        assert_eq!((said.len(), said[0].get("ok").is_some()), (answers, answers == 2), "{said:?}");
    }
    // The others are served as before.
    assert_eq!(client.ask(REMOVE)["ok"]["removed"], true);
}

/// A line that was none never ended a connection.
#[test]
fn a_connection_ends_at_the_first_line_that_is_no_object() {
    let server = Server::new("later", |_| {});
    for good in [0, 1, 5, 300] {
        for bad in [
            post(REMOVE).into_bytes(),
            b"[]".to_vec(),
            // What is wrong in it as well is no reason to go on.
            b"[{\"verb\": \"watch\", \"verb\": \"watch\"}]".to_vec(),
            b"nonsense".to_vec(),
            b"Host: a".to_vec(),
            client_hello(),
            vec![b' ', 0],
            b"{\"verb\": \"watch\"".to_vec(),
            vec![b'{'; LONGEST + 1],
        ] {
            let watch = "{\"verb\": \"watch\"}\n".repeat(good);
            let begin = format!("{}\n{}\n{watch}", server.hello(), requests()[0]);
            let whole =
                [begin.as_bytes(), &bad, b"\n", REMOVE.as_bytes(), b"\n", server.hello().as_bytes(), b"\n"].concat();
            let said = server.said(&whole);
            let shown = String::from_utf8_lossy(&bad[..bad.len().min(40)]).into_owned();
            assert_eq!(said.len(), 3 + good, "{shown}: {said:?}");
            let (last, before) = said.split_last().unwrap();
            assert!(before.iter().all(|said| said.get("ok").is_some()), "{shown}: {said:?}");
            assert_eq!(last["error"]["code"], "malformed", "{shown}: {last}");
            assert_eq!(server.robots(), ["a"], "{shown}");
        }
    }
    // An object with an error in it is answered, and the connection goes on.
    let mut client = server.client();
    for line in [r#"{"verb": "fly"}"#, r#"{"verb": "watch", "verb": "watch"}"#, "{}", r#"{"pcr": 2, "verb": "watch"}"#]
    {
        assert!(client.ask(line).get("error").is_some(), "{line}");
    }
    assert_eq!(client.ask(REMOVE)["ok"]["removed"], true);
    // So is a hello again, and one that ends with the connection.
    assert_eq!(client.ask(&server.hello())["ok"]["version"], 1);
    let mut last = server.connected();
    last.write_all(server.hello().as_bytes()).unwrap();
    last.shutdown(Shutdown::Write).unwrap();
    let mut said = String::new();
    last.read_to_string(&mut said).unwrap();
    assert!(said.contains("\"version\":1"), "{said}");
}

#[test]
fn events_are_for_clients_that_watch() {
    let server = Server::new("events", |_| {});
    let mut client = server.client();
    assert_eq!(client.ask(&requests()[0])["ok"]["path"], 1);
    let mission = |k: usize| {
        json!({ "id": k, "verb": "mission", "robot": "a", "mission": k.to_string(), "path": [{ "kind": "line", "length": 0.1 }] })
            .to_string()
    };
    let counts = |k: usize| json!({ "id": k, "verb": "query", "what": "counts" }).to_string();
    for k in 0..3 {
        assert_eq!(client.ask(&mission(k))["id"], k);
        // Its event would come before the next answer.
        assert_eq!(client.ask(&counts(k + 10))["id"], k + 10);
    }
    assert!(client.ask("{\"verb\": \"watch\"}").get("ok").is_some());
    assert_eq!(client.ask(&mission(3))["id"], 3);
    assert!(client.next().unwrap().get("event").is_some());
}

#[test]
fn a_hello_may_come_in_pieces_but_not_for_ever() {
    let server = Server::new("slow", |access| access.within = Duration::from_secs(60));
    let mut pieces = server.connected();
    for byte in format!("\r\n\n{}\r\n{}\n", server.hello(), requests()[0]).bytes() {
        pieces.write_all(&[byte]).unwrap();
    }
    let said: Vec<String> = BufReader::new(&pieces).lines().take(2).map(Result::unwrap).collect();
    assert!(said[1].contains("\"path\":1"), "{said:?}");
    // A byte from time to time does not make the time longer.
    let server = Server::new("slower", |access| access.within = Duration::from_millis(200));
    for (begin, why) in
        [(&server.hello()[..20], "in time"), ("", "in time"), ("x", "in time"), ("POST /", "no web server")]
    {
        let stream = server.connected();
        let mut drips = stream.try_clone().unwrap();
        drips.write_all(begin.as_bytes()).unwrap();
        // Until the connection has ended.
        let dripping = thread::spawn(move || {
            while drips.write_all(b" ").is_ok() {
                thread::sleep(Duration::from_millis(20));
            }
        });
        let said: Vec<String> = BufReader::new(&stream).lines().map_while(Result::ok).collect();
        assert!(said.len() == 1 && said[0].contains("\"malformed\""), "{begin}: {said:?}");
        assert!(said[0].contains(why), "{begin}: {said:?}");
        drop(stream);
        dripping.join().unwrap();
    }
}

/// All places could be taken by connections that never say who they are.
#[test]
fn connections_without_a_hello_take_no_place_from_clients() {
    let server = Server::new("many", |access| {
        (access.within, access.clients, access.strangers) = (Duration::from_secs(3600), 2, 4);
    });
    let mut first = server.client();
    let strangers: Vec<TcpStream> = (0..40).map(|_| server.connected()).collect();
    // All but four of them end, and the first client is served.
    for stranger in &strangers {
        stranger.set_nonblocking(true).unwrap();
    }
    let has_ended = |stranger: &&TcpStream| !matches!((&**stranger).read(&mut [0; 9]), Err(why) if why.kind() == ErrorKind::WouldBlock);
    while strangers.iter().filter(has_ended).count() < 36 {
        thread::yield_now();
    }
    assert!(first.ask(&requests()[0]).get("ok").is_some());
    assert_eq!(strangers.iter().filter(has_ended).count(), 36);
    let mut second = server.client();
    assert!(second.ask(REMOVE).get("ok").is_some());
    // A third one knows the token, and is told why it is none.
    let said = server.said(format!("{}\n{}\n", server.hello(), requests()[0]).as_bytes());
    assert_eq!((said.len(), &said[0]["error"]["code"]), (1, &json!("full")), "{said:?}");
    assert!(server.robots().is_empty());
    drop(second);
    // Its thread ends some time after that.
    while server.said(format!("{}\n[]\n", server.hello()).as_bytes()).len() != 2 {
        thread::yield_now();
    }
    assert!(first.ask(&requests()[0]).get("ok").is_some());
}

/// Any bytes, whole and in pieces, in front of lines that would remove a robot.
#[test]
fn bytes_that_are_no_hello_change_nothing() {
    let server = Server::new("bytes", |access| access.within = Duration::from_millis(100));
    let mut client = server.client();
    assert!(client.ask(&requests()[0]).get("ok").is_some());
    let mut dice = SplitMix64(54);
    let parts: Vec<Vec<u8>> = [
        server.hello()[..server.hello().len() - 1].into(),
        post(REMOVE).into_bytes(),
        REMOVE.into(),
        client_hello(),
        b"{\"pcr\": 1, \"verb\": \"hello\"}".into(),
        b"\r\n".into(),
        b"{}".into(),
        b"\0".into(),
        b"HTTP/1.1\r\n".into(),
        vec![b' '; 3000],
    ]
    .into();
    for round in 0..400 {
        let mut bytes = Vec::new();
        for _ in 0..1 + dice.below(4) {
            match dice.below(3) {
                0 => bytes.extend((0..dice.below(40)).map(|_| (dice.unit() * 256.0) as u8)),
                1 => bytes.extend(&parts[dice.below(parts.len())]),
                _ => {
                    let mut part = parts[dice.below(parts.len())].clone();
                    let place = dice.below(part.len());
                    part[place] = (dice.unit() * 256.0) as u8;
                    bytes.extend(part);
                }
            }
        }
        bytes.extend(format!("\n{REMOVE}\n").as_bytes());
        let mut stream = server.connected();
        for piece in bytes.chunks(1 + dice.below(bytes.len())) {
            // It may have ended already.
            let _ = stream.write_all(piece);
        }
        let _ = stream.shutdown(Shutdown::Write);
        let said = BufReader::new(&stream).lines().map_while(Result::ok).count();
        assert!(said <= 1, "round {round}");
        assert_eq!(server.robots(), ["a"], "round {round}: {:?}", String::from_utf8_lossy(&bytes));
    }
    assert!(client.ask(REMOVE).get("ok").is_some());
}

/// Who may write to the file needs no token, and says hello all the same.
#[cfg(unix)]
#[test]
fn clients_at_a_file_need_no_token() {
    use pcr_serve::sockets;
    use std::os::unix::net::UnixStream;
    let folder = std::env::temp_dir().join(format!("pcr-sockets-{}-file", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("socket");
    let (listener, file) = sockets::SocketFile::bind(&path).unwrap();
    let (handle, inputs) = queue();
    let own = handle.clone();
    thread::spawn(move || clients::listen(&own, &listener, Access::new(None), LogWriter::new(LogLevel::Error)));
    let server = thread::spawn(move || {
        serve(&mut supervisor(), &inputs, &WriteProgress::default(), LogWriter::new(LogLevel::Error))
    });
    let said = |lines: &str| -> Vec<Value> {
        let mut stream = UnixStream::connect(&path).unwrap();
        let _ = stream.write_all(lines.as_bytes());
        let _ = stream.shutdown(Shutdown::Write);
        BufReader::new(stream).lines().map(|line| serde_json::from_str(&line.unwrap()).unwrap()).collect()
    };
    let add = &requests()[0];
    for (first, answers) in [
        (r#"{"pcr": 1, "verb": "hello"}"#, 2),
        (r#"{"pcr": 1, "verb": "hello", "token": "of another supervisor"}"#, 2),
        (r#"{"pcr": 2, "verb": "hello"}"#, 1),
        (r#"{"verb": "hello"}"#, 1),
        (REMOVE, 1),
        ("POST / HTTP/1.1", 1),
    ] {
        let said = said(&format!("{first}\n{add}\n"));
        assert_eq!((said.len(), said[0].get("ok").is_some()), (answers, answers == 2), "{first}: {said:?}");
        let robots = handle.ask(|own, _, _| own.robots().len()).unwrap();
        assert_eq!(robots, 1);
    }
    handle.send(ServerInput::Stop);
    server.join().unwrap().unwrap();
    drop(file);
    std::fs::remove_dir(&folder).unwrap();
}

/// What of a supervisor a request could change.
fn state(handle: &ServerHandle) -> String {
    let told = handle.ask(|own, _, _| {
        let robots: Vec<_> = own
            .robots()
            .iter()
            .map(|robot| {
                (&robot.name, robot.path, robot.arc_length, robot.notified_limit, &robot.mission, &robot.waiting)
            })
            .collect();
        format!("{robots:?} {:?} {:?}", own.counts(), own.layout())
    });
    told.unwrap()
}

#[test]
fn the_page_answers_get_and_changes_nothing_by_any_method() {
    let (handle, inputs) = queue();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let at = listener.local_addr().unwrap();
    let draw: http::DrawFn = |fleet, place| Ok(format!("<svg>{}</svg>", fleet[place].name));
    let site = http::HttpContent {
        page: "<p>here</p>".into(),
        draw: Some(draw),
        hosts: vec![at.to_string()],
        addresses: false,
        unready: None,
    };
    let own = handle.clone();
    thread::spawn(move || http::listen(&own, &Listener::from(listener), site, LogWriter::new(LogLevel::Error)));
    let server = thread::spawn(move || {
        serve(&mut supervisor(), &inputs, &WriteProgress::default(), LogWriter::new(LogLevel::Error))
    });
    for line in &requests()[..2] {
        let line = line.clone();
        handle.ask(move |own, _, _| {
            pcr_serve::lines::handle(own, line.as_bytes(), 0.0, 0.0).answer["ok"]["path"].clone()
        });
    }
    let before = state(&handle);
    assert!(before.contains("\"b\""), "{before}");
    let ask = |request: &[u8]| {
        let mut stream = TcpStream::connect(at).unwrap();
        let _ = stream.write_all(request);
        let mut text = String::new();
        let _ = stream.read_to_string(&mut text);
        text
    };
    let routes = [
        "/",
        "/state",
        "/layout",
        "/map?robot=a",
        "/metrics",
        "/favicon.ico",
        "/nothing",
        "/?verb=remove&robot=a",
        "*",
        "http://a/",
    ];
    let bodies = ["", REMOVE, "robot=a&verb=remove", "_method=DELETE", "\n{\"verb\":\"remove\",\"robot\":\"a\"}\n"];
    for method in [
        "GET",
        "HEAD",
        "POST",
        "PUT",
        "DELETE",
        "PATCH",
        "OPTIONS",
        "CONNECT",
        "TRACE",
        "PROPFIND",
        "get",
        "REMOVE",
        "{\"verb\":",
        "\u{1}",
        "",
    ] {
        for route in routes {
            for (k, body) in bodies.iter().enumerate() {
                let more = [
                    "",
                    "Content-Type: application/json\r\n",
                    "Origin: http://evil.example\r\n",
                    "X-HTTP-Method-Override: DELETE\r\n",
                    "",
                ][k];
                let head =
                    format!("{method} {route} HTTP/1.1\r\nHost: {at}\r\n{more}Content-Length: {}\r\n\r\n", body.len());
                let said = ask(format!("{head}{body}").as_bytes());
                let (status, lower) = (&said[9..12], said.to_lowercase());
                let expected: &[&str] = match method {
                    "GET" | "HEAD" => &["200", "204", "404"],
                    "" => &["400", "405"],
                    _ => &["405"],
                };
                assert!(expected.contains(&status), "{method} {route}: {said}");
                assert_eq!(said.contains("\r\nAllow: GET, HEAD\r\n"), status == "405", "{method} {route}: {said}");
                assert!(!lower.contains("access-control-"), "{said}");
                assert!(
                    lower.contains("cross-origin-resource-policy: same-origin")
                        && lower.contains("frame-ancestors 'none'"),
                    "{said}"
                );
                assert_eq!(method == "HEAD" || status == "204", said.ends_with("\r\n\r\n"), "{method} {route}: {said}");
            }
            // Under another name it is nobody's page.
            for host in [
                "Host: evil.example\r\n",
                "",
                &format!("Host: evil.example\r\nHost: {at}\r\n"),
                &format!("Host: {at}\r\nHost: {at}\r\n"),
                &format!("Host : {at}\r\n"),
            ] {
                let said = ask(format!("{method} {route} HTTP/1.1\r\n{host}\r\n").as_bytes());
                assert!(said.starts_with("HTTP/1.1 403") || method.is_empty(), "{method} {route} {host}: {said}");
            }
        }
    }
    for route in routes {
        let socket = format!(
            "GET {route} HTTP/1.1\r\nHost: {at}\r\nUpgrade: WebSocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\
             Sec-WebSocket-Version: 13\r\n\r\n"
        );
        assert!(ask(socket.as_bytes()).starts_with("HTTP/1.1 400"), "{route}");
    }
    for garbage in [
        "\r\n\r\n",
        "GET\r\n\r\n",
        "GET /\r\n\r\n",
        "GET / HTTP/2\r\n\r\n",
        "GET /state  HTTP/1.1\r\n\r\n",
        &format!("{REMOVE}\n\r\n\r\n"),
        &"x".repeat(9000),
    ] {
        assert!(ask(garbage.as_bytes()).starts_with("HTTP/1.1 400"), "{garbage}");
    }
    assert!(ask(&client_hello()[..]).is_empty() || !state(&handle).is_empty());
    assert_eq!(state(&handle), before);
    handle.send(ServerInput::Stop);
    server.join().unwrap().unwrap();
}
