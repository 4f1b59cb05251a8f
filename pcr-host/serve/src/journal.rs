//! A file of entries to which the program only appends. A batch of entries is a frame with a length, checksums and JSON; it
//! is on the disk before anything in it is sent to anyone.
//!
//! The checksum of each frame is over that of the frame before it, which is in the frame, too. So frames that are
//! repeated, left out or in another order are damage.
//!
//! If the process or the power fails, the last frame may be incomplete; nothing in it has been sent yet, so it is
//! ignored. Any other error is damage, and the journal is refused.
//!
//! Zeros follow the last frame, because overwriting them reaches the disk sooner than extending a file. So the missing
//! part of an incomplete frame is zeros, and a complete frame has zeros only in its first bytes. A last frame that is
//! wrong in any other way was complete once, and its contents have been sent.
//!
//! A journal that was begun anew has the whole state in its first frame, and was on the disk before it replaced the
//! journal before it. Its last byte of the header says so: if its first frame is incomplete, that is damage.
//!
//! A journal of the version before has the same frames, and fewer kinds of entries. When it is opened, its frames get the present header, and
//! the file as it was stays beside it. So a program of the version before never reads entries that it does not know.

mod folder_lock;
mod follower;

pub(crate) use folder_lock::FolderLock;
pub use follower::{FollowedEntries, JournalFollower};

use crate::journal_entry::{JournalEntry, JournalStore};
use std::fmt;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// First bytes of a journal: its kind, the version of its frames and entries, and in the last byte whether it was begun anew.
pub const HEADER: &[u8; 16] = b"pcr-journal\0\x04\0\0\0";

/// First bytes of a journal that was begun anew. (No single bit makes one of the two headers of the other one.)
pub const ANEW: &[u8; 16] = b"pcr-journal\0\x04\0\0\xff";

/// The version before, which is read, too. (Two versions in a row differ in no single bit.)
const BEFORE: u32 = 3;

/// Where the version is in a header.
const VERSION: usize = 12;

/// Size of a frame's head: length, checksum of the frame before, checksum of these two, and checksum of all the rest of the frame.
const FRAME: usize = 16;

/// Size of the part of the head that is checked before the length is used.
const BEGIN: usize = 12;

/// Largest size of a frame \[bytes\].
const LONGEST: usize = 1 << 28;

/// A new journal is begun when the file is larger than the first number \[bytes\], and larger than the second number times the state with
/// which it was begun anew.
const LONG: (u64, u64) = (16 << 20, 8);

/// Zeros by which the file is extended at a time \[bytes\].
const ROOM: u64 = 1 << 18;

/// The content of a journal.
#[derive(Debug)]
pub struct JournalContents {
    /// The entries, oldest first.
    pub entries: Vec<JournalEntry>,
    /// Size of an incomplete last frame, which is left out \[bytes\].
    pub torn: u64,
    /// The file of a journal of the version before, as it was; `None` if the journal was of the present version.
    pub former: Option<PathBuf>,
}

/// An open journal; no other process can open it.
#[derive(Debug)]
pub struct Journal {
    folder: PathBuf,
    file: File,
    lock: FolderLock,
    /// End of its frames \[bytes\].
    len: u64,
    /// End of the state with which it was begun \[bytes\].
    first: u64,
    /// Checksum of the last frame.
    sum: u32,
    /// End of its zeros \[bytes\].
    end: u64,
    /// Whether a write failed: the content of the disk is then unknown.
    failed: bool,
}

impl Journal {
    /// Opens the journal in a folder, or creates one there.
    ///
    /// # Errors
    /// [`ErrorKind::WouldBlock`] if another process has it open, [`ErrorKind::InvalidData`] if it is damaged or of another
    /// version, and other errors of files.
    pub fn open(folder: &Path) -> io::Result<(Self, JournalContents)> {
        fs::create_dir_all(folder).map_err(of(folder))?;
        let lock = FolderLock::acquire(&folder.join("lock"))?;
        Self::open_locked(folder, lock)
    }

    /// The lock of a folder, which is made; it is not acquired.
    ///
    /// # Errors
    /// Errors of files.
    pub(crate) fn lock_of(folder: &Path) -> io::Result<FolderLock> {
        fs::create_dir_all(folder).map_err(of(folder))?;
        FolderLock::open(&folder.join("lock"))
    }

