//! The Kelvin–Voigt model: spring and dashpot side by side.
//!
//! Creep y(t) = Δ (1 − exp(−t/τ)), with no jump at the start. Under a held deformation it does not relax: there is no such form.
//!
//! | parameter | unit | range | meaning |
//! |---|---|---|---|
//! | amplitude Δ | of y | any | what the creep tends to |
//! | time τ | s | above 0 | retardation time, viscosity over stiffness |

use crate::laws::{BasisFunction, Composition, Description, LawDefinition};

pub(in crate::laws) const LAW: LawDefinition = LawDefinition {
    name: "kelvin-voigt",
    description: Description {
        title: "Kelvin–Voigt",
        equation: "Δ (1 − exp(−t/τ))",
        source: "Voigt 1892; Ferry, Viscoelastic Properties of Polymers, chapter 1",
    },
    relaxation: None,
    creep: Some(Composition::of(&[BasisFunction::Exponential])),
    contains_exponential: false,
};
