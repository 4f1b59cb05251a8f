//! Outlines of agents in a number format, of which none is smaller than that in the scenario.

use super::{HostScalar, RangeProblem, derived};
use pcr_core::{Outline, Vector};
use pcr_formats::footprint::Footprint;

/// Largest number of corners of an outline.
pub(super) const CORNERS: usize = 16;

/// Rounds of leaving out corners that a format cannot tell from their neighbours.
const ROUNDS: usize = 12;

/// A convex footprint as an outline.
///
/// # Errors
/// What does not fit the format.
pub(super) fn of<S: HostScalar>(footprint: &Footprint) -> Result<Outline<S, CORNERS>, RangeProblem> {
    let size = footprint.polygon().iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let mut near = 4.0 * S::STEP + 8.0 * S::EPSILON * size;
    let mut refused = RangeProblem::NotConvex;
    for _ in 0..ROUNDS {
        let Some(corners) = footprint.convex(near) else { break };
        let held = corners.iter().map(|corner| Vector { x: S::from_f64(corner[0]), y: S::from_f64(corner[1]) });
        let held: Vec<Vector<S>> = held.collect();
        let polygon: Vec<[f64; 2]> = held.iter().map(|corner| [corner.x.to_f64(), corner.y.to_f64()]).collect();
        // What the polygon has lost, the radius makes up for.
        let radius = rounded_up(footprint.growth() + footprint.beyond(&polygon));
        let radius = radius.ok_or(RangeProblem::FootprintSize)?;
        match Outline::polygon(held, radius) {
            Ok(outline) => return Ok(outline),
            Err(reason) => refused = RangeProblem::Footprint(Box::new(derived::<S>(reason))),
        }
        near *= 2.0;
    }
    Err(refused)
}

/// The least number of the format, or the one after it, that is not smaller.
fn rounded_up<S: HostScalar>(value: f64) -> Option<S> {
    let above = S::from_f64(value * (1.0 + S::EPSILON) + S::STEP);
    [S::from_f64(value), above].into_iter().find(|number| number.to_f64() >= value)
}
