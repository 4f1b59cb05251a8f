//! Where, along the second segment, the part of the first one that the disc covers can change its structure.
//!
//! Between two neighbouring events the number of covered intervals is constant, and their ends move
//! continuously and monotonically (math: an end moves by the implicit function theorem until the connecting vector
//! is normal to a segment, or reaches an end of one). The events are
//!
//! - the ends of the second segment;
//! - contacts with an end of the first segment: P1 about it;
//! - contacts normal to the first segment, `c = ±R` from its carrier: slices begin, end, split (P3);
//! - contacts normal to the second segment: a slice end turns back (P3 with the roles swapped);
//! - where the foot on a circle leaves one lap for the next, if two laps can be covered at once.
//!
//! A superfluous event costs time and changes nothing.

use super::footprint::{Footprint, Reach};
use super::offset::{Carrier, Relative, on_first_lap};
use crate::geometry::{Direction, Point};
use crate::scalar::Scalar;
use crate::segment::{Curve, Segment};
use heapless::Vec;

/// Most events that a pair of segments has: 2 ends, 4 end contacts, 4 + 8 normal contacts, 2 changes of lap.
pub(crate) const MAX_EVENTS: usize = 20;

/// Events of a pair of segments, in order.
pub(crate) struct Events<S>(Vec<S, MAX_EVENTS>);

impl<S: Scalar> Events<S> {
    /// The events along `second`, for discs whose radii add up to `radius`.
    pub(crate) fn of(first: &Segment<S>, second: &Segment<S>, radius: S) -> Self {
        let mut events = Self(Vec::new());
        events.add(S::ZERO, second);
        events.add(second.length, second);

        let start = Footprint::of(first.start, second);
        events.add_ends(&start, second, radius);
        if first.length > S::ZERO {
            events.add_ends(&Footprint::of(first.end, second), second, radius);
        }

        let along_second = Relative::new(second, Carrier::from(first), &start);
        let along_first = Relative::new(first, Carrier::from(second), &Footprint::of(second.start, first));
        for c in [radius, -radius] {
            for s in along_second.lengths_at(c).into_iter().flatten() {
                events.add(s, second);
            }
            for l in along_first.lengths_at(c).into_iter().flatten() {
                if S::ZERO <= l && l <= first.length {
                    events.add_turning_point(first.point_at(l), second, radius);
                }
            }
        }

        if let Some(cut) = cut(first, radius) {
            let along_second = Relative::new(second, cut, &Footprint::of(cut.start, second));
            for s in along_second.lengths_at(S::ZERO).into_iter().flatten() {
                events.add(s, second);
            }
        }
        events
    }

    /// The events in increasing order, the ends of the segment among them.
    pub(crate) fn in_order(&self) -> &[S] {
        &self.0
    }

    /// Inserts at its place what lies on the segment.
    fn add(&mut self, s: S, second: &Segment<S>) {
        if s < S::ZERO || s > second.length {
            return;
        }
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
            self.add(on_first_lap(foot - half, second), second);
            self.add(on_first_lap(foot + half, second), second);
        }
    }

    fn add_turning_point(&mut self, contact: Point<S>, second: &Segment<S>, radius: S) {
        let foot = Footprint::of(contact, second).foot(second);
        self.add(on_first_lap(foot, second), second);
        // A disc larger than the circle also touches from beyond the centre.
        if let Curve::Arc { radius: own, .. } = second.curve
            && own < radius
        {
            self.add(on_first_lap(foot - second.circumference.half(), second), second);
        }
    }
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
