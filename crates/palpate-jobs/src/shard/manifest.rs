//! What a finished slice says of itself.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::{Places, Shard};
use crate::output::file_sha256;
use crate::{ErrorKind, JobError};

/// A table of a slice.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum ShardTable {
    Parameters,
    Failures,
    /// The last to appear.
    Rows,
}

impl ShardTable {
    pub(super) fn folder(self) -> &'static str {
        match self {
            Self::Parameters => "parameters",
            Self::Failures => "failures",
            Self::Rows => "table",
        }
    }
}

/// Where a slice ends within a file that the next one goes on with.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Cut {
    /// The index of the file among all.
    pub(crate) file: usize,
    /// Its digest.
    pub(crate) sha256: Option<String>,
    /// How many tests it has.
    pub(crate) tests: usize,
    /// The first test behind the cut, from 0.
    pub(crate) at: usize,
}

/// What a finished slice says of itself: what its tables depend on, and their digests.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Manifest {
    /// `batch` or `sweep`.
    pub(crate) job: String,
    pub(crate) shard: Shard,
    /// Version, build, description and options, as they stand in the table of all.
    pub(crate) settings: String,
    /// Digest of the names and sizes of all files; of a sweep, of its protocol.
    pub(crate) plan_sha256: String,
    /// Files of the batch in all; runs of the sweep in all.
    pub(crate) total: u64,
    /// Digest of the files of the slice by name and content.
    pub(crate) inputs_sha256: Option<String>,
    /// Tests of the slice; runs of a sweep.
    pub(crate) tests: usize,
    /// Rows of its table.
    pub(crate) rows: usize,
    /// Tests without rows; runs that were refused.
    pub(crate) failed: usize,
    /// Whether laws were compared.
    pub(crate) compared: bool,
    /// Whether every failure would stay one if the slice were computed again.
    pub(crate) is_lasting: bool,
    /// Where it begins in a file that the slice before ends in.
    pub(crate) start: Option<Cut>,
    /// Where it ends in a file that the next one begins with.
    pub(crate) end: Option<Cut>,
    /// SHA-256 of its tables.
    pub(crate) tables: BTreeMap<ShardTable, String>,
}

impl Manifest {
    /// The manifest at `path`.
    fn read(path: &Path) -> Result<Self, JobError> {
        let bytes = fs::read(path).map_err(|error| JobError::unread(path, &error))?;
        serde_json::from_slice(&bytes).map_err(|error| {
            let message = format!("expected the manifest of a shard ({error})");
            JobError::option(message, "run that shard again with this version of palpate").of(path.display())
        })
    }

    /// Refuses tables that are not those which the slice wrote.
    pub(crate) fn check_tables(&self, places: Places<'_>) -> Result<(), JobError> {
        for (table, sha256) in &self.tables {
            let path = places.table(*table);
            let found = file_sha256(&path);
            let is_missing = |error: &JobError| error.kind == ErrorKind::File(io::ErrorKind::NotFound);
            if found.as_ref().is_err_and(is_missing) || &found? != sha256 {
                let message =
                    format!("expected the table that shard {} wrote, found none, another or a damaged one", self.shard);
                let hint = format!("run shard {} again: it is computed anew", self.shard);
                return Err(JobError::option(message, &hint).of(path.display()));
            }
        }
        Ok(())
    }
}

impl Places<'_> {
    /// Refuses a folder with finished slices of other work.
    pub(crate) fn check_job(&self, job: &str) -> Result<(), JobError> {
        // They are of one work, unless somebody has put them there: one shows it, beside that in the same place.
        let any = fs::read_dir(self.folder.join("shards")).ok().and_then(|mut entries| entries.find_map(json));
        match [Some(self.manifest()), any].into_iter().flatten().find_map(|path| Manifest::read(&path).ok()) {
            Some(found) if found.job != job => {
                let message = format!("expected a folder for shards of a {job}, found those of a {}", found.job);
                Err(JobError::option(message, "choose another folder with ⟨out⟩").of(self.folder.display()))
            }
            _ => Ok(()),
        }
    }
}

/// What a slice says of itself, if it was finished and its tables are whole.
pub(crate) fn finished(places: Places<'_>) -> Option<Manifest> {
    let manifest = Manifest::read(&places.manifest()).ok()?;
    manifest.check_tables(places).ok()?;
    (manifest.shard == places.shard).then_some(manifest)
}

/// The path of an entry of a folder, if it is a file of JSON.
fn json(entry: io::Result<fs::DirEntry>) -> Option<PathBuf> {
    let path = entry.ok()?.path();
    (path.extension().is_some_and(|ending| ending == "json") && path.is_file()).then_some(path)
}

/// The manifests in the folder of a work, in no order.
pub(crate) fn manifests(folder: &Path) -> Result<Vec<(PathBuf, Manifest)>, JobError> {
    let shards = folder.join("shards");
    let entries = fs::read_dir(&shards).and_then(Iterator::collect::<Result<Vec<_>, _>>).map_err(|_| {
        let found = match folder.metadata() {
            Ok(about) if about.is_dir() => "a folder without shards",
            Ok(_) => "a file",
            Err(_) => "nothing under this name",
        };
        let message = format!("expected a folder that shards were written to, found {found}");
        JobError::option(message, "name the folder that the shards had as their ⟨out⟩").of(folder.display())
    })?;
    entries
        .into_iter()
        .filter_map(|entry| json(Ok(entry)))
        .map(|path| Ok((folder.to_owned(), Manifest::read(&path)?)))
        .collect()
}
