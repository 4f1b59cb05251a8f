//! The path of a mission, and the motion of an agent along the rest of it.

use super::FRAME;
use super::braking::{SpeedLimitSpan, speed_before, speeds_to_rest, to_rest};
use pcr_core::{
    Curve, InvalidInput, Limits, Motion, PathRef, Phase, Point, Pose, ProfileRef, Radians, Segment, TurnSide,
};
use pcr_formats::scenario::{Agent, PathSegment};
use pcr_planning::fleet::{ConvexBody, speed};

/// Travelled length for each radian of a turn in place of an outline \[m\]: so short that ramps of the speed take no time there.
const LEVER: f64 = 1e-3;

/// The same of a disc \[m\], which stands meanwhile: so short that a robot is at all of it once it is near its beginning.
const STANDING_LEVER: f64 = 1e-7;

/// An outline has turned if less than this is left of a turn \[rad\].
const TURNED: f64 = 1e-4;

/// Time that a change of gear, or of the angle from the way to the heading, takes \[s\]: none, but for a frame in which the robot stands.
const SHIFT: f64 = 1e-9;

/// A path of lines and arcs, with speed limits.
#[derive(Clone, Debug)]
pub struct SpeedLimitedPath {
    segments: Vec<Segment<f64>>,
    limits: Vec<SegmentLimit>,
}

/// How a segment is driven.
#[derive(Clone, Copy, Debug)]
struct SegmentLimit {
    /// Speed limit; infinite if there is none \[m/s\].
    top: f64,
    /// Angles from the direction of travel to the heading at both ends \[rad\]. Only on a steady arc they differ.
    facing: [f64; 2],
    /// An arc on which the robot keeps its heading.
    steady: bool,
    /// A turn in place for which the robot stands.
    stands: bool,
}

impl SegmentLimit {
    /// That of the rest of a segment, of this length \[m\].
    fn before_end(self, segment: &Segment<f64>, left: f64) -> Self {
        match segment.curve() {
            Curve::Arc { radius, turn } if self.steady && left < segment.length() => {
                let turned = left / radius;
                let facing = self.facing[1] + if turn == TurnSide::Left { turned } else { -turned };
                Self { facing: [facing, self.facing[1]], ..self }
            }
            _ => self,
        }
    }

    /// In forward gear, without a speed limit.
    const NONE: Self = Self { top: f64::INFINITY, facing: [0.0; 2], steady: false, stands: false };
}

/// A place where a robot stands: a turn in place, or a change of facing.
#[derive(Clone, Copy, Debug)]
pub(super) struct TurnInPlace {
    /// Index of its segment: that of the turn, or the one before the change of facing.
    pub(super) segment: usize,
    /// Length along the course \[m\].
    pub(super) at: f64,
    /// \[s\]
    pub(super) duration: f64,
}

impl SpeedLimitedPath {
    /// A course along these segments from a pose; turns in place have a length.
    ///
    /// # Errors
    /// [`InvalidInput`] if a length or a coordinate is out of range.
    pub fn new(start: Pose<f64>, path: &[PathSegment]) -> Result<Self, InvalidInput> {
        Self::along(start, path, |_| f64::INFINITY, false)
    }

    /// The course of an agent with the speed limits of its segments \[m/s\], of turns in place \[rad/s\], infinite where there are no more.
    /// If it is a disc, it may stand while it turns; otherwise turns are driven.
    ///
    /// # Errors
    /// As [`SpeedLimitedPath::new`].
    pub(super) fn of_agent(agent: &Agent, tops: &[f64], stands: bool) -> Result<Self, InvalidInput> {
        let [x, y, heading] = agent.start;
        let start = Pose { position: Point::new(x, y), heading: Radians(heading) };
        Self::along(start, &agent.path, |place| tops.get(place).copied().unwrap_or(f64::INFINITY), stands)
    }

