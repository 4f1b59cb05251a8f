//! Work on all cores.
//!
//! What is made is told by a reference, so that this is compiled once for each type of a result, and not for each caller and number
//! format.

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
