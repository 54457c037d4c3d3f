//! One hold.

use serde::{Deserialize, Serialize};

use super::compared::{add_forecasts, comparison_findings, not_a_hold, recommended};
use super::drive::drive_changes;
use super::end_value::{beyond_zero, extrapolated};
use super::jump::force_step;
use super::rate_bias::{RateBias, rate_bias};
use crate::analysis::{AnalysisOptions, Finding};
use crate::contact::{Shape, Specimen};
use crate::fit::{
    Domain, ExponentChoice, Fit, LatencyFit, LawOptions, OrderSelection, Samples, Termination, fitted, select_order,
};
use crate::forecast::{CompareOptions, Comparison, KnownFit, change, compare_laws_watched};
use crate::laws::Loading;
use crate::record::Record;
use crate::segment::{
    After, FitStartRule, HoldMode, Relaxation, RelaxationType, Segment, classify_relaxation, force_delay,
};
use crate::simulate::Separation;
use crate::statistics::{mean, median, noise};
use crate::strain::{StrainRates, contact_strain, strain_rates};
use crate::watch::{Cancelled, Watch};

/// What the laws are fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Signal {
    /// Strain of the contact layer.
    Strain,
    /// Force, N.
    Force,
}

/// All that is known of one hold.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct HoldAnalysis {
    /// Number of the hold in the record, from 1.
    pub number: usize,
    /// Where it lies.
    pub segment: Segment,
    /// Time of its first sample, s.
    pub start: f64,
    /// Time of its last sample, s.
    pub end: f64,
    /// Time from which the laws are fitted, s; [`Segment::fit_start_rule`] says how it was chosen.
    pub fit_start: f64,
    /// Displacement of the jaw (median), m, if recorded.
    pub displacement: Option<f64>,
    /// What came before.
    pub after: Option<After>,
    /// Type I or II.
    pub relaxation: Relaxation,
    /// Force where the fit starts, N.
    pub force_start: f64,
    /// Force at the end (mean of the last hundredth), N.
    pub force_end: f64,
    /// What was fitted.
    pub signal: Signal,
    /// Newtons per unit of the signal at this hold: E A, or 1.
    pub force_per_signal: f64,
    /// Equilibrium force per modulus at this hold, N/Pa: the modulus that an equilibrium force F_e implies is F_e over it.
    pub force_per_modulus: Option<f64>,
    /// Share by which first touch and the instrument leave that modulus uncertain.
    pub modulus_error: Option<f64>,
    /// Times since the start of the fit, s.
    pub times: Vec<f64>,
    /// The signal at those times.
    pub values: Vec<f64>,
    /// How many of those samples were fitted (the rest is predicted).
    pub fitted: usize,
    /// Time-domain fits: the exponents of the list and of its extension in order, then the free one.
    pub fits: Vec<LatencyFit>,
    /// How well each predicts the rest of the hold, where the fit ended early on request.
    pub predictions: Vec<Option<HoldoutError>>,
    /// Choice of the exponent by the data.
    pub order: Option<OrderSelection>,
    /// Laws compared on the hold.
    pub comparison: Option<Comparison>,
    /// Smoothed strains and strain rates.
    pub rates: StrainRates,
    /// Rate-domain fits in the same order as `fits`; `None` where one could not be made.
    pub rate_fits: Vec<Option<LatencyFit>>,
    /// How far noise takes the rate domain from the truth, at the preferred exponent.
    pub rate_bias: Option<RateBias>,
    /// What to know about this hold.
    pub findings: Vec<Finding>,
}

