//! A point contact and a pressure field, each with Hunt–Crossley dissipation: Drake.

use core::f64::consts::PI;

use super::loading::LoadingSample;
use super::minimax::fit;
use super::{CardError, ExportError, Loading};

/// A stiffness or modulus with its Hunt–Crossley dissipation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dissipative {
    /// Stiffness, N/m, or hydroelastic modulus, Pa.
    pub elastic: f64,
    /// d in F = F_elastic (1 + d u̇), s/m.
    pub dissipation: f64,
}

/// Contacts of a rigid body of Drake, side by side on one body: a point contact, k u (1 + d u̇), and, of a ball, a hydroelastic one.
///
/// The pressure of a compliant ball of radius r falls linearly from the hydroelastic modulus E in its centre to 0 at its surface, so that
/// a rigid flat that is u deep carries
///
/// F = ∫ E (1 − s/r) dA = π r² E h² (1 − ⅔ h) (1 + d u̇),  h = u/r,
///
/// with s the distance from the centre (Elandt et al., IROS 2019; "Hydroelastic Contact User Guide" of Drake). The two together have the
/// linear and the quadratic part that forces of the latency law have on a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HuntCrossley {
    /// Radius of the ball, m; `None` of other bodies, which have no pressure field here.
    pub radius: Option<f64>,
    /// The point contact, N/m; `None` where the fit has none.
    pub point: Option<Dissipative>,
    /// The hydroelastic contact, Pa; `None` where the fit has none.
    pub hydroelastic: Option<Dissipative>,
    /// Its error in loading and hold.
    pub error: CardError,
}

impl HuntCrossley {
    /// Fits them to a loading, so that the largest error is least; `radius` (m) is that of a ball.
    ///
    /// # Errors
    /// [`ExportError::NoFit`] for forces that determine none.
    pub fn fit(loading: &Loading, radius: Option<f64>) -> Result<Self, ExportError> {
        let row = |sample: &LoadingSample| {
            let (u, speed) = (sample.indentation, sample.speed);
            let field = radius.map_or(0.0, |radius| pressure_force(radius, u));
            ([u, u * speed, field, field * speed], sample.force)
        };
        let rows: Vec<([f64; 4], f64)> = loading.samples.iter().map(row).collect();
        let engine = "Hunt and Crossley";
        let needs = [None, Some(0), None, Some(2)];
        let [k, k_d, e, e_d] = fit(&rows, needs).ok_or(ExportError::NoFit { engine })?;
        let part = |elastic: f64, dissipated: f64| {
            (elastic > 0.0).then(|| Dissipative {
                elastic,
                dissipation: dissipated / elastic,
            })
        };
        let (point, hydroelastic) = (part(k, k_d), part(e, e_d));
        let error = loading.error(|u, speed| force(radius, point, hydroelastic, (u, speed)));
        Ok(Self {
            radius,
            point,
            hydroelastic,
            error,
        })
    }

    /// Force (N) at an indentation (m) and its speed (m/s).
    #[must_use]
    pub fn force(&self, indentation: f64, speed: f64) -> f64 {
        force(self.radius, self.point, self.hydroelastic, (indentation, speed))
    }
}

/// Force (m²) of a pressure field of modulus 1 in a ball.
fn pressure_force(radius: f64, u: f64) -> f64 {
    let h = u / radius;
    PI * u * u * (1.0 - 2.0 / 3.0 * h)
}

fn force(
    radius: Option<f64>,
    point: Option<Dissipative>,
    hydroelastic: Option<Dissipative>,
    (u, speed): (f64, f64),
) -> f64 {
    if u <= 0.0 {
        return 0.0;
    }
    let damped = |part: Dissipative| part.elastic * (1.0 + part.dissipation * speed).max(0.0);
    let field = radius.map_or(0.0, |radius| pressure_force(radius, u));
    point.map_or(0.0, |part| u * damped(part)) + hydroelastic.map_or(0.0, |part| field * damped(part))
}
