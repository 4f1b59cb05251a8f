//! Outlines of agents in a number format, of which none is smaller than that in the scenario.

use super::HostScalar;
use pcr_core::{Outline, Vector};
use pcr_formats::footprint::Footprint;
use pcr_formats::plane_geometry;
use pcr_formats::scenario::Agent;

/// Largest number of corners of an outline.
pub(super) const CORNERS: usize = 16;

/// Rounds of leaving out corners that a format cannot tell from their neighbours.
const ROUNDS: usize = 12;

/// A convex footprint as an outline.
///
/// # Errors
/// What is wrong, in words.
pub(super) fn of<S: HostScalar>(footprint: &Footprint) -> Result<Outline<S, CORNERS>, String> {
    let size = footprint.polygon().iter().flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
    let mut near = 4.0 * S::STEP + 8.0 * S::EPSILON * size;
    let mut refused = "footprint: it is not convex".to_owned();
    for _ in 0..ROUNDS {
        let Some(corners) = footprint.convex(near) else { break };
        let held = corners.iter().map(|corner| Vector { x: S::from_f64(corner[0]), y: S::from_f64(corner[1]) });
        let held: Vec<Vector<S>> = held.collect();
        let polygon: Vec<[f64; 2]> = held.iter().map(|corner| [corner.x.to_f64(), corner.y.to_f64()]).collect();
        // What the polygon has lost, the radius makes up for.
        let radius = rounded_up(footprint.growth() + footprint.beyond(&polygon));
        let radius = radius.ok_or_else(|| "footprint: its size is out of range".to_owned())?;
        match Outline::polygon(held, radius) {
            Ok(outline) => return Ok(outline),
            Err(reason) => refused = format!("footprint: {}", super::derived::<S>(reason)),
        }
        near *= 2.0;
    }
    Err(refused)
}

/// The convex hull of all that an agent is at some time, where that is no disc and not one convex outline of few corners; a disc counts as
/// the polygon of 16 corners around it.
pub(super) fn hull(agent: &Agent) -> Option<Footprint> {
    let outlines = agent.outlines();
    let is_one = match &agent.footprint {
        Some(footprint) => agent.loads.is_empty() && footprint.parts().nth(1).is_none(),
        None => outlines.iter().all(|outline| outline.footprint.is_none()),
    };
    if is_one {
        return None;
    }
    let mut growth = 0.0_f64;
    let mut corners = Vec::new();
    for outline in &outlines {
        match outline.footprint {
            Some(footprint) => {
                growth = growth.max(footprint.growth());
                corners.extend_from_slice(footprint.polygon());
            }
            None => corners.extend(around(outline.radius)),
        }
    }
    let hull = fewer(plane_geometry::hull(corners));
    Footprint::new(hull).ok().map(|hull| hull.inflated(growth))
}

/// The corners of a polygon around the disc of this radius about the reference point.
fn around(radius: f64) -> impl Iterator<Item = [f64; 2]> {
    let turn = std::f64::consts::TAU / CORNERS as f64;
    let reach = radius / (0.5 * turn).cos() * (1.0 + 4.0 * f64::EPSILON);
    (0..CORNERS).map(move |k| {
        let (sin, cos) = (turn * k as f64).sin_cos();
        [reach * cos, reach * sin]
    })
}

/// A convex polygon of at most [`CORNERS`] corners around another one: the side is left out whose neighbours meet nearest to it.
fn fewer(mut corners: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    while corners.len() > CORNERS {
        let count = corners.len();
        let meets = |k: usize| {
            let at = |step: usize| corners[(k + step) % count];
            let beyond = crossing([at(0), at(1)], [at(3), at(2)])?;
            Some((plane_geometry::from_segment(beyond, [at(1), at(2)]), k, beyond))
        };
        let Some((_, k, beyond)) = (0..count).filter_map(meets).min_by(|a, b| a.0.total_cmp(&b.0)) else { break };
        corners[(k + 1) % count] = beyond;
        corners.remove((k + 2) % count);
    }
    corners
}

/// Where two lines, from a point on through another one, meet beyond both.
fn crossing([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let [u, v] = [[a, b], [c, d]].map(|[from, to]| [to[0] - from[0], to[1] - from[1]]);
    let cross = |p: [f64; 2], q: [f64; 2]| p[0] * q[1] - p[1] * q[0];
    let turn = cross(u, v);
    let share = cross([c[0] - a[0], c[1] - a[1]], v) / turn;
    (turn < 0.0 && share >= 1.0).then(|| [a[0] + share * u[0], a[1] + share * u[1]])
}

/// The least number of the format, or the one after it, that is not smaller.
fn rounded_up<S: HostScalar>(value: f64) -> Option<S> {
    let above = S::from_f64(value * (1.0 + S::EPSILON) + S::STEP);
    [S::from_f64(value), above].into_iter().find(|number| number.to_f64() >= value)
}
