//! Keeps the passing orders of a plan in every frame, however late a robot is.
//!
//! A plan passes each collision region in coordination space on one side: one of the two robots passes first. Regions in
//! coordination space depend on the paths alone, so robots that keep these orders do not collide, whatever the times. The
//! orders are those of [`PrecedenceTable`](pcr_core::PrecedenceTable), with the proofs of `docs/theory/precedence.md`.
//!
//! Discs and outlines are enlarged by the distance that robots may be off their paths. The place of a robot along its path is an
//! interval, of which the worse end is used. A robot drives only as fast as it can brake before the length at which it
//! is held, so it can still do so in the next frame.

use super::speed_limited_path::{OwnedMotion, SpeedLimitedPath};
use pcr_core::{
    CapacityError, CheckState, CheckTolerances, Interval, Motion, MovementAuthority, PassingState, Progress,
};
use pcr_planning::fleet::{ConvexBody, HostPrecedenceTable, build_orders};

/// Gains below this are no progress when it is checked whether all robots can finish \[m\].
const GAIN: f64 = 1e-3;

/// Why there are no passing orders.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum GuardError {
    /// The body of the agent at this place cannot move on its course.
    Agent(usize),
    /// As [`build_orders`].
    Full(CapacityError),
}

/// The regions of all paths in coordination space, and the passing orders.
#[derive(Debug)]
pub(super) struct PrecedenceGuard {
    /// At 1 m/s from time 0 on: orders do not depend on times.
    drives: Vec<OwnedMotion>,
    bodies: Vec<ConvexBody>,
    orders: HostPrecedenceTable,
}

impl PrecedenceGuard {
    /// For these bodies on these courses; no order is decided.
    ///
    /// # Errors
    /// [`GuardError`].
    pub(super) fn new(courses: &[SpeedLimitedPath], bodies: Vec<ConvexBody>) -> Result<Self, GuardError> {
        let drive = |(place, course): (usize, &SpeedLimitedPath)| {
            OwnedMotion::at_unit_speed(course.clone()).ok_or(GuardError::Agent(place))
        };
        let drives = courses.iter().enumerate().map(drive).collect::<Result<Vec<OwnedMotion>, _>>()?;
        let orders = build_orders(&motions(&drives, &bodies)?).map_err(GuardError::Full)?;
        Ok(Self { drives, bodies, orders })
    }

