//! Lines: of a text in memory, and of a file too large for it.

use super::{encoding::Encoding, feed::Feed, source::Input};
use crate::error::{FileError, FileProblem};

/// Longest line that is read, in bytes. A row of ten thousand columns still fits.
pub(crate) const LONGEST_LINE: usize = 256 * 1024;

/// The lines of `text`, ended by LF, CR LF or CR, without these ends.
pub(crate) fn of_text(text: &str) -> Vec<&str> {
    let pieces = text.split_terminator('\n').map(|piece| piece.strip_suffix('\r').unwrap_or(piece));
    pieces.flat_map(|piece| piece.split('\r')).collect()
}

/// Some lines of a file, stretch by stretch: which line of the file each of them is.
#[derive(Debug, Default)]
pub(crate) struct Excerpt {
    /// Of each stretch, in order, its first line in the excerpt and in the file.
    stretches: Vec<(usize, usize)>,
    lines: usize,
}

impl Excerpt {
    /// Adds so many lines, of which the first has this number in the file, from 1.
    pub(crate) fn push(&mut self, first: usize, lines: usize) {
        self.stretches.push((self.lines + 1, first));
        self.lines += lines;
    }

    /// The line of the file that a line of the excerpt is, and how many lines of the stretch follow it.
    pub(crate) fn line(&self, own: usize) -> (usize, usize) {
        let behind = self.stretches.partition_point(|(first, _)| *first <= own);
        let end = self.stretches.get(behind).map_or(usize::MAX, |(first, _)| *first);
        let (first, line) = behind.checked_sub(1).map_or((1, 1), |index| self.stretches[index]);
        (line + (own - first), end - own - 1)
    }
}

/// Hands out a file line by line from a buffer of bounded size.
pub(crate) struct LineReader<'a> {
    input: &'a Input,
    feed: Feed,
    buffer: Vec<u8>,
    /// Where in the buffer the next line starts.
    start: usize,
    /// Number of the line handed out last.
    line: usize,
    /// The last line ended with CR: an LF right behind it belongs to the same line end.
    after_cr: bool,
}

impl<'a> LineReader<'a> {
    pub(crate) fn open(input: &'a Input, encoding: Encoding) -> Result<Self, FileError> {
        let feed = Feed::open(input, encoding)?;
        Ok(Self {
            input,
            feed,
            buffer: Vec::new(),
            start: 0,
            line: 0,
            after_cr: false,
        })
    }

    /// Number of the line handed out last, from 1.
    pub(crate) fn line(&self) -> usize {
        self.line
    }

    /// Bytes of the file taken in so far, and its size.
    pub(crate) fn progress(&self) -> (u64, u64) {
        self.feed.progress()
    }

    /// The next line without its end, `None` behind the last one.
    pub(crate) fn next_line(&mut self) -> Result<Option<&[u8]>, FileError> {
        let mut searched = 0;
        let (from, to) = loop {
            self.pass_line_feed();
            let ahead = &self.buffer[self.start..];
            let unsearched = ahead.get(searched..).unwrap_or_default();
            if let Some(end) = memchr::memchr2(b'\n', b'\r', unsearched) {
                let end = self.start + searched + end;
                self.after_cr = self.buffer[end] == b'\r';
                let from = std::mem::replace(&mut self.start, end + 1);
                break (from, end);
            }
            searched = ahead.len();
            if searched > LONGEST_LINE {
                let (line, limit) = (self.line + 1, LONGEST_LINE);
                return Err(self.input.wrong(FileProblem::LineTooLong { line, limit }));
            }
            if !self.refill()? {
                let from = std::mem::replace(&mut self.start, self.buffer.len());
                if from == self.start {
                    return Ok(None);
                }
                break (from, self.start);
            }
        };
        self.line += 1;
        Ok(Some(&self.buffer[from..to]))
    }

    /// An LF right behind a CR belongs to the line end that was handed out.
    fn pass_line_feed(&mut self) {
        if self.after_cr && self.start < self.buffer.len() {
            self.start += usize::from(self.buffer[self.start] == b'\n');
            self.after_cr = false;
        }
    }

    /// Takes out whole lines that end with LF, together some `most` bytes; fewer, or none, at the end of the file.
    pub(crate) fn take_lines(&mut self, most: usize, into: &mut Vec<u8>) -> Result<(), FileError> {
        while self.buffer.len() - self.start < most && self.refill()? {}
        self.pass_line_feed();
        self.buffer.drain(..self.start);
        self.start = 0;
        let end = memchr::memrchr(b'\n', &self.buffer).map_or(0, |end| end + 1);
        into.clear();
        std::mem::swap(&mut self.buffer, into);
        self.buffer.extend_from_slice(&into[end..]);
        into.truncate(end);
        Ok(())
    }

    /// Puts lines back that were taken out last and not counted.
    pub(crate) fn put_back(&mut self, lines: &mut Vec<u8>) {
        lines.extend_from_slice(&self.buffer[self.start..]);
        std::mem::swap(&mut self.buffer, lines);
        self.start = 0;
    }

    /// Counts lines that were taken out.
    pub(crate) fn count(&mut self, lines: usize) {
        self.line += lines;
    }

    /// Drops what was handed out and takes more in; `false` at the end of the file.
    fn refill(&mut self) -> Result<bool, FileError> {
        self.buffer.drain(..self.start);
        self.start = 0;
        let taken = self.feed.fill(&mut self.buffer);
        taken.map(|bytes| bytes > 0).map_err(|error| self.input.failed(error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_ends_of_every_kind() {
        assert_eq!(of_text("a\nb\r\nc\rd"), ["a", "b", "c", "d"]);
        assert_eq!(of_text("\n\r\na\n"), ["", "", "a"]);
        assert!(of_text("").is_empty());
    }

    #[test]
    fn streamed_lines_equal_those_in_memory() -> Result<(), Box<dyn std::error::Error>> {
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("lines.txt");
        let mut text = String::new();
        for row in 0..60_000 {
            text.push_str(&row.to_string());
            text.push_str(["\n", "\r\n", "\r", "\n\n"][row % 4]);
        }
        std::fs::write(&path, &text)?;
        let input = Input::open(&path)?;
        let mut reader = LineReader::open(&input, Encoding::Utf8)?;
        for expected in of_text(&text) {
            assert_eq!(reader.next_line()?, Some(expected.as_bytes()));
        }
        assert_eq!(reader.next_line()?, None);
        assert_eq!(reader.progress(), (text.len() as u64, text.len() as u64));
        Ok(())
    }
}
