//! Reports of written exclusions and of audits, for reading and as CSV.

use crate::{ExclusionAudit, LayoutElementId, MissingExclusion, WriteReport};
use pcr_planning::figures::thousandths;
use pcr_planning::report::text_table::TextTable;
use pcr_planning::report::{VersionedReport, counted, printable, quoted, vehicle_text};
use std::io::{self, Write};

impl VersionedReport for WriteReport {
    const FORMAT: &'static str = "pcr-written";
    const VERSION: u32 = pcr_planning::report::LOCKS_VERSION;
}
impl VersionedReport for ExclusionAudit {
    const FORMAT: &'static str = "pcr-audit";
    const VERSION: u32 = pcr_planning::report::LOCKS_VERSION;
}

/// Largest number of rows of a printed table; the others are counted, and are in the other formats.
const ROWS: usize = 40;

fn named(layout: &str) -> String {
    printable(if layout.is_empty() { "layout" } else { layout })
}

fn times(excluded: f64, needed: f64) -> String {
    if needed > 0.0 { format!(", {:.1} times that", excluded / needed) } else { String::new() }
}

/// Prints how much is excluded, and how much is needed.
fn print_excluded_share(out: &mut dyn Write, excluded: f64, needed: f64, needless: usize) -> io::Result<()> {
    let times = times(excluded, needed);
    writeln!(out, "  lengths of two edges: {needed:.1} m² touch, {excluded:.1} m² are excluded{times}")?;
    writeln!(out, "  pairs of edges that cannot touch and are excluded: {needless}")
}

/// A summary of written exclusions.
///
/// # Errors
/// Errors of the writer.
pub fn written_table(written: &WriteReport, out: &mut dyn Write) -> io::Result<()> {
    writeln!(
        out,
        "{}: exclusions for {} on {} and {}, {}",
        named(&written.layout),
        written.exclusions,
        counted(written.edges, "edge"),
        counted(written.nodes, "node"),
        vehicle_text(&written.vehicle)
    )?;
    let cliques = |least| format!("; if all places of a group have to touch one another, at least {least} are needed");
    let bound = written.at_least.map_or(String::new(), cliques);
    writeln!(out, "  groups: {}{bound}", written.groups)?;
    writeln!(out, "  pairs that can touch: {}, all excluded by what stands in the file", written.can_touch)?;
    print_excluded_share(out, written.excluded, written.needed, written.needless)?;
    if let Some(uncut) = written.uncut {
        writeln!(
            out,
            "  without cutting, of the same lengths: {uncut:.1} m² excluded{}",
            times(uncut, written.needed)
        )?;
    }
    print_warnings(out, &written.warnings[written.of_layout..])
}

/// Prints warnings about the exclusions; those about the layout were printed when it was read.
fn print_warnings(out: &mut dyn Write, warnings: &[String]) -> io::Result<()> {
    warnings.iter().try_for_each(|warning| writeln!(out, "  {}", printable(warning)))
}

fn spot(spot: &LayoutElementId) -> String {
    match spot {
        LayoutElementId::Edge(id) => id.to_string(),
        LayoutElementId::Node(id) => format!("node {id}"),
    }
}

/// Which places an audit is of, where it is not of all.
fn selected(spots: &[LayoutElementId]) -> String {
    match spots {
        [] => String::new(),
        some => format!(
            "; pairs with {}",
            some.iter().map(|spot| printable(&spot.to_string())).collect::<Vec<_>>().join(", ")
        ),
    }
}

/// The audit: contacts, the deepest first, and needless exclusions.
///
/// # Errors
/// Errors of the writer.
pub fn audit_table(audit: &ExclusionAudit, out: &mut dyn Write) -> io::Result<()> {
    writeln!(
        out,
        "{}: audit of {} of {}, {}{}",
        named(&audit.layout),
        counted(audit.groups, "group"),
        audit.exclusions,
        vehicle_text(&audit.vehicle),
        selected(&audit.selected)
    )?;
    let count = |relation: &str| audit.gaps.iter().filter(|gap| gap.relation == relation).count();
    writeln!(
        out,
        "  pairs that can touch: {}, not excluded: {} ({} of one edge, {} with a common node, {} apart)",
        audit.can_touch,
        audit.gaps.len(),
        count("same"),
        count("adjacent"),
        count("apart")
    )?;
    print_excluded_share(out, audit.excluded, audit.needed, audit.needless.len())?;
    let mut gaps: Vec<&MissingExclusion> = audit.gaps.iter().collect();
    // Pairs without a common node come first, because the graph does not show them.
    let rank =
        |gap: &MissingExclusion| ["apart", "adjacent", "same"].iter().position(|relation| *relation == gap.relation);
    gaps.sort_by(|a, b| rank(a).cmp(&rank(b)).then(b.depth.total_cmp(&a.depth)));
    if !gaps.is_empty() {
        writeln!(out, "  not excluded:")?;
        let mut columns = TextTable::new(&["<a", "<b", "<", "depth [m]", "x [m]", "y [m]"]);
        for gap in gaps.iter().take(ROWS) {
            let [x, y] = gap.at;
            columns.row(vec![
                printable(&spot(&gap.a)),
                printable(&spot(&gap.b)),
                gap.relation.to_owned(),
                thousandths(gap.depth),
                thousandths(x),
                thousandths(y),
            ]);
        }
        columns.write(out)?;
        more(out, gaps.len())?;
    }
    if !audit.needless.is_empty() {
        writeln!(out, "  needless:")?;
        let mut columns = TextTable::new(&["<a", "<b"]);
        for pair in audit.needless.iter().take(ROWS) {
            columns.row([&pair.a, &pair.b].map(|id| printable(&id.to_string())).to_vec());
        }
        columns.write(out)?;
        more(out, audit.needless.len())?;
    }
    print_warnings(out, &audit.warnings[audit.of_layout..])
}

fn more(out: &mut dyn Write, count: usize) -> io::Result<()> {
    if count > ROWS { writeln!(out, "  and {} more (--json, --format csv)", count - ROWS) } else { Ok(()) }
}

/// The header line of [`audit_csv`].
pub const AUDIT_HEADER: &str = "finding,a,b,relation,a_from,a_to,b_from,b_to,x,y,depth\n";

/// One line for each finding: `open` for a contact that is not excluded, and `needless`. A node is `node` and its name, as `a`,
/// without lengths.
///
/// # Errors
/// Errors of the writer.
pub fn audit_csv(audit: &ExclusionAudit, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(AUDIT_HEADER.as_bytes())?;
    for gap in &audit.gaps {
        let [a, b] = [&gap.a, &gap.b].map(|at| quoted(&spot(at)).into_owned());
        let own = gap.a_length.map_or(",".to_owned(), |[from, to]| format!("{from},{to}"));
        let ([from, to], [x, y]) = (gap.b_length, gap.at);
        writeln!(out, "open,{a},{b},{},{own},{from},{to},{x},{y},{}", gap.relation, gap.depth)?;
    }
    for pair in &audit.needless {
        let [a, b] = [&pair.a, &pair.b].map(|id| quoted(&id.to_string()).into_owned());
        writeln!(out, "needless,{a},{b},,,,,,,,")?;
    }
    Ok(())
}
