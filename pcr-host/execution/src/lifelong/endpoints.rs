//! Nodes of a layout where robots may stand for good without cutting off others, and properties that make a layout
//! difficult.

use super::route_graph::RouteGraph;
use pcr_formats::import::{ElementId, Layout};
use pcr_formats::splitmix64::SplitMix64;
use serde::Serialize;
use std::cell::OnceCell;
use std::collections::VecDeque;

/// Largest number of random orders of nodes from which safe ends are searched.
const DRAWS: usize = 40;

/// Number of pairs of nodes to be examined for that, roughly. In a layout of more than 2,828 nodes only dead ends are examined.
const PAIRS: usize = 8_000_000;

/// The nodes between which missions can be carried out without end, the safe ends, and obstacles to it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct WellFormedness {
    /// Number of nodes of the level with the most nodes.
    pub nodes: usize,
    /// Nodes from which not all others can be reached, or that cannot be reached from all others: no missions go there.
    pub cut_off: Vec<ElementId>,
    /// Safe ends: while robots stand at all of them for good, all other nodes, and each safe end, can be reached from one another.
    /// With fewer robots than safe ends no mission is refused for ever. Idle robots wait there.
    pub safe_ends: Vec<ElementId>,
    /// Nodes where a single robot that stands for good cuts off other nodes.
    pub never_ends: Vec<ElementId>,
    /// Two-way edges without which not all nodes can be reached from one another. Robots that meet there wait for each other for ever
    /// unless one of them has waited before.
    pub bridges: Vec<ElementId>,
    /// Whether only dead ends were examined as safe ends, as in a large layout.
    pub dead_ends_only: bool,
}

/// The nodes that missions can go to, and the safe ends among them.
#[derive(Clone, Debug, Default)]
pub(super) struct Endpoints {
    /// Nodes that can all be reached from one another.
    pub(super) nodes: Vec<usize>,
    pub(super) safe: Vec<usize>,
    /// For each node whether it is a safe end.
    pub(super) is_safe: Vec<bool>,
    /// Number of safe ends of the layout: a place counts once, in whatever layers it is one.
    pub(super) capacity: usize,
    /// Queues of places to stand on dead ends, each with its dead end first.
    lanes: Vec<Vec<usize>>,
    /// `lane[node]` is (index in `lanes`, position in that queue) of a queue place.
    lane: Vec<Option<(usize, usize)>>,
    harm: OnceCell<Vec<usize>>,
}

impl Endpoints {
    pub(super) fn of(site: &RouteGraph, seed: u64) -> Self {
        if site.layers.len() > 1 {
            return Self::of_layers(site, seed);
        }
        let nodes = strongest(site, 0);
        let dead = Some(dead_ends(site, &nodes)).filter(|ends| is_open(site, &nodes, ends));
        let found = [dead.unwrap_or_default(), drawn(site, &nodes, seed)];
        let safe = found.into_iter().max_by_key(Vec::len).unwrap_or_default();
        let mut is_safe = vec![false; site.points.len()];
        safe.iter().for_each(|&end| is_safe[end] = true);
        let (lane, capacity) = (vec![None; is_safe.len()], safe.len());
        Self { lane, lanes: Vec::new(), harm: OnceCell::new(), nodes, safe, is_safe, capacity }
    }

