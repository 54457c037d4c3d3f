//! Records read from files.

use std::path::PathBuf;

use palpate_jobs::input::{Described, Measurement, NamedFile, OpenedFile};
use pyo3::prelude::*;

use crate::files::{Given, described_with, record_file};
use crate::records::record::Record;
use crate::work::job;

/// Read the record in a file of any format that is known, found out by its content.
///
/// Parameters
/// ----------
/// path
///     Delimited text, workbook, Parquet, Arrow, AFM force curve, robot's log and more; packed by gzip or zip or not. A path; or the bytes
///     of a file; or an object with them: an open file, ``io.BytesIO``, a member of a zip archive, an upload, an ``OpenFile`` of fsspec,
///     which is read from where it stands and not closed.
/// name
///     What results and messages call bytes; else the name that the object has.
/// test
///     Test description that says what the file cannot know: path of a TOML file, or a mapping with its tables.
/// part
///     The one test of a file that holds several: its name (a sheet, a curve, a ``test_id``), or its number from 1.
/// columns
///     Columns with their units, before what ``test`` says of them: "force=Kraft:N,displacement=Weg:mm,time=Zeit:s", or a mapping
///     ``{"force": "Kraft:N", ...}``. A minus before a unit turns the sign; "deflection=2:nm:0.04 N/m" names the deflection and
///     the spring constant of a cantilever, whose product is the force.
/// then
///     A second file in which the test goes on, such as the hold after a ramp. A clock that restarts there continues one sample
///     interval after the first file; times that already follow stay as they are.
///
/// Returns
/// -------
/// Record
///     Time, force and displacement in SI, loading positive.
///
/// Raises
/// ------
/// RecordError
///     The file holds no record, or it is not clear which column holds what: the message ends in the lines of a
///     description that would clear it up.
/// OptionError
///     The description is wrong.
/// OSError
///     The operating system does not hand the file out.
#[pyfunction]
#[pyo3(signature = (path, *, name=None, test=None, part=None, columns=None, then=None))]
pub(crate) fn read(
    py: Python<'_>,
    path: &Bound<'_, PyAny>,
    name: Option<&str>,
    test: Given<'_, '_>,
    part: Given<'_, '_>,
    columns: Given<'_, '_>,
    then: Option<PathBuf>,
) -> PyResult<Record> {
    let described = described_with(test, part, columns)?.with_then(then);
    Ok(read_parts(py, record_file(path, name)?, &described, true)?.remove(0))
}

/// Read all tests in a file: the sheets of a workbook, the curves of a map, the ``test_id`` of a table, the files of a zip archive.
///
/// Parameters
/// ----------
/// path, name, test, columns
///     As for `read`.
///
/// Returns
/// -------
/// list of Record
///     In the order of the file, each with the name of its test in ``title``.
///
/// Raises
/// ------
/// RecordError, OptionError, OSError
///     As for `read`, for the first test that makes no record.
#[pyfunction]
#[pyo3(signature = (path, *, name=None, test=None, columns=None))]
pub(crate) fn read_all(
    py: Python<'_>,
    path: &Bound<'_, PyAny>,
    name: Option<&str>,
    test: Given<'_, '_>,
    columns: Given<'_, '_>,
) -> PyResult<Vec<Record>> {
    read_parts(py, record_file(path, name)?, &described_with(test, None, columns)?, false)
}

/// The records in a file, `only` one of them or all.
fn read_parts(py: Python<'_>, file: NamedFile, described: &Described, only: bool) -> PyResult<Vec<Record>> {
    let stated = described.clone();
    let read = job(py, move |watch| {
        let opened = OpenedFile::named(&file, &stated)?;
        if only {
            opened.only()?;
        }
        let parts = opened.tests.parts.iter();
        parts.map(|part| opened.measurement(*part, watch)).collect::<Result<Vec<_>, _>>()
    })?;
    let record = |Measurement { record, input, .. }| Record::new(record, input, described.clone());
    Ok(read.into_iter().map(record).collect())
}
