//! Paths: chains of lines, arcs and turns in place (the map ρ from travelled length to position, Eq. 1). The heading is continuous,
//! except at turns without a length.

use crate::bit_rows::digest;
use crate::error::{InvalidInput, in_range};
use crate::geometry::{Aabb, Direction, Point, Pose};
use crate::scalar::{Angle, Scalar, Wide};
use crate::segment::{Curve, Segment, TurnSide};
use heapless::Vec;

/// Largest number of segments of a path: pieces store their indices in 16 bits.
const MOST_SEGMENTS: usize = u16::MAX as usize;

/// A path of at most `N` lines, arcs and turns in place; `N` is at most 65535. Each segment begins at the end of the one before it,
/// with the same heading unless there is a turn without a length ([`Path::turn`]).
///
/// ```
/// use pcr_core::{Path, Point, Pose, Radians, TurnSide};
/// let start = Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) };
/// let quarter = core::f64::consts::FRAC_PI_2;
/// let path = Path::<f64, 2>::starting_at(start)?.line(3.0)?.arc(1.0, TurnSide::Left, quarter)?;
/// let end = path.as_path().pose_at(3.0 + quarter).position;
/// assert!((end.x - 4.0).abs() < 1e-15 && (end.y - 1.0).abs() < 1e-15);
/// # Ok::<(), pcr_core::InvalidInput>(())
/// ```
/// The compiler refuses more segments than a table can number:
/// ```compile_fail,E0080
/// # use pcr_core::{Path, Point, Pose, Radians};
/// let _ = Path::<f64, 65536>::starting_at(Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) });
/// ```
#[derive(Clone, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Path<S: Scalar, const N: usize> {
    origin: Segment<S>,
    segments: Vec<Segment<S>, N>,
    /// Angle from the direction of travel to the heading of the body, for the next segments.
    facing: Option<Direction<S>>,
}

impl<S: Scalar, const N: usize> Path<S, N> {
    /// The path of length 0 at `pose`, of an agent that stands.
    ///
    /// # Errors
    /// [`InvalidInput::NonFinite`], [`InvalidInput::OutOfRange`].
    pub fn starting_at(pose: Pose<S>) -> Result<Self, InvalidInput> {
        // Pieces store indices of segments in 16 bits.
        const { assert!(N <= MOST_SEGMENTS, "a path has at most 65535 segments") };
        Ok(Self { origin: Segment::standing(pose)?, segments: Vec::new(), facing: None })
    }

    /// Appends a line of this length \[m\]; a length of 0 adds nothing.
    ///
    /// # Errors
    /// As [`Segment::then_line`], and [`InvalidInput::Full`] if there are `N` segments already.
    pub fn line(mut self, length: S) -> Result<Self, InvalidInput> {
        self.append_line(length)?;
        Ok(self)
    }

    /// Appends an arc of this radius \[m\] and length \[m\], at most a full turn; a length of 0 adds nothing.
    ///
    /// # Errors
    /// As [`Segment::then_arc`], and [`InvalidInput::Full`] if there are `N` segments already.
    pub fn arc(mut self, radius: S, turn: TurnSide, length: S) -> Result<Self, InvalidInput> {
        self.append_arc(radius, turn, length)?;
        Ok(self)
    }

    /// Appends an arc of this radius \[m\] and length \[m\] on which the body keeps its heading, as only vehicles with all wheels steered, or with Mecanum wheels, can. Behind it the
    /// body goes on at the angle to the direction of travel that it has there, until [`Path::facing`].
    ///
    /// # Errors
    /// As [`Path::arc`]; [`InvalidInput::NeedsOutlines`].
    ///
    /// ```
    /// # use pcr_core::{Motion, Outline, Path, Point, Pose, Profile, Radians, TurnSide};
    /// # let start = Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) };
    /// // A platform that looks east drives east, around a bend, and north, sideways.
    /// let quarter = core::f64::consts::FRAC_PI_2;
    /// let path = Path::<f64, 3>::starting_at(start)?.line(2.0)?.steady_arc(1.0, TurnSide::Left, quarter)?.line(1.0)?;
    /// let platform = Outline::<f64, 4>::rectangle(0.6, 0.6, 0.4, 0.4, 0.0)?;
    /// let profile = Profile::<f64, 1>::from_pieces(1.0, [(3.0 + quarter, 0.0)])?;
    /// assert!(Motion::with_outline(path.as_path(), profile.as_profile(), &platform, 0.0).is_ok());
    /// # Ok::<(), pcr_core::InvalidInput>(())
    /// ```
    pub fn steady_arc(mut self, radius: S, turn: TurnSide, length: S) -> Result<Self, InvalidInput> {
        self.append_steady_arc(radius, turn, length)?;
        Ok(self)
    }

