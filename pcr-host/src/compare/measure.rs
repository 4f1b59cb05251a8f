//! Times, in rounds: in each round every method is run once, one after the other, so that what slows the machine down
//! for a while slows all of them down. A ratio is the median of the ratios of the rounds.

use super::errors::{Errors, Truth, errors};
use super::{Answer, Field, Input, Method, Question, methods};
use crate::fleet::Refused;
use crate::scenario::Scenario;
use serde::Serialize;
use std::hint::black_box;
use std::time::Instant;

/// How much time a comparison may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Rounds at most.
    pub rounds: usize,
    /// Time of a method in all its rounds, about \[s\]; there is always one round.
    pub budget: f64,
}

/// All methods on a scenario.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Name of the scenario.
    pub name: String,
    /// Their number.
    pub agents: usize,
    /// By the question, pcr first.
    pub rows: Vec<Row>,
}

/// A method on a scenario.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// With resolution or format.
    pub method: String,
    /// What it was asked.
    pub question: Question,
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
    pub errors: Errors,
}

impl Comparison {
    /// Runs all methods whose name holds one of `filters`, and the first one of each question; all of them without filters.
    /// `progress` is told how many methods are done, and of how many.
    ///
    /// # Errors
    /// [`Refused`] where a value does not fit floating point.
    pub fn new(
        scenario: &Scenario,
        effort: Effort,
        filters: &[String],
        progress: &mut dyn FnMut(usize, usize),
    ) -> Result<Self, Refused> {
        let input = Input::new(scenario)?;
        let field = input.field();
        let mut methods = methods();
        if !filters.is_empty() {
            methods.retain(|method| {
                let name = method.name();
                name == "pcr f64" || filters.iter().any(|filter| name.contains(filter))
            });
        }
        Ok(Self {
            name: scenario.name.clone(),
            agents: scenario.agents.len(),
            rows: compare(&field, &methods, effort, progress),
        })
    }
}

/// A method while it is measured.
struct Course<'m> {
    method: &'m dyn Method,
    /// Of each round \[s\], and of the baseline in the same round.
    times: Vec<[f64; 2]>,
    rounds: usize,
    row: Option<Row>,
}

fn compare(
    field: &Field<'_>,
    methods: &[Box<dyn Method>],
    effort: Effort,
    progress: &mut dyn FnMut(usize, usize),
) -> Vec<Row> {
    let truth = Truth::new(field);
    let total = methods.len();
    progress(0, total);
    // The first round tells how many more there is time for, and how good the answers are.
    let mut courses = Vec::new();
    for (done, method) in methods.iter().enumerate() {
        let begin = Instant::now();
        let answer = method.answer(field);
        let took = begin.elapsed().as_secs_f64();
        let rounds = ((effort.budget / took) as usize).clamp(1, effort.rounds);
        let row = answer.map(|answer| row(field, &truth, method.as_ref(), &answer));
        courses.push(Course { method: method.as_ref(), times: Vec::new(), rounds, row });
        progress(done + 1, total);
    }
    courses.retain(|course| course.row.is_some());
    let rounds = courses.iter().map(|course| course.rounds).max().unwrap_or(0);
    for round in 0..rounds {
        let mut baseline: Option<(Question, f64)> = None;
        for course in &mut courses {
            let question = course.method.question();
            let is_baseline = baseline.is_none_or(|(of, _)| of != question);
            if !is_baseline && round >= course.rounds {
                continue;
            }
            let begin = Instant::now();
            black_box(course.method.answer(black_box(field)));
            let took = begin.elapsed().as_secs_f64();
            let base = match baseline {
                Some((of, base)) if of == question => base,
                _ => {
                    baseline = Some((question, took));
                    took
                }
            };
            course.times.push([took, base]);
        }
    }
    courses.into_iter().filter_map(Course::finish).collect()
}

impl Course<'_> {
    fn finish(self) -> Option<Row> {
        let ms = 1e3 * median(self.times.iter().map(|[took, _]| *took).collect());
        let ratio = median(self.times.iter().map(|[took, base]| took / base).collect());
        self.row.map(|row| Row { ms, ratio, rounds: self.times.len(), ..row })
    }
}

fn row(field: &Field<'_>, truth: &Truth, method: &dyn Method, answer: &Answer<'_>) -> Row {
    let (count, bytes) = match answer {
        Answer::Regions(regions) => (regions.count(), regions.bytes()),
        Answer::Conflicts(found) => (found.len(), size_of_val(&found[..])),
    };
    let (method_name, question, tells) = (method.name(), method.question(), method.tells());
    let errors = errors(field, truth, answer);
    Row { method: method_name, question, tells, ms: 0.0, ratio: 1.0, rounds: 0, count, bytes, errors }
}

/// The middle one, the lower one of two.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len().saturating_sub(1) / 2).copied().unwrap_or(f64::NAN)
}
