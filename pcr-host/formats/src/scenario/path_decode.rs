//! Decodes the path of an agent.

use super::angles::{AngleField, Doubts};
use super::file_version::{FACINGS, GEARS, STEADY, VersionFaults};
use super::json_fields::{DecodeLocation, LIMIT, NumberRange, ObjectFields, ScenarioError, brief, figure};
use super::{PathSegment, REVERSE, old_turns};
use crate::json::{JsonData, JsonNode, Position};

/// Segments of a path that the core can number. An arc counts once for each turn begun.
pub(crate) const MOST_SEGMENTS: usize = u16::MAX as usize;

/// The path of an agent, if it is neither too long nor of too many segments.
pub(super) fn path(
    fields: &ObjectFields<'_>,
    place: DecodeLocation<'_>,
    doubts: &mut Doubts,
    versions: &mut VersionFaults,
) -> Result<Vec<PathSegment>, ScenarioError> {
    let given = fields.array("path")?;
    let mut path = Vec::with_capacity(given.len());
    let mut before = 0.0;
    // An arc that stands for a turn was one for which the vehicle stops only where the motion says so.
    let stops = fields.get("profile").is_some() || given.iter().any(|segment| kind(segment) == Some("turn"));
    for (index, json) in given.iter().enumerate() {
        let place = place.part("segment", index);
        let (segment, own) = PathSegment::decode(json, place, doubts)?;
        if let Some(own) = &own {
            let since = |version, field| {
                let problem = format!("it is there from version {version} on; give \"version\": {version}");
                place.error(own.position, field, problem)
            };
            if own.is_steady {
                versions.steady.get_or_insert_with(|| since(STEADY, "steady"));
            } else if own.is_angle {
                versions.facing.get_or_insert_with(|| since(FACINGS, "facing"));
            } else {
                versions.gear.get_or_insert_with(|| since(GEARS, "gear"));
            }
        }
        let segment = match segment {
            PathSegment::Arc { radius: old_turns::RADIUS, sweep, steady: false } if stops => {
                PathSegment::Turn { sweep }
            }
            PathSegment::Arc { radius: old_turns::RADIUS, sweep, steady: false } => PathSegment::Kink { sweep },
            other => other,
        };
        if kind(json) == Some("kink") {
            versions.needs_turns(place, json, "kind");
        }
        // A turn in place goes on as it was before.
        let is_turn = matches!(segment, PathSegment::Turn { .. } | PathSegment::Kink { .. });
        let after = if is_turn { before } else { own.map_or(0.0, |own| own.angle.unwrap_or(before)) };
        if after != before {
            path.push(PathSegment::Facing { before, after });
        }
        before = segment.facing_after(after);
        path.push(segment);
    }
    let length: f64 = path.iter().map(PathSegment::length).sum();
    let segments: f64 = path.iter().map(PathSegment::turns).sum();
    let problem = if length > LIMIT {
        format!("{} m long; allowed is up to {LIMIT:e}", figure(length))
    } else if segments > MOST_SEGMENTS as f64 {
        format!("{segments} segments, each turn of an arc counted; allowed are up to {MOST_SEGMENTS}")
    } else {
        return Ok(path);
    };
    Err(fields.refused("path", problem))
}

/// What a segment in a file is said to be.
pub(super) fn kind<'j>(segment: &'j JsonNode<'_>) -> Option<&'j str> {
    let JsonData::Object(members) = &segment.data else { return None };
    match members.iter().find(|(key, _)| key == "kind").map(|(_, kind)| &kind.data) {
        Some(JsonData::Text(kind)) => Some(kind),
        _ => None,
    }
}

/// The gear of a segment in a file, or the angle from its direction of travel to the heading.
struct GivenFacing {
    position: Position,
    /// \[rad\]; none of a steady segment that goes on as the segment before ends.
    angle: Option<f64>,
    /// Whether the file has `facing` or `facing_deg`, and not `gear`.
    is_angle: bool,
    /// Whether the file has `steady`.
    is_steady: bool,
}

