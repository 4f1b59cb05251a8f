//! Contacts of an outline that moves along a segment with one that stands: the lengths at which they are at a distance of
//! R, in three forms (Lemma 1 of `docs/theory/outlines.md`):
//!
//! ```text
//! VE  a corner of the moving one at the distance R from an edge of the other
//! EV  an edge of the moving one at the distance R from a corner of the other
//! VV  a corner at the distance R from a corner
//! ```
//!
//! On an arc the outline turns about the centre, from which all vectors begin here. A corner at the distance ϱ meets the line
//! with the normal m at the offset h where it is at `h m ± w m⊥`, `w² = (ϱ - h)(ϱ + h)`, and a circle of radius R about a
//! corner at the distance r at the angle 2α from there, `tan α = √((R - δ)(R + δ)) / √((s - R)(s + R))` with δ = ϱ - r,
//! s = ϱ + r. No angle is computed for a candidate before it has passed all tests.
//!
//! A candidate counts if its foot is on the edge and its normal is supported, with an allowance. An allowance adds contacts
//! at a distance of less than R, which do no harm: they are cuts, not ends. Without it, rounding might reject a contact in two forms.

use crate::array_vec::ArrayVec;
use crate::geometry::{Direction, Interval, Vector, turned_back};
use crate::outline::placed::{Carriage, Carried, Circle};
use crate::outline::{Corner, MOST_CORNERS, opposite, supports};
use crate::scalar::{Scalar, Wide};

/// An outline that stands, and how near another one comes.
#[derive(Clone, Copy)]
pub(crate) struct Standing<'a, S: Scalar> {
    /// Its corners, relative to the origin of the moving outline.
    pub(crate) corners: &'a [Corner<S>],
    /// The distance of a contact \[m\]: sum of the radii.
    pub(crate) radius: S,
    /// Allowance of the tests \[m\].
    pub(crate) slack: S,
}

/// Calls `found` with the lengths of contacts along the carrier of the segment, on an arc in `[0, circumference)`, and with the
/// normal from the moving outline to the other.
///
/// With `far` with those at which the outlines overlap such that points of them are `other.radius` apart along a common normal, each on the inner side
/// of the other one: contacts at the distance `-other.radius`, the far values of Theorems 2 and 3. The normal is that of the outline that stands, outward. Of
/// a single point more are found than count.
///
/// The compiler makes a copy of all of it for each `found`: a caller with several lists of contacts goes through them in a loop.
pub(crate) fn contacts<S: Scalar>(
    moving: &Carried<'_, S>,
    other: Standing<'_, S>,
    far: bool,
    mut found: impl FnMut(S, Direction<S>),
) {
    match moving.carriage {
        Carriage::Straight if far => far_contacts_on_line(moving, other, &mut found),
        Carriage::Straight => {
            if let Some(ends) = chord(moving, other) {
                ends.into_iter().for_each(|(length, normal)| found(length, normal));
            }
        }
        Carriage::Turning(_) => {
            corners_at_edges(moving, other, far, &mut found);
            edges_at_corners(moving, other, far, &mut found);
            corners_at_corners(moving, other, far, &mut found);
        }
        Carriage::Circling(circle) => contacts_on_circle(moving, circle, other, far, &mut found),
    }
}

/// Far [`contacts`] on a line.
fn far_contacts_on_line<S: Scalar>(
    moving: &Carried<'_, S>,
    other: Standing<'_, S>,
    found: &mut impl FnMut(S, Direction<S>),
) {
    let (along, depth, slack) = (moving.segment.direction, other.radius, other.slack);
    let corners = moving.corners.as_slice();
    let is_point = other.corners.len() == 1;
    for (index, corner) in corners.iter().enumerate() {
        for (place, point) in other.corners.iter().enumerate() {
            let way = between(corner.at, point.at);
            let supported = |normal| {
                is_point
                    || supports(corners, index, opposite(normal), slack)
                        && supports(other.corners, place, normal, slack)
            };
            if let Some(half) = half_chord(way.across(along), depth) {
                for length in [way.along(along) - half, way.along(along) + half] {
                    let normal = unit(way, length, along, depth);
                    if supported(normal) {
                        found(length, normal);
                    }
                }
            }
            // The corner of one and the edge that begins at the corner of the other, as in `chord`.
            let ahead = (way.along(corner.outward) + depth).quotient_unit(corner.outward.dot(along));
            if let Some(length) = ahead.filter(|_| corner.length > S::ZERO)
                && is_on(corner, between(along.vector(length, S::ZERO), way), slack)
                && supports(other.corners, place, opposite(corner.outward), slack)
            {
                found(length, opposite(corner.outward));
            }
            let ahead = (way.along(point.outward) - depth).quotient_unit(point.outward.dot(along));
            if let Some(length) = ahead.filter(|_| point.length > S::ZERO)
                && is_on(point, between(way, along.vector(length, S::ZERO)), slack)
                && supports(corners, index, opposite(point.outward), slack)
            {
                found(length, point.outward);
            }
        }
    }
}