    fn motions(&self) -> Option<Vec<Motion<'_, f64>>> {
        motions(&self.drives, &self.bodies).ok()
    }

    /// Takes the orders of a plan without collisions: `reached(agent, length)` is when an agent reaches a length of its
    /// course \[s\], `length_at(agent, time)` is the length at which it is at that time. Robots are now in these intervals. `None` where
    /// it cannot be told who passes a region first, or where some robot could never finish.
    pub(super) fn take_orders(
        &mut self,
        now: &[Interval<f64>],
        reached: impl Fn(usize, f64) -> f64,
        length_at: impl Fn(usize, f64) -> f64,
    ) -> Option<()> {
        let motions = motions(&self.drives, &self.bodies).ok()?;
        let mut decisions = Vec::new();
        for ego in 0..motions.len() {
            for (place, region, _) in self.orders.row(&motions, ego).ok()? {
                let other = region.other();
                if other < ego {
                    continue;
                }
                let (own, their) = (region.length(), region.other_length());
                let [at, other_at] = [*now.get(ego)?, *now.get(other)?];
                let stand = [ego, other].iter().all(|&agent| motions[agent].path().length() <= 0.0);
                if stand || at.lo > own.hi || other_at.lo > their.hi {
                    decisions.push((place, ego, PassingState::Over, 0.0));
                    continue;
                }
                // A point of the region that is still ahead of the other one; the whole region is on one side.
                let ahead = Interval::new(other_at.lo.clamp(their.lo, their.hi), their.hi).middle();
                let point = region.slice_at(ahead).next().map(Interval::middle)?;
                let is_behind = length_at(ego, reached(other, ahead)) < point;
                let (pass, since) =
                    if is_behind { (PassingState::Second, at.lo) } else { (PassingState::First, other_at.lo) };
                decisions.push((place, ego, pass, since));
            }
        }
        for (place, ego, pass, since) in decisions {
            self.orders.decide_at(&motions, place, ego, pass, since).ok()?;
        }
        let mut reaches = vec![CheckState::EMPTY; motions.len()];
        let tolerances = CheckTolerances { width: 0.0, gain: GAIN };
        self.orders.check(&motions, &progress(now), tolerances, &mut reaches).ok()
    }

    /// The length \[m\] at which each agent is held, infinite where it is not up to its `horizon`, with the agents in these
    /// intervals.
    pub(super) fn authorities(&self, now: &[Interval<f64>], horizon: impl Fn(usize) -> f64) -> Vec<f64> {
        // There were motions when the table was built; if there were none, no robot would move.
        let Some(motions) = self.motions() else { return vec![f64::NEG_INFINITY; self.drives.len()] };
        let progress = progress(now);
        let hold = |agent: usize| {
            let horizon = horizon(agent);
            let before = if horizon.is_finite() { MovementAuthority::At(horizon) } else { MovementAuthority::Free };
            // The table is that of these motions; if it were not, no robot would move.
            match self.orders.hold_before(&motions, agent, &progress, before) {
                Ok(MovementAuthority::Free) => f64::INFINITY,
                Ok(MovementAuthority::At(hold)) if hold >= horizon => f64::INFINITY,
                Ok(MovementAuthority::At(hold)) => hold,
                Ok(MovementAuthority::Inside) | Err(_) => f64::NEG_INFINITY,
            }
        };
        (0..motions.len()).map(hold).collect()
    }

    /// For which agent another one waits, if it does.
    pub(super) fn waits_for(&self, agent: usize, now: &[Interval<f64>]) -> Option<usize> {
        self.orders.wait(&self.motions()?, agent, &progress(now)).ok()?.1
    }
}

fn progress(now: &[Interval<f64>]) -> Vec<Progress<f64>> {
    now.iter().map(|&at| Progress { at, stop: at.hi }).collect()
}

/// A motion for each agent: one that was left out would shift the places of those after it.
fn motions<'a>(drives: &'a [OwnedMotion], bodies: &'a [ConvexBody]) -> Result<Vec<Motion<'a, f64>>, GuardError> {
    let motion = |(place, drive): (usize, &'a OwnedMotion)| {
        bodies.get(place).and_then(|body| drive.motion_of(body)).ok_or(GuardError::Agent(place))
    };
    drives.iter().enumerate().map(motion).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use pcr_core::{Point, Pose, Radians};
    use pcr_formats::scenario::PathSegment;

    #[test]
    fn an_agent_without_a_motion_is_named_and_not_left_out() {
        let course = |y| {
            let pose = Pose { position: Point::new(0.0, y), heading: Radians(0.0) };
            SpeedLimitedPath::new(pose, &[PathSegment::Line { length: 4.0 }]).expect("a course")
        };
        let courses = [course(0.0), course(0.5), course(1.0)];
        let discs = |radii: &[f64]| radii.iter().map(|&radius| ConvexBody::Disc(radius)).collect::<Vec<_>>();
        assert_eq!(PrecedenceGuard::new(&courses, discs(&[0.3; 3])).map(|guard| guard.drives.len()), Ok(3));
        for (radii, missing) in [([0.3, f64::NAN, 0.3], 1), ([-1.0, 0.3, 0.3], 0)] {
            assert_eq!(PrecedenceGuard::new(&courses, discs(&radii)).map(|_| ()), Err(GuardError::Agent(missing)));
        }
        assert_eq!(PrecedenceGuard::new(&courses, discs(&[0.3; 2])).map(|_| ()), Err(GuardError::Agent(2)));
    }
}
