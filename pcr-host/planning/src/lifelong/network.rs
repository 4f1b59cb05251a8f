//! Where robots may go on a layout, and where they may end without being in anybody's way for good.

use crate::random::Random;
use pcr_formats::import::{Imported, Layout, Step, cheapest};
use pcr_formats::scenario::PathSegment;
use pcr_formats::scenario::Placed;

/// How often safe ends are looked for, from another order of nodes.
const DRAWS: usize = 100;

/// More than the discs need \[m\].
const ROOM: f64 = 1e-3;

/// Parts of an arc between which its distance from a node is taken.
const PARTS: u32 = 64;

/// A layout for robots of one size.
#[derive(Clone, Debug)]
pub(super) struct Network<'a> {
    pub(super) layout: &'a Layout,
    /// Nodes of the level that has most of them.
    pub(super) nodes: Vec<usize>,
    /// For each edge, the nodes that a robot there would touch a robot at.
    near: Vec<Vec<usize>>,
    /// Nodes where a robot may stand for good: all others can still be reached.
    pub(super) ends: Vec<usize>,
    /// Distance at which two robots touch \[m\].
    reach: f64,
}

impl<'a> Network<'a> {
    pub(super) fn new(imported: &'a Imported, seed: u64) -> Self {
        let Imported { layout, vehicle } = imported;
        let reach = 2.0 * (vehicle.radius + vehicle.margin) + ROOM;
        let level = layout.largest_level();
        let nodes: Vec<usize> = (0..layout.nodes.len()).filter(|&node| layout.nodes[node].level == level).collect();
        let near = layout.edges.iter().map(|edge| {
            let touched = |node: &usize| {
                let at = layout.nodes[*node].at;
                let curve = edge.curve.iter().map(|placed| distance_from(placed, at));
                curve.fold(f64::INFINITY, f64::min) < reach || edge.ends.contains(node)
            };
            nodes.iter().copied().filter(touched).collect()
        });
        let mut network = Self { layout, near: near.collect(), nodes, ends: Vec::new(), reach };
        network.ends = network.safe_ends(seed);
        network
    }

    pub(super) fn at(&self, node: usize) -> [f64; 2] {
        self.layout.nodes[node].at
    }

    /// Whether robots at two nodes would touch.
    pub(super) fn collide(&self, a: usize, b: usize) -> bool {
        let (a, b) = (self.at(a), self.at(b));
        (a[0] - b[0]).hypot(a[1] - b[1]) < self.reach
    }

    /// The cheapest way: a step costs its length, and `toll` for each of the nodes with robots that it passes.
    pub(super) fn way(&self, from: usize, to: usize, occupied: &[usize], toll: f64) -> Option<Vec<Step<'a>>> {
        let own: Vec<usize> = [from, to].to_vec();
        cheapest(self.layout, [from, to], |step| {
            let passed = occupied.iter().filter(|&&node| !own.contains(&node) && self.passes(step, node)).count();
            step.edge.length() + if passed > 0 { toll * passed as f64 } else { 0.0 }
        })
    }

    /// Whether a robot on the way would touch one at a node.
    pub(super) fn passes(&self, step: Step<'_>, node: usize) -> bool {
        let edge = self.layout.edges.iter().position(|edge| std::ptr::eq(edge, step.edge));
        edge.is_some_and(|edge| self.near[edge].contains(&node))
    }

    /// Nodes apart from one another such that all nodes can be reached from all others past robots that stand on them: those
    /// of them themselves with the robot there away. The largest set of those that were tried, dead ends first.
    fn safe_ends(&self, seed: u64) -> Vec<usize> {
        let mut random = Random(seed);
        let degree = |node: usize| self.layout.edges.iter().filter(|edge| edge.ends.contains(&node)).count();
        let mut best = Vec::new();
        for _ in 0..DRAWS {
            let mut candidates = random.shuffled(&self.nodes);
            candidates.sort_by_key(|&node| degree(node) > 1);
            let mut ends: Vec<usize> = Vec::new();
            for node in candidates {
                if ends.iter().any(|&end| self.collide(end, node)) {
                    continue;
                }
                ends.push(node);
                if !self.is_open(&ends) {
                    ends.pop();
                }
            }
            if ends.len() > best.len() {
                best = ends;
            }
        }
        best
    }

    /// Whether all nodes that robots at `ends` leave free can be reached from one another, and each of the ends with its own
    /// robot away. Nodes that they cover otherwise are lost: there must be none.
    fn is_open(&self, ends: &[usize]) -> bool {
        let free = |node: usize| ends.iter().all(|&end| !self.collide(end, node));
        let Some(&hub) = self.nodes.iter().find(|&&node| free(node)) else { return false };
        let open = |own: Option<usize>| -> Vec<(usize, usize)> {
            let kept = |k: &usize| {
                let blocked = |end: &usize| Some(*end) != own && self.near[*k].contains(end);
                !ends.iter().any(blocked)
            };
            let edges = (0..self.layout.edges.len()).filter(kept).map(|k| &self.layout.edges[k]);
            let steps = edges.flat_map(|edge| {
                let [a, b] = edge.ends;
                [Some((a, b)), edge.two_way.then_some((b, a))]
            });
            steps.flatten().collect()
        };
        let steps = open(None);
        let both =
            [reached(&steps, hub, self.layout.nodes.len(), false), reached(&steps, hub, self.layout.nodes.len(), true)];
        let strong = self.nodes.iter().all(|&node| !free(node) || both.iter().all(|reached| reached[node]));
        strong
            && ends.iter().all(|&end| {
                let steps = open(Some(end));
                [false, true].into_iter().all(|back| reached(&steps, hub, self.layout.nodes.len(), back)[end])
            })
            && self.nodes.iter().all(|&node| free(node) || ends.contains(&node))
    }
}

fn reached(steps: &[(usize, usize)], from: usize, nodes: usize, backward: bool) -> Vec<bool> {
    let mut onward = vec![Vec::new(); nodes];
    for &(a, b) in steps {
        let (a, b) = if backward { (b, a) } else { (a, b) };
        onward[a].push(b);
    }
    let mut found = vec![false; nodes];
    let mut open = vec![from];
    while let Some(node) = open.pop() {
        if !std::mem::replace(&mut found[node], true) {
            open.extend(&onward[node]);
        }
    }
    found
}

/// Distance of a point from a line or, within a little, from an arc \[m\].
fn distance_from(placed: &Placed, at: [f64; 2]) -> f64 {
    match placed.shape {
        PathSegment::Line { length } => {
            let [x, y] = [at[0] - placed.at[0], at[1] - placed.at[1]];
            let (sin, cos) = placed.heading.sin_cos();
            let along = (x * cos + y * sin).clamp(0.0, length);
            (x - along * cos).hypot(y - along * sin)
        }
        PathSegment::Arc { radius, sweep } => {
            let points = (0..=PARTS).map(|k| {
                let shape = PathSegment::Arc { radius, sweep: sweep * f64::from(k) / f64::from(PARTS) };
                let [x, y] = Placed { shape, ..*placed }.end();
                (x - at[0]).hypot(y - at[1])
            });
            points.fold(f64::INFINITY, f64::min) - radius * sweep.abs() / f64::from(2 * PARTS)
        }
    }
}
