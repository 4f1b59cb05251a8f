//! The path and the speed profile of a trajectory, in the terms of `pcr-core`.
//!
//! The speed of a trajectory jumps at its waypoints. A profile of constant accelerations changes it within a nanosecond, before the slower
//! of two steps and after it, so that every waypoint is reached in time; in between an agent is off by nanometres.

use crate::Error;
use crate::trajectory::{Footprint, ROUNDING, TimedPose, Trajectory, is_half_turn, wrapped};
use pcr_core::{
    InvalidInput, Motion, Outline, PathRef, Phase, Point, Pose, ProfileRef, Radians, Segment, TurnSide, Vector,
};

/// Time in which a speed changes \[s\].
const RAMP: f64 = 1e-9;

/// A path, a profile and a footprint, which a motion borrows.
#[derive(Clone, Debug)]
pub struct OwnedMotion {
    segments: Vec<Segment<f64>>,
    phases: Vec<Phase<f64>>,
    outline: Option<Outline<f64, 16>>,
    radius: f64,
    start: f64,
    /// Length of the path at each waypoint \[m\].
    pub(crate) lengths: Vec<f64>,
}

/// What an agent does on the way to a waypoint.
enum Step {
    Waits,
    /// It moves by this length \[m\] in this direction \[rad\].
    Moves {
        length: f64,
        direction: f64,
    },
    /// It turns by this angle \[rad\].
    Turns {
        by: f64,
    },
    /// It does both.
    Bends {
        length: f64,
        direction: f64,
        by: f64,
    },
}

impl OwnedMotion {
    /// That of a trajectory; errors name this agent.
    ///
    /// # Errors
    /// [`Error::Empty`], [`Error::NoFootprint`], [`Error::Time`], [`Error::TurnsOnTheWay`], [`Error::HalfTurn`], [`Error::Invalid`].
    pub fn new(agent: usize, trajectory: &Trajectory) -> Result<Self, Error> {
        let invalid = |problem| Error::Invalid { agent, problem };
        for (name, value) in [("margin", trajectory.margin), ("deviation", trajectory.deviation)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(invalid(InvalidInput::OutOfRange(name)));
            }
        }
        let &first = trajectory.poses.first().ok_or(Error::Empty { agent })?;
        let footprint = trajectory.footprint.as_ref().ok_or(Error::NoFootprint { agent })?;
        let (outline, reach) = match footprint {
            Footprint::Disc { .. } => (None, None),
            Footprint::Polygon { corners } => {
                let reach = corners.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
                let corners = corners.iter().map(|&[x, y]| Vector { x, y });
                // By its place and by its heading. What it may deviate: by a place that is not gone to, a heading that is not turned to, and an arc.
                let rounding = ROUNDING * (1.0 + reach) + 3.0 * trajectory.deviation + trajectory.margin;
                (Some(Outline::polygon(corners, rounding).map_err(invalid)?), Some(reach))
            }
        };
        let pose = |at: TimedPose, heading| Pose {
            position: Point::new(at.position[0], at.position[1]),
            heading: Radians(heading),
        };
        // The first line decides the direction; until then the agent faces forward.
        let mut path = PathBuilder::new(pose(first, first.yaw), first.yaw, reach.is_some()).map_err(invalid)?;
        let (mut lengths, mut sections) = (vec![0.0], Vec::new());
        for (k, pair) in trajectory.poses.windows(2).enumerate() {
            let (from, to) = (pair[0], pair[1]);
            let duration = to.time - from.time;
            if duration.is_nan() || duration <= 0.0 {
                return Err(Error::Time { agent, waypoint: k + 1 });
            }
            if reach.is_some() && is_half_turn(from, to) {
                return Err(Error::HalfTurn { agent, waypoint: k + 1 });
            }
            match step(&path, from, to, reach.map(|reach| Least::new(trajectory.deviation, reach))) {
                Step::Waits => {}
                Step::Moves { length, direction } => path.line(length, direction).map_err(invalid)?,
                Step::Turns { by } => path.pivot(reach.unwrap_or(1.0).max(0.1), by).map_err(invalid)?,
                Step::Bends { .. } if trajectory.deviation <= 0.0 => {
                    return Err(Error::TurnsOnTheWay { agent, waypoint: k + 1 });
                }
                Step::Bends { length, direction, by } => {
                    path.arcs(length, direction, by, trajectory.deviation).map_err(invalid)?;
                }
            }
            let length = path.length();
            sections.push((length - lengths.last().copied().unwrap_or_default(), duration));
            lengths.push(length);
        }
        let radius = match footprint {
            Footprint::Disc { radius } => *radius + trajectory.margin,
            Footprint::Polygon { .. } => 0.0,
        };
        let phases = phases(&sections).map_err(invalid)?;
        Ok(Self { segments: path.segments, phases, outline, radius, start: first.time, lengths })
    }

    /// Length of the path at each waypoint \[m\]. A turn of an outline has a length as well: the angle times the distance of its farthest corner,
    /// or times 0.1 m if that is less.
    pub fn lengths(&self) -> &[f64] {
        &self.lengths
    }

    /// The motion, for the queries of `pcr-core`. Its times are those of the waypoints.
    ///
    /// # Errors
    /// A number out of range.
    pub fn motion(&self) -> Result<Motion<'_, f64>, InvalidInput> {
        let (path, profile) = (PathRef::new(&self.segments)?, ProfileRef::new(&self.phases)?);
        match &self.outline {
            None => Motion::new(path, profile, self.radius, self.start),
            Some(outline) => Motion::with_outline(path, profile, outline, self.start),
        }
    }
}

