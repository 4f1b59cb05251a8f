//! The waits of robots on their ways: the gates that they have still to pass, given the orders of the fleet.

use super::book::{Book, Region};
use super::gates::Timed;
use super::robot::Robot;
use std::cell::OnceCell;

/// A region that a robot passes second.
#[derive(Clone, Copy)]
pub(super) struct Wait<'r> {
    pub(super) first: usize,
    /// The gates that it has still to pass there: at least one.
    pub(super) gates: &'r [Timed],
    /// Its place among the regions of the robot that has another way.
    pub(super) place: Option<usize>,
}

impl<'r> Wait<'r> {
    /// With the robots of the region at these places; none if nobody has to wait there any more.
    pub(super) fn of(region: &'r Region, place: Option<usize>, at: [f64; 2]) -> Option<Self> {
        if region.is_over(at) {
            return None;
        }
        let (gates, first) = (region.gates(), region.robots[region.first]);
        let gates = &gates[gates.partition_point(|timed| timed.gate.needs <= at[region.first])..];
        (!gates.is_empty()).then_some(Self { first, gates, place })
    }

    /// The nearest gate, and the one at which the first has left.
    pub(super) fn ends(&self) -> [&'r Timed; 2] {
        [&self.gates[0], &self.gates[self.gates.len() - 1]]
    }
}

/// The regions that robots have still to pass second, the nearest first; found when they are asked for.
pub(super) struct Waits<'w> {
    robots: &'w [Robot],
    book: &'w Book,
    without: Option<usize>,
    rows: Vec<OnceCell<Vec<Wait<'w>>>>,
}

impl<'w> Waits<'w> {
    /// By the orders of the fleet, those of one robot left out.
    pub(super) fn of(robots: &'w [Robot], book: &'w Book, without: Option<usize>) -> Self {
        Self { robots, book, without, rows: vec![OnceCell::new(); robots.len()] }
    }

    /// The regions of a robot, but for those of the one that is left out.
    pub(super) fn regions(&self, robot: usize) -> impl Iterator<Item = &'w Region> {
        let without = self.without;
        self.book.row(robot).filter(move |region| without.is_none_or(|without| !region.robots.contains(&without)))
    }

    /// Those of a robot.
    pub(super) fn row(&self, robot: usize) -> &[Wait<'w>] {
        self.rows[robot].get_or_init(|| {
            let second = self.regions(robot).filter(|region| region.second() == robot);
            let at = |region: &Region| region.robots.map(|robot| self.robots[robot].at);
            let mut waits: Vec<Wait<'w>> = second.filter_map(|region| Wait::of(region, None, at(region))).collect();
            sort(&mut waits);
            waits
        })
    }

    /// Gates of all of them: what a forecast of all costs.
    pub(super) fn len(&self) -> usize {
        (0..self.robots.len()).flat_map(|robot| self.row(robot)).map(|wait| wait.gates.len()).sum()
    }
}

/// The nearest first.
pub(super) fn sort(waits: &mut [Wait<'_>]) {
    waits.sort_by(|a, b| a.gates[0].gate.at.total_cmp(&b.gates[0].gate.at));
}
