//! Owned paths of lines, arcs, shifts and turns in place, and the part that is kept when a path is changed.
//!
//! A robot with an outline sweeps an area while it turns in place. So its turns say with `lever` how long the path is for each radian, and all
//! lengths (of positions, authorities, missions and regions, in messages and in the journal) are lengths of the path with its turns: an
//! authority may end within a turn, and a robot says how far it has turned. A disc sweeps nothing, so its turns need no length, and
//! paths of discs are what they were before there were outlines.

use pcr_core::{InvalidInput, Motion, PathRef, Phase, Point, Pose, ProfileRef, Radians, Segment, TurnSide};
use pcr_planning::fleet::ConvexBody;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Largest coordinate of a start, and largest length of a path \[m\]. It includes maps in coordinates of the earth, and the
/// rounding of such numbers is less than the additional radius of the discs.
pub const FAR: f64 = 2e7;

/// A length within this of the end of a shape counts as that end \[m\], because sums and messages round lengths. A path that
/// turns off there is off by at most twice this, half the additional radius of the discs.
pub const JOINT: f64 = 2.5e-7;

/// Largest distance by which rounding may have put a robot from where its missions lead \[m\]: a quarter of the additional radius
/// of the discs. Half is for [`JOINT`], and the rest for the numbers of the present path.
pub const WORN: f64 = 2.5e-7;

/// The pose at which a path begins.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StartPose {
    /// \[m\]
    pub x: f64,
    /// \[m\]
    pub y: f64,
    /// \[rad\], counterclockwise from the x axis.
    pub heading: f64,
}

/// What is missing from the start of a path to where the missions before have led, so that rounding does not add up from path
/// to path; and bounds on the rounding that has added up nevertheless.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathRounding {
    /// \[m\]
    pub x: f64,
    /// \[m\]
    pub y: f64,
    /// \[rad\]
    pub heading: f64,
    /// Bound on the error of the start \[m\].
    #[serde(rename = "off")]
    pub distance_bound: f64,
    /// Bound on the error of its heading \[rad\].
    #[serde(rename = "turned")]
    pub angle_bound: f64,
}

impl PathRounding {
    /// Whether it can be that of a robot.
    pub fn is_valid(&self) -> bool {
        let Self { x, y, heading, distance_bound: off, angle_bound: turned } = *self;
        [x, y, heading].iter().all(|value| value.abs() <= JOINT) && (0.0..=WORN).contains(&off) && turned >= 0.0
    }

    /// Whether nothing is missing.
    pub fn is_nothing(&self) -> bool {
        *self == Self::default()
    }

    /// Bound on the distance of any point of a path of this length \[m\] from where the missions lead \[m\].
    pub fn worn(&self, length: f64) -> f64 {
        self.distance_bound + self.angle_bound * length
    }
}

/// A sum of numbers with what is missing from it by rounding.
#[derive(Clone, Copy)]
struct CompensatedSum(f64, f64);

impl CompensatedSum {
    fn and(self, more: f64) -> Self {
        let Self(sum, rest) = two_sum(self.0, more);
        two_sum(sum, rest + self.1)
    }
}

/// Knuth's sum of two numbers, and exactly what is missing from it.
fn two_sum(a: f64, b: f64) -> CompensatedSum {
    let sum = a + b;
    let added = sum - a;
    CompensatedSum(sum, (a - (sum - added)) + (b - added))
}

