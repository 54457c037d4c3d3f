//! Tables: written once, read as CSV and as sheets of a workbook by machines and as text or HTML by people.
//!
//! ```
//! use palpate_report::table::{Cell, CsvLocale, Table};
//!
//! let holds = [(1, Some(0.012_345)), (2, None)];
//! let table = Table::of("law", "Fitted law.", &holds)
//!     .column("Hold", "hold", "", |(number, _)| Cell::Integer(*number))
//!     .column("Rate coefficient", "rate_coefficient_per_s", "s⁻¹", |(_, v)| Cell::number_or(*v, 3, "hold too short"))
//!     .table();
//! assert_eq!(table.to_csv(CsvLocale::En), "hold,rate_coefficient_per_s\r\n1,0.012345\r\n2,\r\n");
//! ```

mod cell;
mod csv;
mod locale;
mod markdown;
mod plain;
#[cfg(feature = "xlsx")]
mod xlsx;

pub use cell::Cell;
pub use csv::{csv_writer, text_cell};
pub use locale::CsvLocale;
use palpate::units::suited;
#[cfg(feature = "xlsx")]
pub use xlsx::{MOST_SHEET_ROWS, Workbook, WorkbookError};

/// One column of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TableColumn {
    /// What a person reads.
    pub heading: String,
    /// What a machine reads, with a suffix for the unit, as in `rate_coefficient_per_s`.
    pub key: String,
    /// Unit of the values; empty for a dimensionless number or for text. People read the values in the unit that suits their size.
    pub unit: String,
    /// Whether values carry their uncertainty: machines then read three more columns, `_standard_error`, `_low` and `_high`.
    pub is_estimate: bool,
}

impl TableColumn {
    /// Heading with this unit, as in `Force (N)`.
    pub(crate) fn title(&self, unit: &str) -> String {
        if unit.is_empty() { self.heading.clone() } else { format!("{} ({unit})", self.heading) }
    }
}

/// Named columns with their rows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// Name of the table, fit for a file name without extension.
    pub name: String,
    /// Caption.
    pub caption: String,
    /// Columns from left to right.
    pub columns: Vec<TableColumn>,
    /// Rows from top to bottom; a short row is read as if filled up with empty text.
    pub rows: Vec<Vec<Cell>>,
    /// Remarks below the table.
    pub notes: Vec<String>,
}

/// A table with a row for each of its items; every column says what stands in the row of an item.
#[derive(Debug)]
pub struct Columns<'a, T> {
    table: Table,
    items: &'a [T],
}

impl Table {
    /// A table with a row for each of `items` and no columns yet.
    #[must_use]
    pub fn of<T>(name: impl Into<String>, caption: impl Into<String>, items: &[T]) -> Columns<'_, T> {
        let mut table = Self::new(name, caption);
        table.rows.resize(items.len(), Vec::new());
        Columns { table, items }
    }

    /// A table without columns and rows.
    #[must_use]
    pub fn new(name: impl Into<String>, caption: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            caption: caption.into(),
            ..Self::default()
        }
    }

    /// Adds a column on the right.
    #[must_use]
    pub fn column(mut self, heading: impl Into<String>, key: impl Into<String>, unit: impl Into<String>) -> Self {
        self.columns.push(TableColumn {
            heading: heading.into(),
            key: key.into(),
            unit: unit.into(),
            is_estimate: false,
        });
        self
    }

    /// Adds a column on the right whose values carry their uncertainty.
    #[must_use]
    pub fn estimates(mut self, heading: impl Into<String>, key: impl Into<String>, unit: impl Into<String>) -> Self {
        self = self.column(heading, key, unit);
        self.columns.iter_mut().next_back().into_iter().for_each(|column| column.is_estimate = true);
        self
    }

    /// Adds a row at the bottom.
    #[must_use]
    pub fn row(mut self, row: Vec<Cell>) -> Self {
        self.rows.push(row);
        self
    }

    /// Adds a remark below the table.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// The table as CSV: keys as header, numbers that read back exactly, written as the language of its readers has it.
    #[must_use]
    pub fn to_csv(&self, locale: CsvLocale) -> String {
        csv::write(self, locale)
    }

    /// The table as aligned text for a terminal, no wider than that is where words can be broken and columns set below each other.
    #[must_use]
    pub fn to_plain_text(&self) -> String {
        plain::write(self, crate::wrap::width())
    }

    /// The table as Markdown, without its caption and remarks; cells may hold Markdown of their own.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        markdown::write(self)
    }

    /// The cell at a place; places outside the rows hold empty text.
    pub(crate) fn cell(&self, row: usize, column: usize) -> &Cell {
        const EMPTY: &Cell = &Cell::Text(String::new());
        self.rows.get(row).and_then(|row| row.get(column)).unwrap_or(EMPTY)
    }

    /// The unit in which people read each column, and the factor to it, by the median size of its values. Columns of one unit share it
    /// unless their sizes are far apart.
    pub(crate) fn units(&self) -> Vec<(&str, f64)> {
        /// Sizes within this factor of the largest are read in one unit.
        const FAR: f64 = 100.0;
        let size = |column: usize| {
            let sizes = (0..self.rows.len()).filter_map(|row| self.cell(row, column).size());
            let mut sizes: Vec<f64> = sizes.map(f64::abs).filter(|size| *size > 0.0 && size.is_finite()).collect();
            sizes.sort_by(f64::total_cmp);
            sizes.get(sizes.len() / 2).copied().unwrap_or(0.0)
        };
        let sizes: Vec<f64> = (0..self.columns.len()).map(size).collect();
        let largest = |unit: &str| {
            let of_unit = self.columns.iter().zip(&sizes).filter(|(column, _)| column.unit == unit);
            of_unit.map(|(_, size)| *size).fold(0.0, f64::max)
        };
        let columns = self.columns.iter().zip(&sizes);
        columns
            .map(|(column, size)| {
                let largest = largest(&column.unit);
                suited(&column.unit, if size * FAR >= largest || *size == 0.0 { largest } else { *size })
            })
            .collect()
    }

    /// Whether a column holds numbers and is set flush right.
    pub(crate) fn is_numeric(&self, column: usize) -> bool {
        let cells = || (0..self.rows.len()).map(|row| self.cell(row, column));
        // A column whose every number is missing is still one of numbers.
        cells().any(|cell| !matches!(cell, Cell::Text(_)))
            && cells().all(|cell| !matches!(cell, Cell::Text(text) if !text.is_empty()))
    }

    /// Why values are missing, in order of appearance; a reason is listed once.
    pub(crate) fn reasons(&self) -> Vec<&str> {
        let mut reasons: Vec<&str> = Vec::new();
        for cell in self.rows.iter().flatten() {
            if let Cell::Missing(reason) = cell
                && !reason.is_empty()
                && !reasons.contains(&reason.as_str())
            {
                reasons.push(reason);
            }
        }
        reasons
    }
}

