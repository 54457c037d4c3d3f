//! `palpate.reproduction/1`: the summary of the reproduced study.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::analysis::TableRow;
use super::software::Software;
use crate::result::Check;

/// The whole summary.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(title = "palpate.reproduction/1")]
pub struct ReproductionDocument {
    /// `palpate.reproduction/1`.
    pub schema: String,
    /// Radius of the ball, m.
    pub radius_m: f64,
    /// Modulus, Pa.
    pub modulus_pa: f64,
    /// n.
    pub exponent: f64,
    /// v, 1/s.
    pub rate_coefficient_per_s: f64,
    /// m.
    pub layers: f64,
    /// Speed of the jaw, m/s.
    pub rate_m_per_s: f64,
    /// Table I, re-identified from the simulated test (a).
    pub table_1: Vec<TableRow>,
    /// Table II, re-identified from the simulated test (b).
    pub table_2: Vec<TableRow>,
    /// Largest relative error of a re-identified rate coefficient.
    pub largest_rate_coefficient_error: f64,
    /// What the paper reports in words.
    pub checks: Vec<Check>,
    /// Whether all of them pass.
    pub all_passed: bool,
    /// What wrote this.
    pub software: Software,
}
