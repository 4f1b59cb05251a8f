//! Safe intervals of large fleets: the windows of all agents are stored, sorted and merged.

use pcr_core::{Encounter, Interval, MismatchError, Motion, Scalar, gaps};
use std::cmp::Ordering;

/// What [`pcr_core::safe_intervals`] finds, to the bit. That has no storage, and asks all agents for each interval anew.
///
/// # Errors
/// [`MismatchError::NoSuchAgent`].
pub fn safe_intervals<S: Scalar>(
    fleet: &[Motion<'_, S>],
    ego: usize,
    length: Interval<S>,
    during: Interval<S>,
) -> Result<Vec<Interval<S>>, MismatchError> {
    // As there, ends that are the wrong way round are swapped.
    let during = if during.hi < during.lo { Interval::new(during.hi, during.lo) } else { during };
    let own = fleet.get(ego).ok_or(MismatchError::NoSuchAgent(ego))?;
    let others = fleet.iter().enumerate().filter(|&(other, _)| other != ego);
    let mut blocked: Vec<_> =
        others.flat_map(|(_, other)| Encounter::new(own, other).blocked(length, during)).collect();
    blocked.sort_unstable_by(|a, b| a.lo.partial_cmp(&b.lo).unwrap_or(Ordering::Equal));
    blocked.dedup_by(|next, last| {
        let meets = last.meets(*next);
        if meets {
            *last = last.hull(*next);
        }
        meets
    });
    Ok(gaps(blocked.into_iter(), during).collect())
}