impl<T> Columns<'_, T> {
    /// Adds a column on the right: heading, key and unit as in [`TableColumn`], and its cell for an item.
    #[must_use]
    pub fn column(
        mut self,
        heading: impl Into<String>,
        key: impl Into<String>,
        unit: &str,
        cell: impl Fn(&T) -> Cell,
    ) -> Self {
        self.table = self.table.column(heading, key, unit);
        for (row, item) in self.table.rows.iter_mut().zip(self.items) {
            row.push(cell(item));
        }
        self
    }

    /// Adds a column on the right whose values carry their uncertainty.
    #[must_use]
    pub fn estimates(
        self,
        heading: impl Into<String>,
        key: impl Into<String>,
        unit: &str,
        cell: impl Fn(&T) -> Cell,
    ) -> Self {
        let mut columns = self.column(heading, key, unit, cell);
        columns
            .table
            .columns
            .iter_mut()
            .next_back()
            .into_iter()
            .for_each(|column| column.is_estimate = true);
        columns
    }

    /// The table with its columns.
    #[must_use]
    pub fn table(self) -> Table {
        self.table
    }

    /// The table, unless it has no row.
    #[must_use]
    pub fn unless_empty(self) -> Option<Table> {
        (!self.items.is_empty()).then_some(self.table)
    }
}

/// The mark that ties a missing value to its reason: a, b, …, z, aa, ab, …
pub(crate) fn mark(index: usize) -> String {
    let letter = char::from(b'a' + u8::try_from(index % 26).unwrap_or(0));
    if index < 26 { letter.to_string() } else { format!("{}{letter}", mark(index / 26 - 1)) }
}

#[cfg(test)]
mod tests {
    use palpate::fit::Estimate;

    use super::*;

    #[test]
    fn values_are_read_in_the_unit_of_their_size_and_stored_in_their_own() {
        let estimate = Estimate {
            standard_error: Some(1e-10),
            interval: Some((1.8e-9, 2.2e-9)),
            ..Estimate::fixed(2e-9)
        };
        let table = Table::new("t", "")
            .estimates("Force", "force_n", "N")
            .column("Noise", "noise_n", "N")
            .row(vec![Cell::Estimate(estimate), Cell::Number(1.5e-11, 2)])
            .row(vec![Cell::missing("none"), Cell::Number(0.0, 2)]);
        let text = table.to_plain_text();
        assert!(
            text.contains("Force (nN)") && text.contains("2.00 [1.80, 2.20]") && text.contains("0.015"),
            "{text}"
        );
        let csv = table.to_csv(CsvLocale::En);
        assert!(csv.starts_with("force_n,force_n_standard_error,force_n_low,force_n_high,noise_n\r\n"), "{csv}");
        assert!(csv.contains("2e-09,1e-10,1.8e-09,2.2e-09,1.5e-11\r\n,,,,0\r\n"), "{csv}");
    }

    #[test]
    fn marks_go_on_after_z() {
        assert_eq!((mark(0), mark(25), mark(26), mark(52)), ("a".into(), "z".into(), "aa".into(), "ba".into()));
    }

    #[test]
    fn numeric_columns_may_lack_values_but_hold_no_text() {
        let table = Table::new("t", "")
            .column("A", "a", "s")
            .column("B", "b", "")
            .row(vec![Cell::Number(1.0, 2), Cell::Integer(1)])
            .row(vec![Cell::missing("none"), Cell::text("x")])
            .row(vec![]);
        assert!(table.is_numeric(0) && !table.is_numeric(1) && !table.is_numeric(7));
        assert_eq!(table.reasons(), ["none"]);
        assert_eq!(table.columns[0].title("s"), "A (s)");
    }
}
