//! A calibrated body with where it comes from.

use palpate::calibrate::Material;

/// Version of the table `[calibration]` that is written and read.
pub const MATERIAL_VERSION: u64 = 1;

/// A calibrated body with its provenance.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialFile {
    /// The body.
    pub material: Material,
    /// Provenance of its parameters.
    pub origin: MaterialOrigin,
}

/// Provenance of the parameters of a material.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MaterialOrigin {
    /// The record.
    pub record: String,
    /// SHA-256 of the record's file, hexadecimal.
    pub sha256: String,
    /// Its test description, if there was one.
    pub test: Option<String>,
    /// Version of palpate that calibrated.
    pub palpate: String,
    /// Samples that were fitted.
    pub samples: usize,
}
