//! The Rust part of the Python package: reads scenarios, and returns rows of numbers and JSON. `python/pcr/__init__.py`
//! turns these into arrays, objects and errors, and documents them; nothing else imports this module.
//!
//! Rows are bytes, numbers of 8 bytes of which the lowest comes first, so that NumPy takes them as they are and the standard library reads
//! them without it: the stable interface of CPython 3.9 has no buffers of foreign types. The interpreter is released meanwhile.

mod layout;

use layout::{Choices, Layout};
use pcr_core::{AdmissionError, Encounter, Interval, Motion, MovementAuthority, PassingState, Progress};
use pcr_formats::input::{self, InputError};
use pcr_formats::scenario::{Scenario, ScenarioError};
use pcr_planning::check::CheckReport;
use pcr_planning::fleet::{Fleet as Parts, HostPrecedenceTable, build_ecm_of};
use pcr_planning::plan::{DelaySearchOptions, Objective, PlanMethod, PlanOptions, PlanReport, PriorityRule};
use pcr_planning::regions::{RegionOptions, RegionsReport, orders, table};
use pcr_planning::report::{self, VersionedReport};
use pcr_planning::safe_windows::safe_intervals;
use pyo3::create_exception;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};
use rayon::prelude::*;
use std::fmt::Display;
use std::path::PathBuf;
use std::time::Duration;

create_exception!(pcr, Error, PyValueError, "What was asked for cannot be answered, with the reason.");

fn refused(reason: impl Display) -> PyErr {
    Error::new_err(reason.to_string())
}

/// A file that cannot be read is an error of the system, as everywhere in Python: `FileNotFoundError` and its like.
pub(crate) fn unreadable(error: &InputError) -> PyErr {
    match error {
        InputError::Unreadable(Some(path), reason) => match reason.raw_os_error() {
            Some(number) => {
                // The number is told beside it.
                let text = reason.to_string();
                let text = text.split_once(" (os error").map_or(text.as_str(), |(text, _)| text);
                PyOSError::new_err((number, text.to_owned(), path.display().to_string()))
            }
            None => refused(error),
        },
        InputError::Refused(_, error) => misread(error),
        error => refused(error),
    }
}

/// The message, the line, and the place of the fault: agent, part and field.
fn misread(error: &ScenarioError) -> PyErr {
    let part = error.part().map(|(part, number)| format!("{part} {number}"));
    let told = |text: Option<&str>| text.map(str::to_owned);
    Error::new_err((error.to_string(), error.line(), told(error.agent()), part, told(error.field())))
}

/// The output of the tool with `--json`.
fn json(answer: &impl VersionedReport) -> PyResult<String> {
    let mut text = Vec::new();
    report::json(answer, &mut text)?;
    Ok(String::from_utf8(text)?)
}

/// A row of numbers, then of truths, in bytes: each truth takes one, and what is left of eight is 0.
fn row<const WHOLE: usize, const REAL: usize, const TRUTHS: usize>(
    into: &mut Vec<u8>,
    whole: [u64; WHOLE],
    real: [f64; REAL],
    truths: [bool; TRUTHS],
) {
    into.extend_from_slice(whole.map(u64::to_le_bytes).as_flattened());
    into.extend_from_slice(real.map(f64::to_le_bytes).as_flattened());
    into.extend_from_slice(&truths.map(u8::from));
    into.extend_from_slice(&[0; 7][..TRUTHS.next_multiple_of(8) - TRUTHS]);
}

/// A scenario, with the paths and motions that follow from it.
#[pyclass(frozen, module = "pcr._pcr")]
struct Fleet {
    scenario: Scenario,
    parts: Parts<f64>,
}

impl Fleet {
    fn new(scenario: Scenario) -> PyResult<Self> {
        let parts = Parts::of_bodies(&scenario).map_err(refused)?;
        Ok(Self { scenario, parts })
    }

    /// Refuses fleets with agents that are several bodies: their motions here are those of convex hulls.
    fn single_bodies(&self) -> PyResult<()> {
        match self.scenario.agents.iter().find(|agent| agent.has_parts()) {
            Some(agent) => {
                let who = agent.display_name();
                Err(refused(format!(
                    "agent {who}: it is concave or has loads; this is for agents of one convex outline"
                )))
            }
            None => Ok(()),
        }
    }

    fn place(&self, id: u64) -> PyResult<usize> {
        let place = self.scenario.agents.iter().position(|agent| agent.id == id);
        place.ok_or_else(|| refused(format!("no agent {id}")))
    }

    /// The number of an agent that a table names.
    fn id(&self, place: usize) -> PyResult<u64> {
        self.scenario
            .agents
            .get(place)
            .map(|agent| agent.id)
            .ok_or_else(|| refused(format!("no agent at place {place}")))
    }

