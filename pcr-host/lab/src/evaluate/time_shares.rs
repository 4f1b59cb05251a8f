//! Fig. 12: the time to find the pairs that come near each other, and the time to compute their regions.

use super::{DocumentSection, EvaluationError, PaperFleets, Thoroughness, picture};
use pcr_comparing::compare::median;
use pcr_comparing::compare::stopwatch::{Stopwatch, steady};
use pcr_core::{Motion, Scalar as _};
use pcr_drawing::plot::{Chart, DataSeries};
use pcr_planning::figures::{share, time};
use pcr_planning::fleet::{Fleet, build_ecm};
use std::fmt::Write as _;
use std::hint::black_box;

/// A fleet: agents, regions, and times to find pairs and for all \[ms\].
struct TimingSample {
    agents: usize,
    regions: usize,
    finding: f64,
    all: f64,
}

pub(super) fn section(fleets: &PaperFleets, extent: Thoroughness) -> Result<DocumentSection, EvaluationError> {
    let rounds = extent.effort().rounds;
    let mut points = Vec::new();
    for fleet in &fleets.all {
        let parts = Fleet::<f64>::new(&fleet.scenario)?;
        let motions = parts.motions();
        let regions = 2 * pcr_planning::regions::table(&fleet.scenario, &motions)?.len();
        let [finding, all] = [find as fn(&[Motion<'_, f64>]) -> usize, build]
            .map(|work| median((0..rounds).map(|_| timed(|| work(black_box(&motions)))).collect()));
        points.push(TimingSample { agents: motions.len(), regions, finding, all });
    }
    let mut text = String::from(
        "## Fig. 12: finding pairs, making regions\n\nTo compute the table of regions, the library first compares the boxes of all pairs of agents; \
        this time grows with the square of the number of agents. The rest grows with the number of regions. Both directions of a pair count as \
        regions. The table is computed by the same function as in Table VI; the two are measured at different times, so they differ somewhat.\n\n\
        | agents | regions | finding pairs | making regions | share of finding |\n|---:|---:|---:|---:|---:|\n",
    );
    for point in &points {
        let TimingSample { agents, regions, finding, all } = *point;
        let rest = time((all - finding).max(0.0));
        let _ = writeln!(text, "| {agents} | {regions} | {} | {rest} | {} |", time(finding), share(finding / all));
    }
    let _ = write!(text, "\n{}{}", picture("fig12a", "Time by agents"), picture("fig12b", "Time by regions"));
    text.push_str(&picture("fig12c", "Shares by agents"));
    let series = |name: &str, x: fn(&TimingSample) -> f64, y: fn(&TimingSample) -> f64| {
        let mut line: Vec<[f64; 2]> = points.iter().map(|point| [x(point), y(point)]).collect();
        line.sort_by(|a, b| a[0].total_cmp(&b[0]));
        DataSeries { name: name.into(), points: line, line: true }
    };
    // Fleets of as many agents have other regions: no line leads from one to the other.
    let times = |title, axis, x: fn(&TimingSample) -> f64, line: bool| {
        let series = [series("finding pairs", x, |p| p.finding), series("all", x, |p| p.all)];
        let series = series.map(|series| DataSeries { line, ..series }).to_vec();
        Chart { title, axes: [axis, "time [ms]"], series }.draw()
    };
    let agents = |point: &TimingSample| point.agents as f64;
    let shares = [
        series("finding pairs", agents, |p| 100.0 * p.finding / p.all),
        series("regions", agents, |p| 100.0 * (1.0 - p.finding / p.all)),
    ];
    let shares = shares.map(|series| DataSeries { line: false, ..series }).to_vec();
    let shares = Chart { title: "Shares of the time", axes: ["agents", "share [%]"], series: shares };
    let pictures = vec![
        ("fig12a", times("Time by the number of agents", "agents", agents, false)),
        ("fig12b", times("Time by the number of regions", "regions", |point| point.regions as f64, true)),
        ("fig12c", shares.draw()),
    ];
    Ok(DocumentSection { text, pictures })
}

/// \[ms\]
fn timed(work: impl FnMut() -> usize) -> f64 {
    1e3 * steady(Stopwatch::elapsed, work).0
}

/// Pairs whose boxes come within the sum of their radii: what the table does first.
fn find(motions: &[Motion<'_, f64>]) -> usize {
    let mut found = 0;
    for (place, first) in motions.iter().enumerate() {
        for second in &motions[place + 1..] {
            let reach = first.radius() + second.radius() + f64::slack(first.extent().max(second.extent()));
            found += usize::from(first.bounds().expanded(reach).meets(second.bounds()));
        }
    }
    found
}

fn build(motions: &[Motion<'_, f64>]) -> usize {
    build_ecm(motions).map_or(0, |table| table.len())
}
