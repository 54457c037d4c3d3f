//! Folders for what is not finished: removed on an error, when a signal ends the process, and by the next run after a kill.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use palpate_files::faults::{Operation, before};

/// Begin of the names of temporary folders.
const PREFIX: &str = ".palpate-";

/// Held by the process that works in a temporary folder; one without a holder is left from a kill.
const LOCK: &str = "lock";

/// What a signal removes, and whether one has.
struct Unfinished {
    folders: Vec<PathBuf>,
    abandoned: bool,
}

static UNFINISHED: Mutex<Unfinished> = Mutex::new(Unfinished {
    folders: Vec::new(),
    abandoned: false,
});

/// While this is held no signal removes anything.
pub(super) struct Undisturbed(MutexGuard<'static, Unfinished>);

/// Waits until no signal is being handled.
///
/// # Errors
/// Where one was: the process ends, and nothing more is written.
pub(super) fn undisturbed() -> io::Result<Undisturbed> {
    let guard = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    if guard.abandoned { Err(io::ErrorKind::Interrupted.into()) } else { Ok(Undisturbed(guard)) }
}

/// Removes all that is not finished; from here on no file appears. For a process that is about to end.
pub fn abandon() {
    let mut guard = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    guard.abandoned = true;
    for folder in guard.folders.drain(..).rev() {
        // What was made for temporary folders goes with them, if nothing else has come into it.
        let is_temporary = folder.file_name().is_some_and(|name| name.to_string_lossy().starts_with(PREFIX));
        if is_temporary {
            remove(&folder);
        } else {
            let _ = fs::remove_dir(&folder);
        }
    }
}

/// Removes a temporary folder into which another thread may just be writing: a file that appears meanwhile keeps it from going.
fn remove(folder: &Path) {
    const TRIES: usize = 1000;
    for _ in 0..TRIES {
        empty(folder);
        match fs::remove_dir_all(folder) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => std::thread::yield_now(),
            _ => return,
        }
    }
}

/// Removes everything in a temporary folder but its lock: of a removal that is killed the lock is left, by which the next run knows the rest.
fn empty(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_name() != LOCK {
            let path = entry.path();
            let _ = if path.is_dir() && !path.is_symlink() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
        }
    }
}

/// Folders that are made, and removed again where the work does not succeed.
#[derive(Default)]
pub(super) struct Folders {
    made: Vec<PathBuf>,
}

impl Folders {
    /// Makes a folder and what is missing above it.
    pub(super) fn make(&mut self, folder: &Path) -> io::Result<()> {
        let is_missing = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
        let mut missing: Vec<&Path> = folder.ancestors().take_while(is_missing).collect();
        missing.reverse();
        for path in missing {
            let mut guard = undisturbed()?;
            before(Operation::MakeFolder)?;
            match fs::create_dir(path) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists && path.is_dir() => continue,
                made => made?,
            }
            guard.0.folders.push(path.to_owned());
            self.made.push(path.to_owned());
        }
        Ok(())
    }

    /// They stay.
    pub(super) fn keep(mut self) -> Vec<PathBuf> {
        let made = std::mem::take(&mut self.made);
        forget(&made);
        made
    }
}

impl Drop for Folders {
    fn drop(&mut self) {
        for path in self.made.iter().rev() {
            // One into which others have written since stays.
            let _ = fs::remove_dir(path);
        }
        forget(&self.made);
    }
}

fn forget(paths: &[PathBuf]) {
    let mut guard = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    guard.folders.retain(|path| !paths.contains(path));
}

/// A temporary folder with a lock in it, which goes with this value, with a signal, or with the next run after a kill.
pub struct TemporaryFolder {
    path: PathBuf,
    _lock: File,
}

