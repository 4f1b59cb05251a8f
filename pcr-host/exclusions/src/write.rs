//! Writes exclusions into layout files of fleet software, and counts what they exclude beyond the exact table.
//!
//! A written file is read again, by the reader that audits files of other origin. It is refused if any contact is not excluded, if its
//! layout is not the one before with its edges cut, and if it has what its version has not.

use crate::kept::{Cut, compare};
use crate::options::{WriteNotes, WriteOptions};
use crate::{ExclusionAudit, ExclusionFormat, VehicleStamp, lock_file, nav2, opentcs, read, rmf, table, vda5050};
use pcr_formats::import::{self, ImportError, ImportOptions, ImportedLayout, InputFormat, SizeSource, Warnings};
use pcr_formats::warning::WarningCode;
use pcr_planning::exclusion_table::{ExclusionTable, ExclusionVehicle};
use pcr_planning::memory_budget::MemoryDemand;
use serde::Serialize;

/// What has been written.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WriteReport {
    /// Name of the layout.
    pub layout: String,
    /// The vehicle.
    pub vehicle: ExclusionVehicle,
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
    format: InputFormat,
    text: &str,
    options: &ImportOptions,
    name: &str,
    settings: &WriteOptions,
) -> Result<(String, WriteReport, ExclusionAudit), ImportError> {
    refuse(format, options, settings)?;
    let source = LayoutSource { format, options, name };
    let done = source.write(text, settings)?;
    // What cutting is worth.
    let uncut = match settings.split {
        Some(_) => Some(source.write(text, &WriteOptions { split: None, ..settings.clone() })?.excluded_of(&done)),
        None => None,
    };
    let report = done.report(settings, uncut);
    Ok((done.text, report, done.audit))
}

/// Refuses a vehicle of a size that nobody gave: others rely on exclusions and audits.
///
/// # Errors
/// That it is not in the file, and which options say it.
pub fn sized(imported: &ImportedLayout) -> Result<(), ImportError> {
    match imported.vehicle.size {
        SizeSource::Assumed => Err(ImportError::new(
            "the size of the vehicle is not in the file, and none is assumed for what others rely on; give --radius M, or --fleet FILE",
        )),
        SizeSource::Option | SizeSource::Fleet | SizeSource::File => Ok(()),
    }
}

/// # Errors
/// The first option that has no place in what is to be written.
fn refuse(format: InputFormat, options: &ImportOptions, settings: &WriteOptions) -> Result<(), ImportError> {
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
    if settings.split.is_some() && target == ExclusionFormat::Pcr {
        return refused("--split: a lock file has stretches already".into());
    }
    if settings.envelopes.is_some() && target != ExclusionFormat::OpenTcs {
        return refused(format!("--envelopes: {target} has none"));
    }
    Ok(())
}

/// A layout file, and how it is read.
struct LayoutSource<'a> {
    format: InputFormat,
    options: &'a ImportOptions,
    name: &'a str,
}

/// What was written, read again.
struct WrittenLayout {
    text: String,
    again: ImportedLayout,
    locks: ExclusionTable,
    audit: ExclusionAudit,
    notes: WriteNotes,
}

