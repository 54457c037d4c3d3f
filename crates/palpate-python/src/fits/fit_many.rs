//! Thousands of holds in one call.

use std::collections::HashMap;
use std::sync::Arc;

use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, ArrayRef};
use arrow_buffer::ScalarBuffer;
use arrow_cast::cast;
use arrow_schema::{DataType, Field};
use numpy::{PyArray1, PyArrayMethods};
use palpate::fit::{Estimate, Fit, LawOptions, Parameter, Samples, Termination, fit_law};
use palpate::laws::Response;
use palpate::watch::{Cancelled, Progress};
use palpate_report::result::word;
use pyo3::prelude::*;
use pyo3_arrow::PyChunkedArray;
use pyo3_arrow::input::AnyArray;
use rayon::prelude::*;

use crate::arrays::doubles;
use crate::errors::{OptionError, PalpateError, refused, refused_plainly, unfitted};
use crate::fits::fit_hold::{Keywords, Requested, fitted, standard_deviations, without_nan};
use crate::table::{Column, Table};
use crate::work::{Heard, at_length_reported, in_parallel};

/// One curve, or why it is none.
type Curve = Result<ScalarBuffer<f64>, String>;

/// Curves of any lengths. Columns of Arrow never change, and are not copied; arrays of NumPy may change, and are.
type Ragged = Vec<Curve>;

fn numbers(curve: &Curve) -> Result<&[f64], String> {
    curve.as_deref().map_err(Clone::clone)
}

/// Lists of numbers from Arrow, or from anything that `palpate._arrays.as_ragged` understands.
///
/// One column of dates or durations goes the way of NumPy, which knows their units.
fn ragged(curves: &Bound<'_, PyAny>, name: &str, omit_nan: bool) -> PyResult<Ragged> {
    let arrays = curves.py().import("palpate._arrays")?;
    let is_of_arrow = curves.hasattr("__arrow_c_stream__")? || curves.hasattr("__arrow_c_array__")?;
    if is_of_arrow && !arrays.call_method1("is_of_numpy", (curves,))?.is_truthy()? {
        // A column of polars that is none at all cannot be read: NumPy says so.
        let column = curves.extract::<AnyArray>().ok().and_then(|curves| curves.into_chunked_array().ok());
        if let Some(column) = column.filter(|column| !column.data_type().is_temporal()) {
            return of_arrow(&column, name, omit_nan);
        }
    }
    let found = arrays.call_method1("as_ragged", (curves, name, omit_nan))?;
    type Found<'py> = (Bound<'py, PyAny>, Bound<'py, PyArray1<i64>>, HashMap<usize, String>);
    let (values, offsets, mut wrong): Found<'_> = found.extract()?;
    let offsets: Vec<usize> = offsets.try_readonly()?.as_array().iter().map(|offset| *offset as usize).collect();
    let values = ScalarBuffer::from(doubles(&values, name)?);
    let curve = |(index, ends): (usize, &[usize])| match wrong.remove(&index) {
        Some(error) => Err(error),
        None => Ok(values.slice(ends[0], ends[1] - ends[0])),
    };
    Ok(offsets.windows(2).enumerate().map(curve).collect())
}

fn of_arrow(column: &PyChunkedArray, name: &str, omit_nan: bool) -> PyResult<Ragged> {
    let wrong = |kind: &DataType| {
        let found = match kind {
            DataType::Struct(fields) => format!("a table of {} columns", fields.len()),
            other => format!("one of {other}"),
        };
        let help = "pass one column, such as table[\"force_n\"], or the rows of table.to_numpy()";
        refused::<OptionError>(format!("{name}: expected a column of lists of numbers, found {found}"), Some(help))
    };
    let mut curves = Vec::new();
    for chunk in column.chunks() {
        let kind = chunk.data_type();
        let made_of = |to: &DataType| cast(chunk, to).map_err(|_| wrong(kind));
        match nested(kind) {
            // Whatever kind of list of whatever kind of number: lists of doubles pass as they are.
            Some(item) if item.is_numeric() || *item == DataType::Null => {
                let rows = made_of(&DataType::LargeList(Arc::new(Field::new("item", DataType::Float64, true))))?;
                curves.extend(rows.as_list::<i64>().iter().map(|row| whole(row, name, omit_nan)));
            }
            None if kind.is_numeric() => curves.push(whole(Some(made_of(&DataType::Float64)?), name, omit_nan)),
            _ => return Err(wrong(kind)),
        }
    }
    Ok(curves)
}

