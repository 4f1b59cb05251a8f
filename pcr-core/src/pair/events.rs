//! Where, along the second segment, the part of the first one that the disc covers can change its structure,
//! and where it can be extreme.
//!
//! Between two neighbouring [`Events`] the number of covered intervals is constant and their ends move continuously.
//! They are
//!
//! - the ends of the second segment;
//! - contacts with an end of the first segment: P1 about it;
//! - contacts normal to the first segment, `c = ±R` from its carrier: intervals begin and end (P3);
//! - where the disc begins or ceases to cover the whole circle of the first segment: P1 about its centre;
//! - where the foot on a circle leaves one lap for the next, if two laps can be covered at once.
//!
//! An end of a covered interval turns back only where the contact is normal to the second segment
//! ([`turning_points`]), or at an event. Superfluous events and turning points cost time and change nothing.

use super::footprint::{Footprint, Reach};
use super::offset::{Carrier, Relative, on_first_lap};
use crate::geometry::Direction;
use crate::scalar::Scalar;
use crate::segment::{Curve, Segment};
use heapless::Vec;

/// Most events that a pair of segments has: 2 ends, 4 end contacts, 4 normal contacts, 2 for the whole circle and 2
/// changes of lap.
const MAX_EVENTS: usize = 14;

/// Events of a pair of segments, in order.
pub(crate) struct Events<S>(Vec<S, MAX_EVENTS>);

impl<S: Scalar> Events<S> {
    /// The events along `second`, for discs whose radii add up to `radius`.
    pub(crate) fn of(first: &Segment<S>, second: &Segment<S>, radius: S) -> Self {
        let mut events = Self(Vec::new());
        events.add(S::ZERO);
        events.add(second.length);

        let start = Footprint::of(first.start, second);
        events.add_ends(&start, second, radius);
        if first.length > S::ZERO {
            events.add_ends(&Footprint::of(first.end, second), second, radius);
        }
        let normal = Relative::new(second, Carrier::from(first), &start);
        normal.lengths_at(&[radius, -radius], S::ZERO, |s| events.add(s));
        if let Curve::Arc { radius: own, .. } = first.curve
            && wraps(first, radius)
        {
            let diameter = middle_diameter(first, own);
            let centre = Footprint::of(diameter.start, second);
            Relative::new(second, diameter, &centre).lengths_at(&[S::ZERO], S::ZERO, |s| events.add(s));
            events.add_ends(&centre, second, radius - own);
        }
        events
    }

    /// The events in increasing order, the ends of the segment among them.
    pub(crate) fn in_order(&self) -> &[S] {
        &self.0
    }

    /// Inserts an event at its place.
    fn add(&mut self, s: S) {
        // The capacity is the most that `of` can add.
        if self.0.push(s).is_ok() {
            let mut at = self.0.len() - 1;
            while at > 0 && self.0[at - 1] > self.0[at] {
                self.0.swap(at - 1, at);
                at -= 1;
            }
        }
    }

    fn add_ends(&mut self, footprint: &Footprint<S>, second: &Segment<S>, radius: S) {
        if let Reach::Around { foot, half } = footprint.reach(second, radius) {
            for s in [foot - half, foot + half].map(|s| on_first_lap(s, second, S::ZERO)) {
                if S::ZERO <= s && s <= second.length {
                    self.add(s);
                }
            }
        }
    }
}

/// Where a contact with `first` is normal to `second`, as lengths along the two. Contacts from beyond the centre of
/// `second` are left out: there an interval is shortest.
pub(crate) fn turning_points<S: Scalar>(
    first: &Segment<S>,
    second: &Segment<S>,
    radius: S,
    mut found: impl FnMut(S, S),
) {
    let start = Footprint::of(second.start, first);
    Relative::new(first, Carrier::from(second), &start).lengths_at(&[radius, -radius], S::ZERO, |l| {
        let foot = Footprint::of(first.point_at(l), second).foot(second);
        let s = on_first_lap(foot, second, S::ZERO);
        if S::ZERO <= s && s <= second.length {
            found(l, s);
        }
    });
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
