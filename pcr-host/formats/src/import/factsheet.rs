//! Factsheets of VDA 5050 (2.x and 3.0): the contour of a vehicle and its limits.

use super::json_access::JsonObject;
use super::keys::Keys;
use super::vehicle::FileVehicleTraits;
use super::{ImportError, WarningCode, Warnings};
use crate::footprint::Footprint;
use crate::json::JsonNode;
use crate::plane_geometry::hull;

/// Names of a member in versions 3 and 2.
type FieldNames = [&'static str; 2];

const ROOT: Keys = Keys::new(
    &["typeSpecification", "physicalParameters", "mobileRobotGeometry", "agvGeometry"],
    &[
        "headerId",
        "timestamp",
        "version",
        "manufacturer",
        "serialNumber",
        "protocolLimits",
        "protocolFeatures",
        "loadSpecification",
        "vehicleConfig",
        "mobileRobotConfiguration",
        "localizationParameters",
    ],
)
.not(&["envelopes2d", "polygonPoints", "vertices", "length", "width"]);

const TYPE: Keys = Keys::new(
    &["seriesName"],
    &[
        "seriesDescription",
        "agvKinematic",
        "agvKinematics",
        "agvClass",
        "mobileRobotKinematics",
        "mobileRobotClass",
        "maxLoadMass",
        "maximumLoadMass",
        "localizationTypes",
        "navigationTypes",
        "supportedZones",
    ],
);

const PHYSICAL: Keys = Keys::new(
    &[
        "maximumSpeed",
        "speedMax",
        "maximumDeceleration",
        "decelerationMax",
        "maximumAcceleration",
        "accelerationMax",
        "maximumAngularSpeed",
        "angularSpeedMax",
        "length",
        "width",
    ],
    &[
        "minimumSpeed",
        "speedMin",
        "minimumAngularSpeed",
        "angularSpeedMin",
        "minimumHeight",
        "maximumHeight",
        "heightMin",
        "heightMax",
    ],
);

const GEOMETRY: Keys =
    Keys::new(&["envelopes2d"], &["wheelDefinitions", "envelopes3d"]).not(&["polygonPoints", "vertices"]);

const ENVELOPE: Keys = Keys::new(&["vertices", "polygonPoints"], &["set", "envelope2dId", "description"]);

const POINT: Keys = Keys::new(&["x", "y"], &[]);

/// Whether a JSON value looks like one.
pub(super) fn is_factsheet(root: &JsonNode<'_>) -> bool {
    ["physicalParameters", "mobileRobotGeometry", "agvGeometry"].iter().any(|member| root.get(member).is_some())
}

/// Reads one: the contour in it, the hull of several or, if there is none, the rectangle of length and width around the reference point.
pub(super) fn read(value: &JsonNode<'_>, warnings: &mut Warnings) -> Result<FileVehicleTraits, ImportError> {
    let root = JsonObject::new("factsheet", value)?;
    ROOT.check(&root, warnings)?;
    let mut given = FileVehicleTraits::default();
    if let Some(kind) = root.object("typeSpecification")? {
        TYPE.check(&kind, warnings)?;
        given.name = kind.label("seriesName")?;
    }
    let physical = root.object("physicalParameters")?;
    if let Some(physical) = &physical {
        PHYSICAL.check(physical, warnings)?;
        given.speed = either(physical, ["maximumSpeed", "speedMax"])?;
        let braking = either(physical, ["maximumDeceleration", "decelerationMax"])?;
        let speeding = either(physical, ["maximumAcceleration", "accelerationMax"])?;
        given.acceleration = [speeding, braking].into_iter().flatten().reduce(f64::min);
        given.rotation = either(physical, ["maximumAngularSpeed", "angularSpeedMax"])?;
    }
    let geometry = root.object("mobileRobotGeometry")?.map_or_else(|| root.object("agvGeometry"), |it| Ok(Some(it)))?;
    if let Some(geometry) = &geometry {
        GEOMETRY.check(geometry, warnings)?;
    }
    let envelopes = geometry.as_ref().map_or(Ok(&[][..]), |geometry| geometry.list("envelopes2d"))?;
    let polygon = match (envelopes, &physical) {
        ([only], _) => Some(polygon(only, warnings)?),
        ([], Some(physical)) => rectangle(physical, warnings)?,
        ([], None) => None,
        (several, _) => {
            warnings.add(
                WarningCode::VehiclesDiffer,
                "envelopes2d",
                format!("there are {}; the convex hull of all is taken", several.len()),
            );
            let corners = several.iter().map(|one| polygon(one, warnings)).collect::<Result<Vec<_>, _>>()?;
            if let Some(empty) = corners.iter().position(Vec::is_empty) {
                let at = several.get(empty).map_or(value.position, |one| one.position);
                return Err(ImportError::in_json(at, format!("factsheet, envelopes2d {}: 0 corners", empty + 1)));
            }
            Some(hull(corners.concat()))
        }
    };
    if let Some(polygon) = polygon {
        let footprint = Footprint::new(polygon);
        given.footprint = Some(footprint.map_err(|problem| root.field_error("envelopes2d", problem))?);
    }
    Ok(given)
}

/// A number above zero by either of its names, or by both; 0 is what senders write that do not know it.
fn either(object: &JsonObject<'_>, names: FieldNames) -> Result<Option<f64>, ImportError> {
    let [mut found, mut other] = [None; 2];
    for name in names {
        if object.number(name)?.is_some_and(|number| number != 0.0) {
            other = std::mem::replace(&mut found, object.positive(name)?);
        }
    }
    if other.is_some_and(|other| found != Some(other)) {
        let [third, second] = names;
        return Err(object.error(format_args!("its {third} is not its {second}")));
    }
    Ok(found)
}

fn polygon(envelope: &JsonNode<'_>, warnings: &mut Warnings) -> Result<Vec<[f64; 2]>, ImportError> {
    let envelope = JsonObject::new("factsheet, envelopes2d", envelope)?;
    ENVELOPE.check(&envelope, warnings)?;
    let points = match envelope.list("vertices")? {
        [] => envelope.list("polygonPoints")?,
        vertices => vertices,
    };
    let corner = |(k, point)| {
        let point = JsonObject::new(format!("{}, point {}", envelope.name, k + 1), point)?;
        POINT.check(&point, warnings)?;
        point.point()
    };
    points.iter().enumerate().map(corner).collect()
}

fn rectangle(physical: &JsonObject<'_>, warnings: &mut Warnings) -> Result<Option<Vec<[f64; 2]>>, ImportError> {
    let (length, width) = match (physical.positive("length")?, physical.positive("width")?) {
        (Some(length), Some(width)) => (length, width),
        (None, None) => return Ok(None),
        (Some(_), None) => return Err(physical.missing("width")),
        (None, Some(_)) => return Err(physical.missing("length")),
    };
    warnings.add(
        WarningCode::AssumedSize,
        "contour",
        "not in the file; its length and width are taken around the reference point",
    );
    let (ahead, left) = (0.5 * length, 0.5 * width);
    Ok(Some(vec![[ahead, left], [-ahead, left], [-ahead, -left], [ahead, -left]]))
}
