//! Fleets that run on a layout: `cargo run --release -p pcr-tests --example lifelong -- LAYOUT RADIUS HOURS STOPPED SEED ROBOTS...`
//! prints missions an hour, contacts and waits, and how long decisions took.

use pcr_formats::import::{self, Format, Options, Warnings};
use pcr_planning::lifelong::{Request, run};
use std::process::ExitCode;
use std::time::{Duration, Instant};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [layout, radius, hours, stopped, seed, robots @ ..] = arguments.as_slice() else {
        eprintln!("lifelong LAYOUT RADIUS HOURS STOPPED SEED ROBOTS...");
        return ExitCode::from(2);
    };
    let number = |text: &str| text.parse::<f64>().unwrap_or(f64::NAN);
    let Ok(text) = std::fs::read_to_string(layout) else { return ExitCode::from(2) };
    let options = Options {
        radius: Some(number(radius)),
        speed: Some(1.0),
        acceleration: Some(0.5),
        rotation: Some(1.0),
        rotation_acceleration: Some(1.0),
        ..Options::default()
    };
    let imported = import::layout(Format::Nav2, &text, &options, &mut Warnings::default()).expect("a layout");
    for agents in robots {
        let request = Request {
            agents: agents.parse().unwrap_or(0),
            duration: 3600.0 * number(hours),
            stopped: number(stopped),
            seed: seed.parse().unwrap_or(0),
        };
        let begin = Instant::now();
        let (outcome, mut decisions) = run(&imported, request).expect("a run");
        decisions.sort();
        let part = |per_cent: usize| decisions.get(decisions.len() * per_cent / 100).copied().unwrap_or(Duration::ZERO);
        println!("{outcome:?}");
        println!(
            "  {} decisions: median {:.1?}, 99 % {:.1?}; {:.1?} in all",
            decisions.len(),
            part(50),
            part(99),
            begin.elapsed()
        );
    }
    ExitCode::SUCCESS
}
