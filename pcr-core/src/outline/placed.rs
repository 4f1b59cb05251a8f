//! Outlines carried along a segment, with their heading at a fixed angle to it: translated on a line, turned about the centre of an arc, or about
//! the reference point on a turn in place.

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
    /// The start of a line, the centre about which the outline turns otherwise.
    pub(crate) origin: Point<S>,
    /// The corners at the start of the segment, relative to the origin.
    pub(crate) corners: Corners<S>,
    /// Length for each radian by which the outline turns \[m\]: the radius of an arc, the lever of a turn in place.
    pub(crate) bend: Option<S>,
    /// How far a corner moves at most during a length, as the length and the largest distance.
    moves: [S; 2],
}

impl<'a, S: Scalar> Carried<'a, S> {
    pub(crate) fn new(segment: &'a Segment<S>, outline: OutlineRef<'_, S>) -> Self {
        let radius = match segment.curve {
            Curve::Line | Curve::Pivot { .. } => S::ZERO,
            Curve::Arc { radius, .. } => radius,
        };
        let (origin, bend) = (segment.centre(radius), segment.curve.lever());
        // The reference point at the start, as seen from the origin along and across the heading there.
        let across = (-radius).negate_if(segment.mirrored());
        let body = segment.body();
        let place = |corner: &Corner<S>| {
            let at = body.vector(corner.at.x, corner.at.y);
            Corner {
                at: segment.direction.vector(at.x, at.y + across),
                outward: segment.direction.plus(body.plus(corner.outward)),
                length: corner.length,
            }
        };
        let mut corners = ArrayVec::new(place(&Corner::CENTRE));
        let own = outline.corners();
        own.iter().for_each(|corner| corners.add(place(corner), true));
        corners.add(place(&Corner::CENTRE), own.is_empty());
        let moves = bend.map_or([S::ZERO; 2], |lever| [lever, radius + outline.spread()]);
        Self { segment, origin, corners, bend, moves }
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

    /// The turn since the start of the segment.
    fn turn(&self, length: S) -> Direction<S> {
        let Some(lever) = self.bend else { return Direction::X };
        let (sin, cos) = S::Angle::half_subtended(length, lever).sin_cos();
        let half = Direction { cos, sin: if self.segment.mirrored() { -sin } else { sin } };
        half.plus(half)
    }

    /// The length in `[0, circumference)` after which the outline has turned by the angle of a direction \[m\].
    pub(crate) fn length_of(&self, turn: Direction<S>) -> S {
        let Some(lever) = self.bend else { return S::ZERO };
        let (along, across) = (lever.scale(turn.cos), lever.scale(turn.sin));
        let length = S::Angle::atan2(across.negate_if(self.segment.mirrored()), along).arc_length(lever);
        if length < S::ZERO { length + self.segment.circumference } else { length }
    }

    /// A length along the segment during which no corner moves farther than `by` \[m\].
    pub(crate) fn within(&self, by: S) -> S {
        let [length, most] = self.moves;
        if most > length { by.portion(length, most) } else { by }
    }
}
