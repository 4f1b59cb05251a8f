//! Writes exclusions into layout files of fleet software, and counts what they exclude beyond the exact table.
//!
//! A written file is read again, by the reader that audits files of other origin; it is refused if any contact is not
//! excluded.

use crate::settings::{Notes, Settings};
use crate::{Audit, Target, nav2, opentcs, own, read, rmf, table, vda5050};
use pcr_formats::import::{self, Format, ImportError, Imported, Options, Warnings};
use pcr_planning::locks::LockVehicle;
use pcr_planning::memory;
use serde::Serialize;

/// What a part of an edge that is cut takes, with a few locks \[bytes\].
const PART_BYTES: u64 = 4096;

/// What has been written.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Written {
    /// Name of the layout.
    pub layout: String,
    /// The vehicle.
    pub vehicle: LockVehicle,
    /// The format of the exclusions.
    pub exclusions: String,
    /// Edges of the file that is written.
    pub edges: usize,
    /// Its nodes.
    pub nodes: usize,
    /// Groups, blocks, zones or lists.
    pub groups: usize,
    /// No fewer cover the pairs, where a bound is known: cliques of pairs that touch.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_least: Option<usize>,
    /// Pairs of edges, and of a node and an edge, on which two vehicles can touch: none of them is left out.
    pub can_touch: usize,
    /// Pairs of edges that cannot touch and are excluded all the same.
    pub needless: usize,
    /// Lengths of two edges at which the file excludes vehicles that are on both \[m²\].
    pub excluded: f64,
    /// Those at which the table of locks does \[m²\].
    pub needed: f64,
    /// What would be excluded of the same lengths without cutting, where edges, lanes, paths or zones are cut \[m²\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub uncut: Option<f64>,
    /// What was left as it is, or replaced, and what was read otherwise than it was written.
    pub warnings: Vec<String>,
    /// How many of these are of the layout.
    #[serde(skip)]
    pub of_layout: usize,
}

/// Writes exclusions: the text of the new file, the layout in it, and what they are like.
///
/// # Errors
/// [`ImportError`] where the layout cannot be read whole or not be written, or is of another format than asked for.
pub fn write(
    format: Format,
    text: &str,
    options: &Options,
    name: &str,
    settings: &Settings,
) -> Result<(String, Written, Audit), ImportError> {
    let refused = |problem: String| Err(ImportError::new(problem));
    let target = settings.target;
    if let Some(needed) = target.layout().filter(|needed| *needed != format) {
        return refused(format!(
            "exclusions of {target} are written into files of {needed}, and this is one of {format}"
        ));
    }
    if options.partial {
        return refused("--partial: what is left out of a layout would be free in the file".into());
    }
    if settings.split.is_some() && target == Target::Pcr {
        return refused("--split: a lock file has stretches already".into());
    }
    if settings.envelopes.is_some() && target != Target::OpenTcs {
        return refused(format!("--envelopes: {target} has none"));
    }
    let mut notes = Notes::default();
    let read_layout = |text: &str| -> Result<Imported, ImportError> {
        let mut imported = import::layout(format, text, options, &mut Warnings::default())?;
        if imported.layout.name.is_empty() {
            name.clone_into(&mut imported.layout.name);
        }
        Ok(imported)
    };
    let imported = read_layout(text)?;
    if imported.vehicle.footprint.is_some() && target == Target::Vda5050 {
        notes.said.push("zones: they are for the disc around the outline".into());
    }
    if let Some(most) = settings.split {
        let parts = imported.layout.edges.iter().map(|edge| (edge.length() / most).ceil()).sum::<f64>() as u64;
        let asked = memory::ask(parts.saturating_mul(PART_BYTES), || format!("--split {most}: {parts} parts"));
        asked.map_err(|large| ImportError::new(large.to_string()))?;
    }
    // What cutting is worth.
    let uncut = Settings { split: None, ..settings.clone() };
    let uncut = settings.split.map(|_| write(format, text, options, name, &uncut)).transpose()?;
    if let (Target::Rmf, Some(graph)) = (target, options.graph) {
        notes
            .said
            .push(format!("lanes of other graphs than {graph} are left as they are, and nothing is said of them"));
    }
    let prepared = match (target, settings.split) {
        (Target::Nav2, Some(most)) => {
            let (text, whole) = nav2::split(text, most)?;
            notes.said.extend(whole);
            Some(text)
        }
        (Target::OpenTcs, Some(most)) => {
            Some(opentcs::split(text, &imported, most, settings.envelopes.as_deref(), &mut notes)?)
        }
        (Target::Rmf, most) => Some(rmf::prepare(text, &imported, most, &mut notes)?),
        _ => None,
    };
    let (text, imported) = match prepared {
        Some(prepared) => {
            let imported = read_layout(&prepared)?;
            (prepared, imported)
        }
        None => (text.to_owned(), imported),
    };
    let locks = table(&imported)?;
    let written = match target {
        Target::Nav2 => nav2::write(&text, &imported, &locks)?,
        Target::Rmf => rmf::write(&text, &imported, &locks, &mut notes)?,
        Target::OpenTcs => opentcs::write(&text, &imported, &locks, settings, &mut notes)?,
        Target::Vda5050 => vda5050::write(&imported, settings, &mut notes),
        Target::Pcr => own::write(&imported, &locks),
    };
    let again = if target.layout().is_some() { read_layout(&written)? } else { imported };
    let rules = read(target, &written, &again)?;
    let audit = Audit::of(&again, &locks, &rules, target)?;
    if let Some(gap) = audit.gaps.first() {
        let (a, b, depth) = (&gap.a, &gap.b, gap.depth);
        return refused(format!("{a} and {b} are not excluded by what would be written ({depth:.3} m deep)"));
    }
    // An edge excludes itself: two parts of one are lengths that it excludes without cutting, too.
    let squares = |layout: &Imported| layout.layout.edges.iter().map(|edge| edge.length().powi(2)).sum::<f64>();
    let uncut = match uncut {
        Some((uncut, report, _)) if target.layout().is_some() => {
            Some(report.excluded + (squares(&read_layout(&uncut)?) - squares(&again)) / 2.0)
        }
        uncut => uncut.map(|(_, report, _)| report.excluded),
    };
    let report = Written {
        layout: locks.layout.clone(),
        vehicle: locks.vehicle.clone(),
        exclusions: target.to_string(),
        edges: again.layout.edges.len(),
        nodes: again.layout.nodes.len(),
        groups: if settings.envelopes.is_some() || notes.groups > 0 || notes.at_least.is_some() {
            notes.groups
        } else {
            audit.groups
        },
        at_least: notes.at_least,
        can_touch: audit.can_touch,
        needless: audit.needless.len(),
        excluded: audit.excluded,
        needed: audit.needed,
        uncut,
        warnings: audit.warnings.iter().chain(&notes.said).cloned().collect(),
        of_layout: audit.of_layout,
    };
    Ok((written, report, audit))
}
