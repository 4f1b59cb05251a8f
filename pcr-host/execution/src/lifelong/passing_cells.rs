//! Where two robots can be at the same time, whatever the others do: one on an edge, the other at a node or on another edge. On two
//! edges the lengths of both are a rectangle, in which both only go forward; a region of contact is passed on one side.
//!
//! An error is only possible to one side: two robots that cannot pass here cannot pass at all, but not all that can pass here can. Where several
//! regions have to be passed, each is looked at alone, turns of outlines hinder nobody, and regions that cannot be computed are left out.

use super::route_graph::RouteGraph;
use pcr_core::RegionRef;
use pcr_planning::fleet::build_ecm;
use std::collections::HashMap;
use std::rc::Rc;

/// Lengths that are not farther apart count as the same: far more than rounding, and far less than the room that bodies have for it \[m\].
const SAME: f64 = 1e-9;

/// Lengths from and to \[m\].
type LengthRange = [f64; 2];

/// How robots on two edges can go on. The ranges of the second one are counted along its edge.
#[derive(Debug, Default)]
pub(super) struct EdgePairCells {
    /// For each free range of the second robot while the first is at the node where its edge begins: the ranges where the second can
    /// be when the first sets off.
    pub(super) entries: Vec<Vec<usize>>,
    /// For each of these ranges: the free ranges of the second robot in which it can be when the first is at the end of its edge.
    /// First for those where the first robot came last, then for those where the second did.
    pub(super) exits: [Vec<Vec<usize>>; 2],
}

/// A region on the sides of the rectangle of two edges: lengths of the second while the first is at its start and its end, and lengths of
/// the first while the second is.
#[derive(Debug)]
struct RegionSides([[Vec<LengthRange>; 2]; 2]);

/// The cells of a site, computed when they are first needed.
#[derive(Debug)]
pub(super) struct PassingCells<'s> {
    pub(super) site: &'s RouteGraph,
    at_nodes: HashMap<[usize; 2], Rc<[LengthRange]>>,
    of_edges: HashMap<[usize; 2], Rc<EdgePairCells>>,
    nodes: HashMap<[usize; 2], bool>,
}

impl<'s> PassingCells<'s> {
    pub(super) fn new(site: &'s RouteGraph) -> Self {
        let (at_nodes, of_edges, nodes) = (HashMap::new(), HashMap::new(), HashMap::new());
        Self { site, at_nodes, of_edges, nodes }
    }

    /// Whether two robots can stand at two nodes, with some headings.
    pub(super) fn may_stand(&mut self, a: usize, b: usize) -> bool {
        let site = self.site;
        let is_free = || site.standing_at(a).any(|pose| site.standing_at(b).any(|other| !site.touch(pose, other)));
        a != b && *self.nodes.entry([a.min(b), a.max(b)]).or_insert_with(is_free)
    }

    /// The ranges of an edge where a robot can be while another one stands at a node, in increasing order.
    pub(super) fn beside(&mut self, edge: usize, node: usize) -> Rc<[LengthRange]> {
        if let Some(known) = self.at_nodes.get(&[edge, node]) {
            return known.clone();
        }
        let length = self.site.atoms[edge].length;
        let mut free: Vec<LengthRange> = self
            .site
            .standing_at(node)
            .flat_map(|pose| {
                let blocked = self.regions([edge, pose], |region| {
                    let it = region.length();
                    [it.lo, it.hi]
                });
                self.free(blocked, length)
            })
            .collect();
        free.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut found: Vec<LengthRange> = Vec::new();
        for range in free {
            match found.last_mut().filter(|last| range[0] <= last[1]) {
                Some(last) => last[1] = last[1].max(range[1]),
                None => found.push(range),
            }
        }
        let found: Rc<[LengthRange]> = found.into();
        self.at_nodes.insert([edge, node], found.clone());
        found
    }

    /// Whether a range of an edge contains its start.
    pub(super) fn begins(range: LengthRange) -> bool {
        range[0] <= SAME
    }

    /// Whether a range of an edge contains its end.
    pub(super) fn ends(&self, range: LengthRange, edge: usize) -> bool {
        range[1] >= self.site.atoms[edge].length - SAME
    }

