//! Convex, rounded outlines on the segments of a path: where every corner is at a length, how fast it moves with the length, and how much
//! its way may bend.
//!
//! A body moves rigidly, in one of three ways ([`Sweep`]): along a line, about a centre (on an arc with a heading along the path plus a
//! constant angle, and when it turns in place), or along a circle with a constant heading. All that is derived here comes from the
//! corners: a corner of the first and the last kind goes `x(l) = z(l) + Rot(ωl) w` with `w` of constant length.

use super::data::{CORNERS, RawBody, RawCourse, RawHeading, RawOutline};
use crate::ball::{Ball, BallReal, Real106, Ternary};
use crate::box_index::PlainBox;
use crate::double_double::DoubleDouble;
use crate::error::{CertifyError, InputPart};
use crate::path::{LEAST, PreparedSegment, radians, stretches, unit};
use crate::plane::BallVector;
use crate::raw::{RawAngle, RawPath, RawSegment};

/// No corner and no radius of an outline is larger \[m\].
const MOST: f64 = 1e12;
/// No segment turns a body farther \[rad\]: a full turn, and what rounding adds.
const MOST_TURN: f64 = 7.0;

/// Checks an outline.
///
/// # Errors
/// More or fewer corners than allowed, a number out of range, corners that are no convex polygon, counter-clockwise.
pub fn checked(outline: &RawOutline) -> Result<(), CertifyError> {
    let count = outline.corners.len();
    if !(1..=CORNERS).contains(&count) {
        return Err(CertifyError::CornerCount { count, most: CORNERS });
    }
    if !outline.corners.iter().flatten().chain([&outline.radius]).all(|number| number.abs() <= MOST) {
        return Err(CertifyError::OutOfRange("a number of the outline"));
    }
    if outline.radius < 0.0 {
        return Err(CertifyError::OutlineRadius(outline.radius));
    }
    let corner = |k: usize| vector(outline.corners[k % count]);
    let edge = |k: usize| corner(k + 1) - corner(k);
    if count > 1 && !(0..count).all(|k| edge(k).dot(edge(k)).is_positive().is_certain()) {
        return Err(CertifyError::SameCorners);
    }
    // Each corner to the left of each edge, but for those of the edge: that is convex, and goes round once.
    let left = |k: usize, other: usize| edge(k).cross(corner(k + other) - corner(k)).is_positive().is_certain();
    if count > 2 && !(0..count).all(|k| (2..count).all(|other| left(k, other))) {
        return Err(CertifyError::NotConvex);
    }
    Ok(())
}

fn vector([x, y]: [f64; 2]) -> BallVector<DoubleDouble> {
    BallVector { x: Ball::from(x), y: Ball::from(y) }
}

/// How a body moves along a segment.
#[derive(Clone, Copy, Debug)]
pub enum Sweep<R> {
    /// Straight on.
    Line {
        /// Unit vector along.
        along: BallVector<R>,
    },
    /// About a centre.
    Turn {
        /// Centre.
        centre: BallVector<R>,
        /// Angle for each metre, positive to the left \[rad/m\].
        rate: Ball<R>,
    },
    /// Along a circle, with a constant heading.
    Circle {
        /// From the centre of the circle to the reference point at its start.
        arm: BallVector<R>,
        /// Angle for each metre, positive to the left \[rad/m\].
        rate: Ball<R>,
    },
}

/// A body on a segment, in numbers of one type.
#[derive(Clone, Debug)]
pub struct Carried<R> {
    /// How it moves.
    pub sweep: Sweep<R>,
    /// Its corners at the start of the segment: from the centre of a turn, otherwise in the plane.
    corners: Vec<BallVector<R>>,
    /// Outward unit normals of its edges there.
    normals: Vec<BallVector<R>>,
    /// What turns of each corner: its distance from the centre, or the radius of the circle \[m\]; nothing on a line.
    pub(crate) arms: Vec<Ball<R>>,
    /// The largest speed of a corner, for a speed of 1 along the path.
    pub lever: Ball<R>,
}

impl<R: BallReal> Carried<R> {
    fn of(body: &Carried<DoubleDouble>) -> Self {
        let sweep = match body.sweep {
            Sweep::Line { along } => Sweep::Line { along: BallVector::of(along) },
            Sweep::Turn { centre, rate } => {
                Sweep::Turn { centre: BallVector::of(centre), rate: Ball::from_twofold(rate) }
            }
            Sweep::Circle { arm, rate } => Sweep::Circle { arm: BallVector::of(arm), rate: Ball::from_twofold(rate) },
        };
        let vectors = |those: &[BallVector<DoubleDouble>]| those.iter().map(|&one| BallVector::of(one)).collect();
        Self {
            sweep,
            corners: vectors(&body.corners),
            normals: vectors(&body.normals),
            arms: body.arms.iter().map(|&one| Ball::from_twofold(one)).collect(),
            lever: Ball::from_twofold(body.lever),
        }
    }

