//! A motion, cut where its formula changes: each leg is one phase on one segment, or a stand.
//!
//! The legs of a motion cover a given interval of time without gaps: the agent stands at the start of its path before
//! it sets off and at the end after its arrival.

use crate::geometry::{Bounds, Interval, Point};
use crate::motion::Motion;
use crate::profile::Phase;
use crate::scalar::{Scalar, Wide};
use crate::segment::{Curve, Segment};

/// Part of a motion at constant acceleration on one segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leg<'a, S: Scalar> {
    /// When \[s\].
    pub(crate) time: Interval<S>,
    segment: &'a Segment<S>,
    /// `None` for a stand.
    phase: Option<&'a Phase<S>>,
    /// When the motion sets off \[s\].
    start: S,
    /// Where a stand is: length along the path \[m\].
    stand: S,
}

impl<S: Scalar> Leg<'_, S> {
    /// Length along the path at a time of the leg \[m\].
    pub(crate) fn length_at(&self, time: S) -> S {
        match self.phase {
            None => self.stand,
            Some(phase) => phase.length_at((time - self.start).clamp(phase.time().lo, phase.time().hi)),
        }
    }

    /// Position at a length along the path that the leg covers.
    pub(crate) fn point_at(&self, length: S) -> Point<S> {
        self.segment.point_at(length - self.segment.from)
    }

    /// Box around the segment.
    pub(crate) fn bounds(&self) -> Bounds<S> {
        self.segment.bounds
    }

    /// How far the agent may be from the point that goes at constant speed along the chord of its way \[m\], over a part
    /// of the leg that takes `duration` \[s\] for `way` \[m\].
    ///
    /// The largest second derivative times h²/8 bounds the error of linear interpolation: over time it is the
    /// acceleration, over length the curvature.
    pub(crate) fn deviation(&self, way: S, duration: S) -> S {
        let eighth = |length: S| length.half().half().half();
        let bend = match self.segment.curve {
            Curve::Line => S::ZERO,
            Curve::Arc { radius, .. } if way <= radius => eighth(way.portion(way, radius)),
            // Both points are within half the way of the middle of the chord.
            Curve::Arc { .. } => way,
        };
        let Some(phase) = self.phase else {
            return bend;
        };
        let gain = phase.acceleration().abs().times(duration).narrow();
        bend + eighth(gain.times(duration).narrow())
    }
}

/// What comes next.
#[derive(Clone, Copy, Debug)]
enum Stage<S> {
    /// The stand before the motion, if any.
    Before,
    /// This phase and segment.
    Travel(usize, usize),
    /// The stand after the motion, if any.
    After,
    /// A single instant, at this length.
    Instant(S),
    Done,
}

/// The legs of a motion in an interval of time, in their order, none of them empty.
///
/// Cost: a time of a length for each joint before the end of the interval.
#[derive(Clone, Debug)]
pub(crate) struct Legs<'a, S: Scalar> {
    motion: &'a Motion<'a, S>,
    until: S,
    /// Where the next leg begins.
    now: S,
    stage: Stage<S>,
}

impl<'a, S: Scalar> Legs<'a, S> {
    /// An interval of length 0 has one leg.
    pub(crate) fn new(motion: &'a Motion<'a, S>, during: Interval<S>) -> Self {
        let stage = if during.lo < during.hi { Stage::Before } else { Stage::Instant(motion.length_at(during.lo)) };
        Self { motion, until: during.hi, now: during.lo, stage }
    }

    fn stand(&mut self, length: S, until: S) -> Option<Leg<'a, S>> {
        let (time, start) = (Interval::new(self.now, until.min(self.until)), self.motion.time().lo);
        self.now = time.hi;
        let segment = self.motion.path().segment_at(length)?;
        Some(Leg { time, segment, phase: None, start, stand: length })
    }
}

impl<'a, S: Scalar> Iterator for Legs<'a, S> {
    type Item = Leg<'a, S>;

    fn next(&mut self) -> Option<Leg<'a, S>> {
        let travel = self.motion.time();
        loop {
            match self.stage {
                Stage::Done => return None,
                Stage::Instant(length) => {
                    self.stage = Stage::Done;
                    return self.stand(length, self.until);
                }
                _ if self.now >= self.until => self.stage = Stage::Done,
                Stage::Before => {
                    self.stage = Stage::Travel(0, 0);
                    if self.now < travel.lo {
                        return self.stand(S::ZERO, travel.lo);
                    }
                }
                Stage::After => {
                    self.stage = Stage::Done;
                    return self.stand(self.motion.path().length(), self.until);
                }
                Stage::Travel(at, on) => {
                    let segments = self.motion.path().segments();
                    let (Some(phase), Some(segment)) = (self.motion.profile().phases().get(at), segments.get(on))
                    else {
                        self.stage = Stage::After;
                        continue;
                    };
                    let joint = segment.from + segment.length;
                    let next = on.wrapping_add(1);
                    let end = if joint < phase.length().hi && next < segments.len() {
                        self.stage = Stage::Travel(at, next);
                        phase.time_at(joint.max(phase.length().lo))
                    } else {
                        self.stage = Stage::Travel(at.wrapping_add(1), on);
                        phase.time().hi
                    };
                    let time = Interval::new(self.now, (travel.lo + end).min(self.until));
                    if time.lo < time.hi {
                        self.now = time.hi;
                        return Some(Leg { time, segment, phase: Some(phase), start: travel.lo, stand: S::ZERO });
                    }
                }
            }
        }
    }
}
