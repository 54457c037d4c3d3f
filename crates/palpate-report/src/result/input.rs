//! Where a record came from.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where a record came from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Input {
    /// Path as given.
    pub path: String,
    /// The part of the file that is this record (a sheet, a curve, a `test_id`), where the file names it.
    pub part: Option<String>,
    /// SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
    /// Rows of data.
    pub rows: usize,
    /// How many successive rows each sample is the mean of; 1 unless the file is very long.
    pub rows_averaged: usize,
    /// Where the curve was measured, m, where the file states its position in a map.
    pub x_m: Option<f64>,
    /// Second coordinate of that position, m.
    pub y_m: Option<f64>,
    /// Number of the curve in its map, where the file numbers it.
    pub map_index: Option<u64>,
    /// Path of the test description, if one was given.
    pub test: Option<String>,
    /// SHA-256 of the description as it was read, with the columns that were named beside it.
    pub test_sha256: Option<String>,
    /// SHA-256 of the record without a body whose force was subtracted, if one was.
    pub air_run_sha256: Option<String>,
    /// SHA-256 of the file in which the test goes on, if there is one.
    pub then_sha256: Option<String>,
    /// SHA-256 over everything that the result depends on: these files, every setting, and the build of palpate. Equal digests stand for
    /// equal results.
    pub depends_on_sha256: Option<String>,
    /// What the description says of the record (its title, or the file name).
    pub title: String,
}

impl Input {
    /// The file, and the part of it that is this record where the file names one.
    #[must_use]
    pub fn called(&self) -> String {
        self.part.as_ref().map_or_else(|| self.path.clone(), |part| format!("{}, {part}", self.path))
    }
}
