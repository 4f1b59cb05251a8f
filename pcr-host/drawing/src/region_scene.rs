//! Data that all pictures of a scenario share: motions, regions with their outlines, colours and spans.

use super::contour::{RegionOutline, trace};
use super::layout::LayoutLevelView;
use super::palette::{Colour, colour};
use pcr_core::{Aabb, Crossing, Encounter, Interval, Motion, PieceRef, PieceType, Pose, Radians, RegionRef, crossings};
use pcr_formats::plane_geometry::wrapped;
use pcr_formats::scenario::{Agent, KINK, Scenario};
use pcr_planning::fleet::HostEcm;
use std::collections::HashMap;

/// A fleet with its regions.
pub(super) struct RegionScene<'a> {
    pub(super) scenario: &'a Scenario,
    pub(super) motions: &'a [Motion<'a, f64>],
    pub(super) ecm: &'a HostEcm<f64>,
    /// Places in the scenario of the agents whose maps are drawn, in order; none for all of them.
    pub(super) egos: Option<&'a [usize]>,
    /// What the agents travel on.
    pub(super) ground: Option<LayoutLevelView<'a>>,
}

/// A region as the pictures show it.
#[derive(Clone, Debug)]
pub(super) struct DrawnRegion {
    /// Place of the other agent in the scenario.
    pub(super) other: usize,
    /// While the other agent is on its way \[s\].
    pub(super) time: Interval<f64>,
    /// Along the ego's path \[m\].
    pub(super) length: Interval<f64>,
    pub(super) outline: RegionOutline,
    /// Lengths along the ego's path \[m\] that are taken while the other agent stands at its start.
    pub(super) before: Vec<Interval<f64>>,
    /// The same for its end.
    pub(super) after: Vec<Interval<f64>>,
    /// Slices at some times in between, for labels.
    pub(super) slices: Vec<(f64, Interval<f64>)>,
    /// Types of the pieces, without repetition.
    pub(super) types: Vec<PieceType>,
    /// Number of pieces.
    pub(super) pieces: usize,
    /// The crossings of the paths within the region, of which the paper gives the descriptor.
    pub(super) crossings: Vec<Crossing<f64>>,
}

/// Characters of a number and a label that pictures show.
const LONGEST: usize = 32;

/// Slices of a region among which a place for its label is sought.
const LABEL_SLICES: usize = 15;