/// Calls `found` with the lengths at which a moving outline touches a line from outside, and with the corner that does. The line has
/// this normal, towards the outline, at the offset `level` from the origin of the outline.
pub(crate) fn line_contacts<S: Scalar>(
    moving: &Carried<'_, S>,
    normal: Direction<S>,
    level: S,
    slack: S,
    mut found: impl FnMut(S, Vector<S>),
) {
    let corners = moving.corners.as_slice();
    let down = opposite(normal);
    // Not enumerate(): here the compiler would not see that its counter cannot overflow.
    let lowest = || (0..corners.len()).zip(corners).filter(|&(index, _)| supports(corners, index, down, slack));
    match moving.carriage {
        Carriage::Straight => {
            let along = moving.segment.direction;
            for (_, corner) in lowest() {
                if let Some(length) = (level - corner.at.along(normal)).quotient_unit(normal.dot(along)) {
                    found(length, add(corner.at, along.vector(length, S::ZERO)));
                }
            }
            return;
        }
        Carriage::Circling(circle) => {
            for (_, corner) in lowest() {
                let level = level - corner.at.along(normal);
                for across in crossings(circle.radius, level) {
                    let towards = normal.plus(direction(level, across, circle.radius));
                    let place = add(corner.at, normal.vector(level, across));
                    found(moving.length_towards(circle, towards), place);
                }
            }
            return;
        }
        Carriage::Turning(_) => {}
    }
    for (index, corner) in corners.iter().enumerate() {
        let far = corner.at.norm_squared().sqrt();
        for across in crossings(far, level) {
            let turn = turned_back(normal.plus(direction(level, across, far)), direction_of(corner.at, far));
            if supports(corners, index, turned_back(down, turn), slack) {
                found(moving.length_of(turn), normal.vector(level, across));
            }
        }
    }
}

/// VE on an arc. Of far contacts the corner is inside of the edge.
fn corners_at_edges<S: Scalar>(
    moving: &Carried<'_, S>,
    other: Standing<'_, S>,
    far: bool,
    found: &mut impl FnMut(S, Direction<S>),
) {
    let corners = moving.corners.as_slice();
    let radius = signed(other, far);
    for (index, corner) in corners.iter().enumerate() {
        let distance = corner.at.norm_squared().sqrt();
        for edge in other.corners.iter().filter(|edge| edge.length > S::ZERO) {
            let offset = edge.at.along(edge.outward) + radius;
            for across in crossings(distance, offset) {
                if !is_within(across - edge.at.across(edge.outward), edge.length, other.slack) {
                    continue;
                }
                let to = edge.outward.plus(direction(offset, across, distance));
                let turn = turned_back(to, direction_of(corner.at, distance));
                let normal = opposite(edge.outward);
                if supports(corners, index, turned_back(normal, turn), other.slack) {
                    found(moving.length_of(turn), if far { edge.outward } else { normal });
                }
            }
        }
    }
}

/// EV on an arc. Of far contacts the corner is inside of the edge.
fn edges_at_corners<S: Scalar>(
    moving: &Carried<'_, S>,
    other: Standing<'_, S>,
    far: bool,
    found: &mut impl FnMut(S, Direction<S>),
) {
    let radius = signed(other, far);
    for (index, corner) in other.corners.iter().enumerate() {
        let distance = corner.at.norm_squared().sqrt();
        for edge in moving.corners.as_slice().iter().filter(|edge| edge.length > S::ZERO) {
            let offset = edge.at.along(edge.outward) + radius;
            for across in crossings(distance, offset) {
                if !is_within(across - edge.at.across(edge.outward), edge.length, other.slack) {
                    continue;
                }
                let from = edge.outward.plus(direction(offset, across, distance));
                let turn = turned_back(direction_of(corner.at, distance), from);
                let outward = turn.plus(edge.outward);
                if supports(other.corners, index, opposite(outward), other.slack) {
                    found(moving.length_of(turn), if far { opposite(outward) } else { outward });
                }
            }
        }
    }
}

