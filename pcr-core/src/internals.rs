//! Internal kernels, for tests of their error bounds. Not part of the interface, and subject to change.

use crate::error::CapacityError;
use crate::geometry::{Interval, Point};
use crate::pair::disc_on_segment::{CarrierCoordinates, CarrierCover};
use crate::pair::events::{add_events, add_turning_lengths};
use crate::pair::lateral_offset::{Carrier, RelativeCarrier};
use crate::pair::lengths::LengthList;
use crate::pair::slabs::SegmentPair;
use crate::piece_store::{Piece, PieceStore};
use crate::scalar::Scalar;
use crate::segment::Segment;

/// Calls `event` with the events along the second segment, and `turn` with the turning lengths of the first one \[m\].
pub fn events<S: Scalar>(
    first: &Segment<S>,
    second: &Segment<S>,
    [radius, slack]: [S; 2],
    event: impl FnMut(S),
    turn: impl FnMut(S),
) {
    let (mut events, mut turning) = (LengthList::new(S::ZERO), LengthList::new(S::ZERO));
    let ends = add_events(first, second, radius, slack, &mut events);
    add_turning_lengths(first, second, ends, radius, slack, &mut turning);
    events.as_slice().iter().copied().for_each(event);
    turning.as_slice().iter().copied().for_each(turn);
}

/// Calls `found` with the pieces of two segments: their ranges along the first and the second one \[m\].
///
/// # Errors
/// [`CapacityError`] for more than 16 pieces.
pub fn pieces<S: Scalar>(
    first: &Segment<S>,
    second: &Segment<S>,
    [radius, slack]: [S; 2],
    mut found: impl FnMut([Interval<S>; 2]),
) -> Result<(), CapacityError> {
    let mut pieces = PieceStore::new([Piece::EMPTY; 16]);
    SegmentPair { first, second, indices: [0; 2], radius, slack }.find(&mut pieces)?;
    pieces.behind(0).iter().for_each(|piece| found([piece.first, piece.second]));
    Ok(())
}

/// Calls `found` with the lengths of a segment at which P3 finds a contact from inside an arc \[m\].
pub fn inward<S: Scalar>(other: &Segment<S>, segment: &Segment<S>, radius: S, found: impl FnMut(S)) {
    let mut lengths = LengthList::new(S::ZERO);
    let start = CarrierCoordinates::of(other.start, segment);
    let relative = RelativeCarrier::new(segment, Carrier::from(other), &start);
    relative.lengths_at(&[-relative.outward(radius)], S::ZERO, S::ZERO, &mut lengths);
    lengths.as_slice().iter().copied().for_each(found);
}

/// P1: the lateral distance of a point from a segment, and the ends of the part within the radius of it \[m\].
pub fn covered<S: Scalar>(point: Point<S>, segment: &Segment<S>, radius: S) -> (S, Option<[S; 2]>) {
    let footprint = CarrierCoordinates::of(point, segment);
    let ends = match footprint.reach(segment, radius) {
        CarrierCover::Around { foot, half } => Some([foot - half, foot + half]),
        CarrierCover::Nothing | CarrierCover::Whole => None,
    };
    (footprint.offset, ends)
}
