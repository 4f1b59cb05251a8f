//! Priority-based search (Ma, Harabor, Stuckey, Li, Koenig 2019): two agents that collide get an order, either way
//! round; the second agent is planned again, and so are those that come after it. Depth first, the cheaper branch
//! first.

use super::{AgentReplan, ProfileBuffers};
use crate::fleet::HostEcm;
use crate::plan::plan_context::Planner;
use pcr_core::{MismatchError, Motion, RegionRef, SearchNode, first_overlap};

/// Nodes at most.
pub(super) const NODES: usize = 400;

/// A fleet that moves by some priorities.
#[derive(Clone)]
struct PriorityNode<'m> {
    plan: Vec<Motion<'m, f64>>,
    /// For each agent those that it gives way to.
    above: Vec<Vec<usize>>,
    cost: f64,
}

/// A plan that costs less than a limit, the best one that is found.
pub(super) fn searched<'m>(
    planner: &Planner<'_, 'm>,
    ecm: &HostEcm<f64>,
    mut limit: f64,
    room: &mut ProfileBuffers<'m>,
    stations: &mut [SearchNode<f64>],
    told: &dyn Fn(usize),
) -> Option<Vec<Motion<'m, f64>>> {
    let count = planner.motions.len();
    let mut root = PriorityNode { plan: planner.motions.to_vec(), above: vec![Vec::new(); count], cost: 0.0 };
    for agent in 0..count {
        plan_again(planner, ecm, &mut root, agent, room, stations)?;
    }
    root.cost = planner.cost(&root.plan);
    let (mut open, mut best) = (vec![root], None);
    for nodes in 0..NODES {
        told(nodes);
        let Some(node) = open.pop() else { break };
        if node.cost >= limit {
            continue;
        }
        // The table does not hold for plans that take longer than `LONGEST`.
        let Ok(collision) = collision(ecm, &node.plan) else { continue };
        let Some([i, j]) = collision else {
            limit = node.cost;
            best = Some(node.plan);
            continue;
        };
        let mut ways: Vec<PriorityNode<'m>> = [[i, j], [j, i]]
            .into_iter()
            .filter_map(|way| put_in_order(planner, ecm, &node, way, room, stations))
            .collect();
        // The last one is looked at first.
        ways.sort_by(|a, b| b.cost.total_cmp(&a.cost));
        open.append(&mut ways);
    }
    best
}

/// Two agents that collide.
fn collision(ecm: &HostEcm<f64>, plan: &[Motion<'_, f64>]) -> Result<Option<[usize; 2]>, MismatchError> {
    let all = Motion::span(plan);
    for (agent, motion) in plan.iter().enumerate() {
        let after = ecm.row(plan, agent)?.filter(|region| region.other() > agent);
        if let Some(met) = first_overlap(motion, after, all)? {
            return Ok(Some([agent, met.other]));
        }
    }
    Ok(None)
}

/// The node with one more priority, if there is a plan for all who have to give way.
fn put_in_order<'m>(
    planner: &Planner<'_, 'm>,
    ecm: &HostEcm<f64>,
    node: &PriorityNode<'m>,
    [first, second]: [usize; 2],
    room: &mut ProfileBuffers<'m>,
    stations: &mut [SearchNode<f64>],
) -> Option<PriorityNode<'m>> {
    if superiors(&node.above, first).contains(&second) {
        return None;
    }
    let mut node = node.clone();
    node.above[second].push(first);
    // An agent that gives way to more others is planned later.
    let count = node.plan.len();
    let mut below: Vec<(usize, usize)> = (0..count)
        .map(|agent| (superiors(&node.above, agent), agent))
        .filter(|(above, agent)| *agent == second || above.contains(&second))
        .map(|(above, agent)| (above.len(), agent))
        .collect();
    below.sort_unstable();
    for (_, agent) in below {
        plan_again(planner, ecm, &mut node, agent, room, stations)?;
    }
    node.cost = planner.cost(&node.plan);
    Some(node)
}

/// All that an agent gives way to, by way of others as well.
fn superiors(above: &[Vec<usize>], agent: usize) -> Vec<usize> {
    let mut found: Vec<usize> = Vec::new();
    let mut next = vec![agent];
    while let Some(agent) = next.pop() {
        for &superior in &above[agent] {
            if !found.contains(&superior) {
                found.push(superior);
                next.push(superior);
            }
        }
    }
    found
}

/// The earliest arrival of an agent behind those that it gives way to.
fn plan_again<'m>(
    planner: &Planner<'_, 'm>,
    ecm: &HostEcm<f64>,
    node: &mut PriorityNode<'m>,
    agent: usize,
    room: &mut ProfileBuffers<'m>,
    stations: &mut [SearchNode<f64>],
) -> Option<()> {
    let above = superiors(&node.above, agent);
    let motion = planner.motions[agent];
    // Delays count from the motion that the row is of: that of the file.
    node.plan[agent] = motion;
    let regions = ecm.row(&node.plan, agent).ok()?;
    let regions: Vec<RegionRef<'_, f64>> = regions.filter(|region| above.contains(&region.other())).collect();
    node.plan[agent] = AgentReplan::of(&motion, &regions, stations)?.motion(motion, room)?;
    Some(())
}
