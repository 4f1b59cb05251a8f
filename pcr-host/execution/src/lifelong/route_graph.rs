//! A layout for lifelong runs: pieces of way from node to node, and how robots on two of them touch. Data that depend
//! only on the layout and the robot are computed once, when they are first needed.
//!
//! A disc stands where it turns. Any other outline sweeps an area: then a turn at a node is an element of its own, and
//! so is each heading with which a robot stands there.
//!
//! A fleet of several types of vehicles has a layer for each type: all nodes and edges once more, for its body. Robots never change
//! their layer; those of different layers touch as their bodies do.

use super::gates::ElementContact;
use super::kinematic_limits::KinematicLimits;
use super::route_element::{ElementMaker, RouteElement, STRAIGHT};
use crate::error::ExecutionError;
use pcr_core::{InvalidInput, Motion};
use pcr_formats::import::{Facing, ImportedLayout, Layout, RouteStep, VehicleTraits};
use pcr_formats::plane_geometry::wrapped;
use pcr_formats::scenario::PathSegment;
use pcr_planning::fleet::ConvexBody;
use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::rc::Rc;

/// Additional radius of discs, for rounding \[m\].
const ROOM: f64 = 1e-4;

/// Number of gaps between edges, each as large as the largest one, that one window of a certificate is assumed to contain.
const GAPS: f64 = 4.0;

/// Step of the first robot between two gates, in radii.
const PITCH: f64 = 2.0;

/// A type of vehicles on a layout, and the edges of the layout that it may use.
#[derive(Clone, Debug)]
pub(super) struct VehicleLayer {
    pub(super) vehicle: VehicleTraits,
    /// Indices of edges in the layout that are forbidden to it.
    pub(super) forbidden: Vec<usize>,
}

impl VehicleLayer {
    /// Whether both are of vehicles that drive alike.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        let numbers = |it: &VehicleTraits| {
            [it.radius, it.margin, it.speed, it.acceleration, it.rotation, it.rotation_acceleration]
        };
        let [own, its] = [&self.vehicle, &other.vehicle];
        numbers(own) == numbers(its) && own.footprint == its.footprint && self.forbidden == other.forbidden
    }
}

/// The bodies of the robots of a layer.
#[derive(Clone, Debug)]
pub(super) struct LayerBody {
    /// The vehicle as the edges let it face.
    pub(super) vehicle: VehicleTraits,
    /// The robot, without margins.
    pub(super) shape: ConvexBody,
    /// The robot with margins and the error of curves.
    body: ConvexBody,
}

/// The elements of an outline at a node.
#[derive(Clone, Debug, Default)]
struct NodeElements {
    /// A robot that stands with a heading \[rad\]; the first one is that of [`RouteGraph::standing`].
    poses: Vec<(f64, usize)>,
    /// A turn from a heading to another one \[rad\].
    turns: Vec<([f64; 2], usize)>,
}

impl NodeElements {
    fn all(&self) -> impl Iterator<Item = usize> {
        self.poses.iter().map(|pose| pose.1).chain(self.turns.iter().map(|turn| turn.1))
    }
}

/// A layout for robots of one type, or of several types.
#[derive(Debug)]
pub(super) struct RouteGraph {
    pub(super) points: Vec<[f64; 2]>,
    /// All atoms: edges in their directions, then the nodes, then further headings and turns at nodes.
    pub(super) atoms: Vec<RouteElement>,
    /// Number of edges in their directions.
    pub(super) edges: usize,
    /// For each node its elements beyond the edges; none for discs.
    at_nodes: Vec<NodeElements>,
    /// For each node the atoms that begin there.
    pub(super) leaving: Vec<Vec<usize>>,
    /// For each node the atoms that end there.
    pub(super) coming: Vec<Vec<usize>>,
    /// Indices of the nodes of the level; missions are among these.
    pub(super) nodes: Vec<usize>,
    /// For each atom the same edge in the other direction.
    pub(super) back: Vec<Option<usize>>,
    /// For each atom the atoms on which a robot may touch one on it.
    touching_elements: Vec<Vec<usize>>,
    /// Bound on the error of curves, and on the distance of their ends from nodes \[m\].
    pub(super) position_error: f64,
    /// Whether outlines come to rest before and after turns at nodes.
    pub(super) stops_at_turns: bool,
    /// The bodies of each layer.
    pub(super) layers: Vec<LayerBody>,
    /// The contact of each pair of `near`, at the same indices, computed when it is first needed.
    contacts: Vec<Vec<OnceCell<Option<Box<ElementContact>>>>>,
    covers: RefCell<HashMap<usize, Rc<[usize]>>>,
}

