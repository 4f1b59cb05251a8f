//! Approaches of the agents of a record as text.

use super::text_table::TextTable;
use super::{agents, counted, display_name, heading};
use crate::approaches::{ApproachReport, BetweenEntry, ContactVerdict};
use crate::figures::{above, below, exact, outward, thousandths};
use std::io::{self, Write};

/// The approaches for reading, and how near the agents come if that was asked for.
///
/// # Errors
/// Errors of the writer.
pub fn approaches_table(report: &ApproachReport, out: &mut dyn Write) -> io::Result<()> {
    let name = heading(&report.name);
    let contacts = report.approaches.iter().filter(|approach| approach.verdict == ContactVerdict::Contact).count();
    let unknown = report.approaches.len() - contacts;
    let found = match (contacts, unknown) {
        (0, 0) => "contact excluded".to_owned(),
        (0, unknown) => format!("{} unknown", counted(unknown, "time")),
        (contacts, 0) => counted(contacts, "contact"),
        (contacts, unknown) => format!("{}, {} unknown", counted(contacts, "contact"), counted(unknown, "time")),
    };
    let agents_in = counted(report.agents.len(), "agent");
    let apart = if report.apart > 0 { format!(", {} never on record together", report.apart) } else { String::new() };
    writeln!(out, "{name}: {found}, {agents_in}, {}{apart}", counted(report.pairs, "pair"))?;
    let longest = report.agents.iter().map(|agent| agent.longest).fold(0.0, f64::max);
    let longest = thousandths(longest);
    match report.between {
        BetweenEntry::Deviation(0.0) => writeln!(out, "Between two poses: straight at constant speed")?,
        BetweenEntry::Deviation(deviation) => writeln!(
            out,
            "Between two poses, up to {longest} s: straight at constant speed, to within {} m",
            exact(deviation)
        )?,
        BetweenEntry::TopSpeed(speed) => {
            writeln!(out, "Between two poses, up to {longest} s: any way at up to {} m/s", exact(speed))?;
        }
        BetweenEntry::TopSpeedAndRotation([speed, rotation]) => {
            let [speed, rotation] = [speed, rotation].map(exact);
            writeln!(out, "Between two poses, up to {longest} s: any way at up to {speed} m/s and {rotation} rad/s")?;
        }
    }
    if let Some(origin) = &report.origin {
        writeln!(out, "Times count from {origin}")?;
    }
    let [i, j] = agents(&report.labels);
    if !report.approaches.is_empty() {
        let titles = [i, j, "t from [s]", "to [s]", "<verdict", "clearance from [m]", "to [m]", "<contact proved [s]"];
        let mut columns = TextTable::new(&titles);
        for approach in &report.approaches {
            let mut row = [approach.i, approach.j].map(|id| display_name(&report.labels, id)).to_vec();
            row.extend(outward(approach.t));
            row.push(match approach.verdict {
                ContactVerdict::Contact => "contact".into(),
                ContactVerdict::Unknown => "cannot be known".into(),
            });
            row.extend(outward(approach.clearance));
            // Inward: what is printed is proved.
            let proved = approach.contacts.iter().map(|[from, to]| format!("{}-{}", above(*from), below(*to)));
            row.push(proved.collect::<Vec<_>>().join(" "));
            columns.row(row);
        }
        columns.write(out)?;
    }
    if !report.waits.is_empty() {
        writeln!(out, "\nStood because the rest of the order was not released:")?;
        let titles = ["<agent", "t from [s]", "to [s]", "<meanwhile moved", "way [m]", "clearance from [m]", "to [m]"];
        let mut columns = TextTable::new(&titles);
        for wait in &report.waits {
            let [from, to] = outward(wait.t);
            let own = vec![display_name(&report.labels, wait.id), from, to];
            if wait.passed.is_empty() {
                columns.row([own.clone(), vec!["nobody".into(), String::new(), String::new(), String::new()]].concat());
            }
            for passing in &wait.passed {
                let [lower, upper] = outward(passing.clearance);
                let name = display_name(&report.labels, passing.id);
                columns.row([own.clone(), vec![name, thousandths(passing.way), lower, upper]].concat());
            }
        }
        columns.write(out)?;
    }
    if !report.gaps.is_empty() {
        writeln!(out, "\nNothing is known:")?;
        let mut columns = TextTable::new(&["<agent", "t from [s]", "to [s]"]);
        for gap in &report.gaps {
            let [from, to] = outward(gap.t);
            columns.row(vec![display_name(&report.labels, gap.id), from, to]);
        }
        columns.write(out)?;
    }
    if let Some(closest) = report.closest.as_ref().filter(|closest| !closest.is_empty()) {
        writeln!(out, "\nNearest to one another:")?;
        let mut columns =
            TextTable::new(&[i, j, "t [s]", "separation from [m]", "to [m]", "clearance from [m]", "to [m]"]);
        for pair in closest {
            let mut row = [pair.i, pair.j].map(|id| display_name(&report.labels, id)).to_vec();
            row.push(thousandths(pair.t));
            row.extend(outward(pair.separation));
            row.extend(outward(pair.clearance));
            columns.row(row);
        }
        columns.write(out)?;
    }
    Ok(())
}
