//! Starting places of robots, and a stream of tasks, each of which any robot may do, also on its way to another one.

use super::site::Site;
use std::collections::VecDeque;
use std::time::Duration;

/// Places of robots and tasks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tasks {
    /// The node of a layout where each robot stands at first.
    pub starts: Vec<usize>,
    /// The node of each task, and when it comes \[s\].
    pub tasks: Vec<(usize, f64)>,
}

impl Tasks {
    /// Where robots stand at first.
    pub(super) fn starts(&self, site: &Site) -> Result<Vec<usize>, String> {
        let count = site.points.len();
        let all = self.starts.iter().chain(self.tasks.iter().map(|(node, _)| node));
        if let Some(node) = all.into_iter().find(|&&node| node >= count) {
            return Err(format!("node {node} is none of the {count} of the layout"));
        }
        for (robot, &start) in self.starts.iter().enumerate() {
            if let Some(other) = self.starts[..robot].iter().position(|&other| site.collide(other, start)) {
                return Err(format!("robots {other} and {robot} touch where they begin"));
            }
        }
        Ok(self.starts.clone())
    }
}

/// A task that nobody has done yet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Task {
    pub(super) node: usize,
    /// When it came \[s\].
    pub(super) since: f64,
    /// Who is to do it.
    pub(super) robot: Option<usize>,
}

/// Tasks that are to come, by their times, and those that have come.
#[derive(Clone, Debug)]
pub(super) struct Queue {
    left: VecDeque<(usize, f64)>,
    pub(super) open: Vec<Task>,
    /// Time spent on giving tasks since the last one was given.
    pub(super) spent: Duration,
    /// When those were looked at last for which a robot is sent \[s\].
    pub(super) looked: f64,
}

impl Queue {
    pub(super) fn of(tasks: &Tasks) -> Self {
        let mut tasks = tasks.tasks.clone();
        tasks.sort_by(|a, b| a.1.total_cmp(&b.1));
        Self { left: tasks.into(), open: Vec::new(), spent: Duration::ZERO, looked: 0.0 }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.left.is_empty() && self.open.is_empty()
    }

    /// Opens those that have come.
    pub(super) fn come(&mut self, now: f64) {
        while let Some(&(node, since)) = self.left.front().filter(|(_, since)| *since <= now) {
            self.left.pop_front();
            self.open.push(Task { node, since, robot: None });
        }
    }

    /// A robot is at a node: takes the tasks there.
    pub(super) fn done(&mut self, node: usize) -> Vec<Task> {
        self.open.extract_if(.., |task| task.node == node).collect()
    }
}
