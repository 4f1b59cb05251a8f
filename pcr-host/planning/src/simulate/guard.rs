//! Keeps the passing orders of a plan in every frame, however late a robot is.
//!
//! In the coordination space (l, l') of two robots, a plan passes each collision region on one side: one robot passes
//! first. Regions in coordination space depend on the paths alone. So robots that keep these orders do not collide,
//! whatever the times: a robot that passes second stays before all lengths that the first one still blocks on the rest
//! of its way through the region. (The same idea is called RMTRACK in: Čáp, Gregoire and Frazzoli, Provably safe and
//! deadlock-free execution of multi-robot plans under delaying disturbances, IROS 2016.)
//!
//! The discs are enlarged by the distance that robots may be off their paths. The place of a robot along its path is an
//! interval, of which the worse end is used. A robot drives only as fast as it can brake before the length at which it
//! is held, so it can still do so in the next frame.

use super::course::{Course, Drive};
use crate::fleet::{HostEcm, build_ecm};
use pcr_core::{Encounter, Full, Interval, Motion};

/// A region and who passes first.
#[derive(Clone, Copy, Debug)]
struct Order {
    first: usize,
    second: usize,
    /// Extent along the path of the first \[m\].
    first_part: Interval<f64>,
    /// Extent along the path of the second \[m\].
    second_part: Interval<f64>,
}

/// The regions of all paths in coordination space, and the passing orders.
#[derive(Debug)]
pub(super) struct Guard {
    /// At 1 m/s from time 0 on, so that times are lengths.
    drives: Vec<Drive>,
    radii: Vec<f64>,
    ecm: HostEcm<f64>,
    orders: Vec<Order>,
}

impl Guard {
    /// For discs of these radii \[m\] on these courses, without orders yet.
    ///
    /// # Errors
    /// Errors of [`build_ecm`].
    pub(super) fn new(courses: &[Course], radii: &[f64]) -> Result<Self, Full> {
        let drives: Vec<Drive> = courses.iter().filter_map(|course| Drive::at_unit_speed(course.clone())).collect();
        // The supervisor has tried the courses and radii of all robots, and parts of courses are in range as well.
        debug_assert_eq!((drives.len(), motions(&drives, radii).len()), (courses.len(), courses.len()));
        let ecm = build_ecm(&motions(&drives, radii))?;
        Ok(Self { drives, radii: radii.to_vec(), ecm, orders: Vec::new() })
    }

    /// Takes the orders of a plan without collisions. `reached(agent, length)` is the time at which the agent reaches a length of its
    /// course \[s\]; `length_at(agent, time)` is the length at which the agent is at that time \[m\]. `now` has the interval of
    /// lengths in which each robot is now. `None` if the plan does not tell which agent passes a region first.
    pub(super) fn take_orders(
        &mut self,
        now: &[Interval<f64>],
        reached: impl Fn(usize, f64) -> f64,
        length_at: impl Fn(usize, f64) -> f64,
    ) -> Option<()> {
        let motions = motions(&self.drives, &self.radii);
        let mut orders = Vec::new();
        for (other, at) in now.iter().enumerate() {
            for ego in 0..other {
                // Two courses without length have no passing order.
                if [ego, other].iter().all(|&place| motions.get(place).is_some_and(|it| it.path().length() <= 0.0)) {
                    continue;
                }
                for region in self.ecm.pair(&motions, ego, other).expect("the table of the fleet") {
                    let (own, their) = (region.length(), region.other_length());
                    if now.get(ego).is_some_and(|ego| ego.lo > own.hi) || at.lo > their.hi {
                        continue;
                    }
                    // A point of the region that is still ahead of the other one; the whole region is on one side.
                    let ahead = Interval::new(at.lo.clamp(their.lo, their.hi), their.hi).middle();
                    let point = region.slice_at(ahead).next().map(Interval::middle)?;
                    let ego_is_behind = length_at(ego, reached(other, ahead)) < point;
                    let parts = if ego_is_behind { (other, their, ego, own) } else { (ego, own, other, their) };
                    let (first, first_part, second, second_part) = parts;
                    orders.push(Order { first, second, first_part, second_part });
                }
            }
        }
        self.orders = orders;
        Some(())
    }

    /// The length \[m\] at which each agent is held, infinite where it is not up to its `horizon`, with the agents in these
    /// intervals.
    pub(super) fn holds(&self, now: &[Interval<f64>], horizon: impl Fn(usize) -> f64) -> Vec<f64> {
        let motions = motions(&self.drives, &self.radii);
        let mut holds = vec![f64::INFINITY; motions.len()];
        for order in &self.orders {
            let (Some(first), Some(second)) = (motions.get(order.first), motions.get(order.second)) else { continue };
            let Some(at) = now.get(order.first).map(|at| at.lo.max(order.first_part.lo)) else { continue };
            if at > order.first_part.hi || order.second_part.lo > horizon(order.second) {
                continue;
            }
            let rest = Interval::new(at, order.first_part.hi);
            let encounter = Encounter::new(second, first);
            let blocked = encounter.blocked_lengths(rest).filter(|part| part.meets(order.second_part));
            let lowest = blocked.map(|part| part.lo.max(order.second_part.lo)).fold(f64::INFINITY, f64::min);
            if let Some(hold) = holds.get_mut(order.second) {
                *hold = hold.min(lowest);
            }
        }
        holds
    }
}

fn motions<'a>(drives: &'a [Drive], radii: &[f64]) -> Vec<Motion<'a, f64>> {
    drives.iter().zip(radii).filter_map(|(drive, &radius)| drive.motion(radius)).collect()
}
