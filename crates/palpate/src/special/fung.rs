//! Fung's continuous spectrum: relaxation times spread evenly over ln τ between two ends.
//!
//! Fung, *Biomechanics: Mechanical Properties of Living Tissues* (1981), section 7.6.

use super::exponential_integral::{entire_exponential_integral, exponential_integral};
use crate::vector::elementary::exp;

/// φ = [E1(λ_slow t) − E1(λ_fast t)] / ln(λ_fast/λ_slow), the mean of exp(−λt) over ln λ between the two rates, and its derivatives by
/// the logarithms of the rates, at many times.
///
/// Times t ≥ 0 in s, rates > 0 in 1/s; the order of the rates does not matter and equal rates give exp(−λt).
/// Relative error below 1e-13. At λ_slow t = 0.5, λ_fast t = 1 φ = 0.491 078 (= 0.340 389/ln 2).
///
/// # Panics
/// If the slices differ in length.
pub(crate) fn fung_continuous_many(
    times: &[f64],
    rate_slow: f64,
    rate_fast: f64,
    value: &mut [f64],
    by_log_slow: &mut [f64],
    by_log_fast: &mut [f64],
) {
    if rate_slow > rate_fast {
        return fung_continuous_many(times, rate_fast, rate_slow, value, by_log_fast, by_log_slow);
    }
    assert_eq!(times.len(), value.len(), "one output a time");
    assert_eq!(times.len(), by_log_slow.len(), "one output a time");
    assert_eq!(times.len(), by_log_fast.len(), "one output a time");
    let spectrum = Spectrum::new(rate_slow, rate_fast);
    for (((t, value), slow), fast) in times.iter().zip(value).zip(by_log_slow).zip(by_log_fast) {
        [*value, *slow, *fast] = spectrum.at(*t);
    }
}

/// Gauss–Legendre on [−1, 1], the positive half: (node, weight).
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_3),
];

/// A spectrum whose ends are nearer than this in ln λ is summed by [`GAUSS`] while (λ_fast − λ_slow) t < 1:
/// the difference of two E1 would cancel, and the integrand is as good as a polynomial.
const NARROW: f64 = 0.5;

struct Spectrum {
    rate_slow: f64,
    rate_fast: f64,
    /// ln(λ_fast/λ_slow).
    span: f64,
    /// Rates, their weights, and their places between the slow (0) and the fast end (1).
    rates: [(f64, f64, f64); 8],
}

impl Spectrum {
    fn new(rate_slow: f64, rate_fast: f64) -> Self {
        let span = ((rate_fast - rate_slow) / rate_slow).ln_1p();
        let rates = std::array::from_fn(|j| {
            let (node, weight) = GAUSS[j / 2];
            let place = if j % 2 == 0 { 0.5 - 0.5 * node } else { 0.5 + 0.5 * node };
            (rate_slow * (span * place).exp(), 0.5 * weight, place)
        });
        Self {
            rate_slow,
            rate_fast,
            span,
            rates,
        }
    }

    #[inline]
    fn at(&self, time: f64) -> [f64; 3] {
        let (slow, fast, span) = (self.rate_slow * time, self.rate_fast * time, self.span);
        if span < NARROW && fast - slow < 1.0 {
            return self.mean(time);
        }
        if fast < 1.0 {
            // 1 − φ, free of the logarithm that both E1 have.
            let lost = (entire_exponential_integral(fast) - entire_exponential_integral(slow)) / span;
            return [1.0 - lost, (-(-slow).exp_m1() - lost) / span, ((-fast).exp_m1() + lost) / span];
        }
        let (integral_slow, exp_slow) = exponential_integral(slow);
        let (integral_fast, exp_fast) = exponential_integral(fast);
        let value = (integral_slow - integral_fast) / span;
        [value, (value - exp_slow) / span, (exp_fast - value) / span]
    }

    /// ∫₀¹ exp(−λ(w) t) dw with ln λ linear in w.
    #[inline]
    fn mean(&self, time: f64) -> [f64; 3] {
        let (mut value, mut by_log_slow, mut by_log_fast) = (0.0, 0.0, 0.0);
        for (rate, weight, place) in self.rates {
            let s = rate * time;
            let part = weight * exp(-s);
            value += part;
            by_log_slow -= (1.0 - place) * s * part;
            by_log_fast -= place * s * part;
        }
        [value, by_log_slow, by_log_fast]
    }
}
