//! Fleets that run for hours, for reading.

use super::site_changes::site_changes;
use crate::lifelong::{LifelongReport, LifelongRunEntry, TimeShares, WellFormedness};
use pcr_formats::import::ElementId;
use pcr_planning::report::text_table::TextTable;
use pcr_planning::report::{counted, heading, printable};
use std::io::{self, Write};

/// The header line of [`lifelong_csv`].
pub const LIFELONG_CSV_HEADER: &str = "method,robots,missions,missions_per_hour,travel_over_unimpeded,certificate,breaches,\
stuck,standstill,refused,moved,revised,overtaken,longest_wait,waiting,starved,driving,turning,stopped,held,aside,idle,decisions,decision_median,decision_p99,idle_because\n";

/// One line for each method; if no goal was reached, a reason takes the place of the ratio.
///
/// # Errors
/// Errors of the writer.
pub fn lifelong_csv(lifelong: &LifelongReport, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(LIFELONG_CSV_HEADER.as_bytes())?;
    for run in &lifelong.runs {
        let LifelongRunEntry { outcome: it, decisions, decision_median, decision_p99, .. } = run;
        let ratio = it.travel_over_unimpeded.map_or_else(String::new, |ratio| ratio.to_string());
        let because = it.idle_because.as_ref().map_or_else(String::new, |why| format!("\"{why}\""));
        writeln!(
            out,
            "{},{},{},{},{ratio},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{decisions},{decision_median},{decision_p99},{because}",
            it.method.key(),
            it.robots,
            it.missions,
            it.missions_per_hour,
            it.certificate.verdict,
            it.authority_overruns,
            it.stuck,
            it.standstill,
            it.refused,
            it.moved,
            it.revised,
            it.overtaken,
            it.longest_wait,
            it.waiting,
            it.starved,
            it.time.driving,
            it.time.turning,
            it.time.stopped,
            it.time.waiting,
            it.time.yielding,
            it.time.idle
        )?;
    }
    Ok(())
}

/// Properties of the layout, and one line for each method.
///
/// # Errors
/// Errors of the writer.
pub fn lifelong_table(lifelong: &LifelongReport, out: &mut dyn Write) -> io::Result<()> {
    let LifelongReport { layout, seed, asked, active, hours, delays, well_formedness, alone, runs, .. } = lifelong;
    let name = if layout.is_empty() { "layout" } else { layout };
    writeln!(out, "{}: {} for {hours} h, seed {seed}", heading(name), counted(*asked, "robot"))?;
    writeln!(
        out,
        "stopped for {} % of the time, {} s each; up to {} % slower",
        100.0 * delays.stopped,
        delays.stop,
        100.0 * delays.slip
    )?;
    well_formed(well_formedness, out)?;
    active_robots(lifelong, out)?;
    let safe = well_formedness.safe_ends.len();
    if *active >= safe {
        let why = match well_formedness.dead_ends_only {
            true => "whether missions may wait for ever is not known: only dead ends were looked at",
            false => "no safe end is left free: somebody may always stand in the way, and missions wait for ever",
        };
        writeln!(out, "{why}")?;
    }
    if let Some(run) = runs.iter().find(|run| run.outcome.robots < *active) {
        writeln!(out, "{} without a place to start", active - run.outcome.robots)?;
    }
    writeln!(out, "{alone:.0} missions an hour if nobody was in anybody's way")?;
    let mut columns = TextTable::new(&[
        "<method",
        "robots",
        "missions",
        "an hour",
        "travel/alone",
        "refused",
        "waiting [s]",
        "starved",
        "stuck",
        "decisions",
        "median [ms]",
        "99 % [ms]",
        "<contact",
    ]);
    for run in runs {
        let it = &run.outcome;
        columns.row(vec![
            it.method.name().to_owned(),
            it.robots.to_string(),
            it.missions.to_string(),
            format!("{:.0}", it.missions_per_hour),
            it.travel_over_unimpeded.map_or_else(|| "-".to_owned(), |ratio| format!("{ratio:.2}")),
            it.refused.to_string(),
            format!("{:.0}", it.waiting),
            it.starved.to_string(),
            it.stuck.to_string(),
            run.decisions.to_string(),
            format!("{:.2}", 1e3 * run.decision_median),
            format!("{:.2}", 1e3 * run.decision_p99),
            match it.certificate.verdict {
                "proved" => "none, proved".to_owned(),
                verdict => verdict.to_owned(),
            },
        ]);
    }
    columns.write(out)?;
    writeln!(
        out,
        "an hour: missions of the last nine tenths of the time; all robots set off at once in the first tenth"
    )?;
    for run in runs {
        if let Some(why) = &run.outcome.idle_because {
            let what = if run.outcome.missions == 0 { "nobody reached a goal, as " } else { "" };
            writeln!(out, "{}: {what}{why}", run.outcome.method.name())?;
        }
    }
    for run in runs {
        let TimeShares { driving, turning, stopped, waiting: held, yielding: aside, idle } = run.outcome.time;
        let [driving, turning, stopped, held, aside, idle] =
            [driving, turning, stopped, held, aside, idle].map(|part| format!("{:.0} %", 100.0 * part));
        writeln!(
            out,
            "time of the robots, {}: driving {driving}, turning {turning}, stopped {stopped}, waiting for others {held}, \
            without a free way: driving to an end {aside}, standing {idle}",
            run.outcome.method.name()
        )?;
    }
    site_changes(&lifelong.closures, &lifelong.breakdowns, out)
}

