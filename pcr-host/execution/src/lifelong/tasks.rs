//! Starting places of robots, and a stream of tasks, each of which any robot may do, also on its way to another one.

use super::route_graph::RouteGraph;
use crate::error::ExecutionError;
use std::collections::VecDeque;
use std::time::Duration;

/// Starts of robots, and tasks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TaskStream {
    /// Node of the layout at which each robot starts.
    pub starts: Vec<usize>,
    /// Node of each task, and the time at which it comes \[s\].
    pub tasks: Vec<(usize, f64)>,
}

impl TaskStream {
    /// The start nodes, after a check that nodes exist and that robots do not touch there.
    pub(super) fn starts(&self, site: &RouteGraph) -> Result<Vec<usize>, ExecutionError> {
        let count = site.points.len();
        let all = self.starts.iter().chain(self.tasks.iter().map(|(node, _)| node));
        if let Some(&node) = all.into_iter().find(|&&node| node >= count) {
            return Err(ExecutionError::NoSuchNode { node, count });
        }
        for (robot, &start) in self.starts.iter().enumerate() {
            if let Some(other) = self.starts[..robot].iter().position(|&other| site.collide(other, start)) {
                return Err(ExecutionError::Touching([other, robot].map(|robot| robot.to_string())));
            }
        }
        Ok(self.starts.clone())
    }
}

/// A task that is not done.
#[derive(Clone, Copy, Debug)]
pub(super) struct OpenTask {
    pub(super) node: usize,
    /// Time at which it came \[s\].
    pub(super) since: f64,
    /// Robot that is sent for it.
    pub(super) robot: Option<usize>,
}

/// Tasks that will come, by their times, and open tasks.
#[derive(Clone, Debug)]
pub(super) struct TaskQueue {
    left: VecDeque<(usize, f64)>,
    pub(super) open: Vec<OpenTask>,
    /// Computing time for assigning tasks since the last assignment.
    pub(super) spent: Duration,
    /// Time of the last look at tasks for which a robot is sent \[s\].
    pub(super) looked: f64,
}

impl TaskQueue {
    pub(super) fn of(tasks: &TaskStream) -> Self {
        let mut tasks = tasks.tasks.clone();
        tasks.sort_by(|a, b| a.1.total_cmp(&b.1));
        Self { left: tasks.into(), open: Vec::new(), spent: Duration::ZERO, looked: 0.0 }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.left.is_empty() && self.open.is_empty()
    }

    /// Opens the tasks that have come.
    pub(super) fn release_due(&mut self, now: f64) {
        while let Some(&(node, since)) = self.left.front().filter(|(_, since)| *since <= now) {
            self.left.pop_front();
            self.open.push(OpenTask { node, since, robot: None });
        }
    }

    /// Takes the tasks at a node where a robot is.
    pub(super) fn done(&mut self, node: usize) -> Vec<OpenTask> {
        self.open.extract_if(.., |task| task.node == node).collect()
    }
}