/// A node, and the heading with which a robot stands there.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeparturePose {
    pub(super) node: usize,
    /// Heading of the robot, if it is known \[rad\].
    pub(super) heading: Option<f64>,
}

impl RouteGraph {
    /// The site of the level with the most nodes.
    ///
    /// # Errors
    /// An edge that is not a path.
    pub(super) fn new(imported: &ImportedLayout) -> Result<Self, ExecutionError> {
        let ImportedLayout { layout, vehicle } = imported;
        Self::layered(layout, &[VehicleLayer { vehicle: vehicle.clone(), forbidden: Vec::new() }])
    }

    /// The site with a layer for each type of vehicles.
    ///
    /// # Errors
    /// An edge that is not a path.
    pub(super) fn layered(layout: &Layout, layers: &[VehicleLayer]) -> Result<Self, ExecutionError> {
        let level = layout.largest_level();
        let count = layout.nodes.len();
        let points: Vec<[f64; 2]> = layers.iter().flat_map(|_| layout.nodes.iter().map(|node| node.point)).collect();
        let nodes: Vec<usize> = (0..points.len()).filter(|&node| layout.nodes[node % count].level == level).collect();
        let mut atoms = Vec::new();
        let mut off = 0.0_f64;
        let mut makers = Vec::new();
        for (layer, VehicleLayer { vehicle, forbidden }) in layers.iter().enumerate() {
            let open = layout.edges.iter().enumerate();
            let open = open.filter(|(place, edge)| !edge.closed && !forbidden.contains(place));
            let steps = open.flat_map(|(place, edge)| edge.steps().map(move |step| (place, step)));
            let steps: Vec<(usize, RouteStep<'_>)> = steps
                .filter(|(_, step)| {
                    [step.origin(), step.target()].iter().all(|&node| layout.nodes[node].level == level)
                })
                .collect();
            let (vehicle, is_known) = faced(vehicle, steps.iter().map(|(_, step)| step.facing()));
            let shape = ConvexBody::of_vehicle(vehicle.footprint.as_ref(), vehicle.radius);
            let shape = shape.map_err(ExecutionError::Outline)?;
            let maker = ElementMaker { layout, vehicle, shape, layer, is_known };
            for (place, step) in steps {
                let mut atom = maker
                    .along(step, place)
                    .map_err(|invalid| ExecutionError::Edge(layout.edges[place].id.to_string(), invalid))?;
                off = off.max(step.deviation() + maker.vehicle.moved_by(step.turned()) + atom.gap(&points));
                atom.ends = atom.ends.map(|node| layer * count + node);
                atoms.push(atom);
            }
            makers.push(maker);
        }
        let edges = atoms.len();
        let (mut leaving, mut coming) = (vec![Vec::new(); points.len()], vec![Vec::new(); points.len()]);
        for (place, atom) in atoms.iter().enumerate() {
            leaving[atom.ends[0]].push(place);
            coming[atom.ends[1]].push(place);
        }
        let at_nodes = at_nodes(&makers, &mut atoms, &points, [&coming, &leaving]);
        let at_nodes = at_nodes.map_err(ExecutionError::Node)?;
        let gaps = atoms.iter().map(|atom| atom.gap(&points)).fold(0.0, f64::max);
        let layers = makers.into_iter().map(|ElementMaker { vehicle, shape, .. }| {
            // Where the heading changes by less than a corner, nobody turns.
            let straight = if shape.is_disc() { 0.0 } else { 2.0 * STRAIGHT * shape.reach() };
            let larger = vehicle.margin + off + GAPS * gaps + 0.5 * ROOM + straight;
            let body = shape.inflated(larger).map_err(ExecutionError::Outline)?;
            Ok(LayerBody { vehicle, shape, body })
        });
        let layers: Vec<LayerBody> = layers.collect::<Result<_, ExecutionError>>()?;
        let reach = layers.iter().map(|layer| layer.body.reach()).fold(0.0, f64::max);
        let near = neighbours(&atoms, 2.0 * reach);
        let back = |(place, atom): (usize, &RouteElement)| {
            let [a, b] = atom.ends;
            let is_line = |atom: &RouteElement| matches!(&atom.shapes[..], [one] if matches!(one.shape, PathSegment::Line { .. }));
            let back =
                || leaving[b].iter().copied().filter(|&other: &usize| other != place && atoms[other].ends[1] == a);
            // The same edge, or another straight edge between the same nodes.
            let same = |&other: &usize| atoms[other].edge == atom.edge;
            let along = |&other: &usize| is_line(atom) && is_line(&atoms[other]);
            atom.edge.and_then(|_| back().find(same).or_else(|| back().find(along)))
        };
        let back = atoms.iter().enumerate().map(back).collect();
        let contacts = near.iter().map(|near| vec![OnceCell::new(); near.len()]).collect();
        let covers = RefCell::default();
        let site = Self {
            points,
            atoms,
            leaving,
            coming,
            nodes,
            back,
            edges,
            at_nodes,
            touching_elements: near,
            position_error: off,
            stops_at_turns: false,
            layers,
            contacts,
            covers,
        };
        let motions = site.atoms.iter().try_for_each(|atom| atom.motion(site.body_of(atom)).map(drop));
        motions.map_err(ExecutionError::Motion)?;
        Ok(site)
    }

    /// Whether any robots have outlines, whose turns are elements of their own.
    pub(super) fn has_outline(&self) -> bool {
        self.layers.iter().any(|layer| !layer.body.is_disc())
    }

    /// Whether the robots of a layer have outlines.
    pub(super) fn is_outline(&self, layer: usize) -> bool {
        !self.layers[layer].body.is_disc()
    }

    /// Whether a robot has another angle to its direction of travel on the second of two edges that follow one another.
    pub(super) fn changes_facing(&self, before: usize, after: usize) -> bool {
        let [before, after] = [before, after].map(|atom| &self.atoms[atom]);
        let [from, to] = [before.facing_at_end(), after.facing];
        let is_steady = before.steady.or(after.steady).is_some();
        let changes = if is_steady { wrapped(to - from).abs() > STRAIGHT } else { to != from };
        before.edge.is_some() && after.edge.is_some() && changes
    }

    /// Number of nodes of the layout, each of which is in all layers.
    pub(super) fn places(&self) -> usize {
        self.points.len() / self.layers.len()
    }

    /// Layer of a node.
    pub(super) fn layer_of(&self, node: usize) -> usize {
        node / self.places()
    }

    fn body_of(&self, atom: &RouteElement) -> &ConvexBody {
        &self.layers[atom.layer].body
    }

    /// An atom as a motion of the robots of its layer at 1 m/s.
    pub(super) fn motion(&self, atom: usize) -> Result<Motion<'_, f64>, InvalidInput> {
        let it = &self.atoms[atom];
        it.motion(self.body_of(it))
    }

