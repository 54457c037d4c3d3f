//! A table of results: Arrow inside, so that polars, pandas and pyarrow take it without copies.

use std::io;
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, StringArray};
use arrow_ipc::CompressionType;
use arrow_ipc::reader::StreamReader;
use arrow_ipc::writer::{IpcWriteOptions, StreamWriter};
use arrow_schema::{ArrowError, DataType};
use arrow_select::concat::concat;
use numpy::PyArrayMethods;
use palpate::number::significant;
use palpate_report::document::{BudgetDocument, ContributionDocument};
use palpate_report::result::{PARAMETER_COLUMNS, ParameterColumn, ParameterRow};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::{PyIndexError, PyKeyError, PyRuntimeError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyString, PyType};
use pyo3_arrow::PyTable;

use crate::arrays::array;
use crate::errors::refused_plainly;
use crate::pickles::{Made, PICKLE, Piece, Pieces, check_pickle, damaged, digest, in_pieces};
use crate::work::{Heard, at_length};

/// Columns of results, each named with its unit.
///
/// ``table["force_n"]`` is an array where the column holds numbers (NaN where one is missing) and a list with None where it holds
/// texts or truths. ``polars.DataFrame(table)``, ``pandas.DataFrame.from_arrow(table)`` and ``pyarrow.table(table)`` take it without
/// a copy; ``pandas.DataFrame(table)`` copies it, row by row; without rows it has no columns, which ``to_pandas()`` keeps. ``for row in table`` goes
/// through the rows, a dict each; ``table[0]`` and ``table[-1]`` are one.
///
/// Examples
/// --------
/// >>> import palpate
/// >>> table = palpate.fit_many([[0, 1, 2, 3, 4, 5, 6, 7]], [[9, 7, 6, 5.5, 5.2, 5.1, 5.05, 5.02]], law="standard-linear-solid")
/// >>> len(table), round(float(table["time_constant_s"][0]), 2)
/// (1, 1.46)
#[pyclass(name = "Table", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(crate) struct Table {
    batch: RecordBatch,
}

impl Table {
    /// Tables with the same columns one below the other; the column `label` has the name of the table that a row is of.
    pub(crate) fn stacked(label: &str, parts: &[(&str, Self)]) -> PyResult<Self> {
        let names = parts.iter().flat_map(|(name, part)| std::iter::repeat_n(*name, part.batch.num_rows()));
        let mut columns: Vec<(&str, ArrayRef)> = vec![(label, Column::column(names))];
        let schema = parts.first().map(|(_, first)| first.batch.schema());
        for field in schema.iter().flat_map(|schema| schema.fields()) {
            let of_part = |(_, part): &(&str, Self)| part.batch.column_by_name(field.name()).cloned();
            let found: Vec<ArrayRef> = parts.iter().filter_map(of_part).collect();
            let arrays: Vec<&dyn Array> = found.iter().map(AsRef::as_ref).collect();
            columns.push((field.name(), concat(&arrays).map_err(refused_plainly::<PyRuntimeError>)?));
        }
        Self::of(columns)
    }

    /// A row as a dict, by its number from the first, or, below 0, from the last.
    fn row<'py>(&self, py: Python<'py>, number: isize) -> PyResult<Bound<'py, PyAny>> {
        let rows = self.batch.num_rows();
        let from_first = if number < 0 { rows.checked_sub(number.unsigned_abs()) } else { Some(number.unsigned_abs()) };
        let within = from_first.filter(|row| *row < rows);
        let missing = || PyIndexError::new_err(format!("no row has the number {number}; there are {rows}"));
        let batch = self.batch.slice(within.ok_or_else(missing)?, 1);
        Self { batch }.__iter__(py)?.call_method0("__next__")
    }

    /// From columns of one length.
    pub(crate) fn of(columns: Vec<(&str, ArrayRef)>) -> PyResult<Self> {
        // A column without a missing value may get one in the next table of its kind.
        let columns = columns.into_iter().map(|(name, values)| (name.to_owned(), values, true));
        let batch = RecordBatch::try_from_iter_with_nullable(columns).map_err(refused_plainly::<PyRuntimeError>)?;
        Ok(Self { batch })
    }
}

