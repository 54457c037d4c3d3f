//! The one way in: files that are named, regular ones alone, and what is read as a whole up to a limit.

use std::{
    fs::{File, FileType, Metadata},
    io::{self, IsTerminal, Read},
    path::Path,
    time::SystemTime,
};

use crate::{
    error::{FileError, FileProblem},
    faults::admits,
};

/// Whether a name means standard input.
#[must_use]
pub fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

/// The regular file at `path`, through links. A pipe or a device is refused before it is opened: to open one may wait without end.
pub(super) fn open_regular(path: &Path) -> Result<(File, Metadata), FileError> {
    let failed = |error| FileError::from_io(path, error);
    check_regular(path, &std::fs::metadata(path).map_err(failed)?)?;
    let file = File::open(path).map_err(failed)?;
    // What was opened may be another one by now.
    let about = file.metadata().map_err(failed)?;
    check_regular(path, &about)?;
    Ok((file, about))
}

fn check_regular(path: &Path, about: &Metadata) -> Result<(), FileError> {
    if about.is_file() {
        return Ok(());
    }
    let problem = if about.is_dir() { FileProblem::Directory } else { FileProblem::NoFile(kind(about.file_type())) };
    Err(FileError::of(path, problem))
}

/// What a path leads to that is neither a file nor a directory.
#[cfg(unix)]
#[must_use]
pub fn kind(of: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    match () {
        () if of.is_fifo() => "a pipe",
        () if of.is_socket() => "a socket",
        () if of.is_char_device() || of.is_block_device() => "a device",
        () => "something else",
    }
}

/// What a path leads to that is neither a file nor a directory.
#[cfg(not(unix))]
#[must_use]
pub fn kind(_: FileType) -> &'static str {
    "a device"
}

/// All bytes of the regular file at `path`, or of standard input where it is `-`; `None` where there are more than `most`.
///
/// # Errors
/// [`FileError`] where there is no such file, or it cannot be read.
pub fn read_whole(path: &Path, most: u64) -> Result<Option<Vec<u8>>, FileError> {
    if is_standard_input(path) {
        return piped(path, most);
    }
    let (file, about) = open_regular(path)?;
    if !admits(about.len(), most) {
        return Ok(None);
    }
    // It may grow meanwhile.
    up_to(file, most).map_err(|error| FileError::from_io(path, error))
}

fn piped(path: &Path, most: u64) -> Result<Option<Vec<u8>>, FileError> {
    let stdin = io::stdin();
    if stdin.is_terminal() {
        return Err(FileError::of(path, FileProblem::NoFile("a terminal")));
    }
    up_to(stdin.lock(), most).map_err(|error| FileError::from_io(path, error))
}

fn up_to(from: impl Read, most: u64) -> io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    from.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= most).then_some(bytes))
}

/// Length and time of the last change of a file: by these it is the same as before.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stamp {
    length: u64,
    changed: Option<SystemTime>,
}

impl Stamp {
    pub(super) fn of(about: &Metadata) -> Self {
        Self {
            length: about.len(),
            changed: about.modified().ok(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bytes");
        std::fs::write(&path, [7; 10]).unwrap();
        assert_eq!(read_whole(&path, 10).unwrap(), Some(vec![7; 10]));
        assert_eq!(read_whole(&path, 9).unwrap(), None);
        assert!(matches!(read_whole(folder.path(), 9).unwrap_err().problem, FileProblem::Directory));
    }

    #[cfg(unix)]
    #[test]
    fn devices_and_sockets_are_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let socket = folder.path().join("socket");
        let _listener = std::os::unix::net::UnixListener::bind(&socket).unwrap();
        for (path, expected) in [(Path::new("/dev/zero"), "a device"), (&socket, "a socket")] {
            let error = read_whole(path, 10).unwrap_err();
            assert!(matches!(error.problem, FileProblem::NoFile(found) if found == expected), "{error}");
        }
    }
}
