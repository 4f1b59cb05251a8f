//! Where, along the second segment, the part of the first one that the disc covers can change its structure,
//! and where it can be extreme.
//!
//! Between two neighbouring [`Events`] the number of covered intervals is constant and their ends move continuously.
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
//! ([`turning_points`]), or at an event. Superfluous events cost time and change nothing.

use super::footprint::{Footprint, Reach};
use super::offset::{Carrier, Relative, on_first_lap};
use crate::geometry::Direction;
use crate::scalar::{Scalar, Wide};
use crate::segment::{Curve, Segment};
use heapless::Vec;

/// Most events that a pair of segments has: 2 ends, 4 end contacts, 4 normal contacts, 4 for the whole circle and 2
/// changes of lap.
const MAX_EVENTS: usize = 16;

/// Events of a pair of segments.
pub(crate) struct Events<S> {
    in_order: Vec<S, MAX_EVENTS>,
    /// The ends of the first segment, seen from the second one.
    ends: [Footprint<S>; 2],
}

impl<S: Scalar> Events<S> {
    /// The events along `second`, for discs whose radii add up to `radius`, distances right within `slack`.
    pub(crate) fn of(first: &Segment<S>, second: &Segment<S>, radius: S, slack: S) -> Self {
        let ends = [first.start, first.end].map(|end| Footprint::of(end, second));
        let mut events = Self { in_order: Vec::new(), ends };
        events.add(S::ZERO);
        events.add(second.length);
        let [start, end] = ends;
        events.add_ends(&start, second, radius, slack);
        if first.length > S::ZERO {
            events.add_ends(&end, second, radius, slack);
        }
        let normal = Relative::new(second, Carrier::from(first), &start);
        normal.lengths_at(&[radius, -radius], S::ZERO, slack.half(), |s| events.add(s));
        if let Curve::Arc { radius: own, .. } = first.curve {
            let (wraps, ring) = (wraps(first, radius), inner_ring(own, radius));
            if wraps || ring.is_some() {
                let diameter = middle_diameter(first, own);
                let centre = Footprint::of(diameter.start, second);
                if let Some(ring) = ring {
                    events.add_ends(&centre, second, ring, slack);
                    // Where it covers most, √|ϱ² - R²| from the centre, R without its slack: a path through the centre is
                    // normal to the contact there, but P3 cannot tell whether there is one.
                    events.add_ends(&centre, second, (ring + slack).times(own + radius).sqrt(), slack);
                }
                if wraps {
                    let diameter = Relative::new(second, diameter, &centre);
                    diameter.lengths_at(&[S::ZERO], S::ZERO, S::ZERO, |s| events.add(s));
                }
            }
        }
        events
    }

    /// The events in increasing order, the ends of the segment among them.
    pub(crate) fn in_order(&self) -> &[S] {
        &self.in_order
    }

    /// Inserts an event at its place.
    fn add(&mut self, s: S) {
        // The capacity is the most that `of` can add.
        if self.in_order.push(s).is_ok() {
            let mut events = self.in_order.iter_mut().rev();
            let Some(mut place) = events.next() else {
                return;
            };
            for before in events {
                if *before <= *place {
                    break;
                }
                core::mem::swap(before, place);
                place = before;
            }
        }
    }

    fn add_ends(&mut self, footprint: &Footprint<S>, second: &Segment<S>, radius: S, slack: S) {
        ends(footprint, second, radius, slack).into_iter().flatten().for_each(|s| self.add(s));
    }
}

/// Where a contact with `first` is normal to `second`, as lengths along the two. Contacts from beyond the centre of
/// `second` are left out: there an interval is shortest. The ends of `first` that touch it are among
/// them: rounding may have taken a contact just beyond one of them.
pub(crate) fn turning_points<S: Scalar>(
    first: &Segment<S>,
    second: &Segment<S>,
    events: &Events<S>,
    radius: S,
    slack: S,
    mut found: impl FnMut(S, S),
) {
    let mut contact = |l: S, footprint: Footprint<S>| {
        let s = on_first_lap(footprint.foot(second), second, S::ZERO);
        // Rounding makes roots where there are none; what is no contact is no end of an interval either.
        if S::ZERO <= s && s <= second.length && footprint.offset.abs() <= radius + slack {
            found(l, s);
        }
    };
    for (l, end) in [S::ZERO, first.length].into_iter().zip(events.ends) {
        // Further out it is not rounding that keeps the contact from the segment.
        let offset = end.offset.abs();
        if radius - slack <= offset && offset <= radius + slack.half() {
            contact(l, end);
        }
    }
    let mut add = |l: S| contact(l, Footprint::of(first.point_at(l), second));
    let start = Footprint::of(second.start, first);
    let relative = Relative::new(first, Carrier::from(second), &start);
    let ring = match second.curve {
        Curve::Arc { radius: own, .. } if own >= radius => inner_ring(own, radius).zip(Some(own)),
        _ => None,
    };
    match ring {
        None => relative.lengths_at(&[radius, -radius], S::ZERO, S::ZERO, add),
        Some((ring, own)) => {
            relative.lengths_at(&[relative.outward(radius)], S::ZERO, S::ZERO, &mut add);
            let centre = Footprint::of(middle_diameter(second, own).start, first);
            ends(&centre, first, ring, slack).into_iter().flatten().for_each(add);
        }
    }
}

/// Distance from the centre of an arc at which the disc touches its circle from inside, or begins to cover all of it:
/// always for a disc that can, and where that is so near the centre that P3 would lose it.
fn inner_ring<S: Scalar>(own: S, radius: S) -> Option<S> {
    let ring = (own - radius).abs();
    (own <= radius || ring.double().double() < own).then_some(ring)
}

/// The lengths of a segment that are as far from a point as `radius`. Where rounding alone may have kept the point from
/// being that near it is the foot, and of a circle that is nearer everywhere the other end of the diameter: a slab that only
/// just is covered, by rounding too, ends there.
fn ends<S: Scalar>(footprint: &Footprint<S>, segment: &Segment<S>, radius: S, slack: S) -> [Option<S>; 2] {
    let (foot, half) = match footprint.reach(segment, radius) {
        Reach::Around { foot, half } => (foot, half),
        Reach::Nothing if footprint.offset.abs() <= radius + slack => (footprint.foot(segment), S::ZERO),
        Reach::Whole => (footprint.foot(segment), segment.circumference.half()),
        Reach::Nothing => return [None; 2],
    };
    [foot - half, foot + half].map(|u| {
        let u = on_first_lap(u, segment, S::ZERO);
        (S::ZERO <= u && u <= segment.length).then_some(u)
    })
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
    let start = middle + heading.vector(S::ZERO, if arc.mirrored() { -radius } else { radius });
    let direction = Direction { cos: -heading.sin, sin: heading.cos };
    Carrier { start, direction, curve: Curve::Line }
}
