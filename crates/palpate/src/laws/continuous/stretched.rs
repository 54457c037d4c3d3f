//! The stretched exponential of Kohlrausch, Williams and Watts.
//!
//! y(t) = y_e + Δ exp(−(λt)^β), in creep y₀ + Δ (1 − exp(−(λt)^β)).
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | equilibrium y_e, or instantaneous y₀ | of y | any | end, or start in creep |
//! | amplitude Δ | of y | any | what relaxes |
//! | time τ = 1/λ | s | above 0 | where e⁻¹ of it is left |
//! | stretching β | 1 | 0.05 to 2 | 1: exponential; smaller: wider |

use crate::laws::{BasisFunction, Composition, Description, Kernel, LawDefinition, ShapeParameter, TIME, two};
use crate::vector::stretched_columns;

const FORM: Composition = Composition::with_constant(&[BasisFunction::Stretched]);

pub(in crate::laws) const LAW: LawDefinition = LawDefinition {
    name: "stretched",
    description: Description {
        title: "stretched exponential",
        equation: "y_e + Δ exp(−(t/τ)^β)",
        source: "Kohlrausch 1854; Williams and Watts 1970",
    },
    relaxation: Some(FORM),
    creep: Some(FORM),
    contains_exponential: true,
};

/// exp(−(λt)^β).
pub(in crate::laws) struct Stretched;

impl Kernel for Stretched {
    fn parameters(&self) -> &'static [ShapeParameter] {
        const COARSE: [f64; 12] = [0.05, 0.1, 0.15, 0.22, 0.3, 0.4, 0.53, 0.7, 0.9, 1.2, 1.6, 2.0];
        const { &[TIME, ShapeParameter::pure("stretching", 0.05, 2.0, &COARSE)] }
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        stretched_columns(times, theta[0].exp(), theta[1], [value]);
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        let [by_rate, by_stretching] = two(derivatives);
        stretched_columns(times, theta[0].exp(), theta[1], [value, by_rate, by_stretching]);
    }
}
