//! `pcr locks`.

use super::exclusion_args::ExclusionArgs;
use super::help::{DRIVING, STANDING};
use super::printed::notes;
use super::scenario_sources::{layout, layout_source};
use super::{
    CONFLICTS, CliError, NO_FOLDER, NO_STREAM, OutputArgs, OutputFormat, UNDECIDED, acknowledge, is_standard,
    warn_of_boxes,
};
use crate::progress::ProgressLine;
use clap::Args;
use pcr_drawing as picture;
use pcr_exclusions::sized;
use pcr_formats::import::{ImportError, ImportOptions, ImportedLayout};
use pcr_formats::output;
use pcr_planning::exclusion_table::{
    EdgeDriving, ExclusionIndex, ExclusionIndexError, ExclusionTable, SweptLayout, SyncProgressFn, UnsafeDelayModel,
    origin, write_index,
};
use pcr_planning::memory_budget::MemoryDemand;
use pcr_planning::report::{self, EdgeExclusionsReport, ExclusionOutputError, UnsafeDelayReport};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const STATUSES: &str = "\
Exit status:
  0  done; with --audit: no two vehicles can touch; with --certify: proved
  1  with --audit: two vehicles can touch; with --certify: refuted
  2  wrong arguments, or a layout that cannot be read or was refused
  3  the output could not be written
  4  with --certify: not decided, as of discs that just touch";

const EXAMPLES: &str = "\
Examples:
  pcr locks depot.geojson --radius 0.4 -o locks      and a page that shows them
  pcr locks map.xml --radius 0.5 --index map.locks   of any size, in a file
  pcr locks map.locks --edge e17                     of an edge, from that file
  pcr locks site.lif.json --vehicle AMR --radius 0.6 --margin 0.1 --format csv
  pcr locks depot.geojson --radius 0.4 --write nav2 -o guarded.geojson
  pcr locks plant.xml --radius 0.5 --audit -o audit  what it does not exclude";

/// Print which edges exclude one another, and on which lengths
#[derive(Args)]
#[command(after_help = format!("{EXAMPLES}\n\n{STATUSES}"))]
pub(super) struct LocksArgs {
    /// The layout; standard input if left out or `-`. With --edge also a file of --index
    layout: Option<PathBuf>,
    #[command(flatten)]
    printed: OutputArgs,
    /// Add the lengths that a vehicle at a node blocks
    #[arg(long)]
    nodes: bool,
    /// Print the start delays with which vehicles touch; at --speed, with --acceleration from rest to rest
    #[arg(long)]
    delays: bool,
    /// With --delays: prove that all other delays are free
    #[arg(long)]
    certify: bool,
    /// JSON Lines, one lock per line, for tables of any size
    #[arg(long, hide_short_help = true)]
    lines: bool,
    /// Only this edge or node; with --audit repeat it for more
    #[arg(long, value_name = "NAME")]
    edge: Vec<String>,
    /// Write the locks to FILE; with --edge, read them from it
    #[arg(long, value_name = "FILE", hide_short_help = true)]
    index: Option<PathBuf>,
    /// Directory for pictures and a page; of --write the file
    #[arg(short, long, value_name = "PATH")]
    output: Option<PathBuf>,
    #[command(flatten)]
    asked: ExclusionArgs,
    #[command(flatten)]
    import: ImportOptions,
}

impl LocksArgs {
    /// Whether the exit status answers what is asked.
    pub(super) fn is_answered_by_status(&self) -> bool {
        self.asked.is_audit() || self.certify
    }

