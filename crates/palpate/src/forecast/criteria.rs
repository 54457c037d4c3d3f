//! Information criteria.

use serde::{Deserialize, Serialize};

/// Information criteria of a least-squares fit; only differences between laws on the same samples mean anything.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Criteria {
    /// Akaike's, N ln(RSS/N) + 2p.
    pub aic: f64,
    /// Akaike's with the correction of Hurvich and Tsai (1989) for few samples, AIC + 2p (p + 1)/(N − p − 1); infinite where N ≤ p + 1.
    pub aicc: f64,
    /// Schwarz's (1978), N ln(RSS/N) + p ln N.
    pub bic: f64,
}

/// The criteria of a fit of `parameters` numbers to `samples` samples with a residual square of `residual_square`.
///
/// For Gaussian noise of unknown size, up to a constant that all laws share. `parameters` counts the numbers of the law, not
/// the noise: the convention of lmfit, to whose values these are equal. `samples` may be an effective number, where neighbours
/// repeat each other.
///
/// ```
/// use palpate::forecast::criteria;
/// let c = criteria(0.5, 100.0, 3.0);
/// assert!((c.bic - (100.0 * 0.005f64.ln() + 3.0 * 100f64.ln())).abs() < 1e-9);
/// assert!((c.aicc - c.aic - 24.0 / 96.0).abs() < 1e-9);
/// ```
#[must_use]
pub fn criteria(residual_square: f64, samples: f64, parameters: f64) -> Criteria {
    let misfit = samples * (residual_square / samples).ln();
    let aic = misfit + 2.0 * parameters;
    let left = samples - parameters - 1.0;
    Criteria {
        aic,
        aicc: if left > 0.0 { aic + 2.0 * parameters * (parameters + 1.0) / left } else { f64::INFINITY },
        bic: misfit + parameters * samples.ln(),
    }
}
