//! Random fleets in closed loop: whatever has a plan is carried out without a contact.

use pcr_comparing::compare::crowd;
use pcr_planning::plan::{Plan, Request};
use pcr_planning::simulate::{Controller, Disturbance, FRAME, Run, Settings, Task, run};
use std::fmt;
use std::time::Instant;

/// The disturbances of the tool where nothing else is asked for.
pub const USUAL: Disturbance = Disturbance { noise: 0.015, slip: 0.05, delay: 1.0, drift: 0.005 };

/// What became of some fleets.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Fleets without a plan, with which nothing was done.
    pub unplanned: usize,
    /// Fleets of which all robots have arrived without a contact.
    pub carried_out: usize,
    /// Fleets of which it is said of each robot that has not arrived why it never set off; all others have arrived, without a contact.
    pub told: usize,
    /// All other ones.
    pub failed: usize,
    /// Contacts of discs.
    pub contacts: usize,
    /// Robots that had to brake harder than they can.
    pub breaches: usize,
    /// Longest time of planning \[ms\].
    pub planning: Vec<f64>,
    /// Simulated time over that of the machine, of each fleet.
    pub speeds: Vec<f64>,
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { unplanned, carried_out, told, failed, contacts, breaches, planning, speeds } = self;
        let sorted = |values: &[f64]| {
            let mut values = values.to_vec();
            values.sort_by(f64::total_cmp);
            values
        };
        let (planning, speeds) = (sorted(planning), sorted(speeds));
        let at = |values: &[f64], part: f64| values.get((values.len() as f64 * part) as usize).copied().unwrap_or(0.0);
        write!(
            f,
            "{carried_out} fleets carried out, {told} as far as their margins allow, {failed} not ({unplanned} more without a plan); {contacts} contacts, \
             {breaches} breaches; longest planning of a run: median {:.1} ms, 99 of 100 within {:.1} ms, at most {:.1} ms; faster than time by {:.0} at \
             least, {:.0} in the median",
            at(&planning, 0.5),
            at(&planning, 0.99),
            planning.last().copied().unwrap_or(0.0),
            speeds.first().copied().unwrap_or(0.0),
            at(&speeds, 0.5)
        )
    }
}

/// Carries out the fleet of a seed, if it has a plan; what went wrong, if something did.
pub fn fleet(seed: u64, largest: usize, tally: &mut Tally) -> Option<String> {
    let agents = 2 + seed as usize % (largest - 1);
    let scenario = crowd(agents, seed);
    let planned = Plan::of(&scenario, &Request::default()).is_ok_and(|(_, solved)| solved.is_some());
    if !planned {
        tally.unplanned += 1;
        return None;
    }
    let task = Task::of(&scenario).expect("a fleet with a plan");
    let begin = Instant::now();
    let settings = Settings { seed, replan: 2.0, disturbance: USUAL };
    let outcome = run(&task, Controller::Pcr, settings).expect("a fleet with a plan");
    let taken = begin.elapsed().as_secs_f64();
    let Run { done, not_done, collisions, planning, duration, waiting_for, .. } = &outcome.run;
    let planning = planning.expect("a supervisor plans");
    tally.contacts += collisions.len();
    tally.breaches += planning.breaches;
    tally.planning.push(planning.longest_ms);
    tally.speeds.push(duration.max(FRAME) / taken);
    if *not_done == 0 && collisions.is_empty() && planning.breaches == 0 {
        tally.carried_out += 1;
        return None;
    }
    let is_told = *not_done == waiting_for.len() && collisions.is_empty() && planning.breaches == 0;
    *if is_told { &mut tally.told } else { &mut tally.failed } += 1;
    Some(format!(
        "{}, seed {seed}, {agents} robots: {done} done, {not_done} not, {} contacts, {} breaches, planned {} times, {} kept, {duration:.0} s in {taken:.2} s",
        if is_told { "told" } else { "failed" },
        collisions.len(),
        planning.breaches,
        planning.count,
        planning.kept
    ))
}
