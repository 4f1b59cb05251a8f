//! Missions of one's own, for reading.

use super::site_changes::site_changes;
use crate::missions::{MissionsReport, WaitEntry};
use pcr_planning::report::text_table::TextTable;
use pcr_planning::report::{counted, heading, printable};
use std::io::{self, Write};

/// The header line of [`missions_csv`].
pub const MISSIONS_CSV_HEADER: &str = "mission,vehicle,start,finish,lateness,reason\n";

/// One line for each mission.
///
/// # Errors
/// Errors of the writer.
pub fn missions_csv(report: &MissionsReport, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(MISSIONS_CSV_HEADER.as_bytes())?;
    let text = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let number = |number: Option<f64>| number.map_or_else(String::new, |number| number.to_string());
    for mission in &report.missions {
        writeln!(
            out,
            "{},{},{},{},{},{}",
            text(&mission.id),
            mission.vehicle.as_deref().map_or_else(String::new, text),
            number(mission.start),
            number(mission.finish),
            number(mission.lateness),
            mission.reason.as_deref().map_or_else(String::new, text)
        )?;
    }
    Ok(())
}

/// The timetable, who waits for whom, and what was not done.
///
/// # Errors
/// Errors of the writer.
pub fn missions_table(report: &MissionsReport, out: &mut dyn Write) -> io::Result<()> {
    let name = if report.layout.is_empty() { "layout" } else { &report.layout };
    let MissionsReport { done, late, missions, vehicles, certificate, .. } = report;
    writeln!(out, "{}: {}, {}", heading(name), counted(vehicles.len(), "vehicle"), counted(missions.len(), "mission"))?;
    let mut table = TextTable::new(&["<mission", "<vehicle", "start [s]", "finish [s]", "late [s]", "<to"]);
    let time = |time: Option<f64>| time.map_or_else(|| "-".to_owned(), |time| format!("{time:.1}"));
    for mission in missions {
        table.row(vec![
            printable(&mission.id).to_string(),
            mission.vehicle.as_deref().map_or_else(|| "-".to_owned(), |id| printable(id).to_string()),
            time(mission.start),
            time(mission.finish),
            time(mission.lateness),
            mission.stops.last().map_or_else(String::new, |stop| printable(&stop.node).to_string()),
        ]);
    }
    table.write(out)?;
    writeln!(out, "{done} of {} done, {late} late; the last at {:.1} s", missions.len(), report.makespan)?;
    for mission in missions {
        if let Some(why) = &mission.reason {
            writeln!(out, "mission {} is not done: {}", printable(&mission.id), printable(why))?;
        }
    }
    site_changes(&report.closures, &report.breakdowns, out)?;
    waits(&report.waits, out)?;
    match certificate.verdict {
        "proved" => writeln!(out, "no contact, proved for {}", counted(certificate.pairs, "pair")),
        verdict => writeln!(out, "contact of vehicles: {verdict}"),
    }
}

/// The longest waits.
fn waits(waits: &[WaitEntry], out: &mut dyn Write) -> io::Result<()> {
    /// More are counted only.
    const MOST: usize = 10;
    let mut longest: Vec<&WaitEntry> = waits.iter().collect();
    longest.sort_by(|a, b| (b.until - b.from).total_cmp(&(a.until - a.from)));
    for wait in longest.iter().take(MOST) {
        let place = wait.edge.as_ref().map_or_else(
            || format!("at ({:.2}, {:.2})", wait.x, wait.y),
            |edge| format!("on edge {} at ({:.2}, {:.2})", printable(edge), wait.x, wait.y),
        );
        writeln!(
            out,
            "{} waits {place} from {:.1} to {:.1} s for {}",
            printable(&wait.vehicle),
            wait.from,
            wait.until,
            printable(&wait.first)
        )?;
    }
    if longest.len() > MOST {
        writeln!(out, "and {} shorter waits", longest.len() - MOST)?;
    }
    Ok(())
}
