//! Ways and orders for a mission: some routes, ends and preferences are tried, and what lets everybody arrive soonest is taken.

use super::network::Network;
use super::predict::Prediction;
use super::robot::{Abilities, Robot};
use super::way::Way;
use super::{HostOrders, TOLERANCES, motions};
use pcr_core::{Mission, Pass, Progress, Reach, Refused, RegionRef};
use pcr_formats::import::Step;

/// What a node with a robot that stands there costs a route \[m\].
const TOLLS: [f64; 3] = [1e6, 20.0, 0.0];

/// Ends that are tried for each route.
const ENDS: usize = 2;

/// Accepted candidates among which one is chosen.
const CHOICES: usize = 6;

/// How a region's order is preferred: the time by which the other one has to be delayed less \[s\]; none lets everybody else go
/// first.
const BIASES: [Option<f64>; 3] = [Some(0.0), Some(15.0), None];

/// A way that was admitted.
pub(super) struct Admitted<'a> {
    pub(super) way: Way<'a>,
    /// What is cut off from the way before \[m\].
    pub(super) before: f64,
    pub(super) orders: HostOrders,
}

/// What a decision is about.
#[derive(Clone, Copy)]
pub(super) struct Scene<'s, 'a> {
    pub(super) network: &'s Network<'a>,
    pub(super) robots: &'s [Robot<'a>],
    pub(super) orders: &'s HostOrders,
    pub(super) abilities: &'s Abilities,
    pub(super) radius: f64,
}

/// Finds a way for a robot to a node and on to an end.
///
/// # Errors
/// The last refusal, or nothing where there is no way at all.
pub(super) fn dispatch<'a>(scene: Scene<'_, 'a>, agent: usize, goal: usize) -> Result<Admitted<'a>, Option<Refused>> {
    let node = scene.turn_off(agent);
    let routes = routes(scene.network, scene.robots, agent, node, goal);
    scene.admitted(agent, routes.into_iter().map(|(route, goal)| (route, Some(goal))))
}

/// Finds a way for a robot that stands in the way of another one's mission, to where it does not.
pub(super) fn make_way<'a>(scene: Scene<'_, 'a>, robot: usize, other: usize, goal: usize) -> Option<Admitted<'a>> {
    /// Nearest places that are tried.
    const PLACES: usize = 8;
    let Scene { network, robots, .. } = scene;
    let occupied = ends_of_others(robots, robot);
    let route = network.way(scene.turn_off(other), goal, &occupied, 0.0)?;
    let free = |&node: &usize| {
        occupied.iter().all(|&end| !network.collide(node, end)) && !route.iter().any(|&step| network.passes(step, node))
    };
    let from = scene.turn_off(robot);
    let places = network.nodes.iter().copied().filter(|&node| node != from).filter(free);
    let mut ways: Vec<Vec<Step<'a>>> = places.filter_map(|node| network.way(from, node, &occupied, 1e6)).collect();
    ways.sort_by(|a, b| length(a).total_cmp(&length(b)));
    ways.truncate(PLACES);
    scene.admitted(robot, ways.into_iter().map(|way| (way, None))).ok()
}

