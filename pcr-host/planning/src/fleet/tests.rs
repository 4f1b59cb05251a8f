//! Tests of what a number format refuses, and that the conversion to it loses nothing else.

use super::*;
use pcr_core::{MismatchError, first_conflict};
use pcr_fixed::{Q12, Q16, Q20};
use pcr_formats::scenario::figure;
use serde_json::{Value, json};

/// A line of 2 m and a quarter turn.
fn agent() -> Value {
    json!({
        "id": 7, "radius": 0.5, "v_max": 1.0, "a_max": 0.5,
        "start": { "x": 0.0, "y": 0.0, "heading": 0.0 },
        "path": [{ "kind": "line", "length": 2.0 }, { "kind": "arc", "radius": 1.0, "sweep": -1.5 }],
    })
}

fn scenario(agent: Value) -> Scenario {
    Scenario::from_value(&json!({ "agents": [agent] })).unwrap()
}

/// What `f32` says about a value that `f64` takes.
#[track_caller]
fn refused(pointer: &str, value: f64, message: &str) {
    let mut agent = agent();
    *agent.pointer_mut(pointer).unwrap() = json!(value);
    let scenario = scenario(agent);
    assert!(Fleet::<f64>::new(&scenario).is_ok());
    assert_eq!(Fleet::<f32>::new(&scenario).unwrap_err().to_string(), message);
}

#[test]
fn what_overflows_f32_is_refused() {
    let limit = "is out of range; allowed is up to 1e6 in magnitude (f32)";
    refused("/start/x", 2e6, &format!("agent 7, start.x: 2e6 {limit}"));
    refused("/radius", 2e6, &format!("agent 7, radius: 2e6 {limit}"));
    refused("/v_max", 2e6, &format!("agent 7, v_max: 2e6 {limit}"));
    refused("/path/0/length", 2e6, &format!("agent 7, segment 1, length: 2e6 {limit}"));
    refused("/path/1/radius", 2e6, &format!("agent 7, segment 2, radius: 2e6 {limit}"));
    // The end of the path, and the end of the motion.
    refused("/start/x", 999_999.0, &format!("agent 7, segment 1, at its end: x {limit}"));
    refused("/v_max", 1e-6, "agent 7, the motion takes 3.500000000002e6 s; allowed is below 1e6 s (f32)");
}

#[test]
fn what_becomes_0_in_f32_is_refused() {
    let small = "is out of range; it is so small that it becomes 0 (f32)";
    refused("/radius", 1e-50, &format!("agent 7, radius: 1e-50 {small}"));
    refused("/path/0/length", 1e-50, &format!("agent 7, segment 1, length: 1e-50 {small}"));
    refused("/path/1/radius", 1e-50, &format!("agent 7, segment 2, radius: 1e-50 {small}"));
    refused("/start/x", -1e-50, &format!("agent 7, start.x: -1e-50 {small}"));
}

#[test]
fn a_heading_of_many_turns_keeps_its_digits_in_f32() {
    let mut turned = agent();
    turned["start"]["heading"] = json!(100.0 * TAU + 0.5);
    let fleet = Fleet::<f32>::new(&scenario(turned)).unwrap();
    let end = fleet.motions()[0].path().point_at(2.0);
    assert!((end.x - 2.0 * 0.5_f32.cos()).abs() < 1e-6 && (end.y - 2.0 * 0.5_f32.sin()).abs() < 1e-6);
}

#[test]
fn sources_count_segments_of_the_scenario() {
    let mut agent = agent();
    agent["path"] = json!([
        { "kind": "line", "length": 0 },
        { "kind": "arc", "radius": 1, "sweep": 13.0 },
        { "kind": "arc", "radius": 1, "sweep": 0 },
        { "kind": "line", "length": 1 },
    ]);
    let fleet = Fleet::<f64>::new(&scenario(agent.clone())).unwrap();
    let sources = (0..5).map(|segment| fleet.source(0, segment)).collect::<Vec<_>>();
    assert_eq!(sources, [Some(1), Some(1), Some(1), Some(3), None]);
    agent["path"] = json!([]);
    let fleet = Fleet::<f64>::new(&scenario(agent)).unwrap();
    assert_eq!(fleet.motions()[0].path().segments().len(), 1);
    assert_eq!(fleet.source(0, 0), None);
}

