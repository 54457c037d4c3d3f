//! Finished parts of a sweep in a folder beside its table, so that a killed sweep goes on where it stopped.
//!
//! A part is a small table of some runs. It appears whole, by renaming, and its name holds the digest of its bytes: one that is damaged
//! is computed again. What the parts belong to stands in a manifest, which is written before the first of them.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

use palpate_files::parquet_table::{Field, Rows, TableError, TableReader, TableWriter};

use crate::failure::Failure;
use crate::files::{failure, lock_file, sha256, write_file};

const MANIFEST: &str = "sweep.txt";
const LOCK: &str = "lock";
/// Begin of temporary names.
const TEMPORARY: &str = ".palpate-";

/// The folder, which nobody else writes to while this exists.
pub(super) struct Parts {
    folder: PathBuf,
    fields: Vec<Field>,
    runs: u64,
    size: u64,
    done: BTreeMap<u64, PathBuf>,
    lock: File,
}

impl Parts {
    /// Opens or makes the folder beside the table `out`, for a sweep with this digest.
    pub(super) fn open(
        out: &Path,
        digest: &str,
        fields: Vec<Field>,
        runs: u64,
        restart: bool,
    ) -> Result<Self, Failure> {
        let folder = folder_of(out);
        let refused = |error: io::Error| failure(&folder, &error);
        fs::create_dir_all(&folder).map_err(refused)?;
        // Two sweeps into one folder would take each other's parts away.
        let lock = lock_file(&folder.join(LOCK), "sweep")?;
        let manifest = folder.join(MANIFEST);
        match fs::read_to_string(&manifest) {
            Ok(found) if found.trim() == digest => {}
            Ok(_) if !restart => {
                return Err(Failure::of_file(
                    &folder,
                    "expected parts of this sweep, found those of another: the protocol or palpate changed since",
                    Some("compute all runs with --restart, or name another table with --out".to_owned()),
                ));
            }
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(refused(error)),
            _ => {}
        }
        let mut parts = Self {
            folder,
            fields,
            runs,
            size: part_size(runs),
            done: BTreeMap::new(),
            lock,
        };
        parts.take_stock(restart)?;
        write_file(&manifest, format!("{digest}\n").as_bytes())?;
        Ok(parts)
    }

    /// Finds the parts that are whole, and takes away what is left of the others.
    fn take_stock(&mut self, restart: bool) -> Result<(), Failure> {
        let refused = |error: io::Error| failure(&self.folder, &error);
        let mut done = BTreeMap::new();
        for entry in fs::read_dir(&self.folder).map_err(refused)? {
            let path = entry.map_err(refused)?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let part = part_of(&name);
            if let (Some((part, digest)), false) = (part, restart)
                && part < self.count()
                && sha256(&path)?.starts_with(digest)
            {
                done.insert(part, path);
            } else if part.is_some() || name.starts_with(TEMPORARY) {
                fs::remove_file(&path).map_err(refused)?;
            }
        }
        self.done = done;
        Ok(())
    }

    /// How many parts the sweep has.
    pub(super) fn count(&self) -> u64 {
        self.runs.div_ceil(self.size)
    }

    /// The runs of a part.
    pub(super) fn runs_of(&self, part: u64) -> Range<u64> {
        part * self.size..self.runs.min((part + 1) * self.size)
    }

    /// The parts that are not done.
    pub(super) fn missing(&self) -> Vec<u64> {
        (0..self.count()).filter(|part| !self.done.contains_key(part)).collect()
    }

    /// How many runs were found done.
    pub(super) fn runs_done(&self) -> u64 {
        let runs = |part: &u64| {
            let runs = self.runs_of(*part);
            runs.end - runs.start
        };
        self.done.keys().map(runs).sum()
    }

