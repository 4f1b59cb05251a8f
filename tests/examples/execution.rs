//! Carries out the plans on grids in a directory while robots are late: `execution DIRECTORY [RATE [RADIUS ...]]`.
//!
//! Each plan `NAME.path` is carried out by passing orders, with discs of each radius, and by cells, under the same stops: those of
//! `NAME_sit_0.json`, if that is there, and random ones.

use pcr_formats::import::GridPlan;
use pcr_lab::grid_plans::{ExecutionMethod, RandomStops, carried_out, random_stops, situation};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let directory = arguments.next().ok_or("execution DIRECTORY [RATE [RADIUS ...]]")?;
    let rate: f64 = arguments.next().map_or(Ok(0.01), |rate| rate.parse())?;
    let mut radii = arguments.map(|radius| radius.parse()).collect::<Result<Vec<f64>, _>>()?;
    if radii.is_empty() {
        radii = vec![0.35, 0.45];
    }
    let mut files: Vec<_> = std::fs::read_dir(directory)?.collect::<Result<Vec<_>, _>>()?;
    files.sort_by_key(|file| file.file_name());
    for file in files.iter().map(|file| file.path()).filter(|path| path.extension().is_some_and(|it| it == "path")) {
        let plan = GridPlan::read(&std::fs::read_to_string(&file)?)?;
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        for (kind, stops) in all_stops(&file, &plan, rate)? {
            let cells = carried_out(&plan, radii[0], ExecutionMethod::Cells, &stops)?;
            for &radius in &radii {
                let orders = carried_out(&plan, radius, ExecutionMethod::Orders, &stops)?;
                let switched = carried_out(&plan, radius, ExecutionMethod::Switching, &stops)?;
                println!(
                    "{name} {kind} radius {radius}: switching {:.2} s, {:.3} of cells; stuck {}; {}; orders in {:.2?}, run {:.2?}",
                    switched.travel,
                    switched.travel / cells.travel,
                    switched.stuck,
                    switched.proof.verdict,
                    switched.times[0],
                    switched.times[1],
                );
                println!(
                    "{name} {kind} radius {radius}: travel {:.2} s, by cells {:.2} s, {:.3}, alone {:.2} s; last {:.1}, {:.1} s; stuck {}, {}; {}, {}; orders in {:.2?}, run {:.2?}, by cells {:.2?}",
                    orders.travel,
                    cells.travel,
                    orders.travel / cells.travel,
                    orders.alone,
                    orders.makespan,
                    cells.makespan,
                    orders.stuck,
                    cells.stuck,
                    orders.proof.verdict,
                    cells.proof.verdict,
                    orders.times[0],
                    orders.times[1],
                    cells.times[1],
                );
            }
        }
    }
    Ok(())
}

fn all_stops(file: &Path, plan: &GridPlan, rate: f64) -> Result<Vec<(&'static str, RandomStops)>, Box<dyn Error>> {
    let robots = plan.cells().len();
    let mut all = vec![("random", random_stops(robots, 2000, rate, 1))];
    let published =
        file.with_file_name(format!("{}_sit_0.json", file.file_stem().unwrap_or_default().to_string_lossy()));
    if published.exists() {
        all.push(("published", situation(&std::fs::read_to_string(published)?, robots)?));
    }
    Ok(all)
}
