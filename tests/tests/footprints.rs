//! Agents with polygons for outlines: regions and conflicts contain those of the polygons and exceed them by what a number format loses.

use pcr_core::Motion;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::scenario::{Agent, PathSegment, Scenario};
use pcr_planning::certify::{CertifyInput, CertifyReport};
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
    Scenario::from_json(&json!({ "name": "outlines", "version": 5, "agents": agents }).to_string()).unwrap()
}

/// A segment in reverse gear.
fn reverse(mut segment: Value) -> Value {
    segment["gear"] = json!("reverse");
    segment
}

/// The polygons of a vehicle at a length of its path, from the path of the scenario alone: many where it turns in place there.
fn placed(polygon: &[Point], agent: &Agent, length: f64) -> Vec<Polygon> {
    const POSES: u32 = 64;
    let at = |share: f64| {
        let (mut rest, mut before) = (length, 0.0);
        let ways = agent.path.iter().map(|segment| {
            let own = rest.clamp(0.0, segment.length());
            rest -= own;
            before += segment.length();
            if !segment.takes_turning() {
                return own;
            }
            let share = if rest > 0.0 {
                1.0
            } else if before == length {
                share
            } else {
                0.0
            };
            share * segment.sweep().abs()
        });
        after(polygon, agent, &ways.collect::<Vec<_>>())
    };
    let mut from = 0.0;
    let turns = agent.path.iter().any(|segment| {
        from += segment.length();
        segment.takes_turning() && from == length
    });
    if turns { (0..=POSES).map(|k| at(f64::from(k) / f64::from(POSES))).collect() } else { vec![at(0.0)] }
}

/// The least distance of some polygons from another one.
fn least(polygons: &[Polygon], other: &Polygon) -> f64 {
    polygons.iter().map(|polygon| apart(polygon, other)).fold(f64::INFINITY, f64::min)
}

/// The polygon of a vehicle at a time, from the motion of the scenario alone.
fn placed_at(polygon: &[Point], agent: &Agent, time: f64) -> Polygon {
    let mut rest = time - agent.t_start;
    let ways = agent.parts().into_iter().map(|phases| {
        let way = phases.iter().map(|phase| {
            let own = rest.clamp(0.0, phase.duration);
            rest -= own;
            phase.before * own + 0.5 * phase.acceleration() * own * own
        });
        way.sum()
    });
    after(polygon, agent, &ways.collect::<Vec<_>>())
}