impl HoldAnalysis {
    /// Times and values that were fitted.
    pub(in crate::analysis) fn samples(&self) -> Samples<'_> {
        Samples::new(&self.times[..self.fitted], &self.values[..self.fitted])
    }

    /// Root mean square residual of a fit to the signal as a share of the change of the signal over the fitted samples: from the first to the
    /// mean of the last hundredth. `None` of a fit to rates.
    #[must_use]
    pub fn relative_rmse(&self, fit: &LatencyFit) -> Option<f64> {
        (fit.domain == Domain::Time).then(|| fit.rmse / change(self.samples().values))
    }

    /// Whether the hold has a signal that relaxes, so that laws are fitted to it.
    pub(super) fn relaxes(&self) -> bool {
        !self.times.is_empty() && self.relaxation.kind != RelaxationType::None
    }

    /// The preferred time-domain fit.
    #[must_use]
    pub fn preferred(&self) -> Option<&LatencyFit> {
        self.fits.get(self.order.as_ref()?.preferred?)
    }

    /// The time-domain fit with a given exponent.
    #[must_use]
    pub fn fit_with(&self, exponent: f64) -> Option<&LatencyFit> {
        self.fits.iter().find(|fit| fit.choice() == ExponentChoice::Fixed(exponent))
    }

    /// The rate-domain fit with a given exponent.
    #[must_use]
    pub fn rate_fit_with(&self, exponent: f64) -> Option<&LatencyFit> {
        self.rate_fits.iter().flatten().find(|fit| fit.choice() == ExponentChoice::Fixed(exponent))
    }
}

/// A hold of a corrected record with its signal, before any fit.
pub(in crate::analysis) fn prepare_hold(
    record: &Record,
    (segments, index): (&[Segment], usize),
    number: usize,
    specimen: Option<&Specimen>,
    options: &AnalysisOptions,
) -> HoldAnalysis {
    let mut segment = segments[index];
    let reopened = specimen.and_then(|_| open_until(record, &segment, options));
    if let Some(closed) = reopened.filter(|closed| *closed > segment.fit_start) {
        (segment.fit_start, segment.fit_start_rule) = (closed, Some(FitStartRule::ContactClosed));
    }
    let range = segment.fit_start..segment.end;
    let force = &record.force()[range];
    let displacement = record.displacement().map(|d| median(&mut d[segment.start..segment.end].to_vec()));
    let tail = (force.len() / 100).max(1);
    let mut hold = HoldAnalysis {
        number,
        segment,
        start: record.time()[segment.start],
        end: record.time()[segment.end - 1],
        fit_start: record.time()[segment.fit_start],
        displacement,
        after: segment.after,
        relaxation: classify_relaxation(force),
        force_start: force[0],
        force_end: mean(&force[force.len() - tail..]),
        signal: if specimen.is_some() { Signal::Strain } else { Signal::Force },
        force_per_signal: 1.0,
        force_per_modulus: None,
        modulus_error: None,
        times: Vec::new(),
        values: Vec::new(),
        fitted: 0,
        fits: Vec::new(),
        predictions: Vec::new(),
        order: None,
        comparison: None,
        rates: StrainRates::default(),
        rate_fits: Vec::new(),
        rate_bias: None,
        findings: Vec::new(),
    };
    if reopened.is_some() {
        hold.findings.push(Finding::ContactOpen { until: hold.fit_start });
    }
    hold.findings
        .extend(force_delay(record, segments, index).map(|delay| Finding::of_delay(&delay, hold.fit_start)));
    let force_held = segment.mode == Some(HoldMode::ForceHeld);
    if force_held {
        // A force that a controller brings back to where it was does not relax.
        hold.relaxation.kind = RelaxationType::None;
    } else if hold.relaxation.kind == RelaxationType::None {
        hold.findings.push(Finding::NoRelaxation {
            change: hold.relaxation.change,
            standard_error: hold.relaxation.standard_error,
        });
    }
    take_signal(&mut hold, record, if force_held { None } else { specimen }, options);
    if hold.relaxes() {
        if segment.mode == Some(HoldMode::DisplacementHeld) {
            hold.findings
                .extend(drive_changes(record, (segments, index), HoldMode::DisplacementHeld, segment.end));
        }
        let (times, values) = (&hold.times[..hold.fitted], &hold.values[..hold.fitted]);
        hold.rates = strain_rates(times, values, &options.rate_window);
    }
    hold
}

