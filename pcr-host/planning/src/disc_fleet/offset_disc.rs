//! The motion of a disc that is fixed to a vehicle, beside its reference point.
//!
//! On a line the disc runs on the parallel line. On an arc of curvature κ it runs on the concentric arc, with lengths
//! scaled by g = √((κ a)² + (1 - κ b)²) and a heading that differs by atan2(κ a, 1 - κ b), where the disc is a ahead
//! and b to the left of the reference point. Where the curvature changes, its path has corners; these become turns in
//! place of [`TURN`] radius, as in imported paths. Its speed jumps there from g v to g′ v; the profile changes it
//! within a nanosecond, in formats other than `f64` within a millisecond, or longer at high speeds (`joints.rs`). The largest displacement
//! by this is added to the radius of the disc.

use super::speed_jumps::{ContinuousMotion, ProfilePiece, TimeResolution, joined, largest_jump};
use crate::fleet::{HostScalar, RoundingBounds};
use pcr_formats::footprint::CoverDisc;
use pcr_formats::plane_geometry::within_half_turn;
use pcr_formats::scenario::{Agent, MotionSpec, PathSegment, SegmentPhase};
use pcr_formats::scenario::{PlacedSegment, TURN};

/// Speed above which a segment is taken as a jump from its start to its end \[m/s\]: what is left of an angle between two
/// segments that is passed without stopping.
const QUICK: f64 = 1e4;

/// What a number format can tell apart.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScalarPrecision {
    /// Length, angle and speed that are rounding and nothing else \[m, rad, m/s\].
    nothing: f64,
    /// Least time of a change of speed \[s\].
    least: f64,
    /// Largest acceleration \[m/s²\].
    largest: f64,
    /// The least time \[s\].
    tick: f64,
}

impl ScalarPrecision {
    /// That of the format for a vehicle.
    pub(super) fn of<S: HostScalar>(vehicle: &Agent) -> Self {
        if S::NAME == f64::NAME {
            return Self { nothing: NOTHING, least: 1e-9, largest: 1e9, tick: f64::MIN_POSITIVE };
        }
        let [x, y, _] = vehicle.start;
        let extent = S::from_f64(x.abs().max(y.abs()) + vehicle.length() + vehicle.circumscribed_radius());
        let nothing = S::slack(extent.min(S::LIMIT)).to_f64();
        Self { nothing, least: 1.0 / 1024.0, largest: 0.5 * S::LIMIT.to_f64(), tick: S::LEAST.to_f64() }
    }

    /// How long changes of speed take, up to this one.
    fn jump(&self, change: f64) -> f64 {
        self.least.max(change / self.largest)
    }
}

/// Angle and speed that are rounding and nothing else \[rad, m/s\].
const NOTHING: f64 = 1e-12;

/// A disc as an agent of its own, with what its lengths are on the path of the vehicle.
#[derive(Clone, Debug)]
pub(super) struct OffsetDisc {
    pub(super) agent: Agent,
    /// Own lengths and those of the reference point, both not decreasing.
    marks: Vec<[f64; 2]>,
    /// For each segment of the agent that of the vehicle.
    sources: Vec<usize>,
    /// Rounding of own lengths \[m\].
    slack: f64,
}

impl OffsetDisc {
    /// The disc of the vehicle with these parts of its motion, as an agent of this number.
    pub(super) fn of(
        vehicle: &Agent,
        parts: &[Vec<SegmentPhase>],
        disc: &CoverDisc,
        id: u64,
        precision: ScalarPrecision,
    ) -> Self {
        let [x, y, heading] = vehicle.start;
        let (sin, cos) = heading.sin_cos();
        let CoverDisc { ahead, left, radius } = *disc;
        let at = [x + ahead * cos - left * sin, y + ahead * sin + left * cos];
        let mut tracer = OffsetPathBuilder::new(radius + NOTHING * (1.0 + x.abs() + y.abs()), precision);
        let mut reference = PlacedSegment { start: [x, y], heading, shape: PathSegment::Line { length: 0.0 } };
        let length = vehicle.length();
        for (source, (&shape, parts)) in vehicle.path.iter().zip(parts).enumerate() {
            reference = PlacedSegment { start: [0.0; 2], heading: reference.heading_at_end(), shape };
            let curvature = match shape {
                PathSegment::Line { .. } => 0.0,
                PathSegment::Arc { radius, sweep } => sweep.signum() / radius,
            };
            let [across, along] = [curvature * ahead, 1.0 - curvature * left];
            let (scale, turned) = (across.hypot(along), across.atan2(along));
            let shape = match shape {
                PathSegment::Line { .. } => shape,
                PathSegment::Arc { radius, sweep } => PathSegment::Arc { radius: radius * scale, sweep },
            };
            // The rounding of lengths on the path of the vehicle is scaled as well.
            tracer.growth += 4.0 * f64::EPSILON * length * scale;
            tracer.add(shape, reference.heading + turned, [scale, reference.shape.length()], parts, source);
        }
        tracer.finish(vehicle, at, id)
    }

    /// The disc with something done to its agent.
    pub(super) fn map(mut self, change: impl Fn(Agent) -> Agent) -> Self {
        self.agent = change(self.agent);
        self
    }

    /// The disc with what a number format makes of its motion.
    pub(super) fn rounded(mut self, RoundingBounds { distance, length }: RoundingBounds) -> Self {
        self.agent.radius += distance;
        self.slack = length;
        self
    }

