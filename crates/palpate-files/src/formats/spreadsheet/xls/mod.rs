//! Workbooks of Excel 97 to 2003 (`.xls`, BIFF8): records in one stream of a compound file, read by `calamine`.
//!
//! | file | what |
//! |---|---|
//! | `compound.rs` | streams of a compound file |
//! | `records.rs` | records of a stream |
//! | `texts.rs` | how long the texts are that the sheets share |
//! | `sift.rs` | the records that `calamine` is given, bounded by the bytes that are there |
//! | `container.rs` | a compound file around them |

mod compound;
mod container;
mod records;
mod sift;
mod texts;

use std::{collections::BTreeSet, io::Cursor, ops::ControlFlow};

use calamine::{Data, Range, Reader};

use crate::{
    error::{FileError, FileProblem},
    formats::spreadsheet::{
        book::{Book, DAYS_FROM_1900, DAYS_FROM_1904, Sheet, Visitor},
        cell::{Cell, Value},
    },
    input::{Input, contained},
};
use compound::Compound;
pub(super) use compound::SIGNATURE;
use sift::Sifted;

/// A workbook whose cells are in memory.
pub(super) struct Xls {
    sheets: Vec<Sheet>,
    /// The cells of every sheet, from its first to its last.
    cells: Vec<Range<Data>>,
    from_1904: bool,
}

impl Xls {
    pub(super) fn open(input: &Input) -> Result<Self, FileError> {
        let sifted = sifted(input)?;
        contained(input, || {
            let file = Cursor::new(container::around("Workbook", &sifted.stream));
            let wrong = |error: calamine::XlsError| input.damaged("workbook", "sheets of cells", error.to_string());
            let mut reading = calamine::Xls::new(file).map_err(wrong)?;
            let (mut cells, mut names) = (Vec::new(), BTreeSet::new());
            for name in reading.sheet_names() {
                let range = reading.worksheet_range(&name).map_err(wrong)?;
                // A cell whose shared text is none is passed over in silence.
                let held = range.used_cells().count();
                if sifted.held.get(cells.len()) != Some(&held) {
                    return Err(input.damaged(
                        format!("sheet {name}"),
                        "a text of every cell",
                        "shared texts that are missing",
                    ));
                }
                cells.push(range);
                if !names.insert(name.clone()) {
                    return Err(input.damaged("workbook", "sheets of different names", name.clone()));
                }
            }
            Ok(Self {
                sheets: sifted.sheets,
                cells,
                from_1904: reading.has_1904_epoch(),
            })
        })
    }
}

/// The records of a workbook that `calamine` may see.
fn sifted(input: &Input) -> Result<Sifted, FileError> {
    let bytes = input.bytes()?;
    let compound = Compound::of(&bytes)
        .ok_or_else(|| input.damaged("compound file", "a chain of sectors", "one that breaks off"))?;
    if compound.has("EncryptedPackage") {
        return Err(input.wrong(FileProblem::Encrypted));
    }
    let Some(stream) = compound.stream("Workbook") else {
        let found = if compound.has("Book") { "one of Excel 95 or older" } else { "none" };
        let hint = "open it in its program and save its table as .xlsx or CSV";
        return Err(input.wrong(FileProblem::unfit("compound file", "a workbook of Excel 97 or later", found, hint)));
    };
    let sifted = sift::sift(&stream).map_err(|(place, expected)| match expected.starts_with("at most") {
        true => {
            let hint = "clear cells far from the table, or save the workbook as .xlsx";
            input.wrong(FileProblem::unfit(place, expected, "more", hint))
        }
        false => input.damaged(place, expected, "other bytes, or their end"),
    })?;
    if sifted.encrypted {
        return Err(input.wrong(FileProblem::Encrypted));
    }
    if sifted.stream.len() > container::MOST_OF_STREAM {
        return Err(input.too_large("the cells of a workbook", container::MOST_OF_STREAM as u64));
    }
    Ok(sifted)
}

impl Book for Xls {
    fn sheets(&self) -> &[Sheet] {
        &self.sheets
    }

    fn days_to_epoch(&self) -> f64 {
        if self.from_1904 { DAYS_FROM_1904 } else { DAYS_FROM_1900 }
    }

    fn visit(&self, sheet: usize, each: &mut Visitor<'_>) -> Result<(), FileError> {
        let Some(cells) = self.cells.get(sheet) else {
            return Ok(());
        };
        let (first_row, first_column) = cells.start().unwrap_or_default();
        let rows = cells.height() as u64;
        for (row, column, data) in cells.used_cells() {
            let done = row as u64 + 1;
            // A sheet of this format has 65,536 rows at most.
            let (row, column) = (first_row + row as u32, first_column + column as u32);
            let Some(value) = Value::of_kept(data, self.days_to_epoch()) else {
                continue;
            };
            if each(Cell { row, column, value }, done, rows)? == ControlFlow::Break(()) {
                break;
            }
        }
        Ok(())
    }
}
