//! Several files as one.

use std::io::{Cursor, Write};

use palpate_jobs::{ErrorKind, JobError};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::tasks::Files;

/// A ZIP archive of files.
///
/// # Errors
/// [`JobError`] where a name is none of an archive.
pub(super) fn zipped(files: &Files) -> Result<Vec<u8>, JobError> {
    let failed = |error: &dyn std::fmt::Display| JobError::new(ErrorKind::Report, error, None);
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in files {
        let name = name.rsplit('/').next().unwrap_or(name);
        archive.start_file(name, SimpleFileOptions::default()).map_err(|error| failed(&error))?;
        archive.write_all(content).map_err(|error| failed(&error))?;
    }
    Ok(archive.finish().map_err(|error| failed(&error))?.into_inner())
}
