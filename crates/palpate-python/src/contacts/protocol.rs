//! Protocols as Python states them.

use std::path::{Path, PathBuf};

use palpate_files::description::{DescriptionError, read_protocol_text};
use pyo3::prelude::*;

use crate::errors::{of_mapping, of_paths, undescribed};

/// The text of a protocol: that of a file, or of a mapping, of which messages name keys and no lines.
pub(super) struct StatedProtocol {
    pub(super) path: PathBuf,
    text: String,
    is_mapping: bool,
}

impl StatedProtocol {
    /// That at a path, or else the text of a mapping.
    pub(super) fn new(path: Option<PathBuf>, text: Option<String>) -> PyResult<Self> {
        Ok(match path {
            Some(path) => Self {
                text: read_protocol_text(&path).map_err(undescribed)?,
                path,
                is_mapping: false,
            },
            None => Self {
                text: text.unwrap_or_default(),
                path: PathBuf::from("protocol"),
                is_mapping: true,
            },
        })
    }

    /// What `parse` makes of text and path.
    pub(super) fn parsed<T>(&self, parse: impl FnOnce(&str, &Path) -> Result<T, DescriptionError>) -> PyResult<T> {
        self.parsed_with(&[], parse)
    }

    /// The same beside paths of numbers, which messages leave as they are.
    pub(super) fn parsed_with<T>(
        &self,
        numbers: &[(String, Vec<f64>)],
        parse: impl FnOnce(&str, &Path) -> Result<T, DescriptionError>,
    ) -> PyResult<T> {
        let is_number = |error: &DescriptionError| numbers.iter().any(|(path, _)| error.key() == Some(path));
        let of_ours = |error| if is_number(&error) { of_paths(error) } else { of_mapping(error) };
        let wrong = |error| undescribed(if self.is_mapping { of_ours(error) } else { error });
        parse(&self.text, &self.path).map_err(wrong)
    }
}
