//! Output that appears whole or not at all.

use std::fs::{self, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use palpate_report::study::Bundle;

use crate::failure::Failure;

/// What the operating system says about a file to be written, and what would help.
pub(crate) fn failure(path: &Path, error: &io::Error) -> Failure {
    let hint = match error.kind() {
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            Some("choose a folder that you may write to".to_owned())
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            Some("free some space; nothing was written".to_owned())
        }
        io::ErrorKind::NotADirectory | io::ErrorKind::AlreadyExists => {
            Some("a file stands where the folder should go; choose another name with --out".to_owned())
        }
        _ => None,
    };
    // The name of a temporary file would say nothing to the reader.
    let what = std::io::Error::from(error.kind());
    Failure::of_file(path, format!("cannot write: {what}"), hint)
}

/// Writes one file: under a temporary name first, then renamed.
pub(crate) fn write_file(path: &Path, content: &[u8]) -> Result<(), Failure> {
    write_file_with(path, |out| out.write_all(content))
}

/// Likewise, for content that is made as it goes.
pub(crate) fn write_file_with(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), Failure> {
    let buffered = |file: &fs::File| -> io::Result<()> {
        let mut out = io::BufWriter::new(file);
        write(&mut out)?;
        out.flush()
    };
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    place_file(path, folder, buffered).map_err(|error: io::Error| failure(path, &error))
}

/// Likewise, for writers with errors of their own, and with the temporary file in a folder on the same disk.
pub(crate) fn place_file<E: From<io::Error>>(
    path: &Path,
    folder: &Path,
    write: impl FnOnce(&fs::File) -> Result<(), E>,
) -> Result<(), E> {
    fs::create_dir_all(folder)?;
    let file = tempfile::Builder::new().prefix(".palpate-").tempfile_in(folder)?;
    write(file.as_file())?;
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(open_to_all(path)?)
}

/// Writes all files of a bundle below `folder`: all of them beside it first, then moved into place.
pub(crate) fn write_bundle(folder: &Path, bundle: &Bundle) -> Result<(), Failure> {
    let stage = |bundle: &Bundle| -> io::Result<tempfile::TempDir> {
        fs::create_dir_all(folder)?;
        let staged = tempfile::Builder::new().prefix(".palpate-").tempdir_in(folder)?;
        for (name, content) in &bundle.files {
            let path = staged.path().join(name);
            if let Some(parent) = path.parent() {
                fs::create_dir_all(parent)?;
            }
            let mut file = fs::File::create(&path)?;
            file.write_all(content)?;
            file.sync_all()?;
        }
        Ok(staged)
    };
    let existed = folder.exists();
    let staged = stage(bundle).map_err(|error| {
        if !existed {
            // Only an empty folder goes; one that others have written to since stays.
            let _ = fs::remove_dir(folder);
        }
        failure(folder, &error)
    })?;
    let stale = stale_files(folder, bundle);
    for (name, _) in &bundle.files {
        let target = folder.join(name);
        let place = || -> io::Result<()> {
            if let Some(parent) = target.parent() {
                fs::create_dir_all(parent)?;
            }
            fs::rename(staged.path().join(name), &target)
        };
        place().map_err(|error| failure(&target, &error))?;
    }
    for path in stale {
        // A file that is gone already is as good as removed.
        let _ = fs::remove_file(path);
    }
    let names: String = bundle.files.iter().map(|(name, _)| format!("{name}\n")).collect();
    write_file(&folder.join(MANIFEST), names.as_bytes())
}

/// The names that the last run wrote into a folder, so that the next one can take away what it does not write again.
const MANIFEST: &str = ".palpate-files";

/// Files of an earlier run that this one does not write: they would speak of another record. Others' files stay.
fn stale_files(folder: &Path, bundle: &Bundle) -> Vec<PathBuf> {
    let written = fs::read_to_string(folder.join(MANIFEST)).unwrap_or_default();
    let is_stale = |name: &&str| {
        let inside = Path::new(name).components().all(|part| matches!(part, std::path::Component::Normal(_)));
        inside && !bundle.files.iter().any(|(new, _)| new == name)
    };
    written.lines().filter(is_stale).map(|name| folder.join(name)).collect()
}

/// Temporary files are private; a result is as readable as any other file of the user's.
#[cfg(unix)]
fn open_to_all(path: &Path) -> io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    fs::set_permissions(path, fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn open_to_all(_: &Path) -> io::Result<()> {
    Ok(())
}

/// A file that only one `work` can hold at a time.
pub(crate) fn lock_file(path: &Path, work: &str) -> Result<fs::File, Failure> {
    let file = fs::File::create(path).map_err(|error| failure(path, &error))?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(Failure::of_file(
            path,
            format!("expected no other {work} at work here, found one"),
            Some("wait for it, or name another table with --out".to_owned()),
        )),
        // A file system without locks: better without than not at all.
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(file),
        Err(TryLockError::Error(error)) => Err(failure(path, &error)),
    }
}

/// SHA-256 of a file, hexadecimal.
pub(crate) fn sha256(path: &Path) -> Result<String, Failure> {
    use sha2::{Digest, Sha256};
    let hash = || -> io::Result<String> {
        let mut file = fs::File::open(path)?;
        let mut hasher = Sha256::new();
        let mut buffer = vec![0; 1 << 18];
        loop {
            let count = io::Read::read(&mut file, &mut buffer)?;
            if count == 0 {
                break;
            }
            hasher.update(&buffer[..count]);
        }
        Ok(hexadecimal(&hasher.finalize()))
    };
    hash().map_err(|error| Failure::of_file(path, error, None))
}

/// SHA-256 of what a file would hold, hexadecimal.
pub(crate) fn sha256_of(content: &[u8]) -> String {
    use sha2::{Digest, Sha256};
    hexadecimal(&Sha256::digest(content))
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A name of a test as the name of a file: what no system allows there becomes a hyphen.
pub(crate) fn file_name(name: &str) -> String {
    let allowed = |letter: char| !letter.is_control() && !"/\\:*?\"<>|".contains(letter);
    let name: String = name.chars().map(|letter| if allowed(letter) { letter } else { '-' }).collect();
    let name = name.trim().trim_matches('.').trim();
    if name.is_empty() { "test".to_owned() } else { name.to_owned() }
}

/// Folders for the results of several records: the file names, with a number where two are alike.
pub(crate) fn folders(out: &Path, records: &[PathBuf]) -> Vec<PathBuf> {
    if records.len() == 1 {
        return vec![out.to_owned()];
    }
    let mut taken = Vec::new();
    let stem = |record: &PathBuf| record.file_stem().unwrap_or(record.as_os_str()).to_string_lossy().into_owned();
    records.iter().map(|record| folder_in(out, &stem(record), &mut taken)).collect()
}

/// A folder by its name in another one, with a number where that is taken.
pub(crate) fn folder_in(out: &Path, name: &str, taken: &mut Vec<PathBuf>) -> PathBuf {
    let numbered = (2..).map(|number| out.join(format!("{name}-{number}")));
    let mut names = std::iter::once(out.join(name)).chain(numbered);
    let folder = names.find(|folder| !taken.contains(folder)).unwrap_or_else(|| out.join(name));
    taken.push(folder.clone());
    folder
}
