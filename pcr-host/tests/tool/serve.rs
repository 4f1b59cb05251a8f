//! `pcr serve` and `pcr fleet`: options, files and discs.

use crate::fixture::{directory, file, pcr, run, run_with};
use serde_json::{Value, json};
use std::process::Stdio;

const LAYOUT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/nav2/aws_graph.geojson");

pub(crate) const ADD: &str = r#"{"id":1,"verb":"add","robot":"a","start":{"x":0,"y":0,"heading":0},"abilities":{"radius":0.3,"speed":1,"acceleration":1}}
{"id":2,"verb":"mission","robot":"a","mission":"1","path":[{"kind":"line","length":6}]}
"#;

#[test]
fn options_without_effect_are_refused() {
    for (arguments, reason) in [
        (&["fleet", "--certify", "run.txt", "--vehicles", "9"][..], "cannot be used with"),
        (&["fleet", "--certify", "run.txt", "--streets", "6"], "cannot be used with"),
        (&["fleet", "--certify", "run.txt", "--seed", "1"], "cannot be used with"),
        (&["fleet", "--certify", "run.txt", "--profiles", "vehicles.json"], "cannot be used with"),
        (&["fleet", LAYOUT, "--certify", "run.txt"], "cannot be used with"),
        (&["fleet", LAYOUT, "--alone", "supervisor", "--time", "1", "--pace", "2"], "cannot be used with"),
        (&["fleet", LAYOUT, "--alone", "supervisor", "--time", "1", "--broker", "localhost"], "cannot be used with"),
        (&["fleet", LAYOUT, "--alone", "supervisor", "--time", "1", "--topics", "a", "b"], "cannot be used with"),
        (&["fleet", LAYOUT, "--alone", "supervisor", "--time", "1", "--manager"], "cannot be used with"),
        (&["fleet", LAYOUT, "--time", "1", "--finish"], "--finish: missions are those of --manager, or of --alone"),
        (
            &["fleet", LAYOUT, "--alone", "supervisor", "--time", "1", "--vehicles", "0"],
            "--vehicles: allowed is 1 or more\n",
        ),
        (&["serve", "--topics", "a", "b"], "were not provided"),
        (&["serve", "--standby"], "add --journal DIR"),
        (&["serve", "--standby", "--stay", "--journal", "state", "--check"], "--check waits for nobody"),
        (&["serve", "--demo", LAYOUT, "--lookahead", "2"], "--lookahead: allowed is 8 to 600 for vehicles of VDA 5050"),
        (&["serve", "--demo", LAYOUT, "--width", "0.1"], "--width: allowed is 0.3 to 10 for vehicles of VDA 5050"),
        (&["serve", "--lookahead", "0.05"], "for '--lookahead <S>': a number from 0.1 to 600 is expected\n"),
    ] {
        let run = run(arguments);
        assert_eq!((run.status, run.out.as_str()), (2, ""), "{arguments:?}");
        assert!(run.err.contains(reason), "{arguments:?}: {}", run.err);
    }
}

/// Ten parking endpoints: with nine vehicles each mission ends where another one stands.
#[test]
fn a_layout_that_is_nearly_full_is_said_to_be() {
    let fleet =
        |vehicles: &str| run(&["fleet", LAYOUT, "--alone", "supervisor", "--time", "1", "--vehicles", vehicles]);
    let said = fleet("9").err;
    assert!(said.contains("pcr: warning: of 10 parking endpoints, 1 are free while all 9 vehicles stand; a mission to one of the others waits "), "{said}");
    assert!(!fleet("5").err.contains("[parking-endpoints]"));
    let full = fleet("10");
    assert!(full.status == 2 && full.err.ends_with("10 vehicles need 11 places to stand at; there are 10\n"));
}

