//! A calibrated body with where it comes from.

use palpate::calibrate::{Material, Misfit};

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
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MaterialOrigin {
    /// The record, or all of them with commas between.
    pub record: String,
    /// SHA-256 of the record's file, hexadecimal, or of all of them.
    pub sha256: String,
    /// Specimens of the batch, another of which this material is; none of a body that was itself tested.
    pub specimens: Option<usize>,
    /// Its test description, if there was one.
    pub test: Option<String>,
    /// Version of palpate that calibrated.
    pub palpate: String,
    /// Samples that were fitted.
    pub samples: usize,
    /// What the record shows against the law.
    pub misfit: Option<Misfit>,
}
