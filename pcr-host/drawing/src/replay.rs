//! A page that replays runs: one HTML file that contains everything and sends no requests.
//!
//! Bodies move as they did in the run; of controllers that know discs only, each is the disc about it. Beside them is the collision map of a robot as of its last plan: regions, planned
//! motion, and the length that the robot has really travelled.

use crate::contour::trace;
use crate::palette::colour;
use crate::template::PageTemplate;
use pcr_core::{Motion, RegionRef};
use pcr_execution::simulate::{
    ControllerKind, FRAME, MissionRecord, PlanSnapshot, PlaneVector, SimulationRun, SimulationTask,
};
use pcr_planning::failure::ComputationError;
use pcr_planning::fleet::{ConvexBody, build_ecm};
use serde_json::{Value, json};

const PAGE: PageTemplate = PageTemplate {
    kind: "replay",
    connect: "",
    body: include_str!("replay/replay.html"),
    style: include_str!("replay/replay.css"),
    script: concat!(
        include_str!("crowd.js"),
        include_str!("canvas.js"),
        include_str!("replay/replay.js"),
        include_str!("scale.js")
    ),
};

/// Positions are given in this unit \[m\].
const UNIT: f64 = 1e-4;

/// Headings are given in this unit \[rad\].
const ANGLE_UNIT: f64 = 1e-3;

/// Points of a path, and of a planned motion.
const POINTS: usize = 80;

/// Pixels of a map that outlines are traced for.
const PIXELS: f64 = 500.0;

/// The page for some runs of a task.
///
/// # Errors
/// [`ComputationError::Robot`] and [`ComputationError::Full`] where there is no map of a plan.
pub fn page(task: &SimulationTask, outcomes: &[SimulationRun]) -> Result<String, ComputationError> {
    let name = if task.name.is_empty() { "Simulation" } else { &task.name };
    Ok(PAGE.fill(name, &data(task, outcomes)?))
}

fn rounded(length: f64) -> i64 {
    (length / UNIT).round() as i64
}

/// The corners of a body that is no disc, counter-clockwise, ahead and left of its reference point, and the radius by which they are
/// rounded \[m\].
fn body(body: &ConvexBody) -> Option<Value> {
    let (corners, radius) = body.corners();
    (!body.is_disc()).then(|| json!({ "corners": corners, "radius": radius }))
}

/// x, y, x, y, ... in units.
fn flat(points: impl IntoIterator<Item = PlaneVector>) -> Vec<i64> {
    points.into_iter().flatten().map(rounded).collect()
}

