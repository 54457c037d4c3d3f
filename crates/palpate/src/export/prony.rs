//! The latency law's decay as a gamma mixture of exponentials, and its quadrature.
//!
//! With a = 1/(n − 1) and θ = (n − 1) λ the closed form of a hold, equations (4) and (5), is the Laplace transform of a gamma density of
//! rates r with shape a and scale θ:
//!
//! φ(t) = (1 + θ t)^(−a) = ∫₀^∞ r^(a−1) e^(−r/θ)/(Γ(a) θ^a) e^(−r t) dr.
//!
//! The trapezoidal rule in ln r, with k points a decade, has an error of φ(t) 2 |Γ(a + iω)|/Γ(a) cos(ω ln(1 + θ t) + const) with
//! ω = 2π k/ln 10, and terms that are exponentially smaller (Poisson's sum formula): 1.7e-4 of φ for n = 5 and 2.2e-3 for n = 2 at two a
//! decade. Where the points lie is free; they are put where the weights sum to 1, so that φ(0) = 1 is exact.
//!
//! For n → 1 the density narrows to a single rate λ, and more points a decade are taken, at most as many as keep the error of n = 2; n = 1
//! is one exponential. For n < 1 the hold ends after a finite time, no mixture of exponentials does, and there is no series.

use core::f64::consts::{LN_10, PI};

use super::ExportError;

/// A decaying exponential of a Prony series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PronyTerm {
    /// Its share g of the initial force.
    pub share: f64,
    /// Its time constant τ, s.
    pub time_constant: f64,
}

/// A relaxation R(t) = g_∞ + Σ g_i exp(−t/τ_i), with g_∞ + Σ g_i = 1.
#[derive(Debug, Clone, PartialEq)]
pub struct PronySeries {
    /// g_∞.
    equilibrium: f64,
    /// By rising time constant.
    terms: Vec<PronyTerm>,
}

/// Largest r t at the end of the range of the terms that are merged to one.
const SLOW: f64 = 0.03;

/// r/θ below which e^(−r/θ) is 1 in the sums.
const SMALL: f64 = 1e-9;

/// n − 1 below which the series is one exponential.
const NEAR_ONE: f64 = 1e-3;

/// Most points a decade.
const MOST: f64 = 400.0;

impl PronySeries {
    /// φ(t; λ, n) of the latency law over `0 ≤ t ≤ longest` (s), with a relative rate λ (1/s) at the start of the hold and an exponent
    /// n ≥ 1, by `terms_per_decade` terms; more for n below 2.
    ///
    /// Terms that have hardly decayed by `longest` are merged to one of the same weight and first moment. **λ = v |x₀|ⁿ⁻¹ depends on the
    /// excess strain at the start of the hold**: a series is of one depth and one loading.
    ///
    /// ```
    /// use palpate::export::PronySeries;
    /// use palpate::latency::decay;
    /// let series = PronySeries::of_latency(5.0, 6.6, 60.0, 2.0)?;
    /// let error = series.worst_error(60.0, |time| decay(6.6 * time, 5.0));
    /// assert!(error < 2e-4, "{error}");
    /// # Ok::<(), palpate::export::ExportError>(())
    /// ```
    ///
    /// # Errors
    /// [`ExportError::NoMixture`] for n < 1; [`ExportError::Condition`] for a rate, time or number of terms that is not above 0.
    pub fn of_latency(
        exponent: f64,
        relative_rate: f64,
        longest: f64,
        terms_per_decade: f64,
    ) -> Result<Self, ExportError> {
        checked("relative rate", relative_rate, " 1/s", f64::INFINITY)?;
        checked("longest time", longest, " s", f64::INFINITY)?;
        checked("number of terms a decade", terms_per_decade, "", 20.0)?;
        if !(exponent.is_finite() && exponent >= 1.0) {
            return Err(ExportError::NoMixture { exponent });
        }
        // An exponential differs by ½ (n − 1) (λ t)² e^(−λ t) and less, 0.27 (n − 1) at most.
        if exponent - 1.0 < NEAR_ONE {
            let only = PronyTerm {
                share: 1.0,
                time_constant: 1.0 / relative_rate,
            };
            return Ok(Self {
                equilibrium: 0.0,
                terms: vec![only],
            });
        }
        let (shape, scale) = (1.0 / (exponent - 1.0), (exponent - 1.0) * relative_rate);
        let density = Density {
            shape,
            step: LN_10 / points_per_decade(shape, terms_per_decade),
        };
        Ok(density.series(density.offset(), scale, longest))
    }

    /// A series of terms whose shares, with that of the equilibrium, sum to 1.
    pub(super) fn of_terms(mut terms: Vec<PronyTerm>) -> Self {
        terms.sort_by(|a, b| a.time_constant.total_cmp(&b.time_constant));
        Self {
            equilibrium: 1.0 - terms.iter().map(|term| term.share).sum::<f64>(),
            terms,
        }
    }

