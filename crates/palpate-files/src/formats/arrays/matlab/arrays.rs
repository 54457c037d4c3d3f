//! The arrays in an element, those in structures and cells included.

use super::elements::{Bytes, Feed, MATRIX, word};
use crate::{
    error::FileError,
    formats::arrays::tables::{MOST_COLUMNS, Place},
    input::{Input, Number},
};

/// Deepest structure in a structure.
const DEEPEST: usize = 16;

/// Most fields of a structure, and most bytes of the name of one.
const MOST_FIELDS: usize = 4096;
const LONGEST_NAME: usize = 64;

/// Most bytes of a text that are taken.
const MOST_TEXT: u64 = 4096;

/// Hears of the arrays of a file, in order.
pub(super) trait Visit {
    /// An array of real numbers, of so many rows and columns; a vector is one column.
    fn array(&mut self, place: Place, shape: (usize, usize), numbers: &mut Numbers<'_, '_>) -> Result<(), FileError>;

    /// A line of text.
    fn text(&mut self, _: Place, _: String) -> Result<(), FileError> {
        Ok(())
    }

    /// Something that holds no table.
    fn other(&mut self, _: Place, _: &'static str) -> Result<(), FileError> {
        Ok(())
    }
}

/// Goes through the arrays in the bytes of an element.
pub(super) fn walk<'f>(
    input: &'f Input,
    bytes: Bytes<'f>,
    lowest_first: bool,
    visit: &mut dyn Visit,
) -> Result<(), FileError> {
    let mut walker = Walker {
        input,
        feed: Feed::of(input, bytes),
        lowest_first,
        visit,
    };
    let size = match walker.feed.plain_size() {
        Some(size) => size,
        None => {
            let tag = walker.tag(&mut { u64::MAX })?;
            if tag.kind != MATRIX {
                return Ok(());
            }
            tag.size
        }
    };
    walker.matrix(size, None, 0)
}

struct Walker<'w, 'f> {
    input: &'f Input,
    feed: Feed<'f>,
    lowest_first: bool,
    visit: &'w mut dyn Visit,
}

/// What stands before the bytes of an element.
struct Tag {
    kind: u32,
    size: u64,
    /// The bytes themselves, where they are few.
    small: Option<[u8; 4]>,
}

/// The numbers of an array, to be taken once.
pub(super) struct Numbers<'n, 'f> {
    feed: &'n mut Feed<'f>,
    number: Number,
    lowest_first: bool,
    /// Those that stand in the tag.
    small: Option<[u8; 4]>,
    /// How many there are.
    count: usize,
    /// How many were taken.
    taken: usize,
}

impl Numbers<'_, '_> {
    fn next(&mut self, block: &mut [u8]) -> Result<(), FileError> {
        let start = self.taken * self.number.size();
        self.taken += block.len() / self.number.size();
        match &self.small {
            Some(four) => block.copy_from_slice(&four[start..start + block.len()]),
            None => self.feed.take(block)?,
        }
        Ok(())
    }

    /// The first row of columns that have so many rows; of many columns, what begins it.
    pub(super) fn first_row(&mut self, rows: usize) -> Result<Vec<f64>, FileError> {
        let columns = self.count.checked_div(rows).unwrap_or(0).min(MOST_COLUMNS);
        let mut found = Vec::new();
        for column in 0..columns {
            let mut cell = [0; 8];
            let cell = &mut cell[..self.number.size()];
            self.next(cell)?;
            found.push(self.number.read(cell, self.lowest_first));
            if column + 1 < columns {
                self.taken += rows - 1;
                let between = if self.small.is_none() { (rows - 1) * self.number.size() } else { 0 };
                self.feed.skip(between as u64)?;
            }
        }
        Ok(found)
    }

    /// Some of their columns, which have so many rows.
    pub(super) fn columns(&mut self, rows: usize, wanted: &[usize]) -> Result<Vec<Vec<f64>>, FileError> {
        const AT_ONCE: usize = 1 << 11;
        let mut found = vec![Vec::new(); wanted.len()];
        let mut block = [0; 8 * AT_ONCE];
        for column in 0..self.count / rows {
            let mut left = rows;
            while left > 0 {
                let some = left.min(AT_ONCE);
                let block = &mut block[..some * self.number.size()];
                self.next(block)?;
                for (into, _) in found.iter_mut().zip(wanted).filter(|(_, wanted)| **wanted == column) {
                    into.extend(
                        block.chunks_exact(self.number.size()).map(|cell| self.number.read(cell, self.lowest_first)),
                    );
                }
                left -= some;
            }
        }
        Ok(found)
    }
}