/// A stop-and-go schedule of many pieces, with decimal numbers as a file gives them, and its length.
fn stop_and_go(cycles: usize) -> (Vec<Value>, f64) {
    let (mut pieces, mut length) = (Vec::new(), 0.0);
    for cycle in 0..cycles {
        let (up, cruise) = (0.3 + 0.1 * (cycle % 7) as f64, 0.7 + 0.01 * (cycle % 13) as f64);
        let phases = [(up, 0.3), (cruise, 0.0), (2.0 * up, -0.15), (0.9, 0.0)];
        pieces.extend(phases.map(|(duration, accel)| json!({ "duration": duration, "accel": accel })));
        length += 0.3 * up * (0.5 * up + cruise + up);
    }
    (pieces, length)
}

fn schedule<S: HostScalar>(cycles: usize) -> (Vec<Phase<S>>, f64, f64) {
    let (pieces, length) = stop_and_go(cycles);
    let mut agent = agent();
    agent["path"] = json!([{ "kind": "line", "length": length }]);
    agent["profile"] = json!({ "v0": 0.0, "pieces": pieces });
    let scenario = scenario(agent);
    let fleet = Fleet::<S>::new(&scenario).unwrap();
    (fleet.motions()[0].profile().phases().to_vec(), length, scenario.agents[0].duration())
}

#[track_caller]
fn stops_are_stops<S: HostScalar>(phases: &[Phase<S>]) {
    for stop in phases.iter().skip(3).step_by(4) {
        assert!(stop.length().lo == stop.length().hi, "moves while it waits: {stop:?}");
    }
}

#[test]
fn long_profiles_end_at_the_end_of_the_path_and_stand_at_their_stops() {
    let (phases, length, duration) = schedule::<f64>(2500);
    stops_are_stops(&phases);
    let last = phases.last().unwrap();
    assert!((last.length().hi - length).abs() <= f64::slack(length));
    /// Sum of 10 000 roundings of times of some 10⁴ s, and of the length that is made up for in one piece.
    const TIME: f64 = 1e-8;
    assert!((last.time().hi - duration).abs() < TIME);

    let (phases, length, duration) = schedule::<f32>(25);
    stops_are_stops(&phases);
    let last = phases.last().unwrap();
    assert!((last.length().hi.to_f64() - length).abs() <= f32::slack(length as f32).to_f64());
    /// The same for 100 roundings in `f32` of some 100 s.
    const TIME_F32: f64 = 1e-3;
    assert!((last.time().hi.to_f64() - duration).abs() < TIME_F32);
}

#[test]
fn every_piece_reaches_the_speed_it_aims_at() {
    let (phases, ..) = schedule::<f64>(50);
    for (k, phase) in phases.iter().enumerate() {
        let reached = phase.speed_at(phase.time().hi);
        let aim = if k % 4 < 2 { 0.3 * (0.3 + 0.1 * (k / 4 % 7) as f64) } else { 0.0 };
        // The path is scaled by 10⁻¹⁵ or so, and the durations of late phases are differences of times.
        assert!((reached - aim).abs() < 1e-12, "phase {k}: {reached}, aim {aim}");
    }
}

