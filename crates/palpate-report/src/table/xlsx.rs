//! Tables as the sheets of one workbook.

use std::collections::HashSet;

use rust_xlsxwriter::{DocProperties, ExcelDateTime, Format, FormatAlign, Workbook as Book, Worksheet, XlsxError};

use super::csv::is_formula;
use super::{Cell, Table, TableColumn};

/// Rows below the header that a sheet can hold.
pub const MOST_SHEET_ROWS: usize = (1 << 20) - 1;
/// Longest name of a sheet, in UTF-16 units.
const LONGEST_NAME: usize = 31;
/// Longest text of a cell, in UTF-16 units.
const LONGEST_TEXT: usize = 32_767;

/// A workbook could not be written.
#[derive(Debug, thiserror::Error)]
#[error("the workbook could not be written: {0}")]
pub struct WorkbookError(#[from] XlsxError);

/// A workbook under construction: one sheet a table, and at the end one with their captions and remarks.
///
/// Numbers are stored as numbers in the unit that the header states, in full precision; a missing value is an empty cell. A text is stored
/// as text, whatever it begins with.
#[derive(Default)]
pub struct Workbook {
    book: Book,
    names: HashSet<String>,
    captions: Vec<[String; 3]>,
}

impl Workbook {
    /// Adds a table.
    ///
    /// # Errors
    /// [`WorkbookError`] where it has more rows or columns than a sheet.
    pub fn table(&mut self, table: &Table) -> Result<(), WorkbookError> {
        let about = [table.caption.clone(), table.notes.join(" ")];
        self.sheet(&table.name, about, &table.columns, table.rows.len(), |row, column| table.cell(row, column).clone())
    }

    /// Adds a sheet whose cells are made one by one, with its caption and its remarks.
    ///
    /// # Errors
    /// As for [`table`](Self::table).
    pub fn sheet(
        &mut self,
        name: &str,
        [caption, remarks]: [String; 2],
        columns: &[TableColumn],
        rows: usize,
        cell: impl Fn(usize, usize) -> Cell,
    ) -> Result<(), WorkbookError> {
        let name = self.free_name(name);
        let sheet = self.book.add_worksheet();
        sheet.set_name(&name)?.set_freeze_panes(1, 0)?;
        let mut at = 0;
        for (index, column) in columns.iter().enumerate() {
            at = write_column(sheet, at, column, rows, |row| cell(row, index))?;
        }
        self.captions.push([name, caption, remarks]);
        Ok(())
    }

    /// The bytes of the workbook; the same tables always give the same.
    ///
    /// # Errors
    /// [`WorkbookError`] where it cannot be packed.
    pub fn finish(mut self) -> Result<Vec<u8>, WorkbookError> {
        let captions = std::mem::take(&mut self.captions);
        let table = Table::of("captions", "", &captions)
            .column("Sheet", "sheet", "", |[name, ..]| Cell::text(name))
            .column("Caption", "caption", "", |[_, caption, _]| Cell::text(caption))
            .column("Remarks", "remarks", "", |[.., remarks]| Cell::text(remarks));
        self.table(&table.table())?;
        // Without this the file says when it was made.
        let never = ExcelDateTime::from_ymd(1980, 1, 1)?;
        self.book.set_properties(&DocProperties::new().set_creation_datetime(&never));
        Ok(self.book.save_to_buffer()?)
    }

    /// The name as a spreadsheet program allows it, of no other sheet: upper and lower case are one name.
    fn free_name(&mut self, name: &str) -> String {
        let clean: String =
            name.chars().map(|c| if "[]:*?/\\".contains(c) || c.is_control() { '-' } else { c }).collect();
        let clean = clean.trim_matches(['\'', ' ']);
        // A program keeps "History" for itself.
        let clean = if clean.is_empty() || clean.eq_ignore_ascii_case("history") { "table" } else { clean };
        let numbered = |number: usize| match number {
            1 => cut(clean, LONGEST_NAME).to_owned(),
            number => {
                let end = format!(" ({number})");
                format!("{}{end}", cut(clean, LONGEST_NAME - end.len()))
            }
        };
        let free = (1..).map(numbered).find(|name| self.names.insert(name.to_lowercase()));
        free.unwrap_or_default()
    }
}

/// The beginning of a text that has at most so many UTF-16 units.
fn cut(text: &str, most: usize) -> &str {
    let mut units = 0;
    let end = text.char_indices().find(|(_, c)| {
        units += c.len_utf16();
        units > most
    });
    end.map_or(text, |(end, _)| text[..end].trim_end())
}

/// Writes a column of a table, with those of its errors, and returns where the next one goes.
fn write_column(
    sheet: &mut Worksheet,
    at: u16,
    column: &TableColumn,
    rows: usize,
    cell: impl Fn(usize) -> Cell,
) -> Result<u16, XlsxError> {
    let title = |what: &str| {
        let heading = format!("{}{what}", column.heading);
        if column.unit.is_empty() { heading } else { format!("{heading} ({})", column.unit) }
    };
    let [own, error, low, high] = ["", ", standard error", ", lower bound", ", upper bound"].map(title);
    write_cells(sheet, at, &own, rows, &cell)?;
    if !column.is_estimate {
        return Ok(at + 1);
    }
    let part = |row: usize, of: fn(&palpate::fit::Estimate) -> Option<f64>| match cell(row) {
        Cell::Estimate(estimate) => of(&estimate).map_or_else(|| Cell::missing(""), |value| Cell::Number(value, 3)),
        _ => Cell::missing(""),
    };
    write_cells(sheet, at + 1, &error, rows, |row| part(row, |estimate| estimate.standard_error))?;
    write_cells(sheet, at + 2, &low, rows, |row| part(row, |estimate| Some(estimate.interval?.0)))?;
    write_cells(sheet, at + 3, &high, rows, |row| part(row, |estimate| Some(estimate.interval?.1)))?;
    Ok(at + 4)
}

fn write_cells(
    sheet: &mut Worksheet,
    at: u16,
    title: &str,
    rows: usize,
    cell: impl Fn(usize) -> Cell,
) -> Result<(), XlsxError> {
    let header = Format::new().set_bold().set_text_wrap().set_align(FormatAlign::Top);
    sheet.write_string_with_format(0, at, title, &header)?;
    let (number, count) = (number_format(rows, &cell), Format::new().set_num_format("0"));
    let (words, formula) = (Format::new().set_num_format("@"), Format::new().set_num_format("@").set_quote_prefix());
    // Headings are broken over two lines.
    let mut widest = title.chars().count().div_ceil(2);
    for row in 0..rows {
        let place = u32::try_from(row + 1).map_err(|_| XlsxError::RowColumnLimitError)?;
        match cell(row) {
            Cell::Number(value, _) | Cell::AtLeast(value, _) if value.is_finite() => {
                // Adding zero turns −0 into 0.
                sheet.write_number_with_format(place, at, value + 0.0, &number)?;
                widest = widest.max(10);
            }
            Cell::Estimate(estimate) if estimate.value.is_finite() => {
                sheet.write_number_with_format(place, at, estimate.value + 0.0, &number)?;
                widest = widest.max(10);
            }
            // A spreadsheet counts in doubles.
            Cell::Integer(value) => {
                sheet.write_number_with_format(place, at, value as f64, &count)?;
            }
            Cell::Text(text) if !text.is_empty() => {
                let format = if is_formula(&text) { &formula } else { &words };
                sheet.write_string_with_format(place, at, cut(&text, LONGEST_TEXT), format)?;
                widest = widest.max(text.chars().count());
            }
            _ => {}
        }
    }
    sheet.set_column_width(at, widest.clamp(8, 60) as f64 + 2.0)?;
    Ok(())
}

/// The format of the numbers in a column: as many decimals as the middle one of them needs for its digits, or a power of ten.
fn number_format(rows: usize, cell: impl Fn(usize) -> Cell) -> Format {
    /// Digits of an estimate, whose errors stand beside it.
    const DIGITS: usize = 5;
    /// Rows that are looked at.
    const LOOKED_AT: usize = 1000;
    let sizes = (0..rows.min(LOOKED_AT)).filter_map(|row| match cell(row) {
        Cell::Number(value, digits) => Some((value.abs(), digits)),
        Cell::AtLeast(value, _) => Some((value.abs(), 2)),
        Cell::Estimate(estimate) => Some((estimate.value.abs(), DIGITS)),
        _ => None,
    });
    let mut sizes: Vec<(f64, usize)> = sizes.filter(|(size, _)| *size > 0.0 && size.is_finite()).collect();
    sizes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let Some((size, digits)) = sizes.get(sizes.len() / 2) else {
        return Format::new().set_num_format("0");
    };
    let (order, digits) = (size.log10().floor(), *digits as f64);
    let plain = (-4.0..6.0).contains(&order);
    let decimals = if plain { (digits - 1.0 - order).max(0.0) } else { digits - 1.0 } as usize;
    let (point, power) = (if decimals > 0 { "." } else { "" }, if plain { "" } else { "E+00" });
    Format::new().set_num_format(format!("0{point}{}{power}", "0".repeat(decimals)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_sheets_are_allowed_and_differ() {
        let mut book = Workbook::default();
        let long = "a name that is longer than any sheet may have";
        let cases = [
            ("laws", "laws"),
            ("Laws", "Laws (2)"),
            ("[a]:b*c?d/e\\f", "-a--b-c-d-e-f"),
            ("'quoted'", "quoted"),
            ("", "table"),
            ("History", "table (2)"),
            (long, "a name that is longer than any"),
            (long, "a name that is longer than (2)"),
            (
                "\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}",
                "\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}\u{1F33D}",
            ),
        ];
        for (name, expected) in cases {
            assert_eq!(book.free_name(name), expected, "{name}");
        }
    }

    #[test]
    fn numbers_have_the_decimals_of_their_digits() {
        let format = |values: &[f64]| number_format(values.len(), |row| Cell::Number(values[row], 3));
        assert_eq!(format(&[0.0123, 0.0456, 0.0789]), Format::new().set_num_format("0.0000"));
        assert_eq!(format(&[12_345.0]), Format::new().set_num_format("0"));
        assert_eq!(format(&[2e-9]), Format::new().set_num_format("0.00E+00"));
        assert_eq!(format(&[]), Format::new().set_num_format("0"));
    }
}
