//! Writes files so that they are complete or unchanged, and never partial.
//!
//! The contents are written to another file in the same folder and flushed to the disk; only then it takes the name
//! of the file that it replaces. If a full disk, a limit or a signal stops the program, the old file is still
//! untouched. The other file has no name, so that nothing is left of it, whatever stops the program. Systems without such
//! files give it one that is hidden, and keep it if the program is killed.
//!
//! A program that names the files that it reads with [`keep()`] cannot lose them to a picture or a table.

use std::fmt;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Files that are read.
static KEPT: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Folders that were made, each after those that it is in.
static MADE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Why a file that is read is not written to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OverwriteError(PathBuf);

impl fmt::Display for OverwriteError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = self.0.display();
        write!(f, "{file}: this is read, and something of another kind would be written over it; give another name")
    }
}

impl std::error::Error for OverwriteError {}

impl OverwriteError {
    /// The [`OverwriteError`] in an error of an output, if it is one.
    pub fn from_io_error(error: &io::Error) -> Option<&Self> {
        error.get_ref()?.downcast_ref()
    }
}

/// From now on this file, or standard input for `-`, is not written to, whatever its name: it is read.
pub fn keep(file: &Path) {
    // Where that is no file of the system, it cannot be written over either.
    let file = of_system(file);
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if !kept.iter().any(|other| other == file) {
        kept.push(file.to_owned());
    }
}

/// Whether a file is one of those that are kept.
fn is_kept(file: &Path) -> bool {
    let kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    kept.iter().any(|other| is_same_file(file, other))
}

/// Whether an output is what is read from a file, or from standard input for `-`: the same one on the disk, behind all links.
pub fn is_same(output: &Path, input: &Path) -> bool {
    is_same_file(output, of_system(input))
}

/// Whether two outputs cannot both be written: they are one, or one is in the other. Devices and pipes take any number.
pub fn are_at_odds(a: &Path, b: &Path) -> bool {
    let is_file = |file: &Path| fs::metadata(file).map_or(true, |there| there.is_file() || there.is_dir());
    let (one, other) = (placed(a), placed(b));
    is_file(a) && is_file(b) && (one.starts_with(&other) || other.starts_with(&one) || is_same_file(a, b))
}

/// Where a file is or will be, as far as folders are there yet.
fn placed(file: &Path) -> PathBuf {
    let file = followed(file).unwrap_or_else(|_| file.to_owned());
    let file = std::path::absolute(&file).unwrap_or(file);
    let there = file.ancestors().find_map(|folder| Some((folder, fs::canonicalize(folder).ok()?)));
    match there {
        Some((folder, place)) => file.strip_prefix(folder).map_or(place.clone(), |rest| place.join(rest)),
        None => file,
    }
}

/// The file that a name stands for, which is `-` for standard input.
fn of_system(file: &Path) -> &Path {
    if file == Path::new("-") { Path::new("/dev/stdin") } else { file }
}

/// Refuses a file that is kept.
fn refuse_kept(file: &Path) -> io::Result<()> {
    if is_kept(file) { Err(io::Error::other(OverwriteError(file.to_owned()))) } else { Ok(()) }
}

/// Devices and pipes may be read and written.
#[cfg(unix)]
fn is_same_file(a: &Path, b: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |file: &Path| fs::metadata(file).ok().filter(Metadata::is_file).map(|file| (file.dev(), file.ino()));
    identity(a).is_some_and(|one| identity(b) == Some(one))
}

#[cfg(not(unix))]
fn is_same_file(a: &Path, b: &Path) -> bool {
    matches!((fs::canonicalize(a), fs::canonicalize(b)), (Ok(a), Ok(b)) if a == b)
}

/// Writes a file. One that is there is replaced and keeps its mode, and for the superuser its owner; a link is followed. What is no
/// regular file (a terminal, a pipe, a device), and what is open already (`/dev/stdout`), is written to as it is.
///
/// # Errors
/// Those of the file system; then the file is as it was before. One that is there and must not be written to stays, too, and so does
/// one that is kept ([`keep()`]).
pub fn write(file: &Path, content: impl AsRef<[u8]>) -> io::Result<()> {
    stream(file, |out| out.write_all(content.as_ref()))
}

/// Writes a file whose content is already of this kind, which may be one that is kept (else [`write()`] refuses it).
///
/// # Errors
/// Errors of the file system.
pub fn write_over(file: &Path, content: impl AsRef<[u8]>) -> io::Result<()> {
    stream_over(file, |out| out.write_all(content.as_ref()))
}

