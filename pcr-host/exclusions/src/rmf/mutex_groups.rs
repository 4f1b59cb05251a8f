//! Finds vertices that have to be in one group.

use pcr_formats::import::{ElementId, Layout};
use pcr_planning::exclusion_table::ExclusionTable;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// For each node the first node of its group.
pub(super) fn united(layout: &Layout, locks: &ExclusionTable) -> Vec<usize> {
    let edges: HashMap<&ElementId, [usize; 2]> = layout.edges.iter().map(|edge| (&edge.id, edge.ends)).collect();
    let nodes: HashMap<&ElementId, usize> = layout.nodes.iter().enumerate().map(|(k, node)| (&node.id, k)).collect();
    // What has to have a group in common: the ends of two lanes, or a vertex and the ends of a lane.
    let mut open: Vec<[Vec<usize>; 2]> = Vec::new();
    for lock in &locks.locks {
        if let (Some(a), Some(b)) = (edges.get(&lock.a), edges.get(&lock.b)) {
            open.push([a.to_vec(), b.to_vec()]);
        }
    }
    for lock in locks.nodes.iter().flatten() {
        if let (Some(&node), Some(edge)) = (nodes.get(&lock.node), edges.get(&lock.edge)) {
            open.push([vec![node], edge.to_vec()]);
        }
    }
    let mut group: Vec<usize> = (0..layout.nodes.len()).collect();
    let mut size = vec![1_usize; layout.nodes.len()];
    let distance = |a: usize, b: usize| {
        let [p, q] = [layout.nodes[a].point, layout.nodes[b].point];
        (p[0] - q[0]).hypot(p[1] - q[1])
    };
    loop {
        let common = |[a, b]: &[Vec<usize>; 2]| a.iter().any(|a| b.iter().any(|b| group[*a] == group[*b]));
        open.retain(|pair| !common(pair));
        let mut candidates: BTreeMap<[usize; 2], (usize, f64)> = BTreeMap::new();
        for [own, other] in &open {
            let pairs = own.iter().flat_map(|&a| other.iter().map(move |&b| (a, b)));
            let mut once = BTreeSet::new();
            for (a, b) in pairs {
                let key = [group[a].min(group[b]), group[a].max(group[b])];
                let entry = candidates.entry(key).or_insert((0, f64::INFINITY));
                entry.0 += usize::from(once.insert(key));
                entry.1 = entry.1.min(distance(a, b));
            }
        }
        let worth = |([a, b], (count, apart)): (&[usize; 2], &(usize, f64))| {
            (*count as f64 / (size[*a] * size[*b]) as f64, -apart)
        };
        let best = candidates.iter().max_by(|x, y| {
            let (x, y) = (worth((x.0, x.1)), worth((y.0, y.1)));
            x.0.total_cmp(&y.0).then(x.1.total_cmp(&y.1))
        });
        let Some((&[keep, gone], _)) = best else { return group };
        size[keep] += size[gone];
        group.iter_mut().filter(|group| **group == gone).for_each(|group| *group = keep);
    }
}
