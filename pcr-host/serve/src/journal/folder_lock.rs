//! Locks a folder as long as its journal is open.

use super::of;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind};
use std::path::Path;

#[derive(Debug)]
pub(super) struct FolderLock(File);

impl FolderLock {
    /// # Errors
    /// [`ErrorKind::WouldBlock`] if another process has it, and other errors of files.
    pub(super) fn acquire(path: &Path) -> io::Result<Self> {
        let file = OpenOptions::new().write(true).create(true).truncate(false).open(path).map_err(of(path))?;
        file.try_lock().map_err(|error| match error {
            TryLockError::WouldBlock => io::Error::new(ErrorKind::WouldBlock, "another supervisor has it open"),
            TryLockError::Error(error) => error,
        })?;
        Ok(Self(file))
    }
}

/// A process that is just being started has a copy of the open file: if ours is only closed, the lock stays until that copy is closed.
impl Drop for FolderLock {
    fn drop(&mut self) {
        let _ = self.0.unlock();
    }
}

#[cfg(test)]
mod tests {
    use super::FolderLock;
    use std::io::ErrorKind;

    #[test]
    fn ends_while_another_process_has_a_copy_of_the_file() {
        let path = std::env::temp_dir().join(format!("pcr-lock-{}", std::process::id()));
        let lock = FolderLock::acquire(&path).unwrap();
        assert_eq!(FolderLock::acquire(&path).unwrap_err().kind(), ErrorKind::WouldBlock);
        let _copy = lock.0.try_clone().unwrap();
        drop(lock);
        let _again = FolderLock::acquire(&path).unwrap();
        let _ = std::fs::remove_file(&path);
    }
}