/// What a column of a table is made of.
pub(crate) trait Column: Sized {
    /// The values of all rows as one column.
    fn column(values: impl Iterator<Item = Self>) -> ArrayRef;
}

macro_rules! column {
    ($($of:ty => $array:ident, $value:ident: $cell:expr;)*) => {$(
        impl Column for $of {
            fn column(values: impl Iterator<Item = Self>) -> ArrayRef {
                Arc::new(values.map(|$value| $cell).collect::<$array>())
            }
        }
    )*};
}
column! {
    f64 => Float64Array, value: Some(value);
    Option<f64> => Float64Array, value: value;
    usize => Int64Array, value: Some(value as i64);
    Option<usize> => Int64Array, value: value.map(|value| value as i64);
    bool => BooleanArray, value: Some(value);
    String => StringArray, value: Some(value);
    Option<String> => StringArray, value: value;
    &str => StringArray, value: Some(value);
    Option<&str> => StringArray, value: value;
}

/// Columns of rows: the fields of each, or an expression of it, by the name of the column.
macro_rules! columns {
    (@ $row:ident, $name:ident) => { $row.$name.clone() };
    (@ $row:ident, $name:ident, $value:expr) => { $value };
    ($rows:expr, $row:ident => $($name:ident $(= $value:expr)?),* $(,)?) => {
        vec![$((
            stringify!($name),
            $crate::table::Column::column($rows.iter().map(|$row| $crate::table::columns!(@ $row, $name $(, $value)?))),
        )),*]
    };
}
pub(crate) use columns;

/// The columns of the tidy table of parameters, the same as in reports and batches.
pub(crate) fn parameter_columns(rows: &[ParameterRow]) -> Vec<(&'static str, ArrayRef)> {
    let column = |column: ParameterColumn| match column {
        ParameterColumn::Text(of) => Column::column(rows.iter().map(of)),
        ParameterColumn::OptionalText(of) => Column::column(rows.iter().map(of)),
        ParameterColumn::Count(of) => Column::column(rows.iter().map(of)),
        ParameterColumn::Number(of) => Column::column(rows.iter().map(of)),
        ParameterColumn::Flag(of) => Column::column(rows.iter().map(of)),
    };
    // In files an end that is open is missing; as a number it is infinite, as that of an estimate is.
    let ends = |number: usize| Column::column(rows.iter().map(|row| end(row.parameter.interval, number)));
    let named = |(name, of): &(&'static str, ParameterColumn)| match *name {
        "low" => (*name, ends(0)),
        "high" => (*name, ends(1)),
        _ => (*name, column(*of)),
    };
    PARAMETER_COLUMNS.iter().map(named).collect()
}

/// An end of an interval, infinite where it is open; none without an interval.
pub(crate) fn end(interval: Option<[Option<f64>; 2]>, number: usize) -> Option<f64> {
    let open = [f64::NEG_INFINITY, f64::INFINITY];
    interval.map(|ends| ends[number].unwrap_or(open[number]))
}

/// The columns of uncertainty budgets: a row for each input quantity of each result.
pub(crate) fn budget_columns(budgets: &[BudgetDocument]) -> Vec<(&'static str, ArrayRef)> {
    let rows = budgets.iter().flat_map(|budget| budget.contributions.iter().map(move |found| (budget, found)));
    let rows: Vec<(&BudgetDocument, &ContributionDocument)> = rows.collect();
    columns!(rows, row =>
        hold = row.0.hold,
        law = row.0.law.clone(),
        parameter = row.0.name.clone(),
        unit = row.0.unit.clone(),
        value = row.0.value,
        combined_standard_uncertainty = row.0.combined_standard_uncertainty,
        expanded_uncertainty = row.0.expanded_uncertainty,
        input = row.1.input.clone(),
        input_unit = row.1.unit.clone(),
        evaluation = row.1.evaluation.clone(),
        distribution = row.1.distribution.clone(),
        standard_uncertainty = row.1.standard_uncertainty,
        sensitivity = row.1.sensitivity,
        contribution = row.1.contribution,
        share = row.1.share,
    )
}

