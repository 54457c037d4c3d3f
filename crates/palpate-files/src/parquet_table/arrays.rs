//! Columns of rows to arrays of Arrow and back.

use std::sync::Arc;

use arrow_array::{
    ArrayRef, Float64Array, Int64Array, StringArray,
    cast::AsArray,
    types::{Float64Type, Int64Type},
};

use super::rows::{Kind, Values};

impl Values {
    /// No values of this kind.
    pub(super) fn empty(kind: Kind) -> Self {
        match kind {
            Kind::Count => Self::Count(Vec::new()),
            Kind::OptionalCount => Self::OptionalCount(Vec::new()),
            Kind::Number => Self::Number(Vec::new()),
            Kind::Text => Self::Text(Vec::new()),
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
