//! One law for all holds, or one each?

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

use super::result::law_options;
use crate::fit::{Fit, FitError, JointFit, ParameterUnit, Samples, SharedTrend, TrendPoint, fit_law_watched};
use crate::watch::{Unwatched, Watch};

/// What a parameter does from hold to hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TrendVerdict {
    /// One law fits all holds, and no change by a factor of 2 over their strains is compatible with the data; or none by 2 %.
    Constant,
    /// The interval of the slope lies below zero.
    FallsWithStrain,
    /// The interval of the slope lies above zero.
    RisesWithStrain,
    /// The holds differ without a trend, or too little is known of one.
    Undecided,
}

/// A joint fit against the holds fitted alone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct JointComparison {
    /// F = [(RSS_joint − RSS_separate)/(difference of parameters)]/[RSS_separate/(N_e − parameters of the separate fits)].
    pub statistic: f64,
    /// Its degrees of freedom; the second one counts independent samples.
    pub freedom: (f64, f64),
    /// Probability of such an F or a larger one if all holds follow one law; `None` if too few samples are independent.
    pub p: Option<f64>,
    /// Bayesian information criterion of the joint fit less that of the separate ones; negative speaks for one law.
    pub delta_bic: f64,
    /// The same of Akaike's criterion for small samples; `None` if too few samples are independent.
    pub delta_aicc: Option<f64>,
    /// Independent samples N_e, from the residuals of the separate fits.
    pub effective_samples: f64,
    /// The first shared parameter over the strain; `None` if the holds lie at one strain or have no errors.
    pub trend: Option<SharedTrend>,
    /// What it does.
    pub verdict: TrendVerdict,
}

/// Change over the range of strains, in ln, below which a parameter is constant however sure the change is.
const NEGLIGIBLE: f64 = 0.02;

/// Change over the range of strains, in ln, that a constant parameter must not be compatible with.
const NOTABLE: f64 = std::f64::consts::LN_2;

