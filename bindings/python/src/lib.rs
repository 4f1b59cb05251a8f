//! The Rust part of the Python package: reads scenarios, and returns rows of numbers and JSON. `python/pcr/__init__.py`
//! turns these into arrays, objects and errors, and documents them; nothing else imports this module.
//!
//! Rows are bytes of `f64` in the byte order of the machine. NumPy uses them without a copy, and the standard library
//! can read them without NumPy; the stable interface of CPython 3.9 has no buffers of foreign types. Computations
//! release the interpreter lock.

use pcr_core::{Encounter, Hold, Interval, Order, Orders, Piece, Progress, Region, safe_intervals};
use pcr_formats::import::{Imported, Options};
use pcr_formats::input::{self, InputError};
use pcr_formats::scenario::{Scenario, ScenarioError};
use pcr_planning::check::Verdict;
use pcr_planning::fleet::{Fleet as Parts, HostEcm};
use pcr_planning::locks::{Delays, Driving, Locks};
use pcr_planning::plan::{self, Method, Plan};
use pcr_planning::regions::{Answer, Request, find, table};
use pcr_planning::report::{self, DelayTable, Document};
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::fmt::Display;
use std::path::PathBuf;

create_exception!(_pcr, Error, PyValueError, "What was asked for cannot be answered, with the reason.");

fn refused(reason: impl Display) -> PyErr {
    Error::new_err(reason.to_string())
}

/// The message, the line, and the place of the fault: agent, part and field.
fn misread(error: &ScenarioError) -> PyErr {
    let part = error.part().map(|(part, number)| format!("{part} {number}"));
    let told = |text: Option<&str>| text.map(str::to_owned);
    Error::new_err((error.to_string(), error.line(), told(error.agent()), part, told(error.field())))
}

/// The output of the tool with `--json`.
fn json(answer: &impl Document) -> PyResult<String> {
    let mut text = Vec::new();
    report::json(answer, &mut text)?;
    Ok(String::from_utf8(text)?)
}

