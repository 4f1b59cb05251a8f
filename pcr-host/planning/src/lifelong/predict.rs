//! When robots will be where, if nothing stops them but the orders: what decisions are compared by, and nothing else depends on.

use super::robot::{Abilities, Robot};
use super::way::Way;
use super::{HostOrders, motions};
use pcr_core::{Hold, Interval, Progress};

/// Time between two predicted places \[s\].
const STEP: f64 = 1.0;

/// No further ahead \[s\].
const FAR: usize = 240;

/// Predicted places, and the time until all goals are reached.
#[derive(Clone, Debug)]
pub(super) struct Prediction {
    /// For each robot, where it is after so many steps \[m\].
    places: Vec<Vec<f64>>,
    /// Sum of the times until goals are reached \[s\].
    pub(super) sum: f64,
}

impl Prediction {
    /// With these ways and orders.
    pub(super) fn of(
        orders: &HostOrders,
        ways: &[&Way<'_>],
        robots: &[Robot<'_>],
        progress: &[Progress<f64>],
        abilities: &Abilities,
    ) -> Self {
        let fleet = motions(ways);
        let mut places: Vec<Progress<f64>> = progress.to_vec();
        let mut waits = vec![0.0_f64; ways.len()];
        let corner = |way: &Way<'_>, at: f64| way.corners.partition_point(|corner| corner.0 < at - 1e-3);
        let mut turned: Vec<usize> = ways.iter().zip(&places).map(|(way, place)| corner(way, place.at.lo)).collect();
        for (k, robot) in robots.iter().enumerate() {
            // One that has not got another way knows better.
            if std::ptr::eq(ways[k], &raw const robot.way) {
                turned[k] = robot.turned;
            }
        }
        let mut goals: Vec<Option<f64>> = ways.iter().map(|way| way.goal).collect();
        let mut tracks: Vec<Vec<f64>> = places.iter().map(|place| vec![place.at.lo]).collect();
        let mut sum = 0.0;
        for step in 1..=FAR {
            for k in 0..ways.len() {
                if waits[k] > 0.0 {
                    waits[k] -= STEP;
                    continue;
                }
                let (way, at) = (ways[k], places[k].at.lo);
                let next = way.corners.get(turned[k]).map_or(f64::INFINITY, |corner| corner.0);
                let next = next.min(goals[k].unwrap_or(f64::INFINITY)).min(way.length());
                let wanted = (at + abilities.speed * STEP).min(next);
                if wanted <= at && next > at {
                    continue;
                }
                let hold = orders.hold_before(&fleet, k, &places, Hold::At(wanted));
                let to = match hold.expect("the table of the fleet") {
                    Hold::At(hold) => hold.min(wanted).max(at),
                    Hold::Free | Hold::Inside => at,
                };
                places[k].at = Interval::new(to, to);
                if to >= next - 1e-3 {
                    if let Some(&(corner, angle)) = way.corners.get(turned[k])
                        && corner <= next
                    {
                        turned[k] += 1;
                        waits[k] += abilities.turn(angle) + abilities.stop();
                    }
                    if goals[k].is_some_and(|goal| goal <= next) {
                        goals[k] = None;
                        sum += step as f64 * STEP;
                    }
                }
            }
            tracks.iter_mut().zip(&places).for_each(|(track, place)| track.push(place.at.lo));
            if goals.iter().all(Option::is_none) {
                break;
            }
        }
        sum += goals.iter().flatten().count() as f64 * FAR as f64 * STEP;
        Self { places: tracks, sum }
    }

    /// When a robot is at this length at the earliest \[s\].
    pub(super) fn time(&self, robot: usize, length: f64, abilities: &Abilities) -> f64 {
        let track = &self.places[robot];
        let steps = track.partition_point(|&place| place < length);
        let beyond = length - track.last().copied().unwrap_or(0.0);
        if steps < track.len() { steps as f64 * STEP } else { track.len() as f64 * STEP + beyond / abilities.speed }
    }
}