    /// How robots on two edges can go on.
    pub(super) fn between(&mut self, first: usize, second: usize) -> Rc<EdgePairCells> {
        if let Some(known) = self.of_edges.get(&[first, second]) {
            return known.clone();
        }
        let pair = [first.min(second), first.max(second)];
        let durations = pair.map(|edge| self.site.atoms[edge].length + 1.0);
        let regions = self.regions(pair, |region| {
            let slice = |region: &RegionRef<'_, f64>, time: f64| -> Vec<LengthRange> {
                region.slice_at(time).map(|range| [range.lo, range.hi]).collect()
            };
            let swapped = region.clone().swapped();
            let of_second = [slice(&swapped, -1.0), slice(&swapped, durations[0])];
            RegionSides([of_second, [slice(region, -1.0), slice(region, durations[1])]])
        });
        for sides in [[0, 1], [1, 0]] {
            let cells = Rc::new(self.cells(sides.map(|side| pair[side]), sides, &regions));
            self.of_edges.insert(sides.map(|side| pair[side]), cells);
        }
        self.of_edges[&[first, second]].clone()
    }

    /// The cells of two edges; `sides` has the places of both in the regions.
    fn cells(&mut self, edges: [usize; 2], sides: [usize; 2], regions: &[RegionSides]) -> EdgePairCells {
        let lengths = edges.map(|edge| self.site.atoms[edge].length);
        // Lengths of the other robot while robot `robot` is at its start (0) or its end (1).
        let side = |region: &RegionSides, robot: usize, end: usize| region.0[sides[robot]][end].clone();
        let free = |robot: usize, end: usize| {
            let blocked = regions.iter().flat_map(|region| side(region, robot, end)).collect();
            self.free(blocked, lengths[1 - robot])
        };
        let (starts, ends) = ([free(0, 0), free(1, 0)], free(0, 1));
        let [before, after] = self.site.atoms[edges[0]].ends;
        let [before, after] = [before, after].map(|node| self.beside(edges[1], node));
        let meet = |range: &LengthRange, of: &[LengthRange]| -> Vec<usize> {
            (0..of.len()).filter(|&k| range[0] <= of[k][1] && of[k][0] <= range[1]).collect()
        };
        // For each region whether the first, and whether the second robot has to go first past it.
        let is_led_by = |from: (usize, &LengthRange), to: &LengthRange| {
            regions.iter().all(|region| {
                let [low, high] = [0, 1].map(|robot| [0, 1].map(|end| side(region, robot, end)));
                let [above, below] = parts(if from.0 == 0 { &low[0] } else { &high[0] }, from.1);
                let mut first = if from.0 == 0 { above } else { below || !low[0].is_empty() };
                let mut second = if from.0 == 0 { below || !high[0].is_empty() } else { above };
                let [above, below] = parts(&low[1], to);
                first |= above || !high[1].is_empty();
                second |= below;
                !(first && second)
            })
        };
        let exits = [0, 1].map(|robot| {
            let exits = starts[robot].iter().map(|from| {
                let mut found: Vec<usize> =
                    ends.iter().filter(|to| is_led_by((robot, from), to)).flat_map(|to| meet(to, &after)).collect();
                found.sort_unstable();
                found.dedup();
                found
            });
            exits.collect()
        });
        EdgePairCells { entries: before.iter().map(|range| meet(range, &starts[0])).collect(), exits }
    }

    /// Something of each region of two atoms.
    fn regions<T>(&self, pair: [usize; 2], of: impl Fn(&RegionRef<'_, f64>) -> T) -> Vec<T> {
        if !self.site.touch(pair[0], pair[1]) {
            return Vec::new();
        }
        let motions = pair.map(|atom| self.site.motion(atom));
        let [Ok(first), Ok(second)] = motions else { return Vec::new() };
        let motions = [first, second];
        let Ok(ecm) = build_ecm(&motions) else { return Vec::new() };
        let regions = ecm.pair(&motions, 0, 1);
        regions.map(|regions| regions.map(|region| of(&region)).collect()).unwrap_or_default()
    }

    /// The ranges of an edge that are not blocked, in increasing order.
    fn free(&self, mut blocked: Vec<LengthRange>, length: f64) -> Vec<LengthRange> {
        if blocked.is_empty() {
            return vec![[0.0, length]];
        }
        blocked.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let (mut found, mut from) = (Vec::new(), 0.0);
        for [lo, hi] in blocked.into_iter().chain([[length; 2]]) {
            if lo - from > SAME {
                found.push([from, lo]);
            }
            from = f64::max(from, hi);
        }
        found
    }
}

/// Whether some of the ranges are above another one, and whether some are below it.
fn parts(ranges: &[LengthRange], other: &LengthRange) -> [bool; 2] {
    let middle = |range: &LengthRange| range[0] + range[1];
    let is = |above: bool| ranges.iter().any(|range| (middle(range) > middle(other)) == above);
    [is(true), is(false)]
}
