//! Zone sets, since 3.0: polygons on a map in which vehicles have to do something, or must not be.

use super::decode::DecodeError;
use super::header::message;
use crate::plane_geometry::wrapped;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::f64::consts::{FRAC_PI_2, PI};

/// Least and largest speed to which a zone may limit vehicles \[m/s\].
const SPEEDS: [f64; 2] = [1e-3, 1e4];

/// Largest angle by which a vehicle may travel off the direction of a zone that it has to keep to \[rad\].
const OFF: f64 = 0.1;

message! {
    /// A message with a zone set.
    ZoneSetMessage {
        /// The set.
        zone_set: ZoneSet,
    }
}

/// The zones of a map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ZoneSet {
    /// Map id.
    pub map_id: String,
    /// Id of the set; its content never changes.
    pub zone_set_id: String,
    /// The zones.
    pub zones: Vec<Zone>,
    /// All other fields, kept unchanged.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

/// A zone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Zone {
    /// Id within the set.
    pub zone_id: String,
    /// Its type.
    pub zone_type: String,
    vertices: Vec<Vertex>,
    /// All other fields, kept unchanged.
    #[serde(flatten)]
    pub rest: Map<String, Value>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Vertex {
    x: f64,
    y: f64,
}

/// What a zone means to the traffic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ZoneRule {
    /// No vehicle may be in it.
    Blocked,
    /// The largest speed in it \[m/s\].
    SpeedLimit(f64),
    /// Vehicles keep to a direction.
    OneWay(OneWay),
    /// Only the vehicle itself has to do something with it: it asks before it enters, keeps to its way, does something there, or plans with it.
    OfVehicle,
}

/// A direction of travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OneWay {
    /// \[rad\]
    direction: f64,
    /// Whether the opposite direction is allowed, too.
    both: bool,
    /// Largest angle off it \[rad\].
    off: f64,
}

impl OneWay {
    /// Whether a straight way from one point to another is against it.
    pub fn forbids(&self, from: [f64; 2], to: [f64; 2]) -> bool {
        let travels = (to[1] - from[1]).atan2(to[0] - from[0]);
        let off = wrapped(travels - self.direction).abs();
        let off = if self.both { off.min(PI - off) } else { off };
        off > self.off && from != to
    }
}

impl Zone {
    /// Its corners \[m\].
    pub fn corners(&self) -> Vec<[f64; 2]> {
        self.vertices.iter().map(|vertex| [vertex.x, vertex.y]).collect()
    }

    /// What it means.
    ///
    /// # Errors
    /// [`DecodeError`] for a type that is not supported or not known, and for a value that is missing or out of range.
    pub fn rule(&self) -> Result<ZoneRule, DecodeError> {
        let number = |key: &str| {
            let value = self.rest.get(key).and_then(Value::as_f64);
            value.ok_or_else(|| DecodeError::new(key, "missing, or no number"))
        };
        Ok(match self.zone_type.as_str() {
            "BLOCKED" => ZoneRule::Blocked,
            "SPEED_LIMIT" => {
                let (speed, [least, most]) = (number("maximumSpeed")?, SPEEDS);
                if !(least..=most).contains(&speed) {
                    let why = format!("{speed} is out of range; allowed is {least} to {most}");
                    return Err(DecodeError::new("maximumSpeed", why));
                }
                ZoneRule::SpeedLimit(speed)
            }
            kind @ ("DIRECTED" | "BIDIRECTED") => {
                let (direction, both) = (number("direction")?, kind == "BIDIRECTED");
                // The text of the standard and its schema have different names.
                let named = ["limitation", if both { "bidirectedLimitation" } else { "directedLimitation" }];
                let found = named.iter().find_map(|key| self.rest.get(*key)?.as_str());
                let off = match (found, both) {
                    (Some("SOFT"), _) => return Ok(ZoneRule::OfVehicle),
                    (Some("RESTRICTED"), false) => FRAC_PI_2,
                    (Some("RESTRICTED"), true) | (Some("STRICT"), false) => OFF,
                    (found, _) => {
                        let why = format!(
                            "{} is none of a {kind} zone",
                            found.map_or("nothing".into(), |it| format!("{it:?}"))
                        );
                        return Err(DecodeError::new("limitation", why));
                    }
                };
                ZoneRule::OneWay(OneWay { direction, both, off })
            }
            "RELEASE" | "LINE_GUIDED" | "ACTION" | "PRIORITY" | "PENALTY" => ZoneRule::OfVehicle,
            "COORDINATED_REPLANNING" => {
                let why = "COORDINATED_REPLANNING is not supported: vehicles keep to the way of their orders, and no other way is granted";
                return Err(DecodeError::new("zoneType", why));
            }
            other => return Err(DecodeError::new("zoneType", format!("{other:?} is no type of a zone"))),
        })
    }