    /// Opens the journal in a folder whose lock was acquired.
    ///
    /// # Errors
    /// As [`Journal::open`].
    pub(crate) fn open_locked(folder: &Path, lock: FolderLock) -> io::Result<(Self, JournalContents)> {
        let path = folder.join("journal");
        if !path.try_exists().map_err(of(&path))? {
            written(folder, HEADER)?;
        }
        let mut file = OpenOptions::new().read(true).write(true).open(&path).map_err(of(&path))?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(of(&path))?;
        let ParsedFrames { entries, first, end: len, sum, is_former } =
            read(&bytes).map_err(|why| io::Error::new(ErrorKind::InvalidData, why))?;
        let former = is_former.then(|| folder.join(format!("journal.{BEFORE}")));
        if let Some(former) = &former {
            file = converted(folder, &bytes[..len], former)?;
        }
        let torn = bytes[len..].iter().rposition(|byte| *byte != 0).map_or(0, |last| last as u64 + 1);
        let (first, len) = (first as u64, len as u64);
        // The bytes of an incomplete frame are removed, because the next frame begins there.
        file.set_len(len).and_then(|()| file.sync_all()).map_err(of(&path))?;
        file.seek(SeekFrom::Start(len))?;
        let own = Self { folder: folder.into(), file, lock, len, first, sum, end: len, failed: false };
        Ok((own, JournalContents { entries, torn, former }))
    }

    /// Adds a frame, and returns when it is on the disk. After an error any part of it may be there.
    fn add(&mut self, frame: &[u8]) -> io::Result<()> {
        self.lock.check()?;
        let len = self.len + frame.len() as u64;
        if len > self.end {
            let end = len + ROOM;
            self.file.seek(SeekFrom::Start(self.end))?;
            self.file.write_all(&vec![0; (end - self.end) as usize])?;
            self.file.sync_all()?;
            self.file.seek(SeekFrom::Start(self.len))?;
            self.end = end;
        }
        self.file.write_all(frame)?;
        self.file.sync_data()?;
        self.len = len;
        Ok(())
    }
}

impl JournalStore for Journal {
    fn keep(&mut self, entries: &[JournalEntry]) -> io::Result<()> {
        if self.failed {
            return Err(io::Error::other("an earlier write has failed"));
        }
        let (frame, sum) = frame(entries, self.sum)?;
        self.failed = true;
        self.add(&frame).map_err(of(&self.folder.join("journal")))?;
        (self.sum, self.failed) = (sum, false);
        Ok(())
    }

    fn is_long(&self) -> bool {
        self.len > LONG.0.max(LONG.1 * self.first)
    }

    fn restart(&mut self, entries: &[JournalEntry]) -> io::Result<()> {
        if self.failed {
            return Err(io::Error::other("an earlier write has failed"));
        }
        let (frame, sum) = frame(entries, FIRST)?;
        self.failed = true;
        self.lock.check()?;
        let bytes = [ANEW.as_slice(), &frame].concat();
        written(&self.folder, &bytes)?;
        (self.len, self.sum) = (bytes.len() as u64, sum);
        (self.first, self.end) = (self.len, self.len);
        self.file = OpenOptions::new().write(true).open(self.folder.join("journal"))?;
        self.file.seek(SeekFrom::Start(self.len))?;
        self.failed = false;
        Ok(())
    }
}

/// An error with the name of the file.
fn of(path: &Path) -> impl Fn(io::Error) -> io::Error {
    move |error| io::Error::new(error.kind(), format!("{}: {error}", path.display()))
}

/// Replaces the journal by one with these bytes, atomically.
fn written(folder: &Path, bytes: &[u8]) -> io::Result<()> {
    let (new, path) = (folder.join("journal.new"), folder.join("journal"));
    let create = || {
        let mut file = File::create(&new)?;
        file.write_all(bytes)?;
        file.sync_all()
    };
    create().map_err(of(&new))?;
    fs::rename(&new, &path).map_err(of(&path))?;
    // The new name is on the disk when the folder is.
    File::open(folder).and_then(|folder| folder.sync_all()).map_err(of(folder))
}

