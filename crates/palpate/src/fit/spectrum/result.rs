//! What a spectrum says.

use serde::{Deserialize, Serialize};

/// The dense relaxation spectrum of one hold: y(t) = equilibrium + sign × Σ amplitudes_j exp(−t/times_j).
///
/// Single amplitudes have no standard errors: they are bounded, and neighbours can stand in for each other. What the data
/// determine are predictions inside the hold, and the peaks where they are few and far apart.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SpectrumFit {
    /// y_e, the constant. A convention of the grid if [`SpectrumFit::is_open_ended`].
    pub equilibrium: f64,
    /// 1 for a signal that falls (Type I), −1 for one that rises (Type II).
    pub sign: f64,
    /// The grid τ_j, s, rising.
    pub times: Vec<f64>,
    /// h_j ≥ 0 in units of the signal, one a time.
    pub amplitudes: Vec<f64>,
    /// Length of the hold, s.
    pub duration: f64,
    /// μ, the strength of smoothing; a dimensionless parameter.
    pub strength: f64,
    /// Parameters that the samples, not the smoothing, determine: the trace of the hat matrix, the constant included.
    pub effective_parameters: f64,
    /// Weighted sum of squared residuals.
    pub residual_square: f64,
    /// The same with next to no smoothing (10⁻¹²).
    pub least_residual_square: f64,
    /// What smoothing was allowed to bring it to: the least × (1 + √(2 W)/N), W = `weight`, N = `samples`.
    pub residual_limit: f64,
    /// Samples of weight.
    pub samples: usize,
    /// Sum of their weights.
    pub weight: f64,
}

/// Neighbouring times whose amplitudes form one peak.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct SpectrumPeak {
    /// exp of the mean of ln τ_j with weights h_j, s.
    pub time: f64,
    /// Σ h_j in units of the signal.
    pub amplitude: f64,
    /// Grid times with an amplitude above zero.
    pub terms: usize,
}

impl SpectrumFit {
    /// The signal a time `elapsed` (s) after the start of the fit.
    #[must_use]
    pub fn predict(&self, elapsed: f64) -> f64 {
        self.equilibrium + self.sign * self.remaining(elapsed.max(0.0))
    }

    /// Σ h_j exp(−t/τ_j) with t = `elapsed` (s): the part of the relaxation that is still to come.
    #[must_use]
    pub fn remaining(&self, elapsed: f64) -> f64 {
        let terms = self.times.iter().zip(&self.amplitudes).filter(|(_, height)| **height > 0.0);
        terms.map(|(time, height)| height * (-elapsed / time).exp()).sum()
    }

    /// The same where a unit weight is that of a sample with a standard deviation of 1/`precision`: squares add up as χ².
    pub(crate) fn in_deviations(self, precision: f64) -> Self {
        let square = precision * precision;
        Self {
            residual_square: self.residual_square * square,
            least_residual_square: self.least_residual_square * square,
            residual_limit: self.residual_limit * square,
            weight: self.weight * square,
            ..self
        }
    }

    /// Root mean square residual √(RSS/Σ weights).
    #[must_use]
    pub fn rmse(&self) -> f64 {
        (self.residual_square / self.weight).sqrt()
    }

    /// Grid times with an amplitude above zero.
    #[must_use]
    pub fn terms(&self) -> usize {
        self.amplitudes.iter().filter(|height| **height > 0.0).count()
    }

    /// Whether the slowest grid time carries weight. If so, the drift at the end is confounded with the constant, the
    /// spectrum might as well go on beyond its grid, and the equilibrium is a convention of the grid, not a finding.
    #[must_use]
    pub fn is_open_ended(&self) -> bool {
        self.amplitudes.last().is_some_and(|height| *height > 0.0)
    }

    /// The peaks of the spectrum, fastest first.
    ///
    /// Two heaps are two peaks if the lowest amplitude between them is below half the lower one's highest.
    #[must_use]
    pub fn peaks(&self) -> Vec<SpectrumPeak> {
        let mut peaks = Vec::new();
        let mut from = 0;
        for cut in self.valleys().into_iter().chain([self.times.len()]) {
            peaks.extend(self.peak(from, cut));
            from = cut;
        }
        peaks
    }

    /// Places where one peak ends and the next begins.
    fn valleys(&self) -> Vec<usize> {
        let mut cuts = Vec::new();
        let (mut highest, mut lowest, mut place) = (0.0f64, f64::INFINITY, 0);
        for (j, &height) in self.amplitudes.iter().enumerate() {
            if height < lowest {
                (lowest, place) = (height, j);
            }
            if height > 2.0 * lowest && highest > 2.0 * lowest {
                cuts.push(place);
                (highest, lowest, place) = (height, height, j);
            } else if height > highest {
                (highest, lowest, place) = (height, height, j);
            }
        }
        cuts
    }

    fn peak(&self, from: usize, until: usize) -> Option<SpectrumPeak> {
        let (times, amplitudes) = (&self.times[from..until], &self.amplitudes[from..until]);
        let amplitude: f64 = amplitudes.iter().sum();
        let logarithm: f64 = times.iter().zip(amplitudes).map(|(time, height)| height * time.ln()).sum();
        (amplitude > 0.0).then(|| SpectrumPeak {
            time: (logarithm / amplitude).exp(),
            amplitude,
            terms: amplitudes.iter().filter(|height| **height > 0.0).count(),
        })
    }
}
