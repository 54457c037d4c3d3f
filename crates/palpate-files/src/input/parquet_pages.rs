//! The heads of the pages of a Parquet file, gone over before room is made for what they state.
//!
//! The crate `parquet` makes room for as many bytes as a head says its page unpacks to, and for as many values as a head
//! says its dictionary has. It takes the number of a known field whatever the kind of the field says, so that a head that
//! is not exactly as the format has it is refused here: what is checked is what `parquet` reads.
//!
//! A head is a structure of Thrift's compact protocol: fields, each a byte with its kind and how far its number is from
//! the one before. The second field is the unpacked size of the page, the third its packed size, and the seventh describes
//! a dictionary.

use parquet::{
    basic::{Compression, Type},
    errors::ParquetError,
    file::{metadata::ColumnChunkMetaData, reader::ChunkReader},
};

/// Bytes that the head of a page mostly has, and most that it may have (16 MiB).
const USUAL_HEAD: u64 = 4096;
/// See [`USUAL_HEAD`].
const MOST_OF_HEAD: u64 = 16 << 20;

/// Deepest structures inside one another; those of the format have four.
const DEEPEST: usize = 8;

/// Kinds of fields: whole numbers of 32 bits, and structures.
const WHOLE: u8 = 5;
/// See [`WHOLE`].
const STRUCTURE: u8 = 12;

/// Why the pages of a column are not read.
#[derive(Debug)]
pub(crate) enum PageProblem {
    /// A page unpacks to more than may be unpacked.
    Beyond,
    /// A page is not as the format has it.
    Damaged {
        /// Where its head begins.
        at: u64,
        /// What the format has there.
        expected: String,
        /// What is there.
        found: String,
    },
    /// The bytes cannot be read.
    Unread(ParquetError),
}

/// Checks what the pages of a column of a row group state; each may unpack to `most` bytes.
///
/// Panics where the column begins before the file, as `parquet` does.
pub(crate) fn check_pages(file: &impl ChunkReader, column: &ColumnChunkMetaData, most: u64) -> Result<(), PageProblem> {
    let packed = column.compression() != Compression::UNCOMPRESSED;
    let (mut start, length) = column.byte_range();
    let end = start.saturating_add(length).min(file.len());
    while start < end {
        let in_next = |most: u64| {
            let bytes = file.get_bytes(start, (end - start).min(most) as usize).map_err(PageProblem::Unread)?;
            Ok(page(&bytes))
        };
        // The least and greatest value of a page of texts stand in its head.
        let page = match in_next(USUAL_HEAD)? {
            None if end - start > USUAL_HEAD => in_next(MOST_OF_HEAD)?,
            page => page,
        };
        let damaged = |expected: String, found: String| PageProblem::Damaged {
            at: start,
            expected,
            found,
        };
        let page = page.ok_or_else(|| damaged("the head of a page".to_owned(), "other bytes".to_owned()))?;
        if packed && page.unpacked > most {
            return Err(PageProblem::Beyond);
        }
        let left = (end - start).saturating_sub(page.head);
        if page.packed > left {
            return Err(damaged(format!("a page of at most {left} bytes"), page.packed.to_string()));
        }
        let size = if packed { page.unpacked } else { page.packed };
        if page.values > size / least_width(column) {
            return Err(damaged(format!("a dictionary of {size} bytes"), format!("one of {} values", page.values)));
        }
        start = start.saturating_add(page.head).saturating_add(page.packed);
    }
    Ok(())
}

/// Fewest bytes of a value in a dictionary of a column.
fn least_width(column: &ColumnChunkMetaData) -> u64 {
    match column.column_type() {
        Type::BOOLEAN => 1,
        // The length of a text takes four bytes.
        Type::INT32 | Type::FLOAT | Type::BYTE_ARRAY => 4,
        Type::INT64 | Type::DOUBLE => 8,
        Type::INT96 => 12,
        Type::FIXED_LEN_BYTE_ARRAY => u64::try_from(column.column_descr().type_length()).unwrap_or(0).max(1),
    }
}

/// The head of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Page {
    /// Bytes that the head takes.
    head: u64,
    /// Bytes behind it, as they are stored.
    packed: u64,
    /// What they unpack to.
    unpacked: u64,
    /// How many values there are in a dictionary; none of another page.
    values: u64,
}

/// The head of the page that begins `bytes`; `None` where it is none, or goes on behind them.
fn page(bytes: &[u8]) -> Option<Page> {
    let mut head = Bytes { bytes, at: 0 };
    let (mut unpacked, mut packed, mut values) = (None, None, 0);
    let mut field = 0;
    while let Some(kind) = head.field(&mut field)? {
        match (field, kind) {
            (2, WHOLE) => unpacked = Some(head.size()?),
            (3, WHOLE) => packed = Some(head.size()?),
            (1 | 4, WHOLE) => drop(head.number()?),
            // A page of values, an index, and a page of values of the second version, by their numbers of whole numbers.
            (5, STRUCTURE) => drop(head.known(4)?),
            (6, STRUCTURE) => drop(head.known(0)?),
            (7, STRUCTURE) => values = head.known(2)?,
            (8, STRUCTURE) => drop(head.known(6)?),
            (1..=8, _) => return None,
            (_, kind) => head.value(kind, DEEPEST)?,
        }
    }
    Some(Page {
        head: head.at as u64,
        packed: packed?,
        unpacked: unpacked?,
        values,
    })
}

