//! A simulated protocol.

use std::path::PathBuf;

use arrow_array::ArrayRef;
use numpy::PyArray1;
use palpate::record::Record;
use palpate::simulate::{ContactEvent, Cycle, StepWork, Trajectory as Series};
use palpate::watch::Watch;
use palpate_files::description::{parse_protocol, parse_scene};
use palpate_jobs::{DriveBy, JobError, Simulate, Simulated};
use palpate_report::result::word;
use palpate_report::study::write_trajectory;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use super::protocol::StatedProtocol;
use crate::errors::{RecordError, failed, one_of, refused};
use crate::report_files::csv_locale as readers;
use crate::shown::shown;
use crate::table::{Column, Table, columns};
use crate::work::{Heard, Long, at_length};

/// A simulated contact over time, in SI, compression positive: arrays of one length, and a table for polars, pandas and pyarrow.
#[pyclass(name = "Trajectory", module = "palpate", frozen, eq)]
#[derive(Clone, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct Trajectory {
    pub(crate) series: Series,
}

/// What a record drives a contact with: time, displacement and force.
type Driver = (Vec<f64>, Option<Vec<f64>>, Vec<f64>);

/// Simulates the protocol in a file, or in a text, or its body under what a record says.
fn simulated(
    path: Option<PathBuf>,
    text: Option<String>,
    driver: Option<Driver>,
    drive_by: DriveBy,
    watch: &mut dyn Watch,
) -> PyResult<Simulated> {
    let protocol = StatedProtocol::new(path, text)?;
    let job = Simulate {
        drive_by,
        ..Simulate::default()
    };
    let done = match driver {
        None => job.run_protocol(protocol.parsed(parse_protocol)?, &protocol.path, watch),
        Some((time, displacement, force)) => {
            let body = protocol.parsed(parse_scene)?;
            let record = Record::new(time, displacement, force);
            let record = record.map_err(|error| refused::<RecordError>(&error, Some(error.hint())))?;
            job.run_driven(body, (&record, "drive"), watch)
        }
    };
    Ok(done.map_err(failed)?.result)
}

/// Which column drives, as a keyword says it.
fn driving(name: &str) -> PyResult<DriveBy> {
    one_of("drive_by", &[("displacement", DriveBy::Displacement), ("force", DriveBy::Force)], name)
}

#[pyfunction]
pub(crate) fn simulate(
    py: Python<'_>,
    path: Option<PathBuf>,
    text: Option<String>,
    driver: Option<Driver>,
    drive_by: &str,
) -> PyResult<Trajectory> {
    let drive_by = driving(drive_by)?;
    let run = move |mut heard: Heard| simulated(path, text, driver, drive_by, &mut heard);
    Ok(Trajectory {
        series: at_length(py, run)??.trajectory,
    })
}

/// Work of the jaw over time, by step or by cycle.
#[pyfunction]
pub(crate) fn energy(
    py: Python<'_>,
    path: Option<PathBuf>,
    text: Option<String>,
    driver: Option<Driver>,
    drive_by: &str,
    by: &str,
) -> PyResult<Table> {
    type Columns = fn(&Simulated, &mut dyn Watch) -> Result<Vec<(&'static str, ArrayRef)>, JobError>;
    let kinds: [(&str, Columns); 3] = [("time", over_time), ("step", by_step), ("cycle", by_cycle)];
    let (drive_by, columns) = (driving(drive_by)?, one_of("by", &kinds, by)?);
    let run = move |mut heard: Heard| {
        let simulated = simulated(path, text, driver, drive_by, &mut heard)?;
        columns(&simulated, &mut heard).map_err(failed)
    };
    Table::of(at_length(py, run)??)
}

fn over_time(simulated: &Simulated, watch: &mut dyn Watch) -> Result<Vec<(&'static str, ArrayRef)>, JobError> {
    let energy = simulated.work(watch)?;
    let rows: Vec<usize> = (0..energy.time.len()).collect();
    let split = energy.split.as_ref();
    Ok(columns!(rows, row =>
        time_s = energy.time[*row], work_j = energy.work[*row], given_back_j = energy.given_back[*row],
        stored_j = split.map(|split| split.stored[*row]), lost_j = split.map(|split| split.lost[*row])
    ))
}

fn by_step(simulated: &Simulated, watch: &mut dyn Watch) -> Result<Vec<(&'static str, ArrayRef)>, JobError> {
    let steps: Vec<(usize, StepWork)> = (1..).zip(simulated.steps(watch)?).collect();
    Ok(columns!(steps, row =>
        step = row.0, from_s = row.1.from, until_s = row.1.until, displacement_from_m = row.1.displacement_from,
        displacement_until_m = row.1.displacement_until, work_j = row.1.work, given_back_j = row.1.given_back, lost_j = row.1.lost
    ))
}

fn by_cycle(simulated: &Simulated, watch: &mut dyn Watch) -> Result<Vec<(&'static str, ArrayRef)>, JobError> {
    let cycles: Vec<(usize, Cycle)> = (1..).zip(simulated.cycles(watch)?).collect();
    Ok(columns!(cycles, row =>
        cycle = row.0, from_s = row.1.from, until_s = row.1.until, done_j = row.1.done, given_back_j = row.1.given_back,
        lost_j = row.1.lost, share_lost = row.1.share_lost, closed = row.1.is_closed
    ))
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
