//! How far a predicted force is from another, by the uncertainty of its calibration.

use crate::calibrate::Prediction;

/// A force that a calibration predicts, with its uncertainty.
///
/// A bound of the force takes the wider of two accounts: z standard errors, and z over the factor of the interval of the prediction times what that
/// interval reaches, in the logarithm of the force where it ends above 0. They differ where parameters are hardly determined.
#[derive(Clone, Copy)]
pub(super) struct Margin {
    force: f64,
    error: f64,
    /// How far the interval reaches below, N, and how many standard deviations that is.
    below: f64,
    factor: f64,
}

impl Margin {
    /// Of a sample of a prediction; `None` where its calibration says nothing.
    pub(super) fn of(predicted: &Prediction, index: usize) -> Option<Self> {
        Some(Self {
            force: predicted.trajectory.force[index],
            error: predicted.force_standard_error.as_ref()?[index],
            below: predicted.force_half_widths.as_ref()?[index].0,
            factor: predicted.factor,
        })
    }

    /// The bound of the force `deviations` standard deviations below the estimate; above it, for fewer than none.
    pub(super) fn least(&self, deviations: f64) -> f64 {
        let by_error = self.force - deviations * self.error;
        if deviations <= 0.0 {
            return by_error;
        }
        let share = deviations / self.factor;
        let by_interval = match self.logarithm() {
            Some(logarithm) => self.force * (-share * logarithm).exp(),
            None => self.force - share * self.below,
        };
        by_error.min(by_interval)
    }

    /// By how many standard deviations at most a bound of the force is still the one that is needed; below 0 where the estimate is less.
    pub(super) fn deviations_above(&self, needed: f64) -> f64 {
        let surplus = self.force - needed;
        let over = |surplus: f64, unit: f64| match unit > 0.0 {
            true => surplus / unit,
            false if surplus >= 0.0 => f64::INFINITY,
            false => f64::NEG_INFINITY,
        };
        let by_error = over(surplus, self.error);
        if surplus <= 0.0 {
            return by_error;
        }
        let by_interval = match self.logarithm() {
            Some(_) if needed <= 0.0 => f64::INFINITY,
            Some(logarithm) => over((self.force / needed).ln(), logarithm),
            None => over(surplus, self.below),
        };
        by_error.min(self.factor * by_interval)
    }

    /// How far the interval reaches below in the logarithm, where it ends above 0.
    fn logarithm(&self) -> Option<f64> {
        (self.below < self.force).then(|| -(-self.below / self.force).ln_1p())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_is_as_many_deviations_away_as_it_was_made_of() {
        let margin = |error: f64, below: f64| Margin {
            force: 2.0,
            error,
            below,
            factor: 1.96,
        };
        for (error, below) in [(0.3, 0.5), (0.1, 0.9), (0.2, 2.5), (0.9, 0.4)] {
            let found = margin(error, below);
            for deviations in [-1.0, 0.0, 0.4, 1.645, 1.96, 3.0] {
                let bound = found.least(deviations);
                assert!((found.deviations_above(bound) - deviations).abs() < 1e-12, "{error} {below} {deviations}");
            }
            // The interval of the prediction and 1.96 standard errors, whichever reaches farther.
            assert!((found.least(1.96) - (2.0 - below.max(1.96 * error))).abs() < 1e-12);
        }
        let exact = margin(0.0, 0.0);
        assert_eq!(
            [1.9, 2.0, 2.1].map(|needed| exact.deviations_above(needed)),
            [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY]
        );
    }
}
