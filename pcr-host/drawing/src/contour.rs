//! The outline of a collision region in the plane of time and travelled length.
//!
//! The exact slices of the region are computed at *columns* of time. Columns lie between neighbouring events
//! ([`events`]) at the cosines of equal angles, so that the vertical tangents at the ends of a region, where its slices
//! shrink like a square root, are resolved as well as its flanks. A column is added where a straight line would deviate
//! from the outline by more than [`TOLERANCE`]. Between two columns whose intervals correspond one to one, the outline
//! follows their ends. Where slices begin, end, split or merge, columns are added close to that time, and the outline
//! follows the vertical line there: the ends on it are joined in pairs from below.

mod events;
mod outline;

pub(crate) use outline::RegionOutline;
pub(super) use outline::is_thin;
use outline::{OutlineColumn, correspond, outline, scaled};
use pcr_core::{Interval, Motion, RegionRef, excess};
use std::f64::consts::PI;

/// Largest distance of an outline from its chord \[px\].
pub(super) const TOLERANCE: f64 = 0.03;

/// Columns between two events before any is added.
const FIRST_COLUMNS: usize = 6;

/// Halvings of the angle between two columns; 26 of them leave 10⁻¹⁵ of the time between two events.
const HALVINGS: u32 = 26;

/// Columns of a region at most. Only a region whose parts are far below a pixel, and many, comes near it.
const MOST_COLUMNS: usize = 20_000;

/// The outline of a region while the other agent is on its way; `pixel` is the size of a pixel \[s\], \[m\].
pub(crate) fn trace(region: &RegionRef<'_, f64>, ego: &Motion<'_, f64>, pixel: [f64; 2]) -> RegionOutline {
    let other = region.other_motion();
    let radius = ego.radius() + other.radius() + 0.5 * excess(ego, other);
    let mut tracer = OutlineTracer { region, pixel, columns: Vec::new() };
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

struct OutlineTracer<'r, 'a> {
    region: &'r RegionRef<'a, f64>,
    pixel: [f64; 2],
    columns: Vec<OutlineColumn>,
}

impl OutlineTracer<'_, '_> {
    fn column(&self, time: f64) -> OutlineColumn {
        OutlineColumn { time, intervals: self.region.slice_at(time).collect() }
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
    fn refine(
        &mut self,
        time_at: &dyn Fn(f64) -> f64,
        a: &(f64, OutlineColumn),
        b: &(f64, OutlineColumn),
        halvings: u32,
    ) {
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

    fn is_straight(&self, a: &OutlineColumn, middle: &OutlineColumn, b: &OutlineColumn) -> bool {
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

fn distance_to_chord(a: [f64; 2], p: [f64; 2], b: [f64; 2]) -> f64 {
    let (chord, offset) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let length = chord[0].hypot(chord[1]);
    if length > 0.0 { (chord[0] * offset[1] - chord[1] * offset[0]).abs() / length } else { offset[0].hypot(offset[1]) }
}

#[cfg(test)]
mod tests;
