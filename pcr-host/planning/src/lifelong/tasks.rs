//! Starting places of robots, and a stream of tasks, each of which any robot may do.

use super::site::Site;
use std::collections::VecDeque;

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

/// Tasks that are not given yet, by their times.
#[derive(Clone, Debug)]
pub(super) struct Queue(VecDeque<(usize, f64)>);

impl Queue {
    pub(super) fn of(tasks: &Tasks) -> Self {
        let mut tasks = tasks.tasks.clone();
        tasks.sort_by(|a, b| a.1.total_cmp(&b.1));
        Self(tasks.into())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The node of the oldest task, if it has come.
    pub(super) fn due(&self, now: f64) -> Option<usize> {
        self.0.front().filter(|(_, since)| *since <= now).map(|(node, _)| *node)
    }

    /// Takes the oldest task away; when it came \[s\].
    pub(super) fn take(&mut self) -> f64 {
        self.0.pop_front().map_or(0.0, |(_, since)| since)
    }
}
