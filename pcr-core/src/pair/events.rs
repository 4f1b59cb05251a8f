//! Finds where, along the second segment, the covered part of the first segment can change its structure, and where it
//! can be extreme.
//!
//! Between two neighbouring [events](add_events) the number of covered intervals is constant and their ends move
//! continuously. Events are
//!
//! - the ends of the second segment;
//! - contacts with an end of the first segment: P1 about that end;
//! - contacts normal to the first segment, where intervals begin or end, or where the disc begins or ceases to cover
//!   the whole circle (P3, or P1 about the centre);
//! - places where the foot on a circle passes from one lap to the next, if two laps can be covered at once.
//!
//! An end of a covered interval reverses its direction only where the contact is normal to the second segment
//! ([`add_turning_lengths`]), or at an event. Additional events cost time but do not change the result.

use super::disc_on_segment::{CarrierCoordinates, CarrierCover};
use super::lateral_offset::{Carrier, RelativeCarrier, on_first_lap};
use super::lengths::LengthList;
use crate::geometry::Direction;
use crate::scalar::Scalar;
use crate::segment::{Curve, Segment};

/// Adds the events along `second`, its ends included, for discs whose radii add up to `radius`; distances are right
/// within `slack`. Returns the lateral distances of the ends of `first` from `second` \[m\].
pub(crate) fn add_events<S: Scalar>(
    first: &Segment<S>,
    second: &Segment<S>,
    radius: S,
    slack: S,
    events: &mut LengthList<S>,
) -> [S; 2] {
    let (start, end) = (CarrierCoordinates::of(first.start, second), CarrierCoordinates::of(first.end, second));
    events.add(S::ZERO, true);
    add_ends(&start, second, radius, slack, events);
    if first.length > S::ZERO {
        add_ends(&end, second, radius, slack, events);
    }
    add_normals(first, &start, second, radius, slack, events);
    if let (Curve::Arc { radius: own, .. }, true) = (first.curve, wraps(first, radius, slack)) {
        let diameter = middle_diameter(first, own);
        let centre = CarrierCoordinates::of(diameter.start, second);
        RelativeCarrier::new(second, diameter, &centre).lengths_at(&[S::ZERO], S::ZERO, S::ZERO, events);
    }
    // Added last, because it is the largest: then fewer events are out of order.
    events.add(second.length, true);
    [start.offset, end.offset]
}

/// Adds the lengths of `first` at which a contact with it may be normal to `second`. An end of `first` is added if its
/// distance shows that it touches `second`, because rounding may have moved the contact just beyond that end.
pub(crate) fn add_turning_lengths<S: Scalar>(
    first: &Segment<S>,
    second: &Segment<S>,
    [start, end]: [S; 2],
    radius: S,
    slack: S,
    lengths: &mut LengthList<S>,
) {
    // At larger distances the contact is beyond the segment, and not because of rounding.
    let touches = |offset: S| (radius - slack <= offset) & (offset <= radius + slack.half());
    lengths.add(S::ZERO, touches(start.abs()));
    lengths.add(first.length, touches(end.abs()));
    add_normals(second, &CarrierCoordinates::of(second.start, first), first, radius, slack, lengths);
}

/// Adds the lengths of `segment` at which a contact may be normal to `other`, whose start has this footprint on it: by
/// P3.
///
/// P3 compares squares; on the inside of an arc, d² with (ϱ - R)². Their rounding error is 2ϱ times that of a distance,
/// so the error in d is ϱ / |ϱ - R| times as large. From ϱ = 2R on, that is at most twice. Below, P1 about the centre
/// compares d with |ϱ - R|; the centre is then not further away than 2R. (The centre of a larger arc is less accurate
/// than its start.)
fn add_normals<S: Scalar>(
    other: &Segment<S>,
    start: &CarrierCoordinates<S>,
    segment: &Segment<S>,
    radius: S,
    slack: S,
    lengths: &mut LengthList<S>,
) {
    let relative = RelativeCarrier::new(segment, Carrier::from(other), start);
    match other.curve {
        Curve::Arc { radius: own, .. } if own < radius.double() => {
            relative.lengths_at(&[relative.outward(radius)], S::ZERO, slack.half(), lengths);
            let centre = CarrierCoordinates::of(other.centre(own), segment);
            add_ends(&centre, segment, (own - radius).abs(), slack, lengths);
        }
        _ => relative.lengths_at(&[radius, -radius], S::ZERO, slack.half(), lengths),
    }
}

/// Adds the lengths of a segment at the distance `radius` from a point. If only rounding may keep the point from being
/// that near, the foot is added; if the whole circle is nearer, the other end of the diameter. So a slab that is barely
/// covered, perhaps only because of rounding, ends there.
fn add_ends<S: Scalar>(
    footprint: &CarrierCoordinates<S>,
    segment: &Segment<S>,
    radius: S,
    slack: S,
    lengths: &mut LengthList<S>,
) {
    let (foot, half) = match footprint.reach(segment, radius) {
        CarrierCover::Around { foot, half } => (foot, half),
        CarrierCover::Nothing if footprint.offset.abs() <= radius + slack => (footprint.foot(segment), S::ZERO),
        CarrierCover::Whole => (footprint.foot(segment), segment.circumference.half()),
        CarrierCover::Nothing => return,
    };
    for u in [foot - half, foot + half] {
        let u = on_first_lap(u, segment, S::ZERO);
        lengths.add(u, (S::ZERO <= u) & (u <= segment.length));
    }
}

/// Whether both ends of an arc can be covered while its middle is not. Then two laps are covered at once, or seem to be
/// because of rounding; or they are covered one after the other, behind the centre of an arc that is hardly larger than
/// the disc, with a gap between them that may be narrower than a last digit.
pub(crate) fn wraps<S: Scalar>(segment: &Segment<S>, radius: S, slack: S) -> bool {
    match segment.curve {
        Curve::Line | Curve::Pivot { .. } => false,
        Curve::Arc { radius: own, .. } => {
            // The factor 16 is derived in docs/theory/equations.md#laps.
            let far = radius + slack.double().double().double().double();
            own <= far || segment.length.double() >= segment.circumference
        }
    }
}

/// The diameter through the middle of an arc, from the centre. On its far half the foot passes to the next lap.
fn middle_diameter<S: Scalar>(arc: &Segment<S>, radius: S) -> Carrier<S> {
    let middle = arc.point_at(arc.length.half());
    let heading = Direction::<S>::at(arc.heading_at(arc.length.half()));
    let start = middle + heading.vector(S::ZERO, radius.negate_if(arc.mirrored()));
    let direction = Direction { cos: -heading.sin, sin: heading.cos };
    Carrier { start, direction, curve: Curve::Line }
}