struct Bytes<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Bytes<'_> {
    fn byte(&mut self) -> Option<u8> {
        let byte = *self.bytes.get(self.at)?;
        self.at += 1;
        Some(byte)
    }

    fn skip(&mut self, count: u64) -> Option<()> {
        let end = self.at.checked_add(usize::try_from(count).ok()?)?;
        self.at = (end <= self.bytes.len()).then_some(end)?;
        Some(())
    }

    /// Seven bits a byte, lowest first.
    fn number(&mut self) -> Option<u64> {
        let mut number = 0;
        for place in 0..10 {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7F) << (7 * place);
            if byte & 0x80 == 0 {
                return Some(number);
            }
        }
        None
    }

    /// A size, which is kept as 2n (or 2n − 1 of a negative one), and has 31 bits.
    fn size(&mut self) -> Option<u64> {
        let kept = self.number()?;
        (kept & 1 == 0 && kept >> 32 == 0).then_some(kept >> 1)
    }

    /// Goes to the next field of a structure, whose number replaces that of the one before: its kind, or `None` at the end.
    fn field(&mut self, number: &mut i16) -> Option<Option<u8>> {
        let lead = self.byte()?;
        if lead == 0 {
            return Some(None);
        }
        *number = match lead >> 4 {
            0 => self.number().and_then(|kept| i16::try_from((kept >> 1) as i64 ^ -((kept & 1) as i64)).ok())?,
            step => number.checked_add(i16::from(step))?,
        };
        Some(Some(lead & 0x0F))
    }

    /// A structure of the format whose first fields are so many whole numbers: the first of these, a count.
    fn known(&mut self, whole: i16) -> Option<u64> {
        let (mut field, mut count) = (0, 0);
        while let Some(kind) = self.field(&mut field)? {
            match (field, kind) {
                (1, WHOLE) => count = self.size()?,
                (_, kind) if kind != WHOLE && (1..=whole).contains(&field) => return None,
                (_, kind) => self.value(kind, DEEPEST)?,
            }
        }
        Some(count)
    }

    fn value(&mut self, kind: u8, deepest: usize) -> Option<()> {
        let deepest = deepest.checked_sub(1)?;
        match kind {
            // Truths are in the lead of their field.
            1 | 2 => Some(()),
            3 => self.skip(1),
            4..=6 => self.number().map(drop),
            7 => self.skip(8),
            8 => {
                let length = self.number()?;
                self.skip(length)
            }
            9 | 10 => {
                let lead = self.byte()?;
                let count = if lead >> 4 == 15 { self.number()? } else { u64::from(lead >> 4) };
                // A truth in a list takes a byte, which not every reader passes over; the format has none.
                (lead & 0x0F > 2 || count == 0).then_some(())?;
                (0..count).try_for_each(|_| self.value(lead & 0x0F, deepest))
            }
            STRUCTURE => {
                let mut field = 0;
                while let Some(kind) = self.field(&mut field)? {
                    self.value(kind, deepest)?;
                }
                Some(())
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Head of a page: its size, the packed and unpacked size of the page, and the values of a dictionary.
    fn page_of(bytes: &[u8]) -> Option<(u64, u64, u64, u64)> {
        page(bytes).map(|page| (page.head, page.packed, page.unpacked, page.values))
    }

    #[test]
    fn sizes_are_found_and_what_stands_behind_them_is_passed_over() {
        // Kind 0, 300 bytes of 20, then a structure with four numbers and another with a text and a list of two numbers.
        let sizes = [0x15, 0, 0x15, 0xD8, 0x04, 0x15, 40];
        let values = [0x2C, 0x15, 8, 0x15, 0, 0x15, 6, 0x15, 6, 0x1C, 0x18, 2, b'a', b'b', 0x19, 0x25, 2, 4, 0, 0, 0];
        let head = [&sizes[..], &values].concat();
        assert_eq!(page_of(&[&head[..], &[9; 5]].concat()), Some((28, 20, 300, 0)));
        for length in 0..head.len() {
            assert_eq!(page(&head[..length]), None, "{length}");
        }
        // A dictionary of 33 sorted values; a checksum may be negative.
        let dictionary = [0x15, 3, 0x3C, 0x15, 66, 0x15, 0, 0x11, 0, 0];
        assert_eq!(page_of(&[&sizes[..], &dictionary].concat()), Some((17, 20, 300, 33)));
        // The number of a field may stand behind its lead.
        assert_eq!(page_of(&[0x05, 4, 8, 0x15, 2, 0]), Some((6, 1, 4, 0)));
    }

    #[test]
    fn heads_that_are_not_exactly_as_the_format_has_them_are_none() {
        let none = |why: &str, bytes: &[u8]| assert_eq!(page(bytes), None, "{why}");
        none("a negative size", &[0x25, 9, 0x15, 2, 0]);
        none("a size of 32 bits", &[0x25, 0x80, 0x80, 0x80, 0x80, 0x10, 0x15, 2, 0]);
        none("one size", &[0x25, 8, 0]);
        none("a size of another kind", &[0x26, 8, 0x15, 2, 0]);
        none("a text in place of the checksum", &[0x25, 8, 0x15, 2, 0x18, 1, b'a', 0]);
        none("a text in place of a number of values", &[0x25, 8, 0x15, 2, 0x4C, 0x18, 1, b'a', 0, 0]);
        none("truths in a list", &[0x25, 8, 0x15, 2, 0xC9, 0x11, 1, 0]);
        none("the number of a field beyond 16 bits", &[0x05, 0x84, 0x80, 8, 8, 0x15, 2, 0]);
        none("structures in structures", &[0x1C; 100]);
    }
}