    /// A course along segments with speed limits \[m/s\], of turns in place \[rad/s\], for which the robot may stand.
    fn along(
        start: Pose<f64>,
        path: &[PathSegment],
        top: impl Fn(usize) -> f64,
        stands: bool,
    ) -> Result<Self, InvalidInput> {
        let mut facing = 0.0;
        let mut course = Self::standing(start)?;
        for (place, segment) in path.iter().enumerate() {
            let top = top(place);
            let whole = segment.turns();
            let (curve, length, top) = match *segment {
                PathSegment::Line { length } => (Curve::Line, length, top),
                PathSegment::Facing { after, .. } => {
                    facing = after;
                    continue;
                }
                PathSegment::Arc { radius, sweep, .. } => {
                    (Curve::Arc { radius, turn: side(sweep) }, segment.length(), top)
                }
                PathSegment::Turn { sweep } | PathSegment::Kink { sweep } => {
                    let lever = if stands { STANDING_LEVER } else { LEVER };
                    (Curve::Pivot { lever, turn: side(sweep) }, lever * sweep.abs(), top * lever)
                }
            };
            let stands = stands && segment.takes_turning();
            let part = match *segment {
                PathSegment::Arc { radius, sweep, steady } => PathSegment::Arc { radius, sweep: sweep / whole, steady },
                other => other,
            };
            let steady = matches!(part, PathSegment::Arc { steady: true, .. });
            for _ in 0..whole as usize {
                let ends = [facing, part.facing_after(facing)];
                course.push(curve, length / whole, SegmentLimit { top, facing: ends, steady, stands })?;
                facing = ends[1];
            }
        }
        course.path()?;
        Ok(course)
    }

    /// A course to stand in a pose.
    ///
    /// # Errors
    /// As [`SpeedLimitedPath::new`].
    pub fn standing(pose: Pose<f64>) -> Result<Self, InvalidInput> {
        Ok(Self { segments: vec![Segment::standing(pose)?], limits: vec![SegmentLimit::NONE] })
    }

    /// A course to stand at its beginning.
    pub(super) fn beginning(&self) -> Self {
        // The start of a segment is always a pose in range.
        let pose = self.path().map(|path| Pose { heading: Radians(self.heading_at(0.0)), ..path.pose_at(0.0) });
        Self { segments: pose.and_then(Segment::standing).into_iter().collect(), limits: vec![SegmentLimit::NONE] }
    }

    /// The path of a motion whose heading is its direction of travel all along.
    pub fn of(motion: &Motion<'_, f64>) -> Self {
        let segments = motion.path().segments().to_vec();
        Self { limits: vec![SegmentLimit::NONE; segments.len()], segments }
    }

    /// Sets the speed limit of each segment \[m/s\], by its index; infinite for none. For a turn in place it is its length
    /// divided by its duration.
    #[must_use]
    pub(crate) fn with_speed_limits(self, top: impl Fn(usize) -> f64) -> Self {
        let limits = self.limits.into_iter().enumerate();
        Self { limits: limits.map(|(place, limit)| SegmentLimit { top: top(place), ..limit }).collect(), ..self }
    }

    fn push(&mut self, curve: Curve<f64>, length: f64, limit: SegmentLimit) -> Result<(), InvalidInput> {
        let (Some(last), Some(before)) = (self.segments.last_mut(), self.limits.last()) else {
            return Ok(());
        };
        if length <= 0.0 {
            return Ok(());
        }
        // The body keeps its heading.
        let [before, after] = [before.facing[1], limit.facing[0]];
        if after != before {
            *last = last.turned(Radians(before - after))?;
        }
        let next = match curve {
            Curve::Line => last.then_line(length)?,
            Curve::Arc { radius, turn } if limit.steady => last.then_steady_arc(radius, turn, length)?,
            Curve::Arc { radius, turn } => last.then_arc(radius, turn, length)?,
            Curve::Pivot { lever, turn } => last.then_pivot(lever, turn, length)?,
        };
        let next = next.facing(Radians(after))?;
        if last.length() == 0.0 {
            self.segments.clear();
            self.limits.clear();
        }
        self.segments.push(next);
        self.limits.push(limit);
        Ok(())
    }

