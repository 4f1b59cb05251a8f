//! The last step of a speed plan: checks it, and shortens waits as far as contacts allow.

use crate::error::InvalidInput;
use crate::geometry::Interval;
use crate::motion::Motion;
use crate::plan::constraint::Constraint;
use crate::plan::lattice::SpeedLattice;
use crate::plan::result::{SpeedPlan, SpeedPlanError};
use crate::plan::search::SpeedSearch;
use crate::profile::{Phase, Profile};
use crate::query::first_conflict;
use crate::region::RegionRef;
use crate::scalar::Scalar;

/// Largest number of bisections for a wait; formats with fewer digits need fewer.
const HALVINGS: u32 = 32;

impl<'a, S: Scalar, L: SpeedLattice<S>, I: Iterator<Item = RegionRef<'a, S>> + Clone> SpeedSearch<'_, S, L, I> {
    /// Whether the plan has no conflict from a time on and breaks no constraint.
    fn is_free<const N: usize>(
        &self,
        ego: &Motion<'_, S>,
        plan: &SpeedPlan<S, N>,
        from: S,
    ) -> Result<bool, SpeedPlanError<S>> {
        let motion = ego.with_profile(plan.profile.as_profile(), plan.start)?;
        Ok(self.broken(&motion, ego.time().lo).is_none()
            && first_conflict(&motion, self.regions.clone(), self.during(&motion, from))?.is_none())
    }

    /// A constraint that a motion breaks if the agent stands at its start from a time on \[s\].
    fn broken(&self, motion: &Motion<'_, S>, from: S) -> Option<&Constraint<S>> {
        self.constraints.iter().find(|constraint| constraint.is_broken_by(motion, from))
    }

    /// The interval from a time on until all agents stand.
    fn during(&self, ego: &Motion<'_, S>, from: S) -> Interval<S> {
        let ends = self.regions.clone().map(|region| region.other_motion().time()).chain([ego.time()]);
        let all = ends.reduce(Interval::hull).unwrap_or_default();
        let from = from.max(all.lo);
        Interval::new(from, all.hi.max(from))
    }

    /// Refuses a plan with an overlap that is more than a rounding.
    pub(super) fn check<const N: usize>(
        &self,
        ego: &Motion<'_, S>,
        plan: &SpeedPlan<S, N>,
    ) -> Result<(), SpeedPlanError<S>> {
        let [start, _] = self.lattice.ends();
        let from = if start == 0 { -S::LIMIT } else { plan.start };
        let motion = ego.with_profile(plan.profile.as_profile(), plan.start)?;
        let during = self.during(&motion, from);
        if let Some(constraint) = self.broken(&motion, ego.time().lo) {
            return Err(SpeedPlanError::Constrained { length: constraint.length.lo });
        }
        let mut overlaps =
            self.regions.clone().filter_map(|region| Some((region.other(), region.overlap(&motion, during)?)));
        overlaps
            .next()
            .map_or(Ok(()), |(other, conflict)| Err(SpeedPlanError::Beyond { length: conflict.length.lo, other }))
    }

    /// Shortens the waits, beginning with the first one, as long as there is no conflict.
    pub(super) fn tighten<const N: usize>(
        &self,
        ego: &Motion<'_, S>,
        plan: &mut SpeedPlan<S, N>,
    ) -> Result<(), SpeedPlanError<S>> {
        let [start, _] = self.lattice.ends();
        if start == 0 {
            self.shorten(ego, plan, None, plan.start - ego.time().lo)?;
            // Undoes a start that is earlier by a rounding.
            plan.start = plan.start.max(ego.time().lo);
        }
        let mut place = 0_usize;
        while let Some(phase) = plan.profile.as_profile().phases().get(place) {
            let wait = phase.time().length() - self.lattice.stands_at(phase.length().hi);
            if wait > S::ZERO && phase.speed() == [S::ZERO; 2] {
                self.shorten(ego, plan, Some(place), wait)?;
            }
            place = place.saturating_add(1);
        }
        Ok(())
    }

    /// Shortens the wait before the start, or the phase with this index, which is a wait.
    fn shorten<const N: usize>(
        &self,
        ego: &Motion<'_, S>,
        plan: &mut SpeedPlan<S, N>,
        place: Option<usize>,
        wait: S,
    ) -> Result<(), SpeedPlanError<S>> {
        let end = place.and_then(|place| plan.profile.as_profile().phases().get(place)).map(|phase| phase.time().hi);
        let leaves = plan.start + end.unwrap_or_default();
        let resolution = Interval::new(ego.time().lo, ego.time().hi.max(leaves)).resolution();
        let (mut free, mut doubtful) = (S::ZERO, wait);
        let mut tried = wait;
        for _ in 0..HALVINGS {
            if doubtful - free <= resolution {
                break;
            }
            let sooner = plan.sooner(place, tried)?;
            // The motion before the wait does not change.
            if self.is_free(ego, &sooner, leaves - wait)? {
                free = tried;
            } else {
                doubtful = tried;
            }
            tried = free + (doubtful - free).half();
        }
        *plan = plan.sooner(place, free)?;
        Ok(())
    }
}

impl<S: Scalar, const N: usize> SpeedPlan<S, N> {
    /// The plan with an earlier start, or with a shorter phase at this index.
    fn sooner(&self, place: Option<usize>, by: S) -> Result<Self, InvalidInput> {
        let phases = self.profile.as_profile().phases();
        let Some(place) = place else {
            return Ok(Self { start: self.start - by, profile: self.profile.clone() });
        };
        let mut profile = Profile::standing();
        let mut last = phases.first().map_or(Phase::origin(S::ZERO), |first| Phase::origin(first.speed()[0]));
        for (k, phase) in (0..phases.len()).zip(phases) {
            let duration = phase.time().length() - if k == place { by } else { S::ZERO };
            let next = last.until(duration, phase.length().hi, phase.speed()[1], phase.acceleration());
            profile.extend(&mut last, next)?;
        }
        Ok(Self { start: self.start, profile })
    }
}
