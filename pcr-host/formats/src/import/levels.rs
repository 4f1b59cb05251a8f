//! The vertices of the levels of an Open-RMF building, and where the levels are: from pixels of their floor plans to
//! metres, as its building tools do.
//!
//! Measurements give the scale of the reference level, which is the first one unless the building names another. The
//! other levels are laid upon it by the fiducials that both have: their bearings and distances to one another give the
//! rotation and the scale, and their places the translation, each as a mean.

use super::json_access::JsonObject;
use super::projection::{Projection, ProjectionError};
use super::{ImportError, WarningCode, Warnings};
use crate::json::JsonNode;
use std::fmt;

/// Relative difference of two scales of a level that goes without a warning.
const SPREAD: f64 = 0.01;

/// From the coordinates of a file to metres, y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LevelTransform {
    /// From a floor plan, y down; or from metres.
    Plan(FloorPlan),
    /// From longitudes and latitudes.
    Earth(Projection),
}

impl LevelTransform {
    /// From metres, y up.
    pub(super) const METRES: Self = Self::Plan(FloorPlan::METRES);

    /// The point in metres.
    ///
    /// # Errors
    /// [`ProjectionError::OutOfRange`] if the projection does not reach as far.
    pub(super) fn apply(&self, at: [f64; 2]) -> Result<[f64; 2], ProjectionError> {
        match self {
            Self::Plan(plan) => Ok(plan.apply(at)),
            Self::Earth(projection) => projection.apply(at),
        }
    }
}

/// From a floor plan, y down, to metres, y up: scaled, rotated and moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FloorPlan {
    /// Metres of a unit of the plan, to the right and down.
    scale: [f64; 2],
    /// Cosine and sine of the rotation.
    turn: [f64; 2],
    /// \[m\]
    shift: [f64; 2],
}

impl FloorPlan {
    /// Coordinates in metres, y up.
    const METRES: Self = Self { scale: [1.0; 2], turn: [1.0, 0.0], shift: [0.0; 2] };

    /// Scaled only.
    fn scaled(scale: f64) -> Self {
        Self { scale: [scale, -scale], ..Self::METRES }
    }

    /// A point of the plan in metres.
    fn apply(&self, at: [f64; 2]) -> [f64; 2] {
        let [x, y] = [0, 1].map(|k| at[k] * self.scale[k]);
        let [cos, sin] = self.turn;
        [cos * x - sin * y + self.shift[0], sin * x + cos * y + self.shift[1]]
    }
}

/// The level that all others are laid upon.
#[derive(Default)]
pub(super) struct ReferenceLevel<'j> {
    name: String,
    /// Metres of a pixel; `None` without measurements.
    scale: Option<f64>,
    fiducials: Vec<Fiducial<'j>>,
}

/// A point of the building that several levels have.
#[derive(Clone, Copy, Debug)]
struct Fiducial<'j> {
    /// Its name as it is written.
    name: &'j str,
    /// The value that its name stands for.
    value: &'j JsonNode<'j>,
    /// In pixels.
    at: [f64; 2],
}

impl Fiducial<'_> {
    /// Whether both have the same name; nothing if programs differ about it, which compare texts (C++) or values (Python: `1`, `1.0` and
    /// `true` are equal, `1` and `"1"` are not).
    fn is_called_as(&self, other: &Self) -> Option<bool> {
        let number = |value: &JsonNode<'_>| value.as_f64().or_else(|| value.as_bool().map(f64::from));
        let by_value = match [self.value, other.value].map(number) {
            [Some(a), Some(b)] => a == b,
            _ => self.value == other.value,
        };
        (by_value == (self.name == other.name)).then_some(by_value)
    }
}

