//! Test cases as plain numbers: a disc on a chain of lines and arcs.
//!
//! The oracle and the library are both built from this description, which is why it holds no geometry.

use pcr_core::{InvalidInput, Limits, Motion, PathRef, Phase, Point, Pose, Profile, ProfileRef, Segment, TurnSide};
use pcr_formats::scenario::{Agent, MotionSpec, PathSegment};
use pcr_planning::fleet::HostScalar;
use std::f64::consts::TAU;

/// A line or an arc of a path, by its length \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Leg {
    /// Straight.
    Line(f64),
    /// Circular, counter-clockwise.
    Left {
        /// Radius \[m\].
        radius: f64,
        /// \[m\]
        length: f64,
    },
    /// Circular, clockwise.
    Right {
        /// Radius \[m\].
        radius: f64,
        /// \[m\]
        length: f64,
    },
}

impl Leg {
    /// The arc of this radius \[m\] and sweep \[rad\], left positive.
    pub fn arc(radius: f64, sweep: f64) -> Self {
        let length = radius * sweep.abs();
        if sweep < 0.0 { Self::Right { radius, length } } else { Self::Left { radius, length } }
    }

    /// Length \[m\].
    pub fn length(self) -> f64 {
        match self {
            Self::Line(length) | Self::Left { length, .. } | Self::Right { length, .. } => length,
        }
    }

    /// Radius of an arc \[m\].
    pub fn radius(self) -> Option<f64> {
        match self {
            Self::Line(_) => None,
            Self::Left { radius, .. } | Self::Right { radius, .. } => Some(radius),
        }
    }

    /// Change of heading over the whole leg \[rad\], left positive.
    pub fn sweep(self) -> f64 {
        match self {
            Self::Line(_) => 0.0,
            Self::Left { radius, length } => length / radius,
            Self::Right { radius, length } => -length / radius,
        }
    }

    /// The same shape with another length \[m\].
    pub fn with_length(self, length: f64) -> Self {
        match self {
            Self::Line(_) => Self::Line(length),
            Self::Left { radius, .. } => Self::Left { radius, length },
            Self::Right { radius, .. } => Self::Right { radius, length },
        }
    }

    /// The same leg, driven from its end to its start.
    pub fn reversed(self) -> Self {
        match self {
            Self::Line(length) => Self::Line(length),
            Self::Left { radius, length } => Self::Right { radius, length },
            Self::Right { radius, length } => Self::Left { radius, length },
        }
    }
}

/// A disc and its path.
#[derive(Clone, Debug, PartialEq)]
pub struct Disc {
    /// Radius \[m\].
    pub radius: f64,
    /// Start of the path: abscissa \[m\], ordinate \[m\], heading \[rad\].
    pub start: [f64; 3],
    /// The path.
    pub legs: Vec<Leg>,
}

impl Disc {
    /// Length of the path \[m\].
    pub fn length(&self) -> f64 {
        self.legs.iter().map(|leg| leg.length()).sum()
    }

    /// The disc and path of an agent of a scenario; arcs of more than one turn are cut into equal parts.
    pub fn of_agent(agent: &Agent) -> Self {
        let mut legs = Vec::new();
        for segment in &agent.path {
            match *segment {
                PathSegment::Line { length } => legs.push(Leg::Line(length)),
                PathSegment::Arc { radius, sweep, .. } => {
                    let turns = (sweep.abs() / TAU).ceil().max(1.0);
                    legs.extend(std::iter::repeat_n(Leg::arc(radius, sweep / turns), turns as usize));
                }
                _ => panic!("{segment:?}"),
            }
        }
        Self { radius: agent.radius, start: agent.start, legs }
    }

    /// The numbers that are left of it in the format `S`. The library sees exactly these, and so must whoever checks
    /// it: the rounding of the input is not an error of the algorithm.
    pub fn rounded<S: HostScalar>(&self) -> Self {
        let round = |value: f64| S::from_f64(value).to_f64();
        let legs = self.legs.iter().map(|leg| match *leg {
            Leg::Line(length) => Leg::Line(round(length)),
            Leg::Left { radius, length } => Leg::Left { radius: round(radius), length: round(length) },
            Leg::Right { radius, length } => Leg::Right { radius: round(radius), length: round(length) },
        });
        let [x, y, heading] = self.start;
        let start = [round(x), round(y), S::radians(S::angle(heading).expect("an angle"))];
        let mut rounded = Self { radius: round(self.radius), start, legs: legs.collect() };
        rounded.legs.retain(|leg| leg.length() > 0.0);
        // The library takes a full turn that rounding made too long back to the circumference.
        if let Ok(course) = Course::<S>::new(&rounded) {
            for (leg, segment) in rounded.legs.iter_mut().zip(&course.segments) {
                *leg = leg.with_length(segment.length().to_f64());
            }
        }
        rounded
    }

    /// The disc with a radius that is larger by `by` \[m\].
    pub fn grown(&self, by: f64) -> Self {
        Self { radius: self.radius + by, ..self.clone() }
    }
}

/// How a disc moves along its path.
#[derive(Clone, Debug, PartialEq)]
pub enum Drive {
    /// At 1 m/s throughout, so that the time since the start equals the travelled length: regions in
    /// path-time space are then those of coordination space, and no rounding of a speed profile disturbs them.
    Unit,
    /// From rest to rest under these limits, \[m/s\] and \[m/s²\].
    Limits(f64, f64),
    /// Initial speed \[m/s\], then durations \[s\] and accelerations \[m/s²\].
    Pieces(f64, Vec<(f64, f64)>),
}

