//! The elements of a file, unpacked as they are read.

use std::io::{BufReader, Read, SeekFrom, Take};

use flate2::bufread::ZlibDecoder;

use crate::{
    error::FileError,
    input::{Input, MOST_IN_MEMORY, Seekable},
};

/// Bytes before the first element.
const HEADER: u64 = 128;

/// Kinds of elements.
pub(super) const MATRIX: u32 = 14;
const PACKED: u32 = 15;

/// Whether the numbers of a file that begins so have their lowest byte first; `None`: it is no file of level 5.
pub(super) fn order(beginning: &[u8]) -> Option<bool> {
    let is_text = beginning.get(..4)?.iter().all(|byte| *byte != 0);
    match beginning.get(124..128)? {
        _ if !is_text => None,
        [0x00, 0x01, b'I', b'M'] => Some(true),
        [0x01, 0x00, b'M', b'I'] => Some(false),
        _ => None,
    }
}

/// An element at the top of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Element {
    /// Where the bytes behind its tag begin.
    start: u64,
    size: u64,
    is_packed: bool,
}

/// The elements of a file, one after the other.
pub(super) struct Elements<'i> {
    input: &'i Input,
    stored: Box<dyn Seekable>,
    length: u64,
    next: u64,
    pub(super) lowest_first: bool,
}

impl<'i> Elements<'i> {
    pub(super) fn open(input: &'i Input) -> Result<Self, FileError> {
        let lowest_first = order(&input.beginning)
            .ok_or_else(|| input.damaged("header", "that of a MATLAB file of level 5", "another one"))?;
        let mut stored = input.seekable()?;
        let length = stored.seek(SeekFrom::End(0)).map_err(|error| input.failed(error))?;
        Ok(Self {
            input,
            stored,
            length,
            next: HEADER,
            lowest_first,
        })
    }

    /// The next array at the top; elements of other kinds are passed over.
    pub(super) fn next(&mut self) -> Result<Option<Element>, FileError> {
        while self.next < self.length {
            let place = format!("element at byte {}", self.next);
            let cut =
                |expected: &str, found: u64| self.input.damaged(place.as_str(), expected, format!("{found} bytes"));
            if self.length - self.next < 8 {
                return Err(cut("a tag of 8 bytes", self.length - self.next));
            }
            let mut tag = [0; 8];
            let failed = |error| self.input.failed(error);
            self.stored.seek(SeekFrom::Start(self.next)).map_err(failed)?;
            self.stored.read_exact(&mut tag).map_err(failed)?;
            let (kind, size) = (word(&tag[..4], self.lowest_first), u64::from(word(&tag[4..], self.lowest_first)));
            let (start, left) = (self.next + 8, self.length - self.next - 8);
            // A small element has its bytes in its tag.
            let size = if kind > 0xFFFF { 0 } else { size };
            if size > left {
                return Err(cut(&format!("{size} bytes"), left));
            }
            self.next = start + size;
            if matches!(kind, MATRIX | PACKED) {
                return Ok(Some(Element {
                    start,
                    size,
                    is_packed: kind == PACKED,
                }));
            }
        }
        Ok(None)
    }

    /// The bytes of an element: of one that is packed, with the tag of what is inside.
    pub(super) fn bytes(&mut self, element: Element) -> Result<Bytes<'_>, FileError> {
        let Self { input, stored, .. } = self;
        stored.seek(SeekFrom::Start(element.start)).map_err(|error| input.failed(error))?;
        let inside = BufReader::new(stored.take(element.size));
        Ok(match element.is_packed {
            true => Bytes::Packed(ZlibDecoder::new(inside)),
            false => Bytes::Plain(inside, element.size),
        })
    }
}

/// The bytes of an element.
pub(super) enum Bytes<'e> {
    Plain(BufReader<Take<&'e mut Box<dyn Seekable>>>, u64),
    Packed(ZlibDecoder<BufReader<Take<&'e mut Box<dyn Seekable>>>>),
}

impl Read for Bytes<'_> {
    fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
        match self {
            Self::Plain(bytes, _) => bytes.read(into),
            Self::Packed(bytes) => bytes.read(into),
        }
    }
}

/// Bytes that are read in order, no more of them than the file warrants.
pub(super) struct Feed<'f> {
    input: &'f Input,
    bytes: Bytes<'f>,
    read: u64,
}

/// A word of four bytes.
pub(super) fn word(bytes: &[u8], lowest_first: bool) -> u32 {
    let four = [bytes[0], bytes[1], bytes[2], bytes[3]];
    if lowest_first { u32::from_le_bytes(four) } else { u32::from_be_bytes(four) }
}

impl<'f> Feed<'f> {
    pub(super) fn of(input: &'f Input, bytes: Bytes<'f>) -> Self {
        Self { input, bytes, read: 0 }
    }

    /// The size of the array where its element is not packed, and has no tag of its own then.
    pub(super) fn plain_size(&self) -> Option<u64> {
        if let Bytes::Plain(_, size) = self.bytes { Some(size) } else { None }
    }

    /// Fills all of `into`.
    pub(super) fn take(&mut self, into: &mut [u8]) -> Result<(), FileError> {
        self.read += into.len() as u64;
        if matches!(self.bytes, Bytes::Packed(_)) {
            self.input.bounded(self.read, "an array", MOST_IN_MEMORY)?;
        }
        self.bytes.read_exact(into).map_err(|error| {
            if error.raw_os_error().is_some() {
                return self.input.failed(error);
            }
            self.input.damaged("an array", "bytes that can be unpacked", "their end, or others")
        })
    }

    /// Passes over bytes.
    pub(super) fn skip(&mut self, mut count: u64) -> Result<(), FileError> {
        let mut piece = [0; 1 << 14];
        while count > 0 {
            let some = count.min(piece.len() as u64);
            self.take(&mut piece[..some as usize])?;
            count -= some;
        }
        Ok(())
    }
}
