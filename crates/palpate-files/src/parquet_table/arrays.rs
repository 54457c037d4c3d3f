//! Columns of rows to arrays of Arrow and back.

use std::sync::Arc;

use arrow_array::{
    ArrayRef, Float64Array, Int64Array, StringArray,
    cast::AsArray,
    types::{Float64Type, Int64Type},
};

use super::rows::{Rows, Values};

impl Values {
    /// Adds the values of a column of the same kind; `None` where it is of another.
    fn append(&mut self, more: Self) -> Option<()> {
        match (self, more) {
            (Self::Count(column), Self::Count(more)) => column.extend(more),
            (Self::OptionalCount(column), Self::OptionalCount(more)) => column.extend(more),
            (Self::Number(column), Self::Number(more)) => column.extend(more),
            (Self::Text(column), Self::Text(more)) => column.extend(more),
            _ => return None,
        }
        Some(())
    }

    fn split_off(&mut self, at: usize) -> Self {
        match self {
            Self::Count(column) => Self::Count(column.split_off(at)),
            Self::OptionalCount(column) => Self::OptionalCount(column.split_off(at)),
            Self::Number(column) => Self::Number(column.split_off(at)),
            Self::Text(column) => Self::Text(column.split_off(at)),
        }
    }

    /// Adds the values of a column of the same kind.
    pub(super) fn extend(&mut self, column: &ArrayRef) {
        match self {
            Self::Count(values) => values.extend(column.as_primitive::<Int64Type>().values()),
            Self::OptionalCount(values) => values.extend(column.as_primitive::<Int64Type>()),
            Self::Number(values) => values.extend(column.as_primitive::<Float64Type>()),
            Self::Text(values) => values.extend(column.as_string::<i32>().iter().map(|text| text.map(str::to_owned))),
        }
    }
}

impl Rows {
    /// Adds rows of the same columns; `None` where they have others, or columns of several lengths.
    pub(super) fn append(&mut self, more: Self) -> Option<()> {
        let length = more.len();
        if more.columns.len() != self.columns.len() || more.columns.iter().any(|column| column.len() != length) {
            return None;
        }
        self.columns.iter_mut().zip(more.columns).try_for_each(|(column, more)| column.append(more))
    }

    /// Takes the rows from the index `at` on away; there are at least so many.
    pub(super) fn split_off(&mut self, at: usize) -> Self {
        Self {
            columns: self.columns.iter_mut().map(|column| column.split_off(at)).collect(),
        }
    }
}

impl From<Values> for ArrayRef {
    fn from(values: Values) -> Self {
        match values {
            Values::Count(values) => Arc::new(Int64Array::from(values)),
            Values::OptionalCount(values) => Arc::new(Int64Array::from(values)),
            Values::Number(values) => Arc::new(Float64Array::from(values)),
            Values::Text(values) => Arc::new(StringArray::from(values)),
        }
    }
}
