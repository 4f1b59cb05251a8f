//! The line protocol: the example of the document, the schema, and bytes that are no requests.

use pcr_formats::splitmix64::SplitMix64;
use pcr_serve::bridge_status::BridgeStatus;
use pcr_serve::clients::Access;
use pcr_serve::journal_entry::NullStore;
use pcr_serve::journal_writer::WriteProgress;
use pcr_serve::lines::{RequestLine, handle, news};
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::outbox::{BACKLOG, DisconnectReason, outbox};
use pcr_serve::server::{ServerInput, SupervisorCall, queue, serve};
use pcr_serve::supervisor::{Supervisor, SupervisorConfig};
use pcr_serve::{clients, http};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::mpsc::sync_channel;
use std::thread;
use std::time::{Duration, Instant};

pub(crate) fn supervisor() -> Supervisor {
    Supervisor::new(SupervisorConfig::default(), Box::new(NullStore))
}

pub(crate) fn document(name: &str) -> String {
    std::fs::read_to_string(format!("{}/../../docs/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

pub(crate) fn fits(schema: &Value, line: &Value) {
    let validator = jsonschema::draft202012::new(schema).unwrap();
    let faults: Vec<String> = validator.iter_errors(line).map(|error| error.to_string()).collect();
    assert!(faults.is_empty(), "{line}: {faults:?}");
}

/// Equal but for the digits that a document leaves out.
fn near(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => (a.as_f64().unwrap() - b.as_f64().unwrap()).abs() < 1e-4,
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| near(a, b)),
        (Value::Object(a), Value::Object(b)) => {
            a.len() == b.len() && a.iter().all(|(key, a)| b.get(key).is_some_and(|b| near(a, b)))
        }
        (a, b) => a == b,
    }
}

#[test]
fn the_example_of_the_document() {
    let schema: Value = serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap();
    let text = document("reference/serve.md");
    let mut supervisor = supervisor();
    let (mut said, mut now, mut requests): (Vec<Value>, f64, u32) = (Vec::new(), 0.0, 0);
    for line in text.lines() {
        if let Some(request) = line.strip_prefix("> ") {
            assert!(said.is_empty(), "the document leaves out {said:?}");
            let reply = handle(&mut supervisor, request.as_bytes(), now, now);
            said.push(reply.answer);
            let events = supervisor.settle(now).unwrap();
            said.extend(events.iter().map(news));
            fits(&schema, &serde_json::from_str(request).unwrap());
            (now, requests) = (now + 0.1, requests + 1);
        } else if let Some(answer) = line.strip_prefix("< ") {
            let told: Value = serde_json::from_str(answer).unwrap();
            let found = said.remove(0);
            assert!(near(&told, &found), "the document: {told}\nthe supervisor: {found}");
            fits(&schema, &found);
        }
    }
    assert!(said.is_empty() && requests == 11, "{requests} {said:?}");
}

/// Whoever asks how far it may go and does not watch would never hear of a `stop`.
#[test]
fn who_asks_for_holds_hears_that_a_robot_is_stopped() {
    let schema: Value = serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap();
    let mut supervisor = supervisor();
    let add = |name: &str, x: f64| {
        json!({ "verb": "add", "robot": name, "start": { "x": x, "y": 0, "heading": 0 },
                "abilities": { "radius": 0.25, "speed": 1, "acceleration": 0.5 } })
    };
    let mission = json!({ "verb": "mission", "robot": "a", "mission": "1", "path": [{ "kind": "line", "length": 3 }] });
    let holds = json!({ "verb": "query", "what": "holds" });
    let mut stopped = Vec::new();
    for request in [
        &add("a", 0.0),
        &mission,
        &holds,
        &add("new", 1.5),
        &holds,
        &json!({ "verb": "remove", "robot": "new" }),
        &holds,
    ] {
        let reply = handle(&mut supervisor, request.to_string().as_bytes(), 0.0, 0.0);
        supervisor.settle(0.0).unwrap();
        fits(&schema, &reply.answer);
        if request == &holds {
            let of_a = reply.answer["ok"]["holds"][0].clone();
            assert_eq!((&of_a["robot"], &of_a["path"]), (&json!("a"), &json!(2)));
            stopped.push(of_a["stopped_for"].clone());
        }
    }
    assert_eq!(stopped, [Value::Null, json!("new"), Value::Null]);
}

const HELLO: &str = "{\"id\": \"h\", \"pcr\": 1, \"verb\": \"hello\"}\n";

const ABILITIES: &str = r#"{"radius": 0.25, "speed": 1, "acceleration": 0.5}"#;

/// What clients can say that is right, or nearly.
pub(crate) fn requests() -> Vec<String> {
    let add = |name: &str, x: f64| {
        format!(
            r#"{{"id": 1, "verb": "add", "robot": "{name}", "start": {{"x": {x}, "y": 0, "heading": 0}}, "abilities": {ABILITIES}}}"#
        )
    };
    let mut all = vec![
        add("a", -3.0),
        add("b", 3.0),
        add("a", 3.0),
        add("", 0.0),
        r#"{"verb": "layout", "name": "hall", "lanes": [{"start": {"x": 0, "y": 0, "heading": 0}, "path": [{"kind": "arc", "radius": 1, "sweep": 2}, {"kind": "turn", "sweep": 1}]}]}"#.into(),
        r#"{"id": "x", "verb": "mission", "robot": "a", "mission": "1", "path": [{"kind": "line", "length": 6.5}]}"#.into(),
        r#"{"id": "x", "verb": "mission", "robot": "c", "mission": "1", "path": []}"#.into(),
        r#"{"verb": "mission", "robot": "a", "mission": "2", "start": {"x": 9, "y": 0, "heading": 0}, "path": []}"#.into(),
        r#"{"verb": "mission", "robot": "a", "mission": "3", "path": [{"kind": "arc", "radius": -1, "sweep": 1e9}]}"#.into(),
        r#"{"verb": "replace", "robot": "a", "mission": "4", "path": []}"#.into(),
        r#"{"verb": "position", "robot": "a", "path": 1, "at": [0, 0]}"#.into(),
        r#"{"verb": "position", "robot": "a", "path": 9, "at": [0, 0]}"#.into(),
        r#"{"verb": "position", "robot": "a", "path": 1, "at": [1, 0]}"#.into(),
        r#"{"verb": "position", "robot": "a", "path": 1, "at": [0, 1e300], "age": -1}"#.into(),
        r#"{"verb": "position", "robot": "a", "path": 1, "at": [4, 4.5]}"#.into(),
        r#"{"verb": "off", "robot": "b", "x": 1, "y": 1}"#.into(),
        r#"{"verb": "away", "robot": "b"}"#.into(),
        r#"{"verb": "away", "robot": "b", "away": false}"#.into(),
        r#"{"verb": "remove", "robot": "a"}"#.into(),
        r#"{"verb": "remove", "robot": "a"}"#.into(),
        r#"{"pcr": 1, "verb": "hello", "token": "x"}"#.into(),
        r#"{"id": 1, "verb": "hello"}"#.into(),
        r#"{"pcr": 2, "verb": "watch"}"#.into(),
        r#"{"id": [1], "verb": "watch"}"#.into(),
        r#"{"id": 1, "verb": "query", "what": "safe", "robot": "b", "length": [0, 0], "until": 10}"#.into(),
        "[]".into(),
        "\u{0}".into(),
    ];
    for what in ["robots", "holds", "counts", "regions", "conflicts"] {
        let robot = if ["regions", "conflicts"].contains(&what) { r#", "robot": "b""# } else { "" };
        all.push(format!(r#"{{"id": 1, "verb": "query", "what": "{what}"{robot}}}"#));
    }
    all
}

#[test]
fn every_answer_fits_the_schema_and_nothing_panics() {
    let schema: Value = serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap();
    let validator = jsonschema::draft202012::new(&schema).unwrap();
    let (mut dice, mut kinds) = (SplitMix64(7), std::collections::BTreeSet::new());
    let all = requests();
    let mut supervisor = supervisor();
    for round in 0..4000 {
        let mut line = all[if round < all.len() { round } else { dice.below(all.len()) }].clone().into_bytes();
        // Damage of all kinds.
        if round >= 2 * all.len() {
            for _ in 0..dice.below(4) {
                let place = dice.below(line.len());
                match dice.below(3) {
                    0 => line[place] = (dice.unit() * 256.0) as u8,
                    1 => drop(line.remove(place)),
                    _ => line.insert(place, b"0\"{}[],:e-"[dice.below(10)]),
                }
                if line.is_empty() {
                    line.push(b'{');
                }
            }
        }
        let now = round as f64 * 0.1;
        let reply = handle(&mut supervisor, &line, now, now);
        let events = supervisor.settle(now).unwrap();
        for line in [reply.answer].into_iter().chain(events.iter().map(news)) {
            assert!(validator.is_valid(&line), "{line}");
            kinds.insert(line["event"].as_str().or(line["error"]["code"].as_str()).unwrap_or("ok").to_owned());
        }
        if round % 500 == 499 {
            supervisor = self::supervisor();
        }
    }
    let seen: Vec<&str> = kinds.iter().map(String::as_str).collect();
    for kind in [
        "admitted",
        "alarm",
        "apart",
        "hold",
        "invalid",
        "malformed",
        "no_such_path",
        "no_such_robot",
        "ok",
        "robot_exists",
        "silent",
        "version",
    ] {
        assert!(seen.contains(&kind), "{kind} is not among {seen:?}");
    }
}

/// What a message says of its age, and what follows from it.
#[test]
fn robots_off_their_paths_and_back() {
    let schema: Value = serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap();
    let mut supervisor = supervisor();
    let add = json!({ "verb": "add", "robot": "a", "start": { "x": 0, "y": 0, "heading": 0 },
        "abilities": { "radius": 0.25, "speed": 1, "acceleration": 0.5 } });
    let mission = |length: f64| json!({ "verb": "mission", "robot": "a", "mission": "1", "path": [{ "kind": "line", "length": length }] });
    let position =
        |lo: f64, age: f64| json!({ "verb": "position", "robot": "a", "path": 2, "at": [lo, lo], "age": age });
    let off = |age: f64| json!({ "verb": "off", "robot": "a", "x": 1, "y": 2, "age": age });
    let mut told = Vec::new();
    for (request, now) in [
        (add, 0.0),
        (mission(3.0), 0.0),
        (mission(2.0), 0.0),
        (position(1.0, 0.0), 1.0),
        (position(0.5, 0.0), 2.0),
        (off(1.5), 2.1),
        (off(0.0), 2.2),
        (position(1.0, 0.0), 2.3),
    ] {
        fits(&schema, &request);
        let reply = handle(&mut supervisor, request.to_string().as_bytes(), now, now).answer;
        fits(&schema, &reply);
        told.extend(reply["error"]["code"].as_str().map(str::to_owned));
        for event in supervisor.settle(now).unwrap().iter().map(news) {
            fits(&schema, &event);
            if event["event"] != "hold" {
                told.push(format!("{} {}", event["event"], event["why"]).replace(['"'], ""));
            }
        }
    }
    assert_eq!(told, ["admitted null", "mission_exists", "alarm back", "alarm off", "clear null"]);
}

/// A mission that was admitted meanwhile made another place of the length at which a robot was to turn off.
/// The last ids of each robot are kept: with ids of a megabyte, the journal came to its end.
#[test]
fn ids_of_missions_have_a_limit() {
    let mut supervisor = supervisor();
    handle(&mut supervisor, requests()[0].as_bytes(), 0.0, 0.0);
    for (length, is_taken) in [(1000, true), (1001, false)] {
        let mission = json!({ "verb": "mission", "robot": "a", "mission": "m".repeat(length),
            "path": [{ "kind": "line", "length": 1 }] });
        let answer = handle(&mut supervisor, mission.to_string().as_bytes(), 0.0, 0.0).answer;
        assert_eq!(answer["error"].is_null(), is_taken, "{length}: {answer}");
        supervisor.settle(0.0).unwrap();
    }
}

#[test]
fn a_replacement_is_of_the_path_that_it_names() {
    let schema: Value = serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap();
    let mut supervisor = supervisor();
    let lines = |count: usize| vec![json!({ "kind": "line", "length": 3 }); count];
    let replace = |name: &str, after: f64, of: Value| {
        json!({ "verb": "replace", "robot": "a", "mission": name, "after": after, "of": of,
                "path": [{ "kind": "turn", "sweep": 1.5 }, { "kind": "line", "length": 2 }] })
    };
    let mut told = Vec::new();
    for (request, now) in [
        (serde_json::from_str(&requests()[0]).unwrap(), 0.0),
        (json!({ "verb": "mission", "robot": "a", "mission": "1", "path": lines(3) }), 0.0),
        (json!({ "verb": "position", "robot": "a", "path": 2, "at": [2, 2] }), 2.0),
        (json!({ "verb": "position", "robot": "a", "path": 2, "at": [4, 4] }), 4.0),
        (json!({ "verb": "mission", "robot": "a", "mission": "2", "of": 2, "path": lines(1) }), 4.0),
        (replace("3", 6.5, json!(2)), 5.0),
        (replace("3", 6.5, json!(4)), 5.0),
        (replace("3", 6.5, json!(3)), 5.0),
        // Asked for again it is the same one.
        (replace("3", 6.5, json!(3)), 5.0),
        (replace("4", 8.0, Value::Null), 5.0),
    ] {
        fits(&schema, &request);
        let answer = handle(&mut supervisor, request.to_string().as_bytes(), now, now).answer;
        fits(&schema, &answer);
        supervisor.settle(now).unwrap();
        told.push((answer["ok"]["path"].as_u64(), answer["error"]["code"].clone(), answer["error"]["path"].clone()));
    }
    let (none, other) = (Value::Null, json!("no_such_path"));
    let ok = |path: Option<u64>| (path, none.clone(), none.clone());
    let refused = (None, other, json!(3));
    let same = ok(Some(4));
    assert_eq!(
        told,
        [
            ok(Some(1)),
            ok(Some(2)),
            ok(None),
            ok(None),
            ok(Some(3)),
            refused.clone(),
            refused,
            same.clone(),
            same,
            ok(Some(5))
        ]
    );
}

/// A heading that was a thousandth of a radian off was let through, whatever it was off at the end of the path.
#[test]
fn a_path_ends_where_who_asks_for_it_believes() {
    let arc = json!({ "kind": "arc", "radius": 0.2, "sweep": 6.0 });
    for (heading, path, is_there) in [
        (9e-4, json!([{ "kind": "line", "length": 1 }]), true),
        (9e-4, json!([{ "kind": "line", "length": 10 }]), false),
        (9e-5, json!([{ "kind": "line", "length": 10 }]), true),
        (std::f64::consts::TAU, json!([{ "kind": "line", "length": 1000 }]), true),
        // However long it is, it does not lead far.
        (9e-4, json!([arc, arc]), true),
        (9e-4, json!([arc, arc, arc]), false),
        (2e-3, json!([{ "kind": "turn", "sweep": 1 }]), false),
        (9e-4, json!([{ "kind": "turn", "sweep": 1 }]), true),
    ] {
        let mut supervisor = supervisor();
        handle(&mut supervisor, requests()[0].as_bytes(), 0.0, 0.0);
        let start = json!({ "x": -3, "y": 0, "heading": heading });
        let request = json!({ "verb": "mission", "robot": "a", "mission": "1", "start": start, "path": path });
        let answer = handle(&mut supervisor, request.to_string().as_bytes(), 0.0, 0.0).answer;
        assert_eq!(answer["error"]["code"] != "apart", is_there, "{request} {answer}");
    }
}

/// A message that was older than an alarm, and said so, ended it where it had waited for longer than that: its age was that of when it was
/// read.
#[test]
fn ages_count_from_when_a_line_came() {
    let (sender, inputs) = sync_channel(100);
    let server = thread::spawn(move || {
        serve(&mut supervisor(), &inputs, &WriteProgress::default(), LogWriter::new(LogLevel::Error)).unwrap();
    });
    let (answer, alarm) = sync_channel(2);
    let ask = |question: fn(&Supervisor) -> bool| {
        let answer = answer.clone();
        let call: SupervisorCall = Box::new(move |supervisor, _, _| {
            answer.send(question(supervisor)).unwrap();
            None
        });
        sender.send((Instant::now(), ServerInput::Call(call))).unwrap();
        alarm.recv().unwrap()
    };
    // It is at work.
    assert!(ask(|supervisor| supervisor.robots().is_empty()));
    let begin = Instant::now();
    // What follows came a while ago.
    let busy = |supervisor: &Supervisor| {
        thread::sleep(Duration::from_millis(200));
        supervisor.robots().iter().any(|robot| robot.alarm.is_some())
    };
    assert!(!ask(busy));
    let (out, _lines) = outbox();
    sender.send((begin, ServerInput::Opened(1, out))).unwrap();
    let say = |after: u64, request: Value| {
        let request = RequestLine::read(request.to_string().as_bytes());
        sender.send((begin + Duration::from_millis(after), ServerInput::Line(1, request))).unwrap();
    };
    say(0, serde_json::from_str(&requests()[0]).unwrap());
    say(1, json!({ "verb": "mission", "robot": "a", "mission": "1", "path": [{ "kind": "line", "length": 2 }] }));
    let position = |age: f64| json!({ "verb": "position", "robot": "a", "path": 2, "at": [0, 0], "age": age });
    say(20, json!({ "verb": "off", "robot": "a", "x": 0, "y": 2 }));
    // It does something else for longer than the message is old.
    assert!(ask(busy));
    say(40, position(0.03));
    assert!(ask(|supervisor| supervisor.robots()[0].alarm.is_some()));
    say(60, position(0.03));
    assert!(ask(|supervisor| supervisor.robots()[0].alarm.is_none()));
    sender.send((Instant::now(), ServerInput::Stop)).unwrap();
    server.join().unwrap();
}

#[test]
fn clients_over_tcp_and_the_page() {
    let mut supervisor = supervisor();
    let (handle, inputs) = queue();
    let (lines, page) = (TcpListener::bind("127.0.0.1:0").unwrap(), TcpListener::bind("127.0.0.1:0").unwrap());
    let (at, shown) = (lines.local_addr().unwrap(), page.local_addr().unwrap());
    let draw: http::DrawFn = |fleet, place| Ok(format!("<svg>{}</svg>", fleet[place].name));
    let unready = http::Readiness::default();
    let site = http::HttpContent {
        page: "<p>here</p>".into(),
        draw: Some(draw),
        hosts: vec![shown.to_string()],
        addresses: false,
        unready: Some(unready.clone()),
    };
    let own = handle.clone();
    thread::spawn(move || clients::listen(&own, &lines.into(), Access::new(None), LogWriter::new(LogLevel::Error)));
    let own = handle.clone();
    thread::spawn(move || http::listen(&own, &page.into(), site, LogWriter::new(LogLevel::Error)));
    let server = thread::spawn(move || {
        serve(&mut supervisor, &inputs, &WriteProgress::default(), LogWriter::new(LogLevel::Error))
    });

    let (mut out, mut other) = (TcpStream::connect(at).unwrap(), TcpStream::connect(at).unwrap());
    let mut answers = BufReader::new(out.try_clone().unwrap()).lines();
    let mut others = BufReader::new(other.try_clone().unwrap()).lines();
    let next = |lines: &mut dyn Iterator<Item = std::io::Result<String>>| -> Value {
        serde_json::from_str(&lines.next().unwrap().unwrap()).unwrap()
    };
    for (client, answers) in [(&mut out, &mut answers), (&mut other, &mut others)] {
        client.write_all(HELLO.as_bytes()).unwrap();
        let welcome = next(answers);
        assert_eq!((&welcome["id"], &welcome["ok"]["version"]), (&json!("h"), &json!(1)), "{welcome}");
        assert_eq!(
            welcome["ok"]["fleet"],
            json!({ "robots": 0, "waiting": 0, "alarmed": 0, "stopped": 0, "silent": 0 })
        );
        fits(&serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap(), &welcome);
    }
    other.write_all(b"{\"verb\": \"watch\"}\n").unwrap();
    assert_eq!(next(&mut others)["ok"], json!({}));
    for request in &requests()[..2] {
        out.write_all(format!("{request}\n").as_bytes()).unwrap();
        assert_eq!(next(&mut answers)["ok"], json!({ "path": 1 }));
    }
    out.write_all(b"{\"id\": 5, \"verb\": \"mission\", \"robot\": \"a\", \"mission\": \"m\", \"path\": [{\"kind\": \"line\", \"length\": 1}]}\n").unwrap();
    assert_eq!(next(&mut answers)["id"], 5);
    assert_eq!(next(&mut others)["event"], "admitted");
    assert_eq!(next(&mut others)["event"], "hold");

    let get = |request: &str| {
        let mut stream = TcpStream::connect(shown).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut text = String::new();
        stream.read_to_string(&mut text).unwrap();
        text
    };
    let ask = |path: &str| get(&format!("GET {path} HTTP/1.1\r\nHost: {shown}\r\n\r\n"));
    assert!(ask("/").ends_with("<p>here</p>"));
    let metrics = ask("/metrics");
    assert!(metrics.contains("\npcr_robots 2\n") && metrics.contains("pcr_latency_seconds_count 6\n"), "{metrics}");
    let state = ask("/state");
    let state: Value = serde_json::from_str(state.split("\r\n\r\n").nth(1).unwrap()).unwrap();
    assert_eq!(state["robots"].as_array().unwrap().len(), 2);
    // The page asks with the time, so that no old picture is shown: that was taken for a part of the name.
    assert!(ask("/map?robot=b&1795457224920").ends_with("<svg>b</svg>"));
    assert!(ask("/map?robot=nobody").starts_with("HTTP/1.1 404") && ask("/map").starts_with("HTTP/1.1 400"));
    assert!(ask("/healthz").starts_with("HTTP/1.1 200"));
    assert!(ask("/readyz").starts_with("HTTP/1.1 200"));
    let status = BridgeStatus { connected: true, ..BridgeStatus::default() };
    unready.tell(Some("kit/1 has not said where it stands".into()), status);
    let told = ask("/readyz");
    assert!(told.starts_with("HTTP/1.1 503") && told.ends_with("kit/1 has not said where it stands\n"), "{told}");
    let metrics = ask("/metrics");
    for line in [
        "pcr_broker_connected 1",
        "pcr_broker_active 0",
        "pcr_vehicles_unplaced 0",
        "pcr_robot_waiting{robot=\"a\"} 0",
        "pcr_robot_alarmed{robot=\"b\"} 0",
    ] {
        assert!(metrics.contains(&format!("\n{line}\n")), "{line}: {metrics}");
    }
    assert!(ask("/healthz").starts_with("HTTP/1.1 200"));
    assert!(ask("/favicon.ico").starts_with("HTTP/1.1 204"));
    assert!(ask("/etc/passwd").starts_with("HTTP/1.1 404"));
    assert!(get(&format!("POST / HTTP/1.1\r\nHost: {shown}\r\n\r\n")).starts_with("HTTP/1.1 405"));
    // A page of somebody else whose name leads here.
    assert!(get("GET /state HTTP/1.1\r\nHost: example.org\r\n\r\n").starts_with("HTTP/1.1 403"));
    assert!(get("GET /state HTTP/1.1\r\n\r\n").starts_with("HTTP/1.1 403"));
    handle.send(ServerInput::Stop);
    server.join().unwrap().unwrap();
    // The picture of a robot said that there was no such robot.
    for path in ["/state", "/metrics", "/layout", "/map?robot=b", "/healthz", "/readyz"] {
        assert!(ask(path).starts_with("HTTP/1.1 503"), "{path}");
    }
}

/// At 0.0.0.0 it answered 403 to all who asked from elsewhere.
#[test]
fn a_page_at_all_addresses_is_shown_under_any_address_and_no_other_name() {
    let (handle, inputs) = queue();
    drop(inputs);
    let site = |addresses| http::HttpContent {
        page: "here".into(),
        draw: None,
        hosts: vec!["localhost:8080".into()],
        addresses,
        unready: None,
    };
    let status = |addresses, host: &str| {
        let request = format!("GET / HTTP/1.1\r\nHost: {host}\r\n\r\n");
        http::answer(&handle, &site(addresses), request.as_bytes()).0[..3].parse::<u16>().unwrap()
    };
    // The port may be another one: that of a machine around this one, which passes on what comes there.
    for host in ["192.168.1.5:8080", "[fe80::1]:8080", "10.0.0.1:80", "192.168.1.5", "[fe80::1]"] {
        assert_eq!([false, true].map(|addresses| status(addresses, host)), [403, 200], "{host}");
    }
    for host in ["example.org:8080", "1.2.3.4.example.org:8080", "fe80::1:8080", "[10.0.0.1]:8080", "[::1", ":8080", ""]
    {
        assert_eq!(status(true, host), 403, "{host}");
    }
    assert_eq!(status(true, "LOCALHOST:8080"), 200);
}

#[test]
fn no_more_bytes_wait_for_a_client_than_said() {
    let (out, lines) = outbox();
    // One that is too long is sent if nothing else waits, and one more is not.
    assert_eq!(out.send("x".repeat(BACKLOG + 1)), Ok(()));
    assert_eq!(lines.recv().unwrap().len(), BACKLOG + 1);
    let half = "x".repeat(BACKLOG / 2);
    assert_eq!(
        [out.send(half.clone()), out.send(half.clone()), out.send("x".into())],
        [Ok(()), Ok(()), Err(DisconnectReason::Slow)]
    );
    assert!(!lines.is_closed());
    drop(out);
    assert!(lines.is_closed());
    assert_eq!([lines.recv().unwrap(), lines.recv().unwrap()], [half.clone(), half]);
    let last: Value = serde_json::from_str(&lines.recv().unwrap()).unwrap();
    fits(&serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap(), &last);
    assert_eq!(last["error"]["code"], "slow", "{last}");
    assert!(lines.recv().is_err());
    let (out, lines) = outbox();
    drop(lines);
    assert_eq!(out.send("x".into()), Err(DisconnectReason::Gone));
}

/// It is told why in the last line, and whoever reads is served as before.
#[test]
fn a_client_that_never_reads_is_let_go_and_told_why() {
    const REQUESTS: u64 = 60;
    let mut supervisor = supervisor();
    let (handle, inputs) = queue();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let at = listener.local_addr().unwrap();
    let own = handle.clone();
    thread::spawn(move || clients::listen(&own, &listener.into(), Access::new(None), LogWriter::new(LogLevel::Error)));
    let server = thread::spawn(move || {
        serve(&mut supervisor, &inputs, &WriteProgress::default(), LogWriter::new(LogLevel::Error))
    });
    let (mut slow, mut other) = (TcpStream::connect(at).unwrap(), TcpStream::connect(at).unwrap());
    for client in [&mut slow, &mut other] {
        client.write_all(HELLO.as_bytes()).unwrap();
    }
    slow.write_all(format!("{}\n", requests()[0]).as_bytes()).unwrap();
    // Answers are as long as the requests, as the id comes back.
    let id = "x".repeat(900_000);
    let request = format!(r#"{{"id": "{id}", "verb": "position", "robot": "a", "path": 1, "at": [0, 0]}}"#);
    for _ in 0..REQUESTS {
        slow.write_all(format!("{request}\n").as_bytes()).unwrap();
    }
    // More than connections hold has waited: it is let go, and gets what had waited, and why there is no more.
    let answers: Vec<String> = BufReader::new(slow).lines().map(Result::unwrap).collect();
    let (last, before) = answers.split_last().unwrap();
    let last: Value = serde_json::from_str(last).unwrap();
    assert_eq!((&last["id"], &last["error"]["code"]), (&Value::Null, &json!("slow")), "{last}");
    assert!((before.len() as u64) < REQUESTS, "{}", before.len());
    other.write_all(b"{\"id\": 1, \"verb\": \"query\", \"what\": \"counts\"}\n").unwrap();
    let answered: Vec<String> = BufReader::new(other).lines().take(2).map(Result::unwrap).collect();
    assert!(answered.iter().all(|line| line.contains("\"ok\"")), "{answered:?}");
    handle.send(ServerInput::Stop);
    server.join().unwrap().unwrap();
}

/// It was let go, and until then nobody else was answered for seconds: now it is not read until it reads.
#[test]
fn a_client_that_reads_late_gets_all_its_answers() {
    const REQUESTS: usize = 30_000;
    let mut supervisor = supervisor();
    let (handle, inputs) = queue();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let at = listener.local_addr().unwrap();
    let own = handle.clone();
    thread::spawn(move || clients::listen(&own, &listener.into(), Access::new(None), LogWriter::new(LogLevel::Error)));
    let server = thread::spawn(move || {
        serve(&mut supervisor, &inputs, &WriteProgress::default(), LogWriter::new(LogLevel::Error))
    });
    let late = TcpStream::connect(at).unwrap();
    let mut writes = late.try_clone().unwrap();
    // More bytes of answers than connections hold and the server keeps.
    let request = format!("{{\"id\": \"{}\", \"verb\": \"watch\", \"events\": false}}\n", "x".repeat(1_000));
    let writer = thread::spawn(move || {
        writes.write_all(HELLO.as_bytes()).unwrap();
        (0..REQUESTS).for_each(|_| writes.write_all(request.as_bytes()).unwrap());
    });
    // Another client is answered meanwhile, whatever waits.
    let mut other = TcpStream::connect(at).unwrap();
    other.write_all(HELLO.as_bytes()).unwrap();
    let mut answers = BufReader::new(other.try_clone().unwrap()).lines();
    for _ in 0..200 {
        other.write_all(b"{\"verb\": \"query\", \"what\": \"counts\"}\n").unwrap();
        assert!(answers.next().unwrap().unwrap().contains("\"ok\""));
    }
    let told: Vec<String> = BufReader::new(late).lines().take(REQUESTS + 1).map(Result::unwrap).collect();
    assert_eq!(told.len(), REQUESTS + 1);
    assert!(told.iter().all(|line| line.contains("\"ok\"")), "{:?}", told.iter().find(|line| !line.contains("\"ok\"")));
    writer.join().unwrap();
    handle.send(ServerInput::Stop);
    server.join().unwrap().unwrap();
}

/// What it had sent was carried out, and nobody was told.
#[test]
fn what_a_client_has_sent_that_was_let_go_is_not_carried_out() {
    let mut supervisor = supervisor();
    let (handle, inputs) = queue();
    let server = thread::spawn(move || {
        serve(&mut supervisor, &inputs, &WriteProgress::default(), LogWriter::new(LogLevel::Error))
    });
    let (out, lines) = outbox();
    handle.send(ServerInput::Opened(1, out));
    let say = |line: &str| assert!(handle.send(ServerInput::Line(1, RequestLine::read(line.as_bytes()))));
    let robots = || handle.ask(|supervisor, _, _| supervisor.robots().len()).unwrap();
    let long = format!(r#"{{"id": "{}", "verb": "watch"}}"#, "x".repeat(BACKLOG / 2));
    say(&requests()[0]);
    (0..3).for_each(|_| say(&long));
    // What was decided before these is told.
    assert_eq!([robots(), robots(), robots()], [1; 3]);
    assert!(lines.is_closed());
    say(&requests()[1]);
    assert_eq!(robots(), 1);
    // One that has gone does not read what becomes of its requests, and has sent them all the same.
    let (out, lines) = outbox();
    handle.send(ServerInput::Opened(2, out));
    drop(lines);
    for line in [&requests()[0], &long, &requests()[1]] {
        assert!(handle.send(ServerInput::Line(2, RequestLine::read(line.as_bytes()))));
        robots();
    }
    assert_eq!(robots(), 2);
    handle.send(ServerInput::Stop);
    server.join().unwrap().unwrap();
}

/// Robots with outlines, shifts, turns with a length and missions of any heading, as the schema describes them.
#[test]
fn lines_about_outlines_fit_the_schema() {
    let schema: Value = serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap();
    let corner = |[ahead, left]: [f64; 2]| json!({ "ahead": ahead, "left": left });
    let outline = |corners: &[[f64; 2]]| json!({ "polygon": corners.iter().map(|at| corner(*at)).collect::<Vec<_>>(), "growth": 0.01 });
    let truck = outline(&[[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]]);
    let angle = outline(&[[-0.6, -0.4], [0.6, -0.4], [0.6, 0.0], [0.0, 0.0], [0.0, 0.4], [-0.6, 0.4]]);
    let add = |robot: &str, y: f64, outline: &Value| {
        json!({ "verb": "add", "robot": robot, "start": { "x": 0, "y": y, "heading": 0 },
            "abilities": { "footprint": outline, "speed": 1, "acceleration": 0.5 } })
    };
    let path = json!([{ "kind": "shift", "ahead": -1, "left": 0.5 }, { "kind": "turn", "sweep": 1, "lever": 0.5 }]);
    let mission = |robot: &str, any: bool| json!({ "verb": "mission", "robot": robot, "mission": "m", "path": path, "any_heading": any });
    let mut supervisor = supervisor();
    let mut say = |request: Value| {
        fits(&schema, &request);
        let answer = handle(&mut supervisor, request.to_string().as_bytes(), 0.0, 0.0).answer;
        fits(&schema, &answer);
        assert!(answer["ok"].is_object(), "{answer}");
        supervisor.settle(0.0).unwrap().iter().for_each(|event| fits(&schema, &news(event)));
        answer["ok"].clone()
    };
    assert_eq!(say(add("truck", 0.0, &truck)), json!({ "path": 1 }));
    assert!(say(add("angle", 9.0, &angle))["hull_excess"].as_f64().is_some_and(|excess| excess > 0.1));
    assert_eq!(say(mission("truck", false))["verdict"], "admitted");
    assert_eq!(say(mission("angle", true))["verdict"], "admitted");
    let robots = say(json!({ "verb": "query", "what": "robots" }));
    assert_eq!((&robots["robots"][0]["footprint"], &robots["robots"][1]["any_heading"]), (&truck, &json!(true)));
    say(json!({ "verb": "query", "what": "conflicts", "robot": "truck" }));
    // Neither a radius nor a footprint, or both, fits.
    for (missing, more) in [("footprint", None), ("none", Some(1.0))] {
        let mut wrong = add("other", 20.0, &truck);
        wrong["abilities"].as_object_mut().unwrap().remove(missing);
        more.into_iter().for_each(|radius| wrong["abilities"]["radius"] = json!(radius));
        assert!(!jsonschema::draft202012::new(&schema).unwrap().is_valid(&wrong), "{wrong}");
        let answer = handle(&mut self::supervisor(), wrong.to_string().as_bytes(), 0.0, 0.0).answer;
        assert_eq!(answer["error"]["code"], "malformed", "{answer}");
    }
}

/// Names were limited in bytes, and large ids came back as other numbers.
#[test]
fn names_are_limited_in_characters_and_ids_come_back_as_they_were() {
    let add = |id: &str, name: &str| {
        format!(
            r#"{{"id": {id}, "verb": "add", "robot": "{name}", "start": {{"x": 0, "y": 0, "heading": 0}}, "abilities": {ABILITIES}}}"#
        )
    };
    let says = |line: String| handle(&mut supervisor(), line.as_bytes(), 0.0, 0.0).answer;
    let refused = |name: &str| says(add("1", name)).get("error").is_some();
    assert!(!refused(&"é".repeat(200)) && refused(&"é".repeat(201)) && refused("a\u{202e}b"));
    for id in ["7", "-7", "18446744073709551615", "0.5", "-9007199254740991.0", "\"12345678901234567890123\""] {
        assert_eq!(says(add(id, "a"))["id"].to_string(), id);
    }
    for id in ["12345678901234567890123", "-12345678901234567890123", "1e300", "9007199254740992.0"] {
        let answer = says(add(id, "a"));
        assert!(
            answer["id"].is_null() && answer["error"]["message"].to_string().contains("has to be a text"),
            "{answer}"
        );
    }
}

#[test]
fn angles_may_be_in_degrees_and_are_no_more_than_a_turn_in_radians() {
    let schema: Value = serde_json::from_str(&document("reference/schema/pcr-serve.schema.json")).unwrap();
    let said = |supervisor: &mut Supervisor, request: &Value| {
        handle(supervisor, request.to_string().as_bytes(), 0.0, 0.0).answer
    };
    let abilities = json!({ "radius": 0.25, "speed": 1, "acceleration": 0.5 });
    let add = |start: Value| json!({ "verb": "add", "robot": "r", "start": start, "abilities": abilities });
    let mission = |id: &str, path: Value| json!({ "verb": "mission", "robot": "r", "mission": id, "path": path });
    // The same robot and path in either unit.
    let view = |start: Value, path: Value| {
        let mut supervisor = supervisor();
        for request in [add(start), mission("m", path)] {
            fits(&schema, &request);
            let answer = said(&mut supervisor, &request);
            assert!(answer["ok"].is_object(), "{answer}");
        }
        supervisor.settle(0.0).unwrap();
        let view = said(&mut supervisor, &json!({ "verb": "query", "what": "robots" }));
        view["ok"]["robots"][0].clone()
    };
    let right_angle = std::f64::consts::FRAC_PI_2;
    let degrees = view(
        json!({ "x": 1, "y": 2, "heading_deg": 90 }),
        json!([{ "kind": "arc", "radius": 1, "sweep_deg": -90 }, { "kind": "turn", "sweep_deg": 45 }, { "kind": "line", "length": 1 }]),
    );
    let radians = view(
        json!({ "x": 1, "y": 2, "heading": right_angle }),
        json!([{ "kind": "arc", "radius": 1, "sweep": -right_angle }, { "kind": "turn", "sweep": 0.5 * right_angle }, { "kind": "line", "length": 1 }]),
    );
    assert_eq!(degrees, radians);
    assert_eq!(
        (&degrees["start"]["heading"], degrees["length"].as_f64()),
        (&json!(right_angle), Some(right_angle + 1.0))
    );

    let mut supervisor = supervisor();
    let mut refusal = |request: Value| {
        let error = said(&mut supervisor, &request)["error"].clone();
        assert_eq!(error["code"], "malformed", "{request}: {error}");
        error["message"].as_str().unwrap().to_owned()
    };
    for (start, part) in [
        (
            json!({ "x": 0, "y": 0, "heading": 90 }),
            "start.heading: 90 is more than one turn in radians; use heading_deg for degrees",
        ),
        (json!({ "x": 0, "y": 0, "heading": -6.5 }), "start.heading: -6.5 is more than one turn in radians"),
        (json!({ "x": 0, "y": 0, "heading": 1, "heading_deg": 90 }), "start.heading_deg: given beside heading"),
        (json!({ "x": 0, "y": 0, "heading": null, "heading_deg": 90 }), "start.heading_deg: given beside heading"),
        (json!({ "x": 0, "y": 0, "heading_deg": "90" }), "start.heading_deg: a number of degrees is expected"),
        (json!({ "x": 0, "y": 0, "heading_deg": null }), "start.heading_deg: a number of degrees is expected"),
        (json!({ "x": 0, "y": 0 }), "missing field `heading`"),
    ] {
        let text = refusal(add(start));
        assert!(text.contains(part), "{text}");
    }
    for (shape, part) in [
        (
            json!({ "kind": "arc", "radius": 1, "sweep": 90 }),
            "path[1].sweep: 90 is more than one turn in radians; use sweep_deg for degrees",
        ),
        (json!({ "kind": "turn", "sweep": -90 }), "path[1].sweep: -90 is more than one turn in radians"),
        (json!({ "kind": "turn", "sweep": 0, "sweep_deg": 0 }), "path[1].sweep_deg: given beside sweep"),
        (json!({ "kind": "line", "length": 1, "sweep_deg": 90 }), "unknown field `sweep`"),
    ] {
        let text = refusal(mission("m", json!([{ "kind": "line", "length": 1 }, shape])));
        assert!(text.contains(part), "{text}");
    }
    // What is probably a rounding of one turn is one.
    let turn = add(json!({ "x": 0, "y": 0, "heading": 6.284 }));
    assert!(said(&mut supervisor, &turn)["ok"].is_object());
}
