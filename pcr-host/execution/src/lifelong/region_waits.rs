//! The waits of robots on their ways: the gates that they have still to pass, given the orders of the fleet.

use super::gates::TimedGate;
use super::region_table::{RegionTable, RouteRegion};
use super::robot::LifelongRobot;
use std::cell::OnceCell;

/// A region that a robot passes second.
#[derive(Clone, Copy)]
pub(super) struct RegionWait<'r> {
    pub(super) first: usize,
    /// The gates of the region that are still ahead: at least one.
    pub(super) gates: &'r [TimedGate],
    /// The nearest of these gates, and the last one, at which the first robot has left.
    pub(super) ends: [TimedGate; 2],
    /// Index of the region among those of the changed robot, if it is one of these.
    pub(super) changed_region: Option<usize>,
    /// Index before sorting, which decides between equal lengths.
    order: usize,
}

impl<'r> RegionWait<'r> {
    /// The wait at a region with its robots at these places; `None` if no wait is possible any more.
    pub(super) fn of(region: &'r RouteRegion, place: Option<usize>, at: [f64; 2]) -> Option<Self> {
        if region.is_over(at) {
            return None;
        }
        let ([mut nearest, last], at) = (region.ends()?, at[region.first]);
        if last.gate.required_position <= at {
            return None;
        }
        // In most cases no gate is passed, and the list need not be read.
        let mut gates = region.gates();
        if nearest.gate.required_position <= at {
            gates = &gates[gates.partition_point(|timed| timed.gate.required_position <= at)..];
            nearest = *gates.first()?;
        }
        Some(Self { first: region.robots[region.first], gates, ends: [nearest, last], changed_region: place, order: 0 })
    }
}

/// For each robot the regions ahead that it passes second, the nearest first; computed when first needed.
pub(super) struct FleetWaits<'w> {
    robots: &'w [LifelongRobot],
    book: &'w RegionTable,
    rows: Vec<OnceCell<Vec<RegionWait<'w>>>>,
}

impl<'w> FleetWaits<'w> {
    /// The waits by the orders of the fleet.
    pub(super) fn of(robots: &'w [LifelongRobot], book: &'w RegionTable) -> Self {
        Self { robots, book, rows: vec![OnceCell::new(); robots.len()] }
    }

    /// The regions of a robot.
    pub(super) fn regions(&self, robot: usize) -> impl Iterator<Item = &'w RouteRegion> {
        self.book.row(robot)
    }

    /// The waits of a robot.
    pub(super) fn row(&self, robot: usize) -> &[RegionWait<'w>] {
        self.rows[robot].get_or_init(|| {
            let second = self.regions(robot).filter(|region| region.second() == robot);
            let at = |region: &RouteRegion| region.robots.map(|robot| self.robots[robot].at);
            let mut waits: Vec<RegionWait<'w>> =
                second.filter_map(|region| RegionWait::of(region, None, at(region))).collect();
            sort(&mut waits);
            waits
        })
    }

    /// Number of gates of all robots but one: the cost of a forecast of all.
    pub(super) fn len_without(&self, robot: usize) -> usize {
        let others = (0..self.robots.len()).filter(|&other| other != robot).flat_map(|other| self.row(other));
        others.filter(|wait| wait.first != robot).map(|wait| wait.gates.len()).sum()
    }
}

/// Sorts by length, the nearest first.
pub(super) fn sort(waits: &mut [RegionWait<'_>]) {
    waits.iter_mut().enumerate().for_each(|(place, wait)| wait.order = place);
    waits.sort_unstable_by(|a, b| {
        a.ends[0].gate.wait_position.total_cmp(&b.ends[0].gate.wait_position).then(a.order.cmp(&b.order))
    });
}
