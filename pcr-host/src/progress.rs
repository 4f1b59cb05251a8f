//! A line on the terminal that shows the progress of long work.

use std::io::{self, IsTerminal, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Work shorter than this is not worth a word.
const PATIENCE: Duration = Duration::from_secs(1);

/// Time between two looks at the counts.
const INTERVAL: Duration = Duration::from_millis(200);

static SILENT: AtomicBool = AtomicBool::new(false);

/// From now on nothing is told.
pub(crate) fn silence() {
    SILENT.store(true, Ordering::Relaxed);
}

/// Tells what goes on, on standard error, if that is a terminal and the work takes more than a second. The line is
/// wiped when the value is dropped.
#[derive(Debug)]
pub(crate) struct Progress {
    counts: Arc<Counts>,
    running: Option<(Sender<()>, JoinHandle<()>)>,
}

#[derive(Debug, Default)]
struct Counts {
    done: AtomicUsize,
    /// 0 where it is not known.
    total: AtomicUsize,
}

impl Progress {
    /// Begins to watch over some work.
    pub(crate) fn new(what: impl Into<String>) -> Self {
        let counts = Arc::<Counts>::default();
        let told = io::stderr().is_terminal() && !SILENT.load(Ordering::Relaxed);
        let running = if told { watch(what.into(), Arc::clone(&counts)) } else { None };
        Self { counts, running }
    }

    /// So many of so many things are done; `total` is 0 where it is not known.
    pub(crate) fn set(&self, done: usize, total: usize) {
        self.counts.done.store(done, Ordering::Relaxed);
        self.counts.total.store(total, Ordering::Relaxed);
    }
}

/// A thread that tells until the sender is dropped. Where the system has no thread for it, nothing is told.
fn watch(what: String, counts: Arc<Counts>) -> Option<(Sender<()>, JoinHandle<()>)> {
    let (stop, stopped) = mpsc::channel::<()>();
    let tell = move || {
        let begin = Instant::now();
        let mut wait = PATIENCE;
        while stopped.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
            wait = INTERVAL;
            show(&what, &counts, begin.elapsed());
        }
        if wait == INTERVAL {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    };
    let watch = thread::Builder::new().name("progress".into()).spawn(tell).ok()?;
    Some((stop, watch))
}

/// A terminal that cannot be written to is no reason to stop.
fn show(what: &str, counts: &Counts, elapsed: Duration) {
    let seconds = elapsed.as_secs();
    let _ = match (counts.done.load(Ordering::Relaxed), counts.total.load(Ordering::Relaxed)) {
        (0, 0) => write!(io::stderr(), "\r\x1b[K{what} ({seconds} s)"),
        (done, 0) => write!(io::stderr(), "\r\x1b[K{what}: {done} ({seconds} s)"),
        (done, total) => {
            let rest = remaining(done, total, elapsed).map_or(String::new(), |rest| format!(", {rest} s to go"));
            let (share, rate) = (done.saturating_mul(100) / total, done as f64 / elapsed.as_secs_f64());
            write!(io::stderr(), "\r\x1b[K{what}: {done} of {total} ({share} %, {rate:.0} a second, {seconds} s{rest})")
        }
    };
}

/// Seconds that the rest takes if it takes as long as what is done; nothing before a hundredth is.
pub(crate) fn remaining(done: usize, total: usize, elapsed: Duration) -> Option<u64> {
    let left = total.saturating_sub(done) as f64;
    (done >= total / 100 && done > 0).then(|| (elapsed.as_secs_f64() * left / done as f64).ceil() as u64)
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((stop, watch)) = self.running.take() {
            drop(stop);
            let _ = watch.join();
        }
    }
}
