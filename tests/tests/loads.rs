//! Outlines that change along the path, and turns in place: against distances at many times and lengths.

use pcr_core::Motion;
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::scenario::{Agent, Scenario};
use pcr_planning::check::CheckReport;
use pcr_planning::fleet::{Fleet, HostScalar};
use pcr_planning::regions::{RegionEntry, RegionOptions, RegionsReport};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, PI};

fn line(length: f64) -> Value {
    json!({ "kind": "line", "length": length })
}

fn arc(radius: f64, sweep: f64) -> Value {
    json!({ "kind": "arc", "radius": radius, "sweep": sweep })
}

fn turn(sweep: f64) -> Value {
    json!({ "kind": "turn", "sweep": sweep })
}

fn agent(id: u64, radius: f64, start: [f64; 3], path: &Value) -> Value {
    json!({ "id": id, "radius": radius, "v_max": 1.0, "a_max": 0.7, "turn_v_max": 1.5, "turn_a_max": 2.0, "path": path,
        "start": { "x": start[0], "y": start[1], "heading": start[2] } })
}

fn read(agents: &[Value]) -> Scenario {
    Scenario::from_json(&json!({ "agents": agents }).to_string()).unwrap()
}

/// The radii that count at a length: two where one gives way to another.
fn radii(agent: &Agent, length: f64) -> Vec<f64> {
    let mut from = 0.0;
    let mut radii = Vec::new();
    for (k, segment) in agent.path.iter().enumerate() {
        if from <= length + 1e-9 && length <= from + segment.length() + 1e-9 {
            let load = agent.loads.iter().find(|load| (load.segments[0]..=load.segments[1]).contains(&k));
            radii.push(load.map_or(agent.radius, |load| load.radius));
        }
        from += segment.length();
    }
    radii
}

