//! The token by which a client of the lines over TCP proves that it may read a file.
//!
//! Every program of the machine can connect to a TCP port, and so can every page that a browser of the machine shows. Only who may read
//! the file knows the token.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Read, Write};
use std::path::Path;
use subtle::ConstantTimeEq;

/// Random bytes of a new token.
const BYTES: usize = 32;

/// Fewest and most characters of a token.
const LENGTHS: std::ops::RangeInclusive<usize> = 32..=1024;

/// A token.
#[derive(Clone)]
pub struct Token(String);

/// It is in no log.
impl std::fmt::Debug for Token {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Token(..)")
    }
}

impl Token {
    /// Reads the token of a file, or creates the file, which only its owner may read, with a random token.
    ///
    /// # Errors
    /// With the name of the file: it cannot be read or created, others than its owner may read or write it, or it does not have one word of 32
    /// to 1,024 printable ASCII characters.
    pub fn at(path: &Path) -> io::Result<Self> {
        let named = |error: io::Error| io::Error::new(error.kind(), format!("{}: {error}", path.display()));
        loop {
            match File::open(path) {
                Ok(file) => return Self::read(file).map_err(named),
                Err(error) if error.kind() == ErrorKind::NotFound => {}
                Err(error) => return Err(named(error)),
            }
            match create(path) {
                Ok(()) => {}
                // Another supervisor was faster.
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(named(error)),
            }
        }
    }

    fn read(file: File) -> io::Result<Self> {
        let wrong = |why: String| Err(io::Error::new(ErrorKind::InvalidData, why));
        let kind = file.metadata()?;
        if !kind.is_file() {
            return wrong("it is no file with a token".into());
        }
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let mode = kind.permissions().mode() & 0o777;
            if mode & 0o077 != 0 {
                return wrong(format!(
                    "others than its owner may read or change this token (mode {mode:03o}): delete the file, and a new one is made at the next start"
                ));
            }
        }
        let mut text = String::new();
        file.take(*LENGTHS.end() as u64 + 2).read_to_string(&mut text)?;
        let token = text.trim_ascii();
        let is_word = token.bytes().all(|byte| byte.is_ascii_graphic());
        if !(is_word && LENGTHS.contains(&token.len())) {
            return wrong(format!(
                "a token is one word of {} to {} printable ASCII characters: delete the file, and a new one is made at the next start",
                LENGTHS.start(),
                LENGTHS.end()
            ));
        }
        Ok(Self(token.into()))
    }

    /// Whether this is the token. The time that it takes tells nothing of the characters of the token.
    pub fn is(&self, said: &str) -> bool {
        self.0.as_bytes().ct_eq(said.as_bytes()).into()
    }
}

/// Creates a file with a random token. It gets its name when it is complete, and nobody else could read it before.
fn create(path: &Path) -> io::Result<()> {
    let random = |bytes: &mut [u8]| getrandom::fill(bytes).map_err(io::Error::other);
    let hex = |bytes: &[u8]| bytes.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    let (mut bytes, mut other) = ([0; BYTES], [0; 8]);
    random(&mut bytes)?;
    random(&mut other)?;
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}", hex(&other)));
    let new = path.with_file_name(name);
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    let mut file = options.open(&new)?;
    // Unlike a new name, a second one does not replace a file that another supervisor has made meanwhile.
    let written =
        writeln!(file, "{}", hex(&bytes)).and_then(|()| file.sync_all()).and_then(|()| fs::hard_link(&new, path));
    written.and(fs::remove_file(&new))?;
    #[cfg(unix)]
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        File::open(folder)?.sync_all()?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::Token;
    use std::fs;
    use std::path::PathBuf;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("pcr-token-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir(&folder).unwrap();
        folder
    }

    #[test]
    fn is_made_once_and_read_after_that() {
        let folder = folder("once");
        let path = folder.join("token");
        let made: Vec<Token> = std::thread::scope(|scope| {
            let threads: Vec<_> = (0..8).map(|_| scope.spawn(|| Token::at(&path).unwrap())).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        let text = fs::read_to_string(&path).unwrap();
        let word = text.trim_end();
        assert!(word.len() == 64 && word.bytes().all(|byte| byte.is_ascii_hexdigit()), "{word}");
        assert!(made.iter().all(|token| token.is(word)));
        assert!(!Token::at(&path).unwrap().is(&word[..63]) && !Token::at(&path).unwrap().is(&format!("{word}0")));
        assert!(!Token::at(&path).unwrap().is(&word.replace(&word[..1], "x")) && !Token::at(&path).unwrap().is(""));
        assert_eq!(format!("{:?}", made[0]), "Token(..)");
        // Nothing but the file is left, and another folder has another token.
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
        Token::at(&folder.join("other")).unwrap();
        assert_ne!(fs::read_to_string(folder.join("other")).unwrap(), text);
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn only_its_owner_may_read_it() {
        use std::os::unix::fs::PermissionsExt;
        let folder = folder("mode");
        let path = folder.join("token");
        Token::at(&path).unwrap();
        let mode = |path: &PathBuf| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&path), 0o600);
        for wide in [0o640, 0o604, 0o620, 0o601, 0o644, 0o666] {
            fs::set_permissions(&path, fs::Permissions::from_mode(wide)).unwrap();
            let why = Token::at(&path).unwrap_err().to_string();
            assert!(
                why.starts_with(&path.display().to_string()) && why.contains(&format!("(mode {wide:03o})")),
                "{why}"
            );
        }
        fs::set_permissions(&path, fs::Permissions::from_mode(0o400)).unwrap();
        Token::at(&path).unwrap();
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_token_is_refused() {
        use std::os::unix::fs::PermissionsExt;
        let folder = folder("none");
        let path = folder.join("token");
        for (text, is_token) in [
            (String::new(), false),
            ("\n".into(), false),
            ("x".repeat(31), false),
            (format!("{}\n", "x".repeat(32)), true),
            ("x".repeat(1024), true),
            ("x".repeat(1025), false),
            ("x".repeat(1 << 20), false),
            (format!("{0} {0}", "x".repeat(32)), false),
            (format!("{}é", "x".repeat(32)), false),
        ] {
            fs::write(&path, &text).unwrap();
            fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).unwrap();
            assert_eq!(Token::at(&path).is_ok(), is_token, "{}", text.len());
        }
        fs::write(&path, [0xff; 64]).unwrap();
        assert!(Token::at(&path).is_err());
        assert!(Token::at(&folder).unwrap_err().to_string().contains("it is no file"));
        assert!(Token::at(&folder.join("missing/token")).is_err());
        fs::remove_dir_all(folder).unwrap();
    }
}
