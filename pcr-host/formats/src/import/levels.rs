//! The vertices of the levels of an Open-RMF building, and where the levels are: from pixels of their floor plans to
//! metres, as its building tools do.
//!
//! Measurements give the scale of the reference level, which is the first one unless the building names another. The
//! other levels are laid upon it by the fiducials that both have: their bearings and distances to one another give the
//! rotation and the scale, and their places the translation, each as a mean.

use super::value::Object;
use super::{ImportError, WarningCode, Warnings};
use crate::yaml::Document;
use serde_json::Value;

/// Relative difference of two scales of a level that goes without a warning.
const SPREAD: f64 = 0.01;

/// From a floor plan, y down, to metres, y up: scaled, rotated and moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placing {
    /// Metres of a unit of the plan, to the right and down.
    scale: [f64; 2],
    /// Cosine and sine of the rotation.
    turn: [f64; 2],
    /// \[m\]
    shift: [f64; 2],
}

impl Placing {
    /// Coordinates in metres, y up.
    pub(super) const METRES: Self = Self { scale: [1.0; 2], turn: [1.0, 0.0], shift: [0.0; 2] };

    /// Scaled only.
    fn scaled(scale: f64) -> Self {
        Self { scale: [scale, -scale], ..Self::METRES }
    }

    /// A point of the plan in metres.
    pub(super) fn apply(&self, at: [f64; 2]) -> [f64; 2] {
        let [x, y] = [0, 1].map(|k| at[k] * self.scale[k]);
        let [cos, sin] = self.turn;
        [cos * x - sin * y + self.shift[0], sin * x + cos * y + self.shift[1]]
    }
}

/// The level that all others are laid upon.
#[derive(Default)]
pub(super) struct Reference<'j> {
    name: String,
    /// Metres of a pixel; `None` without measurements.
    scale: Option<f64>,
    fiducials: Vec<(&'j str, [f64; 2])>,
}

impl<'j> Reference<'j> {
    /// That of the building in a file.
    pub(super) fn of(
        document: &Document<'_>,
        building: &Object<'j>,
        levels: &Object<'j>,
        warnings: &mut Warnings,
    ) -> Result<Self, ImportError> {
        let name = match building.text("reference_level_name")? {
            Some(name) => Some(name.to_owned()),
            // The first one of the file, whose order a value of JSON does not have.
            None => document.names("levels").map_err(ImportError::of_yaml)?.into_iter().next(),
        };
        let Some((name, value)) = levels.members().find(|(level, _)| name.as_ref().is_none_or(|name| *level == name))
        else {
            return match name {
                Some(name) => {
                    Err(ImportError::new(format!("building, reference_level_name: there is no level {name}")))
                }
                None => Ok(Self::default()),
            };
        };
        let level = Object::new(format!("level {name}"), value)?;
        let vertices = vertices(&level, false)?;
        let scale = scale(&level, &vertices, warnings)?;
        Ok(Self { name: name.clone(), scale, fiducials: fiducials(&level, warnings)? })
    }

    /// Where a level is.
    pub(super) fn place(
        &self,
        name: &str,
        level: &Object<'_>,
        vertices: &[Vertex],
        warnings: &mut Warnings,
    ) -> Result<Placing, ImportError> {
        if name == self.name {
            return self.scale.map(Placing::scaled).ok_or_else(|| no_scale(level));
        }
        let own = fiducials(level, warnings)?;
        let pairs: Vec<_> = own
            .iter()
            .filter_map(|(name, at)| Some([self.fiducials.iter().find(|known| known.0 == *name)?.1, *at]))
            .collect();
        let measured = scale(level, vertices, warnings)?;
        match (self.laid_upon(&pairs), measured) {
            (Some((scale, placing, spread)), measured) => {
                if spread > SPREAD {
                    let problem = "its fiducials give scales that differ from their mean by up to";
                    warnings.add(
                        WarningCode::UncertainScale,
                        &level.name,
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
                        &level.name,
                        format!("{problem}; that of its fiducials counts, as for Open-RMF"),
                    );
                }
                Ok(placing)
            }
            (None, Some(measured)) => {
                let problem = match self.scale {
                    Some(_) => format!("no two fiducials place it upon level {}", self.name),
                    None => format!("level {}, upon which it belongs, has no measurements", self.name),
                };
                warnings.add(
                    WarningCode::UncertainScale,
                    &level.name,
                    format!("{problem}; it has the scale of its own measurements"),
                );
                Ok(Placing::scaled(measured))
            }
            (None, None) => Err(no_scale(level)),
        }
    }