/// The pose to which shapes lead.
fn led(start: StartPose, rest: PathRounding, shapes: impl Iterator<Item = PathElement>) -> (StartPose, PathRounding) {
    /// What is missing from [`TAU`] to a full turn.
    const TURN: f64 = 2.449_293_598_294_706_4e-16;
    let (mut x, mut y) = (CompensatedSum(start.x, rest.x), CompensatedSum(start.y, rest.y));
    let mut heading = CompensatedSum(start.heading, rest.heading);
    for shape in shapes {
        let (chord, sweep) = match shape {
            PathElement::Line { length } => (length, 0.0),
            PathElement::Arc { radius, sweep } => (2.0 * radius * (0.5 * sweep.abs()).sin(), sweep),
            PathElement::Turn { sweep, .. } => (0.0, sweep),
            PathElement::Shift { .. } => (shape.length(), 0.0),
        };
        let CompensatedSum(along, small) = heading.and(0.5 * sweep + shape.side());
        let (sin, cos) = along.sin_cos();
        // The small rest of the angle turns the chord by so much.
        (x, y) = (x.and(chord * cos).and(-chord * small * sin), y.and(chord * sin).and(chord * small * cos));
        heading = heading.and(sweep);
    }
    // Wrapped, so that headings do not grow with the turns of all missions.
    let turns = (heading.0 / TAU).round();
    let full = turns * TAU;
    let heading = heading.and(-full).and(-(turns.mul_add(TAU, -full) + turns * TURN));
    (StartPose { x: x.0, y: y.0, heading: heading.0 }, PathRounding { x: x.1, y: y.1, heading: heading.1, ..rest })
}

/// A part of a path; it begins in the pose in which the part before ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum PathElement {
    /// Straight.
    Line {
        /// \[m\], 0 or more.
        length: f64,
    },
    /// Circular, at most a full turn.
    Arc {
        /// \[m\]
        radius: f64,
        /// \[rad\], left positive.
        sweep: f64,
    },
    /// Straight, in a direction from the heading, which stays as it is: backward, sideways.
    Shift {
        /// \[m\]
        ahead: f64,
        /// \[m\]
        left: f64,
    },
    /// In place.
    Turn {
        /// \[rad\], left positive.
        sweep: f64,
        /// Length of the path for each radian \[m\]; without it the turn has no length, and is no path for an outline.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        lever: Option<f64>,
    },
}

impl PathElement {
    /// \[m\]
    pub fn length(self) -> f64 {
        match self {
            Self::Line { length } => length,
            Self::Arc { radius, sweep } => radius * sweep.abs(),
            Self::Shift { ahead, left } => ahead.hypot(left),
            Self::Turn { sweep, lever } => lever.map_or(0.0, |lever| lever * sweep.abs()),
        }
    }

    /// Bound on the distance from its start to any of its points \[m\].
    fn extent(self) -> f64 {
        match self {
            Self::Arc { radius, .. } => self.length().min(2.0 * radius),
            Self::Line { .. } | Self::Shift { .. } => self.length(),
            Self::Turn { .. } => 0.0,
        }
    }

    /// The angle from the heading to the direction of travel \[rad\].
    fn side(self) -> f64 {
        match self {
            Self::Shift { ahead, left } => left.atan2(ahead),
            _ => 0.0,
        }
    }

    /// The shape cut to this length \[m\].
    fn of_length(self, length: f64) -> Self {
        match self {
            Self::Shift { ahead, left } => {
                let share = length / ahead.hypot(left);
                Self::Shift { ahead: ahead * share, left: left * share }
            }
            Self::Line { .. } => Self::Line { length },
            Self::Arc { radius, sweep } => Self::Arc { radius, sweep: (length / radius).copysign(sweep) },
            Self::Turn { sweep, lever: Some(lever) } => {
                Self::Turn { sweep: (length / lever).copysign(sweep), lever: Some(lever) }
            }
            Self::Turn { lever: None, .. } => self,
        }
    }
}

/// Bound on the distance from the start of these shapes to any of their points \[m\].
pub fn extent(shapes: &[PathElement]) -> f64 {
    shapes.iter().map(|shape| shape.extent()).sum()
}

/// A path that owns its parts.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "PathRecord", into = "PathRecord")]
pub struct OwnedPath {
    start: StartPose,
    shapes: Vec<PathElement>,
    segments: Vec<Segment<f64>>,
    /// Length before each shape, and the whole length \[m\]: the same numbers as in the segments.
    offsets: Vec<f64>,
    phases: Vec<Phase<f64>>,
}