    /// The elements of a robot that stands at a node, with each heading.
    pub(super) fn standing_at(&self, node: usize) -> impl Iterator<Item = usize> {
        let poses = &self.at_nodes[node].poses;
        let disc = poses.is_empty().then(|| self.standing(node));
        poses.iter().map(|pose| pose.1).chain(disc)
    }

    /// The node of an atom on which a robot stands with the first heading of that node.
    pub(super) fn node_of(&self, atom: usize) -> Option<usize> {
        atom.checked_sub(self.edges).filter(|&node| node < self.points.len())
    }

    /// The heading with which a robot first stands at a node \[rad\]; `None` for discs.
    pub(super) fn first_heading(&self, node: usize) -> Option<f64> {
        self.at_nodes[node].poses.first().map(|pose| pose.0)
    }

    /// The atom of a robot that stands at a node with this heading \[rad\].
    pub(super) fn pose(&self, node: usize, heading: Option<f64>) -> usize {
        let poses = &self.at_nodes[node].poses;
        let off = |pose: &(f64, usize)| heading.map_or(0.0, |heading| wrapped(pose.0 - heading).abs());
        let nearest = poses.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        nearest.map_or(self.standing(node), |pose| pose.1)
    }

    /// The turn at a node between two headings \[rad\] that differ; `None` for discs, which need none.
    pub(super) fn turn(&self, node: usize, headings: [f64; 2]) -> Option<usize> {
        let off = |turn: &[f64; 2]| [0, 1].map(|k| wrapped(turn[k] - headings[k]).abs()).iter().sum::<f64>();
        let turns = self.at_nodes[node].turns.iter();
        turns.min_by(|a, b| off(&a.0).total_cmp(&off(&b.0))).map(|turn| turn.1)
    }

