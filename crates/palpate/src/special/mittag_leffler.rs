//! The Mittag-Leffler function on the negative axis, the decay of a fractional Zener body.
//!
//! With z = s p in its inverse Laplace integral,
//!
//! E_α(−s^α) = 1/(2πi) ∫ e^z / [z (1 + s^α z^(−α))] dz,
//!
//! s stands beside nothing but z^(−α), so one contour and one set of nodes serve every s. The trapezoidal
//! rule on the contour in `contour.rs` is E ≈ Re Σ C_j/(1 + s^α z_j^(−α)): one power and twelve complex divisions
//! a sample, without a branch. Its error, 1e-14, has to be observed beside 1/Γ(1 − α), hence what happens near α = 1.

use super::contour::{CONTOUR, Complex, NODES};
use crate::vector::elementary::{exp, ln};

/// Samples that go through the nodes together: few enough for the nearest cache, enough for vector code.
const BLOCK: usize = 64;
/// Above this α the exponential is split off: the sum of C_j/(1 + …) then cancels down to (1 − α)/s.
const SPLIT_ABOVE: f64 = 0.99;

/// E_α(−s^α) and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MittagLeffler {
    /// φ, from 1 at s = 0 towards 0.
    pub value: f64,
    /// ∂φ/∂ln s.
    pub by_log_rate: f64,
    /// ∂φ/∂α.
    pub by_alpha: f64,
}

/// φ = E_α(−s^α) = Σ (−s^α)^k / Γ(αk + 1) with its derivatives.
///
/// `s` = λt ≥ 0 (dimensionless), 0.05 ≤ `alpha` ≤ 1; α = 1 is exp(−s), α = ½ is eˢ erfc(√s), and for large s
/// φ → s^(−α)/Γ(1 − α). Relative error of φ below 1e-11 for s up to 1e30, of the derivatives below 1e-10.
/// At s = 1, α = ½ φ = e·erfc(1) = 0.427 583 576 155 807.
///
/// Neither crate mittagleffler 0.1.9 (5.7 µs a value, no derivative by α, 8e-10 off at α = 0.999999) nor quadrature
/// of the spectrum, a needle for α near 1, would do.
///
/// ```
/// use palpate::special::mittag_leffler_decay;
/// // mpmath: e·erfc(1)
/// assert!((mittag_leffler_decay(1.0, 0.5).value - 0.427_583_576_155_807).abs() < 1e-14);
/// ```
#[must_use]
pub fn mittag_leffler_decay(s: f64, alpha: f64) -> MittagLeffler {
    let [mut value, mut by_log_rate, mut by_alpha] = [[0.0]; 3];
    mittag_leffler_decay_many(&[s], 1.0, alpha, &mut value, &mut by_log_rate, &mut by_alpha);
    MittagLeffler {
        value: value[0],
        by_log_rate: by_log_rate[0],
        by_alpha: by_alpha[0],
    }
}

/// φ, ∂φ/∂ln λ and ∂φ/∂α at s = λtᵢ for every time, in any order; arguments as for [`mittag_leffler_decay`].
///
/// # Panics
/// If the slices differ in length.
pub(crate) fn mittag_leffler_decay_many(
    times: &[f64],
    rate: f64,
    alpha: f64,
    value: &mut [f64],
    by_log_rate: &mut [f64],
    by_alpha: &mut [f64],
) {
    assert_eq!(times.len(), value.len(), "one output a time");
    assert_eq!(times.len(), by_log_rate.len(), "one output a time");
    assert_eq!(times.len(), by_alpha.len(), "one output a time");
    let sum = Sum::new(alpha);
    let slopes = by_log_rate.chunks_mut(BLOCK).zip(by_alpha.chunks_mut(BLOCK));
    for ((times, value), (by_log_rate, by_alpha)) in times.chunks(BLOCK).zip(value.chunks_mut(BLOCK)).zip(slopes) {
        let samples = Samples::new(times, rate, alpha);
        sum.gradient(&samples, value, by_log_rate, by_alpha);
    }
}

