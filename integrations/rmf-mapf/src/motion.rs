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
}

impl OwnedMotion {
    /// That of a trajectory; errors name this agent.
    ///
    /// # Errors
    /// [`Error::Empty`], [`Error::NoFootprint`], [`Error::Time`], [`Error::TurnsOnTheWay`], [`Error::HalfTurn`], [`Error::Invalid`].
    pub fn new(agent: usize, trajectory: &Trajectory) -> Result<Self, Error> {
        let invalid = |problem| Error::Invalid { agent, problem };
        let &first = trajectory.poses.first().ok_or(Error::Empty { agent })?;
        let footprint = trajectory.footprint.as_ref().ok_or(Error::NoFootprint { agent })?;
        let (outline, reach) = match footprint {
            Footprint::Disc { .. } => (None, None),
            Footprint::Polygon { corners } => {
                let reach = corners.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
                let corners = corners.iter().map(|&[x, y]| Vector { x, y });
                // By its place and by its heading.
                let rounding = ROUNDING * (1.0 + reach) + trajectory.margin;
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
            match step(path.end(), path.heading, to, reach.is_some()) {
                None => return Err(Error::TurnsOnTheWay { agent, waypoint: k + 1 }),
                Some(Step::Waits) => {}
                Some(Step::Moves { length, direction }) => path.line(length, direction).map_err(invalid)?,
                Some(Step::Turns { by }) => path.pivot(reach.unwrap_or(1.0).max(0.1), by).map_err(invalid)?,
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

/// What an agent does from the end of its path, where it has this heading, to the next waypoint. `None` if an outline moves and turns.
fn step(end: Point<f64>, heading: f64, to: TimedPose, is_outline: bool) -> Option<Step> {
    let [x, y] = [to.position[0] - end.x, to.position[1] - end.y];
    let (length, direction) = (x.hypot(y), y.atan2(x));
    let by = if is_outline { wrapped(to.yaw - heading) } else { 0.0 };
    match (length > ROUNDING, by.abs() > ROUNDING) {
        (true, true) => None,
        (true, false) => Some(Step::Moves { length, direction }),
        (false, true) => Some(Step::Turns { by }),
        (false, false) => Some(Step::Waits),
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

    /// Turns the body by an angle, less than half a turn.
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
