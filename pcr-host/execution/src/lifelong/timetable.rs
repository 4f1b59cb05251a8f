//! Expected times of robots along their ways. Forecasts use them, and a large fleet keeps to them between forecasts.
//!
//! A timetable that keeps all orders shows that all robots can finish, however late they really are (`docs/theory/precedence.md`).
//! Its times need not be right; only their order matters.
//!
//! Every way has times of its own, as if no other robot was in the way ([`Route::time`]). A [`Timeline`] adds the waits.

use super::gates::TimedGate;
use super::region_table::RouteRegion;
use super::region_waits::RegionWait;
use super::robot::SHORT;
use super::route::Route;

/// Weight of the arrival at the end of a way, relative to that at a goal.
const TAIL: f64 = 0.1;

/// The expected times of one robot along its way.
#[derive(Clone, Debug, Default)]
pub(super) struct Timeline {
    /// Time of the way at the place of the robot when the timeline was made \[s\].
    start: f64,
    /// Time at which the timeline was made \[s\].
    made: f64,
    /// Waits as (length, sum of the delays so far) \[m, s\], in increasing order: the sum applies beyond the length.
    delays: Vec<(f64, f64)>,
}

impl Timeline {
    /// Without waits.
    pub(super) fn new(start: f64, made: f64) -> Self {
        Self { start, made, delays: Vec::new() }
    }

    /// Arrival at a length of the way, counted from now \[s\]. `time` is the time of the way there:
    /// max(`made` + (`time` - `start`) - `now`, 0) + delays before `length`.
    #[inline]
    pub(super) fn from(&self, time: f64, length: f64, now: f64) -> f64 {
        (time - self.start + self.made - now).max(0.0) + self.late(length)
    }

    /// Time at which the robot, as the first one, opens a gate for the second, counted from now \[s\].
    #[inline]
    pub(super) fn opens(&self, timed: &TimedGate, now: f64) -> f64 {
        // A robot that waits stands up to this much before its gate.
        self.from(timed.opening_time, timed.gate.required_position + 2.0 * SHORT, now)
    }

    /// Arrival at the place with this time of the way, counted from when the timeline was made \[s\]:
    /// max(`time` - `start`, 0) + all delays so far.
    pub(super) fn comes(&self, time: f64) -> f64 {
        (time - self.start).max(0.0) + self.delays.last().map_or(0.0, |delay| delay.1)
    }

    /// Adds a wait at length `at` \[m\], where the time of the way is `comes`. The wait ends at `opens`, counted from when the timeline
    /// was made; half of `lost`, the time that a full stop costs, is added, or half of the wait if that is shorter \[s\].
    pub(super) fn wait(&mut self, at: f64, comes: f64, opens: f64, lost: f64) {
        let so_far = self.delays.last().map_or(0.0, |delay| delay.1);
        let wait = opens - self.comes(comes);
        if wait > 0.0 {
            self.delays.push((at, so_far + wait + 0.5 * lost.min(wait)));
        }
    }

    /// Weighted sum of the times until the robot reaches its goals \[s\]: weight 1 for the last goal, `earlier` for the goals before it,
    /// and `TAIL` for the end of the way.
    pub(super) fn cost(&self, way: &Route, now: f64, earlier: f64) -> f64 {
        let time = |length: f64| self.from(way.time(length), length, now);
        let goals = way.goals.split_last();
        let goals = goals
            .map_or(0.0, |(&last, before)| earlier * before.iter().map(|&goal| time(goal)).sum::<f64>() + time(last));
        goals + TAIL * time(way.length())
    }

    /// Sum of the delays before a length \[s\].
    #[inline]
    fn late(&self, length: f64) -> f64 {
        self.delays.partition_point(|delay| delay.0 < length).checked_sub(1).map_or(0.0, |last| self.delays[last].1)
    }

    /// Sum of the delays up to a length, with a wait at that length \[s\].
    fn late_beyond(&self, length: f64) -> f64 {
        self.delays.partition_point(|delay| delay.0 <= length).checked_sub(1).map_or(0.0, |last| self.delays[last].1)
    }

    /// Departure from a length, where the time of the way is `time`, counted from now; negative if it was before now \[s\].
    fn beyond(&self, time: f64, length: f64, now: f64) -> f64 {
        time - self.start + self.made - now + self.late_beyond(length)
    }

    /// Whether it is anywhere later than another timeline of the same way.
    pub(super) fn is_later(&self, other: &Self) -> bool {
        let later = other.start - self.start + self.made - other.made;
        later > 0.0 || self.delays.iter().any(|&(at, late)| late + later > other.late_beyond(at))
    }
}

/// A timeline for each robot of a fleet. Together they keep all orders.
#[derive(Clone, Debug, Default)]
pub(super) struct Timetable {
    pub(super) lines: Vec<Timeline>,
}

impl Timetable {
    /// The timetable of robots that stand.
    pub(super) fn new(robots: usize) -> Self {
        Self { lines: vec![Timeline::default(); robots] }
    }

    /// Whether the second robot of a region would pass one of its gates too early if the first had the timeline `first`. `way` is the way
    /// of the second; `at` has the places of both \[m\].
    pub(super) fn is_broken(
        &self,
        region: &RouteRegion,
        first: &Timeline,
        now: f64,
        at: [f64; 2],
        way: &Route,
    ) -> bool {
        let Some(ends) = region.ends() else { return false };
        let second = &self.lines[region.second()];
        let is_early = |[at, needs]: [TimedGate; 2]| {
            at.gate.wait_position < way.length()
                && first.opens(&needs, now) > second.beyond(at.arrival_time, at.gate.wait_position, now)
        };
        // Only gates at which the second would still find the first matter.
        let is_met = |wait: RegionWait<'_>| is_early(wait.ends) && wait.gates.iter().any(|timed| is_early([*timed; 2]));
        // `ends` pairs the nearest gate with the last event, so if this is not too early no gate is.
        is_early(ends) && RegionWait::of(region, None, at).is_some_and(is_met)
    }

    /// Replaces the timelines of some robots.
    pub(super) fn change(&mut self, lines: Vec<(usize, Timeline)>) {
        lines.into_iter().for_each(|(robot, line)| self.lines[robot] = line);
    }

    /// Whether the second robot of a region waits at one of its gates.
    pub(super) fn waits_at(&self, region: &RouteRegion) -> bool {
        let second = &self.lines[region.second()];
        region.gates().iter().any(|timed| second.delays.iter().any(|delay| delay.0 == timed.gate.wait_position))
    }
}