/// As [`mittag_leffler_decay_many`], φ alone.
///
/// # Panics
/// If the slices differ in length.
pub(crate) fn mittag_leffler_decay_value_many(times: &[f64], rate: f64, alpha: f64, value: &mut [f64]) {
    assert_eq!(times.len(), value.len(), "one output a time");
    let sum = Sum::new(alpha);
    for (times, value) in times.chunks(BLOCK).zip(value.chunks_mut(BLOCK)) {
        sum.value(&Samples::new(times, rate, alpha), value);
        // At the limit the sum is ∞/∞.
        times.iter().zip(value).filter(|(time, _)| time.is_infinite()).for_each(|(_, value)| *value = 0.0);
    }
}

/// What a node contributes for one α.
#[derive(Debug, Clone, Copy, Default)]
struct Node {
    /// C.
    weight: Complex,
    /// W = z^(−α).
    power: Complex,
    /// C W.
    slope: Complex,
    /// C W ln z.
    slope_log: Complex,
    /// 1/z.
    inverse: Complex,
    /// z^(1−α) − 1.
    excess: Complex,
}

/// The sum over the nodes for one α.
struct Sum {
    alpha: f64,
    nodes: [Node; NODES],
    /// 1 − Re Σ C, the error at s = 0.
    lacking: f64,
}

impl Sum {
    fn new(alpha: f64) -> Self {
        let nodes = CONTOUR.map(|(log, weight)| {
            let power = log.scaled(-alpha).exp();
            let slope = weight.times(power);
            Node {
                weight,
                power,
                slope,
                slope_log: slope.times(log),
                inverse: log.scaled(-1.0).exp(),
                excess: log.scaled(1.0 - alpha).exp_m1(),
            }
        });
        let lacking = 1.0 - nodes.iter().map(|node| node.weight.re).sum::<f64>();
        Self { alpha, nodes, lacking }
    }

    fn value(&self, samples: &Samples, value: &mut [f64]) {
        if self.alpha > SPLIT_ABOVE {
            return self.value_beside_exponential(samples, value);
        }
        value.fill(0.0);
        for node in &self.nodes {
            for (x, value) in samples.x.iter().zip(value.iter_mut()) {
                let d = node.power.scaled(*x).one_over_one_plus();
                *value += node.weight.re * d.re - node.weight.im * d.im;
            }
        }
        self.complete(samples, value);
    }

    /// What the nodes lack of 1 counts as one more of them, at z = 1.
    fn complete(&self, samples: &Samples, value: &mut [f64]) {
        for (x, value) in samples.x.iter().zip(value) {
            *value = (*value + self.lacking / (1.0 + x)).min(1.0);
        }
    }

    /// φ, ∂φ/∂ln s = −α x Re Σ C W D² and ∂φ/∂α = −x Re Σ C W (ln s − ln z) D² with D = 1/(1 + x W).
    fn gradient(&self, samples: &Samples, value: &mut [f64], by_log_rate: &mut [f64], by_alpha: &mut [f64]) {
        value.fill(0.0);
        by_log_rate.fill(0.0);
        by_alpha.fill(0.0);
        for node in &self.nodes {
            let sums = value.iter_mut().zip(by_log_rate.iter_mut()).zip(by_alpha.iter_mut());
            for (x, ((value, by_log_rate), by_alpha)) in samples.x.iter().zip(sums) {
                let d = node.power.scaled(*x).one_over_one_plus();
                let d2 = d.times(d);
                *value += node.weight.re * d.re - node.weight.im * d.im;
                *by_log_rate += node.slope.re * d2.re - node.slope.im * d2.im;
                *by_alpha += node.slope_log.re * d2.re - node.slope_log.im * d2.im;
            }
        }
        self.complete(samples, value);
        let slopes = by_log_rate.iter_mut().zip(by_alpha);
        for ((x, log), (by_log_rate, by_alpha)) in samples.x.iter().zip(&samples.log).zip(slopes) {
            *by_alpha = x * (*by_alpha - log * *by_log_rate);
            *by_log_rate *= -self.alpha * x;
        }
        if self.alpha > SPLIT_ABOVE {
            self.value_beside_exponential(samples, value);
            self.slope_beside_exponential(samples, by_log_rate);
        }
    }

