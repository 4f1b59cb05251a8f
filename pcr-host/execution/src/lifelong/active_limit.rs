//! How many robots of a fleet are active: as many as do most missions. More of them can be in one another's way so much that together
//! they do fewer missions.
//!
//! The number is found by trial runs: first all robots, then fewer and fewer, until even robots that are never in one another's way
//! would do no more. Robots that are not active are not on the layout. Where they would stand on it, missions could not go there, or
//! would have to send them away first.

use super::lifelong_report::{LifelongReport, LifelongRunEntry, TrialRun};
use super::{CoordinationMethod, LifelongOptions, LifelongResult};
use crate::error::ExecutionError;
use pcr_formats::import::ImportedLayout;
use pcr_formats::missions::SiteChanges;

/// Longest trial run \[s\].
const TRIAL: f64 = 900.0;

/// Fewer robots are taken if they do this many times as many missions: the same robots do a few more or fewer with other delays.
const MORE: f64 = 1.03;

/// All numbers up to this one are tried; above it each is about this part of the one before.
const FEW: usize = 12;
const STEP: f64 = 0.8;

impl LifelongReport {
    /// Runs as [`LifelongReport::watched`] with the number of robots that do most missions, at most as many as requested. `told` gets the
    /// simulated time and that of all runs so far \[s\].
    ///
    /// # Errors
    /// Errors of [`super::run`].
    pub fn limited(
        imported: &ImportedLayout,
        request: LifelongOptions,
        changes: &SiteChanges,
        methods: &[CoordinationMethod],
        told: &dyn Fn(f64, f64),
    ) -> Result<Self, ExecutionError> {
        let duration = request.duration.min(TRIAL);
        let mut over = 0.0;
        let mut run = |robots: usize, duration: f64| {
            let request = LifelongOptions { agents: robots, duration, ..request };
            let all = over + duration + request.duration;
            let answer =
                Self::watched(imported, request, changes, &[CoordinationMethod::Orders], &|now| told(over + now, all));
            over += duration;
            answer
        };
        let mut trials: Vec<Trial> = Vec::new();
        let mut robots = Some(request.agents);
        while let Some(number) = robots {
            trials.push(Trial::of(run(number, duration)?));
            // A contact is told, not hidden by fewer robots.
            if trials.last().is_some_and(|trial| !trial.is_safe()) {
                break;
            }
            let best = &trials[best(&trials)];
            let best = if best.is_idle() { 0.0 } else { best.rate() };
            let each = trials.iter().map(Trial::alone_each).fold(0.0, f64::max);
            robots = fewer(number).filter(|&fewer| each * fewer as f64 > MORE * best);
        }
        // In a whole run a fleet may do less than in its trial.
        let mut answer = loop {
            let best = best(&trials);
            if trials[best].answer.hours * 3600.0 >= request.duration || !trials[best].is_safe() {
                break trials[best].answer.clone();
            }
            trials[best] = Trial::of(run(trials[best].robots(), request.duration)?);
        };
        answer.trials = trials.iter().map(Trial::entry).collect();
        if methods != [CoordinationMethod::Orders] || answer.hours * 3600.0 < request.duration {
            let request = LifelongOptions { agents: answer.active, ..request };
            let all = over + methods.len() as f64 * request.duration;
            let whole = Self::watched(imported, request, changes, methods, &|now| told(over + now, all))?;
            (answer.runs, answer.closures, answer.breakdowns) = (whole.runs, whole.closures, whole.breakdowns);
            answer.hours = request.duration / 3600.0;
        }
        answer.asked = request.agents;
        Ok(answer)
    }
}

/// A number of robots, and what they did.
struct Trial {
    answer: LifelongReport,
}

impl Trial {
    fn of(answer: LifelongReport) -> Self {
        Self { answer }
    }

    fn outcome(&self) -> Option<&LifelongResult> {
        self.answer.runs.first().map(|LifelongRunEntry { outcome, .. }| outcome)
    }

    fn robots(&self) -> usize {
        self.answer.active
    }

    fn rate(&self) -> f64 {
        self.outcome().map_or(0.0, |outcome| outcome.missions_per_hour)
    }

    /// Missions an hour of each robot if nobody was in its way.
    fn alone_each(&self) -> f64 {
        self.answer.alone / self.robots().max(1) as f64
    }

    /// Returns whether nobody touched, as proved, and all robots came to their ends.
    fn is_safe(&self) -> bool {
        self.outcome().is_some_and(LifelongResult::is_safe)
    }

    /// Whether it came to a standstill.
    fn is_idle(&self) -> bool {
        self.outcome().is_none_or(|outcome| outcome.idle_because.is_some())
    }

    fn entry(&self) -> TrialRun {
        TrialRun {
            robots: self.robots(),
            hours: self.answer.hours,
            missions_per_hour: self.rate(),
            standstill: self.is_idle(),
        }
    }
}

/// The place of the trial with the most missions, of those that did not come to a standstill if there are any. The trials are in the
/// order of their numbers of robots, the largest one first.
fn best(trials: &[Trial]) -> usize {
    let is_better = |new: &Trial, old: &Trial| match (new.is_safe(), new.is_idle(), old.is_idle()) {
        (false, ..) => true,
        (true, true, false) => false,
        (true, false, true) => true,
        (true, ..) => new.rate() > MORE * old.rate(),
    };
    (0..trials.len())
        .fold(0, |best, next| if next > best && is_better(&trials[next], &trials[best]) { next } else { best })
}

/// The next smaller number of robots to be tried.
fn fewer(robots: usize) -> Option<usize> {
    let mut below = robots.min(FEW + 1).saturating_sub(1);
    if robots > FEW + 1 {
        let mut size = FEW;
        while size < robots {
            below = size;
            size = (size as f64 / STEP) as usize;
        }
    }
    (below > 0).then_some(below)
}
