//! Comparisons as text.

use crate::compare::{Accuracy, Comparison, MethodMeasurement, MethodQuestion, UnavailableMethod};
use pcr_planning::figures::{bytes, seconds, share, time, times};
use pcr_planning::report::text_table::TextTable;
use pcr_planning::report::{VersionedReport, counted, heading, quoted};
use std::io::{self, Write};

impl VersionedReport for Comparison {
    const FORMAT: &'static str = "pcr-comparison";
}

/// The header line of [`comparison_csv`].
pub const COMPARISON_CSV_HEADER: &str =
    "name,agents,method,question,ms,ratio,rounds,count,bytes,conflicts,missed,invented,time,area,difference\n";

/// A line a method.
///
/// # Errors
/// Errors of the writer.
pub fn comparison_csv(comparison: &Comparison, out: &mut dyn Write) -> io::Result<()> {
    let (name, agents) = (quoted(&comparison.name), comparison.agents);
    for row in &comparison.rows {
        let MethodMeasurement { method, ms, ratio, rounds, count, bytes, .. } = row;
        let question = match row.question {
            MethodQuestion::Regions => "regions",
            MethodQuestion::Conflicts => "conflicts",
        };
        let errors = match row.errors {
            Accuracy::Conflicts { conflicts, missed, invented, time } => {
                format!("{conflicts},{missed},{invented},{time},,")
            }
            Accuracy::Regions { area, difference } => format!(",,,,{area},{difference}"),
        };
        let method = quoted(method);
        writeln!(out, "{name},{agents},{method},{question},{ms},{ratio},{rounds},{count},{bytes},{errors}")?;
    }
    Ok(())
}

/// A heading and a table for each question, as text or in Markdown.
///
/// # Errors
/// Errors of the writer.
pub fn comparison_table(comparison: &Comparison, markdown: bool, out: &mut dyn Write) -> io::Result<()> {
    let Comparison { agents, rows, absent, .. } = comparison;
    if !markdown {
        writeln!(out, "{}: {}\n", heading(&comparison.name), counted(*agents, "agent"))?;
    }
    for (place, question) in [MethodQuestion::Regions, MethodQuestion::Conflicts].into_iter().enumerate() {
        let titles = match question {
            MethodQuestion::Regions => ["pairs or regions", "kept", "area off"].as_slice(),
            MethodQuestion::Conflicts => &["found", "missed", "invented", "time off"],
        };
        let mut all = vec!["<method", "<tells", "time", "of pcr's"];
        all.extend(titles);
        let mut columns = TextTable::new(&all);
        for row in rows.iter().filter(|row| row.question == question) {
            columns.row(cells(row));
        }
        if place > 0 {
            writeln!(out)?;
        }
        if markdown { columns.write_markdown(out)? } else { columns.write(out)? }
    }
    if !absent.is_empty() {
        let absent: Vec<_> =
            absent.iter().map(|UnavailableMethod { method, reason }| format!("{method}: {reason}")).collect();
        writeln!(out, "\nLeft out: {}.", absent.join("; "))?;
    }
    Ok(())
}

fn cells(row: &MethodMeasurement) -> Vec<String> {
    let mut cells = vec![row.method.clone(), row.tells.to_owned(), time(row.ms), times(row.ratio)];
    match row.errors {
        Accuracy::Regions { area, difference } => {
            cells.extend([row.count.to_string(), bytes(row.bytes), share(difference / area)]);
        }
        Accuracy::Conflicts { conflicts, missed, invented, time } => cells.extend([
            format!("{} of {conflicts}", conflicts - missed),
            missed.to_string(),
            invented.to_string(),
            seconds(time),
        ]),
    }
    cells
}
