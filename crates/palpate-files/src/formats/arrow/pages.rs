//! The heads of the pages of a Parquet file, gone over before room is made for what they say they unpack to.
//!
//! A head is a structure of Thrift's compact protocol: fields, each a byte with its kind and how far its number is from
//! the one before. The second field is the unpacked size of the page, the third its packed size.

/// Deepest structures inside one another; those of the format have four.
const DEEPEST: usize = 8;

/// The head of a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Page {
    /// Bytes that the head takes.
    pub(super) head: u64,
    /// Bytes behind it, as they are stored.
    pub(super) packed: u64,
    /// What they unpack to.
    pub(super) unpacked: u64,
}

/// The head of the page that begins `bytes`; `None` where it is none, or goes on behind them.
pub(super) fn page(bytes: &[u8]) -> Option<Page> {
    let mut head = Bytes { bytes, at: 0 };
    // Sizes are kept as 2n, or 2n − 1 of a negative one.
    let [_, _, unpacked, packed] =
        head.structure(DEEPEST)?.map(|size| if size & 1 == 0 { size >> 1 } else { u64::MAX });
    Some(Page {
        head: head.at as u64,
        packed,
        unpacked,
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

    /// The whole numbers of the first fields of a structure, as they are kept, at its end.
    fn structure(&mut self, deepest: usize) -> Option<[u64; 4]> {
        let deepest = deepest.checked_sub(1)?;
        let (mut field, mut numbers) = (0_i64, [0; 4]);
        loop {
            let lead = self.byte()?;
            if lead == 0 {
                return Some(numbers);
            }
            field = match lead >> 4 {
                0 => self.number().map(|kept| (kept >> 1) as i64 ^ -((kept & 1) as i64))?,
                step => field.checked_add(i64::from(step))?,
            };
            match lead & 0x0F {
                // Truths are in the lead.
                1 | 2 => {}
                4..=6 => {
                    let number = self.number()?;
                    if let Some(kept) = usize::try_from(field).ok().and_then(|field| numbers.get_mut(field)) {
                        *kept = number;
                    }
                }
                kind => self.value(kind, deepest)?,
            }
        }
    }

    fn value(&mut self, kind: u8, deepest: usize) -> Option<()> {
        match kind {
            1..=3 => self.skip(1),
            4..=6 => self.number().map(drop),
            7 => self.skip(8),
            8 => {
                let length = self.number()?;
                self.skip(length)
            }
            9 | 10 => {
                let lead = self.byte()?;
                let count = if lead >> 4 == 15 { self.number()? } else { u64::from(lead >> 4) };
                let deepest = deepest.checked_sub(1)?;
                (0..count).try_for_each(|_| self.value(lead & 0x0F, deepest))
            }
            12 => self.structure(deepest).map(drop),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_found_and_what_stands_behind_them_is_passed_over() {
        // Kind 0, 300 bytes of 20, then a structure with a number, a text and a list of two numbers.
        let head = [0x15, 0, 0x15, 0xD8, 0x04, 0x15, 40, 0x2C, 0x15, 8, 0x18, 2, b'a', b'b', 0x19, 0x25, 2, 4, 0, 0];
        let page_of = |bytes: &[u8]| page(bytes).map(|page| (page.head, page.packed, page.unpacked));
        assert_eq!(page_of(&[&head[..], &[9; 5]].concat()), Some((20, 20, 300)));
        for length in 0..head.len() {
            assert_eq!(page(&head[..length]), None, "{length}");
        }
        // The number of a field may stand behind its lead, and a size may be negative.
        assert_eq!(page_of(&[0x05, 4, 9, 0x15, 2, 0]), Some((6, 1, u64::MAX)));
        assert_eq!(page(&[0x1C; 100]), None);
    }
}