    /// The ends of several types of vehicles: places where any of them may stand for good.
    fn of_layers(site: &RouteGraph, seed: u64) -> Self {
        let nodes: Vec<usize> = (0..site.layers.len()).flat_map(|layer| strongest(site, layer)).collect();
        let mut groups: Vec<Vec<usize>> = vec![Vec::new(); site.places()];
        nodes.iter().for_each(|&node| groups[node % site.places()].push(node));
        let places: Vec<usize> = (0..groups.len()).filter(|&place| !groups[place].is_empty()).collect();
        let mut random = SplitMix64(seed);
        let mut best: Vec<usize> = Vec::new();
        for _ in 0..draws(&nodes).max(1) {
            let mut candidates = random.shuffled(&places);
            candidates.sort_by_key(|&place| groups[place].iter().any(|&node| site.leaving[node].len() > 1));
            let mut ends: Vec<usize> = Vec::new();
            for place in candidates {
                let touches = |&end: &usize| {
                    let own = groups[place].iter();
                    own.clone().any(|&node| groups[end].iter().any(|&other| site.collide(node, other)))
                };
                if !ends.iter().any(touches) {
                    ends.push(place);
                    if !are_open(site, &nodes, &groups, &ends) {
                        ends.pop();
                    }
                }
            }
            if ends.len() > best.len() {
                best = ends;
            }
        }
        let safe: Vec<usize> = best.iter().flat_map(|&place| groups[place].iter().copied()).collect();
        let mut is_safe = vec![false; site.points.len()];
        safe.iter().for_each(|&end| is_safe[end] = true);
        let (lane, capacity) = (vec![None; is_safe.len()], best.len());
        Self { lane, lanes: Vec::new(), harm: OnceCell::new(), nodes, safe, is_safe, capacity }
    }

    /// With queues of places on dead ends, each with its dead end first.
    pub(super) fn queued(self, site: &RouteGraph, lanes: Vec<Vec<usize>>) -> Self {
        let (mut is_safe, mut lane) = (self.is_safe, vec![None; site.points.len()]);
        is_safe.resize(site.points.len(), false);
        for (k, nodes) in lanes.iter().enumerate() {
            nodes.iter().enumerate().for_each(|(place, &node)| lane[node] = Some((k, place)));
        }
        Self { lanes, lane, is_safe, ..self }
    }

    /// Whether a robot may take a queue place: the next place towards the dead end is taken, and all places in front are free.
    pub(super) fn is_next(&self, node: usize, is_free: impl Fn(usize) -> bool) -> bool {
        let Some((lane, place)) = self.lane[node] else { return true };
        let lane = &self.lanes[lane];
        !lane[..place].last().is_some_and(|&behind| is_free(behind))
            && lane[place + 1..].iter().all(|&front| is_free(front))
    }

    /// For each node: how many nodes become unreachable if a robot stands there in addition to all safe ends; `usize::MAX` for nodes
    /// where no robot should stand. For a robot at a queue place other queue places do not count: those behind it are taken already.
    pub(super) fn harm(&self, site: &RouteGraph) -> &[usize] {
        /// Up to about this many pairs of neighbours it is faster to search ways between them than to count all nodes again.
        const FEW: usize = 64;
        self.harm.get_or_init(|| {
            let places: Vec<usize> = self.lanes.iter().flat_map(|lane| &lane[1..]).copied().collect();
            let all: Vec<usize> = self.nodes.iter().chain(&places).copied().collect();
            let mut harm = vec![usize::MAX; site.points.len()];
            let mut search = ReachabilitySearch::new(site);
            for (nodes, counted) in [(&self.nodes, &all), (&places, &self.nodes)] {
                let full = RemainingGraph::of(site, counted, &self.safe);
                let mut is_counted = vec![false; site.points.len()];
                counted.iter().for_each(|&node| is_counted[node] = full.is_inside[node]);
                for &node in nodes {
                    // If the robot separates no nodes, only the nodes that its disc covers are lost. Otherwise the rest is counted again.
                    harm[node] = if parts(&mut search, &full.is_inside, |atom| full.is_open[atom], node, FEW) {
                        let ends: Vec<usize> = self.safe.iter().chain([&node]).copied().collect();
                        full.count.saturating_sub(RemainingGraph::of(site, counted, &ends).count)
                    } else {
                        let is_lost = |other: &usize| is_counted[*other] && full.is_open[site.standing(*other)];
                        covered(site, node).into_iter().filter(is_lost).count()
                    };
                }
            }
            harm
        })
    }