/// Rows that a notebook shows of each end of a table.
const ENDS: usize = 5;

/// Rows that become objects of Python in some milliseconds.
const AT_ONCE: usize = 1 << 12;

/// Rows that become bytes in some milliseconds.
const PICKLED_AT_ONCE: usize = 1 << 16;

/// A cell as a notebook shows it.
fn cell(column: &ArrayRef, row: usize) -> String {
    if column.is_null(row) {
        return "<td></td>".to_owned();
    }
    let text = match column.data_type() {
        DataType::Float64 => significant(column.as_primitive::<Float64Type>().value(row), 6),
        DataType::Int64 => column.as_primitive::<Int64Type>().value(row).to_string(),
        DataType::Boolean => column.as_boolean().value(row).to_string(),
        DataType::FixedSizeList(_, width) => format!("{width} numbers"),
        _ => escaped(column.as_string::<i32>().value(row)),
    };
    format!("<td>{text}</td>")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[pymethods]
impl Table {
    /// Names of the columns.
    #[getter]
    fn column_names(&self) -> Vec<String> {
        self.batch.schema().fields().iter().map(|field| field.name().clone()).collect()
    }

    /// Names of the columns, as a mapping has them: ``dict(table)`` is one of columns.
    fn keys(&self) -> Vec<String> {
        self.column_names()
    }

    /// Number of rows.
    fn __len__(&self) -> usize {
        self.batch.num_rows()
    }

    /// The rows, a dict each: ``pandas.DataFrame(table)`` is a table of them.
    pub(crate) fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let names = self.column_names().iter().map(|name| PyString::new(py, name).unbind()).collect();
        let (batch, next, columns) = (self.batch.clone(), 0, Vec::new());
        let rows = Rows {
            batch,
            names,
            next,
            columns,
        };
        Ok(Bound::new(py, rows)?.into_any())
    }

    fn __contains__(&self, name: &Bound<'_, PyAny>) -> bool {
        name.extract::<String>().is_ok_and(|name| self.batch.column_by_name(&name).is_some())
    }

    fn __getitem__<'py>(&self, py: Python<'py>, name: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        if let Ok(row) = name.extract::<isize>() {
            return self.row(py, row);
        }
        let names = self.column_names().join(", ");
        let wrong = "a table is indexed by the name of a column or the number of a row";
        let found = |_| PyTypeError::new_err(format!("{wrong}; found {name:?}, columns are {names}"));
        let name: String = name.extract().map_err(found)?;
        let missing = || PyKeyError::new_err(format!("no column is called {name:?}; columns are {names}"));
        let column = self.batch.column_by_name(&name).ok_or_else(missing)?;
        of_python(py, column)
    }

    /// The Arrow PyCapsule interface: `polars.DataFrame(table)`, `pyarrow.table(table)`.
    #[pyo3(signature = (requested_schema=None))]
    pub(crate) fn __arrow_c_stream__(
        &self,
        py: Python<'_>,
        requested_schema: Option<Py<PyAny>>,
    ) -> PyResult<Py<PyAny>> {
        let table = PyTable::try_new(vec![self.batch.clone()], self.batch.schema())?.into_pyobject(py)?;
        Ok(table.call_method1("__arrow_c_stream__", (requested_schema,))?.unbind())
    }

    /// The same rows with a column before the others, which replaces one of its name.
    fn _labelled(&self, name: &str, labels: &Bound<'_, PyAny>) -> PyResult<Self> {
        let truths = labels.extract::<Vec<bool>>().ok().filter(|truths| !truths.is_empty());
        let column: ArrayRef = if let Some(truths) = truths {
            Column::column(truths.into_iter())
        } else if let Ok(counts) = labels.extract::<Vec<Option<i64>>>() {
            Arc::new(Int64Array::from(counts))
        } else if let Ok(numbers) = labels.extract::<Vec<f64>>() {
            Column::column(numbers.into_iter())
        } else {
            Column::column(labels.extract::<Vec<String>>()?.into_iter())
        };
        let (schema, old) = (self.batch.schema(), self.batch.columns().iter());
        let others = schema.fields().iter().map(|field| field.name().as_str()).zip(old.map(Arc::clone));
        let others = others.filter(|(other, _)| *other != name);
        Self::of(std::iter::once((name, column)).chain(others).collect())
    }

    #[classmethod]
    #[pyo3(signature = (bytes, digest="", format=0))]
    fn _from_ipc(class: &Bound<'_, PyType>, bytes: Pieces, digest: &str, format: u32) -> PyResult<Self> {
        check_pickle(format)?;
        let digest = digest.to_owned();
        let of_ours = |batch: RecordBatch| match batch.columns().iter().find(|of| !is_column_of_ours(of.data_type())) {
            Some(column) => Err(format!("a column of {}", column.data_type())),
            None => Ok(Self { batch }),
        };
        let read = move |heard: Heard| -> Result<_, String> {
            // Lengths in the bytes are taken at their word by their reader.
            if bytes.sha256(&heard).map_err(|ended| ended.to_string())? != digest {
                return Err("expected bytes of its digest, found others".to_owned());
            }
            let unread = |error: ArrowError| error.to_string();
            let reader = StreamReader::try_new(bytes.reader(heard.clone()), None).map_err(unread)?;
            let schema = reader.schema();
            let batches: Vec<_> = reader.collect::<Result<_, _>>().map_err(unread)?;
            let [first, _, ..] = &batches[..] else {
                let batch = batches.into_iter().next().unwrap_or_else(|| RecordBatch::new_empty(schema));
                return of_ours(batch);
            };
            let column = |index: usize| -> Result<ArrayRef, String> {
                heard.look().map_err(|ended| ended.to_string())?;
                let parts: Vec<&dyn Array> = batches.iter().map(|batch| batch.column(index).as_ref()).collect();
                concat(&parts).map_err(unread)
            };
            let columns = (0..first.num_columns()).map(column).collect::<Result<_, _>>()?;
            of_ours(RecordBatch::try_new(schema, columns).map_err(unread)?)
        };
        at_length(class.py(), read)?.map_err(damaged)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (Vec<Piece>, String, u32)>> {
        let rows = self.batch.num_rows();
        let pieces = in_pieces(py, |out| {
            let failed = io::Error::other::<ArrowError>;
            let smaller = IpcWriteOptions::default().try_with_compression(Some(CompressionType::LZ4_FRAME));
            let schema = self.batch.schema();
            let mut writer =
                StreamWriter::try_new_with_options(out, &schema, smaller.map_err(failed)?).map_err(failed)?;
            for begin in (0..rows).step_by(PICKLED_AT_ONCE) {
                writer.write(&self.batch.slice(begin, PICKLED_AT_ONCE.min(rows - begin))).map_err(failed)?;
            }
            writer.finish().map_err(failed)
        })?;
        let digest = digest(py, &pieces)?;
        let make = py.get_type::<Self>().getattr("_from_ipc")?;
        Ok((make, (pieces, digest, PICKLE)))
    }

    /// The first and the last rows as a notebook shows them.
    pub(crate) fn _repr_html_(&self) -> String {
        let rows = self.batch.num_rows();
        let shown = |row: &usize| *row < ENDS || *row + ENDS >= rows;
        let row = |row: usize| {
            let cells: String = self.batch.columns().iter().map(|column| cell(column, row)).collect();
            let gap = if row + ENDS == rows && rows > 2 * ENDS { "<tr><td>…</td></tr>" } else { "" };
            format!("{gap}<tr>{cells}</tr>")
        };
        let head: String = self.column_names().iter().map(|name| format!("<th>{}</th>", escaped(name))).collect();
        let body: String = (0..rows).filter(shown).map(row).collect();
        let size = format!("{rows} rows × {} columns", self.batch.num_columns());
        format!("<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table><p>{size}</p>")
    }

    fn __repr__(&self) -> String {
        let names = self.column_names().join(", ");
        format!("<palpate.Table of {} rows: {names}>", self.batch.num_rows())
    }
}

