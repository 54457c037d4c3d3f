//! What is done, line by line in a file of a folder beside the table, so that a batch that was killed goes on where it stopped.
//!
//! The first line says what the results depend on. Every further line holds all rows of one file, or why there are
//! none; it is valid only if it is whole, and it counts only for a file of the same bytes. The journal stays when
//! the table is written, so that files which are added later are all that is computed then.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::failure::Failure;
use crate::files::{failure, lock_file};

const RESULTS: &str = "results.jsonl";
/// Begin of temporary names.
const TEMPORARY: &str = ".palpate-";

/// What came of one file.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Entry {
    /// Path as given.
    pub(super) path: String,
    /// Its digest; `None` where it could not be read.
    pub(super) sha256: Option<String>,
    /// Rows of the table.
    pub(super) rows: Vec<Vec<Value>>,
    /// The tests that gave none, with why.
    pub(super) failures: Vec<Refused>,
    /// How many tests there are in the file.
    pub(super) tests: usize,
}

/// A test that could not be analysed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Refused {
    /// What is wrong, with the path.
    pub(super) message: String,
    /// What would help.
    pub(super) hint: Option<String>,
}

/// The journal, which nobody else writes to while this exists.
pub(super) struct Journal {
    path: PathBuf,
    file: File,
    known: Known,
    end: u64,
    _lock: File,
}

/// Where the whole entries of a journal lie, by path and digest.
#[derive(Debug, Clone, Default)]
pub(super) struct Known(HashMap<(String, String), Range<u64>>);

impl Known {
    /// Where the entry of a file of these bytes lies, if it is done.
    pub(super) fn find(&self, path: &str, sha256: &str) -> Option<Range<u64>> {
        self.0.get(&(path.to_owned(), sha256.to_owned())).cloned()
    }
}

/// The first line.
#[derive(Serialize, Deserialize)]
struct Head {
    palpate_batch: String,
}

impl Journal {
    /// Opens or makes the journal beside the table `out`, for results that depend on `digest`.
    pub(super) fn open(out: &Path, digest: &str, restart: bool) -> Result<Self, Failure> {
        let folder = folder_of(out);
        let path = folder.join(RESULTS);
        let refused = |error: io::Error| failure(&path, &error);
        fs::create_dir_all(&folder).map_err(refused)?;
        let lock = lock_file(&folder.join("lock"), "batch")?;
        // What a kill left of a table that was being written.
        for entry in fs::read_dir(&folder).map_err(refused)?.flatten() {
            if entry.file_name().to_string_lossy().starts_with(TEMPORARY) {
                fs::remove_file(entry.path()).map_err(refused)?;
            }
        }
        let mut options = OpenOptions::new();
        let file = options.read(true).write(true).create(true).truncate(restart).open(&path).map_err(refused)?;
        let mut journal = Self {
            path,
            file,
            known: Known::default(),
            end: 0,
            _lock: lock,
        };
        if !journal.take_stock(digest)? {
            journal.begin(digest).map_err(|error| failure(&journal.path, &error))?;
        }
        Ok(journal)
    }

    /// Finds the entries that are whole; `false` where there is no journal yet, or one of other settings.
    fn take_stock(&mut self, digest: &str) -> Result<bool, Failure> {
        let mut reader = BufReader::new(&self.file);
        let (mut line, mut from) = (Vec::new(), 0);
        let mut places = HashMap::new();
        let mut end = 0;
        loop {
            line.clear();
            let length = reader.read_until(b'\n', &mut line).map_err(|error| failure(&self.path, &error))? as u64;
            // The last line may have been cut off.
            if length == 0 || line.last() != Some(&b'\n') {
                break;
            }
            if from == 0 {
                let head: Option<Head> = serde_json::from_slice(&line).ok();
                if head.is_none_or(|head| head.palpate_batch != digest) {
                    return Ok(false);
                }
            } else if let Ok(entry) = serde_json::from_slice::<Entry>(&line)
                && let Some(sha256) = entry.sha256
            {
                places.insert((entry.path, sha256), from..from + length);
            }
            from += length;
            end = from;
        }
        (self.known, self.end) = (Known(places), end);
        Ok(end > 0)
    }

