//! Fleets of up to 100,000 agents.

use super::machine::line;
use super::{Extent, Fleets, Problem, Section, picture};
use crate::compare::crowd;
use crate::compare::measure::median;
use crate::compare::stopwatch::Stopwatch;
use crate::fleet::{Fleet, build_ecm};
use crate::picture::plot::{Chart, Series};
use crate::report::figures::{digits, time};
use crate::rows;
use pcr_core::Motion;
use std::fmt::Write as _;
use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The largest fleet of which one table is made, and of which an agent is exchanged.
const TABLE: usize = 10_000;

/// A fleet worked through row by row.
struct Point {
    agents: usize,
    regions: usize,
    /// On one core, on all, and of the table of all pairs \[ms\].
    rows: f64,
    all_cores: f64,
    table: Option<f64>,
    /// Largest so far \[MB\].
    memory: Option<f64>,
}

pub(super) fn section(_: &Fleets, extent: Extent) -> Result<Section, Problem> {
    // Small fleets are repeated until they are as many agents.
    let (sizes, repeated): (&[usize], usize) = match extent {
        Extent::Full => (&[100, 1_000, 10_000, 100_000], 20_000),
        Extent::Quick => (&[100, 300], 300),
    };
    let points =
        sizes.iter().map(|&agents| measure(agents, (repeated / agents).max(1))).collect::<Result<Vec<_>, Problem>>()?;
    let mut text = String::from(
        "## Scale\n\nRandom fleets as dense as the paper's (12 agents on 7 m by 7 m), paths of three to six segments. `rows` finds the agents that \
        come near by a grid, and works through the fleet an agent at a time without keeping anything, as a server would that \
        streams; `table` is the table of the library, which compares the boxes of all pairs. Regions in both directions.\n\n\
        | agents | regions | rows, an agent | all cores, an agent | table, an agent | memory of the process |\n|---:|---:|---:|---:|---:|---:|\n",
    );
    let share = |ms: f64, agents: usize| time(ms / agents as f64);
    for point in &points {
        let Point { agents, regions, rows, all_cores, .. } = *point;
        let table = point.table.map_or("–".into(), |table| share(table, agents));
        let memory = point.memory.map_or("–".into(), |memory| format!("{} MB", digits(memory)));
        let _ = writeln!(
            text,
            "| {agents} | {regions} | {} | {} | {table} | {memory} |",
            share(rows, agents),
            share(all_cores, agents)
        );
    }
    let line_of = |y: fn(&Point) -> Option<f64>, x: fn(&Point) -> f64| -> Vec<[f64; 2]> {
        points.iter().filter_map(|point| Some([x(point), y(point)?])).collect()
    };
    let by_agents = line_of(|point| Some(point.rows), |point| point.agents as f64);
    let by_regions = line_of(|point| Some(point.rows), |point| point.regions as f64);
    let table = line_of(|point| point.table, |point| point.agents as f64);
    let each = points.iter().map(|point| point.rows / point.agents as f64);
    let (least, most) = each.fold((f64::INFINITY, 0.0_f64), |(least, most), each| (least.min(each), most.max(each)));
    let exponents = [&by_agents, &by_regions, &table].map(|line| exponent(line));
    let _ = writeln!(
        text,
        "\nFitted: time grows with the power {:.2} of the agents and {:.2} of the regions by rows, {:.2} of the agents by the table. \
        The time for an agent varies by a factor of {} over all sizes.\n",
        exponents[0],
        exponents[1],
        exponents[2],
        digits(most / least)
    );
    text.push_str(&exchange(if extent == Extent::Full { TABLE } else { 300 })?);
    let _ = write!(text, "\n{}", picture("scale", "Time by agents"));
    let all_cores = line_of(|point| Some(point.all_cores), |point| point.agents as f64);
    let series = |name: &str, points: Vec<[f64; 2]>| Series { name: name.into(), points, line: true };
    let series =
        vec![series("rows", by_agents), series("rows, all cores", all_cores), series("table of all pairs", table)];
    let chart = Chart { title: "All regions of a fleet", axes: ["agents", "time [ms]"], series };
    Ok(Section { text, pictures: vec![("scale", chart.draw())] })
}

