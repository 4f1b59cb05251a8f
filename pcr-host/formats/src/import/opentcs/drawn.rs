//! What the visual layout of models up to version 0.0.3 says of points and paths: where points are drawn, and how paths are bent.

use super::super::ImportError;
use super::super::xml::children;
use super::MILLI;
use crate::scenario::LIMIT;
use roxmltree::Node;
use std::collections::HashMap;

/// How a path is drawn.
pub(super) struct Bend {
    /// `DIRECT`, `BEZIER` and others.
    pub(super) kind: String,
    /// Its control points, in units of the visual layout.
    pub(super) points: Vec<[f64; 2]>,
}

/// The properties of each thing that the visual layout names.
pub(super) struct VisualProperties<'a>(HashMap<&'a str, HashMap<&'a str, &'a str>>);

impl<'a> VisualProperties<'a> {
    /// Reads the `modelLayoutElement`s.
    ///
    /// # Errors
    /// A thing of which the layout speaks twice.
    pub(super) fn of(visual: Option<Node<'a, '_>>) -> Result<Self, ImportError> {
        let mut all = HashMap::new();
        for element in visual.into_iter().flat_map(|visual| children(visual, "modelLayoutElement")) {
            let Some(name) = element.attribute("visualizedObjectName") else {
                return Err(ImportError::new("visualLayout, modelLayoutElement, visualizedObjectName: missing"));
            };
            let property =
                |property: Node<'a, '_>| Some((property.attribute("name")?, property.attribute("value")?.trim()));
            if all.insert(name, children(element, "property").filter_map(property).collect()).is_some() {
                return Err(ImportError::new(format!("visualLayout, modelLayoutElement {name}: there are several")));
            }
        }
        Ok(Self(all))
    }

    fn value(&self, name: &str, property: &str) -> Option<&'a str> {
        self.0.get(name)?.get(property).copied().filter(|value| !value.is_empty())
    }

    /// Where a point is drawn \[m\]; `None` if that is not said.
    ///
    /// # Errors
    /// One coordinate without the other, and what is no number.
    pub(super) fn point(&self, name: &str) -> Result<Option<[f64; 2]>, ImportError> {
        let at = |property: &str| {
            self.value(name, property).map(|text| number(text, name, property).map(|x| x * MILLI)).transpose()
        };
        match (at("POSITION_X")?, at("POSITION_Y")?) {
            (Some(x), Some(y)) => Ok(Some([x, y])),
            (None, None) => Ok(None),
            _ => Err(ImportError::new(format!("{name}, modelLayoutElement: POSITION_X and POSITION_Y are expected"))),
        }
    }

    /// How a path is drawn; `None` if that is not said.
    ///
    /// # Errors
    /// Control points that are not pairs of numbers.
    pub(super) fn path(&self, name: &str) -> Result<Option<Bend>, ImportError> {
        let (kind, points) = (self.value(name, "CONN_TYPE"), self.value(name, "CONTROL_POINTS"));
        if kind.is_none() && points.is_none() {
            return Ok(None);
        }
        let pair = |pair: &str| {
            let problem = || ImportError::new(format!("{name}, CONTROL_POINTS: {pair:?} where x,y is expected"));
            let (x, y) = pair.split_once(',').ok_or_else(problem)?;
            Ok([number(x, name, "CONTROL_POINTS")?, number(y, name, "CONTROL_POINTS")?])
        };
        let pairs = points.into_iter().flat_map(|points| points.split(';')).filter(|pair| !pair.trim().is_empty());
        let points = pairs.map(pair).collect::<Result<Vec<_>, ImportError>>()?;
        // Releases differ in their case.
        Ok(Some(Bend { kind: kind.unwrap_or("DIRECT").to_ascii_uppercase(), points }))
    }
}

fn number(text: &str, name: &str, property: &str) -> Result<f64, ImportError> {
    let number = text.trim().parse::<f64>().ok().filter(|number| number.abs() <= LIMIT);
    let problem =
        || ImportError::new(format!("{name}, modelLayoutElement, {property}: {text:?} where a number is expected"));
    number.ok_or_else(problem)
}
