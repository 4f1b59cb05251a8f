//! Fleets that run for a quarter of an hour on all layouts of others in the repository: orders beside locks.

use super::{CORNER_RADIUS, DocumentSection, EvaluationError, PaperFleets, Thoroughness};
use crate::error::LabError;
use pcr_execution::ExecutionError;
use pcr_execution::lifelong::{CoordinationMethod, DelayModel, LifelongOptions, LifelongReport, LifelongRunEntry};
use pcr_formats::import::{self, ImportOptions, ImportedLayout, InputFormat, Warnings};
use pcr_planning::figures::digits;
use std::fmt::Write as _;
use std::fs;

/// Layouts below `tests/data/real`, and the radius of the discs there \[m\]. The largest level of a building is taken.
const LAYOUTS: [(&str, f64); 22] = [
    ("nav2/warehouse_graph.geojson", 0.4),
    ("nav2/aws_graph.geojson", 0.3),
    ("nav2/sample_graph.geojson", 0.3),
    ("rmf/battle_royale.building.yaml", 0.3),
    ("rmf/hotel.building.yaml", 0.3),
    ("rmf/office.building.yaml", 0.3),
    ("rmf/triple_H.building.yaml", 0.3),
    ("opendrive/Town01.planview.xodr", 1.0),
    ("opendrive/Town02.planview.xodr", 1.0),
    ("opentcs/Demo-01.xml", 0.3),
    ("ccbs/sparse_map.xml", 0.35),
    ("lif/example_01.lif.json", 0.3),
    ("lif/example_02.lif.json", 0.3),
    ("lif/example_03.lif.json", 0.3),
    ("lif/example_04.lif.json", 0.3),
    ("lif/example_05.lif.json", 0.3),
    ("lif/example_06.lif.json", 0.3),
    ("lif/example_07.lif.json", 0.3),
    ("lif/example_08.lif.json", 0.3),
    ("lif/example_09.lif.json", 0.3),
    ("lif/example_10.lif.json", 0.3),
    ("lif/example_17.lif.json", 0.3),
];

/// Sizes of fleets, where there is room for them.
const SIZES: [usize; 2] = [10, 20];

/// Runs of each of them, with seeds from 1 on: in one alone, chance decides by a tenth.
const RUNS: u64 = 4;

pub(super) fn section(fleets: &PaperFleets, extent: Thoroughness) -> Result<DocumentSection, EvaluationError> {
    let (layouts, sizes, hours, runs): (&[(&str, f64)], &[usize], f64, u64) = match extent {
        Thoroughness::Full => (&LAYOUTS, &SIZES, 0.25, RUNS),
        Thoroughness::Quick => (&LAYOUTS[1..3], &SIZES[..1], 0.002, 2),
    };
    let mut text = format!(
        "## Fleets on other layouts\n\nThe same for {hours} h on all layouts of others in `tests/data/real`, 1 m/s, 0.5 m/s², the largest level of a building, with {} robots where so many find a \
        place to start (`pcr traffic LAYOUT --hours {hours} --radius RADIUS --agents N --active N --compare --seed SEED`). *Orders*, *locks*, *start delays*: missions an hour, without the first tenth of the time and what is finished after its end, the mean of seeds 1 to {runs}. *Safe*: safe ends; with fewer robots no mission is refused for ever. *Alone*: the same if nobody was \
        in anybody's way; where *orders / alone* is 1, no method can do more. *Locks*: the better one of locks on whole routes and on edges. *Decision*: by orders, 99 of 100 within, the longest of the seeds.\n\n\
        | layout | radius | safe | robots | alone | orders | locks | start delays | orders / locks | orders / alone | stuck | decision | contact |\n\
        |---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|\n",
        sizes.iter().map(usize::to_string).collect::<Vec<_>>().join(" and ")
    );
    let mut small = Vec::new();
    for &(name, radius) in layouts {
        let read = read(fleets, name, radius);
        let imported = match read {
            Ok(imported) => imported,
            Err(problem) => {
                small.push(format!("{name}: {problem}"));
                continue;
            }
        };
        for &agents in sizes {
            let request = LifelongOptions {
                agents,
                duration: 3600.0 * hours,
                delays: DelayModel::default(),
                seed: 1,
                method: CoordinationMethod::Orders,
            };
            // Whether there is room is found by what is quick.
            let tried = LifelongReport::run(
                &imported,
                LifelongOptions { duration: 1.0, ..request },
                &[CoordinationMethod::RouteLocks],
            );
            let room = tried.map(|it| (it.runs.first().map_or(0, |run| run.outcome.robots), it.well_formedness));
            match room {
                Ok((robots, _)) if robots == agents => {}
                Ok((robots, layout)) => {
                    if agents == SIZES[0] {
                        let (nodes, safe) = (layout.nodes, layout.safe_ends.len());
                        small.push(format!("{name}: {nodes} nodes, {safe} safe ends, robots that find room: {robots}"));
                    }
                    break;
                }
                Err(problem) => {
                    small.push(format!("{name}: {problem}"));
                    break;
                }
            }
            let refused = |problem: ExecutionError| {
                EvaluationError::Method(format!("{name}, {agents} robots"), problem.to_string())
            };
            let of_seed = |seed| {
                LifelongReport::run(&imported, LifelongOptions { seed, ..request }, &CoordinationMethod::ALL)
                    .map_err(refused)
            };
            let answers = (1..=runs).map(of_seed).collect::<Result<Vec<_>, _>>()?;
            text.push_str(&row(name, radius, agents, &answers));
        }
    }
    if !small.is_empty() {
        let _ = writeln!(text, "\nLayouts that cannot take {} robots:\n", SIZES[0]);
        small.iter().for_each(|it| text.push_str(&format!("- {it}\n")));
    }
    Ok(DocumentSection { text, pictures: Vec::new() })
}

