//! Ways and orders for a mission: some routes and ends are tried, orders by what is forecast, mended where somebody would wait for
//! ever; what lets everybody arrive soonest is taken.

use super::Method;
use super::abilities::Abilities;
use super::book::{Book, Region};
use super::forecast::{Forecast, Stuck, Trial, Waits};
use super::robot::Robot;
use super::routes::{From, routes};
use super::site::Site;
use super::way::{Kept, Way};
use std::cell::Cell;

/// What a route costs more: past a robot that stands for good, and for each robot that comes the other way \[s\].
const TOLLS: [[f64; 2]; 4] = [[f64::INFINITY, 0.0], [f64::INFINITY, 4.0], [f64::INFINITY, 15.0], [20.0, 4.0]];

/// Ends that are tried for each route.
const ENDS: usize = 3;

/// Orders that are turned round in search of better ones, at most, and even if a decision has taken long already.
const TURNS: usize = 16;
const LEAST_TURNS: usize = 4;

/// Gates that a decision may go through in all its forecasts, about; and the least and the largest number of forecasts that it may make.
const WORK: usize = 60_000;
const FORECASTS: [usize; 2] = [12, 96];

/// Orders that are turned round where somebody would wait for ever.
const REPAIRS: usize = 12;

/// A robot with a start delay sets off in steps of \[s\], not later than \[s\].
const DELAYS: (f64, u32) = (2.0, 60);

/// What a decision is about.
#[derive(Clone, Copy)]
pub(super) struct Scene<'s> {
    pub(super) site: &'s Site,
    pub(super) robots: &'s [Robot],
    pub(super) book: &'s Book,
    pub(super) abilities: &'s Abilities,
    /// Nodes where robots may stand for good.
    pub(super) ends: &'s [usize],
    /// How many robots stand for good in the way of an atom.
    pub(super) parked: &'s [u16],
    pub(super) time: f64,
    pub(super) method: Method,
}

/// A way that was admitted.
#[derive(Debug)]
pub(super) struct Admitted {
    pub(super) way: Way,
    /// What is cut off from the way before \[m\].
    pub(super) before: f64,
    pub(super) regions: Vec<Region>,
    /// When it sets off \[s\].
    pub(super) departs: f64,
    /// Forecast, for comparison.
    pub(super) cost: f64,
}

/// Why no way was admitted: who is in the way, if anybody is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Refused {
    pub(super) by: Option<usize>,
}

/// A route, and after how many of its atoms the goal is.
type Route = (Vec<usize>, Option<usize>);