/// Writes a file as [`write()`] does, with content that `fill` makes part by part.
///
/// # Errors
/// As [`write()`], and what `fill` refuses.
pub fn stream<T, E: From<io::Error>>(file: &Path, fill: impl FnOnce(&mut File) -> Result<T, E>) -> Result<T, E> {
    refuse_kept(file)?;
    stream_over(file, fill)
}

fn stream_over<T, E: From<io::Error>>(file: &Path, fill: impl FnOnce(&mut File) -> Result<T, E>) -> Result<T, E> {
    // Where it leads to a file, that is open for others, too, and may not be replaced.
    if let Some(mut own) = descriptor(file).map(|number| opened(number, file)).transpose()? {
        return fill(&mut own);
    }
    // Before links are followed: what a shell calls /dev/fd/63 is a link to no name.
    if fs::metadata(file).is_ok_and(|there| !there.is_file() && !there.is_dir()) {
        return fill(&mut OpenOptions::new().write(true).open(file)?);
    }
    if file.to_string_lossy().ends_with(std::path::is_separator) && !file.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "the name of a folder, and a file is written").into());
    }
    let target = followed(file)?;
    match fs::metadata(&target) {
        Ok(old) if old.is_dir() => Err(io::Error::new(io::ErrorKind::IsADirectory, "a folder").into()),
        Ok(old) => {
            // Its folder would let it be replaced even where it is read-only.
            OpenOptions::new().write(true).open(&target)?;
            replace(&target, Some(&old), fill)
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => replace(&target, None, fill),
        Err(error) => Err(error.into()),
    }
}

/// Makes a folder, and those that it is in, where they are not there yet.
///
/// # Errors
/// Errors of the file system; [`io::ErrorKind::NotADirectory`] if there is a file of this name.
pub fn folder(directory: &Path) -> io::Result<()> {
    let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    let missing: Vec<PathBuf> = directory.ancestors().take_while(is_missing).map(Path::to_owned).collect();
    match fs::create_dir_all(directory) {
        Ok(()) => {
            MADE.lock().unwrap_or_else(PoisonError::into_inner).extend(missing.into_iter().rev());
            Ok(())
        }
        Err(_) if fs::metadata(directory).is_ok_and(|there| !there.is_dir()) => {
            Err(io::Error::new(io::ErrorKind::NotADirectory, "it is there and not a folder"))
        }
        Err(error) => Err(error),
    }
}

/// Removes the folders that [`folder()`] has made and that are empty: those of a run that failed before it wrote anything.
pub fn remove_empty_folders() {
    let made = std::mem::take(&mut *MADE.lock().unwrap_or_else(PoisonError::into_inner));
    // One with something in it is not removed by this.
    made.iter().rev().for_each(|folder| drop(fs::remove_dir(folder)));
}

/// The path of a file behind all links, whether it exists or not.
fn followed(file: &Path) -> io::Result<PathBuf> {
    links(file)
        .take(LINKS + 1)
        .last()
        .filter(|last| fs::read_link(last).is_err())
        .ok_or_else(|| io::Error::other("too many links"))
}

/// As many links as Linux follows.
const LINKS: usize = 40;

/// A file, and what each link leads to.
fn links(file: &Path) -> impl Iterator<Item = PathBuf> {
    std::iter::successors(Some(file.to_owned()), |target| {
        Some(target.parent().unwrap_or(Path::new("")).join(fs::read_link(target).ok()?))
    })
}

/// The number of the descriptor of this program that a name stands for, as `/dev/stdout` does.
#[cfg(unix)]
pub fn descriptor(file: &Path) -> Option<u32> {
    let own = fs::canonicalize("/dev/fd").ok()?;
    let is_own = |file: &PathBuf| file.parent().and_then(|folder| fs::canonicalize(folder).ok()).as_ref() == Some(&own);
    let found = links(file).take(LINKS).find(is_own)?;
    found.file_name()?.to_str()?.parse().ok()
}

/// No name is that of a descriptor.
#[cfg(not(unix))]
pub fn descriptor(_: &Path) -> Option<u32> {
    None
}

