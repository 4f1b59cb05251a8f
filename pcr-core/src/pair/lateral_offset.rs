//! P3, offset against segment: where a segment J has the lateral offset `c` from the carrier of a segment I.
//!
//! The base is the foot of I's start on the carrier of J. There, `n` is the offset of I's start from J and `α` the
//! angle from I to J. With the signed curvatures `κ`, the squared distance between I's centre and J's point at
//! half-tangent `T = tan(κ_J u / 2) / κ_J` gives one quadratic equation for all four types,
//!
//! ```text
//! A T² - 4 sin α T + G = 0
//! G = 2 (c + n cos α) + κ_I (n² - c²)
//! A = 4 κ_I - 4 κ_J (κ_I n + cos α) + κ_J² G,
//! ```
//!
//! multiplied below by the radii, so that it contains only lengths and products of lengths. The base is near I, so no
//! coefficient is much larger than the quantities it is computed from. With `c = ±R` the roots are the first and last
//! contacts of Eq. (17), (23), (33), (37); with `c = 0` the crossings of the two paths. For an arc I with `R > ϱ`, the
//! offset beyond the centre is the circle of radius `R - ϱ`; the equation includes it.

use super::disc_on_segment::CarrierCoordinates;
use super::lengths::LengthList;
use crate::geometry::{Direction, Point};
use crate::scalar::{Angle, AngleSector, Scalar, Wide};
use crate::segment::{Curve, Segment, TurnSide};
use core::hint::select_unpredictable as select;

/// A carrier: an infinite line or a full circle, given by start, direction there and shape.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Carrier<S: Scalar> {
    pub(crate) start: Point<S>,
    pub(crate) direction: Direction<S>,
    pub(crate) curve: Curve<S>,
}

impl<S: Scalar> From<&Segment<S>> for Carrier<S> {
    fn from(segment: &Segment<S>) -> Self {
        Self { start: segment.start, direction: segment.direction, curve: segment.curve }
    }
}

/// A carrier in the coordinates of a segment (mirrored if that turns right).
#[derive(Clone, Copy, Debug)]
pub(crate) struct RelativeCarrier<'a, S: Scalar> {
    segment: &'a Segment<S>,
    /// The carrier's start.
    start: &'a CarrierCoordinates<S>,
    /// Direction of the segment at the foot of the carrier's start, in the (mirrored) frame of the segment's start.
    base: Direction<S>,
    /// Cosine and sine of the angle from the carrier to the segment there.
    cos: S::Unit,
    sin: S::Unit,
    /// Signed radius of the carrier, left positive; `None` for a line.
    bend: Option<S>,
}

impl<'a, S: Scalar> RelativeCarrier<'a, S> {
    /// The carrier whose start has this footprint on the segment.
    pub(crate) fn new(segment: &'a Segment<S>, carrier: Carrier<S>, start: &'a CarrierCoordinates<S>) -> Self {
        let mirror = segment.mirrored();
        let (cos, sin) = (segment.direction.dot(carrier.direction), segment.direction.cross(carrier.direction));
        let towards = Direction::<S> { cos, sin: if mirror { -sin } else { sin } };
        let base = start.direction(segment);
        let bend = match carrier.curve {
            Curve::Line | Curve::Pivot { .. } => None,
            Curve::Arc { radius, turn } => Some(radius.negate_if(mirror != (turn == TurnSide::Right))),
        };
        Self { segment, start, base, cos: towards.dot(base), sin: towards.cross(base), bend }
    }

    /// The offset of a point at this distance outside of the carrier's circle, or to the right of a line.
    pub(crate) fn outward(&self, distance: S) -> S {
        match self.bend {
            Some(bend) if bend < S::ZERO => distance,
            _ => -distance,
        }
    }