#[test]
fn a_pair_of_too_many_pieces_is_an_error_and_does_not_grow_for_ever() {
    // Two agents that turn on the spot, 257 times: each turn of one meets each of the other, 66049 pieces.
    let spin = |id: u64| {
        let mut agent = agent();
        agent["id"] = json!(id);
        agent["path"] = json!([{ "kind": "arc", "radius": 0.1, "sweep": 257.0 * TAU }]);
        agent
    };
    let mut still = agent();
    still["path"] = json!([]);
    let scenario = Scenario::from_value(&json!({ "agents": [still, spin(1), spin(2)] })).unwrap();
    let fleet = Fleet::<f64>::new(&scenario).unwrap();
    assert_eq!(build_ecm(&fleet.motions()).unwrap_err(), CapacityError::Pair([1, 2]));
}

#[test]
fn what_is_far_below_a_fixed_point_format_is_refused() {
    for value in [-1e9, 1e9, -32768.0] {
        assert!(number::<pcr_fixed::Q16>("start.x", value).is_err(), "{value}");
    }
}

/// Two lines of 4 m that cross in their middles, the second in this heading.
fn crossing(heading: f64) -> Scenario {
    let agent = |id: u64, x: f64, y: f64, heading: f64| {
        json!({
            "id": id, "radius": 0.3, "v_max": 1.0, "a_max": 0.5,
            "start": { "x": x, "y": y, "heading": heading },
            "path": [{ "kind": "line", "length": 4.0 }],
        })
    };
    Scenario::from_value(&json!({ "agents": [agent(1, -2.0, 0.0, 0.0), agent(2, 0.0, -2.0, heading)] })).unwrap()
}

