//! A supervisor that waits for the end of another one with the same journal, and goes on in its place.
//!
//! The one at work has the lock of the journal's folder. The kernel takes it away when that process ends, however that happens, and from no process that
//! still runs: so there are never two at work. Whatever the dead one had told is in the journal, which is read anew under the lock; what was followed
//! until then only shows early whether it can be gone on with.

use crate::journal::{FolderLock, Journal, JournalContents, JournalFollower};
use crate::supervisor::JournalState;
use std::io;
use std::path::{Path, PathBuf};

/// A supervisor that waits.
#[derive(Debug)]
pub struct Standby {
    folder: PathBuf,
    lock: FolderLock,
    follower: JournalFollower,
    state: JournalState,
    /// Number of entries followed since it began.
    count: u64,
}

impl Standby {
    /// Begins to wait for the journal in a folder; both are created if they are not there.
    ///
    /// # Errors
    /// Errors of files.
    pub fn new(folder: &Path) -> io::Result<Self> {
        let lock = Journal::lock_of(folder)?;
        let follower = JournalFollower::new(folder);
        Ok(Self { folder: folder.into(), lock, follower, state: JournalState::default(), count: 0 })
    }

    /// Opens the journal if nobody else has it open any more.
    ///
    /// # Errors
    /// As [`Journal::open`].
    pub fn take_over(&mut self) -> io::Result<Option<(Journal, JournalContents)>> {
        if !self.lock.try_acquire()? {
            return Ok(None);
        }
        let other = Journal::lock_of(&self.folder)?;
        let lock = std::mem::replace(&mut self.lock, other);
        // The file may have been removed by a person: then another process may have locked a new one of its name, which is tried next.
        if lock.check().is_err() {
            return Ok(None);
        }
        Journal::open_locked(&self.folder, lock).map(Some)
    }

    /// Reads what the other one has written since.
    ///
    /// # Errors
    /// Why the journal could not be gone on with as it is now, in words.
    pub fn follow(&mut self) -> Result<(), String> {
        let news = self.follower.read_on().map_err(|error| error.to_string())?;
        if news.is_anew {
            self.state = JournalState::default();
        }
        self.count += news.entries.len() as u64;
        news.entries.into_iter().try_for_each(|entry| self.state.take(entry)).map_err(|error| error.to_string())
    }

    /// Number of robots that the other one has.
    pub fn robots(&self) -> usize {
        self.state.robots()
    }

    /// Number of entries that were read since it began to wait.
    pub fn entries(&self) -> u64 {
        self.count
    }
}
