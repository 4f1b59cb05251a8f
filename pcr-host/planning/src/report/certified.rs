//! Results of the checker for tables, as text.

use super::text_table::TextTable;
use super::{agents, display_name, heading, quoted};
use crate::certify::CertifyReport;
use crate::figures::{small, thousandths};
use std::io::{self, Write};

/// The header line of [`certified_csv`].
pub const CERTIFIED_CSV_HEADER: &str = "name,verdict,promise,i,j,l_i,l_j,clearance,in_excess,i_label,j_label\n";

/// A line a place that is not proved, or one that says that all is.
///
/// # Errors
/// Errors of the writer.
pub fn certified_csv(certified: &CertifyReport, out: &mut dyn Write) -> io::Result<()> {
    let name = quoted(&certified.name);
    for (verdict, points) in [("refuted", &certified.refuted), ("undecided", &certified.undecided)] {
        for point in points {
            let (promise, numbers) = (point.promise, [point.l_i, point.l_j, point.clearance, point.in_excess]);
            let number = |number: f64| if number.is_nan() { String::new() } else { number.to_string() };
            let numbers = numbers.map(number).join(",");
            let [a, b] = [point.i, point.j].map(|id| quoted(certified.labels.get(id)));
            writeln!(out, "{name},{verdict},{promise},{},{},{numbers},{a},{b}", point.i, point.j)?;
        }
    }
    if certified.verdict == Some("proved") {
        writeln!(out, "{name},proved,,,,,,,,,")?;
    }
    Ok(())
}

/// A verdict for reading.
///
/// # Errors
/// Errors of the writer.
pub fn certified_table(certified: &CertifyReport, out: &mut dyn Write) -> io::Result<()> {
    let name = heading(&certified.name);
    if let Some(error) = &certified.error {
        return writeln!(out, "{name}: {error}");
    }
    let counted = |count: usize, one: &str, many: &str| format!("{count} {}", if count == 1 { one } else { many });
    let bodies = [
        (certified.discs > 0 || certified.outlines == 0).then(|| counted(certified.discs, "disc", "discs")),
        (certified.outlines > 0).then(|| counted(certified.outlines, "outline", "outlines")),
    ];
    let counts = [
        counted(certified.segment_pairs, "pair of segments", "pairs of segments"),
        counted(certified.pieces, "piece", "pieces"),
        counted(certified.times, "region in time", "regions in time"),
        counted(certified.steps, "step", "steps"),
    ];
    let verdict = certified.verdict.unwrap_or("refused");
    let counts: Vec<String> = bodies.into_iter().flatten().chain(counts).collect();
    writeln!(out, "{name}: {verdict}; {}", counts.join(", "))?;
    if let Some(margin) = certified.margin {
        writeln!(out, "Contacts are covered up to the combined radius and {margin:.3} of the bound ε.")?;
    }
    for (title, points) in [("Wrong", &certified.refuted), ("Not decided", &certified.undecided)] {
        if points.is_empty() {
            continue;
        }
        writeln!(out, "{title}:")?;
        let [i, j] = agents(&certified.labels);
        let mut columns = TextTable::new(&[i, j, "l_i [m]", "l_j [m]", "clearance [m]", "in ε", "<"]);
        for point in points {
            let mut row = [point.i, point.j].map(|id| display_name(&certified.labels, id)).to_vec();
            row.extend([point.l_i, point.l_j].map(|length| format!("{length:.6}")));
            let known = |text: String| if point.clearance.is_nan() { "unknown".into() } else { text };
            row.extend([small(point.clearance), thousandths(point.in_excess)].map(known));
            row.push(point.promise.into());
            columns.row(row);
        }
        columns.write(out)?;
    }
    Ok(())
}
