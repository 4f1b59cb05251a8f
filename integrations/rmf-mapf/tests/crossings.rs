//! Random plans of two discs that are free of collisions at their times, and whose paths cross. Steps that overlap must not be possible at the
//! same time, whatever the robots' delays. What overlaps is computed here, by the distances of line segments.

mod common;

use common::Random;
use pcr_rmf_mapf::{Dependencies, Error, Footprint, TimedPose, Trajectory};

type Point = [f64; 2];

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// The least length of a + share b, for a share from 0 to 1.
fn least(a: Point, b: Point) -> f64 {
    let share = if dot(b, b) > 0.0 { (-dot(a, b) / dot(b, b)).clamp(0.0, 1.0) } else { 0.0 };
    let at = [a[0] + share * b[0], a[1] + share * b[1]];
    dot(at, at).sqrt()
}

/// Distance of two line segments.
fn distance(a: [Point; 2], b: [Point; 2]) -> f64 {
    let cross = |o: Point, p: Point, q: Point| {
        let (u, v) = (minus(p, o), minus(q, o));
        u[0] * v[1] - u[1] * v[0]
    };
    let apart =
        |own: [Point; 2], other: [Point; 2]| cross(own[0], own[1], other[0]) * cross(own[0], own[1], other[1]) < 0.0;
    if apart(a, b) && apart(b, a) {
        return 0.0;
    }
    let ends = |own: [Point; 2], other: [Point; 2]| {
        own.map(|point| least(minus(other[0], point), minus(other[1], other[0]))).into_iter().fold(f64::MAX, f64::min)
    };
    ends(a, b).min(ends(b, a))
}

/// Where an agent is at a time of the plan.
fn at(poses: &[TimedPose], time: f64) -> TimedPose {
    match poses.iter().position(|pose| pose.time >= time) {
        Some(0) => poses[0],
        Some(k) => {
            common::between(poses[k - 1], poses[k], (time - poses[k - 1].time) / (poses[k].time - poses[k - 1].time))
        }
        None => poses[poses.len() - 1],
    }
}

/// The least distance of two agents at the times of their plan.
fn clearance(a: &Trajectory, b: &Trajectory) -> f64 {
    let mut times: Vec<f64> = a.poses().iter().chain(b.poses()).map(|pose| pose.time).collect();
    times.sort_by(f64::total_cmp);
    let apart = |time: f64| minus(at(a.poses(), time).position, at(b.poses(), time).position);
    times.windows(2).map(|pair| least(apart(pair[0]), minus(apart(pair[1]), apart(pair[0])))).fold(f64::MAX, f64::min)
}

/// A path of random waypoints in a square of 6 m, with waits, at random speeds.
fn trajectory(random: &mut Random, radius: f64) -> Trajectory {
    let mut pose = TimedPose { time: 0.0, position: [random.between(-3.0, 3.0), random.between(-3.0, 3.0)], yaw: 0.0 };
    let mut poses = vec![pose];
    for _ in 0..2 + (random.unit() * 8.0) as usize {
        if random.unit() > 0.25 {
            pose.position = [random.between(-3.0, 3.0), random.between(-3.0, 3.0)];
        }
        pose.time += random.between(0.2, 4.0);
        poses.push(pose);
    }
    Trajectory::new(poses).with_footprint(Footprint::Disc { radius })
}

/// The steps of an agent, and the last one: it stays.
fn steps(trajectory: &Trajectory) -> Vec<[Point; 2]> {
    let mut places: Vec<Point> = trajectory.poses().iter().map(|pose| pose.position).collect();
    places.extend(places.last().copied());
    places.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// The last waypoint of the other agent that has to be reached before an agent is in its step of an index.
fn needed(dependencies: &Dependencies, agent: usize, step: usize) -> usize {
    let before = |wait: &pcr_rmf_mapf::Dependency| wait.agent == agent && wait.waypoint <= step + 1;
    dependencies.iter().filter(before).map(|wait| wait.reached).max().unwrap_or(0)
}

#[test]
fn steps_that_overlap_are_never_possible_at_the_same_time() {
    let mut random = Random(1);
    let (mut plans, mut overlaps, mut circles) = (0, 0, 0);
    for radius in [0.5, 0.35, 0.25, 0.1] {
        let mut found = 0;
        while found < 450 {
            let pair = [0; 2].map(|_| trajectory(&mut random, radius));
            let (least, both) = (clearance(&pair[0], &pair[1]), 2.0 * radius);
            let near = |one: &[Point; 2], other: &[Point; 2]| distance(*one, *other) < both - 1e-7;
            let [own, other] = [0, 1].map(|agent| steps(&pair[agent]));
            let crosses = own.iter().any(|one| other.iter().any(|two| near(one, two)));
            if !crosses || (least - both).abs() < 1e-6 {
                continue;
            }
            if least < both {
                assert_eq!(Dependencies::of(&pair).unwrap_err(), Error::Meeting { agents: [0, 1] });
                continue;
            }
            found += 1;
            let dependencies = match Dependencies::of(&pair) {
                // With waypoints in between there is an order.
                Err(Error::Circle { .. }) => {
                    circles += 1;
                    let fine = [0, 1].map(|agent| pair[agent].divided(0.01).0);
                    Dependencies::of(&fine).unwrap();
                    continue;
                }
                dependencies => dependencies.unwrap(),
            };
            assert!(dependencies.iter().next().is_some(), "none, at a radius of {radius}: {pair:?}");
            plans += 1;
            for (a, one) in own.iter().enumerate() {
                for (b, two) in other.iter().enumerate().filter(|(_, two)| near(one, two)) {
                    overlaps += 1;
                    let both_may = a >= needed(&dependencies, 1, b) && b >= needed(&dependencies, 0, a);
                    assert!(!both_may, "steps {a} and {b} at a radius of {radius}: {pair:?} {two:?}");
                }
            }
        }
    }
    assert!(
        plans > 1200 && overlaps > 10_000,
        "{plans} plans, {overlaps} overlaps, {circles} with waypoints in between"
    );
}
