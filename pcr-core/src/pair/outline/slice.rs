//! Slices: the lengths of a segment at which the outline that moves along it is within the radius of one that stands.
//!
//! On a line that is one interval, because the difference of two convex sets is convex. Elsewhere the contacts cut the segment
//! into gaps, in each of which the outlines are either nearer than R throughout or farther; the distance at one place
//! of a gap tells which. So a contact that was found twice, or is none, only cuts an interval into two that are put together again.

use super::contacts::{Standing, chord, contacts, on_segment};
use super::distance::clearance;
use crate::array_vec::ArrayVec;
use crate::geometry::{Interval, Point};
use crate::outline::placed::Carried;
use crate::scalar::Scalar;

/// Largest number of intervals of a slice. The theorem allows fewer: a gap for each corner, and two more.
pub(crate) const MOST_PARTS: usize = 36;

/// Largest number of contacts of a slice.
const MOST_CUTS: usize = 96;

/// Intervals of a slice in increasing order, as lengths along the segment \[m\].
pub(crate) type Parts<S> = ArrayVec<Interval<S>, MOST_PARTS>;

/// Returns the parts of a segment on which the moving outline is within the radius of the other, which stands. `from` is the origin of
/// the moving outline. `None` if there were too many contacts.
///
/// Cost: a few operations for each pair of a corner and an edge; on an arc a distance for each contact.
pub(crate) fn parts<S: Scalar>(moving: &Carried<'_, S>, other: Standing<'_, S>) -> Option<Parts<S>> {
    let length = moving.segment.length;
    let mut parts = ArrayVec::new(Interval::new(S::ZERO, S::ZERO));
    if moving.is_straight() {
        if let Some(part) = part_of_line(moving, other) {
            parts.add(part, true);
        }
        return Some(parts);
    }
    let mut cuts = ArrayVec::<S, MOST_CUTS>::new(S::ZERO);
    let mut fits = true;
    contacts(moving, other, false, |cut, _| {
        if S::ZERO < cut && cut < length {
            fits &= cuts.push(cut);
        }
    });
    fits &= cuts.push(length);
    if !fits {
        return None;
    }
    cuts.sort();
    let (mut from, mut open) = (S::ZERO, false);
    for &to in cuts.as_slice() {
        let gap = Interval::new(from, to);
        if from == to && length > S::ZERO {
            continue;
        }
        let covered = is_covered(moving, other, gap);
        if covered {
            extend(&mut parts, gap, open);
        }
        (from, open) = (to, covered);
    }
    Some(parts)
}

/// Returns the part of a line on which the moving outline is within the radius of the other.
pub(crate) fn part_of_line<S: Scalar>(moving: &Carried<'_, S>, other: Standing<'_, S>) -> Option<Interval<S>> {
    let [(lo, _), (hi, _)] = chord(moving, other)?;
    on_segment([lo, hi], moving.segment.length)
}

/// Adds an interval to a slice, or extends the last one.
fn extend<S: Scalar>(parts: &mut Parts<S>, gap: Interval<S>, open: bool) {
    if (open || !parts.has_room())
        && let Some(last) = parts.as_mut_slice().last_mut()
    {
        last.hi = gap.hi;
        return;
    }
    parts.add(gap, true);
}

/// Whether the outlines are within the radius in a gap between two contacts. The place with the clearest answer decides: at one place
/// the distance may be the radius by chance.
fn is_covered<S: Scalar>(moving: &Carried<'_, S>, other: Standing<'_, S>, gap: Interval<S>) -> bool {
    let clearance = |length: S| {
        let corners = moving.at(length, moving.origin);
        clearance(corners.as_slice(), other.corners, other.radius, other.slack)
    };
    let middle = gap.middle();
    let clear = clearance(middle);
    if clear.abs() > other.slack {
        return clear <= S::ZERO;
    }
    let places = [Interval::new(gap.lo, middle).middle(), Interval::new(middle, gap.hi).middle()];
    let places = places.map(clearance).into_iter();
    places.fold(clear, |clear, other| if other.abs() > clear.abs() { other } else { clear }) <= S::ZERO
}

/// Returns the parts of a segment on which the moving outline is within `radius` of another one that stands at a length of its own segment;
/// `None` if there were too many contacts.
pub(crate) fn parts_beside<S: Scalar>(
    moving: &Carried<'_, S>,
    standing: &Carried<'_, S>,
    length: S,
    [radius, slack]: [S; 2],
) -> Option<Parts<S>> {
    let place: Point<S> = moving.origin;
    let corners = standing.at(length, place);
    parts(moving, Standing { corners: corners.as_slice(), radius, slack })
}