/// What a list is a list of.
fn nested(kind: &DataType) -> Option<&DataType> {
    match kind {
        DataType::List(item) | DataType::LargeList(item) | DataType::ListView(item) => Some(item.data_type()),
        DataType::LargeListView(item) | DataType::FixedSizeList(item, _) => Some(item.data_type()),
        _ => None,
    }
}

/// A curve of doubles all of which are there; with `omit_nan` one that is missing is NaN.
fn whole(row: Option<ArrayRef>, name: &str, omit_nan: bool) -> Curve {
    let row = row.ok_or_else(|| format!("{name}: expected a list of numbers, found none"))?;
    let numbers = row.as_primitive::<Float64Type>();
    if omit_nan && numbers.null_count() > 0 {
        return Ok(numbers.iter().map(|number| number.unwrap_or(f64::NAN)).collect());
    }
    match (0..numbers.len()).find(|index| numbers.is_null(*index)) {
        Some(index) => Err(format!("{name}: expected a number everywhere, found none at index {index}")),
        None => Ok(numbers.values().clone()),
    }
}

/// Whether one list stands for all curves; it is then the matter of all if it is wrong.
fn one_for_all(times: &Ragged, curves: usize, name: &str) -> PyResult<bool> {
    match times.len() {
        1 => numbers(&times[0]).map(|_| true).map_err(refused_plainly::<OptionError>),
        count if count == curves => Ok(false),
        count => {
            let message = format!("{name}: expected one list for all curves or one each, {curves}, found {count}");
            Err(refused_plainly::<OptionError>(message))
        }
    }
}

/// What the table shows of a fit: a fraction of its memory.
struct Row {
    /// In the order of the parameters of the table, those that are determined.
    estimates: Vec<Option<Estimate>>,
    rmse: f64,
    residual_correlation: f64,
    noise: String,
    effective_samples: f64,
    interval_method: &'static str,
    samples: usize,
    termination: Termination,
}

impl Row {
    fn of(fit: &Fit, parameters: &[Parameter]) -> Self {
        let estimate = |parameter: &Parameter| fit.parameter(parameter.name)?.determined(fit.termination).copied();
        Self {
            estimates: parameters.iter().map(estimate).collect(),
            rmse: fit.rmse,
            residual_correlation: fit.residual_correlation,
            noise: fit.noise_in_words(),
            effective_samples: fit.effective_samples(),
            interval_method: fit.interval_method.name(),
            samples: fit.samples,
            termination: fit.termination,
        }
    }
}

/// A fit, or why there is none.
type Fitted = Result<Row, String>;

