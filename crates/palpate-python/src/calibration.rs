//! One set of numbers for a whole record.

use numpy::PyArray1;
use palpate_jobs::input::Measurement;
use palpate_jobs::{Calibrate, Results};
use palpate_report::document::{CalibratedLawDocument, CalibrationDocument};
use palpate_report::study::calibration_page;
use pyo3::prelude::*;
use pyo3::types::PyType;
use serde::{Deserialize, Serialize};

use crate::errors::{PalpateError, refused_plainly};
use crate::html::framed;
use crate::material::Material;
use crate::table::{Table, columns};
use crate::work::{Made, job, plain, printed, unpickled};

/// One set of numbers for a whole record, ramps and holds alike: a material, what its law leaves over, and its rivals.
///
/// Made by `Record.calibrate`. ``print(calibration)`` shows what ``palpate calibrate`` does; series are tables for polars, pandas and
/// pyarrow, and a notebook shows tables and figure.
#[pyclass(name = "Calibration", module = "palpate", frozen, eq)]
#[derive(PartialEq)]
pub(crate) struct Calibration {
    kept: Kept,
    material: Material,
}

/// What a calibration is made of again.
#[derive(Clone, PartialEq, Serialize, Deserialize)]
struct Kept {
    document: CalibrationDocument,
    text: String,
    page: String,
    sentence: Option<String>,
    series: Vec<Sample>,
}

/// Measured and simulated force; the first samples were fitted, the rest was foretold.
#[derive(Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Sample {
    time: f64,
    displacement: f64,
    force: f64,
    simulated: f64,
}

impl Calibration {
    /// Calibrates laws on a record, and warns where the one that is asked for leaves a number open.
    pub(crate) fn of(py: Python<'_>, measured: Measurement, options: Calibrate) -> PyResult<Self> {
        let done = job(py, move |watch| options.run(measured, watch))?.result;
        let (record, file) = (&done.record, done.material());
        let Some((chosen, file)) = record.chosen().zip(file) else {
            return Err(refused_plainly::<PalpateError>("no law was calibrated"));
        };
        let (times, data) = (record.data.times(), &record.data);
        let sample = |(index, time): (usize, &f64)| Sample {
            time: *time,
            displacement: data.motion().displacement_at(*time),
            force: data.forces()[index],
            simulated: chosen.simulated[index],
        };
        let kept = Kept {
            document: done.document(),
            text: done.text(),
            page: calibration_page(record).map_err(refused_plainly::<PalpateError>)?.to_html(),
            sentence: record.sentence(),
            series: times.iter().enumerate().map(sample).collect(),
        };
        Ok(Self {
            kept,
            material: Material::of(py, file)?,
        })
    }

    /// The law that was asked for.
    fn asked(&self) -> &CalibratedLawDocument {
        // There is one: without it there is no calibration.
        &self.kept.document.laws[0]
    }

    fn series<'py>(&self, py: Python<'py>, of: impl Fn(&Sample) -> f64) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_iter(py, self.kept.series.iter().map(of))
    }
}

#[pymethods]
impl Calibration {
    /// The body with the numbers of the law that was asked for.
    #[getter]
    fn material(&self) -> Material {
        self.material.clone()
    }

    /// The laws, a row each, the one that was asked for first: ``parameters`` searched, root mean square residual ``rmse_n``, the same as a
    /// share of the largest force (``relative``), BIC less the lowest (``delta_bic``), with ``fit_until_s`` the errors of what was
    /// foretold, ``termination``, and why there is no calibration (``error``).
    #[getter]
    fn laws(&self) -> PyResult<Table> {
        let laws = &self.kept.document.laws;
        let mut columns = columns!(laws, law => law, parameters, rmse_n, relative, delta_bic);
        if laws.iter().any(|law| law.foretold.is_some()) {
            columns.extend(columns!(laws, law =>
                foretold_rmse_n = law.foretold.as_ref().map(|foretold| foretold.rmse_n),
                foretold_relative = law.foretold.as_ref().map(|foretold| foretold.relative),
                foretold_samples = law.foretold.as_ref().map(|foretold| foretold.samples)
            ));
        }
        columns.extend(columns!(laws, law => termination, error));
        Table::of(columns)
    }

    /// Which law foretells best, or has the lowest BIC, in a sentence; None without rivals.
    #[getter]
    fn sentence(&self) -> Option<&str> {
        self.kept.sentence.as_deref()
    }

