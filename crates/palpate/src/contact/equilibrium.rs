//! The force that a body tends to once relaxation is over.

use super::{Curve, CurveError, Shape, Tip};

/// Law of the equilibrium force F_e of a contact: what the force F tends to while the jaw stands still.
///
/// The force of a contact is F = S(u) ε, with ε the strain of the contact layer and S the stiffness against it; relaxed, ε = u/depth.
/// A law of F_e is therefore one of S = F_e depth/u, and the strain in excess of equilibrium adds S(u) x to it.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(
    feature = "alloc",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case", tag = "kind")
)]
pub enum Equilibrium {
    /// The paper's: F_e = E (u/depth) A(u), equation (11).
    #[default]
    UniformStrain,
    /// Hertz (1881), a ball of modulus E pressed by a rigid flat: F_e = 4/3 E/(1 − ν²) √r u^(3/2); under the tip of an indenter, its extensions
    /// to other tips and to thin layers ([`Tip`](super::Tip), [`ThinLayer`](super::ThinLayer)).
    ///
    /// For balls and pads, from small contacts up to u ≈ r/10, and a pad much thicker than the contact is wide; for tips.
    Hertz {
        /// Poisson's ratio ν, from 0 to 0.5.
        poisson_ratio: f64,
    },
    /// Measured: S(u) through the rows of a table of F_e.
    Measured {
        /// F_e/u in N/m at contact displacements in m.
        force_per_displacement: Curve,
    },
}

/// A law of the equilibrium force that does not go with a body.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EquilibriumError {
    /// A Poisson's ratio beyond what solids have.
    #[error("Poisson's ratio must be from 0 to 0.5, found {found}")]
    PoissonRatio {
        /// What was given.
        found: f64,
    },
    /// Hertz's law for a body that is not round.
    #[error("Hertz's law needs a ball, a pad or the tip of an indenter, whose form determines the contact")]
    NotRound,
    /// A flat punch on a layer that is thinner than the punch is wide.
    #[error(
        "a flat punch must be at most as wide as the layer is thick, {thickness} m, found a diameter of {diameter} m"
    )]
    WidePunch {
        /// Thickness of the layer, m.
        thickness: f64,
        /// Diameter of the punch, m.
        diameter: f64,
    },
    /// A table whose rows make no law.
    #[error("table of equilibrium forces, {0}")]
    Table(#[from] CurveError),
    /// A force where nothing touches.
    #[error("table of equilibrium forces, row 1: the force at first touch must be 0 N, found {found} N")]
    Touch {
        /// What was given, N.
        found: f64,
    },
    /// A body that gets softer as it is squeezed.
    #[error(
        "table of equilibrium forces, row {row}: force over displacement must not fall, found {found:.4e} N/m after {before:.4e} N/m"
    )]
    Softening {
        /// Which row, from 1.
        row: usize,
        /// F_e/u there, N/m.
        found: f64,
        /// F_e/u a row before, N/m.
        before: f64,
    },
}

impl Equilibrium {
    /// Checks that the law goes with a shape.
    ///
    /// # Errors
    /// [`EquilibriumError`] for Hertz's law with a body that is not round, a Poisson's ratio that no solid has, or a punch that is wider than its
    /// layer is thick.
    pub fn check(&self, shape: &Shape) -> Result<(), EquilibriumError> {
        match self {
            Self::Hertz { poisson_ratio } => {
                if !(0.0..=0.5).contains(poisson_ratio) {
                    return Err(EquilibriumError::PoissonRatio { found: *poisson_ratio });
                }
                match shape.tip() {
                    None => Err(EquilibriumError::NotRound),
                    Some((tip @ Tip::Punch { radius }, Some(layer))) if tip.deepest(&layer) <= 0.0 => {
                        Err(EquilibriumError::WidePunch {
                            thickness: layer.thickness,
                            diameter: 2.0 * radius,
                        })
                    }
                    Some(_) => Ok(()),
                }
            }
            Self::UniformStrain | Self::Measured { .. } => Ok(()),
        }
    }

    /// S(u), the force per strain of the contact layer (N), and its slope dS/du (N/m).
    pub(super) fn stiffness(&self, shape: &Shape, modulus: f64, depth: f64, u: f64) -> (f64, f64) {
        match (self, shape.tip()) {
            (Self::Measured { force_per_displacement }, _) => {
                let (ratio, slope) = force_per_displacement.value_and_slope(u);
                (ratio * depth, slope * depth)
            }
            (Self::Hertz { poisson_ratio }, Some((tip, layer))) => {
                let scale = modulus / (1.0 - poisson_ratio * poisson_ratio) * depth;
                let (stiffness, slope) = tip.stiffness(layer.as_ref(), *poisson_ratio, u);
                (scale * stiffness, scale * slope)
            }
            _ => {
                let (area, growth) = shape.area(u);
                (modulus * area, modulus * growth)
            }
        }
    }

    /// The deepest contact displacement that is known, m, and what sets it; infinite where a formula goes on.
    pub(super) fn end(&self, shape: &Shape) -> (f64, &'static str) {
        match (self, shape.tip()) {
            (Self::Measured { force_per_displacement }, _) => {
                (force_per_displacement.end(), "last row of the table of forces")
            }
            (Self::Hertz { .. }, Some((tip, Some(layer)))) => {
                (tip.deepest(&layer), "displacement at which the contact is as wide as the layer is thick")
            }
            (Self::UniformStrain | Self::Hertz { .. }, _) => (f64::INFINITY, "range of the law"),
        }
    }
}
