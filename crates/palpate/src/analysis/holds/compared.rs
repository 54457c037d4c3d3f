//! What a comparison of laws gives cause to say.

use super::end_value::end_value;
use crate::analysis::finding::Finding;
use crate::fit::{Fit, LawOptions, ParameterKind, Samples, Termination};
use crate::forecast::{Comparison, HoldForecast};
use crate::laws::Law;
use crate::record::Record;
use crate::segment::{After, HoldMode, OBSERVED, PARTS, Segment, change, error_of_mean};
use crate::statistics::{mean, range};
use crate::watch::{Cancelled, Watch};

/// Adds to the comparisons of the holds of a record what each hold will show next, by what laws have predicted of all.
pub(super) fn add_forecasts(
    holds: Vec<(Samples<'_>, LawOptions, &mut Comparison)>,
    laws: &[Law],
    watch: &mut dyn Watch,
) -> Result<(), Cancelled> {
    let (samples, comparisons): (Vec<_>, Vec<_>) =
        holds.into_iter().map(|(samples, options, comparison)| ((samples, options), comparison)).unzip();
    let forecasts = HoldForecast::of_record(&samples, laws, watch)?;
    for (comparison, forecast) in comparisons.into_iter().zip(forecasts) {
        comparison.forecast = forecast;
    }
    Ok(())
}

/// What a comparison gives cause to say on a hold whose first two samples are an `interval` (s) apart.
pub(super) fn comparison_findings(comparison: &Comparison, interval: f64) -> Vec<Finding> {
    let laws = |which: &dyn Fn(&Fit) -> bool| -> Vec<Law> {
        let fits = comparison.rows.iter().filter_map(|row| row.fit.as_ref().ok());
        fits.filter(|fit| which(fit)).map(|fit| fit.law).collect()
    };
    let at_bound = laws(&|fit| matches!(fit.termination, Termination::RateAtBound | Termination::ExponentAtBound));
    let merged = laws(&Fit::has_redundant_terms);
    // A law that contains the chosen one predicts at least as well.
    let alike = comparison.verdict.as_ref().map_or_else(Vec::new, |verdict| {
        let alternatives = verdict.indistinguishable.iter().filter(|law| !law.contains(verdict.law));
        [verdict.law].iter().chain(alternatives).copied().collect()
    });
    let mut findings = Vec::new();
    findings.extend(times_out_of_sight(comparison, interval));
    if !at_bound.is_empty() {
        findings.push(Finding::ParametersAtBound { laws: at_bound });
    }
    if !merged.is_empty() {
        findings.push(Finding::TermsIndistinguishable { laws: merged });
    }
    findings.extend(equilibrium_by_law(comparison, &alike));
    if alike.len() > 1 {
        findings.push(Finding::LawsIndistinguishable { laws: alike });
    }
    findings
}

/// Where the first of laws that are not distinguishable has an interval of the equilibrium, or the end of a creep, that leaves out those of others, or others have none.
fn equilibrium_by_law(comparison: &Comparison, alike: &[Law]) -> Option<Finding> {
    let (law, others) = alike.split_first()?;
    let equilibrium = |law: &Law| Some(end_value(fit_of(comparison, *law)?).map(|(estimate, _)| estimate));
    let (_, response) = end_value(fit_of(comparison, *law)?)?;
    let (low, high) = equilibrium(law)??.interval?;
    // Far beyond a hold a dense spectrum goes where its ridge takes it.
    let fitted = others.iter().filter(|law| !matches!(law, Law::Spectrum));
    let (mut outside, mut without) = (Vec::new(), Vec::new());
    for other in fitted {
        match equilibrium(other) {
            Some(Some(estimate)) if !(low..=high).contains(&estimate.value) => outside.push(*other),
            Some(None) => without.push(*other),
            _ => {}
        }
    }
    // A series and its interval know nothing slower than its last term; a spectrum that is as good and reaches the end of its grid does.
    let spectrum = comparison.rows.iter().find_map(|row| row.spectrum.as_ref()).filter(|fit| fit.is_open_ended());
    let is_alike = |law| comparison.verdict.as_ref().is_some_and(|verdict| verdict.indistinguishable.contains(&law));
    if law.is_series()
        && is_alike(Law::Spectrum)
        && spectrum.is_some_and(|fit| !(low..=high).contains(&fit.equilibrium))
    {
        outside.push(Law::Spectrum);
    }
    (!outside.is_empty() || !without.is_empty()).then_some(Finding::EquilibriumByLaw {
        law: *law,
        outside,
        without,
        response,
    })
}

/// The fit of a law of the comparison.
fn fit_of(comparison: &Comparison, law: Law) -> Option<&Fit> {
    comparison.rows.iter().find(|row| row.law == law)?.fit.as_ref().ok()
}

/// The fit of the recommended law.
pub(super) fn recommended(comparison: &Comparison) -> Option<&Fit> {
    fit_of(comparison, comparison.verdict.as_ref()?.law)
}

/// Sample intervals up to which a time constant is that of the first samples.
const FIRST_SAMPLES: f64 = 2.0;

/// Time constants of the recommended law that the hold does not show: one that outlasts it, and one of a series that ends with its first samples.
fn times_out_of_sight(comparison: &Comparison, interval: f64) -> Vec<Finding> {
    let Some(fit) = recommended(comparison) else {
        return Vec::new();
    };
    let law = fit.law;
    let times = fit.parameters.iter().filter(|parameter| parameter.name.kind == ParameterKind::Time);
    let (shortest, longest) = times
        .map(|parameter| parameter.estimate.value)
        .fold((f64::INFINITY, 0.0f64), |(least, most), time| (least.min(time), most.max(time)));
    let duration = comparison.duration;
    let outlasts = (longest > duration).then_some(Finding::TimeBeyondHold {
        law,
        time_constant: longest,
        duration,
    });
    let is_over = (law.is_series() && shortest < FIRST_SAMPLES * interval).then_some(Finding::FirstSamplesAlone {
        law,
        time_constant: shortest,
        interval,
    });
    outlasts.into_iter().chain(is_over).collect()
}

/// What shows that a hold is not one of constant displacement with a force that relaxes.
pub(super) fn not_a_hold(record: &Record, segment: &Segment) -> Option<Finding> {
    let moved = change(record, segment.start, segment.end);
    let (travel, change) = moved.map_or((0.0, 0.0), |moved| (moved.travel, moved.force));
    match segment.mode {
        Some(HoldMode::ForceHeld) => Some(Finding::FeedbackControlled { travel, change }),
        Some(HoldMode::Neither) if moved.is_some() => Some(Finding::NothingHeld { travel, change }),
        _ => drift(record, segment),
    }
}

/// Means of ten equal parts.
fn means(values: &[f64]) -> Vec<f64> {
    let bounds: Vec<usize> = (0..=PARTS).map(|i| i * values.len() / PARTS).collect();
    bounds.windows(2).map(|pair| mean(&values[pair[0]..pair[1]])).collect()
}

/// The force rises in a hold after loading: at once, or again after it has fallen.
fn drift(record: &Record, segment: &Segment) -> Option<Finding> {
    /// Of what it fell, and of the force's range in the record.
    const LEAST_SHARES: [f64; 2] = [0.03, 2e-3];
    /// Samples at an end, or a hundredth of them.
    const ENDS: usize = 3;
    let force = &record.force()[segment.fit_start..segment.end];
    if segment.after != Some(After::Loading) || force.len() < 3 * PARTS {
        return None;
    }
    let parts = means(force);
    let lowest = parts.iter().copied().fold(f64::MAX, f64::min);
    let (rise, fall) = (parts[PARTS - 1] - lowest, parts[0] - lowest);
    let observed = rise > OBSERVED * std::f64::consts::SQRT_2 * error_of_mean(force);
    let matters = rise > LEAST_SHARES[0] * fall && rise > LEAST_SHARES[1] * range(record.force());
    // Means of tenths tell a drift from noise; how far it goes is between its ends.
    let first = mean(&force[..ENDS]);
    let last = mean(&force[force.len() - (force.len() / 100).max(ENDS)..]);
    let least = lowest.min(first);
    (observed && matters).then_some(Finding::DriftInsteadOfRelaxation {
        rise: last - least,
        fall: if fall > 0.0 { first - least } else { 0.0 },
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "in a test a panic is the verdict")]

    use super::*;
    use crate::forecast::{CompareOptions, compare_laws};
    use crate::test_problems::Rng;

    /// An equilibrium of −66 N, by a time constant of 110 min from a hold of 65 s, stood without a word.
    #[test]
    fn a_time_constant_that_outlasts_the_hold_is_reported() {
        let codes = |duration: f64| -> Vec<&'static str> {
            let mut random = Rng::new(4);
            let times: Vec<f64> = (0..400).map(|i| duration * f64::from(i) / 399.0).collect();
            let values: Vec<f64> = times.iter().map(|t| 1.0 + (-t / 10.0).exp() + 1e-3 * random.normal()).collect();
            let laws = vec!["sls".parse().unwrap()];
            let options = CompareOptions {
                laws,
                ..CompareOptions::default()
            };
            let found = compare_laws(&Samples::new(&times, &values), &options).unwrap();
            comparison_findings(&found, times[1]).iter().map(Finding::code).collect()
        };
        assert!(codes(5.0).contains(&"time_beyond_hold") && !codes(20.0).contains(&"time_beyond_hold"));
    }

    /// A first sample 6 % too high was a term of 7 ms in a "clear" law, of samples 50 ms apart.
    #[test]
    fn a_term_of_the_first_sample_alone_is_reported() {
        let codes = |first: f64| -> Vec<&'static str> {
            let mut random = Rng::new(4);
            let times: Vec<f64> = (0..400).map(|i| 0.05 * f64::from(i)).collect();
            let mut values: Vec<f64> =
                times.iter().map(|t| 12.0 + 8.0 * (-t / 5.0).exp() + 1e-2 * random.normal()).collect();
            values[0] += first;
            let found = compare_laws(&Samples::new(&times, &values), &CompareOptions::default()).unwrap();
            comparison_findings(&found, times[1]).iter().map(Finding::code).collect()
        };
        assert!(codes(1.2).contains(&"first_samples_alone") && !codes(0.0).contains(&"first_samples_alone"));
    }
}
