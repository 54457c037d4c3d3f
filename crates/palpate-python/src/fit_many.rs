//! Thousands of holds in one call.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use arrow_array::cast::AsArray;
use arrow_array::types::Float64Type;
use arrow_array::{Array, ArrayRef, Float64Array, Int64Array, StringArray};
use arrow_buffer::ScalarBuffer;
use arrow_schema::DataType;
use numpy::{PyArray1, PyArrayMethods};
use palpate::identify::{FitError as Refused, LawFit, NumberUnit};
use pyo3::prelude::*;
use pyo3_arrow::PyChunkedArray;
use pyo3_arrow::input::AnyArray;
use rayon::prelude::*;

use crate::errors::{FitError, refused_plainly};
use crate::fit::{Asked, Keywords, deviations, ending, fitted};
use crate::table::Table;
use crate::work::{Progress, at_length_told};

/// Curves of any lengths. Columns of Arrow never change, and are not copied; arrays of NumPy may change, and are.
struct Ragged {
    curves: Vec<ScalarBuffer<f64>>,
}

impl Ragged {
    fn len(&self) -> usize {
        self.curves.len()
    }

    fn curve(&self, index: usize) -> &[f64] {
        &self.curves[index]
    }
}

/// Lists of numbers from Arrow, or from anything that `palpate._arrays.as_ragged` understands.
fn ragged(curves: &Bound<'_, PyAny>, name: &str) -> PyResult<Ragged> {
    if curves.hasattr("__arrow_c_stream__")? || curves.hasattr("__arrow_c_array__")? {
        return of_arrow(&curves.extract::<AnyArray>()?.into_chunked_array()?, name);
    }
    let found = curves.py().import("palpate._arrays")?.call_method1("as_ragged", (curves, name))?;
    let (values, offsets): (Bound<'_, PyArray1<f64>>, Bound<'_, PyArray1<i64>>) = found.extract()?;
    let offsets: Vec<usize> = offsets.try_readonly()?.as_array().iter().map(|offset| *offset as usize).collect();
    let values = values.try_readonly()?;
    let values = values.as_slice()?;
    let (mut ragged, mut copied) = (
        Ragged {
            curves: Vec::with_capacity(offsets.len()),
        },
        0,
    );
    for ends in offsets.windows(2) {
        ragged.curves.push(ScalarBuffer::from(values[ends[0]..ends[1]].to_vec()));
        copied += ends[1] - ends[0];
        if copied > AT_ONCE {
            // A gigabyte takes a second to copy: Ctrl-C is heard in between.
            curves.py().check_signals()?;
            copied = 0;
        }
    }
    Ok(ragged)
}

/// Numbers that are copied in some milliseconds.
const AT_ONCE: usize = 4 << 20;

fn of_arrow(column: &PyChunkedArray, name: &str) -> PyResult<Ragged> {
    let mut ragged = Ragged { curves: Vec::new() };
    let wrong = |kind: &DataType| {
        refused_plainly::<FitError>(format!("{name}: expected a column of lists of doubles, found one of {kind}"))
    };
    let mut push = |row: Option<ArrayRef>| -> PyResult<()> {
        let row = row.ok_or_else(|| refused_plainly::<FitError>(format!("{name}: a list is missing")))?;
        let numbers = row.as_primitive_opt::<Float64Type>().ok_or_else(|| wrong(row.data_type()))?;
        if numbers.null_count() > 0 {
            let index = ragged.len();
            return Err(refused_plainly::<FitError>(format!("{name}, curve {index}: a number is missing")));
        }
        ragged.curves.push(numbers.values().clone());
        Ok(())
    };
    for chunk in column.chunks() {
        match chunk.data_type() {
            DataType::List(_) => chunk.as_list::<i32>().iter().try_for_each(&mut push)?,
            DataType::LargeList(_) => chunk.as_list::<i64>().iter().try_for_each(&mut push)?,
            DataType::FixedSizeList(..) => chunk.as_fixed_size_list().iter().try_for_each(&mut push)?,
            DataType::Float64 => push(Some(Arc::clone(chunk)))?,
            other => return Err(wrong(other)),
        }
    }
    Ok(ragged)
}

/// Where the times of a curve are: one list may stand for all.
fn shared(times: &Ragged, curves: usize, name: &str) -> PyResult<bool> {
    match times.len() {
        count if count == curves => Ok(false),
        1 => Ok(true),
        count => {
            let message = format!("{name}: expected one list for all curves or one each, {curves}, found {count}");
            Err(refused_plainly::<FitError>(message))
        }
    }
}

