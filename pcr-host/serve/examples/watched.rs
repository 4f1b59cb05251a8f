//! The live page of a fleet in which everything is to be seen: robots that go, that wait for others, that have arrived, and one that is off
//! its path. Prints the address of the page, and ends with standard input. The pages are looked at with it in a browser:
//! `pcr-host/tests/browser/pages.py`.

use pcr_drawing::live;
use pcr_formats::scenario::Scenario;
use pcr_serve::entry::Nowhere;
use pcr_serve::http::{self, Drawn, Site};
use pcr_serve::log::{Level, Log};
use pcr_serve::server::{Input, queue, serve};
use pcr_serve::supervisor::{Settings, Supervisor};
use pcr_serve::{clients, lines};
use std::io::{Read, Write};
use std::net::TcpListener;
use std::thread;

const ABILITIES: &str = r#"{"radius": 0.4, "speed": 1, "acceleration": 0.5}"#;

/// Name, start, path, and how far along it a robot is.
const ROBOTS: [(&str, [f64; 3], &str, f64); 6] = [
    ("east-1", [-12.0, 0.0, 0.0], r#"{"kind": "line", "length": 24}"#, 6.0),
    ("north-2", [0.0, -9.0, 1.5707963267948966], r#"{"kind": "line", "length": 18}"#, 6.5),
    (
        "turns-3",
        [-6.0, -9.0, 1.5707963267948966],
        r#"{"kind": "line", "length": 6}, {"kind": "arc", "radius": 3, "sweep": -1.5707963267948966}, {"kind": "line", "length": 9}"#,
        1.0,
    ),
    ("west-4", [12.0, 3.0, 3.141592653589793], r#"{"kind": "line", "length": 24}"#, 5.0),
    ("there-5", [8.0, -7.0, 0.0], r#"{"kind": "line", "length": 3}"#, 3.0),
    ("a robot with a name of some length 6", [-9.0, 8.0, 0.0], r#"{"kind": "line", "length": 6}"#, 2.0),
];

fn requests() -> Vec<String> {
    let start = |[x, y, heading]: [f64; 3]| format!(r#"{{"x": {x}, "y": {y}, "heading": {heading}}}"#);
    let lanes: Vec<String> =
        ROBOTS.iter().map(|(_, at, path, _)| format!(r#"{{"start": {}, "path": [{path}]}}"#, start(*at))).collect();
    let mut all = vec![format!(r#"{{"verb": "layout", "name": "hall", "lanes": [{}]}}"#, lanes.join(", "))];
    for (name, at, ..) in ROBOTS {
        let start = start(at);
        all.push(format!(r#"{{"verb": "add", "robot": "{name}", "start": {start}, "abilities": {ABILITIES}}}"#));
    }
    for (place, (name, _, path, _)) in ROBOTS.into_iter().enumerate() {
        all.push(format!(r#"{{"verb": "mission", "robot": "{name}", "mission": "order {place}", "path": [{path}]}}"#));
    }
    for (name, .., at) in ROBOTS {
        all.push(format!(r#"{{"verb": "position", "robot": "{name}", "path": 2, "at": [{at}, {at}]}}"#));
    }
    all.push(format!(r#"{{"verb": "off", "robot": "{}", "x": -5, "y": 6.5}}"#, ROBOTS[5].0));
    all
}

fn draw(fleet: &[Drawn], ego: usize) -> Result<String, String> {
    let agents = fleet.iter().zip(1..).map(|(robot, id)| robot.agent(id));
    live::map(&Scenario::new("fleet", agents.collect()), ego).map_err(|error| error.to_string())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Nobody goes, so nobody reports.
    let settings = Settings { silence: 86400.0, ..Settings::default() };
    let mut supervisor = Supervisor::new(settings, Box::new(Nowhere));
    for request in requests() {
        let answer = lines::handle(&mut supervisor, request.as_bytes(), 0.0).answer;
        if answer.get("ok").is_none() {
            return Err(format!("{request}: {answer}").into());
        }
        supervisor.settle(0.0).map_err(|fault| format!("{fault:?}"))?;
    }
    let (handle, inputs) = queue();
    let page = TcpListener::bind("127.0.0.1:0")?;
    let address = page.local_addr()?;
    let site = Site { page: live::page(), draw: Some(draw), hosts: vec![address.to_string()] };
    let own = handle.clone();
    thread::spawn(move || http::listen(&own, &page, site));
    println!("http://{address}/");
    std::io::stdout().flush()?;
    let own = handle.clone();
    thread::spawn(move || {
        let _ = std::io::stdin().read_to_end(&mut Vec::new());
        own.send(Input::Stop);
    });
    // What is heard of robots now is on the page, too: it has seen no event yet.
    let last = requests().split_off(1 + 2 * ROBOTS.len()).join("\n") + "\n";
    clients::serve(&handle, last.as_bytes(), std::io::sink());
    serve(&mut supervisor, &inputs, Log::new(Level::Error)).map_err(|fault| format!("{fault:?}").into())
}
