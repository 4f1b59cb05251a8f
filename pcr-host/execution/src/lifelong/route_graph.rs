//! A layout for lifelong runs: pieces of way from node to node, and how robots on two of them touch. Data that depend
//! only on the layout and the radius are computed once, when they are first needed.

use super::gates::ElementContact;
use pcr_core::{InvalidInput, Motion, PathRef, Phase, Point, Pose, ProfileRef, Radians, Segment, TurnSide};
use pcr_formats::import::{ImportedLayout, Layout, RouteStep};
use pcr_formats::scenario::{PathSegment, PlacedSegment};
use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::rc::Rc;

/// Additional radius of discs, for rounding \[m\].
const ROOM: f64 = 1e-4;

/// Number of gaps between edges, each as large as the largest one, that one window of a certificate is assumed to contain.
const GAPS: f64 = 4.0;

/// Step of the first robot between two gates, in radii.
const PITCH: f64 = 2.0;

/// An edge in one direction, or a node at which a robot can stand.
#[derive(Clone, Debug)]
pub(super) struct RouteElement {
    /// Nodes where it begins and ends.
    pub(super) ends: [usize; 2],
    pub(super) length: f64,
    /// Largest speed on it \[m/s\].
    pub(super) speed: f64,
    /// Directions at its ends \[rad\]; `None` for a node.
    pub(super) headings: Option<[f64; 2]>,
    pub(super) shapes: Vec<PlacedSegment>,
    segments: Vec<Segment<f64>>,
    phases: Vec<Phase<f64>>,
    /// Least and largest x and y \[m\].
    bounds: [[f64; 2]; 2],
    /// Index of its edge in the layout; `None` for a node.
    pub(super) edge: Option<usize>,
}

/// A layout for robots of one size.
#[derive(Debug)]
pub(super) struct RouteGraph {
    pub(super) points: Vec<[f64; 2]>,
    /// All atoms: edges in their directions, then the nodes.
    pub(super) atoms: Vec<RouteElement>,
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
    /// Radius of the discs, with margins and the error of curves \[m\].
    radius: f64,
    /// The contact of each pair of `near`, at the same indices, computed when it is first needed.
    contacts: Vec<Vec<OnceCell<Option<ElementContact>>>>,
    covers: RefCell<HashMap<usize, Rc<[usize]>>>,
}

/// A node, and the direction in which a robot stands there.
#[derive(Clone, Copy, Debug)]
pub(super) struct DeparturePose {
    pub(super) node: usize,
    /// Direction of the robot, if it is known \[rad\].
    pub(super) heading: Option<f64>,
}

impl RouteGraph {
    /// The site of the level with the most nodes.
    ///
    /// # Errors
    /// An edge that is not a path.
    pub(super) fn new(imported: &ImportedLayout) -> Result<Self, String> {
        let ImportedLayout { layout, vehicle } = imported;
        let level = layout.largest_level();
        let points: Vec<[f64; 2]> = layout.nodes.iter().map(|node| node.point).collect();
        let nodes: Vec<usize> = (0..points.len()).filter(|&node| layout.nodes[node].level == level).collect();
        let mut atoms = Vec::new();
        let mut off = 0.0_f64;
        for (place, edge) in layout.edges.iter().enumerate().filter(|(_, edge)| !edge.closed) {
            for step in edge.steps() {
                let there = [step.origin(), step.target()].iter().all(|&node| layout.nodes[node].level == level);
                if there {
                    let atom = RouteElement::along(layout, step, place, vehicle.speed);
                    let atom = atom.map_err(|invalid| format!("edge {}: {invalid}", edge.id))?;
                    off = off.max(step.deviation() + atom.gap(&points));
                    atoms.push(atom);
                }
            }
        }
        let (mut leaving, mut coming) = (vec![Vec::new(); points.len()], vec![Vec::new(); points.len()]);
        for (place, atom) in atoms.iter().enumerate() {
            leaving[atom.ends[0]].push(place);
            coming[atom.ends[1]].push(place);
        }
        for (node, &at) in points.iter().enumerate() {
            atoms.push(RouteElement::node(node, at).map_err(|invalid| format!("a node: {invalid}"))?);
        }
        let gaps = atoms.iter().map(|atom| atom.gap(&points)).fold(0.0, f64::max);
        let radius = vehicle.radius + vehicle.margin + off + GAPS * gaps + 0.5 * ROOM;
        let near = neighbours(&atoms, 2.0 * radius);
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
            touching_elements: near,
            position_error: off,
            radius,
            contacts,
            covers,
        };
        site.atoms.iter().try_for_each(|atom| atom.motion(radius).map(drop)).map_err(|invalid| invalid.to_string())?;
        Ok(site)
    }

    /// The atom of a robot that stands at a node.
    pub(super) fn standing(&self, node: usize) -> usize {
        self.atoms.len() - self.points.len() + node
    }

    /// Whether robots that stand at two nodes would touch.
    pub(super) fn collide(&self, a: usize, b: usize) -> bool {
        let (a, b) = (self.points[a], self.points[b]);
        (a[0] - b[0]).hypot(a[1] - b[1]) < self.width()
    }

    /// Distance at which two standing robots do not touch \[m\].
    pub(super) fn width(&self) -> f64 {
        2.0 * self.radius
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
            let motions = pair.map(|atom| self.atoms[atom].motion(self.radius).expect("checked by the constructor"));
            ElementContact::compute(motions, PITCH * self.radius)
        });
        found.as_ref()
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
        let near = self.touching_elements[self.standing(node)].iter().copied();
        let found: Rc<[usize]> = near.filter(|&atom| self.passes(atom, node)).collect();
        self.covers.borrow_mut().insert(node, found.clone());
        found
    }

    /// Whether a robot somewhere on an atom would touch one that stands at a node.
    pub(super) fn passes(&self, atom: usize, node: usize) -> bool {
        self.atoms[atom].ends.contains(&node) || self.touch(atom, self.standing(node))
    }
}

