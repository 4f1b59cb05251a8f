//! Locks a folder as long as its journal is open.

use super::of;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

#[derive(Debug)]
pub(crate) struct FolderLock(File, PathBuf);

impl FolderLock {
    /// # Errors
    /// [`ErrorKind::WouldBlock`] if another process has it, and other errors of files.
    pub(super) fn acquire(path: &Path) -> io::Result<Self> {
        let own = Self::open(path)?;
        match own.try_acquire()? {
            true => Ok(own),
            false => Err(io::Error::new(ErrorKind::WouldBlock, "another supervisor has it open")),
        }
    }

    /// A lock that is not acquired yet.
    ///
    /// # Errors
    /// Errors of files.
    pub(super) fn open(path: &Path) -> io::Result<Self> {
        let file = OpenOptions::new().write(true).create(true).truncate(false).open(path).map_err(of(path))?;
        Ok(Self(file, path.to_owned()))
    }

    /// Acquires it if no other process has it, and returns whether it did.
    ///
    /// # Errors
    /// Errors of files.
    pub(crate) fn try_acquire(&self) -> io::Result<bool> {
        match self.0.try_lock() {
            Ok(()) => Ok(true),
            Err(TryLockError::WouldBlock) => Ok(false),
            Err(TryLockError::Error(error)) => Err(of(&self.1)(error)),
        }
    }

    /// Whether the locked file is still the one with its name. Otherwise another process may have locked another one.
    ///
    /// # Errors
    /// [`ErrorKind::NotFound`] if it was removed or replaced, and other errors of files.
    pub(crate) fn check(&self) -> io::Result<()> {
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt;
            let id = |file: std::fs::Metadata| (file.dev(), file.ino());
            let is_same = match std::fs::metadata(&self.1) {
                Ok(named) => id(named) == id(self.0.metadata()?),
                Err(error) if error.kind() == ErrorKind::NotFound => false,
                Err(error) => return Err(of(&self.1)(error)),
            };
            if !is_same {
                let why = "removed while the journal is open: another supervisor may be at work in the same folder";
                return Err(of(&self.1)(io::Error::new(ErrorKind::NotFound, why)));
            }
        }
        Ok(())
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
        lock.check().unwrap();
        drop(lock);
        let _again = FolderLock::acquire(&path).unwrap();
        let _ = std::fs::remove_file(&path);
    }

    /// A second supervisor could lock the new file, and both worked with one journal.
    #[test]
    #[cfg(unix)]
    fn a_file_that_was_removed_or_replaced_is_noticed() {
        let path = std::env::temp_dir().join(format!("pcr-lock-removed-{}", std::process::id()));
        let lock = FolderLock::acquire(&path).unwrap();
        lock.check().unwrap();
        std::fs::remove_file(&path).unwrap();
        let why = lock.check().unwrap_err();
        assert!(why.kind() == ErrorKind::NotFound && why.to_string().contains("another supervisor"), "{why}");
        let _other = FolderLock::acquire(&path).unwrap();
        assert_eq!(lock.check().unwrap_err().kind(), ErrorKind::NotFound);
        let _ = std::fs::remove_file(&path);
    }
}