    /// Appends an arc of this radius \[m\] that turns by `sweep` \[rad\], to the left if positive, by at most a full
    /// turn in either direction. Many file formats describe arcs this way. The length is radius · |sweep|, rounded
    /// once. `sweep` is a scalar and not an angle of the format, because binary angles only reach half a turn.
    ///
    /// # Errors
    /// As [`Path::arc`], and [`InvalidInput::NonFinite`] and [`InvalidInput::OutOfRange`] for the sweep.
    ///
    /// ```
    /// # use pcr_core::{Path, Point, Pose, Radians};
    /// # let start = Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) };
    /// let right = Path::<f64, 1>::starting_at(start)?.arc_by(2.0, -core::f64::consts::FRAC_PI_2)?;
    /// let end = right.as_path().pose_at(4.0).position;
    /// assert!((end.x - 2.0).abs() < 1e-15 && (end.y + 2.0).abs() < 1e-15);
    /// # Ok::<(), pcr_core::InvalidInput>(())
    /// ```
    pub fn arc_by(mut self, radius: S, sweep: S) -> Result<Self, InvalidInput> {
        let (turn, length) = swept(radius, sweep)?;
        self.append_arc(radius, turn, length)?;
        Ok(self)
    }

    /// Appends a turn in place by `sweep` \[rad\], to the left if positive, by at most a full turn in either direction. The reference point stays, and
    /// the travelled length is lever · |sweep|, rounded once: with a lever of 1 m a speed of 1 m/s in the profile is one radian a second. A disc
    /// stands for as long; any other outline sweeps what its corners pass.
    ///
    /// # Errors
    /// As [`Segment::then_pivot`]; [`InvalidInput::NonFinite`] and [`InvalidInput::OutOfRange`] for the sweep; [`InvalidInput::Full`] if
    /// there are `N` segments already.
    ///
    /// ```
    /// # use pcr_core::{Path, Point, Pose, Radians};
    /// # let start = Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) };
    /// let quarter = core::f64::consts::FRAC_PI_2;
    /// let path = Path::<f64, 3>::starting_at(start)?.line(2.0)?.pivot(0.5, quarter)?.line(1.0)?;
    /// let end = path.as_path().pose_at(3.0 + 0.5 * quarter);
    /// assert!((end.position.x - 2.0).abs() < 1e-15 && (end.position.y - 1.0).abs() < 1e-15);
    /// assert_eq!(end.heading, Radians(quarter));
    /// # Ok::<(), pcr_core::InvalidInput>(())
    /// ```
    pub fn pivot(mut self, lever: S, sweep: S) -> Result<Self, InvalidInput> {
        let (turn, length) = swept(lever, sweep)?;
        self.append_pivot(lever, turn, length)?;
        Ok(self)
    }

    /// Turns the direction of travel, to the left if the angle is positive. It needs no segment and has no length. A body other than a disc
    /// that turns with it takes [`Path::pivot`]; one whose heading stays, as that of a vehicle with steered wheels only, also
    /// [`Path::facing`] with the angle before it less this one.
    ///
    /// # Errors
    /// As [`Segment::turned`].
    pub fn turn(mut self, by: S::Angle) -> Result<Self, InvalidInput> {
        self.turn_by(by)?;
        Ok(self)
    }

    /// Sets the angle from the direction of travel to the heading of the body, counted to the left, for all segments that follow: 0, as at
    /// the beginning, for a body that looks ahead, half a turn in reverse gear, anything else for vehicles that drive sideways. It adds no
    /// segment. The heading of an outline must go on at joints: see [`Path::reverse`].
    ///
    /// # Errors
    /// As [`Segment::facing`].
    pub fn facing(mut self, angle: S::Angle) -> Result<Self, InvalidInput> {
        self.face(angle)?;
        Ok(self)
    }

