//! A lower bound from groups of agents: the least costs of each group alone add up.

use super::problem::{Objective, Problem};
use super::search::{Search, Stop};
use std::collections::BTreeMap;

/// Most agents of a group, one attempt after the other.
const SIZES: [usize; 5] = [4, 8, 12, 16, 24];

/// No delays cost less \[ticks\].
pub(super) fn bound(problem: &Problem, stop: Stop<'_>) -> i128 {
    let Some(root) = Search::new(problem, stop).root() else { return i128::MAX };
    SIZES.iter().map(|&size| of_size(problem, &root, size, stop)).max().unwrap_or(0)
}

fn of_size(problem: &Problem, root: &[i64], size: usize, stop: Stop<'_>) -> i128 {
    let of_group = |group: Vec<usize>| {
        let part = problem.of(&group);
        let least = group.iter().map(|&agent| root[agent]).collect();
        Search::new(&part, stop).from(least).run([], i128::MAX).bound
    };
    let bounds = groups(problem, root, size).into_iter().map(of_group);
    match problem.objective {
        Objective::Sum => bounds.fold(0, i128::saturating_add),
        Objective::Makespan => bounds.max().unwrap_or(0),
    }
}

/// The agents in disjoint groups: those that cost one another most are joined first.
fn groups(problem: &Problem, root: &[i64], size: usize) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = (0..problem.len()).map(|agent| vec![agent]).collect();
    let mut links: BTreeMap<[usize; 2], i128> = BTreeMap::new();
    for pair in &problem.pairs {
        let difference = pair.difference(root);
        if let Some([lo, hi]) = pair.violated(root) {
            let [i, j] = pair.agents;
            *links.entry([i.min(j), i.max(j)]).or_default() += i128::from((difference - lo).min(hi - difference));
        }
    }
    loop {
        let joined = |[a, b]: &[usize; 2]| groups[*a].len() + groups[*b].len();
        let link = links.iter().filter(|(ends, _)| joined(ends) <= size);
        let Some((&[kept, gone], _)) = link.max_by_key(|(ends, cost)| *cost / joined(ends) as i128) else { break };
        let mut members = std::mem::take(&mut groups[gone]);
        groups[kept].append(&mut members);
        let (moved, stay): (BTreeMap<_, _>, BTreeMap<_, _>) =
            links.into_iter().partition(|(ends, _)| ends.contains(&gone));
        links = stay;
        for ([a, b], cost) in moved {
            let other = if a == gone { b } else { a };
            if other != kept {
                *links.entry([kept.min(other), kept.max(other)]).or_default() += cost;
            }
        }
    }
    groups.retain(|group| !group.is_empty());
    groups
}