    /// Adds the lengths of the segment at which it has one of the offsets `c` from the carrier. The ends of the segment
    /// are included, and a margin beyond them.
    ///
    /// If the segment misses an offset by less than `doubt`, rounding may be the reason; then the length at which it
    /// comes nearest to the offset is added. A slab that is judged by its middle alone is cut there.
    pub(crate) fn lengths_at(&self, offsets: &[S], margin: S, doubt: S, found: &mut LengthList<S>) {
        // The rounding error of a distance at any extent: because of it P3 may miss a contact that P1 finds, and the
        // contact would be lost. An additional event is harmless.
        let doubt = doubt + S::slack(S::ZERO);
        match self.segment.curve {
            Curve::Line | Curve::Pivot { .. } => self.lengths_of_line(offsets, margin, doubt, found),
            Curve::Arc { radius, .. } => self.lengths_of_arc(radius, offsets, margin, doubt, found),
        }
    }

    /// J is a line: `2 T = u`.
    fn lengths_of_line(&self, offsets: &[S], margin: S, doubt: S, found: &mut LengthList<S>) {
        let Self { segment, cos, sin, bend, .. } = *self;
        let n = self.start.offset;
        let foot = self.start.foot(segment);
        let mut add = |root: S| {
            let u = foot + root;
            found.add(u, (-margin <= u) & (u <= segment.length + margin));
        };
        for &c in offsets {
            let lateral = c + n.scale(cos);
            match bend {
                // SS: (c + n cos α) / sin α, the one division by a sine.
                None => {
                    if let Some(u) = lateral.quotient_unit(sin) {
                        add(u);
                    }
                }
                // I is an arc: u² - 2 ϱ sin α u + ϱ G = 0.
                Some(bend) => {
                    let doubt = (bend.abs() + c.abs()).times(doubt).double();
                    let g = Self::constant(bend, lateral, n, c);
                    if let Some([a, b]) = S::quadratic_roots(-bend.scale(sin), g, doubt) {
                        add(a);
                        add(b);
                    }
                }
            }
        }
    }

    /// J is an arc: `T = r τ`. Lengths beyond its ends may be left out.
    fn lengths_of_arc(&self, r: S, offsets: &[S], margin: S, doubt: S, found: &mut LengthList<S>) {
        let Self { segment, base, cos, sin, bend, .. } = *self;
        let n = self.start.offset;
        let equations = offsets.iter().map(|&c| {
            let lateral = c + n.scale(cos);
            match bend {
                // I is a line, equation times r / 2: G = 2 lateral.
                None => {
                    let far = lateral - r.scale(cos).double();
                    [r.times(far), -r.times(r.scale(sin)), r.times(lateral), r.times(doubt)]
                }
                // Both are arcs, equation times ϱ (κ_I = 1/ϱ).
                Some(bend) => {
                    let g = Self::constant(bend, lateral, n, c);
                    let centre = n + bend.scale(cos) - r;
                    let a = g - r.double().times(centre.double());
                    let doubt = (bend.abs() + c.abs()).times(doubt).double();
                    [a, -r.double().times(bend.scale(sin)), g, doubt]
                }
            }
        });
        let sector = if margin > S::ZERO { AngleSector::all([base.cos, base.sin]) } else { segment.sector(base) };
        S::half_tangent_roots(equations, sector, |angle| {
            let u = on_first_lap(angle.arc_length(r), segment, margin);
            found.add(u, (-margin <= u) & (u <= segment.length + margin));
        });
    }

    /// `ϱ G = 2 ϱ (c + n cos α) + n² - c²`.
    fn constant(bend: S, lateral: S, n: S, c: S) -> S::Wide {
        bend.times(lateral).double() + (n - c).times(n + c)
    }
}

/// Moves a length along a circle, less than one lap away, to the first lap, unless it is within the margin of it. Lines
/// have one lap only and a circumference of 0, so nothing moves.
#[cfg_attr(not(feature = "std"), inline(never))]
pub(crate) fn on_first_lap<S: Scalar>(length: S, segment: &Segment<S>, margin: S) -> S {
    let lap = segment.circumference;
    let length = select(length > lap + margin, length - lap, length);
    select(length < -margin, length + lap, length)
}
