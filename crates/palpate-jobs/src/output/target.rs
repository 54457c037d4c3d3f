//! Where a file may go, and what stands in its way.

use std::fs;
use std::io;
use std::path::Path;

use palpate::number::counted;
use palpate_files::input::kind;
use palpate_files::message_log::LogError;
use palpate_files::parquet_table::TableError;

use crate::{ErrorKind, JobError};

/// What the operating system says about a file to be written, and what would help.
#[must_use]
pub fn unwritten(path: &Path, error: &io::Error) -> JobError {
    let hint = match error.kind() {
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => "choose a folder with write permission",
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "free some space; nothing was written",
        _ => "",
    };
    // The system says that something is there, not what.
    if let Some(file) = path.ancestors().find(|path| path.is_file())
        && (file != path || error.kind() == io::ErrorKind::AlreadyExists)
    {
        let message = format!("cannot write: expected a folder, found {}", standing(file));
        let hint = "choose another name with ⟨out⟩, or move the file away";
        return JobError::new(ErrorKind::File(error.kind()), message, hint.to_owned()).of(file.display());
    }
    if path.is_dir() && matches!(error.kind(), io::ErrorKind::IsADirectory | io::ErrorKind::DirectoryNotEmpty) {
        let message = format!("cannot write: expected a file or nothing, found {}", standing(path));
        let hint = "choose another name with ⟨out⟩, or move the directory away";
        return JobError::new(ErrorKind::File(error.kind()), message, hint.to_owned()).of(path.display());
    }
    // The name of a temporary file would say nothing to the reader.
    let what = io::Error::from(error.kind());
    JobError::new(ErrorKind::File(error.kind()), format!("cannot write: {what}"), hint.to_owned()).of(path.display())
}

/// What stands at a path where something else should go.
pub(super) fn standing(path: &Path) -> String {
    const NAMED: usize = 3;
    if let Ok(entries) = fs::read_dir(path) {
        let names = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
        let mut names: Vec<String> = names.filter(|name| !name.starts_with('.')).collect();
        names.sort();
        let (count, more) = (names.len(), if names.len() > NAMED { ", …" } else { "" });
        names.truncate(NAMED);
        return match count {
            0 => "a directory that is empty".to_owned(),
            _ => format!("a directory that holds {}{more}", names.join(", ")),
        };
    }
    let size = fs::metadata(path).map_or(0, |about| about.len());
    format!("a file of {}", counted(usize::try_from(size).unwrap_or(usize::MAX), "byte"))
}

/// Refuses a file in the place of the folder for a report, before any work is done.
///
/// # Errors
/// [`JobError`] where the path, or what should be a folder above it, leads to a file.
pub fn check_folder(out: &Path) -> Result<(), JobError> {
    match out.ancestors().find(|path| path.is_file()) {
        Some(_) => Err(unwritten(out, &io::ErrorKind::AlreadyExists.into())),
        None => Ok(()),
    }
}

/// Refuses a place for a file where a directory, a pipe or a device stands, or a file above it; `named` is what the path was called.
pub(super) fn check_regular(path: &Path, named: &Path) -> Result<(), JobError> {
    match fs::metadata(path) {
        Ok(about) if about.is_dir() => Err(unwritten(named, &io::ErrorKind::IsADirectory.into())),
        Ok(about) if !about.is_file() => {
            let message =
                format!("cannot write: expected a regular file or nothing, found {}", kind(about.file_type()));
            let hint = "choose another name with ⟨out⟩".to_owned();
            let kind = ErrorKind::File(io::ErrorKind::InvalidInput);
            Err(JobError::new(kind, message, hint).of(named.display()))
        }
        _ => check_folder(folder_of(path)),
    }
}

/// The folder that a file lies in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A failure of a table at `path`.
pub(crate) fn unwritten_table(path: &Path, error: &TableError) -> JobError {
    match error {
        TableError::Io(error) => unwritten(path, error),
        error => {
            let hint = "compute all runs again with ⟨restart⟩".to_owned();
            JobError::new(ErrorKind::File(io::ErrorKind::InvalidData), error, hint).of(path.display())
        }
    }
}

/// A failure of a log at `path`.
pub(crate) fn unwritten_log(path: &Path, error: &LogError) -> JobError {
    match error {
        LogError::Io(error) => unwritten(path, error),
        error => JobError::new(ErrorKind::Record, error, error.hint().to_owned()).of(path.display()),
    }
}

/// Refuses a table in the place of a folder.
pub(crate) fn check_no_folder(out: &Path) -> Result<(), JobError> {
    if out.is_dir() {
        let message = format!("expected a file for the table, found {}", standing(out));
        let name = out.join("table.parquet").display().to_string();
        return Err(JobError::option(message, &format!("name a file in it: ⟨out={name}⟩")).of(out.display()));
    }
    Ok(())
}
