//! Files that appear whole or not at all, and never in the place of one that is read.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use palpate::number::counted;
use palpate_files::parquet_table::TableError;
use palpate_report::figure::Figure;
use palpate_report::study::Bundle;
use sha2::{Digest, Sha256};

use crate::{ErrorKind, JobError};

/// Begin of the names of temporary files.
pub(crate) const TEMPORARY: &str = ".palpate-";

/// Resolution of PNG figures.
const DPI: f64 = 300.0;

/// Refuses to write a file that is read: a measured record cannot be had again.
///
/// # Errors
/// [`JobError`] with the first of `writes` that is among `reads`, through links too.
pub fn keep_apart<R: AsRef<Path>, W: AsRef<Path>>(
    reads: impl IntoIterator<Item = R>,
    writes: impl IntoIterator<Item = W>,
) -> Result<(), JobError> {
    let reads: Vec<R> = reads.into_iter().collect();
    match writes.into_iter().find(|out| reads.iter().any(|read| is_same(read.as_ref(), out.as_ref()))) {
        Some(out) => Err(JobError::option(
            "expected an output file that is not an input, found an input",
            "choose another name for the output",
        )
        .of(out.as_ref().display())),
        None => Ok(()),
    }
}

/// Whether two paths lead to one file, through links too.
pub(crate) fn is_same(one: &Path, other: &Path) -> bool {
    match (one.canonicalize(), other.canonicalize()) {
        (Ok(one), Ok(other)) => one == other,
        _ => one == other,
    }
}

