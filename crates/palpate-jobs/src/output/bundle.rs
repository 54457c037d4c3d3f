//! All files of a report.

use std::fs;
use std::path::{Component, Path, PathBuf};

use palpate_report::study::Bundle;

use super::stage::Stage;
use crate::JobError;

/// The names that the last run wrote into a folder, so that the next one can take away what it does not write again.
const MANIFEST: &str = ".palpate-files";

/// Writes all files of a bundle below `folder`, and removes those that an earlier run wrote there and this one does not.
///
/// # Errors
/// [`JobError`] where one of them cannot be written; the folder is as it was then.
pub fn write_bundle(folder: &Path, bundle: &Bundle) -> Result<(), JobError> {
    let mut stage = Stage::default();
    stage.bundle(folder, bundle)?;
    stage.commit()
}

impl Stage {
    /// All files of a bundle below `folder`, as [`write_bundle`] writes them.
    ///
    /// # Errors
    /// [`JobError`] where one of them cannot be written.
    pub fn bundle(&mut self, folder: &Path, bundle: &Bundle) -> Result<(), JobError> {
        for (name, content) in &bundle.files {
            self.bytes(&folder.join(name), content)?;
        }
        let names: String = bundle.files.iter().map(|(name, _)| format!("{name}\n")).collect();
        self.bytes(&folder.join(MANIFEST), names.as_bytes())?;
        stale_files(folder, bundle).into_iter().for_each(|path| self.remove(path));
        Ok(())
    }
}

/// Files of an earlier run that this one does not write: they would speak of another record. Others' files stay.
fn stale_files(folder: &Path, bundle: &Bundle) -> Vec<PathBuf> {
    let written = fs::read_to_string(folder.join(MANIFEST)).unwrap_or_default();
    let is_stale = |name: &&str| {
        let inside = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        inside && !bundle.files.iter().any(|(new, _)| new == name)
    };
    written.lines().filter(is_stale).map(|name| folder.join(name)).collect()
}
