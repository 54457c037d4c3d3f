//! One-dimensional diffusion, after Golik's picture of holes that diffuse out of a loaded polymer.
//!
//! What is left in a sheet of thickness L that exchanges through both faces: φ(t) = (8/π²) Σ_{k = 1, 3, 5, …} exp(−k²λt)/k²,
//! λ = π²D/L² with the diffusivity D. y(t) = y_e + Δ φ(t); in creep y₀ + Δ (1 − φ(t)).
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | equilibrium y_e, or instantaneous y₀ | of y | any | end, or start in creep |
//! | amplitude Δ | of y | any | what relaxes |
//! | time τ = 1/λ = L²/(π²D) | s | above 0 | of the slowest mode |
//!
//! Early, 1 − φ grows as the square root of time; late, φ falls as (8/π²) exp(−t/τ).

use crate::laws::{BasisFunction, Composition, Description, Kernel, LawDefinition, ShapeParameter, TIME};
use crate::special::diffusion_decay_many;

const FORM: Composition = Composition::with_constant(&[BasisFunction::Diffusion]);

pub(in crate::laws) const LAW: LawDefinition = LawDefinition {
    name: "diffusion",
    description: Description {
        title: "diffusion",
        equation: "y_e + Δ (8/π²) Σ_odd exp(−k²t/τ)/k²",
        source: "hole diffusion after Golik, cited by Tsai, Kao et al.; series: Crank, The Mathematics of Diffusion, section 4.3",
    },
    relaxation: Some(FORM),
    creep: Some(FORM),
    contains_exponential: false,
};

/// (8/π²) Σ_odd exp(−k²λt)/k².
pub(in crate::laws) struct Diffusion;

impl Kernel for Diffusion {
    fn parameters(&self) -> &'static [ShapeParameter] {
        &[TIME]
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        let mut unused = vec![0.0; times.len()];
        diffusion_decay_many(times, theta[0].exp(), value, &mut unused);
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        diffusion_decay_many(times, theta[0].exp(), value, &mut derivatives[0]);
    }
}
