//! The memory of a linear law while what drives it is a polynomial of time.
//!
//! ẋ_k = g_k q̇ − λ_k x_k with q̇ = Σ a_p P_p(2c − 1)/width, c = t/width from 0 to 1 and Legendre's polynomials P_p, has the solution
//!
//! ```text
//! x_k(c) = x_k(0) exp(−z c) + g_k Σ a_p I_p(c, z),   I_p(c, z) = ∫₀ᶜ exp(−z (c − s)) P_p(2s − 1) ds,   z = λ_k width
//! ```
//!
//! I₀ has a closed form; the others are integrals of something smooth once the integral is cut where the exponential is over.

use std::sync::LazyLock;

use super::law::{LinearLaw, LinearTerm};
use crate::special;

/// Polynomials of q̇.
pub(super) const DEGREE: usize = 6;

/// A stretch of time, from `start` (s).
#[derive(Debug, Clone)]
pub(super) struct Stage {
    pub(super) start: f64,
    pub(super) width: f64,
    /// q at the start.
    pub(super) from: f64,
    /// a_p, in units of q.
    pub(super) rates: [f64; DEGREE],
    /// x_k at the start.
    pub(super) before: Vec<f64>,
}

impl Stage {
    /// A stage over which q goes straight by `by`.
    pub(super) fn straight(start: f64, width: f64, from: f64, by: f64, before: Vec<f64>) -> Self {
        let mut rates = [0.0; DEGREE];
        rates[0] = by;
        Self {
            start,
            width,
            from,
            rates,
            before,
        }
    }

    pub(super) fn end(&self) -> f64 {
        self.start + self.width
    }

    /// What `of` says of the stage that holds a time, and of c there.
    pub(super) fn within<T>(stages: &[Self], time: f64, of: impl Fn(&Self, f64) -> T) -> T {
        let index = stages.partition_point(|stage| stage.end() < time);
        let stage = &stages[index.min(stages.len() - 1)];
        of(stage, stage.part(time))
    }

    /// c at a time.
    fn part(&self, time: f64) -> f64 {
        if self.width > 0.0 { (time - self.start) / self.width } else { 0.0 }
    }

    /// Whether q goes straight.
    pub(super) fn is_straight(&self) -> bool {
        self.rates[1..].iter().all(|rate| *rate == 0.0)
    }

    /// q.
    pub(super) fn value(&self, part: f64) -> f64 {
        self.from + dot(&self.rates, &integrated(part))
    }

    /// q̇, 1/s times the unit of q.
    pub(super) fn slope(&self, part: f64) -> f64 {
        dot(&self.rates, &legendre(part)) / self.width
    }

    /// x_k.
    pub(super) fn memory(&self, part: f64, law: &LinearLaw) -> Vec<f64> {
        let is_straight = self.is_straight();
        let each = |(x, term): (&f64, &LinearTerm)| {
            let z = term.rate * self.width;
            let over = (-z * part).exp_m1();
            let driven = match () {
                () if self.width == 0.0 => 0.0,
                () if is_straight => -self.rates[0] * over / z,
                () => dot(&self.rates, &fading(z, part)),
            };
            x * (1.0 + over) + term.overshoot * driven
        };
        self.before.iter().zip(law.terms()).map(each).collect()
    }
}

pub(super) fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// P_p(2c − 1).
pub(super) fn legendre(part: f64) -> [f64; DEGREE] {
    special::legendre(2.0 * part - 1.0)
}

/// ∫₀ᶜ P_p(2s − 1) ds = (P_{p+1} − P_{p−1})/(2 (2p + 1)).
pub(super) fn integrated(part: f64) -> [f64; DEGREE] {
    let all: [f64; DEGREE + 1] = special::legendre(2.0 * part - 1.0);
    std::array::from_fn(|p| match p {
        0 => part,
        _ => (all[p + 1] - all[p - 1]) / (4 * p + 2) as f64,
    })
}

/// Where exp(−z s) has become nothing.
const OVER: f64 = 37.0;

/// z from which I_p follow from each other without loss of digits.
const FAST: f64 = 60.0;

/// I_p(c, z) to about 10⁻¹⁴.
pub(super) fn fading(z: f64, part: f64) -> [f64; DEGREE] {
    if z >= FAST {
        return fading_fast(z, part);
    }
    let length = part.min(OVER / z);
    if z * length <= SLOW {
        quadrature(z, part, length, &*FEW)
    } else {
        quadrature(z, part, length, &*GAUSS)
    }
}

/// I_p(c, z) by a rule over the last `length`.
fn quadrature(z: f64, part: f64, length: f64, rule: &[(f64, f64)]) -> [f64; DEGREE] {
    let mut sums = [0.0; DEGREE];
    for &(node, weight) in rule {
        let back = length * node;
        let weight = length * weight * (-z * back).exp();
        for (sum, value) in sums.iter_mut().zip(legendre(part - back)) {
            *sum += weight * value;
        }
    }
    sums
}

