//! Results of a run.

use super::Method;
use super::ends::WellFormedness;
use super::record::Certificate;
use serde::Serialize;
use std::time::Duration;

/// How it went.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// How robots were kept apart.
    pub method: Method,
    /// Robots that found a place to start.
    pub robots: usize,
    /// Goals reached.
    pub missions: usize,
    /// The same an hour, after the first tenth of the time, without those that were under way at its end.
    pub missions_per_hour: f64,
    /// Mean of the times from when missions were given until goals were reached, over those of a robot alone; none without any.
    pub travel_over_unimpeded: Option<f64>,
    /// What the independent checker has found.
    pub certificate: Certificate,
    /// Controls at which a robot was beyond what its orders allow.
    pub breaches: usize,
    /// Robots that do not come to the end of their way after the last mission, as nobody moves any more: deadlocks.
    pub stuck: usize,
    /// Longest time for which nobody moved \[s\].
    pub standstill: f64,
    /// Tries for a mission that were refused; they are repeated.
    pub refused: usize,
    /// Robots that were asked to go elsewhere, as they stood in the way.
    pub moved: usize,
    /// Ways and orders that were exchanged for better ones.
    pub revised: usize,
    /// Longest time from when a mission was given until it was admitted \[s\].
    pub longest_wait: f64,
    /// The same of those that still wait in the end \[s\].
    pub waiting: f64,
    /// How many do so for longer than ten minutes.
    pub starved: usize,
    /// Why nobody reached a goal, where nobody did, or nobody did any more in the last ten minutes although missions waited.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub idle_because: Option<String>,
    /// Where the time of the robots went, while missions came.
    pub time: Shares,
}

/// Parts of the time of all robots, which add up to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Shares {
    /// On the way to a goal.
    pub driving: f64,
    /// Turning in place.
    pub turning: f64,
    /// Stopped for no reason.
    pub stopped: f64,
    /// Standing on the way, as others go first.
    pub held: f64,
    /// On the way from a goal to an end, without a way for the next mission.
    pub aside: f64,
    /// Standing without a way for the next mission.
    pub idle: f64,
}

impl Shares {
    /// Makes parts of sums.
    pub(super) fn norm(&mut self) {
        let Self { driving, turning, stopped, held, aside, idle } = self;
        let parts = [driving, turning, stopped, held, aside, idle];
        let all: f64 = parts.iter().map(|part| **part).sum();
        parts.into_iter().for_each(|part| *part /= all.max(1.0));
    }
}

/// A run with what was measured on the machine.
#[derive(Clone, Debug)]
pub struct Report {
    /// What is the same on every machine.
    pub outcome: Outcome,
    /// Of the layout.
    pub layout: WellFormedness,
    /// Missions an hour, after the first tenth of the time, if nobody was in anybody's way; 0 where robots
    /// share their tasks.
    pub alone: f64,
    /// Time of each decision.
    pub decisions: Vec<Duration>,
    /// Time of all but the certificate.
    pub time: Duration,
    /// When the last goal was reached \[s\].
    pub last_arrival: f64,
}

impl Report {
    /// Time within which this part of the decisions was made \[s\].
    pub fn decided_within(&self, part: f64) -> f64 {
        let mut times = self.decisions.clone();
        times.sort_unstable();
        let place = (times.len() as f64 * part).ceil() as usize;
        times.get(place.saturating_sub(1)).map_or(0.0, Duration::as_secs_f64)
    }
}