    /// The report about the safe ends of a layout.
    pub(super) fn report(&self, site: &RouteGraph, layout: &Layout) -> WellFormedness {
        let ids = |nodes: Vec<usize>| nodes.into_iter().map(|node| layout.nodes[node].id.clone()).collect();
        let mut is_inside = vec![false; site.points.len()];
        self.nodes.iter().for_each(|&node| is_inside[node] = true);
        let other = |node: &usize| !is_inside[*node];
        let mut search = ReachabilitySearch::new(site);
        let never = |node: &usize| cuts_off(&mut search, &is_inside, *node);
        let mut safe = self.safe.clone();
        safe.sort_unstable();
        WellFormedness {
            nodes: site.nodes.len(),
            cut_off: ids(site.nodes.iter().copied().filter(other).collect()),
            safe_ends: ids(safe),
            never_ends: ids(self.nodes.iter().copied().filter(never).collect()),
            bridges: bridges(site, &is_inside).into_iter().map(|edge| layout.edges[edge].id.clone()).collect(),
            dead_ends_only: draws(&self.nodes) == 0,
        }
    }
}

/// The largest set of nodes of a layer that can all be reached from one another.
fn strongest(site: &RouteGraph, layer: usize) -> Vec<usize> {
    let mut left: Vec<bool> = vec![true; site.points.len()];
    let mut best: Vec<usize> = Vec::new();
    for &node in site.nodes.iter().filter(|&&node| site.layer_of(node) == layer) {
        if left[node] {
            let both = [false, true].map(|back| reached(site, node, back, |_| true));
            let mutual: Vec<usize> = site.nodes.iter().copied().filter(|&k| both[0][k] && both[1][k]).collect();
            mutual.iter().for_each(|&k| left[k] = false);
            if mutual.len() > best.len() {
                best = mutual;
            }
        }
    }
    best
}

/// Number of random orders from which safe ends are searched among these nodes.
fn draws(nodes: &[usize]) -> usize {
    (PAIRS / nodes.len().pow(2).max(1)).min(DRAWS)
}

/// The largest set of safe ends found from some random orders of nodes, dead ends first.
fn drawn(site: &RouteGraph, nodes: &[usize], seed: u64) -> Vec<usize> {
    let mut random = SplitMix64(seed);
    let mut best = Vec::new();
    for _ in 0..draws(nodes) {
        let mut candidates = random.shuffled(nodes);
        candidates.sort_by_key(|&node| site.leaving[node].len() > 1);
        let mut ends: Vec<usize> = Vec::new();
        for node in candidates {
            if ends.iter().all(|&end| !site.collide(end, node)) {
                ends.push(node);
                if !is_open(site, nodes, &ends) {
                    ends.pop();
                }
            }
        }
        if ends.len() > best.len() {
            best = ends;
        }
    }
    best
}

/// Nodes with one neighbour at which a robot touches no robot on other edges than those to that neighbour: no other way leads past them.
fn dead_ends(site: &RouteGraph, nodes: &[usize]) -> Vec<usize> {
    let mut ends: Vec<usize> = Vec::new();
    let mut taken = vec![false; site.atoms.len()];
    for &node in nodes {
        let [leaving] = site.leaving[node][..] else { continue };
        let neighbour = site.atoms[leaving].ends[1];
        let is_dead = site.coming[node].iter().all(|&atom| site.atoms[atom].ends[0] == neighbour);
        let own = |&atom: &usize| site.atoms[atom].ends.contains(&node);
        let covers = site.covers(node);
        if is_dead && covers.iter().all(own) && !taken[site.standing(node)] {
            covers.iter().for_each(|&atom| taken[atom] = true);
            ends.push(node);
        }
    }
    ends
}

