//! Fung's reduced relaxation function with a continuous spectrum, for quasi-linear viscoelasticity.
//!
//! y(t) = N [1 + C (E₁(t/τ_long) − E₁(t/τ_short))]/[1 + C ln(τ_long/τ_short)], E₁ the exponential integral: relaxation times spread
//! evenly in ln τ between τ_short and τ_long. As a shape: φ = [E₁(λt) − E₁(ϱλt)]/ln ϱ with λ = 1/τ_long and ϱ = τ_long/τ_short.
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | elastic response N | of y | any | signal at the start |
//! | strength C | 1 | above 0 for relaxation | height of the spectrum |
//! | time_short, time_long | s | above 0 | its ends; ln ϱ is sought from 0.05 to 25 |
//!
//! Limit: ϱ → 1 is the standard linear solid.

use crate::laws::{
    BasisFunction, Composition, Description, Kernel, LawDefinition, ShapeParameter, ShapeParameterKind, two,
};
use crate::special::fung_continuous_many;

pub(in crate::laws) const LAW: LawDefinition = LawDefinition {
    name: "fung-continuous",
    description: Description {
        title: "Fung, continuous spectrum",
        equation: "N [1 + C (E₁(t/τ_long) − E₁(t/τ_short))]/[1 + C ln(τ_long/τ_short)]",
        source: "Neubert 1963; Fung, Biomechanics, section 7.6",
    },
    relaxation: Some(Composition::with_constant(&[BasisFunction::FungContinuous])),
    creep: None,
    contains_exponential: true,
};

/// [E₁(λt) − E₁(ϱλt)]/ln ϱ in θ = (ln λ, ln ϱ).
pub(in crate::laws) struct FungContinuous;

impl Kernel for FungContinuous {
    fn parameters(&self) -> &'static [ShapeParameter] {
        const COARSE: [f64; 10] = [0.05, 1.5, 3.0, 4.5, 6.0, 8.0, 10.0, 13.0, 17.0, 25.0];
        const TIME_LONG: ShapeParameter = ShapeParameter::new("time_constant_long_s", ShapeParameterKind::Time);
        const { &[TIME_LONG, ShapeParameter::pure("log_ratio", 0.05, 25.0, &COARSE)] }
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        let mut unused = (vec![0.0; times.len()], vec![0.0; times.len()]);
        let (slow, fast) = (theta[0].exp(), (theta[0] + theta[1]).exp());
        fung_continuous_many(times, slow, fast, value, &mut unused.0, &mut unused.1);
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        let [by_slow, by_ratio] = two(derivatives);
        let (slow, fast) = (theta[0].exp(), (theta[0] + theta[1]).exp());
        fung_continuous_many(times, slow, fast, value, by_slow, by_ratio);
        // ln λ moves both ends, ln ϱ only the fast one.
        for (slow, fast) in by_slow.iter_mut().zip(by_ratio.iter()) {
            *slow += fast;
        }
    }
}
