//! Conflicts and authorities, beside what the paths themselves say: closed forms of simple ones, and samples of random ones.

mod common;

use common::{NOW, Random, Timed, at, authority, pair, path, watch};
use pcr_ros2::messages::{Marker, Time};
use pcr_ros2::report::{AuthorityReport, PairReport};
use pcr_ros2::{Answer, Config, Watch};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn seconds(time: Time) -> f64 {
    time.since(NOW)
}

fn assert_near(a: f64, b: f64, most: f64) {
    assert!((a - b).abs() <= most, "{a} is not {b}");
}

#[test]
fn a_crossing_of_discs() {
    let mut watch = watch(&[r#""radius": 0.3"#, r#""radius": 0.5"#]);
    // One metre a second; they are 3 m and 2 m from the crossing, and one sets off a second later.
    watch.take(0, &path(&[(1.0, -3.0, 0.0, 0.0), (7.0, 3.0, 0.0, 0.0)]));
    watch.take(1, &path(&[(2.0, 0.0, -2.5, FRAC_PI_2), (7.0, 0.0, 2.5, FRAC_PI_2)]));
    let answer = watch.answer(NOW);
    assert_eq!(pair(&answer, "0", "1").state, PairReport::CONFLICT);
    let [found] = &answer.conflicts.conflicts[..] else { panic!("{answer:?}") };
    assert_eq!(
        (found.robot_a.as_str(), found.robot_b.as_str(), found.lasting, found.touching),
        ("0", "1", false, false)
    );
    // At t, one is at t - 4 and the other one at t - 4.5, of their ways: (t - 4)² + (t - 4.5)² is 0.8² at begin and end.
    let half = (2.0 * 0.64_f64 - 0.25).sqrt() / 2.0;
    for (time, length_a, length_b, expected) in [
        (found.begin, found.begin_length_a, found.begin_length_b, 4.25 - half),
        (found.end, found.end_length_a, found.end_length_b, 4.25 + half),
    ] {
        assert_near(seconds(time), expected, 1e-6);
        assert_near(length_a, expected - 1.0, 1e-6);
        assert_near(length_b, expected - 2.0, 1e-6);
    }
    assert_near(seconds(found.deepest), 4.25, 1e-6);
    assert_near(found.depth, 0.8 - 0.125_f64.sqrt(), 1e-6);
    assert_near(found.pose_a.position.x, 0.25, 1e-6);
    assert_near(found.pose_b.position.y, -0.25, 1e-6);
    assert_near(found.pose_b.orientation.z, (PI / 4.0).sin(), 1e-12);
    // The one that gets there first goes first, and the other one waits where their sum of radii is left.
    let [first, second] = ["0", "1"].map(|robot| authority(&answer, robot));
    assert_eq!((first.state, first.length, first.waits_for.as_str()), (AuthorityReport::FREE, 6.0, ""));
    assert_near(seconds(first.time), 7.0, 1e-6);
    assert_eq!((second.state, second.waits_for.as_str()), (AuthorityReport::LIMITED, "0"));
    assert_near(second.length, 2.5 - 0.8, 1e-6);
    assert_near(seconds(second.time), 2.0 + 1.7, 1e-6);
    assert_near(second.pose.position.y, -0.8, 1e-6);
    assert_eq!(answer.authorities.stuck, "");
    // Both outlines are drawn where they overlap most, after what was there is deleted.
    let [clear, a, b] = &answer.markers.markers[..] else { panic!("{:?}", answer.markers) };
    assert_eq!((clear.action, a.kind, b.kind), (Marker::DELETE_ALL, Marker::LINE_STRIP, Marker::LINE_STRIP));
    assert_eq!((a.pose, b.pose), (found.pose_a, found.pose_b));
    assert!(a.points.iter().all(|point| (point.x.hypot(point.y) - 0.3).abs() < 1e-9));
    assert_eq!((a.id, b.id, a.points.first(), b.points.len()), (0, 1, a.points.last(), 33));
}

#[test]
fn conflicts_are_from_now_on() {
    let mut watch = watch(&[r#""radius": 0.3"#, r#""radius": 0.3"#]);
    watch.take(0, &path(&[(-9.0, -2.0, 0.0, 0.0), (-5.0, 2.0, 0.0, 0.0)]));
    watch.take(1, &path(&[(-9.0, 0.0, -2.0, 0.0), (-5.0, 0.0, 2.0, 0.0)]));
    // They have met, and stand at their ends now.
    assert_eq!(pair(&watch.answer(NOW), "0", "1").state, PairReport::CLEAR);
    // Both end at the same place, and stay.
    watch.take(1, &path(&[(0.0, 2.0, -2.0, 0.0), (4.0, 2.0, 0.0, 0.0)]));
    let answer = watch.answer(NOW);
    let [found] = &answer.conflicts.conflicts[..] else { panic!("{answer:?}") };
    assert!(found.lasting);
    // At 0.5 m/s up to 0.6 m before it.
    assert_near(seconds(found.begin), 2.8, 1e-6);
    assert_eq!(found.end, at(4.0));
}

#[test]
fn who_stands_in_the_way_goes_first() {
    let mut watch = watch(&[r#""radius": 0.3"#, r#""radius": 0.3"#]);
    watch.take(0, &path(&[(0.0, -2.0, 0.0, 0.0), (2.0, 2.0, 0.0, 0.0)]));
    watch.take(1, &path(&[(9.0, 0.0, 0.0, FRAC_PI_2), (11.0, 0.0, 2.0, FRAC_PI_2)]));
    let answer = watch.answer(NOW);
    let [first, second] = ["0", "1"].map(|robot| authority(&answer, robot));
    assert_eq!(
        (first.state, first.waits_for.as_str(), second.state),
        (AuthorityReport::LIMITED, "1", AuthorityReport::FREE)
    );
    assert_near(first.length, 1.4, 1e-6);
    // Head on, each stands where the other one goes to.
    watch.take(0, &path(&[(0.0, -2.0, 0.0, 0.0), (4.0, 2.0, 0.0, 0.0)]));
    watch.take(1, &path(&[(0.0, 2.0, 0.0, 0.0), (4.0, -2.0, 0.0, 0.0)]));
    let answer = watch.answer(NOW);
    for (robot, other) in [("0", "1"), ("1", "0")] {
        let found = authority(&answer, robot);
        assert_eq!((found.state, found.waits_for.as_str(), found.length), (AuthorityReport::NONE, other, 0.0));
    }
    assert!(["0, 1", "1, 0"].contains(&answer.authorities.stuck.as_str()), "{}", answer.authorities.stuck);
}

#[test]
fn an_authority_that_ends_in_a_turn() {
    // A long robot turns to the left, after a disc has passed at its side.
    let mut watch = watch(&[r#""outline": [[-0.2, -0.1], [1, -0.1], [1, 0.1], [-0.2, 0.1]]"#, r#""radius": 0.3"#]);
    watch.take(0, &path(&[(5.0, 0.0, 0.0, 0.0), (7.0, 0.0, 0.0, FRAC_PI_2), (9.0, 0.0, 2.0, FRAC_PI_2)]));
    watch.take(1, &path(&[(0.0, -3.0, 0.8, 0.0), (6.0, 3.0, 0.8, 0.0)]));
    let answer = watch.answer(NOW);
    assert_eq!(pair(&answer, "0", "1").state, PairReport::CLEAR);
    let found = authority(&answer, "0");
    assert_eq!((found.state, found.waits_for.as_str(), found.length), (AuthorityReport::LIMITED, "1", 0.0));
    // Its corner, at 1 m ahead and 0.1 m to the left, is 0.5 m to the side then, less 3 mm.
    let yaw = 2.0 * found.pose.orientation.z.atan2(found.pose.orientation.w);
    let side = yaw.sin() + 0.1 * yaw.cos();
    assert!(side < 0.5 && side > 0.495, "{side}");
    assert_near(seconds(found.time), 5.0 + 2.0 * yaw / FRAC_PI_2, 1e-6);
}

#[test]
fn planners_without_times() {
    let robot = |name: &str| {
        format!(
            r#"{{ "name": "{name}", "path": "/{name}", "radius": 0.3, "margin": 0, "pace": {{ "speed": 0.5, "turn": 1 }} }}"#
        )
    };
    let config = format!(r#"{{ "frame": "map", "max_age": 2, "robots": [{}, {}] }}"#, robot("a"), robot("b"));
    let mut watch = Watch::new(Config::from_json(&config).expect("a configuration"));
    // A pose twice, and a turn in place of 1 rad.
    watch.take(0, &path(&[(0.0, -2.0, 0.0, 0.0), (0.0, -2.0, 0.0, 0.0), (0.0, -2.0, 0.0, 1.0), (0.0, 2.0, 0.0, 1.0)]));
    watch.take(1, &path(&[(0.0, 0.0, 0.5, 0.0), (0.0, 0.0, 0.5, 0.0)]));
    let answer = watch.answer(NOW);
    let [found] = &answer.conflicts.conflicts[..] else { panic!("{answer:?}") };
    // Its way is 2 m less the half chord at 0.5 m from its centre.
    let half = (0.36_f64 - 0.25).sqrt();
    assert_near(seconds(found.begin), 1.0 + (2.0 - half) / 0.5, 1e-6);
    assert_near(found.begin_length_a, 2.0 - half, 1e-6);
    assert_near(found.begin_length_b, 0.0, 0.0);
}

/// Where a robot is at a time: along lines, and turned the shorter way.
fn place(poses: &[Timed], time: f64) -> (f64, f64, f64) {
    let next = poses.partition_point(|pose| pose.0 <= time);
    let (_, x, y, yaw) = poses[next.saturating_sub(1)];
    if next == 0 || next == poses.len() {
        return (x, y, yaw);
    }
    let (from, to) = (poses[next - 1], poses[next]);
    let share = (time - from.0) / (to.0 - from.0);
    let turn = (to.3 - from.3 + PI).rem_euclid(TAU) - PI;
    (x + share * (to.1 - x), y + share * (to.2 - y), yaw + share * turn)
}

/// A path of random waypoints in a square of 6 m, with waits and turns in place.
fn wander(random: &mut Random) -> Vec<Timed> {
    let mut pose = (random.between(0.0, 2.0), random.between(-3.0, 3.0), random.between(-3.0, 3.0), 0.0);
    let mut poses = vec![pose];
    for _ in 0..1 + random.between(0.0, 5.0) as usize {
        if random.between(0.0, 1.0) < 0.7 {
            (pose.1, pose.2) = (random.between(-3.0, 3.0), random.between(-3.0, 3.0));
        }
        if random.between(0.0, 1.0) < 0.7 {
            // Half a turn has no side.
            pose.3 += random.between(-3.0, 3.0);
        }
        pose.0 += random.between(0.5, 4.0);
        poses.push(pose);
    }
    poses
}

/// The largest gap between two convex polygons along a normal of an edge: below 0 they overlap, and their distance is not less.
fn gap(a: &[(f64, f64)], b: &[(f64, f64)]) -> f64 {
    let along = |own: &[(f64, f64)], other: &[(f64, f64)]| {
        let edges = own.iter().zip(own.iter().cycle().skip(1));
        let gaps = edges.map(|(from, to)| {
            let (nx, ny) = (to.1 - from.1, from.0 - to.0);
            let length = nx.hypot(ny);
            other.iter().map(|at| ((at.0 - from.0) * nx + (at.1 - from.1) * ny) / length).fold(f64::MAX, f64::min)
        });
        gaps.fold(f64::MIN, f64::max)
    };
    along(a, b).max(along(b, a))
}

fn corners(outline: &[(f64, f64)], (x, y, yaw): (f64, f64, f64)) -> Vec<(f64, f64)> {
    let (sin, cos) = yaw.sin_cos();
    outline.iter().map(|(ahead, left)| (x + ahead * cos - left * sin, y + ahead * sin + left * cos)).collect()
}

const FORKLIFT: [(f64, f64); 4] = [(-0.3, -0.3), (0.7, -0.3), (0.7, 0.3), (-0.3, 0.3)];

/// Least gap of two bodies at the times of their paths, sampled, and the times at which they overlap for certain.
fn sampled(robots: [&[Timed]; 2], apart: impl Fn([(f64, f64, f64); 2]) -> f64) -> (f64, Vec<f64>) {
    let end = robots.iter().map(|poses| poses[poses.len() - 1].0).fold(0.0, f64::max);
    let times = (0..=(end / 0.005) as usize + 1).map(|k| k as f64 * 0.005);
    let gaps: Vec<(f64, f64)> = times.map(|time| (time, apart(robots.map(|poses| place(poses, time))))).collect();
    let least = gaps.iter().map(|(_, gap)| *gap).fold(f64::MAX, f64::min);
    (least, gaps.into_iter().filter(|(_, gap)| *gap < -1e-6).map(|(time, _)| time).collect())
}

fn ask(footprint: &str, robots: &[&[Timed]]) -> Answer {
    let mut watch = watch(&vec![footprint; robots.len()]);
    robots.iter().enumerate().for_each(|(robot, poses)| watch.take(robot, &path(poses)));
    watch.answer(NOW)
}

/// Compares the answer for two random robots with samples: all overlaps are told, and none is told where the bodies are `most` apart.
/// Returns the state.
fn compare(robots: [&[Timed]; 2], answer: &Answer, most: f64, apart: impl Fn([(f64, f64, f64); 2]) -> f64) -> u8 {
    let told = &answer.conflicts.conflicts;
    let (least, overlaps) = sampled(robots, &apart);
    let is_told = |time: f64| {
        told.iter().any(|told| seconds(told.begin) - 1e-6 <= time && (told.lasting || time <= seconds(told.end) + 1e-6))
    };
    let missed: Vec<f64> = overlaps.into_iter().filter(|&time| !is_told(time)).collect();
    assert!(missed.is_empty(), "{missed:?} of {told:?}, {robots:?}");
    for conflict in told {
        let at = seconds(conflict.deepest);
        let there = robots.map(|poses| place(poses, at));
        assert!(apart(there) <= most, "{} at {at}, least {least}, {robots:?}", apart(there));
        for ((x, y, _), pose) in there.iter().zip([conflict.pose_a, conflict.pose_b]) {
            assert!((x - pose.position.x).hypot(y - pose.position.y) < 1e-3);
        }
    }
    assert_eq!(answer.conflicts.refusals, []);
    let state = pair(answer, "0", "1").state;
    assert_eq!(state, if told.is_empty() { PairReport::CLEAR } else { PairReport::CONFLICT }, "{answer:?}");
    state
}

#[test]
fn random_discs() {
    let (mut random, mut counts) = (Random(1), [0; 3]);
    for _ in 0..300 {
        let paths = [0; 2].map(|_| wander(&mut random));
        let robots = [&paths[0][..], &paths[1][..]];
        let answer = ask(r#""radius": 0.4"#, &robots);
        let apart = |[a, b]: [(f64, f64, f64); 2]| (a.0 - b.0).hypot(a.1 - b.1) - 0.8;
        counts[usize::from(compare(robots, &answer, 1e-6, apart))] += 1;
    }
    assert!(counts[0] == 0 && counts[1] > 50 && counts[2] > 50, "{counts:?}");
}

#[test]
fn random_outlines_that_go_and_turn() {
    let footprint = r#""outline": [[-0.3, -0.3], [0.7, -0.3], [0.7, 0.3], [-0.3, 0.3]]"#;
    let (mut random, mut counts) = (Random(2), [0; 3]);
    for _ in 0..100 {
        let paths = [0; 2].map(|_| wander(&mut random));
        let robots = [&paths[0][..], &paths[1][..]];
        let answer = ask(footprint, &robots);
        let apart = |there: [(f64, f64, f64); 2]| {
            let [a, b] = there.map(|pose| corners(&FORKLIFT, pose));
            gap(&a, &b)
        };
        // Each deviates by up to 3 mm, and is larger by as much.
        counts[usize::from(compare(robots, &answer, 0.012, apart))] += 1;
    }
    assert!(counts[0] == 0 && counts[1] > 15 && counts[2] > 15, "{counts:?}");
}

/// Places of a path up to a travelled length, a centimetre apart.
fn places(poses: &[Timed], until: f64) -> Vec<(f64, f64)> {
    let (mut travelled, mut found) = (0.0, vec![(poses[0].1, poses[0].2)]);
    for pair in poses.windows(2) {
        let (dx, dy) = (pair[1].1 - pair[0].1, pair[1].2 - pair[0].2);
        let length = dx.hypot(dy);
        let steps = (length / 0.01).ceil() as usize;
        for k in 1..=steps {
            let share = k as f64 / steps as f64;
            if travelled + share * length <= until {
                found.push((pair[0].1 + share * dx, pair[0].2 + share * dy));
            }
        }
        travelled += length;
    }
    found
}

fn least(a: &[(f64, f64)], b: &[(f64, f64)]) -> f64 {
    let to_all = |at: &(f64, f64)| b.iter().map(|of| (at.0 - of.0).hypot(at.1 - of.1)).fold(f64::MAX, f64::min);
    a.iter().map(to_all).fold(f64::MAX, f64::min)
}

/// Whoever keeps to the authorities touches nobody, wherever all of them are; and none of them is much shorter than it has to be.
#[test]
fn random_authorities() {
    let (mut random, mut counts) = (Random(3), [0; 4]);
    for _ in 0..60 {
        let paths = [0; 3].map(|_| wander(&mut random));
        let robots = [&paths[0][..], &paths[1][..], &paths[2][..]];
        let answer = ask(r#""radius": 0.4"#, &robots);
        let told: Vec<&AuthorityReport> = ["0", "1", "2"].map(|robot| authority(&answer, robot)).into();
        told.iter().for_each(|told| counts[usize::from(told.state)] += 1);
        let reach: Vec<Vec<(f64, f64)>> =
            robots.iter().zip(&told).map(|(poses, told)| places(poses, told.length)).collect();
        for b in 0..3 {
            for a in 0..b {
                let is_stuck = [a, b].iter().any(|&robot| told[robot].state == AuthorityReport::NONE);
                let apart = least(&reach[a], &reach[b]);
                // Where one stands in the other one's way from the beginning, they may touch there already.
                let begin = least(&reach[a][..1], &reach[b][..1]);
                assert!(apart >= 0.8 - 1e-6 || (is_stuck && begin < 0.8), "{apart}: {told:?} of {robots:?}");
            }
        }
        for (robot, told) in told.iter().enumerate().filter(|(_, told)| told.state == AuthorityReport::LIMITED) {
            let other: usize = told.waits_for.parse().expect("a name");
            let beyond = places(robots[robot], told.length + 0.05);
            assert!(least(&beyond, &places(robots[other], f64::MAX)) <= 0.8 + 0.02, "{told:?} of {robots:?}");
        }
    }
    assert!(counts[0] == 0 && counts[1..].iter().all(|&count| count > 5), "{counts:?}");
}
