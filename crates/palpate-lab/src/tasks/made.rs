//! What a task made.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use palpate::watch::Unwatched;
use palpate_jobs::{Analyzed, CurveMap, JobError};
use palpate_report::figure::{Column, PictureFormat};
use palpate_report::study::{Bundle, FileOptions};
use serde::Deserialize;
use serde_json::Value;

/// Files by their relative paths.
pub(crate) type Files = Vec<(String, Vec<u8>)>;

/// What a task made: an answer for the page, and files to take away.
#[derive(Default)]
pub(crate) struct Made {
    /// What the page shows.
    pub(crate) answer: Value,
    /// Files that were made with it.
    pub(crate) files: Files,
    /// Of an analysed test, what figures are made of.
    analyzed: Option<Analyzed>,
    /// Of a batch, what maps are made of.
    map: Option<CurveMap>,
    pictures: Mutex<HashMap<PictureChoice, Arc<Files>>>,
}

/// How figures are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct PictureChoice {
    pub(crate) format: PictureFormat,
    #[serde(default)]
    pub(crate) column: Option<Column>,
}

impl Made {
    /// An answer with files.
    pub(crate) fn new(answer: Value, bundle: Bundle) -> Self {
        Self {
            answer,
            files: bundle.files,
            ..Self::default()
        }
    }

    /// The same with what its figures are made of.
    pub(crate) fn of_analysis(mut self, analyzed: Analyzed) -> Self {
        self.analyzed = Some(analyzed);
        self
    }

    /// The same with what its maps are made of.
    pub(crate) fn of_map(mut self, map: CurveMap) -> Self {
        self.map = Some(map);
        self
    }

    /// Whether it keeps a whole record, or files of as many bytes as one.
    pub(crate) fn is_large(&self) -> bool {
        const LARGE: usize = 1 << 20;
        self.analyzed.is_some() || self.files.iter().map(|(_, content)| content.len()).sum::<usize>() > LARGE
    }

    /// The curves with positions.
    pub(crate) fn map(&self) -> Option<&CurveMap> {
        self.map.as_ref()
    }

    /// The file at a path.
    pub(crate) fn file(&self, path: &str) -> Option<&[u8]> {
        self.files.iter().find(|(name, _)| name == path).map(|(_, content)| content.as_slice())
    }

    /// The figures of an analysed test in a format, made once.
    ///
    /// # Errors
    /// [`JobError`] where a figure cannot be drawn.
    pub(crate) fn pictures(&self, choice: PictureChoice) -> Result<Arc<Files>, JobError> {
        let mut kept = self.pictures.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(files) = kept.get(&choice) {
            return Ok(Arc::clone(files));
        }
        let mut files = Files::new();
        if let Some(analyzed) = &self.analyzed {
            let options = FileOptions {
                figures: vec![choice.format],
                column: choice.column,
                ..FileOptions::default()
            };
            files = analyzed.bundle(&options, &mut Unwatched)?.files;
            files.retain(|(name, _)| name.starts_with("figures/"));
        }
        let files = Arc::new(files);
        kept.insert(choice, Arc::clone(&files));
        Ok(files)
    }
}