/// Time by the wall \[ms\].
fn milliseconds(work: impl FnOnce()) -> f64 {
    let clock = Stopwatch::start();
    work();
    1e3 * clock.wall()
}

/// Time of one core \[ms\], over so many repetitions.
fn on_one_core(repetitions: usize, mut work: impl FnMut()) -> f64 {
    let clock = Stopwatch::start();
    (0..repetitions).for_each(|_| work());
    1e3 * clock.elapsed() / repetitions as f64
}

fn measure(agents: usize, rounds: usize) -> Result<Point, Problem> {
    reset_peak();
    let fleet = Fleet::<f64>::new(&crowd(agents, 1))?;
    let motions = fleet.motions();
    let regions = AtomicUsize::new(0);
    rows::each(&motions, |_, row| {
        regions.fetch_add(2 * row.table().len(), Ordering::Relaxed);
    })?;
    let memory = peak();
    let mut failed = None;
    let rows = on_one_core(rounds, || failed = one_by_one(&motions).err().or(failed));
    let all_cores =
        (0..rounds).map(|_| milliseconds(|| failed = rows::each(&motions, |_, row| drop(row)).err().or(failed)));
    let all_cores = median(all_cores.collect());
    let table = (agents <= TABLE).then(|| on_one_core(rounds, || failed = build_ecm(&motions).err().or(failed)));
    if let Some(full) = failed {
        return Err(full.into());
    }
    let regions = regions.into_inner();
    Ok(Point { agents, regions, rows, all_cores, table, memory })
}

fn one_by_one(motions: &[Motion<'_, f64>]) -> Result<(), pcr_core::Full> {
    let grid = rows::grid(motions);
    let row = |ego: usize| rows::Row::new(motions, ego, &grid.after(ego)).map(drop);
    grid.order().into_iter().try_for_each(|ego| row(ego as usize))
}

/// One agent of a large fleet gets another path, in the table of all.
fn exchange(agents: usize) -> Result<String, Problem> {
    const EXCHANGES: usize = 51;
    let fleets = [1, 2].map(|seed| Fleet::<f64>::new(&crowd(agents, seed)));
    let [first, second] = fleets;
    let (first, second) = (first?, second?);
    let (mut motions, others) = (first.motions(), second.motions());
    let mut table = build_ecm(&motions)?;
    let mut times = Vec::new();
    for k in 0..EXCHANGES {
        let agent = k * agents / EXCHANGES;
        let (before, after) = (motions[agent], others[agent]);
        // There and back: the table does not grow.
        for motion in [after, before] {
            let mut outcome = Ok(());
            times.push(milliseconds(|| outcome = table.replace(&mut motions, agent, motion)));
            outcome?;
        }
    }
    let longest = times.iter().copied().fold(0.0, f64::max);
    Ok(format!(
        "One of {agents} agents gets another path, and its regions with all others are computed anew in the table of {} regions: {} \
        (median of {}), at most {}.\n",
        2 * table.len(),
        time(median(times.clone())),
        times.len(),
        time(longest)
    ))
}

/// Slope of the best line through the logarithms.
fn exponent(points: &[[f64; 2]]) -> f64 {
    let logs: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::ln)).collect();
    let count = logs.len() as f64;
    let mean = |axis: usize| logs.iter().map(|log| log[axis]).sum::<f64>() / count;
    let (x, y) = (mean(0), mean(1));
    let (top, bottom) = logs.iter().fold((0.0, 0.0), |(top, bottom), log| {
        (top + (log[0] - x) * (log[1] - y), bottom + (log[0] - x) * (log[0] - x))
    });
    top / bottom
}

/// From here on the peak counts anew, where the system can do that.
fn reset_peak() {
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// Most memory that the process has had \[MB\].
fn peak() -> Option<f64> {
    let kilobytes: f64 = line("/proc/self/status", "VmHWM")?.split(' ').next()?.parse().ok()?;
    Some(kilobytes / 1e3)
}

#[cfg(test)]
mod tests {
    use super::exponent;

    #[test]
    fn exponents_of_powers_are_found() {
        let points = [1.0, 3.0, 50.0].map(|x: f64| [x, 7.0 * x.powf(1.3)]);
        assert!((exponent(&points) - 1.3).abs() < 1e-12);
    }
}
