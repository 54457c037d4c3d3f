//! The normalised closed form, and the law with its parameters.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;
use serde::{Deserialize, Serialize};

/// Normalised excess strain x(t)/x₀ under the latency law at constant equilibrium strain.
///
/// φ(t; λ, n) = [1 + (n − 1) λ t]^(−1/(n − 1)),  φ = exp(−λ t) at n = 1,  and for n < 1
/// φ = 0 from t = 1/((1 − n) λ) on. Equations (4) and (5) of the paper are x₀ φ with
/// λ = v |x₀|ⁿ⁻¹ and x₀ of either sign. It is the q-exponential e_q(−λ t) with q = n.
///
/// `scaled_time` is λ t ≥ 0 (dimensionless), `exponent` is n > 0. Returns a value from 0 to 1.
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
    if z == 0.0 || p == 0.0 {
        // n = 1, t = 0, or a product too small to tell from them.
        return (-scaled_time).exp();
    }
    (-z.ln_1p() / p).exp()
}

/// Invalid parameters of a law.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LawError {
    /// The exponent must be a finite number above zero.
    #[error("exponent n must be a number above 0, found {found}")]
    Exponent {
        /// What was given.
        found: f64,
    },
    /// The rate coefficient must be a finite number above zero.
    #[error("rate coefficient v must be above 0 1/s, found {found} 1/s")]
    RateCoefficient {
        /// What was given, in 1/s.
        found: f64,
    },
}

/// The nonlinear latency law, ẋ = −v sgn(x) |x|ⁿ with x = ε − ε_e.
///
/// Equation (2) for every real n > 0: its odd branch is equation (3), and n = 5 is equation (10).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LatencyLaw {
    exponent: f64,
    rate_coefficient: f64,
}

impl LatencyLaw {
    /// A law with exponent n > 0 and rate coefficient v > 0 in 1/s.
    ///
    /// # Errors
    /// [`LawError`] for an exponent or coefficient that is not a finite number above zero.
    ///
    /// ```
    /// use palpate::latency::LatencyLaw;
    /// let law = LatencyLaw::new(5.0, 2e4)?;
    /// // the paper's equation (10): strain 0.1 above equilibrium falls at 0.2 per second
    /// assert!((law.rate(0.1) + 0.2).abs() < 1e-15);
    /// # Ok::<(), palpate::latency::LawError>(())
    /// ```
    pub fn new(exponent: f64, rate_coefficient: f64) -> Result<Self, LawError> {
        if !(exponent.is_finite() && exponent > 0.0) {
            return Err(LawError::Exponent { found: exponent });
        }
        if !(rate_coefficient.is_finite() && rate_coefficient > 0.0) {
            return Err(LawError::RateCoefficient {
                found: rate_coefficient,
            });
        }
        Ok(Self {
            exponent,
            rate_coefficient,
        })
    }

    /// n, dimensionless.
    #[must_use]
    pub fn exponent(&self) -> f64 {
        self.exponent
    }

    /// v in 1/s.
    #[must_use]
    pub fn rate_coefficient(&self) -> f64 {
        self.rate_coefficient
    }

    /// The law with its rate coefficient times a factor above 0; within the range of doubles.
    #[cfg(feature = "std")]
    pub(crate) fn times(self, factor: f64) -> Self {
        let rate_coefficient = (self.rate_coefficient * factor).clamp(f64::MIN_POSITIVE, f64::MAX);
        Self {
            rate_coefficient,
            ..self
        }
    }

    /// Strain rate in 1/s at excess strain `excess` = ε − ε_e, equations (2), (3) and (10).
    ///
    /// −v sgn(x) |x|ⁿ; zero at x = 0, always towards equilibrium.
    #[must_use]
    pub fn rate(&self, excess: f64) -> f64 {
        -self.rate_coefficient * signed_power(excess, self.exponent)
    }

    /// λ = v |x₀|ⁿ⁻¹ in 1/s, the relative rate at which an excess strain x₀ begins to fall.
    ///
    /// For n < 1 it grows without bound as x₀ → 0; at x₀ = 0 nothing moves and 0 is returned.
    #[must_use]
    pub fn relative_rate(&self, excess: f64) -> f64 {
        if excess == 0.0 {
            return 0.0;
        }
        self.rate_coefficient * power(excess.abs(), self.exponent - 1.0)
    }

    /// Excess strain a time `elapsed` ≥ 0 (s) after it was `initial`, at constant equilibrium strain: equations (4) and (5).
    ///
    /// x(t) = x₀ φ(λ t; n), exact at any t and of the sign of x₀.
    ///
    /// ```
    /// use palpate::latency::LatencyLaw;
    /// // The hold at 5 mm of the paper's test (a): 0.133032479302 falls to 0.033403736623 in 10 s.
    /// let law = LatencyLaw::new(5.0, 2e4)?;
    /// let x = law.excess_after(0.133_032_479_302, 10.0);
    /// assert!((x - 0.033_403_736_623).abs() < 1e-12);
    /// assert_eq!(law.excess_after(-0.133_032_479_302, 10.0), -x);
    /// # Ok::<(), palpate::latency::LawError>(())
    /// ```
    #[must_use]
    pub fn excess_after(&self, initial: f64, elapsed: f64) -> f64 {
        // No time is none at a rate beyond all numbers, too.
        if initial == 0.0 || elapsed == 0.0 {
            return initial;
        }
        let s = self.relative_rate(initial) * elapsed;
        // The paper's exponent is worth one branch: two roots instead of exp and ln, and exact.
        if self.exponent == 5.0 {
            return initial / (1.0 + 4.0 * s).sqrt().sqrt();
        }
        initial * decay(s, self.exponent)
    }

