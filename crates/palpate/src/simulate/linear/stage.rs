//! The memory of a linear law while what drives it is a polynomial of time.
//!
//! ẋ_k = g_k q̇ − λ_k x_k with q̇ = Σ a_p P_p(2c − 1)/width, c = t/width from 0 to 1 and Legendre's polynomials P_p, has the solution
//!
//! ```text
//! x_k(c) = x_k(0) exp(−z c) + g_k Σ a_p I_p(c, z),   I_p(c, z) = ∫₀ᶜ exp(−z (c − s)) P_p(2s − 1) ds,   z = λ_k width
//! ```
//!
//! They are sums of ∫₀ᶜ exp(−z (c − s)) s^j ds = c^(j+1) φ_j(z c), where φ_j(y) = ∫₀¹ exp(−y (1 − s)) s^j ds obeys y φ_j = 1 − j φ_(j−1).

use std::sync::LazyLock;

use super::law::{LinearLaw, LinearTerm};
use crate::special;
use crate::vector::elementary::exp_m1;
use crate::vector::{add_multiple, fill};

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
        let (is_straight, powers) = (self.is_straight(), self.powers());
        let each = |(x, term): (&f64, &LinearTerm)| {
            let z = term.rate * self.width;
            let change = (-z * part).exp_m1();
            let driven = match () {
                () if self.width == 0.0 => 0.0,
                () if is_straight => -powers[0] * change / z,
                () => dot(&powers, &faded_powers(z, part)),
            };
            x * (1.0 + change) + term.overshoot * driven
        };
        self.before.iter().zip(law.terms()).map(each).collect()
    }

    /// Appends Σ x_k at rising times (s) of this stage, of which the first is that of `origin`.
    pub(super) fn extend_sums(&self, origin: f64, times: &[f64], law: &LinearLaw, sums: &mut Vec<f64>) {
        let (from, begin) = (sums.len(), origin + self.start);
        sums.resize(from + times.len(), 0.0);
        let (powers, per_width) = (self.powers(), if self.width > 0.0 { 1.0 / self.width } else { 0.0 });
        let mut column = vec![0.0; times.len()];
        for (&before, &LinearTerm { overshoot, rate }) in self.before.iter().zip(law.terms()) {
            if self.is_straight() {
                // exp(−λ t) before + g a₀ (1 − exp(−λ t))/z
                let fading = before - overshoot * powers[0] * per_width / rate;
                fill(
                    times,
                    [&mut column],
                    #[inline(always)]
                    |time| [before + fading * exp_m1(-rate * (time - begin))],
                );
            } else {
                let slow = times.partition_point(|time| rate * (time - begin) < SLOW);
                let (first, second) = column.split_at_mut(slow);
                fill(
                    &times[..slow],
                    [first],
                    #[inline(always)]
                    |time| {
                        let (y, part) = (rate * (time - begin), (time - begin) * per_width);
                        [before * (1.0 + exp_m1(-y)) + overshoot * polynomial(&powers, &faded_slowly(y), part)]
                    },
                );
                fill(
                    &times[slow..],
                    [second],
                    #[inline(always)]
                    |time| {
                        let (y, part) = (rate * (time - begin), (time - begin) * per_width);
                        let change = exp_m1(-y);
                        [before * (1.0 + change) + overshoot * polynomial(&powers, &faded_fast(y, change), part)]
                    },
                );
            }
            add_multiple(&mut sums[from..], 1.0, &column);
        }
    }

    /// Coefficients of q̇ width as a sum of c^j.
    fn powers(&self) -> [f64; DEGREE] {
        std::array::from_fn(|j| (j..DEGREE).map(|p| self.rates[p] * LEGENDRE[p][j]).sum())
    }
}