    pub(super) fn run(self) -> Result<ExitCode, CliError> {
        if is_standard(self.output.as_ref()) && !self.asked.is_to_be_written() {
            return Err(CliError::arguments(format!("--output -: {NO_FOLDER}")));
        }
        if is_standard(self.index.as_ref()) {
            return Err(CliError::arguments(format!("--index -: {NO_STREAM}")));
        }
        if let Some(index) = self.index.as_deref().filter(|index| is_stream(index)) {
            let why = "this is written and read at many places, which a pipe or a device is not";
            return Err(CliError::wrong(index, why));
        }
        let file = &layout_source(self.layout.clone())?;
        if let Some(done) = self.asked.run(file, &self.import, &self.printed, self.output.as_ref(), &self.edge) {
            return done;
        }
        match &self.edge[..] {
            [] => {}
            [edge] => return self.of_edge(file, edge),
            _ => {
                return Err(CliError::arguments(
                    "--edge: locks are listed of one edge; with --audit it may be given several times",
                ));
            }
        }
        if self.delays {
            return self.unsafe_delays(file);
        }
        let imported = layout(file, &self.import, STANDING, false)?;
        let progress = ProgressLine::new(format!("{}: pairs of edges", file.display()));
        let told: SyncProgressFn<'_> = &|done, total| progress.set(done, total);
        let wrong = |error: ImportError| CliError::wrong(file, error);
        if let Some(index) = &self.index {
            if self.printed.form() != OutputFormat::Table {
                return Err(CliError::arguments(
                    "--format and --json have no effect with --index: the locks go to a file of its own form",
                ));
            }
            let sweep = SweptLayout::new(&imported, self.nodes).map_err(wrong)?;
            let written = output::stream(index, |out| write_index(&sweep, origin(&imported), out, told));
            let records = written.map_err(|error| match error {
                ExclusionIndexError::Import(error) => wrong(error),
                ExclusionIndexError::Io(error) => CliError::not_written(index, &error),
                damaged @ ExclusionIndexError::Damaged(_) => CliError::wrong(index, damaged),
            })?;
            drop(progress);
            let names = sweep.ids().len();
            writeln!(notes(), "{}: {names} edges and nodes, {records} records of locks", index.display())?;
            return Ok(ExitCode::SUCCESS);
        }
        let mut out = self.out();
        let form = self.printed.form();
        if self.lines || (form == OutputFormat::Csv && self.output.is_none()) {
            let sweep = SweptLayout::new(&imported, self.nodes).map_err(wrong)?;
            let printed = match self.lines {
                true => report::locks_lines(&head(&imported, self.nodes), &sweep, told, &mut out),
                false => report::locks_csv(&sweep, told, &mut out),
            };
            printed.map_err(|unprinted| unprinted_of(file, unprinted))?;
            out.flush()?;
            return Ok(ExitCode::SUCCESS);
        }
        let mut locks = ExclusionTable::watched(&imported, self.nodes, told).map_err(wrong)?;
        acknowledge(&mut locks.warnings);
        drop(progress);
        if let Some(directory) = &self.output {
            let written = picture::write_locks(&imported, &locks, directory);
            warn_of_boxes(directory, &written.map_err(|error| CliError::not_written(directory, &error))?);
        }
        match form {
            OutputFormat::Table => {
                ask_for_rows(locks.locks.len(), "locks")?;
                report::locks_table(&locks, &mut out)?;
            }
            OutputFormat::Json => report::json(&locks, &mut out)?,
            OutputFormat::Csv => report::kept_locks_csv(&locks, &mut out)?,
        }
        out.flush()?;
        Ok(ExitCode::SUCCESS)
    }

    /// Delays of starts instead of lengths.
    fn unsafe_delays(&self, file: &Path) -> Result<ExitCode, CliError> {
        if self.certify && self.printed.form() == OutputFormat::Csv {
            return Err(CliError::arguments("--certify is for --format json and table"));
        }
        let Some(speed) = self.import.speed else {
            return Err(CliError::arguments("--delays are of one speed: say which, --speed"));
        };
        if self.import.acceleration.is_none()
            && let Some(option) = self.import.one_of(&["rotation", "rotation_acceleration"])
        {
            return Err(CliError::arguments(format!(
                "{option} has no effect without --acceleration: the speed is constant then, and lower only where the file says so"
            )));
        }
        let driving = EdgeDriving { speed, acceleration: self.import.acceleration };
        let imported = layout(file, &self.import, DRIVING, driving.acceleration.is_some())?;
        let wrong = |error: ImportError| CliError::wrong(file, error);
        sized(&imported).map_err(wrong)?;
        let progress = ProgressLine::new(format!("{}: pairs of edges", file.display()));
        let told: SyncProgressFn<'_> = &|done, total| progress.set(done, total);
        let delays = UnsafeDelayModel::new(&imported, driving, self.nodes).map_err(wrong)?;
        let head = self::head(&imported, self.nodes);
        let mut out = self.out();
        let mut status = ExitCode::SUCCESS;
        let printed = match self.printed.form() {
            _ if self.lines => report::delays_lines(&head, driving, &delays, told, &mut out),
            OutputFormat::Csv => report::delays_csv(&delays, told, &mut out),
            form => {
                let mut table = UnsafeDelayReport::collect(head, driving, &delays, told).map_err(wrong)?;
                drop(progress);
                if self.certify {
                    let progress = ProgressLine::new(format!("{}: proofs of edges", file.display()));
                    table.certify(&delays, &|done, total| progress.set(done, total)).map_err(wrong)?;
                }
                status = match table.certificate.as_ref().map(|proof| proof.verdict) {
                    None | Some("proved") => ExitCode::SUCCESS,
                    Some("refuted") => ExitCode::from(CONFLICTS),
                    Some(_) => ExitCode::from(UNDECIDED),
                };
                if form == OutputFormat::Json {
                    report::json(&table, &mut out)?;
                } else {
                    ask_for_rows(table.delays.len(), "delays")?;
                    report::delays_table(&table, &mut out)?;
                }
                Ok(())
            }
        };
        printed.map_err(|unprinted| unprinted_of(file, unprinted))?;
        out.flush()?;
        Ok(status)
    }

