//! The normalised closed form of the law, equations (4) and (5) in one.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Value and derivatives of the normalised excess strain φ(t; λ, n).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decay {
    /// φ, from 1 at t = 0 towards 0.
    pub value: f64,
    /// ∂φ/∂ln λ.
    pub by_log_rate: f64,
    /// ∂φ/∂n.
    pub by_exponent: f64,
}

/// Below this |(n − 1) λt| the derivative by n uses its power series.
pub(super) const SERIES_BELOW: f64 = 0.1;

/// Normalised excess strain x(t)/x₀ under the latency law at constant equilibrium strain.
///
/// φ(t; λ, n) = [1 + (n − 1) λ t]^(−1/(n − 1)),  φ = exp(−λ t) at n = 1,  and for n < 1
/// φ = 0 from t = 1/((1 − n) λ) on. Equations (4) and (5) of the paper are x₀ φ with
/// λ = v |x₀|ⁿ⁻¹ and x₀ of either sign. It is the q-exponential e_q(−λ t) with q = n.
///
/// `scaled_time` is λ t ≥ 0 (a pure number), `exponent` is n > 0. Returns a number from 0 to 1.
///
/// Evaluated as exp(−ln(1 + p s)/p) with p = n − 1 and `ln_1p`, so that the limit n → 1 is reached
/// smoothly: the relative error stays near |ln φ| × 1e-16 for every n.
///
/// ```
/// use palpate::latency::decay;
/// assert_eq!(decay(0.0, 5.0), 1.0);
/// // n = 5 after λt = 20: 81^(-1/4) = 1/3
/// assert!((decay(20.0, 5.0) - 1.0 / 3.0).abs() < 1e-15);
/// // n = 1/2 reaches equilibrium at λt = 2 and stays
/// assert_eq!(decay(2.5, 0.5), 0.0);
/// ```
#[must_use]
pub fn decay(scaled_time: f64, exponent: f64) -> f64 {
    let p = exponent - 1.0;
    let z = p * scaled_time;
    if z <= -1.0 {
        return 0.0;
    }
    if z == 0.0 {
        // n = 1, t = 0, or a product too small to tell from them.
        return (-scaled_time).exp();
    }
    (-z.ln_1p() / p).exp()
}

/// φ together with its derivatives by ln λ and by n.
///
/// With s = λ t, z = (n − 1) s:  ∂φ/∂ln λ = −s φ/(1 + z)  and
/// ∂φ/∂n = φ s² h(z),  h(z) = [ln(1 + z) − z/(1 + z)]/z²  (h → 1/2 as z → 0).
///
/// Arguments as for [`decay`]. Past the finite end of a law with n < 1 all three are zero.
///
/// ```
/// use palpate::latency::decay_with_gradient;
/// // n = 1: φ = e⁻¹, ∂φ/∂ln λ = −e⁻¹, ∂φ/∂n = e⁻¹/2 at λt = 1
/// let d = decay_with_gradient(1.0, 1.0);
/// assert!((d.by_log_rate + (-1.0f64).exp()).abs() < 1e-15);
/// assert!((d.by_exponent - 0.5 * (-1.0f64).exp()).abs() < 1e-15);
/// ```
#[must_use]
pub fn decay_with_gradient(scaled_time: f64, exponent: f64) -> Decay {
    let s = scaled_time;
    let z = (exponent - 1.0) * s;
    if z <= -1.0 {
        return Decay {
            value: 0.0,
            by_log_rate: 0.0,
            by_exponent: 0.0,
        };
    }
    let value = decay(s, exponent);
    // s² alone overflows long after φ has vanished; the product is grouped to stay finite.
    let by_exponent = if z.abs() < SERIES_BELOW {
        value * s * s * exponent_series(z)
    } else {
        let p = exponent - 1.0;
        value * ((z.ln_1p() - z / (1.0 + z)) / p) / p
    };
    Decay {
        value,
        by_log_rate: -(s / (1.0 + z)) * value,
        by_exponent: if value == 0.0 { 0.0 } else { by_exponent },
    }
}

/// h(z) = Σ_{k≥2} (−1)^k (k−1)/k · z^(k−2), for |z| < [`SERIES_BELOW`]; the first term left out is below 1e-16.
pub(super) fn exponent_series(z: f64) -> f64 {
    const TERMS: usize = 17;
    let mut sum = 0.0;
    for k in (2..2 + TERMS).rev() {
        let coefficient = (k as f64 - 1.0) / k as f64;
        sum = coefficient - z * sum;
    }
    sum
}
