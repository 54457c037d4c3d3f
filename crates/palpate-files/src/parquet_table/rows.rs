//! Rows in memory, column by column.

use std::sync::Arc;

use arrow_array::{
    ArrayRef, Float64Array, Int64Array, StringArray,
    cast::AsArray,
    types::{Float64Type, Int64Type},
};

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Whole numbers, none missing.
    Count,
    /// Numbers, some of which may be missing.
    Number,
    /// Texts, some of which may be missing.
    Text,
}

/// A column by its name, which ends in its unit, and its kind.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Name.
    pub name: String,
    /// What it holds.
    pub kind: Kind,
}

impl Field {
    /// A column.
    #[must_use]
    pub fn new(name: impl Into<String>, kind: Kind) -> Self {
        Self {
            name: name.into(),
            kind,
        }
    }
}

/// The values of one column.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Whole numbers.
    Count(Vec<i64>),
    /// Numbers.
    Number(Vec<Option<f64>>),
    /// Texts.
    Text(Vec<Option<String>>),
}

impl Values {
    /// No values of this kind.
    pub(super) fn empty(kind: Kind) -> Self {
        match kind {
            Kind::Count => Self::Count(Vec::new()),
            Kind::Number => Self::Number(Vec::new()),
            Kind::Text => Self::Text(Vec::new()),
        }
    }

    /// Adds the values of a column of the same kind.
    pub(super) fn extend(&mut self, column: &ArrayRef) {
        match self {
            Self::Count(values) => values.extend(column.as_primitive::<Int64Type>().values()),
            Self::Number(values) => values.extend(column.as_primitive::<Float64Type>()),
            Self::Text(values) => values.extend(column.as_string::<i32>().iter().map(|text| text.map(str::to_owned))),
        }
    }
}

impl From<Values> for ArrayRef {
    fn from(values: Values) -> Self {
        match values {
            Values::Count(values) => Arc::new(Int64Array::from(values)),
            Values::Number(values) => Arc::new(Float64Array::from(values)),
            Values::Text(values) => Arc::new(StringArray::from(values)),
        }
    }
}

/// Some rows of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    /// The columns in order, all of one length.
    pub columns: Vec<Values>,
}
