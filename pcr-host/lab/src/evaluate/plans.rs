//! The quality of start delays: their cost, the proved bound, and the time to compute them.

use super::{DocumentSection, EvaluationError, PaperFleets, Thoroughness};
use pcr_comparing::compare::crowd;
use pcr_execution::traffic;
use pcr_formats::scenario::Scenario;
use pcr_planning::figures::{digits, time};
use pcr_planning::plan::{PlanOptions, PlanReport};
use std::fmt::Write as _;
use std::time::Instant;

/// Radius of the discs on the warehouse graph \[m\].
const RADIUS: f64 = 0.4;

/// Agents of random fleets, and how many fleets of each number.
const SIZES: [usize; 7] = [2, 5, 10, 20, 50, 100, 193];
const SEEDS: u64 = 20;
/// Agents with missions on the warehouse graph.
const MISSIONS: [usize; 3] = [10, 20, 40];

/// What came of some fleets.
#[derive(Default)]
struct DelayPlanQuality {
    fleets: usize,
    planned: usize,
    left_out: usize,
    proved: usize,
    /// Of the sums of costs.
    costs: f64,
    bounds: f64,
    widest: f64,
    /// \[ms\]
    times: Vec<f64>,
}

impl DelayPlanQuality {
    fn add(&mut self, scenario: &Scenario) -> Result<(), EvaluationError> {
        let request = PlanOptions { leave_out: true, ..PlanOptions::default() };
        let begin = Instant::now();
        let (plan, _) = PlanReport::compute(scenario, &request)?;
        self.times.push(1e3 * begin.elapsed().as_secs_f64());
        self.fleets += 1;
        self.planned += plan.agents.len();
        self.left_out += scenario.agents.len() - plan.agents.len();
        if let Some(costs) = plan.costs {
            self.proved += usize::from(costs.proved);
            self.costs += costs.sum_of_costs;
            self.bounds += costs.lower_bound;
            self.widest = self.widest.max(costs.gap);
        }
        Ok(())
    }

    fn write(mut self, name: &str, text: &mut String) {
        self.times.sort_by(f64::total_cmp);
        let gap = if self.costs > 0.0 { 1.0 - self.bounds / self.costs } else { 0.0 };
        let percent = |part: f64| format!("{:.4} %", 100.0 * part);
        let [middle, longest] = [self.times.len() / 2, self.times.len().saturating_sub(1)]
            .map(|place| self.times.get(place).map_or_else(String::new, |&taken| time(taken)));
        let Self { fleets, planned, left_out, proved, .. } = self;
        let _ = writeln!(
            text,
            "| {name} | {fleets} | {planned} | {left_out} | {} s | {proved} | {} | {} | {middle} | {longest} |",
            digits(self.costs),
            percent(gap),
            percent(self.widest)
        );
    }
}

pub(super) fn section(fleets: &PaperFleets, extent: Thoroughness) -> Result<DocumentSection, EvaluationError> {
    let mut text = format!(
        "## Plans and their bounds\n\nStart delays with the least sum of costs (`pcr plan --leave-out`). *Left out*: the fewest agents without which the \
        others have a plan. *Proved*: number of fleets whose delays are proved to be the best, except for rounding. *Gap*: by \
        how much the sums of costs are above their lower bounds, for all fleets together, and the largest of a fleet. *In*: \
        time of the whole command without reading the file, from the regions to the certificate, the median and the longest. \
        There are {SEEDS} random fleets of each size, as dense as the paper\'s; missions are those of the warehouse above, seed \
        1, before any delay.\n\n\
        | fleets | number | planned | left out | sum of costs | proved | gap | largest gap | in | at most |\n\
        |---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    let (sizes, seeds, missions): (&[usize], _, &[usize]) = match extent {
        Thoroughness::Full => (&SIZES, SEEDS, &MISSIONS),
        Thoroughness::Quick => (&SIZES[..3], 2, &MISSIONS[..1]),
    };
    for fleet in &fleets.all {
        let mut row = DelayPlanQuality::default();
        row.add(&fleet.scenario)?;
        row.write(&format!("Table VI, {} agents, {} crossings", fleet.size[0], fleet.size[1]), &mut text);
    }
    for &agents in sizes {
        let mut row = DelayPlanQuality::default();
        (0..seeds).try_for_each(|seed| row.add(&crowd(agents, seed)))?;
        row.write(&format!("random, {agents} agents"), &mut text);
    }
    let warehouse = fleets.warehouse(RADIUS)?;
    for &agents in missions {
        let (_, [scenario, _]) = traffic::TrafficReport::plan(&warehouse, traffic::TrafficOptions { agents, seed: 1 })?;
        let mut row = DelayPlanQuality::default();
        row.add(&scenario)?;
        row.write(&format!("missions, {agents} agents"), &mut text);
    }
    Ok(DocumentSection { text, pictures: Vec::new() })
}
