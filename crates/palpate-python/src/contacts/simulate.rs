//! A simulated protocol.

use std::path::{Path, PathBuf};

use numpy::PyArray1;
use palpate::simulate::{ContactEvent, Trajectory as Simulated, simulate_watched};
use palpate_files::description::{parse_protocol, read_protocol};
use palpate_report::result::word;
use palpate_report::study::write_trajectory;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::errors::{ModelError, of_mapping, refused_plainly, undescribed};
use crate::report_files::csv_locale as readers;
use crate::shown::shown;
use crate::table::{Column, Table};
use crate::work::{Heard, Long, at_length};

/// A simulated contact over time, in SI, compression positive: arrays of one length, and a table for polars, pandas and pyarrow.
#[pyclass(name = "Trajectory", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct Trajectory {
    pub(crate) series: Simulated,
}

/// Simulates a protocol in a file, or in a text.
#[pyfunction]
pub(crate) fn simulate(py: Python<'_>, path: Option<PathBuf>, text: Option<String>) -> PyResult<Trajectory> {
    let run = move |mut heard: Heard| {
        let protocol = match path {
            Some(path) => read_protocol(&path),
            None => parse_protocol(&text.unwrap_or_default(), Path::new("protocol")).map_err(of_mapping),
        };
        let protocol = protocol.map_err(undescribed)?;
        let series = simulate_watched(protocol.drive(), &protocol.contact, &protocol.sampling, &mut heard);
        Ok(Trajectory {
            series: series.map_err(refused_plainly::<ModelError>)?,
        })
    };
    at_length(py, run)?
}

fn reported(event: &ContactEvent) -> (String, f64, f64) {
    (word(event.kind), event.time, event.contact_displacement)
}

shown! {
    Trajectory: self
    arrays {
        /// Time, s.
        time_s: self.series.time.clone(),
        /// Displacement of the jaw, m.
        displacement_m: self.series.displacement.clone(),
        /// Displacement of the surface of the body at one contact, m.
        contact_displacement_m: self.series.contact_displacement.clone(),
        /// Contact force, N.
        force_n: self.series.force.clone(),
        /// Strain of the contact layer.
        strain: self.series.strain.clone(),
        /// Strain that the contact layer tends to.
        equilibrium_strain: self.series.equilibrium_strain.clone(),
        /// Strain less the equilibrium strain.
        excess_strain: self.series.excess_strain.clone(),
        /// Strain rate of the contact layer, 1/s.
        strain_rate_per_s: self.series.strain_rate.clone(),
    }
    values {
        /// Whether the jaw touches the body.
        in_contact<'py>(py): Bound<'py, PyArray1<bool>> = PyArray1::from_slice(py, &self.series.in_contact),
        /// Contacts lost and regained: ("lost" or "regained", time in s, displacement of the surface in m).
        events: Vec<(String, f64, f64)> = self.series.events.iter().map(reported).collect(),
    }

    fn __len__(&self) -> usize {
        self.series.len()
    }

    /// All series as the CSV that ``palpate simulate`` prints, for readers of this language as in `Analysis.report`.
    #[pyo3(signature = (*, csv_locale=None))]
    fn to_csv(&self, py: Python<'_>, csv_locale: Option<&str>) -> PyResult<String> {
        let locale = readers(csv_locale)?;
        Long::text(py, |out| write_trajectory(out, &self.series, locale))
    }

    /// All series as a table.
    fn to_arrow(&self) -> PyResult<Table> {
        let mut columns = self.columns();
        columns.push(("in_contact", Column::column(self.series.in_contact.iter().copied())));
        Table::of(columns)
    }

    fn __repr__(&self) -> String {
        let (samples, events) = (self.series.len(), self.series.events.len());
        format!("<palpate.Trajectory of {samples} samples, {events} contacts lost or regained>")
    }
}
