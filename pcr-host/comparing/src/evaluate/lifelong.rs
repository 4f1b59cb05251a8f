//! Fleets that run for an hour on a real warehouse, under orders, locks and start delays: same missions, same delays.

use super::{Extent, Fleets, Problem, Section};
use pcr_formats::import::Imported;
use pcr_planning::lifelong::{Delays, Driven, Lifelong, Method, Request, streets};
use pcr_planning::report::figures::digits;
use std::fmt::Write as _;

/// Radius of the discs \[m\].
const RADIUS: f64 = 0.4;

pub(super) fn section(fleets: &Fleets, extent: Extent) -> Result<Section, Problem> {
    let (sizes, hours): (&[usize], f64) = match extent {
        Extent::Full => (&[5, 10, 20, 30, 50], 1.0),
        Extent::Quick => (&[3], 0.02),
    };
    let imported = fleets.warehouse(RADIUS)?;
    let usual = Delays::default();
    let mut text = format!(
        "## Fleets that run\n\nThe same route graph, discs of {RADIUS} m, turns in place at corners; every robot gets a random mission whenever one is done, for {hours} h \
        (`pcr traffic --hours {hours} --compare`, seed 1). Robots are stopped for {} % of the time, {} s each, and are up to {} % slower than asked. Missions are \
        drawn once and never exchanged; all methods have the same ones and the same delays; orders look for the way to the next goal up to 10 s \
        before a goal is reached. Locks on edges are given one by one, if all could still finish then (the banker's check). *An hour*: missions after the first tenth of the time; *travel*: mean time \
        of a mission over that of a robot alone; *starved*: missions that have waited for more than ten minutes in the end; *decision*: a way and orders, 99 of 100 within; \
        *contact*: what the independent checker says of the recorded motions.\n\n\
        | robots | method | missions | an hour | travel | starved | stuck | decision | contact |\n|---:|---|---:|---:|---:|---:|---:|---:|---|\n",
        100.0 * usual.stopped,
        usual.stop,
        100.0 * usual.slip
    );
    let (mut safe, mut alone) = (0, Vec::new());
    for &agents in sizes {
        let answer = driven(&imported, agents, hours, &Method::ALL)?;
        safe = answer.well_formedness.safe_ends.len();
        alone.push(format!("{} with {agents}", digits(answer.alone)));
        answer.runs.iter().for_each(|run| text.push_str(&row(agents, run)));
    }
    let _ = writeln!(
        text,
        "\nThe graph has {safe} safe ends: with more robots somebody always stands in the way of somebody else, and missions may wait for ever. \
        If nobody was in anybody's way, robots with these missions and delays would do so many an hour: {}.",
        alone.join(", ")
    );
    text.push_str(&large(extent)?);
    Ok(Section { text, pictures: Vec::new() })
}

/// Fleets of which each decision looks at some robots only.
fn large(extent: Extent) -> Result<String, Problem> {
    let (sizes, hours): (&[[usize; 2]], f64) = match extent {
        Extent::Full => (&[[100, 14], [300, 22], [1000, 40]], 0.1),
        Extent::Quick => (&[[70, 10]], 0.005),
    };
    let mut text = format!(
        "\nLarge fleets, by orders: streets that cross every 6 m, one-way to and fro by turns, with two bays a block, the same robots and delays, {hours} h \
        (`cargo run --release -p pcr-planning --example streets -- ROBOTS {hours} STREETS`). *Faster*: than real time, on one core, with all decisions and the simulation \
        of the robots, without the certificate.\n\n\
        | nodes | robots | missions | an hour | travel | stuck | decision | faster | contact |\n|---:|---:|---:|---:|---:|---:|---:|---:|---|\n"
    );
    for &[agents, count] in sizes {
        let answer = driven(&streets(count), agents, hours, &[Method::Orders])?;
        for run in &answer.runs {
            let it = &run.outcome;
            let contact = if it.certificate.verdict == "proved" { "none, proved" } else { it.certificate.verdict };
            let _ = writeln!(
                text,
                "| {} | {} | {} | {} | {} | {} | {} ms | {} × | {contact} |",
                answer.well_formedness.nodes,
                it.robots,
                it.missions,
                digits(it.missions_per_hour),
                it.travel_over_unimpeded.map_or_else(|| "–".to_owned(), digits),
                it.stuck,
                digits(1e3 * run.decision_p99),
                digits(3600.0 * hours / run.computed_in)
            );
        }
    }
    Ok(text)
}

fn driven(imported: &Imported, agents: usize, hours: f64, methods: &[Method]) -> Result<Lifelong, Problem> {
    let (duration, delays) = (3600.0 * hours, Delays::default());
    let request = Request { agents, duration, delays, seed: 1, method: Method::Orders };
    let refused = |problem| Problem::Method(format!("{agents} robots"), problem);
    Lifelong::of(imported, request, methods).map_err(refused)
}

fn row(agents: usize, run: &Driven) -> String {
    let it = &run.outcome;
    let count = if it.robots < agents { format!("{} of {agents}", it.robots) } else { agents.to_string() };
    let contact = if it.certificate.verdict == "proved" { "none, proved" } else { it.certificate.verdict };
    format!(
        "| {count} | {} | {} | {} | {} | {} | {} | {} ms | {contact} |\n",
        it.method.name(),
        it.missions,
        digits(it.missions_per_hour),
        it.travel_over_unimpeded.map_or_else(|| "–".to_owned(), digits),
        it.starved,
        it.stuck,
        digits(1e3 * run.decision_p99)
    )
}
