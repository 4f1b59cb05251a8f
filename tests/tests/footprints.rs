//! Agents with polygons for outlines: regions and conflicts contain those of the polygons and exceed them by what a number format loses.

use pcr_core::Motion;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::scenario::Scenario;
use pcr_planning::check::CheckReport;
use pcr_planning::fleet::{Fleet, HostScalar};
use pcr_planning::regions::{RegionEntry, RegionOptions, RegionsReport};
use pcr_tests::generators::Dice;
use pcr_tests::polygons::{self, Point, Polygon, apart};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, PI};

/// Ahead of and behind the reference point, and to both sides.
const TRUCK: [[f64; 2]; 4] = [[-0.3, -0.35], [0.9, -0.35], [0.9, 0.35], [-0.3, 0.35]];
const SQUARE: [[f64; 2]; 4] = [[-0.25, -0.25], [0.25, -0.25], [0.25, 0.25], [-0.25, 0.25]];

/// Above what sums of `f64` lose, and what a turn in place adds to the path of the scenario \[m\].
const SLACK: f64 = 1e-7;

fn outline(polygon: &[[f64; 2]]) -> Value {
    let corners = polygon.iter().map(|[ahead, left]| json!({ "ahead": ahead, "left": left }));
    json!({ "polygon": corners.collect::<Vec<_>>() })
}

fn agent(id: u64, polygon: &[[f64; 2]], start: [f64; 3], path: &Value) -> Value {
    json!({ "id": id, "footprint": outline(polygon), "v_max": 1.0, "a_max": 0.7, "path": path,
        "start": { "x": start[0], "y": start[1], "heading": start[2] } })
}

fn line(length: f64) -> Value {
    json!({ "kind": "line", "length": length })
}

fn arc(radius: f64, sweep: f64) -> Value {
    json!({ "kind": "arc", "radius": radius, "sweep": sweep })
}

fn read(agents: &[Value]) -> Scenario {
    Scenario::from_json(&json!({ "name": "outlines", "agents": agents }).to_string()).unwrap()
}

/// The polygon of a vehicle in a pose.
fn placed(polygon: &[Point], pose: pcr_core::Pose<f64>) -> Polygon {
    polygons::placed(polygon, [pose.position.x, pose.position.y], pose.heading.0)
}

/// The reference points alone.
fn references(scenario: &Scenario) -> Fleet<f64> {
    Fleet::new(scenario).unwrap()
}

fn within([lo, hi]: [f64; 2], x: f64) -> bool {
    lo <= x && x <= hi
}

/// Compares the regions at their slices, and the conflicts, with the polygons at many lengths; returns the numbers of
/// points inside and outside.
fn compare(agents: &[Value], polygons: [&[Point]; 2]) -> [usize; 2] {
    compare_in::<f64>(agents, polygons, SLACK)
}

/// The same in a number format that loses up to `slack` \[m\]; the polygons are where the scenario has them.
fn compare_in<S: HostScalar>(agents: &[Value], polygons: [&[Point]; 2], slack: f64) -> [usize; 2] {
    const SLICES: usize = 12;
    const LENGTHS: usize = 80;
    let scenario = read(agents);
    // An outline that is computed as it is is that of the motion as the format holds it.
    let lost = if S::NAME == f64::NAME { 1e-9 } else { slack };
    let smaller = polygons.map(|polygon| polygons::smaller(polygon, lost));
    let fleet = references(&scenario);
    let motions = fleet.motions();
    let answer =
        RegionsReport::compute::<S>(&scenario, RegionOptions { agent: None, slices: Some(SLICES), certificate: false })
            .unwrap();
    let mut counts = [0, 0];
    for (own, other) in [(0, 1), (1, 0)] {
        let (ego, them): (&Motion<'_, f64>, &Motion<'_, f64>) = (&motions[own], &motions[other]);
        let id = scenario.agents[own].id;
        let regions: Vec<RegionEntry> = answer.regions.iter().filter(|region| region.i == id).cloned().collect();
        // At the times of the slices of each region, that of all regions then.
        for region in &regions {
            for slice in region.slices.iter().flatten() {
                let there = them.path().pose_at(them.length_at(slice.t));
                let [far, inner] = [placed(polygons[other], there), placed(&smaller[other], there)];
                for step in 0..=LENGTHS {
                    let length = scenario.agents[own].length() * (step as f64 / LENGTHS as f64);
                    let here = ego.path().pose_at(length);
                    let distance = apart(&placed(polygons[own], here), &far);
                    let in_slice = |by: f64| slice.l.iter().any(|[lo, hi]| within([lo - by, hi + by], length));
                    // On a turn in place, a whole turn is no longer than what the format may lose.
                    let covered = in_slice(lost);
                    assert!(!in_slice(0.0) || distance <= 3.0 * slack, "t {} l {length}: {distance}", slice.t);
                    // What no other region may hold is in this one.
                    let others = regions.iter().filter(|other| *other != region);
                    let alone = others.clone().all(|other| !within(other.t, slice.t) || !within(other.l, length));
                    let is_free = || apart(&placed(&smaller[own], here), &inner) > 0.0;
                    assert!(covered || !alone || is_free(), "{} t {} l {length}: not covered", S::NAME, slice.t);
                    counts[usize::from(distance > 0.0)] += 1;
                }
            }
        }
        // Everywhere in time: where the polygons overlap a region is there.
        let time = them.time();
        for step in 0..=120 {
            let t = time.lo + (time.hi - time.lo) * f64::from(step) / 120.0;
            let far = placed(&smaller[other], them.path().pose_at(them.length_at(t)));
            for step in 0..=LENGTHS {
                let length = scenario.agents[own].length() * (step as f64 / LENGTHS as f64);
                if apart(&placed(&smaller[own], ego.path().pose_at(length)), &far) == 0.0 {
                    // With fewer digits the other agent may arrive a little earlier.
                    let there = |region: &RegionEntry| within(region.t, t) || (region.open_end && t > region.t[1]);
                    let inside = regions
                        .iter()
                        .any(|region| there(region) && within([region.l[0] - lost, region.l[1] + lost], length));
                    assert!(inside, "t {t} l {length}: no region");
                }
            }
        }
    }
    conflicts::<S>(&scenario, &motions, [polygons, [&smaller[0], &smaller[1]]], [2.0 * slack, lost]);
    counts
}

