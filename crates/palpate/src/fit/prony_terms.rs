//! How many exponentials a hold has: series of one, two, … terms, and the one that the data ask for.

use super::law_fit::{LawFit, fit_law};
use super::samples::Samples;
use super::{FitError, LawOptions};
use crate::laws::{Law, MOST_TERMS};

/// Fits series of 1 to `most_terms` exponentials (at most [`MOST_TERMS`]) and chooses one: the lowest Bayesian criterion
/// N_e ln(RSS/N) + p ln N_e among the fits that ended well and have no ghosts (merged or vanishing terms), N_e the number of
/// independent samples that the residuals of the best of them allow.
///
/// Returns the index of the chosen fit, if any is sound, and all fits in the order of their terms. Series with more numbers than the
/// samples can bear are left out.
///
/// ```
/// use palpate::fit::{LawOptions, Samples, fit_prony};
/// use palpate::test_problems::Noise;
/// // 1 + 2 exp(−t/3) + 4 exp(−t/40), noise 0.01
/// let mut random = Noise::new(1);
/// let times: Vec<f64> = (0..400).map(|i| 0.5 * f64::from(i)).collect();
/// let value = |t: &f64| 1.0 + 2.0 * (-t / 3.0).exp() + 4.0 * (-t / 40.0).exp() + 0.01 * random.normal();
/// let values: Vec<f64> = times.iter().map(value).collect();
/// let (chosen, fits) = fit_prony(&Samples::new(&times, &values), 4, &LawOptions::default())?;
/// assert_eq!((chosen, fits.len()), (Some(1), 4));
/// assert!((fits[1].value("time_2").unwrap() / 40.0 - 1.0).abs() < 0.02);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
///
/// # Errors
/// [`FitError`] for samples that not even one exponential can be fitted to.
pub fn fit_prony(
    samples: &Samples<'_>,
    most_terms: usize,
    options: &LawOptions,
) -> Result<(Option<usize>, Vec<LawFit>), FitError> {
    let mut fits = vec![fit_law(samples, Law::Prony { terms: 1 }, options)?];
    for terms in 2..=most_terms.min(MOST_TERMS) {
        match fit_law(samples, Law::Prony { terms }, options) {
            Ok(fit) => fits.push(fit),
            Err(FitError::TooFewSamples { .. }) => break,
            Err(error) => return Err(error),
        }
    }
    let sound = |fit: &&LawFit| fit.termination.is_good() && fit.ghosts.is_empty();
    let best = fits.iter().filter(sound).min_by(|a, b| a.residual_square.total_cmp(&b.residual_square));
    let Some(effective) = best.map(LawFit::effective_samples) else {
        return Ok((None, fits));
    };
    let criterion = |fit: &LawFit| {
        // Noise-free records leave rounding only; below this share of the signal all residuals are equal.
        let size = fit.curve.constant.abs() + fit.curve.terms.iter().map(|term| term.amplitude.abs()).sum::<f64>();
        let exact = (1e-9 * size / fit.rmse).max(1.0).powi(2);
        let square = exact * fit.residual_square / fit.samples as f64;
        effective * square.ln() + fit.free_numbers() as f64 * effective.ln()
    };
    let chosen = (0..fits.len())
        .filter(|&i| sound(&&fits[i]))
        .min_by(|a, b| criterion(&fits[*a]).total_cmp(&criterion(&fits[*b])));
    Ok((chosen, fits))
}