/// The number of conflicts and the verdict of the checker, or why there is neither.
type Answers = Result<(usize, &'static str), String>;

fn answers<S: HostScalar>(scenario: &Scenario) -> Answers {
    let found = crate::check::CheckReport::compute::<S>(scenario, false).map_err(|failure| failure.to_string())?;
    let proof = crate::certify::MotionCertificate::prove::<S>(scenario).map_err(|refused| refused.to_string())?;
    // The checker takes as many turns.
    assert_eq!(proof.error, None);
    Ok((found.conflicts.len(), proof.verdict))
}

#[test]
fn a_heading_of_too_many_turns_is_refused_in_every_format_alike() {
    use pcr_fixed::{Q12, Q16, Q20};
    fn everywhere(heading: f64) -> Vec<Answers> {
        let scenario = crossing(heading);
        let all: [fn(&Scenario) -> Answers; 5] =
            [answers::<f64>, answers::<f32>, answers::<Q12>, answers::<Q16>, answers::<Q20>];
        all.map(|answers| answers(&scenario)).to_vec()
    }
    // π/2 and turns, up to the largest.
    for turns in [0.0, 1.0, -900.0, 2_670_176.0, -2_670_176.0] {
        assert_eq!(everywhere(0.5 * PI + TAU * turns), vec![Ok((1, "contact")); 5], "{turns}");
    }
    // π/2 as well, which fixed point once took for 0, and found free.
    for heading in [6_999_999_997.529_028, -1e10, ANGLE_LIMIT.next_up()] {
        for (refused, format) in everywhere(heading).into_iter().zip(["f64", "f32", "q12", "q16", "q20"]) {
            let range = "is out of range; allowed is up to 1.6777216e7 in magnitude";
            assert_eq!(refused, Err(format!("agent 2, start.heading: {} {range} ({format})", figure(heading))));
        }
    }
}

#[test]
fn headings_along_a_path_are_refused_with_their_own_limit() {
    let spin = |turns: f64| {
        let mut agent = agent();
        agent["path"] = json!([{ "kind": "arc", "radius": 0.1, "sweep": turns * TAU }]);
        scenario(agent)
    };
    assert!(Fleet::<f32>::new(&spin(160.0)).is_ok() && Fleet::<pcr_fixed::Q16>::new(&spin(170.0)).is_ok());
    let refused = Fleet::<f32>::new(&spin(170.0)).unwrap_err().to_string();
    let limit = "heading is out of range; allowed is up to 1024 in magnitude, with all turns of the path (f32)";
    assert_eq!(refused, format!("agent 7, segment 1, at its end: {limit}"));
}

#[test]
fn the_limits_of_headings_are_those_of_the_core() {
    fn of_core<S: HostScalar>(heading: impl Fn(f64) -> S::Angle) {
        let stands = |heading| Segment::standing(Pose { position: Point::new(S::ZERO, S::ZERO), heading }).map(|_| ());
        assert_eq!(stands(heading(S::HEADING_LIMIT)), Ok(()), "{}", S::NAME);
        assert_eq!(stands(heading(1.001 * S::HEADING_LIMIT)), Err(InvalidInput::OutOfRange("heading")), "{}", S::NAME);
    }
    of_core::<f64>(Radians);
    of_core::<f32>(|heading| Radians(heading as f32));
}

/// Two agents that pass one another on lanes of 20 m, at 1 m/s.
fn lanes<S: HostScalar>(apart: f64) -> Fleet<S> {
    let lane = |id: u64, x: f64, y: f64, heading: f64| {
        json!({
            "id": id, "radius": 0.25, "start": { "x": x, "y": y, "heading": heading },
            "path": [{ "kind": "line", "length": 20.0 }], "profile": { "v0": 1.0, "pieces": [{ "duration": 20.0, "accel": 0.0 }] },
        })
    };
    let agents = [lane(1, 0.0, 0.0, 0.0), lane(2, 20.0, apart, PI)];
    Fleet::new(&Scenario::from_value(&json!({ "agents": agents })).expect("a scenario")).expect("it fits")
}

/// A table holds for other profiles of its agents as long as their lag is not larger than what its regions were computed for. It said that
/// agents were free of one another whose regions it had not.
fn holds_for_its_lag<S: HostScalar>(other: &Profile<S, 3>, may_wait: bool) {
    let fleet = lanes::<S>(0.4);
    let mut motions = fleet.motions();
    let table = build_ecm(&motions).expect("memory");
    let refused = Some(MismatchError::OtherFleet);
    let asked = |table: &HostEcm<S>, fleet: &[Motion<'_, S>]| {
        [
            table.row(fleet, 0).err(),
            table.pair(fleet, 1, 0).err(),
            table.regions(fleet).err(),
            table.regions_once(fleet).err(),
        ]
    };
    assert_eq!(asked(&table, &motions), [None; 4], "{}", S::NAME);
    let with = |motion: Motion<'_, S>| motion.with_profile(other.as_profile(), S::ZERO).map(|other| other.lag());
    let larger = with(motions[0]).expect("its path") > motions[0].lag();
    assert!(larger, "{}", S::NAME);
    for agent in 0..2 {
        let mut changed = motions.clone();
        changed[agent] = motions[agent].with_profile(other.as_profile(), S::ZERO).expect("its path");
        assert_eq!(asked(&table, &changed), [refused; 4], "{}: agent {agent}", S::NAME);
        // The tolerance of a search for conflicts counts lags, which is enough for contacts of any depth above it.
        let regions = table.row(&motions, agent).expect("the table of the fleet");
        let met = first_conflict(&changed[agent], regions, changed[agent].time());
        assert!(met.is_ok(), "{}: agent {agent}", S::NAME);
        // Given to the table, it has its regions, and the motion before may come back.
        let mut again = table.clone();
        let late = changed[agent];
        let mut replaced = motions.clone();
        again.replace(&mut replaced, agent, late).expect("memory");
        assert_eq!(asked(&again, &replaced), [None; 4], "{}", S::NAME);
        let own = motions[agent].profile();
        replaced[agent] = late.with_profile(own, S::ZERO).expect("its path");
        assert_eq!(asked(&again, &replaced), [None; 4], "{}: a smaller lag", S::NAME);
    }
    // What changes no lag may change.
    motions[0] =
        motions[0].delayed(S::from_f64(9.0)).expect("a start").with_margin(S::from_f64(0.1)).expect("a margin");
    assert_eq!(asked(&table, &motions), [None; 4], "{}", S::NAME);
    // A table that is made for long motions.
    let longest = other.as_profile().duration();
    let prepared: Vec<_> = motions.iter().map(|motion| motion.with_longest(longest).expect("a duration")).collect();
    let table = build_ecm(&prepared).expect("memory");
    let late: Vec<_> =
        prepared.iter().map(|motion| motion.with_profile(other.as_profile(), S::ZERO).expect("its path")).collect();
    assert_eq!(asked(&table, &late), if may_wait { [None; 4] } else { [refused; 4] }, "{}", S::NAME);
}

#[test]
fn a_table_is_not_that_of_motions_with_a_longer_wait() {
    let waits = |seconds: f64| (seconds, 0.0);
    let f64s = Profile::from_pieces(0.0, [waits(300.0), (1.0, 1.0), (19.5, 0.0)]).expect("a profile");
    holds_for_its_lag::<f64>(&f64s, true);
    let f32s = Profile::from_pieces(0.0, [(20_000.0, 0.0), (1.0, 1.0), (19.5, 0.0)]).expect("a profile");
    holds_for_its_lag::<f32>(&f32s, true);
    // With it they touch: the lag is 9 mm, and they pass at 8 mm.
    let fleet = lanes::<f32>(0.508);
    let late: Vec<_> =
        fleet.motions().iter().map(|motion| motion.with_profile(f32s.as_profile(), 0.0).expect("its path")).collect();
    let before = build_ecm(&fleet.motions()).expect("memory");
    assert!(before.is_empty() && before.row(&late, 0).is_err());
    assert_eq!(build_ecm(&late).expect("memory").len(), 1);
}

#[test]
fn a_table_is_not_that_of_motions_that_miss_the_end_by_more() {
    fn misses<S: HostScalar>(by: f64) {
        let [one, duration, none] = [1.0, 20.0 + by, 0.0].map(S::from_f64);
        holds_for_its_lag::<S>(&Profile::from_pieces(one, [(duration, none)]).expect("a profile"), false);
    }
    misses::<f64>(1.5e-5);
    misses::<Q12>(2.0 / 4096.0);
    misses::<Q16>(1.0 / 65_536.0);
    misses::<Q20>(8.0 / 1_048_576.0);
}

#[test]
fn passing_orders_are_not_those_of_motions_with_another_lag() {
    let fleet = lanes::<f64>(0.3);
    let mut motions = fleet.motions();
    let orders = build_orders(&motions).expect("memory");
    assert_eq!(orders.row(&motions, 0).map(drop), Ok(()));
    let longer = Profile::<f64, 1>::from_pieces(1.0, [(20.000_015, 0.0)]).expect("a profile");
    motions[1] = motions[1].with_profile(longer.as_profile(), 0.0).expect("its path");
    assert_eq!(orders.row(&motions, 0).map(drop), Err(MismatchError::OtherFleet));
}

/// Where the gear changes the direction of travel turns by half a turn, in the format as in the file: it was told as if the path went on.
#[test]
fn gears_and_turns_are_not_rounded_away() {
    let line = |length: f64, gear: &str| json!({ "kind": "line", "length": length, "gear": gear });
    let turn = json!({ "kind": "turn", "sweep": 1.0 });
    let path = [line(2.0, "forward"), line(1.0, "reverse"), turn, line(3.0, "reverse"), line(2.0, "forward")];
    let limits = json!({ "turn_v_max": 1.0, "turn_a_max": 1.0, "path": path });
    let mut agent = agent();
    agent.as_object_mut().unwrap().extend(limits.as_object().unwrap().clone());
    let scenario = Scenario::from_value(&json!({ "version": 2, "agents": [agent] })).unwrap();
    assert_eq!(rounded::<f32>(&scenario), Ok(None));
    assert_eq!(rounded::<Q20>(&scenario), Ok(None));
    assert_eq!(rounded::<Q16>(&scenario), Ok(None));
}