/// The kind of numbers of an element.
fn number(kind: u32) -> Option<Number> {
    Some(match kind {
        1 => Number::I8,
        2 => Number::U8,
        3 => Number::I16,
        4 => Number::U16,
        5 => Number::I32,
        6 => Number::U32,
        7 => Number::F32,
        9 => Number::F64,
        12 => Number::I64,
        13 => Number::U64,
        _ => return None,
    })
}

impl Walker<'_, '_> {
    fn damaged(&self, expected: impl Into<String>, found: impl Into<String>) -> FileError {
        self.input.damaged("an array", expected, found)
    }

    /// The next tag of an array that has so many bytes left.
    fn tag(&mut self, left: &mut u64) -> Result<Tag, FileError> {
        let mut bytes = [0; 8];
        self.spend(left, 8)?;
        self.feed.take(&mut bytes)?;
        let first = word(&bytes[..4], self.lowest_first);
        let (kind, size) = (first & 0xFFFF, first >> 16);
        if size == 0 {
            let size = u64::from(word(&bytes[4..], self.lowest_first));
            return Ok(Tag {
                kind: first,
                size,
                small: None,
            });
        }
        if size > 4 {
            return Err(self.damaged("at most 4 bytes in a tag", size.to_string()));
        }
        let small = Some([bytes[4], bytes[5], bytes[6], bytes[7]]);
        let size = u64::from(size);
        Ok(Tag { kind, size, small })
    }

    fn spend(&self, left: &mut u64, bytes: u64) -> Result<(), FileError> {
        *left = left
            .checked_sub(bytes)
            .ok_or_else(|| self.damaged(format!("{bytes} bytes more"), format!("{left} bytes")))?;
        Ok(())
    }

    /// Bytes behind those of an element, up to the next multiple of eight.
    fn padding(tag: &Tag) -> u64 {
        if tag.small.is_some() { 0 } else { tag.size.wrapping_neg() % 8 }
    }

    /// The bytes of an element, no more than `most` of them; the rest is passed over.
    fn content(&mut self, tag: &Tag, most: u64, left: &mut u64) -> Result<Vec<u8>, FileError> {
        if let Some(small) = tag.small {
            return Ok(small[..tag.size as usize].to_vec());
        }
        self.spend(left, tag.size)?;
        let mut bytes = vec![0; tag.size.min(most) as usize];
        self.feed.take(&mut bytes)?;
        self.feed.skip(tag.size - bytes.len() as u64)?;
        self.pad(tag, left)?;
        Ok(bytes)
    }

    fn pad(&mut self, tag: &Tag, left: &mut u64) -> Result<(), FileError> {
        // The last element of an array may end without.
        let padding = Self::padding(tag).min(*left);
        self.spend(left, padding)?;
        self.feed.skip(padding)
    }

    /// An array of `size` bytes; one in a structure has its place there.
    fn matrix(&mut self, size: u64, inside: Option<Place>, depth: usize) -> Result<(), FileError> {
        if size == 0 {
            return Ok(());
        }
        let mut left = size;
        let flags = self.words(&mut left, 2)?;
        let dimensions = self.words(&mut left, 32)?;
        let tag = self.tag(&mut left)?;
        let name = self.content(&tag, LONGEST_NAME as u64, &mut left)?;
        let place = inside.unwrap_or_else(|| Place {
            parent: String::new(),
            name: String::from_utf8_lossy(&name).into_owned(),
            mark: '.',
        });
        let &[flags, ..] = &flags[..] else {
            return Err(self.damaged("flags of 8 bytes", "fewer"));
        };
        let count = dimensions.iter().try_fold(1_usize, |product, size| product.checked_mul(*size as usize));
        let (Some(count), 2..) = (count, dimensions.len()) else {
            return Err(self.damaged("two dimensions or more", format!("{dimensions:?}")));
        };
        match flags & 0xFF {
            1 => self.cell(count, &place, &mut left, depth)?,
            2 => self.structure(count, &place, &mut left, depth)?,
            4 => self.text(&dimensions, place, &mut left)?,
            6..=15 if flags & 0x800 != 0 => self.visit.other(place, "complex numbers")?,
            6..=15 if dimensions.len() > 2 => self.visit.other(place, "more than two dimensions")?,
            6..=15 => {
                let shape = match (dimensions[0] as usize, dimensions[1] as usize) {
                    (1, columns) => (columns, 1),
                    shape => shape,
                };
                self.numbers(shape, count, place, &mut left)?;
            }
            5 => self.visit.other(place, "a sparse matrix")?,
            _ => self.visit.other(place, "an object of a program")?,
        }
        self.feed.skip(left)
    }

