//! What can be resumed: finished pieces of long work, in a folder beside the table that they are for.
//!
//! The folder holds a lock and one file. Its first line says what the pieces depend on. Every piece follows as a line with its key, length
//! and digest, and its bytes. Every line begins with the digest of the rest of it. A line or a piece counts only if it is whole; work that
//! was killed goes on with the pieces that are missing or damaged.

use std::collections::HashMap;
use std::fmt;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use palpate_files::faults::{Operation, before};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::output::{sha256, unwritten};
use crate::{ErrorKind, JobError};

const PIECES: &str = "pieces";
const LOCK: &str = "lock";

/// The pieces, which nobody else writes while this exists.
pub(crate) struct Store {
    folder: PathBuf,
    found: HashMap<String, Range<u64>>,
    file: Mutex<(File, u64)>,
    lock: File,
}

/// The first line.
#[derive(PartialEq, Serialize, Deserialize)]
struct Head {
    palpate: String,
    depends_on_sha256: String,
}

/// The line before a piece.
#[derive(Serialize, Deserialize)]
struct PieceHead {
    key: String,
    bytes: u64,
    sha256: String,
}

impl Store {
    /// Opens or makes the store in `folder`, for pieces of some `work` that depend on what has this digest; pieces of other work are taken
    /// away, and so are all of them with `restart`.
    pub(crate) fn open(folder: &Path, work: &str, digest: &str, restart: bool) -> Result<Self, JobError> {
        let refused = |error: io::Error| unstored(folder, &error);
        before(Operation::MakeFolder).and_then(|()| fs::create_dir_all(folder)).map_err(refused)?;
        let lock = locked(&folder.join(LOCK), work)?;
        let mut options = OpenOptions::new();
        let options = options.read(true).write(true).create(true).truncate(restart);
        let file = before(Operation::Create).and_then(|()| options.open(folder.join(PIECES))).map_err(refused)?;
        let head = Head {
            palpate: work.to_owned(),
            depends_on_sha256: digest.to_owned(),
        };
        let (found, end) = stock(&file, &head).map_err(refused)?;
        let store = Self {
            folder: folder.to_owned(),
            found,
            file: Mutex::new((file, end)),
            lock,
        };
        if end == 0 {
            store.append(&line(&head)?)?;
        }
        Ok(store)
    }

    /// Where a piece lies that was there when the store was opened.
    pub(crate) fn find(&self, key: &str) -> Option<Range<u64>> {
        self.found.get(key).cloned()
    }

    /// The keys of all pieces that were there when the store was opened.
    pub(crate) fn keys(&self) -> impl Iterator<Item = &str> {
        self.found.keys().map(String::as_str)
    }

    /// Adds a piece and returns where it lies.
    ///
    /// It need not reach the disk before the next one: what a power cut damages, its digest gives away.
    pub(crate) fn add(&self, key: &str, piece: &[u8]) -> Result<Range<u64>, JobError> {
        let mut bytes = line(&PieceHead {
            key: key.to_owned(),
            bytes: piece.len() as u64,
            sha256: sha256(piece),
        })?;
        let before = bytes.len() as u64;
        bytes.extend_from_slice(piece);
        bytes.push(b'\n');
        let from = self.append(&bytes)? + before;
        Ok(from..from + piece.len() as u64)
    }

    /// The piece at a place.
    pub(crate) fn read(&self, place: &Range<u64>) -> Result<Vec<u8>, JobError> {
        let (file, _) = &mut *self.file();
        let mut piece = Vec::new();
        let read = file.seek(SeekFrom::Start(place.start));
        let read = read.and_then(|_| file.take(place.end - place.start).read_to_end(&mut piece));
        read.map_err(|error| JobError::unread(&self.folder, &error))?;
        Ok(piece)
    }

    /// Why a piece says nothing: somebody else has written over it, where locks do not hold.
    pub(crate) fn damaged(&self, error: &dyn fmt::Display) -> JobError {
        let message = format!("expected what this run had finished, found something else ({error})");
        let hint = "run it again, and let no other process work in this folder: its file system does not keep locks";
        JobError::new(ErrorKind::File(io::ErrorKind::InvalidData), message, hint.to_owned()).of(self.folder.display())
    }

