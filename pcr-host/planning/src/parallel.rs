//! Work on all cores. The work is given as `dyn Fn`, and results go through slots: what divides the work is compiled once, and not for
//! each type of result.

use rayon::prelude::*;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

fn each(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(work);
}

/// What is made of each place, in their order.
pub(crate) fn map_parallel<T: Send>(places: Range<usize>, make: &(dyn Fn(usize) -> T + Sync)) -> Vec<T> {
    let slots: Vec<Mutex<Option<T>>> = places.clone().map(|_| Mutex::new(None)).collect();
    each(slots.len(), &|k| {
        let made = make(places.start + k);
        *slots[k].lock().expect("nobody panics with it") = Some(made);
    });
    let made = slots.into_iter().map(|slot| slot.into_inner().ok().flatten().expect("each place was looked at"));
    made.collect()
}

/// Whether any place is one that is looked for; after the first that is found no others are looked at.
pub(crate) fn any(places: Range<usize>, is: &(dyn Fn(usize) -> bool + Sync)) -> bool {
    let found = AtomicBool::new(false);
    each(places.len(), &|k| {
        if !found.load(Ordering::Relaxed) && is(places.start + k) {
            found.store(true, Ordering::Relaxed);
        }
    });
    found.into_inner()
}
