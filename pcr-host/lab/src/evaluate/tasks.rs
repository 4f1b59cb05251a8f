//! Lifelong tasks on roadmaps of others, beside the published figures of a method for discrete orders.

use super::{DocumentSection, EvaluationError, PaperFleets, Thoroughness};
use crate::roadmap;
use pcr_execution::lifelong::{CoordinationMethod, DelayModel, LifelongOptions, MeasuredLifelongRun, run_tasks};
use pcr_planning::figures::digits;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Sets of the benchmark.
const SETS: usize = 9;

/// All tasks are done by then \[s\].
const LONGEST: f64 = 1200.0;

pub(super) fn section(fleets: &PaperFleets, extent: Thoroughness) -> Result<DocumentSection, EvaluationError> {
    let (sets, count) = match extent {
        Thoroughness::Full => (SETS, usize::MAX),
        Thoroughness::Quick => (1, 5),
    };
    let usual = DelayModel::default();
    let mut text = format!(
        "## Tasks on roadmaps\n\nTasks that come over time on the roadmaps of CPLP (Combrink, Roselli, Fabian, arXiv 2503.13175; `tests/data/real/cplp`), \
        for discs of 1 m at 1 m/s that start, stop and turn at once, as published. A task is done by the first robot that is at its node after it has \
        come. *A second*: all tasks divided by the time of the last one; *published*: the mean of the three instances of each set, of which \
        the first one is done here. *Late*: the same if robots are stopped for {} % of the time, {} s each, and are up to {} % slower. \
        *Decision*: mean time to choose robot, way and orders, beside the published mean of a call of their planner (Python, another machine). \
        *Contact*: verdict of the independent checker on the recorded motions, without and with delays. Decisions look at those whom they are about, \
        as in large fleets.\n\n\
        | set | nodes | robots | tasks | safe ends | a second | published | ratio | late | decision | published | faster | stuck | contact |\n\
        |---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|\n",
        100.0 * usual.stopped,
        usual.stop,
        100.0 * usual.slip
    );
    let folder = fleets.data.join("real/cplp");
    let stats = folder.join("published-stats.json");
    let published: Value = serde_json::from_str(&read(&stats)?)
        .map_err(|error| EvaluationError::File(stats.clone(), error.to_string()))?;
    for set in 0..sets {
        let file = folder.join(file(set));
        let problem = |problem: String| EvaluationError::File(file.clone(), problem);
        let (imported, mut tasks) = roadmap::read(&read(&file)?).map_err(|refused| problem(refused.to_string()))?;
        tasks.tasks.truncate(count);
        let done = |delays: DelayModel| {
            let request =
                LifelongOptions { agents: 0, duration: LONGEST, delays, seed: 1, method: CoordinationMethod::Orders };
            run_tasks(&imported, request, &tasks).map_err(|refused| problem(refused.to_string()))
        };
        let runs = [done(DelayModel { stopped: 0.0, slip: 0.0, ..usual })?, done(usual)?];
        // The rate of those that are done would be too high.
        if let Some(run) = runs.iter().find(|run| run.outcome.missions < tasks.tasks.len()) {
            let (done, all) = (run.outcome.missions, tasks.tasks.len());
            return Err(problem(format!("{done} of {all} tasks are done after {LONGEST} s")));
        }
        let figures = &published[format!("set_{set}")];
        let [Some(rate), Some(call)] =
            ["Throughput", "Planning Computation Time (per call)"].map(|what| figures[what]["mean"].as_f64())
        else {
            return Err(EvaluationError::File(
                stats,
                format!("set_{set}: its throughput or time of a call is missing"),
            ));
        };
        text.push_str(&row(set, &runs, [rate, call]));
    }
    Ok(DocumentSection { text, pictures: Vec::new() })
}

/// The file of a set.
fn file(set: usize) -> String {
    const FILES: [&str; SETS] =
        ["301c854d", "688009a3", "7cd988d3", "082915a1", "83630882", "bb6cd4d7", "6fcc5c86", "2910f867", "15ee252a"];
    format!("set{set}_{}.json", FILES[set])
}

/// A line of the table, beside the published rate \[1/s\] and time of a call \[s\].
fn row(set: usize, runs: &[MeasuredLifelongRun; 2], [rate, call]: [f64; 2]) -> String {
    let [report, late] = runs;
    let a_second = |report: &MeasuredLifelongRun| report.outcome.missions as f64 / report.last_arrival;
    let decision =
        report.decisions.iter().map(|it| it.as_secs_f64()).sum::<f64>() / report.decisions.len().max(1) as f64;
    let [stuck, late_stuck] = [report, late].map(|report| report.outcome.stuck);
    let verdicts = [report, late].map(|report| match report.outcome.certificate.verdict {
        "proved" => "none, proved",
        other => other,
    });
    let contact = if verdicts[0] == verdicts[1] { verdicts[0].to_owned() } else { verdicts.join("; ") };
    format!(
        "| {set} | {} | {} | {} | {} | {:.3} | {rate:.3} | {:.2} | {:.3} | {} ms | {} ms | {} × | {} | {contact} |\n",
        report.layout.nodes,
        report.outcome.robots,
        report.outcome.missions,
        report.layout.safe_ends.len(),
        a_second(report),
        a_second(report) / rate,
        a_second(late),
        digits(1e3 * decision),
        digits(1e3 * call),
        digits(call / decision),
        stuck + late_stuck,
    )
}

fn read(path: &Path) -> Result<String, EvaluationError> {
    fs::read_to_string(path).map_err(|error| EvaluationError::File(path.to_owned(), format!("cannot be read: {error}")))
}
