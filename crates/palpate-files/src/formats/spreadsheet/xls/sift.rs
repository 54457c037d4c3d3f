//! The records that `calamine` is given of a workbook: those of cells, each bounded by the bytes that are there.
//!
//! `calamine` reserves memory by the dimensions of a sheet and by the letters a text says it has, spells out formulas
//! at a cost that grows with the square of their length, goes through one sheet again for each of its names, and lays
//! a sheet out from its first cell to its last. A process that runs out of memory ends, and nothing can catch that.
//! So dimensions, formulas, drawings and names are left out, formulas become the values they had, and what is left is
//! counted first.

use super::{
    records::{Record, Records, letters, u16_at, u32_at},
    texts,
};
use crate::formats::spreadsheet::book::Sheet;

/// Most cells from the first to the last of every sheet, all sheets together: some 0.5 GB while they are read.
const MOST_CELLS: u64 = 8 << 20;
/// So many of them, some 50 MB, may be empty in any file, and as many more for each that is not.
const MOST_EMPTY: u64 = 800_000;
const EMPTY_A_CELL: u64 = 8;
/// Most records that the texts of the sheets go on in: `calamine` shifts all that are left for each.
const MOST_CONTINUED: usize = 1 << 14;
/// Most letters of shared texts in all cells: each cell has its own copy.
const MOST_LETTERS: u64 = 32 << 20;
/// The number of the last column that a sheet of this format can have, from 0.
const LAST_COLUMN: u16 = 255;

const BEGIN: u16 = 0x0809;
const END: u16 = 0x000A;
const SHEET: u16 = 0x0085;
const TEXTS: u16 = 0x00FC;
/// Goes on with the record before, which was too long for one.
const CONTINUE: u16 = 0x003C;
const NUMBER: u16 = 0x0203;
const LABEL: u16 = 0x0204;
const TRUTH_OR_FAULT: u16 = 0x0205;

/// A stream of the records that are read.
#[derive(Default)]
pub(super) struct Sifted {
    pub(super) stream: Vec<u8>,
    pub(super) sheets: Vec<Sheet>,
    /// How many cells of every sheet hold anything.
    pub(super) held: Vec<usize>,
    pub(super) encrypted: bool,
    /// Letters of every shared text.
    texts: Vec<u32>,
    /// Letters of shared texts in all cells.
    letters: u64,
}

