//! Times at which robots would be at places. Forecasts use it, and a large fleet keeps to it between forecasts.
//!
//! A timetable that keeps all orders shows that all robots can finish, however late they really are (`docs/theory.md`).
//! Its times need not be right, only its order.

use super::book::Region;
use super::gates::Timed;
use super::robot::SHORT;
use super::waits::Wait;
use super::way::Way;

/// What an end counts beside a goal.
const TAIL: f64 = 0.1;

/// When a robot would be where.
#[derive(Clone, Debug, Default)]
pub(super) struct Timeline {
    /// Time of its way at which it is when this is made \[s\].
    start: f64,
    /// When that is \[s\].
    made: f64,
    /// Lengths beyond which it is later, and by how much in all \[m, s\].
    delays: Vec<(f64, f64)>,
}

impl Timeline {
    /// Without waits.
    pub(super) fn new(start: f64, made: f64) -> Self {
        Self { start, made, delays: Vec::new() }
    }

    /// When the robot is at a length of its way, which it would be at at this time of its way, from now \[s\].
    pub(super) fn from(&self, time: f64, length: f64, now: f64) -> f64 {
        (time - self.start + self.made - now).max(0.0) + self.late(length)
    }

    /// When it has opened a gate for another one, from now \[s\].
    pub(super) fn opens(&self, timed: &Timed, now: f64) -> f64 {
        // Where it waits it stands that much before.
        self.from(timed.opens, timed.gate.needs + 2.0 * SHORT, now)
    }

    /// When it comes to where it would be at this time of its way, after all waits so far, from when this was made \[s\].
    pub(super) fn comes(&self, time: f64) -> f64 {
        (time - self.start).max(0.0) + self.delays.last().map_or(0.0, |delay| delay.1)
    }

    /// It waits at a length, to which it comes at this time of its way, until so long after the line was made; it loses so much by a stop
    /// \[m, s\].
    pub(super) fn wait(&mut self, at: f64, comes: f64, opens: f64, lost: f64) {
        let so_far = self.delays.last().map_or(0.0, |delay| delay.1);
        let wait = opens - self.comes(comes);
        if wait > 0.0 {
            self.delays.push((at, so_far + wait + 0.5 * lost.min(wait)));
        }
    }

    /// Sum of the times from now until goals are reached, of which those before the last one count so much, and a little of that until it
    /// stands \[s\].
    pub(super) fn cost(&self, way: &Way, now: f64, earlier: f64) -> f64 {
        let time = |length: f64| self.from(way.time(length), length, now);
        let goals = way.goals.split_last();
        let goals = goals
            .map_or(0.0, |(&last, before)| earlier * before.iter().map(|&goal| time(goal)).sum::<f64>() + time(last));
        goals + TAIL * time(way.length())
    }

    /// By how much it is later at a length \[s\].
    fn late(&self, length: f64) -> f64 {
        self.delays.partition_point(|delay| delay.0 < length).checked_sub(1).map_or(0.0, |last| self.delays[last].1)
    }

    /// The same beyond a length, after the wait there if there is any.
    fn late_beyond(&self, length: f64) -> f64 {
        self.delays.partition_point(|delay| delay.0 <= length).checked_sub(1).map_or(0.0, |last| self.delays[last].1)
    }

    /// When it goes on beyond a length, to which it comes at this time of its way, from now, or before now \[s\].
    fn beyond(&self, time: f64, length: f64, now: f64) -> f64 {
        time - self.start + self.made - now + self.late_beyond(length)
    }

    /// Whether it is later anywhere than another line of the same way.
    pub(super) fn is_later(&self, other: &Self) -> bool {
        let later = other.start - self.start + self.made - other.made;
        later > 0.0 || self.delays.iter().any(|&(at, late)| late + later > other.late_beyond(at))
    }
}

/// A line for each robot of a fleet; they keep all orders.
#[derive(Clone, Debug, Default)]
pub(super) struct Timetable {
    pub(super) lines: Vec<Timeline>,
}

impl Timetable {
    /// Of robots that stand.
    pub(super) fn new(robots: usize) -> Self {
        Self { lines: vec![Timeline::default(); robots] }
    }

    /// Whether the second of a region, which has this way, sets off too early at one of its gates if the first has this line; they are at
    /// these places.
    pub(super) fn is_broken(&self, region: &Region, first: &Timeline, now: f64, at: [f64; 2], way: &Way) -> bool {
        let Some(ends) = region.ends() else { return false };
        let second = &self.lines[region.second()];
        let is_early = |[at, needs]: [Timed; 2]| {
            at.gate.at < way.length() && first.opens(&needs, now) > second.beyond(at.comes, at.gate.at, now)
        };
        // Where the first has left before the second comes no gate matters.
        let is_met = |wait: Wait<'_>| is_early(wait.ends) && wait.gates.iter().any(|timed| is_early([*timed; 2]));
        // If it is not too early at the nearest gate of all, it is not at one that is farther either.
        is_early(ends) && Wait::of(region, None, at).is_some_and(is_met)
    }

    /// Other lines for some robots.
    pub(super) fn change(&mut self, lines: Vec<(usize, Timeline)>) {
        lines.into_iter().for_each(|(robot, line)| self.lines[robot] = line);
    }

    /// Whether the second of a region waits there for the first.
    pub(super) fn waits_at(&self, region: &Region) -> bool {
        let second = &self.lines[region.second()];
        region.gates().iter().any(|timed| second.delays.iter().any(|delay| delay.0 == timed.gate.at))
    }
}
