//! Methods that find collisions, side by side: the answers of each method, the time that it takes, the memory that it
//! needs, and its errors.
//!
//! ```text
//! disc_track      discs in motion as plain numbers
//! reference       the definition, evaluated by bisection: the reference for errors
//! pcr             this library, in every format, on one core and all
//! sampled         the sampled collision map of the paper's reference [34]
//! polyline        flattened paths, closed-form discs piece by piece
//! mesh_proximity  proximity of meshes, sample by sample, as the paper uses PQP
//! crowd           random fleets of any size
//! errors          an answer against the reference
//! measure         times, in rounds                  Comparison
//! error_chart     time against error
//! stopwatch       processor time of one core, also on a busy machine
//! ```
//!
//! All methods start from the same paths and motions, already placed in the plane. Sampling, flattening and the
//! construction of meshes are part of a method, and of its time.

mod crowd;
pub mod disc_track;
mod error_chart;
mod errors;
mod measure;
pub mod mesh_proximity;
mod pcr;
pub mod polyline;
pub mod reference;
pub mod sampled;
pub mod stopwatch;

pub use crowd::crowd;
pub use disc_track::DiscTrack;
pub use errors::Accuracy;
pub use measure::{Comparison, MeasurementBudget, MethodMeasurement, UnavailableMethod, median};

use pcr_core::{CapacityError, Motion};
use pcr_fixed::Q16;
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::{Fleet, FormatRangeError, HostScalar};
use serde::Serialize;
use std::hint::black_box;
use std::{fmt, io};
use stopwatch::{Stopwatch, steady};

/// A fleet, in every form that a method starts from.
#[derive(Debug)]
pub struct ComparisonInput {
    tracks: Vec<DiscTrack>,
    double: Fleet<f64>,
    single: Fleet<f32>,
    fixed: Result<Fleet<Q16>, FormatRangeError>,
}

/// A fleet in the form that each of the methods takes, ready to use.
#[derive(Debug)]
pub struct ComparisonFleet<'a> {
    /// The discs and their paths as plain numbers.
    pub tracks: &'a [DiscTrack],
    double: Vec<Motion<'a, f64>>,
    single: Vec<Motion<'a, f32>>,
    /// None where the fleet is beyond the format.
    fixed: Option<Vec<Motion<'a, Q16>>>,
    /// From the first start to the last arrival \[s\].
    pub horizon: [f64; 2],
}

impl ComparisonInput {
    /// The agents of a scenario.
    ///
    /// # Errors
    /// [`FormatRangeError`] where a value does not fit floating point.
    pub fn new(scenario: &Scenario) -> Result<Self, FormatRangeError> {
        Ok(Self {
            tracks: scenario.agents.iter().map(DiscTrack::new).collect(),
            double: Fleet::new(scenario)?,
            single: Fleet::new(scenario)?,
            fixed: Fleet::new(scenario),
        })
    }

    /// Ready to use.
    pub fn field(&self) -> ComparisonFleet<'_> {
        let double = self.double.motions();
        let time = Motion::span(&double);
        ComparisonFleet {
            tracks: &self.tracks,
            double,
            single: self.single.motions(),
            fixed: self.fixed.as_ref().ok().map(Fleet::motions),
            horizon: [time.lo, time.hi],
        }
    }
}

/// What a method is asked for, and what it can answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum MethodQuestion {
    /// All collision regions: where an agent must not be at what time, whatever its motion.
    Regions,
    /// Whether agents collide in the given motions.
    Conflicts,
}

/// A contact that a method found: two agents, the lower one first, and when \[s\]; no end where it tells none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MethodContact {
    /// Places of the agents in the fleet.
    pub agents: [usize; 2],
    /// Its first time \[s\].
    pub begin: f64,
    /// Its last time \[s\], where the method tells one.
    pub end: Option<f64>,
}