#[pyfunction]
#[expect(clippy::needless_pass_by_value, reason = "arguments of Python")]
pub(crate) fn fit_many(
    py: Python<'_>,
    time_s: &Bound<'_, PyAny>,
    signal: &Bound<'_, PyAny>,
    weights: Option<&Bound<'_, PyAny>>,
    keywords: Keywords,
    progress: Option<Py<PyAny>>,
) -> PyResult<Table> {
    let requested = keywords.requested()?;
    let omit_nan = requested.omit_nan;
    let (times, values) = (ragged(time_s, "time_s", omit_nan)?, ragged(signal, "signal", omit_nan)?);
    let curves = values.len();
    let one_time = one_for_all(&times, curves, "time_s")?;
    let weights = match weights {
        Some(weights) => {
            let of_one = |weights: Curve| standard_deviations(&weights?, omit_nan).map(ScalarBuffer::from);
            let found: Ragged = ragged(weights, "weights", omit_nan)?.into_iter().map(of_one).collect();
            Some((one_for_all(&found, curves, "weights")?, found))
        }
        None => None,
    };
    let law = requested.law.to_string();
    let parameters = parameters_of(&requested)?;
    let reported = parameters.clone();
    let work = move |heard: Heard| {
        let fit = |index: usize| {
            let time = numbers(&times[if one_time { 0 } else { index }])?;
            let standard_deviations =
                weights.as_ref().map(|(one, found)| numbers(&found[if *one { 0 } else { index }]));
            let (value, standard_deviations) = (numbers(&values[index])?, standard_deviations.transpose()?);
            let mut watch = |_: Progress<'_>| heard.look();
            if !omit_nan {
                return fitted(time, value, standard_deviations, &requested, &mut watch)
                    .map_err(|error| error.to_string());
            }
            let (mut time, mut value) = (time.to_vec(), value.to_vec());
            let mut standard_deviations = standard_deviations.map(<[f64]>::to_vec);
            let columns = [&mut time, &mut value].into_iter().chain(&mut standard_deviations);
            without_nan(&mut columns.collect::<Vec<_>>());
            fitted(&time, &value, standard_deviations.as_deref(), &requested, &mut watch)
                .map_err(|error| error.to_string())
        };
        let one = |index: usize| {
            let row = fit(index).map(|fit| Row::of(&fit, &reported));
            heard.step().map(|()| row)
        };
        in_parallel(|| (0..curves).into_par_iter().map(one).collect::<Result<Vec<Fitted>, Cancelled>>())
    };
    let fits = at_length_reported(py, progress.as_ref(), work)?.map_err(refused_plainly::<PalpateError>)?;
    let fits = fits.map_err(refused_plainly::<PalpateError>)?;
    table(&law, &parameters, &fits)
}

/// The parameters that every fit of a law has, whatever the curve, by their names.
fn parameters_of(requested: &Requested) -> PyResult<Vec<Parameter>> {
    let times: Vec<f64> = (0..200).map(f64::from).collect();
    let falling = |t: &f64| 1.0 / (1.0 + 0.1 * t).sqrt();
    let sign = if requested.options.response == Response::Creep { -1.0 } else { 1.0 };
    let values: Vec<f64> = times.iter().map(|t| sign * falling(t)).collect();
    let plain = LawOptions {
        response: requested.options.response,
        ..LawOptions::default()
    };
    Ok(fit_law(&Samples::new(&times, &values), requested.law, &plain).map_err(unfitted)?.parameters)
}

/// A row a curve; parameters that a fit does not have are missing.
fn table(law: &str, parameters: &[Parameter], fits: &[Fitted]) -> PyResult<Table> {
    let good = || fits.iter().map(|fit| fit.as_ref().ok());
    let floats = |pick: &dyn Fn(&Row) -> Option<f64>| Column::column(good().map(|row| pick(row?)));
    let mut columns = vec![
        ("curve".to_owned(), Column::column(0..fits.len())),
        ("law".to_owned(), Column::column(fits.iter().map(|_| law))),
    ];
    for (index, parameter) in parameters.iter().enumerate() {
        let name = parameter.name.to_string();
        columns.push((name.clone(), floats(&|row| Some(row.estimates[index]?.value))));
        columns.push((format!("{name}_standard_error"), floats(&|row| row.estimates[index]?.standard_error)));
        columns.push((format!("{name}_low"), floats(&|row| Some(row.estimates[index]?.interval?.0))));
        columns.push((format!("{name}_high"), floats(&|row| Some(row.estimates[index]?.interval?.1))));
    }
    columns.push(("rmse".to_owned(), floats(&|row| Some(row.rmse))));
    columns.push(("residual_correlation".to_owned(), floats(&|row| Some(row.residual_correlation))));
    columns.push(("noise".to_owned(), Column::column(good().map(|row| Some(row?.noise.as_str())))));
    columns.push(("effective_samples".to_owned(), floats(&|row| Some(row.effective_samples))));
    columns.push(("interval_method".to_owned(), Column::column(good().map(|row| Some(row?.interval_method)))));
    columns.push(("samples".to_owned(), Column::column(good().map(|row| Some(row?.samples)))));
    columns.push(("termination".to_owned(), Column::column(good().map(|row| Some(word(row?.termination))))));
    columns.push(("error".to_owned(), Column::column(fits.iter().map(|fit| fit.as_ref().err().cloned()))));
    Table::of(columns.iter().map(|(name, values)| (name.as_str(), Arc::clone(values))).collect())
}