    /// The regions of every agent in the order of the tool: ego, other, times, lengths, lengths of the other, and whether it is open
    /// at the start and at the end.
    fn rows(&self, inflated: bool) -> PyResult<Vec<u8>> {
        let mut motions = self.parts.motions();
        if inflated {
            motions = motions.into_iter().map(|motion| motion.inflated()).collect();
        }
        let ecm = table(&self.scenario, &motions).map_err(refused)?;
        let mut found: Vec<_> = self.scenario.agents.iter().map(|agent| (agent.id, Vec::new())).collect();
        for region in ecm.regions_once(&motions).map_err(refused)? {
            for region in [region.clone(), region.swapped()] {
                let (t, l, s) = (region.time(), region.length(), region.other_length());
                let open = [region.is_open_at_start(), region.is_open_at_end()];
                let spans = [t.lo, t.hi, l.lo, l.hi, s.lo, s.hi];
                let (ego, other) = (region.ego(), self.id(region.other())?);
                let (_, own) = found.get_mut(ego).ok_or_else(|| refused(format!("no agent at place {ego}")))?;
                own.push((other, spans, open));
            }
        }
        // All come in the order of places: where that is the order of numbers, too, neither of these two moves anything.
        found.sort_by_key(|&(ego, _)| ego);
        let mut rows = Vec::with_capacity(2 * 72 * ecm.len());
        for (ego, mut own) in found {
            own.sort_by_key(|&(other, ..)| other);
            for pair in own.chunk_by_mut(|a, b| a.0 == b.0) {
                pair.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]).then(a.1[2].total_cmp(&b.1[2])));
            }
            own.into_iter().for_each(|(other, spans, open)| row(&mut rows, [ego, other], spans, open));
        }
        Ok(rows)
    }

    /// Who passes first, as the motions do.
    fn orders(&self, motions: &[Motion<'_, f64>]) -> PyResult<HostPrecedenceTable> {
        let mut orders = orders(&self.scenario, motions).map_err(refused)?;
        orders.as_planned(motions).map_err(|refusal| match refusal {
            // The library counts places.
            AdmissionError::Meeting([i, j]) => match (self.id(i), self.id(j)) {
                (Ok(i), Ok(j)) => refused(format!("agents {i} and {j} meet: there is no order in which they pass")),
                _ => refused(refusal),
            },
            _ => refused(refusal),
        })?;
        Ok(orders)
    }
}

#[pymethods]
impl Fleet {
    #[staticmethod]
    fn from_json(py: Python<'_>, text: &str) -> PyResult<Self> {
        py.detach(|| Self::new(Scenario::from_json(text).map_err(|error| misread(&error))?))
    }

    /// Reads a file of any format.
    #[staticmethod]
    #[pyo3(signature = (path, options))]
    fn read(py: Python<'_>, path: PathBuf, options: Choices) -> PyResult<Self> {
        let options = options.options()?;
        py.detach(|| match input::read(&path, &options) {
            Ok((scenario, _)) => Self::new(scenario),
            Err(error) => Err(unreadable(&error)),
        })
    }

    fn to_json(&self) -> String {
        self.scenario.to_json()
    }

    fn name(&self) -> &str {
        &self.scenario.name
    }

    fn warnings(&self) -> Vec<String> {
        self.scenario.warnings.clone()
    }

    fn agents(&self) -> Vec<(u64, String, f64, f64, f64, f64)> {
        let motions = self.parts.motions();
        let agents = self.scenario.agents.iter().zip(&motions);
        agents
            .map(|(agent, motion)| {
                let (path, time) = (motion.path().length(), motion.time());
                (agent.id, agent.label.clone(), agent.radius, path, time.lo, time.hi)
            })
            .collect()
    }

