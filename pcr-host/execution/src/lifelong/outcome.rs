//! Results of a run.

use super::CoordinationMethod;
use super::change_results::ChangeResults;
use super::endpoints::WellFormedness;
use super::motion_record::RunCertificate;
use serde::Serialize;
use std::time::Duration;

/// The results of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LifelongResult {
    /// Method that kept robots apart.
    pub method: CoordinationMethod,
    /// Number of robots that found a place to start.
    pub robots: usize,
    /// Number of goals reached.
    pub missions: usize,
    /// Goals reached per hour, after the first tenth of the time, without the missions under way at its end.
    pub missions_per_hour: f64,
    /// Mean time from a mission to its goal, divided by that of a robot alone; `None` without any.
    pub travel_over_unimpeded: Option<f64>,
    /// Result of the independent checker.
    pub certificate: RunCertificate,
    /// Number of control steps at which a robot was beyond its hold.
    #[serde(rename = "breaches")]
    pub authority_overruns: usize,
    /// Number of robots that do not reach the end of their way after the last mission, because no robot moves any more:
    /// deadlocks.
    pub stuck: usize,
    /// Longest time for which no robot moved although one was on its way \[s\].
    pub standstill: f64,
    /// Number of refused attempts for missions; they are repeated.
    pub refused: usize,
    /// Number of times a robot was asked to go elsewhere, because it stood in the way.
    pub moved: usize,
    /// Number of ways and orders that were replaced by better ones.
    pub revised: usize,
    /// The most often that a mission was overtaken while it waited: newer missions that were admitted before it.
    pub overtaken: usize,
    /// Longest time between a mission and its admission \[s\].
    pub longest_wait: f64,
    /// Longest time that a mission has waited at the end of the run \[s\].
    pub waiting: f64,
    /// Number of missions that have waited for longer than ten minutes at the end.
    pub starved: usize,
    /// Reason why no goal was reached, in the run or in its last ten minutes, although missions waited.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub idle_because: Option<String>,
    /// Shares of the time of the robots while missions came.
    pub time: TimeShares,
}

impl LifelongResult {
    /// Whether the run is certified free of contact, no robot went beyond its hold, and every robot came to its end.
    pub(crate) fn is_safe(&self) -> bool {
        self.certificate.verdict == "proved" && self.authority_overruns == 0 && self.stuck == 0
    }
}

/// Shares of the time of all robots; their sum is 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct TimeShares {
    /// On the way to a goal.
    pub driving: f64,
    /// Turning in place.
    pub turning: f64,
    /// Stopped at random.
    pub stopped: f64,
    /// Standing on the way while others go first.
    #[serde(rename = "held")]
    pub waiting: f64,
    /// On the way from a goal to an end, because there is no way for the next mission.
    #[serde(rename = "aside")]
    pub yielding: f64,
    /// Standing without a way for the next mission.
    pub idle: f64,
}

impl TimeShares {
    /// Divides sums by their total.
    pub(super) fn norm(&mut self) {
        let Self { driving, turning, stopped, waiting: held, yielding: aside, idle } = self;
        let parts = [driving, turning, stopped, held, aside, idle];
        let all: f64 = parts.iter().map(|part| **part).sum();
        parts.into_iter().for_each(|part| *part /= all.max(1.0));
    }
}

/// The results of a run, with times measured on the machine.
#[derive(Clone, Debug)]
pub struct MeasuredLifelongRun {
    /// The results that are the same on every machine.
    pub outcome: LifelongResult,
    /// Properties of the layout.
    pub layout: WellFormedness,
    /// Missions per hour, after the first tenth of the time, if no robot was in another one's way; 0 if robots share their
    /// tasks.
    pub alone: f64,
    /// Computing time of each decision.
    pub decisions: Vec<Duration>,
    /// Computing time without the certificate.
    pub time: Duration,
    /// Time at which the last goal was reached \[s\].
    pub last_arrival: f64,
    /// What the changes of the site did.
    pub changes: ChangeResults,
}

impl MeasuredLifelongRun {
    /// Time within which this share of the decisions was made \[s\].
    pub(crate) fn decided_within(&self, part: f64) -> f64 {
        let mut times = self.decisions.clone();
        times.sort_unstable();
        let place = (times.len() as f64 * part).ceil() as usize;
        times.get(place.saturating_sub(1)).map_or(0.0, Duration::as_secs_f64)
    }
}
