//! The search behind a speed plan: a forward pass computes the times at every station, a backward pass the motion.

use crate::error::InvalidInput;
use crate::geometry::Interval;
use crate::plan::constraint::Constraint;
use crate::plan::lattice::{LEVELS, LatticeEdge, SLABS, SpeedLattice, parts};
use crate::plan::result::{SpeedPlan, SpeedPlanError};
use crate::plan::search_node::SearchNode;
use crate::plan::time_set::TimeSet;
use crate::profile::{Phase, Profile};
use crate::region::RegionRef;
use crate::scalar::Scalar;
use core::borrow::Borrow;

/// The regions that an agent on a path of this length has to avoid, and the motions to choose from.
pub(super) struct SpeedSearch<'c, S: Scalar, L, I> {
    pub(super) lattice: L,
    pub(super) regions: I,
    pub(super) constraints: &'c [Constraint<S>],
    /// The agent sets off from this time on \[s\].
    pub(super) from: S,
    /// Length of the path \[m\].
    pub(super) length: S,
}

/// The times at which the [`parts`] of a cell are blocked.
type BlockedTimes<S> = [TimeSet<S>; SLABS + 1];

impl<'a, S: Scalar, L: SpeedLattice<S>, I: Iterator<Item = RegionRef<'a, S>> + Clone> SpeedSearch<'_, S, L, I> {
    /// Initializes the stations, with the times at which the agent may set off from the first one.
    pub(super) fn begin(&self, from: S, stations: &mut [SearchNode<S>]) -> Result<(), SpeedPlanError<S>> {
        let cells = self.lattice.cells().map(Some);
        let mut length = S::ZERO;
        for (station, cell) in stations.iter_mut().zip(core::iter::once(None).chain(cells)) {
            length = cell.map_or(length, |cell| self.lattice.end(cell, length));
            station.clear();
            station.length = length;
        }
        if let Some(goal) = stations.last_mut() {
            // Removes the rounding error of the sum of the cells.
            goal.length = self.length;
        }
        let [start, _] = self.lattice.ends();
        let at_rest = start == 0;
        let begin = from;
        let from = begin + self.lattice.stands_at(S::ZERO);
        let before = if at_rest { Interval::new(-S::LIMIT, from) } else { Interval::new(from, from) };
        stands(&self.regions, S::ZERO, before)?;
        let mut blocked = TimeSet::NONE;
        self.cover(&[Interval::new(S::ZERO, S::ZERO)], core::slice::from_mut(&mut blocked));
        // No other agent is there before, and constraints on the time before do not count.
        let until = blocked.iter().find(|window| window.hi > begin).map_or(S::LIMIT, |window| window.lo);
        if until < from {
            return Err(SpeedPlanError::Constrained { length: S::ZERO });
        }
        if let Some(times) = stations.first_mut().and_then(|station| station.reached_mut(start)) {
            times.add(Interval::new(from, if at_rest { until } else { from }));
        }
        Ok(())
    }

    /// Adds the times at which each of some parts of the path, one after the other, is blocked.
    fn cover(&self, parts: &[Interval<S>], blocked: &mut [TimeSet<S>]) {
        let (Some(first), Some(last)) = (parts.first(), parts.last()) else { return };
        let add = |times: &mut TimeSet<S>, window: Interval<S>| {
            // What ended before the agent sets off would only take room.
            if window.hi > self.from {
                times.cover(window);
            }
        };
        let always = Interval::new(-S::LIMIT, S::LIMIT);
        // Few regions are on any of the parts.
        for region in self.near(first.hull(*last)) {
            let length = region.length();
            for (&part, times) in parts.iter().zip(blocked.iter_mut()).filter(|(part, _)| length.meets(**part)) {
                region.blocked(part, always).for_each(|window| add(times, window));
            }
        }
        for (&part, times) in parts.iter().zip(blocked) {
            self.constrained(part).for_each(|window| add(times, window));
        }
    }

    /// The times at which constraints forbid a part of the path.
    fn constrained(&self, part: Interval<S>) -> impl Iterator<Item = Interval<S>> {
        self.constraints.iter().filter(move |it| it.length.meets(part)).map(Constraint::during)
    }

    /// The regions on a part of the path.
    fn near(&self, part: Interval<S>) -> impl Iterator<Item = RegionRef<'a, S>> + use<'a, S, L, I> {
        self.regions.clone().filter(move |region| region.length().meets(part))
    }

    fn blocked(&self, cell: Interval<S>) -> BlockedTimes<S> {
        let mut blocked = [const { TimeSet::NONE }; SLABS + 1];
        self.cover(&parts(cell), &mut blocked);
        blocked
    }

    /// The times at which the agent may leave a station so that it passes the cell after it without contact.
    fn departures(&self, reached: &TimeSet<S>, passes: &[S], blocked: &BlockedTimes<S>) -> TimeSet<S> {
        let mut departures = reached.clone();
        // The end of the cell, the last part, has no borders.
        for ((slab, &enters), &leaves) in blocked.iter().zip(passes).zip(passes.iter().skip(1)) {
            for window in slab.iter() {
                // A window without an end stays unbounded.
                let until = if window.hi >= S::LIMIT { S::LIMIT.double() } else { window.hi - enters };
                departures.remove(Interval::new(window.lo - leaves, until));
            }
        }
        departures
    }

    /// Indices of the speeds that are possible at a station.
    fn levels(&self, is_first: bool, is_last: bool) -> core::ops::Range<usize> {
        let [start, goal] = self.lattice.ends();
        let only = |level: usize| level..level.saturating_add(1);
        match (is_first, is_last) {
            (true, _) => only(start),
            (_, true) => only(goal),
            _ => 0..LEVELS,
        }
    }

    /// Computes the times at which the agent can be at each station with each speed.
    pub(super) fn reach(&self, stations: &mut [SearchNode<S>]) -> Result<(), SpeedPlanError<S>> {
        let (mut rest, mut is_first) = (stations, true);
        for cell in self.lattice.cells() {
            let Some((here, after)) = rest.split_first_mut() else { break };
            let is_last = after.len() <= 1;
            let Some(next) = after.first_mut() else { break };
            let blocked = self.blocked(Interval::new(here.length, next.length));
            for from in self.levels(is_first, false) {
                for to in self.levels(false, is_last) {
                    let (Some(reached), Some(edge)) = (here.reached(from), self.lattice.edge(cell, from, to)) else {
                        continue;
                    };
                    let edge: &LatticeEdge<S> = edge.borrow();
                    let departures = self.departures(reached, &edge.passes, &blocked);
                    let Some(arrivals) = next.reached_mut(to) else { continue };
                    departures
                        .iter()
                        .filter_map(|times| later(times, edge.duration()))
                        .for_each(|times| arrivals.add(times));
                }
            }
            let [.., end] = &blocked;
            if let Some(times) = next.reached.first_mut().filter(|_| self.levels(false, is_last).contains(&0)) {
                stand(times, self.lattice.stands_at(next.length), end);
            }
            if next.reached.iter().all(TimeSet::is_empty) {
                return Err(self.stopped(Interval::new(here.length, next.length)));
            }
            (rest, is_first) = (after, false);
        }
        Ok(())
    }

    /// The error if no motion passes a cell.
    fn stopped(&self, cell: Interval<S>) -> SpeedPlanError<S> {
        let until = |region: &RegionRef<'a, S>| if region.is_open_at_end() { S::LIMIT } else { region.time().hi };
        let later = |a: RegionRef<'a, S>, b: RegionRef<'a, S>| if until(&b) > until(&a) { b } else { a };
        let constrained = self.constrained(cell).map(|window| window.hi).reduce(S::max);
        let most = self.near(cell).reduce(later).filter(|region| constrained.is_none_or(|hi| hi < until(region)));
        match (most, constrained) {
            (Some(region), _) => SpeedPlanError::Beyond { length: cell.lo, other: region.other() },
            (None, Some(_)) => SpeedPlanError::Constrained { length: cell.lo },
            // No agent is the cause: the speeds are too far apart, or the times exceed the format.
            (None, None) => SpeedPlanError::Invalid(InvalidInput::OutOfRange("speed or time")),
        }
    }

    /// The time from which on the goal stays free.
    pub(super) fn free_from(&self) -> Result<S, SpeedPlanError<S>> {
        let place = Interval::new(self.length, self.length);
        let always = Interval::new(-S::LIMIT, S::LIMIT);
        let mut free = -S::LIMIT;
        for region in self.near(place) {
            let until = region.blocked(place, always).map(|window| window.hi).fold(-S::LIMIT, S::max);
            if until >= S::LIMIT {
                return Err(SpeedPlanError::AtGoal(region.other()));
            }
            free = free.max(until);
        }
        let free = self.constrained(place).map(|window| window.hi).fold(free, S::max);
        if free >= S::LIMIT { Err(SpeedPlanError::Constrained { length: self.length }) } else { Ok(free) }
    }

    /// The earliest arrival at the goal, which stays free from the time `free` on.
    pub(super) fn arrive(&self, stations: &[SearchNode<S>], free: S) -> Result<S, SpeedPlanError<S>> {
        let [_, goal] = self.lattice.ends();
        let times = stations.last().and_then(|station| station.reached(goal));
        let arrival = times.into_iter().flat_map(TimeSet::iter).find(|times| times.hi >= free);
        let place = Interval::new(self.length, self.length);
        arrival.map(|times| times.lo.max(free)).ok_or_else(|| self.stopped(place))
    }

    /// Goes back from the goal to the start, and chooses the speed at each station and the time at which the agent
    /// leaves it.
    pub(super) fn trace(&self, arrival: S, stations: &mut [SearchNode<S>]) -> Result<(), SpeedPlanError<S>> {
        let [_, goal] = self.lattice.ends();
        if let Some(last) = stations.last_mut() {
            (last.level, last.leaves) = (goal, arrival);
        }
        let mut rest = stations;
        for place in self.lattice.cells().rev() {
            let Some((next, before)) = rest.split_last_mut() else { break };
            let is_first = before.len() <= 1;
            let Some(here) = before.last_mut() else { break };
            let cell = Interval::new(here.length, next.length);
            let blocked = self.blocked(cell);
            // At rest the agent may have waited since its place became free.
            let waits = next.level == 0;
            let until = next.leaves - if waits { self.lattice.stands_at(next.length) } else { S::ZERO };
            let [.., end] = &blocked;
            let since = end.iter().map(|window| window.hi).filter(|&hi| hi <= next.leaves).fold(-S::LIMIT, S::max);
            let mut best: Option<(S, S, usize)> = None;
            for from in self.levels(is_first, false) {
                let (Some(reached), Some(edge)) = (here.reached(from), self.lattice.edge(place, from, next.level))
                else {
                    continue;
                };
                let edge: &LatticeEdge<S> = edge.borrow();
                for times in self.departures(reached, &edge.passes, &blocked).iter() {
                    let Some(arrivals) = later(times, edge.duration()) else { continue };
                    let at = arrivals.hi.min(until);
                    let possible = arrivals.lo <= at && if waits { since <= at } else { at >= until };
                    // Prefers the shortest wait, then the highest speed.
                    if possible && best.is_none_or(|(best, ..)| at >= best) {
                        best = Some((at, (at - edge.duration()).clamp(times.lo, times.hi), from));
                    }
                }
            }
            let Some((_, leaves, level)) = best else { return Err(self.stopped(cell)) };
            (here.leaves, here.level) = (leaves, level);
            rest = before;
        }
        Ok(())
    }

    /// The motion that was chosen.
    pub(super) fn profile<const N: usize>(
        &self,
        stations: &[SearchNode<S>],
    ) -> Result<SpeedPlan<S, N>, SpeedPlanError<S>> {
        let first = stations.first().map_or(S::ZERO, |station| station.leaves - self.lattice.stands_at(S::ZERO));
        let mut phase = Phase::origin(self.lattice.speed());
        let mut profile = Profile::standing();
        let mut now = first;
        let pairs = stations.iter().zip(stations.iter().skip(1));
        for ((here, next), cell) in pairs.zip(self.lattice.cells()) {
            let wait = here.leaves - now;
            if here.level == 0 && wait > S::ZERO {
                let stand = phase.until(wait, phase.length().hi, S::ZERO, S::ZERO);
                profile.extend(&mut phase, stand)?;
            }
            let edge = self.lattice.edge(cell, here.level, next.level).ok_or(InvalidInput::Disconnected("phase"))?;
            let edge: &LatticeEdge<S> = edge.borrow();
            let mut parts = edge.phases().peekable();
            while let Some((duration, way, speed, acceleration)) = parts.next() {
                let to = if parts.peek().is_some() { phase.length().hi + way } else { next.length };
                let next = phase.until(duration, to, speed, acceleration);
                profile.extend(&mut phase, next)?;
            }
            now = here.leaves.max(now) + edge.duration();
        }
        let stand = phase.until(self.lattice.stands_at(self.length), phase.length().hi, phase.speed()[1], S::ZERO);
        profile.extend(&mut phase, stand)?;
        Ok(SpeedPlan { start: first, profile })
    }
}