    /// Takes the store away; files that others put there stay, and so does the folder then.
    pub(crate) fn remove(self) -> Result<(), JobError> {
        let Self { folder, lock, .. } = self;
        let gone = |name: &str| match fs::remove_file(folder.join(name)) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(unwritten(&folder, &error)),
            _ => Ok(()),
        };
        gone(PIECES)?;
        drop(lock);
        gone(LOCK)?;
        // Whatever else lies there is not ours.
        let _ = fs::remove_dir(&folder);
        Ok(())
    }

    fn file(&self) -> MutexGuard<'_, (File, u64)> {
        self.file.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes behind the last whole piece, over what a kill may have left of one, and returns where that begins.
    fn append(&self, bytes: &[u8]) -> Result<u64, JobError> {
        let (file, end) = &mut *self.file();
        let from = *end;
        let written = before(Operation::Write).and_then(|()| file.seek(SeekFrom::Start(from)));
        let written = written.and_then(|_| file.write_all(bytes));
        let written = written.and_then(|()| file.set_len(from + bytes.len() as u64));
        written.map_err(|error| unstored(&self.folder, &error))?;
        *end = from + bytes.len() as u64;
        Ok(from)
    }
}

/// Whether a folder is a store.
pub(crate) fn is_store(folder: &Path) -> bool {
    folder.join(PIECES).is_file()
}

/// What the pieces in a folder depend on, if there are any: a store whose first line is not whole has none.
pub(crate) fn depends_on(folder: &Path) -> Option<String> {
    let mut first = Vec::new();
    BufReader::new(File::open(folder.join(PIECES)).ok()?).read_until(b'\n', &mut first).ok()?;
    stated::<Head>(&first).map(|head| head.depends_on_sha256)
}

/// A name with this ending more, beside a table.
pub(crate) fn beside(table: &Path, ending: &str) -> PathBuf {
    let mut name = table.as_os_str().to_owned();
    name.push(ending);
    PathBuf::from(name)
}

/// Where the whole pieces lie by their keys, and where the next one goes; 0 where there is no store yet, or one for something else.
fn stock(file: &File, head: &Head) -> io::Result<(HashMap<String, Range<u64>>, u64)> {
    let (mut reader, mut found, mut end) = (BufReader::new(file), HashMap::new(), 0);
    loop {
        let mut line = Vec::new();
        let from = end + reader.read_until(b'\n', &mut line)? as u64;
        if line.last() != Some(&b'\n') {
            return Ok((found, end));
        }
        if end == 0 {
            if stated::<Head>(&line).as_ref() != Some(head) {
                return Ok((found, 0));
            }
            end = from;
            continue;
        }
        let Some(about) = stated::<PieceHead>(&line) else {
            return Ok((found, end));
        };
        let mut piece = Vec::new();
        reader.by_ref().take(about.bytes.saturating_add(1)).read_to_end(&mut piece)?;
        if piece.pop() != Some(b'\n') || piece.len() as u64 != about.bytes {
            return Ok((found, end));
        }
        end = from + about.bytes + 1;
        if sha256(&piece) == about.sha256 {
            found.insert(about.key, from..end - 1);
        }
    }
}

/// Why nothing can be added: what is there stays.
fn unstored(path: &Path, error: &io::Error) -> JobError {
    let mut refused = unwritten(path, error);
    if matches!(error.kind(), io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded) {
        refused.hint = Some("free some space and run it again: it goes on from what is finished".to_owned());
    }
    refused
}

/// A line that states something, behind the digest of it.
fn line(value: &impl Serialize) -> Result<Vec<u8>, JobError> {
    let stated = serde_json::to_string(value)?;
    Ok(format!("{} {stated}\n", sha256(stated.as_bytes())).into_bytes())
}

/// What a line states, if it is whole.
fn stated<T: DeserializeOwned>(line: &[u8]) -> Option<T> {
    let line = std::str::from_utf8(line).ok()?;
    let (digest, stated) = line.strip_suffix('\n')?.split_once(' ')?;
    (sha256(stated.as_bytes()) == digest).then(|| serde_json::from_str(stated).ok())?
}

