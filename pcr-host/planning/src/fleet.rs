//! Converts scenarios to motions and tables, in any number format of the tool.

mod fixed;
mod format_range_error;
mod hull;
#[cfg(feature = "micromath")]
mod micro_format;
mod outline;
pub(crate) mod rounding;
pub mod speed;
#[cfg(test)]
mod tests;
mod turns;

use crate::memory_budget;
use format_range_error::{FieldFault, derived};
pub use format_range_error::{FormatRangeError, RangeProblem};
pub use hull::{ConvexBody, HullOutline};
use pcr_certify::raw::RawAngle;
use pcr_core::{
    CapacityError, Curve, Ecm, EcmEntry, EcmError, Interval, InvalidInput, Limits, Motion, Outline, PathRef, Phase,
    Piece, Point, Pose, PrecedenceTable, Profile, ProfileRef, Radians, RegionPrecedence, Scalar, Segment, TurnSide,
};
use pcr_formats::scenario::{Agent, MotionSpec, PathSegment, Scenario};
use std::f64::consts::{PI, TAU};

/// A table on the heap.
pub type HostEcm<S> = Ecm<S, Vec<EcmEntry>, Vec<Piece<S>>>;

/// A table of passing orders on the heap.
pub type HostPrecedenceTable = PrecedenceTable<f64, Vec<EcmEntry>, Vec<Piece<f64>>, Vec<RegionPrecedence<f64>>>;

/// Largest magnitude of a heading at the start of a path, or of a turn in place, in a scenario \[rad\]: 2²⁴, the limit of the core
/// in `f64`. It is the same in every format. Up to this limit, the error of subtracting whole turns in `f64` is below the last
/// digit of an angle in all smaller formats.
pub(crate) const ANGLE_LIMIT: f64 = 16_777_216.0;

/// The angle, if it is in the range that every format has.
fn in_angles(radians: f64) -> Option<f64> {
    (radians.abs() <= ANGLE_LIMIT).then_some(radians)
}

/// A number format that scenario files can be read into.
pub trait HostScalar: Scalar<Angle: Send + Sync, Unit: Send + Sync> + Send + Sync {
    /// Name on the command line and in the output.
    const NAME: &'static str;
    /// The nearest number of the format.
    fn from_f64(value: f64) -> Self;
    /// The exact value.
    fn to_f64(self) -> f64;
    /// The nearest angle of the format; `None` above 2^24 rad, and for NaN.
    fn angle(radians: f64) -> Option<Self::Angle>;
    /// The exact angle \[rad\].
    fn radians(angle: Self::Angle) -> f64;
    /// The angle as the format holds it.
    fn held_angle(angle: Self::Angle) -> RawAngle {
        RawAngle::Radians(Self::radians(angle))
    }
    /// Largest magnitude of a heading, accumulated along a path, that the core takes \[rad\]; infinite where whole turns do
    /// not count.
    const HEADING_LIMIT: f64;
    /// Twice the unit roundoff of sums; 0 if the format adds exactly.
    const EPSILON: f64;
    /// The last digit of a fixed-point format, of which all numbers are multiples; 0 in floating point.
    const STEP: f64 = 0.0;
}

impl HostScalar for f64 {
    const NAME: &'static str = "f64";
    const HEADING_LIMIT: f64 = ANGLE_LIMIT;
    const EPSILON: f64 = f64::EPSILON;
    fn from_f64(value: f64) -> Self {
        value
    }
    fn to_f64(self) -> f64 {
        self
    }
    fn angle(radians: f64) -> Option<Radians<f64>> {
        in_angles(radians).map(Radians)
    }
    fn radians(angle: Radians<f64>) -> f64 {
        angle.0
    }
}

impl HostScalar for f32 {
    const NAME: &'static str = "f32";
    const HEADING_LIMIT: f64 = 1_024.0;
    const EPSILON: f64 = f32::EPSILON as f64;
    fn from_f64(value: f64) -> Self {
        value as f32
    }
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    /// Whole turns are subtracted first: they would cost digits of the rest.
    fn angle(radians: f64) -> Option<Radians<f32>> {
        let radians = in_angles(radians)?;
        Some(Radians((if radians.abs() > PI { radians - TAU * (radians / TAU).round() } else { radians }) as f32))
    }
    fn radians(angle: Radians<f32>) -> f64 {
        f64::from(angle.0)
    }
}