    /// The lines and arcs.
    ///
    /// # Errors
    /// [`InvalidInput`] if they do not form a path.
    pub fn path(&self) -> Result<PathRef<'_, f64>, InvalidInput> {
        PathRef::new(&self.segments)
    }

    /// \[m\]
    pub fn length(&self) -> f64 {
        self.segments.iter().map(Segment::length).sum()
    }

    /// Position at a travelled length \[m\].
    pub fn point_at(&self, length: f64) -> [f64; 2] {
        let point = self.path().map(|path| path.point_at(length)).unwrap_or_default();
        [point.x, point.y]
    }

    /// Heading of the robot at a travelled length \[rad\].
    pub(super) fn heading_at(&self, length: f64) -> f64 {
        let along = self.path().map_or(0.0, |path| path.pose_at(length).heading.0);
        // That of the segment that begins there, as of a path.
        let place = self.segments.partition_point(|segment| segment.from() <= length).saturating_sub(1);
        match self.limits.get(place).zip(self.segments.get(place)) {
            Some((limit, segment)) if limit.steady => segment.heading_at(0.0).0 + limit.facing[0],
            Some((limit, _)) => along + limit.facing[0],
            None => along,
        }
    }

    /// How near to its end \[m\] a robot has arrived, of these two: where it drives, and where it turns in place.
    pub(super) fn end_tolerance(&self, driven: f64) -> f64 {
        match self.segments.last().map(Segment::curve) {
            Some(Curve::Pivot { lever, .. }) if !self.limits.last().is_some_and(|limit| limit.stands) => TURNED * lever,
            _ => driven,
        }
    }

    /// The difference of the largest rates at which it turns to the left and to the right, for a robot with a largest speed \[m/s\], and
    /// for how much it turns at such a rate at most in a time \[s\]: how far its heading may be off a uniform turn in that time \[rad\].
    pub(super) fn uneven_turn(&self, speed: f64, time: f64) -> f64 {
        let (mut left, mut right) = (0.0_f64, 0.0_f64);
        for (segment, SegmentLimit { top, .. }) in
            self.segments.iter().zip(&self.limits).filter(|(_, limit)| !limit.steady)
        {
            let (Curve::Arc { radius: lever, turn } | Curve::Pivot { lever, turn }) = segment.curve() else { continue };
            let rate = (top.min(speed) / lever * time).min(segment.length() / lever);
            let most = if turn == TurnSide::Left { &mut left } else { &mut right };
            *most = most.max(rate);
        }
        // A function whose slope is within a range is off its chord by a quarter of the range times the length at most.
        0.25 * (left + right)
    }

    /// The rest after a travelled length \[m\].
    ///
    /// # Errors
    /// As [`SpeedLimitedPath::new`].
    pub fn from(&self, length: f64) -> Result<Self, InvalidInput> {
        let heading = Radians(self.heading_at(length));
        let mut rest = Self::standing(Pose { heading, ..self.path()?.pose_at(length) })?;
        for (segment, &limit) in self.segments.iter().zip(&self.limits) {
            let left = segment.from() + segment.length() - length;
            if left > 0.0 {
                let left = left.min(segment.length());
                rest.push(segment.curve(), left, limit.before_end(segment, left))?;
            }
        }
        Ok(rest)
    }

    /// Its stretches with equal speed limits up to a length \[m\], for a robot with a largest speed \[m/s\].
    fn stretches(&self, until: f64, speed: f64) -> Vec<SpeedLimitSpan> {
        let mut stretches: Vec<SpeedLimitSpan> = Vec::new();
        for (place, (segment, limit)) in self.segments.iter().zip(&self.limits).enumerate() {
            let (length, top) = (segment.length().min(until - segment.from()).max(0.0), limit.top.min(speed));
            if place > 0 && self.changes_facing_after(place - 1) {
                stretches.push(SpeedLimitSpan { length: 0.0, top: 0.0 });
            }
            match stretches.last_mut() {
                Some(last) if last.top == top => last.length += length,
                _ => stretches.push(SpeedLimitSpan { length, top }),
            }
        }
        stretches
    }

    /// The course after a time \[s\] of its first turn in place.
    #[must_use]
    pub(super) fn turned(mut self, time: f64) -> Self {
        let turn = self.in_place(0).filter(|turn| time > 0.0 && self.limits[turn.segment].stands);
        if let Some(TurnInPlace { segment, duration, .. }) = turn {
            // At least a frame is left.
            self.limits[segment].top *= duration / (duration - time).max(FRAME);
        }
        self
    }

    /// The largest speed at its beginning from which a robot with these limits can keep the speed limits and stop at its end
    /// \[m/s\].
    pub(super) fn most(&self, limits: Limits<f64>) -> f64 {
        speeds_to_rest(&self.stretches(self.length(), limits.speed), limits.acceleration)[0]
    }

    /// Pieces (duration \[s\], acceleration \[m/s²\]) of the fastest motion from a speed at its beginning to rest at a length
    /// \[m\]; `None` if there is none.
    pub(super) fn to_rest(&self, speed: f64, until: f64, limits: Limits<f64>) -> Option<Vec<(f64, f64)>> {
        to_rest(speed, &self.stretches(until, limits.speed), limits.acceleration)
    }

    /// Time from rest to rest if no robot is in the way \[s\].
    pub(super) fn unimpeded(&self, limits: Limits<f64>) -> f64 {
        self.to_rest(0.0, self.length(), limits).into_iter().flatten().map(|(duration, _)| duration).sum()
    }

    /// The speed in a frame from a length on \[m\] with which a robot keeps to all that follows; turns in place are left aside \[m/s\].
    pub(super) fn allowed(&self, length: f64, acceleration: f64, frame: f64) -> f64 {
        let ahead = self.segments.iter().zip(&self.limits).filter(|(segment, limit)| {
            limit.top.is_finite() && !limit.stands && segment.from() + segment.length() > length
        });
        ahead.fold(f64::INFINITY, |allowed: f64, (segment, &SegmentLimit { top, .. })| {
            let before = segment.from() - length;
            allowed.min(if before > 0.0 { speed_before(before, top, acceleration, frame) } else { top })
        })
    }

    /// The first turn in place that takes time, or change of facing, among its segments from this place on.
    pub(super) fn in_place(&self, from: usize) -> Option<TurnInPlace> {
        let segments = self.segments.iter().zip(&self.limits).enumerate().skip(from);
        segments.into_iter().find_map(|(place, (segment, SegmentLimit { top, stands, .. }))| {
            let duration = segment.length() / top;
            if *stands && duration > 0.0 {
                return Some(TurnInPlace { segment: place, at: segment.from(), duration });
            }
            let at = segment.from() + segment.length();
            self.changes_facing_after(place).then_some(TurnInPlace { segment: place, at, duration: SHIFT })
        })
    }

    /// Whether the angle to the heading changes at the end of a segment.
    fn changes_facing_after(&self, place: usize) -> bool {
        let [before, after] = [place, place + 1].map(|place| self.limits.get(place));
        before.zip(after).is_some_and(|(before, after)| before.facing[1] != after.facing[0])
    }

    /// The least radius of an arc that is driven \[m\]; infinite without any.
    pub(super) fn least_radius(&self) -> f64 {
        let radius = |segment: &Segment<f64>| match segment.curve() {
            Curve::Arc { radius, .. } => radius,
            _ => f64::INFINITY,
        };
        self.segments.iter().map(radius).fold(f64::INFINITY, f64::min)
    }
}

