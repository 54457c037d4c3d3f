//! A point contact and a pressure field, each with Hunt–Crossley dissipation: Drake.

use core::f64::consts::PI;

use super::loading::LoadingSample;
use super::minimax::{fit, fit_rounds};
use super::{CardError, ExportError, Loading};

/// A stiffness or modulus with its Hunt–Crossley dissipation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dissipative {
    /// Stiffness, N/m, or hydroelastic modulus, Pa.
    pub elastic: f64,
    /// d in F = F_elastic (1 + d u̇), s/m.
    pub dissipation: f64,
}

/// Contacts of a rigid body of Drake, side by side on one body: a point contact, and, of a ball, a hydroelastic one.
///
/// The point contact is that of a geometry whose surface lies deeper by a gap g,
///
/// F = k (u − g) (1 + d u̇) for u > g.
///
/// The pressure of a compliant ball of radius r falls linearly from the hydroelastic modulus E in its centre to 0 at its surface, so that
/// a rigid flat that is u deep carries
///
/// F = ∫ E (1 − s/r) dA = π r² E h² (1 − ⅔ h) (1 + d u̇),  h = u/r,
///
/// with s the distance from the centre (Elandt et al., IROS 2019; "Hydroelastic Contact User Guide" of Drake). The two together have the
/// linear and the quadratic part that forces of the latency law have on a ball, and the gap their soft beginning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HuntCrossley {
    /// Radius of the ball, m; `None` of other bodies, which have no pressure field here.
    pub radius: Option<f64>,
    /// The point contact, N/m; `None` where the fit has none.
    pub point: Option<Dissipative>,
    /// Indentation at which the point contact begins, m.
    pub gap: f64,
    /// The hydroelastic contact, Pa; `None` where the fit has none.
    pub hydroelastic: Option<Dissipative>,
    /// Its error in loading and hold.
    pub error: CardError,
}

/// Gaps that are tried, as shares of the indentation at the end of loading.
const GAPS: usize = 31;
const WIDEST_GAP: f64 = 0.3;

/// Rounds of the fit that gaps are compared by.
const ROUNDS: usize = 20;

/// Dissipation needs the elastic part that it is of.
const NEEDS: [Option<usize>; 4] = [None, Some(0), None, Some(2)];

impl HuntCrossley {
    /// Fits them to a loading, so that the largest error is least; `radius` (m) is that of a ball.
    ///
    /// # Errors
    /// [`ExportError::NoFit`] for forces that determine none.
    pub fn fit(loading: &Loading, radius: Option<f64>) -> Result<Self, ExportError> {
        let engine = "Hunt and Crossley";
        let gaps = (0..GAPS).map(|index| loading.indentation * (WIDEST_GAP * index as f64 / (GAPS - 1) as f64));
        let compared = gaps.filter_map(|gap| {
            let (_, error) = fit_rounds(&rows(loading, radius, gap), NEEDS, ROUNDS)?;
            Some((gap, error))
        });
        let best = compared.min_by(|(_, a), (_, b)| a.total_cmp(b));
        let (gap, _) = best.ok_or(ExportError::NoFit { engine })?;
        let [k, k_d, e, e_d] = fit(&rows(loading, radius, gap), NEEDS).ok_or(ExportError::NoFit { engine })?;
        let part = |elastic: f64, dissipated: f64| {
            (elastic > 0.0).then(|| Dissipative {
                elastic,
                dissipation: dissipated / elastic,
            })
        };
        let mut found = Self {
            radius,
            point: part(k, k_d),
            gap,
            hydroelastic: part(e, e_d),
            error: loading.error(|_, _| 0.0),
        };
        found.error = loading.error(|u, speed| found.force(u, speed));
        Ok(found)
    }

    /// Force (N) at an indentation (m) and its speed (m/s).
    #[must_use]
    pub fn force(&self, indentation: f64, speed: f64) -> f64 {
        let u = indentation.max(0.0);
        let damped = |part: Dissipative| part.elastic * (1.0 + part.dissipation * speed).max(0.0);
        let field = self.radius.map_or(0.0, |radius| pressure_force(radius, u));
        let point = self.point.map_or(0.0, |part| (u - self.gap).max(0.0) * damped(part));
        point + self.hydroelastic.map_or(0.0, |part| field * damped(part))
    }
}

/// What k, k d, E and E d are multiplied by, with the force.
fn rows(loading: &Loading, radius: Option<f64>, gap: f64) -> Vec<([f64; 4], f64)> {
    let row = |sample: &LoadingSample| {
        let (u, speed) = ((sample.indentation - gap).max(0.0), sample.speed);
        let field = radius.map_or(0.0, |radius| pressure_force(radius, sample.indentation));
        ([u, u * speed, field, field * speed], sample.force)
    };
    loading.fitted().map(row).collect()
}

/// Force (m²) of a pressure field of modulus 1 in a ball.
fn pressure_force(radius: f64, u: f64) -> f64 {
    let h = u / radius;
    PI * u * u * (1.0 - 2.0 / 3.0 * h)
}
