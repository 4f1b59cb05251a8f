//! How fast the supervisor is: robots to and fro on crossing lanes, 25 one way and 25 the other in a hall, as many halls as it takes; each
//! says 10 times a second where it is. Every message, or so many together, is decided and written into a journal on the disc.
//!
//! `cargo run --release -p pcr-serve --example load -- ROBOTS SECONDS [TOGETHER]`

use pcr_serve::course::{Shape, Start};
use pcr_serve::event::Event;
use pcr_serve::journal::Journal;
use pcr_serve::robot::Abilities;
use pcr_serve::supervisor::{Proposal, Report, Settings, Supervisor};
use std::f64::consts::{FRAC_PI_2, PI};
use std::time::Instant;

const LANES: usize = 25;
const SPACE: f64 = 2.0;
const RATE: f64 = 10.0;

struct Robot {
    name: String,
    path: u64,
    origin: f64,
    length: f64,
    at: f64,
    hold: f64,
    missions: u32,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let numbers: Vec<f64> = std::env::args().skip(1).map(|word| word.parse()).collect::<Result<_, _>>()?;
    let (count, seconds) = match numbers[..] {
        [count, seconds] | [count, seconds, _] => (count, seconds),
        _ => return Err("load ROBOTS SECONDS [TOGETHER]".into()),
    };
    let together = numbers.get(2).map_or(1, |together| *together as u64);
    let folder = std::env::temp_dir().join(format!("pcr-load-{}", std::process::id()));
    let (journal, _) = Journal::open(&folder)?;
    let mut supervisor = Supervisor::new(Settings::default(), Box::new(journal));
    let abilities = Abilities { radius: 0.4, margin: 0.05, speed: 1.0, acceleration: 0.5 };
    let mut robots = Vec::new();
    let width = SPACE * LANES as f64;
    for k in 0..count as usize {
        let (hall, lane, across) = (k / (2 * LANES), (k / 2) % LANES, k % 2 == 1);
        let (x, y) = (hall as f64 * (width + 10.0), SPACE * (lane as f64 + 0.5));
        let start = match across {
            false => Start { x: x - 2.0, y, heading: 0.0 },
            true => Start { x: x + y, y: -2.0, heading: FRAC_PI_2 },
        };
        let name = format!("robot {k}");
        supervisor.add(&name, abilities, start)?;
        robots.push(Robot { name, path: 1, origin: 0.0, length: 0.0, at: 0.0, hold: 0.0, missions: 0 });
    }
    let begin = Instant::now();
    // Room that is there from the start: what grows is the supervisor's.
    let mut times = vec![1.0; (seconds * RATE * count) as usize];
    times.clear();
    let (mut decisions, mut messages, mut done) = (Vec::new(), 0_u64, 0_u32);
    let mut first = 0;
    for tick in 0..(seconds * RATE) as u64 {
        for k in 0..robots.len() {
            let now = (tick as f64 + k as f64 / robots.len() as f64) / RATE;
            let robot = &mut robots[k];
            robot.at = (robot.at + abilities.speed / RATE).min(robot.hold).min(robot.length);
            let arrived = robot.at >= robot.length - 1e-3;
            let report = Report { robot: robot.name.clone(), path: robot.path, at: [robot.at; 2], age: 0.0 };
            let asked = Instant::now();
            supervisor.position(&report, now)?;
            messages += 1;
            let mut events = Vec::new();
            if messages % together == 0 {
                events = supervisor.settle(now)?;
                times.push(asked.elapsed().as_secs_f64());
            }
            if arrived && supervisor.robot(&robot.name)?.waiting.is_none() {
                robot.missions += 1;
                done += 1;
                let there = Shape::Line { length: width + 4.0 };
                let path = if robot.missions == 1 { vec![there] } else { vec![Shape::Turn { sweep: PI }, there] };
                let mission = format!("mission {}", robot.missions);
                let proposal = Proposal { robot: robot.name.clone(), mission, after: None, start: None, path };
                let asked = Instant::now();
                supervisor.mission(&proposal, now)?;
                events.extend(supervisor.settle(now)?);
                decisions.push(asked.elapsed().as_secs_f64());
            }
            for event in events {
                let number = event.robot().strip_prefix("robot ").and_then(|number| number.parse::<usize>().ok());
                let Some(robot) = number.and_then(|number| robots.get_mut(number)) else { continue };
                match event {
                    Event::Admitted { path, origin, length, hold, .. } => {
                        robot.at += robot.origin - origin;
                        (robot.path, robot.origin, robot.length, robot.hold) = (path, origin, length, hold);
                    }
                    Event::Hold { path, hold, .. } if path == robot.path => robot.hold = hold,
                    _ => {}
                }
            }
        }
        if tick == 50 {
            first = memory();
        }
    }
    let all = begin.elapsed().as_secs_f64();
    let within = |times: &mut Vec<f64>, part: f64| {
        times.sort_unstable_by(f64::total_cmp);
        times
            .get(((times.len() as f64 * part) as usize).min(times.len().saturating_sub(1)))
            .copied()
            .unwrap_or_default()
            * 1e3
    };
    println!(
        "{count} robots, {messages} messages in {seconds} s of fleet time, {all:.1} s of the machine: {done} missions"
    );
    println!(
        "a position to what follows: p50 {:.3} ms, p99 {:.3} ms, p99.9 {:.3} ms, longest {:.1} ms",
        within(&mut times, 0.5),
        within(&mut times, 0.99),
        within(&mut times, 0.999),
        within(&mut times, 1.0)
    );
    println!("a mission: p50 {:.2} ms, p99 {:.2} ms", within(&mut decisions, 0.5), within(&mut decisions, 0.99));
    println!("memory: {first} kB after 5 s, {} kB at the end; {:?}", memory(), supervisor.counts());
    std::fs::remove_dir_all(folder)?;
    Ok(())
}

/// Of this process \[kB\], where the system tells; 0 elsewhere.
fn memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmRSS"));
    line.and_then(|line| line.split_whitespace().nth(1)).and_then(|word| word.parse().ok()).unwrap_or_default()
}
