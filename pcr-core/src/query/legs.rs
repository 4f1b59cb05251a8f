//! Splits a motion where its formula changes. Each leg is one phase on one segment, or a stand.
//!
//! A motion has a stage before it sets off, one on each segment, and one after its arrival. The position of a stage is
//! known at no cost; each end of its time needs an inversion of the profile. Legs are the phases of a stage.

use crate::geometry::{Aabb, Interval, Point};
use crate::motion::Motion;
use crate::profile::Phase;
use crate::scalar::Scalar;
use crate::segment::{Curve, Segment};

/// A part of a motion at constant acceleration on one segment, or a stand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leg<'a, S: Scalar> {
    segment: &'a Segment<S>,
    /// `None` for a stand.
    phase: Option<&'a Phase<S>>,
    /// Time at which the motion sets off \[s\].
    start: S,
    /// Place of a stand: length along the path \[m\].
    stand: S,
}

impl<'a, S: Scalar> Leg<'a, S> {
    /// The segment of the leg.
    pub(crate) fn segment(&self) -> &'a Segment<S> {
        self.segment
    }

    /// The speeds at some times of the leg \[m/s\], and the magnitude of the acceleration in between \[m/s²\].
    pub(crate) fn speeds<const N: usize>(&self, times: [S; N]) -> ([S; N], S) {
        let Some(phase) = self.phase else { return ([S::ZERO; N], S::ZERO) };
        let at = |time: S| phase.speed_at((time - self.start).clamp(phase.time().lo, phase.time().hi));
        (times.map(at), phase.acceleration().abs())
    }

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

    /// Largest distance \[m\] of the agent from a point that moves uniformly along the chord, over a part of the leg
    /// that has the length `way` \[m\] and takes `duration` \[s\].
    ///
    /// The error of linear interpolation is at most h²/8 times the largest second derivative: over time this is the
    /// acceleration, over length the curvature.
    pub(crate) fn deviation(&self, way: S, duration: S) -> S {
        let bend = self.segment.bulge(way);
        let bulge = self.phase.map_or(S::ZERO, |phase| phase.bulge(duration));
        if bulge <= S::ZERO { bend } else { bend.double() + bulge }
    }

    /// Whether both have the same acceleration along segments of the same shape and direction, on which they are at the same place at
    /// these lengths \[m\]; the place makes no difference on lines.
    pub(crate) fn goes_like(&self, other: &Self, [at, there]: [S; 2]) -> bool {
        let (Some(own), Some(their)) = (self.phase, other.phase) else { return false };
        let [here, yonder] = [self.segment, other.segment];
        own.goes_like(their)
            && here.direction == yonder.direction
            && here.curve == yonder.curve
            && (here.curve == Curve::Line || at - here.from == there - yonder.from)
    }
}

/// The part of a motion on one segment, or one of its two stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MotionStage<'a, S: Scalar> {
    motion: &'a Motion<'a, S>,
    /// 0 for the stand before the motion, then the index of the segment plus 1, finally the stand after the motion.
    place: usize,
    segment: &'a Segment<S>,
    /// Place of a stand: length along the path \[m\].
    stand: Option<S>,
}

/// The indices of the first and the last stage within an interval of time; `slack` bounds the rounding error of a
/// length \[m\].
pub(crate) fn places<S: Scalar>(motion: &Motion<'_, S>, during: Interval<S>, slack: S) -> [usize; 2] {
    let (travel, segments) = (motion.time(), motion.path().segments());
    let after = segments.len().wrapping_add(1);
    let first = if during.lo <= travel.lo {
        0
    } else if during.lo >= travel.hi {
        after
    } else {
        let length = motion.length_at(during.lo) - slack;
        segments.partition_point(|segment| segment.to < length).wrapping_add(1)
    };
    let last = if during.hi >= travel.hi {
        after
    } else if during.hi < travel.lo {
        0
    } else {
        let length = motion.length_at(during.hi) + slack;
        segments.partition_point(|segment| segment.from <= length)
    };
    [first, last]
}

