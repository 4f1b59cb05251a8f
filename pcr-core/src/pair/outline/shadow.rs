//! The lengths of the second segment at which some of the first one is covered.

use super::events::Carriers;
use crate::array_vec::ArrayVec;
use crate::geometry::Interval;
use crate::pair::outline::walk::HALVINGS;
use crate::scalar::Scalar;

/// Largest number of intervals of a shadow. If there were more, the last one would cover the rest: what is not covered would count as covered.
pub(crate) const MOST_SHADOWS: usize = 12;

impl<S: Scalar> Carriers<'_, S> {
    /// Returns the lengths of the second segment at which some of the first one is covered, as intervals in increasing order \[m\]; all
    /// of it, if there are too many contacts.
    ///
    /// Cost: up to three slices for each event, and some more where rounding hides an end.
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
            let wide = slab.length() > beside.double();
            let [lo, hi] = if wide { [slab.lo + beside, slab.hi - beside] } else { [slab.middle(); 2] };
            // A slab is covered or not, but for rounding: beside an event at which the outlines part slowly they may still seem to touch.
            if self.covers(slab.middle()) {
                cast(&mut parts, slab, open);
                open = true;
                continue;
            }
            if wide && self.covers(lo) {
                cast(&mut parts, Interval::new(slab.lo, self.edge(lo, slab.middle(), beside)), open);
            }
            open = wide && self.covers(hi);
            if open {
                cast(&mut parts, Interval::new(self.edge(hi, slab.middle(), beside), slab.hi), false);
            }
        }
        parts
    }

    /// Whether some of the first segment is covered at a length of the second.
    fn covers(&self, at: S) -> bool {
        self.slice_of_first(at).is_none_or(|slice| !slice.as_slice().is_empty())
    }

    /// A place between one at which some is covered and one at which nothing is, from which on nothing is; within `beside` of what is covered.
    fn edge(&self, covered: S, free: S, beside: S) -> S {
        let (mut covered, mut free) = (covered, free);
        for _ in 0..HALVINGS {
            let middle = Interval::new(covered, free).middle();
            if (free - covered).abs() <= beside || middle == covered || middle == free {
                break;
            }
            if self.covers(middle) { covered = middle } else { free = middle }
        }
        free
    }
}

/// Adds an interval to a shadow, or extends the last one.
fn cast<S: Scalar>(parts: &mut ArrayVec<Interval<S>, MOST_SHADOWS>, part: Interval<S>, open: bool) {
    if (open || !parts.has_room())
        && let Some(last) = parts.as_mut_slice().last_mut()
    {
        last.hi = part.hi;
        return;
    }
    parts.add(part, true);
}
