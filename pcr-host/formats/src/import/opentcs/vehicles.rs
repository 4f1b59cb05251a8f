//! What a model of openTCS says about its vehicles, where nothing else does: the rectangle that covers the bounding boxes of all,
//! and the least of their speeds.
//!
//! The reference point of a box may be off its middle; the rectangle is as large to the other side. Each vehicle has to have a box, if
//! any has: that of the others says nothing about it. Models before version 6 have no boxes, and lengths of vehicles.

use super::super::vehicle::FileVehicleTraits;
use super::super::xml::{children, only, optional, parse};
use super::super::{ImportError, ImportOptions, LayoutEdge, WarningCode, Warnings};
use super::{MILLI, metres};
use crate::footprint::Footprint;
use std::fmt;

/// How far a vehicle reaches ahead and aside of its reference point \[m\].
type HalfExtents = [f64; 2];

/// Adds what the model says to what is given.
pub(in super::super) fn vehicles(
    text: &str,
    options: &ImportOptions,
    given: &mut FileVehicleTraits,
    warnings: &mut Warnings,
) -> Result<(), ImportError> {
    let document = parse(text)?;
    let all = children(document.root_element(), "vehicle").map(OpenTcsVehicle::new).collect::<Result<Vec<_>, _>>()?;
    slowest(&all, options, given, warnings);
    if given.radius.is_some() || given.footprint.is_some() {
        return Ok(());
    }
    warn_of_lengths(&all, options, warnings);
    let Some([ahead, left]) = largest(&all, options, warnings) else { return Ok(()) };
    let corners = vec![[ahead, left], [-ahead, left], [-ahead, -left], [ahead, -left]];
    let outline = Footprint::new(corners);
    let outline = outline.map_err(|problem| ImportError::new(format!("vehicle, boundingBox: {problem}")))?;
    given.footprint = Some(outline);
    Ok(())
}

/// Limits the speeds backward to the least of the vehicles.
pub(super) fn limit_backward(
    root: roxmltree::Node<'_, '_>,
    edges: &mut [LayoutEdge],
    warnings: &mut Warnings,
) -> Result<(), ImportError> {
    let mut ways: Vec<&mut LayoutEdge> = edges.iter_mut().filter(|edge| edge.ways[1]).collect();
    for vehicle in children(root, "vehicle") {
        let name = named(vehicle);
        match metres(vehicle, &name, "maxReverseVelocity")? {
            Some(0.0) if !ways.is_empty() => {
                warnings.add(
                    WarningCode::DrivesBackward,
                    name,
                    "its maxReverseVelocity is 0; it is taken to drive backward all the same",
                );
            }
            Some(own) if own > 0.0 => {
                ways.iter_mut()
                    .for_each(|edge| edge.speed[1] = edge.speed[1].map_or(Some(own), |speed| Some(speed.min(own))));
            }
            _ => {}
        }
    }
    Ok(())
}

fn named(vehicle: roxmltree::Node<'_, '_>) -> String {
    format!("vehicle {}", vehicle.attribute("name").unwrap_or_default())
}

/// A length or width of the box of a vehicle that is missing or no size.
struct BoxError {
    vehicle: String,
    field: &'static str,
    /// Its value, if it is there.
    size: Option<f64>,
}

impl fmt::Display for BoxError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, boundingBox, {}: ", self.vehicle, self.field)?;
        match self.size {
            None => f.write_str("missing"),
            Some(size) => write!(f, "{size} where a number above 0 is expected"),
        }
    }
}

/// A vehicle of the model.
struct OpenTcsVehicle {
    name: String,
    speed: Option<f64>,
    /// Before version 6 \[m\].
    length: Option<f64>,
    /// Its box, or what is wrong with it; `None` where it has none.
    half: Option<Result<HalfExtents, BoxError>>,
    /// Whether its box says where its reference point is.
    is_placed: bool,
}