    /// Words of four bytes, up to `most` of them.
    fn words(&mut self, left: &mut u64, most: usize) -> Result<Vec<u32>, FileError> {
        let tag = self.tag(left)?;
        if tag.size > 4 * most as u64 {
            return Err(self.damaged(format!("at most {} bytes", 4 * most), tag.size.to_string()));
        }
        let bytes = self.content(&tag, tag.size, left)?;
        Ok(bytes.chunks_exact(4).map(|four| word(four, self.lowest_first)).collect())
    }

    fn numbers(&mut self, shape: (usize, usize), count: usize, place: Place, left: &mut u64) -> Result<(), FileError> {
        let tag = self.tag(left)?;
        let number =
            number(tag.kind).ok_or_else(|| self.damaged("numbers", format!("an element of kind {}", tag.kind)))?;
        let expected = (count as u64).checked_mul(number.size() as u64);
        if expected != Some(tag.size) {
            let expected = format!("{count} numbers of {} bytes", number.size());
            return Err(self.damaged(expected, format!("{} bytes", tag.size)));
        }
        if tag.small.is_none() {
            self.spend(left, tag.size)?;
        }
        let mut numbers = Numbers {
            feed: &mut self.feed,
            number,
            lowest_first: self.lowest_first,
            small: tag.small,
            count,
            taken: 0,
        };
        self.visit.array(place, shape, &mut numbers)?;
        let taken = (numbers.taken * number.size()) as u64;
        if tag.small.is_none() {
            self.feed.skip(tag.size - taken)?;
        }
        self.pad(&tag, left)
    }

    /// A line of text; several lines are no named value.
    fn text(&mut self, dimensions: &[u32], place: Place, left: &mut u64) -> Result<(), FileError> {
        let tag = self.tag(left)?;
        let bytes = self.content(&tag, MOST_TEXT, left)?;
        let wide = || {
            let units = bytes.chunks_exact(2).map(|pair| match self.lowest_first {
                true => u16::from_le_bytes([pair[0], pair[1]]),
                false => u16::from_be_bytes([pair[0], pair[1]]),
            });
            String::from_utf16_lossy(&units.collect::<Vec<_>>())
        };
        let text = match tag.kind {
            4 | 17 => wide(),
            _ => String::from_utf8_lossy(&bytes).into_owned(),
        };
        match dimensions {
            [1, _] if !text.trim().is_empty() => self.visit.text(place, text),
            _ => Ok(()),
        }
    }

    /// An array inside of another.
    fn inside(&mut self, place: Place, left: &mut u64, depth: usize) -> Result<(), FileError> {
        let tag = self.tag(left)?;
        if tag.kind != MATRIX || tag.small.is_some() {
            return Err(self.damaged("an array in a structure", format!("an element of kind {}", tag.kind)));
        }
        self.spend(left, tag.size)?;
        if depth == DEEPEST {
            self.visit.other(place, "too deep in structures")?;
            return self.feed.skip(tag.size);
        }
        self.matrix(tag.size, Some(place), depth + 1)
    }

    fn cell(&mut self, count: usize, place: &Place, left: &mut u64, depth: usize) -> Result<(), FileError> {
        for index in 1..=count {
            let inside = Place {
                parent: place.full(),
                name: format!("{}{{{index}}}", place.name),
                mark: '.',
            };
            self.inside(inside, left, depth)?;
        }
        Ok(())
    }

    fn structure(&mut self, count: usize, place: &Place, left: &mut u64, depth: usize) -> Result<(), FileError> {
        let length = match self.words(left, 1)?[..] {
            [length] if (1..=LONGEST_NAME).contains(&(length as usize)) => length as usize,
            ref other => return Err(self.damaged("the length of names of fields", format!("{other:?}"))),
        };
        let tag = self.tag(left)?;
        if tag.size > (MOST_FIELDS * LONGEST_NAME) as u64 {
            return Err(self.damaged(format!("at most {MOST_FIELDS} fields"), "more"));
        }
        let names = self.content(&tag, tag.size, left)?;
        let name = |bytes: &[u8]| {
            let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
            String::from_utf8_lossy(&bytes[..end]).into_owned()
        };
        let names: Vec<String> = names.chunks_exact(length).map(name).collect();
        let full = place.full();
        // Without fields there is nothing to be read of however many elements.
        for index in 1..=if names.is_empty() { 0 } else { count } {
            let parent = if count > 1 { format!("{full}({index})") } else { full.clone() };
            for name in &names {
                let inside = Place {
                    parent: parent.clone(),
                    name: name.clone(),
                    mark: '.',
                };
                self.inside(inside, left, depth)?;
            }
        }
        Ok(())
    }
}
