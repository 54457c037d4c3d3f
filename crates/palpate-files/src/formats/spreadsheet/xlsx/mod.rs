//! Workbooks of Office Open XML (`.xlsx`, `.xlsm`): XML parts in a zip archive, read by `calamine`.
//!
//! | file | what |
//! |---|---|
//! | `package.rs` | the parts of the archive, and going through their XML up to a limit |
//! | `guard.rs` | what is gone over before `calamine` takes it at its word |

mod guard;
mod package;

use std::{
    collections::BTreeSet,
    io::BufReader,
    ops::ControlFlow,
    sync::{Mutex, PoisonError},
};

use calamine::{Reader, SheetType};

use crate::{
    error::{FileError, FileProblem, shown},
    formats::spreadsheet::{
        book::{Book, DAYS_FROM_1900, DAYS_FROM_1904, Sheet, Visitor},
        cell::{Cell, Value},
    },
    input::{Input, Seekable, contained},
};
use package::Package;

pub(super) use package::has_part;

type Reading = calamine::Xlsx<BufReader<Box<dyn Seekable>>>;

/// A workbook that has been gone over, and whose sheets, texts and styles have been read.
pub(super) struct Xlsx {
    input: Input,
    reading: Mutex<Reading>,
    sheets: Vec<Sheet>,
    from_1904: bool,
}

impl Xlsx {
    pub(super) fn open(input: &Input) -> Result<Self, FileError> {
        let found = guard::check(&Package::open(input)?)?;
        if !found.has_sheets {
            let hint = "name a workbook, or open this file in its program and save its table as .xlsx or CSV";
            return Err(input.wrong(FileProblem::unfit("zip archive", "a workbook with sheets", found.document, hint)));
        }
        let reading: Reading = contained(input, || {
            let stored = BufReader::with_capacity(1 << 16, input.seekable()?);
            Reading::new(stored)
                .map_err(|error| input.damaged("zip archive", "a workbook with sheets", shown(&error.to_string())))
        })?;
        let sheet = |sheet: &calamine::Sheet| Sheet {
            name: sheet.name.clone(),
            other: other(sheet.typ),
        };
        let sheets: Vec<Sheet> = reading.sheets_metadata().iter().map(sheet).collect();
        let mut names = BTreeSet::new();
        if let Some(twin) = sheets.iter().find(|sheet| !names.insert(&sheet.name)) {
            return Err(input.damaged("zip archive", "sheets of different names", shown(&twin.name)));
        }
        Ok(Self {
            input: input.clone(),
            from_1904: reading.has_1904_epoch(),
            reading: Mutex::new(reading),
            sheets,
        })
    }
}

fn other(kind: SheetType) -> Option<&'static str> {
    match kind {
        SheetType::WorkSheet => None,
        SheetType::ChartSheet => Some("a chart"),
        SheetType::DialogSheet => Some("a dialogue"),
        SheetType::MacroSheet => Some("a macro"),
        SheetType::Vba => Some("no table of numbers"),
    }
}

impl Book for Xlsx {
    fn sheets(&self) -> &[Sheet] {
        &self.sheets
    }

    fn days_to_epoch(&self) -> f64 {
        if self.from_1904 { DAYS_FROM_1904 } else { DAYS_FROM_1900 }
    }

    fn visit(&self, sheet: usize, each: &mut Visitor<'_>) -> Result<(), FileError> {
        let Some(Sheet { name, .. }) = self.sheets.get(sheet) else {
            return Ok(());
        };
        let wrong = |error: calamine::XlsxError| {
            self.input.damaged(format!("sheet {name}"), "rows of cells", shown(&error.to_string()))
        };
        contained(&self.input, || {
            let mut reading = self.reading.lock().unwrap_or_else(PoisonError::into_inner);
            let mut cells = reading.worksheet_cells_reader(name).map_err(wrong)?;
            // The sheet says how many it has; this is only for those who wait.
            let rows = u64::from(cells.dimensions().end.0) + 1;
            while let Some(found) = cells.next_cell().map_err(wrong)? {
                let (row, column) = found.get_position();
                let Some(value) = Value::of_ref(found.get_value(), self.days_to_epoch()) else {
                    continue;
                };
                if each(Cell { row, column, value }, u64::from(row) + 1, rows)? == ControlFlow::Break(()) {
                    break;
                }
            }
            Ok(())
        })
    }
}