/// The smallest length \[m\] and turn \[rad\] that are not left out.
#[derive(Clone, Copy)]
struct Least {
    length: f64,
    turn: f64,
}

impl Least {
    /// What moves no point of an outline by more than a deviation \[m\].
    fn new(deviation: f64, reach: f64) -> Self {
        Self { length: ROUNDING.max(deviation), turn: ROUNDING.max(deviation / reach.max(0.1)) }
    }
}

/// What an agent does from the end of its path, which is at `from` but for what was left out, to the next waypoint. A disc does not turn. Of an
/// outline that moves or turns by more than rounding, the other one is left out if it is less than `outline` says.
fn step(path: &PathBuilder, from: TimedPose, to: TimedPose, outline: Option<Least>) -> Step {
    let end = path.end();
    let [x, y] = [to.position[0] - end.x, to.position[1] - end.y];
    let (length, direction) = (x.hypot(y), y.atan2(x));
    // To the side to which it turns between the waypoints, whatever it has to make good.
    let by = outline.map_or(0.0, |_| wrapped(to.yaw - from.yaw) + wrapped(from.yaw - path.heading));
    let (moves, turns) = (length > ROUNDING, by.abs() > ROUNDING);
    let is_less = |least: Least| (length <= least.length, by.abs() <= least.turn);
    match (moves, turns, outline.map(is_less)) {
        (false, false, _) => Step::Waits,
        (true, false, _) => Step::Moves { length, direction },
        (false, true, _) => Step::Turns { by },
        (true, true, Some((_, true))) => Step::Moves { length, direction },
        (true, true, Some((true, _))) => Step::Turns { by },
        (true, true, _) => Step::Bends { length, direction, by },
    }
}

/// A path that grows. Lines go in any direction, whatever the heading.
struct PathBuilder {
    segments: Vec<Segment<f64>>,
    last: Segment<f64>,
    /// Heading of the body, and direction of the path \[rad\].
    heading: f64,
    direction: f64,
    is_outline: bool,
}

impl PathBuilder {
    fn new(pose: Pose<f64>, heading: f64, is_outline: bool) -> Result<Self, InvalidInput> {
        let last = Segment::standing(pose)?;
        Ok(Self { segments: vec![last], last, heading, direction: heading, is_outline })
    }

