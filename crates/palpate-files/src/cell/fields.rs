//! Splitting one line into cells.

use super::mark::Delimiter;

/// The cells of one line, left to right, each without its quotes and without blanks around it.
///
/// Works on bytes of any encoding that splits like ASCII. A quote counts only where a cell begins with it, so an
/// inch mark inside a cell does no harm; doubled quotes inside a quoted cell are left as they are.
#[derive(Debug, Clone)]
pub(crate) struct Fields<'a> {
    /// What is left of the line; `None` when the last cell is out.
    rest: Option<&'a [u8]>,
    /// The delimiting byte, or `None` for runs of blanks.
    delimiter: Option<u8>,
}

impl<'a> Fields<'a> {
    /// Starts on a line given without its line end. A blank line has one empty cell, or none under
    /// [`Delimiter::Blanks`].
    #[inline]
    pub(crate) fn of(line: &'a [u8], delimiter: Delimiter) -> Self {
        let delimiter = delimiter.byte();
        let rest = match delimiter {
            Some(_) => Some(line),
            None => Some(trim(line)).filter(|line| !line.is_empty()),
        };
        Self { rest, delimiter }
    }

    /// Takes a cell that begins with a quote; `line` starts right behind that quote.
    fn quoted(&mut self, line: &'a [u8]) -> &'a [u8] {
        let mut from = 0;
        let end = loop {
            match memchr::memchr(b'"', &line[from..]).map(|at| from + at) {
                Some(quote) if line.get(quote + 1) == Some(&b'"') => from = quote + 2,
                Some(quote) => break quote,
                None => break line.len(),
            }
        };
        let cell = &line[..end];
        let behind = line.get(end + 1..).unwrap_or_default();
        self.rest = match self.delimiter {
            Some(delimiter) => behind.iter().position(|&byte| byte == delimiter).map(|place| &behind[place + 1..]),
            None => Some(trim(behind)).filter(|rest| !rest.is_empty()),
        };
        trim(cell)
    }
}

impl<'a> Iterator for Fields<'a> {
    type Item = &'a [u8];

    #[inline]
    fn next(&mut self) -> Option<&'a [u8]> {
        let line = self.rest?;
        let start = line.iter().position(|&byte| !is_blank(byte, self.delimiter)).unwrap_or(line.len());
        if line.get(start) == Some(&b'"') {
            return Some(self.quoted(&line[start + 1..]));
        }
        let tail = &line[start..];
        let Some(delimiter) = self.delimiter else {
            let end = tail.iter().position(|&byte| byte == b' ' || byte == b'\t');
            self.rest = end.map(|end| trim(&tail[end..])).filter(|rest| !rest.is_empty());
            return Some(&tail[..end.unwrap_or(tail.len())]);
        };
        let end = tail.iter().position(|&byte| byte == delimiter);
        self.rest = end.map(|end| &tail[end + 1..]);
        Some(trim_end(&tail[..end.unwrap_or(tail.len())], self.delimiter))
    }
}

/// A blank is a space, or a tabulator that is not the delimiter.
#[inline]
fn is_blank(byte: u8, delimiter: Option<u8>) -> bool {
    byte == b' ' || (byte == b'\t' && delimiter != Some(b'\t'))
}

#[inline]
fn trim_end(bytes: &[u8], delimiter: Option<u8>) -> &[u8] {
    let last = bytes.iter().rposition(|&byte| !is_blank(byte, delimiter));
    &bytes[..last.map_or(0, |last| last + 1)]
}

/// Less the spaces and tabulators at both ends.
fn trim(bytes: &[u8]) -> &[u8] {
    let first = bytes.iter().position(|&byte| !is_blank(byte, None));
    trim_end(&bytes[first.unwrap_or(bytes.len())..], None)
}

/// The cells of a line of text.
pub(crate) fn cells(line: &str, delimiter: Delimiter) -> Vec<&str> {
    Fields::of(line.as_bytes(), delimiter)
        // Cells are cut at ASCII bytes only, so every cell of a text is text.
        .map(|cell| std::str::from_utf8(cell).unwrap_or_default())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_and_quoted() {
        assert_eq!(cells("1,2,3", Delimiter::Comma), ["1", "2", "3"]);
        assert_eq!(cells(" 1 ; 2;", Delimiter::Semicolon), ["1", "2", ""]);
        assert_eq!(cells("\"1,5\",\"a\"\"b\" ,3\" pipe", Delimiter::Comma), ["1,5", "a\"\"b", "3\" pipe"]);
        assert_eq!(cells("\"never closed,2", Delimiter::Comma), ["never closed,2"]);
        assert_eq!(cells("\"\",\"", Delimiter::Comma), ["", ""]);
        assert_eq!(cells("", Delimiter::Comma), [""]);
    }

    #[test]
    fn tabs_keep_empty_cells_and_blanks_do_not() {
        assert_eq!(cells("\ta\t\tb c\t", Delimiter::Tab), ["", "a", "", "b c", ""]);
        assert_eq!(cells("  1   \t2 \"x y\" ", Delimiter::Blanks), ["1", "2", "x y"]);
        assert!(cells("   ", Delimiter::Blanks).is_empty());
    }
}
