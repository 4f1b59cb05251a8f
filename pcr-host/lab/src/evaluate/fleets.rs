//! Table VI, and all methods on two of its fleets.

use super::{DocumentSection, EvaluationError, PaperFleets, Thoroughness, picture};
use crate::methods::methods;
use pcr_comparing::compare::{Accuracy, Comparison, MethodMeasurement, MethodQuestion};
use pcr_comparing::report::comparison_table;
use pcr_planning::figures::{bytes, digits, time, times};
use std::fmt::Write as _;

pub(super) fn section(fleets: &PaperFleets, extent: Thoroughness) -> Result<DocumentSection, EvaluationError> {
    let filters: Vec<String> = extent.filters().iter().map(|&filter| filter.to_owned()).collect();
    let mut all = Vec::new();
    for fleet in &fleets.all {
        all.push(Comparison::new(&fleet.scenario, methods(), extent.effort(), &filters, &mut |_, _| {})?);
    }
    let mut text = table(fleets, &all);
    let mut pictures = Vec::new();
    for (fleet, comparison) in fleets.all.iter().zip(&all) {
        let names = match fleet.size {
            [12, 126] => [(MethodQuestion::Regions, "regions-12"), (MethodQuestion::Conflicts, "conflicts-12")],
            [100, _] => [(MethodQuestion::Regions, "regions-100"), (MethodQuestion::Conflicts, "conflicts-100")],
            _ => continue,
        };
        let agents = comparison.agents;
        let _ = writeln!(text, "\n## All methods, {agents} agents\n\n{WORDS}");
        let mut table = Vec::new();
        // Writing to memory does not fail.
        let _ = comparison_table(comparison, true, &mut table);
        text.push_str(String::from_utf8_lossy(&table).trim_start());
        text.push('\n');
        for (question, name) in names {
            let what = format!("{agents} agents: {}", question.title());
            text.push_str(&picture(name, &what));
            pictures.push((name, comparison.chart(question)));
        }
    }
    Ok(DocumentSection { text, pictures })
}

const WORDS: &str = "The first table is about all collision regions, both directions of every pair. *Area off* is the area of the symmetric \
difference to the exact regions (computed from the definition by bisection), divided by their area. *Kept* is the \
memory of the answer; sampled maps take a time and a length in single precision for each point. The second table is \
about the conflicts of the given motions: missed and invented ones, and the largest error of a beginning or end. Casts \
only find the first time of a pair. All methods exclude distant pairs first: pcr with boxes in space and time, which \
the others could use as well, the others with boxes of paths and of their pieces.\n";

fn find<'c>(comparison: &'c Comparison, question: MethodQuestion, name: &str) -> Option<&'c MethodMeasurement> {
    comparison.rows.iter().find(|row| row.question == question && row.method == name)
}

/// Ours and the paper's side by side.
fn table(fleets: &PaperFleets, all: &[Comparison]) -> String {
    let mut text = String::from(
        "## Table VI\n\nThe paper's fleets are not published. Ours have as many agents and regions as the paper's, counted as in the paper, \
        which counts crossings. The table compares the analytic method with the computational one, which samples both paths \
        every 0.01 s, and with mesh proximity every 0.01 s on cylinders of 100 triangles (by PQP in the paper, by parry3d and \
        FCL here). *Paper*: measured on a Pentium IV at 2.33 GHz. A ratio is a method's time divided by that of the analytic \
        method. Ours use the fastest sampled map that we could write, without boxes and with boxes.\n\n\
        | agents | crossings | analytic, paper | ours | sampled / analytic, paper | ours | ours, boxes | mesh / analytic, paper | parry3d | FCL | \
        memory analytic / sampled, paper | ours |\n|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    for (fleet, comparison) in fleets.all.iter().zip(all) {
        let [agents, crossings] = fleet.size;
        let [analytic, sampled, mesh] = fleet.paper;
        let regions = |name| find(comparison, MethodQuestion::Regions, name);
        let ratio = |row: Option<&MethodMeasurement>| row.map_or("–".into(), |row| times(row.ratio));
        let own = regions("pcr f64");
        let meshes = ["parry3d meshes 0.01 s", "FCL meshes 0.01 s"].map(|name| {
            let both = find(comparison, MethodQuestion::Conflicts, name).zip(own);
            both.map_or("–".into(), |(mesh, own)| times(mesh.ms / own.ms))
        });
        let memory = own.zip(regions("sampled map 0.01 s, boxes"));
        let _ = writeln!(
            text,
            "| {agents} | {crossings} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            time(analytic),
            own.map_or("–".into(), |own| time(own.ms)),
            times(sampled / analytic),
            ratio(regions("sampled map 0.01 s")),
            ratio(regions("sampled map 0.01 s, boxes")),
            times(mesh / analytic),
            meshes[0],
            meshes[1],
            fleet.memory,
            memory.map_or("–".into(), |(own, sampled)| format!("{} / {}", bytes(own.bytes), bytes(sampled.bytes))),
        );
    }
    let ratios = |fleet: &super::PaperFleet| fleet.paper[1] / fleet.paper[0];
    let paper = span(fleets.all.iter().map(ratios));
    let plain = span(ratios_of(all, "sampled map 0.01 s"));
    let boxes = span(ratios_of(all, "sampled map 0.01 s, boxes"));
    let area = span(all.iter().filter_map(|comparison| {
        match find(comparison, MethodQuestion::Regions, "sampled map 0.01 s, boxes")?.errors {
            Accuracy::Regions { area, difference } => Some(100.0 * difference / area),
            Accuracy::Conflicts { .. } => None,
        }
    }));
    if let (Some(paper), Some(plain), Some(boxes), Some(area)) = (paper, plain, boxes, area) {
        let _ = writeln!(
            text,
            "\nA sampled map takes {plain} times as long as the analytic one here, {paper} times in the paper. Boxes around paths and runs \
            of samples, which the paper's method does not have, bring that down to {boxes} times; the memory stays the same. \
            The area of a sampled map is off by {area} %."
        );
    }
    text
}

fn ratios_of<'c>(all: &'c [Comparison], name: &'c str) -> impl Iterator<Item = f64> + 'c {
    all.iter().filter_map(move |comparison| Some(find(comparison, MethodQuestion::Regions, name)?.ratio))
}

/// From the least to the largest.
fn span(values: impl Iterator<Item = f64>) -> Option<String> {
    let [least, most] =
        values.fold([f64::INFINITY, 0.0_f64], |[least, most], value| [least.min(value), most.max(value)]);
    (least <= most).then(|| format!("{} to {}", digits(least), digits(most)))
}