/// Σ a_j φ_j c^(j+1).
#[inline(always)]
fn polynomial(powers: &[f64; DEGREE], faded: &[f64; DEGREE], part: f64) -> f64 {
    let mut sum = 0.0;
    for j in (0..DEGREE).rev() {
        sum = sum * part + powers[j] * faded[j];
    }
    sum * part
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

/// Coefficients of P_p(2c − 1), of c^j.
const LEGENDRE: [[f64; DEGREE]; DEGREE] = [
    [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [-1.0, 2.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, -6.0, 6.0, 0.0, 0.0, 0.0],
    [-1.0, 12.0, -30.0, 20.0, 0.0, 0.0],
    [1.0, -20.0, 90.0, -140.0, 70.0, 0.0],
    [-1.0, 30.0, -210.0, 560.0, -630.0, 252.0],
];

/// I_p(c, z), to about 10⁻¹⁶ of I₀ times the largest coefficient of P_p.
pub(super) fn fading(z: f64, part: f64) -> [f64; DEGREE] {
    let powers = faded_powers(z, part);
    LEGENDRE.map(|coefficients| dot(&coefficients, &powers))
}

/// c^(j+1) φ_j(z c).
fn faded_powers(z: f64, part: f64) -> [f64; DEGREE] {
    let y = z * part;
    let mut power = 1.0;
    let faded = if y < SLOW { faded_slowly(y) } else { faded_fast(y, exp_m1(-y)) };
    faded.map(|faded| {
        power *= part;
        faded * power
    })
}

/// y below which φ_j follow from φ_(j+1), and above which from φ_(j−1): errors grow by y/j, or by j/y.
const SLOW: f64 = 2.0;

/// Terms of the series of the last φ: y^k/((p + 1) … (p + k)) is below 10⁻¹⁷ then.
const TERMS: usize = 20;

/// φ_j(y) for 0 ≤ y ≤ [`SLOW`]: the last as 1/(p + 1) (1 − y/(p + 2) (1 − y/(p + 3) (1 − …))), the others downwards.
#[inline(always)]
fn faded_slowly(y: f64) -> [f64; DEGREE] {
    let mut faded = [0.0; DEGREE];
    let mut series = 1.0;
    for k in (0..TERMS).rev() {
        series = 1.0 - y * series * PER_NUMBER[DEGREE + 1 + k];
    }
    faded[DEGREE - 1] = series * PER_NUMBER[DEGREE];
    for j in (1..DEGREE).rev() {
        faded[j - 1] = (1.0 - y * faded[j]) * PER_NUMBER[j];
    }
    faded
}

/// φ_j(y) from [`SLOW`] on, with exp(−y) − 1.
#[inline(always)]
fn faded_fast(y: f64, change: f64) -> [f64; DEGREE] {
    let mut faded = [0.0; DEGREE];
    let per = 1.0 / y;
    faded[0] = -change * per;
    for j in 1..DEGREE {
        faded[j] = (1.0 - j as f64 * faded[j - 1]) * per;
    }
    faded
}

/// 1/i.
const PER_NUMBER: [f64; DEGREE + 1 + TERMS] = {
    let mut per = [0.0; DEGREE + 1 + TERMS];
    let mut i = 1;
    while i < per.len() {
        per[i] = 1.0 / i as f64;
        i += 1;
    }
    per
};

/// Nodes and weights of Gauss's rule on 0…1.
pub(super) static GAUSS: LazyLock<[(f64, f64); 24]> = LazyLock::new(rule);

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
    fn fading_integrals_are_those_by_quadrature() {
        for part in [1e-3, 0.2, 0.77, 1.0] {
            // On either side of where one recursion takes over from the other.
            for z in [1e-6, 0.3, SLOW / part * (1.0 - 1e-15), SLOW / part, 7.0, 30.0] {
                let mut sums = [0.0; DEGREE];
                for &(node, weight) in GAUSS.iter() {
                    let back = part * node;
                    let weight = part * weight * (-z * back).exp();
                    sums.iter_mut().zip(legendre(part - back)).for_each(|(sum, value)| *sum += weight * value);
                }
                for (p, (found, expected)) in fading(z, part).into_iter().zip(sums).enumerate() {
                    let size: f64 = LEGENDRE[p].iter().map(|coefficient| coefficient.abs()).sum();
                    let most = 4.0 * f64::EPSILON * size.max(10.0) * sums[0];
                    assert!((found - expected).abs() < most, "{z} {part} {p}: {found} {expected}");
                }
            }
        }
    }

    #[test]
    fn sums_at_many_times_are_those_of_the_memory() {
        let law =
            LinearLaw::new(&[(2.0, 0.3), (0.5, 40.0)].map(|(overshoot, rate)| LinearTerm { overshoot, rate })).unwrap();
        for rates in [[0.3, -0.1, 0.05, 0.02, -0.01, 0.004], [0.3, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0; DEGREE]] {
            let stage = Stage {
                start: 3.0,
                width: 2.0,
                from: 0.1,
                rates,
                before: vec![0.2, -0.03],
            };
            let times: Vec<f64> = (0..=100).map(|i| 13.0 + 0.02 * f64::from(i)).collect();
            let mut sums = vec![7.0];
            stage.extend_sums(10.0, &times, &law, &mut sums);
            assert_eq!(sums.len(), times.len() + 1);
            for (time, sum) in times.iter().zip(&sums[1..]) {
                let expected: f64 = stage.memory((time - 13.0) / 2.0, &law).iter().sum();
                assert!((sum - expected).abs() < 1e-14, "{time}: {sum} {expected}");
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