/// The collision regions that a method found.
pub trait RegionSet {
    /// Both directions of every pair.
    fn count(&self) -> usize;
    /// What is kept of them.
    fn bytes(&self) -> usize;
    /// Lengths of the path of `ego` that `other` blocks at a time \[m\]; disjoint, increasing.
    fn slice(&self, ego: usize, other: usize, time: f64) -> Vec<[f64; 2]>;
}

/// What a method found.
pub enum MethodAnswer<'a> {
    /// Collision regions.
    Regions(Box<dyn RegionSet + 'a>),
    /// By the agents, then by the begin.
    Conflicts(Vec<MethodContact>),
}

/// An answer, or why there is none.
pub type MethodResult<'f> = Result<MethodAnswer<'f>, MethodError>;

/// Why a method has no answer that can have one for other fleets.
#[derive(Debug)]
pub enum MethodError {
    /// The fleet is beyond what the method can hold.
    Beyond,
    /// The table of the method is too large.
    Full(CapacityError),
    /// The program of the method failed.
    Program(io::Error),
}

impl fmt::Display for MethodError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Beyond => f.write_str("this fleet is beyond what it can hold"),
            Self::Full(full) => full.fmt(f),
            Self::Program(error) => write!(f, "its program failed: {error}"),
        }
    }
}

impl std::error::Error for MethodError {}

impl From<CapacityError> for MethodError {
    fn from(full: CapacityError) -> Self {
        Self::Full(full)
    }
}

/// A way to find collisions.
pub trait CollisionMethod: Sync {
    /// With resolution or format.
    fn name(&self) -> String;
    /// What it is asked for.
    fn question(&self) -> MethodQuestion;
    /// What it tells, in words.
    fn output_description(&self) -> &'static str;
    /// Whether it works on all cores.
    fn is_parallel(&self) -> bool {
        false
    }
    /// What it needs and is not there.
    fn missing(&self) -> Option<&'static str> {
        None
    }
    /// The answer, or why there is none: a fleet beyond its limits, or a program that failed.
    fn answer<'f>(&self, field: &'f ComparisonFleet<'_>) -> MethodResult<'f>;
    /// The time that the answer takes \[s\], and the answer.
    fn timed<'f>(&self, field: &'f ComparisonFleet<'_>) -> (f64, MethodResult<'f>) {
        let clock = if self.is_parallel() { Stopwatch::wall } else { Stopwatch::elapsed };
        steady(clock, || self.answer(black_box(field)))
    }
}

/// Returns the methods of `pcr compare`; pcr on one core first for each question: what the others are compared with.
pub fn methods() -> Vec<Box<dyn CollisionMethod>> {
    let mut methods = pcr::regions();
    methods.extend(sampled::methods());
    methods.extend(pcr::conflicts());
    methods.extend(polyline::methods());
    methods.extend(mesh_proximity::methods());
    methods
}

/// Returns the names of methods, each once, in alphabetic order.
pub fn names(methods: &[Box<dyn CollisionMethod>]) -> Vec<String> {
    methods.iter().map(|method| method.name()).collect::<std::collections::BTreeSet<_>>().into_iter().collect()
}

/// A number format with a fleet in it.
trait ComparedScalar: HostScalar {
    fn motions<'f, 'a>(field: &'f ComparisonFleet<'a>) -> Option<&'f [Motion<'a, Self>]>;
}

impl ComparedScalar for f64 {
    fn motions<'f, 'a>(field: &'f ComparisonFleet<'a>) -> Option<&'f [Motion<'a, Self>]> {
        Some(&field.double)
    }
}

impl ComparedScalar for f32 {
    fn motions<'f, 'a>(field: &'f ComparisonFleet<'a>) -> Option<&'f [Motion<'a, Self>]> {
        Some(&field.single)
    }
}

impl ComparedScalar for Q16 {
    fn motions<'f, 'a>(field: &'f ComparisonFleet<'a>) -> Option<&'f [Motion<'a, Self>]> {
        field.fixed.as_deref()
    }
}