/// A descriptor of this program, for writing; others that have it go on behind what is written.
#[cfg(unix)]
fn opened(number: u32, file: &Path) -> io::Result<File> {
    use std::os::fd::AsFd;
    match number {
        1 => io::stdout().as_fd().try_clone_to_owned().map(File::from),
        2 => io::stderr().as_fd().try_clone_to_owned().map(File::from),
        _ => OpenOptions::new().append(true).open(file),
    }
}

#[cfg(not(unix))]
fn opened(_: u32, file: &Path) -> io::Result<File> {
    OpenOptions::new().append(true).open(file)
}

fn replace<T, E: From<io::Error>>(
    target: &Path,
    old: Option<&Metadata>,
    fill: impl FnOnce(&mut File) -> Result<T, E>,
) -> Result<T, E> {
    if target.file_name().is_none() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not the name of a file").into());
    }
    let folder = match target.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let (mut file, mut named) = match unnamed(folder) {
        Some(file) => (file, None),
        None => {
            let make = |path: &Path| OpenOptions::new().write(true).create_new(true).open(path);
            let takes_none = |error: io::Error| {
                io::Error::new(error.kind(), format!("its folder {} takes no file: {error}", folder.display()))
            };
            temporary(folder, make).map(|(path, file)| (file, Some(path))).map_err(takes_none)?
        }
    };
    let done = filled(&mut file, old, fill).and_then(|done| {
        let path = match named.take() {
            Some(path) => path,
            None => temporary(folder, |path| link(&file, path))?.0,
        };
        fs::rename(named.insert(path), target)?;
        Ok(done)
    });
    match done {
        Ok(done) => {
            // So that the new name is on the disk. If folders cannot be opened or synced, the system writes it later.
            let _ = File::open(folder).and_then(|folder| folder.sync_all());
            Ok(done)
        }
        Err(error) => {
            if let Some(path) = named {
                let _ = fs::remove_file(path);
            }
            Err(error)
        }
    }
}

fn filled<T, E: From<io::Error>>(
    file: &mut File,
    old: Option<&Metadata>,
    fill: impl FnOnce(&mut File) -> Result<T, E>,
) -> Result<T, E> {
    if let Some(old) = old {
        give_to_owner(file, old);
        file.set_permissions(old.permissions())?;
    }
    let done = fill(file)?;
    file.sync_all()?;
    Ok(done)
}

/// Gives a file to the owner of another one. Only the superuser may; for others it is theirs, as it was before.
#[cfg(unix)]
fn give_to_owner(file: &File, old: &Metadata) {
    use std::os::unix::fs::{MetadataExt, fchown};
    let is_theirs = |new: &Metadata| (new.uid(), new.gid()) == (old.uid(), old.gid());
    if !file.metadata().is_ok_and(|new| is_theirs(&new)) {
        let _ = fchown(file, Some(old.uid()), Some(old.gid()));
    }
}

#[cfg(not(unix))]
fn give_to_owner(_: &File, _: &Metadata) {}

/// A file in a folder that vanishes with the program; `None` where the system has none.
#[cfg(target_os = "linux")]
fn unnamed(folder: &Path) -> Option<File> {
    use std::os::unix::fs::OpenOptionsExt;
    let flag = rustix::fs::OFlags::TMPFILE.bits();
    let file = OpenOptions::new().write(true).custom_flags(flag.cast_signed()).open(folder).ok()?;
    fs::metadata(of_process(&file)).is_ok().then_some(file)
}

/// Gives a name to a file that has none.
#[cfg(target_os = "linux")]
fn link(file: &File, path: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    Ok(linkat(CWD, of_process(file), CWD, path, AtFlags::SYMLINK_FOLLOW)?)
}

/// Where the system shows an open file.
#[cfg(target_os = "linux")]
fn of_process(file: &File) -> PathBuf {
    use std::os::fd::AsRawFd;
    format!("/proc/self/fd/{}", file.as_raw_fd()).into()
}

#[cfg(not(target_os = "linux"))]
fn unnamed(_: &Path) -> Option<File> {
    None
}

