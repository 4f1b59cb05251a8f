//! The piece of two outlines that are both on lines.
//!
//! Both are translated, so the lengths at which they are within R of each other are a convex set: the inverse image of the difference
//! of both, rounded by R, under an affine map. Within both segments there is at most one piece, and its ranges are extreme
//! at an end of a segment or where one outline touches a line beside the way of the other (`docs/theory/outlines.md`, "Two lines", which also
//! says why rounding loses no contact beside an end).

use super::contacts::Standing;
use super::events::{Carriers, critical_on_line};
use super::slice::part_of_line;
use crate::error::CapacityError;
use crate::geometry::Interval;
use crate::outline::placed::Carried;
use crate::piece_store::{Piece, PieceStore};
use crate::scalar::Scalar;

/// The ranges of a piece along both segments \[m\], as far as they are known.
struct Ranges<S>(Option<[Interval<S>; 2]>);

impl<S: Scalar> Ranges<S> {
    fn add(&mut self, first: Interval<S>, second: Interval<S>) {
        self.0 = Some(self.0.map_or([first, second], |known| [known[0].hull(first), known[1].hull(second)]));
    }
}

impl<S: Scalar> Carriers<'_, S> {
    /// Adds the piece of two outlines on lines. Lengths are along the segments.
    ///
    /// # Errors
    /// [`CapacityError::Pieces`].
    pub(super) fn find_on_lines<P: AsRef<[Piece<S>]> + AsMut<[Piece<S>]>>(
        &self,
        indices: [u16; 2],
        pieces: &mut PieceStore<S, P>,
    ) -> Result<(), CapacityError> {
        let Self { first, second, radius, slack } = self;
        let [own, their] = [first.segment.length, second.segment.length];
        let point = |length: S| Interval::new(length, length);
        let mut ranges = Ranges(None);
        for (at, is_new) in [(S::ZERO, true), (their, their > S::ZERO)] {
            if let Some(part) = self.part_on_line(first, second, at).filter(|_| is_new) {
                ranges.add(part, point(at));
            }
        }
        for (at, is_new) in [(S::ZERO, true), (own, own > S::ZERO)] {
            if let Some(part) = self.part_on_line(second, first, at).filter(|_| is_new) {
                ranges.add(point(at), part);
            }
        }
        let inside = |at: S, length: S| S::ZERO < at && at < length;
        let mut add = |one: S, other: S| {
            if inside(one, own) && inside(other, their) {
                ranges.add(point(one), point(other));
            }
        };
        critical_on_line(first, second, [*radius, *slack], &mut |other, one| add(one, other));
        critical_on_line(second, first, [*radius, *slack], &mut add);
        if let Some([first, second]) = ranges.0 {
            pieces.push(Piece::ranked(indices, [0, 1], first, second))?;
        }
        Ok(())
    }

    /// The part of a line that is covered while the other outline is at a length of its segment.
    fn part_on_line(&self, moving: &Carried<'_, S>, standing: &Carried<'_, S>, at: S) -> Option<Interval<S>> {
        let corners = standing.at(at, moving.origin);
        part_of_line(moving, Standing { corners: corners.as_slice(), radius: self.radius, slack: self.slack })
    }
}
