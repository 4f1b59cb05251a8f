//! Tables of locks, for programs and for reading.

use super::text_table::TextTable;
use super::{VersionedReport, counted, json, printable, quoted};
use crate::exclusion_table::{
    ExclusionPartner, ExclusionTable, ExclusionVehicle, SweptLayout, SyncProgressFn, TouchingAreas,
};
use crate::figures::{above, given, outward_but_for_rounding};
use pcr_formats::import::{ElementId, ImportError};
use serde::Serialize;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Version of what is printed about locks: version 1 had covers of discs.
pub const LOCKS_VERSION: u32 = 2;

/// The header line of [`locks_csv`].
pub const LOCKS_HEADER: &str = "a,b,a_from,a_to,b_from,b_to\n";

/// Why locks were not printed, or not to their end.
#[derive(Debug)]
pub enum ExclusionOutputError {
    /// There are none.
    Import(ImportError),
    /// The output cannot be written.
    Output(io::Error),
}

impl From<ImportError> for ExclusionOutputError {
    fn from(error: ImportError) -> Self {
        Self::Import(error)
    }
}

impl From<io::Error> for ExclusionOutputError {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

/// A line a lock. A node is `node` and its name, as `a`, and has no lengths. More than ten million are in the order of
/// [`SweptLayout::each`].
///
/// # Errors
/// Errors of the writer, and of [`SweptLayout::each`].
pub fn locks_csv(
    sweep: &SweptLayout,
    told: SyncProgressFn<'_>,
    out: &mut dyn Write,
) -> Result<(), ExclusionOutputError> {
    out.write_all(LOCKS_HEADER.as_bytes())?;
    let name = |(place, id): (usize, &ElementId)| {
        let kind = if sweep.is_edge(place) { "" } else { "node " };
        quoted(&format!("{kind}{id}")).into_owned()
    };
    let names: Vec<String> = sweep.ids().iter().enumerate().map(name).collect();
    let lines = |found: &[TouchingAreas]| {
        let mut text = String::with_capacity(100 * found.len());
        for TouchingAreas { places: [a, b], lengths: [own, other] } in found {
            match (sweep.is_edge(*a), sweep.is_edge(*b)) {
                (true, true) => csv_row(&mut text, [&names[*a], &names[*b]], Some(*own), Some(*other)),
                (true, false) => csv_row(&mut text, [&names[*b], &names[*a]], None, Some(*own)),
                (false, _) => csv_row(&mut text, [&names[*a], &names[*b]], None, None),
            }
        }
        text
    };
    sweep.each(told, &lines, |text| Ok::<(), ExclusionOutputError>(out.write_all(text.as_bytes())?))
}

/// Writes the locks of a table in memory as CSV, in its order.
///
/// # Errors
/// Errors of the writer.
pub fn kept_locks_csv(locks: &ExclusionTable, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(LOCKS_HEADER.as_bytes())?;
    let name = |id: &ElementId| quoted(&id.to_string()).into_owned();
    let node = |id: &ElementId| quoted(&format!("node {id}")).into_owned();
    let edges = locks.locks.iter();
    let edges = edges.map(|it| ([name(&it.a), name(&it.b)], Some(it.a_length), Some(it.b_length)));
    let nodes = locks.nodes.iter().flatten();
    let nodes = nodes.map(|it| ([node(&it.node), name(&it.edge)], None, Some(it.edge_length)));
    let pairs = locks.node_pairs.iter().flatten().map(|[a, b]| ([node(a), node(b)], None, None));
    let mut text = String::new();
    for ([a, b], own, other) in edges.chain(nodes).chain(pairs) {
        text.clear();
        csv_row(&mut text, [&a, &b], own, other);
        out.write_all(text.as_bytes())?;
    }
    Ok(())
}

/// A line of the names of two places, and the lengths from and to on both \[m\]; nodes have none.
fn csv_row(text: &mut String, [a, b]: [&str; 2], own: Option<[f64; 2]>, other: Option<[f64; 2]>) {
    text.extend([a, ",", b]);
    for part in [own, other] {
        // Writing to a `String` does not fail.
        let _ = match part {
            Some([from, to]) => write!(text, ",{from},{to}"),
            None => write!(text, ",,"),
        };
    }
    text.push('\n');
}

/// The first line of [`locks_lines`].
#[derive(Serialize)]
struct ExclusionReportHeader<'a> {
    layout: &'a str,
    vehicle: &'a ExclusionVehicle,
    warnings: &'a [String],
}

impl VersionedReport for ExclusionReportHeader<'_> {
    const FORMAT: &'static str = "pcr-lock-lines";
    const VERSION: u32 = LOCKS_VERSION;
}