impl OpenTcsVehicle {
    fn new(vehicle: roxmltree::Node<'_, '_>) -> Result<Self, ImportError> {
        let name = named(vehicle);
        let speed = metres(vehicle, &name, "maxVelocity")?.filter(|speed| *speed > 0.0);
        let sizes = only(vehicle, "boundingBox")?.map(|outline| Sizes::new(outline, &name)).transpose()?;
        let half = sizes.map(|sizes| sizes.half(&name));
        let length = optional(vehicle, &name, "length")?.map(|length| length * MILLI);
        let offsets = ["referenceOffsetX", "referenceOffsetY"];
        let is_placed = only(vehicle, "boundingBox")?.is_none_or(|own| offsets.iter().all(|at| own.has_attribute(*at)));
        Ok(Self { speed, length, half, is_placed, name })
    }
}

/// A box as the file has it: along and across, its size, and how far its middle is from the reference point \[mm\].
struct Sizes([[Option<f64>; 2]; 2]);

impl Sizes {
    const NAMES: [[&'static str; 2]; 2] = [["length", "referenceOffsetX"], ["width", "referenceOffsetY"]];

    fn new(outline: roxmltree::Node<'_, '_>, name: &str) -> Result<Self, ImportError> {
        let name = format!("{name}, boundingBox");
        let mut sizes = [[None; 2]; 2];
        for (size, field) in sizes.as_flattened_mut().iter_mut().zip(Self::NAMES.as_flattened()) {
            *size = optional(outline, &name, field)?;
        }
        Ok(Self(sizes))
    }

    /// Half of the rectangle around the box, or what is wrong with that.
    fn half(&self, name: &str) -> Result<HalfExtents, BoxError> {
        let mut half = [0.0; 2];
        for (half, ([size, offset], [field, _])) in half.iter_mut().zip(self.0.into_iter().zip(Self::NAMES)) {
            *half = match size {
                Some(size) if size > 0.0 => MILLI * (0.5 * size + offset.unwrap_or(0.0).abs()),
                size => return Err(BoxError { vehicle: name.to_owned(), field, size }),
            };
        }
        Ok(half)
    }
}

/// The least of the speeds.
fn slowest(all: &[OpenTcsVehicle], options: &ImportOptions, given: &mut FileVehicleTraits, warnings: &mut Warnings) {
    let speeds = || all.iter().filter_map(|vehicle| vehicle.speed);
    let Some(least) = speeds().reduce(f64::min).filter(|_| given.speed.is_none()) else { return };
    if options.speed.is_none() && speeds().any(|speed| speed != least) {
        warnings.add(
            WarningCode::VehiclesDiffer,
            "vehicles",
            format!("their maxVelocity differs; the least of {least} m/s is taken"),
        );
    }
    given.speed = Some(least);
}

/// Says which vehicles are longer than the disc that stands for them, if nothing but their length is known.
fn warn_of_lengths(all: &[OpenTcsVehicle], options: &ImportOptions, warnings: &mut Warnings) {
    for vehicle in all.iter().filter(|vehicle| vehicle.half.is_none()) {
        if let Some(length) = vehicle.length.filter(|length| options.radius.is_none_or(|radius| 2.0 * radius < *length))
        {
            let problem = format!("it is {length} m long, and the model says nothing more of its outline");
            warnings.add(WarningCode::LongVehicle, &vehicle.name, problem);
        }
    }
}

/// The half that covers those of all vehicles, if there is any. A radius that is asked for is that of all, whatever their boxes are.
fn largest(all: &[OpenTcsVehicle], options: &ImportOptions, warnings: &mut Warnings) -> Option<HalfExtents> {
    let has_box = all.iter().any(|vehicle| vehicle.half.is_some());
    let mut largest: Option<HalfExtents> = None;
    for vehicle in all.iter().filter(|_| has_box) {
        match &vehicle.half {
            Some(Ok(half)) => {
                let before = largest.unwrap_or_default();
                largest = Some([0, 1].map(|k| half[k].max(before[k])));
            }
            _ if options.radius.is_some() => {}
            Some(Err(problem)) => warnings.lose(format_args!("{problem}")),
            None => warnings.lose(format_args!("{}, boundingBox: missing, and others have one", vehicle.name)),
        }
    }
    if options.radius.is_none() {
        for vehicle in all.iter().filter(|vehicle| !vehicle.is_placed) {
            let problem = "its boundingBox does not say where its reference point is; it is taken to be in the middle";
            warnings.add(WarningCode::AssumedSize, &vehicle.name, problem);
        }
    }
    largest
}
