//! `pcr serve` in operation: a standby takes over, and the file of vehicles is read again.
#![cfg(target_os = "linux")]

use crate::fixture::directory;
use crate::serve::{ADD, END, Listening, ROBOTS, answers};
use serde_json::{Value, json};
use std::process::Stdio;

/// What a page answers.
fn page(address: &str, path: &str) -> String {
    use std::io::{Read, Write};
    let mut stream = std::net::TcpStream::connect(address).unwrap();
    write!(stream, "GET {path} HTTP/1.1\r\nHost: {address}\r\n\r\n").unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    answer
}

/// The first one is killed, and the second one goes on with what it had told, at the same socket; then a third one takes over from the second one.
#[test]
fn a_standby_takes_over_when_the_supervisor_at_work_is_killed() {
    use std::os::unix::net::UnixStream;
    let folder = directory("standby").join("state");
    let _ = std::fs::remove_dir_all(&folder);
    let name = folder.to_str().unwrap();
    let start = || Listening::start(&["--standby", "--journal", name, "--page", "0", "--listen"], Stdio::null());
    let hello = r#"{"pcr":1,"verb":"hello"}"#.to_owned() + "\n";
    let asks = |lines: &str| answers(UnixStream::connect(folder.join("socket")).unwrap(), &(hello.clone() + lines));
    // Without another one it is the supervisor at once.
    let mut at_work = start();
    assert!(at_work.said.contains("socket="), "{}", at_work.said);
    let said = asks(&format!("{ADD}{END}"));
    assert_eq!(said[2]["ok"]["verdict"], "admitted", "{said:?}");
    for round in 0..3 {
        let mut standby = start();
        let address = standby.value("address");
        assert!(page(&address, "/healthz").starts_with("HTTP/1.1 200 "));
        let ready = page(&address, "/readyz");
        assert!(ready.starts_with("HTTP/1.1 503 ") && ready.contains("\r\n\r\nstandby: "), "{ready}");
        assert!(page(&address, "/metrics").contains("\npcr_standby 1\n"));
        let line = standby.log.find(|line| line.contains("msg=\"standby: ")).unwrap();
        assert!(line.contains("robots=\"1\""), "{line}");
        let told = asks(&format!("{ROBOTS}{END}"))[1]["ok"]["robots"][0].clone();
        // The one at work has the socket.
        at_work.child.kill().unwrap();
        at_work.child.wait().unwrap();
        assert!(standby.log.any(|line| line.contains("this one takes over")), "round {round}");
        assert!(
            standby.log.any(|line| line.contains("msg=\"listening\"") && line.contains("socket=")),
            "round {round}"
        );
        let knows = asks(&format!("{ROBOTS}{END}"))[1]["ok"]["robots"][0].clone();
        assert_eq!([&knows["mission"], &knows["path"]], [&told["mission"], &told["path"]]);
        assert!(page(&address, "/readyz").starts_with("HTTP/1.1 200 "));
        assert!(page(&address, "/metrics").contains("\npcr_standby 0\n"));
        at_work = standby;
    }
    // One that waits is ended by what ends others, too.
    let mut standby = start();
    assert!(standby.log.any(|line| line.contains("msg=\"standby: ")));
    let kill = std::process::Command::new("kill").args(["-TERM", &standby.child.id().to_string()]).status().unwrap();
    assert!(kill.success());
    assert_eq!(standby.child.wait().unwrap().code(), Some(0));
}

/// On SIGHUP the file of vehicles is read again: who was added or is away since is known, and a file that is wrong changes nothing.
#[test]
fn the_file_of_vehicles_is_read_again_on_a_signal() {
    use std::os::unix::net::UnixStream;
    let folder = directory("reload");
    let state = folder.join("state");
    let _ = std::fs::remove_dir_all(&state);
    let file = folder.join("vehicles.json");
    let vehicle = |serial: &str, away: bool| json!({ "manufacturer": "KIT", "serialNumber": serial, "radius": 0.4, "margin": 0.1, "speed": 1.0, "acceleration": 0.5, "away": away });
    let write = |text: &Value| std::fs::write(&file, text.to_string()).unwrap();
    write(&json!({ "vehicles": [vehicle("1", false)] }));
    // Nobody is at this port: what a file says does not need a broker.
    let [state_name, file_name] = [&state, &file].map(|path| path.to_str().unwrap().to_owned());
    let arguments = ["--journal", &state_name, "--listen", "--broker", "localhost:1", "--fleet", &file_name];
    let mut own = Listening::start(&arguments, Stdio::null());
    let hello = r#"{"pcr":1,"verb":"hello"}"#.to_owned() + "\n";
    let away = || {
        let stream = UnixStream::connect(state.join("socket")).unwrap();
        answers(stream, &format!("{hello}{ROBOTS}{END}"))[1]["ok"]["away"].clone()
    };
    assert_eq!(away(), json!([]));
    let id = own.child.id().to_string();
    let mut reload = |what: &str| -> String {
        let kill = std::process::Command::new("kill").args(["-HUP", &id]).status().unwrap();
        assert!(kill.success());
        own.log.find(|line| line.contains("the file of vehicles was read again")).unwrap_or_else(|| panic!("{what}"))
    };
    write(&json!({ "vehicles": [vehicle("1", true), vehicle("2", true), vehicle("3", false)] }));
    let line = reload("added");
    assert!(line.contains("level=info") && line.contains(r#"added="KIT/2, KIT/3" left_out="""#), "{line}");
    assert_eq!(away(), json!(["KIT/1", "KIT/2"]));
    write(&json!({ "vehicles": [vehicle("2", false), { "manufacturer": "KIT" }] }));
    let line = reload("wrong");
    assert!(line.contains("level=error") && line.contains("vehicles[1]: "), "{line}");
    assert_eq!(away(), json!(["KIT/1", "KIT/2"]), "nothing has changed");
    write(&json!({ "vehicles": [vehicle("1", false), vehicle("2", true)] }));
    let line = reload("left out");
    assert!(line.contains(r#"added="" left_out="KIT/3""#), "{line}");
    assert_eq!(away(), json!(["KIT/2"]));
}