impl Scene<'_> {
    /// Finds a way for a robot to a node and on to an end.
    ///
    /// # Errors
    /// Who is in the way.
    pub(super) fn dispatch(&self, robot: usize, goal: usize) -> Result<Admitted, Refused> {
        let kept = self.kept(robot);
        self.admitted(robot, &kept, self.candidates(robot, &kept, goal))
    }

    /// Finds a way for a robot that stands in the way of another one's mission, to where it does not.
    pub(super) fn make_way(&self, robot: usize, other: usize, goal: usize) -> Option<Admitted> {
        /// Nearest places that are tried.
        const PLACES: usize = 6;
        let from = self.kept(other);
        let route = self.routes(other, &from, [20.0, 0.0], |node| node == goal, Some(goal), 1).pop()?;
        let kept = self.kept(robot);
        let here = self.robots[robot].way.end();
        let clear = |node: usize| {
            node != here
                && self.is_free(robot, node)
                && !self.site.collide(node, goal)
                && !route.iter().any(|&atom| self.site.passes(atom, node))
        };
        let ends = self.routes(robot, &kept, TOLLS[0], |node| clear(node) && self.ends.contains(&node), None, PLACES);
        let any = || self.routes(robot, &kept, TOLLS[0], clear, None, PLACES);
        let found = if ends.is_empty() { any() } else { ends };
        self.admitted(robot, &kept, found.into_iter().map(|route| (route, None)).collect()).ok()
    }

    /// Another way and other orders for a robot that has a mission, with which all are expected to arrive sooner by `gain` \[s\].
    pub(super) fn better(&self, robot: usize, goal: usize, gain: f64) -> Option<Admitted> {
        let cost = self.base().ok()?.cost;
        self.dispatch(robot, goal).ok().filter(|found| found.cost + gain < cost)
    }

    /// When all are where with the ways and orders that they have.
    fn base(&self) -> Result<Forecast, Vec<Stuck>> {
        let Scene { robots, abilities, time, .. } = *self;
        let waits = &Waits::of(robots, self.book, None);
        Trial { robots, waits, abilities, time, changed: None }.forecast()
    }

    fn kept(&self, robot: usize) -> Kept {
        let it = &self.robots[robot];
        it.way.kept(self.site, it.at, it.stop(self.abilities))
    }

    /// Whether nobody else stands for good where a robot would stand at a node.
    fn is_free(&self, robot: usize, node: usize) -> bool {
        let own = self.site.collide(self.robots[robot].way.end(), node);
        let count = usize::from(self.parked[self.site.standing(node)]);
        count <= usize::from(own)
    }

    /// Routes on from where a robot can leave its way.
    fn routes(
        &self,
        robot: usize,
        kept: &Kept,
        [standing, coming]: [f64; 2],
        asked: impl Fn(usize) -> bool,
        towards: Option<usize>,
        count: usize,
    ) -> Vec<Vec<usize>> {
        let heading = kept.atoms.last().and_then(|&last| self.site.atoms[last].headings).map(|headings| headings[1]);
        self.onward(robot, From { node: kept.node, heading }, [standing, coming], asked, towards, count)
    }

    fn onward(
        &self,
        robot: usize,
        from: From,
        [standing, coming]: [f64; 2],
        asked: impl Fn(usize) -> bool,
        towards: Option<usize>,
        count: usize,
    ) -> Vec<Vec<usize>> {
        let end = self.robots[robot].way.end();
        let toll = |atom: usize| {
            let own = u16::from(self.site.covers(end).contains(&atom));
            let parked = self.parked[atom].saturating_sub(own);
            let mut toll = if parked > 0 { standing * f64::from(parked) } else { 0.0 };
            if coming > 0.0
                && let Some(back) = self.site.back[atom]
            {
                toll += coming * self.book.others_on(back, robot, self.robots).count() as f64;
            }
            toll
        };
        routes((self.site, self.abilities), from, toll, asked, towards, count)
    }

    /// Routes to a goal and on to an end.
    fn candidates(&self, robot: usize, kept: &Kept, goal: usize) -> Vec<Route> {
        let mut found: Vec<Route> = Vec::new();
        for tolls in TOLLS {
            let Some(there) = self.routes(robot, kept, tolls, |node| node == goal, Some(goal), 1).pop() else {
                continue;
            };
            let heading = there.last().or(kept.atoms.last()).and_then(|&last| self.site.atoms[last].headings);
            let heading = heading.map(|headings| headings[1]);
            let safe = |node: usize| self.is_free(robot, node) && self.ends.contains(&node);
            let mut onward = self.onward(robot, From { node: goal, heading }, tolls, safe, None, ENDS);
            if onward.is_empty() {
                // More robots than ends: wherever nobody stands.
                onward = self.onward(
                    robot,
                    From { node: goal, heading },
                    tolls,
                    |node| self.is_free(robot, node),
                    None,
                    ENDS,
                );
            }
            for end in onward {
                let steps = there.len();
                let way: Vec<usize> = there.iter().chain(&end).copied().collect();
                if found.iter().all(|(other, _)| *other != way) {
                    found.push((way, Some(steps)));
                }
            }
        }
        found
    }

    /// The way and orders with which all are expected to arrive soonest, of those that are admitted.
    fn admitted(&self, robot: usize, kept: &Kept, candidates: Vec<Route>) -> Result<Admitted, Refused> {
        let it = &self.robots[robot];
        // The orders of all are sound before.
        let base = self.base().unwrap_or_default();
        let waits = Waits::of(self.robots, self.book, Some(robot));
        let [least, most] = FORECASTS;
        let budget = &Cell::new((WORK / waits.len().max(1)).clamp(least, most));
        let mut refused = Refused::default();
        let mut best: Option<Admitted> = None;
        let [at, stop] = [it.at, it.stop(self.abilities)].map(|length| length - kept.before);
        for (route, goal) in candidates {
            let atoms: Vec<usize> = kept.atoms.iter().chain(&route).copied().collect();
            let goal = goal.map(|goal| kept.atoms.len() + goal);
            let way = Way::new(self.site, kept.from, &atoms, goal, self.abilities);
            let regions = self.book.regions(self.site, self.robots, robot, &way, at);
            let case = Case { scene: self, base: &base, waits: &waits, robot, way: &way, at, stop, budget };
            match case.solve(regions) {
                Ok((regions, departs, cost)) => {
                    if best.as_ref().is_none_or(|best| cost < best.cost) {
                        best = Some(Admitted { way, before: kept.before, regions, departs, cost });
                    }
                }
                Err(by) => refused = by,
            }
        }
        let mut best = best.ok_or(refused)?;
        if self.method == Method::Orders {
            let case = Case { scene: self, base: &base, waits: &waits, robot, way: &best.way, at, stop, budget };
            (best.regions, best.cost) = case.improved(std::mem::take(&mut best.regions), best.cost);
        }
        Ok(best)
    }
}

