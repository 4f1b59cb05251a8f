//! Where on an edge a vehicle is in a zone of a file: for certain, entirely, or possibly.

use crate::convex_outline::{depth, distance, sides_meet};
use crate::curve_proximity::{lengths_near_polygon, lengths_of_outline};
use pcr_formats::import::{ImportedLayout, RouteStep, VehicleTraits};
use pcr_formats::scenario::{PathSegment, PlacedSegment};
use pcr_planning::exclusion_table::{EdgeTraversal, EdgeTraversals, placed_pieces};

/// By how much vehicles have to reach farther than to the border of a zone that they are said to need, or to be within: less than
/// [`BEYOND`] \[m\].
const SURE: f64 = 1e-7;

/// How much farther off vehicles are said to reach into a zone: more than what counts as contact in an audit \[m\].
const POSSIBLE: f64 = 1e-4;

/// A zone of a file that others are kept out of.
pub(super) struct ReleaseZone {
    pub(super) map: String,
    /// Nobody enters it.
    pub(super) blocked: bool,
    pub(super) polygon: Vec<[f64; 2]>,
    /// Corners of the box around it.
    pub(super) bounds: [[f64; 2]; 2],
}

/// Lengths of an edge at which a vehicle is in a zone.
#[derive(Default)]
pub(super) struct ZoneIntervals {
    /// The vehicle is certainly in the zone, at least in part.
    pub(super) certain: Vec<[f64; 2]>,
    /// The vehicle is certainly in the zone entirely.
    pub(super) whole: Vec<[f64; 2]>,
    /// The vehicle may be in the zone in part.
    pub(super) possible: Vec<[f64; 2]>,
}

/// Where on an edge a vehicle with an outline turns in place, its presence there is said of so much of the edge on both sides \[m\].
const TURNING: f64 = 1e-4;

/// Lengths that differ by no more are the end of an edge \[m\].
const SAME: f64 = 1e-9;

/// Bounds on how far vehicles reach from their centres.
pub(super) struct OutlineRadii {
    /// All points at most this far from the centre are in the contour \[m\]; `None` if the centre is outside, because then
    /// nothing is known.
    pub(super) inner: Option<f64>,
    /// Bound on the distance of the points of the contour from the centre \[m\].
    outer: f64,
    /// Bound on the distance of the centre from its edge \[m\].
    position_error: f64,
}

impl OutlineRadii {
    pub(super) fn of(imported: &ImportedLayout) -> Self {
        let vehicle = &imported.vehicle;
        let inner = match &vehicle.footprint {
            None => Some(vehicle.radius),
            Some(footprint) => Some(depth(footprint.polygon(), [0.0; 2])).filter(|depth| *depth >= 0.0),
        };
        // A margin is for how far vehicles are off their edges: their contours are no larger for it.
        Self { inner, outer: vehicle.radius, position_error: vehicle.margin }
    }

    /// Lengths of a curve at which a vehicle is in a zone; `deviation` bounds the distance of the true curve from this one
    /// \[m\].
    pub(super) fn entered(&self, curve: &[PlacedSegment], deviation: f64, zone: &ReleaseZone) -> ZoneIntervals {
        let off = self.position_error + deviation;
        let far = self.outer + off + POSSIBLE;
        if !near(curve, far, zone.bounds) {
            return ZoneIntervals::default();
        }
        let within = |reach| lengths_near_polygon(curve, &zone.polygon, reach);
        ZoneIntervals {
            // If the centre is outside the contour, only a zone that contains the whole contour is certain to contain a part of
            // it.
            certain: within(self.inner.unwrap_or(-self.outer) - off - SURE),
            whole: within(-(self.outer + off + SURE)),
            possible: within(far),
        }
    }
}

/// The lengths of an edge in one direction at which a vehicle with an outline is in zones.
pub(super) struct OutlinePresence<'a> {
    pub(super) rides: &'a EdgeTraversals<'a>,
    pub(super) vehicle: &'a VehicleTraits,
    pub(super) inner: Option<f64>,
}