/// Whether all nodes that robots at `ends` leave free can be reached from one another, and so can each end while its own robot is away.
/// Robots at the ends may cover no other nodes.
fn is_open(site: &RouteGraph, nodes: &[usize], ends: &[usize]) -> bool {
    let mut blocked = vec![0_u16; site.atoms.len()];
    ends.iter().for_each(|&end| site.covers(end).iter().for_each(|&atom| blocked[atom] += 1));
    let free = |node: usize| blocked[site.standing(node)] == 0;
    let Some(&hub) = nodes.iter().find(|&&node| free(node)) else { return false };
    let both = [false, true].map(|back| reached(site, hub, back, |atom| blocked[atom] == 0));
    nodes.iter().all(|&node| if free(node) { both.iter().all(|reached| reached[node]) } else { ends.contains(&node) })
        && ends.iter().all(|&end| {
            let covers = site.covers(end);
            let open = |atom: usize| blocked[atom] == 0 || (blocked[atom] == 1 && covers.contains(&atom));
            // It is enough that the robot can go to a node from which the hub can be reached, and can come from one that the hub reaches.
            let out = |atom: &usize| open(*atom) && both[1][site.atoms[*atom].ends[1]];
            let leaves = site.leaving[end].iter().any(out);
            let comes =
                |atom: &usize| site.atoms[*atom].ends[1] == end && open(*atom) && both[0][site.atoms[*atom].ends[0]];
            leaves && covers.iter().any(comes)
        })
}

/// The same of several types of vehicles: whoever stands at these places, all other nodes can be reached from one another in each layer, and
/// so can each end while its robot is away. `groups` has the nodes of each place.
fn are_open(site: &RouteGraph, nodes: &[usize], groups: &[Vec<usize>], ends: &[usize]) -> bool {
    let mut blocked = vec![0_u16; site.atoms.len()];
    let covers: Vec<Vec<usize>> = ends
        .iter()
        .map(|&end| {
            let mut all: Vec<usize> = groups[end].iter().flat_map(|&node| site.covers(node).to_vec()).collect();
            all.sort_unstable();
            all.dedup();
            all
        })
        .collect();
    covers.iter().flatten().for_each(|&atom| blocked[atom] += 1);
    let free = |node: usize| blocked[site.standing(node)] == 0;
    (0..site.layers.len()).all(|layer| {
        let mut own = nodes.iter().copied().filter(|&node| site.layer_of(node) == layer);
        let Some(hub) = own.clone().find(|&node| free(node)) else { return own.next().is_none() };
        let both = [false, true].map(|back| reached(site, hub, back, |atom| blocked[atom] == 0));
        let is_end = |node: usize| ends.contains(&(node % site.places()));
        own.all(|node| if free(node) { both.iter().all(|reached| reached[node]) } else { is_end(node) })
            && ends.iter().zip(&covers).all(|(&end, covers)| {
                let Some(&node) = groups[end].iter().find(|&&node| site.layer_of(node) == layer) else { return true };
                let open =
                    |atom: usize| blocked[atom] == 0 || (blocked[atom] == 1 && covers.binary_search(&atom).is_ok());
                let leaves = site.leaving[node].iter().any(|&atom| open(atom) && both[1][site.atoms[atom].ends[1]]);
                let comes = site.coming[node].iter().any(|&atom| open(atom) && both[0][site.atoms[atom].ends[0]]);
                leaves && comes
            })
    })
}

/// The part of a layout that remains usable while robots stand at some nodes.
struct RemainingGraph {
    /// For each atom whether no standing robot blocks it.
    is_open: Vec<bool>,
    /// For each node whether it is in the largest set of nodes that can all be reached from one another.
    is_inside: Vec<bool>,
    /// Number of counted nodes that are in this set and free.
    count: usize,
}

