//! Residual squares of sums of exponentials to 30 digits, in pairs of doubles.
//!
//! Where three rates come together columns differ by parts in 10¹⁰, and the rounding of a double is a column of noise that fits part of
//! the noise of the samples: residual squares come out too low by up to parts in 10⁵. What brute force claims there is checked here.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// The sum of two doubles, the second below the last digit of the first.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Pair(f64, f64);

impl Pair {
    const ZERO: Self = Self(0.0, 0.0);
    const ONE: Self = Self(1.0, 0.0);
    const LN_2: Self = Self(std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);

    fn sum(a: f64, b: f64) -> Self {
        let sum = a + b;
        let part = sum - a;
        Self(sum, (a - (sum - part)) + (b - part))
    }

    fn product(a: f64, b: f64) -> Self {
        let product = a * b;
        Self(product, a.mul_add(b, -product))
    }

    /// e to this power, of 0 or less.
    fn exp(self) -> Self {
        if self.0 < -700.0 {
            return Self::ZERO;
        }
        /// Halvings before the series, and its terms.
        const HALVINGS: i32 = 6;
        const TERMS: u32 = 14;
        let twos = (self.0 / Self::LN_2.0).round();
        let rest = self - Self::LN_2 * Self(twos, 0.0);
        let shrink = 2f64.powi(-HALVINGS);
        let rest = Self(rest.0 * shrink, rest.1 * shrink);
        let mut value = (1..=TERMS).rev().fold(Self::ONE, |sum, i| Self::ONE + sum * rest / Self(f64::from(i), 0.0));
        for _ in 0..HALVINGS {
            value = value * value;
        }
        let scale = 2f64.powi(twos as i32);
        Self(value.0 * scale, value.1 * scale)
    }
}

impl Add for Pair {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (Self::sum(self.0, other.0), Self::sum(self.1, other.1));
        let first = Self::sum(high.0, high.1 + low.0);
        Self::sum(first.0, first.1 + low.1)
    }
}

impl Neg for Pair {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}

impl Sub for Pair {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Pair {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = Self::product(self.0, other.0);
        Self::sum(high.0, high.1 + (self.0 * other.1 + self.1 * other.0))
    }
}

impl Div for Pair {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = Self(self.0 / other.0, 0.0);
        let rest = self - other * first;
        let second = Self(rest.0 / other.0, 0.0);
        let rest = rest - other * second;
        first + second + Self(rest.0 / other.0, 0.0)
    }
}

fn dot(a: &[Pair], b: &[Pair]) -> Pair {
    a.iter().zip(b).fold(Pair::ZERO, |sum, (a, b)| sum + *a * *b)
}

/// `column` less its part along `axis`, whose square is `size`.
fn remove(column: &mut [Pair], axis: &[Pair], size: Pair) {
    let part = dot(column, axis) / size;
    for (entry, along) in column.iter_mut().zip(axis) {
        *entry = *entry - part * *along;
    }
}

/// What the best constant, if there is one, and amplitudes of exponentials of these ln λ leave over of the values.
pub(crate) fn exact_square(times: &[f64], values: &[f64], constant: bool, log_rates: &[f64]) -> f64 {
    let exponential = |log_rate: &f64| -> Vec<Pair> {
        let rate = log_rate.exp();
        times.iter().map(|time| Pair::product(-rate, *time).exp()).collect()
    };
    let still = constant.then(|| vec![Pair::ONE; times.len()]);
    let mut axes: Vec<(Vec<Pair>, Pair)> = Vec::new();
    for mut column in still.into_iter().chain(log_rates.iter().map(exponential)) {
        let before = dot(&column, &column);
        for (axis, size) in axes.iter().chain(&axes) {
            remove(&mut column, axis, *size);
        }
        let size = dot(&column, &column);
        if size.0 > 1e-50 * before.0 {
            axes.push((column, size));
        }
    }
    let mut rest: Vec<Pair> = values.iter().map(|value| Pair(*value, 0.0)).collect();
    for (axis, size) in axes.iter().chain(&axes) {
        remove(&mut rest, axis, *size);
    }
    dot(&rest, &rest).0
}

#[test]
fn pairs_have_thirty_digits() {
    // e^(−1/3) and e^(−20) to 32 digits, less the nearest double.
    let third = -(Pair::ONE / Pair(3.0, 0.0));
    for (power, high, low) in [
        (third, 0.7165313105737893, -2.0286948382455594e-17),
        (Pair(-20.0, 0.0), 2.061153622438558e-09, -4.19755767595054e-26),
    ] {
        let off = power.exp() - Pair(high, low);
        assert!((off.0 / high).abs() < 1e-29, "{off:?}");
    }
}