impl OutlinePresence<'_> {
    /// The rides in one direction, each with where it goes.
    pub(super) fn ways(&self, step: RouteStep<'_>) -> Vec<(EdgeTraversal, Vec<PlacedSegment>)> {
        let rides = self.rides.in_direction(step).into_iter();
        rides.map(|ride| (placed_pieces(&ride.agent), ride)).map(|(path, ride)| (ride, path)).collect()
    }

    pub(super) fn entered(
        &self,
        step: RouteStep<'_>,
        ways: &[(EdgeTraversal, Vec<PlacedSegment>)],
        zone: &ReleaseZone,
    ) -> ZoneIntervals {
        let length = step.edge.length();
        let mut all = ZoneIntervals::default();
        let (mut uncertain, mut not_whole) = (Vec::new(), Vec::new());
        for (ride, path) in ways {
            let here = self.of_ride(step, ride, path, zone);
            match ride.turns_at() {
                None => {
                    let enclosed = |ranges: Vec<[f64; 2]>| {
                        let inner = ranges.into_iter().filter_map(|range| ride.enclosed_lengths(range));
                        inner.map(|[from, to]| [from, if to >= length - SAME { length } else { to }]).collect()
                    };
                    all.certain = enclosed(here.certain);
                    all.whole = enclosed(here.whole);
                    let touched = here.possible.into_iter().map(|range| ride.touched_lengths(range));
                    all.possible.extend(touched.map(|[from, to]| [from, to.min(length)]));
                }
                Some(at) => {
                    let beside = [at - TURNING, at + TURNING];
                    let angle: f64 = path.iter().map(|piece| piece.shape.sweep().abs()).sum();
                    let is_all =
                        |ranges: &[[f64; 2]]| ranges.iter().any(|[from, to]| *from <= SAME && *to >= angle - SAME);
                    if !is_all(&here.certain) {
                        uncertain.push(beside);
                    }
                    if !is_all(&here.whole) {
                        not_whole.push(beside);
                    }
                    if !here.possible.is_empty() {
                        all.possible.push(beside.map(|end| end.clamp(0.0, length)));
                    }
                }
            }
        }
        all.certain = without(all.certain, &uncertain);
        all.whole = without(all.whole, &not_whole);
        all
    }

    /// Returns the lengths on the path of a ride at which the vehicle is in a zone.
    fn of_ride(
        &self,
        step: RouteStep<'_>,
        ride: &EdgeTraversal,
        path: &[PlacedSegment],
        zone: &ReleaseZone,
    ) -> ZoneIntervals {
        let agent = &ride.agent;
        if !near(path, agent.radius + POSSIBLE, zone.bounds) {
            return ZoneIntervals::default();
        }
        let (corners, growth) = match &agent.footprint {
            Some(footprint) => (footprint.polygon(), footprint.growth()),
            None => (&[[0.0; 2]][..], agent.radius),
        };
        let (far, deep) = (growth + POSSIBLE, growth + SURE);
        let polygon = &zone.polygon[..];
        let touches = |placed: &[[f64; 2]]| {
            let is_near =
                |own: &[[f64; 2]], other: &[[f64; 2]]| own.iter().any(|&corner| distance(other, corner) <= far);
            is_near(placed, polygon) || is_near(polygon, placed) || sides_meet(placed, polygon)
        };
        let encloses = |placed: &[[f64; 2]]| {
            placed.iter().all(|&corner| depth(polygon, corner) >= deep)
                && polygon.iter().all(|&corner| depth(placed, corner) <= -deep)
                && !sides_meet(placed, polygon)
        };
        // What the vehicle itself covers, of which the agent has the hull if it may face either way, and the margin with other
        // deviations.
        let known = step.facing().angle_at(0.0).filter(|_| agent.footprint.is_some());
        let contour = known.and_then(|_| self.vehicle.facing(step.facing()).footprint);
        let off = agent.radius - self.vehicle.radius + SURE;
        let mut certain = Vec::new();
        if let Some(contour) = &contour {
            let room = off - contour.growth();
            certain.extend(lengths_of_outline(path, contour.polygon(), polygon, &[room], |placed| {
                placed.iter().any(|&corner| depth(polygon, corner) >= room)
                    || polygon.iter().any(|&corner| depth(placed, corner) >= room)
            }));
        }
        if let Some(inner) = self.inner {
            let room = off - inner;
            certain.extend(lengths_of_outline(path, &[[0.0; 2]], polygon, &[room], |placed| {
                placed.iter().all(|&centre| depth(polygon, centre) >= room)
            }));
        }
        ZoneIntervals {
            certain: joined(certain),
            whole: lengths_of_outline(path, corners, polygon, &[deep], encloses),
            possible: lengths_of_outline(path, corners, polygon, &[far], touches),
        }
    }
}

/// Ranges in ascending order, those that overlap as one.
fn joined(mut ranges: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    ranges.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut all: Vec<[f64; 2]> = Vec::new();
    for next in ranges {
        match all.last_mut() {
            Some(last) if next[0] < last[1] => last[1] = last[1].max(next[1]),
            _ => all.push(next),
        }
    }
    all
}

/// Ranges without what is in others.
fn without(ranges: Vec<[f64; 2]>, others: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let cut = |ranges: Vec<[f64; 2]>, &[from, to]: &[f64; 2]| {
        let rest = ranges.into_iter().flat_map(|[lo, hi]| [[lo, hi.min(from)], [lo.max(to), hi]]);
        rest.filter(|[lo, hi]| lo < hi).collect()
    };
    others.iter().fold(ranges, cut)
}

/// Whether a curve can come so near a box.
fn near(curve: &[PlacedSegment], far: f64, [lo, hi]: [[f64; 2]; 2]) -> bool {
    curve.iter().any(|piece| {
        let ends = [piece.start, piece.end()];
        // No point of a piece is farther from both ends than half its length.
        let room = match piece.shape {
            PathSegment::Arc { .. } => piece.shape.length() / 2.0,
            _ => 0.0,
        };
        (0..2).all(|x| {
            let (least, most) = (ends[0][x].min(ends[1][x]), ends[0][x].max(ends[1][x]));
            least - room - far <= hi[x] && lo[x] <= most + room + far
        })
    })
}

pub(super) fn bounds(polygon: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let of = |pick: fn(f64, f64) -> f64, from: f64| [0, 1].map(|x| polygon.iter().map(|at| at[x]).fold(from, pick));
    [of(f64::min, f64::INFINITY), of(f64::max, f64::NEG_INFINITY)]
}

/// The intersection of two lists of ranges.
pub(super) fn both(a: &[[f64; 2]], b: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let pairs = a.iter().flat_map(|a| b.iter().map(move |b| [a[0].max(b[0]), a[1].min(b[1])]));
    pairs.filter(|[from, to]| from <= to).collect()
}
