//! A linear spring and damper: PhysX, Isaac, Newton.

use super::loading::LoadingSample;
use super::minimax::fit;
use super::{CardError, ExportError, Loading};

/// A contact with a linear spring and a linear damper, F = max(0, k u + c u̇): compliant contact of PhysX and Isaac, contact of Newton.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpringDamper {
    /// k in N/m.
    pub stiffness: f64,
    /// c in N s/m.
    pub damping: f64,
    /// Its error in loading and hold.
    pub error: CardError,
}

impl SpringDamper {
    /// Fits both to a loading, so that the largest error is least.
    ///
    /// # Errors
    /// [`ExportError::NoFit`] for forces that determine neither.
    pub fn fit(loading: &Loading) -> Result<Self, ExportError> {
        let row = |sample: &LoadingSample| ([sample.indentation, sample.speed], sample.force);
        let rows: Vec<([f64; 2], f64)> = loading.fitted().map(row).collect();
        let engine = "a spring and a damper";
        let [stiffness, damping] = fit(&rows, [None, Some(0)]).ok_or(ExportError::NoFit { engine })?;
        let error = loading.error(|u, speed| force(stiffness, damping, (u, speed)));
        Ok(Self {
            stiffness,
            damping,
            error,
        })
    }

    /// Force (N) at an indentation (m) and its speed (m/s).
    #[must_use]
    pub fn force(&self, indentation: f64, speed: f64) -> f64 {
        force(self.stiffness, self.damping, (indentation, speed))
    }
}

fn force(stiffness: f64, damping: f64, (u, speed): (f64, f64)) -> f64 {
    if u > 0.0 { (stiffness * u + damping * speed).max(0.0) } else { 0.0 }
}
