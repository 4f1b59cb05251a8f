//! Where, along the second segment, the part of the first one that the disc covers can change its structure,
//! and where it can be extreme.
//!
//! Between two neighbouring [`Events`] the number of covered intervals is constant and their ends move continuously.
//! They are
//!
//! - the ends of the second segment;
//! - contacts with an end of the first segment: P1 about it;
//! - contacts normal to the first segment, `c = ±R` from its carrier: intervals begin, end, split (P3);
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

/// Most events that a pair of segments has: 2 ends, 4 end contacts, 4 normal contacts, 2 changes of lap.
pub(crate) const MAX_EVENTS: usize = 12;

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
        normal.lengths_at(&[radius, -radius], |s| events.add(s));
        if let Some(cut) = cut(first, radius) {
            let start = Footprint::of(cut.start, second);
            Relative::new(second, cut, &start).lengths_at(&[S::ZERO], |s| events.add(s));
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
            for s in [foot - half, foot + half].map(|s| on_first_lap(s, second)) {
                if S::ZERO <= s && s <= second.length {
                    self.add(s);
                }
            }
        }
    }
}

/// A contact that is normal to the second segment.
pub(crate) struct TurningPoint<S> {
    /// Length along the first segment.
    pub(crate) first: S,
    /// Length along the second segment.
    pub(crate) second: S,
    /// Whether the disc touches from beyond the centre of the second segment, if it does.
    pub(crate) beyond_centre: bool,
}

/// Where a contact with `first` is normal to `second`.
pub(crate) fn turning_points<S: Scalar>(
    first: &Segment<S>,
    second: &Segment<S>,
    radius: S,
    mut found: impl FnMut(TurningPoint<S>),
) {
    let start = Footprint::of(second.start, first);
    Relative::new(first, Carrier::from(second), &start).lengths_at(&[radius, -radius], |l| {
        let foot = Footprint::of(first.point_at(l), second).foot(second);
        let mut add = |s: S, beyond_centre| {
            if S::ZERO <= s && s <= second.length {
                found(TurningPoint { first: l, second: s, beyond_centre });
            }
        };
        add(on_first_lap(foot, second), false);
        if let Curve::Arc { radius: own, .. } = second.curve
            && own < radius
        {
            add(on_first_lap(foot - second.circumference.half(), second), true);
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

/// The diameter through the middle of an arc that wraps: the foot changes its lap on the far half of it.
fn cut<S: Scalar>(segment: &Segment<S>, radius: S) -> Option<Carrier<S>> {
    let Curve::Arc { radius: own, .. } = segment.curve else {
        return None;
    };
    if !wraps(segment, radius) {
        return None;
    }
    let middle = segment.point_at(segment.length.half());
    let heading = Direction::<S>::at(segment.heading_at(segment.length.half()));
    let across = if segment.mirrored() { -own } else { own };
    let start = middle + heading.vector(S::ZERO, across);
    let direction = Direction { cos: -heading.sin, sin: heading.cos };
    Some(Carrier { start, direction, curve: Curve::Line })
}
