//! Finds a way and orders for a mission: tries some routes and ends with orders by forecast, repairs orders if a robot
//! would wait for ever, and takes the result with which all robots arrive soonest.

use super::Method;
use super::book::Region;
use super::forecast::{Forecast, MOST, Trial};
use super::scene::{Scene, TOLLS};
use super::search::Case;
use super::site::From;
use super::timetable::Timeline;
use super::waits::Waits;
use super::way::{Kept, Way};
use std::cell::Cell;

/// Sides are also taken as if the robot came by so much later, or, if negative, earlier \[s\].
const SHIFTS: [f64; 5] = [-8.0, -20.0, 10.0, -40.0, 25.0];

/// On so many of the best ways.
const SHIFTED: usize = 2;

/// Ends that are tried for each route.
const ENDS: usize = 3;

/// Gates that a decision may go through in all its forecasts, about; and the least and the largest number of forecasts that it may make.
const WORK: usize = 30_000;
const FORECASTS: [usize; 2] = [12, 96];

/// The same where a forecast looks at some robots of many.
const FEW: usize = 2;

/// A way that was admitted.
#[derive(Debug)]
pub(super) struct Admitted {
    pub(super) way: Way,
    /// Atoms of it that are kept from the way before.
    pub(super) kept: usize,
    /// What is cut off from the way before \[m\].
    pub(super) before: f64,
    pub(super) regions: Vec<Region>,
    /// When it sets off \[s\].
    pub(super) departs: f64,
    /// Forecast, for comparison.
    pub(super) cost: f64,
    /// Robots of a large fleet that go by another timetable then.
    pub(super) lines: Vec<(usize, Timeline)>,
}

/// A route, and after how many of its atoms the goals are.
type Route = (Vec<usize>, Vec<usize>);