/// Completes a hold whose exponents have been fitted: the choice among them, the comparison of laws, the findings. `loading` is what was imposed
/// before it.
pub(in crate::analysis) fn complete_hold(
    hold: &mut HoldAnalysis,
    record: &Record,
    loading: Option<&Loading>,
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<(), Cancelled> {
    if hold.relaxes() {
        hold.order = (!hold.fits.is_empty()).then(|| select_order(&hold.fits));
        hold.comparison = compare(hold, loading, options, watch)?;
        hold.rate_bias = hold.preferred().and_then(|fit| rate_bias(hold.samples(), fit, options));
        judge(hold);
        let interval = hold.times[1];
        hold.findings.extend(hold.comparison.iter().flat_map(|found| comparison_findings(found, interval)));
    }
    hold.findings.extend(not_a_hold(record, &hold.segment));
    hold.findings.extend(force_step(record, &hold.segment));
    Ok(())
}

/// The sample at which the body meets the jaw again, in a hold after unloading that begins with the contact open.
///
/// Open means: no force beyond five times its noise. Only a jaw that cannot pull leaves the body.
fn open_until(record: &Record, segment: &Segment, options: &AnalysisOptions) -> Option<usize> {
    const LEAST: usize = 5;
    if options.separation != Separation::Unilateral || segment.after != Some(After::Unloading) {
        return None;
    }
    let force = &record.force()[segment.start..segment.end];
    let largest = record.force().iter().fold(0.0, |most: f64, f| most.max(f.abs()));
    let threshold = (5.0 * noise(force)).max(1e-3 * largest);
    let closed = force.windows(3).position(|three| three.iter().all(|f| *f > threshold))?;
    (closed >= LEAST).then_some(segment.start + closed)
}

/// Fills times and values, thinned if there are too many; they stay empty where there is no strain.
fn take_signal(hold: &mut HoldAnalysis, record: &Record, specimen: Option<&Specimen>, options: &AnalysisOptions) {
    let range = hold.segment.fit_start..hold.segment.end;
    let every = range.len().div_ceil(options.most_samples.max(8));
    if every > 1 {
        hold.findings.push(Finding::Thinned { every });
    }
    let start = hold.fit_start;
    let samples = range.step_by(every);
    match (specimen, record.displacement(), hold.displacement) {
        (Some(specimen), Some(displacement), Some(level)) => {
            let contact = specimen.contact_displacement(level);
            hold.force_per_signal = specimen.force(1.0, contact);
            let relaxed = specimen.equilibrium_force(contact) / specimen.modulus();
            hold.force_per_modulus = Some(relaxed).filter(|force| *force > 0.0);
            // So close to first touch the area is the difference of two nearly equal numbers, but under a tip, whose depth is that of the sample.
            let is_tip = matches!(specimen.shape(), Shape::Indenter { .. });
            let shallow = contact < 0.01 * specimen.depth() && specimen.contact_area(0.0) == 0.0 && !is_tip;
            for i in samples {
                match contact_strain(record.force()[i], displacement[i], specimen) {
                    Some(strain) if !shallow => {
                        hold.times.push(record.time()[i] - start);
                        hold.values.push(strain);
                    }
                    _ => {
                        hold.findings.push(Finding::NoContactArea);
                        hold.times.clear();
                        hold.values.clear();
                        return;
                    }
                }
            }
        }
        _ => {
            hold.signal = Signal::Force;
            for i in samples {
                hold.times.push(record.time()[i] - start);
                hold.values.push(record.force()[i]);
            }
        }
    }
    hold.fitted = options.fitted(&hold.times);
}

/// Compares laws over the whole hold, or over what was requested to be fitted.
fn compare(
    hold: &HoldAnalysis,
    loading: Option<&Loading>,
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<Option<Comparison>, Cancelled> {
    let Some(compare) = &options.compare else {
        return Ok(None);
    };
    let compare = CompareOptions {
        fit: fit_options(compare, loading),
        // All holds are forecast together.
        forecast: false,
        ..compare.clone()
    };
    let known = |fit| KnownFit {
        options: options.fit.of_latency(LatencyFit::choice(fit)),
        fit,
    };
    let known: Vec<KnownFit<'_>> = hold.fits.iter().map(known).collect();
    fitted(compare_laws_watched(&hold.samples(), &compare, &known, watch))
}

/// Adds to all compared holds what each will show next. `loadings` are what was imposed before them.
pub(in crate::analysis) fn forecast_holds(
    holds: &mut [HoldAnalysis],
    loadings: &[Option<Loading>],
    options: &AnalysisOptions,
    watch: &mut dyn Watch,
) -> Result<(), Cancelled> {
    let Some(compare) = options.compare.as_ref().filter(|compare| compare.forecast) else {
        return Ok(());
    };
    let compared = holds.iter_mut().zip(loadings).filter_map(|(hold, loading)| {
        let samples = Samples::new(&hold.times[..hold.fitted], &hold.values[..hold.fitted]);
        let fit = fit_options(compare, loading.as_ref());
        Some((samples, fit, hold.comparison.as_mut()?))
    });
    add_forecasts(compared.collect(), &compare.laws(), watch)
}

/// Options of the fits on a hold after a loading.
pub(in crate::analysis) fn fit_options(compare: &CompareOptions, loading: Option<&Loading>) -> LawOptions {
    LawOptions {
        loading: loading.or(compare.fit.loading.as_ref()).cloned(),
        ..compare.fit.clone()
    }
}

/// Adds what the fits give cause to say.
fn judge(hold: &mut HoldAnalysis) {
    let Some(order) = hold.order.as_ref() else { return };
    let alike: Vec<f64> = order
        .candidates
        .iter()
        .filter(|candidate| !candidate.free && candidate.indistinguishable)
        .map(|candidate| candidate.exponent)
        .collect();
    if alike.len() > 1 {
        hold.findings.push(Finding::ExponentsIndistinguishable { exponents: alike });
    }
    if let Some(free) = hold.fits.iter().find(|fit| fit.choice() == ExponentChoice::Free) {
        match free.exponent().interval {
            Some((low, high)) if high - low > free.exponent().value.max(1.0) => {
                hold.findings.push(Finding::ExponentUndetermined {
                    interval: Some((low, high)),
                });
            }
            Some(_) => {
                if let Some(correlation) = confounded(free) {
                    hold.findings.push(Finding::ExponentConfounded { correlation });
                }
            }
            None if free.termination != Termination::RateAtBound => {
                hold.findings.push(Finding::ExponentUndetermined { interval: None });
            }
            _ => {}
        }
    }
    let Some(best) = hold.preferred().cloned() else { return };
    let bounded = best.termination == Termination::RateAtBound;
    if bounded {
        hold.findings.push(Finding::RateAtBound {
            exponent: best.exponent().value,
        });
    }
    match hold.comparison.as_ref().and_then(recommended).cloned() {
        Some(fit) => judge_fit(hold, &fit),
        None if !bounded => judge_fit(hold, &best),
        None => {}
    }
}

/// Adds what the fit of the law to use gives cause to say.
fn judge_fit(hold: &mut HoldAnalysis, fit: &Fit) {
    let (last, first_step) = (hold.times[hold.fitted - 1], hold.times[1]);
    let [start, next, end] = [0.0, first_step, last].map(|time| fit.predict(time));
    hold.findings.extend(extrapolated(fit, last));
    hold.findings.extend(beyond_zero(fit, last));
    let share = (start - next) / (start - end);
    if share > 0.3 {
        hold.findings.push(Finding::SampledTooSlowly { share });
    }
    if fit.residual_correlation > 0.5 && fit.rmse > 1e-9 * (start - end).abs() {
        hold.findings.push(Finding::ResidualsCorrelated {
            law: fit.law,
            correlation: fit.residual_correlation,
            independent: fit.effective_samples(),
        });
    }
    hold.findings.extend(Finding::of_noise(fit));
}

/// Correlation of exponent and equilibrium, if it is close to one and the exponent is not known well for all that.
fn confounded(fit: &LatencyFit) -> Option<f64> {
    const CLOSE: f64 = 0.98;
    const WIDE: f64 = 0.2;
    let (low, high) = fit.exponent().interval?;
    if high - low < WIDE * fit.exponent().value {
        return None;
    }
    let covariance = fit.covariance()?;
    let correlation = covariance[0][3] / (covariance[0][0] * covariance[3][3]).sqrt();
    (correlation.abs() > CLOSE).then_some(correlation)
}

/// Error of a fit over samples that it was not fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct HoldoutError {
    /// Root mean square of measured less predicted, in the unit of the signal.
    pub rmse: f64,
    /// The same as a share of the drop of the signal over the whole hold, or of the largest force of the whole record.
    pub relative: f64,
    /// Samples that were held out.
    pub samples: usize,
}