/// A field as a number of the format; an overflow, or a value that becomes 0, is refused.
fn number<S: HostScalar>(field: &'static str, value: f64) -> Result<S, RangeProblem> {
    let number = S::from_f64(value);
    // Not compared by magnitude, because the least number of a fixed-point format has none.
    if !number.is_finite() || !(-S::LIMIT..=S::LIMIT).contains(&number) {
        Err(RangeProblem::TooLarge { field, value, limit: S::LIMIT.to_f64() })
    } else if number == S::ZERO && value != 0.0 {
        Err(RangeProblem::BecomesZero { field, value })
    } else {
        Ok(number)
    }
}

/// A field as an angle of the format.
fn angle<S: HostScalar>(field: &'static str, radians: f64) -> Result<S::Angle, RangeProblem> {
    S::angle(radians).ok_or(RangeProblem::Angle { field, radians, limit: ANGLE_LIMIT })
}

/// A warning if rounding to the format moves some agents by more than 1 mm at some time. `None` for `f64`, the format of the
/// scenario.
///
/// # Errors
/// [`FormatRangeError`] if a value does not fit the number format.
pub fn rounded<S: HostScalar>(scenario: &Scenario) -> Result<Option<String>, FormatRangeError> {
    rounding::warning::<S>(scenario)
}

/// The paths and profiles of a scenario in one number format.
#[derive(Clone, Debug)]
pub struct Fleet<S: Scalar> {
    agents: Vec<MotionParts<S>>,
}

/// The data that the motion of one agent borrows.
#[derive(Clone, Debug)]
struct MotionParts<S: Scalar> {
    segments: Vec<Segment<S>>,
    /// Index of each segment in the scenario: segments of length 0 are left out, and arcs of more than one turn are split.
    sources: Vec<usize>,
    heading: S::Angle,
    turns: Vec<PathTurn<S>>,
    phases: Vec<Phase<S>>,
    shape: Shape<S>,
    margin: S,
    start: S,
    /// Lengths of turns in place that have one, in the order of the path.
    turned: Vec<Interval<S>>,
}

/// What moves along a path. Outlines are large, and most fleets have none.
#[derive(Clone, Debug)]
enum Shape<S: Scalar> {
    /// A disc of this radius.
    Disc(S),
    Outline(Box<Outline<S, { outline::CORNERS }>>),
}

impl<S: HostScalar> Fleet<S> {
    /// All agents of a scenario, each as the disc about its reference point that contains it.
    ///
    /// # Errors
    /// [`FormatRangeError`] if a value does not fit the number format.
    pub fn new(scenario: &Scenario) -> Result<Self, FormatRangeError> {
        let agents = scenario.agents.iter().map(|agent| {
            let disc = number("radius", agent.circumscribed_radius()).map_err(FieldFault::from);
            disc.and_then(|disc| MotionParts::new(agent, Shape::Disc(disc)))
                .map_err(|fault| fault.of::<S>(agent.display_name()))
        });
        Ok(Self { agents: agents.collect::<Result<_, _>>()? })
    }

    /// All agents of a scenario, each as one body: a disc, a convex outline, or the convex hull of a concave one, or of all outlines of an
    /// agent with loads.
    ///
    /// # Errors
    /// As [`Fleet::new`].
    pub fn of_bodies(scenario: &Scenario) -> Result<Self, FormatRangeError> {
        let mut fleet = Self { agents: Vec::with_capacity(scenario.agents.len()) };
        for agent in &scenario.agents {
            let hull = ConvexBody::hull_of(agent)
                .map_err(|problem| FieldFault::from(problem).of::<S>(agent.display_name()))?;
            fleet.append(match hull {
                Some(hull) => Self::body(&Agent { footprint: Some(hull), loads: Vec::new(), ..agent.clone() })?,
                // Of a disc a turn in place sweeps nothing.
                None if agent.footprint.is_none() => Self::new(&Scenario::new("", vec![agent.clone()]))?,
                None => Self::body(agent)?,
            });
        }
        Ok(fleet)
    }

    /// One agent without loads whose footprint, if it has one, is convex.
    ///
    /// # Errors
    /// As [`Fleet::new`].
    pub(crate) fn body(agent: &Agent) -> Result<Self, FormatRangeError> {
        let parts = MotionParts::of_body(agent).map_err(|fault| fault.of::<S>(agent.display_name()))?;
        Ok(Self { agents: vec![parts] })
    }