/// Compares a joint fit with separate fits of the holds, and tests the first shared parameter for a trend with strain.
///
/// `holds` are those of the joint fit. `strains` gives the abscissa of each; without it, it is the constant that each hold
/// tends to. For the trend a dimensionless parameter beside (n of the latency law) is held alike in all holds, at the mean of the separate
/// fits by their errors, since v changes its unit with n; what the error of that mean does to the slope is part of its error.
///
/// ```
/// use palpate::fit::{JointOptions, Samples, TrendVerdict, compare_joint, fit_joint};
/// use palpate::latency::decay;
/// use palpate::laws::{ExponentChoice, Law};
/// use palpate::test_problems::Rng;
/// // Three holds at strains of 0.1, 0.2 and 0.3 whose v falls: ln v = 10 − 6 ε_e.
/// let times: Vec<f64> = (0..200).map(|i| 0.1 * f64::from(i)).collect();
/// let mut noise = Rng::new(3);
/// let mut hold = |strain: f64| -> Vec<f64> {
///     let rate = (10.0 - 6.0 * strain).exp() * 0.13f64.powi(4);
///     times.iter().map(|t| strain + 0.13 * decay(rate * t, 5.0) + 1e-4 * noise.normal()).collect()
/// };
/// let values = [hold(0.1), hold(0.2), hold(0.3)];
/// let holds: Vec<Samples<'_>> = values.iter().map(|values| Samples::new(&times, values)).collect();
/// let law = Law::Latency { exponent: ExponentChoice::Fixed(5.0) };
/// let joint = fit_joint(&holds, law, &JointOptions::default())?;
/// let comparison = compare_joint(&holds, &joint, None)?;
/// assert!(comparison.p.unwrap() < 1e-6);
/// assert!((comparison.trend.as_ref().unwrap().slope + 6.0).abs() < 0.5);
/// assert_eq!(comparison.verdict, TrendVerdict::FallsWithStrain);
/// # Ok::<(), palpate::fit::FitError>(())
/// ```
///
/// # Errors
/// [`FitError::Lengths`] if `strains` or `holds` are not as many as were fitted, and those of [`fit_law`](crate::fit::fit_law).
pub fn compare_joint(
    holds: &[Samples<'_>],
    joint: &JointFit,
    strains: Option<&[f64]>,
) -> Result<JointComparison, FitError> {
    compare_joint_watched(holds, joint, strains, &mut Unwatched)
}

/// [`compare_joint`] with a watch.
///
/// # Errors
/// As [`compare_joint`], and [`FitError::Cancelled`].
pub fn compare_joint_watched(
    holds: &[Samples<'_>],
    joint: &JointFit,
    strains: Option<&[f64]>,
    watch: &mut dyn Watch,
) -> Result<JointComparison, FitError> {
    let count = joint.holds.len();
    FitError::check_lengths(holds.len(), count)?;
    FitError::check_lengths(strains.map_or(count, <[f64]>::len), count)?;
    let effective: f64 = joint.separate.iter().map(Fit::effective_samples).sum();
    let few = joint.free_parameters() as f64;
    let many: f64 = joint.separate.iter().map(|fit| fit.free_parameters() as f64).sum();
    // Noise-free records leave rounding only.
    let scale = joint.holds.iter().flat_map(|fit| &fit.values[..1]).map(|value| value.abs()).sum::<f64>();
    let floor = (1e-9 * scale / count as f64).powi(2) * joint.samples as f64;
    let (one, each) = (joint.residual_square.max(floor), joint.separate_residual_square.max(floor));
    let freedom = (many - few, effective - many);
    let statistic = ((one - each) / freedom.0).max(0.0) / (each / freedom.1.max(1.0));
    let tested = freedom.0 > 0.0 && freedom.1 >= 1.0;
    let law = FisherSnedecor::new(freedom.0, freedom.1).ok().filter(|_| tested);
    let p = law.map(|law| law.sf(statistic));
    let likelihood = effective * (one / each).ln();
    let small = |parameters: f64| 2.0 * parameters * effective / (effective - parameters - 1.0);
    let trend = trend(holds, joint, strains, watch)?;
    Ok(JointComparison {
        statistic,
        freedom,
        p,
        delta_bic: likelihood + (few - many) * effective.ln(),
        delta_aicc: (effective > many + 1.0).then(|| likelihood + small(few) - small(many)),
        effective_samples: effective,
        verdict: verdict(trend.as_ref(), p, 1.0 - joint.options.fit.confidence),
        trend,
    })
}

impl JointComparison {
    /// The same for holds at one level, over which a trend has no meaning.
    pub(crate) fn without_trend(&mut self) {
        (self.trend, self.verdict) = (None, TrendVerdict::Undecided);
    }
}

fn verdict(trend: Option<&SharedTrend>, p: Option<f64>, level: f64) -> TrendVerdict {
    match trend {
        Some(trend) if trend.most_change() < NEGLIGIBLE => TrendVerdict::Constant,
        Some(trend) if trend.interval.1 < 0.0 => TrendVerdict::FallsWithStrain,
        Some(trend) if trend.interval.0 > 0.0 => TrendVerdict::RisesWithStrain,
        Some(trend) if trend.most_change() < NOTABLE && p.is_some_and(|p| p >= level) => TrendVerdict::Constant,
        _ => TrendVerdict::Undecided,
    }
}

/// ln of the first shared parameter over the strain.
fn trend(
    holds: &[Samples<'_>],
    joint: &JointFit,
    strains: Option<&[f64]>,
    watch: &mut dyn Watch,
) -> Result<Option<SharedTrend>, FitError> {
    let Some(name) = joint.shared.first().map(|parameter| parameter.name.to_string()) else {
        return Ok(None);
    };
    let held = joint.shared[1..]
        .iter()
        .find(|parameter| parameter.unit == ParameterUnit::One)
        .map(|parameter| parameter.name.to_string());
    let (fits, beside) = match held.and_then(|held| Some((common(&joint.separate, &held)?, held))) {
        None => (joint.separate.clone(), None),
        Some(((value, error), held)) => {
            let mut at = |value: f64| -> Result<Vec<Fit>, FitError> {
                let mut options = law_options(joint.law, &joint.options);
                options.bounds.clear();
                options.fixed.push((held.clone(), value));
                holds.iter().map(|hold| fit_law_watched(hold, joint.law, &options, watch)).collect()
            };
            (at(value)?, Some(at(value + error)?))
        }
    };
    let log = |fit: &Fit| fit.value(&name).map_or(f64::NAN, f64::ln);
    let constant = joint.law.form(joint.response).map(|form| form.constant_name());
    let mut points = Vec::new();
    for (index, fit) in fits.iter().enumerate() {
        let error = fit.estimate(&name).and_then(|estimate| Some(estimate.standard_error? / estimate.value));
        // A constant that was not found has no error.
        let level = constant.and_then(|name| fit.estimate(name)).filter(|estimate| estimate.standard_error.is_some());
        let strain = strains.map(|strains| strains[index]).or(level.map(|estimate| estimate.value));
        let (Some(error), Some(abscissa)) = (error, strain) else {
            continue;
        };
        points.push(TrendPoint {
            hold: index + 1,
            abscissa,
            log_value: log(fit),
            standard_error: error,
            by_held: beside.as_ref().map_or(0.0, |beside| log(&beside[index]) - log(fit)),
        });
    }
    Ok(SharedTrend::of(name, points, joint.options.fit.confidence))
}

/// The mean of a parameter over separate fits, by their errors, in ln; and its standard error.
fn common(separate: &[Fit], name: &str) -> Option<(f64, f64)> {
    let (mut total, mut sum) = (0.0, 0.0);
    for fit in separate {
        if let Some(estimate) = fit.estimate(name)
            && let Some(error) = estimate.standard_error
        {
            let weight = 1.0 / ((error / estimate.value).powi(2)).max(1e-24);
            total += weight;
            sum += weight * estimate.value.ln();
        }
    }
    let value = (sum / total).exp();
    (total > 0.0).then(|| (value, value / total.sqrt()))
}
