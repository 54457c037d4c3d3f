//! Streams of a compound file: sectors that are chained by a table ([MS-CFB]).

use std::borrow::Cow;

use super::records::{u16_at, u32_at};

/// First bytes of a compound file.
pub(crate) const SIGNATURE: &[u8] = b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1";

/// Sector numbers from here on have a meaning of their own; the end of a chain is one.
const LAST_SECTOR: u32 = 0xFFFF_FFFA;
/// Size of the sectors of small streams.
const SMALL: usize = 64;

/// A compound file with its tables read.
pub(super) struct Compound<'a> {
    large: Sectors<'a>,
    small: Sectors<'a>,
    smallest_large: u64,
    entries: Vec<Entry>,
}

struct Entry {
    name: String,
    start: u32,
    size: u64,
}

/// Sectors of one size, and which follows which.
struct Sectors<'a> {
    bytes: Cow<'a, [u8]>,
    size: usize,
    next: Vec<u32>,
}

impl<'a> Compound<'a> {
    /// `None` where its tables break off or run in a ring.
    pub(super) fn of(file: &'a [u8]) -> Option<Self> {
        let size = match u16_at(file, 30)? {
            9 => 512,
            12 => 4096,
            _ => return None,
        };
        let mut large = Sectors::of(file.get(size..)?, size);
        large.next = table(file, &large)?;
        let directory = large.chain(u32_at(file, 48)?, u64::MAX)?;
        let entries: Vec<Entry> = directory.chunks_exact(128).filter_map(entry).collect();
        let root = entries.first()?;
        let mut small = Sectors::of(&[], SMALL);
        if u32_at(file, 64)? > 0 {
            small.next = numbers(&large.chain(u32_at(file, 60)?, u64::MAX)?);
            small.bytes = large.chain(root.start, root.size)?.into();
        }
        Some(Self {
            large,
            small,
            smallest_large: u64::from(u32_at(file, 56)?),
            entries,
        })
    }

    fn entry(&self, name: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.name.eq_ignore_ascii_case(name))
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.entry(name).is_some()
    }

    /// The bytes of a stream; `None` where there is none of this name or it breaks off.
    pub(super) fn stream(&self, name: &str) -> Option<Vec<u8>> {
        let entry = self.entry(name)?;
        let sectors = if entry.size < self.smallest_large { &self.small } else { &self.large };
        sectors.chain(entry.start, entry.size)
    }
}

impl<'a> Sectors<'a> {
    fn of(bytes: &'a [u8], size: usize) -> Self {
        Self {
            bytes: bytes.into(),
            size,
            next: Vec::new(),
        }
    }

    /// How many there are, but for one that may be cut short.
    fn count(&self) -> usize {
        self.bytes.len() / self.size
    }

    fn get(&self, number: u32) -> Option<&[u8]> {
        let start = (number as usize).checked_mul(self.size)?;
        // The last sector of a file may be short.
        let end = start.checked_add(self.size)?.min(self.bytes.len());
        self.bytes.get(start..end).filter(|sector| !sector.is_empty())
    }

    /// The bytes of a chain, at most `size` of them; it has no more sectors than there are unless it runs in a ring.
    fn chain(&self, start: u32, size: u64) -> Option<Vec<u8>> {
        let (mut bytes, mut number) = (Vec::new(), start);
        for _ in 0..=self.count() + 1 {
            if number >= LAST_SECTOR || bytes.len() as u64 >= size {
                bytes.truncate(usize::try_from(size).unwrap_or(usize::MAX));
                return Some(bytes);
            }
            bytes.extend_from_slice(self.get(number)?);
            number = *self.next.get(number as usize)?;
        }
        None
    }
}

/// The table that says which sector follows which. Its own sectors are listed in the header, and in a chain behind.
fn table(file: &[u8], sectors: &Sectors<'_>) -> Option<Vec<u32>> {
    let mut list = numbers(file.get(76..512)?);
    let mut more = u32_at(file, 68)?;
    let mut steps = 0;
    while more < LAST_SECTOR {
        steps += 1;
        let mut sector = numbers(sectors.get(more)?);
        more = sector.pop()?;
        list.extend(sector);
        if steps > sectors.count() + 1 {
            return None;
        }
    }
    let mut table = Vec::new();
    for number in list.into_iter().filter(|number| *number < LAST_SECTOR).take(sectors.count() + 2) {
        table.extend(numbers(sectors.get(number)?));
    }
    Some(table)
}

fn numbers(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).filter_map(|four| u32_at(four, 0)).collect()
}

/// An entry of the directory that is in use.
fn entry(bytes: &[u8]) -> Option<Entry> {
    let length = usize::from(u16_at(bytes, 64)?).min(64) / 2;
    let letters: Vec<u16> = (0..length.checked_sub(1)?).filter_map(|index| u16_at(bytes, 2 * index)).collect();
    Some(Entry {
        name: String::from_utf16_lossy(&letters),
        start: u32_at(bytes, 116)?,
        // The upper half is not set by all programs where sectors have 512 bytes, and no such stream needs it.
        size: u64::from(u32_at(bytes, 120)?),
    })
}
