//! Bytes of a packed file that hold nothing.

use super::{
    packing::Packing,
    source::{ALWAYS_UNPACKED, Input},
};
use crate::error::{FileError, FileProblem};

/// Bytes of lines without a row that a packed file may have for every row (64), beyond [`ALWAYS_UNPACKED`].
pub const IDLE_A_ROW: u64 = 64;

/// Counts the bytes of lines without a row: a few packed bytes hold millions of blank lines, and to unpack them gives nothing.
pub(crate) struct Idle<'a> {
    input: &'a Input,
    bytes: u64,
}

impl<'a> Idle<'a> {
    pub(crate) fn of(input: &'a Input) -> Self {
        Self { input, bytes: 0 }
    }

    /// Passes over a line of so many bytes, with so many rows before it.
    pub(crate) fn pass(&mut self, length: usize, line: usize, rows: usize) -> Result<(), FileError> {
        self.bytes += length as u64 + 1;
        let most_bytes = (rows as u64).saturating_mul(IDLE_A_ROW).saturating_add(ALWAYS_UNPACKED);
        match self.input.packing == Packing::None || self.bytes <= most_bytes {
            true => Ok(()),
            false => Err(self.input.wrong(FileProblem::Idle { line, most_bytes })),
        }
    }
}
