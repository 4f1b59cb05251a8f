//! Vehicles that obey nothing but a written file, as many missions as are asked for, for each of `pcr_tests::written::ALL`:
//! `cargo run --profile checked -p pcr-tests --example exclusions -- MISSIONS [SEED [PATTERN]]`, of those whose names hold a pattern.
//! Exit status 1 if any two touch, or it is not decided.

use pcr_tests::written::ALL;
use std::process::ExitCode;
use std::time::Instant;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some(missions) = arguments.first().and_then(|missions| missions.parse().ok()) else {
        eprintln!("MISSIONS [SEED [PATTERN]]");
        return ExitCode::from(2);
    };
    let seed = arguments.get(1).map_or(1, |seed| seed.parse().expect("a seed"));
    let pattern = arguments.get(2).map_or("", String::as_str);
    let (mut all, mut held) = (0, 0);
    for file in ALL.into_iter().filter(|file| file.to_string().contains(pattern)) {
        let start = Instant::now();
        let (report, run) = file.obeyed(missions, seed).unwrap_or_else(|why| panic!("{file}: {why}"));
        println!(
            "{file}: {} groups, {} pairs that can touch; {} missions, {} edges, refused {} times, {} taken out; {} pairs proved, \
             {} contacts; {:.1} s",
            report.groups,
            report.can_touch,
            run.missions,
            run.edges,
            run.refused,
            run.taken_out,
            run.pairs,
            run.contacts.len(),
            start.elapsed().as_secs_f64()
        );
        for contact in run.contacts.iter().take(10) {
            println!("  {contact:?}");
        }
        all += 1;
        held += usize::from(run.contacts.is_empty() && run.missions >= missions);
    }
    println!("{held} of {all} files suffice");
    if all > 0 && held == all { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
