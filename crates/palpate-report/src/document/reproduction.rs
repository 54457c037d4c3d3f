//! `palpate.reproduction/1`: the summary of the reproduced study.

use palpate::test_problems::PAPER_RATE;

use super::analysis::{TableRow, tables};
use super::software::Software;
use crate::page::Check;
use crate::result::Reproduction;

documents! {
    /// The whole summary.
    #[schemars(title = "palpate.reproduction/1")]
    ReproductionDocument(study: &Reproduction) {
        /// `palpate.reproduction/1`.
        schema: String = "palpate.reproduction/1".to_owned(),
        /// Radius of the ball, m.
        radius_m: f64 = study.model.specimen.depth(),
        /// Modulus, Pa.
        modulus_pa: f64 = study.model.specimen.modulus(),
        /// n.
        exponent: f64 = study.model.law.exponent(),
        /// v, 1/s.
        rate_coefficient_per_s: f64 = study.model.law.rate_coefficient(),
        /// m.
        layers: f64 = study.model.layers.count(),
        /// Speed of the jaw, m/s.
        rate_m_per_s: f64 = PAPER_RATE,
        /// Table I, re-identified from the simulated test (a).
        table_1: Vec<TableRow> = tables(&study.test_a.analysis).map_or(Vec::new(), |tables| tables.loading),
        /// Table II, re-identified from the simulated test (b).
        table_2: Vec<TableRow> = tables(&study.test_b.analysis).map_or(Vec::new(), |tables| tables.unloading),
        /// Largest relative error of a re-identified rate coefficient.
        largest_rate_coefficient_error: f64 = study.largest_coefficient_error(),
        /// Results of the paper, with their checks.
        checks: Vec<Check> = study.checks.clone(),
        /// Whether all of them pass.
        all_passed: bool = study.all_passed(),
        /// The software that wrote this.
        software: Software = Software::this(),
    }
}