type Fitted = Option<Result<LawFit, Refused>>;

#[pyfunction]
pub(crate) fn fit_many(
    py: Python<'_>,
    time_s: &Bound<'_, PyAny>,
    signal: &Bound<'_, PyAny>,
    weights: Option<&Bound<'_, PyAny>>,
    keywords: Keywords,
    progress: Option<Py<PyAny>>,
) -> PyResult<Table> {
    let (times, values) = (ragged(time_s, "time_s")?, ragged(signal, "signal")?);
    let curves = values.len();
    let one_time = shared(&times, curves, "time_s")?;
    let weights = weights.map(|weights| ragged(weights, "weights")).transpose()?;
    let weights = match weights {
        Some(Ragged { curves: weights }) => {
            let of_one = |weights: ScalarBuffer<f64>| deviations(weights.to_vec()).map(ScalarBuffer::from);
            let found = Ragged {
                curves: weights.into_iter().map(of_one).collect::<PyResult<_>>()?,
            };
            Some((shared(&found, curves, "weights")?, found))
        }
        None => None,
    };
    let asked = keywords.asked()?;
    let stopped = Arc::new(AtomicBool::new(false));
    let stop = Arc::clone(&stopped);
    let progress = Progress::of(progress);
    let told = progress.clone();
    let work = move || -> (Vec<Fitted>, Asked) {
        let one = |index: usize| {
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            let time = times.curve(if one_time { 0 } else { index });
            let deviations = weights.as_ref().map(|(one, found)| found.curve(if *one { 0 } else { index }));
            let fit = fitted(time, values.curve(index), deviations, &asked);
            told.step();
            Some(fit)
        };
        let fits = (0..curves).into_par_iter().map(one).collect();
        (fits, asked)
    };
    let (fits, _) = at_length_told(py, &progress, work).inspect_err(|_| stopped.store(true, Ordering::Relaxed))?;
    table(&fits)
}

fn suffix(unit: NumberUnit) -> &'static str {
    match unit {
        NumberUnit::Second => "_s",
        NumberUnit::PerSecond => "_per_s",
        _ => "",
    }
}

/// A row a curve; numbers that a fit does not have are missing.
fn table(fits: &[Fitted]) -> PyResult<Table> {
    let good = || fits.iter().map(|fit| fit.as_ref().and_then(|fit| fit.as_ref().ok()));
    let floats = |pick: &dyn Fn(&LawFit) -> Option<f64>| -> ArrayRef {
        Arc::new(good().map(|fit| fit.and_then(pick)).collect::<Float64Array>())
    };
    let mut columns: Vec<(String, ArrayRef)> = vec![
        ("curve".to_owned(), Arc::new((0..fits.len() as i64).collect::<Int64Array>())),
        (
            "law".to_owned(),
            Arc::new(good().map(|fit| fit.map(|fit| fit.law.to_string())).collect::<StringArray>()),
        ),
    ];
    let numbers = good().flatten().next().map_or(&[][..], |fit| &fit.numbers);
    for number in numbers {
        let (name, suffix) = (&number.name, suffix(number.unit));
        columns.push((format!("{name}{suffix}"), floats(&|fit| fit.value(name))));
        let error = |fit: &LawFit| fit.estimate(name)?.standard_error;
        columns.push((format!("{name}_standard_error{suffix}"), floats(&error)));
        columns.push((format!("{name}_low{suffix}"), floats(&|fit| Some(fit.estimate(name)?.interval?.0))));
        columns.push((format!("{name}_high{suffix}"), floats(&|fit| Some(fit.estimate(name)?.interval?.1))));
    }
    columns.push(("rmse".to_owned(), floats(&|fit| Some(fit.rmse))));
    columns.push(("residual_correlation".to_owned(), floats(&|fit| Some(fit.residual_correlation))));
    let samples = good().map(|fit| fit.map(|fit| fit.samples as i64)).collect::<Int64Array>();
    columns.push(("samples".to_owned(), Arc::new(samples)));
    let ended = good().map(|fit| fit.map(|fit| ending(fit.termination))).collect::<StringArray>();
    columns.push(("termination".to_owned(), Arc::new(ended)));
    let errors = fits.iter().map(|fit| fit.as_ref()?.as_ref().err().map(ToString::to_string));
    columns.push(("error".to_owned(), Arc::new(errors.collect::<StringArray>())));
    Table::of(columns.iter().map(|(name, values)| (name.as_str(), Arc::clone(values))).collect())
}
