//! Taking a file in, piece by piece, as bytes that split like ASCII.

use std::io::{self, Read};

use super::{
    encoding::Encoding,
    source::{Input, InputReader},
};
use crate::error::FileError;

/// Bytes taken in at once: large against the cost of a call, small against a processor cache.
const PIECE: usize = 256 * 1024;

/// A file that is decoded only where that is needed to tell its cells apart.
pub(crate) struct Feed {
    bytes: InputReader,
    decoding: Option<Decoding>,
}

struct Decoding {
    decoder: encoding_rs::Decoder,
    raw: Vec<u8>,
    finished: bool,
}

impl Feed {
    /// Opens a file behind its byte order mark, if it has one.
    pub(crate) fn open(input: &Input, encoding: Encoding) -> Result<Self, FileError> {
        let mut bytes = input.reader()?;
        let mark = encoding.mark_length(&input.beginning);
        bytes.read_exact(&mut vec![0; mark]).map_err(|error| input.failed(error))?;
        let decoding = (!encoding.splits_like_ascii()).then(|| Decoding {
            decoder: encoding.codec().new_decoder_without_bom_handling(),
            raw: vec![0; PIECE],
            finished: false,
        });
        Ok(Self { bytes, decoding })
    }

    /// Bytes of the file taken in so far, and its size.
    pub(crate) fn progress(&self) -> (u64, u64) {
        self.bytes.progress()
    }

    /// Appends the next piece and returns its length, 0 at the end of the file.
    pub(crate) fn fill(&mut self, buffer: &mut Vec<u8>) -> io::Result<usize> {
        let held = buffer.len();
        match &mut self.decoding {
            None => {
                buffer.resize(held + PIECE, 0);
                let got = self.bytes.read(&mut buffer[held..]);
                buffer.truncate(held + *got.as_ref().unwrap_or(&0));
                got?;
            }
            Some(decoding) => {
                // One piece may decode to nothing: the first byte of a pair, say.
                while buffer.len() == held && !decoding.finished {
                    let got = self.bytes.read(&mut decoding.raw)?;
                    decoding.append(got, buffer);
                }
            }
        }
        Ok(buffer.len() - held)
    }
}

impl Decoding {
    /// Decodes the first `got` raw bytes; none at all are the end of the file.
    fn append(&mut self, got: usize, buffer: &mut Vec<u8>) {
        self.finished = got == 0;
        let held = buffer.len();
        // The needed length overflows only for pieces of half the address space.
        let room = self.decoder.max_utf8_buffer_length(got).unwrap_or(4 * PIECE);
        buffer.resize(held + room, 0);
        let (_, _, written, _) = self.decoder.decode_to_utf8(&self.raw[..got], &mut buffer[held..], self.finished);
        buffer.truncate(held + written);
    }
}
