//! Streams of a compound file: sectors that are chained by a table ([MS-CFB]).

use super::records::{u16_at, u32_at};

/// First bytes of a compound file.
pub(crate) const SIGNATURE: &[u8] = b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1";

/// Sector numbers from here on have a meaning of their own; the end of a chain is one.
const LAST_SECTOR: u32 = 0xFFFF_FFFA;
/// Size of the sectors of small streams.
const SMALL: usize = 64;

/// A compound file with its tables read.
pub(super) struct Compound<'a> {
    bytes: &'a [u8],
    sector: usize,
    next: Vec<u32>,
    next_small: Vec<u32>,
    small: Vec<u8>,
    smallest_large: u64,
    entries: Vec<Entry>,
}

struct Entry {
    name: String,
    start: u32,
    size: u64,
}

impl<'a> Compound<'a> {
    /// `None` where its tables break off or run in a ring.
    pub(super) fn of(bytes: &'a [u8]) -> Option<Self> {
        let sector = match u16_at(bytes, 30)? {
            9 => 512,
            12 => 4096,
            _ => return None,
        };
        let mut compound = Self {
            bytes,
            sector,
            next: Vec::new(),
            next_small: Vec::new(),
            small: Vec::new(),
            smallest_large: u64::from(u32_at(bytes, 56)?),
            entries: Vec::new(),
        };
        compound.next = compound.table()?;
        let directory = compound.chain(u32_at(bytes, 48)?, u64::MAX)?;
        compound.entries = directory.chunks_exact(128).filter_map(entry).collect();
        let root = compound.entries.first()?;
        let (start, size) = (root.start, root.size);
        if u32_at(bytes, 64)? > 0 {
            let table = compound.chain(u32_at(bytes, 60)?, u64::MAX)?;
            compound.next_small = numbers(&table);
            compound.small = compound.chain(start, size)?;
        }
        Some(compound)
    }

    fn sectors(&self) -> usize {
        self.bytes.len() / self.sector
    }

    fn sector(&self, number: u32) -> Option<&'a [u8]> {
        let start = (number as usize).checked_add(1)?.checked_mul(self.sector)?;
        // The last sector of a file may be short.
        let end = start.checked_add(self.sector)?.min(self.bytes.len());
        self.bytes.get(start..end).filter(|sector| !sector.is_empty())
    }

    /// The table that says which sector follows which. Its own sectors are listed in the header, and in a chain behind.
    fn table(&self) -> Option<Vec<u32>> {
        let mut list = numbers(self.bytes.get(76..512)?);
        let mut more = u32_at(self.bytes, 68)?;
        let mut steps = 0;
        while more < LAST_SECTOR {
            steps += 1;
            let mut sector = numbers(self.sector(more)?);
            more = sector.pop()?;
            list.extend(sector);
            if steps > self.sectors() {
                return None;
            }
        }
        let mut table = Vec::new();
        for number in list.into_iter().filter(|number| *number < LAST_SECTOR).take(self.sectors() + 1) {
            table.extend(numbers(self.sector(number)?));
        }
        Some(table)
    }

    /// The bytes of a chain of sectors, at most `size` of them.
    fn chain(&self, start: u32, size: u64) -> Option<Vec<u8>> {
        chain(&self.next, start, size, self.sectors(), |number| self.sector(number))
    }

    fn small_chain(&self, start: u32, size: u64) -> Option<Vec<u8>> {
        chain(&self.next_small, start, size, self.small.len() / SMALL, |number| {
            let from = (number as usize).checked_mul(SMALL)?;
            self.small.get(from..from + SMALL)
        })
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.entries.iter().any(|entry| entry.name.eq_ignore_ascii_case(name))
    }

    /// The bytes of a stream; `None` where there is none of this name or it breaks off.
    pub(super) fn stream(&self, name: &str) -> Option<Vec<u8>> {
        let entry = self.entries.iter().find(|entry| entry.name.eq_ignore_ascii_case(name))?;
        if entry.size < self.smallest_large {
            self.small_chain(entry.start, entry.size)
        } else {
            self.chain(entry.start, entry.size)
        }
    }
}

/// The bytes of a chain, which has no more than `most` sectors unless it runs in a ring.
fn chain<'s>(
    next: &[u32],
    start: u32,
    size: u64,
    most: usize,
    sector: impl Fn(u32) -> Option<&'s [u8]>,
) -> Option<Vec<u8>> {
    let (mut bytes, mut number) = (Vec::new(), start);
    for _ in 0..=most {
        if number >= LAST_SECTOR || bytes.len() as u64 >= size {
            bytes.truncate(usize::try_from(size).unwrap_or(usize::MAX));
            return Some(bytes);
        }
        bytes.extend_from_slice(sector(number)?);
        number = *next.get(number as usize)?;
    }
    None
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
