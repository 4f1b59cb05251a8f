//! Messages that cannot be used: each is told with its reason, and nothing is claimed about its robot.

mod common;

use common::{NOW, Timed, at, authority, pair, path, watch};
use pcr_ros2::messages::{FleetLocation, FleetRobotState, FleetState, PathMessage, Quaternion};
use pcr_ros2::report::{AuthorityReport, PairReport};
use pcr_ros2::{Answer, Config, Watch};

const DISCS: [&str; 3] = [r#""radius": 0.3"#; 3];
/// Three lanes that keep apart.
const LANES: [[Timed; 2]; 3] = [
    [(0.0, 0.0, 0.0, 0.0), (4.0, 4.0, 0.0, 0.0)],
    [(0.0, 0.0, 2.0, 0.0), (4.0, 4.0, 2.0, 0.0)],
    [(0.0, 0.0, 4.0, 0.0), (4.0, 4.0, 4.0, 0.0)],
];

/// All three paths, and after them `last` of robot 1.
fn after(last: &PathMessage) -> Answer {
    let mut watch = watch(&DISCS);
    LANES.iter().enumerate().for_each(|(robot, poses)| watch.take(robot, &path(poses)));
    let before = watch.answer(NOW);
    assert!(before.conflicts.pairs.iter().all(|pair| pair.state == PairReport::CLEAR), "{before:?}");
    assert!(before.conflicts.refusals.is_empty());
    assert!(before.authorities.robots.iter().all(|authority| authority.state == AuthorityReport::FREE));
    watch.take(1, last);
    watch.answer(NOW)
}

/// Checks that the last path of robot 1 was refused for this reason, and that the others are still told.
fn assert_refused(answer: &Answer, reason: &str) {
    let [refusal] = &answer.conflicts.refusals[..] else { panic!("{reason}: {:?}", answer.conflicts.refusals) };
    assert_eq!((refusal.topic.as_str(), refusal.robot.as_str()), ("/r1/plan", "1"));
    assert_eq!(refusal.reason, reason);
    assert_eq!(answer.conflicts.pairs.len(), 3);
    assert_eq!(pair(answer, "0", "2").state, PairReport::CLEAR);
    for found in [pair(answer, "0", "1"), pair(answer, "1", "2")] {
        assert_eq!((found.state, found.reason.as_str()), (PairReport::UNKNOWN, format!("1: {reason}").as_str()));
    }
    for found in &answer.authorities.robots {
        assert_eq!((found.state, found.length), (AuthorityReport::UNKNOWN, 0.0));
        assert_eq!(found.reason, format!("1: {reason}"));
    }
}

/// Robot 1's path with a change.
fn changed(change: impl Fn(&mut PathMessage)) -> Answer {
    let mut message = path(&LANES[1]);
    change(&mut message);
    after(&message)
}

#[test]
fn each_with_its_reason() {
    assert_refused(&changed(|path| path.poses.clear()), "the path has no poses");
    assert_refused(
        &changed(|path| path.poses[1].header.stamp = path.poses[0].header.stamp),
        "pose 1: it is not later than the one before",
    );
    assert_refused(&changed(|path| path.poses.swap(0, 1)), "pose 1: it is not later than the one before");
    assert_refused(
        &changed(|path| path.poses[0].header.stamp.nanosec = 1_000_000_000),
        "a time has nanoseconds that are not below 1e9",
    );
    assert_refused(
        &changed(|path| path.header.stamp.nanosec = u32::MAX),
        "a time has nanoseconds that are not below 1e9",
    );
    for bad in [f64::NAN, f64::INFINITY] {
        let reason = "pose 1: a number is not finite";
        assert_refused(&changed(|path| path.poses[1].pose.position.x = bad), reason);
        assert_refused(&changed(|path| path.poses[1].pose.position.y = bad), reason);
        assert_refused(&changed(|path| path.poses[1].pose.position.z = bad), reason);
        assert_refused(&changed(|path| path.poses[1].pose.orientation.w = bad), reason);
    }
    let odom = "the path is in frame \"odom\", not \"map\"";
    assert_refused(&changed(|path| path.header.frame_id = "odom".to_owned()), odom);
    assert_refused(&changed(|path| path.poses[1].header.frame_id = "odom".to_owned()), odom);
    assert_refused(&changed(|path| path.header.frame_id.clear()), "the path is in frame \"\", not \"map\"");
    for (x, y, z, w) in [(1.0, 0.0, 0.0, 0.0), (0.0, 0.01, 0.0, 0.99995), (0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.1)] {
        assert_refused(
            &changed(|path| path.poses[0].pose.orientation = Quaternion { x, y, z, w }),
            "pose 0: its orientation is not a rotation about z",
        );
    }
    assert_refused(&changed(|path| path.header.stamp = at(-2.5)), "the path is more than 2 s old");
    assert_refused(&changed(|path| path.header.stamp = at(2.5)), "the path is of a time more than 2 s from now");
    assert_refused(&changed(|path| path.poses[1].pose.position.x = 1e300), "length is out of range");
}

#[test]
fn half_turns_on_the_way_have_no_side() {
    let outline = r#""outline": [[-0.5, -0.3], [0.5, -0.3], [0.5, 0.3], [-0.5, 0.3]]"#;
    let mut watch = watch(&[outline, outline]);
    watch.take(0, &path(&[(0.0, 0.0, 0.0, 0.0), (4.0, 4.0, 0.0, std::f64::consts::PI)]));
    watch.take(1, &path(&[(0.0, 0.0, 9.0, 0.0), (4.0, 0.0, 9.0, std::f64::consts::PI)]));
    let answer = watch.answer(NOW);
    let reason = "pose 1: it is not told to which side the robot makes half a turn";
    assert_eq!(answer.conflicts.refusals.len(), 2);
    assert!(answer.conflicts.refusals.iter().all(|refusal| refusal.reason == reason), "{answer:?}");
    assert_eq!(pair(&answer, "0", "1").reason, format!("0: {reason}; 1: {reason}"));
}

#[test]
fn nobody_is_told_before_his_path() {
    let mut watch = watch(&DISCS[..2]);
    watch.take(0, &path(&LANES[0]));
    let answer = watch.answer(NOW);
    assert_eq!(pair(&answer, "0", "1").reason, "1: no path has come yet");
    assert_eq!(authority(&answer, "0").reason, "1: no path has come yet");
    watch.take_unreadable(0, "too short".to_owned());
    let answer = watch.answer(NOW);
    assert_eq!(answer.conflicts.refusals[0].reason, "the message cannot be read: too short");
}

#[test]
fn a_path_grows_old() {
    let mut watch = watch(&DISCS[..2]);
    LANES[..2].iter().enumerate().for_each(|(robot, poses)| watch.take(robot, &path(poses)));
    assert_eq!(pair(&watch.answer(at(2.0)), "0", "1").state, PairReport::CLEAR);
    assert_eq!(pair(&watch.answer(at(2.001)), "0", "1").state, PairReport::UNKNOWN);
}

fn fleet(robots: &[(&str, f32, &str)]) -> FleetState {
    let location = |time: f64, x: f32, y: f32, level: &str| FleetLocation {
        t: at(time),
        x,
        y,
        level_name: level.to_owned(),
        ..Default::default()
    };
    let state = |&(name, y, level): &(&str, f32, &str)| FleetRobotState {
        name: name.to_owned(),
        location: location(0.0, 0.0, y, level),
        path: vec![location(4.0, 4.0, y, level)],
        ..Default::default()
    };
    FleetState { name: "tiny".to_owned(), robots: robots.iter().map(state).collect() }
}

#[test]
fn fleets_have_the_robots_that_are_configured() {
    let robot =
        |name: &str| format!(r#"{{ "name": "{name}", "fleet": "tiny", "level": "L1", "radius": 0.3, "margin": 0 }}"#);
    let config = format!(
        r#"{{ "frame": "map", "max_age": 2, "fleet_states": "/fleet_states", "robots": [{}, {}] }}"#,
        robot("a"),
        robot("b")
    );
    let config = Config::from_json(&config).expect("a configuration");
    let told = |states: &[FleetState]| {
        let mut watch = Watch::new(config.clone());
        states.iter().for_each(|state| watch.take_fleet(state));
        let answer = watch.answer(NOW);
        let reasons: Vec<String> =
            answer.conflicts.refusals.iter().map(|refusal| format!("{}: {}", refusal.robot, refusal.reason)).collect();
        assert!(answer.conflicts.refusals.iter().all(|refusal| refusal.topic == "/fleet_states"));
        let free = answer.authorities.robots.iter().all(|authority| authority.state == AuthorityReport::FREE);
        (pair(&answer, "a", "b").state, free, reasons.join("; "))
    };
    let (unknown, clear) = (PairReport::UNKNOWN, PairReport::CLEAR);
    let both = fleet(&[("a", 0.0, "L1"), ("b", 2.0, "L1")]);
    assert_eq!(told(std::slice::from_ref(&both)), (clear, true, String::new()));
    let near = fleet(&[("a", 0.0, "L1"), ("b", 0.5, "L1")]);
    assert_eq!(told(&[near]), (PairReport::CONFLICT, false, String::new()));
    let missing = "b: the state of its fleet does not have the robot".to_owned();
    assert_eq!(told(&[both.clone(), fleet(&[("a", 0.0, "L1")])]), (unknown, false, missing));
    let twice = fleet(&[("a", 0.0, "L1"), ("b", 2.0, "L1"), ("b", 3.0, "L1")]);
    assert_eq!(told(&[twice]), (unknown, false, "b: the state of its fleet has the robot more than once".to_owned()));
    let above = fleet(&[("a", 0.0, "L1"), ("b", 2.0, "L2")]);
    assert_eq!(told(&[above]), (unknown, false, "b: the path is in frame \"L2\", not \"L1\"".to_owned()));
    // Pairs of the others are known, but nobody may drive where a robot may be that nobody has told about.
    let stranger = fleet(&[("a", 0.0, "L1"), ("b", 2.0, "L1"), ("c", 4.0, "L1")]);
    assert_eq!(told(&[stranger]), (clear, false, ": robot \"c\" of fleet \"tiny\" is not configured".to_owned()));
    let other = FleetState { name: "large".to_owned(), ..both.clone() };
    let (state, free, reasons) = told(&[both.clone(), other.clone()]);
    assert_eq!((state, free), (clear, false));
    assert!(reasons.contains("robot \"a\" of fleet \"large\" is not configured"), "{reasons}");
    let gone = FleetState { robots: Vec::new(), ..other.clone() };
    assert_eq!(told(&[both, other, gone]), (clear, true, String::new()));
}

/// One that was not read, and so not checked.
#[test]
fn a_robot_of_no_size_is_unknown() {
    let config = r#"{ "frame": "map", "max_age": 2, "robots": [
        { "name": "a", "path": "/a", "radius": 0.3, "margin": 0 }, { "name": "b", "path": "/b", "radius": 0.3, "margin": 0 }] }"#;
    let mut config = Config::from_json(config).expect("a configuration");
    config.robots[1].radius = None;
    let mut watch = Watch::new(config);
    (0..2).for_each(|robot| watch.take(robot, &path(&LANES[robot])));
    let answer = watch.answer(NOW);
    assert_eq!(pair(&answer, "a", "b").state, PairReport::UNKNOWN, "{answer:?}");
    assert!(answer.authorities.robots.iter().all(|authority| authority.state == AuthorityReport::UNKNOWN));
}

