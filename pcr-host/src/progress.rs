//! A line on the terminal that shows the progress of long work.

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// Work shorter than this is not worth a word.
const PATIENCE: Duration = Duration::from_secs(1);

/// Time between two looks at the counts.
const INTERVAL: Duration = Duration::from_millis(200);

/// Time between two lines where standard error is no terminal.
const LINES: Duration = Duration::from_secs(5);

static SILENT: AtomicBool = AtomicBool::new(false);
static REQUESTED: AtomicBool = AtomicBool::new(false);

/// From now on nothing is told.
pub(crate) fn silence() {
    SILENT.store(true, Ordering::Relaxed);
}

/// From now on the progress is told where standard error is no terminal, too, in a line every few seconds.
pub(crate) fn request() {
    REQUESTED.store(true, Ordering::Relaxed);
}

/// Tells what goes on, on standard error, if that is a terminal or it is requested, and the work takes more than a second; with a percentage and the remaining
/// time where these are known. The line is wiped when the value is dropped.
#[derive(Debug)]
pub(crate) struct ProgressLine {
    counts: Arc<ProgressCounters>,
    begin: Instant,
    running: Option<(Sender<()>, JoinHandle<()>)>,
}

#[derive(Debug, Default)]
pub(crate) struct ProgressCounters {
    pub(crate) done: AtomicUsize,
    /// 0 where it is not known.
    pub(crate) total: AtomicUsize,
    /// When the work ends at the latest, counted from its begin; milliseconds, 0 where it is not known.
    pub(crate) limit: AtomicU64,
    /// The part of the work that the counts are of, and how many milliseconds from the begin of the work it began.
    pub(crate) part: Mutex<Option<(&'static str, u64)>>,
}

impl ProgressLine {
    /// Begins to watch over some work.
    pub(crate) fn new(what: impl Into<String>) -> Self {
        let counts = Arc::<ProgressCounters>::default();
        let is_terminal = io::stderr().is_terminal();
        let told = (is_terminal || REQUESTED.load(Ordering::Relaxed)) && !SILENT.load(Ordering::Relaxed);
        let running = if told { watch(what.into(), Arc::clone(&counts), is_terminal) } else { None };
        Self { counts, begin: Instant::now(), running }
    }

    /// Begins to watch over some work that takes this long at most.
    pub(crate) fn until(what: impl Into<String>, limit: Duration) -> Self {
        let progress = Self::new(what);
        progress.counts.limit.store(u64::try_from(limit.as_millis()).unwrap_or(u64::MAX), Ordering::Relaxed);
        progress
    }

    /// Of a part of the work so many of so many things are done. Its remaining time is counted from its own begin.
    pub(crate) fn set_part(&self, part: &'static str, done: usize, total: usize) {
        let mut current = self.counts.part.lock().unwrap_or_else(PoisonError::into_inner);
        if current.is_none_or(|(name, _)| name != part) {
            *current = Some((part, u64::try_from(self.begin.elapsed().as_millis()).unwrap_or(u64::MAX)));
        }
        self.set(done, total);
    }

    /// So many of so many things are done; `total` is 0 where it is not known.
    pub(crate) fn set(&self, done: usize, total: usize) {
        self.counts.done.store(done, Ordering::Relaxed);
        self.counts.total.store(total, Ordering::Relaxed);
    }
}

/// A thread that tells until the sender is dropped. Where the system has no thread for it, nothing is told.
fn watch(what: String, counts: Arc<ProgressCounters>, is_terminal: bool) -> Option<(Sender<()>, JoinHandle<()>)> {
    let (stop, stopped) = mpsc::channel::<()>();
    let tell = move || {
        let begin = Instant::now();
        let mut wait = PATIENCE;
        while stopped.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
            wait = if is_terminal { INTERVAL } else { LINES };
            let line = line(&what, &counts, begin.elapsed());
            // A terminal that cannot be written to is no reason to stop.
            let _ = if is_terminal {
                write!(io::stderr(), "\r\x1b[K{line}")
            } else {
                writeln!(io::stderr(), "pcr: {line}")
            };
        }
        if wait == INTERVAL {
            let _ = write!(io::stderr(), "\r\x1b[K");
        }
    };
    let watch = thread::Builder::new().name("progress".into()).spawn(tell).ok()?;
    Some((stop, watch))
}

/// What is told after some time.
pub(crate) fn line(what: &str, counts: &ProgressCounters, elapsed: Duration) -> String {
    let part = *counts.part.lock().unwrap_or_else(PoisonError::into_inner);
    let (what, elapsed) = match part {
        Some((part, begin)) => (format!("{what}, {part}"), elapsed.saturating_sub(Duration::from_millis(begin))),
        None => (what.to_owned(), elapsed),
    };
    let seconds = elapsed.as_secs();
    match (counts.done.load(Ordering::Relaxed), counts.total.load(Ordering::Relaxed)) {
        (0, 0) if counts.limit.load(Ordering::Relaxed) > 0 => {
            let limit = Duration::from_millis(counts.limit.load(Ordering::Relaxed));
            let share = (100.0 * elapsed.as_secs_f64() / limit.as_secs_f64()).min(100.0);
            let rest = limit.saturating_sub(elapsed).as_secs();
            format!("{what} ({share:.0} % of the time limit, {seconds} s, {rest} s to go)")
        }
        (0, 0) => format!("{what} ({seconds} s)"),
        (done, 0) => format!("{what}: {done} ({seconds} s)"),
        (done, total) => {
            let rest = remaining(done, total, elapsed).map_or(String::new(), |rest| format!(", {rest} s to go"));
            let (share, rate) = (done.saturating_mul(100) / total, done as f64 / elapsed.as_secs_f64());
            format!("{what}: {done} of {total} ({share} %, {rate:.0} a second, {seconds} s{rest})")
        }
    }
}

/// Seconds that the rest takes if it takes as long as what is done; nothing before a hundredth is.
pub(crate) fn remaining(done: usize, total: usize, elapsed: Duration) -> Option<u64> {
    let left = total.saturating_sub(done) as f64;
    (done >= total / 100 && done > 0).then(|| (elapsed.as_secs_f64() * left / done as f64).ceil() as u64)
}

impl Drop for ProgressLine {
    fn drop(&mut self) {
        if let Some((stop, watch)) = self.running.take() {
            drop(stop);
            let _ = watch.join();
        }
    }
}
