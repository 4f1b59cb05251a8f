//! What robots wait for on their ways: the gates that they have still to pass, by the orders of the fleet.

use super::book::{Book, Region};
use super::gates::Timed;
use super::robot::Robot;
use std::cell::OnceCell;

/// A gate on a way, and whom it is about.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wait {
    pub(super) timed: Timed,
    pub(super) first: usize,
    /// Its place among the regions of the robot that has another way.
    pub(super) region: Option<usize>,
}

/// The gates that robots have still to pass, the nearest first; found when they are asked for.
pub(super) struct Waits<'w> {
    robots: &'w [Robot],
    book: &'w Book,
    without: Option<usize>,
    rows: Vec<OnceCell<Vec<Wait>>>,
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

    /// The gates of a robot.
    pub(super) fn row(&self, robot: usize) -> &[Wait] {
        self.rows[robot].get_or_init(|| {
            let mut waits = Vec::new();
            for region in self.regions(robot).filter(|region| region.second() == robot) {
                add(region, None, region.robots.map(|robot| self.robots[robot].at), &mut waits);
            }
            sort(&mut waits);
            waits
        })
    }

    /// How many there are: what a forecast of all costs.
    pub(super) fn len(&self) -> usize {
        (0..self.robots.len()).map(|robot| self.row(robot).len()).sum()
    }
}

/// The gates of a region that the second has still to pass.
pub(super) fn add(region: &Region, place: Option<usize>, at: [f64; 2], into: &mut Vec<Wait>) {
    if region.is_over(at) {
        return;
    }
    let (gates, first) = (region.gates(), region.robots[region.first]);
    let passed = gates.partition_point(|timed| timed.gate.needs <= at[region.first]);
    into.extend(gates[passed..].iter().map(|&timed| Wait { timed, first, region: place }));
}

pub(super) fn sort(waits: &mut [Wait]) {
    // Made of runs that are in order: stable sorting makes use of that.
    waits.sort_by(|a, b| a.timed.gate.at.total_cmp(&b.timed.gate.at));
}