    #[pyo3(signature = (inflated = false))]
    fn regions<'py>(&self, py: Python<'py>, inflated: bool) -> PyResult<Bound<'py, PyBytes>> {
        self.single_bodies()?;
        let rows = py.detach(|| self.rows(inflated))?;
        Ok(PyBytes::new(py, &rows))
    }

    /// The output of `pcr regions --json`, also for fleets with footprints.
    #[pyo3(signature = (slices = None, agent = None))]
    fn regions_json(&self, py: Python<'_>, slices: Option<usize>, agent: Option<u64>) -> PyResult<String> {
        py.detach(|| {
            RegionsReport::compute::<f64>(&self.scenario, RegionOptions { agent, slices, certificate: false })
                .map_err(refused)
                .and_then(|answer| json(&answer))
        })
    }

    fn check_json(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| {
            CheckReport::compute::<f64>(&self.scenario, false).map_err(refused).and_then(|verdict| json(&verdict))
        })
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
        self.single_bodies()?;
        let ego = self.place(agent)?;
        let rows = py.detach(|| -> PyResult<Vec<u8>> {
            let motions = self.parts.motions();
            let ecm = build_ecm_of(&motions, ego).map_err(refused)?;
            let mut rows = Vec::new();
            for region in ecm.row(&motions, ego).map_err(refused)? {
                let other = self.id(region.other())?;
                for place in 0..times {
                    for slice in region.slice_at(from + step * place as f64) {
                        row(&mut rows, [place as u64, other], [slice.lo, slice.hi], []);
                    }
                }
            }
            Ok(rows)
        })?;
        Ok(PyBytes::new(py, &rows))
    }

    /// The place of every agent at a time: x, y, heading, travelled length.
    fn places<'py>(&self, py: Python<'py>, time: f64) -> PyResult<Bound<'py, PyBytes>> {
        if !time.is_finite() {
            return Err(refused(format!("time: {time} is not a finite number")));
        }
        let motions = self.parts.motions();
        let mut rows = Vec::new();
        for motion in &motions {
            let length = motion.length_at(time);
            let pose = motion.path().pose_at(length);
            row(&mut rows, [], [pose.position.x, pose.position.y, pose.heading.0, length], []);
        }
        Ok(PyBytes::new(py, &rows))
    }

    /// The times at which no other agent blocks these lengths of an agent's path.
    fn safe_intervals(
        &self,
        py: Python<'_>,
        agent: u64,
        length: (f64, f64),
        during: (f64, f64),
    ) -> PyResult<Vec<(f64, f64)>> {
        self.single_bodies()?;
        let ego = self.place(agent)?;
        for (name, (lo, hi)) in [("length", length), ("during", during)] {
            if !(lo.is_finite() && hi.is_finite() && lo <= hi) {
                return Err(refused(format!("{name}: {lo} to {hi} is not an interval of finite numbers")));
            }
        }
        py.detach(|| {
            let motions = self.parts.motions();
            // What is not on the path is nobody's way: "free" would be no answer.
            let end = motions.get(ego).map_or(0.0, |motion| motion.path().length());
            if length.1 < 0.0 || length.0 > end {
                return Err(refused(format!("length: {} to {} is not on the path, 0 to {end}", length.0, length.1)));
            }
            let (length, during) = (Interval::new(length.0, length.1), Interval::new(during.0, during.1));
            let free = safe_intervals(&motions, ego, length, during).map_err(refused)?;
            Ok(free.into_iter().map(|free| (free.lo, free.hi)).collect())
        })
    }

    /// The least distance of two agents, its time, and the sum of their radii.
    fn closest(&self, i: u64, j: u64) -> PyResult<(f64, f64, f64)> {
        self.single_bodies()?;
        if i == j {
            return Err(refused(format!("agents {i} and {j} are one and the same")));
        }
        let motions = self.parts.motions();
        let [Some(own), Some(other)] = [self.place(i)?, self.place(j)?].map(|place| motions.get(place)) else {
            return Err(refused(format!("no agents {i} and {j}")));
        };
        let pair = Encounter::new(own, other);
        let nearest = pair.closest(pair.time());
        Ok((nearest.separation, nearest.time, pair.radius()))
    }

    /// The plan as JSON, and the planned fleet if there is one.
    fn plan(&self, py: Python<'_>, options: PlanChoices) -> PyResult<(String, Option<Self>)> {
        let options = options.options(&self.scenario)?;
        py.detach(|| {
            let (plan, scenario) = PlanReport::compute(&self.scenario, &options).map_err(refused)?;
            // As a file of it is read: the same bits as the tool's.
            let read = |scenario: Scenario| Scenario::from_json(&scenario.to_json()).map_err(|error| misread(&error));
            Ok((json(&plan)?, scenario.map(|scenario| Self::new(read(scenario)?)).transpose()?))
        })
    }

    /// The regions of an agent and who passes them first: ego, other, lengths of both, and whether the ego does.
    fn passings<'py>(&self, py: Python<'py>, agent: u64) -> PyResult<Bound<'py, PyBytes>> {
        self.single_bodies()?;
        let ego = self.place(agent)?;
        let rows = py.detach(|| -> PyResult<Vec<u8>> {
            let motions = self.parts.motions();
            let orders = self.orders(&motions)?;
            let mut rows = Vec::new();
            for (_, region, pass) in orders.row(&motions, ego).map_err(refused)? {
                let first = match pass {
                    PassingState::First => true,
                    PassingState::Second => false,
                    PassingState::Undecided | PassingState::Over => return Err(refused("a region without an order")),
                };
                let (l, s) = (region.length(), region.other_length());
                row(&mut rows, [agent, self.id(region.other())?], [l.lo, l.hi, s.lo, s.hi], [first]);
            }
            Ok(rows)
        })?;
        Ok(PyBytes::new(py, &rows))
    }

    /// How far each agent may go in the order in which the motions pass, for places that are known from-to; infinite where nobody is
    /// in the way.
    fn holds(&self, py: Python<'_>, places: Vec<(f64, f64)>) -> PyResult<Vec<f64>> {
        self.single_bodies()?;
        let motions = self.parts.motions();
        if places.len() != motions.len() {
            return Err(refused(format!("{} places for {} agents", places.len(), motions.len())));
        }
        if let Some((lo, hi)) = places.iter().find(|(lo, hi)| !(lo.is_finite() && hi.is_finite() && lo <= hi)) {
            return Err(refused(format!("place: {lo} to {hi} is not an interval of finite numbers")));
        }
        py.detach(|| {
            let orders = self.orders(&motions)?;
            let progress: Vec<_> =
                places.iter().map(|&(lo, hi)| Progress { at: Interval::new(lo, hi), stop: hi }).collect();
            let hold = |agent: usize| match orders.hold(&motions, agent, &progress) {
                Ok(MovementAuthority::Free) => Ok(f64::INFINITY),
                Ok(MovementAuthority::At(length)) => Ok(length),
                Ok(MovementAuthority::Inside) => Ok(f64::NEG_INFINITY),
                Err(mismatch) => Err(refused(mismatch)),
            };
            (0..motions.len()).map(hold).collect()
        })
    }
}