/// What the operating system says about a file to be written, and what would help.
pub(crate) fn unwritten(path: &Path, error: &io::Error) -> JobError {
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
fn standing(path: &Path) -> String {
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

/// Refuses a place for a file where a directory stands, or a file above it.
fn check_place(path: &Path) -> Result<(), JobError> {
    match path.is_dir() {
        true => Err(unwritten(path, &io::ErrorKind::IsADirectory.into())),
        false => check_folder(folder_of(path)),
    }
}

/// Writes one file: under a temporary name first, then renamed.
///
/// # Errors
/// [`JobError`] where the operating system takes no file there.
pub fn write_file(path: &Path, content: &[u8]) -> Result<(), JobError> {
    write_file_with(path, |out| out.write_all(content))
}

/// Likewise, for content that is made as it goes.
///
/// # Errors
/// As for [`write_file`].
pub fn write_file_with(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), JobError> {
    let buffered = |file: &fs::File| -> io::Result<()> {
        let mut out = io::BufWriter::new(file);
        write(&mut out)?;
        out.flush()
    };
    place_file(path, folder_of(path), |file| buffered(file).map_err(|error| unwritten(path, &error)))
}

/// The folder that a file lies in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Likewise, for writers with errors of their own, and with the temporary file in a folder on the same disk.
pub(crate) fn place_file(
    path: &Path,
    folder: &Path,
    write: impl FnOnce(&fs::File) -> Result<(), JobError>,
) -> Result<(), JobError> {
    let refused = |error: io::Error| unwritten(path, &error);
    fs::create_dir_all(folder).map_err(refused)?;
    let file = tempfile::Builder::new().prefix(TEMPORARY).tempfile_in(folder).map_err(refused)?;
    write(file.as_file())?;
    file.as_file().sync_all().map_err(refused)?;
    file.persist(path).map_err(|error| refused(error.error))?;
    open_to_all(path).map_err(refused)
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

/// Refuses a table in the place of a folder.
pub(crate) fn check_no_folder(out: &Path) -> Result<(), JobError> {
    if out.is_dir() {
        let message = format!("expected a file for the table, found {}", standing(out));
        let name = out.join("table.parquet").display().to_string();
        return Err(JobError::option(message, &format!("name a file in it: ⟨out={name}⟩")).of(out.display()));
    }
    Ok(())
}

/// Writes all files of a bundle below `folder`: all of them beside it first, then moved into place.
///
/// # Errors
/// As for [`write_file`].
pub fn write_bundle(folder: &Path, bundle: &Bundle) -> Result<(), JobError> {
    let stage = |bundle: &Bundle| -> io::Result<tempfile::TempDir> {
        fs::create_dir_all(folder)?;
        let staged = tempfile::Builder::new().prefix(TEMPORARY).tempdir_in(folder)?;
        for (name, content) in &bundle.files {
            let path = staged.path().join(name);
            fs::create_dir_all(folder_of(&path))?;
            let mut file = fs::File::create(&path)?;
            file.write_all(content)?;
            file.sync_all()?;
        }
        Ok(staged)
    };
    for (name, _) in &bundle.files {
        check_place(&folder.join(name))?;
    }
    let existed = folder.exists();
    let staged = stage(bundle).map_err(|error| {
        if !existed {
            // Only an empty folder goes; one that others have written to since stays.
            let _ = fs::remove_dir(folder);
        }
        unwritten(folder, &error)
    })?;
    let stale = stale_files(folder, bundle);
    for (name, _) in &bundle.files {
        let target = folder.join(name);
        let place = fs::create_dir_all(folder_of(&target));
        let place = place.and_then(|()| fs::rename(staged.path().join(name), &target));
        place.map_err(|error| unwritten(&target, &error))?;
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

/// SHA-256 of bytes, hexadecimal.
#[must_use]
pub fn sha256(content: &[u8]) -> String {
    hexadecimal(Sha256::digest(content))
}

/// A digest in hexadecimal.
pub(crate) fn hexadecimal(bytes: impl AsRef<[u8]>) -> String {
    bytes.as_ref().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Endings of files that only a build with some feature writes, and that feature.
const NOT_IN_THIS_BUILD: &[(&str, &str)] = &[
    #[cfg(not(feature = "arrow"))]
    ("parquet", "arrow"),
    #[cfg(not(feature = "png"))]
    ("png", "png"),
];

/// Refuses a name without one of these endings, before any work is done; `expected` and `hint` say what is meant.
pub(crate) fn check_ending(path: &Path, endings: &[&str], expected: &str, hint: &str) -> Result<(), JobError> {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    if !endings.contains(&ending) {
        if path.is_dir() {
            let message = format!("expected {expected}, found {}", standing(path));
            let name = path.join("FILE").with_extension(endings[0]);
            return Err(JobError::option(message, &format!("name a file in it: {}", name.display())).of(path.display()));
        }
        return Err(JobError::option(format!("expected {expected}"), hint).of(path.display()));
    }
    if let Some((_, feature)) = NOT_IN_THIS_BUILD.iter().find(|(absent, _)| *absent == ending) {
        let message = format!("expected a format of this build, found one that needs the feature `{feature}`");
        let hint = format!("build palpate with the feature `{feature}`, which is enabled by default");
        return Err(JobError::option(message, &hint).of(path.display()));
    }
    Ok(())
}

/// Refuses names of figures that say no format.
///
/// # Errors
/// [`JobError`] where the name does not end in `.svg` or `.png`.
pub fn check_figure(path: &Path) -> Result<(), JobError> {
    check_ending(path, &["svg", "png"], "a figure ending in .svg or .png", "name the figure FILE.svg or FILE.png")
}

/// Refuses names of series that do not end in `.csv`.
///
/// # Errors
/// [`JobError`] for any other name.
pub fn check_series(path: &Path) -> Result<(), JobError> {
    check_ending(path, &["csv"], "a series ending in .csv", "name the series FILE.csv")
}

/// Refuses a file that is there: a description that a person has worked on is not written over.
///
/// # Errors
/// [`JobError`] where there is such a file.
pub fn check_new(path: &Path) -> Result<(), JobError> {
    if path.exists() {
        let hint = "choose another name with ⟨write_test⟩, or remove the file first";
        let message = "expected the name of a new file, found an existing file";
        return Err(JobError::option(message, hint).of(path.display()));
    }
    Ok(())
}

/// The bytes of a figure, by the ending of its name.
///
/// # Errors
/// [`JobError`] where the name says no format, or the figure cannot be drawn.
pub fn picture(path: &Path, figure: &Figure) -> Result<Vec<u8>, JobError> {
    check_figure(path)?;
    let drawn = match path.extension().and_then(|extension| extension.to_str()) {
        Some("png") => figure.to_png(DPI),
        _ => figure.to_svg().map(String::into_bytes),
    };
    drawn.map_err(|error| JobError::new(ErrorKind::Report, error, None).of(path.display()))
}

/// The name of a figure in a file.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem().map_or("figure".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// A name of a test as the name of a file: what no system allows there becomes a hyphen.
pub(crate) fn file_name(name: &str) -> String {
    let allowed = |letter: char| !letter.is_control() && !"/\\:*?\"<>|".contains(letter);
    let name: String = name.chars().map(|letter| if allowed(letter) { letter } else { '-' }).collect();
    let name = name.trim().trim_matches('.').trim();
    if name.is_empty() { "test".to_owned() } else { name.to_owned() }
}

/// A folder by its name in another one, with a number where that is taken.
pub(crate) fn folder_in(out: &Path, name: &str, taken: &mut Vec<PathBuf>) -> PathBuf {
    let numbered = (2..).map(|number| out.join(format!("{name}-{number}")));
    let mut names = std::iter::once(out.join(name)).chain(numbered);
    let folder = names.find(|folder| !taken.contains(folder)).unwrap_or_else(|| out.join(name));
    taken.push(folder.clone());
    folder
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With all features both names pass; `validation/long_proofs.sh features` runs this without them.
    #[test]
    fn what_a_build_cannot_write_is_refused_before_any_work() {
        for (name, feature, is_there) in
            [("a.parquet", "arrow", cfg!(feature = "arrow")), ("a.png", "png", cfg!(feature = "png"))]
        {
            let checked = check_ending(Path::new(name), &["parquet", "png"], "a table or a figure", "");
            let refused = checked.err().map(|error| error.to_string());
            let expected =
                format!("{name}: expected a format of this build, found one that needs the feature `{feature}`");
            assert_eq!(refused, (!is_there).then_some(expected));
        }
        let other = check_ending(Path::new("a.txt"), &["csv"], "a table ending in .csv", "").unwrap_err();
        assert_eq!(other.to_string(), "a.txt: expected a table ending in .csv");
    }
}
