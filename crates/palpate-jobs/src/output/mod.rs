//! Files that appear whole or not at all, and never in the place of one that is read.
//!
//! | file | what |
//! |---|---|
//! | `stage.rs` | the one way out: files that appear together ([`Stage`]) |
//! | `temporary.rs` | folders for what is not finished, removed on errors, on signals and after kills |
//! | `bundle.rs` | all files of a report |
//! | `target.rs` | where a file may go, and what stands in its way |
//! | `names.rs` | names that every system can hold |

mod bundle;
mod names;
mod stage;
mod target;
mod temporary;

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use palpate_report::figure::{Figure, PictureFormat};
use sha2::{Digest, Sha256};

pub use bundle::write_bundle;
pub(crate) use names::Names;
pub use names::file_name;
pub use stage::{Stage, StagedFile};
pub use target::{check_folder, unwritten};
pub(crate) use target::{check_no_folder, unwritten_log, unwritten_table};
use target::{check_regular, folder_of, standing};
use temporary::remove_stale;
pub use temporary::{TemporaryFolder, abandon};

use crate::{ErrorKind, JobError};

/// Refuses to write a file that is read, for a measured record cannot be had again, and what is no regular file.
///
/// # Errors
/// [`JobError`] with the first of `writes` that is among `reads`, through links too, or that is a pipe, a socket or a device.
pub fn keep_apart<R: AsRef<Path>, W: AsRef<Path>>(
    reads: impl IntoIterator<Item = R>,
    writes: impl IntoIterator<Item = W>,
) -> Result<(), JobError> {
    let (reads, writes): (Vec<R>, Vec<W>) = (reads.into_iter().collect(), writes.into_iter().collect());
    match writes.iter().find(|out| reads.iter().any(|read| is_same(read.as_ref(), out.as_ref()))) {
        Some(out) => Err(JobError::option(
            "expected an output file that is not an input, found an input",
            "choose another name for the output",
        )
        .of(out.as_ref().display())),
        // What stands as a folder there is for the command to explain.
        None => writes
            .iter()
            .filter(|out| !out.as_ref().is_dir())
            .try_for_each(|out| check_regular(out.as_ref(), out.as_ref())),
    }
}

/// Removes the temporary folders that kills have left beside a file, of work that has nothing to write any more.
pub(crate) fn remove_left_beside(file: &Path) {
    if let Ok(target) = file.canonicalize() {
        remove_stale(folder_of(&target));
    }
}

/// Whether two paths lead to one file, through links too.
pub(crate) fn is_same(one: &Path, other: &Path) -> bool {
    match (one.canonicalize(), other.canonicalize()) {
        (Ok(one), Ok(other)) => one == other,
        _ => one == other,
    }
}

/// Writes one file.
///
/// # Errors
/// [`JobError`] where the operating system takes no file there.
pub fn write_file(path: &Path, content: &[u8]) -> Result<(), JobError> {
    let mut stage = Stage::default();
    stage.bytes(path, content)?;
    stage.commit()
}

/// SHA-256 of bytes, hexadecimal.
#[must_use]
pub fn sha256(content: &[u8]) -> String {
    sha256_of_parts([content])
}

/// SHA-256 of the bytes that parts make together, hexadecimal.
#[must_use]
pub fn sha256_of_parts<'a>(parts: impl IntoIterator<Item = &'a [u8]>) -> String {
    let mut digest = Sha256::new();
    parts.into_iter().for_each(|part| digest.update(part));
    hexadecimal(digest.finalize())
}

/// SHA-256 of the bytes of a file, hexadecimal.
pub(crate) fn file_sha256(path: &Path) -> Result<String, JobError> {
    let digest = || -> io::Result<String> {
        let (mut file, mut digest) = (BufReader::with_capacity(1 << 18, File::open(path)?), Sha256::new());
        loop {
            let piece = file.fill_buf()?;
            if piece.is_empty() {
                return Ok(hexadecimal(digest.finalize()));
            }
            digest.update(piece);
            let length = piece.len();
            file.consume(length);
        }
    };
    digest().map_err(|error| JobError::unread(path, &error))
}

/// A digest in hexadecimal.
pub(crate) fn hexadecimal(bytes: impl AsRef<[u8]>) -> String {
    bytes.as_ref().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Endings of files that only a build with some feature writes, and that feature.
const NOT_IN_THIS_BUILD: &[(&str, &str)] = &[
    #[cfg(not(feature = "arrow"))]
    ("parquet", "arrow"),
    #[cfg(not(feature = "robot-log"))]
    ("mcap", "robot-log"),
    #[cfg(not(feature = "png"))]
    ("png", "png"),
    #[cfg(not(feature = "png"))]
    ("pdf", "png"),
    #[cfg(not(feature = "xlsx"))]
    ("xlsx", "xlsx"),
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
/// [`JobError`] where the name does not end in `.svg`, `.png` or `.pdf`.
pub fn check_figure(path: &Path) -> Result<(), JobError> {
    let endings = PictureFormat::ALL.map(PictureFormat::ending);
    let hint = "name the figure FILE.svg, FILE.png or FILE.pdf";
    check_ending(path, &endings, "a figure ending in .svg, .png or .pdf", hint)
}

/// Refuses names of series that do not end in `.csv`.
///
/// # Errors
/// [`JobError`] for any other name.
pub fn check_series(path: &Path) -> Result<(), JobError> {
    check_ending(path, &["csv"], "a series ending in .csv", "name the series FILE.csv")
}

/// Refuses names of series that end neither in `.csv` nor in `.mcap`.
///
/// # Errors
/// [`JobError`] for any other name, and for a log in a build without the feature `robot-log`.
pub fn check_series_or_log(path: &Path) -> Result<(), JobError> {
    let hint = "name the series FILE.csv or FILE.mcap";
    check_ending(path, &["csv", "mcap"], "a series ending in .csv or .mcap", hint)
}

/// Refuses names of logs that do not end in `.mcap`.
///
/// # Errors
/// As for [`check_series_or_log`].
pub fn check_log(path: &Path) -> Result<(), JobError> {
    check_ending(path, &["mcap"], "a log ending in .mcap", "name the log FILE.mcap")
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
    let drawn = figure.to_file(PictureFormat::of(path).unwrap_or(PictureFormat::Svg));
    drawn.map_err(|error| JobError::new(ErrorKind::Report, error, None).of(path.display()))
}

/// The name of a figure in a file.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem().map_or("figure".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With all features both names pass; `validation/long_proofs.sh features` runs this without them.
    #[test]
    fn what_a_build_cannot_write_is_refused_before_any_work() {
        for (name, feature, is_there) in [
            ("a.parquet", "arrow", cfg!(feature = "arrow")),
            ("a.png", "png", cfg!(feature = "png")),
            ("a.mcap", "robot-log", cfg!(feature = "robot-log")),
        ] {
            let checked = check_ending(Path::new(name), &["parquet", "png", "mcap"], "a table or a figure", "");
            let refused = checked.err().map(|error| error.to_string());
            let expected =
                format!("{name}: expected a format of this build, found one that needs the feature `{feature}`");
            assert_eq!(refused, (!is_there).then_some(expected));
        }
        let other = check_ending(Path::new("a.txt"), &["csv"], "a table ending in .csv", "").unwrap_err();
        assert_eq!(other.to_string(), "a.txt: expected a table ending in .csv");
    }
}