impl RemainingGraph {
    fn of(site: &RouteGraph, counted: &[usize], ends: &[usize]) -> Self {
        /// Number of nodes from which the largest set is searched. It may be missed if none of them is in it.
        const HUBS: usize = 4;
        let mut is_open = vec![true; site.atoms.len()];
        for &end in ends {
            site.covers(end).iter().for_each(|&atom| is_open[atom] = false);
        }
        let open = |atom: usize| is_open[atom];
        let (mut count, mut is_inside) = (0, vec![false; site.points.len()]);
        for layer in 0..site.layers.len() {
            let is_free = |node: &usize| site.layer_of(*node) == layer && open(site.standing(*node));
            let free: Vec<usize> = counted.iter().copied().filter(is_free).collect();
            let parts = (0..HUBS.min(free.len())).map(|k| {
                let hub = free[k * free.len() / HUBS.min(free.len())];
                let [to, from] = [false, true].map(|back| reached(site, hub, back, open));
                let is_inside: Vec<bool> = to.into_iter().zip(from).map(|(to, from)| to && from).collect();
                (free.iter().filter(|&&node| is_inside[node]).count(), is_inside)
            });
            if let Some((most, inside)) = parts.max_by_key(|part| part.0) {
                count += most;
                is_inside.iter_mut().zip(inside).for_each(|(all, own)| *all |= own);
            }
        }
        Self { is_open, is_inside, count }
    }
}

/// The nodes at which a robot would touch one that stands at `node`; `node` is one of them.
fn covered(site: &RouteGraph, node: usize) -> Vec<usize> {
    site.covers(node).iter().filter_map(|&atom| site.node_of(atom)).collect()
}

/// Whether a robot that stands at `node` cuts off other inside nodes: nodes that it covers, or nodes behind it.
fn cuts_off(search: &mut ReachabilitySearch<'_>, is_inside: &[bool], node: usize) -> bool {
    covered(search.site, node).into_iter().any(|other| other != node && is_inside[other])
        || parts(search, is_inside, |_| true, node, usize::MAX)
}

/// Whether a robot at `node` separates other inside nodes, which can reach one another over open atoms. Only ways that touch its disc
/// are lost, so it is enough to find detours from the starts of the edges that touch it to their ends. With more than `most` pairs of
/// starts and ends none are searched, and the answer is "maybe" (`true`).
fn parts(
    search: &mut ReachabilitySearch<'_>,
    is_inside: &[bool],
    is_open: impl Fn(usize) -> bool,
    node: usize,
    most: usize,
) -> bool {
    let site = search.site;
    let covers = site.covers(node);
    let edges = || covers.iter().filter(|&&atom| is_open(atom) && site.atoms[atom].edge.is_some());
    let ends = |end: usize| {
        let mut ends: Vec<usize> = edges().map(|&atom| site.atoms[atom].ends[end]).collect();
        ends.retain(|&end| end != node && is_inside[end]);
        ends.sort_unstable();
        ends.dedup();
        ends
    };
    let [from, to] = [ends(0), ends(1)];
    let mut is_parted = |from, to| !search.leads(from, to, |atom| is_open(atom) && !covers.contains(&atom));
    from.len() * to.len() > most || from.iter().any(|&from| to.iter().any(|&to| is_parted(from, to)))
}

/// Two-way edges without which not all nodes can be reached from one another.
fn bridges(site: &RouteGraph, is_inside: &[bool]) -> Vec<usize> {
    let mut search = ReachabilitySearch::new(site);
    let two_way =
        site.atoms.iter().enumerate().filter(|(place, _)| site.back[*place].is_some_and(|back| back > *place));
    let inside = two_way.filter(|(_, atom)| atom.ends.iter().all(|&node| is_inside[node]));
    let mut cuts = |place: usize, [a, b]: [usize; 2]| {
        // Begin at the node with fewer edges: from a dead end the search ends at once.
        let (a, b) = if site.leaving[a].len() < site.leaving[b].len() { (a, b) } else { (b, a) };
        let mut leads =
            |from: usize, to: usize| search.leads(from, to, |atom| atom != place && Some(atom) != site.back[place]);
        !leads(a, b) || !leads(b, a)
    };
    inside.filter(|(place, atom)| cuts(*place, atom.ends)).filter_map(|(_, atom)| atom.edge).collect()
}

/// Breadth-first search for ways between two nodes.
struct ReachabilitySearch<'s> {
    site: &'s RouteGraph,
    /// For each node the number of the search that found it last.
    found: Vec<u32>,
    count: u32,
}