#[cfg(not(target_os = "linux"))]
fn link(_: &File, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// What is made in a folder under a hidden name that is free.
fn temporary<T>(folder: &Path, make: impl Fn(&Path) -> io::Result<T>) -> io::Result<(PathBuf, T)> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    loop {
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = folder.join(format!(".pcr-{}-{number}.tmp", std::process::id()));
        match make(&path) {
            // Left by a program of the same number that was killed.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            made => return made.map(|made| (path, made)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An empty folder for a test.
    fn scratch(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("pcr-output-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_made_and_replaced_and_nothing_is_left_beside_it() {
        let folder = scratch("made");
        let file = folder.join("a.json");
        write(&file, "one").unwrap();
        write(&file, "two").unwrap();
        assert_eq!((fs::read_to_string(&file).unwrap().as_str(), names(&folder)), ("two", vec!["a.json".to_owned()]));
        write(&folder.join("x".repeat(255)), "the longest name").unwrap();
        assert_eq!(names(&folder).len(), 2);
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn nothing_has_a_name_before_it_is_complete() {
        let folder = scratch("unnamed");
        let file = folder.join("a.json");
        for before in [vec![], vec!["a.json".to_owned()]] {
            let fill = |out: &mut File| {
                // Some file systems have no files without names.
                assert!(names(&folder) == before || unnamed(&folder).is_none());
                out.write_all(b"some").and(Err::<(), _>(io::Error::other("stopped")))
            };
            assert!(stream(&file, fill).is_err());
            assert_eq!(names(&folder), before);
            write(&file, "all").unwrap();
        }
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn folders_are_not_files_and_files_no_folders() {
        let folder = scratch("kinds");
        assert_eq!(write(&folder, "x").unwrap_err().kind(), io::ErrorKind::IsADirectory);
        let file = folder.join("file");
        write(&file, "x").unwrap();
        assert_eq!(super::folder(&file).unwrap_err().kind(), io::ErrorKind::NotADirectory);
        super::folder(&folder.join("a/b")).unwrap();
        super::folder(&folder.join("a/b")).unwrap();
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn what_is_read_is_not_written_to_under_any_name() {
        let folder = scratch("read");
        let [file, link, other] = ["file", "link", "other"].map(|name| folder.join(name));
        fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink("file", &link).unwrap();
        fs::hard_link(&file, folder.join("hard")).unwrap();
        keep(&file);
        for name in [&file, &link, &folder.join("hard"), &folder.join("./file")] {
            let error = write(name, "new").unwrap_err();
            assert_eq!(OverwriteError::from_io_error(&error), Some(&OverwriteError(name.clone())));
        }
        write(&other, "new").unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "old");
        write_over(&link, "new").unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
        // It is another file on the disk now, and kept as well.
        assert!(write(&file, "newer").is_err());
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn outputs_that_cannot_both_be_written_are_known() {
        let folder = scratch("odds");
        let [file, link, other] = ["file", "link", "other"].map(|name| folder.join(name));
        std::os::unix::fs::symlink("file", &link).unwrap();
        for (a, b, at_odds) in [
            // Neither is there yet.
            (&file, &folder.join("./file"), true),
            (&file, &link, true),
            (&file, &other, false),
            (&file, &folder.join("file2"), false),
            (&folder.join("maps/before"), &folder.join("maps/before/index.html"), true),
            (&folder.join("maps/before"), &folder.join("maps"), true),
            (&folder.join("maps/before"), &folder.join("maps/plan.json"), false),
            (&PathBuf::from("/dev/null"), &PathBuf::from("/dev/null"), false),
        ] {
            assert_eq!(are_at_odds(a, b), at_odds, "{} {}", a.display(), b.display());
        }
        fs::write(&file, "").unwrap();
        fs::hard_link(&file, &other).unwrap();
        assert!(are_at_odds(&file, &other));
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn mode_and_links_are_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = scratch("links");
        let [file, link, dangling] = ["file", "link", "dangling"].map(|name| folder.join(name));
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        symlink("file", &link).unwrap();
        symlink("new", &dangling).unwrap();
        write(&link, "new").unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
        // Only the superuser can see to it, and find out.
        if std::os::unix::fs::chown(&file, Some(1), Some(1)).is_ok() {
            use std::os::unix::fs::MetadataExt;
            write(&file, "newer").unwrap();
            let there = fs::metadata(&file).unwrap();
            assert_eq!((there.uid(), there.gid(), there.permissions().mode() & 0o777), (1, 1, 0o640));
        }
        write(&dangling, "there").unwrap();
        assert_eq!(fs::read_to_string(folder.join("new")).unwrap(), "there");
        assert!([&link, &dangling].iter().all(|link| fs::symlink_metadata(link).unwrap().is_symlink()));
        symlink("b", folder.join("a")).unwrap();
        symlink("a", folder.join("b")).unwrap();
        assert!(write(&folder.join("a"), "x").is_err());
        fs::remove_dir_all(folder).unwrap();
    }
}
