//! Corridors of VDA 5050 and LIF: room beside an edge that a vehicle may use to go round obstacles.
//!
//! Anywhere in it the vehicle counts as being: the circle around its reference point that it may be in is as wide as the wider side.
//! How it turns there is not said, so that an outline has any heading.

use super::json_access::JsonObject;
use super::keys::Keys;
use super::vehicle::{Facing, VehicleTraits};
use super::{ImportError, LayoutEdge, WarningCode, Warnings};

/// Keys in VDA 5050 2.1, in 3.0, and in LIF 2.
const KEYS: Keys = Keys::new(
    &["leftWidth", "rightWidth", "maximumLeftWidth", "maximumRightWidth", "corridorRefPoint", "corridorReferencePoint"],
    &["releaseRequired", "releaseLossBehavior"],
);

/// How far the reference point of a vehicle may be from its edge \[m\]; `None` without a corridor.
pub(super) fn read(
    of: &JsonObject<'_>,
    vehicle: &VehicleTraits,
    warnings: &mut Warnings,
) -> Result<Option<f64>, ImportError> {
    let Some(corridor) = of.object("corridor")? else { return Ok(None) };
    KEYS.check(&corridor, warnings)?;
    let width = |names: [&str; 2]| -> Result<f64, ImportError> {
        let [first, second] = names.map(|name| corridor.number(name));
        let widths = [first?, second?];
        let width = widths.into_iter().flatten().reduce(f64::max).ok_or_else(|| corridor.missing(names[0]))?;
        if widths.into_iter().flatten().any(|width| width < 0.0) {
            return Err(corridor.error(format_args!("a width of {width} m; widths are from 0")));
        }
        Ok(width)
    };
    let widest = width(["leftWidth", "maximumLeftWidth"])?.max(width(["rightWidth", "maximumRightWidth"])?);
    let mut is_of_contour = None;
    for name in ["corridorRefPoint", "corridorReferencePoint"] {
        let of_contour = match corridor.text(name)? {
            None => continue,
            Some("KINEMATICCENTER" | "KINEMATIC_CENTER") => false,
            Some("CONTOUR") => true,
            Some(other) => return Err(corridor.field_error(name, format_args!("{other} is not read"))),
        };
        // Of two that differ the one counts that leaves more room.
        is_of_contour = Some(of_contour && is_of_contour.unwrap_or(true));
    }
    // Without a word it is that of the kinematic center.
    if !is_of_contour.unwrap_or(false) {
        return Ok(Some(widest));
    }
    let inner = vehicle.inner_radius();
    if widest < inner {
        let problem =
            format!("its corridor is for the contour, and narrower than the vehicle ({inner:.3} m to either side)");
        warnings.add(WarningCode::RadiusBelowOutline, &of.name, problem);
    }
    Ok(Some((widest - inner).max(0.0)))
}

impl LayoutEdge {
    /// Gives the edge a corridor, in which the vehicle may be as far as this from it \[m\], and face any way.
    pub(super) fn widen(&mut self, room: f64) {
        if room > 0.0 {
            self.room += room;
            self.deviation += room;
            self.facing = [Facing::Any; 2];
        }
    }
}
