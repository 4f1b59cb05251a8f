//! The outline of a collision region in the plane of time and travelled length.
//!
//! The exact slices of the region are taken at *columns* of time, which lie between neighbouring events
//! ([`events`]) at the cosines of equal angles: the vertical tangents at the ends of a region, where its slices shrink
//! like a square root, are then as well resolved as its flanks. A column is added wherever a straight line would
//! leave the outline by more than [`TOLERANCE`]. Between two columns whose intervals correspond one to one the outline
//! follows their ends. Where slices begin, end, split or merge, the columns close in on that time, and the
//! outline crosses over along the vertical line there: the ends that lie on it belong together in pairs from below.

mod events;

use pcr_core::{Interval, Motion, RegionRef, Scalar};
use std::f64::consts::PI;

/// Largest distance of an outline from its chord \[px\].
pub(super) const TOLERANCE: f64 = 0.03;

/// Columns between two events before any is added.
const FIRST_COLUMNS: usize = 6;

/// Halvings of the angle between two columns; 26 of them leave 10⁻¹⁵ of the time between two events.
const HALVINGS: u32 = 26;

/// Columns of a region at most. Only a region whose parts are far below a pixel, and many, comes near it.
const MOST_COLUMNS: usize = 20_000;

/// Closed outlines, region to the left: counter-clockwise about the region, clockwise about its holes.
/// Points are (time \[s\], length \[m\]).
pub(super) type Outline = Vec<Vec<[f64; 2]>>;

/// The slice of a region at one time.
#[derive(Clone, Debug)]
struct Column {
    time: f64,
    intervals: Vec<Interval<f64>>,
}

/// The outline of a region while the other agent is on its way; `pixel` is the size of a pixel \[s\], \[m\].
pub(super) fn trace(region: &RegionRef<'_, f64>, ego: &Motion<'_, f64>, pixel: [f64; 2]) -> Outline {
    let other = region.other_motion();
    let radius = ego.radius() + other.radius() + f64::slack(ego.extent() + other.extent());
    let mut tracer = Tracer { region, pixel, columns: Vec::new() };
    let times = event_times(region, radius);
    for (k, pair) in times.windows(2).enumerate() {
        tracer.add_slab(pair[0], pair[1], k == 0);
    }
    if times.len() == 1 {
        tracer.columns.push(tracer.column(times[0]));
    }
    outline(&tracer.columns, pixel)
}

/// The times of all events, and of the breaks in the other's profile, in order.
fn event_times(region: &RegionRef<'_, f64>, radius: f64) -> Vec<f64> {
    let (range, other) = (region.time(), region.other_motion());
    let mut times = vec![range.lo, range.hi];
    for length in events::lengths(region, radius) {
        let at = other.time_in(Interval::new(length, length));
        times.extend([at.lo, at.hi]);
    }
    times.extend(other.profile().phases().iter().map(|phase| other.time().lo + phase.time().lo));
    times.retain(|time| range.contains(*time));
    times.sort_by(f64::total_cmp);
    // Times that only rounding tells apart are one.
    let apart = 4.0 * f64::EPSILON * range.lo.abs().max(range.hi.abs());
    times.dedup_by(|later, earlier| *later - *earlier <= apart);
    times
}

struct Tracer<'r, 'a> {
    region: &'r RegionRef<'a, f64>,
    pixel: [f64; 2],
    columns: Vec<Column>,
}

impl Tracer<'_, '_> {
    fn column(&self, time: f64) -> Column {
        Column { time, intervals: self.region.slice_at(time).collect() }
    }

    /// Adds the columns from one event to the next, the first only on demand.
    fn add_slab(&mut self, lo: f64, hi: f64, with_first: bool) {
        let time_at = |angle: f64| {
            let half = (angle / 2.0).sin();
            if angle >= PI { hi } else { lo + (hi - lo) * half * half }
        };
        let mut before = (0.0, self.column(lo));
        if with_first {
            self.columns.push(before.1.clone());
        }
        for k in 1..=FIRST_COLUMNS {
            let angle = PI * k as f64 / FIRST_COLUMNS as f64;
            let after = (angle, self.column(time_at(angle)));
            self.refine(&time_at, &before, &after, HALVINGS);
            self.columns.push(after.1.clone());
            before = after;
        }
    }

