//! Telling packed files by their content, and unpacking them.

use std::{
    borrow::Cow,
    fmt,
    io::{self, Read, Seek},
    path::Path,
};

use flate2::{CrcReader, read::MultiGzDecoder};
use zip::{CompressionMethod, ZipArchive, result::ZipError};

use crate::error::{FileError, FileProblem, shown};

/// Most bytes that a packed file may unpack to where its rows are streamed (64 GiB).
pub const MOST_UNPACKED: u64 = 64 << 30;

/// Most files of a zip archive (65,536).
const MOST_FILES: usize = 1 << 16;

/// How a file is packed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Packing {
    /// Not at all. A workbook or force curve that is a zip archive by itself counts as not packed.
    None,
    /// By gzip.
    Gzip,
    /// In a zip archive: alone, or as one of its files.
    Zip(Member),
    /// It is a zip archive of so many files.
    Archive(usize),
}

/// A file in a zip archive, and where it lies there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Member {
    /// Its name in the archive.
    pub name: String,
    /// The first of its packed bytes.
    start: u64,
    /// How many packed bytes it has.
    pub(super) packed: u64,
    method: CompressionMethod,
    /// Its checksum.
    sum: u32,
    pub(super) is_encrypted: bool,
}

impl fmt::Display for Packing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("not packed"),
            Self::Gzip => f.write_str("packed by gzip"),
            Self::Zip(member) => write!(f, "packed in a zip archive as {}", shown(&member.name)),
            Self::Archive(files) => write!(f, "{files} files in a zip archive"),
        }
    }
}

/// Whether the bytes of an archive's first member can begin here.
pub(crate) fn is_zip(beginning: &[u8]) -> bool {
    beginning.starts_with(b"PK\x03\x04") || beginning.starts_with(EMPTY)
}

/// Whether a file begins as HDF5 does, perhaps behind a block of another program.
pub(crate) fn is_hdf5(beginning: &[u8]) -> bool {
    let mut places = std::iter::once(0).chain((9..16).map(|power| 1_usize << power));
    places.any(|place| beginning.get(place..).is_some_and(|rest| rest.starts_with(b"\x89HDF\r\n\x1A\n")))
}

/// The first bytes of what gzip packed.
const GZIP: &[u8] = b"\x1F\x8B";

/// The first bytes of an archive without members.
const EMPTY: &[u8] = b"PK\x05\x06";

/// Members by which formats that are zip archives are known.
const FORMATS: [&str; 4] = ["[Content_Types].xml", "xl/workbook.xml", "header.properties", "mimetype"];

/// How a file that begins like this is packed; an archive is looked into as it is stored.
pub(super) fn recognise<R: Read + Seek>(
    name: &Path,
    beginning: &[u8],
    stored: impl FnOnce() -> Result<R, FileError>,
) -> Result<Packing, FileError> {
    if beginning.starts_with(GZIP) {
        return Ok(Packing::Gzip);
    }
    if is_zip(beginning) {
        return archive(name, stored()?);
    }
    Ok(Packing::None)
}

fn archive(path: &Path, stored: impl Read + Seek) -> Result<Packing, FileError> {
    let mut archive = ZipArchive::new(stored).map_err(|error| damaged(path, &error))?;
    if archive.file_names().any(|name| name.is_ok_and(|name| FORMATS.contains(&&*name))) {
        return Ok(Packing::None);
    }
    match files(&archive)[..] {
        [] => Err(FileError::of(path, FileProblem::EmptyArchive)),
        [index] => match member(path, &mut archive, index)? {
            member if member.is_encrypted => Err(FileError::of(path, FileProblem::Encrypted)),
            member => Ok(Packing::Zip(member)),
        },
        ref several => Ok(Packing::Archive(several.len())),
    }
}

/// Numbers of the files in an archive: without folders, and without what macOS puts beside every file.
fn files<R: Read + Seek>(archive: &ZipArchive<R>) -> Vec<usize> {
    let noise = |name: &str| name.ends_with('/') || name.starts_with("__MACOSX/") || name.ends_with(".DS_Store");
    let is_file =
        |index: &usize| archive.name_for_index(*index).is_some_and(|name| !name.is_ok_and(|name| noise(&name)));
    (0..archive.len()).filter(is_file).collect()
}

