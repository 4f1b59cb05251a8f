//! Loads of vehicles that turn in place: one of the outline of the vehicle changes nothing, and others are told as their polygons are.

use pcr_core::Motion;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::scenario::{Agent, PathSegment, Scenario};
use pcr_planning::bodies::BodyFleet;
use pcr_planning::check::CheckReport;
use pcr_planning::fleet::HostScalar;
use pcr_tests::generators::Dice;
use pcr_tests::polygons::{Point, Polygon, apart, placed};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, PI};

/// What rounding costs at most \[m\].
const SLACK: f64 = 1e-4;

const LONG: [Point; 4] = [[-0.3, -0.2], [0.9, -0.2], [0.9, 0.2], [-0.3, 0.2]];
const WIDE: [Point; 4] = [[-0.1, -0.8], [0.2, -0.8], [0.2, 0.8], [-0.1, 0.8]];
const SQUARE: [Point; 4] = [[-0.15, -0.15], [0.15, -0.15], [0.15, 0.15], [-0.15, 0.15]];

fn outline(polygon: &[Point]) -> Value {
    let corners = polygon.iter().map(|[ahead, left]| json!({ "ahead": ahead, "left": left }));
    json!({ "polygon": corners.collect::<Vec<_>>() })
}

fn line(length: f64) -> Value {
    json!({ "kind": "line", "length": length })
}

fn turn(sweep: f64) -> Value {
    json!({ "kind": "turn", "sweep": sweep })
}

fn one_of<T: Copy>(dice: &mut Dice, all: &[T]) -> T {
    all[dice.below(all.len())]
}

/// Round lengths and limits, on which borders are where pieces of the motion end, as often as others.
fn path(dice: &mut Dice) -> Vec<Value> {
    let legs = 2 + dice.below(4);
    let leg = |_| match dice.range(0.0, 1.0) {
        ..0.4 if dice.chance(0.7) => turn(one_of(dice, &[FRAC_PI_2, -FRAC_PI_2, PI, 1.0])),
        ..0.35 => turn(dice.range(-3.0, 3.0)),
        // An angle between two segments.
        ..0.4 => turn(dice.range(-0.02, 0.02)),
        ..0.6 => line(one_of(dice, &[0.5, 1.0, 2.0])),
        ..0.85 => line(dice.range(0.1, 3.0)),
        _ => json!({ "kind": "arc", "radius": dice.range(0.3, 2.0), "sweep": dice.range(-2.0, 2.0) }),
    };
    (0..legs).map(leg).collect()
}

fn vehicle(dice: &mut Dice, path: &[Value], polygon: &[Point]) -> Value {
    json!({ "id": 1, "footprint": outline(polygon), "path": path, "start": { "x": 0, "y": 0, "heading": dice.range(-PI, PI) },
        "v_max": one_of(dice, &[0.5, 0.6, 0.8, 1.0]), "a_max": one_of(dice, &[0.7, 1.0, 2.0, 3.0, 5.0]),
        "turn_v_max": one_of(dice, &[0.5, 1.0]), "turn_a_max": one_of(dice, &[1.0, 2.0]) })
}

fn other(dice: &mut Dice) -> Value {
    json!({ "id": 2, "radius": 0.1, "v_max": 1.0, "a_max": 1.0, "t_start": dice.range(-1.0, 5.0), "path": [line(dice.range(1.0, 5.0))],
        "start": { "x": dice.range(-2.0, 2.0), "y": dice.range(-2.0, 2.0), "heading": dice.range(-PI, PI) } })
}

fn segments(dice: &mut Dice, count: usize) -> [usize; 2] {
    let all: Vec<usize> = (1..=count).collect();
    let [a, b] = [one_of(dice, &all), one_of(dice, &all)];
    [a.min(b), a.max(b)]
}

fn read(agents: &[Value]) -> Scenario {
    Scenario::from_json(&json!({ "agents": agents }).to_string()).unwrap()
}

fn loaded(agent: &Value, segments: [usize; 2], polygon: &[Point]) -> Value {
    let mut agent = agent.clone();
    agent["loads"] = json!([{ "segments": segments, "footprint": outline(polygon) }]);
    agent
}