/// VV on an arc.
fn corners_at_corners<S: Scalar>(
    moving: &Carried<'_, S>,
    other: Standing<'_, S>,
    far: bool,
    found: &mut impl FnMut(S, Direction<S>),
) {
    let (corners, radius) = (moving.corners.as_slice(), other.radius);
    let mut distances = ArrayVec::<S, MOST_CORNERS>::new(S::ZERO);
    other.corners.iter().for_each(|point| distances.add(point.at.norm_squared().sqrt(), true));
    for (index, corner) in corners.iter().enumerate() {
        let own = corner.at.norm_squared().sqrt();
        for ((place, point), &their) in other.corners.iter().enumerate().zip(distances.as_slice()) {
            let (less, sum) = (own - their, own + their);
            if less.abs() > radius || radius > sum || own <= S::ZERO || their <= S::ZERO {
                continue;
            }
            for to in meetings(radius, less, sum, direction_of(point.at, their)) {
                let turn = turned_back(to, direction_of(corner.at, own));
                let way = between(to.vector(own, S::ZERO), point.at);
                let normal = direction_of(way, radius);
                let outward = if far { opposite(normal) } else { normal };
                let counts = far && other.corners.len() == 1
                    || supports(corners, index, turned_back(outward, turn), other.slack)
                        && supports(other.corners, place, opposite(outward), other.slack);
                if counts {
                    found(moving.length_of(turn), normal);
                }
            }
        }
    }
}

/// All forms on a circle along which the moving outline does not turn, so that most tests of support do not depend on the length. `ϱ u` is the place of the
/// reference point: a corner a is at `a + ϱ u`, and `ϱ u` meets the line or circle that belongs to a pair of features.
fn contacts_on_circle<S: Scalar>(
    moving: &Carried<'_, S>,
    circle: Circle<S>,
    other: Standing<'_, S>,
    far: bool,
    found: &mut impl FnMut(S, Direction<S>),
) {
    let corners = moving.corners.as_slice();
    let (signed, slack) = (signed(other, far), other.slack);
    for (index, own) in corners.iter().enumerate() {
        for (place, their) in other.corners.iter().enumerate() {
            let way = between(own.at, their.at);
            // VE: (a + ϱ u - b) m = R for the edge at b.
            let normal = opposite(their.outward);
            if their.length > S::ZERO && supports(corners, index, normal, slack) {
                let level = way.along(their.outward) + signed;
                for across in crossings(circle.radius, level) {
                    if is_within(across - way.across(their.outward), their.length, slack) {
                        let towards = their.outward.plus(direction(level, across, circle.radius));
                        found(moving.length_towards(circle, towards), if far { their.outward } else { normal });
                    }
                }
            }
            // EV: (b - a - ϱ u) m = R for the edge at a.
            let normal = opposite(own.outward);
            if own.length > S::ZERO && supports(other.corners, place, normal, slack) {
                let level = way.along(own.outward) - signed;
                for across in crossings(circle.radius, level) {
                    if is_within(way.across(own.outward) - across, own.length, slack) {
                        let towards = own.outward.plus(direction(level, across, circle.radius));
                        found(moving.length_towards(circle, towards), if far { normal } else { own.outward });
                    }
                }
            }
            // VV: |b - a - ϱ u| = R.
            let distance = way.norm_squared().sqrt();
            let (less, sum) = (circle.radius - distance, circle.radius + distance);
            if less.abs() > other.radius || other.radius > sum || distance <= S::ZERO {
                continue;
            }
            for towards in meetings(other.radius, less, sum, direction_of(way, distance)) {
                let rest = between(towards.vector(circle.radius, S::ZERO), way);
                let normal = direction_of(rest, other.radius);
                let outward = if far { opposite(normal) } else { normal };
                if supports(corners, index, outward, slack) && supports(other.corners, place, opposite(outward), slack)
                {
                    found(moving.length_towards(circle, towards), normal);
                }
            }
        }
    }
}

/// The directions from the common centre of two circles to the points of one that are at the distance `radius` from a point of the other, which is in the direction `middle`; `less` and
/// `sum` are the difference and the sum of the radii of both circles.
fn meetings<S: Scalar>(radius: S, less: S, sum: S, middle: Direction<S>) -> [Direction<S>; 2] {
    let near = (radius - less).times(radius + less).sqrt();
    let far = (sum - radius).times(sum + radius).sqrt();
    let half = direction(far, near, (near.times(near) + far.times(far)).sqrt());
    let angle = half.plus(half);
    [middle.plus(angle), turned_back(middle, angle)]
}

/// The distance of a contact, negative of a far one \[m\].
fn signed<S: Scalar>(other: Standing<'_, S>, far: bool) -> S {
    if far { -other.radius } else { other.radius }
}