impl GivenFacing {
    /// That of a segment, if one is given.
    fn decode(fields: &ObjectFields<'_>, doubts: &mut Doubts) -> Result<Option<Self>, ScenarioError> {
        let gear = fields.get("gear");
        let angle = AngleField::Facing.keys().iter().find_map(|key| fields.get(key));
        let (gear, angle) = match (gear, angle) {
            (None, None) => return Ok(None),
            (Some(_), Some(_)) => {
                return Err(fields.refused("facing", "given beside gear; reverse gear is the facing of half a turn"));
            }
            (None, Some(angle)) => {
                let position = angle.position;
                let angle = doubts.angle(fields, AngleField::Facing)?;
                return Ok(Some(Self { position, angle: Some(angle), is_angle: true, is_steady: false }));
            }
            (Some(gear), None) => match &gear.data {
                JsonData::Text(name) if name == "reverse" => (gear, REVERSE),
                JsonData::Text(name) if name == "forward" => (gear, 0.0),
                _ => return Err(fields.unexpected("gear", gear, "\"forward\" or \"reverse\"")),
            },
        };
        Ok(Some(Self { position: gear.position, angle: Some(angle), is_angle: false, is_steady: false }))
    }

    /// That of a segment that may be steady, and whether it is: then the angle is that at its start, and the one with which the segment before
    /// ends if none is given.
    fn decode_steady(fields: &ObjectFields<'_>, doubts: &mut Doubts) -> Result<(Option<Self>, bool), ScenarioError> {
        let own = Self::decode(fields, doubts)?;
        let Some(given) = fields.get("steady") else { return Ok((own, false)) };
        let JsonData::Bool(steady) = given.data else {
            return Err(fields.unexpected("steady", given, "true or false"));
        };
        let angle = if steady { None } else { Some(0.0) };
        let own = own.unwrap_or(Self { position: given.position, angle, is_angle: false, is_steady: true });
        Ok((Some(Self { position: given.position, is_steady: true, ..own }), steady))
    }
}

impl PathSegment {
    /// The segment, and its gear or facing if it is given.
    fn decode(
        json: &JsonNode<'_>,
        place: DecodeLocation<'_>,
        doubts: &mut Doubts,
    ) -> Result<(Self, Option<GivenFacing>), ScenarioError> {
        match kind(json) {
            Some("line") => {
                let fields = place.fields(json, &["kind", "length", "gear", "facing", "facing_deg", "steady"])?;
                let length = fields.number("length", NumberRange::NotNegative)?;
                let (own, _) = GivenFacing::decode_steady(&fields, doubts)?;
                Ok((Self::Line { length }, own))
            }
            Some("arc") => {
                let known = ["kind", "radius", "sweep", "sweep_deg", "gear", "facing", "facing_deg", "steady"];
                let fields = place.fields(json, &known)?;
                let radius = fields.number("radius", NumberRange::Positive)?;
                let sweep = doubts.angle(&fields, AngleField::Sweep)?;
                let (own, steady) = GivenFacing::decode_steady(&fields, doubts)?;
                Ok((Self::Arc { radius, sweep, steady }, own))
            }
            Some(of_angle @ ("turn" | "kink")) => {
                let fields = place.fields(json, &["kind", "sweep", "sweep_deg"])?;
                let sweep = doubts.angle(&fields, AngleField::Sweep)?;
                Ok((if of_angle == "turn" { Self::Turn { sweep } } else { Self::Kink { sweep } }, None))
            }
            _ => {
                let fields = place.fields(
                    json,
                    &["kind", "length", "radius", "sweep", "sweep_deg", "gear", "facing", "facing_deg", "steady"],
                )?;
                let kind = fields.required("kind")?;
                Err(fields.error(
                    kind.position,
                    "kind",
                    format!("{}; allowed is \"line\", \"arc\", \"turn\" or \"kink\"", brief(kind)),
                ))
            }
        }
    }
}
