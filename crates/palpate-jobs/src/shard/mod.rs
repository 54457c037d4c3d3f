//! One of several slices of a batch or a sweep, each the work of one process, in a folder that all of them share.
//!
//! | file | what |
//! |---|---|
//! | `slice.rs` | which files, and which tests of them, a slice has ([`Slice`]) |
//! | `manifest.rs` | what a finished slice says of itself, and whether it still holds |
//!
//! ```text
//! holds/table/3-of-40.parquet        rows
//! holds/parameters/3-of-40.parquet   rows of the table of parameters (batch)
//! holds/failures/3-of-40.parquet     tests without rows (batch)
//! holds/shards/3-of-40.json          the manifest
//! holds/3-of-40.journal              what can be resumed, until the slice is finished
//! ```

mod manifest;
mod slice;

use std::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::JobError;
use crate::output::{check_folder, is_same, unwritten};
use crate::store::Store;
pub(crate) use manifest::{Cut, Manifest, ShardTable, finished, manifests};
pub use slice::Slice;

/// Most slices of one work.
const MOST: u32 = 1_000_000;

/// Which slice of how many: `3/40`, from `1/1` to `1000000/1000000`.
///
/// ```
/// use palpate_jobs::Shard;
///
/// let shard: Shard = "3/40".parse()?;
/// assert_eq!((shard.number(), shard.of(), shard.to_string()), (3, 40, "3/40".to_owned()));
/// assert!("0/40".parse::<Shard>().is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "String", into = "String")]
#[schemars(with = "String")]
pub struct Shard {
    of: u32,
    number: u32,
}

impl Shard {
    /// Its number, from 1.
    #[must_use]
    pub fn number(self) -> u32 {
        self.number
    }

    /// How many there are.
    #[must_use]
    pub fn of(self) -> u32 {
        self.of
    }

    /// All slices of so many, in order.
    ///
    /// # Errors
    /// What was expected, for none or too many.
    pub fn all(of: u32) -> Result<impl Iterator<Item = Self>, String> {
        format!("{of}/{of}").parse::<Self>()?;
        Ok((1..=of).map(move |number| Self { of, number }))
    }

    /// Its place in `total` things in a row: from where to where.
    pub(crate) fn range(self, total: u64) -> std::ops::Range<u64> {
        let end = |number: u32| (u128::from(total) * u128::from(number) / u128::from(self.of)) as u64;
        end(self.number - 1)..end(self.number)
    }

    fn name(self) -> String {
        format!("{}-of-{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || {
            format!("expected NUMBER/OF with NUMBER from 1 to OF, and OF at most {MOST}, such as 3/40; found {text:?}")
        };
        let (number, of) = text.trim().split_once('/').ok_or_else(expected)?;
        let [number, of] = [number, of].map(|part| part.parse::<u32>().ok());
        let (Some(number), Some(of)) = (number, of) else {
            return Err(expected());
        };
        if (1..=of).contains(&number) && of <= MOST { Ok(Self { of, number }) } else { Err(expected()) }
    }
}

impl TryFrom<String> for Shard {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Shard> for String {
    fn from(shard: Shard) -> Self {
        shard.to_string()
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

/// Whether a file lies, or would lie, among those of the slices in the folder of a work.
pub(crate) fn has_among_its_own(folder: &Path, file: &Path) -> bool {
    let names = [ShardTable::Rows, ShardTable::Parameters, ShardTable::Failures].map(ShardTable::folder);
    names
        .iter()
        .chain(&["shards"])
        .any(|name| file.parent().is_some_and(|own| is_same(&folder.join(name), own)))
}

/// Forgets one slice in the folder of all: what says that it is finished, and what it could go on from.
///
/// # Errors
/// [`JobError`] where another process is at it, or the files cannot be removed.
pub fn forget(folder: &Path, shard: Shard) -> Result<(), JobError> {
    let places = Places::new(folder, shard)?;
    let (journal, manifest) = (places.journal(), places.manifest());
    if !manifest.exists() && !journal.exists() {
        return Ok(());
    }
    let store = Store::open(&journal, "shard", "", true)?;
    match fs::remove_file(&manifest) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(unwritten(&manifest, &error)),
        _ => store.remove(),
    }
}

/// The files of one slice in the folder of all.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Places<'a> {
    pub(crate) folder: &'a Path,
    pub(crate) shard: Shard,
}

impl<'a> Places<'a> {
    /// In this folder, which is made where it is missing.
    pub(crate) fn new(folder: &'a Path, shard: Shard) -> Result<Self, JobError> {
        if folder.extension().is_some_and(|ending| ending == "parquet" || ending == "csv") {
            let hint = "name a folder for all shards, such as ⟨out=holds⟩; `palpate merge` makes one table of them";
            return Err(
                JobError::option("expected a folder for shards, found the name of a table", hint).of(folder.display())
            );
        }
        check_folder(folder)?;
        Ok(Self { folder, shard })
    }

    /// One of its tables.
    pub(crate) fn table(&self, table: ShardTable) -> PathBuf {
        self.folder.join(table.folder()).join(format!("{}.parquet", self.shard.name()))
    }

    /// What it says of itself.
    pub(crate) fn manifest(&self) -> PathBuf {
        self.folder.join("shards").join(format!("{}.json", self.shard.name()))
    }

    /// What can be resumed.
    pub(crate) fn journal(&self) -> PathBuf {
        self.folder.join(format!("{}.journal", self.shard.name()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_that_are_none_are_refused() {
        for text in ["", "3", "0/4", "5/4", "1/0", "-1/4", "1/4/2", "1.0/4", "1/1000001", "99999999999/99999999999"] {
            let refused = text.parse::<Shard>().unwrap_err();
            assert!(refused.contains("such as 3/40"), "{text}: {refused}");
        }
    }

    #[test]
    fn slices_of_things_in_a_row_meet_and_differ_by_one_at_most() {
        for (total, of) in [(0, 3), (1, 3), (7, 3), (1_000_000, 7), (u64::MAX, 1_000_000)] {
            let ranges: Vec<_> = Shard::all(of).unwrap().map(|shard| shard.range(total)).collect();
            assert_eq!((ranges[0].start, ranges[ranges.len() - 1].end), (0, total));
            assert!(ranges.windows(2).all(|pair| pair[0].end == pair[1].start));
            let sizes = ranges.iter().map(|range| range.end - range.start);
            assert!(sizes.clone().max().unwrap() - sizes.min().unwrap() <= 1);
        }
    }
}
