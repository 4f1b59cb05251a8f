//! Executes plans on grids from other planners while robots are late: by passing orders on the geometry of discs, and
//! by cells.

use super::{DocumentSection, EvaluationError, PaperFleets, Thoroughness};
use crate::error::LabError;
use crate::grid_plans::{ExecutionMethod, GridRunResult, RandomStops, carried_out, random_stops, situation};
use pcr_formats::import::GridPlan;
use pcr_planning::figures::digits;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Radii of the discs, in cells.
const RADII: [f64; 2] = [0.35, 0.45];
/// Probability of a stop, each second that a robot is not stopped.
const RATE: f64 = 0.01;
/// No plan takes longer than this, with what is late \[s\].
const LONGEST: u32 = 2000;

pub(super) fn section(fleets: &PaperFleets, extent: Thoroughness) -> Result<DocumentSection, EvaluationError> {
    let mut text = format!(
        "## Plans on grids, carried out\n\nPublished plans for discs of up to half a cell (PBS, `tests/data/real/stpg`) are carried out by robots that drive one \
        cell per second and change their speed at once, as in these plans. Robots are stopped: either as published with the \
        plan (one situation with few late robots), or each with a probability of {} % a second, for 10 to 20 s. *Orders*: \
        robots pass each collision region in the planned order; holds are those of discs of the given radius, in cells. \
        *Cells*: an action dependency graph (Hönig et al. 2019), in which a robot enters a cell when the robot that was there \
        before has reached its next cell. *Alone*: the time with these stops if nobody waited for anybody; no execution can be \
        faster, so where *alone / cells* is above 0.9, nothing can take 0.9 of the time of cells. *Switching*: the order of two robots is reversed if one is late and has not used its right, and if all can \
        still finish and arrive sooner that way. This is checked once a second. Nobody knows how long a stop will last: it is expected to \
        last 15 s, which is the mean. The times are means until robots arrive, with the same stops for all \
        methods. *Faster*: how many times faster than real time, with the time to find the regions and orders, for switching; \
        *contact*: verdict of the independent checker on the recorded motions, for orders, switching and cells. For the other \
        plans of that source: \
        `cargo run --release -p pcr-tests --example execution -- DIRECTORY`.\n\n\
        | plan | robots | stops | radius | alone | cells | orders | switching | alone / cells | orders / cells | switching / cells | stuck | faster | contact |\n|---|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|---|---:|---|\n",
        100.0 * RATE
    );
    let files = plans(&fleets.data.join("real/stpg"))?;
    let count = if extent == Thoroughness::Quick { 1 } else { files.len() };
    for file in &files[..count] {
        let problem = |problem: LabError| EvaluationError::File(file.clone(), problem.to_string());
        let plan = GridPlan::read(&read(file)?).map_err(|error| problem(error.into()))?;
        for (kind, stops) in all_stops(file, &plan)? {
            let cells = carried_out(&plan, RADII[0], ExecutionMethod::Cells, &stops).map_err(problem)?;
            for radius in RADII {
                let orders = carried_out(&plan, radius, ExecutionMethod::Orders, &stops).map_err(problem)?;
                let switching = carried_out(&plan, radius, ExecutionMethod::Switching, &stops).map_err(problem)?;
                let name = file.file_stem().unwrap_or_default().to_string_lossy();
                let of = (name.trim_start_matches("map_"), plan.cells().len(), kind, radius);
                text.push_str(&row(of, [&orders, &switching, &cells]));
            }
        }
    }
    Ok(DocumentSection { text, pictures: Vec::new() })
}

fn row(
    (name, robots, kind, radius): (&str, usize, &str, f64),
    [orders, switching, cells]: [&GridRunResult; 3],
) -> String {
    let taken = switching.times.iter().map(std::time::Duration::as_secs_f64).sum::<f64>();
    let verdict =
        |outcome: &GridRunResult| if outcome.proof.verdict == "proved" { "none" } else { outcome.proof.verdict };
    let mut row = String::new();
    // Writing to memory does not fail.
    let _ = writeln!(
        row,
        "| {name} | {robots} | {kind} | {radius} | {} s | {} s | {} s | {} s | {:.3} | {:.3} | {:.3} | {}, {}, {} | {} × | {}, {}, {} |",
        digits(orders.alone),
        digits(cells.travel),
        digits(orders.travel),
        digits(switching.travel),
        orders.alone / cells.travel,
        orders.travel / cells.travel,
        switching.travel / cells.travel,
        orders.stuck,
        switching.stuck,
        cells.stuck,
        digits(switching.makespan / taken),
        verdict(orders),
        verdict(switching),
        verdict(cells)
    );
    row
}

fn read(path: &Path) -> Result<String, EvaluationError> {
    fs::read_to_string(path).map_err(|error| EvaluationError::File(path.to_owned(), format!("cannot be read: {error}")))
}

/// The plans in a directory, the smallest first.
fn plans(directory: &Path) -> Result<Vec<PathBuf>, EvaluationError> {
    let failed =
        |error: std::io::Error| EvaluationError::File(directory.to_owned(), format!("cannot be read: {error}"));
    let mut plans = Vec::new();
    for entry in fs::read_dir(directory).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        if entry.path().extension().is_some_and(|it| it == "path") {
            plans.push((entry.metadata().map_err(failed)?.len(), entry.path()));
        }
    }
    plans.sort();
    if plans.is_empty() {
        return Err(EvaluationError::File(directory.to_owned(), "there is no plan in it".into()));
    }
    Ok(plans.into_iter().map(|(_, path)| path).collect())
}

/// The stops that are published with a plan, if there are any, and random ones.
fn all_stops(file: &Path, plan: &GridPlan) -> Result<Vec<(&'static str, RandomStops)>, EvaluationError> {
    let robots = plan.cells().len();
    let published =
        file.with_file_name(format!("{}_sit_0.json", file.file_stem().unwrap_or_default().to_string_lossy()));
    let mut all = Vec::new();
    if published.exists() {
        let stops = situation(&read(&published)?, robots);
        all.push(("published", stops.map_err(|problem| EvaluationError::File(published, problem.to_string()))?));
    }
    all.push(("random", random_stops(robots, LONGEST, RATE, 1)));
    Ok(all)
}
