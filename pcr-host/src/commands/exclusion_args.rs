//! The part of `pcr locks` that writes exclusions into layout files, and audits such files.

use super::help::STANDING;
use super::printed::acknowledge_parts;
use super::scenario_sources::{layout_from, text};
use super::{CONFLICTS, CliError, OutputArgs, OutputFormat, is_standard, warn_of_boxes, write_over};
use clap::Args;
use pcr_drawing as picture;
use pcr_exclusions::{ExclusionAudit, ExclusionFormat, Selection, WriteOptions, report, sized};
use pcr_formats::import::{ImportError, ImportOptions, ImportedLayout, InputFormat};
use pcr_formats::input;
use pcr_planning::report::json;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Exclusions, as they stand in files of fleets.
#[derive(Args)]
pub(super) struct ExclusionArgs {
    /// Write the layout with exclusions to --output: nav2, rmf, opentcs, vda5050 or pcr
    #[arg(long, value_enum, value_name = "FORMAT", hide_possible_values = true)]
    write: Option<ExclusionFormat>,
    /// Before writing, cut edges into equal parts of at most this length
    #[arg(long, value_name = "LENGTH", hide_short_help = true, value_parser = length)]
    split: Option<f64>,
    /// Write envelopes with this key, not blocks (openTCS)
    #[arg(long, value_name = "KEY", hide_short_help = true)]
    envelopes: Option<String>,
    /// List where vehicles that obey the exclusions in the layout, or FILE, can still touch (status 1 if any)
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true)]
    audit: Option<Option<PathBuf>>,
    /// With --audit: only this node; repeat it for more
    #[arg(long, value_name = "NAME", hide_short_help = true)]
    node: Vec<String>,
}

fn length(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(length) if length > 0.0 && length <= 1e6 => Ok(length),
        _ => Err("a number above 0, up to 1e6, is expected".into()),
    }
}

impl ExclusionArgs {
    /// Whether the output is a layout, not a folder.
    pub(super) fn is_to_be_written(&self) -> bool {
        self.write.is_some()
    }

    /// Whether the exit status tells what is asked for.
    pub(super) fn is_audit(&self) -> bool {
        self.audit.is_some()
    }

    /// Does what is asked for, if anything is.
    pub(super) fn run(
        &self,
        file: &Path,
        import: &ImportOptions,
        printed: &OutputArgs,
        output: Option<&PathBuf>,
        edges: &[String],
    ) -> Option<Result<ExitCode, CliError>> {
        match (self.write, &self.audit) {
            (Some(target), _) => Some(self.write(target, file, import, printed, output?)),
            (None, Some(beside)) => Some(self.audit(file, beside.as_deref(), import, printed, output, edges)),
            (None, None) => None,
        }
    }

    fn write(
        &self,
        target: ExclusionFormat,
        file: &Path,
        import: &ImportOptions,
        printed: &OutputArgs,
        output: &PathBuf,
    ) -> Result<ExitCode, CliError> {
        if printed.form() == OutputFormat::Csv {
            return Err(CliError::arguments("--write is for --format json and table"));
        }
        let standard = is_standard(Some(output));
        let (format, content) = read(file, import)?;
        let settings = WriteOptions { target, split: self.split, envelopes: self.envelopes.clone() };
        let name = input::stem(file);
        // What is to be said of the layout has been said when it was read.
        let (written, mut report, _) = pcr_exclusions::write(format, &content, import, &name, &settings)
            .map_err(|error| CliError::refused(file, &error))?;
        acknowledge_parts(&mut report.warnings, &mut report.of_layout);
        // A layout may get what keeps its vehicles apart; a table of that is no layout.
        write_over(output, &written, file, || Ok(target.layout() == Some(format)))?;
        let mut out = printed.out(standard);
        match printed.form() {
            OutputFormat::Json => json(&report, &mut out)?,
            _ => report::written_table(&report, &mut out)?,
        }
        out.flush()?;
        Ok(ExitCode::SUCCESS)
    }

    fn audit(
        &self,
        file: &Path,
        beside: Option<&Path>,
        import: &ImportOptions,
        printed: &OutputArgs,
        output: Option<&PathBuf>,
        edges: &[String],
    ) -> Result<ExitCode, CliError> {
        if beside.is_some_and(|beside| beside == file && beside == Path::new("-")) {
            return Err(CliError::arguments("--audit=-: standard input is the layout already"));
        }
        let content = text(file)?;
        let imported: ImportedLayout = layout_from(file, &content, import, STANDING, false)?;
        sized(&imported).map_err(|error| CliError::wrong(file, error))?;
        let selection = Selection::of(&imported, edges, &self.node).map_err(|error| CliError::wrong(file, error))?;
        let (source, content) = match beside {
            Some(beside) => (beside, text(beside)?),
            None => (file, content),
        };
        let target = match beside {
            Some(_) => ExclusionFormat::of_text(&content),
            None => import.from.or_else(|| InputFormat::detect(file, &content)).and_then(ExclusionFormat::of_layout),
        };
        let target = target.ok_or_else(|| unread(source, &content, beside.is_some()))?;
        let wrong = |error: ImportError| CliError::refused(source, &error);
        let rules = pcr_exclusions::read(target, &content, &imported).map_err(wrong)?;
        let locks = pcr_exclusions::table(&imported).map_err(wrong)?;
        let mut audit = ExclusionAudit::of_some(&imported, &locks, &rules, target, &selection).map_err(wrong)?;
        acknowledge_parts(&mut audit.warnings, &mut audit.of_layout);
        if let Some(directory) = output {
            let written = picture::write_audit(&imported, &locks, &rules, &audit, directory);
            warn_of_boxes(directory, &written.map_err(|error| CliError::not_written(directory, &error))?);
        }
        let mut out = printed.out(false);
        match printed.form() {
            OutputFormat::Table => report::audit_table(&audit, &mut out)?,
            OutputFormat::Json => json(&audit, &mut out)?,
            OutputFormat::Csv => report::audit_csv(&audit, &mut out)?,
        }
        out.flush()?;
        Ok(if audit.suffices() { ExitCode::SUCCESS } else { ExitCode::from(CONFLICTS) })
    }
}

/// Why a file, beside a layout or not, cannot be audited.
fn unread(source: &Path, content: &str, is_beside: bool) -> CliError {
    match is_beside {
        true if InputFormat::detect(source, content).and_then(ExclusionFormat::of_layout).is_some() => CliError::wrong(
            source,
            "neither a zone set of VDA 5050 nor a lock file; a layout that holds exclusions itself is audited without another file: --audit",
        ),
        true => CliError::wrong(source, "neither a zone set of VDA 5050 nor a lock file"),
        false => {
            CliError::wrong(source, "files of this format hold no exclusions; name the file that does: --audit=FILE")
        }
    }
}

/// The text of a layout, and its format; everything that is wrong with it, or with the options, is said.
fn read(file: &Path, import: &ImportOptions) -> Result<(InputFormat, String), CliError> {
    let content = text(file)?;
    let Some(format) = import.from.or_else(|| InputFormat::detect(file, &content)) else {
        return Err(CliError::wrong(file, "not a layout in a format that is read"));
    };
    layout_from(file, &content, import, STANDING, false)?;
    Ok((format, content))
}