#[test]
fn what_a_broker_needs_is_the_least_lookahead() {
    let vehicles = file("lookahead", "vehicles.json", r#"{"vehicles":[]}"#);
    let refused = |lookahead: &str| {
        run(&["serve", "--broker", "localhost:1", "--fleet", &vehicles, "--lookahead", lookahead]).failed(2)
    };
    assert_eq!(refused("7.9"), "pcr: --lookahead: allowed is 8 to 600 for vehicles of VDA 5050\n");
}

/// Each of its positions would have been off its way.
#[test]
fn a_margin_that_leaves_a_vehicle_no_room_is_refused() {
    for (margin, is_refused) in [("0", true), ("0.002", true), ("0.0021", false)] {
        let vehicle = format!(
            r#"{{"vehicles":[{{"manufacturer":"m","serialNumber":"1","radius":0.4,"margin":{margin},"speed":1,"acceleration":1}}]}}"#
        );
        let vehicles = file("margin", "vehicles.json", &vehicle);
        let run = run(&["serve", "--broker", "localhost:1", "--fleet", &vehicles]);
        let reason = "vehicles[0]: margin: has to be more than 0.002 m";
        assert_eq!((run.status == 2, run.err.contains(reason)), (is_refused, is_refused), "{margin}: {}", run.err);
    }
}

/// The log did not say which robots there are.
#[test]
fn robots_that_come_and_go_are_logged() {
    let remove = r#"{"id":3,"verb":"remove","robot":"a"}"#;
    let run = run_with(&["serve"], format!("{ADD}{remove}\n").as_bytes());
    assert_eq!(run.status, 0, "{}", run.err);
    let lines: Vec<&str> = run.err.lines().filter(|line| line.contains("msg=\"a robot was ")).collect();
    let expected =
        ["level=info msg=\"a robot was added\" robot=\"a\"", "level=info msg=\"a robot was removed\" robot=\"a\""];
    assert!(lines.len() == 2 && lines.iter().zip(expected).all(|(line, said)| line.ends_with(said)), "{lines:?}");
}

#[test]
fn a_log_level_beside_quiet_is_refused() {
    for words in [["-q", "serve", "--log", "debug"], ["serve", "--log", "debug", "-q"]] {
        let refused = run(&words).failed(2);
        assert_eq!(refused, "pcr: --log has no effect: with --quiet only errors are told\n", "{words:?}");
    }
}

#[test]
fn vehicles_are_written_as_they_are_read() {
    let folder = directory("profiles");
    let name = folder.join("vehicles.json").to_string_lossy().into_owned();
    let fleet = ["fleet", LAYOUT, "--vehicles", "3", "--alone", "supervisor", "--time", "0.2", "-q", "--profiles"];
    run(&[&fleet[..], &[&name]].concat()).ok();
    let text = std::fs::read_to_string(&name).unwrap();
    assert!(text.starts_with(r#"{"format":"pcr-vehicles","version":1,"vehicles":["#), "{text}");
    let refused = |text: &str| {
        let name = file("profiles", "changed.json", text);
        run(&["serve", "--log", "error", "--broker", "localhost:1", "--fleet", &name]).failed(2)
    };
    assert!(refused(r#"{"version":1}"#).ends_with("vehicles: a list is expected\n"));
    for (from, to, reason) in [
        ("pcr-vehicles", "pcr-plan", "format: \"pcr-plan\" where pcr-vehicles is expected"),
        ("\"version\":1", "\"version\":2", "version: 2 where 1 is expected"),
        ("\"radius\":", "\"radius\":0.1,\"radius\":", "not JSON: \"radius\" is there twice"),
        (
            "\"radius\":",
            "\"footprint\":{\"polygon\":[]},\"radius\":",
            "vehicles[0]: footprint: 0 corners; allowed are 3 to 256",
        ),
        (
            "\"radius\":",
            "\"footprint\":{\"polygon\":[{\"ahead\":1,\"left\":0},{\"ahead\":0,\"left\":1},{\"ahead\":0,\"left\":0}]},\"radius\":",
            "vehicles[0]: radius: there is a radius or a footprint, not both",
        ),
        ("\"version\"", "\"versions\"", "versions: unknown; format, version and vehicles are read"),
    ] {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text);
        let failed = refused(&changed);
        assert!(failed.ends_with(&format!("{reason}\n")), "{failed}");
    }
}

/// A disc on which a journal finds no room: the process may not write files that long.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disc_gives_no_right() {
    let folder = directory("full").join("state");
    let _ = std::fs::remove_dir_all(&folder);
    let mut command = std::process::Command::new("sh");
    command.args(["-c", "ulimit -f 512; exec \"$0\" serve --log error --journal \"$1\""]);
    command.arg(pcr().get_program()).arg(&folder);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut stdin = child.stdin.take().unwrap();
    // The tool may have ended before it has read all.
    let _ = std::io::Write::write_all(&mut stdin, ADD.as_bytes());
    let output = child.wait_with_output().unwrap();
    drop(stdin);
    let (out, err) = (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap());
    let journal = folder.join("journal").to_string_lossy().into_owned();
    assert_eq!(output.status.code(), Some(3), "{out}{err}");
    assert!(err.contains("pcr: the journal cannot be written, so no robot gets the right of way any more: "), "{err}");
    assert!(err.contains(&format!("{journal}: File too large")), "{err}");
    // Whatever was answered, nothing was admitted.
    for line in out.lines() {
        let line: Value = serde_json::from_str(line).unwrap();
        assert_eq!(line["error"]["code"], "broken", "{line}");
        assert!(line["error"]["message"].as_str().unwrap().contains(&journal), "{line}");
    }
    // What is there is a journal, and with room it goes on.
    let name = folder.to_string_lossy().into_owned();
    let again = run_with(&["serve", "--log", "error", "--journal", &name], ADD.as_bytes()).ok();
    let first: Value = serde_json::from_str(again.lines().next().unwrap()).unwrap();
    assert_eq!(first, json!({ "pcr": 1, "id": 1, "ok": { "path": 1 } }));
}

/// It ended with status 0, and said nothing.
#[cfg(target_os = "linux")]
#[test]
fn answers_that_cannot_be_written_end_it() {
    let full = || std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let start = |arguments: &[&str], out: Stdio| {
        let mut command = pcr();
        command.arg("serve").args(arguments).stdin(Stdio::piped()).stdout(out).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut stdin = child.stdin.take().unwrap();
        std::io::Write::write_all(&mut stdin, ADD.as_bytes()).unwrap();
        (child, stdin)
    };
    let why = "msg=\"standard output cannot be written: answers to standard input are lost\"";
    let said = |child: std::process::Child, status: i32| {
        let output = child.wait_with_output().unwrap();
        let err = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(status), "{err}");
        assert!(err.contains(why), "{err}");
        err
    };
    // Where the input has ended, and where it goes on.
    for ends in [true, false] {
        let (child, stdin) = start(&["--log", "error"], full().into());
        let stdin = Some(stdin).filter(|_| !ends);
        let err = said(child, 3);
        assert!(err.contains("level=error") && err.contains("pcr: standard output: cannot be written: "), "{err}");
        drop(stdin);
    }
    // A reader who goes is an end like that of the input.
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let (child, stdin) = start(&["--log", "warn"], writer.into());
    let err = said(child, 0);
    assert!(err.contains("level=warn") && !err.contains("pcr: "), "{err}");
    drop(stdin);
}

/// A supervisor that takes clients of the lines, and what it has logged at its start.
#[cfg(target_os = "linux")]
pub(crate) struct Listening {
    pub(crate) child: std::process::Child,
    pub(crate) log: Box<dyn Iterator<Item = String>>,
    /// The line that says where it listens.
    pub(crate) said: String,
}

#[cfg(target_os = "linux")]
impl Listening {
    pub(crate) fn start(arguments: &[&str], out: Stdio) -> Self {
        use std::io::{BufRead, BufReader};
        let mut command = pcr();
        command.args(["serve", "--stay"]).args(arguments).stdin(Stdio::piped()).stdout(out).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let mut log = BufReader::new(child.stderr.take().unwrap()).lines().map_while(Result::ok);
        let said = log.by_ref().find(|line| line.contains("msg=\"listening\""));
        let said = said.unwrap_or_else(|| panic!("{arguments:?}: it does not listen"));
        Self { child, log: Box::new(log), said }
    }

    /// A value of that line.
    pub(crate) fn value(&self, key: &str) -> String {
        let (_, rest) =
            self.said.split_once(&format!(" {key}=\"")).unwrap_or_else(|| panic!("{}: no {key}", self.said));
        rest.split('"').next().unwrap().to_owned()
    }

    fn client(&self) -> std::net::TcpStream {
        std::net::TcpStream::connect(self.value("address")).unwrap()
    }

    fn hello(&self) -> String {
        let token = std::fs::read_to_string(self.value("token")).unwrap();
        format!("{}\n", json!({ "pcr": 1, "verb": "hello", "token": token.trim_end() }))
    }
}

#[cfg(target_os = "linux")]
impl Drop for Listening {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Writes lines and returns those that come back until the connection ends.
#[cfg(target_os = "linux")]
pub(crate) fn answers(mut stream: impl std::io::Read + std::io::Write, lines: &str) -> Vec<Value> {
    use std::io::{BufRead, BufReader};
    stream.write_all(lines.as_bytes()).unwrap();
    BufReader::new(stream).lines().map_while(Result::ok).map(|line| serde_json::from_str(&line).unwrap()).collect()
}

#[cfg(target_os = "linux")]
pub(crate) const ROBOTS: &str = "{\"verb\":\"query\",\"what\":\"robots\"}\n";

/// Ends a connection.
#[cfg(target_os = "linux")]
pub(crate) const END: &str = "end\n";

/// Robots and other clients still need a supervisor whose own output is full.
#[cfg(target_os = "linux")]
#[test]
fn it_stays_where_answers_cannot_be_written() {
    use std::io::Write;
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let folder = directory("stays").join("state");
    let _ = std::fs::remove_dir_all(&folder);
    let mut own = Listening::start(&["--journal", folder.to_str().unwrap(), "--listen", "0"], full.into());
    own.child.stdin.take().unwrap().write_all(ADD.as_bytes()).unwrap();
    assert!(own.log.any(|line| line.contains("level=error") && line.contains("standard output cannot be written")));
    let said = answers(own.client(), &format!("{}{ROBOTS}{END}", own.hello()));
    assert_eq!(said[1]["ok"]["robots"][0]["mission"], "1", "{said:?}");
}

/// Whoever could connect could command robots: any program of the machine, and any page in a browser.
#[cfg(target_os = "linux")]
#[test]
fn clients_over_tcp_need_the_token_of_a_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = directory("token").join("state");
    let _ = std::fs::remove_dir_all(&folder);
    let name = folder.to_str().unwrap();
    let mut own = Listening::start(&["--journal", name, "--listen", "0"], Stdio::null());
    let token = folder.join("token");
    assert_eq!(own.value("token"), token.to_string_lossy());
    assert_eq!(std::fs::metadata(&token).unwrap().permissions().mode() & 0o777, 0o600);
    let secret = std::fs::read_to_string(&token).unwrap().trim_end().to_owned();
    assert!(!own.said.contains(&secret));
    let post = format!(
        "POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://evil.example\r\nContent-Length: {}\r\n\r\n{ADD}{END}",
        ADD.len() + END.len()
    );
    for (lines, code, kind) in [
        (format!("{ADD}{END}"), "no_hello", "its first line is no hello"),
        (format!("{{\"pcr\":1,\"verb\":\"hello\"}}\n{ADD}{END}"), "unauthorized", "hello has no token"),
        (own.hello().replace(&secret[..9], "000000000") + ADD, "unauthorized", ""),
        (own.hello().replace(":1", ":2") + ADD, "version", "its hello has another version, or none"),
        (post, "malformed", "a browser or an HTTP client has sent a request to the lines"),
    ] {
        let said = answers(own.client(), &lines);
        assert_eq!((said.len(), &said[0]["error"]["code"]), (1, &json!(code)), "{lines}: {said:?}");
        if !kind.is_empty() {
            let line = own.log.find(|line| line.contains("msg=\"a connection to the lines is refused\"")).unwrap();
            assert!(line.contains("level=warn") && line.contains(kind), "{line}");
            assert!(
                !line.contains(&secret) && (code != "malformed" || line.contains("page=\"http://evil.example\"")),
                "{line}"
            );
        }
    }
    let said = answers(own.client(), &format!("{}{ROBOTS}{ADD}{END}", own.hello()));
    assert_eq!(said[0]["ok"]["fleet"]["robots"], 0, "{said:?}");
    assert_eq!((&said[1]["ok"]["robots"], &said[2]["ok"]["path"]), (&json!([]), &json!(1)), "{said:?}");
    // The next start has the same token.
    drop(own);
    let own = Listening::start(&["--journal", name, "--listen", "127.0.0.1:0"], Stdio::null());
    assert_eq!(std::fs::read_to_string(&token).unwrap().trim_end(), secret);
    let said = answers(own.client(), &format!("{}{ROBOTS}{END}", own.hello()));
    assert_eq!(said[1]["ok"]["robots"][0]["robot"], "a", "{said:?}");
    drop(own);
    // One that others may read is refused, here and anywhere else.
    std::fs::set_permissions(&token, std::fs::Permissions::from_mode(0o644)).unwrap();
    let refused = run(&["serve", "--log", "error", "--journal", name, "--listen", "0"]).failed(2);
    assert!(
        refused.starts_with(&format!("pcr: --token-file: {}: others than its owner may read", token.display())),
        "{refused}"
    );
    let own = folder.join("own");
    let own = Listening::start(&["--token-file", own.to_str().unwrap(), "--listen", "0"], Stdio::null());
    assert_eq!(answers(own.client(), &format!("{}{END}", own.hello()))[0]["ok"]["version"], 1);
}

/// At a socket in the folder of the journal, programs of the same user are clients.
#[cfg(target_os = "linux")]
#[test]
fn clients_at_a_socket_need_a_hello_and_no_token() {
    use std::os::unix::fs::{FileTypeExt, PermissionsExt};
    use std::os::unix::net::UnixStream;
    let folder = directory("socket").join("state");
    let _ = std::fs::remove_dir_all(&folder);
    let name = folder.to_str().unwrap();
    let socket = folder.join("socket");
    let other = format!("unix:{}", folder.join("other").display());
    for round in 0..3 {
        // Once after an end in order, and once after a kill.
        let mut own =
            Listening::start(&["--journal", name, "--listen", "--listen", &other, "--silence", "9"], Stdio::null());
        assert_eq!(own.value("socket"), socket.to_string_lossy());
        let kind = std::fs::symlink_metadata(&socket).unwrap();
        assert!(kind.file_type().is_socket() && kind.permissions().mode() & 0o777 == 0o600);
        let said = answers(UnixStream::connect(&socket).unwrap(), &format!("{ADD}{END}"));
        assert_eq!((said.len(), &said[0]["error"]["code"]), (1, &json!("no_hello")), "{said:?}");
        let said =
            answers(UnixStream::connect(&socket).unwrap(), &format!("{{\"pcr\":1,\"verb\":\"hello\"}}\n{ROBOTS}{END}"));
        assert_eq!((said.len(), &said[1]["ok"]["robots"]), (3, &json!([])), "{said:?}");
        assert!(own.log.any(|line| line.contains("msg=\"listening\"") && line.contains("other\"")));
        assert!(UnixStream::connect(folder.join("other")).is_ok());
        if round == 0 {
            // Another supervisor does not take it.
            let place = format!("unix:{}", socket.display());
            let refused = run(&["serve", "--log", "error", "--listen", &place]).failed(2);
            assert_eq!(refused, format!("pcr: --listen: {}: another program listens there\n", socket.display()));
            let ends = std::process::Command::new("kill").arg(own.child.id().to_string()).status().unwrap();
            assert!(ends.success() && own.child.wait().unwrap().success());
            assert!(!socket.exists());
        }
    }
    assert!(!folder.join("token").exists());
}

#[test]
fn places_that_are_none_and_addresses_of_others_are_refused() {
    let folder = directory("places").join("state");
    let name = folder.to_str().unwrap();
    for (arguments, reason) in [
        (
            &["--listen", "0"][..],
            "--listen: clients over TCP need a token: --journal DIR keeps it in DIR/token, or --token-file FILE says where\n",
        ),
        (
            &["--listen"],
            "--listen: the socket is in the folder of --journal, which is not given; or --listen unix:PATH\n",
        ),
        (
            &["--journal", name, "--listen", "--token-file", "x"],
            "--token-file has no effect: only clients over TCP need a token\n",
        ),
        (&["--journal", name, "--allow-remote"], "--allow-remote has no effect: --listen names no address\n"),
        (
            &["--journal", name, "--listen", "0.0.0.0:0"],
            "--listen: 0.0.0.0:0: other machines can reach this address, and neither the token nor the lines are encrypted",
        ),
        (&["--journal", name, "--listen", "[::]:0"], "other machines can reach this address"),
        (&["--journal", name, "--listen", "/tmp/x"], "unix:PATH, a port (0 to 65535) or ADDRESS:PORT is expected"),
        (&["--journal", name, "--listen", "unix:/"], "--listen: /: "),
    ] {
        let run = run(&[&["serve", "--log", "error"][..], arguments].concat());
        assert_eq!((run.status, run.out.as_str()), (2, ""), "{arguments:?}: {}", run.err);
        assert!(run.err.contains(reason), "{arguments:?}: {}", run.err);
    }
}

/// It was the journal of which was said that it cannot be written.
#[cfg(target_os = "linux")]
#[test]
fn a_record_that_cannot_be_written_is_named() {
    let fleet = ["fleet", LAYOUT, "--vehicles", "3", "--alone", "supervisor", "-q", "--record", "/dev/full", "--time"];
    // At once, and at the end.
    for time in ["600", "1"] {
        let failed = run(&[&fleet[..], &[time]].concat()).failed(3);
        assert!(failed.starts_with("pcr: /dev/full: cannot be written: "), "{failed}");
    }
}

/// One that was cut within a line was refused as a file that is no record.
#[test]
fn a_record_that_was_cut_is_undecided() {
    let name = directory("cut").join("run.txt").to_string_lossy().into_owned();
    run(&["fleet", LAYOUT, "--vehicles", "3", "--alone", "supervisor", "--time", "60", "-q", "--record", &name]).ok();
    let whole = std::fs::read(&name).unwrap();
    run(&["fleet", "--certify", &name]).ok();
    for end in [whole.len() / 2, whole.len() - 10] {
        let name = file("cut", "part.txt", &whole[..end]);
        let said = run(&["fleet", "--certify", &name]);
        assert_eq!(said.status, 4, "{}", said.err);
        assert!(said.out.contains("the record is cut: its last line is missing"), "{}", said.out);
    }
}

/// Folders in which nobody can write, not even root.
#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_cannot_be_written_is_named() {
    for folder in ["/sys/pcr-journal".into(), format!("{}/state", file("unwritable", "a-file", ""))] {
        let failed = run_with(&["serve", "--log", "error", "--journal", &folder], ADD.as_bytes()).failed(3);
        let begins = format!("pcr: the journal cannot be opened, so no robot gets the right of way: {folder}: ");
        assert!(failed.starts_with(&begins), "{failed}");
    }
}

#[test]
fn layouts_and_records_come_in_by_pipes() {
    let layout = std::fs::read(LAYOUT).unwrap();
    let name = directory("pipes").join("run.txt").to_string_lossy().into_owned();
    let fleet = ["--vehicles", "3", "--alone", "supervisor", "--time", "20", "-q"];
    run(&[&["fleet", LAYOUT, "--record", &name][..], &fleet].concat()).ok();
    let record = std::fs::read(&name).unwrap();
    for first in [&["fleet"][..], &["fleet", "-"]] {
        run_with(&[first, &fleet, &["--record", &name]].concat(), &layout).ok();
        assert!(std::fs::read(&name).unwrap() == record, "the same vehicles");
    }
    let proved = run_with(&["fleet", "--certify", "-"], &record).json();
    assert_eq!(proved["verdict"], "proved");
    let unknown = run_with(&["fleet", "--alone", "supervisor", "--time", "1"], b"nonsense").failed(2);
    assert_eq!(unknown, "pcr: standard input: not known as a layout by its name or content\n");
}

/// As everything else that is written.
#[cfg(target_os = "linux")]
#[test]
fn a_record_is_written_as_a_whole_or_not_at_all() {
    let name = file("whole", "run.txt", "before");
    let script = "ulimit -f 1; exec \"$0\" \"$@\"";
    let fleet = ["fleet", LAYOUT, "--vehicles", "3", "--alone", "supervisor", "--time", "60", "-q", "--record", &name];
    let mut limited = std::process::Command::new("bash");
    let output = limited.args(["-c", script, env!("CARGO_BIN_EXE_pcr")]).args(fleet).output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3), "{message}");
    assert!(message.starts_with(&format!("pcr: {name}: cannot be written: ")), "{message}");
    assert_eq!(std::fs::read_to_string(&name).unwrap(), "before");
    assert_eq!(std::fs::read_dir(directory("whole")).unwrap().count(), 1);
    let message = run(&[&fleet[..], &["--profiles", &name]].concat()).failed(2);
    assert_eq!(message, "pcr: --profiles and --record name the same file; two files are written\n");
    assert_eq!(std::fs::read_to_string(&name).unwrap(), "before");
}

