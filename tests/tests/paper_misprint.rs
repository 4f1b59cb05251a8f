//! Row 17 of Table VII prints `dir = 1`; the rest of the table only fits `dir = -1`.
//!
//! Rows 17 and 1 say where agent 10 crosses the path of agent 3, 13.0 s apart at 0.40 m/s, and Table V that it moves on
//! two arcs and a line (AAS), the first arc having the radius of row 17 and the line being that of row 1. The first arc
//! and the line are thus given, but for their lengths; the second arc has to turn by what is missing. Every such
//! path is tried: with a counter-clockwise first arc none comes near the place of row 1.

use pcr_core::{Path, Point, Pose, Radians, TurnSide};
use pcr_formats::scenario::Scenario;
use pcr_planning::fleet::Fleet;

/// Half of the last digit of the table.
const HALF_DIGIT: f64 = 0.05;

/// Steps of the lengths of both arcs; the paths are 5.2 m long.
const STEPS: usize = 150;

/// Position and heading of agent 3 at a length.
fn agent_3_at(length: f64) -> (f64, f64, f64) {
    let scenario = Scenario::from_json(include_str!("../data/paper12.json")).expect("a valid scenario");
    let fleet = Fleet::<f64>::new(&scenario).expect("a valid fleet");
    let pose = fleet.motions()[2].path().pose_at(length);
    (pose.position.x, pose.position.y, pose.heading.0)
}

/// How far the best AAS path with this first turn ends from the place of row 1 \[m\], over the roundings of the lengths L,
/// of θ, of T and of the radius.
fn least_miss(first_turn: TurnSide) -> f64 {
    let mut least = f64::INFINITY;
    let ends = [-HALF_DIGIT, 0.0, HALF_DIGIT];
    let sign = if first_turn == TurnSide::Left { 1.0 } else { -1.0 };
    let (from, to) = (agent_3_at(10.0), agent_3_at(0.9));
    for (turned, longer, wider) in ends.iter().flat_map(|a| ends.iter().flat_map(move |b| ends.map(|c| (*a, *b, c)))) {
        let (length, radius) = ((19.3 - 6.3) * 0.40 + 2.0 * 0.40 * longer, 1.6 + wider);
        let (begin, end) = (from.2 - 4.3 + turned, to.2 - 0.9 - turned);
        for (a, b) in (0..STEPS).flat_map(|a| (1..STEPS).map(move |b| (a, b))) {
            let [first, second] = [a, b].map(|k| length * k as f64 / STEPS as f64);
            let line = length - first - second;
            let missing = end - begin - sign * first / radius;
            if line < 0.0 || missing == 0.0 {
                continue;
            }
            let turn = if missing > 0.0 { TurnSide::Left } else { TurnSide::Right };
            let start = Pose { position: Point::new(from.0, from.1), heading: Radians(begin) };
            let path = Path::<f64, 3>::starting_at(start).and_then(|path| path.arc(radius, first_turn, first));
            let path = path.and_then(|path| path.arc(second / missing.abs(), turn, second));
            // An arc of more than one turn is no candidate.
            let Ok(path) = path.and_then(|path| path.line(line)) else {
                continue;
            };
            let reached = path.as_path().pose_at(length).position;
            least = least.min((reached.x - to.0).hypot(reached.y - to.1));
        }
    }
    least
}

#[test]
fn agent_10_cannot_reach_row_1_from_a_counter_clockwise_row_17() {
    let (left, right) = (least_miss(TurnSide::Left), least_miss(TurnSide::Right));
    // L is rounded as well: two half digits along the two straight parts of agent 3.
    assert!(right < 2.0 * HALF_DIGIT, "clockwise: {right} m");
    assert!(left > 10.0 * HALF_DIGIT, "counter-clockwise: {left} m");
}