/// Gives the frames of a journal of the version before the present header, and keeps the file as it was under another name. If this ends
/// halfway, the journal is still the former one.
fn converted(folder: &Path, frames: &[u8], former: &Path) -> io::Result<File> {
    let path = folder.join("journal");
    fs::copy(&path, former).and_then(|_| File::open(former)?.sync_all()).map_err(of(former))?;
    let header = if frames[HEADER.len() - 1] == ANEW[HEADER.len() - 1] { ANEW } else { HEADER };
    written(folder, &[header.as_slice(), &frames[HEADER.len()..]].concat())?;
    OpenOptions::new().read(true).write(true).open(&path).map_err(of(&path))
}

/// In the first frame, stands for the checksum of a frame before.
pub const FIRST: u32 = 0;

/// A frame with a batch of entries, after a frame with the checksum `before`; and the checksum of the new frame.
///
/// # Errors
/// [`ErrorKind::InvalidInput`] for a batch that is too long.
pub fn frame(entries: &[JournalEntry], before: u32) -> io::Result<(Vec<u8>, u32)> {
    let text = serde_json::to_vec(entries)?;
    let length = u32::try_from(text.len()).ok().filter(|length| *length as usize <= LONGEST);
    let length = length.ok_or_else(|| io::Error::new(ErrorKind::InvalidInput, "too many entries at once"))?;
    let mut frame = Vec::with_capacity(FRAME + text.len());
    frame.extend(length.to_le_bytes());
    frame.extend(before.to_le_bytes());
    frame.extend(crc32fast::hash(&frame).to_le_bytes());
    let sum = sum(&frame, &text);
    frame.extend(sum.to_le_bytes());
    frame.extend(text);
    Ok((frame, sum))
}

/// The checksum of a frame, from the first [`BEGIN`] bytes of its head and from its entries.
fn sum(begin: &[u8], text: &[u8]) -> u32 {
    let mut sum = crc32fast::Hasher::new();
    sum.update(begin);
    sum.update(text);
    sum.finalize()
}

/// The parsed content of a journal.
#[derive(Debug)]
pub struct ParsedFrames {
    /// The entries, oldest first.
    pub entries: Vec<JournalEntry>,
    /// End of the state with which it was begun: of the first frame, if it was begun anew.
    pub first: usize,
    /// End of the last complete frame.
    pub end: usize,
    /// Its checksum.
    pub sum: u32,
    /// Whether the journal is of the version before.
    pub is_former: bool,
}

/// Why the bytes of a journal cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum JournalDamage {
    /// They do not begin as those of a journal.
    NoJournal,
    /// They are of another version.
    Version {
        /// Version of the journal.
        own: u32,
        /// Version that is read.
        version: u32,
    },
    /// A frame is damaged.
    Frame {
        /// Where it begins.
        byte: usize,
        /// What is wrong with it.
        why: String,
    },
}

impl fmt::Display for JournalDamage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoJournal => f.write_str("it is no journal"),
            Self::Version { own, version } => {
                write!(
                    f,
                    "it is of version {own}, and {BEFORE} and {version} are read: begin another journal while all robots stand"
                )
            }
            Self::Frame { byte, why } => write!(f, "at byte {byte}: {why}"),
        }
    }
}

impl std::error::Error for JournalDamage {}

/// Reads the bytes of a journal.
///
/// # Errors
/// [`JournalDamage`].
pub fn read(bytes: &[u8]) -> Result<ParsedFrames, JournalDamage> {
    let header = bytes.get(..HEADER.len()).filter(|header| header[..VERSION] == HEADER[..VERSION]);
    let Some(header) = header else { return Err(JournalDamage::NoJournal) };
    // Without the last byte where it is that of a journal begun anew.
    let of = |word: u32| if word.to_le_bytes()[3] == ANEW[15] { (word & 0xff_ffff, true) } else { (word, false) };
    let [(own, is_anew), (version, _)] = [header, HEADER].map(|header| word(header, VERSION).map_or((0, false), of));
    if own != version && own != BEFORE {
        return Err(JournalDamage::Version { own, version });
    }
    let mut read = ParsedFrames {
        entries: Vec::new(),
        first: HEADER.len(),
        end: HEADER.len(),
        sum: FIRST,
        is_former: own == BEFORE,
    };
    while let Some(rest) = bytes.get(read.end..).filter(|rest| !rest.is_empty()) {
        let damage = |why: &str| JournalDamage::Frame { byte: read.end, why: why.to_owned() };
        match text(rest) {
            Ok((text, before, sum)) => {
                if before != read.sum {
                    return Err(damage("entries that do not follow those before them"));
                }
                let batch: Vec<JournalEntry> =
                    serde_json::from_slice(text).map_err(|error| damage(&error.to_string()))?;
                read.entries.extend(batch);
                let is_state = is_anew && read.end == HEADER.len();
                read.end += FRAME + text.len();
                if is_state {
                    read.first = read.end;
                }
                read.sum = sum;
            }
            // A frame is begun only after the one before it is on the disk, so a frame after an incomplete one is damage. (No
            // frame begins inside another one: the fourth byte of a length is no character of JSON.)
            Err(why) if (1..rest.len()).any(|later| text(&rest[later..]).is_ok()) => return Err(damage(why)),
            Err(why) if !is_torn(rest, read.end) => return Err(damage(why)),
            Err(_) => break,
        }
    }
    if is_anew && read.end == HEADER.len() {
        let why = "no whole frame, though it was whole when the journal was begun anew".to_owned();
        return Err(JournalDamage::Frame { byte: read.end, why });
    }
    Ok(read)
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..at + 4).and_then(|word| word.try_into().ok()).map(u32::from_le_bytes)
}

