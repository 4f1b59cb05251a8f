//! How long a change of one edge takes in a roadmap of any size: `change ROADMAP RADIUS`. Every hundredth edge or so is taken out and put
//! back; prints how many edges there are, and the median and the longest time of a change \[ms\].

use pcr_formats::import::{ImportOptions, InputFormat, Warnings, layout};
use pcr_planning::exclusion_table::IncrementalExclusions;
use std::path::Path;
use std::time::Instant;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, radius] = &arguments[..] else { panic!("ROADMAP RADIUS") };
    let text = std::fs::read_to_string(file).expect("a roadmap");
    let format = InputFormat::detect(Path::new(file), &text).expect("a format");
    let options = ImportOptions { radius: Some(radius.parse().expect("a radius")), ..ImportOptions::default() };
    let imported = layout(format, &text, &options, &mut Warnings::default()).expect("a roadmap");
    let edges = imported.layout.edges.clone();
    let mut table = IncrementalExclusions::new(imported).expect("a table");
    let mut times: Vec<f64> = Vec::new();
    for edge in edges.iter().step_by((edges.len() / 100).max(1)) {
        let start = Instant::now();
        table.remove(&edge.id).expect("an edge");
        let removed = start.elapsed();
        let start = Instant::now();
        table.insert(edge.clone()).expect("an edge");
        times.extend([removed, start.elapsed()].map(|time| 1e3 * time.as_secs_f64()));
    }
    times.sort_by(f64::total_cmp);
    println!("{} edges: {:.3} ms, {:.3} ms at most", edges.len(), times[times.len() / 2], times[times.len() - 1]);
}