    /// Angle for each metre of what turns, be it the body or its way \[rad/m\].
    pub(crate) fn rate(&self) -> Ball<R> {
        match self.sweep {
            Sweep::Line { .. } => Ball::from(0.0),
            Sweep::Turn { rate, .. } | Sweep::Circle { rate, .. } => rate,
        }
    }

    /// The fixed point about which a corner turns.
    pub(crate) fn hub(&self, corner: usize) -> BallVector<R> {
        match self.sweep {
            Sweep::Line { .. } => self.corners[corner],
            Sweep::Turn { centre, .. } => centre,
            Sweep::Circle { arm, .. } => self.corners[corner] - arm,
        }
    }

    /// The body at a length along the segment \[m\].
    pub fn posture(&self, length: Ball<R>) -> Posture<R> {
        let nothing = BallVector { x: Ball::from(0.0), y: Ball::from(0.0) };
        match self.sweep {
            Sweep::Line { along } => {
                let by = along.times(length);
                let corners: Vec<_> = self.corners.iter().map(|&corner| corner + by).collect();
                Posture {
                    velocities: vec![along; corners.len()],
                    corners,
                    normals: self.normals.clone(),
                    origin: nothing,
                    drift: along,
                    rate: Ball::from(0.0),
                }
            }
            Sweep::Turn { centre, rate } => {
                let by = (rate * length).sin_cos();
                let arms: Vec<_> = self.corners.iter().map(|corner| corner.turned(by)).collect();
                Posture {
                    velocities: arms.iter().map(|arm| arm.left().times(rate)).collect(),
                    corners: arms.into_iter().map(|arm| centre + arm).collect(),
                    normals: self.normals.iter().map(|normal| normal.turned(by)).collect(),
                    origin: centre,
                    drift: nothing,
                    rate,
                }
            }
            Sweep::Circle { arm, rate } => {
                let turned = arm.turned((rate * length).sin_cos());
                let drift = turned.left().times(rate);
                let corners: Vec<_> = self.corners.iter().map(|&corner| corner + (turned - arm)).collect();
                Posture {
                    velocities: vec![drift; corners.len()],
                    corners,
                    normals: self.normals.clone(),
                    origin: nothing,
                    drift,
                    rate: Ball::from(0.0),
                }
            }
        }
    }
}

impl Carried<f64> {
    /// The corners at a length along the segment, about \[m\]: for searches, on which nothing rests.
    pub(crate) fn sketch(&self, length: f64) -> Vec<[f64; 2]> {
        let corners = self.corners.iter().map(|corner| [corner.x.mid, corner.y.mid]);
        let moved = |[x, y]: [f64; 2]| corners.clone().map(|[a, b]| [a + x, b + y]).collect();
        match self.sweep {
            Sweep::Line { along } => moved([along.x.mid * length, along.y.mid * length]),
            Sweep::Turn { centre, rate } => {
                let (sin, cos) = (rate.mid * length).sin_cos();
                corners.map(|[a, b]| [centre.x.mid + a * cos - b * sin, centre.y.mid + a * sin + b * cos]).collect()
            }
            Sweep::Circle { arm, rate } => {
                let (sin, cos) = (rate.mid * length).sin_cos();
                let (x, y) = (arm.x.mid, arm.y.mid);
                moved([x * cos - y * sin - x, x * sin + y * cos - y])
            }
        }
    }
}

/// A body at a length along its segment.
#[derive(Clone, Debug)]
pub struct Posture<R> {
    /// Corners \[m\].
    pub corners: Vec<BallVector<R>>,
    /// By how much each corner moves for each metre along the path.
    pub velocities: Vec<BallVector<R>>,
    /// Outward unit normals of the edges, each from a corner to the next one; none of a disc.
    pub normals: Vec<BallVector<R>>,
    origin: BallVector<R>,
    drift: BallVector<R>,
    rate: Ball<R>,
}

impl<R: BallReal> Posture<R> {
    /// By how much a point that moves with the body moves for each metre along the path.
    pub fn velocity(&self, point: BallVector<R>) -> BallVector<R> {
        self.drift + (point - self.origin).left().times(self.rate)
    }
}

/// A body on a segment, in numbers of both types.
#[derive(Clone, Debug)]
pub struct Placed {
    /// With 106 bits.
    pub exact: Carried<DoubleDouble>,
    /// With 53.
    pub near: Carried<f64>,
    /// Length of the segment, and what lengths along the path are on it.
    pub stretch: PreparedSegment,
    /// Bound on the speed of each point of the body, for a speed of 1 along the path.
    pub(crate) lever: f64,
}

