//! Where, along the other agent's path, the slices of a region can begin, end, split or merge.
//!
//! Between these lengths the number of intervals in a slice is constant. It can change where the other's disc, enlarged
//! by the ego's radius, touches a segment of the ego from the side (the distance to its carrier is R) or an end of it
//! (the distance to that point is R), and where a piece of the region ends. Additional events do no harm.

use pcr_core::{Curve, PieceRef, Point, RegionRef, Segment, TurnSide};
use std::f64::consts::TAU;

/// The events of a region along the other's path \[m\], in no order.
pub(super) fn lengths(region: &RegionRef<'_, f64>, radius: f64) -> Vec<f64> {
    let range = region.other_length();
    let mut events: Vec<f64> = region.pieces().flat_map(|piece| of_piece(&piece, radius)).collect();
    events.extend([range.lo, range.hi]);
    events.retain(|event| range.contains(*event));
    events
}

fn of_piece(piece: &PieceRef<'_, f64>, radius: f64) -> Vec<f64> {
    let (ego, other) = (piece.ego, CentredSegment::of(piece.other));
    let ends = [0.0, ego.length()].map(|end| ego.point_at(end));
    let mut local: Vec<f64> = ends.iter().flat_map(|end| other.at_distance_from(*end, radius)).collect();
    match CentredSegment::of(ego).curve {
        CentredCurve::Line => {
            local.extend([-radius, radius].into_iter().flat_map(|offset| other.at_offset_from(ego, offset)))
        }
        CentredCurve::Arc { centre, radius: bend, .. } => {
            let rings = [bend + radius, (bend - radius).abs()];
            local.extend(rings.into_iter().flat_map(|ring| other.at_distance_from(centre, ring)));
        }
    }
    let from = piece.other.from();
    let mut events = vec![piece.other_length.lo, piece.other_length.hi, from, from + piece.other.length()];
    events.extend(local.into_iter().filter(|u| (0.0..=piece.other.length()).contains(u)).map(|u| from + u));
    events
}

/// A segment as the textbook has it: an arc by its centre.
struct CentredSegment {
    start: Point<f64>,
    heading: f64,
    curve: CentredCurve,
}

enum CentredCurve {
    Line,
    Arc {
        centre: Point<f64>,
        radius: f64,
        /// Angle of the start as seen from the centre \[rad\].
        from: f64,
        /// 1 to the left, -1 to the right.
        turn: f64,
    },
}

impl CentredSegment {
    fn of(segment: &Segment<f64>) -> Self {
        let (start, heading) = (segment.point_at(0.0), segment.heading_at(0.0).0);
        let curve = match segment.curve() {
            // Of a turn in place its point counts, as an end.
            Curve::Line | Curve::Pivot { .. } => CentredCurve::Line,
            Curve::Arc { radius, turn } => {
                let turn = if turn == TurnSide::Left { 1.0 } else { -1.0 };
                let (sin, cos) = heading.sin_cos();
                let centre = Point::new(start.x - turn * radius * sin, start.y + turn * radius * cos);
                CentredCurve::Arc { centre, radius, from: heading - turn * TAU / 4.0, turn }
            }
        };
        Self { start, heading, curve }
    }

    /// Lengths along the carrier, from the start on, at which it is at this distance from a point; on a circle
    /// those of the first lap.
    fn at_distance_from(&self, point: Point<f64>, distance: f64) -> Vec<f64> {
        match self.curve {
            CentredCurve::Line => {
                let (sin, cos) = self.heading.sin_cos();
                let (x, y) = (point.x - self.start.x, point.y - self.start.y);
                let (along, across) = (x * cos + y * sin, y * cos - x * sin);
                let half = ((distance - across) * (distance + across)).max(0.0).sqrt();
                vec![along - half, along + half]
            }
            CentredCurve::Arc { centre, radius, .. } => {
                let (x, y) = (point.x - centre.x, point.y - centre.y);
                let apart = x.hypot(y);
                let cosine = (radius * radius + (apart - distance) * (apart + distance)) / (2.0 * radius * apart);
                self.at_angles(y.atan2(x), cosine)
            }
        }
    }

    /// The same for a signed distance to the carrier of a line.
    fn at_offset_from(&self, line: &Segment<f64>, offset: f64) -> Vec<f64> {
        let (sin, cos) = line.heading_at(0.0).0.sin_cos();
        let origin = line.point_at(0.0);
        let offset_of = |point: Point<f64>| (point.y - origin.y) * cos - (point.x - origin.x) * sin;
        match self.curve {
            CentredCurve::Line => {
                let slope = (self.heading - line.heading_at(0.0).0).sin();
                vec![(offset - offset_of(self.start)) / slope]
            }
            CentredCurve::Arc { centre, radius, .. } => {
                self.at_angles(cos.atan2(-sin), (offset - offset_of(centre)) / radius)
            }
        }
    }

    /// Lengths at which the angle seen from the centre differs from `middle` by the arc cosine.
    fn at_angles(&self, middle: f64, cosine: f64) -> Vec<f64> {
        let CentredCurve::Arc { radius, from, turn, .. } = self.curve else {
            return Vec::new();
        };
        // Of a cosine beyond 1 by rounding a touch is left; elsewhere an event too many does no harm.
        let half = cosine.clamp(-1.0, 1.0).acos();
        [middle - half, middle + half].map(|angle| (turn * (angle - from)).rem_euclid(TAU) * radius).to_vec()
    }
}