fn bytes<const N: usize>(py: Python<'_>, rows: impl IntoIterator<Item = [f64; N]>) -> Bound<'_, PyBytes> {
    let numbers: Vec<u8> = rows.into_iter().flatten().flat_map(f64::to_ne_bytes).collect();
    PyBytes::new(py, &numbers)
}

/// A scenario, with the paths and motions that follow from it.
#[pyclass(frozen)]
struct Fleet {
    scenario: Scenario,
    parts: Parts<f64>,
}

impl Fleet {
    fn new(scenario: Scenario) -> PyResult<Self> {
        let parts = Parts::new(&scenario).map_err(refused)?;
        Ok(Self { scenario, parts })
    }

    /// Refuses fleets with footprints, whose agents consist of several discs.
    fn discs(&self) -> PyResult<()> {
        match self.scenario.agents.iter().find(|agent| agent.footprint.is_some() || !agent.loads.is_empty()) {
            Some(agent) => Err(refused(format!("agent {}: it has a footprint; this is for discs", agent.called()))),
            None => Ok(()),
        }
    }

    fn place(&self, id: u64) -> PyResult<usize> {
        let place = self.scenario.agents.iter().position(|agent| agent.id == id);
        place.ok_or_else(|| refused(format!("no agent {id}")))
    }

    /// The regions of every agent in the order of the tool: ego, other, times, lengths, lengths of the other, and
    /// whether they are open at the start and at the end.
    fn rows(&self, inflated: bool) -> PyResult<Vec<[f64; 10]>> {
        let mut motions = self.parts.motions();
        if inflated {
            motions = motions.into_iter().map(|motion| motion.inflated()).collect();
        }
        let ids: Vec<f64> = self.scenario.agents.iter().map(|agent| agent.id as f64).collect();
        let ecm = table(&self.scenario, &motions).map_err(refused)?;
        let regions = ecm.regions(&motions).map_err(refused)?;
        let id = |agent: usize| ids.get(agent).copied().unwrap_or(f64::NAN);
        let truth = |yes: bool| f64::from(u8::from(yes));
        let mut rows: Vec<[f64; 10]> = regions
            .map(|region| {
                let (t, l, s) = (region.time(), region.length(), region.other_length());
                let open = [truth(region.is_open_at_start()), truth(region.is_open_at_end())];
                [id(region.ego()), id(region.other()), t.lo, t.hi, l.lo, l.hi, s.lo, s.hi, open[0], open[1]]
            })
            .collect();
        rows.sort_by(|a, b| {
            [0, 1, 2, 4].iter().fold(std::cmp::Ordering::Equal, |order, &k| order.then(a[k].total_cmp(&b[k])))
        });
        Ok(rows)
    }
}

#[pymethods]
impl Fleet {
    #[staticmethod]
    fn from_json(py: Python<'_>, text: &str) -> PyResult<Self> {
        py.detach(|| Self::new(Scenario::from_json(text).map_err(|error| misread(&error))?))
    }

    /// Reads a file of any format; also returns the warnings of the reader.
    #[staticmethod]
    #[pyo3(signature = (path, options))]
    fn read(py: Python<'_>, path: PathBuf, options: Choices) -> PyResult<(Self, Vec<String>)> {
        py.detach(|| match input::read(&path, &options.into()) {
            Ok((scenario, _)) => {
                let warnings = scenario.warnings.clone();
                Ok((Self::new(scenario)?, warnings))
            }
            Err(InputError::Refused(_, error)) => Err(misread(&error)),
            Err(error) => Err(refused(error)),
        })
    }

    fn to_json(&self) -> String {
        self.scenario.to_json()
    }

    fn name(&self) -> &str {
        &self.scenario.name
    }

    fn agents(&self) -> Vec<(u64, String, f64, f64, f64)> {
        let motions = self.parts.motions();
        let agents = self.scenario.agents.iter().zip(&motions);
        agents
            .map(|(agent, motion)| {
                (agent.id, agent.label.clone(), agent.radius, motion.path().length(), motion.time().hi)
            })
            .collect()
    }

    fn find(&self, asked: &str) -> PyResult<u64> {
        find(&self.scenario, asked).map_err(refused)
    }

    #[pyo3(signature = (inflated = false))]
    fn regions<'py>(&self, py: Python<'py>, inflated: bool) -> PyResult<Bound<'py, PyBytes>> {
        self.discs()?;
        let rows = py.detach(|| self.rows(inflated))?;
        Ok(bytes(py, rows))
    }

    /// The output of `pcr regions --json`, also for fleets with footprints.
    #[pyo3(signature = (slices = None, agent = None))]
    fn regions_json(&self, py: Python<'_>, slices: Option<usize>, agent: Option<u64>) -> PyResult<String> {
        py.detach(|| {
            Answer::of::<f64>(&self.scenario, Request { agent, slices, certificate: false })
                .map_err(refused)
                .and_then(|answer| json(&answer))
        })
    }

    fn check_json(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| Verdict::of::<f64>(&self.scenario, false).map_err(refused).and_then(|verdict| json(&verdict)))
    }

    /// The forbidden lengths of an agent at these times: index of the time, other agent, from, to.
    fn map<'py>(
        &self,
        py: Python<'py>,
        agent: u64,
        from: f64,
        step: f64,
        times: usize,
    ) -> PyResult<Bound<'py, PyBytes>> {
        self.discs()?;
        let ego = self.place(agent)?;
        let rows = py.detach(|| -> PyResult<Vec<[f64; 4]>> {
            let motions = self.parts.motions();
            let mut ecm: HostEcm<f64> = pcr_core::Ecm::new(Vec::new(), Vec::new());
            while let Err(full) = ecm.fill_row(&motions, ego) {
                ecm.grow(full).map_err(refused)?;
            }
            let mut rows = Vec::new();
            for region in ecm.row(&motions, ego).map_err(refused)? {
                let other = self.scenario.agents.get(region.other()).map_or(f64::NAN, |agent| agent.id as f64);
                for place in 0..times {
                    let slices = region.slice_at(from + step * place as f64);
                    rows.extend(slices.map(|slice| [place as f64, other, slice.lo, slice.hi]));
                }
            }
            Ok(rows)
        })?;
        Ok(bytes(py, rows))
    }

    /// The place of every agent at a time: x, y, heading, travelled length.
    fn places<'py>(&self, py: Python<'py>, time: f64) -> PyResult<Bound<'py, PyBytes>> {
        if !time.is_finite() {
            return Err(refused(format!("time: {time} is not a finite number")));
        }
        let motions = self.parts.motions();
        let rows = motions.iter().map(|motion| {
            let length = motion.length_at(time);
            let pose = motion.path().pose_at(length);
            [pose.position.x, pose.position.y, pose.heading.0, length]
        });
        Ok(bytes(py, rows.collect::<Vec<_>>()))
    }

    /// The times at which no other agent blocks these lengths of an agent's path.
    fn safe_intervals(
        &self,
        py: Python<'_>,
        agent: u64,
        length: (f64, f64),
        during: (f64, f64),
    ) -> PyResult<Vec<(f64, f64)>> {
        self.discs()?;
        let ego = self.place(agent)?;
        for (name, (lo, hi)) in [("length", length), ("during", during)] {
            if !(lo.is_finite() && hi.is_finite() && lo <= hi) {
                return Err(refused(format!("{name}: {lo} to {hi} is not an interval of finite numbers")));
            }
        }
        py.detach(|| {
            let motions = self.parts.motions();
            let (length, during) = (Interval::new(length.0, length.1), Interval::new(during.0, during.1));
            let free = safe_intervals(&motions, ego, length, during).map_err(refused)?;
            Ok(free.map(|free| (free.lo, free.hi)).collect())
        })
    }

    /// The least distance of two agents, its time, and the sum of their radii.
    fn closest(&self, i: u64, j: u64) -> PyResult<(f64, f64, f64)> {
        self.discs()?;
        let motions = self.parts.motions();
        let [Some(own), Some(other)] = [self.place(i)?, self.place(j)?].map(|place| motions.get(place)) else {
            return Err(refused(format!("no agents {i} and {j}")));
        };
        let pair = Encounter::new(own, other);
        let nearest = pair.closest(pair.time());
        Ok((nearest.separation, nearest.time, pair.radius()))
    }

    /// The plan as JSON, and the planned fleet if there is one.
    fn plan(&self, py: Python<'_>, speeds: bool) -> PyResult<(String, Option<Self>)> {
        py.detach(|| {
            let method = if speeds { Method::Speed } else { Method::Delay };
            let (plan, scenario) = Plan::of(&self.scenario, &plan::Request::of(method)).map_err(refused)?;
            Ok((json(&plan)?, scenario.map(Self::new).transpose()?))
        })
    }

    /// How far each agent may go in the order in which the motions pass one another. Places are intervals; a hold is
    /// infinite if no agent is in the way.
    fn holds(&self, py: Python<'_>, places: Vec<(f64, f64)>) -> PyResult<Vec<f64>> {
        self.discs()?;
        let motions = self.parts.motions();
        if places.len() != motions.len() {
            return Err(refused(format!("{} places for {} agents", places.len(), motions.len())));
        }
        if let Some((lo, hi)) = places.iter().find(|(lo, hi)| !(lo.is_finite() && hi.is_finite() && lo <= hi)) {
            return Err(refused(format!("place: {lo} to {hi} is not an interval of finite numbers")));
        }
        py.detach(|| {
            let ecm = table(&self.scenario, &motions).map_err(refused)?;
            let (regions, pieces) = (ecm.len(), ecm.pieces());
            let storage = (vec![Region::EMPTY; regions], vec![Piece::EMPTY; pieces], vec![Order::EMPTY; regions]);
            let mut orders = Orders::build(storage.0, storage.1, storage.2, &motions).map_err(refused)?;
            orders.as_planned(&motions).map_err(refused)?;
            let progress: Vec<_> =
                places.iter().map(|&(lo, hi)| Progress { at: Interval::new(lo, hi), stop: hi }).collect();
            let hold = |agent: usize| match orders.hold(&motions, agent, &progress) {
                Ok(Hold::Free) => Ok(f64::INFINITY),
                Ok(Hold::At(length)) => Ok(length),
                Ok(Hold::Inside) => Ok(f64::NEG_INFINITY),
                Err(mismatch) => Err(refused(mismatch)),
            };
            (0..motions.len()).map(hold).collect()
        })
    }
}

