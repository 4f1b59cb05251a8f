//! Outlines carried along a segment, with their heading along it: translated on a line, turned about the centre of an arc.

use crate::array_vec::ArrayVec;
use crate::geometry::{Direction, Point, Vector};
use crate::outline::{Corner, MOST_CORNERS, OutlineRef};
use crate::scalar::{Angle, Scalar};
use crate::segment::{Curve, Segment};

/// The corners of a placed outline, relative to some origin; at least one.
pub(crate) type Corners<S> = ArrayVec<Corner<S>, MOST_CORNERS>;

/// An outline carried along a segment.
pub(crate) struct Carried<'a, S: Scalar> {
    pub(crate) segment: &'a Segment<S>,
    /// The start of a line, the centre of an arc.
    pub(crate) origin: Point<S>,
    /// The corners at the start of the segment, relative to the origin.
    pub(crate) corners: Corners<S>,
    /// Radius of an arc \[m\].
    pub(crate) bend: Option<S>,
    /// How far a corner moves at most while the reference point moves by a length, as the length and the largest distance.
    lever: [S; 2],
}

impl<'a, S: Scalar> Carried<'a, S> {
    pub(crate) fn new(segment: &'a Segment<S>, outline: OutlineRef<'_, S>) -> Self {
        let (origin, bend) = match segment.curve {
            Curve::Line => (segment.start, None),
            Curve::Arc { radius, .. } => (segment.centre(radius), Some(radius)),
        };
        // The reference point at the start, as seen from the origin along and across the heading there.
        let across = bend.map_or(S::ZERO, |radius| (-radius).negate_if(segment.mirrored()));
        let place = |corner: &Corner<S>| Corner {
            at: segment.direction.vector(corner.at.x, corner.at.y + across),
            outward: segment.direction.plus(corner.outward),
            length: corner.length,
        };
        let mut corners = ArrayVec::new(place(&Corner::CENTRE));
        let own = outline.corners();
        own.iter().for_each(|corner| corners.add(place(corner), true));
        corners.add(place(&Corner::CENTRE), own.is_empty());
        let reach = bend.map_or(S::ZERO, |radius| radius + outline.spread());
        Self { segment, origin, corners, bend, lever: [bend.unwrap_or(S::ZERO), reach] }
    }

    /// The corners at a length of the segment \[m\], relative to a point.
    pub(crate) fn at(&self, length: S, from: Point<S>) -> Corners<S> {
        let shift = self.origin - from;
        let (turn, shift) = if self.bend.is_some() {
            (self.turn(length), shift)
        } else {
            let way = self.segment.direction.vector(length, S::ZERO);
            (Direction::X, Vector { x: shift.x + way.x, y: shift.y + way.y })
        };
        let mut corners = ArrayVec::new(Corner::CENTRE);
        for corner in self.corners.as_slice() {
            let (at, outward) = if self.bend.is_some() {
                (turn.vector(corner.at.x, corner.at.y), turn.plus(corner.outward))
            } else {
                (corner.at, corner.outward)
            };
            let at = Vector { x: at.x + shift.x, y: at.y + shift.y };
            corners.add(Corner { at, outward, length: corner.length }, true);
        }
        corners
    }

    /// The turn of an arc since its start.
    fn turn(&self, length: S) -> Direction<S> {
        let Some(radius) = self.bend else { return Direction::X };
        let (sin, cos) = S::Angle::half_subtended(length, radius).sin_cos();
        let half = Direction { cos, sin: if self.segment.mirrored() { -sin } else { sin } };
        half.plus(half)
    }

    /// The length in `[0, circumference)` after which an arc has turned by the angle of a direction \[m\].
    pub(crate) fn length_of(&self, turn: Direction<S>) -> S {
        let Some(radius) = self.bend else { return S::ZERO };
        let (along, across) = (radius.scale(turn.cos), radius.scale(turn.sin));
        let length = S::Angle::atan2(across.negate_if(self.segment.mirrored()), along).arc_length(radius);
        if length < S::ZERO { length + self.segment.circumference } else { length }
    }

    /// A length along the segment during which no corner moves farther than `by` \[m\].
    pub(crate) fn within(&self, by: S) -> S {
        let [length, most] = self.lever;
        if most > length { by.portion(length, most) } else { by }
    }
}
