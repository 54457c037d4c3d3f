//! All laws on one hold, ranked.

use super::verdict::judge;
use super::{CompareOptions, Comparison, ForwardScore, HoldForecast, Ranking, Row, criteria};
use crate::fit::{
    Fit, FitError, LawOptions, Samples, SpectrumFit, SpectrumOptions, fit_law_watched, fit_spectrum, until,
};
use crate::laws::Law;
use crate::statistics::{mean, noise_in_time};
use crate::watch::{Cancelled, Progress, Unwatched, Watch};

/// Fits laws to a hold, lets each predict the last part from the first, and ranks them.
///
/// Laws are ranked by their forward score: the error over the rest of the hold of a fit to its first quarter, third and half, as a share of
/// the change of the signal. Where the change of the signal after the first cut does not exceed its noise, or the
/// first part has too few samples, the rank is by BIC at the effective number of samples.
///
/// ```
/// use palpate::forecast::{CompareOptions, compare_laws};
/// use palpate::fit::Samples;
/// use palpate::test_problems::noisy_hold;
/// let (times, values) = noisy_hold(500, 5.0, 1e-3);
/// let comparison = compare_laws(&Samples::new(&times, &values), &CompareOptions::default())?;
/// assert!(comparison.rows[0].forward.score.unwrap() < 0.01);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
///
/// # Errors
/// [`FitError`] for samples that no law can be fitted to.
pub fn compare_laws(samples: &Samples<'_>, options: &CompareOptions) -> Result<Comparison, FitError> {
    compare_laws_watched(samples, options, &[], &mut Unwatched)
}

/// An existing fit of the same samples, with its options.
#[derive(Debug, Clone)]
pub struct KnownFit<'a> {
    /// Its options.
    pub options: LawOptions,
    /// The fit.
    pub fit: &'a Fit,
}

/// [`compare_laws`] with a watch, and with fits that exist already, which are not made again.
///
/// # Errors
/// As [`compare_laws`], and [`FitError::Cancelled`].
pub fn compare_laws_watched(
    samples: &Samples<'_>,
    options: &CompareOptions,
    known: &[KnownFit<'_>],
    watch: &mut dyn Watch,
) -> Result<Comparison, FitError> {
    samples.check(1)?;
    let laws = options.laws();
    let mut rows: Vec<Row> = Vec::new();
    for law in &laws {
        watch.report(Progress::counted("comparing laws", rows.len(), 2 * laws.len()))?;
        rows.push(row(samples, *law, options, known, watch)?);
    }
    let (times, values) = (samples.times, samples.values);
    let duration = times[times.len() - 1] - times[0];
    let change = change(values);
    let noise = noise_in_time(times, values);
    let mut cuts = cuts(samples, options, duration, noise);
    let mut forecast_from = |rows: &mut [Row], cuts: &[f64]| -> Result<(), Cancelled> {
        for (done, row) in rows.iter_mut().enumerate() {
            watch.report(Progress::counted("comparing laws", laws.len() + done, 2 * laws.len()))?;
            row.forward = ForwardScore::of(samples, row.law, &options.fit, cuts, change);
        }
        Ok(())
    };
    forecast_from(&mut rows, &cuts)?;
    // A first part that no law can be fitted to (a force that has not changed by a digit yet) is no cut.
    let reported: Vec<bool> =
        (0..cuts.len()).map(|cut| rows.iter().any(|row| row.forward.forecasts[cut].is_some())).collect();
    if reported.contains(&false) {
        cuts = cuts.into_iter().zip(reported).filter(|(_, reported)| *reported).map(|(cut, _)| cut).collect();
        forecast_from(&mut rows, &cuts)?;
    }
    let fits = || rows.iter().filter_map(|row| row.fit.as_ref().ok());
    let closest = fits().min_by(|a, b| a.residual_square.total_cmp(&b.residual_square));
    let effective = closest.map_or(values.len() as f64, |closest| independent(closest, fits()));
    let refuting = rows.iter().find_map(|row| row.spectrum.as_ref());
    let effective = match (refuting, closest) {
        (Some(spectrum), Some(closest)) if spectrum.residual_square < CLOSER * closest.residual_square => {
            effective_beside(spectrum, samples)
        }
        _ => effective,
    };
    weigh(&mut rows, effective, values.len(), change * samples.roots().1);
    let ranking = if cuts.is_empty() { Ranking::Information } else { Ranking::Forward };
    let key = |row: &Row| match ranking {
        Ranking::Forward => row.forward.score.unwrap_or(f64::INFINITY),
        Ranking::Information => row.delta_bic.unwrap_or(f64::INFINITY),
    };
    rows.sort_by(|a, b| key(a).total_cmp(&key(b)));
    let forecast = match options.forecast {
        true => HoldForecast::of(samples, &laws, &options.fit, watch)?,
        false => None,
    };
    let mut comparison = Comparison {
        rows,
        ranking,
        cuts,
        duration,
        change,
        noise,
        samples: values.len(),
        effective_samples: effective,
        forecast,
        verdict: None,
    };
    comparison.verdict = judge(&comparison);
    Ok(comparison)
}

/// Samples that count as independent: most of what laws say that describe the hold about as closely as the closest. Terms of a series that
/// follow the noise leave residuals that look slow, one time in fifty; those of another law show then that they are not.
fn independent<'f>(closest: &Fit, fits: impl Iterator<Item = &'f Fit>) -> f64 {
    let variance = |fit: &Fit| fit.residual_square / (fit.samples as f64 - fit.free_parameters() as f64).max(1.0);
    let alike = 1.02 + 3.0 / closest.samples as f64;
    let close = fits.filter(|fit| variance(fit) <= alike * variance(closest));
    close.map(Fit::effective_samples).fold(closest.effective_samples(), f64::max)
}

