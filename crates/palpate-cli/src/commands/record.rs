//! Reading records and their description, for the commands that take some.

use std::path::Path;

use palpate_files::description::{TestDescription, read_test};
use palpate_files::open::Contents;
use palpate_files::record::{ReadError, RecordFile, Tests, read_part, tests};
use palpate_files::table::SkippedPart;

use palpate_report::result::Input;

use crate::failure::Failure;
use crate::files::sha256;
use crate::progress::Reading;
use crate::terminal::note;

/// The test description, if there is one, with the part of the file that was chosen on the command line.
pub(super) fn description(path: Option<&Path>, part: Option<&str>) -> Result<Option<TestDescription>, Failure> {
    let read = |path| {
        read_test(path).map_err(|error| {
            let hint = error.hint();
            Failure::new(error, hint)
        })
    };
    let mut test = path.map(read).transpose()?;
    if let Some(part) = part {
        test.get_or_insert_default().reading.part = Some(part.to_owned());
    }
    Ok(test)
}

/// A file of records that was looked into.
pub(super) struct Opened<'t> {
    contents: Contents,
    tests: Tests,
    test: Option<&'t TestDescription>,
}

impl<'t> Opened<'t> {
    /// Looks into the file at `path`.
    pub(super) fn open(path: &Path, test: Option<&'t TestDescription>) -> Result<Self, Failure> {
        let usual = TestDescription::default();
        let said = test.unwrap_or(&usual);
        let contents = Contents::open(path, &said.reading).map_err(ReadError::File).map_err(refused)?;
        let tests = tests(&contents, said).map_err(refused)?;
        Ok(Self { contents, tests, test })
    }

    /// What is in the file.
    pub(super) fn contents(&self) -> &Contents {
        &self.contents
    }

    /// Indices of its tests among its parts.
    pub(super) fn parts(&self) -> &[usize] {
        &self.tests.parts
    }

    /// What is said about all tests in the file.
    pub(super) fn test(&self) -> Option<&'t TestDescription> {
        self.test
    }

    /// What was passed over.
    pub(super) fn skipped(&self) -> &[SkippedPart] {
        &self.tests.skipped
    }

    /// What to call a part, where the file holds several tests.
    pub(super) fn name(&self, part: usize) -> Option<&str> {
        let several = self.contents.parts().len() > 1;
        self.contents.parts()[part].name.as_deref().filter(|_| several)
    }

    /// The record in a part.
    pub(super) fn read_quietly(&self, part: usize) -> Result<RecordFile, Failure> {
        read_part(&self.contents, part, self.test, &mut |_, _| {}).map_err(refused)
    }

    /// The record in a part, with progress.
    pub(super) fn read(&self, part: usize) -> Result<RecordFile, Failure> {
        let path = self.contents.path();
        let name = path
            .file_name()
            .map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned());
        let mut reading = Reading::new(name);
        let file = read_part(&self.contents, part, self.test, &mut |done, total| reading.update(done, total));
        drop(reading);
        let file = file.map_err(refused)?;
        if file.averaged > 1 {
            let kept = file.rows.div_ceil(file.averaged);
            note(&format!(
                "{}: {} rows are more than are kept; every {} successive ones became their mean ({kept} samples)",
                path.display(),
                file.rows,
                file.averaged
            ));
        }
        Ok(file)
    }
}

/// Names what a file holds besides tests.
pub(super) fn tell_skipped(opened: &Opened<'_>) {
    for part in opened.skipped() {
        note(&format!("{}: skipped {} ({})", opened.contents().path().display(), part.name, part.reason));
    }
}

/// A record by its file, and its part where the file holds several.
pub(super) fn called(path: &Path, part: Option<&str>) -> String {
    part.map_or_else(|| path.display().to_string(), |part| format!("{}, {part}", path.display()))
}

/// The one test of a file.
pub(super) fn one_part(opened: &Opened<'_>) -> Result<usize, Failure> {
    match opened.parts() {
        [only] => Ok(*only),
        several => Err(refused(ReadError::SeveralParts {
            path: opened.contents.path().to_owned(),
            parts: several.iter().map(|part| opened.contents.parts()[*part].title().to_owned()).collect(),
        })),
    }
}

/// The one record of a file.
pub(super) fn record(path: &Path, test: Option<&TestDescription>) -> Result<RecordFile, Failure> {
    let opened = Opened::open(path, test)?;
    opened.read(one_part(&opened)?)
}

fn refused(error: ReadError) -> Failure {
    let hint = error.hint();
    Failure::new(error, hint)
}

/// What a result says of the record that it comes from.
pub(super) fn input(
    file: &RecordFile,
    part: Option<&str>,
    described_by: Option<&Path>,
    test: Option<&TestDescription>,
) -> Result<Input, Failure> {
    let path = file.path.as_path();
    let title = test
        .and_then(|test| test.about.title.clone())
        .unwrap_or_else(|| path.file_stem().unwrap_or_default().to_string_lossy().into_owned());
    Ok(Input {
        path: path.display().to_string(),
        part: file.part.name.clone(),
        sha256: sha256(path)?,
        rows: file.rows,
        rows_averaged: file.averaged,
        test: described_by.map(|test| test.display().to_string()),
        title: part.map_or_else(|| title.clone(), |part| format!("{title} · {part}")),
    })
}