    fn end(&self) -> Point<f64> {
        self.last.point_at(self.last.length())
    }

    fn length(&self) -> f64 {
        self.last.from() + self.last.length()
    }

    /// Adds a segment after a turn of the direction.
    fn push(
        &mut self,
        direction: f64,
        next: impl Fn(&Segment<f64>) -> Result<Segment<f64>, InvalidInput>,
    ) -> Result<(), InvalidInput> {
        let turned = self.last.turned(Radians(wrapped(direction - self.direction)))?;
        if let Some(last) = self.segments.last_mut() {
            *last = turned;
        }
        let mut next = next(&turned)?;
        if self.is_outline {
            next = next.facing(Radians(wrapped(self.heading - direction)))?;
        }
        (self.last, self.direction) = (next, direction);
        self.segments.push(next);
        Ok(())
    }

    fn line(&mut self, length: f64, direction: f64) -> Result<(), InvalidInput> {
        self.push(direction, |last| last.then_line(length))
    }

    /// Moves by a chord while the body turns at a constant rate: arcs, of which no point is further than `deviation` \[m\] from the chord at the same
    /// share of the time.
    fn arcs(&mut self, chord: f64, direction: f64, by: f64, deviation: f64) -> Result<(), InvalidInput> {
        // An arc is off by half the chord times the tangent of a quarter of its angle across, and along it, for an angle of 1 rad at most, by less than
        // a tenth of that.
        let off = |parts: f64| 1.1 * chord / parts / 2.0 * (by.abs() / parts / 4.0).tan();
        let mut parts = (chord * by.abs() / 8.0 / deviation).sqrt().max(by.abs()).ceil().max(1.0);
        while off(parts) > deviation {
            parts += 1.0;
        }
        let (angle, chord) = (by / parts, chord / parts);
        let radius = chord / 2.0 / (angle.abs() / 2.0).sin();
        let turn = if angle > 0.0 { TurnSide::Left } else { TurnSide::Right };
        for _ in 0..parts as u32 {
            self.push(direction - angle / 2.0, |last| last.then_arc(radius, turn, radius * angle.abs()))?;
            self.direction += angle;
            self.heading += angle;
        }
        Ok(())
    }

    /// Turns the body by an angle, about half a turn at most.
    fn pivot(&mut self, lever: f64, by: f64) -> Result<(), InvalidInput> {
        let turn = if by > 0.0 { TurnSide::Left } else { TurnSide::Right };
        self.push(self.direction, |last| last.then_pivot(lever, turn, lever * by.abs()))?;
        self.direction += by;
        self.heading += by;
        Ok(())
    }
}

/// The phases of sections of given lengths \[m\] and durations \[s\], each at a constant speed.
fn phases(sections: &[(f64, f64)]) -> Result<Vec<Phase<f64>>, InvalidInput> {
    let speed = |k: Option<usize>| k.and_then(|k| sections.get(k)).map_or(0.0, |(length, duration)| length / duration);
    let mut phases: Vec<Phase<f64>> = Vec::new();
    let mut push = |duration: f64, speed: f64| {
        let last = match phases.last() {
            None => Phase::starting_at(0.0, 0.0, 0.0)?,
            Some(last) => *last,
        };
        last.then_to(duration, speed).map(|phase| phases.push(phase))
    };
    for (k, &(length, duration)) in sections.iter().enumerate() {
        let own = length / duration;
        let [before, after] = [own.min(speed(k.checked_sub(1))), own.min(speed(Some(k + 1)))];
        let ramp = RAMP.min(duration / 4.0);
        // (before + peak) ramp / 2 + peak (duration - 2 ramp) + (peak + after) ramp / 2 is the length.
        let peak = (length - (before + after) * ramp / 2.0) / (duration - ramp);
        push(ramp, peak)?;
        push(duration - 2.0 * ramp, peak)?;
        push(ramp, after)?;
    }
    Ok(phases)
}
