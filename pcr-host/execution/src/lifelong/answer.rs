//! The answer of `pcr traffic --hours`: runs of one fleet with the same missions and random delays.

use super::{Delays, Method, Outcome, Report, Request, WellFormedness, run};
use pcr_formats::import::Imported;
use serde::Serialize;

/// Runs of a fleet. The JSON output, field for field in this order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Lifelong {
    /// Name of the layout.
    pub layout: String,
    /// Seed of missions and delays.
    pub seed: u64,
    /// Number of robots requested.
    pub asked: usize,
    /// Time for which missions come \[h\].
    pub hours: f64,
    /// Radius of the discs, without their margin \[m\].
    pub radius: f64,
    /// Random delays of the robots.
    pub delays: Delays,
    /// Where robots may stand, and what makes the layout difficult.
    pub well_formedness: WellFormedness,
    /// Missions per hour, after the first tenth of the time, that the robots would do if no robot was in another one's way.
    pub alone: f64,
    /// One run for each method.
    pub runs: Vec<Driven>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
}

/// A run, with its computing times.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Driven {
    /// The results of the run.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Number of decisions: searches for a way and orders.
    pub decisions: usize,
    /// Time within which half of the decisions was made \[s\].
    pub decision_median: f64,
    /// Time within which 99 of 100 decisions were made \[s\].
    pub decision_p99: f64,
    /// Computing time of the simulation \[s\].
    pub computed_in: f64,
}

impl Lifelong {
    /// Runs the same missions with the same delays under some methods.
    ///
    /// # Errors
    /// Errors of [`run`].
    pub fn of(imported: &Imported, request: Request, methods: &[Method]) -> Result<Self, String> {
        Self::watched(imported, request, methods, &|_| {})
    }

    /// Runs as [`Lifelong::of`], and tells from time to time how much of the time of all runs is simulated \[s\].
    ///
    /// # Errors
    /// Errors of [`super::run`].
    pub fn watched(
        imported: &Imported,
        request: Request,
        methods: &[Method],
        told: &dyn Fn(f64),
    ) -> Result<Self, String> {
        let mut well_formedness = WellFormedness::default();
        let (mut runs, mut alone) = (Vec::new(), 0.0);
        for (before, &method) in methods.iter().enumerate() {
            let before = before as f64 * request.duration;
            let report = run::watched(imported, Request { method, ..request }, &|now| told(before + now))?;
            runs.push(Driven::of(&report));
            alone = report.alone;
            well_formedness = report.layout;
        }
        Ok(Self {
            layout: imported.layout.name.clone(),
            seed: request.seed,
            asked: request.agents,
            hours: request.duration / 3600.0,
            radius: imported.vehicle.radius,
            delays: request.delays,
            well_formedness,
            alone,
            runs,
            warnings: imported.layout.warnings.clone(),
        })
    }

    /// Whether every run is certified free of contact, no robot went beyond its hold, no robot waits for ever, and some goal
    /// was reached.
    pub fn is_sound(&self) -> bool {
        self.runs.iter().all(|run| {
            let Outcome { certificate, breaches, stuck, idle_because, .. } = &run.outcome;
            certificate.verdict == "proved" && *breaches == 0 && *stuck == 0 && idle_because.is_none()
        })
    }
}

impl Driven {
    fn of(report: &Report) -> Self {
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
    use pcr_formats::import::{Format, Options, Warnings, roads};
    use std::cell::RefCell;

    #[test]
    fn the_time_that_is_simulated_is_told_over_all_runs() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/real/nav2/sample_graph.geojson");
        let text = std::fs::read_to_string(path).unwrap();
        let options = Options { radius: Some(0.3), ..Options::default() };
        let imported = roads(Format::Nav2, &text, &options, &mut Warnings::default()).unwrap();
        let (delays, method) = (Delays::default(), Method::Orders);
        let request = Request { agents: 2, duration: 60.0, delays, seed: 1, method };
        let told = RefCell::new(Vec::new());
        let methods = [Method::Orders, Method::EdgeLocks];
        let watched = Lifelong::watched(&imported, request, &methods, &|now| told.borrow_mut().push(now)).unwrap();
        let told = told.into_inner();
        assert!(told.is_sorted() && told.len() >= 2 * methods.len(), "{told:?}");
        assert_eq!((told.last(), watched.runs.len()), (Some(&120.0), 2));
    }
}
