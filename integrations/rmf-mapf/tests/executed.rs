//! Plans that are executed by robots with random delays: none touches another one, and all arrive.

mod common;

use common::{Random, between};
use mapf::negotiation::{Agent, Scenario, negotiate};
use pcr_rmf_mapf::{Dependencies, Dependency, Error, Footprint, TimedPose, Trajectory};
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::{FRAC_PI_2, PI};

/// Executes a plan: every agent waits as it has to, and is on the way to each waypoint for a random time. Calls `check` with the poses of all
/// agents in steps of `step` \[s\].
fn execute(
    trajectories: &[Trajectory],
    dependencies: &Dependencies,
    random: &mut Random,
    step: f64,
    mut check: impl FnMut(&[TimedPose]),
) {
    let mut reached = vec![0; trajectories.len()];
    // How much of its way each agent has made, and how long all of it takes.
    let mut ways: Vec<Option<(f64, f64)>> = vec![None; reached.len()];
    for _ in 0..10_000_000 {
        for agent in 0..reached.len() {
            if ways[agent].is_none() && dependencies.may_proceed(agent, &reached).unwrap() {
                let poses = trajectories[agent].poses();
                let planned = poses[reached[agent] + 1].time - poses[reached[agent]].time;
                // Now and then a robot is very late.
                let late = if random.unit() < 0.2 { 10.0 } else { 1.0 };
                ways[agent] = Some((0.0, planned * random.between(0.5, 2.0) * late));
            }
        }
        let pose = |agent: usize| {
            let (poses, last) = (trajectories[agent].poses(), reached[agent]);
            ways[agent]
                .map_or(poses[last], |(done, takes)| between(poses[last], poses[last + 1], (done / takes).min(1.0)))
        };
        check(&(0..reached.len()).map(pose).collect::<Vec<_>>());
        for agent in 0..reached.len() {
            if let Some((done, takes)) = &mut ways[agent] {
                *done += step;
                if *done >= *takes {
                    ways[agent] = None;
                    reached[agent] += 1;
                }
            }
        }
        let has_arrived = |agent: usize| reached[agent] + 1 == trajectories[agent].poses().len();
        if (0..reached.len()).all(has_arrived) {
            return;
        }
        let may_go = |agent: usize| ways[agent].is_some() || dependencies.may_proceed(agent, &reached).unwrap();
        assert!((0..reached.len()).any(may_go), "all wait at {reached:?}");
    }
    panic!("it did not end");
}

fn disc(radius: f64, poses: &[(f64, f64, f64)]) -> Trajectory {
    let poses = poses.iter().map(|&(time, x, y)| TimedPose { time, position: [x, y], yaw: 0.0 });
    Trajectory::new(poses).with_footprint(Footprint::Disc { radius })
}

fn stay_apart(poses: &[TimedPose], least: f64) {
    for (k, one) in poses.iter().enumerate() {
        for other in &poses[..k] {
            let [x, y] = [0, 1].map(|axis| one.position[axis] - other.position[axis]);
            assert!(x.hypot(y) > least, "{one:?} {other:?}");
        }
    }
}

/// Six robots of the planner's own negotiation cross a room.
#[test]
fn what_the_planner_negotiates() {
    let agent =
        |start: [i64; 2], goal: [i64; 2], yaw: f64| Agent { start, yaw, goal, radius: 0.45, speed: 0.75, spin: 1.0 };
    let agents = [
        agent([-6, 0], [6, 0], 0.0),
        agent([6, 2], [-6, 2], 3.0),
        agent([0, -6], [0, 6], 1.5),
        agent([3, 6], [3, -6], -1.5),
    ];
    let agents: BTreeMap<String, Agent> =
        (agents.into_iter().enumerate()).map(|(k, agent)| (k.to_string(), agent)).collect();
    let count = agents.len();
    let scenario =
        Scenario { agents, obstacles: Vec::new(), occupancy: HashMap::new(), cell_size: 1.0, camera_bounds: None };
    let (solution, _, names) = negotiate(&scenario, Some(1_000_000)).expect("there is a plan");
    let radius = scenario.agents.values().next().expect("an agent").radius;
    let mut trajectories = vec![None; count];
    for (k, proposal) in &solution.proposals {
        let own: usize = names[k].parse().unwrap();
        let planned = Trajectory::from(&proposal.meta.trajectory).with_footprint(Footprint::Disc { radius });
        trajectories[own] = Some(planned.divided(0.5).0);
    }
    let trajectories: Vec<Trajectory> = trajectories.into_iter().map(|own| own.expect("a proposal")).collect();
    let dependencies = Dependencies::of(&trajectories).unwrap();
    assert!(dependencies.iter().count() >= 4, "{:?}", dependencies.iter().collect::<Vec<_>>());
    for seed in 0..20 {
        execute(&trajectories, &dependencies, &mut Random(seed), 0.02, |poses| stay_apart(poses, 2.0 * radius - 1e-6));
    }
}