/// A body on all segments of its path.
#[derive(Clone, Debug)]
pub struct Body<'a> {
    /// What it has been made of.
    pub raw: &'a RawBody,
    /// Its segments.
    pub segments: Vec<Placed>,
    /// Radius of its outline \[m\].
    pub radius: Real106,
    /// How far a corner jumps at most where segments meet, all of them together \[m\].
    pub(crate) jumps: f64,
    /// The path as a line of the same lengths: all that the motion along it depends on.
    pub(crate) lengths: RawPath,
}

impl<'a> Body<'a> {
    /// Puts an outline on its path into the plane.
    ///
    /// # Errors
    /// What is wrong with the outline or with the path: a number out of range, lengths that are no sums, a heading that jumps.
    pub fn new(raw: &'a RawBody) -> Result<Self, CertifyError> {
        checked(&raw.outline)?;
        if !((0.0..=MOST).contains(&raw.rounding) && (0.0..=1e-3).contains(&raw.jump)) {
            return Err(CertifyError::OutOfRange("a rounding of lengths or angles"));
        }
        if !raw.start.iter().all(|number| number.abs() <= 1e15) {
            return Err(CertifyError::OutOfRange("the start"));
        }
        let lengths = lengths(raw);
        let along = stretches(&lengths)?;
        let corners: Vec<_> = raw.outline.corners.iter().map(|&corner| vector(corner)).collect();
        let reach = corners.iter().map(|corner| upper(corner.norm())).fold(0.0, f64::max);
        let mut jumps = 0.0;
        let mut direction = angle(raw.direction)?;
        let mut at = vector(raw.start);
        let mut before: Option<Real106> = None;
        let mut segments = Vec::with_capacity(along.len());
        for (place, (segment, stretch)) in raw.segments.iter().zip(along).enumerate() {
            let wrong = CertifyError::of(InputPart::Segment(place));
            for &turn in &segment.turns {
                direction = direction + angle(turn).map_err(wrong)?;
            }
            let rate = rate(segment.course, segment.length).map_err(wrong)?;
            let turned = rate * Ball::from(segment.length);
            let (heading, after) = match segment.heading {
                RawHeading::Along(facing) => {
                    let heading = direction + angle(facing).map_err(wrong)?;
                    (heading, heading + turned)
                }
                RawHeading::Steady(heading) => [angle(heading).map_err(wrong)?; 2].into(),
            };
            if let Some(before) = before.filter(|_| reach > 0.0) {
                jumps += reach * goes_on(before, heading, raw.jump).map_err(wrong)?;
            }
            let [along, ahead] = [unit(direction).map_err(wrong)?, unit(heading).map_err(wrong)?];
            let from_reference: Vec<_> =
                corners.iter().map(|&corner| ahead.times(corner.x) + ahead.left().times(corner.y)).collect();
            let (sweep, first) = match (segment.course, segment.heading) {
                (RawCourse::Line, _) => (Sweep::Line { along }, at),
                (RawCourse::Arc { radius }, RawHeading::Along(_)) => {
                    let arm = along.left().times(Ball::from(-radius));
                    (Sweep::Turn { centre: at - arm, rate }, arm)
                }
                (RawCourse::Arc { radius }, RawHeading::Steady(_)) => {
                    (Sweep::Circle { arm: along.left().times(Ball::from(-radius)), rate }, at)
                }
                (RawCourse::Pivot { .. }, RawHeading::Along(_)) => {
                    (Sweep::Turn { centre: at, rate }, vector([0.0, 0.0]))
                }
                (RawCourse::Pivot { .. }, RawHeading::Steady(_)) => {
                    return Err(wrong(CertifyError::SteadyPivot));
                }
            };
            let placed: Vec<_> = from_reference.into_iter().map(|corner| first + corner).collect();
            let exact = carried(sweep, placed);
            let lever = upper(exact.lever);
            segments.push(Placed { near: Carried::of(&exact), exact, stretch, lever });
            at = match segment.course {
                RawCourse::Line => at + along.times(Ball::from(segment.length)),
                RawCourse::Arc { radius } => {
                    let arm = along.left().times(Ball::from(-radius));
                    at - arm + arm.turned(turned.sin_cos())
                }
                RawCourse::Pivot { .. } => at,
            };
            direction = direction + turned;
            before = Some(after);
        }
        // A few roundings for each segment.
        let jumps = jumps * (1.0 + 1e-9);
        Ok(Self { raw, segments, radius: Ball::from(raw.outline.radius), jumps, lengths })
    }