/// A column as Python has it: an array of numbers, or a list.
fn of_python<'py>(py: Python<'py>, column: &ArrayRef) -> PyResult<Bound<'py, PyAny>> {
    Ok(match column.data_type() {
        DataType::Float64 => {
            array(py, column.as_primitive::<Float64Type>().iter().map(|value| value.unwrap_or(f64::NAN)))?.into_any()
        }
        DataType::Int64 if column.null_count() == 0 => {
            array(py, column.as_primitive::<Int64Type>().values().iter().copied())?.into_any()
        }
        DataType::Int64 => {
            let number = |value: Option<i64>| value.map_or(f64::NAN, |value| value as f64);
            array(py, column.as_primitive::<Int64Type>().iter().map(number))?.into_any()
        }
        DataType::FixedSizeList(_, width) => {
            let (rows, width) = (column.as_fixed_size_list(), *width as usize);
            let numbers = rows.values().as_primitive::<Float64Type>();
            let number = |index: usize| if rows.is_valid(index / width) { numbers.value(index) } else { f64::NAN };
            array(py, (0..rows.len() * width).map(number))?.reshape([rows.len(), width])?.into_any()
        }
        DataType::Boolean => listed(py, column.as_boolean().iter().map(|truth| truth.into_bound_py_any(py)))?,
        _ => {
            // A word that stands in many rows is one object.
            let mut last: Option<(&str, Bound<'py, PyAny>)> = None;
            listed(
                py,
                column.as_string::<i32>().iter().map(|text| {
                    let Some(text) = text else {
                        return Ok(py.None().into_bound(py));
                    };
                    if let Some((_, word)) = last.as_ref().filter(|(word, _)| *word == text) {
                        return Ok(word.clone());
                    }
                    let word = PyString::new(py, text).into_any();
                    last = Some((text, word.clone()));
                    Ok(word)
                }),
            )?
        }
    })
}

