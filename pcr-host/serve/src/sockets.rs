//! Sockets of the machine: TCP, and Unix sockets, which are files with permissions.

use std::io::{self, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::time::Duration;

#[cfg(unix)]
pub use unix::SocketFile;

#[cfg(unix)]
use std::os::unix::net::{UnixListener, UnixStream};

/// Takes connections.
#[derive(Debug)]
pub enum Listener {
    /// At an address.
    Tcp(TcpListener),
    /// At a file.
    #[cfg(unix)]
    Unix(UnixListener),
}

/// A connection.
#[derive(Debug)]
pub enum Stream {
    /// Of any program that can reach the address.
    Tcp(TcpStream),
    /// Of a program that may write to the file.
    #[cfg(unix)]
    Unix(UnixStream),
}

impl From<TcpListener> for Listener {
    fn from(listener: TcpListener) -> Self {
        Self::Tcp(listener)
    }
}

/// Calls the same method of either.
macro_rules! each {
    ($own:expr, $inner:ident => $call:expr) => {
        match $own {
            Self::Tcp($inner) => $call,
            #[cfg(unix)]
            Self::Unix($inner) => $call,
        }
    };
}

impl Listener {
    /// Waits for a connection; the text names the other end.
    ///
    /// # Errors
    /// A connection cannot be taken now.
    pub fn accept(&self) -> io::Result<(Stream, String)> {
        match self {
            Self::Tcp(listener) => listener.accept().map(|(stream, from)| (Stream::Tcp(stream), from.to_string())),
            #[cfg(unix)]
            Self::Unix(listener) => listener.accept().map(|(stream, _)| (Stream::Unix(stream), "this machine".into())),
        }
    }
}

impl Stream {
    /// A second handle of the same connection.
    ///
    /// # Errors
    /// There is no file descriptor for it.
    pub fn try_clone(&self) -> io::Result<Self> {
        match self {
            Self::Tcp(stream) => stream.try_clone().map(Self::Tcp),
            #[cfg(unix)]
            Self::Unix(stream) => stream.try_clone().map(Self::Unix),
        }
    }

    /// Ends one way of the connection, or both.
    ///
    /// # Errors
    /// It has ended already.
    pub fn shutdown(&self, how: Shutdown) -> io::Result<()> {
        each!(self, stream => stream.shutdown(how))
    }

    /// Sets how long a read waits.
    ///
    /// # Errors
    /// A time of zero, and errors of the system.
    pub(crate) fn set_read_timeout(&self, time: Option<Duration>) -> io::Result<()> {
        each!(self, stream => stream.set_read_timeout(time))
    }

    /// Sets how long a write waits.
    ///
    /// # Errors
    /// A time of zero, and errors of the system.
    pub(crate) fn set_write_timeout(&self, time: Option<Duration>) -> io::Result<()> {
        each!(self, stream => stream.set_write_timeout(time))
    }
}

impl Read for Stream {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        each!(self, stream => stream.read(bytes))
    }
}

impl Write for Stream {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        each!(self, stream => stream.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        each!(self, stream => stream.flush())
    }
}

#[cfg(unix)]
mod unix {
    use super::Listener;
    use std::fs::{self, DirBuilder, Permissions};
    use std::io::{self, ErrorKind};
    use std::os::unix::fs::{DirBuilderExt, FileTypeExt, MetadataExt, PermissionsExt};
    use std::os::unix::net::{SocketAddr, UnixListener, UnixStream};
    use std::path::{Path, PathBuf};

    /// The file of a Unix socket, to which only its owner can connect. It is removed when this is dropped.
    #[derive(Debug)]
    pub struct SocketFile {
        path: PathBuf,
        /// Device and number of the file.
        id: (u64, u64),
    }

    impl SocketFile {
        /// Listens at a file, which is made. One that a program has left behind is replaced.
        ///
        /// # Errors
        /// [`ErrorKind::AddrInUse`] if another program listens there, or the file is no socket; and other errors, with the name of the file.
        pub fn bind(path: &Path) -> io::Result<(Listener, Self)> {
            let named = |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", path.display()));
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            // Of two supervisors that begin at once, the second one finds the first one listening.
            let lock = fs::File::open(folder).map_err(named)?;
            lock.lock().map_err(named)?;
            let bound = is_free(path).and_then(|()| placed(path, folder)).map_err(named);
            // A process that is just being started may have a copy of the open folder.
            lock.unlock().map_err(named)?;
            bound
        }
    }

    impl Drop for SocketFile {
        fn drop(&mut self) {
            // Somebody else may have put another file there.
            if fs::symlink_metadata(&self.path).is_ok_and(|there| (there.dev(), there.ino()) == self.id) {
                let _ = fs::remove_file(&self.path);
            }
        }
    }

