//! The cells of one sheet.

use super::{
    super::cell::{Cell, MOST_COLUMNS, NumberFormat, Value},
    globals::Globals,
    records::{Record, Records, f64_at, text_at, u16_at, u32_at},
};

/// Most cells of a sheet of this format.
const MOST_CELLS: usize = 65_536 * 256;

/// The cells of the sheet whose records begin at `start`, row by row; else the number of the record that is wrong, and
/// what was expected of it.
pub(super) fn read(stream: &[u8], start: usize, globals: &Globals) -> Result<Vec<Cell>, (usize, &'static str)> {
    let mut reading = Reading {
        globals,
        cells: Vec::new(),
        awaiting: None,
    };
    // A chart inside of the sheet has records of its own between a beginning and an end.
    let mut depth = 0_usize;
    for (number, record) in Records::from(stream, start).enumerate() {
        match record.kind {
            0x0809 => depth += 1,
            _ if depth == 0 => return Err((number + 1, "the beginning of a sheet")),
            0x000A if depth == 1 => return Ok(reading.sorted()),
            0x000A => depth -= 1,
            _ if depth == 1 => reading.take(record).ok_or((number + 1, "a cell"))?,
            _ => {}
        }
        if reading.cells.len() > MOST_CELLS {
            return Err((number + 1, "at most 65536 rows of 256 cells"));
        }
    }
    Err((Records::from(stream, start).count() + 1, "the end of the sheet"))
}

struct Reading<'a> {
    globals: &'a Globals,
    cells: Vec<Cell>,
    /// Row and column of a formula whose text comes in the next record.
    awaiting: Option<(u16, u16)>,
}

impl Reading<'_> {
    /// Takes the cells of a record, if it holds any; `None` where it breaks off.
    fn take(&mut self, Record { kind, bytes }: Record<'_>) -> Option<()> {
        match kind {
            // NUMBER
            0x0203 => self.number(bytes, f64_at(bytes, 6)?),
            // RK
            0x027E => self.number(bytes, compact(u32_at(bytes, 6)?)),
            // MULRK: cells side by side
            0x00BD => {
                let (row, first) = (u16_at(bytes, 0)?, u16_at(bytes, 2)?);
                let held = bytes.get(4..bytes.len().checked_sub(2)?)?;
                for (index, six) in held.chunks_exact(6).enumerate() {
                    let value = Value::formatted(compact(u32_at(six, 2)?), self.style(u16_at(six, 0)?));
                    self.push(row, first.checked_add(u16::try_from(index).ok()?)?, value)?;
                }
                Some(())
            }
            // LABELSST
            0x00FD => {
                let text = self.globals.strings.get(u32_at(bytes, 6)? as usize)?.to_owned();
                self.at(bytes, Value::Text(text))
            }
            // LABEL, RSTRING
            0x0204 | 0x00D6 => {
                let text = text_at(bytes, 8, usize::from(u16_at(bytes, 6)?))?;
                self.at(bytes, Value::Text(text))
            }
            // BOOLERR
            0x0205 => {
                let code = *bytes.get(6)?;
                let value = if *bytes.get(7)? == 0 { Value::Truth(code != 0) } else { Value::Fault(fault(code)) };
                self.at(bytes, value)
            }
            // FORMULA, with the value it had
            0x0006 => self.formula(bytes),
            // STRING, the text of the formula before
            0x0207 => {
                let text = text_at(bytes, 2, usize::from(u16_at(bytes, 0)?))?;
                match self.awaiting.take() {
                    Some((row, column)) => self.push(row, column, Value::Text(text)),
                    None => Some(()),
                }
            }
            _ => Some(()),
        }
    }

    fn formula(&mut self, bytes: &[u8]) -> Option<()> {
        if u16_at(bytes, 12)? != 0xFFFF {
            return self.number(bytes, f64_at(bytes, 6)?);
        }
        let value = *bytes.get(8)?;
        match *bytes.get(6)? {
            0 => self.awaiting = Some((u16_at(bytes, 0)?, u16_at(bytes, 2)?)),
            1 => return self.at(bytes, Value::Truth(value != 0)),
            2 => return self.at(bytes, Value::Fault(fault(value))),
            _ => {}
        }
        Some(())
    }

    fn style(&self, number: u16) -> NumberFormat {
        self.globals.styles.get(usize::from(number)).copied().unwrap_or_default()
    }

    fn number(&mut self, bytes: &[u8], number: f64) -> Option<()> {
        let value = if number.is_finite() {
            Value::formatted(number, self.style(u16_at(bytes, 4)?))
        } else {
            Value::Fault(number.to_string())
        };
        self.at(bytes, value)
    }

    /// A value in the cell whose row and column the record begins with.
    fn at(&mut self, bytes: &[u8], value: Value) -> Option<()> {
        self.push(u16_at(bytes, 0)?, u16_at(bytes, 2)?, value)
    }

    fn push(&mut self, row: u16, column: u16, value: Value) -> Option<()> {
        let blank = matches!(&value, Value::Text(text) if text.trim().is_empty());
        let (row, column) = (u32::from(row), u32::from(column));
        if column >= MOST_COLUMNS {
            return None;
        }
        if !blank {
            self.cells.push(Cell { row, column, value });
        }
        Some(())
    }

    /// Some programs write the cells in the order they were filled in.
    fn sorted(mut self) -> Vec<Cell> {
        self.cells.sort_by_key(|cell| (cell.row, cell.column));
        // Of a cell that was written twice, the last counts.
        self.cells.reverse();
        self.cells.dedup_by_key(|cell| (cell.row, cell.column));
        self.cells.reverse();
        self.cells
    }
}

/// A number in 32 bits: a whole one, or the upper part of an `f64`; perhaps a hundredth of it.
fn compact(bits: u32) -> f64 {
    let number = if bits & 2 == 0 {
        f64::from_bits(u64::from(bits & !3) << 32)
    } else {
        f64::from(bits.cast_signed() >> 2)
    };
    if bits & 1 == 0 { number } else { number / 100.0 }
}

/// The name of an error by its code.
fn fault(code: u8) -> String {
    let name = match code {
        0x00 => "#NULL!",
        0x07 => "#DIV/0!",
        0x0F => "#VALUE!",
        0x17 => "#REF!",
        0x1D => "#NAME?",
        0x24 => "#NUM!",
        0x2A => "#N/A",
        _ => "an error",
    };
    name.to_owned()
}
