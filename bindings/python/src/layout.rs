//! Layouts, and the options with which files of others are read.

use crate::{json, refused, unreadable};
use pcr_formats::import::{ImportOptions, ImportedLayout, InputFormat};
use pcr_formats::input;
use pcr_planning::exclusion_table::{EdgeDriving, ExclusionTable, UnsafeDelayModel};
use pcr_planning::report::UnsafeDelayReport;
use pyo3::prelude::*;
use std::path::PathBuf;

/// The options of the importers, by their names on the command line.
#[derive(FromPyObject)]
pub(crate) struct Choices {
    #[pyo3(item)]
    format: Option<String>,
    #[pyo3(item)]
    routes: Vec<String>,
    #[pyo3(item)]
    radius: Option<f64>,
    #[pyo3(item)]
    margin: Option<f64>,
    #[pyo3(item)]
    speed: Option<f64>,
    #[pyo3(item)]
    acceleration: Option<f64>,
    #[pyo3(item)]
    rotation: Option<f64>,
    #[pyo3(item)]
    rotation_acceleration: Option<f64>,
    #[pyo3(item)]
    vehicle: Option<String>,
    #[pyo3(item)]
    fleet: Option<PathBuf>,
    #[pyo3(item)]
    corner_radius: Option<f64>,
    #[pyo3(item)]
    tolerance: Option<f64>,
    #[pyo3(item)]
    graph: Option<u64>,
    #[pyo3(item)]
    horizon: bool,
    #[pyo3(item)]
    partial: bool,
}

impl Choices {
    pub(crate) fn options(self) -> PyResult<ImportOptions> {
        let from = match self.format {
            None => None,
            Some(name) => match InputFormat::ALL.into_iter().find(|format| format.to_string() == name) {
                Some(format) => Some(format),
                None => {
                    let known: Vec<_> = InputFormat::ALL.iter().map(InputFormat::to_string).collect();
                    return Err(refused(format!("format {name}: there are {}", known.join(", "))));
                }
            },
        };
        let Self { format: _, routes, radius, margin, speed, acceleration, rotation, rotation_acceleration, .. } = self;
        let Self { vehicle, fleet, corner_radius, tolerance, graph, horizon, partial, .. } = self;
        Ok(ImportOptions {
            from,
            routes,
            radius,
            margin,
            speed,
            acceleration,
            rotation,
            rotation_acceleration,
            vehicle,
            fleet,
            corner_radius,
            tolerance,
            graph,
            horizon,
            partial,
        })
    }
}

/// A layout, for a vehicle.
#[pyclass(frozen, module = "pcr._pcr")]
pub(crate) struct Layout(ImportedLayout);

#[pymethods]
impl Layout {
    /// With an acceleration for vehicles that drive from rest to rest. The warnings of its reader come with it.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, options: Choices) -> PyResult<(Self, Vec<String>)> {
        let options = options.options()?;
        if let Some(option) = options.one_of(&["routes", "corner_radius"]) {
            return Err(refused(format!("{option} has no effect: locks and delays are of all edges as they are")));
        }
        py.detach(|| {
            let moves = options.acceleration.is_some();
            let (imported, warnings) =
                input::read_layout(&path, &options, moves).map_err(|error| unreadable(&error))?;
            Ok((Self(imported), warnings.all()))
        })
    }

    fn locks_json(&self, py: Python<'_>, nodes: bool) -> PyResult<String> {
        py.detach(|| ExclusionTable::compute(&self.0, nodes).map_err(refused).and_then(|locks| json(&locks)))
    }

    /// For a layout that was read with this speed and acceleration, on which the limits of edges depend.
    #[pyo3(signature = (speed, acceleration))]
    fn delays_json(&self, py: Python<'_>, speed: f64, acceleration: Option<f64>) -> PyResult<String> {
        let driving = EdgeDriving { speed, acceleration };
        py.detach(|| {
            let delays = UnsafeDelayModel::new(&self.0, driving, false).map_err(refused)?;
            let head = ExclusionTable::head(&self.0, false);
            UnsafeDelayReport::collect(head, driving, &delays, &|_, _| {})
                .map_err(refused)
                .and_then(|table| json(&table))
        })
    }

    fn sizes(&self) -> (String, usize, usize) {
        (self.0.layout.name.clone(), self.0.layout.nodes.len(), self.0.layout.edges.len())
    }
}