/// Where in a stream it is damaged, and what was expected there.
pub(super) type Wrong = (String, &'static str);

/// Sifts the records of a workbook.
pub(super) fn sift(stream: &[u8]) -> Result<Sifted, Wrong> {
    let mut sifted = Sifted::default();
    let starts = sifted.globals(stream).map_err(|expected| (String::from("workbook"), expected))?;
    let (mut spanned, mut filled, mut gone_over) = (0, 0, 0);
    for (index, (start, written)) in starts.into_iter().enumerate() {
        let place = format!("sheet {}", sifted.sheets[index].name);
        // A stream of 4 GiB is refused before it is read.
        let begins = sifted.stream.len() as u32;
        sifted.stream[written..written + 4].copy_from_slice(&begins.to_le_bytes());
        sifted.put(BEGIN, &[0x00, 0x06, 0x10, 0x00]);
        let mut cells = Cells::default();
        if sifted.sheets[index].other.is_none() {
            let size = cells.take_all(stream, start, &mut sifted);
            gone_over += size.map_err(|(record, expected)| (format!("{place}, record {record}"), expected))?;
            if gone_over > stream.len() {
                return Err((place, "sheets that do not overlap"));
            }
            spanned += cells.span();
            filled += cells.places.len() as u64;
            if spanned > MOST_CELLS {
                return Err((place, "at most 8388608 cells from first to last of all sheets"));
            }
            if spanned > MOST_EMPTY + EMPTY_A_CELL * filled {
                return Err((
                    place,
                    "at most 800000 empty cells, and 8 for each other, from first to last of all sheets",
                ));
            }
            if sifted.letters > MOST_LETTERS {
                return Err((place, "at most 33554432 letters of shared texts in all cells"));
            }
        }
        sifted.held.push(cells.held());
        sifted.put(END, &[]);
    }
    Ok(sifted)
}

fn sheet(bytes: &[u8]) -> Option<Sheet> {
    let other = match bytes.get(5)? {
        0 => None,
        1 => Some("a macro"),
        2 => Some("a chart"),
        _ => Some("no table of numbers"),
    };
    let (length, wide) = (usize::from(*bytes.get(6)?), *bytes.get(7)? & 1 == 1);
    let held = bytes.get(8..)?;
    let length = if wide { 2 * length } else { length };
    let name = letters(&held[..length.min(held.len())], wide);
    Some(Sheet { name, other })
}

impl Sifted {
    /// Takes what stands before the sheets: where every sheet begins, and where this is written. Else what was expected.
    fn globals(&mut self, stream: &[u8]) -> Result<Vec<(usize, usize)>, &'static str> {
        let mut starts = Vec::new();
        let mut records = Records::from(stream, 0).peekable();
        let first = records.next().filter(|record| record.kind == BEGIN && u16_at(record.bytes, 0) == Some(0x0600));
        self.put(BEGIN, first.ok_or("a workbook of Excel 97 or later")?.bytes);
        loop {
            let Record { kind, bytes } = records.next().ok_or("the end of the globals")?;
            match kind {
                END => break,
                0x002F => {
                    self.encrypted = true;
                    return Ok(Vec::new());
                }
                SHEET => {
                    let sheet = sheet(bytes).ok_or("the name of a sheet")?;
                    let start = u32_at(bytes, 0).ok_or("the beginning of a sheet")? as usize;
                    self.put(SHEET, bytes);
                    let written = self.stream.len() - bytes.len();
                    // Of all kinds that hold no cells, one is enough to know.
                    if sheet.other.is_some() {
                        self.stream[written + 5] = 2;
                    }
                    starts.push((start, written));
                    self.sheets.push(sheet);
                }
                TEXTS => {
                    self.put(TEXTS, bytes);
                    let mut pieces = vec![bytes];
                    let mut left = MOST_CONTINUED;
                    while let Some(more) = records.next_if(|record| record.kind == CONTINUE) {
                        left = left.checked_sub(1).ok_or("shared texts in at most 16384 records")?;
                        self.put(CONTINUE, more.bytes);
                        pieces.push(more.bytes);
                    }
                    self.texts = texts::lengths(&pieces);
                }
                // How days are counted; number formats; styles of cells.
                0x0022 | 0x041E | 0x00E0 if bytes.len() >= 2 => self.put(kind, bytes),
                _ => {}
            }
        }
        self.put(END, &[]);
        Ok(starts)
    }

    /// Writes a record, whose bytes come from one.
    fn put(&mut self, kind: u16, bytes: &[u8]) {
        self.stream.extend(kind.to_le_bytes());
        self.stream.extend((bytes.len() as u16).to_le_bytes());
        self.stream.extend(bytes);
    }
}

/// The places of the cells of a sheet.
#[derive(Default)]
struct Cells {
    places: Vec<(u16, u16)>,
    /// The cell of a formula whose text comes in the next record.
    awaiting: Option<[u8; 6]>,
}

impl Cells {
    /// Takes the cells of the sheet that begins at `start`, and says how many bytes it has.
    fn take_all(&mut self, stream: &[u8], start: usize, into: &mut Sifted) -> Result<usize, (usize, &'static str)> {
        // A chart inside of the sheet has records of its own between a beginning and an end.
        let (mut depth, mut done, mut last) = (0_usize, 0, 0);
        for (number, record) in Records::from(stream, start).enumerate() {
            done += 4 + record.bytes.len();
            last = number + 1;
            match record.kind {
                BEGIN => depth += 1,
                _ if depth == 0 => return Err((last, "the beginning of a sheet")),
                END if depth == 1 => return Ok(done),
                END => depth -= 1,
                _ if depth == 1 => self.take(record, into).ok_or((last, "a cell"))?,
                _ => {}
            }
        }
        Err((last + 1, "the end of the sheet"))
    }

    /// Takes the cells of a record, if it holds any; `None` where it breaks off.
    fn take(&mut self, Record { kind, bytes }: Record<'_>, into: &mut Sifted) -> Option<()> {
        match kind {
            NUMBER => self.put(into, NUMBER, bytes.get(..14)?),
            // A number in 32 bits.
            0x027E => self.put(into, kind, bytes.get(..10)?),
            // The same, cells side by side.
            0x00BD => {
                let (row, first, last) = (u16_at(bytes, 0)?, u16_at(bytes, 2)?, u16_at(bytes, bytes.len() - 2)?);
                let count = usize::from(last.checked_sub(first)?) + 1;
                let whole = last <= LAST_COLUMN && bytes.len() == 6 + 6 * count;
                whole.then(|| {
                    self.places.extend((first..=last).map(|column| (row, column)));
                    into.put(kind, bytes);
                })
            }
            // The number of a shared text.
            0x00FD => {
                let text = u32_at(bytes, 6)?;
                into.letters += u64::from(into.texts.get(text as usize).copied().unwrap_or(0));
                self.put(into, kind, bytes.get(..10)?)
            }
            LABEL | 0x00D6 => self.text(into, bytes.get(..6)?, bytes.get(6..)?),
            TRUTH_OR_FAULT => self.put(into, TRUTH_OR_FAULT, bytes.get(..8)?),
            // A formula, with the value it had.
            0x0006 => self.formula(into, bytes),
            // The text of the formula before.
            0x0207 => match self.awaiting.take() {
                Some(cell) => self.text(into, &cell, bytes),
                None => Some(()),
            },
            _ => Some(()),
        }
    }

