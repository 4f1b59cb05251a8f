//! Outlines in scenario files: radius or footprint, and loads.

use super::LoadOutline;
use super::json_fields::{DecodeLocation, NumberRange, ObjectFields, ScenarioError, brief, figure, parse_integer};
use crate::footprint::Footprint;
use crate::json::{JsonData, JsonNode};

/// The radius and the footprint of what has either.
pub(super) fn outline(
    fields: &ObjectFields<'_>,
    place: DecodeLocation<'_>,
) -> Result<(f64, Option<Footprint>), ScenarioError> {
    if fields.get("footprint").is_none() {
        return Ok((fields.number("radius", NumberRange::Positive)?, None));
    }
    if let Some(radius) = fields.get("radius") {
        return Err(fields.error(radius.position, "radius", "there is a radius or a footprint, not both"));
    }
    let footprint = footprint(fields, place)?;
    Ok((footprint.circumscribed_radius(), Some(footprint)))
}

fn footprint(outer: &ObjectFields<'_>, place: DecodeLocation<'_>) -> Result<Footprint, ScenarioError> {
    let fields = outer.object("footprint", "footprint.", &["polygon", "overhang", "growth"])?;
    let corners = fields.array("polygon")?.iter().enumerate().map(|(index, json)| {
        let corner = place.part("corner", index).fields(json, &["ahead", "left"])?;
        Ok([corner.number("ahead", NumberRange::Any)?, corner.number("left", NumberRange::Any)?])
    });
    let corners = corners.collect::<Result<_, ScenarioError>>()?;
    // Once how far discs that covered it were allowed to reach out of it.
    fields.get("overhang").map(|_| fields.number("overhang", NumberRange::Positive)).transpose()?;
    let growth = fields.get("growth").map_or(Ok(0.0), |_| fields.number("growth", NumberRange::NotNegative))?;
    let footprint = Footprint::new(corners);
    footprint.map(|it| it.inflated(growth)).map_err(|problem| outer.error(fields.position, "footprint", problem))
}

/// The loads of an agent with this many segments.
pub(super) fn loads(agent: &ObjectFields<'_>, segments: usize) -> Result<Vec<LoadOutline>, ScenarioError> {
    if agent.get("loads").is_none() {
        return Ok(Vec::new());
    }
    let mut loads: Vec<LoadOutline> = Vec::new();
    for (index, json) in agent.array("loads")?.iter().enumerate() {
        let place = agent.location.part("load", index);
        let fields = place.fields(json, &["segments", "radius", "footprint"])?;
        let (radius, footprint) = outline(&fields, place)?;
        let range = fields.array("segments")?;
        let ends: Vec<usize> = range.iter().map(|end| segment(&fields, end, segments)).collect::<Result<_, _>>()?;
        let position = fields.required("segments")?.position;
        let &[first, last] = ends.as_slice() else {
            let problem = format!("{} numbers; allowed are the first and the last segment", ends.len());
            return Err(fields.error(position, "segments", problem));
        };
        if last < first || loads.last().is_some_and(|before| first <= before.segments[1]) {
            let problem = format!("{} to {}; allowed are segments after one another", first + 1, last + 1);
            return Err(fields.error(position, "segments", problem));
        }
        loads.push(LoadOutline { segments: [first, last], radius, footprint });
    }
    Ok(loads)
}

/// The place of a segment by its number, which counts from 1.
fn segment(fields: &ObjectFields<'_>, json: &JsonNode<'_>, segments: usize) -> Result<usize, ScenarioError> {
    let number = match &json.data {
        JsonData::Number(text) => parse_integer(text).and_then(|number| usize::try_from(number).ok()),
        _ => None,
    };
    number.and_then(|number| number.checked_sub(1)).filter(|place| *place < segments).ok_or_else(|| {
        let problem = format!("{} where a segment from 1 to {} is expected", brief(json), figure(segments as f64));
        fields.error(json.position, "segments", problem)
    })
}