/// Robots that set off one after the other, so late that each is free of those before it.
fn fleet(random: &mut Random, count: usize, radius: f64) -> Vec<Trajectory> {
    let mut fleet: Vec<Trajectory> = Vec::new();
    let place = |random: &mut Random| [random.between(-8.0, 8.0), random.between(-8.0, 8.0)];
    'next: while fleet.len() < count {
        let places: Vec<[f64; 2]> = (0..4).map(|_| place(random)).collect();
        for delay in 0..60 {
            let mut pose = TimedPose { time: 0.0, position: places[0], yaw: 0.0 };
            let mut poses = vec![pose];
            pose.time = 0.5 + f64::from(delay) * 2.0;
            poses.push(pose);
            for pair in places.windows(2) {
                pose.time += (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
                pose.position = pair[1];
                poses.push(pose);
            }
            fleet.push(Trajectory::new(poses).with_footprint(Footprint::Disc { radius }).divided(0.4).0);
            match Dependencies::of(&fleet) {
                Ok(_) => continue 'next,
                Err(Error::Meeting { .. } | Error::Circle { .. }) => drop(fleet.pop()),
                Err(other) => panic!("{other}"),
            }
        }
    }
    fleet
}

#[test]
fn random_fleets() {
    let mut random = Random(7);
    for radius in [0.2, 0.4] {
        let fleet = fleet(&mut random, 12, radius);
        let dependencies = Dependencies::of(&fleet).unwrap();
        assert!(dependencies.iter().count() > 10);
        for _ in 0..5 {
            execute(&fleet, &dependencies, &mut random, 0.05, |poses| stay_apart(poses, 2.0 * radius - 1e-6));
        }
    }
}

/// The corners of a rectangle at a pose.
fn corners(size: [f64; 2], pose: TimedPose) -> [[f64; 2]; 4] {
    let ([x, y], (sin, cos)) = (size.map(|size| size / 2.0), pose.yaw.sin_cos());
    [[x, y], [-x, y], [-x, -y], [x, -y]]
        .map(|[x, y]| [pose.position[0] + x * cos - y * sin, pose.position[1] + x * sin + y * cos])
}

/// Whether two convex polygons are apart, by more than rounding: along the normal of one of their edges.
fn are_apart(one: &[[f64; 2]; 4], other: &[[f64; 2]; 4]) -> bool {
    let along = |own: &[[f64; 2]; 4], them: &[[f64; 2]; 4]| {
        (0..4).any(|k| {
            let ([ax, ay], [bx, by]) = (own[k], own[(k + 1) % 4]);
            let out = |p: &[f64; 2]| (p[0] - ax) * (by - ay) - (p[1] - ay) * (bx - ax);
            them.iter().all(|point| out(point) > -1e-6)
        })
    };
    along(one, other) || along(other, one)
}

