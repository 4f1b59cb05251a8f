//! Which edges of the route graph are to be closed for which robot: those that others are in the way of.

use crate::config::RobotConfig;
use crate::messages::Time;
use crate::planned_path::{PlannedPath, PlannedPose};
use crate::refusal::Refusal;
use crate::route_graph::RouteGraph;
use std::collections::BTreeSet;

/// Whether a robot stands, and where, by its messages.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Stand {
    /// It moves, or nothing has been said yet.
    No,
    /// Since then its messages say that it stands, last at this pose.
    At { pose: PlannedPose, since: Time },
}

/// Which robots stand, and since when.
#[derive(Clone, Debug)]
pub struct Closures {
    graph: RouteGraph,
    /// How long a robot stands before it closes edges \[s\].
    stands: f64,
    robots: Vec<Stand>,
    /// It is computed when poses change.
    computed: Option<Computed>,
}

/// The edges that are closed for each robot.
#[derive(Clone, Debug)]
struct Computed {
    /// Where those stand that close edges.
    poses: Vec<Option<PlannedPose>>,
    edges: Vec<Result<BTreeSet<u16>, Refusal>>,
}

impl Closures {
    /// Nobody stands yet.
    pub fn new(graph: RouteGraph, stands: f64, robots: usize) -> Self {
        Self { graph, stands, robots: vec![Stand::No; robots], computed: None }
    }

    /// Takes what is known of each robot now. A message of one pose says that its robot stands there, one of more that it goes on. Where there is none
    /// that can be used, nothing changes: who has stopped talking has not moved away.
    pub(crate) fn take(&mut self, paths: &[Result<&PlannedPath, Refusal>], now: Time) {
        for (stand, path) in self.robots.iter_mut().zip(paths) {
            let Ok(path) = path else { continue };
            *stand = match (path.poses(), *stand) {
                (&[pose], Stand::At { since, .. }) => Stand::At { pose, since },
                (&[pose], Stand::No) => Stand::At { pose, since: now },
                _ => Stand::No,
            };
        }
    }

    /// For each robot the edges that others close.
    pub(crate) fn of_robots(&mut self, robots: &[RobotConfig], now: Time) -> &[Result<BTreeSet<u16>, Refusal>] {
        let closing = |stand: &Stand| match *stand {
            Stand::At { pose, since } if now.since(since) >= self.stands => Some(pose),
            _ => None,
        };
        let poses: Vec<Option<PlannedPose>> = self.robots.iter().map(closing).collect();
        // The times of the messages make no difference.
        let same = |computed: &Computed| {
            let place = |pose: &Option<PlannedPose>| pose.map(|pose| (pose.position, pose.yaw));
            computed.poses.iter().map(place).eq(poses.iter().map(place))
        };
        let computed = self.computed.take().filter(same);
        let graph = &self.graph;
        let Computed { edges, .. } = self.computed.insert(computed.unwrap_or_else(|| {
            let blocked = |(driver, robot): (usize, &RobotConfig)| {
                // A robot does not close the edges that it stands on for itself.
                let others = robots.iter().zip(&poses).enumerate().filter(|&(other, _)| other != driver);
                let others: Vec<(&RobotConfig, PlannedPose)> =
                    others.filter_map(|(_, (other, pose))| Some((other, (*pose)?))).collect();
                match robot.route_server {
                    Some(_) => graph.blocked(robot, &others),
                    None => Ok(BTreeSet::new()),
                }
            };
            let edges = robots.iter().enumerate().map(blocked).collect();
            Computed { poses, edges }
        }));
        edges
    }
}
