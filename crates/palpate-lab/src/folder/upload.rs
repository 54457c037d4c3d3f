//! A file that arrives piece by piece, and appears once it is whole.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, BufRead, BufReader, Write};
use std::path::Path;
use std::sync::{MutexGuard, PoisonError};

use palpate_jobs::output::{Stage, StagedFile, unwritten};
use palpate_jobs::{ErrorKind, JobError};

use super::Folder;
use super::names::plain;

/// The largest file that is taken, in bytes (4 GiB): four times what the longest record of the readers takes as text.
const LARGEST: u64 = 4 << 30;

/// A file on its way.
pub(crate) struct Upload<'f> {
    stage: Stage,
    file: StagedFile,
    bytes: u64,
    /// The name that the browser sent, and the one that the file gets.
    wanted: String,
    name: Reserved<'f>,
}

/// A name that no other upload takes.
struct Reserved<'f> {
    folder: &'f Folder,
    name: String,
}

impl Drop for Reserved<'_> {
    fn drop(&mut self) {
        self.folder.arriving().remove(&self.name);
    }
}

impl Folder {
    /// Begins a file by the name that a browser sent; one that is taken gets a number.
    ///
    /// # Errors
    /// [`JobError`] where the operating system takes no file there.
    pub(crate) fn upload(&self, sent: &str) -> Result<Upload<'_>, JobError> {
        let wanted = plain(sent);
        let name = self.reserved(&wanted);
        let mut stage = Stage::default();
        let file = stage.open(&self.path().join(&name.name))?;
        Ok(Upload {
            stage,
            file,
            bytes: 0,
            wanted,
            name,
        })
    }

    fn arriving(&self) -> MutexGuard<'_, BTreeSet<String>> {
        self.arriving.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A name that no file has and no upload is about to take.
    fn reserved(&self, name: &str) -> Reserved<'_> {
        let mut arriving = self.arriving();
        let path = Path::new(name);
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let ending = path.extension().map(|ending| format!(".{}", ending.to_string_lossy())).unwrap_or_default();
        let numbered = (2..).map(|number| format!("{stem}-{number}{ending}"));
        let is_free = |name: &String| !arriving.contains(name) && !self.path().join(name).exists();
        let name = std::iter::once(name.to_owned()).chain(numbered).find(is_free).unwrap_or_default();
        arriving.insert(name.clone());
        Reserved { folder: self, name }
    }
}

impl Upload<'_> {
    /// Takes the next piece.
    ///
    /// # Errors
    /// [`JobError`] where the file is larger than any that is taken, or the disk is full.
    pub(crate) fn write(&mut self, piece: &[u8]) -> Result<(), JobError> {
        self.bytes += piece.len() as u64;
        if self.bytes > LARGEST {
            let message = format!("expected a file of at most {} GiB, found more", LARGEST >> 30);
            let hint = "start the lab in the folder where the file lies";
            return Err(JobError::new(ErrorKind::Record, message, hint.to_owned()).of(&self.wanted));
        }
        let place = self.name.folder.path().join(&self.wanted);
        self.file.write_all(piece).map_err(|error| unwritten(&place, &error))
    }

    /// The file is whole: it appears, and its name is returned. Where a file of the wanted name is there already, byte by byte the same, it
    /// stands for this one.
    ///
    /// # Errors
    /// [`JobError`] where it cannot be put into its place.
    pub(crate) fn finish(mut self) -> Result<String, JobError> {
        self.stage.take(self.file)?;
        self.stage.commit()?;
        let path = |name: &str| self.name.folder.path().join(name);
        let name = &self.name.name;
        if *name != self.wanted && is_alike(&path(name), &path(&self.wanted)).unwrap_or(false) {
            let _ = fs::remove_file(path(name));
            return Ok(self.wanted.clone());
        }
        Ok(name.clone())
    }
}

/// Whether two files hold the same bytes.
fn is_alike(one: &Path, other: &Path) -> io::Result<bool> {
    if fs::metadata(one)?.len() != fs::metadata(other)?.len() {
        return Ok(false);
    }
    let [mut one, mut other] = [fs::File::open(one)?, fs::File::open(other)?].map(BufReader::new);
    loop {
        let (a, b) = (one.fill_buf()?, other.fill_buf()?);
        let length = a.len().min(b.len());
        if length == 0 || a[..length] != b[..length] {
            return Ok(a.is_empty() && b.is_empty());
        }
        one.consume(length);
        other.consume(length);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sent(folder: &Folder, name: &str, bytes: &[u8]) -> String {
        let mut upload = folder.upload(name).unwrap();
        upload.write(bytes).unwrap();
        upload.finish().unwrap()
    }

    #[test]
    fn an_upload_overwrites_nothing_and_leaves_nothing_half_written() {
        let place = tempfile::tempdir().unwrap();
        let folder = Folder::open(Some(place.path())).unwrap();
        assert_eq!(sent(&folder, "../ball.csv", b"1"), "ball.csv");
        // The same file again is that file; another of its name gets a number.
        assert_eq!(sent(&folder, "ball.csv", b"1"), "ball.csv");
        assert_eq!(sent(&folder, "ball.csv", b"2"), "ball-2.csv");
        assert_eq!(fs::read(place.path().join("ball.csv")).unwrap(), b"1");
        let (mut one, mut other) = (folder.upload("new.csv").unwrap(), folder.upload("new.csv").unwrap());
        one.write(b"a").unwrap();
        other.write(b"b").unwrap();
        drop(one);
        assert_eq!(other.finish().unwrap(), "new-2.csv");
        let mut left: Vec<_> = fs::read_dir(place.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        left.sort();
        assert_eq!(left, ["ball-2.csv", "ball.csv", "new-2.csv"]);
    }
}