    /// The numbers of the law that was asked for, by name and unit as in `to_dict`: ``value``, ``standard_error``, ``low`` and ``high`` of
    /// the interval and, where profiles were asked for, ``profile_low`` and ``profile_high``, NaN where the record leaves them open.
    #[getter]
    fn numbers(&self) -> PyResult<Table> {
        let numbers = &self.asked().numbers;
        let mut columns = columns!(numbers, number =>
            name, value = number.estimate.value, standard_error = number.estimate.standard_error,
            low = number.estimate.interval.map(|interval| interval[0]),
            high = number.estimate.interval.map(|interval| interval[1])
        );
        if numbers.iter().any(|number| number.profile.is_some()) {
            columns.extend(columns!(numbers, number =>
                profile_low = number.profile.as_ref().and_then(|profile| profile.low),
                profile_high = number.profile.as_ref().and_then(|profile| profile.high)
            ));
        }
        Table::of(columns)
    }

    /// What the numbers alone do not tell, in sentences.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.kept.document.remarks.clone()
    }

    /// Why the search ended: "converged", or what kept it from that.
    #[getter]
    fn termination(&self) -> &str {
        self.asked().termination.as_deref().unwrap_or_default()
    }

    /// Whether it ended at an optimum inside the range that was searched.
    #[getter]
    fn is_good(&self) -> bool {
        self.termination() == "converged"
    }

    /// Root mean square residual over the fitted samples, N.
    #[getter]
    fn rmse_n(&self) -> f64 {
        self.asked().rmse_n.unwrap_or(f64::NAN)
    }

    /// How many samples, from the first on, were fitted; the rest was foretold.
    #[getter]
    fn fitted(&self) -> usize {
        self.kept.document.fitted
    }

    /// Time of every sample, s, on the clock of the record.
    #[getter]
    fn time_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.series(py, |sample| sample.time)
    }

    /// Displacement of the jaw since first touch, m, as it was simulated.
    #[getter]
    fn displacement_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.series(py, |sample| sample.displacement)
    }

    /// Measured force, N.
    #[getter]
    fn force_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.series(py, |sample| sample.force)
    }

    /// Force by the law, N.
    #[getter]
    fn simulated_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.series(py, |sample| sample.simulated)
    }

    /// Measured less simulated force, N.
    #[getter]
    fn residual_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.series(py, |sample| sample.force - sample.simulated)
    }

    fn __len__(&self) -> usize {
        self.kept.series.len()
    }

    /// Columns ``time_s``, ``displacement_m``, ``force_n``, ``simulated_n``, ``residual_n`` and ``is_fitted`` as a table.
    fn to_arrow(&self) -> PyResult<Table> {
        let rows: Vec<_> = self.kept.series.iter().enumerate().collect();
        Table::of(columns!(rows, row =>
            time_s = row.1.time, displacement_m = row.1.displacement, force_n = row.1.force,
            simulated_n = row.1.simulated, residual_n = row.1.force - row.1.simulated,
            is_fitted = row.0 < self.fitted()
        ))
    }

    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.to_arrow()?.__arrow_c_stream__(py, requested_schema)
    }

    /// The document that ``palpate calibrate --format json`` prints, as plain objects.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.kept.document)
    }

    /// The same as text, as the command prints it.
    fn to_json(&self) -> PyResult<String> {
        printed(&self.kept.document)
    }

    /// Tables of the laws and of the numbers, and remarks, as text.
    fn report(&self) -> &str {
        &self.kept.text
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str, material: &str) -> PyResult<Self> {
        Ok(Self {
            kept: unpickled(json)?,
            material: Material::parsed(material)?,
        })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String, String)>> {
        let json = serde_json::to_string(&self.kept).map_err(refused_plainly::<PalpateError>)?;
        Ok((py.get_type::<Self>().getattr("_from_json")?, (json, self.material.to_toml())))
    }

    fn __str__(&self) -> &str {
        &self.kept.text
    }

    fn __repr__(&self) -> String {
        format!(
            "<palpate.Calibration of {:?}: {}; {}>",
            self.kept.document.input.title,
            self.material.law(),
            self.termination()
        )
    }

    /// Tables and figure, for notebooks.
    fn _repr_html_(&self) -> String {
        framed(&self.kept.page)
    }
}