/// A course in files and messages.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PathRecord {
    start: StartPose,
    path: Vec<PathElement>,
}

impl TryFrom<PathRecord> for OwnedPath {
    type Error = InvalidInput;

    fn try_from(sketch: PathRecord) -> Result<Self, InvalidInput> {
        Self::new(sketch.start, sketch.path)
    }
}

impl From<OwnedPath> for PathRecord {
    fn from(course: OwnedPath) -> Self {
        Self { start: course.start, path: course.shapes }
    }
}

impl OwnedPath {
    /// A course along these shapes. Without shapes it is a robot that stands at the start.
    ///
    /// # Errors
    /// [`InvalidInput`], as for paths of `pcr_core`.
    pub fn new(start: StartPose, shapes: Vec<PathElement>) -> Result<Self, InvalidInput> {
        for (name, value) in [("x", start.x), ("y", start.y)] {
            if value.abs() > FAR {
                return Err(InvalidInput::OutOfRange(name));
            }
        }
        let pose = Pose { position: Point::new(start.x, start.y), heading: Radians(start.heading) };
        let mut last = Segment::standing(pose)?;
        let (mut segments, mut before): (Vec<Segment<f64>>, _) = (Vec::new(), Vec::with_capacity(shapes.len()));
        let (shifts, mut side) = (shapes.iter().any(|shape| shape.side() != 0.0), 0.0);
        for &shape in &shapes {
            before.push(segments.len());
            // The direction of travel becomes another one, and the heading does not.
            let sideways = shape.side() - side;
            if sideways != 0.0 && shape.length() > 0.0 {
                last = last.turned(Radians(sideways))?;
                segments.last_mut().into_iter().for_each(|segment| *segment = last);
                side = shape.side();
            }
            let next = match shape {
                PathElement::Turn { sweep, lever: None } => {
                    last = last.turned(Radians(sweep))?;
                    if let Some(segment) = segments.last_mut() {
                        *segment = last;
                    }
                    continue;
                }
                PathElement::Line { .. } | PathElement::Shift { .. } => last.then_line(shape.length())?,
                PathElement::Arc { radius, sweep } => last.then_arc(radius, turn_side(sweep)?, shape.length())?,
                PathElement::Turn { sweep, lever: Some(lever) } => {
                    last.then_pivot(lever, turn_side(sweep)?, shape.length())?
                }
            };
            if next.length() > 0.0 {
                last = if shifts { next.facing(Radians(-side))? } else { next };
                segments.push(last);
            }
        }
        if segments.is_empty() {
            segments.push(last);
        }
        let length = PathRef::new(&segments)?.length();
        if length > FAR {
            return Err(InvalidInput::OutOfRange("length"));
        }
        let phases = if length > 0.0 { vec![Phase::starting_at(1.0, length, 0.0)?] } else { Vec::new() };
        let offset = |&place: &usize| segments.get(place).map_or(length, Segment::from);
        let offsets = before.iter().map(offset).chain([length]).collect();
        Ok(Self { start, shapes, segments, offsets, phases })
    }

    /// \[m\]
    pub fn length(&self) -> f64 {
        self.offsets.last().copied().unwrap_or(0.0)
    }

    /// Its first pose.
    pub fn start(&self) -> StartPose {
        self.start
    }

    /// Its parts.
    pub fn shapes(&self) -> &[PathElement] {
        &self.shapes
    }

    /// The pose at a length \[m\], limited to the path.
    pub fn pose(&self, length: f64) -> StartPose {
        // The constructor has checked them.
        let pose = PathRef::new(&self.segments).map(|path| path.pose_at(length));
        let pose = pose.unwrap_or(Pose { position: Point::default(), heading: Radians(self.start.heading) });
        StartPose { x: pose.position.x, y: pose.position.y, heading: pose.heading.0 - self.side(length) }
    }

