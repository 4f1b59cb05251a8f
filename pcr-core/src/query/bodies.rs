//! Two outlines in motion at one time, and for how long they certainly stay apart or in contact.
//!
//! All bounds are of one form. A quantity that has still the room r until it matters, and is used up at the rate q, which
//! changes by at most M, lasts for
//!
//! ```text
//! h = 2 r / (q + √(q² + 2 M r))
//! ```
//!
//! Apart, the quantities are the gaps between the corners of one body and the line that separates it from the other, which moves with
//! the other. In contact they are the signed distances of a corner of one body from the edges of the other, as long as the corner is
//! beside one edge, and either outside within reach of it or on the inner side of all others. A corner beside a corner is treated in `Bodies::stays_at`.
//! Where nothing else helps, the distance changes by at most the sum of the speeds.

use crate::geometry::{Direction, Interval, Point, Vector};
use crate::motion::Motion;
use crate::outline::placed::{Carriage, Carried, Corners};
use crate::outline::{Corner, opposite};
use crate::pair::outline::distance::separation_along;
use crate::query::legs::Leg;
use crate::scalar::{Scalar, Wide};

/// An outline in motion at one time. All bounds hold until the end of its window.
struct Body<S: Scalar> {
    corners: Corners<S>,
    /// Velocity of the reference point, if the body does not turn \[m/s\].
    velocity: Vector<S>,
    /// The centre about which it turns, and the rate of turn, left positive \[rad/s\].
    turn: Option<(Vector<S>, S)>,
    /// Largest rate of turn, or speed of a body that does not turn.
    rate: S,
    /// Largest change of that rate in a second, and of a body that turns the square of the rate of turn more: multiplied by a distance from the centre it
    /// bounds an acceleration. On a steady arc largest acceleration, with that towards the centre.
    change: S,
}

impl<S: Scalar> Body<S> {
    fn new(motion: &Motion<'_, S>, leg: &Leg<'_, S>, length: S, [at, until]: [S; 2], since: S, from: Point<S>) -> Self {
        let segment = leg.segment();
        let carried = Carried::new(segment, motion.outline());
        let corners = carried.at(length - segment.from, from);
        let ([now, before, after], acceleration) = leg.speeds([at, since, until]);
        let most = before.max(after);
        match carried.carriage {
            Carriage::Straight => {
                let velocity = carried.segment.direction.vector(now, S::ZERO);
                Self { corners, velocity, turn: None, rate: most, change: acceleration }
            }
            Carriage::Circling(circle) => {
                let direction = carried.segment.direction.plus(carried.turn(length - segment.from));
                let velocity = direction.vector(now, S::ZERO);
                let inward = up(most.times(up(most.quotient(circle.radius))).narrow());
                Self { corners, velocity, turn: None, rate: most, change: up(acceleration + inward) }
            }
            Carriage::Turning(lever) => {
                let (rate, most) = (now.quotient(lever), up(most.quotient(lever)));
                let turn = (carried.origin - from, rate.negate_if(segment.mirrored()));
                let change = up(most.times(most).narrow() + acceleration.quotient(lever));
                let velocity = Vector { x: S::ZERO, y: S::ZERO };
                Self { corners, velocity, turn: Some(turn), rate: most, change }
            }
        }
    }

    fn distance_from_centre(&self, point: Vector<S>) -> S {
        self.turn.map_or(S::ZERO, |(centre, _)| between(centre, point).norm_squared().sqrt())
    }

    /// Velocity of the body at a place \[m/s\].
    fn velocity_at(&self, point: Vector<S>) -> Vector<S> {
        let Some((centre, rate)) = self.turn else { return self.velocity };
        let way = between(centre, point);
        Vector { x: -rate.times(way.y).narrow(), y: rate.times(way.x).narrow() }
    }

    /// Largest speed of a point of the body \[m/s\].
    fn speed_of(&self, point: Vector<S>) -> S {
        if self.turn.is_some() { up(self.rate.times(self.distance_from_centre(point)).narrow()) } else { self.rate }
    }

    /// Largest acceleration of a point of the body \[m/s²\].
    fn acceleration_of(&self, point: Vector<S>) -> S {
        if self.turn.is_some() { up(self.change.times(self.distance_from_centre(point)).narrow()) } else { self.change }
    }