impl<'s> ReachabilitySearch<'s> {
    fn new(site: &'s RouteGraph) -> Self {
        Self { site, found: vec![0; site.points.len()], count: 0 }
    }

    /// Whether a way leads from a node to another one over these atoms.
    fn leads(&mut self, from: usize, to: usize, open: impl Fn(usize) -> bool) -> bool {
        self.count += 1;
        self.found[from] = self.count;
        let mut left = VecDeque::from([from]);
        while self.found[to] != self.count
            && let Some(node) = left.pop_front()
        {
            for &atom in self.site.leaving[node].iter().filter(|&&atom| open(atom)) {
                let next = self.site.atoms[atom].ends[1];
                if std::mem::replace(&mut self.found[next], self.count) != self.count {
                    left.push_back(next);
                }
            }
        }
        self.found[to] == self.count
    }
}

/// The nodes that can be reached from one, or from which it can be, over these atoms.
pub(super) fn reached(site: &RouteGraph, from: usize, back: bool, open: impl Fn(usize) -> bool) -> Vec<bool> {
    let mut found = vec![false; site.points.len()];
    found[from] = true;
    let mut left = vec![from];
    while let Some(node) = left.pop() {
        let next = if back { &site.coming[node] } else { &site.leaving[node] };
        for &atom in next.iter().filter(|&&atom| open(atom)) {
            let other = site.atoms[atom].ends[usize::from(!back)];
            if !std::mem::replace(&mut found[other], true) {
                left.push(other);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lifelong::streets;

    /// Nodes and edges that cut others off, by looking at all nodes.
    #[test]
    fn what_is_found_near_a_node_holds_for_all() {
        for (count, radius) in [(2, 0.4), (4, 0.4), (4, 1.2), (4, 2.0)] {
            let mut imported = streets(count);
            imported.vehicle.radius = radius;
            // A street for both directions, so that some bridge is none.
            imported.layout.edges[0].ways = [true; 2];
            let site = RouteGraph::new(&imported).expect("a site");
            let nodes = strongest(&site, 0);
            assert_eq!(nodes.len(), count * count + 6 * count * (count - 1));
            let mut is_inside = vec![false; site.points.len()];
            nodes.iter().for_each(|&node| is_inside[node] = true);
            let mut search = ReachabilitySearch::new(&site);
            let found = nodes.iter().filter(|&&node| cuts_off(&mut search, &is_inside, node)).count();
            for &node in &nodes {
                let cuts = !is_open(&site, &nodes, &[node]);
                assert_eq!(cuts_off(&mut search, &is_inside, node), cuts, "{count}, {radius}: {node}");
            }
            assert!(found > 0 && (found < nodes.len() || radius > 1.0), "{found} of {}", nodes.len());
            let ends = Endpoints::of(&site, 1);
            // Corners of one-way streets have one edge in and one out, and are no dead ends.
            let dead = dead_ends(&site, &nodes);
            assert!(is_open(&site, &nodes, &ends.safe) && is_open(&site, &nodes, &dead), "{count}, {radius}: {dead:?}");
            let full = RemainingGraph::of(&site, &ends.nodes, &ends.safe).count;
            for &node in &ends.nodes {
                let standing: Vec<usize> = ends.safe.iter().chain([&node]).copied().collect();
                let lost = full - RemainingGraph::of(&site, &ends.nodes, &standing).count;
                assert_eq!(ends.harm(&site)[node], lost, "{count}, {radius}: {node}");
            }
            let cuts = |edge: usize| {
                [false, true].into_iter().any(|back| {
                    let found = reached(&site, nodes[0], back, |atom| site.atoms[atom].edge != Some(edge));
                    nodes.iter().any(|&node| !found[node])
                })
            };
            let edges =
                imported.layout.edges.iter().enumerate().filter(|(place, edge)| edge.is_two_way() && cuts(*place));
            let edges: Vec<usize> = edges.map(|edge| edge.0).collect();
            assert_eq!(bridges(&site, &is_inside), edges);
            assert!(!edges.is_empty());
        }
    }
}
