//! The one way out: files are written beside their targets and appear together, or none of them does.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use palpate_files::faults::{Operation, before};

use super::file_sha256;
use super::target::{check_regular, folder_of, unwritten};
use super::temporary::{Folders, TemporaryFolder, undisturbed};
use crate::JobError;

/// Files that are to appear together.
///
/// Each is written to a temporary folder beside its target and synced; [`commit`](Self::commit) renames all. A link is followed to what it
/// leads to. A new file has the permissions that the umask of the process leaves; one that replaces another has those of the other.
#[derive(Default)]
pub struct Stage {
    // Dropped in this order: the temporary folders before the folders that were made for them.
    temporaries: Vec<(PathBuf, TemporaryFolder)>,
    folders: Folders,
    opened: usize,
    files: Vec<Staged>,
    removed: Vec<PathBuf>,
}

struct Staged {
    /// As it was named.
    named: PathBuf,
    /// Where it goes, links followed.
    target: PathBuf,
    /// Where it lies now.
    written: PathBuf,
}

/// A file that is being written.
pub struct StagedFile {
    file: File,
    staged: Staged,
    /// Bytes that were written since the last were synced.
    unsynced: usize,
}

/// Bytes that are synced together: no process ends before a sync has, whatever signal it got, and a disk takes some 100 MB/s.
const SYNCED: usize = 8 << 20;

impl Write for StagedFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        before(Operation::Write)?;
        let written = self.file.write(&bytes[..bytes.len().min(SYNCED)])?;
        self.unsynced += written;
        if self.unsynced >= SYNCED {
            before(Operation::Sync)?;
            self.file.sync_data()?;
            self.unsynced = 0;
        }
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl StagedFile {
    /// What was written, to be read.
    ///
    /// # Errors
    /// Where it cannot be opened again.
    pub fn read(&self) -> io::Result<File> {
        File::open(&self.staged.written)
    }

    /// SHA-256 of what was written, hexadecimal.
    ///
    /// # Errors
    /// [`JobError`] where it cannot be read again.
    pub fn sha256(&self) -> Result<String, JobError> {
        file_sha256(&self.staged.written)
    }
}

impl Stage {
    /// Begins a file that is to appear at `path`.
    ///
    /// # Errors
    /// [`JobError`] where the operating system takes no file there.
    pub fn open(&mut self, path: &Path) -> Result<StagedFile, JobError> {
        let refused = |error: io::Error| unwritten(path, &error);
        let target = followed(path).map_err(refused)?;
        check_regular(&target, path)?;
        let folder = self.temporary(folder_of(&target)).map_err(refused)?;
        self.opened += 1;
        let written = folder.join(self.opened.to_string());
        before(Operation::Create).map_err(refused)?;
        let file = OpenOptions::new().write(true).create_new(true).open(&written).map_err(refused)?;
        let staged = Staged {
            named: path.to_owned(),
            target,
            written,
        };
        Ok(StagedFile {
            file,
            staged,
            unsynced: 0,
        })
    }

    /// Takes a file that is complete.
    ///
    /// # Errors
    /// [`JobError`] where it does not reach the disk.
    pub fn take(&mut self, file: StagedFile) -> Result<(), JobError> {
        let StagedFile { file, staged, .. } = file;
        like_before(&file, &staged.target);
        let synced = before(Operation::Sync).and_then(|()| file.sync_all());
        synced.map_err(|error| unwritten(&staged.named, &error))?;
        self.files.push(staged);
        Ok(())
    }

    /// Writes a file that is to appear at `path`.
    ///
    /// # Errors
    /// [`JobError`] where `write` fails, or the operating system takes no file there.
    pub fn file(
        &mut self,
        path: &Path,
        write: impl FnOnce(&mut StagedFile) -> Result<(), JobError>,
    ) -> Result<(), JobError> {
        let mut file = self.open(path)?;
        write(&mut file)?;
        self.take(file)
    }

    /// Writes a file of these bytes.
    ///
    /// # Errors
    /// As for [`file`](Self::file).
    pub fn bytes(&mut self, path: &Path, content: &[u8]) -> Result<(), JobError> {
        self.file(path, |file| file.write_all(content).map_err(|error| unwritten(path, &error)))
    }

    /// The file at `path` goes when the others appear.
    pub(super) fn remove(&mut self, path: PathBuf) {
        self.removed.push(path);
    }