#[test]
fn vehicles_on_standard_output_are_alone_there() {
    let fleet = ["fleet", LAYOUT, "--vehicles", "3", "--alone", "supervisor", "--time", "1", "--profiles", "-"];
    let run = run(&fleet);
    assert!(run.status == 0 && run.err.contains("3 vehicles, 1 s of theirs: "), "{}", run.err);
    assert_eq!(serde_json::from_str::<Value>(&run.out).unwrap()["vehicles"].as_array().unwrap().len(), 3);
}

#[test]
fn warnings_about_a_layout_are_told_as_everywhere() {
    let track = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/real/opendrive/Town02.planview.xodr");
    let fleet = ["fleet", track, "--vehicles", "2", "--alone", "supervisor", "--time", "1"];
    let told = run(&fleet).err;
    let expected = run(&["locks", track, "--radius", "0.4", "--format", "csv"]).err;
    assert!(!expected.is_empty() && told.contains(expected.lines().next().unwrap()), "{told}\n{expected}");
}

/// It ended as if all had been well, and nobody was ever connected.
#[test]
fn vehicles_without_a_broker_say_so() {
    let record = directory("broker").join("record.txt");
    let record = record.to_str().unwrap();
    let fleet = [
        "fleet",
        "--streets",
        "4",
        "--vehicles",
        "2",
        "--broker",
        "localhost:1",
        "--pace",
        "10",
        "--time",
        "4",
        "--record",
        record,
    ];
    let run = run(&fleet);
    let lines: Vec<&str> = run.err.lines().collect();
    assert_eq!((run.status, run.out.as_str(), lines.len()), (2, "", 2), "{}", run.err);
    assert!(lines[0].starts_with("pcr: no broker: ") && lines[0].ends_with("; it is tried again"), "{}", lines[0]);
    assert!(lines[1].starts_with("pcr: no vehicle has reached a broker: "), "{}", lines[1]);
    assert!(!std::path::Path::new(record).exists());
}

