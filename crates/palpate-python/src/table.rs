//! A table of results: Arrow inside, so that polars, pandas and pyarrow take it without copies.

use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_schema::{ArrowError, DataType};
use numpy::PyArray1;
use pyo3::exceptions::{PyKeyError, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::PyList;
use pyo3_arrow::PyTable;

use crate::document::{Document, Fields};

/// Columns of results, each named with its unit.
#[pyclass(name = "Table", module = "palpate", frozen)]
pub(crate) struct Table {
    batch: RecordBatch,
}

impl Table {
    /// From columns of one length.
    pub(crate) fn of(columns: Vec<(&str, ArrayRef)>) -> PyResult<Self> {
        // A column without a missing value may get one in the next table of its kind.
        let columns = columns.into_iter().map(|(name, values)| (name.to_owned(), values, true));
        let batch = RecordBatch::try_from_iter_with_nullable(columns)
            .map_err(|error: ArrowError| PyRuntimeError::new_err(error.to_string()))?;
        Ok(Self { batch })
    }

    /// From documents: the columns are the fields that stand in any of them, in order.
    pub(crate) fn of_documents(rows: &[Fields]) -> PyResult<Self> {
        let mut names: Vec<&str> = Vec::new();
        for name in rows.iter().flat_map(Fields::keys) {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        let column = |name: &str| -> ArrayRef {
            let cells = || rows.iter().map(|row| row.get(name).unwrap_or(&Document::Null(())));
            let found = |kind: fn(&Document) -> bool| cells().any(kind);
            let texts = found(|cell| matches!(cell, Document::Text(_)));
            let truths = found(|cell| matches!(cell, Document::Bool(_)));
            let numbers = found(|cell| matches!(cell, Document::Number(_)));
            let integers = found(|cell| matches!(cell, Document::Integer(_)));
            if texts {
                let text = |cell: &Document| match cell {
                    Document::Text(text) => Some(text.clone()),
                    _ => None,
                };
                Arc::new(cells().map(text).collect::<StringArray>())
            } else if truths {
                let truth = |cell: &Document| match cell {
                    Document::Bool(truth) => Some(*truth),
                    _ => None,
                };
                Arc::new(cells().map(truth).collect::<BooleanArray>())
            } else if integers && !numbers {
                let integer = |cell: &Document| match cell {
                    Document::Integer(value) => Some(*value),
                    _ => None,
                };
                Arc::new(cells().map(integer).collect::<Int64Array>())
            } else {
                let number = |cell: &Document| match cell {
                    Document::Number(value) => Some(*value),
                    Document::Integer(value) => Some(*value as f64),
                    _ => None,
                };
                Arc::new(cells().map(number).collect::<Float64Array>())
            }
        };
        Self::of(names.iter().map(|name| (*name, column(name))).collect())
    }
}

#[pymethods]
impl Table {
    /// Names of the columns.
    #[getter]
    fn column_names(&self) -> Vec<String> {
        self.batch.schema().fields().iter().map(|field| field.name().clone()).collect()
    }

    fn __len__(&self) -> usize {
        self.batch.num_rows()
    }

    fn __getitem__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let column = self.batch.column_by_name(name).ok_or_else(|| {
            PyKeyError::new_err(format!("no column is called {name:?}; columns are {}", self.column_names().join(", ")))
        })?;
        Ok(match column.data_type() {
            DataType::Float64 => {
                let values = column.as_primitive::<Float64Type>().iter().map(|value| value.unwrap_or(f64::NAN));
                PyArray1::from_iter(py, values).into_any()
            }
            DataType::Int64 if column.null_count() == 0 => {
                PyArray1::from_slice(py, column.as_primitive::<Int64Type>().values()).into_any()
            }
            DataType::Int64 => PyList::new(py, column.as_primitive::<Int64Type>().iter())?.into_any(),
            DataType::Boolean => PyList::new(py, column.as_boolean().iter())?.into_any(),
            _ => PyList::new(py, column.as_string::<i32>().iter())?.into_any(),
        })
    }

    /// The Arrow PyCapsule interface: `polars.DataFrame(table)`, `pyarrow.table(table)`.
    #[pyo3(signature = (requested_schema=None))]
    pub(crate) fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let table = PyTable::try_new(vec![self.batch.clone()], self.batch.schema())?;
        table.into_pyobject(py)?.call_method1("__arrow_c_stream__", (requested_schema,))
    }

    fn __repr__(&self) -> String {
        let names = self.column_names().join(", ");
        format!("<palpate.Table of {} rows: {names}>", self.batch.num_rows())
    }
}