    /// The lengths of the reference point that belong to own lengths, outward.
    pub(super) fn on_reference(&self, [lo, hi]: [f64; 2]) -> [f64; 2] {
        let [lo, hi] = [lo - self.slack, hi + self.slack];
        let end = self.marks.last().map_or(0.0, |mark| mark[1]);
        let between = |[a, b]: [[f64; 2]; 2], length: f64| {
            let share = if b[0] > a[0] { ((length - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0) } else { 0.0 };
            a[1] + (b[1] - a[1]) * share
        };
        let pairs = || self.marks.windows(2).map(|pair| [pair[0], pair[1]]);
        let slack = NOTHING * (1.0 + end);
        let own_end = self.marks.last().map_or(0.0, |mark| mark[0]);
        // Where own lengths stand still: the first reference length for the lower end, the last one for the upper.
        let first = pairs()
            .find(|[_, b]| b[0] >= lo - slack)
            .map_or(0.0, |[a, b]| if b[0] > a[0] { between([a, b], lo) } else { a[1] });
        let last = pairs().rfind(|[a, _]| a[0] <= hi + slack);
        let last = last.map_or(0.0, |[a, b]| if b[0] > a[0] { between([a, b], hi) } else { b[1] });
        [
            if lo <= slack { 0.0 } else { (first - slack).max(0.0) },
            if hi >= own_end - slack { end } else { (last + slack).min(end) },
        ]
    }

    /// Segment of the vehicle that a segment of the disc belongs to.
    pub(super) fn source(&self, segment: usize) -> Option<usize> {
        self.sources.get(segment).copied()
    }
}

/// A path and a motion in the making.
struct OffsetPathBuilder {
    precision: ScalarPrecision,
    start: Option<f64>,
    heading: f64,
    path: Vec<PathSegment>,
    sources: Vec<usize>,
    pieces: Vec<ProfilePiece>,
    marks: Vec<[f64; 2]>,
    growth: f64,
}

impl OffsetPathBuilder {
    fn new(growth: f64, precision: ScalarPrecision) -> Self {
        Self {
            precision,
            start: None,
            heading: 0.0,
            path: Vec::new(),
            sources: Vec::new(),
            pieces: Vec::new(),
            marks: vec![[0.0; 2]],
            growth,
        }
    }

    /// Goes on by a segment in a heading, on which lengths are `scale` times the `length` of the vehicle.
    fn add(
        &mut self,
        shape: PathSegment,
        heading: f64,
        [scale, length]: [f64; 2],
        parts: &[SegmentPhase],
        source: usize,
    ) {
        let own = shape.length();
        let [mut at, reference] = self.marks.last().copied().unwrap_or_default();
        let duration: f64 = parts.iter().map(|part| part.duration).sum();
        let quick = own > duration * self.precision.largest.min(QUICK);
        if own <= self.precision.nothing || quick {
            // It stands, or is at the end at once; the next segments lie beside where it would have taken the disc.
            self.growth += 2.0 * own;
            self.marks.push([at, reference + length]);
            if !quick {
                self.pieces.push(ProfilePiece { duration, speed: [0.0; 2], detour: 0.0 });
            }
            return;
        }
        let turn = self.start.map_or(0.0, |_| within_half_turn(heading - self.heading));
        self.start.get_or_insert(heading);
        if turn.abs() > NOTHING {
            self.path.push(PathSegment::Arc { radius: TURN, sweep: turn });
            self.sources.push(source);
            at += TURN * turn.abs();
            self.marks.push([at, reference]);
            // Its chord.
            self.growth += 2.0 * TURN;
        }
        self.path.push(shape);
        self.sources.push(source);
        self.marks.push([at + own, reference + length]);
        self.heading = match shape {
            PathSegment::Line { .. } => heading,
            PathSegment::Arc { sweep, .. } => heading + sweep,
        };
        let mut detour = TURN * turn.abs();
        self.pieces.extend(parts.iter().filter(|part| part.duration > 0.0).map(|part| ProfilePiece {
            duration: part.duration,
            speed: [scale * part.before, scale * part.after],
            detour: std::mem::take(&mut detour),
        }));
    }

    fn finish(self, vehicle: &Agent, [x, y]: [f64; 2], id: u64) -> OffsetDisc {
        let jump = self.precision.jump(largest_jump(&self.pieces));
        let ScalarPrecision { nothing, tick, .. } = self.precision;
        let ContinuousMotion { pieces, position_error: off } =
            joined(&self.pieces, TimeResolution { change: jump, nothing, tick });
        let radius = self.growth + off;
        let v0 = pieces.first().map_or(0.0, |first| first.speed[0]);
        let mut speed = v0;
        let pieces = pieces.iter().filter(|piece| piece.duration > 0.0).map(|piece| {
            let change = piece.speed[1] - std::mem::replace(&mut speed, piece.speed[1]);
            (piece.duration, change / piece.duration)
        });
        let motion = MotionSpec::Profile { v0, pieces: pieces.collect() };
        let heading = self.start.unwrap_or(vehicle.start[2]);
        let start = [x, y, heading];
        let agent = Agent { id, radius, start, path: self.path, motion, ..vehicle.clone() };
        OffsetDisc { agent, marks: self.marks, sources: self.sources, slack: 0.0 }
    }
}
