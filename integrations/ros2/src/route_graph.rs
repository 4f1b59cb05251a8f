//! The route graph of nav2's route server, and which of its edges robots that stand are in the way of.

use crate::config::RobotConfig;
use crate::planned_path::PlannedPose;
use crate::refusal::Refusal;
use pcr_core::{Encounter, Interval};
use pcr_formats::import::{self, ElementId, ImportOptions, InputFormat, Warnings};
use pcr_formats::warning::WarningCode;
use pcr_rmf_mapf::{Footprint, OwnedMotion, TimedPose, Trajectory};
use std::collections::BTreeSet;
use std::fmt;

/// How near two robots may come to be looked at closely, beyond what their footprints reach \[m\]: above all rounding.
const SLACK: f64 = 0.01;

/// An edge of the graph: as for the route server, the straight line between its nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct RouteEdge {
    id: u16,
    ends: [[f64; 2]; 2],
}

/// A route graph.
#[derive(Clone, Debug, PartialEq)]
pub struct RouteGraph {
    edges: Vec<RouteEdge>,
}

/// Why a file is not used as a route graph.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GraphError {
    /// It cannot be read, or not as a whole.
    Unreadable(String),
    /// It is in another frame.
    Frame {
        /// Its frame.
        given: String,
        /// That of the configuration.
        expected: String,
    },
    /// The service cannot name an edge: its id is not below 65536, or another one has it as well.
    Edge(String),
}

impl RouteGraph {
    /// Reads a graph, as GeoJSON.
    ///
    /// # Errors
    /// [`GraphError`].
    pub fn read(text: &str, frame: &str) -> Result<Self, GraphError> {
        let mut warnings = Warnings::default();
        let unreadable = |problem: &dyn fmt::Display| GraphError::Unreadable(problem.to_string());
        let options = ImportOptions::default();
        let imported = import::layout(InputFormat::Nav2, text, &options, &mut warnings);
        let layout = imported.map_err(|error| unreadable(&error))?.layout;
        // An edge that is not read would never be closed.
        let left_out = warnings.iter().find(|(code, ..)| *code == WarningCode::LeftOut);
        if let Some((_, what, _)) = left_out {
            return Err(unreadable(&format_args!("what the file has is not read: {what}")));
        }
        if let Some(given) = layout.levels.iter().find(|given| *given != frame) {
            return Err(GraphError::Frame { given: given.clone(), expected: frame.to_owned() });
        }
        let edge = |edge: &import::LayoutEdge| {
            let id = match edge.id {
                ElementId::Number(id) => u16::try_from(id).ok(),
                _ => None,
            };
            let id = id.ok_or_else(|| GraphError::Edge(edge.id.to_string()))?;
            Ok(RouteEdge { id, ends: edge.ends.map(|node| layout.position(node)) })
        };
        let edges: Vec<RouteEdge> = layout.edges.iter().map(edge).collect::<Result<_, _>>()?;
        let mut ids = BTreeSet::new();
        if let Some(twice) = edges.iter().find(|edge| !ids.insert(edge.id)) {
            return Err(GraphError::Edge(twice.id.to_string()));
        }
        Ok(Self { edges })
    }

    /// The edges on which a robot would touch one of these that stand, margins included. It drives ahead, from node to node; it turns at nodes, which
    /// is not part of an edge.
    ///
    /// # Errors
    /// Why it is not known.
    pub(crate) fn blocked(
        &self,
        driver: &RobotConfig,
        standing: &[(&RobotConfig, PlannedPose)],
    ) -> Result<BTreeSet<u16>, Refusal> {
        let mut found = BTreeSet::new();
        for &(robot, pose) in standing {
            let still = TimedPose { time: 0.0, position: pose.position, yaw: pose.yaw };
            let still = motion(&[still], robot)?;
            let still = still.motion().map_err(Refusal::Range)?;
            let reach = reach(driver) + reach(robot) + SLACK;
            for edge in &self.edges {
                if found.contains(&edge.id) || distance(pose.position, edge.ends) > reach {
                    continue;
                }
                // Who drives an edge without a length is at its node in any heading.
                if edge.ends[0] == edge.ends[1] {
                    found.insert(edge.id);
                } else {
                    let (driven, duration) = driven(edge, driver)?;
                    let driven = driven.motion().map_err(Refusal::Range)?;
                    let encounter = Encounter::new(&driven, &still);
                    if encounter.conflicts(Interval::new(0.0, duration)).next().is_some() {
                        found.insert(edge.id);
                    }
                }
            }
        }
        Ok(found)
    }
}

/// A robot that goes along an edge at 1 m/s, and how long that takes \[s\].
fn driven(edge: &RouteEdge, driver: &RobotConfig) -> Result<(OwnedMotion, f64), Refusal> {
    let [from, to] = edge.ends;
    let way = [to[0] - from[0], to[1] - from[1]];
    let (length, yaw) = (way[0].hypot(way[1]), way[1].atan2(way[0]));
    let poses = [(0.0, from), (length, to)].map(|(time, position)| TimedPose { time, position, yaw });
    Ok((motion(&poses, driver)?, length))
}

fn motion(poses: &[TimedPose], robot: &RobotConfig) -> Result<OwnedMotion, Refusal> {
    let trajectory = Trajectory::new(poses.iter().copied()).with_footprint(robot.footprint());
    OwnedMotion::new(0, &trajectory.with_margin(robot.margin)).map_err(|error| match error {
        pcr_rmf_mapf::Error::Invalid { problem, .. } => Refusal::Range(problem),
        other => Refusal::Motion(other),
    })
}

/// The largest distance of a point of a robot, with its margin, from its position \[m\].
fn reach(robot: &RobotConfig) -> f64 {
    let radius = match robot.footprint() {
        Footprint::Disc { radius } => radius,
        Footprint::Polygon { corners } => corners.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max),
    };
    radius + robot.margin
}

/// From a point to a line from one point to another \[m\].
fn distance(point: [f64; 2], [from, to]: [[f64; 2]; 2]) -> f64 {
    let way = [to[0] - from[0], to[1] - from[1]];
    let off = [point[0] - from[0], point[1] - from[1]];
    let square = way[0] * way[0] + way[1] * way[1];
    let share = if square > 0.0 { ((off[0] * way[0] + off[1] * way[1]) / square).clamp(0.0, 1.0) } else { 0.0 };
    (off[0] - share * way[0]).hypot(off[1] - share * way[1])
}

impl fmt::Display for GraphError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(problem) => f.write_str(problem),
            Self::Frame { given, expected } => write!(f, "the graph is in frame \"{given}\", not \"{expected}\""),
            Self::Edge(id) => write!(f, "edge {id}: the service cannot name it: ids are unique, and below 65536"),
        }
    }
}

impl std::error::Error for GraphError {}
