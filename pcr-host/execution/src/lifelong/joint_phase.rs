//! When robots are moved up together, and on which edges.

use super::route_graph::RouteGraph;

/// When robots are moved up together.
#[derive(Clone, Debug, Default)]
pub(super) struct JointPhase {
    /// Time until which they are \[s\].
    pub(super) until: f64,
    /// Duration of the present or last time \[s\].
    pub(super) period: f64,
    /// Time since which nobody has a goal on its way; `None` if somebody has \[s\].
    pub(super) idle_since: Option<f64>,
    /// Time of the next attempt after one without success \[s\].
    pub(super) next_try: f64,
    /// For each atom whether a robot at its end can come back to its beginning over other edges.
    pub(super) is_round: Vec<bool>,
    /// For each robot the time before which it is not tried again \[s\].
    pub(super) again: Vec<f64>,
}

/// For each atom whether a way leads from its end to its beginning that does not go back on it.
pub(super) fn rounds(site: &RouteGraph) -> Vec<bool> {
    let is_round = |&[from, to]: &[usize; 2]| {
        let mut found = vec![false; site.points.len()];
        let mut left = vec![to];
        found[to] = true;
        while let Some(node) = left.pop() {
            for &atom in &site.leaving[node] {
                let next = site.atoms[atom].ends[1];
                if (node, next) != (to, from) && !std::mem::replace(&mut found[next], true) {
                    left.push(next);
                }
            }
        }
        found[from]
    };
    site.atoms.iter().map(|atom| atom.edge.is_some() && atom.ends[0] != atom.ends[1] && is_round(&atom.ends)).collect()
}