/// The options of a plan, by their names on the command line.
#[derive(FromPyObject)]
struct PlanChoices {
    #[pyo3(item)]
    speeds: bool,
    #[pyo3(item)]
    makespan: bool,
    #[pyo3(item)]
    leave_out: bool,
    #[pyo3(item)]
    prove: bool,
    #[pyo3(item)]
    time_limit: Option<f64>,
    /// A rule by its name, or numbers of agents.
    #[pyo3(item)]
    rule: String,
    #[pyo3(item)]
    first: Vec<u64>,
}

impl PlanChoices {
    fn options(self, scenario: &Scenario) -> PyResult<PlanOptions> {
        let priority = match self.rule.as_str() {
            "longest" => PriorityRule::Longest,
            "crowded" => PriorityRule::Crowded,
            "best" => PriorityRule::Best,
            _ => PriorityRule::Given(self.first),
        };
        if let PriorityRule::Given(ids) = &priority
            && let Some(id) = ids.iter().find(|id| scenario.agents.iter().all(|agent| agent.id != **id))
        {
            return Err(refused(format!("priority: no agent {id}")));
        }
        let time = match self.time_limit.map(Duration::try_from_secs_f64) {
            None => None,
            Some(Ok(time)) => Some(time),
            Some(Err(_)) => return Err(refused("time_limit: it is not a number of seconds")),
        };
        Ok(PlanOptions {
            method: if self.speeds { PlanMethod::Speed } else { PlanMethod::Delay },
            priority,
            objective: if self.makespan { Objective::Makespan } else { Objective::Sum },
            leave_out: self.leave_out,
            effort: DelaySearchOptions { prove: self.prove, time },
        })
    }
}

/// The output of `pcr check --json` for each of these texts of scenario files, on so many threads, or as many as there are cores. The first
/// fault, in the order of the texts, is that of the call; the number of its text is the last part of it.
#[pyfunction]
fn check_all(py: Python<'_>, texts: Vec<String>, threads: Option<usize>) -> PyResult<Vec<String>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).build().map_err(refused)?;
    let one = |text: &String| -> PyResult<String> {
        let scenario = Scenario::from_json(text).map_err(|error| misread(&error))?;
        json(&CheckReport::compute::<f64>(&scenario, false).map_err(refused)?)
    };
    let answers: Vec<PyResult<String>> = py.detach(|| pool.install(|| texts.par_iter().map(one).collect()));
    answers.into_iter().enumerate().map(|(at, answer)| answer.map_err(|fault| numbered(py, &fault, at))).collect()
}

/// Adds a number to a fault, as the last part of it.
fn numbered(py: Python<'_>, fault: &PyErr, number: usize) -> PyErr {
    let parts = || -> PyResult<Py<PyTuple>> {
        let mut parts: Vec<Bound<'_, PyAny>> = fault.value(py).getattr("args")?.try_iter()?.collect::<PyResult<_>>()?;
        parts.push(number.into_pyobject(py)?.into_any());
        Ok(PyTuple::new(py, parts)?.unbind())
    };
    parts().map_or_else(|other| other, Error::new_err)
}

#[pymodule]
fn _pcr(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("Error", module.py().get_type::<Error>())?;
    module.add_class::<Fleet>()?;
    module.add_class::<Layout>()?;
    module.add_function(wrap_pyfunction!(check_all, module)?)?;
    module.add("version", env!("CARGO_PKG_VERSION"))
}
