//! Fleets that run for an hour in a real warehouse, under orders, locks and start delays, with the same missions and
//! the same random delays.

use super::{DocumentSection, EvaluationError, PaperFleets, Thoroughness};
use pcr_execution::ExecutionError;
use pcr_execution::lifelong::{
    CoordinationMethod, DelayModel, LifelongOptions, LifelongReport, LifelongRunEntry, streets,
};
use pcr_formats::import::ImportedLayout;
use pcr_planning::figures::digits;
use std::fmt::Write as _;

/// Radius of the discs \[m\].
const RADIUS: f64 = 0.4;

pub(super) fn section(fleets: &PaperFleets, extent: Thoroughness) -> Result<DocumentSection, EvaluationError> {
    let (sizes, hours): (&[usize], f64) = match extent {
        Thoroughness::Full => (&[5, 10, 20, 30, 50], 1.0),
        Thoroughness::Quick => (&[3], 0.02),
    };
    let imported = fleets.warehouse(RADIUS)?;
    let usual = DelayModel::default();
    let mut text = format!(
        "## Fleets that run\n\nThe same route graph, discs of {RADIUS} m, turns in place at corners; a robot that has finished a mission gets a new \
        random one, for {hours} h (`pcr traffic --hours {hours} --active N --compare`, seed 1). Robots are stopped for {} % of the time, {} s each, and are up \
        to {} % slower than commanded. Missions are drawn once and never exchanged; all methods have the same missions and the same delays. Only \
        with orders, a robot looks for the way to its next goal up to 25 s before it reaches a goal, 10 s with more robots than safe \
        ends or more than 64 robots. Locks on edges are granted one by one, if all could still finish \
        afterwards (the banker's algorithm). *An hour*: missions per hour, without the first tenth of the time; *travel*: mean \
        time of a mission divided by that of a robot alone; *starved*: missions that have waited for more than ten minutes at the end; *decision*: \
        time to decide on a way and orders, 99th percentile; *contact*: verdict of the independent checker on the recorded motions.\n\n\
        | robots | method | missions | an hour | travel | starved | stuck | decision | contact |\n|---:|---|---:|---:|---:|---:|---:|---:|---|\n",
        100.0 * usual.stopped,
        usual.stop,
        100.0 * usual.slip
    );
    let (mut safe, mut alone) = (0, Vec::new());
    for &agents in sizes {
        let answer = driven(&imported, agents, hours, &CoordinationMethod::ALL)?;
        safe = answer.well_formedness.safe_ends.len();
        alone.push(format!("{} with {agents}", digits(answer.alone)));
        answer.runs.iter().for_each(|run| text.push_str(&row(agents, run)));
    }
    let _ = writeln!(
        text,
        "\nThe graph has {safe} safe ends. With as many robots or more, some robot may always be in the way of another one, and missions may wait \
        for ever. If no robot was in another one's way, robots with these missions and delays would do this many missions an hour: {}.",
        alone.join(", ")
    );
    text.push_str(&large(extent)?);
    Ok(DocumentSection { text, pictures: Vec::new() })
}

/// Fleets of which each decision looks at some robots only.
fn large(extent: Thoroughness) -> Result<String, EvaluationError> {
    let (sizes, hours): (&[[usize; 2]], f64) = match extent {
        Thoroughness::Full => (&[[100, 14], [300, 22], [1000, 40]], 0.1),
        Thoroughness::Quick => (&[[70, 10]], 0.005),
    };
    let mut text = format!(
        "\nLarge fleets, with orders: streets that cross every 6 m, one-way with alternating directions and two bays for each block; the same robots \
        and delays, {hours} h (`cargo run --release -p pcr-execution --example streets -- ROBOTS {hours} STREETS`). *Faster*: how many times faster \
        than real time, on one core, with all decisions and the simulation of the robots, without the certificate.\n\n\
        | nodes | robots | missions | an hour | travel | stuck | decision | faster | contact |\n|---:|---:|---:|---:|---:|---:|---:|---:|---|\n"
    );
    for &[agents, count] in sizes {
        let answer = driven(&streets(count), agents, hours, &[CoordinationMethod::Orders])?;
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

fn driven(
    imported: &ImportedLayout,
    agents: usize,
    hours: f64,
    methods: &[CoordinationMethod],
) -> Result<LifelongReport, EvaluationError> {
    let (duration, delays) = (3600.0 * hours, DelayModel::default());
    let request = LifelongOptions { agents, duration, delays, seed: 1, method: CoordinationMethod::Orders };
    let refused = |problem: ExecutionError| EvaluationError::Method(format!("{agents} robots"), problem.to_string());
    LifelongReport::run(imported, request, methods).map_err(refused)
}

fn row(agents: usize, run: &LifelongRunEntry) -> String {
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
