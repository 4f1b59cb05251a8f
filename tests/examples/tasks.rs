//! Lifelong tasks of others on roadmaps, done by robots under passing orders: `tasks DIRECTORY [SECONDS]`.
//!
//! Each file `set*.json` of Adcombrink/CPLP-LifelongMAPFR has a roadmap, robots of radius 1 and speed 1 that start and stop at once, and tasks
//! that come over time; `published-stats.json` has the throughput and the times of planning of the method there.

use pcr_planning::lifelong::{Delays, Method, Request, run_tasks};
use pcr_tests::roadmap_tasks::read;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let directory = std::path::PathBuf::from(arguments.next().ok_or("tasks DIRECTORY [SECONDS]")?);
    let duration: f64 = arguments.next().map_or(Ok(1200.0), |seconds| seconds.parse())?;
    let published: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(directory.join("published-stats.json"))?)?;
    let mut files: Vec<_> = std::fs::read_dir(&directory)?.collect::<Result<Vec<_>, _>>()?;
    files.sort_by_key(|file| file.file_name());
    for file in files.iter().map(|file| file.path()) {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let Some((set, _)) = name.strip_prefix("set").and_then(|rest| rest.split_once('_')) else { continue };
        let (imported, tasks) = read(&std::fs::read_to_string(&file)?)?;
        let delays = Delays { stopped: 0.0, slip: 0.0, ..Delays::default() };
        let request = Request { agents: tasks.starts.len(), duration, delays, seed: 1, method: Method::Orders };
        let report = match run_tasks(&imported, request, &tasks) {
            Ok(report) => report,
            Err(problem) => {
                println!("{name}: {problem}");
                continue;
            }
        };
        let outcome = &report.outcome;
        let theirs = &published[format!("set_{set}")];
        let of = |what: &str| theirs[what]["mean"].as_f64().unwrap_or(f64::NAN);
        println!(
            "{name}: {} robots, {} of {} tasks in {:.1} s, {:.4} a second (published {:.4}); contact {}, stuck {}, standstill {:.0} s, refused {}; {} decisions, mean {:.3} ms, p99 {:.3} ms \
             (published mean {:.3} ms); {} safe ends; in {:.1} s",
            outcome.robots,
            outcome.missions,
            tasks.tasks.len(),
            report.last_arrival,
            outcome.missions as f64 / report.last_arrival,
            of("Throughput"),
            outcome.certificate.verdict,
            outcome.stuck,
            outcome.standstill,
            outcome.refused,
            report.decisions.len(),
            1e3 * report.decisions.iter().map(|it| it.as_secs_f64()).sum::<f64>()
                / report.decisions.len().max(1) as f64,
            1e3 * report.decided_within(0.99),
            1e3 * of("Planning Computation Time (per call)"),
            report.layout.safe_ends.len(),
            report.time.as_secs_f64(),
        );
    }
    Ok(())
}
