//! Events: where, along the second segment, slices of the first can change their structure, and where the ends of slices
//! can be extreme.
//!
//! The structure can change (Theorem 1 of `docs/theory/outlines.md`) at a contact with the first outline at an end of its segment, and at a critical contact:
//! one that the first outline neither enters nor leaves. On a line that is a contact whose normal is normal to the line. On an arc the line of the contact passes
//! through the centre c, and the contact is an end of a slice about c (Theorem 2): the second outline at the distance s + R from c, where
//! s is one of the critical radii of the first outline, which do not change while it turns. On a steady arc the normal is radial, and the contact is
//! one with the first outline about the centre of its circle (Theorem 3).
//!
//! The ends of slices are extreme at the same contacts with the roles exchanged (Lemma 3). Their lengths along the second segment are
//! closed forms of the normal.

use super::contacts::{Standing, add, between, contacts, direction_of, is_within, line_contacts};
use crate::array_vec::ArrayVec;
use crate::geometry::{Direction, Interval, Point, Vector, turned_back};
use crate::outline::placed::{Carriage, Carried, Circle, Corners};
use crate::outline::{Corner, MOST_CORNERS, opposite, supports};
use crate::scalar::{Scalar, Unit, Wide};

/// Largest number of events.
const MOST: usize = 160;

/// Lengths along a segment \[m\].
pub(crate) type Events<S> = ArrayVec<S, MOST>;

/// A point of an outline at which its normal passes through the centre of an arc.
#[derive(Clone, Copy)]
struct Critical<S: Scalar> {
    /// Signed distance of the point from the centre, along the normal \[m\].
    radius: S,
    /// Outward normal at the start of the arc.
    normal: Direction<S>,
}

type Criticals<S> = ArrayVec<Critical<S>, { 3 * MOST_CORNERS }>;

/// Two outlines carried along a pair of segments.
pub(crate) struct Carriers<'a, S: Scalar> {
    pub(crate) first: Carried<'a, S>,
    pub(crate) second: Carried<'a, S>,
    /// Combined radius, including the slack \[m\].
    pub(crate) radius: S,
    /// Bound on the rounding error of distances \[m\].
    pub(crate) slack: S,
}

/// A list of lengths along a segment, which may run full.
struct Found<'a, S: Scalar> {
    lengths: &'a mut Events<S>,
    end: S,
    fits: bool,
    /// What is added of a critical contact: without a window the length of the outline that moves, with one the length of the other outline, if the first
    /// is in the window.
    window: Option<Interval<S>>,
}

impl<S: Scalar> Found<'_, S> {
    fn add(&mut self, length: S) {
        if S::ZERO < length && length < self.end && !self.lengths.as_slice().contains(&length) {
            self.fits &= self.lengths.push(length);
        }
    }

    /// Adds a critical contact of an outline: the length along the segment of the one that moves, and that along its own.
    fn add_critical(&mut self, length: S, own: S) {
        match self.window {
            None => self.add(length),
            Some(window) if window.contains(length) => self.add(own),
            Some(_) => {}
        }
    }
}

impl<S: Scalar> Carriers<'_, S> {
    /// Returns the events along the second segment in increasing order, its ends included; `None` if there are too many.
    pub(crate) fn events(&self) -> Option<Events<S>> {
        let Self { first, second, radius, slack } = self;
        let end = second.segment.length;
        let mut lengths = ArrayVec::new(S::ZERO);
        let mut found = Found { lengths: &mut lengths, end, fits: true, window: None };
        for place in [S::ZERO, first.segment.length] {
            let corners = first.at(place, second.origin);
            let standing = Standing { corners: corners.as_slice(), radius: *radius, slack: *slack };
            contacts(second, standing, false, |length, _| found.add(length));
        }
        critical(first, second, [*radius, *slack], &mut found);
        let fits = found.fits && lengths.push(S::ZERO) && lengths.push(end);
        lengths.sort();
        fits.then_some(lengths)
    }

    /// Returns the lengths of the second segment at which an end of a slice may be extreme, in increasing order; `None` if there are too many.
    pub(crate) fn turning(&self) -> Option<Events<S>> {
        let Self { first, second, radius, slack } = self;
        let mut lengths = ArrayVec::new(S::ZERO);
        // A contact a little beyond an end of the first segment may be due to rounding.
        let window = match first.is_straight() {
            true => Interval::new(-*slack, first.segment.length + *slack),
            false => Interval::new(-S::LIMIT, S::LIMIT),
        };
        let end = second.segment.length;
        let mut found = Found { lengths: &mut lengths, end, fits: true, window: Some(window) };
        critical(second, first, [*radius, *slack], &mut found);
        let fits = found.fits;
        lengths.sort();
        fits.then_some(lengths)
    }
}