    /// The atom of a robot that stands at a node.
    pub(super) fn standing(&self, node: usize) -> usize {
        self.edges + node
    }

    /// Whether robots that stand at two nodes would touch; outlines also where one of them turns.
    pub(super) fn collide(&self, a: usize, b: usize) -> bool {
        if self.has_outline() {
            let stand = |a: usize, b: usize| {
                let others = || self.standing_at(b).chain(self.at_nodes[b].all());
                a == b || self.standing_at(a).any(|pose| others().any(|other| self.touch(pose, other)))
            };
            return stand(a, b) || stand(b, a);
        }
        let reach = [a, b].map(|node| self.layers[self.layer_of(node)].body.reach());
        let (a, b) = (self.points[a], self.points[b]);
        (a[0] - b[0]).hypot(a[1] - b[1]) < reach[0] + reach[1]
    }

    /// Distance at which two robots do not touch while they stand and turn, the largest of all \[m\].
    pub(super) fn width(&self) -> f64 {
        2.0 * self.layers.iter().map(|layer| layer.body.reach()).fold(0.0, f64::max)
    }

    /// The atoms that touch an atom, with their contacts.
    pub(super) fn contacts(&self, atom: usize) -> impl Iterator<Item = (usize, &ElementContact)> {
        let places = 0..self.touching_elements[atom].len();
        places.filter_map(move |place| Some((self.touching_elements[atom][place], self.contact_at(atom, place)?)))
    }

    /// Whether robots on two atoms may touch.
    pub(super) fn touch(&self, a: usize, b: usize) -> bool {
        self.touching_elements[a].binary_search(&b).is_ok_and(|place| self.contact_at(a, place).is_some())
    }

    fn contact_at(&self, atom: usize, place: usize) -> Option<&ElementContact> {
        let found = self.contacts[atom][place].get_or_init(|| {
            let pair = [atom, self.touching_elements[atom][place]];
            let bodies = pair.map(|atom| self.body_of(&self.atoms[atom]));
            let motion = |side: usize| self.atoms[pair[side]].motion(bodies[side]).expect("checked by the constructor");
            let pitch = PITCH * f64::max(bodies[0].reach(), bodies[1].reach());
            ElementContact::compute([motion(0), motion(1)], pitch).map(Box::new)
        });
        found.as_deref()
    }

    /// Computes all contacts now.
    pub(super) fn warm(&self) {
        (0..self.atoms.len()).for_each(|atom| self.contacts(atom).for_each(drop));
    }

    /// The atoms on which a robot would touch one that stands at a node.
    pub(super) fn covers(&self, node: usize) -> Rc<[usize]> {
        if let Some(known) = self.covers.borrow().get(&node) {
            return known.clone();
        }
        let near = |atom: usize| self.touching_elements[atom].iter().copied();
        let found: Rc<[usize]> = if self.has_outline() {
            let mut all: Vec<usize> = self.standing_at(node).flat_map(near).collect();
            all.sort_unstable();
            all.dedup();
            let is_covered = |atom: &usize| match self.node_of(*atom) {
                Some(other) => self.collide(node, other),
                None => self.passes(*atom, node),
            };
            all.into_iter().filter(is_covered).collect()
        } else {
            near(self.standing(node)).filter(|&atom| self.passes(atom, node)).collect()
        };
        self.covers.borrow_mut().insert(node, found.clone());
        found
    }

    /// Whether a robot somewhere on an atom would touch one that stands at a node.
    pub(super) fn passes(&self, atom: usize, node: usize) -> bool {
        self.atoms[atom].ends.contains(&node) || self.standing_at(node).any(|pose| self.touch(atom, pose))
    }
}

