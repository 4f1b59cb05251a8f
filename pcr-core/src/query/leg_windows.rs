//! The intervals of time in which two agents may be near each other, each on one leg.
//!
//! Stages of the two agents are compared first by position, then by time: boxes reject most pairs, and only the others
//! need inversions of a profile. Windows come in the order of the ego's stages, then of the other's; windows with the
//! same stages follow one another in time.

use crate::geometry::{Interval, Vector};
use crate::motion::Motion;
use crate::query::bodies::Bodies;
use crate::query::legs::{Leg, MotionStage, places};
use crate::scalar::{Scalar, Wide};

/// A leg of each agent, and the time in which both last.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LegWindow<'a, S: Scalar> {
    pub(crate) time: Interval<S>,
    legs: [Leg<'a, S>; 2],
}

/// Positions of both agents at one time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PairInstant<S> {
    pub(crate) time: S,
    lengths: [S; 2],
    /// Vector from one centre to the other.
    pub(crate) apart: Vector<S>,
}

impl<S: Scalar> PairInstant<S> {
    /// Distance of the centres \[m\].
    pub(crate) fn separation(&self) -> S {
        self.apart.norm_squared().sqrt()
    }
}

impl<S: Scalar> LegWindow<'_, S> {
    #[cfg_attr(feature = "std", inline(always))]
    pub(crate) fn at(&self, time: S) -> PairInstant<S> {
        let [a, b] = &self.legs;
        let lengths = [a.length_at(time), b.length_at(time)];
        PairInstant { time, lengths, apart: b.point_at(lengths[1]) - a.point_at(lengths[0]) }
    }

    /// The two outlines at an instant, with bounds that hold during an interval around it \[s\].
    pub(crate) fn bodies(&self, motions: [&Motion<'_, S>; 2], at: &PairInstant<S>, during: Interval<S>) -> Bodies<S> {
        let [ego, other] = &self.legs;
        Bodies::new(motions, [ego, other], at.lengths, at.time, during)
    }

    /// Largest deviation of the relative position from the chord between two instants \[m\].
    pub(crate) fn deviation(&self, from: &PairInstant<S>, to: &PairInstant<S>) -> S {
        let duration = to.time - from.time;
        let [[a, b], [c, d]] = [from.lengths, to.lengths];
        let [ego, other] = &self.legs;
        ego.deviation(c - a, duration) + other.deviation(d - b, duration)
    }

    /// Whether the relative position moves uniformly between two instants, along the chord: both agents go alike.
    pub(crate) fn is_uniform(&self, from: &PairInstant<S>, to: &PairInstant<S>) -> bool {
        let [ego, other] = &self.legs;
        [from, to].into_iter().all(|instant| ego.goes_like(other, instant.lengths))
    }
}

