//! Reads the journal of another process while that one writes it.

use super::{ANEW, FIRST, FRAME, HEADER, JournalDamage, VERSION, length, of, text, word};
use crate::journal_entry::JournalEntry;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Reads a journal frame by frame, as they come. What it has read is not proved to be on the disk: whoever goes on with the journal opens it.
#[derive(Debug)]
pub struct JournalFollower {
    path: PathBuf,
    /// The file that is being read, and what tells it from one that takes its place.
    file: Option<(File, [u64; 2])>,
    /// End of the frames that were read \[bytes\].
    end: u64,
    /// Checksum of the last one.
    sum: u32,
}

/// What has come since the last look.
#[derive(Debug, Default)]
pub struct FollowedEntries {
    /// Whether the journal was begun anew: these are all entries.
    pub is_anew: bool,
    /// The entries, oldest first.
    pub entries: Vec<JournalEntry>,
}

impl JournalFollower {
    /// Begins with the first frame of the journal in a folder, which may come only later.
    pub fn new(folder: &Path) -> Self {
        Self { path: folder.join("journal"), file: None, end: 0, sum: FIRST }
    }

    /// Reads the frames that are complete by now.
    ///
    /// # Errors
    /// [`ErrorKind::InvalidData`] for a journal of another version and for a frame that does not follow the one before it; and other errors of
    /// files. Where only a part of a frame is there, that is no error: the rest comes, or nobody was told of it.
    pub fn read_on(&mut self) -> io::Result<FollowedEntries> {
        let mut news = FollowedEntries::default();
        let there = match fs::metadata(&self.path) {
            Ok(there) => identity(&there),
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(news),
            Err(error) => return Err(of(&self.path)(error)),
        };
        if self.file.as_ref().is_none_or(|(_, known)| *known != there) {
            let file = File::open(&self.path).map_err(of(&self.path))?;
            // The name may be that of another file since it was looked at.
            let id = identity(&file.metadata().map_err(of(&self.path))?);
            (self.file, self.end, self.sum) = (Some((file, id)), 0, FIRST);
            news.is_anew = true;
        }
        let read = self.read(&mut news.entries);
        if read.is_err() {
            // From the first frame on, next time.
            self.file = None;
        }
        read.map_err(of(&self.path)).map(|()| news)
    }

    fn read(&mut self, entries: &mut Vec<JournalEntry>) -> io::Result<()> {
        let Some((file, _)) = &mut self.file else { return Ok(()) };
        let damaged = |why: JournalDamage| io::Error::new(ErrorKind::InvalidData, why);
        if self.end == 0 {
            let Some(header) = part(file, 0, HEADER.len())? else { return Ok(()) };
            if header != HEADER && header != ANEW {
                let version = |header: &[u8]| word(header, VERSION).map_or(0, |word| word & 0xff_ffff);
                let is_journal = header[..VERSION] == HEADER[..VERSION];
                let [own, version] = [&header[..], HEADER].map(version);
                return Err(damaged(if is_journal {
                    JournalDamage::Version { own, version }
                } else {
                    JournalDamage::NoJournal
                }));
            }
            self.end = HEADER.len() as u64;
        }
        while let Some(mut frame) = part(file, self.end, FRAME)? {
            // Zeros, or a part of a head.
            let Some(size) = length(&frame) else { break };
            let Some(rest) = part(file, self.end + FRAME as u64, size)? else { break };
            frame.extend(rest);
            let Ok((text, before, sum)) = text(&frame) else { break };
            let byte = usize::try_from(self.end).unwrap_or(usize::MAX);
            let wrong = |why: String| damaged(JournalDamage::Frame { byte, why });
            if before != self.sum {
                return Err(wrong("entries that do not follow those before them".into()));
            }
            let batch: Vec<JournalEntry> = serde_json::from_slice(text).map_err(|error| wrong(error.to_string()))?;
            entries.extend(batch);
            (self.end, self.sum) = (self.end + frame.len() as u64, sum);
        }
        Ok(())
    }
}

/// A part of a file; `None` if it ends before.
fn part(file: &mut File, from: u64, size: usize) -> io::Result<Option<Vec<u8>>> {
    file.seek(SeekFrom::Start(from))?;
    let mut bytes = Vec::new();
    file.take(size as u64).read_to_end(&mut bytes)?;
    Ok((bytes.len() == size).then_some(bytes))
}

#[cfg(unix)]
fn identity(file: &fs::Metadata) -> [u64; 2] {
    use std::os::unix::fs::MetadataExt;
    [file.dev(), file.ino()]
}

/// Where files have no numbers, one that is open is not replaced.
#[cfg(not(unix))]
fn identity(_: &fs::Metadata) -> [u64; 2] {
    [0; 2]
}
