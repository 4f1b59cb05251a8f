//! Which way a vehicle faces as it travels: an outline is read as if it faced along its path.

use super::value::Object;
use super::{ImportError, Warnings};
use crate::footprint::Footprint;
use std::f64::consts::{PI, TAU};

/// Angle that is rounding in a file and nothing else \[rad\].
const ROUNDING: f64 = 1e-3;

/// Whether an outline at this angle from its path covers what it covers when it faces along it.
pub(super) fn is_ahead(outline: &Footprint, angle: f64) -> bool {
    let is_none = |angle: f64| ((angle + PI).rem_euclid(TAU) - PI).abs() <= ROUNDING;
    is_none(angle) || is_none(angle - PI) && outline.is_same_backward()
}

/// The message about a backward drive that was not read.
pub(super) const BACKWARD: &str = "it is driven backward, and outlines face along their paths here";

/// Whether it matters that the vehicle drives backward: neither to a disc nor to an outline that is the same then.
pub(super) fn is_other_backward(outline: Option<&Footprint>) -> bool {
    outline.is_some_and(|outline| !outline.is_same_backward())
}

/// Adds the message about an orientation that was not read.
pub(super) fn lose(of: &str, field: &str, value: f64, warnings: &mut Warnings) {
    warnings.lose(format_args!("{of}: its {field} {value}, as outlines face along their paths here"));
}

/// Loses the orientation of an edge, in the unit of its field \[rad\], unless that is along its way, of which a straight one has a
/// heading.
pub(super) fn along(
    edge: &Object<'_>,
    field: &str,
    unit: f64,
    heading: Option<f64>,
    outline: &Footprint,
    warnings: &mut Warnings,
) -> Result<(), ImportError> {
    let Some(orientation) = edge.number(field)? else { return Ok(()) };
    let is_global = edge.text("orientationType")?.is_some_and(|kind| kind.eq_ignore_ascii_case("GLOBAL"));
    let ahead = if is_global { heading } else { Some(0.0) };
    if !ahead.is_some_and(|ahead| is_ahead(outline, orientation * unit - ahead)) {
        lose(&edge.name, field, orientation, warnings);
    }
    Ok(())
}
