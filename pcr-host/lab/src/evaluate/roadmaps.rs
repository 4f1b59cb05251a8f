//! Roadmaps of growing size, like those that planners generate: the time to compute the tables of locks and of unsafe
//! delays.

use super::scale::exponent;
use super::{DocumentSection, EvaluationError, PaperFleets, Thoroughness};
use pcr_formats::import::{
    ElementId, ImportError, ImportedLayout, Layout, LayoutEdge, LayoutNode, SizeSource, VehicleTraits,
};
use pcr_formats::scenario::{PathSegment, PlacedSegment};
use pcr_formats::splitmix64::SplitMix64;
use pcr_planning::exclusion_table::{EdgeDriving, SweptLayout, TouchingAreas, UnsafeDelayModel, UnsafeRelation};
use pcr_planning::figures::digits;
use std::fmt::Write as _;
use std::time::Instant;

/// Radius of the discs \[m\], of whose squares each node has one of so many metres.
const RADIUS: f64 = 0.5;
const SPACING: f64 = 1.5;
/// Neighbours that each node is joined with, both ways.
const NEIGHBOURS: usize = 6;

/// Of curved roadmaps one way in so many is an arc, which turns by so much \[rad\].
const ARCS: usize = 4;
const SWEEP: f64 = 1.0;

/// Unsafe delays of arcs have no closed form: larger curved roadmaps than this are for locks only \[nodes\].
const LARGEST: usize = 1_000;

/// One roadmap: edges, pairs found, and seconds, of locks and of delays.
struct RoadmapMeasurement {
    edges: f64,
    locks: [f64; 2],
    delays: Option<[f64; 2]>,
}

pub(super) fn section(_: &PaperFleets, extent: Thoroughness) -> Result<DocumentSection, EvaluationError> {
    let sizes: &[usize] = match extent {
        Thoroughness::Full => &[300, 1_000, 3_000, 10_000, 30_000, 150_000],
        Thoroughness::Quick => &[20, 40],
    };
    let mut text = format!(
        "## Roadmaps\n\nRandom nodes, one per {} m² on average, each joined with its {NEIGHBOURS} nearest ones in both directions; discs of {RADIUS} \
        m at 1 m/s. Locks: the pairs of edges on which two vehicles can touch, and the lengths on which they can (`pcr locks`). Unsafe delays: the \
        interval of start delays at which two vehicles on them touch (`pcr locks --delays --speed 1`), including each edge with itself. All cores \
        are used; nothing is printed.\n",
        digits(SPACING * SPACING)
    );
    for (is_curved, title) in [(false, "All edges straight"), (true, "One way in four an arc that turns by 1 rad")] {
        let all = sizes.iter().map(|&nodes| measured(&roadmap(nodes, 1, is_curved), !is_curved || nodes <= LARGEST));
        let all = all.collect::<Result<Vec<_>, _>>();
        table(&all.map_err(|error| EvaluationError::Method("locks".into(), error.to_string()))?, title, &mut text);
    }
    Ok(DocumentSection { text, pictures: Vec::new() })
}

fn table(all: &[RoadmapMeasurement], title: &str, text: &mut String) {
    let _ = write!(
        text,
        "\n{title}:\n\n\
        | edges | locks | s | µs a lock | unsafe delays | s | µs an interval |\n|---:|---:|---:|---:|---:|---:|---:|\n"
    );
    let each =
        |[count, seconds]: [f64; 2]| format!("{count} | {} | {}", digits(seconds), digits(1e6 * seconds / count));
    for measured in all {
        let delays = measured.delays.map_or("– | – | –".to_owned(), each);
        let _ = writeln!(text, "| {} | {} | {delays} |", measured.edges, each(measured.locks));
    }
    let of = |time: fn(&RoadmapMeasurement) -> Option<[f64; 2]>| {
        exponent(&all.iter().filter_map(|measured| Some([measured.edges, time(measured)?[1]])).collect::<Vec<_>>())
    };
    let _ = writeln!(
        text,
        "\nTime grows with the power {:.2} of the edges (locks) and {:.2} (unsafe delays), fitted to the sizes above.",
        of(|measured| Some(measured.locks)),
        of(|measured| measured.delays)
    );
}

fn measured(imported: &ImportedLayout, with_delays: bool) -> Result<RoadmapMeasurement, ImportError> {
    let count = |found: usize, start: Instant| [found as f64, start.elapsed().as_secs_f64()];
    let (start, mut found) = (Instant::now(), 0);
    SweptLayout::new(imported, false)?.each(&|_, _| {}, &<[TouchingAreas]>::len, |some| {
        found += some;
        Ok::<(), ImportError>(())
    })?;
    let locks = count(found, start);
    let delays = || {
        let (start, mut found) = (Instant::now(), 0);
        let driving = EdgeDriving { speed: 1.0, acceleration: None };
        UnsafeDelayModel::new(imported, driving, false)?.each(&|_, _| {}, &<[UnsafeRelation]>::len, |some| {
            found += some;
            Ok::<(), ImportError>(())
        })?;
        Ok(count(found, start))
    };
    let delays = with_delays.then(delays).transpose()?;
    Ok(RoadmapMeasurement { edges: imported.layout.edges.len() as f64, locks, delays })
}

/// A roadmap of so many nodes, with arcs among its ways.
fn roadmap(count: usize, seed: u64, is_curved: bool) -> ImportedLayout {
    let (side, mut random) = (SPACING * (count as f64).sqrt(), SplitMix64(seed));
    let places: Vec<[f64; 2]> = (0..count).map(|_| [0; 2].map(|_| random.uniform(0.0, side))).collect();
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
    let sweeps = (0..pairs.len()).map(|way| if is_curved && way % ARCS == 0 { SWEEP } else { 0.0 });
    let both = pairs.iter().zip(sweeps).flat_map(|(&[a, b], sweep)| [([a, b], sweep), ([b, a], -sweep)]);
    let edges = both.enumerate().map(|(id, (ends, sweep))| {
        let [[x, y], [u, v]] = ends.map(|node| places[node]);
        let (length, heading) = ((u - x).hypot(v - y), (v - y).atan2(u - x) - sweep / 2.0);
        let shape = match sweep {
            0.0 => PathSegment::Line { length },
            _ => PathSegment::arc(length / (2.0 * (sweep.abs() / 2.0).sin()), sweep),
        };
        let curve = vec![PlacedSegment { start: [x, y], heading, shape }];
        LayoutEdge::new(ElementId::Number(id as u64), ends, curve)
    });
    let node = |(id, &at): (usize, &[f64; 2])| LayoutNode {
        id: ElementId::Number(id as u64),
        name: None,
        level: 0,
        point: at,
    };
    let vehicle = VehicleTraits {
        name: None,
        radius: RADIUS,
        footprint: None,
        size: SizeSource::Option,
        margin: 0.0,
        speed: 1.0,
        acceleration: 1.0,
        rotation: 1.0,
        rotation_acceleration: 1.0,
    };
    let nodes = places.iter().enumerate().map(node).collect();
    ImportedLayout {
        layout: Layout { levels: vec![String::new()], nodes, edges: edges.collect(), ..Layout::default() },
        vehicle,
    }
}