    /// Adds the columns that are needed between two others.
    fn refine(&mut self, time_at: &dyn Fn(f64) -> f64, a: &(f64, Column), b: &(f64, Column), halvings: u32) {
        let angle = (a.0 + b.0) / 2.0;
        let time = time_at(angle);
        if halvings == 0 || time <= a.1.time || time >= b.1.time || self.columns.len() >= MOST_COLUMNS {
            return;
        }
        let middle = (angle, self.column(time));
        if self.is_straight(&a.1, &middle.1, &b.1) {
            // Steep bands correspond over the middle only.
            if !correspond(&a.1, &b.1, self.pixel[1]) {
                self.columns.push(middle.1);
            }
            return;
        }
        self.refine(time_at, a, &middle, halvings - 1);
        self.columns.push(middle.1.clone());
        self.refine(time_at, &middle, b, halvings - 1);
    }

    fn is_straight(&self, a: &Column, middle: &Column, b: &Column) -> bool {
        let near = |a: [f64; 2], middle: [f64; 2], b: [f64; 2]| {
            distance_to_chord(self.scaled(a), self.scaled(middle), self.scaled(b)) <= TOLERANCE
        };
        correspond(a, middle, self.pixel[1])
            && correspond(middle, b, self.pixel[1])
            && a.intervals.iter().zip(&middle.intervals).zip(&b.intervals).all(|((left, inner), right)| {
                near([a.time, left.lo], [middle.time, inner.lo], [b.time, right.lo])
                    && near([a.time, left.hi], [middle.time, inner.hi], [b.time, right.hi])
            })
    }

    fn scaled(&self, point: [f64; 2]) -> [f64; 2] {
        scaled(point, self.pixel)
    }
}

fn scaled(point: [f64; 2], pixel: [f64; 2]) -> [f64; 2] {
    [point[0] / pixel[0], point[1] / pixel[1]]
}

fn distance_to_chord(a: [f64; 2], p: [f64; 2], b: [f64; 2]) -> f64 {
    let (chord, offset) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length = chord[0].hypot(chord[1]);
    if length > 0.0 { (chord[0] * offset[1] - chord[1] * offset[0]).abs() / length } else { offset[0].hypot(offset[1]) }
}

/// Whether the intervals of two columns correspond one to one: each meets the one of the same number, and no
/// other, or they are as near as no picture can show.
fn correspond(a: &Column, b: &Column, pixel: f64) -> bool {
    let near = |a: &Interval<f64>, b: &Interval<f64>| (a.lo - b.lo).abs().max((a.hi - b.hi).abs()) < pixel / 2.0;
    let same = a.intervals.len() == b.intervals.len();
    let pairs = || a.intervals.iter().zip(&b.intervals);
    let own = pairs().all(|(a, b)| a.meets(*b));
    let next = |a: &Column, b: &Column| a.intervals.iter().zip(b.intervals.iter().skip(1)).any(|(a, b)| a.meets(*b));
    same && (own && !next(a, b) && !next(b, a) || pairs().all(|(a, b)| near(a, b)))
}

/// The outlines through the ends of all intervals.
///
/// Each end is passed once: a lower end in the direction of time, an upper one against it. `next` says where each
/// leads to; where two columns do not correspond, a lower end on the left or an upper end on the right leads to its
/// partner on the vertical line between them.
fn outline(columns: &[Column], pixel: [f64; 2]) -> Outline {
    let mut firsts = Vec::with_capacity(columns.len());
    let mut points = Vec::new();
    for column in columns {
        firsts.push(points.len());
        points.extend(column.intervals.iter().flat_map(|slice| [[column.time, slice.lo], [column.time, slice.hi]]));
    }
    let mut next: Vec<usize> = (0..points.len()).collect();
    let ends = |k: usize| {
        let first = firsts.get(k).copied().unwrap_or(points.len());
        first..firsts.get(k + 1).copied().unwrap_or(points.len())
    };
    let empty = Column { time: 0.0, intervals: Vec::new() };
    for k in 0..=columns.len() {
        let left = k.checked_sub(1).and_then(|left| columns.get(left)).unwrap_or(&empty);
        let right = columns.get(k).unwrap_or(&empty);
        let (on_left, on_right) = (k.checked_sub(1).map_or(0..0, &ends), ends(k));
        if correspond(left, right, pixel[1]) {
            for (a, b) in on_left.zip(on_right) {
                // Even places are lower ends: all columns begin at one.
                let (from, to) = if a.is_multiple_of(2) { (a, b) } else { (b, a) };
                next[from] = to;
            }
        } else {
            let arrives = |end: usize| (end < on_right.start) == end.is_multiple_of(2);
            let mut line: Vec<usize> = on_left.clone().chain(on_right.clone()).collect();
            line.sort_by(|a, b| points[*a][1].total_cmp(&points[*b][1]));
            for pair in line.chunks_exact(2) {
                let (from, to) = if arrives(pair[0]) { (pair[0], pair[1]) } else { (pair[1], pair[0]) };
                next[from] = to;
            }
        }
    }
    cycles(&points, &next, pixel)
}