    /// Changes gear at a cusp: the direction of travel turns by half a turn, and the heading of the body stays. It adds no segment, and
    /// nothing moves.
    ///
    /// # Errors
    /// As [`Segment::facing`] and [`Segment::turned`].
    ///
    /// ```
    /// use pcr_core::{Motion, Outline, Path, Point, Pose, Profile, Radians};
    /// // A forklift drives 2 m ahead, and 3 m back with its fork ahead of it all the time.
    /// let start = Pose { position: Point::new(0.0, 0.0), heading: Radians(0.0) };
    /// let path = Path::<f64, 2>::starting_at(start)?.line(2.0)?.reverse()?.line(3.0)?;
    /// assert!((path.as_path().point_at(5.0).x + 1.0).abs() < 1e-15);
    /// let forklift = Outline::<f64, 4>::rectangle(1.2, 0.3, 0.4, 0.4, 0.0)?;
    /// let profile = Profile::<f64, 1>::from_pieces(1.0, [(5.0, 0.0)])?;
    /// assert!(Motion::with_outline(path.as_path(), profile.as_profile(), &forklift, 0.0).is_ok());
    /// # Ok::<(), pcr_core::InvalidInput>(())
    /// ```
    pub fn reverse(mut self) -> Result<Self, InvalidInput> {
        self.change_gear()?;
        Ok(self)
    }

    /// The path in the form that algorithms take.
    pub fn as_path(&self) -> PathRef<'_, S> {
        let segments = if self.segments.is_empty() { core::slice::from_ref(&self.origin) } else { &self.segments[..] };
        PathRef { segments }
    }
}

impl<S: Scalar, const N: usize> SegmentChain<S> for Path<S, N> {
    fn last(&mut self) -> Result<&mut Segment<S>, InvalidInput> {
        Ok(self.segments.last_mut().unwrap_or(&mut self.origin))
    }

    fn body(&mut self) -> &mut Option<Direction<S>> {
        &mut self.facing
    }

    fn push(&mut self, next: Segment<S>) -> Result<(), InvalidInput> {
        self.segments.push(next).map_err(|_| InvalidInput::Full("segment"))
    }
}

/// Side and length of an arc with this radius, or a turn in place with this lever \[m\], that turns by `sweep` \[rad\].
pub(crate) fn swept<S: Scalar>(lever: S, sweep: S) -> Result<(TurnSide, S), InvalidInput> {
    let sweep = in_range(sweep, "sweep")?;
    let turn = if sweep < S::ZERO { TurnSide::Right } else { TurnSide::Left };
    Ok((turn, sweep.abs().times(lever).narrow()))
}

/// A path to which segments are appended, wherever they are stored: in the path itself, or in the storage of a fleet.
pub(crate) trait SegmentChain<S: Scalar> {
    /// The last segment, or the one without a length with which the path begins.
    fn last(&mut self) -> Result<&mut Segment<S>, InvalidInput>;

    /// Angle from the direction of travel to the heading of the body, for the next segments; `None` for a body that looks ahead.
    fn body(&mut self) -> &mut Option<Direction<S>>;

    /// Stores a segment with a length behind all others.
    fn push(&mut self, next: Segment<S>) -> Result<(), InvalidInput>;

    fn append(&mut self, next: Segment<S>) -> Result<(), InvalidInput> {
        if next.length > S::ZERO {
            let next = if let Some(facing) = *self.body() { next.faced(facing)? } else { next };
            self.push(next)?;
        }
        Ok(())
    }

    fn append_line(&mut self, length: S) -> Result<(), InvalidInput> {
        let next = self.last()?.then_line(length)?;
        self.append(next)
    }

    fn append_arc(&mut self, radius: S, turn: TurnSide, length: S) -> Result<(), InvalidInput> {
        let next = self.last()?.then_arc(radius, turn, length)?;
        self.append(next)
    }

    fn append_steady_arc(&mut self, radius: S, turn: TurnSide, length: S) -> Result<(), InvalidInput> {
        let last = self.last()?;
        let mut next = last.then_steady_arc(radius, turn, length)?;
        if next.length > S::ZERO {
            if let Some(facing) = *self.body() {
                next = next.faced(facing)?;
            }
            *self.body() = Some(next.body_after());
            self.push(next)?;
        }
        Ok(())
    }

    fn append_pivot(&mut self, lever: S, turn: TurnSide, length: S) -> Result<(), InvalidInput> {
        let next = self.last()?.then_pivot(lever, turn, length)?;
        self.append(next)
    }

    fn turn_by(&mut self, by: S::Angle) -> Result<(), InvalidInput> {
        let last = self.last()?;
        *last = last.turned(by)?;
        Ok(())
    }

    fn face(&mut self, angle: S::Angle) -> Result<(), InvalidInput> {
        let facing = self.last()?.facing(angle)?.body();
        self.set_body(facing)
    }