/// The side to which it turns by an angle.
fn side(sweep: f64) -> TurnSide {
    if sweep > 0.0 { TurnSide::Left } else { TurnSide::Right }
}

/// A course with the motion of an agent on it.
#[derive(Clone, Debug)]
pub struct OwnedMotion {
    course: SpeedLimitedPath,
    phases: Vec<Phase<f64>>,
    start: f64,
}

impl OwnedMotion {
    /// A motion that owns what it is made of, without its radius.
    pub fn of(motion: &Motion<'_, f64>) -> Self {
        let phases = motion.profile().phases().to_vec();
        Self { course: SpeedLimitedPath::of(motion), phases, start: motion.time().lo }
    }

    /// The motion from a time on \[s\]: the remaining path, at the speed reached by then. Before that time the agent counts as
    /// standing where the rest begins, so the places that it has already left are free. `None` if rounding leaves no motion.
    ///
    /// ```
    /// use pcr_core::{Motion, Path, Point, Pose, Profile, Radians};
    /// use pcr_execution::simulate::OwnedMotion;
    /// let pose = Pose { position: Point::new(-2.0, 0.0), heading: Radians(0.0) };
    /// let path = Path::<f64, 1>::starting_at(pose)?.line(4.0)?;
    /// let profile = Profile::<f64, 1>::from_pieces(1.0, [(4.0, 0.0)])?;
    /// let whole = OwnedMotion::of(&Motion::new(path.as_path(), profile.as_profile(), 0.25, 10.0)?);
    /// let rest = whole.rest(11.5).unwrap();
    /// let motion = rest.motion(0.25).unwrap();
    /// assert!((motion.position_at(12.0).x - 0.0).abs() < 1e-12 && (motion.position_at(0.0).x + 0.5).abs() < 1e-12);
    /// # Ok::<(), pcr_core::InvalidInput>(())
    /// ```
    pub fn rest(&self, time: f64) -> Option<Self> {
        let motion = self.motion(1.0)?;
        let passed = time - self.start;
        let course = self.course.from(motion.length_at(time)).ok()?;
        if passed <= 0.0 {
            return Some(self.clone());
        }
        let left = self.phases.iter().filter(|phase| phase.time().hi > passed);
        let pieces = left.map(|phase| (phase.time().hi - phase.time().lo.max(passed), phase.acceleration()));
        let pieces: Vec<(f64, f64)> = pieces.collect();
        match course.length() > 0.0 {
            true => Self::new(course, motion.speed_at(time), &pieces, time),
            false => Self::standing(course, time),
        }
    }