/// The vehicle as the edges of a layout let it face, and whether it is known which way it faces on each of them: where it may face one of
/// two ways it covers what it covers either way, and where it may face any way the disc about it.
fn faced(vehicle: &VehicleTraits, facings: impl Iterator<Item = Facing>) -> (VehicleTraits, bool) {
    let any = facings.fold(None, |any, facing| match (any, facing) {
        (Some(Facing::Any), _) | (_, Facing::Any) => Some(Facing::Any),
        (Some(Facing::Either), _) | (_, Facing::Either) => Some(Facing::Either),
        (any, _) => any,
    });
    any.map_or_else(|| (vehicle.clone(), true), |facing| (vehicle.facing(facing), false))
}

/// Adds a robot that stands at each node, and for outlines all headings with which one can stand there, and all turns.
fn at_nodes(
    makers: &[ElementMaker<'_>],
    atoms: &mut Vec<RouteElement>,
    points: &[[f64; 2]],
    [coming, leaving]: [&[Vec<usize>]; 2],
) -> Result<Vec<NodeElements>, InvalidInput> {
    let mut all = vec![NodeElements::default(); points.len()];
    let maker = |node: usize| &makers[node * makers.len() / points.len()];
    let ends = |of: &[usize], end: usize| {
        let headings = of.iter().filter_map(|&atom| atoms[atom].headings);
        different(headings.map(|headings| headings[end]))
    };
    let headings: Vec<[Vec<f64>; 2]> =
        coming.iter().zip(leaving).map(|(coming, leaving)| [ends(coming, 1), ends(leaving, 0)]).collect();
    // Robots begin with the first heading with which one can arrive, or else leave.
    let poses: Vec<Vec<f64>> = headings
        .iter()
        .enumerate()
        .map(|(node, [arrive, leave])| match (&arrive[..], &leave[..]) {
            _ if !maker(node).has_outline() => Vec::new(),
            ([], []) => vec![0.0],
            ([], [first, ..]) => vec![*first],
            _ => arrive.clone(),
        })
        .collect();
    let standing = |node: usize, heading: Option<f64>| {
        let element = RouteElement::standing(node, points[node], heading)?;
        Ok::<_, InvalidInput>(element.in_layer(maker(node).layer))
    };
    for (node, list) in poses.iter().enumerate() {
        list.first().into_iter().for_each(|&heading| all[node].poses.push((heading, atoms.len())));
        atoms.push(standing(node, list.first().copied())?);
    }
    for (node, list) in poses.iter().enumerate() {
        for &heading in list.iter().skip(1) {
            all[node].poses.push((heading, atoms.len()));
            atoms.push(standing(node, Some(heading))?);
        }
    }
    for (node, [arrive, leave]) in headings.iter().enumerate() {
        if !maker(node).has_outline() {
            continue;
        }
        let abilities = KinematicLimits::of(&maker(node).vehicle);
        // One that has turned may be sent another way.
        for from in different(poses[node].iter().chain(arrive).chain(leave).copied()) {
            for &to in leave {
                let turn = wrapped(to - from);
                if turn.abs() > STRAIGHT {
                    all[node].turns.push(([from, to], atoms.len()));
                    let element = RouteElement::turning(node, points[node], from, turn, abilities.turn(turn))?;
                    atoms.push(element.in_layer(maker(node).layer));
                }
            }
        }
    }
    Ok(all)
}

/// The headings without those that are nearly the same as one before \[rad\].
fn different(headings: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::new();
    for heading in headings {
        if found.iter().all(|other| wrapped(other - heading).abs() > 0.5 * STRAIGHT) {
            found.push(heading);
        }
    }
    found
}

/// For each atom the atoms whose boxes are nearer than `reach`, found with a grid.
fn neighbours(atoms: &[RouteElement], reach: f64) -> Vec<Vec<usize>> {
    /// Largest number of cells for a box; the grid is made coarser if necessary.
    const MOST: f64 = 64.0;
    let size = |atom: &RouteElement| (0..2).map(|axis| atom.bounds[1][axis] - atom.bounds[0][axis]).fold(0.0, f64::max);
    let largest = atoms.iter().map(size).fold(0.0, f64::max);
    let pitch = reach.max(largest / MOST);
    let cells = |atom: &RouteElement, room: f64| {
        let cell = |value: f64| (value / pitch).floor() as i64;
        let [lo, hi] = atom.bounds;
        let (x, y) = ([cell(lo[0] - room), cell(hi[0] + room)], [cell(lo[1] - room), cell(hi[1] + room)]);
        (x[0]..=x[1]).flat_map(move |x| (y[0]..=y[1]).map(move |y| (x, y)))
    };
    let mut grid: HashMap<(i64, i64), Vec<usize>> = HashMap::new();
    for (place, atom) in atoms.iter().enumerate() {
        cells(atom, 0.0).for_each(|cell| grid.entry(cell).or_default().push(place));
    }
    let near = |a: &RouteElement, b: &RouteElement| {
        let apart = |axis: usize| (a.bounds[0][axis] - b.bounds[1][axis]).max(b.bounds[0][axis] - a.bounds[1][axis]);
        apart(0) < reach && apart(1) < reach
    };
    let all = atoms.iter().map(|atom| {
        let mut found: Vec<usize> = cells(atom, reach).filter_map(|cell| grid.get(&cell)).flatten().copied().collect();
        found.sort_unstable();
        found.dedup();
        found.retain(|&other| near(atom, &atoms[other]));
        found
    });
    all.collect()
}

#[cfg(test)]
mod tests {
    use super::super::route_element::LEVER;
    use super::*;
    use crate::lifelong::{CoordinationMethod, DelayModel, LifelongOptions, aisles, run, streets};
    use pcr_formats::footprint::Footprint;
    use pcr_formats::scenario::PlacedSegment;

    /// A pallet truck of 1.2 by 0.8 m, and the disc around it.
    fn trucks(imported: &ImportedLayout) -> [ImportedLayout; 2] {
        let corners = vec![[-0.6, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.6, 0.4]];
        let footprint = Footprint::new(corners).expect("a footprint");
        [Some(footprint), None].map(|footprint| {
            let mut imported = imported.clone();
            (imported.vehicle.radius, imported.vehicle.footprint) = (0.52_f64.sqrt(), footprint);
            imported
        })
    }

    #[test]
    fn outlines_turn_at_nodes_and_discs_do_not() {
        let [exact, disc] = trucks(&streets(2)).map(|imported| RouteGraph::new(&imported).expect("a site"));
        assert_eq!(disc.atoms.len(), disc.edges + disc.points.len());
        assert!(exact.atoms.len() > disc.atoms.len() && exact.edges == disc.edges);
        // Wherever outlines touch, so do their discs.
        for a in 0..disc.atoms.len() {
            for b in 0..disc.atoms.len() {
                assert!(!exact.touch(a, b) || disc.touch(a, b), "{a} {b}");
            }
        }
        let turns = exact.atoms.iter().filter(|atom| atom.is_turn());
        for turn in turns {
            let [from, to] = turn.headings.expect("headings");
            assert!((turn.length - LEVER * (to - from).abs()).abs() < 1e-12);
            assert!(wrapped(turn.heading(turn.length) - to).abs() < 1e-9);
        }
    }

    #[test]
    fn fleets_of_outlines_run_and_are_certified() {
        for method in [CoordinationMethod::Orders, CoordinationMethod::EdgeLocks] {
            let request =
                LifelongOptions { agents: 4, duration: 600.0, delays: DelayModel::default(), seed: 3, method };
            for imported in trucks(&streets(2)) {
                let outcome = run(&imported, request).expect("a run").outcome;
                let certificate = &outcome.certificate;
                assert_eq!((certificate.verdict, outcome.authority_overruns, outcome.stuck), ("proved", 0, 0));
                assert!(outcome.missions > 10 && certificate.steps > 0, "{outcome:?}");
            }
        }
    }

    #[test]
    fn trucks_pass_each_other_in_aisles_of_two_lanes() {
        let (delays, method) = (DelayModel::default(), CoordinationMethod::Orders);
        let request = LifelongOptions { agents: 12, duration: 300.0, delays, seed: 1, method };
        let [exact, disc] = trucks(&aisles(4)).map(|imported| run(&imported, request).expect("a run").outcome);
        for outcome in [&exact, &disc] {
            assert_eq!((outcome.certificate.verdict, outcome.authority_overruns, outcome.stuck), ("proved", 0, 0));
        }
        assert!(exact.missions_per_hour >= 1.3 * disc.missions_per_hour, "{exact:?} {disc:?}");
    }

    /// What is certified are the outlines, not what the orders were made for.
    #[test]
    fn trucks_that_are_larger_than_their_orders_are_found_in_contact() {
        let (delays, method) = (DelayModel::default(), CoordinationMethod::Orders);
        let request = LifelongOptions { agents: 12, duration: 600.0, delays, seed: 1, method };
        let [mut exact, _] = trucks(&aisles(4));
        let footprint = exact.vehicle.footprint.take().expect("a footprint");
        (exact.vehicle.footprint, exact.vehicle.margin) = (Some(footprint.inflated(0.2)), -0.19);
        let outcome = run(&exact, request).expect("a run").outcome;
        assert!(outcome.certificate.verdict == "contact" && outcome.certificate.contacts > 0, "{outcome:?}");
    }

    /// Forklifts back out of their bays, and some edges have kinks.
    #[test]
    fn robots_that_drive_backward_and_turn_on_edges_are_certified() {
        let mut imported = streets(2);
        let corners = vec![[-0.3, -0.3], [0.9, -0.3], [0.9, 0.3], [-0.3, 0.3]];
        imported.vehicle.footprint = Some(Footprint::new(corners).expect("a footprint"));
        imported.vehicle.radius = 0.9_f64.hypot(0.3);
        for (k, edge) in imported.layout.edges.iter_mut().enumerate() {
            if edge.is_two_way() {
                edge.facing = [Facing::Ahead, Facing::Backward];
            } else if k % 3 == 0 {
                let [from, to] = [edge.curve[0].start, edge.curve[0].end()];
                let aside = [0.5 * (from[0] + to[0]) + 0.2 * (to[1] - from[1]) / 3.0, 0.5 * (from[1] + to[1])];
                let aside = [aside[0], aside[1] - 0.2 * (to[0] - from[0]) / 3.0];
                edge.curve = vec![PlacedSegment::line(from, aside), PlacedSegment::line(aside, to)];
            }
        }
        let site = RouteGraph::new(&imported).expect("a site");
        let back = site.atoms.iter().filter(|atom| atom.facing != 0.0).count();
        assert_eq!(back, imported.layout.edges.iter().filter(|edge| edge.is_two_way()).count());
        let pivots = |atom: &&RouteElement| atom.edge.is_some() && atom.segments.len() > atom.shapes.len();
        assert!(site.atoms.iter().filter(pivots).count() > 2);
        // Into a bay and out of it again nobody turns.
        let dead = (0..site.points.len()).filter(|&node| site.leaving[node].len() == 1 && site.coming[node].len() == 1);
        let ends = dead.filter(|&node| site.back[site.leaving[node][0]].is_some());
        assert!(ends.into_iter().all(|node| site.at_nodes[node].turns.is_empty()));
        for method in [CoordinationMethod::Orders, CoordinationMethod::EdgeLocks] {
            let request =
                LifelongOptions { agents: 4, duration: 900.0, delays: DelayModel::default(), seed: 2, method };
            let outcome = run(&imported, request).expect("a run").outcome;
            assert_eq!((outcome.certificate.verdict, outcome.authority_overruns, outcome.stuck), ("proved", 0, 0));
            assert!(outcome.missions > 10 && outcome.certificate.steps > 0, "{outcome:?}");
        }
        // Where it is not known which way they face, the hull of both ways counts.
        imported.layout.edges[0].facing = [Facing::Either; 2];
        let either = RouteGraph::new(&imported).expect("a site");
        let (corners, _) = either.layers[0].shape.corners();
        assert!(corners.iter().all(|&[x, _]| (x.abs() - 0.9).abs() < 1e-12) && either.is_outline(0));
        imported.layout.edges[0].facing = [Facing::Any; 2];
        assert!(!RouteGraph::new(&imported).expect("a site").is_outline(0));
    }
}
