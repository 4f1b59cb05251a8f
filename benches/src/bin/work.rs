//! Does one job again and again, for profilers: `work JOB FLEET TIMES`.
//!
//! The jobs are `table` (all regions of the fleet), `exchange` (those of its first agent), `conflicts` (when agents are in
//! contact), `pairs` (the same without a broad phase, pair by pair), `certify` (the proof of the table) and `motions` (the proof that
//! nobody meets, or where). Fleets are `scattered`, 100 agents that cannot meet,
//! `serpentine`, two agents whose paths cross 2000 times, and the files of `tests/data`. Prints the pairs of agents and the pieces of both directions of the fleet.

use pcr_benches::{Storage, boxes, fleet, scattered, serpentine};
use pcr_certify::motion::{Mover, meetings};
use pcr_certify::table::{Checker, CoverageMargin};
use pcr_core::{BroadPhase, Encounter, Motion};
use pcr_planning::checker_input;
use pcr_planning::fleet::build_ecm;
use std::hint::black_box;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (job, name, times) = match arguments.as_slice() {
        [job, name, times] => (job.as_str(), name.as_str(), times.parse()),
        _ => ("", "", "".parse()),
    };
    const JOBS: [&str; 6] = ["table", "exchange", "conflicts", "pairs", "certify", "motions"];
    let (Ok(times), true): (Result<u32, _>, _) = (times, JOBS.contains(&job)) else {
        eprintln!("work {} FLEET TIMES", JOBS.join("|"));
        return ExitCode::from(2);
    };
    let fleet = match name {
        "scattered" => scattered::<f64>(10),
        "serpentine" => serpentine(),
        _ => fleet::<f64>(name),
    };
    let mut motions = fleet.motions();
    let time = Motion::span(&motions);
    let mut storage = Storage::of(&motions);
    println!("{} {}", motions.len() * (motions.len() - 1) / 2, 2 * storage.pieces.len());
    let first = motions[0];
    let mut boxes = boxes(&motions);
    let mut exchanged = storage.clone();
    let mut exchanged = exchanged.table(&motions);
    let ids: Vec<u64> = (0..motions.len() as u64).collect();
    let agents = checker_input::agents(&fleet, &motions, &ids);
    let certified = build_ecm(&motions).map(|ecm| checker_input::table(agents.clone(), &motions, &ecm));
    let certified = certified.expect("the table of the fleet");
    for _ in 0..times {
        black_box(match job {
            "table" => storage.table(black_box(&motions)).len(),
            "exchange" => usize::from(exchanged.replace(&mut motions, 0, black_box(first)).is_ok()),
            "pairs" => {
                let fleet = black_box(&motions);
                let pairs = (0..fleet.len()).flat_map(|i| (i + 1..fleet.len()).map(move |j| (&fleet[i], &fleet[j])));
                pairs.map(|(a, b)| Encounter::new(a, b).contacts(time).count()).sum()
            }
            "certify" => {
                let found =
                    Checker::new(black_box(&certified)).and_then(|checker| checker.check(CoverageMargin::Needed));
                found.map_or(0, |found| found.steps)
            }
            "motions" => {
                let ends = [time.lo, time.hi];
                let movers = black_box(&agents).iter().map(|agent| Mover::new(agent, ends));
                movers.collect::<Result<Vec<_>, _>>().map_or(0, |movers| meetings(&movers).steps)
            }
            _ => {
                let broad_phase = BroadPhase::new(&mut boxes[..], black_box(&motions), time);
                broad_phase.map_or(0, |broad_phase| broad_phase.contacts().count())
            }
        });
    }
    ExitCode::SUCCESS
}