/// By parts, with P_p′ = 2 Σ (2 j + 1) P_j over j = p − 1, p − 3, …:
/// z I_p(c) = P_p(2c − 1) − (−1)^p exp(−z c) − 2 Σ (2 j + 1) I_j(c). An error grows by 2 (2 p − 1)/z from one to the next, which is below 1.
fn fading_fast(z: f64, part: f64) -> [f64; DEGREE] {
    let (values, left) = (legendre(part), (-z * part).exp());
    let mut found = [0.0; DEGREE];
    // Σ (2 j + 1) I_j over even j, and over odd ones.
    let mut sums = [0.0; 2];
    for p in 0..DEGREE {
        let start = if p % 2 == 0 { left } else { -left };
        found[p] = (values[p] - start - 2.0 * sums[(p + 1) % 2]) / z;
        sums[p % 2] += (2 * p + 1) as f64 * found[p];
    }
    found
}

/// Nodes and weights of Gauss's rule on 0…1.
pub(super) static GAUSS: LazyLock<[(f64, f64); 24]> = LazyLock::new(rule);

/// As many nodes as serve exponentials that fall by no more than exp(−`SLOW`).
static FEW: LazyLock<[(f64, f64); 12]> = LazyLock::new(rule);

const SLOW: f64 = 4.0;

fn rule<const N: usize>() -> [(f64, f64); N] {
    special::gauss_legendre().map(|(y, weight)| (0.5 * (1.0 - y), 0.5 * weight))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fading_integrals_are_right_from_slow_to_fast() {
        let total: f64 = GAUSS.iter().map(|(_, weight)| weight).sum();
        assert!((total - 1.0).abs() < 1e-14);
        for part in [1e-3, 0.2, 0.77, 1.0] {
            for z in [1e-12, 1e-3, 0.7, 5.0, 30.0, 37.0, 60.0, 1e4, 1e12] {
                let found = fading(z, part);
                // ∫ exp(−z (c − s)) ds and ∫ exp(−z (c − s)) (2s − 1) ds
                let zero = -f64::exp_m1(-z * part) / z;
                assert!((found[0] / zero - 1.0).abs() < 1e-13, "{z} {part}: {} {zero}", found[0]);
                if z > 0.5 {
                    let one = ((2.0 * part - 1.0) + (-z * part).exp()) / z - 2.0 * zero / z;
                    assert!((found[1] - one).abs() < 1e-13 * zero, "{z} {part}: {} {one}", found[1]);
                }
                if z < 1e-9 {
                    for (found, expected) in found.iter().zip(integrated(part)) {
                        assert!((found - expected).abs() < 1e-11 * part);
                    }
                }
            }
        }
    }

    #[test]
    fn fading_integrals_by_recursion_and_by_few_nodes_are_those_by_many() {
        for part in [0.0, 1e-3, 0.2, 0.77, 1.0] {
            // On either side of where one takes over from the other.
            let (below, above) = (fading(FAST * (1.0 - 1e-15), part), fading_fast(FAST, part));
            let few = [1e-6, 0.3, SLOW].map(|z| (quadrature(z, part, part, &*FEW), quadrature(z, part, part, &*GAUSS)));
            for (one, other) in few.into_iter().chain([(below, above)]) {
                for (one, other) in one.iter().zip(other) {
                    assert!((one - other).abs() < 3e-15, "{part}: {one} {other}");
                }
            }
        }
    }

    #[test]
    fn a_stage_in_two_halves_is_the_stage() {
        let law =
            LinearLaw::new(&[(2.0, 0.3), (0.5, 40.0)].map(|(overshoot, rate)| LinearTerm { overshoot, rate })).unwrap();
        let stage = Stage {
            start: 3.0,
            width: 2.0,
            from: 0.1,
            rates: [0.3, -0.1, 0.05, 0.02, -0.01, 0.004],
            before: vec![0.2, -0.03],
        };
        let whole = stage.memory(1.0, &law);
        // ẋ = g q̇ − λ x by the rule of Simpson over small steps of the solution itself
        let steps = 20_000;
        let mut x = stage.before.clone();
        for i in 0..steps {
            let (a, b) = (f64::from(i) / f64::from(steps), f64::from(i + 1) / f64::from(steps));
            let dt = (b - a) * stage.width;
            for (x, term) in x.iter_mut().zip(law.terms()) {
                let push = |c: f64, left: f64| (-term.rate * left * dt).exp() * term.overshoot * stage.slope(c);
                *x = *x * (-term.rate * dt).exp()
                    + dt / 6.0 * (push(a, 1.0) + 4.0 * push(0.5 * (a + b), 0.5) + push(b, 0.0));
            }
        }
        for (found, expected) in whole.iter().zip(x) {
            assert!((found - expected).abs() < 1e-11, "{found} {expected}");
        }
        let rise = stage.value(0.51) - stage.value(0.49);
        assert!((rise / 0.04 - stage.slope(0.5)).abs() < 1e-4);
    }
}
