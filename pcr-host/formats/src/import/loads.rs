//! Loads in a state of VDA 5050, which enlarge the outline of the vehicle.
//!
//! A load is a box of a length and a width around its reference in the frame of the vehicle. The outline becomes the convex
//! hull of contour and loads; a disc becomes the disc around both.

use super::value::Object;
use super::{ImportError, Vehicle, Warnings};
use crate::footprint::Footprint;

/// The vehicle with what the state says that it carries.
pub(super) fn loaded(state: &Object<'_>, vehicle: &Vehicle, warnings: &mut Warnings) -> Result<Vehicle, ImportError> {
    let mut corners = Vec::new();
    for (k, value) in state.list("loads")?.iter().enumerate() {
        let load = Object::new(format!("{}, load {}", state.name, k + 1), value)?;
        let size = load.object("loadDimensions")?.map(|size| Ok([size.number("length")?, size.number("width")?]));
        let Some([Some(length), Some(width)]) = size.transpose()? else {
            warnings.add(&load.name, "it has no length and width; the outline of the vehicle is taken for both");
            continue;
        };
        if length <= 0.0 || width <= 0.0 {
            warnings
                .add(&load.name, "its length or width is not above 0; the outline of the vehicle is taken for both");
            continue;
        }
        let reference = load.object("boundingBoxReference")?;
        if reference.is_none() {
            warnings.add(&load.name, "it has no boundingBoxReference; it is taken around the reference point");
        }
        let at = reference.as_ref().map_or(Ok([0.0; 2]), Object::point)?;
        let (sin, cos) = reference.map_or(Ok(None), |it| it.number("theta"))?.unwrap_or(0.0).sin_cos();
        for [ahead, left] in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]] {
            let (ahead, left) = (0.5 * length * ahead, 0.5 * width * left);
            corners.push([at[0] + ahead * cos - left * sin, at[1] + ahead * sin + left * cos]);
        }
    }
    if corners.is_empty() {
        return Ok(vehicle.clone());
    }
    let Some(footprint) = &vehicle.footprint else {
        let reach = corners.iter().map(|[ahead, left]| ahead.hypot(*left)).fold(vehicle.radius, f64::max);
        return Ok(Vehicle { radius: reach, ..vehicle.clone() });
    };
    corners.extend(footprint.polygon());
    let outline = Footprint::new(hull(corners), footprint.allowed());
    let outline = outline.map_err(|problem| ImportError::new(format!("{}, loads: {problem}", state.name)))?;
    let outline = outline.grown(footprint.growth());
    Ok(Vehicle { radius: outline.reach(), footprint: Some(outline), ..vehicle.clone() })
}

/// The corners of the convex hull, to the left about (Andrew's monotone chain).
pub(super) fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for next in points {
            while let [.., a, b] = chain.as_slice()
                && (b[0] - a[0]) * (next[1] - b[1]) - (b[1] - a[1]) * (next[0] - b[0]) <= 0.0
            {
                chain.pop();
            }
            chain.push(next);
        }
        // The last one is the first of the other chain.
        chain.pop();
        chain
    };
    let lower = chain(&mut points.iter().copied());
    [lower, chain(&mut points.iter().rev().copied())].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_has_the_outer_corners_to_the_left_about() {
        let points = vec![[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 0.5], [2.0, 2.0], [0.0, 2.0], [0.0, 0.0]];
        assert_eq!(hull(points), [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
    }
}