    /// The motions, in the order of the scenario.
    pub fn motions(&self) -> Vec<Motion<'_, S>> {
        self.agents.iter().map(|parts| parts.motion().expect("built before by `Parts::new`")).collect()
    }

    /// The motion of one agent.
    pub(crate) fn motion(&self, agent: usize) -> Option<Motion<'_, S>> {
        self.agents.get(agent)?.motion().ok()
    }

    /// Appends the agents of another fleet.
    pub(crate) fn append(&mut self, other: Self) {
        self.agents.extend(other.agents);
    }

    /// Heading at the start of an agent's path, and the turns of its direction of travel.
    pub(crate) fn headings(&self, agent: usize) -> (S::Angle, &[PathTurn<S>]) {
        let parts = &self.agents[agent];
        (parts.heading, &parts.turns)
    }

    /// Lengths on the path of an agent's motion during which it turns in place.
    pub(crate) fn turned(&self, agent: usize) -> &[Interval<S>] {
        self.agents.get(agent).map_or(&[], |parts| &parts.turned)
    }

    /// Index in the scenario of a segment of an agent's motion; `None` for the point of an agent that stands.
    pub fn source(&self, agent: usize, segment: usize) -> Option<usize> {
        self.agents.get(agent)?.sources.get(segment).copied()
    }
}

/// A turn of the direction of travel that has no length.
#[derive(Clone, Copy, Debug)]
pub struct PathTurn<S: Scalar> {
    /// Index of the segment that follows.
    pub(crate) before: usize,
    /// By how much, left positive.
    pub(crate) by: S::Angle,
    /// The angle from the direction of travel to the heading of the body after it, if the body keeps its heading; otherwise it turns as well.
    pub(crate) facing: Option<S::Angle>,
}

impl<S: HostScalar> MotionParts<S> {
    /// It waits while it turns in place.
    fn new(agent: &Agent, shape: Shape<S>) -> Result<Self, FieldFault> {
        Self::along(agent, place_path(agent, None)?, &agent.motion, shape)
    }

    /// A disc or a convex outline whose turns in place have a length.
    fn of_body(agent: &Agent) -> Result<Self, FieldFault> {
        let turning = turns::turning::<S>(agent);
        let (levers, motion, off) = match &turning {
            None => (None, &agent.motion, 0.0),
            Some(turning) => (Some(&turning.levers[..]), &turning.motion, turning.off),
        };
        let shape = match &agent.footprint {
            None => Shape::Disc(number("radius", agent.circumscribed_radius() + off)?),
            Some(footprint) => Shape::Outline(Box::new(outline::of(&footprint.inflated(off))?)),
        };
        Self::along(agent, place_path(agent, levers)?, motion, shape)
    }

    fn along(agent: &Agent, path: PlacedPath<S>, motion: &MotionSpec, shape: Shape<S>) -> Result<Self, FieldFault> {
        let PlacedPath { segments, sources, turns } = path;
        let path = PathRef::new(&segments).map_err(derived::<S>)?;
        let phases = phases(agent, motion, path.length())?;
        let turned = segments.iter().filter_map(|segment| match segment.curve() {
            Curve::Pivot { .. } => Some(Interval::new(segment.from(), segment.from() + segment.length())),
            _ => None,
        });
        let turned = turned.collect();
        let start = number("t_start", agent.t_start)?;
        let margin = number("margin", agent.margin)?;
        let heading = angle::<S>("start.heading", agent.start[2])?;
        let parts = Self { segments, sources, heading, turns, phases, shape, margin, start, turned };
        match parts.motion() {
            Ok(_) => Ok(parts),
            Err(reason) => Err(derived::<S>(reason).into()),
        }
    }

    fn motion(&self) -> Result<Motion<'_, S>, InvalidInput> {
        let (path, profile) = (PathRef::new(&self.segments)?, ProfileRef::new(&self.phases)?);
        let motion = match &self.shape {
            Shape::Disc(radius) => Motion::new(path, profile, *radius, self.start),
            Shape::Outline(outline) => Motion::with_outline(path, profile, outline.as_ref(), self.start),
        };
        motion?.with_margin(self.margin)
    }
}

/// The placed segments of a path, the index of each in the scenario, and turns of the direction of travel.
struct PlacedPath<S: Scalar> {
    segments: Vec<Segment<S>>,
    sources: Vec<usize>,
    turns: Vec<PathTurn<S>>,
}

