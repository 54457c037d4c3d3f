//! Bytes to read a record from, under a name for messages.

use std::{
    fmt,
    io::{self, Cursor, Read, Seek},
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
};

use super::{
    counting::Counting,
    packing::{self, MOST_UNPACKED, Member, Packing},
    regular::{Stamp, is_standard_input, open_regular, read_whole},
};
use crate::{
    error::{FileError, FileProblem, shown},
    faults::admits,
};

/// Most bytes of a file that is held in memory as a whole: a workbook, a force curve, a packed table (2 GiB).
pub const MOST_IN_MEMORY: u64 = 2 << 30;

/// How many times the size of a packed file it may unpack to in memory, beyond [`ALWAYS_UNPACKED`].
pub const MOST_TIMES: u64 = 256;

/// What any packed file may unpack to in memory (16 MiB).
pub const ALWAYS_UNPACKED: u64 = 16 << 20;

/// How much of a file is looked at to tell its format.
const BEGINNING: u64 = 64 * 1024;

/// Bytes to read a record from, under a name for messages.
#[derive(Clone)]
pub struct Input {
    /// What messages call it: its path, on a disk.
    pub name: PathBuf,
    /// How it is packed.
    pub packing: Packing,
    /// Its first bytes, unpacked: all of it, or 64 KiB.
    pub beginning: Vec<u8>,
    /// Its size in bytes, packed as it is.
    pub size: u64,
    stored: Stored,
}

/// Where the bytes lie.
#[derive(Clone)]
enum Stored {
    /// On a disk at this path, as the file was when it was opened.
    Disk(PathBuf, Stamp),
    Memory(Arc<[u8]>),
}

impl fmt::Debug for Input {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Input({}, {} bytes)", self.name.display(), self.size)
    }
}

/// Bytes that can be read from any place in them.
pub(crate) trait Seekable: Read + Seek + Send {}

impl<T: Read + Seek + Send> Seekable for T {}