/// A broker that answers all who come with this code: 0 lets them in.
fn broker(code: u8) -> String {
    use std::io::{Read, Write};
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let place = listener.local_addr().unwrap().to_string();
    std::thread::spawn(move || {
        for stream in listener.incoming() {
            let (mut stream, mut packet) = (stream.unwrap(), [0; 1024]);
            let _ = stream.read(&mut packet);
            let _ = stream.write_all(&[0x20, 2, 0, code]);
            // Until the other end closes.
            while stream.read(&mut packet).is_ok_and(|count| count > 0) {}
        }
    });
    place
}

const VEHICLES: &str =
    r#"{"vehicles":[{"manufacturer":"m","serialNumber":"1","radius":0.4,"margin":0.1,"speed":1,"acceleration":1}]}"#;

#[test]
fn what_would_be_wrong_is_said_before_the_start() {
    let folder = directory("serve-check");
    let _ = std::fs::remove_dir_all(folder.join("state"));
    let name = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let vehicles = file("serve-check", "vehicles.json", VEHICLES);
    let (journal, open) = (name("state"), broker(0));
    let check = |more: &[&str]| run(&[&["serve", "--check"][..], more].concat());
    let at_broker = ["--fleet", &vehicles, "--broker", &open];
    let right = check(&[&at_broker[..], &["--journal", &journal, "--page", "0", "--listen"]].concat());
    assert_eq!(right.status, 0, "{} {}", right.out, right.err);
    assert_eq!(
        right.out,
        "vehicles: 1\nthe broker lets it in\njournal: there is none yet; robots must stand at the start\nnothing is wrong\n"
    );
    assert!(right.err.contains("no user for the broker"), "{}", right.err);
    // It has written nothing.
    assert!(!folder.join("state").exists());

    let wrong = |more: &[&str], reason: &str| {
        let run = check(more);
        let is_said = run.out.lines().any(|line| line.starts_with("wrong: ") && line.contains(reason));
        assert!(
            run.status == 2 && is_said && !run.out.contains("nothing is wrong"),
            "{reason}: {} {}",
            run.out,
            run.err
        );
        run.out
    };
    wrong(&["--fleet", &vehicles, "--broker", &broker(5)], "NotAuthorized");
    wrong(&["--fleet", &name("none.json"), "--broker", &open], "none.json: ");
    for (from, to, reason) in [
        ("\"speed\"", "\"pace\"", "vehicles[0]: pace: unknown"),
        ("\"radius\":0.4,", "", "vehicles[0]: radius: a number is expected"),
        ("\"radius\"", "\"away\":1,\"radius\"", "vehicles[0]: away: true or false is expected"),
        ("\"radius\"", "\"places\":[],\"radius\"", "vehicles[0]: places: a list with a place is expected"),
        (
            "\"radius\"",
            "\"places\":[{\"x\":1,\"y\":2}],\"radius\"",
            "vehicles[0]: places[0]: within: a number is expected",
        ),
        (
            "\"radius\"",
            "\"places\":[{\"x\":1,\"y\":2,\"within\":-1}],\"radius\"",
            "places[0]: within: -1 is out of range",
        ),
        ("\"radius\"", "\"places\":[{\"x\":1e30,\"y\":2,\"within\":1}],\"radius\"", "places[0]: x, y: out of range"),
        (
            "\"radius\"",
            "\"places\":[{\"x\":1,\"y\":2,\"within\":1,\"z\":1}],\"radius\"",
            "places[0]: x, y and within are read",
        ),
    ] {
        let changed = file("serve-check", "changed.json", VEHICLES.replace(from, to));
        wrong(&["--fleet", &changed, "--broker", &open], reason);
    }
    let more = "\"away\":true,\"places\":[{\"x\":1,\"y\":2,\"within\":0.5}],\"radius\"";
    let changed = file("serve-check", "changed.json", VEHICLES.replace("\"radius\"", more));
    assert_eq!(check(&["--fleet", &changed, "--broker", &open]).status, 0);
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    run_with(&["serve", "--log", "error", "--journal", &journal], ADD.as_bytes()).ok();
    assert_eq!(check(&["--journal", &journal]).out, "journal: 1 robots\nnothing is wrong\n");
    // All that is wrong is said at once, and the journal stays as it is.
    let file = folder.join("state/journal");
    let bytes = std::fs::read(&file).unwrap();
    let mut other = bytes.clone();
    other[12] = 99;
    std::fs::write(&file, &other).unwrap();
    let said = wrong(&["--journal", &journal, "--page", &port], "it is of version 99, and ");
    assert!(said.contains("wrong: --page: ") && said.lines().count() == 2, "{said}");
    assert_eq!(std::fs::read(&file).unwrap(), other);
    let mut damaged = bytes;
    damaged[40] ^= 1;
    std::fs::write(&file, &damaged).unwrap();
    wrong(&["--journal", &journal], "state: ");
    let lock = std::fs::File::open(folder.join("state/lock")).unwrap();
    lock.try_lock().unwrap();
    wrong(&["--journal", &journal], "another supervisor has it open");
}

