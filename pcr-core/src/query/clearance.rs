//! The closest approach of two agents: the least separation over time.
//!
//! The separation is bounded from below by the chord of a step (see `contact`) minus its error, and from above by the
//! motion itself at the nearest point of the chord. A step is finished when its lower bound is not below the least
//! separation known.

use crate::array_vec::ArrayVec;
use crate::geometry::Interval;
use crate::pair::outline::distance::separation_along;
use crate::query::contact::Encounter;
use crate::query::leg_windows::{LegWindow, LegWindows};
use crate::query::relative_motion::LinearRelativeMotion;
use crate::scalar::{Scalar, Wide};

/// The closest approach of two agents: its time and the distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ClosestApproach<S> {
    /// The first time of the closest approach, within the tolerance \[s\].
    pub time: S,
    /// Distance of the centres \[m\]. For outlines, the distance of the polygons without their rounding; if these overlap, minus the length of the least translation
    /// that separates them.
    pub separation: S,
}

impl<S: Scalar> Encounter<'_, S> {
    /// The closest approach of the two agents during an interval of time \[s\], within half of [`Encounter::tolerance`] of the
    /// least separation. Each agent stands at its start before it sets off and at its end after its arrival. The
    /// clearance is the separation minus [`Encounter::radius`].
    ///
    /// Cost: a comparison of boxes for each pair of segments, and a few steps for each pair that comes nearer than
    /// those before. Only where the distance stays the same although the agents do not go alike, on a circle around a
    /// stand for instance, steps are as short as √(ε / c) with c = Σ |a| + v²/ϱ.
    pub fn closest(&self, during: Interval<S>) -> ClosestApproach<S> {
        if self.has_outline() {
            return self.closest_of_outlines(during.limited());
        }
        let separation = |time: S| (self.other.position_at(time) - self.ego.position_at(time)).norm_squared().sqrt();
        let during = during.limited();
        let mut best = ClosestApproach { time: during.lo, separation: separation(during.lo) };
        // An upper bound that the search can use from the first window on.
        let eighth = during.length().half().half().half();
        let places = [(); 8].iter().scan(during.lo, |place, ()| {
            *place = *place + eighth;
            Some(separation(*place))
        });
        let bound = places.fold(best.separation, S::min) + self.tolerance().half();
        let mut windows = LegWindows::new([self.ego, self.other], during, self.pad());
        while let Some(window) = windows.next(best.separation.min(bound) + self.pad()) {
            self.closest_in(&window, bound, &mut best);
        }
        best
    }

    /// Returns the closest approach of two outlines, as [`Encounter::closest`]. A step is finished when the lower bound of the separation around its middle (`Bodies::least_within`) is not
    /// below the least separation known; if not, it is halved.
    // Not inlined: pairs of discs would need the stack of it.
    #[inline(never)]
    fn closest_of_outlines(&self, during: Interval<S>) -> ClosestApproach<S> {
        let fine = self.tolerance().half().half();
        let separation = |time: S| {
            let from = self.ego.position_at(time);
            let [own, their] = [self.ego, self.other].map(|motion| motion.corners_at(time, from));
            separation_along(own.as_slice(), their.as_slice()).0
        };
        let mut best = ClosestApproach { time: during.lo, separation: separation(during.lo) };
        let mut windows = LegWindows::new([self.ego, self.other], during, self.pad());
        while let Some(window) = windows.next(self.spread(best.separation.max(S::ZERO)) + self.pad()) {
            // Halves of halves: so what lies ahead is known in steps that double, and a descent is not followed step by step.
            let (mut now, mut ends) = (window.time.lo, ArrayVec::<S, 64>::new(S::ZERO));
            ends.push(window.time.hi);
            while let Some(&end) = ends.as_slice().last() {
                let during = Interval::new(now, end);
                let instant = window.at(during.middle());
                let bodies = window.bodies([self.ego, self.other], &instant, during);
                if bodies.separation < best.separation {
                    best = ClosestApproach { time: instant.time, separation: bodies.separation };
                }
                // The middle is rounded, and times of phases are.
                let (half, rounding) =
                    (during.length().half(), S::rounding(window.time.lo.abs().max(window.time.hi.abs())));
                let least = bodies.least_within(half + rounding);
                if least >= best.separation - fine || half <= rounding.double() || !ends.push(instant.time) {
                    now = end;
                    ends.pop();
                }
            }
        }
        best
    }

    /// Searches a window for a separation that is less than `best` and `bound`.
    fn closest_in(&self, window: &LegWindow<'_, S>, bound: S, best: &mut ClosestApproach<S>) {
        // The nearest place of the chord and that of the motion are each off by the error of the chord, and the distance by the pad, a quarter
        // of the tolerance at most: half of the tolerance in all.
        let fine = self.tolerance().half().half().half();
        let mut now = window.at(window.time.lo);
        let mut step = window.time.length();
        loop {
            let left = window.time.hi - now.time;
            let (duration, to) = if step < left { (step, now.time + step) } else { (left, window.time.hi) };
            let ahead = window.at(to);
            let chord = LinearRelativeMotion::between(now.apart, ahead.apart);
            // The distance of agents that go alike often stays the same: then no lower bound would end the search early.
            let uniform = window.is_uniform(&now, &ahead);
            let error = if uniform { S::ZERO } else { window.deviation(&now, &ahead) };
            let (x, distance) = chord.nearest();
            let mut done = distance - error >= best.separation.min(bound);
            if !done {
                let elapsed = if x < chord.length { duration.portion(x, chord.length) } else { duration };
                let time = (now.time + elapsed).min(to);
                let separation = window.at(time).separation();
                if separation < best.separation {
                    *best = ClosestApproach { time, separation };
                }
                let half = duration.half();
                done = error <= fine || distance - error + fine >= best.separation || now.time + half <= now.time;
            }
            if !done {
                step = duration.half();
            } else if to >= window.time.hi {
                return;
            } else {
                now = ahead;
                step = duration.double();
            }
        }
    }
}