    /// The angle from the heading to the direction of travel from a length on, and at the end that with which it is reached \[rad\].
    fn side(&self, length: f64) -> f64 {
        let there = |k: &usize| self.offsets[*k] < self.offsets[k + 1];
        let ahead = (0..self.shapes.len()).filter(there).find(|k| length < self.offsets[k + 1]);
        let shape = ahead.or_else(|| (0..self.shapes.len()).rfind(there)).and_then(|k| self.shapes.get(k));
        shape.map_or(0.0, |shape| shape.side())
    }

    /// The motion of a disc or an outline at 1 m/s: passing orders need no times.
    ///
    /// # Errors
    /// [`InvalidInput`] for the radius, and for an outline if a turn in place has no length.
    pub fn motion<'a>(&'a self, body: &'a ConvexBody) -> Result<Motion<'a, f64>, InvalidInput> {
        self.motion_by(ProfileRef::new(&self.phases)?, body)
    }

    /// The motion of a disc or an outline by a profile, from the time 0 on.
    ///
    /// # Errors
    /// As [`OwnedPath::motion`], and for a profile of another length.
    pub(crate) fn motion_by<'a>(
        &'a self,
        profile: ProfileRef<'a, f64>,
        body: &'a ConvexBody,
    ) -> Result<Motion<'a, f64>, InvalidInput> {
        // The path does not show it where the robot begins with such a turn.
        let moves = |shape: &PathElement| match *shape {
            PathElement::Turn { sweep, lever: None } => sweep.abs() * body.reach() > JOINT,
            _ => false,
        };
        if !body.is_disc() && self.shapes.iter().any(moves) {
            return Err(InvalidInput::TurnInPlace);
        }
        body.motion(PathRef::new(&self.segments)?, profile, 0.0)
    }

    /// Bound on how far a point moves that is within `spread` of the reference point \[m\], for each metre of the path.
    pub(crate) fn stretch(&self, spread: f64) -> f64 {
        let of = |shape: &PathElement| match *shape {
            PathElement::Line { .. } | PathElement::Shift { .. } | PathElement::Turn { lever: None, .. } => 1.0,
            PathElement::Arc { radius, .. } => 1.0 + spread / radius,
            PathElement::Turn { lever: Some(lever), .. } => spread / lever,
        };
        self.shapes.iter().map(of).fold(1.0, f64::max)
    }

    /// The end of a shape that is within rounding of this length, otherwise the length itself \[m\].
    fn joint(&self, length: f64) -> f64 {
        let off = |end: f64| (end - length).abs();
        let near = self.offsets.iter().copied().filter(|&end| off(end) <= JOINT);
        near.min_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap_or(length)
    }

    /// The part between two lengths \[m\]. A turn in place at its beginning is left out.
    ///
    /// # Errors
    /// [`InvalidInput`] if the part is no path.
    pub fn part(&self, from: f64, to: f64) -> Result<Self, InvalidInput> {
        let to = self.joint(to);
        let Some(first) = self.ahead(from, to) else { return Self::new(self.arrival(from)?, Vec::new()) };
        let mut kept: Vec<PathElement> = self.up_to(first, to).collect();
        if from <= self.offsets[first] {
            return Self::new(self.departure(first, PathRounding::default()).0, kept);
        }
        if let Some(shape) = kept.first_mut() {
            *shape = shape.of_length(self.offsets[first + 1].min(to) - from);
        }
        Self::new(self.pose(from), kept)
    }

    /// The part from the shape on that contains `from`, up to `to`, followed by other shapes; the length that is left out
    /// before it \[m\], and what is missing from its start. `rest` is what is missing from the start of this path.
    ///
    /// # Errors
    /// [`InvalidInput`] if the result is no path.
    pub fn rejoined(
        &self,
        from: f64,
        to: f64,
        shapes: &[PathElement],
        rest: PathRounding,
    ) -> Result<(Self, f64, PathRounding), InvalidInput> {
        let to = self.joint(to);
        let first = self.ahead(from, to);
        let ((start, mut rest), dropped) = match first {
            // The robot stands: nothing of the old path is ahead.
            None => (led(self.start, rest, self.up_to(0, to)), to),
            Some(first) => (self.departure(first, rest), self.offsets[first]),
        };
        let kept = self.up_to(first.unwrap_or(self.shapes.len()), to);
        let kept = kept.chain(shapes.iter().copied()).collect();
        // The error of a heading counts along all that is left out. Beside that, the chord, its direction and their product are
        // rounded: together by less than 8 times the last digit of the length. What is added up is exact.
        rest.distance_bound += rest.angle_bound * dropped + 8.0 * f64::EPSILON * dropped;
        // A shape that is cut ends where the length before it, and its own, are rounded; an arc is turned by that, too.
        if let Some(cut) = self.cut(to) {
            let rounding = 2.0 * f64::EPSILON * to;
            rest.distance_bound += rounding;
            if let PathElement::Arc { radius: lever, sweep } | PathElement::Turn { lever: Some(lever), sweep } = cut {
                rest.angle_bound += rounding / lever + f64::EPSILON * sweep.abs();
            }
        }
        Ok((Self::new(start, kept)?, dropped, rest))
    }

    /// The shape that is cut if the path ends at a length.
    fn cut(&self, to: f64) -> Option<PathElement> {
        let is_cut = |ends: &[f64]| ends[0] < to && to < ends[1];
        self.offsets.windows(2).zip(&self.shapes).find(|(ends, _)| is_cut(ends)).map(|(_, shape)| *shape)
    }

    /// The first shape, other than a turn without a length, that goes beyond `from`, if it begins before `to`.
    fn ahead(&self, from: f64, to: f64) -> Option<usize> {
        let first = (0..self.shapes.len()).find(|&k| self.offsets[k + 1] > from.max(0.0) + JOINT)?;
        (from < to && self.offsets[first] < to).then_some(first)
    }

    /// The pose in which a shape begins, after the turns before it.
    fn departure(&self, shape: usize, rest: PathRounding) -> (StartPose, PathRounding) {
        led(self.start, rest, self.shapes.iter().take(shape).copied())
    }

    /// The pose of arrival at a length \[m\]: before a turn in place there, except at the end of the course.
    ///
    /// # Errors
    /// [`InvalidInput`] if there is no such length.
    pub fn arrival(&self, length: f64) -> Result<StartPose, InvalidInput> {
        let before = Self::new(self.start, self.up_to(0, self.joint(length)).collect())?;
        Ok(before.pose(before.length()))
    }

    /// The shapes from one on, up to a length, with the turns in place before it; those at the length only at the end of the
    /// course.
    fn up_to(&self, first: usize, to: f64) -> impl Iterator<Item = PathElement> {
        (first..self.shapes.len()).filter_map(move |k| {
            let (begin, end, shape) = (self.offsets[k], self.offsets[k + 1], self.shapes[k]);
            match shape {
                PathElement::Turn { lever: None, .. } => (begin < to || to >= self.length()).then_some(shape),
                _ if to >= end => (end > begin).then_some(shape),
                _ => (to > begin).then(|| shape.of_length(to - begin)),
            }
        })
    }
}

