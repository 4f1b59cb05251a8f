//! Markers for RViz: the outlines of two robots where they overlap most.

use crate::config::RobotConfig;
use crate::messages::{Colour, Header, Marker, MarkerArray, Position};
use crate::report::ConflictReport;
use pcr_rmf_mapf::Footprint;
use std::f64::consts::TAU;

/// Of the polygon that is drawn for a disc.
const CORNERS: u32 = 32;
/// Width of lines \[m\].
const WIDTH: f64 = 0.03;
const RED: Colour = Colour { r: 1.0, g: 0.1, b: 0.1, a: 1.0 };

/// Deletes what is there, and draws each conflict.
pub(crate) fn of(robots: &[&RobotConfig], conflicts: &[ConflictReport], header: &Header) -> MarkerArray {
    let clear = Marker { header: header.clone(), action: Marker::DELETE_ALL, ..Default::default() };
    let outlines = conflicts
        .iter()
        .flat_map(|conflict| [(&conflict.robot_a, conflict.pose_a), (&conflict.robot_b, conflict.pose_b)]);
    let drawn = outlines.zip(0..).filter_map(|((name, pose), id)| {
        let robot = robots.iter().find(|robot| robot.name == *name)?;
        Some(Marker {
            header: header.clone(),
            ns: "conflicts".to_owned(),
            id,
            kind: Marker::LINE_STRIP,
            action: Marker::ADD,
            pose,
            scale: Position { x: WIDTH, y: 0.0, z: 0.0 },
            color: RED,
            points: outline(robot),
            ..Default::default()
        })
    });
    MarkerArray { markers: std::iter::once(clear).chain(drawn).collect() }
}

/// The closed outline of a robot in its own frame, without its margin.
fn outline(robot: &RobotConfig) -> Vec<Position> {
    let corners = match robot.footprint() {
        Footprint::Polygon { corners } => corners,
        Footprint::Disc { radius } => (0..CORNERS)
            .map(|k| f64::from(k) / f64::from(CORNERS) * TAU)
            .map(|angle| [radius * angle.cos(), radius * angle.sin()])
            .collect(),
    };
    corners.iter().chain(corners.first()).map(|&[x, y]| Position { x, y, z: 0.0 }).collect()
}