/// A list of values.
fn listed<'py>(
    py: Python<'py>,
    values: impl Iterator<Item = PyResult<Bound<'py, PyAny>>>,
) -> PyResult<Bound<'py, PyAny>> {
    let list = PyList::empty(py);
    for (index, value) in values.enumerate() {
        if index.is_multiple_of(AT_ONCE) {
            py.check_signals()?;
        }
        list.append(value?)?;
    }
    Ok(list.into_any())
}

/// The rows of a table, which become dicts when they are requested.
#[pyclass(module = "palpate")]
struct Rows {
    batch: RecordBatch,
    names: Vec<Py<PyString>>,
    next: usize,
    /// The columns of the rows from the last multiple of [`AT_ONCE`] on.
    columns: Vec<Py<PyAny>>,
}

#[pymethods]
impl Rows {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __length_hint__(&self) -> usize {
        self.batch.num_rows() - self.next
    }

    fn __next__<'py>(&mut self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let (begin, count) = (self.next, self.batch.num_rows());
        if begin == count {
            return Ok(None);
        }
        let within = begin % AT_ONCE;
        if within == 0 {
            py.check_signals()?;
            let some = self.batch.slice(begin, AT_ONCE.min(count - begin));
            let cells = |column: &ArrayRef| -> PyResult<Py<PyAny>> {
                let values = of_python(py, column)?;
                // A row of several values stays an array.
                let single = values.getattr("ndim").is_ok_and(|ndim| ndim.eq(1).unwrap_or(false));
                Ok(if single { values.call_method0("tolist")? } else { values }.unbind())
            };
            self.columns = some.columns().iter().map(cells).collect::<PyResult<_>>()?;
        }
        let row = PyDict::new(py);
        for (name, column) in self.names.iter().zip(&self.columns) {
            row.set_item(name, column.bind(py).get_item(within)?)?;
        }
        self.next += 1;
        Ok(Some(row))
    }
}

/// Whether a column has one of the types that tables are made of.
fn is_column_of_ours(kind: &DataType) -> bool {
    match kind {
        DataType::Float64 | DataType::Int64 | DataType::Boolean | DataType::Utf8 => true,
        DataType::FixedSizeList(item, width) => *item.data_type() == DataType::Float64 && *width > 0,
        _ => false,
    }
}
