//! All files of a report.

use std::fs;
use std::path::{Component, Path};

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
        let written = fs::read_to_string(folder.join(MANIFEST)).unwrap_or_default();
        let stale = stale_names(&written, bundle);
        let names: String = bundle.files.iter().map(|(name, _)| format!("{name}\n")).collect();
        // Whatever is there when a kill ends this is in the manifest of that moment, so that the next run takes it away.
        let manifest = folder.join(MANIFEST);
        self.bytes(&manifest, [&names, stale.join("\n").as_str()].concat().as_bytes())?;
        for (name, content) in &bundle.files {
            self.bytes(&folder.join(name), content)?;
        }
        if !stale.is_empty() {
            self.bytes(&manifest, names.as_bytes())?;
        }
        stale.into_iter().for_each(|name| self.remove(folder.join(name)));
        Ok(())
    }
}

/// Files of an earlier run, by its manifest, that this one does not write: they would speak of another record. Others' files stay.
fn stale_names<'a>(manifest: &'a str, bundle: &Bundle) -> Vec<&'a str> {
    let is_stale = |name: &&str| {
        let inside = Path::new(name).components().all(|part| matches!(part, Component::Normal(_)));
        inside && !bundle.files.iter().any(|(new, _)| new == name)
    };
    manifest.lines().filter(is_stale).collect()
}
