//! The lengths of the second segment at which some of the first one is covered.

use super::events::Carriers;
use crate::array_vec::ArrayVec;
use crate::geometry::Interval;
use crate::scalar::Scalar;

/// Largest number of intervals of a shadow. If there were more, the last one would cover the rest: what is not covered would count as covered.
pub(crate) const MOST_SHADOWS: usize = 12;

impl<S: Scalar> Carriers<'_, S> {
    /// Returns the lengths of the second segment at which some of the first one is covered, as intervals in increasing order \[m\]; all
    /// of it, if there are too many contacts.
    ///
    /// Cost: up to three slices for each event.
    // Not inlined: pairs of discs would need the stack of it.
    #[inline(never)]
    pub(crate) fn shadow(&self) -> ArrayVec<Interval<S>, MOST_SHADOWS> {
        let all = Interval::new(S::ZERO, self.second.segment.length);
        let mut parts = ArrayVec::new(all);
        let Some(events) = self.events() else {
            parts.add(all, true);
            return parts;
        };
        let beside = self.second.within(self.slack.half().half());
        let events = events.as_slice();
        let slabs = events.iter().zip(events.iter().skip(1)).map(|(&lo, &hi)| Interval::new(lo, hi));
        let mut open = false;
        for slab in slabs.filter(|slab| slab.lo < slab.hi || self.second.segment.length == S::ZERO) {
            let middle = slab.middle();
            let places = if slab.length() > beside.double() {
                [middle, slab.lo + beside, slab.hi - beside]
            } else {
                [middle; 3]
            };
            // A slab is covered or not, but for rounding.
            let covered =
                places.into_iter().any(|at| self.slice_of_first(at).is_none_or(|slice| !slice.as_slice().is_empty()));
            if covered && (open || !parts.has_room()) {
                parts.as_mut_slice().last_mut().into_iter().for_each(|last| last.hi = slab.hi);
            } else {
                parts.add(slab, covered);
            }
            open = covered;
        }
        parts
    }
}