/// A number with four digits after the point.
fn short(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

fn data(task: &SimulationTask, outcomes: &[SimulationRun]) -> Result<Value, ComputationError> {
    let robots = task.robots.iter().enumerate().map(|(place, robot)| {
        // Beyond 2⁵³ a number would lose its last digits in the browser.
        let (id, name) = (robot.id.to_string(), task.labels.display_name(robot.id));
        let ways = robot.missions.iter().map(|mission| {
            let course = &mission.course;
            flat((0..=POINTS).map(|k| course.point_at(course.length() * k as f64 / POINTS as f64)))
        });
        json!({
            "id": id,
            "name": name,
            "radius": robot.radius,
            "body": body(&robot.body),
            "colour": colour(place).to_string(),
            "ways": ways.collect::<Vec<_>>(),
        })
    });
    let obstacles = task.obstacles.iter().map(|obstacle| {
        json!({ "at": obstacle.centre, "radius": obstacle.radius, "body": body(&obstacle.body), "heading": obstacle.heading })
    });
    let runs = outcomes.iter().map(|outcome| run(task, outcome)).collect::<Result<Vec<_>, _>>()?;
    Ok(json!({
        "name": task.name,
        "frame": FRAME,
        "unit": UNIT,
        "angleUnit": ANGLE_UNIT,
        "robots": robots.collect::<Vec<_>>(),
        "obstacles": obstacles.collect::<Vec<_>>(),
        "runs": runs,
    }))
}

fn run(task: &SimulationTask, outcome: &SimulationRun) -> Result<Value, ComputationError> {
    let plans = outcome.snapshots.iter().map(|snapshot| plan(task, snapshot)).collect::<Result<Vec<_>, _>>()?;
    let tracks = outcome.trace.positions.iter().map(|track| flat(track.iter().copied()));
    let travelled = outcome.trace.travelled.iter().map(|track| track.iter().map(|l| rounded(*l)).collect::<Vec<_>>());
    let bound = outcome.run.controller == ControllerKind::Pcr;
    // Headings of those for which they matter.
    let headings = outcome.trace.headings.iter().zip(&task.robots).map(|(track, robot)| {
        let track = track.iter().filter(|_| bound && !robot.body.is_disc());
        track.map(|heading| (heading / ANGLE_UNIT).round() as i64).collect::<Vec<_>>()
    });
    let collisions = outcome
        .run
        .collisions
        .iter()
        .map(|collision| json!([collision.i.to_string(), collision.j.map(|j| j.to_string()), collision.t]));
    Ok(json!({
        "controller": outcome.run.controller.name(),
        "travel": outcome.run.travel,
        "tracks": tracks.collect::<Vec<_>>(),
        "headings": headings.collect::<Vec<_>>(),
        "travelled": if bound { travelled.collect::<Vec<_>>() } else { Vec::new() },
        "journeys": journeys(task, &outcome.trace.journeys),
        "collisions": collisions.collect::<Vec<_>>(),
        "plans": plans,
    }))
}

/// Each with the number of its way among those of its robot, whose missions follow one another.
fn journeys(task: &SimulationTask, journeys: &[MissionRecord]) -> Vec<Value> {
    let mut begun = vec![0_usize; task.robots.len()];
    let journey = |journey: &MissionRecord| {
        let (robot, number) = (task.robots.get(journey.robot)?, begun.get_mut(journey.robot)?);
        let way = *number;
        *number += 1;
        robot.missions.get(way)?;
        Some(json!({ "robot": journey.robot, "begin": journey.begin, "end": journey.end, "way": way }))
    };
    journeys.iter().filter_map(journey).collect()
}

/// The map of every robot that moves.
fn plan(task: &SimulationTask, snapshot: &PlanSnapshot) -> Result<Value, ComputationError> {
    let robots = task.robots.iter().zip(snapshot.drives.iter().zip(&snapshot.bodies));
    let motions = robots.map(|(robot, (drive, body))| drive.motion_of(body).ok_or(ComputationError::Robot(robot.id)));
    let motions = motions.collect::<Result<Vec<Motion<'_, f64>>, _>>()?;
    let ecm = build_ecm(&motions)?;
    let end = motions.iter().map(|motion| motion.time().hi).fold(snapshot.time, f64::max);
    let maps = motions.iter().enumerate().map(|(ego, motion)| {
        let offset = snapshot.offsets[ego];
        let length = motion.path().length();
        let pixel = [(end - snapshot.time).max(FRAME) / PIXELS, length.max(UNIT) / PIXELS];
        let regions = ecm.row(&motions, ego).expect("the table of the fleet");
        let regions = regions.map(|region| self::region(&region, motion, pixel, offset, end));
        let times = (0..=POINTS).map(|k| snapshot.time + (end - snapshot.time) * k as f64 / POINTS as f64);
        let curve = times.map(|time| [short(time), short(offset + motion.length_at(time))]);
        json!({
            "from": short(offset),
            "to": short(offset + length),
            "curve": if length > 0.0 { curve.collect::<Vec<_>>() } else { Vec::new() },
            "regions": if length > 0.0 { regions.collect::<Vec<_>>() } else { Vec::new() },
        })
    });
    Ok(json!({ "time": snapshot.time, "end": short(end), "maps": maps.collect::<Vec<_>>() }))
}

/// Its outlines, and the strips of an agent that stands at its start or end, as \[from time, to time, from length, to length\].
fn region(region: &RegionRef<'_, f64>, ego: &Motion<'_, f64>, pixel: [f64; 2], offset: f64, end: f64) -> Value {
    let outline = trace(region, ego, pixel);
    let outline = outline
        .iter()
        .map(|contour| contour.iter().map(|&[time, length]| [short(time), short(length + offset)]).collect::<Vec<_>>());
    let arrival = region.other_motion().time().hi;
    let strips = region.slice_at(end).filter(|_| region.is_open_at_end() && arrival < end);
    let strips = strips.map(|slice| [arrival, end, slice.lo + offset, slice.hi + offset].map(short));
    json!({ "other": region.other(), "outline": outline.collect::<Vec<_>>(), "strips": strips.collect::<Vec<_>>() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_execution::simulate::{ClosedLoopOptions, Disturbance, run};
    use pcr_formats::scenario::Scenario;

    #[test]
    fn outlines_are_drawn_where_the_controller_knows_them() {
        let square = r#""footprint":{"polygon":[{"ahead":0.2,"left":0.2},{"ahead":-0.2,"left":0.2},{"ahead":-0.2,"left":-0.2},{"ahead":0.2,"left":-0.2}]}"#;
        let agents = format!(
            r#"{{"version":2,"agents":[
            {{"id":3,{square},"v_max":1,"a_max":1,"start":{{"x":-2,"y":0,"heading":1}},
              "path":[{{"kind":"line","length":1}},{{"kind":"arc","radius":1,"sweep":0.5,"gear":"reverse"}}]}},
            {{"id":5,{square},"v_max":1,"a_max":1,"start":{{"x":9,"y":0,"heading":0.25}},"path":[]}},
            {{"id":8,"radius":0.3,"v_max":1,"a_max":1,"start":{{"x":0,"y":-2,"heading":1.57}},"path":[{{"kind":"line","length":4}}]}}]}}"#
        );
        let task = SimulationTask::from_scenario(&Scenario::from_json(&agents).expect("a scenario")).expect("a task");
        let disturbance = Disturbance { noise: 0.0, slip: 0.0, delay: 0.0, drift: 0.0 };
        let settings = ClosedLoopOptions { seed: 1, replan: 2.0, disturbance };
        let runs = [ControllerKind::Pcr, ControllerKind::Orca].map(|kind| run(&task, kind, settings).expect("a run"));
        let data = data(&task, &runs).expect("data");
        assert_eq!(data["robots"][0]["body"]["corners"].as_array().map(Vec::len), Some(4));
        assert_eq!((&data["robots"][1]["body"], &data["obstacles"][0]["heading"]), (&Value::Null, &json!(0.25)));
        let headings =
            |run: usize, robot: usize| data["runs"][run]["headings"][robot].as_array().expect("a track").clone();
        let own = headings(0, 0);
        assert_eq!((own.first(), own.last()), (Some(&json!(1000)), Some(&json!(1500))));
        assert_eq!([headings(0, 1).len(), headings(1, 0).len()], [0, 0]);
    }

    #[test]
    fn a_plan_without_a_map_is_no_empty_map() {
        let agents = r#"{"agents":[
            {"id":3,"radius":0.3,"v_max":1,"a_max":1,"start":{"x":-2,"y":0,"heading":0},"path":[{"kind":"line","length":4}]},
            {"id":8,"radius":0.3,"v_max":1,"a_max":1,"start":{"x":0,"y":-2,"heading":1.57},"path":[{"kind":"line","length":4}]}]}"#;
        let task = SimulationTask::from_scenario(&Scenario::from_json(agents).expect("a scenario")).expect("a task");
        let disturbance = Disturbance { noise: 0.0, slip: 0.0, delay: 0.0, drift: 0.0 };
        let settings = ClosedLoopOptions { seed: 1, replan: 2.0, disturbance };
        let mut outcome = run(&task, ControllerKind::Pcr, settings).expect("a run");
        assert!(page(&task, std::slice::from_ref(&outcome)).is_ok_and(|page| page.contains("outline")));
        outcome.snapshots[0].bodies[1] = ConvexBody::Disc(f64::NAN);
        assert_eq!(page(&task, &[outcome]), Err(ComputationError::Robot(8)));
    }
}