    /// The temporary folder in `folder`, which is made where it is missing.
    fn temporary(&mut self, folder: &Path) -> io::Result<PathBuf> {
        if let Some((_, temporary)) = self.temporaries.iter().find(|(of, _)| of == folder) {
            return Ok(temporary.path().to_owned());
        }
        self.folders.make(folder)?;
        let temporary = TemporaryFolder::make(folder)?;
        let path = temporary.path().to_owned();
        self.temporaries.push((folder.to_owned(), temporary));
        Ok(path)
    }

    /// Puts all files into their places: all of them, or where that fails none.
    ///
    /// # Errors
    /// [`JobError`] with the file that could not be placed; those that were there before are there again.
    pub fn commit(self) -> Result<(), JobError> {
        let Self {
            temporaries,
            folders,
            files,
            removed,
            ..
        } = self;
        let guard = undisturbed().map_err(|_| JobError::from(palpate::watch::Cancelled))?;
        let mut done: Vec<Undo> = Vec::new();
        let moved = moved(&temporaries, &files, &removed, &mut done);
        if let Err((path, error)) = moved {
            done.into_iter().rev().for_each(Undo::undo);
            drop(guard);
            // Before the folders that were made for them.
            drop(temporaries);
            return Err(unwritten(&path, &error));
        }
        drop(guard);
        let made = folders.keep();
        let mut touched: Vec<PathBuf> = temporaries.iter().map(|(folder, _)| folder.clone()).collect();
        touched.extend(made.iter().map(|made| folder_of(made).to_owned()));
        drop(temporaries);
        for folder in touched {
            sync_folder(&folder).map_err(|error| unwritten(&folder, &error))?;
        }
        Ok(())
    }
}

/// What brings back the state before one step of a commit.
struct Undo {
    target: PathBuf,
    /// What was there.
    before: Option<PathBuf>,
}

impl Undo {
    fn undo(self) {
        let _ = match self.before {
            Some(before) => fs::rename(before, &self.target),
            None => fs::remove_file(&self.target),
        };
    }
}

/// Renames all files, with what is needed to undo it in `done`; or the path that failed.
fn moved(
    temporaries: &[(PathBuf, TemporaryFolder)],
    files: &[Staged],
    removed: &[PathBuf],
    done: &mut Vec<Undo>,
) -> Result<(), (PathBuf, io::Error)> {
    let temporary = |target: &Path| -> PathBuf {
        let folder = folder_of(target);
        let found = temporaries.iter().find(|(of, _)| of == folder);
        found.map_or(folder, |(_, temporary)| temporary.path()).to_owned()
    };
    // First what goes: a manifest among the files may be the last that knows of it.
    for (index, path) in removed.iter().enumerate().filter(|(_, path)| path.exists()) {
        // Out of the way, and gone with the temporary folder.
        let Some((_, temporary)) = temporaries.first() else {
            break;
        };
        let away = temporary.path().join(format!("removed-{index}"));
        before(Operation::Rename)
            .and_then(|()| fs::rename(path, &away))
            .map_err(|error| (path.clone(), error))?;
        done.push(Undo {
            target: path.clone(),
            before: Some(away),
        });
    }
    for (index, file) in files.iter().enumerate() {
        let failed = |error| (file.named.clone(), error);
        // The last step needs no way back.
        let needs_way_back = index + 1 < files.len() && file.target.exists();
        let before_it = needs_way_back.then(|| temporary(&file.target).join(format!("before-{index}")));
        if let Some(kept) = &before_it {
            kept_beside(&file.target, kept).map_err(failed)?;
        }
        before(Operation::Rename).and_then(|()| fs::rename(&file.written, &file.target)).map_err(failed)?;
        done.push(Undo {
            target: file.target.clone(),
            before: before_it,
        });
    }
    Ok(())
}

/// A second name for a file that is about to be replaced, or a copy where the file system knows no second names.
fn kept_beside(file: &Path, kept: &Path) -> io::Result<()> {
    fs::hard_link(file, kept).or_else(|_| {
        before(Operation::Write)?;
        fs::copy(file, kept).map(drop)
    })
}

/// Where a path leads, through links that lead to nothing yet, too.
fn followed(path: &Path) -> io::Result<PathBuf> {
    const MOST_LINKS: usize = 40;
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(to) => path = folder_of(&path).join(to),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("too many links"))
}

