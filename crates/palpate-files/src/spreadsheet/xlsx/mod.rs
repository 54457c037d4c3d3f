//! Workbooks of Office Open XML (`.xlsx`, `.xlsm`): XML parts in a zip archive.
//!
//! Every part is streamed through a limit, so that a small archive cannot fill a memory, and no count or dimension
//! that a part states is believed.
//!
//! | file | what |
//! |---|---|
//! | `package.rs` | the parts of the archive, and reading their XML |
//! | `outline.rs` | the sheets by name, and where their parts are |
//! | `strings.rs` | the texts that all sheets share |
//! | `styles.rs` | which styles show numbers as times |
//! | `cells.rs` | the cells of one sheet |

mod cells;
mod outline;
mod package;
mod strings;
mod styles;

use std::fmt;

use super::{
    book::{Book, DAYS_FROM_1900, DAYS_FROM_1904, Sheet, Visitor},
    cell::NumberFormat,
    strings::Strings,
};
use crate::{error::FileError, input::Input};
use outline::Outline;
use package::Package;

pub(super) use package::has_part;

/// A workbook whose outline, texts and styles have been read.
pub(super) struct Xlsx {
    package: Package,
    outline: Outline,
    strings: Strings,
    styles: Vec<NumberFormat>,
}

impl Xlsx {
    pub(super) fn open(input: &Input) -> Result<Self, FileError> {
        let package = Package::open(input)?;
        let outline = outline::read(&package)?;
        let strings = strings::read(&package, outline.strings.as_deref())?;
        let styles = styles::read(&package, outline.styles.as_deref())?;
        Ok(Self {
            package,
            outline,
            strings,
            styles,
        })
    }
}

impl Book for Xlsx {
    fn sheets(&self) -> &[Sheet] {
        &self.outline.sheets
    }

    fn days_to_epoch(&self) -> f64 {
        if self.outline.from_1904 { DAYS_FROM_1904 } else { DAYS_FROM_1900 }
    }

    fn visit(&self, sheet: usize, each: &mut Visitor<'_>) -> Result<(), FileError> {
        let (Some(part), Some(Sheet { name, .. })) = (self.outline.parts.get(sheet), self.outline.sheets.get(sheet))
        else {
            return Ok(());
        };
        let known = cells::Known {
            strings: &self.strings,
            styles: &self.styles,
            days_to_epoch: self.days_to_epoch(),
        };
        cells::visit(&self.package, name, part, &known, each)
    }
}

impl fmt::Debug for Xlsx {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Xlsx").field("outline", &self.outline).finish_non_exhaustive()
    }
}
