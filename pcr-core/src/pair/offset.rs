//! P3, offset against piece: where a piece J runs at the lateral offset `c` from the carrier of a piece I.
//!
//! Take as base the foot of I's start on the carrier of J. There, `n` is the offset of I's start from J and
//! `α` the angle from I to J; with the signed curvatures `κ` the square of the distance between J's point at
//! half-tangent `T = tan(κ_J u / 2) / κ_J` and I's centre gives one quadratic for all four types,
//!
//! ```text
//! A T² - 4 sin α T + G = 0
//! G = 2 (c + n cos α) + κ_I (n² - c²)
//! A = 4 κ_I - 4 κ_J (κ_I n + cos α) + κ_J² G,
//! ```
//!
//! multiplied below by the radii, so that it holds lengths and products of lengths only. The base is near
//! I, hence no coefficient is large against what it is made of. With `c = ±R` the roots are the first and last
//! contacts of Eq. (17), (23), (33), (37); with `c = 0` the crossings of the two paths. For an arc I with `R > ϱ`
//! the offset beyond the centre is the circle of radius `R - ϱ`, included.

use super::footprint::Footprint;
use crate::geometry::{Direction, Point};
use crate::scalar::{Angle, Scalar, Sector, Wide};
use crate::segment::{Curve, Segment, Turn};

/// An infinite line or a full circle: start, direction there, shape.
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

/// A carrier seen from a segment (mirrored if that turns right).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relative<'a, S: Scalar> {
    segment: &'a Segment<S>,
    /// The carrier's start.
    start: &'a Footprint<S>,
    /// Direction of the segment at the foot of the carrier's start, in the (mirrored) frame of its start.
    base: Direction<S>,
    /// Angle from the carrier to the segment there.
    cos: S::Unit,
    sin: S::Unit,
    /// Signed radius of the carrier, left positive; `None` for a line.
    bend: Option<S>,
}

impl<'a, S: Scalar> Relative<'a, S> {
    /// The carrier whose start has this footprint on the segment.
    pub(crate) fn new(segment: &'a Segment<S>, carrier: Carrier<S>, start: &'a Footprint<S>) -> Self {
        let mirror = segment.mirrored();
        let (cos, sin) = (segment.direction.dot(carrier.direction), segment.direction.cross(carrier.direction));
        let towards = Direction::<S> { cos, sin: if mirror { -sin } else { sin } };
        let base = start.direction(segment);
        let bend = match carrier.curve {
            Curve::Line => None,
            Curve::Arc { radius, turn } => Some(if mirror == (turn == Turn::Right) { radius } else { -radius }),
        };
        Self { segment, start, base, cos: towards.dot(base), sin: towards.cross(base), bend }
    }

    /// The offset of what is this far outside of the carrier's circle; on the right of a line.
    pub(crate) fn outward(&self, distance: S) -> S {
        match self.bend {
            Some(bend) if bend < S::ZERO => distance,
            _ => -distance,
        }
    }

    /// The lengths of the segment, ends and a margin beyond them included, at which it has one of the offsets `c` from
    /// the carrier.
    ///
    /// Where the segment only just misses an offset, by `doubt`, this may be rounding: then the length is found at which it
    /// comes nearest to it. A slab that would be judged by its middle alone, by rounding, is cut there.
    pub(crate) fn lengths_at(&self, offsets: &[S], margin: S, doubt: S, mut found: impl FnMut(S)) {
        let mut foot = None;
        // What rounding does to a distance whatever the extent: it may take a contact from P3 that P1 has not, and then
        // nobody would tell of it. An event too many is harmless.
        let doubt = doubt + S::slack(S::ZERO);
        for &c in offsets {
            let Some(roots) = self.roots(c, margin, doubt) else {
                continue;
            };
            for root in roots {
                let Some(u) = root else {
                    continue;
                };
                let foot = *foot.get_or_insert_with(|| self.start.foot(self.segment));
                let u = on_first_lap(foot + u, self.segment, margin);
                if -margin <= u && u <= self.segment.length + margin {
                    found(u);
                }
            }
        }
    }

    /// The lengths of the segment's carrier, from the base, at which it has the offset `c`; on an arc those on the segment
    /// and some more.
    fn roots(&self, c: S, margin: S, doubt: S) -> Option<[Option<S>; 2]> {
        let Self { cos, sin, bend, .. } = *self;
        let n = self.start.offset;
        let lateral = c + n.scale(cos);
        let Curve::Arc { radius: r, .. } = self.segment.curve else {
            // J is a line: 2 T = u.
            return match bend {
                // SS: (c + n cos α) / sin α, the one division by a sine.
                None => Some([Some(lateral.quotient_unit(sin)?), None]),
                // I is an arc: u² - 2 ϱ sin α u + ϱ G = 0.
                Some(bend) => {
                    let doubt = (bend.abs() + c.abs()).times(doubt).double();
                    let g = Self::constant(bend, lateral, n, c);
                    S::quadratic_roots(-bend.scale(sin), g, doubt).map(|roots| roots.map(Some))
                }
            };
        };
        // J is an arc: T = r τ.
        let sector = if margin > S::ZERO { Sector::all() } else { self.segment.sector(self.base) };
        let angles = match bend {
            // I is a line, equation times r / 2: G = 2 lateral.
            None => {
                let far = lateral - r.scale(cos).double();
                S::half_tangent_roots(r.times(far), -r.times(r.scale(sin)), r.times(lateral), r.times(doubt), sector)?
            }
            // Both are arcs, equation times ϱ (κ_I = 1/ϱ).
            Some(bend) => {
                let g = Self::constant(bend, lateral, n, c);
                let centre = n + bend.scale(cos) - r;
                let a = g - r.double().times(centre.double());
                let doubt = (bend.abs() + c.abs()).times(doubt).double();
                S::half_tangent_roots(a, -r.double().times(bend.scale(sin)), g, doubt, sector)?
            }
        };
        Some(angles.map(|angle| angle.map(|angle| angle.arc_length(r))))
    }

    /// `ϱ G = 2 ϱ (c + n cos α) + n² - c²`.
    fn constant(bend: S, lateral: S, n: S, c: S) -> S::Wide {
        bend.times(lateral).double() + (n - c).times(n + c)
    }
}

/// A length along a circle, less than one lap away, moved onto its first lap unless it is within the margin of it.
/// Lines have one lap only.
#[inline(never)]
pub(crate) fn on_first_lap<S: Scalar>(length: S, segment: &Segment<S>, margin: S) -> S {
    if length < -margin {
        length + segment.circumference
    } else if length > segment.circumference + margin && segment.circumference > S::ZERO {
        length - segment.circumference
    } else {
        length
    }
}