    /// Where the answer goes. Lines are for programs: they are not what --quiet leaves out.
    fn out(&self) -> Box<dyn Write> {
        if self.lines { Box::new(BufWriter::new(io::stdout().lock())) } else { self.printed.out(false) }
    }

    /// The locks of one edge, of a layout or from a file that has them.
    fn of_edge(&self, file: &Path, edge: &str) -> Result<ExitCode, CliError> {
        let found = |index: &Path, of: Option<u32>| {
            let wrong = |error: ExclusionIndexError| match error {
                ExclusionIndexError::Io(missing) if missing.kind() == ErrorKind::NotFound => CliError::wrong(
                    index,
                    "there is no such table of locks; pcr locks LAYOUT --index, without --edge, writes one",
                ),
                other => CliError::wrong(index, other),
            };
            let mut held = ExclusionIndex::open(index).map_err(wrong)?;
            if of.is_some_and(|of| of != held.origin()) {
                let stale = "it has the locks of another layout or vehicle; without --edge it is written anew";
                return Err(CliError::wrong(index, stale));
            }
            if self.nodes && !held.has_nodes() {
                let problem = "it has no nodes, as it was written without --nodes; without --edge it is written anew";
                return Err(CliError::wrong(index, problem));
            }
            held.partners(edge).map_err(wrong)
        };
        let (partners, head) = if ExclusionIndex::is_one(file) {
            if self.index.is_some() {
                return Err(CliError::arguments("--index beside a table of locks: the layout is expected there"));
            }
            let given = self.import.given().first().copied().or(self.nodes.then_some("--nodes"));
            if let Some(option) = given {
                return Err(CliError::arguments(format!(
                    "{option} has no effect: {} has its locks already",
                    file.display()
                )));
            }
            (found(file, None)?, None)
        } else if let Some(index) = &self.index {
            let imported = layout(file, &self.import, STANDING, false)?;
            (found(index, Some(origin(&imported)))?, Some(head(&imported, self.nodes)))
        } else {
            let imported = layout(file, &self.import, STANDING, false)?;
            let sweep = SweptLayout::new(&imported, self.nodes).map_err(|error| CliError::wrong(file, error))?;
            let partners = sweep.partners(edge).map_err(|error| CliError::wrong(file, error))?;
            (partners, Some(head(&imported, self.nodes)))
        };
        let Some(partners) = partners else {
            return Err(CliError::wrong(file, format!("there is no edge {edge}; pcr nodes lists them")));
        };
        let edge = edge.to_owned();
        let locks = match head {
            Some(ExclusionTable { layout, vehicle, warnings, .. }) => {
                EdgeExclusionsReport { layout: Some(layout), vehicle: Some(vehicle), edge, partners, warnings }
            }
            None => EdgeExclusionsReport { layout: None, vehicle: None, edge, partners, warnings: Vec::new() },
        };
        let mut out = self.printed.out(false);
        match self.printed.form() {
            OutputFormat::Table => report::edge_table(&locks, &mut out)?,
            OutputFormat::Json => report::json(&locks, &mut out)?,
            OutputFormat::Csv => report::edge_csv(&locks, &mut out)?,
        }
        out.flush()?;
        Ok(ExitCode::SUCCESS)
    }
}

/// What stands before the locks of a layout, without the warnings that are acknowledged.
fn head(imported: &ImportedLayout, nodes: bool) -> ExclusionTable {
    let mut head = ExclusionTable::head(imported, nodes);
    acknowledge(&mut head.warnings);
    head
}

/// Whether there is something of this name that is neither a file nor a folder.
fn is_stream(file: &Path) -> bool {
    std::fs::metadata(file).is_ok_and(|there| !there.is_file() && !there.is_dir())
}

/// Asks for what a table for reading takes.
fn ask_for_rows(count: usize, what: &str) -> Result<(), CliError> {
    MemoryDemand::Rows { count, what }.ask().map_err(|large| {
        CliError::arguments(format!("{large}; --lines, --format csv and (of locks) --index print tables of any size"))
    })
}

fn unprinted_of(file: &Path, unprinted: ExclusionOutputError) -> CliError {
    match unprinted {
        ExclusionOutputError::Import(error) => CliError::wrong(file, error),
        ExclusionOutputError::Output(error) => error.into(),
    }
}