/// JSON Lines: what the table is, then a line a lock as in the document `pcr-locks`, then how many there were: what has no such
/// line was cut off.
///
/// # Errors
/// As [`locks_csv`].
pub fn locks_lines(
    head: &ExclusionTable,
    sweep: &SweptLayout,
    told: SyncProgressFn<'_>,
    out: &mut dyn Write,
) -> Result<(), ExclusionOutputError> {
    json(&ExclusionReportHeader { layout: &head.layout, vehicle: &head.vehicle, warnings: &head.warnings }, out)?;
    let names: Vec<String> =
        sweep.ids().iter().map(serde_json::to_string).collect::<Result<_, _>>().map_err(io::Error::from)?;
    let lines = |found: &[TouchingAreas]| {
        let mut text = String::with_capacity(150 * found.len());
        for TouchingAreas { places: [a, b], lengths: [[a_from, a_to], [b_from, b_to]] } in found {
            let (a_name, b_name) = (&names[*a], &names[*b]);
            let _ = match (sweep.is_edge(*a), sweep.is_edge(*b)) {
                (true, true) => writeln!(
                    text,
                    r#"{{"a":{a_name},"b":{b_name},"a_length":[{a_from:?},{a_to:?}],"b_length":[{b_from:?},{b_to:?}]}}"#
                ),
                (true, false) => {
                    writeln!(text, r#"{{"node":{b_name},"edge":{a_name},"edge_length":[{a_from:?},{a_to:?}]}}"#)
                }
                (false, _) => writeln!(text, r#"{{"nodes":[{a_name},{b_name}]}}"#),
            };
        }
        (found.len(), text)
    };
    let mut count = 0;
    sweep.each(told, &lines, |(lines, text)| {
        count += lines;
        Ok::<(), ExclusionOutputError>(out.write_all(text.as_bytes())?)
    })?;
    Ok(writeln!(out, r#"{{"locks":{count}}}"#)?)
}

/// The locks of an edge.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EdgeExclusionsReport {
    /// Name of the layout; a table in a file does not have it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub layout: Option<String>,
    /// The vehicle; a table in a file does not have it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vehicle: Option<ExclusionVehicle>,
    /// The edge, or the node.
    pub edge: String,
    /// Sorted: edges, then nodes.
    pub partners: Vec<ExclusionPartner>,
    /// Warnings about input that was changed or left out when it was read; for a table in a file they were given when that was
    /// written.
    pub warnings: Vec<String>,
}

impl VersionedReport for EdgeExclusionsReport {
    const FORMAT: &'static str = "pcr-edge-locks";
    const VERSION: u32 = LOCKS_VERSION;
}

/// The header line of [`edge_csv`].
pub const EDGE_HEADER: &str = "edge,other,from,to,other_from,other_to\n";

/// A line a lock of an edge.
///
/// # Errors
/// Errors of the writer.
pub fn edge_csv(locks: &EdgeExclusionsReport, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(EDGE_HEADER.as_bytes())?;
    let edge = quoted(&locks.edge);
    for ExclusionPartner { name, node, own: [from, to], other: [other_from, other_to] } in &locks.partners {
        let name = format!("{}{name}", if *node { "node " } else { "" });
        writeln!(out, "{edge},{},{from},{to},{other_from},{other_to}", quoted(&name))?;
    }
    Ok(())
}

/// The locks of an edge in columns, lengths outward to the millimetre.
///
/// # Errors
/// Errors of the writer.
pub fn edge_table(locks: &EdgeExclusionsReport, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{}: {}", printable(&locks.edge), counted(locks.partners.len(), "lock"))?;
    let mut columns = TextTable::new(&["<other", "from [m]", "to", "other from [m]", "to"]);
    for ExclusionPartner { name, node, own, other } in &locks.partners {
        let name = format!("{}{name}", if *node { "node " } else { "" });
        columns.row(
            [
                vec![printable(&name)],
                outward_but_for_rounding(*own).to_vec(),
                outward_but_for_rounding(*other).to_vec(),
            ]
            .concat(),
        );
    }
    columns.write(out)
}

/// The vehicle of a table of locks, in words.
pub fn vehicle_text(vehicle: &ExclusionVehicle) -> String {
    let outline = match &vehicle.footprint {
        None => format!("radius {} m", given(vehicle.radius)),
        Some(footprint) => {
            format!("an outline of {} corners within {} m", footprint.polygon().len(), above(vehicle.radius))
        }
    };
    match vehicle.corner_margin {
        None => outline,
        Some(margin) => format!("{outline}, up to {} m more for rounded corners", above(margin)),
    }
}

/// The locks in columns, lengths outward to the millimetre.
///
/// # Errors
/// Errors of the writer.
pub fn locks_table(locks: &ExclusionTable, out: &mut dyn Write) -> io::Result<()> {
    let name = if locks.layout.is_empty() { "layout" } else { &locks.layout };
    let mut pairs: Vec<_> = locks.locks.iter().map(|lock| (&lock.a, &lock.b)).collect();
    pairs.dedup();
    let (count, pairs) = (counted(locks.locks.len(), "lock"), counted(pairs.len(), "pair"));
    let vehicle = vehicle_text(&locks.vehicle);
    writeln!(out, "{}: {count} of {pairs} of edges, {vehicle}", printable(name))?;
    let text = |id: &dyn ToString| printable(&id.to_string());
    if !locks.locks.is_empty() {
        let mut columns = TextTable::new(&["<a", "<b", "a from [m]", "to", "b from [m]", "to"]);
        for lock in &locks.locks {
            let cells = [
                [text(&lock.a), text(&lock.b)],
                outward_but_for_rounding(lock.a_length),
                outward_but_for_rounding(lock.b_length),
            ];
            columns.row(cells.concat());
        }
        columns.write(out)?;
    }
    if let Some(nodes) = &locks.nodes {
        writeln!(out, "{} of nodes", counted(nodes.len(), "lock"))?;
        let mut columns = TextTable::new(&["<node", "<edge", "from [m]", "to"]);
        for lock in nodes {
            columns.row([[text(&lock.node), text(&lock.edge)], outward_but_for_rounding(lock.edge_length)].concat());
        }
        columns.write(out)?;
    }
    for [a, b] in locks.node_pairs.iter().flatten() {
        writeln!(out, "  nodes {} and {}", text(a), text(b))?;
    }
    Ok(())
}
