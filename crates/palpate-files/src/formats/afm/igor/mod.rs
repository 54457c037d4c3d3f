//! Igor binary waves (`.ibw`) of the versions 1, 2, 3 and 5, as Igor Pro and the microscopes of Asylum Research write them.
//!
//! A wave is an array of numbers with a name, a unit, and a scale of its rows. One of two dimensions has a label a column, and a microscope
//! of Asylum Research writes `Raw` (or `Height`), `Defl` and `ZSnsr` so, in m, with `key: value` lines beside it. Its heights count from the
//! cantilever towards the sample, so that −`ZSnsr` is a height as the other formats have it.
//!
//! | file | what |
//! |---|---|
//! | `wave.rs` | the bytes of a wave |
//! | `curve.rs` | a wave as a force curve, or as a table |

mod curve;
mod wave;

use crate::{
    error::FileError,
    formats::afm::{assemble::assemble, numbers},
    input::{Input, Number},
    table::{Found, ReadOptions},
};

/// Whether a file begins like a wave: with a version and a header whose checksum is right.
pub(crate) fn recognise(input: &Input) -> bool {
    wave::begins(&input.beginning).is_some()
}

/// Looks into a wave.
pub(crate) fn look_into(input: &Input, _options: &ReadOptions) -> Result<Found, FileError> {
    let bytes = input.bytes()?;
    let wave = wave::read(input, &bytes)?;
    let (curve, skipped) = assemble(curve::drafts(&wave, &bytes), curve::about(&wave));
    let columns = Columns {
        input: input.clone(),
        rows: wave.rows,
        number: wave.number,
        lowest_first: wave.lowest_first,
        data: wave.data,
    };
    Ok(numbers::found(input, curve.into_iter().collect(), skipped, columns))
}

/// The columns of a wave, which lie one behind the other.
struct Columns {
    input: Input,
    rows: usize,
    number: Number,
    lowest_first: bool,
    /// Where the first begins.
    data: usize,
}

impl numbers::Channels for Columns {
    fn numbers(&self, _curve: usize, channel: usize) -> Result<Vec<f64>, FileError> {
        let bytes = self.input.bytes()?;
        let (size, length) = (self.number.size(), self.rows * self.number.size());
        let column = bytes.get(self.data + channel * length..).and_then(|rest| rest.get(..length));
        let column = column.ok_or_else(|| self.input.damaged("wave", "the numbers that were there before", "none"))?;
        Ok(column.chunks_exact(size).map(|cell| self.number.read(cell, self.lowest_first)).collect())
    }
}