impl<'j> ReferenceLevel<'j> {
    /// The level of this name, which the building gives, or which is the first one of its file.
    pub(super) fn new(
        levels: &[BuildingLevel<'j>],
        named: Option<&str>,
        warnings: &mut Warnings,
    ) -> Result<Self, ImportError> {
        let level = match named {
            Some(name) => levels
                .iter()
                .find(|level| level.name == name)
                .ok_or_else(|| ImportError::new(format!("building, reference_level_name: there is no level {name}")))?,
            None => return Ok(Self::default()),
        };
        let scale = scale(level, warnings)?;
        Ok(Self { name: level.name.to_owned(), scale, fiducials: fiducials(level)? })
    }

    /// Where a level is.
    pub(super) fn level_transform(
        &self,
        level: &BuildingLevel<'_>,
        warnings: &mut Warnings,
    ) -> Result<LevelTransform, ImportError> {
        if level.name == self.name {
            return self
                .scale
                .map(|scale| LevelTransform::Plan(FloorPlan::scaled(scale)))
                .ok_or_else(|| no_scale(level));
        }
        let mut pairs = Vec::new();
        for own in &fiducials(level)? {
            for known in &self.fiducials {
                match known.is_called_as(own) {
                    Some(true) => pairs.push([known.at, own.at]),
                    Some(false) => {}
                    None => {
                        let [there, here] = [known, own].map(|fiducial| fiducial.value);
                        let problem = format!(
                            "{here}, and {there} in level {}; the programs of Open-RMF differ on whether these are one name",
                            self.name
                        );
                        return Err(level.object.field_error("fiducials", problem));
                    }
                }
            }
        }
        let measured = scale(level, warnings)?;
        match (self.laid_upon(&pairs), measured) {
            (Some((scale, placing, spread)), measured) => {
                if spread > SPREAD {
                    let problem = "its fiducials give scales that differ from their mean by up to";
                    warnings.add(
                        WarningCode::UncertainScale,
                        &level.object.name,
                        format!("{problem} {:.1} %", 100.0 * spread),
                    );
                }
                if let Some(measured) = measured
                    && (measured / scale - 1.0).abs() > SPREAD
                {
                    let more = 100.0 * (measured / scale - 1.0);
                    let problem = format!("its measurements give a scale that differs by {more:+.1} %");
                    warnings.add(
                        WarningCode::UncertainScale,
                        &level.object.name,
                        format!("{problem}; that of its fiducials counts, as for Open-RMF"),
                    );
                }
                Ok(LevelTransform::Plan(placing))
            }
            (None, Some(measured)) => {
                let problem = match self.scale {
                    Some(_) => format!("no two fiducials place it upon level {}", self.name),
                    None => format!("level {}, upon which it belongs, has no measurements", self.name),
                };
                warnings.add(
                    WarningCode::UncertainScale,
                    &level.object.name,
                    format!("{problem}; it has the scale of its own measurements"),
                );
                Ok(LevelTransform::Plan(FloorPlan::scaled(measured)))
            }
            (None, None) => Err(no_scale(level)),
        }
    }

    /// The scale \[m\] and place of a level by pairs of fiducials, that of the reference level first, and by how much of their mean
    /// the scales of the pairs differ.
    fn laid_upon(&self, pairs: &[[[f64; 2]; 2]]) -> Option<(f64, FloorPlan, f64)> {
        // Bearings of plans with y down are mirrored.
        let between = |a: [f64; 2], b: [f64; 2]| [b[0] - a[0], a[1] - b[1]];
        let (mut ratios, mut turn) = (Vec::new(), [0.0; 2]);
        for (k, a) in pairs.iter().enumerate() {
            for b in &pairs[k + 1..] {
                let [reference, own] = [between(a[0], b[0]), between(a[1], b[1])];
                ratios.push(own[0].hypot(own[1]) / reference[0].hypot(reference[1]));
                let angle = reference[1].atan2(reference[0]) - own[1].atan2(own[0]);
                turn = [turn[0] + angle.cos(), turn[1] + angle.sin()];
            }
        }
        let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
        let ratio = Some(mean).filter(|ratio| ratio.is_finite() && *ratio > 0.0)?;
        let spread = ratios.iter().map(|one| (one / ratio - 1.0).abs()).fold(0.0, f64::max);
        let of_reference = self.scale?;
        let scale = of_reference / ratio;
        let angle = turn[1].atan2(turn[0]);
        let turned = FloorPlan { turn: [angle.cos(), angle.sin()], ..FloorPlan::scaled(scale) };
        let reference = FloorPlan::scaled(of_reference);
        let mut shift = [0.0; 2];
        for pair in pairs {
            let [there, here] = [reference.apply(pair[0]), turned.apply(pair[1])];
            shift = [0, 1].map(|k| shift[k] + (there[k] - here[k]) / pairs.len() as f64);
        }
        Some((scale, FloorPlan { shift, ..turned }, spread))
    }
}

fn no_scale(level: &BuildingLevel<'_>) -> ImportError {
    level.object.field_error("measurements", "none that gives the scale of its pixels")
}

/// The fiducials of a level. One that cannot be read is an error even if parts may be left out: the level would have another scale.
fn fiducials<'j>(level: &BuildingLevel<'j>) -> Result<Vec<Fiducial<'j>>, ImportError> {
    let mut all: Vec<Fiducial<'j>> = Vec::new();
    for (k, value) in level.object.list("fiducials")?.iter().enumerate() {
        let refused = |problem: String| {
            let problem = format!("{}, fiducial {k}: {problem}", level.object.name);
            Err(ImportError::in_json(value.position, problem))
        };
        let number = |place: usize| value.element(place).and_then(JsonNode::as_f64);
        let name = level.text(&["fiducials"], &[k, 2]).zip(value.element(2));
        let (Some(x), Some(y), Some((name, value))) = (number(0), number(1), name) else {
            return refused("no place and name".into());
        };
        if all.iter().any(|known| known.name == name) {
            return refused(format!("another one is {name}"));
        }
        all.push(Fiducial { name, value, at: [x, y] });
    }
    Ok(all)
}

/// A level of the file: its values, and its scalars as they are written.
pub(super) struct BuildingLevel<'j> {
    pub(super) name: &'j str,
    pub(super) object: JsonObject<'j>,
    /// `None` where the file has no level of this name.
    texts: Option<&'j JsonNode<'j>>,
    pub(super) vertices: Vec<PlacedVertex>,
}

