//! The motion with given knots that is nearest to samples, by the normal equations of its hat functions.

use super::motion::Motion;

/// Displacements at knots of the motion that is straight between them and nearest to the samples; `None` where samples do not say.
pub(super) fn hats(samples: &Motion, knots: &[f64]) -> Option<(Vec<f64>, Tridiagonal)> {
    if knots.windows(2).any(|pair| pair[1] <= pair[0]) {
        return None;
    }
    let mut normal = Tridiagonal {
        diagonal: vec![0.0; knots.len()],
        beside: vec![0.0; knots.len() - 1],
    };
    for (at, [before, between, after]) in sums_of_hats(samples, knots).into_iter().enumerate() {
        normal.diagonal[at] += before;
        normal.diagonal[at + 1] += after;
        normal.beside[at] += between;
    }
    let mut values = vec![0.0; knots.len()];
    let mut at = 0;
    for (time, displacement) in samples.times().iter().zip(samples.displacements()) {
        while at + 2 < knots.len() && *time >= knots[at + 1] {
            at += 1;
        }
        let share = (time - knots[at]) / (knots[at + 1] - knots[at]);
        values[at] += (1.0 - share) * displacement;
        values[at + 1] += share * displacement;
    }
    let factored = normal.factored()?;
    factored.solve(&mut values);
    values.iter().all(|value| value.is_finite()).then_some((values, factored))
}

/// Sums of (1 − s)², s (1 − s) and s² over the samples of every stretch between two knots, with s the share of it that lies before a sample.
pub(super) fn sums_of_hats(samples: &Motion, knots: &[f64]) -> Vec<[f64; 3]> {
    let mut sums = vec![[0.0; 3]; knots.len() - 1];
    let mut at = 0;
    for time in samples.times() {
        while at + 2 < knots.len() && *time >= knots[at + 1] {
            at += 1;
        }
        let share = (time - knots[at]) / (knots[at + 1] - knots[at]);
        sums[at][0] += (1.0 - share) * (1.0 - share);
        sums[at][1] += share * (1.0 - share);
        sums[at][2] += share * share;
    }
    sums
}

/// Measured displacements less those of the motion.
pub(super) fn residuals<'a>(samples: &'a Motion, motion: &'a Motion) -> impl Iterator<Item = f64> + 'a {
    let (knots, values) = (motion.times(), motion.displacements());
    let mut at = 0;
    samples.times().iter().zip(samples.displacements()).map(move |(time, displacement)| {
        while at + 2 < knots.len() && *time >= knots[at + 1] {
            at += 1;
        }
        let share = (time - knots[at]) / (knots[at + 1] - knots[at]);
        displacement - values[at] - share * (values[at + 1] - values[at])
    })
}

/// A symmetric matrix with entries on its diagonal and beside it alone, or its factors L D Lᵀ.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tridiagonal {
    diagonal: Vec<f64>,
    beside: Vec<f64>,
}

impl Tridiagonal {
    /// Its factors; `None` where it is singular.
    fn factored(mut self) -> Option<Self> {
        /// Share of an entry below which rounding has left it.
        const SINGULAR: f64 = 1e-10;
        for i in 0..self.diagonal.len() {
            let own = self.diagonal[i];
            if i > 0 {
                let factor = self.beside[i - 1] / self.diagonal[i - 1];
                self.diagonal[i] -= factor * self.beside[i - 1];
                self.beside[i - 1] = factor;
            }
            if self.diagonal[i].is_nan() || self.diagonal[i] <= SINGULAR * own.max(SINGULAR) {
                return None;
            }
        }
        Some(self)
    }

    /// Solves for a right side, from the factors.
    pub(super) fn solve(&self, right: &mut [f64]) {
        for i in 1..right.len() {
            right[i] -= self.beside[i - 1] * right[i - 1];
        }
        right.iter_mut().zip(&self.diagonal).for_each(|(entry, pivot)| *entry /= pivot);
        for i in (1..right.len()).rev() {
            right[i - 1] -= self.beside[i - 1] * right[i];
        }
    }
}
