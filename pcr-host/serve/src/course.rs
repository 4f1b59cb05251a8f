//! Owned paths of lines, arcs and turns in place, and the part that is kept when a path is changed.

use pcr_core::{Invalid, Motion, PathRef, Phase, Point, Pose, ProfileRef, Radians, Segment, Turn};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Paths begin no further off than this, and are no longer \[m\]: coordinates of maps of the earth are in it, and what they are rounded to is
/// less than what discs are larger by.
pub const FAR: f64 = 2e7;

/// Where a path begins.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Start {
    /// \[m\]
    pub x: f64,
    /// \[m\]
    pub y: f64,
    /// \[rad\], counterclockwise from the x axis.
    pub heading: f64,
}

/// A part of a path, in the pose in which the one before it ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Shape {
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
    /// In place: it has no length.
    Turn {
        /// \[rad\], left positive.
        sweep: f64,
    },
}

impl Shape {
    /// \[m\]
    pub fn length(self) -> f64 {
        match self {
            Self::Line { length } => length,
            Self::Arc { radius, sweep } => radius * sweep.abs(),
            Self::Turn { .. } => 0.0,
        }
    }

    /// From its beginning to any of its places it is no further \[m\].
    fn extent(self) -> f64 {
        match self {
            Self::Arc { radius, .. } => self.length().min(2.0 * radius),
            _ => self.length(),
        }
    }

    /// The part between two lengths of it \[m\].
    fn part(self, whole: f64, from: f64, to: f64) -> Self {
        match self {
            _ if from <= 0.0 && to >= whole => self,
            Self::Line { .. } => Self::Line { length: to - from },
            Self::Arc { radius, sweep } => Self::Arc { radius, sweep: ((to - from) / radius).copysign(sweep) },
            Self::Turn { .. } => self,
        }
    }
}

/// From the beginning of these shapes to any of their places it is no further \[m\].
pub fn extent(shapes: &[Shape]) -> f64 {
    shapes.iter().map(|shape| shape.extent()).sum()
}

/// A path that owns its parts.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(try_from = "Sketch", into = "Sketch")]
pub struct Course {
    start: Start,
    shapes: Vec<Shape>,
    segments: Vec<Segment<f64>>,
    /// Length before each shape \[m\].
    offsets: Vec<f64>,
    phases: Vec<Phase<f64>>,
}

/// A course as files and messages say it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Sketch {
    start: Start,
    path: Vec<Shape>,
}

impl TryFrom<Sketch> for Course {
    type Error = Invalid;

    fn try_from(sketch: Sketch) -> Result<Self, Invalid> {
        Self::new(sketch.start, sketch.path)
    }
}

impl From<Course> for Sketch {
    fn from(course: Course) -> Self {
        Self { start: course.start, path: course.shapes }
    }
}

impl Course {
    /// Along these shapes; none of them is standing at the start.
    ///
    /// # Errors
    /// [`Invalid`] as the paths of `pcr_core`.
    pub fn new(start: Start, shapes: Vec<Shape>) -> Result<Self, Invalid> {
        for (name, value) in [("x", start.x), ("y", start.y)] {
            if value.abs() > FAR {
                return Err(Invalid::OutOfRange(name));
            }
        }
        let pose = Pose { position: Point::new(start.x, start.y), heading: Radians(start.heading) };
        let mut last = Segment::standing(pose)?;
        let (mut segments, mut offsets): (Vec<Segment<f64>>, _) = (Vec::new(), Vec::with_capacity(shapes.len()));
        for &shape in &shapes {
            offsets.push(last.from() + last.length());
            let next = match shape {
                Shape::Turn { sweep } => {
                    last = last.turned(Radians(sweep))?;
                    if let Some(before) = segments.last_mut() {
                        *before = last;
                    }
                    continue;
                }
                Shape::Line { length } => last.then_line(length)?,
                Shape::Arc { radius, sweep } => {
                    if !sweep.is_finite() {
                        return Err(Invalid::NonFinite("sweep"));
                    }
                    last.then_arc(radius, if sweep < 0.0 { Turn::Right } else { Turn::Left }, shape.length())?
                }
            };
            if next.length() > 0.0 {
                last = next;
                segments.push(next);
            }
        }
        if segments.is_empty() {
            segments.push(last);
        }
        let length = PathRef::new(&segments)?.length();
        if length > FAR {
            return Err(Invalid::OutOfRange("length"));
        }
        let phases = if length > 0.0 { vec![Phase::starting_at(1.0, length, 0.0)?] } else { Vec::new() };
        Ok(Self { start, shapes, segments, offsets, phases })
    }

    /// \[m\]
    pub fn length(&self) -> f64 {
        self.segments.last().map_or(0.0, |last| last.from() + last.length())
    }

