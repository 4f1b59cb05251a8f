//! Conflicts as text.

use super::columns::Columns;
use super::{heading, quoted};
use crate::check::{Conflict, Verdict};
use std::io::{self, Write};

/// The header line of [`conflicts_csv`].
pub const CONFLICTS_CSV_HEADER: &str = "name,i,j,t_a,t_b,depth,l_i_a,l_i_b,l_j_a,l_j_b,touching\n";

/// A line a conflict: numbers that read back exactly, flags as 0 and 1.
///
/// # Errors
/// Those of the writer.
pub fn conflicts_csv(verdict: &Verdict, out: &mut impl Write) -> io::Result<()> {
    let name = quoted(&verdict.name);
    for conflict in &verdict.conflicts {
        let Conflict { i, j, t: [t_a, t_b], depth, l_i: [l_i_a, l_i_b], l_j: [l_j_a, l_j_b], .. } = conflict;
        let touching = u8::from(conflict.touching);
        writeln!(out, "{name},{i},{j},{t_a},{t_b},{depth},{l_i_a},{l_i_b},{l_j_a},{l_j_b},{touching}")?;
    }
    Ok(())
}

/// The conflicts for reading, and how near the agents come if that was asked for.
///
/// # Errors
/// Those of the writer.
pub fn conflicts_table(verdict: &Verdict, out: &mut impl Write) -> io::Result<()> {
    let name = heading(&verdict.name);
    match verdict.conflicts.len() {
        0 => writeln!(out, "{name}: no conflicts")?,
        1 => writeln!(out, "{name}: 1 conflict")?,
        many => writeln!(out, "{name}: {many} conflicts")?,
    }
    if !verdict.conflicts.is_empty() {
        let titles =
            ["i", "j", "t_a [s]", "t_b [s]", "depth [m]", "l_i from [m]", "to [m]", "l_j from [m]", "to [m]", "<"];
        let mut columns = Columns::new(&titles);
        for conflict in &verdict.conflicts {
            let mut row = vec![conflict.i.to_string(), conflict.j.to_string()];
            let [t_a, t_b] = conflict.t;
            let numbers = [t_a, t_b, conflict.depth].into_iter().chain(conflict.l_i).chain(conflict.l_j);
            row.extend(numbers.map(|number| format!("{number:.3}")));
            row.push(if conflict.touching { "touching" } else { "" }.into());
            columns.row(row);
        }
        columns.write(out)?;
    }
    if let Some(closest) = &verdict.closest {
        writeln!(out, "\nNearest to one another:")?;
        let mut columns = Columns::new(&["i", "j", "t [s]", "separation [m]", "clearance [m]"]);
        for pair in closest {
            let mut row = vec![pair.i.to_string(), pair.j.to_string()];
            row.extend([pair.t, pair.separation, pair.clearance].map(|number| format!("{number:.3}")));
            columns.row(row);
        }
        columns.write(out)?;
    }
    if let Some(proof) = &verdict.certificate {
        writeln!(out, "{}", proof.sentence())?;
    }
    Ok(())
}