/// How near the agents come \[m\].
fn nearest<S: HostScalar>(scenario: &Scenario) -> f64 {
    let verdict = CheckReport::compute::<S>(scenario, true).unwrap_or_else(|problem| panic!("{}: {problem}", S::NAME));
    verdict.closest.unwrap()[0].clearance
}

#[test]
fn a_load_of_the_outline_of_the_vehicle_changes_nothing() {
    const PAIRS: u64 = if cfg!(optimized) { 400 } else { 40 };
    let mut met = 0;
    for seed in 0..PAIRS {
        let dice = &mut Dice::seeded(seed);
        let path = path(dice);
        let bare = vehicle(dice, &path, &LONG);
        let other = other(dice);
        let with = loaded(&bare, segments(dice, path.len()), &LONG);
        // A load all the way: one body.
        let plain = loaded(&bare, [1, path.len()], &LONG);
        let [plain, with] = [plain, with].map(|agent| read(&[agent, other.clone()]));
        let [exact, clearance] = [&plain, &with].map(nearest::<f64>);
        assert!((clearance - exact).abs() < SLACK, "seed {seed}: {clearance} {exact}");
        let [conflicts, others] =
            [&plain, &with].map(|scenario| CheckReport::compute::<f64>(scenario, false).unwrap().conflicts);
        if exact.abs() > SLACK && conflicts.len() == others.len() {
            for (a, b) in conflicts.iter().zip(&others) {
                assert!((a.depth - b.depth).abs() < SLACK, "seed {seed}: {a:?} {b:?}");
            }
        }
        met += usize::from(exact < 0.0);
        if seed % 4 == 0 {
            // The digits that the agents and the clearance lose.
            let within = |found: f64, digits: f64, name: &str| {
                assert!((exact - found).abs() < digits, "seed {seed}, {name}: {}", exact - found);
            };
            for scenario in [&plain, &with] {
                within(nearest::<f32>(scenario), 1e-3, "f32");
                within(nearest::<Q20>(scenario), 1e-3, "q20");
                within(nearest::<Q16>(scenario), 1e-2, "q16");
                within(nearest::<Q12>(scenario), 1e-1, "q12");
            }
        }
    }
    assert!(met > 5, "{met}");
}

/// Length of a segment in the motion of a body: a turn in place has a lever of 1 m.
fn length_of(segment: &PathSegment) -> f64 {
    match segment {
        PathSegment::Turn { sweep } => sweep.abs(),
        other => other.length(),
    }
}

/// The polygons that count at a length: two where one gives way to another.
fn polygons<'p>(agent: &Agent, loads: [usize; 2], [own, load]: [&'p [Point]; 2], length: f64) -> Vec<&'p [Point]> {
    const ROUNDING: f64 = 1e-12;
    let mut from = 0.0;
    let mut polygons = Vec::new();
    for (k, segment) in agent.path.iter().enumerate() {
        if from <= length + ROUNDING && length <= from + length_of(segment) + ROUNDING {
            polygons.push(if (loads[0]..=loads[1]).contains(&(k + 1)) { load } else { own });
        }
        from += length_of(segment);
    }
    polygons
}

