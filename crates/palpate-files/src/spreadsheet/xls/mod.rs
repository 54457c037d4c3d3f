//! Workbooks of Excel 97 to 2003 (`.xls`, BIFF8): records in one stream of a compound file.
//!
//! | file | what |
//! |---|---|
//! | `compound.rs` | streams of a compound file |
//! | `records.rs` | records of a stream, and numbers and texts in them |
//! | `globals.rs` | sheets, texts and number formats, which stand before the sheets |
//! | `cells.rs` | the cells of one sheet |

mod cells;
mod compound;
mod globals;
mod records;

use std::{fmt, ops::ControlFlow};

use super::book::{Book, DAYS_FROM_1900, DAYS_FROM_1904, Sheet, Visitor};
use crate::{error::FileError, input::Input};
use compound::Compound;
pub(super) use compound::SIGNATURE;
use globals::Globals;

/// A workbook whose stream is in memory and whose globals have been read.
pub(super) struct Xls {
    input: Input,
    stream: Vec<u8>,
    globals: Globals,
}

impl Xls {
    pub(super) fn open(input: &Input) -> Result<Self, FileError> {
        let damaged = |place: &str, expected: &str, found: &str| FileError::Damaged {
            path: input.name().to_owned(),
            place: place.to_owned(),
            expected: expected.to_owned(),
            found: found.to_owned(),
        };
        let bytes = input.bytes()?;
        let compound = Compound::of(&bytes)
            .ok_or_else(|| damaged("compound file", "a chain of sectors", "one that breaks off"))?;
        if compound.has("EncryptedPackage") {
            return Err(encrypted(input));
        }
        let Some(stream) = compound.stream("Workbook") else {
            let found = if compound.has("Book") { "one of Excel 95 or older" } else { "none" };
            return Err(damaged("compound file", "a workbook of Excel 97 or later", found));
        };
        let globals = match globals::read(&stream) {
            Ok(globals) if globals.encrypted => return Err(encrypted(input)),
            Ok(globals) => globals,
            Err(wrong) => return Err(damaged("workbook", wrong, "other bytes, or their end")),
        };
        Ok(Self {
            input: input.clone(),
            stream,
            globals,
        })
    }
}

fn encrypted(input: &Input) -> FileError {
    FileError::Encrypted {
        path: input.name().to_owned(),
    }
}

impl Book for Xls {
    fn sheets(&self) -> &[Sheet] {
        &self.globals.sheets
    }

    fn days_to_epoch(&self) -> f64 {
        if self.globals.from_1904 { DAYS_FROM_1904 } else { DAYS_FROM_1900 }
    }

    fn visit(&self, sheet: usize, each: &mut Visitor<'_>) -> Result<(), FileError> {
        let (Some(&start), Some(Sheet { name, .. })) = (self.globals.starts.get(sheet), self.globals.sheets.get(sheet))
        else {
            return Ok(());
        };
        let cells =
            cells::read(&self.stream, start, &self.globals).map_err(|(record, expected)| FileError::Damaged {
                path: self.input.name().to_owned(),
                place: format!("sheet {name}, record {record}"),
                expected: expected.to_owned(),
                found: "other bytes, or their end".to_owned(),
            })?;
        let total = cells.len() as u64;
        for (done, cell) in cells.into_iter().enumerate() {
            if each(cell, done as u64 + 1, total)? == ControlFlow::Break(()) {
                break;
            }
        }
        Ok(())
    }
}

impl fmt::Debug for Xls {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Xls").field("sheets", &self.globals.sheets).finish_non_exhaustive()
    }
}