/// One way of one robot.
struct Case<'c> {
    scene: &'c Scene<'c>,
    base: &'c Forecast,
    waits: &'c Waits,
    robot: usize,
    way: &'c Way,
    at: f64,
    stop: f64,
    /// Forecasts that are left.
    budget: &'c Cell<usize>,
}

impl Case<'_> {
    fn solve(&self, regions: Vec<Region>) -> Result<(Vec<Region>, f64, f64), Refused> {
        match self.scene.method {
            Method::Orders => self.ordered(regions).map(|(regions, cost)| (regions, self.scene.time, cost)),
            Method::RouteLocks => match regions.first() {
                None => Ok((regions, self.scene.time, self.way.time(self.way.length()))),
                Some(region) => Err(Refused { by: Some(region.robots[1]) }),
            },
            Method::StartDelays => self.delayed(regions),
        }
    }

    fn forecast(&self, regions: &[Region], departs: f64) -> Result<Forecast, Vec<Stuck>> {
        let Scene { robots, abilities, time, .. } = *self.scene;
        let changed = Some((self.robot, self.way, self.at, departs, regions));
        Trial { robots, waits: self.waits, abilities, time, changed }.forecast()
    }

    /// Which of the two can go first at a region: the robot, the other one.
    fn sides(&self, region: &Region) -> [bool; 2] {
        let other = &self.scene.robots[region.robots[1]];
        let at = [self.at, other.at];
        let stop = [self.stop, other.stop(self.scene.abilities)];
        let lengths = [self.way.length(), other.way.length()];
        [0, 1].map(|first| region.can_be_first(first, at, stop, lengths))
    }

    /// Orders by what is forecast, mended, and turned round where that is better.
    fn ordered(&self, mut regions: Vec<Region>) -> Result<(Vec<Region>, f64), Refused> {
        regions.sort_by(|a, b| a.hull[0].lo.total_cmp(&b.hull[0].lo));
        let mut open = Vec::with_capacity(regions.len());
        let mut late = 0.0;
        for region in &mut regions {
            let sides = self.sides(region);
            let (ahead, behind) = self.waits(region, late);
            region.first = match sides {
                [true, true] => usize::from(ahead >= behind),
                [true, false] => 0,
                [false, true] => 1,
                [false, false] => return Err(Refused { by: Some(region.robots[1]) }),
            };
            if region.first == 1 {
                late += behind;
            }
            open.push(sides == [true, true]);
        }
        let forecast = self.repaired(&mut regions, &open)?;
        Ok((regions, forecast.cost))
    }

    /// Turns orders round where all are expected to arrive sooner by that.
    fn improved(&self, mut regions: Vec<Region>, mut cost: f64) -> (Vec<Region>, f64) {
        let mut turns = 0;
        for k in 0..regions.len() {
            let (ahead, behind) = self.waits(&regions[k], 0.0);
            if turns >= LEAST_TURNS && self.budget.get() == 0 {
                break;
            }
            let free = if regions[k].first == 0 { ahead == 0.0 } else { behind == 0.0 };
            if turns >= TURNS || free || self.sides(&regions[k]) != [true; 2] {
                continue;
            }
            turns += 1;
            self.budget.set(self.budget.get().saturating_sub(1));
            regions[k].first = 1 - regions[k].first;
            match self.forecast(&regions, self.scene.time) {
                Ok(other) if other.cost < cost => cost = other.cost,
                _ => regions[k].first = 1 - regions[k].first,
            }
        }
        (regions, cost)
    }

    /// How long the other one would wait if the robot went first, and the robot if the other one did, which is `late` already \[s\].
    fn waits(&self, region: &Region, late: f64) -> (f64, f64) {
        let now = self.way.time(self.at) - late;
        let other = region.robots[1];
        let (mut first, mut second) = (0.0_f64, 0.0_f64);
        for timed in region.gates_of(1) {
            let comes = self.base.from(other, timed.comes, timed.gate.at);
            first = first.max(timed.opens - now - comes);
        }
        for timed in region.gates_of(0) {
            let opens = self.base.from(other, timed.opens, timed.gate.needs);
            second = second.max(opens - (timed.comes - now).max(late));
        }
        (first, second)
    }

    /// Turns orders round until nobody waits for ever; last of all everybody else goes first.
    fn repaired(&self, regions: &mut [Region], open: &[bool]) -> Result<Forecast, Refused> {
        let mut tried = vec![false; regions.len()];
        let mut last = Refused::default();
        for _ in 0..REPAIRS {
            if self.budget.get() == 0 {
                return Err(last);
            }
            self.budget.set(self.budget.get() - 1);
            let stuck = match self.forecast(regions, self.scene.time) {
                Ok(forecast) => return Ok(forecast),
                Err(stuck) => stuck,
            };
            last.by = stuck.iter().find(|stuck| stuck.robot == self.robot).or(stuck.first()).map(|stuck| stuck.by);
            let mendable = |first: usize| {
                let places = stuck.iter().filter_map(|stuck| stuck.region);
                places.into_iter().find(|&place| open[place] && !tried[place] && regions[place].first == first)
            };
            let Some(place) = mendable(0).or_else(|| mendable(1)) else { break };
            tried[place] = true;
            regions[place].first = 1 - regions[place].first;
        }
        for (region, open) in regions.iter_mut().zip(open) {
            if *open {
                region.first = 1;
            }
        }
        self.forecast(regions, self.scene.time).map_err(|_| last)
    }

    /// The least start delay with which the robot waits for nobody and nobody for it, as all are expected to be.
    fn delayed(&self, mut regions: Vec<Region>) -> Result<(Vec<Region>, f64, f64), Refused> {
        let mut refused = Refused::default();
        'delays: for k in 0..DELAYS.1 {
            let late = DELAYS.0 * f64::from(k);
            for region in &mut regions {
                let (ahead, behind) = self.waits(region, late);
                let sides = self.sides(region);
                region.first = match (sides[0] && ahead <= 0.0, sides[1] && behind <= 0.0) {
                    (true, _) => 0,
                    (false, true) => 1,
                    (false, false) => {
                        refused.by = Some(region.robots[1]);
                        continue 'delays;
                    }
                };
            }
            let departs = self.scene.time + late;
            if let Ok(forecast) = self.forecast(&regions, departs) {
                return Ok((regions, departs, forecast.cost));
            }
        }
        Err(refused)
    }
}