    /// The same relaxation above an equilibrium share, R = g_∞ + (1 − g_∞) φ.
    #[must_use]
    pub(super) fn above(self, equilibrium: f64) -> Self {
        let scaled = |term: PronyTerm| PronyTerm {
            share: (1.0 - equilibrium) * term.share,
            ..term
        };
        Self {
            equilibrium: equilibrium + (1.0 - equilibrium) * self.equilibrium,
            terms: self.terms.into_iter().map(scaled).collect(),
        }
    }

    /// g_∞, the share of the initial force that does not relax.
    #[must_use]
    pub fn equilibrium(&self) -> f64 {
        self.equilibrium
    }

    /// The terms, by rising time constant.
    #[must_use]
    pub fn terms(&self) -> &[PronyTerm] {
        &self.terms
    }

    /// R at a time (s) after the start of the hold.
    #[must_use]
    pub fn value(&self, time: f64) -> f64 {
        self.terms
            .iter()
            .fold(self.equilibrium, |sum, term| sum + term.share * (-time / term.time_constant).exp())
    }

    /// Largest difference to a relaxation over `0 ≤ t ≤ longest` (s), at 0 and at 400 times over nine decades.
    #[must_use]
    pub fn worst_error(&self, longest: f64, relaxation: impl Fn(f64) -> f64) -> f64 {
        let times = (0..400).map(|i| longest * 10f64.powf(-9.0 * f64::from(i) / 399.0));
        let error = |time: f64| (self.value(time) - relaxation(time)).abs();
        times.map(error).fold(error(0.0), f64::max)
    }
}

fn checked(name: &'static str, found: f64, unit: &'static str, most: f64) -> Result<(), ExportError> {
    if found.is_finite() && found > 0.0 && found <= most {
        return Ok(());
    }
    let expected = if most.is_finite() { "above 0 and at most 20" } else { "a finite number above 0" };
    Err(ExportError::Condition {
        name,
        expected,
        found,
        unit,
    })
}

/// 2 |Γ(a + iω)|/Γ(a), the error of k points a decade as a share of φ:
/// |Γ(a + iω)/Γ(a)|² = ∏ 1/(1 + ω²/(a + j)²), j = 0, 1, …; the factors beyond the first thousands by their integral.
fn error_share(shape: f64, points: f64) -> f64 {
    const FACTORS: i32 = 4000;
    let square = (2.0 * PI * points / LN_10).powi(2);
    let factors = (0..FACTORS).map(|j| (square / (shape + f64::from(j)).powi(2)).ln_1p());
    let beyond = square / (shape + f64::from(FACTORS) - 0.5);
    2.0 * (-0.5 * (factors.sum::<f64>() + beyond)).exp()
}

/// The points a decade that are requested, or as many more as have the error that those have for n = 2.
fn points_per_decade(shape: f64, requested: f64) -> f64 {
    let enough = error_share(1.0, requested) * (1.0 + 1e-9);
    let mut points = requested;
    while points < MOST && error_share(shape, points) > enough {
        points *= 1.05;
    }
    points
}

/// The density of ln z, z = r/θ, as a share of its largest value, (z/a)^a e^(a − z), on a grid of this step.
struct Density {
    shape: f64,
    step: f64,
}

impl Density {
    fn at(&self, z: f64) -> f64 {
        (self.shape * (z / self.shape).ln() + self.shape - z).exp()
    }

    /// Largest z of a grid: the density beyond is below e^−25.
    fn fastest(&self) -> f64 {
        self.shape + 8.0 * self.shape.sqrt() + 25.0
    }

    /// Sum of `power` 0 or 1 of z, weighted by the density, over z, z e^(−step), …; z is small enough for a geometric series.
    fn tail(&self, z: f64, power: f64) -> f64 {
        z.powf(power) * self.at(z) / -(-(self.shape + power) * self.step).exp_m1()
    }

    /// Sum over the grid fastest · e^(−(j + offset) step), j = 0, 1, …, times the step; below [`SMALL`] a geometric series.
    fn sum(&self, offset: f64) -> f64 {
        let (mut sum, mut z) = (0.0, self.fastest() * (-offset * self.step).exp());
        while z > SMALL {
            sum += self.at(z);
            z *= (-self.step).exp();
        }
        self.step * (sum + self.tail(z, 0.0))
    }

    /// The integral: the same sum with so small a step that its error is that of rounding.
    fn norm(&self) -> f64 {
        let fine = Self {
            step: self.step / 16.0,
            ..*self
        };
        fine.sum(0.0)
    }