fn read(fleets: &PaperFleets, name: &str, radius: f64) -> Result<ImportedLayout, LabError> {
    let path = fleets.data.join("real").join(name);
    let text = fs::read_to_string(&path)?;
    let format = InputFormat::detect(&path, &text).ok_or(LabError::NoLayout)?;
    let options =
        ImportOptions { radius: Some(radius), corner_radius: Some(CORNER_RADIUS), ..ImportOptions::default() };
    Ok(import::roads(format, &text, &options, &mut Warnings::default())?)
}

fn row(name: &str, radius: f64, agents: usize, answers: &[LifelongReport]) -> String {
    let runs = |method: CoordinationMethod| {
        let runs = answers.iter().flat_map(|answer| &answer.runs);
        runs.filter(move |run| run.outcome.method == method)
    };
    let seeds = answers.len().max(1) as f64;
    let an_hour = |method| runs(method).map(|run| run.outcome.missions_per_hour).sum::<f64>() / seeds;
    let [orders, routes, edges, delays] = CoordinationMethod::ALL.map(an_hour);
    let locks = routes.max(edges);
    let which = if routes >= edges { CoordinationMethod::RouteLocks } else { CoordinationMethod::EdgeLocks };
    let alone = answers.iter().map(|answer| answer.alone).sum::<f64>() / seeds;
    let decision = runs(CoordinationMethod::Orders).map(|run| run.decision_p99).fold(0.0, f64::max);
    let all = || answers.iter().flat_map(|answer| &answer.runs).map(|run: &LifelongRunEntry| &run.outcome);
    let stuck: usize = all().map(|outcome| outcome.stuck).sum();
    let verdicts = all().map(|outcome| outcome.certificate.verdict);
    let contact = verdicts.fold("none, proved", |worst, verdict| if verdict == "proved" { worst } else { verdict });
    let ratio = |a: f64, b: f64| if b > 0.0 { digits(a / b) } else { "–".to_owned() };
    format!(
        "| {name} | {radius} | {} | {agents} | {} | {} | {} ({}) | {} | {} | {} | {stuck} | {} ms | {contact} |\n",
        answers.first().map_or(0, |answer| answer.well_formedness.safe_ends.len()),
        digits(alone),
        digits(orders),
        digits(locks),
        which.name(),
        digits(delays),
        ratio(orders, locks),
        ratio(orders, alone),
        digits(1e3 * decision)
    )
}
