//! Charts of comparisons: time against error.

use super::{Accuracy, Comparison, MethodQuestion};
use pcr_drawing::plot::{Chart, DataSeries};
use pcr_formats::scenario::printable;

/// Errors below this are drawn as large as this.
const LEAST: f64 = 1e-10;

impl MethodQuestion {
    /// What its chart shows.
    pub fn title(self) -> &'static str {
        match self {
            Self::Regions => "time and error of all regions",
            Self::Conflicts => "time and error of all conflicts",
        }
    }
}

impl Comparison {
    /// The time of each method and how far it is off, as SVG.
    pub fn chart(&self, question: MethodQuestion) -> String {
        let rows = self.rows.iter().filter(|row| row.question == question);
        let series = rows.map(|row| {
            let error = match row.errors {
                Accuracy::Conflicts { time, .. } => time,
                Accuracy::Regions { area, difference } => difference / area,
            };
            // Without any area there is no share of it.
            let error = if error.is_finite() { error.max(LEAST) } else { LEAST };
            DataSeries { name: row.method.clone(), points: vec![[row.ms, error]], line: false }
        });
        let error = match question {
            MethodQuestion::Regions => "area off, as a part of all",
            MethodQuestion::Conflicts => "largest error of a begin or end [s]",
        };
        let of = if self.name.is_empty() { String::new() } else { format!("{}, ", printable(&self.name)) };
        let title = format!("{of}{} agents: {}", self.agents, question.title());
        Chart { title: &title, axes: ["time [ms]", error], series: series.collect() }.draw()
    }
}
