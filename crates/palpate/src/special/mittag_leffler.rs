//! The Mittag-Leffler function on the negative axis, the decay of a fractional Zener body.
//!
//! With z = s p in its inverse Laplace integral,
//!
//! E_α(−s^α) = 1/(2πi) ∫ e^z / [z (1 + s^α z^(−α))] dz,
//!
//! s stands beside nothing but z^(−α), so one contour and one set of nodes serve every s. The contour is the
//! cotangent of Weideman, SIAM J. Numer. Anal. 44 (2006) 2342: with 24 nodes, of which conjugate symmetry spares
//! half, the error is 3.89⁻²⁴. What is left is E ≈ Re Σ C_j/(1 + s^α z_j^(−α)): one power and twelve complex
//! divisions a sample, without a branch.

use std::f64::consts::PI;
use std::sync::LazyLock;

use crate::vector::elementary::{exp, ln};

/// Nodes in the upper half plane.
const NODES: usize = 12;
/// Samples that go through the nodes together: few enough for the nearest cache, enough for vector code.
const BLOCK: usize = 64;
/// Above this α the exponential is split off: the sum of C_j/(1 + …) then cancels down to (1 − α)/s.
const SPLIT_ABOVE: f64 = 0.99;

/// E_α(−s^α) and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MittagLeffler {
    /// φ, from 1 at s = 0 towards 0.
    pub(crate) value: f64,
    /// ∂φ/∂ln s.
    pub(crate) by_log_rate: f64,
    /// ∂φ/∂α.
    pub(crate) by_alpha: f64,
}

/// φ = E_α(−s^α) = Σ (−s^α)^k / Γ(αk + 1) with its derivatives.
///
/// `s` = λt ≥ 0 (a pure number), 0.05 ≤ `alpha` ≤ 1; α = 1 is exp(−s), α = ½ is eˢ erfc(√s), and for large s
/// φ → s^(−α)/Γ(1 − α). Relative error of φ below 1e-11 for s up to 1e30, of the derivatives below 1e-10.
/// At s = 1, α = ½ φ = e·erfc(1) = 0.427 583 576 155 807.
///
/// Neither crate mittagleffler 0.1.9 (5.7 µs a value, no derivative by α, 8e-10 off at α = 0.999999) nor quadrature
/// of the spectrum, a needle for α near 1, would do.
#[must_use]
pub(crate) fn mittag_leffler_decay(s: f64, alpha: f64) -> MittagLeffler {
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
        sum.value(&samples, value);
        sum.gradient(&samples, by_log_rate, by_alpha);
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
    }
}

#[derive(Debug, Clone, Copy, Default)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }

    #[inline(always)]
    fn scaled(self, by: f64) -> Self {
        Self {
            re: by * self.re,
            im: by * self.im,
        }
    }

    /// 1/(1 + self).
    #[inline(always)]
    fn one_over_one_plus(self) -> Self {
        let re = 1.0 + self.re;
        let inverse = 1.0 / (re * re + self.im * self.im);
        Self {
            re: re * inverse,
            im: -self.im * inverse,
        }
    }

    fn exp(self) -> Self {
        let (sin, cos) = self.im.sin_cos();
        Self { re: cos, im: sin }.scaled(self.re.exp())
    }

    fn exp_m1(self) -> Self {
        let half = (0.5 * self.im).sin();
        Self {
            re: self.re.exp_m1() * self.im.cos() - 2.0 * half * half,
            im: self.re.exp() * self.im.sin(),
        }
    }
}

/// ln z_j and C_j = 2 e^z z′/(24 i z) on z(θ) = 24 [0.5017 θ cot 0.6407θ − 0.6122 + 0.2645 iθ], θ_j = (j + ½)π/12.
static CONTOUR: LazyLock<[(Complex, Complex); NODES]> = LazyLock::new(|| {
    let total = 2.0 * NODES as f64;
    std::array::from_fn(|j| {
        let theta = (j as f64 + 0.5) * PI / NODES as f64;
        let (sin, cos) = (0.6407 * theta).sin_cos();
        let z = Complex {
            re: total * (0.5017 * theta * cos / sin - 0.6122),
            im: total * 0.2645 * theta,
        };
        // z′/(24 i): real and imaginary part change places.
        let slope = Complex {
            re: 0.2645,
            im: -0.5017 * (cos / sin - 0.6407 * theta / (sin * sin)),
        };
        let log = Complex {
            re: z.re.hypot(z.im).ln(),
            im: z.im.atan2(z.re),
        };
        let inverse = Complex {
            re: -log.re,
            im: -log.im,
        }
        .exp();
        (log, slope.times(inverse).times(z.exp()).scaled(2.0))
    })
});

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
        let x = &samples.x[..value.len()];
        for node in &self.nodes {
            for (x, value) in x.iter().zip(value.iter_mut()) {
                let d = node.power.scaled(*x).one_over_one_plus();
                *value += node.weight.re * d.re - node.weight.im * d.im;
            }
        }
        for (x, value) in x.iter().zip(value.iter_mut()) {
            // What the nodes lack of 1 counts as one more of them, at z = 1.
            *value = (*value + self.lacking / (1.0 + x)).min(1.0);
        }
    }

    /// ∂φ/∂ln s = −α x Re Σ C W D² and ∂φ/∂α = −x Re Σ C W (ln s − ln z) D² with D = 1/(1 + x W).
    fn gradient(&self, samples: &Samples, by_log_rate: &mut [f64], by_alpha: &mut [f64]) {
        by_log_rate.fill(0.0);
        by_alpha.fill(0.0);
        let (x, log) = (&samples.x[..by_alpha.len()], &samples.log[..by_alpha.len()]);
        for node in &self.nodes {
            for ((x, by_log_rate), by_alpha) in x.iter().zip(by_log_rate.iter_mut()).zip(by_alpha.iter_mut()) {
                let d = node.power.scaled(*x).one_over_one_plus();
                let d2 = d.times(d);
                *by_log_rate += node.slope.re * d2.re - node.slope.im * d2.im;
                *by_alpha += node.slope_log.re * d2.re - node.slope_log.im * d2.im;
            }
        }
        for (((x, log), by_log_rate), by_alpha) in x.iter().zip(log).zip(by_log_rate.iter_mut()).zip(by_alpha) {
            *by_alpha = x * (*by_alpha - log * *by_log_rate);
            *by_log_rate *= -self.alpha * x;
        }
        if self.alpha > SPLIT_ABOVE {
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
                let sum = Complex {
                    re: a.re + b.re - 1.0,
                    im: a.im + b.im,
                };
                let steeper = node.difference(samples, i, a, b).times(sum);
                let slower = node.power.scaled(rest * samples.x[i]).times(a).times(a);
                let slope = Complex {
                    re: steeper.re + slower.re,
                    im: steeper.im + slower.im,
                };
                *by_log_rate += node.weight.times(slope).re;
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
        let excess = Complex {
            re: -of_s - (1.0 + of_s) * self.excess.re,
            im: -(1.0 + of_s) * self.excess.im,
        };
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
        for ((((t, s), log), x), excess) in times.iter().zip(&mut s).zip(&mut log).zip(&mut x).zip(&mut excess) {
            *s = rate * t;
            *log = ln(s.clamp(1e-300, 1e300));
            let power = exp(alpha * *log);
            *x = if *s > 0.0 { power } else { 0.0 };
            if alpha > SPLIT_ABOVE {
                *excess = ((alpha - 1.0) * *log).exp_m1();
            }
        }
        Self { s, log, x, excess }
    }
}