    fn change_gear(&mut self) -> Result<(), InvalidInput> {
        let Direction { cos, sin } = self.body().unwrap_or(Direction::X);
        self.set_body(Direction { cos: -cos, sin: -sin })?;
        self.turn_by(S::Angle::atan2(S::ZERO, -S::LIMIT))
    }

    /// Sets the angle of the body for the next segments, and of a path that has none yet.
    fn set_body(&mut self, facing: Direction<S>) -> Result<(), InvalidInput> {
        let last = self.last()?;
        let faced = last.faced(facing)?;
        if last.length <= S::ZERO {
            *last = faced;
        }
        *self.body() = Some(facing);
        Ok(())
    }
}

/// A path of any capacity, borrowed: at least one segment, and each begins where the one before it ends.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PathRef<'a, S: Scalar> {
    segments: &'a [Segment<S>],
}

impl<'a, S: Scalar> PathRef<'a, S> {
    /// A path of segments that were built one from the other.
    ///
    /// # Errors
    /// [`InvalidInput::Disconnected`] if they were not, or if there are no segments; [`InvalidInput::Full`] above 65535 segments.
    pub fn new(segments: &'a [Segment<S>]) -> Result<Self, InvalidInput> {
        if segments.len() > MOST_SEGMENTS {
            return Err(InvalidInput::Full("segment"));
        }
        let first = segments.first().ok_or(InvalidInput::Disconnected("path"))?;
        if first.from != S::ZERO {
            return Err(InvalidInput::Disconnected("path"));
        }
        for (before, after) in segments.iter().zip(segments.iter().skip(1)) {
            let joined = after.start == before.end
                && after.from == before.to
                && after.heading_at(S::ZERO) == before.heading_at(before.length);
            if !joined {
                return Err(InvalidInput::Disconnected("segment"));
            }
        }
        Ok(Self { segments })
    }

    /// The path of segments that were built one from the other, which was checked.
    pub(crate) const fn of(segments: &'a [Segment<S>]) -> Self {
        Self { segments }
    }

    /// The lines, arcs and turns in place.
    pub fn segments(self) -> &'a [Segment<S>] {
        self.segments
    }

    /// Total length \[m\].
    pub fn length(self) -> S {
        self.segments.last().map_or(S::ZERO, |last| last.to)
    }

    /// Position and heading at a travelled length \[m\], which is clamped to `[0, length]`. O(log segments).
    pub fn pose_at(self, length: S) -> Pose<S> {
        let Some((segment, u)) = self.locate(length) else {
            return Pose { position: Point::default(), heading: S::Angle::ZERO };
        };
        Pose { position: segment.point_at(u), heading: segment.heading_at(u) }
    }

    /// Position at a travelled length \[m\], which is clamped to `[0, length]`. O(log segments).
    pub fn point_at(self, length: S) -> Point<S> {
        self.locate(length).map_or_else(Point::default, |(segment, u)| segment.point_at(u))
    }

    /// Shape of the segment at a travelled length \[m\]: its curvature is `± 1 / radius` on an arc, 0 on a line, and not finite on a turn in place.
    pub fn curve_at(self, length: S) -> Curve<S> {
        self.locate(length).map_or(Curve::Line, |(segment, _)| segment.curve)
    }

    /// Box around the path \[m\].
    pub fn bounds(self) -> Aabb<S> {
        let mut rest = self.segments.iter().map(|segment| segment.bounds);
        let first = rest.next().unwrap_or_default();
        rest.fold(first, Aabb::hull)
    }

    /// A checksum of all that defines the path: where it begins, and heading, curvature and length of each segment.
    pub(crate) fn digest(self) -> u32 {
        let origin = self.segments.first().map_or_else(Point::default, |first| first.start);
        let begin = [origin.x.digest(), origin.y.digest()].into_iter().fold(0, digest);
        self.segments.iter().fold(begin, |sum, segment| {
            let bend = segment.curve.lever().unwrap_or(S::ZERO).negate_if(segment.mirrored()).digest();
            let bend = if matches!(segment.curve, Curve::Pivot { .. }) { !bend } else { bend };
            [segment.heading.digest(), segment.length.digest(), bend].into_iter().fold(sum, digest)
        })
    }

    /// The segment at a travelled length, and the length along it. It always exists, because every path has a segment.
    pub(crate) fn locate(self, length: S) -> Option<(&'a Segment<S>, S)> {
        let after = self.segments.partition_point(|segment| segment.from <= length);
        let segment = self.segments.get(after.saturating_sub(1))?;
        let u = if length >= self.length() { segment.length } else { length.max(S::ZERO) - segment.from };
        Some((segment, u))
    }
}
