//! The answer of `pcr traffic --hours`: runs of one fleet with the same missions and random delays.

use super::{Delays, Method, Outcome, Report, Request, WellFormedness, run};
use pcr_formats::import::Imported;
use serde::Serialize;

/// Runs of a fleet. The JSON output, field for field in this order.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Lifelong {
    /// Name of the layout.
    pub layout: String,
    /// From which missions and delays follow.
    pub seed: u64,
    /// Robots asked for.
    pub asked: usize,
    /// For how long missions come \[h\].
    pub hours: f64,
    /// Radius of the discs, without their margin \[m\].
    pub radius: f64,
    /// What goes wrong with robots.
    pub delays: Delays,
    /// Where robots may stand, and what is hard about the layout.
    pub well_formedness: WellFormedness,
    /// Missions an hour, after the first tenth of the time, that the robots would do if nobody was in anybody's way.
    pub alone: f64,
    /// A run for each method.
    pub runs: Vec<Driven>,
    /// What was read otherwise than it was written.
    pub warnings: Vec<String>,
}

/// A run, and what it took on the machine.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Driven {
    /// How it went.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Decisions: ways and orders that were looked for.
    pub decisions: usize,
    /// Time within which half of the decisions was made \[s\].
    pub decision_median: f64,
    /// The same of 99 of 100 \[s\].
    pub decision_p99: f64,
    /// Time of the simulation \[s\].
    pub computed_in: f64,
}

impl Lifelong {
    /// Runs the same missions with the same delays under some methods.
    ///
    /// # Errors
    /// Those of [`run`].
    pub fn of(imported: &Imported, request: Request, methods: &[Method]) -> Result<Self, String> {
        let mut well_formedness = WellFormedness::default();
        let (mut runs, mut alone) = (Vec::new(), 0.0);
        for &method in methods {
            let report = run(imported, Request { method, ..request })?;
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

    /// Whether every run is certified free of contact, everybody kept to what it was allowed, nobody waits for ever, and somebody reached a
    /// goal.
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