/// A file that only one `work` can hold at a time.
fn locked(path: &Path, work: &str) -> Result<File, JobError> {
    let file = File::create(path).map_err(|error| unstored(path, &error))?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(JobError::new(
            ErrorKind::File(io::ErrorKind::WouldBlock),
            format!("expected no other running {work} here, found one"),
            "wait for it, or choose another ⟨out⟩".to_owned(),
        )
        .of(path.display())),
        // A file system without locks: better without than not at all.
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(file),
        Err(TryLockError::Error(error)) => Err(unwritten(path, &error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(folder: &Path, digest: &str) -> Store {
        Store::open(folder, "test", digest, false).unwrap()
    }

    #[test]
    fn a_store_cut_off_at_any_byte_keeps_its_whole_pieces() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().join("table.parts");
        let store = opened(&folder, "d");
        let ends = ["a", "b", "c"].map(|key| store.add(key, &[0, b'\n', 255]).unwrap().end + 1);
        drop(store);
        let whole = fs::read(folder.join(PIECES)).unwrap();
        for length in 0..=whole.len() {
            fs::write(folder.join(PIECES), &whole[..length]).unwrap();
            let store = opened(&folder, "d");
            for (key, end) in ["a", "b", "c"].iter().zip(ends) {
                assert_eq!(store.find(key).is_some(), length as u64 >= end, "{key} of {length} bytes");
            }
            let place = store.add("later", b"piece").unwrap();
            assert_eq!(store.read(&place).unwrap(), b"piece");
        }
    }

    #[test]
    fn a_damaged_piece_is_missing_and_the_others_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let store = opened(folder.path(), "d");
        let places = ["a", "b"].map(|key| store.add(key, key.as_bytes()).unwrap());
        drop(store);
        let mut bytes = fs::read(folder.path().join(PIECES)).unwrap();
        bytes[usize::try_from(places[0].start).unwrap()] ^= 1;
        fs::write(folder.path().join(PIECES), bytes).unwrap();
        let store = opened(folder.path(), "d");
        assert_eq!((store.find("a"), store.find("b")), (None, Some(places[1].clone())));
        assert_eq!(store.read(&store.add("a", b"a").unwrap()).unwrap(), b"a");
    }

    #[test]
    fn a_line_of_which_one_byte_is_another_one_counts_for_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let store = opened(folder.path(), "d");
        let places = ["a", "b"].map(|key| store.add(key, key.as_bytes()).unwrap());
        drop(store);
        let whole = fs::read(folder.path().join(PIECES)).unwrap();
        let first = whole.iter().position(|byte| *byte == b'\n').unwrap();
        for at in (0..whole.len()).step_by(7) {
            let mut damaged = whole.clone();
            damaged[at] ^= 1;
            fs::write(folder.path().join(PIECES), &damaged).unwrap();
            let store = opened(folder.path(), "d");
            let found = ["a", "b"].map(|key| store.find(key));
            // Behind a damaged line nothing can be found; a damaged piece is missing alone.
            let expected = match at as u64 {
                at if at <= first as u64 => [None, None],
                at if at < places[0].start => [None, None],
                at if at < places[0].end => [None, Some(places[1].clone())],
                _ => [Some(places[0].clone()), None],
            };
            assert_eq!(found, expected, "byte {at}");
        }
    }

    #[test]
    fn pieces_of_other_work_count_for_nothing_and_two_works_do_not_meet() {
        let folder = tempfile::tempdir().unwrap();
        let store = opened(folder.path(), "one");
        store.add("a", b"1").unwrap();
        assert!(Store::open(folder.path(), "test", "one", false).is_err());
        drop(store);
        assert_eq!(depends_on(folder.path()).as_deref(), Some("one"));
        assert!(opened(folder.path(), "one").find("a").is_some());
        assert!(opened(folder.path(), "two").find("a").is_none());
        assert!(opened(folder.path(), "one").find("a").is_none());
        opened(folder.path(), "one").remove().unwrap();
        assert!(!folder.path().exists());
    }
}
