//! The index of the reports that an analysis of several records writes into one folder.

use std::path::{Path, PathBuf};

use palpate::watch::Watch;
use palpate_report::document::SpecimensDocument;
use palpate_report::result::LeftOut;
use palpate_report::spelling::with_flags;
use palpate_report::study::{Bundle, FileOptions, SpecimenIndex};

use crate::error::without;
use crate::output::{Names, Stage};
use crate::{Analyzed, JobError};

/// The reports in a folder, while they are written.
#[derive(Debug, Clone, Default)]
pub struct ReportIndex {
    index: SpecimenIndex,
}

impl ReportIndex {
    /// Adds a record whose report lies in `folder`, below `out` with the index.
    ///
    /// # Errors
    /// [`JobError`] where its figure cannot be drawn, or the watch ends it.
    pub fn add(
        &mut self,
        analyzed: &Analyzed,
        folder: &Path,
        out: &Path,
        watch: &mut dyn Watch,
    ) -> Result<(), JobError> {
        let below = folder.strip_prefix(out).unwrap_or(folder);
        let parts = below.components().map(|part| part.as_os_str().to_string_lossy().into_owned());
        let report = parts.chain(["report.html".to_owned()]).collect();
        Ok(self.index.add(&analyzed.analysis, &analyzed.input, report, watch)?)
    }

    /// Adds a record that could not be analysed.
    pub fn leave_out(&mut self, path: &Path, error: &JobError) {
        self.index.leave_out(LeftOut {
            path: path.display().to_string(),
            reason: without(path, &error.to_string()),
            hint: error.hint.as_deref().map(with_flags),
        });
    }

    /// Whether no record was added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.index.results().specimens.is_empty()
    }

    /// The same as a document.
    #[must_use]
    pub fn document(&self) -> SpecimensDocument {
        SpecimensDocument::new(self.index.results())
    }

    /// `index.html`, `specimens.json`, tables and figures by their names.
    ///
    /// # Errors
    /// [`JobError`] where a figure or document cannot be made, or the watch ends it.
    pub fn bundle(&self, options: &FileOptions, watch: &mut dyn Watch) -> Result<Bundle, JobError> {
        Ok(self.index.bundle(options, watch)?)
    }
}

/// Writes the reports of analysed records below `folder`, each into a folder named after its record, and their index: all or none.
///
/// # Errors
/// [`JobError`] where a figure or document cannot be made or a file cannot be written, or the watch ends it.
pub fn write_reports<'a>(
    analyzed: impl IntoIterator<Item = &'a Analyzed>,
    folder: &Path,
    options: &FileOptions,
    watch: &mut dyn Watch,
) -> Result<PathBuf, JobError> {
    let (mut index, mut names, mut stage) = (ReportIndex::default(), Names::default(), Stage::default());
    for one in analyzed {
        let stem = Path::new(&one.input.path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let name = one.input.part.as_ref().map_or_else(|| stem.clone(), |part| format!("{stem} {part}"));
        let own = names.folder_in(folder, &name);
        index.add(one, &own, folder, watch)?;
        stage.bundle(&own, &one.bundle(options, watch)?)?;
    }
    stage.bundle(folder, &index.bundle(options, watch)?)?;
    stage.commit()?;
    Ok(folder.join("index.html"))
}
