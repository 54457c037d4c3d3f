//! The head of a page: a structure of Thrift's compact protocol.
//!
//! The structure is a row of fields, each a byte with its kind and how far its number is from the one before. The second
//! field is the unpacked size of the page and the third its packed size. The fifth describes a page of values, the seventh
//! a dictionary, and the eighth a page of values of the second version, whose levels are never packed.
//!
//! The crate `parquet` takes the number of a known field whatever the kind of the field says, so that a head that is not
//! exactly as the format has it is refused here: what is checked is what `parquet` reads.

use super::number;

/// Deepest structures inside one another; those of the format have four.
const DEEPEST: usize = 8;

/// Kinds of fields: a truth that is so, one that is not, whole numbers of 32 bits, and structures.
const TRUE: u8 = 1;
/// See [`TRUE`].
const FALSE: u8 = 2;
/// See [`TRUE`].
const WHOLE: u8 = 5;
/// See [`TRUE`].
const STRUCTURE: u8 = 12;

/// Encodings that begin with the lengths of the texts of a page, by their numbers in the format.
const LENGTHS_FIRST: [u64; 2] = [6, 7];

/// The head of a page.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Head {
    /// Bytes that the head takes.
    pub length: u64,
    /// Bytes behind it, as they are stored.
    pub packed: u64,
    /// What they unpack to.
    pub unpacked: u64,
    /// How many of them come first and are never packed.
    pub plain: u64,
    /// The others are not packed either, whatever the column says.
    pub stored: bool,
    /// How many values there are in a dictionary; none of another page.
    pub dictionary: u64,
    /// Its values begin with their lengths.
    pub lengths_first: bool,
}

impl Head {
    /// The head that begins `bytes`; `None` where it is none, or goes on behind them.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        let mut fields = Bytes { bytes, at: 0 };
        let mut head = Self::default();
        let (mut unpacked, mut packed) = (None, None);
        let mut field = 0;
        while let Some(kind) = fields.field(&mut field)? {
            match (field, kind) {
                (2, WHOLE) => unpacked = Some(fields.size()?),
                (3, WHOLE) => packed = Some(fields.size()?),
                (1 | 4, WHOLE) => drop(fields.number()?),
                (5, STRUCTURE) => {
                    let ([_values, encoding, _, _], _) = fields.known()?;
                    head.lengths_first |= LENGTHS_FIRST.contains(&encoding);
                }
                (6, STRUCTURE) => drop(fields.known::<0>()?),
                (7, STRUCTURE) => ([head.dictionary, _], _) = fields.known()?,
                (8, STRUCTURE) => {
                    let ([_values, _nulls, _rows, encoding, definitions, repetitions], packed) = fields.known()?;
                    head.lengths_first |= LENGTHS_FIRST.contains(&encoding);
                    head.plain = definitions + repetitions;
                    head.stored = packed == Some(false);
                }
                (1..=8, _) => return None,
                (_, kind) => fields.value(kind, DEEPEST)?,
            }
        }
        (head.packed, head.unpacked, head.length) = (packed?, unpacked?, fields.at as u64);
        Some(head)
    }
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

    fn number(&mut self) -> Option<u64> {
        let mut behind = self.bytes.get(self.at..)?;
        let number = number(&mut behind)?;
        self.at = self.bytes.len() - behind.len();
        Some(number)
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

    /// A structure of the format whose first fields are `N` counts: these, and the truth that is the field behind them.
    fn known<const N: usize>(&mut self) -> Option<([u64; N], Option<bool>)> {
        let (mut field, mut counts, mut truth) = (0, [0; N], None);
        while let Some(kind) = self.field(&mut field)? {
            let index = usize::try_from(field).ok()?.checked_sub(1)?;
            match (counts.get_mut(index), kind) {
                (Some(count), WHOLE) => *count = self.size()?,
                (Some(_), _) => return None,
                (None, TRUE | FALSE) if index == N => truth = Some(kind == TRUE),
                (None, _) => self.value(kind, DEEPEST)?,
            }
        }
        Some((counts, truth))
    }

    fn value(&mut self, kind: u8, deepest: usize) -> Option<()> {
        let deepest = deepest.checked_sub(1)?;
        match kind {
            // Truths are in the lead of their field.
            TRUE | FALSE => Some(()),
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
                (lead & 0x0F > FALSE || count == 0).then_some(())?;
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
        Head::of(bytes).map(|head| (head.length, head.packed, head.unpacked, head.dictionary))
    }

    #[test]
    fn sizes_are_found_and_what_stands_behind_them_is_passed_over() {
        // Kind 0, 300 bytes of 20, then a structure with four numbers and another with a text and a list of two numbers.
        let sizes = [0x15, 0, 0x15, 0xD8, 0x04, 0x15, 40];
        let values = [0x2C, 0x15, 8, 0x15, 0, 0x15, 6, 0x15, 6, 0x1C, 0x18, 2, b'a', b'b', 0x19, 0x25, 2, 4, 0, 0, 0];
        let head = [&sizes[..], &values].concat();
        assert_eq!(page_of(&[&head[..], &[9; 5]].concat()), Some((28, 20, 300, 0)));
        for length in 0..head.len() {
            assert_eq!(Head::of(&head[..length]), None, "{length}");
        }
        // A dictionary of 33 sorted values; a checksum may be negative.
        let dictionary = [0x15, 3, 0x3C, 0x15, 66, 0x15, 0, 0x11, 0, 0];
        assert_eq!(page_of(&[&sizes[..], &dictionary].concat()), Some((17, 20, 300, 33)));
        // The number of a field may stand behind its lead.
        assert_eq!(page_of(&[0x05, 4, 8, 0x15, 2, 0]), Some((6, 1, 4, 0)));
    }

    #[test]
    fn heads_that_are_not_exactly_as_the_format_has_them_are_none() {
        let none = |why: &str, bytes: &[u8]| assert_eq!(Head::of(bytes), None, "{why}");
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