/// Where the spectrum leaves less than this share of what the closest law leaves, the residuals of that law are no noise.
const CLOSER: f64 = 0.8;

/// Samples that count as independent by the correlation of neighbouring residuals of the spectrum, as those of AR(1).
fn effective_beside(spectrum: &SpectrumFit, samples: &Samples<'_>) -> f64 {
    /// As many say enough of their neighbours.
    const MOST: usize = 1 << 16;
    let (times, values) = (samples.times, samples.values);
    let first = values.len().saturating_sub(MOST) / 2;
    let (roots, _) = samples.roots();
    let root = |i: usize| roots.as_ref().map_or(1.0, |roots| roots[i]);
    let left = |i: usize| root(i) * (values[i] - spectrum.predict(times[i] - times[0]));
    let residuals: Vec<f64> = (first..values.len().min(first + MOST)).map(left).collect();
    let square: f64 = residuals.iter().map(|residual| residual * residual).sum();
    let product: f64 = residuals.windows(2).map(|pair| pair[0] * pair[1]).sum();
    let correlation = (product / square).clamp(0.0, 0.999);
    let correlation = if correlation.is_nan() { 0.0 } else { correlation };
    (values.len() as f64 * (1.0 - correlation) / (1.0 + correlation)).max(2.0)
}

fn row(
    samples: &Samples<'_>,
    law: Law,
    options: &CompareOptions,
    known: &[KnownFit<'_>],
    watch: &mut dyn Watch,
) -> Result<Row, FitError> {
    let mut row = Row {
        law,
        fit: Err(FitError::NoDecay),
        spectrum: None,
        effective_parameters: 0.0,
        rmse: f64::NAN,
        criteria: None,
        delta_bic: None,
        forward: ForwardScore::default(),
    };
    if law == Law::Spectrum {
        let (roots, precision) = samples.roots();
        let fit = fit_spectrum(samples.times, samples.values, roots.as_deref(), &SpectrumOptions::default())?;
        let fit = fit.in_deviations(precision);
        row.effective_parameters = fit.effective_parameters;
        row.rmse = fit.rmse();
        row.spectrum = Some(fit);
        return Ok(row);
    }
    let same = |known: &&KnownFit<'_>| known.fit.law == law && known.options.same_for(law, &options.fit);
    row.fit = match known.iter().find(same) {
        Some(known) => Ok(known.fit.clone()),
        None => fit_law_watched(samples, law, &options.fit, watch),
    };
    match &row.fit {
        Ok(fit) => {
            row.effective_parameters = fit.free_parameters() as f64;
            row.rmse = fit.rmse;
        }
        // A law may ask for more samples than there are; what no law can be fitted to is an error of the whole.
        Err(FitError::TooFewSamples { .. } | FitError::NoForm { .. } | FitError::NoDecay) => {}
        Err(error) => return Err(error.clone()),
    }
    Ok(row)
}

/// Change of the signal over the hold: first sample to the mean of the last hundredth.
pub(crate) fn change(values: &[f64]) -> f64 {
    let tail = (values.len() / 100).max(1);
    (values[0] - mean(&values[values.len() - tail..])).abs()
}

/// Cut points at which there is something to predict: enough samples before, and a change after that shows above the noise.
fn cuts(samples: &Samples<'_>, options: &CompareOptions, duration: f64, noise: f64) -> Vec<f64> {
    /// Least samples in the first part.
    const FEWEST: usize = 30;
    /// Least change after the cut, in standard deviations of the noise of the means that show it.
    const OBSERVED: f64 = 5.0;
    let (times, values) = (samples.times, samples.values);
    let tells = |cut: &f64| {
        let first = until(times, *cut);
        let rest = &values[first..];
        if first < FEWEST || rest.len() < FEWEST / 3 {
            return false;
        }
        let part = (rest.len() / 10).max(1);
        let moved = (mean(&rest[..part]) - mean(&rest[rest.len() - part..])).abs();
        moved > OBSERVED * noise * (2.0 / part as f64).sqrt()
    };
    options
        .cuts
        .iter()
        .map(|share| share * duration)
        .filter(|cut| *cut > 0.0 && *cut < duration)
        .filter(tells)
        .collect()
}

/// Fills the criteria of every row; `change` is that of the signal in standard deviations, where samples have those.
fn weigh(rows: &mut [Row], effective: f64, samples: usize, change: f64) {
    // Noise-free records leave rounding only; below this share of the signal all residuals are equal.
    let floor = (1e-9 * change).powi(2) * samples as f64;
    let square = |row: &Row| match (&row.fit, &row.spectrum) {
        (_, Some(spectrum)) => Some(spectrum.residual_square.max(floor)),
        (Ok(fit), None) => Some(fit.residual_square.max(floor)),
        _ => None,
    };
    let count = samples as f64;
    for row in rows.iter_mut() {
        row.criteria = square(row).map(|square| criteria(square, count, row.effective_parameters));
        row.delta_bic =
            square(row).map(|square| criteria(square * effective / count, effective, row.effective_parameters).bic);
    }
    let lowest = rows.iter().filter_map(|row| row.delta_bic).fold(f64::INFINITY, f64::min);
    for row in rows {
        row.delta_bic = row.delta_bic.map(|bic| bic - lowest);
    }
}
