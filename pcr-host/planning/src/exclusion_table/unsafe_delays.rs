//! Unsafe delays: differences of start times at which two vehicles on two edges touch, and times at which a vehicle at a
//! node touches one on an edge. Planners of the CCBS and SIPP families compute such delays for each pair that they
//! consider.
//!
//! Both vehicles are on their edges from their start until they arrive; before and after that they stand at a node. An
//! edge that may be travelled in both directions counts as two *ways*. A way also has delays with itself, for two
//! vehicles that follow each other.
//!
//! Straight ways of discs at constant speed have a closed form (`straight`); for all others the library brackets the ends. An outline turns at
//! nodes before it departs, or after it has arrived.

mod proof;

use super::area_pair_search::{PIECES, SyncProgressFn, in_stretches};
use super::edge_traversals::EdgeTraversals;
use super::straight_edges::StraightEdge;
use super::swept_areas::straight_ends;
use super::{edges_by_id, nodes_by_id};
use crate::agent_regions::{BoxGrid, area};
use crate::bodies::{Body, BodyFleet};
use crate::checker_input::{self, outlines};
use crate::fleet::Fleet;
use crate::memory_budget;
use crate::parallel;
use pcr_core::{CapacityError, Interval, Motion, Piece, RegionRef, overlaps, union};
use pcr_formats::import::{self, ElementId, ImportError, ImportedLayout, LayoutEdge, RouteStep, VehicleTraits};
use pcr_formats::scenario::{Agent, MotionSpec, Scenario, label};
pub(crate) use proof::ForbiddenDelays;
pub use proof::{DelayApproach, DelayProof};
use serde::Serialize;
use std::ops::Range;

/// Number of agents that are built at a time.
const STRETCH: usize = 1 << 12;

/// How edges are driven.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EdgeDriving {
    /// Largest speed \[m/s\]; the limits of an edge, of speed and of rotation in its arcs, apply if they are lower.
    pub speed: f64,
    /// Largest acceleration \[m/s²\]: edges are driven from rest to rest. `None`: at constant speed from end to end.
    pub acceleration: Option<f64>,
}

/// An edge in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectedEdge {
    /// Id of the edge in the layout.
    pub edge: ElementId,
    /// Whether it leads from the end of the edge to its start.
    pub backward: bool,
}

/// What is unsafe. Numbers are indices into [`UnsafeDelayModel::ways`] and [`UnsafeDelayModel::nodes`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum UnsafeRelation {
    /// Two ways, in the order of their indices, and the range of start times on the second minus start times on the first at which
    /// two vehicles touch \[s\].
    Delays([usize; 2], [f64; 2]),
    /// A node and a way, and the times after the start on the way at which no other vehicle may stand at the node \[s\].
    Times(usize, usize, [f64; 2]),
    /// Two nodes at which vehicles touch.
    Nodes([usize; 2]),
}

/// The ways of a layout, its nodes if requested, and which of them can touch.
pub struct UnsafeDelayModel {
    ways: Vec<DirectedEdge>,
    nodes: Vec<ElementId>,
    /// Indices of ways, then of nodes.
    levels: Vec<[usize; 2]>,
    straight: Vec<Option<StraightEdge>>,
    points: Vec<[f64; 2]>,
    /// How far from each of these a vehicle may stand \[m\].
    beside: Vec<f64>,
    /// Sum of the radii of two vehicles on straight ways \[m\].
    reach: f64,
    /// The bodies of ways, then of nodes; none if all ways are straight and driven at constant speed by a disc.
    fleet: Fleet<f64>,
    /// For each way and node its bodies in the fleet: several if its outline is concave.
    bodies: Vec<Range<usize>>,
    areas: Vec<[f64; 4]>,
}