    /// Largest speed of all points \[m/s\].
    fn speed(&self) -> S {
        self.corners.as_slice().iter().map(|corner| self.speed_of(corner.at)).fold(S::ZERO, S::max)
    }
}

/// Two outlines in motion at one time.
pub(crate) struct Bodies<S: Scalar> {
    bodies: [Body<S>; 2],
    /// Time for which the bounds hold \[s\].
    duration: S,
    /// Signed distance of the polygons \[m\].
    pub(crate) separation: S,
    /// Direction along which they are as far apart, from one body to the one that it belongs to: that with the edge of the contact.
    normal: Direction<S>,
    /// Whether the normal belongs to the first body.
    is_of_first: bool,
}

impl<S: Scalar> Bodies<S> {
    /// The bodies of two motions at a time, when they are at these lengths of their paths. Bounds hold during an interval around it.
    pub(crate) fn new(
        [ego, other]: [&Motion<'_, S>; 2],
        [own, their]: [&Leg<'_, S>; 2],
        [length, other_length]: [S; 2],
        at: S,
        during: Interval<S>,
    ) -> Self {
        let from = their.segment().start;
        let times = [at, during.hi];
        let ego = Body::new(ego, own, length, times, during.lo, from);
        let other = Body::new(other, their, other_length, times, during.lo, from);
        let (separation, normal, is_of_first) = separation_along(ego.corners.as_slice(), other.corners.as_slice());
        let normal = if is_of_first { opposite(normal) } else { normal };
        Self { bodies: [ego, other], duration: during.length(), separation, normal, is_of_first }
    }

    /// A time for which the polygons stay farther apart than `radius`, which they are now \[s\].
    pub(crate) fn stay_apart(&self, radius: S) -> S {
        let (ego, other, level) = self.apart();
        let lasts = ego.corners.as_slice().iter().map(|corner| {
            let room = level - corner.at.along(self.normal) - radius;
            let rate = self.relative(ego, other, corner.at).along(self.normal);
            lasts(room.max(S::ZERO), rate, self.change(ego, other, corner.at))
        });
        lasts.reduce(S::min).unwrap_or(S::ZERO)
    }

    /// A lower bound of the separation within `time` before and after \[m\].
    pub(crate) fn least_within(&self, time: S) -> S {
        let (ego, other, level) = self.apart();
        let least = ego.corners.as_slice().iter().map(|corner| {
            let gap = level - corner.at.along(self.normal);
            let rate = self.relative(ego, other, corner.at).along(self.normal).abs();
            let bend = self.change(ego, other, corner.at).times(time).narrow().times(time).narrow().half();
            gap - rate.times(time).narrow() - bend
        });
        least.reduce(S::min).unwrap_or(S::ZERO)
    }

    /// A time for which the polygons stay within `radius` of each other, which they are now \[s\].
    pub(crate) fn stay_near(&self, radius: S) -> S {
        let [ego, other] = &self.bodies;
        let speed = ego.speed() + other.speed();
        let least = lasts(radius - self.separation, speed, S::ZERO);
        let one = Self::stays(self, ego, other, radius);
        let two = Self::stays(self, other, ego, radius);
        least.max(one).max(two)
    }

    /// A body, the body that carries the normal, and the least component of that one along the normal. The normal is kept in the frame of its
    /// body: as seen from there the corners of the other one go nowhere if it slides along an edge.
    fn apart(&self) -> (&Body<S>, &Body<S>, S) {
        let [ego, other] = &self.bodies;
        let [body, carrier] = if self.is_of_first { [other, ego] } else { [ego, other] };
        let along = carrier.corners.as_slice().iter().map(|corner| corner.at.along(self.normal));
        (body, carrier, along.reduce(S::min).unwrap_or(S::ZERO))
    }

    /// Velocity of a point of a body as seen from another one, which may turn \[m/s\].
    fn relative(&self, body: &Body<S>, from: &Body<S>, point: Vector<S>) -> Vector<S> {
        between(from.velocity_at(point), body.velocity_at(point))
    }

    /// Largest acceleration of a point of a body as seen from another one \[m/s²\]: its own, and on an arc that of Coriolis and of the turn.
    fn change(&self, body: &Body<S>, from: &Body<S>, point: Vector<S>) -> S {
        let own = body.acceleration_of(point);
        if from.turn.is_none() {
            return up(own + from.change);
        }
        let speed = body.speed_of(point);
        let distance = from.distance_from_centre(point) + up(speed.times(self.duration).narrow());
        let coriolis = from.rate.times(speed).narrow().double();
        up(own + up(coriolis) + up(from.change.times(distance).narrow()))
    }

    /// A time for which some corner of a body stays within `radius` of the other.
    fn stays(&self, body: &Body<S>, other: &Body<S>, radius: S) -> S {
        let edges = other.corners.as_slice();
        let mut most = S::ZERO;
        for corner in body.corners.as_slice() {
            let velocity = self.relative(body, other, corner.at);
            let change = self.change(body, other, corner.at);
            for edge in edges.iter().filter(|edge| edge.length > S::ZERO) {
                most = most.max(stays_at_edge(edges, edge, corner.at, radius, velocity, change));
            }
            for point in edges {
                most = most.max(stays_at(between(point.at, corner.at), radius, velocity, change));
            }
        }
        most
    }
}

/// A time for which a point stays beside an edge, and either outside within `radius` of it or on the inner side of all others.
fn stays_at_edge<S: Scalar>(
    edges: &[Corner<S>],
    edge: &Corner<S>,
    point: Vector<S>,
    radius: S,
    velocity: Vector<S>,
    change: S,
) -> S {
    let way = between(edge.at, point);
    let (out, along) = (way.along(edge.outward), way.across(edge.outward));
    if out > radius || along < S::ZERO || along > edge.length {
        return S::ZERO;
    }
    let (rate, speed) = (velocity.along(edge.outward), velocity.across(edge.outward));
    let beside = lasts(along, -speed, change).min(lasts(edge.length - along, speed, change));
    // Outside of the edge, near its end, a point may be on the outer side of the next edge.
    let outside = if out < S::ZERO { S::ZERO } else { lasts(out, -rate, change) };
    let mut inside = S::LIMIT;
    for other in edges.iter().filter(|other| other.length > S::ZERO && other.at != edge.at) {
        // The other side of a capsule has no inner side: the point stays within reach of its line on that side, too.
        let room = if edges.len() == 2 { radius } else { S::ZERO } - between(other.at, point).along(other.outward);
        let stays = if room < S::ZERO { S::ZERO } else { lasts(room, velocity.along(other.outward), change) };
        inside = inside.min(stays);
    }
    beside.min(lasts(radius - out, rate, change)).min(outside.max(inside))
}

/// A time for which a point stays within `radius` of another one: half of the room for its uniform motion, half for the deviation from that.
fn stays_at<S: Scalar>(way: Vector<S>, radius: S, velocity: Vector<S>, change: S) -> S {
    let distance = way.norm_squared().sqrt();
    let room = radius - distance;
    if room <= S::ZERO {
        return S::ZERO;
    }
    let bends = lasts(room.half(), S::ZERO, change);
    // |way + velocity h| reaches the circle in the middle at the end of a chord.
    let speed = velocity.norm_squared().sqrt();
    let circle = distance + room.half();
    if speed <= S::ZERO {
        return bends;
    }
    let [cos, sin] = S::unit_vector(velocity.x, velocity.y, speed);
    let direction = Direction { cos, sin };
    let (along, across) = (way.along(direction), way.across(direction).abs().min(circle));
    let chord = (circle - across).times(circle + across).sqrt() - along;
    bends.min(chord.max(S::ZERO).quotient(speed))
}

/// The time for which a room lasts, if it is used up at this rate, which changes by at most `change` in a second.
fn lasts<S: Scalar>(room: S, rate: S, change: S) -> S {
    let rate = rate + S::rounding(rate.abs()).double();
    let root = (rate.times(rate) + room.times(change).double()).sqrt();
    if rate > S::ZERO {
        room.double().quotient(rate + root)
    } else if change > S::ZERO {
        (root - rate).quotient(change)
    } else {
        S::LIMIT
    }
    .min(S::LIMIT)
}

/// A bound that was computed, with its rounding error.
fn up<S: Scalar>(bound: S) -> S {
    bound + S::rounding(bound).double()
}

fn between<S: Scalar>(from: Vector<S>, to: Vector<S>) -> Vector<S> {
    Vector { x: to.x - from.x, y: to.y - from.y }
}
