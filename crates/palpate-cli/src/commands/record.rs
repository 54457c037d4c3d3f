//! Reading a record and its description, for the commands that take one.

use std::path::Path;

use palpate_files::description::{TestDescription, read_test};
use palpate_files::record_file::{RecordFile, read_record};

use palpate_report::document::Input;

use crate::failure::Failure;
use crate::files::sha256;
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

/// What a result says of the record that it comes from.
pub(super) fn input(
    path: &Path,
    rows: usize,
    described_by: Option<&Path>,
    test: Option<&TestDescription>,
) -> Result<Input, Failure> {
    Ok(Input {
        path: path.display().to_string(),
        sha256: sha256(path)?,
        rows,
        test: described_by.map(|test| test.display().to_string()),
        title: test
            .and_then(|test| test.about.title.clone())
            .unwrap_or_else(|| path.file_stem().unwrap_or_default().to_string_lossy().into_owned()),
    })
}