impl LayoutSource<'_> {
    fn layout(&self, text: &str) -> Result<ImportedLayout, ImportError> {
        let mut imported = import::layout(self.format, text, self.options, &mut Warnings::default())?;
        if imported.layout.name.is_empty() {
            self.name.clone_into(&mut imported.layout.name);
        }
        imported.layout.include_corners();
        Ok(imported)
    }

    fn write(&self, before: &str, settings: &WriteOptions) -> Result<WrittenLayout, ImportError> {
        let target = settings.target;
        let original = self.layout(before)?;
        sized(&original)?;
        let (text, imported, mut notes) = self.prepared(before, &original, settings)?;
        let locks = table(&imported)?;
        let text = match target {
            ExclusionFormat::Nav2 => nav2::write(&text, &imported, &locks)?,
            ExclusionFormat::Rmf => rmf::write(&text, &imported, &locks, &mut notes)?,
            ExclusionFormat::OpenTcs => opentcs::write(&text, &imported, &locks, settings, &mut notes)?,
            ExclusionFormat::Vda5050 => vda5050::write(&imported, settings, &mut notes)?,
            ExclusionFormat::Pcr => lock_file::write(&imported, &locks)?,
        };
        let again = if target.layout().is_some() {
            let again = self.layout(&text)?;
            let rounding = if target == ExclusionFormat::OpenTcs { opentcs::ROUNDING } else { 0.0 };
            compare(&original, &again, Cut { most: settings.split, rounding })?;
            if target == ExclusionFormat::OpenTcs {
                opentcs::check(before, &text)?;
            }
            again
        } else {
            imported
        };
        let rules = read(target, &text, &again)?;
        if rules.stamp.as_ref() != Some(&VehicleStamp::of(&again)) {
            return Err(ImportError::new("what would be written does not say for which vehicle it is"));
        }
        let audit = ExclusionAudit::run(&again, &locks, &rules, target)?;
        if let Some(gap) = audit.gaps.first() {
            let (a, b, depth) = (&gap.a, &gap.b, gap.depth);
            let problem = format!("{a} and {b} are not excluded by what would be written ({depth:.3} m deep)");
            return Err(ImportError::new(problem));
        }
        Ok(WrittenLayout { text, again, locks, audit, notes })
    }

    /// The file into which is written, with its edges cut, and its layout.
    fn prepared(
        &self,
        text: &str,
        imported: &ImportedLayout,
        settings: &WriteOptions,
    ) -> Result<(String, ImportedLayout, WriteNotes), ImportError> {
        let mut notes = WriteNotes::default();
        if let Some(most) = settings.split {
            let parts = imported.layout.edges.iter().map(|edge| (edge.length() / most).ceil()).sum::<f64>() as u64;
            MemoryDemand::EdgeParts { longest: most, parts }
                .ask()
                .map_err(|large| ImportError::new(large.to_string()))?;
        }
        if let (ExclusionFormat::Rmf, Some(graph)) = (settings.target, self.options.graph) {
            let text =
                format_args!("lanes of other graphs than {graph} are left as they are, and nothing is said of them");
            notes.warnings.push(WarningCode::OtherGraphs.text(text));
        }
        let cut = match (settings.target, settings.split) {
            (ExclusionFormat::Nav2, Some(most)) => {
                let (text, whole) = nav2::split(text, most)?;
                notes.warnings.extend(whole.into_iter().map(|text| WarningCode::LeftWhole.text(text)));
                text
            }
            (ExclusionFormat::OpenTcs, Some(most)) => {
                opentcs::split(text, imported, most, settings.envelopes.as_deref(), &mut notes)?
            }
            (ExclusionFormat::Rmf, most) => rmf::prepare(text, imported, most, &mut notes)?,
            _ => return Ok((text.to_owned(), imported.clone(), notes)),
        };
        let imported = self.layout(&cut)?;
        Ok((cut, imported, notes))
    }
}

impl WrittenLayout {
    /// What this one, which is not cut, excludes of the lengths of another one, which is \[m²\].
    fn excluded_of(&self, cut: &Self) -> f64 {
        // An edge excludes itself: two parts of one are lengths that it excludes without cutting, too.
        let squares = |done: &Self| done.again.layout.edges.iter().map(|edge| edge.length().powi(2)).sum::<f64>();
        self.audit.excluded + (squares(self) - squares(cut)) / 2.0
    }

    fn report(&self, settings: &WriteOptions, uncut: Option<f64>) -> WriteReport {
        let Self { again, locks, audit, notes, .. } = self;
        let counts = settings.envelopes.is_some() || notes.groups > 0 || notes.at_least.is_some();
        WriteReport {
            layout: locks.layout.clone(),
            vehicle: locks.vehicle.clone(),
            exclusions: settings.target.to_string(),
            edges: again.layout.edges.len(),
            nodes: again.layout.nodes.len(),
            groups: if counts { notes.groups } else { audit.groups },
            at_least: notes.at_least,
            can_touch: audit.can_touch,
            needless: audit.needless.len(),
            excluded: audit.excluded,
            needed: audit.needed,
            uncut,
            warnings: audit.warnings.iter().chain(&notes.warnings).cloned().collect(),
            of_layout: audit.of_layout,
        }
    }
}
