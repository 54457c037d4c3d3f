//! Logarithmic relaxation and creep.
//!
//! y(t) = y₀ − Δ ln(1 + λt), in creep y₀ + Δ ln(1 + λt): the limit of the latency law for large n, where (n−1) λ and Δ/(n−1) stay.
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | start y₀, or instantaneous y₀ in creep | of y | any | signal at the start |
//! | amplitude Δ | of y | any | change per e-fold of time |
//! | time 1/λ | s | above 0 | where the logarithm begins |

use crate::laws::{BasisFunction, Composition, Description, Kernel, LawDefinition, ShapeParameter, TIME};
use crate::vector::logarithm_columns;

const FORM: Composition = Composition::with_constant(&[BasisFunction::Logarithm]);

pub(in crate::laws) const LAW: LawDefinition = LawDefinition {
    name: "logarithmic",
    description: Description {
        title: "logarithmic",
        equation: "y₀ − Δ ln(1 + t/t₀)",
        source: "Guiu and Pratt 1964; Kubát 1965",
    },
    relaxation: Some(FORM),
    creep: Some(FORM),
    contains_exponential: false,
};

/// ln(1 + λt).
pub(in crate::laws) struct Logarithm;

impl Kernel for Logarithm {
    fn parameters(&self) -> &'static [ShapeParameter] {
        &[TIME]
    }

    fn decays(&self) -> bool {
        false
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        logarithm_columns(times, theta[0].exp(), [value]);
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        logarithm_columns(times, theta[0].exp(), [value, &mut derivatives[0]]);
    }
}