/// The path of an agent. With `levers` \[m\], turns in place have a length where theirs is not 0.
fn place_path<S: HostScalar>(agent: &Agent, levers: Option<&[f64]>) -> Result<PlacedPath<S>, FieldFault> {
    let [x, y, heading] = agent.start;
    let position = Point::new(number("start.x", x)?, number("start.y", y)?);
    let pose = Pose { position, heading: angle::<S>("start.heading", heading)? };
    let mut origin = Segment::standing(pose).map_err(derived::<S>)?;
    // Fleets are large, and paths are short: a list that grows would have room for four.
    let count = agent.path.len();
    let mut segments: Vec<Segment<S>> = Vec::with_capacity(count.max(1));
    let (mut sources, mut turns) = (Vec::with_capacity(count), Vec::new());
    // Angle from the direction of travel to the heading of the body, from its first change on, and how many there were.
    let (mut facing, mut changes) = (None, 0);
    // That angle \[rad\] behind a steady arc, on which it changes: by what the arc turns in the format.
    let mut held = None;
    for (source, segment) in agent.path.iter().enumerate() {
        if let PathSegment::Facing { before, after } = *segment {
            // By what the angles differ in the format, so that the body keeps its heading.
            let [was, is] = [angle::<S>("facing", held.take().unwrap_or(before))?, angle::<S>("facing", after)?];
            let by = angle::<S>("facing", S::radians(was) - S::radians(is))?;
            let last = segments.last_mut().unwrap_or(&mut origin);
            *last = last.turned(by).map_err(derived::<S>)?;
            turns.push(PathTurn { before: segments.len(), by, facing: Some(is) });
            (facing, changes) = (Some(is), changes + 1);
            continue;
        }
        let turn = match *segment {
            PathSegment::Turn { sweep } | PathSegment::Kink { sweep } => Some(sweep),
            _ => None,
        };
        if turn.map_or_else(|| segment.length(), f64::abs) <= 0.0 {
            continue;
        }
        // In the file.
        let source = source - changes;
        let at = |problem| FieldFault { part: Some(("segment", source)), problem };
        let lever = levers.and_then(|levers| levers.get(source + changes).copied()).filter(|lever| *lever > 0.0);
        if let Some(sweep) = turn.filter(|_| lever.is_none()) {
            let by = angle::<S>("sweep", sweep).map_err(at)?;
            let last = segments.last_mut().unwrap_or(&mut origin);
            *last = last.turned(by).map_err(|reason| at(derived::<S>(reason)))?;
            turns.push(PathTurn { before: segments.len(), by, facing: None });
            continue;
        }
        let whole = segment.turns();
        let side = if segment.sweep() > 0.0 { TurnSide::Left } else { TurnSide::Right };
        let radius = |radius| number::<S>("radius", radius).map_err(at);
        let (curve, length) = match (*segment, lever) {
            (PathSegment::Arc { radius: given, .. }, _) => {
                (Curve::Arc { radius: radius(given)?, turn: side }, segment.length())
            }
            (shape, Some(lever)) => (Curve::Pivot { lever: radius(lever)?, turn: side }, lever * shape.sweep().abs()),
            (_, None) => (Curve::Line, segment.length()),
        };
        let length = number::<S>("length", length / whole).map_err(at)?;
        let steady = matches!(segment, PathSegment::Arc { steady: true, .. });
        if let (true, Curve::Arc { radius, .. }) = (steady, curve) {
            let turned = (whole * length.to_f64() / radius.to_f64()).copysign(segment.sweep());
            let before = held.or_else(|| facing.map(S::radians)).unwrap_or(0.0);
            held = Some(PathSegment::Arc { radius: 1.0, sweep: turned, steady }.facing_after(before));
        }
        for _ in 0..whole as usize {
            let last = segments.last().unwrap_or(&origin);
            let next = match curve {
                Curve::Line => last.then_line(length),
                Curve::Pivot { lever, turn } => last.then_pivot(lever, turn, length),
                Curve::Arc { radius, turn } if steady => last.then_steady_arc(radius, turn, length),
                Curve::Arc { radius, turn } => last.then_arc(radius, turn, length),
            };
            // Behind a steady arc the body goes on as it is.
            let stated = if steady { facing.take() } else { facing };
            let next = next.and_then(|next| match stated {
                Some(facing) => next.facing(facing),
                None => Ok(next),
            });
            let next = next.map_err(|reason| at(RangeProblem::AtItsEnd(Box::new(derived::<S>(reason)))))?;
            if next.length() > S::ZERO {
                segments.push(next);
                sources.push(source);
            }
        }
    }
    if segments.is_empty() {
        segments.push(origin);
    }
    Ok(PlacedPath { segments, sources, turns })
}