    /// φ as e⁻ˢ plus the difference, which is of the order of 1 − α and does not cancel.
    ///
    /// e⁻ˢ is the same integral with b = s/z in place of a = s^α z^(−α), so with A = 1/(1 + a), B = 1/(1 + b)
    /// the integrand of the difference is A − B = A b B [1 − (z/s)^(1−α)].
    fn value_beside_exponential(&self, samples: &Samples, value: &mut [f64]) {
        value.fill(0.0);
        for node in &self.nodes {
            for (i, value) in value.iter_mut().enumerate() {
                let (a, b) = node.of_both(samples, i);
                *value += node.weight.times(node.difference(samples, i, a, b)).re;
            }
        }
        for (s, value) in samples.s.iter().zip(value) {
            *value += (-s).exp();
        }
    }

    /// ∂φ/∂ln s in the same way: the integrand of the difference is (A − B)(A + B − 1) + (1 − α) a A².
    fn slope_beside_exponential(&self, samples: &Samples, by_log_rate: &mut [f64]) {
        by_log_rate.fill(0.0);
        let rest = 1.0 - self.alpha;
        for node in &self.nodes {
            for (i, by_log_rate) in by_log_rate.iter_mut().enumerate() {
                let (a, b) = node.of_both(samples, i);
                let sum = Complex::new(a.re + b.re - 1.0, a.im + b.im);
                let steeper = node.difference(samples, i, a, b).times(sum);
                let slower = node.power.scaled(rest * samples.x[i]).times(a).times(a);
                *by_log_rate += node.weight.times(steeper.plus(slower)).re;
            }
        }
        for (s, by_log_rate) in samples.s.iter().zip(by_log_rate) {
            *by_log_rate -= s * (-s).exp();
        }
    }
}

impl Node {
    /// A and B of a sample.
    #[inline(always)]
    fn of_both(&self, samples: &Samples, i: usize) -> (Complex, Complex) {
        let a = self.power.scaled(samples.x[i]);
        let b = self.inverse.scaled(samples.s[i]);
        (a.one_over_one_plus(), b.one_over_one_plus())
    }

    /// A − B without cancellation; see [`Sum::value_beside_exponential`].
    #[inline(always)]
    fn difference(&self, samples: &Samples, i: usize, a: Complex, b: Complex) -> Complex {
        let of_s = samples.excess[i];
        let excess = Complex::new(-of_s - (1.0 + of_s) * self.excess.re, -(1.0 + of_s) * self.excess.im);
        a.times(self.inverse.scaled(samples.s[i]).times(b)).times(excess)
    }
}

/// What does not depend on the nodes, for up to [`BLOCK`] samples.
struct Samples {
    /// s = λt.
    s: [f64; BLOCK],
    /// ln s, finite also for s = 0.
    log: [f64; BLOCK],
    /// x = s^α.
    x: [f64; BLOCK],
    /// s^(α−1) − 1; only for α above [`SPLIT_ABOVE`].
    excess: [f64; BLOCK],
}

impl Samples {
    fn new(times: &[f64], rate: f64, alpha: f64) -> Self {
        let [mut s, mut log, mut x, mut excess] = [[0.0; BLOCK]; 4];
        let count = times.len();
        for (((t, s), log), x) in times.iter().zip(&mut s).zip(&mut log).zip(&mut x) {
            *s = rate * t;
            *log = ln(s.clamp(1e-300, 1e300));
            let power = exp(alpha * *log);
            *x = if *s > 0.0 { power } else { 0.0 };
        }
        if alpha > SPLIT_ABOVE {
            for (log, excess) in log[..count].iter().zip(&mut excess) {
                *excess = ((alpha - 1.0) * log).exp_m1();
            }
        }
        Self { s, log, x, excess }
    }
}