impl<'a, S: Scalar> MotionStage<'a, S> {
    /// The first stage from `place` on, up to the `last` one, whose box meets `around`.
    pub(crate) fn in_box(motion: &'a Motion<'a, S>, [place, last]: [usize; 2], around: &Aabb<S>) -> Option<Self> {
        let segments = motion.path().segments();
        let stands_in = |point: Point<S>| around.x.contains(point.x) && around.y.contains(point.y);
        let stage = |place, segment, stand| Some(Self { motion, place, segment, stand });
        let first = segments.first()?;
        if place == 0 && stands_in(first.start) {
            return stage(0, first, Some(S::ZERO));
        }
        let skipped = place.saturating_sub(1);
        let mut rest = segments.get(skipped..last.min(segments.len()))?.iter();
        if let Some(on) = rest.position(|segment| around.meets(segment.bounds)) {
            let on = skipped.wrapping_add(on);
            return stage(on.wrapping_add(1), segments.get(on)?, None);
        }
        let (end, after) = (segments.last()?, segments.len().wrapping_add(1));
        let stands = place <= after && last == after && stands_in(end.end);
        if stands { stage(after, end, Some(motion.path().length())) } else { None }
    }

    /// Box around the stage \[m\].
    pub(crate) fn bounds(&self) -> Aabb<S> {
        match self.stand {
            None => self.segment.bounds,
            Some(_) => {
                let point = if self.place == 0 { self.segment.start } else { self.segment.end };
                Aabb::around(point, point)
            }
        }
    }

    pub(crate) fn place(&self) -> usize {
        self.place
    }

    /// The lengths of the path \[m\] at which this stage may come nearer than `reach` to another one, whose box is near
    /// its own; `None` if there are none.
    pub(crate) fn beside(&self, other: &Self, reach: S) -> Option<Interval<S>> {
        let Segment { from, to, length, .. } = *self.segment;
        let part = match (self.stand, other.stand) {
            (None, None) if !self.segment.near(other.segment, reach) => return None,
            (None, None) => self.segment.beside(other.segment, reach)?,
            _ => Interval::new(S::ZERO, length),
        };
        Some(Interval::new(from + part.lo, if part.hi < length { from + part.hi } else { to }))
    }

    /// The time \[s\] in which the agent is on a part of the stage, within the interval `during`, to which stands are
    /// limited. A wait at a joint belongs to the segment before it.
    pub(crate) fn time_in(&self, part: Interval<S>, during: Interval<S>) -> Interval<S> {
        let (travel, profile, place) = (self.motion.time(), self.motion.profile(), self.place);
        let joints = self.motion.path().segments().len();
        let lo = match part.lo {
            _ if place == 0 => during.lo,
            _ if place == 1 && part.lo <= self.segment.from => travel.lo,
            _ if place > joints => travel.hi,
            joint if joint <= self.segment.from => travel.lo + profile.last_time_at(joint),
            length => travel.lo + profile.first_time_at(length),
        };
        let hi = match part.hi {
            _ if place == 0 => travel.lo,
            _ if place > joints => during.hi,
            _ if place == joints && part.hi >= self.segment.to => travel.hi,
            length => travel.lo + profile.last_time_at(length),
        };
        Interval::new(lo.max(during.lo), hi.min(during.hi))
    }

    /// The leg of the stage from a time on, and its end, if it ends before the stage. On entry `phase` must not be
    /// behind the phase of the leg; on return it is the index of that phase.
    pub(crate) fn leg(&self, now: S, phase: &mut usize) -> (Leg<'a, S>, Option<S>) {
        let start = self.motion.time().lo;
        let mut phases = self.motion.profile().phases().get(*phase..).unwrap_or_default().iter();
        let over = |phase: &&Phase<S>| start + phase.time().hi <= now;
        let leg = |phase, stand| Leg { segment: self.segment, phase, start, stand };
        if let Some(stand) = self.stand {
            return (leg(None, stand), None);
        }
        let current = loop {
            match phases.next() {
                Some(passed) if over(&passed) => *phase = phase.wrapping_add(1),
                current => break current,
            }
        };
        (leg(current, self.motion.path().length()), current.map(|phase| start + phase.time().hi))
    }
}