/// The length in the head of a frame, if the head is valid.
fn length(bytes: &[u8]) -> Option<usize> {
    (crc32fast::hash(bytes.get(..8)?) == word(bytes, 8)?).then_some(word(bytes, 0)? as usize)
}

/// Entries, checksum of the frame before, and own checksum of a frame, if it is complete.
fn text(bytes: &[u8]) -> Result<(&[u8], u32, u32), &'static str> {
    let (before, own) = word(bytes, 4).zip(word(bytes, BEGIN)).ok_or("no whole frame")?;
    let length = length(bytes).ok_or("a length that is none")?;
    let text = bytes.get(FRAME..FRAME + length).ok_or("no whole frame")?;
    match sum(&bytes[..BEGIN], text) == own {
        true => Ok((text, before, own)),
        false => Err("entries that are not as they were written"),
    }
}

/// Whether this frame, at this byte of the file, was never written completely.
fn is_torn(bytes: &[u8], at: usize) -> bool {
    /// Size that a disk writes atomically \[bytes\].
    const SECTOR: usize = 512;
    /// Fewer zeros than any part has that a disk writes at once \[bytes\].
    const PART: usize = 32;
    let is_missing = |part: &[u8]| part.iter().all(|byte| *byte == 0);
    match length(bytes) {
        Some(length) => bytes.get(FRAME..FRAME + length).is_none_or(|text| {
            // Its end was not written, or a part of it. JSON has no byte that is 0: a few of them were other bytes once.
            text.last() == Some(&0) || text.split(|byte| *byte != 0).any(|zeros| zeros.len() >= PART)
        }),
        // Only its beginning was written, or a sector is missing.
        None => {
            let (_, after) = bytes.split_at(FRAME.min(bytes.len()));
            let (head, next) = bytes.split_at((SECTOR - at % SECTOR).min(BEGIN).min(bytes.len()));
            is_missing(after) || is_missing(head) || (head.len() < BEGIN && is_missing(&next[..BEGIN - head.len()]))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// It went on, and so did another one.
    #[test]
    fn nothing_is_written_without_the_lock() {
        let folder = std::env::temp_dir().join(format!("pcr-journal-unlocked-{}", std::process::id()));
        let (mut journal, _) = Journal::open(&folder).unwrap();
        journal.keep(&[JournalEntry::Spent { path: 1 }]).unwrap();
        fs::remove_file(folder.join("lock")).unwrap();
        let (mut other, contents) = Journal::open(&folder).unwrap();
        assert_eq!(contents.entries.len(), 1);
        let why = journal.keep(&[JournalEntry::Spent { path: 2 }]).unwrap_err().to_string();
        assert!(why.contains("another supervisor"), "{why}");
        assert!(journal.restart(&[]).is_err());
        other.keep(&[JournalEntry::Spent { path: 3 }]).unwrap();
        drop((journal, other));
        let (_journal, contents) = Journal::open(&folder).unwrap();
        assert!(matches!(contents.entries[..], [JournalEntry::Spent { path: 1 }, JournalEntry::Spent { path: 3 }]));
        let _ = fs::remove_dir_all(&folder);
    }
}