    /// The box around all that the body passes, grown by a reach \[m\]. No corner is farther from where it is at the nearer end of a segment
    /// than half the length, times the lever.
    pub(crate) fn area(&self, reach: f64) -> PlainBox {
        let mut area = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        for segment in &self.segments {
            let length = segment.stretch.placed.length;
            let way = (0.5 * segment.lever * length.to_f64()).next_up().next_up();
            let grown = ((way + reach).next_up() + self.raw.outline.radius).next_up();
            for end in [DoubleDouble::ZERO, length] {
                for corner in segment.exact.posture(Ball { mid: end, err: 0.0 }).corners {
                    for (axis, value) in [corner.x, corner.y].into_iter().enumerate() {
                        let by = (value.err.next_up() + grown).next_up();
                        let middle = value.mid.to_f64();
                        // What is no number may be anywhere.
                        let outward = |side: f64, end: f64| if side.is_nan() { end } else { side };
                        area[axis] = area[axis].min(outward((middle.next_down() - by).next_down(), f64::NEG_INFINITY));
                        area[axis + 2] = area[axis + 2].max(outward((middle.next_up() + by).next_up(), f64::INFINITY));
                    }
                }
            }
        }
        area
    }

    /// A bound on the speed of each point of the body on any segment, for a speed of 1 along the path.
    pub(crate) fn lever(&self) -> f64 {
        self.segments.iter().map(|segment| segment.lever).fold(1.0, f64::max)
    }
}

/// A bound on a number.
pub(crate) fn upper<R: BallReal>(ball: Ball<R>) -> f64 {
    let most = (ball.to_f64() + ball.err) * (1.0 + 4.0 * f64::EPSILON);
    if most.is_nan() { f64::INFINITY } else { most }
}

/// The path as a line of the same lengths.
fn lengths(raw: &RawBody) -> RawPath {
    let line = |length, from, to| RawSegment { length, radius: None, turns: Vec::new(), from, to };
    RawPath {
        start: [0.0; 2],
        heading: RawAngle::Radians(0.0),
        segments: raw.segments.iter().map(|segment| line(segment.length, segment.from, segment.to)).collect(),
        rounding: raw.rounding,
        step: raw.step,
    }
}

fn angle(angle: RawAngle) -> Result<Real106, CertifyError> {
    let (RawAngle::Radians(number) | RawAngle::Turns(number)) = angle;
    if number.abs() <= 16_777_216.0 {
        Ok(radians(angle))
    } else {
        Err(CertifyError::ValueOutOfRange("an angle of", number))
    }
}

/// Angle for each metre along a course \[rad/m\].
fn rate(course: RawCourse, length: f64) -> Result<Real106, CertifyError> {
    let (RawCourse::Arc { radius: reach } | RawCourse::Pivot { lever: reach }) = course else {
        return Ok(Ball::from(0.0));
    };
    if !(LEAST..=1e15).contains(&reach.abs()) {
        return Err(CertifyError::Reach(reach));
    }
    if length > MOST_TURN * reach.abs() {
        return Err(CertifyError::MoreThanATurn);
    }
    Ok(Ball::from(1.0) / Ball::from(reach))
}

/// Checks that a heading is another one, but for whole turns and rounding, and returns a bound on how far it is off \[rad\].
fn goes_on(before: Real106, heading: Real106, jump: f64) -> Result<f64, CertifyError> {
    let apart = heading - before;
    let turns = (apart.to_f64() / DoubleDouble::TURN.to_f64()).round();
    // 2π is right within 2^-106 of itself.
    let whole = Ball { mid: DoubleDouble::TURN * turns, err: 1e-30 * turns.abs() };
    let rest = (apart - whole).abs();
    // Two headings that are the same number may differ by what the sums are not known by.
    let allowed = Ball::from(jump + 1e-20);
    match rest.above(allowed) {
        Ternary::No => Ok(upper(rest)),
        _ => Err(CertifyError::HeadingJump(rest.to_f64())),
    }
}

fn carried(sweep: Sweep<DoubleDouble>, corners: Vec<BallVector<DoubleDouble>>) -> Carried<DoubleDouble> {
    let count = corners.len();
    let normal = |k: usize| {
        let edge = corners[(k + 1) % count] - corners[k];
        let length = edge.norm();
        let right = edge.left().times(Ball::from(-1.0));
        BallVector { x: right.x / length, y: right.y / length }
    };
    let normals = if count > 1 { (0..count).map(normal).collect() } else { Vec::new() };
    let zero = Ball::from(0.0);
    let (arms, lever) = match sweep {
        Sweep::Line { along } => (vec![zero; count], along.norm()),
        Sweep::Turn { rate, .. } => {
            let arms: Vec<_> = corners.iter().map(|corner| corner.norm()).collect();
            let farthest = arms.iter().fold(zero, |most, &arm| most.max(arm));
            (arms, farthest * rate.abs())
        }
        Sweep::Circle { arm, rate } => {
            let arm = arm.norm();
            (vec![arm; count], arm * rate.abs())
        }
    };
    Carried { sweep, corners, normals, arms, lever }
}
