//! Answers as text: JSON and CSV for programs, tables for people.

mod approaches;
mod certified;
mod conflicts;
mod delays;
mod locks;
mod nodes;
mod overview;
mod plans;
mod proofs;
mod streamed_regions;
mod table;
pub mod text_table;

pub use approaches::approaches_table;
pub use certified::{CERTIFIED_CSV_HEADER, certified_csv, certified_table};
pub use conflicts::{CONFLICTS_CSV_HEADER, conflicts_csv, conflicts_table};
pub use delays::{
    DELAYS_HEADER, UnsafeDelay, UnsafeDelayReport, UnsafeNodeTimes, delays_csv, delays_lines, delays_table,
};
pub use locks::{
    EDGE_HEADER, EdgeExclusionsReport, ExclusionOutputError, LOCKS_HEADER, LOCKS_VERSION, edge_csv, edge_table,
    kept_locks_csv, locks_csv, locks_lines, locks_table, vehicle_text,
};
pub use nodes::{nodes_csv, nodes_table};
pub use overview::overview;
pub use pcr_formats::scenario::printable;
pub use plans::{PLAN_CSV_HEADER, left_open, plan_csv, plan_table, reasons};
pub use proofs::proof_line;
pub use streamed_regions::{OutputError, sheet_csv, sheet_json};
pub use table::table;

use crate::approaches::ApproachReport;
use crate::certify::{self, CertifyReport};
use crate::check::CheckReport;
use crate::exclusion_table::ExclusionTable;
use crate::nodes::LayoutReport;
use crate::plan::PlanReport;
use crate::regions::{RegionEntry, RegionsReport};
use pcr_formats::scenario::Labels;
use serde::Serialize;
use std::borrow::Cow;
use std::fmt::Write as _;
use std::io::{self, Write};

/// An answer that is printed as JSON, with its format and version.
pub trait VersionedReport: Serialize {
    /// Name of the format; the schema is `docs/reference/schema/FORMAT.schema.json`.
    const FORMAT: &'static str;
    /// Version: counts changes that affect programs which read it; new fields do not.
    const VERSION: u32 = 1;
}

impl VersionedReport for RegionsReport {
    const FORMAT: &'static str = certify::ANSWERS;
    const VERSION: u32 = certify::VERSION;
}
impl VersionedReport for CheckReport {
    const FORMAT: &'static str = "pcr-conflicts";
    const VERSION: u32 = 2;
}
impl VersionedReport for ApproachReport {
    const FORMAT: &'static str = "pcr-approaches";
}
impl VersionedReport for CertifyReport {
    const FORMAT: &'static str = "pcr-certificate";
}
impl VersionedReport for PlanReport {
    const FORMAT: &'static str = "pcr-plan";
}
impl VersionedReport for ExclusionTable {
    const FORMAT: &'static str = "pcr-locks";
    const VERSION: u32 = LOCKS_VERSION;
}
impl VersionedReport for LayoutReport<'_> {
    const FORMAT: &'static str = "pcr-nodes";
}

/// One line of JSON.
///
/// # Errors
/// Errors of the writer.
pub fn json<D: VersionedReport>(answer: &D, out: &mut dyn Write) -> io::Result<()> {
    #[derive(Serialize)]
    struct ReportEnvelope<'a, D> {
        format: &'static str,
        version: u32,
        #[serde(flatten)]
        answer: &'a D,
    }
    serde_json::to_writer(&mut *out, &ReportEnvelope { format: D::FORMAT, version: D::VERSION, answer })?;
    out.write_all(b"\n")
}

/// The header line of [`csv`].
pub const CSV_HEADER: &str = "name,i,j,t_a,t_b,l_a,l_b,open_start,open_end,types,crossings,margin,i_label,j_label\n";

/// One line for each region: numbers that read back exactly, flags as 0 and 1, types as `SS+2AA`. Regions of discs with margins
/// come last, with 1 in the column `margin`.
///
/// # Errors
/// Errors of the writer.
pub fn csv(answer: &RegionsReport, out: &mut dyn Write) -> io::Result<()> {
    csv_rows(&answer.name, &answer.labels, &answer.regions, false, out)?;
    csv_rows(&answer.name, &answer.labels, answer.margin_regions.as_deref().unwrap_or_default(), true, out)
}

/// Some of these lines.
fn csv_rows(name: &str, labels: &Labels, regions: &[RegionEntry], margin: bool, out: &mut dyn Write) -> io::Result<()> {
    let (name, margin) = (quoted(name), u8::from(margin));
    for region in regions {
        let RegionEntry { i, j, t: [t_a, t_b], l: [l_a, l_b], .. } = region;
        let (open_start, open_end) = (u8::from(region.open_start), u8::from(region.open_end));
        let crossings = crossings(region);
        let types = types(region);
        let [a, b] = [i, j].map(|id| quoted(labels.get(*id)));
        write!(out, "{name},{i},{j},{t_a},{t_b},{l_a},{l_b},{open_start},{open_end},{types},{crossings},{margin}")?;
        writeln!(out, ",{a},{b}")?;
    }
    Ok(())
}

/// A name as a field of CSV.
pub fn quoted(name: &str) -> Cow<'_, str> {
    if name.contains(['"', ',', '\n', '\r']) {
        Cow::Owned(format!("\"{}\"", name.replace('"', "\"\"")))
    } else {
        Cow::Borrowed(name)
    }
}

/// Number of crossings in a region.
fn crossings(region: &RegionEntry) -> usize {
    region.pieces.iter().map(|piece| piece.crossings.len()).sum()
}

/// The types of the pieces with their numbers, in the order in which they first occur.
fn types(region: &RegionEntry) -> String {
    let mut counts: Vec<(&str, usize)> = Vec::new();
    for piece in &region.pieces {
        match counts.iter_mut().find(|(piece_type, _)| *piece_type == piece.piece_type) {
            Some((_, count)) => *count += 1,
            None => counts.push((&piece.piece_type, 1)),
        }
    }
    let mut text = String::new();
    for (piece_type, count) in counts {
        let plus = if text.is_empty() { "" } else { "+" };
        let count = if count > 1 { count.to_string() } else { String::new() };
        // Writing to a `String` does not fail.
        let _ = write!(text, "{plus}{count}{piece_type}");
    }
    text
}

/// Titles of the columns of two agents; labels are left-aligned.
fn agents(labels: &Labels) -> [&'static str; 2] {
    if labels.is_empty() { ["i", "j"] } else { ["<i", "<j"] }
}

/// An agent in a table.
pub fn display_name(labels: &Labels, id: u64) -> String {
    printable(&labels.display_name(id))
}

/// Some agents in a sentence.
pub fn all_called(labels: &Labels, ids: &[u64]) -> String {
    ids.iter().map(|id| display_name(labels, *id)).collect::<Vec<_>>().join(" and ")
}

/// A number with a noun: `1 lock`, `2 locks`.
pub fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// The name of a scenario in a heading.
pub fn heading(name: &str) -> String {
    if name.is_empty() { "scenario".into() } else { printable(name) }
}