    /// Where it begins.
    pub fn start(&self) -> Start {
        self.start
    }

    /// Its parts.
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// Where a robot is after so much \[m\], limited to the path.
    pub fn pose(&self, length: f64) -> Start {
        // The constructor has checked them.
        let pose = PathRef::new(&self.segments).map(|path| path.pose_at(length));
        let pose = pose.unwrap_or(Pose { position: Point::default(), heading: Radians(self.start.heading) });
        Start { x: pose.position.x, y: pose.position.y, heading: pose.heading.0 }
    }

    /// As a disc of this radius \[m\] at 1 m/s: orders need no times.
    ///
    /// # Errors
    /// [`Invalid`] for the radius.
    pub fn motion(&self, radius: f64) -> Result<Motion<'_, f64>, Invalid> {
        self.motion_by(ProfileRef::new(&self.phases)?, radius)
    }

    /// As a disc that moves by a profile from the time 0 on.
    ///
    /// # Errors
    /// [`Invalid`] for the radius, and a profile of another length.
    pub fn motion_by<'a>(&'a self, profile: ProfileRef<'a, f64>, radius: f64) -> Result<Motion<'a, f64>, Invalid> {
        Motion::new(PathRef::new(&self.segments)?, profile, radius, 0.0)
    }

    /// The part between two lengths \[m\].
    ///
    /// # Errors
    /// [`Invalid`] where it is no path.
    pub fn part(&self, from: f64, to: f64) -> Result<Self, Invalid> {
        Self::new(self.pose(from), self.between(from, to).collect())
    }

    /// This course from the part on in which `from` is, up to `to`, and then other shapes; with the length that is left out before
    /// it \[m\].
    ///
    /// # Errors
    /// [`Invalid`] where that is no path.
    pub fn rejoined(&self, from: f64, to: f64, shapes: &[Shape]) -> Result<(Self, f64), Invalid> {
        let first = (0..self.shapes.len()).find(|&k| self.offsets[k] + self.shapes[k].length() > from);
        let (start, dropped) = match first.filter(|_| to > from) {
            // Nothing of it is ahead: a robot that stands.
            None => (self.arrival(from)?, from),
            Some(first) => (self.departure(first), self.offsets[first]),
        };
        let first = first.filter(|_| to > from).unwrap_or(self.shapes.len());
        let all = self.length();
        let kept = (first..self.shapes.len()).filter_map(|k| {
            let (begin, shape) = (self.offsets[k], self.shapes[k]);
            let end = (begin + shape.length()).min(to);
            match shape {
                Shape::Turn { .. } => (begin < to || to >= all).then_some(shape),
                _ => (end > begin).then(|| shape.part(shape.length(), 0.0, end - begin)),
            }
        });
        let kept = kept.chain(shapes.iter().copied()).collect();
        // It does not grow with the turns of all missions before.
        let heading = (start.heading + PI).rem_euclid(TAU) - PI;
        Ok((Self::new(Start { heading, ..start }, kept)?, dropped))
    }

    /// In which pose a shape begins, after the turns before it: which of two shapes a length belongs to is a matter of rounding there.
    fn departure(&self, shape: usize) -> Start {
        self.shapes.iter().take(shape).fold(self.start, |Start { x, y, heading }, shape| {
            let (chord, sweep) = match *shape {
                Shape::Line { length } => (length, 0.0),
                Shape::Arc { radius, sweep } => (2.0 * radius * (0.5 * sweep.abs()).sin(), sweep),
                Shape::Turn { sweep } => (0.0, sweep),
            };
            let (sin, cos) = (heading + 0.5 * sweep).sin_cos();
            Start { x: x + chord * cos, y: y + chord * sin, heading: heading + sweep }
        })
    }

    /// How it arrives at a length \[m\]: before a turn there, but at its end.
    ///
    /// # Errors
    /// [`Invalid`] where that is no place.
    pub fn arrival(&self, length: f64) -> Result<Start, Invalid> {
        let before = Self::new(self.start, self.between(-1.0, length).collect())?;
        Ok(before.pose(before.length()))
    }

    /// The parts of shapes between two lengths; of turns in place those in between, and those at the end of all.
    fn between(&self, from: f64, to: f64) -> impl Iterator<Item = Shape> {
        let all = self.length();
        let ends = self.offsets.iter().skip(1).copied().chain([all]);
        self.shapes.iter().zip(&self.offsets).zip(ends).filter_map(move |((&shape, &begin), end)| {
            let (lo, hi) = (begin.max(from), end.min(to));
            match shape {
                Shape::Turn { .. } => (begin > from && (begin < to || to >= all)).then_some(shape),
                _ => (hi > lo).then(|| shape.part(end - begin, lo - begin, hi - begin)),
            }
        })
    }
}