/// A truck drives forward, turns in place, goes on sideways and in reverse, while another one crosses all of it.
#[test]
fn rectangles_in_every_direction_of_travel() {
    let size = [1.6, 0.8];
    let pose = |time: f64, x: f64, y: f64, yaw: f64| TimedPose { time, position: [x, y], yaw };
    let footprint = || {
        let [x, y] = size.map(|size| size / 2.0);
        Footprint::Polygon { corners: vec![[x, -y], [x, y], [-x, y], [-x, -y]] }
    };
    let first = [
        pose(0.0, -4.0, 0.0, 0.0),
        pose(4.0, 0.0, 0.0, 0.0),
        pose(6.0, 0.0, 0.0, FRAC_PI_2),
        pose(8.0, 2.0, 0.0, FRAC_PI_2),
        pose(12.0, 2.0, -4.0, FRAC_PI_2),
    ];
    let second = [
        pose(0.0, 1.2, 6.0, -FRAC_PI_2),
        pose(8.0, 1.2, 4.0, -FRAC_PI_2),
        pose(14.0, 1.2, 1.5, -FRAC_PI_2),
        pose(24.0, 1.2, -1.5, -FRAC_PI_2),
        pose(25.0, 1.2, -1.5, 0.0),
        pose(30.0, 6.0, -1.5, 0.0),
    ];
    let trajectory = |poses: &[TimedPose]| Trajectory::new(poses.to_vec()).with_footprint(footprint()).divided(0.5).0;
    let trajectories = [trajectory(&first), trajectory(&second)];
    let dependencies = Dependencies::of(&trajectories).unwrap();
    assert!(dependencies.iter().all(|wait| wait.agent == 1) && dependencies.iter().count() > 0);
    for seed in 0..50 {
        execute(&trajectories, &dependencies, &mut Random(seed), 0.02, |poses| {
            let [one, other] = [0, 1].map(|agent| corners(size, poses[agent]));
            assert!(are_apart(&one, &other), "{poses:?}");
        });
    }
}

#[test]
fn trucks_that_fit_past_one_another_do_not_wait() {
    let truck = |poses: [(f64, f64, f64, f64); 2]| {
        let poses = poses.map(|(time, x, y, yaw)| TimedPose { time, position: [x, y], yaw });
        let corners = vec![[0.6, -0.4], [0.6, 0.4], [-0.6, 0.4], [-0.6, -0.4]];
        Trajectory::new(poses).with_footprint(Footprint::Polygon { corners })
    };
    let east = truck([(0.0, -3.0, 0.0, 0.0), (6.0, 3.0, 0.0, 0.0)]);
    let west = |y: f64| truck([(0.0, 3.0, y, PI), (6.0, -3.0, y, PI)]);
    assert_eq!(Dependencies::of(&[east.clone(), west(0.801)]).unwrap().iter().count(), 0);
    assert_eq!(Dependencies::of(&[east, west(0.799)]).unwrap_err(), Error::Meeting { agents: [0, 1] });
}

/// Four robots go round a square all at once.
#[test]
fn a_round_needs_waypoints_in_between() {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let robot = |k: usize| {
        let [from, to] = [corners[k], corners[(k + 1) % 4]];
        disc(0.3, &[(0.0, from[0], from[1]), (1.0, to[0], to[1])])
    };
    let round: Vec<Trajectory> = (0..4).map(robot).collect();
    let waits = (0..4).map(|agent| (agent, 1)).collect();
    assert_eq!(Dependencies::of(&round).unwrap_err(), Error::Circle { waits });
    let fine: Vec<Trajectory> = round.iter().map(|robot| robot.divided(0.05).0).collect();
    let dependencies = Dependencies::of(&fine).unwrap();
    execute(&fine, &dependencies, &mut Random(3), 0.001, |poses| stay_apart(poses, 0.6 - 1e-6));
}

/// In the same step one robot passes in the first half of it and one in the second half; or they pass in different steps, and at different
/// times after the beginnings of these.
#[test]
fn two_plans_whose_dependencies_are_easily_missed() {
    let first = disc(0.3, &[(0.0, -1.0, 0.0), (1.0, 3.0, 0.0), (2.0, 3.0, 0.0)]);
    for (waypoint, second) in [
        (1, [(0.0, 0.0, -3.0), (1.0, 0.0, 1.0), (2.0, 0.0, 1.0)]),
        (2, [(0.0, 0.0, -3.0), (1.0, 0.0, -3.0), (2.0, 0.0, 1.0)]),
    ] {
        let found: Vec<_> = Dependencies::of(&[first.clone(), disc(0.3, &second)]).unwrap().iter().collect();
        assert_eq!(found, [Dependency { agent: 1, waypoint, waits_for: 0, reached: 1 }]);
    }
}