impl Drive {
    /// The motion of an agent of a scenario.
    pub fn of_agent(agent: &Agent) -> Self {
        match &agent.motion {
            MotionSpec::RestToRest { v_max, a_max } => Self::Limits(*v_max, *a_max),
            MotionSpec::Profile { .. } => {
                let (v0, pieces) = agent.motion.pieces(agent.length());
                Self::Pieces(v0, pieces)
            }
        }
    }

    /// No speed is above this \[m/s\].
    pub fn top_speed(&self) -> f64 {
        match self {
            Self::Unit => 1.0,
            Self::Limits(speed, _) => *speed,
            Self::Pieces(speed, pieces) => {
                let after = pieces.iter().scan(*speed, |speed, (duration, acceleration)| {
                    *speed += duration * acceleration;
                    Some(*speed)
                });
                after.fold(*speed, f64::max)
            }
        }
    }

    /// The numbers that are left of it in the format `S`.
    pub fn rounded<S: HostScalar>(&self) -> Self {
        let round = |value: f64| S::from_f64(value).to_f64();
        match self {
            Self::Unit => Self::Unit,
            Self::Limits(speed, acceleration) => Self::Limits(round(*speed), round(*acceleration)),
            Self::Pieces(speed, pieces) => {
                let pieces = pieces.iter().map(|&(duration, acceleration)| (round(duration), round(acceleration)));
                Self::Pieces(round(*speed), pieces.collect())
            }
        }
    }
}

/// A disc, how it is driven, and when it sets off \[s\].
pub type Driven = (Disc, Drive, f64);

/// What a motion of the library borrows.
#[derive(Clone, Debug)]
pub struct Course<S: HostScalar> {
    segments: Vec<Segment<S>>,
    phases: Vec<Phase<S>>,
    radius: S,
    start: S,
}

impl<S: HostScalar> Course<S> {
    /// The disc with speed 1 m/s from the time 0 on.
    ///
    /// # Errors
    /// As the library's constructors.
    pub fn new(disc: &Disc) -> Result<Self, InvalidInput> {
        Self::driven(disc, &Drive::Unit, 0.0)
    }

    /// The disc, driven from the time `start` \[s\] on.
    ///
    /// # Errors
    /// As the library's constructors.
    pub fn driven(disc: &Disc, drive: &Drive, start: f64) -> Result<Self, InvalidInput> {
        let [x, y, heading] = disc.start;
        let position = Point::new(S::from_f64(x), S::from_f64(y));
        let origin = Segment::standing(Pose { position, heading: S::angle(heading).expect("an angle") })?;
        let mut segments = Vec::<Segment<S>>::new();
        for leg in &disc.legs {
            let last = segments.last().unwrap_or(&origin);
            let length = S::from_f64(leg.length());
            let next = match *leg {
                Leg::Line(_) => last.then_line(length)?,
                Leg::Left { radius, .. } => last.then_arc(S::from_f64(radius), TurnSide::Left, length)?,
                Leg::Right { radius, .. } => last.then_arc(S::from_f64(radius), TurnSide::Right, length)?,
            };
            if next.length() > S::ZERO {
                segments.push(next);
            }
        }
        if segments.is_empty() {
            segments.push(origin);
        }
        let length = PathRef::new(&segments)?.length();
        let mut phases = Vec::new();
        match drive {
            Drive::Unit if length > S::ZERO => phases.push(Phase::starting_at(S::from_f64(1.0), length, S::ZERO)?),
            Drive::Unit => {}
            Drive::Limits(speed, acceleration) => {
                let limits = Limits { speed: S::from_f64(*speed), acceleration: S::from_f64(*acceleration) };
                phases.extend_from_slice(Profile::rest_to_rest(length, limits)?.as_profile().phases());
            }
            Drive::Pieces(speed, pieces) => {
                for &(duration, acceleration) in pieces {
                    let (duration, acceleration) = (S::from_f64(duration), S::from_f64(acceleration));
                    phases.push(match phases.last() {
                        None => Phase::starting_at(S::from_f64(*speed), duration, acceleration)?,
                        Some(last) => last.then(duration, acceleration)?,
                    });
                }
            }
        }
        let course = Self { segments, phases, radius: S::from_f64(disc.radius), start: S::from_f64(start) };
        course.try_motion()?;
        Ok(course)
    }

    /// The driven disc with the numbers that are left of it in the format `S`, and its course; none where it does not fit.
    pub fn rounded((disc, drive, start): &Driven) -> Option<(Self, Driven)> {
        let (disc, drive, start) = (disc.rounded::<S>(), drive.rounded::<S>(), S::from_f64(*start).to_f64());
        Some((Self::driven(&disc, &drive, start).ok()?, (disc, drive, start)))
    }

    /// The motion.
    pub fn motion(&self) -> Motion<'_, S> {
        self.try_motion().expect("checked by the constructor")
    }

    fn try_motion(&self) -> Result<Motion<'_, S>, InvalidInput> {
        Motion::new(PathRef::new(&self.segments)?, ProfileRef::new(&self.phases)?, self.radius, self.start)
    }
}
