//! Lines, arcs and turns in place, placed in the plane.
//!
//! A segment is defined by its start, the heading there, its curvature and its length; everything else is derived once,
//! when it is built. A point of an arc is computed from half the chord,
//!
//! ```text
//! p(u) = p₀ + 2ϱ sin(h) e(ϑ + h),   h = u / 2ϱ  to the left,
//! ```
//!
//! which keeps its relative accuracy for every radius, also for almost straight arcs.

mod aabb;
mod proximity;

pub(crate) use proximity::{ROW, in_box};

use crate::error::{self, InvalidInput, in_range};
use crate::geometry::{Aabb, Direction, Point, Pose, Vector, turned_back};
use crate::scalar::{Angle, AngleSector, Scalar, Unit};

/// Side to which an arc bends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum TurnSide {
    /// Counter-clockwise.
    Left,
    /// Clockwise.
    Right,
}

/// Shape of a segment: the S and A of the paper's SCC paths, and turns in place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Curve<S> {
    /// Straight line.
    Line,
    /// Circular arc.
    Arc {
        /// Radius of curvature \[m\], positive.
        radius: S,
        /// Side to which it bends.
        turn: TurnSide,
    },
    /// Turn in place: the reference point stays, and the heading turns by the travelled length divided by the lever \[rad\].
    Pivot {
        /// Travelled length for each radian \[m\], positive. Speeds of a profile are those of a point at this distance from the
        /// reference point.
        lever: S,
        /// Side to which it turns.
        turn: TurnSide,
    },
}

impl<S: Scalar> Curve<S> {
    /// Travelled length for each radian by which the heading turns \[m\]; `None` on a line.
    pub(crate) fn lever(self) -> Option<S> {
        match self {
            Self::Line => None,
            Self::Arc { radius: lever, .. } | Self::Pivot { lever, .. } => Some(lever),
        }
    }
}

/// A line, an arc or a turn in place, placed in the plane, part of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Segment<S: Scalar> {
    pub(crate) start: Point<S>,
    pub(crate) end: Point<S>,
    pub(crate) direction: Direction<S>,
    pub(crate) heading: S::Angle,
    heading_at_end: S::Angle,
    /// Angle from the direction of travel to the heading of the body; on a steady arc that at its start. Discs have none.
    #[cfg(feature = "outlines")]
    facing: Direction<S>,
    /// Whether the body keeps its heading on an arc.
    #[cfg(feature = "outlines")]
    steady: bool,
    pub(crate) curve: Curve<S>,
    /// Length of a full turn \[m\]: of the circle of an arc, or of a turn in place.
    pub(crate) circumference: S,
    pub(crate) length: S,
    /// Angle by which an arc or a turn in place turns up to its middle, as a direction; counted to the left.
    half_turn: Direction<S>,
    /// Lengths of the path at the start and at the end of this segment \[m\].
    pub(crate) from: S,
    pub(crate) to: S,
    rest: SegmentRounding<S>,
    pub(crate) bounds: Aabb<S>,
    /// The smallest box along the chord: direction of the chord, middle of the box, and its half extents along and
    /// across \[m\].
    axis: Direction<S>,
    middle: Point<S>,
    half: [S; 2],
}

/// Rounding errors at the end of a segment. The next segment takes them into account, so that they do not add up along
/// a path.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
struct SegmentRounding<S: Scalar> {
    position: Vector<S>,
    heading: S::Angle,
    length: S,
}

impl<S: Scalar> SegmentRounding<S> {
    const NOTHING: Self =
        Self { position: Vector { x: S::ZERO, y: S::ZERO }, heading: S::Angle::ZERO, length: S::ZERO };
}