    /// The steady excess strain under a constant drive `drive` = g (1/s): sgn(g) (|g|/v)^(1/n).
    #[must_use]
    pub fn steady_excess(&self, drive: f64) -> f64 {
        drive.signum() * (drive.abs() / self.rate_coefficient).powf(1.0 / self.exponent)
    }
}

/// sgn(x) |x|ⁿ, with a product instead of a power for the small whole n that people use.
pub(crate) fn signed_power(x: f64, n: f64) -> f64 {
    power(x.abs(), n) * if x < 0.0 { -1.0 } else { 1.0 }
}

/// aⁿ for a ≥ 0.
fn power(a: f64, n: f64) -> f64 {
    match n {
        1.0 => a,
        2.0 => a * a,
        3.0 => a * a * a,
        4.0 => (a * a) * (a * a),
        5.0 => (a * a) * (a * a) * a,
        _ => a.powf(n),
    }
}

/// The linear latency law, equation (1): ε̇ = −v₁ (ε − ε_e) with ε_e = −N₀ c₀/α_c.
///
/// N₀ c₀ is the force that is left when relaxation is over, α_c the stiffness that turns strain to force.
/// The paper counts tension as positive in this equation, hence its minus sign; the same sign is kept here
/// for the one constructor that takes the paper's parameters, everything else counts compression as positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LinearLatency {
    /// v₁ in 1/s.
    pub rate_coefficient: f64,
    /// ε_e, tension positive as in equation (1).
    pub equilibrium_strain: f64,
}

impl LinearLatency {
    /// From Fung's parameters: `equilibrium_force` = N₀ c₀ in N and `stiffness` = α_c in N (force per unit strain).
    ///
    /// # Errors
    /// [`LawError::RateCoefficient`] unless v₁ is a finite number above zero.
    ///
    /// ```
    /// use palpate::latency::LinearLatency;
    /// let law = LinearLatency::from_fung(0.8, 6.0, 30.0)?;
    /// assert_eq!(law.equilibrium_strain, -0.2);
    /// assert!((law.rate(-0.3) - 0.08).abs() < 1e-15);
    /// # Ok::<(), palpate::latency::LawError>(())
    /// ```
    pub fn from_fung(rate_coefficient: f64, equilibrium_force: f64, stiffness: f64) -> Result<Self, LawError> {
        LatencyLaw::new(1.0, rate_coefficient)?;
        Ok(Self {
            rate_coefficient,
            equilibrium_strain: -equilibrium_force / stiffness,
        })
    }

    /// Strain rate in 1/s at strain ε (tension positive).
    #[must_use]
    pub fn rate(&self, strain: f64) -> f64 {
        -self.rate_coefficient * (strain - self.equilibrium_strain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn even_and_odd_branches_of_equation_2_are_one_formula() {
        for n in [1.0f64, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0] {
            let law = LatencyLaw::new(n, 3.0).unwrap();
            for x in [-0.4f64, -1e-3, 0.0, 1e-3, 0.4] {
                let paper = if n % 2.0 == 1.0 { -3.0 * x.powi(n as i32) } else { -x.signum() * 3.0 * x.powi(n as i32) };
                assert!((law.rate(x) - paper).abs() <= 1e-15 * paper.abs(), "n={n} x={x}");
            }
        }
    }

    #[test]
    fn closed_form_is_the_papers_equations_4_and_5() {
        let (n, v) = (5.0f64, 2e4);
        let law = LatencyLaw::new(n, v).unwrap();
        let (start, equilibrium) = (0.20f64, 0.30);
        let t = 3.7;
        // (4), ε_e > ε₀
        let c = (equilibrium - start).powf(1.0 - n) / (n - 1.0);
        let rising = equilibrium - ((n - 1.0) * (v * t + c)).powf(1.0 / (1.0 - n));
        assert!((equilibrium + law.excess_after(start - equilibrium, t) - rising).abs() < 1e-15);
        // (5), ε_e < ε₀
        let c = (0.40f64 - equilibrium).powf(1.0 - n) / (n - 1.0);
        let falling = equilibrium + ((n - 1.0) * (v * t + c)).powf(1.0 / (1.0 - n));
        assert!((equilibrium + law.excess_after(0.40 - equilibrium, t) - falling).abs() < 1e-15);
    }

    #[test]
    fn closed_form_solves_its_differential_equation() {
        for n in [0.3, 0.5, 0.999, 1.0, 1.001, 1.5, 2.0, 5.0, 7.3, 40.0] {
            let law = LatencyLaw::new(n, 1.7).unwrap();
            for x0 in [-0.9, 0.6] {
                let (t, h) = (0.4, 1e-5);
                let slope = (law.excess_after(x0, t + h) - law.excess_after(x0, t - h)) / (2.0 * h);
                let rate = law.rate(law.excess_after(x0, t));
                assert!((slope - rate).abs() < 1e-8 * (1.0 + rate.abs()), "n={n} x0={x0}: {slope} {rate}");
            }
        }
    }

    #[test]
    fn numbers_that_make_no_law_are_refused() {
        for (n, v) in [(0.0, 1.0), (-1.0, 1.0), (f64::NAN, 1.0), (5.0, 0.0), (5.0, -2.0), (5.0, f64::INFINITY)] {
            assert!(LatencyLaw::new(n, v).is_err(), "{n} {v}");
        }
    }

    #[test]
    fn nothing_moves_at_equilibrium() {
        for n in [0.5, 1.0, 5.0] {
            let law = LatencyLaw::new(n, 2.0).unwrap();
            assert_eq!(law.excess_after(0.0, 3.0), 0.0);
            assert_eq!(law.rate(0.0), 0.0);
            assert_eq!(law.relative_rate(0.0), 0.0);
        }
    }
}
