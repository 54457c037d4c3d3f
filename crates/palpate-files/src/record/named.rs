//! A column as messages name it.

use std::fmt;

use crate::{error::shown, table::ColumnInfo};

/// A column as messages name it: `column 3 (Force)`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedColumn {
    /// Its number, from 1.
    pub number: usize,
    /// Its name, if it has one.
    pub name: Option<String>,
}

impl fmt::Display for NamedColumn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.name.as_ref().map_or_else(String::new, |name| format!(" ({})", shown(name)));
        write!(f, "column {}{name}", self.number)
    }
}

impl From<&ColumnInfo> for NamedColumn {
    fn from(column: &ColumnInfo) -> Self {
        Self {
            number: column.number,
            name: column.name.clone(),
        }
    }
}