#[test]
fn what_cannot_be_answered_is_refused() {
    let good = disc(0.3, &[(0.0, 0.0, 0.0), (1.0, 1.0, 0.0)]);
    let error = |trajectory: Trajectory| Dependencies::of(&[good.clone(), trajectory]).unwrap_err();
    assert_eq!(error(Trajectory::new([]).with_footprint(Footprint::Disc { radius: 0.3 })), Error::Empty { agent: 1 });
    let pose = |time: f64, x: f64, yaw: f64| TimedPose { time, position: [x, 9.0], yaw };
    assert_eq!(error(Trajectory::new([pose(0.0, 0.0, 0.0)])), Error::NoFootprint { agent: 1 });
    let late = disc(0.3, &[(1.0, 5.0, 5.0), (1.0, 6.0, 5.0)]);
    assert_eq!(error(late), Error::Time { agent: 1, waypoint: 1 });
    assert!(matches!(error(disc(0.0, &[(0.0, 5.0, 5.0)])), Error::Invalid { agent: 1, .. }));
    assert!(matches!(error(disc(0.3, &[(0.0, f64::NAN, 5.0)])), Error::Invalid { agent: 1, .. }));
    assert!(matches!(error(disc(0.3, &[(0.0, 5.0, 5.0), (1.0, f64::INFINITY, 5.0)])), Error::Invalid { agent: 1, .. }));
    let polygon = |corners: &[[f64; 2]]| Footprint::Polygon { corners: corners.to_vec() };
    let square = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let curved = Trajectory::new([pose(0.0, 0.0, 0.0), pose(1.0, 1.0, 0.2)]).with_footprint(polygon(&square));
    assert_eq!(error(curved.clone()), Error::TurnsOnTheWay { agent: 1, waypoint: 1 });
    for wrong in [-0.1, f64::NAN, f64::INFINITY] {
        assert!(matches!(error(curved.clone().with_deviation(wrong)), Error::Invalid { agent: 1, .. }), "{wrong}");
        assert!(matches!(error(good.clone().with_margin(wrong)), Error::Invalid { agent: 1, .. }), "{wrong}");
    }
    let turned = Trajectory::new([pose(0.0, 0.0, 0.0), pose(1.0, 0.0, PI)]).with_footprint(polygon(&square));
    assert_eq!(error(turned.clone()), Error::HalfTurn { agent: 1, waypoint: 1 });
    assert_eq!(error(turned.divided(0.1).0), Error::HalfTurn { agent: 1, waypoint: 1 });
    let by_way_of = Trajectory::new([pose(0.0, 0.0, 0.0), pose(1.0, 0.0, -1.0), pose(2.0, 0.0, PI)]);
    assert!(Dependencies::of(&[by_way_of.with_footprint(polygon(&square))]).is_ok());
    let concave = [[1.0, -1.0], [0.0, 0.0], [1.0, 1.0], [-1.0, 0.0]];
    let stands = Trajectory::new([pose(0.0, 0.0, 0.0)]).with_footprint(polygon(&concave));
    assert!(matches!(error(stands), Error::Invalid { agent: 1, .. }));
    assert_eq!(error(disc(0.3, &[(0.0, 1.0, 0.0)])), Error::Meeting { agents: [0, 1] });

    let dependencies = Dependencies::of(&[good.clone(), disc(0.3, &[(0.0, 5.0, 5.0)])]).unwrap();
    assert_eq!(dependencies.may_proceed(0, &[0]).unwrap_err(), Error::Agents { given: 1, expected: 2 });
    assert_eq!(dependencies.may_proceed(2, &[0, 0]).unwrap_err(), Error::NoSuchAgent { agent: 2 });
    assert_eq!(dependencies.may_proceed(0, &[2, 0]).unwrap_err(), Error::NoSuchWaypoint { agent: 0, waypoint: 2 });
    assert!(!dependencies.may_proceed(0, &[1, 0]).unwrap() && dependencies.may_proceed(0, &[0, 0]).unwrap());
    assert_eq!(Dependencies::of(&[]).unwrap().iter().count(), 0);
}
