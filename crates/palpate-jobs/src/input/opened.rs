//! A file of records that was looked into.

use std::path::{Path, PathBuf};

use palpate::analysis::{AnalysisOptions, Finding};
use palpate::record::Record;
use palpate::watch::{Cancelled, Progress, Watch};
use palpate_files::open::Contents;
use palpate_files::record::{MapPosition, ReadError, RecordFile, Tests, read_part, tests};
use palpate_files::table::SkippedPart;
use palpate_report::result::Input;
use sha2::{Digest, Sha256};

use super::Described;
use super::source::{FileDigest, NamedFile, Source};
use crate::JobError;
use crate::output::hexadecimal;

/// A record as the jobs take it.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement {
    /// The record, in SI, loading positive.
    pub record: Record,
    /// What results say of where it comes from.
    pub input: Input,
    /// How its description wants it analysed.
    pub options: AnalysisOptions,
    /// What to know of its reading, a sentence each.
    pub notes: Vec<String>,
    /// Quantities whose column has a sign, each with the option that turns it.
    pub turned: Vec<(String, String)>,
}

/// A file of records that was looked into.
pub struct OpenedFile<'d> {
    /// What is in the file.
    pub contents: Contents,
    /// Its tests among its parts, and what was passed over.
    pub tests: Tests,
    /// What is stated about its tests.
    pub described: &'d Described,
    digest: FileDigest,
    /// The file in which the test goes on.
    then: Option<Box<Self>>,
}

impl<'d> OpenedFile<'d> {
    /// Looks into the file at `path`.
    ///
    /// # Errors
    /// [`JobError`] where it cannot be read, or holds no test.
    pub fn open(path: &Path, described: &'d Described) -> Result<Self, JobError> {
        Self::named(&NamedFile::Path(path.to_owned()), described)
    }

    /// Looks into a file that may lie in memory.
    ///
    /// # Errors
    /// As for [`open`](Self::open).
    pub fn named(file: &NamedFile, described: &'d Described) -> Result<Self, JobError> {
        Self::of(Source::open(file)?, described)
    }

    /// Looks into a file whose bytes are there.
    pub(crate) fn of(source: Source, described: &'d Described) -> Result<Self, JobError> {
        let next = |path: &PathBuf| Self::alone(Source::open(&NamedFile::Path(path.clone()))?, described);
        let then = described.then.as_ref().map(next).transpose()?;
        let mut opened = Self::alone(source, described)?;
        opened.then = then.map(Box::new);
        Ok(opened)
    }

    /// Looks into one file, without any in which the test goes on.
    fn alone(source: Source, described: &'d Described) -> Result<Self, JobError> {
        let stated = described.test.clone().unwrap_or_default();
        let contents = Contents::of(source.input, &stated.reading).map_err(ReadError::File)?;
        let tests = tests(&contents, &stated)?;
        Ok(Self {
            contents,
            tests,
            described,
            digest: source.digest,
            then: None,
        })
    }

