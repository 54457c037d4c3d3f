//! Columns of a record from a table.

use arrow_array::Array;
use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_cast::cast;
use arrow_schema::{DataType, TimeUnit};
use pyo3::prelude::*;
use pyo3_arrow::PyTable;

use crate::arrays::doubles;
use crate::errors::{OptionError, RecordError, refused, refused_plainly};

/// Time (s), displacement (m) and force (N).
pub(super) type Columns = (Vec<f64>, Option<Vec<f64>>, Vec<f64>);

/// The columns of these names; a displacement without one is looked for under its own, and may be missing.
pub(super) fn of_table(
    table: &Bound<'_, PyAny>,
    time_s: &str,
    force_n: &str,
    displacement_m: Option<&str>,
) -> PyResult<Columns> {
    if is_by_names(table)? {
        return by_names(table, time_s, force_n, displacement_m);
    }
    let Ok(table) = table.extract::<PyTable>() else {
        // What is no table to Arrow may be one by the names of its columns: polars exports columns that are none at all as nothing can read.
        let is_table = !table.hasattr("collect")? && table.hasattr("columns")?;
        return match is_table {
            true => by_names(table, time_s, force_n, displacement_m).map_err(|error| of_record(table.py(), error)),
            false => Err(no_table(table)?),
        };
    };
    let known = |name: &str| table.batches().first().is_none_or(|batch| batch.column_by_name(name).is_some());
    let usual = Some("displacement_m").filter(|name| known(name));
    let displacement = displacement_m.or(usual).map(|name| column(&table, name, false)).transpose()?;
    Ok((column(&table, time_s, true)?, displacement, column(&table, force_n, false)?))
}

/// The columns of a table that is read by their names.
fn by_names(table: &Bound<'_, PyAny>, time_s: &str, force_n: &str, displacement_m: Option<&str>) -> PyResult<Columns> {
    let column = |argument: &str, name: &str| doubles(&column_of(table, name)?, argument);
    let names = if table.hasattr("columns")? { table.getattr("columns")? } else { table.clone() };
    let displacement = match displacement_m {
        None if !names.contains("displacement_m")? => None,
        name => Some(column("displacement_m", name.unwrap_or("displacement_m"))?),
    };
    Ok((column("time_s", time_s)?, displacement, column("force_n", force_n)?))
}

/// Why something is no table.
fn no_table(found: &Bound<'_, PyAny>) -> PyResult<PyErr> {
    let message =
        format!("expected a table of polars, pandas or pyarrow, or a mapping, found {}", found.get_type().name()?);
    let is_lazy = found.hasattr("collect")?;
    let help = if is_lazy {
        "table.collect()"
    } else {
        "Record.from_arrays(time_s=..., force_n=...) takes columns"
    };
    Ok(refused::<RecordError>(message, Some(help)))
}

/// The name of a column that is given beside a table.
pub(super) fn column_name(argument: &str, given: Option<&Bound<'_, PyAny>>) -> PyResult<Option<String>> {
    let wrong = |found: &Bound<'_, PyAny>| {
        let kind = found.get_type().name().map_or_else(|_| String::new(), |name| name.to_string());
        let message = format!("{argument}: expected the name of a column beside a table, found {kind}");
        refused::<OptionError>(message, Some("pass either a table or arrays"))
    };
    given.map(|given| given.extract().map_err(|_| wrong(given))).transpose()
}

/// What helps where a column has another name.
const NAMED: &str = "name the columns: time_s=\"...\", force_n=\"...\", displacement_m=\"...\"";

/// A column of numbers by its name, none missing; one of times may have durations, in s, and dates, in s since the first.
fn column(table: &PyTable, name: &str, is_of_times: bool) -> PyResult<Vec<f64>> {
    let (mut values, mut first) = (Vec::new(), None);
    for batch in table.batches() {
        let Some(column) = batch.column_by_name(name) else {
            let schema = batch.schema();
            let names: Vec<&str> = schema.fields().iter().map(|field| field.name().as_str()).collect();
            let message = format!("expected a column called {name:?}, found {}", names.join(", "));
            return Err(refused::<RecordError>(message, Some(NAMED)));
        };
        if column.null_count() > 0 || (*column.data_type() == DataType::Null && !column.is_empty()) {
            let row = (0..column.len()).find(|row| column.is_null(*row)).unwrap_or(0);
            let message = format!("{name}: expected a number in every row, found none in row {}", values.len() + row);
            return Err(refused_plainly::<RecordError>(message));
        }
        match column.data_type() {
            kind if kind.is_numeric() => {
                let doubles = cast(column, &DataType::Float64).map_err(refused_plainly::<RecordError>)?;
                values.extend_from_slice(doubles.as_primitive::<Float64Type>().values());
            }
            DataType::Timestamp(unit, _) | DataType::Duration(unit) if is_of_times => {
                let counts = cast(column, &DataType::Int64).map_err(refused_plainly::<RecordError>)?;
                let counts = counts.as_primitive::<Int64Type>().values();
                let is_date = matches!(column.data_type(), DataType::Timestamp(..));
                let first = *first.get_or_insert(if is_date { counts.first().copied().unwrap_or(0) } else { 0 });
                let per_second = match unit {
                    TimeUnit::Second => 1.0,
                    TimeUnit::Millisecond => 1e3,
                    TimeUnit::Microsecond => 1e6,
                    TimeUnit::Nanosecond => 1e9,
                };
                values.extend(counts.iter().map(|count| (count - first) as f64 / per_second));
            }
            other => {
                let message = format!("{name}: expected a column of doubles, found one of {other}");
                return Err(refused_plainly::<RecordError>(message));
            }
        }
    }
    Ok(values)
}

/// Whether a table is read by the names of its columns: it has them, and is none to Arrow.
fn is_by_names(table: &Bound<'_, PyAny>) -> PyResult<bool> {
    let is_of_numpy = table.py().import("palpate._arrays")?.call_method1("is_of_numpy", (table,))?.extract()?;
    Ok(table.hasattr("keys")? && (is_of_numpy || !table.hasattr("__arrow_c_stream__")?))
}

/// A column of a mapping or a Dataset.
fn column_of<'py>(table: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let found = table.py().import("palpate._long")?.call_method1("column", (table, name));
    found.map_err(|error| of_record(table.py(), error))
}

/// What is wrong with a column as something that is wrong with a record.
fn of_record(py: Python<'_>, error: PyErr) -> PyErr {
    match error.is_instance_of::<OptionError>(py) {
        true => refused_plainly::<RecordError>(error.value(py)),
        false => error,
    }
}
