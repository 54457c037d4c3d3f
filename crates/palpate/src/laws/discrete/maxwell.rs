//! The Maxwell model: spring and dashpot in series.
//!
//! Relaxation y(t) = Δ exp(−t/τ): everything relaxes. Creep y(t) = y₀ + rate · t: it flows without end.
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | amplitude Δ | of y | any | signal at the start |
//! | time τ | s | above 0 | relaxation time, viscosity over stiffness |
//! | instantaneous y₀ (creep) | of y | any | elastic part |
//! | flow rate (creep) | of y per s | any | slope of the flow |

use crate::laws::{BasisFunction, Composition, Description, Kernel, LawDefinition, REFERENCE, ShapeParameter};

pub(in crate::laws) const LAW: LawDefinition = LawDefinition {
    name: "maxwell",
    description: Description {
        title: "Maxwell",
        equation: "Δ exp(−t/τ)",
        source: "Maxwell 1867; Ferry, Viscoelastic Properties of Polymers, chapter 1",
    },
    relaxation: Some(Composition::of(&[BasisFunction::Exponential])),
    creep: Some(Composition::with_constant(&[BasisFunction::Straight])),
    contains_exponential: false,
};

/// λt with λ one over the duration of the fit: flow.
pub(in crate::laws) struct Straight;

impl Kernel for Straight {
    fn parameters(&self) -> &'static [ShapeParameter] {
        &[REFERENCE]
    }

    fn decays(&self) -> bool {
        false
    }

    fn value(&self, times: &[f64], theta: &[f64], value: &mut [f64]) {
        let rate = theta[0].exp();
        for (out, t) in value.iter_mut().zip(times) {
            *out = rate * t;
        }
    }

    fn gradient(&self, times: &[f64], theta: &[f64], value: &mut [f64], derivatives: &mut [Vec<f64>]) {
        self.value(times, theta, value);
        derivatives[0].copy_from_slice(value);
    }
}
