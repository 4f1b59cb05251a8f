//! How far the second agent at a region may go: the infimum of its lengths in the part that the first agent has not
//! passed yet.
//!
//! A piece that lies ahead of both agents counts with its stored least length. If an agent is inside a piece, closed
//! forms give the lengths of the second agent's segment that are blocked by the part of the first agent's segment that
//! is still ahead.

use crate::geometry::Interval;
use crate::query::{covered_by, cut};
use crate::region::{PieceRef, RegionRef};
use crate::scalar::Scalar;

/// How far an agent may go.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum MovementAuthority<S> {
    /// To the end of its path.
    Free,
    /// Up to this length of its path \[m\]; it may stand there.
    At(S),
    /// Nowhere: it stands where the other agent will pass. It can only go first.
    Inside,
}

impl<S: Scalar> MovementAuthority<S> {
    /// Whether the agent may be at this length of its path \[m\].
    pub fn allows(self, length: S) -> bool {
        match self {
            Self::Free => true,
            Self::At(hold) => length <= hold,
            Self::Inside => false,
        }
    }

    /// The more restrictive of two holds.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        match (self, other) {
            (Self::Free, hold) | (hold, Self::Free) => hold,
            (Self::At(a), Self::At(b)) => Self::At(a.min(b)),
            (Self::Inside, _) | (_, Self::Inside) => Self::Inside,
        }
    }

    /// Whether the agent may go beyond this length of its path \[m\].
    pub(super) fn allows_beyond(self, length: S) -> bool {
        match self {
            Self::Free => true,
            Self::At(hold) => length < hold,
            Self::Inside => false,
        }
    }

    /// The hold as a length of a path that ends at `end` \[m\]; `None` for [`MovementAuthority::Inside`].
    pub fn length(self, end: S) -> Option<S> {
        match self {
            Self::Free => Some(end),
            Self::At(hold) => Some(hold.min(end)),
            Self::Inside => None,
        }
    }
}

impl<S: Scalar> RegionRef<'_, S> {
    /// How far the ego may go if the other agent passes this region first and has still to travel from `other_from` on:
    /// the infimum of the ego's lengths in the part of the region in which the ego is at `from` or beyond, and the
    /// other at `other_from` or beyond \[m\]. For places that are known as ranges, use the lower ends: this is safe for
    /// both agents.
    ///
    /// The hold never exceeds the exact infimum of the region for the sum of the radii R, and never falls below that
    /// for R + 2 [`RegionRef::excess`]. It does not decrease as the other agent goes on, except for rounding. It is
    /// free once the other agent has left the region, which never happens if the region contains the end of its path.
    /// [`MovementAuthority::Inside`] means that the region begins before `from`, or at the start of the ego's path.
    ///
    /// If both agents are in the same pair of segments, and one segment is an arc of half a turn or more or fits into
    /// the disc, another region of this pair of segments may count as well: the hold is then lower than necessary.
    ///
    /// Cost: a comparison for each piece, and a few hundred operations for each piece that an agent is in.
    ///
    /// ```
    /// use pcr_core::{Ecm, MovementAuthority, Limits, Motion, Path, Piece, Point, Pose, Profile, Radians, EcmEntry};
    /// let pose = |x, y, heading| Pose { position: Point::new(x, y), heading: Radians(heading) };
    /// // Two agents on one lane, the other 1 m ahead, discs of 0.25 m.
    /// let ego = Path::<f64, 1>::starting_at(pose(0.0, 0.0, 0.0))?.line(4.0)?;
    /// let other = Path::<f64, 2>::starting_at(pose(1.0, 0.0, 0.0))?.line(4.0)?.arc(1.0, pcr_core::TurnSide::Left, 2.0)?;
    /// let limits = Limits { speed: 1.0, acceleration: 1.0 };
    /// let (short, long) = (Profile::rest_to_rest(4.0, limits)?, Profile::rest_to_rest(6.0, limits)?);
    /// let fleet = [
    ///     Motion::new(ego.as_path(), short.as_profile(), 0.25, 0.0)?,
    ///     Motion::new(other.as_path(), long.as_profile(), 0.25, 0.0)?,
    /// ];
    /// let ecm = Ecm::build([EcmEntry::EMPTY; 1], [Piece::EMPTY; 4], &fleet)?;
    /// let region = ecm.pair(&fleet, 0, 1)?.next().unwrap();
    /// let at = |length| match region.hold(0.0, length) {
    ///     MovementAuthority::At(hold) => hold,
    ///     _ => f64::NAN,
    /// };
    /// // It follows at a distance of 0.5 m.
    /// assert!((at(0.0) - 0.5).abs() < 1e-12 && (at(1.0) - 1.5).abs() < 1e-12);
    /// assert_eq!(region.hold(0.0, 6.0), MovementAuthority::Free);
    /// assert_eq!(region.swapped().hold(0.0, 0.0), MovementAuthority::Inside); // the other one cannot be second
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn hold(&self, from: S, other_from: S) -> MovementAuthority<S> {
        // Places are clamped to the paths, which rounding may leave a little; NaN is taken as the start.
        let from = S::ZERO.max(from).min(self.ego_motion().path().length());
        let other_from = S::ZERO.max(other_from).min(self.other_motion().path().length());
        let mut hold = MovementAuthority::Free;
        for piece in self.pieces() {
            // The hold is at least the least length of the piece.
            let counts =
                piece.other_length.hi >= other_from && piece.length.hi >= from && hold.allows_beyond(piece.length.lo);
            if counts {
                hold = hold.min(self.hold_of(&piece, from, other_from));
            }
        }
        hold
    }

    fn hold_of(&self, piece: &PieceRef<'_, S>, from: S, other_from: S) -> MovementAuthority<S> {
        let whole = other_from <= piece.other_length.lo && from <= piece.length.lo;
        if whole {
            return at(piece.length.lo, from);
        }
        let slack = self.slack();
        // Cutting a segment adds rounding errors of its own.
        let (ego, other) = (self.ego_motion(), self.other_motion());
        let radius = ego.rounding_radius() + other.rounding_radius() + slack.double();
        let ahead = Interval::new(other_from.max(piece.other_length.lo), piece.other_length.hi);
        let Some(their) = cut(piece.other, ahead) else { return MovementAuthority::Free };
        let parts = covered_by(other, ego, &their, piece.ego, radius, slack);
        let parts = parts.map(|part| Interval::new(part.lo + piece.ego.from, part.hi + piece.ego.from));
        let parts = parts.filter(|part| part.meets(piece.length)).map(|part| part.widen(slack, piece.length));
        parts.filter(|part| part.hi >= from).fold(MovementAuthority::Free, |hold, part| hold.min(at(part.lo, from)))
    }
}

/// The hold before this length. The start of a path is no boundary of a region.
fn at<S: Scalar>(length: S, from: S) -> MovementAuthority<S> {
    if length < from || length <= S::ZERO { MovementAuthority::Inside } else { MovementAuthority::At(length) }
}
