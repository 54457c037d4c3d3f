//! The bytes of a file and their digest.

use std::cell::{OnceCell, RefCell};
use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use palpate::watch::{Progress, Watch};
use palpate_files::FileError;
use palpate_files::input::{Input, is_standard_input};
use palpate_files::record::ReadError;
use sha2::{Digest, Sha256};

use crate::output::{hexadecimal, sha256};
use crate::{ErrorKind, JobError};

/// Up to this many bytes a file is read into memory as a whole, and hashed there (64 MiB). A longer one is hashed on a thread of its own
/// while it is read.
const IN_MEMORY: u64 = 64 << 20;

/// A file of records as a front end names it.
#[derive(Debug, Clone)]
pub enum NamedFile {
    /// On a disk; `-` is standard input.
    Path(PathBuf),
    /// In memory, under a name for results and messages.
    Bytes(PathBuf, Arc<[u8]>),
    /// Elsewhere, such as in a store of objects: its name, its size in bytes, and what fetches it each time that it is read.
    Remote(PathBuf, u64, Arc<dyn Fetch>),
}

/// Fetches the bytes of a file that is not on a disk of this machine.
pub trait Fetch: fmt::Debug + Send + Sync {
    /// All of its bytes.
    ///
    /// # Errors
    /// What kept it from them.
    fn fetch(&self) -> io::Result<Vec<u8>>;
}

impl NamedFile {
    /// What results and messages call it.
    #[must_use]
    pub fn name(&self) -> &Path {
        match self {
            Self::Path(name) | Self::Bytes(name, _) | Self::Remote(name, ..) => name,
        }
    }

    /// Its length in bytes; 0 where it cannot be found.
    #[must_use]
    pub fn size(&self) -> u64 {
        match self {
            Self::Path(path) => fs::metadata(path).map_or(0, |about| about.len()),
            Self::Bytes(_, bytes) => bytes.len() as u64,
            Self::Remote(_, size, _) => *size,
        }
    }

    /// Whether it is standard input.
    #[must_use]
    pub fn is_standard_input(&self) -> bool {
        self.path().is_some_and(is_standard_input)
    }

    /// Where it lies, if it lies on a disk.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        if let Self::Path(path) = self { Some(path) } else { None }
    }
}

impl From<PathBuf> for NamedFile {
    fn from(path: PathBuf) -> Self {
        Self::Path(path)
    }
}

/// A file to read a record from, and the digest of its bytes.
pub(crate) struct Source {
    pub(crate) input: Input,
    pub(crate) digest: FileDigest,
}

impl Source {
    /// The file; standard input is read to its end.
    pub(crate) fn open(file: &NamedFile) -> Result<Self, JobError> {
        let input = match file {
            NamedFile::Bytes(name, bytes) => Input::from_bytes(name, Arc::clone(bytes)),
            NamedFile::Remote(name, _, remote) => {
                let bytes = remote.fetch().map_err(|error| JobError::unread(name, &error))?;
                Input::from_bytes(name, bytes)
            }
            NamedFile::Path(path) if is_standard_input(path) => Input::read(path),
            // Opened first: only a regular file is read.
            NamedFile::Path(path) => {
                Input::open(path).and_then(|input| if input.size <= IN_MEMORY { Input::read(path) } else { Ok(input) })
            }
        };
        let input = input.map_err(ReadError::File)?;
        Ok(Self {
            digest: FileDigest::of(&input),
            input,
        })
    }
}

/// SHA-256 in hexadecimal, waited for where it is wanted.
pub(crate) struct FileDigest {
    found: OnceCell<Result<String, JobError>>,
    work: RefCell<Option<JoinHandle<Result<String, FileError>>>>,
    stop: Arc<AtomicBool>,
}

impl FileDigest {
    fn of(input: &Input) -> Self {
        let stop = Arc::new(AtomicBool::new(false));
        let (found, work) = match input.in_memory() {
            Some(bytes) => (OnceCell::from(Ok(sha256(bytes))), None),
            None => {
                let (input, stop) = (input.clone(), Arc::clone(&stop));
                (OnceCell::new(), Some(thread::spawn(move || hashed(&input, &stop))))
            }
        };
        Self {
            found,
            work: RefCell::new(work),
            stop,
        }
    }

    /// The digest; the watch is heard while it is waited for.
    ///
    /// # Errors
    /// [`JobError`] where the file can no longer be read, or has changed, or the watch ends it.
    pub(crate) fn get(&self, watch: &mut dyn Watch) -> Result<String, JobError> {
        const LOOK: Duration = Duration::from_millis(5);
        let wait = || {
            let gone = || JobError::new(ErrorKind::Record, "the digest of the file was not computed", None);
            let work = self.work.borrow_mut().take().ok_or_else(gone)?;
            while !work.is_finished() {
                watch.report(Progress::open("digesting the file", 0))?;
                thread::sleep(LOOK);
            }
            let digest = work.join().map_err(|_| gone())?;
            Ok(digest.map_err(ReadError::File)?)
        };
        self.found.get_or_init(wait).clone()
    }
}

/// Work that was ended wants no digest any more.
impl Drop for FileDigest {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// The digest of a file on a disk; none of any use once it is to `stop`.
fn hashed(input: &Input, stop: &AtomicBool) -> Result<String, FileError> {
    let mut hasher = Sha256::new();
    input.each_piece(|piece| {
        hasher.update(piece);
        !stop.load(Ordering::Relaxed)
    })?;
    input.check_unchanged()?;
    Ok(hexadecimal(hasher.finalize()))
}
