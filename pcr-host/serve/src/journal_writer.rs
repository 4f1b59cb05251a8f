//! A journal that is written by a thread of its own. Entries that arrive during one write to the disk are collected for
//! the next write. Messages are sent only after [`WriteProgress`] says that their entries are on the disk.

use crate::journal_entry::{JournalEntry, JournalStore};
use crate::request_error::RequestError;
use std::io;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

enum WriteTask {
    Keep(Vec<JournalEntry>),
    Restart(Vec<JournalEntry>),
}

#[derive(Debug, Default)]
struct WriterState {
    /// Number of batches handed over.
    asked: AtomicU64,
    /// Number of batches on the disk; or the reason why no more will be written.
    done: Mutex<(u64, Option<String>)>,
    more: Condvar,
    is_long: AtomicBool,
}

/// The progress of a journal. A journal without a thread of its own has always written everything.
#[derive(Clone, Debug, Default)]
pub struct WriteProgress {
    shared: Arc<WriterState>,
}

impl WriteProgress {
    /// Number of batches handed over.
    pub fn asked(&self) -> u64 {
        self.shared.asked.load(Ordering::Acquire)
    }

    /// Number of batches on the disk.
    ///
    /// # Errors
    /// [`RequestError::Broken`]: no more will be written.
    pub fn done(&self) -> Result<u64, RequestError> {
        let done = self.shared.done.lock().unwrap_or_else(PoisonError::into_inner);
        done.1.clone().map_or(Ok(done.0), |why| Err(RequestError::Broken { why }))
    }

    /// Waits until all batches that were handed over are on the disk.
    ///
    /// # Errors
    /// [`RequestError::Broken`].
    pub fn wait(&self) -> Result<(), RequestError> {
        let asked = self.asked();
        let done = self.shared.done.lock().unwrap_or_else(PoisonError::into_inner);
        let done = self.shared.more.wait_while(done, |(done, why)| *done < asked && why.is_none());
        let done = done.unwrap_or_else(PoisonError::into_inner);
        done.1.clone().map_or(Ok(()), |why| Err(RequestError::Broken { why }))
    }

    /// Waits until more is on the disk, or no more will be written, but no longer than a time.
    pub(crate) fn wait_for(&self, time: Duration) {
        let done = self.shared.done.lock().unwrap_or_else(PoisonError::into_inner);
        let before = done.0;
        let more = self.shared.more.wait_timeout_while(done, time, |(done, why)| *done == before && why.is_none());
        drop(more);
    }
}

/// Hands entries over to the thread. Nothing in them may be told before [`WriteProgress`] says that they are on the disk.
#[derive(Debug)]
pub struct JournalWriter {
    sender: Option<Sender<WriteTask>>,
    thread: Option<JoinHandle<()>>,
    kept: WriteProgress,
}

impl JournalWriter {
    /// Starts the thread; `wake` is called after each write.
    ///
    /// # Errors
    /// The thread cannot be started.
    pub fn start(mut keeper: Box<dyn JournalStore>, wake: impl Fn() + Send + 'static) -> io::Result<Self> {
        let (sender, jobs) = channel();
        let kept = WriteProgress::default();
        let own = kept.clone();
        let work = move || {
            while write_pending(&mut *keeper, &jobs, &own) {
                wake();
            }
            // Threads that wait see the error of a failed write.
            wake();
        };
        let thread = std::thread::Builder::new().name("journal".into()).spawn(work);
        let thread = thread
            .map_err(|error| io::Error::new(error.kind(), format!("no thread can be started for it: {error}")))?;
        Ok(Self { sender: Some(sender), thread: Some(thread), kept })
    }

    /// The progress of the writer.
    pub fn kept(&self) -> WriteProgress {
        self.kept.clone()
    }

    fn hand(&mut self, job: WriteTask) -> io::Result<()> {
        self.kept.done().map_err(|fault| io::Error::other(fault.to_string()))?;
        let ended = || io::Error::other("the thread that writes the journal has ended");
        self.sender.as_ref().ok_or_else(ended)?.send(job).map_err(|_| ended())?;
        self.kept.shared.asked.fetch_add(1, Ordering::AcqRel);
        Ok(())
    }
}

impl JournalStore for JournalWriter {
    fn keep(&mut self, entries: &[JournalEntry]) -> io::Result<()> {
        self.hand(WriteTask::Keep(entries.to_vec()))
    }

    fn is_long(&self) -> bool {
        self.kept.shared.is_long.load(Ordering::Relaxed)
    }

    fn restart(&mut self, entries: &[JournalEntry]) -> io::Result<()> {
        self.kept.shared.is_long.store(false, Ordering::Relaxed);
        self.hand(WriteTask::Restart(entries.to_vec()))
    }
}

impl Drop for JournalWriter {
    fn drop(&mut self) {
        self.sender = None;
        if let Some(thread) = self.thread.take() {
            // All batches are written. A thread that panics has printed its own message.
            let _ = thread.join();
        }
    }
}

/// Writes all that was handed over; `false`: nothing more will come, or nothing more can be written.
fn write_pending(keeper: &mut dyn JournalStore, jobs: &Receiver<WriteTask>, kept: &WriteProgress) -> bool {
    let Ok(first) = jobs.recv() else { return false };
    let (mut fresh, mut entries, mut count) = (None, Vec::new(), 0);
    for job in std::iter::once(first).chain(jobs.try_iter()) {
        count += 1;
        match job {
            WriteTask::Keep(more) => entries.extend(more),
            // The new journal has all entries from before.
            WriteTask::Restart(all) => (fresh, entries) = (Some(all), Vec::new()),
        }
    }
    let begun = fresh.map_or(Ok(()), |all| keeper.restart(&all));
    let written = begun.and_then(|()| if entries.is_empty() { Ok(()) } else { keeper.keep(&entries) });
    kept.shared.is_long.store(written.is_ok() && keeper.is_long(), Ordering::Relaxed);
    let mut done = kept.shared.done.lock().unwrap_or_else(PoisonError::into_inner);
    match &written {
        Ok(()) => done.0 += count,
        Err(error) => done.1 = Some(error.to_string()),
    }
    kept.shared.more.notify_all();
    written.is_ok()
}
