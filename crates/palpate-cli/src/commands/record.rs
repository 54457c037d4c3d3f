//! Reading a record and its description, for the commands that take one.

use std::path::Path;

use palpate_files::description::{TestDescription, read_test};
use palpate_files::record_file::{RecordFile, read_record};

use crate::failure::Failure;
use crate::progress::Reading;

/// The test description, or the one of which nothing is said.
pub(super) fn description(path: Option<&Path>) -> Result<Option<TestDescription>, Failure> {
    let read = |path| {
        read_test(path).map_err(|error| {
            let hint = error.hint();
            Failure::new(error, hint)
        })
    };
    path.map(read).transpose()
}

/// The record of a file, with progress.
pub(super) fn record(path: &Path, test: Option<&TestDescription>) -> Result<RecordFile, Failure> {
    let name = path
        .file_name()
        .map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
    let mut reading = Reading::new(name);
    read_record(path, test, &mut |done, total| reading.update(done, total)).map_err(|error| {
        let hint = error.hint();
        Failure::new(error, hint)
    })
}
