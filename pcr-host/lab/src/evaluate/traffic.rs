//! Random missions on the route graph of a real warehouse: regions, start delays and their check.

use super::{DocumentSection, EvaluationError, PaperFleets, Thoroughness, picture};
use pcr_comparing::compare::stopwatch::{Stopwatch, steady};
use pcr_drawing::{LayoutLevelView, overview};
use pcr_execution::traffic::{TrafficOptions, TrafficReport, schedule};
use pcr_formats::footprint::{Footprint, FootprintError};
use pcr_formats::import::ImportedLayout;
use pcr_planning::bodies::BodyFleet;
use pcr_planning::check::CheckReport;
use pcr_planning::figures::{digits, time};
use pcr_planning::fleet::build_ecm;
use std::fmt::Write as _;

/// Radius of the discs \[m\].
const RADIUS: f64 = 0.4;

/// Length and width of the vehicle with an outline \[m\].
const SIZE: [f64; 2] = [0.9, 0.6];

/// Largest fleet of these.
const OUTLINED: usize = 25;

/// The fleet of the picture.
const DRAWN: usize = 50;

pub(super) fn section(fleets: &PaperFleets, extent: Thoroughness) -> Result<DocumentSection, EvaluationError> {
    let sizes: &[usize] = match extent {
        Thoroughness::Full => &[10, 25, 50, 100],
        Thoroughness::Quick => &[10],
    };
    let refused = |problem: &dyn ToString| EvaluationError::File(fleets.data.clone(), problem.to_string());
    let disc = fleets.warehouse(RADIUS)?;
    let [nodes, edges] = [disc.layout.nodes.len(), disc.layout.edges.len()];
    let [length, width] = SIZE;
    let mut text = format!(
        "## Traffic in a warehouse\n\nThe route graph of nav2's warehouse, {nodes} nodes and {edges} edges, and random missions on it \
        (`pcr traffic`, seed 1): shortest ways between nodes, corners rounded with 1 m. A mission is rejected if no order of starts makes it \
        possible together with the missions before it. *Regions*: the table of all pairs, both directions; *plan*: the delays that every pair \
        forbids, and 2000 orders of priority; *check*: all conflicts of the plan.\n\n\
        | vehicle | agents | rejected | regions | in | plan in | check in | conflicts if all set off at once | planned | conflicts then | \
        makespan | missions an hour |\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    let mut pictures = Vec::new();
    let outlined = with_outline(&disc).map_err(|problem| refused(&problem))?;
    let vehicles = [(&disc, format!("disc of {RADIUS} m")), (&outlined, format!("{length} m by {width} m"))];
    for (imported, name) in vehicles {
        let most = if imported.vehicle.footprint.is_some() { OUTLINED } else { usize::MAX };
        for &agents in sizes.iter().filter(|agents| **agents <= most) {
            let (row, [_, plan]) = row(imported, &name, agents)?;
            text.push_str(&row);
            if agents == DRAWN && imported.vehicle.footprint.is_none() {
                let ground = LayoutLevelView { imported, level: imported.layout.largest_level() };
                let svg = overview(&plan, Some(ground)).map_err(|error| refused(&error))?;
                pictures.push(("warehouse", svg));
            }
        }
    }
    if !pictures.is_empty() {
        let _ = write!(text, "\n{}", picture("warehouse", "50 planned agents on the warehouse graph"));
    }
    Ok(DocumentSection { text, pictures })
}

/// The same layout with vehicles that are no discs.
fn with_outline(disc: &ImportedLayout) -> Result<ImportedLayout, FootprintError> {
    let [ahead, left] = SIZE.map(|side| 0.5 * side);
    let footprint = Footprint::new(vec![[ahead, left], [-ahead, left], [-ahead, -left], [ahead, -left]])?;
    let mut outlined = disc.clone();
    (outlined.vehicle.radius, outlined.vehicle.footprint) = (footprint.circumscribed_radius(), Some(footprint));
    Ok(outlined)
}

fn row(
    imported: &ImportedLayout,
    name: &str,
    agents: usize,
) -> Result<(String, [pcr_formats::scenario::Scenario; 2]), EvaluationError> {
    let request = TrafficOptions { agents, seed: 1 };
    let (traffic, scenarios) = TrafficReport::plan(imported, request)?;
    let [missions, plan] = &scenarios;
    let bodies = BodyFleet::<f64>::new(missions)?;
    let motions = bodies.fleet.motions();
    let table = timed(|| build_ecm(&motions).map(drop))?;
    let planned = timed(|| schedule(missions, request.seed).map(drop))?;
    let check = timed(|| CheckReport::compute::<f64>(plan, false).map(drop))?;
    let mut row = String::new();
    let TrafficReport { placed, passed_over, regions, conflicts_before, conflicts_after, .. } = traffic;
    let count = if placed < agents { format!("{placed} of {agents}") } else { agents.to_string() };
    let [table, planned_in, check] = [table, planned, check].map(time);
    let _ = writeln!(
        row,
        "| {name} | {count} | {passed_over} | {regions} | {table} | {planned_in} | {check} | {conflicts_before} | {} | {conflicts_after} | {} s | {} |",
        traffic.planned,
        digits(traffic.makespan),
        digits(traffic.missions_per_hour)
    );
    Ok((row, scenarios))
}

/// Time of one core \[ms\].
fn timed<E>(work: impl FnMut() -> Result<(), E>) -> Result<f64, E> {
    let (time, outcome) = steady(Stopwatch::elapsed, work);
    outcome.map(|()| 1e3 * time)
}
