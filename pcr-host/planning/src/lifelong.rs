//! Fleets that run for hours: missions come one after the other, ways and orders are admitted when a robot needs them, and
//! robots keep their orders however late anybody is.
//!
//! A robot goes to its goal and on to a node where it may stand for good, so that nobody ever waits for somebody without a
//! mission; where its next mission is admitted on the way it turns off. Orders are those of `pcr_core::Orders`
//! (`docs/theory.md`).

mod dispatch;
mod network;
mod predict;
mod robot;
mod way;

use crate::random::Random;
use dispatch::{Scene, dispatch, make_way};
use network::Network;
use pcr_core::{Hold, Motion, Order, Orders, Piece, Refused, Region, Tolerances};
use pcr_formats::import::Imported;
use robot::{Abilities, Robot, STEP};
use serde::Serialize;
use std::time::{Duration, Instant};
use way::Way;

/// Orders on the heap.
pub type HostOrders = Orders<f64, Vec<Region>, Vec<Piece<f64>>, Vec<Order<f64>>>;

/// Robots know where they are, and stop this near to where they may go \[m\].
const TOLERANCES: Tolerances<f64> = Tolerances { width: 0.01, gain: 1e-3 };

/// Between two tries for the same mission \[s\].
const AGAIN: f64 = 2.0;

/// A robot that stands in the way of a mission that has been refused for so long is asked to go elsewhere \[s\].
const PATIENCE: f64 = 8.0;

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// Robots.
    pub agents: usize,
    /// For how long missions come \[s\].
    pub duration: f64,
    /// Part of the time for which robots are stopped at random.
    pub stopped: f64,
    /// Another number gives other missions and stops.
    pub seed: u64,
}

/// How it went.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Outcome {
    /// Robots that found a place to start.
    pub robots: usize,
    /// Nodes where robots may stand for good.
    pub safe_ends: usize,
    /// Goals reached.
    pub missions: usize,
    /// The same an hour.
    pub missions_per_hour: f64,
    /// Times at which two discs overlapped.
    pub contacts: usize,
    /// Least distance between two discs \[m\].
    pub clearance: f64,
    /// Times at which a robot was beyond what its orders allow.
    pub breaches: usize,
    /// Longest time for which nobody moved \[s\].
    pub standstill: f64,
    /// Longest time from when a mission is given until it is admitted, of those that were \[s\].
    pub longest_wait: f64,
    /// The same of those that still wait in the end \[s\].
    pub waiting: f64,
    /// Tries that were refused.
    pub refused: usize,
    /// Robots that were asked to go elsewhere, as they stood in the way.
    pub moved: usize,
    /// Tries that were refused because a table was full.
    pub full: usize,
    /// Robots that have not come to the end of their way long after the last mission.
    pub stuck: usize,
}

/// Runs a fleet on a layout; with it the time that each decision took.
///
/// # Errors
/// Where the vehicle cannot move or brake, or a way is no path.
pub fn run(imported: &Imported, request: Request) -> Result<(Outcome, Vec<Duration>), String> {
    let network = Network::new(imported, request.seed);
    let abilities = Abilities::of(&imported.vehicle).ok_or("the vehicle cannot brake")?;
    let radius = imported.vehicle.radius + imported.vehicle.margin;
    let mut random = Random(request.seed);
    let starts = starts(&network, request.agents, &mut random);
    let standing = |&node: &usize| Way::standing(&network, node, radius).map(Robot::new);
    let mut robots: Vec<Robot<'_>> =
        starts.iter().map(standing).collect::<Result<_, _>>().map_err(|reason| reason.to_string())?;
    let mut outcome =
        Outcome { robots: robots.len(), safe_ends: network.ends.len(), clearance: f64::INFINITY, ..Outcome::default() };
    let mut orders = table(&robots)?;
    let mut decisions = Vec::new();
    let mut next_try = vec![0.0_f64; robots.len()];
    let mut still = 0.0;
    let rest = 1200.0;
    for tick in 0.. {
        let time = f64::from(tick) * STEP;
        let open = time < request.duration;
        if time > request.duration + rest || (!open && robots.iter().all(|robot| robot.has_arrived())) {
            break;
        }
        if open {
            for k in 0..robots.len() {
                if robots[k].wants.is_none() && robots[k].way.goal.is_none() {
                    let goal = draw(&network, &robots, k, &mut random);
                    robots[k].wants = Some((goal, time));
                }
            }
            // The one that has waited longest, of those whose turn it is.
            let mut waiting: Vec<(usize, usize, f64)> = robots
                .iter()
                .enumerate()
                .filter_map(|(k, robot)| {
                    robot.wants.filter(|_| next_try[k] <= time).map(|(goal, since)| (k, goal, since))
                })
                .collect();
            waiting.sort_by(|a, b| a.2.total_cmp(&b.2));
            if let Some(&(agent, goal, since)) = waiting.first() {
                let begin = Instant::now();
                let scene =
                    Scene { network: &network, robots: &robots, orders: &orders, abilities: &abilities, radius };
                let found = dispatch(scene, agent, goal);
                decisions.push(begin.elapsed());
                match found {
                    Ok(admitted) => {
                        orders = admitted.orders;
                        robots[agent].take(admitted.way, admitted.before);
                        robots[agent].wants = None;
                        outcome.longest_wait = outcome.longest_wait.max(time - since);
                    }
                    Err(reason) => {
                        outcome.refused += 1;
                        outcome.full += usize::from(matches!(reason, Some(Refused::Full(_))));
                        next_try[agent] = time + AGAIN;
                        let by = match reason {
                            Some(Refused::Blocked { by, .. } | Refused::Stuck { by, .. }) => by,
                            _ => agent,
                        };
                        let asked = by != agent && time - since > PATIENCE && robots[by].has_arrived();
                        let scene = Scene { robots: &robots, ..scene };
                        if let Some(admitted) = asked.then(|| make_way(scene, by, agent, goal)).flatten() {
                            orders = admitted.orders;
                            robots[by].take(admitted.way, admitted.before);
                            outcome.moved += 1;
                        }
                    }
                }
            }
        }
        let before: f64 = robots.iter().map(|robot| robot.at).sum();
        step(
            &mut robots,
            &orders,
            time,
            &abilities,
            &mut random,
            request.stopped * f64::from(u8::from(open)),
            &mut outcome,
        );
        let moved = robots.iter().map(|robot| robot.at).sum::<f64>() > before;
        still = if moved || robots.iter().all(|robot| robot.has_arrived()) { 0.0 } else { still + STEP };
        outcome.standstill = f64::max(outcome.standstill, still);
        if tick % 10 == 0 {
            let progress: Vec<_> = robots.iter().map(|robot| robot.progress(&abilities)).collect();
            orders.passed(&progress);
        }
        let clearance = clearance(&robots, imported.vehicle.radius);
        outcome.clearance = outcome.clearance.min(clearance);
        outcome.contacts += usize::from(clearance < -1e-9);
    }
    let since = |robot: &Robot<'_>| robot.wants.map_or(0.0, |(_, since)| request.duration - since);
    outcome.waiting = robots.iter().map(since).fold(0.0, f64::max);
    outcome.stuck = robots.iter().filter(|robot| !robot.has_arrived()).count();
    outcome.missions_per_hour = outcome.missions as f64 * 3600.0 / request.duration;
    Ok((outcome, decisions))
}

