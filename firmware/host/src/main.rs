//! The host's side of the firmware.
//!
//! ```text
//! pcr-link table FORMAT              the table that the demo prints, computed here
//! pcr-link rectangles FORMAT         the same of rectangles, as the program `rectangles` prints it
//! pcr-link certify                   proves the table that it prints, from the standard input
//! pcr-link serial FORMAT COMMAND...  talks to the supervisor over the standard streams of COMMAND and checks its answers
//! pcr-link robot FORMAT COMMAND...   is the supervisor of the robot behind COMMAND, and the 29 others; f32 or q16
//! pcr-link passing FORMAT RUNS [COMMAND...]  random fleets under way on a bad line: no two discs touch; f32 or q16; RUNS is a
//!                                    number, or FROM..TO
//! ```
//!
//! Numbers are compared bit by bit: the closed forms are the same code on the same operations everywhere.

mod passing;
mod robot;
mod serial;

use pcr_certify::table::{Checker, CoverageMargin};
use pcr_core::{Ecm, EcmEntry, FleetMotions, FleetStorage, Motion, Outline, Piece};
use pcr_supervisor::scenario::{self, AGENTS, PIECES, REGIONS, SEGMENTS};
use pcr_supervisor::{Agent, Number, Step, dump};
use std::error::Error;
use std::io::{self, Write};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["robot", "f32", ref command @ ..] => robot::check::<f32>(command),
        ["robot", "micro", ref command @ ..] => robot::check::<pcr_core::scalar::Micro>(command),
        ["robot", "q16", ref command @ ..] => robot::check::<pcr_fixed::Q16>(command),
        ["certify"] => certify(&io::read_to_string(io::stdin())?),
        ["passing", "f32", runs, ref command @ ..] => pass::<f32>(runs, command),
        ["passing", "q16", runs, ref command @ ..] => pass::<pcr_fixed::Q16>(runs, command),
        [what, "f32", ref rest @ ..] => run(what, &scenario::float::AGENTS, rest),
        [what, "micro", ref rest @ ..] => run(what, &scenario::micro::AGENTS, rest),
        [what, "q12", ref rest @ ..] => run(what, &scenario::q12::AGENTS, rest),
        [what, "q16", ref rest @ ..] => run(what, &scenario::q16::AGENTS, rest),
        [what, "q20", ref rest @ ..] => run(what, &scenario::q20::AGENTS, rest),
        _ => Err(USAGE.into()),
    }
}

const USAGE: &str = "usage: pcr-link table FORMAT | pcr-link rectangles FORMAT | pcr-link certify | pcr-link serial FORMAT COMMAND... | pcr-link passing FORMAT RUNS [COMMAND...] \
     | pcr-link robot FORMAT COMMAND...; \
     formats: f32, micro, q12, q16, q20";

/// Random fleets under way, with a supervisor here or behind a command.
fn pass<S: passing::Rounded>(runs: &str, command: &[&str]) -> Result<(), Box<dyn Error>> {
    let seeds = match runs.split_once("..") {
        Some((from, to)) => from.parse()?..to.parse()?,
        None => 0..runs.parse()?,
    };
    let tally = if command.is_empty() {
        passing::runs::<S>(seeds.clone(), false, || Ok(Box::new(passing::here::<S>())))?
    } else {
        passing::runs::<S>(seeds.clone(), false, || Ok(Box::new(serial::Remote::<S>::start(command)?)))?
    };
    println!("{tally}");
    // Whoever looks at no hold meets somebody: the check can fail.
    let reckless = (0..100)
        .map(|seed| passing::runs::<S>(seed..seed + 1, true, || Ok(Box::new(passing::here::<S>()))))
        .filter(|run| run.as_ref().is_err_and(|error| error.to_string().contains("overlap")));
    let reckless = reckless.count();
    println!("of 100 runs without holds, {reckless} end in a contact");
    if reckless > 20 && tally.orders > 0 { Ok(()) } else { Err("the runs prove nothing".into()) }
}

fn run<S: Number>(what: &str, agents: BuiltIn<S>, rest: &[&str]) -> Result<(), Box<dyn Error>> {
    match (what, rest) {
        ("table", []) => table(agents),
        ("rectangles", []) => rectangles(agents),
        ("serial", command) => serial::check(agents, command),
        _ => Err(USAGE.into()),
    }
}

/// The built-in agents of a format.
type BuiltIn<S> = &'static [Agent<S, &'static [Step<S>]>];

type Store<S> = FleetStorage<'static, S, AGENTS, SEGMENTS>;

/// The fleet of a format, stored.
fn store<S: Number>(agents: BuiltIn<S>) -> Result<Store<S>, Box<dyn Error>> {
    let mut store = Store::new();
    for agent in agents {
        agent.add_to(&mut store)?;
    }
    Ok(store)
}

fn motions<S: Number>(store: &Store<S>) -> FleetMotions<'_, S, AGENTS> {
    let mut fleet = FleetMotions::new();
    fleet.fill(store);
    fleet
}

/// Prints what the program `rectangles` prints, but for its figures.
fn rectangles<S: Number>(agents: BuiltIn<S>) -> Result<(), Box<dyn Error>> {
    let store = store(agents)?;
    let discs = motions(&store);
    let outline = |disc: &Motion<'_, S>| {
        let (length, width) = (disc.radius(), disc.radius().half());
        Outline::<S, 4>::rectangle(length, length, width, width, S::ZERO)
    };
    let outlines = discs.iter().map(outline).collect::<Result<Vec<_>, _>>()?;
    let fleet = discs
        .iter()
        .zip(&outlines)
        .map(|(disc, outline)| Motion::with_outline(disc.path(), disc.profile(), outline, disc.time().lo));
    let fleet = fleet.collect::<Result<Vec<_>, _>>()?;
    let ecm = Ecm::build([EcmEntry::EMPTY; REGIONS], [Piece::EMPTY; 2 * PIECES], &fleet)?;
    let mut out = io::stdout().lock();
    for region in ecm.regions(&fleet)? {
        out.write_all(dump::region(&region).as_bytes())?;
    }
    writeln!(out, "{} regions, {} pieces", ecm.len(), ecm.pieces())?;
    Ok(())
}

/// Prints what the demo prints.
fn table<S: Number>(agents: BuiltIn<S>) -> Result<(), Box<dyn Error>> {
    let store = store(agents)?;
    let fleet = motions(&store);
    let ecm = Ecm::build([EcmEntry::EMPTY; REGIONS], [Piece::EMPTY; PIECES], &fleet)?;
    let mut out = io::stdout().lock();
    out.write_all(dump::HEADING)?;
    for region in ecm.regions(&fleet)? {
        out.write_all(dump::region(&region).as_bytes())?;
    }
    writeln!(out, "{} regions, {} pieces", ecm.len(), ecm.pieces())?;
    let mut written = Ok(());
    dump::table(&fleet, &ecm, |line| {
        if written.is_ok() {
            written = out.write_all(line);
        }
    })?;
    Ok(written?)
}

/// Proves that no contact is missing from the table in a text, as `pcr certify --table` does.
fn certify(text: &str) -> Result<(), Box<dyn Error>> {
    let table = pcr_certify::device_dump::decode(text)?;
    let found = Checker::new(&table)?.check(CoverageMargin::Needed)?;
    match found.refuted.first().or(found.undecided.first()) {
        Some(witness) => Err(format!("not proved: {witness:?}").into()),
        None if found.pieces == 0 => Err("there is nothing in the table".into()),
        None => {
            println!("proved: {} agents, {} pieces, {} regions in time", table.agents.len(), found.pieces, found.times);
            Ok(())
        }
    }
}
