//! Long runs over numbered cases: on all processors, and in every number format.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

/// What so many cases come to, from a first one on.
pub type CaseRange<T> = fn(u64, u64) -> T;

/// A function of a number format in each of them, with its name.
macro_rules! in_every_format {
    ($function:ident) => {
        $crate::case_ranges::in_every_format!($function; f64, f32, pcr_core::scalar::Micro, pcr_fixed::Q20, pcr_fixed::Q16, pcr_fixed::Q12)
    };
    ($function:ident; $($format:ty),*) => {
        [$((<$format as pcr_planning::fleet::HostScalar>::NAME, $function::<$format>)),*]
    };
}
pub(crate) use in_every_format;

/// What runs over many cases come to together.
pub trait Total: Default + Send {
    /// Counts another run as well.
    fn add(&mut self, other: &Self);
}

/// The same on all processors. What a batch of the cases has come to is told beside the sum of those that were done.
pub fn run_on_all_processors<T: Total>(
    run: impl Fn(u64, u64) -> T + Sync,
    first: u64,
    count: u64,
    tell: impl Fn(&T, &T) + Sync,
) -> T {
    // Few are long ones.
    let size = (count / 64).clamp(1, 1_000);
    let (next, total) = (AtomicU64::new(0), Mutex::new(T::default()));
    let work = || {
        loop {
            let done = next.fetch_add(size, Ordering::Relaxed);
            if done >= count {
                break;
            }
            let batch = run(first.wrapping_add(done), size.min(count - done));
            let mut total = total.lock().expect("no thread panics with it");
            total.add(&batch);
            tell(&batch, &total);
        }
    };
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    total.into_inner().expect("no thread panics with it")
}
