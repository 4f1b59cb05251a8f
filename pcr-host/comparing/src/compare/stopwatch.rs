//! Measures the time of work on one core. On a machine that is busy with other work, long computations are interrupted
//! and short ones are not. For fair ratios, long computations are measured in processor time, if the system reports it.
//! Short ones would be measured with caches that other work has filled, so they are repeated.

use std::fs;
use std::hint::black_box;
use std::time::Instant;

/// Work from here on is long \[s\]: the system counts in ticks of 1 to 10 ms.
const LONG: f64 = 0.04;

/// Work that is over before is repeated for about as long \[s\].
const SHORT: f64 = 0.005;

/// Most repetitions.
const MOST: f64 = 10_000.0;

/// The time that work takes \[s\] by `clock`, and what it makes. Short work counts by the mean of its repetitions, without the
/// first time.
pub fn steady<T>(clock: fn(&Stopwatch) -> f64, mut work: impl FnMut() -> T) -> (f64, T) {
    let watch = Stopwatch::start();
    let made = black_box(work());
    let first = clock(&watch);
    if first >= SHORT {
        return (first, made);
    }
    let times = (SHORT / first).ceil().min(MOST);
    let watch = Stopwatch::start();
    let made = (0..times as u32).fold(made, |_, _| black_box(work()));
    (clock(&watch) / times, made)
}

/// A running clock of this thread.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    begin: Instant,
    spent: Option<f64>,
}

impl Stopwatch {
    /// Starts it.
    pub fn start() -> Self {
        let spent = spent();
        Self { begin: Instant::now(), spent }
    }

    /// \[s\]
    pub fn elapsed(&self) -> f64 {
        let elapsed = self.wall();
        if elapsed < LONG {
            return elapsed;
        }
        let busy = self.spent.and_then(|before| Some(spent()? - before));
        busy.map_or(elapsed, |busy| busy.min(elapsed))
    }

    /// The same by the clock on the wall, for work of several threads \[s\].
    pub fn wall(&self) -> f64 {
        self.begin.elapsed().as_secs_f64()
    }
}

/// Time that the processor has spent on this thread so far \[s\].
fn spent() -> Option<f64> {
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split(' ').next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How often work is done, and the time that counts, if a clock shows this.
    fn runs(clock: fn(&Stopwatch) -> f64) -> (u32, f64) {
        let mut count = 0;
        let (time, last) = steady(clock, || {
            count += 1;
            count
        });
        assert_eq!(last, count, "what it made the last time");
        (count, time)
    }

    #[test]
    fn long_work_is_done_once_and_short_work_again_and_again() {
        assert_eq!(runs(|_| SHORT), (1, SHORT));
        assert_eq!(runs(|_| 0.3 * SHORT), (1 + 4, 0.3 * SHORT / 4.0));
        assert_eq!(runs(|_| 0.0), (1 + MOST as u32, 0.0));
    }
}