    fn begin(&mut self, digest: &str) -> io::Result<()> {
        let head = serde_json::to_string(&Head {
            palpate_batch: digest.to_owned(),
        })?;
        let head = format!("{head}\n");
        self.file.set_len(0)?;
        self.file.seek(SeekFrom::Start(0))?;
        self.file.write_all(head.as_bytes())?;
        self.end = head.len() as u64;
        Ok(())
    }

    /// What was done when the journal was opened.
    pub(super) fn known(&self) -> Known {
        self.known.clone()
    }

    /// Adds an entry and returns where it lies.
    pub(super) fn add(&mut self, line: &[u8]) -> Result<Range<u64>, Failure> {
        let place = self.end..self.end + line.len() as u64;
        let write = |file: &mut File| -> io::Result<()> {
            // Over what a kill may have left of a line.
            file.seek(SeekFrom::Start(place.start))?;
            file.write_all(line)?;
            file.set_len(place.end)
        };
        write(&mut self.file).map_err(|error| failure(&self.path, &error))?;
        self.end = place.end;
        Ok(place)
    }

    /// The entry at a place.
    pub(super) fn read(&mut self, place: &Range<u64>) -> Result<Entry, Failure> {
        let mut line = Vec::new();
        let mut read = || -> io::Result<()> {
            self.file.seek(SeekFrom::Start(place.start))?;
            (&self.file).take(place.end - place.start).read_to_end(&mut line)?;
            Ok(())
        };
        read().map_err(|error| failure(&self.path, &error))?;
        serde_json::from_slice(&line).map_err(|error| {
            let hint = "analyse all records again with --restart";
            Failure::of_file(&self.path, format!("expected a result, found {error}"), Some(hint.to_owned()))
        })
    }
}

/// Whether a folder is a journal, going by its name and what is in it.
pub(super) fn is_journal(folder: &Path) -> bool {
    folder.extension().is_some_and(|ending| ending == "journal") && folder.join(RESULTS).is_file()
}

/// The folder of the journal of a table.
pub(super) fn folder_of(out: &Path) -> PathBuf {
    let mut name = out.as_os_str().to_owned();
    name.push(".journal");
    PathBuf::from(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(path: &str, sha256: &str) -> Vec<u8> {
        let entry = Entry {
            path: path.to_owned(),
            sha256: Some(sha256.to_owned()),
            rows: vec![vec![0.1.into(), "text".into(), Value::Null]],
            failures: Vec::new(),
            tests: 1,
        };
        let mut line = serde_json::to_vec(&entry).unwrap();
        line.push(b'\n');
        line
    }

    #[test]
    fn a_journal_cut_off_at_any_byte_keeps_its_whole_entries() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("table.csv");
        let mut journal = Journal::open(&out, "d", false).unwrap();
        let ends = ["a", "b", "c"].map(|name| journal.add(&entry(name, "1")).unwrap().end);
        drop(journal);
        let whole = fs::read(folder_of(&out).join(RESULTS)).unwrap();
        for length in 0..=whole.len() {
            fs::write(folder_of(&out).join(RESULTS), &whole[..length]).unwrap();
            let mut journal = Journal::open(&out, "d", false).unwrap();
            for (name, end) in ["a", "b", "c"].iter().zip(ends) {
                assert_eq!(journal.known().find(name, "1").is_some(), length as u64 >= end, "{name} of {length} bytes");
            }
            let place = journal.add(&entry("later", "1")).unwrap();
            assert_eq!(journal.read(&place).unwrap().path, "later");
        }
    }

    #[test]
    fn other_settings_and_other_bytes_count_for_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("table.csv");
        let mut journal = Journal::open(&out, "one", false).unwrap();
        journal.add(&entry("a", "1")).unwrap();
        assert!(journal.known().find("a", "2").is_none() && journal.known().find("b", "1").is_none());
        let busy = Journal::open(&out, "one", false);
        assert!(busy.is_err());
        drop(journal);
        assert!(Journal::open(&out, "one", false).unwrap().known().find("a", "1").is_some());
        assert!(Journal::open(&out, "two", false).unwrap().known().find("a", "1").is_none());
        assert!(Journal::open(&out, "one", false).unwrap().known().find("a", "1").is_none());
    }
}
