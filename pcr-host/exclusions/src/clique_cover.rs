//! Covers the edges of a graph by cliques: groups of places of which any two exclude each other.
//!
//! The least number of cliques is hard to find (Kou, Stockmeyer, Wong 1978). Here each uncovered edge grows to a clique
//! by adding the vertex that covers most of the remaining edges; then redundant cliques are removed. A lower bound
//! shows how good the result is: edges of which no two are in one clique need one clique each.

use std::collections::BTreeSet;

/// Cliques, and how many it takes at least.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct CliqueCover {
    pub(crate) cliques: Vec<Vec<usize>>,
    pub(crate) at_least: usize,
}

/// Covers the `needed` pairs by cliques of pairs that are `allowed`. All needed pairs are allowed; each is of two vertices below `count`.
pub(crate) fn cover(count: usize, allowed: &[[usize; 2]], needed: &[[usize; 2]]) -> CliqueCover {
    let mut beside = vec![BTreeSet::new(); count];
    for &[a, b] in allowed.iter().chain(needed) {
        beside[a].insert(b);
        beside[b].insert(a);
    }
    let ordered = |[a, b]: [usize; 2]| [a.min(b), a.max(b)];
    let all: BTreeSet<[usize; 2]> = needed.iter().map(|&pair| ordered(pair)).collect();
    let mut left = all.clone();
    let mut cliques: Vec<Vec<usize>> = Vec::new();
    while let Some(&[a, b]) = left.first() {
        let mut clique = vec![a, b];
        let mut fit: BTreeSet<usize> = beside[a].intersection(&beside[b]).copied().collect();
        let gain = |vertex: usize, clique: &[usize]| {
            clique.iter().filter(|&&other| left.contains(&ordered([vertex, other]))).count()
        };
        while let Some((gained, next)) = fit.iter().map(|&next| (gain(next, &clique), usize::MAX - next)).max()
            && gained > 0
        {
            let next = usize::MAX - next;
            fit = fit.intersection(&beside[next]).copied().collect();
            clique.push(next);
        }
        clique.sort_unstable();
        for (k, &a) in clique.iter().enumerate() {
            for &b in &clique[k + 1..] {
                left.remove(&ordered([a, b]));
            }
        }
        cliques.push(clique);
    }
    CliqueCover { cliques: pruned(cliques, &all), at_least: independent(&all, &beside) }
}

/// Without those of which every needed pair is in others, the smallest ones first.
fn pruned(mut cliques: Vec<Vec<usize>>, needed: &BTreeSet<[usize; 2]>) -> Vec<Vec<usize>> {
    let pairs = |clique: &[usize]| {
        let all = clique.iter().enumerate().flat_map(|(k, &a)| clique[k + 1..].iter().map(move |&b| [a, b]));
        all.filter(|pair| needed.contains(pair)).collect::<Vec<_>>()
    };
    let mut times = std::collections::BTreeMap::<[usize; 2], usize>::new();
    for pair in cliques.iter().flat_map(|clique| pairs(clique)) {
        *times.entry(pair).or_default() += 1;
    }
    cliques.sort_by_key(Vec::len);
    cliques.retain(|clique| {
        let own = pairs(clique);
        let needless = own.iter().all(|pair| times[pair] > 1);
        if needless {
            own.iter().for_each(|pair| *times.entry(*pair).or_default() -= 1);
        }
        !needless
    });
    cliques.sort();
    cliques
}

/// As many pairs as are found of which no two fit into one clique.
fn independent(needed: &BTreeSet<[usize; 2]>, beside: &[BTreeSet<usize>]) -> usize {
    let joined = |a: usize, b: usize| a == b || beside[a].contains(&b);
    let together =
        |[a, b]: [usize; 2], [c, d]: [usize; 2]| joined(a, c) && joined(a, d) && joined(b, c) && joined(b, d);
    // Pairs with few common neighbours are in few cliques.
    let mut order: Vec<[usize; 2]> = needed.iter().copied().collect();
    order.sort_by_key(|&[a, b]| beside[a].intersection(&beside[b]).count());
    let mut chosen: Vec<[usize; 2]> = Vec::new();
    for pair in order {
        if !chosen.iter().any(|&other| together(pair, other)) {
            chosen.push(pair);
        }
    }
    chosen.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::splitmix64::SplitMix64;

    #[test]
    fn every_pair_is_in_a_clique_and_the_bound_holds() {
        let mut random = SplitMix64(5);
        for _ in 0..300 {
            let count = 2 + random.below(9);
            let (mut allowed, mut needed) = (Vec::new(), Vec::new());
            for a in 0..count {
                for b in a + 1..count {
                    if random.unit() < 0.6 {
                        allowed.push([a, b]);
                        if random.unit() < 0.6 {
                            needed.push([b, a]);
                        }
                    }
                }
            }
            let found = cover(count, &allowed, &needed);
            for &[b, a] in &needed {
                let covers = |clique: &Vec<usize>| clique.contains(&a) && clique.contains(&b);
                assert!(found.cliques.iter().any(covers), "{a} {b} {found:?}");
            }
            for clique in &found.cliques {
                for (k, a) in clique.iter().enumerate() {
                    assert!(clique[k + 1..].iter().all(|b| allowed.contains(&[*a, *b])), "{found:?}");
                }
            }
            assert!(found.at_least <= found.cliques.len(), "{found:?}");
        }
        // A triangle is one clique, a path of three edges three.
        assert_eq!(cover(3, &[], &[[0, 1], [1, 2], [0, 2]]), CliqueCover { cliques: vec![vec![0, 1, 2]], at_least: 1 });
        assert_eq!(cover(4, &[], &[[0, 1], [1, 2], [2, 3]]).cliques.len(), 3);
        assert_eq!(cover(4, &[], &[[0, 1], [1, 2], [2, 3]]).at_least, 3);
    }
}