/// How far the discs reach into one another at most, by the largest of the radii that count, and by the smallest.
fn overlap(agents: [&Agent; 2], motions: [&Motion<'_, f64>; 2], lengths: [f64; 2]) -> [f64; 2] {
    let [a, b] = [0, 1].map(|k| motions[k].path().point_at(lengths[k]));
    let distance = (a.x - b.x).hypot(a.y - b.y);
    let reach = |pick: fn(f64, f64) -> f64| -> f64 {
        (0..2).map(|k| radii(agents[k], lengths[k]).into_iter().reduce(pick).unwrap_or_default()).sum()
    };
    [reach(f64::max) - distance, reach(f64::min) - distance]
}

fn within([lo, hi]: [f64; 2], x: f64) -> bool {
    lo <= x && x <= hi
}

/// Regions, and conflicts, are where the discs overlap, and nowhere else; returns how many points were inside.
fn compare(scenario: &Scenario) -> usize {
    const STEPS: usize = 200;
    let fleet = Fleet::<f64>::new(scenario).unwrap();
    let motions = fleet.motions();
    let answer =
        RegionsReport::compute::<f64>(scenario, RegionOptions { agent: None, slices: Some(15), certificate: false })
            .unwrap();
    let mut inside = 0;
    for [own, other] in [[0, 1], [1, 0]] {
        let (agents, motions) = ([own, other].map(|k| &scenario.agents[k]), [own, other].map(|k| &motions[k]));
        let regions: Vec<_> = answer.regions.iter().filter(|region| region.i == agents[0].id).collect();
        for region in &regions {
            for slice in region.slices.iter().flatten() {
                for step in 0..=STEPS {
                    let length = agents[0].length() * (step as f64 / STEPS as f64);
                    let [most, least] = overlap(agents, motions, [length, motions[1].length_at(slice.t)]);
                    let covered = slice.l.iter().any(|lengths| within(*lengths, length));
                    let others = regions.iter().filter(|other| **other != *region);
                    let alone = others.clone().all(|other| !within(other.t, slice.t) || !within(other.l, length));
                    assert!(!covered || most >= -1e-8, "t {} l {length}: {most}", slice.t);
                    assert!(covered || least <= 1e-8 || !alone, "t {} l {length}: {least}", slice.t);
                    inside += usize::from(covered);
                }
            }
        }
        let time = motions[1].time();
        for step in 0..=STEPS {
            let t = time.lo + (time.hi - time.lo) * step as f64 / STEPS as f64;
            for step in 0..=STEPS {
                let length = agents[0].length() * (step as f64 / STEPS as f64);
                if overlap(agents, motions, [length, motions[1].length_at(t)])[1] > 1e-8 {
                    assert!(
                        regions.iter().any(|region| within(region.t, t) && within(region.l, length)),
                        "{t} {length}"
                    );
                }
            }
        }
    }
    conflicts(scenario, &motions);
    inside
}

fn conflicts(scenario: &Scenario, motions: &[Motion<'_, f64>]) {
    let verdict = CheckReport::compute::<f64>(scenario, true).unwrap();
    let ends = motions.iter().map(|motion| motion.time().hi).fold(0.0, f64::max);
    let pair = [&scenario.agents[0], &scenario.agents[1]];
    let mut deepest = f64::NEG_INFINITY;
    for step in 0..=4000 {
        let t = ends * f64::from(step) / 4000.0;
        let lengths = [0, 1].map(|k| motions[k].length_at(t));
        let [most, least] = overlap(pair, [&motions[0], &motions[1]], lengths);
        let conflict = verdict.conflicts.iter().find(|conflict| within(conflict.t, t));
        assert!(conflict.is_some() || least <= 1e-8, "t {t}: no conflict, {least}");
        assert!(conflict.is_none() || most >= -1e-8, "t {t}: a conflict, {most}");
        assert!(conflict.is_none_or(|conflict| conflict.depth >= least - 1e-8), "t {t}: {least} {conflict:?}");
        deepest = deepest.max(least);
    }
    let clearance = verdict.closest.as_ref().unwrap()[0].clearance;
    assert!(-clearance >= deepest - 1e-9, "{clearance} {deepest}");
}

fn with_loads(mut agent: Value, loads: Value) -> Value {
    agent["loads"] = loads;
    agent
}

#[test]
fn a_loaded_vehicle_is_wide_where_it_is_loaded() {
    // Passing lanes 0.7 m apart: too near where the first one is loaded, else not.
    let path = json!([line(3.0), line(2.0), line(3.0)]);
    let loads = json!([{ "segments": [2, 2], "radius": 0.5 }]);
    let agents =
        [with_loads(agent(1, 0.3, [0.0, 0.0, 0.0], &path), loads), agent(2, 0.3, [8.0, 0.7, PI], &json!([line(8.0)]))];
    let scenario = read(&agents);
    assert!(compare(&scenario) > 100);
    let answer = RegionsReport::compute::<f64>(&scenario, RegionOptions::default()).unwrap();
    let [region] = answer.regions.iter().filter(|region| region.i == 1).collect::<Vec<_>>()[..] else {
        panic!("one region of the first agent: {:?}", answer.regions)
    };
    assert!(within([2.9999, 3.0], region.l[0]) && within([5.0, 5.0001], region.l[1]), "{:?}", region.l);
    assert!(region.pieces.iter().all(|piece| piece.i_segment == Some(2)));
    assert!(!region.open_start && !region.open_end);
    // What computes with one disc takes the largest.
    assert_eq!(Fleet::<f64>::new(&scenario).unwrap().motions()[0].radius(), 0.5);
}

#[test]
fn loads_on_curves_and_on_both_agents() {
    let path = json!([line(2.0), arc(1.0, FRAC_PI_2), line(1.0), arc(0.8, -1.0), line(2.0)]);
    let one = with_loads(
        agent(1, 0.2, [-3.0, 0.0, 0.0], &path),
        json!([{ "segments": [1, 2], "radius": 0.55 }, { "segments": [4, 4], "radius": 0.3 }]),
    );
    for shift in [-1.0, 0.0, 0.7, 1.4] {
        let other = with_loads(
            agent(2, 0.3, [shift, -3.0, FRAC_PI_2], &json!([line(3.0), line(1.0), line(3.0)])),
            json!([{ "segments": [2, 3], "radius": 0.5 }]),
        );
        assert!(compare(&read(&[one.clone(), other])) > 100, "{shift}");
    }
}

#[test]
fn a_load_that_is_taken_up_while_standing() {
    // It waits 4 s at the border, in the way of the other one only with its load.
    let mut first = agent(1, 0.2, [-2.0, 0.0, 0.0], &json!([line(2.0), line(2.0)]));
    first["profile"] = json!({ "v0": 0.0, "pieces": [ { "duration": 2.0, "accel": 0.5 }, { "duration": 2.0, "accel": -0.5 },
        { "duration": 4.0, "accel": 0.0 }, { "duration": 2.0, "accel": 0.5 }, { "duration": 2.0, "accel": -0.5 } ] });
    let second = agent(2, 0.2, [-1.0, 0.6, 0.0], &json!([line(4.0)]));
    let scenario = read(&[with_loads(first, json!([{ "segments": [2, 2], "radius": 0.45 }])), second]);
    assert!(compare(&scenario) > 10);
}

/// Behind a segment without length the vehicle stands where its outline changes, before its start or after its arrival.
#[test]
fn loads_at_the_ends_of_a_path_stay() {
    let load = |segment: usize| json!([{ "segments": [segment, segment], "radius": 0.5 }]);
    let late = |mut agent: Value| {
        agent["t_start"] = json!(5.0);
        agent
    };
    for nothing in [line(0.0), arc(1.0, 0.0), turn(0.0)] {
        for way in [line(1.0), turn(1.0)] {
            let end = if way == turn(1.0) { 0.0 } else { 1.0 };
            // Set down at the end: in the way of one that comes after the arrival.
            let ended = with_loads(agent(1, 0.1, [0.0; 3], &json!([way, nothing])), load(1));
            let passing = late(agent(2, 0.1, [end - 3.0, 0.4, 0.0], &json!([line(6.0)])));
            // Taken up at the start: in the way of one that passes before.
            let starts = late(with_loads(agent(1, 0.1, [0.0; 3], &json!([nothing, nothing, way])), load(3)));
            let before = agent(2, 0.1, [-1.0, 0.4, 0.0], &json!([line(6.0)]));
            for (agents, end) in [([ended, passing], 1), ([starts, before], 0)] {
                let scenario = read(&agents);
                let verdict = CheckReport::compute::<f64>(&scenario, false).unwrap();
                assert!(verdict.conflicts.iter().any(|conflict| conflict.depth > 0.199), "{verdict:?}");
                let answer = RegionsReport::compute::<f64>(&scenario, RegionOptions::default()).unwrap();
                let open = |region: &RegionEntry| region.i == 2 && [region.open_start, region.open_end][end];
                assert!(answer.regions.iter().any(open), "{:?}", answer.regions);
                assert_eq!(
                    CheckReport::compute::<Q16>(&scenario, false).unwrap().conflicts.len(),
                    verdict.conflicts.len()
                );
            }
        }
        // The load is set down before a way, however short: then it is not there.
        let gone = with_loads(agent(1, 0.1, [0.0; 3], &json!([line(1.0), nothing, line(0.001)])), load(1));
        let passing = late(agent(2, 0.1, [-2.0, 0.4, 0.0], &json!([line(6.0)])));
        assert!(CheckReport::compute::<f64>(&read(&[gone, passing]), false).unwrap().conflicts.is_empty());
    }
}

#[test]
fn wrong_loads_are_refused_by_name() {
    let path = json!([line(2.0), line(2.0)]);
    let refused = |loads: Value| {
        let agents = [with_loads(agent(1, 0.2, [0.0; 3], &path), loads)];
        Scenario::from_json(&json!({ "agents": agents }).to_string()).unwrap_err().to_string()
    };
    let load = |segments: Value| json!([{ "segments": segments, "radius": 0.3 }]);
    assert!(refused(load(json!([1, 3]))).contains("agent 1, load 1, segments: 3 where a segment from 1 to 2"));
    assert!(refused(load(json!([0, 1]))).contains("0 where"));
    assert!(refused(load(json!([2, 1]))).contains("after one another"));
    assert!(refused(load(json!([1]))).contains("1 numbers"));
    assert!(refused(json!([{ "segments": [1, 1] }])).contains("radius: missing"));
    let twice = json!([{ "segments": [1, 2], "radius": 0.3 }, { "segments": [2, 2], "radius": 0.3 }]);
    assert!(refused(twice).contains("load 2"));
}

#[test]
fn a_turn_in_place_takes_its_time_and_no_way() {
    let agents = [agent(1, 0.2, [0.0; 3], &json!([line(2.0), turn(FRAC_PI_2), line(3.0)]))];
    let scenario = read(&agents);
    let again = &Scenario::from_json(&scenario.to_json()).unwrap().agents[0];
    assert_eq!(again.path, scenario.agents[0].path);
    assert!((again.duration() - scenario.agents[0].duration()).abs() < 1e-12);
    let ramp =
        |length: f64, v: f64, a: f64| if length > v * v / a { length / v + v / a } else { 2.0 * (length / a).sqrt() };
    let duration = ramp(2.0, 1.0, 0.7) + ramp(FRAC_PI_2, 1.5, 2.0) + ramp(3.0, 1.0, 0.7);
    fn check<S: HostScalar>(scenario: &Scenario, duration: f64, slack: f64) {
        let fleet = Fleet::<S>::new(scenario).unwrap();
        let motion = fleet.motions()[0];
        let time = motion.time();
        assert!((time.hi.to_f64() - duration).abs() < slack, "{}: {:?} {duration}", S::NAME, time);
        let end = motion.position_at(time.hi);
        let off = (end.x.to_f64() - 2.0).hypot(end.y.to_f64() - 3.0);
        assert!(off < slack, "{}: {off}", S::NAME);
    }
    check::<f64>(&scenario, duration, 1e-8);
    check::<f32>(&scenario, duration, 1e-5);
    check::<Q20>(&scenario, duration, 1e-4);
    check::<Q16>(&scenario, duration, 1e-3);
    check::<Q12>(&scenario, duration, 2e-2);
    let mut bare = agents[0].clone();
    bare.as_object_mut().unwrap().remove("turn_v_max");
    let refused = Scenario::from_json(&json!({ "agents": [bare] }).to_string()).unwrap_err().to_string();
    assert!(refused.contains("turn_v_max: missing"), "{refused}");
}

/// Regions of paths with corners, in fixed point with corners in the path itself, are where the discs overlap.
#[test]
fn corners_are_passed_in_every_format() {
    let agents = [
        agent(1, 0.3, [-2.0, 0.0, 0.0], &json!([line(2.0), turn(2.0), line(2.0), turn(-1.0), arc(1.0, 1.5)])),
        agent(2, 0.25, [0.0, -2.0, FRAC_PI_2], &json!([turn(0.3), line(2.5), turn(-2.5), line(2.0), turn(PI)])),
    ];
    let scenario = read(&agents);
    assert!(compare(&scenario) > 100);
    let exact = RegionsReport::compute::<f64>(&scenario, RegionOptions::default()).unwrap().regions;
    fn check<S: HostScalar>(scenario: &Scenario, exact: &[pcr_planning::regions::RegionEntry], slack: f64) {
        let regions = RegionsReport::compute::<S>(scenario, RegionOptions::default()).unwrap().regions;
        assert_eq!(regions.len(), exact.len(), "{}", S::NAME);
        for (own, exact) in regions.iter().zip(exact) {
            let ends = [own.t[0] - exact.t[0], own.t[1] - exact.t[1], own.l[0] - exact.l[0], own.l[1] - exact.l[1]];
            assert!(ends.iter().all(|off| off.abs() < slack), "{}: {ends:?}", S::NAME);
        }
    }
    // Of outlines turns in place have a length, which makes paths longer and their digits fewer.
    check::<f32>(&scenario, &exact, 2e-4);
    check::<Q20>(&scenario, &exact, 1e-3);
    check::<Q16>(&scenario, &exact, 5e-3);
    check::<Q12>(&scenario, &exact, 5e-2);
}
