//! Outlines of agents in a number format, of which none is smaller than that in the scenario.

use super::HostScalar;
use pcr_core::{Outline, Vector};
use pcr_formats::scenario::{Agent, PathSegment, TURN};

/// Largest number of corners of an outline.
pub(super) const CORNERS: usize = 16;

/// The outline of an agent, if it is convex and the same on all of its path, which does not turn in place.
pub(super) fn of<S: HostScalar>(agent: &Agent) -> Option<Outline<S, CORNERS>> {
    let footprint = agent.footprint.as_ref().filter(|_| agent.loads.is_empty() && !turns_in_place(agent))?;
    let size = footprint.polygon().iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let corners = footprint.convex(4.0 * S::STEP + 8.0 * S::EPSILON * size)?;
    let held: Vec<Vector<S>> = corners.iter().map(|&[x, y]| Vector { x: S::from_f64(x), y: S::from_f64(y) }).collect();
    let polygon: Vec<[f64; 2]> = held.iter().map(|corner| [corner.x.to_f64(), corner.y.to_f64()]).collect();
    // What the polygon has lost, the radius makes up for.
    let radius = rounded_up(footprint.growth() + footprint.beyond(&polygon))?;
    Outline::polygon(held, radius).ok()
}

/// Whether the agent turns about its reference point somewhere: its outline sweeps an area there, for which the path has no length.
fn turns_in_place(agent: &Agent) -> bool {
    agent.path.iter().any(|segment| matches!(*segment, PathSegment::Arc { radius, .. } if radius <= TURN))
}

/// The least number of the format, or the one after it, that is not smaller.
fn rounded_up<S: HostScalar>(value: f64) -> Option<S> {
    let above = S::from_f64(value * (1.0 + S::EPSILON) + S::STEP);
    [S::from_f64(value), above].into_iter().find(|number| number.to_f64() >= value)
}
