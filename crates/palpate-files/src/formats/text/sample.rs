//! Looking at the beginning of a file.

use std::io::Read;

use crate::{
    error::{FileError, FileProblem, Foreign, mostly_control, recognise_foreign},
    input::{Encoding, Input, LONGEST_LINE, encoding, lines},
};

/// Most lines looked at; what they do not show of a layout, more would not either.
pub(super) const MOST_LINES: usize = 4000;

/// The beginning of a file, decoded.
pub(crate) struct Sample {
    pub(crate) encoding: Encoding,
    text: String,
    /// The file goes on behind the sample.
    cut: bool,
}

impl Sample {
    /// Reads the beginning of a file and decodes it, as `fixed` or as what it looks like.
    pub(crate) fn take(input: &Input, fixed: Option<Encoding>) -> Result<Self, FileError> {
        let mut bytes = Vec::new();
        // One byte more tells whether there is more.
        let read = input.reader()?.take(LONGEST_LINE as u64 + 1).read_to_end(&mut bytes);
        read.map_err(|error| input.failed(error))?;
        let cut = bytes.len() > LONGEST_LINE;
        let foreign = |looks_like| input.wrong(FileProblem::Foreign(looks_like));
        if let Some(looks_like) = recognise_foreign(&bytes) {
            return Err(foreign(looks_like));
        }
        let encoding = fixed.or_else(|| encoding::recognise(&bytes)).ok_or_else(|| foreign(Foreign::Binary))?;
        let body = &bytes[encoding.mark_length(&bytes)..];
        let (text, _) = encoding.codec().decode_without_bom_handling(body);
        if mostly_control(&text) {
            return Err(foreign(Foreign::Binary));
        }
        if text.trim().is_empty() && !cut {
            return Err(input.wrong(FileProblem::Empty));
        }
        let text = text.into_owned();
        if cut && memchr::memchr2(b'\n', b'\r', text.as_bytes()).is_none() {
            let limit = LONGEST_LINE;
            return Err(input.wrong(FileProblem::LineTooLong { line: 1, limit }));
        }
        Ok(Self { encoding, text, cut })
    }

    /// The lines that are in the sample from end to end.
    pub(crate) fn lines(&self) -> Vec<&str> {
        let mut lines = lines::of_text(&self.text);
        if self.cut && lines.len() > 1 {
            lines.pop();
        }
        lines.truncate(MOST_LINES);
        lines
    }
}
