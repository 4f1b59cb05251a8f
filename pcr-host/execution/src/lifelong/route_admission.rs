//! Finds a way and orders for a mission: tries some routes and ends with orders by forecast, repairs orders if a robot
//! would wait for ever, and takes the result with which all robots arrive soonest.

use super::CoordinationMethod;
use super::forecast::{Forecast, ForecastInput, MOST};
use super::planning_context::{PlanningContext, TOLLS};
use super::precedence_search::PrecedenceSearch;
use super::region_table::RouteRegion;
use super::region_waits::FleetWaits;
use super::route::{CommittedRoute, Route};
use super::route_graph::DeparturePose;
use super::timetable::Timeline;
use std::cell::Cell;

/// Orders are also searched as if the robot came later by these times \[s\]; negative: earlier.
const SHIFTS: [f64; 5] = [-8.0, -20.0, 10.0, -40.0, 25.0];

/// Number of the best ways for which this is done.
const SHIFTED: usize = 2;

/// Number of ends that are tried for each route.
const ENDS: usize = 3;

/// Number of gates that all forecasts of a decision may visit, roughly; and the least and the largest number of forecasts.
const WORK: usize = 30_000;
const FORECASTS: [usize; 2] = [12, 96];

/// Largest number of forecasts of a decision in a large fleet.
const FEW: usize = 2;

/// A way that was admitted.
#[derive(Debug)]
pub(super) struct AdmittedRoute {
    pub(super) way: Route,
    /// Number of atoms that are kept from the way before.
    pub(super) kept: usize,
    /// Length that is cut off from the way before \[m\].
    pub(super) before: f64,
    pub(super) regions: Vec<RouteRegion>,
    /// Time at which the robot sets off \[s\].
    pub(super) departs: f64,
    /// Cost of the forecast, for comparison.
    pub(super) cost: f64,
    /// New timelines of robots of a large fleet whose times change.
    pub(super) lines: Vec<(usize, Timeline)>,
}

/// Atoms of a route, and for each goal the number of atoms before it.
type RouteElements = (Vec<usize>, Vec<usize>);

impl PlanningContext<'_> {
    /// Finds a way for a robot to its goals and on to an end; `None` if none is admitted now.
    pub(super) fn dispatch(&self, robot: usize, goals: &[usize]) -> Option<AdmittedRoute> {
        let kept = self.kept(robot);
        self.admitted(robot, &kept, self.candidates(robot, &kept, goals))
    }

    /// Another way and other orders for a robot with a mission, if all robots together are expected to arrive sooner by `gain`
    /// \[s\].
    pub(super) fn better(&self, robot: usize, goals: &[usize], gain: f64) -> Option<AdmittedRoute> {
        let it = &self.robots[robot];
        let cost = match self.timetable {
            Some(timetable) => timetable.lines[robot].cost(&it.way, self.time, self.earlier()),
            None => self.base().ok()?.cost,
        };
        self.dispatch(robot, goals).filter(|found| found.cost + gain < cost)
    }

    /// Routes to goals and on to an end.
    fn candidates(&self, robot: usize, kept: &CommittedRoute, goals: &[usize]) -> Vec<RouteElements> {
        let mut found: Vec<RouteElements> = Vec::new();
        // In a large fleet only the quickest way is tried, if there is one, to save time.
        let is_large = self.timetable.is_some();
        let ends = if is_large { 1 } else { ENDS };
        for tolls in TOLLS {
            if is_large && !found.is_empty() {
                break;
            }
            let (mut way, mut marks, mut from) = (Vec::new(), Vec::new(), kept.end_pose);
            for &goal in goals {
                let part = self.onward(robot, from, tolls, |node| node == goal, Some(goal), 1).pop();
                let Some(part) = part else { break };
                let heading = part.iter().rev().find_map(|&last| self.site.atoms[last].headings);
                from = DeparturePose { node: goal, heading: heading.map(|headings| headings[1]).or(from.heading) };
                way.extend(part);
                marks.push(way.len());
            }
            if marks.len() < goals.len() {
                continue;
            }
            let safe = |node: usize| self.is_free(robot, node) && self.ends.is_safe[node];
            let mut onward = Vec::new();
            if !self.crowded {
                onward = self.onward(robot, from, tolls, safe, None, ends);
            }
            if onward.is_empty() {
                // More robots than ends: any place where no robot stands.
                onward = self.aside(robot, from, tolls, |_| true, ends);
            }
            // Where no end can be reached, for example in a dead end, the vehicle stays.
            if onward.is_empty() && self.stays && goals.last().is_some_and(|&goal| self.is_free(robot, goal)) {
                onward.push(Vec::new());
            }
            for end in onward {
                let way: Vec<usize> = way.iter().chain(&end).copied().collect();
                if found.iter().all(|(other, _)| *other != way) {
                    found.push((way, marks.clone()));
                }
            }
        }
        found
    }

    /// The admitted way and orders with which all robots together are expected to arrive soonest.
    pub(super) fn admitted(
        &self,
        robot: usize,
        kept: &CommittedRoute,
        candidates: Vec<RouteElements>,
    ) -> Option<AdmittedRoute> {
        if self.method == CoordinationMethod::EdgeLocks {
            return self.locked(robot, kept, candidates);
        }
        let it = &self.robots[robot];
        let waits = &FleetWaits::of(self.robots, self.book);
        let [at, stop] = [it.at, it.stop()].map(|length| length - kept.before);
        // The orders of all robots were valid before, so they are without this robot.
        let PlanningContext { robots, time, .. } = *self;
        let alone = || {
            let changed = Some((robot, &it.way, it.at, time, &[][..]));
            let earlier = self.earlier();
            ForecastInput { robots, waits, time, changed, earlier, kept: None }.forecast().map(|found| found.lines)
        };
        let [least, most] = FORECASTS;
        let (alone, taken, budget) = match self.timetable {
            Some(_) => (Vec::new(), self.waiting_for(robot), FEW),
            None => (alone().ok()?, Vec::new(), (WORK / waits.len_without(robot).max(1)).clamp(least, most)),
        };
        let (base, taken) = (self.timetable.map_or(&alone[..], |timetable| &timetable.lines), &taken[..]);
        let budget = &Cell::new(budget);
        let ways = candidates.into_iter().map(|(route, goals)| {
            let atoms: Vec<usize> = kept.atoms.iter().chain(&route).copied().collect();
            let goals: Vec<usize> = goals.iter().map(|goal| kept.atoms.len() + goal).collect();
            Route::new(self.site, kept.from, &atoms, &goals, &self.robots[robot].abilities)
        });
        let mut tried: Vec<(Route, Vec<RouteRegion>)> = Vec::new();
        let mut found: Vec<RouteCandidate> = Vec::new();
        for way in ways {
            let regions = self.book.regions(self.site, self.robots, robot, &way, at);
            let case = PrecedenceSearch { scene: self, base, waits, taken, robot, way: &way, at, stop, budget };
            let solved = match self.method {
                CoordinationMethod::RouteLocks => {
                    let alone = || Forecast { cost: way.time(way.length()), ..Forecast::default() };
                    regions.is_empty().then(|| (Vec::new(), self.time, alone()))
                }
                CoordinationMethod::StartDelays => case.delayed(regions.clone()),
                _ => case.ordered(regions.clone(), 0.0).map(|(regions, forecast)| (regions, self.time, forecast)),
            };
            if let Some((regions, departs, forecast)) = solved {
                found.push(RouteCandidate { place: tried.len(), regions, departs, forecast });
            }
            tried.push((way, regions));
        }
        found.sort_by(|a, b| a.forecast.cost.total_cmp(&b.forecast.cost));
        if self.method == CoordinationMethod::Orders {
            // Earlier or later in the sequence of the others.
            let mut places: Vec<usize> = found.iter().map(|found| found.place).collect();
            places.extend((0..tried.len()).filter(|place| found.iter().all(|found| found.place != *place)));
            places.truncate(SHIFTED);
            for place in places {
                let (way, regions) = &tried[place];
                let case = PrecedenceSearch { scene: self, base, waits, taken, robot, way, at, stop, budget };
                for shift in SHIFTS {
                    if budget.get() == 0 {
                        break;
                    }
                    if let Some((regions, forecast)) = case.ordered(regions.clone(), shift) {
                        found.push(RouteCandidate { place, regions, departs: self.time, forecast });
                    }
                }
            }
        }
        let best = found.into_iter().min_by(|a, b| a.forecast.cost.total_cmp(&b.forecast.cost))?;
        let RouteCandidate { place, mut regions, departs, mut forecast } = best;
        let way = tried.swap_remove(place).0;
        if self.method == CoordinationMethod::Orders {
            let case = PrecedenceSearch { scene: self, base, waits, taken, robot, way: &way, at, stop, budget };
            (regions, forecast) = case.improved(regions, forecast);
        }
        let Forecast { robots, lines, cost } = forecast;
        let lines = if self.timetable.is_some() { robots.into_iter().zip(lines).collect() } else { Vec::new() };
        Some(AdmittedRoute { way, kept: kept.atoms.len(), before: kept.before, regions, departs, cost, lines })
    }
}