    /// From a speed \[m/s\] with these pieces (duration \[s\], acceleration \[m/s²\]); `None` where they do not travel the
    /// length of the course.
    pub(super) fn new(course: SpeedLimitedPath, speed: f64, pieces: &[(f64, f64)], start: f64) -> Option<Self> {
        let phases = speed::phases(speed, pieces, course.length()).ok()?;
        let drive = Self { course, phases, start };
        drive.motion(1.0).is_some().then_some(drive)
    }

    pub(super) fn standing(course: SpeedLimitedPath, start: f64) -> Option<Self> {
        let drive = Self { course, phases: Vec::new(), start };
        drive.motion(1.0).is_some().then_some(drive)
    }

    /// At 1 m/s from time 0 on: times are lengths.
    pub(super) fn at_unit_speed(course: SpeedLimitedPath) -> Option<Self> {
        let length = course.length();
        let start = 0.0;
        if length > 0.0 { Self::new(course, 1.0, &[(length, 0.0)], start) } else { Self::standing(course, start) }
    }

    /// As the motion of a body.
    pub fn motion_of<'m>(&'m self, body: &'m ConvexBody) -> Option<Motion<'m, f64>> {
        body.motion(self.course.path().ok()?, ProfileRef::new(&self.phases).ok()?, self.start).ok()
    }