impl TemporaryFolder {
    /// Makes one in `folder`, and removes what kills have left there.
    ///
    /// # Errors
    /// Where the operating system makes none.
    pub fn make(folder: &Path) -> io::Result<Self> {
        remove_stale(folder);
        loop {
            let mut guard = undisturbed()?;
            before(Operation::MakeFolder)?;
            let path = private().prefix(PREFIX).tempdir_in(folder)?.keep();
            guard.0.folders.push(path.clone());
            drop(guard);
            match locked(&path) {
                Ok(Some(lock)) => return Ok(Self { path, _lock: lock }),
                // Another process has taken it for one that a kill had left, in the moment between folder and lock.
                Ok(None) => forget(&[path]),
                Err(error) => {
                    let _ = fs::remove_dir_all(&path);
                    forget(&[path]);
                    return Err(error);
                }
            }
        }
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        remove(&self.path);
        forget(std::slice::from_ref(&self.path));
    }
}

/// Temporary folders that no other user can look into.
#[cfg(unix)]
fn private() -> tempfile::Builder<'static, 'static> {
    use std::os::unix::fs::PermissionsExt;
    let mut builder = tempfile::Builder::new();
    builder.permissions(fs::Permissions::from_mode(0o700));
    builder
}

#[cfg(not(unix))]
fn private() -> tempfile::Builder<'static, 'static> {
    tempfile::Builder::new()
}

/// The lock of a new temporary folder; `None` where the folder is gone again.
fn locked(folder: &Path) -> io::Result<Option<File>> {
    let path = folder.join(LOCK);
    before(Operation::Create)?;
    let file = match File::create_new(&path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        made => made?,
    };
    match file.try_lock() {
        Ok(()) => Ok(path.exists().then_some(file)),
        Err(fs::TryLockError::WouldBlock) => Ok(None),
        // A file system without locks: nothing is ever stale there.
        Err(fs::TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(Some(file)),
        Err(fs::TryLockError::Error(error)) => Err(error),
    }
}

/// Removes the temporary folders that nobody holds.
pub(super) fn remove_stale(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if !entry.file_name().to_string_lossy().starts_with(PREFIX) || !path.is_dir() || path.is_symlink() {
            continue;
        }
        match File::open(path.join(LOCK)) {
            Ok(lock) if lock.try_lock().is_ok() => remove(&path),
            // Only an empty one goes.
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let _ = fs::remove_dir(&path);
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file that another thread wrote while a signal removed the folder kept it from going.
    #[test]
    fn a_folder_goes_while_files_appear_in_it() {
        let folder = tempfile::tempdir().unwrap();
        for round in 0..20 {
            let path = folder.path().join(format!("{PREFIX}{round}"));
            fs::create_dir(&path).unwrap();
            let into = path.clone();
            let writes = std::thread::spawn(move || {
                (0..).take_while(|at| fs::write(into.join(format!("{at}")), "").is_ok()).count()
            });
            while fs::read_dir(&path).unwrap().count() == 0 {}
            remove(&path);
            assert!(!path.exists(), "{round}");
            assert!(writes.join().unwrap() > 0);
        }
    }

    /// A removal that was killed behind the lock left files that no next run took away.
    #[test]
    fn a_removal_that_was_killed_goes_on() {
        let folder = tempfile::tempdir().unwrap();
        let left = folder.path().join(".palpate-left");
        fs::create_dir_all(left.join("before")).unwrap();
        for name in [LOCK, "before/1", "2"] {
            fs::write(left.join(name), "").unwrap();
        }
        empty(&left);
        assert_eq!(fs::read_dir(&left).unwrap().map(|entry| entry.unwrap().file_name()).collect::<Vec<_>>(), [LOCK]);
        drop(TemporaryFolder::make(folder.path()).unwrap());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn what_a_kill_left_is_removed_and_what_is_held_stays() {
        let folder = tempfile::tempdir().unwrap();
        let held = TemporaryFolder::make(folder.path()).unwrap();
        let left = folder.path().join(".palpate-left");
        fs::create_dir(&left).unwrap();
        for name in [LOCK, "table.csv"] {
            fs::write(left.join(name), "").unwrap();
        }
        let second = TemporaryFolder::make(folder.path()).unwrap();
        assert!(!left.exists() && held.path().exists() && second.path().exists());
        drop((held, second));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