    fn formula(&mut self, into: &mut Sifted, bytes: &[u8]) -> Option<()> {
        let (cell, value) = (bytes.first_chunk::<6>()?, bytes.get(6..14)?);
        let plain = |last: u8| [&cell[..], &[value[2], last]].concat();
        match (value[0], &value[6..]) {
            (0, [0xFF, 0xFF]) => {
                self.awaiting = Some(*cell);
                Some(())
            }
            (1, [0xFF, 0xFF]) => self.put(into, TRUTH_OR_FAULT, &plain(0)),
            (2, [0xFF, 0xFF]) => self.put(into, TRUTH_OR_FAULT, &plain(1)),
            // An empty text.
            (_, [0xFF, 0xFF]) => Some(()),
            _ => self.put(into, NUMBER, bytes.get(..14)?),
        }
    }

    /// A text of as many letters as are there; one that goes on in another record ends with its own.
    fn text(&mut self, into: &mut Sifted, cell: &[u8], text: &[u8]) -> Option<()> {
        let (stated, wide) = (u16_at(text, 0)?, *text.get(2)? & 1 == 1);
        let held = text.len() - 3;
        let length = usize::from(stated).min(if wide { held / 2 } else { held });
        let bytes = if wide { 2 * length } else { length };
        let length = (length as u16).to_le_bytes();
        self.put(into, LABEL, &[cell, &length, &text[2..3 + bytes]].concat())
    }

    /// A cell whose row and column the record begins with.
    fn put(&mut self, into: &mut Sifted, kind: u16, bytes: &[u8]) -> Option<()> {
        let (row, column) = (u16_at(bytes, 0)?, u16_at(bytes, 2)?);
        (column <= LAST_COLUMN).then(|| {
            self.places.push((row, column));
            into.put(kind, bytes);
        })
    }

    /// How many cells there are from the first to the last row and column.
    fn span(&self) -> u64 {
        let of = |place: &dyn Fn(&(u16, u16)) -> u16| {
            let numbers = self.places.iter().map(place);
            let ends = numbers.fold((u16::MAX, 0), |(low, high), number| (low.min(number), high.max(number)));
            u64::from(ends.1.saturating_sub(ends.0)) + 1
        };
        if self.places.is_empty() { 0 } else { of(&|place| place.0) * of(&|place| place.1) }
    }

    fn held(mut self) -> usize {
        self.places.sort_unstable();
        self.places.dedup();
        self.places.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_shared_text_in_many_cells_is_refused() {
        let of = |cells: u16| {
            let mut written = Sifted::default();
            written.put(BEGIN, &[0, 6]);
            written.put(SHEET, &[0, 0, 0, 0, 0, 0, 1, 0, b'a']);
            let begins = written.stream.len() - 9;
            written.put(TEXTS, &[&[0; 8][..], &60_000_u16.to_le_bytes(), &[0], &[b'x'; 60_000]].concat());
            written.put(END, &[]);
            let start = (written.stream.len() as u32).to_le_bytes();
            written.stream[begins..begins + 4].copy_from_slice(&start);
            written.put(BEGIN, &[0, 6, 0x10, 0]);
            (0..cells).for_each(|row| written.put(0x00FD, &[&row.to_le_bytes()[..], &[0; 8]].concat()));
            written.put(END, &[]);
            sift(&written.stream).map(drop)
        };
        assert_eq!(of(500), Ok(()));
        let expected = "at most 33554432 letters of shared texts in all cells";
        assert_eq!(of(600), Err(("sheet a".to_owned(), expected)));
    }

    #[test]
    fn shared_texts_in_many_pieces_are_refused() {
        let of = |pieces: usize| {
            let mut written = Sifted::default();
            written.put(BEGIN, &[0, 6]);
            written.put(TEXTS, &[0; 8]);
            (0..pieces).for_each(|_| written.put(CONTINUE, &[]));
            written.put(END, &[]);
            sift(&written.stream).map(drop)
        };
        assert_eq!(of(MOST_CONTINUED), Ok(()));
        assert_eq!(of(MOST_CONTINUED + 1), Err(("workbook".to_owned(), "shared texts in at most 16384 records")));
    }
}