/// The motions of a fleet for the table.
fn motions<'w>(ways: &[&'w Way<'_>]) -> Vec<Motion<'w, f64>> {
    ways.iter().map(|way| way.motion()).collect()
}

/// An empty table with room for a fleet of this size.
fn table(robots: &[Robot<'_>]) -> Result<HostOrders, String> {
    let ways: Vec<&Way<'_>> = robots.iter().map(|robot| &robot.way).collect();
    let count = robots.len() + 4;
    let regions = vec![Region::EMPTY; 100 * count];
    let (pieces, orders) = (vec![Piece::EMPTY; 1500 * count], vec![Order::EMPTY; 200 * count]);
    Orders::build(regions, pieces, orders, &motions(&ways)).map_err(|full| full.to_string())
}

/// Nodes apart from one another, safe ends first.
fn starts(network: &Network<'_>, count: usize, random: &mut Random) -> Vec<usize> {
    let mut starts: Vec<usize> = Vec::new();
    let mut nodes = random.shuffled(&network.ends);
    nodes.extend(random.shuffled(&network.nodes));
    for node in nodes {
        if starts.len() < count && starts.iter().all(|&other| !network.collide(other, node)) {
            starts.push(node);
        }
    }
    starts
}

/// A goal that no other robot stands at for good, and that is not where the robot is.
fn draw(network: &Network<'_>, robots: &[Robot<'_>], agent: usize, random: &mut Random) -> usize {
    let here = robots[agent].way.point(robots[agent].at);
    loop {
        let goal = network.nodes[random.below(network.nodes.len())];
        let [x, y] = network.at(goal);
        let elsewhere = (x - here[0]).hypot(y - here[1]) > 0.01;
        let others = robots.iter().enumerate().filter(|(k, _)| *k != agent);
        if elsewhere && others.into_iter().all(|(_, robot)| !network.collide(goal, robot.way.end())) {
            return goal;
        }
    }
}

/// Everybody goes on for a step.
fn step(
    robots: &mut [Robot<'_>],
    orders: &HostOrders,
    time: f64,
    abilities: &Abilities,
    random: &mut Random,
    stopped: f64,
    outcome: &mut Outcome,
) {
    /// Mean duration of a stop \[s\].
    const STOP: f64 = 5.0;
    let progress: Vec<_> = robots.iter().map(|robot| robot.progress(abilities)).collect();
    let holds: Vec<f64> = {
        let ways: Vec<&Way<'_>> = robots.iter().map(|robot| &robot.way).collect();
        let fleet = motions(&ways);
        let hold = |(k, robot): (usize, &Robot<'_>)| {
            let far = robot.horizon(abilities).max(progress[k].stop);
            match orders.hold_before(&fleet, k, &progress, Hold::At(far)).expect("the table of the fleet") {
                Hold::At(hold) => hold,
                Hold::Free => far,
                Hold::Inside => f64::NEG_INFINITY,
            }
        };
        robots.iter().enumerate().map(hold).collect()
    };
    for ((robot, hold), progress) in robots.iter_mut().zip(holds).zip(&progress) {
        outcome.breaches += usize::from(progress.stop > hold + 1e-9 && progress.stop > progress.at.lo);
        // So that it is stopped for this part of the time.
        if robot.stopped_until <= time && random.unit() < stopped * STEP / STOP / (1.0 - stopped) {
            robot.stopped_until = time + 2.0 * STOP * random.unit();
        }
        outcome.missions += usize::from(robot.drive(hold, time, abilities));
    }
}

/// Least distance between two discs \[m\].
fn clearance(robots: &[Robot<'_>], radius: f64) -> f64 {
    let points: Vec<[f64; 2]> = robots.iter().map(|robot| robot.way.point(robot.at)).collect();
    let pairs = points.iter().enumerate().flat_map(|(k, a)| points[..k].iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]) - 2.0 * radius).fold(f64::INFINITY, f64::min)
}