/// The lengths between which an outline on a line is within the radius of the other, with the normals there: the hull of the chords that the line
/// cuts out of the capsules of all edges and corners of the difference of both (theorem 1 of `docs/theory/outlines.md`). All
/// of these belong to the difference, so none has to be left out.
pub(super) fn chord<S: Scalar>(moving: &Carried<'_, S>, other: Standing<'_, S>) -> Option<[(S, Direction<S>); 2]> {
    let (along, radius, slack) = (moving.segment.direction, other.radius, other.slack);
    let mut ends: Option<[(S, Direction<S>); 2]> = None;
    let mut add = |length: S, normal: Direction<S>| {
        let [lo, hi] = ends.get_or_insert([(length, normal); 2]);
        if length < lo.0 {
            *lo = (length, normal);
        }
        if length > hi.0 {
            *hi = (length, normal);
        }
    };
    for own in moving.corners.as_slice() {
        for their in other.corners {
            let way = between(own.at, their.at);
            if let Some(half) = half_chord(way.across(along), radius) {
                for length in [way.along(along) - half, way.along(along) + half] {
                    add(length, unit(way, length, along, radius));
                }
            }
            // The corner of one and the edge that begins at the corner of the other.
            let ahead = (radius + way.along(their.outward)).quotient_unit(their.outward.dot(along));
            if let Some(length) = ahead.filter(|_| their.length > S::ZERO) {
                // From the begin of the edge to the corner after this length.
                if is_on(their, between(way, along.vector(length, S::ZERO)), slack) {
                    add(length, opposite(their.outward));
                }
            }
            let ahead = (way.along(own.outward) - radius).quotient_unit(own.outward.dot(along));
            if let Some(length) = ahead.filter(|_| own.length > S::ZERO)
                && is_on(own, between(along.vector(length, S::ZERO), way), slack)
            {
                add(length, own.outward);
            }
        }
    }
    ends
}

/// Half of the chord that a circle cuts out of a line at this distance of its centre \[m\].
fn half_chord<S: Scalar>(offset: S, radius: S) -> Option<S> {
    let offset = offset.abs();
    (offset <= radius).then(|| (radius - offset).times(radius + offset).sqrt())
}

/// The direction of the rest of a way of the length `radius`, after a length along a direction.
fn unit<S: Scalar>(way: Vector<S>, length: S, along: Direction<S>, radius: S) -> Direction<S> {
    direction_of(between(along.vector(length, S::ZERO), way), radius)
}

/// Both components along a line at the offset `offset` from the origin of its points at the distance `far`; none if there are none, or
/// if the point does not move.
fn crossings<S: Scalar>(far: S, offset: S) -> impl Iterator<Item = S> {
    let meets = offset.abs() <= far && far > S::ZERO;
    let across = if meets { (far - offset).times(far + offset).sqrt() } else { S::ZERO };
    [across, -across].into_iter().filter(move |_| meets)
}

/// Whether the foot of a point is on the edge that begins at a corner; `way` leads from the corner to the point.
fn is_on<S: Scalar>(edge: &Corner<S>, way: Vector<S>, slack: S) -> bool {
    is_within(way.across(edge.outward), edge.length, slack)
}

/// Whether a length lies on an edge, with an allowance.
pub(crate) fn is_within<S: Scalar>(length: S, edge: S, slack: S) -> bool {
    (-slack <= length) & (length <= edge + slack)
}

/// The direction of the vector with these components, of this norm, which is above 0.
fn direction<S: Scalar>(along: S, across: S, norm: S) -> Direction<S> {
    let [cos, sin] = S::unit_vector(along, across, norm);
    Direction { cos, sin }
}

/// The direction of a vector of this norm, which is above 0.
pub(crate) fn direction_of<S: Scalar>(vector: Vector<S>, norm: S) -> Direction<S> {
    direction(vector.x, vector.y, norm)
}

pub(crate) fn between<S: Scalar>(from: Vector<S>, to: Vector<S>) -> Vector<S> {
    Vector { x: to.x - from.x, y: to.y - from.y }
}

pub(crate) fn add<S: Scalar>(a: Vector<S>, b: Vector<S>) -> Vector<S> {
    Vector { x: a.x + b.x, y: a.y + b.y }
}

/// The part of a chord that lies on the segment.
pub(crate) fn on_segment<S: Scalar>(ends: [S; 2], length: S) -> Option<Interval<S>> {
    let [lo, hi] = ends;
    (lo <= length && hi >= S::ZERO).then(|| Interval::new(lo.max(S::ZERO), hi.min(length)))
}