impl RouteElement {
    fn along(layout: &Layout, step: RouteStep<'_>, edge: usize, fastest: f64) -> Result<Self, InvalidInput> {
        let mut shapes = step.curve();
        shapes.retain(|placed| placed.shape.length() > 0.0);
        let from = layout.nodes[step.origin()].point;
        let segments = path(&shapes, from)?;
        let length = PathRef::new(&segments)?.length();
        let headings = shapes.first().zip(shapes.last()).map(|(first, last)| [first.heading, last.heading_at_end()]);
        Ok(Self {
            ends: [step.origin(), step.target()],
            length,
            speed: step.steady(fastest),
            headings,
            phases: if length > 0.0 { vec![Phase::starting_at(1.0, length, 0.0)?] } else { Vec::new() },
            bounds: bounds(&shapes, from),
            shapes,
            segments,
            edge: Some(edge),
        })
    }

    fn node(node: usize, at: [f64; 2]) -> Result<Self, InvalidInput> {
        let segments = path(&[], at)?;
        let (shapes, phases, bounds) = (Vec::new(), Vec::new(), [at, at]);
        Ok(Self {
            ends: [node; 2],
            length: 0.0,
            speed: 0.0,
            headings: None,
            shapes,
            segments,
            phases,
            bounds,
            edge: None,
        })
    }

    /// Largest distance between the ends of its curve and its nodes \[m\].
    fn gap(&self, points: &[[f64; 2]]) -> f64 {
        let ends = self.shapes.first().zip(self.shapes.last()).map(|(first, last)| [first.start, last.end()]);
        let off = |ends: [[f64; 2]; 2]| {
            let each =
                ends.iter().zip(self.ends).map(|(at, node)| (at[0] - points[node][0]).hypot(at[1] - points[node][1]));
            each.fold(0.0, f64::max)
        };
        ends.map_or(0.0, off)
    }

    /// The atom as a motion at 1 m/s.
    fn motion(&self, radius: f64) -> Result<Motion<'_, f64>, InvalidInput> {
        Motion::new(PathRef::new(&self.segments)?, ProfileRef::new(&self.phases)?, radius, 0.0)
    }

    /// Position of a robot at a length \[m\].
    pub(super) fn point(&self, length: f64) -> [f64; 2] {
        let point = PathRef::new(&self.segments).map(|path| path.point_at(length)).unwrap_or_default();
        [point.x, point.y]
    }
}

/// An angle from -π to π.
pub(super) fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

/// The segments, with turns in place where the shapes meet at an angle.
fn path(shapes: &[PlacedSegment], at: [f64; 2]) -> Result<Vec<Segment<f64>>, InvalidInput> {
    let heading = shapes.first().map_or(0.0, |first| first.heading);
    let start = shapes.first().map_or(at, |first| first.start);
    let mut last = Segment::standing(Pose { position: Point::new(start[0], start[1]), heading: Radians(heading) })?;
    let mut segments: Vec<Segment<f64>> = Vec::new();
    let mut heading = heading;
    for placed in shapes {
        let turn = wrapped(placed.heading - heading);
        if turn != 0.0 {
            last = last.turned(Radians(turn))?;
            if let Some(before) = segments.last_mut() {
                *before = last;
            }
        }
        last = match placed.shape {
            PathSegment::Line { length } => last.then_line(length)?,
            PathSegment::Arc { radius, sweep } => {
                last.then_arc(radius, if sweep > 0.0 { TurnSide::Left } else { TurnSide::Right }, radius * sweep.abs())?
            }
        };
        heading = placed.heading_at_end();
        segments.push(last);
    }
    if segments.is_empty() {
        segments.push(last);
    }
    Ok(segments)
}

/// A box around a curve.
fn bounds(shapes: &[PlacedSegment], at: [f64; 2]) -> [[f64; 2]; 2] {
    let mut bounds = [at, at];
    for placed in shapes {
        // No point of an arc is farther from its ends than its length.
        let (ends, room) = match placed.shape {
            PathSegment::Line { .. } => ([placed.start, placed.end()], 0.0),
            PathSegment::Arc { .. } => ([placed.start, placed.end()], 0.5 * placed.shape.length()),
        };
        for end in ends {
            for axis in 0..2 {
                bounds[0][axis] = bounds[0][axis].min(end[axis] - room);
                bounds[1][axis] = bounds[1][axis].max(end[axis] + room);
            }
        }
    }
    bounds
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