impl<S: Scalar> Segment<S> {
    /// The line of length 0 with which a path begins.
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`]; [`InvalidInput::OutOfRange`], also for a heading of so many turns that its direction is
    /// inaccurate: beyond 1024 rad in `f32`, 2²⁴ rad in `f64`.
    pub fn standing(pose: Pose<S>) -> Result<Self, InvalidInput> {
        in_range(pose.position.x, "x")?;
        in_range(pose.position.y, "y")?;
        if !pose.heading.is_finite() {
            return Err(InvalidInput::NonFinite("heading"));
        }
        heading_in_range::<S>(pose.heading)?;
        Ok(Self {
            start: pose.position,
            end: pose.position,
            direction: Direction::at(pose.heading),
            heading: pose.heading,
            heading_at_end: pose.heading,
            #[cfg(feature = "outlines")]
            facing: Direction::X,
            #[cfg(feature = "outlines")]
            steady: false,
            curve: Curve::Line,
            circumference: S::ZERO,
            length: S::ZERO,
            half_turn: Direction::X,
            from: S::ZERO,
            to: S::ZERO,
            rest: SegmentRounding::NOTHING,
            bounds: Aabb::around(pose.position, pose.position),
            axis: Direction::X,
            middle: pose.position,
            half: [S::ZERO; 2],
        })
    }

    /// The line of this length \[m\] that continues the path at the end of `self`.
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::Negative`], [`InvalidInput::OutOfRange`] (also for the end point and the
    /// length of the path).
    pub fn then_line(&self, length: S) -> Result<Self, InvalidInput> {
        let length = error::length(length)?;
        let mut line = self.then(Curve::Line, S::ZERO, length);
        line.lay();
        line.checked()
    }

    /// The arc of this radius \[m\] and length \[m\] that continues the path at the end of `self`.
    ///
    /// # Errors
    /// As [`Segment::then_line`]; [`InvalidInput::OutOfRange`] also for the diameter, the box of the arc (from half a turn
    /// on that of its circle) and the heading at its end, as in [`Segment::standing`]; [`InvalidInput::NonPositive`] and
    /// [`InvalidInput::TooSmall`] for the radius; [`InvalidInput::SweepOverOneTurn`].
    pub fn then_arc(&self, radius: S, turn: TurnSide, length: S) -> Result<Self, InvalidInput> {
        error::radius(radius)?;
        in_range(radius.double(), "diameter of the arc")?;
        self.then_turning(Curve::Arc { radius, turn }, [radius, length], turn)
    }

    /// The arc of [`Segment::then_arc`] on which the body keeps the heading that it has at its start. On the segments
    /// that continue it the body is at the angle to the direction of travel that it has at the end of the arc.
    ///
    /// # Errors
    /// As [`Segment::then_arc`]; [`InvalidInput::NeedsOutlines`].
    pub fn then_steady_arc(&self, radius: S, turn: TurnSide, length: S) -> Result<Self, InvalidInput> {
        self.then_arc(radius, turn, length)?.steadied()
    }

    #[cfg(feature = "outlines")]
    fn steadied(self) -> Result<Self, InvalidInput> {
        Ok(Self { steady: true, ..self })
    }

    #[cfg(not(feature = "outlines"))]
    fn steadied(self) -> Result<Self, InvalidInput> {
        Err(InvalidInput::NeedsOutlines)
    }

    /// The turn in place of this length \[m\] that continues the path at the end of `self`: the reference point stays, and the
    /// heading turns by the length divided by the lever \[rad\]. A disc stands for as long; any other outline sweeps what its corners pass.
    ///
    /// # Errors
    /// As [`Segment::then_line`]; [`InvalidInput::NonPositive`] and [`InvalidInput::TooSmall`] for the lever \[m\], [`InvalidInput::OutOfRange`]
    /// for twice the lever, and for the heading at its end, as in [`Segment::standing`]; [`InvalidInput::SweepOverOneTurn`];
    /// [`InvalidInput::NeedsOutlines`].
    pub fn then_pivot(&self, lever: S, turn: TurnSide, length: S) -> Result<Self, InvalidInput> {
        if !cfg!(feature = "outlines") {
            return Err(InvalidInput::NeedsOutlines);
        }
        if error::positive(lever, "lever")? < S::LEAST {
            return Err(InvalidInput::TooSmall("lever"));
        }
        in_range(lever.double(), "lever")?;
        self.then_turning(Curve::Pivot { lever, turn }, [lever, length], turn)
    }

    /// The arc or turn in place of this length with this length for each radian.
    fn then_turning(&self, curve: Curve<S>, [lever, length]: [S; 2], turn: TurnSide) -> Result<Self, InvalidInput> {
        let length = error::length(length)?;
        let circumference = S::Angle::circumference(lever);
        // The length of a full turn may be a product `sweep * radius` with a rounding error.
        if length > circumference + S::slack(circumference) {
            return Err(InvalidInput::SweepOverOneTurn);
        }
        let length = length.min(circumference);
        let sweep = S::Angle::subtended(length, lever);
        let mut segment = self.then(curve, circumference, length);
        let rest = sweep.subtended_rest(length, lever);
        let (sweep, rest) = match turn {
            TurnSide::Left => (sweep, rest),
            TurnSide::Right => (-sweep, -rest),
        };
        let (heading, rounding) = segment.heading.sum(sweep);
        (segment.heading_at_end, segment.rest.heading) = heading.sum(rounding + (rest + segment.rest.heading));
        segment.lay();
        segment.checked()
    }

    /// Returns the segment with a turn in place after it, by an angle, to the left if it is positive: the next segment
    /// begins with the new heading. A disc does not move while it turns, so a turn has no length.
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`] for the heading after the turn, as in [`Segment::standing`].
    pub fn turned(mut self, by: S::Angle) -> Result<Self, InvalidInput> {
        if !by.is_finite() {
            return Err(InvalidInput::NonFinite("turn"));
        }
        let (heading, rounding) = self.heading_at_end.sum(by);
        (self.heading_at_end, self.rest.heading) = heading.sum(rounding + self.rest.heading);
        heading_in_range::<S>(self.heading_at_end)?;
        Ok(self)
    }

    /// Returns this segment for a body whose heading is at this angle to the direction of travel, counted to the left: 0 along it, half a turn
    /// against it, in reverse gear, anything else for vehicles that drive sideways; on a steady arc that at its start. The segments that continue it have the same angle, but
    /// behind a steady arc. An
    /// [`Outline`](crate::Outline) turns by it; to a disc it makes no difference. To change gear, turn the direction of travel as well: then the
    /// heading goes on ([`Path::reverse`](crate::Path::reverse)).
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`] for the angle, as in [`Segment::standing`]; [`InvalidInput::NeedsOutlines`].
    pub fn facing(self, angle: S::Angle) -> Result<Self, InvalidInput> {
        if !angle.is_finite() {
            return Err(InvalidInput::NonFinite("angle of the body"));
        }
        heading_in_range::<S>(angle)?;
        self.faced(Direction::at(angle))
    }

    /// Returns this segment for a body whose heading is opposite to the one it has now. It is the first segment after a change of gear, at
    /// which the direction of travel turns by half a turn ([`Segment::turned`]) and the heading of the body stays. Paths that are built in a
    /// fixed array by [`Path`](crate::Path) have [`Path::reverse`](crate::Path::reverse) for both.
    ///
    /// # Errors
    /// [`InvalidInput::NeedsOutlines`].
    pub fn facing_opposite(self) -> Result<Self, InvalidInput> {
        let facing = self.body();
        self.faced(Direction { cos: -facing.cos, sin: -facing.sin })
    }

    /// Returns this segment for a body whose heading is at the angle of `facing` to the direction of travel.
    #[cfg(feature = "outlines")]
    pub(crate) fn faced(self, facing: Direction<S>) -> Result<Self, InvalidInput> {
        Ok(Self { facing, ..self })
    }

    #[cfg(not(feature = "outlines"))]
    pub(crate) fn faced(self, _: Direction<S>) -> Result<Self, InvalidInput> {
        Err(InvalidInput::NeedsOutlines)
    }

    /// Angle from the direction of travel to the heading of the body, as a direction.
    pub(crate) fn body(&self) -> Direction<S> {
        #[cfg(feature = "outlines")]
        return self.facing;
        #[cfg(not(feature = "outlines"))]
        Direction::X
    }

    /// Whether the body keeps its heading, although the direction of travel turns ([`Segment::then_steady_arc`]).
    pub fn is_steady(&self) -> bool {
        #[cfg(feature = "outlines")]
        return self.steady;
        #[cfg(not(feature = "outlines"))]
        false
    }

    /// Angle from the direction of travel to the heading of the body behind this segment, as a direction.
    pub(crate) fn body_after(&self) -> Direction<S> {
        if !self.is_steady() {
            return self.body();
        }
        let half = self.signed_half_turn();
        turned_back(turned_back(self.body(), half), half)
    }

    /// Angle by which an arc or a turn in place turns up to its middle, as a direction.
    fn signed_half_turn(&self) -> Direction<S> {
        if self.mirrored() { self.half_turn.mirrored() } else { self.half_turn }
    }

    /// Whether the heading of the body jumps at the end of the segment, where another one or nothing follows, so that a point at the distance
    /// `reach` from the reference point moves by more than `by` \[m\].
    pub(crate) fn jumps_before(&self, next: Option<&Self>, reach: S, by: S) -> bool {
        let half = self.signed_half_turn();
        let turned = if self.is_steady() { self.direction } else { self.direction.plus(half).plus(half) };
        let before = turned.plus(self.body());
        let after = match next {
            Some(next) => next.direction.plus(next.body()),
            None => self.direction_after().plus(self.body_after()),
        };
        before.dot(after) < S::Unit::ZERO || reach.scale(before.cross(after)).abs() > by
    }

    /// Direction of travel of the segment that continues this one.
    fn direction_after(&self) -> Direction<S> {
        Direction::at(self.heading_at_end).turned_by(self.rest.heading)
    }

    /// A segment of this shape at the end of `self`; its end is not valid yet.
    fn then(&self, curve: Curve<S>, circumference: S, length: S) -> Self {
        let (to, rounding) = self.to.sum(length);
        let (to, rest) = to.sum(rounding + self.rest.length);
        let direction = self.direction_after();
        Self {
            start: self.end,
            end: self.end,
            direction,
            heading: self.heading_at_end,
            heading_at_end: self.heading_at_end,
            #[cfg(feature = "outlines")]
            facing: self.body_after(),
            #[cfg(feature = "outlines")]
            steady: false,
            curve,
            circumference,
            length,
            half_turn: Direction::X,
            from: self.to,
            to,
            rest: SegmentRounding { length: rest, ..self.rest },
            bounds: Aabb::default(),
            axis: direction,
            middle: self.end,
            half: [S::ZERO; 2],
        }
    }

    /// The part between these lengths of the segment \[m\], `from <= to`, as a segment that begins its path. It is in
    /// range because the whole segment is, except for rounding.
    pub(crate) fn part(&self, from: S, to: S) -> Self {
        let (start, length) = (self.point_at(from), to - from);
        let mut part = Self {
            start,
            end: start,
            heading: self.heading_before_turn(from),
            heading_at_end: self.heading_before_turn(to),
            length,
            from: S::ZERO,
            to: length,
            rest: SegmentRounding::NOTHING,
            ..*self
        };
        if let Some(lever) = self.curve.lever() {
            // Not the direction of the heading, which is rounded: by more than a direction, after many turns.
            let (sin, cos) = S::Angle::half_subtended(from, lever).sin_cos();
            let half = Direction { cos, sin: if self.mirrored() { -sin } else { sin } };
            part.direction = self.direction.plus(half).plus(half);
            #[cfg(feature = "outlines")]
            if self.steady {
                part.facing = turned_back(turned_back(self.facing, half), half);
            }
        }
        part.lay();
        part
    }

    /// Computes what follows from start, direction, curve and length: the end and the boxes.
    fn lay(&mut self) {
        self.advance();
        match self.curve {
            Curve::Line => {
                self.bounds = Aabb::around(self.start, self.end);
                self.middle = self.start + self.axis.vector(self.length.half(), S::ZERO);
                self.half = [self.length.half(), S::ZERO];
            }
            Curve::Arc { radius, turn } => self.enclose(radius, turn),
            Curve::Pivot { .. } => {
                self.bounds = Aabb::around(self.start, self.end);
                self.middle = self.start;
                self.half = [S::ZERO; 2];
            }
        }
    }

    /// Computes the end from the start, over the chord.
    fn advance(&mut self) {
        let length = match self.curve {
            Curve::Line => self.length,
            Curve::Arc { radius, .. } => {
                let (sin, cos) = S::Angle::half_subtended(self.length, radius).sin_cos();
                self.half_turn = Direction { cos, sin };
                self.axis = self.direction.plus(Direction { cos, sin: if self.mirrored() { -sin } else { sin } });
                radius.double().scale(sin)
            }
            Curve::Pivot { lever, .. } => {
                let (sin, cos) = S::Angle::half_subtended(self.length, lever).sin_cos();
                self.half_turn = Direction { cos, sin };
                return;
            }
        };
        let rest = self.rest.position;
        (self.end.x, self.rest.position.x) = self.start.x.advance(rest.x, length, self.axis.cos);
        (self.end.y, self.rest.position.y) = self.start.y.advance(rest.y, length, self.axis.sin);
    }

    fn checked(self) -> Result<Self, InvalidInput> {
        // The whole arc is checked, not only its end, because an arc may leave the range and come back.
        in_range(self.bounds.x.lo.min(-self.bounds.x.hi), "x")?;
        in_range(self.bounds.y.lo.min(-self.bounds.y.hi), "y")?;
        in_range(self.to, "length of the path")?;
        heading_in_range::<S>(self.heading_at_end)?;
        Ok(self)
    }

    /// Shape.
    pub fn curve(&self) -> Curve<S> {
        self.curve
    }

    /// Length \[m\].
    pub fn length(&self) -> S {
        self.length
    }

    /// Length of the path before this segment \[m\].
    pub fn from(&self) -> S {
        self.from
    }

    /// Box around the segment \[m\].
    pub fn bounds(&self) -> Aabb<S> {
        self.bounds
    }

    /// The point after `u` metres of this segment; `u` is clamped to `[0, length]`. Cost: one sine and cosine on an
    /// arc.
    pub fn point_at(&self, u: S) -> Point<S> {
        if u >= self.length {
            self.end
        } else if u <= S::ZERO {
            self.start
        } else {
            self.start + self.chord(u)
        }
    }

    /// Angle of the direction of travel after `u` metres; `u` is clamped to `[0, length]`. At the end it is the heading
    /// after the turn there.
    pub fn heading_at(&self, u: S) -> S::Angle {
        if u >= self.length { self.heading_at_end } else { self.heading_before_turn(u.max(S::ZERO)) }
    }

    /// The same without the turn at the end.
    fn heading_before_turn(&self, u: S) -> S::Angle {
        match self.curve.lever() {
            Some(lever) if self.mirrored() => self.heading - S::Angle::subtended(u, lever),
            Some(lever) => self.heading + S::Angle::subtended(u, lever),
            None => self.heading,
        }
    }

    /// Largest distance of a part of this length from its chord: `w² / 8ϱ`, the error of linear interpolation over
    /// length.
    pub(crate) fn bulge(&self, way: S) -> S {
        match self.curve {
            Curve::Line | Curve::Pivot { .. } => S::ZERO,
            Curve::Arc { radius, .. } => way.portion(way, radius.double().double().double()),
        }
    }

    /// Centre of an arc with this radius.
    pub(crate) fn centre(&self, radius: S) -> Point<S> {
        self.start + self.direction.vector(S::ZERO, radius.negate_if(self.mirrored()))
    }

    /// Whether the segment turns to the right. Coordinates along it are then mirrored, so that all arcs turn left.
    pub(crate) fn mirrored(&self) -> bool {
        matches!(self.curve, Curve::Arc { turn: TurnSide::Right, .. } | Curve::Pivot { turn: TurnSide::Right, .. })
    }

    /// Angle by which an arc or a turn in place turns, as a direction; counted to the left.
    pub(crate) fn turn_at_end(&self) -> Direction<S> {
        self.half_turn.plus(self.half_turn)
    }

    /// The angles at which an arc lies, seen from its centre and counted from the (mirrored) direction `from`.
    pub(crate) fn sector(&self, from: Direction<S>) -> AngleSector<S::Unit> {
        let least = self.half_turn.cos - S::Unit::COARSE;
        AngleSector { from: [from.cos, from.sin], middle: [self.half_turn.cos, self.half_turn.sin], least }
    }

    /// Vector from the start to the point after `u` metres.
    fn chord(&self, u: S) -> Vector<S> {
        let radius = match self.curve {
            Curve::Line => return self.direction.vector(u, S::ZERO),
            Curve::Pivot { .. } => return Vector { x: S::ZERO, y: S::ZERO },
            Curve::Arc { radius, .. } => radius,
        };
        let half = S::Angle::half_subtended(u, radius);
        let [x, y] = S::chord(radius, half, self.mirrored(), [self.direction.cos, self.direction.sin]);
        Vector { x, y }
    }
}

fn heading_in_range<S: Scalar>(heading: S::Angle) -> Result<(), InvalidInput> {
    if heading.is_in_range() { Ok(()) } else { Err(InvalidInput::OutOfRange("heading")) }
}

#[cfg(all(test, feature = "libm"))]
mod tests;
