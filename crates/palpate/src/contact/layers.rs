//! How a body is cut into layers.

use serde::{Deserialize, Serialize};

/// The number m of layers between a contact and the plane that does not move; any real m ≥ 1.
///
/// New displacement lands on the contact layer first, so m decides how much a ramp overshoots: the drive of the
/// contact layer is g = u̇₁ (m − 1)/depth. **The layer thickness ℓ = depth/m is a material length, not a mesh
/// size**: at a fixed rate coefficient the force does not converge as m grows. m = 1 is a purely elastic body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Layers(f64);

/// An invalid number or thickness of layers.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LayersError {
    /// Fewer than one layer.
    #[error("the number of layers must be 1 or more, found {found}")]
    TooFew {
        /// What was given.
        found: f64,
    },
    /// A layer thickness that is not between zero and the depth of the body.
    #[error("layer thickness must be above 0 m and at most the depth of {depth} m, found {found} m")]
    Thickness {
        /// Depth of the body, m.
        depth: f64,
        /// What was given, m.
        found: f64,
    },
}

impl Layers {
    /// m layers.
    ///
    /// # Errors
    /// [`LayersError::TooFew`] unless m is a finite number of at least 1.
    pub fn new(count: f64) -> Result<Self, LayersError> {
        if count.is_finite() && count >= 1.0 {
            Ok(Self(count))
        } else {
            Err(LayersError::TooFew { found: count })
        }
    }

    /// Layers of the given thickness (m) in a body of the given depth (m); m = depth/thickness need not be whole.
    ///
    /// # Errors
    /// [`LayersError::Thickness`] unless 0 < thickness ≤ depth.
    pub fn of_thickness(thickness: f64, depth: f64) -> Result<Self, LayersError> {
        if thickness > 0.0 && thickness <= depth {
            Self::new(depth / thickness)
        } else {
            Err(LayersError::Thickness {
                depth,
                found: thickness,
            })
        }
    }

    /// m.
    #[must_use]
    pub fn count(self) -> f64 {
        self.0
    }

    /// m as an integer, or `None`: only whole layers have strains of their own.
    #[must_use]
    pub fn whole(self) -> Option<usize> {
        let whole = self.0 as usize;
        (self.0 < 1e6 && whole as f64 == self.0).then_some(whole)
    }

    /// ℓ = depth/m in m.
    #[must_use]
    pub fn thickness(self, depth: f64) -> f64 {
        depth / self.0
    }

    /// Drive g = u̇₁ (m − 1)/depth of the contact layer in 1/s, from the speed of the contact in m/s.
    #[must_use]
    pub fn drive(self, contact_speed: f64, depth: f64) -> f64 {
        contact_speed * (self.0 - 1.0) / depth
    }
}
