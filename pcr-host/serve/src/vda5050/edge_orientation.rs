//! Which way a vehicle with an outline faces on an edge of an order.

use pcr_formats::vda5050::decode::DecodeError;
use pcr_formats::vda5050::order::OrderEdge;
use serde_json::Value;
use std::f64::consts::TAU;

/// The heading of a vehicle on an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum EdgeOrientation {
    /// At this angle to the direction of travel \[rad\].
    Tangential(f64),
    /// At this angle on the map \[rad\].
    Global(f64),
}

impl EdgeOrientation {
    /// Returns the heading on an edge, and why the vehicle may have another one on it, if so. Without an orientation it faces ahead.
    ///
    /// # Errors
    /// [`DecodeError`] for an orientation that cannot be one in radians, and for a type of orientations that is not known.
    pub(super) fn of(edge: &OrderEdge, place: usize) -> Result<(Self, Option<String>), DecodeError> {
        let refused = |field: &str, why: String| Err(DecodeError::new(format!("edges[{place}].{field}"), why));
        let angle = match edge.rest.get("orientation") {
            None | Some(Value::Null) => 0.0,
            Some(value) => match value.as_f64().filter(|angle| angle.abs() <= TAU + 1e-6) {
                Some(angle) => angle,
                None => return refused("orientation", format!("{value} is no angle of up to one turn in radians")),
            },
        };
        let is_given = edge.rest.get("orientation").is_some_and(|value| !value.is_null());
        let own = match edge.rest.get("orientationType").and_then(Value::as_str) {
            Some(kind) if is_given && kind.eq_ignore_ascii_case("GLOBAL") => Self::Global(angle),
            Some(kind) if !kind.eq_ignore_ascii_case("TANGENTIAL") && !kind.eq_ignore_ascii_case("GLOBAL") => {
                return refused("orientationType", format!("{kind:?} is neither TANGENTIAL nor GLOBAL"));
            }
            _ => Self::Tangential(angle),
        };
        let is = |field: &str, value: bool| edge.rest.get(field).and_then(Value::as_bool) == Some(value);
        let may_turn = if is("rotationAllowed", true) {
            Some(format!("it may rotate on edges[{place}]"))
        } else if is("reachOrientationBeforeEntering", false) {
            Some(format!("it need not have its orientation before it enters edges[{place}]"))
        } else {
            None
        };
        Ok((own, may_turn))
    }
}