#[test]
fn configurations() {
    let robots = r#""robots": [{ "name": "a", "path": "/a", "radius": 0.3, "margin": 0 }, { "name": "b", "path": "/b", "radius": 0.3, "margin": 0 }]"#;
    let good = format!(r#"{{ "frame": "map", "max_age": 2, {robots} }}"#);
    assert!(Config::from_json(&good).is_ok());
    for (from, to, problem) in [
        (r#""max_age": 2"#, r#""max_age": 0"#, "the configuration: \"max_age\" is not a number in range"),
        ("\"map\"", "\"\"", "the configuration: \"frame\" is empty"),
        (r#""name": "a""#, r#""name": """#, "robot \"\": \"name\" is empty"),
        ("\"/b\"", "\"/a\"", "two robots have \"/a\""),
        (
            "\"radius\": 0.3, \"margin\": 0 }]",
            "\"radius\": -0.3, \"margin\": 0 }]",
            "robot \"b\": \"radius\" is not a number in range",
        ),
        ("\"radius\": 0.3, \"margin\": 0 }]", "\"margin\": 0 }]", "robot \"b\" needs either \"radius\" or \"outline\""),
        (
            "\"radius\": 0.3, \"margin\": 0 }]",
            "\"outline\": [[0, 0], [0, 1], [1, 0]], \"margin\": 0 }]",
            "robot \"b\": its outline is not valid",
        ),
        ("\"path\": \"/b\",", "", "robot \"b\" needs either \"path\""),
        ("\"path\": \"/b\"", "\"fleet\": \"f\", \"level\": \"L1\"", "robot \"b\" needs either \"path\""),
        (
            "\"margin\": 0 }]",
            "\"margin\": 0, \"pace\": { \"speed\": 0, \"turn\": 1 } }]",
            "robot \"b\": \"speed\" is not a number in range",
        ),
        (", \"margin\": 0 }]", " }]", "missing field `margin`"),
        ("\"margin\": 0 }]", "\"margin\": 0, \"colour\": 1 }]", "unknown field `colour`"),
        ("\"margin\": 0 }]", "\"margin\": 0, \"route_server\": \"/b/edges\" }]", "need one another"),
        ("\"margin\": 0 }]", "\"margin\": 0, \"route_server\": \"\" }]", "need one another"),
        ("\"max_age\": 2", "\"max_age\": 2, \"route_graph\": { \"file\": \"g\", \"stands\": 1 }", "need one another"),
    ] {
        assert!(good.contains(from), "{from}");
        let error = Config::from_json(&good.replacen(from, to, 1)).expect_err(problem).to_string();
        assert!(error.contains(problem), "{error}");
    }
    let with_graph = |stands: &str, server: &str| {
        let graph = format!(r#""max_age": 2, "route_graph": {{ "file": "g", "stands": {stands} }}"#);
        let server = format!(r#""margin": 0, "route_server": "{server}" }}]"#);
        Config::from_json(&good.replacen(r#""max_age": 2"#, &graph, 1).replacen(r#""margin": 0 }]"#, &server, 1))
    };
    assert_eq!(with_graph("0", "/b/edges").expect("a graph").route_graph.expect("it").stands, 0.0);
    let problem = with_graph("-1", "/b/edges").expect_err("no time").to_string();
    assert_eq!(problem, "\"route_graph\": \"stands\" is not a number in range");
    assert_eq!(with_graph("1", "").expect_err("no name").to_string(), "robot \"b\": \"route_server\" is empty");
    let both = good.replace(r#""margin": 0 }"#, r#""margin": 0, "route_server": "/edges" }"#);
    let both = both.replacen(r#""max_age": 2"#, r#""max_age": 2, "route_graph": { "file": "g", "stands": 1 }"#, 1);
    assert_eq!(Config::from_json(&both).expect_err("one server").to_string(), "two robots have \"/edges\"");
    let readme = include_str!("../README.md");
    let examples: Vec<&str> = readme.split("```json\n").skip(1).filter_map(|text| text.split("```").next()).collect();
    let robots = examples.iter().map(|text| Config::from_json(text).expect("an example of the README").robots.len());
    assert_eq!(robots.collect::<Vec<_>>(), [3, 2]);
    let one = r#"{ "frame": "map", "max_age": 2, "robots": [] }"#;
    assert_eq!(Config::from_json(one).expect_err("none").to_string(), "there are not two robots");
}
