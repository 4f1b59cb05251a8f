//! Execution by cells: a robot that enters a cell after another one sets off towards it when the other one has reached
//! its next cell.

use super::{ExecutionRule, NEAR};
use std::collections::HashMap;

/// A robot waits before a length until another one has reached a length \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
struct CellDependency {
    at: f64,
    first: usize,
    needs: f64,
}

/// The dependencies of a plan, in the order of the cells of each robot.
#[derive(Debug)]
pub(super) struct CellDependencyGraph {
    waits: Vec<Vec<CellDependency>>,
    /// For each robot the number of its waits that are fulfilled.
    passed: Vec<usize>,
}

/// The time at which a robot enters a cell, and the index of the cell on its way.
#[derive(Clone, Copy, Debug)]
struct CellVisit {
    time: usize,
    robot: usize,
    place: usize,
}

impl CellDependencyGraph {
    /// The dependencies of a plan with the cell of each robot at each step.
    pub(super) fn new(plan: &[Vec<[i32; 2]>]) -> Self {
        let mut visits: HashMap<[i32; 2], Vec<CellVisit>> = HashMap::new();
        for (robot, cells) in plan.iter().enumerate() {
            let mut place = 0;
            for (time, cell) in cells.iter().enumerate() {
                if time > 0 && cells[time - 1] == *cell {
                    continue;
                }
                place += usize::from(time > 0);
                visits.entry(*cell).or_default().push(CellVisit { time, robot, place });
            }
        }
        let mut waits: Vec<Vec<CellDependency>> = vec![Vec::new(); plan.len()];
        for visits in visits.values_mut() {
            visits.sort_by_key(|visit| visit.time);
            for pair in visits.windows(2).filter(|pair| pair[0].robot != pair[1].robot) {
                let [before, after] = [pair[0], pair[1]];
                let wait = CellDependency {
                    at: after.place as f64 - 1.0,
                    first: before.robot,
                    needs: before.place as f64 + 1.0,
                };
                waits[after.robot].push(wait);
            }
        }
        waits.iter_mut().for_each(|waits| waits.sort_by(|a, b| a.at.total_cmp(&b.at)));
        Self { passed: vec![0; waits.len()], waits }
    }
}

impl ExecutionRule for CellDependencyGraph {
    fn authority(&mut self, robot: usize, at: &[f64], _wanted: f64) -> f64 {
        let passed = &mut self.passed[robot];
        while let Some(wait) = self.waits[robot].get(*passed) {
            if at[wait.first] < wait.needs - NEAR {
                return wait.at;
            }
            *passed += 1;
        }
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_is_entered_when_the_one_before_has_come_to_its_next() {
        let plan = [vec![[0, 0], [1, 0], [1, 0], [2, 0]], vec![[1, -2], [1, -2], [1, -1], [1, -1], [1, 0]]];
        let mut cells = CellDependencyGraph::new(&plan);
        assert_eq!(cells.waits, [vec![], vec![CellDependency { at: 1.0, first: 0, needs: 2.0 }]]);
        assert_eq!(cells.authority(0, &[0.0, 0.0], 1.0), f64::INFINITY);
        assert_eq!(cells.authority(1, &[1.5, 0.0], 2.0), 1.0);
        assert_eq!(cells.authority(1, &[2.0, 0.0], 2.0), f64::INFINITY);
    }
}
