//! Times, measured in rounds: in each round all methods run, one after the other, so that anything that slows the
//! machine down for a while affects all of them. A ratio is the median of the ratios of the rounds.

use super::errors::{Accuracy, GroundTruth, errors};
use super::{CollisionMethod, ComparisonFleet, ComparisonInput, MethodAnswer, MethodQuestion};
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::FormatRangeError;
use serde::Serialize;

/// How much time a comparison may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasurementBudget {
    /// Rounds at most.
    pub rounds: usize,
    /// Time of a method in all its rounds, about \[s\]; there is always one round.
    pub budget: f64,
    /// Slices of regions, about, by which they are compared with the reference.
    pub slices: usize,
}

/// All methods on a scenario.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Name of the scenario.
    pub name: String,
    /// Their number.
    pub agents: usize,
    /// By the question, pcr first.
    pub rows: Vec<MethodMeasurement>,
    /// Methods that were asked for and have no row.
    pub absent: Vec<UnavailableMethod>,
    /// Warnings about input that was changed or left out when it was read.
    pub warnings: Vec<String>,
}

/// A method without an answer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct UnavailableMethod {
    /// With resolution or format.
    pub method: String,
    /// Why.
    pub reason: String,
}

/// A method on a scenario.
#[derive(Clone, Debug, Serialize)]
pub struct MethodMeasurement {
    /// With resolution or format.
    pub method: String,
    /// What it was asked.
    pub question: MethodQuestion,
    /// What it tells.
    pub tells: &'static str,
    /// Median of the rounds \[ms\].
    pub ms: f64,
    /// Median of the ratios to the first method of the same question in the same round.
    pub ratio: f64,
    /// Rounds.
    pub rounds: usize,
    /// Regions, for sampled maps pairs that have any, or conflicts.
    pub count: usize,
    /// What is kept of the answer.
    pub bytes: usize,
    /// How far it is off.
    pub errors: Accuracy,
}

impl Comparison {
    /// Runs those of the `methods` whose name holds one of `filters`, and pcr; all of them without filters. `progress` is called with the
    /// number of methods that are done, and of all.
    ///
    /// # Errors
    /// [`FormatRangeError`] where a value does not fit floating point.
    pub fn new(
        scenario: &Scenario,
        mut methods: Vec<Box<dyn CollisionMethod>>,
        effort: MeasurementBudget,
        filters: &[String],
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, FormatRangeError> {
        let input = ComparisonInput::new(scenario)?;
        let field = input.field();
        if !filters.is_empty() {
            methods.retain(|method| {
                let name = method.name();
                name == "pcr f64" || filters.iter().any(|filter| name.contains(filter))
            });
        }
        let (rows, absent) = compare(&field, &methods, effort, progress);
        let warnings = scenario.warnings.clone();
        Ok(Self { name: scenario.name.clone(), agents: scenario.agents.len(), rows, absent, warnings })
    }
}

/// A method while it is measured.
struct MethodTimer<'m> {
    method: &'m dyn CollisionMethod,
    /// Of each round \[s\], and of the baseline in the same round.
    times: Vec<[f64; 2]>,
    rounds: usize,
    row: MethodMeasurement,
}

fn compare(
    field: &ComparisonFleet<'_>,
    methods: &[Box<dyn CollisionMethod>],
    effort: MeasurementBudget,
    progress: &mut dyn FnMut(usize, usize),
) -> (Vec<MethodMeasurement>, Vec<UnavailableMethod>) {
    let truth = GroundTruth::new(field, effort.slices);
    let total = methods.len();
    progress(0, total);
    // The first round tells how many more there is time for, and how good the answers are.
    let mut courses: Vec<MethodTimer<'_>> = Vec::new();
    let mut absent = Vec::new();
    let mut baseline = None;
    for (done, method) in methods.iter().enumerate() {
        let method = method.as_ref();
        let mut leave_out = |reason: String| absent.push(UnavailableMethod { method: method.name(), reason });
        if let Some(reason) = method.missing() {
            leave_out(reason.to_owned());
            continue;
        }
        if baseline.is_none_or(|of: &dyn CollisionMethod| of.question() != method.question()) {
            baseline = Some(method);
        }
        let base = baseline.map_or(f64::NAN, |baseline| baseline.timed(field).0);
        let (took, answer) = method.timed(field);
        let rounds = ((effort.budget / took) as usize).clamp(1, effort.rounds);
        match answer {
            Ok(answer) => {
                let row = row(&truth, method, &answer);
                courses.push(MethodTimer { method, times: vec![[took, base]], rounds, row });
            }
            Err(reason) => leave_out(reason.to_string()),
        }
        progress(done + 1, total);
    }
    let rounds = courses.iter().map(|course| course.rounds).max().unwrap_or(0);
    for round in 1..rounds {
        let mut baseline: Option<(MethodQuestion, f64)> = None;
        for course in &mut courses {
            let question = course.method.question();
            let known = baseline.filter(|(of, _)| *of == question);
            if known.is_some() && round >= course.rounds {
                continue;
            }
            let took = course.method.timed(field).0;
            let base = known.map_or(took, |(_, base)| base);
            baseline = Some((question, base));
            course.times.push([took, base]);
        }
    }
    (courses.into_iter().map(MethodTimer::finish).collect(), absent)
}

impl MethodTimer<'_> {
    fn finish(self) -> MethodMeasurement {
        let ms = 1e3 * median(self.times.iter().map(|[took, _]| *took).collect());
        let ratio = median(self.times.iter().map(|[took, base]| took / base).collect());
        MethodMeasurement { ms, ratio, rounds: self.times.len(), ..self.row }
    }
}

fn row(truth: &GroundTruth, method: &dyn CollisionMethod, answer: &MethodAnswer<'_>) -> MethodMeasurement {
    let (count, bytes) = match answer {
        MethodAnswer::Regions(regions) => (regions.count(), regions.bytes()),
        MethodAnswer::Conflicts(found) => (found.len(), size_of_val(&found[..])),
    };
    let (method_name, question, tells) = (method.name(), method.question(), method.output_description());
    let errors = errors(truth, answer);
    MethodMeasurement { method: method_name, question, tells, ms: 0.0, ratio: 1.0, rounds: 0, count, bytes, errors }
}

/// Returns the middle one of some values, the lower one of two; NaN of none.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len().saturating_sub(1) / 2).copied().unwrap_or(f64::NAN)
}
