//! Where, along the second segment, the part of the first one that the disc covers can change its structure,
//! and where it can be extreme.
//!
//! Between two neighbouring [events](add_events) the number of covered intervals is constant and their ends move continuously.
//! They are
//!
//! - the ends of the second segment;
//! - contacts with an end of the first segment: P1 about it;
//! - contacts normal to the first segment, `c = ±R` from its carrier: intervals begin and end (P3);
//! - where the disc begins or ceases to cover the whole circle of the first segment, touches it all around from inside, or
//!   covers most of it: P1 about its centre, because P3 compares squares and these distances are small;
//! - where the foot on a circle leaves one lap for the next, if two laps can be covered at once.
//!
//! An end of a covered interval turns back only where the contact is normal to the second segment
//! ([`add_turning_lengths`]), or at an event. Superfluous events cost time and change nothing.

use super::footprint::{Footprint, Reach};
use super::lengths::Lengths;
use super::offset::{Carrier, Relative, on_first_lap};
use crate::geometry::Direction;
use crate::scalar::{Scalar, Wide};
use crate::segment::{Curve, Segment};

/// Adds the events along `second`, its ends among them, for discs whose radii add up to `radius`, distances right within
/// `slack`. Returns the lateral distances of the ends of `first` from `second` \[m\].
pub(crate) fn add_events<S: Scalar>(
    first: &Segment<S>,
    second: &Segment<S>,
    radius: S,
    slack: S,
    events: &mut Lengths<S>,
) -> [S; 2] {
    let (start, end) = (Footprint::of(first.start, second), Footprint::of(first.end, second));
    events.add(S::ZERO, true);
    add_ends(&start, second, radius, slack, events);
    if first.length > S::ZERO {
        add_ends(&end, second, radius, slack, events);
    }
    let normal = Relative::new(second, Carrier::from(first), &start);
    normal.lengths_at(&[radius, -radius], S::ZERO, slack.half(), events);
    if let Curve::Arc { radius: own, .. } = first.curve {
        let (wraps, ring) = (wraps(first, radius), inner_ring(own, radius));
        if wraps || ring.is_some() {
            let diameter = middle_diameter(first, own);
            let centre = Footprint::of(diameter.start, second);
            if let Some(ring) = ring {
                add_ends(&centre, second, ring, slack, events);
                // Where it covers most, √|ϱ² - R²| from the centre, R without its slack: a path through the centre is
                // normal to the contact there, but P3 cannot tell whether there is one.
                let most = (ring + slack).times(own + radius).sqrt();
                add_ends(&centre, second, most, slack, events);
            }
            if wraps {
                let diameter = Relative::new(second, diameter, &centre);
                diameter.lengths_at(&[S::ZERO], S::ZERO, S::ZERO, events);
            }
        }
    }
    // Last, where it belongs: fewer are out of order.
    events.add(second.length, true);
    [start.offset, end.offset]
}

/// Adds the lengths of `first` at which a contact with it may be normal to `second`. Contacts from beyond the centre of `second`
/// are left out: there an interval is shortest. The ends of `first` that touch it, by their distances from it, are among them:
/// rounding may have taken a contact just beyond one of them.
pub(crate) fn add_turning_lengths<S: Scalar>(
    first: &Segment<S>,
    second: &Segment<S>,
    [start, end]: [S; 2],
    radius: S,
    slack: S,
    lengths: &mut Lengths<S>,
) {
    // Further out it is not rounding that keeps the contact from the segment.
    let touches = |offset: S| (radius - slack <= offset) & (offset <= radius + slack.half());
    lengths.add(S::ZERO, touches(start.abs()));
    lengths.add(first.length, touches(end.abs()));
    let start = Footprint::of(second.start, first);
    let relative = Relative::new(first, Carrier::from(second), &start);
    let ring = match second.curve {
        Curve::Arc { radius: own, .. } if own >= radius => inner_ring(own, radius).zip(Some(own)),
        _ => None,
    };
    match ring {
        None => relative.lengths_at(&[radius, -radius], S::ZERO, S::ZERO, lengths),
        Some((ring, own)) => {
            relative.lengths_at(&[relative.outward(radius)], S::ZERO, S::ZERO, lengths);
            let centre = Footprint::of(middle_diameter(second, own).start, first);
            add_ends(&centre, first, ring, slack, lengths);
        }
    }
}

/// The length of `second` whose normal meets `first` at `l`, if there is contact: rounding makes roots where there are none,
/// and what is no contact is no end of an interval either.
pub(crate) fn contact<S: Scalar>(first: &Segment<S>, l: S, second: &Segment<S>, reach: S) -> Option<S> {
    let footprint = Footprint::of(first.point_at(l), second);
    let s = on_first_lap(footprint.foot(second), second, S::ZERO);
    (S::ZERO <= s && s <= second.length && footprint.offset.abs() <= reach).then_some(s)
}

/// Distance from the centre of an arc at which the disc touches its circle from inside, or begins to cover all of it:
/// always for a disc that can, and where that is so near the centre that P3 would lose it.
fn inner_ring<S: Scalar>(own: S, radius: S) -> Option<S> {
    let ring = (own - radius).abs();
    (own <= radius || ring.double().double() < own).then_some(ring)
}

/// Adds the lengths of a segment that are as far from a point as `radius`. Where rounding alone may have kept the point from
/// being that near it is the foot, and of a circle that is nearer everywhere the other end of the diameter: a slab that only
/// just is covered, by rounding too, ends there.
fn add_ends<S: Scalar>(footprint: &Footprint<S>, segment: &Segment<S>, radius: S, slack: S, lengths: &mut Lengths<S>) {
    let (foot, half) = match footprint.reach(segment, radius) {
        Reach::Around { foot, half } => (foot, half),
        Reach::Nothing if footprint.offset.abs() <= radius + slack => (footprint.foot(segment), S::ZERO),
        Reach::Whole => (footprint.foot(segment), segment.circumference.half()),
        Reach::Nothing => return,
    };
    for u in [foot - half, foot + half] {
        let u = on_first_lap(u, segment, S::ZERO);
        lengths.add(u, (S::ZERO <= u) & (u <= segment.length));
    }
}

/// Whether both ends of an arc can be covered while its middle is not: two laps at once.
pub(crate) fn wraps<S: Scalar>(segment: &Segment<S>, radius: S) -> bool {
    match segment.curve {
        Curve::Line => false,
        Curve::Arc { radius: own, .. } => own <= radius || segment.length.double() >= segment.circumference,
    }
}

/// The diameter through the middle of an arc, from the centre: the foot changes its lap on the far half of it.
fn middle_diameter<S: Scalar>(arc: &Segment<S>, radius: S) -> Carrier<S> {
    let middle = arc.point_at(arc.length.half());
    let heading = Direction::<S>::at(arc.heading_at(arc.length.half()));
    let start = middle + heading.vector(S::ZERO, radius.negate_if(arc.mirrored()));
    let direction = Direction { cos: -heading.sin, sin: heading.cos };
    Carrier { start, direction, curve: Curve::Line }
}
