//! Conflicts as text.

use super::proofs::proof_line;
use super::text_table::TextTable;
use super::{agents, display_name, heading, quoted};
use crate::check::{CheckReport, ConflictEntry};
use crate::figures::{outward, small, thousandths};
use std::io::{self, Write};

/// The header line of [`conflicts_csv`].
pub const CONFLICTS_CSV_HEADER: &str = "name,i,j,t_a,t_b,depth,l_i_a,l_i_b,l_j_a,l_j_b,touching,i_label,j_label\n";

/// A line a conflict: numbers that read back exactly, flags as 0 and 1.
///
/// # Errors
/// Errors of the writer.
pub fn conflicts_csv(verdict: &CheckReport, out: &mut dyn Write) -> io::Result<()> {
    let name = quoted(&verdict.name);
    for conflict in &verdict.conflicts {
        let ConflictEntry { i, j, t: [t_a, t_b], depth, l_i: [l_i_a, l_i_b], l_j: [l_j_a, l_j_b], .. } = conflict;
        let touching = u8::from(conflict.touching);
        let [a, b] = [i, j].map(|id| quoted(verdict.labels.get(*id)));
        writeln!(out, "{name},{i},{j},{t_a},{t_b},{depth},{l_i_a},{l_i_b},{l_j_a},{l_j_b},{touching},{a},{b}")?;
    }
    Ok(())
}

/// The conflicts for reading, and how near the agents come if that was asked for.
///
/// # Errors
/// Errors of the writer.
pub fn conflicts_table(verdict: &CheckReport, out: &mut dyn Write) -> io::Result<()> {
    let name = heading(&verdict.name);
    match verdict.conflicts.len() {
        0 => match verdict.agents {
            1 => writeln!(out, "{name}: no conflicts, 1 agent")?,
            agents => writeln!(out, "{name}: no conflicts, {agents} agents")?,
        },
        1 => writeln!(out, "{name}: 1 conflict")?,
        many => writeln!(out, "{name}: {many} conflicts")?,
    }
    if !verdict.conflicts.is_empty() {
        let [i, j] = agents(&verdict.labels);
        let titles =
            [i, j, "t_a [s]", "t_b [s]", "depth [m]", "l_i from [m]", "to [m]", "l_j from [m]", "to [m]", "<touching"];
        let mut columns = TextTable::new(&titles);
        let touching = verdict.conflicts.iter().filter(|conflict| conflict.touching).count();
        for conflict in &verdict.conflicts {
            let mut row = [conflict.i, conflict.j].map(|id| display_name(&verdict.labels, id)).to_vec();
            row.extend(outward(conflict.t));
            row.push(small(conflict.depth));
            row.extend([conflict.l_i, conflict.l_j].into_iter().flat_map(outward));
            row.push(if conflict.touching { "*" } else { "" }.into());
            columns.row(row);
        }
        columns.write(out)?;
        if touching > 0 {
            writeln!(
                out,
                "* touching ({touching}): not deeper than the tolerance of the search, 2e-10 of the coordinates in f64, so it may be no contact"
            )?;
        }
    }
    if let Some(closest) = verdict.closest.as_ref().filter(|closest| !closest.is_empty()) {
        writeln!(out, "\nNearest to one another:")?;
        let [i, j] = agents(&verdict.labels);
        let mut columns = TextTable::new(&[i, j, "t [s]", "separation [m]", "clearance [m]"]);
        for pair in closest {
            let mut row = [pair.i, pair.j].map(|id| display_name(&verdict.labels, id)).to_vec();
            row.extend([thousandths(pair.t), small(pair.separation), small(pair.clearance)]);
            columns.row(row);
        }
        columns.write(out)?;
    }
    if let Some(proof) = &verdict.certificate {
        writeln!(out, "{}", proof_line(proof, &verdict.labels))?;
    }
    Ok(())
}
