//! Loads in a state of VDA 5050, which enlarge the outline of the vehicle.
//!
//! A load is a box of a length and a width around its reference in the frame of the vehicle. The outline becomes the convex
//! hull of contour and loads; a disc becomes the disc around both.

use super::json_access::JsonObject;
use super::keys::Keys;
use super::{ImportError, VehicleTraits, WarningCode, Warnings, vehicle_heading};
use crate::footprint::Footprint;
use crate::plane_geometry::hull;

const LOAD: Keys =
    Keys::new(&["loadDimensions", "boundingBoxReference"], &["loadId", "loadType", "loadPosition", "weight"])
        .not(&["length", "width"]);
const SIZE: Keys = Keys::new(&["length", "width"], &["height"]);
const REFERENCE: Keys = Keys::new(&["x", "y", "theta"], &["z"]);

/// The vehicle with what the state says that it carries.
pub(super) fn loaded(
    state: &JsonObject<'_>,
    vehicle: &VehicleTraits,
    warnings: &mut Warnings,
) -> Result<VehicleTraits, ImportError> {
    let mut corners = Vec::new();
    for (k, value) in state.list("loads")?.iter().enumerate() {
        let load = JsonObject::new(format!("{}, load {}", state.name, k + 1), value)?;
        LOAD.check(&load, warnings)?;
        let size = load.object("loadDimensions")?;
        if let Some(size) = &size {
            SIZE.check(size, warnings)?;
        }
        let given = |field: &str| size.as_ref().map_or(Ok(None), |size| size.number(field));
        let (Some(length), Some(width)) = (given("length")?, given("width")?) else {
            warnings.add(
                WarningCode::AssumedSize,
                &load.name,
                "it has no length and width; the outline of the vehicle is taken for both",
            );
            continue;
        };
        if length <= 0.0 || width <= 0.0 {
            warnings.add(
                WarningCode::AssumedSize,
                &load.name,
                "its length or width is not above 0; the outline of the vehicle is taken for both",
            );
            continue;
        }
        let reference = load.object("boundingBoxReference")?;
        if let Some(reference) = &reference {
            REFERENCE.check(reference, warnings)?;
        }
        if reference.is_none() {
            warnings.add(
                WarningCode::AssumedSize,
                &load.name,
                "it has no boundingBoxReference; it is taken around the reference point",
            );
        }
        let at = reference.as_ref().map_or(Ok([0.0; 2]), JsonObject::point)?;
        let (sin, cos) = reference.map_or(Ok(None), |it| vehicle_heading::theta(&it))?.unwrap_or(0.0).sin_cos();
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
        return Ok(VehicleTraits { radius: reach, ..vehicle.clone() });
    };
    corners.extend(footprint.polygon());
    let outline = Footprint::new(hull(corners));
    let outline = outline.map_err(|problem| state.field_error("loads", problem))?;
    let outline = outline.inflated(footprint.growth());
    Ok(VehicleTraits { radius: outline.circumscribed_radius(), footprint: Some(outline), ..vehicle.clone() })
}
