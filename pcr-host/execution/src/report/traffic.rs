//! Traffic for reading.

use crate::traffic::{SkippedMissions, TrafficReport};
use pcr_formats::scenario::Labels;
use pcr_planning::figures::{above, exact, thousandths};
use pcr_planning::report::text_table::TextTable;
use pcr_planning::report::{all_called, counted, heading, printable, proof_line, quoted};
use std::io::{self, Write};

/// The header line of [`traffic_csv`].
pub const TRAFFIC_CSV_HEADER: &str = "id,from,to,length,delay,t_end\n";

/// A line a mission: numbers that read back exactly; no delay and no end without a plan.
///
/// # Errors
/// Errors of the writer.
pub fn traffic_csv(traffic: &TrafficReport, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(TRAFFIC_CSV_HEADER.as_bytes())?;
    for mission in &traffic.missions {
        let [from, to] = [&mission.from, &mission.to].map(|id| quoted(&id.to_string()).into_owned());
        let [delay, end] = [mission.delay, mission.t_end].map(|time| time.map_or_else(String::new, |t| t.to_string()));
        writeln!(out, "{},{from},{to},{},{delay},{end}", mission.id, mission.length)?;
    }
    Ok(())
}

/// The missions in columns, and what comes of them.
///
/// # Errors
/// Errors of the writer.
pub fn traffic_table(traffic: &TrafficReport, out: &mut dyn Write) -> io::Result<()> {
    let TrafficReport { layout, seed, asked, placed, planned, passed_over, .. } = traffic;
    let name = if layout.is_empty() { "layout" } else { layout };
    let (name, asked_for) = (heading(name), counted(*asked, "agent"));
    writeln!(out, "{name}: {asked_for} asked for, {placed} placed, {planned} planned, seed {seed}")?;
    if *passed_over == 0 {
        writeln!(out, "no mission rejected")?;
    }
    for SkippedMissions { why, missions } in &traffic.passed_over_because {
        writeln!(out, "{} rejected and drawn again: {}", counted(*missions, "mission"), printable(why))?;
    }
    if placed < asked {
        let without = asked - placed;
        writeln!(
            out,
            "{without} without a mission: whatever nodes are left, somebody always stands in the way of another"
        )?;
    }
    let mut columns = TextTable::new(&["agent", "<from", "<to", "length [m]", "delay [s]", "t_end [s]"]);
    let time = |time: Option<f64>, digits: fn(f64) -> String| time.map_or_else(|| "-".to_owned(), digits);
    for mission in &traffic.missions {
        let [from, to] = [&mission.from, &mission.to].map(|id| printable(&id.to_string()));
        let length = thousandths(mission.length);
        columns.row(vec![
            mission.id.to_string(),
            from,
            to,
            length,
            time(mission.delay, exact),
            time(mission.t_end, above),
        ]);
    }
    columns.write(out)?;
    for unsolved in &traffic.unsolved {
        if unsolved.ids.is_empty() {
            writeln!(out, "{}", unsolved.why)?;
            continue;
        }
        let agents = all_called(&Labels::default(), &unsolved.ids);
        writeln!(out, "agents {agents}: {}; the first is left out", unsolved.why)?;
    }
    let TrafficReport { regions, conflicts_before, conflicts_after, .. } = traffic;
    writeln!(
        out,
        "{}; {} if all set off at once, {conflicts_after} as planned",
        counted(*regions, "region"),
        counted(*conflicts_before, "conflict")
    )?;
    let TrafficReport { makespan, sum_of_costs, lower_bound, missions_per_hour, .. } = traffic;
    let costs = format!("sum of costs {sum_of_costs:.3} s (without any wait {lower_bound:.3} s)");
    writeln!(out, "makespan {makespan:.3} s, {costs}, {missions_per_hour:.1} missions an hour")?;
    writeln!(out, "{}", proof_line(&traffic.certificate, &Labels::default()))
}
