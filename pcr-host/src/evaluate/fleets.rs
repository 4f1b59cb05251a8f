//! Table VI, and all methods on two of its fleets.

use super::{Extent, Fleets, Problem, Section, picture};
use crate::compare::{Comparison, Errors, Question, Row};
use crate::picture::plot::{Chart, Series};
use crate::report::comparison_table;
use crate::report::figures::{bytes, digits, time, times};
use std::fmt::Write as _;

pub(super) fn section(fleets: &Fleets, extent: Extent) -> Result<Section, Problem> {
    let filters: Vec<String> = extent.filters().iter().map(|&filter| filter.to_owned()).collect();
    let mut all = Vec::new();
    for fleet in &fleets.0 {
        all.push(Comparison::new(&fleet.scenario, extent.effort(), &filters, &mut |_, _| {})?);
    }
    let mut text = table(fleets, &all);
    let mut pictures = Vec::new();
    let shown = [
        ("12", fleets.0.iter().position(|fleet| fleet.size == [12, 126])),
        ("100", fleets.0.iter().position(|fleet| fleet.size[0] == 100)),
    ];
    for (agents, place) in shown {
        let Some(comparison) = place.and_then(|place| all.get(place)) else { continue };
        let name = if agents == "12" { "methods-12" } else { "methods-100" };
        let _ = writeln!(text, "\n## All methods, {agents} agents\n\n{}", WORDS);
        let mut table = Vec::new();
        // Writing to memory does not fail.
        let _ = comparison_table(comparison, true, &mut table);
        text.push_str(String::from_utf8_lossy(&table).trim_start());
        let what = format!("Time and error of the conflicts of {agents} agents");
        let _ = write!(text, "\n{}", picture(name, &what));
        pictures.push((name, chart(comparison, &what)));
    }
    Ok(Section { text, pictures })
}

const WORDS: &str = "First all collision regions, both directions of every pair: *area off* is the area of the symmetric difference to the \
regions by the definition (found by halving), as a part of theirs; kept is what the answer takes, for sampled maps a time and a \
length in single precision for each point. Then the conflicts of the motions as they are: missed and invented ones, and the largest error of a \
begin or end. Casts tell the first time of a pair only.\n";

fn find<'c>(comparison: &'c Comparison, question: Question, name: &str) -> Option<&'c Row> {
    comparison.rows.iter().find(|row| row.question == question && row.method == name)
}

/// Ours and the paper's side by side.
fn table(fleets: &Fleets, all: &[Comparison]) -> String {
    let mut text = String::from(
        "## Table VI\n\nThe paper's fleets are not published; these have as many agents and regions as its own, by its count, which is that of \
        crossings. The analytic method against the computational one, which samples both paths every 0.01 s, and mesh \
        proximity every 0.01 s with cylinders of 100 triangles. *Paper*: a Pentium IV at 2.33 GHz. A ratio is that of a method's time to \
        that of the analytic method; ours are against the fastest sampled map that we could write, without boxes and with them.\n\n\
        | agents | crossings | analytic, paper | ours | sampled / analytic, paper | ours | ours, boxes | mesh / analytic, paper | ours | \
        memory analytic / sampled, ours |\n|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    for (fleet, comparison) in fleets.0.iter().zip(all) {
        let [agents, crossings] = fleet.size;
        let [analytic, sampled, mesh] = fleet.paper;
        let regions = |name| find(comparison, Question::Regions, name);
        let ratio = |row: Option<&Row>| row.map_or("–".into(), |row| times(row.ratio));
        let own = regions("pcr f64");
        let mesh_ratio = find(comparison, Question::Conflicts, "parry3d meshes 0.01 s")
            .zip(own)
            .map_or("–".into(), |(mesh, own)| times(mesh.ms / own.ms));
        let memory = own.zip(regions("sampled map 0.01 s, boxes"));
        let _ = writeln!(
            text,
            "| {agents} | {crossings} | {} | {} | {} | {} | {} | {} | {mesh_ratio} | {} |",
            time(analytic),
            own.map_or("–".into(), |own| time(own.ms)),
            times(sampled / analytic),
            ratio(regions("sampled map 0.01 s")),
            ratio(regions("sampled map 0.01 s, boxes")),
            times(mesh / analytic),
            memory.map_or("–".into(), |(own, sampled)| format!("{} / {}", bytes(own.bytes), bytes(sampled.bytes))),
        );
    }
    let sampled = all.iter().filter_map(|comparison| {
        let row = find(comparison, Question::Regions, "sampled map 0.01 s, boxes")?;
        let Errors::Regions { area, difference } = row.errors else { return None };
        Some(difference / area)
    });
    let (least, most) = sampled.fold((f64::INFINITY, 0.0_f64), |(least, most), part| (least.min(part), most.max(part)));
    if least <= most {
        let _ = writeln!(
            text,
            "\nThe sampled maps are off by {} % to {} % of the area of the regions. The ratio without boxes is of the paper's order; \
            boxes around paths and runs of samples, which its method did not have, take most of the work away, not the memory.",
            digits(100.0 * least),
            digits(100.0 * most)
        );
    }
    text
}

fn chart(comparison: &Comparison, title: &str) -> String {
    let series = comparison.rows.iter().filter_map(|row| match row.errors {
        Errors::Conflicts { time, .. } => {
            Some(Series { name: row.method.clone(), points: vec![[row.ms, time.max(1e-10)]], line: false })
        }
        Errors::Regions { .. } => None,
    });
    let axes = ["time [ms]", "largest error of a begin or end [s]"];
    Chart { title, axes, series: series.collect() }.draw()
}
