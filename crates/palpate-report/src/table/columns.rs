//! Tables with a row for each of some items.

use super::{Cell, Table, TableColumn};

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
        self.table.columns.push(TableColumn::new(heading, key, unit));
        for (row, item) in self.table.rows.iter_mut().zip(self.items) {
            row.push(cell(item));
        }
        self
    }

    /// The table with its columns.
    #[must_use]
    pub fn table(self) -> Table {
        self.table
    }
}