impl PlanningContext<'_> {
    /// The robot, and the robots that wait for it by the timetable of a large fleet: they may be earlier when it has another
    /// way.
    pub(super) fn waiting_for(&self, robot: usize) -> Vec<usize> {
        let mut found = vec![robot];
        let firsts = self.book.row(robot).filter(|region| region.second() != robot);
        for region in firsts.filter(|region| self.timetable.is_some_and(|timetable| timetable.waits_at(region))) {
            if found.len() < MOST / 2 && !found.contains(&region.second()) {
                found.push(region.second());
            }
        }
        found
    }

    /// The first way whose edges can all be given one after the other: no robot stands on it for good, its end is on no other
    /// way, and all robots can finish.
    fn locked(&self, robot: usize, kept: &CommittedRoute, candidates: Vec<RouteElements>) -> Option<AdmittedRoute> {
        for (route, goals) in candidates {
            let atoms: Vec<usize> = kept.atoms.iter().chain(&route).copied().collect();
            let goals: Vec<usize> = goals.iter().map(|goal| kept.atoms.len() + goal).collect();
            let way = Route::new(self.site, kept.from, &atoms, &goals, &self.robots[robot].abilities);
            let stands = |other: usize| {
                let end = self.robots[other].way.end();
                other != robot && way.atoms.iter().any(|&atom| self.site.passes(atom, end))
            };
            let mut near = self.site.contacts(way.poses[1]);
            let is_passed = near.any(|(near, _)| self.book.others_on(near, robot, self.robots).next().is_some());
            let at = self.robots[robot].at - kept.before;
            let is_safe = || self.locks.is_safe(self.site, self.robots, Some((robot, &way, at, kept.atoms.len())));
            if !is_passed && !(0..self.robots.len()).any(stands) && is_safe() {
                let (kept, before, cost) = (kept.atoms.len(), kept.before, way.time(way.length()));
                return Some(AdmittedRoute {
                    way,
                    kept,
                    before,
                    regions: Vec::new(),
                    departs: self.time,
                    cost,
                    lines: Vec::new(),
                });
            }
        }
        None
    }
}

/// A way with orders, by its index among those that were tried.
struct RouteCandidate {
    place: usize,
    regions: Vec<RouteRegion>,
    departs: f64,
    forecast: Forecast,
}
