//! Unsafe delays of roadmaps of CPLP, every pair of edges against the definition with 106 bits, and how long the table takes:
//! `cargo run --profile checked -p pcr-tests --example delays -- [published-stats.json] ROADMAP.json...`. Files of that benchmark are
//! called `set3_...json`; its `stats.json` has the published times of the preprocessing of each set. Exit status 1 for any contact that is
//! missing and any end that is too far out.

use pcr_formats::import::ImportError;
use pcr_lab::roadmap;
use pcr_planning::exclusion_table::{EdgeDriving, StraightEdge, UnsafeDelayModel, UnsafeRelation};
use pcr_tests::delays::published::cut_conic;
use pcr_tests::delays::{DelayFault, Exact, ends_of};
use serde_json::Value;
use std::collections::HashMap;
use std::fs::read_to_string;
use std::hint::black_box;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// Repetitions of which the shortest is told.
const TIMES: usize = 5;

fn main() -> ExitCode {
    let (stats, roadmaps): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|file| file.ends_with("stats.json"));
    let published: Option<Value> = stats
        .first()
        .map(|file| serde_json::from_str(&read_to_string(file).expect("a file of published times")).expect("JSON"));
    let mut right = !roadmaps.is_empty();
    println!(
        "roadmap nodes edges | pairs unsafe missing wide | cut conic: wrong | table [ms] | published [s] times faster"
    );
    for file in &roadmaps {
        let name = Path::new(file).file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let set = name.split('_').next().unwrap_or_default().replace("set", "set_");
        let (imported, _) = roadmap::read(&read_to_string(file).expect("a roadmap")).expect("a roadmap");
        let (layout, speed) = (&imported.layout, imported.vehicle.speed);
        let driving = EdgeDriving { speed, acceleration: None };
        let mut least = f64::INFINITY;
        let mut found: HashMap<[usize; 2], [f64; 2]> = HashMap::new();
        for _ in 0..TIMES {
            let start = Instant::now();
            let delays = UnsafeDelayModel::new(&imported, driving, true).expect("a roadmap");
            let mut rows: Vec<Vec<UnsafeRelation>> = Vec::new();
            let take = |row| {
                rows.push(row);
                Ok::<(), ImportError>(())
            };
            delays.each(&|_, _| {}, &<[UnsafeRelation]>::to_vec, take).expect("a roadmap");
            black_box(&rows);
            least = least.min(start.elapsed().as_secs_f64());
            found = rows
                .concat()
                .into_iter()
                .filter_map(|found| match found {
                    UnsafeRelation::Delays(pair, interval) => Some((pair, interval)),
                    _ => None,
                })
                .collect();
        }
        let reach = 2.0 * imported.vehicle.radius;
        let (mut pairs, mut missing, mut wide, mut wrong) = (0, 0, 0, 0);
        let ends = layout.edges.iter().map(|edge| ends_of(layout, edge));
        let all: Vec<_> = ends
            .map(|[a, b]| (Exact::new(a, b, speed), StraightEdge::new(a, b, speed).expect("an edge"), [a, b]))
            .collect();
        for (a, (exact, straight, ends)) in all.iter().enumerate() {
            for (b, (other_exact, other, other_ends)) in all.iter().enumerate().skip(a) {
                pairs += 1;
                let interval = found.get(&[a, b]).copied();
                match exact.judge(other_exact, reach, interval, straight.error_bound(other, reach)) {
                    Err(problem @ (DelayFault::Missing { .. } | DelayFault::Beyond { .. })) => {
                        missing += 1;
                        eprintln!("{name} {a} {b}: {problem:?}");
                    }
                    Err(problem) => {
                        wide += 1;
                        eprintln!("{name} {a} {b}: {problem:?}");
                    }
                    Ok(()) => {}
                }
                let theirs = cut_conic(*ends, *other_ends, reach);
                let far = |[a, b]: [f64; 2], [c, d]: [f64; 2]| (a - c).abs().max((b - d).abs()) > 1e-6;
                wrong += usize::from(match (interval, theirs) {
                    (Some(ours), Some(theirs)) => far(ours, theirs),
                    (ours, theirs) => ours.is_some() != theirs.is_some(),
                });
            }
        }
        right &= missing == 0 && wide == 0;
        let time = published.as_ref().and_then(|stats| stats[&set]["GPP Time"]["mean"].as_f64());
        let beside = time.map_or(String::new(), |time| format!("{time:.2} {:.0}", time / least));
        println!(
            "{name} {} {} | {pairs} {} {missing} {wide} | {wrong} | {:.2} | {beside}",
            layout.nodes.len(),
            layout.edges.len(),
            found.len(),
            1e3 * least
        );
    }
    if right { ExitCode::SUCCESS } else { ExitCode::from(1) }
}
