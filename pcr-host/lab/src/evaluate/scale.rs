//! Fleets of up to 100,000 agents.

mod scale_measurement;
mod tiled_layout;

use super::{DocumentSection, EvaluationError, PaperFleets, Thoroughness, picture};
use pcr_comparing::compare::crowd;
use pcr_comparing::compare::median;
use pcr_comparing::compare::stopwatch::Stopwatch;
use pcr_drawing::plot::{Chart, DataSeries};
use pcr_formats::scenario::Scenario;
use pcr_planning::figures::{digits, time};
use pcr_planning::fleet::{Fleet, build_ecm};
use scale_measurement::{ScaleMeasurement, TABLE};
use std::fmt::Write as _;
use tiled_layout::TiledLayout;

pub(super) fn section(fleets: &PaperFleets, extent: Thoroughness) -> Result<DocumentSection, EvaluationError> {
    let copies = TiledLayout::new(fleets.warehouse(tiled_layout::RADIUS)?);
    let copies = copies.map_err(|error| EvaluationError::File(fleets.data.clone(), error.to_string()))?;
    let floor = FleetSeries::run("floor", &|agents, seed| crowd(agents, seed), extent)?;
    let warehouse = FleetSeries::run("warehouse", &|agents, seed| copies.fleet(agents, seed), extent)?;
    let kinds = [floor, warehouse];
    let ([width, depth], [nodes, edges]) = copies.size();
    let words = [
        "Random agents on a floor, as dense as in the paper (12 agents on 7 m by 7 m), with paths of three to six segments that \
        stay on the floor."
            .to_owned(),
        format!(
            "The warehouse graph of nav2 ({nodes} nodes, {edges} edges, {} m by {} m) in copies side by side, with {} agents of {} m radius in each \
            copy. Each agent takes the shortest way from a random node to another one, with rounded corners.",
            digits(width),
            digits(depth),
            tiled_layout::AGENTS,
            tiled_layout::RADIUS
        ),
    ];
    let mut text = String::from(
        "## Scale\n\n`rows` finds the agents that come near with a grid. It processes the fleet agent by agent along a space-filling curve \
        and keeps no results, as a streaming server would. `table` is the table of the library, which compares the boxes of all \
        pairs. For small sizes many different fleets are used, so that the processor has none of them in its caches. Regions \
        count in both directions.\n",
    );
    for (kind, words) in kinds.iter().zip(words) {
        let _ = write!(text, "\n{words}\n\n{}", kind.table());
    }
    text.push_str("\nTime grows with these powers of the agents and of the regions, fitted to the sizes above:\n\n");
    text.push_str(
        "| | rows, agents | rows, regions | all cores, agents | table, agents | time an agent varies by | time a region varies by |\n\
        |---|---:|---:|---:|---:|---:|---:|\n",
    );
    kinds.iter().for_each(|kind| text.push_str(&kind.fitted()));
    let _ = write!(text, "\n{}", exchange(if extent == Thoroughness::Full { TABLE } else { 300 })?);
    let _ =
        write!(text, "\n{}{}", picture("scale-agents", "Time by agents"), picture("scale-regions", "Time by regions"));
    let by_agents = kinds.iter().flat_map(|kind| {
        [
            kind.series("rows", |course| course.agents as f64, |course| Some(course.rows)),
            kind.series("all cores", |course| course.agents as f64, |course| Some(course.all_cores)),
            kind.series("table", |course| course.agents as f64, |course| course.table),
        ]
    });
    let by_regions = kinds.iter().map(|kind| kind.series("rows", |course| course.regions, |course| Some(course.rows)));
    let chart = |axis, series| Chart { title: "All regions of a fleet", axes: [axis, "time [ms]"], series }.draw();
    let pictures = vec![
        ("scale-agents", chart("agents", by_agents.collect())),
        ("scale-regions", chart("regions", by_regions.collect())),
    ];
    Ok(DocumentSection { text, pictures })
}

/// Fleets of a kind, in growing sizes.
struct FleetSeries {
    name: &'static str,
    courses: Vec<ScaleMeasurement>,
    /// Of the process with the largest one \[MB\].
    memory: Option<f64>,
}

