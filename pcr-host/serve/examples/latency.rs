//! How long it takes from a position to everything that follows from it, with a journal on the disc. Robots go to and fro on crossing lanes,
//! 25 one way and 25 the other in a hall, as many halls as it takes, and say where they are so many times a second, whether they were
//! answered or not. With a rate of 0 they say it as fast as answers come, 256 at once.
//!
//! `cargo run --release -p pcr-serve --example latency -- ROBOTS RATE MESSAGES`

use pcr_serve::journal::Journal;
use pcr_serve::journal_writer::JournalWriter;
use pcr_serve::lines::RequestLine;
use pcr_serve::log::{LogLevel, LogWriter};
use pcr_serve::outbox::{OutboxReceiver, outbox};
use pcr_serve::server::{ServerHandle, ServerInput, queue, serve};
use pcr_serve::supervisor::{Supervisor, SupervisorConfig};
use serde_json::{Value, json};
use std::error::Error;
use std::f64::consts::{FRAC_PI_2, PI};
use std::time::{Duration, Instant};

const LANES: usize = 25;
const SPACE: f64 = 2.0;
/// Of the robots' time between two positions \[s\].
const STEP: f64 = 0.1;
const WINDOW: usize = 256;

#[derive(Clone, Copy, Default)]
struct Robot {
    path: u64,
    origin: f64,
    length: f64,
    at: f64,
    hold: f64,
    missions: u64,
    asked: bool,
}

struct Driver {
    handle: ServerHandle,
    lines: OutboxReceiver,
    robots: Vec<Robot>,
    /// When each message was sent, by its number; of missions nothing.
    sent: Vec<Option<Instant>>,
    open: usize,
    /// Of positions; of those after which somebody may go on; and when the last of them was sent.
    times: [Vec<f64>; 2],
    last: Option<Instant>,
    done: u64,
}

impl Driver {
    fn ask(&mut self, request: Value, is_position: bool) {
        let mut request = request;
        request["id"] = self.sent.len().into();
        self.sent.push(is_position.then(Instant::now));
        self.open += 1;
        self.handle.send(ServerInput::Line(1, RequestLine::read(request.to_string().as_bytes())));
    }

    fn position(&mut self, k: usize) {
        let robot = &mut self.robots[k];
        robot.at = (robot.at + STEP).min(robot.hold).min(robot.length);
        let (at, path, arrived) = (robot.at, robot.path, robot.at >= robot.length - 1e-3);
        let asks = arrived && !robot.asked;
        self.ask(json!({ "verb": "position", "robot": k.to_string(), "path": path, "at": [at, at] }), true);
        if asks {
            let robot = &mut self.robots[k];
            (robot.asked, robot.missions) = (true, robot.missions + 1);
            let there = json!({ "kind": "line", "length": SPACE * LANES as f64 + 4.0 });
            let turn = json!({ "kind": "turn", "sweep": PI });
            let path = if robot.missions == 1 { json!([there]) } else { json!([turn, there]) };
            let mission = robot.missions.to_string();
            self.ask(json!({ "verb": "mission", "robot": k.to_string(), "mission": mission, "path": path }), false);
        }
    }

    fn take(&mut self, line: &str) {
        let Ok(line) = serde_json::from_str::<Value>(line) else { return };
        if let Some(id) = line["id"].as_u64() {
            self.open -= 1;
            assert!(line["error"].is_null(), "{line}");
            if let Some(sent) = self.sent.get(id as usize).copied().flatten() {
                self.times[0].push(sent.elapsed().as_secs_f64());
                self.last = Some(sent);
            }
            return;
        }
        let number = |name: &str| line[name].as_f64().unwrap_or_default();
        let Some(k) = line["robot"].as_str().and_then(|name| name.parse::<usize>().ok()) else { return };
        let robot = &mut self.robots[k];
        match line["event"].as_str() {
            Some("admitted") => {
                robot.at += robot.origin - number("origin");
                (robot.origin, robot.length, robot.hold) = (number("origin"), number("length"), number("hold"));
                (robot.path, robot.asked) = (line["path"].as_u64().unwrap_or_default(), false);
                self.done += 1;
            }
            Some("hold") => {
                robot.hold = robot.hold.max(number("hold"));
                // Events come right after the answers that they were decided with.
                self.times[1].extend(self.last.map(|sent| sent.elapsed().as_secs_f64()));
            }
            _ => {}
        }
    }