/// Where the smaller polygons overlap there is a conflict, and in a conflict the polygons are near somewhere.
fn conflicts<S: HostScalar>(
    scenario: &Scenario,
    motions: &[Motion<'_, f64>],
    [polygons, smaller]: [[&[Point]; 2]; 2],
    [most, lost]: [f64; 2],
) {
    let verdict = CheckReport::compute::<S>(scenario, true).unwrap();
    let between = |polygons: [&[Point]; 2], t: f64| {
        let [a, b] = [0, 1].map(|k| placed(polygons[k], motions[k].path().pose_at(motions[k].length_at(t))));
        apart(&a, &b)
    };
    let end = motions.iter().map(|motion| motion.time().hi).fold(0.0, f64::max);
    for step in 0..=2000 {
        let t = end * f64::from(step) / 2000.0;
        let there = verdict.conflicts.iter().any(|conflict| within(conflict.t, t));
        let distance = between(polygons, t);
        assert!(there || between(smaller, t) > 0.0, "t {t}: no conflict");
        assert!(!there || distance <= most, "t {t}: a conflict at {distance}");
        // What is said to be nearest is.
        let closest = verdict.closest.as_ref().unwrap()[0];
        assert!(closest.clearance <= distance + 2.0 * lost, "t {t}: {} {distance}", closest.clearance);
    }
}

#[test]
fn crossing_vehicles() {
    let agents = [
        agent(1, &TRUCK, [-4.0, 0.0, 0.0], &json!([line(3.0), arc(1.5, FRAC_PI_2), line(3.0)])),
        agent(2, &SQUARE, [0.5, -4.0, FRAC_PI_2], &json!([line(8.0)])),
    ];
    let [inside, outside] = compare(&agents, [&TRUCK, &SQUARE]);
    assert!(inside > 100 && outside > 100, "{inside} {outside}");
}

#[test]
fn a_vehicle_that_turns_in_place_sweeps_what_is_beside_it() {
    // It comes, turns back on the spot, and goes; the other one passes within reach of its nose only.
    let turn = json!([line(2.0), arc(1e-9, PI), line(2.0)]);
    let profile = json!({ "v0": 0.0, "pieces": [
        { "duration": 2.0, "accel": 0.5 }, { "duration": 2.0, "accel": -0.5 },
        { "duration": 2.0, "accel": 1e-9 * PI / 4.0 }, { "duration": 2.0, "accel": -1e-9 * PI / 4.0 },
        { "duration": 2.0, "accel": 0.5 }, { "duration": 2.0, "accel": -0.5 } ] });
    let mut turning = agent(1, &TRUCK, [0.0, 0.0, 0.0], &turn);
    turning["profile"] = profile;
    let agents = [turning, agent(2, &SQUARE, [-2.0, 0.95, 0.0], &json!([line(6.0)]))];
    let [inside, outside] = compare(&agents, [&TRUCK, &SQUARE]);
    assert!(inside > 100 && outside > 100, "{inside} {outside}");
    // While the reference point stands.
    let scenario = read(&agents);
    let regions =
        RegionsReport::compute::<f64>(&scenario, RegionOptions { agent: Some(1), slices: None, certificate: false })
            .unwrap()
            .regions;
    assert!(regions.iter().any(|region| region.pieces.iter().any(|piece| piece.i_segment == Some(2))));
}

#[test]
fn the_centre_of_an_arc_may_be_inside_the_outline() {
    let agents = [
        agent(1, &TRUCK, [-2.0, 0.0, 0.0], &json!([line(2.0), arc(0.2, -1.4 * PI), line(1.0)])),
        agent(2, &TRUCK, [2.5, -0.2, PI], &json!([line(1.0), arc(0.6, 1.0), line(2.0)])),
    ];
    let [inside, outside] = compare(&agents, [&TRUCK, &TRUCK]);
    assert!(inside > 100 && outside > 100, "{inside} {outside}");
}

/// In formats with fewer digits regions contain the polygons as well.
#[test]
fn vehicles_in_fixed_point() {
    let turn = json!([line(1.5), { "kind": "turn", "sweep": -2.0 }, line(1.0), arc(1.2, FRAC_PI_2), line(0.5)]);
    let mut turning = agent(1, &TRUCK, [-1.5, 0.3, 0.1], &turn);
    (turning["turn_v_max"], turning["turn_a_max"]) = (json!(1.0), json!(1.5));
    let agents = [turning, agent(2, &SQUARE, [0.5, -2.5, FRAC_PI_2], &json!([line(2.0), arc(1.5, 1.1), line(1.0)]))];
    for counts in [
        compare_in::<f32>(&agents, [&TRUCK, &SQUARE], 0.01),
        compare_in::<Q20>(&agents, [&TRUCK, &SQUARE], 0.02),
        compare_in::<Q16>(&agents, [&TRUCK, &SQUARE], 0.02),
        compare_in::<Q12>(&agents, [&TRUCK, &SQUARE], 0.1),
    ] {
        assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
    }
}

#[test]
fn random_vehicles() {
    const PAIRS: u64 = if cfg!(optimized) { 30 } else { 5 };
    let mut met = 0;
    for seed in 0..PAIRS {
        let mut dice = Dice::seeded(seed);
        let mut path = || {
            let legs = (0..3).map(|_| match dice.chance(0.5) {
                true => line(dice.range(0.5, 3.0)),
                false => arc(dice.range(0.3, 2.0), dice.range(-2.5, 2.5)),
            });
            legs.collect::<Vec<_>>()
        };
        let paths = [path(), path()].map(Value::from);
        let place = |dice: &mut Dice| [dice.range(-1.0, 1.0), dice.range(-1.0, 1.0), dice.range(-PI, PI)];
        let agents = [agent(1, &TRUCK, place(&mut dice), &paths[0]), agent(2, &SQUARE, place(&mut dice), &paths[1])];
        met += usize::from(compare(&agents, [&TRUCK, &SQUARE])[0] > 0);
        if seed % 2 == 0 {
            compare_in::<Q16>(&agents, [&TRUCK, &SQUARE], 0.05);
        }
    }
    assert!(met > 2, "{met}");
}

/// A fork lift whose fork is a gap between two prongs, and a post that it takes between them.
#[test]
fn a_fork_takes_a_post_between_its_prongs() {
    const FORK: [[f64; 2]; 8] =
        [[-0.3, -0.4], [1.2, -0.4], [1.2, -0.2], [0.3, -0.2], [0.3, 0.2], [1.2, 0.2], [1.2, 0.4], [-0.3, 0.4]];
    let stands = |y: f64| {
        json!({ "id": 2, "radius": 0.15, "v_max": 1.0, "a_max": 1.0, "path": [],
        "start": { "x": 3.0, "y": y, "heading": 0.0 } })
    };
    for (y, is_free) in [(0.0, true), (0.049, true), (0.051, false)] {
        let scenario = read(&[agent(1, &FORK, [0.0; 3], &json!([line(2.5)])), stands(y)]);
        let request = RegionOptions { certificate: true, ..RegionOptions::default() };
        let answer = RegionsReport::compute::<f64>(&scenario, request).unwrap();
        assert_eq!(answer.regions.is_empty(), is_free, "{y}");
        assert_eq!(answer.bodies[0].parts.len(), 3);
        assert!(CheckReport::compute::<f64>(&scenario, false).unwrap().conflicts.is_empty() == is_free, "{y}");
    }
}

#[test]
fn a_turn_in_place_is_computed_as_it_is() {
    let path = json!([line(3.0), { "kind": "turn", "sweep": FRAC_PI_2 }]);
    // The corner of the square passes at 0.25 m times the root of 2.
    let reach = 0.25 * 2.0_f64.sqrt();
    for (apart, is_free) in [(1e-6, true), (-1e-6, false)] {
        let disc = json!({ "id": 7, "radius": 0.3, "v_max": 1.0, "a_max": 0.5, "path": [],
            "start": { "x": 3.0 + reach + 0.3 + apart, "y": 0.0, "heading": 0.0 } });
        let mut turning = agent(2, &SQUARE, [0.0, 0.0, 0.0], &path);
        (turning["turn_v_max"], turning["turn_a_max"]) = (json!(1.0), json!(1.5));
        let scenario = read(&[disc, turning]);
        let answer = RegionsReport::compute::<f64>(&scenario, RegionOptions::default()).unwrap();
        assert_eq!(answer.regions.is_empty(), is_free);
    }
    let both = json!({ "agents": [{ "id": 1, "radius": 0.1, "footprint": outline(&SQUARE), "path": [],
        "v_max": 1.0, "a_max": 1.0, "start": { "x": 0.0, "y": 0.0, "heading": 0.0 } }] });
    assert!(Scenario::from_json(&both.to_string()).unwrap_err().to_string().contains("not both"));
}