/// Conflicts are where the polygons are, and nowhere else, at many times.
fn compare<S: HostScalar>(scenario: &Scenario, loads: [usize; 2], shapes: [&[Point]; 3], name: &str) -> usize {
    let bare = scenario.agents.iter().map(|agent| Agent { loads: Vec::new(), ..agent.clone() }).collect();
    // Without loads, each is one body.
    let bodies = BodyFleet::<f64>::new(&Scenario::new("", bare)).unwrap();
    let motions = bodies.fleet.motions();
    let verdict = CheckReport::compute::<S>(scenario, false).unwrap();
    let at = |motion: &Motion<'_, f64>, polygon: &[Point], t: f64| -> Polygon {
        let pose = motion.path().pose_at(motion.length_at(t));
        placed(polygon, [pose.position.x, pose.position.y], pose.heading.0)
    };
    let end = motions.iter().map(|motion| motion.time().hi).fold(0.0, f64::max);
    let mut inside = 0;
    for step in 0..=4000 {
        let t = end * f64::from(step) / 4000.0;
        let far = at(&motions[1], shapes[2], t);
        let length = motions[0].length_at(t);
        let near = polygons(&scenario.agents[0], loads, [shapes[0], shapes[1]], length);
        let distances = near.into_iter().map(|polygon| apart(&at(&motions[0], polygon, t), &far));
        let [least, largest] =
            distances.fold([f64::INFINITY, 0.0], |[least, largest], d| [d.min(least), d.max(largest)]);
        let there = verdict.conflicts.iter().any(|conflict| conflict.t[0] <= t && t <= conflict.t[1]);
        // A conflict in fixed point begins and ends at its digits.
        let beside = verdict.conflicts.iter().any(|conflict| conflict.t[0] - 1e-2 <= t && t <= conflict.t[1] + 1e-2);
        assert!(there || largest > 0.0 || (S::NAME != "f64" && beside), "{name}, {}, t {t}: no conflict", S::NAME);
        assert!(!there || least <= 1e-6 || S::NAME != "f64", "{name}, {}, t {t}: a conflict at {least}", S::NAME);
        inside += usize::from(largest == 0.0);
    }
    inside
}

#[test]
fn loads_of_other_outlines_are_told_where_they_are_carried() {
    const PAIRS: u64 = if cfg!(optimized) { 150 } else { 15 };
    let mut met = 0;
    for seed in 0..PAIRS {
        let dice = &mut Dice::seeded(seed);
        let path = path(dice);
        let loads = segments(dice, path.len());
        let first = loaded(&vehicle(dice, &path, &LONG), loads, &WIDE);
        let mut second = other(dice);
        second.as_object_mut().unwrap().remove("radius");
        second["footprint"] = outline(&SQUARE);
        let scenario = read(&[first, second]);
        let name = format!("seed {seed}");
        let shapes: [&[Point]; 3] = [&LONG, &WIDE, &SQUARE];
        met += usize::from(compare::<f64>(&scenario, loads, shapes, &name) > 0);
        if seed % 5 == 0 {
            compare::<Q16>(&scenario, loads, shapes, &name);
        }
    }
    assert!(met > 3, "{met}");
}

/// A pole that is fixed to a vehicle and sweeps half a circle, with a load of the same outline up to there: the ramp before the
/// turn was cut short by a rounding, and the turn with it.
#[test]
fn a_turn_takes_its_time_with_a_load_as_without() {
    let pole = [[1.1, 0.1], [0.9, 0.1], [0.9, -0.1], [1.1, -0.1]];
    let first = json!({ "id": 1, "v_max": 0.8, "a_max": 5, "turn_v_max": 1, "turn_a_max": 1, "start": { "x": 0, "y": 0, "heading": 0 },
        "path": [line(0.5), turn(PI), line(1.0)], "footprint": outline(&pole) });
    let second = json!({ "id": 2, "radius": 0.1, "v_max": 1, "a_max": 1, "t_start": 0.7,
        "start": { "x": 2.21, "y": 0.96, "heading": PI }, "path": [line(4.0)] });
    fn check<S: HostScalar>(scenario: &Scenario, slack: f64) {
        let conflicts = CheckReport::compute::<S>(scenario, false).unwrap().conflicts;
        let [only] = conflicts.as_slice() else { panic!("{}: {conflicts:?}", S::NAME) };
        assert!((only.depth - 0.1523).abs() < slack, "{}: {only:?}", S::NAME);
        assert!((only.t[0] - 2.1895).abs() < 5.0 * slack && (only.t[1] - 3.6215).abs() < 5.0 * slack, "{only:?}");
    }
    for first in [first.clone(), loaded(&first, [1, 2], &pole)] {
        let scenario = read(&[first, second.clone()]);
        check::<f64>(&scenario, 1e-3);
        check::<f32>(&scenario, 1e-3);
        check::<Q20>(&scenario, 1e-3);
        check::<Q16>(&scenario, 2e-3);
        check::<Q12>(&scenario, 1e-2);
    }
}
