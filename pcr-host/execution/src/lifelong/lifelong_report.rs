//! The answer of `pcr traffic --hours`: runs of one fleet with the same missions and random delays.

use super::site_changes::{self, BreakdownEntry, ClosureEntry};
use super::{
    CoordinationMethod, DelayModel, LifelongOptions, LifelongResult, MeasuredLifelongRun, WellFormedness, run,
};
use crate::error::ExecutionError;
use pcr_formats::import::ImportedLayout;
use pcr_formats::missions::SiteChanges;
use serde::Serialize;

/// Runs of a fleet. The JSON output, field for field in this order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LifelongReport {
    /// Name of the layout.
    pub layout: String,
    /// Seed of missions and delays.
    pub seed: u64,
    /// Number of robots requested.
    pub asked: usize,
    /// Number of robots that were active; the others were not on the layout.
    pub active: usize,
    /// Trial runs from which the number of active robots was chosen; empty if it was given.
    pub trials: Vec<TrialRun>,
    /// Time for which missions come \[h\].
    pub hours: f64,
    /// Radius of the discs, without their margin \[m\].
    pub radius: f64,
    /// Random delays of the robots.
    pub delays: DelayModel,
    /// Where robots may stand, and what makes the layout difficult.
    pub well_formedness: WellFormedness,
    /// Missions per hour, after the first tenth of the time, that the robots would do if no robot was in another one's way.
    pub alone: f64,
    /// One run for each method.
    pub runs: Vec<LifelongRunEntry>,
    /// The closures, in the order of the files.
    pub closures: Vec<ClosureEntry>,
    /// The breakdowns, in the order of the files.
    pub breakdowns: Vec<BreakdownEntry>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
}

/// What a number of robots did in a trial run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TrialRun {
    /// Number of robots.
    pub robots: usize,
    /// Time for which missions came \[h\].
    pub hours: f64,
    /// Missions per hour, after the first tenth of the time.
    pub missions_per_hour: f64,
    /// Whether it came to a standstill.
    pub standstill: bool,
}

/// A run, with its computing times.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LifelongRunEntry {
    /// The results of the run.
    #[serde(flatten)]
    pub outcome: LifelongResult,
    /// Number of decisions: searches for a way and orders.
    pub decisions: usize,
    /// Time within which half of the decisions was made \[s\].
    pub decision_median: f64,
    /// Time within which 99 of 100 decisions were made \[s\].
    pub decision_p99: f64,
    /// Computing time of the simulation \[s\].
    pub computed_in: f64,
}

impl LifelongReport {
    /// Runs the same missions with the same delays under some methods.
    ///
    /// # Errors
    /// Errors of [`run`].
    pub fn run(
        imported: &ImportedLayout,
        request: LifelongOptions,
        methods: &[CoordinationMethod],
    ) -> Result<Self, ExecutionError> {
        Self::watched(imported, request, &SiteChanges::default(), methods, &|_| {})
    }

    /// Runs as [`LifelongReport::run`] on a site that changes, and tells from time to time how much of the time of all runs is simulated
    /// \[s\]. The robots have the numbers from 1 on as their names.
    ///
    /// # Errors
    /// Errors of [`super::run`], and changes for other methods than passing orders.
    pub fn watched(
        imported: &ImportedLayout,
        request: LifelongOptions,
        changes: &SiteChanges,
        methods: &[CoordinationMethod],
        told: &dyn Fn(f64),
    ) -> Result<Self, ExecutionError> {
        let mut well_formedness = WellFormedness::default();
        let (mut runs, mut alone) = (Vec::new(), 0.0);
        let (mut closures, mut breakdowns) = (Vec::new(), Vec::new());
        for (before, &method) in methods.iter().enumerate() {
            let before = before as f64 * request.duration;
            let report =
                run::watched(imported, LifelongOptions { method, ..request }, changes, &|now| told(before + now))?;
            let name = |robot: usize| (robot + 1).to_string();
            (closures, breakdowns) = site_changes::entries(&imported.layout, changes, &report.changes, name);
            runs.push(LifelongRunEntry::of(&report));
            alone = report.alone;
            well_formedness = report.layout;
        }
        Ok(Self {
            layout: imported.layout.name.clone(),
            seed: request.seed,
            asked: request.agents,
            active: request.agents,
            trials: Vec::new(),
            hours: request.duration / 3600.0,
            radius: imported.vehicle.radius,
            delays: request.delays,
            well_formedness,
            alone,
            runs,
            closures,
            breakdowns,
            warnings: imported.layout.warnings.clone(),
        })
    }

    /// Whether every run is certified free of contact, no robot went beyond its hold, no robot waits for ever, and some goal
    /// was reached.
    pub fn is_sound(&self) -> bool {
        self.runs.iter().all(|run| run.outcome.is_safe() && run.outcome.idle_because.is_none())
    }
}

impl LifelongRunEntry {
    fn of(report: &MeasuredLifelongRun) -> Self {
        Self {
            outcome: report.outcome.clone(),
            decisions: report.decisions.len(),
            decision_median: report.decided_within(0.5),
            decision_p99: report.decided_within(0.99),
            computed_in: report.time.as_secs_f64(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::import::{ImportOptions, InputFormat, Warnings, roads};
    use std::cell::RefCell;

    #[test]
    fn the_time_that_is_simulated_is_told_over_all_runs() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/real/nav2/sample_graph.geojson");
        let text = std::fs::read_to_string(path).unwrap();
        let options = ImportOptions { radius: Some(0.3), ..ImportOptions::default() };
        let imported = roads(InputFormat::Nav2, &text, &options, &mut Warnings::default()).unwrap();
        let (delays, method) = (DelayModel::default(), CoordinationMethod::Orders);
        let request = LifelongOptions { agents: 2, duration: 60.0, delays, seed: 1, method };
        let told = RefCell::new(Vec::new());
        let methods = [CoordinationMethod::Orders, CoordinationMethod::EdgeLocks];
        let watched = LifelongReport::watched(&imported, request, &SiteChanges::default(), &methods, &|now| {
            told.borrow_mut().push(now)
        })
        .unwrap();
        let told = told.into_inner();
        assert!(told.is_sorted() && told.len() >= 2 * methods.len(), "{told:?}");
        assert_eq!((told.last(), watched.runs.len()), (Some(&120.0), 2));
    }
}
