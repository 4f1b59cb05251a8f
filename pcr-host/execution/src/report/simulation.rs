//! Simulated runs as text.

use crate::simulate::{ClearanceEntry, ControllerRunEntry, RunEnd, SimulationReport};
use pcr_formats::scenario::Labels;
use pcr_planning::figures::small;
use pcr_planning::report::text_table::TextTable;
use pcr_planning::report::{counted, display_name, heading, quoted};
use std::io::{self, Write};

/// A line a mission: numbers that read back exactly; no end where it was not done.
///
/// # Errors
/// Errors of the writer.
pub fn simulation_csv(simulation: &SimulationReport, out: &mut dyn Write) -> io::Result<()> {
    let name = quoted(&simulation.name);
    writeln!(out, "name,controller,id,begin,end,unimpeded,waiting,label")?;
    for run in &simulation.runs {
        for mission in &run.missions {
            let end = mission.end.map(|end| end.to_string()).unwrap_or_default();
            let (controller, unimpeded, waiting) = (run.controller.name(), mission.unimpeded, mission.waiting);
            let label = quoted(simulation.labels.get(mission.id));
            writeln!(out, "{name},{controller},{},{},{end},{unimpeded},{waiting},{label}", mission.id, mission.begin)?;
        }
    }
    Ok(())
}

/// The runs for reading: a line a controller.
///
/// # Errors
/// Errors of the writer.
pub fn simulation_table(simulation: &SimulationReport, out: &mut dyn Write) -> io::Result<()> {
    let SimulationReport { seed, noise, drift, slip, delay, replan, .. } = simulation;
    let name = heading(&simulation.name);
    writeln!(
        out,
        "{name}: seed {seed}, positions seen within {noise} m, paths kept within {drift} m, slip up to {slip},"
    )?;
    writeln!(
        out,
        "held up for up to {delay} s about every 10 s, a plan every {replan} s; times are means of a mission"
    )?;
    let mut columns = TextTable::new(&[
        "<controller",
        "missions",
        "not done",
        "travel [s]",
        "unimpeded [s]",
        "waiting [s]",
        "all done [s]",
        "collisions",
        "deepest [m]",
        "clearance [m]",
    ]);
    for run in &simulation.runs {
        let deepest = run.collisions.iter().map(|collision| collision.depth).reduce(f64::max);
        let metres = |length: Option<f64>| length.map(small).unwrap_or_default();
        columns.row(vec![
            run.controller.name().to_owned(),
            run.done.to_string(),
            run.not_done.to_string(),
            format!("{:.1}", run.travel),
            format!("{:.1}", run.unimpeded),
            format!("{:.1}", run.waiting),
            format!("{:.1}", run.duration),
            run.collisions.len().to_string(),
            metres(deepest),
            metres(run.clearance),
        ]);
    }
    columns.write(out)?;
    for run in &simulation.runs {
        let (name, duration) = (run.controller.name(), run.duration);
        match run.ended {
            RunEnd::Done => {}
            RunEnd::Standstill => writeln!(out, "{name}: after {duration:.0} s no robot would ever have moved again")?,
            RunEnd::TimeLimit => {
                writeln!(out, "{name}: given up after {duration:.0} s, with missions that were not done")?
            }
        }
        planning(run, &simulation.labels, out)?;
    }
    Ok(())
}

/// What room is missing, and what would do; lengths are rounded so that they do, to tenths of a millimetre.
fn missing(ClearanceEntry { free, needed, drift }: ClearanceEntry) -> String {
    let up = |length: f64| (1e4 * length).ceil() * 1e-4;
    let down = |length: f64| (1e4 * length).floor() * 1e-4;
    let less = drift.map_or_else(String::new, |drift| format!(", or --drift {:.4},", down(drift)));
    format!(
        "{:.4} m are free and {:.4} m needed, as robots may be off their paths; {:.4} m more{less} would do",
        down(free),
        up(needed),
        up(needed - free)
    )
}

fn planning(run: &ControllerRunEntry, labels: &Labels, out: &mut dyn Write) -> io::Result<()> {
    let Some(planning) = run.planning else { return Ok(()) };
    let (count, kept) = (planning.count, planning.kept);
    let (mean, longest) = (planning.mean_ms, planning.longest_ms);
    let name = run.controller.name();
    if count > 0 && kept == count {
        let tries = if count == 1 { "1 try".to_owned() } else { format!("{count} tries") };
        writeln!(out, "{name}: no plan was found in {tries}, and nobody moved")?;
    }
    for waiting in &run.waiting_for {
        let by = waiting.blocked_by.map(|by| display_name(labels, by));
        let why = match (waiting.begun, by) {
            (false, Some(by)) => match waiting.clearance {
                Some(room) => format!("never set off, as {by} stands too near its way: {}", missing(room)),
                None => format!("never set off, as {by} stands in its way"),
            },
            (false, None) => "never set off, as no order of passing lets it through with its margin".to_owned(),
            (true, Some(by)) => format!("stands on its way, as {by} passes first"),
            (true, None) => "stands on its way, though no passing order holds it".to_owned(),
        };
        writeln!(out, "{name}: {} {why}", display_name(labels, waiting.id))?;
    }
    if kept == count {
        return Ok(());
    }
    writeln!(
        out,
        "{name}: planned {} (the old orders were kept {}), {mean:.2} ms each, at most {longest:.2} ms",
        counted(count, "time"),
        counted(kept, "time")
    )
}
