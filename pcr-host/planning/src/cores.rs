//! Work on all cores. The work is given as `dyn Fn`, so that this is compiled once for each type of result, not for each caller.

use rayon::prelude::*;
use std::ops::Range;

/// What is made of each place, in their order.
pub(crate) fn made<T: Send>(places: Range<usize>, make: &(dyn Fn(usize) -> T + Sync)) -> Vec<T> {
    places.into_par_iter().map(make).collect()
}

/// Whether any place is one that is looked for; the work ends with the first that is found.
pub(crate) fn any(places: Range<usize>, is: &(dyn Fn(usize) -> bool + Sync)) -> bool {
    places.into_par_iter().any(is)
}