    /// How much of a straight way is inside of it \[m\].
    pub fn length_inside(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let corners = self.corners();
        let sides = || corners.iter().zip(corners.iter().cycle().skip(1));
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let mut cuts = vec![0.0, 1.0];
        for (a, b) in sides() {
            let [sx, sy] = [b[0] - a[0], b[1] - a[1]];
            let across = dx * sy - dy * sx;
            let along = ((a[0] - from[0]) * sy - (a[1] - from[1]) * sx) / across;
            if (0.0..=1.0).contains(&along) {
                cuts.push(along);
            }
        }
        cuts.sort_by(f64::total_cmp);
        let is_inside = |[x, y]: [f64; 2]| {
            let passes = |(a, b): &(&[f64; 2], &[f64; 2])| {
                (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
            };
            sides().filter(passes).count() % 2 == 1
        };
        let inside = cuts.windows(2).filter(|pair| {
            let middle = 0.5 * (pair[0] + pair[1]);
            is_inside([from[0] + middle * dx, from[1] + middle * dy])
        });
        inside.map(|pair| pair[1] - pair[0]).sum::<f64>() * dx.hypot(dy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn zone(more: &Value) -> Zone {
        // An L: the corner at the top right is missing.
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 2.0], [2.0, 4.0], [0.0, 4.0]];
        let vertices: Vec<Value> = corners.iter().map(|[x, y]| json!({ "x": x, "y": y })).collect();
        let mut zone = json!({ "zoneId": "z", "zoneType": "BLOCKED", "vertices": vertices });
        zone.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        serde_json::from_value(zone).unwrap()
    }

    #[test]
    fn the_part_of_a_way_in_a_zone_is_measured() {
        let zone = zone(&json!({}));
        for (from, to, length) in [
            ([-1.0, 1.0], [5.0, 1.0], 4.0),
            ([-1.0, 3.0], [5.0, 3.0], 2.0),
            ([3.0, 3.0], [3.0, 5.0], 0.0),
            ([1.0, 1.0], [1.0, 3.0], 2.0),
            ([1.0, 3.5], [3.5, 1.0], 2.0 * 2.0_f64.sqrt()),
            ([9.0, 9.0], [9.0, 9.0], 0.0),
        ] {
            assert!(
                (zone.length_inside(from, to) - length).abs() < 1e-9,
                "{from:?} {to:?}: {}",
                zone.length_inside(from, to)
            );
        }
    }

    #[test]
    fn directions_forbid_what_the_standard_says() {
        let forbids = |kind: &str, limitation: &str, degrees: f64| {
            let zone = zone(&json!({ "zoneType": kind, "direction": 0.0, "limitation": limitation }));
            let to = [degrees.to_radians().cos(), degrees.to_radians().sin()];
            matches!(zone.rule(), Ok(ZoneRule::OneWay(way)) if way.forbids([0.0; 2], to))
        };
        for (kind, limitation, forbidden) in [
            ("DIRECTED", "SOFT", [false; 4]),
            ("DIRECTED", "RESTRICTED", [false, false, true, true]),
            ("DIRECTED", "STRICT", [false, true, true, true]),
            ("BIDIRECTED", "SOFT", [false; 4]),
            ("BIDIRECTED", "RESTRICTED", [false, true, true, false]),
        ] {
            let found = [3.0, 60.0, -120.0, 180.0].map(|degrees| forbids(kind, limitation, degrees));
            assert_eq!(found, forbidden, "{kind} {limitation}");
        }
    }

    #[test]
    fn what_cannot_be_kept_is_refused() {
        let refused = |more: Value| zone(&more).rule().unwrap_err().field;
        assert_eq!(refused(json!({ "zoneType": "COORDINATED_REPLANNING" })), "zoneType");
        assert_eq!(refused(json!({ "zoneType": "blocked" })), "zoneType");
        assert_eq!(refused(json!({ "zoneType": "SPEED_LIMIT" })), "maximumSpeed");
        assert_eq!(refused(json!({ "zoneType": "SPEED_LIMIT", "maximumSpeed": 0.0 })), "maximumSpeed");
        assert_eq!(refused(json!({ "zoneType": "DIRECTED", "limitation": "SOFT" })), "direction");
        assert_eq!(refused(json!({ "zoneType": "DIRECTED", "direction": 0.0 })), "limitation");
        assert_eq!(
            refused(json!({ "zoneType": "BIDIRECTED", "direction": 0.0, "limitation": "STRICT" })),
            "limitation"
        );
        let other = zone(&json!({ "zoneType": "DIRECTED", "direction": 0.0, "directedLimitation": "STRICT" }));
        assert!(other.rule().is_ok(), "as the text of the standard has it");
    }
}