/// The cycles of `next`, without points that no picture can tell from the one before them.
fn cycles(points: &[[f64; 2]], next: &[usize], pixel: [f64; 2]) -> Outline {
    let mut visited = vec![false; points.len()];
    let mut outline = Outline::new();
    for start in 0..points.len() {
        let mut contour: Vec<[f64; 2]> = Vec::new();
        let mut at = start;
        while !visited[at] {
            visited[at] = true;
            let apart = contour.last().is_none_or(|last| {
                let [x, y] = scaled([points[at][0] - last[0], points[at][1] - last[1]], pixel);
                x.hypot(y) > TOLERANCE
            });
            if apart {
                contour.push(points[at]);
            }
            at = next[at];
        }
        if !contour.is_empty() {
            outline.push(contour);
        }
    }
    // A region is connected: of several outlines, one that is a point is rounding at a tip or a pinch.
    if outline.iter().any(|contour| contour.len() > 1) {
        outline.retain(|contour| contour.len() > 1);
    }
    outline
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fleet::{Fleet, build_ecm};
    use crate::scenario::Scenario;
    use serde_json::{Value, json};

    /// Distance of an outline from the contour \[m\]: slices are rounded outward by a few ulp of some 10 m.
    const RESIDUAL: f64 = 1e-9;

    /// Pixels along each side of a region in these tests.
    const PIXELS: f64 = 1000.0;

    /// Area between an outline and the region, as a part of the box around it: [`TOLERANCE`] along an outline of at
    /// most four sides, twice as long for the bends.
    const AREA: f64 = 8.0 * TOLERANCE / PIXELS;

    fn scenario(agents: &Value) -> Scenario {
        Scenario::from_json(&json!({ "agents": agents }).to_string()).unwrap()
    }

    /// Calls `check` with every region of the scenario, its ego and its outline.
    fn for_all(scenario: &Scenario, mut check: impl FnMut(&RegionRef<'_, f64>, &Motion<'_, f64>, &Outline)) {
        let fleet = Fleet::<f64>::new(scenario).unwrap();
        let motions = fleet.motions();
        let ecm = build_ecm(&motions).unwrap();
        for region in ecm.regions(&motions) {
            let ego = &motions[region.ego()];
            let pixel = [region.time(), region.length()].map(|side| side.length().max(1e-6) / PIXELS);
            check(&region, ego, &trace(&region, ego, pixel));
        }
    }

    fn area(contour: &[[f64; 2]]) -> f64 {
        let sides = contour.iter().zip(contour.iter().cycle().skip(1));
        sides.map(|(a, b)| (a[0] - contour[0][0]) * (b[1] - a[1]) - (a[1] - contour[0][1]) * (b[0] - a[0])).sum::<f64>()
            / 2.0
    }

    fn golden() -> Vec<Value> {
        let text = include_str!("../../../tests/data/golden-public.json");
        let golden: Value = serde_json::from_str(text).unwrap();
        golden["cases"].as_array().unwrap().iter().filter(|case| case["uncertain"] == json!(false)).cloned().collect()
    }

    fn golden_scenario(case: &Value) -> Scenario {
        let mut agents = [case["i"].clone(), case["j"].clone()];
        agents[0]["id"] = json!(1);
        agents[1]["id"] = json!(2);
        scenario(&json!(agents))
    }

    #[test]
    fn every_point_is_on_the_contour_or_at_an_end_of_the_path() {
        let paper = Scenario::from_json(include_str!("../../../tests/data/paper12.json")).unwrap();
        for scenario in golden().iter().map(golden_scenario).chain([paper]) {
            for_all(&scenario, |region, ego, outline| {
                let (other, whole) = (region.other_motion(), ego.path().length());
                for [time, length] in outline.iter().flatten() {
                    let (a, b) = (ego.path().point_at(*length), other.position_at(*time));
                    let residual = (a.x - b.x).hypot(a.y - b.y) - ego.radius() - other.radius();
                    let at_end = *length <= RESIDUAL || *length >= whole - RESIDUAL;
                    assert!(residual.abs() < RESIDUAL || at_end && residual < 0.0, "{time} {length} {residual:e}");
                }
            });
        }
    }

    #[test]
    fn outlines_enclose_the_areas_of_the_reference_regions() {
        let mut regions = 0;
        for case in golden() {
            let mut found = Vec::new();
            for_all(&golden_scenario(&case), |region, _, outline| {
                if region.ego() == 0 {
                    let (time, length) = (region.time(), region.length());
                    found
                        .push(([time.lo, time.hi, length.lo, length.hi], outline.iter().map(|c| area(c)).sum::<f64>()));
                }
            });
            for component in case["components"].as_array().unwrap() {
                let extents =
                    [("t", 0), ("t", 1), ("l", 0), ("l", 1)].map(|(key, k)| component[key][k].as_f64().unwrap());
                let same = |found: &[f64; 4]| found.iter().zip(extents).all(|(a, b)| (a - b).abs() < RESIDUAL);
                let (_, inside) = found.iter().find(|(found, _)| same(found)).unwrap();
                let want = component["area"].as_f64().unwrap();
                let bounds = (extents[1] - extents[0]) * (extents[3] - extents[2]);
                assert!((inside - want).abs() <= AREA * bounds + 1e-12, "{}: {inside} for {want}", case["name"]);
                regions += 1;
            }
        }
        assert!(regions > 300, "{regions}");
    }

    #[test]
    fn a_crossing_is_one_outline_around_a_region_without_holes() {
        let paper = Scenario::from_json(include_str!("../../../tests/data/paper12.json")).unwrap();
        for_all(&paper, |region, _, outline| {
            assert_eq!(outline.len(), 1, "{} {}", region.ego(), region.other());
            assert!(area(&outline[0]) > 0.0);
        });
    }

    #[test]
    fn a_region_that_splits_and_merges_again_has_a_hole() {
        // The ego comes back on a second lane; the other goes down between the lanes and back.
        let agents = json!([
            { "id": 1, "radius": 0.4, "v_max": 1, "a_max": 1, "start": { "x": 0, "y": -0.5, "heading": 0 }, "path": [
                { "kind": "line", "length": 6 }, { "kind": "arc", "radius": 0.5, "sweep": std::f64::consts::PI },
                { "kind": "line", "length": 6 } ] },
            { "id": 2, "radius": 0.4, "v_max": 1, "a_max": 1,
              "start": { "x": 6.2, "y": 0.1, "heading": std::f64::consts::PI }, "path": [
                { "kind": "line", "length": 3 }, { "kind": "arc", "radius": 0.1, "sweep": std::f64::consts::PI },
                { "kind": "line", "length": 3 } ] }
        ]);
        let mut seen = 0;
        for_all(&scenario(&agents), |region, _, outline| {
            if region.ego() == 0 {
                let mut areas: Vec<f64> = outline.iter().map(|contour| area(contour)).collect();
                areas.sort_by(f64::total_cmp);
                assert!(matches!(areas[..], [hole, all] if hole < 0.0 && all > -hole), "{areas:?}");
                seen += 1;
            }
        });
        assert_eq!(seen, 1);
    }

    #[test]
    fn the_region_of_a_standing_agent_is_a_line() {
        let agents = json!([
            { "id": 1, "radius": 0.3, "v_max": 1, "a_max": 1, "start": { "x": 0, "y": 0, "heading": 0 },
              "path": [{ "kind": "line", "length": 4 }] },
            { "id": 2, "radius": 0.3, "v_max": 1, "a_max": 1, "t_start": 5, "start": { "x": 2, "y": 0, "heading": 0 }, "path": [] }
        ]);
        for_all(&scenario(&agents), |region, _, outline| {
            assert_eq!(outline.len(), 1);
            if region.ego() == 0 {
                assert!(outline[0].iter().all(|[time, _]| *time == 5.0));
                let lengths: Vec<f64> = outline[0].iter().map(|[_, length]| *length).collect();
                assert!(matches!(lengths[..], [lo, hi] if (lo - 1.4).abs() < RESIDUAL && (hi - 2.6).abs() < RESIDUAL));
            }
        });
    }

    #[test]
    fn columns_are_limited_by_the_size_of_the_picture() {
        // Two discs of a micrometre that follow one another over a hundred kilometres.
        let agent = |id, x| {
            json!({ "id": id, "radius": 1e-6, "v_max": 10, "a_max": 1, "start": { "x": x, "y": 0, "heading": 0 },
            "path": [{ "kind": "line", "length": 1e5 }] })
        };
        for_all(&scenario(&json!([agent(1, 0.0), agent(2, 1.0)])), |_, _, outline| {
            let points = outline.iter().map(Vec::len).sum::<usize>();
            assert!((4..10 * PIXELS as usize).contains(&points), "{points}");
        });
    }
}
