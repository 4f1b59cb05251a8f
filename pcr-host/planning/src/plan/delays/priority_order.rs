//! Orders of priority in which every agent comes after those that have to start before it.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The order, changed so that each agent comes after those that have to start before it (`first`). In a cycle the first
/// remaining agent is taken. Takes O(n log n) for n agents, plus the size of `first`.
pub(crate) fn respecting(order: &[usize], first: &[Vec<usize>]) -> Vec<usize> {
    let mut ranks = vec![0; first.len()];
    order.iter().enumerate().for_each(|(rank, &agent)| ranks[agent] = rank);
    let mut after = vec![Vec::new(); first.len()];
    let mut missing: Vec<usize> = first.iter().map(Vec::len).collect();
    for (agent, first) in first.iter().enumerate() {
        first.iter().for_each(|&other| after[other].push(agent));
    }
    let mut ready: BinaryHeap<Reverse<usize>> =
        order.iter().filter(|&&agent| missing[agent] == 0).map(|&agent| Reverse(ranks[agent])).collect();
    let mut placed = vec![false; first.len()];
    let mut respecting = Vec::with_capacity(order.len());
    let mut begin = 0;
    while respecting.len() < order.len() {
        let rank = ready.pop().map_or_else(
            || (begin..order.len()).find(|&rank| !placed[order[rank]]).unwrap_or(begin),
            |Reverse(rank)| rank,
        );
        let agent = order[rank];
        if std::mem::replace(&mut placed[agent], true) {
            continue;
        }
        while order.get(begin).is_some_and(|&agent| placed[agent]) {
            begin += 1;
        }
        respecting.push(agent);
        for &other in &after[agent] {
            missing[other] -= 1;
            if missing[other] == 0 && !placed[other] {
                ready.push(Reverse(ranks[other]));
            }
        }
    }
    respecting
}

#[cfg(test)]
mod tests {
    use super::respecting;

    #[test]
    fn who_has_to_start_before_others_does_and_circles_are_cut() {
        // 2 before 0; 3 and 4 before one another.
        let first = [vec![2], vec![], vec![], vec![4], vec![3]];
        assert_eq!(respecting(&[0, 1, 2, 3, 4], &first), [1, 2, 0, 3, 4]);
        assert_eq!(respecting(&[4, 3, 0, 2, 1], &first), [2, 0, 1, 4, 3]);
    }
}