    /// Whether nothing is at a path, or a socket at which nobody listens any more.
    fn is_free(path: &Path) -> io::Result<()> {
        let in_use = |why: &str| Err(io::Error::new(ErrorKind::AddrInUse, why));
        let there = match fs::symlink_metadata(path) {
            Ok(there) => there,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
            Err(error) => return Err(error),
        };
        if !there.file_type().is_socket() {
            return in_use("there is a file that is no socket: choose another name");
        }
        match UnixStream::connect(path) {
            Ok(_) => in_use("another program listens there"),
            Err(error) if error.kind() == ErrorKind::ConnectionRefused => Ok(()),
            Err(error) => Err(error),
        }
    }

    /// Makes the socket in a folder that nobody else can look into, gives it its permissions, and moves it to its place. So nobody else can
    /// connect at any time.
    fn placed(path: &Path, folder: &Path) -> io::Result<(Listener, SocketFile)> {
        let mut random = [0; 4];
        getrandom::fill(&mut random).map_err(io::Error::other)?;
        let inner = folder.join(format!(".pcr-{:08x}", u32::from_ne_bytes(random)));
        DirBuilder::new().mode(0o700).create(&inner)?;
        let socket = inner.join("s");
        let made = || {
            let listener = [path, &socket].iter().try_for_each(|path| SocketAddr::from_pathname(path).map(drop));
            let listener = listener.map_err(|error| {
                io::Error::new(error.kind(), "the name is too long for a socket: choose a shorter one")
            });
            let listener = listener.and_then(|()| UnixListener::bind(&socket))?;
            fs::set_permissions(&socket, Permissions::from_mode(0o600))?;
            let there = fs::symlink_metadata(&socket)?;
            fs::rename(&socket, path)?;
            Ok((Listener::Unix(listener), SocketFile { path: path.into(), id: (there.dev(), there.ino()) }))
        };
        let made = made();
        // It is empty after the move.
        let _ = fs::remove_file(&socket);
        let _ = fs::remove_dir(&inner);
        made
    }

    #[cfg(test)]
    mod tests {
        use super::*;
        use std::io::{Read, Write};

        fn folder(name: &str) -> PathBuf {
            let folder = std::env::temp_dir().join(format!("pcr-socket-{}-{name}", std::process::id()));
            let _ = fs::remove_dir_all(&folder);
            fs::create_dir(&folder).unwrap();
            folder
        }

        #[test]
        fn only_its_owner_can_connect_and_it_is_removed_at_the_end() {
            let folder = folder("own");
            let path = folder.join("lines");
            let (listener, file) = SocketFile::bind(&path).unwrap();
            let there = fs::symlink_metadata(&path).unwrap();
            assert!(there.file_type().is_socket());
            assert_eq!(there.permissions().mode() & 0o777, 0o600);
            assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "nothing else is left");
            let mut client = UnixStream::connect(&path).unwrap();
            let (mut stream, _) = listener.accept().unwrap();
            client.write_all(b"here").unwrap();
            let mut said = [0; 4];
            stream.read_exact(&mut said).unwrap();
            assert_eq!(&said, b"here");
            let why = SocketFile::bind(&path).unwrap_err();
            assert!(
                why.kind() == ErrorKind::AddrInUse && why.to_string().ends_with("another program listens there"),
                "{why}"
            );
            drop(file);
            assert!(!path.exists());
            fs::remove_dir_all(folder).unwrap();
        }

        #[test]
        fn a_socket_that_was_left_behind_is_replaced_and_nothing_else_is() {
            let folder = folder("left");
            let path = folder.join("lines");
            let (listener, file) = SocketFile::bind(&path).unwrap();
            std::mem::forget(file);
            drop(listener);
            assert!(path.exists());
            let (listener, file) = SocketFile::bind(&path).unwrap();
            assert!(UnixStream::connect(&path).is_ok());
            // One that was put there meanwhile is not removed.
            fs::remove_file(&path).unwrap();
            fs::write(&path, "other").unwrap();
            drop((listener, file));
            assert_eq!(fs::read_to_string(&path).unwrap(), "other");
            let why = SocketFile::bind(&path).unwrap_err().to_string();
            assert!(why.contains("no socket"), "{why}");
            assert_eq!(fs::read_to_string(&path).unwrap(), "other");
            let long = folder.join("x".repeat(120));
            let why = SocketFile::bind(&long).unwrap_err().to_string();
            assert!(why.ends_with("the name is too long for a socket: choose a shorter one"), "{why}");
            assert!(SocketFile::bind(&folder.join("missing/lines")).is_err());
            assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
            fs::remove_dir_all(folder).unwrap();
        }

        #[test]
        fn of_many_that_begin_at_once_one_listens() {
            let folder = folder("once");
            let path = folder.join("lines");
            // One is left behind.
            std::mem::forget(SocketFile::bind(&path).unwrap().1);
            let bound: Vec<_> = std::thread::scope(|scope| {
                let threads: Vec<_> = (0..8).map(|_| scope.spawn(|| SocketFile::bind(&path))).collect();
                threads.into_iter().map(|thread| thread.join().unwrap()).collect()
            });
            assert_eq!(bound.iter().filter(|bound| bound.is_ok()).count(), 1, "{bound:?}");
            assert!(UnixStream::connect(&path).is_ok());
            drop(bound);
            fs::remove_dir_all(folder).unwrap();
        }
    }
}