    /// Writes a part, whole or not at all, and returns its path.
    ///
    /// It need not reach the disk before the next one is begun: what a power cut damages, its digest gives away.
    pub(super) fn write(&self, part: u64, rows: Rows) -> Result<PathBuf, Failure> {
        let place = || -> Result<(tempfile::NamedTempFile, String), Failure> {
            let refused = |error: TableError| table_failure(&self.folder, &error);
            let temporary = tempfile::Builder::new().prefix(TEMPORARY).tempfile_in(&self.folder);
            let temporary = temporary.map_err(|error| failure(&self.folder, &error))?;
            let mut writer = TableWriter::new(temporary.as_file(), &self.fields).map_err(refused)?;
            writer.write(rows).map_err(refused)?;
            writer.finish(&[]).map_err(refused)?;
            let digest = sha256(temporary.path())?;
            Ok((temporary, digest))
        };
        let (temporary, digest) = place()?;
        let path = self.folder.join(format!("part-{part:07}-{}.parquet", &digest[..16]));
        temporary.persist(&path).map_err(|error| failure(&path, &error.error))?;
        Ok(path)
    }

    /// Takes the paths of parts that were written since.
    pub(super) fn add(&mut self, written: impl IntoIterator<Item = (u64, PathBuf)>) {
        self.done.extend(written);
    }

    /// Hands the rows of all parts to `take`, in the order of the runs, one part in memory at a time.
    pub(super) fn each(&self, mut take: impl FnMut(Rows) -> Result<(), TableError>) -> Result<(), TableError> {
        for path in self.done.values() {
            let table = TableReader::new(File::open(path)?)?;
            for group in 0..table.groups() {
                take(table.read(group)?)?;
            }
        }
        Ok(())
    }

    /// Takes the folder away; files that others put there stay, and so does the folder then.
    pub(super) fn remove(self) -> Result<(), Failure> {
        let Self { folder, done, lock, .. } = self;
        let gone = |path: &Path| match fs::remove_file(path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(failure(path, &error)),
            _ => Ok(()),
        };
        for path in done.values() {
            gone(path)?;
        }
        gone(&folder.join(MANIFEST))?;
        drop(lock);
        gone(&folder.join(LOCK))?;
        // Whatever else lies there is not ours.
        let _ = fs::remove_dir(&folder);
        Ok(())
    }
}

/// The folder of the parts of a table.
pub(super) fn folder_of(out: &Path) -> PathBuf {
    let mut name = out.as_os_str().to_owned();
    name.push(".parts");
    PathBuf::from(name)
}

/// Whether there are parts beside the table `out`, and they are of the sweep with this digest.
pub(super) fn belong(out: &Path, digest: &str) -> bool {
    fs::read_to_string(folder_of(out).join(MANIFEST)).is_ok_and(|found| found.trim() == digest)
}

/// A failure of a table at `path`.
pub(super) fn table_failure(path: &Path, error: &TableError) -> Failure {
    match error {
        TableError::Io(error) => failure(path, error),
        error => Failure::of_file(path, error, Some("compute all runs again with --restart".to_owned())),
    }
}

/// Runs of a part: about a thousand parts, none of them too small to be worth a file or too large to be lost.
fn part_size(runs: u64) -> u64 {
    (runs / 1024).next_power_of_two().clamp(16, 8192)
}

/// Number and digest in the name of a part.
fn part_of(name: &str) -> Option<(u64, &str)> {
    let (part, digest) = name.strip_prefix("part-")?.strip_suffix(".parquet")?.split_once('-')?;
    let whole = digest.len() == 16 && digest.chars().all(|c| c.is_ascii_hexdigit());
    Some((part.parse().ok()?, digest)).filter(|_| whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_parts() {
        assert_eq!(part_of("part-0000012-0123456789abcdef.parquet"), Some((12, "0123456789abcdef")));
        for name in ["part-12.parquet", "part-x-0123456789abcdef.parquet", "part-1-01.parquet", "lock", "sweep.txt"] {
            assert_eq!(part_of(name), None, "{name}");
        }
    }

    #[test]
    fn parts_are_neither_tiny_nor_huge() {
        let sizes = [1, 450, 100_000, 1_000_000, 10_000_000].map(part_size);
        assert_eq!(sizes, [16, 16, 128, 1024, 8192]);
    }
}