impl Scene<'_> {
    /// Finds a way for a robot to its goals and on to an end; none if none is admitted now.
    pub(super) fn dispatch(&self, robot: usize, goals: &[usize]) -> Option<Admitted> {
        let kept = self.kept(robot);
        self.admitted(robot, &kept, self.candidates(robot, &kept, goals))
    }

    /// Another way and other orders for a robot that has a mission, with which all are expected to arrive sooner by `gain` \[s\].
    pub(super) fn better(&self, robot: usize, goals: &[usize], gain: f64) -> Option<Admitted> {
        let it = &self.robots[robot];
        let cost = match self.timetable {
            Some(timetable) => timetable.lines[robot].cost(&it.way, self.time, self.earlier()),
            None => self.base().ok()?.cost,
        };
        self.dispatch(robot, goals).filter(|found| found.cost + gain < cost)
    }

    /// Routes to goals and on to an end.
    fn candidates(&self, robot: usize, kept: &Kept, goals: &[usize]) -> Vec<Route> {
        let mut found: Vec<Route> = Vec::new();
        // In a large fleet the quickest way has to do, if there is any: decisions cost what they are about.
        let is_large = self.timetable.is_some();
        let ends = if is_large { 1 } else { ENDS };
        for tolls in TOLLS {
            if is_large && !found.is_empty() {
                break;
            }
            let (mut way, mut marks, mut from) = (Vec::new(), Vec::new(), kept.on);
            for &goal in goals {
                let part = self.onward(robot, from, tolls, |node| node == goal, Some(goal), 1).pop();
                let Some(part) = part else { break };
                let heading = part.iter().rev().find_map(|&last| self.site.atoms[last].headings);
                from = From { node: goal, heading: heading.map(|headings| headings[1]).or(from.heading) };
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
                // More robots than ends: wherever nobody stands.
                onward = self.aside(robot, from, tolls, |_| true, ends);
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

    /// The way and orders with which all are expected to arrive soonest, of those that are admitted.
    pub(super) fn admitted(&self, robot: usize, kept: &Kept, candidates: Vec<Route>) -> Option<Admitted> {
        if self.method == Method::EdgeLocks {
            return self.locked(robot, kept, candidates);
        }
        let it = &self.robots[robot];
        let waits = &Waits::of(self.robots, self.book);
        let [at, stop] = [it.at, it.stop(self.abilities)].map(|length| length - kept.before);
        // The orders of all are sound before, the more so without this robot.
        let Scene { robots, abilities, time, .. } = *self;
        let alone = || {
            let changed = Some((robot, &it.way, it.at, time, &[][..]));
            let earlier = self.earlier();
            Trial { robots, waits, abilities, time, changed, earlier, kept: None }.forecast().map(|found| found.lines)
        };
        let [least, most] = FORECASTS;
        let (alone, taken, budget) = match self.timetable {
            Some(_) => (Vec::new(), self.waiting_for(robot), FEW),
            None => {
                (alone().unwrap_or_default(), Vec::new(), (WORK / waits.len_without(robot).max(1)).clamp(least, most))
            }
        };
        let (base, taken) = (self.timetable.map_or(&alone[..], |timetable| &timetable.lines), &taken[..]);
        let budget = &Cell::new(budget);
        let ways = candidates.into_iter().map(|(route, goals)| {
            let atoms: Vec<usize> = kept.atoms.iter().chain(&route).copied().collect();
            let goals: Vec<usize> = goals.iter().map(|goal| kept.atoms.len() + goal).collect();
            Way::new(self.site, kept.from, &atoms, &goals, self.abilities)
        });
        let mut tried: Vec<(Way, Vec<Region>)> = Vec::new();
        let mut found: Vec<Found> = Vec::new();
        for way in ways {
            let regions = self.book.regions(self.site, self.robots, robot, &way, at);
            let case = Case { scene: self, base, waits, taken, robot, way: &way, at, stop, budget };
            let solved = match self.method {
                Method::RouteLocks => {
                    let alone = || Forecast { cost: way.time(way.length()), ..Forecast::default() };
                    regions.is_empty().then(|| (Vec::new(), self.time, alone()))
                }
                Method::StartDelays => case.delayed(regions.clone()),
                _ => case.ordered(regions.clone(), 0.0).map(|(regions, forecast)| (regions, self.time, forecast)),
            };
            if let Some((regions, departs, forecast)) = solved {
                found.push(Found { place: tried.len(), regions, departs, forecast });
            }
            tried.push((way, regions));
        }
        found.sort_by(|a, b| a.forecast.cost.total_cmp(&b.forecast.cost));
        if self.method == Method::Orders {
            // Earlier or later among the others.
            let mut places: Vec<usize> = found.iter().map(|found| found.place).collect();
            places.extend((0..tried.len()).filter(|place| found.iter().all(|found| found.place != *place)));
            places.truncate(SHIFTED);
            for place in places {
                let (way, regions) = &tried[place];
                let case = Case { scene: self, base, waits, taken, robot, way, at, stop, budget };
                for shift in SHIFTS {
                    if budget.get() == 0 {
                        break;
                    }
                    if let Some((regions, forecast)) = case.ordered(regions.clone(), shift) {
                        found.push(Found { place, regions, departs: self.time, forecast });
                    }
                }
            }
        }
        let best = found.into_iter().min_by(|a, b| a.forecast.cost.total_cmp(&b.forecast.cost))?;
        let Found { place, mut regions, departs, mut forecast } = best;
        let way = tried.swap_remove(place).0;
        if self.method == Method::Orders {
            let case = Case { scene: self, base, waits, taken, robot, way: &way, at, stop, budget };
            (regions, forecast) = case.improved(regions, forecast);
        }
        let Forecast { robots, lines, cost } = forecast;
        let lines = if self.timetable.is_some() { robots.into_iter().zip(lines).collect() } else { Vec::new() };
        Some(Admitted { way, kept: kept.atoms.len(), before: kept.before, regions, departs, cost, lines })
    }
}

impl Scene<'_> {
    /// A robot of a large fleet, and those who wait for it by the timetable: they may be earlier when it has another way.
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

    /// The first way of which all edges can be got one after the other: nobody stands on it for good, its end is on nobody's way, and
    /// all can finish.
    fn locked(&self, robot: usize, kept: &Kept, candidates: Vec<Route>) -> Option<Admitted> {
        for (route, goals) in candidates {
            let atoms: Vec<usize> = kept.atoms.iter().chain(&route).copied().collect();
            let goals: Vec<usize> = goals.iter().map(|goal| kept.atoms.len() + goal).collect();
            let way = Way::new(self.site, kept.from, &atoms, &goals, self.abilities);
            let stands = |other: usize| {
                let end = self.robots[other].way.end();
                other != robot && way.atoms.iter().any(|&atom| self.site.passes(atom, end))
            };
            let mut near = self.site.contacts(self.site.standing(way.end()));
            let is_passed = near.any(|(near, _)| self.book.others_on(near, robot, self.robots).next().is_some());
            let at = self.robots[robot].at - kept.before;
            let is_safe = || self.locks.is_safe(self.site, self.robots, Some((robot, &way, at, kept.atoms.len())));
            if !is_passed && !(0..self.robots.len()).any(stands) && is_safe() {
                let (kept, before, cost) = (kept.atoms.len(), kept.before, way.time(way.length()));
                return Some(Admitted {
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

/// A way with orders, by its place among those that were tried.
struct Found {
    place: usize,
    regions: Vec<Region>,
    departs: f64,
    forecast: Forecast,
}