impl Input {
    /// The file at `path`, which is looked into to see whether it is packed.
    ///
    /// # Errors
    /// [`FileError`] where it cannot be read, or is a packed file that holds no file, or several.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let (_, about) = open_regular(path)?;
        let stored = Stored::Disk(path.to_owned(), Stamp::of(&about));
        Self::of(path.to_owned(), stored, about.len())
    }

    /// All bytes of the file at `path`, held in memory; `-` is standard input, read to its end.
    ///
    /// # Errors
    /// As for [`open`](Self::open), and where there are more than [`MOST_IN_MEMORY`].
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let name = if is_standard_input(path) { Path::new("standard input") } else { path };
        let bytes = read_whole(path, MOST_IN_MEMORY).map_err(|error| FileError::of(name, error.problem))?;
        let limit = || {
            FileError::of(
                name,
                FileProblem::TooLarge {
                    what: "the file",
                    most_bytes: MOST_IN_MEMORY,
                },
            )
        };
        Self::from_bytes(name, bytes.ok_or_else(limit)?)
    }

    /// Checks that the file is still the one that was opened, where it lies on a disk.
    ///
    /// # Errors
    /// [`FileError`] where its length or the time of its last change is another one.
    pub fn check_unchanged(&self) -> Result<(), FileError> {
        let Stored::Disk(path, before) = &self.stored else {
            return Ok(());
        };
        let (_, about) = open_regular(path)?;
        if Stamp::of(&about) == *before { Ok(()) } else { Err(self.wrong(FileProblem::Changed)) }
    }

    /// Hands out its bytes as they are stored, in pieces, for as long as `take` wants more.
    ///
    /// # Errors
    /// [`FileError`] where they cannot be read.
    pub fn each_piece(&self, mut take: impl FnMut(&[u8]) -> bool) -> Result<(), FileError> {
        let (mut stored, mut piece) = (self.as_stored()?, vec![0; 1 << 18]);
        loop {
            match stored.read(&mut piece).map_err(|error| FileError::from_io(&self.name, error))? {
                0 => return Ok(()),
                count if !take(&piece[..count]) => return Ok(()),
                _ => {}
            }
        }
    }

    /// All of its bytes as they are stored, where they lie in memory.
    #[must_use]
    pub fn in_memory(&self) -> Option<&[u8]> {
        match &self.stored {
            Stored::Memory(bytes) => Some(bytes),
            Stored::Disk(..) => None,
        }
    }

    /// Bytes in memory. `name` is what messages call them.
    ///
    /// # Errors
    /// As for [`open`](Self::open), less those of the disk.
    pub fn from_bytes(name: impl Into<PathBuf>, bytes: impl Into<Arc<[u8]>>) -> Result<Self, FileError> {
        let bytes = bytes.into();
        let size = bytes.len() as u64;
        Self::of(name.into(), Stored::Memory(bytes), size)
    }

    fn of(name: PathBuf, stored: Stored, size: u64) -> Result<Self, FileError> {
        let mut input = Self {
            name,
            stored,
            packing: Packing::None,
            beginning: Vec::new(),
            size,
        };
        input.beginning = input.first_bytes()?;
        input.packing = packing::recognise(&input.name, &input.beginning, || input.as_stored())?;
        if matches!(input.packing, Packing::Gzip | Packing::Zip(_)) {
            input.beginning = input.first_bytes()?;
        }
        Ok(input)
    }

    /// The files of a zip archive of several, in its order.
    pub(crate) fn members(&self) -> Result<Vec<Member>, FileError> {
        packing::members(&self.name, self.as_stored()?)
    }

    /// One of the files of a zip archive, which messages call by archive and file.
    pub(crate) fn member(&self, member: &Member) -> Result<Self, FileError> {
        let mut input = Self {
            name: format!("{}/{}", self.name.display(), shown(&member.name)).into(),
            stored: self.stored.clone(),
            packing: Packing::Zip(member.clone()),
            beginning: Vec::new(),
            size: member.packed,
        };
        if member.is_encrypted {
            return Err(input.wrong(FileProblem::Encrypted));
        }
        input.beginning = input.first_bytes()?;
        Ok(input)
    }

    fn first_bytes(&self) -> Result<Vec<u8>, FileError> {
        let mut bytes = Vec::new();
        let reader = self.reader()?;
        reader.take(BEGINNING).read_to_end(&mut bytes).map_err(|error| self.failed(error))?;
        Ok(bytes)
    }

    /// Its bytes from the first on, unpacked.
    pub(crate) fn reader(&self) -> Result<InputReader, FileError> {
        let (inner, count) = (self.as_stored()?, Arc::default());
        let counting = Counting {
            inner,
            count: Arc::clone(&count),
        };
        Ok(InputReader {
            bytes: packing::unpacked(counting, &self.packing).map_err(|error| self.failed(error))?,
            count,
            size: self.size,
        })
    }

    /// It, or where it is packed all of its bytes unpacked in memory: not to be unpacked for every look into it.
    pub(crate) fn unpacked(&self) -> Result<Self, FileError> {
        match self.packing {
            Packing::None | Packing::Archive(_) => Ok(self.clone()),
            Packing::Gzip | Packing::Zip(_) => Self::from_bytes(&self.name, self.bytes()?),
        }
    }

    /// Its bytes in any order, unpacked. A packed file is unpacked into memory.
    pub(crate) fn seekable(&self) -> Result<Box<dyn Seekable>, FileError> {
        match self.packing {
            Packing::None | Packing::Archive(_) => self.as_stored(),
            Packing::Gzip | Packing::Zip(_) => Ok(Box::new(Cursor::new(self.bytes()?))),
        }
    }

    /// All of its bytes, unpacked, up to [`MOST_IN_MEMORY`] and to what its size warrants.
    pub(crate) fn bytes(&self) -> Result<Vec<u8>, FileError> {
        let mut bytes = Vec::new();
        let warranted = if self.packing == Packing::None { u64::MAX } else { self.warranted() };
        let most = MOST_IN_MEMORY.min(warranted);
        let read = self.reader()?.take(most + 1).read_to_end(&mut bytes);
        read.map_err(|error| self.failed(error))?;
        match bytes.len() as u64 {
            length if admits(length, most) => Ok(bytes),
            _ if most < MOST_IN_MEMORY => Err(self.beyond_limit()),
            _ => Err(self.too_large("the file", most)),
        }
    }

    /// Most bytes that what is packed here may unpack to in memory: [`MOST_TIMES`] as many as there are, and at least
    /// [`ALWAYS_UNPACKED`].
    pub(crate) fn warranted(&self) -> u64 {
        self.size.saturating_mul(MOST_TIMES).max(ALWAYS_UNPACKED)
    }

    /// An error where `bytes` that `what` unpacks to are more than `most`, or than is [`warranted`](Self::warranted).
    pub(crate) fn bounded(&self, bytes: u64, what: &'static str, most: u64) -> Result<(), FileError> {
        if !admits(bytes, most) {
            return Err(self.too_large(what, most));
        }
        if bytes > self.warranted() { Err(self.beyond_limit()) } else { Ok(()) }
    }

    /// What is packed here unpacks to more than is [`warranted`](Self::warranted).
    pub(crate) fn beyond_limit(&self) -> FileError {
        self.wrong(FileProblem::DecompressionLimit(MOST_TIMES))
    }

    /// The bytes as they lie there, packed or not.
    fn as_stored(&self) -> Result<Box<dyn Seekable>, FileError> {
        Ok(match &self.stored {
            Stored::Disk(path, _) => Box::new(open_regular(path)?.0),
            Stored::Memory(bytes) => Box::new(Cursor::new(Arc::clone(bytes))),
        })
    }

    /// What the operating system, or an unpacker, says about this file.
    pub(crate) fn failed(&self, error: io::Error) -> FileError {
        if error.kind() == io::ErrorKind::FileTooLarge {
            return self.too_large("the unpacked file", MOST_UNPACKED);
        }
        if self.packing == Packing::None || error.raw_os_error().is_some() {
            return FileError::from_io(&self.name, error);
        }
        let found = match error.kind() {
            io::ErrorKind::UnexpectedEof => "their end, or others".to_owned(),
            io::ErrorKind::InvalidInput | io::ErrorKind::InvalidData => format!("others than were packed ({error})"),
            _ => error.to_string(),
        };
        self.damaged(self.packing.to_string(), "bytes that can be unpacked", found)
    }

    /// Something is wrong with it.
    pub(crate) fn wrong(&self, problem: FileProblem) -> FileError {
        FileError::of(&self.name, problem)
    }

    /// A part of it is not as its format has it.
    pub(crate) fn damaged(
        &self,
        place: impl Into<String>,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> FileError {
        self.wrong(FileProblem::damaged(place, expected, found))
    }

    /// A build with more features would read it.
    #[cfg(not(all(feature = "arrow", feature = "hdf5", feature = "robot-log")))]
    pub(crate) fn not_in_this_build(&self, expected: &'static str, hint: &'static str) -> FileError {
        self.wrong(FileProblem::unfit("its format", expected, "one without", hint))
    }

    /// A limit that the file goes beyond.
    pub(crate) fn too_large(&self, what: &'static str, most_bytes: u64) -> FileError {
        self.wrong(FileProblem::TooLarge { what, most_bytes })
    }
}

/// The bytes of an input in order, and how far they have been read.
pub(crate) struct InputReader {
    bytes: Box<dyn Read + Send>,
    count: Arc<AtomicU64>,
    size: u64,
}

impl InputReader {
    /// Bytes of the stored file taken in so far, and its size.
    pub(crate) fn progress(&self) -> (u64, u64) {
        let done = self.count.load(Ordering::Relaxed);
        (done, self.size.max(done))
    }
}

impl Read for InputReader {
    /// Goes on where a signal interrupts it.
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        loop {
            match self.bytes.read(into) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                read => return read,
            }
        }
    }
}