    /// The scale \[m\] and place of a level by pairs of fiducials, that of the reference level first, and by how much of their mean
    /// the scales of the pairs differ.
    fn laid_upon(&self, pairs: &[[[f64; 2]; 2]]) -> Option<(f64, Placing, f64)> {
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
        let turned = Placing { turn: [angle.cos(), angle.sin()], ..Placing::scaled(scale) };
        let reference = Placing::scaled(of_reference);
        let mut shift = [0.0; 2];
        for pair in pairs {
            let [there, here] = [reference.apply(pair[0]), turned.apply(pair[1])];
            shift = [0, 1].map(|k| shift[k] + (there[k] - here[k]) / pairs.len() as f64);
        }
        Some((scale, Placing { shift, ..turned }, spread))
    }
}

fn no_scale(level: &Object<'_>) -> ImportError {
    ImportError::new(format!("{}, measurements: none that gives the scale of its pixels", level.name))
}

/// Names and places of the fiducials of a level; of several with one name the first one.
fn fiducials<'j>(level: &Object<'j>, warnings: &mut Warnings) -> Result<Vec<(&'j str, [f64; 2])>, ImportError> {
    let mut all: Vec<(&str, [f64; 2])> = Vec::new();
    for (k, value) in level.list("fiducials")?.iter().enumerate() {
        let number = |place: usize| value.get(place).and_then(Value::as_f64);
        let name = value.get(2).and_then(Value::as_str);
        match (number(0), number(1), name) {
            (Some(x), Some(y), Some(name)) if all.iter().all(|known| known.0 != name) => all.push((name, [x, y])),
            (Some(_), Some(_), Some(name)) => {
                warnings.lose(format_args!("{}, fiducial {k}: another one is {name}", level.name));
            }
            _ => warnings.lose(format_args!("{}, fiducial {k}: no place and name", level.name)),
        }
    }
    Ok(all)
}

/// Position as in the file, and name; `None` for what is no vertex.
pub(super) type Vertex = Option<([f64; 2], Option<String>)>;

/// The vertices of a level.
pub(super) fn vertices(level: &Object<'_>, graph: bool) -> Result<Vec<Vertex>, ImportError> {
    Ok(level.list("vertices")?.iter().map(|value| vertex(value, graph)).collect())
}

fn vertex(value: &Value, graph: bool) -> Vertex {
    let list = value.as_array()?;
    let number = |k: usize| list.get(k)?.as_f64().filter(|x| x.abs() <= crate::scenario::LIMIT);
    let name = if graph { list.get(2).and_then(|parameters| parameters.get("name")) } else { list.get(3) };
    // Adapters take any scalar for a name, whole numbers among them.
    let name = name.and_then(|name| match name {
        Value::String(text) => Some(text.clone()),
        Value::Number(number) if number.is_i64() || number.is_u64() => Some(number.to_string()),
        _ => None,
    });
    Some(([number(0)?, number(1)?], name.filter(|name| !name.is_empty())))
}

/// The value of a parameter, which is a list of its type and itself; a list without it is no value, and given as it is.
pub(super) fn parameter<'j>(parameters: Option<&'j Value>, name: &str) -> Option<&'j Value> {
    let given = parameters?.get(name)?;
    Some(given.as_array().and_then(|typed| typed.get(1)).unwrap_or(given))
}

/// Ends of a lane, a wall or a measurement.
pub(super) fn ends(value: &Value, vertices: &[Vertex]) -> Result<[(usize, [f64; 2]); 2], String> {
    let list = value.as_array().ok_or("not a list")?;
    let mut ends = [(0, [0.0; 2]); 2];
    for (k, end) in ends.iter_mut().enumerate() {
        let place = list.get(k).and_then(Value::as_u64).ok_or("two numbers of vertices are expected")?;
        let vertex =
            usize::try_from(place).ok().and_then(|place| vertices.get(place)?.as_ref().map(|vertex| (place, vertex.0)));
        *end = vertex.ok_or(format!("there is no vertex {place}"))?;
    }
    Ok(ends)
}

/// Metres of a pixel: the mean of the measurements of a level; `None` without any.
fn scale(level: &Object<'_>, vertices: &[Vertex], warnings: &mut Warnings) -> Result<Option<f64>, ImportError> {
    let mut scales = Vec::new();
    for (k, value) in level.list("measurements")?.iter().enumerate() {
        let metres = parameter(value.get(2), "distance").and_then(Value::as_f64);
        let scale = ends(value, vertices)
            .ok()
            .zip(metres)
            .map(|([(_, a), (_, b)], metres)| metres / (a[0] - b[0]).hypot(a[1] - b[1]));
        match scale.filter(|scale| (1e-9..1e9).contains(scale)) {
            Some(scale) => scales.push(scale),
            // The building tools do not leave it out: they count a distance of 0, and stop if there is none.
            None => warnings.lose(format_args!("{}, measurement {k}: it gives no scale", level.name)),
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
            &level.name,
            format!("its measurements differ from their mean by up to {percent:.1} %"),
        );
    }
    Ok(Some(mean))
}
