//! Regions and crossings for reading.

use super::text_table::TextTable;
use super::{agents, counted, crossings, display_name, heading, types};
use crate::figures::{outward, thousandths};
use crate::regions::{CrossingDescriptor, RegionEntry, RegionsReport};
use pcr_formats::scenario::Labels;
use std::collections::HashMap;
use std::io::{self, Write};

/// A crossing with its place in the paper's numbering.
#[derive(Clone, Copy, Debug)]
pub(super) struct NumberedCrossing<'a> {
    pub(super) i: u64,
    pub(super) j: u64,
    /// Counted along the path of `i`, from 1, for each `j`.
    pub(super) k: usize,
    pub(super) piece_type: &'a str,
    pub(super) crossing: &'a CrossingDescriptor,
    /// Index of its region.
    region: usize,
}

/// The crossings in the order of Table VII: by ego, then along its path.
pub(super) fn numbered(regions: &[RegionEntry]) -> Vec<NumberedCrossing<'_>> {
    let mut all: Vec<NumberedCrossing<'_>> = Vec::new();
    for (index, region) in regions.iter().enumerate() {
        for piece in &region.pieces {
            let crossings = piece.crossings.iter();
            all.extend(crossings.map(|crossing| NumberedCrossing {
                i: region.i,
                j: region.j,
                k: 0,
                piece_type: &piece.piece_type,
                crossing,
                region: index,
            }));
        }
    }
    all.sort_by(|a, b| a.i.cmp(&b.i).then(a.crossing.length.total_cmp(&b.crossing.length)));
    let mut counts = HashMap::new();
    for numbered in &mut all {
        let count = counts.entry((numbered.i, numbered.j)).or_insert(0);
        *count += 1;
        numbered.k = *count;
    }
    all
}

/// An arc of a descriptor: radius and turn.
pub(super) fn arc(sigma: Option<f64>, dir: Option<i8>) -> String {
    match (sigma, dir) {
        (Some(sigma), Some(dir)) => format!("{sigma:.3} {}", if dir > 0 { "ccw" } else { "cw " }),
        _ => "-".into(),
    }
}

/// The crossings in the form of the paper's Table VII, then the regions, then those of the discs with their margins.
///
/// # Errors
/// Errors of the writer.
pub fn table(answer: &RegionsReport, out: &mut dyn Write) -> io::Result<()> {
    let all = numbered(&answer.regions);
    let name = heading(&answer.name);
    let (regions, crossings) = (counted(answer.regions.len(), "collision region"), counted(all.len(), "crossing"));
    writeln!(out, "{name}: {regions}, {crossings} ({})", answer.scalar)?;
    for bodies in answer.bodies.iter().filter(|bodies| bodies.parts.len() > 1) {
        let parts = bodies.parts.len();
        let stretch = bodies.segments.map_or(String::new(), |[a, b]| format!(", segments {a} to {b}"));
        let id = display_name(&answer.labels, bodies.id);
        writeln!(out, "agent {id}{stretch}: a concave outline of {parts} convex parts")?;
    }
    if !all.is_empty() {
        writeln!(out, "\nCrossings: j passes L on the path of i at T; theta = heading of j - heading of i")?;
        let [i, j] = agents(&answer.labels);
        let mut columns = TextTable::new(&[
            i,
            j,
            "k",
            "<type",
            "T [s]",
            "L [m]",
            "r_hat [m]",
            "v_j [m/s]",
            "theta",
            "arc of i",
            "arc of j",
        ]);
        for NumberedCrossing { i, j, k, piece_type, crossing, .. } in &all {
            let [i, j] = [i, j].map(|id| display_name(&answer.labels, *id));
            let mut row = vec![i, j, k.to_string(), (*piece_type).to_owned()];
            let numbers = [crossing.time, crossing.length, crossing.r_hat, crossing.v, crossing.theta];
            row.extend(numbers.map(thousandths));
            row.extend([arc(crossing.sigma_i, crossing.dir_i), arc(crossing.sigma_j, crossing.dir_j)]);
            columns.row(row);
        }
        columns.write(out)?;
        writeln!(
            out,
            "k: number of the crossing among those of i with j; type: straight (S) or arc (A), of i and of j"
        )?;
    }
    extents(&answer.labels, &answer.regions, &all, "Regions", out)?;
    let margin = answer.margin_regions.as_deref().unwrap_or_default();
    extents(&answer.labels, margin, &numbered(margin), "Regions of the discs with their margins", out)
}

/// The extents of regions, with the numbers of their crossings.
fn extents(
    labels: &Labels,
    regions: &[RegionEntry],
    all: &[NumberedCrossing<'_>],
    title: &str,
    out: &mut dyn Write,
) -> io::Result<()> {
    if regions.is_empty() {
        return Ok(());
    }
    writeln!(out, "\n{title}: their extents; the lengths inside at a given time: --format json --slices N")?;
    let [i, j] = agents(labels);
    let mut columns = TextTable::new(&[i, j, "t_a [s]", "t_b [s]", "l_a [m]", "l_b [m]", "<open", "<k", "<pieces"]);
    let mut held: HashMap<usize, Vec<String>> = HashMap::new();
    for crossing in all {
        held.entry(crossing.region).or_default().push(crossing.k.to_string());
    }
    for (index, region) in regions.iter().enumerate() {
        let mut row = [region.i, region.j].map(|id| display_name(labels, id)).to_vec();
        row.extend([region.t, region.l].into_iter().flat_map(outward));
        let open = match (region.open_start, region.open_end) {
            (false, false) => "-",
            (true, false) => "start",
            (false, true) => "end",
            (true, true) => "both",
        };
        let held = held.get(&index).map_or("-".into(), |held| held.join(","));
        row.extend([open.to_owned(), held, types(region)]);
        columns.row(row);
    }
    columns.write(out)?;
    if regions.iter().any(|region| region.open_start || region.open_end) {
        writeln!(out, "open: j stands in the way before t_a already, at its start, or after t_b as well, at its end")?;
    }
    let near = match regions.iter().filter(|region| crossings(region) == 0).count() {
        0 => String::new(),
        near => format!(" (-: the paths come near but do not cross, {near} of {})", regions.len()),
    };
    writeln!(out, "k: the crossings in the region{near}")?;
    Ok(())
}
