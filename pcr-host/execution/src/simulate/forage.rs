//! The foraging of the paper's Section 4.2: four small robots fetch from resources behind obstacles.
//!
//! ```text
//!   y
//!  1.0                    r       d  places in the nest (x = 0.1)
//!        d        o       r       r  resources (x = 1.0), six, of which the seed gives one to each robot
//!        d    o           r       o  obstacles
//!                 o
//!        d    o           r
//!        d        o       r
//!  0.0                    r  x
//! ```
//!
//! The paper gives neither the plan of its arena nor the data of its robots. Radius and speed are those of the e-puck
//! (Mondada et al. 2009: 70 mm across, 13 cm/s); the lengths of the paths match the 8.1 s of the paper.

use super::noise::{NoiseSource, NoiseStream};
use super::shortest_paths::{RoundObstacle, taut};
use super::simulation_task::{ReleasedMission, RobotTask, SimulationTask, StandingObstacle};
use super::speed_limited_path::SpeedLimitedPath;
use super::vector::PlaneVector;
use pcr_core::Limits;
use pcr_formats::scenario::Labels;
use pcr_planning::fleet::ConvexBody;

/// Radius of a robot \[m\].
const RADIUS: f64 = 0.035;

/// \[m/s\], \[m/s²\]
const LIMITS: Limits<f64> = Limits { speed: 0.13, acceleration: 0.4 };

/// Distance that a path keeps from an obstacle, beyond the radius of the robot \[m\].
const CLEARANCE: f64 = 0.03;

/// Radius of the obstacles \[m\].
const OBSTACLE: f64 = 0.055;

/// Starts of the robots, to which they return \[m\].
pub(crate) const NEST: [PlaneVector; 4] = [[0.1, 0.2], [0.1, 0.4], [0.1, 0.6], [0.1, 0.8]];

/// Positions of the resources \[m\].
pub(crate) const RESOURCES: [PlaneVector; 6] = [[1.0, 0.0], [1.0, 0.2], [1.0, 0.4], [1.0, 0.6], [1.0, 0.8], [1.0, 1.0]];

/// \[m\]
const OBSTACLES: [PlaneVector; 5] = [[0.36, 0.34], [0.36, 0.66], [0.55, 0.5], [0.55, 0.18], [0.55, 0.82]];

/// The task for a seed: each robot travels `trips` times from the nest to its resource and back.
pub fn task(seed: u64, trips: u32) -> SimulationTask {
    let discs = OBSTACLES.map(|centre| RoundObstacle { centre, radius: OBSTACLE + RADIUS + CLEARANCE });
    let mut noise = NoiseStream::new(seed, 0, NoiseSource::Missions);
    let mut resources = RESOURCES.to_vec();
    let robots = NEST.iter().enumerate().map(|(place, &home)| {
        let resource = resources.swap_remove(noise.below(resources.len()));
        let course = |from, to| {
            let (pose, path) = taut(from, to, &discs)?;
            SpeedLimitedPath::new(pose, &path).ok()
        };
        let (out, back) = (course(home, resource), course(resource, home));
        // The arena is fixed: a test looks at all ways.
        let trip = out.into_iter().chain(back).map(|course| ReleasedMission { release: 0.0, course });
        let trip: Vec<ReleasedMission> = trip.collect();
        let missions = (0..trips).flat_map(|_| trip.clone()).collect();
        RobotTask {
            id: place as u64 + 1,
            radius: RADIUS,
            body: ConvexBody::Disc(RADIUS),
            margin: 0.0,
            limits: LIMITS,
            missions,
        }
    });
    let obstacles = OBSTACLES.map(|centre| {
        let body = ConvexBody::Disc(OBSTACLE);
        StandingObstacle { id: None, centre, heading: 0.0, radius: OBSTACLE, body, margin: 0.0 }
    });
    SimulationTask {
        name: "foraging".into(),
        labels: Labels::default(),
        robots: robots.collect(),
        obstacles: obstacles.to_vec(),
        warnings: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::vector::{norm, sub};
    use super::*;

    #[test]
    fn all_ways_are_clear_of_obstacles_and_of_all_other_places_to_stand() {
        let discs = OBSTACLES.map(|centre| RoundObstacle { centre, radius: OBSTACLE + RADIUS + CLEARANCE });
        for home in NEST {
            for resource in RESOURCES {
                for [from, to] in [[home, resource], [resource, home]] {
                    let (pose, path) = taut(from, to, &discs).expect("a way");
                    let course = SpeedLimitedPath::new(pose, &path).expect("a course");
                    let end = course.point_at(course.length());
                    assert!(norm(sub(end, to)) < 1e-9);
                    let mut least = f64::INFINITY;
                    let stand = NEST.iter().chain(&RESOURCES).filter(|&&place| place != from && place != to);
                    for k in 0..=1000 {
                        let at = course.point_at(course.length() * f64::from(k) / 1000.0);
                        assert!(discs.iter().all(|disc| norm(sub(disc.centre, at)) >= disc.radius - 1e-9));
                        for place in stand.clone() {
                            least = least.min(norm(sub(*place, at)) - 2.0 * RADIUS);
                        }
                    }
                    // Both robots keep the margin of a plan: the camera's 15 mm, and twice 5 mm off the path.
                    assert!(least > 2.0 * 0.025, "{from:?} {to:?} passes another place at {least}");
                }
            }
        }
    }
}