/// The options of the importers.
#[derive(FromPyObject)]
struct Choices {
    #[pyo3(item)]
    radius: Option<f64>,
    #[pyo3(item)]
    speed: Option<f64>,
    #[pyo3(item)]
    acceleration: Option<f64>,
    #[pyo3(item)]
    rotation: Option<f64>,
    #[pyo3(item)]
    vehicle: Option<String>,
    #[pyo3(item)]
    routes: Vec<String>,
    #[pyo3(item)]
    partial: bool,
}

impl From<Choices> for Options {
    fn from(choices: Choices) -> Self {
        let Choices { radius, speed, acceleration, rotation, vehicle, routes, partial } = choices;
        Self { radius, speed, acceleration, rotation, vehicle, routes, partial, ..Self::default() }
    }
}

/// A layout for one vehicle.
#[pyclass(frozen)]
struct Layout(Imported);

#[pymethods]
impl Layout {
    /// With an acceleration, vehicles drive from rest to rest.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, options: Choices) -> PyResult<Self> {
        py.detach(|| {
            let moves = options.acceleration.is_some();
            input::read_layout(&path, &options.into(), moves).map(|(imported, _)| Self(imported)).map_err(refused)
        })
    }

    fn locks_json(&self, py: Python<'_>, nodes: bool) -> PyResult<String> {
        py.detach(|| Locks::of(&self.0, nodes).map_err(refused).and_then(|locks| json(&locks)))
    }

    /// The layout must have been read with this speed and acceleration, because the limits of edges depend on them.
    #[pyo3(signature = (speed, acceleration))]
    fn delays_json(&self, py: Python<'_>, speed: f64, acceleration: Option<f64>) -> PyResult<String> {
        let driving = Driving { speed, acceleration };
        py.detach(|| {
            let delays = Delays::new(&self.0, driving, false).map_err(refused)?;
            let head = Locks::head(&self.0, false);
            DelayTable::of(head, driving, &delays, &|_, _| {}).map_err(refused).and_then(|table| json(&table))
        })
    }

    fn sizes(&self) -> (String, usize, usize) {
        (self.0.layout.name.clone(), self.0.layout.nodes.len(), self.0.layout.edges.len())
    }
}

#[pymodule]
fn _pcr(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("Error", module.py().get_type::<Error>())?;
    module.add_class::<Fleet>()?;
    module.add_class::<Layout>()?;
    module.add("version", env!("CARGO_PKG_VERSION"))
}