impl UnsafeDelayModel {
    /// The unsafe delays of the vehicle with its margin.
    ///
    /// # Errors
    /// [`ImportError`] for an outline that turns in place on an edge in no time, and for coordinates, speeds and durations beyond what can be
    /// computed with.
    pub fn new(imported: &ImportedLayout, driving: EdgeDriving, nodes: bool) -> Result<Self, ImportError> {
        let (layout, rides) = (&imported.layout, EdgeTraversals::new(imported));
        layout.one_speed()?;
        let has_outline = rides.vehicle().footprint.is_some();
        let steps: Vec<RouteStep<'_>> = edges_by_id(layout).into_iter().flat_map(LayoutEdge::steps).collect();
        let places = if nodes { nodes_by_id(layout) } else { Vec::new() };
        let level = |node: usize| layout.level_of(node);
        let on_edges = steps.iter().map(|step| step.edge.ends.map(level));
        let mut all = Self {
            ways: steps
                .iter()
                .map(|step| DirectedEdge { edge: step.edge.id.clone(), backward: step.backward })
                .collect(),
            nodes: places.iter().map(|&node| layout.nodes[node].id.clone()).collect(),
            levels: on_edges.chain(places.iter().map(|&node| [level(node); 2])).collect(),
            straight: Vec::new(),
            points: places.iter().map(|&node| layout.nodes[node].point).collect(),
            beside: places.iter().map(|&node| rides.node_tolerance(node)).collect(),
            reach: 2.0 * rides.vehicle().radius,
            fleet: Fleet::new(&Scenario::default()).map_err(|refused| ImportError::new(refused.to_string()))?,
            bodies: Vec::new(),
            areas: Vec::new(),
        };
        let speed = |step: RouteStep<'_>| step.steady(driving.speed);
        all.straight = steps
            .iter()
            .map(|step| {
                let is_steady = driving.acceleration.is_none() && !has_outline;
                let [from, to] = straight_ends(layout, step.edge).filter(|_| is_steady)?;
                let [from, to] = if step.backward { [to, from] } else { [from, to] };
                StraightEdge::new(from, to, speed(*step))
            })
            .collect();
        if all.straight.iter().all(Option::is_some) {
            let half = 0.5 * all.reach;
            let ends = all.straight.iter().flatten().map(StraightEdge::ends);
            let ends = ends.chain(all.points.iter().map(|&at| [at; 2]));
            all.areas = ends.map(|ends| around(ends, half)).collect();
            return Ok(all);
        }
        let vehicle = |step: RouteStep<'_>| VehicleTraits {
            speed: driving.speed,
            acceleration: driving.acceleration.unwrap_or(rides.vehicle().acceleration),
            ..rides.facing(step).clone()
        };
        let agent = |place: usize| {
            let Some(&step) = steps.get(place) else { return Ok(rides.at_node(places[place - steps.len()]).agent) };
            let agent = rides.along_with(&vehicle(step), step);
            if agent.footprint.is_some() && agent.turns_in_place() && driving.acceleration.is_none() {
                let problem = "its outline turns in place there, which takes no time at constant speed";
                return Err(ImportError::new(format!("edge {}: {problem}; give --acceleration", step.edge.id)));
            }
            Ok(driven(agent, step.edge, driving, speed(step)))
        };
        let units: Vec<usize> = (0..all.levels.len()).collect();
        for stretch in units.chunks(STRETCH) {
            let parts: Vec<&[usize]> = stretch.chunks(64).collect();
            let fleets = parallel::map_parallel(0..parts.len(), &|part| {
                let units = parts[part];
                let agents = units.iter().map(|&unit| Ok(Agent { id: unit as u64, ..agent(unit)? }));
                let scenario = import::checked(&Scenario::new("", agents.collect::<Result<_, ImportError>>()?))?;
                let (fleet, bodies, parts) =
                    BodyFleet::<f64>::moving(&scenario).map_err(|refused| ImportError::new(refused.to_string()))?;
                // What is computed, and proved, is about these motions.
                let ids: Vec<u64> = parts.agents.iter().map(|agent| agent.id).collect();
                let motions = fleet.motions();
                let held = checker_input::agents(&fleet, &motions, &ids);
                if motions.iter().any(outlines::is_body) {
                    outlines::as_given::<f64>(&parts, &held, &outlines::bodies(&fleet, held.clone(), &motions))
                } else {
                    checker_input::as_given::<f64>(&parts, &held)
                }
                .map_err(|misread| ImportError::new(misread.to_string()))?;
                drop(motions);
                let counts = bodies.chunk_by(|a, b| a.agent == b.agent).map(<[Body]>::len).collect::<Vec<_>>();
                Ok((fleet, counts))
            });
            for made in fleets {
                let (fleet, counts) = made?;
                let mut areas = fleet.motions().iter().map(area).collect::<Vec<_>>().into_iter();
                for count in counts {
                    let first = all.bodies.last().map_or(0, |bodies| bodies.end);
                    all.bodies.push(first..first + count);
                    all.areas.extend(areas.by_ref().take(count).reduce(joint));
                }
                all.fleet.append(fleet);
            }
        }
        Ok(all)
    }

    /// The ways, sorted by their edges, forward before backward.
    pub fn ways(&self) -> &[DirectedEdge] {
        &self.ways
    }

    /// The nodes, sorted by their ids; empty if they were not requested.
    pub fn nodes(&self) -> &[ElementId] {
        &self.nodes
    }

    /// Calls `make` for each result, on all cores, and passes its values to `take`: for each way the results with itself and
    /// with later ways, then with nodes; at last pairs of nodes. Intervals of one pair are disjoint, in increasing order.
    ///
    /// # Errors
    /// Errors of `take`, and [`ImportError`] for a pair that does not fit in memory.
    pub fn each<T: Send, E: From<ImportError>>(
        &self,
        told: SyncProgressFn<'_>,
        make: &(dyn Fn(&[UnsafeRelation]) -> T + Sync),
        take: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        let grid = BoxGrid::new(self.areas.clone());
        let (counts, motions) = (grid.counts(), self.fleet.motions());
        let row = |unit: usize| {
            let (mut near, mut found) = (Vec::new(), Vec::new());
            grid.after(unit, &mut near);
            let own = (unit < self.ways.len()).then_some(unit);
            for other in own.into_iter().chain(near.iter().map(|&other| other as usize)) {
                if !self.share_a_level([unit, other]) {
                    continue;
                }
                self.pair([unit, other], &motions, &mut found)?;
            }
            Ok(make(&found))
        };
        in_stretches(self.levels.len(), |unit| 1 + counts[unit] as usize, told, &row, take)
    }

    /// The results of two units, in the order of their indices.
    fn pair(
        &self,
        [a, b]: [usize; 2],
        motions: &[Motion<'_, f64>],
        found: &mut Vec<UnsafeRelation>,
    ) -> Result<(), ImportError> {
        let ways = self.ways.len();
        let point = |unit: usize| self.points[unit - ways];
        if a >= ways {
            let [[x, y], [u, v]] = [point(a), point(b)];
            let reach = self.reach + self.beside[a - ways] + self.beside[b - ways];
            let slack = 8.0 * f64::EPSILON * (x.abs() + y.abs() + reach);
            if (x - u).hypot(y - v) <= reach + slack {
                found.push(UnsafeRelation::Nodes([a - ways, b - ways]));
            }
            return Ok(());
        }
        let other = self.straight.get(b).copied().flatten();
        match (self.straight[a], other) {
            (Some(own), Some(other)) => {
                found.extend(own.delays(&other, self.reach).map(|delays| UnsafeRelation::Delays([a, b], delays)));
                return Ok(());
            }
            (Some(own), None) if b >= ways => {
                let reach = self.reach + self.beside[b - ways];
                found.extend(own.times_at(point(b), reach).map(|times| UnsafeRelation::Times(b - ways, a, times)));
                return Ok(());
            }
            _ => {}
        }
        let of = |unit: usize| self.bodies.get(unit).and_then(|bodies| motions.get(bodies.clone()));
        let (Some(own), Some(their)) = (of(a), of(b)) else {
            return Err(ImportError::new(format!("{} and {}: no motions", self.name(a), self.name(b))));
        };
        let mut all = Vec::new();
        for (own, their) in own.iter().flat_map(|own| their.iter().map(move |their| (own, their))) {
            self.regions(own, their, [a, b], |region| {
                all.push(if b < ways {
                    // `passing_delays` delays the ego, which is on the first way; hence the changed sign.
                    let Interval { lo, hi } = region.passing_delays();
                    Interval::new(-hi, -lo)
                } else {
                    // A vehicle that hardly moves may be at a length much earlier than it is computed to be.
                    let Interval { lo, hi } = region.length();
                    own.time_in(Interval::new(lo - own.lag(), hi + own.lag()))
                });
            })?;
        }
        found.extend(union(all.into_iter()).map(|Interval { lo, hi }| match b < ways {
            true => UnsafeRelation::Delays([a, b], [lo, hi]),
            false => UnsafeRelation::Times(b - ways, a, [lo, hi]),
        }));
        Ok(())
    }

    /// The regions of two motions.
    fn regions(
        &self,
        own: &Motion<'_, f64>,
        their: &Motion<'_, f64>,
        units: [usize; 2],
        mut found: impl FnMut(&RegionRef<'_, f64>),
    ) -> Result<(), ImportError> {
        let mut pieces = vec![Piece::EMPTY; PIECES];
        while let Err(full) = overlaps(own, their, &mut pieces, &mut found) {
            let names = units.map(|unit| self.name(unit));
            if !matches!(full, CapacityError::Pieces { .. }) {
                let problem = "more than 32767 pieces (pairs of segments within reach of one another)";
                return Err(ImportError::new(format!("{} and {}: {problem}", names[0], names[1])));
            }
            let bytes = 2 * (pieces.len() * size_of::<Piece<f64>>()) as u64;
            memory_budget::ask(bytes, || "a pair of edges".into())
                .map_err(|large| ImportError::new(large.to_string()))?;
            pieces.resize(2 * pieces.len(), Piece::EMPTY);
        }
        Ok(())
    }

    fn share_a_level(&self, [a, b]: [usize; 2]) -> bool {
        self.levels[b].iter().any(|level| self.levels[a].contains(level))
    }

    fn name(&self, unit: usize) -> String {
        let node = || self.nodes.get(unit - self.ways.len()).map(ElementId::to_string);
        self.ways.get(unit).map(|way| way.edge.to_string()).or_else(node).unwrap_or_default()
    }
}

/// The agent of a way, as it is driven.
fn driven(agent: Agent, edge: &LayoutEdge, driving: EdgeDriving, speed: f64) -> Agent {
    let (length, whole) = (agent.length(), edge.length());
    let motion = match driving.acceleration {
        None if length > 0.0 => MotionSpec::profile(speed, [(length / speed, 0.0)]),
        // A line too short to have a direction is replaced by a larger radius, but takes time all the same.
        acceleration if length == 0.0 && whole > 0.0 => {
            let ramps =
                acceleration.map_or(0.0, |acceleration| (speed / acceleration).min((whole / acceleration).sqrt()));
            MotionSpec::profile(0.0, [((whole / speed).max(ramps) + ramps, 0.0)])
        }
        _ => agent.motion,
    };
    Agent { label: label(&edge.id.to_string()), motion, ..agent }
}

/// The box around two boxes.
fn joint(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]
}

/// The box around a segment, enlarged by a reach \[m\] and its rounding.
fn around([[x, y], [u, v]]: [[f64; 2]; 2], reach: f64) -> [f64; 4] {
    let reach = reach + 64.0 * f64::EPSILON * (x.abs().max(u.abs()) + y.abs().max(v.abs()) + reach);
    [x.min(u) - reach, y.min(v) - reach, x.max(u) + reach, y.max(v) + reach]
}
