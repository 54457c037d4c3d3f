//! How readings that follow each other correlate, found out as they come.

use crate::observe::kept::kept;

/// Surprises whose correlation with the one before is averaged at most.
const SURPRISES: f64 = 400.0;
/// The largest correlation that counts.
const MOST_CORRELATION: f64 = 0.98;

/// How surprises that follow each other correlate: noise of one reading that is also in the next.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::observe) struct Correlation {
    last: f64,
    product: f64,
    square: f64,
    count: f64,
}
kept!(Correlation: last, product, square, count);

impl Correlation {
    pub(in crate::observe) fn feed(&mut self, surprise: f64) {
        self.count = (self.count + 1.0).min(SURPRISES);
        self.product += (surprise * self.last - self.product) / self.count;
        self.square += (surprise * surprise - self.square) / self.count;
        self.last = surprise;
    }

    /// ρ of noise that obeys AR(1); 0 where it is no more than chance leaves of white noise.
    fn coefficient(&self) -> f64 {
        let correlation = if self.square > 0.0 { self.product / self.square } else { 0.0 };
        if correlation < 2.0 / self.count.sqrt() { 0.0 } else { correlation.min(MOST_CORRELATION) }
    }

    /// How many readings tell together as much as one would without correlation: (1 + ρ)/(1 − ρ).
    pub(in crate::observe) fn together(&self) -> f64 {
        let correlation = self.coefficient();
        (1.0 + correlation) / (1.0 - correlation)
    }

    /// The variance of the mean of many readings times their number, and its degrees of freedom; `None` where nothing correlates.
    ///
    /// The variance of ρ is (1 − ρ²)/N, so that of ln((1 + ρ)/(1 − ρ)) is 4/(N (1 − ρ²)): as of a sum of N (1 − ρ²)/2 squares.
    pub(in crate::observe) fn long_run_variance(&self) -> Option<(f64, f64)> {
        let correlation = self.coefficient();
        let freedom = 0.5 * self.count * (1.0 - correlation * correlation);
        (correlation > 0.0).then(|| (self.square * self.together(), freedom.max(1.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;

    #[test]
    fn the_variance_of_means_of_autoregressive_noise_is_found() {
        for rho in [0.0, 0.5, 0.9] {
            let (mut correlation, mut random) = (Correlation::default(), Rng::new(3));
            let mut noise = random.normal();
            for _ in 0..4000 {
                noise = rho * noise + (1.0_f64 - rho * rho).sqrt() * random.normal();
                correlation.feed(noise);
            }
            let expected = (1.0 + rho) / (1.0 - rho);
            let found = correlation.long_run_variance().map_or(1.0, |(variance, _)| variance);
            println!("{rho}: {found} {expected}");
            // Two standard deviations of a memory of 400.
            assert!(
                (found / expected).ln().abs() < 2.0 * 2.0 / (400.0 * (1.0_f64 - rho * rho)).sqrt(),
                "{rho}: {found}"
            );
        }
    }
}
