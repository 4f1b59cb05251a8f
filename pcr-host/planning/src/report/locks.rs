//! Tables of locks, for programs and for reading.

use super::columns::Columns;
use super::{printable, quoted};
use crate::locks::Locks;
use std::io::{self, Write};

/// The header line of [`locks_csv`].
pub const LOCKS_HEADER: &str = "a,b,a_from,a_to,b_from,b_to\n";

/// A line a lock. A node is `node` and its name, as `a`, and has no lengths.
///
/// # Errors
/// Those of the writer.
pub fn locks_csv(locks: &Locks, out: &mut impl Write) -> io::Result<()> {
    out.write_all(LOCKS_HEADER.as_bytes())?;
    for lock in &locks.locks {
        let [a, b] = [&lock.a, &lock.b].map(|id| quoted(&id.to_string()).into_owned());
        let ([a_from, a_to], [b_from, b_to]) = (lock.a_length, lock.b_length);
        writeln!(out, "{a},{b},{a_from},{a_to},{b_from},{b_to}")?;
    }
    for lock in locks.nodes.iter().flatten() {
        let [from, to] = lock.edge_length;
        writeln!(out, "{},{},,,{from},{to}", quoted(&format!("node {}", lock.node)), quoted(&lock.edge.to_string()))?;
    }
    for [a, b] in locks.node_pairs.iter().flatten() {
        writeln!(out, "{},{},,,,", quoted(&format!("node {a}")), quoted(&format!("node {b}")))?;
    }
    Ok(())
}

/// The locks in columns, lengths outward to the millimetre.
///
/// # Errors
/// Those of the writer.
pub fn locks_table(locks: &Locks, out: &mut impl Write) -> io::Result<()> {
    let name = if locks.layout.is_empty() { "layout" } else { &locks.layout };
    let mut pairs: Vec<_> = locks.locks.iter().map(|lock| (&lock.a, &lock.b)).collect();
    pairs.dedup();
    let counted = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    let (count, pairs) = (counted(locks.locks.len(), "lock"), counted(pairs.len(), "pair"));
    let vehicle = match (locks.vehicle.discs.len(), locks.vehicle.radius) {
        (0, radius) => format!("radius {radius} m"),
        (discs, radius) => format!("an outline of {discs} discs within {radius:.3} m"),
    };
    writeln!(out, "{}: {count} of {pairs} of edges, {vehicle}", printable(name))?;
    let range = |[from, to]: [f64; 2]| {
        // What rounding adds is no millimetre.
        let (from, to) = ((from * 1e3 + 1e-6).floor() / 1e3, (to * 1e3 - 1e-6).ceil() / 1e3);
        [format!("{from:.3}"), format!("{to:.3}")]
    };
    let text = |id: &dyn ToString| printable(&id.to_string());
    if !locks.locks.is_empty() {
        let mut columns = Columns::new(&["<a", "<b", "a from [m]", "to", "b from [m]", "to"]);
        for lock in &locks.locks {
            let cells = [[text(&lock.a), text(&lock.b)], range(lock.a_length), range(lock.b_length)];
            columns.row(cells.concat());
        }
        columns.write(out)?;
    }
    if let Some(nodes) = &locks.nodes {
        writeln!(out, "{} locks of nodes", nodes.len())?;
        let mut columns = Columns::new(&["<node", "<edge", "from [m]", "to"]);
        for lock in nodes {
            columns.row([[text(&lock.node), text(&lock.edge)], range(lock.edge_length)].concat());
        }
        columns.write(out)?;
    }
    for [a, b] in locks.node_pairs.iter().flatten() {
        writeln!(out, "  nodes {} and {}", text(a), text(b))?;
    }
    Ok(())
}