/// Adds the critical contacts of an outline with one that moves: the length along the segment of the moving one,
/// and the length along that of the first one at which the contact takes place.
fn critical<S: Scalar>(
    of: &Carried<'_, S>,
    moving: &Carried<'_, S>,
    [radius, slack]: [S; 2],
    found: &mut Found<'_, S>,
) {
    match of.carriage {
        Carriage::Straight => {
            let mut add = |length: S, own: S| found.add_critical(length, own);
            return critical_on_line(of, moving, [radius, slack], &mut add);
        }
        Carriage::Circling(circle) => return critical_on_circle([of, moving], circle, [radius, slack], found),
        Carriage::Turning(_) => {}
    }
    let all = criticals(of, slack);
    let centre = seen(of.origin, moving.origin);
    // Critical radii that differ by rounding have the same contacts.
    let fine = slack.half().half().half();
    for (index, own) in all.as_slice().iter().enumerate() {
        let alike = |other: &&Critical<S>| (other.radius - own.radius).abs() <= fine;
        if all.as_slice().iter().take(index).any(|other| alike(&other)) {
            continue;
        }
        let distance = own.radius + radius;
        for (distance, far) in [(distance, false), (-distance, true)] {
            if distance <= -slack {
                continue;
            }
            let standing = Standing { corners: core::slice::from_ref(&centre), radius: distance.max(slack), slack };
            contacts(moving, standing, far, |length, normal| {
                let normal = if far { normal } else { opposite(normal) };
                for one in all.as_slice().iter().filter(alike) {
                    found.add_critical(length, of.length_of(turned_back(normal, one.normal)));
                }
            });
        }
    }
}

/// Calls `found` with the critical contacts of an outline on a line, as [`critical`] does: the other one touches one of the two lines beside all
/// of its way.
pub(super) fn critical_on_line<S: Scalar>(
    of: &Carried<'_, S>,
    moving: &Carried<'_, S>,
    [radius, slack]: [S; 2],
    found: &mut impl FnMut(S, S),
) {
    let along = of.segment.direction;
    let left = Direction { cos: S::Unit::ZERO - along.sin, sin: along.cos };
    let origin = seen(of.origin, moving.origin).at;
    for normal in [left, opposite(left)] {
        let corners = of.corners.as_slice();
        let most = corners.iter().map(|corner| corner.at.along(normal)).reduce(S::max).unwrap_or(S::ZERO);
        let level = most + radius + origin.along(normal);
        line_contacts(moving, normal, level, slack, |length, corner| {
            for own in corners.iter().filter(|own| own.at.along(normal) >= most - slack) {
                let way = between(Vector { x: origin.x + own.at.x, y: origin.y + own.at.y }, corner);
                found(length, way.along(along));
            }
        });
    }
}

/// Calls `found` with the critical contacts of an outline that moves along a circle without turning, as [`critical`] does. The normal of such a contact
/// is radial, so the other one is at the distance R + ϱ, outside, or R - ϱ, inside of the circle, from the first one with its reference point at the centre
/// (Theorem 3).
fn critical_on_circle<S: Scalar>(
    [of, moving]: [&Carried<'_, S>; 2],
    circle: Circle<S>,
    [radius, slack]: [S; 2],
    found: &mut Found<'_, S>,
) {
    let shift = of.origin - moving.origin;
    let mut corners = Corners::new(Corner::CENTRE);
    for corner in of.corners.as_slice() {
        corners.add(Corner { at: add(corner.at, shift), ..*corner }, true);
    }
    let inside = radius - circle.radius;
    // The normal is that of the outline that moves, of far contacts that of the one that stands: only inside of the circle does it point away from
    // the centre.
    for (distance, far, outward) in
        [(radius + circle.radius, false, false), (inside, false, true), (-inside, true, false)]
    {
        if distance <= -slack {
            continue;
        }
        let standing = Standing { corners: corners.as_slice(), radius: distance.max(slack), slack };
        contacts(moving, standing, far, |length, normal| {
            let towards = if outward { normal } else { opposite(normal) };
            found.add_critical(length, of.length_towards(circle, towards));
        });
    }
}

/// The critical radii of an outline about the centre of its arc, and some more due to rounding.
fn criticals<S: Scalar>(of: &Carried<'_, S>, slack: S) -> Criticals<S> {
    let corners = of.corners.as_slice();
    let mut all = ArrayVec::new(Critical { radius: S::ZERO, normal: Direction::X });
    for (index, corner) in corners.iter().enumerate() {
        let far = corner.at.norm_squared().sqrt();
        if far > S::ZERO {
            let outward = direction_of(corner.at, far);
            all.add(Critical { radius: far, normal: outward }, supports(corners, index, outward, slack));
            let inward = opposite(outward);
            all.add(Critical { radius: -far, normal: inward }, supports(corners, index, inward, slack));
        } else if corner.length <= S::ZERO {
            all.add(Critical { radius: S::ZERO, normal: Direction::X }, true);
        }
        let foot = -corner.at.across(corner.outward);
        let on_edge = corner.length > S::ZERO && is_within(foot, corner.length, slack);
        all.add(Critical { radius: corner.at.along(corner.outward), normal: corner.outward }, on_edge);
    }
    all
}

/// A point, as the only corner of an outline, seen from another one.
fn seen<S: Scalar>(point: Point<S>, from: Point<S>) -> Corner<S> {
    Corner { at: point - from, ..Corner::CENTRE }
}