    /// An offset, as a share of the step, at which the sum is the integral: the error goes like a sine of it.
    fn offset(&self) -> f64 {
        const PIECES: u32 = 8;
        let norm = self.norm();
        let error = |offset: f64| self.sum(offset) / norm - 1.0;
        let place = |piece: u32| f64::from(piece) / f64::from(PIECES);
        let changed = (0..PIECES).find(|piece| error(place(*piece)) * error(place(*piece + 1)) <= 0.0);
        let Some(piece) = changed else {
            return 0.0;
        };
        let (mut low, mut high) = (place(piece), place(piece + 1));
        let sign = error(low).signum();
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if error(middle) * sign > 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// The terms of the grid down to those that have hardly decayed after `longest` (s), and one for the rest.
    fn series(&self, offset: f64, scale: f64, longest: f64) -> PronySeries {
        let last = (SLOW / (scale * longest)).min(self.fastest());
        let (mut shares, mut z) = (Vec::new(), self.fastest() * (-offset * self.step).exp());
        while z > last {
            shares.push((self.step * self.at(z), z));
            z *= (-self.step).exp();
        }
        let (mut weight, mut moment) = (0.0, 0.0);
        while z > SMALL {
            weight += self.at(z);
            moment += z * self.at(z);
            z *= (-self.step).exp();
        }
        weight += self.tail(z, 0.0);
        moment += self.tail(z, 1.0);
        if weight > 0.0 {
            shares.push((self.step * weight, moment / weight));
        }
        let sum: f64 = shares.iter().map(|(share, _)| share).sum();
        // What is too fast to carry weight is left out.
        let term = |(share, z): &(f64, f64)| PronyTerm {
            share: share / sum,
            time_constant: 1.0 / (z * scale),
        };
        let mut terms: Vec<PronyTerm> = shares.iter().map(term).filter(|term| term.share > 1e-9).collect();
        let kept: f64 = terms.iter().map(|term| term.share).sum();
        terms.iter_mut().for_each(|term| term.share /= kept);
        terms.sort_by(|a, b| a.time_constant.total_cmp(&b.time_constant));
        PronySeries {
            equilibrium: 0.0,
            terms,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::latency::decay;

    fn error(exponent: f64, rate: f64, longest: f64, terms: f64) -> (f64, usize) {
        let series = PronySeries::of_latency(exponent, rate, longest, terms).unwrap();
        let sum: f64 = series.terms().iter().map(|term| term.share).sum();
        assert!((sum - 1.0).abs() < 1e-12 && series.terms().iter().all(|term| term.share > 0.0));
        (series.worst_error(longest, |time| decay(rate * time, exponent)), series.terms().len())
    }

    /// The error that Poisson's sum formula states, and that the issue of a Prony series is judged by.
    #[test]
    fn two_terms_a_decade_reproduce_the_law() {
        for (exponent, most) in [(2.0, 2.4e-3), (3.0, 9e-4), (5.0, 2e-4), (9.0, 1.2e-4)] {
            for longest in [0.1, 10.0, 60.0, 1e4] {
                let (found, terms) = error(exponent, 6.6, longest, 2.0);
                println!("n = {exponent}, {longest} s: {terms} terms, error {found:.2e}");
                assert!(found < most, "n = {exponent}, {longest} s: {found:.3e}");
            }
        }
    }

    #[test]
    fn more_terms_a_decade_leave_less_error() {
        let errors = [1.0, 2.0, 3.0].map(|terms| error(5.0, 2.0, 100.0, terms).0);
        assert!(errors[0] < 2e-2 && errors[1] < 0.05 * errors[0] && errors[2] < 0.2 * errors[1], "{errors:?}");
    }

    /// Near 1 the density is narrow: more points a decade, over fewer decades.
    #[test]
    fn near_one_the_series_has_more_points_and_at_one_it_is_one_exponential() {
        for exponent in [1.0 + 1e-4, 1.001, 1.01, 1.1, 1.5, 1.9] {
            let (found, terms) = error(exponent, 0.7, 60.0, 2.0);
            println!("n = {exponent}: {terms} terms, error {found:.2e}");
            assert!(found < 2.5e-3 && terms < 40, "n = {exponent}: {terms} terms, {found:.3e}");
        }
        let only = PronySeries::of_latency(1.0, 0.5, 60.0, 2.0).unwrap();
        assert_eq!(
            only.terms(),
            [PronyTerm {
                share: 1.0,
                time_constant: 2.0
            }]
        );
        assert_eq!(only.value(2.0), (-1f64).exp());
    }

    #[test]
    fn below_one_there_is_no_mixture() {
        let refused = PronySeries::of_latency(0.8, 1.0, 60.0, 2.0);
        assert_eq!(refused, Err(ExportError::NoMixture { exponent: 0.8 }));
        assert!(PronySeries::of_latency(f64::NAN, 1.0, 60.0, 2.0).is_err());
        for (rate, longest, terms) in [(0.0, 60.0, 2.0), (1.0, f64::INFINITY, 2.0), (1.0, 60.0, 0.0), (1.0, 60.0, 21.0)]
        {
            let refused = PronySeries::of_latency(5.0, rate, longest, terms);
            assert!(matches!(refused, Err(ExportError::Condition { .. })), "{refused:?}");
        }
    }
}