impl FleetSeries {
    fn run(
        name: &'static str,
        make: &dyn Fn(usize, u64) -> Scenario,
        extent: Thoroughness,
    ) -> Result<Self, EvaluationError> {
        let sizes: &[usize] = match extent {
            Thoroughness::Full => &[100, 1_000, 10_000, 100_000],
            Thoroughness::Quick => &[100, 300],
        };
        let memory = scale_measurement::memory(make, sizes.last().copied().unwrap_or(0))?;
        let courses = sizes.iter().map(|&agents| ScaleMeasurement::run(make, agents, extent));
        Ok(Self { name, courses: courses.collect::<Result<_, _>>()?, memory })
    }

    fn table(&self) -> String {
        let mut text = String::from(
            "| agents | regions an agent | rows, an agent | rows, a region | all cores, an agent | table, an agent |\n\
            |---:|---:|---:|---:|---:|---:|\n",
        );
        for ScaleMeasurement { agents, regions, rows, all_cores, table } in &self.courses {
            let share = |ms: f64| time(ms / *agents as f64);
            let _ = writeln!(
                text,
                "| {agents} | {} | {} | {} | {} | {} |",
                digits(regions / *agents as f64),
                share(*rows),
                time(rows / regions),
                share(*all_cores),
                table.map_or("–".into(), share)
            );
        }
        if let (Some(memory), Some(largest)) = (self.memory, self.courses.last()) {
            let _ = writeln!(
                text,
                "\nMaking and streaming the fleet of {} takes at most {} MB of memory.",
                largest.agents,
                digits(memory)
            );
        }
        text
    }

    fn series(
        &self,
        what: &str,
        x: fn(&ScaleMeasurement) -> f64,
        y: fn(&ScaleMeasurement) -> Option<f64>,
    ) -> DataSeries {
        let points = self.courses.iter().filter_map(|course| Some([x(course), y(course)?])).collect();
        DataSeries { name: format!("{}, {what}", self.name), points, line: true }
    }

    /// A row of the table of exponents.
    fn fitted(&self) -> String {
        let of = |x: fn(&ScaleMeasurement) -> f64, y: fn(&ScaleMeasurement) -> Option<f64>| {
            exponent(&self.series("", x, y).points)
        };
        let agents = |course: &ScaleMeasurement| course.agents as f64;
        let varies = |each: &dyn Fn(&ScaleMeasurement) -> f64| {
            let each = self.courses.iter().map(each);
            let (least, most) =
                each.fold((f64::INFINITY, 0.0_f64), |(least, most), each| (least.min(each), most.max(each)));
            digits(most / least)
        };
        format!(
            "| {} | {:.2} | {:.2} | {:.2} | {:.2} | {} × | {} × |\n",
            self.name,
            of(agents, |course| Some(course.rows)),
            of(|course| course.regions, |course| Some(course.rows)),
            of(agents, |course| Some(course.all_cores)),
            of(agents, |course| course.table),
            varies(&|course| course.rows / course.agents as f64),
            varies(&|course| course.rows / course.regions)
        )
    }
}

/// One agent of a large fleet gets another path, in the table of all.
fn exchange(agents: usize) -> Result<String, EvaluationError> {
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
            let clock = Stopwatch::start();
            let outcome = table.replace(&mut motions, agent, motion);
            times.push(1e3 * clock.wall());
            outcome.expect("the table of the fleet, which does not grow");
        }
    }
    let longest = times.iter().copied().fold(0.0, f64::max);
    Ok(format!(
        "One of {agents} agents on the floor gets another path, and its regions with all others are computed again in the table \
        of {} regions: {} (median of {}), at most {}.\n",
        2 * table.len(),
        time(median(times.clone())),
        times.len(),
        time(longest)
    ))
}

/// Slope of the best line through the logarithms.
pub(super) fn exponent(points: &[[f64; 2]]) -> f64 {
    let logs: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::ln)).collect();
    let count = logs.len() as f64;
    let mean = |axis: usize| logs.iter().map(|log| log[axis]).sum::<f64>() / count;
    let (x, y) = (mean(0), mean(1));
    let (top, bottom) = logs.iter().fold((0.0, 0.0), |(top, bottom), log| {
        (top + (log[0] - x) * (log[1] - y), bottom + (log[0] - x) * (log[0] - x))
    });
    top / bottom
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