/// How much larger an outline is made for turns in place that are passed without a stop \[m\].
pub(crate) fn growth_of_turns<S: HostScalar>(agent: &Agent) -> f64 {
    turns::turning::<S>(agent).map_or(0.0, |turning| turning.off)
}

/// For each turn in place of a body's motion that has a length, whether the agent comes to rest for it: not so for a kink.
pub(crate) fn stops_of_pivots<S: HostScalar>(agent: &Agent) -> Vec<bool> {
    let levers = turns::turning::<S>(agent).map_or_else(Vec::new, |turning| turning.levers);
    let pivots = agent.path.iter().zip(levers).filter(|(_, lever)| *lever > 0.0);
    // More than one turn is several segments.
    pivots.flat_map(|(segment, _)| std::iter::repeat_n(segment.takes_turning(), segment.turns() as usize)).collect()
}

/// The phases of a motion of the agent over a path of this length.
fn phases<S: HostScalar>(agent: &Agent, motion: &MotionSpec, length: S) -> Result<Vec<Phase<S>>, FieldFault> {
    let duration = agent.duration();
    // The division of the core saturates, so motions that take too long are detected here.
    if S::from_f64(duration) >= S::LIMIT {
        return Err(RangeProblem::Duration { duration, limit: S::LIMIT.to_f64() }.into());
    }
    match motion {
        MotionSpec::RestToRest { v_max, a_max } => {
            let speed = number("v_max", *v_max)?;
            let acceleration = number("a_max", *a_max)?;
            let profile = Profile::rest_to_rest(length, Limits { speed, acceleration });
            let profile = profile.map_err(derived::<S>)?;
            Ok(profile.as_profile().phases().to_vec())
        }
        MotionSpec::Profile { .. } => {
            let (v0, pieces) = motion.pieces(length.to_f64());
            speed::phases(v0, &pieces, length)
                .map_err(|(piece, problem)| FieldFault { part: piece.map(|piece| ("profile piece", piece)), problem })
        }
    }
}

/// The extended collision map of a fleet of any size: the storage grows until it is large enough.
///
/// # Errors
/// [`CapacityError::Agents`] for more than 65536 agents, [`CapacityError::Pair`] where two of them have more than 32767 pieces.
pub fn build_ecm<S: HostScalar>(motions: &[Motion<'_, S>]) -> Result<HostEcm<S>, CapacityError> {
    Ecm::grown(motions)
}

/// The table of passing orders of a fleet of any size, without decisions: the storage grows until it is large enough for all
/// regions.
///
/// # Errors
/// As [`build_ecm`].
pub fn build_orders(motions: &[Motion<'_, f64>]) -> Result<HostPrecedenceTable, CapacityError> {
    PrecedenceTable::grown(motions)
}

/// The table of the regions of one agent with all others.
///
/// # Errors
/// As [`build_ecm`].
///
/// # Panics
/// Where there is no such agent.
pub fn build_ecm_of<S: HostScalar>(motions: &[Motion<'_, S>], agent: usize) -> Result<HostEcm<S>, CapacityError> {
    table_of(motions, agent, [16 * motions.len(), 32 * motions.len()])
}

/// The same, with initial storage for these numbers of regions and pieces.
///
/// # Errors
/// As [`build_ecm`].
pub(crate) fn table_of<S: HostScalar>(
    motions: &[Motion<'_, S>],
    agent: usize,
    [regions, pieces]: [usize; 2],
) -> Result<HostEcm<S>, CapacityError> {
    let room = |full| move |_: memory_budget::MemoryError| full;
    let [region, piece] = [size_of::<EcmEntry>(), size_of::<Piece<S>>()].map(|size| size as u64);
    memory_budget::for_list(regions, region).map_err(room(CapacityError::Regions { needed: regions, capacity: 0 }))?;
    memory_budget::for_list(pieces, piece).map_err(room(CapacityError::Pieces { needed: pieces, capacity: 0 }))?;
    let mut ecm = Ecm::new(vec![EcmEntry::EMPTY; regions], vec![Piece::EMPTY; pieces]);
    loop {
        match ecm.fill_row(motions, agent) {
            Err(EcmError::Full(full)) => ecm.grow(full)?,
            done => return Ok(done.map(|()| ecm).expect("an agent of the fleet")),
        }
    }
}
