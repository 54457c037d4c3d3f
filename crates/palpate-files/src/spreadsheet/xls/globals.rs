//! Sheets, texts and number formats, which stand before the sheets.

use std::collections::BTreeMap;

use super::{
    super::{
        book::{MOST_SHEETS, Sheet},
        cell::NumberFormat,
        strings::Strings,
    },
    records::{Records, letters, text_at, u16_at, u32_at},
};

/// What stands before the sheets.
#[derive(Debug, Default)]
pub(super) struct Globals {
    pub(super) sheets: Vec<Sheet>,
    /// Where the records of every sheet begin.
    pub(super) starts: Vec<usize>,
    pub(super) strings: Strings,
    /// The number format of every style of cells.
    pub(super) styles: Vec<NumberFormat>,
    pub(super) from_1904: bool,
    pub(super) encrypted: bool,
}

/// Reads the globals, or says what was expected in vain.
pub(super) fn read(stream: &[u8]) -> Result<Globals, &'static str> {
    let mut globals = Globals::default();
    let mut own: BTreeMap<u16, NumberFormat> = BTreeMap::new();
    let mut formats: Vec<u16> = Vec::new();
    let mut records = Records::from(stream, 0);
    let first = records.next().filter(|record| record.kind == 0x0809 && u16_at(record.bytes, 0) == Some(0x0600));
    first.ok_or("a workbook of Excel 97 or later")?;
    loop {
        let record = records.next().ok_or("the end of the globals")?;
        let bytes = record.bytes;
        match record.kind {
            0x000A => break,
            0x002F => {
                globals.encrypted = true;
                return Ok(globals);
            }
            0x0022 => globals.from_1904 = u16_at(bytes, 0) == Some(1),
            0x0085 => {
                let (sheet, start) = sheet(bytes).ok_or("the name of a sheet")?;
                globals.sheets.push(sheet);
                globals.starts.push(start);
                if globals.sheets.len() > MOST_SHEETS {
                    return Err("at most 4096 sheets");
                }
            }
            0x041E => {
                let number = u16_at(bytes, 0).ok_or("a number format")?;
                let length = usize::from(u16_at(bytes, 2).ok_or("a number format")?);
                let code = text_at(bytes, 4, length).ok_or("a number format")?;
                own.insert(number, NumberFormat::of_code(&code));
            }
            0x00E0 => formats.push(u16_at(bytes, 2).ok_or("a style of cells")?),
            0x00FC => {
                let mut pieces = vec![bytes];
                pieces.extend(records.continued());
                globals.strings = strings(&pieces).ok_or("shared texts")?;
            }
            _ => {}
        }
    }
    let style = |number: &u16| own.get(number).copied().unwrap_or_else(|| NumberFormat::built_in(u32::from(*number)));
    globals.styles = formats.iter().map(style).collect();
    Ok(globals)
}

fn sheet(bytes: &[u8]) -> Option<(Sheet, usize)> {
    let other = match bytes.get(5)? {
        0 => None,
        1 => Some("a macro"),
        2 => Some("a chart"),
        _ => Some("no table of numbers"),
    };
    let name = text_at(bytes, 7, usize::from(*bytes.get(6)?))?;
    Some((Sheet { name, other }, u32_at(bytes, 0)? as usize))
}

/// Texts that go on from record to record.
struct Pieces<'a> {
    pieces: &'a [&'a [u8]],
    piece: usize,
    place: usize,
}

impl Pieces<'_> {
    /// Moves on to the next piece where this one is used up.
    fn rest(&mut self) -> Option<&[u8]> {
        while self.place >= self.pieces.get(self.piece)?.len() {
            self.piece += 1;
            self.place = 0;
        }
        self.pieces.get(self.piece)?.get(self.place..)
    }

    fn byte(&mut self) -> Option<u8> {
        let byte = *self.rest()?.first()?;
        self.place += 1;
        Some(byte)
    }

    fn u16(&mut self) -> Option<u16> {
        Some(u16::from_le_bytes([self.byte()?, self.byte()?]))
    }

    fn u32(&mut self) -> Option<u32> {
        Some(u32::from(self.u16()?) | u32::from(self.u16()?) << 16)
    }

    fn skip(&mut self, mut count: usize) -> Option<()> {
        while count > 0 {
            let step = count.min(self.rest()?.len());
            self.place += step;
            count -= step;
        }
        Some(())
    }

    /// Letters, whose width is said anew where they go on in the next piece.
    fn letters(&mut self, mut count: usize, mut wide: bool, into: &mut Strings) -> Option<()> {
        while count > 0 {
            if self.place >= self.pieces.get(self.piece)?.len() {
                wide = self.byte()? & 1 == 1;
            }
            let width = if wide { 2 } else { 1 };
            let held = self.pieces.get(self.piece)?.get(self.place..)?;
            let here = count.min(held.len() / width);
            if here == 0 {
                return None;
            }
            into.extend(&letters(&held[..here * width], wide));
            self.place += here * width;
            count -= here;
        }
        Some(())
    }
}

fn strings(pieces: &[&[u8]]) -> Option<Strings> {
    let mut strings = Strings::default();
    let mut from = Pieces {
        pieces,
        piece: 0,
        place: 4,
    };
    let count = from.u32()?;
    for _ in 0..count {
        let length = usize::from(from.u16()?);
        let flags = from.byte()?;
        let runs = if flags & 8 != 0 { usize::from(from.u16()?) } else { 0 };
        let spoken = if flags & 4 != 0 { from.u32()? as usize } else { 0 };
        from.letters(length, flags & 1 == 1, &mut strings)?;
        strings.end();
        from.skip(4 * runs + spoken)?;
    }
    Some(strings)
}