/// Gives a new file permissions and owner of the one that it replaces, as far as this user may.
#[cfg(unix)]
fn like_before(file: &File, target: &Path) {
    use std::os::unix::fs::{MetadataExt, fchown};
    let Ok(before) = fs::metadata(target) else { return };
    if file.metadata().is_ok_and(|about| about.uid() != before.uid() || about.gid() != before.gid()) {
        let _ = fchown(file, Some(before.uid()), Some(before.gid()));
    }
    let _ = file.set_permissions(before.permissions());
}

#[cfg(not(unix))]
fn like_before(_: &File, _: &Path) {}

/// Has the names in a folder reach the disk.
#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    before(Operation::Sync)?;
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        // Network file systems, and folders that may be written to and not read.
        Err(error)
            if matches!(
                error.kind(),
                io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported | io::ErrorKind::PermissionDenied
            ) =>
        {
            Ok(())
        }
        synced => synced,
    }
}

#[cfg(not(unix))]
fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use palpate_report::study::Bundle;

    use super::super::write_bundle;
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn files_appear_together_and_nothing_else_does() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let mut stage = Stage::default();
        stage.bytes(&at("a"), b"1").unwrap();
        stage.bytes(&at("new/deep/b"), b"2").unwrap();
        assert!(!at("a").exists());
        stage.commit().unwrap();
        assert_eq!((fs::read(at("a")).unwrap(), fs::read(at("new/deep/b")).unwrap()), (b"1".to_vec(), b"2".to_vec()));
        assert_eq!(
            (names(folder.path()), names(&at("new/deep"))),
            (vec!["a".to_owned(), "new".to_owned()], vec!["b".to_owned()])
        );
    }

    #[test]
    fn what_is_not_committed_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let mut stage = Stage::default();
        stage.bytes(&folder.path().join("new/deep/b"), b"2").unwrap();
        drop(stage);
        assert!(names(folder.path()).is_empty());
    }

    /// A kill before the last step left files of the run before, which no manifest knew any more.
    #[test]
    fn a_bundle_that_was_killed_at_any_step_leaves_nothing_to_the_next() {
        let bundle = |names: &[&str]| {
            let files: Vec<_> = names.iter().map(|name| ((*name).to_owned(), name.as_bytes().to_vec())).collect();
            Bundle::from(files)
        };
        for steps in 0..8 {
            let folder = tempfile::tempdir().unwrap();
            write_bundle(folder.path(), &bundle(&["old", "older", "same"])).unwrap();
            let mut stage = Stage::default();
            stage.bundle(folder.path(), &bundle(&["same", "killed"])).unwrap();
            let goes = steps.min(stage.removed.len());
            let comes = (steps - goes).min(stage.files.len());
            assert!(moved(&stage.temporaries, &stage.files[..comes], &stage.removed[..goes], &mut Vec::new()).is_ok());
            drop(stage);
            write_bundle(folder.path(), &bundle(&["next"])).unwrap();
            assert_eq!(names(folder.path()), [".palpate-files", "next"], "{steps}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_permissions_are_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let mode = |name: &str| fs::metadata(at(name)).unwrap().permissions().mode() & 0o777;
        fs::write(at("there"), "old").unwrap();
        fs::set_permissions(at("there"), fs::Permissions::from_mode(0o640)).unwrap();
        symlink("there", at("link")).unwrap();
        symlink("missing", at("dangling")).unwrap();
        fs::write(at("usual"), "").unwrap();
        let mut stage = Stage::default();
        for name in ["link", "dangling"] {
            stage.bytes(&at(name), b"new").unwrap();
        }
        stage.commit().unwrap();
        assert!(at("link").is_symlink() && at("dangling").is_symlink());
        assert_eq!((fs::read(at("there")).unwrap(), mode("there")), (b"new".to_vec(), 0o640));
        // The umask of this process, as any other new file has it.
        assert_eq!(mode("missing"), mode("usual"));
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_never_replaced() {
        let error = Stage::default().bytes(Path::new("/dev/null"), b"").unwrap_err().to_string();
        assert!(error.contains("expected a regular file or nothing, found a device"), "{error}");
        assert!(!Path::new("/dev/null").is_file());
    }
}