/// The options of the unit and of the container are those of this program.
#[test]
fn deployment_files_start_this_program() {
    let deploy =
        |name: &str| std::fs::read_to_string(format!("{}/serve/deploy/{name}", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let unit = deploy("pcr-serve.service");
    let unit: Vec<&str> =
        unit.lines().find_map(|line| line.strip_prefix("ExecStart=/usr/local/bin/pcr ")).unwrap().split(' ').collect();
    let container = deploy("Containerfile");
    let listed = |key: &str| -> Vec<String> {
        serde_json::from_str(container.lines().find_map(|line| line.strip_prefix(key)).unwrap()).unwrap()
    };
    let container = [listed("ENTRYPOINT "), listed("CMD ")].concat();
    let container: Vec<&str> = container.iter().skip(1).map(String::as_str).collect();
    let vehicles = file("deployment", "vehicles.json", VEHICLES);
    let (open, journal) = (broker(0), directory("deployment").join("state").to_string_lossy().into_owned());
    for words in [unit, container] {
        // Places of this test instead of those of a machine.
        let words = words.iter().map(|word| match *word {
            "/etc/pcr/vehicles.json" => &vehicles,
            "localhost:1883" | "broker:1883" => &open,
            "127.0.0.1:8080" | "0.0.0.0:8080" => "0",
            "${STATE_DIRECTORY}/journal" | "/var/lib/pcr-serve/journal" => &journal,
            word => word,
        });
        let words: Vec<&str> = words.chain(["--check"]).collect();
        let run = run(&words);
        assert!(run.status == 0 && run.out.ends_with("nothing is wrong\n"), "{words:?}: {} {}", run.out, run.err);
    }
}
