//! What a result depends on, as one digest: the job and its settings, every file that it reads, and the build that computes it.
//!
//! Where two digests are equal the results are, too. Work that is resumed and tables that are taken as they are rely on this.

use palpate_report::result::Input;
use serde::Serialize;

use crate::JobError;
use crate::output::sha256;

/// This build: a digest of the sources, of the versions of what they use, and of target and features.
pub const BUILD: &str = env!("PALPATE_BUILD");

/// Everything that a result depends on.
#[derive(Debug, Serialize)]
pub(crate) struct Dependencies<'a, S: Serialize> {
    /// What computes it.
    build: &'static str,
    job: &'a str,
    settings: &'a S,
    /// What each file is read for, and the digest of what was read.
    files: Vec<(&'a str, String)>,
}

impl<'a, S: Serialize> Dependencies<'a, S> {
    /// A job with its settings, and no file yet.
    pub(crate) fn new(job: &'a str, settings: &'a S) -> Self {
        Self {
            build: BUILD,
            job,
            settings,
            files: Vec::new(),
        }
    }

    /// The same with a file that is read for `role`, if it is read.
    pub(crate) fn file(mut self, role: &'a str, sha256: Option<&str>) -> Self {
        self.files.extend(sha256.map(|sha256| (role, sha256.to_owned())));
        self
    }

    /// The same with a text that was read for `role`, if one was.
    pub(crate) fn text(self, role: &'a str, text: Option<&str>) -> Self {
        let digest = text.map(|text| sha256(text.as_bytes()));
        self.file(role, digest.as_deref())
    }

    /// The same with the files of a record.
    pub(crate) fn record(self, input: &'a Input) -> Self {
        let part = input.part.as_deref();
        self.file("record", Some(&input.sha256))
            .text("part", part)
            .file("test", input.test_sha256.as_deref())
            .file("air run", input.air_run_sha256.as_deref())
            .file("then", input.then_sha256.as_deref())
    }

    /// The digest of all that, hexadecimal.
    ///
    /// # Errors
    /// [`JobError`] where the settings have no form in JSON.
    pub(crate) fn sha256(&self) -> Result<String, JobError> {
        Ok(sha256(&serde_json::to_vec(self)?))
    }
}
