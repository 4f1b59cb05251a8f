//! Fleets that run on a layout: `cargo run --release -p pcr-tests --example lifelong -- LAYOUT RADIUS HOURS SEED METHODS ROBOTS...`
//! prints what comes of it, and how long decisions took. Methods are letters: o(rders), r(oute locks), e(dge locks), d(elays).

use pcr_host::import::{self, Format, Options, Warnings};
use pcr_host::lifelong::{Delays, Method, Request, run};
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [layout, radius, hours, seed, methods, robots @ ..] = arguments.as_slice() else {
        eprintln!("lifelong LAYOUT RADIUS HOURS SEED METHODS ROBOTS...");
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
        for method in Method::ALL.into_iter().filter(|method| methods.contains(&method.name()[..1].replace('s', "d"))) {
            let request = Request {
                agents: agents.parse().unwrap_or(0),
                duration: 3600.0 * number(hours),
                delays: Delays::default(),
                seed: seed.parse().unwrap_or(0),
                method,
            };
            let report = run(&imported, request).expect("a run");
            println!("{agents} {}: {:?}", method.name(), report.outcome);
            println!(
                "  {} decisions: median {:.2} ms, 99 % {:.2} ms; {:.1?} in all",
                report.decisions.len(),
                1e3 * report.decided_within(0.5),
                1e3 * report.decided_within(0.99),
                report.time
            );
        }
    }
    ExitCode::SUCCESS
}