/// Refuses a place at which a standing agent is hit at some time of the interval.
pub(super) fn stands<'a, S: Scalar>(
    regions: &(impl Iterator<Item = RegionRef<'a, S>> + Clone),
    length: S,
    during: Interval<S>,
) -> Result<(), SpeedPlanError<S>> {
    let place = Interval::new(length, length);
    let met = regions.clone().find(|region| region.blocked(place, during).next().is_some());
    met.map_or(Ok(()), |region| Err(SpeedPlanError::AtStart(region.other())))
}

/// Shifts an interval of times by a duration, limited to the range of the format.
fn later<S: Scalar>(times: Interval<S>, duration: S) -> Option<Interval<S>> {
    let lo = times.lo + duration;
    (lo <= S::LIMIT).then(|| Interval::new(lo, (times.hi + duration).min(S::LIMIT)))
}

/// The times at which an agent may go on that arrives at these and stands for a duration at least. It may wait until its
/// place is blocked.
fn stand<S: Scalar>(times: &mut TimeSet<S>, least: S, blocked: &TimeSet<S>) {
    let mut arrivals = core::mem::replace(times, TimeSet::NONE);
    if least > S::ZERO {
        for window in blocked.iter() {
            arrivals.remove(Interval::new(window.lo - least, window.hi));
        }
    }
    for arrival in arrivals.iter().filter_map(|arrival| later(arrival, least)) {
        let until = blocked.iter().find(|window| window.hi > arrival.lo).map_or(S::LIMIT, |window| window.lo);
        times.add(Interval::new(arrival.lo, arrival.hi.max(until)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(intervals: &[[f64; 2]]) -> TimeSet<f64> {
        let mut times = TimeSet::NONE;
        intervals.iter().for_each(|&[lo, hi]| times.add(Interval::new(lo, hi)));
        times
    }

    fn stood(arrivals: [f64; 2], least: f64, blocked: &[[f64; 2]]) -> heapless::Vec<[f64; 2], 8> {
        let mut times = set(&[arrivals]);
        stand(&mut times, least, &set(blocked));
        times.iter().map(|interval| [interval.lo, interval.hi]).collect()
    }

    #[test]
    fn nobody_stands_where_it_is_hit_meanwhile() {
        const END: f64 = f64::LIMIT;
        // It stands for 2 s before the block, or after it.
        assert_eq!(stood([0.0, 10.0], 2.0, &[[5.0, 6.0]])[..], [[2.0, 5.0], [8.0, END]]);
        // There is too little time between two blocks.
        assert_eq!(stood([0.0, 10.0], 2.0, &[[5.0, 6.0], [7.5, 9.0]])[..], [[2.0, 5.0], [11.0, END]]);
        // It may go on at once, or wait until the block begins.
        assert_eq!(stood([0.0, 3.0], 0.0, &[[5.0, 6.0]])[..], [[0.0, 5.0]]);
        // There is no time at all.
        assert_eq!(stood([0.0, 3.0], 2.0, &[[0.0, 20.0]])[..], [[0.0; 2]; 0]);
    }
}
