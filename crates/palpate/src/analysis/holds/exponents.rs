//! The exponents fitted to the holds of a record: the list, its extension, the free one.

use super::hold::{HoldAnalysis, HoldoutError};
use crate::analysis::{AnalysisOptions, Finding};
use crate::fit::{ExponentChoice, FitError, LatencyFit, fit_hold_watched, fit_rates_watched, fitted, select_order};
use crate::forecast::change;
use crate::watch::{Cancelled, Progress, Watch};

/// What a list is extended by: steps of about 1.4 up to the largest exponent of a free fit.
const LADDER: [f64; 9] = [1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 14.0, 20.0, 30.0];

/// Fits the listed exponents and the free one to every hold; returns the list with its extension, and the finding of it.
///
/// An exponent at the end of a list may be limited by the list and not by the data. A list of two exponents or more is therefore
/// extended along [`LADDER`] while the information criterion of any hold is lowest at its end. All holds are fitted with the same
/// exponents, so that their criteria can be summed. A list of one exponent is a choice and stays.
pub(in crate::analysis) fn fit_exponents(
    holds: &mut [HoldAnalysis],
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<(Vec<f64>, Option<Finding>), Cancelled> {
    let mut exponents = options.exponents.clone();
    exponents.sort_by(f64::total_cmp);
    exponents.dedup();
    for exponent in &exponents {
        fit_all(holds, ExponentChoice::Fixed(*exponent), options, watch)?;
    }
    let at_ends: Vec<usize> = holds.iter().filter(|hold| end(hold).is_some()).map(|hold| hold.number).collect();
    let mut added = Vec::new();
    let mut open = false;
    for upwards in [true, false] {
        while holds.iter().any(|hold| end(hold) == Some(upwards)) {
            let Some(next) = beyond(&exponents, upwards, options) else {
                open |= upwards;
                break;
            };
            fit_all(holds, ExponentChoice::Fixed(next), options, watch)?;
            exponents.insert(if upwards { exponents.len() } else { 0 }, next);
            added.push(next);
        }
    }
    added.sort_by(f64::total_cmp);
    if options.free_exponent {
        fit_all(holds, ExponentChoice::Free, options, watch)?;
    }
    let finding = (!added.is_empty()).then(|| Finding::ExponentListExtended {
        listed: options.exponents.clone(),
        added,
        holds: at_ends,
        open,
    });
    Ok((exponents, finding))
}

/// The next exponent of the ladder beyond an end of the list.
fn beyond(exponents: &[f64], upwards: bool, options: &AnalysisOptions) -> Option<f64> {
    let (low, high) = options.fit.exponent_range;
    let mut ladder = LADDER.into_iter().filter(|n| (low..=high).contains(n));
    if upwards {
        ladder.find(|n| exponents.last().is_some_and(|last| n > last))
    } else {
        ladder.rev().find(|n| exponents.first().is_some_and(|first| n < first))
    }
}

/// At which end of the list the criterion of a hold is lowest: `true` for its largest exponent, `false` for its smallest.
fn end(hold: &HoldAnalysis) -> Option<bool> {
    let listed = select_order(&hold.fits).candidates;
    let best = (0..listed.len()).min_by(|a, b| listed[*a].delta_bic.total_cmp(&listed[*b].delta_bic))?;
    match listed.len() {
        0 | 1 => None,
        count => (best == count - 1).then_some(true).or((best == 0).then_some(false)),
    }
}

fn fit_all(
    holds: &mut [HoldAnalysis],
    choice: ExponentChoice,
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<(), Cancelled> {
    holds
        .iter_mut()
        .filter(|hold| hold.relaxes())
        .try_for_each(|hold| fit_exponent(hold, choice, options, watch))
}

fn fit_exponent(
    hold: &mut HoldAnalysis,
    choice: ExponentChoice,
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<(), Cancelled> {
    let (times, values) = (&hold.times[..hold.fitted], &hold.values[..hold.fitted]);
    watch.report(Progress::open("fitting the latency law", hold.fits.len()))?;
    match fit_hold_watched(times, values, choice, &options.fit, watch) {
        Ok(fit) => {
            let before = |fitted: &LatencyFit| match choice {
                ExponentChoice::Fixed(exponent) => fitted.exponent().value < exponent,
                ExponentChoice::Free => true,
            };
            let at = hold.fits.partition_point(before);
            hold.predictions.insert(at, forecast(&fit, &hold.times, &hold.values, hold.fitted));
            hold.fits.insert(at, fit);
            let rates = fit_rates_watched(&hold.rates.strain, &hold.rates.rate, choice, &options.fit, watch);
            hold.rate_fits.insert(at, fitted(rates)?);
        }
        Err(FitError::TooFewSamples { needed, found, .. }) => {
            if hold.fits.is_empty() && hold.findings.iter().all(|finding| finding.code() != "too_few_samples") {
                hold.findings.push(Finding::TooFewSamples { found, needed });
            }
        }
        Err(FitError::Cancelled(cancelled)) => return Err(cancelled),
        // A constant signal has been reported as no relaxation; nothing else can happen to a checked record.
        Err(_) => {}
    }
    Ok(())
}

/// Error of a fit over the samples from index `fitted` on.
fn forecast(fit: &LatencyFit, times: &[f64], values: &[f64], fitted: usize) -> Option<HoldoutError> {
    let beyond = times[fitted..].iter().zip(&values[fitted..]);
    let samples = values.len() - fitted;
    if samples == 0 {
        return None;
    }
    let square: f64 = beyond.map(|(t, y)| (y - fit.predict(*t)).powi(2)).sum();
    let rmse = (square / samples as f64).sqrt();
    Some(HoldoutError {
        rmse,
        relative: rmse / change(values),
        samples,
    })
}
