//! Telling packed files by their content, and unpacking them.

use std::{
    fmt,
    io::{self, Read, Seek},
    path::Path,
};

use flate2::{CrcReader, read::MultiGzDecoder};
use zip::{ZipArchive, result::ZipError};

use crate::error::{FileError, FileProblem};

/// Most bytes that a packed file may unpack to where its rows are streamed (64 GiB).
pub const MOST_UNPACKED: u64 = 64 << 30;

/// How a file is packed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Packing {
    /// Not at all. A workbook or force curve that is a zip archive by itself counts as not packed.
    None,
    /// By gzip.
    Gzip,
    /// Alone in a zip archive.
    Zip {
        /// Its name in the archive.
        member: String,
    },
}

impl fmt::Display for Packing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("not packed"),
            Self::Gzip => f.write_str("packed by gzip"),
            Self::Zip { member } => write!(f, "packed in a zip archive as {}", crate::error::shown(member)),
        }
    }
}

/// Whether the bytes of an archive's first member can begin here.
pub(crate) fn is_zip(beginning: &[u8]) -> bool {
    beginning.starts_with(b"PK\x03\x04") || beginning.starts_with(EMPTY)
}

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
    if beginning.starts_with(b"\x1F\x8B") {
        return Ok(Packing::Gzip);
    }
    if is_zip(beginning) {
        return archive(name, stored()?);
    }
    Ok(Packing::None)
}

fn archive(path: &Path, stored: impl Read + Seek) -> Result<Packing, FileError> {
    let mut archive = ZipArchive::new(stored).map_err(|error| damaged(path, &error))?;
    let names: Vec<String> = archive.file_names().filter_map(|name| Some(name.ok()?.into_owned())).collect();
    if names.iter().any(|name| FORMATS.contains(&name.as_str())) {
        return Ok(Packing::None);
    }
    // Folders, and what macOS puts beside every file.
    let noise = |name: &str| name.ends_with('/') || name.starts_with("__MACOSX/") || name.ends_with(".DS_Store");
    let files: Vec<String> = names.into_iter().filter(|name| !noise(name)).collect();
    let [member] = &files[..] else {
        return Err(FileError::of(path, FileProblem::Archive(files)));
    };
    let index = archive.index_for_name(member);
    match index.and_then(|index| Some(archive.by_index_raw(index).ok()?.encrypted())) {
        Some(true) => Err(FileError::of(path, FileProblem::Encrypted)),
        _ => Ok(Packing::Zip { member: member.clone() }),
    }
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
        Packing::None => Box::new(stored),
        Packing::Gzip => Box::new(Limited(MultiGzDecoder::new(stored), MOST_UNPACKED)),
        Packing::Zip { member } => {
            let archive = ZipArchive::new(stored).map_err(io::Error::other)?;
            Box::new(Limited(Member::of(archive, member)?, MOST_UNPACKED))
        }
    })
}

/// One member of an archive, unpacked as it is read.
///
/// The reader of the archive borrows from it; to hold both, the member's raw bytes are cut out of the archive and
/// unpacked here.
struct Member {
    bytes: CrcReader<Box<dyn Read + Send>>,
    expected_sum: u32,
}

impl Member {
    fn of<R: Read + Seek + Send + 'static>(mut archive: ZipArchive<R>, name: &str) -> io::Result<Self> {
        let (start, packed, method, expected_sum) = {
            let member = archive.by_name(name).map_err(|error| match error {
                ZipError::InvalidArchive(_) => io::ErrorKind::UnexpectedEof.into(),
                other => io::Error::other(other),
            })?;
            let start = member
                .data_start()
                .ok_or_else(|| io::Error::other("the archive does not state where its file begins"))?;
            (start, member.compressed_size(), member.compression(), member.crc32())
        };
        let mut stored = archive.into_inner();
        stored.seek(io::SeekFrom::Start(start))?;
        let raw = io::BufReader::new(stored.take(packed));
        let bytes: Box<dyn Read + Send> = match method {
            zip::CompressionMethod::Stored => Box::new(raw),
            zip::CompressionMethod::Deflated => Box::new(flate2::bufread::DeflateDecoder::new(raw)),
            other => return Err(io::Error::other(format!("some packed by {other:?}; deflate is understood"))),
        };
        let bytes = CrcReader::new(bytes);
        Ok(Self { bytes, expected_sum })
    }
}

impl Read for Member {
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