    /// What the file holds besides tests, a sentence each.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let path = self.contents.input.name.display();
        let reported = |part: &SkippedPart| format!("{path}: skipped {} ({})", part.name, part.reason);
        self.tests.skipped.iter().map(reported).collect()
    }

    /// What to call a part, where the file holds several tests.
    #[must_use]
    pub fn name(&self, part: usize) -> Option<&str> {
        let several = self.contents.parts.len() > 1;
        self.contents.parts[part].name.as_deref().filter(|_| several)
    }

    /// The one test of the file.
    ///
    /// # Errors
    /// [`JobError`] where there are several, with their names.
    pub fn only(&self) -> Result<usize, JobError> {
        match &self.tests.parts[..] {
            [only] => Ok(*only),
            several => Err(JobError::from(ReadError::SeveralParts {
                path: self.contents.input.name.clone(),
                parts: several.iter().map(|part| self.contents.parts[*part].title().to_owned()).collect(),
            })),
        }
    }

    /// Reads the record in a part, with that of the file in which the test goes on; the watch hears of the bytes.
    ///
    /// # Errors
    /// [`JobError`] where it cannot be read, or the watch ends it.
    pub fn read(&self, part: usize, watch: &mut dyn Watch) -> Result<RecordFile, JobError> {
        let mut file = self.read_alone(part, watch)?;
        let Some(then) = &self.then else {
            return Ok(file);
        };
        let next = then.read_alone(then.only()?, watch)?;
        // Clocks that count from 1970 say how far the two are apart.
        let start = file.start.zip(next.start).map(|(first, second)| second - first);
        file.record = file.record.then(&next.record, start).map_err(|source| ReadError::Record {
            path: next.path.clone(),
            part: next.part.name.clone(),
            line: None,
            source,
        })?;
        file.signals = file.record.signals();
        (file.rows, file.bytes) = (file.rows + next.rows, file.bytes + next.bytes);
        Ok(file)
    }

    fn read_alone(&self, part: usize, watch: &mut dyn Watch) -> Result<RecordFile, JobError> {
        let path = &self.contents.input.name;
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let task = format!("reading {name}");
        let mut report = |done, total| {
            let (task, total) = (task.as_str(), Some(total));
            watch.report(Progress { task, done, total })
        };
        let file = read_part(&self.contents, part, self.described.test.as_ref(), &mut report)?;
        let size = self.contents.input.size;
        report(size, size)?;
        self.contents.input.check_unchanged().map_err(ReadError::File)?;
        Ok(file)
    }

    /// The record in a part as jobs take it.
    ///
    /// # Errors
    /// As for [`read`](Self::read).
    pub fn measurement(&self, part: usize, watch: &mut dyn Watch) -> Result<Measurement, JobError> {
        let file = self.read(part, watch)?;
        Ok(Measurement {
            input: self.input(&file, self.name(part), watch)?,
            options: self.described.options(),
            notes: averaged(&file).into_iter().collect(),
            turned: turned(&file),
            record: file.record,
        })
    }

    /// What results say of where a record comes from; `part` is what to call it where the file holds several.
    ///
    /// # Errors
    /// [`JobError`] where the file can no longer be read, or the watch ends it.
    pub(crate) fn input(
        &self,
        file: &RecordFile,
        part: Option<&str>,
        watch: &mut dyn Watch,
    ) -> Result<Input, JobError> {
        let path = file.path.as_path();
        let about = self.described.test.as_ref().and_then(|test| test.about.title.clone());
        let position = MapPosition::of(&file.part.metadata);
        let title = about.unwrap_or_else(|| path.file_stem().unwrap_or_default().to_string_lossy().into_owned());
        Ok(Input {
            path: path.display().to_string(),
            part: file.part.name.clone(),
            sha256: self.digest.get(watch)?,
            test_sha256: self.described.sha256(),
            air_run_sha256: None,
            then_sha256: self.then.as_ref().map(|then| then.digest.get(watch)).transpose()?,
            depends_on_sha256: None,
            rows: file.rows,
            rows_averaged: file.averaged,
            x_m: position.map(|position| position.x),
            y_m: position.map(|position| position.y),
            map_index: position.and_then(|position| position.index),
            test: self.described.shown(),
            title: part.map_or_else(|| title.clone(), |part| format!("{title} · {part}")),
        })
    }
}

/// What would give the displacement or the force the opposite sign.
fn turned(file: &RecordFile) -> Vec<(String, String)> {
    let option = |quantity: &str| Some((quantity.to_owned(), file.with_other_sign(quantity)?));
    ["displacement", "force"].into_iter().filter_map(option).collect()
}

impl Measurement {
    /// The option that turns the sign of the column that a finding doubts, in a sentence.
    pub(crate) fn sign_note(turned: &[(String, String)], finding: &Finding) -> Option<String> {
        let Finding::SignSuspicious { column, .. } = finding else {
            return None;
        };
        let (_, option) = turned.iter().find(|(quantity, _)| quantity == column)?;
        Some(format!("the other sign of the {column}: {option}"))
    }
}

/// SHA-256 of a record that was in memory already, hexadecimal: of its columns as doubles, the lowest byte first, time, displacement and
/// force in this order.
///
/// # Errors
/// [`Cancelled`] once the watch ends it.
pub fn record_sha256(record: &Record, watch: &mut dyn Watch) -> Result<String, Cancelled> {
    const AT_ONCE: usize = 1 << 16;
    let columns = [Some(record.time()), record.displacement(), Some(record.force())];
    let mut digest = Sha256::new();
    let mut bytes = Vec::with_capacity(8 * AT_ONCE);
    for values in columns.into_iter().flatten().flat_map(|column| column.chunks(AT_ONCE)) {
        watch.report(Progress::open("digesting the record", 0))?;
        bytes.clear();
        bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        digest.update(&bytes);
    }
    Ok(hexadecimal(digest.finalize()))
}

/// That a file is so long that its rows were averaged.
pub(crate) fn averaged(file: &RecordFile) -> Option<String> {
    (file.averaged > 1).then(|| {
        let kept = file.rows.div_ceil(file.averaged);
        format!(
            "{}: {} rows exceed the limit; each {} successive rows are averaged ({kept} samples)",
            file.path.display(),
            file.rows,
            file.averaged
        )
    })
}

/// A record by its file, and its part where the file holds several.
#[must_use]
pub fn called(path: &Path, part: Option<&str>) -> String {
    part.map_or_else(|| path.display().to_string(), |part| format!("{}, {part}", path.display()))
}