/// The side to which an angle turns.
fn turn_side(sweep: f64) -> Result<TurnSide, InvalidInput> {
    match sweep.is_finite() {
        false => Err(InvalidInput::NonFinite("sweep")),
        true if sweep < 0.0 => Ok(TurnSide::Right),
        true => Ok(TurnSide::Left),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_formats::splitmix64::SplitMix64;
    use std::f64::consts::PI;

    fn shape(random: &mut SplitMix64) -> PathElement {
        match random.below(4) {
            0 => PathElement::Line { length: random.uniform(0.1, 3.0) },
            1 => PathElement::Arc { radius: random.uniform(0.5, 3.0), sweep: random.uniform(-PI, PI) },
            2 => PathElement::Shift { ahead: random.uniform(-2.0, 2.0), left: random.uniform(-2.0, 2.0) },
            _ => PathElement::Turn { sweep: random.uniform(-PI, PI), lever: Some(random.uniform(0.02, 2.0)) },
        }
    }

    fn same(a: StartPose, b: StartPose) -> bool {
        (a.x - b.x).hypot(a.y - b.y) < 1e-9
            && (a.heading - b.heading).sin().hypot(1.0 - (a.heading - b.heading).cos()) < 1e-9
    }

    /// Where a body is after some shapes, computed with nothing of the library.
    fn after(mut pose: StartPose, shapes: &[PathElement]) -> StartPose {
        for shape in shapes {
            let (sin, cos) = pose.heading.sin_cos();
            let (ahead, left, sweep) = match *shape {
                PathElement::Line { length } => (length, 0.0, 0.0),
                PathElement::Shift { ahead, left } => (ahead, left, 0.0),
                PathElement::Turn { sweep, .. } => (0.0, 0.0, sweep),
                PathElement::Arc { radius, sweep } => {
                    (radius * sweep.abs().sin(), (radius * (1.0 - sweep.cos())).copysign(sweep), sweep)
                }
            };
            pose.x += ahead * cos - left * sin;
            pose.y += ahead * sin + left * cos;
            pose.heading += sweep;
        }
        pose
    }

    /// Parts and new paths of a robot are where the whole path is, with its heading, wherever they begin and end.
    #[test]
    fn parts_of_paths_with_shifts_and_turns_have_their_poses() {
        let mut random = SplitMix64(3);
        let start = StartPose { x: 1.0, y: -2.0, heading: 0.7 };
        let square = pcr_formats::footprint::Footprint::new(vec![[-0.3, -0.4], [0.6, -0.4], [0.6, 0.4], [-0.3, 0.4]]);
        let body = ConvexBody::of_vehicle(Some(&square.unwrap()), 0.0).unwrap();
        for _ in 0..300 {
            let shapes: Vec<PathElement> = (0..=random.below(7)).map(|_| shape(&mut random)).collect();
            let path = OwnedPath::new(start, shapes.clone()).unwrap();
            // An outline never jumps along it.
            path.motion(&body).unwrap();
            assert!(same(path.pose(path.length()), after(start, &shapes)), "{shapes:?}");
            assert!(same(path.arrival(path.length()).unwrap(), after(start, &shapes)), "{shapes:?}");
            for (k, &length) in path.offsets.iter().enumerate() {
                assert!(same(path.pose(length), after(start, &shapes[..k])), "{k}: {shapes:?}");
            }
            let mut ends = [0.0, 1.0].map(|_| random.uniform(0.0, path.length()));
            ends.sort_by(f64::total_cmp);
            let [from, to] = ends;
            let part = path.part(from, to).unwrap();
            assert!((part.length() - (to - from)).abs() < 1e-9, "{from} {to} {shapes:?}");
            let more = shape(&mut random);
            let (next, dropped, _) = path.rejoined(from, to, &[more], PathRounding::default()).unwrap();
            assert!((next.length() - (to - dropped + more.length())).abs() < 1e-9, "{from} {to} {shapes:?}");
            next.motion(&body).unwrap();
            assert!(
                same(next.pose(next.length()), after(path.arrival(to).unwrap(), &[more])),
                "{to} {shapes:?} {more:?}"
            );
            for _ in 0..5 {
                let at = random.uniform(from, to);
                assert!(same(part.pose(at - from), path.pose(at)), "{from} {to} {at} {shapes:?}");
                assert!(same(next.pose(at - dropped), path.pose(at)), "{from} {to} {at} {shapes:?}");
            }
        }
    }
}