impl<'a> Scene<'_, 'a> {
    /// The node at which a robot can leave its way.
    fn turn_off(&self, agent: usize) -> usize {
        let robot = &self.robots[agent];
        robot.way.kept(robot.at, robot.progress(self.abilities).stop).3
    }

    /// The way and orders with which all are expected to arrive soonest, of those that are admitted.
    fn admitted(
        &self,
        agent: usize,
        candidates: impl Iterator<Item = (Vec<Step<'a>>, Option<usize>)>,
    ) -> Result<Admitted<'a>, Option<Refused>> {
        let Self { network, robots, orders, abilities, radius } = *self;
        let progress: Vec<Progress<f64>> = robots.iter().map(|robot| robot.progress(abilities)).collect();
        let ways: Vec<&Way<'a>> = robots.iter().map(|robot| &robot.way).collect();
        let robot = &robots[agent];
        let (origin, kept, before, _) = robot.way.kept(robot.at, progress[agent].stop);
        let prediction = Prediction::of(orders, &ways, robots, &progress, abilities);
        let own = Progress {
            at: pcr_core::Interval::new((robot.at - before).max(0.0), (robot.at - before).max(0.0)),
            stop: (progress[agent].stop - before).max(0.0),
        };
        let mut refused = None;
        let mut best: Option<(f64, Admitted<'a>)> = None;
        let mut choices = 0;
        for (route, goal) in candidates {
            let steps = kept.iter().chain(&route).copied().collect();
            let Ok(way) = Way::new(network, origin, steps, radius, goal.map(|goal| kept.len() + goal)) else {
                continue;
            };
            for bias in BIASES {
                if choices >= CHOICES {
                    break;
                }
                let mut trial = orders.clone();
                let found = {
                    let mut fleet = motions(&ways);
                    let mut places = progress.clone();
                    let mut reaches = vec![Reach::EMPTY; robots.len()];
                    let mission = Mission { agent, motion: way.motion(), progress: own };
                    let prefer =
                        |region: &RegionRef<'_, f64>| preferred(region, &way, own.at.lo, &prediction, bias, abilities);
                    trial.admit(&mut fleet, &mut places, mission, TOLERANCES, &mut reaches, prefer)
                };
                match found {
                    Ok(()) => {
                        choices += 1;
                        let mut after = ways.clone();
                        after[agent] = &way;
                        let mut places = progress.clone();
                        places[agent] = own;
                        let sum = Prediction::of(&trial, &after, robots, &places, abilities).sum;
                        if best.as_ref().is_none_or(|(least, _)| sum < *least) {
                            best = Some((sum, Admitted { way: way.clone(), before, orders: trial }));
                        }
                    }
                    Err(reason) => {
                        refused = Some(reason);
                        // No preference helps where nobody can wait.
                        if matches!(reason, Refused::Blocked { .. }) {
                            break;
                        }
                    }
                }
            }
        }
        best.map(|(_, admitted)| admitted).ok_or(refused)
    }
}

/// Ways to the goal and on to an end, with the number of steps to the goal.
fn routes<'a>(
    network: &Network<'a>,
    robots: &[Robot<'a>],
    agent: usize,
    node: usize,
    goal: usize,
) -> Vec<(Vec<Step<'a>>, usize)> {
    let occupied = ends_of_others(robots, agent);
    let free = |end: &usize| occupied.iter().all(|&other| !network.collide(*end, other));
    let mut found: Vec<(Vec<Step<'a>>, usize)> = Vec::new();
    for toll in TOLLS {
        let Some(there) = network.way(node, goal, &occupied, toll) else { continue };
        let mut onward: Vec<Vec<Step<'a>>> = network
            .ends
            .iter()
            .copied()
            .filter(free)
            .filter_map(|end| network.way(goal, end, &occupied, toll))
            .collect();
        onward.sort_by(|a, b| length(a).total_cmp(&length(b)));
        // More robots than ends: it stays.
        if onward.is_empty() && free(&goal) {
            onward.push(Vec::new());
        }
        for end in onward.into_iter().take(ENDS) {
            let way: Vec<Step<'a>> = there.iter().chain(&end).copied().collect();
            if found.iter().all(|(other, _)| *other != way) {
                found.push((way, there.len()));
            }
        }
    }
    found
}

fn length(way: &[Step<'_>]) -> f64 {
    way.iter().map(|step| step.edge.length()).sum()
}

/// Where all other robots are to stand in the end.
fn ends_of_others(robots: &[Robot<'_>], agent: usize) -> Vec<usize> {
    robots.iter().enumerate().filter(|(k, _)| *k != agent).map(|(_, robot)| robot.way.end()).collect()
}

/// Who should go first: who delays the other one less.
fn preferred(
    region: &RegionRef<'_, f64>,
    way: &Way<'_>,
    at: f64,
    prediction: &Prediction,
    bias: Option<f64>,
    abilities: &Abilities,
) -> Pass {
    let Some(bias) = bias else { return Pass::Second };
    let own = |length: f64| {
        let corners = way.corners.iter().filter(|corner| at <= corner.0 && corner.0 < length);
        let turns: f64 = corners.map(|corner| abilities.turn(corner.1) + abilities.stop()).sum();
        (length - at).max(0.0) / abilities.speed + turns
    };
    let other = |length: f64| prediction.time(region.other(), length, abilities);
    let (length, other_length) = (region.length(), region.other_length());
    let behind = (other(other_length.hi) - own(length.lo)).max(0.0);
    let ahead = (own(length.hi) - other(other_length.lo)).max(0.0);
    if ahead + bias < behind { Pass::First } else { Pass::Second }
}
