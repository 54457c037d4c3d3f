//! A column as messages name it.

use std::fmt;

use crate::table::ColumnInfo;

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
        write!(f, "column {}", self.number)?;
        match &self.name {
            Some(name) => write!(f, " ({name})"),
            None => Ok(()),
        }
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
