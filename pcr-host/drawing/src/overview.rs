//! The workspace beside the extended collision map of the agent with the most regions.

use super::axis::{PlotArea, ROOM_ABOVE, ROOM_BELOW, room_at_left};
use super::map::{self, Legend};
use super::region_scene::RegionScene;
use super::svg::SvgWriter;
use super::workspace;

/// Largest width and height of either plot \[px\].
const SIDE: f64 = 400.0;

/// Smallest height of the map \[px\].
const LEAST: f64 = 260.0;

/// The agent with the most regions, the first of them, of those whose maps are drawn; the first agent of a fleet without any.
pub(super) fn busiest(scene: &RegionScene<'_>) -> usize {
    scene.egos().rev().max_by_key(|place| scene.count(*place)).unwrap_or(0)
}

/// The picture; of an empty fleet the workspace alone.
pub(super) fn picture(scene: &RegionScene<'_>) -> String {
    if scene.motions.is_empty() {
        return workspace::picture(scene);
    }
    let space = workspace::frame(scene, SIDE, [0.0, 0.0]);
    let ego = busiest(scene);
    let [time, length] = map::spans(scene, ego);
    let [_, _, between, bottom] = space.edges;
    let bottom = bottom.max(ROOM_ABOVE + LEAST);
    let left = between + 16.0 + room_at_left(length, bottom - ROOM_ABOVE);
    let frame = PlotArea::new(time, length, [left, ROOM_ABOVE, left + SIDE, bottom]);
    let shapes = scene.shapes(ego, [frame.x.units_per_pixel(), frame.y.units_per_pixel()]);
    let (agents, regions) = (
        workspace::DiscLabels::new(scene, &space),
        map::RegionLabels::new(scene, ego, &shapes, &frame, map::LABEL_SIZE),
    );
    let notes = agents.left_out().into_iter().chain(regions.left_out());
    let legend = Legend::new(scene, ego, &shapes, notes, [space.edges[0], frame.edges[2]]);
    let title = format!("Workspace and extended collision map of agent {}", scene.display_name(ego));
    let mut svg = SvgWriter::new(frame.edges[2] + 12.0, bottom + ROOM_BELOW + legend.height() + 6.0, &title);
    workspace::draw(&mut svg, scene, &space, &agents);
    map::draw(&mut svg, scene, ego, &shapes, &regions, &frame);
    legend.draw(&mut svg, bottom + ROOM_BELOW);
    svg.finish()
}
