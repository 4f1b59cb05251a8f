//! Outlines carried along a segment: translated on a line, turned about the centre of an arc, or about the reference point on a turn in place;
//! on a steady arc translated along a circle.

use crate::array_vec::ArrayVec;
use crate::geometry::{Direction, Point, Vector, turned_back};
use crate::outline::{Corner, MOST_CORNERS, OutlineRef, opposite};
use crate::scalar::{Angle, Scalar};
use crate::segment::{Curve, Segment};

/// The corners of a placed outline, relative to some origin; at least one.
pub(crate) type Corners<S> = ArrayVec<Corner<S>, MOST_CORNERS>;

/// How a segment carries an outline.
#[derive(Clone, Copy)]
pub(crate) enum Carriage<S: Scalar> {
    /// Straight on; the origin is the start.
    Straight,
    /// About the origin. The length for each radian is the radius of an arc, or the lever of a turn in place \[m\].
    Turning(S),
    /// Along a circle, without turning.
    Circling(Circle<S>),
}

/// The circle about the origin along which an outline moves without turning.
#[derive(Clone, Copy)]
pub(crate) struct Circle<S: Scalar> {
    pub(crate) radius: S,
    /// Direction from the origin to the reference point at the start.
    start: Direction<S>,
}

/// An outline carried along a segment.
pub(crate) struct Carried<'a, S: Scalar> {
    pub(crate) segment: &'a Segment<S>,
    /// The start of a line, the centre of an arc or a turn in place.
    pub(crate) origin: Point<S>,
    /// The corners at the start of the segment, relative to the origin; on a circle relative to the reference point, so that it is the place of the
    /// outline with the reference point at the origin.
    pub(crate) corners: Corners<S>,
    pub(crate) carriage: Carriage<S>,
    /// How far a corner moves at most during a length, as the length and the largest distance.
    moves: [S; 2],
}

impl<'a, S: Scalar> Carried<'a, S> {
    pub(crate) fn new(segment: &'a Segment<S>, outline: OutlineRef<'_, S>) -> Self {
        let radius = match segment.curve {
            Curve::Line | Curve::Pivot { .. } => S::ZERO,
            Curve::Arc { radius, .. } => radius,
        };
        let carriage = match segment.curve.lever() {
            None => Carriage::Straight,
            Some(_) if segment.is_steady() => {
                let Direction { cos, sin } = segment.direction;
                let right = Direction { cos: sin, sin: -cos };
                let start = if segment.mirrored() { opposite(right) } else { right };
                Carriage::Circling(Circle { radius, start })
            }
            Some(lever) => Carriage::Turning(lever),
        };
        // The reference point at the start, as seen from the origin along and across the heading there.
        let across = match carriage {
            Carriage::Circling(_) => S::ZERO,
            Carriage::Straight | Carriage::Turning(_) => (-radius).negate_if(segment.mirrored()),
        };
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
        let moves = match carriage {
            Carriage::Turning(lever) => [lever, radius + outline.spread()],
            Carriage::Straight | Carriage::Circling(_) => [S::ZERO; 2],
        };
        Self { segment, origin: segment.centre(radius), corners, carriage, moves }
    }

    /// The corners at a length of the segment \[m\], relative to a point.
    pub(crate) fn at(&self, length: S, from: Point<S>) -> Corners<S> {
        let shift = self.origin - from;
        let (turn, shift) = match self.carriage {
            Carriage::Turning(_) => (Some(self.turn(length)), shift),
            Carriage::Straight => {
                let way = self.segment.direction.vector(length, S::ZERO);
                (None, Vector { x: shift.x + way.x, y: shift.y + way.y })
            }
            Carriage::Circling(_) => (None, self.segment.point_at(length) - from),
        };
        let mut corners = ArrayVec::new(Corner::CENTRE);
        for corner in self.corners.as_slice() {
            let (at, outward) = match turn {
                Some(turn) => (turn.vector(corner.at.x, corner.at.y), turn.plus(corner.outward)),
                None => (corner.at, corner.outward),
            };
            let at = Vector { x: at.x + shift.x, y: at.y + shift.y };
            corners.add(Corner { at, outward, length: corner.length }, true);
        }
        corners
    }

    /// Returns whether the segment is a line.
    pub(crate) fn is_straight(&self) -> bool {
        matches!(self.carriage, Carriage::Straight)
    }

    /// Length for each radian by which the outline or its way turns \[m\].
    fn lever(&self) -> Option<S> {
        match self.carriage {
            Carriage::Straight => None,
            Carriage::Turning(lever) => Some(lever),
            Carriage::Circling(circle) => Some(circle.radius),
        }
    }

    /// The turn of the way since the start of the segment.
    pub(crate) fn turn(&self, length: S) -> Direction<S> {
        let Some(lever) = self.lever() else { return Direction::X };
        let (sin, cos) = S::Angle::half_subtended(length, lever).sin_cos();
        let half = Direction { cos, sin: if self.segment.mirrored() { -sin } else { sin } };
        half.plus(half)
    }

    /// The length in `[0, circumference)` at which the reference point is in this direction from the centre of the circle \[m\].
    pub(crate) fn length_towards(&self, circle: Circle<S>, direction: Direction<S>) -> S {
        self.length_of(turned_back(direction, circle.start))
    }

    /// The length in `[0, circumference)` after which the outline, or its way on a circle, has turned by the angle of a direction \[m\].
    pub(crate) fn length_of(&self, turn: Direction<S>) -> S {
        let Some(lever) = self.lever() else { return S::ZERO };
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