/// The files in an archive, in its order. That they share bytes, so that each unpacks to much, is refused.
pub(super) fn members(path: &Path, stored: impl Read + Seek) -> Result<Vec<Member>, FileError> {
    let mut archive = ZipArchive::new(stored).map_err(|error| damaged(path, &error))?;
    let files = files(&archive);
    if files.len() > MOST_FILES {
        let found = files.len().to_string();
        return Err(FileError::of(
            path,
            FileProblem::damaged("zip archive", format!("at most {MOST_FILES} files"), found),
        ));
    }
    let members: Vec<Member> =
        files.into_iter().map(|index| member(path, &mut archive, index)).collect::<Result<_, _>>()?;
    let mut places: Vec<(u64, u64)> = members.iter().map(|member| (member.start, member.packed)).collect();
    places.sort_unstable();
    let overlap = places.windows(2).any(|pair| pair[0].0.saturating_add(pair[0].1) > pair[1].0);
    if overlap {
        let found = "files that share bytes";
        return Err(FileError::of(path, FileProblem::damaged("zip archive", "files one behind the other", found)));
    }
    Ok(members)
}

/// The file with this number.
fn member<R: Read + Seek>(path: &Path, archive: &mut ZipArchive<R>, index: usize) -> Result<Member, FileError> {
    let file = archive.by_index_raw(index).map_err(|error| damaged(path, &error))?;
    let start = file.data_start().ok_or_else(|| {
        FileError::of(path, FileProblem::damaged("zip archive", "where each of its files begins", "nothing"))
    })?;
    Ok(Member {
        name: file.name().map_or_else(|_| format!("file {}", index + 1), Cow::into_owned),
        start,
        packed: file.compressed_size(),
        method: file.compression(),
        sum: file.crc32(),
        is_encrypted: file.encrypted(),
    })
}

fn damaged(path: &Path, error: &ZipError) -> FileError {
    let found = match error {
        ZipError::InvalidArchive(_) => "one that is cut off or overwritten".to_owned(),
        other => other.to_string(),
    };
    FileError::of(path, FileProblem::damaged("zip archive", "a whole archive", found))
}

/// The unpacked bytes behind `stored`; more than [`MOST_UNPACKED`] of them are an error of the reader.
pub(super) fn unpacked<R: Read + Seek + Send + 'static>(
    stored: R,
    packing: &Packing,
) -> io::Result<Box<dyn Read + Send>> {
    Ok(match packing {
        Packing::None | Packing::Archive(_) => Box::new(stored),
        Packing::Gzip => Box::new(Limited(MultiGzDecoder::new(stored), MOST_UNPACKED)),
        Packing::Zip(member) => {
            let mut member = Unpacked::of(stored, member)?;
            let mut first = Vec::new();
            member.by_ref().take(GZIP.len() as u64).read_to_end(&mut first)?;
            let is_gzip = first == GZIP;
            let whole = io::Cursor::new(first).chain(member);
            match is_gzip {
                true => Box::new(Limited(MultiGzDecoder::new(whole), MOST_UNPACKED)),
                false => Box::new(Limited(whole, MOST_UNPACKED)),
            }
        }
    })
}

/// One member of an archive, unpacked as it is read.
///
/// The reader of an archive borrows from it, so that both cannot be held: the member's raw bytes are cut out and unpacked here.
struct Unpacked {
    bytes: CrcReader<Box<dyn Read + Send>>,
    expected_sum: u32,
}

impl Unpacked {
    fn of<R: Read + Seek + Send + 'static>(mut stored: R, member: &Member) -> io::Result<Self> {
        stored.seek(io::SeekFrom::Start(member.start))?;
        let raw = io::BufReader::new(stored.take(member.packed));
        let bytes: Box<dyn Read + Send> = match member.method {
            CompressionMethod::Stored => Box::new(raw),
            CompressionMethod::Deflated => Box::new(flate2::bufread::DeflateDecoder::new(raw)),
            other => return Err(io::Error::other(format!("some packed by {other:?}; deflate is understood"))),
        };
        Ok(Self {
            bytes: CrcReader::new(bytes),
            expected_sum: member.sum,
        })
    }
}

impl Read for Unpacked {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let got = self.bytes.read(into)?;
        if got == 0 && !into.is_empty() && self.bytes.crc().sum() != self.expected_sum {
            return Err(io::Error::other("others than were packed (checksum)"));
        }
        Ok(got)
    }
}

/// A reader, and how many bytes it may still give.
struct Limited<R>(R, u64);

impl<R: Read> Read for Limited<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let got = self.0.read(into)?;
        let left = self.1.checked_sub(got as u64);
        self.1 = left.ok_or(io::ErrorKind::FileTooLarge)?;
        Ok(got)
    }
}
