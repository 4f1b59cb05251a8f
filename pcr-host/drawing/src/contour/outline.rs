//! Connects columns of slices to closed outlines.

use super::TOLERANCE;
use pcr_core::Interval;

/// Closed outlines, region to the left: counter-clockwise about the region, clockwise about its holes.
/// Points are (time \[s\], length \[m\]).
pub(crate) type RegionOutline = Vec<Vec<[f64; 2]>>;

/// The slice of a region at one time.
#[derive(Clone, Debug)]
pub(super) struct OutlineColumn {
    pub(super) time: f64,
    pub(super) intervals: Vec<Interval<f64>>,
}

/// A point or step in pixels.
pub(super) fn scaled(point: [f64; 2], pixel: [f64; 2]) -> [f64; 2] {
    [point[0] / pixel[0], point[1] / pixel[1]]
}

/// Whether the intervals of two columns correspond one to one: each meets the one of the same number, and no
/// other, or they are as near as no picture can show.
pub(super) fn correspond(a: &OutlineColumn, b: &OutlineColumn, pixel: f64) -> bool {
    let near = |a: &Interval<f64>, b: &Interval<f64>| (a.lo - b.lo).abs().max((a.hi - b.hi).abs()) < pixel / 2.0;
    let same = a.intervals.len() == b.intervals.len();
    let pairs = || a.intervals.iter().zip(&b.intervals);
    let own = pairs().all(|(a, b)| a.meets(*b));
    let next = |a: &OutlineColumn, b: &OutlineColumn| {
        a.intervals.iter().zip(b.intervals.iter().skip(1)).any(|(a, b)| a.meets(*b))
    };
    same && (own && !next(a, b) && !next(b, a) || pairs().all(|(a, b)| near(a, b)))
}

/// The outlines through the ends of all intervals.
///
/// Each end is passed once: a lower end in the direction of time, an upper one against it. `next` says where each
/// leads to; where two columns do not correspond, a lower end on the left or an upper end on the right leads to its
/// partner on the vertical line between them.
pub(super) fn outline(columns: &[OutlineColumn], pixel: [f64; 2]) -> RegionOutline {
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
    let empty = OutlineColumn { time: 0.0, intervals: Vec::new() };
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
fn cycles(points: &[[f64; 2]], next: &[usize], pixel: [f64; 2]) -> RegionOutline {
    let mut visited = vec![false; points.len()];
    let mut outline = RegionOutline::new();
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

/// Whether a contour, in pixels, encloses next to nothing: on the average over its length less than `width`.
pub(in super::super) fn is_thin(contour: &[[f64; 2]], width: f64) -> bool {
    let [mut area, mut perimeter] = [0.0; 2];
    let Some(origin) = contour.first() else {
        return true;
    };
    for (a, b) in contour.iter().zip(contour.iter().cycle().skip(1)) {
        let step = [b[0] - a[0], b[1] - a[1]];
        area += (a[0] - origin[0]) * step[1] - (a[1] - origin[1]) * step[0];
        perimeter += step[0].hypot(step[1]);
    }
    // A band of this width has half its perimeter as its length.
    area.abs() <= width * perimeter
}
