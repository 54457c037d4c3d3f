//! How far noise takes the rate domain from the truth, found by simulation.

use serde::{Deserialize, Serialize};

use crate::analysis::options::AnalysisOptions;
use crate::fit::{ExponentChoice, LatencyFit, Samples, fit_rates};
use crate::random::Rng;
use crate::statistics::{noise_in_time, quantile};
use crate::strain::strain_rates;

/// What the rate domain makes of simulated holds whose truth is the fit in time, with the noise of the measured one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RateBias {
    /// The exponent, given in all fits.
    pub exponent: f64,
    /// Simulated holds that gave a fit.
    pub repetitions: usize,
    /// v of the rate domain over the true one, median.
    pub coefficient: f64,
    /// The same, lowest and highest of the repetitions.
    pub coefficient_range: (f64, f64),
    /// Equilibrium of the rate domain less the true one, median, as a share of the amplitude.
    pub equilibrium: f64,
}

/// Simulated holds.
const REPETITIONS: u64 = 15;

/// Samples of a simulated hold at most; a longer one is thinned, its noise reduced as averaging would.
const MOST_SAMPLES: usize = 4000;

/// Simulates the hold of these times and values with the numbers of `fit`, and fits them in the rate domain; `None` if fewer than half give a fit.
pub(super) fn rate_bias(samples: Samples<'_>, fit: &LatencyFit, options: &AnalysisOptions) -> Option<RateBias> {
    if !fit.termination.is_good() {
        return None;
    }
    let (times, values) = (samples.times, samples.values);
    let every = times.len().div_ceil(MOST_SAMPLES);
    let noise = noise_in_time(times, values) / (every as f64).sqrt();
    let times: Vec<f64> = times.iter().step_by(every).copied().collect();
    let exponent = fit.exponent().value;
    let (mut ratios, mut shifts) = (Vec::new(), Vec::new());
    for seed in 0..REPETITIONS {
        let mut random = Rng::new(seed);
        let signal: Vec<f64> = times.iter().map(|t| fit.predict(*t) + noise * random.normal()).collect();
        let rates = strain_rates(&times, &signal, &options.rate_window);
        if let Ok(by_rate) = fit_rates(&rates.strain, &rates.rate, ExponentChoice::Fixed(exponent), &options.fit) {
            ratios.push(by_rate.rate_coefficient().value / fit.rate_coefficient().value);
            shifts.push((by_rate.equilibrium().value - fit.equilibrium().value) / fit.amplitude().value);
        }
    }
    if 2 * ratios.len() < REPETITIONS as usize || !ratios.iter().chain(&shifts).all(|value| value.is_finite()) {
        return None;
    }
    Some(RateBias {
        exponent,
        repetitions: ratios.len(),
        coefficient: quantile(&mut ratios, 0.5),
        coefficient_range: (quantile(&mut ratios, 0.0), quantile(&mut ratios, 1.0)),
        equilibrium: quantile(&mut shifts, 0.5),
    })
}