    /// Reads what comes until a time, or until there is room for more.
    fn wait(&mut self, until: Option<Instant>) {
        loop {
            let left = until.map(|until| until.saturating_duration_since(Instant::now()));
            match left {
                Some(left) => match self.lines.recv_timeout(left) {
                    Ok(line) => self.take(&line),
                    Err(_) => return,
                },
                None if self.open >= WINDOW => match self.lines.recv() {
                    Ok(line) => self.take(&line),
                    Err(_) => return,
                },
                None => return,
            }
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let numbers: Vec<f64> = std::env::args().skip(1).map(|word| word.parse()).collect::<Result<_, _>>()?;
    let [count, rate, messages] = numbers[..] else { return Err("latency ROBOTS RATE MESSAGES".into()) };
    let (count, messages) = (count as usize, messages as usize);
    let folder = std::env::temp_dir().join(format!("pcr-latency-{}", std::process::id()));
    let (journal, _) = Journal::open(&folder)?;
    let (handle, inputs) = queue();
    let own = handle.clone();
    let writer = JournalWriter::start(Box::new(journal), move || own.wake())?;
    let kept = writer.kept();
    let mut supervisor = Supervisor::new(SupervisorConfig::default(), Box::new(writer));
    let server = std::thread::spawn(move || {
        let result = serve(&mut supervisor, &inputs, &kept, LogWriter::new(LogLevel::Error));
        (result, supervisor.counts())
    });
    let (out, lines) = outbox();
    handle.send(ServerInput::Opened(1, out));
    let robots = vec![Robot { path: 1, ..Robot::default() }; count];
    // Room that is there from the start: what grows is the supervisor's.
    let room = 2 * messages + 4 * count;
    let (mut sent, mut times) = (vec![Some(Instant::now()); room], [vec![1.0; room], vec![1.0; room]]);
    sent.clear();
    times.iter_mut().for_each(Vec::clear);
    let mut own = Driver { handle, lines, robots, sent, open: 0, times, last: None, done: 0 };
    own.ask(json!({ "verb": "watch" }), false);
    let width = SPACE * LANES as f64;
    for k in 0..count {
        let (hall, lane, across) = (k / (2 * LANES), (k / 2) % LANES, k % 2 == 1);
        let (x, y) = (hall as f64 * (width + 10.0), SPACE * (lane as f64 + 0.5));
        let (x, y, heading) = if across { (x + y, -2.0, FRAC_PI_2) } else { (x - 2.0, y, 0.0) };
        let abilities = json!({ "radius": 0.4, "margin": 0.05, "speed": 1.0, "acceleration": 0.5 });
        let start = json!({ "x": x, "y": y, "heading": heading });
        own.ask(json!({ "verb": "add", "robot": k.to_string(), "start": start, "abilities": abilities }), false);
        own.wait(None);
    }
    let (begin, mut first) = (Instant::now(), 0);
    for message in 0..messages {
        let due = begin + Duration::from_secs_f64(message as f64 / (rate * count as f64).max(1e-9));
        own.wait((rate > 0.0).then_some(due));
        own.position(message % count);
        if message == messages / 10 {
            first = memory();
        }
    }
    while own.open > 0 {
        let line = own.lines.recv()?;
        own.take(&line);
    }
    let (all, last) = (begin.elapsed().as_secs_f64(), memory());
    own.handle.send(ServerInput::Stop);
    let (result, counts) = server.join().map_err(|_| "the server has panicked")?;
    result.map_err(|fault| fault.to_string())?;
    println!("{count} robots, {messages} positions in {all:.1} s, {} missions, {} writes", own.done, counts.writes);
    for (what, times) in ["a position to its answer", "a position to a hold that follows"].iter().zip(&mut own.times) {
        times.sort_unstable_by(f64::total_cmp);
        let at =
            |part: f64| times.get((times.len() as f64 * part) as usize).or(times.last()).map_or(0.0, |it| it * 1e3);
        let [half, most, nearly, longest] = [0.5, 0.99, 0.999, 1.0].map(at);
        println!("{what}: p50 {half:.3} ms, p99 {most:.3} ms, p99.9 {nearly:.3} ms, longest {longest:.1} ms");
    }
    println!("memory: {first} kB after a tenth, {last} kB at the end");
    std::fs::remove_dir_all(folder)?;
    Ok(())
}

/// Of this process \[kB\], where the system tells; 0 elsewhere.
fn memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmRSS"));
    line.and_then(|line| line.split_whitespace().nth(1)).and_then(|word| word.parse().ok()).unwrap_or_default()
}
