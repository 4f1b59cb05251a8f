//! Random goals, delays and starts, which are the same for all methods.

use super::LifelongOptions;
use super::endpoints::Endpoints;
use super::robot::LifelongRobot;
use super::route_graph::RouteGraph;
use pcr_formats::splitmix64::SplitMix64;

/// Time between two control steps \[s\].
pub(super) const STEP: f64 = 0.1;

/// Steps between two values of the slip.
const SLIPS: usize = 50;

/// Draws the random stops and slip of a robot: the same under each method.
pub(super) fn disturb(
    robot: &mut LifelongRobot,
    number: usize,
    tick: usize,
    now: f64,
    open: bool,
    request: &LifelongOptions,
) {
    let delays = request.delays;
    let mut random = SplitMix64(request.seed ^ (number as u64).wrapping_mul(0x9e37_79b9) ^ ((tick as u64) << 24));
    let rate = delays.stopped * STEP / delays.stop / (1.0 - delays.stopped);
    if open && robot.stopped_until <= now && random.unit() < rate {
        robot.stopped_until = now + 2.0 * delays.stop * random.unit();
    }
    if tick % SLIPS == number % SLIPS {
        robot.slip = delays.slip * random.unit();
    }
}

/// The goal of a mission of a robot: a different node from its present one under any method, and if possible one where it would
/// not touch a robot that stands at `place`.
pub(super) fn goal(site: &RouteGraph, ends: &Endpoints, seed: u64, robot: usize, number: u64, place: usize) -> usize {
    let mut random = SplitMix64(seed.wrapping_mul(0x2545_f491).wrapping_add((robot as u64) << 32).wrapping_add(number));
    random.bits();
    let is_apart = |&goal: &usize| !site.collide(goal, place);
    let is_any = ends.nodes.iter().any(is_apart);
    loop {
        let goal = ends.nodes[random.below(ends.nodes.len())];
        // Robots only start if there are two nodes.
        if if is_any { is_apart(&goal) } else { goal != place } {
            return goal;
        }
    }
}

/// Nodes at which robots do not touch one another, safe ends first.
pub(super) fn starts(site: &RouteGraph, ends: &Endpoints, count: usize, seed: u64) -> Vec<usize> {
    let mut random = SplitMix64(seed ^ 0x5741_5254);
    let mut starts: Vec<usize> = Vec::new();
    let mut taken = vec![false; site.atoms.len()];
    let mut nodes = random.shuffled(&ends.safe);
    nodes.extend(random.shuffled(&ends.nodes));
    if ends.nodes.len() < 2 {
        return starts;
    }
    for node in nodes {
        if starts.len() < count && !taken[site.standing(node)] {
            site.covers(node).iter().for_each(|&atom| taken[atom] = true);
            starts.push(node);
        }
    }
    starts
}