impl RegionScene<'_> {
    /// Number of the agent at this place of the scenario.
    pub(super) fn id(&self, place: usize) -> u64 {
        self.scenario.agents[place].id
    }

    /// The number of the agent at this place of the scenario and what it is called, shortened.
    pub(super) fn display_name(&self, place: usize) -> String {
        let Some(agent) = self.scenario.agents.get(place) else { return String::new() };
        let called = agent.display_name();
        match called.char_indices().nth(LONGEST) {
            Some((end, _)) => format!("{}…", called.get(..end).unwrap_or_default()),
            None => called,
        }
    }

    /// The polygon of the agent at this place of the scenario, or the convex hull of all outlines of an agent with loads; empty of a disc.
    pub(super) fn polygon(&self, place: usize) -> Vec<[f64; 2]> {
        let agent = self.scenario.agents.get(place).filter(|agent| agent.loads.is_empty());
        match agent.and_then(|agent| agent.footprint.as_ref()) {
            Some(footprint) => footprint.polygon().to_vec(),
            None => {
                let corners = self.motions.get(place).map_or(&[][..], |motion| motion.outline().corners());
                corners.iter().map(|corner| [corner.at().x, corner.at().y]).collect()
            }
        }
    }

    /// The angle from the direction of travel to the heading of an agent \[rad\], at the start of each segment of its motion; empty if the two are
    /// always the same.
    pub(super) fn facings(&self, place: usize) -> Vec<f64> {
        let agent = self.scenario.agents.get(place).filter(|agent| agent.changes_facing() || agent.has_steady_arcs());
        let (Some(agent), Some(motion)) = (agent, self.motions.get(place)) else { return Vec::new() };
        // The direction of travel turns where the angle changes, and nowhere else without a length: an outline stands and turns.
        let (mut direction, mut facing) = (agent.start[2], 0.0);
        let segments = motion.path().segments().iter().map(|segment| {
            let turned = wrapped(segment.heading_at(0.0).0 - direction);
            if turned.abs() > KINK {
                facing -= turned;
            }
            direction = segment.heading_at(segment.length()).0;
            let at_start = facing;
            if segment.is_steady() {
                facing -= direction - segment.heading_at(0.0).0;
            }
            at_start
        });
        segments.collect()
    }

    /// Where an agent is at a length of its path \[m\], with the heading of its body.
    pub(super) fn pose_at(&self, place: usize, length: f64) -> Option<Pose<f64>> {
        let motion = self.motions.get(place)?;
        let Pose { position, heading } = motion.path().pose_at(length);
        let segments = motion.path().segments();
        let after = segments.partition_point(|segment| segment.from() <= length).saturating_sub(1);
        let facing = self.facings(place).get(after).copied().unwrap_or_default();
        let steady = segments.get(after).filter(|segment| segment.is_steady());
        let direction = steady.map_or(heading, |segment| segment.heading_at(0.0));
        Some(Pose { position, heading: Radians(direction.0 + facing) })
    }

    /// Whether an agent is more than one convex outline: maps show the regions of convex hulls.
    pub(super) fn has_hulls(&self) -> bool {
        self.scenario.agents.iter().any(Agent::has_parts)
    }

    /// Colour of the agent at this place of the scenario.
    pub(super) fn colour(&self, place: usize) -> Colour {
        colour(place)
    }

    /// From the first start to the last arrival \[s\].
    pub(super) fn horizon(&self) -> Interval<f64> {
        let times = self.motions.iter().map(Motion::time);
        times.reduce(Interval::hull).unwrap_or(Interval::new(0.0, 1.0))
    }

    /// Box around all agents on all paths, and around the ground \[m\].
    pub(super) fn bounds(&self) -> Aabb<f64> {
        let grown = self.motions.iter().map(|motion| {
            let (Aabb { x, y }, r) = (motion.bounds(), motion.outline().reach());
            Aabb { x: Interval::new(x.lo - r, x.hi + r), y: Interval::new(y.lo - r, y.hi + r) }
        });
        let unit = Interval::new(-1.0, 1.0);
        let ground = self.ground.iter().map(LayoutLevelView::bounds).map(|[x, y]| Aabb { x, y });
        grown.chain(ground).reduce(Aabb::hull).unwrap_or(Aabb { x: unit, y: unit })
    }

    /// Places of the agents whose maps are drawn.
    pub(super) fn egos(&self) -> impl DoubleEndedIterator<Item = usize> {
        let all = if self.egos.is_some() { 0..0 } else { 0..self.motions.len() };
        self.egos.into_iter().flatten().copied().chain(all)
    }

    /// Number of regions of an ego.
    pub(super) fn count(&self, ego: usize) -> usize {
        self.ecm.row(self.motions, ego).expect("the table of the fleet").count()
    }

    /// The points, time \[s\] and length \[m\], at which the motion of an ego enters one of these regions: the begin of each conflict.
    pub(super) fn entries(&self, ego: usize, shapes: &[DrawnRegion]) -> Vec<[f64; 2]> {
        let Some(motion) = self.motions.get(ego) else { return Vec::new() };
        let mut others: Vec<usize> = shapes.iter().map(|shape| shape.other).collect();
        others.dedup();
        let others = others.into_iter().filter_map(|other| self.motions.get(other));
        let begins = others.flat_map(|other| Encounter::new(motion, other).contacts(self.horizon()));
        begins.map(|time| [time.lo, motion.length_at(time.lo)]).collect()
    }

    /// The regions of an ego, traced for pixels of this size \[s\], \[m\].
    pub(super) fn shapes(&self, ego: usize, pixel: [f64; 2]) -> Vec<DrawnRegion> {
        let Some(motion) = self.motions.get(ego) else {
            return Vec::new();
        };
        let mut all = Crossings::new();
        let mut of = None;
        let shape = |region: RegionRef<'_, f64>| {
            if of != Some(region.other()) {
                of = Some(region.other());
                all = by_segments(crossings(motion, region.other_motion()));
            }
            DrawnRegion::new(&region, motion, &all, pixel)
        };
        self.ecm.row(self.motions, ego).expect("the table of the fleet").map(shape).collect()
    }
}

/// The crossings of two paths with their places in the order of all, by the segments that cross.
type Crossings = HashMap<[usize; 2], Vec<(usize, Crossing<f64>)>>;

fn by_segments(crossings: impl Iterator<Item = Crossing<f64>>) -> Crossings {
    let mut all = Crossings::new();
    for (place, crossing) in crossings.enumerate() {
        all.entry(crossing.segments).or_default().push((place, crossing));
    }
    all
}

impl DrawnRegion {
    fn new(region: &RegionRef<'_, f64>, ego: &Motion<'_, f64>, all: &Crossings, pixel: [f64; 2]) -> Self {
        let time = region.time();
        let travel = region.other_motion().time();
        let strip = |open: bool, at: f64| if open { region.slice_at(at).collect() } else { Vec::new() };
        let mut types: Vec<PieceType> = Vec::new();
        for piece in region.pieces() {
            if !types.contains(&piece.piece_type()) {
                types.push(piece.piece_type());
            }
        }
        let inside = |piece: PieceRef<'_, f64>| {
            let those = all.get(&piece.segments).into_iter().flatten();
            let held = move |(_, crossing): &&(usize, Crossing<f64>)| {
                piece.length.contains(crossing.length) && piece.other_length.contains(crossing.other_length)
            };
            those.filter(held).copied()
        };
        let mut crossings: Vec<(usize, Crossing<f64>)> = region.pieces().flat_map(inside).collect();
        // A crossing may be in two pieces.
        crossings.sort_by_key(|(place, _)| *place);
        crossings.dedup_by_key(|(place, _)| *place);
        let slices = (0..LABEL_SLICES).flat_map(|k| {
            let part = (k as f64 + 0.5) / LABEL_SLICES as f64;
            let at = time.lo + part * time.length();
            region.slice_at(at).map(move |interval| (at, interval))
        });
        Self {
            other: region.other(),
            time,
            length: region.length(),
            outline: trace(region, ego, pixel),
            before: strip(region.is_open_at_start(), travel.lo),
            after: strip(region.is_open_at_end(), travel.hi),
            slices: slices.collect(),
            types,
            pieces: region.pieces().count(),
            crossings: crossings.into_iter().map(|(_, crossing)| crossing).collect(),
        }
    }
}