/// The polygon of a vehicle that has come so far on each of its segments \[m\], of turns in place \[rad\].
fn after(polygon: &[Point], agent: &Agent, ways: &[f64]) -> Polygon {
    let [mut x, mut y, mut heading] = agent.start;
    let mut facing = 0.0;
    for (segment, &own) in agent.path.iter().zip(ways) {
        match *segment {
            // At the change itself it does not matter.
            PathSegment::Facing { after, .. } => facing = after,
            PathSegment::Line { .. } => {
                x += own * (heading - facing).cos();
                y += own * (heading - facing).sin();
            }
            PathSegment::Arc { radius, sweep, steady } => {
                // The centre is beside the way.
                let (side, turned) = (radius.copysign(sweep), (own / radius).copysign(sweep));
                let way = heading - facing;
                x += side * ((way + turned).sin() - way.sin());
                y -= side * ((way + turned).cos() - way.cos());
                if steady { facing -= turned } else { heading += turned }
            }
            PathSegment::Turn { sweep } => heading += own.copysign(sweep),
            PathSegment::Kink { .. } => panic!("{segment:?}"),
        }
    }
    polygons::placed(polygon, [x, y], heading)
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

/// Makes the comparison of [`compare`] in a number format that loses up to `slack` \[m\]; the polygons are where the scenario has them.
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
        let them: &Motion<'_, f64> = &motions[other];
        let id = scenario.agents[own].id;
        let regions: Vec<RegionEntry> = answer.regions.iter().filter(|region| region.i == id).cloned().collect();
        // At the times of the slices of each region, that of all regions then.
        for region in &regions {
            for slice in region.slices.iter().flatten() {
                let far = placed_at(polygons[other], &scenario.agents[other], slice.t);
                let inner = placed_at(&smaller[other], &scenario.agents[other], slice.t);
                for step in 0..=LENGTHS {
                    let length = scenario.agents[own].length() * (step as f64 / LENGTHS as f64);
                    let here = |polygon: &[Point]| placed(polygon, &scenario.agents[own], length);
                    let distance = least(&here(polygons[own]), &far);
                    let in_slice = |by: f64| slice.l.iter().any(|[lo, hi]| within([lo - by, hi + by], length));
                    // On a turn in place, a whole turn is no longer than what the format may lose.
                    let covered = in_slice(lost);
                    assert!(!in_slice(0.0) || distance <= 3.0 * slack, "t {} l {length}: {distance}", slice.t);
                    // What no other region may hold is in this one.
                    let others = regions.iter().filter(|other| *other != region);
                    // The end of a path is rounded in another way as an end of a region than as the sum of its segments.
                    let alone = others.clone().all(|other| {
                        !within(other.t, slice.t) || !within([other.l[0] - lost, other.l[1] + lost], length)
                    });
                    let is_free = || least(&here(&smaller[own]), &inner) > 0.0;
                    assert!(covered || !alone || is_free(), "{} t {} l {length}: not covered", S::NAME, slice.t);
                    counts[usize::from(distance > 0.0)] += 1;
                }
            }
        }
        // Everywhere in time: where the polygons overlap a region is there.
        let time = them.time();
        for step in 0..=120 {
            let t = time.lo + (time.hi - time.lo) * f64::from(step) / 120.0;
            let far = placed_at(&smaller[other], &scenario.agents[other], t);
            for step in 0..=LENGTHS {
                let length = scenario.agents[own].length() * (step as f64 / LENGTHS as f64);
                if least(&placed(&smaller[own], &scenario.agents[own], length), &far) == 0.0 {
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
        let [a, b] = [0, 1].map(|k| placed_at(polygons[k], &scenario.agents[k], t));
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
    let turn = json!([line(2.0), { "kind": "turn", "sweep": PI }, line(2.0)]);
    let profile = json!({ "v0": 0.0, "pieces": [
        { "duration": 2.0, "accel": 0.5 }, { "duration": 2.0, "accel": -0.5 },
        { "duration": 2.0, "turn_accel": PI / 4.0 }, { "duration": 2.0, "turn_accel": -PI / 4.0 },
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

/// A truck that backs out of a bay and drives on, with its nose ahead all the time; and one that begins in reverse gear.
fn reversing() -> [Value; 2] {
    let out = json!([line(2.0), reverse(arc(1.5, 1.1)), reverse(line(1.3)), line(0.7), arc(1.2, -0.9)]);
    let back = json!([reverse(line(1.1)), reverse(arc(0.8, -1.2)), arc(0.9, 0.4), line(1.5)]);
    [agent(1, &TRUCK, [-1.5, 0.3, 0.1], &out), agent(2, &SQUARE, [0.6, -0.4, 1.3], &back)]
}

#[test]
fn vehicles_in_reverse_gear() {
    let agents = reversing();
    let [inside, outside] = compare(&agents, [&TRUCK, &SQUARE]);
    assert!(inside > 100 && outside > 100, "{inside} {outside}");
    for counts in [
        compare_in::<f32>(&agents, [&TRUCK, &SQUARE], 0.01),
        compare_in::<Q20>(&agents, [&TRUCK, &SQUARE], 0.02),
        compare_in::<Q16>(&agents, [&TRUCK, &SQUARE], 0.02),
        compare_in::<Q12>(&agents, [&TRUCK, &SQUARE], 0.1),
    ] {
        assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
    }
    // Without its gear the truck would be elsewhere, and so it would if it turned round at its cusps.
    let scenario = read(&agents);
    let mut turning = agents.clone();
    turning[0]["path"] = json!([line(2.0), { "kind": "turn", "sweep": PI }, arc(1.5, 1.1), line(1.3),
        { "kind": "turn", "sweep": -PI }, line(0.7), arc(1.2, -0.9)]);
    (turning[0]["turn_v_max"], turning[0]["turn_a_max"]) = (json!(1.0), json!(1.0));
    let lengths = |scenario: &Scenario| {
        let options = RegionOptions { agent: Some(1), slices: None, certificate: false };
        let answer = RegionsReport::compute::<f64>(scenario, options).unwrap();
        answer.regions.iter().map(|region| region.l).collect::<Vec<_>>()
    };
    assert_ne!(lengths(&scenario), lengths(&read(&turning)));
}

/// Segments are numbered as in the file, where a change of gear is none.
#[test]
fn tables_in_reverse_gear_are_proved() {
    let scenario = read(&reversing());
    assert_eq!(scenario.agents[0].structure(), "SCASCSA");
    proved_in_formats(&scenario, 5);
    // As its file says it, and no other.
    assert_eq!(Scenario::from_json(&scenario.to_json()), Ok(scenario));
}

/// The table of two agents is proved in each format, and names segments up to this number.
fn proved_in_formats(scenario: &Scenario, segments: usize) {
    fn proved<S: HostScalar>(scenario: &Scenario, most: usize) {
        let options = RegionOptions { agent: None, slices: None, certificate: true };
        let answer = RegionsReport::compute::<S>(scenario, options).unwrap();
        let segments = answer.regions.iter().flat_map(|region| &region.pieces).filter_map(|piece| piece.i_segment);
        let segments: Vec<usize> = segments.collect();
        assert!(!segments.is_empty() && segments.iter().all(|segment| (1..=most).contains(segment)), "{segments:?}");
        let mut text = Vec::new();
        pcr_planning::report::json(&answer, &mut text).unwrap();
        let input = CertifyInput::of_json(std::str::from_utf8(&text).unwrap()).unwrap();
        let report = CertifyReport::prove("", &input.certificate[0], false);
        assert_eq!(report.verdict, Some("proved"), "{} {report:?}", S::NAME);
        assert!(report.outlines >= 2, "{report:?}");
    }
    proved::<f64>(scenario, segments);
    proved::<f32>(scenario, segments);
    proved::<Q20>(scenario, segments);
    proved::<Q16>(scenario, segments);
}

/// A segment on which the heading is at an angle to the direction of travel.
fn facing(mut segment: Value, angle: f64) -> Value {
    segment["facing"] = json!(angle);
    segment
}

/// A vehicle that goes around an obstacle without turning, and one that travels an arc sideways.
fn sideways() -> [Value; 2] {
    let around =
        json!([line(1.5), facing(line(0.8), -FRAC_PI_2), line(1.2), facing(line(0.8), FRAC_PI_2), reverse(line(0.5))]);
    let across = json!([facing(arc(1.2, 2.0), FRAC_PI_2), facing(line(1.0), 0.4), { "kind": "turn", "sweep": 0.8 }, facing(line(0.5), -2.9)]);
    let mut across = agent(2, &SQUARE, [0.6, -0.4, 1.3], &across);
    (across["turn_v_max"], across["turn_a_max"]) = (json!(1.0), json!(1.0));
    [agent(1, &TRUCK, [-1.5, 0.3, 0.1], &around), across]
}

/// Compares a truck and a square platform in all formats with the oracle, except within what rounding may move a boundary \[m\].
fn compare_in_formats(agents: &[Value; 2]) {
    for counts in [
        compare(agents, [&TRUCK, &SQUARE]),
        compare_in::<f32>(agents, [&TRUCK, &SQUARE], 0.01),
        compare_in::<Q20>(agents, [&TRUCK, &SQUARE], 0.02),
        compare_in::<Q16>(agents, [&TRUCK, &SQUARE], 0.02),
        compare_in::<Q12>(agents, [&TRUCK, &SQUARE], 0.1),
    ] {
        assert!(counts.iter().all(|count| *count > 100), "{counts:?}");
    }
}

#[test]
fn vehicles_that_travel_sideways() {
    let agents = sideways();
    compare_in_formats(&agents);
    proved_in_formats(&read(&agents), 5);
}

/// A segment on which the heading is kept.
fn steady(mut segment: Value) -> Value {
    segment["steady"] = json!(true);
    segment
}

/// Platforms with steered wheels only, of which one turns with an arc at the end.
fn platforms() -> [Value; 2] {
    let keeps = json!([
        line(1.0),
        steady(arc(1.0, 1.3)),
        steady(line(0.6)),
        steady(arc(0.5, -2.2)),
        facing(line(0.5), 0.4),
        steady(arc(0.4, 7.0))
    ]);
    let turns = json!([steady(facing(arc(1.2, -2.0), FRAC_PI_2)), steady(line(0.6)), facing(arc(0.8, 1.5), -0.3)]);
    [agent(1, &TRUCK, [-1.5, -0.3, 0.1], &keeps), agent(2, &SQUARE, [0.6, -0.4, 1.3 + FRAC_PI_2], &turns)]
}

#[test]
fn vehicles_that_keep_their_heading_on_arcs() {
    let agents = platforms();
    compare_in_formats(&agents);
    let scenario = read(&agents);
    assert_eq!(Scenario::from_json(&scenario.to_json()), Ok(scenario.clone()));
    proved_in_formats(&scenario, 6);
    // On arcs with the body they would be elsewhere.
    let mut turning = agents.clone();
    turning[0]["path"] = json!([
        line(1.0),
        arc(1.0, 1.3),
        line(0.6),
        arc(0.5, -2.2),
        facing(line(0.5), 0.4),
        facing(arc(0.4, 7.0), 0.4)
    ]);
    let lengths = |scenario: &Scenario| {
        let options = RegionOptions { agent: Some(1), slices: None, certificate: false };
        let answer = RegionsReport::compute::<f64>(scenario, options).unwrap();
        answer.regions.iter().map(|region| region.l).collect::<Vec<_>>()
    };
    assert_ne!(lengths(&scenario), lengths(&read(&turning)));
}

/// On every line and arc an outline at an angle to its way covers what an outline that is turned by the angle covers along it.
#[test]
fn an_angle_turns_the_outline() {
    let turned = |polygon: &[[f64; 2]], angle: f64| {
        let (sin, cos) = angle.sin_cos();
        polygon.iter().map(|[x, y]| [x * cos - y * sin, x * sin + y * cos]).collect::<Vec<_>>()
    };
    for (place, angle) in [0.3, FRAC_PI_2, -1.2, 3.0, PI].into_iter().enumerate() {
        let path = [arc(1.5, 1.1), line(1.3), arc(1.2, -0.9)];
        let start = [-1.0, 0.2, 0.1];
        let other = agent(2, &SQUARE, [0.0, 0.2, 1.3], &json!([line(0.5), arc(0.8, -1.2)]));
        let along = agent(1, &turned(&TRUCK, angle), start, &json!(path));
        let across = path.map(|segment| facing(segment, angle));
        let across = agent(1, &TRUCK, [start[0], start[1], start[2] + angle], &json!(across));
        let regions = [along, across].map(|own| {
            let options = RegionOptions { agent: None, slices: None, certificate: false };
            let answer = RegionsReport::compute::<f64>(&read(&[own, other.clone()]), options).unwrap();
            answer.regions.iter().flat_map(|region| [region.t, region.l]).collect::<Vec<_>>()
        });
        assert!(!regions[0].is_empty() && regions[0].len() == regions[1].len(), "{place}: {regions:?}");
        for (one, other) in regions[0].iter().zip(&regions[1]) {
            assert!((one[0] - other[0]).abs() < 1e-7 && (one[1] - other[1]).abs() < 1e-7, "{angle}: {regions:?}");
        }
    }
}

/// With a load on some of them, too, each segment has its outline and its angle.
#[test]
fn loads_of_vehicles_that_change_their_gear() {
    const LONG: [[f64; 2]; 4] = [[-0.9, -0.2], [1.1, -0.2], [1.1, 0.2], [-0.9, 0.2]];
    let [mut one, mut other] = [reversing(), sideways()].map(|[own, _]| own);
    (other["id"], other["start"]["y"]) = (json!(2), json!(-0.6));
    for (agent, [first, second]) in [(&mut one, [[1, 2], [3, 3]]), (&mut other, [[2, 3], [5, 5]])] {
        let load = |segments: [usize; 2], polygon| json!({ "segments": segments, "footprint": outline(polygon) });
        agent["loads"] = json!([load(first, &SQUARE), load(second, &LONG)]);
    }
    let scenario = read(&[one, other]);
    let options = RegionOptions { agent: Some(1), slices: None, certificate: false };
    let regions = RegionsReport::compute::<f64>(&scenario, options).unwrap().regions;
    // The poses of an agent at lengths between the ends of its segments, each with the outline that it has there.
    let poses = |agent: &Agent| {
        let outlines = agent.outlines();
        let mut before = 0.0;
        let mut poses = Vec::new();
        for (place, segment) in agent.path.iter().enumerate() {
            let own = outlines.iter().find(|own| (own.segments[0]..=own.segments[1]).contains(&place)).unwrap();
            for share in 0..15 {
                let length = before + (f64::from(share) + 0.5) / 15.0 * segment.length();
                if segment.length() > 0.0 {
                    poses.push((length, placed(own.footprint.unwrap().polygon(), agent, length).swap_remove(0)));
                }
            }
            before += segment.length();
        }
        poses
    };
    let [one, other] = [0, 1].map(|place| poses(&scenario.agents[place]));
    let (mut inside, mut outside) = (0, 0);
    for ((i, a), (j, b)) in one.iter().flat_map(|one| other.iter().map(move |other| (one, other))) {
        let gap = apart(a, b);
        let mut pieces = regions.iter().flat_map(|region| &region.pieces);
        if gap <= 0.0 {
            inside += 1;
            assert!(pieces.any(|piece| within(piece.i_length, *i) && within(piece.j_length, *j)), "{i} {j}: {gap}");
        } else if !regions.iter().any(|region| within(region.l, *i)) {
            outside += 1;
        }
    }
    assert!(inside > 100 && outside > 100, "{inside} {outside}");
    proved_in_formats(&scenario, 5);
}

#[test]
fn random_vehicles_in_reverse_gear() {
    const PAIRS: u64 = if cfg!(optimized) { 30 } else { 5 };
    let mut met = 0;
    for seed in 0..PAIRS {
        let mut dice = Dice::seeded(1000 + seed);
        let mut path = || {
            let legs = (0..4).map(|_| {
                let leg = match dice.chance(0.5) {
                    true => line(dice.range(0.5, 2.0)),
                    false => arc(dice.range(0.3, 2.0), dice.range(-2.0, 2.0)),
                };
                match dice.chance(0.5) {
                    true if dice.chance(0.5) => reverse(leg),
                    true => facing(leg, dice.range(-4.0, 4.0)),
                    false => leg,
                }
            });
            legs.collect::<Vec<_>>()
        };
        let paths = [path(), path()].map(Value::from);
        let place = |dice: &mut Dice| [dice.range(-1.0, 1.0), dice.range(-1.0, 1.0), dice.range(-PI, PI)];
        let agents = [agent(1, &TRUCK, place(&mut dice), &paths[0]), agent(2, &TRUCK, place(&mut dice), &paths[1])];
        met += usize::from(compare(&agents, [&TRUCK, &TRUCK])[0] > 0);
    }
    assert!(met > 2, "{met}");
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