/// The windows in which two agents may be near each other, in increasing order of time.
#[derive(Clone, Debug)]
pub(crate) struct LegWindows<'a, S: Scalar> {
    motions: [&'a Motion<'a, S>; 2],
    /// The rest of the interval of time \[s\].
    during: Interval<S>,
    /// Whether the interval had length 0; its window then has, too.
    instant: bool,
    /// The remaining stages, first and last: those of the ego, and those of the other agent for the next stage of the
    /// ego.
    left: [[usize; 2]; 2],
    /// The first stage of the other agent that is not over before.
    first_of_other: usize,
    /// The rest of the time that two stages share.
    rest: Option<(Interval<S>, [MotionStage<'a, S>; 2])>,
    /// Indices of the current phases of both, or of earlier ones.
    phases: [usize; 2],
}

impl<'a, S: Scalar> LegWindows<'a, S> {
    pub(crate) fn new(motions: [&'a Motion<'a, S>; 2], during: Interval<S>, slack: S) -> Self {
        let left = motions.map(|motion| places(motion, during, slack));
        let (instant, first_of_other) = (during.lo == during.hi, left[1][0]);
        Self { motions, during, instant, left, first_of_other, rest: None, phases: [0; 2] }
    }

    /// The next window in which the two may come nearer than `reach`.
    pub(crate) fn next(&mut self, reach: S) -> Option<LegWindow<'a, S>> {
        let (time, stages) = match self.rest.take() {
            None => self.meeting(reach)?,
            Some(rest) => rest,
        };
        let ([ego, other], [own, their]) = (&stages, &mut self.phases);
        let ((ego, ends), (other, then)) = (ego.leg(time.lo, own), other.leg(time.lo, their));
        let until = time.hi.min(ends.unwrap_or(time.hi)).min(then.unwrap_or(time.hi));
        self.during.lo = until;
        self.rest = (until < time.hi).then_some((Interval::new(until, time.hi), stages));
        Some(LegWindow { time: Interval::new(time.lo, until), legs: [ego, other] })
    }

    /// The next two stages that may come nearer than `reach` at the same time, and the interval in which both last.
    fn meeting(&mut self, reach: S) -> Option<(Interval<S>, [MotionStage<'a, S>; 2])> {
        let [ego, other] = self.motions;
        let near = other.bounds().expanded(reach);
        loop {
            let own = MotionStage::in_box(ego, self.left[0], &near)?;
            if own.place() > self.left[0][0] {
                self.go_on(own.place());
            }
            let around = own.bounds().expanded(reach);
            while let Some(their) = MotionStage::in_box(other, self.left[1], &around) {
                self.left[1][0] = their.place().wrapping_add(1);
                let Some(part) = own.beside(&their, reach) else { continue };
                let Some(their_part) = their.beside(&own, reach) else { continue };
                let time = own.time_in(part, self.during).common(their.time_in(their_part, self.during));
                // Segments that are passed at a single time are skipped: both their ends are near, within
                // `Motion::leap`, and belong to other windows.
                if time.lo < time.hi || self.instant && time.lo <= time.hi {
                    return Some((time, [own, their]));
                }
            }
            self.go_on(own.place().wrapping_add(1));
        }
    }

    /// Continues with stage `place` of the ego, and all stages of the other agent.
    fn go_on(&mut self, place: usize) {
        (self.left[0][0], self.left[1][0]) = (place, self.first_of_other);
    }
}

#[cfg(all(test, feature = "libm"))]
mod tests {
    use super::*;
    use crate::{Limits, Path, Point, Pose, Profile, Radians, TurnSide};

    /// Whether two agents go alike: on lines or arcs, with these headings, accelerations and times at which they set off.
    fn alike(arcs: [Option<TurnSide>; 2], headings: [f64; 2], accelerations: [f64; 2], starts: [f64; 2]) -> bool {
        let paths = [0, 1].map(|k| {
            let pose = Pose { position: Point::new(0.0, k as f64), heading: Radians(headings[k]) };
            let path = Path::<f64, 1>::starting_at(pose).expect("a pose");
            let path = match arcs[k] {
                None => path.line(4.0),
                Some(turn) => path.arc(2.0, turn, 4.0),
            };
            path.expect("a path")
        });
        let profiles = accelerations
            .map(|acceleration| Profile::rest_to_rest(4.0, Limits { speed: 1.0, acceleration }).expect("a profile"));
        let motions = [0, 1]
            .map(|k| Motion::new(paths[k].as_path(), profiles[k].as_profile(), 0.1, starts[k]).expect("a motion"));
        let during = Interval::new(0.125, 0.875);
        let mut windows = LegWindows::new([&motions[0], &motions[1]], during, 1e-9);
        let window = windows.next(9.0).expect("they are near");
        window.is_uniform(&window.at(window.time.lo), &window.at(window.time.hi))
    }

    #[test]
    fn only_agents_that_go_alike_move_uniformly_as_seen_from_each_other() {
        let (lines, [left, right]) = ([None; 2], [Some(TurnSide::Left), Some(TurnSide::Right)]);
        assert!(alike(lines, [0.5; 2], [1.0; 2], [0.0; 2]));
        assert!(alike(lines, [0.5; 2], [1.0; 2], [0.0, 0.0625]), "on lines one may be ahead");
        assert!(alike([left; 2], [0.5; 2], [1.0; 2], [0.0; 2]));
        assert!(!alike([left; 2], [0.5; 2], [1.0; 2], [0.0, 0.0625]), "ahead on an arc, it goes in another direction");
        assert!(!alike([left, right], [0.5; 2], [1.0; 2], [0.0; 2]));
        assert!(!alike([left, None], [0.5; 2], [1.0; 2], [0.0; 2]));
        assert!(!alike(lines, [0.5, 0.25], [1.0; 2], [0.0; 2]));
        assert!(!alike(lines, [0.5; 2], [1.0, 0.5], [0.0; 2]));
    }
}