    /// As the motion of a disc of this radius \[m\].
    pub fn motion(&self, radius: f64) -> Option<Motion<'_, f64>> {
        Motion::new(self.course.path().ok()?, ProfileRef::new(&self.phases).ok()?, radius, self.start).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_core::{Point, Radians};
    use pcr_formats::scenario::REVERSE;

    #[test]
    fn the_rest_of_a_drive_goes_on_as_it_does() {
        let pose = Pose { position: Point::new(1.0, 2.0), heading: Radians(0.3) };
        let arc = PathSegment::arc(0.5, -1.0);
        let course = SpeedLimitedPath::new(pose, &[PathSegment::Line { length: 1.0 }, arc]).expect("a course");
        // To 0.5 m/s, on, to rest, a wait, and again.
        let pieces = [(1.0, 0.5), (0.5, 0.0), (1.0, -0.5), (2.0, 0.0), (1.0, 0.5), (0.5, 0.0), (1.0, -0.5)];
        let drive = OwnedMotion::new(course, 0.0, &pieces, 3.0).expect("a drive");
        let whole = drive.motion(0.2).expect("a motion");
        for time in [0.0, 3.0, 3.4, 4.2, 5.0, 6.0, 7.7, 8.6, 9.9, 10.0, 12.0] {
            let rest = drive.rest(time).expect("its rest");
            let rest = rest.motion(0.2).expect("a motion");
            for later in [0.0, 0.1, 0.9, 2.5, 4.0, 20.0] {
                let (a, b) = (whole.position_at(time + later), rest.position_at(time + later));
                assert!((a.x - b.x).hypot(a.y - b.y) < 1e-9, "{time} + {later}: {a:?} {b:?}");
                assert!((whole.speed_at(time + later) - rest.speed_at(time + later)).abs() < 1e-9, "{time} + {later}");
            }
            let stood = rest.position_at(-5.0);
            let now = whole.position_at(time);
            assert!((stood.x - now.x).hypot(stood.y - now.y) < 1e-9);
        }
    }

    #[test]
    fn the_rest_of_a_course_is_where_the_course_is() {
        let pose = Pose { position: Point::new(1.0, 2.0), heading: Radians(0.3) };
        let arc = PathSegment::arc(0.5, -1.0);
        let course = SpeedLimitedPath::new(pose, &[PathSegment::Line { length: 1.0 }, arc, arc]).expect("a course");
        let facings = |before: f64, after: f64| {
            let [change, back] =
                [[before, after], [after, before]].map(|[before, after]| PathSegment::Facing { before, after });
            [change, arc, PathSegment::Line { length: 0.5 }, back, change, arc]
        };
        let there_and_back = [facings(0.0, REVERSE), facings(REVERSE, 0.0)].concat();
        let shunting = SpeedLimitedPath::new(pose, &there_and_back).expect("a course");
        for from in [0.0, 0.4, 0.5, 1.2, 1.9, 2.0, 2.7, 3.0] {
            let rest = shunting.from(from).expect("its rest");
            assert_eq!(
                rest.stretches(3.0, 1.0).len(),
                shunting.stretches(3.0, 1.0).len() - usize::from(from >= 1.5) * 2
            );
            for further in [0.0, 0.05, 0.3] {
                let ([x, y], [u, v]) = (rest.point_at(further), shunting.point_at(from + further));
                assert!((x - u).hypot(y - v) < 1e-12, "{from} {further}");
                let off = rest.heading_at(further) - shunting.heading_at(from + further);
                assert!(off.abs() < 1e-12, "{from} {further}: {off}");
            }
        }
        for from in [0.0, 0.4, 1.0, 1.2, 1.5, 1.9, 2.0] {
            let rest = course.from(from).expect("its rest");
            assert!((rest.length() - (course.length() - from)).abs() < 1e-12);
            for further in [0.0, 0.05, 0.3] {
                let ([x, y], [u, v]) = (rest.point_at(further), course.point_at(from + further));
                assert!((x - u).hypot(y - v) < 1e-12, "{from} {further}");
            }
        }
    }
}
