//! Roadmaps of growing size, as planners draw them: how long the tables of locks and of unsafe delays take.

use super::scale::exponent;
use super::{Extent, Fleets, Problem, Section};
use pcr_formats::import::{Edge, Id, ImportError, Imported, Layout, Node, Vehicle};
use pcr_formats::scenario::{PathSegment, Placed};
use pcr_planning::locks::{Delays, Driving, Found, Sweep, Unsafe};
use pcr_planning::random::Random;
use pcr_planning::report::figures::digits;
use std::fmt::Write as _;
use std::time::Instant;

/// Radius of the discs \[m\], of whose squares each node has one of so many metres.
const RADIUS: f64 = 0.5;
const SPACING: f64 = 1.5;
/// Neighbours that each node is joined with, both ways.
const NEIGHBOURS: usize = 6;

/// One roadmap: edges, pairs found, and seconds, of locks and of delays.
struct Measured {
    edges: f64,
    locks: [f64; 2],
    delays: [f64; 2],
}

pub(super) fn section(_: &Fleets, extent: Extent) -> Result<Section, Problem> {
    let sizes: &[usize] = match extent {
        Extent::Full => &[300, 1_000, 3_000, 10_000, 30_000],
        Extent::Quick => &[100, 200],
    };
    let mut text = format!(
        "## Roadmaps\n\nNodes at random, one on {} m² on average, each joined with its {NEIGHBOURS} nearest ones in both directions; discs of {RADIUS} m at 1 m/s. \
        Locks: which pairs of edges can touch, and on which lengths (`pcr locks`). Unsafe delays: the interval of start delays at which two vehicles on them touch \
        (`pcr locks --delays --speed 1`), each edge with itself included. All cores; nothing is printed.\n\n\
        | edges | locks | s | µs a lock | unsafe delays | s | µs an interval |\n|---:|---:|---:|---:|---:|---:|---:|\n",
        digits(SPACING * SPACING)
    );
    let mut all = Vec::new();
    for &nodes in sizes {
        let measured =
            measured(&roadmap(nodes, 1)).map_err(|error| Problem::Method("locks".into(), error.to_string()))?;
        let each =
            |[count, seconds]: [f64; 2]| format!("{count} | {} | {}", digits(seconds), digits(1e6 * seconds / count));
        let _ = writeln!(text, "| {} | {} | {} |", measured.edges, each(measured.locks), each(measured.delays));
        all.push(measured);
    }
    let of = |time: fn(&Measured) -> f64| {
        exponent(&all.iter().map(|measured| [measured.edges, time(measured)]).collect::<Vec<_>>())
    };
    let _ = writeln!(
        text,
        "\nTime grows with the power {:.2} of the edges (locks) and {:.2} (unsafe delays), fitted to the sizes above.",
        of(|measured| measured.locks[1]),
        of(|measured| measured.delays[1])
    );
    Ok(Section { text, pictures: Vec::new() })
}

fn measured(imported: &Imported) -> Result<Measured, ImportError> {
    let count = |found: usize, start: Instant| [found as f64, start.elapsed().as_secs_f64()];
    let (start, mut found) = (Instant::now(), 0);
    Sweep::new(imported, false)?.each(&|_, _| {}, <[Found]>::len, |some| {
        found += some;
        Ok::<(), ImportError>(())
    })?;
    let locks = count(found, start);
    let (start, mut found) = (Instant::now(), 0);
    let driving = Driving { speed: 1.0, acceleration: None };
    Delays::new(imported, driving, false)?.each(&|_, _| {}, <[Unsafe]>::len, |some| {
        found += some;
        Ok::<(), ImportError>(())
    })?;
    Ok(Measured { edges: imported.layout.edges.len() as f64, locks, delays: count(found, start) })
}

/// A roadmap of so many nodes.
fn roadmap(count: usize, seed: u64) -> Imported {
    let (side, mut random) = (SPACING * (count as f64).sqrt(), Random(seed));
    let places: Vec<[f64; 2]> = (0..count).map(|_| [0; 2].map(|_| random.within(0.0, side))).collect();
    // Nodes by squares that hold some of them each: neighbours are looked for around their own.
    let cell = 2.0 * SPACING;
    let columns = (side / cell) as usize + 1;
    let square = |[x, y]: [f64; 2]| [x, y].map(|at| ((at / cell) as usize).min(columns - 1));
    let mut squares = vec![Vec::new(); columns * columns];
    for (node, &at) in places.iter().enumerate() {
        let [column, row] = square(at);
        squares[row * columns + column].push(node);
    }
    let mut pairs = Vec::new();
    for (node, &[x, y]) in places.iter().enumerate() {
        let [column, row] = square([x, y]);
        let around = |place: usize| place.saturating_sub(2)..(place + 3).min(columns);
        let near = around(row).flat_map(|row| around(column).map(move |column| row * columns + column));
        let mut near: Vec<usize> = near.flat_map(|square| squares[square].iter().copied()).collect();
        near.retain(|&other| other != node);
        let distance = |other: usize| (places[other][0] - x).hypot(places[other][1] - y);
        near.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)));
        pairs.extend(near.into_iter().take(NEIGHBOURS).map(|other| [node.min(other), node.max(other)]));
    }
    pairs.sort_unstable();
    pairs.dedup();
    let both = pairs.into_iter().flat_map(|[a, b]| [[a, b], [b, a]]);
    let edges = both.enumerate().map(|(id, ends)| {
        let [[x, y], [u, v]] = ends.map(|node| places[node]);
        let shape = PathSegment::Line { length: (u - x).hypot(v - y) };
        let curve = vec![Placed { at: [x, y], heading: (v - y).atan2(u - x), shape }];
        Edge { id: Id::Number(id as u64), ends, curve, two_way: false, speed: None, rotation: None, deviation: 0.0 }
    });
    let node = |(id, &at): (usize, &[f64; 2])| Node { id: Id::Number(id as u64), name: None, level: 0, at };
    let vehicle = Vehicle {
        name: None,
        radius: RADIUS,
        footprint: None,
        margin: 0.0,
        speed: 1.0,
        acceleration: 1.0,
        rotation: 1.0,
        rotation_acceleration: 1.0,
    };
    let nodes = places.iter().enumerate().map(node).collect();
    Imported {
        layout: Layout { levels: vec![String::new()], nodes, edges: edges.collect(), ..Layout::default() },
        vehicle,
    }
}