/// Position as in the file, and name; `None` for what is no vertex.
pub(super) type PlacedVertex = Option<([f64; 2], Option<String>)>;

impl<'j> BuildingLevel<'j> {
    /// A level of a building, or of a `graph` for navigation.
    pub(super) fn new(
        name: &'j str,
        value: &'j JsonNode<'j>,
        texts: Option<&'j JsonNode<'j>>,
        graph: bool,
    ) -> Result<Self, ImportError> {
        let object = JsonObject::new(format!("level {name}"), value)?;
        let mut level = Self { name, object, texts, vertices: Vec::new() };
        let all = level.object.list("vertices")?.iter().enumerate();
        level.vertices = all.map(|(k, value)| level.vertex(k, value, graph)).collect();
        Ok(level)
    }

    /// A scalar as it is written, by its member and its places in lists.
    fn text(&self, members: &[&str], places: &[usize]) -> Option<&'j str> {
        let member = members.iter().try_fold(self.texts?, |value, member| value.get(member))?;
        places.iter().try_fold(member, |value, place| value.element(*place))?.as_str()
    }

    /// A vertex, whose name may be any scalar.
    fn vertex(&self, k: usize, value: &JsonNode<'_>, graph: bool) -> PlacedVertex {
        let list = value.as_array()?;
        let number = |k: usize| list.get(k)?.as_f64().filter(|x| x.abs() <= crate::scenario::LIMIT);
        let name = if graph {
            let parameters = self.texts.and_then(|texts| texts.get("vertices")?.element(k)?.element(2)?.get("name"));
            parameters.and_then(JsonNode::as_str)
        } else {
            self.text(&["vertices"], &[k, 3])
        };
        Some(([number(0)?, number(1)?], name.filter(|name| !name.is_empty()).map(str::to_owned)))
    }
}

/// The value of a parameter, which is a list of its type and itself; a list without it is no value, and given as it is.
pub(super) fn parameter<'j>(parameters: Option<&'j JsonNode<'j>>, name: &str) -> Option<&'j JsonNode<'j>> {
    let given = parameters?.get(name)?;
    Some(given.as_array().and_then(|typed| typed.get(1)).unwrap_or(given))
}

/// Why ends are none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum EndsError {
    /// They are not in a list.
    List,
    /// They are not two numbers of vertices.
    Numbers,
    /// There is no vertex of this number.
    Vertex(u64),
}

impl fmt::Display for EndsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::List => f.write_str("not a list"),
            Self::Numbers => f.write_str("two numbers of vertices are expected"),
            Self::Vertex(place) => write!(f, "there is no vertex {place}"),
        }
    }
}

/// Ends of a lane, a wall or a measurement.
pub(super) fn ends(value: &JsonNode<'_>, vertices: &[PlacedVertex]) -> Result<[(usize, [f64; 2]); 2], EndsError> {
    let list = value.as_array().ok_or(EndsError::List)?;
    let mut ends = [(0, [0.0; 2]); 2];
    for (k, end) in ends.iter_mut().enumerate() {
        let place = list.get(k).and_then(JsonNode::as_u64).ok_or(EndsError::Numbers)?;
        let vertex =
            usize::try_from(place).ok().and_then(|place| vertices.get(place)?.as_ref().map(|vertex| (place, vertex.0)));
        *end = vertex.ok_or(EndsError::Vertex(place))?;
    }
    Ok(ends)
}

/// Metres of a pixel: the mean of the measurements of a level; `None` without any.
fn scale(level: &BuildingLevel<'_>, warnings: &mut Warnings) -> Result<Option<f64>, ImportError> {
    let mut scales = Vec::new();
    for (k, value) in level.object.list("measurements")?.iter().enumerate() {
        let metres = parameter(value.element(2), "distance").and_then(JsonNode::as_f64);
        let scale = ends(value, &level.vertices)
            .ok()
            .zip(metres)
            .map(|([(_, a), (_, b)], metres)| metres / (a[0] - b[0]).hypot(a[1] - b[1]));
        match scale.filter(|scale| (1e-9..1e9).contains(scale)) {
            Some(scale) => scales.push(scale),
            // The building tools do not leave it out: they count a distance of 0, and stop if there is none. Without it the level would have
            // another scale, so that it is an error even if parts may be left out.
            None => {
                let problem = format!("{}, measurement {k}: it gives no scale", level.object.name);
                return Err(ImportError::in_json(value.position, problem));
            }
        }
    }
    if scales.is_empty() {
        return Ok(None);
    }
    let mean = scales.iter().sum::<f64>() / scales.len() as f64;
    let spread = scales.iter().map(|scale| (scale / mean - 1.0).abs()).fold(0.0, f64::max);
    if spread > SPREAD {
        let percent = 100.0 * spread;
        warnings.add(
            WarningCode::UncertainScale,
            &level.object.name,
            format!("its measurements differ from their mean by up to {percent:.1} %"),
        );
    }
    Ok(Some(mean))
}
