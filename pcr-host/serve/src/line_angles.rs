//! Angles of request lines: radians, or degrees by keys of their own. The journal and all answers are in radians.

use crate::request_error::RequestError;
use serde_json::{Map, Value, json};
use std::f64::consts::TAU;

/// The keys of angles, in radians and in degrees.
const KEYS: [[&str; 2]; 2] = [["heading", "heading_deg"], ["sweep", "sweep_deg"]];

/// An angle in radians above which degrees were probably meant: one turn, which clients may round to four digits.
const MOST: f64 = 1.001 * TAU;

/// Replaces all angles that are given in degrees, in `object` and in what it contains.
///
/// # Errors
/// [`RequestError::Malformed`] with the place of an angle that is given twice, that is no number, or that is more than one turn in
/// radians: nobody reads a warning in the answer of a program, and a path that leads elsewhere would be admitted.
pub(crate) fn to_radians(object: &mut Map<String, Value>) -> Result<(), RequestError> {
    of_object(object, "")
}

fn of_object(object: &mut Map<String, Value>, place: &str) -> Result<(), RequestError> {
    let called = |key: &str| if place.is_empty() { key.to_owned() } else { format!("{place}.{key}") };
    let malformed = |key: &str, why: &str| Err(RequestError::Malformed { why: format!("{}: {why}", called(key)) });
    for [radians, degrees] in KEYS {
        if let Some(angle) = object.remove(degrees) {
            if object.contains_key(radians) {
                return malformed(degrees, &format!("given beside {radians}; give one of the two"));
            }
            let Some(angle) = angle.as_f64() else { return malformed(degrees, "a number of degrees is expected") };
            object.insert(radians.into(), json!(angle.to_radians()));
        } else if let Some(angle) = object.get(radians).and_then(Value::as_f64)
            && angle.abs() > MOST
        {
            return malformed(radians, &format!("{angle} is more than one turn in radians; use {degrees} for degrees"));
        }
    }
    object.iter_mut().try_for_each(|(key, value)| of_value(value, &called(key)))
}

fn of_value(value: &mut Value, place: &str) -> Result<(), RequestError> {
    match value {
        Value::Object(object) => of_object(object, place),
        Value::Array(values) => {
            (0..).zip(values).try_for_each(|(k, value): (usize, _)| of_value(value, &format!("{place}[{k}]")))
        }
        _ => Ok(()),
    }
}
