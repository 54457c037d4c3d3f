//! A simulated protocol.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use arrow_array::{ArrayRef, BooleanArray, Float64Array};
use numpy::PyArray1;
use palpate::simulate::{ContactEventKind, Trajectory as Simulated, simulate as walk};
use palpate_files::description::{parse_protocol, read_protocol};
use palpate_report::study::write_trajectory;
use pyo3::prelude::*;
use pyo3::types::PyType;

use crate::errors::{ModelError, refused_plainly, undescribed};
use crate::table::Table;
use crate::work::{Made, at_length};

/// A simulated contact over time, in SI, compression positive: arrays of one length, and a table for polars, pandas and pyarrow.
#[pyclass(name = "Trajectory", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq)]
pub(crate) struct Trajectory {
    pub(crate) series: Simulated,
}

/// Simulates a protocol in a file, or in a text.
#[pyfunction]
pub(crate) fn simulate(py: Python<'_>, path: Option<PathBuf>, text: Option<&str>) -> PyResult<Trajectory> {
    let protocol = match path {
        Some(path) => read_protocol(&path),
        None => parse_protocol(text.unwrap_or_default(), Path::new("protocol")),
    };
    let protocol = protocol.map_err(undescribed)?;
    let series = at_length(py, move |_| walk(protocol.drive(), &protocol.contact, &protocol.sampling))?;
    Ok(Trajectory {
        series: series.map_err(refused_plainly::<ModelError>)?,
    })
}

impl Trajectory {
    fn columns(&self) -> [(&'static str, &[f64]); 8] {
        let series = &self.series;
        [
            ("time_s", &series.time),
            ("displacement_m", &series.displacement),
            ("contact_displacement_m", &series.contact_displacement),
            ("force_n", &series.force),
            ("strain", &series.strain),
            ("equilibrium_strain", &series.equilibrium_strain),
            ("excess_strain", &series.excess_strain),
            ("strain_rate_per_s", &series.strain_rate),
        ]
    }
}

#[pymethods]
impl Trajectory {
    /// Time, s.
    #[getter]
    fn time_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.series.time)
    }

    /// Displacement of the jaw, m.
    #[getter]
    fn displacement_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.series.displacement)
    }

    /// Displacement of the surface of the body at one contact, m.
    #[getter]
    fn contact_displacement_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.series.contact_displacement)
    }

    /// Contact force, N.
    #[getter]
    fn force_n<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.series.force)
    }

    /// Strain of the contact layer.
    #[getter]
    fn strain<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.series.strain)
    }

    /// Strain that the contact layer tends to.
    #[getter]
    fn equilibrium_strain<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.series.equilibrium_strain)
    }

    /// Strain less the equilibrium strain.
    #[getter]
    fn excess_strain<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.series.excess_strain)
    }

    /// Strain rate of the contact layer, 1/s.
    #[getter]
    fn strain_rate_per_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.series.strain_rate)
    }

    /// Whether the jaw touches the body.
    #[getter]
    fn in_contact<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        PyArray1::from_slice(py, &self.series.in_contact)
    }

    /// Contacts lost and regained: ("lost" or "regained", time in s, displacement of the surface in m).
    #[getter]
    fn events(&self) -> Vec<(&'static str, f64, f64)> {
        let word = |kind| match kind {
            ContactEventKind::Lost => "lost",
            ContactEventKind::Regained => "regained",
        };
        let events = self.series.events.iter();
        events.map(|event| (word(event.kind), event.time, event.contact_displacement)).collect()
    }

    fn __len__(&self) -> usize {
        self.series.len()
    }

    /// All series as the CSV that ``palpate simulate`` prints.
    fn to_csv(&self) -> PyResult<String> {
        let mut out = Vec::new();
        write_trajectory(&mut out, &self.series)?;
        Ok(String::from_utf8(out)?)
    }

    /// All series as a table.
    fn to_arrow(&self) -> PyResult<Table> {
        let column = |values: &[f64]| -> ArrayRef { Arc::new(Float64Array::from(values.to_vec())) };
        let mut columns: Vec<(&str, ArrayRef)> =
            self.columns().into_iter().map(|(name, values)| (name, column(values))).collect();
        columns.push(("in_contact", Arc::new(BooleanArray::from(self.series.in_contact.clone()))));
        Table::of(columns)
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
        let series = serde_json::from_str(json).map_err(refused_plainly::<ModelError>)?;
        Ok(Self { series })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Made<'py, (String,)>> {
        let make = py.get_type::<Self>().getattr("_from_json")?;
        let json = serde_json::to_string(&self.series).map_err(refused_plainly::<ModelError>)?;
        Ok((make, (json,)))
    }

    fn __repr__(&self) -> String {
        let (samples, events) = (self.series.len(), self.series.events.len());
        format!("<palpate.Trajectory of {samples} samples, {events} contacts lost or regained>")
    }
}
