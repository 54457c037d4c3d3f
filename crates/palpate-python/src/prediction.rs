//! What a calibrated body does, with intervals.

use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array};
use numpy::PyArray1;
use palpate::calibrate::Prediction as Predicted;
use palpate_report::study::{prediction_figure, write_prediction};
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::errors::{ModelError, PalpateError, refused_plainly, warn};
use crate::html::framed;
use crate::simulate::Trajectory;
use crate::table::Table;
use crate::work::Made;

/// What a calibrated body does over time, with two intervals of the force: of its mean (what the calibration leaves open), and of one
/// reading (noise besides). Arrays of one length, and a table for polars, pandas and pyarrow; a figure in a notebook.
///
/// Made by `Material.predict`.
#[pyclass(name = "Prediction", module = "palpate", frozen, eq)]
#[derive(PartialEq)]
pub(crate) struct Prediction {
    predicted: Predicted,
}

impl Prediction {
    /// Warns of every question beyond the test.
    pub(crate) fn of(py: Python<'_>, predicted: Predicted) -> PyResult<Self> {
        for beyond in &predicted.extrapolations {
            warn(py, &format!("beyond the test: {beyond}"))?;
        }
        Ok(Self { predicted })
    }

    /// One that has been warned of.
    pub(crate) fn kept(predicted: Predicted) -> Self {
        Self { predicted }
    }

    /// Lower and upper ends of an interval at every sample.
    fn ends(&self, of: fn(&Predicted, usize) -> (f64, f64)) -> (Vec<f64>, Vec<f64>) {
        (0..self.predicted.trajectory.len()).map(|index| of(&self.predicted, index)).unzip()
    }

    /// The columns of the file of ``palpate predict``, but for the noise, which is one number.
    fn columns(&self) -> [(&'static str, Vec<f64>); 10] {
        let course = &self.predicted.trajectory;
        let (near, far) = self.ends(Predicted::displacement_interval);
        let (low, high) = self.ends(Predicted::force_interval);
        let (reading_low, reading_high) = self.ends(Predicted::reading_interval);
        [
            ("time_s", course.time.clone()),
            ("displacement_m", course.displacement.clone()),
            ("displacement_low_m", near),
            ("displacement_high_m", far),
            ("force_n", course.force.clone()),
            ("force_low_n", low),
            ("force_high_n", high),
            ("reading_low_n", reading_low),
            ("reading_high_n", reading_high),
            ("force_error_n", self.predicted.force_deviation.clone()),
        ]
    }
}

#[pymethods]
impl Prediction {
    /// Time, s.
    #[getter]
    fn time_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.predicted.trajectory.time)
    }

    /// Displacement of the jaw, m.
    #[getter]
    fn displacement_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.predicted.trajectory.displacement)
    }

    /// Lower end of the interval of the displacement, m: the displacement itself where that is asked for.
    #[getter]
    fn displacement_low_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.ends(Predicted::displacement_interval).0)
    }

    /// Its upper end, m.
    #[getter]
    fn displacement_high_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.ends(Predicted::displacement_interval).1)
    }

    /// Contact force with the best numbers, N.
    #[getter]
    fn force_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.predicted.trajectory.force)
    }

    /// Lower end of the interval of the mean force, N: what the numbers leave open.
    #[getter]
    fn force_low_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.ends(Predicted::force_interval).0)
    }

    /// Its upper end, N.
    #[getter]
    fn force_high_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.ends(Predicted::force_interval).1)
    }

    /// Lower end of the interval of one reading of the force, N: numbers and noise.
    #[getter]
    fn reading_low_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.ends(Predicted::reading_interval).0)
    }

    /// Its upper end, N.
    #[getter]
    fn reading_high_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.ends(Predicted::reading_interval).1)
    }

    /// Standard error of the mean force by what the calibration leaves open, N.
    #[getter]
    fn force_error_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.predicted.force_deviation)
    }

    /// Standard deviation of the noise of one reading, N.
    #[getter]
    fn noise_n(&self) -> f64 {
        self.predicted.noise
    }

    /// Coverage of the intervals.
    #[getter]
    fn confidence(&self) -> f64 {
        self.predicted.confidence
    }

    /// What was asked beyond the test, a sentence each.
    #[getter]
    fn extrapolations(&self) -> Vec<String> {
        self.predicted.extrapolations.iter().map(ToString::to_string).collect()
    }

    /// The course with the best numbers, with strains and contacts lost and regained.
    #[getter]
    fn trajectory(&self) -> Trajectory {
        Trajectory {
            series: self.predicted.trajectory.clone(),
        }
    }

    fn __len__(&self) -> usize {
        self.predicted.trajectory.len()
    }

    /// All series as the CSV that ``palpate predict`` prints.
    fn to_csv(&self) -> PyResult<String> {
        let mut out = Vec::new();
        write_prediction(&mut out, &self.predicted)?;
        Ok(String::from_utf8(out)?)
    }

    /// All series as a table.
    fn to_arrow(&self) -> PyResult<Table> {
        let column = |(name, values)| -> (&str, ArrayRef) { (name, Arc::new(Float64Array::from(values))) };
        Table::of(self.columns().map(column).into())
    }

    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.to_arrow()?.__arrow_c_stream__(py, requested_schema)
    }

    #[classmethod]
    fn _from_json(_class: &Bound<'_, PyType>, json: &str) -> PyResult<Self> {
        let predicted = serde_json::from_str(json).map_err(refused_plainly::<ModelError>)?;
        Ok(Self { predicted })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        let json = serde_json::to_string(&self.predicted).map_err(refused_plainly::<ModelError>)?;
        Ok((py.get_type::<Self>().getattr("_from_json")?, (json,)))
    }

    fn __repr__(&self) -> String {
        let (samples, beyond) = (self.predicted.trajectory.len(), self.predicted.extrapolations.len());
        format!("<palpate.Prediction of {samples} samples, {beyond} extrapolations>")
    }

    /// Force with its bands over time, for notebooks.
    fn _repr_html_(&self) -> PyResult<String> {
        let figure = prediction_figure(&self.predicted, "prediction", "What the body does, by its calibrated law.");
        Ok(framed(&figure.to_svg().map_err(refused_plainly::<PalpateError>)?))
    }
}