/// How many robots are active, and why not all of them.
fn active_robots(lifelong: &LifelongReport, out: &mut dyn Write) -> io::Result<()> {
    let LifelongReport { asked, active, trials, .. } = lifelong;
    let chosen = trials.iter().find(|trial| trial.robots == *active);
    let most = chosen.map_or(0.0, |trial| trial.missions_per_hour);
    let why = match trials.len() {
        0 if active < asked => "",
        0 | 1 => return Ok(()),
        _ if trials.iter().any(|trial| trial.robots > *active && trial.standstill) => {
            "; more would do less or come to a standstill"
        }
        _ if active < asked => "; more would do less",
        _ if trials.iter().any(|trial| trial.robots < *active && trial.missions_per_hour > most) => {
            "; fewer would do hardly more"
        }
        _ => "; fewer would do no more",
    };
    let away = if active < asked { ", the others are not on the layout" } else { "" };
    write!(out, "{active} of {asked} active{away}{why}")?;
    if !trials.is_empty() {
        let tried =
            trials.iter().map(|it| format!("{} robots {:.0} in {} h", it.robots, it.missions_per_hour, it.hours));
        write!(out, " (missions an hour: {})", tried.collect::<Vec<_>>().join(", "))?;
    }
    writeln!(out)
}

fn well_formed(it: &WellFormedness, out: &mut dyn Write) -> io::Result<()> {
    let list = |ids: &[ElementId]| {
        /// More are counted only.
        const MOST: usize = 20;
        let shown: Vec<String> = ids.iter().take(MOST).map(|id| printable(&id.to_string())).collect();
        let more = if ids.len() > MOST { format!(" and {} more", ids.len() - MOST) } else { String::new() };
        format!("{}{more}", shown.join(", "))
    };
    let kind = if it.dead_ends_only { " (only dead ends were looked at)" } else { "" };
    writeln!(
        out,
        "{} nodes, {} safe ends{kind}, where robots may stand for good: {}",
        it.nodes,
        it.safe_ends.len(),
        list(&it.safe_ends)
    )?;
    if !it.cut_off.is_empty() {
        writeln!(
            out,
            "{} nodes have no missions, as not all others can be reached: {}",
            it.cut_off.len(),
            list(&it.cut_off)
        )?;
    }
    if !it.never_ends.is_empty() {
        let count = it.never_ends.len();
        writeln!(out, "{count} nodes at which a single standing robot cuts others off: {}", list(&it.never_ends))?;
    }
    if !it.bridges.is_empty() {
        let count = it.bridges.len();
        writeln!(
            out,
            "{count} two-way edges with no way around: robots that meet there block each other, unless orders prevent it: {}",
            list(&it.bridges)
        )?;
    }
    Ok(())
}
