//! The bytes of a file and their digest.

use std::cell::LazyCell;
use std::fs::File;
use std::io::{self, IsTerminal, Read};
use std::path::Path;
use std::thread;

use palpate_files::input::Input;
use palpate_files::record::ReadError;
use sha2::{Digest, Sha256};

use crate::output::{hexadecimal, sha256};
use crate::{ErrorKind, JobError};

/// Up to this many bytes a file is read into memory as a whole, and hashed there (64 MiB). A longer one is hashed on a thread of its own
/// while it is read.
const IN_MEMORY: u64 = 64 << 20;

/// SHA-256 in hexadecimal, waited for where it is wanted.
pub(crate) type FileDigest = LazyCell<Result<String, JobError>, Box<dyn FnOnce() -> Result<String, JobError>>>;

/// A file to read a record from, and the digest of its bytes.
pub(crate) struct Source {
    pub(crate) input: Input,
    pub(crate) digest: FileDigest,
}

impl Source {
    /// The file at `path`; `-` is standard input, read to its end.
    pub(crate) fn open(path: &Path) -> Result<Self, JobError> {
        if is_standard_input(path) {
            return Self::piped();
        }
        let short = std::fs::metadata(path).is_ok_and(|about| about.is_file() && about.len() <= IN_MEMORY);
        let (input, digest): (_, Box<dyn FnOnce() -> Result<String, JobError>>) =
            match short.then(|| std::fs::read(path)) {
                Some(Ok(bytes)) => {
                    let digest = sha256(&bytes);
                    (Input::from_bytes(path, bytes), Box::new(|| Ok(digest)))
                }
                _ => {
                    let (input, path) = (Input::open(path), path.to_owned());
                    let of = path.clone();
                    let work = thread::spawn(move || hashed(&of));
                    let digest = move || {
                        let digest = work.join().unwrap_or_else(|_| Err(io::ErrorKind::Other.into()));
                        digest.map_err(|error| JobError::unread(&path, &error))
                    };
                    (input, Box::new(digest))
                }
            };
        Ok(Self {
            input: input.map_err(ReadError::File)?,
            digest: LazyCell::new(digest),
        })
    }

    fn piped() -> Result<Self, JobError> {
        let (name, mut piped, mut bytes) = (Path::new("standard input"), io::stdin(), Vec::new());
        if piped.is_terminal() {
            let message = "expected a record on standard input, found a terminal";
            let hint = "name a file, or send one through a pipe: `palpate watch - < log.csv`".to_owned();
            return Err(JobError::new(ErrorKind::Record, message, hint));
        }
        piped.read_to_end(&mut bytes).map_err(|error| JobError::unread(name, &error))?;
        let digest = sha256(&bytes);
        let digest: Box<dyn FnOnce() -> Result<String, JobError>> = Box::new(|| Ok(digest));
        Ok(Self {
            input: Input::from_bytes(name, bytes).map_err(ReadError::File)?,
            digest: LazyCell::new(digest),
        })
    }
}

/// Whether a name means standard input.
pub(crate) fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

fn hashed(path: &Path) -> io::Result<String> {
    let (mut file, mut hasher, mut buffer) = (File::open(path)?, Sha256::new(), vec![0; 1 << 18]);
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(hexadecimal(hasher.finalize())),
            count => hasher.update(&buffer[..count]),
        }
    }
}
